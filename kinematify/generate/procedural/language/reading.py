"""A sentence while it is read: its words, the family, what was taken up so far."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.language.words import NOUNS, Words

if TYPE_CHECKING:
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
    understood: list[str] = field(default_factory=list)
    used: set[int] = field(default_factory=set)
    said: dict[str, str] = field(default_factory=dict)
    """Words that set a parameter, as they were written."""
    named: frozenset[int] = frozenset()
    """Where the family is named; a choice may be part of its name."""
    counted: set[int] = field(default_factory=set)
    """Nouns that were counted; a choice may say their kind, as in `two cross handles`."""
    overall: tuple[str, float] | None = None
    """Size of the whole that no parameter sets, and metres."""
    copies: int = 1
    mentions: list[Mention] = field(default_factory=list)

    def take(self, name: str, value: Value, said: str, *where: int) -> None:
        """Set a parameter; two different values for one are a contradiction."""
        before = self.values.get(name)
        if before is not None and before != value:
            raise InputError(
                f"The text asks for {name} = {before} and for {name} = {value}. Say one of them for a "
                f"{self.family.title}."
            )
        if before is None:
            self.understood.append(said)
            self.said[name] = " ".join(self.tokens[k].given for k in sorted(set(where))) or said
        self.values[name] = value
        self.used.update(where)

    def parameter(self, name: str) -> Parameter | None:
        """The family's parameter of a name."""
        return next((p for p in self.family.all_parameters if p.name == name), None)


def nouns_of(parameter: Parameter) -> tuple[str, ...]:
    """What a count or a size is called, singular."""
    own = parameter.name.replace("_", " ")
    counted = isinstance(parameter.default, int)
    return (own.removesuffix("s") if counted else own, *parameter.words, *NOUNS.get(parameter.name, ()))
