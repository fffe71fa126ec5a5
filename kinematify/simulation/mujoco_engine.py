"""MuJoCo: files as `MjModel.from_xml_path` loads them, on a floor too, and worlds (`simulation/world.py`).

A world is compiled once for a process; engines are copies of that.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING, ClassVar

import mujoco
import numpy as np
from lxml import etree

from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.configurations import GRAVITY, PIN_SOLIMP, PIN_SOLREF
from kinematify.simulation.engine import Engine, Unloadable
from kinematify.simulation.world import (
    FLOOR,
    ROBOT,
    ObjectState,
    OpenedFile,
    PlacedModel,
    PlacedRobot,
    PullingHand,
    Variation,
    WorldSpec,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import LeaderMechanism

_RESERVED = "world"
"""MuJoCo's name of the outside; a link of this name is loaded under another one."""


def _parsed(placed: PlacedModel, step: float) -> tuple[mujoco.MjSpec, dict[str, str]]:
    """Parse a file; also returns its links in the document's order with their names as MuJoCo knows them.

    Raises:
        Unloadable: MuJoCo cannot.
    """
    mechanism, robot = placed.mechanism, etree.parse(str(placed.urdf)).getroot()
    stand_in = _free_name(mechanism.links)
    for element in robot.iter("link", "parent", "child"):
        key = "name" if element.tag == "link" else "link"
        if element.get(key) == _RESERVED:
            element.set(key, stand_in)
    try:
        spec = mujoco.MjSpec.from_string(etree.tostring(robot, encoding="unicode", pretty_print=True))
    except ValueError as error:
        raise Unloadable(str(error)) from error
    spec.modelfiledir = str(placed.urdf.parent)
    spec.compiler.fusestatic, spec.compiler.balanceinertia = False, True
    _set_options(spec, step)
    # Contacts between a body and its parent count; what is there from the start is allowed pair by pair.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_FILTERPARENT.value
    for number, geom in enumerate(spec.geoms):
        geom.name = f"kinematify geom {number}"
    names = {name: stand_in if name == _RESERVED else name for name in mechanism.links}
    _close_loops(spec, names, mechanism)
    for first, second in placed.apart:
        spec.add_exclude(bodyname1=names[first], bodyname2=names[second])
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


def _set_options(spec: mujoco.MjSpec, step: float) -> None:
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
    _set_options(world, spec.step)
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


def mechanics(spec: WorldSpec, leaders: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the mass matrix (J, J) and holding torques (J,) of the object's joints at values of its leaders."""
    model, mechanism = _compiled(spec).model, spec.object.mechanism
    data, (qpos, dof) = mujoco.MjData(model), _addresses(model, _OBJECT, mechanism.joints)
    data.qpos[qpos] = mechanism.all_values(leaders[None])[0]
    mujoco.mj_forward(model, data)
    matrix = np.zeros((model.nv, model.nv))
    _fill_mass_matrix(model, data, matrix)
    return matrix[np.ix_(dof, dof)], data.qfrc_bias[dof].copy()


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
_BASE = "kinematify base"
_FAR = 1e3
"""Height above the floor from which an object is let down [m]."""
_HELD = 1e9
"""Inertia of a base that floats, which so stays where it is [kg or kg m^2]; PyBullet is asked for a fixed one."""
_NO_CONTACTS = "model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT\n"
_NO_MOTORS = "model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION; "
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
    + """{off}{motors}model.opt.gravity[:] = 0.0; seen = [rest[{joint}]]
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
    + """{motors}model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY; data.qvel{v}[:] = {speeds}
seen = [sum(data.energy) for _ in range({steps}) if mujoco.mj_step(model, data) is None]
print(max(seen) - seen[0])
"""
)


def _on_floor(urdf: str) -> mujoco.MjModel:
    """Compile a file whose base is free, and a floor."""
    world, source = mujoco.MjSpec(), mujoco.MjSpec.from_file(urdf)
    source.compiler.fusestatic = False
    world.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0.0, 0.0, 1.0])
    base = world.worldbody.add_body()
    base.add_freejoint()
    world.attach(source, prefix=_OBJECT, frame=base.add_frame())
    return world.compile()


class MujocoEngine(Engine):
    """MuJoCo. Its model and data may be looked at; links that fixed joints join are one in a URDF without a world."""

    title = "MuJoCo"
    code: ClassVar = {
        "joints": _JOINTS,
        "overlap": _OVERLAP,
        "rest": _REST,
        "push": _PUSH.replace("{off}", ""),
        "push_alone": _PUSH.replace("{off}", _NO_CONTACTS),
        "release": _RELEASE,
    }
    keyed = False
    look_steps = 1

    def __init__(self, content: OpenedFile | WorldSpec) -> None:
        """Open a file, its base held, floors of a scene left out; or copy a compiled world, so that it can be changed.

        Raises:
            Unloadable: MuJoCo does not open it, or moves a link of a file in other ways than by turning or sliding.
        """
        self._on_floor = isinstance(content, OpenedFile) and content.on_floor
        self._servo_rate: float | None = None
        self._moved, self._masses_drawn = False, False
        self._offsets: dict[int, FloatArray] = {}
        self.facts, self.link_code = {}, {}
        if isinstance(content, WorldSpec):
            self._open_world(content)
        else:
            self._open_file(content)
        model = self.model
        self.data, option = mujoco.MjData(model), model.opt
        self._flags, self._gravity = option.disableflags, option.gravity.copy()
        self.time_step = float(option.timestep)
        self.joint_code = {name: number for number, name in enumerate(self.joints)}

    def _open_file(self, file: OpenedFile) -> None:
        path, prefix = str(file.urdf), _OBJECT if file.on_floor else ""
        try:
            self.model = model = _on_floor(path) if file.on_floor else mujoco.MjModel.from_xml_path(path)
        except ValueError as error:
            raise Unloadable(str(error), _OPEN.format(path=path)) from error
        base = int(model.njnt > 0 and model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE)
        if not model.nq - 7 * base == model.nv - 6 * base == model.njnt - base:
            raise Unloadable(reproduction=_OPEN.format(path=path) + "print(model.jnt_type)\n")
        self._qpos, self._dof = np.arange(7 * base, model.nq), np.arange(6 * base, model.nv)
        held = "" if file.on_floor else self._hold_still(base)
        self.facts = {"path": path, "held": held, "q": "[7:]" * base, "v": "[6:]" * base}
        self.facts["motors"] = _NO_MOTORS * bool(model.nu)
        model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        names = [model.body(k).name.removeprefix(prefix) for k in range(1, model.nbody)]
        self.root = _BASE if file.on_floor else file.root
        names[: file.on_floor] = [_BASE] * file.on_floor
        world = FLOOR if file.on_floor else "world" if file.root in names else file.root
        self.links, self.link_code = (world, *names), {world: "world"}
        self._bodies = np.array([k for k in range(1, model.nbody) if self.links[k]], dtype=np.int64)
        # A link's frame lies at its joint, which an MJCF may place elsewhere in the body.
        last = model.body_jntadr + model.body_jntnum - 1
        at = {k: model.jnt_pos[last[body]] for k, body in enumerate(self._bodies) if model.body_jntnum[body]}
        self._offsets = {k: place for k, place in at.items() if place.any()}
        self.joints = tuple(model.joint(k).name.removeprefix(prefix) for k in range(base, model.njnt))
        ranges = zip(self.joints, model.jnt_limited[base:], model.jnt_range[base:].tolist(), strict=True)
        self.limits = {name: tuple(ends) if limited else (-np.inf, np.inf) for name, limited, ends in ranges}

    def _hold_still(self, base: int) -> str:
        """Hold a base that floats, and leave planes and height fields out, which come first; the code of that."""
        model, held = self.model, f"model.dof_armature[:6] = {_HELD:g}; " * base
        model.dof_armature[: 6 * base] = _HELD
        floors = np.flatnonzero(
            (model.geom_bodyid == 0) & (model.geom_type < mujoco.mjtGeom.mjGEOM_SPHERE.value)
        ).tolist()
        if floors:
            model.geom_contype[floors] = model.geom_conaffinity[floors] = 0
            held += f"model.geom_contype[{floors}] = model.geom_conaffinity[{floors}] = 0; "
        return held

    def _open_world(self, spec: WorldSpec) -> None:
        compiled, mechanism = _compiled(spec), spec.object.mechanism
        self.model = model = copy(compiled.model)
        self.root, self.joints, self.limits = mechanism.robot.root, mechanism.joints, {}
        self._qpos, self._dof = _addresses(model, _OBJECT, mechanism.joints)
        leaders = [mechanism.joints.index(travel.joint) for travel in mechanism.travels]
        self._leader_qpos, self._leader_dof = self._qpos[leaders], self._dof[leaders]
        self._body = self._ids(_OBJECT, compiled.object_links)
        self._root = int(self._body[mechanism.links.index(mechanism.robot.root)])
        self._geoms = np.flatnonzero(np.isin(model.geom_bodyid, self._body))
        self._bodies = np.concatenate([self._body, self._ids(ROBOT, compiled.robot_links)])
        names: tuple[str, ...] = mechanism.links
        if spec.robot is not None:
            robot = spec.robot.mechanism
            names = (*names, *(ROBOT + name for name in robot.links))
            self._driven = _addresses(model, ROBOT, spec.robot.driven)
            self._robot_qpos, self._robot_dof = _addresses(model, ROBOT, robot.joints)
            self._robot_rest, self._fingers = robot.values_at_rest, len(spec.robot.fingers)
            self._servo_rate = np.pi * spec.robot.settings.servo_frequency
        links = [FLOOR] * model.nbody
        for body, name in zip(self._bodies.tolist(), names, strict=True):
            links[body] = name
        self.links = tuple(links)
        self._keep()

    def _ids(self, prefix: str, links: Sequence[str]) -> IntArray:
        return np.array([int(self.model.body(prefix + name).id) for name in links], dtype=np.int64)

    def _keep(self) -> None:
        """Remember what factors refer to."""
        model = self.model
        self._damping, self._friction = model.dof_damping[self._dof].copy(), model.dof_frictionloss[self._dof].copy()
        self._mass, self._moments = model.body_mass[self._body].copy(), model.body_inertia[self._body].copy()
        self._surface = model.geom_friction[self._geoms].copy()
        self._place, self._turn = model.body_pos[self._root].copy(), model.body_quat[self._root].copy()
        self._masses_drawn = False

    def place(
        self,
        values: FloatArray,
        robot: FloatArray | None = None,
        *,
        speeds: FloatArray | None = None,
        contacts: bool = True,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """Implement `Engine`; the motors of an MJCF are off for all joints where some are released."""
        model, data, option = self.model, self.data, self.model.opt
        option.disableflags, option.gravity[:] = self._flags, self._gravity
        mujoco.mj_resetData(model, data)
        data.qpos[self._qpos] = values
        if robot is not None:
            data.qpos[self._robot_qpos] = self._robot_rest
            data.qpos[self._driven[0]] = data.ctrl[:] = robot
            if model.na:
                data.act[:] = robot
        if self._on_floor:
            data.qpos[2] = _FAR
        mujoco.mj_forward(model, data)
        if self._on_floor:
            gaps = [mujoco.mj_geomDistance(model, data, 0, geom, 2.0 * _FAR, None) for geom in range(1, model.ngeom)]
            data.qpos[2] -= min(gaps, default=_FAR)
        if speeds is not None:
            data.qvel[self._dof] = speeds
            mujoco.mj_energyVel(model, data)
        option.disableflags |= 0 if contacts else int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        if released and self.facts:
            option.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION.value
        option.gravity[:] *= gravity
        self._moved = False

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Implement `Engine`."""
        self.data.qpos[self._qpos], self.data.qvel[self._dof] = q, v
        self._moved = True

    def step(self, count: int = 1) -> None:
        """Implement `Engine`."""
        mujoco.mj_step(self.model, self.data, nstep=count)
        self._moved = False

    def state(self, *, robot: bool = False) -> tuple[FloatArray, FloatArray]:
        """Implement `Engine`."""
        qpos, dof = (self._robot_qpos, self._robot_dof) if robot else (self._qpos, self._dof)
        return self.data.qpos[qpos], self.data.qvel[dof]

    def link_poses(self) -> dict[str, FloatArray]:
        """Implement `Engine`; links that fixed joints join are one in a file."""
        bodies = self._bodies
        if self._on_floor:
            mujoco.mj_kinematics(self.model, self.data)
        found = np.tile(np.eye(4), (len(bodies), 1, 1))
        found[:, :3, :3], found[:, :3, 3] = self.data.xmat[bodies].reshape(-1, 3, 3), self.data.xpos[bodies]
        for k, place in self._offsets.items():
            found[k, :3, 3] += found[k, :3, :3] @ place
        return {self.links[body]: pose for body, pose in zip(bodies, found, strict=True)}

    def contacts(self) -> tuple[IntArray, FloatArray]:
        """Implement `Engine`."""
        if self._moved:
            mujoco.mj_forward(self.model, self.data)
        contact = self.data.contact
        return self.model.geom_bodyid[contact.geom], -contact.dist

    def warnings(self) -> dict[str, int]:
        """Implement `Engine`."""
        numbers = self.data.warning.number
        if not numbers.any():
            return {}
        return {_WARNINGS[k]: int(number) for k, number in enumerate(numbers) if number}

    def stable(self) -> bool:
        """Implement `Engine`."""
        # What is wrong with a place was wrong with a speed before.
        return math.isfinite(self.data.qvel.sum())

    def energy(self) -> tuple[float, float]:
        """Implement `Engine`; of the state before the last step."""
        return float(self.data.energy[0]), float(self.data.energy[1])

    def inertias(self, values: FloatArray) -> FloatArray:
        """Implement `Engine`."""
        self.place(values)
        inverse = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_solveM(self.model, self.data, inverse, np.eye(self.model.nv))
        return np.asarray(1.0 / np.diagonal(inverse)[self._dof])

    def max_safe_force(self, values: FloatArray) -> FloatArray:
        """Implement `Engine`; there is no such force."""
        return np.full(len(values), np.inf)

    def apply(self, joint: int, force: float) -> None:
        """Implement `Engine`."""
        self.data.qfrc_applied[self._dof[joint]] = force

    def command(self, values: FloatArray, speeds: FloatArray | None = None) -> None:
        """Implement `Engine`."""
        self.data.ctrl[:] = values
        if self._servo_rate is None:
            # As rollouts of many environments begin, so that both give the same numbers.
            self.data.qacc_warmstart[:] = 0.0
        elif speeds is not None:
            self.data.ctrl[: len(speeds)] += speeds / self._servo_rate

    def weld(self) -> None:
        """Implement `Engine`."""
        model, data, weld = self.model, self.data, self.model.equality(_WELD).id
        tool, part = model.eq_obj1id[weld], model.eq_obj2id[weld]
        first, second = data.xmat[tool].reshape(3, 3), data.xmat[part].reshape(3, 3)
        # The anchor, which is the tool's origin, in the frame of the part and in that of the tool.
        model.eq_data[weld, :3] = second.T @ (data.xpos[tool] - data.xpos[part])
        model.eq_data[weld, 3:6] = 0.0
        model.eq_data[weld, 6:10] = quaternion_of(first.T @ second)
        model.eq_data[weld, 10] = 1.0
        data.eq_active[weld] = 1

    def unlock(self, joints: Iterable[str]) -> None:
        """Implement `Engine`."""
        for name in joints:
            self.data.eq_active[self.model.equality(_LATCH + _OBJECT + name).id] = 0

    def observe(self, rows: tuple[FloatArray, FloatArray, FloatArray] | None = None) -> ObjectState:
        """Implement `Engine`; or the same of many worlds, rows of positions, speeds and sensors."""
        qpos, qvel, sensors = rows or (self.data.qpos, self.data.qvel, self.data.sensordata)
        return ObjectState(
            values=qpos[..., self._leader_qpos],
            speeds=qvel[..., self._leader_dof],
            hold=sensors[..., 0:3],
            anchor=sensors[..., 3:6],
            axis=sensors[..., 6:9],
        )

    def touch(self) -> FloatArray:
        """Implement `Engine`."""
        forces = self.data.sensordata[9:].reshape(self._fingers, -1, 3).sum(axis=1)
        return np.asarray(np.sqrt(np.vecdot(forces, forces)))

    def resist(self, damping: FloatArray, friction: FloatArray, hand: PullingHand | None = None) -> None:
        """Implement `Engine`."""
        model, dof, stiff = self.model, self._dof, 2.0 * self.time_step
        joints = model.dof_jntid[dof]
        model.dof_damping[dof], model.dof_frictionloss[dof] = damping, friction
        # As it is, MuJoCo's friction creeps: a light handle would sink by 7 deg in a second.
        # And its ends of ranges give: a hand that presses a lid shut would push it in by 20 deg.
        model.dof_solimp[dof, :2], model.dof_solref[dof, 0] = _STIFF, stiff
        model.jnt_solimp[joints, :2], model.jnt_solref[joints, 0] = _STIFF, stiff
        model.jnt_actfrclimited[:] = 0
        self._keep()
        if hand is None:
            return
        model.actuator_gainprm[:, 0] = hand.stiffness if hand.spring else hand.force
        if hand.spring:
            model.actuator_biastype[:] = mujoco.mjtBias.mjBIAS_AFFINE
            model.actuator_biasprm[:, 1], model.actuator_biasprm[:, 2] = -hand.stiffness, -hand.damping
            model.actuator_forcelimited[:] = 1
            model.actuator_forcerange[:] = hand.force * np.array([-1.0, 1.0])

    def vary(self, drawn: Variation) -> None:
        """Implement `Engine`."""
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

    def close(self) -> None:
        """Implement `Engine`; nothing is held that Python does not free."""


ENGINE = MujocoEngine
