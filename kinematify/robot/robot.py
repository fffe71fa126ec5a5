"""A robot description: links with meshes, single-axis joints, and where every link stands in a configuration."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import DescriptionError
from kinematify.robot.arrays import read_only
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.arrays import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkMesh:
    """One geometry element of a link as triangles."""

    vertices: FloatArray
    """Link frame [m], shape (V, 3). Read-only."""
    faces: IntArray
    """Shape (F, 3). Read-only."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", read_only(self.vertices, np.float64))
        object.__setattr__(self, "faces", read_only(self.faces, np.int64))


@dataclass(frozen=True, kw_only=True, eq=False)
class DescribedLink:
    """A link; without meshes it is only a frame."""

    name: str
    meshes: tuple[LinkMesh, ...] = ()
    """Visual geometry, or collision geometry where there is no visual one."""
    from_collision: bool = False
    """True where `meshes` are the collision geometry."""

    @property
    def has_geometry(self) -> bool:
        """True if it has at least one triangle."""
        return any(len(mesh.faces) for mesh in self.meshes)


@dataclass(frozen=True, kw_only=True)
class Mimic:
    """value = multiplier * value of `joint` + offset."""

    joint: str
    """Name of the leader."""
    multiplier: float
    offset: float
    """[rad or m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DescribedJoint:
    """A joint; its frame is the child link's frame."""

    name: str
    kind: JointType
    parent: str
    child: str
    T_parent_child: FloatArray
    """Child frame in the parent frame at zero, shape (4, 4). Read-only."""
    axis: FloatArray
    """Unit direction in the joint frame, shape (3,). Read-only."""
    lower: float
    """[rad or m]; -inf for continuous, 0 for fixed."""
    upper: float
    """[rad or m]; +inf for continuous, 0 for fixed."""
    mimic: Mimic | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "T_parent_child", read_only(self.T_parent_child, np.float64))
        object.__setattr__(self, "axis", read_only(self.axis, np.float64))

    def motion(self, value: float) -> FloatArray:
        """Return the transform of the child in the joint frame, shape (4, 4), at `value` [rad or m]."""
        transform = np.eye(4)
        if self.kind.turns:
            transform[:3, :3] = rotation_about(self.axis, value)
        elif self.kind is JointType.PRISMATIC:
            transform[:3, 3] = value * self.axis
        return transform


@dataclass(frozen=True, kw_only=True, eq=False)
class RobotDescription:
    """A kinematic tree as it was described; links and joints in the order of the document."""

    name: str
    links: tuple[DescribedLink, ...]
    joints: tuple[DescribedJoint, ...]
    """As many as links less one: one root, no cycle."""
    notes: tuple[str, ...] = ()
    """What was read with a meaning that the document does not state plainly, one sentence each."""

    @cached_property
    def link_by_name(self) -> dict[str, DescribedLink]:
        """Links keyed by name."""
        return {link.name: link for link in self.links}

    @cached_property
    def joint_by_name(self) -> dict[str, DescribedJoint]:
        """Joints keyed by name."""
        return {joint.name: joint for joint in self.joints}

    @cached_property
    def joint_above(self) -> dict[str, DescribedJoint]:
        """Joint that carries a link, keyed by the link; the root is missing."""
        return {joint.child: joint for joint in self.joints}

    @cached_property
    def joints_below(self) -> dict[str, tuple[DescribedJoint, ...]]:
        """Joints that hang on a link, keyed by the link."""
        below: dict[str, list[DescribedJoint]] = defaultdict(list)
        for joint in self.joints:
            below[joint.parent].append(joint)
        return {link.name: tuple(below[link.name]) for link in self.links}

    @cached_property
    def root(self) -> str:
        """Name of the link that no joint carries."""
        return next(link.name for link in self.links if link.name not in self.joint_above)

    @cached_property
    def joints_downward(self) -> tuple[DescribedJoint, ...]:
        """All joints, parents before children, breadth first."""
        found: list[DescribedJoint] = []
        frontier = [self.root]
        for link in frontier:
            found.extend(self.joints_below[link])
            frontier.extend(joint.child for joint in self.joints_below[link])
        return tuple(found)


@dataclass(frozen=True, kw_only=True)
class RigidGroup:
    """Links that fixed joints hold together; one part of the assembly if it has geometry."""

    links: tuple[str, ...]
    """The link nearest the root first."""
    has_geometry: bool

    @property
    def top(self) -> str:
        """The link nearest the root; the group's only connection upward is the joint above it."""
        return self.links[0]


def rigid_groups(description: RobotDescription) -> tuple[RigidGroup, ...]:
    """Return the groups of links joined by fixed joints, the root's first, parents before children."""
    members: dict[str, list[str]] = {description.root: [description.root]}
    top_of = {description.root: description.root}
    for joint in description.joints_downward:
        top = top_of[joint.parent] if joint.kind is JointType.FIXED else joint.child
        top_of[joint.child] = top
        members.setdefault(top, []).append(joint.child)
    return tuple(
        RigidGroup(links=tuple(links), has_geometry=any(description.link_by_name[n].has_geometry for n in links))
        for links in members.values()
    )


def joint_values(description: RobotDescription, q: Mapping[str, float]) -> dict[str, float]:
    """Return the value of every joint [rad or m]: leaders from `q`, followers by their mimic rule, the rest 0.

    Args:
        description: The robot.
        q: Joint name -> value; followers and fixed joints in it have no effect.

    Raises:
        DescriptionError: `q` names a joint that the robot does not have.
    """
    unknown = sorted(set(q) - set(description.joint_by_name))
    if unknown:
        raise DescriptionError(
            f"The robot {description.name} has no joint {unknown[0]}. Its joints are "
            f"{', '.join(sorted(description.joint_by_name))}."
        )
    return {joint.name: _value(description, joint, q) for joint in description.joints}


def _value(description: RobotDescription, joint: DescribedJoint, q: Mapping[str, float]) -> float:
    if joint.kind is JointType.FIXED:
        return 0.0
    if joint.mimic is None:
        return float(q.get(joint.name, 0.0))
    leader = description.joint_by_name[joint.mimic.joint]
    return joint.mimic.multiplier * _value(description, leader, q) + joint.mimic.offset


def forward_kinematics(description: RobotDescription, q: Mapping[str, float]) -> dict[str, FloatArray]:
    """Return T_world_link of every link, shape (4, 4); the root link's frame is the world.

    Args:
        description: The robot.
        q: Joint name -> value [rad or m]; missing joints stand at zero, followers follow their leader.

    Raises:
        DescriptionError: `q` names a joint that the robot does not have.
    """
    values = joint_values(description, q)
    poses: dict[str, FloatArray] = {description.root: np.eye(4)}
    for joint in description.joints_downward:
        poses[joint.child] = poses[joint.parent] @ joint.T_parent_child @ joint.motion(values[joint.name])
    return poses


def rest_configuration(description: RobotDescription) -> dict[str, float]:
    """Return the rest value of every joint: zero, or mid-limits where zero lies outside; followers follow."""
    leaders = {
        joint.name: 0.0 if joint.lower <= 0.0 <= joint.upper else 0.5 * (joint.lower + joint.upper)
        for joint in description.joints
        if joint.mimic is None
    }
    return joint_values(description, leaders)


def rotation_about(axis: FloatArray, angle: float) -> FloatArray:
    """Return the rotation matrix, shape (3, 3), by `angle` [rad] about a unit `axis` (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix: FloatArray = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return matrix
