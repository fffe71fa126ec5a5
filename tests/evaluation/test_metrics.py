"""Scores of whole mechanisms: hand-made cases, and laws that hold for any prediction."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematify.assembly.erasure import GroundTruth, TrueJoint
from kinematify.contact.tree import KinematicTree
from kinematify.evaluation.metrics import (
    NOTHING_PREDICTED,
    JointScore,
    ObjectScore,
    Prediction,
    prediction_of,
    score_object,
)
from kinematify.joints.candidate import JointCandidate, JointEstimate
from kinematify.robot.joint_type import JointType

X, Y, Z = np.eye(3)
CENTROIDS = [np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.5])]
DIAGONALS = [1.0, 1.0, 1.0]


def true_joint(**changes: object) -> TrueJoint:
    facts = {
        "name": "hinge",
        "serial": 0,
        "chain_length": 1,
        "mimic": None,
        "parent": 0,
        "child": 1,
        "kind": JointType.REVOLUTE,
        "axis": Z,
        "pivot": np.array([0.5, 0.0, 0.0]),
        "lower": 0.0,
        "upper": 1.5,
        "value": 0.0,
    }
    facts.update(changes)
    return TrueJoint(source=str(facts["name"]), **facts)  # type: ignore[arg-type]


def predicted_joint(**changes: object) -> JointEstimate:
    facts = {
        "parent": 0,
        "child": 1,
        "kind": JointType.REVOLUTE,
        "axis": Z,
        "pivot": np.array([0.5, 0.0, 0.0]),
        "lower": 0.0,
        "upper": 1.5,
        "confidence": 0.5,
    }
    return JointEstimate(**{**facts, **changes})  # type: ignore[arg-type]


DRAWER = {"name": "slide", "child": 2, "kind": JointType.PRISMATIC, "axis": X, "upper": 0.4}


def truth_of(*joints: TrueJoint, part_names: tuple[str, ...] = ("part_a", "part_b", "part_c")) -> GroundTruth:
    return GroundTruth(
        name="object",
        part_names=part_names,
        part_links=tuple((f"link of {name}",) for name in part_names),
        joints=joints,
        dropped=(),
        configuration={joint.name: joint.value for joint in joints},
        pose="rest",
        seed=0,
        yaw_deg=0.0,
    )


TRUTH = truth_of(true_joint(), true_joint(**DRAWER))


def prediction(*joints: JointEstimate, parents: tuple[int, ...] = (-1, 0, 0)) -> Prediction:
    return Prediction(parents=dict(enumerate(parents)), joints=joints)


def score(truth: GroundTruth, guess: Prediction, **given: object) -> ObjectScore:
    return score_object(truth, guess, centroids=CENTROIDS, part_diagonals=DIAGONALS, diagonal=2.0, **given)  # type: ignore[arg-type]


def hinge_score(**changes: object) -> JointScore:
    return score(TRUTH, prediction(predicted_joint(**changes))).joints[0]


SLIDE = predicted_joint(child=2, kind=JointType.PRISMATIC, axis=X, upper=0.4)


def test_perfect_prediction_has_perfect_scores() -> None:
    result = score(TRUTH, prediction(predicted_joint(), SLIDE))
    assert (result.ted.value, result.ted_unlabelled.value, result.parent_errors, result.root_right) == (0, 0, 0, True)
    hinge, slide = result.joints
    assert (hinge.angle_deg, hinge.line_m, hinge.pivot_m, hinge.limit_iou, hinge.opens) == (0.0, 0.0, 0.0, 1.0, True)
    assert (slide.angle_deg, slide.line_m, slide.pivot_m, slide.limit_iou, slide.opens) == (0.0, None, None, 1.0, True)
    assert hinge.type_right
    assert slide.type_right_strict
    assert (hinge.parent, hinge.child) == ("part_a", "part_b")


def test_missing_pair_counts_ninety_degrees_and_a_wrong_type() -> None:
    result = score(TRUTH, prediction(predicted_joint(), predicted_joint(parent=1, child=2), parents=(-1, 0, 1)))
    slide = result.joints[1]
    assert (slide.matched, slide.angle_deg, slide.type_right, slide.limit_iou) == (False, 90.0, False, 0.0)
    assert (slide.line_m, slide.pivot_m, slide.opens) == (None, None, False)
    assert (result.ted.value, result.parent_errors, result.root_right) == (2, 1, True)


def test_nothing_predicted_misses_everything() -> None:
    result = score(TRUTH, NOTHING_PREDICTED)
    assert [joint.angle_deg for joint in result.joints] == [90.0, 90.0]
    assert (result.ted.value, result.parent_errors, result.root_right) == (3, 3, False)


@pytest.mark.parametrize(("off", "right"), [(0.09, True), (0.11, False)])
def test_an_origin_is_right_within_a_tenth_of_the_moving_part(off: float, right: bool) -> None:
    hinge = hinge_score(pivot=np.array([0.5, off, 0.0]))
    assert (hinge.type_right, hinge.axis_right, hinge.origin_right) == (True, True, right)


def test_an_axis_is_right_within_five_degrees_and_a_slide_has_no_origin() -> None:
    tilted = [np.array([0.0, math.sin(angle), math.cos(angle)]) for angle in (math.radians(4.9), math.radians(5.1))]
    assert [hinge_score(axis=axis).axis_right for axis in tilted] == [True, False]
    slide = predicted_joint(child=2, kind=JointType.PRISMATIC, axis=X, pivot=np.array([9.0, 9.0, 9.0]))
    assert score(TRUTH, prediction(slide)).joints[1].origin_right
    assert not score(TRUTH, NOTHING_PREDICTED).joints[1].origin_right


def test_continuous_counts_as_revolute_unless_strict() -> None:
    joint = hinge_score(kind=JointType.CONTINUOUS, lower=-math.inf, upper=math.inf)
    assert joint.type_right
    assert not joint.type_right_strict
    assert joint.limit_iou == pytest.approx(1.5 / (2.0 * math.pi))


def test_wrong_type_is_measured_by_the_best_candidate_of_the_true_one() -> None:
    tilted = np.array([0.0, 0.6, 0.8])
    alternatives = tuple(
        JointCandidate(kind=kind, axis=axis, pivot=np.zeros(3), score=1.0, source="test")
        for kind, axis in ((JointType.PRISMATIC, X), (JointType.CONTINUOUS, tilted), (JointType.REVOLUTE, Z))
    )
    joint = hinge_score(kind=JointType.PRISMATIC, axis=X, alternatives=alternatives)
    assert joint.angle_deg == 90.0
    assert joint.angle_given_type_deg == pytest.approx(math.degrees(math.acos(0.8)))
    assert joint.limit_iou == 0.0
    assert hinge_score(kind=JointType.PRISMATIC, axis=X).angle_given_type_deg == 90.0


def test_line_is_measured_at_the_child_and_pivot_point_to_point() -> None:
    joint = hinge_score(pivot=np.array([0.5, 0.1, 3.0]))
    assert joint.line_m == pytest.approx(0.1)
    assert joint.pivot_m == pytest.approx(math.hypot(0.1, 3.0))


@pytest.mark.parametrize(("axis", "opens"), [(Z, True), (-Z, False)])
def test_opening_direction_is_the_sign_of_the_predicted_axis(axis: np.ndarray, opens: bool) -> None:
    assert hinge_score(axis=axis).opens is opens


def test_two_true_joints_between_two_parts_share_one_prediction() -> None:
    """A screw cap: the predicted joint stands for the one that it fits best; the other is missing."""
    cap = true_joint(name="turn", kind=JointType.CONTINUOUS, lower=-math.inf, upper=math.inf)
    lift = true_joint(name="lift", kind=JointType.PRISMATIC, upper=0.1)
    for kind, expected in ((JointType.REVOLUTE, (True, False)), (JointType.PRISMATIC, (False, True))):
        joints = score(truth_of(cap, lift), prediction(predicted_joint(kind=kind))).joints
        assert tuple(joint.matched for joint in joints) == expected
        assert sorted(joint.angle_deg for joint in joints) == [0.0, 90.0]


def test_fingers_are_deleted_from_both_trees() -> None:
    wrong_finger = prediction(predicted_joint(), predicted_joint(parent=1, child=2), parents=(-1, 0, 1))
    result = score(TRUTH, wrong_finger, gripper_joints=["slide"])
    assert [joint.gripper for joint in result.joints] == [False, True]
    assert (result.ted.value, result.ted_without_gripper.value) == (2, 0)


def test_prediction_is_translated_by_part_name() -> None:
    tree = KinematicTree(parents=(2, 2, -1))
    candidates = (JointCandidate(kind=JointType.PRISMATIC, axis=Y, pivot=X, score=1.0, source="test"),)
    estimates = [
        JointEstimate(
            parent=2,
            child=child,
            kind=JointType.REVOLUTE,
            axis=Z,
            pivot=X,
            lower=0.0,
            upper=1.0,
            confidence=1.0,
            alternatives=candidates,
        )
        for child in (0, 1)
    ]
    guess = prediction_of(tree, estimates, ["c", "a", "b"], {"a": 0, "b": 1, "c": 2})
    assert guess.parents == {2: 1, 0: 1, 1: -1}
    assert [(joint.parent, joint.child) for joint in guess.joints] == [(1, 2), (1, 0)]
    assert guess.joints[0].alternatives[0].kind == JointType.PRISMATIC


numbers = st.floats(-1.0, 1.0, allow_nan=False, width=32)
vectors = st.tuples(numbers, numbers, numbers).map(lambda values: np.array(values, dtype=np.float64))
units = vectors.filter(lambda vector: float(np.linalg.norm(vector)) > 0.1).map(
    lambda vector: vector / np.linalg.norm(vector)
)
ranges = st.tuples(numbers, numbers).map(sorted)
kinds = st.sampled_from([JointType.REVOLUTE, JointType.PRISMATIC])


@st.composite
def guesses(draw: st.DrawFn) -> JointEstimate:
    lower, upper = draw(ranges)
    return predicted_joint(
        kind=draw(kinds), axis=draw(units), pivot=draw(vectors), lower=float(lower), upper=float(upper)
    )


@settings(deadline=None, max_examples=80)
@given(guess=guesses(), kind=kinds, axis=units, limits=ranges)
def test_flipping_either_axis_with_its_limits_is_the_same_joint(
    guess: JointEstimate, kind: JointType, axis: np.ndarray, limits: list[float]
) -> None:
    lower, upper = map(float, limits)
    truth = true_joint(kind=kind, axis=axis, lower=lower, upper=upper)
    flipped_truth = true_joint(kind=kind, axis=-axis, lower=-upper, upper=-lower)
    flipped_guess = replace(guess, axis=-guess.axis, lower=-guess.upper, upper=-guess.lower)
    expected = score(truth_of(truth), prediction(guess)).joints[0]
    of_truth = score(truth_of(flipped_truth), prediction(guess)).joints[0]
    of_guess = score(truth_of(truth), prediction(flipped_guess)).joints[0]
    # The direction in which the positive side opens is the one thing that a flip of the prediction does change.
    for other in (of_truth, replace(of_guess, opens=expected.opens)):
        assert same(other, expected)


def same(first: JointScore, second: JointScore) -> bool:
    pairs = [(getattr(first, name), getattr(second, name)) for name in vars(first)]
    return all(a == pytest.approx(b, abs=1e-9) if isinstance(a, float) else a == b for a, b in pairs)
