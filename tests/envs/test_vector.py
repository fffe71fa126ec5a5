"""The batched path gives the numbers of single environments."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import kinematify.envs
from kinematify.errors import InputError

COUNT = 5


@pytest.mark.parametrize("control", ["force", "position"])
def test_batched_and_single_environments_give_the_same_numbers(control: str) -> None:
    """Over two ends of episodes, with every copy's object drawn again each time."""
    keywords = {"model": "bundled:box", "control": control, "randomize": True}
    batched = gymnasium.make_vec(kinematify.envs.OPEN_PART, COUNT, vectorization_mode="vector_entry_point", **keywords)
    single = gymnasium.make_vec(kinematify.envs.OPEN_PART, COUNT, vectorization_mode="sync", **keywords)
    assert batched.single_observation_space == single.single_observation_space
    assert batched.action_space == single.action_space
    assert batched.metadata["autoreset_mode"] == single.metadata["autoreset_mode"]
    seen = [envs.reset(seed=3)[0] for envs in (batched, single)]
    np.testing.assert_allclose(seen[0], seen[1], atol=1e-6)
    rng, ends = np.random.default_rng(0), 0
    for _ in range(230):
        actions = rng.uniform(-1.0, 1.0, (COUNT, 3)).astype(np.float32)
        ours, theirs = batched.step(actions), single.step(actions)
        np.testing.assert_allclose(ours[0], theirs[0], atol=1e-4)
        np.testing.assert_allclose(ours[1], theirs[1], atol=1e-5)
        np.testing.assert_array_equal(ours[2], theirs[2])
        np.testing.assert_array_equal(ours[3], theirs[3])
        ends += int(ours[3].sum())
    assert ends == 2 * COUNT
    batched.close()
    single.close()


def test_success_ends_batched_episodes_when_asked() -> None:
    from tests.envs.hands import steady

    envs = gymnasium.make_vec(
        kinematify.envs.OPEN_PART_SPARSE, COUNT, vectorization_mode="vector_entry_point", terminate_on_success=True
    )
    seen, _ = envs.reset(seed=0)
    paid = np.zeros(COUNT)
    for _ in range(80):
        seen, reward, terminated, _, info = envs.step(np.stack([steady(row) for row in seen]))
        paid += reward
        np.testing.assert_array_equal(terminated, info["is_success"])
    assert (paid >= 1.0).all()
    envs.close()


def test_other_engines_are_refused() -> None:
    with pytest.raises(InputError, match='"sync"'):
        gymnasium.make_vec(kinematify.envs.OPEN_PART, 2, vectorization_mode="vector_entry_point", engine="pybullet")


def test_workers_that_are_ended_leave_no_folder(tmp_path: Path) -> None:
    """Neither those that are killed nor those that the end of the program ends."""
    program = """
import gymnasium, os, signal
envs = gymnasium.make_vec(
    "kinematify.envs:kinematify/OpenPart-v0", 2, "async", vector_kwargs={"context": "spawn"}, model="bundled:box"
)
os.kill(envs.processes[0].pid, signal.SIGKILL)
"""
    environment = {**os.environ, "TMPDIR": str(tmp_path)}
    subprocess.run([sys.executable, "-c", program], env=environment, check=True, capture_output=True, timeout=120)
    assert not list(tmp_path.iterdir())
