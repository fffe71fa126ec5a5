"""Goldens of what is generated: families, described objects, requests of sentences, and episodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from benchmarks.expectations import SETS, load_sentences
from benchmarks.goldens.values import array_hash, blueprint_values, made, plain
from kinematify.errors import InputError
from kinematify.generate.reader import read_sentence
from kinematify.generate.registry import FAMILIES, all_kinds, build

if TYPE_CHECKING:
    from benchmarks.goldens.values import Values
    from kinematify.generate.procedural.blueprint import Blueprint

_SEEDS = (None, 0, 1, 2)
"""None: the defaults."""
_ACTIONS = 50


def _values(blueprints: dict[str, Blueprint]) -> dict[str, Values]:
    both = {name: blueprint_values(blueprint) for name, blueprint in blueprints.items()}
    return made(
        exact={name: exact for name, (exact, _) in both.items()},
        portable={name: structure for name, (_, structure) in both.items()},
    )


def family_items(sample: bool) -> tuple[dict[str, Any], dict[str, str]]:
    """Families that programs build, each with its seeds."""
    return {name: (name, _SEEDS[1:2] if sample else _SEEDS) for name in list(FAMILIES)[:: 5 if sample else 1]}, {}


def object_items(sample: bool) -> tuple[dict[str, Any], dict[str, str]]:
    """Objects that files describe: one that a seed draws of each, and all as they usually are."""
    described = [name for name in all_kinds() if name not in FAMILIES]
    return {name: (name, (0,) if sample else (None, 0)) for name in described[:: 8 if sample else 1]}, {}


def family_values(item: tuple[str, tuple[int | None, ...]]) -> dict[str, Values]:
    """Objects of one family."""
    name, seeds = item
    return _values({f"{name} {'defaults' if seed is None else seed}": build(name, seed=seed) for seed in seeds})


# ---- sentences and requests ------------------------------------------------------------------------------------------


def request_items(sample: bool) -> tuple[dict[str, Any], dict[str, str]]:
    """Lists of sentences."""
    return {name: name for name in (list(SETS)[:3] if sample else SETS)}, {}


def request_values(name: str) -> dict[str, Values]:
    """The request that every sentence of a list becomes, or why it is refused, and what is built of it."""
    exact: Values = {}
    portable: Values = {}
    for item in load_sentences(name):
        text = item["text"]
        try:
            built = read_sentence(text).made()
            exact[text], structure = blueprint_values(built.blueprint)
            listed = [*built.differences, *built.unread]
            portable[text] = {"request": built.facts["request"], "listed": listed, "built": structure}
        except InputError as error:
            portable[text] = {"refused": str(error)}
    return made(exact=exact, portable=portable)


# ---- episodes ------------------------------------------------------------------------------------------------------


def episode_items(sample: bool) -> tuple[dict[str, Any], dict[str, str]]:
    """Named tasks of the environments."""
    from kinematify.envs import TASK_IDS  # noqa: PLC0415 - Gymnasium, which nothing else here needs

    return dict(list(TASK_IDS.items())[:: 7 if sample else 1]), {}


def episode_values(env_id: str) -> dict[str, Values]:
    """An episode of random actions: every observation, reward and end."""
    import gymnasium  # noqa: PLC0415 - see `episode_items`

    import kinematify.envs  # noqa: F401, PLC0415 - registers the ids

    env = gymnasium.make(env_id, object_seed=1)
    env.action_space.seed(0)
    observation, info = env.reset(seed=0)
    steps = [[array_hash(observation), plain(info)]]
    for _ in range(_ACTIONS):
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        steps.append([array_hash(observation), float(reward), terminated, truncated, plain(info)])
        if terminated or truncated:
            break
    env.close()
    spaces = [str(env.observation_space.shape), str(env.action_space)]
    return made(exact={"steps": steps}, portable={"spaces": spaces})
