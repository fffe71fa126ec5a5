"""Scores of the paper's method: J is a likelihood."""

from __future__ import annotations

from functools import cache

import pytest

from kinematify.config import Config, load_config
from kinematify.paper.joints import NOISE, noise_of
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.inference import Inference
from tests.objects import BUILDERS


@cache
def paper() -> Config:
    """As printed, but for distances from grids: networks are trained for seconds and say the same here."""
    config = load_config("paper")
    return config.model_copy(update={"sdf": config.sdf.model_copy(update={"kind": "grid"})})


@cache
def drawer() -> Inference:
    return infer(BUILDERS["drawer"]().assembly, config=paper())


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
