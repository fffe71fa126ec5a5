"""The answer of `kinematify validate`: every check with its status, every finding, a verdict, and lines of models."""

from __future__ import annotations

import json
import math
import platform
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from kinematify import __version__
from kinematify.errors import ExitStatus
from kinematify.robot.arrays import json_values
from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Severity, Status
from kinematify.validation.run.conclusion import group_by_cause
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config.validation import ValidationSettings
    from kinematify.validation.finding import CheckResult, Finding, JointSummary
    from kinematify.validation.run.conclusion import FindingGroup

SCHEMA = 2
_Z = 1.96
"""Of an interval of 95 %."""
_OPENS, _MOVES = "KV801", "KV804"
CONTRACT, ISAAC = "KV82", "KV113"
"""Begin of the ids of the contract for objects, and id of what Isaac Sim makes of a file: both run when asked for."""
_PACKAGES = (
    "numpy", "scipy", "trimesh", "libigl", "python-fcl", "mujoco", "pybullet", "pin",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class ValidationReport:
    """The result for one model."""

    model: str
    """Path as it was given."""
    checks: tuple[CheckResult[Finding], ...]
    joints: tuple[JointSummary, ...] = ()
    environment: Mapping[str, Any] = field(default_factory=dict)
    """Versions, seed, settings, seconds, and ``interrupted`` if it is partial."""

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All findings, the worst first, otherwise in the order of the checks."""
        order = list(Severity)
        found = [finding for check in self.checks for finding in check.findings]
        return tuple(sorted(found, key=lambda finding: order.index(finding.severity)))

    @property
    def counted(self) -> tuple[Finding, ...]:
        """Findings that are not suppressed."""
        return tuple(finding for finding in self.findings if finding.suppressed is None)

    @property
    def groups(self) -> tuple[FindingGroup, ...]:
        """Findings that follow from no other, the worst first, each with what follows from it."""
        return group_by_cause(self.findings)

    @property
    def verdict(self) -> str:
        """``fail`` with an error, ``warn`` with a warning, else ``pass``; suppressed findings do not count."""
        severities = {finding.severity for finding in self.counted}
        if Severity.ERROR in severities:
            return "fail"
        return "warn" if Severity.WARNING in severities else "pass"

    @property
    def interrupted(self) -> bool:
        """Ctrl-C ended the run: the report is partial."""
        return bool(self.environment.get("interrupted"))

    @property
    def unfinished(self) -> tuple[CheckResult[Finding], ...]:
        """Checks that time ran out for."""
        return tuple(check for check in self.checks if check.unfinished)

    @property
    def as_loaded(self) -> str:
        """Return how many joints move in the untouched file, by engine; empty if no engine loaded it."""
        return as_loaded_words(self.checks)

    @property
    def exit_status(self) -> int:
        """1 with an error, else 3 if a check was not finished, else 0."""
        return self.status_at(Severity.ERROR)

    def status_at(self, least: Severity) -> int:
        """1 with a finding of at least a severity, else 3 if a check was not finished, else 0."""
        order = list(Severity)
        if any(order.index(finding.severity) <= order.index(least) for finding in self.counted):
            return ExitStatus.FAILURES
        return ExitStatus.FAULT if self.unfinished else ExitStatus.FINE

    def as_json(self) -> dict[str, Any]:
        """The report as JSON values (schema 2); absent values and non-finite numbers are null."""
        return {
            "schema": SCHEMA,
            "model": self.model,
            "verdict": self.verdict,
            "as_loaded": self.as_loaded or None,
            "checks": [_check_json(check) for check in self.checks],
            "findings": self._findings_json(),
            "joints": [_joint_json(joint) for joint in self.joints],
            "environment": json_values(self.environment),
        }

    def _findings_json(self) -> list[dict[str, Any]]:
        place = {id(finding): number for number, finding in enumerate(self.findings)}
        return [
            json_values(
                vars(item)
                | {"severity": str(item.severity), "cause": str(item.cause)}
                | {"follows_from": place.get(id(item.follows_from))}
            )
            for item in self.findings
        ]


def _check_json(check: CheckResult[Finding]) -> dict[str, Any]:
    return {
        "check": check.check,
        "title": CHECKS[check.check].fails if check.status is Status.FAIL else CHECKS[check.check].title,
        "engine": check.engine,
        "status": check.status.value,
        "reason": check.reason,
        "seconds": round(check.seconds, 4),
        "measured": json_values(check.measured),
    }


def _joint_json(joint: JointSummary) -> dict[str, Any]:
    facts = json_values(joint)
    return {"joint": facts.pop("joint"), "type": facts.pop("kind"), **facts}


def environment(settings: ValidationSettings, *, seconds: float, interrupted: bool) -> dict[str, Any]:
    """Versions, machine, seed, settings and time of a run."""
    return {
        "kinematify": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "versions": package_versions(_PACKAGES),
        "seed": settings.seed,
        "seconds": round(seconds, 3),
        "interrupted": interrupted,
        "settings": settings.model_dump(),
    }


def as_loaded_words(checks: Sequence[CheckResult[Finding]]) -> str:
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


def contract_words(reports: Sequence[Sequence[CheckResult[Finding]]]) -> str:
    """Return how many of some models keep the contract, with Wilson's interval of 95 %; empty if it was not asked for.

    Args:
        reports: All results of each model.
    """
    asked = [{check.status for check in checks if check.check.startswith(CONTRACT)} for checks in reports]
    order = {Status.FAIL: "failed", Status.BLOCKED: "blocked", Status.PASS: "kept", Status.SKIPPED: "not applicable"}
    states = [next(name for status, name in order.items() if status in found) for found in asked if found]
    if not states:
        return ""
    if len(states) == 1:
        return f"contract: {states[0]}"
    kept, count = states.count("kept"), states.count("kept") + states.count("failed")
    others = ", ".join(f"{name} {states.count(name)}" for name in ("blocked", "not applicable"))
    share, part = kept / max(count, 1), _Z**2 / max(count, 1)
    spread = math.sqrt(part * share * (1.0 - share) + part**2 / 4.0)
    low, high = ((share + part / 2.0 + sign * spread) / (1.0 + part) for sign in (-1, 1))
    return f"contract: kept by {kept} of {count} ({share:.0%}, 95 % interval {low:.0%} to {high:.0%}); {others}"


@dataclass(frozen=True, kw_only=True)
class Unusable:
    """A file that is no URDF at all."""

    model: str
    """Path as it was given."""
    message: str
    """What was found and what to do, one paragraph."""

    interrupted = False
    """Always."""

    @property
    def verdict(self) -> str:
        """Always ``unusable``."""
        return "unusable"

    @property
    def exit_status(self) -> int:
        """Always 2."""
        return ExitStatus.UNUSABLE

    def status_at(self, least: Severity) -> int:
        """Always 2, whatever the least severity is that counts."""
        del least
        return self.exit_status

    def as_json(self) -> dict[str, Any]:
        """The same keys as a report's, with the reason under ``error``."""
        return {"schema": SCHEMA, "model": self.model, "verdict": self.verdict, "error": self.message}


Outcome = ValidationReport | Unusable


def severity_counts(report: ValidationReport) -> Mapping[Severity, int]:
    """Findings that count, by severity; what follows from another one does not count beside it."""
    return Counter(finding.severity for finding in report.counted if finding.follows_from is None)


def status_counts(report: ValidationReport) -> Mapping[Status, int]:
    """Checks by status; a check in two engines counts twice."""
    return Counter(check.status for check in report.checks)


def counted_words(count: int, noun: str) -> str:
    """``1 error``, ``2 errors``, ``no errors``."""
    return f"{count or 'no'} {noun}{'' if count == 1 else 's'}"


def as_json_text(outcomes: Sequence[Outcome]) -> str:
    """Return the outcomes as text: indented if there is one, else a line each, in the order of the models."""
    if len(outcomes) == 1:
        return json.dumps(outcomes[0].as_json(), indent=2, allow_nan=False) + "\n"
    return "".join(json.dumps(outcome.as_json(), allow_nan=False) + "\n" for outcome in outcomes)
