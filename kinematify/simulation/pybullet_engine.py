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
from dataclasses import dataclass, field
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
from kinematify.simulation.engine import Engine, Unloadable
from kinematify.simulation.world import (
    ROBOT,
    Grip,
    ObjectState,
    OpenedFile,
    PlacedRobot,
    PullingHand,
    Variation,
    WorldSpec,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
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


@dataclass(kw_only=True, eq=False)
class _Model:
    """A model in a world, and where its links and joints stand in it."""

    client: Client
    body: int
    infos: list[tuple[Any, ...]]
    """Facts of each joint, in PyBullet's order."""
    names: tuple[str, ...]
    """Links, the root first, then in the order of PyBullet's indices."""
    joints: Mapping[str, int]
    """PyBullet's index of each joint that moves, in the order of its values."""
    saved: int | None = None
    """State from which all runs begin."""
    commanded: set[int] = field(default_factory=set)
    """Joints whose motors are others now than when the file was loaded."""

    @cached_property
    def links(self) -> dict[str, int]:
        """PyBullet's index of each link, -1 for the root."""
        return {name: index for index, name in enumerate(self.names, _BASE)}

    @cached_property
    def places(self) -> list[int]:
        """PyBullet's indices of the joints."""
        return list(self.joints.values())

    def set(self, values: Iterable[float], speeds: Iterable[float] | None = None) -> None:
        """Set all joints [rad or m], and their speeds, which are else none."""
        for k, value, speed in zip(self.places, values, speeds or [0.0] * len(self.places), strict=True):
            self.client.resetJointState(self.body, k, value, speed)

    def motion(self, joints: list[int] | None = None) -> tuple[FloatArray, FloatArray]:
        """Values and speeds of joints, of all if none are given."""
        states = self.client.getJointStates(self.body, self.places if joints is None else joints) or ()
        return np.array([state[0] for state in states]), np.array([state[1] for state in states])

    def brake(self, joint: int, force: float) -> None:
        """Let a motor want no speed with so much force: friction."""
        self.client.setJointMotorControl2(self.body, joint, bullet.VELOCITY_CONTROL, targetVelocity=0.0, force=force)

    def hold(self, values: Mapping[str, float]) -> None:
        """Set joints and hold them there."""
        for name, value in values.items():
            self.client.resetJointState(self.body, self.joints[name], value)
            self.client.setJointMotorControl2(
                self.body,
                self.joints[name],
                bullet.POSITION_CONTROL,
                targetPosition=value,
                targetVelocity=0.0,
                force=_STRONG,
                positionGain=_GAIN,
                velocityGain=1.0,
            )

    def forget_contacts(self) -> None:
        """Forget the contacts of earlier configurations.

        PyBullet keeps contacts from step to step as points that move with the bodies. Where a body was set to another
        place they are wrong, so all pairs are made to be found again.
        """
        for index in self.links.values():
            self.client.setCollisionFilterGroupMask(self.body, index, 1, 1)
        self.client.performCollisionDetection()

    def frame(self, link: str) -> FloatArray:
        """World pose of a link's frame, shape (4, 4)."""
        index = self.links[link]
        if index == _BASE:
            inertial = self.client.getDynamicsInfo(self.body, _BASE)
            return np.asarray(self.centre(link) @ np.linalg.inv(_pose_of(inertial[3], inertial[4])))
        state = self.client.getLinkState(self.body, index, computeForwardKinematics=1)
        return _pose_of(state[4], state[5])

    def centre(self, link: str) -> FloatArray:
        """World pose of a link's centre of mass, in which constraints are stated, shape (4, 4)."""
        index = self.links[link]
        if index == _BASE:
            return _pose_of(*self.client.getBasePositionAndOrientation(self.body))
        state = self.client.getLinkState(self.body, index, computeForwardKinematics=1)
        return _pose_of(state[0], state[1])

    def close_loops(self, robot: Robot) -> None:
        """Hold both ends of every loop together (`createConstraint`); no motor moves `_passive` joints."""
        for loop in robot.loops:
            parent, child = (self.links[link] for link in loop.links)
            at, its = (self._from_centre(link, point) for link, point in zip(loop.links, loop.points, strict=True))
            pin = self.client.createConstraint(
                self.body, parent, self.body, child, bullet.JOINT_POINT2POINT, [0.0, 0.0, 0.0], at, its
            )
            self.client.changeConstraint(pin, maxForce=_PIN_FORCE)
        for name in _passive(robot):
            self.client.setJointMotorControl2(self.body, self.joints[name], bullet.VELOCITY_CONTROL, force=0.0)

    def _from_centre(self, link: str, point: FloatArray) -> list[float]:
        """A point of a link's frame in the frame of its centre of mass, in which constraints are stated [m]."""
        info = self.client.getDynamicsInfo(self.body, self.links[link])
        found: list[float] = (np.linalg.inv(_pose_of(info[3], info[4])) @ np.append(point, 1.0))[:3].tolist()
        return found

    def part(self, pairs: Iterable[tuple[int, int]]) -> None:
        """Let the links of these pairs pass through each other."""
        for first, second in pairs:
            self.client.setCollisionFilterPair(self.body, self.body, first, second, 0)


def _loaded(client: Client, urdf: Path, root: str, joints: Iterable[str] | None = None, **options: Any) -> _Model:
    """Load a file; links and joints that PyBullet loses are lost.

    Args:
        client: The world.
        urdf: The file.
        root: Name of its first link.
        joints: Joints that count, in their order; None: all that move, in PyBullet's.
        options: Of `loadURDF`.

    Raises:
        Unloadable: PyBullet cannot.
    """
    try:
        body = client.loadURDF(str(urdf), **options)
    except bullet.error as error:
        raise Unloadable(str(error), _OPEN.format(path=str(urdf))) from error
    infos = [client.getJointInfo(body, k) for k in range(client.getNumJoints(body))]
    moving = {_text_of(info[1]): info[0] for info in infos if info[2] != bullet.JOINT_FIXED}
    return _Model(
        client=client,
        body=body,
        infos=infos,
        names=(root, *(_text_of(info[12]) for info in infos)),
        joints=moving if joints is None else {name: moving[name] for name in joints if name in moving},
    )


def load_with_loops(client: int, robot: Robot, urdf: Path) -> int:
    """Load a file into a world that is connected, its root fixed and its loops closed; returns PyBullet's number of it.

    Args:
        client: PyBullet's number of the world.
        robot: What is in the file.
        urdf: The file.

    Raises:
        Unloadable: PyBullet cannot.
    """
    loaded = _loaded(Client(client), urdf, robot.root, useFixedBase=True)
    if _complete(loaded, LeaderMechanism(robot=robot)):
        loaded.close_loops(robot)
    return loaded.body


def _complete(loaded: _Model, mechanism: LeaderMechanism) -> bool:
    """True if no link and no joint was lost."""
    return loaded.links.keys() >= {*mechanism.links} and loaded.joints.keys() >= {*mechanism.joints}


def _passive(robot: Robot) -> frozenset[str]:
    """Joints that loops move, and no motor: those that follow along a curve, or mimic a joint of the same loop."""
    found = {joint.name for joint in robot.joints if joint.closure is not None}
    for loop in robot.loops:
        moved = joints_between(robot, loop.links)
        mimics = ((name, robot.joint_by_name[name].mimic) for name in moved)
        found |= {name for name, mimic in mimics if mimic is not None and mimic.joint in moved}
    return frozenset(found)


def _welded_pairs(mechanism: LeaderMechanism) -> list[tuple[str, str]]:
    """Pairs of links that fixed joints join."""
    members: dict[int, list[str]] = defaultdict(list)
    for name, body in zip(mechanism.links, mechanism.body_of_link.tolist(), strict=True):
        members[body].append(name)
    return [pair for group in members.values() for pair in combinations(group, 2)]


def _pose_of(place: tuple[float, ...], turn: tuple[float, ...]) -> FloatArray:
    """Pose from a place [m] and a quaternion x, y, z, w, shape (4, 4)."""
    T = np.eye(4)
    T[:3, :3] = np.array(bullet.getMatrixFromQuaternion(turn)).reshape(3, 3)
    T[:3, 3] = place
    return T


def _text_of(name: bytes) -> str:
    """Return one of PyBullet's names."""
    return name.decode("utf-8", errors="replace")


_FOLLOWER_FORCE = 1e3  # holds a joint that follows another one [N m or N]
_STRONG = 1e5  # holds a joint where it is [N m or N]
_GAIN = 0.3  # share of an error of position that a motor makes good in a step


class _Servos:
    """A robot in the world of an object, and its motors."""

    def __init__(self, beside: _Model, placed: PlacedRobot, grip: Grip | None) -> None:
        """The robot meets the object and the floor; the object does not meet the floor."""
        client, self.placed, T = beside.client, placed, placed.T_world_root
        flags = bullet.URDF_USE_INERTIA_FROM_FILE | (bullet.URDF_USE_SELF_COLLISION if grip is None else 0)
        at = {"basePosition": T[:3, 3].tolist(), "baseOrientation": quaternion_of(T[:3, :3], real_last=True).tolist()}
        root, joints = placed.mechanism.robot.root, placed.mechanism.joints
        self.model = model = _loaded(client, placed.urdf, root, joints, useFixedBase=True, flags=flags, **at)
        self.driven = [model.joints[name] for name in placed.driven]
        self.wanted = self.led = np.zeros(len(self.driven))
        """What is commanded, and what the motors have been led to."""
        self.speeds: FloatArray | None = None
        grips = np.full(len(placed.fingers), placed.settings.grip_force)
        self._forces = np.concatenate([placed.strongest, grips]).tolist()
        for name in placed.mechanism.links:
            client.changeDynamics(model.body, model.links[name], lateralFriction=placed.settings.friction)
        rest = zip(joints, placed.mechanism.values_at_rest.tolist(), strict=True)
        model.hold({name: value for name, value in rest if name not in placed.driven})
        for hand, part in () if grip is None else product(grip.hand, grip.part):
            client.setCollisionFilterPair(model.body, beside.body, model.links[hand], beside.links[part], 0)
        floor = client.createMultiBody(0.0, client.createCollisionShape(bullet.GEOM_PLANE))
        for index in beside.links.values():
            client.setCollisionFilterPair(floor, beside.body, _BASE, index, 0)

    def place(self, values: FloatArray) -> None:
        """Set the joints with motors, and hold them."""
        for index, value in zip(self.driven, values.tolist(), strict=True):
            self.model.client.resetJointState(self.model.body, index, value)
        self.wanted = self.led = np.asarray(values)
        self.lead(1.0)

    def lead(self, share: float) -> None:
        """Lead the motors a share of the way to what is commanded."""
        count = len(self.driven)
        speeds: dict[str, list[float]] = {}
        if self.speeds is not None:
            speeds["targetVelocities"] = [*self.speeds.tolist(), *[0.0] * (count - len(self.speeds))]
        self.model.client.setJointMotorControlArray(
            self.model.body,
            self.driven,
            bullet.POSITION_CONTROL,
            targetPositions=(self.led + share * (self.wanted - self.led)).tolist(),
            forces=self._forces,
            positionGains=[_GAIN] * count,
            velocityGains=[1.0] * count,
            **speeds,
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
"""Of every joint when a file is loaded [N or N m]: Bullet gives it an impulse of 1 a step, and no speed."""


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


class PybulletEngine(Engine):
    """PyBullet; `close` frees its worlds.

    Contacts of links of a file are those of `URDF_USE_SELF_COLLISION`, but for links that fixed joints alone hold
    together, for those of neighbours (as `URDF_MERGE_FIXED_LINKS` has it), and for links that the file declares not to
    collide with their own model.
    """

    title = "PyBullet"
    code: ClassVar = {
        "joints": _JOINTS,
        "overlap": _OVERLAP,
        "rest": _REST,
        "push": _PUSH,
        "push_alone": _without_contacts(_PUSH),
        "release": _RELEASE.replace("{looks}", "8"),
    }
    keyed = True
    look_steps = 8
    _servos: _Servos | None = None
    _hand: PullingHand | None = None

    def __init__(self, content: OpenedFile | WorldSpec) -> None:
        """Load a file, its base fixed, its motors as they are; or both models of a world.

        Raises:
            Unloadable: PyBullet does not open it.
        """
        self._spec = content if isinstance(content, WorldSpec) else None
        self._file = content if isinstance(content, OpenedFile) else None
        self._followers: list[int] = []
        self._moved, self._margin = False, dict[int, float]()
        self.facts = {}
        if isinstance(content, WorldSpec):
            self.root, self.time_step = content.object.mechanism.robot.root, content.step
            self._now = self._load_world(content)
        else:
            self.root, self.time_step = content.root, _TIME_STEP
            self._passing = passing_links(parse_description(content.urdf))
            self._now = self._load_file(content, contacts=True, seen=True)
        now, self._worlds = self._now, {True: self._now}
        self.joints, self.joint_code = tuple(now.joints), now.joints
        self.links, self.link_code = now.names, now.links
        if self._servos is not None:
            self.links += tuple(ROBOT + name for name in self._servos.model.names)
        ends = {name: now.infos[k][8:10] for name, k in now.joints.items()}
        self.limits = {name: pair if pair[0] <= pair[1] else (-np.inf, np.inf) for name, pair in ends.items()}

    def _load_file(self, file: OpenedFile, *, contacts: bool, seen: bool) -> _Model:
        """Load the file with or without contacts among its links.

        `seen`: with its visual geometry, which takes nearly all of the time and moves nothing.
        """
        client = Client()
        client.setGravity(0.0, 0.0, -GRAVITY)
        flags = (bullet.URDF_USE_SELF_COLLISION if contacts else 0) | (0 if seen else bullet.URDF_IGNORE_VISUAL_SHAPES)
        try:
            loaded = _loaded(client, file.urdf, file.root, useFixedBase=True, flags=flags)
        except Unloadable as error:
            printed = _printed(lambda: client.loadURDF(str(file.urdf), flags=flags))
            if not printed:
                raise
            raise Unloadable(f"{error.__cause__} It prints: {printed}", error.reproduction) from error
        if contacts:
            self.facts = {"path": str(file.urdf), "silent": self._silent_pairs(loaded)}
            loaded.part(self._silent_pairs(loaded))
        loaded.saved = client.saveState()
        return loaded

    def _load_world(self, spec: WorldSpec) -> _Model:
        placed, mechanism, itself = spec.object, spec.object.mechanism, spec.grip is None
        client = Client()
        client.setPhysicsEngineParameter(enableFileCaching=0, fixedTimeStep=spec.step)
        client.setGravity(0.0, 0.0, -GRAVITY)
        flags = _FLAGS if itself else bullet.URDF_USE_INERTIA_FROM_FILE
        root, joints = mechanism.robot.root, mechanism.joints
        self._object = loaded = _loaded(client, placed.urdf, root, joints, useFixedBase=True, flags=flags)
        for index in loaded.links.values():
            meshes = any(shape[2] == bullet.GEOM_MESH for shape in client.getCollisionShapeData(loaded.body, index))
            self._margin[index] = HULL_MARGIN if meshes else 0.0
        if not _complete(loaded, mechanism):
            raise Unloadable("it loses links or joints")
        if mechanism.robot.loops:
            client.setPhysicsEngineParameter(erp=_PIN_ERP, numSolverIterations=_PIN_ITERATIONS)
            loaded.close_loops(mechanism.robot)
        welded = _welded_pairs(mechanism) if itself else []
        client.setPhysicsEngineParameter(numSolverIterations=spec.iterations, deterministicOverlappingPairs=1)
        loaded.part((loaded.links[first], loaded.links[second]) for first, second in (*welded, *placed.apart))
        self._mechanism, names, self._passive = mechanism, list(joints), _passive(mechanism.robot)
        leaders = [names.index(travel.joint) for travel in mechanism.travels]
        self._leaders = [loaded.places[k] for k in leaders]
        self._followers = [k for k, name in enumerate(names) if k not in leaders and name not in self._passive]
        self._T_base = _pose_of(*client.getBasePositionAndOrientation(loaded.body))
        self._dynamics = [client.getDynamicsInfo(loaded.body, index)[:3] for index in self._document_links]
        self._move_root(np.eye(4))
        self._servos = None if spec.robot is None else _Servos(loaded, spec.robot, spec.grip)
        if spec.point is not None:
            self._point, self._link = spec.point, loaded.links[spec.point.link]
        return loaded

    @property
    def _document_links(self) -> list[int]:
        """PyBullet's indices of the object's links, in the order of the document."""
        return [self._object.links[name] for name in self._mechanism.links]

    def _move_root(self, T_root: FloatArray) -> None:
        assert self._spec is not None
        loaded, self._T_root = self._object, T_root @ self._spec.object.T_world_root
        T = self._T_root @ self._T_base
        turn = quaternion_of(T[:3, :3], real_last=True)
        loaded.client.resetBasePositionAndOrientation(loaded.body, T[:3, 3].tolist(), turn)
        if loaded.saved is not None:
            loaded.client.removeState(loaded.saved)
        loaded.saved = None

    def _silent_pairs(self, loaded: _Model) -> list[tuple[int, int]]:
        """Pairs that a fixed joint connects, that only one moving joint parts, or that pass by declaration."""
        infos, names, top = loaded.infos, dict(enumerate(loaded.names, _BASE)), {-1: -1}
        for k, info in enumerate(infos):  # parents come first
            top[k] = top[info[16]] if info[2] == bullet.JOINT_FIXED else k
        above = {k: top[infos[k][16]] if k >= 0 else None for k in set(top.values())}
        solid = [k for k in top if loaded.client.getCollisionShapeData(loaded.body, k)]
        return [
            (a, b)
            for a, b in combinations(solid, 2)
            if top[a] == top[b]
            or top[a] == above[top[b]]
            or top[b] == above[top[a]]
            or {names[a], names[b]} & self._passing
        ]

    def place(
        self,
        values: FloatArray,
        robot: FloatArray | None = None,
        *,
        speeds: FloatArray | None = None,
        contacts: bool = True,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """Implement `Engine`; motors of a file that were released are put back."""
        if self._file is None:
            self._place_in_world(values, robot)
            return
        now = self._worlds.get(contacts)
        if now is None:
            now = self._load_file(self._file, contacts=contacts, seen=False)
        self._now, self._moved = now, True
        self._worlds[contacts] = now
        now.client.restoreState(now.saved)
        now.set(values.tolist(), None if speeds is None else speeds.tolist())
        now.client.setGravity(0.0, 0.0, -GRAVITY if gravity else 0.0)
        for k in now.commanded:
            now.brake(k, _MOTOR)
        now.commanded = {now.places[number] for number in released or ()}
        for k in now.commanded:
            now.brake(k, 0.0)

    def _place_in_world(self, values: FloatArray, robot: FloatArray | None) -> None:
        assert self._spec is not None
        loaded, client = self._object, self._object.client
        if loaded.saved is None:
            loaded.set(self._mechanism.values_at_rest.tolist())
            loaded.forget_contacts()
            loaded.saved = client.saveState()
        client.restoreState(loaded.saved)
        loaded.set(values.tolist())
        if self._spec.object.locked:
            named = zip(self.joints, values.tolist(), strict=True)
            loaded.hold({name: value for name, value in named if name not in self._passive})
            for index in loaded.places:
                client.changeDynamics(loaded.body, index, jointDamping=0.0)
        client.performCollisionDetection()
        if robot is not None and self._servos is not None:
            self._servos.place(robot)
            client.performCollisionDetection()

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Implement `Engine`."""
        now, self._moved = self._now, True
        now.client.resetJointStatesMultiDof(now.body, now.places, q[:, None].tolist(), v[:, None].tolist())

    def step(self, count: int = 1) -> None:
        """Implement `Engine`."""
        for step in range(1, count + 1):
            if self._hand is not None:
                self._pull(self._hand)
            if self._servos is not None:
                self._servos.lead(step / count)
            if self._followers:
                self._follow()
            self._now.client.stepSimulation()
        self._moved = False
        if self._servos is not None:
            self._servos.led = self._servos.wanted

    def _pull(self, hand: PullingHand) -> None:
        """Apply the hand's force in the next step."""
        client, state = self._now.client, self._link_state()
        at = self._at_hold(state)
        if hand.spring:
            velocity = np.array(state[6]) + np.cross(state[7], at - np.array(state[0]))
            spring = hand.stiffness * (self._pulled - at) - hand.damping * velocity
            force = np.clip(spring, -hand.force, hand.force)
        else:
            force = hand.force * self._pulled
        client.applyExternalForce(self._now.body, self._link, force.tolist(), at.tolist(), bullet.WORLD_FRAME)

    def _follow(self) -> None:
        """Make joints that mimic others follow them, which PyBullet does not care for."""
        values, now = self._mechanism.all_values(self._now.motion(self._leaders)[0][None])[0], self._now
        for k in self._followers:
            now.client.setJointMotorControl2(
                now.body,
                now.places[k],
                bullet.POSITION_CONTROL,
                targetPosition=float(values[k]),
                force=_FOLLOWER_FORCE,
            )

    def _link_state(self) -> tuple[tuple[float, ...], ...]:
        state: tuple[tuple[float, ...], ...] = self._now.client.getLinkState(
            self._now.body, self._link, computeLinkVelocity=1, computeForwardKinematics=1
        )
        return state

    def _at_hold(self, state: tuple[tuple[float, ...], ...]) -> FloatArray:
        return np.asarray(_pose_of(state[4], state[5])[:3] @ np.append(self._point.point, 1.0))

    def state(self, *, robot: bool = False) -> tuple[FloatArray, FloatArray]:
        """Implement `Engine`."""
        return self._servos.model.motion() if robot and self._servos is not None else self._now.motion()

    def link_poses(self) -> dict[str, FloatArray]:
        """Implement `Engine`; of all links of a file but the base."""
        now = self._now
        if self._file is not None:
            links = list(range(len(now.infos)))
            states = now.client.getLinkStates(now.body, links, computeForwardKinematics=True) if links else ()
            return {name: _pose_of(*state[4:6]) for name, state in zip(now.names[1:], states, strict=True)}
        leaders = [travel.joint for travel in self._mechanism.travels]
        values = now.motion(self._leaders)[0].tolist()
        poses = forward_kinematics(self._mechanism.robot, dict(zip(leaders, values, strict=True)))
        found = {name: self._T_root @ T for name, T in poses.items()}
        if self._servos is not None:
            found |= {ROBOT + name: self._servos.model.frame(name) for name in self._servos.placed.mechanism.links}
        return found

    def contacts(self) -> tuple[IntArray, FloatArray]:
        """Implement `Engine`; of the robot only those with the object."""
        now = self._now
        if self._moved:
            now.client.performCollisionDetection()
        inflated = self._margin.get
        found = [
            (point[3] + 1, point[4] + 1, -point[8] - float(inflated(point[3], 0.0) + inflated(point[4], 0.0)))
            for point in now.client.getContactPoints(now.body, now.body) or ()
        ]
        first = len(now.names) + 1
        found += [(first + point[3], point[4] + 1, -point[8] - HULL_MARGIN) for point in self._robot_contacts()]
        return np.array([row[:2] for row in found], dtype=np.int64).reshape(-1, 2), np.array([row[2] for row in found])

    def _robot_contacts(self) -> list[tuple[Any, ...]]:
        """Contacts of the robot with the object."""
        if self._servos is None:
            return []
        return list(self._now.client.getContactPoints(self._servos.model.body, self._now.body) or ())

    def warnings(self) -> dict[str, int]:
        """Implement `Engine`; PyBullet has none."""
        return {}

    def stable(self) -> bool:
        """Implement `Engine`."""
        seen = (*self.state(), *self.state(robot=True))
        return all(bool(np.isfinite(part).all()) for part in seen)

    def energy(self) -> tuple[float, float]:
        """Implement `Engine`; of all links but the base."""
        world, links = self._now, list(range(len(self._now.infos)))
        states = world.client.getLinkStates(world.body, links, computeLinkVelocity=True, computeForwardKinematics=True)
        potential = kinetic = 0.0
        for link, state in zip(links, states, strict=True):
            mass, _, tensor, *_ = world.client.getDynamicsInfo(world.body, link)
            turning = np.reshape(bullet.getMatrixFromQuaternion(state[1]), (3, 3)).T @ state[7]
            potential += GRAVITY * mass * state[0][2]
            kinetic += 0.5 * (mass * np.dot(state[6], state[6]) + np.dot(tensor, turning**2))
        return potential, float(kinetic)

    def inertias(self, values: FloatArray) -> FloatArray:
        """Implement `Engine`; the motors of the others hold them within a step."""
        self.place(values, released=())
        return np.array([self._inertia(self._now, k) for k in self._now.places])

    def _inertia(self, world: _Model, joint: int) -> float:
        """Of what hangs on a joint; PyBullet's own mass matrix fails where a tensor is unsymmetric by 1e-13."""
        info = world.client.getJointInfo(world.body, joint)
        frame = world.client.getLinkState(world.body, joint, computeForwardKinematics=True)
        axis = np.array(bullet.rotateVector(frame[5], info[13]))
        total = 0.0
        for link in self._below(joint):
            mass, _, tensor, *_ = world.client.getDynamicsInfo(world.body, link)
            centre, turned, *_ = world.client.getLinkState(world.body, link, computeForwardKinematics=True)
            if info[2] == bullet.JOINT_PRISMATIC:
                total += mass
                continue
            arm = np.cross(axis, np.subtract(centre, frame[4]))
            local = np.array(bullet.getMatrixFromQuaternion(turned)).reshape(3, 3).T @ axis
            total += mass * float(arm @ arm) + float(local @ (np.array(tensor) * local))
        return total

    def _below(self, joint: int) -> list[int]:
        """Indices of the links that a joint moves."""
        moved = [joint]
        for k, info in enumerate(self._now.infos):  # parents come first
            if info[16] in moved:
                moved.append(k)
        return moved

    def max_safe_force(self, values: FloatArray) -> FloatArray:
        """Implement `Engine`.

        Bullet lets no joint be faster than 100 rad/s within a step either, before motors hold the others: a joint that
        is light where those give way is thrown back by more.
        """
        torques, speeds = 1e-2 * self.inertias(values), []
        self.place(values, contacts=False, gravity=False, released=range(len(values)))
        for joint, torque in enumerate(torques.tolist()):
            self._now.set(values.tolist())
            self.apply(joint, torque)
            self._now.client.stepSimulation()
            speeds.append(abs(float(self.state()[1][joint])))
        return 0.5 * _FASTEST * torques / np.maximum(speeds, 1e-12)

    def apply(self, joint: int, force: float) -> None:
        """Implement `Engine`."""
        now = self._now
        now.client.setJointMotorControl2(now.body, now.places[joint], bullet.TORQUE_CONTROL, force=force)

    def command(self, values: FloatArray, speeds: FloatArray | None = None) -> None:
        """Implement `Engine`; servos are led there in the steps that follow."""
        if self._servos is not None:
            self._servos.wanted, self._servos.speeds = values, speeds
        elif self._file is None:
            self._pulled = np.asarray(values, dtype=np.float64)
        else:
            now = self._now
            for k, wanted in zip(now.places, values.tolist(), strict=True):
                now.client.setJointMotorControl2(now.body, k, bullet.POSITION_CONTROL, targetPosition=wanted)
            now.commanded.update(now.places)

    def weld(self) -> None:
        """Implement `Engine`."""
        assert self._servos is not None
        assert self._spec is not None
        assert self._spec.grip is not None
        robot, grip, tool = self._servos.model, self._spec.grip, self._servos.placed.tool
        T_world_tool = robot.frame(tool)
        T_tool, T_part = (
            np.linalg.inv(side.centre(link)) @ T_world_tool for side, link in ((robot, tool), (self._object, grip.link))
        )
        weld = robot.client.createConstraint(
            robot.body,
            robot.links[tool],
            self._object.body,
            self._object.links[grip.link],
            bullet.JOINT_FIXED,
            [0.0, 0.0, 0.0],
            T_tool[:3, 3].tolist(),
            T_part[:3, 3].tolist(),
            *(quaternion_of(T[:3, :3], real_last=True) for T in (T_tool, T_part)),
        )
        robot.client.changeConstraint(weld, maxForce=grip.weld_force)

    def unlock(self, joints: Iterable[str]) -> None:
        """Implement `Engine`."""
        for name in joints:
            self._now.brake(self._now.joints[name], 0.0)

    def observe(self) -> ObjectState:
        """Implement `Engine`."""
        (values, speeds), link = self._now.motion(self._leaders), self._link_state()
        T = _pose_of(link[4], link[5])
        return ObjectState(
            values=values,
            speeds=speeds,
            hold=self._at_hold(link),
            anchor=T[:3, 3],
            axis=T[:3, :3] @ self._point.axis,
        )

    def touch(self) -> FloatArray:
        """Implement `Engine`."""
        assert self._servos is not None
        links = self._servos.placed.finger_links
        forces = np.zeros((len(links), 3))
        rows = {self._servos.model.links[link]: row for row, link in enumerate(links)}
        held = {self._object.links[link] for link in self._point.body}
        for point in self._robot_contacts():
            if point[3] in rows and point[4] in held:
                forces[rows[point[3]]] += point[9] * np.array(point[7])
        return np.asarray(np.linalg.norm(forces, axis=1))

    def resist(self, damping: FloatArray, friction: FloatArray, hand: PullingHand | None = None) -> None:
        """Implement `Engine`; with the next `vary`."""
        self._damping, self._friction, self._hand = damping, friction, hand

    def vary(self, drawn: Variation) -> None:
        """Implement `Engine`."""
        client, body = self._object.client, self._object.body
        for index, (mass, friction, moments), factor in zip(
            self._document_links, self._dynamics, drawn.mass.tolist(), strict=True
        ):
            client.changeDynamics(
                body, index, lateralFriction=drawn.surface * friction, linearDamping=0.0, angularDamping=0.0
            )
            if index != _BASE:  # a base that is given a mass is no longer fixed
                client.changeDynamics(
                    body, index, mass=factor * mass, localInertiaDiagonal=[factor * m for m in moments]
                )
        damping, friction_of = drawn.damping * self._damping, drawn.friction * self._friction
        for k, index in enumerate(self._object.places):
            client.changeDynamics(body, index, jointDamping=float(damping[k]))
            if k not in self._followers:
                # A motor that wants no speed and is as strong as the friction is friction.
                self._object.brake(index, float(friction_of[k]))
        self._move_root(drawn.T_root)

    def close(self) -> None:
        """Implement `Engine`."""
        for world in {self._now, *self._worlds.values()}:
            world.client.disconnect()


ENGINE = PybulletEngine
