"""Runs of engines that Python steps: what is kept of every step, whatever the engine."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from kinematify.simulation.engine import SLOW_SECONDS, DriveRun, Dropped, FreeRun

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.servos import Drive

_FREE_LOOKS = 24
"""Times at which speeds and energies of a free run are measured."""


class SteppedWorld(Protocol):
    """A model in a world; a run is an iterator that yields the number of each step once it is done."""

    @property
    def mechanism(self) -> LeaderMechanism:
        """Its tree."""

    @property
    def failure(self) -> Sequence[str]:
        """Why the last run ended early; empty if it went on to the end."""

    def values(self) -> FloatArray:
        """Values of all joints [rad or m], shape (J,)."""

    def energy(self) -> tuple[float, float]:
        """Potential and kinetic [J]."""

    def fastest(self) -> float:
        """Largest speed of a link [m/s]."""

    def pressing(self) -> frozenset[tuple[int, int]]:
        """Pairs of bodies that press against each other, smaller index first."""


def count_steps(seconds: float, step: float) -> int:
    """Steps of so long a run."""
    return max(2, round(seconds / step))


def free_run(world: SteppedWorld, run: Iterable[int], count: int, *, every: int = 1) -> FreeRun:
    """Keep what a run shows in which nothing is driven.

    Args:
        world: Placed where the run begins.
        run: Not begun yet.
        count: Its steps.
        every: Values are kept of every so many steps.
    """
    leaders = [world.mechanism.joints.index(travel.joint) for travel in world.mechanism.travels]
    looks = set(np.linspace(0, count - 1, _FREE_LOOKS).astype(int).tolist())
    values, energies, fastest = [], [world.energy()], 0.0
    for step in run:
        values.append(world.values()[leaders])
        if step in looks:
            energies.append(world.energy())
            fastest = max(fastest, world.fastest())
    return FreeRun(
        q=np.array(values).reshape(-1, len(leaders))[every - 1 :: every],
        energy=np.array(energies),
        fastest=fastest,
        warnings=tuple(world.failure),
    )


def drive_run(world: SteppedWorld, run: Iterable[int], drive: Drive, force: Callable[[], float]) -> DriveRun:
    """Keep what a run shows in which one joint is driven.

    Args:
        world: Placed where the run begins.
        run: Not begun yet.
        drive: What is commanded.
        force: Of the servo that drives, after a step [N m or N].
    """
    looks = set(drive.looks.tolist())
    values, forces, fastest = [], [], 0.0
    pressed: frozenset[tuple[int, int]] = frozenset()
    for step in run:
        values.append(world.values())
        forces.append(force())
        if step in looks:
            fastest = max(fastest, world.fastest())
        if step == drive.arrived - 1:
            pressed = world.pressing()
    return DriveRun(
        q=np.array(values).reshape(-1, len(world.mechanism.joints)),
        force=np.array(forces),
        pressed=pressed,
        fastest=fastest,
        warnings=tuple(world.failure),
    )


def drop_run(
    world: SteppedWorld,
    run: Iterable[int],
    count: int,
    step: float,
    *,
    places: Callable[[], FloatArray],
    depth: Callable[[], float],
) -> Dropped:
    """Look at the end of a drop.

    Args:
        world: Placed above the floor.
        run: Not begun yet.
        count: Its steps.
        step: [s].
        places: Where all links are [m], shape (L, 3).
        depth: Of the lowest point below the floor [m].
    """
    window = count_steps(SLOW_SECONDS, step)
    early = places()
    for number in run:
        if number == count - 1 - window:
            early = places()
    late = places()
    if world.failure or not np.isfinite(late).all():
        return Dropped(depth=np.inf, speed=np.inf, warnings=tuple(world.failure))
    speed = float(np.linalg.norm(late - early, axis=1).max()) / (window * step)
    return Dropped(depth=depth(), speed=speed, warnings=())
