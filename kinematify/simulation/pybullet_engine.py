"""PyBullet: files as `loadURDF` loads them, their base fixed, their motors as they are, and worlds.

PyBullet speaks in indices of its own and in tuples; nothing of either leaves this module. Bullet keeps contacts from
step to step. What is placed in a world therefore begins from a state that was saved before any step, so that it does
not depend on what happened before.
"""

from __future__ import annotations

import ctypes
import os
import re
import tempfile
import weakref
from collections import defaultdict
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import combinations, product
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import pybullet as bullet

from kinematify.robot.mechanism import LeaderMechanism, joints_between
from kinematify.robot.robot import Robot, forward_kinematics
from kinematify.robot.transforms import quaternion_of
from kinematify.robot.urdf_numbers import passing_links
from kinematify.robot.urdf_text import parse_description
from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.engine_file import EngineFile, Push, Unloadable
from kinematify.simulation.world import (
    ROBOT,
    Grip,
    HeldPoint,
    ObjectState,
    PlacedModel,
    PlacedRobot,
    PullingHand,
    Variation,
    WorldSpec,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray, IntArray

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

    def part(self, pairs: Iterable[tuple[int, int]]) -> None:
        """Let the links of these pairs (indices in the document) pass through each other."""
        for first, second in pairs:
            self.client.setCollisionFilterPair(self.body, self.body, int(self.link[first]), int(self.link[second]), 0)


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
        loaded.part(_welded_pairs(mechanism))
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


_FOLLOWER_FORCE = 1e3  # holds a joint that follows another one [N m or N]
_STRONG = 1e5  # holds a joint where it is [N m or N]
_GAIN = 0.3  # share of an error of position that a motor makes good in a step


class PybulletWorld:
    """World in PyBullet; `close` frees the world."""

    def __init__(self, spec: WorldSpec) -> None:
        """Load both models.

        Raises:
            Unloadable: PyBullet cannot.
        """
        self._spec, self._mechanism = spec, spec.object.mechanism
        placed, mechanism = spec.object, spec.object.mechanism
        self._object = load(mechanism, placed.urdf, step=spec.step, itself=spec.grip is None)
        self.client, self._body = self._object.client, self._object.body
        self.client.setPhysicsEngineParameter(numSolverIterations=spec.iterations, deterministicOverlappingPairs=1)
        self._object.part(_indices(placed))
        names = list(mechanism.joints)
        leaders = [names.index(travel.joint) for travel in mechanism.travels]
        passive = {names.index(name) for name in self._object.passive}
        self._leaders = [self._object.indices[k] for k in leaders]
        self._followers = [k for k in range(len(names)) if k not in {*leaders, *passive}]
        self._T_base = pose_of(*self.client.getBasePositionAndOrientation(self._body))
        self._links = {index: self._link_facts(index) for index in self._object.link.tolist()}
        self._hand: PullingHand | None = None
        self._saved: int | None = None
        self._move_root(np.eye(4))
        self._robot = None if spec.robot is None else _Robot(self._object, spec.robot, spec.grip)
        if spec.point is not None:
            self._link = self._object.index_of(spec.point.link)
            self._look()

    def _link_facts(self, index: int) -> tuple[float, list[float], float]:
        """Mass [kg], principal moments [kg m^2] and friction of a link."""
        info = self.client.getDynamicsInfo(self._body, index)
        return float(info[0]), list(info[2]), float(info[1])

    def _move_root(self, T_root: FloatArray) -> None:
        self._T_root = T_root @ self._spec.object.T_world_root
        T = self._T_root @ self._T_base
        turn = quaternion_of(T[:3, :3], real_last=True)
        self.client.resetBasePositionAndOrientation(self._body, T[:3, 3].tolist(), turn)
        if self._saved is not None:
            self.client.removeState(self._saved)
        self._saved = None

    def resist(self, damping: FloatArray, friction: FloatArray) -> None:
        """Give the object's joints damping and friction, with the next `vary`."""
        self._damping, self._friction = damping, friction

    def take(self, hand: PullingHand) -> None:
        """Give the held point a hand."""
        self._hand = hand

    def vary(self, drawn: Variation) -> None:
        """Change the object."""
        client, body = self.client, self._body
        for number, index in enumerate(self._object.link.tolist()):
            mass, moments, friction = self._links[index]
            factor = float(drawn.mass[number])
            client.changeDynamics(
                body, index, lateralFriction=drawn.surface * friction, linearDamping=0.0, angularDamping=0.0
            )
            if index != _BASE:  # a base that is given a mass is no longer fixed
                client.changeDynamics(
                    body, index, mass=factor * mass, localInertiaDiagonal=[factor * m for m in moments]
                )
        damping, friction_of = drawn.damping * self._damping, drawn.friction * self._friction
        for k, index in enumerate(self._object.indices):
            client.changeDynamics(body, index, jointDamping=float(damping[k]))
            if k not in self._followers:
                # A motor that wants no speed and is as strong as the friction is friction.
                self._brake(index, float(friction_of[k]))
        self._move_root(drawn.T_root)

    def _brake(self, index: int, force: float) -> None:
        self.client.setJointMotorControl2(self._body, index, bullet.VELOCITY_CONTROL, targetVelocity=0.0, force=force)

    def place(self, values: FloatArray, robot: FloatArray | None = None) -> None:
        """Set all joints and stop them."""
        if self._saved is None:
            self._object.place(self._mechanism.values_at_rest)
            self._object.forget_contacts()
            self._saved = self.client.saveState()
        self.client.restoreState(self._saved)
        self._object.place(values)
        locked = self._spec.object.locked
        if locked:
            named = dict(zip(self._mechanism.joints, values.tolist(), strict=True))
            _hold(self._object, {name: value for name, value in named.items() if name not in self._object.passive})
            for index in self._object.indices:
                self.client.changeDynamics(self._body, index, jointDamping=0.0)
        if self._spec.point is not None:
            self._look()
        self.client.performCollisionDetection()
        if robot is not None and self._robot is not None:
            self._robot.place(robot)
            self.client.performCollisionDetection()

    def pull(self, command: FloatArray) -> None:
        """Command the hand."""
        self._pulled = np.asarray(command, dtype=np.float64)

    def command(self, values: FloatArray, speeds: FloatArray | None = None) -> None:
        """Command the motors; they are led there in the steps that follow."""
        self._arm.wanted, self._arm.speeds = values, speeds

    def step(self, count: int = 1) -> None:
        """Simulate so many steps."""
        for step in range(1, count + 1):
            if self._robot is None:
                self._push()
            else:
                self._robot.lead(step / count)
            self._follow()
            self.client.stepSimulation()
        if self._robot is not None:
            self._robot.led = self._robot.wanted
        if self._spec.point is not None:
            self._look()

    def _push(self) -> None:
        """Apply the hand's force in the next step."""
        hand, state = self._hand, self._link_state()
        assert hand is not None
        at = self._at_hold(state)
        if hand.spring:
            velocity = np.array(state[6]) + np.cross(state[7], at - np.array(state[0]))
            spring = hand.stiffness * (self._pulled - at) - hand.damping * velocity
            force = np.clip(spring, -hand.force, hand.force)
        else:
            force = hand.force * self._pulled
        self.client.applyExternalForce(self._body, self._link, force.tolist(), at.tolist(), bullet.WORLD_FRAME)

    def _follow(self) -> None:
        """Make joints that mimic others follow them, which PyBullet does not care for."""
        if not self._followers:
            return
        values = self._mechanism.all_values(self._object_leaders()[0][None])[0]
        for k in self._followers:
            self.client.setJointMotorControl2(
                self._body,
                self._object.indices[k],
                bullet.POSITION_CONTROL,
                targetPosition=float(values[k]),
                force=_FOLLOWER_FORCE,
            )

    def release(self, joints: Iterable[str]) -> None:
        """Make locked joints of the object go."""
        for name in joints:
            self._brake(self._object.indices[self._mechanism.joints.index(name)], 0.0)

    def weld(self) -> None:
        """Fix the tool to the part where it now is."""
        robot, grip, tool = self._arm.loaded, self._spec.grip, self._arm.placed.tool
        assert grip is not None
        T_world_tool = robot.frame(tool)
        T_tool, T_part = (
            np.linalg.inv(side.centre(link)) @ T_world_tool for side, link in ((robot, tool), (self._object, grip.link))
        )
        weld = self.client.createConstraint(
            robot.body,
            robot.index_of(tool),
            self._body,
            self._object.index_of(grip.link),
            bullet.JOINT_FIXED,
            [0.0, 0.0, 0.0],
            T_tool[:3, 3].tolist(),
            T_part[:3, 3].tolist(),
            *(quaternion_of(T[:3, :3], real_last=True) for T in (T_tool, T_part)),
        )
        self.client.changeConstraint(weld, maxForce=grip.weld_force)

    def _object_leaders(self) -> tuple[FloatArray, FloatArray]:
        return _motion(self._object, self._leaders)

    def _link_state(self) -> tuple[tuple[float, ...], ...]:
        state: tuple[tuple[float, ...], ...] = self.client.getLinkState(
            self._body, self._link, computeLinkVelocity=1, computeForwardKinematics=1
        )
        return state

    def _at_hold(self, state: tuple[tuple[float, ...], ...]) -> FloatArray:
        return np.asarray(pose_of(state[4], state[5])[:3] @ np.append(self._point.point, 1.0))

    @property
    def _point(self) -> HeldPoint:
        assert self._spec.point is not None
        return self._spec.point

    def _look(self) -> None:
        """Take the state of now for `state`."""
        (values, speeds), link = self._object_leaders(), self._link_state()
        T = pose_of(link[4], link[5])
        self._state = ObjectState(
            values=values,
            speeds=speeds,
            hold=self._at_hold(link),
            anchor=T[:3, 3],
            axis=T[:3, :3] @ self._point.axis,
        )

    def state(self) -> ObjectState:
        """State of the object after the last step."""
        return self._state

    def values(self) -> FloatArray:
        """Values of all joints of the object."""
        return _motion(self._object, self._object.indices)[0]

    def robot_values(self) -> FloatArray:
        """Values of all joints of the robot."""
        return _motion(self._arm.loaded, self._arm.loaded.indices)[0]

    def driven(self) -> tuple[FloatArray, FloatArray]:
        """Values and speeds of the robot's joints with motors."""
        return _motion(self._arm.loaded, self._arm.driven)

    def tool(self) -> FloatArray:
        """Pose of the tool."""
        return self._arm.loaded.frame(self._arm.placed.tool)

    def touch(self) -> FloatArray:
        """Force of each finger on the held body."""
        links = self._arm.placed.finger_links
        forces = np.zeros((len(links), 3))
        rows = {self._arm.loaded.index_of(link): row for row, link in enumerate(links)}
        held = {self._object.index_of(link) for link in self._point.body}
        for point in self._contacts():
            if point[3] in rows and point[4] in held:
                forces[rows[point[3]]] += point[9] * np.array(point[7])
        return np.asarray(np.linalg.norm(forces, axis=1))

    def _contacts(self) -> list[tuple[Any, ...]]:
        """Contacts of the robot with the object."""
        return list(self.client.getContactPoints(self._arm.loaded.body, self._body) or ())

    @property
    def _arm(self) -> _Robot:
        assert self._robot is not None
        return self._robot

    def link_poses(self) -> dict[str, FloatArray]:
        """World poses of the links of both."""
        leaders = [travel.joint for travel in self._mechanism.travels]
        poses = forward_kinematics(self._mechanism.robot, dict(zip(leaders, self._state.values.tolist(), strict=True)))
        found = {name: self._T_root @ T for name, T in poses.items()}
        for name in () if self._robot is None else self._robot.placed.mechanism.links:
            found[ROBOT + name] = self._arm.loaded.frame(name)
        return found

    def depth(self) -> float:
        """Deepest contact of the object with itself among pairs that collide, or with the robot."""
        link_of, margin = self._object.link_of, self._object.margin
        points = self.client.getContactPoints(self._body, self._body)
        depths = [-p[8] - float(margin[link_of[p[3]]] + margin[link_of[p[4]]]) for p in points]
        if self._robot is not None:
            depths += [float(-point[8]) - HULL_MARGIN for point in self._contacts()]
        return max(0.0, *depths) if depths else 0.0

    def deeper(self, than: float) -> tuple[float, tuple[str, str]] | None:
        """Deepest contact of the robot, if it is deeper than that."""
        deepest = min(self._contacts(), key=lambda point: point[8], default=None)
        if deepest is None or -deepest[8] - HULL_MARGIN <= than:
            return None
        sides = ((self._arm.loaded, deepest[3]), (self._object, deepest[4]))
        link, other = (side.mechanism.links[side.link_of[index]] for side, index in sides)
        return -deepest[8] - HULL_MARGIN, (link, other)

    def stable(self) -> bool:
        """True if all numbers are finite."""
        robot = () if self._robot is None else self.driven()
        return all(bool(np.isfinite(part).all()) for part in (*self._object_leaders(), *robot))

    def warnings(self) -> dict[str, int]:
        """PyBullet has none."""
        return {}

    def close(self) -> None:
        """Free the world."""
        self.client.disconnect()


class _Robot:
    """A robot in the world of an object."""

    def __init__(self, beside: PybulletBody, placed: PlacedRobot, grip: Grip | None) -> None:
        """The robot meets the object and the floor; the object stands on the floor."""
        client, self.placed, T = beside.client, placed, placed.T_world_root
        flags = bullet.URDF_USE_INERTIA_FROM_FILE | (bullet.URDF_USE_SELF_COLLISION if grip is None else 0)
        at = {"basePosition": T[:3, 3].tolist(), "baseOrientation": quaternion_of(T[:3, :3], real_last=True).tolist()}
        loaded = _loaded(client, placed.mechanism, placed.urdf, useFixedBase=True, flags=flags, **at)
        self.loaded, joints = loaded, dict(zip(placed.mechanism.joints, loaded.indices, strict=True))
        self.driven = [joints[name] for name in placed.driven]
        self.wanted = self.led = np.zeros(len(self.driven))
        """What is commanded, and what the motors have been led to."""
        self.speeds: FloatArray | None = None
        grips = np.full(len(placed.fingers), placed.settings.grip_force)
        self._forces = np.concatenate([placed.strongest, grips]).tolist()
        for index in loaded.link.tolist():
            client.changeDynamics(loaded.body, index, lateralFriction=placed.settings.friction)
        rest = zip(placed.mechanism.joints, placed.mechanism.values_at_rest.tolist(), strict=True)
        _hold(loaded, {name: value for name, value in rest if name not in placed.driven})
        for hand, part in () if grip is None else product(grip.hand, grip.part):
            first, second = loaded.index_of(hand), beside.index_of(part)
            client.setCollisionFilterPair(loaded.body, beside.body, first, second, 0)
        floor = client.createMultiBody(0.0, client.createCollisionShape(bullet.GEOM_PLANE))
        for index in beside.link.tolist():
            client.setCollisionFilterPair(floor, beside.body, _BASE, index, 0)

    def place(self, values: FloatArray) -> None:
        """Set the joints with motors, and hold them."""
        for index, value in zip(self.driven, values.tolist(), strict=True):
            self.loaded.client.resetJointState(self.loaded.body, index, value)
        self.wanted = self.led = np.asarray(values)
        self.lead(1.0)

    def lead(self, share: float) -> None:
        """Lead the motors a share of the way to what is commanded."""
        count = len(self.driven)
        speeds: dict[str, list[float]] = {}
        if self.speeds is not None:
            speeds["targetVelocities"] = [*self.speeds.tolist(), *[0.0] * (count - len(self.speeds))]
        self.loaded.client.setJointMotorControlArray(
            self.loaded.body,
            self.driven,
            bullet.POSITION_CONTROL,
            targetPositions=(self.led + share * (self.wanted - self.led)).tolist(),
            forces=self._forces,
            positionGains=[_GAIN] * count,
            velocityGains=[1.0] * count,
            **speeds,
        )


def _indices(placed: PlacedModel) -> list[tuple[int, int]]:
    """Pairs of links that do not act on each other."""
    place = {name: k for k, name in enumerate(placed.mechanism.links)}
    return [(place[first], place[second]) for first, second in placed.apart]


def _motion(body: PybulletBody, joints: list[int]) -> tuple[FloatArray, FloatArray]:
    """Values and speeds of joints."""
    states = body.client.getJointStates(body.body, joints) or ()
    return np.array([state[0] for state in states]), np.array([state[1] for state in states])


def _hold(side: PybulletBody, values: Mapping[str, float]) -> None:
    """Set joints and hold them there."""
    joints = dict(zip(side.mechanism.joints, side.indices, strict=True))
    for name, value in values.items():
        side.client.resetJointState(side.body, joints[name], value)
        side.client.setJointMotorControl2(
            side.body,
            joints[name],
            bullet.POSITION_CONTROL,
            targetPosition=value,
            targetVelocity=0.0,
            force=_STRONG,
            positionGain=_GAIN,
            velocityGain=1.0,
        )


def _without_contacts(lines: str) -> str:
    """Code in which links pass through each other."""
    return lines.replace("p.URDF_USE_SELF_COLLISION", "0")


_LOAD = """import pybullet as p
p.connect(p.DIRECT); p.setGravity(0, 0, -9.81); rest = {values}; push = 0.0
body = p.loadURDF({path!r}, useFixedBase=True, flags=p.URDF_USE_SELF_COLLISION); \
[p.resetJointState(body, k, q) for k, q in rest.items()]; \
[p.setCollisionFilterPair(body, body, a, b, 0) for a, b in {silent}]
"""
_OPEN = """import pybullet as p
p.connect(p.DIRECT); body = p.loadURDF({path!r}, useFixedBase=True)
"""
_JOINTS = (
    _OPEN
    + """joints = [p.getJointInfo(body, k) for k in range(p.getNumJoints(body))]
for info in joints: ends = info[8:10] if info[8] <= info[9] else (-float("inf"), float("inf")); \
info[2] == p.JOINT_FIXED or print("\\n", info[1].decode(), *ends)
"""
)
_OVERLAP = (
    _LOAD
    + """p.performCollisionDetection()
print("\\n", max(-contact[8] for contact in p.getContactPoints(body, body) if set(contact[3:5]) == {links}))
"""
)
_REST = (
    _LOAD
    + """seen = [p.getJointState(body, {joint})[0] for _ in range({steps}) if not p.stepSimulation()]
print("\\n", min(seen), max(seen))
"""
)
_PUSH = (
    _LOAD
    + """p.setGravity(0, 0, 0); moved, clip = {moved}, lambda f: min(max(f, -{force!r}), {force!r})
seen = [rest[{joint}]]; [p.setJointMotorControl2(body, k, p.VELOCITY_CONTROL, force=0) for k, _, _ in moved]
for _ in range({steps}): slow = {speed!r} - p.getJointState(body, {joint})[1]; \
push = clip(push + {integral!r} * slow); \
p.setJointMotorControl2(body, {joint}, p.TORQUE_CONTROL, force=clip({proportional!r} * slow + push)); \
p.stepSimulation(); state = {{k: p.getJointState(body, k) for k in rest}}; \
way = sum(w * (state[k][0] - rest[k]) for k, _, w in moved); speed = sum(w * state[k][1] for k, _, w in moved); \
ratio = {{k: r for k, r, _ in moved}}; \
[p.resetJointState(body, k, q + ratio.get(k, 0) * way, ratio.get(k, 0) * speed) for k, q in rest.items()]; \
seen.append(p.getJointState(body, {joint})[0])
print("\\n", {farthest}(seen))
"""
)
_RELEASE = (
    _without_contacts(_LOAD)
    + """import numpy as np
[p.resetJointState(body, k, rest[k], v) for k, v in {speeds}.items()]
[p.setJointMotorControl2(body, k, p.VELOCITY_CONTROL, force=0) for k in rest]; links = range(p.getNumJoints(body))
local = lambda s: np.reshape(p.getMatrixFromQuaternion(s[1]), (3, 3)).T @ s[7]
energy = lambda: sum(d[0] * (9.81 * s[0][2] + 0.5 * np.dot(s[6], s[6])) + 0.5 * np.dot(d[2], local(s)**2) \
for d, s in ((p.getDynamicsInfo(body, k), p.getLinkState(body, k, 1, 1)) for k in links))
seen = [energy()] + [energy() for k in range({steps}) if not p.stepSimulation() and k % {looks} == {looks} - 1]
print("\\n", max(seen) - seen[0])
"""
)
_MARK = re.compile(r"b3(?:Warning|Error)\[[^\]]*\]:")
"""Before each message that PyBullet prints."""
_NO_FAULT = "No inertial data"
"""Beginning of what it prints of many files that it loads."""
_TIME_STEP = 1.0 / 240.0
_FASTEST = 100.0
"""Speed that Bullet lets no joint exceed [rad/s or m/s]."""
_MOTOR = 240.0
"""Of a joint that was pushed, afterwards [N or N m]: about what motors have when a file is loaded."""


class PybulletFile(EngineFile):
    """See `EngineFile`: a file as `loadURDF` loads it, its base fixed, its motors as they are.

    Contacts of links are those of `URDF_USE_SELF_COLLISION`, but for links that fixed joints alone hold together, for
    those of neighbours (as `URDF_MERGE_FIXED_LINKS` has it), and for links that the file declares not to collide with
    their own model.
    """

    code: ClassVar = {
        "joints": _JOINTS,
        "overlap": _OVERLAP,
        "rest": _REST,
        "push": _PUSH,
        "push_alone": _without_contacts(_PUSH),
        "release": _RELEASE.replace("{looks}", "8"),
    }

    look_steps = 8

    def __init__(self, urdf: Path, root: str) -> None:
        """Load it.

        Raises:
            Unloadable: PyBullet does not open it.
        """
        self._path, self._root, self.time_step = urdf, root, _TIME_STEP
        self._passing = passing_links(parse_description(urdf))
        world = self._opened(contacts=True, seen=True)
        self._now, self._worlds = world, {True: world}
        self._file = {"path": str(urdf), "silent": world.ignored_pairs}
        infos, self._links = world.infos, world.links
        self._index = {text_of(info[1]): k for k, info in enumerate(infos) if info[2] != bullet.JOINT_FIXED}
        self._places = list(self._index.values())
        self.joints = tuple(self._index)
        self.limits = {
            name: infos[k][8:10] if infos[k][8] <= infos[k][9] else (-np.inf, np.inf) for name, k in self._index.items()
        }
        above = {k: info[16] for k, info in enumerate(infos)}
        self._below = {k: [link for link in above if k in _chain(above, link)] for k in self._index.values()}

    def begin(
        self,
        values: Mapping[str, float],
        speeds: Mapping[str, float] | None = None,
        *,
        contacts: bool,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """See `EngineFile`: the world as it was after loading; motors of joints that were released are put back."""
        world = self._worlds.get(contacts)
        if world is None or (released is None and world.pushed):
            world = self._opened(contacts=contacts, seen=False)
        self._now = self._worlds[contacts] = world
        world.client.restoreState(world.state)
        for name, k in self._index.items():
            world.client.resetJointState(world.body, k, values[name], 0.0 if speeds is None else speeds[name])
        world.client.setGravity(0.0, 0.0, -GRAVITY if gravity else 0.0)
        freed = [self._places[number] for number in released or ()]
        for k in world.freed - set(freed):
            world.client.setJointMotorControl2(world.body, k, bullet.VELOCITY_CONTROL, force=_MOTOR)
        for k in freed:
            world.client.setJointMotorControl2(world.body, k, bullet.VELOCITY_CONTROL, force=0)
        world.freed, world.pushed = set(freed), world.pushed or bool(freed)

    def _opened(self, *, contacts: bool, seen: bool) -> _LoadedWorld:
        return _LoadedWorld(self._path, contacts=contacts, seen=seen, root=self._root, passing=self._passing)

    def poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """See `EngineFile`; of all links but the base."""
        self.begin(values, contacts=True)
        world, links = self._now, [link for link in self._links if link != -1]
        states = world.client.getLinkStates(world.body, links, computeForwardKinematics=True) if links else ()
        return {
            self._links[link]: np.column_stack([np.reshape(bullet.getMatrixFromQuaternion(state[5]), (3, 3)), state[4]])
            for link, state in zip(links, states, strict=True)
        }

    def steps(self, count: int, every: int = 1) -> Iterator[int]:
        """See `EngineFile`."""
        for done in range(1, count + 1):
            self._now.client.stepSimulation()
            if done % every == 0:
                yield done

    def state(self) -> tuple[FloatArray, FloatArray]:
        """See `EngineFile`."""
        states = self._now.client.getJointStates(self._now.body, self._places)
        return np.array([state[0] for state in states]), np.array([state[1] for state in states])

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """See `EngineFile`."""
        self._now.client.resetJointStatesMultiDof(
            self._now.body, self._places, q[:, None].tolist(), v[:, None].tolist()
        )

    def apply(self, joint: int, force: float) -> None:
        """See `EngineFile`."""
        self._now.client.setJointMotorControl2(self._now.body, self._places[joint], bullet.TORQUE_CONTROL, force=force)

    def touching(self) -> Iterator[tuple[str, str, float]]:
        """See `EngineFile`."""
        world = self._now
        world.client.performCollisionDetection()
        for contact in world.client.getContactPoints(world.body, world.body):
            first, second = sorted(contact[3:5])
            yield self._links[first], self._links[second], -contact[8]

    def energy(self) -> tuple[float, float]:
        """See `EngineFile`; of all links but the base."""
        world, links = self._now, [link for link in self._links if link != -1]
        states = world.client.getLinkStates(world.body, links, computeLinkVelocity=True, computeForwardKinematics=True)
        potential = kinetic = 0.0
        for link, state in zip(links, states, strict=True):
            mass, _, tensor, *_ = world.client.getDynamicsInfo(world.body, link)
            turning = np.reshape(bullet.getMatrixFromQuaternion(state[1]), (3, 3)).T @ state[7]
            potential += GRAVITY * mass * state[0][2]
            kinetic += 0.5 * (mass * np.dot(state[6], state[6]) + np.dot(tensor, turning**2))
        return potential, float(kinetic)

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """See `EngineFile`; the motors of the others hold them within a step."""
        self.begin(values, contacts=True, released=())
        return np.array([self._inertia(self._now, k) for k in self._places])

    def _inertia(self, world: _LoadedWorld, joint: int) -> float:
        """Of what hangs on a joint; PyBullet's own mass matrix fails where a tensor is unsymmetric by 1e-13."""
        info = world.client.getJointInfo(world.body, joint)
        frame = world.client.getLinkState(world.body, joint, computeForwardKinematics=True)
        axis = np.array(bullet.rotateVector(frame[5], info[13]))
        total = 0.0
        for link in self._below[joint]:
            mass, _, tensor, *_ = world.client.getDynamicsInfo(world.body, link)
            centre, turned, *_ = world.client.getLinkState(world.body, link, computeForwardKinematics=True)
            if info[2] == bullet.JOINT_PRISMATIC:
                total += mass
                continue
            arm = np.cross(axis, np.subtract(centre, frame[4]))
            local = np.array(bullet.getMatrixFromQuaternion(turned)).reshape(3, 3).T @ axis
            total += mass * float(arm @ arm) + float(local @ (np.array(tensor) * local))
        return total

    def max_safe_force(self, values: Mapping[str, float]) -> FloatArray:
        """See `EngineFile`.

        Bullet lets no joint be faster than 100 rad/s within a step either, before motors hold the others: a joint that
        is light where those give way is thrown back by more.
        """
        torques, speeds = 1e-2 * self.inertias(values), []
        self.begin(values, contacts=False, gravity=False, released=range(len(self._places)))
        for joint, torque in enumerate(torques.tolist()):
            for k, value in zip(self._places, self.row(values).tolist(), strict=True):
                self._now.client.resetJointState(self._now.body, k, value)
            self.apply(joint, torque)
            self._now.client.stepSimulation()
            speeds.append(abs(float(self.state()[1][joint])))
        del self._worlds[False]
        return 0.5 * _FASTEST * torques / np.maximum(speeds, 1e-12)

    def motor(self, joint: str, values: Mapping[str, float], target: float, seconds: float) -> float:
        """See `EngineFile`; the motors of the other joints hold them, gravity is off."""
        self.begin(values, contacts=False, gravity=False, released=())
        for name, k in self._index.items():
            wanted = target if name == joint else values[name]
            self._now.client.setJointMotorControl2(self._now.body, k, bullet.POSITION_CONTROL, targetPosition=wanted)
        sign, farthest, index = np.sign(target - values[joint]), values[joint], self._index[joint]
        for _ in self.steps(self._steps(seconds)):
            farthest = sign * max(sign * farthest, sign * self._now.client.getJointState(self._now.body, index)[0])
        del self._worlds[False]  # its motors are others than those of the file as it is loaded
        return float(sign * min(sign * farthest, sign * target))

    def _script_values(self, values: Mapping[str, float]) -> object:
        return {k: float(values[name]) for name, k in self._index.items()}

    def _links_in_code(self, links: tuple[str, str]) -> object:
        return {k for k, name in self._links.items() if name in links}

    def _index_of(self, joint: str) -> int:
        return self._index[joint]

    def _moved_in_code(self, push: Push) -> object:
        return list(zip([self._index[name] for name in push.moved], push.ratios, push.weights, strict=True))


def _chain(above: Mapping[int, int], link: int) -> list[int]:
    """A link and all that it hangs on but the base."""
    return [] if link == -1 else [link, *_chain(above, above[link])]


def _printed(load: Callable[[], object]) -> str:
    """What PyBullet prints of a file while it refuses it; its exception does not say why."""
    library, streams = ctypes.CDLL(None), (1, 2)
    kept = [os.dup(stream) for stream in streams]
    with tempfile.TemporaryFile() as file:
        try:
            for stream in streams:
                os.dup2(file.fileno(), stream)
            with suppress(bullet.error):
                load()
            library.fflush(None)
        finally:
            for stream, copy in zip(streams, kept, strict=True):
                os.dup2(copy, stream)
                os.close(copy)
        file.seek(0)
        said = _MARK.split(file.read().decode("utf-8", "replace"))
    words = [" ".join(item.split()) for item in said]
    return "; ".join(item for item in dict.fromkeys(words) if item and not item.startswith(_NO_FAULT))


class _LoadedWorld:
    """A world with one file in it."""

    def __init__(self, urdf: Path, *, contacts: bool, seen: bool, root: str, passing: frozenset[str]) -> None:
        """Load a file.

        Args:
            urdf: The file.
            contacts: Links collide with each other.
            seen: With its visual geometry, which takes nearly all of the time and moves nothing.
            root: Name of the first link.
            passing: Links that collide with no other one.
        """
        self.client, self.pushed = Client(), False
        self.freed: set[int] = set()
        """Joints without motors now; `pushed`: some were so once."""
        self.client.setGravity(0.0, 0.0, -GRAVITY)
        flags = (bullet.URDF_USE_SELF_COLLISION if contacts else 0) | (0 if seen else bullet.URDF_IGNORE_VISUAL_SHAPES)
        try:
            self.body = self.client.loadURDF(str(urdf), useFixedBase=True, flags=flags)
        except bullet.error as error:
            printed = _printed(lambda: self.client.loadURDF(str(urdf), flags=flags))
            words = f"{error} It prints: {printed}" if printed else str(error)
            raise Unloadable(words, _OPEN.format(path=str(urdf))) from error
        self.infos = [self.client.getJointInfo(self.body, k) for k in range(self.client.getNumJoints(self.body))]
        self.links = {-1: root, **{k: text_of(info[12]) for k, info in enumerate(self.infos)}}
        self.ignored_pairs = self._silent_pairs(passing) if contacts else []
        """Indices of two links each that do not collide."""
        for first, second in self.ignored_pairs:
            self.client.setCollisionFilterPair(self.body, self.body, first, second, 0)
        self.state = self.client.saveState()

    def _silent_pairs(self, passing: frozenset[str]) -> list[tuple[int, int]]:
        """Pairs that a fixed joint connects, that only one moving joint parts, or that pass by declaration."""
        infos, names, top = self.infos, self.links, {-1: -1}
        for k, info in enumerate(infos):  # parents come first
            top[k] = top[info[16]] if info[2] == bullet.JOINT_FIXED else k
        above = {k: top[infos[k][16]] if k >= 0 else None for k in set(top.values())}
        solid = [k for k in top if self.client.getCollisionShapeData(self.body, k)]
        return [
            (a, b)
            for a, b in combinations(solid, 2)
            if top[a] == top[b] or top[a] == above[top[b]] or top[b] == above[top[a]] or {names[a], names[b]} & passing
        ]


FILE, WORLD = PybulletFile, PybulletWorld
