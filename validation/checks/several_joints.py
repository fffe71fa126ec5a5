"""KV333: joints of twins, two parts that mirror or repeat each other.

A pair counts only where the shapes at rest and what carries them agree. A difference counts only if no symmetry of
the pair explains the two joints: knobs side by side may turn the same way or mirrored, doors with both hinges on the
left repeat each other. Parts whose lines differ are no twins.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import transformed
from kinematify.validation.check import check
from kinematify.validation.checks.shared import joints_move
from kinematify.validation.finding import Cause, Severity, not_finished

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.geometry.look import GeometryContext

_SAME, _SAME_PART = 0.01, 0.05
"""Difference of boxes at rest and of pivots, fraction of the model's size and of the part's; the smaller one counts."""
_SAME_DEG = 2.0
_SAME_RANGE = 0.1
"""Difference of the ends of two ranges that is one of design, fraction of the wider range."""
_EXACT = 0.02
"""The same up to which a range is that of the twin, turned round."""
_LOPSIDED = 0.2
"""A range shows a direction if the sum of its ends is above this share of its width."""
_WIDER = 1.8
"""A range that is this many times that of its twin is another one."""

OTHER_WAY = "one moves the other way round"
OTHER_TYPE = "one turns and the other slides"
TWICE = "the range of one is about twice as wide"
_RANKED = (OTHER_WAY, OTHER_TYPE, TWICE)
"""If several symmetries show a difference, the last of these is reported."""


def _two_joints(look: GeometryContext) -> str | None:
    late = None if look.left is None else not_finished(f"time ran out before {look.left}")
    return late or ("only one joint moves" if len(look.scene.travels) < 2 else None)


@check(
    "KV333",
    title="Twins move alike",
    fails="Twins do not move alike",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    needs=(joints_move, _two_joints),
)
def unlike_twins(result: OpenCheck, look: GeometryContext) -> None:
    """Two parts of one size that mirror or repeat each other at rest, and whose axes do so too, have joints of one type
    whose ranges are about as wide and lead the same way. It is a finding only if no symmetry of the two explains both
    joints, and one joint is in all pairs that differ: legs may bend alike in front and behind.

    Why it matters: One leg that bends the wrong way, or one door that opens inwards, is stopped by nothing in an
    engine.

    Remedy: Compare the two joints; correct the type, the axis or the limits of the one that is wrong.
    """
    found = [*twins_at_odds(look.scene)]
    for first, second, how in found:
        if not all({first.name, second.name} & {one.name, other.name} for one, other, _ in found):
            continue
        result.find(
            f"{first.child} and {second.child} mirror or repeat each other, but {how}: "
            f"{' and '.join(f'{joint.name} ({_line_and_range(joint)})' for joint in (first, second))}.",
            "Compare the two: correct the type, <axis> or limits of the one that is wrong.",
            pair=(first.child, second.child),
            line=second.line,
        )


def _line_and_range(joint: Joint) -> str:
    axis = " ".join(f"{value + 0.0:.4g}" for value in np.round(joint.axis, 4))
    return f"{joint.kind}, axis {axis}, {joint.lower:.4g} to {joint.upper:.4g}"


@dataclass(frozen=True, kw_only=True, eq=False)
class _Part:
    joint: Joint
    child: int
    parent: int
    low: FloatArray
    high: FloatArray
    axis: FloatArray
    """World frame at rest, shape (3,)."""
    point: FloatArray
    rest: float

    @property
    def middle(self) -> FloatArray:
        return 0.5 * (self.low + self.high)

    @property
    def ends(self) -> FloatArray:
        """Ends of its range, from rest [rad or m]."""
        return np.array([self.joint.lower - self.rest, self.joint.upper - self.rest])


def twins_at_odds(scene: Scene) -> Iterator[tuple[Joint, Joint, str]]:
    """Find joints of twins that differ in type, direction or width, and what differs, to follow "they are twins, but".

    Args:
        scene: The model at rest.
    """
    boxes = [_box(scene, body) for body in range(len(scene.bodies))]
    parts = _parts(scene, boxes)
    for first, second in combinations(parts, 2):
        compared = [
            (_difference(scene, first, second, sign), np.count_nonzero(sign < 0.0) == 2)
            for sign in _symmetries(scene, boxes, first, second)
        ]
        shown = [how for how, turned in compared if how and not turned]  # half a turn only explains
        if shown and all(how is not None for how, _ in compared):
            yield first.joint, second.joint, max(shown, key=_RANKED.index)


def _box(scene: Scene, body: int) -> FloatArray:
    T = scene.at_rest[body]
    points = transformed(scene.bodies[body].solid.points, T)
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _parts(scene: Scene, boxes: list[FloatArray]) -> list[_Part]:
    leaders = {travel.joint: travel.rest for travel in scene.travels}
    found = []
    for connection in scene.connections:
        joint = scene.model.joint_by_name[connection.joints[-1]]
        single = sum(scene.model.joint_by_name[name].kind is not JointType.FIXED for name in connection.joints) == 1
        limited = joint.kind in (JointType.REVOLUTE, JointType.PRISMATIC) and joint.name in leaders
        if single and limited and scene.bodies[connection.child].links[0] == joint.child:
            T = scene.at_rest[connection.child]
            low, high = boxes[connection.child]
            found.append(
                _Part(
                    joint=joint,
                    child=connection.child,
                    parent=connection.parent,
                    low=low,
                    high=high,
                    axis=T[:3, :3] @ joint.axis,
                    point=T[:3, 3],
                    rest=leaders[joint.name],
                )
            )
    return found


def _symmetries(scene: Scene, boxes: list[FloatArray], first: _Part, second: _Part) -> Iterator[FloatArray]:
    """Signs along the axes of the root by which one part may be the other one, about the middle between both."""
    same = _tolerance(scene, first)
    if np.abs((first.high - first.low) - (second.high - second.low)).max() > same:
        return
    apart = np.abs(second.middle - first.middle)
    if apart.max() <= same:
        return
    for signs in ((1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1), (-1, -1, 1), (-1, 1, -1), (1, -1, -1)):
        sign = np.array(signs, dtype=np.float64)
        if (sign < 0).any() and (apart[sign > 0] > same).any():
            continue
        turned = np.count_nonzero(sign < 0.0) == 2
        if first.parent == second.parent:
            # What is turned by half a turn takes its parent with it; what is mirrored or repeated is beside.
            off = _mapped(boxes[first.parent].mean(axis=0), sign, first, second) - boxes[first.parent].mean(axis=0)
            agrees = not turned or np.abs(off).max() <= 2.0 * same
        else:
            mapped = np.sort(_mapped(boxes[first.parent], sign, first, second), axis=0)
            agrees = np.abs(mapped - boxes[second.parent]).max() <= 2.0 * same
        if agrees:
            yield sign


def _mapped(points: FloatArray, sign: FloatArray, first: _Part, second: _Part) -> FloatArray:
    return np.asarray((points - first.middle) * sign + second.middle)


def _tolerance(scene: Scene, part: _Part) -> float:
    return min(_SAME * scene.size, _SAME_PART * float(np.linalg.norm(part.high - part.low)))


def _difference(scene: Scene, first: _Part, second: _Part, sign: FloatArray) -> str | None:
    """Return what differs under one symmetry: None if nothing does, "" if it is no such pair."""
    turns = first.joint.kind is JointType.REVOLUTE
    kinds = first.joint.kind is second.joint.kind
    axis = sign * first.axis * (np.prod(sign) if turns else 1.0)
    off = _mapped(first.point, sign, first, second) - second.point
    beside = np.abs(off - (off @ second.axis) * second.axis).max() > _tolerance(scene, first)
    if np.degrees(np.arccos(np.clip(abs(axis @ second.axis), 0.0, 1.0))) > _SAME_DEG or (turns and kinds and beside):
        return ""
    if not kinds:
        return OTHER_TYPE
    ends = first.ends if axis @ second.axis > 0.0 else -first.ends[::-1]
    narrow, wide = np.sort([np.ptp(first.ends), np.ptp(second.ends)])
    if np.abs(ends - second.ends).max() <= _SAME_RANGE * wide:
        return None
    turned_round = np.abs(-ends[::-1] - second.ends).max() < _EXACT * wide
    if turned_round and abs(second.ends.sum()) > _LOPSIDED * wide:
        return OTHER_WAY
    return TWICE if wide > _WIDER * narrow else None
