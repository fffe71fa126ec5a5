"""MuJoCo: prepared models in several runs at a time, one per thread, and raw files."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from mujoco import rollout

from kinematify.robot.mechanism import sweep_rows
from kinematify.simulation.engine import (
    FINER,
    SLOW_SECONDS,
    DriveRun,
    Dropped,
    FreeRun,
    LoadedJoint,
    LoadedRobot,
    Measured,
)
from kinematify.simulation.mujoco_model import (
    CompiledModel,
    ParsedModel,
    compiled,
    limited_servos,
    measure,
    parse,
    released,
    set_servos,
    with_allowances,
    with_floor,
    with_servos,
)
from kinematify.simulation.mujoco_world import MujocoWorld
from kinematify.simulation.raw_model import MovesFreely, Reproductions, RunningFile, Unloadable
from kinematify.simulation.servos import commands
from kinematify.simulation.stepped import count_steps

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.contacts import Contacts, Touching
    from kinematify.simulation.prepared import Prepared
    from kinematify.simulation.raw_model import Start
    from kinematify.simulation.servos import Drive, Servos
    from kinematify.simulation.world import WorldSpec

_STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
_NUMBERS = 20_000_000
"""Numbers in the states of runs that are kept at a time."""
_LOOK = 10
"""Steps of a drive between two looks for pairs that did not act."""
_TIME = re.compile(r" Time = ")


class MujocoEngine:
    """MuJoCo as `kinematify.simulation.engine.Engine`."""

    def __init__(self, settings: EngineSettings, log: Path) -> None:
        """Keep MuJoCo's messages, which else go into a file in the working directory."""
        del log
        self.settings, self.threads = settings, len(os.sched_getaffinity(0))  # it computes outside of Python's lock
        self.said: list[str] = []
        mujoco.set_mju_user_warning(self.said.append)

    @staticmethod
    def load_raw(urdf: Path, root: str, package_dirs: Sequence[Path]) -> MujocoFile:
        """Load a file as users do; MuJoCo knows no packages."""
        del package_dirs
        return MujocoFile(urdf, root)

    @staticmethod
    def open_world(spec: WorldSpec) -> MujocoWorld:
        """Build a world that runs."""
        return MujocoWorld(spec)

    def load(self, prepared: Prepared, mechanism: LeaderMechanism) -> MujocoModel:
        """Load a prepared file."""
        source = parse(prepared.urdf, mechanism, step=self.settings.time_step)
        return MujocoModel(engine=self, source=source, measuring=compiled(source))

    def messages(self) -> list[str]:
        """MuJoCo's warnings without the time in them."""
        return list(dict.fromkeys(_TIME.split(text)[0] for text in self.said))


@dataclass(frozen=True, kw_only=True, eq=False)
class MujocoModel:
    """Prepared model in MuJoCo."""

    engine: MujocoEngine
    source: ParsedModel
    measuring: CompiledModel
    """Everything collides at any depth."""

    @property
    def loaded(self) -> LoadedRobot:
        """Return what became of joints and masses."""
        model, mechanism = self.measuring.model, self.source.mechanism
        joints = {
            name: LoadedJoint(
                turns=bool(model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE),
                lower=float(model.jnt_range[joint, 0]) if model.jnt_limited[joint] else -np.inf,
                upper=float(model.jnt_range[joint, 1]) if model.jnt_limited[joint] else np.inf,
                axis=model.jnt_axis[joint].copy(),
            )
            for name, joint in zip(mechanism.joints, self.measuring.joint.tolist(), strict=True)
            if joint >= 0
        }
        bodies = zip(mechanism.links, self.measuring.body.tolist(), strict=True)
        masses = {name: float(model.body_mass[body]) for name, body in bodies if body >= 0}
        total = float(model.body_mass.sum())
        return LoadedRobot(joints=joints, masses=masses, total_mass=total, balanced=self.measuring.balanced)

    @property
    def complete(self) -> bool:
        """True if no link and no joint was lost."""
        return self.measuring.complete

    @property
    def size(self) -> float:
        """Size of the model [m]."""
        return float(max(self.measuring.model.stat.extent, 1e-9))

    @property
    def resistance(self) -> FloatArray:
        """Damping and friction of all joints, shape (2, J)."""
        model, dof = self.measuring.model, self.measuring.dof
        return np.array([model.dof_damping[dof], model.dof_frictionloss[dof]])

    @property
    def ignored_pairs(self) -> frozenset[tuple[int, int]]:
        """None: MuJoCo lets each pair have the depth that it has at rest."""
        return frozenset()

    def poses(self, values: FloatArray) -> FloatArray:
        """Where every link is in every row."""
        return self.measure(values).T_world_link

    def measure(self, values: FloatArray) -> Measured:
        """Set the model to every row and look."""
        return measure(self.measuring, values, threads=self.engine.threads)

    def contacts(self, values: FloatArray) -> Contacts:
        """Contacts in every row."""
        return self.measure(values).contacts

    def simulation(self, sweep: Touching, seen: Measured, servos: Servos) -> MujocoSimulation:
        """Compile the models for runs."""
        return MujocoSimulation(model=self, sweep=sweep, servos=servos, inertia=np.diag(seen.inertia))


@dataclass(frozen=True, kw_only=True, eq=False)
class MujocoSimulation:
    """Simulation of a prepared model in MuJoCo."""

    model: MujocoModel
    sweep: Touching
    servos: Servos
    inertia: FloatArray
    """What every joint moves at rest, by which their speeds are weighed, shape (J,)."""

    @cached_property
    def _servoed(self) -> ParsedModel:
        return with_servos(self.model.source)

    def _compiled(self, source: ParsedModel) -> CompiledModel:
        loaded = compiled(source)
        set_servos(loaded.model, self.servos.stiffness, self.servos.damping)
        return loaded

    @cached_property
    def _everything(self) -> CompiledModel:
        """All pairs act on each other, beyond what they are allowed."""
        return self._compiled(with_allowances(self._servoed, self.model.measuring, self.sweep))

    @property
    def _mechanism(self) -> LeaderMechanism:
        return self.model.source.mechanism

    @property
    def step(self) -> float:
        """Time step [s]."""
        return self.model.source.step

    @property
    def batch(self) -> int:
        """As many drives as there is memory for."""
        settings = self.model.engine.settings
        seconds = settings.drive_seconds + settings.settle_seconds + settings.push_seconds
        numbers = round(seconds / self.step) * (2 * len(self._mechanism.joints) + 3)
        return max(2 * self.model.engine.threads, _NUMBERS // numbers)

    def hold(self, efforts: FloatArray, seconds: float) -> FreeRun:
        """Hold the model by servos, which make up for its weight."""
        model = limited_servos(self._everything.model, efforts)
        steps = count_steps(seconds, self.step)
        return self._free(model, np.repeat(self._held[None], steps, axis=0))

    def release(self, seconds: float, *, fine: bool = False) -> FreeRun:
        """Make the model go."""
        free, finer = released(self._everything.model), FINER if fine else 1
        free.opt.timestep /= finer
        return self._free(free, np.zeros((finer * count_steps(seconds, self.step), free.nu)), every=finer)

    def _free(self, model: mujoco.MjModel, control: FloatArray, *, every: int = 1) -> FreeRun:
        """Run a variant of `_everything` under commands (steps, leaders); values are kept of every so many steps."""
        (run,) = _run(self._everything, [model], self._mechanism.values_at_rest, control[None], threads=1)
        leaders = [self._mechanism.joints.index(travel.joint) for travel in self._mechanism.travels]
        return FreeRun(
            q=run.q[: run.whole][every - 1 :: every][:, leaders],
            energy=run.energy[: run.whole],
            fastest=self._fastest([run])[0] * every,
            warnings=run.warnings,
        )

    def drive(self, drives: Sequence[Drive]) -> list[DriveRun]:
        """Drive a joint to an end, the others held."""
        samples = self.model.engine.settings.sweep_samples
        control = np.stack([commands(drive, self._mechanism, self.servos, samples) for drive in drives])
        met = [self.sweep.meet(sweep_rows(drive.leader, samples)) for drive in drives]
        runs = self._driven(drives, control, met)
        if again := [k for k in range(len(drives)) if self._more_meet(runs[k], met[k])]:
            every = [self.sweep.meet(slice(None))] * len(again)  # what held joints bring together counts then, too
            for k, run in zip(again, self._driven([drives[k] for k in again], control[again], every), strict=True):
                runs[k] = run
        return [
            DriveRun(
                q=run.q,
                force=self._force(drive, run, targets[:, drive.leader]),
                pressed=frozenset(),
                fastest=fastest,
                warnings=run.warnings,
            )
            for drive, run, targets, fastest in zip(drives, runs, control, self._fastest(runs), strict=True)
        ]

    def _driven(self, drives: Sequence[Drive], control: FloatArray, acting: list[tuple[int, ...]]) -> list[_Run]:
        """Run drives in each of which only some pairs of the sweep act on each other."""
        only = {
            pairs: self._compiled(with_allowances(self._servoed, self.model.measuring, self.sweep, only=pairs)).model
            for pairs in set(acting)
        }
        forces = np.where(np.eye(len(self._mechanism.travels), dtype=bool), self.servos.force, np.inf)
        models = [limited_servos(only[pairs], forces[k.leader]) for k, pairs in zip(drives, acting, strict=True)]
        rest, threads = self._mechanism.values_at_rest, self.model.engine.threads
        return _run(self._everything, models, rest, control, threads=threads)

    def _more_meet(self, run: _Run, acting: tuple[int, ...]) -> bool:
        """True if pairs that did not act get too deep in a run, since held joints give way."""
        found, sweep = self.model.contacts(run.q[: run.whole : _LOOK]), self.sweep
        bodies = np.sort(self._mechanism.body_of_link[found.links], axis=1)
        return any(
            (found.depth[(bodies == sweep.bodies[pair]).all(axis=1)] > sweep.allowed[pair]).any()
            for pair in {*sweep.meet(slice(None))} - {*acting}
        )

    def _force(self, drive: Drive, run: _Run, targets: FloatArray) -> FloatArray:
        """Force of the servo that drives, after every step, shape (steps,)."""
        leader = drive.leader
        column = self._mechanism.joints.index(self._mechanism.travels[leader].joint)
        force = self.servos.stiffness[leader] * (targets - run.q[:, column])
        force -= self.servos.damping[leader] * run.v[:, column]
        return np.asarray(np.clip(force, -self.servos.force[leader], self.servos.force[leader]))

    def drop(self) -> Dropped:
        """Make the model fall on a floor."""
        settings, measuring, rest = self.model.engine.settings, self.model.measuring, self._mechanism.values_at_rest
        lowest = _lowest_point(measuring.model, _data_of(measuring, _start_state(measuring, rest)))
        allowed = with_allowances(self._servoed, measuring, self.sweep)
        loaded = self._compiled(with_floor(allowed, height=lowest - settings.drop, tolerance=self.sweep.tolerance))
        control = np.repeat(self._held[None, None], count_steps(settings.drop_seconds, self.step), axis=1)
        (run,) = _run(loaded, [loaded.model], rest, control, threads=1)
        window = count_steps(SLOW_SECONDS, self.step)
        early, late = (_data_of(loaded, state) for state in (run.state[-1 - window], run.state[-1]))
        moved = np.linalg.norm(late.xpos[loaded.body] - early.xpos[loaded.body], axis=1)
        return Dropped(
            depth=lowest - settings.drop - _lowest_point(loaded.model, late),
            speed=float(moved.max()) / SLOW_SECONDS,
            warnings=run.warnings,
        )

    @property
    def _held(self) -> FloatArray:
        """Commands that hold the joints at rest, their weight made up for, shape (leaders,)."""
        return np.asarray(self._mechanism.rest + self.servos.holding[0] / self.servos.stiffness)

    def _fastest(self, runs: Sequence[_Run]) -> list[float]:
        """Largest speed of a link's frame in each run, around the step with most motion [m/s]."""
        rows = np.concatenate([_around_fastest(run, self.inertia) for run in runs])
        places = self.model.poses(rows)[..., :3, 3]
        moved = np.linalg.norm(places[1::2] - places[::2], axis=2)
        return [float(most) / self.step for most in moved.max(axis=1)]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Run:
    """States after every step; where the engine diverges, the last state stands to the end."""

    q: FloatArray
    """Values of all joints [rad or m], shape (steps, J)."""
    v: FloatArray
    """Their speeds, shape (steps, J)."""
    energy: FloatArray
    """Potential and kinetic [J], shape (steps, 2)."""
    whole: int
    """Steps before the engine gave up."""
    state: FloatArray
    """All of the engine's state, shape (steps, s)."""
    warnings: tuple[str, ...]
    """What the engine said when it gave up."""


def _run(
    loaded: CompiledModel, models: Sequence[mujoco.MjModel], values: FloatArray, control: FloatArray, *, threads: int
) -> list[_Run]:
    """Run each model under its commands.

    Args:
        loaded: Where the joints stand.
        models: One per run, variants of `loaded.model`; the last two sensors are potential and kinetic energy.
        values: Of all joints at the start, shape (J,).
        control: Shape (runs, steps, leaders).
        threads: At most.
    """
    start = _start_state(loaded, values)
    states = np.repeat(start[None], len(models), axis=0)
    data = [mujoco.MjData(loaded.model) for _ in range(max(1, min(threads, len(models))))]
    with rollout.Rollout(nthread=len(data) if len(data) > 1 else 0) as pool:
        state, sensors = pool.rollout(list(models), data, states, control, chunk_size=1)
    first = 1 + loaded.model.nq
    runs = []
    for model, way, energy, targets in zip(models, state, sensors[:, :, -2:], control, strict=True):
        stopped = np.flatnonzero(np.diff(way[:, 0]) <= 0.0)  # the clock stands still
        whole = int(stopped[0]) + 1 if len(stopped) else len(way)
        warnings = _warnings(model, np.vstack([start, way]), targets, whole) if len(stopped) else ()
        q, v = way[:, 1 + loaded.qpos], way[:, first + loaded.dof]
        runs.append(_Run(q=q, v=v, energy=energy, whole=whole, state=way, warnings=warnings))
    return runs


def _start_state(loaded: CompiledModel, values: FloatArray) -> FloatArray:
    """Return the state at rest with the given values of all joints, shape (J,)."""
    data = mujoco.MjData(loaded.model)
    data.qpos[loaded.qpos] = values
    state = np.zeros(mujoco.mj_stateSize(loaded.model, _STATE))
    mujoco.mj_getState(loaded.model, data, state, _STATE)
    return state


def _warnings(model: mujoco.MjModel, states: FloatArray, control: FloatArray, whole: int) -> tuple[str, ...]:
    """Repeat the last two steps before the engine gave up, and read its counters.

    Args:
        model: Of the run.
        states: At the start and after every step, shape (1 + steps, s).
        control: Shape (steps, leaders).
        whole: Steps that it made; the last one may have ended in a state that MuJoCo had reset.
    """
    data = mujoco.MjData(model)
    first = max(0, whole - 1)
    mujoco.mj_setState(model, data, states[first], _STATE)
    for command in control[first : first + 2]:
        data.ctrl[:] = command
        mujoco.mj_step(model, data)
    kinds = {int(kind): name.removeprefix("mjWARN_") for name, kind in mujoco.mjtWarning.__members__.items()}
    counted = tuple(kinds[k] for k, warning in enumerate(data.warning) if warning.number and k in kinds)
    return counted or ("and it reports no reason",)


def _around_fastest(run: _Run, inertia: FloatArray) -> FloatArray:
    """Return the values of all joints before and after the step with most motion, shape (2, J)."""
    step = 1 + int(np.argmax(run.v[1 : max(2, run.whole)] ** 2 @ inertia))
    return run.q[step - 1 : step + 1]


def _data_of(loaded: CompiledModel, state: FloatArray) -> mujoco.MjData:
    data = mujoco.MjData(loaded.model)
    mujoco.mj_setState(loaded.model, data, state, _STATE)
    mujoco.mj_kinematics(loaded.model, data)
    return data


def _lowest_point(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Return the height of the lowest point of all collision shapes but planes [m]."""
    heights = [
        float((data.geom_xpos[geom] + _corners(model, geom) @ data.geom_xmat[geom].reshape(3, 3).T)[:, 2].min())
        for geom in range(model.ngeom)
        if model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_PLANE
    ]
    return min(heights)


def _corners(model: mujoco.MjModel, geom: int) -> FloatArray:
    """Vertices of a mesh, corners of the box around anything else, in its own frame, shape (n, 3)."""
    mesh = model.geom_dataid[geom]
    if mesh >= 0:
        first = model.mesh_vertadr[mesh]
        vertices: FloatArray = model.mesh_vert[first : first + model.mesh_vertnum[mesh]].astype(np.float64)
        return vertices
    signs = np.array(np.meshgrid([-1.0, 1.0], [-1.0, 1.0], [-1.0, 1.0])).reshape(3, -1).T
    corners: FloatArray = model.geom_aabb[geom, :3] + signs * model.geom_aabb[geom, 3:]
    return corners


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
data.qpos[:] = {values}; mujoco.mj_forward(model, data); rest = data.qpos.copy(); push = 0.0
"""
_NO_CONTACTS = "model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT\n"
_OVERLAP = (
    _LOAD
    + """name = lambda geom: model.body(model.geom_bodyid[geom]).name
print(max(-contact.dist for contact in data.contact if {{name(geom) for geom in contact.geom}} == set({links})))
"""
)
_REST = (
    _LOAD
    + """seen = [data.qpos[{joint}] for _ in range({steps}) if mujoco.mj_step(model, data) is None]
print(min(seen), max(seen))
"""
)
_PUSH = (
    _LOAD
    + """{off}model.opt.gravity[:] = 0.0; seen = [rest[{joint}]]
moved, ratios, weights = {moved}, np.array({ratios}), np.array({weights})
for _ in range({steps}): slow = {speed!r} - data.qvel[{joint}]; \
push = np.clip(push + {integral!r} * slow, -{force!r}, {force!r}); \
data.qfrc_applied[{joint}] = np.clip({proportional!r} * slow + push, -{force!r}, {force!r}); \
mujoco.mj_step(model, data); \
way, speed = weights @ (data.qpos - rest)[moved], weights @ data.qvel[moved]; \
data.qpos[:] = rest; data.qvel[:] = 0.0; data.qpos[moved] += ratios * way; data.qvel[moved] = ratios * speed; \
seen.append(data.qpos[{joint}])
print({farthest}(seen))
"""
)
_RELEASE = (
    _LOAD
    + _NO_CONTACTS
    + """model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY; data.qvel[:] = {speeds}
seen = [sum(data.energy) for _ in range({steps}) if mujoco.mj_step(model, data) is None]
print(max(seen) - seen[0])
"""
)


class MujocoFile(RunningFile):
    """Raw model: a file as `MjModel.from_xml_path` loads it."""

    code = Reproductions(
        joints=_JOINTS,
        overlap=_OVERLAP,
        rest=_REST,
        push=_PUSH.replace("{off}", ""),
        push_alone=_PUSH.replace("{off}", _NO_CONTACTS),
        release=_RELEASE,
    )

    def __init__(self, urdf: Path, root: str) -> None:
        """Load it.

        Raises:
            Unloadable: MuJoCo does not open it.
            MovesFreely: It moves a link in other ways than by turning or sliding.
        """
        self._file, self._root = {"path": str(urdf)}, root
        try:
            self._model = mujoco.MjModel.from_xml_path(str(urdf))
        except ValueError as error:
            raise Unloadable(str(error), _OPEN.format(path=str(urdf))) from error
        if self._model.nq != self._model.nv or self._model.nv != self._model.njnt:
            raise MovesFreely(_OPEN.format(path=str(urdf)) + "print(model.jnt_type)\n")
        self._data, option = mujoco.MjData(self._model), self._model.opt
        self._flags, self._gravity = option.disableflags, option.gravity.copy()
        option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        self.joints = tuple(self._model.joint(k).name for k in range(self._model.njnt))
        ranges = zip(self.joints, self._model.jnt_limited, self._model.jnt_range.tolist(), strict=True)
        self.limits = {name: tuple(ends) if limited else (-np.inf, np.inf) for name, limited, ends in ranges}
        self.time_step = float(option.timestep)

    def _start(self, start: Start) -> None:
        model, data, option = self._model, self._data, self._model.opt
        option.disableflags, option.gravity[:] = self._flags, self._gravity
        mujoco.mj_resetData(model, data)
        data.qpos[:] = start.q
        mujoco.mj_forward(model, data)
        data.qvel[:] = start.v
        mujoco.mj_energyVel(model, data)
        option.disableflags |= 0 if start.contacts else int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        option.gravity[:] *= start.gravity

    def steps(self, count: int, every: int = 1) -> Iterator[int]:
        """Implement `RunningFile`."""
        for done in range(every, count + 1, every):
            mujoco.mj_step(self._model, self._data, nstep=every)
            yield done

    def state(self) -> tuple[FloatArray, FloatArray]:
        """Implement `RunningFile`."""
        return self._data.qpos.copy(), self._data.qvel.copy()

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Implement `RunningFile`."""
        self._data.qpos[:], self._data.qvel[:] = q, v

    def apply(self, joint: int, force: float) -> None:
        """Implement `RunningFile`."""
        self._data.qfrc_applied[joint] = force

    def energy(self) -> tuple[float, float]:
        """Implement `RunningFile`; of the state before the last step."""
        return float(self._data.energy[0]), float(self._data.energy[1])

    def touching(self) -> Iterator[tuple[str, str, float]]:
        """Implement `RunningFile`."""
        mujoco.mj_forward(self._model, self._data)
        for contact in self._data.contact:
            bodies = sorted(int(self._model.geom_bodyid[geom]) for geom in contact.geom)
            first, second = (self._model.body(body).name if body else self._root for body in bodies)
            yield first, second, -float(contact.dist)

    @property
    def complaint(self) -> str | None:
        """Warnings of numbers that are none."""
        bad = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
        broken = [item.name.removeprefix("mjWARN_") for item in bad if self._data.warning[item].number]
        return f"MuJoCo warns {', '.join(broken)}" if broken else None

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """Implement `RunningFile`."""
        self.begin(values, contacts=True)
        inverse = np.zeros((self._model.nv, self._model.nv))
        mujoco.mj_solveM(self._model, self._data, inverse, np.eye(self._model.nv))
        return np.asarray(1.0 / np.diagonal(inverse))

    def _links_in_code(self, links: tuple[str, str]) -> object:
        return sorted({"world" if name == self._root else name for name in links})
