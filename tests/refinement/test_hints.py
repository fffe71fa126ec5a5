"""Hints decide; what they leave open comes from the geometry, and what cannot be is said with the choices."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematify.errors import InputError
from kinematify.joints.candidate import JointEstimate
from kinematify.pipeline.inference import Inference
from kinematify.refinement.hints import Hint, parse_hints, with_hints
from kinematify.robot.joint_type import JointType
from tests.inferred import inferred

PARTS = ("body", "door_1", "door_2", "lid")


def joint_of(inference: Inference, part: str) -> JointEstimate:
    return next(joint for joint in inference.joints if inference.assembly.names[joint.child] == part)


def moving(inference: Inference) -> str:
    return inference.assembly.names[inference.joints[0].child]


def test_hints_are_read_and_those_on_one_part_are_taken_together() -> None:
    found = parse_hints(["door_1=prismatic", "lid:axis=x", "door_1:axis=y"], PARTS)
    assert found == (Hint(part="door_1", kind=JointType.PRISMATIC, axis="y"), Hint(part="lid", axis="x"))


@pytest.mark.parametrize(
    ("texts", "said"),
    [
        (["door_3=prismatic"], "door_1"),
        (["nosuch=prismatic"], "The parts are body, door_1"),
        (["door_1=sliding"], "prismatic"),
        (["door_1:axis=w"], "x, y, z"),
        (["door_1:axis=0,0,0"], "x, y, z"),
        (["door_1:pivot=1,2"], "three numbers"),
        (["door_1:range=0.1..1.5"], "zero, which is the pose of the input"),
        (["door_1:range=1"], "two numbers"),
        (["door_1:range=-200..200deg"], "spans 400 deg"),
        (["lid=revolute", "lid:range=0..7"], "spans 401 deg"),
        (["lid=fixed", "lid:range=0..1"], "cannot be fixed and have limits"),
        (["door_1"], "PART=TYPE"),
        (["=prismatic"], "PART=TYPE"),
        (["door_1=prismatic", "door_1=revolute"], "contradict"),
        (["lid:axis=x", "lid:axis=z"], "both x and z"),
        (["lid:axis=x", "lid=fixed"], "cannot be fixed and have an axis"),
        (["lid:axis=x", "lid:fixed"], "cannot be fixed and have an axis"),
        (["door_1=prismatic", "door_1:range=0..90deg"], "prismatic and have the range 0..90deg"),
        (["lid:fixed", "lid:pivot=0,0,1"], "be fixed and have a pivot at 0,0,1"),
        (["lid=prismatic", "lid:pivot=0,0,1"], "be prismatic and have a pivot"),
        (["lid=revolute", "lid:range=0..0.3m"], "be revolute and have the range 0..0.3m"),
        (["lid:pivot=0,0,1", "lid:range=0..300mm"], "both a pivot and the range 0..300mm"),
        (["door_1:parent=bdy"], "Did you mean body"),
        (["lid:parent=lid"], "neither its own parent"),
        (["lid:parent=door_1", "door_1:parent=lid"], "hang on each other"),
        (["lid:parent=door_1", "lid:parent=body"], "both door_1 and body"),
        (["door_1:twin=door_2", "door_2:twin=door_1"], "each the model of the other"),
        (["door_1:twin=door_2", "door_1=prismatic"], "takes its joint from door_2"),
    ],
)
def test_what_cannot_be_meant_is_refused_with_the_choices(texts: list[str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        parse_hints(texts, PARTS)


def test_a_hint_on_the_part_that_is_to_be_the_base_is_refused_before_anything_is_computed() -> None:
    with pytest.raises(InputError, match="is the base link"):
        parse_hints(["lid=revolute"], PARTS, base="lid")
    assert parse_hints(["lid=revolute"], PARTS, base="body")


def test_a_type_is_obeyed_and_the_rest_is_found() -> None:
    inference = inferred("drawer")
    name = moving(inference)
    hinted = with_hints(inference, [Hint(part=name, kind=JointType.REVOLUTE)])
    joint = joint_of(hinted, name)
    assert joint.kind is JointType.REVOLUTE
    assert joint.confidence == 1.0
    assert math.isfinite(joint.lower)
    assert joint_of(inference, name).kind is JointType.PRISMATIC  # the inference that was given stays as it is


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_an_axis_is_obeyed_in_every_direction(axis: str) -> None:
    inference = inferred("edge_door")
    name = moving(inference)
    joint = joint_of(with_hints(inference, [Hint(part=name, axis=axis)]), name)
    assert abs(joint.axis["xyz".index(axis)]) > np.cos(np.radians(30.0))


def test_limits_are_along_the_axis_that_was_named_or_had_before() -> None:
    inference = inferred("edge_door")
    name = moving(inference)
    before = joint_of(inference, name)
    joint = joint_of(with_hints(inference, [Hint(part=name, limits="-0.25..1.25")]), name)
    assert (joint.lower, joint.upper) == (-0.25, 1.25)
    assert np.allclose(joint.axis, before.axis)
    against = ",".join(f"{-value:.6g}" for value in before.axis)
    joint = joint_of(with_hints(inference, [Hint(part=name, axis=against, limits="-0.25..1.25")]), name)
    turned = np.sign(joint.axis @ before.axis)
    assert (joint.lower, joint.upper) == ((-1.25, 0.25) if turned > 0.0 else (-0.25, 1.25))


def test_a_range_may_be_given_in_degrees_and_millimetres() -> None:
    inference = inferred("edge_door")
    name = moving(inference)
    joint = joint_of(with_hints(inference, parse_hints([f"{name}:range=-10..90deg"], (name,))), name)
    assert (joint.lower, joint.upper) == pytest.approx((math.radians(-10.0), math.pi / 2.0))
    slide = [f"{name}=prismatic", f"{name}:axis=x", f"{name}:range=-20..300mm"]
    joint = joint_of(with_hints(inference, parse_hints(slide, (name,))), name)
    assert sorted([abs(joint.lower), abs(joint.upper)]) == pytest.approx([0.02, 0.3])


def test_the_unit_of_a_range_and_a_pivot_say_whether_a_part_turns() -> None:
    drawer, door = inferred("drawer"), inferred("edge_door")
    for inference, hint, turns in (
        (drawer, "range=0..90deg", True),
        (drawer, "range=0..0.2m", False),
        (drawer, "pivot=0.1,0,0.2", True),
        (door, "range=0..50mm", False),
        (door, "range=0..1rad", True),
    ):
        name = moving(inference)
        joint = joint_of(with_hints(inference, parse_hints([f"{name}:{hint}"], inference.assembly.names)), name)
        assert joint.kind.turns is turns, hint


def test_a_part_hangs_where_a_hint_says_and_all_else_stays() -> None:
    inference = inferred("toilet")
    names = inference.assembly.names
    bowl, seat, lid = (names.index(name) for name in ("bowl", "seat", "lid"))
    assert inference.trees[0].root == bowl
    hung = with_hints(inference, parse_hints(["lid:parent=seat", "seat:parent=bowl"], names))
    assert hung.trees[0].parents[lid] == seat
    assert hung.trees[0].parents[seat] == bowl
    assert hung.hints == ("lid:parent=seat", "seat:parent=bowl")
    assert [(joint.parent, joint.child) for joint in hung.joints] == list(hung.trees[0].edges())
    turned = with_hints(hung, [Hint(part="seat", parent="lid")])
    assert turned.trees[0].parents[seat] == lid
    assert turned.trees[0].parents[lid] == bowl, "what carried it hangs on what the two hung on"
    with pytest.raises(InputError, match="base link"):
        with_hints(inference, [Hint(part="bowl", parent="lid")])


def test_a_twin_has_the_joint_of_its_model_mirrored() -> None:
    inference = inferred("torso")
    hints = ["left_upper_arm:range=-0.1..1.2", "right_upper_arm:twin=left_upper_arm"]
    hinted = with_hints(inference, parse_hints(hints, inference.assembly.names))
    one, other = joint_of(hinted, "left_upper_arm"), joint_of(hinted, "right_upper_arm")
    assert one.kind is other.kind
    assert (one.lower, one.upper) == (other.lower, other.upper)
    away = inference.assembly.parts[one.child].centroid - inference.assembly.parts[other.child].centroid
    mirror = np.eye(3) - 2.0 * np.outer(away, away) / (away @ away)
    np.testing.assert_allclose(other.axis, -mirror @ one.axis, atol=1e-6)
    assert not any("congruent" in text for text in (*inference.warnings, *hinted.warnings))
    alone = with_hints(inference, parse_hints(hints[:1], inference.assembly.names))
    said = "joints differ in range. If they move alike, give --hint right_upper_arm:twin=left_upper_arm"
    assert any(said in text for text in alone.warnings)
    assert with_hints(alone, parse_hints(hints[1:], inference.assembly.names)).warnings == inference.warnings
    with pytest.raises(InputError, match="cannot be followed"):
        with_hints(inference, [Hint(part="left_forearm", twin="left_upper_arm")])


def test_a_pivot_chooses_the_hinge_that_goes_through_it() -> None:
    inference = inferred("edge_door")
    name = moving(inference)
    joint = joint_of(inference, name)
    bounds = next(part.bounds for part in inference.assembly.parts if part.name == name)
    upright = np.abs(joint.axis) > 0.9
    other_edge = np.where(upright, joint.pivot, bounds.sum(axis=0) - joint.pivot)
    numbers = ",".join(f"{value:.6g}" for value in other_edge)
    axis = ",".join(f"{value:.3g}" for value in joint.axis)
    hints = parse_hints(
        [f"{name}=revolute", f"{name}:axis={axis}", f"{name}:pivot={numbers}"], inference.assembly.names
    )
    hinted = with_hints(inference, hints)
    found = joint_of(hinted, name)
    assert np.linalg.norm(np.cross(found.pivot - other_edge, found.axis)) < 0.02 * inference.assembly.diagonal
    assert hinted.hints == hints[0].texts
    again = with_hints(hinted, parse_hints([f"{name}=fixed"], inference.assembly.names))
    assert again.hints == (f"{name}=fixed",), "the last word counts"


def test_a_hint_against_the_geometry_is_followed_and_said() -> None:
    inference = inferred("drawer")
    name = moving(inference)
    hinted = with_hints(inference, [Hint(part=name, kind=JointType.PRISMATIC, axis="x")])
    assert abs(joint_of(hinted, name).axis[0]) > 0.9
    assert any(name in warning and "slides by" in warning for warning in hinted.warnings)
    with pytest.raises(InputError, match="every pose twice"):
        with_hints(inferred("edge_door"), [Hint(part=moving(inferred("edge_door")), limits="-7..0")])
