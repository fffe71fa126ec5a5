"""`kinematify refine`: a model is simulated, and what its failures point to is chosen again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.inferred import describe, describe_validation, validated, validation_answer, validation_status
from kinematify.cli.options import examples
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from kinematify.pipeline.inference import Inference
    from kinematify.refinement import Refinement

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
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "-o", "--out", type=click.Path(path_type=Path), help="Folder to make for the refined model; FOLDER if not given."
)
@click.option(
    "--rounds", type=click.IntRange(min=0), default=3, show_default=True, help="Rounds at most; 0 only simulates."
)
@click.option("--base", metavar="NAME", help="Part that the tree is rooted at, if the choice made is wrong.")
@click.option("--force", is_flag=True, help="Replace OUT if it is a model folder; without -o, the model in FOLDER.")
@click.option("--no-preview", is_flag=True, help="Write no picture.")
@click.option("--no-validation", is_flag=True, help="Do not check the model or load it into engines.")
@json_option
def command(
    *,
    folder: Path,
    out: Path | None,
    rounds: int,
    base: str | None,
    force: bool,
    no_preview: bool,
    no_validation: bool,
    json_to: str | None,
) -> int:
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
    from kinematify.model.output import MODEL_FILE
    from kinematify.pipeline.infer_assembly import infer
    from kinematify.processes.lock import writing
    from kinematify.refinement import refine
    from kinematify.refinement.folder import open_model_folder, read_record, stored_state, write_refined

    target = _target(folder, out, force=force)
    with writing(target), progress_reporter() as progress:
        progress("reading the parts", 0.0)
        assembly, config = open_model_folder(folder)
        inference = infer(assembly, config=config, base=base, progress=lambda stage, done: progress(stage, 0.4 * done))
        refinement = refine(
            stored_state(inference, read_record(folder)),
            rounds=rounds,
            base=base,
            progress=lambda stage, done: progress(stage, 0.4 + 0.5 * done),
        )
        progress("writing the model", 0.9)
        write_refined(refinement.inference, folder, target, overwrite=force, preview=not no_preview)
        report = None
        if not (no_validation or refinement.interrupted):
            progress("checking the geometry and loading the file into engines", 0.94)
            report = validated(target / MODEL_FILE)
    if write_answer({**as_answer(refinement, target), **validation_answer(report)}, json_to):
        blocks = (
            describe_refinement(refinement.inference),
            describe(refinement.inference, target),
            describe_validation(report, target),
        )
        click.echo("\n\n".join(block for block in blocks if block))
    return exit_status(refinement) or validation_status(report)


def exit_status(refinement: Refinement) -> int:
    """130 after Ctrl-C, 1 if the kept round has an error about motion, else 0."""
    if refinement.interrupted:
        return ExitStatus.INTERRUPTED
    history = refinement.history
    return ExitStatus.FAILURES if any(item.errors for item in history.rounds[history.kept : history.kept + 1]) else 0


def describe_refinement(inference: Inference) -> str:
    """What changed and why as a table, which round was kept and why the loop ended."""
    from kinematify.validation.run.outcome import counted_words

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


def as_answer(refinement: Refinement, folder: Path) -> dict[str, Any]:
    """Everything as JSON values."""
    history = refinement.history
    kept = next((item for item in history.rounds if item.number == history.kept), None)
    return {
        "schema": 1,
        "out": str(folder),
        "passes": kept is not None and kept.errors == 0,
        "refinement": history.as_json(),
    }


def _target(folder: Path, out: Path | None, *, force: bool) -> Path:
    """Return the folder to write, once it may be written.

    Raises:
        InputError: The model in FOLDER would be replaced without --force, or one of the two folders holds the other.
        OutputError: OUT exists and must not be replaced, or cannot be written.
    """
    from kinematify.errors import InputError
    from kinematify.model.output import check_output

    if out is None and not force:
        raise InputError(
            f"The refined model would replace the one in {folder}.\n"
            f"Give -o OUT to write it to another folder, or --force to replace the model in {folder}."
        )
    target = folder if out is None else out
    ends = folder.resolve(), target.resolve()
    if ends[0] != ends[1] and (ends[0] in ends[1].parents or ends[1] in ends[0].parents):
        raise InputError(f"One of the folders {folder} and {target} lies in the other. Give a place beside {folder}.")
    if out is not None:
        check_output(out, overwrite=force)
    return target
