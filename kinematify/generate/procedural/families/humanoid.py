"""Robots with legs, arms and a head. They look along x, as robots do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.pieces.limbs import leg_solids, limb_solids
from kinematify.generate.procedural.solids import ball, box, cylinder, hull, off, rod

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_SIDES = {"left": 1, "right": -1}
_SOLE = 1.6  # of the ankles over the floor, in joint radii


def _build(values: Values, workshop: Workshop) -> None:
    radius, clearance = values.number("joint_radius"), values.number("clearance")
    hip = values.number("thigh") + values.number("shank") + (_SOLE if values.choice("feet") == "feet" else 0.5) * radius
    wide = 1.6 * radius
    back = -2.0 * radius - clearance  # front of the pelvis; the legs hang before it, under its upper plate
    top = hip + 3.6 * radius
    workshop.body(
        "pelvis",
        box((back - 2.0 * radius, -wide - radius, hip - 1.2 * radius), (back, wide + radius, top)),
        box((back - 2.0 * radius, -wide - 0.5 * radius, top - 0.8 * radius), (2.0 * radius, wide + 0.5 * radius, top)),
    )
    for name, sy in _SIDES.items():
        _add_leg(values, workshop, name, sy, np.array([back, sy * wide, hip]))
    _add_torso(values, workshop, top)


def _roll(values: Values) -> tuple[float, float]:
    """How far a leg rolls inwards until it meets the other one, and outwards until it meets a hand [rad]."""
    radius, clearance = values.number("joint_radius"), values.number("clearance")
    inwards = min(0.1, 2.2 * radius / (values.number("thigh") + values.number("shank")))
    room = _shoulder(values) - 7.4 * radius - 2.0 * clearance
    arm = values.number("upper_arm") + values.number("forearm") + 5.0 * radius
    below = arm - values.number("torso") - 2.2 * radius  # a hand under the hip
    return inwards, 0.4 if below <= 0.0 else min(0.4, 0.9 * room / (below + radius))


def _shoulder(values: Values) -> float:
    """Half the distance of the shoulders' pivots [m]."""
    return max(0.5 * values.number("shoulders"), 8.5 * values.number("joint_radius"))


def _add_leg(values: Values, workshop: Workshop, name: str, sy: int, hip: FloatArray) -> None:
    """Hip, thigh and shank, and a foot."""
    radius, clearance = values.number("joint_radius"), values.number("clearance")
    lengths = values.number("thigh"), values.number("shank")
    boss, hole, links, pivots = leg_solids(hip, (1, sy), radius, lengths, clearance)
    workshop.add("pelvis", boss)
    workshop.cut("pelvis", hole)
    workshop.body(f"{name}_hip", links["hip"])
    inwards, outwards = _roll(values)
    limits = (-inwards, outwards) if sy > 0 else (-outwards, inwards)
    workshop.turns(f"{name}_hip", "pelvis", (1, 0, 0), pivots[0], limits)
    workshop.body(f"{name}_thigh", links["thigh"])
    workshop.turns(f"{name}_thigh", f"{name}_hip", (0, -1, 0), pivots[1], (-0.6, 1.2))
    workshop.body(f"{name}_shank", links["shank"])
    workshop.turns(f"{name}_shank", f"{name}_thigh", (0, 1, 0), pivots[2], (0.0, 1.8))
    if values.choice("feet") == "feet":
        _add_foot(values, workshop, name, sy, off(pivots[2], 0, -sy * (0.8 * radius + clearance), -lengths[1]))


def _add_foot(values: Values, workshop: Workshop, name: str, sy: int, ankle: FloatArray) -> None:
    """A sole beside the end of a shank, on a stub through it."""
    radius, clearance = values.number("joint_radius"), values.number("clearance")
    small = 0.6 * radius
    pivot = off(ankle, 0, sy * small, 0)
    boss, hole, rotor = stub(pivot, (0, sy, 0), small, clearance, length=2.0 * small)
    workshop.add(f"{name}_shank", boss)
    workshop.cut(f"{name}_shank", hole)
    outer = pivot[1] + sy * (2.0 * small + clearance)
    inner = pivot[1] + sy * (0.4 * small + clearance)
    strut = _between((-0.5 * radius, 0.2 * radius), (0.5 * radius, ankle[2]), inner, outer)
    sole = _between((-2.2 * radius, 0.0), (4.2 * radius, 0.4 * radius), ankle[1] - sy * 1.2 * radius, outer)
    workshop.body(f"{name}_foot", rotor, strut, sole, material="rubber")
    workshop.turns(f"{name}_foot", f"{name}_shank", (0, 1, 0), pivot, (-0.5, 0.5))


def _between(lower: tuple[float, float], upper: tuple[float, float], one: float, other: float) -> Manifold:
    """A block from x and z to x and z, between two y in any order."""
    y0, y1 = sorted((one, other))
    return box((lower[0], y0, lower[1]), (upper[0], y1, upper[1]))


def _add_torso(values: Values, workshop: Workshop, level: float) -> None:
    """A torso that turns on the pelvis, its head and its arms."""
    radius, clearance, tall = values.number("joint_radius"), values.number("clearance"), values.number("torso")
    half = _shoulder(values)
    waist, x = (-radius, 0.0, level), -radius
    boss, hole, rotor = stub(waist, (0, 0, 1), 1.6 * radius, clearance, length=radius)
    workshop.add("pelvis", boss)
    workshop.cut("pelvis", hole)
    low, high = level + 1.5 * radius, level + tall
    side = half - 3.2 * radius
    trunk = hull(
        box((x - 1.5 * radius, -0.6 * side, low - 0.7 * radius), (x + 1.5 * radius, 0.6 * side, low)),
        box((x - 2.0 * radius, -side, high - 0.5 * tall), (x + 2.2 * radius, side, high)),
    )
    workshop.body("torso", rotor, trunk)
    workshop.turns("torso", "pelvis", (0, 0, 1), waist, (-1.2, 1.2))
    _add_head(values, workshop, (x, 0.0, high))
    for name, sy in _SIDES.items():
        shoulder = np.array([x, sy * half, high - 1.4 * radius])
        workshop.add("torso", cylinder(radius, off(shoulder, 0, -sy * half, 0), shoulder))
        _add_arm(values, workshop, name, sy, shoulder)


def _add_head(values: Values, workshop: Workshop, neck: tuple[float, float, float]) -> None:
    radius, clearance = values.number("joint_radius"), values.number("clearance")
    pivot = off(neck, 0, 0, radius)
    boss, hole, rotor = stub(pivot, (0, 0, 1), radius, clearance)
    workshop.add("torso", boss)
    workshop.cut("torso", hole)
    centre, size = off(pivot, 0.2 * radius, 0, 3.6 * radius), 2.0 * radius
    skull = hull(ball(size, centre), ball(0.7 * size, off(centre, 0.5 * size, 0, -0.6 * size)))
    eyes = [ball(0.18 * size, off(centre, 0.95 * size, s * 0.4 * size, 0.1 * size)) for s in (-1, 1)]
    workshop.body("head", rotor, cylinder(0.8 * radius, off(pivot, 0, 0, 0.5 * radius), centre), skull, *eyes)
    workshop.turns("head", "torso", (0, 0, 1), pivot, (-1.2, 1.2))


def _add_arm(values: Values, workshop: Workshop, name: str, sy: int, shoulder: FloatArray) -> None:
    """Upper arm, forearm and a hand that turns about the forearm."""
    radius, clearance = values.number("joint_radius"), values.number("clearance")
    lengths = values.number("upper_arm"), values.number("forearm")
    limb = limb_solids(shoulder, sy, radius, lengths, clearance)
    workshop.add("torso", limb.boss)
    workshop.cut("torso", limb.hole)
    workshop.body(f"{name}_upper_arm", limb.upper)
    workshop.turns(f"{name}_upper_arm", "torso", (0, -1, 0), shoulder, (-0.8, 2.6))
    workshop.body(f"{name}_forearm", limb.lower)
    workshop.turns(f"{name}_forearm", f"{name}_upper_arm", (0, -1, 0), limb.knee, (0.0, 2.0))
    small, end = 0.6 * radius, off(limb.end, 0, 0, -0.6 * radius)
    palm = [off(end, 0, 0, -z * radius - clearance) for z in (1.0, 2.4)]
    hand = hull(*(rod(0.3 * radius, off(p, -0.6 * radius, 0, 0), off(p, 0.6 * radius, 0, 0)) for p in palm))
    thumb = rod(0.25 * radius, off(palm[0], 0.6 * radius, 0, 0), off(palm[1], 1.3 * radius, 0, 0.3 * radius))
    if values.choice("hands") == "fixed":
        workshop.add(f"{name}_forearm", hand, thumb, cylinder(small, limb.end, off(end, 0, 0, -radius)))
        return
    boss, hole, rotor = stub(end, (0, 0, -1), small, clearance, length=1.2 * small)
    workshop.add(f"{name}_forearm", boss)
    workshop.cut(f"{name}_forearm", hole)
    workshop.body(f"{name}_hand", rotor, hand, thumb)
    workshop.turns(f"{name}_hand", f"{name}_forearm", (0, 0, 1), end, (-1.4, 1.4))


FAMILY = family("humanoid", _build)
