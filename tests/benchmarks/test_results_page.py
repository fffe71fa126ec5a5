"""Documents link only tables that say when they were made, and none that is older than the code."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from benchmarks.results_page import dated
from kinematify.errors import InputError
from tests.places import ROOT

PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md")] + sorted((ROOT / "docs").glob("*.md"))


def linked(page: Path) -> set[Path]:
    """Tables in `results/` that a page links."""
    found = re.findall(r"\]\(((?:\.\./)?results/[\w/]+\.md)", page.read_text("utf-8"))
    return {(page.parent / path).resolve() for path in found}


def test_no_linked_table_is_older_than_the_code() -> None:
    tables = {table for page in PAGES for table in linked(page)}
    assert len(tables) > 10
    assert [table.name for table in sorted(tables) if "Older than the code" in table.read_text("utf-8")] == []


def test_every_table_is_linked() -> None:
    assert set((ROOT / "results").glob("*.md")) - linked(ROOT / "docs" / "results.md") == set()


def test_dates_and_commits_are_those_of_the_tables() -> None:
    rows = (ROOT / "docs" / "results.md").read_text("utf-8").split("<!-- tables:begin -->\n")[1].split("\n<!--")[0]
    assert rows == dated(rows, ROOT), "kinematify bench --results-page fills them"


def test_a_row_gets_date_and_commit_of_its_table_and_a_table_without_them_is_refused(tmp_path: Path) -> None:
    (tmp_path / "results").mkdir()
    table = tmp_path / "results" / "speed.md"
    table.write_text("# Speed\n\n- date: 2026-01-02, commit abc1234, code 99\n")
    head = "| question | tables | date | commit |\n| --- | --- | --- | --- |\n"
    rows = f"{head}| How fast? | [speed](../results/speed.md) | | |"
    assert dated(rows, tmp_path).endswith("| How fast? | [speed](../results/speed.md) | 2026-01-02 | abc1234 |")
    table.write_text("# Speed\n")
    with pytest.raises(InputError, match="does not say when it was made"):
        dated(rows, tmp_path)
