"""What a user gets who loads a URDF in an engine as it is, with the engine's own defaults and nothing prepared.

The model is left alone under gravity, and then a hand moves one joint after the other over its range: it pushes with
what it has until the joint moves at a walking pace. In MuJoCo the others are put back after every step; in PyBullet
they are held by the motors that it gives to every joint, and only the one that is driven is let go.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import mujoco
import numpy as np
import pybullet as bullet

from kinematify.model.dynamics import joint_load
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path
    from typing import Self

    from kinematify.robot.robot import Joint, Robot

PLAIN_WORLDS = ("mujoco", "pybullet", "pybullet, self-collision")
"""Names of engines and of ways to load in them."""
_REST_SECONDS = 4.0
_DRIVE_SECONDS = 8.0
"""For each side of a range."""
_PACE = {True: 1.5, False: 0.4}
"""Speed at which a hand moves what turns [rad/s] and what slides [m/s]."""
_GAINS = 0.3, 0.05
"""Share of the difference of speed that a hand makes up for in one step, and that it adds to what it pushes with."""
_SOFT = {True: 0.01, False: 0.003}
"""How far soft limits give way [rad or m]."""
_SOFT_SHARE = 0.02
"""The same as a fraction of the range."""
_MOTOR = 240.0
"""Force of the motors that PyBullet gives to every joint: an impulse of 1 in each of its steps [N m or N]."""
REACHED = 0.95
"""Share of its range over which a joint must move."""


@dataclass(frozen=True, kw_only=True)
class JointAsLoaded:
    """One joint in one engine."""

    joint: str
    reached: float
    """Share of its range over which a hand moves it."""
    beyond: float
    """How far it leaves its range by itself [rad or m]."""
    moved: float
    """How far from zero it is after it was left alone [rad or m]."""
    rests: bool
    """Its limits hold it while it is left alone."""
    still: bool
    """It also stays where it is."""

    @property
    def works(self) -> bool:
        """It rests, and it moves when it is pushed."""
        return self.rests and self.reached >= REACHED


@dataclass(frozen=True, kw_only=True)
class AsLoaded:
    """A model in one engine."""

    world: str
    joints: tuple[JointAsLoaded, ...]
    depth: float
    """Deepest contact at zero [m]."""
    pair: tuple[str, str] | None
    """Links that have it."""

    @property
    def working(self) -> int:
        """Number of joints that work."""
        return sum(joint.works for joint in self.joints)

    @property
    def works(self) -> bool:
        """Whether all joints do."""
        return self.working == len(self.joints)


class _World(Protocol):
    """A loaded model that runs."""

    step_seconds: float

    def reset(self) -> None: ...
    def let_go(self, joint: str) -> None: ...
    def step(self, joint: str | None = None, force: float = 0.0) -> None: ...
    def value(self, joint: str) -> float: ...
    def speed(self, joint: str) -> float: ...
    def inertia(self, joint: str) -> float: ...
    def deepest(self) -> tuple[float, tuple[str, str] | None]: ...
    def __enter__(self) -> Self: ...
    def __exit__(self, *error: object) -> None: ...


def as_loaded(
    urdf: Path, robot: Robot, world: str, forces: Mapping[str, float], free: Mapping[str, tuple[float, float]]
) -> AsLoaded:
    """Load a file and try all joints that lead.

    Args:
        urdf: The file.
        robot: What it describes.
        world: One of `PLAIN_WORLDS`.
        forces: What each joint is pushed with [N m or N].
        free: Values between which a joint is free by exact geometry [rad or m], where that is less than its range.

    Raises:
        ValueError, pybullet.error: The engine does not load the file.
    """
    plain: _World = (
        _MujocoWorld(urdf) if world == "mujoco" else _PybulletWorld(urdf, robot, selfish=world != "pybullet")
    )
    with plain as loaded:
        depth, pair = loaded.deepest()
        ranges = {joint.name: _range(joint, free.get(joint.name, (-math.inf, math.inf))) for joint in robot.leaders}
        beyond, moved = _left_alone(loaded, ranges)
        joints = []
        for joint in robot.leaders:
            low, high = ranges[joint.name]
            give = max(_SOFT_SHARE * (high - low), _SOFT[joint.kind.turns])
            joints.append(
                JointAsLoaded(
                    joint=joint.name,
                    reached=_driven(loaded, joint, (low, high), forces[joint.name]),
                    beyond=beyond[joint.name],
                    moved=moved[joint.name],
                    rests=beyond[joint.name] <= give,
                    still=abs(moved[joint.name]) <= give,
                )
            )
        return AsLoaded(world=world, joints=tuple(joints), depth=depth, pair=pair)


def _range(joint: Joint, free: tuple[float, float]) -> tuple[float, float]:
    """Where a joint is to move, around zero: what has no limits half a turn to both sides."""
    lower, upper = (-math.pi, math.pi) if joint.kind is JointType.CONTINUOUS else (joint.lower, joint.upper)
    return float(max(lower, free[0])), float(min(upper, free[1]))


def _left_alone(world: _World, ranges: Mapping[str, tuple[float, float]]) -> tuple[dict[str, float], dict[str, float]]:
    """How far joints leave their ranges, and where they are in the end, by name."""
    world.reset()
    beyond = dict.fromkeys(ranges, 0.0)
    for _ in range(round(_REST_SECONDS / world.step_seconds)):
        world.step()
        for name, (low, high) in ranges.items():
            value = world.value(name)
            beyond[name] = max(beyond[name], low - value, value - high)
    return beyond, {name: world.value(name) for name in ranges}


def _driven(world: _World, joint: Joint, ends: tuple[float, float], force: float) -> float:
    """Share of a range over which a hand moves a joint, from zero to both ends."""
    low, high = min(ends[0], 0.0), max(ends[1], 0.0)
    if high == low:
        return 1.0
    way = sum(_pushed(world, joint, end, force) for end in (low, high) if end != 0.0)
    return way / (high - low)


def _pushed(world: _World, joint: Joint, end: float, force: float) -> float:
    """How far a hand moves a joint from zero towards an end [rad or m]."""
    world.reset()
    world.let_go(joint.name)
    pace = math.copysign(_PACE[joint.kind.turns], end)
    quick, slow = (gain * world.inertia(joint.name) / world.step_seconds for gain in _GAINS)
    push, farthest = 0.0, 0.0
    for _ in range(round(_DRIVE_SECONDS / world.step_seconds)):
        missing = pace - world.speed(joint.name)
        push = min(max(push + slow * missing, -force), force)
        world.step(joint.name, min(max(push + quick * missing, -force), force))
        farthest = max(farthest, world.value(joint.name) * math.copysign(1.0, end))
        if farthest >= abs(end):
            break
    return min(farthest, abs(end))


class _MujocoWorld:
    """`MjModel.from_xml_path` and `mj_step`."""

    def __init__(self, urdf: Path) -> None:
        self._model = mujoco.MjModel.from_xml_path(str(urdf))
        self._data = mujoco.MjData(self._model)
        self.step_seconds = float(self._model.opt.timestep)

    def reset(self) -> None:
        mujoco.mj_resetData(self._model, self._data)
        mujoco.mj_forward(self._model, self._data)

    def let_go(self, joint: str) -> None:
        """Nothing holds a joint."""

    def step(self, joint: str | None = None, force: float = 0.0) -> None:
        self._data.qfrc_applied[:] = 0.0
        if joint is None:
            mujoco.mj_step(self._model, self._data)
            return
        dof = self._dof(joint)
        self._data.qfrc_applied[dof] = force
        mujoco.mj_step(self._model, self._data)
        others = np.arange(self._model.nv) != dof  # a URDF has only joints of one degree of freedom
        self._data.qpos[others], self._data.qvel[others] = 0.0, 0.0

    def value(self, joint: str) -> float:
        return float(self._data.qpos[self._dof(joint)])

    def speed(self, joint: str) -> float:
        return float(self._data.qvel[self._dof(joint)])

    def inertia(self, joint: str) -> float:
        """What a push at a joint accelerates while the others are not held."""
        matrix = np.zeros((self._model.nv, self._model.nv))
        mujoco.mj_fullM(self._model, self._data, matrix)
        return float(1.0 / np.linalg.inv(matrix)[self._dof(joint), self._dof(joint)])

    def deepest(self) -> tuple[float, tuple[str, str] | None]:
        self.reset()
        contacts = [self._data.contact[number] for number in range(self._data.ncon)]
        worst = min(contacts, key=lambda contact: float(contact.dist), default=None)
        if worst is None or worst.dist >= 0.0:
            return 0.0, None
        first, second = (self._model.body(self._model.geom_bodyid[geom]).name for geom in worst.geom)
        return -float(worst.dist), (first, second)

    def _dof(self, joint: str) -> int:
        return int(self._model.joint(joint).dofadr[0])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        """Nothing is kept outside of Python."""


class _PybulletWorld:
    """`loadURDF` with a fixed base and `stepSimulation`."""

    def __init__(self, urdf: Path, robot: Robot, *, selfish: bool) -> None:
        self._robot = robot
        self._client = bullet.connect(bullet.DIRECT)
        flags = bullet.URDF_USE_SELF_COLLISION if selfish else 0
        self._call(bullet.setPhysicsEngineParameter, enableFileCaching=0)
        self._call(bullet.setGravity, 0.0, 0.0, -9.81)
        self._body = self._call(bullet.loadURDF, str(urdf), useFixedBase=1, flags=flags)
        self.step_seconds = 1.0 / 240.0
        count = self._call(bullet.getNumJoints, self._body)
        infos = [self._call(bullet.getJointInfo, self._body, number) for number in range(count)]
        self._index = {info[1].decode(): info[0] for info in infos if info[2] != bullet.JOINT_FIXED}
        self._links = {-1: "base", **{info[0]: info[12].decode() for info in infos}}

    def _call(self, function: Any, *arguments: Any, **options: Any) -> Any:
        return function(*arguments, **options, physicsClientId=self._client)

    def reset(self) -> None:
        for number in self._index.values():
            self._call(bullet.resetJointState, self._body, number, 0.0, 0.0)
            self._call(bullet.setJointMotorControl2, self._body, number, bullet.VELOCITY_CONTROL, force=_MOTOR)

    def let_go(self, joint: str) -> None:
        number = self._index[joint]
        self._call(bullet.setJointMotorControl2, self._body, number, bullet.VELOCITY_CONTROL, force=0.0)

    def step(self, joint: str | None = None, force: float = 0.0) -> None:
        if joint is not None:
            number = self._index[joint]
            self._call(bullet.setJointMotorControl2, self._body, number, bullet.TORQUE_CONTROL, force=force)
        self._call(bullet.stepSimulation)

    def value(self, joint: str) -> float:
        return float(self._call(bullet.getJointState, self._body, self._index[joint])[0])

    def speed(self, joint: str) -> float:
        return float(self._call(bullet.getJointState, self._body, self._index[joint])[1])

    def inertia(self, joint: str) -> float:
        """Of what the joint carries: the others are held. PyBullet's own mass matrix fails for some models."""
        return joint_load(self._robot, self._robot.joint_by_name[joint]).inertia

    def deepest(self) -> tuple[float, tuple[str, str] | None]:
        self.reset()
        self._call(bullet.performCollisionDetection)
        contacts = self._call(bullet.getContactPoints, self._body, self._body)
        worst = min(contacts, key=lambda contact: float(contact[8]), default=None)
        if worst is None or worst[8] >= 0.0:
            return 0.0, None
        return -float(worst[8]), (self._links[worst[3]], self._links[worst[4]])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        bullet.disconnect(self._client)
