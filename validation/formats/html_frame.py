"""Frame of every HTML page: policy, style and script, tables, badges and escaped text."""

from __future__ import annotations

from functools import cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.validation.formats.report_content import printable

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_ASSETS = Path(__file__).resolve().parent / "assets"
_POLICY = "default-src 'none'; img-src {images}; style-src 'unsafe-inline'; script-src 'unsafe-inline'"
"""A name in a URDF must not be able to make the page load anything from elsewhere."""
_BESIDE = "data: 'self' file:"
"""From where a page may show pictures that lie beside it."""
_MANY_ROWS = 8
"""Tables with more rows get a box that filters them."""

Cell = str | tuple[str, str]
"""HTML of a table's cell, or that with the value by which the cell is sorted."""


@cache
def asset(name: str) -> str:
    """Text of a style or script that is packaged beside this module."""
    return (_ASSETS / name).read_text(encoding="utf-8")


def page(title: str, body: Iterable[str], *, scripts: Sequence[str] = (), beside: bool = False) -> str:
    """Return a page that loads nothing from other servers and can be read without scripts.

    Args:
        title: Plain text.
        body: Pieces of HTML.
        scripts: Names of further assets.
        beside: Whether it may show pictures that lie beside it.
    """
    policy = _POLICY.format(images=_BESIDE if beside else "data:")
    code = "\n".join(asset(name) for name in ("page.js", *scripts))
    parts = [
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{text(title)}</title><style>{asset('page.css')}</style></head><body>",
        '<a class="skip" href="#content">To the content</a><main id="content">',
        *body,
        f"</main><script>{code}</script></body></html>\n",
    ]
    return "\n".join(part for part in parts if part)


def text(words: str) -> str:
    """Escaped text without what neither XML nor terminals can take."""
    return escape(printable(words))


def badge(verdict: str) -> str:
    """A verdict as a word on a colour."""
    return f'<span class="verdict {text(verdict)}">{text(verdict)}</span>'


def table(
    headings: Sequence[str],
    rows: Iterable[Sequence[Cell]],
    *,
    name: str,
    classes: Sequence[str] = (),
    anchors: Sequence[str] = (),
) -> str:
    """Return a table that sorts by a click on a heading, with a box that filters it if it is long.

    Args:
        headings: Plain text.
        rows: Cells that are HTML already.
        name: Id of the table, unique in the page.
        classes: A class for all cells of each column, empty for none; ``state``: the cell's text is its class.
        anchors: Id of each row.
    """
    head = "".join(
        f'<th scope="col" aria-sort="none"><button type="button">{text(heading)}</button></th>' for heading in headings
    )
    kinds = [*classes, *[""] * (len(headings) - len(classes))]
    listed = list(rows)
    lines = [
        _row([_cell(cell, kind) for cell, kind in zip(row, kinds, strict=True)], anchors[k] if anchors else "")
        for k, row in enumerate(listed)
    ]
    tools = _tools(name) if len(lines) > _MANY_ROWS else ""
    return (
        f'{tools}<div class="scroll" tabindex="0" role="region" aria-label="Table {text(name)}">'
        f'<table id="{text(name)}"><thead><tr>{head}</tr></thead><tbody>{"".join(lines)}</tbody></table></div>'
    )


def _tools(name: str) -> str:
    return (
        f'<div class="tools"><label>Filter <input type="search" data-table="{text(name)}" disabled></label>'
        '<output class="faint" aria-live="polite"></output></div>'
    )


def _row(cells: Sequence[str], anchor: str) -> str:
    mark = f' id="{text(anchor)}"' if anchor else ""
    return f"<tr{mark}>{''.join(cells)}</tr>"


def _cell(cell: Cell, kind: str) -> str:
    shown, value = (cell, None) if isinstance(cell, str) else cell
    kind = shown.split(" ")[0] if kind == "state" else kind
    css = f' class="{text(kind)}"' if kind else ""
    sort = "" if value is None else f' data-value="{text(value)}"'
    return f"<td{css}{sort}>{shown}</td>"
