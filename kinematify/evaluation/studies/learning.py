"""Train Stable-Baselines3 on a drawer, a door and an inferred object: results/learning.{json,md,png}.

Needs pip install 'kinematify[rl,bench]'. Each training ends when all of 20 episodes succeed twice in a row, or after
ten minutes; then 100 episodes with other seeds are evaluated. Objects are drawn anew in each episode (randomize=True).
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import tempfile
import time
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import gymnasium
import matplotlib as mpl
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.env_util import make_vec_env

import kinematify
from kinematify.envs.expert import HandExpert

mpl.use("Agg")
from matplotlib import pyplot as plt

OPEN_PART = "kinematify.envs:kinematify/OpenPart-v0"
LIMIT = 600.0
"""Of a training [s]."""
PPO_KEYWORDS: dict[str, Any] = {
    "n_steps": 256, "batch_size": 512, "gamma": 0.97, "learning_rate": 1e-3, "policy_kwargs": {"log_std_init": -0.7},
}  # fmt: skip
SEEN, UNSEEN = range(1000, 1020), range(5000, 5100)
"""Seeds of the curve, and of the evaluation."""
ROOT = Path(__file__).resolve().parent.parent


def episodes(act: Any, keywords: dict[str, Any], seeds: range) -> dict[str, float]:
    """Success, return, share that is open and share that was thrown, as means over episodes."""
    env = gymnasium.make(OPEN_PART, **keywords)
    rows = []
    for seed in seeds:
        observation, _ = env.reset(seed=seed)
        total, over = 0.0, False
        while not over:
            observation, reward, terminated, truncated, info = env.step(act(observation))
            total, over = total + reward, terminated or truncated
        rows.append((info["is_success"], total, info["open_fraction"], info["thrown"]))
    env.close()
    names = ("success", "return", "open", "thrown")
    return dict(zip(names, np.mean(np.array(rows, dtype=float), axis=0).tolist(), strict=True))


def acting(policy: PPO) -> Any:
    return lambda observation: policy.predict(observation, deterministic=True)[0]


def train(keywords: dict[str, Any], seed: int) -> tuple[PPO, list[dict[str, float]]]:
    """Train until it succeeds; the curve has a point per 2048 steps."""
    envs = make_vec_env(lambda: gymnasium.make(OPEN_PART, **keywords), n_envs=8, seed=seed)
    policy = PPO("MlpPolicy", envs, device="cpu", seed=seed, **PPO_KEYWORDS)
    curve, spent, good = [], 0.0, 0
    while spent < LIMIT and good < 2:
        start = time.perf_counter()
        policy.learn(2048, reset_num_timesteps=False)
        spent += time.perf_counter() - start
        seen = episodes(acting(policy), keywords, SEEN)
        curve.append({"steps": policy.num_timesteps, "seconds": spent, **seen})
        good = good + 1 if seen["success"] == 1.0 else 0
        print(f"  {policy.num_timesteps:6d} steps {spent:6.1f} s success {seen['success']:.0%}", flush=True)
    envs.close()
    return policy, curve


def write(rows: list[dict[str, Any]], output: Path) -> None:
    facts = {
        "stable-baselines3": version("stable-baselines3"), "torch": version("torch"), "mujoco": version("mujoco"),
        "python": platform.python_version(), "cores": len(os.sched_getaffinity(0)), "threads": torch.get_num_threads(),
    }  # fmt: skip
    record = {"environment": facts, "ppo": PPO_KEYWORDS, "rows": rows}
    (output / "learning.json").write_text(json.dumps(record, indent=1) + "\n")
    heads = ("object", "joint", "training seed", "steps", "time [s]", "success", "open", "thrown", "return")
    heads = (*heads, "expert: success", "expert: return", "random: return")
    lines = [
        "# Learning to open a part",
        "",
        "OpenPart-v0 with force control and `randomize=True`; PPO of Stable-Baselines3, 8 environments, one thread.",
        f"Seconds are those of learning, on {facts['cores']} cores with other load.",
        "The evaluation is over 100 episodes whose seeds no training has seen.",
        "",
        "| " + " | ".join(heads) + " |",
        "|" + "---|" * len(heads),
        *("| " + " | ".join(_cells(row)) + " |" for row in rows),
        "",
        "![success over steps](learning.png)",
        "",
        f"Made by `python benchmarks/learning.py --seeds {' '.join(sorted({str(row['seed']) for row in rows}))}`.",
    ]
    (output / "learning.md").write_text("\n".join(lines) + "\n")
    draw(rows, output / "learning.png")


def _cells(row: dict[str, Any]) -> list[str]:
    last, final, expert, chance = row["curve"][-1], row["final"], row["expert"], row["random"]
    return [
        row["object"], row["joint"], str(row["seed"]), str(last["steps"]), f"{last['seconds']:.0f}",
        f"{final['success']:.0%}", f"{final['open']:.2f}", f"{final['thrown']:.0%}", f"{final['return']:.1f}",
        f"{expert['success']:.0%}", f"{expert['return']:.1f}", f"{chance['return']:.1f}",
    ]  # fmt: skip


def draw(rows: list[dict[str, Any]], path: Path) -> None:
    figure, panels = plt.subplots(1, 2, figsize=(10, 3.6))
    colors = {name: f"C{k}" for k, name in enumerate(dict.fromkeys(row["object"] for row in rows))}
    shown = min(row["seed"] for row in rows)
    for row in rows:
        steps = [0, *(point["steps"] for point in row["curve"])]
        for panel, key in zip(panels, ("success", "return"), strict=True):
            values = [row["untrained"][key], *(point[key] for point in row["curve"])]
            label = row["object"] if row["seed"] == shown else None
            panel.plot(steps, values, color=colors[row["object"]], marker="o", markersize=3, label=label)
    panels[0].set(xlabel="steps of the environment", ylabel="success, 20 episodes", ylim=(-0.03, 1.03))
    panels[1].set(xlabel="steps of the environment", ylabel="return of an episode", ylim=(0, 100))
    panels[1].legend(frameon=False)
    for panel in panels:
        panel.grid(alpha=0.3)
        panel.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(path, dpi=130)


def measured(name: str, what: dict[str, Any], seeds: list[int]) -> Iterator[dict[str, Any]]:
    """One row per training, and what an expert and chance make of the same object."""
    keywords = {**what, "randomize": True}
    env = gymnasium.make(OPEN_PART, **keywords)
    joint, expert = env.reset(seed=0)[1]["joint"], HandExpert(env.unwrapped)
    rng = np.random.default_rng(0)
    facts = {
        "object": name,
        "joint": joint,
        "expert": episodes(expert.act, keywords, UNSEEN),
        "random": episodes(lambda _: rng.uniform(-1, 1, 3).astype(np.float32), keywords, UNSEEN),
    }
    for seed in seeds:
        print(name, joint, "seed", seed, flush=True)
        untrained = episodes(acting(PPO("MlpPolicy", env, device="cpu", seed=seed, **PPO_KEYWORDS)), keywords, SEEN)
        policy, curve = train(keywords, seed)
        final = episodes(acting(policy), keywords, UNSEEN)
        print(f"  100 unseen seeds: {final}", flush=True)
        yield {**facts, "seed": seed, "untrained": untrained, "curve": curve, "final": final}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, nargs="+", default=[0, 1, 2])
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        inferred = Path(folder, "inferred")
        inference = kinematify.infer(kinematify.load_assembly(ROOT / "examples" / "cabinet"))
        kinematify.write_inference(inference, inferred)
        objects = (
            ("bundled drawer", {"model": "bundled:drawers"}),
            ("bundled door", {"model": "bundled:cabinet"}),
            ("inferred cabinet: drawer", {"model": str(inferred), "joint": "drawer_left_joint"}),
            ("inferred cabinet: door", {"model": str(inferred), "joint": "door_left_joint"}),
        )
        for name, what in objects:
            for row in measured(name, what, arguments.seeds):
                rows.append(row)
                write(rows, arguments.output)


if __name__ == "__main__":
    main()
