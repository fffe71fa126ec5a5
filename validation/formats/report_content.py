"""Content of all reports and of the terminal: statements about a model and about each finding.

A format marks up blocks and tables and decides nothing about what they say.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import ExitStatus
from kinematify.validation.check import FAMILIES
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Finding, Severity, Status
from kinematify.validation.run.report import counted_words, severity_counts, status_counts

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

    from kinematify.validation.finding import CheckResult, JointSummary
    from kinematify.validation.run.conclusion import FindingGroup
    from kinematify.validation.run.report import ValidationReport

SHOWN_JOINTS = 4
"""A configuration is shortened to the joints that are farthest from zero."""
PLACES = 6
"""So many places where the same was found are named."""
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
_UNPRINTABLE = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
TURNING = ("revolute", "continuous")
"""Types whose values are angles."""


def printable(text: str) -> str:
    """The text without control characters and halves of characters, which XML and terminals cannot take."""
    return _UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", text)


def where(finding: Finding) -> str:
    """The joint, the link or the pair that a finding is about; empty if it is about the whole model."""
    if finding.pair is not None:
        between = " - ".join(map(_named, finding.pair))
        return f"{between} (joint {_named(finding.joint)})" if finding.joint else between
    names = (("joint", finding.joint), ("link", finding.link))
    return ", ".join(f"{kind} {_named(name)}" for kind, name in names if name is not None)


def _named(name: str) -> str:
    """A name in quotes where it is a number, so that nobody takes it for a value."""
    return f"'{name}'" if name.isdecimal() else name


def configuration(q: Mapping[str, float] | None) -> str:
    """The joints that stand away from zero, the farthest first; empty if all are at zero or none is known."""
    moved = sorted(((name, value) for name, value in (q or {}).items() if value), key=lambda item: -abs(item[1]))
    shown = ", ".join(f"{name} {number(value)}" for name, value in moved[:SHOWN_JOINTS])
    hidden = len(moved) - SHOWN_JOINTS
    return f"{shown} and {hidden} more" if hidden > 0 else shown


def measure(finding: Finding) -> str:
    """Return what was measured against its limit, with the unit; empty if nothing was."""
    unit = f" {finding.unit}" if finding.unit else ""
    if finding.value is None:
        return "" if finding.limit is None else f"limit {number(finding.limit)}{unit}"
    measured = f"{number(finding.value)}{unit}"
    return measured if finding.limit is None else f"{measured}, limit {number(finding.limit)}{unit}"


def number(value: float) -> str:
    """Four digits, without an exponent where that is readable."""
    return f"{value:.4g}" if math.isfinite(value) else {math.inf: "infinite", -math.inf: "-infinite"}.get(value, "NaN")


def joint_range(joint: JointSummary, limits: tuple[float, float] | None) -> str:
    """A range in degrees or millimetres; a dash if there is none."""
    if limits is None:
        return "-"
    turning = joint.kind in TURNING
    low, high = (number(math.degrees(value) if turning else 1000.0 * value) for value in limits)
    return f"{low} to {high} {'deg' if turning else 'mm'}"


@dataclass(frozen=True, kw_only=True)
class Table:
    """Rows of plain text; empty where there is nothing to list."""

    headings: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


def joint_table(report: ValidationReport) -> Table:
    """Every joint with its ranges and what would explain the geometry better."""
    rows = [
        (
            joint.joint,
            joint.kind,
            joint_range(joint, joint.declared_limits),
            joint_range(joint, joint.free_travel),
            alternative(joint),
        )
        for joint in report.joints
    ]
    return Table(headings=("joint", "type", "declared limits", "free travel", "better alternative"), rows=rows)


def family_table(report: ValidationReport) -> Table:
    """Checks by family and engine, with a count for each status."""
    groups: dict[tuple[str, str], list[CheckResult[Finding]]] = {}
    for check in report.checks:
        groups.setdefault((check.check[:3], check.engine or "-"), []).append(check)
    rows = [
        (
            f"{prefix} {FAMILIES[prefix]}",
            engine,
            *(str(sum(check.status is status for check in checks)) for status in Status),
            f"{sum(check.seconds for check in checks):.2f}",
        )
        for (prefix, engine), checks in sorted(groups.items())
    ]
    return Table(headings=("family", "engine", *(status.value for status in Status), "seconds"), rows=rows)


def check_table(report: ValidationReport) -> Table:
    """Every check with what became of it, why, and what it measured."""
    rows = []
    for check in report.checks:
        figures = ", ".join(f"{name} {number(float(value))}" for name, value in check.measured.items())
        remark = "; ".join(part for part in (check.reason or "", figures) if part)
        rows.append((title(check), check.status.value, f"{check.seconds:.3f}", remark))
    return Table(headings=("check", "status", "seconds", "remark"), rows=rows)


def alternative(joint: JointSummary) -> str:
    """The joint that would explain the geometry better, in a few words; a dash if there is none."""
    better = joint.best_alternative
    if not better:
        return "-"
    places = [
        f"{key} ({', '.join(number(float(item)) for item in better[key])})"
        for key in ("axis", "pivot")
        if better.get(key) is not None
    ]
    kind = [str(better["kind"])] if better.get("kind") else []
    score = [f"score {number(float(better['score']))}"] if better.get("score") is not None else []
    return ", ".join([*kind, *places, *score])


def title(item: CheckResult[Finding] | Finding) -> str:
    """Id, title and engine of a check: what is wrong of a finding or a check that failed, else what should be."""
    failed = isinstance(item, Finding) or item.status is Status.FAIL
    return _titled(item.check, CHECKS[item.check].fails, item.engine) if failed else lasting_title(item)


def follow_words(consequences: Iterable[Finding]) -> str:
    """Which checks say what follows from a finding, in which engine and how often; empty if none does."""
    counts = Counter((item.check, item.engine) for item in consequences)
    return ", ".join(
        f"{check}{f' [{engine}]' if engine else ''}{f' {count} times' if count > 1 else ''}"
        for (check, engine), count in counts.items()
    )


def lasting_title(item: CheckResult[Finding] | Finding) -> str:
    """Id, title and engine of a check, the same whatever became of it: names by which machines follow it over time."""
    return _titled(item.check, CHECKS[item.check].title, item.engine)


def _titled(check: str, title: str, *engines: str | None) -> str:
    names = ", ".join(dict.fromkeys(engine for engine in engines if engine))
    return f"{check} {title}{f' [{names}]' if names else ''}"


def family(check: str) -> str:
    """Title of the family of an id."""
    return FAMILIES[check[:3]]


def summary_words(report: ValidationReport) -> str:
    """Return what follows the verdict: how much was found, what ran, how long it took and what is not finished."""
    severities, statuses = severity_counts(report), status_counts(report)
    ran = statuses.get(Status.PASS, 0) + statuses.get(Status.FAIL, 0)
    left = [f"{statuses[item]} {item.value}" for item in (Status.SKIPPED, Status.BLOCKED) if statuses.get(item)]
    suppressed, unfinished = len(report.findings) - len(report.counted), len(report.unfinished)
    status = ", exit status 3" if report.exit_status == ExitStatus.FAULT else ""
    parts = [
        ", ".join(counted_words(severities.get(item, 0), item.value) for item in Severity),
        f"{counted_words(suppressed, 'finding')} suppressed" if suppressed else "",
        ", ".join([f"{ran} of {len(report.checks)} checks ran", *left]),
        f"{float(report.environment.get('seconds', 0.0)):.1f} s",
        f"{counted_words(unfinished, 'check')} not finished{status}" if unfinished else "",
        "interrupted: partial" if report.interrupted else "",
    ]
    return "; ".join(part for part in parts if part)


def reasons(report: ValidationReport, statuses: Collection[Status]) -> list[str]:
    """Why checks of some statuses did not run, or were not finished, a paragraph for each reason."""
    grouped: dict[tuple[Status, str], list[str]] = {}
    for check in report.checks:
        if check.status in statuses or check.unfinished:
            grouped.setdefault((check.status, check.reason or "no reason given"), []).append(check.check)
    return [f"{status.value} ({_listed(checks)}): {reason}" for (status, reason), checks in grouped.items()]


def _listed(checks: Sequence[str]) -> str:
    """Ids of checks, or how many they are where nobody would read them."""
    return ", ".join(dict.fromkeys(checks)) if len(checks) <= PLACES else f"{len(checks)} checks"


@dataclass(frozen=True, kw_only=True)
class FindingBlock:
    """Statement about a finding, or of several that say the same of different places; empty words are not shown."""

    findings: tuple[Finding, ...]
    severity: Severity
    title: str
    """Of the check."""
    cause: str
    facts: str
    """Where the first was found, in which configuration, what was measured, and the line of the file."""
    message: str
    also: str
    """Where else."""
    remedy: str
    follows: str
    """Which checks say what follows."""
    consequences: tuple[Finding, ...]
    code: str
    """Plain Python that shows it."""
    suppressed: str
    """Why it does not count."""


def block_of(group: Sequence[FindingGroup]) -> FindingBlock:
    """Return what is said of findings that were put into one group."""
    first = group[0].finding
    consequences = tuple(item for one in group for item in one.consequences)
    follows = follow_words(consequences)
    return FindingBlock(
        findings=tuple(item.finding for item in group),
        severity=first.severity,
        title=_titled(first.check, CHECKS[first.check].fails, *(item.finding.engine for item in group)),
        cause=f"(cause: {first.cause.value})",
        facts="; ".join(fact for fact in _facts(first) if fact),
        message=first.message,
        also=f"Also: {others}." if (others := _others(group)) else "",
        remedy=f"Remedy: {first.remedy}",
        follows=f"Follows from it: {follows}" if follows else "",
        consequences=consequences,
        code=first.reproduction or "",
        suppressed="" if first.suppressed is None else f"Suppressed, does not count: {first.suppressed}",
    )


def blocks(
    groups: Iterable[FindingGroup], *, together: int = 2, alike: bool = True, by_engine: bool = True
) -> list[FindingBlock]:
    """Return a block for all findings that differ in names and numbers only, in the order of the first of each.

    Args:
        groups: The findings.
        together: From so many on they share a block; fewer have one each.
        alike: False: all of one check, engine and severity that have a place share a block, whatever their words.
        by_engine: False: those that have a place share it in all engines.
    """
    grouped: dict[tuple[object, ...], list[FindingGroup]] = {}
    for item in groups:
        finding = item.finding
        engine = None if where(finding) and not by_engine else finding.engine
        key = (finding.check, engine, finding.severity, finding.cause, finding.suppressed)
        words = _pattern(finding) if alike or not where(finding) else ""
        grouped.setdefault((*key, words), []).append(item)
    apart = ([group] if len(group) >= together else [[item] for item in group] for group in grouped.values())
    return [block_of(group) for parted in apart for group in parted]


def places(block: FindingBlock) -> Table:
    """Where each finding of a block was seen, and what was measured there."""
    rows = [(where(item), configuration(item.q), measure(item), str(item.line or "")) for item in block.findings]
    return Table(headings=("where", "at", "measured", "line"), rows=rows)


def _facts(finding: Finding) -> tuple[str, ...]:
    at = configuration(finding.q)
    line = f"line {finding.line}" if finding.line is not None else ""
    return where(finding), f"at {at}" if at else "", measure(finding), line


def _others(group: Sequence[FindingGroup]) -> str:
    """Where else the same was found."""
    _, *others = dict.fromkeys(where(item.finding) for item in group)
    named = [place for place in others if place]
    more = len(named) - PLACES
    return "; ".join(named[:PLACES]) + (f" and {more} more" if more > 0 else "")


def _pattern(finding: Finding) -> str:
    """Message and remedy without the names and numbers of this finding."""
    text = f"{finding.message} {finding.remedy}"
    names = {finding.joint, finding.link, *(finding.pair or ()), *(finding.q or ())} - {None, ""}
    for name in sorted(map(str, names), key=len, reverse=True):
        text = re.sub(rf"(?<!\w){re.escape(name)}(?!\w)", "@", text)
    return _NUMBER.sub("#", text)
