"""`kinematify bench`: accuracy on models whose joints are known, beside the paper's, and studies of other questions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.checkout import benchmark_module, has_benchmarks
from kinematify.cli.options import examples, listed, words_of
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.evaluation.benchmark_job import JobResult
    from kinematify.evaluation.result_record import Report
    from kinematify.evaluation.run_benchmark import Variant


_HEADINGS = (
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


class _BenchCommand(click.Command):
    """The benchmark, or the study that the first word names."""

    def make_context(
        self, info_name: str | None, args: list[str], parent: click.Context | None = None, **extra: Any
    ) -> click.Context:
        """Hand over to the study's own command where one is named."""
        study = None if not args or args[0].startswith("-") else _study(args[0])
        if study is None:
            return super().make_context(info_name, args, parent, **extra)
        study.params += [parameter for parameter in self.params if parameter.name == "traceback"]
        return study.make_context(f"{info_name} {args[0]}", args[1:], parent, **extra)


def _study(word: str) -> click.Command | None:
    """The command of a study; None for data.

    Raises:
        InputError: The word is no data, and there is no `benchmarks/` that could have a study of that name.
    """
    from kinematify.evaluation.datasets import PIP_DATA, SETS

    if not has_benchmarks() and (word in (*SETS, PIP_DATA) or Path(word).exists() or "/" in word):
        return None
    study: click.Command | None = benchmark_module("study", f"The study {word}").study_command(word)
    return study


def _list(context: click.Context, _parameter: click.Parameter, asked: bool) -> None:
    if asked:
        benchmark_module("study", "The list of studies").print_studies()
        context.exit()


@click.command(
    "bench",
    cls=_BenchCommand,
    options_metavar="[OPTIONS]",
    epilog=examples(
        "kinematify bench pip",
        "kinematify bench models/ -o results --name robots",
        "kinematify bench models/ --conditions rest --objects panda --objects cabinet_*",
        "kinematify bench models/ --config default --config paper",
        "kinematify bench models/ --baseline results/robots.json",
        "kinematify bench models/ --degrade voxels-150,cut-2 --conditions rest --name degraded",
        "kinematify bench --list",
        "kinematify bench detection --only kinematic",
        "kinematify bench detection --help",
    ),
)
@click.argument("data", required=False)
@click.option(
    "--list", is_flag=True, expose_value=False, is_eager=True, callback=_list, help="Name the studies and end."
)
@click.option(
    "--config",
    "configs",
    multiple=True,
    default=("default",),
    show_default=True,
    metavar="NAME|FILE",
    help="May be given more than once; paper brings its two ablations with it, in a checkout.",
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
@click.option("--fresh", is_flag=True, help="Run everything again instead of resuming an earlier run.")
@click.option(
    "--degrade",
    metavar="LIST",
    default="none",
    show_default=True,
    help="Also measure faulty meshes; all, or some of voxels-300, voxels-150, vertex-noise, faces-1000, "
    "faces-300, hulls, holes, flipped, gaps, interpenetration, open, cut-2, cut-3.",
)
@json_option
def command(
    *,
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
    json_to: str | None,
) -> int:
    """Erase the joints of every URDF below DATA, infer them again and measure the errors.

    DATA is a folder with URDF files at any depth, one URDF file, or one of the words pip (robots of the package
    example-robot-data), robots, everyday, everyday2, articraft, infinigen, kitchen and kinart. Without it robots and
    everyday objects are measured. The sets are searched in the folder that the variable KINEMATIFY_BENCH names, else in
    ../shared/bench beside the repository.

    The report is written as Markdown and JSON. A run that was interrupted goes on where it stopped; a change of the
    code or of the configuration starts again. Wrong answers do not change the exit status, worse ones than those of
    --baseline do. Studies, --ablation, --baseline, --degrade and all tables but the first need a checkout of the
    repository.

    --degrade measures the same objects once more with every fault that meshes have in practice: remeshed on a grid of
    1/300 or 1/150 of the diagonal, noisy, decimated, as hulls, with holes or flipped faces, apart or interpenetrating,
    open where parts meet (open), or with a part cut in two or three (cut-2, cut-3), which must come out as fixed.

    `kinematify bench STUDY` runs another study; --list names them, and each has its own options.
    """
    from kinematify.evaluation.benchmark_job import CLEAN
    from kinematify.evaluation.result_record import as_json, load_report, table, write_report
    from kinematify.evaluation.run_benchmark import RESULTS, bench

    if degrade != "none" and baseline is not None:
        raise click.UsageError("--degrade cannot be combined with --baseline. Give one of them.")
    earlier = load_report(baseline, RESULTS) if baseline is not None else None
    find = None if baseline is None else benchmark_module("regression", "--baseline").find_regressions
    detailed = has_benchmarks()
    faults, by = _faults(degrade)
    with progress_reporter() as progress:
        report = bench(
            data,
            variants=_variants(configs, ablation=ablation),
            conditions=listed(conditions),
            inputs=(CLEAN, *faults),
            degrade=by,
            objects=patterns,
            fresh=fresh,
            jobs=jobs,
            progress=progress,
        )
        if detailed:
            blocks = benchmark_module("tables", "The report").benchmark_blocks(report, earlier)
        else:
            blocks = [table(_HEADINGS, _rows(report))]
        written = write_report(report, RESULTS, blocks, out, name=name, title=name)
    regressions = () if find is None else find(report, earlier)
    if write_answer(as_json(report, RESULTS), json_to):
        click.echo(f"{_describe(report)}\n\nReport: {', '.join(map(str, written))}")
    for worse in regressions:
        click.echo(worse.sentence, err=True)
    return ExitStatus.FAILURES if regressions else 0


def _faults(given: str) -> tuple[tuple[str, ...], str]:
    """Return what is asked for of `--degrade`, and the function that does it, as ``module:name``."""
    if given == "none":
        return (), ""
    module = benchmark_module("degrade", "--degrade")
    return words_of(given, module.DEGRADED, "--degrade"), f"{module.__name__}:{module.degraded.__name__}"


def _variants(configs: Sequence[str], *, ablation: bool) -> tuple[Variant, ...]:
    """One variant per configuration; in a checkout `paper` has its ablations too, and `default` where it is asked."""
    from kinematify.evaluation.run_benchmark import Variant

    several: dict[str, tuple[Variant, ...]] = {}
    if ablation or has_benchmarks():
        published = benchmark_module("paper", "--ablation")
        several = {"paper": published.PAPER_VARIANTS, **({"default": published.DEFAULT_ABLATION} if ablation else {})}
    own = [Variant(label=Path(config).stem, config=config) for config in configs]
    return tuple(variant for one in own for variant in several.get(one.label, (one,)))


def _describe(report: Report[JobResult]) -> str:
    """Return the means per configuration and kind of object, the paper's below them."""
    return format_table(_HEADINGS, _rows(report))


def _rows(report: Report[JobResult]) -> list[tuple[str, ...]]:
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
    from kinematify.evaluation.benchmark_job import CLEAN
    from kinematify.evaluation.benchmark_summary import summarise
    from kinematify.evaluation.result_record import number

    summary = summarise(runs)
    columns = (("angle_deg", 1.0, 2), ("line_m", 1e3, 2), ("ted", 1.0, 2), ("root", 1.0, 2), ("types", 100.0, 1))
    cells = [
        number(summary.values.get(metric), digits, scale) for metric, scale, digits in (*columns, ("seconds", 1.0, 1))
    ]
    variant, kind, given = key
    objects = kind if given == CLEAN else f"{kind}, {given}"
    return (variant, objects, str(summary.objects), *cells, str(summary.failed_runs + summary.unscored_runs))
