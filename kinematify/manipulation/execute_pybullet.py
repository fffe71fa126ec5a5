"""A planned motion in PyBullet, as a second opinion: position motors on the arm, a weld at the hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet

from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.robot import joint_values, rest_configuration
from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.pybullet_world import Client, PybulletBody, connect, load_at

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.config.task import ExecutionSettings
    from kinematify.manipulation.execute import Loaded
    from kinematify.manipulation.request import Hold
    from kinematify.robot.arrays import FloatArray

_MARGIN = 1e-3  # Bullet inflates convex hulls by it [m]
_STRONG = 1e5  # holds a joint where it is [N m or N]
_GAIN = 0.3  # share of an error of position that a motor makes good in a step
_ITERATIONS = 80  # of the solver


def open_world(loaded: Loaded, settings: ExecutionSettings, hold: Hold) -> PybulletExecution:
    """Load robot and object into one world, at the start of the motion.

    Raises:
        Refused: PyBullet cannot load a model.
    """
    del hold  # its hulls slip out of fingers that hold by friction
    client, motion = connect(settings.time_step, iterations=_ITERATIONS), loaded.motion
    robot, placed = (
        load_at(client, LeaderMechanism(robot=model), prepared.urdf, T_world_root, itself=False)
        for model, prepared, T_world_root in (
            (loaded.robot, loaded.robot_prepared, motion.T_world_base),
            (loaded.object, loaded.object_prepared, motion.T_world_object),
        )
    )
    world = PybulletExecution(client, loaded, settings, robot, placed)
    world.start()
    return world


@dataclass(frozen=True, eq=False)
class PybulletExecution:
    """See `kinematify.manipulation.execute.ExecutionWorld`."""

    client: Client
    loaded: Loaded
    settings: ExecutionSettings
    robot: PybulletBody
    object: PybulletBody

    def start(self) -> None:
        """Place both, hold all joints, and let the hand through what it holds."""
        motion = self.loaded.motion
        fingers = dict(zip(motion.robot.finger_joints, self.loaded.fingers(motion.grasp.spread).tolist(), strict=True))
        arm = dict(zip(motion.robot.arm_joints, motion.reach[0].tolist(), strict=True))
        _hold(self.robot, {**arm, **fingers})
        _hold(self.object, {**motion.start, motion.joint: float(motion.opened[0])})
        for index in self.object.indices:
            self.client.changeDynamics(self.object.body, index, jointDamping=0.0)
        for hand in self.loaded.hand_links:
            for held in self.loaded.held_links:
                self.client.setCollisionFilterPair(
                    self.robot.body, self.object.body, self.robot.index_of(hand), self.object.index_of(held), 0
                )

    def step(self, arm: FloatArray, speed: FloatArray) -> bool:
        """Simulate one time step."""
        joints, count = self._arm, len(self._arm)
        self.client.setJointMotorControlArray(
            self.robot.body,
            joints,
            bullet.POSITION_CONTROL,
            targetPositions=arm.tolist(),
            targetVelocities=speed.tolist(),
            forces=self.loaded.strongest(self.settings).tolist(),
            positionGains=[_GAIN] * count,
            velocityGains=[1.0] * count,
        )
        self.client.stepSimulation()
        return True

    @property
    def _arm(self) -> list[int]:
        return [self._joint(self.robot, name) for name in self.loaded.motion.robot.arm_joints]

    @staticmethod
    def _joint(side: PybulletBody, name: str) -> int:
        return side.indices[side.mechanism.joints.index(name)]

    def squeeze(self) -> None:
        """The weld holds."""

    def take_hold(self) -> None:
        """Let the joint go, and weld the hand to the part where it now is."""
        motion, client = self.loaded.motion, self.client
        for name in (motion.joint, *motion.freed):
            client.setJointMotorControl2(
                self.object.body, self._joint(self.object, name), bullet.VELOCITY_CONTROL, force=0.0
            )
        tool, held = motion.robot.tool, self.loaded.held
        T_world_tool = self.robot.frame(tool)
        T_tool, T_held = (
            np.linalg.inv(side.centre(link)) @ T_world_tool for side, link in ((self.robot, tool), (self.object, held))
        )
        weld = client.createConstraint(
            self.robot.body,
            self.robot.index_of(tool),
            self.object.body,
            self.object.index_of(held),
            bullet.JOINT_FIXED,
            [0.0, 0.0, 0.0],
            T_tool[:3, 3].tolist(),
            T_held[:3, 3].tolist(),
            *(quaternion_of(T[:3, :3], real_last=True) for T in (T_tool, T_held)),
        )
        client.changeConstraint(weld, maxForce=self.settings.weld_force)

    def opened(self) -> float:
        """Value of the joint that is opened [rad or m]."""
        joint = self._joint(self.object, self.loaded.motion.joint)
        return float(self.client.getJointState(self.object.body, joint)[0])

    def arm(self) -> FloatArray:
        """Values of the arm's joints."""
        return np.array([state[0] for state in self.client.getJointStates(self.robot.body, self._arm)])

    def joints(self) -> tuple[dict[str, float], dict[str, float]]:
        """Values of all joints of robot and object."""
        robot, placed = (dict(zip(s.mechanism.joints, s.state()[0], strict=True)) for s in (self.robot, self.object))
        return robot, placed

    def deeper(self, than: float) -> tuple[float, tuple[str, str]] | None:
        """Deepest contact of the robot, if it is deeper than that."""
        points = self.client.getContactPoints(self.robot.body, self.object.body)
        deepest = min(points, key=lambda point: point[8], default=None)
        if deepest is None or -deepest[8] - _MARGIN <= than:
            return None
        sides = ((self.robot, deepest[3]), (self.object, deepest[4]))
        link, other = (side.mechanism.links[side.link_of[index]] for side, index in sides)
        return -deepest[8] - _MARGIN, (link, other)

    def close(self) -> None:
        """Free the world."""
        self.client.disconnect()


def _hold(side: PybulletBody, values: Mapping[str, float]) -> None:
    """Set all joints, those that are not given to rest, and hold them there."""
    robot = side.mechanism.robot
    full = joint_values(robot, {**rest_configuration(robot), **values})
    for name, index in zip(side.mechanism.joints, side.indices, strict=True):
        side.client.resetJointState(side.body, index, full[name])
        side.client.setJointMotorControl2(
            side.body,
            index,
            bullet.POSITION_CONTROL,
            targetPosition=full[name],
            targetVelocity=0.0,
            force=_STRONG,
            positionGain=_GAIN,
            velocityGain=1.0,
        )
