"""`python -m benchmarks.fit`: the choice of joints, fitted again and judged on held-out objects."""

from __future__ import annotations

import os
from pathlib import Path

import click

from benchmarks.fit.packages import write_installed
from benchmarks.fit.run import as_markdown, run_fit
from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import examples
from kinematify.cli.progress import progress_reporter


@click.command(
    epilog=examples(
        "python -m benchmarks.fit -o fitted",
        "python -m benchmarks.fit models/everyday models/robots --rounds 8 --composed 400 -o fitted",
        "python -m benchmarks.fit models/everyday models/infinigen --per-category 10 --hold-out infinigen -o fitted",
        "python -m benchmarks.fit --rounds 1 --composed 20 -o reduced",
    ),
)
@click.argument("folders", nargs=-1, type=click.Path(path_type=Path))
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True, help="Folder of weights and tables.")
@click.option("--rounds", type=click.IntRange(min=0), default=4, show_default=True, help="Objects of every family.")
@click.option("--composed", type=click.IntRange(min=0), default=150, show_default=True, help="Random mechanisms.")
@click.option("--packages", is_flag=True, help="Also objects that installed PyPI packages carry.")
@click.option("--seed", type=int, default=0, show_default=True, help="Draws the generated objects.")
@click.option("--jobs", type=click.IntRange(min=1), help="Worker processes; as many as there are cores if not given.")
@click.option(
    "--per-category",
    type=click.IntRange(min=1),
    help="Fit to this many objects of each category of a folder; the others judge. All if not given.",
)
@click.option(
    "--hold-out", multiple=True, help="Also evaluate this folder of objects without fitting to it; repeat it."
)
@click.option(
    "--skip",
    type=click.Choice(["fixed", "described"]),
    multiple=True,
    help="Do not refit what detects fixed parts; do not evaluate described objects.",
)
@json_option
def command(
    *,
    folders: tuple[Path, ...],
    out: Path,
    rounds: int,
    composed: int,
    packages: bool,
    seed: int,
    jobs: int | None,
    per_category: int | None,
    hold_out: tuple[str, ...],
    skip: tuple[str, ...],
    json_to: str | None,
) -> None:
    """Fit the choice of joints to generated objects and to the objects in FOLDERS.

    Each object has a model.urdf and a source.json, as those of `kinematify bench`; those whose licence is for research
    alone judge and are not fitted to. What was measured is kept beside the weights, so that an interrupted run goes on.
    To ship new weights, copy the .npz files into kinematify/joints/choice.
    """
    if packages:
        write_installed(out / "packages")
        folders = (*folders, out / "packages")
    with progress_reporter() as progress:
        report = run_fit(
            folders,
            out,
            rounds=rounds,
            composed=composed,
            seed=seed,
            workers=jobs or os.cpu_count() or 1,
            cache=out / "measured",
            per_category=per_category,
            hold_out=hold_out,
            skip=skip,
            progress=progress,
        )
    if json_to != "-":
        click.echo(as_markdown(report))
    if json_to is not None:
        write_answer(report, json_to)


if __name__ == "__main__":
    command(prog_name="python -m benchmarks.fit")
