"""Two parts that mirror or repeat each other, and whether their joints do so too.

A pair counts only where the shapes at rest and what carries them agree. A difference counts only if no symmetry of
the pair explains the two joints: knobs side by side may turn the same way or mirrored, doors with both hinges on the
left repeat each other. Of lines that differ, only one thing may: the direction where both pass through one place of
the two parts, or the place where both run the same way; and the surfaces must agree, not only the boxes.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import transformed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint

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

_OTHER_DEG = 10.0  # axes of twins that differ by more are at odds
_BESIDE = 0.05  # of the part's size: lines of twins that run farther beside each other are at odds
_SOME = 5  # every so many of a surface's points are compared
_FITS = 0.02  # of the part's size: how far its surface may be from that of its twin

OTHER_WAY = "one moves the other way round"
OTHER_TYPE = "one turns and the other slides"
TWICE = "the range of one is about twice as wide"
OTHER_AXIS = "their axes run in different directions"
OTHER_PLACE = "their axes are in different places"
_NEARLY = "their axes nearly agree"  # never reported: no other symmetry then shows that the lines differ
_RANKED = (OTHER_PLACE, OTHER_AXIS, OTHER_WAY, OTHER_TYPE, TWICE)
"""If several symmetries show a difference, the last of these is reported; the first two are about lines."""


@dataclass(frozen=True, kw_only=True)
class Difference:
    """Two twins whose joints are at odds."""

    joints: tuple[Joint, Joint]
    how: str
    """What differs, to follow "they are twins, but"."""


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


def twins_at_odds(scene: Scene) -> Iterator[Difference]:
    """Find twins whose joints differ in type, direction or width.

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
        listed = _RANKED[2:] if any(how == _NEARLY for how, _ in compared) else _RANKED
        shown = [how for how, turned in compared if how and how in listed and not turned]  # half a turn only explains
        if shown and all(how is not None for how, _ in compared):
            yield Difference(joints=(first.joint, second.joint), how=max(shown, key=_RANKED.index))


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
            agrees = _lands([boxes[second.parent]], _mapped(boxes[first.parent], sign, first, second), 2.0 * same)
        if agrees:
            yield sign


def _mapped(points: FloatArray, sign: FloatArray, first: _Part, second: _Part) -> FloatArray:
    return np.asarray((points - first.middle) * sign + second.middle)


def _tolerance(scene: Scene, part: _Part) -> float:
    return min(_SAME * scene.size, _SAME_PART * float(np.linalg.norm(part.high - part.low)))


def _lands(boxes: list[FloatArray], box: FloatArray, same: float) -> bool:
    """True if a box that was mapped is one of some others."""
    mapped = np.sort(box, axis=0)
    return any(bool(np.abs(mapped - other).max() <= same) for other in boxes)


def _difference(scene: Scene, first: _Part, second: _Part, sign: FloatArray) -> str | None:
    """Return what differs under one symmetry: None if nothing does, "" if it is no such pair."""
    turns = first.joint.kind is JointType.REVOLUTE
    kinds = first.joint.kind is second.joint.kind
    axis = sign * first.axis * (np.prod(sign) if turns else 1.0)
    other = _other_line(scene, first, second, sign, axis, turns=turns and kinds)
    if other is not None:
        return other if kinds else ""
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


def _other_line(
    scene: Scene, first: _Part, second: _Part, sign: FloatArray, axis: FloatArray, *, turns: bool
) -> str | None:
    """Return the difference of the mapped line of one joint from the other's: None if equal, "" if not clear."""
    angle = np.degrees(np.arccos(np.clip(abs(axis @ second.axis), 0.0, 1.0)))
    off = _mapped(first.point, sign, first, second) - second.point
    off = off - (off @ second.axis) * second.axis if angle <= _SAME_DEG else off
    beside = float(np.abs(off).max()) if turns else 0.0
    same = _tolerance(scene, first)
    if angle <= _SAME_DEG and beside <= same:
        return None
    size = float(np.linalg.norm(first.high - first.low))
    if angle <= _OTHER_DEG and beside <= _BESIDE * size:
        return _NEARLY
    unclear = _SAME_DEG < angle <= _OTHER_DEG or (angle > _OTHER_DEG and beside > same)
    if unclear or not _fits(scene, first, second, sign, _FITS * size):
        return ""
    return OTHER_PLACE if angle <= _SAME_DEG else OTHER_AXIS


def _fits(scene: Scene, first: _Part, second: _Part, sign: FloatArray, most: float) -> bool:
    """True if the surface of one part, mapped, is that of the other one."""
    T = scene.at_rest[first.child]
    points = transformed(scene.bodies[first.child].solid.points[::_SOME], T)
    T = scene.at_rest[second.child]
    local = (_mapped(points, sign, first, second) - T[:3, 3]) @ T[:3, :3]
    return bool((scene.bodies[second.child].solid.distance(local) <= most).all())
