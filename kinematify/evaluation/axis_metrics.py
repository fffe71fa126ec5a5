"""Distances between one true and one predicted joint, in the world frame of the input (paper IV-A)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray

FULL_TURN = 2.0 * math.pi
ONE_SIDED = 0.5
"""A joint opens towards one side where that side has this much more of its travel, as a share: three to one."""


def axis_angle(first: FloatArray, second: FloatArray) -> float:
    """Return the angle between two axes [deg], opposite directions counting as equal: in [0, 90].

    Args:
        first: Direction of any non-zero length, shape (3,).
        second: Direction of any non-zero length, shape (3,).
    """
    sine = float(np.linalg.norm(np.cross(first, second)))
    return math.degrees(math.atan2(sine, abs(float(first @ second))))


def axis_line_distance(
    *, true_axis: FloatArray, true_pivot: FloatArray, axis: FloatArray, pivot: FloatArray, near: FloatArray
) -> float:
    """Return how far the predicted axis line passes from the true one at the part that moves [m].

    It is the distance to the predicted line from the point of the true line nearest to `near`, the child part's
    centroid. The usual distance between two skew lines jumps at parallel lines: lines 10 cm apart and tilted by 0.01
    deg cross somewhere far away and count 0. This one is continuous everywhere, does not change when either pivot
    slides along its line, nor when an axis is flipped, and equals the offset where the lines are parallel.

    Args:
        true_axis: True direction, shape (3,).
        true_pivot: A point on the true axis [m], shape (3,).
        axis: Predicted direction, shape (3,).
        pivot: A point on the predicted axis [m], shape (3,).
        near: Where the joint does its work [m], shape (3,).
    """
    anchor = true_pivot + _along(near - true_pivot, true_axis)
    offset = anchor - pivot
    return float(np.linalg.norm(offset - _along(offset, axis)))


def limit_overlap(
    true_limits: tuple[float, float], limits: tuple[float, float], *, same_sign: bool, turns: bool
) -> float:
    """Return intersection over union of two ranges of motion, in [0, 1].

    A turning range of a full turn or more reaches every angle, as a continuous joint does; where one of the two is
    such a range, the overlap is the share of the turn that the other one reaches.

    Args:
        true_limits: Lower and upper limit [rad or m], measured from the configuration of the input.
        limits: The predicted ones, same zero and unit; infinite for a continuous joint.
        same_sign: True where the axes point the same way; otherwise the predicted range is mirrored.
        turns: True for angles, False for travels.
    """
    lower, upper = limits if same_sign else (-limits[1], -limits[0])
    widths = (true_limits[1] - true_limits[0], upper - lower)
    if turns and max(widths) >= FULL_TURN:
        return min(FULL_TURN, *widths) / FULL_TURN
    shared = min(true_limits[1], upper) - max(true_limits[0], lower)
    if shared < 0.0:
        return 0.0
    hull = max(true_limits[1], upper) - min(true_limits[0], lower)
    return shared / hull if hull > 0.0 else 1.0


def opening_sign(lower: float, upper: float) -> int:
    """Return the direction in which a joint opens from zero: 1, -1, or 0 where its range does not say.

    It does not where the range is not one-sided (most robot joints), has no end, or leaves out zero.

    Args:
        lower: Lower limit in the joint's own zero [rad or m]; may be infinite.
        upper: Upper limit in the same unit.
    """
    finite = math.isfinite(lower) and math.isfinite(upper)
    if not finite or not lower <= 0.0 <= upper or lower == upper:
        return 0
    share = (upper + lower) / (upper - lower)
    return 0 if abs(share) < ONE_SIDED else int(math.copysign(1, share))


def _along(vector: FloatArray, direction: FloatArray) -> FloatArray:
    """Component of `vector` along `direction`."""
    return direction * (float(vector @ direction) / float(direction @ direction))
