"""`kinematify explain`, and the page of checks."""

from __future__ import annotations

import json

import pytest

from kinematify.cli.app import run
from kinematify.validation.check import FAMILIES
from kinematify.validation.checks import CHECKS
from tests.places import ROOT
from tests.reports import add_checks
from tools.checks_page import as_markdown

PAGE = ROOT / "docs" / "checks.md"


def said(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert run(["explain", *words]) == 0
    return capsys.readouterr().out


def test_a_check_is_explained_in_any_case(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    add_checks(monkeypatch)
    text = said(capsys, "kv896")
    for part in (
        "KV896  Doors & drawers of KV896",
        FAMILIES["KV8"],
        "error",
        "kinematics",
        "mujoco",
        "It jams.",
        "Move it.",
    ):
        assert part in text


def test_unknown_ids_are_answered_with_the_nearest(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    add_checks(monkeypatch)
    assert run(["explain", "KV397"]) == 2
    assert "KV396" in capsys.readouterr().err


def test_json_has_every_field(capsys: pytest.CaptureFixture[str]) -> None:
    answer = json.loads(said(capsys, "--json", "-"))
    assert [check["id"] for check in answer["checks"]] == list(CHECKS)
    assert all(check["verifies"] and check["matters"] and check["remedy"] for check in answer["checks"])


@pytest.mark.parametrize("words", [[], ["KV150", "--list"]])
def test_words_that_make_no_sense_end_with_2(words: list[str]) -> None:
    assert run(["explain", *words]) == 2


def test_every_check_belongs_to_a_family_and_is_written_out() -> None:
    for check in CHECKS.values():
        assert check.id[:3] in FAMILIES
        assert check.title.strip() == check.title
        assert all(text.endswith((".", "?", ")")) for text in (check.verifies, check.matters, check.remedy)), check.id


def test_the_page_of_checks_is_up_to_date() -> None:
    assert PAGE.read_text(encoding="utf-8") == as_markdown(list(CHECKS.values())), (
        "docs/checks.md is older than the checks: python -m tools.checks_page > docs/checks.md"
    )
