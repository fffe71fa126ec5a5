"""What does `kinematify validate` say of models that nobody planted a fault in?

All checks, models as they are: those of the benchmark, and URDFs that PyBullet's data package ships. Most of the
benchmark's have neither mass nor collision geometry, which KV201 and KV240 warn of. What the errors mean, one by one,
stands in docs/validate.md.
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING

import pybullet_data
from pydantic import Field

from kinematify.evaluation.datasets import find_objects
from kinematify.evaluation.record import grouped, table
from kinematify.evaluation.study import Options, Study, explained
from kinematify.validation.finding import Severity, Status
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from kinematify.evaluation.record import Report
    from kinematify.evaluation.study import Measured, Record, Work

SHIPPED = (
    "a1/a1", "aliengo/aliengo", "bicycle/bike", "biped/biped2d_pybullet", "cartpole", "differential/diff_ring",
    "franka_panda/panda", "humanoid/humanoid", "husky/husky", "kuka_iiwa/model", "kuka_iiwa/model_vr_limits",
    "laikago/laikago", "laikago/laikago_toes_limits", "mini_cheetah/mini_cheetah", "pendulum5", "pr2_gripper",
    "quadruped/minitaur", "quadruped/quadruped", "quadruped/spirit40", "quadruped/vision60", "r2d2", "racecar/racecar",
    "xarm/xarm6_robot", "xarm/xarm6_with_gripper",
)  # fmt: skip
"""Articulated models of the package pybullet_data, without ``.urdf``."""


class PublishedOptions(Options):
    """Which models."""

    data: str | None = Field(None, description="Folder or set of models; the benchmark's if not given.")


@dataclass(frozen=True, kw_only=True)
class Published:
    """One model."""

    model: str
    source: str
    urdf: Path


def measure(options: PublishedOptions, work: Work) -> Measured:
    """Validate one model after the other, for the times."""
    models = [Published(model=item.name, source="benchmark", urdf=item.urdf) for item in find_objects(options.data)]
    folder = Path(pybullet_data.getDataPath())
    models += [Published(model=name, source="pybullet_data", urdf=folder / f"{name}.urdf") for name in SHIPPED]
    return list(work.each(verdict_on, {model.model: model for model in models}, workers=1).values()), {}


def verdict_on(model: Published) -> Record:
    """Validate one model: errors with the joint, link or pair that they name, and the number of warnings by check."""
    start = time.perf_counter()
    report = validate(model.urdf)
    errors = [finding for finding in report.findings if finding.severity is Severity.ERROR]
    warnings = Counter(finding.check for finding in report.findings if finding.severity is Severity.WARNING)
    return {
        "model": model.model,
        "source": model.source,
        "seconds": round(time.perf_counter() - start, 1),
        "errors": [[item.check, item.joint or item.link or " and ".join(item.pair or ())] for item in errors],
        "warnings": dict(sorted(warnings.items())),
        "blocked": sum(check.status is Status.BLOCKED for check in report.checks),
    }


def report(found: Report[Record]) -> list[str]:
    """One line per model."""
    blocks = [explained(__doc__)]
    for source, records in grouped(found.records, by=itemgetter("source")).items():
        wrong = sum(bool(record["errors"]) for record in records)
        blocks += [
            f"## {source}: {wrong} of {len(records)} models with errors",
            table(("model", "time [s]", "errors", "warnings", "checks that a fault blocks"), map(_row, records)),
        ]
    return blocks


def _row(record: Record) -> tuple[str, ...]:
    counts = Counter(check for check, _ in record["errors"])
    errors = ", ".join(
        f"{check} ({'; '.join(place for name, place in record['errors'] if name == check) if count < 4 else count})"
        for check, count in counts.items()
    )
    warnings = ", ".join(f"{check} x {count}" if count > 1 else check for check, count in record["warnings"].items())
    return record["model"], str(record["seconds"]), errors, warnings, str(record["blocked"] or "")


STUDY = Study(
    title="What `kinematify validate` says of published models",
    options=PublishedOptions,
    measure=measure,
    report=report,
)
