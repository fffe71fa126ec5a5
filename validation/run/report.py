"""The answer of `kinematify validate`: every check with its status, every finding, and a verdict."""

from __future__ import annotations

import platform
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from kinematify import __version__
from kinematify.errors import ExitStatus
from kinematify.robot.arrays import json_values
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Severity, Status
from kinematify.validation.run.conclusion import group_by_cause
from kinematify.validation.run.loaded_words import as_loaded_words
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.config.validation import ValidationSettings
    from kinematify.validation.finding import CheckResult, Finding
    from kinematify.validation.run.conclusion import FindingGroup
    from kinematify.validation.summary import JointSummary

SCHEMA = 2
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
            _finding_json(finding)
            | {"follows_from": None if finding.follows_from is None else place[id(finding.follows_from)]}
            for finding in self.findings
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


def _finding_json(finding: Finding) -> dict[str, Any]:
    return {
        "check": finding.check,
        "severity": finding.severity.value,
        "cause": finding.cause.value,
        "joint": finding.joint,
        "link": finding.link,
        "pair": None if finding.pair is None else list(finding.pair),
        "engine": finding.engine,
        "q": json_values(finding.q),
        "value": json_values(finding.value),
        "limit": json_values(finding.limit),
        "unit": finding.unit,
        "message": finding.message,
        "remedy": finding.remedy,
        "line": finding.line,
        "reproduction": finding.reproduction,
        "suppressed": finding.suppressed,
    }


def _joint_json(joint: JointSummary) -> dict[str, Any]:
    return {
        "joint": joint.joint,
        "type": joint.kind,
        "declared_limits": json_values(joint.declared_limits),
        "free_travel": json_values(joint.free_travel),
        "best_alternative": json_values(joint.best_alternative),
    }


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
