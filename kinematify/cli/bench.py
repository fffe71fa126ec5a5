"""`kinematify bench`: accuracy on models whose joints are known, beside the paper's, and studies of other questions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import examples, jobs_option, listed
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus
from kinematify.evaluation.checkout import benchmark_module, has_benchmarks


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
    callback=listed,
    metavar="LIST",
    default="rest,random-0,random-1,random-2,yaw37",
    show_default=True,
    help="Poses in which each object is shown, separated by commas.",
)
@click.option(
    "--objects",
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
@jobs_option
@click.option("--fresh", is_flag=True, help="Run everything again instead of resuming an earlier run.")
@click.option(
    "--degrade",
    callback=listed,
    metavar="LIST",
    show_default="none",
    help="Also measure faulty meshes; all, or some of voxels-300, voxels-150, vertex-noise, faces-1000, "
    "faces-300, hulls, holes, flipped, gaps, interpenetration, open, cut-2, cut-3.",
)
@json_option
def command(*, json_to: str | None, **given: Any) -> int:
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
    from kinematify.evaluation.accuracy import HEADINGS, bench, summary_rows
    from kinematify.evaluation.result_record import as_json
    from kinematify.evaluation.run_benchmark import RESULTS

    with progress_reporter() as progress:
        done = bench(**given, progress=progress)
    if write_answer(as_json(done, RESULTS), json_to):
        rows = format_table(HEADINGS, summary_rows(done))
        click.echo(f"{rows}\n\nReport: {', '.join(map(str, done.files))}")
    for sentence in done.regressions:
        click.echo(sentence, err=True)
    return ExitStatus.FAILURES if done.regressions else ExitStatus.FINE
