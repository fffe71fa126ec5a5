"""A night as pages and as JUnit XML, where only what fails the night is a failure.

A run in which nothing is new but something is still wrong is marked as skipped, as expected failures are, so that it is
neither green nor red.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lxml import etree

from kinematify.evaluation.nightly.comparison import GOOD, QUALITY, ChangeKind
from kinematify.validation.check import FAMILIES
from kinematify.validation.formats.html_frame import rendered
from kinematify.validation.formats.junit import count_cases
from kinematify.validation.formats.report_content import printable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.evaluation.nightly.comparison import Change, Night

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


def as_junit(night: Night) -> str:
    """Return the night as an XML document: a suite per object, a case per run."""
    root = etree.Element("testsuites", name=f"kinematify nightly {night.name}")
    for name in dict.fromkeys(run.object for run in night.runs):
        suite = etree.SubElement(root, "testsuite", name=printable(name))
        for run in (run for run in night.runs if run.object == name):
            place = printable(f"{name}.{run.what}")
            case = etree.SubElement(suite, "testcase", classname=place, name=run.case, time=f"{run.seconds:.3f}")
            own = [change for change in night.changes if (change.object, change.what, change.case) == run.place]
            failing = [_message(change) for change in own if change.gate]
            known = ", ".join(problem.id for problem in run.problems)
            if failing:
                etree.SubElement(case, "failure", message=failing[0], type="regression").text = "\n".join(failing)
            elif run.reported:
                words = f"known problems, nothing new: {known}" if run.answered else f"{run.status}: {run.message}"
                etree.SubElement(case, "skipped", message=printable(words))
            others = [_message(item) for item in own if not item.gate and item.kind is not ChangeKind.STILL_FAILING]
            if others:
                etree.SubElement(case, "system-out").text = "\n".join(others)
        count_cases(suite)
    count_cases(root)
    text: str = etree.tostring(root, encoding="unicode", pretty_print=True)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}'


def _message(change: Change) -> str:
    return printable(f"{change.kind.value}: {change.subject} {change.text}".replace("  ", " "))
