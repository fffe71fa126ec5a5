"""Request of a specification to the composer: which mechanisms go on a body, where, and how large the body is."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.composer.bodies import BodyKind
from kinematify.generate.composer.compose import BANDS, Composition, MechanismSpec, compose
from kinematify.generate.composer.placed_mechanisms import MECHANISMS, MechanismKind
from kinematify.generate.composer.side import FACING
from kinematify.generate.procedural.language.compare import Missing
from kinematify.generate.procedural.language.parse import lemmas
from kinematify.generate.procedural.language.sizes import SIZE_WORDS
from kinematify.generate.procedural.language.words import ARTICLES, lemma

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.generate.procedural.language.specification import PartSpecification, Specification

_SIDES = {side: side for side in FACING} | {"rear": "back", "underside": "bottom", "upper": "top", "lower": "bottom"}
_SIDES |= {"uppermost": "top", "lowest": "bottom"}
_FLANKS = ("left", "right")
_ENDS = ("front", "back", "rear")
"""Sides that are said before a noun; a left door is the left one of two."""
_AXES = {"width": 0, "length": 0, "depth": 1, "height": 2}
_ATTACHED = ("grid", "axles", "corners")
"""How mechanisms are arranged that any object may get."""
_UPRIGHT = ("front", "top", "right", "left", "back")
_HANDLES = ("handle", "handles", "pull", "grip")
MOST_COPIES = 12
"""Side by side."""
_MOST_MEMBERS = 12  # blades
_LARGER = 1.3  # times as long in all directions is large
_SCALES = 3.5  # times as long as usual a body may be
_SHORTEST, _LONGEST = 0.05, 20.0  # [m]


@dataclass(kw_only=True)
class Requirements:
    """Request of a specification to a body."""

    specification: Specification
    body: BodyKind
    wanted: list[MechanismSpec] = field(default_factory=list)
    excluded: list[MechanismKind] = field(default_factory=list)
    handles: tuple[str | None, str | None] = (None, None)
    """Material and colour of the handles of doors and drawers."""
    of_handles: set[int] = field(default_factory=set)
    used: set[int] = field(default_factory=set)
    """Words that were taken up, and that no comparison sees."""
    dropped: list[Missing] = field(default_factory=list)
    """What has no place on the body."""
    added: list[MechanismSpec] = field(default_factory=list)
    """What goes on other parts: a lock on each drawer."""
    places: dict[int, tuple[int, ...]] = field(default_factory=dict)
    """Words of what is wanted, by the id of it."""

    # ---- mechanisms ------------------------------------------------------------------------------------------------

    def take_parts(self) -> None:
        """Take up what is asked for besides the body."""
        for part in self.specification.parts:
            self._parse(part)

    def _parse(self, part: PartSpecification) -> None:
        at = part.claims[0].at
        words, kind = self._mechanism(max(at))
        if kind is None and not part.of:  # an adjective asks for it: a rolling cabinet
            words = tuple(part.noun.split()[-1:])
            kind = _mechanisms().get(words)
            if any(item.mechanism is kind for item in self.wanted):
                return  # it was named
        if part.of and (on_part := mechanism_for(part, self.specification.owner_of(part))):
            self.added.append(on_part)
            return
        look = (_first(part, "material"), _first(part, "color"))
        plain_handles = part.noun in _HANDLES and not any(claim.about == "count" for claim in part.claims)
        if plain_handles and (part.count is None or part.of):
            self.handles = look  # those of doors and drawers, which are not counted
            self.of_handles |= _words_of_part(part)
            return
        if self._is_detail(part) or self._are_members(part) or kind is None:
            return
        before = next((item for item in self.wanted if item.mechanism is kind), None)
        if before is not None and not self._is_counted(part):
            return  # what was named before
        if part.absent:
            self.excluded.append(kind)
            return
        side, level = self._side(part, kind)
        wanted = MechanismSpec(
            mechanism=kind,
            said=_unusual(words, kind.words),
            count=_several(kind) if part.count is None else part.count,
            side=side,
            level=level,
            hinge=_hinge(part) if kind.words[0] == "door" else "",
            material=look[0],
            color=look[1],
        )
        self.wanted.append(wanted)
        self.used.update(range(max(at) - len(words) + 1, max(at) + 1))
        self.places[id(wanted)] = tuple(range(max(at) - len(words) + 1, max(at) + 1))

    def _mechanism(self, last: int) -> tuple[tuple[str, ...], MechanismKind | None]:
        """The longest name of a mechanism that ends with a word, and what it means on this body."""
        says = {tuple(word.split()): kind for word, kind in self.body.says.items()}
        for start in range(max(last - 4, 0), last + 1):
            given = [token.given for token in self.specification.tokens[start : last + 1]]
            for words in (tuple(given), (*given[:-1], lemma(given[-1])), (*given[:-1], given[-1].removesuffix("ed"))):
                kind = _mechanisms().get(tuple(says[words].split()) if words in says else words)
                if kind is not None:
                    return words, kind
        return (), None

    def _is_counted(self, part: PartSpecification) -> bool:
        """True if a number or `a` counts it, and no `the` takes up what was named before: `the left one`."""
        tokens, first = self.specification.tokens, min(part.claims[0].at)
        if part.is_share:
            return False
        count = next((min(claim.at) for claim in part.claims if claim.about == "count"), None)
        if count is not None:
            return "the" not in [token.given for token in tokens[max(count - 2, 0) : count]]
        return any(token.given in ARTICLES for token in tokens[max(first - 3, 0) : first])

    def _is_detail(self, part: PartSpecification) -> bool:
        """`with two handles`, which this body has anyway."""
        details = self.body.details.items()
        number = next((number for word, number in details if f" {part.noun}".endswith(f" {word}")), 0)
        if not number or part.count not in (number, None):
            return False
        self.used |= _words_of_part(part)
        return True

    def _are_members(self, part: PartSpecification) -> bool:
        """`with five blades`, of the rotor that it has or just got."""
        own = [MechanismSpec(mechanism=kind) for kind in MECHANISMS if kind.words[0] in self.body.always]
        for item in self.wanted[-1:] or own:
            if part.noun in item.mechanism.members and 2 <= (part.count or 0) <= _MOST_MEMBERS:
                self.wanted[-1:] = [replace(item, members=part.count or 0)]
                self.used |= _words_of_part(part)
                return True
        return False

    def _side(self, part: PartSpecification, kind: MechanismKind) -> tuple[str, int]:
        """The side of the body, and the level on it, on which a part is asked for."""
        first = min(part.claims[0].at)
        said = [claim for claim in part.claims if claim.about == "place"]
        said = [claim for claim in said if min(claim.at) > first or claim.value in _ENDS]
        if not said or "one" in said[0].words.split():  # all on the same side
            return "", 0
        if said[0].value == "side":
            flank = next((side for side in kind.sides if side in _FLANKS), "right")
            return "" if kind.arranged == "axles" else flank, 0
        side = _SIDES.get(said[0].value, "")
        # What goes on the front alone is at its top or bottom there.
        if kind.arranged in BANDS and side in ("top", "bottom") and side not in kind.sides:
            return "", 1 if side == "top" else -1
        return side, 0

    def accepted(self, *, nothing_wanted: bool = False) -> list[MechanismSpec]:
        """Return what the body has without being asked for."""
        body = self.body
        named = [*self.excluded, *(item.mechanism for item in self.wanted)]
        granted = {**body.always, **({} if self.wanted and not nothing_wanted else body.usual)}
        if any(item.mechanism.needs == "opening" for item in self.wanted):
            granted.pop("door", None)  # something else closes it
        called = {kind: word for word, kind in body.says.items()}
        return [
            MechanismSpec(
                mechanism=kind,
                said=called.get(kind.words[0], ""),
                count=granted[kind.words[0]],
                hinge=_hinge(self.specification.whole) if kind.words[0] == "door" else "",
            )
            for kind in MECHANISMS
            if kind.words[0] in granted and kind not in named
        ]

    # ---- the body --------------------------------------------------------------------------------------------------

    def size(self) -> tuple[float | None, float | None, float | None]:
        """Width, depth and height that are asked for [m].

        Raises:
            InputError: No such body can be so large.
        """
        found: list[float | None] = [None, None, None]
        longest = max(range(3), key=self.body.size.__getitem__)
        title = self.body.words[0]
        for claim in (claim for claim in self.specification.whole.claims if claim.about == "size"):
            name, metres = claim.value
            axis = _AXES.get(name, longest if not name else None)
            if axis is None or found[axis] is not None:
                continue
            if not _SHORTEST <= metres <= _LONGEST or metres > _SCALES * self.body.size[axis]:
                raise InputError(
                    f"A {title} cannot be {claim.words}: usual is {self.body.size[axis]:g} m there, and lengths are "
                    f"from {_SHORTEST:g} m to {_LONGEST:g} m."
                )
            found[axis] = metres
        return found[0], found[1], found[2]

    def scale(self) -> float:
        """Scale of lengths that are not asked for: `a small cart`."""
        scale = 1.0
        for k in range(min(self.specification.name)):
            if (word := self.specification.tokens[k].given) in SIZE_WORDS:
                scale *= _LARGER if SIZE_WORDS[word][0] else 1.0 / _LARGER
                self.used.add(k)
        return scale

    def drop(self, words: str, *where: int, reason: str = "") -> None:
        """Build without something that was asked for."""
        self.dropped.append(Missing(words=words, at=frozenset(where), reason=reason))


def asked_composition(
    specification: Specification, body: BodyKind, *, may_stand_still: bool = False
) -> tuple[Composition, Requirements]:
    """Find out which mechanisms go on a body; what has no place there is dropped.

    Args:
        specification: What is asked for.
        body: Of the object's name.
        may_stand_still: It need not move.

    Raises:
        InputError: It asks for absurd sizes, or nothing of it would move.
    """
    asked = Requirements(specification=specification, body=body)
    asked.take_parts()
    wanted = (*asked.wanted, *asked.accepted())
    whole = specification.whole
    if any(item.mechanism.has_grip for item in wanted):
        asked.used |= asked.of_handles
    else:
        asked.handles = (None, None)
    copies = 1 if whole.count is None else whole.count
    name = " ".join(specification.tokens[k].given for k in specification.name)
    if not 1 <= copies <= MOST_COPIES:
        raise InputError(f"The text asks for {copies} {name}; at most {MOST_COPIES} are built side by side.")
    asked.used |= {k for claim in whole.claims if claim.about == "count" for k in claim.at}
    rest = next((c.value[1] for c in whole.claims if c.about == "open" and c.value[0] == "share"), 0.0)
    composition = Composition(
        body=body,
        said=_unusual(tuple(lemmas(specification.tokens, specification.name)), body.words),
        wanted=wanted,
        size=asked.size(),
        material=_first(whole, "material"),
        color=_first(whole, "color"),
        handles=asked.handles,
        rest=rest,
        copies=copies,
        scale=asked.scale(),
    )
    return _fitting(composition, asked, may_stand_still=may_stand_still), asked


def _fitting(composition: Composition, asked: Requirements, *, may_stand_still: bool) -> Composition:
    """The composition without mechanisms that have no place on its body, the last said first.

    Raises:
        InputError: Nothing of it would move.
    """
    first: InputError | None = None
    while True:
        try:
            compose(composition, may_stand_still=may_stand_still)
        except InputError as error:
            first = first or error
            items = [item for item in asked.wanted if item in composition.wanted]
            if not items:
                raise first from None
            alone = [item for item in items if _fits_without(composition, item)]
            last = (alone or items)[-1]
            reason = str(error).split(". ", maxsplit=1)[0].rstrip(".")
            asked.drop(last.title, *asked.places.get(id(last), ()), reason=reason)
            rest = tuple(item for item in composition.wanted if item is not last)
            composition = replace(composition, wanted=rest or tuple(asked.accepted(nothing_wanted=True)))
        else:
            return composition


def _fits_without(composition: Composition, item: MechanismSpec) -> bool:
    try:
        compose(replace(composition, wanted=tuple(other for other in composition.wanted if other is not item)))
    except InputError:
        return False
    return True


def _first(part: PartSpecification, about: str) -> str | None:
    return next((str(claim.value) for claim in part.claims if claim.about == about), None)


def _hinge(part: PartSpecification) -> str:
    """``left`` or ``right``, where it is hinged or opens to."""
    said = (claim.value for claim in part.claims if claim.about in ("hinge", "way"))
    return next((side for side in said if side in _FLANKS), "")


def _words_of_part(part: PartSpecification) -> set[int]:
    return {k for claim in part.claims for k in claim.at}


def sentence_of(composition: Composition) -> str:
    """Return a sentence that `read_composition` understands as this composition, its openness and lengths apart."""
    items = [_listed(item) for item in composition.wanted]
    listed = " and ".join([*([", ".join(items[:-1])] if items[1:] else []), items[-1]])
    return f"{_phrase(1, composition.color, composition.material, composition.title)} with {listed}"


def _listed(item: MechanismSpec) -> str:
    noun = item.title + ("s" if item.count > 1 else "")
    return _phrase(item.count, item.color, item.material, noun) + (f" on the {item.side} side" if item.side else "")


def _phrase(count: int, *words: str | None) -> str:
    text = " ".join(word for word in words if word)
    return f"{count if count > 1 else 'an' if text[0] in 'aeiou' else 'a'} {text}"


def _several(mechanism: MechanismKind) -> int:
    """Return how many are meant that are not counted: what stands on wheels has four."""
    return 4 if mechanism.arranged in ("axles", "corners") else 2


def _unusual(words: tuple[str, ...], names: Sequence[str]) -> str:
    said = next((name for name in names if _words_of(name) == words), " ".join(words))
    return "" if said == names[0] else said


def _words_of(name: str) -> tuple[str, ...]:
    """A name as a sentence is split: `3d` is two words."""
    return tuple(re.findall(r"[0-9]+|[a-z]+", name))


@cache
def _mechanisms() -> Mapping[tuple[str, ...], MechanismKind]:
    return {_words_of(word): mechanism for mechanism in MECHANISMS for word in mechanism.words}


def mechanism_for(part: PartSpecification, owner: PartSpecification | None) -> MechanismSpec | None:
    """The mechanism that a part asks for, which an object has not; the one part that is to have it says its place."""
    words, said = part.noun.split(), {claim.about: claim for claim in part.claims}
    named = [(kind, words[k:]) for k in range(len(words)) if (kind := _mechanisms().get(tuple(words[k:])))]
    kind, words = next((item for item in named if item[0].arranged in _ATTACHED or item[0].on_parts), (None, words))
    carrier = f"each {part.of}" if part.of else ""
    place = _first(owner, "place") if owner is not None and owner.count == 1 else None
    if place:
        carrier = f"the {_SIDES.get(place, place)} {part.of}"
    if "relation" in said and said["relation"].value[1].split()[-1] not in _SIDES:
        carrier = " ".join(_SIDES.get(word, word) for word in said["relation"].words.split())
    on_carrier_alone = kind is not None and kind.arranged not in _ATTACHED
    if kind is None or part.absent or (on_carrier_alone and not carrier and "place" not in said):
        return None
    return MechanismSpec(
        mechanism=replace(kind, build=kind.on_parts, arranged="grid", sides=_UPRIGHT) if kind.on_parts else kind,
        said=" ".join(words),
        count=min(part.count or (1 if carrier else _several(kind)), _MOST_MEMBERS),
        side=_SIDES.get(said["place"].value, "") if "place" in said else "",
        carrier=carrier,
        material=said["material"].value if "material" in said else None,
        color=said["color"].value if "color" in said else None,
    )


@cache
def nouns_of_mechanisms() -> frozenset[str]:
    """Nouns, singular, that ask for a mechanism: of a hand wheel the wheel."""
    return frozenset(words[-1] for words in _mechanisms())
