"""Whether a fault was found: a finding that the untouched model lacks names the place and puts the right blame."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from benchmarks.faults.fault import Fault, Planted
    from kinematify.validation.finding import Finding
    from kinematify.validation.report import ValidationReport

Fact = dict[str, Any]
"""What is kept of a finding: check, severity, blame, joint, link, pair."""


class Verdict(StrEnum):
    """What became of a planted fault."""

    FOUND = "found"
    """A new warning or error names the joint or link and puts the right blame."""
    NOTED = "only as a note"
    """A new note does: the shapes suggest otherwise, and no fact agrees."""
    ELSEWHERE = "elsewhere"
    """There are new warnings or errors, but they name something else or blame something else."""
    MISSED = "missed"
    """Nothing new was found."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """A mutant and what was said of it."""

    verdict: Verdict
    right: tuple[Fact, ...]
    other: tuple[Fact, ...]


def facts(report: ValidationReport) -> list[Fact]:
    """Warnings and errors of a report, and the notes that hold something against a joint, short."""
    return [
        _fact(finding)
        for finding in report.findings
        if finding.severity is not Severity.NOTE or CHECKS[finding.check].opinion
    ]


def _fact(finding: Finding) -> Fact:
    return {
        "check": finding.check,
        "severity": finding.severity.value,
        "blame": finding.blame.value,
        "joint": finding.joint,
        "link": finding.link,
        "pair": list(finding.pair) if finding.pair else None,
    }


def judge(fault: Fault, planted: Planted, found: Sequence[Fact], untouched: Sequence[Fact]) -> Outcome:
    """Compare the findings of a mutant with those of the model that it was made from."""
    known = {_key(fact) for fact in untouched}
    new = [fact for fact in found if _key(fact) not in known]
    right = [fact for fact in new if _names(fact, planted) and fact["blame"] in fault.blames]
    other = tuple(fact for fact in new if fact not in right)
    if any(_counts(fact) for fact in right):
        verdict = Verdict.FOUND
    elif right:
        verdict = Verdict.NOTED
    else:
        verdict = Verdict.ELSEWHERE if any(map(_counts, other)) else Verdict.MISSED
    return Outcome(verdict=verdict, right=tuple(right), other=other)


def _counts(fact: Fact) -> bool:
    return bool(fact["severity"] != Severity.NOTE)


def _key(fact: Fact) -> tuple[Any, ...]:
    return fact["check"], _counts(fact), fact["joint"], fact["link"], tuple(fact["pair"] or ())


def _names(fact: Fact, planted: Planted) -> bool:
    """The joint itself, or without a joint one of the links; any place where the whole model is wrong."""
    if not planted.links:
        return True
    if fact["joint"] is not None and planted.joint is not None:
        return bool(fact["joint"] == planted.joint)
    named: Collection[str] = [name for name in (fact["link"], *(fact["pair"] or ())) if name]
    return any(link in named for link in planted.links)
