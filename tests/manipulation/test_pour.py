"""Pouring: the object that is made of cup and container, the plan, and its execution."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from kinematify.cli.app import run
from kinematify.errors import InputError
from kinematify.geometry.scene import read_scene
from kinematify.manipulation.execute import execute, load
from kinematify.manipulation.kinematics import Arm
from kinematify.manipulation.manipulator import builtin_robot
from kinematify.manipulation.plan_request import Failure, Hold
from kinematify.manipulation.pour import (
    ABOVE,
    TILT_DEG,
    PourPlan,
    Vessel,
    plan_pour,
    pour_motion,
    read_vessel,
    write_pour,
)
from kinematify.robot.read import read_robot
from tests.manipulation.furniture import SETTINGS, box


def ring(radius: float, height: float, sides: int) -> str:
    """A vessel of a floor and flat walls."""
    walls = []
    for angle in 2.0 * np.pi * np.arange(sides) / sides:
        x, y, width = radius * np.cos(angle), radius * np.sin(angle), 2.2 * np.pi * radius / sides
        walls.append(
            f'<visual><origin xyz="{x} {y} {0.5 * height}" rpy="0 0 {angle}"/>'
            f'<geometry><box size="0.004 {width} {height}"/></geometry></visual>'
        )
    return box((1.6 * radius, 1.6 * radius, 0.004), (0.0, 0.0, 0.002)) + "".join(walls)


def write_vessel(path: Path, name: str, *, radius: float, height: float) -> Path:
    """A cup or a bowl."""
    path.write_text(f'<robot name="{name}"><link name="shell">{ring(radius, height, 12)}</link></robot>')
    return path


@pytest.fixture(scope="module")
def vessels(tmp_path_factory: pytest.TempPathFactory) -> tuple[Vessel, Vessel, Path]:
    folder = tmp_path_factory.mktemp("pour")
    cup = write_vessel(folder / "cup.urdf", "cup", radius=0.035, height=0.1)
    bowl = write_vessel(folder / "bowl.urdf", "bowl", radius=0.09, height=0.06)
    return read_vessel(cup, folder / "a.urdf", SETTINGS), read_vessel(bowl, folder / "b.urdf", SETTINGS), folder


@pytest.fixture(scope="module")
def plan(vessels: tuple[Vessel, Vessel, Path]) -> PourPlan:
    cup, bowl, folder = vessels
    return plan_pour(Arm(builtin_robot(), SETTINGS.task.plan), cup, bowl, folder, SETTINGS)


@pytest.mark.parametrize("yaw", [0.0, 1.0])
def test_the_lip_ends_above_the_middle_of_the_container(vessels: tuple[Vessel, Vessel, Path], yaw: float) -> None:
    cup, bowl, folder = vessels
    pour = write_pour(cup, bowl, yaw, folder / "made.urdf")
    scene = read_scene(read_robot(pour.urdf), SETTINGS.geometry)
    motion = pour_motion(scene, pour)
    names = [body.name for body in scene.bodies]
    container = scene.bodies[names.index("into_shell")]
    corners = np.concatenate(container.shapes)
    T = motion.body_poses[0][names.index("into_shell")]
    low, high = (f((corners @ T[:3, :3].T + T[:3, 3]), axis=0) for f in (np.min, np.max))
    pivot = motion.link_poses[-1][:3, 3]
    assert pivot[:2] == pytest.approx(0.5 * (low + high)[:2], abs=0.01)
    assert pivot[2] >= high[2] + ABOVE - 1e-9
    assert low[2] == pytest.approx(0.0, abs=1e-9)


def test_the_cup_stays_upright_until_it_tilts(vessels: tuple[Vessel, Vessel, Path]) -> None:
    cup, bowl, folder = vessels
    pour = write_pour(cup, bowl, 0.5, folder / "made.urdf")
    scene = read_scene(read_robot(pour.urdf), SETTINGS.geometry)
    poses = pour_motion(scene, pour).link_poses
    up = poses[:, :3, :3] @ np.array([0.0, 0.0, 1.0])
    tilting = np.flatnonzero(up[:, 2] < 1.0 - 1e-9)
    assert np.ptp(poses[tilting[0] - 1 :, :3, 3], axis=0) == pytest.approx(np.zeros(3), abs=1e-9)
    assert np.degrees(np.arccos(up[-1, 2])) == pytest.approx(TILT_DEG, abs=1e-6)
    assert up[-1, 0] > 0.0  # towards the container


def test_the_arm_pours(plan: PourPlan) -> None:
    assert plan.failure is None, plan.words
    assert plan.fraction == pytest.approx(1.0)
    assert plan.motion is not None
    assert plan.motion.opened[-1] == pytest.approx(np.radians(TILT_DEG))


def test_engines_pour(plan: PourPlan, vessels: tuple[Vessel, Vessel, Path]) -> None:
    assert plan.motion is not None
    loaded = load(plan.motion, vessels[2], SETTINGS.prepare)
    for result in (
        execute(loaded, SETTINGS.task.execution, engine="mujoco", hold=Hold.WELD),
        execute(loaded, SETTINGS.task.execution, engine="pybullet", hold=Hold.WELD),
    ):
        assert result.success, result.reason


def test_a_cup_that_is_too_wide_is_not_held(vessels: tuple[Vessel, Vessel, Path], tmp_path: Path) -> None:
    block = tmp_path / "block.urdf"
    block.write_text(f'<robot name="box"><link name="b">{box((0.3, 0.3, 0.3), (0, 0, 0.15))}</link></robot>')
    vessel = read_vessel(block, tmp_path / "c.urdf", SETTINGS)
    arm = Arm(builtin_robot(), SETTINGS.task.plan)
    assert plan_pour(arm, vessel, vessels[1], tmp_path, SETTINGS).failure is Failure.NO_GRASP


def test_a_vessel_needs_geometry(tmp_path: Path) -> None:
    path = tmp_path / "cup.urdf"
    path.write_text('<robot name="cup"><link name="a"/></robot>')
    with pytest.raises(InputError, match="no geometry"):
        read_vessel(path, tmp_path / "c.urdf", SETTINGS)


@pytest.mark.parametrize(
    "words", [["--task", "pour"], ["--task", "pull", "--into", "bowl.urdf"], ["--into", "bowl.urdf"]]
)
def test_pour_and_its_container_belong_together(
    vessels: tuple[Vessel, Vessel, Path], words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["validate", str(vessels[2] / "cup.urdf"), *words]) == 2
    assert "--into" in capsys.readouterr().err
