"""A family of objects: its parameters with their ranges, and the function that builds one."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.procedural.materials import COLORS, MATERIALS
from kinematify.generate.procedural.parameter import choice, number
from kinematify.generate.procedural.workshop import STYLES, Workshop
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.parameter import Parameter, Value


@dataclass(frozen=True, kw_only=True, eq=False)
class Family:
    """A kind of object that can be built."""

    name: str
    """One word, as in ``--category``."""
    title: str
    """A few words for lists."""
    words: tuple[str, ...]
    """How people call it, singular."""
    parameters: tuple[Parameter, ...]
    """Besides those that every family has, see `COMMON`."""
    build: Callable[[Values, Workshop], None]
    """Adds bodies and joints to the workshop."""
    material: str = "wood"
    """Of its base, if nothing is asked for."""
    walls: float | None = None
    """Mass of the walls of what is hollow [kg/m^2]: thin sheet has 5, armour 700; as configured if None."""
    kinds: Mapping[str, Mapping[str, Value]] = field(default_factory=dict)
    """What is usual of those that are called by one of the words, where a sentence says nothing else."""
    part_words: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """How people call its parts, besides the names that they have without their numbers."""
    like: str = ""
    """The kind that it is another way to build, which the fit alone knows; empty of a kind of its own."""
    module: str = ""
    """The theme that it is listed under: the module of `kinematify.generate.kinds` with its function."""
    draw: Callable[..., None] | None = None
    """Draws it with a builder, in any style of modelling; None where it is carved or listed by a blueprint."""

    @property
    def all_parameters(self) -> tuple[Parameter, ...]:
        """Its own and the common ones."""
        return (*self.parameters, *COMMON)


class Values:
    """Parameters with their values, as a family reads them."""

    def __init__(self, values: Mapping[str, Value], rng: np.random.Generator, *, drawn: bool = True) -> None:
        """Keep the values; `rng` is for decoration that has no parameter, which is only `drawn` by a seed."""
        self._values = dict(values)
        self.rng, self.drawn = rng, drawn

    def value(self, name: str) -> Value:
        """As it was given."""
        return self._values[name]

    def has(self, name: str) -> bool:
        """True if there is such a parameter."""
        return name in self._values

    def number(self, name: str) -> float:
        """A length [m] or an angle [rad]."""
        return float(self._values[name])

    def count(self, name: str) -> int:
        """Return how many."""
        return int(self._values[name])

    def choice(self, name: str) -> str:
        """One of the choices."""
        return str(self._values[name])


_INSTEAD = "How far {} stand open instead of a share; {} stay closed."
COMMON = (
    number("open", 0.0, (0.0, 1.0), "Share of the way that moving parts stand open."),
    number("clearance", 0.001, (0.0, 0.003), "Gap between what moves past each other.", unit="m", usual=(2e-4, 3e-3)),
    choice("style", STYLES, "Of the meshes: as drawn, or as from elsewhere."),
    choice("material", ("", *MATERIALS), "What the base is made of."),
    choice("color", ("", *COLORS), "Colour of what names no material of its own."),
    choice("handle_material", sorted(MATERIALS, key="metal".__ne__), "What handles are made of.", drawn=False),
    choice("handle_color", ("", *COLORS), "Colour of handles, if painted.", drawn=False),
    number("open_angle", 0.0, (0.0, math.pi), _INSTEAD.format("hinges", "slides"), unit="rad", drawn=False),
    number("open_distance", 0.0, (0.0, 5.0), _INSTEAD.format("slides", "hinges"), unit="m", drawn=False),
)
"""Parameters of every family."""


_NOT_DRAWN = ("material", "color")
_FAR = {JointType.REVOLUTE: "open_angle", JointType.PRISMATIC: "open_distance"}


def build(family: Family, given: Mapping[str, Value], *, seed: int | None = None, name: str = "") -> Blueprint:
    """Build an object of a family.

    Args:
        family: What to build.
        given: Parameter -> value in metres, radians, counts or words; others take their default, or what the seed
            draws from their usual range.
        seed: Draws what is not given; none takes the defaults.
        name: Of the object; the family's if empty.

    Raises:
        InputError: A parameter is unknown or out of its bounds; the message names the nearest or the bounds.
    """
    rng = np.random.default_rng(seed)
    asked = {key: checked(family, key, value) for key, value in given.items()}
    values = {p.name: _drawn(p, rng) if seed is not None and p.drawn else p.default for p in family.all_parameters}
    values.update(asked)
    workshop = Workshop(
        family.name,
        material=str(values["material"]) or family.material,
        color=str(values["color"]) or None,
        handles=(str(values["handle_material"]), str(values["handle_color"]) or None),
        walls=family.walls,
    )
    far = {kind: float(values[key]) for kind, key in _FAR.items() if values[key]}
    # What opens at all is asked of the family by opening it; how far, is set on the joints.
    family.build(Values({**values, "open": 1.0} if far else values, rng, drawn=seed is not None), workshop)
    if not workshop.moves:
        counts = ", ".join(p.name for p in family.parameters if isinstance(p.default, int))
        raise InputError(f"Nothing of this {family.title} would move. Ask for one of {counts} at least.")
    if far:
        workshop.set_opening(far, title=family.title)
    return workshop.finish(
        name or family.name,
        {"seed": seed, **values},
        style=str(values["style"]),
        clearance=float(values["clearance"]),
        rng=np.random.default_rng(seed),
    )


def _drawn(parameter: Parameter, rng: np.random.Generator) -> Value:
    """Draw a value; always the same number of draws, so that giving one parameter does not change the others."""
    share = float(rng.random())
    if parameter.choices and parameter.name not in _NOT_DRAWN:
        return parameter.choices[int(share * len(parameter.choices))]
    if parameter.usual is None:
        return parameter.default
    low, high = parameter.usual
    if isinstance(parameter.default, int):
        return int(low) + int(share * (int(high) - int(low) + 1))
    return low + share * (high - low)


def checked(family: Family, name: str, value: Any) -> Value:
    """Return a value of a parameter as its type says.

    Raises:
        InputError: There is no such parameter, or the value is out of its bounds.
    """
    parameter = next((p for p in family.all_parameters if p.name == name), None)
    if parameter is None:
        known = [p.name for p in family.all_parameters]
        near = difflib.get_close_matches(name, known, n=1)
        hint = f" Did you mean {near[0]}?" if near else ""
        raise InputError(f"A {family.title} has no parameter {name!r}.{hint} It has {', '.join(known)}.")
    if isinstance(parameter.default, str):
        return _checked_choice(family, parameter, str(value))
    return _checked_number(family, parameter, value)


def _checked_choice(family: Family, parameter: Parameter, value: str) -> str:
    if parameter.choices and value not in parameter.choices:
        choices = ", ".join(choice for choice in parameter.choices if choice)
        raise InputError(f"The {parameter.name} of a {family.title} cannot be {value!r}. Choose one of {choices}.")
    return value


def _checked_number(family: Family, parameter: Parameter, value: Any) -> float | int:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    low, high = parameter.bounds or (-math.inf, math.inf)
    whole = isinstance(parameter.default, int)
    if not low <= number <= high or (whole and number != int(number)):
        raise InputError(
            f"The parameter {parameter.name} of a {family.title} is {_shown(parameter, value)}, but must be "
            f"{'a whole number' if whole else 'a number'} from {low:g} to {_shown(parameter, high)}."
        )
    return int(number) if whole else number


def _shown(parameter: Parameter, value: Any) -> str:
    """A value with its unit; angles in degrees, too. What is no number stands in quotes."""
    if not isinstance(value, float | int):
        return repr(value)
    degrees = f" ({math.degrees(value):.0f} degrees)" if parameter.unit == "rad" else ""
    return f"{value:g} {parameter.unit}".strip() + degrees
