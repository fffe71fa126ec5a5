"""Does a broken file break `kinematify validate`?

Valid models are corrupted, one way at a time. *Passes* and *fails* are reports (exit status 0 and 1, written in every
format), *no URDF* is a refusal with a remedy (exit status 2); all else is a defect.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field

from benchmarks.corruption.bases import all_bases
from benchmarks.corruption.cases import KINDS, READY, CorruptionTask, run_case
from benchmarks.study import Options, Study, explained
from kinematify.evaluation.record import table
from kinematify.validation.checks import CHECKS

if TYPE_CHECKING:
    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.record import Report
    from kinematify.processes.pool import TaskFailure

BAD = ("crash", "timeout", "error")
_PATIENCE = 12.0
"""Time on the clock over the budget, which is processor time of each stage, after which a run hangs; a stage of it is
stopped after ten."""


class RobustnessOptions(Options):
    """Which corruptions."""

    data: str | None = Field(None, description="Folder or set of models; the benchmark's if not given.")
    count: int = Field(2000, ge=1, description="Corrupted models.")
    cases: tuple[int, ...] = Field((), description="Numbers of single cases to run instead, separated by commas.")
    seed: int = Field(0, description="Draws the corruptions.")
    seconds: float = Field(60.0, gt=0.0, description="Time budget of one validation.")
    checks: tuple[str, ...] = Field(("KV",), description="Beginnings of the ids of checks, separated by commas.")


def measure(options: RobustnessOptions, work: Work) -> Measured:
    """Validate every corrupted model."""
    bases = tuple(all_bases(work.folder / "bases", options.data))
    selected = tuple(check for check in CHECKS if check.startswith(options.checks))
    wanted = options.cases or tuple(range(options.count))
    asked = {
        str(number): CorruptionTask(
            number=number, seed=options.seed, bases=bases, seconds=options.seconds, selected=selected
        )
        for number in wanted
    }

    def failed(name: str, failure: TaskFailure) -> Record:
        facts = {"number": int(name), "kind": KINDS[int(name) % len(KINDS)], "base": "?", "outcome": failure.status}
        return {**facts, "message": failure.message, "seconds": failure.seconds}

    records = work.each(run_case, asked, timeout=_PATIENCE * options.seconds, reuse=100, failed=failed)
    return counted(list(records.values()))


def counted(records: list[Record]) -> Measured:
    """Keep of a record what tells; thousands end as they should."""
    seconds = [record["seconds"] for record in records]
    listed = [record for record in records if record["outcome"] in BAD or record.get("unexplained")]
    by_kind = {kind: [record for record in records if record["kind"] == kind] for kind in KINDS}
    return listed or records[:1], {
        "cases": len(records),
        "outcomes": dict(Counter(record["outcome"] for record in records)),
        "by_kind": {kind: dict(Counter(record["outcome"] for record in group)) for kind, group in by_kind.items()},
        "seconds": {
            "median": float(np.median(seconds)), "95 %": float(np.percentile(seconds, 95)), "longest": max(seconds),
        },
    }  # fmt: skip


def report(found: Report[Record]) -> list[str]:
    """Outcomes by kind of corruption, and every failure."""
    columns = (*READY, *BAD)
    summary = found.summary
    rows = [
        (kind, str(sum(counts.values())), *(str(counts.get(name, 0)) for name in columns))
        for kind, counts in [*summary["by_kind"].items(), ("**all**", summary["outcomes"])]
    ]
    inside = [record for record in found.records if record.get("unexplained")]
    reasons = Counter(reason for record in inside for reason in record["unexplained"])
    seconds = summary["seconds"]
    return [
        f"{summary['cases']} corruptions of valid models. " + explained(__doc__),
        (
            f"Time of a run: median {seconds['median']:.2f} s, 95 % below {seconds['95 %']:.1f} s, longest "
            f"{seconds['longest']:.1f} s. In {len(inside)} runs an isolated stage or check gave way, which the report "
            "says."
        ),
        table(("corruption", "cases", *columns), rows),
        *(["## Failures", "\n".join(f"- {line}" for line in faults(found))] if faults(found) else []),
        *(["## Stages and checks that gave way, isolated"] if reasons else []),
        "\n".join(f"- {count} times {reason}" for reason, count in reasons.most_common(30)),
    ]


def faults(found: Report[Record]) -> list[str]:
    """Every run that ended otherwise than with a report or a refusal."""
    return [
        f"{r['number']} ({r['kind']}, {r['base']}): {r['outcome']}, {r['message'][-300:]}"
        for r in found.records
        if r["outcome"] in BAD
    ]


STUDY = Study(
    title="Robustness of `kinematify validate`",
    options=RobustnessOptions,
    measure=measure,
    report=report,
    faults=faults,
)
