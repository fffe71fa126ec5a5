"""`kinematify.bench`: accuracy on models with known joints, in a report beside the paper's."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.evaluation.benchmark_job import CLEAN
from kinematify.evaluation.benchmark_summary import summarise
from kinematify.evaluation.checkout import benchmark_module, has_benchmarks
from kinematify.evaluation.result_record import load_report, number, table, write_report
from kinematify.evaluation.run_benchmark import ALL_CONDITIONS, RESULTS, Variant, run_benchmark

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.batch.task_pool import Progress
    from kinematify.evaluation.benchmark_job import JobResult
    from kinematify.evaluation.result_record import Report

HEADINGS = (
    "config",
    "objects",
    "number",
    "angle [deg]",
    "line [mm]",
    "TED",
    "root",
    "types [%]",
    "time [s]",
    "failed",
)
_COLUMNS = (
    ("angle_deg", 1.0, 2), ("line_m", 1e3, 2), ("ted", 1.0, 2), ("root", 1.0, 2), ("types", 100.0, 1),
    ("seconds", 1.0, 1),
)  # fmt: skip
"""Metrics of a row with factor and digits."""


def bench(
    data: str | Path | None = None,
    out: str | Path = "results",
    *,
    configs: Sequence[str] = ("default",),
    ablation: bool = False,
    conditions: Sequence[str] = ALL_CONDITIONS,
    objects: Sequence[str] = (),
    name: str = "bench",
    baseline: str | Path | None = None,
    jobs: int | None = None,
    fresh: bool = False,
    degrade: Sequence[str] = (),
    progress: Progress | None = None,
) -> Report[JobResult]:
    """Erase the joints of models, infer them again and measure the errors, as `kinematify bench` does.

    Args:
        data: Folder, URDF, or name of a set; robots and everyday objects if absent.
        out: Folder of the report.
        configs: Names or paths of configurations; ``paper`` brings its two ablations with it, in a checkout.
        ablation: Measure ``default`` without MCTS, and with DW-CAVL in place of its own joints, too.
        conditions: Poses in which each object is shown.
        objects: Patterns for names of objects, categories or kinds; empty for all.
        name: File name of the report, without suffix.
        baseline: Earlier report (JSON) to compare with.
        jobs: Processes at a time; as many as there are cores if absent.
        fresh: Run everything again instead of resuming an earlier run.
        degrade: Faults of meshes with which everything is measured once more; ``all`` for all.
        progress: Called with what has just finished and the fraction done.

    Returns:
        Header, scores of every object, means, the files of the report, and what is worse than in the baseline.

    Raises:
        InputError: There is no such data, object, condition, configuration or fault, or it needs a checkout.
        OutputError: The report or the records of finished jobs cannot be written.
    """
    if degrade and baseline is not None:
        raise InputError("--degrade cannot be combined with --baseline. Give one of them.")
    earlier = load_report(Path(baseline), RESULTS) if baseline is not None else None
    find = None if baseline is None else benchmark_module("regression", "--baseline").find_regressions
    faults, by = _faults(degrade)
    report = run_benchmark(
        data,
        variants=_variants(configs, ablation=ablation),
        conditions=conditions,
        inputs=(CLEAN, *faults),
        degrade=by,
        objects=objects,
        fresh=fresh,
        jobs=jobs,
        progress=progress,
    )
    if has_benchmarks():
        blocks = benchmark_module("tables", "The report").benchmark_blocks(report, earlier)
    else:
        blocks = [table(HEADINGS, summary_rows(report))]
    files = write_report(report, RESULTS, blocks, Path(out), name=name, title=name)
    worse = () if find is None else find(report, earlier)
    return replace(report, files=files, regressions=tuple(item.sentence for item in worse))


def _faults(asked: Sequence[str]) -> tuple[tuple[str, ...], str]:
    """The faults that are asked for, and the function that makes them, as ``module:name``."""
    if not asked:
        return (), ""
    module: Any = benchmark_module("degrade", "--degrade")
    unknown = [word for word in asked if word not in (*module.DEGRADED, "all")]
    if unknown:
        raise InputError(f"--degrade names {unknown[0]!r}. Known are all, {', '.join(module.DEGRADED)}.")
    known = tuple(word for word in module.DEGRADED if word in asked or "all" in asked)
    return known, f"{module.__name__}:{module.degraded.__name__}"


def _variants(configs: Sequence[str], *, ablation: bool) -> tuple[Variant, ...]:
    """One variant per configuration; in a checkout `paper` has its ablations too, and `default` where it is asked."""
    several: dict[str, tuple[Variant, ...]] = {}
    if ablation or has_benchmarks():
        published = benchmark_module("paper", "--ablation")
        several = {"paper": published.PAPER_VARIANTS, **({"default": published.DEFAULT_ABLATION} if ablation else {})}
    own = [Variant(label=Path(config).stem, config=config) for config in configs]
    return tuple(variant for one in own for variant in several.get(one.label, (one,)))


def summary_rows(report: Report[JobResult]) -> list[tuple[str, ...]]:
    """Means by configuration and kind of object, a cell for each of `HEADINGS`; in a checkout the paper's below."""
    rows = [
        _summary_row(key, [run for run in report.records if (run.variant, run.kind, run.input) == key])
        for key in dict.fromkeys((run.variant, run.kind, run.input) for run in report.records)
    ]
    if has_benchmarks():
        published = benchmark_module("paper", "The report")
        for paper in (published.mean_over_robots(), published.TABLE_I["everyday"]):
            values = (f"{paper.angle_deg:.2f}", "", f"{paper.ted:.2f}")
            rows.append(("(the paper)", paper.label, "", *values, "", "", "", ""))
    return rows


def _summary_row(key: tuple[str, str, str], runs: Sequence[JobResult]) -> tuple[str, ...]:
    summary = summarise(runs)
    cells = [number(summary.values.get(metric), digits, scale) for metric, scale, digits in _COLUMNS]
    variant, kind, given = key
    objects = kind if given == CLEAN else f"{kind}, {given}"
    return (variant, objects, str(summary.objects), *cells, str(summary.failed_runs + summary.unscored_runs))
