"""Straight limbs of two links on flanged stubs, and legs that roll at the hip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.solids import off, rod, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.solids import Point
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
