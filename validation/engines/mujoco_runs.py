"""Runs of MuJoCo from rest, several at a time, and what became of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from mujoco import rollout

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray
    from kinematify.validation.engines.mujoco_model import MujocoModel

STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS


@dataclass(frozen=True, kw_only=True, eq=False)
class Trajectories:
    """States after every step of several runs; where the engine diverges, the last state stands to the end."""

    q: FloatArray
    """Values of all joints [rad or m], shape (runs, steps, J)."""
    v: FloatArray
    """Their speeds, shape (runs, steps, J)."""
    energy: FloatArray
    """Potential and kinetic [J], shape (runs, steps, 2)."""
    whole: tuple[int, ...]
    """Steps of each run before the engine gave up."""
    state: FloatArray
    """All of the engine's state, shape (runs, steps, s)."""
    warnings: tuple[tuple[str, ...], ...]
    """What the engine said when it gave up."""

    @property
    def steps(self) -> int:
        """Of every run."""
        return int(self.q.shape[1])


def simulate(
    loaded: MujocoModel, models: Sequence[mujoco.MjModel], start: FloatArray, control: FloatArray, *, threads: int
) -> Trajectories:
    """Run each model under its commands.

    Args:
        loaded: Where the joints stand.
        models: One per run, variants of `loaded.model`; the last two sensors are potential and kinetic energy.
        start: State from `start_state`.
        control: Shape (runs, steps, leaders).
        threads: At most.
    """
    states = np.repeat(start[None], len(models), axis=0)
    data = [mujoco.MjData(loaded.model) for _ in range(max(1, min(threads, len(models))))]
    with rollout.Rollout(nthread=len(data) if len(data) > 1 else 0) as pool:
        state, sensors = pool.rollout(list(models), data, states, control, chunk_size=1)
    whole = tuple(_whole(run[:, 0]) for run in state)
    size = loaded.model.nq
    return Trajectories(
        q=state[:, :, 1 + loaded.qpos],
        v=state[:, :, 1 + size + loaded.dof],
        energy=sensors[:, :, -2:],
        whole=whole,
        state=state,
        warnings=tuple(
            _warnings(model, np.vstack([start, state[run]]), control[run], steps) if steps < state.shape[1] else ()
            for run, (model, steps) in enumerate(zip(models, whole, strict=True))
        ),
    )


def start_state(loaded: MujocoModel, values: FloatArray) -> FloatArray:
    """Return the state at rest with the given values of all joints, shape (J,)."""
    data = mujoco.MjData(loaded.model)
    data.qpos[loaded.qpos] = values
    state = np.zeros(mujoco.mj_stateSize(loaded.model, STATE))
    mujoco.mj_getState(loaded.model, data, state, STATE)
    return state


def _whole(time: FloatArray) -> int:
    """Steps until the clock stands still."""
    stopped = np.flatnonzero(np.diff(time) <= 0.0)
    return int(stopped[0]) + 1 if len(stopped) else len(time)


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
    mujoco.mj_setState(model, data, states[first], STATE)
    for command in control[first : first + 2]:
        data.ctrl[:] = command
        mujoco.mj_step(model, data)
    return counted_warnings(data) or ("for no reason that it tells",)


def counted_warnings(data: mujoco.MjData) -> tuple[str, ...]:
    """Names of the warnings that were given, e.g. ``BADQACC``."""
    kinds = {int(kind): name.removeprefix("mjWARN_") for name, kind in mujoco.mjtWarning.__members__.items()}
    return tuple(kinds[k] for k, warning in enumerate(data.warning) if warning.number and k in kinds)


def around_fastest(runs: Trajectories, run: int, inertia: FloatArray) -> FloatArray:
    """Return the values of all joints before and after the step of a run with most motion, shape (2, J).

    Args:
        runs: At least two steps.
        run: Which one.
        inertia: What every joint moves, by which their speeds are weighed, shape (J,).
    """
    steps = max(2, runs.whole[run])
    step = 1 + int(np.argmax(runs.v[run, 1:steps] ** 2 @ inertia))
    return runs.q[run, step - 1 : step + 1]
