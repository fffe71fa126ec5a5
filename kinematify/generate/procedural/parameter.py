"""Parameters of a family: lengths, angles, shares, counts and choices; and tables in YAML that say it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
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


def number(
    name: str,
    default: float,
    bounds: _Range,
    help: str,
    *,
    unit: str = "",
    usual: _Range | None = None,
    words: Words = "",
    drawn: bool = True,
) -> Parameter:
    """A number with its unit, a count where the default is whole."""
    return Parameter(
        name=name, default=default, unit=unit, bounds=bounds, usual=usual, help=help, words=phrases(words), drawn=drawn
    )


def choice(
    name: str,
    choices: Sequence[str] | Mapping[str, str],
    help: str,
    *,
    words: Words = "",
    drawn: bool = True,
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


def _ranged(name: str, bounds: _Range, help: str, *, default: float | None = None, **facts: Any) -> Parameter:
    """A number that is drawn from all that can be built; whole bounds make it a count, the middle is the default."""
    whole = all(isinstance(end, int) for end in bounds)
    middle = float(f"{0.5 * sum(bounds):.3g}") if default is None else default
    unit = {} if whole else {"unit": "m"}
    return number(name, int(middle) if whole else middle, bounds, help, usual=bounds, **(unit | facts))


def _yes_or_no(name: str, share: float, help: str, **facts: Any) -> Parameter:
    """A choice that is yes in a share of the draws."""
    return replace(choice(name, ("yes", "no") if share >= 0.5 else ("no", "yes"), help, **facts), yes=share)


_KINDS: Mapping[str, Callable[..., Parameter]] = {
    "length": partial(number, unit="m"), "angle": partial(number, unit="rad"), "share": number, "count": number,
    "choices": choice, "range": _ranged, "yes": _yes_or_no,
}  # fmt: skip


def read_parameter(name: str, said: Mapping[str, Any] | Sequence[float]) -> Parameter:
    """Return the parameter that a table describes: its kind with a default, range or choices, and arguments above.

    A list is short for a range.
    """
    facts = {"help": "As the object has it.", **(said if isinstance(said, Mapping) else {"range": said})}
    facts = {key: tuple(value) if isinstance(value, list) else value for key, value in facts.items()}
    kind = next(kind for kind in _KINDS if kind in facts)
    return _KINDS[kind](name, facts.pop(kind), **facts)


def phrases(text: Words) -> tuple[str, ...]:
    """Split a text at its commas; what is a list stays one."""
    return tuple(text.split(", ") if isinstance(text, str) else text) if text else ()


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
