"""Joint result of the checks of the untouched file over all engines that loaded it (KV8xx)."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES
from kinematify.validation.finding import Cause, Severity, Status

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.validation.finding import CheckResult, Finding

_FAMILY, _OPENS, _MOVES, _ENERGY = "KV8", "KV801", "KV804", "KV806"
_TENSORS = ("KV204", "KV205")
"""Checks of inertia tensors, for which engines refuse files."""


def as_loaded_words(checks: Sequence[CheckResult]) -> str:
    """Return how many joints move in the untouched file, by engine; empty if no engine was asked.

    A joint moves if a hand moves it over its free range and nothing throws it, e.g.
    ``as loaded: MuJoCo 5 of 5 joints move, PyBullet 5 of 5``. Every engine has its defaults; a second line names the
    flag of an engine with which fewer move.
    """
    opened = {check.engine: check for check in checks if check.check == _OPENS and check.engine is not None}
    moved = {check.engine: check for check in checks if check.check == _MOVES}
    parts = []
    for engine, opening in opened.items():
        title, found = ENGINES[engine].title, moved.get(engine)
        if "joints" not in opening.measured and opening.findings:
            parts.append(f"{title} does not open the file")
        elif found is not None and "right" in found.measured:
            joints = "" if parts and "joints move" in parts[0] else " joints move"
            parts.append(f"{title} {found.measured['right']:.0f} of {found.measured['joints']:.0f}{joints}")
        elif not ENGINES[engine].runs and "read" in opening.measured:
            parts.append(f"{title} reads {opening.measured['read']:.0f} of {opening.measured['joints']:.0f}")
        elif engine in DEFAULT_ENGINES:
            why = opening.reason or (found.reason if found is not None else None)
            parts.append(f"{title}: {why or 'its joints were not moved'}")
    absent = [f"{ENGINES[name].title} is not installed" for name in opened if name not in DEFAULT_ENGINES]
    words = [f"as loaded: {', '.join([*parts, *absent])}"] if parts else []
    for name, found in moved.items():
        entry = ENGINES[name or ""]
        if entry.contact_flag and found.measured.get("with_contacts", math.inf) < found.measured.get("right", 0.0):
            counted = f"{found.measured['with_contacts']:.0f} of {found.measured['joints']:.0f}"
            words.append(f"with {entry.contact_flag}: {entry.title} {counted}")
    return "\n".join(words)


def with_refusals(checks: Sequence[CheckResult]) -> list[CheckResult]:
    """Say of inertias for which an engine refuses the untouched file that it does; they are no mere notes then.

    Args:
        checks: All results.
    """
    refusals: dict[str, list[str]] = {}
    for check in checks:
        for finding in check.findings:
            if check.check == _OPENS and finding.link is not None:
                refusals.setdefault(finding.link, []).append(ENGINES[check.engine or ""].title)

    def worded(finding: Finding) -> Finding:
        engines = refusals.get(finding.link or "", [])
        if finding.check not in _TENSORS or not engines:
            return finding
        return replace(
            finding,
            severity=Severity.WARNING if finding.severity is Severity.NOTE else finding.severity,
            message=f"{finding.message} {' and '.join(engines)} refuses the file for it.",
        )

    found = [check.with_findings(map(worded, check.findings)) for check in checks]
    return [
        replace(check, status=Status.FAIL)
        if check.check in _TENSORS and any(item.severity is not Severity.NOTE for item in check.findings)
        else check
        for check in found
    ]


def across_engines(checks: Sequence[CheckResult], engines: Sequence[str], *, named: bool = True) -> list[CheckResult]:
    """Make errors of the untouched file warnings where another engine has none or did not finish, and say which.

    What is laid to an engine and only one shows is a note then, and a warning where no other engine runs the file.

    Args:
        checks: All results.
        engines: That were asked for. Where they are not the default ones a user has named them, and errors stay.
        named: False: the user named no engine, and what the only one shows is a warning.
    """
    if tuple(engines) != DEFAULT_ENGINES and named:
        return list(checks)
    ran: dict[str, set[str | None]] = {}
    late: dict[str, set[str | None]] = {}
    for check in checks:
        if check.status in (Status.PASS, Status.FAIL):
            ran.setdefault(check.check, set()).add(check.engine)
        elif check.unfinished:
            late.setdefault(check.check, set()).add(check.engine)
    errors = [
        finding
        for check in checks
        if check.check.startswith(_FAMILY)
        for finding in check.findings
        if finding.severity is Severity.ERROR
    ]
    return [
        check.with_findings(_across(finding, errors, ran, late, named=named) for finding in check.findings)
        if check.check.startswith(_FAMILY)
        else check
        for check in checks
    ]


def _across(
    finding: Finding,
    errors: Sequence[Finding],
    ran: Mapping[str, set[str | None]],
    late: Mapping[str, set[str | None]],
    *,
    named: bool,
) -> Finding:
    failing = {
        other.engine
        for other in errors
        if other.joint in (None, finding.joint) and (other.check == _ENERGY) <= (finding.check == _ENERGY)
    }
    works = [entry.title for name, entry in ENGINES.items() if name in ran.get(finding.check, set()) - failing]
    if finding.severity is not Severity.ERROR:
        return finding
    alone = finding.cause is Cause.ENGINE and not any(
        other.check == finding.check and other.engine != finding.engine for other in errors
    )
    unknown = [entry.title for name, entry in ENGINES.items() if name in late.get(finding.check, set())]
    if unknown and not works:
        message = f"{finding.message} {' and '.join(unknown)} did not finish."
        return replace(finding, severity=Severity.WARNING, message=message)
    if not (works or named):
        return replace(finding, severity=Severity.WARNING, message=f"{finding.message} No other engine was asked.")
    if not works:
        return replace(finding, severity=Severity.WARNING) if alone else finding
    return replace(
        finding,
        severity=Severity.NOTE if alone else Severity.WARNING,
        message=f"{finding.message} It works in {' and '.join(works)}.",
    )
