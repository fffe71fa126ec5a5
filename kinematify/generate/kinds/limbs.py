"""Jaws, fingers, legs and tracks that several carved kinds share.

Jaws on a rail and fingers on pins around a palm stand on z = 0 of a frame and reach up; limbs hang down.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, radians, sin
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold

from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.pieces.bearing_pieces import fork, fork_room, stub
from kinematify.generate.procedural.solids import Point, X, Z, box, cylinder, hull, off, rod, slab, union, vector
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray

# ---- parallel jaws on a rail, and fingers on pins around a palm; both stand on z = 0 of a frame and reach up
_JAW_BAR = 0.006
_JAW_LEVEL = 0.095
_JAW_LONG = 0.016
_FINGER_HALF = 0.007
_KNUCKLE = 0.06


def jaw_rail(half: float) -> list[Manifold]:
    """Return a palm with a rail along x on which two jaws run, as far as `half` to either side."""
    return [
        slab(half + 0.012, 0.03, (0.04, 0.07)),
        cylinder(0.025, 0, 0.041),
        slab(half + 0.001, _JAW_BAR, (_JAW_LEVEL - _JAW_BAR, _JAW_LEVEL + _JAW_BAR)),
        *[slab((s * half, s * (half + 0.012)), 0.03, (0.069, _JAW_LEVEL + 2 * _JAW_BAR)) for s in (-1, 1)],
    ]


def finger_ring(fingers: int) -> float:
    """Return the radius on which so many fingers stand around a palm [m]."""
    return max(0.04, 0.02 * fingers)


def finger_palm(fingers: int) -> list[Manifold]:
    """Return a round palm with room for fingers around it."""
    return [cylinder(finger_ring(fingers) + _FINGER_HALF, 0.02, _KNUCKLE - 2 * _FINGER_HALF), cylinder(0.025, 0, 0.021)]


def jaws(
    w: ObjectBuilder,
    clearance: float,
    frame: FloatArray,
    palm: str,
    called: str,
    half: float,
    reach: float,
    rest: float,
) -> None:
    """Add two mirrored jaws, `called`_1 and `called`_2, that reach beyond the rail of a palm; zero is shut."""
    inner = _JAW_BAR + clearance
    slide = slab((clearance, _JAW_LONG), 0.02, (0.07 + clearance, _JAW_LEVEL + 3 * _JAW_BAR)) - slab(
        1, inner, (_JAW_LEVEL - inner, _JAW_LEVEL + inner)
    )
    jaw = slide + slab((clearance, 0.008), 0.008, (_JAW_LEVEL + 2.9 * _JAW_BAR, _JAW_LEVEL + reach))
    seen = w.from_frame(frame)
    for number, sign, solid in ((1, 1, jaw), (2, -1, jaw.mirror((1, 0, 0)))):
        seen.part(f"{called}_{number}", solid)
        seen.slide(
            f"{called}_{number}",
            palm,
            (sign, 0, 0),
            half - _JAW_LONG - clearance,
            pivot=(0, 0, _JAW_LEVEL),
            rest=rest * (half - _JAW_LONG - clearance),
        )


def fingered(
    w: ObjectBuilder,
    clearance: float,
    frame: FloatArray,
    palm: str,
    called: str,
    count: int,
    reach: float,
    rest: float,
    joints: int = 1,
) -> None:
    """Add fingers of so many joints each to a `finger_palm`; zero is straight, positive opens."""
    tight = min(clearance, 0.0008)
    wide = 0.02
    start = fork_room(_FINGER_HALF, tight)
    around = finger_ring(count)
    seen = w.from_frame(frame)
    for k in range(count):
        angle = 360.0 * k / count
        turn = rotation_about(Z, radians(angle))
        forked, tongue = [
            half.translate((0, -around, _KNUCKLE)).rotate((0, 0, angle))
            for half in fork(wide, _FINGER_HALF, tight, 2.2 * _FINGER_HALF)
        ]
        pitch, parent = reach / joints, palm
        for j in range(joints):
            end = pitch if j == joints - 1 else pitch - start
            blade = slab(0.5 * wide, _FINGER_HALF, (start, end))
            if j == joints - 1:
                blade += cylinder(_FINGER_HALF, (-0.5 * wide, 0.5 * wide), 0, end)
            name, up = f"{called}_{k + 1}" + (f"_{j + 1}" if j else ""), (0, 0, j * pitch)
            solids = forked, tongue, blade.translate((0, -around, _KNUCKLE)).rotate((0, 0, angle))
            forks, *link = [solid.translate(up) for solid in solids] if j else solids
            seen.part(parent, forks)
            seen.part(name, link)
            pivot = turn @ (0, -around, _KNUCKLE + j * pitch)
            seen.hinge(name, parent, turn @ X, pivot, 1.2, rest=rest * 1.2)
            parent = name


# ---- straight limbs that hang down


def beyond(solid: Manifold, point: Point, direction: Point) -> Manifold:
    """Return what lies on the far side of the plane through a point across a direction."""
    return solid.trim_by_plane(direction, np.array(direction) @ np.array(point))


def limb_solids(
    clearance: float, pivot: Point, sy: float, radius: float, lengths: Sequence[float]
) -> tuple[Manifold, Manifold, Manifold, Manifold, FloatArray, FloatArray]:
    """Return two links that turn about y, on the side `sy` of their boss: boss, hole, both links, knee and end."""
    boss, hole, rotor = stub(pivot, (0, sy, 0), radius, clearance, length=2 * radius)
    top = off(pivot, 0, sy * (radius + clearance), 0)
    knee = off(top, 0, -sy * radius, -lengths[0])
    knee_boss, knee_hole, knee_rotor = stub(knee, (0, -sy, 0), 0.8 * radius, clearance, length=1.6 * radius)
    stem = knee_boss + rod(0.7 * radius, top, off(top, 0, 0, -lengths[0]), segments=20)
    ankle = off(knee, 0, -sy * (0.8 * radius + clearance), 0)
    end = off(ankle, 0, 0, -lengths[1])
    shank = rod(0.5 * radius, ankle, end, segments=20)
    upper = union(rotor, beyond(stem, knee, (0, sy, 0))) - knee_hole
    lower = union(knee_rotor, beyond(shank, off(knee, 0, -sy * clearance, 0), (0, -sy, 0)))
    return boss, hole, upper, lower, knee, end


def leg_solids(
    clearance: float, hip: Point, side: tuple[int, int], radius: float, lengths: Sequence[float]
) -> tuple[Manifold, Manifold, dict[str, Manifold], tuple[Point, FloatArray, FloatArray]]:
    """Return a leg that also rolls about x at the hip: boss, hole, links by name, and pivots.

    `side` has the signs of x (front) and y (left) of its place.
    """
    sx, sy = side
    boss, hole, rotor = stub(hip, (sx, 0, 0), radius, clearance)
    flange = sx * (radius + clearance)
    end = sx * (2 * radius + clearance)
    pitch_at = off(hip, end, sy * 2.2 * radius, 0)
    its_boss, its_hole, thigh, shank, knee, _ = limb_solids(clearance, pitch_at, sy, radius, lengths)
    bridge = its_boss + rod(0.8 * radius, off(hip, flange, 0, 0), off(hip, end, 0, 0), segments=20)
    upper = union(rotor, beyond(bridge, off(hip, sx * clearance, 0, 0), (sx, 0, 0))) - its_hole
    return boss, hole, {"hip": upper, "thigh": thigh, "shank": shank}, (hip, pitch_at, knee)


# ---- undercarriages on two tracks


def track_ring(length: float, width: float) -> float:
    """Return the radius of the ring between an undercarriage and its body [m]."""
    return 0.2 * min(width, length)


def track_level(length: float) -> float:
    """Return the height at which that ring begins [m]."""
    return 1.3 * 0.22 * length


def track_top(clearance: float, length: float, width: float) -> float:
    """Return the height at which the body begins [m]."""
    return track_level(length) + clearance + 0.5 * track_ring(length, width)


def tracked(w: ObjectBuilder, clearance: float, called: str, length: float, width: float, wheels: int) -> None:
    """Add an undercarriage as the base, with `wheels` that turn on the outside of each track."""
    belt = 0.24 * width
    high = 0.22 * length
    half = 0.5 * width
    round_ = 0.46 * high
    run = 0.5 * length - 0.5 * high
    cleat = 0.04 * high
    cross = slab(half - 0.5 * belt, 0.3 * length, (0.35 * high, 0.9 * high))

    def belt_of(x: float) -> list[Manifold]:
        return [
            hull(*[cylinder(round_, (x - 0.5 * belt, x + 0.5 * belt), y, 0.5 * high) for y in (-run, run)]),
            *[
                box((x - 0.5 * belt, y - cleat, z0), (x + 0.5 * belt, y + cleat, z1))
                for y in np.linspace(-run, run, 9)
                for z0, z1 in ((0.0, 0.1 * high), (0.9 * high, high))
            ],
        ]

    radius = min(0.36 * high, 0.32 * length / max(wheels, 1))
    places = np.linspace(-0.5, 0.5, wheels) * (length - high) if wheels > 1 else np.zeros(wheels)
    w.part(called, cross, [belt_of(s * (half - 0.5 * belt)) for s in (-1, 1)])
    for side, s in (("left", -1), ("right", 1)):
        for k, y in enumerate(places):
            pivot = vector(s * half, y, 0.5 * high)
            _, hole, rotor = stub(pivot, (s, 0, 0), radius, min(clearance, 0.1 * radius), length=0.5 * radius)

            spots = [
                off(pivot, s * 0.4 * radius, 0.65 * radius * cos(0.4 * pi * n), 0.65 * radius * sin(0.4 * pi * n))
                for n in range(5)
            ]
            nuts = [cylinder(0.12 * radius, spot, off(spot, s * 0.3 * radius, 0, 0), segments=6) for spot in spots]
            w.cut(called, hole)
            w.part(f"{side}_wheel_{k + 1}", rotor, nuts, look="steel")
            w.spin(f"{side}_wheel_{k + 1}", called, (s, 0, 0), pivot)


def turntable(w: ObjectBuilder, clearance: float, called: str, parent: str, length: float, width: float) -> None:
    """Add the ring that turns on an undercarriage without end; its body follows above the `track_top`."""
    ring_ = track_ring(length, width)
    pivot = (0.0, 0.0, track_level(length))
    boss, hole, rotor = stub(pivot, (0, 0, 1), ring_, clearance, length=0.5 * ring_)
    w.part(parent, boss, cylinder(ring_, (0, 0, 0.6 * 0.22 * length), pivot))
    w.cut(parent, hole)
    w.part(called, rotor)
    w.spin(called, parent, Z, pivot)
