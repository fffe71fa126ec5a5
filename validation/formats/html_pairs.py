"""Which bodies meet which, in a page: a matrix for the eye, and a table with the reason of every pair."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.formats.content import number
from kinematify.validation.formats.html_frame import table, text
from kinematify.validation.formats.html_motion import show_button

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.summary import PairSummary, PairTable

_MATRIX_AT_MOST = 40
"""Bodies; a larger matrix is read by nobody."""
_OPEN_AT_MOST = 10
_CLEAR = "\N{MIDDLE DOT}"


def pair_matrix(index: int, pairs: PairTable | None) -> str:
    """Return the matrix and the table of a model; empty where there is nothing to say.

    Args:
        index: Of the model in the page.
        pairs: From the exact geometry.
    """
    if pairs is None or len(pairs.bodies) < 2:
        return ""
    rest = len(pairs.bodies) * (len(pairs.bodies) - 1) // 2 - len(pairs.pairs)
    opened = " open" if len(pairs.bodies) <= _OPEN_AT_MOST else ""
    inner = (_matrix(index, pairs) if len(pairs.bodies) <= _MATRIX_AT_MOST else "") + _table(index, pairs.pairs)
    words = f"{len(pairs.pairs)} touch at rest or meet, {rest} stay clear in all that was looked at"
    return f"<details{opened}><summary>Pairs of bodies: {words}</summary>{inner}</details>"


def _matrix(index: int, pairs: PairTable) -> str:
    known = {frozenset(item.pair): item for item in pairs.pairs}
    head = "".join(f'<th scope="col" title="{text(body)}">{k + 1}</th>' for k, body in enumerate(pairs.bodies))
    rows = "".join(
        f'<tr><th scope="row">{k + 1} {text(body)}</th>'
        + "".join(_cell(body, other, known.get(frozenset((body, other)))) for other in pairs.bodies)
        + "</tr>"
        for k, body in enumerate(pairs.bodies)
    )
    body_rows = f"<thead><tr><th></th>{head}</tr></thead><tbody>{rows}</tbody>"
    return (
        '<div class="scroll" tabindex="0" role="region" aria-label="Matrix of pairs">'
        f'<table id="matrix-{index}"><caption>{_LETTERS}</caption>{body_rows}</table></div>'
    )


_LETTERS = (
    "J: joined and in contact at rest; R: in contact at rest; A: in contact nearly always; M: meet while a joint "
    f"moves; {_CLEAR}: stay clear."
)


def _cell(body: str, other: str, item: PairSummary | None) -> str:
    if body == other:
        return "<td></td>"
    if item is None:
        return f'<td class="faint">{_CLEAR}</td>'
    letter = _letter(item)
    state = ' class="fail"' if item.meets else ""
    return f'<td{state} title="{text(f"{body} - {other}: {_reason(item)}")}">{letter}</td>'


def _letter(item: PairSummary) -> str:
    first = "" if item.reason is None else {"joined": "J", "in contact at": "R"}.get(_kind(item.reason), "A")
    return first + ("M" if item.meets else "")


def _kind(reason: str) -> str:
    return next((start for start in ("joined", "in contact at") if reason.startswith(start)), "")


def _reason(item: PairSummary) -> str:
    met = [f"meet while {joint} moves, from {number(value)}" for joint, value, _ in item.meets]
    return "; ".join([*([item.reason] if item.reason else []), *met])


def _table(index: int, pairs: Sequence[PairSummary]) -> str:
    if not pairs:
        return ""
    rows = [
        (
            text(" - ".join(item.pair)),
            text(_reason(item)),
            number(1e3 * item.at_rest),
            number(1e3 * item.tolerated),
            number(1e3 * max((depth for _, _, depth in item.meets), default=0.0)),
            show_button(index, {joint: value for joint, value, _ in item.meets[:1]}, item.pair, "Show"),
        )
        for item in pairs
    ]
    headings = ("pair", "reason", "at rest [mm]", "tolerated [mm]", "deeper on the way [mm]", "in 3-D")
    return table(headings, rows, name=f"pair-reasons-{index}", classes=("", "", "number", "number", "number", ""))
