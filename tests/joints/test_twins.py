"""Edges that are alike agree on a type."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.joints.candidate import FIXED, SLIDE, TURN
from kinematify.joints.choice.judge import agreed
from tests.joints.joint_scenes import evidence, infer_joints
from tests.objects import BUILDERS

KINDS = np.array([FIXED, TURN, TURN, SLIDE])


def test_what_is_likelier_for_all_together_is_likelier_for_each() -> None:
    """One part is nearly sure, the other hardly leans the other way."""
    sure, leaning = np.array([0.0, 0.05, 0.05, 0.9]), np.array([0.0, 0.4, 0.2, 0.4])
    for found in agreed([KINDS, KINDS], [sure, leaning]):
        assert found.sum() == pytest.approx(1.0)
        assert found[3] > 0.5


def test_fingers_of_one_hand_are_alike_and_get_one_type() -> None:
    known = BUILDERS["parallel_gripper"]()
    tree, graph, _ = evidence(known)
    groups = [group for group in graph.alike.edges(tree) if len(group) > 1]
    assert [sorted(known.parts[child].name for _, child in group) for group in groups] == [
        sorted(joint.child for joint in known.joints if "finger" in joint.child)
    ]
    estimates = infer_joints(known)
    assert len({estimates[known.parts[child].name].kind for _, child in groups[0]}) == 1
