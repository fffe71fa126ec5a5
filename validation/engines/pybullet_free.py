"""Runs of PyBullet in which nothing is driven: held at rest, released, released with smaller steps, dropped."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet

from kinematify.validation.engines.configurations import GRAVITY
from kinematify.validation.engines.pybullet_drive import Motors, fastest_link

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.validation.engines.pybullet_drive import Bench
    from kinematify.validation.engines.pybullet_model import PybulletModel

_LOOKS = 24
"""Times at which speeds and energies are measured."""
_SLOW_SECONDS = 0.1
"""Time over which the speed at the end of a drop is measured."""
_FINER = 4
"""Small steps per step."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Free:
    """A run without commands."""

    q: FloatArray
    """Values of the leaders after every step that was sound, shape (steps, leaders)."""
    energy: FloatArray
    """Potential and kinetic [J] at some of them, shape (looks, 2)."""
    fastest: float
    """Largest speed of a link [m/s]."""
    diverged: bool


@dataclass(frozen=True, kw_only=True)
class Dropped:
    """The end of a drop."""

    depth: float
    """Of the deepest contact with the floor [m], negative above."""
    speed: float
    """Of the fastest link [m/s]."""
    diverged: bool


def hold(bench: Bench, model: PybulletModel, efforts: FloatArray) -> Free:
    """Hold the model at rest by motors no stronger than `efforts` [N m or N], shape (leaders,)."""
    Motors(model, bench).hold(efforts)
    return _run(bench, model, steps=_steps(bench, bench.settings.passive_seconds))


def release(bench: Bench, model: PybulletModel) -> Free:
    """Let the model go from rest, without motors, damping and friction."""
    model.place(bench.values_at_rest)
    model.release(ideal=True)
    return _run(bench, model, steps=_steps(bench, bench.settings.passive_seconds))


def release_finely(bench: Bench, model: PybulletModel) -> Free:
    """Release as in `release` with a quarter of the time step; the values are those at the same times as there."""
    bullet.setPhysicsEngineParameter(fixedTimeStep=bench.step / _FINER, physicsClientId=model.client)
    model.place(bench.values_at_rest)
    model.release(ideal=True)
    run = _run(bench, model, steps=_FINER * _steps(bench, bench.settings.passive_seconds))
    bullet.setPhysicsEngineParameter(fixedTimeStep=bench.step, physicsClientId=model.client)
    return replace(run, q=run.q[_FINER - 1 :: _FINER])


def _steps(bench: Bench, seconds: float) -> int:
    return max(2, round(seconds / bench.step))


def _run(bench: Bench, model: PybulletModel, *, steps: int) -> Free:
    leaders = [bench.mechanism.joints.index(travel.joint) for travel in bench.mechanism.travels]
    looks = set(np.linspace(0, steps - 1, _LOOKS).astype(int).tolist())
    values: list[list[float]] = []
    energies = [_energy(bench, model, *model.state()[:2])]
    fastest = 0.0
    for step in range(steps):
        bullet.stepSimulation(physicsClientId=model.client)
        q, v, _ = model.state()
        if not np.isfinite([q, v]).all():
            break
        values.append([q[column] for column in leaders])
        if step in looks:
            energies.append(_energy(bench, model, q, v))
            fastest = max(fastest, fastest_link(model))
    return Free(
        q=np.array(values).reshape(-1, len(leaders)),
        energy=np.array(energies),
        fastest=fastest,
        diverged=len(values) < steps,
    )


def _energy(bench: Bench, model: PybulletModel, q: list[float], v: list[float]) -> tuple[float, float]:
    """Potential energy of all links but the root, and kinetic energy [J]."""
    states, speeds = model.link_states(), np.array(v)
    links = [
        (name, index) for name, index in zip(model.mechanism.links, model.link.tolist(), strict=True) if index >= 0
    ]
    weights = [GRAVITY * bench.prepared.link_by_name[name].mass for name, _ in links]
    heights = [states[index][0][2] for _, index in links]
    inertia = bench.measuring.mass_matrix(np.array(q))
    return float(np.dot(weights, heights)), float(0.5 * speeds @ inertia @ speeds)


def drop(bench: Bench, model: PybulletModel) -> Dropped:
    """Let a model with a free base fall on a floor, its joints held."""
    client = model.client
    Motors(model, bench).hold(np.inf)
    height = _lowest(model) - bench.settings.drop
    shape = bullet.createCollisionShape(bullet.GEOM_PLANE, physicsClientId=client)
    floor = bullet.createMultiBody(0.0, shape, basePosition=[0.0, 0.0, height], physicsClientId=client)
    steps, window = _steps(bench, bench.settings.drop_seconds), _steps(bench, _SLOW_SECONDS)
    early = _centres(model)
    for step in range(steps):
        bullet.stepSimulation(physicsClientId=client)
        if step == steps - 1 - window:
            early = _centres(model)
    late = _centres(model)
    if not np.isfinite(late).all():
        return Dropped(depth=np.inf, speed=np.inf, diverged=True)
    near = bullet.getClosestPoints(model.body, floor, 1e-3, physicsClientId=client)
    margins = {index: float(model.margin[link]) for link, index in enumerate(model.link.tolist())}
    return Dropped(
        depth=max((-point[8] - margins[point[3]] for point in near), default=-1e-3),
        speed=float(np.linalg.norm(late - early, axis=1).max()) / (window * bench.step),
        diverged=False,
    )


def _lowest(model: PybulletModel) -> float:
    """Height of the lowest point of all collision shapes [m]; the boxes around them are a little too large."""
    heights: list[float] = [
        bullet.getAABB(model.body, index, physicsClientId=model.client)[0][2]
        for index in model.link.tolist()
        if bullet.getCollisionShapeData(model.body, index, physicsClientId=model.client)
    ]
    return min(heights)


def _centres(model: PybulletModel) -> FloatArray:
    """Centres of mass of all links, shape (L, 3)."""
    base, _ = bullet.getBasePositionAndOrientation(model.body, physicsClientId=model.client)
    return np.array([base, *(state[0] for state in model.link_states())])
