"""The registry of checks: one function each, documented in three parts, and readable without an engine."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

from kinematify.config.validation import load_settings
from kinematify.simulation.engines import ENGINES
from kinematify.validation.check import REGISTRY, OpenCheck, check
from kinematify.validation.checks import CHECKS, checks_of
from kinematify.validation.finding import Cause, Severity, Status
from kinematify.validation.isolation import _EVERY_STAGE
from kinematify.validation.run.needs import (
    Recorder,
    Subjects,
    keys,
    stages_of,
    task_stage,
)
from kinematify.validation.stage import StageRequest
from tests.places import ROOT

HEAVY = {"torch", "mujoco", "pybullet", "pinocchio", "coal", "fcl", "igl", "ompl", "trimesh", "scipy", "pydantic"}


@pytest.fixture
def registry(monkeypatch: pytest.MonkeyPatch) -> None:
    """A registry to which a test may add."""
    monkeypatch.setitem(REGISTRY, "KV398", CHECKS["KV301"])
    monkeypatch.delitem(REGISTRY, "KV398")


def documented(result: OpenCheck, context: float) -> None:
    """Nothing is above `most`.

    It is about a limit.

    Engines: All.

    Why it matters: It jams.

    Remedy: Move it.
    """
    result.find(f"It is {context}.", "Move it.")


def test_reading_the_checks_loads_no_engine() -> None:
    code = "import sys, kinematify.validation.checks; print(*{name.partition('.')[0] for name in sys.modules})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "kinematify" in done.stdout.split()
    assert set(done.stdout.split()) & HEAVY == set()


def test_every_check_has_all_its_texts() -> None:
    for name, entry in CHECKS.items():
        assert entry.id == name
        assert entry.title != entry.fails, name
        assert all((entry.title, entry.fails, entry.verifies, entry.matters, entry.remedy)), name


def test_every_check_but_those_of_the_text_is_reported_by_one_stage() -> None:
    stages = [*stages_of(tuple(ENGINES)), task_stage()]
    reported = [key for stage in stages for key in stage.checks]
    text = keys(checks_of("KV10", "KV11", "KV12", "KV13", "KV14"))
    assert sorted(map(str, (*reported, *text))) == sorted(map(str, keys(CHECKS.values())))


@pytest.mark.usefixtures("registry")
def test_a_check_needs_its_three_paragraphs() -> None:
    decorate = check("KV398", title="t", fails="f", severity=Severity.NOTE, cause=Cause.ASSET)
    with pytest.raises(AssertionError, match="Why it matters"):
        decorate(documented)
    documented.__doc__ = (documented.__doc__ or "").replace("    It is about a limit.\n\n    Engines: All.\n\n", "")
    decorate(documented)
    assert (REGISTRY["KV398"].verifies, REGISTRY["KV398"].remedy) == ("Nothing is above `most`.", "Move it.")
    with pytest.raises(AssertionError, match="two functions"):
        decorate(documented)


def test_what_a_check_needs_is_the_reason_why_it_is_skipped(tmp_path: Path) -> None:
    reported = []  # type: ignore[var-annotated]
    request = StageRequest(
        urdf=tmp_path, package_dirs=(), work=tmp_path, settings=load_settings(), selected={"KV305"}, deadline=1.0
    )

    class Late:
        disabled, random = ("a", "b"), None
        scene = type("Scene", (), {"travels": (1,)})

    # KV333 was not asked for, and would fail
    Recorder(reported.append, request).run({"GeometryContext": Subjects(items=lambda: [Late()])})
    (result,) = reported
    assert (result.status, result.reason) == (Status.SKIPPED, "not finished: time ran out before it")


def test_the_example_of_the_page_is_the_code() -> None:
    section = (ROOT / "docs/write_checks.md").read_text("utf-8").split("## Add a check")[1].split("\n## ")[0]
    function, test = (part.split("```")[0].strip() for part in section.split("```python")[1:])
    assert function in (ROOT / "validation/checks/declared_limits.py").read_text("utf-8")
    assert test in (ROOT / "tests/validation/test_physics.py").read_text("utf-8")


def test_what_workers_have_imported_beforehand_is_there() -> None:
    stages = stages_of(list(ENGINES))
    names = {*_EVERY_STAGE, *(name for stage in stages for name in stage.imports)}
    assert [name for name in names if importlib.util.find_spec(name) is None] == []  # the server would not say so


@pytest.mark.parametrize(
    ("message", "reported"),
    [
        ("Driven from 0 to 12 rad, joint 12 stops at 12 mm.", "Driven from 0 to 12 rad, joint '12' stops at 12 mm."),
        ("12 is declared to go to 12.5 rad.", "'12' is declared to go to 12.5 rad."),
        ("Moving 12 alone, base and 3 meet in 12 of 120.", "Moving '12' alone, base and '3' meet in 12 of 120."),
    ],
)
def test_names_that_are_numbers_stand_in_quotes(message: str, reported: str) -> None:
    result = OpenCheck(id="KV312", engine=None)
    result.find(message, "Mend it.", joint="12", pair=("base", "3"))
    assert result.findings[0].message == reported
    assert result.findings[0].joint == "12"
