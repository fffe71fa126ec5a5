"""Links of robots between the flanged stubs that they turn on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.sources.procedural.pieces.bearings import stub
from kinematify.sources.procedural.solids import off, rod, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.assembly.part import FloatArray
    from kinematify.sources.procedural.solids import Point


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
    pitch_boss, pitch_hole, pitch_rotor = stub(pitch_at, (0, sy, 0), radius, clearance, length=2 * radius)
    bridge = pitch_boss + rod(0.8 * radius, off(hip, flange, 0, 0), off(hip, end, 0, 0))
    links = {"hip": union(rotor, beyond(bridge, off(hip, sx * clearance, 0, 0), (sx, 0, 0))) - pitch_hole}

    top = off(pitch_at, 0, sy * (radius + clearance), 0)
    knee_at = off(top, 0, -sy * radius, -lengths[0])
    knee_boss, knee_hole, knee_rotor = stub(knee_at, (0, -sy, 0), 0.8 * radius, clearance, length=1.6 * radius)
    upper = knee_boss + rod(0.7 * radius, top, off(top, 0, 0, -lengths[0]))
    links["thigh"] = union(pitch_rotor, beyond(upper, knee_at, (0, sy, 0))) - knee_hole

    ankle = off(knee_at, 0, -sy * (0.8 * radius + clearance), 0)
    lower = rod(0.5 * radius, ankle, off(ankle, 0, 0, -lengths[1]))
    links["shank"] = union(knee_rotor, beyond(lower, off(knee_at, 0, -sy * clearance, 0), (0, -sy, 0)))
    return boss, hole, links, (hip, pitch_at, knee_at)


def beyond(solid: Manifold, point: Point, direction: tuple[int, int, int]) -> Manifold:
    """Return what lies on the far side of the plane through `point` across `direction`."""
    return solid.trim_by_plane(direction, float(np.dot(direction, point)))
