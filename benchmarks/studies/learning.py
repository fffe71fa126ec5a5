"""Do policies learn to open bundled and inferred objects, with one setting for all?

OpenPart-v0 with position control and `randomize=True`; PPO of Stable-Baselines3 with the setting of
examples/train_policy.py, 8 environments, one thread. A training ends when 19 of 20 episodes succeed, or after the
given rounds of 2048 steps. The evaluation is over 100 episodes whose seeds no training has seen. Seconds are those of
learning. The joints of what is inferred are found from the parts alone.
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
from kinematify.envs.expert import HandExpert
from kinematify.evaluation.result_record import table
from kinematify.generate.registry import build
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.record import write_inference
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Callable

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report

_OPEN_PART = "kinematify.envs:kinematify/OpenPart-v0"
CONTROL = "position"
"""With forces, the noise of exploration overcomes the friction of small joints, and the mean action does not."""
PPO_SETTINGS: dict[str, Any] = {"n_steps": 256, "batch_size": 128, "gamma": 0.97, "learning_rate": 1e-3}
_ENOUGH = 0.95
"""Success at which a training ends."""
_SEEN, _UNSEEN = range(1000, 1020), range(5000, 5100)
"""Seeds of the curve, and of the evaluation."""
_BUNDLED = ("drawers", "nightstand", "cabinet", "door", "fridge", "microwave", "oven", "box", "laptop", "safe")
_INFERRED = (
    ("vise", "handle_joint"),
    ("vise", "jaw_joint"),
    ("microwave", "button_1_joint"),
    ("toaster", "lever_1_joint"),
    ("window", "sash_1_joint"),
)
"""Kinds of `kinematify generate --list` and the joint that is opened, slides of some millimetres among them."""
_OBJECTS = {
    **{f"bundled {name}": (f"bundled:{name}", None) for name in _BUNDLED},
    **{f"inferred {name}: {joint.removesuffix('_joint')}": (name, joint) for name, joint in _INFERRED},
}
"""Model and joint; with a joint, the model is a kind whose joints are inferred."""


class LearningOptions(Options):
    """Which trainings."""

    seeds: tuple[int, ...] = Field((0,), description="Of the trainings, separated by commas.")
    rounds: int = Field(20, description="Of 2048 steps, at most.")


@dataclass(frozen=True, kw_only=True)
class Training:
    """One training."""

    object: str
    seed: int
    rounds: int


def measure(options: LearningOptions, work: Work) -> Measured:
    """Train on every object with every seed."""
    stable_baselines()
    asked = {
        f"{name}, seed {seed}": Training(object=name, seed=seed, rounds=options.rounds)
        for name in _OBJECTS
        for seed in options.seeds
    }
    return list(work.each(trained, asked, workers=1).values()), {"ppo": PPO_SETTINGS}


def stable_baselines() -> tuple[Any, Any]:
    """Return PPO, and what makes environments for it.

    Raises:
        EnvironmentFault: Stable-Baselines3 is not installed.
    """
    require("Training", "stable-baselines3", "matplotlib")
    from stable_baselines3 import PPO  # noqa: PLC0415  an optional package
    from stable_baselines3.common.env_util import make_vec_env  # noqa: PLC0415

    return PPO, make_vec_env


def trained(asked: Training) -> Record:
    """Train a policy, and see what an expert and chance make of the same object."""
    ppo, _ = stable_baselines()
    model, joint = _OBJECTS[asked.object]
    with tempfile.TemporaryDirectory() as folder:
        keywords: Record = {"model": model, "control": CONTROL, "randomize": True}
        if joint is not None:
            keywords |= {"model": str(Path(folder, "inferred")), "joint": joint}
            write_inference(infer(build(model).assembly), Path(keywords["model"]))
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
        policy, record["curve"] = _train(keywords, asked)
        record["final"] = _episodes(_acting(policy), keywords, _UNSEEN)
        env.close()
    return record


def _train(keywords: Record, asked: Training) -> tuple[Any, list[Record]]:
    """Train until it succeeds; the curve has a point per 2048 steps."""
    ppo, make_vec_env = stable_baselines()
    envs = make_vec_env(lambda: gymnasium.make(_OPEN_PART, **keywords), n_envs=8, seed=asked.seed)
    policy = ppo("MlpPolicy", envs, device="cpu", seed=asked.seed, **PPO_SETTINGS)
    curve: list[Record] = []
    spent = 0.0
    while len(curve) < asked.rounds:
        start = time.perf_counter()
        policy.learn(2048, reset_num_timesteps=False)
        spent += time.perf_counter() - start
        seen = _episodes(_acting(policy), keywords, _SEEN)
        curve.append({"steps": policy.num_timesteps, "seconds": spent, **seen})
        if seen["success"] >= _ENOUGH:
            break
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


STUDY = Study(title="Learning to open a part", options=LearningOptions, measure=measure, report=report)
