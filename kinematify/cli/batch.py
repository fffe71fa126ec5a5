"""`kinematify batch`: a library of assets becomes models, by all processors of a machine or of a cluster."""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import examples, listed, pieces_option, scale_option, vlm_option
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from kinematify.batch.run_batch import BatchResult

_SHOWN = 10
"""Objects without a good model that are named on the terminal; the page has all."""


def _share(_context: click.Context, _parameter: click.Parameter, words: str) -> tuple[int, int]:
    """Number and count of the shares, from `2/8`."""
    number, _, of = words.partition("/")
    if not (number.isdecimal() and of.isdecimal() and 1 <= int(number) <= int(of)):
        raise click.BadParameter(f"{words} is no share. Give I/N with I from 1 to N, e.g. 2/8.")
    return int(number), int(of)


@click.command(
    "batch",
    epilog=examples(
        "kinematify batch 'assets/**/*.glb' -o out/library",
        "kinematify batch 'assets/**/*.glb' -o out/library --resume",
        "kinematify batch 'models/**/*.urdf' -o out/judged --steps validate",
        "kinematify batch 's3://bucket/assets/*.glb' -o s3://bucket/models --engine ray --address auto",
        "kinematify batch 'assets/*.glb' -o out/library --shard 2/8 --steps infer,validate,export --to mjcf,usd",
    ),
)
@click.argument("inputs", nargs=-1, required=True, metavar="INPUT...")
@click.option("-o", "--out", required=True, metavar="DIR|URL", help="Where the results go.")
@click.option(
    "--steps",
    callback=listed,
    default="infer,validate",
    show_default=True,
    metavar="LIST",
    help="Of infer, refine, validate, export; without infer the inputs are URDFs.",
)
@click.option(
    "--to",
    callback=listed,
    default="mjcf",
    show_default=True,
    metavar="LIST",
    help="Formats of the step export: mjcf, usd, sdf, glb.",
)
@click.option(
    "--engine",
    type=click.Choice(["local", "ray"]),
    default="local",
    show_default=True,
    help="Processes of this machine, or of a Ray cluster (extra `ray`).",
)
@click.option("--address", metavar="ADDRESS", help="Of the Ray cluster, e.g. auto or ray://host:10001; none: one here.")
@click.option(
    "--workers", type=click.IntRange(min=1), help="Objects at a time; as many as there are cores if not given."
)
@click.option(
    "--timeout", type=click.FloatRange(min=0.0, min_open=True), default=900.0, show_default=True, metavar="SECONDS",
    help="Wall time for an object.",
)  # fmt: skip
@click.option(
    "--memory", type=click.FloatRange(min=1.0), default=8.0, show_default=True, metavar="GB",
    help="Address space of a worker.",
)  # fmt: skip
@click.option("--resume", is_flag=True, help="Continue the run in the output and skip finished objects.")
@click.option("--retry", is_flag=True, help="With --resume, convert again every object that gave no model.")
@click.option(
    "--shard",
    metavar="I/N",
    default="1/1",
    callback=_share,
    help="Only share I of N of the objects, for runs side by side.",
)
@click.option(
    "--up",
    type=click.Choice(["auto", "z", "y", "x", "-z", "-y", "-x"]),
    default="auto",
    show_default=True,
    help="Axis of the inputs that points up.",
)
@scale_option
@pieces_option
@vlm_option
@click.option(
    "--config", default="default", show_default=True, metavar="NAME|FILE", help="Shipped or own configuration."
)
@click.option("--seed", type=int, help="Seed of everything random, instead of the configuration's.")
@json_option
def command(*, json_to: str | None, **given: Any) -> int:
    """Convert every INPUT (path, pattern, URL, folder of assets), as `kinematify infer` takes it, into its own model.

    OUT gets objects/NAME/ for each, manifest.jsonl with a line for each that has ended (status, verdict, time, memory,
    error, hashes), and index.html. An object that crashes, hangs or cannot be read is recorded, and the run goes on.

    Ends with 0 if every object has a model without errors, with 1 if one has not. Ctrl-C leaves valid records and ends
    with 130; the same command with --resume goes on.
    """
    from kinematify.batch.batch_summary import write_page
    from kinematify.batch.run_batch import batch

    signal.signal(signal.SIGTERM, lambda *_: signal.raise_signal(signal.SIGINT))  # as schedulers of clusters stop jobs
    with progress_reporter() as progress:
        result = batch(**given, progress=progress)
    page = write_page(result.out)
    if write_answer(_answer(result), json_to):
        click.echo(f"{_described(result)}\n{page}")
    if result.interrupted:
        click.echo(f"Interrupted, {result.left} objects are left. Go on with --resume.", err=True)
        return ExitStatus.INTERRUPTED
    return ExitStatus.FAILURES if any(record.failed for record in result.records) else ExitStatus.FINE


def _described(result: BatchResult) -> str:
    from kinematify.batch.batch_summary import STEP_HEADINGS, outcome_words, step_rows
    from kinematify.validation.run.report import counted_words

    skipped = f"; skipped: {len(result.records) - result.new} done earlier" if len(result.records) > result.new else ""
    rate = f", {3600.0 * result.new / result.seconds:.0f} an hour" if result.new else ""
    workers = counted_words(result.workers, "worker")
    bad = [record for record in result.records if record.failed]
    lines = [f"{record.object}: {record.error or 'an error, see its validation.json'}" for record in bad[:_SHOWN]]
    if len(bad) > _SHOWN:
        lines.append(f"and {len(bad) - _SHOWN} more, see the page")
    return "\n".join(
        [
            f"{len(result.records)} objects: {outcome_words(result.records)}",
            f"{result.new} converted in {result.seconds:.0f} s with {workers}{rate}{skipped}",
            "",
            format_table(STEP_HEADINGS, step_rows(result.records)),
            "",
            *lines,
        ]
    )


def _answer(result: BatchResult) -> dict[str, Any]:
    from kinematify.batch.manifest import RECORD

    return {
        "schema": 1,
        "out": result.out,
        "new": result.new,
        "left": result.left,
        "seconds": result.seconds,
        "workers": result.workers,
        "interrupted": result.interrupted,
        "records": [RECORD.dump_python(record, mode="json") for record in result.records],
    }
