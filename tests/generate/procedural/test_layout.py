"""Layouts divide a front as they are written."""

from __future__ import annotations

import pytest

from kinematify.errors import InputError
from kinematify.generate.procedural.layout import parse_layout


def test_doors_stand_side_by_side_and_drawers_are_stacked():
    cells = parse_layout("2*door / 3*drawer")
    assert [cell.kind for cell in cells] == ["door"] * 2 + ["drawer"] * 3
    doors, drawers = cells[:2], cells[2:]
    assert doors[0].bottom == doors[1].bottom > drawers[0].top - 1e-12
    assert doors[0].right == doors[1].left == 0.5
    assert [cell.left for cell in drawers] == [0.0] * 3
    assert drawers[0].bottom == pytest.approx(drawers[1].top)


@pytest.mark.parametrize("text", ["door", "2*door | drawer", "(door / drawer) | (2*drawer / shelf)", "3*(2*door)"])
def test_cells_cover_the_front_once(text):
    cells = parse_layout(text)
    assert sum((c.right - c.left) * (c.top - c.bottom) for c in cells) == pytest.approx(1.0)
    for k, one in enumerate(cells):
        for other in cells[k + 1 :]:
            wide = min(one.right, other.right) - max(one.left, other.left)
            high = min(one.top, other.top) - max(one.bottom, other.bottom)
            assert wide < 1e-12 or high < 1e-12


@pytest.mark.parametrize("text", ["", "window", "2*", "(door", "door)", "0*door", "door // door", "500*drawer"])
def test_what_is_no_layout_is_refused(text):
    with pytest.raises(InputError, match="layout"):
        parse_layout(text)
