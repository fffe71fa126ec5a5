"""Fans: blades that turn without end, in a cage on a stand, under a ceiling or in a box."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import at, bent_fork, stub
from kinematify.generate.procedural.pieces.controls import FRONT, TOP, Mount, add_button, add_knob
from kinematify.generate.procedural.solids import box, cylinder, hull, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_DOWN = np.diag([1.0, -1.0, -1.0])
_PITCH = 16.0  # of the blades [deg]
_FLANGE = 0.014  # of the rotor [m]
_WIRE = 0.004  # thickness of the cage's rods [m]
_SPOKES = 12
_FORK = (0.036, 0.013)  # width and radius of the hinge that a head tilts on [m]


def _build(values: Values, workshop: Workshop) -> None:
    {"stand": _on_stand, "ceiling": _under_ceiling, "box": _in_box}[values.choice("kind")](values, workshop)


# What turns is built about z with its bearing in z = 0, and then brought to its place.


def _blades(values: Values, radius: float) -> tuple[float, float, float]:
    """Width of a blade, the level of its middle, and how far the rotor reaches outwards [m]."""
    clearance = values.number("clearance")
    wide = min(0.5 * radius, 2.4 * radius / values.count("blades"))
    level = 0.006 + 0.5 * wide * math.sin(math.radians(_PITCH)) + clearance
    return wide, level, max(2.0 * level - 0.004, _FLANGE + clearance)


def _add_rotor(values: Values, workshop: Workshop, parent: str, place: FloatArray, radius: float) -> None:
    """Add boss, hole and rotor."""
    clearance, count = values.number("clearance"), values.count("blades")
    hub = min(0.2 * radius, 0.06)
    boss, hole, rotor = stub((0, 0, 0), (0, 0, 1), hub, clearance, length=_FLANGE)
    wide, level, front = _blades(values, radius)
    root, tip = (0.2 * radius, 0.25 * wide), (radius - 0.5 * wide, 0.5 * wide)
    ends = [cylinder(r, (x, 0, -0.0015), (x, 0, 0.0015), segments=24) for x, r in (root, tip)]
    blade = (hull(*ends) + box((0, -root[1], -0.0015), (root[0], root[1], 0.0015))).rotate((_PITCH, 0, 0))
    blades = [blade.translate((0, 0, level)).rotate((0, 0, 360.0 * k / count)) for k in range(count)]
    cap = cylinder(0.9 * hub, (0, 0, clearance + 1e-3), (0, 0, front))
    workshop.add(parent, boss.transform(place))
    workshop.cut(parent, hole.transform(place))
    workshop.body("rotor", union(rotor, cap, *blades).transform(place))
    workshop.turns("rotor", parent, place[:, 2], place[:, 3])


def _cage(radius: float, motor: float, front: float) -> Manifold:
    """Rods behind and before the blades, and a rim around them."""
    outer, back = radius + 0.012, -0.002 - _WIRE
    top = front + 0.008
    rim = cylinder(outer + _WIRE, (0, 0, back), (0, 0, top + _WIRE)) - cylinder(outer, (0, 0, -1), (0, 0, 1))
    rods = []
    for k in range(_SPOKES):
        for start, level in ((0.6 * motor, back), (0.0, top)):
            rod = box((start, -0.5 * _WIRE, level), (outer + 0.5 * _WIRE, 0.5 * _WIRE, level + _WIRE))
            rods.append(rod.rotate((0, 0, 360.0 * k / _SPOKES)))
    rods.append(cylinder(0.7 * motor, (0, 0, top), (0, 0, top + 1.5 * _WIRE)))
    return union(rim, *rods)


def _on_stand(values: Values, workshop: Workshop) -> None:
    """A foot with a post; a yoke that swings on it, and in the yoke a head that tilts."""
    radius, clearance, rest = 0.5 * values.number("diameter"), values.number("clearance"), values.number("open")
    foot, motor = 0.07 + 0.5 * radius, max(0.032, 0.22 * radius)
    lift = motor + 0.028
    axle = max(values.number("height") - radius - 0.016, 1.2 * radius + 0.09, lift + 0.11)  # else it nods onto the foot
    tilt = np.array([0.0, 0.0, axle - lift])
    swing = (0.0, 0.0, tilt[2] - 0.042)
    workshop.body("base", cylinder(foot, (0, 0, 0), (0, 0, 0.025)), cylinder(0.014, (0, 0, 0.02), swing))
    boss, hole, rotor = stub(swing, (0, 0, 1), 0.018, clearance, length=0.015)
    workshop.add("base", boss)
    workshop.cut("base", hole)
    forked, tongue = bent_fork(tilt, (0.0, 0.0), _FORK[0], _FORK[1], clearance)
    workshop.body("yoke", rotor, forked)
    workshop.turns("yoke", "base", (0, 0, 1), swing, (-0.8, 0.8), rest=rest)
    front = -0.5 * radius - 0.03
    housing = cylinder(motor, (0, 0.03, axle), (0, front, axle))
    neck = box((-0.008, -0.01, tilt[2] + 0.015), (0.008, 0.01, axle))
    workshop.body("head", tongue, neck, housing)
    workshop.turns("head", "yoke", (-1, 0, 0), tilt, (-0.3, 0.3), rest=rest)
    place = at((0, front, axle), FRONT)
    _add_rotor(values, workshop, "head", place, radius)
    workshop.add("head", _cage(radius, motor, _blades(values, radius)[2]).transform(place))
    _add_controls(values, workshop, (0.0, -0.6 * foot, 0.025), 0.018)


def _under_ceiling(values: Values, workshop: Workshop) -> None:
    """A canopy, a rod and a motor with the rotor below."""
    radius, height = 0.5 * values.number("span"), values.number("height")
    level = _blades(values, radius)[2] + 0.004
    workshop.body(
        "base",
        cylinder(0.075, (0, 0, height - 0.05), (0, 0, height)),
        cylinder(0.012, (0, 0, level), (0, 0, height - 0.04)),
        cylinder(0.09, (0, 0, level), (0, 0, level + 0.09)),
    )
    _add_rotor(values, workshop, "base", at((0, 0, level), _DOWN), radius)
    workshop.add("rotor", cylinder(0.02, (0, 0, 0), (0, 0, 0.005)))


def _in_box(values: Values, workshop: Workshop) -> None:
    """A square duct with bars behind and in front of the blades."""
    radius = 0.5 * values.number("diameter")
    half, motor, back = radius + 0.03, max(0.03, 0.22 * radius), 0.06
    centre = (0.0, back, half)
    workshop.body("base", cylinder(motor, (0, back + 0.03, half), centre))
    _add_rotor(values, workshop, "base", at(centre, FRONT), radius)
    front = back - _blades(values, radius)[2] - 0.02
    duct = box((-half, front, 0), (half, back + 0.05, 2 * half))
    duct -= box((0.012 - half, -1.0, 0.012), (half - 0.012, 1.0, 2 * half - 0.012))
    bars = []
    for share in np.linspace(-0.8, 0.8, 9):
        x = share * half
        bars.append(box((x - 0.003, front, 0.005), (x + 0.003, front + 0.006, 2 * half - 0.005)))
        bars.append(box((x - 0.003, back + 0.01, 0.005), (x + 0.003, back + 0.018, 2 * half - 0.005)))
    bars.append(box((0.005 - half, back + 0.01, half - 0.004), (half - 0.005, back + 0.018, half + 0.004)))
    workshop.add("base", duct, *bars)
    _add_controls(values, workshop, (0.0, back + 0.03, 2.0 * half), 0.009)


def _add_controls(values: Values, workshop: Workshop, place: tuple[float, float, float], depth: float) -> None:
    """Buttons in a row, or a knob, on top of the base."""
    count, clearance = values.count("buttons"), values.number("clearance")
    for k in range(max(count, 1)):
        where = (place[0] + 0.021 * (k - 0.5 * (max(count, 1) - 1)), *place[1:])
        mount = Mount(parent="base", place=where, face=TOP, clearance=clearance, depth=depth)
        if count:
            add_button(workshop, f"button_{k + 1}", mount, (0.013, 0.012), travel=0.003)
        else:
            add_knob(workshop, "knob", mount, 0.016, rest=values.number("open"))


FAMILY = family("fan", _build)
