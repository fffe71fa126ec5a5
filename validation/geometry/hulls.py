"""What engines see of the motion that take the convex hull of every collision mesh, for KV332.

Of a hull only its faces matter: a point is as deep in it as the nearest of them is far, exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull

from kinematify.geometry.convex import outermost
from kinematify.geometry.hull import thickened
from kinematify.geometry.scene import inverse, relative

if TYPE_CHECKING:
    from kinematify.geometry.rest import Allowance
    from kinematify.geometry.scene import Pair, Scene
    from kinematify.geometry.sweep import JointSweep, Sweeper
    from kinematify.robot.arrays import FloatArray

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

    def blocked(self, sweep: JointSweep, samples: int) -> HullMeeting | None:
        """Of the pairs of one joint whose hulls are in the way where their surfaces are clear, the deepest."""
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

        Of a body that the file declares concave they collide the surface, those that heed it.
        """
        links = [name for index in pair for name in self._scene.bodies[index].links]
        if any(shape.concave for name in links for shape in self._scene.model.link_by_name[name].collisions):
            return False
        return pair not in self._scene.connection_of or pair[0] == 0


def _deepest(planes: FloatArray, points: FloatArray, T: FloatArray) -> FloatArray:
    """Depth of the deepest point, posed in the frame of the planes (f, 4), below all of them [m], (n, 4, 4) -> (n,)."""
    posed = points @ T[:, :3, :3].transpose(0, 2, 1) + T[:, None, :3, 3]
    depth = -(posed @ planes[:, :3].T + planes[:, 3]).max(axis=2)
    return np.asarray(np.maximum(depth.max(axis=1), 0.0))
