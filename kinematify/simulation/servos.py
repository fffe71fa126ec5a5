"""Servos of the joints, and their targets on the way from rest to either end of a range."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.mechanism import sweep_rows

if TYPE_CHECKING:
    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import LeaderMechanism, Travel
    from kinematify.simulation.contacts import Touching

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
    resistance: FloatArray
    """Damping and friction of the joints that each moves, as (damping, friction), shape (2, leaders)."""


def servos(
    mechanism: LeaderMechanism,
    mass_matrix: FloatArray,
    gravity: FloatArray,
    resistance: FloatArray,
    settings: EngineSettings,
) -> Servos:
    """Return servos of equal frequency for all joints.

    Args:
        mechanism: The tree.
        mass_matrix: Of all joints at rest, shape (J, J).
        gravity: Torques that hold the model still along `LeaderMechanism.sweep`, shape (rows, J).
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
    drag = np.stack([np.abs(leads).T ** 2 @ resistance[0], np.abs(leads).T @ resistance[1]])
    inertial = np.max(np.abs(coupled) * acceleration, axis=1, initial=0.0)
    need = np.max(np.abs(holding), axis=0, initial=0.0) + inertial + drag[0] * speed + drag[1]
    return Servos(
        stiffness=inertia * rate**2,
        damping=2.0 * inertia * rate,
        force=settings.servo_margin * need,
        holding=holding,
        resistance=drag,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Drive:
    """One joint on its way from rest to one end, the others held."""

    leader: int
    """Index in `LeaderMechanism.travels`."""
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


def drives(mechanism: LeaderMechanism, settings: EngineSettings, step: float) -> tuple[Drive, ...]:
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


def commands(drive: Drive, mechanism: LeaderMechanism, servos: Servos, samples: int) -> FloatArray:
    """Return the target of each servo per step, shape (steps, leaders); weight and resistance are made up for."""
    travel = mechanism.travels[drive.leader]
    places = np.linspace(travel.lower, travel.upper, samples)
    holding = servos.holding[sweep_rows(drive.leader, samples)]
    targets = np.tile(mechanism.rest, (len(drive.reference), 1))
    damping, friction = servos.resistance[:, drive.leader]
    ahead = drive.speed * (servos.damping[drive.leader] + damping) + friction * np.sign(drive.speed)
    targets[:, drive.leader] = drive.reference + ahead / servos.stiffness[drive.leader]
    for leader in range(targets.shape[1]):
        targets[:, leader] += np.interp(drive.reference, places, holding[:, leader]) / servos.stiffness[leader]
    return targets


def acting_pairs(
    mechanism: LeaderMechanism, sweep: Touching, drive: Drive, ignored_pairs: frozenset[tuple[int, int]], samples: int
) -> list[tuple[int, int]]:
    """Return the pairs of links of the bodies that get too deep into each other on the way, but for ignored ones.

    Where an engine knows no depth that a pair may have, only these act on each other in a drive: others would stop a
    joint that slides past them within the tolerance.

    Args:
        mechanism: The tree.
        sweep: Along `LeaderMechanism.sweep`.
        drive: One of `drives`.
        ignored_pairs: Pairs of links, smaller index first.
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
    return [pair for pair in pairs if (min(pair), max(pair)) not in ignored_pairs]
