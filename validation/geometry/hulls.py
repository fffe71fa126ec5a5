"""Convex hulls of collision meshes in motion, as engines see them, for KV332.

Of a hull only its faces matter: a point is as deep in it as the nearest of them is far, exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull

from kinematify.geometry.convex import outermost, thickened
from kinematify.geometry.scene import inverse, relative

if TYPE_CHECKING:
    from kinematify.geometry.rest_pairs import DepthAllowance
    from kinematify.geometry.scene import Pair, Scene
    from kinematify.geometry.sweep import JointSweep, Sweeper
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Shape

_THICKNESS = 1e-4  # of the model's size: no hull of a plane


@dataclass(frozen=True, kw_only=True)
class HullMeeting:
    """Two bodies whose hulls are deeper in each other, while one joint moves, than they may be."""

    pair: Pair
    depth: float
    """Beyond that at rest [m]."""
    tolerance: float
    """What it may be [m]."""
    at: float
    """Value of the joint where they are deepest [rad or m]."""
    share: float
    """Share of the joint's free range in which they are in the way."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Hull:
    """Convex hull of a collision shape, in the frame of its body."""

    points: FloatArray
    """Corners, and the middles of the faces (k, 3) [m]."""
    planes: FloatArray
    """Outward normals with their offsets (f, 4)."""

    @cached_property
    def middle(self) -> FloatArray:
        """Centre of a sphere round it (3,) [m]."""
        return np.asarray((self.points.min(axis=0) + self.points.max(axis=0)) / 2.0)

    @cached_property
    def radius(self) -> float:
        """Radius of that sphere [m]."""
        return float(np.linalg.norm(self.points - self.middle, axis=1).max())

    def reached(self, other: _Hull, T: FloatArray) -> FloatArray:
        """Depth of the deepest point of another hull, posed in this one's frame, in it [m], (n, 4, 4) -> (n,)."""
        depth = np.zeros(len(T))
        middle = T[:, :3, :3] @ other.middle + T[:, :3, 3]
        near = (middle @ self.planes[:, :3].T + self.planes[:, 3]).max(axis=1) < other.radius
        posed = other.points @ T[near, :3, :3].transpose(0, 2, 1) + T[near, None, :3, 3]
        depth[near] = -(posed @ self.planes[:, :3].T + self.planes[:, 3]).max(axis=2).min(axis=1, initial=0.0)
        return depth


class HullView:
    """The bodies as engines see them."""

    def __init__(self, scene: Scene, sweeper: Sweeper, allowance: DepthAllowance) -> None:
        """Keep what is shared."""
        self._scene, self._sweeper, self._allowance = scene, sweeper, allowance

    @cached_property
    def _hulls(self) -> list[list[_Hull]]:
        """For every body, the hull of each shape."""
        return [[self._hull(points) for points in body.shapes] for body in self._scene.bodies]

    def _hull(self, points: FloatArray) -> _Hull:
        kept = outermost(points, self._scene.settings.hull_planes)
        hull = ConvexHull(thickened(kept, _THICKNESS * self._scene.size))
        corners = hull.points[hull.vertices]
        middles = hull.points[hull.simplices].mean(axis=1)
        return _Hull(points=np.concatenate([corners, middles]), planes=np.asarray(hull.equations))

    def depth(self, pair: Pair, T: FloatArray) -> FloatArray:
        """Deepest point of one body's hulls in the other one's [m], poses (n, 4, 4) -> (n,)."""
        first, second = self._hulls[pair[0]], self._hulls[pair[1]]
        back = inverse(T)
        found = np.zeros(len(T))
        for one in first:
            for other in second:
                found = np.maximum(found, np.maximum(one.reached(other, T), other.reached(one, back)))
        return found

    def blocked(self, sweep: JointSweep, samples: int) -> HullMeeting | None:
        """Return the deepest pair of one joint whose hulls are in the way where their surfaces are clear."""
        low, high = (side.declared for side in sweep.sides)
        free_low, free_high = sweep.free
        values = np.linspace(max(low, free_low), min(high, free_high), samples)
        poses = self._scene.poses(self._sweeper.rows(sweep.leader, values))
        worst: HullMeeting | None = None
        for pair in self._scene.affected[sweep.leader]:
            if not self._seen_by_engines(pair):
                continue
            tolerance = self._allowance.tolerance(pair)
            excess = self.depth(pair, relative(poses, pair)) - self._allowance.at_rest(pair) - tolerance
            if excess.max() > 0.0 and (worst is None or excess.max() > worst.depth - worst.tolerance):
                worst = HullMeeting(
                    pair=pair,
                    depth=float(excess.max()) + tolerance,
                    tolerance=tolerance,
                    at=float(values[int(np.argmax(excess))]),
                    share=float((excess > 0.0).mean()),
                )
        return worst

    def _seen_by_engines(self, pair: Pair) -> bool:
        """Engines leave out contacts of parent and child, except with a base that is fixed to the world.

        What has no collision geometry meets nothing. Of a body that the file declares concave they collide the surface,
        those that follow it.
        """
        shapes = [self._collisions(index) for index in pair]
        if not all(shapes) or any(shape.concave for some in shapes for shape in some):
            return False
        return pair not in self._scene.connection_of or pair[0] == 0

    def _collisions(self, body: int) -> list[Shape]:
        links = self._scene.model.link_by_name
        return [shape for name in self._scene.bodies[body].links for shape in links[name].collisions]
