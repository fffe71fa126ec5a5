"""DrawerPull in PyBullet: robot, object and floor in one world; motors move the robot, contacts the rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet

from kinematify.envs.articulated_object import held_links
from kinematify.envs.mujoco_arm import ROBOT, arm_facts
from kinematify.envs.pybullet_object import PybulletObject, PybulletWorld
from kinematify.robot.robot import rest_configuration
from kinematify.simulation.pybullet_world import load_at

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.robot_plan import EnvRobot, RobotPlan
    from kinematify.envs.settings import EnvSettings
    from kinematify.robot.arrays import FloatArray

_BASE = -1
_MARGIN = 1e-3  # Bullet inflates convex hulls by it [m]
_STRONG = 1e4  # holds joints that are neither of the arm nor of the fingers [N m or N]
_GAIN = 0.3  # share of an error of position that a motor makes good in a step


class PybulletArm(PybulletWorld):
    """One world; see `kinematify.envs.worlds.ArmWorld`."""

    def __init__(
        self,
        articulated_object: ArticulatedObject,
        target: Target,
        robot: EnvRobot,
        plan: RobotPlan,
        settings: EnvSettings,
    ) -> None:
        """Connect to a world of its own; `close` frees it."""
        facts = arm_facts(articulated_object, target, robot, plan)
        self.object = PybulletObject(articulated_object, target, facts.dynamics, plan.T_world_object, settings)
        self.client = self.object.client
        self._articulated_object, self._robot, self._substeps = articulated_object, robot, settings.time.substeps
        self._load(plan, settings)
        self._held = [self.object.link_index(name) for name in held_links(articulated_object, target)]
        forces = np.full(len(robot.robot.finger_joints), settings.robot.grip_force)
        self._forces = np.concatenate([robot.strongest, forces]).tolist()
        self._wanted = np.zeros(len(self._forces))

    def _load(self, plan: RobotPlan, settings: EnvSettings) -> None:
        client, names = self.client, self._robot.robot
        loaded = load_at(client, self._robot.mechanism, self._robot.loaded, plan.T_world_base, itself=True)
        self._loaded, self.body = loaded, loaded.body
        joints = dict(zip(loaded.mechanism.joints, loaded.indices, strict=True))
        driven = (*names.arm_joints, *names.finger_joints)
        self._joints = [joints[name] for name in driven]
        for index in loaded.link.tolist():
            bullet.changeDynamics(self.body, index, lateralFriction=settings.robot.friction, physicsClientId=client)
        rest = rest_configuration(self._robot.mechanism.robot)
        for name, index in joints.items():
            if name not in driven:
                bullet.resetJointState(self.body, index, rest.get(name, 0.0), physicsClientId=client)
                bullet.setJointMotorControl2(
                    self.body, index, bullet.POSITION_CONTROL, targetPosition=rest.get(name, 0.0), force=_STRONG,
                    physicsClientId=client,
                )  # fmt: skip
        self._lay_floor()

    def _lay_floor(self) -> None:
        """The robot meets the floor, the object stands on it."""
        shape = bullet.createCollisionShape(bullet.GEOM_PLANE, physicsClientId=self.client)
        floor = bullet.createMultiBody(0.0, shape, physicsClientId=self.client)
        for name in self._articulated_object.scene.mechanism.links:
            bullet.setCollisionFilterPair(
                floor, self.object.body, _BASE, self.object.link_index(name), 0, physicsClientId=self.client
            )

    def place(self, leaders: FloatArray, arm: FloatArray) -> float:
        """Set the object's joints and those of the arm, fingers apart, and stop all."""
        self.object.place(leaders)
        self._wanted = np.concatenate([arm, self._robot.finger_values(1.0)])
        for index, value in zip(self._joints, self._wanted.tolist(), strict=True):
            bullet.resetJointState(self.body, index, value, physicsClientId=self.client)
        self._drive(self._wanted)
        bullet.performCollisionDetection(physicsClientId=self.client)
        return self.depth()

    def act(self, arm: FloatArray, fingers: FloatArray) -> None:
        """Simulate until the next action, motors led smoothly to these values."""
        before, wanted = self._wanted, np.concatenate([arm, fingers])
        for step in range(1, self._substeps + 1):
            self._drive(before + step / self._substeps * (wanted - before))
            self.object.follow()
            bullet.stepSimulation(physicsClientId=self.client)
        self._wanted = wanted
        self.object.look()

    def _drive(self, values: FloatArray) -> None:
        count = len(self._joints)
        bullet.setJointMotorControlArray(
            self.body, self._joints, bullet.POSITION_CONTROL, targetPositions=values.tolist(), forces=self._forces,
            positionGains=[_GAIN] * count, velocityGains=[1.0] * count, physicsClientId=self.client,
        )  # fmt: skip

    def joints(self) -> tuple[FloatArray, FloatArray]:
        """Values and speeds of the arm's joints and then of the fingers'."""
        states = bullet.getJointStates(self.body, self._joints, physicsClientId=self.client)
        return np.array([state[0] for state in states]), np.array([state[1] for state in states])

    def tool(self) -> FloatArray:
        """Pose of the tool, shape (4, 4)."""
        return self._loaded.frame(self._robot.robot.tool)

    def touch(self) -> FloatArray:
        """Force of each finger on the part [N], shape (fingers,)."""
        forces = np.zeros((len(self._robot.finger_links), 3))
        rows = {self._loaded.index_of(link): row for row, link in enumerate(self._robot.finger_links)}
        for point in bullet.getContactPoints(self.body, self.object.body, physicsClientId=self.client) or ():
            if point[3] in rows and point[4] in self._held:
                forces[rows[point[3]]] += point[9] * np.array(point[7])
        return np.asarray(np.linalg.norm(forces, axis=1))

    def depth(self) -> float:
        """Deepest contact of the object with itself or the robot [m]."""
        points = bullet.getContactPoints(self.body, self.object.body, physicsClientId=self.client)
        return max([super().depth(), *(float(-point[8]) - _MARGIN for point in points or ())])

    def stable(self) -> bool:
        """True if all numbers are finite."""
        return super().stable() and bool(np.isfinite(self.joints()).all())

    def link_poses(self) -> Mapping[str, FloatArray]:
        """World poses of the links of object and robot."""
        return {
            **super().link_poses(),
            **{ROBOT + name: self._loaded.frame(name) for name in self._loaded.mechanism.links},
        }
