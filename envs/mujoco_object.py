"""The object in MuJoCo: contacts that count, the hand's point, sensors, and dynamics that can be redrawn."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.envs.dynamics import Loads, full_force, joint_dynamics
from kinematify.envs.goal import ObjectState
from kinematify.geometry.rest import overlapping_links
from kinematify.simulation.mujoco_model import parse, world_spec

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.dynamics import Draw, JointDynamics
    from kinematify.envs.settings import EnvSettings
    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.simulation.mujoco_model import ParsedModel

PREFIX = "object "
"""Before the names of the object's links, joints and shapes."""
HOLD, AXIS, WORLD = "kinematify hold", "kinematify axis", "kinematify world"
_WAY_SAMPLES = 9
_WARNINGS = {
    kind.value: name.removeprefix("mjWARN_").lower()
    for name, kind in mujoco.mjtWarning.__members__.items()
    if name.startswith("mjWARN_")
}
_STIFF = 0.999  # share of its creep that friction takes away


def parsed(urdf: Path, scene: Scene, settings: EnvSettings) -> ParsedModel:
    """Parse a file; what is in each other at rest does not collide, everything else does."""
    source = parse(urdf, scene.mechanism, step=settings.time.step)
    source.spec.compiler.balanceinertia = True
    names = dict(zip(scene.mechanism.links, source.names, strict=True))
    for first, second in overlapping_links(scene):
        source.spec.add_exclude(bodyname1=names[first], bodyname2=names[second])
    return source


def env_spec(settings: EnvSettings) -> mujoco.MjSpec:
    """An empty world with the options of all environments."""
    spec = world_spec(settings.time.step)
    # What blows up is told, not silently set back to the start.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_FILTERPARENT.value
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET.value
    spec.worldbody.add_site(name=WORLD)
    return spec


def add_object(
    spec: mujoco.MjSpec,
    articulated_object: ArticulatedObject,
    target: Target,
    found: ParsedModel,
    T_world_root: FloatArray,
) -> None:
    """Attach the object, mark the hold and the joint that is opened, and add their sensors."""
    part = found.spec.copy()
    part.compiler.balanceinertia = True
    spec.attach(part, prefix=PREFIX, frame=spec.worldbody.add_frame(pos=T_world_root[:3, 3]))
    names = dict(zip(articulated_object.scene.mechanism.links, found.names, strict=True))
    body = spec.body(PREFIX + names[target.link])
    body.add_site(name=HOLD, pos=target.point)
    axis = articulated_object.declared.joint_by_name[target.joint].axis
    body.add_site(name=AXIS, quat=_quaternion_to(axis))
    for kind, site in (
        (mujoco.mjtSensor.mjSENS_FRAMEPOS, HOLD),
        (mujoco.mjtSensor.mjSENS_FRAMEPOS, AXIS),
        (mujoco.mjtSensor.mjSENS_FRAMEZAXIS, AXIS),
    ):
        spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=site)


def _quaternion_to(axis: FloatArray) -> FloatArray:
    """Turn that takes z to an axis, w x y z."""
    found = np.zeros(4)
    mujoco.mju_quatZ2Vec(found, np.asarray(axis, dtype=np.float64))
    return found


class MujocoObject:
    """Where the object stands in a compiled world, and its dynamics; redrawn in place."""

    def __init__(
        self, model: mujoco.MjModel, articulated_object: ArticulatedObject, target: Target, found: ParsedModel
    ) -> None:
        """Look up names; `model` is changed by `set_up` and `apply`."""
        self.model, self.articulated_object, self.target = model, articulated_object, target
        mechanism = articulated_object.scene.mechanism
        self.joints: IntArray = np.array([model.joint(PREFIX + name).id for name in mechanism.joints], dtype=np.int64)
        self.qpos: IntArray = np.asarray(model.jnt_qposadr[self.joints], dtype=np.int64)
        self.dof: IntArray = np.asarray(model.jnt_dofadr[self.joints], dtype=np.int64)
        self.body: IntArray = np.array([int(model.body(PREFIX + name).id) for name in found.names], dtype=np.int64)
        names = list(mechanism.joints)
        self._leaders = np.array([names.index(joint) for joint in articulated_object.joints], dtype=np.int64)
        self.leader_qpos, self.leader_dof = self.qpos[self._leaders], self.dof[self._leaders]
        self._root = int(self.body[mechanism.links.index(mechanism.robot.root)])
        self._geoms = np.flatnonzero(np.isin(model.geom_bodyid, self.body))

    def set_up(self, settings: EnvSettings) -> JointDynamics:
        """Give the joints their damping and friction, and keep them as what factors refer to."""
        inertia, gravity = self._loads(self.articulated_object.scene.mechanism.rest)
        found = joint_dynamics(self.articulated_object, Loads(inertia=inertia, gravity=gravity), settings.object)
        self.model.dof_damping[self.dof], self.model.dof_frictionloss[self.dof] = found.damping, found.friction
        # As it is, MuJoCo's friction creeps: a light handle would sink by 7 deg in a second.
        # And its ends of ranges give: a hand that presses a lid shut would push it in by 20 deg.
        self.model.dof_solimp[self.dof, :2], self.model.dof_solref[self.dof, 0] = _STIFF, 2.0 * settings.time.step
        self.model.jnt_solimp[self.joints, :2], self.model.jnt_solref[self.joints, 0] = _STIFF, 2.0 * settings.time.step
        self.model.jnt_actfrclimited[:] = 0
        self.keep()
        return found

    def keep(self) -> None:
        """Remember the model as it is now."""
        model = self.model
        self._damping, self._friction = model.dof_damping[self.dof].copy(), model.dof_frictionloss[self.dof].copy()
        self._mass, self._moments = model.body_mass[self.body].copy(), model.body_inertia[self.body].copy()
        self._surface = model.geom_friction[self._geoms].copy()
        self._place, self._turn = model.body_pos[self._root].copy(), model.body_quat[self._root].copy()
        self._masses_drawn = False

    def force(self, dynamics: JointDynamics, settings: EnvSettings) -> float:
        """Full force of a hand [N] (`full_force`)."""
        mechanism, k = self.articulated_object.scene.mechanism, self.target.leader
        rows = np.tile(mechanism.rest, (_WAY_SAMPLES, 1))
        rows[:, k] = np.linspace(self.target.closed, self.target.opened, _WAY_SAMPLES)
        loads, leads = [self._moved(row) for row in rows], mechanism.leads_at(mechanism.rest)[:, k]
        return full_force(
            self.target,
            settings.hand,
            inertia=np.array([inertia for inertia, _ in loads]),
            gravity=np.array([gravity for _, gravity in loads]),
            damping=float(leads**2 @ dynamics.damping),
            friction=float(np.abs(leads) @ dynamics.friction),
        )

    def inertia(self) -> float:
        """Largest inertia that the joint moves, at both ends [kg m^2 or kg]."""
        rows = np.tile(self.articulated_object.scene.mechanism.rest, (2, 1))
        rows[:, self.target.leader] = self.target.closed, self.target.opened
        return max(self._moved(row)[0] for row in rows)

    def _moved(self, leaders: FloatArray) -> tuple[float, float]:
        """Inertia and holding torque of the joint that is opened and of all that follow it."""
        matrix, bias = self._dynamics_at(leaders)
        leads = self.articulated_object.scene.mechanism.leads_at(leaders)[:, self.target.leader]
        return float(leads @ matrix @ leads), float(leads @ bias)

    def _loads(self, leaders: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Inertia and holding torque of every joint at a configuration of the leaders, shape (J,) each."""
        matrix, bias = self._dynamics_at(leaders)
        return np.diag(matrix).copy(), bias

    def _dynamics_at(self, leaders: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mass matrix (J, J) and holding torques (J,) of all joints at a configuration of the leaders."""
        model, data = self.model, mujoco.MjData(self.model)
        data.qpos[self.qpos] = self.articulated_object.scene.mechanism.all_values(leaders[None])[0]
        mujoco.mj_forward(model, data)
        matrix = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, matrix)
        return matrix[np.ix_(self.dof, self.dof)], data.qfrc_bias[self.dof].copy()

    def apply(self, drawn: Draw, data: mujoco.MjData) -> None:
        """Redraw the object (`kinematify.envs.dynamics.draw`)."""
        model = self.model
        model.dof_damping[self.dof] = drawn.damping * self._damping
        model.dof_frictionloss[self.dof] = drawn.friction * self._friction
        model.geom_friction[self._geoms] = drawn.surface * self._surface
        T = drawn.T_root
        model.body_pos[self._root] = T[:3, :3] @ self._place + T[:3, 3]
        turn = np.zeros(4)
        mujoco.mju_mat2Quat(turn, T[:3, :3].ravel())
        mujoco.mju_mulQuat(model.body_quat[self._root], turn, self._turn)
        drawn_masses = bool((drawn.mass != 1.0).any())
        if drawn_masses or self._masses_drawn:
            model.body_mass[self.body] = drawn.mass * self._mass
            model.body_inertia[self.body] = drawn.mass[:, None] * self._moments
            mujoco.mj_setConst(model, data)
        self._masses_drawn = drawn_masses

    def place(self, data: mujoco.MjData, leaders: FloatArray) -> None:
        """Set the joints, followers included, and stop them."""
        data.qpos[self.qpos] = self.articulated_object.scene.mechanism.all_values(leaders[None])[0]
        data.qvel[self.dof] = 0.0

    def reading(self, data: mujoco.MjData) -> ObjectState:
        """Return the state after the last step."""
        return self.split(data.qpos, data.qvel, data.sensordata)

    def split(self, qpos: FloatArray, qvel: FloatArray, sensors: FloatArray) -> ObjectState:
        """The same for states in rows, shapes (..., nq), (..., nv), (..., sensors)."""
        return ObjectState(
            values=qpos[..., self.leader_qpos],
            speeds=qvel[..., self.leader_dof],
            hold=sensors[..., 0:3],
            anchor=sensors[..., 3:6],
            axis=sensors[..., 6:9],
        )


def deepest_contact(data: mujoco.MjData) -> float:
    """How much deeper than allowed two shapes are in each other at most [m], 0 without contact."""
    if not data.ncon:
        return 0.0
    contact = data.contact
    return max(0.0, float((contact.includemargin - contact.dist).max()))


def reported_warnings(data: mujoco.MjData) -> dict[str, int]:
    """What MuJoCo's solver has warned of since the last reset, by its own names."""
    numbers = data.warning.number
    if not numbers.any():
        return {}
    return {_WARNINGS[k]: int(number) for k, number in enumerate(numbers) if number}


class MujocoWorld:
    """What every world of an object tells; the other engine tells the same."""

    model: mujoco.MjModel
    data: mujoco.MjData
    object: MujocoObject

    def draw(self, drawn: Draw) -> None:
        """Redraw the object."""
        self.object.apply(drawn, self.data)

    def reading(self) -> ObjectState:
        """Return the state of the object."""
        return self.object.reading(self.data)

    def depth(self) -> float:
        """How much deeper than allowed two shapes are in each other at most [m]."""
        return deepest_contact(self.data)

    def stable(self) -> bool:
        """True if all numbers are finite and the solver has not failed."""
        # What is wrong with a place was wrong with a speed before.
        return math.isfinite(self.data.qvel.sum())

    def warnings(self) -> dict[str, int]:
        """MuJoCo's warnings since `place`, with counts."""
        return reported_warnings(self.data)

    def link_poses(self) -> Mapping[str, FloatArray]:
        """World poses of the object's links."""
        links = self.object.articulated_object.scene.mechanism.links
        return poses_of(self.data, self.object.body, links, "")

    def close(self) -> None:
        """Nothing is held that Python does not free."""


def poses_of(data: mujoco.MjData, bodies: IntArray, names: tuple[str, ...], prefix: str) -> dict[str, FloatArray]:
    """World poses of bodies under their names, shape (4, 4) each."""
    found = np.tile(np.eye(4), (len(names), 1, 1))
    found[:, :3, :3], found[:, :3, 3] = data.xmat[bodies].reshape(-1, 3, 3), data.xpos[bodies]
    return {prefix + name: T for name, T in zip(names, found, strict=True)}
