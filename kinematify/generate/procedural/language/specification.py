"""Request of a sentence: a kind of object, its parts as individuals or groups, sizes, looks, motions and places."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.generate.procedural.language.words import Token


HANDLES = ("handle", "knob", "pull", "grip")
"""Words for handles, which may be no parts of their own."""
FRONTS = ("door", "drawer", "lid", "flap", "window")
"""What has handles."""


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One thing that is said of a part or of the whole."""

    about: str
    """``there``, ``count``, ``moves``, ``way``, ``range``, ``hinge``, ``open``, ``answers`` (to a push), ``still``,
    ``only``, ``does``, ``place``, ``size``, ``color``, ``material``, ``like`` or ``relation``."""
    value: Any
    words: str
    """As it was written."""
    at: tuple[int, ...]
    """Which words of the sentence these are."""


@dataclass(frozen=True, kw_only=True)
class PartSpecification:
    """One part, or several equal parts, of an object."""

    noun: str
    """Singular, as in ``coat hook``; for the object itself its kind."""
    count: int | None = 1
    """None: some."""
    claims: tuple[Claim, ...] = ()
    of: str = ""
    """Noun of the part that it belongs to, where that is said."""

    @property
    def is_share(self) -> bool:
        """True if it is some of the parts that were named before: `two of which`."""
        return any(claim.about == "place" and claim.value == "first" for claim in self.claims)

    @property
    def absent(self) -> bool:
        """It is to be omitted: `without a handle`."""
        return self.count == 0

    def __str__(self) -> str:
        said = [f"{self._value(claim)}" for claim in self.claims if claim.about not in ("there", "count")]
        number = {None: "some ", 0: "no ", 1: ""}.get(self.count, f"{self.count} ")
        of = f" of {self.of}" if self.of else ""
        return f"{number}{self.noun}{of}" + (f" ({', '.join(said)})" if said else "")

    @staticmethod
    def _value(claim: Claim) -> str:
        if claim.about == "size":
            return f"{claim.value[0] or 'size'} {claim.value[1]:g} m"
        return claim.words

    def as_json(self) -> dict[str, Any]:
        """Its fields as JSON values."""
        said = {claim.about: claim.value for claim in self.claims if claim.about not in ("there", "count")}
        return {"noun": self.noun, "count": self.count, **({"of": self.of} if self.of else {}), **said}


@dataclass(frozen=True, kw_only=True)
class Specification:
    """A sentence as it was parsed; nothing has been built."""

    text: str
    """Without what it is for and what it is like."""
    tokens: tuple[Token, ...]
    name: tuple[int, ...]
    """Which words name the kind of object."""
    whole: PartSpecification
    """The object itself."""
    parts: tuple[PartSpecification, ...]
    harmless: tuple[str, ...] = ()
    """Words of purpose and of looks, which ask for no shape and no motion."""
    scene: tuple[tuple[str, Specification, Specification], ...] = ()
    """Two objects that the sentence may mean instead, and how they stand: ``on``, ``carrying``, ``beside``,
    ``holding``."""
    is_toy: bool = False
    """The whole is small."""

    @property
    def kind(self) -> str:
        """Name of the object, singular."""
        return self.whole.noun

    def all_parts(self) -> Iterator[PartSpecification]:
        """The object, then its parts."""
        yield self.whole
        yield from self.parts

    def handles(self) -> list[tuple[PartSpecification, PartSpecification | None]]:
        """Handles and knobs, each with the fronts that it is said of: those it is on, or those named before."""
        found: list[tuple[PartSpecification, PartSpecification | None]] = []
        every = [part for part in self.parts if part.noun.split()[-1] in HANDLES]
        for part in every:
            on: list[str] = next((claim.value[1].split() for claim in part.claims if claim.about == "relation"), [])
            places = tuple(claim for claim in part.claims if claim.about == "place")
            before = found[-1][1] if found else None
            owner = self.owner_of(part)
            if owner is None and on and on[-1] in FRONTS:
                at = part.claims[0].at
                said = tuple(Claim(about="place", value=word, words=word, at=at) for word in on[:-1])
                owner = PartSpecification(noun=on[-1], count=1 if said else None, claims=said)
            elif owner is None and places and before:
                owner = replace(before, count=1, claims=places)
            elif owner is None and len(every) > 1:
                named = [item for item in self.parts[: self.parts.index(part)] if item.noun in FRONTS]
                owner = named[-1] if named else None
            found.append((part, owner))
        return found

    def owner_of(self, part: PartSpecification) -> PartSpecification | None:
        """The part that has a part: of those of its name, the one that was named last before it."""
        first = min(part.claims[0].at)
        named = [item for item in self.parts if part.of and item.noun == part.of and min(item.claims[0].at) < first]
        return named[-1] if named else next((item for item in self.parts if part.of and item.noun == part.of), None)

    def __str__(self) -> str:
        return "; ".join(map(str, self.all_parts()))

    def as_json(self) -> dict[str, Any]:
        """Its fields as JSON values, for ``source.json``."""
        return {
            "kind": self.kind,
            "object": self.whole.as_json(),
            "parts": [part.as_json() for part in self.parts],
            "harmless": list(self.harmless),
        }
