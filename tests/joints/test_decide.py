"""`estimate_joints`: what holds for every answer, and how answers follow the input."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.joints.choice.decide import estimate_joints
from tests.joints.joint_scenes import CONFIG, estimates_of, evidence
from tests.objects import BUILDERS

SOME = ("edge_door", "drawer", "knob", "parallel_gripper", "universal_joint")


@pytest.mark.parametrize("name", ["lever", "universal_joint", "torso"])
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
