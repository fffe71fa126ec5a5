"""Test whether two bodies collide in many relative poses, how deep, and how far apart they are."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import fcl
import numpy as np

from kinematify.geometry.scene import inverse
from kinematify.robot.transforms import transformed
from kinematify.robot.vectors import all_three, lengths_of

if TYPE_CHECKING:
    from kinematify.geometry.scene import Pair, Scene
    from kinematify.geometry.solid import Solid
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


_POINTS = 100_000  # asked about at a time: 10 MB
_SOME = 16  # every so many of a body's points are asked about first: of what is near, most are
_FEW = 0.03  # of the points: trims of sheets that stick in one another at rest count for nothing
_SHRINK = 0.01  # surfaces that slide on one another must not count as crossed by a rounding error


class OverlapQueries:
    """Asks FCL and the signed distances; a pose is that of the second body in the frame of the first one."""

    def __init__(self, scene: Scene) -> None:
        """Keep the scene; trees are built when a pair is first near each other."""
        self._scene = scene
        self._object = cache(self._new_object)

    def solids(self, pair: Pair) -> tuple[Solid, Solid]:
        """Both solids."""
        return self._scene.bodies[pair[0]].solid, self._scene.bodies[pair[1]].solid

    def collide(self, pair: Pair, T: FloatArray) -> BoolArray:
        """Test whether the surfaces meet, poses (n, 4, 4) -> (n,)."""
        first, second = self.solids(pair)
        hit = boxes_meet(first, second, T)
        rows = np.flatnonzero(hit)
        if not len(rows):
            return hit
        fixed, moving = self._object(pair[0], 0), self._object(pair[1], 1)
        rotations = T[rows, :3, :3]
        shifts = (rotations @ second.middle + T[rows, :3, 3] - first.middle) / self._scene.unit
        request, transform = fcl.CollisionRequest(), fcl.Transform
        for row, rotation, shift in zip(rows.tolist(), rotations, shifts, strict=True):
            moving.setTransform(transform(rotation, shift))
            hit[row] = fcl.collide(fixed, moving, request, fcl.CollisionResult()) > 0
        return hit

    def may_contain(self, pair: Pair, T: FloatArray) -> BoolArray:
        """Test whether the box of one body lies in the box of the other one, poses (n, 4, 4) -> (n,)."""
        first, second = self.solids(pair)
        return _box_in_box(second, first, T) | _box_in_box(first, second, inverse(T))

    def depth(self, pair: Pair, T: FloatArray) -> FloatArray:
        """Deepest point of one body in the closed shells of the other [m], poses (n, 4, 4) -> (n,); 0 where none is.

        Whether the surfaces meet plays no part, so that a body inside another one is found.
        """
        first, second = self.solids(pair)
        return np.maximum(_reach_into(first, second, T), _reach_into(second, first, inverse(T)))

    def passed(self, pair: Pair, T: FloatArray, hit: BoolArray, *, grace: float) -> FloatArray:
        """Measure how far points of one body went through walls of the other [m], along a path of poses -> (n,).

        A thin wall is never deep, and a sheet has no inside; what went through it stands behind it.

        Args:
            pair: Both bodies.
            T: Poses from the start of the path on, shape (n, 4, 4).
            hit: Where the surfaces meet, shape (n,); where they do not, nothing is on its way through.
            grace: Way of a point [m] on which it may pass walls: what is stuck at rest comes out of them.
        """
        first, second = self.solids(pair)
        if not hit[1:].any():
            return np.zeros(len(T))
        return np.maximum(_passed(first, second, T, hit, grace), _passed(second, first, inverse(T), hit, grace))

    def near(self, pair: Pair, T: FloatArray, limit: float) -> bool:
        """True if a point of the second body is at most `limit` from the first [m] in one pose (4, 4).

        Then so is their gap, which takes far longer to find; where it is False, the gap may still be smaller.
        """
        first, second = self.solids(pair)
        points = transformed(second.points, T)
        points = points[all_three((points >= first.low - limit) & (points <= first.high + limit))]
        return any(bool((first.distance(some) <= limit).any()) for some in (points[::_SOME], points))

    def gap(self, pair: Pair, T: FloatArray) -> float:
        """Distance of the two bodies [m] in one pose (4, 4); 0 where they cross or one is in the solid of the other."""
        one = T[None]
        if self.collide(pair, one)[0] or (self.may_contain(pair, one)[0] and self.depth(pair, one)[0] > 0.0):
            return 0.0
        first, second = self.solids(pair)
        fixed, moving = self._object(pair[0], 0), self._object(pair[1], 1)
        shift = (T[:3, :3] @ second.middle + T[:3, 3] - first.middle) / self._scene.unit
        moving.setTransform(fcl.Transform(T[:3, :3], shift))
        distance = fcl.distance(fixed, moving, fcl.DistanceRequest(), fcl.DistanceResult())
        return self._scene.unit * max(0.0, float(distance))

    def _new_object(self, body: int, _side: int) -> fcl.CollisionObject:
        """FCL object of a body; the one of side 0 always stands at the origin."""
        return fcl.CollisionObject(self._scene.bodies[body].solid.tree, fcl.Transform())


def boxes_meet(first: Solid, second: Solid, T: FloatArray) -> BoolArray:
    """Test whether the oriented boxes of two bodies meet (separating axes of their faces), poses (n, 4, 4) -> (n,)."""
    half = 0.5 * (first.high - first.low), 0.5 * (second.high - second.low)
    rotations = T[:, :3, :3]
    absolute = np.abs(rotations)
    offset = rotations @ second.middle + T[:, :3, 3] - first.middle
    along_first = np.abs(offset) <= half[0] + absolute @ half[1]
    back = np.einsum("nij,ni->nj", rotations, offset)
    along_second = np.abs(back) <= half[1] + np.einsum("nij,i->nj", absolute, half[0])
    return all_three(along_first & along_second)


def _box_in_box(inner: Solid, outer: Solid, T: FloatArray) -> BoolArray:
    """Test whether the box of `inner`, posed in the frame of `outer`, lies in the box of the latter."""
    reach = np.abs(T[:, :3, :3]) @ (0.5 * (inner.high - inner.low))
    middle = T[:, :3, :3] @ inner.middle + T[:, :3, 3]
    return all_three((middle - reach >= outer.low) & (middle + reach <= outer.high))


def _reach_into(body: Solid, other: Solid, T: FloatArray) -> FloatArray:
    """Return how deep points of `other`, posed in the frame of `body`, lie in it [m], poses (n, 4, 4) -> (n,)."""
    depth = np.zeros(len(T))
    if len(body.shells.closed):
        for rows in _pieces(len(T), len(other.points)):
            depth[rows] = body.deepest(_posed(other.points, T[rows]))
    return depth


def _passed(body: Solid, other: Solid, T: FloatArray, hit: BoolArray, grace: float) -> FloatArray:
    """`OverlapQueries.passed` for the walls of `body` and the points of `other`."""
    path = _posed(other.points + _SHRINK * (other.middle - other.points), T)
    few = max(1, int(_FEW * path.shape[1]))
    near = all_three((path.min(axis=0) <= body.high) & (path.max(axis=0) >= body.low))
    if np.count_nonzero(near) < few:
        return np.zeros(len(T))
    path = path[:, near]
    steps = np.diff(path, axis=0)
    way = np.cumsum(lengths_of(steps), axis=0)
    last_free = np.maximum.accumulate(np.where(hit, 0, np.arange(len(T))))
    beyond = np.zeros(path.shape[:2])
    for sheets in (True, False):
        met = hit[1:, None] & (way > grace)  # what was met before the last free pose does not count
        met[met] = body.meets(path[:-1][met], steps[met], sheets=sheets)
        met[_pierced_at_rest(other, path, met, T[0])] = False
        if not met.any():
            continue
        crossings = np.concatenate([np.zeros((1, path.shape[1]), dtype=np.int64), np.cumsum(met, axis=0)])
        crossings -= crossings[last_free]
        if sheets:
            through = crossings % 2 == 1
            beyond[through] = body.beside_sheets(path[through])
        else:
            through = (crossings > 0) & ~body.contains(path[0])
            through[through] = ~body.contains(path[through])
            beyond[through] = np.maximum(beyond[through], body.beside_closed(path[through]))
    return np.asarray(np.partition(beyond, -few, axis=1)[:, -few])


def _pierced_at_rest(other: Solid, path: FloatArray, met: BoolArray, T: FloatArray) -> tuple[IntArray, IntArray]:
    """Crossings of a wall (row, point) where the solid of `other` already goes through it at rest, as a rail does."""
    rows, points = np.nonzero(met)
    if not len(rows) or not len(other.shells.closed):
        return rows[:0], points[:0]
    at_rest = transformed(path[rows + 1, points], inverse(T[None])[0])
    pierced = other.contains(at_rest)
    return rows[pierced], points[pierced]


def _posed(points: FloatArray, T: FloatArray) -> FloatArray:
    """Points (p, 3) in every pose (n, 4, 4), shape (n, p, 3)."""
    return np.asarray(points @ T[:, :3, :3].transpose(0, 2, 1) + T[:, None, :3, 3])


def _pieces(poses: int, points: int) -> list[slice]:
    step = max(1, _POINTS // max(points, 1))
    return [slice(start, start + step) for start in range(0, poses, step)]
