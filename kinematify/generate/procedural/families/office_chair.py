"""Office chairs: a star with castors, a gas spring, a seat that turns and a backrest that leans."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import at, bent_fork, stub
from kinematify.generate.procedural.pieces.castors import STEM, castor
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, rod

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_COLUMN = 0.026  # radius of the tube around the gas spring [m]
_SPRING = 0.014  # radius of the gas spring [m]
_SIDES = 8  # of the gas spring
_FORK = (0.07, 0.016)  # width and radius of the backrest's hinge [m]
_SEAT = 0.065  # thickness of the cushion [m]


def _build(values: Values, workshop: Workshop) -> None:
    level = 2.0 * values.number("wheel") + 0.035  # underside of the star's arms
    column = level + values.number("column")
    hub = cylinder(0.04, (0, 0, level - 0.005), (0, 0, level + 0.05))
    workshop.body("base", hub, cylinder(_COLUMN, (0, 0, level), (0, 0, column)))
    count = values.count("castors")
    for k in range(count):
        _add_castor(values, workshop, k + 1, 2.0 * math.pi * k / count, level)
    _add_seat(values, workshop, _add_spring(values, workshop, level, column))


def _add_castor(values: Values, workshop: Workshop, number: int, angle: float, level: float) -> None:
    """An arm of the star; under its end a fork on a stem that turns, and in the fork a wheel."""
    wheel, reach, clearance = values.number("wheel"), values.number("star"), values.number("clearance")
    cosine, sine = math.cos(angle), math.sin(angle)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    place = at(turn @ (0.0, -reach, 0.0), turn)
    arm = hull(
        cylinder(0.022, (0, reach, level), (0, reach, level + 0.045), segments=24),
        cylinder(0.016, (0, 0, level), (0, 0, level + 0.03), segments=24),
    )
    workshop.add("base", arm.transform(place))
    workshop.cut("base", bore(STEM, clearance, (0, 0, level - 0.01), (0, 0, level + 0.024)).transform(place))
    axle = np.array([0.0, -0.4 * wheel, wheel])
    fork, roller = (solid.transform(place) for solid in castor(axle, level - clearance, wheel, clearance))
    workshop.body(f"castor_{number}", fork, material="metal")
    workshop.turns(f"castor_{number}", "base", (0, 0, 1), place[:, 3])
    workshop.body(f"wheel_{number}", roller, material="rubber")
    workshop.turns(f"wheel_{number}", f"castor_{number}", turn[:, 0], place @ (*axle, 1.0))


def _add_spring(values: Values, workshop: Workshop, level: float, column: float) -> float:
    """A rod that rises in the column, of eight sides that it may not turn; returns the level of what turns on it."""
    clearance = values.number("clearance")
    top = column + 0.012
    travel = min(0.1, 0.5 * values.number("column"))
    workshop.cut("base", bore(_SPRING, clearance, (0, 0, level + 0.01), (0, 0, column + 0.1), segments=_SIDES))
    boss, hole, rotor = stub((0, 0, top + 0.022), (0, 0, 1), 0.032, clearance, length=0.022)
    rod = cylinder(_SPRING, (0, 0, level + 0.014), (0, 0, top + 0.001), segments=_SIDES)
    workshop.body("lift", rod, boss, material="steel")
    workshop.cut("lift", hole)
    workshop.slides("lift", "base", (0, 0, 1), (0, 0, column), (0.0, travel), rest=values.number("open"))
    workshop.body("seat", rotor)
    workshop.turns("seat", "lift", (0, 0, 1), (0, 0, top + 0.022))
    return top + 0.044 + clearance


def _add_seat(values: Values, workshop: Workshop, level: float) -> None:
    """A cushion on a plate, and behind it a bracket with the backrest."""
    width, depth, clearance = values.number("width"), values.number("depth"), values.number("clearance")
    behind = 0.5 * depth + 0.05
    places = [(sx * (0.5 * width - 0.05), sy * (0.5 * depth - 0.05)) for sx in (-1, 1) for sy in (-1, 1)]
    cushion = [cylinder(0.05, (*xy, level + 0.02), (*xy, level + _SEAT), segments=24) for xy in places]
    plate = box((-0.1, -0.12, level - 0.01), (0.1, 0.12, level + 0.021))
    bracket = box((-0.03, 0.1, level - 0.01), (0.03, behind + _FORK[1], level + 0.012))
    pivot = (0.0, behind, level + 0.012 + 2.0 * _FORK[1])
    forked, tongue = bent_fork(pivot, (0.0, 0.0), _FORK[0], _FORK[1], clearance)
    workshop.add("seat", plate, bracket, forked, hull(*cushion))
    if values.choice("armrests") == "armrests":
        workshop.add("seat", *(solid for s in (-1, 1) for solid in _armrest(s * (0.5 * width + 0.02), level)))
    high = values.number("back")
    low = level + _SEAT + 0.05
    rail = box((-0.025, behind - 0.01, pivot[2] + 0.02), (0.025, behind + 0.01, low + 0.5 * high))
    wide = 0.5 * width - 0.05
    rest = [
        rod(0.02, (s * wide, behind - 0.015, z), (0.6 * s * wide, behind + 0.002, z))
        for s in (-1, 1)
        for z in (low + 0.02, low + high - 0.02)
    ]
    workshop.body("back", tongue, rail, hull(*rest))
    workshop.turns("back", "seat", (-1, 0, 0), pivot, (0.0, 0.45), rest=values.number("open"))


def _armrest(x: float, level: float) -> list[Manifold]:
    """A bow beside the cushion with a pad on it."""
    low, high = level + 0.03, level + _SEAT + 0.19
    inner = -0.06 if x > 0 else 0.06
    return [
        rod(0.012, (x + inner, 0.0, low), (x, 0.0, low)),
        rod(0.012, (x, 0.0, low), (x, 0.0, high)),
        hull(rod(0.018, (x, -0.11, high), (x, 0.1, high)), rod(0.018, (x, -0.11, high + 0.01), (x, 0.1, high + 0.01))),
    ]


FAMILY = family("office_chair", _build)
