"""The room that the geometry of each link takes, and the gaps between neighbours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import transformed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Link, Robot


@dataclass(frozen=True, kw_only=True, eq=False)
class Extent:
    """The room that the geometry of a link takes."""

    link: Link
    diagonal: float
    """[m], independent of the link's pose."""
    low: FloatArray
    """World frame at zero [m], shape (3,)."""
    high: FloatArray

    @property
    def has_file(self) -> bool:
        """True if a mesh file belongs to it."""
        return any(shape.file is not None for shape in (*self.link.visuals, *self.link.collisions))

    @property
    def line(self) -> int:
        """Line of its first shape."""
        return min(shape.line for shape in (*self.link.visuals, *self.link.collisions))


def extents_of(robot: Robot) -> dict[str, Extent]:
    """Measure the room of every link, keyed by link; links without geometry are omitted."""
    found = {}
    poses = forward_kinematics(robot, {})
    for link in robot.links:
        clouds = [shape.mesh.vertices for shape in (*link.visuals, *link.collisions) if len(shape.mesh.vertices)]
        if clouds:
            points = np.concatenate(clouds)
            placed = transformed(points, poses[link.name])
            found[link.name] = Extent(
                link=link,
                diagonal=float(np.linalg.norm(np.ptp(points, axis=0))),
                low=placed.min(axis=0),
                high=placed.max(axis=0),
            )
    return found


def gaps_between(robot: Robot, extents: dict[str, Extent]) -> Iterator[tuple[str, float, float]]:
    """Yield for each link the joint above it, its gap to the next link above with geometry, and both sizes [m].

    The gap is that of the bounding boxes, the sizes are added up; of several joints in between, the longest counts.
    """
    above = robot.joint_above
    for name, extent in extents.items():
        joints = []
        place = name
        while place in above and (place == name or place not in extents):
            joints.append(above[place])
            place = above[place].parent
        if joints and place in extents:
            parent = extents[place]
            gap = np.maximum(0.0, np.maximum(extent.low - parent.high, parent.low - extent.high))
            farthest = max(joints, key=lambda joint: float(np.linalg.norm(joint.T_parent_child[:3, 3])))
            yield farthest.name, float(np.linalg.norm(gap)), extent.diagonal + parent.diagonal
