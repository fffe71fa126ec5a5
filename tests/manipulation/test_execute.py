"""Planned motions in MuJoCo and PyBullet: what can be done is done, and what cannot is noticed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kinematify.manipulation.execute import Execution, Loaded, execute, load, timed
from kinematify.manipulation.plan_request import Hold
from kinematify.manipulation.task_film import write_film
from tests.manipulation import furniture

SETTINGS = furniture.SETTINGS
EXECUTION = SETTINGS.task.execution


@pytest.fixture(scope="module")
def drawer(tmp_path_factory: pytest.TempPathFactory) -> tuple[Loaded, Path]:
    folder = tmp_path_factory.mktemp("drawer")
    urdf = furniture.write_drawer_cabinet(folder / "c.urdf")
    return load(furniture.planned(folder, urdf, "slide", 0.25, (-0.75, -0.1, 0.0)), folder, SETTINGS.prepare), folder


@pytest.fixture(scope="module")
def door(tmp_path_factory: pytest.TempPathFactory) -> Loaded:
    folder = tmp_path_factory.mktemp("door")
    urdf = furniture.write_door_cabinet(folder / "c.urdf")
    return load(furniture.planned(folder, urdf, "hinge", -1.3, (-0.85, -0.1, 0.0)), folder, SETTINGS.prepare)


@pytest.fixture(scope="module")
def pulled(drawer: tuple[Loaded, Path]) -> Execution:
    return execute(drawer[0], EXECUTION, engine="mujoco", hold=Hold.CONTACT)


def changed(loaded: Loaded, **changes: object) -> Loaded:
    """The same models with another motion."""
    return replace(loaded, motion=replace(loaded.motion, **changes))


def test_timing_keeps_the_speed_limits_and_ends_at_rest(drawer: tuple[Loaded, Path]) -> None:
    loaded = drawer[0]
    fastest = loaded.fastest(EXECUTION)
    reference = timed(loaded.motion, fastest, EXECUTION, 0.002)
    assert (np.abs(reference.speed).max(axis=0) <= EXECUTION.speed_share * fastest * 1.05).all()
    assert reference.arm[0] == pytest.approx(loaded.motion.reach[0])
    assert reference.arm[-1] == pytest.approx(loaded.motion.pull[-1])
    assert reference.arm[reference.grasped] == pytest.approx(loaded.motion.pull[0])
    assert np.abs(reference.speed[-1]).max() == pytest.approx(0.0, abs=1e-9)
    assert 0 < reference.grasped < reference.pulls < len(reference.arm)


@pytest.mark.parametrize("hold", list(Hold))
def test_mujoco_opens_the_drawer(drawer: tuple[Loaded, Path], pulled: Execution, hold: Hold) -> None:
    result = pulled if hold is Hold.CONTACT else execute(drawer[0], EXECUTION, engine="mujoco", hold=hold)
    assert result.success, result.reason
    assert result.share == pytest.approx(1.0, abs=0.03)
    assert result.depth < EXECUTION.depth


@pytest.mark.parametrize("hold", list(Hold))
def test_mujoco_opens_the_door(door: Loaded, hold: Hold) -> None:
    result = execute(door, EXECUTION, engine="mujoco", hold=hold)
    assert result.success, result.reason
    assert result.share == pytest.approx(1.0, abs=0.03)


def test_pybullet_agrees(drawer: tuple[Loaded, Path], door: Loaded) -> None:
    for loaded in (drawer[0], door):
        result = execute(loaded, EXECUTION, engine="pybullet", hold=Hold.WELD)
        assert result.success, result.reason
        assert result.share == pytest.approx(1.0, abs=0.03)


def test_a_joint_that_is_locked_does_not_open(drawer: tuple[Loaded, Path]) -> None:
    """The engines are given the object, not the plan: a pull across the rail must fail in both."""
    loaded, folder = drawer
    work = folder / "wrong"
    work.mkdir(exist_ok=True)
    urdf = furniture.write_drawer_cabinet(work / "c.urdf", axis="0 1 0")
    wrong = load(replace(loaded.motion, object_urdf=urdf), work, SETTINGS.prepare)
    for result in (
        execute(wrong, EXECUTION, engine="mujoco", hold=Hold.WELD),
        execute(wrong, EXECUTION, engine="pybullet", hold=Hold.WELD),
    ):
        assert not result.success
        assert "stops" in (result.reason or "")


def test_a_weak_grip_slips(drawer: tuple[Loaded, Path]) -> None:
    loaded, folder = drawer
    heavy = folder / "heavy"
    heavy.mkdir(exist_ok=True)
    text = loaded.motion.object_urdf.read_text().replace("<limit", '<dynamics damping="0" friction="400"/><limit')
    (heavy / "c.urdf").write_text(text)
    stuck = load(replace(loaded.motion, object_urdf=heavy / "c.urdf"), heavy, SETTINGS.prepare)
    assert not execute(stuck, EXECUTION, engine="mujoco", hold=Hold.CONTACT).success


def test_an_arm_that_goes_through_the_object_is_noticed(drawer: tuple[Loaded, Path]) -> None:
    """The object stands 30 cm farther in front than it was planned: the arm runs into it."""
    loaded = drawer[0]
    T = loaded.motion.T_world_object.copy()
    T[:3, 3] += [-0.3, 0.0, 0.0]
    result = execute(changed(loaded, T_world_object=T), EXECUTION, engine="mujoco", hold=Hold.WELD)
    assert not result.success
    assert result.depth > 0.0
    assert result.deepest is not None


def test_the_film_moves_and_the_still_has_three_panels(drawer: tuple[Loaded, Path], pulled: Execution) -> None:
    loaded, folder = drawer
    few = replace(pulled, frames=(*pulled.frames[:1], *pulled.frames[20::24], *pulled.frames[-1:]))
    write_film(loaded, few, folder / "film.gif", folder / "still.png")
    with Image.open(folder / "film.gif") as film:
        assert film.n_frames == len(few.frames)
        assert film.size == (360, 290)
        first = np.asarray(film.convert("RGB"))
        film.seek(film.n_frames - 1)
        assert (first != np.asarray(film.convert("RGB"))).mean() > 0.01
    with Image.open(folder / "still.png") as still:
        assert still.width == 3 * 360
