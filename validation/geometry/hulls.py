"""KV332: what engines see of the motion, which take the convex hull of every collision mesh.

Of a hull only its faces matter: a point is as deep in it as the nearest of them is far, exactly.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull

from kinematify.geometry.convex import outermost
from kinematify.geometry.hull import thickened
from kinematify.geometry.scene import inverse, relative
from kinematify.validation.finding import Severity
from kinematify.validation.geometry.remark import Remark, configuration, in_document_order, joint_value, length

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.geometry.rest import Allowance
    from kinematify.geometry.scene import Pair, Scene
    from kinematify.geometry.sweep import JointSweep, Sweeper
    from kinematify.robot.arrays import FloatArray

_THICKNESS = 1e-4  # of the model's size: no hull of a plane


class HullView:
    """The bodies as engines see them."""

    def __init__(self, scene: Scene, sweeper: Sweeper, allowance: Allowance) -> None:
        """Keep what is shared."""
        self._scene, self._sweeper, self._allowance = scene, sweeper, allowance

    @cached_property
    def _hulls(self) -> list[list[tuple[FloatArray, FloatArray]]]:
        """For every body, of each shape the corners (k, 3) and the planes (f, 4) of its hull."""
        return [[self._hull(points) for points in body.shapes] for body in self._scene.bodies]

    def _hull(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        kept = outermost(points, self._scene.settings.hull_planes)
        hull = ConvexHull(thickened(kept, _THICKNESS * self._scene.size))
        corners = hull.points[hull.vertices]
        middles = hull.points[hull.simplices].mean(axis=1)
        return np.concatenate([corners, middles]), np.asarray(hull.equations)

    def depth(self, pair: Pair, T: FloatArray) -> FloatArray:
        """Deepest point of one body's hulls in the other one's [m], poses (n, 4, 4) -> (n,)."""
        first, second = self._hulls[pair[0]], self._hulls[pair[1]]
        back = inverse(T)
        found = np.zeros(len(T))
        for one in first:
            for other in second:
                found = np.maximum(found, np.maximum(_deepest(one[1], other[0], T), _deepest(other[1], one[0], back)))
        return found

    def blocked(self, sweep: JointSweep, samples: int) -> Iterator[Remark]:
        """Pairs of one joint whose hulls are in the way where their surfaces are clear."""
        low, high = (side.declared for side in sweep.sides)
        free_low, free_high = sweep.free
        values = np.linspace(max(low, free_low), min(high, free_high), samples)
        poses = self._scene.poses(self._sweeper.rows(sweep.leader, values))
        worst: tuple[float, Pair, FloatArray] | None = None
        for pair in self._scene.affected[sweep.leader]:
            if self._seen_by_engines(pair):
                limit = self._allowance.at_rest(pair) + self._allowance.tolerance(pair)
                excess = self.depth(pair, relative(poses, pair)) - limit
                if excess.max() > 0.0 and (worst is None or excess.max() > worst[0]):
                    worst = (float(excess.max()), pair, excess)
        if worst is not None:
            yield self._remark(sweep, worst[1], values, worst[2])

    def _seen_by_engines(self, pair: Pair) -> bool:
        """Engines leave out contacts of parent and child, except with a base that is fixed to the world."""
        return pair not in self._scene.connection_of or pair[0] == 0

    def _remark(self, sweep: JointSweep, pair: Pair, values: FloatArray, excess: FloatArray) -> Remark:
        deepest, tolerance = int(np.argmax(excess)), self._allowance.tolerance(pair)
        share = float((excess > 0.0).mean())
        first, second = in_document_order(self._scene, pair)
        value = joint_value(float(values[deepest]), turns=sweep.travel.turns)
        return Remark(
            message=f"The surfaces of {first} and {second} stay clear, but their convex hulls, which engines collide, "
            f"are {length(excess[deepest] + tolerance)} deep in each other at {value} of {sweep.travel.joint}, and in "
            f"the way over {share:.0%} of its free range.",
            remedy="Cut the collision meshes into convex pieces (kinematify export --to urdf, or CoACD); the joint "
            "itself is right.",
            severity=Severity.WARNING,
            joint=sweep.travel.joint,
            pair=(first, second),
            q=configuration(self._scene, {sweep.leader: float(values[deepest])}),
            value=float(excess[deepest] + tolerance),
            limit=tolerance,
            unit="m",
        )


def _deepest(planes: FloatArray, points: FloatArray, T: FloatArray) -> FloatArray:
    """Depth of the deepest point, posed in the frame of the planes (f, 4), below all of them [m], (n, 4, 4) -> (n,)."""
    posed = points @ T[:, :3, :3].transpose(0, 2, 1) + T[:, None, :3, 3]
    depth = -(posed @ planes[:, :3].T + planes[:, 3]).max(axis=2)
    return np.asarray(np.maximum(depth.max(axis=1), 0.0))


def seen_by_engines(scene: Scene) -> bool:
    """Whether two bodies at least have collision geometry of their own."""
    links = scene.model.link_by_name
    return sum(any(links[name].collisions for name in body.links) for body in scene.bodies) > 1
