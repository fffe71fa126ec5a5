"""Real robots and everyday objects: their joints are erased, inferred again and held against the promised bounds.

The models are not ours to ship; they are read from the folder that KINEMATIFY_BENCH names.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.config import load_config
from kinematify.evaluation.benchmark_job import Job, run_job
from kinematify.evaluation.datasets import CONDITIONS, find_objects
from tests.places import BENCH

if TYPE_CHECKING:
    from kinematify.evaluation.benchmark_job import JobResult
    from kinematify.evaluation.metrics import ObjectScore

REST = next(condition for condition in CONDITIONS if condition.name == "rest")
DIAGONAL_SHARE = 0.06
"""A door's axis stands somewhere in the thickness of its edge, which is what the meshes leave open."""


@cache
def inferred_again(name: str) -> JobResult:
    """Erase, infer and score an object at rest, with its parts renamed and shuffled."""
    items = [item for item in find_objects(BENCH) if item.name == name] if BENCH.is_dir() else []
    if not items:
        pytest.skip(f"There is no benchmark model {name} here; set KINEMATIFY_BENCH to the folder of the models.")
    result = run_job(Job(item=items[0], condition=REST, variant="default", config=load_config()))
    assert result.status == "ok", result.message
    return result


def score_of_right_tree(name: str, count: int) -> ObjectScore:
    """Its score, where base link, tree and types are right, as they must be."""
    score = inferred_again(name).score
    assert score is not None
    assert score.root_right
    assert score.ted.value == 0
    assert len(score.joints) == count
    assert all(joint.type_right for joint in score.joints)
    return score


@pytest.mark.parametrize(("name", "count"), [("ur10e", 6)])
def test_arms_come_back_exactly(name: str, count: int) -> None:
    score = score_of_right_tree(name, count)
    assert np.mean([joint.angle_deg for joint in score.joints]) <= 0.5
    assert np.mean([joint.line_m for joint in score.joints if joint.line_m is not None]) <= 0.002


def test_everyday_objects_come_back_with_their_joints() -> None:
    """All trees and types; nine lines of ten: the choice may err where a door has two edges to turn about."""
    right = 0
    for name, count in (("cabinet_41083", 4), ("dishwasher_12428", 5), ("box_100141", 1)):
        score = score_of_right_tree(name, count)
        near = DIAGONAL_SHARE * score.diagonal
        right += sum(
            joint.angle_deg <= 0.5 and (joint.line_m is None or joint.line_m <= near) for joint in score.joints
        )
    assert right >= 9
