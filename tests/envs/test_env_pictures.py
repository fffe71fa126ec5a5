"""Pictures: with OpenGL where the machine has it, without it everywhere, and RecordVideo."""

from __future__ import annotations

import ctypes
import os
from pathlib import Path

import gymnasium
import numpy as np
import pytest

from kinematify.envs.open_part import OpenPartEnv
from kinematify.errors import EnvironmentFault
from tests.envs.hands import OPEN_PART

HELD = np.array([41, 158, 143])
"""Colour of the part that is opened, as it is given."""


def has(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def held_pixels(picture: np.ndarray) -> int:
    """Pixels of the hue of the held part: much more green than red."""
    red, green = picture[..., 0].astype(int), picture[..., 1].astype(int)
    return int((green - red > 50).sum())


@pytest.mark.parametrize(
    "kind",
    [
        "off",
        pytest.param("egl", marks=pytest.mark.skipif(not has("libEGL.so.1"), reason="libegl1 is not installed")),
        pytest.param(
            "osmesa", marks=pytest.mark.skipif(not has("libOSMesa.so.8"), reason="libosmesa6 is not installed")
        ),
    ],
)
def test_the_picture_shows_the_part_where_it_is(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if kind != "off" and os.environ.get("PYOPENGL_PLATFORM", kind) != kind:
        pytest.skip("PyOpenGL is set to another platform in this process already")
    monkeypatch.setenv("MUJOCO_GL", kind)
    env = OpenPartEnv("bundled:cabinet", render_mode="rgb_array")
    env.reset(seed=0, options={"open_fraction": 0.0})
    shut = env.render()
    assert shut.shape == (env.settings.picture.height, env.settings.picture.width, 3)
    assert shut.dtype == np.uint8
    env.reset(seed=0, options={"open_fraction": 1.0})
    opened = env.render()
    assert env.renderer == ("software" if kind == "off" else kind)
    assert held_pixels(shut) > 2000
    assert held_pixels(opened) > 1000
    assert (np.abs(shut.astype(int) - opened.astype(int)).max(axis=2) > 30).mean() > 0.02
    env.close()


@pytest.mark.parametrize("engine", ["mujoco", "pybullet"])
def test_record_video(engine: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "off")
    env = gymnasium.make(OPEN_PART, engine=engine, render_mode="rgb_array", max_episode_steps=2)
    env = gymnasium.wrappers.RecordVideo(env, str(tmp_path / "films"), disable_logger=True)
    env.reset(seed=0)
    while not env.step(env.action_space.sample())[3]:
        pass
    env.close()
    assert [file.stat().st_size > 1000 for file in tmp_path.glob("films/*.mp4")] == [True]


def test_a_renderer_that_is_missing_is_named_with_its_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    monkeypatch.setattr("kinematify.envs.picture._there", lambda library: False)
    env = OpenPartEnv(render_mode="rgb_array")
    env.reset(seed=0)
    with pytest.raises(EnvironmentFault, match=r"libOSMesa.*apt-get install libosmesa6.*MUJOCO_GL=off"):
        env.render()


def test_without_opengl_pictures_are_still_drawn(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr("kinematify.envs.picture._there", lambda library: False)
    env = OpenPartEnv("bundled:box", render_mode="rgb_array")
    env.reset(seed=0)
    assert held_pixels(env.render()) > 1000
    assert env.renderer == "software"
    assert "libegl1" in caplog.text
