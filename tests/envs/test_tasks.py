"""Named tasks and what a camera sees: every task can be made, its splits are apart, pixels show the part that moves."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest

from kinematify.envs import OPEN_PART, TASK_IDS
from kinematify.envs.expert import HandExpert
from kinematify.envs.tasks import TASKS, TEST, TRAIN
from kinematify.errors import InputError
from kinematify.generate.registry import build


def done_by_hand(env: gymnasium.Env, *, seed: int) -> dict[str, object]:
    """Last info of an episode of the hand-written policy."""
    observation, info = env.reset(seed=seed)
    expert, over = HandExpert(env.unwrapped), False
    while not over:
        observation, _, terminated, truncated, info = env.step(expert.act(observation))
        over = terminated or truncated
    return info


def test_there_are_twenty_tasks_and_their_splits_are_apart() -> None:
    assert len(TASKS) == len(TASK_IDS) == 20
    assert not set(TRAIN.objects) & set(TEST.objects)
    assert not set(TRAIN.seeds) & set(TEST.seeds)


@pytest.mark.parametrize("name", list(TASKS)[::3])
def test_every_object_of_a_task_has_its_joint(name: str) -> None:
    family, joint = TASKS[name]
    for seed in (*TRAIN.objects, *TEST.objects):
        built = build(family, seed=seed)
        assert joint.removesuffix("_joint") in {made.child for made in built.joints}, seed


@pytest.mark.parametrize("name", ["close-drawer", "turn-oven-knob"])
def test_a_task_is_done_by_hand_on_a_test_object(name: str) -> None:
    env = gymnasium.make(TASK_IDS[name], object_seed=TEST.objects[0])
    info = done_by_hand(env, seed=TEST.seeds[0])
    assert info["is_success"], info
    env.close()


def test_closing_begins_open_and_ends_shut() -> None:
    env = gymnasium.make(TASK_IDS["close-microwave"], randomize=False)
    bare = env.unwrapped
    env.reset(seed=0)
    assert bare.reading().values[bare.target.leader] > 0.9 * bare.target.closed > 0.0
    assert done_by_hand(env, seed=0)["is_success"]
    assert bare.reading().values[bare.target.leader] < 0.15 * bare.target.closed
    env.close()


def test_an_object_seed_draws_another_object_and_the_same_one_again() -> None:
    sizes = []
    for seed in (0, 1, 0):
        env = gymnasium.make(TASK_IDS["open-fridge"], object_seed=seed)
        sizes.append(env.unwrapped.articulated_object.scene.size)
        env.close()
    assert sizes[0] == sizes[2] != sizes[1]
    with pytest.raises(InputError, match="no object procedural:fridge:last"):
        gymnasium.make(OPEN_PART, model="procedural:fridge:last")


def test_pixels_show_the_part_where_it_is_the_same_in_both_engines() -> None:
    seen = {}
    for engine in ("mujoco", "pybullet"):
        env = gymnasium.make(OPEN_PART, model="bundled:cabinet", engine=engine, observation="pixels")
        for share in (0.0, 1.0):
            seen[engine, share] = env.reset(seed=0, options={"open_fraction": share})[0].astype(int)
        env.close()
    for share in (0.0, 1.0):
        assert np.abs(seen["mujoco", share] - seen["pybullet", share]).max(axis=2).mean() < 1.0
        red, green = seen["mujoco", share][..., 0], seen["mujoco", share][..., 1]
        assert (green - red > 50).sum() > 100, "the part that is opened is green"
    assert (np.abs(seen["mujoco", 0.0] - seen["mujoco", 1.0]).max(axis=2) > 30).mean() > 0.02


def test_wrong_words_are_reported() -> None:
    with pytest.raises(InputError, match="observation"):
        gymnasium.make(OPEN_PART, observation="depth")
    with pytest.raises(InputError, match="pixel_size is \\(0, 84\\)"):
        gymnasium.make(OPEN_PART, observation="pixels", pixel_size=(0, 84))
    with pytest.raises(InputError, match="observed by their state"):
        gymnasium.make_vec(OPEN_PART, num_envs=2, vectorization_mode="vector_entry_point", observation="pixels")
