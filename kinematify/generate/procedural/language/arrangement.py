"""Where things are: above, below, left, right, in rows and columns; the answer is a layout."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from kinematify.generate.procedural.language.words import NUMBERS
from kinematify.generate.procedural.layout import CELLS

if TYPE_CHECKING:
    from collections.abc import Sequence

_ABOVE = ("above", "over", "atop")
_BELOW = ("below", "under", "beneath", "underneath")
_BESIDE = ("beside", "next", "alongside")
_SIDES = {"left": -1, "right": 1}
_LEVELS = {"top": 1, "upper": 1, "middle": 0, "bottom": -1, "lower": -1}
_MIDDLE = ("middle", "center", "centre", "between")
_PRONOUNS = ("it", "them", "these", "those", "that", "which", "each", "")


@dataclass(frozen=True, kw_only=True)
class Mention:
    """Some things of one kind, as a sentence names them."""

    kind: str
    """``door``, ``drawer`` or ``shelf``."""
    count: int
    first: int
    """Index of the first word."""
    last: int
    """Index of the last word."""
    grid: tuple[int, int] | None = None
    """Columns and rows, where the sentence gives both."""
    across: int = 0
    """-1 left, 1 right, where it is half of what stands on either side."""
    stated: bool = True
    """With a number; else it takes up what was named before, as in `the doors on the left`."""


@dataclass(kw_only=True)
class _Block:
    """A mention with the place that it is given."""

    mention: Mention
    across: int = 0
    """-1 left, 1 right."""
    up: int | None = None
    """1 top, 0 middle, -1 bottom; none where nothing is said."""


def layout_of(words: Sequence[str], mentions: Sequence[Mention]) -> tuple[str, tuple[int, ...]]:
    """Write down the arrangement that a sentence states.

    Args:
        words: The sentence.
        mentions: What it counts, in any order.

    Returns:
        A layout as `parse_layout` reads it, empty where the sentence states none, and the words that stated it.
    """
    shown = sorted((m for m in mentions if m.kind in CELLS and m.count > 0), key=lambda m: m.first)
    if not shown:
        return "", ()
    blocks, meant = _blocks(shown)
    used: list[int] = []
    for block in blocks:
        _place_described(words, block, used)
    for k, mention in enumerate(shown):
        end = shown[k + 1].first if k + 1 < len(shown) else len(words)
        following = meant[k + 1] if k + 1 < len(shown) else None
        _place(words, blocks, (meant[k], following), range(mention.last + 1, end), used)
    ends = {id(block.mention): _end(words, shown, block.mention) for block in blocks}
    texts = [_cells(words, block.mention, ends[id(block.mention)], used) for block in blocks]
    plain = [_stack(b.mention) for b in blocks]
    placed = used or any(block.across for block in blocks)
    if not placed and texts == plain and {b.mention.kind for b in blocks} <= {"door", "drawer"}:
        return "", ()
    return _written(blocks, texts), tuple(used)


def _place_described(words: Sequence[str], block: _Block, used: list[int]) -> None:
    """`left door`, `two upper drawers`: the place stands right before the noun, or between it and its number."""
    first, last = block.mention.first, block.mention.last
    numbered = words[first] in NUMBERS or words[first].isdigit()
    for at in range(first if numbered else max(first - 1, 0), last):
        if words[at] in _SIDES:
            block.across = _SIDES[words[at]]
        elif words[at] in _LEVELS:
            block.up = _LEVELS[words[at]]
        else:
            continue
        used.append(at)


def _blocks(mentions: Sequence[Mention]) -> tuple[list[_Block], list[_Block]]:
    """Return what is to be placed, and the one of them that each mention means."""
    kinds = {mention.kind for mention in mentions if mention.stated}
    own: dict[str, _Block] = {}
    blocks, meant = [], []
    for mention in sorted(mentions, key=lambda m: not m.stated):
        if (mention.stated or mention.kind not in kinds) and (mention.stated or mention.kind not in own):
            blocks.append(_Block(mention=mention, across=mention.across))
            own.setdefault(mention.kind, blocks[-1])
    of = {id(block.mention): block for block in blocks}
    meant = [of.get(id(mention), own[mention.kind]) for mention in mentions]
    return sorted(blocks, key=lambda block: (block.mention.first, block.mention.across)), meant


def _place(
    words: Sequence[str],
    blocks: list[_Block],
    pair: tuple[_Block, _Block | None],
    between: range,
    used: list[int],
) -> None:
    """Read the words between a mention and the next one."""
    block, following = pair
    for at in between:
        word, after = words[at], words[at + 1] if at + 1 < len(words) else ""
        if at in used:
            continue
        refers_back = after in _PRONOUNS or following is None or after in (",", ".", ";", "and")
        if word in ("left", "right"):
            side = -1 if word == "left" else 1
            block.across = side
            if following is not None and after == "of":
                following.across = -side
        elif word in _ABOVE or word in _BELOW or (word in ("top", "bottom") and words[at - 1] in ("on", "at", "the")):
            up = 1 if word in _ABOVE or word == "top" else -1
            block.up = up
            others = [following] if following is not None and not refers_back else [b for b in blocks if b is not block]
            for other in others:
                other.up = -up if other.up is None else other.up
        elif word in _MIDDLE:
            block.up = 0
        elif word in _BESIDE:
            block.across = -1
            if following is not None:
                following.across = 1
        else:
            continue
        used.append(at)


def _end(words: Sequence[str], mentions: Sequence[Mention], mention: Mention) -> int:
    """The word at which the next mention begins, or six words behind this one."""
    later = [other.first for other in mentions if other.first > mention.last]
    return min([mention.last + 6, len(words), *later])


def _stack(mention: Mention) -> str:
    return mention.kind if mention.count == 1 else f"{mention.count}*{mention.kind}"


def _cells(words: Sequence[str], mention: Mention, end: int, used: list[int]) -> str:
    """The cells of one mention, said before the word `end`: stacked, side by side, or in a grid."""
    kind, count = mention.kind, mention.count
    if mention.grid is not None:
        used.append(mention.first)
        return _grid(kind, *mention.grid)
    for at in range(mention.first, end):
        number = NUMBERS.get(words[at - 1], 0) or (int(words[at - 1]) if words[at - 1].isdigit() else 0)
        if words[at] in ("column", "columns", "row", "rows") and number and count % number == 0:
            used.extend((at - 1, at))
            columns = number if words[at].startswith("column") else count // number
            return _grid(kind, columns, count // columns)
        if words[at : at + 3] == ["side", "by", "side"] and at > mention.last:
            used.extend(range(at, at + 3))
            return _grid(kind, count, 1)
        if words[at] == "stacked":
            used.append(at)
            return _grid(kind, 1, count)
    joined = [at for at in range(mention.first, mention.last) if words[at] in ("x", "by")]
    if joined:
        used.extend(at for at, word in enumerate(words[: mention.last]) if word == "grid")
        rows = int(words[joined[0] - 1]) if words[joined[0] - 1].isdigit() else NUMBERS.get(words[joined[0] - 1], 1)
        return _grid(kind, max(1, count // max(rows, 1)), rows)
    return _stack(mention)


def _grid(kind: str, columns: int, rows: int) -> str:
    row = " | ".join([kind] * columns)
    return " / ".join([f"({row})" if columns > 1 else kind] * rows)


def _written(blocks: Sequence[_Block], texts: Sequence[str]) -> str:
    """Left, middle and right columns; in each, what is on top first."""
    columns = []
    places = {block.across for block in blocks}
    if len(places) == 1 and places != {0}:  # on the right of a front that is otherwise plain
        column = _written([replace(block, across=0) for block in blocks], texts)
        return f"panel | ({column})" if places == {1} else f"({column}) | panel"
    for across in (-1, 0, 1):
        members = [(b, t) for b, t in zip(blocks, texts, strict=True) if b.across == across]
        order = {"shelf": 0, "door": 1, "drawer": 2}
        stated = any(b.up is not None for b, _ in members)
        members.sort(key=lambda item: -(item[0].up or 0) if stated else order.get(item[0].mention.kind, 3))
        if members:
            columns.append(" / ".join(text for _, text in members))
    return " | ".join(f"({column})" for column in columns) if len(columns) > 1 else columns[0]
