"""Crosses, ball joints and fingers are recognised; arms, doors and drawers are not taken for them."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from kinematify import infer
from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.contact.alike import AlikeParts
from kinematify.contact.build_graph import build_contact_graph
from kinematify.generate.registry import build
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.candidate import JointEstimate
from kinematify.pipeline.warnings import Compound, CompoundKind, compounds, described, missed_linkages
from kinematify.robot.joint_type import JointType

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
    found = compounds(shaft(), joints, AlikeParts(4, ()))
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
    assert compounds(shaft(cross), joints, AlikeParts(4, ())) == ()


def test_three_axes_through_one_point_are_a_ball_joint_and_not_a_universal_one_too() -> None:
    joints = [joint(0, 1, X, (0.3, 0, 0)), joint(1, 2, Y, (0, -0.2, 0)), joint(2, 3, Z, (0, 0, 0.4))]
    found = compounds(shaft(), joints, AlikeParts(4, ()))
    assert found == (Compound(kind=CompoundKind.BALL, children=(1, 2, 3)),)
    in_a_plane = [*joints[:2], joint(2, 3, (X + Y) / np.sqrt(2), (0, 0, 0))]
    assert [item.kind for item in compounds(shaft(), in_a_plane, AlikeParts(4, ()))] == [CompoundKind.UNIVERSAL]


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
    assert compounds(hand(), slides, AlikeParts(3, [(1, 2)])) == (Compound(kind=CompoundKind.FINGERS, children=(1, 2)),)
    assert compounds(hand(), slides, AlikeParts(4, ())) == ()  # of different shape
    assert compounds(hand(offset=0.05), slides, AlikeParts(3, [(1, 2)])) == ()  # beside each other
    same_way = [slides[0], joint(0, 2, -X, (0, 0, 0), JointType.PRISMATIC)]
    assert compounds(hand(), same_way, AlikeParts(3, [(1, 2)])) == ()


def test_a_tray_that_only_turning_arms_carry_is_a_linkage_that_was_not_found() -> None:
    parts = [
        block("base", (0, 0, 0), (0.4, 0.2, 0.1)),
        block("arm_1", (-0.15, 0, 0.15), (0.01, 0.02, 0.2)),
        block("arm_2", (0.15, 0, 0.15), (0.01, 0.02, 0.2)),
        block("tray", (0, 0, 0.27), (0.4, 0.2, 0.04)),
    ]
    assembly = Assembly(parts=tuple(parts), source="code")
    config, tray = load_config(), joint(1, 3, X, (0, 0, 0.25), JointType.PRISMATIC)
    graph = build_contact_graph(assembly, part_surfaces(assembly, config=config.surface), config=config.contact, seed=0)
    arms = [joint(0, k, Y, (0.15 * side, 0, 0.05)) for k, side in ((1, -1.0), (2, 1.0))]
    (said,) = missed_linkages(assembly, graph, {}, [*arms, tray], config)
    assert said.startswith("tray touches arm_1 and arm_2, which turn about parallel axes")
    assert "--hint tray:parent=arm_1 --hint tray=revolute" in said
    crossed = [arms[0], joint(0, 2, X, (0.15, 0, 0.05))]
    assert not missed_linkages(assembly, graph, {}, [*crossed, tray], config)


def test_the_inference_tells_of_fingers_of_a_gripper_and_of_nothing_in_a_cabinet() -> None:
    objects = {"gripper": {"fingers": 2}, "cabinet": {}}
    warnings = {name: infer(build(name, given, seed=1).assembly).warnings for name, given in objects.items()}
    assert any("mirror each other as fingers do" in sentence for sentence in warnings["gripper"])
    assert not any("mirror each other" in s or "together a" in s for s in warnings["cabinet"])
