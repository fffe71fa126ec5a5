"""Ground truth about an erased model: what the method must find out."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.robot.arrays import ReadOnlyArrays, json_values
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Mimic

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.arrays import FloatArray

SCHEMA = 1
"""Number of the JSON layout; raised whenever a reader of the old one would go wrong."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TrueJoint(ReadOnlyArrays):
    """One movable joint between two parts, in the world frame; its zero is the erased pose."""

    name: str
    """Unique; `source`, with a number behind it where one joint of the description stands in several chains."""
    source: str
    """Name in the description."""
    kind: JointType
    parent: int
    """Index of the part that carries it."""
    child: int
    """Index of the part that moves."""
    axis: FloatArray
    """Unit direction, shape (3,); positive motion follows the right hand rule or goes along it. Read-only."""
    pivot: FloatArray
    """A point on the axis [m], shape (3,). Read-only."""
    lower: float
    """Limit relative to the erased pose [rad or m]; -inf for continuous."""
    upper: float
    """Limit relative to the erased pose [rad or m]; +inf for continuous."""
    value: float
    """Value in the description's terms at the erased pose [rad or m]; `lower` + `value` is the described limit."""
    serial: int = 0
    """Place in the chain of joints between the two parts, 0 next to the parent."""
    chain_length: int = 1
    """Joints between the two parts; more than 1 where links without geometry stand between them."""
    mimic: Mimic | None = None
    """Leader, by its name in the description; between values of the description."""


@dataclass(frozen=True, kw_only=True, eq=False)
class GroundTruth:
    """The tree of parts and the joints between them."""

    name: str
    """Of the robot."""
    part_names: tuple[str, ...]
    """Anonymous names, as the method sees them."""
    part_links: tuple[tuple[str, ...], ...]
    """Links of the description that each part consists of."""
    joints: tuple[TrueJoint, ...]
    """Parents before children, along each chain from parent to child."""
    dropped: tuple[str, ...]
    """Movable joints of the description that stand between no two parts."""
    configuration: Mapping[str, float] = field(default_factory=dict)
    """Value of every movable joint of the description at the erased pose [rad or m]."""
    pose: str
    """``rest`` or ``random``."""
    seed: int
    yaw_deg: float

    @property
    def parents(self) -> tuple[int, ...]:
        """Parent of every part, -1 for the root."""
        parents = [-1] * len(self.part_names)
        for joint in self.joints:
            parents[joint.child] = joint.parent
        return tuple(parents)

    @property
    def root(self) -> int:
        """Index of the root part."""
        return self.parents.index(-1)

    def to_json(self) -> str:
        """Return the truth as JSON text; unlimited is null."""
        return json.dumps({"schema": SCHEMA, **json_values(self)}, indent=1, allow_nan=False)
