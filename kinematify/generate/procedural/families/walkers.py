"""Robots with legs or a body of many joints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import at, fork, room, stub
from kinematify.generate.procedural.solids import ball, box, cylinder, hull, off, rod, union

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.solids import Point
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray


_ROD_SIDES = 20  # of rods; a robot has many


def leg_solids(
    hip: FloatArray, side: tuple[int, int], radius: float, lengths: tuple[float, float], clearance: float
) -> tuple[Manifold, Manifold, dict[str, Manifold], tuple[FloatArray, FloatArray, FloatArray]]:
    """Build a straight leg that hangs down from `hip`: hip roll about x, thigh and shank about y.

    Args:
        hip: Where the hip's stub leaves the trunk [m], shape (3,).
        side: Signs of x (front) and y (left) of the leg's place.
        radius: Of the stubs [m].
        lengths: Of thigh and shank [m].
        clearance: Between parts that turn on each other [m].

    Returns:
        Boss and hole for the trunk, the three links, and the three pivots [m], shape (3,) each.
    """
    sx, sy = side
    boss, hole, rotor = stub(hip, (sx, 0, 0), radius, clearance)
    flange, end = sx * (radius + clearance), sx * (2 * radius + clearance)
    pitch_at = off(hip, end, sy * 2.2 * radius, 0)
    limb = limb_solids(pitch_at, sy, radius, lengths, clearance)
    bridge = limb.boss + rod(0.8 * radius, off(hip, flange, 0, 0), off(hip, end, 0, 0), segments=_ROD_SIDES)
    upper = union(rotor, beyond(bridge, off(hip, sx * clearance, 0, 0), (sx, 0, 0))) - limb.hole
    links = {"hip": upper, "thigh": limb.upper, "shank": limb.lower}
    return boss, hole, links, (hip, pitch_at, limb.knee)


@dataclass(frozen=True, kw_only=True)
class Limb:
    """A straight limb of two links that hangs down and turns about y."""

    boss: Manifold
    """What carries it, at the upper pivot."""
    hole: Manifold
    """To be taken away when the boss has become one with its body."""
    upper: Manifold
    lower: Manifold
    knee: FloatArray
    """Pivot between both links [m], shape (3,)."""
    end: FloatArray
    """Middle of the lower link's round end [m], shape (3,)."""


def limb_solids(pivot: FloatArray, sy: int, radius: float, lengths: tuple[float, float], clearance: float) -> Limb:
    """Build a limb on the side `sy` of y of its boss; arguments as for `leg_solids`."""
    boss, hole, rotor = stub(pivot, (0, sy, 0), radius, clearance, length=2 * radius)
    top = off(pivot, 0, sy * (radius + clearance), 0)
    knee = off(top, 0, -sy * radius, -lengths[0])
    knee_boss, knee_hole, knee_rotor = stub(knee, (0, -sy, 0), 0.8 * radius, clearance, length=1.6 * radius)
    upper = knee_boss + rod(0.7 * radius, top, off(top, 0, 0, -lengths[0]), segments=_ROD_SIDES)
    ankle = off(knee, 0, -sy * (0.8 * radius + clearance), 0)
    end = off(ankle, 0, 0, -lengths[1])
    lower = rod(0.5 * radius, ankle, end, segments=_ROD_SIDES)
    return Limb(
        boss=boss,
        hole=hole,
        upper=union(rotor, beyond(upper, knee, (0, sy, 0))) - knee_hole,
        lower=union(knee_rotor, beyond(lower, off(knee, 0, -sy * clearance, 0), (0, -sy, 0))),
        knee=knee,
        end=end,
    )


def beyond(solid: Manifold, point: Point, direction: tuple[int, int, int]) -> Manifold:
    """Return what lies on the far side of the plane through `point` across `direction`."""
    return solid.trim_by_plane(direction, float(np.dot(direction, point)))


_LEGS = {"front_left": (1, 1), "front_right": (1, -1), "rear_left": (-1, 1), "rear_right": (-1, -1)}


def build_quadruped(values: Values, workshop: Workshop) -> None:
    """Robots on four legs: a trunk and legs of two or three joints on flanged stubs."""
    half, wide, radius = 0.5 * values.number("length"), 0.5 * values.number("width"), values.number("joint_radius")
    lengths = values.number("thigh"), values.number("shank")
    high = lengths[0] + lengths[1] + 0.5 * radius
    workshop.body(
        "trunk",
        box((-half, -wide, high - 1.3 * radius), (half, wide, high + 1.7 * radius)),
        box((half - 0.05, -0.03, high + radius), (half + 0.03, 0.03, high + 2.7 * radius)),
    )
    for leg, side in _LEGS.items():
        hip = np.array([side[0] * (half + 0.02), side[1] * (wide - radius), high])
        boss, hole, links, pivots = leg_solids(hip, side, radius, lengths, values.number("clearance"))
        workshop.add("trunk", boss)
        workshop.cut("trunk", hole)
        _add_quadruped_leg(
            workshop, leg, links, pivots, side, radius=radius, swings=_swings(values), three=values.count("joints") > 2
        )


def _swings(values: Values) -> tuple[float, float, float]:
    """How far hips roll inwards, and thighs and shanks swing, until two legs could meet [rad]."""
    shank = values.number("shank")
    leg = values.number("thigh") + shank
    beside = 0.5 * values.number("width")  # from the hip to half the way to the other side
    between = values.number("length") + 0.04  # of the legs in front and behind
    thigh = math.asin(min(math.sin(0.8), between / leg))
    return min(0.2, beside / leg), thigh, math.asin(min(math.sin(1.2), between / shank))


def _add_quadruped_leg(
    workshop: Workshop,
    leg: str,
    links: Mapping[str, Manifold],
    pivots: Sequence[FloatArray],
    side: tuple[int, int],
    *,
    radius: float,
    swings: tuple[float, float, float],
    three: bool,
) -> None:
    above, (roll, thigh, shank) = "trunk", swings
    if three:
        workshop.body(f"{leg}_hip", links["hip"])
        workshop.turns(f"{leg}_hip", "trunk", (1, 0, 0), pivots[0], (-roll, 0.5) if side[1] > 0 else (-0.5, roll))
        above = f"{leg}_hip"
    else:
        hip = pivots[0]
        workshop.add("trunk", links["hip"], cylinder(radius, off(hip, -radius, 0, 0), off(hip, radius, 0, 0)))
    workshop.body(f"{leg}_thigh", links["thigh"])
    workshop.turns(f"{leg}_thigh", above, (0, 1, 0), pivots[1], (-thigh, thigh))
    workshop.body(f"{leg}_shank", links["shank"])
    workshop.turns(f"{leg}_shank", f"{leg}_thigh", (0, 1, 0), pivots[2], (-shank, shank))


_OUTWARDS = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
"""Turns a leg that hangs down, its first joint along x, so that it reaches out along x, that joint upright."""


def build_hexapod(values: Values, workshop: Workshop) -> None:
    """Robots on six legs, or four to eight, that stand around a round trunk."""
    radius, clearance, count = values.number("joint_radius"), values.number("clearance"), values.count("legs")
    lengths = values.number("femur"), values.number("tibia")
    high = lengths[1] - 1.5 * radius - clearance  # of the pivots in the trunk, so that the feet stand on the floor
    ring = max(0.5 * values.number("trunk"), 3.5 * radius / math.sin(math.pi / count))  # else coxae meet
    plate = (0, 0, high - 1.4 * radius), (0, 0, high - 0.2 * radius)
    workshop.body(
        "trunk",
        cylinder(ring + 0.4 * radius, *plate),
        ball(0.5 * ring, (0, 0, high - 0.2 * radius)).trim_by_plane((0, 0, 1), high - radius),
    )
    for k in range(count):
        angle = 2.0 * math.pi * (k + 0.5) / count
        cosine, sine = math.cos(angle), math.sin(angle)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        place = at((ring * cosine, ring * sine, high), turn @ _OUTWARDS)
        _add_hexapod_leg(values, workshop, f"leg_{k + 1}", place)


def _add_hexapod_leg(values: Values, workshop: Workshop, leg: str, place: FloatArray) -> None:
    """A coxa on an upright joint, a femur that reaches out and a tibia that reaches down."""
    radius, clearance = values.number("joint_radius"), values.number("clearance")
    lengths = values.number("femur"), values.number("tibia")
    boss, hole, links, pivots = leg_solids(np.zeros(3), (1, 1), radius, lengths, clearance)
    knee = pivots[2]
    links["shank"] = links["shank"].translate(-knee).rotate((0, 90, 0)).translate(knee)
    coxa, femur, tibia = (links[name].transform(place) for name in ("hip", "thigh", "shank"))
    upright, *others = (place @ (*pivot, 1.0) for pivot in pivots)
    workshop.add("trunk", boss.transform(place))
    workshop.cut("trunk", hole.transform(place))
    above, across = "trunk", -place[:, 1]
    if values.count("joints") > 2:
        above = f"{leg}_coxa"
        workshop.body(above, coxa)
        workshop.turns(above, "trunk", (0, 0, 1), upright, (-0.3, 0.3))
    else:
        workshop.add("trunk", coxa, cylinder(radius, off(upright, 0, 0, -radius), off(upright, 0, 0, radius)))
    workshop.body(f"{leg}_femur", femur)
    workshop.turns(f"{leg}_femur", above, across, others[0], (-0.3, 0.8))
    workshop.body(f"{leg}_tibia", tibia)
    workshop.turns(f"{leg}_tibia", f"{leg}_femur", across, others[1], (-0.35, 0.9))


_SIDES = {"left": 1, "right": -1}
_SOLE = 1.6  # of the ankles over the floor, in joint radii


def build_humanoid(values: Values, workshop: Workshop) -> None:
    """Robots with legs, arms and a head. They look along x, as robots do."""
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
        _add_humanoid_leg(values, workshop, name, sy, np.array([back, sy * wide, hip]))
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


def _add_humanoid_leg(values: Values, workshop: Workshop, name: str, sy: int, hip: FloatArray) -> None:
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


_SIZE = 0.45
"""Radius of a hinge beside that of the body."""


def build_snake(values: Values, workshop: Workshop) -> None:
    """Snake robots: segments on hinges that turn about the upright and across it in turn."""
    segments, radius, length = values.count("segments"), values.number("radius"), values.number("segment")
    clearance = min(values.number("clearance"), 0.03 * radius)
    size = _SIZE * radius
    space = room(size, clearance)
    length = max(length, 8.0 * size)
    for k in range(segments):
        start, end = k * length, (k + 1) * length
        first, last = k == 0, k + 1 == segments
        name = f"segment_{k + 1}"
        body = cylinder(
            radius, (start + (0.0 if first else 1.6 * space + 0.5 * radius), 0, radius),
            (end - (0.0 if last else 1.6 * space + 0.5 * radius), 0, radius),
        )  # fmt: skip
        workshop.body(name, body)
        if not first:
            _hinge(workshop, k, start, radius, clearance)
    workshop.add("segment_1", rod(0.8 * radius, (0, 0, radius), (-0.6 * radius, 0, radius)))


def _hinge(workshop: Workshop, k: int, x: float, radius: float, clearance: float) -> None:
    """Join segment k to segment k + 1 at x: a fork on the one, a tongue on the other."""
    upright, size = k % 2 == 0, _SIZE * radius
    forked, tongue = fork(1.6 * radius, size, clearance, 1.8 * size + 0.9 * radius)
    # The fork reaches down along -z and turns about x: lay it along x, its pin across or upright.
    lay = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    if upright:
        lay = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
    place = np.column_stack([lay, (x, 0.0, radius)])
    reach = tongue.transform(place)
    workshop.add(f"segment_{k}", forked.transform(place))
    workshop.add(f"segment_{k + 1}", reach)
    axis = (0, 0, 1) if upright else (0, 1, 0)
    workshop.turns(f"segment_{k + 1}", f"segment_{k}", axis, (x, 0, radius), (-0.7, 0.7))
