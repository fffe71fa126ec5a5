"""Plain text tables that read the same on a terminal, in a log and in a pipe."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence


def format_table(headings: Sequence[str], rows: Sequence[Sequence[str]], width: int | None = None) -> str:
    """Align the cells of every column under its heading; the last column is not padded.

    Args:
        headings: One per column.
        rows: Cells of every row, as many as there are headings.
        width: Characters of a line at most: the last column is wrapped below itself.
    """
    lines = [tuple(headings), *(tuple(row) for row in rows)]
    if width is not None:
        room = width - sum(2 + max(map(len, column)) for column in list(zip(*lines, strict=True))[:-1])
        lines = [row for line in lines for row in _wrapped(line, room)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    lines.insert(1, tuple("-" * width for width in widths))
    return "\n".join(_format_line(line, widths) for line in lines)


def _wrapped(cells: tuple[str, ...], room: int) -> list[tuple[str, ...]]:
    first, *more = textwrap.wrap(cells[-1], room) or [""]
    return [(*cells[:-1], first), *((*[""] * (len(cells) - 1), rest) for rest in more)]


def _format_line(cells: Sequence[str], widths: Sequence[int]) -> str:
    return "  ".join(cell.ljust(width) for cell, width in zip(cells, widths, strict=True)).rstrip()
