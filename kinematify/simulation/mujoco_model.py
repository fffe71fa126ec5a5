"""Files in MuJoCo: compiled models, variants of them, and what it says of a table of configurations."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from lxml import etree

from kinematify.simulation.configurations import GRAVITY, PIN_SOLIMP, PIN_SOLREF
from kinematify.simulation.contacts import deepest
from kinematify.simulation.engine import Measured, Refused

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.contacts import Touching

_RESERVED = "world"
"""MuJoCo's name of the outside; a link of this name is loaded under another one."""
_ROWS_PER_THREAD = 150
"""Fewer rows are done before a thread has started."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CompiledModel:
    """A compiled model and where the links and joints of the document stand in it."""

    model: mujoco.MjModel
    body: IntArray
    """Body of each link, -1 for lost ones, shape (L,)."""
    joint: IntArray
    """MuJoCo joint of each of `LeaderMechanism.joints`, -1 for lost ones, shape (J,)."""
    balanced: bool
    """True if MuJoCo refused an inertia tensor, and all such were replaced by balanced ones."""

    @property
    def complete(self) -> bool:
        """True if no link and no joint was lost."""
        return bool((self.body >= 0).all() and (self.joint >= 0).all())

    @property
    def qpos(self) -> IntArray:
        """Address of each joint in `qpos`, shape (J,)."""
        return np.asarray(self.model.jnt_qposadr, dtype=np.int64)[self.joint]

    @property
    def dof(self) -> IntArray:
        """Address of each joint in `qvel`, shape (J,)."""
        return np.asarray(self.model.jnt_dofadr, dtype=np.int64)[self.joint]

    @property
    def link_of_body(self) -> IntArray:
        """Link of each body, -1 for what is no link, shape (bodies,)."""
        links = np.full(self.model.nbody, -1, dtype=np.int64)
        links[self.body] = np.arange(len(self.body))
        return links


@dataclass(frozen=True, kw_only=True, eq=False)
class ParsedModel:
    """A parsed file, from which variants are compiled."""

    spec: mujoco.MjSpec
    names: tuple[str, ...]
    """Names of the links in the document's order, as MuJoCo knows them."""
    mechanism: LeaderMechanism
    step: float
    """Time step [s]."""


def parse(urdf: Path, mechanism: LeaderMechanism, *, step: float) -> ParsedModel:
    """Parse a file.

    Raises:
        Refused: MuJoCo cannot.
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
        raise Refused(_sentence(error)) from error
    spec.modelfiledir = str(urdf.parent)
    spec.compiler.fusestatic = False
    set_options(spec, step)
    # Contacts between a body and its parent count; what is there from the start is allowed pair by pair.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_FILTERPARENT.value
    for number, geom in enumerate(spec.geoms):
        geom.name = f"kinematify geom {number}"
    names = tuple(stand_in if name == _RESERVED else name for name in mechanism.links)
    _close_loops(spec, names, mechanism)
    return ParsedModel(spec=spec, names=names, mechanism=mechanism, step=step)


def _close_loops(spec: mujoco.MjSpec, names: tuple[str, ...], mechanism: LeaderMechanism) -> None:
    """Hold both ends of every loop together, which MuJoCo does not read in a URDF."""
    for loop in mechanism.robot.loops:
        first, second = (names[mechanism.links.index(link)] for link in loop.links)
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


def compiled(source: ParsedModel) -> CompiledModel:
    """Compile a variant; where MuJoCo refuses an inertia tensor, a second time with balanced ones.

    Raises:
        Refused: It refuses something else.
    """
    balanced = bool(source.spec.compiler.balanceinertia)
    try:
        model = source.spec.compile()
    except ValueError as error:
        if balanced or "inertia" not in str(error):
            raise Refused(_sentence(error)) from error
        source.spec.compiler.balanceinertia = True
        return compiled(source)
    names = source.mechanism.joints
    return CompiledModel(
        model=model,
        body=_ids(model, mujoco.mjtObj.mjOBJ_BODY, source.names),
        joint=_ids(model, mujoco.mjtObj.mjOBJ_JOINT, names),
        balanced=balanced,
    )


def _ids(model: mujoco.MjModel, kind: mujoco.mjtObj, names: Iterable[str]) -> IntArray:
    return np.array([mujoco.mj_name2id(model, kind, name) for name in names], dtype=np.int64)


def _free_name(names: Iterable[str]) -> str:
    name = f"{_RESERVED} link"
    while name in names:
        name += "_"
    return name


def _sentence(error: Exception) -> str:
    return " ".join(str(error).split())


def with_servos(source: ParsedModel) -> ParsedModel:
    """Return a copy with sensors of both energies, and one servo for each leading joint, in their order.

    The gains are set after compiling (`set_servos`).
    """
    spec = source.spec.copy()
    for number, travel in enumerate(source.mechanism.travels):
        servo = spec.add_actuator(
            name=f"kinematify servo {number}", target=travel.joint, trntype=mujoco.mjtTrn.mjTRN_JOINT
        )
        servo.set_to_position(kp=1.0)
    for kind in (mujoco.mjtSensor.mjSENS_E_POTENTIAL, mujoco.mjtSensor.mjSENS_E_KINETIC):
        spec.add_sensor(type=kind)
    return ParsedModel(spec=spec, names=source.names, mechanism=source.mechanism, step=source.step)


def with_allowances(
    source: ParsedModel, measured: CompiledModel, touching: Touching, *, only: Collection[int] | None = None
) -> ParsedModel:
    """Return a copy in which pairs of bodies act on each other only beyond what they are allowed.

    Args:
        source: The file, with servos.
        measured: The same file compiled as it is.
        touching: The pairs that touch in the sweep.
        only: Indices of the pairs that act, which saves most of the time where few can meet; None: all bodies do.
    """
    spec = source.spec.copy()
    bodies = source.mechanism.body_of_link
    geoms = _geoms_of_bodies(measured, bodies)
    deep = {tuple(pair): allowed for pair, allowed in zip(touching.bodies.tolist(), touching.allowed, strict=True)}
    acting = set(deep) if only is None else {tuple(touching.bodies[index].tolist()) for index in only}
    if only is not None:
        for geom in spec.geoms:
            geom.contype = geom.conaffinity = 0
    else:
        _exclude(spec, source.names, bodies, acting)
        for geom in spec.geoms:
            # Frictionless; detected when they touch (margin + gap), acting beyond (margin); those of both sides add up.
            geom.condim, geom.margin, geom.gap = 1, -0.5 * touching.tolerance, 0.5 * touching.tolerance
    for pair in sorted(pair for pair in acting if np.isfinite(deep[pair])):
        for first in geoms.get(pair[0], ()):
            for second in geoms.get(pair[1], ()):
                depth = float(deep[pair])
                spec.add_pair(geomname1=first, geomname2=second, condim=1, margin=-depth, gap=depth)
    return ParsedModel(spec=spec, names=source.names, mechanism=source.mechanism, step=source.step)


def with_floor(source: ParsedModel, *, height: float, tolerance: float) -> ParsedModel:
    """Return a copy whose root is free, above a plane at a height [m]; the floor tolerates no depth."""
    spec = source.spec.copy()
    spec.body(source.names[source.mechanism.links.index(source.mechanism.robot.root)]).add_freejoint()
    floor = spec.worldbody.add_geom(name="kinematify floor", type=mujoco.mjtGeom.mjGEOM_PLANE)
    floor.size, floor.pos, floor.priority = [0.0, 0.0, 1.0], [0.0, 0.0, height], 1
    floor.margin, floor.gap = 0.5 * tolerance, -0.5 * tolerance
    return ParsedModel(spec=spec, names=source.names, mechanism=source.mechanism, step=source.step)


def _exclude(spec: mujoco.MjSpec, names: tuple[str, ...], bodies: IntArray, pairs: set[tuple[int, int]]) -> None:
    for pair in sorted(pairs):
        for first in np.flatnonzero(bodies == pair[0]):
            for second in np.flatnonzero(bodies == pair[1]):
                spec.add_exclude(bodyname1=names[first], bodyname2=names[second])


def _geoms_of_bodies(measured: CompiledModel, bodies: IntArray) -> dict[int, list[str]]:
    """Names of the collision shapes of every rigid body."""
    found: dict[int, list[str]] = {}
    for geom, body in enumerate(measured.model.geom_bodyid):
        link = measured.link_of_body[body]
        found.setdefault(int(bodies[link]), []).append(measured.model.geom(geom).name)
    return found


def set_servos(model: mujoco.MjModel, stiffness: FloatArray, damping: FloatArray) -> None:
    """Give each servo its gains [N m/rad or N/m, and times s], shape (leaders,); its force is unlimited."""
    model.actuator_gainprm[:, 0] = stiffness
    model.actuator_biasprm[:, 1] = -stiffness
    model.actuator_biasprm[:, 2] = -damping
    model.jnt_actfrclimited[:] = 0


def limited_servos(model: mujoco.MjModel, forces: FloatArray) -> mujoco.MjModel:
    """Return a copy whose servos are no stronger than `forces` [N m or N], shape (leaders,); infinite: no limit."""
    weaker = copy(model)
    finite = np.isfinite(forces)
    weaker.actuator_forcelimited[:] = finite
    weaker.actuator_forcerange[:] = np.where(finite, forces, 0.0)[:, None] * [-1.0, 1.0]
    return weaker


def released(model: mujoco.MjModel) -> mujoco.MjModel:
    """Return a copy without servos, damping and friction in its joints."""
    free = copy(model)
    free.actuator_gainprm[:] = 0.0
    free.actuator_biasprm[:] = 0.0
    free.dof_damping[:] = 0.0
    free.dof_frictionloss[:] = 0.0
    return free


def measure(loaded: CompiledModel, values: FloatArray, *, threads: int) -> Measured:
    """Set the model to every row and look.

    Args:
        loaded: Complete (`CompiledModel.complete`).
        values: Values of all joints [rad or m], shape (n, J).
        threads: MuJoCo computes outside of Python's lock.
    """
    chunks = np.array_split(np.arange(len(values)), min(threads, 1 + len(values) // _ROWS_PER_THREAD))
    if len(chunks) == 1:
        parts = [_measure_rows(loaded, values, chunks[0])]
    else:
        with ThreadPoolExecutor(len(chunks)) as pool:
            parts = list(pool.map(lambda rows: _measure_rows(loaded, values, rows), chunks))
    row, links, depth = (np.concatenate([part[k] for part in parts]) for k in (1, 2, 3))
    return Measured(
        T_world_link=np.concatenate([part[0] for part in parts]),
        contacts=deepest(row, links, depth),
        gravity=np.concatenate([part[4] for part in parts]),
        inertia=parts[0][5],
    )


_Part = tuple["FloatArray", "IntArray", "IntArray", "FloatArray", "FloatArray", "FloatArray"]


def _measure_rows(loaded: CompiledModel, values: FloatArray, rows: IntArray) -> _Part:
    model, data = loaded.model, mujoco.MjData(loaded.model)
    configurations = np.tile(data.qpos, (len(rows), 1))
    configurations[:, loaded.qpos] = values[rows]
    turns, places = np.empty((len(rows), model.nbody, 9)), np.empty((len(rows), model.nbody, 3))
    gravity, counts = np.zeros((len(rows), model.nv)), np.zeros(len(rows), dtype=np.int64)
    inertia = np.zeros((len(loaded.joint), len(loaded.joint)))
    found: list[tuple[IntArray, FloatArray]] = []
    for k, row in enumerate(rows):
        data.qpos[:] = configurations[k]
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_rne(model, data, 0, gravity[k])
        turns[k], places[k], counts[k] = data.xmat, data.xpos, data.ncon
        if data.ncon:
            contact = data.contact
            found.append((contact.geom.copy(), -contact.dist))
        if row == 0:
            inertia = _mass_matrix(loaded, data)
    bodies = loaded.body
    poses = np.tile(np.eye(4), (len(rows), len(bodies), 1, 1))
    poses[..., :3, :3], poses[..., :3, 3] = turns[:, bodies].reshape(len(rows), -1, 3, 3), places[:, bodies]
    geoms, depth = (np.concatenate([item[k] for item in found] or [np.zeros(0)]) for k in range(2))
    links = loaded.link_of_body[model.geom_bodyid][geoms.reshape(-1, 2).astype(np.int64)]
    return poses, np.repeat(rows, counts), links, depth, gravity[:, loaded.dof], inertia


def _mass_matrix(loaded: CompiledModel, data: mujoco.MjData) -> FloatArray:
    matrix = np.zeros((loaded.model.nv, loaded.model.nv))
    if loaded.model.nv:
        mujoco.mj_fullM(loaded.model, data, matrix)
    return matrix[np.ix_(loaded.dof, loaded.dof)]
