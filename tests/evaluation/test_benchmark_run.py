"""The benchmark runner: isolation, resumption, honest counting, and reports."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest

from benchmarks.paper import ABLATION, DEFAULT_ABLATION, PAPER_VARIANTS
from benchmarks.tables import benchmark_blocks
from kinematify.config import load_config
from kinematify.errors import ConfigError, EnvironmentFault, InputError, OutputError
from kinematify.evaluation.benchmark_job import JobResult
from kinematify.evaluation.benchmark_summary import summarise
from kinematify.evaluation.datasets import find_objects
from kinematify.evaluation.result_record import Report, load_report, write_report
from kinematify.evaluation.run_benchmark import (
    RESULTS,
    Variant,
    changed,
)
from tests.places import ROOT
from tests.secret_cabinets import request, write_object


@pytest.fixture
def data(tmp_path: Path) -> Path:
    write_object(tmp_path / "data" / "two_parts", with_knob=False)
    write_object(tmp_path / "data" / "three_parts", with_knob=True)
    return tmp_path / "data"


def without_costs(report: Report[JobResult]) -> list[object]:
    return [replace(result, seconds=0.0, peak_mb=None) for result in report.records]


def written(report: Report[JobResult], folder: Path, name: str, baseline: Report[JobResult] | None = None) -> str:
    """Text of the Markdown."""
    blocks = benchmark_blocks(report, baseline)
    return write_report(report, RESULTS, blocks, folder, name=name, title=name)[0].read_text()


def test_runs_every_object_under_every_condition_and_scores_it(data: Path, tmp_path: Path) -> None:
    reported: list[float] = []
    report = request(data, tmp_path / "work", "star")(progress=lambda _, fraction: reported.append(fraction))
    assert [(result.object, result.condition) for result in report.records[:6]] == [
        ("three_parts", "rest"),
        ("three_parts", "random-0"),
        ("three_parts", "random-1"),
        ("three_parts", "random-2"),
        ("three_parts", "yaw37"),
        ("two_parts", "rest"),
    ]
    assert all(result.status == "ok" for result in report.records)
    assert all(result.peak_mb is not None and result.peak_mb > 1.0 for result in report.records)
    assert reported == sorted(reported)
    assert reported[-1] == 1.0
    for result in report.records:
        assert result.score is not None
        assert result.score.ted.value == 0
        assert result.score.root_right
        scores = {joint.joint: joint for joint in result.score.joints}
        assert scores["secret_hinge"].type_right
        assert scores["secret_hinge"].angle_deg == pytest.approx(0.0, abs=1e-6)
        if result.object == "three_parts":
            assert not scores["secret_slide"].type_right
            assert scores["secret_slide"].angle_deg == pytest.approx(90.0, abs=1e-6)


def test_truth_never_reaches_the_inference(data: Path, tmp_path: Path) -> None:
    report = request(data, tmp_path / "work", "telling_what_it_sees", conditions=("rest", "random-1"))()
    for result in report.records:
        assert result.status == "error"
        assert "SEEN" in result.message
        assert "given=['config']" in result.message
        for word in ("secret", "cabinet", "parts/", "urdf", str(tmp_path)):
            assert word not in result.message, word


def test_failed_inference_counts_as_if_nothing_was_predicted(data: Path, tmp_path: Path) -> None:
    report = request(data, tmp_path / "work", "telling_what_it_sees", conditions=("rest",))()
    values = summarise(report.records).values
    assert values["angle_deg"] == 90.0
    assert values["types"] == 0.0
    assert values["ted"] == pytest.approx(2.5)
    assert values["root"] == 0.0


def test_crashing_worker_ends_its_own_job_only(data: Path, tmp_path: Path) -> None:
    report = request(data, tmp_path / "work", "crashing_on_three_parts", conditions=("rest",))()
    crashed, fine = report.records
    assert (crashed.status, crashed.peak_mb) == ("crash", None)
    assert "SIGSEGV" in crashed.message
    assert crashed.score is not None
    assert [joint.angle_deg for joint in crashed.score.joints] == [90.0, 90.0]
    assert fine.status == "ok"


def test_hanging_worker_is_stopped_and_its_answer_counts_as_missing(data: Path, tmp_path: Path) -> None:
    quick = request(data, tmp_path / "work", "endless", conditions=("rest",), objects=("two_parts",), timeout=4.0)
    (result,) = quick().records
    assert result.status == "timeout"
    assert result.seconds >= 4.0
    assert result.score is not None
    assert result.score.joints[0].predicted_kind is None


def test_unreadable_description_is_reported_and_in_no_mean(data: Path, tmp_path: Path) -> None:
    (data / "broken").mkdir()
    (data / "broken" / "model.urdf").write_text("<robot")
    report = request(data, tmp_path / "work", "star", conditions=("rest",))()
    (broken,) = [result for result in report.records if result.object == "broken"]
    assert broken.status == "unreadable"
    assert broken.score is None
    summary = summarise(report.records)
    assert (summary.objects, summary.unscored_runs) == (2, 1)
    assert "| broken | rest | default | unreadable |" in written(report, tmp_path / "out", "bench")


@pytest.mark.parametrize("end", [signal.SIGKILL])
def test_killed_run_resumes_to_the_same_report(data: Path, tmp_path: Path, end: signal.Signals) -> None:
    work = tmp_path / "work"
    ledger = work / "jobs.jsonl"
    program = (
        "from pathlib import Path\n"
        "from kinematify.evaluation.run_benchmark import run_benchmark\n"
        "if __name__ == '__main__':\n"
        f"    run_benchmark({str(data)!r}, work=Path({str(work)!r}), jobs=2,\n"
        "        infer='quick_inference:slow_star')\n"
    )
    script = tmp_path / "program.py"
    script.write_text(program)
    places = os.pathsep.join([str(ROOT / "tests"), *sys.path])
    child = subprocess.Popen(
        [sys.executable, str(script)], env={**os.environ, "PYTHONPATH": places}, stderr=subprocess.DEVNULL
    )
    deadline = time.monotonic() + 300.0
    while time.monotonic() < deadline and (not ledger.exists() or ledger.read_bytes().count(b"\n") < 3):
        time.sleep(0.02)
    child.send_signal(end)
    assert child.wait(timeout=20.0) == -end
    finished = ledger.read_bytes().splitlines()
    assert 3 <= len(finished) < 10
    # What a kill in the middle of a write leaves behind.
    with ledger.open("ab") as file:
        file.write(b'{"key": "half a li')

    resumed = request(data, work, "slow_star")()
    lines = ledger.read_bytes().splitlines()
    assert lines[: len(finished)] == finished
    assert len(lines) == len(resumed.records) == 10
    uninterrupted = request(data, tmp_path / "other", "slow_star")()
    assert without_costs(resumed) == without_costs(uninterrupted)


def test_finished_jobs_are_taken_up_unless_something_changed_or_fresh(data: Path, tmp_path: Path) -> None:
    base = request(data, tmp_path / "work", "star", conditions=("rest",))
    first = base()
    ledger = tmp_path / "work" / "jobs.jsonl"
    before = ledger.read_bytes()
    assert base().records == first.records
    assert ledger.read_bytes() == before
    base(variants=(Variant(label="seeded", config="default", changes={"seed": 7}),))
    assert ledger.read_bytes().count(b"\n") == 4
    base(fresh=True)
    assert ledger.read_bytes().count(b"\n") == 2


def test_report_survives_the_disk_and_compares_with_a_baseline(data: Path, tmp_path: Path) -> None:
    both = (Variant(label="default", config="default"), Variant(label="other", config="default", changes={"seed": 1}))
    report = request(data, tmp_path / "work", "star", conditions=("rest",), variants=both)()
    text = written(report, tmp_path / "out", "first")
    values = tmp_path / "out" / "first.json"
    assert "2.92 / 22.50" in text
    assert "secret_slide" in text
    assert "Configurations beside the paper's ablation" in text
    read = load_report(values, RESULTS)
    assert read.records == report.records
    assert json.loads(values.read_text())["summary"]["groups"][0]["with_gripper"]["values"]["ted"] == 0.0

    worse = request(data, tmp_path / "work", "telling_what_it_sees", conditions=("rest",))()
    compared = written(worse, tmp_path / "out", "second", read)
    assert "22.50 -> 90.00" in compared
    assert "2 runs in both" in compared


def test_ablations_differ_from_the_paper_in_one_thing() -> None:
    full, without_search, without_anchor = (variant.load() for variant in PAPER_VARIANTS)
    assert without_search.topology.mode == "bfs" != full.topology.mode
    assert without_search.cavl == full.cavl
    assert without_anchor.cavl == full.cavl.model_copy(update={"consistency_weight": 0.0, "pivot_weight": 0.0})
    assert without_anchor.cavl != full.cavl
    assert without_anchor.topology == full.topology
    assert set(ABLATION) == {variant.label for variant in PAPER_VARIANTS}
    plain, unsearched, with_cavl = (variant.load() for variant in DEFAULT_ABLATION)
    assert unsearched.topology.mode == "bfs" != plain.topology.mode
    assert (unsearched.joints, with_cavl.topology) == (plain.joints, plain.topology)
    assert with_cavl.joints.method == "cavl" != plain.joints.method


def test_unknown_words_are_named(data: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No object, category or kind matches --objects piano"):
        request(data, tmp_path, "star", objects=("piano",))()
    with pytest.raises(InputError, match="no condition upside-down"):
        request(data, tmp_path, "star", conditions=("upside-down",))()
    with pytest.raises(ConfigError, match=r"no field topology\.colour"):
        changed(load_config("default"), {"topology.colour": "red"})
    with pytest.raises(InputError, match="is not a benchmark report"):
        load_report(data / "two_parts" / "model.urdf", RESULTS)
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(OutputError, match="Results cannot be kept in"):
        request(data, blocked / "work", "star")()


def test_objects_are_found_in_folders_files_and_the_environment(
    data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (data / "loose.urdf").write_text("<robot/>")
    (data / "two_parts" / "variant.urdf").write_text("<robot/>")
    write_object(tmp_path / "data" / "more" / "two_parts", with_knob=False)
    names = [item.name for item in find_objects(data)]
    assert names == ["loose", "more/two_parts", "three_parts", "two_parts"]
    (single,) = find_objects(data / "three_parts" / "model.urdf")
    assert (single.name, single.kind, single.category) == ("three_parts", "everyday", "cabinet")
    monkeypatch.setenv("KINEMATIFY_BENCH", str(data))
    assert find_objects() == find_objects(data)
    with pytest.raises(InputError, match="no benchmark data"):
        find_objects(tmp_path / "nowhere")
    with pytest.raises(InputError, match="holds no URDF"):
        find_objects(_empty(tmp_path))


def _empty(folder: Path) -> Path:
    empty = folder / "empty"
    empty.mkdir()
    return empty


def test_pip_data_is_found_or_its_installation_named() -> None:
    try:
        distribution("example-robot-data")
    except PackageNotFoundError:
        with pytest.raises(EnvironmentFault, match=r" install .?example-robot-data"):
            find_objects("pip")
    else:
        robots = find_objects("pip")
        assert [robot.name for robot in robots] == ["panda", "go2", "allegro", "ur10"]
        assert all(robot.urdf.is_file() for robot in robots)
