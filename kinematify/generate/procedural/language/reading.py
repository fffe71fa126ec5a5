"""A sentence while it is read: its words, the family, what was taken up so far."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.language.compare import Missing
from kinematify.generate.procedural.language.words import NOUNS, Words

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.language.arrangement import Mention
    from kinematify.generate.procedural.language.words import Token
    from kinematify.generate.procedural.parameter import Parameter, Value


@dataclass(kw_only=True)
class ParseState(Words):
    """A sentence being read; words that were taken up are marked."""

    tokens: tuple[Token, ...]
    family: Family
    values: dict[str, Value] = field(default_factory=dict)
    used: set[int] = field(default_factory=set)
    said: dict[str, str] = field(default_factory=dict)
    """Words that set a parameter, as they were written, by its name."""
    places: dict[str, tuple[int, ...]] = field(default_factory=dict)
    """Which words these are."""
    dropped: list[Missing] = field(default_factory=list)
    """What such an object cannot have."""
    named: frozenset[int] = frozenset()
    """Where the family is named; a choice may be part of its name."""
    ranges: frozenset[int] = frozenset()
    """Words that say how far something moves, which are no size."""
    apart: frozenset[int] = frozenset()
    """Words for handles of some parts alone."""
    of_parts: Mapping[int, str] = field(default_factory=dict)
    """Words of sizes of parts -> the noun of the part."""
    counted: set[int] = field(default_factory=set)
    """Nouns that were counted; a choice may say their kind, as in `two cross handles`."""
    overall: tuple[str, float] | None = None
    """Size of the whole that no parameter sets, and metres."""
    copies: int = 1
    mentions: list[Mention] = field(default_factory=list)

    def take(self, name: str, value: Value, said: str, *where: int) -> None:
        """Set a parameter; of two choices the first holds, two numbers for one thing are a contradiction.

        Raises:
            InputError: There are two numbers.
        """
        before = self.values.get(name)
        words = self.words_at(where) or said
        if before is not None and before != value:
            if isinstance(value, str):
                self.dropped.append(Missing(words=words, at=frozenset(where), reason=f"{name}: {before}"))
                self.used.update(where)
                return
            raise InputError(
                f"The text says {self.said.get(name, before)!r} and {words!r}: {name} {before} or {value}? Say one."
            )
        if before is None:
            self.said[name] = words
            self.places[name] = where
        self.values[name] = value
        self.used.update(where)

    def drop(self, name: str, reason: str) -> None:
        """Build without a parameter that was taken."""
        words = self.said.pop(name, name)
        del self.values[name]
        self.dropped.append(Missing(words=words, at=frozenset(self.places.pop(name, ())), reason=reason))

    def words_at(self, where: Collection[int]) -> str:
        """Words as they were written."""
        return " ".join(self.tokens[k].given for k in sorted(set(where)))

    def parameter(self, name: str) -> Parameter | None:
        """The family's parameter of a name."""
        return next((p for p in self.family.all_parameters if p.name == name), None)


def nouns_of(parameter: Parameter) -> tuple[str, ...]:
    """Return what a count or a size is called, singular."""
    own = parameter.name.replace("_", " ")
    counted = isinstance(parameter.default, int)
    return (own.removesuffix("s") if counted else own, *parameter.words, *NOUNS.get(parameter.name, ()))
