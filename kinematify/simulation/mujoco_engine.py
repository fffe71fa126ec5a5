"""MuJoCo: files as `MjModel.from_xml_path` loads them, an object on a floor, and worlds (`simulation/world.py`).

A world is compiled once for a process; worlds are copies of that.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import product
from typing import TYPE_CHECKING, ClassVar

import mujoco
import numpy as np
from lxml import etree

from kinematify.robot.transforms import pose_at, quaternion_of
from kinematify.simulation.configurations import GRAVITY, PIN_SOLIMP, PIN_SOLREF
from kinematify.simulation.engine_file import EngineFile, Unloadable
from kinematify.simulation.world import (
    FLOOR,
    ROBOT,
    ObjectState,
    PlacedModel,
    PlacedRobot,
    PullingHand,
    Variation,
    WorldSpec,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray
    from kinematify.robot.mechanism import LeaderMechanism

_RESERVED = "world"
"""MuJoCo's name of the outside; a link of this name is loaded under another one."""


def _parse(urdf: Path, mechanism: LeaderMechanism, *, step: float) -> tuple[mujoco.MjSpec, dict[str, str]]:
    """Parse a file; also returns its links in the document's order with their names as MuJoCo knows them.

    Raises:
        Unloadable: MuJoCo cannot.
    """
    robot = etree.parse(str(urdf)).getroot()
    stand_in = _free_name(mechanism.links)
    for element in robot.iter("link", "parent", "child"):
        key = "name" if element.tag == "link" else "link"
        if element.get(key) == _RESERVED:
            element.set(key, stand_in)
    try:
        spec = mujoco.MjSpec.from_string(etree.tostring(robot, encoding="unicode", pretty_print=True))
    except ValueError as error:
        raise Unloadable(str(error)) from error
    spec.modelfiledir = str(urdf.parent)
    spec.compiler.fusestatic = False
    set_options(spec, step)
    # Contacts between a body and its parent count; what is there from the start is allowed pair by pair.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_FILTERPARENT.value
    for number, geom in enumerate(spec.geoms):
        geom.name = f"kinematify geom {number}"
    names = {name: stand_in if name == _RESERVED else name for name in mechanism.links}
    _close_loops(spec, names, mechanism)
    return spec, names


def _close_loops(spec: mujoco.MjSpec, names: Mapping[str, str], mechanism: LeaderMechanism) -> None:
    """Hold both ends of every loop together, which MuJoCo does not read in a URDF."""
    for loop in mechanism.robot.loops:
        first, second = (names[link] for link in loop.links)
        pin = spec.add_equality(
            name=loop.name, type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_BODY, name1=first, name2=second
        )
        pin.data[:3] = loop.points[0]
        pin.solref[:2], pin.solimp[:3] = PIN_SOLREF, PIN_SOLIMP


def set_options(spec: mujoco.MjSpec, step: float) -> None:
    """Set a time step [s], and the options that everything shares."""
    spec.option.timestep = step
    spec.option.gravity = [0.0, 0.0, -GRAVITY]
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # MuJoCo 4.0.0 factorises sparse systems wrongly in rare cases; 4.0.1 does not.
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE


def _free_name(names: Iterable[str]) -> str:
    name = f"{_RESERVED} link"
    while name in names:
        name += "_"
    return name


_OBJECT = "object "
_HOLD, _AXIS, _WORLD = "kinematify hold", "kinematify axis", "kinematify world"
_WELD, _LATCH = "kinematify weld", "kinematify latch "
_PART, _OTHERS, _PIECE, _ROBOT, _FLOOR = 1, 2, 4, 8, 16
"""Bits of what is gripped, the rest of the object, the piece that friction holds, the robot, and the floor."""
_NET_FORCE = 3
"""MuJoCo's reduction of contacts to the sum of their forces."""
_STIFF = 0.999
"""Share of its creep that friction takes away."""
_SQUEEZE = 1e3
"""Stiffness of fingers over their force [1/m]: a millimetre inside of what they hold they press fully."""
_WARNINGS = {
    kind.value: name.removeprefix("mjWARN_").lower()
    for name, kind in mujoco.mjtWarning.__members__.items()
    if name.startswith("mjWARN_")
}


@dataclass(frozen=True, kw_only=True, eq=False)
class _Compiled:
    """A compiled world, and the links of both models as MuJoCo knows them."""

    model: mujoco.MjModel
    object_links: tuple[str, ...]
    robot_links: tuple[str, ...]


@lru_cache(maxsize=24)
def _compiled(spec: WorldSpec) -> _Compiled:
    world = mujoco.MjSpec()
    set_options(world, spec.step)
    world.compiler.balanceinertia = True
    # What blows up is reported, not silently set back to the start.
    world.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_FILTERPARENT.value
    world.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET.value
    world.worldbody.add_site(name=_WORLD)
    source, names = _parsed(spec.object, spec.step)
    robot_links: tuple[str, ...] = ()
    if spec.robot is not None:
        _layer_object(spec, source, names)
    _attach(world, source, _OBJECT, spec.object.T_world_root)
    _observe(world, spec, names)
    if spec.robot is not None:
        # Friction holds without creeping: elliptic cones, and stiffer along surfaces than into them.
        world.option.cone, world.option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0
        robot_links = _add_robot(world, spec, spec.robot, names)
    else:
        for axis, letter in enumerate("xyz"):
            hand = world.add_actuator(name=f"kinematify hand {letter}", trntype=mujoco.mjtTrn.mjTRN_SITE, target=_HOLD)
            hand.refsite = _WORLD
            hand.gear = np.eye(6)[axis]
    _lock(world, spec.object, _OBJECT)
    model = world.compile()
    if spec.robot is not None:
        _set_servos(model, spec, spec.robot)
    return _Compiled(model=model, object_links=tuple(names.values()), robot_links=robot_links)


def _parsed(placed: PlacedModel, step: float) -> tuple[mujoco.MjSpec, dict[str, str]]:
    source, names = _parse(placed.urdf, placed.mechanism, step=step)
    source.compiler.balanceinertia = True
    for first, second in placed.apart:
        source.add_exclude(bodyname1=names[first], bodyname2=names[second])
    return source, names


def _attach(world: mujoco.MjSpec, part: mujoco.MjSpec, prefix: str, T_world_root: FloatArray) -> None:
    frame = world.worldbody.add_frame(pos=T_world_root[:3, 3], quat=quaternion_of(T_world_root[:3, :3]))
    world.attach(part, prefix=prefix, frame=frame)


def _layer_object(spec: WorldSpec, source: mujoco.MjSpec, names: Mapping[str, str]) -> None:
    """The object meets the robot, and itself where no plan has looked at it."""
    grip = spec.grip
    part = () if grip is None else [names[link] for link in grip.part]
    for geom in source.geoms:
        held = geom.parent.name in part
        geom.contype, geom.conaffinity = _PART if held else _OTHERS, _OTHERS if grip is None else 0
    if grip is not None and grip.piece is not None:
        vertices, faces = grip.piece
        mesh = source.add_mesh(name="kinematify grip", uservert=vertices.ravel(), userface=faces.ravel())
        piece = source.body(names[grip.link]).add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name, mass=0.0)
        piece.contype, piece.conaffinity = _PIECE, 0


def _observe(world: mujoco.MjSpec, spec: WorldSpec, names: Mapping[str, str]) -> None:
    """Mark the held point and the joint that moves it, with their sensors."""
    if spec.point is None:
        return
    body = world.body(_OBJECT + names[spec.point.link])
    turn = np.zeros(4)
    mujoco.mju_quatZ2Vec(turn, np.asarray(spec.point.axis, dtype=np.float64))
    body.add_site(name=_HOLD, pos=spec.point.point)
    body.add_site(name=_AXIS, quat=turn)
    for kind, site in (
        (mujoco.mjtSensor.mjSENS_FRAMEPOS, _HOLD),
        (mujoco.mjtSensor.mjSENS_FRAMEPOS, _AXIS),
        (mujoco.mjtSensor.mjSENS_FRAMEZAXIS, _AXIS),
    ):
        world.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=site)


def _add_robot(
    world: mujoco.MjSpec, spec: WorldSpec, robot: PlacedRobot, object_links: Mapping[str, str]
) -> tuple[str, ...]:
    """Attach the robot, rubber on all of its surfaces, with servos, on a floor that it alone meets."""
    (source, names), grip = _parsed(robot, spec.step), spec.grip
    itself = _ROBOT if grip is None else 0
    hand = () if grip is None else [names[link] for link in grip.hand]
    for geom in source.geoms:
        met = _OTHERS | (_PIECE if geom.parent.name in hand else _PART)
        geom.contype, geom.conaffinity = _ROBOT, met | _FLOOR | itself
        geom.condim, geom.friction = 4, [robot.settings.friction, 0.02, 0.0001]
        geom.solref[:2], geom.solimp[:2], geom.priority = [2.0 * spec.step, 1.0], [0.95, 0.99], 1
    for body in source.bodies:
        body.gravcomp = 1.0
    _attach(world, source, ROBOT, robot.T_world_root)
    floor = world.worldbody.add_geom(name="kinematify floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0.0, 0.0, 1.0])
    floor.contype, floor.conaffinity = _FLOOR, 0
    smoothing = {} if robot.smoothing is None else {"timeconst": robot.smoothing}
    for joint in robot.driven:
        servo = world.add_actuator(name=f"kinematify servo {joint}", target=ROBOT + joint)
        servo.trntype = mujoco.mjtTrn.mjTRN_JOINT
        servo.set_to_position(kp=1.0, **smoothing)
    _lock(world, robot, ROBOT)
    touched = () if spec.point is None else spec.point.body
    for link, other in product(robot.finger_links, touched):
        world.add_sensor(
            type=mujoco.mjtSensor.mjSENS_CONTACT,
            objtype=mujoco.mjtObj.mjOBJ_BODY,
            objname=ROBOT + link,
            reftype=mujoco.mjtObj.mjOBJ_BODY,
            refname=_OBJECT + object_links[other],
            intprm=[1 << mujoco.mjtConDataField.mjCONDATA_FORCE.value, _NET_FORCE, 1],
        )
    if grip is not None:
        weld = world.add_equality(name=_WELD, type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY)
        weld.name1, weld.name2, weld.active = ROBOT + robot.tool, _OBJECT + object_links[grip.link], False
    return tuple(names.values())


def _lock(world: mujoco.MjSpec, placed: PlacedModel, prefix: str) -> None:
    """Hold joints where they are locked."""
    for joint, value in placed.locked.items():
        latch = world.add_equality(type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT)
        latch.name, latch.name1, latch.data[0] = _LATCH + prefix + joint, prefix + joint, value


def _set_servos(model: mujoco.MjModel, spec: WorldSpec, robot: PlacedRobot) -> None:
    """Servos of one frequency for the arm, as strong as the file says, and fingers as strong as the grip."""
    arm, fingers = (_addresses(model, ROBOT, names) for names in (robot.arm, robot.fingers))
    inertia, settings = _largest_inertia(model, spec, arm[0], robot.postures), robot.settings
    model.dof_armature[arm[1]] += settings.armature * inertia[arm[1]]
    model.dof_armature[fingers[1]] = settings.finger_inertia
    rate, count = 2.0 * np.pi * settings.servo_frequency, len(robot.arm)
    own = np.full(len(robot.fingers), settings.finger_inertia)
    stiffness = np.concatenate([(1.0 + settings.armature) * inertia[arm[1]], own]) * rate**2
    stiffness[count:] = np.maximum(stiffness[count:], _SQUEEZE * settings.grip_force)
    model.actuator_gainprm[:, 0], model.actuator_biasprm[:, 1] = stiffness, -stiffness
    model.actuator_biasprm[:, 2] = -2.0 * stiffness / rate
    forces = np.concatenate([robot.strongest, np.full(len(robot.fingers), settings.grip_force)])
    model.actuator_forcelimited[:] = 1
    model.actuator_forcerange[:] = forces[:, None] * [-1.0, 1.0]
    model.jnt_actfrclimited[:] = 0
    for joint, share in spec.object.damping.items():
        dof = int(model.joint(_OBJECT + joint).dofadr[0])
        model.dof_damping[dof] = max(model.dof_damping[dof], share * inertia[dof])


def _addresses(model: mujoco.MjModel, prefix: str, joints: Iterable[str]) -> tuple[IntArray, IntArray]:
    """Where joints stand in positions and in velocities, shape (joints,) each."""
    ids = np.array([int(model.joint(prefix + name).id) for name in joints], dtype=np.int64)
    return np.asarray(model.jnt_qposadr, dtype=np.int64)[ids], np.asarray(model.jnt_dofadr, dtype=np.int64)[ids]


def _largest_inertia(
    model: mujoco.MjModel, spec: WorldSpec, arm: IntArray, postures: Sequence[FloatArray]
) -> FloatArray:
    """Inertia that each degree of freedom moves, the largest of some postures of the arm [kg m^2 or kg], (nv,)."""
    data, matrix, largest = mujoco.MjData(model), np.zeros((model.nv, model.nv)), np.zeros(model.nv)
    if spec.object.locked:
        leaders = [[spec.object.locked[travel.joint] for travel in spec.object.mechanism.travels]]
        object_joints = _addresses(model, _OBJECT, spec.object.mechanism.joints)[0]
        data.qpos[object_joints] = spec.object.mechanism.all_values(np.array(leaders))[0]
    for posture in postures:
        data.qpos[arm] = posture
        mujoco.mj_forward(model, data)
        _fill_mass_matrix(model, data, matrix)
        largest = np.maximum(largest, np.diag(matrix))
    return largest


def _fill_mass_matrix(model: mujoco.MjModel, data: mujoco.MjData, matrix: FloatArray) -> None:
    if hasattr(data, "qM"):  # MuJoCo before 4
        mujoco.mj_fullM(model, matrix, data.qM)
    else:
        mujoco.mj_fullM(model, data, matrix)


class MujocoWorld:
    """World in MuJoCo."""

    def __init__(self, spec: WorldSpec) -> None:
        """Copy the compiled world, so that it can be changed."""
        compiled, mechanism = _compiled(spec), spec.object.mechanism
        self._spec, self.model = spec, copy(compiled.model)
        self.data = mujoco.MjData(self.model)
        self._qpos, self._dof = _addresses(self.model, _OBJECT, mechanism.joints)
        leaders = [mechanism.joints.index(travel.joint) for travel in mechanism.travels]
        self._leader_qpos, self._leader_dof = self._qpos[leaders], self._dof[leaders]
        self._body = self._bodies(_OBJECT, compiled.object_links)
        self._root = int(self._body[mechanism.links.index(mechanism.robot.root)])
        self._geoms = np.flatnonzero(np.isin(self.model.geom_bodyid, self._body))
        self._robot_body = self._bodies(ROBOT, compiled.robot_links)
        if spec.robot is not None:
            self._driven = _addresses(self.model, ROBOT, spec.robot.driven)
            self._robot_qpos = _addresses(self.model, ROBOT, spec.robot.mechanism.joints)[0]
            self._tool = int(self.model.body(ROBOT + spec.robot.tool).id)
        self._keep()

    def _bodies(self, prefix: str, links: Sequence[str]) -> IntArray:
        return np.array([int(self.model.body(prefix + name).id) for name in links], dtype=np.int64)

    def _keep(self) -> None:
        """Remember what factors refer to."""
        model = self.model
        self._damping, self._friction = model.dof_damping[self._dof].copy(), model.dof_frictionloss[self._dof].copy()
        self._mass, self._moments = model.body_mass[self._body].copy(), model.body_inertia[self._body].copy()
        self._surface = model.geom_friction[self._geoms].copy()
        self._place, self._turn = model.body_pos[self._root].copy(), model.body_quat[self._root].copy()
        self._masses_drawn = False

    def mechanics(self, leaders: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mass matrix (J, J) and holding torques (J,) of the object's joints at values of its leaders."""
        model, data = self.model, mujoco.MjData(self.model)
        data.qpos[self._qpos] = self._spec.object.mechanism.all_values(leaders[None])[0]
        mujoco.mj_forward(model, data)
        matrix = np.zeros((model.nv, model.nv))
        _fill_mass_matrix(model, data, matrix)
        return matrix[np.ix_(self._dof, self._dof)], data.qfrc_bias[self._dof].copy()

    def resist(self, damping: FloatArray, friction: FloatArray) -> None:
        """Give the object's joints damping and friction."""
        model, dof, stiff = self.model, self._dof, 2.0 * self._spec.step
        joints = model.dof_jntid[dof]
        model.dof_damping[dof], model.dof_frictionloss[dof] = damping, friction
        # As it is, MuJoCo's friction creeps: a light handle would sink by 7 deg in a second.
        # And its ends of ranges give: a hand that presses a lid shut would push it in by 20 deg.
        model.dof_solimp[dof, :2], model.dof_solref[dof, 0] = _STIFF, stiff
        model.jnt_solimp[joints, :2], model.jnt_solref[joints, 0] = _STIFF, stiff
        model.jnt_actfrclimited[:] = 0
        self._keep()

    def take(self, hand: PullingHand) -> None:
        """Give the held point a hand."""
        model = self.model
        if not hand.spring:
            model.actuator_gainprm[:, 0] = hand.force
            return
        model.actuator_biastype[:] = mujoco.mjtBias.mjBIAS_AFFINE
        model.actuator_gainprm[:, 0], model.actuator_biasprm[:, 1] = hand.stiffness, -hand.stiffness
        model.actuator_biasprm[:, 2] = -hand.damping
        model.actuator_forcelimited[:] = 1
        model.actuator_forcerange[:] = hand.force * np.array([-1.0, 1.0])

    def vary(self, drawn: Variation) -> None:
        """Change the object."""
        model = self.model
        model.dof_damping[self._dof] = drawn.damping * self._damping
        model.dof_frictionloss[self._dof] = drawn.friction * self._friction
        model.geom_friction[self._geoms] = drawn.surface * self._surface
        T = drawn.T_root
        model.body_pos[self._root] = T[:3, :3] @ self._place + T[:3, 3]
        turn = np.zeros(4)
        mujoco.mju_mat2Quat(turn, T[:3, :3].ravel())
        mujoco.mju_mulQuat(model.body_quat[self._root], turn, self._turn)
        masses_drawn = bool((drawn.mass != 1.0).any())
        if masses_drawn or self._masses_drawn:
            model.body_mass[self._body] = drawn.mass * self._mass
            model.body_inertia[self._body] = drawn.mass[:, None] * self._moments
            mujoco.mj_setConst(model, self.data)
        self._masses_drawn = masses_drawn

    def place(self, values: FloatArray, robot: FloatArray | None = None) -> None:
        """Set all joints and stop them."""
        data = self.data
        mujoco.mj_resetData(self.model, data)
        data.qpos[self._qpos] = values
        if robot is not None and self._spec.robot is not None:
            data.qpos[self._robot_qpos] = self._spec.robot.mechanism.values_at_rest
            data.qpos[self._driven[0]] = data.ctrl[:] = robot
            if self.model.na:
                data.act[:] = robot
        mujoco.mj_forward(self.model, data)

    def pull(self, command: FloatArray) -> None:
        """Command the hand."""
        self.data.ctrl[:] = command
        # As rollouts of many environments begin, so that both give the same numbers.
        self.data.qacc_warmstart[:] = 0.0

    def command(self, values: FloatArray, speeds: FloatArray | None = None) -> None:
        """Command the servos; with a speed they run ahead of the lag by damping over stiffness."""
        self.data.ctrl[:] = values
        if speeds is not None and self._spec.robot is not None:
            self.data.ctrl[: len(speeds)] += speeds / (np.pi * self._spec.robot.settings.servo_frequency)

    def step(self, count: int = 1) -> None:
        """Simulate so many steps."""
        mujoco.mj_step(self.model, self.data, nstep=count)

    def release(self, joints: Iterable[str]) -> None:
        """Make locked joints of the object go."""
        for name in joints:
            self.data.eq_active[self.model.equality(_LATCH + _OBJECT + name).id] = 0

    def weld(self) -> None:
        """Fix the tool to the part where it now is."""
        model, data, weld = self.model, self.data, self.model.equality(_WELD).id
        tool, part = model.eq_obj1id[weld], model.eq_obj2id[weld]
        first, second = data.xmat[tool].reshape(3, 3), data.xmat[part].reshape(3, 3)
        # The anchor, which is the tool's origin, in the frame of the part and in that of the tool.
        model.eq_data[weld, :3] = second.T @ (data.xpos[tool] - data.xpos[part])
        model.eq_data[weld, 3:6] = 0.0
        model.eq_data[weld, 6:10] = quaternion_of(first.T @ second)
        model.eq_data[weld, 10] = 1.0
        data.eq_active[weld] = 1

    def state(self) -> ObjectState:
        """State of the object after the last step."""
        return self.split(self.data.qpos, self.data.qvel, self.data.sensordata)

    def split(self, qpos: FloatArray, qvel: FloatArray, sensors: FloatArray) -> ObjectState:
        """The same of states in rows, shapes (..., nq), (..., nv), (..., sensors)."""
        return ObjectState(
            values=qpos[..., self._leader_qpos],
            speeds=qvel[..., self._leader_dof],
            hold=sensors[..., 0:3],
            anchor=sensors[..., 3:6],
            axis=sensors[..., 6:9],
        )

    def values(self) -> FloatArray:
        """Values of all joints of the object."""
        return np.asarray(self.data.qpos[self._qpos])

    def robot_values(self) -> FloatArray:
        """Values of all joints of the robot."""
        return np.asarray(self.data.qpos[self._robot_qpos])

    def driven(self) -> tuple[FloatArray, FloatArray]:
        """Values and speeds of the robot's joints with servos."""
        return self.data.qpos[self._driven[0]], self.data.qvel[self._driven[1]]

    def tool(self) -> FloatArray:
        """Pose of the tool."""
        pose: FloatArray = self._poses([self._tool])[0]
        return pose

    def touch(self) -> FloatArray:
        """Force of each finger on the held body."""
        assert self._spec.robot is not None
        forces = self.data.sensordata[9:].reshape(len(self._spec.robot.fingers), -1, 3).sum(axis=1)
        return np.asarray(np.sqrt(np.vecdot(forces, forces)))

    def link_poses(self) -> dict[str, FloatArray]:
        """World poses of the links of both."""
        robot = () if self._spec.robot is None else [ROBOT + name for name in self._spec.robot.mechanism.links]
        names = (*self._spec.object.mechanism.links, *robot)
        return dict(zip(names, self._poses([*self._body, *self._robot_body]), strict=True))

    def _poses(self, bodies: Sequence[int]) -> FloatArray:
        """World poses of bodies, shape (n, 4, 4)."""
        found = np.tile(np.eye(4), (len(bodies), 1, 1))
        found[:, :3, :3], found[:, :3, 3] = self.data.xmat[bodies].reshape(-1, 3, 3), self.data.xpos[bodies]
        return found

    def depth(self) -> float:
        """Return how much deeper than allowed two shapes are in each other at most."""
        if not self.data.ncon:
            return 0.0
        contact = self.data.contact
        return max(0.0, float((contact.includemargin - contact.dist).max()))

    def deeper(self, than: float) -> tuple[float, tuple[str, str]] | None:
        """Deepest contact of the robot, if it is deeper than that."""
        if not self.data.ncon:
            return None
        geoms = self.data.contact.geom
        depths = np.where(self._gripped[geoms].all(axis=1), 0.0, -self.data.contact.dist)
        deepest = int(depths.argmax())
        if depths[deepest] <= than:
            return None
        bodies = (self.model.body(self.model.geom_bodyid[geom]).name for geom in geoms[deepest])
        link, other = sorted(bodies, key=lambda name: not name.startswith(ROBOT))
        other = FLOOR if other == "world" else other.removeprefix(_OBJECT)
        return float(depths[deepest]), (link.removeprefix(ROBOT), other)

    @cached_property
    def _gripped(self) -> BoolArray:
        """Which shapes belong to the hand or to what it holds, shape (geoms,)."""
        grip = self._spec.grip
        links = set() if grip is None else {ROBOT + link for link in grip.hand} | {_OBJECT + link for link in grip.part}
        return np.array([self.model.body(body).name in links for body in self.model.geom_bodyid])

    def stable(self) -> bool:
        """True if all numbers are finite."""
        # What is wrong with a place was wrong with a speed before.
        return math.isfinite(self.data.qvel.sum())

    def warnings(self) -> dict[str, int]:
        """MuJoCo's warnings since `place`."""
        numbers = self.data.warning.number
        if not numbers.any():
            return {}
        return {_WARNINGS[k]: int(number) for k, number in enumerate(numbers) if number}

    def close(self) -> None:
        """Nothing is held that Python does not free."""


_FAR = 1e3
"""Height above the floor from which an object is let down [m]."""


def stand(urdf: Path, values: Mapping[str, float], seconds: float) -> dict[str, float]:
    """Implement `engines.stand`."""
    try:
        world, source = mujoco.MjSpec(), mujoco.MjSpec.from_file(str(urdf))
        source.compiler.fusestatic = False
        world.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0.0, 0.0, 1.0])
        base = world.worldbody.add_body()
        base.add_freejoint()
        world.attach(source, prefix=_OBJECT, frame=base.add_frame())
        model = world.compile()
    except ValueError as error:
        raise Unloadable(str(error)) from error
    data = mujoco.MjData(model)
    for name, value in values.items():
        data.qpos[model.joint(_OBJECT + name).qposadr] = value
    data.qpos[2] = _FAR
    mujoco.mj_forward(model, data)
    gaps = [mujoco.mj_geomDistance(model, data, 0, geom, 2.0 * _FAR, None) for geom in range(1, model.ngeom)]
    data.qpos[2] -= min(gaps, default=_FAR)
    start, turn = data.qpos[:7].copy(), np.zeros(3)
    mujoco.mj_step(model, data, nstep=round(seconds / model.opt.timestep))
    mujoco.mju_subQuat(turn, data.qpos[3:7], start[3:])
    return {
        "moved": float(np.linalg.norm(data.qpos[:3] - start[:3])),
        "turned": float(np.linalg.norm(turn)),
        "deepest": max((-float(contact.dist) for contact in data.contact), default=0.0),
        "on_floor": float(sum(0 in contact.geom for contact in data.contact)),
    }


_OPEN = """import mujoco, numpy as np
model = mujoco.MjModel.from_xml_path({path!r})
"""
_JOINTS = (
    _OPEN
    + """for k in range(model.njnt): ends = model.jnt_range[k] if model.jnt_limited[k] else (-np.inf, np.inf); \
print(model.joint(k).name, *ends)
"""
)
_LOAD = """import mujoco, numpy as np
model = mujoco.MjModel.from_xml_path({path!r}); data = mujoco.MjData(model)
{held}data.qpos{q}[:] = {values}; mujoco.mj_forward(model, data); rest = data.qpos{q}.copy(); push = 0.0
"""
_HELD = 1e9
"""Inertia of a base that floats, which so stays where it is [kg or kg m^2]; PyBullet is asked for a fixed one."""
_NO_CONTACTS = "model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT\n"
_OVERLAP = (
    _LOAD
    + """name = lambda geom: model.body(model.geom_bodyid[geom]).name
print(max(-contact.dist for contact in data.contact if {{name(geom) for geom in contact.geom}} == set({links})))
"""
)
_REST = (
    _LOAD
    + """seen = [data.qpos{q}[{joint}] for _ in range({steps}) if mujoco.mj_step(model, data) is None]
print(min(seen), max(seen))
"""
)
_PUSH = (
    _LOAD
    + """{off}model.opt.gravity[:] = 0.0; seen = [rest[{joint}]]
moved, ratios, weights = {moved}, np.array({ratios}), np.array({weights})
for _ in range({steps}): slow = {speed!r} - data.qvel{v}[{joint}]; \
push = np.clip(push + {integral!r} * slow, -{force!r}, {force!r}); \
data.qfrc_applied{v}[{joint}] = np.clip({proportional!r} * slow + push, -{force!r}, {force!r}); \
mujoco.mj_step(model, data); \
way, speed = weights @ (data.qpos{q} - rest)[moved], weights @ data.qvel{v}[moved]; \
data.qpos{q}[:] = rest; data.qvel{v}[:] = 0.0; \
data.qpos{q}[moved] += ratios * way; data.qvel{v}[moved] = ratios * speed; \
seen.append(data.qpos{q}[{joint}])
print({farthest}(seen))
"""
)
_RELEASE = (
    _LOAD
    + _NO_CONTACTS
    + """model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY; data.qvel{v}[:] = {speeds}
seen = [sum(data.energy) for _ in range({steps}) if mujoco.mj_step(model, data) is None]
print(max(seen) - seen[0])
"""
)


class MujocoFile(EngineFile):
    """Raw model: a file as `MjModel.from_xml_path` loads it."""

    code: ClassVar = {
        "joints": _JOINTS,
        "overlap": _OVERLAP,
        "rest": _REST,
        "push": _PUSH.replace("{off}", ""),
        "push_alone": _PUSH.replace("{off}", _NO_CONTACTS),
        "release": _RELEASE,
    }

    def __init__(self, urdf: Path, root: str) -> None:
        """Load it; a base that floats is held, and floors of a scene are left out.

        Raises:
            Unloadable: MuJoCo does not open it, or moves a link in other ways than by turning or sliding.
        """
        try:
            self._model = model = mujoco.MjModel.from_xml_path(str(urdf))
        except ValueError as error:
            raise Unloadable(str(error), _OPEN.format(path=str(urdf))) from error
        base = int(model.njnt > 0 and model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE)
        if not model.nq - 7 * base == model.nv - 6 * base == model.njnt - base:
            raise Unloadable(reproduction=_OPEN.format(path=str(urdf)) + "print(model.jnt_type)\n")
        self._q, self._v = slice(7 * base, None), slice(6 * base, None)
        held = f"model.dof_armature[:6] = {_HELD:g}; " * base
        model.dof_armature[: 6 * base] = _HELD
        # Planes and height fields, which come first.
        floors = np.flatnonzero(
            (model.geom_bodyid == 0) & (model.geom_type < mujoco.mjtGeom.mjGEOM_SPHERE.value)
        ).tolist()
        if floors:
            model.geom_contype[floors] = model.geom_conaffinity[floors] = 0
            held += f"model.geom_contype[{floors}] = model.geom_conaffinity[{floors}] = 0; "
        self._file = {"path": str(urdf), "held": held, "q": "[7:]" * base, "v": "[6:]" * base}
        self._data, option = mujoco.MjData(self._model), self._model.opt
        self._flags, self._gravity = option.disableflags, option.gravity.copy()
        option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        self._bodies = {k: model.body(k).name for k in range(1, model.nbody)}
        self._world = "world" if root in self._bodies.values() else root
        self._root = root
        self.joints = tuple(self._model.joint(k).name for k in range(base, self._model.njnt))
        ranges = zip(self.joints, self._model.jnt_limited[base:], self._model.jnt_range[base:].tolist(), strict=True)
        self.limits = {name: tuple(ends) if limited else (-np.inf, np.inf) for name, limited, ends in ranges}
        self.time_step = float(option.timestep)

    def begin(
        self,
        values: Mapping[str, float],
        speeds: Mapping[str, float] | None = None,
        *,
        contacts: bool,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """Implement `EngineFile`; MuJoCo gives a URDF no motors."""
        del released
        model, data, option = self._model, self._data, self._model.opt
        option.disableflags, option.gravity[:] = self._flags, self._gravity
        mujoco.mj_resetData(model, data)
        data.qpos[self._q] = self.row(values)
        mujoco.mj_forward(model, data)
        data.qvel[self._v] = 0.0 if speeds is None else self.row(speeds)
        mujoco.mj_energyVel(model, data)
        option.disableflags |= 0 if contacts else int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        option.gravity[:] *= gravity

    def poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """Implement `EngineFile`; links that fixed joints join are one, bodies without a name are no links.

        A link's frame lies at its joint, which an MJCF may place elsewhere in the body.
        """
        self.begin(values, contacts=False)
        found, last = {}, self._model.body_jntadr + self._model.body_jntnum - 1
        for number, name in self._bodies.items():
            body, joints = self._data.body(number), self._model.body_jntnum[number]
            at = self._model.jnt_pos[last[number]] if joints else np.zeros(3)
            found[name] = pose_at(body.xpos + body.xmat.reshape(3, 3) @ at, body.xmat.reshape(3, 3))
        T_root = np.linalg.inv(found[self._root]) if self._root in found else np.eye(4)
        return {name: (T_root @ pose)[:3] for name, pose in found.items() if name}

    def steps(self, count: int, every: int = 1) -> Iterator[int]:
        """Implement `EngineFile`."""
        for done in range(every, count + 1, every):
            mujoco.mj_step(self._model, self._data, nstep=every)
            yield done

    def state(self) -> tuple[FloatArray, FloatArray]:
        """Implement `EngineFile`."""
        return self._data.qpos[self._q].copy(), self._data.qvel[self._v].copy()

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Implement `EngineFile`."""
        self._data.qpos[self._q], self._data.qvel[self._v] = q, v

    def apply(self, joint: int, force: float) -> None:
        """Implement `EngineFile`."""
        self._data.qfrc_applied[self._v][joint] = force

    def energy(self) -> tuple[float, float]:
        """Implement `EngineFile`; of the state before the last step."""
        return float(self._data.energy[0]), float(self._data.energy[1])

    def touching(self) -> Iterator[tuple[str, str, float]]:
        """Implement `EngineFile`."""
        mujoco.mj_forward(self._model, self._data)
        for contact in self._data.contact:
            bodies = sorted(int(self._model.geom_bodyid[geom]) for geom in contact.geom)
            first, second = (self._bodies.get(body, self._world) for body in bodies)
            yield first, second, -float(contact.dist)

    @property
    def complaint(self) -> str | None:
        """Warnings of numbers that are none."""
        bad = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
        broken = [item.name.removeprefix("mjWARN_") for item in bad if self._data.warning[item].number]
        return f"MuJoCo warns {', '.join(broken)}" if broken else None

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """Implement `EngineFile`."""
        self.begin(values, contacts=True)
        inverse = np.zeros((self._model.nv, self._model.nv))
        mujoco.mj_solveM(self._model, self._data, inverse, np.eye(self._model.nv))
        return np.asarray(1.0 / np.diagonal(inverse)[self._v])

    def _links_in_code(self, links: tuple[str, str]) -> object:
        return sorted({"world" if name == self._world else name for name in links})


FILE, WORLD = MujocoFile, MujocoWorld
