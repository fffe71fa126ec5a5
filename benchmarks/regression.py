"""Which numbers became worse since an earlier report."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.evaluation.benchmark_summary import Summary, summarise

if TYPE_CHECKING:
    from kinematify.evaluation.benchmark_job import JobResult
    from kinematify.evaluation.result_record import Report

    Group = tuple[list[JobResult], list[JobResult]]


@dataclass(frozen=True, kw_only=True)
class Regression:
    """One mean that became worse."""

    variant: str
    kind: str
    """Kind of the objects that the mean is over."""
    metric: str
    before: float
    now: float
    unit: str

    @property
    def sentence(self) -> str:
        """For the terminal."""
        change = f"{self.metric} went from {self.before:.4g} to {self.now:.4g} {self.unit}".rstrip()
        return f"Worse than the baseline: {change} ({self.kind} objects, configuration {self.variant})."


_SLACK = {
    "angle_deg": (0.01, "deg"),
    "line_m": (1.0e-5, "m"),
    "ted": (0.005, ""),
    "types": (-0.001, "of 1"),
    "root": (-0.001, "of 1"),
    "limit_iou": (-0.005, "of 1"),
    "opens": (-0.005, "of 1"),
}
"""Metric -> change for the worse that is still no regression, half of what the tables print; negative where more is
better. The inference is deterministic, so that this only has to cover other versions of numeric libraries."""


def find_regressions(report: Report[JobResult], baseline: Report[JobResult]) -> tuple[Regression, ...]:
    """Compare means over the runs that both reports hold, per configuration and kind of object.

    Times are omitted: they depend on the machine.

    Args:
        report: The run to judge.
        baseline: The earlier one.
    """
    return tuple(
        regression
        for (variant, kind), (old, new) in _common_runs(report, baseline).items()
        for regression in _worse_means(variant, kind, summarise(old), summarise(new))
    )


def _common_runs(report: Report[JobResult], baseline: Report[JobResult]) -> dict[tuple[str, str], Group]:
    before = {(result.object, result.condition, result.variant): result for result in baseline.records}
    groups: dict[tuple[str, str], Group] = defaultdict(lambda: ([], []))
    for result in report.records:
        earlier = before.get((result.object, result.condition, result.variant))
        if earlier is not None:
            old, new = groups[result.variant, result.kind]
            old.append(earlier)
            new.append(result)
    return groups


def _worse_means(variant: str, kind: str, old: Summary, new: Summary) -> list[Regression]:
    found = []
    for metric, (slack, unit) in _SLACK.items():
        before, now = old.values.get(metric), new.values.get(metric)
        if before is not None and now is not None and (now - before) / slack > 1.0:
            found.append(Regression(variant=variant, kind=kind, metric=metric, before=before, now=now, unit=unit))
    return found
