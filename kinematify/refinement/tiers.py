"""The dear tiers: finalists are written, validated in engines, and pulled by an arm."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.manipulation.request import PULL, TaskRequest
from kinematify.model.urdf import write_urdf
from kinematify.refinement.simulate import MotionVerdict
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from kinematify.config.validation import ValidationSettings
    from kinematify.refinement.plan import Plan
    from kinematify.validation.report import ValidationReport

GEOMETRY, ENGINES, TASK = "geometry", "engines", "task"
TIERS = (GEOMETRY, ENGINES, TASK)
"""From cheap to dear; each includes those before it."""

_TRIED = " tried"
"""After the name of a joint, in what KV705 measures."""
_OWN = ("KV30", "KV31", "KV32")
"""Checks that the cheap tier has told already."""


def dear_verdict(plan: Plan, cheap: MotionVerdict, *, tier: str, settings: ValidationSettings) -> MotionVerdict:
    """Validate a plan in engines, and with a task if the tier asks for it.

    Args:
        plan: The finalist.
        cheap: What the exact geometry says of it.
        tier: ``engines`` or ``task``.
        settings: Of the validation.
    """
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        urdf = write_urdf(plan.model, Path(folder))
        report = validate(urdf, settings=settings, task=TaskRequest(kind=PULL) if tier == TASK else None)
    told = tuple(finding for finding in report.counted if not finding.check.startswith(_OWN))
    if report.environment.get("interrupted"):
        raise KeyboardInterrupt
    return MotionVerdict(
        findings=(*cheap.findings, *told),
        joints=cheap.joints,
        placements=_placements(report),
    )


def _placements(report: ValidationReport) -> dict[str, float]:
    """How many places of the robot were tried for each joint."""
    measured = next((check.measured for check in report.checks if check.check == "KV705"), {})
    return {name.removesuffix(_TRIED): value for name, value in measured.items() if name.endswith(_TRIED)}
