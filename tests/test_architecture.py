"""The page about the architecture shows what the code imports."""

from __future__ import annotations

import re

import pytest

from tools.count_lines import size
from tools.draw_architecture import PAGE, drawing, rewritten, table
from tools.imports import ROOT


def without_lines(page: str) -> str:
    """Lines of code change with every commit."""
    return re.sub(r"[\d,]+ \|$", "|", page, flags=re.MULTILINE)


def test_the_page_is_up_to_date() -> None:
    page = PAGE.read_text("utf-8")
    assert without_lines(page) == without_lines(rewritten(page)), "python -m tools.draw_architecture makes it again"


def test_the_drawing_has_the_long_way_and_no_short_cut() -> None:
    arrows = drawing()
    assert "assembly --> geometry" in arrows
    assert "assembly --> joints" not in arrows  # contact stands between them
    assert "config -->" not in arrows


def test_every_package_is_described() -> None:
    rows = table().splitlines()[2:]
    assert len(rows) > 20
    assert [row for row in rows if "|  |" in row] == []


def test_a_page_without_a_place_for_the_drawing_is_refused() -> None:
    with pytest.raises(SystemExit, match="drawing:begin"):
        rewritten("# Architecture\n")


def test_lines_functions_and_docstrings_are_counted() -> None:
    counted = size([ROOT / "tools" / "count_lines.py"])
    assert counted.lines == (ROOT / "tools" / "count_lines.py").read_text("utf-8").count("\n")
    assert counted.public == counted.documented
    assert min(counted.lengths) >= 2
