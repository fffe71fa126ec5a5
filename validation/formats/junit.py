"""JUnit XML as continuous integration reads it: a suite per model, a case per check and engine.

Errors alone are failures, as they alone change the exit status; warnings and notes stand in the case's output.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lxml import etree

from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.report_content import family, lasting_title, measure, printable, where
from kinematify.validation.run.report import Unusable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lxml.etree import _Element

    from kinematify.validation.finding import CheckResult, Finding
    from kinematify.validation.run.report import Outcome, ValidationReport

_COUNTED = (("failures", "failure"), ("errors", "error"), ("skipped", "skipped"))


def as_junit(outcomes: Sequence[Outcome]) -> str:
    """Return the outcomes as an XML document."""
    root = etree.Element("testsuites", name="kinematify validate")
    for outcome in outcomes:
        suite = etree.SubElement(root, "testsuite", name=printable(outcome.model))
        if isinstance(outcome, Unusable):
            _fill_unusable(suite, outcome)
        else:
            _fill(suite, outcome)
        count_cases(suite)
    count_cases(root)
    text: str = etree.tostring(root, encoding="unicode", pretty_print=True)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}'


def _fill(suite: _Element, report: ValidationReport) -> None:
    facts = etree.SubElement(suite, "properties")
    for key, value in {**report.environment, "verdict": report.verdict}.items():
        etree.SubElement(facts, "property", name=key, value=printable(f"{value}"))
    for check in report.checks:
        _add_case(suite, report.model, check)


def _fill_unusable(suite: _Element, outcome: Unusable) -> None:
    model = printable(outcome.model)
    case = etree.SubElement(suite, "testcase", classname=model, name="readable as a URDF", time="0")
    message = printable(outcome.message)
    etree.SubElement(case, "error", message=message, type="unusable").text = message


def _add_case(suite: _Element, model: str, check: CheckResult[Finding]) -> None:
    case = etree.SubElement(
        suite,
        "testcase",
        classname=printable(f"{model}.{family(check.check)}"),
        name=printable(lasting_title(check)),
        time=f"{check.seconds:.3f}",
    )
    counted = [finding for finding in check.findings if finding.suppressed is None and finding.follows_from is None]
    failing = [finding for finding in counted if finding.severity is Severity.ERROR]
    others = [finding for finding in check.findings if finding not in failing]
    if failing:
        # A check that fell over did not come to an answer: that is an error of the test, not a failure of the model.
        tag = "error" if check.status is Status.BLOCKED else "failure"
        element = etree.SubElement(case, tag, message=printable(failing[0].message), type=failing[0].cause.value)
        element.text = "\n\n".join(_text(finding) for finding in failing)
    elif check.status in (Status.SKIPPED, Status.BLOCKED):
        etree.SubElement(case, "skipped", message=printable(f"{check.status.value}: {check.reason or 'no reason'}"))
    if others:
        etree.SubElement(case, "system-out").text = "\n\n".join(_text(finding) for finding in others)


def _text(finding: Finding) -> str:
    about = [part for part in (where(finding), measure(finding)) if part]
    about += [f"line {finding.line}"] if finding.line is not None else []
    lines = [
        f"{finding.severity.value} ({finding.cause.value}): {finding.message}",
        *(["  " + "; ".join(about)] if about else []),
        f"  Remedy: {finding.remedy}",
        *([f"  Follows from: {finding.follows_from.message}"] if finding.follows_from is not None else []),
        *([f"  Suppressed: {finding.suppressed}"] if finding.suppressed is not None else []),
    ]
    return printable("\n".join(lines))


def count_cases(element: _Element) -> None:
    """Set the attributes of a suite, or of all suites, by which readers of JUnit sum up."""
    cases = list(element.iter("testcase"))
    element.set("tests", str(len(cases)))
    for attribute, tag in _COUNTED:
        element.set(attribute, str(sum(case.find(tag) is not None for case in cases)))
    element.set("time", f"{sum(float(case.get('time') or 0.0) for case in cases):.3f}")
