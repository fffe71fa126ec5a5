"""SARIF 2.1.0 as GitHub code scanning and editors read it: rules from the registry of checks, a result per finding."""

from __future__ import annotations

import hashlib
import json
import linecache
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from kinematify import __version__
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.report_content import (
    configuration,
    follow_words,
    measure,
    printable,
    title,
    where,
)
from kinematify.validation.run.report import Unusable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.check import Check
    from kinematify.validation.finding import Finding
    from kinematify.validation.run.conclusion import FindingGroup
    from kinematify.validation.run.report import Outcome, ValidationReport

SARIF_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "note"}
_UNUSABLE = "unusable-input"


def as_sarif(outcomes: Sequence[Outcome]) -> str:
    """Return the outcomes as one SARIF run."""
    reports = [outcome for outcome in outcomes if not isinstance(outcome, Unusable)]
    fired = dict.fromkeys(finding.check for report in reports for finding in report.findings)
    run = {
        "tool": {"driver": _driver([CHECKS[check] for check in fired])},
        "invocations": [_invocation(outcomes)],
        "results": [_result(report, group) for report in reports for group in report.groups],
    }
    document = {"$schema": SARIF_SCHEMA, "version": "2.1.0", "runs": [run]}
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def _driver(fired: Sequence[Check]) -> dict[str, Any]:
    return {
        "name": "kinematify validate",
        "version": __version__,
        "rules": [_rule(check) for check in fired],
    }


def _rule(check: Check) -> dict[str, Any]:
    plain = f"{check.verifies}\n\nWhy it matters: {check.matters}\n\nRemedy: {check.remedy}"
    marked = f"{check.verifies}\n\n**Why it matters:** {check.matters}\n\n**Remedy:** {check.remedy}"
    return {
        "id": check.id,
        "shortDescription": {"text": check.fails},
        "fullDescription": {"text": check.verifies},
        "help": {"text": plain, "markdown": marked},
        "defaultConfiguration": {"level": _LEVELS[check.severity]},
    }


def _result(report: ValidationReport, group: FindingGroup) -> dict[str, Any]:
    finding, follows = group.finding, follow_words(group.consequences)
    about = [part for part in (where(finding), configuration(finding.q), measure(finding)) if part]
    more = [*([f"({'; '.join(about)})"] if about else []), finding.remedy]
    text = printable(" ".join([finding.message, *more, *([f"Follows from it: {follows}."] if follows else [])]))
    result: dict[str, Any] = {
        "ruleId": finding.check,
        "level": _LEVELS[finding.severity],
        "message": {"text": text},
        "locations": [_location(report.model, finding)],
        "partialFingerprints": {"kinematify/v1": _fingerprint(finding)},
    }
    if finding.suppressed is not None:
        result["suppressions"] = [{"kind": "external", "justification": printable(finding.suppressed)}]
    return result


def _location(model: str, finding: Finding) -> dict[str, Any]:
    # Code scanning shows a result at a line only; what is about the whole model stands at the first.
    line = max(finding.line or 1, 1)
    text = "" if "\0" in model else linecache.getline(model, line)
    region = {"startLine": line, "startColumn": len(text) - len(text.lstrip()) + 1}
    return {"physicalLocation": {"artifactLocation": {"uri": _uri(model)}, "region": region}}


def _uri(model: str) -> str:
    """Relative to the folder of the call where the file lies below it, as code scanning wants, else absolute."""
    path = os.path.abspath(model)  # noqa: PTH100 - a link stays the file that the repository knows
    below = Path(path).is_relative_to(Path.cwd())
    relative = Path(path).relative_to(Path.cwd()).as_posix() if below else path
    quoted = quote(relative.encode("utf-8", "surrogateescape"))
    return quoted if below else f"file://{quoted}"


def _fingerprint(finding: Finding) -> str:
    """The same for the same fault in the next run, whatever the numbers and lines are then."""
    names = (finding.check, finding.engine, finding.joint, finding.link, *(finding.pair or ()))
    return hashlib.sha256(repr(names).encode("utf-8", "backslashreplace")).hexdigest()[:32]


def _invocation(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    notes = []
    for outcome in outcomes:
        if isinstance(outcome, Unusable):
            notes.append(_notification(outcome.model, _UNUSABLE, "error", outcome.message))
            continue
        notes += [
            _notification(outcome.model, check.status.value, "note", f"{title(check)}: {check.reason}")
            for check in outcome.checks
            if check.status in (Status.SKIPPED, Status.BLOCKED)
        ]
    successful = not any(isinstance(o, Unusable) or o.interrupted for o in outcomes)
    return {"executionSuccessful": successful, "toolExecutionNotifications": notes}


def _notification(model: str, name: str, level: str, text: str) -> dict[str, Any]:
    return {
        "descriptor": {"id": name},
        "level": level,
        "message": {"text": printable(text)},
        "locations": [{"physicalLocation": {"artifactLocation": {"uri": _uri(model)}}}],
    }
