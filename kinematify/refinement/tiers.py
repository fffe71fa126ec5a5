"""The dear tiers: a plan is written as a model folder has it, run in engines, and pulled at by an arm."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.manipulation.request import PULL, TaskRequest
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model
from kinematify.refinement.simulate import MotionVerdict
from kinematify.validation.checks import checks_of
from kinematify.validation.failure_rates import ENGINES, GEOMETRY, TASK
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from kinematify.config.validation import ValidationSettings
    from kinematify.refinement.plan import Plan
    from kinematify.validation.report import ValidationReport

TIERS = (GEOMETRY, ENGINES, TASK)
"""From cheap to dear; each includes those before it."""

_TRIED = " tried"
"""After the name of a joint, in what KV705 measures."""
_RUN = {ENGINES: ("KV34", "KV4", "KV5", "KV8"), TASK: ("KV34", "KV4", "KV5", "KV7", "KV8")}
"""Families of checks that a dear tier runs beside those of geometry, which the cheap tier has told already.

What the inference itself holds of the shapes is left out: its scores have said that.
"""


def dear_verdict(plan: Plan, cheap: MotionVerdict, *, tier: str, settings: ValidationSettings) -> MotionVerdict:
    """Run a plan as it would be written, in engines, and with a task if the tier asks for it.

    Args:
        plan: The finalist.
        cheap: What the exact geometry says of it.
        tier: ``engines`` or ``task``.
        settings: Of the validation.
    """
    selected = [check.id for check in checks_of(*_RUN[tier]) if not check.opinion]
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        urdf = write_model(simulable_model(plan.model, plan.config).robot, Path(folder))
        task = TaskRequest(kind=PULL) if tier == TASK else None
        report = validate(urdf, settings=settings, selected=selected, task=task)
    if report.environment.get("interrupted"):
        raise KeyboardInterrupt
    told = tuple(finding for finding in report.counted if finding.check in selected)
    return MotionVerdict(
        findings=(*cheap.findings, *told),
        joints=cheap.joints,
        placements=_placements(report),
    )


def _placements(report: ValidationReport) -> dict[str, float]:
    """How many places of the robot were tried for each joint."""
    measured = next((check.measured for check in report.checks if check.check == "KV705"), {})
    return {name.removesuffix(_TRIED): value for name, value in measured.items() if name.endswith(_TRIED)}
