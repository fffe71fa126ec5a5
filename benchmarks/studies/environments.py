"""How fast and how robust are the environments, and do hand-written policies solve them?

Hand-written policies and random actions meet objects that are drawn again in each episode (`randomize=True`). Speed is
measured beside MuJoCo's own loop.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from functools import partial
from operator import itemgetter
from typing import TYPE_CHECKING, Annotated, Any

import gymnasium
import mujoco
import numpy as np
from pydantic import Field

from benchmarks.study import Options, Study, among, explained
from kinematify.envs import DRAWER_PULL, OPEN_PART
from kinematify.envs.bundled import BUNDLED, DRAWERS
from kinematify.envs.expert import ArmExpert, HandExpert
from kinematify.evaluation.result_record import grouped, table

if TYPE_CHECKING:
    from collections.abc import Callable

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report

_SPEED_MODELS = ("drawers", "cabinet", "microwave")
_PARTS = {
    "expert": "Hand-written policies, `randomize=True`",
    "speed": "Steps per second, one step is 25 sub-steps of 2 ms",
    "random": "Random actions, `randomize=True`",
}
_COLUMNS = {
    "expert": ("id", "object", "joint", "seeds", "success", "thrown", "return", "depth_mm", "warnings"),
    "speed": ("object", "env", "loop", "ratio", "single", "to single", "sync", "batched", "batched over sync"),
    "random": (
        "object", "steps", "episodes", "nan", "unstable", "escaped", "warned episodes", "depth_mm", "beyond_range",
    ),
}  # fmt: skip


class EnvironmentsOptions(Options):
    """How much of each."""

    parts: Annotated[tuple[str, ...], among(_PARTS)] = Field(
        tuple(_PARTS), description="Some of expert, speed, random, separated by commas."
    )
    seeds: int = Field(100, ge=1, description="Episodes of a hand-written policy per object.")
    seconds: float = Field(12.0, gt=0.0, description="Time for which the speed of an object is measured.")
    steps: int = Field(1_000_000, ge=1, description="Random actions, on all objects together.")


@dataclass(frozen=True, kw_only=True)
class Episodes:
    """Episodes of the expert of one environment on one object."""

    env_id: str
    object: str
    seeds: int


@dataclass(frozen=True, kw_only=True)
class Amount:
    """One object, and for how long: seconds or steps."""

    object: str
    amount: float


def measure(options: EnvironmentsOptions, work: Work) -> Measured:
    """Run the parts that are asked for."""
    solved = {
        f"{DRAWER_PULL} {name}": Episodes(env_id=DRAWER_PULL, object=name, seeds=options.seeds) for name in DRAWERS
    }
    solved |= {f"{OPEN_PART} {name}": Episodes(env_id=OPEN_PART, object=name, seeds=options.seeds) for name in BUNDLED}
    timed = {name: Amount(object=name, amount=options.seconds) for name in _SPEED_MODELS}
    pushed = {name: Amount(object=name, amount=options.steps // len(BUNDLED)) for name in BUNDLED}
    runs: dict[str, Callable[[], dict[str, Record]]] = {
        "expert": lambda: work.each(solved_by_expert, solved),
        "speed": lambda: work.each(steps_per_second, timed, workers=1),
        "random": lambda: work.each(pushed_at_random, pushed),
    }
    load = os.getloadavg()[0]
    records = [{"part": part, **record} for part in options.parts for record in runs[part]().values()]
    return records, {"cores": len(os.sched_getaffinity(0)), "load": load}


def solved_by_expert(asked: Episodes) -> Record:
    """Success of a hand-written policy over seeds."""
    env = gymnasium.make(asked.env_id, model=f"bundled:{asked.object}", randomize=True, terminate_on_success=True)
    bare: Any = env.unwrapped
    policy = (ArmExpert if asked.env_id == DRAWER_PULL else HandExpert)(bare)
    start = time.perf_counter()
    ends = [_episode(env, policy, seed) for seed in range(asked.seeds)]
    record = {
        "id": asked.env_id,
        "object": asked.object,
        "joint": bare.target.joint,
        "seeds": asked.seeds,
        "success": float(np.mean([end["is_success"] for end in ends])),
        "thrown": float(np.mean([end["thrown"] for end in ends])),
        "return": float(np.mean([end["return"] for end in ends])),
        "depth_mm": 1e3 * max(end["deepest"] for end in ends),
        "warnings": sum(bool(end["warnings"]) for end in ends),
        "seconds": time.perf_counter() - start,
    }
    env.close()
    return record


def _episode(env: gymnasium.Env[Any, Any], policy: Any, seed: int) -> Record:
    observation, info = env.reset(seed=seed)
    policy.begin()
    total, deepest, over = 0.0, 0.0, False
    while not over:
        observation, reward, terminated, truncated, info = env.step(policy.act(observation))
        total, deepest = total + float(reward), max(deepest, info["max_penetration"])
        over = terminated or truncated
    return {**info, "return": total, "deepest": deepest}


def steps_per_second(asked: Amount) -> Record:
    """Steps per second of one environment, of MuJoCo's loop with the same sub-steps, and of sixteen at once."""
    single, batched = _single_speed(asked.object, asked.amount), _batched_speed(asked.object, asked.amount)
    return {"object": asked.object, **single, **batched}


def _single_speed(name: str, seconds: float) -> dict[str, float]:
    """The same pushes from the same starts, in short turns and by processor time, so that other load counts little."""
    env = gymnasium.make(OPEN_PART, model=f"bundled:{name}")
    bare: Any = env.unwrapped
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (99, 3)).astype(np.float32)
    world, substeps = bare.world, bare.settings.time.substeps
    steps: dict[str, Callable[[Any], Any]] = {
        "env": env.step,
        "loop": partial(_native, world, substeps),
        "single": partial(_one_by_one, world, substeps),
    }
    rates: list[list[float]] = []
    start = time.perf_counter()
    while time.perf_counter() - start < seconds or len(rates) < 10:
        rates.append([])
        for step in steps.values():
            env.reset(seed=len(rates))
            begun = time.process_time()
            for action in actions:
                step(action)
            rates[-1].append(len(actions) / (time.process_time() - begun))
    columns = np.array(rates)
    return {
        **dict(zip(steps, np.median(columns, axis=0).tolist(), strict=True)),
        "ratio": float(np.median(columns[:, 0] / columns[:, 1])),
        "to single": float(np.median(columns[:, 0] / columns[:, 2])),
    }


def _batched_speed(name: str, seconds: float) -> dict[str, float]:
    modes = ("sync", "vector_entry_point")
    both: list[Any] = [
        gymnasium.make_vec(OPEN_PART, 16, vectorization_mode=mode, model=f"bundled:{name}") for mode in modes
    ]
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (100, 16, 3)).astype(np.float32)
    for envs in both:
        envs.reset(seed=0)
    rates = np.array([[16.0 * _rate(envs.step, actions, seconds / 20) for envs in both] for _ in range(10)])
    for envs in both:
        envs.close()
    found = dict(zip(("sync", "batched"), np.median(rates, axis=0).tolist(), strict=True))
    return {**found, "batched over sync": float(np.median(rates[:, 1] / rates[:, 0]))}


def _rate(step: Callable[[Any], Any], actions: Any, seconds: float) -> float:
    start, count = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        for _ in range(10):
            step(actions[count % len(actions)])
            count += 1
    return count / (time.perf_counter() - start)


def _native(world: Any, substeps: int, action: Any) -> None:
    world.data.ctrl[:] = action
    mujoco.mj_step(world.model, world.data, nstep=substeps)


def _one_by_one(world: Any, substeps: int, action: Any) -> None:
    world.data.ctrl[:] = action
    for _ in range(substeps):
        mujoco.mj_step(world.model, world.data)


def pushed_at_random(asked: Amount) -> Record:
    """Random pushes on one object: each held for up to 1.5 s, a fifth of them with full force along all axes."""
    env = gymnasium.make(OPEN_PART, model=f"bundled:{asked.object}", randomize=True)
    rng, over, left, action = np.random.default_rng(0), True, 0, np.zeros(3, dtype=np.float32)
    record: Record = {"object": asked.object, "steps": int(asked.amount), "episodes": 0}
    record |= dict.fromkeys(("nan", "unstable", "escaped", "warned episodes", "thrown episodes"), 0)
    record |= {"depth_mm": 0.0, "beyond_range": 0.0}
    for _ in range(int(asked.amount)):
        if over:
            env.reset(seed=record["episodes"])
            left = 0
        if not left:
            action = rng.uniform(-1.0, 1.0, 3).astype(np.float32)
            action = np.sign(action) if rng.random() < 0.2 else action
            left = int(rng.integers(1, 30))
        left -= 1
        observation, reward, terminated, truncated, info = env.step(action)
        over = terminated or truncated
        record["nan"] += int(not (np.isfinite(observation).all() and np.isfinite(float(reward))))
        record["unstable"] += int(info["unstable"])
        record["escaped"] += int(info["escaped"])
        record["depth_mm"] = max(record["depth_mm"], 1e3 * float(info["max_penetration"]))
        record["beyond_range"] = max(record["beyond_range"], abs(float(info["open_fraction"]) - 0.5) - 0.5)
        if over:
            record["episodes"] += 1
            record["warned episodes"] += int(bool(info["warnings"]))
            record["thrown episodes"] += int(info["thrown"])
    env.close()
    return record


def report(found: Report[Record]) -> list[str]:
    """A table for each part."""
    blocks = [explained(__doc__)]
    for part, records in grouped(found.records, by=itemgetter("part")).items():
        rows = [[_text(record[column]) for column in _COLUMNS[part]] for record in records]
        blocks += [f"## {_PARTS[part]}", table(_COLUMNS[part], rows)]
        if part == "speed":
            blocks.append(
                f"{found.summary['cores']} cores, load {found.summary['load']:.1f}: ratios are what counts. `env`, "
                "`loop` (`mj_step(nstep=25)`) and `single` (25 calls of `mj_step`) are steps per second of processor "
                "time, with the same pushes from the same starts; `sync` and `batched` are steps per second of 16 "
                "environments."
            )
        if part == "random":
            blocks.append(
                f"{sum(record['steps'] for record in records):,} steps in all. `depth_mm`: deepest contact beyond what "
                "touches at rest; `beyond_range`: farthest beyond an end of the range, share of the way."
            )
    return blocks


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.3g}" if value < 1000 else f"{value:.0f}"
    return str(value)


STUDY = Study(title="The environments, measured", options=EnvironmentsOptions, measure=measure, report=report)
