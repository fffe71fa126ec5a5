"""Runs of MuJoCo in which nothing is driven: held at rest, released, released with smaller steps, dropped."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.validation.engines.mujoco_model import (
    compiled,
    limited_servos,
    released,
    set_servos,
    with_allowances,
    with_floor,
    with_servos,
)
from kinematify.validation.engines.mujoco_runs import STATE, simulate, start_state

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.validation.engines.mujoco_drive import Bench
    from kinematify.validation.engines.mujoco_model import MujocoModel, Source
    from kinematify.validation.engines.mujoco_runs import Trajectories

_SLOW_SECONDS = 0.1
"""Time over which the speed at the end of a drop is measured."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Dropped:
    """The end of a drop."""

    depth: float
    """Of the lowest point below the floor [m], negative above."""
    speed: float
    """Of the fastest link [m/s]."""
    warnings: tuple[str, ...]


def hold_and_release(bench: Bench, efforts: FloatArray) -> Trajectories:
    """Run 0: held at rest by servos no stronger than `efforts`; run 1: without servos, damping and friction."""
    model = bench.everything.model
    steps = _steps(bench.settings.passive_seconds, model)
    control = np.repeat(_held(bench)[None, None], 2, axis=0).repeat(steps, axis=1)
    start = start_state(bench.everything, bench.values_at_rest)
    models = [limited_servos(model, efforts), released(model)]
    return simulate(bench.everything, models, start, control, threads=bench.threads)


def release_finely(bench: Bench) -> Trajectories:
    """Release as in `hold_and_release` with a quarter of the time step; every fourth state belongs to one there."""
    fine = copy(released(bench.everything.model))
    fine.opt.timestep /= 4.0
    control = np.zeros((1, 4 * _steps(bench.settings.step_seconds, bench.everything.model), fine.nu))
    start = start_state(bench.everything, bench.values_at_rest)
    return simulate(bench.everything, [fine], start, control, threads=1)


def drop(bench: Bench, source: Source) -> Dropped:
    """Let the model fall on a floor, its joints held."""
    lowest = lowest_point(bench.measuring.model, _data_at(bench.measuring, bench.values_at_rest))
    servoed = with_servos(source)
    allowed = with_allowances(servoed, bench.measuring, bench.sweep, only=False)
    loaded = compiled(with_floor(allowed, height=lowest - bench.settings.drop, tolerance=bench.sweep.tolerance))
    set_servos(loaded.model, bench.servos.stiffness, bench.servos.damping)
    steps = _steps(bench.settings.drop_seconds, loaded.model)
    control = np.repeat(_held(bench)[None, None], steps, axis=1)
    run = simulate(loaded, [loaded.model], start_state(loaded, bench.values_at_rest), control, threads=1)
    window = _steps(_SLOW_SECONDS, loaded.model)
    early, late = (_data_of(loaded, state) for state in (run.state[0, -1 - window], run.state[0, -1]))
    moved = np.linalg.norm(late.xpos[loaded.body] - early.xpos[loaded.body], axis=1)
    return Dropped(
        depth=lowest - bench.settings.drop - lowest_point(loaded.model, late),
        speed=float(moved.max()) / _SLOW_SECONDS,
        warnings=run.warnings[0],
    )


def _held(bench: Bench) -> FloatArray:
    """Commands that hold the joints at rest, their weight made up for, shape (leaders,)."""
    commands: FloatArray = bench.mechanism.rest + bench.servos.holding[0] / bench.servos.stiffness
    return commands


def _steps(seconds: float, model: mujoco.MjModel) -> int:
    return max(2, round(seconds / float(model.opt.timestep)))


def _data_at(loaded: MujocoModel, values: FloatArray) -> mujoco.MjData:
    return _data_of(loaded, start_state(loaded, values))


def _data_of(loaded: MujocoModel, state: FloatArray) -> mujoco.MjData:
    data = mujoco.MjData(loaded.model)
    mujoco.mj_setState(loaded.model, data, state, STATE)
    mujoco.mj_kinematics(loaded.model, data)
    return data


def lowest_point(model: mujoco.MjModel, data: mujoco.MjData) -> float:
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
