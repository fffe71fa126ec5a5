"""DrawerPull in MuJoCo: robot, object and floor in one world; servos move the robot, contacts and friction the rest."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.config.validation import load_settings as load_limits
from kinematify.envs.articulated_object import held_links
from kinematify.envs.mujoco_hand import link_poses
from kinematify.envs.mujoco_object import (
    PREFIX,
    MujocoObject,
    ObjectSource,
    add_object,
    deepest_contact,
    object_source,
    reported_warnings,
    settled_source,
    world_spec,
)
from kinematify.envs.settings import load_settings

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.dynamics import Draw, JointDynamics
    from kinematify.envs.reading import Reading
    from kinematify.envs.robot_plan import EnvRobot, RobotPlan
    from kinematify.envs.settings import EnvSettings
    from kinematify.robot.arrays import FloatArray

ROBOT = "robot "
"""Before the names of the robot's links and joints."""
_OBJECT_BIT, _ROBOT_BIT = 1, 2
_NET_FORCE = 3  # MuJoCo's reduction of contacts to the sum of their forces
_FILTER_SHARE = 0.6  # of the time between actions: servos are told of a new target smoothly
_SQUEEZE = 1e3  # stiffness of fingers over their force [1/m]: a millimetre inside of what they hold they press fully


@dataclass(frozen=True, kw_only=True, eq=False)
class ArmFacts:
    """A compiled world; worlds are copies of it."""

    model: mujoco.MjModel
    source: ObjectSource
    dynamics: JointDynamics


@lru_cache(maxsize=8)
def arm_facts(articulated_object: ArticulatedObject, target: Target, robot: EnvRobot, plan: RobotPlan) -> ArmFacts:
    """Compile the world, once per process."""
    settings = load_settings()
    spec = world_spec(settings)
    spec.option.cone, spec.option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0
    source = object_source(articulated_object, settings)
    add_object(spec, articulated_object, target, source, plan.T_world_object)
    _add_robot(spec, articulated_object, robot, plan, settings)
    floor = spec.worldbody.add_geom(name="kinematify floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0.0, 0.0, 1.0])
    floor.contype, floor.conaffinity = 0, _ROBOT_BIT
    _add_drives(spec, robot, settings)
    _add_touch(spec, robot, held_links(articulated_object, target))
    model = spec.compile()
    dynamics = MujocoObject(model, articulated_object, target, source).set_up(settings)
    _set_servos(model, robot, plan, settings)
    return ArmFacts(model=model, source=source, dynamics=dynamics)


def _add_robot(
    spec: mujoco.MjSpec, articulated_object: ArticulatedObject, robot: EnvRobot, plan: RobotPlan, settings: EnvSettings
) -> None:
    """Attach the robot; it meets itself, the object and the floor, with rubber on all of its surfaces."""
    tolerance = load_limits().engines.contact_depth * articulated_object.scene.size
    part = settled_source(robot.prepared, robot.mechanism, 1.0, settings).source.spec.copy()
    for geom in part.geoms:
        geom.contype, geom.conaffinity = _ROBOT_BIT, _OBJECT_BIT | _ROBOT_BIT
        geom.condim, geom.friction = 4, [settings.robot.friction, 0.02, 0.0001]
        geom.solref[:2], geom.solimp[:2], geom.priority = [2.0 * settings.time.step, 1.0], [0.95, 0.99], 1
        # Margins of both sides add up: robot and object act on each other from the first touch.
        geom.margin, geom.gap = 0.5 * tolerance, -0.5 * tolerance
    for body in part.bodies:
        body.gravcomp = 1.0
    for geom in spec.geoms:
        geom.conaffinity = _OBJECT_BIT | _ROBOT_BIT
    T, turn = plan.T_world_base, np.zeros(4)
    mujoco.mju_mat2Quat(turn, np.ascontiguousarray(T[:3, :3]).ravel())
    spec.attach(part, prefix=ROBOT, frame=spec.worldbody.add_frame(pos=T[:3, 3], quat=turn))


def _add_drives(spec: mujoco.MjSpec, robot: EnvRobot, settings: EnvSettings) -> None:
    for name in (*robot.robot.arm_joints, *robot.robot.finger_joints):
        servo = spec.add_actuator(
            name=f"kinematify servo {name}", target=ROBOT + name, trntype=mujoco.mjtTrn.mjTRN_JOINT
        )
        servo.set_to_position(kp=1.0, timeconst=_FILTER_SHARE * settings.time.control_step)
    driven = {*robot.robot.arm_joints, *robot.robot.finger_joints}
    for travel in robot.mechanism.travels:
        if travel.joint not in driven:
            latch = spec.add_equality(type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT)
            latch.name1 = ROBOT + travel.joint
            latch.data[0] = travel.rest


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
    values, names = settings.robot, robot.robot
    arm = [int(model.joint(ROBOT + name).id) for name in names.arm_joints]
    fingers = [int(model.joint(ROBOT + name).id) for name in names.finger_joints]
    dof = model.jnt_dofadr
    inertia = _largest_inertia(model, model.jnt_qposadr[arm], plan)[dof[arm]]
    model.dof_armature[dof[arm]] += values.armature * inertia
    model.dof_armature[dof[fingers]] = values.finger_inertia
    rate = 2.0 * np.pi * values.servo_frequency
    moved = np.concatenate([(1.0 + values.armature) * inertia, np.full(len(fingers), values.finger_inertia)])
    stiffness = moved * rate**2
    stiffness[len(arm) :] = np.maximum(stiffness[len(arm) :], _SQUEEZE * values.grip_force)
    model.actuator_gainprm[:, 0], model.actuator_biasprm[:, 1] = stiffness, -stiffness
    model.actuator_biasprm[:, 2] = -2.0 * stiffness / rate
    model.actuator_forcelimited[:] = 1
    forces = np.concatenate([robot.strongest, np.full(len(fingers), values.grip_force)])
    model.actuator_forcerange[:] = forces[:, None] * [-1.0, 1.0]


def _largest_inertia(model: mujoco.MjModel, addresses: FloatArray, plan: RobotPlan) -> FloatArray:
    """Inertia that each degree of freedom moves, the largest along the plan, shape (nv,)."""
    data, matrix, largest = mujoco.MjData(model), np.zeros((model.nv, model.nv)), np.zeros(model.nv)
    for row in (plan.reach[0], plan.pull[0], plan.pull[-1]):
        data.qpos[addresses] = row
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, matrix)
        largest = np.maximum(largest, np.diag(matrix))
    return largest


class MujocoArm:
    """One world; see `kinematify.envs.worlds.ArmWorld`."""

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

    def draw(self, drawn: Draw) -> None:
        """Redraw the object."""
        self.object.apply(drawn, self.data)

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

    def reading(self) -> Reading:
        """Return the state of the object."""
        return self.object.reading(self.data)

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

    def depth(self) -> float:
        """How much deeper than allowed two shapes are in each other at most [m]."""
        return deepest_contact(self.data)

    def stable(self) -> bool:
        """True if all numbers are finite and the solver has not failed."""
        return bool(np.isfinite(self.data.qpos).all() and np.isfinite(self.data.qvel).all())

    def warnings(self) -> dict[str, int]:
        """MuJoCo's warnings since `place`, with counts."""
        return reported_warnings(self.data)

    def link_poses(self) -> Mapping[str, FloatArray]:
        """World poses of the links of object and robot."""
        articulated_object = link_poses(self.data, self.object.body, self._articulated_object.scene.mechanism.links, "")
        return {**articulated_object, **link_poses(self.data, self._bodies, self._links, ROBOT)}

    def close(self) -> None:
        """Nothing is held that Python does not free."""
