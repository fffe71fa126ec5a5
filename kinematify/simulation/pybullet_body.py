"""Files in worlds of PyBullet.

PyBullet speaks in indices of its own and in tuples; nothing of either leaves this package.
"""

from __future__ import annotations

import weakref
from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
import pybullet as bullet

from kinematify.robot.mechanism import LeaderMechanism, joints_between
from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.engine_file import Unloadable

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Robot

_FLAGS = (
    bullet.URDF_USE_SELF_COLLISION
    | bullet.URDF_USE_SELF_COLLISION_INCLUDE_PARENT  # else neighbours pass through each other
    | bullet.URDF_USE_INERTIA_FROM_FILE  # else inertias are made up from the collision shapes
)
HULL_MARGIN = 1e-3
"""Bullet inflates convex hulls of meshes by it [m]; primitives keep their size."""
_BASE = -1
_PIN_FORCE = 1e6
"""Of a pin that closes a loop [N]: it never gives way."""
_PIN_ERP, _PIN_ITERATIONS = 0.8, 200
"""Share of a gap that a step closes, and iterations of the solver: with Bullet's own a driven clamp opens by .15 %."""


class Client:
    """A world, with PyBullet's functions for it; it is freed when nothing refers to it any more."""

    def __init__(self, connected: int | None = None) -> None:
        """Connect to a new world, in this process; `connected`: use a world of somebody else, and leave it open."""
        number = bullet.connect(bullet.DIRECT) if connected is None else connected
        self._named = {"physicsClientId": number}
        if connected is None:
            self.disconnect = weakref.finalize(self, bullet.disconnect, physicsClientId=number)
            """Frees it now, once: PyBullet gives the same number to the next one."""

    def __getattr__(self, name: str) -> Any:
        """A function of PyBullet in this world."""
        function = partial(getattr(bullet, name), **self._named)
        setattr(self, name, function)
        return function


@dataclass(frozen=True, kw_only=True, eq=False)
class PybulletBody:
    """A model in a world, and where the links and joints of the document stand in it."""

    client: Client
    body: int
    mechanism: LeaderMechanism
    link: IntArray
    """PyBullet's index of each link, -1 for the root, -2 for lost ones, shape (L,)."""
    joint: IntArray
    """PyBullet's index of each of `LeaderMechanism.joints`, -2 for lost ones, shape (J,)."""
    margin: FloatArray
    """By which each link's shapes are inflated [m], shape (L,)."""

    @property
    def complete(self) -> bool:
        """True if no link and no joint was lost."""
        return bool((self.link >= _BASE).all() and (self.joint >= 0).all())

    @cached_property
    def indices(self) -> list[int]:
        """`joint` as PyBullet wants it."""
        return [int(index) for index in self.joint]

    @cached_property
    def link_of(self) -> dict[int, int]:
        """Link of the document by PyBullet's index."""
        return {index: link for link, index in enumerate(self.link.tolist())}

    def place(self, values: FloatArray) -> None:
        """Set all joints, shape (J,) [rad or m], and stop them."""
        if self.indices:
            self.client.resetJointStatesMultiDof(
                self.body, self.indices, [[value] for value in values.tolist()], [[0.0]] * len(values)
            )

    def state(self) -> tuple[list[float], list[float], list[float]]:
        """Return values, speeds and motor torques of all joints."""
        states = self.client.getJointStates(self.body, self.indices) or ()
        return [s[0] for s in states], [s[1] for s in states], [s[3] for s in states]

    def forget_contacts(self) -> None:
        """Forget the contacts of earlier configurations.

        PyBullet keeps contacts from step to step as points that move with the bodies. Where a body was set to another
        place they are wrong, so all pairs are made to be found again.
        """
        for index in self.link.tolist():
            self.client.setCollisionFilterGroupMask(self.body, index, 1, 1)
        self.client.performCollisionDetection()

    def index_of(self, link: str) -> int:
        """PyBullet's index of a link."""
        return int(self.link[self.mechanism.links.index(link)])

    def frame(self, link: str) -> FloatArray:
        """World pose of a link's frame, shape (4, 4)."""
        index = self.index_of(link)
        if index == _BASE:
            inertial = self.client.getDynamicsInfo(self.body, _BASE)
            return np.asarray(self.centre(link) @ np.linalg.inv(pose_of(inertial[3], inertial[4])))
        state = self.client.getLinkState(self.body, index, computeForwardKinematics=1)
        return pose_of(state[4], state[5])

    def centre(self, link: str) -> FloatArray:
        """World pose of a link's centre of mass, in which constraints are stated, shape (4, 4)."""
        index = self.index_of(link)
        if index == _BASE:
            return pose_of(*self.client.getBasePositionAndOrientation(self.body))
        state = self.client.getLinkState(self.body, index, computeForwardKinematics=1)
        return pose_of(state[0], state[1])

    def close_loops(self) -> None:
        """Hold both ends of every loop together (`createConstraint`), and switch off the motors of `passive` joints."""
        for loop in self.mechanism.robot.loops:
            parent, child = map(self.index_of, loop.links)
            at, its = (self._from_centre(link, point) for link, point in zip(loop.links, loop.points, strict=True))
            pin = self.client.createConstraint(
                self.body, parent, self.body, child, bullet.JOINT_POINT2POINT, [0.0, 0.0, 0.0], at, its
            )
            self.client.changeConstraint(pin, maxForce=_PIN_FORCE)
        for name in self.passive:
            index = self.indices[self.mechanism.joints.index(name)]
            self.client.setJointMotorControl2(self.body, index, bullet.VELOCITY_CONTROL, force=0.0)

    @cached_property
    def passive(self) -> frozenset[str]:
        """Joints that loops move, and no motor: those that follow along a curve, or mimic a joint of the same loop."""
        robot = self.mechanism.robot
        found = {joint.name for joint in robot.joints if joint.closure is not None}
        for loop in robot.loops:
            moved = joints_between(robot, loop.links)
            mimics = ((name, robot.joint_by_name[name].mimic) for name in moved)
            found |= {name for name, mimic in mimics if mimic is not None and mimic.joint in moved}
        return frozenset(found)

    def _from_centre(self, link: str, point: FloatArray) -> list[float]:
        """A point of a link's frame in the frame of its centre of mass, in which constraints are stated [m]."""
        info = self.client.getDynamicsInfo(self.body, self.index_of(link))
        found: list[float] = (np.linalg.inv(pose_of(info[3], info[4])) @ np.append(point, 1.0))[:3].tolist()
        return found

    def release(self) -> None:
        """Switch all motors off, which are on from the start."""
        for index in self.indices:
            self.client.setJointMotorControl2(self.body, index, bullet.VELOCITY_CONTROL, force=0.0)

    def act(self, pairs: Iterable[tuple[int, int]], *, on: bool) -> None:
        """Make the links of these pairs (indices in the document) act on each other, or not."""
        for first, second in pairs:
            self.client.setCollisionFilterPair(
                self.body, self.body, int(self.link[first]), int(self.link[second]), int(on)
            )


def load(mechanism: LeaderMechanism, urdf: Path, *, step: float, itself: bool = True) -> PybulletBody:
    """Load a file into a new world, its root fixed; links that fixed joints join do not collide with each other.

    Args:
        mechanism: Its tree.
        urdf: The file, its meshes convex.
        step: Time step [s].
        itself: Its links collide with each other.

    Raises:
        Unloadable: PyBullet cannot.
    """
    client = Client()
    client.setPhysicsEngineParameter(enableFileCaching=0, fixedTimeStep=step)
    client.setGravity(0.0, 0.0, -GRAVITY)
    flags = _FLAGS if itself else bullet.URDF_USE_INERTIA_FROM_FILE
    loaded = _loaded(client, mechanism, urdf, useFixedBase=True, flags=flags)
    if loaded.complete and mechanism.robot.loops:
        loaded.client.setPhysicsEngineParameter(erp=_PIN_ERP, numSolverIterations=_PIN_ITERATIONS)
        loaded.close_loops()
    if loaded.complete and itself:
        loaded.act(_welded_pairs(mechanism), on=False)
    return loaded


def load_with_loops(client: int, robot: Robot, urdf: Path) -> int:
    """Load a file into a world that is connected, its root fixed and its loops closed; returns PyBullet's number of it.

    Args:
        client: PyBullet's number of the world.
        robot: What is in the file.
        urdf: The file.

    Raises:
        Unloadable: PyBullet cannot.
    """
    loaded = _loaded(Client(client), LeaderMechanism(robot=robot), urdf, useFixedBase=True)
    if loaded.complete:
        loaded.close_loops()
    return loaded.body


def load_at(
    client: Client, mechanism: LeaderMechanism, urdf: Path, T_world_root: FloatArray, *, itself: bool
) -> PybulletBody:
    """Load a file into a world, its root fixed at a pose.

    Args:
        client: The world.
        mechanism: Its tree.
        urdf: The file, its meshes convex.
        T_world_root: Shape (4, 4).
        itself: Links that no joint connects collide with each other.

    Raises:
        Unloadable: PyBullet cannot.
    """
    flags = bullet.URDF_USE_INERTIA_FROM_FILE | (bullet.URDF_USE_SELF_COLLISION if itself else 0)
    place, turn = T_world_root[:3, 3].tolist(), quaternion_of(T_world_root[:3, :3], real_last=True).tolist()
    options = {"basePosition": place, "baseOrientation": turn, "useFixedBase": True, "flags": flags}
    return _loaded(client, mechanism, urdf, **options)


def _loaded(client: Client, mechanism: LeaderMechanism, urdf: Path, **options: Any) -> PybulletBody:
    try:
        body = client.loadURDF(str(urdf), **options)
    except bullet.error as error:
        raise Unloadable(str(error)) from error
    infos = [client.getJointInfo(body, k) for k in range(client.getNumJoints(body))]
    links = {text_of(info[12]): info[0] for info in infos}
    links.setdefault(mechanism.robot.root, _BASE)
    joints = {text_of(info[1]): info[0] for info in infos if info[2] != bullet.JOINT_FIXED}
    indices = [links.get(name, -2) for name in mechanism.links]
    inflated = [
        index >= _BASE and any(shape[2] == bullet.GEOM_MESH for shape in client.getCollisionShapeData(body, index))
        for index in indices
    ]
    return PybulletBody(
        client=client,
        body=body,
        mechanism=mechanism,
        link=np.array(indices, dtype=np.int64),
        joint=np.array([joints.get(name, -2) for name in mechanism.joints], dtype=np.int64),
        margin=np.where(inflated, HULL_MARGIN, 0.0),
    )


def _welded_pairs(mechanism: LeaderMechanism) -> list[tuple[int, int]]:
    """Pairs of links that fixed joints join."""
    members: dict[int, list[int]] = defaultdict(list)
    for link, body in enumerate(mechanism.body_of_link.tolist()):
        members[body].append(link)
    return [pair for group in members.values() for pair in combinations(group, 2)]


def pose_of(place: tuple[float, ...], turn: tuple[float, ...]) -> FloatArray:
    """Pose from a place [m] and a quaternion x, y, z, w, shape (4, 4)."""
    T = np.eye(4)
    T[:3, :3] = np.array(bullet.getMatrixFromQuaternion(turn)).reshape(3, 3)
    T[:3, 3] = place
    return T


def text_of(name: bytes) -> str:
    """Return one of PyBullet's names."""
    return name.decode("utf-8", errors="replace")
