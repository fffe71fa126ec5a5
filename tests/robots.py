"""Mechanisms and robots with known joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearing_pieces import fork, fork_room, stub
from kinematify.generate.procedural.solids import bore, box, cylinder, off, union
from tests.known import KnownJoint, KnownObject, known_object, moved, sliding, turning, varied

if TYPE_CHECKING:
    from manifold3d import Manifold

UP = np.array([0.0, 0.0, 1.0])


def beyond(solid: Manifold, point: np.ndarray, direction: tuple[int, int, int]) -> Manifold:
    """What lies on the far side of the plane through `point` across `direction`."""
    return solid.trim_by_plane(direction, float(np.dot(direction, point)))


def wheel(*, radius: float = 0.1, clearance: float = 3e-4, seed: int | None = None) -> KnownObject:
    """A wheel with five holes on the axle of a block; a cap keeps it there."""
    vary = varied(seed)
    size, wide, pin = vary(radius), vary(0.04), vary(0.012)
    start, end = clearance, clearance + wide
    block = box((-1.2 * size, -0.12, -0.05), (1.5 * size, 0, 0.05))
    axle = cylinder(pin, (0, -0.02, 0), (0, end + 2 * clearance, 0))
    cap = cylinder(1.6 * pin, (0, end + clearance, 0), (0, end + clearance + 0.005, 0))
    disc = cylinder(size, (0, start, 0), (0, end, 0)) - bore(pin, clearance, (0, -wide, 0), (0, 2 * wide, 0))
    for k in range(5):
        x, z = 0.6 * size * np.cos(0.4 * np.pi * k), 0.6 * size * np.sin(0.4 * np.pi * k)
        disc -= cylinder(0.15 * size, (x, -wide, z), (x, 2 * wide, z), segments=24)
    return known_object(
        "wheel", {"block": union(block, axle, cap), "wheel": disc}, turning("block", "wheel", (0, 1, 0), (0, 0, 0))
    )


def square_lift(*, height: float = 0.6, clearance: float = 5e-4, seed: int | None = None) -> KnownObject:
    """A carriage on a square column, between its foot and its cap."""
    vary = varied(seed)
    half = vary(0.03)
    column = box((-half, -half, -0.02), (half, half, vary(height)))
    inner = half + clearance
    hole = box((-inner, -inner, -1), (inner, inner, 2))
    return lift("square_lift", column, hole, half, clearance)


def lift(name: str, column: Manifold, hole: Manifold, half: float, clearance: float) -> KnownObject:
    """Return foot, column and cap with a carriage that has the given hole."""
    top, tall = column.bounding_box()[5], 4 * half
    foot = box((-4 * half, -4 * half, -0.03), (4 * half, 4 * half, 0))
    cap = box((-1.6 * half, -1.6 * half, top - 0.001), (1.6 * half, 1.6 * half, top + 0.01))
    start = clearance
    body = box((-2 * half, -2 * half, start), (2 * half, 2 * half, start + tall))
    shelf = box((1.9 * half, -1.5 * half, start + 0.8 * tall), (7 * half, 1.5 * half, start + tall))
    carriage = body + shelf - hole
    travel = top - 0.001 - tall - 2 * clearance
    joint = sliding("column", "carriage", (0, 0, 1), (0, 0, start), (0.0, travel), stops=(True, True))
    return known_object(name, {"column": union(column, foot, cap), "carriage": carriage}, joint)


def universal_joint(*, radius: float = 0.012, clearance: float = 3e-4, seed: int | None = None) -> KnownObject:
    """Two yokes and the small cross between them, which they hide."""
    vary = varied(seed)
    size, long = vary(radius), vary(0.12)
    arm, pin, wall = 2.4 * size, 0.5 * size, 0.8 * size
    outer, high = arm + 0.5 * wall, 3.2 * size
    lugs = [cylinder(size, (s * (arm - 0.5 * wall), 0, 0), (s * outer, 0, 0)) for s in (-1, 1)]
    sides = [
        box((min(s * (arm - 0.5 * wall), s * outer), -size, -high), (max(s * (arm - 0.5 * wall), s * outer), size, 0))
        for s in (-1, 1)
    ]
    bridge = box((-outer, -size, -high - size), (outer, size, -high + 0.1 * size))
    shaft = cylinder(size, (0, 0, -high - long), (0, 0, -high))
    hole = bore(pin, clearance, (-2 * outer, 0, 0), (2 * outer, 0, 0))
    lower = union(*lugs, *sides, bridge, shaft) - hole
    upper = lower.rotate((180, 0, 90))
    cross = cylinder(pin, (-outer, 0, 0), (outer, 0, 0)) + cylinder(pin, (0, -outer, 0), (0, outer, 0))
    cross += box((-size, -size, -size), (size, size, size))
    flange = box((-2 * size, -2 * size, -high - long - 0.01), (3 * size, 2 * size, -high - long + 0.001))
    return known_object(
        "universal_joint",
        {"lower_yoke": lower + flange, "cross": cross, "upper_yoke": upper},
        turning("lower_yoke", "cross", (1, 0, 0), (0, 0, 0), (-0.6, 0.6)),
        turning("cross", "upper_yoke", (0, 1, 0), (0, 0, 0), (-0.6, 0.6)),
    )


def parallel_gripper(
    *, width: float = 0.12, opening: float = 0.02, clearance: float = 3e-4, seed: int | None = None
) -> KnownObject:
    """Two mirrored fingers on one rail, each open by `opening` [m]."""
    vary = varied(seed)
    half, bar, thick = 0.5 * vary(width), vary(0.006), vary(0.016)
    level = 0.025
    inner = bar + clearance
    palm = box((-half - 0.012, -0.03, -0.03), (half + 0.012, 0.03, 0))
    palm += cylinder(0.025, (0, 0, -0.07), (0, 0, -0.03))
    for sign in (-1, 1):
        x0, x1 = sorted((sign * half, sign * (half + 0.012)))
        palm += box((x0, -0.03, -0.001), (x1, 0.03, level + 2 * bar))
    palm += box((-half - 0.001, -bar, level - bar), (half + 0.001, bar, level + bar))
    slide = box((clearance, -0.02, clearance), (thick, 0.02, level + 3 * bar))
    slide -= box((-1, -inner, level - inner), (1, inner, level + inner))
    right = union(slide, box((clearance, -0.008, level + 2.9 * bar), (0.008, 0.008, level + 0.07)))
    travel = half - thick - clearance
    joints = [
        sliding("palm", name, (sign, 0, 0), (0, 0, level), (0.0, travel), stops=(False, True))
        for name, sign in (("right_finger", 1), ("left_finger", -1))
    ]
    solids = {"palm": palm, "right_finger": right, "left_finger": right.mirror((1, 0, 0))}
    shut = known_object("parallel_gripper", solids, *joints)
    return moved(shut, {"right_finger": opening, "left_finger": opening})


def serial_arm(
    *, joints: int = 6, radius: float = 0.04, clearance: float = 5e-4, seed: int | None = None
) -> KnownObject:
    """An arm on a foot whose joints turn about z and y in turn; pitch joints step aside and back."""
    vary = varied(seed)
    size = vary(radius)
    pieces = [box((-3 * size, -2 * size, -0.02), (2 * size, 2 * size, 0)), cylinder(size, (0, 0, -0.01), (0, 0, size))]
    tip, side, parent = np.array([0.0, 0.0, size]), 1.0, "foot"
    solids, truth = {}, []
    for k in range(joints):
        name = f"link{k + 1}"
        if k % 2 == 0:
            pivot, axis = off(tip, 0, 0, size), np.array([0.0, 0.0, 1.0])
            boss, hole, rotor = stub(pivot, axis, size, clearance)
            tip, limits = off(pivot, 0, 0, size + clearance), (-2.8, 2.8)
        else:
            pivot, axis = off(tip, 0, side * size, 0.5 * size), np.array([0.0, side, 0.0])
            boss, hole, rotor = stub(pivot, axis, size, clearance, length=2 * size)
            tip, limits, side = off(pivot, 0, axis[1] * (size + clearance), 0), (-1.7, 1.7), -side
            rotor += cylinder(size, tip, off(tip, 0, axis[1] * size, 0))
        solids[parent] = union(*pieces, boss) - hole
        end = off(tip, 0, 0, vary(3.0 * size))
        pieces = [rotor, cylinder(0.75 * size, tip, end)]
        truth.append(turning(parent, name, (0, 0, 1) if k % 2 == 0 else (0, 1, 0), pivot, limits))
        tip, parent = end, name
    solids[parent] = union(*pieces, box(tip - 0.8 * size, off(tip, 1.2 * size, 0.8 * size, 0.2 * size)))
    return known_object(f"serial_arm_{joints}", solids, *truth)


def torso(*, height: float = 0.4, clearance: float = 5e-4, seed: int | None = None) -> KnownObject:
    """A torso with two congruent arms: the right one is the left one turned by half a turn."""
    vary = varied(seed)
    high, radius, long = vary(height), vary(0.03), vary(0.2)
    wide = vary(0.12)
    level = high - 1.5 * radius
    shoulder = np.array([0.0, wide + radius, level])
    boss, hole, rotor = stub(shoulder, (0, 1, 0), radius, clearance, length=2 * radius)
    elbow = off(shoulder, 0, radius + clearance, -long)
    width, thin = 1.6 * radius, 0.6 * radius
    forked, tongue = (solid.rotate((180, 0, 90)).translate(elbow) for solid in fork(width, thin, clearance, 2.2 * thin))
    upper_body = cylinder(0.7 * radius, off(elbow, 0, 0, long), off(elbow, 0, 0, 1.8 * thin))
    start = fork_room(thin, clearance)
    lower_body = cylinder(thin, off(elbow, 0, 0, -start), off(elbow, 0, 0, -long))
    hand = box(off(elbow, -0.5 * thin, -1.5 * thin, -1.3 * long), off(elbow, 0.8 * thin, 1.5 * thin, -0.95 * long))
    arm = {"upper_arm": union(rotor, upper_body, forked), "forearm": union(tongue, lower_body, hand)}
    trunk = union(
        box((-0.08, -wide, 0), (0.07, wide, high)),
        box((0.06, -0.5 * wide, 0.6 * high), (0.09, 0.5 * wide, 0.9 * high)),
        boss,
        boss.rotate((0, 0, 180)),
    )
    solids = {"torso": trunk - hole - hole.rotate((0, 0, 180))}
    joints: list[KnownJoint] = []
    for side, angle, sign in (("left", 0, 1.0), ("right", 180, -1.0)):
        flip = np.array([sign, sign, 1.0])
        upper, lower = f"{side}_upper_arm", f"{side}_forearm"
        solids[upper], solids[lower] = (arm[kind].rotate((0, 0, angle)) for kind in ("upper_arm", "forearm"))
        joints += [
            turning("torso", upper, (0, sign, 0), flip * shoulder, (-2.0, 2.0)),
            turning(upper, lower, (0, sign, 0), flip * elbow, (-1.4, 1.4)),
        ]
    return known_object("torso", solids, *joints)
