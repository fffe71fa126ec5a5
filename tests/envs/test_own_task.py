"""A task of one's own is one file, that of the page."""

from __future__ import annotations

from pathlib import Path

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env

from tests.envs import half_open

PAGE = Path(__file__).parents[2] / "docs" / "envs.md"
TASK = "mine/HalfOpen-v0"
KEYWORDS = {"model": "bundled:box", "control": "position"}


def test_the_page_shows_the_file() -> None:
    assert Path(half_open.__file__).read_text("utf-8") in PAGE.read_text("utf-8")


def test_it_is_an_environment_that_can_be_solved() -> None:
    env = gymnasium.make(TASK, **KEYWORDS, randomize=True)
    check_env(env.unwrapped, skip_render_check=True)
    seen, info = env.reset(seed=0)
    assert not info["is_success"]
    for _ in range(100):
        share, direction = seen[0], seen[54:57]
        seen, reward, _, _, info = env.step((np.clip(2.0 * (0.5 - share), -1.0, 1.0) * direction).astype(np.float32))
    assert info["is_success"]
    assert float(reward) > 0.99
    env.close()


def test_many_at_once_give_the_same_numbers() -> None:
    batched, single = (
        gymnasium.make_vec(TASK, 3, vectorization_mode=mode, **KEYWORDS) for mode in ("vector_entry_point", "sync")
    )
    rng = np.random.default_rng(0)
    np.testing.assert_allclose(batched.reset(seed=1)[0], single.reset(seed=1)[0], atol=1e-6)
    for _ in range(40):
        actions = rng.uniform(-1.0, 1.0, (3, 3)).astype(np.float32)
        ours, theirs = batched.step(actions), single.step(actions)
        np.testing.assert_allclose(ours[0], theirs[0], atol=1e-4)
        np.testing.assert_allclose(ours[1], theirs[1], atol=1e-5)
    batched.close()
    single.close()
