"""Facts before opinions: what only our own inference holds against a joint is a note until a fact agrees.

A fact is something that a user can measure or see without us: an overlap, a part that leaves, a drive that stops. Over
published robots that work, 27 of 28 findings of the inference alone were wrong, so no score of ours makes a file fail.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.validation.check import FeedbackRow
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.finding import CheckResult, Finding


def demote_inference_findings(results: Sequence[CheckResult]) -> list[CheckResult]:
    """Return the results with the opinions about each joint as one note, unless an error of fact is about that joint.

    Of a joint whose line a fact doubts, the opinions about its line are omitted: the fact names the better one.

    Args:
        results: Of all checks of a run.
    """
    facts = {finding.joint for finding in _findings(results, opinion=False) if _proves(finding)}
    lines = {finding.joint for finding in _findings(results, opinion=False) if _doubts_line(finding)}
    spoken: dict[str | None, list[Finding]] = {}
    apart: list[Finding] = []
    for finding in _findings(results, opinion=True):
        if finding.joint in facts or finding.cause is Cause.ENGINE:  # a crash of the stage is no opinion
            continue
        group = apart if finding.joint in lines and _doubts_line(finding) else spoken.setdefault(finding.joint, [])
        group.append(finding)
    notes = {id(group[0]): _note(group) for group in spoken.values()}
    folded = {id(finding) for group in (*spoken.values(), apart) for finding in group}
    return [_as_notes(result, notes, folded) if CHECKS[result.check].opinion else result for result in results]


_LIFTS = "KV349"
_SWEPT = ("KV310", "KV311", "KV312", "KV320")
"""What exact sweeps measure of one joint."""


def join_facts(results: Sequence[CheckResult]) -> list[CheckResult]:
    """Make it an error that a part lifts off its bearing (KV349) where its sweep goes wrong too: two facts, one axis.

    Args:
        results: Of all checks of a run.
    """
    swept: dict[str | None, list[str]] = {}
    for finding in _findings(results, opinion=False):
        if finding.check in _SWEPT and finding.severity is not Severity.NOTE and finding.cause is Cause.KINEMATICS:
            swept.setdefault(finding.joint, []).append(finding.check)

    def joined(finding: Finding) -> Finding:
        others = swept.get(finding.joint)
        if finding.check != _LIFTS or finding.severity is not Severity.WARNING or not others:
            return finding
        also = f"{finding.message} Its sweep speaks against the same line ({', '.join(dict.fromkeys(others))})."
        return replace(finding, severity=Severity.ERROR, message=also)

    return [
        replace(result, findings=tuple(map(joined, result.findings))) if result.check == _LIFTS else result
        for result in results
    ]


def _findings(results: Sequence[CheckResult], *, opinion: bool) -> list[Finding]:
    return [finding for item in results if CHECKS[item.check].opinion is opinion for finding in item.findings]


def _proves(finding: Finding) -> bool:
    return finding.severity is Severity.ERROR and finding.cause is Cause.KINEMATICS and finding.joint is not None


def _doubts_line(finding: Finding) -> bool:
    return CHECKS[finding.check].feedback is FeedbackRow.LINE


def _note(group: Sequence[Finding]) -> Finding:
    """Return one note for all opinions about a joint."""
    others = [finding.check for finding in group[1:]]
    also = f" ({', '.join(others)} say so too.)" if others else ""
    return replace(
        group[0],
        severity=Severity.NOTE,
        message=f"The shapes suggest otherwise, though nothing measured does: {group[0].message}{also}",
    )


def _as_notes(result: CheckResult, notes: dict[int, Finding], folded: set[int]) -> CheckResult:
    return result.with_findings(
        notes.get(id(item), item) for item in result.findings if id(item) in notes or id(item) not in folded
    )
