"""The page of results has date and commit of every table that it links."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.results_page import dated
from kinematify.errors import InputError
from tests.places import ROOT


def test_dates_and_commits_are_those_of_the_tables() -> None:
    rows = (ROOT / "docs" / "results.md").read_text("utf-8").split("<!-- tables:begin -->\n")[1].split("\n<!--")[0]
    assert rows == dated(rows, ROOT), "python -m benchmarks.results_page fills them"


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
