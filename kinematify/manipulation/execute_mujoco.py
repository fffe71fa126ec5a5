"""A planned motion in MuJoCo: both models in one world, servos on the arm, a weld or friction at the hand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.manipulation.execute import Execution, Frame, Log, judged
from kinematify.manipulation.grip import grip_piece
from kinematify.manipulation.motion import timed
from kinematify.manipulation.outcome import Hold
from kinematify.robot.joint_type import JointType
from kinematify.robot.mechanism import Mechanism
from kinematify.robot.robot import joint_values, rest_configuration
from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.mujoco_model import parse

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.config.task import ExecutionSettings
    from kinematify.manipulation.execute import Loaded
    from kinematify.manipulation.motion import Reference
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Robot
    from kinematify.simulation.prepared import Prepared

    BoolArray = NDArray[np.bool_]

_ROBOT, _OBJECT = "robot_", "object_"
_HELD, _OTHERS, _GRIP = 1, 2, 4  # bits: the held part, all that is not held, and what lies between the pads
_WELD, _LATCH = "kinematify weld", "kinematify latch"


def execute(loaded: Loaded, settings: ExecutionSettings, *, hold: Hold) -> Execution:
    """Run a planned motion.

    Args:
        loaded: Both models and the motion.
        settings: Servos, forces and tolerances.
        hold: What connects the hand with the part.

    Returns:
        What became of it; a world that MuJoCo refuses or that blows up is no success.
    """
    world = _World(loaded, settings, hold)
    reference = timed(loaded.motion, loaded.fastest(settings), settings, settings.time_step)
    log = Log(frames=[])
    values = world.run(reference, log)
    return judged(loaded, log, values, reference, settings, engine="mujoco", hold=hold)


@dataclass(frozen=True, eq=False)
class _World:
    """One compiled world."""

    loaded: Loaded
    settings: ExecutionSettings
    hold: Hold

    @cached_property
    def model(self) -> mujoco.MjModel:
        spec = self._spec()
        model = spec.compile()
        self._set_servos(model)
        return model

    @cached_property
    def data(self) -> mujoco.MjData:
        data = mujoco.MjData(self.model)
        data.qpos[:] = self._start(self.model)
        mujoco.mj_forward(self.model, data)
        return data

    def run(self, reference: Reference, log: Log) -> FloatArray:
        """Track the reference; returns the value of the object's joint after every step, shape (steps,)."""
        model, data, settings = self.model, self.data, self.settings
        every = max(1, round(1.0 / (settings.frame_rate * settings.time_step)))
        joint = model.joint(_OBJECT + self.loaded.motion.joint).qposadr[0]
        lead = 1.0 / (np.pi * settings.servo_frequency)  # damping over stiffness: commands run ahead of the lag
        told = reference.arm + lead * reference.speed
        values = np.full(reference.steps, np.nan)
        dof = told.shape[1]
        data.ctrl[dof:] = self.loaded.fingers(self.loaded.motion.grasp.spread)
        for step in range(reference.steps):
            if step == reference.grasped and self.hold is Hold.CONTACT:
                data.ctrl[dof:] = self._squeezed()
            if step == reference.pulls:
                self._take_hold()
            data.ctrl[:dof] = told[step]
            mujoco.mj_step(model, data)
            if not np.isfinite(data.qpos).all() or data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number:
                return values
            values[step] = data.qpos[joint]
            log.tracking = max(log.tracking, float(np.abs(data.qpos[self._arm_qpos] - reference.arm[step]).max()))
            self._note_contacts(log)
            if step % every == 0 or step == reference.steps - 1:
                log.frames.append(self._frame(step * settings.time_step))
        return values

    def _spec(self) -> mujoco.MjSpec:
        motion, settings = self.loaded.motion, self.settings
        spec = mujoco.MjSpec()
        spec.option.timestep = settings.time_step
        spec.option.gravity = [0.0, 0.0, -GRAVITY]
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        spec.option.impratio = 10.0
        # MuJoCo 4.0.0 factorises sparse systems wrongly in rare cases; 4.0.1 does not.
        spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        robot, object_spec = (
            self._parsed(self.loaded.robot, self.loaded.robot_prepared),
            self._parsed(self.loaded.object, self.loaded.object_prepared),
        )
        self._set_contacts(robot, object_spec)
        for body in robot.bodies:
            body.gravcomp = 1.0
        for part, prefix, T in ((robot, _ROBOT, motion.T_world_base), (object_spec, _OBJECT, motion.T_world_object)):
            frame = spec.worldbody.add_frame(pos=T[:3, 3], quat=quaternion_of(T[:3, :3]))
            spec.attach(part, prefix=prefix, frame=frame)
        floor = spec.worldbody.add_geom(name="kinematify floor", type=mujoco.mjtGeom.mjGEOM_PLANE)
        floor.size, floor.contype, floor.conaffinity = [0.0, 0.0, 1.0], _OTHERS, 0
        self._add_drives(spec)
        self._add_bonds(spec)
        return spec

    def _parsed(self, model: Robot, prepared: Prepared) -> mujoco.MjSpec:
        spec = parse(prepared.urdf, Mechanism(robot=model), step=self.settings.time_step).spec
        spec.compiler.balanceinertia = True
        return spec

    def _set_contacts(self, robot: mujoco.MjSpec, object_spec: mujoco.MjSpec) -> None:
        """The robot meets the object and the floor; neither meets itself, which the planner has looked at."""
        for geom in robot.geoms:
            geom.contype, geom.conaffinity = 0, _HELD | _OTHERS
            geom.condim, geom.friction = 4, [self.settings.friction, 0.02, 0.0001]
            geom.solref[:2], geom.solimp[:2], geom.priority = [2.0 * self.settings.time_step, 1.0], [0.95, 0.99], 1
            if geom.parent.name in self.loaded.hand_links:
                geom.conaffinity = _OTHERS | _GRIP
        for geom in object_spec.geoms:
            held = geom.parent.name in self.loaded.held_links
            geom.contype, geom.conaffinity = _HELD if held else _OTHERS, 0
        if self.hold is Hold.CONTACT:
            vertices, faces = grip_piece(
                self.loaded.object, self.loaded.held, self._leaders(), self.loaded.motion.grasp, self.settings
            )
            mesh = object_spec.add_mesh(name="kinematify grip", uservert=vertices.ravel(), userface=faces.ravel())
            grip = object_spec.body(self.loaded.held).add_geom(
                type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name, mass=0.0
            )
            grip.contype, grip.conaffinity = _GRIP, 0

    def _leaders(self) -> dict[str, float]:
        """Leading joints of the object at the start [rad or m]."""
        rest = rest_configuration(self.loaded.object)
        start = {**self.loaded.motion.start, self.loaded.motion.joint: float(self.loaded.motion.opened[0])}
        return {joint.name: start.get(joint.name, rest[joint.name]) for joint in self.loaded.object.leaders}

    def _add_drives(self, spec: mujoco.MjSpec) -> None:
        robot = self.loaded.motion.robot
        for name in (*robot.arm_joints, *robot.finger_joints):
            servo = spec.add_actuator(
                name=f"kinematify servo {name}", target=_ROBOT + name, trntype=mujoco.mjtTrn.mjTRN_JOINT
            )
            servo.set_to_position(kp=1.0)

    def _add_bonds(self, spec: mujoco.MjSpec) -> None:
        """Weld the hand to the part, and hold every joint that is not driven where it starts."""
        weld = spec.add_equality(name=_WELD, type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY)
        weld.name1, weld.name2, weld.active = _ROBOT + self.loaded.motion.robot.tool, _OBJECT + self.loaded.held, False
        driven = {*self.loaded.motion.robot.arm_joints, *self.loaded.motion.robot.finger_joints}
        for prefix, model, values in self._sides():
            for joint in model.joints:
                if joint.kind is JointType.FIXED or joint.mimic is not None:
                    continue
                if prefix == _ROBOT and joint.name in driven:
                    continue
                latch = spec.add_equality(type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT)
                latch.name1 = prefix + joint.name
                latch.data[0] = values[joint.name]
                if prefix == _OBJECT and joint.name in self._freed:
                    latch.name = f"{_LATCH} {joint.name}"

    def _sides(self) -> Sequence[tuple[str, Robot, dict[str, float]]]:
        """Prefix, model and values of all joints at the start, of robot and object."""
        loaded, motion = self.loaded, self.loaded.motion
        arm = dict(zip(motion.robot.arm_joints, motion.reach[0].tolist(), strict=True))
        gap = loaded.fingers(motion.grasp.spread)
        hand = dict(zip(motion.robot.finger_joints, gap.tolist(), strict=True))
        robot = {**rest_configuration(loaded.robot), **arm, **hand}
        values = {**rest_configuration(loaded.object), **motion.start, motion.joint: float(motion.opened[0])}
        return (
            (_ROBOT, loaded.robot, {**joint_values(loaded.robot, robot), **hand}),
            (_OBJECT, loaded.object, joint_values(loaded.object, values)),
        )

    def _start(self, model: mujoco.MjModel) -> FloatArray:
        qpos = np.array(model.qpos0)
        for prefix, _, values in self._sides():
            for name, value in values.items():
                index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, prefix + name)
                if index >= 0:
                    qpos[model.jnt_qposadr[index]] = value
        return qpos

    def _set_servos(self, model: mujoco.MjModel) -> None:
        """Servos of one frequency for the arm, as strong as the arm; fingers as strong as the grip."""
        settings, arm = self.settings, self.loaded.motion.robot.arm_joints
        inertia = self._inertia(model)
        model.dof_armature[self._dofs(model, _ROBOT)] += settings.armature * inertia[self._dofs(model, _ROBOT)]
        for name in self.loaded.motion.robot.finger_joints:
            finger = int(model.joint(_ROBOT + name).dofadr[0])
            model.dof_armature[finger] = settings.finger_inertia
            inertia[finger] = settings.finger_inertia
        joint = model.joint(_OBJECT + self.loaded.motion.joint)
        dof = int(joint.dofadr[0])
        model.dof_damping[dof] = max(model.dof_damping[dof], settings.joint_damping * inertia[dof])
        rate = 2.0 * np.pi * settings.servo_frequency
        force = np.full(model.nu, settings.grip_force)
        force[: len(arm)] = self.loaded.strongest(settings)
        for servo in range(model.nu):
            moved = (1.0 + settings.armature) * inertia[model.jnt_dofadr[model.actuator_trnid[servo, 0]]]
            stiffness = moved * rate**2
            if servo >= len(arm):  # fingers squeeze with their full force where the part keeps them a millimetre off
                stiffness = max(stiffness, 1e3 * settings.grip_force)
            damping = 2.0 * stiffness / rate
            model.actuator_gainprm[servo, 0] = stiffness
            model.actuator_biasprm[servo, 1:3] = -stiffness, -damping
        model.actuator_forcelimited[:] = 1
        model.actuator_forcerange[:] = force[:, None] * [-1.0, 1.0]
        model.jnt_actfrclimited[:] = 0

    def _inertia(self, model: mujoco.MjModel) -> FloatArray:
        """Inertia that each degree of freedom moves, the largest along the motion, shape (nv,)."""
        data = mujoco.MjData(model)
        data.qpos[:] = self._start(model)
        largest = np.zeros(model.nv)
        matrix = np.zeros((model.nv, model.nv))
        motion = self.loaded.motion
        for row in (motion.reach[0], motion.pull[0], motion.pull[-1]):
            data.qpos[[int(model.joint(_ROBOT + name).qposadr[0]) for name in motion.robot.arm_joints]] = row
            mujoco.mj_forward(model, data)
            mujoco.mj_fullM(model, data, matrix)
            largest = np.maximum(largest, np.diag(matrix))
        return largest

    def _dofs(self, model: mujoco.MjModel, prefix: str) -> IntArray:
        names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, k) or "" for k in range(model.njnt)]
        return np.array(
            [model.jnt_dofadr[k] for k, name in enumerate(names) if name.startswith(prefix)], dtype=np.int64
        )

    @property
    def _freed(self) -> tuple[str, ...]:
        return (self.loaded.motion.joint, *self.loaded.motion.freed)

    @cached_property
    def _arm_qpos(self) -> IntArray:
        names = self.loaded.motion.robot.arm_joints
        return np.array([int(self.model.joint(_ROBOT + name).qposadr[0]) for name in names], dtype=np.int64)

    def _squeezed(self) -> FloatArray:
        """Commands of the fingers a centimetre inside of what they hold, so that they press with their full force."""
        grasp = self.loaded.motion.grasp
        closed, opened = self.loaded.fingers(0.0), self.loaded.fingers(grasp.spread)
        gap = max(grasp.spread, 1e-6)
        return np.asarray(opened + (closed - opened) * (gap - grasp.width + 0.02) / gap)

    def _take_hold(self) -> None:
        """Let the joint go, and weld the hand to the part where it now is."""
        model, data = self.model, self.data
        for name in self._freed:
            data.eq_active[model.equality(f"{_LATCH} {name}").id] = 0
        if self.hold is not Hold.WELD:
            return
        weld = model.equality(_WELD).id
        tool, held = (data.body(name) for name in (_ROBOT + self.loaded.motion.robot.tool, _OBJECT + self.loaded.held))
        first, second = tool.xmat.reshape(3, 3), held.xmat.reshape(3, 3)
        # The anchor, which is the tool's origin, in the frame of the part and in that of the tool.
        model.eq_data[weld, :3] = second.T @ (tool.xpos - held.xpos)
        model.eq_data[weld, 3:6] = 0.0
        model.eq_data[weld, 6:10] = quaternion_of(first.T @ second)
        model.eq_data[weld, 10] = 1.0
        data.eq_active[weld] = 1

    def _note_contacts(self, log: Log) -> None:
        count = self.data.ncon
        if not count:
            return
        geoms = self.data.contact.geom[:count]
        depths = np.where(self._gripped[geoms].all(axis=1), 0.0, -self.data.contact.dist[:count])
        deepest = int(depths.argmax())
        if depths[deepest] > log.depth:
            bodies = (self.model.body(self.model.geom_bodyid[geom]).name for geom in geoms[deepest])
            link, other = sorted(bodies, key=lambda name: not name.startswith(_ROBOT))
            other = "the floor" if other == "world" else other.removeprefix(_OBJECT)
            log.touch(link.removeprefix(_ROBOT), other, float(depths[deepest]))

    @cached_property
    def _gripped(self) -> BoolArray:
        """Which shapes belong to the hand or to what it holds, shape (geoms,)."""
        names = {_ROBOT + link for link in self.loaded.hand_links} | {_OBJECT + link for link in self.loaded.held_links}
        return np.array([self.model.body(body).name in names for body in self.model.geom_bodyid])

    def _frame(self, time: float) -> Frame:
        states: list[dict[str, float]] = []
        for prefix, model, _ in self._sides():
            names = [joint.name for joint in model.joints if joint.kind is not JointType.FIXED]
            states.append({name: float(self.data.joint(prefix + name).qpos[0]) for name in names})
        return Frame(time=time, robot=states[0], object=states[1])
