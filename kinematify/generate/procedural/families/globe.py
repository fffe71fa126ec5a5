"""Globes: a ball that turns on an inclined axis in a meridian, which may turn on its foot."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.solids import ball, bore, cylinder, ring, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_FOOT = 0.014  # thickness of the foot [m]
_LATITUDES = (-40.0, 0.0, 40.0)  # of the raised lines [deg]


def _build(values: Values, workshop: Workshop) -> None:
    radius, clearance = 0.5 * values.number("diameter"), values.number("clearance")
    arc, pin = 0.02 * radius + 0.0025, 0.015 * radius + 0.0015
    reach = 1.03 * radius + 2.0 * clearance + arc + 0.004
    low, tilt = 2.0 * _FOOT + values.number("post"), values.number("tilt")
    level = low + reach
    carrier = _add_stand(values, workshop, low, arc)

    def tilted(*solids: Manifold) -> Manifold:
        return union(*solids).rotate((0, math.degrees(tilt), 0)).translate((0, 0, level))

    ends = [side * (1.02 * radius + clearance) for side in (-1.0, 1.0)]
    meridian = ring(reach, arc, 360.0 if values.choice("mount") == "ring" else 180.0)
    meridian = meridian.rotate((0, 0, -90.0)).rotate((90.0, 0, 0))  # in the x-z plane, on the side of +x
    wide = pin + clearance + 0.003
    bosses = [cylinder(wide, (0, 0, end), (0, 0, math.copysign(reach + arc + 0.002, end))) for end in ends]
    hole = bore(pin, clearance, (0, 0, -2.0 * reach), (0, 0, 2.0 * reach))
    workshop.add(carrier, tilted(union(meridian, *bosses) - hole))

    lines = [_latitude(radius, math.radians(angle)) for angle in _LATITUDES]
    hubs = [cylinder(wide, (0, 0, 0.9 * end), (0, 0, math.copysign(1.02 * radius, end))) for end in ends]
    tips = reach + arc + 0.004
    shaft = cylinder(pin, (0, 0, -tips), (0, 0, tips))
    workshop.body("ball", tilted(ball(radius, (0, 0, 0), segments=64), *lines, *hubs, shaft), color="blue")
    axis = (math.sin(tilt), 0, math.cos(tilt))
    workshop.turns("ball", carrier, axis, (0, 0, level))


def _add_stand(values: Values, workshop: Workshop, low: float, arc: float) -> str:
    """A foot and a post up to the meridian; returns the body that the post belongs to."""
    radius, clearance = 0.5 * values.number("diameter"), values.number("clearance")
    wide, start = 3.0 * arc, 1.5 * _FOOT
    workshop.body(
        "base",
        cylinder(0.62 * radius, (0, 0, 0), (0, 0, _FOOT), segments=64),
        cylinder(0.5 * radius, (0, 0, 0), (0, 0, start), segments=64),
    )
    if values.choice("foot") == "fixed":
        workshop.add("base", cylinder(0.5 * wide, (0, 0, _FOOT), (0, 0, low)))
        return "base"
    boss, hole, rotor = stub((0, 0, start + 0.01), (0, 0, 1), wide, clearance, length=0.012)
    workshop.add("base", boss)
    workshop.cut("base", hole)
    workshop.body("meridian", rotor, cylinder(0.5 * wide, (0, 0, start + 0.01 + clearance), (0, 0, low)))
    workshop.turns("meridian", "base", (0, 0, 1), (0, 0, start + 0.01))
    return "meridian"


def _latitude(radius: float, angle: float) -> Manifold:
    """A raised line around the ball."""
    return ring(radius * math.cos(angle), 0.008 * radius, sides=8).translate((0, 0, radius * math.sin(angle)))


FAMILY = family("globe", _build)
