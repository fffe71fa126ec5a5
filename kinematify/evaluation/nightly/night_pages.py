"""A night, and all nights, as pages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.evaluation.nightly.comparison import GOOD, QUALITY, ChangeKind
from kinematify.validation.check import FAMILIES
from kinematify.validation.formats.html_frame import rendered

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.evaluation.nightly.comparison import Night

_METRICS = {
    "angle_deg": "axis angle [deg]",
    "line_m": "axis line [m]",
    "ted": "tree edits",
    "types": "types right",
    "root": "root right",
    "limit_iou": "limit overlap",
    "opens": "opens right",
}


def night_page(night: Night) -> str:
    """Return the page of one night: the gate, what changed, objects against checks, accuracy, and every problem."""
    unlisted = (ChangeKind.STILL_FAILING, ChangeKind.NEW_SERIES)
    return rendered(
        "night.html",
        title=f"kinematify nightly {night.name}: {night.gate}",
        night=night,
        listed=[change for change in night.changes if change.kind not in unlisted],
        order={kind: number for number, kind in enumerate(ChangeKind)},
        quality=QUALITY,
        good=GOOD,
        validations=[run for run in night.runs if run.what == "validation"],
        inferences=[run for run in night.runs if run.what == "accuracy"],
        families=FAMILIES,
        metrics=_METRICS,
        anchor=anchor,
        short=lambda value: "" if value is None else f"{value:.4g}",
    )


def nights_page(nights: Sequence[Night]) -> str:
    """Return the page of all nights, a row each.

    Args:
        nights: The oldest first.
    """
    title = f"kinematify nightly: {len(nights)} nights"
    return rendered("nights.html", title=title, nights=nights[::-1], kinds=[kind.value for kind in ChangeKind][:-1])


def anchor(*words: str) -> str:
    """Return the id of a section or row of a page: letters, digits and dashes alone, so that an address can hold it."""
    return "".join(letter if letter.isascii() and letter.isalnum() else "-" for letter in "-".join(words))
