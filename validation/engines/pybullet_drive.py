"""Every joint driven through its range in PyBullet, one after the other."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet

from kinematify.robot.mechanism import sweep_rows
from kinematify.validation.engines.drive import drives, servos
from kinematify.validation.engines.outcome import Driven
from kinematify.validation.engines.pybullet_measure import measure
from kinematify.validation.engines.touching import Contacts, touching

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import Mechanism
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.engines.drive import Drive, Servos
    from kinematify.validation.engines.pybullet_measure import Measured
    from kinematify.validation.engines.pybullet_model import PybulletModel
    from kinematify.validation.engines.touching import Touching

_LOOKS = 16
"""Looks at the contacts on the way to an end."""
_DECIMALS = 6
"""Of joint values [rad or m] at which contacts are measured."""
_POSITION_GAIN = 0.2
"""Share of the error that a motor takes back per step: fast, and without overshoot."""
_UNLIMITED = 1e9
"""Force [N m or N] that no motion needs."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Bench:
    """What all runs share."""

    mechanism: Mechanism
    prepared: Prepared
    measuring: PybulletModel
    """Everything collides; only looked at."""
    sweep: Touching
    at_rest: frozenset[tuple[int, int]]
    """Pairs of links whose inflated shapes touch at rest. PyBullet knows no depth that a pair may have, so they do not
    act on each other in runs; how deep they get is measured beside."""
    servos: Servos
    force: FloatArray
    """What the motor of each leader may exert while it is driven [N m or N], shape (leaders,)."""
    settings: EngineSettings

    @property
    def values_at_rest(self) -> FloatArray:
        """Of all joints [rad or m], shape (J,)."""
        values: FloatArray = self.mechanism.all_values(self.mechanism.rest[None])[0]
        return values

    @property
    def step(self) -> float:
        """Time step [s]."""
        return self.settings.pybullet_time_step


def set_up(
    measuring: PybulletModel, prepared: Prepared, *, seen: Measured, sweep: Touching, settings: EngineSettings
) -> Bench:
    """Choose the servos.

    Args:
        measuring: The model in which everything collides.
        prepared: Its record.
        seen: What was measured along `Mechanism.sweep`.
        sweep: Its contacts.
        settings: Of the engines.
    """
    mechanism = measuring.mechanism
    infos = [bullet.getJointInfo(measuring.body, k, physicsClientId=measuring.client) for k in measuring.indices]
    resistance = np.array([[info[6] for info in infos], [info[7] for info in infos]]).reshape(2, -1)
    measuring.place(mechanism.all_values(mechanism.rest[None])[0])
    close = {(min(a, b), max(a, b)) for _, a, b, depth in measuring.contacts(0) if depth > 0.0}
    gains = servos(mechanism, seen.inertia[0], seen.gravity, resistance, settings)
    # A leader and its follower may balance each other's weight; here each is moved by a motor of its own.
    own = seen.gravity[:, [mechanism.joints.index(travel.joint) for travel in mechanism.travels]]
    unbalanced = np.abs(own - gains.holding).max(axis=0, initial=0.0)
    return Bench(
        mechanism=mechanism,
        prepared=prepared,
        measuring=measuring,
        sweep=sweep,
        at_rest=frozenset(close),
        servos=gains,
        force=gains.force + settings.servo_margin * unbalanced,
        settings=settings,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Session:
    """All drives and what was seen on the way."""

    driven: tuple[Driven, ...]
    sweep: Touching
    """The sweep, followed by the looks on the way: pairs that only met there are in it too."""
    diverged: tuple[int, ...]
    """Leaders of drives in which a value was no number any more."""
    fastest: tuple[tuple[int, float], ...]
    """Leader and largest speed of a link [m/s] of each drive."""
    left: int
    """Drives for which there was no time."""


def drive_all(bench: Bench, acting: PybulletModel, seen: Measured, remaining: Callable[[], float]) -> Session:
    """Drive every joint to both ends.

    Args:
        bench: As set up.
        acting: A model of its own; pairs act on each other in it only in drives in which they get too deep.
        seen: What was measured along `Mechanism.sweep`.
        remaining: Seconds that are left.
    """
    acting.silence()
    planned = drives(bench.mechanism, bench.settings, bench.step)
    records: list[_Record] = []
    for drive in planned:
        if remaining() <= 0.0:
            break
        records.append(_drive(bench, acting, drive))
    sound = [record for record in records if record.looks is not None]
    looks = [record.looks for record in sound if record.looks is not None]
    rows = np.concatenate(looks) if looks else np.zeros((0, len(bench.mechanism.joints)))
    # PyBullet finds boxes metres deep in each other where their edges are parallel but for the noise of a motor.
    looked = measure(bench.measuring, np.round(rows, _DECIMALS), dynamic=0, poses=False)
    sweep = _both(bench, seen.contacts, looked.contacts, len(sound))
    start = bench.sweep.depth.shape[1]
    return Session(
        driven=tuple(
            _driven(bench, record, sweep, sweep.excess[:, start + k * _LOOKS : start + (k + 1) * _LOOKS])
            for k, record in enumerate(sound)
        ),
        sweep=sweep,
        diverged=tuple(record.drive.leader for record in records if record.looks is None),
        fastest=tuple((record.drive.leader, record.fastest) for record in records),
        left=len(planned) - len(records),
    )


def _acting_pairs(bench: Bench, drive: Drive) -> list[tuple[int, int]]:
    """Pairs of links of the bodies that get too deep into each other on the way, but for those that touch at rest.

    Others are left out, because an inflated shape would stop a joint that slides past it within the tolerance.
    """
    travel, count = bench.mechanism.travels[drive.leader], bench.settings.sweep_samples
    values = np.linspace(travel.lower, travel.upper, count)
    ahead = values >= travel.rest if drive.end == travel.upper else values <= travel.rest
    excess = bench.sweep.excess[:, sweep_rows(drive.leader, count)][:, ahead]
    body = bench.mechanism.body_of_link
    pairs = [
        (int(a), int(b))
        for first, second in bench.sweep.bodies[(excess > 0.0).any(axis=1)].tolist()
        for a, b in product(np.flatnonzero(body == first), np.flatnonzero(body == second))
    ]
    return [pair for pair in pairs if (min(pair), max(pair)) not in bench.at_rest]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Record:
    """A drive without its contacts."""

    drive: Drive
    reached: float
    force: float
    lag: float
    beyond: float
    looks: FloatArray | None
    """Values of all joints on the way, the last where the joint stands at last, shape (_LOOKS, J); None: diverged."""
    way: FloatArray
    """Command, value [rad or m] and force of the driven joint at these looks, shape (3, looks)."""
    against: frozenset[tuple[int, int]]
    """Pairs of bodies that press against each other there, smaller index first."""
    fastest: float


def _drive(bench: Bench, acting: PybulletModel, drive: Drive) -> _Record:
    """Drive one joint by a motor that is no stronger than the motion needs; the others are held."""
    column = bench.mechanism.joints.index(bench.mechanism.travels[drive.leader].joint)
    force = float(bench.force[drive.leader])
    pairs = _acting_pairs(bench, drive)
    acting.act(pairs, on=True)
    motors = Motors(acting, bench)
    looks = set((np.linspace(drive.arrived / _LOOKS, drive.arrived, _LOOKS).astype(int) - 1).tolist())
    values, forces, seen, way, fastest = [], [], [], [], 0.0
    against: frozenset[tuple[int, int]] = frozenset()
    motors.hold(_UNLIMITED)
    for step, (target, speed) in enumerate(zip(drive.reference.tolist(), drive.speed.tolist(), strict=True)):
        motors.command(drive.leader, target, speed, force)
        bullet.stepSimulation(physicsClientId=acting.client)
        q, _, torques = acting.state()
        if not np.isfinite(q).all():
            break
        motors.follow(q)
        values.append(q[column])
        forces.append(abs(torques[column]))
        if step in looks:
            seen.append(q)
            way.append((drive.reference[step], q[column], torques[column]))
            fastest = max(fastest, fastest_link(acting))
        if step == drive.arrived - 1:
            against = acting.touching_bodies()
    acting.act(pairs, on=False)
    whole = len(values) == len(drive.reference)
    moved, outward = np.array(values), np.sign(drive.end - drive.reference[0])
    arrived = drive.arrived
    return _Record(
        drive=drive,
        reached=float(moved[arrived - 1]) if whole else np.nan,
        force=max(forces[:arrived], default=0.0),
        lag=float(np.abs(drive.reference[:arrived] - moved[:arrived]).max()) if whole else np.nan,
        beyond=float(np.max((outward or _side(bench, drive)) * (moved[arrived:] - drive.end))) if whole else np.nan,
        looks=np.array(seen) if whole else None,
        way=np.array(way).reshape(-1, 3).T,
        against=against,
        fastest=fastest,
    )


def _side(bench: Bench, drive: Drive) -> float:
    """Where a limit looks at which the joint rests."""
    return 1.0 if drive.end == bench.mechanism.travels[drive.leader].upper else -1.0


class Motors:
    """Position motors on all joints; followers follow what their leaders do, which PyBullet does not care for."""

    def __init__(self, model: PybulletModel, bench: Bench) -> None:
        """Place the model at rest."""
        self._model = model
        self._mechanism = bench.mechanism
        travels = bench.mechanism.travels
        self._columns = [bench.mechanism.joints.index(travel.joint) for travel in travels]
        self._followers = [k for k in range(len(bench.mechanism.joints)) if k not in self._columns]
        self._rest = bench.values_at_rest
        model.place(self._rest)

    def hold(self, force: float | FloatArray) -> None:
        """Hold all joints at rest, with one force or one for each leader [N m or N]; followers without limit."""
        forces = np.full(len(self._rest), _UNLIMITED)
        forces[self._columns] = np.minimum(force, _UNLIMITED)
        for column, value in enumerate(self._rest.tolist()):
            self._command(column, value, 0.0, float(forces[column]))

    def command(self, leader: int, target: float, speed: float, force: float) -> None:
        """Command one leader."""
        self._command(self._columns[leader], target, speed, force)

    def follow(self, q: list[float]) -> None:
        """Command the followers to where their leaders stand."""
        if self._followers:
            values = self._mechanism.all_values(np.array(q)[None, self._columns])[0]
            for column in self._followers:
                self._command(column, float(values[column]), 0.0, _UNLIMITED)

    def _command(self, column: int, target: float, speed: float, force: float) -> None:
        bullet.setJointMotorControl2(
            self._model.body,
            self._model.indices[column],
            bullet.POSITION_CONTROL,
            targetPosition=target,
            targetVelocity=speed,
            force=force,
            positionGain=_POSITION_GAIN,
            velocityGain=1.0,
            physicsClientId=self._model.client,
        )


def fastest_link(model: PybulletModel) -> float:
    """Return the largest speed of a centre of mass [m/s], infinite where it is no number."""
    speeds = np.array([state[6] for state in model.link_states()]).reshape(-1, 3)
    largest = float(np.linalg.norm(speeds, axis=1).max(initial=0.0))
    return largest if np.isfinite(largest) else np.inf


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


def _driven(bench: Bench, record: _Record, sweep: Touching, excess: FloatArray) -> Driven:
    """Put the contacts to a drive, which ends where a pair that does not act gets too deep.

    Args:
        bench: As set up.
        record: The drive.
        sweep: Pairs of bodies.
        excess: Of each at each look [m], shape (pairs, _LOOKS).
    """
    pressed = np.array([(a, b) in record.against for a, b in sweep.bodies.tolist()], dtype=bool)
    driven = Driven(
        drive=record.drive,
        reached=record.reached,
        force=record.force,
        lag=record.lag,
        beyond=record.beyond,
        excess=excess.max(axis=1),
        at_end=np.where(pressed, np.maximum(excess[:, -1], 0.0), excess[:, -1]),
        looks=np.vstack([record.way, excess.max(axis=0, initial=0.0)]),
    )
    body = bench.mechanism.body_of_link
    silent = {tuple(sorted((int(body[a]), int(body[b])))) for a, b in bench.at_rest}
    moved = bench.mechanism.moved[record.drive.leader]
    stops = np.array([(a, b) in silent and moved[a] != moved[b] for a, b in sweep.bodies.tolist()], dtype=bool)
    deep = np.flatnonzero((excess[stops] > 0.0).any(axis=0))
    if not len(deep) or record.looks is None:
        return driven
    first = int(deep[0])
    column = bench.mechanism.joints.index(bench.mechanism.travels[record.drive.leader].joint)
    return replace(
        driven,
        reached=float(record.looks[first, column]),
        excess=excess[:, : first + 1].max(axis=1),
        at_end=excess[:, first],
    )
