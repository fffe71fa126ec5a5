"""A robot: links with mass and geometry, single-axis joints, and where every link stands in a configuration."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import DescriptionError
from kinematify.robot.arrays import ReadOnlyArrays
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import joint_motion, rotation_about, transformed
from kinematify.robot.vectors import as_one

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.robot.appearance import Appearance, Rgba
    from kinematify.robot.arrays import FloatArray, IntArray

_UNLIMITED_TURN = np.pi
_NO_LIMIT = 10.0
"""Limits of plus and minus this are how files say that there is none [rad]."""
_ROUNDED = 1e-3
"""Share by which limits of three digits, such as 9.42, miss whole half turns."""
_WIDEST_TURN = 4.0 * np.pi
"""Wider ranges [rad] repeat the same poses."""
_WIDEST_SLIDE = 100.0
"""Beyond it [m] floating-point error of the pose would be taken for disagreement."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkMesh(ReadOnlyArrays):
    """One geometry element of a link as triangles."""

    vertices: FloatArray
    """Link frame [m], shape (V, 3). Read-only."""
    faces: IntArray
    """Shape (F, 3). Read-only."""
    appearance: Appearance | None = None
    """Of the faces, from the mesh file or from the colour that the link states; None where neither says anything, and
    where it was not asked for."""

    @property
    def is_dressed(self) -> bool:
        """True if it has several materials or a texture."""
        look = self.appearance
        return look is not None and (len(look.materials) > 1 or look.is_textured)


@dataclass(frozen=True, kw_only=True, eq=False)
class Shape(ReadOnlyArrays):
    """One `visual` or `collision` element."""

    kind: str = "mesh"
    """``mesh``, ``box``, ``cylinder``, ``sphere`` or ``capsule``."""
    mesh: LinkMesh
    """Its triangles in the link frame [m]; primitives are tessellated."""
    file: Path | None = None
    """Mesh file, resolved; None for primitives and for meshes that come from no file."""
    scale: FloatArray = field(default_factory=lambda: np.ones(3))
    """Scale of a mesh as written, ones for primitives, shape (3,). Read-only."""
    size: tuple[float, ...] = ()
    """Box: x, y, z; cylinder and capsule: radius, length; sphere: radius [m]; empty for a mesh."""
    T_link_shape: FloatArray = field(default_factory=lambda: np.eye(4))
    """The element's origin, shape (4, 4). Read-only."""
    color: Rgba | None = None
    """Red, green, blue, opacity in [0, 1]; None where the file states none."""
    concave: bool = False
    """Whether the file asks engines to collide its surface, not its hull (``concave="yes"``, respected by PyBullet)."""
    line: int = 0
    """Where the file declares it; 0 for what no file declares, here and below."""

    @property
    def plain_color(self) -> Rgba | None:
        """The colour that the document states, else that of the mesh file where it has one; None where neither does."""
        look = self.mesh.appearance
        return look.materials[0].color if self.color is None and look and not self.mesh.is_dressed else self.color


@dataclass(frozen=True, kw_only=True)
class UpAxis:
    """Up axis of meshes whose files state that another axis than z points up."""

    respected: bool
    """Whether they were turned upright."""
    gap_ignored: float
    """Mean gap at rest between links that a joint connects, if it is ignored [m]."""
    gap_respected: float
    """The same if it is respected [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Inertial(ReadOnlyArrays):
    """Mass properties of a link, expressed in the link frame."""

    mass: float
    """[kg]; a file may declare one that is not above zero."""
    center_of_mass: FloatArray
    """Link frame [m], shape (3,). Read-only."""
    tensor: FloatArray
    """About the centre of mass, axes of the link frame [kg m^2], shape (3, 3). Read-only."""
    source: str = "file"
    """``file``; or ``volume`` for a closed mesh, ``hull`` for the convex hull of an open or flat one, ``ball`` for a
    small ball in the place of a mere frame."""
    line: int = 0


def inertial_of(mass: float, T_link_inertial: FloatArray, moments: Iterable[float], line: int) -> Inertial:
    """Return mass properties from xx, xy, xz, yy, yz and zz [kg m^2] in the axes of a frame at the centre of mass."""
    xx, xy, xz, yy, yz, zz = moments
    turn, tensor = T_link_inertial[:3, :3], np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return Inertial(mass=mass, center_of_mass=T_link_inertial[:3, 3], tensor=turn @ tensor @ turn.T, line=line)


@dataclass(frozen=True, kw_only=True, eq=False)
class Link:
    """A rigid body; without shapes it is only a frame."""

    name: str
    inertial: Inertial | None = None
    visuals: tuple[Shape, ...] = ()
    collisions: tuple[Shape, ...] = ()
    line: int = 0

    @cached_property
    def meshes(self) -> tuple[LinkMesh, ...]:
        """Visual geometry, or collision geometry where there is no visual one."""
        return tuple(shape.mesh for shape in self.visuals or self.collisions)

    @cached_property
    def has_geometry(self) -> bool:
        """True if it has at least one triangle."""
        return any(len(shape.mesh.faces) for shape in (*self.visuals, *self.collisions))


@dataclass(frozen=True, kw_only=True)
class Mimic:
    """value = multiplier * value of `joint` + offset."""

    joint: str
    """Name of the leader."""
    multiplier: float
    offset: float
    """[rad or m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Closure(ReadOnlyArrays):
    """A joint of a closed chain follows the joint that drives the chain along a curve."""

    joint: str
    """Name of the driver."""
    at: FloatArray
    """Values of the driver, rising [rad or m], shape (n,). Read-only."""
    values: FloatArray
    """Values of the follower there [rad or m], shape (n,). Read-only."""
    repeats: bool = False
    """The curve is one turn of a driver that turns without end."""

    def follow(self, driver: FloatArray) -> FloatArray:
        """Return the follower's values at values of the driver [rad or m], (n,); beyond the curve those at its end."""
        if not self.repeats:
            return np.asarray(np.interp(driver, self.at, self.values))
        turns = np.floor((driver - self.at[0]) / (2.0 * np.pi))
        within = np.interp(driver - 2.0 * np.pi * turns, self.at, self.values)
        return np.asarray(within + turns * (self.values[-1] - self.values[0]))


@dataclass(frozen=True, kw_only=True, eq=False)
class Joint(ReadOnlyArrays):
    """A joint; its frame is the child link's frame."""

    name: str
    kind: JointType
    parent: str
    child: str
    T_parent_child: FloatArray
    """Child frame in the parent frame at zero, shape (4, 4). Read-only."""
    axis: FloatArray = field(default_factory=lambda: np.array([1.0, 0.0, 0.0]))
    """Unit direction in the joint frame, shape (3,). Read-only."""
    lower: float = 0.0
    """[rad or m]; -inf for continuous, 0 for fixed."""
    upper: float = 0.0
    """[rad or m]; +inf for continuous, 0 for fixed."""
    mimic: Mimic | None = None
    closure: Closure | None = None
    """How it follows another one since a chain closes (`robot.linkage`); no file states it, the loops of a robot do."""
    declared_kind: str = ""
    """Type as a file declares it, e.g. ``floating``, which `kind` has as fixed; empty where no file does."""
    has_limit: bool = True
    """False if a file declares no `limit`."""
    effort: float | None = None
    """[N m or N]; None where absent."""
    velocity: float | None = None
    """[rad/s or m/s]; None where absent."""
    damping: float | None = None
    """[N m s/rad or N s/m]; None where absent."""
    friction: float | None = None
    """[N m or N]; None where absent."""
    line: int = 0

    @property
    def leads(self) -> bool:
        """True if it moves by itself: neither fixed, nor mimic, nor driven by another joint of a closed chain."""
        return self.kind is not JointType.FIXED and self.mimic is None and self.closure is None

    @property
    def is_limited(self) -> bool:
        """True if both of its limits are finite; a fixed one's are."""
        return bool(np.isfinite([self.lower, self.upper]).all())

    @property
    def endless(self) -> bool:
        """True of a hinge whose limits say that there are none: infinite, 10 rad, or three to eight half turns."""
        if not self.kind.turns or self.lower != -self.upper:
            return False
        if self.upper in (_NO_LIMIT, np.inf):
            return True
        half_turns = self.upper / np.pi
        return bool(2.5 < half_turns < 8.5 and abs(half_turns - round(half_turns)) < _ROUNDED * half_turns)

    def motion(self, value: float) -> FloatArray:
        """Return the transform of the child in the joint frame, shape (4, 4), at `value` [rad or m]."""
        return joint_motion(self.kind, self.axis, np.zeros(3), value)

    def motions(self, values: FloatArray) -> FloatArray:
        """Return `motion` at many values [rad or m], shape (n, 4, 4)."""
        motions = np.broadcast_to(np.eye(4), (len(values), 4, 4)).copy()
        if self.kind.turns:
            motions[:, :3, :3] = rotation_about(self.axis, values)
        elif self.kind is JointType.PRISMATIC:
            motions[:, :3, 3] = values[:, None] * self.axis
        return motions


@dataclass(frozen=True, kw_only=True, eq=False)
class LoopJoint:
    """Two links that share a point besides the joints of the tree: it closes a chain of joints.

    In a URDF it is a `drake:ball_constraint`, or a `loop_joint` of Isaac Sim; readers that know trees alone leave it
    out.
    """

    name: str
    links: tuple[str, str]
    points: tuple[FloatArray, FloatArray]
    """The point in the frame of either link [m], each of shape (3,)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Robot:
    """A kinematic tree; links and joints in the order of the document."""

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    """As many as links less one: one root, no cycle."""
    loops: tuple[LoopJoint, ...] = ()
    """What closes chains besides."""
    apart: frozenset[frozenset[str]] = frozenset()
    """Pairs of links with collision geometry that the file keeps from colliding."""
    path: Path = Path()
    """The URDF file, absolute; the working directory for what was read from none."""
    notes: tuple[str, ...] = ()
    """What was read with a meaning that the document does not state plainly, one sentence each."""
    lacking: frozenset[str] = frozenset()
    """Links with a ``collision`` whose shape is missing or cannot be read."""
    up_axis: UpAxis | None = None
    """How an up axis that meshes state was read; None where none states another one than z."""

    @cached_property
    def link_by_name(self) -> dict[str, Link]:
        """Links keyed by name."""
        return {link.name: link for link in self.links}

    @cached_property
    def joint_by_name(self) -> dict[str, Joint]:
        """Joints keyed by name."""
        return {joint.name: joint for joint in self.joints}

    @cached_property
    def joint_above(self) -> dict[str, Joint]:
        """Joint that carries a link, keyed by the link; the root is missing."""
        return {joint.child: joint for joint in self.joints}

    @cached_property
    def joints_below(self) -> dict[str, tuple[Joint, ...]]:
        """Joints that hang on a link, keyed by the link."""
        below: dict[str, list[Joint]] = defaultdict(list)
        for joint in self.joints:
            below[joint.parent].append(joint)
        return {link.name: tuple(below[link.name]) for link in self.links}

    @cached_property
    def root(self) -> str:
        """Name of the link that no joint carries."""
        return next(link.name for link in self.links if link.name not in self.joint_above)

    @cached_property
    def leaders(self) -> tuple[Joint, ...]:
        """Joints that move by themselves (neither fixed nor mimic), in the order of the document."""
        return tuple(joint for joint in self.joints if joint.leads)

    @cached_property
    def joints_downward(self) -> tuple[Joint, ...]:
        """All joints, parents before children, breadth first."""
        found: list[Joint] = []
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


def rigid_groups(robot: Robot) -> tuple[RigidGroup, ...]:
    """Return the groups of links joined by fixed joints, the root's first, parents before children."""
    members: dict[str, list[str]] = {robot.root: [robot.root]}
    top_of = {robot.root: robot.root}
    for joint in robot.joints_downward:
        top = top_of[joint.parent] if joint.kind is JointType.FIXED else joint.child
        top_of[joint.child] = top
        members.setdefault(top, []).append(joint.child)
    return tuple(
        RigidGroup(links=tuple(links), has_geometry=any(robot.link_by_name[n].has_geometry for n in links))
        for links in members.values()
    )


def fixed_together(robot: Robot, link: str) -> tuple[str, ...]:
    """Return the links that no joint moves against a link, itself included, parents before children."""
    return next(group.links for group in rigid_groups(robot) if link in group.links)


def group_mesh(robot: Robot, group: RigidGroup, zero: Mapping[str, FloatArray]) -> tuple[FloatArray, IntArray]:
    """Return all meshes of a group as one, frame of its top link: vertices (V, 3) and faces (F, 3).

    Args:
        robot: The robot.
        group: Of its links.
        zero: Pose of every link where all joints are at zero, shape (4, 4) each.
    """
    back = np.linalg.inv(zero[group.top])
    return as_one(
        (transformed(mesh.vertices, back @ zero[link]), mesh.faces)
        for link in group.links
        for mesh in robot.link_by_name[link].meshes
    )


def joint_values(robot: Robot, q: Mapping[str, float]) -> dict[str, float]:
    """Return the value of every joint [rad or m]: leaders from `q`, followers by their mimic rule, the rest 0.

    Args:
        robot: The robot.
        q: Joint name -> value; followers and fixed joints in it have no effect.

    Raises:
        DescriptionError: `q` names a joint that the robot does not have.
    """
    unknown = sorted(set(q) - set(robot.joint_by_name))
    if unknown:
        raise DescriptionError(
            f"The robot {robot.name} has no joint {unknown[0]}. Its joints are "
            f"{', '.join(sorted(robot.joint_by_name))}."
        )
    return {joint.name: _value(robot, joint, q) for joint in robot.joints}


def _value(robot: Robot, joint: Joint, q: Mapping[str, float]) -> float:
    if joint.kind is JointType.FIXED:
        return 0.0
    if joint.closure is not None:
        driver = _value(robot, robot.joint_by_name[joint.closure.joint], q)
        return float(joint.closure.follow(np.array([driver]))[0])
    if joint.mimic is None:
        return float(q.get(joint.name, 0.0))
    leader = robot.joint_by_name[joint.mimic.joint]
    return joint.mimic.multiplier * _value(robot, leader, q) + joint.mimic.offset


def forward_kinematics(robot: Robot, q: Mapping[str, float]) -> dict[str, FloatArray]:
    """Return T_world_link of every link, shape (4, 4); the root link's frame is the world.

    Args:
        robot: The robot.
        q: Joint name -> value [rad or m]; missing joints stand at zero, followers follow their leader.

    Raises:
        DescriptionError: `q` names a joint that the robot does not have.
    """
    values = joint_values(robot, q)
    poses: dict[str, FloatArray] = {robot.root: np.eye(4)}
    for joint in robot.joints_downward:
        poses[joint.child] = poses[joint.parent] @ joint.T_parent_child @ joint.motion(values[joint.name])
    return poses


def rest_configuration(robot: Robot) -> dict[str, float]:
    """Return the rest value of every joint: zero, or mid-limits where zero lies outside; followers follow."""
    leaders = {
        joint.name: 0.0 if joint.lower <= 0.0 <= joint.upper else 0.5 * (joint.lower + joint.upper)
        for joint in robot.joints
        if joint.mimic is None
    }
    return joint_values(robot, leaders)


def joint_ends(joints: Sequence[Joint]) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest value of each joint [rad or m], shape (n,) each; unlimited ones turn once."""
    widest = np.array([_WIDEST_TURN if joint.kind.turns else _WIDEST_SLIDE for joint in joints])
    given = [(joint.lower, joint.upper) if not joint.endless else (-np.inf, np.inf) for joint in joints]
    lower = np.array([low if np.isfinite(low) else -_UNLIMITED_TURN for low, _ in given])
    upper = np.array([high if np.isfinite(high) else _UNLIMITED_TURN for _, high in given])
    return np.clip(lower, -widest, widest), np.clip(upper, -widest, widest)
