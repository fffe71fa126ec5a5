"""A planned motion in PyBullet, as a second opinion: position motors on the arm, a weld at the hand."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet

from kinematify.manipulation.execute import Execution, Log, judged
from kinematify.manipulation.motion import timed
from kinematify.manipulation.outcome import Hold
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import joint_values, rest_configuration
from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.configurations import GRAVITY

if TYPE_CHECKING:
    from kinematify.config.task import ExecutionSettings
    from kinematify.manipulation.execute import Loaded
    from kinematify.manipulation.motion import Reference
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot
    from kinematify.simulation.prepared import Prepared

_MARGIN = 1e-3  # Bullet inflates convex hulls by it [m]
_STRONG = 1e5  # holds a joint where it is [N m or N]
_BASE = -1


def execute(loaded: Loaded, settings: ExecutionSettings) -> Execution:
    """Run a planned motion with a weld at the hand; the arguments are those of MuJoCo's `execute`.

    Raises:
        pybullet.error: PyBullet cannot load a model.
    """
    reference = timed(loaded.motion, loaded.fastest(settings), settings, settings.time_step)
    log = Log(frames=[])
    with _world(loaded, settings) as world:
        values = world.run(reference, log)
    return judged(loaded, log, values, reference, settings, engine="pybullet", hold=Hold.WELD)


@dataclass(frozen=True, eq=False)
class _Side:
    """One of the two models."""

    client: int
    body: int
    model: Robot
    joints: dict[str, int]
    """Index of every joint that moves."""
    links: dict[str, int]

    @classmethod
    def load(cls, client: int, model: Robot, prepared: Prepared, T: FloatArray) -> _Side:
        body = bullet.loadURDF(
            str(prepared.urdf),
            basePosition=T[:3, 3].tolist(),
            baseOrientation=quaternion_of(T[:3, :3], real_last=True),
            useFixedBase=True,
            flags=bullet.URDF_USE_INERTIA_FROM_FILE,
            physicsClientId=client,
        )
        infos = [bullet.getJointInfo(body, k, client) for k in range(bullet.getNumJoints(body, client))]
        return cls(
            client=client,
            body=body,
            model=model,
            joints={info[1].decode(): info[0] for info in infos if info[2] != bullet.JOINT_FIXED},
            links={model.root: _BASE, **{info[12].decode(): info[0] for info in infos}},
        )

    @property
    def link_names(self) -> dict[int, str]:
        return {index: name for name, index in self.links.items()}

    def place(self, values: dict[str, float]) -> None:
        """Set all joints and hold them there."""
        full = joint_values(self.model, {**rest_configuration(self.model), **values})
        for name, index in self.joints.items():
            bullet.resetJointState(self.body, index, full[name], physicsClientId=self.client)
            self.drive(name, full[name], _STRONG)

    def drive(self, name: str, value: float, force: float, speed: float = 0.0) -> None:
        bullet.setJointMotorControl2(
            self.body, self.joints[name], bullet.POSITION_CONTROL, targetPosition=value, targetVelocity=speed,
            force=force, positionGain=0.3, velocityGain=1.0, physicsClientId=self.client,
        )  # fmt: skip

    def center(self, link: str) -> FloatArray:
        """Pose of a link's centre of mass, in which constraints are stated, world frame, shape (4, 4)."""
        index = self.links[link]
        if index == _BASE:
            return _transform(*bullet.getBasePositionAndOrientation(self.body, self.client))
        state = bullet.getLinkState(self.body, index, computeForwardKinematics=1, physicsClientId=self.client)
        return _transform(state[0], state[1])

    def frame(self, link: str) -> FloatArray:
        """Pose of a link that is not the root, world frame, shape (4, 4)."""
        state = bullet.getLinkState(
            self.body, self.links[link], computeForwardKinematics=1, physicsClientId=self.client
        )
        return _transform(state[4], state[5])


@contextmanager
def _world(loaded: Loaded, settings: ExecutionSettings) -> Iterator[_World]:
    client = bullet.connect(bullet.DIRECT)
    try:
        bullet.setPhysicsEngineParameter(
            enableFileCaching=0, fixedTimeStep=settings.time_step, numSolverIterations=80, physicsClientId=client
        )
        bullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=client)
        motion = loaded.motion
        robot = _Side.load(client, loaded.robot, loaded.robot_prepared, motion.T_world_base)
        placed = _Side.load(client, loaded.object, loaded.object_prepared, motion.T_world_object)
        yield _World(client, loaded, settings, robot, placed)
    finally:
        bullet.disconnect(client)


@dataclass(frozen=True, eq=False)
class _World:
    client: int
    loaded: Loaded
    settings: ExecutionSettings
    robot: _Side
    object: _Side

    def run(self, reference: Reference, log: Log) -> FloatArray:
        """Track the reference; returns the value of the object's joint after every step, shape (steps,)."""
        motion, settings = self.loaded.motion, self.settings
        self._start(reference)
        force = self.loaded.strongest(settings)
        joint = self.object.joints[motion.joint]
        values = np.full(reference.steps, np.nan)
        arm = [self.robot.joints[name] for name in motion.robot.arm_joints]
        for step in range(reference.steps):
            if step == reference.pulls:
                self._take_hold()
            bullet.setJointMotorControlArray(
                self.robot.body, arm, bullet.POSITION_CONTROL, targetPositions=reference.arm[step].tolist(),
                targetVelocities=reference.speed[step].tolist(), forces=force.tolist(),
                positionGains=[0.3] * len(arm), velocityGains=[1.0] * len(arm), physicsClientId=self.client,
            )  # fmt: skip
            bullet.stepSimulation(self.client)
            values[step] = bullet.getJointState(self.object.body, joint, self.client)[0]
            states = bullet.getJointStates(self.robot.body, arm, self.client)
            lag = np.abs(np.array([state[0] for state in states]) - reference.arm[step])
            log.tracking = max(log.tracking, float(lag.max()))
            self._note_contacts(log)
        return values

    def _start(self, reference: Reference) -> None:
        motion = self.loaded.motion
        fingers = dict(zip(motion.robot.finger_joints, self.loaded.fingers(motion.grasp.spread).tolist(), strict=True))
        arm = dict(zip(motion.robot.arm_joints, reference.arm[0].tolist(), strict=True))
        self.robot.place({**arm, **fingers})
        self.object.place({**motion.start, motion.joint: float(motion.opened[0])})
        for name, joint in self.loaded.object.joint_by_name.items():
            if joint.kind is not JointType.FIXED:
                bullet.changeDynamics(
                    self.object.body, self.object.joints[name], jointDamping=0.0, physicsClientId=self.client
                )
        for hand in self.loaded.hand_links:
            for held in self.loaded.held_links:
                bullet.setCollisionFilterPair(
                    self.robot.body, self.object.body, self.robot.links[hand], self.object.links[held], 0,
                    physicsClientId=self.client,
                )  # fmt: skip

    def _take_hold(self) -> None:
        """Let the joint go, and weld the hand to the part where it now is."""
        motion, client = self.loaded.motion, self.client
        for name in (motion.joint, *motion.freed):
            bullet.setJointMotorControl2(
                self.object.body, self.object.joints[name], bullet.VELOCITY_CONTROL, force=0.0, physicsClientId=client
            )
        T_world_tool = self.robot.frame(motion.robot.tool)
        local = [
            np.linalg.inv(side.center(link)) @ T_world_tool
            for side, link in ((self.robot, motion.robot.tool), (self.object, self.loaded.held))
        ]
        weld = bullet.createConstraint(
            self.robot.body, self.robot.links[motion.robot.tool], self.object.body, self.object.links[self.loaded.held],
            bullet.JOINT_FIXED, [0.0, 0.0, 0.0], local[0][:3, 3].tolist(), local[1][:3, 3].tolist(),
            *(quaternion_of(T[:3, :3], real_last=True) for T in local), physicsClientId=client,
        )  # fmt: skip
        bullet.changeConstraint(weld, maxForce=self.settings.weld_force, physicsClientId=client)

    def _note_contacts(self, log: Log) -> None:
        for point in bullet.getContactPoints(self.robot.body, self.object.body, physicsClientId=self.client):
            depth = -point[8] - _MARGIN
            if depth > log.depth:
                log.touch(self.robot.link_names[point[3]], self.object.link_names[point[4]], depth)


def _transform(position: tuple[float, ...], orientation: tuple[float, ...]) -> FloatArray:
    T = np.eye(4)
    T[:3, :3] = np.array(bullet.getMatrixFromQuaternion(orientation)).reshape(3, 3)
    T[:3, 3] = position
    return T
