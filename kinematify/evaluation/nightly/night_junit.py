"""A night as JUnit XML: a suite per object, a case per run.

Only what fails the night is a failure. A run in which nothing is new but something is still wrong is marked as
skipped, as expected failures are, so that it is neither green nor red.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lxml import etree

from kinematify.evaluation.nightly.comparison import ChangeKind
from kinematify.validation.formats.junit import count_cases
from kinematify.validation.formats.report_content import printable

if TYPE_CHECKING:
    from lxml.etree import _Element

    from kinematify.evaluation.nightly.comparison import Change
    from kinematify.evaluation.nightly.runs import Run
    from kinematify.evaluation.nightly.store import Night


def as_junit(night: Night) -> str:
    """Return the night as an XML document."""
    root = etree.Element("testsuites", name=f"kinematify nightly {night.name}")
    changes: dict[tuple[str, str, str], list[Change]] = {}
    for change in (*night.changes, *night.baseline_changes):
        changes.setdefault((change.object, change.what, change.case), []).append(change)
    for name in dict.fromkeys(run.object for run in night.runs):
        suite = etree.SubElement(root, "testsuite", name=printable(name))
        for run in (run for run in night.runs if run.object == name):
            _add_case(suite, run, changes.get(run.place, []))
        count_cases(suite)
    count_cases(root)
    text: str = etree.tostring(root, encoding="unicode", pretty_print=True)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}'


def _add_case(suite: _Element, run: Run, changes: list[Change]) -> None:
    case = etree.SubElement(
        suite, "testcase", classname=printable(f"{run.object}.{run.what}"), name=run.case, time=f"{run.seconds:.3f}"
    )
    failing = [change for change in changes if change.gate]
    if failing:
        element = etree.SubElement(case, "failure", message=_message(failing[0]), type=failing[0].kind.value)
        element.text = "\n".join(dict.fromkeys(map(_message, failing)))
    elif not run.answered:
        etree.SubElement(case, "skipped", message=printable(f"{run.status}: {run.message}"))
    elif run.problems:
        ids = ", ".join(problem.id for problem in run.problems)
        etree.SubElement(case, "skipped", message=printable(f"known problems, nothing new: {ids}"))
    others = [change for change in changes if not change.gate and change.kind is not ChangeKind.STILL_FAILING]
    if others:
        etree.SubElement(case, "system-out").text = "\n".join(dict.fromkeys(map(_message, others)))


def _message(change: Change) -> str:
    return printable(f"{change.kind.value}: {change.subject} {change.text}".replace("  ", " "))
