"""Words and numbers of findings as people read them; shared by all formats and the terminal."""

from __future__ import annotations

import math
import re
from collections import Counter
from typing import TYPE_CHECKING, Any

from kinematify.validation.check import FAMILIES
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Finding, Status

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from kinematify.validation.finding import CheckResult
    from kinematify.validation.report import ValidationReport
    from kinematify.validation.summary import JointSummary

SHOWN_JOINTS = 4
"""A configuration is shortened to the joints that are farthest from zero."""
FAMILY_HEADINGS = ("family", "engine", *(status.value for status in Status), "seconds")
"""Headings of `family_rows`."""
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
    """What was measured against its limit, with the unit; empty if nothing was."""
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


JOINT_HEADINGS = ("joint", "type", "declared limits", "free travel", "better alternative")
"""Headings of `joint_rows`."""


def joint_rows(report: ValidationReport) -> list[tuple[str, ...]]:
    """A row per joint with its ranges and what would explain the geometry better."""
    return [
        (
            joint.joint,
            joint.kind,
            joint_range(joint, joint.declared_limits),
            joint_range(joint, joint.free_travel),
            alternative(joint),
        )
        for joint in report.joints
    ]


NEXT_BEST_HEADINGS = ("joint", "next best by the inference", "from")
"""Headings of `next_best_rows`."""


def next_best_rows(report: ValidationReport) -> list[tuple[str, ...]]:
    """What the inference would have chosen next for every joint that failed, best first."""
    return [
        (joint.joint, _candidate(candidate), str(candidate.get("source", "")))
        for joint in report.joints
        for candidate in joint.next_best
    ]


def alternative(joint: JointSummary) -> str:
    """The joint that would explain the geometry better, in a few words; a dash if there is none."""
    better = joint.best_alternative
    return _candidate(better) if better else "-"


def _candidate(better: Mapping[str, Any]) -> str:
    places = [
        f"{key} ({', '.join(number(float(item)) for item in better[key])})"
        for key in ("axis", "pivot")
        if better.get(key) is not None
    ]
    kind = [str(better["kind"])] if better.get("kind") else []
    score = [f"score {number(float(better['score']))}"] if better.get("score") is not None else []
    return ", ".join([*kind, *places, *score])


def figures(check: CheckResult) -> str:
    """What a check measured, by name."""
    return ", ".join(f"{name} {number(float(value))}" for name, value in check.measured.items())


def family_rows(report: ValidationReport) -> list[tuple[str, ...]]:
    """Cells of the table of families: title, engine, a count for each status, seconds."""
    groups: dict[tuple[str, str], list[CheckResult]] = {}
    for check in report.checks:
        groups.setdefault((check.check[:3], check.engine or "-"), []).append(check)
    return [
        (
            f"{prefix} {FAMILIES[prefix]}",
            engine,
            *(str(sum(check.status is status for check in checks)) for status in Status),
            f"{sum(check.seconds for check in checks):.2f}",
        )
        for (prefix, engine), checks in sorted(groups.items())
    ]


def title(told: CheckResult | Finding) -> str:
    """Id, title and engine of a check: what is wrong of a finding or a check that failed, else what should be."""
    failed = isinstance(told, Finding) or told.status is Status.FAIL
    return _titled(told, CHECKS[told.check].fails) if failed else lasting_title(told)


def follow_words(consequences: Iterable[Finding]) -> str:
    """Which checks say what follows from a finding, in which engine and how often; empty if none does."""
    counts = Counter((item.check, item.engine) for item in consequences)
    return ", ".join(
        f"{check}{f' [{engine}]' if engine else ''}{f' {count} times' if count > 1 else ''}"
        for (check, engine), count in counts.items()
    )


def lasting_title(told: CheckResult | Finding) -> str:
    """Id, title and engine of a check, the same whatever became of it: names by which machines follow it over time."""
    return _titled(told, CHECKS[told.check].title)


def _titled(told: CheckResult | Finding, title: str) -> str:
    return f"{told.check} {title}{f' [{told.engine}]' if told.engine else ''}"


def family(check: str) -> str:
    """Title of the family of an id."""
    return FAMILIES[check[:3]]
