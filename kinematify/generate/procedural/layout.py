"""Layout of the front of a piece of furniture: rows and columns of doors, drawers and shelves.

Written ``2*door / 3*drawer``: a slash stacks, a bar sets side by side, brackets group, and a count repeats (doors
side by side, all else stacked). Rows count from the top, columns from the left, as one reads.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

CELLS = {"door": 3.0, "drawer": 1.0, "shelf": 1.5, "panel": 1.0}
"""What a cell may be, and its share of a stack's height beside the others."""
MAX_CELLS = 60
_TOKEN = re.compile(r"\s*(\d+\s*\*|[a-z]+|[/|()])")


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


@dataclass(frozen=True, kw_only=True)
class _Group:
    """Fields one below the other, or side by side."""

    stacked: bool
    members: tuple[_Group | str, ...]

    @property
    def weight(self) -> float:
        """Share of a stack's height that it asks for."""
        weights = [CELLS[member] if isinstance(member, str) else member.weight for member in self.members]
        return sum(weights) if self.stacked else max(weights)


def parse_layout(text: str) -> tuple[Cell, ...]:
    """Divide the unit square as a layout says; cells from the top left, row by row.

    Raises:
        InputError: The text is no layout, or has too many cells.
    """
    tokens = _tokens(text)
    group, rest = _group(text, tokens)
    if rest:
        raise _malformed(text, rest[0])
    cells = _placed(group, (0.0, 1.0), (0.0, 1.0))
    if len(cells) > MAX_CELLS:
        raise InputError(f"The layout {text!r} has {len(cells)} fields; at most {MAX_CELLS} can be built.")
    return tuple(cells)


def stacked(counts: Sequence[tuple[int, str]]) -> str:
    """Return the layout of so many fields of each kind, one kind below the other."""
    return " / ".join(f"{count}*{kind}" for count, kind in counts if count) or "shelf"


def _tokens(text: str) -> list[str]:
    found, position = [], 0
    text = text.strip().lower()
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise _malformed(text, text[position:][:10])
        found.append(match[1].replace(" ", ""))
        position = match.end()
    return found


def _group(text: str, tokens: list[str], sign: str = "/") -> tuple[_Group, list[str]]:
    members: list[_Group | str] = []
    while not members or (tokens and tokens[0] == sign):
        rest = tokens[1:] if members else tokens
        member, tokens = _group(text, rest, "|") if sign == "/" else _item(text, rest)
        members.append(member)
    return _Group(stacked=sign == "/", members=tuple(members)), tokens


def _item(text: str, tokens: list[str]) -> tuple[_Group | str, list[str]]:
    if not tokens:
        raise _malformed(text, "its end")
    first, *rest = tokens
    if first == "(":
        group, rest = _group(text, rest)
        if not rest or rest[0] != ")":
            raise _malformed(text, "a bracket that is not closed")
        return group, rest[1:]
    if first.endswith("*"):
        count = min(int(first[:-1]), MAX_CELLS + 1)
        item, rest = _item(text, rest)
        if count < 1:
            raise _malformed(text, first)
        return _Group(stacked=item != "door", members=(item,) * count), rest
    if first not in CELLS:
        raise _malformed(text, first)
    return first, rest


def _placed(item: _Group | str, across: tuple[float, float], up: tuple[float, float]) -> list[Cell]:
    if isinstance(item, str):
        return [Cell(kind=item, left=across[0], right=across[1], bottom=up[0], top=up[1])]
    weights = [CELLS[m] if isinstance(m, str) else m.weight for m in item.members]
    shares = [weight / sum(weights) for weight in weights] if item.stacked else [1.0 / len(weights)] * len(weights)
    cells, done = [], 0.0
    for member, share in zip(item.members, shares, strict=True):
        if item.stacked:
            height = up[1] - up[0]
            cells += _placed(member, across, (up[1] - (done + share) * height, up[1] - done * height))
        else:
            width = across[1] - across[0]
            cells += _placed(member, (across[0] + done * width, across[0] + (done + share) * width), up)
        done += share
    return cells


def grid(count: int, columns: int, size: tuple[float, float]) -> list[tuple[float, float]]:
    """Return the middles of `count` fields in rows of `columns`, first row on top, on an area around the origin."""
    columns = max(1, min(columns, count))
    rows = max(1, -(-count // columns))
    pitch = size[0] / columns, size[1] / rows
    return [
        ((k % columns + 0.5) * pitch[0] - 0.5 * size[0], 0.5 * size[1] - (k // columns + 0.5) * pitch[1])
        for k in range(count)
    ]


def _malformed(text: str, at: str) -> InputError:
    return InputError(
        f"The layout {text!r} cannot be read at {at!r}. Write for example '2*door / 3*drawer': / stacks, | sets "
        f"side by side, brackets group; the fields are {', '.join(CELLS)}."
    )
