"""Studies: their commands, their records, and the tables in `results/` that are written from them."""

from __future__ import annotations

import json
from fnmatch import fnmatchcase
from pathlib import Path

import pytest

from benchmarks.studies.published import (
    PACKAGE_OBJECTS,
    ExpertVerdict,
    ExpertVerdicts,
    load_judged,
    package_models,
)
from benchmarks.study import RECORDS, file_stem, load_study, study_names
from kinematify.cli.app import run
from kinematify.errors import EnvironmentFault
from kinematify.evaluation.result_record import document, load_report
from kinematify.validation.checks import CHECKS
from tests.places import ROOT

REPORTS = ROOT / "results"


@pytest.mark.parametrize("name", [name for name in study_names() if (REPORTS / f"{file_stem(name)}.json").is_file()])
def test_tables_say_what_their_records_say(name: str) -> None:
    """Whoever changes a study remakes its tables with --tables."""
    report = load_report(REPORTS / f"{file_stem(name)}.json", RECORDS)
    study = load_study(name)
    picture = [f"![{study.title}]({file_stem(name)}.png)"] if study.plot is not None else []
    text = document(report.header, study.title, [*study.report(report), *picture])
    assert (REPORTS / f"{file_stem(name)}.md").read_text() == text
    assert not picture or (REPORTS / f"{file_stem(name)}.png").is_file()


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


def test_a_study_runs_goes_on_and_ends_with_1_on_faults(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ["bench", "as-loaded", "--data", "", "--families", "laptop", "--engines", "mujoco", "-o", "out"]
    assert run(words) == 0
    found = json.loads((tmp_path / "out" / "as_loaded.json").read_text())
    assert [record["object"] for record in found["records"]] == ["laptop 0"]
    assert found["configuration"]["families"] == ["laptop"]
    capsys.readouterr()
    assert run(words) == 0
    assert "skipped: done earlier" in capsys.readouterr().err
    assert "Nothing." in (tmp_path / "out" / "as_loaded.md").read_text()
    found["records"][0]["worlds"]["mujoco"] |= {"findings": [["KV802", None, "it is stuck"]], "shown": [False]}
    (tmp_path / "out" / "as_loaded.json").write_text(json.dumps(found))
    assert run([*words, "--tables"]) == 1
    assert "laptop 0, mujoco, KV802: its code does not show that it is stuck" in capsys.readouterr().err
    assert "KV802: it is stuck" in (tmp_path / "out" / "as_loaded.md").read_text()


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["refine", "--faults", "rust"], "'rust' is none of axis by 90 deg, pivot"),
        (["detection", "--only", "both"], "--only 'both' does not fit"),
        (["detection", "--count", "0"], "--count '0' does not fit"),
        (["published", "--folder", "no/such/folder"], "no/such/folder"),
        (["refine", "--tables", "-o", "no/such/folder"], "is not a benchmark report"),
    ],
)
def test_wrong_words_end_with_2(
    words: list[str], text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["bench", *words]) == 2
    assert text in capsys.readouterr().err


def test_objects_of_packages_are_read_in_the_version_that_was_judged(tmp_path: Path) -> None:
    def names() -> list[str]:
        return [model.name for model in package_models(tmp_path)]

    for package, version, path in PACKAGE_OBJECTS:
        folder = tmp_path / f"{package.replace('-', '_')}-{version}.dist-info"
        folder.mkdir(exist_ok=True)
        (folder / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: {version}\n")
        assert not path.endswith(".urdf")
    assert "pyflyt/ball_and_string" in names()
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: pyflyt\nVersion: 0.1\n")
    with pytest.raises(EnvironmentFault, match="pip install --no-deps"):
        names()


def test_the_first_judgement_that_fits_a_finding_counts() -> None:
    entries = [
        ExpertVerdict(model="arm", check="KV31*", where="el*", verdict="right", reason="seen"),
        ExpertVerdict(model="*", check="KV312", verdict="wrong", reason="not seen"),
    ]
    judged = ExpertVerdicts(judged=entries, seen={})
    finding = {"check": "KV312", "joint": "elbow", "link": None, "pair": None}
    assert judged.of("arm", finding) is entries[0]
    assert judged.of("arm", {**finding, "joint": None, "pair": ["base", "elbow"]}) is entries[0]
    assert judged.of("arm", {**finding, "joint": "wrist"}) is entries[1]
    assert judged.of("leg", finding) is entries[1]
    assert judged.of("leg", {**finding, "check": "KV311"}) is None


def test_every_shipped_judgement_names_a_check() -> None:
    for entry in load_judged().judged:
        assert any(fnmatchcase(check, entry.check) for check in CHECKS), entry
