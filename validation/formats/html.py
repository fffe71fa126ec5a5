"""One HTML file that opens from disk: nothing is loaded from elsewhere, and without scripts all of it can be read."""

from __future__ import annotations

import base64
import json
import math
import struct
from typing import TYPE_CHECKING, Any

from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, Severity
from kinematify.validation.formats.html_frame import rendered
from kinematify.validation.formats.report_content import (
    block_of,
    check_table,
    family_table,
    joint_table,
    summary_words,
    title,
)
from kinematify.validation.run.report import Unusable, severity_counts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.validation.finding import Finding
    from kinematify.validation.run.report import Outcome, ValidationReport

_PNG_SIZES = slice(16, 24)
"""Where the first chunk of a PNG has width and height."""


def as_html(outcomes: Sequence[Outcome], pictures: Mapping[str, bytes], scenes: Mapping[str, str] | None = None) -> str:
    """Return the outcomes as a page.

    Args:
        outcomes: In the order of the models.
        pictures: PNG of a model, keyed by its path as given; may lack some.
        scenes: JSON of a model for the viewer in the page; likewise.
    """
    scenes = scenes or {}
    reports = [outcome for outcome in outcomes if not isinstance(outcome, Unusable)]
    findings = [finding for report in reports for finding in report.findings]
    return rendered(
        "report.html",
        title=f"kinematify validate: {_headline(outcomes)}",
        scripts=("viewer.js",) if scenes else (),
        models=[
            _model(index, outcome, pictures.get(outcome.model, b""), scenes.get(outcome.model, ""))
            for index, outcome in enumerate(outcomes)
        ],
        severities=[item.value for item in Severity if any(finding.severity is item for finding in findings)],
        causes=[item.value for item in Cause if any(finding.cause is item for finding in findings)],
        explained=[CHECKS[name] for name in sorted({finding.check for finding in findings})],
        title_of=title,
    )


def _headline(outcomes: Sequence[Outcome]) -> str:
    if len(outcomes) == 1:
        return f"{outcomes[0].verdict}, {outcomes[0].model}"
    failed = sum(outcome.verdict in ("fail", "unusable") for outcome in outcomes)
    return f"{len(outcomes)} models, {failed} of them not good"


def _model(index: int, outcome: Outcome, picture: bytes, scene: str) -> dict[str, Any]:
    """Facts of one model that the page shows."""
    if isinstance(outcome, Unusable):
        return {"index": index, "outcome": outcome, "unusable": True, "counts": ("", "", "")}
    counts = severity_counts(outcome)
    return {
        "index": index,
        "outcome": outcome,
        "unusable": False,
        "counts": [counts.get(severity, 0) for severity in Severity],
        "summary": summary_words(outcome),
        "blocks": [(block_of([item]), _shown(outcome, item.finding) if scene else "") for item in outcome.groups],
        "scene": scene.replace("<", "\\u003c"),  # a name must not be able to end the script
        "sliders": [joint for joint in json.loads(scene)["joints"] if joint["mimic"] is None] if scene else [],
        "picture": base64.b64encode(picture).decode("ascii"),
        "extent": struct.unpack(">II", picture[_PNG_SIZES]) if len(picture) >= _PNG_SIZES.stop else None,
        "families": family_table(outcome),
        "joints": joint_table(outcome),
        "checks": check_table(outcome),
        "environment": json.dumps(outcome.as_json()["environment"], indent=2),
    }


def _shown(report: ValidationReport, finding: Finding) -> str:
    """Where a finding was seen, as the viewer takes it; empty if it names no place."""
    links = [*(finding.pair or ()), *([finding.link] if finding.link else [])]
    joints = {joint.joint for joint in report.joints}
    joint = finding.joint if finding.joint in joints and not links else None
    q = {name: value for name, value in (finding.q or {}).items() if name in joints and math.isfinite(value)}
    return _place(q, links, joint) if links or q or joint else ""


def _place(q: Mapping[str, float], links: Iterable[str], joint: str | None = None) -> str:
    """Return a configuration, and links or what a joint moves, which the viewer marks, as JSON."""
    return json.dumps({"q": q, "links": list(links), "joint": joint})
