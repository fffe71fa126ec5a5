"""Worlds of MuJoCo in which a robot that servos move meets an object, as environments and executions of plans need."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import mujoco
import numpy as np

from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.mujoco_model import set_options

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from kinematify.robot.arrays import FloatArray, IntArray

_SQUEEZE = 1e3
"""Stiffness of fingers over their force [1/m]: a millimetre inside of what they hold they press fully."""


class ServoSettings(Protocol):
    """How a robot is moved."""

    servo_frequency: float
    """Of the arm's servos [Hz]; they are critically damped."""
    armature: float
    """Rotor inertia, fraction of the inertia that a joint moves."""
    finger_inertia: float
    """Of each finger with its drive [kg or kg m^2]."""
    grip_force: float
    """Of each finger [N]."""


def world_spec(step: float) -> mujoco.MjSpec:
    """An empty world with a time step [s] and the options of all that Kinematify simulates."""
    spec = mujoco.MjSpec()
    set_options(spec, step)
    spec.compiler.balanceinertia = True
    return spec


def attach(spec: mujoco.MjSpec, part: mujoco.MjSpec, prefix: str, T_world_root: FloatArray) -> None:
    """Add a model, its names behind a prefix."""
    frame = spec.worldbody.add_frame(pos=T_world_root[:3, 3], quat=quaternion_of(T_world_root[:3, :3]))
    spec.attach(part, prefix=prefix, frame=frame)


def make_rubber(robot: mujoco.MjSpec, friction: float, step: float) -> None:
    """Give all surfaces of a robot friction that holds, whatever they touch, and carry its weight."""
    for geom in robot.geoms:
        geom.condim, geom.friction = 4, [friction, 0.02, 0.0001]
        geom.solref[:2], geom.solimp[:2], geom.priority = [2.0 * step, 1.0], [0.95, 0.99], 1
    for body in robot.bodies:
        body.gravcomp = 1.0


def hold_by_friction(spec: mujoco.MjSpec) -> None:
    """Let friction hold without creeping: elliptic cones, and stiffer along surfaces than into them."""
    spec.option.cone, spec.option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0


def add_servos(spec: mujoco.MjSpec, joints: Iterable[str], *, timeconst: float | None = None) -> None:
    """Add position servos; their gains are set after compiling (`set_robot_servos`).

    Args:
        spec: The world.
        joints: Names with their prefix.
        timeconst: By which commands are smoothed [s]; None: not at all.
    """
    for joint in joints:
        servo = spec.add_actuator(name=f"kinematify servo {joint}", target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        if timeconst is None:
            servo.set_to_position(kp=1.0)
        else:
            servo.set_to_position(kp=1.0, timeconst=timeconst)


def add_latch(spec: mujoco.MjSpec, joint: str, value: float, name: str = "") -> None:
    """Hold a joint at a value [rad or m]."""
    latch = spec.add_equality(type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT)
    latch.name1, latch.data[0] = joint, value
    if name:
        latch.name = name


def joint_ids(model: mujoco.MjModel, prefix: str, names: Sequence[str]) -> IntArray:
    """Indices of joints, shape (names,)."""
    return np.array([int(model.joint(prefix + name).id) for name in names], dtype=np.int64)


def largest_inertia(
    model: mujoco.MjModel, start: FloatArray, addresses: IntArray, rows: Iterable[FloatArray]
) -> FloatArray:
    """Inertia that each degree of freedom moves, the largest of some configurations [kg m^2 or kg], shape (nv,).

    Args:
        model: The world.
        start: All positions, shape (nq,).
        addresses: Of those that change.
        rows: Their values.
    """
    data, matrix, largest = mujoco.MjData(model), np.zeros((model.nv, model.nv)), np.zeros(model.nv)
    data.qpos[:] = start
    for row in rows:
        data.qpos[addresses] = row
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, matrix)
        largest = np.maximum(largest, np.diag(matrix))
    return largest


def set_robot_servos(
    model: mujoco.MjModel,
    arm: IntArray,
    fingers: IntArray,
    *,
    inertia: FloatArray,
    strongest: FloatArray,
    settings: ServoSettings,
) -> None:
    """Set servos of one frequency for the arm, as strong as the arm, and for fingers as strong as the grip.

    Args:
        model: The world; its actuators are those of the arm and then of the fingers.
        arm: Degrees of freedom of the arm.
        fingers: Of the fingers.
        inertia: That each degree of freedom moves, shape (nv,).
        strongest: Effort limits of the arm [N m or N], shape (arm,).
        settings: Frequency, rotor inertia and grip.
    """
    model.dof_armature[arm] += settings.armature * inertia[arm]
    model.dof_armature[fingers] = settings.finger_inertia
    rate = 2.0 * np.pi * settings.servo_frequency
    moved = np.concatenate([(1.0 + settings.armature) * inertia[arm], np.full(len(fingers), settings.finger_inertia)])
    stiffness = moved * rate**2
    stiffness[len(arm) :] = np.maximum(stiffness[len(arm) :], _SQUEEZE * settings.grip_force)
    model.actuator_gainprm[:, 0], model.actuator_biasprm[:, 1] = stiffness, -stiffness
    model.actuator_biasprm[:, 2] = -2.0 * stiffness / rate
    forces = np.concatenate([strongest, np.full(len(fingers), settings.grip_force)])
    model.actuator_forcelimited[:] = 1
    model.actuator_forcerange[:] = forces[:, None] * [-1.0, 1.0]
    model.jnt_actfrclimited[:] = 0
