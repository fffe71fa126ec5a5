"""One HTML file that opens from disk: nothing is loaded from elsewhere, and without scripts all of it can be read."""

from __future__ import annotations

import base64
import json
from typing import TYPE_CHECKING

from kinematify.validation.finding import Blame, Severity, Status
from kinematify.validation.formats.html_frame import badge, page, table, text
from kinematify.validation.formats.text import (
    FAMILY_HEADINGS,
    alternative,
    configuration,
    family_rows,
    figures,
    joint_range,
    measure,
    title,
    where,
)
from kinematify.validation.outcome import Unusable, counted_words, severity_counts, status_counts

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.validation.finding import CheckResult, Finding
    from kinematify.validation.outcome import Outcome
    from kinematify.validation.report import ValidationReport

_COUNTS = ("", "", "number", "number", "number", "number", "number")
"""Classes of the columns of the table of families."""


def as_html(outcomes: Sequence[Outcome], pictures: Mapping[str, bytes]) -> str:
    """Return the outcomes as a page.

    Args:
        outcomes: In the order of the models.
        pictures: PNG of a model, keyed by its path as given; may lack some.
    """
    title_text = f"kinematify validate: {_headline(outcomes)}"
    body = [
        f"<h1>{text(title_text)}</h1>",
        _contents(outcomes) if len(outcomes) > 1 else "",
        _filters(outcomes),
        *(_section(index, outcome, pictures.get(outcome.model, b"")) for index, outcome in enumerate(outcomes)),
    ]
    return page(title_text, body)


def _headline(outcomes: Sequence[Outcome]) -> str:
    if len(outcomes) == 1:
        return f"{outcomes[0].verdict}, {outcomes[0].model}"
    failed = sum(outcome.verdict in ("fail", "unusable") for outcome in outcomes)
    return f"{len(outcomes)} models, {failed} of them not good"


def _contents(outcomes: Sequence[Outcome]) -> str:
    rows = [
        (
            f'<a href="#model-{index}">{text(outcome.model)}</a>',
            badge(outcome.verdict),
            *(("", "", "") if isinstance(outcome, Unusable) else map(str, _severities(outcome))),
        )
        for index, outcome in enumerate(outcomes)
    ]
    return table(
        ("model", "verdict", "errors", "warnings", "notes"),
        rows,
        name="models",
        classes=("", "", "number", "number", "number"),
    )


def _severities(report: ValidationReport) -> tuple[int, ...]:
    counts = severity_counts(report)
    return tuple(counts.get(severity, 0) for severity in Severity)


def _filters(outcomes: Sequence[Outcome]) -> str:
    """Boxes for the severities and blames that occur; nothing where there is nothing to choose."""
    findings = [finding for outcome in outcomes if not isinstance(outcome, Unusable) for finding in outcome.findings]
    if not findings:
        return ""
    severities = [item for item in Severity if any(finding.severity is item for finding in findings)]
    blames = [item for item in Blame if any(finding.blame is item for finding in findings)]
    boxes = [_box("severity", item.value) for item in severities] + [_box("blame", item.value) for item in blames]
    return f'<div class="filters">Show {"".join(boxes)}<span id="shown" class="faint"></span></div>'


def _box(kind: str, value: str) -> str:
    return f'<label><input type="checkbox" name="{kind}" value="{value}" checked> {value}</label>'


def _section(index: int, outcome: Outcome, picture: bytes) -> str:
    heading = f'<h2 id="model-{index}">{badge(outcome.verdict)} {text(outcome.model)}</h2>'
    if isinstance(outcome, Unusable):
        return f"<section>{heading}<p>{text(outcome.message)}</p></section>"
    parts = [
        heading,
        f"<p>{text(_summary(outcome))}</p>",
        _picture(picture),
        "<h3>Families</h3>",
        table(FAMILY_HEADINGS, _family_cells(outcome), name=f"families-{index}", classes=_COUNTS),
        "<h3>Findings</h3>",
        "".join(_finding(item) for item in outcome.findings if not _is_pair_note(item)) or "<p>None.</p>",
        _joints(index, outcome),
        _pairs(index, outcome),
        _checks(index, outcome),
        _environment(outcome),
    ]
    return "<section>" + "\n".join(part for part in parts if part) + "</section>"


def _summary(report: ValidationReport) -> str:
    found = ", ".join(
        counted_words(count, severity.value) for severity, count in zip(Severity, _severities(report), strict=True)
    )
    counts = status_counts(report)
    checks = ", ".join(f"{counts.get(status, 0)} {status.value}" for status in Status)
    suppressed = len(report.findings) - len(report.counted)
    more = f" {counted_words(suppressed, 'finding')} suppressed." if suppressed else ""
    partial = " The run was interrupted: this report is partial." if report.environment.get("interrupted") else ""
    return f"{found}. Checks: {checks}.{more}{partial}"


def _picture(png: bytes) -> str:
    if not png:
        return ""
    data = base64.b64encode(png).decode("ascii")
    return (
        f'<img class="picture" alt="The model at rest, and with every joint moved" src="data:image/png;base64,{data}">'
    )


def _family_cells(report: ValidationReport) -> list[tuple[str, ...]]:
    return [tuple(map(text, row)) for row in family_rows(report)]


def _finding(finding: Finding) -> str:
    facts = [
        where(finding),
        finding.engine or "",
        f"at {configuration(finding.q)}" if configuration(finding.q) else "",
        measure(finding),
        f"blames {finding.blame.value}",
        f"line {finding.line}" if finding.line is not None else "",
    ]
    shut = finding.suppressed is not None
    return (
        f'<div class="finding {finding.severity.value}{" suppressed" if shut else ""}" '
        f'data-severity="{finding.severity.value}" data-blame="{finding.blame.value}">'
        f"<p><strong>{finding.severity.value} {text(title(finding))}</strong></p>"
        f'<p class="faint">{text("; ".join(fact for fact in facts if fact))}</p>'
        f"<p>{text(finding.message)}</p><p>Remedy: {text(finding.remedy)}</p>"
        + (f"<p>Suppressed: {text(finding.suppressed or '')}</p>" if shut else "")
        + "</div>"
    )


def _joints(index: int, report: ValidationReport) -> str:
    if not report.joints:
        return ""
    rows = [
        tuple(
            map(
                text,
                (
                    joint.joint,
                    joint.kind,
                    joint_range(joint, joint.declared_limits),
                    joint_range(joint, joint.free_travel),
                    alternative(joint),
                ),
            )
        )
        for joint in report.joints
    ]
    headings = ("joint", "type", "declared limits", "free travel", "better alternative")
    return "<h3>Joints</h3>" + table(headings, rows, name=f"joints-{index}")


def _pairs(index: int, report: ValidationReport) -> str:
    """Notes about pairs, such as why they may touch: often hundreds, so a table and not a card each."""
    notes = [finding for finding in report.findings if _is_pair_note(finding)]
    if not notes:
        return ""
    rows = [tuple(map(text, (where(f), title(f), measure(f), f.message))) for f in notes]
    inner = table(("pair", "check", "measured", "reason"), rows, name=f"pairs-{index}")
    return f"<details><summary>{len(rows)} notes on pairs, such as why they may touch</summary>{inner}</details>"


def _is_pair_note(finding: Finding) -> bool:
    return finding.severity is Severity.NOTE and finding.pair is not None


def _checks(index: int, report: ValidationReport) -> str:
    rows = [
        (text(title(check)), check.status.value, f"{check.seconds:.3f}", text(_remark(check)))
        for check in report.checks
    ]
    inner = table(
        ("check", "status", "seconds", "remark"), rows, name=f"checks-{index}", classes=("", "state", "number", "")
    )
    return f"<details><summary>All {len(rows)} checks</summary>{inner}</details>"


def _remark(check: CheckResult) -> str:
    return "; ".join(part for part in (check.reason or "", figures(check)) if part)


def _environment(report: ValidationReport) -> str:
    facts = json.dumps(report.as_json()["environment"], indent=2)
    return f"<details><summary>Environment and settings</summary><pre>{text(facts)}</pre></details>"
