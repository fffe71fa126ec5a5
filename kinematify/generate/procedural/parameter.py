"""What may be asked of a family: lengths, angles, shares, counts and choices; and tables in YAML that say it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import yaml

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path


_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast, where PyYAML was built with it


def read_table(path: Path) -> Any:
    """Return what a file of the package says: lists, mappings, texts and numbers."""
    return parse_table(path.read_text(encoding="utf-8"))


def parse_table(text: str) -> Any:
    """Return what YAML of the package says."""
    return yaml.load(text, Loader=_LOADER)


Value = float | int | str
_Range = tuple[float, float]


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
    drawn: bool = True
    """False: a seed draws no value, and no number either, so that what else it draws stays the same without it."""


def length(
    name: str,
    default: float,
    bounds: _Range,
    help: str,
    *,
    usual: _Range | None = None,
    words: str = "",
    drawn: bool = True,
) -> Parameter:
    """A length [m]; `words` are separated by commas, here and below."""
    return Parameter(
        name=name, default=default, unit="m", bounds=bounds, usual=usual, help=help, words=phrases(words), drawn=drawn
    )


def angle(
    name: str, default: float, bounds: _Range, help: str, *, usual: _Range | None = None, drawn: bool = True
) -> Parameter:
    """An angle [rad]."""
    return Parameter(name=name, default=default, unit="rad", bounds=bounds, usual=usual, help=help, drawn=drawn)


def share(name: str, default: float, bounds: _Range, help: str, *, usual: _Range | None = None) -> Parameter:
    """A number without a unit."""
    return Parameter(name=name, default=default, bounds=bounds, usual=usual, help=help)


def counted(
    name: str,
    default: int,
    bounds: _Range,
    help: str,
    *,
    usual: _Range | None = None,
    words: str = "",
    drawn: bool = True,
) -> Parameter:
    """How many there are."""
    return Parameter(
        name=name, default=default, bounds=bounds, usual=usual, help=help, words=phrases(words), drawn=drawn
    )


def choice(
    name: str, choices: Sequence[str] | Mapping[str, str], help: str, *, words: str = "", drawn: bool = True
) -> Parameter:
    """One of several, the first if nothing is said; a mapping gives words for each. Any text if there are none."""
    named = choices if isinstance(choices, Mapping) else {}
    return Parameter(
        name=name,
        default=next(iter(choices), ""),
        choices=tuple(choices),
        help=help,
        words=phrases(words),
        choice_words={key: phrases(said) for key, said in named.items() if said},
        drawn=drawn,
    )


_KINDS: Mapping[str, Callable[..., Parameter]] = {
    "length": length, "angle": angle, "share": share, "count": counted, "choices": choice,
}  # fmt: skip


def read_parameter(name: str, said: Mapping[str, Any]) -> Parameter:
    """Return the parameter that a table describes: what it is with its default or choices, and the arguments above."""
    kind = next(kind for kind in _KINDS if kind in said)
    facts = {key: tuple(value) if isinstance(value, list) else value for key, value in said.items() if key != kind}
    return _KINDS[kind](name, said[kind], **facts)


def phrases(text: str) -> tuple[str, ...]:
    """Split a text at its commas."""
    return tuple(text.split(", ")) if text else ()


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
