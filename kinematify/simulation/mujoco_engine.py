"""Every joint driven through its range in MuJoCo, several at a time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.engines.drive import commands, drives, servos
from kinematify.validation.engines.mujoco_measure import measure
from kinematify.validation.engines.mujoco_model import (
    compiled,
    limited_servos,
    set_servos,
    with_allowances,
    with_servos,
)
from kinematify.validation.engines.mujoco_runs import around_fastest, simulate, start_state
from kinematify.validation.engines.outcome import Driven
from kinematify.validation.engines.touching import Contacts, touching

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import Mechanism
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.engines.drive import Drive, Servos
    from kinematify.validation.engines.mujoco_measure import Measured
    from kinematify.validation.engines.mujoco_model import MujocoModel, Source
    from kinematify.validation.engines.mujoco_runs import Trajectories
    from kinematify.validation.engines.touching import Touching

_LOOKS = 16
"""Looks at the contacts on the way to an end."""
_NUMBERS = 20_000_000
"""Numbers in the states of runs that are kept at a time."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Bench:
    """The models in which runs take place, with servos of the same gains."""

    mechanism: Mechanism
    prepared: Prepared
    measuring: MujocoModel
    """Everything collides at any depth; only looked at."""
    sweep: Touching
    acting: MujocoModel
    """Only pairs that can meet while one joint moves act on each other."""
    everything: MujocoModel
    """All pairs act on each other, beyond what they are allowed."""
    servos: Servos
    inertia: FloatArray
    """What every joint moves at rest [kg m^2 or kg], shape (J,)."""
    settings: EngineSettings
    threads: int

    @property
    def values_at_rest(self) -> FloatArray:
        """Of all joints [rad or m], shape (J,)."""
        values: FloatArray = self.mechanism.all_values(self.mechanism.rest[None])[0]
        return values


def set_up(
    source: Source,
    prepared: Prepared,
    *,
    measuring: MujocoModel,
    seen: Measured,
    sweep: Touching,
    settings: EngineSettings,
    threads: int,
) -> Bench:
    """Compile the models for runs.

    Args:
        source: As parsed.
        prepared: Its record.
        measuring: The same, compiled.
        seen: What was measured along `Mechanism.sweep`.
        sweep: Its contacts.
        settings: Of the engines.
        threads: At most.
    """
    dof = measuring.dof
    gains = servos(
        source.mechanism,
        seen.inertia[0],
        seen.gravity,
        np.array([measuring.model.dof_damping[dof], measuring.model.dof_frictionloss[dof]]),
        settings,
    )
    servoed = with_servos(source)
    acting, everything = (compiled(with_allowances(servoed, measuring, sweep, only=only)) for only in (True, False))
    for loaded in (acting, everything):
        set_servos(loaded.model, gains.stiffness, gains.damping)
    return Bench(
        mechanism=source.mechanism,
        prepared=prepared,
        measuring=measuring,
        sweep=sweep,
        acting=acting,
        everything=everything,
        servos=gains,
        inertia=np.diag(seen.inertia[0]),
        settings=settings,
        threads=threads,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Session:
    """All drives and what was seen on the way."""

    driven: tuple[Driven, ...]
    sweep: Touching
    """The sweep, followed by the looks on the way: pairs that only met there are in it too."""
    fastest: tuple[float, ...]
    """Largest speed of a link's frame in each [m/s]."""
    warnings: tuple[tuple[str, ...], ...]
    """What MuJoCo said when it gave up, for each."""
    left: int
    """Drives for which there was no time."""


def drive_all(bench: Bench, seen: Measured, remaining: Callable[[], float]) -> Session:
    """Drive every joint to both ends."""
    step = float(bench.acting.model.opt.timestep)
    planned = drives(bench.mechanism, bench.settings, step)
    numbers = max((len(drive.reference) for drive in planned), default=1) * (2 * len(bench.mechanism.joints) + 3)
    batch = max(2 * bench.threads, _NUMBERS // numbers)
    records: list[_Record] = []
    for start in range(0, len(planned), batch):
        if remaining() <= 0.0:
            break
        records += _drive(bench, planned[start : start + batch])
    if not records:
        return Session(driven=(), sweep=bench.sweep, fastest=(), warnings=(), left=len(planned))
    fastest = np.concatenate([record.fastest for record in records])
    around = measure(bench.measuring, fastest, dynamic=0, threads=bench.threads).T_world_link[..., :3, 3]
    looked = measure(
        bench.measuring,
        np.concatenate([record.looks for record in records]),
        dynamic=0,
        threads=bench.threads,
    )
    sweep = _both(bench, seen.contacts, looked.contacts, len(records))
    rows = bench.sweep.depth.shape[1]
    return Session(
        driven=tuple(
            _driven(record, sweep.excess[:, rows + k * _LOOKS : rows + (k + 1) * _LOOKS])
            for k, record in enumerate(records)
        ),
        sweep=sweep,
        fastest=tuple(
            float(np.linalg.norm(around[2 * k + 1] - around[2 * k], axis=1).max()) / step for k in range(len(records))
        ),
        warnings=tuple(record.warnings for record in records),
        left=len(planned) - len(records),
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Record:
    """A drive without its contacts."""

    drive: Drive
    reached: float
    force: float
    lag: float
    beyond: float
    looks: FloatArray
    """Values of all joints on the way, the last where the joint stands at last, shape (_LOOKS, J)."""
    way: FloatArray
    """Command, value [rad or m] and force of the driven joint at these looks, shape (3, _LOOKS)."""
    fastest: FloatArray
    """Values of all joints right before and after the step with most motion, shape (2, J)."""
    warnings: tuple[str, ...]


def _drive(bench: Bench, planned: Sequence[Drive]) -> list[_Record]:
    """Run some drives at a time; the servo that is driven is no stronger than its motion needs."""
    samples = bench.settings.sweep_samples
    models = []
    for drive in planned:
        forces = np.full(len(bench.mechanism.travels), np.inf)
        forces[drive.leader] = bench.servos.force[drive.leader]
        models.append(limited_servos(bench.acting.model, forces))
    control = np.stack([commands(drive, bench.mechanism, bench.servos, samples) for drive in planned])
    start = start_state(bench.acting, bench.values_at_rest)
    runs = simulate(bench.acting, models, start, control, threads=bench.threads)
    return [_record(bench, drive, runs, k, control[k]) for k, drive in enumerate(planned)]


def _record(bench: Bench, drive: Drive, runs: Trajectories, run: int, control: FloatArray) -> _Record:
    travel = bench.mechanism.travels[drive.leader]
    column = bench.mechanism.joints.index(travel.joint)
    q, v = runs.q[run, :, column], runs.v[run, :, column]
    told = control[:, drive.leader]
    force = bench.servos.stiffness[drive.leader] * (told - q) - bench.servos.damping[drive.leader] * v
    strongest = bench.servos.force[drive.leader]
    arrived, way = drive.arrived, slice(0, drive.arrived)
    outward = 1.0 if drive.end == travel.upper else -1.0
    looks = np.linspace(arrived / _LOOKS, arrived, _LOOKS).astype(int) - 1
    return _Record(
        drive=drive,
        reached=float(q[arrived - 1]),
        force=float(np.abs(np.clip(force[way], -strongest, strongest)).max()),
        lag=float(np.abs(drive.reference - q)[way].max()),
        beyond=float(np.max(outward * (q[arrived:] - drive.end))),
        looks=runs.q[run, looks],
        way=np.stack([drive.reference[looks], q[looks], np.clip(force[looks], -strongest, strongest)]),
        fastest=around_fastest(runs, run, bench.inertia),
        warnings=runs.warnings[run],
    )


def _both(bench: Bench, sweep: Contacts, looked: Contacts, runs: int) -> Touching:
    rows = bench.sweep.depth.shape[1]
    together = Contacts(
        row=np.concatenate([sweep.row, rows + looked.row]),
        links=np.concatenate([sweep.links, looked.links]),
        depth=np.concatenate([sweep.depth, looked.depth]),
    )
    return touching(
        together, bench.mechanism, bench.prepared, rows=rows + runs * _LOOKS, tolerance=bench.sweep.tolerance
    )


def _driven(record: _Record, excess: FloatArray) -> Driven:
    return Driven(
        drive=record.drive,
        reached=record.reached,
        force=record.force,
        lag=record.lag,
        beyond=record.beyond,
        excess=excess.max(axis=1),
        at_end=excess[:, -1],
        looks=np.vstack([record.way, excess.max(axis=0, initial=0.0)]),
    )
