"""Outcome of each model of a run over several: a report, or the reason why there is none."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kinematify.errors import ExitStatus
from kinematify.validation.finding import Severity, Status
from kinematify.validation.run.report import SCHEMA, ValidationReport

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


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
