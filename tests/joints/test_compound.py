"""Crosses, ball joints and fingers are recognised; arms, doors and drawers are not taken for them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from kinematify import infer
from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.joints.candidate import JointEstimate
from kinematify.pipeline.warnings import Compound, CompoundKind, compounds, described
from kinematify.robot.joint_type import JointType

CONFIG = load_config().joints.compound
X, Y, Z = np.eye(3)


def block(name: str, at: tuple[float, float, float], size: tuple[float, float, float]) -> Part:
    mesh = trimesh.creation.box(size).apply_translation(at)
    return Part(name=name, vertices=mesh.vertices, faces=mesh.faces)


def joint(
    parent: int, child: int, axis: np.ndarray, pivot: tuple[float, float, float], kind: JointType = JointType.REVOLUTE
) -> JointEstimate:
    return JointEstimate(
        parent=parent, child=child, kind=kind, axis=axis, pivot=np.array(pivot), lower=0.0, upper=0.05, confidence=1.0
    )


def shaft(cross: float = 0.04) -> Assembly:
    """Two forks and a part between them, along z."""
    return Assembly(
        parts=(
            block("lower fork", (0, 0, -0.1), (0.06, 0.06, 0.2)),
            block("cross", (0, 0, 0), (cross, cross, cross)),
            block("upper fork", (0, 0, 0.1), (0.06, 0.06, 0.2)),
            block("tip", (0, 0, 0.25), (0.05, 0.05, 0.1)),
        ),
        source="code",
    )


def test_square_axes_that_meet_in_a_small_part_are_a_universal_joint() -> None:
    joints = [joint(0, 1, X, (0.3, 0, 0)), joint(1, 2, Y, (0, -0.2, 0))]
    found = compounds(shaft(), joints, (), CONFIG)
    assert found == (Compound(kind=CompoundKind.UNIVERSAL, children=(1, 2)),)
    assert described(found[0], shaft().names).startswith("The joints of cross and upper fork cross at a right angle")


@pytest.mark.parametrize(
    ("axis", "pivot", "cross"),
    [(Y, (0.0, 0.0, 0.02), 0.04), (X, (0.0, 0.0, 0.0), 0.04), (Y, (0.0, 0.0, 0.0), 0.3)],
    ids=["axes pass each other", "one line", "a link, no cross"],
)
def test_other_pairs_of_turns_are_no_universal_joint(
    axis: np.ndarray, pivot: tuple[float, float, float], cross: float
) -> None:
    joints = [joint(0, 1, X, (0, 0, 0)), joint(1, 2, axis, pivot)]
    assert compounds(shaft(cross), joints, (), CONFIG) == ()


def test_three_axes_through_one_point_are_a_ball_joint_and_not_a_universal_one_too() -> None:
    joints = [joint(0, 1, X, (0.3, 0, 0)), joint(1, 2, Y, (0, -0.2, 0)), joint(2, 3, Z, (0, 0, 0.4))]
    found = compounds(shaft(), joints, (), CONFIG)
    assert found == (Compound(kind=CompoundKind.BALL, children=(1, 2, 3)),)
    in_a_plane = [*joints[:2], joint(2, 3, (X + Y) / np.sqrt(2), (0, 0, 0))]
    assert [item.kind for item in compounds(shaft(), in_a_plane, (), CONFIG)] == [CompoundKind.UNIVERSAL]


def hand(offset: float = 0.0) -> Assembly:
    return Assembly(
        parts=(
            block("palm", (0, 0, 0), (0.2, 0.06, 0.05)),
            block("left", (-0.03, 0, 0.06), (0.02, 0.03, 0.07)),
            block("right", (0.03, offset, 0.06), (0.02, 0.03, 0.07)),
        ),
        source="code",
    )


def test_twins_that_slide_towards_each_other_are_fingers() -> None:
    slides = [joint(0, 1, -X, (0, 0, 0), JointType.PRISMATIC), joint(0, 2, X, (0, 0, 0), JointType.PRISMATIC)]
    assert compounds(hand(), slides, ((1, 2),), CONFIG) == (Compound(kind=CompoundKind.FINGERS, children=(1, 2)),)
    assert compounds(hand(), slides, (), CONFIG) == ()  # of different shape
    assert compounds(hand(offset=0.05), slides, ((1, 2),), CONFIG) == ()  # beside each other
    same_way = [slides[0], joint(0, 2, -X, (0, 0, 0), JointType.PRISMATIC)]
    assert compounds(hand(), same_way, ((1, 2),), CONFIG) == ()


@pytest.mark.parametrize(
    ("body", "inner", "expected"),
    [((0.03, 0.0), 0.0, True), ((0.03, 0.0), 0.02, False), ((0.07, 0.0), 0.0, False), ((0.03, 0.1), 0.0, False)],
    ids=["cap", "ring: the neck goes through", "stopper: the neck goes around", "knob: the body lies aside"],
)
def test_a_part_that_closes_a_neck_may_come_off(body: tuple[float, float], inner: float, expected: bool) -> None:
    radius, aside = body
    neck = trimesh.creation.cylinder(radius, 0.2).apply_translation((0, 0, -0.1))
    if aside:
        plate = trimesh.creation.box((1.0, 1.0, 0.05)).apply_translation((aside, 0, -0.3))
        neck = trimesh.util.concatenate([neck, plate])
    shell = trimesh.creation.annulus(0.035, 0.05, 0.08) if radius < 0.05 else trimesh.creation.cylinder(0.05, 0.08)
    lid = trimesh.creation.annulus(inner, 0.05, 0.01) if inner else trimesh.creation.cylinder(0.05, 0.01)
    cap = trimesh.util.concatenate([shell, lid.apply_translation((0, 0, 0.045))])
    parts = tuple(
        Part(name=n, vertices=mesh.vertices, faces=mesh.faces) for n, mesh in (("bottle", neck), ("cap", cap))
    )
    turning = replace(joint(0, 1, Z, (0, 0, 0)), evidence={"bearing_gate": 1.0})
    found = compounds(Assembly(parts=parts, source="code"), [turning], (), CONFIG)
    assert found == ((Compound(kind=CompoundKind.CAP, children=(1,)),) if expected else ())
    if expected:
        assert described(found[0], ("bottle", "cap")).startswith("cap closes the end of what it turns on")


def test_the_inference_tells_of_fingers_of_a_gripper_and_of_nothing_in_a_cabinet() -> None:
    objects = {"gripper": {"fingers": 2}, "cabinet": {}}
    warnings = {name: infer(build(FAMILIES[name], given, seed=1).assembly).warnings for name, given in objects.items()}
    assert any("mirror each other as fingers do" in sentence for sentence in warnings["gripper"])
    assert not any("mirror each other" in s or "together a" in s for s in warnings["cabinet"])
