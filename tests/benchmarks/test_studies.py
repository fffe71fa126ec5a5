"""Studies: their commands, their records, and the tables in `results/` that are written from them."""

from __future__ import annotations

import json
from fnmatch import fnmatchcase
from pathlib import Path

import pytest
from test_benchmark_run import write_object

from benchmarks.studies.published import Judged, Judgement, load_judged
from benchmarks.studies.same_joints import differences
from benchmarks.study import file_stem, load_study, load_study_report, study_names
from benchmarks.tables import benchmark_blocks
from kinematify.cli.app import run
from kinematify.errors import InputError
from kinematify.evaluation.record import document, load_report, write_report
from kinematify.evaluation.run import RESULTS
from kinematify.validation.checks import CHECKS
from tests.places import ROOT

REPORTS = ROOT / "results"
JOINT = {
    "parent": "body", "child": "door", "kind": "revolute", "axis": [0.0, 0.0, 1.0], "pivot": [0.5, 0.0, 0.0],
    "lower": 0.0, "upper": 1.5, "confidence": 0.9,
}  # fmt: skip


@pytest.mark.parametrize("name", study_names())
def test_tables_say_what_their_records_say(name: str) -> None:
    """Whoever changes a study writes its tables anew with --tables."""
    report = load_study_report(REPORTS, name)
    study = load_study(name)
    picture = [f"![{study.title}]({file_stem(name)}.png)"] if study.plot is not None else []
    text = document(report.header, study.title, [*study.report(report), *picture])
    assert (REPORTS / f"{file_stem(name)}.md").read_text() == text
    assert not picture or (REPORTS / f"{file_stem(name)}.png").is_file()


@pytest.mark.parametrize("name", ["robots", "everyday"])
def test_accuracy_tables_say_what_their_records_say(name: str, tmp_path: Path) -> None:
    report = load_report(REPORTS / f"{name}.json", RESULTS)
    written = write_report(report, RESULTS, benchmark_blocks(report), tmp_path, name=name, title=name)
    assert written[0].read_text() == (REPORTS / f"{name}.md").read_text()
    assert written[1].read_text() == (REPORTS / f"{name}.json").read_text()


def test_every_study_is_listed_with_its_question(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["bench", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()[2:]
    assert [line.split()[0] for line in lines] == list(study_names())
    assert all(len(line.split()) > 5 for line in lines)


@pytest.mark.parametrize("name", study_names())
def test_every_study_has_help(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["bench", name, "--help"]) == 0
    shown = capsys.readouterr().out
    for field, info in load_study(name).options.model_fields.items():
        assert info.description
        assert f"--{field.replace('_', '-')}" in shown


def test_a_joint_that_changed_is_named_with_what_changed() -> None:
    turned = {**JOINT, "axis": [0.0, 1e-3, 1.0], "upper": None}
    assert list(differences([JOINT], [JOINT], 1e-9)) == []
    assert list(differences([JOINT], [turned], 1e-9)) == [
        "door: axis [0.0, 0.0, 1.0] -> [0.0, 0.001, 1.0]; upper 1.5 -> None"
    ]
    assert list(differences([JOINT], [turned], 1e-2)) == ["door: upper 1.5 -> None"]
    assert list(differences([JOINT], [], 1e-9)) == ["door has no joint any more"]
    assert list(differences([], [JOINT], 1e-9)) == ["door has a joint now"]


def test_a_study_runs_goes_on_and_ends_with_1_on_faults(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_object(tmp_path / "data" / "hinged", with_knob=False)
    monkeypatch.chdir(tmp_path)
    words = ["bench", "same-joints", "--data", "data", "-o", "out"]
    assert run([*words, "--name", "before"]) == 0
    before = json.loads((tmp_path / "out" / "before.json").read_text())
    assert [record["object"] for record in before["records"]] == ["hinged"]
    assert before["configuration"]["data"] == ["data"]
    against = [*words, "--against", "out/before.json"]
    capsys.readouterr()
    assert run(against) == 0
    assert "taken up from an earlier run" in capsys.readouterr().err
    assert "No joint differs." in (tmp_path / "out" / "same_joints.md").read_text()
    before["records"][0]["joints"][0]["kind"] = "prismatic"
    (tmp_path / "out" / "before.json").write_text(json.dumps(before))
    assert run(against) == 1
    assert "kind prismatic -> revolute" in capsys.readouterr().err
    (tmp_path / "out" / "same_joints.md").unlink()
    assert run([*words, "--tables"]) == 1
    assert "kind prismatic -> revolute" in (tmp_path / "out" / "same_joints.md").read_text()


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["refinement", "--tiers", "cheap"], "'cheap' is none of geometry, engines, task"),
        (["detection", "--only", "both"], "--only 'both' does not fit"),
        (["detection", "--count", "0"], "--count '0' does not fit"),
        (["published", "--folder", "no/such/folder"], "no/such/folder"),
        (["same-joints", "--against", "no.json"], "no.json"),
        (["voters", "--tables", "-o", "no/such/folder"], "is not a benchmark report"),
    ],
)
def test_wrong_words_end_with_2(
    words: list[str], text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["bench", *words]) == 2
    assert text in capsys.readouterr().err


def test_an_unknown_study_is_refused_with_the_known_ones() -> None:
    with pytest.raises(InputError, match=r"There are .*calibration, colors, criteria"):
        load_study("alchemy")


def test_the_first_judgement_that_fits_a_finding_counts() -> None:
    entries = [
        Judgement(model="arm", check="KV31*", where="el*", verdict="right", reason="seen"),
        Judgement(model="*", check="KV312", verdict="wrong", reason="not seen"),
    ]
    judged = Judged(judged=entries)
    finding = {"check": "KV312", "joint": "elbow", "link": None, "pair": None}
    assert judged.of("arm", finding) is entries[0]
    assert judged.of("arm", {**finding, "joint": None, "pair": ["base", "elbow"]}) is entries[0]
    assert judged.of("arm", {**finding, "joint": "wrist"}) is entries[1]
    assert judged.of("leg", finding) is entries[1]
    assert judged.of("leg", {**finding, "check": "KV311"}) is None


def test_every_shipped_judgement_names_a_check() -> None:
    for entry in load_judged().judged:
        assert any(fnmatchcase(check, entry.check) for check in CHECKS), entry
