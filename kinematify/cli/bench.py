"""`kinematify bench`: accuracy on models whose joints are known, beside the paper's."""

from __future__ import annotations

import os
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.help import examples
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.cli.words import words_of
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.evaluation.job import JobResult
    from kinematify.evaluation.regression import Regression
    from kinematify.evaluation.run import BenchmarkReport, Variant


@click.command(
    "bench",
    short_help="Accuracy on models with known joints, beside the paper's.",
    epilog=examples(
        "kinematify bench --data pip",
        "kinematify bench models/ -o results --name robots",
        "kinematify bench models/ --conditions rest --objects panda --objects cabinet_*",
        "kinematify bench models/ --config default --config paper",
        "kinematify bench models/ --baseline results/robots.json",
        "kinematify bench models/ --degrade voxels-150,cut-2 --conditions rest --name degraded",
        "kinematify bench models/ --errors 20",
        "kinematify bench models/ --refine --tiers geometry,engines --perturb all --conditions rest",
    ),
)
@click.argument("folder", metavar="[DATA]", required=False, type=click.Path(path_type=Path))
@click.option("--data", metavar="pip|PATH", help="Same as DATA; pip: robots of the package example-robot-data.")
@click.option(
    "--config",
    "configs",
    multiple=True,
    default=("default",),
    show_default=True,
    metavar="NAME|FILE",
    help="May be given more than once; paper brings its two ablations with it.",
)
@click.option(
    "--ablation", is_flag=True, help="Measure default without MCTS, and with DW-CAVL in place of its own joints, too."
)
@click.option(
    "--conditions",
    metavar="LIST",
    default="rest,random-0,random-1,random-2,yaw37",
    show_default=True,
    help="Poses in which each object is shown, separated by commas.",
)
@click.option(
    "--objects",
    "patterns",
    multiple=True,
    metavar="GLOB",
    help="Only objects of such a name, category or kind; may be given more than once.",
)
@click.option(
    "-o", "--out", type=click.Path(path_type=Path), default=Path("results"), show_default=True, help="Report folder."
)
@click.option("--name", default="bench", show_default=True, help="File name of the report, without suffix.")
@click.option(
    "--baseline", type=click.Path(path_type=Path), help="Earlier report (JSON); exit status 1 if one is worse."
)
@click.option("--jobs", type=click.IntRange(min=1), help="Worker processes; as many as there are cores if not given.")
@click.option("--fresh", is_flag=True, help="Run all again instead of taking up what an earlier run has finished.")
@click.option(
    "--degrade",
    metavar="LIST",
    default="none",
    show_default=True,
    help="Rough meshes too, beside clean ones; all, or some of voxels-300, voxels-150, vertex-noise, faces-1000, "
    "faces-300, hulls, holes, flipped, gaps, interpenetration, open, cut-2, cut-3.",
)
@click.option(
    "--errors",
    "shown",
    type=click.IntRange(min=1),
    metavar="N",
    help="Also write a page with pictures of the N worst joints, truth beside inference.",
)
@click.option("--refine", is_flag=True, help="Measure what simulation and choosing again change, instead of accuracy.")
@click.option(
    "--tiers",
    metavar="LIST",
    default="geometry",
    show_default=True,
    help="With --refine: how far it simulates, of geometry, engines and task.",
)
@click.option(
    "--perturb",
    metavar="LIST",
    default="none",
    show_default=True,
    help="With --refine: input that is a little wrong too; all, or some of "
    "tolerance-half, tolerance-double, noise, contacts-missing, contacts-spurious, split, gaps.",
)
@json_option
def command(
    *,
    folder: Path | None,
    data: str | None,
    configs: tuple[str, ...],
    ablation: bool,
    conditions: str,
    patterns: tuple[str, ...],
    out: Path,
    name: str,
    baseline: Path | None,
    jobs: int | None,
    fresh: bool,
    degrade: str,
    shown: int | None,
    refine: bool,
    tiers: str,
    perturb: str,
    json_to: str | None,
) -> int:
    """Erase the joints of every URDF below DATA, infer them again and measure how far off they are.

    DATA is a folder with URDF files at any depth, one URDF file, or the word pip. Without it the folder that the
    variable KINEMATIFY_BENCH names is used, else ../shared/bench beside the repository.

    The report is written as Markdown and JSON. A run that was interrupted goes on where it stopped; a change of the
    code or of the configuration starts anew. Wrong answers do not change the exit status, worse ones than those of
    --baseline do.

    --degrade measures the same objects once more with every fault that meshes have in practice: remeshed on a grid of
    1/300 or 1/150 of the diagonal, noisy, decimated, as hulls, with holes or flipped faces, apart or in each other,
    open where parts meet (open), or with a part cut in two or three (cut-2, cut-3), which must come out as fixed.

    With --refine each object is inferred once and refined by every tier; the table says what that mends, what it costs
    and where it does harm. --perturb adds input with wrong tolerances, noise, faulty contacts, cut parts or gaps.
    """
    from kinematify.evaluation.regression import find_regressions
    from kinematify.evaluation.report import as_json, load_report, write_report
    from kinematify.evaluation.run import BenchmarkRequest, run_benchmark

    if folder is not None and data is not None:
        raise click.UsageError(f"Both DATA ({folder}) and --data ({data}) are given. Leave one out.")
    chosen = data if data is not None else folder
    if degrade != "none" and (refine or baseline is not None):
        raise click.UsageError("--degrade cannot be combined with --refine or --baseline. Give one of them.")
    earlier = load_report(baseline) if baseline is not None else None
    request = BenchmarkRequest(
        data=chosen,
        variants=_variants(configs, ablation=ablation),
        conditions=tuple(word.strip() for word in conditions.split(",")),
        inputs=_inputs(degrade),
        only=_matching_objects(chosen, patterns),
        fresh=fresh,
        workers=jobs or os.cpu_count() or 1,
    )
    if refine:
        from kinematify.cli.bench_refine import measure_refinement

        measure_refinement(request, tiers=tiers, perturb=perturb, out=out, name=name, json_to=json_to)
        return 0
    with progress_reporter() as progress:
        report = run_benchmark(request, progress)
        written: tuple[Path, ...] = write_report(report, out, name=name, baseline=earlier)
        if shown is not None:
            from kinematify.evaluation.errors import write_error_gallery

            page = write_error_gallery(report, request, out, name=f"{name}_errors", count=shown, progress=progress)
            written = (*written, page)
    regressions = find_regressions(report, earlier) if earlier is not None else ()
    if json_to:
        write_answer(as_json(report), json_to)
    if json_to != "-":
        click.echo(f"{_describe(report)}\n\nReport: {', '.join(map(str, written))}")
    for regression in regressions:
        click.echo(_describe_regression(regression), err=True)
    return ExitStatus.FAILURES if regressions else 0


def _inputs(given: str) -> tuple[str, ...]:
    """Clean meshes, and what is asked for of `--degrade`."""
    from kinematify.evaluation.perturb import CLEAN, DEGRADED

    return (CLEAN,) if given == "none" else (CLEAN, *words_of(given, DEGRADED, "--degrade"))


def _matching_objects(data: str | Path | None, patterns: Sequence[str]) -> tuple[str, ...]:
    from kinematify.errors import InputError
    from kinematify.evaluation.datasets import find_objects

    if not patterns:
        return ()
    objects = find_objects(data)
    words = sorted({word for item in objects for word in (item.name, item.category, item.kind)})
    chosen = tuple(word for word in words if any(fnmatchcase(word, pattern) for pattern in patterns))
    if not chosen:
        raise InputError(
            f"No object, category or kind matches --objects {' '.join(patterns)}. There are {', '.join(words)}."
        )
    return chosen


def _variants(configs: Sequence[str], *, ablation: bool) -> tuple[Variant, ...]:
    """Return one variant per configuration; `paper` stands for its ablations too, `default` if they are asked for."""
    from kinematify.evaluation.run import DEFAULT_ABLATION, PAPER_VARIANTS, Variant

    several = {"paper": PAPER_VARIANTS, **({"default": DEFAULT_ABLATION} if ablation else {})}
    own = [Variant(label=Path(config).stem, config=config) for config in configs]
    return tuple(variant for one in own for variant in several.get(one.label, (one,)))


def _describe(report: BenchmarkReport) -> str:
    """Return the means per configuration and kind of object, the paper's below them."""
    from kinematify.evaluation.paper import TABLE_I, mean_over_robots

    rows = [
        _summary_row(key, [run for run in report.results if (run.variant, run.kind, run.input) == key])
        for key in dict.fromkeys((run.variant, run.kind, run.input) for run in report.results)
    ]
    for paper in (mean_over_robots(), TABLE_I["everyday"]):
        rows.append(("(the paper)", paper.label, "", f"{paper.angle_deg:.2f}", "", f"{paper.ted:.2f}", "", "", "", ""))
    headings = (
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
    return format_table(headings, rows)


def _summary_row(key: tuple[str, str, str], runs: Sequence[JobResult]) -> tuple[str, ...]:
    from kinematify.evaluation.perturb import CLEAN
    from kinematify.evaluation.summary import summarise

    summary = summarise(runs)
    columns = (("angle_deg", 1.0, 2), ("line_m", 1e3, 2), ("ted", 1.0, 2), ("root", 1.0, 2), ("types", 100.0, 1))
    cells = [
        _number(summary.values.get(metric), scale, digits) for metric, scale, digits in (*columns, ("seconds", 1.0, 1))
    ]
    variant, kind, given = key
    objects = kind if given == CLEAN else f"{kind}, {given}"
    return (variant, objects, str(summary.objects), *cells, str(summary.failed_runs + summary.unscored_runs))


def _number(value: float | None, scale: float, digits: int) -> str:
    return "-" if value is None else f"{value * scale:.{digits}f}"


def _describe_regression(regression: Regression) -> str:
    change = f"{regression.metric} went from {regression.before:.4g} to {regression.now:.4g} {regression.unit}".rstrip()
    return f"Worse than the baseline: {change} ({regression.kind} objects, configuration {regression.variant})."
