"""`kinematify view`: what it shows of a model, without and with its server."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from kinematify.cli.app import run
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.view.alternatives import JointAlternative, agreeing, described
from kinematify.view.viewer_scene import ViewScene
from tests.view.pages import candidates_in

_URDF = """<robot name="door">
<link name="frame"><collision><geometry><box size="1 0.1 2"/></geometry></collision></link>
<link name="door"><collision><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.04 1.8"/></geometry></collision></link>
<link name="plate"><collision><geometry><box size="0.1 0.02 0.02"/></geometry></collision></link>
<joint name="hinge" type="revolute"><parent link="frame"/><child link="door"/><origin xyz="-0.4 -0.1 0" rpy="0 0 -0.1"/>
<axis xyz="0 0 -1"/><limit lower="-0.5" upper="1.5" effort="1" velocity="1"/></joint>
<joint name="glue" type="fixed"><parent link="door"/><child link="plate"/><origin xyz="0.8 -0.1 0"/></joint>
</robot>"""


@pytest.fixture
def urdf(tmp_path: Path) -> Path:
    file = tmp_path / "model.urdf"
    file.write_text(_URDF)
    return file


@pytest.fixture
def scene(urdf: Path) -> ViewScene:
    return ViewScene(read_robot(urdf))


def test_bodies_stand_where_the_joints_put_them(scene: ViewScene) -> None:
    for value in (-0.3, 0.0, 1.2):
        ours, reference = scene.poses({"hinge": value}), forward_kinematics(scene.robot, {"hinge": value})
        assert all(np.allclose(ours[link], reference[link]) for link in reference)
    vertices, faces = scene.meshes["door"]
    assert len(faces) == 24, "the plate is glued to the door"
    assert vertices[:, 0].max() == pytest.approx(0.85)


def test_collisions_are_reported_apart_from_contact(scene: ViewScene) -> None:
    assert scene.touches({"hinge": 1.0}) == []
    ((pair, depth, tolerated),) = scene.touches({"hinge": -0.5})
    assert set(pair) == {"frame", "door"}
    assert not tolerated
    assert depth > 0.01


def test_an_alternative_replaces_axis_place_and_type(scene: ViewScene) -> None:
    slide = JointAlternative(kind=JointType.PRISMATIC, axis=np.array([0.0, -1.0, 0.0]), pivot=np.array([3.0, 0.0, 0.0]))
    at_zero = scene.poses({"hinge": 0.0})["door"]
    scene.try_joint("hinge", slide)
    assert np.allclose(scene.poses({"hinge": 0.0})["door"], at_zero)
    moved = scene.poses({"hinge": 0.7})["door"]
    assert np.allclose(moved[:3, 3] - at_zero[:3, 3], [0.0, -0.7, 0.0])
    other_edge = JointAlternative(
        kind=JointType.REVOLUTE, axis=np.array([0.0, 0.0, 1.0]), pivot=np.array([0.4, -0.1, 0.0])
    )
    scene.try_joint("hinge", other_edge)
    still = np.array([0.4, -0.1, 0.5, 1.0])
    in_door = np.linalg.solve(at_zero, still)
    assert np.allclose(scene.poses({"hinge": 0.9})["door"] @ in_door, still), "points on its axis stand still"
    scene.try_joint("hinge", None)
    assert np.allclose(scene.poses({"hinge": 0.9})["door"], forward_kinematics(scene.robot, {"hinge": 0.9})["door"])


@pytest.mark.usefixtures("urdf")
def test_alternatives_of_a_record(tmp_path: Path) -> None:
    candidate = {"type": "revolute", "axis": [0, 0, 1], "pivot": [1, 2, 3], "score": 0.5, "source": "panel"}
    record = {"joints": [{"parent": "frame", "child": "door", "candidates": [candidate]}]}
    (tmp_path / "inference.json").write_text(json.dumps(record))
    found, fixed = candidates_in(tmp_path)["frame", "door"]
    assert (found.kind, found.pivot.tolist()) == (JointType.REVOLUTE, [1.0, 2.0, 3.0])
    assert fixed.kind is JointType.FIXED


_BOUNDS = np.array([[0.0, -0.02, 0.0], [0.6, 0.02, 1.0]])


@pytest.mark.parametrize(
    ("kind", "axis", "pivot", "words"),
    [
        (JointType.REVOLUTE, (0.0, 0.0, 1.0), (0.0, 0.0, 0.3), "turns about its left edge, axis upright"),
        (JointType.REVOLUTE, (0.0, 0.0, -1.0), (0.6, 0.0, 0.3), "turns about its right edge, axis upright"),
        (JointType.REVOLUTE, (1.0, 0.0, 0.0), (0.1, 0.0, 1.0), "turns about its upper edge, axis from left to right"),
        (JointType.REVOLUTE, (0.0, 1.0, 0.0), (0.3, 0.0, 0.5), "turns about its middle, axis from front to back"),
        (JointType.PRISMATIC, (0.0, -1.0, 0.0), (0.0, 0.0, 0.0), "slides out or in"),
        (JointType.PRISMATIC, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), "slides up or down"),
        (JointType.FIXED, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), "fixed"),
    ],
)
def test_candidates_are_said_in_words(
    kind: JointType, axis: tuple[float, ...], pivot: tuple[float, ...], words: str
) -> None:
    item = JointAlternative(kind=kind, axis=np.array(axis), pivot=np.array(pivot), probability=0.224)
    assert described(item, _BOUNDS) == f"{words}, 22 %"


def test_candidates_agree_with_the_confidence_of_the_joint_in_the_file() -> None:
    def turn(x: float, probability: float | None) -> JointAlternative:
        axis, pivot = np.array([0.0, 0.0, 1.0]), np.array([x, 0.0, 0.0])
        return JointAlternative(kind=JointType.REVOLUTE, axis=axis, pivot=pivot, probability=probability)

    found = agreeing([turn(0.6, 0.4), turn(0.0, 0.3), turn(0.3, 0.1)], turn(0.01, None), 0.75, size=1.0)
    assert [item.probability for item in found] == pytest.approx([0.75, 0.2, 0.05]), "the joint of the file is first"


def test_a_candidate_gets_the_range_that_is_free(scene: ViewScene) -> None:
    hinge = scene.robot.joint_by_name["hinge"]
    slide = JointAlternative(kind=JointType.PRISMATIC, axis=np.array([0.0, 1.0, 0.0]), pivot=np.zeros(3))
    scene.try_joint("hinge", slide)
    lower, upper = scene.free_range(hinge)
    assert lower == pytest.approx(-scene.size)
    assert 0.0 <= upper < 0.1 * scene.size, "the frame is behind the door"


def test_a_model_that_another_program_changes_is_shown_again(urdf: Path) -> None:
    from kinematify.view.window import model_window  # needs viser

    window = model_window(urdf, port=18087)
    window.run_aside()
    try:
        urdf.write_text(_URDF.replace("hinge", "pivot"))
        os.utime(urdf, (1.0, 1.0))
        until = time.monotonic() + 300.0
        while not window.viewer._panel.news.visible and time.monotonic() < until:  # what is done last
            time.sleep(0.2)
        assert set(window.viewer.values) == {"pivot"}
    finally:
        window.close()


def test_a_model_without_colours_gets_some_and_one_with_colours_keeps_them(urdf: Path, scene: ViewScene) -> None:
    invented = {surfaces[0].material.color for surfaces in scene.surfaces.values()}
    assert len(invented) == len(scene.surfaces)
    red = _URDF.replace("</collision></link>", "</collision></link>", 1).replace(
        '<link name="door"><collision>',
        '<link name="door"><visual><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.04 1.8"/></geometry>'
        '<material name="r"><color rgba="1 0 0 0.5"/></material></visual><collision>',
    )
    urdf.write_text(red)
    shown = ViewScene(read_robot(urdf, appearance=True)).surfaces
    assert (1.0, 0.0, 0.0, 0.5) in {surface.material.color for surface in shown["door"]}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["none.urdf"], "There is no file none.urdf"),
        (["{two}"], "has 2 URDF files (a.urdf, b.urdf)"),
        (["{urdf}", "--joint", "hinge"], "1 --joint and 0 --q"),
        (["{urdf}", "--joint", "knob", "--q", "1"], "It has hinge."),
        (["{urdf}", "--report", "{urdf}"], "is no report of one model"),
    ],
)
def test_bad_arguments(urdf: Path, arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    two = urdf.parent / "two"
    two.mkdir()
    for name in ("a.urdf", "b.urdf"):
        (two / name).write_text(_URDF)
    assert run(["view", *(argument.format(urdf=urdf, two=two) for argument in arguments)]) == 2
    assert words in capsys.readouterr().err


def test_it_prints_its_address_and_ends_with_ctrl_c(urdf: Path) -> None:
    finding = {"check": "KV310", "severity": "error", "joint": "hinge", "pair": ["frame", "door"], "link": None,
               "q": {"hinge": -0.5}, "message": "m", "remedy": "r"}  # fmt: skip
    (urdf.parent / "validation.json").write_text(json.dumps({"findings": [finding]}))
    candidate = {"type": "prismatic", "axis": [0, 1, 0], "pivot": [0, 0, 0], "score": 0.5, "source": "rail"}
    record = {"joints": [{"parent": "frame", "child": "door", "candidates": [candidate]}]}
    (urdf.parent / "inference.json").write_text(json.dumps(record))
    command = [sys.executable, "-m", "kinematify", "view", str(urdf.parent), "--joint", "hinge", "--q", "0.5", "--port"]
    process = subprocess.Popen(
        [*command, "18081"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    assert process.stdout is not None
    line = process.stdout.readline()
    process.send_signal(signal.SIGINT)
    rest, errors = process.communicate(timeout=300)
    assert line.startswith("http://localhost:"), errors
    assert rest == "Closed.\n"
    assert errors == ""
    assert process.returncode == 0


def test_a_model_whose_collision_mesh_is_missing_is_seen_all_the_same(urdf: Path) -> None:
    from kinematify.view.window import model_window  # needs viser

    shape = '<geometry><box size="1 0.1 2"/></geometry>'
    missing = f'<visual>{shape}</visual><collision><geometry><mesh filename="gone.obj"/></geometry></collision>'
    urdf.write_text(_URDF.replace(f"<collision>{shape}</collision>", missing, 1))
    window = model_window(urdf, port=18085)
    try:
        window.viewer.look_for_collisions()
        assert window.viewer.status == "Nothing collides."  # what is missing is omitted, and the command says so
        assert any("gone.obj" in note for note in read_robot(urdf).notes)
    finally:
        window.close()
