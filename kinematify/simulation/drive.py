"""One joint after the other driven through its range, and what became of it, whatever the engine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.simulation.contacts import Contacts, touching
from kinematify.simulation.servos import LOOKS, drives

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.contacts import Touching
    from kinematify.simulation.engine import DriveRun, PhysicsModel, Simulation
    from kinematify.simulation.prepared import Prepared
    from kinematify.simulation.servos import Drive


@dataclass(frozen=True, kw_only=True, eq=False)
class Driven:
    """Result of one drive."""

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
    rows: tuple[int, ...]
    """Rows of `DriveSession.sweep` on its way."""
    values: FloatArray
    """Of all joints at each look [rad or m], shape (LOOKS, J)."""
    looks: FloatArray
    """What is drawn of the way: command, value [rad or m], force [N m or N] and depth beyond what is allowed [m] at
    each look, shape (4, LOOKS)."""


@dataclass(frozen=True, kw_only=True)
class DriveEnd:
    """Reason why a drive ended."""

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
    mechanism: LeaderMechanism,
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
        seen: Contacts along `LeaderMechanism.sweep`.
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
            _driven(mechanism, record, sweep, range(rows + k * LOOKS, rows + (k + 1) * LOOKS), model.ignored_pairs)
            for k, record in enumerate(records)
        ),
        sweep=sweep,
        ends=tuple(ends),
        left=len(planned) - len(ends),
    )


def _record(mechanism: LeaderMechanism, drive: Drive, run: DriveRun) -> _Record:
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
    mechanism: LeaderMechanism, record: _Record, sweep: Touching, rows: range, ignored_pairs: Iterable[tuple[int, int]]
) -> Driven:
    """Put the contacts to a drive, which ends where a pair that does not act gets too deep.

    Args:
        mechanism: The tree.
        record: The drive.
        sweep: Pairs of bodies.
        rows: Of the sweep, its looks.
        ignored_pairs: Pairs of links that do not act.
    """
    excess = sweep.excess[:, rows.start : rows.stop]
    reached, looks = record.reached, np.vstack([record.way, excess.max(axis=0, initial=0.0)])
    pressed = np.array([(a, b) in record.pressed for a, b in sweep.bodies.tolist()], dtype=bool)
    at_end = np.where(pressed, np.maximum(excess[:, -1], 0.0), excess[:, -1])
    body, moved = mechanism.body_of_link, mechanism.moved[record.drive.leader]
    quiet = {tuple(sorted((int(body[a]), int(body[b])))) for a, b in ignored_pairs}
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
        rows=tuple(rows[: excess.shape[1]]),
        values=record.looks,
        looks=looks,
    )
