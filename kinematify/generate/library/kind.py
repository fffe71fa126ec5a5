"""Kinds of objects: names, bounded parameters, and the function that makes one; those in Python draw with a builder.

```python
@kind(words="stovetop espresso maker, espresso pot", radius=(0.035, 0.055), height=(0.13, 0.2))
def moka_pot(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part("pot", b.cylinder(radius, 0, height), look="metal")
    b.part("lid", b.cylinder(radius, height + 0.001, height + 0.02), look="metal")
    b.hinge("lid", "pot", -X, (0, radius, height + 0.001), 1.7)
```

The name of the function is the name of the kind, less a ``_`` at its end; two numbers bound a length. Whether it
names `open` or `clearance` besides its parameters decides if it is given them. Where the object is `carved_from` a
material, what the function adds and cuts takes effect at once, and it ends with `settle`.
"""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.generate.procedural.materials import COLORS, MATERIALS
from kinematify.generate.procedural.mesh_styles import STYLES
from kinematify.generate.procedural.parameter import Parameter, details_of, phrases

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.generate.procedural.builder import ObjectBuilder
    from kinematify.generate.procedural.parameter import Value, Words

MODELING: dict[str, dict[str, Any]] = {
    "careful": {},
    "gaps": {"gap": 0.005},
    "touching": {"gap": 0.0},
    "solid": {"has_bore": False, "hollow": False, "gap": 0.0},
    "overlapping": {"has_bore": False, "max_penetration": 0.3, "gap": 0.0},
}
"""How a drawn object is modelled -> what differs from the careful way, in which everything moves freely."""
KINDS: dict[str, Kind] = {}
"""Kinds whose modules are imported, keyed by name."""
_HELP = "As the object has it."
_Range = tuple[float, float]


# ---- kinds and objects of them ---------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True, eq=False)
class Kind:
    """A kind of object that can be built, in Python or in a file."""

    name: str
    """One word, as in ``--category``."""
    title: str
    """A few words for lists."""
    words: tuple[str, ...]
    """How people call it, singular."""
    parameters: tuple[Parameter, ...]
    """Besides those that every kind has, see `COMMON`."""
    make: Callable[[ObjectBuilder, Mapping[str, Value]], None]
    """Adds parts and joints to the builder, with values of all parameters."""
    carved_from: str = ""
    """Material of parts that name none, if nothing is asked for, where cuts take effect at once."""
    walls: float | None = None
    """Mass of the walls of what is hollow [kg/m^2]: thin sheet has 5, armour 700; as configured if None."""
    usual: Mapping[str, Mapping[str, Value]] = field(default_factory=dict)
    """What is usual of those that are called by one of the words, where a sentence says nothing else."""
    part_words: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """How people call its parts, besides the names that they have without their numbers."""
    like: str = ""
    """The kind that it is another way to build, which the fit alone knows; empty of a kind of its own."""
    about: str = ""
    """What it has, in words."""
    module: str = ""
    """The theme that it is listed under: the module of `kinematify.generate.kinds` with its function."""
    draw: Callable[..., None] | None = None
    """Draws it with a builder, in any style of modelling; None where it is carved or listed by a blueprint."""

    @property
    def all_parameters(self) -> tuple[Parameter, ...]:
        """Its own and the common ones."""
        return (*self.parameters, *COMMON)


def checked(kind: Kind, name: str, value: Any) -> Value:
    """Return a value of a parameter as its type says.

    Raises:
        InputError: There is no such parameter, or the value is out of its bounds.
    """
    parameter = next((p for p in kind.all_parameters if p.name == name), None)
    if parameter is None:
        known = [p.name for p in kind.all_parameters]
        near = difflib.get_close_matches(name, known, n=1)
        hint = f" Did you mean {near[0]}?" if near else ""
        raise InputError(f"A {kind.title} has no parameter {name!r}.{hint} It has {', '.join(known)}.")
    if isinstance(parameter.default, str):
        return _checked_choice(kind, parameter, str(value))
    return _checked_number(kind, parameter, value)


def _checked_choice(kind: Kind, parameter: Parameter, value: str) -> str:
    if parameter.choices and value not in parameter.choices:
        choices = ", ".join(choice for choice in parameter.choices if choice)
        raise InputError(f"The {parameter.name} of a {kind.title} cannot be {value!r}. Choose one of {choices}.")
    return value


def _checked_number(kind: Kind, parameter: Parameter, value: Any) -> float | int:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    low, high = parameter.bounds or (-math.inf, math.inf)
    whole = isinstance(parameter.default, int)
    if not low <= number <= high or (whole and number != int(number)):
        raise InputError(
            f"The parameter {parameter.name} of a {kind.title} is {_shown(parameter, value)}, but must be "
            f"{'a whole number' if whole else 'a number'} from {low:g} to {_shown(parameter, high)}."
        )
    return int(number) if whole else number


def _shown(parameter: Parameter, value: Any) -> str:
    """A value with its unit; angles in degrees, too. What is no number stands in quotes."""
    if not isinstance(value, float | int):
        return repr(value)
    degrees = f" ({math.degrees(value):.0f} degrees)" if parameter.unit == "rad" else ""
    return f"{value:g} {parameter.unit}".strip() + degrees


# ---- parameters ------------------------------------------------------------------------------------------------------


def length(low: float, high: float, *, unit: str = "m", default: float | None = None, **facts: Any) -> Parameter:
    """Return a bounded length [m].

    Args:
        low: The least that can be built.
        high: The most.
        unit: Another one, of what is no length.
        default: The middle if absent.
        facts: `usual` (the bounds that a seed draws from, all if absent), `help`, `words` and `drawn` of `Parameter`.
    """
    middle = float(f"{0.5 * (low + high):.3g}") if default is None else default
    given = {"help": _HELP, "usual": (low, high), **facts, "words": phrases(facts.get("words", ""))}
    return Parameter(name="", default=middle, unit=unit, bounds=(low, high), **given)


def angle(low: float, high: float, **facts: Any) -> Parameter:
    """Return a bounded angle [rad]; arguments as of `length`."""
    return length(low, high, unit="rad", **facts)


def share(low: float, high: float, **facts: Any) -> Parameter:
    """Return a bounded number without a unit; arguments as of `length`."""
    return length(low, high, unit="", **facts)


def whole(low: int, high: int, *, default: int | None = None, **facts: Any) -> Parameter:
    """Return a bounded count; arguments as of `length`."""
    return share(low, high, default=int(0.5 * (low + high)) if default is None else default, **facts)


def choice(
    choices: Sequence[str] | Mapping[str, str], *, help: str = _HELP, words: Words = "", **facts: Any
) -> Parameter:
    """Return one of several, the first if nothing is said; a mapping gives words for each. Without any: free text."""
    said = choices.items() if isinstance(choices, dict) else ()
    return Parameter(
        name="",
        default=next(iter(choices), ""),
        choices=tuple(choices),
        help=help,
        words=phrases(words),
        choice_words={key: phrases(words) for key, words in said if words},
        **facts,
    )


def yes(chance: float, **facts: Any) -> Parameter:
    """Return what holds or not, in a share of what seeds draw."""
    return choice(("yes", "no") if chance >= 0.5 else ("no", "yes"), yes=chance, **facts)


_COMMON = {
    "open": share(0.0, 1.0, default=0.0, usual=None, help="Share of the way that moving parts stand open."),
    "clearance": length(0, 0.003, default=1e-3, usual=(2e-4, 3e-3), help="Gap between what moves past each other."),
    "style": choice(STYLES, help="Of the meshes: as drawn, or as from elsewhere."),
    "material": choice(("", *MATERIALS), help="What the base is made of."),
    "color": choice(("", *COLORS), help="Colour of what names no material of its own."),
    "handle_material": choice(sorted(MATERIALS, key="metal".__ne__), help="What handles are made of.", drawn=False),
    "handle_color": choice(("", *COLORS), help="Colour of handles, if painted.", drawn=False),
}
COMMON = tuple(replace(item, name=name) for name, item in _COMMON.items())
"""Parameters of every kind."""


# ---- registering -----------------------------------------------------------------------------------------------------


def kind(
    called: str = "",
    *,
    words: str = "",
    title: str = "",
    like: str = "",
    carved_from: str = "",
    part_words: Mapping[str, Words] | None = None,
    details: Mapping[str, int] | None = None,
    usual: Mapping[str, Mapping[str, Value]] | None = None,
    styles: bool = True,
    walls: float | None = None,
    **parameters: Parameter | _Range,
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Return a decorator that registers the function that draws a kind of object.

    Args:
        called: How people call it, singular; as the function if empty.
        words: Other names, split at their commas, besides those of `usual`.
        title: A few words for lists; `called` if empty.
        like: The kind that it is another way to build, which `all_kinds` leaves out; empty of a kind of its own.
        carved_from: Of `Kind`.
        part_words: Name of a part without its number -> how else people call it.
        details: Word for what belongs to a part -> how many of it there are.
        usual: Names, split at their commas -> what is usual of those that are called so.
        styles: It may be modelled in any of `MODELING`; of what is not carved alone.
        walls: Of `Kind`.
        parameters: What may be asked for, under its name; two numbers bound a length.
    """
    given = {name: length(*item) if isinstance(item, tuple) else item for name, item in parameters.items()}
    asked = tuple(replace(item, name=name) for name, item in given.items())
    usually = {word: what for group, what in (usual or {}).items() for word in phrases(group)}

    def register(draw: Callable[..., None]) -> Callable[..., None]:
        name = draw.__name__.rstrip("_")
        said = called or name.replace("_", " ")
        if name in KINDS:
            raise ValueError(f"two kinds are called {name}")
        code = draw.__code__
        taken = code.co_varnames[1 : code.co_argcount]
        modeling = choice(tuple(MODELING), help="How it is modelled.", drawn=False)
        KINDS[name] = Kind(
            name=name,
            title=title or said,
            words=tuple(dict.fromkeys((said, *phrases(words), *usually))),
            parameters=(
                *asked,
                *details_of(details or {}),
                *([replace(modeling, name="modeling")] if styles and not carved_from else ()),
            ),
            make=partial(_made, draw, taken, bool(carved_from)),
            carved_from=carved_from,
            walls=walls,
            usual=usually,
            part_words={part: phrases(said) for part, said in (part_words or {}).items()},
            like=like,
            about=draw.__doc__ or "",
            module=draw.__module__.rpartition(".")[2],
            draw=draw if styles and not carved_from else None,
        )
        return draw

    return register


def _made(
    draw: Callable[..., None], taken: Sequence[str], carves: bool, builder: ObjectBuilder, values: Mapping[str, Value]
) -> None:
    """Draw an object with those of the values that are taken.

    Raises:
        InputError: It cannot be built.
    """
    given = {name: values[name] for name in taken}
    try:
        draw(builder, **{name: value == "yes" if value in ("yes", "no") else value for name, value in given.items()})
        if not carves:
            builder.arrange(str(values["material"]), str(values["color"]), float(values["open"]))
    except ValueError as error:
        raise InputError(f"The object {builder.family} cannot be built: {error}.") from error
