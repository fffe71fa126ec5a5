"""`estimate_joints`: what holds for every answer, and how answers follow the input."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.joints.choice.decide import estimate_joints
from tests.joints.joint_scenes import CONFIG, estimates_of, evidence, infer_joints
from tests.known import transformed
from tests.objects import BUILDERS, shuffled, with_yaw

if TYPE_CHECKING:
    from kinematify.joints.candidate import JointEstimate
    from kinematify.robot.arrays import FloatArray

SOME = ("edge_door", "drawer", "knob", "parallel_gripper", "universal_joint")


@pytest.mark.parametrize("name", ["hinge_pin", "laptop", "lever", "universal_joint", "torso", "scissors"])
def test_bearing_lines_are_used_as_they_are(name: str) -> None:
    known = BUILDERS[name]()
    estimates = estimates_of(name)
    for joint in known.joints:
        estimate = estimates[joint.child]
        angle = np.degrees(np.arccos(min(1.0, abs(float(estimate.axis @ joint.axis)))))
        distance = np.linalg.norm(np.cross(estimate.pivot - joint.pivot, joint.axis))
        assert angle < 0.5, joint.child
        assert distance < 2e-3 * known.assembly.diagonal, joint.child


@pytest.mark.parametrize("name", SOME)
def test_every_answer_is_well_formed(name: str) -> None:
    known = BUILDERS[name]()
    tree, graph, bearings = evidence(known)
    estimates = estimate_joints(known.assembly, graph, tree, bearings, config=CONFIG.joints, seed=0)
    assert [(e.parent, e.child) for e in estimates] == list(tree.edges())
    for estimate in estimates:
        assert np.linalg.norm(estimate.axis) == pytest.approx(1.0)
        assert np.isfinite(estimate.pivot).all()
        assert 0.0 <= estimate.confidence <= 1.0
        assert estimate.lower <= 0.0 <= estimate.upper
        scores = [candidate.score for candidate in estimate.alternatives]
        assert scores == sorted(scores, reverse=True)
        assert len(scores) <= 2 * CONFIG.joints.alternatives
        best = estimate.alternatives[0]
        assert best.kind.turns == estimate.kind.turns
        assert abs(float(best.axis @ estimate.axis)) == pytest.approx(1.0)


def same_joints(
    first: dict[str, JointEstimate], second: dict[str, JointEstimate], turn: FloatArray, degrees: float
) -> None:
    """Assert that the second answer is the first one, turned."""
    assert set(first) == set(second)
    for child, before in first.items():
        after = second[child]
        assert after.kind is before.kind
        assert float(after.axis @ (turn @ before.axis)) > np.cos(np.radians(degrees)), child
        if np.isfinite(before.upper) and before.kind.turns:
            assert after.upper == pytest.approx(before.upper, abs=0.3)


@pytest.mark.parametrize("name", SOME)
def test_order_of_parts_does_not_matter(name: str) -> None:
    known = BUILDERS[name]()
    same_joints(estimates_of(name), infer_joints(shuffled(known, 3)), np.eye(3), 0.5)


@pytest.mark.parametrize("name", SOME)
def test_turning_about_z_turns_the_answer(name: str) -> None:
    known = BUILDERS[name]()
    c, s = np.cos(0.65), np.sin(0.65)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    same_joints(estimates_of(name), infer_joints(with_yaw(known, 0.65)), turn, 1.0)


@pytest.mark.parametrize("name", ["edge_door", "drawer"])
def test_scale_and_place_do_not_matter(name: str) -> None:
    known = BUILDERS[name]()
    transform = np.column_stack([100.0 * np.eye(3), [30.0, -20.0, 5.0]])
    large = replace(known, parts=tuple(transformed(part, transform) for part in known.parts))
    first, second = estimates_of(name), infer_joints(large)
    same_joints(first, second, np.eye(3), 0.5)
    for child, before in first.items():
        if not before.kind.turns:
            assert second[child].upper == pytest.approx(100.0 * before.upper, rel=0.1)


def test_the_same_input_gives_the_same_answer() -> None:
    known = BUILDERS["drawer"]()
    first, second = infer_joints(known)["drawer"], estimates_of("drawer")["drawer"]
    np.testing.assert_array_equal(first.axis, second.axis)
    assert (first.lower, first.upper, first.confidence) == (second.lower, second.upper, second.confidence)
