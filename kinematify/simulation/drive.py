"""One joint after the other driven through its range: servos, commands, and what became of it, whatever the engine."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.mechanism import sweep_rows
from kinematify.simulation.contacts import Contacts, touching

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import Mechanism, Travel
    from kinematify.simulation.contacts import Touching
    from kinematify.simulation.engine import DriveRun, PhysicsModel, Simulation
    from kinematify.simulation.prepared import Prepared

LOOKS = 16
"""Looks at the contacts on the way to an end."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Servos:
    """Position servos of the leading joints, scaled by what they move."""

    stiffness: FloatArray
    """[N m/rad or N/m], shape (leaders,)."""
    damping: FloatArray
    """Stiffness times s, shape (leaders,)."""
    force: FloatArray
    """What each may exert: its motion's need with a margin [N m or N], shape (leaders,)."""
    holding: FloatArray
    """Torques and forces that hold the model still in each row of the sweep, shape (rows, leaders)."""


def servos(
    mechanism: Mechanism,
    mass_matrix: FloatArray,
    gravity: FloatArray,
    resistance: FloatArray,
    settings: EngineSettings,
) -> Servos:
    """Return servos of equal frequency for all joints.

    Args:
        mechanism: The tree.
        mass_matrix: Of all joints at rest, shape (J, J).
        gravity: Torques that hold the model still along `Mechanism.sweep`, shape (rows, J).
        resistance: Damping and friction of all joints, as (damping, friction), shape (2, J).
        settings: Frequency and margin.
    """
    leads = mechanism.leads
    coupled = leads.T @ mass_matrix @ leads
    inertia = np.maximum(np.diag(coupled), np.finfo(np.float64).tiny)
    rate = 2.0 * np.pi * settings.servo_frequency
    way = np.array([max(t.upper - t.rest, t.rest - t.lower) for t in mechanism.travels])
    speed, acceleration = np.pi / settings.drive_seconds * way / 2.0, (np.pi / settings.drive_seconds) ** 2 * way / 2.0
    holding = gravity @ leads
    drag = (np.abs(leads).T ** 2 @ resistance[0]) * speed + np.abs(leads).T @ resistance[1]
    inertial = np.max(np.abs(coupled) * acceleration, axis=1, initial=0.0)
    need = np.max(np.abs(holding), axis=0, initial=0.0) + inertial + drag
    return Servos(
        stiffness=inertia * rate**2,
        damping=2.0 * inertia * rate,
        force=settings.servo_margin * need,
        holding=holding,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Drive:
    """One joint on its way from rest to one end, the others held."""

    leader: int
    """Index in `Mechanism.travels`."""
    end: float
    """[rad or m]."""
    reference: FloatArray
    """Commanded value per step [rad or m], shape (steps,)."""
    speed: FloatArray
    """Its derivative, shape (steps,)."""
    arrived: int
    """Step at which the way and the wait are over and the push begins."""

    @property
    def looks(self) -> IntArray:
        """Steps after which contacts are looked at, the last when the joint has arrived, shape (LOOKS,)."""
        return np.linspace(self.arrived / LOOKS, self.arrived, LOOKS).astype(np.int64) - 1


def drives(mechanism: Mechanism, settings: EngineSettings, step: float) -> tuple[Drive, ...]:
    """Return a drive to each end of every leading joint that has a way, all of the same number of steps."""
    return tuple(
        _drive(leader, travel, end, settings, step)
        for leader, travel in enumerate(mechanism.travels)
        if travel.range > 0.0
        for end in (travel.lower, travel.upper)
    )


def _drive(leader: int, travel: Travel, end: float, settings: EngineSettings, step: float) -> Drive:
    moving = max(1, round(settings.drive_seconds / step))
    waiting, pushing = (max(1, round(seconds / step)) for seconds in (settings.settle_seconds, settings.push_seconds))
    phase = np.pi * np.arange(1, moving + 1) / moving
    way = end - travel.rest
    beyond = settings.push * travel.range * (1.0 if end == travel.upper else -1.0) if travel.limited else 0.0
    reference = np.concatenate(
        [travel.rest + way * (1.0 - np.cos(phase)) / 2.0, np.full(waiting, end), np.full(pushing, end + beyond)]
    )
    speed = np.zeros_like(reference)
    speed[:moving] = way * np.sin(phase) / 2.0 * np.pi / (moving * step)
    return Drive(leader=leader, end=end, reference=reference, speed=speed, arrived=moving + waiting)


def commands(drive: Drive, mechanism: Mechanism, servos: Servos, samples: int) -> FloatArray:
    """Return what each servo is told per step, weight and speed made up for in advance, shape (steps, leaders)."""
    travel = mechanism.travels[drive.leader]
    places = np.linspace(travel.lower, travel.upper, samples)
    holding = servos.holding[sweep_rows(drive.leader, samples)]
    told = np.tile(mechanism.rest, (len(drive.reference), 1))
    told[:, drive.leader] = (
        drive.reference + drive.speed * servos.damping[drive.leader] / servos.stiffness[drive.leader]
    )
    for leader in range(told.shape[1]):
        told[:, leader] += np.interp(drive.reference, places, holding[:, leader]) / servos.stiffness[leader]
    return told


@dataclass(frozen=True, kw_only=True, eq=False)
class Driven:
    """How one drive went."""

    drive: Drive
    reached: float
    """Where the joint stands when way and wait are over [rad or m]."""
    force: float
    """The largest of its servo until then [N m or N]."""
    lag: float
    """The largest behind the command [rad or m]."""
    beyond: float
    """How far it gets beyond the limit at which it is pushed [rad or m]; negative if it does not get there."""
    excess: FloatArray
    """How much deeper than allowed each pair of `DriveSession.sweep` gets on the way [m], shape (pairs,)."""
    at_end: FloatArray
    """The same where the joint stands at last, shape (pairs,)."""
    looks: FloatArray
    """What is drawn of the way: command, value [rad or m], force [N m or N] and depth beyond what is allowed [m] at
    each look, shape (4, LOOKS)."""


@dataclass(frozen=True, kw_only=True)
class DriveEnd:
    """How a drive ended."""

    drive: Drive
    fastest: float
    """Largest speed of a link [m/s]."""
    warnings: tuple[str, ...]
    """Why the engine gave up; empty if it went on to the end."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DriveSession:
    """All drives and what was seen on the way."""

    driven: tuple[Driven, ...]
    """Those that the engine brought to an end."""
    sweep: Touching
    """The sweep, followed by the looks on the way: pairs that only met there are in it too."""
    ends: tuple[DriveEnd, ...]
    left: int
    """Drives for which there was no time."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Record:
    """A drive without its contacts."""

    drive: Drive
    reached: float
    force: float
    lag: float
    beyond: float
    looks: FloatArray
    """Values of all joints on the way, shape (LOOKS, J)."""
    way: FloatArray
    """Command, value [rad or m] and force of the driven joint at these looks, shape (3, LOOKS)."""
    pressed: frozenset[tuple[int, int]]


def drive_all(
    simulation: Simulation,
    model: PhysicsModel,
    mechanism: Mechanism,
    prepared: Prepared,
    *,
    seen: Contacts,
    sweep: Touching,
    settings: EngineSettings,
    remaining: Callable[[], float],
) -> DriveSession:
    """Drive every joint to both ends.

    Args:
        simulation: Where it is driven.
        model: Where contacts are looked at.
        mechanism: The tree.
        prepared: Its record.
        seen: Contacts along `Mechanism.sweep`.
        sweep: The same by bodies.
        settings: Of the engines.
        remaining: Seconds that are left.
    """
    planned = drives(mechanism, settings, simulation.step)
    records: list[_Record] = []
    ends: list[DriveEnd] = []
    for start in range(0, len(planned), simulation.batch):
        if remaining() <= 0.0:
            break
        some = planned[start : start + simulation.batch]
        for drive, run in zip(some, simulation.drive(some), strict=True):
            ends.append(DriveEnd(drive=drive, fastest=run.fastest, warnings=run.warnings))
            if len(run.q) == len(drive.reference):
                records.append(_record(mechanism, drive, run))
    looks = np.array([record.looks for record in records]).reshape(-1, len(mechanism.joints))
    rows = sweep.depth.shape[1]
    together = _both(seen, model.contacts(looks), rows)
    sweep = touching(together, mechanism, prepared, rows=rows + len(looks), tolerance=sweep.tolerance)
    return DriveSession(
        driven=tuple(
            _driven(mechanism, record, sweep, sweep.excess[:, rows + k * LOOKS : rows + (k + 1) * LOOKS], model.silent)
            for k, record in enumerate(records)
        ),
        sweep=sweep,
        ends=tuple(ends),
        left=len(planned) - len(ends),
    )


def _record(mechanism: Mechanism, drive: Drive, run: DriveRun) -> _Record:
    travel = mechanism.travels[drive.leader]
    moved = run.q[:, mechanism.joints.index(travel.joint)]
    arrived, looks = drive.arrived, drive.looks
    outward = 1.0 if drive.end == travel.upper else -1.0
    return _Record(
        drive=drive,
        reached=float(moved[arrived - 1]),
        force=float(np.abs(run.force[:arrived]).max()),
        lag=float(np.abs(drive.reference - moved)[:arrived].max()),
        beyond=float(np.max(outward * (moved[arrived:] - drive.end))),
        looks=run.q[looks],
        way=np.stack([drive.reference[looks], moved[looks], run.force[looks]]),
        pressed=run.pressed,
    )


def _both(sweep: Contacts, looked: Contacts, rows: int) -> Contacts:
    return Contacts(
        row=np.concatenate([sweep.row, rows + looked.row]),
        links=np.concatenate([sweep.links, looked.links]),
        depth=np.concatenate([sweep.depth, looked.depth]),
    )


def _driven(
    mechanism: Mechanism, record: _Record, sweep: Touching, excess: FloatArray, silent: Iterable[tuple[int, int]]
) -> Driven:
    """Put the contacts to a drive, which ends where a pair that does not act gets too deep.

    Args:
        mechanism: The tree.
        record: The drive.
        sweep: Pairs of bodies.
        excess: Of each at each look [m], shape (pairs, LOOKS).
        silent: Pairs of links that do not act.
    """
    reached, looks = record.reached, np.vstack([record.way, excess.max(axis=0, initial=0.0)])
    pressed = np.array([(a, b) in record.pressed for a, b in sweep.bodies.tolist()], dtype=bool)
    at_end = np.where(pressed, np.maximum(excess[:, -1], 0.0), excess[:, -1])
    body, moved = mechanism.body_of_link, mechanism.moved[record.drive.leader]
    quiet = {tuple(sorted((int(body[a]), int(body[b])))) for a, b in silent}
    stops = np.array([(a, b) in quiet and moved[a] != moved[b] for a, b in sweep.bodies.tolist()], dtype=bool)
    deep = np.flatnonzero((excess[stops] > 0.0).any(axis=0))
    if len(deep):
        excess = excess[:, : int(deep[0]) + 1]
        at_end, reached = excess[:, -1], float(record.way[1, deep[0]])
    return Driven(
        drive=record.drive,
        reached=reached,
        force=record.force,
        lag=record.lag,
        beyond=record.beyond,
        excess=excess.max(axis=1),
        at_end=at_end,
        looks=looks,
    )


def acting_pairs(
    mechanism: Mechanism, sweep: Touching, drive: Drive, silent: frozenset[tuple[int, int]], samples: int
) -> list[tuple[int, int]]:
    """Return the pairs of links of the bodies that get too deep into each other on the way, but for silent ones.

    Where an engine knows no depth that a pair may have, only these act on each other in a drive: others would stop a
    joint that slides past them within the tolerance.

    Args:
        mechanism: The tree.
        sweep: Along `Mechanism.sweep`.
        drive: One of `drives`.
        silent: Pairs of links, smaller index first.
        samples: Of each joint in the sweep.
    """
    travel = mechanism.travels[drive.leader]
    values = np.linspace(travel.lower, travel.upper, samples)
    ahead = values >= travel.rest if drive.end == travel.upper else values <= travel.rest
    excess = sweep.excess[:, sweep_rows(drive.leader, samples)][:, ahead]
    body = mechanism.body_of_link
    pairs = [
        (int(a), int(b))
        for first, second in sweep.bodies[(excess > 0.0).any(axis=1)].tolist()
        for a, b in product(np.flatnonzero(body == first), np.flatnonzero(body == second))
    ]
    return [pair for pair in pairs if (min(pair), max(pair)) not in silent]
