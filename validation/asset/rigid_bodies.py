"""Rigid bodies with their mass, the room that links take, and the loads that joints bear against gravity."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull

from kinematify.geometry.convex import enclosed_volume, outermost, thickened
from kinematify.geometry.sampling import spread_rows
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Inertial, forward_kinematics, rest_configuration, rigid_groups
from kinematify.robot.vectors import referenced

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.config.validation import PhysicsSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Link, LinkMesh, Robot, Shape

_DIRECTIONS = 200
"""The hull of the outermost points in so many directions leaves 1 % of a ball's volume out."""
_THINNEST = 1e-4
"""Flat geometry counts as this thick, fraction of its diagonal."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Room:
    """The room that some geometry takes, in the frame of a link."""

    points: FloatArray
    """Its outermost points [m], shape (k, 3)."""
    solid: float | None
    """Volume inside its surfaces [m^3]; None where one of them is open."""

    @cached_property
    def low(self) -> FloatArray:
        """Lower corner of the bounding box [m], shape (3,)."""
        return np.asarray(self.points.min(axis=0))

    @cached_property
    def high(self) -> FloatArray:
        """Upper corner."""
        return np.asarray(self.points.max(axis=0))

    @cached_property
    def diagonal(self) -> float:
        """[m]."""
        return float(np.linalg.norm(self.high - self.low))

    @cached_property
    def hull(self) -> ConvexHull:
        """Convex hull of the points, with a little thickness where they are flat."""
        return ConvexHull(thickened(self.points, max(_THINNEST * self.diagonal, 1e-9)))

    def outside(self, point: FloatArray) -> float:
        """Return how far a point lies outside the hull at least [m], negative inside."""
        return float((self.hull.equations[:, :3] @ point + self.hull.equations[:, 3]).max())


class Rooms:
    """Rooms of shapes; each mesh is measured once, since visual and collision geometry are often the same file."""

    def __init__(self) -> None:
        """Begin without any."""
        self._of_mesh: dict[bytes, Room] = {}

    def of(self, shapes: Sequence[Shape]) -> Room | None:
        """Measure shapes; None where there is nothing to measure."""
        rooms = [self._measured(shape.mesh) for shape in shapes if len(shape.mesh.faces)]
        if len(rooms) < 2:
            return rooms[0] if rooms else None
        return Room(points=np.concatenate([room.points for room in rooms]), solid=_sum(room.solid for room in rooms))

    def _measured(self, mesh: LinkMesh) -> Room:
        made_of = blake2b(mesh.vertices.tobytes())
        made_of.update(mesh.faces.tobytes())
        key = made_of.digest()
        if key not in self._of_mesh:
            points = outermost(referenced(mesh.vertices, mesh.faces), _DIRECTIONS)
            self._of_mesh[key] = Room(points=points, solid=enclosed_volume(mesh.vertices, mesh.faces))
        return self._of_mesh[key]


def _sum(volumes: Iterable[float | None]) -> float | None:
    """Sum of volumes; None where one of them is unknown."""
    total = 0.0
    for volume in volumes:
        if volume is None:
            return None
        total += volume
    return total


@dataclass(frozen=True, kw_only=True, eq=False)
class Body:
    """Links that fixed joints hold together."""

    links: tuple[Link, ...]
    """The link nearest the root first."""
    T_body_link: dict[str, FloatArray]
    """Pose of each link in the frame of the first."""
    joint: str | None
    """The joint that moves it; None for the body of the root."""
    rooms: dict[str, Room]
    """Room of each link that has geometry, in the link's own frame, visual and collision geometry together."""

    @property
    def moves(self) -> bool:
        """False for the body of the root."""
        return self.joint is not None

    @property
    def called(self) -> str:
        """Name of the link that says where it is: the largest, or the first where none has geometry."""
        return max(self.rooms, key=lambda name: self.rooms[name].diagonal) if self.rooms else self.links[0].name

    @cached_property
    def mass(self) -> float:
        """Sum of the masses above zero [kg]."""
        return sum(link.inertial.mass for link in self.links if link.inertial is not None and link.inertial.mass > 0.0)

    @cached_property
    def fused(self) -> Inertial | None:
        """Mass properties of all links together in the frame of the first, as engines fuse them; None without mass."""
        if self.mass <= 0.0:
            return None
        weighed = [
            (self.T_body_link[link.name], link.inertial)
            for link in self.links
            if link.inertial is not None and link.inertial.mass > 0.0
        ]
        centres = [T[:3, :3] @ inertial.center_of_mass + T[:3, 3] for T, inertial in weighed]
        centre = np.sum([item.mass * at for (_, item), at in zip(weighed, centres, strict=True)], axis=0) / self.mass
        tensor = np.zeros((3, 3))
        for (T, inertial), at in zip(weighed, centres, strict=True):
            arm = at - centre
            tensor += T[:3, :3] @ inertial.tensor @ T[:3, :3].T
            tensor += inertial.mass * (float(arm @ arm) * np.eye(3) - np.outer(arm, arm))
        return Inertial(mass=self.mass, center_of_mass=centre, tensor=tensor)

    @cached_property
    def heaviest(self) -> Link:
        """The link that a wrong mass is most likely written at."""
        return max(self.links, key=lambda link: 0.0 if link.inertial is None else link.inertial.mass)

    @property
    def named(self) -> str:
        """The heaviest link and how many are fixed to it, for messages about all of them."""
        others = len(self.links) - 1
        return f"The link {self.heaviest.name}" + f" with the {others} fixed to it" * bool(others)

    @cached_property
    def room(self) -> Room | None:
        """Room of all links together, in the frame of the first."""
        return self.placed(self.rooms)

    def placed(self, rooms: Mapping[str, Room]) -> Room | None:
        """Put rooms of its links together in the frame of the first link; None where there are none."""
        if not rooms:
            return None
        points = [
            room.points @ self.T_body_link[name][:3, :3].T + self.T_body_link[name][:3, 3]
            for name, room in rooms.items()
        ]
        return Room(points=np.concatenate(points), solid=_sum(room.solid for room in rooms.values()))


@dataclass(frozen=True, kw_only=True, eq=False)
class Physics:
    """A model with what was measured of it."""

    model: Robot
    settings: PhysicsSettings
    bodies: tuple[Body, ...]
    """The root's first, parents before children."""
    visual: dict[str, Room]
    """Room of the visual geometry of each link that has some, in the link's frame."""
    collision: dict[str, Room]
    """The same for the collision geometry."""
    rooms: Rooms
    """What all of them were measured by."""

    @cached_property
    def body_of(self) -> dict[str, Body]:
        """Body of every link."""
        return {link.name: body for body in self.bodies for link in body.links}

    @cached_property
    def diagonal(self) -> float:
        """Diagonal of the model at zero [m]; 0 without geometry."""
        poses = forward_kinematics(self.model, {})
        placed = [
            body.room.points @ poses[body.links[0].name][:3, :3].T + poses[body.links[0].name][:3, 3]
            for body in self.bodies
            if body.room is not None
        ]
        return float(np.linalg.norm(np.ptp(np.concatenate(placed), axis=0))) if placed else 0.0

    @cached_property
    def worst_loads(self) -> dict[str, tuple[float, dict[str, float]]]:
        """Largest weight at each joint [N m or N] and the configuration that it was found in, keyed by joint."""
        return worst_loads(self.model, self.settings.load_doublings)

    def inflation(self, shape: Shape) -> float:
        """Volume of the hull of a closed mesh over its own; 0 for other shapes."""
        room = self.rooms.of([shape]) if shape.kind == "mesh" else None
        return 0.0 if room is None or room.solid is None else float(room.hull.volume) / room.solid


def measure(model: Robot, settings: PhysicsSettings) -> Physics:
    """Measure every link once."""
    rooms = Rooms()
    links = [link for link in model.links if link.name not in model.lacking]
    visual = {link.name: room for link in links if (room := rooms.of(link.visuals)) is not None}
    collision = {link.name: room for link in links if (room := rooms.of(link.collisions)) is not None}
    poses = forward_kinematics(model, {})
    bodies = []
    for group in rigid_groups(model):
        above = model.joint_above.get(group.top)
        T_body_world = np.linalg.inv(poses[group.top])
        bodies.append(
            Body(
                links=tuple(model.link_by_name[name] for name in group.links),
                T_body_link={name: T_body_world @ poses[name] for name in group.links},
                joint=None if above is None else above.name,
                # nobody knows the room of a body of which a shape is missing
                rooms={}
                if model.lacking.intersection(group.links)
                else {name: room for name in group.links if (room := _both(name, visual, collision)) is not None},
            )
        )
    return Physics(
        model=model, settings=settings, bodies=tuple(bodies), visual=visual, collision=collision, rooms=rooms
    )


def _both(name: str, visual: dict[str, Room], collision: dict[str, Room]) -> Room | None:
    """Visual and collision geometry together; the volume is that of the visual one, which shows the true shape."""
    seen, felt = visual.get(name), collision.get(name)
    if seen is None or felt is None:
        return seen or felt
    return Room(points=np.concatenate([seen.points, felt.points]), solid=seen.solid)


_GRAVITY = 9.81
_NO_LIMIT = np.pi
"""Range to each side in which a joint without limits is looked at [rad]."""


def worst_loads(robot: Robot, doublings: int) -> dict[str, tuple[float, dict[str, float]]]:
    """Return the largest weight at each joint [N m or N] and the configuration that it was found in.

    Args:
        robot: Its root is fixed, and gravity acts along -z of it.
        doublings: Of the number of configurations that are looked at beside rest.
    """
    loads: dict[str, tuple[float, dict[str, float]]] = {}
    for q in _configurations(robot, doublings):
        poses = forward_kinematics(robot, q)
        carried = _carried(robot, poses)
        for joint in robot.joints:
            if joint.kind is JointType.FIXED:
                continue
            mass, moment = carried[joint.child]
            axis = poses[joint.child][:3, :3] @ joint.axis
            load = mass * abs(axis[2])
            if joint.kind.turns:
                lever = moment - mass * poses[joint.child][:3, 3]
                load = abs(float(axis[1] * lever[0] - axis[0] * lever[1]))
            if _GRAVITY * load > loads.get(joint.name, (0.0, {}))[0]:
                loads[joint.name] = _GRAVITY * float(load), q
    return loads


def _configurations(robot: Robot, doublings: int) -> list[dict[str, float]]:
    """Rest and quasi-random configurations within the limits."""
    joints = robot.leaders
    rest = rest_configuration(robot)
    found = [{joint.name: rest[joint.name] for joint in joints}]
    if joints:
        ends = np.array([[joint.lower, joint.upper] for joint in joints])
        low, high = np.clip(ends, -_NO_LIMIT, _NO_LIMIT).T
        values = spread_rows(low, high, 2**doublings, seed=0)
        found += [dict(zip([joint.name for joint in joints], row.tolist(), strict=True)) for row in values]
    return found


def _carried(robot: Robot, poses: dict[str, FloatArray]) -> dict[str, tuple[float, FloatArray]]:
    """Mass [kg] and mass times centre [kg m] of each link with all that hangs on it, world frame."""
    carried: dict[str, tuple[float, FloatArray]] = {}
    for link in robot.links:
        mass = 0.0 if link.inertial is None else max(link.inertial.mass, 0.0)
        centre = np.zeros(3) if link.inertial is None else link.inertial.center_of_mass
        pose = poses[link.name]
        carried[link.name] = mass, mass * (pose[:3, :3] @ centre + pose[:3, 3])
    for joint in reversed(robot.joints_downward):
        mass, moment = carried[joint.parent]
        more, further = carried[joint.child]
        carried[joint.parent] = mass + more, moment + further
    return carried
