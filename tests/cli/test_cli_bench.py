"""`kinematify bench`: what it prints, where it writes, and when it ends with 1."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from benchmarks.regression import find_regressions
from kinematify.cli.app import run
from kinematify.evaluation.benchmark_job import JobResult
from kinematify.evaluation.metrics import JointScore, ObjectScore
from kinematify.evaluation.result_record import Header, Report
from kinematify.evaluation.tree_metrics import TreeDistance

NO_DISTANCE = TreeDistance(value=0, exact=True)
JOINT = JointScore(
    joint="hinge", parent="body", child="door", kind="revolute", predicted_kind="revolute", gripper=False,
    angle_deg=0.2, angle_given_type_deg=0.2, line_m=0.001, pivot_m=0.1, limit_iou=0.8, opens=True,
)  # fmt: skip
SCORE = ObjectScore(
    diagonal=1.0, joints=(JOINT,), ted=NO_DISTANCE, ted_unlabelled=NO_DISTANCE, ted_without_gripper=NO_DISTANCE,
    parent_errors=0, root_right=True,
)  # fmt: skip
RESULT = JobResult(
    object="door", kind="everyday", category="door", condition="rest", variant="default", status="ok",
    message="", seconds=1.0, score=SCORE,
)  # fmt: skip
HEADER = Header(
    study="bench", command="kinematify bench", date="2025-01-01", commit="0a1b2c3", code="0", seeds=(0,),
    configuration={"objects": 1}, machine={"processor": "none", "workers": 1}, versions={"python": "3.11"},
)  # fmt: skip


def report(*results: JobResult) -> Report[JobResult]:
    return Report(header=HEADER, records=results)


def with_joint(**changes: object) -> JobResult:
    joint = replace(JOINT, **changes)  # type: ignore[arg-type]
    return replace(RESULT, score=replace(SCORE, joints=(joint,)))


@pytest.mark.parametrize(
    ("now", "metrics"),
    [
        (RESULT, set()),
        (replace(RESULT, seconds=9.0), set()),
        (with_joint(angle_deg=0.205), set()),
        (with_joint(angle_deg=0.3), {"angle_deg"}),
        (with_joint(angle_deg=0.1), set()),
        (with_joint(predicted_kind="prismatic", limit_iou=0.0), {"types", "limit_iou"}),
        (with_joint(line_m=0.002), {"line_m"}),
        (with_joint(opens=False), {"opens"}),
        (
            replace(RESULT, score=replace(SCORE, root_right=False, ted=TreeDistance(value=2, exact=True))),
            {"root", "ted"},
        ),
        (replace(RESULT, object="another", score=None), set()),
    ],
)
def test_only_what_became_worse_is_a_regression(now: JobResult, metrics: set[str]) -> None:
    assert {found.metric for found in find_regressions(report(now), report(RESULT))} == metrics


@pytest.fixture
def results(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """Let the benchmark answer at once; the list receives what it was asked."""
    asked: list[dict[str, Any]] = []

    def answer(data: object, **options: Any) -> Report[JobResult]:
        asked.append({"data": data, **options})
        return report(RESULT)

    monkeypatch.setattr("kinematify.evaluation.accuracy.run_benchmark", answer)
    return asked


def test_arguments_become_those_of_the_function(results: list[dict[str, Any]], tmp_path: Path) -> None:
    words = ["pip", "--conditions", "rest,yaw37", "--jobs", "3", "--fresh", "--objects", "pan*"]
    assert run(["bench", *words, "--config", "paper", "-o", str(tmp_path)]) == 0
    (request,) = results
    assert (request["data"], request["jobs"], request["fresh"]) == ("pip", 3, True)
    assert request["conditions"] == ("rest", "yaw37")
    assert request["objects"] == ("pan*",)
    assert [variant.label for variant in request["variants"]] == [
        "paper",
        "paper without MCTS",
        "paper without DW-CAVL",
    ]
    assert run(["bench", *words, "--ablation", "-o", str(tmp_path)]) == 0
    assert [variant.label for variant in results[1]["variants"]] == [
        "default", "default without MCTS", "default with DW-CAVL",
    ]  # fmt: skip


def test_report_is_written_and_summed_up(
    results: list[dict[str, Any]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["bench", str(tmp_path), "-o", str(tmp_path / "out"), "--name", "doors"]) == 0
    text = capsys.readouterr().out
    assert "16.06" not in text.splitlines()[2]
    assert "everyday" in text
    assert str(tmp_path / "out" / "doors.md") in text
    assert json.loads((tmp_path / "out" / "doors.json").read_text())["records"][0]["object"] == "door"


def test_json_stands_alone_on_stdout(
    results: list[dict[str, Any]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["bench", str(tmp_path), "-o", str(tmp_path), "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["schema"] == 2


def test_worse_than_the_baseline_ends_with_1(
    results: list[dict[str, Any]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["bench", str(tmp_path), "-o", str(tmp_path)]
    assert run([*words, "--name", "first"]) == 0
    baseline = ["--baseline", str(tmp_path / "first.json")]
    assert run([*words, *baseline]) == 0
    values = json.loads((tmp_path / "first.json").read_text())
    values["records"][0]["score"]["joints"][0]["angle_deg"] = 0.1
    (tmp_path / "first.json").write_text(json.dumps(values))
    capsys.readouterr()
    assert run([*words, *baseline]) == 1
    message = capsys.readouterr().err
    assert "angle_deg went from 0.1 to 0.2 deg (everyday objects, configuration default)" in message


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["bench", "no/such/folder"], "no/such/folder"),
        (["bench", "pip", "--objects", "zebra*"], "No object, category or kind matches --objects zebra*"),
        (["bench", "pip", "--conditions", "upside"], "There is no condition upside"),
        (["bench", "pip", "--config", "no-such"], "There is no configuration no-such"),
        (["bench", "pip", "--baseline", "no.json"], "no.json"),
    ],
)
def test_wrong_words_end_with_2(words: list[str], text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert text in captured.err
    assert "Traceback" not in captured.err
