"""Reliability of confidences: what is counted as right, the error of calibration and the order."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from objects import BUILDERS

from benchmarks.studies.calibration import ScoredJoint, reliability
from benchmarks.study import write_study
from benchmarks.tables import is_right
from kinematify.config import Config, load_config
from kinematify.evaluation.metrics import JointScore
from kinematify.evaluation.record import Report, new_header
from kinematify.pipeline.infer import infer


def judged(confidences: list[float], right: list[bool]) -> list[ScoredJoint]:
    return [
        ScoredJoint(object="o", category="c", joint=f"j{k}", confidence=said, right=good)
        for k, (said, good) in enumerate(zip(confidences, right, strict=True))
    ]


def test_confidences_that_are_kept_have_no_error() -> None:
    """Of a hundred joints of 30 %, thirty are right, and so on."""
    said = np.repeat([0.1, 0.3, 0.5, 0.7, 0.9], 100)
    right = np.concatenate([np.arange(100) < 100 * share for share in (0.1, 0.3, 0.5, 0.7, 0.9)])
    found = reliability(judged(said.tolist(), right.tolist()))
    assert found.ece_width == pytest.approx(0.0, abs=1e-9)
    assert [item.joints for item in found.bins] == [100] * 5


def test_certainty_that_is_wrong_is_all_error_and_order_is_judged_by_itself() -> None:
    found = reliability(judged([1.0] * 8, [False] * 4 + [True] * 4))
    assert found.ece == pytest.approx(0.5)
    ordered = reliability(judged([0.1, 0.2, *[0.9] * 8], [False, False, *[True] * 8]))
    assert (ordered.errors_in_least, ordered.auc) == (1.0, 1.0)
    turned = reliability(judged([0.9, 0.8, *[0.1] * 8], [False, False, *[True] * 8]))
    assert (turned.errors_in_least, turned.auc) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("predicted", "angle", "line", "right"),
    [
        ("revolute", 1.0, 0.0, True),
        ("continuous", 1.0, None, True),
        ("prismatic", 1.0, None, False),
        ("revolute", 6.0, 0.0, False),
        ("revolute", 1.0, 0.06, False),
        (None, 90.0, None, False),
    ],
)
def test_right_means_parent_type_and_axis(predicted: str | None, angle: float, line: float | None, right: bool) -> None:
    score = JointScore(
        joint="j", parent="p", child="c", kind="revolute", predicted_kind=predicted, gripper=False, angle_deg=angle,
        angle_given_type_deg=angle, line_m=line, pivot_m=None, limit_iou=0.0, opens=None,
    )  # fmt: skip
    assert is_right(score, 1.0) is right


def test_the_page_shows_the_curve_and_names_the_confident_errors(tmp_path: Path) -> None:
    joints = judged([0.2, 0.95, 0.9, 0.8], [False, False, True, True])
    header = new_header("calibration", workers=1, seeds=[2], configuration={"count": 1})
    records = tuple(asdict(joint) for joint in joints)
    page, data, picture = write_study(
        Report(header=header, records=records, summary=asdict(reliability(joints))), tmp_path
    )
    text = page.read_text()
    assert "| joints right | 50.0% |" in text
    assert text.index("| o | j1 | 0.95 |") < text.index("| o | j0 | 0.20 |")
    assert json.loads(data.read_text())["summary"]["joints"] == 4
    assert picture.stat().st_size > 1000


def test_close_types_cost_confidence() -> None:
    assembly = BUILDERS["hinge_pin"]().assembly
    config = load_config()

    def said(**changes: float) -> float:
        doubt = config.joints.confidence.model_copy(update=changes)
        joints = config.joints.model_copy(update={"confidence": doubt})
        changed: Config = config.model_copy(update={"joints": joints})
        return infer(assembly, config=changed).joints[0].confidence

    usual = said()
    assert 0.6 < usual < 1.0
    assert said(cues_lead=0.0) < usual < said(cues_lead=100.0)
