"""Demonstrations of the hand-written policies as a Minari dataset, the format that offline learning reads.

Needs the extra `rl`. Minari keeps datasets as HDF5 in the folder that the variable
MINARI_DATASETS_PATH names, ``~/.minari/datasets`` if it is not set; ``minari.load_dataset(name)`` reads them.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np

from kinematify.envs.drawer_pull import DrawerPullEnv
from kinematify.envs.expert import ArmExpert, HandExpert
from kinematify.errors import InputError
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Iterable


def expert_for(env: gymnasium.Env[Any, Any]) -> HandExpert | ArmExpert:
    """Return the hand-written policy of an environment that this package registers."""
    bare: Any = env.unwrapped
    return ArmExpert(bare) if isinstance(bare, DrawerPullEnv) else HandExpert(bare)


def record_demonstrations(
    env_id: str, name: str, *, seeds: Iterable[int] = range(100), only_successes: bool = True, **keywords: Any
) -> Any:
    """Record episodes of the hand-written policy.

    Args:
        env_id: One of `kinematify.envs.IDS`, with or without ``kinematify.envs:``.
        name: Of the dataset, such as ``kinematify/drawers/expert-v0``.
        seeds: One episode each.
        only_successes: Leave out episodes that do not end open and at rest.
        keywords: Of the environment.

    Returns:
        The `minari.MinariDataset`.

    Raises:
        EnvironmentFault: Minari is not installed.
        InputError: No episode is left, or a keyword is impossible.
    """
    require("Writing demonstrations", "minari", "h5py")
    minari = importlib.import_module("minari")
    buffers = importlib.import_module("minari.data_collector.episode_buffer")
    env = gymnasium.make(env_id, **keywords)
    policy = expert_for(env)
    episodes = [_episode(env, policy, seed) for seed in seeds]
    kept = [facts for facts in episodes if facts.pop("success") or not only_successes]
    env.close()
    if not kept:
        raise InputError(
            f"None of {len(episodes)} episodes of {env_id} ended open and at rest, so there is nothing to write. Give "
            "another model or joint, or only_successes=False."
        )
    return minari.create_dataset_from_buffers(
        name,
        [buffers.EpisodeBuffer(id=number, **facts) for number, facts in enumerate(kept)],
        env=env,
        eval_env=env,
        algorithm_name=type(policy).__name__,
        author="Kinematify",
        author_email="none",
        code_permalink="kinematify.envs.expert",
        description="Hand-written policy of Kinematify.",
    )


def _episode(env: gymnasium.Env[Any, Any], policy: HandExpert | ArmExpert, seed: int) -> dict[str, Any]:
    """One episode, as `minari` wants it."""
    observation, info = env.reset(seed=seed)
    policy.begin()
    lists = ("actions", "rewards", "terminations", "truncations")
    facts: dict[str, Any] = {"seed": seed, "observations": [observation], **{key: [] for key in lists}}
    over = False
    while not over:
        action = policy.act(observation)
        observation, reward, terminated, truncated, info = env.step(action)
        over = terminated or truncated
        for key, value in (("observations", observation), ("actions", action), ("rewards", reward),
                           ("terminations", terminated), ("truncations", truncated)):  # fmt: skip
            facts[key].append(value)
    return {
        **facts,
        **{key: np.array(facts[key]) for key in ("observations", "actions")},
        "success": info["is_success"],
    }
