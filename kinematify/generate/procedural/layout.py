"""Layout of the front of a piece of furniture: rows and columns of doors, drawers and shelves.

Written ``2*door / 3*drawer``: a slash stacks, a bar sets side by side, brackets group, and a count repeats (doors
side by side, all else stacked). Rows count from the top, columns from the left, as one reads.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from kinematify.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

CELLS = {"door": 3.0, "drawer": 1.0, "shelf": 1.5, "panel": 1.0}
"""What a cell may be, and its share of a stack's height beside the others."""
MAX_CELLS = 60


@dataclass(frozen=True, kw_only=True)
class Cell:
    """One field of the front."""

    kind: str
    """Of `CELLS`."""
    left: float
    """In shares of the front's width, from the left, in [0, 1]."""
    right: float
    bottom: float
    """In shares of the front's height, from the bottom, in [0, 1]."""
    top: float


_Item: TypeAlias = "str | tuple[bool, list[_Item]]"
"""A cell, or items one below the other (True), or side by side."""


def parse_layout(text: str) -> tuple[Cell, ...]:
    """Divide the unit square as a layout says; cells from the top left, row by row.

    Raises:
        InputError: The text is no layout, or has too many cells.
    """
    words = ["", *re.findall(r"\d+\s*\*|[a-z]+|\S", text.lower())[::-1]]  # the next one last
    try:
        item = _group(words)
        if words[-1]:
            raise ValueError(words[-1])
    except ValueError as error:
        raise InputError(
            f"The layout {text!r} cannot be read at {str(error) or 'its end'!r}. Write for example '2*door / 3*drawer':"
            f" / stacks, | sets side by side, brackets group; the fields are {', '.join(CELLS)}."
        ) from error
    cells = tuple(_placed(item, (0.0, 1.0), (0.0, 1.0)))
    if len(cells) > MAX_CELLS:
        raise InputError(f"The layout {text!r} has {len(cells)} fields; at most {MAX_CELLS} can be built.")
    return cells


def stacked(counts: Sequence[tuple[int, str]]) -> str:
    """Return the layout of so many fields of each kind, one kind below the other."""
    return " / ".join(f"{count}*{kind}" for count, kind in counts if count) or "shelf"


def _group(words: list[str], sign: str = "/") -> _Item:
    """Take items with a sign between them from the end of the words."""
    members: list[_Item] = []
    while not members or words[-1] == sign:
        if members:
            words.pop()
        members.append(_group(words, "|") if sign == "/" else _item(words))
    return sign == "/", members


def _item(words: list[str]) -> _Item:
    word = words.pop()
    if word == "(":
        inside = _group(words)
        if words.pop() != ")":
            raise ValueError("a bracket that is not closed")
        return inside
    if word.endswith("*") and (count := int(word[:-1])):
        item = _item(words)
        return item != "door", [item] * min(count, MAX_CELLS + 1)
    if word not in CELLS:
        raise ValueError(word)
    return word


def _weight(item: _Item) -> float:
    """Share of a stack's height that an item asks for."""
    if isinstance(item, str):
        return CELLS[item]
    weights = map(_weight, item[1])
    return sum(weights) if item[0] else max(weights)


def _placed(item: _Item, across: tuple[float, float], up: tuple[float, float]) -> Iterator[Cell]:
    if isinstance(item, str):
        yield Cell(kind=item, left=across[0], right=across[1], bottom=up[0], top=up[1])
        return
    is_stacked, members = item
    weights, done = [_weight(member) if is_stacked else 1.0 for member in members], 0.0
    for member, weight in zip(members, weights, strict=True):
        share = weight / sum(weights)
        if is_stacked:
            height = up[1] - up[0]
            yield from _placed(member, across, (up[1] - (done + share) * height, up[1] - done * height))
        else:
            width = across[1] - across[0]
            yield from _placed(member, (across[0] + done * width, across[0] + (done + share) * width), up)
        done += share


def grid(count: int, columns: int, size: tuple[float, float]) -> list[tuple[float, float]]:
    """Return the middles of `count` fields in rows of `columns`, first row on top, on an area around the origin."""
    columns = max(1, min(columns, count))
    rows = max(1, -(-count // columns))
    pitch = size[0] / columns, size[1] / rows
    return [
        ((k % columns + 0.5) * pitch[0] - 0.5 * size[0], 0.5 * size[1] - (k // columns + 0.5) * pitch[1])
        for k in range(count)
    ]
