"""`infer` end to end: the trees and joints of known objects, and the laws that every answer obeys."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.inference import Inference
from kinematify.pipeline.record import inference_record
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import rotation_about
from tests.engines import read_pinocchio
from tests.inferred import inferred, write_inferred
from tests.known import angle_deg
from tests.objects import BUILDERS, KnownObject, posed, shuffled

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray

DEFAULT, PAPER = load_config(), load_config("paper")


@cache
def built(name: str) -> KnownObject:
    return BUILDERS[name]()


@dataclass(frozen=True)
class Answer:
    """A joint with names in place of indices."""

    parent: str
    turns: bool
    axis: FloatArray
    pivot: FloatArray
    limits: tuple[float, float]


def answers(inference: Inference) -> dict[str, Answer]:
    """The joint above every part but the root."""
    names = inference.assembly.names
    return {
        names[joint.child]: Answer(
            names[joint.parent], joint.kind.turns, joint.axis, joint.pivot, (joint.lower, joint.upper)
        )
        for joint in inference.joints
    }


def line_distance(axis: FloatArray, pivot: FloatArray, point: FloatArray) -> float:
    return float(np.linalg.norm(np.cross(axis, point - pivot)))


# ---- known objects -------------------------------------------------------------------------------------------------

BEARINGS = ("hinge_pin", "knob", "lever", "wheel", "torso")
"""Something round on both parts says where the axis is."""
OTHERS = ("edge_door", "drawer", "nested_drawer", "button")


@pytest.mark.parametrize("name", [*BEARINGS, *OTHERS])
def test_known_objects_come_back_with_their_tree_and_joints(name: str) -> None:
    known, found = built(name), answers(inferred(name))
    assert {child: answer.parent for child, answer in found.items()} == {
        joint.child: joint.parent for joint in known.joints
    }
    for truth in known.joints:
        answer = found[truth.child]
        assert answer.turns == truth.kind.turns, truth.child
        assert angle_deg(answer.axis, truth.axis) < 1.0, truth.child
        if truth.kind.turns:
            assert line_distance(answer.axis, answer.pivot, truth.pivot) < 0.01 * known.assembly.diagonal, truth.child


# ---- laws ----------------------------------------------------------------------------------------------------------

LAWFUL = ("hinge_pin", "edge_door", "drawer")


def assert_same(
    inference: Inference, reference: Inference, turn: FloatArray, shift: FloatArray, scale: float = 1.0
) -> None:
    """The answer is the reference's, turned, scaled and moved; a joint may be flipped together with its limits."""
    found, expected = answers(inference), answers(reference)
    diagonal = inference.assembly.diagonal
    assert {child: answer.parent for child, answer in found.items()} == {
        child: answer.parent for child, answer in expected.items()
    }
    for child, before in expected.items():
        after = found[child]
        unit = 1.0 if before.turns else scale
        assert after.turns == before.turns, child
        assert angle_deg(after.axis, turn @ before.axis) < 0.1, child
        if before.turns:
            assert line_distance(after.axis, after.pivot, scale * turn @ before.pivot + shift) < 1e-3 * diagonal, child
        limits = after.limits if after.axis @ turn @ before.axis > 0.0 else (-after.limits[1], -after.limits[0])
        slack = np.radians(5.0) if before.turns else 0.02 * diagonal
        assert limits == pytest.approx((unit * before.limits[0], unit * before.limits[1]), abs=slack), child


@pytest.mark.parametrize("name", LAWFUL)
@pytest.mark.parametrize(("angle", "scale"), [(37.0, 1000.0), (180.0, 0.01)])
def test_the_answer_goes_with_an_object_that_is_turned_moved_and_scaled_with_its_parts_in_another_order(
    name: str, angle: float, scale: float
) -> None:
    transform = np.eye(4)
    turn = transform[:3, :3] = rotation_about(np.array([0.0, 0.0, 1.0]), np.radians(angle))
    shift = transform[:3, 3] = scale * np.array([3.0, -1.0, 0.5])
    transform[:3, :3] *= scale
    there = infer(posed(shuffled(built(name), 3), transform).assembly, config=DEFAULT)
    assert_same(there, inferred(name), turn, shift, scale)


# ---- the record ----------------------------------------------------------------------------------------------------


def lasting(inference: Inference) -> str:
    """The record without what depends on the machine's mood."""
    record = {key: value for key, value in inference_record(inference).items() if key not in ("seconds", "peak_mb")}
    return json.dumps(record, sort_keys=True)


@pytest.mark.parametrize("name", ["nested_drawer"])
def test_the_same_seed_gives_the_same_record(name: str) -> None:
    assert lasting(infer(BUILDERS[name]().assembly, config=DEFAULT)) == lasting(inferred(name))


def test_a_given_base_is_the_root() -> None:
    inference = infer(built("nested_drawer").assembly, config=DEFAULT, base="tray")
    assert inference.assembly.names[inference.trees[0].root] == "tray"
    with pytest.raises(InputError, match="no part lid"):
        infer(built("nested_drawer").assembly, config=DEFAULT, base="lid")


# ---- the model -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["nested_drawer", "torso"])
def test_the_model_at_zero_is_the_input(name: str, tmp_path: Path) -> None:
    inference = inferred(name)
    parts = {part.name: part for part in inference.assembly.parts}
    poses = forward_kinematics(inference.model.robot, {})
    for link in inference.model.links:
        assert np.allclose(poses[link.name], link.T_world_link, atol=1e-12)
    reading = read_pinocchio(write_inferred(name, tmp_path / "out") / "model.urdf", {})
    assert set(reading.vertices) == set(parts)
    for link, vertices in reading.vertices.items():
        given = parts[link].bounds
        assert np.abs([vertices.min(axis=0), vertices.max(axis=0)] - given).max() < 1e-6 * inference.assembly.diagonal


# ---- the paper's method --------------------------------------------------------------------------------------------


def test_the_papers_method_finds_a_hinge_by_dw_cavl_alone() -> None:
    known = built("hinge_pin")
    inference = infer(known.assembly, config=PAPER)
    truth, (joint,) = known.joints[0], inference.joints
    assert not inference.bearings
    assert "bearings" not in inference.timings
    assert {candidate.source.partition("_")[0] for candidate in joint.alternatives} == {"paper"}
    assert joint.kind is JointType.REVOLUTE
    assert angle_deg(joint.axis, truth.axis) < 1.0
    assert line_distance(joint.axis, joint.pivot, truth.pivot) < 0.01 * known.assembly.diagonal
    assert (joint.lower, joint.upper) == (-np.pi, np.pi)


def test_the_papers_method_calls_a_drawer_sliding_with_its_own_length_as_travel() -> None:
    inference = infer(built("drawer").assembly, config=PAPER)
    (joint,) = inference.joints
    moving = inference.assembly.parts[joint.child]
    assert joint.kind is JointType.PRISMATIC
    assert joint.evidence["cavl_score"] == max(candidate.evidence["cavl_score"] for candidate in joint.alternatives)
    assert joint.upper == pytest.approx(np.ptp(moving.vertices @ joint.axis))
    assert joint.lower == -joint.upper
    assert inference.model.joints[0].upper > 0.0
