"""How far the contact of two bodies opens while one of them moves: a bearing or a guide in use stays closed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.transforms import joint_motion

if TYPE_CHECKING:
    from kinematify.joints.bearings.line import Line
    from kinematify.joints.measure.workspace import PartCache
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.joint_type import JointType

_STEPS = 4
"""Places to each side at which the contact is looked at."""


@dataclass(frozen=True, kw_only=True)
class Opening:
    """How far half of a contact has opened, where it has opened most."""

    width: float
    """[m]"""
    at: float
    """Value of the joint, zero at rest [rad or m]."""


class Contact:
    """Two bodies that touch at rest, and the places where they do."""

    def __init__(self, cache: PartCache, parent: int, child: int, *, band: float) -> None:
        """Gather the places.

        Args:
            cache: The bodies at rest.
            parent: Index of the body that stands.
            child: Index of the body that moves.
            band: Places this much farther apart than the nearest are in contact too [m].
        """
        self._cache, self._parent, self._child = cache, parent, child
        found = cache.contact(parent, child, band)
        self._of_child, self._of_parent = found.points, found.parent_points
        self._at_rest = cache.distances(parent, self._of_child), cache.distances(child, self._of_parent)

    @property
    def places(self) -> int:
        """Samples of the larger side."""
        return max(len(self._of_child), len(self._of_parent))

    def opening(self, kind: JointType, line: Line, lower: float, upper: float) -> Opening:
        """Return how far half of the contact opens, on the side of the body on which less does.

        Args:
            kind: Type of the joint.
            line: Its axis, world frame at rest.
            lower: End of the motion below rest [rad or m].
            upper: End above rest [rad or m].
        """
        values = np.concatenate([np.linspace(0.0, end, _STEPS + 1) for end in (lower, upper)])
        motions = [joint_motion(kind, line.axis, line.point, value) for value in values.tolist()]
        widths = [self._width(T[:3, :3], T[:3, 3]) for T in motions]
        widest = int(np.argmax(widths))
        return Opening(width=widths[widest], at=float(values[widest]))

    def _width(self, rotation: FloatArray, shift: FloatArray) -> float:
        of_child = self._grown(self._parent, self._of_child @ rotation.T + shift, self._at_rest[0])
        return min(of_child, self._grown(self._child, (self._of_parent - shift) @ rotation, self._at_rest[1]))

    def _grown(self, body: int, places: FloatArray, before: FloatArray) -> float:
        """By how much half of some places are farther from a body than before; infinite without places."""
        return float(np.median(self._cache.distances(body, places) - before)) if len(places) else float("inf")
