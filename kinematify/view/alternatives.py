"""Candidates of a joint as the viewer offers them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray


_SAME_DIRECTION = np.cos(np.radians(5.0))
_SAME_LINE = 0.1
"""Of the part's diagonal: turns about lines so near to each other look the same."""
_MIDDLE = 0.12
"""Of the part's diagonal: a line so near to its middle is at no edge."""
_SIDES = (("left", "right"), ("front", "back"), ("lower", "upper"))
_WAYS = (("to the left", "to the right"), ("to the front", "to the back"), ("down", "up"))
_FEWEST, _MOST = 3, 6
"""Candidates of one joint that are offered; more than the fewest only if they are likely at all."""
_LEAST = 0.01
"""Probability below which a candidate is not."""


@dataclass(frozen=True, kw_only=True, eq=False)
class JointAlternative:
    """One candidate of a joint; world frame at zero."""

    kind: JointType
    axis: FloatArray
    """Unit direction, shape (3,)."""
    pivot: FloatArray
    """A point on the axis [m], shape (3,)."""
    probability: float | None = None
    """How likely it is by what the inference measured; None where that is not known."""
    score: float = 0.0
    """Its rank among the candidates of one joint: higher is better."""
    by_hand: bool = False
    """It was set on the page, and its type is meant as it is: `continuous` turns without end."""
    limits: tuple[float, float] | None = None
    """Lower and upper limit along `axis` [rad or m] where they were set."""


def distinct(alternatives: Sequence[JointAlternative], size: float) -> tuple[JointAlternative, ...]:
    """Return what differs to the eye, the likeliest first; what looks the same becomes one, with all its probability.

    Args:
        alternatives: Candidates of one joint.
        size: Diagonal of the part that moves [m].
    """
    kept: list[JointAlternative] = []
    for item in alternatives:
        twin = next((k for k, other in enumerate(kept) if _look_alike(item, other, size)), None)
        if twin is None:
            kept.append(item)
        elif item.probability is not None:
            kept[twin] = replace(kept[twin], probability=(kept[twin].probability or 0.0) + item.probability)
    moving = sorted((item for item in kept if item.kind is not JointType.FIXED), key=lambda item: -item.score)
    if all(item.probability is not None for item in moving):
        moving.sort(key=lambda item: -(item.probability or 0.0))
    likely = [item for item in moving if item.probability is None or item.probability >= _LEAST]
    shown = likely if len(likely) >= _FEWEST else moving[:_FEWEST]
    return (*shown[:_MOST], *(item for item in kept if item.kind is JointType.FIXED))


def agreeing(
    alternatives: Sequence[JointAlternative], written: JointAlternative, confidence: float | None, size: float
) -> tuple[JointAlternative, ...]:
    """Return candidates whose probabilities agree with the confidence of the joint; the others share the rest.

    Args:
        alternatives: From `distinct`.
        written: The joint of the file.
        confidence: What the inference states for it; None leaves the probabilities as they are.
        size: Diagonal of the part that moves [m].
    """
    alike = [_look_alike(item, written, size) for item in alternatives]
    if confidence is None or not any(alike):
        return tuple(alternatives)
    others = sum(item.probability or 0.0 for item, same in zip(alternatives, alike, strict=True) if not same)
    rest = (1.0 - confidence) / max(others, 1e-12)
    scaled = [
        replace(item, probability=confidence if same else min(rest * (item.probability or 0.0), 1.0 - confidence))
        for item, same in zip(alternatives, alike, strict=True)
    ]
    return tuple(sorted(scaled, key=lambda item: (item.kind is JointType.FIXED, -(item.probability or 0.0))))


def _look_alike(one: JointAlternative, other: JointAlternative, size: float) -> bool:
    if one.kind is JointType.FIXED or other.kind is JointType.FIXED:
        return one.kind is other.kind
    if one.kind.turns != other.kind.turns or abs(float(one.axis @ other.axis)) < _SAME_DIRECTION:
        return False
    return not one.kind.turns or _distance(one, other.pivot) < _SAME_LINE * size


def _distance(item: JointAlternative, point: FloatArray) -> float:
    """From a point to the axis [m]."""
    return float(np.linalg.norm(np.cross(point - item.pivot, item.axis)))


def described(item: JointAlternative, bounds: FloatArray) -> str:
    """Say what a candidate does, as people say it: "turns about its left edge, 22 %".

    Args:
        item: A candidate.
        bounds: Lower and upper corner of the part that moves, world frame [m], shape (2, 3); the front is towards -y.
    """
    share = item.probability
    said = "" if share is None else ", under 1 %" if share < _LEAST else f", {100.0 * share:.0f} %"
    return f"{_motion(item, bounds)}{said}"


def _motion(item: JointAlternative, bounds: FloatArray) -> str:
    if item.kind is JointType.FIXED:
        return "fixed"
    along = int(np.argmax(np.abs(item.axis)))
    tilted = abs(float(item.axis[along])) < _SAME_DIRECTION
    if item.kind is JointType.PRISMATIC:
        back, forth = _WAYS[along]
        way = f"{forth} or {back}" if along != 1 else "out or in"
        return f"slides {'askew, ' if tilted else ''}{way}"
    offset = item.pivot - bounds.mean(axis=0)
    offset = offset - float(offset @ item.axis) * item.axis
    axis = ("from left to right", "from front to back", "upright")[along]
    lies = f"axis {'askew' if tilted else axis}"
    if float(np.linalg.norm(offset)) < _MIDDLE * float(np.linalg.norm(bounds[1] - bounds[0])):
        return f"turns about its middle, {lies}"
    extent = np.maximum(np.ptp(bounds, axis=0), 1e-9)
    side = int(np.argmax(np.abs(offset) / extent))
    return f"turns about its {_SIDES[side][int(offset[side] > 0.0)]} edge, {lies}"
