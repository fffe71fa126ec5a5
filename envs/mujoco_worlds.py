"""OpenPart and DrawerPull in MuJoCo: a hand that pulls at one point of the part, or a robot that servos move.

Contacts and friction do the rest. A world is compiled once for a process; environments have copies of it.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.envs.articulated_object import held_links
from kinematify.envs.mujoco_object import (
    HOLD,
    PREFIX,
    WORLD,
    MujocoObject,
    MujocoWorld,
    add_object,
    deepest_contact,
    env_spec,
    parsed,
    poses_of,
)
from kinematify.envs.settings import load_settings
from kinematify.simulation.mujoco_model import (
    add_latch,
    add_servos,
    attach,
    hold_by_friction,
    joint_ids,
    largest_inertia,
    make_rubber,
    set_robot_servos,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.dynamics import JointDynamics
    from kinematify.envs.robot_plan import EnvRobot, RobotPlan
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
    """One object and a hand without a robot."""

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


ROBOT = "robot "
"""Before the names of the robot's links and joints."""
_OBJECT_BIT, _ROBOT_BIT = 1, 2
_NET_FORCE = 3  # MuJoCo's reduction of contacts to the sum of their forces
_FILTER_SHARE = 0.6  # of the time between actions: servos are told of a new target smoothly


@dataclass(frozen=True, kw_only=True, eq=False)
class ArmFacts:
    """A compiled world; worlds are copies of it."""

    model: mujoco.MjModel
    source: ParsedModel
    dynamics: JointDynamics


@lru_cache(maxsize=8)
def arm_facts(articulated_object: ArticulatedObject, target: Target, robot: EnvRobot, plan: RobotPlan) -> ArmFacts:
    """Compile the world, once per process."""
    settings = load_settings()
    spec = env_spec(settings)
    hold_by_friction(spec)
    source = parsed(articulated_object.loaded, articulated_object.scene, settings)
    add_object(spec, articulated_object, target, source, plan.T_world_object)
    _add_robot(spec, robot, plan, settings)
    floor = spec.worldbody.add_geom(name="kinematify floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0.0, 0.0, 1.0])
    floor.contype, floor.conaffinity = 0, _ROBOT_BIT
    _add_drives(spec, robot, settings)
    _add_touch(spec, robot, held_links(articulated_object, target))
    model = spec.compile()
    dynamics = MujocoObject(model, articulated_object, target, source).set_up(settings)
    _set_servos(model, robot, plan, settings)
    return ArmFacts(model=model, source=source, dynamics=dynamics)


def _add_robot(spec: mujoco.MjSpec, robot: EnvRobot, plan: RobotPlan, settings: EnvSettings) -> None:
    """Attach the robot; it meets itself, the object and the floor, with rubber on all of its surfaces."""
    part = parsed(robot.loaded, robot.scene, settings).spec.copy()
    make_rubber(part, settings.robot.friction, settings.time.step)
    for geom in part.geoms:
        geom.contype, geom.conaffinity = _ROBOT_BIT, _OBJECT_BIT | _ROBOT_BIT
    for geom in spec.geoms:
        geom.conaffinity = _OBJECT_BIT | _ROBOT_BIT
    attach(spec, part, ROBOT, plan.T_world_base)


def _add_drives(spec: mujoco.MjSpec, robot: EnvRobot, settings: EnvSettings) -> None:
    driven = (*robot.robot.arm_joints, *robot.robot.finger_joints)
    add_servos(spec, [ROBOT + name for name in driven], timeconst=_FILTER_SHARE * settings.time.control_step)
    for travel in robot.mechanism.travels:
        if travel.joint not in driven:
            add_latch(spec, ROBOT + travel.joint, travel.rest)


def _add_touch(spec: mujoco.MjSpec, robot: EnvRobot, held: tuple[str, ...]) -> None:
    """Force of each finger on each link of the part."""
    for link, other in product(robot.finger_links, held):
        spec.add_sensor(
            type=mujoco.mjtSensor.mjSENS_CONTACT,
            objtype=mujoco.mjtObj.mjOBJ_BODY,
            objname=ROBOT + link,
            reftype=mujoco.mjtObj.mjOBJ_BODY,
            refname=PREFIX + other,
            intprm=[1 << mujoco.mjtConDataField.mjCONDATA_FORCE.value, _NET_FORCE, 1],
        )


def _set_servos(model: mujoco.MjModel, robot: EnvRobot, plan: RobotPlan, settings: EnvSettings) -> None:
    """Servos of one frequency, as strong as the file says; fingers as strong as the grip."""
    arm, fingers = (joint_ids(model, ROBOT, names) for names in (robot.robot.arm_joints, robot.robot.finger_joints))
    rows = (plan.reach[0], plan.pull[0], plan.pull[-1])
    inertia = largest_inertia(model, model.qpos0, model.jnt_qposadr[arm], rows)
    dof, strongest = model.jnt_dofadr, robot.strongest
    set_robot_servos(model, dof[arm], dof[fingers], inertia=inertia, strongest=strongest, settings=settings.robot)


class MujocoArm(MujocoWorld):
    """One object and a robot."""

    def __init__(
        self,
        articulated_object: ArticulatedObject,
        target: Target,
        robot: EnvRobot,
        plan: RobotPlan,
        settings: EnvSettings,
    ) -> None:
        """Copy the compiled world, so that it can be redrawn."""
        facts = arm_facts(articulated_object, target, robot, plan)
        self.model = copy(facts.model)
        self.data = mujoco.MjData(self.model)
        self.object = MujocoObject(self.model, articulated_object, target, facts.source)
        self.object.keep()
        self._articulated_object, self._robot, self._substeps = articulated_object, robot, settings.time.substeps
        names = robot.robot
        joints = [self.model.joint(ROBOT + name).id for name in (*names.arm_joints, *names.finger_joints)]
        self._dof = len(names.arm_joints)
        self._qpos, self._qvel = self.model.jnt_qposadr[joints], self.model.jnt_dofadr[joints]
        self._bodies = np.array([self.model.body(ROBOT + name).id for name in self._links], dtype=np.int64)
        self._tool = int(self.model.body(ROBOT + names.tool).id)

    @property
    def _links(self) -> tuple[str, ...]:
        return self._robot.mechanism.links

    def place(self, leaders: FloatArray, arm: FloatArray) -> float:
        """Set the object's joints and those of the arm, fingers apart, and stop all."""
        mujoco.mj_resetData(self.model, self.data)
        self.object.place(self.data, leaders)
        commands = np.concatenate([arm, self._robot.finger_values(1.0)])
        self.data.qpos[self._qpos] = commands
        self.data.ctrl[:] = self.data.act[:] = commands
        mujoco.mj_forward(self.model, self.data)
        return deepest_contact(self.data)

    def act(self, arm: FloatArray, fingers: FloatArray) -> None:
        """Simulate until the next action, servos told to go to these values."""
        self.data.ctrl[: self._dof], self.data.ctrl[self._dof :] = arm, fingers
        mujoco.mj_step(self.model, self.data, nstep=self._substeps)

    def joints(self) -> tuple[FloatArray, FloatArray]:
        """Values and speeds of the arm's joints and then of the fingers'."""
        return self.data.qpos[self._qpos], self.data.qvel[self._qvel]

    def tool(self) -> FloatArray:
        """Pose of the tool, shape (4, 4)."""
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = self.data.xmat[self._tool].reshape(3, 3), self.data.xpos[self._tool]
        return T

    def touch(self) -> FloatArray:
        """Force of each finger on the part [N], shape (fingers,)."""
        forces = self.data.sensordata[9:].reshape(len(self._robot.finger_links), -1, 3).sum(axis=1)
        return np.asarray(np.sqrt(np.vecdot(forces, forces)))

    def stable(self) -> bool:
        """True if all numbers are finite and the solver has not failed."""
        return bool(np.isfinite(self.data.qpos).all() and np.isfinite(self.data.qvel).all())

    def link_poses(self) -> Mapping[str, FloatArray]:
        """World poses of the links of object and robot."""
        return {**super().link_poses(), **poses_of(self.data, self._bodies, self._links, ROBOT)}
