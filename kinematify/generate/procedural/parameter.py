"""Parameters of a family: lengths, angles, shares, counts and choices; and tables in YAML that say it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import yaml

if TYPE_CHECKING:
    from collections.abc import Sequence


_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast, where PyYAML was built with it


def parse_table(text: str) -> Any:
    """Return what YAML of the package says."""
    return yaml.load(text, Loader=_LOADER)


Value = float | int | str
_Range = tuple[float, float]
Words = str | tuple[str, ...]
"""How people call something; a text is split at its commas."""


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One thing that may be asked for."""

    name: str
    default: Value
    """Its type is the parameter's: float with a unit, int for a count, str for a choice."""
    help: str
    unit: str = ""
    """``m``, ``rad`` or empty."""
    bounds: _Range | None = None
    """Values that can be built, both ends included."""
    usual: _Range | None = None
    """Values that a seed draws from; the default alone if absent."""
    choices: tuple[str, ...] = ()
    """Of a choice; a seed draws from all of them."""
    words: tuple[str, ...] = ()
    """How people call what is counted, measured or chosen, singular; the name itself and its singular count anyway."""
    choice_words: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """How people call a choice, besides its own name."""
    yes: float | None = None
    """Share of the draws in which it is yes, of a choice of yes and no."""
    drawn: bool = True
    """False: a seed draws no value, and no number either, so that what else it draws stays the same without it."""

    @property
    def nouns(self) -> tuple[str, ...]:
        """What a count or a size is called, singular."""
        own = self.name.replace("_", " ")
        return (own.removesuffix("s") if isinstance(self.default, int) else own, *self.words)


def details_of(details: Mapping[str, int]) -> tuple[Parameter, ...]:
    """Return a count for each word for what belongs to parts of an object."""
    return tuple(
        Parameter(name=f"{word}s", default=count, bounds=(count, count), help="Belongs to it.", words=(word,))
        for word, count in details.items()
    )


def phrases(text: Words) -> tuple[str, ...]:
    """Split a text at its commas; what is a list stays one."""
    return tuple(text.split(", ") if isinstance(text, str) else text) if text else ()


def pairs(text: str) -> dict[str, str]:
    """Return words, each with what is behind it, of a text with a bar between the pairs."""
    return dict(item.split(" ", 1) for item in text.split("|"))


PARAMETER_HEADINGS = ("parameter", "default", "values", "what it is")


def parameter_rows(parameters: Sequence[Parameter]) -> list[tuple[str, str, str, str]]:
    """Return a row of cells per parameter, see `PARAMETER_HEADINGS`."""
    return [(item.name, _default(item), _values(item), item.help) for item in parameters]


def _default(parameter: Parameter) -> str:
    value = parameter.default
    text = format(value, "g") if isinstance(value, float) else str(value)
    return f"{text} {parameter.unit}".strip()


def _values(parameter: Parameter) -> str:
    if parameter.bounds is not None:
        return f"{parameter.bounds[0]:g} to {parameter.bounds[1]:g} {parameter.unit}".strip()
    return ", ".join(choice for choice in parameter.choices if choice)
