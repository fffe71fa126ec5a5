"""Pictures need no OpenGL and no screen, have the colours of the model, and RecordVideo films them."""

from __future__ import annotations

from pathlib import Path

import gymnasium
import numpy as np
import pytest

from kinematify.envs.open_part import OpenPartEnv
from tests.envs.hands import OPEN_PART


def held_pixels(picture: np.ndarray) -> int:
    """Pixels of the hue of the held part: much more green than red."""
    red, green = picture[..., 0].astype(int), picture[..., 1].astype(int)
    return int((green - red > 50).sum())


def test_the_picture_shows_the_part_where_it_is() -> None:
    env = OpenPartEnv("bundled:cabinet", render_mode="rgb_array")
    env.reset(seed=0, options={"open_fraction": 0.0})
    shut = env.render()
    assert shut.shape == (360, 480, 3)
    assert shut.dtype == np.uint8
    env.reset(seed=0, options={"open_fraction": 1.0})
    opened = env.render()
    assert held_pixels(shut) > 2000
    assert held_pixels(opened) > 1000
    assert (np.abs(shut.astype(int) - opened.astype(int)).max(axis=2) > 30).mean() > 0.02
    env.close()


@pytest.mark.parametrize("engine", ["pybullet"])
def test_record_video(engine: str, tmp_path: Path) -> None:
    env = gymnasium.make(OPEN_PART, engine=engine, render_mode="rgb_array", max_episode_steps=2)
    env = gymnasium.wrappers.RecordVideo(env, str(tmp_path / "films"), disable_logger=True)
    env.reset(seed=0)
    while not env.step(env.action_space.sample())[3]:
        pass
    env.close()
    assert [file.stat().st_size > 1000 for file in tmp_path.glob("films/*.mp4")] == [True]
