"""OpenPart in PyBullet: the same hand as in MuJoCo, its force set anew in every step of the engine."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet

from kinematify.envs.mujoco_hand import POSITION, hand_facts
from kinematify.envs.pybullet_object import PybulletObject, PybulletWorld

if TYPE_CHECKING:
    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.settings import EnvSettings
    from kinematify.robot.arrays import FloatArray


class PybulletHand(PybulletWorld):
    """One world; see `kinematify.envs.worlds.HandWorld`."""

    def __init__(
        self, articulated_object: ArticulatedObject, target: Target, control: str, settings: EnvSettings
    ) -> None:
        """Connect to a world of its own; `close` frees it."""
        self.facts = hand_facts(articulated_object, target, control)
        self.object = PybulletObject(
            articulated_object, target, self.facts.dynamics, articulated_object.T_world_root, settings
        )
        self.client = self.object.client
        self._control, self._substeps = control, settings.time.substeps
        self._stride = self.facts.speed * settings.time.control_step
        self._lead = self.facts.force / self.facts.stiffness
        self._wanted = np.zeros(3)

    def place(self, leaders: FloatArray) -> float:
        """Set the object's joints and stop them; the hand's spring is slack."""
        self.object.place(leaders)
        self._wanted = self.object.hold()
        return self.object.depth()

    def act(self, action: FloatArray) -> None:
        """Simulate until the next action."""
        action = np.asarray(action, dtype=np.float64)
        if self._control == POSITION:
            hold = self.object.hold()
            lead = self._wanted - hold + self._stride * action
            self._wanted = hold + np.clip(lead, -self._lead, self._lead)
        for _ in range(self._substeps):
            hold, velocity = self.object.hold_motion()
            self.object.push(self._force(action, hold, velocity), hold)
            self.object.follow()
            bullet.stepSimulation(physicsClientId=self.client)
        self.object.look()

    def _force(self, action: FloatArray, hold: FloatArray, velocity: FloatArray) -> FloatArray:
        """Of the hand, world axes [N], shape (3,)."""
        facts = self.facts
        if self._control != POSITION:
            return facts.force * action
        spring = facts.stiffness * (self._wanted - hold) - facts.spring_damping * velocity
        return np.asarray(np.clip(spring, -facts.force, facts.force))

    def command(self) -> FloatArray:
        """From the hold to where the hand wants it [m], zero in force control, shape (3,)."""
        return self._wanted - self.object.hold() if self._control == POSITION else np.zeros(3)
