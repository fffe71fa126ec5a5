"""Do policies learn to open a drawer, a door and what was inferred?

OpenPart-v0 with force control and `randomize=True`; PPO of Stable-Baselines3, 8 environments, one thread. A training
ends when all of 20 episodes succeed twice in a row, or after ten minutes. The evaluation is over 100 episodes whose
seeds no training has seen. Seconds are those of learning.
"""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from pydantic import Field

from benchmarks.study import Options, Study, explained
from kinematify.assembly.load import load_assembly
from kinematify.envs.expert import HandExpert
from kinematify.errors import EnvironmentFault
from kinematify.evaluation.record import table
from kinematify.pipeline import infer, write_inference

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.record import Report

_OPEN_PART = "kinematify.envs:kinematify/OpenPart-v0"
_LIMIT = 600.0
"""Of a training [s]."""
PPO_SETTINGS: dict[str, Any] = {
    "n_steps": 256, "batch_size": 512, "gamma": 0.97, "learning_rate": 1e-3, "policy_kwargs": {"log_std_init": -0.7},
}  # fmt: skip
_SEEN, _UNSEEN = range(1000, 1020), range(5000, 5100)
"""Seeds of the curve, and of the evaluation."""
_OBJECTS = {
    "bundled drawer": ("bundled:drawers", None),
    "bundled door": ("bundled:cabinet", None),
    "inferred cabinet: drawer": (None, "drawer_left_joint"),
    "inferred cabinet: door": (None, "door_left_joint"),
}
"""Model and joint; without a model the cabinet of the examples is inferred."""


class LearningOptions(Options):
    """Which trainings."""

    seeds: tuple[int, ...] = Field((0, 1, 2), description="Of the trainings, separated by commas.")
    parts: Path = Field(Path("examples/cabinet"), description="Parts of the cabinet that is inferred.")


@dataclass(frozen=True, kw_only=True)
class Training:
    """One training."""

    object: str
    seed: int
    parts: Path


def measure(options: LearningOptions, work: Work) -> Measured:
    """Train on every object with every seed."""
    stable_baselines()
    asked = {
        f"{name}, seed {seed}": Training(object=name, seed=seed, parts=options.parts)
        for name in _OBJECTS
        for seed in options.seeds
    }
    return list(work.each(trained, asked, workers=1).values()), {"ppo": PPO_SETTINGS}


def stable_baselines() -> tuple[Any, Any]:
    """Return PPO, and what makes environments for it.

    Raises:
        EnvironmentFault: Stable-Baselines3 is not installed.
    """
    try:
        from stable_baselines3 import PPO  # noqa: PLC0415  an optional package
        from stable_baselines3.common.env_util import make_vec_env  # noqa: PLC0415
    except ImportError as error:
        raise EnvironmentFault(
            "Training needs Stable-Baselines3, which is not installed. Run `pip install 'kinematify[rl,bench]'`."
        ) from error
    return PPO, make_vec_env


def trained(asked: Training) -> Record:
    """Train a policy, and see what an expert and chance make of the same object."""
    ppo, _ = stable_baselines()
    model, joint = _OBJECTS[asked.object]
    with tempfile.TemporaryDirectory() as folder:
        if model is None:
            model = str(Path(folder, "inferred"))
            write_inference(infer(load_assembly(asked.parts)), Path(model))
        keywords: Record = {"model": model, "randomize": True, **({} if joint is None else {"joint": joint})}
        env = gymnasium.make(_OPEN_PART, **keywords)
        bare: Any = env.unwrapped
        name, expert, rng = env.reset(seed=0)[1]["joint"], HandExpert(bare), np.random.default_rng(0)
        untrained = ppo("MlpPolicy", env, device="cpu", seed=asked.seed, **PPO_SETTINGS)
        record: Record = {
            "object": asked.object,
            "joint": name,
            "seed": asked.seed,
            "expert": _episodes(expert.act, keywords, _UNSEEN),
            "random": _episodes(lambda _: rng.uniform(-1, 1, 3).astype(np.float32), keywords, _UNSEEN),
            "untrained": _episodes(_acting(untrained), keywords, _SEEN),
        }
        policy, record["curve"] = _train(keywords, asked.seed)
        record["final"] = _episodes(_acting(policy), keywords, _UNSEEN)
        env.close()
    return record


def _train(keywords: Record, seed: int) -> tuple[Any, list[Record]]:
    """Train until it succeeds; the curve has a point per 2048 steps."""
    ppo, make_vec_env = stable_baselines()
    envs = make_vec_env(lambda: gymnasium.make(_OPEN_PART, **keywords), n_envs=8, seed=seed)
    policy = ppo("MlpPolicy", envs, device="cpu", seed=seed, **PPO_SETTINGS)
    curve: list[Record] = []
    spent, good = 0.0, 0
    while spent < _LIMIT and good < 2:
        start = time.perf_counter()
        policy.learn(2048, reset_num_timesteps=False)
        spent += time.perf_counter() - start
        seen = _episodes(_acting(policy), keywords, _SEEN)
        curve.append({"steps": policy.num_timesteps, "seconds": spent, **seen})
        good = good + 1 if seen["success"] == 1.0 else 0
    envs.close()
    return policy, curve


def _acting(policy: Any) -> Callable[[Any], Any]:
    return lambda observation: policy.predict(observation, deterministic=True)[0]


def _episodes(act: Callable[[Any], Any], keywords: Record, seeds: range) -> dict[str, float]:
    """Success, return, share that is open and share that was thrown, as means over episodes."""
    env = gymnasium.make(_OPEN_PART, **keywords)
    rows = []
    for seed in seeds:
        observation, _ = env.reset(seed=seed)
        total, over = 0.0, False
        while not over:
            observation, reward, terminated, truncated, info = env.step(act(observation))
            total, over = total + float(reward), terminated or truncated
        rows.append((info["is_success"], total, info["open_fraction"], info["thrown"]))
    env.close()
    means: list[float] = np.mean(np.array(rows, dtype=float), axis=0).tolist()
    return dict(zip(("success", "return", "open", "thrown"), means, strict=True))


def report(found: Report[Record]) -> list[str]:
    """One line per training."""
    titles = (
        "object", "joint", "training seed", "steps", "time [s]", "success", "open", "thrown", "return",
        "expert: success", "expert: return", "random: return",
    )  # fmt: skip
    return [explained(__doc__), table(titles, map(_row, found.records))]


def _row(record: Record) -> tuple[str, ...]:
    last, final, expert, chance = record["curve"][-1], record["final"], record["expert"], record["random"]
    return (
        record["object"], record["joint"], str(record["seed"]), str(last["steps"]), f"{last['seconds']:.0f}",
        f"{final['success']:.0%}", f"{final['open']:.2f}", f"{final['thrown']:.0%}", f"{final['return']:.1f}",
        f"{expert['success']:.0%}", f"{expert['return']:.1f}", f"{chance['return']:.1f}",
    )  # fmt: skip


def plot(found: Report[Record]) -> Figure:
    """Success and return over steps, a colour per object."""
    from matplotlib.figure import Figure  # noqa: PLC0415  an optional package

    figure = Figure(figsize=(10, 3.6), layout="constrained")
    panels = figure.subplots(1, 2)
    colors = {name: f"C{k}" for k, name in enumerate(dict.fromkeys(record["object"] for record in found.records))}
    named = min(record["seed"] for record in found.records)
    for record in found.records:
        steps = [0, *(point["steps"] for point in record["curve"])]
        for panel, key in zip(panels, ("success", "return"), strict=True):
            values = [record["untrained"][key], *(point[key] for point in record["curve"])]
            label = record["object"] if record["seed"] == named else None
            panel.plot(steps, values, color=colors[record["object"]], marker="o", markersize=3, label=label)
    panels[0].set(xlabel="steps of the environment", ylabel="success, 20 episodes", ylim=(-0.03, 1.03))
    panels[1].set(xlabel="steps of the environment", ylabel="return of an episode", ylim=(0, 100))
    panels[1].legend(frameon=False)
    for panel in panels:
        panel.grid(alpha=0.3)
        panel.spines[["top", "right"]].set_visible(False)
    return figure


STUDY = Study(title="Learning to open a part", options=LearningOptions, measure=measure, report=report, plot=plot)
