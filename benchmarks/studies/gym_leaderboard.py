"""Who does the named tasks: chance, a policy written by hand, or one that learned for a short time?

Twenty tasks of `kinematify.envs.tasks`, observed by state. Every policy is judged on objects and seeds of the test
split; PPO of Stable-Baselines3 learns on objects and seeds of the training split, a policy for each task, and its
success on objects that it was trained on is beside. *Reset* is the longest of a task, of processor time.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import gymnasium
import numpy as np
from pydantic import Field

from benchmarks.studies.learning import PPO_SETTINGS, stable_baselines
from benchmarks.study import Options, Study, among, explained
from kinematify.envs import TASK_IDS
from kinematify.envs.expert import HandExpert
from kinematify.envs.tasks import TASKS, TEST, TRAIN
from kinematify.evaluation.record import number, table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.record import Report

_RESET_MS = 50.0
"""A reset that takes longer is too slow for training [ms]."""


class TasksOptions(Options):
    """How much of each."""

    tasks: Annotated[tuple[str, ...], among(TASKS)] = Field(
        tuple(TASKS), description="Some of the tasks, separated by commas."
    )
    episodes: int = Field(20, ge=1, description="Of each policy on each test object.")
    steps: int = Field(20_480, ge=0, description="That PPO learns for on each task; 0 leaves it out.")
    seed: int = Field(0, description="Of the training.")


@dataclass(frozen=True, kw_only=True)
class TaskTrial:
    """One task."""

    task: str
    episodes: int
    steps: int
    seed: int


def measure(options: TasksOptions, work: Work) -> Measured:
    """Let every policy do every task."""
    if options.steps:
        stable_baselines()
    asked = {
        name: TaskTrial(task=name, episodes=options.episodes, steps=options.steps, seed=options.seed)
        for name in options.tasks
    }
    return list(work.each(tried, asked).values()), {}


def tried(asked: TaskTrial) -> Record:
    """Success of chance, expert and PPO in a task."""
    rng = np.random.default_rng(asked.seed)

    def at_random(_: Any) -> Any:
        return lambda _: rng.uniform(-1.0, 1.0, 3).astype(np.float32)

    def by_hand(env: Any) -> Any:
        expert = HandExpert(env)
        expert.begin()
        return expert.act

    record: Record = {
        "task": asked.task,
        "random": _success(asked, at_random, TEST.objects, TEST.seeds),
        "expert": _success(asked, by_hand, TEST.objects, TEST.seeds),
        "reset_ms": _longest_reset(asked),
    }
    if asked.steps:
        start = time.perf_counter()
        policy = _trained(asked)
        record["ppo_seconds"] = time.perf_counter() - start

        def learned(_: Any) -> Any:
            return lambda seen: policy.predict(seen, deterministic=True)[0]

        record["ppo"] = _success(asked, learned, TEST.objects, TEST.seeds)
        record["ppo_trained_objects"] = _success(asked, learned, TRAIN.objects[: len(TEST.objects)], TEST.seeds)
    return record


def _made(task: str, object_seed: int) -> gymnasium.Env[Any, Any]:
    return gymnasium.make(TASK_IDS[task], object_seed=object_seed)


def _success(
    asked: TaskTrial, begun: Callable[[Any], Callable[[Any], Any]], objects: Iterable[int], seeds: range
) -> float:
    """Share of episodes in which the task is done at the end; `begun` gives a policy for an environment."""
    ends = []
    for object_seed in objects:
        env = _made(asked.task, object_seed)
        for seed in seeds[: asked.episodes]:
            observation, info = env.reset(seed=seed)
            act, over = begun(env.unwrapped), False
            while not over:
                observation, _, terminated, truncated, info = env.step(act(observation))
                over = terminated or truncated
            ends.append(info["is_success"])
        env.close()
    return float(np.mean(ends))


def _longest_reset(asked: TaskTrial) -> float:
    """Processor time [ms]."""
    env = _made(asked.task, TEST.objects[0])
    taken = []
    for seed in TEST.seeds[: asked.episodes]:
        start = time.process_time()
        env.reset(seed=seed)
        taken.append(time.process_time() - start)
    env.close()
    return 1e3 * max(taken)


def _trained(asked: TaskTrial) -> Any:
    """A policy that learned on all training objects at once."""
    ppo, _ = stable_baselines()
    from stable_baselines3.common.monitor import Monitor  # noqa: PLC0415  # an optional package
    from stable_baselines3.common.vec_env import DummyVecEnv  # noqa: PLC0415

    envs = DummyVecEnv([lambda k=k: Monitor(_made(asked.task, k)) for k in TRAIN.objects])
    envs.seed(asked.seed)
    policy = ppo("MlpPolicy", envs, device="cpu", seed=asked.seed, **PPO_SETTINGS)
    policy.learn(asked.steps)
    envs.close()
    return policy


def report(found: Report[Record]) -> list[str]:
    """A leaderboard: the task, and who does it how often."""
    titles = ("task", "random", "expert", "PPO", "PPO, objects it trained on", "PPO [s]", "reset [ms]")
    rows = [*map(_row, found.records), _mean_row(found.records)]
    steps = found.header.configuration["steps"]
    return [explained(__doc__), f"PPO learned for {steps} steps.", table(titles, rows)]


def _row(record: Record) -> tuple[str, ...]:
    shares = (record["random"], record["expert"], record.get("ppo"), record.get("ppo_trained_objects"))
    return (
        record["task"],
        *("-" if share is None else f"{share:.0%}" for share in shares),
        number(record.get("ppo_seconds"), 0),
        number(record["reset_ms"], 1),
    )


def _mean_row(records: Iterable[Record]) -> tuple[str, ...]:
    rows = list(records)
    names = ("random", "expert", "ppo", "ppo_trained_objects", "ppo_seconds")
    means = {name: float(np.mean([row[name] for row in rows])) for name in names if all(name in row for row in rows)}
    return _row({"task": "**mean**", "reset_ms": max(row["reset_ms"] for row in rows), **means})


def faults(found: Report[Record]) -> list[str]:
    """Resets that are too slow."""
    return [
        f"A reset of {record['task']} takes {record['reset_ms']:.0f} ms; at most {_RESET_MS:.0f} are allowed."
        for record in found.records
        if record["reset_ms"] > _RESET_MS
    ]


STUDY = Study(title="Leaderboard of the tasks", options=TasksOptions, measure=measure, report=report, faults=faults)
