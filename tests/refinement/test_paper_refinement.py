"""Refining under the paper's method: J is a likelihood, failures are a penalty, and the optimiser runs again."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from kinematify.config import Config, load_config
from kinematify.paper.cavl import FailedMotions
from kinematify.paper.joints import NOISE, PaperJoints, noise_of
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.inference import Inference
from kinematify.refinement import refine
from tests.objects import BUILDERS


@cache
def paper() -> Config:
    """As printed, but for distances from grids: networks are trained for seconds and say the same here."""
    config = load_config("paper")
    return config.model_copy(update={"sdf": config.sdf.model_copy(update={"kind": "grid"})})


@cache
def drawer() -> Inference:
    """DW-CAVL leaves it tilted by three degrees, so that it gets stuck in its guides."""
    return infer(BUILDERS["drawer"]().assembly, config=paper())


def off_deg(axis: np.ndarray) -> float:
    (true,) = BUILDERS["drawer"]().joints
    return float(np.degrees(np.arccos(min(abs(axis @ true.axis), 1.0))))


def test_scores_are_log_likelihoods_whose_noise_is_what_the_best_joints_cost() -> None:
    (joint,) = drawer().joints
    costs = [item.evidence["cavl_objective"] for item in joint.alternatives]
    assert joint.evidence[NOISE] == pytest.approx(2.0 * costs[0])
    assert [item.score for item in joint.alternatives] == pytest.approx(
        [-cost / joint.evidence[NOISE] for cost in costs]
    )


def test_noise_is_that_of_the_object_and_never_below_the_margin() -> None:
    cavl = paper().cavl
    assert noise_of([1.0e-4, 2.0e-4, 9.0e-4], cavl) == pytest.approx(4.0e-4)
    assert noise_of([0.0, 0.0], cavl) == pytest.approx(cavl.volume_margin**2)


def test_a_candidate_moves_because_of_a_failure() -> None:
    inference = drawer()
    (joint,) = inference.joints
    edges = PaperJoints(inference.assembly, inference.graph, inference.config)
    failed = FailedMotions(travels=(0.4,))
    pushed, left = (edges.optimise_again(joint, failed, against).alternatives for against in (3.0, 0.0))
    assert off_deg(joint.axis) > 2.0
    slides = {
        name: [item for item in found if not item.kind.turns] for name, found in (("pushed", pushed), ("left", left))
    }
    assert min(off_deg(item.axis) for item in slides["pushed"]) < 0.5
    assert min(off_deg(item.axis) for item in slides["left"]) > 2.0, "without the failure none goes there"
    assert any(np.array_equal(item.axis, joint.axis) for item in pushed), "what failed stays, to be compared with"
    assert len(pushed) > len(joint.alternatives), "the next best of the pool are optimised as well"


def test_a_slide_that_gets_stuck_is_straightened() -> None:
    before = drawer()
    refinement = refine(before)
    (joint,) = refinement.inference.joints
    assert refinement.history.rounds[0].errors > 0
    assert refinement.history.rounds[refinement.history.kept].errors == 0
    assert not joint.kind.turns
    assert off_deg(before.joints[0].axis) > 2.0
    assert off_deg(joint.axis) < 0.5
