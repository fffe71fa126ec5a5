"""`kinematify refine`: a model is simulated, and what its failures point to is chosen again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.inferred import describe, describe_validation, validation_answer, validation_status
from kinematify.cli.options import examples, preview_option, validation_option
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from kinematify.pipeline.inference import Inference

_HEADINGS = ("part", "what", "before", "after", "why")


@click.command(
    "refine",
    epilog=examples(
        "kinematify refine out -o refined",
        "kinematify refine out --force",
        "kinematify refine out -o refined --rounds 5",
        "kinematify refine out -o refined --json - > rounds.json",
    ),
)
@click.argument("model", type=click.Path(path_type=Path), metavar="FOLDER")
@click.option(
    "-o", "--out", type=click.Path(path_type=Path), help="Folder to make for the refined model; FOLDER if not given."
)
@click.option(
    "--rounds", type=click.IntRange(min=0), default=3, show_default=True, help="Rounds at most; 0 only simulates."
)
@click.option("--base", metavar="NAME", help="Part that the tree is rooted at, if the choice made is wrong.")
@click.option(
    "--force",
    "overwrite",
    is_flag=True,
    help="Replace OUT if it is a model folder; without -o, the model in FOLDER.",
)
@preview_option
@validation_option
@json_option
def command(*, model: Path, out: Path | None, json_to: str | None, **given: Any) -> int:
    """Simulate the model in FOLDER, feed its failures back into the search, and keep the best round.

    FOLDER was written by `kinematify infer` or `generate`. Every joint is swept through its range by exact geometry; a
    collision, a lost contact or an unreachable limit is evidence against its axis, type, range or parent. The next best
    candidates of the joints that fail are simulated too; the evidence of shape and simulation is added. No collision is
    ever switched off, no range is cut to hide a failure, and nothing is fixed without evidence. A joint that is wrong
    but moves freely stays: no simulation sees it.

    The best round is written to OUT: fewest errors, then fewest warnings, then most evidence; the model as it was wins
    every tie. inference.json keeps all rounds. OUT also gets the other files of FOLDER, but no report about the earlier
    model. Without -o the best round replaces the model in FOLDER, which needs --force.

    The last line is the verdict on the file. Ends with 1 if the model that is kept has an error, else with 0. Ctrl-C
    keeps the best round so far and ends with 130.
    """
    from kinematify.refinement.loop import refine

    with progress_reporter() as progress:
        refinement = refine(model, out, **given, progress=progress)
    report, target = refinement.report, out or model
    facts = {"schema": 1, "out": str(target), "passes": refinement.passes, "refinement": refinement.history.as_json()}
    if write_answer({**facts, **validation_answer(report)}, json_to):
        blocks = (
            describe_refinement(refinement.inference),
            describe(refinement.inference, target),
            describe_validation(report, target),
        )
        click.echo("\n\n".join(block for block in blocks if block))
    if refinement.interrupted:
        return ExitStatus.INTERRUPTED
    return validation_status(report) if refinement.passes else ExitStatus.FAILURES


def describe_refinement(inference: Inference) -> str:
    """What changed and why as a table, which round was kept and why the loop ended."""
    from kinematify.validation.run.report import counted_words

    record = inference.refinement
    if record is None:
        return ""
    rounds, kept = record["rounds"], record["kept"]
    if not rounds:
        return "Nothing was simulated."
    changes = [item for played in rounds[: kept + 1] for item in played["changes"]]
    table = [format_table(_HEADINGS, [[item[key] for key in _HEADINGS] for item in changes])] if changes else []
    what = "the model as it was inferred" if kept == 0 else f"round {kept}"
    left = ", ".join(counted_words(rounds[kept][name], name[:-1]) for name in ("errors", "warnings"))
    refused = dict.fromkeys(phrase for item in rounds for phrase in item["refused"])
    cost = f"{record['seconds']:.1f} s, {record['candidates']} candidates"
    kept_words = f"Kept: {what}, with {left} about motion. The loop ended because {record['ended']} ({cost})."
    refusals = [f"Refused, because it would have hidden a failure: {phrase}." for phrase in refused]
    return "\n".join([*table, kept_words, *refusals])
