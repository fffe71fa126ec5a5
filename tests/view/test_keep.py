"""A candidate that is kept in the viewer is the joint of the file from then on."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.errors import InputError
from kinematify.refinement.folder import read_record
from kinematify.refinement.hints import Hint
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.view.alternatives import JointAlternative
from kinematify.view.inference_view import shown_with
from kinematify.view.keep import ModelFolder
from kinematify.view.viewer_scene import ViewScene
from tests.inferred import write_inferred
from tests.view.pages import candidates_in

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_inferred("edge_door", tmp_path / "model")


def test_keeping_writes_the_joint_the_hint_and_the_command_and_can_be_taken_back(folder: Path) -> None:
    (joint,) = read_robot(folder / "model.urdf").joints
    assert joint.kind is JointType.REVOLUTE
    choices = candidates_in(folder)[joint.parent, joint.child]
    slide = next(item for item in choices if item.kind is JointType.PRISMATIC)
    files = {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()}
    kept = ModelFolder(folder)
    reported = kept.keep(joint.child, slide)
    assert not list(folder.rglob("*.mtl"))  # nothing has a colour of its own
    (found,) = read_robot(folder / "model.urdf").joints
    assert found.kind is JointType.PRISMATIC
    assert abs(float(found.axis @ slide.axis)) > 0.99
    assert reported.hints[0] == f"{joint.child}=prismatic"
    assert tuple(read_record(folder)["hints"]) == reported.hints
    assert all(f"--hint {text}" in reported.command for text in reported.hints)
    kept.undo()
    assert {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()} == files
    with pytest.raises(InputError, match="Nothing was chosen"):
        kept.undo()


def test_fixed_is_a_choice_and_another_viewer_goes_on_from_it(folder: Path) -> None:
    (joint,) = read_robot(folder / "model.urdf").joints
    *_, fixed = candidates_in(folder)[joint.parent, joint.child]
    ModelFolder(folder).keep(joint.child, fixed)
    assert read_robot(folder / "model.urdf").joints[0].kind is JointType.FIXED
    turn = replace(fixed, kind=JointType.REVOLUTE, pivot=joint.T_parent_child[:3, 3])
    reported = ModelFolder(folder).keep(joint.child, turn)
    assert read_robot(folder / "model.urdf").joints[0].kind is JointType.REVOLUTE
    assert f"{joint.child}=fixed" not in reported.command, "the last word counts"


def test_a_model_that_was_changed_by_hand_is_left_as_it_is(folder: Path) -> None:
    path = folder / "model.urdf"
    path.write_text(path.read_text().replace("<robot", "<!-- mine --><robot", 1))
    changed = path.read_bytes()
    (joint,) = read_robot(path).joints
    *_, fixed = candidates_in(folder)[joint.parent, joint.child]
    with pytest.raises(InputError, match="was changed"):
        ModelFolder(folder).keep(joint.child, fixed)
    assert path.read_bytes() == changed


def test_what_was_set_by_hand_is_written_with_its_limits(folder: Path) -> None:
    (joint,) = read_robot(folder / "model.urdf").joints
    axis, pivot = np.array([0.0, 0.6, -0.8]), np.array([0.01, 0.02, 0.03])
    by_hand = JointAlternative(kind=JointType.REVOLUTE, axis=axis, pivot=pivot, by_hand=True, limits=(-0.25, 1.25))
    reported = ModelFolder(folder).keep(joint.child, by_hand)
    assert f"{joint.child}:range=-0.25..1.25" in reported.hints
    (found,) = read_robot(folder / "model.urdf").joints
    turned = float(found.axis @ axis)
    assert abs(turned) > 1.0 - 1e-9
    assert (found.lower, found.upper) == pytest.approx((-0.25, 1.25) if turned > 0.0 else (-1.25, 0.25))
    assert np.linalg.norm(np.cross(found.T_parent_child[:3, 3] - pivot, axis)) < 1e-5
    assert tuple(read_record(folder)["hints"]) == reported.hints
    endless = replace(by_hand, kind=JointType.CONTINUOUS, limits=None)
    ModelFolder(folder).keep(joint.child, endless)
    assert read_robot(folder / "model.urdf").joints[0].kind is JointType.CONTINUOUS


def test_another_parent_is_written_as_a_hint_and_can_be_taken_back(tmp_path: Path) -> None:
    folder = tmp_path / "model"
    write_inferred("toilet", folder)
    record = read_record(folder)
    (lid,) = (joint for joint in record["joints"] if joint["child"] == "lid")
    other = "seat" if lid["parent"] == "bowl" else "bowl"
    shown = shown_with(ViewScene(read_robot(folder / "model.urdf")), folder / "inference.json")
    assert other in shown.parents["lid"]
    kept = ModelFolder(folder)
    reported = kept.state(Hint(part="lid", parent=other))
    assert reported.hints == (f"lid:parent={other}",)
    (joint,) = (joint for joint in read_robot(folder / "model.urdf").joints if joint.child == "lid")
    assert joint.parent == other
    kept.undo()
    assert read_record(folder)["trees"][0]["parents"]["lid"] == lid["parent"]
