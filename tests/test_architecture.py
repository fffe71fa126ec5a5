"""The page about the architecture shows what the code imports."""

from __future__ import annotations

import re

import pytest

from tools.draw_architecture import PAGE, drawing, rewritten, table


def without_sizes(page: str) -> str:
    """The size of the code changes with every commit."""
    return re.sub(r"[\d,]+ \|$", "|", page, flags=re.MULTILINE)


def test_the_page_is_up_to_date() -> None:
    page = PAGE.read_text("utf-8")
    assert without_sizes(page) == without_sizes(rewritten(page)), "python -m tools.draw_architecture makes it again"


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
