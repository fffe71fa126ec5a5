"""The dear tiers: a plan is written as a model folder has it, run in engines, and pulled at by an arm."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.manipulation.request import PULL, TaskRequest
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model
from kinematify.validation.check import FeedbackRow
from kinematify.validation.checks import checks_of
from kinematify.validation.failure_rates import ENGINES, GEOMETRY, TASK
from kinematify.validation.finding import Severity
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from kinematify.config.validation import ValidationSettings
    from kinematify.refinement.plan import Plan
    from kinematify.refinement.simulate import MotionVerdict
    from kinematify.validation.report import ValidationReport

TIERS = (GEOMETRY, ENGINES, TASK)
"""From cheap to dear; each includes those before it."""

_TRIED = " tried"
"""After the name of a joint, in what KV705 measures."""
_RUN = {
    ENGINES: [
        check.id for check in checks_of("KV4", "KV5", "KV8") if check.feedback not in (None, FeedbackRow.EXPORTER)
    ],
    TASK: [check.id for check in checks_of("KV7") if check.severity is not Severity.NOTE],
}
"""Checks that a dear tier runs beside those of the tiers before it: whose findings change what is chosen.

What geometry holds of the shapes at rest (KV34x) is left out: the scores of the inference have said that.
"""


@dataclass(kw_only=True, eq=False)
class DearTiers:
    """Runs plans of one assembly in engines and tasks, each once."""

    settings: ValidationSettings
    _reports: dict[tuple[object, ...], ValidationReport] = field(default_factory=dict)

    def deepened(self, verdict: MotionVerdict, plan: Plan, tier: str) -> MotionVerdict:
        """What all tiers up to a dear one say of a plan.

        Args:
            verdict: What the exact geometry says of it.
            plan: The finalist.
            tier: ``engines`` or ``task``.
        """
        for dear in TIERS[1 : TIERS.index(tier) + 1]:
            report = self._report(plan, dear)
            told = tuple(finding for finding in report.counted if finding.check in _RUN[dear])
            verdict = replace(
                verdict, findings=(*verdict.findings, *told), placements={**verdict.placements, **_placements(report)}
            )
        return verdict

    def _report(self, plan: Plan, tier: str) -> ValidationReport:
        """What one dear tier says of a plan."""
        key = (tier, *plan.signature)
        if key not in self._reports:
            with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
                urdf = write_model(simulable_model(plan.model, plan.config).robot, Path(folder))
                task = TaskRequest(kind=PULL) if tier == TASK else None
                report = validate(urdf, settings=self.settings, selected=_RUN[tier], task=task)
            if report.environment.get("interrupted"):
                raise KeyboardInterrupt
            self._reports[key] = report
        return self._reports[key]


def _placements(report: ValidationReport) -> dict[str, float]:
    """How many places of the robot were tried for each joint."""
    measured = next((check.measured for check in report.checks if check.check == "KV705"), {})
    return {name.removesuffix(_TRIED): value for name, value in measured.items() if name.endswith(_TRIED)}
