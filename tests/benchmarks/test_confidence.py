"""How far confidence is from what is right, by fifths, for each set and for all of them together."""

from __future__ import annotations

from benchmarks.confidence import confidence_table
from kinematify.evaluation.metrics import JointScore


def joint(confidence: float | None, *, right: bool) -> JointScore:
    return JointScore(
        joint="j", parent="a", child="b", kind="revolute", predicted_kind="revolute", gripper=False,
        angle_deg=0.0 if right else 90.0, angle_given_type_deg=0.0, line_m=0.0, pivot_m=0.0, limit_iou=1.0, opens=None,
        confidence=confidence,
    )  # fmt: skip


def test_the_error_is_the_mean_distance_of_the_fifths_whatever_the_order() -> None:
    sure = [joint(0.9, right=True) for _ in range(9)] + [joint(0.4, right=False)]
    unsure = [joint(0.5, right=k % 2 == 0) for k in range(10)]
    rows = [line.split(" | ") for line in confidence_table({"one": reversed(sure), "other": unsure}).splitlines()[2:]]
    assert [row[0].strip("| ") for row in rows] == ["one", "other", "together"]
    assert [row[1] for row in rows] == ["10", "10", "20"]
    # (.65 for .5, then .9 for 1 four times); (.5 for .5 in each fifth, but for the pairs of one kind).
    assert rows[0][2:4] == ["0.65 (0.50)", "0.90 (1.00)"]
    assert rows[0][-1].strip("| ") == "0.110"
    assert rows[1][-1].strip("| ") == "0.000"


def test_a_joint_without_confidence_does_not_count() -> None:
    joints = [joint(0.8, right=True) for _ in range(5)]
    assert confidence_table({"one": joints}) == confidence_table({"one": [*joints, joint(None, right=False)]})
