"""OpenPart in MuJoCo: a hand without a robot pushes and pulls at one point of the part."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.envs.mujoco_object import (
    HOLD,
    WORLD,
    MujocoObject,
    MujocoWorld,
    add_object,
    deepest_contact,
    env_spec,
    parsed,
)
from kinematify.envs.settings import load_settings

if TYPE_CHECKING:
    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.dynamics import JointDynamics
    from kinematify.envs.settings import EnvSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.mujoco_model import ParsedModel

FORCE, POSITION = "force", "position"
_DAMPING_RATIO = 2.0  # of the hand's spring, times mass and frequency: neither swings nor creeps


@dataclass(frozen=True, kw_only=True, eq=False)
class HandFacts:
    """A compiled world and what its hand can do; worlds are copies of it."""

    model: mujoco.MjModel
    source: ParsedModel
    dynamics: JointDynamics
    inertia: float
    """That the joint moves at most [kg m^2 or kg]."""
    force: float
    """Of a full action, or of the spring at most [N]."""
    stiffness: float
    """Of the spring [N/m]."""
    spring_damping: float
    """[N s/m]."""
    speed: float
    """Of the hand with a full action in position control [m/s]."""


@lru_cache(maxsize=16)
def hand_facts(articulated_object: ArticulatedObject, target: Target, control: str) -> HandFacts:
    """Compile the world of a hand, once per process."""
    settings = load_settings()
    source = parsed(articulated_object.loaded, articulated_object.scene, settings)
    spec = env_spec(settings)
    add_object(spec, articulated_object, target, source, articulated_object.T_world_root)
    for axis, letter in enumerate("xyz"):
        hand = spec.add_actuator(name=f"kinematify hand {letter}", trntype=mujoco.mjtTrn.mjTRN_SITE, target=HOLD)
        hand.refsite = WORLD
        hand.gear = np.eye(6)[axis]
    model = spec.compile()
    placed = MujocoObject(model, articulated_object, target, source)
    dynamics = placed.set_up(settings)
    force, inertia = placed.force(dynamics, settings), placed.inertia()
    stiffness = force / (settings.hand.lag * target.way)
    damping = _DAMPING_RATIO * np.sqrt(stiffness * inertia) / target.path_ratio
    _set_hand(model, control, force, stiffness, damping)
    return HandFacts(
        model=model, source=source, dynamics=dynamics, inertia=inertia, force=force, stiffness=stiffness,
        spring_damping=float(damping), speed=settings.hand.speed * target.way,
    )  # fmt: skip


def _set_hand(model: mujoco.MjModel, control: str, force: float, stiffness: float, damping: float) -> None:
    """Forces along the world's axes, or springs to a place, no stronger than the full force."""
    if control == FORCE:
        model.actuator_gainprm[:, 0] = force
        return
    model.actuator_biastype[:] = mujoco.mjtBias.mjBIAS_AFFINE
    model.actuator_gainprm[:, 0], model.actuator_biasprm[:, 1], model.actuator_biasprm[:, 2] = (
        stiffness,
        -stiffness,
        -damping,
    )
    model.actuator_forcelimited[:] = 1
    model.actuator_forcerange[:] = force * np.array([-1.0, 1.0])


class MujocoHand(MujocoWorld):
    """One world; see `kinematify.envs.worlds.HandWorld`."""

    def __init__(
        self, articulated_object: ArticulatedObject, target: Target, control: str, settings: EnvSettings
    ) -> None:
        """Copy the compiled world, so that it can be redrawn."""
        self.facts = hand_facts(articulated_object, target, control)
        self.model = copy(self.facts.model)
        self.data = mujoco.MjData(self.model)
        self.object = MujocoObject(self.model, articulated_object, target, self.facts.source)
        self.object.keep()
        self._articulated_object, self._control, self._settings = articulated_object, control, settings
        self._substeps = settings.time.substeps
        self._stride = self.facts.speed * settings.time.control_step
        self._lead = self.facts.force / self.facts.stiffness

    def place(self, leaders: FloatArray) -> float:
        """Set the object's joints and stop them; the hand's spring is slack."""
        mujoco.mj_resetData(self.model, self.data)
        self.object.place(self.data, leaders)
        mujoco.mj_forward(self.model, self.data)
        if self._control == POSITION:
            self.data.ctrl[:] = self.data.sensordata[:3]
        return deepest_contact(self.data)

    def commanded(self, before: FloatArray, hold: FloatArray, action: FloatArray) -> FloatArray:
        """Return what the actuators are told by an action, shapes (..., 3): forces in shares, or a place [m].

        Args:
            before: What they were told until now.
            hold: Where the part is held [m].
            action: Within -1 and 1.
        """
        if self._control == FORCE:
            return action
        lead = before - hold + self._stride * action
        return np.asarray(hold + np.minimum(np.maximum(lead, -self._lead), self._lead))

    def act(self, action: FloatArray) -> None:
        """Simulate until the next action."""
        self.data.ctrl[:] = self.commanded(self.data.ctrl, self.data.sensordata[:3], action)
        # As rollouts of many environments begin, so that both give the same numbers.
        self.data.qacc_warmstart[:] = 0.0
        mujoco.mj_step(self.model, self.data, nstep=self._substeps)

    def command(self) -> FloatArray:
        """From the hold to where the hand wants it [m], zero in force control, shape (3,)."""
        return np.asarray(self.data.ctrl - self.data.sensordata[:3]) if self._control == POSITION else np.zeros(3)
