"""Measure the environments: results/environments.{json,md}. Each part keeps what the others have measured.

python benchmarks/environments.py expert --seeds 100     # hand-written policies, every bundled object
python benchmarks/environments.py speed                  # steps per second beside MuJoCo's own loop
python benchmarks/environments.py random --steps 1000000 # random actions: NaN, warnings, escapes
"""

from __future__ import annotations

import argparse
import json
import os
import time
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import mujoco
import numpy as np

import kinematify.envs
from kinematify.envs.bundled import BUNDLED, DRAWERS
from kinematify.envs.expert import ArmExpert, HandExpert

_ROUNDS = 20
SPEED_MODELS = ("drawers", "cabinet", "microwave")


def expert(seeds: int, models: list[str]) -> dict[str, Any]:
    """Success of the hand-written policies over seeds, objects drawn anew in each episode."""
    rows = []
    for env_id, kind, names in (
        (kinematify.envs.DRAWER_PULL, ArmExpert, DRAWERS), (kinematify.envs.OPEN_PART, HandExpert, tuple(BUNDLED)),
    ):  # fmt: skip
        for name in names:
            if models and name not in models:
                continue
            env = gymnasium.make(env_id, model=f"bundled:{name}", randomize=True, terminate_on_success=True)
            policy, start = kind(env.unwrapped), time.perf_counter()
            ends = [_episode(env, policy, seed) for seed in range(seeds)]
            rows.append({
                "id": env_id, "object": name, "joint": env.unwrapped.target.joint, "seeds": seeds,
                "success": float(np.mean([end["is_success"] for end in ends])),
                "thrown": float(np.mean([end["thrown"] for end in ends])),
                "return": float(np.mean([end["return"] for end in ends])),
                "depth_mm": 1e3 * max(end["deepest"] for end in ends),
                "warnings": sum(bool(end["warnings"]) for end in ends),
                "seconds": time.perf_counter() - start,
            })  # fmt: skip
            print(rows[-1], flush=True)
            env.close()
    return {"rows": rows}


def _episode(env: gymnasium.Env, policy: Any, seed: int) -> dict[str, Any]:
    observation, info = env.reset(seed=seed)
    policy.begin()
    total, deepest, over = 0.0, 0.0, False
    while not over:
        observation, reward, terminated, truncated, info = env.step(policy.act(observation))
        total, deepest = total + reward, max(deepest, info["max_penetration"])
        over = terminated or truncated
    return {**info, "return": total, "deepest": deepest}


def speed(seconds: float) -> dict[str, Any]:
    """Steps per second of one environment, of MuJoCo's loop with the same sub-steps, and of sixteen at once."""
    rows = []
    for name in SPEED_MODELS:
        rows.append({"object": name, **_single_speed(name, seconds), **_batched_speed(name, seconds)})
        print(rows[-1], flush=True)
    return {"rows": rows, "cores": len(os.sched_getaffinity(0)), "load": os.getloadavg()[0]}


def _single_speed(name: str, seconds: float) -> dict[str, float]:
    """The same pushes from the same starts, in short turns and by processor time, so that other load counts little."""
    env = gymnasium.make(kinematify.envs.OPEN_PART, model=f"bundled:{name}")
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (99, 3)).astype(np.float32)
    world, substeps = env.unwrapped.hand, env.unwrapped.settings.time.substeps
    ways = {"env": env.step, "loop": partial(_native, world, substeps), "single": partial(_one_by_one, world, substeps)}
    rates: list[list[float]] = []
    start = time.perf_counter()
    while time.perf_counter() - start < seconds or len(rates) < 10:
        rates.append([])
        for way in ways.values():
            env.reset(seed=len(rates))
            begun = time.process_time()
            for action in actions:
                way(action)
            rates[-1].append(len(actions) / (time.process_time() - begun))
    found, table = dict(zip(ways, np.median(rates, axis=0).tolist(), strict=True)), np.array(rates)
    return {
        **found,
        "ratio": float(np.median(table[:, 0] / table[:, 1])),
        "to single": float(np.median(table[:, 0] / table[:, 2])),
    }


def _batched_speed(name: str, seconds: float) -> dict[str, float]:
    modes = ("sync", "vector_entry_point")
    both = [
        gymnasium.make_vec(kinematify.envs.OPEN_PART, 16, vectorization_mode=mode, model=f"bundled:{name}")
        for mode in modes
    ]
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (100, 16, 3)).astype(np.float32)
    for envs in both:
        envs.reset(seed=0)
    rates = np.array([[16.0 * _rate(envs.step, actions, seconds / 20) for envs in both] for _ in range(10)])
    for envs in both:
        envs.close()
    found = dict(zip(("sync", "batched"), np.median(rates, axis=0).tolist(), strict=True))
    return {**found, "batched over sync": float(np.median(rates[:, 1] / rates[:, 0]))}


def _rate(way: Any, actions: np.ndarray, seconds: float) -> float:
    start, count = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        for _ in range(10):
            way(actions[count % len(actions)])
            count += 1
    return count / (time.perf_counter() - start)


def _native(world: Any, substeps: int, action: np.ndarray) -> None:
    world.data.ctrl[:] = action
    mujoco.mj_step(world.model, world.data, nstep=substeps)


def _one_by_one(world: Any, substeps: int, action: np.ndarray) -> None:
    world.data.ctrl[:] = action
    for _ in range(substeps):
        mujoco.mj_step(world.model, world.data)


class RandomRun:
    """Random pushes on one object: each held for up to 1.5 s, a fifth of them with full force along all axes."""

    def __init__(self, name: str) -> None:
        self.env = gymnasium.make(kinematify.envs.OPEN_PART, model=f"bundled:{name}", randomize=True)
        self.rng, self.over, self.held = np.random.default_rng(0), True, 0
        self.action = np.zeros(3, dtype=np.float32)
        self.row: dict[str, Any] = {"object": name, "steps": 0, "episodes": 0, "nan": 0, "unstable": 0, "escaped": 0}
        self.row |= {"warned episodes": 0, "thrown episodes": 0, "depth_mm": 0.0, "beyond_range": 0.0}

    def go_on(self, steps: int) -> None:
        row = self.row
        for _ in range(steps):
            if self.over:
                self.env.reset(seed=row["episodes"])
                self.held = 0
            if not self.held:
                self.action = self.rng.uniform(-1.0, 1.0, 3).astype(np.float32)
                self.action = np.sign(self.action) if self.rng.random() < 0.2 else self.action
                self.held = int(self.rng.integers(1, 30))
            self.held -= 1
            observation, reward, terminated, truncated, info = self.env.step(self.action)
            self.over = terminated or truncated
            row["steps"] += 1
            row["nan"] += not (np.isfinite(observation).all() and np.isfinite(reward))
            row["unstable"] += info["unstable"]
            row["escaped"] += info["escaped"]
            row["depth_mm"] = max(row["depth_mm"], 1e3 * info["max_penetration"])
            row["beyond_range"] = max(row["beyond_range"], abs(info["open_fraction"] - 0.5) - 0.5)
            if self.over:
                row["episodes"] += 1
                row["warned episodes"] += bool(info["warnings"])
                row["thrown episodes"] += info["thrown"]


def random_steps(steps: int, output: Path) -> dict[str, Any]:
    """Random pushes on every bundled object in turn; what is known is written after each of twenty rounds."""
    runs = [RandomRun(name) for name in BUNDLED]
    for number in range(_ROUNDS):
        for run in runs:
            run.go_on(steps // len(runs) // _ROUNDS)
        print(number, sum(run.row["steps"] for run in runs), flush=True)
        write("random", {"rows": [run.row for run in runs]}, output)
    return {"rows": [run.row for run in runs]}


def write(part: str, found: dict[str, Any], output: Path) -> None:
    path = output / "environments.json"
    known = json.loads(path.read_text()) if path.is_file() else {}
    known[part] = found
    path.write_text(json.dumps(known, indent=1) + "\n")
    lines = [
        "# The environments, measured",
        "",
        "Made by `python benchmarks/environments.py expert`, `speed` and `random`; MuJoCo.",
    ]
    for title, key, columns in (
        ("Hand-written policies, `randomize=True`", "expert",
         ("id", "object", "joint", "seeds", "success", "thrown", "return", "depth_mm", "warnings")),
        ("Steps per second, one step is 25 sub-steps of 2 ms", "speed",
         ("object", "env", "loop", "ratio", "single", "to single", "sync", "batched", "batched over sync")),
        ("Random actions, `randomize=True`", "random",
         ("object", "steps", "episodes", "nan", "unstable", "escaped", "warned episodes", "depth_mm", "beyond_range")),
    ):  # fmt: skip
        if key not in known:
            continue
        lines += ["", f"## {title}", "", "| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
        lines += ["| " + " | ".join(_text(row[column]) for column in columns) + " |" for row in known[key]["rows"]]
        lines += ["", _below(key, known[key])] if key in {"speed", "random"} else []
    (output / "environments.md").write_text("\n".join(lines) + "\n")


def _below(part: str, found: dict[str, Any]) -> str:
    """What a table needs to be understood."""
    if part == "random":
        total = sum(row["steps"] for row in found["rows"])
        return (
            f"{total:,} steps in all. `depth_mm`: deepest contact beyond what touches at rest; `beyond_range`: "
            "farthest beyond an end of the range, share of the way."
        )
    return (
        f"{found['cores']} cores, load {found['load']:.1f}: ratios are what counts. `env`, `loop` "
        "(`mj_step(nstep=25)`) and `single` (25 calls of `mj_step`) are steps per second of processor time, with the "
        "same pushes from the same starts; `sync` and `batched` are steps per second of 16 environments."
    )


def _text(value: Any) -> str:
    return (
        f"{value:.3g}"
        if isinstance(value, float) and value < 1000
        else f"{value:.0f}"
        if isinstance(value, float)
        else str(value)
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=("expert", "speed", "random"))
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--models", nargs="*", default=[])
    parser.add_argument("--steps", type=int, default=1_000_000)
    parser.add_argument("--seconds", type=float, default=12.0)
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    found = {
        "expert": lambda: expert(arguments.seeds, arguments.models),
        "speed": lambda: speed(arguments.seconds),
        "random": lambda: random_steps(arguments.steps, arguments.output),
    }[arguments.part]()
    write(arguments.part, found, arguments.output)
