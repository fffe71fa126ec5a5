"""Whether a fault was found: a finding that the untouched model lacks names the place and puts the right blame."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from kinematify.evaluation.mutants.fault import Fault, Planted
    from kinematify.validation.finding import Finding
    from kinematify.validation.report import ValidationReport

Fact = dict[str, Any]
"""What is kept of a finding: check, severity, blame, joint, link, pair."""


class Verdict(StrEnum):
    """What became of a planted fault."""

    FOUND = "found"
    """A new finding names the joint or link and puts the right blame."""
    ELSEWHERE = "elsewhere"
    """There are new findings, but they name something else or blame something else."""
    MISSED = "missed"
    """Nothing new was found."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """A mutant and what was said of it."""

    verdict: Verdict
    right: tuple[Fact, ...]
    other: tuple[Fact, ...]


def facts(report: ValidationReport) -> list[Fact]:
    """Warnings and errors of a report, short."""
    return [_fact(finding) for finding in report.findings if finding.severity is not Severity.NOTE]


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
    verdict = Verdict.FOUND if right else Verdict.ELSEWHERE if new else Verdict.MISSED
    return Outcome(verdict=verdict, right=tuple(right), other=tuple(fact for fact in new if fact not in right))


def _key(fact: Fact) -> tuple[Any, ...]:
    return fact["check"], fact["joint"], fact["link"], tuple(fact["pair"] or ())


def _names(fact: Fact, planted: Planted) -> bool:
    """The joint itself, or without a joint one of the links; any place where the whole model is wrong."""
    if not planted.links:
        return True
    if fact["joint"] is not None and planted.joint is not None:
        return bool(fact["joint"] == planted.joint)
    named: Collection[str] = [name for name in (fact["link"], *(fact["pair"] or ())) if name]
    return any(link in named for link in planted.links)
