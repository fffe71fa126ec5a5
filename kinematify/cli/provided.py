"""`kinematify generate` with another generator: parts of an image or a sentence, or a written blueprint."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import click

from kinematify.assembly.load import load_assembly
from kinematify.cli.blueprint_feedback import in_blueprint_words
from kinematify.cli.inferred import describe, describe_validation, validation_answer, validation_status
from kinematify.cli.options import say
from kinematify.cli.report_files import report_on
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.providers.command import CommandSource
from kinematify.generate.providers.job import open_job
from kinematify.generate.providers.judge_blueprint import drawn_findings
from kinematify.generate.providers.language_model import LanguageModel, language_model
from kinematify.generate.providers.rodin import RodinSource
from kinematify.generate.providers.source import RecordingSource, ReplayedSource, check_prompt
from kinematify.model.output import MODEL_FILE, check_output, write_model_folder
from kinematify.pipeline.record import write_inference_files
from kinematify.validation.run import validate
from kinematify.vision.infer_object import infer

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.cli.progress import Reporter
    from kinematify.config import Config
    from kinematify.generate.delivery import BuildResult
    from kinematify.generate.providers.language_model import Written
    from kinematify.generate.providers.source import PartSource
    from kinematify.validation.run.report import ValidationReport

_MADE, _INFERRED, _WRITTEN = 0.6, 0.8, 0.85  # shares of the time at which these are done


def job_folder(out: Path) -> Path:
    """Beside the model: it stays, so that the same request never costs anything again."""
    return out.parent / f"{out.name}.job"


def part_source(given: Mapping[str, Any], config: Config) -> PartSource:
    """The generator that the options ask for.

    Raises:
        click.UsageError: There is no program.
    """
    limit, chosen = given["time_limit"], config.sources.rodin
    if given["source"] == "rodin":
        asked = chosen if limit is None else chosen.model_copy(update={"job_seconds": limit})
        source: PartSource = RodinSource(asked, given["budget"])
    elif given["program"] is None:
        raise click.UsageError("--source command needs --command 'program {image} {out}'.")
    else:
        source = CommandSource(given["program"], limit or config.sources.command_seconds)
    if given["record"] is not None:
        return RecordingSource(source, given["record"])
    return source if given["replay"] is None else ReplayedSource(source, given["replay"])


def model_of_parts(
    given: Mapping[str, Any], out: Path, config: Config, progress: Reporter
) -> tuple[int, dict[str, Any], str]:
    """Get the parts, infer their joints, write the folder and validate the model in it.

    Returns:
        The exit status, everything as JSON values, and the text for the user.

    Raises:
        InputError: The prompt, the key or an option cannot be used.
        EnvironmentFault: The generator failed; the same call goes on where it stopped.
        OutputError: The folder exists and must not be replaced, or cannot be written.
    """
    check_output(out, overwrite=given["force"])
    source, job_place = part_source(given, config), job_folder(out)
    prompt = check_prompt(given["text"], given["images"], seed=given["seed"] or 0)
    with open_job(job_place, source.name, prompt.digest(source.options())) as job:
        if given["resend"]:
            job.resend()
        generated = source.generate(prompt, job, lambda stage, done: progress(stage, _MADE * done))
    progress("reading the parts", _MADE)
    parts = load_assembly(
        generated.path, config=config.assembly, up=given["up"], scale=given["scale"], labels=generated.labels
    )
    found = infer(
        parts, config=config, progress=lambda stage, done: progress(stage, _MADE + (_INFERRED - _MADE) * done)
    )
    made = generated.provenance
    inference = replace(found, provenance=made.as_json())
    write_model_folder(
        out,
        lambda folder: write_inference_files(
            inference, folder, preview=not given["no_preview"],
            progress=lambda stage, done: progress(stage, _INFERRED + (_WRITTEN - _INFERRED) * done),
        ),
        overwrite=given["force"],
    )  # fmt: skip
    report = None if given["no_validation"] else report_on(out, progress, _WRITTEN)
    answer = {
        "schema": 1,
        "out": str(out),
        "job": str(job_place),
        "provenance": made.as_json(),
        "validation": validation_answer(report),
    }
    words = (
        f"Parts of {made.provider} ({made.model}), cost: {made.cost or 'unknown'}. Terms: {made.licence}\n"
        f"{job_place}: everything that the generator made; the same request is not sent again"
    )
    return (
        validation_status(report),
        answer,
        "\n\n".join([words, describe(inference, out), describe_validation(report, out)]),
    )


def model_asked(given: Mapping[str, Any], config: Config) -> LanguageModel:
    """The language model that the options ask for.

    Raises:
        InputError: No address is set.
    """
    asked = {"rounds": given["rounds"], "answer_seconds": given["time_limit"]}
    settings = config.sources.language_model.model_copy(
        update={name: value for name, value in asked.items() if value is not None}
    )
    return language_model(settings, budget=given["budget"], record=given["record"], replay=given["replay"])


def written_by(
    model: LanguageModel, given: Mapping[str, Any], out: Path, config: Config, progress: Reporter
) -> Written:
    """Build what a language model answers, and send back what does not hold of it.

    Raises:
        InputError: See `LanguageModel.write`.
        EnvironmentFault: The service failed.
    """

    def judged(made: BuildResult) -> Sequence[str]:
        drawn = drawn_findings(made.blueprint) if made.request is None else ()
        if given["no_validation"]:
            return drawn
        with TemporaryDirectory() as folder:
            write_blueprint(made.blueprint, Path(folder), config)
            report: ValidationReport = validate(Path(folder, MODEL_FILE), workers=os.cpu_count() or 1)
        return [*drawn, *in_blueprint_words(report.counted)]

    prompt = check_prompt(given["text"], given["images"], seed=0)
    with open_job(job_folder(out), "llm", prompt.digest(model.options())) as job:
        if given["resend"]:
            job.resend()
        written = model.write(prompt, job, judged, progress)
    facts = {"source": "llm", "model": model.model, "text": given["text"], "rounds": written.rounds}
    blueprint = written.made.blueprint
    named = replace(blueprint, parameters={**blueprint.parameters, **facts})
    return replace(written, made=replace(written.made, blueprint=named))


def say_written(model: LanguageModel, written: Written) -> None:
    """Tell the user who drew or filled in what was built."""
    by = f"by {model.model} in {written.rounds} rounds, {written.tokens} tokens: {written.path}"
    say(f"{'Drawn' if written.made.request is None else 'Filled in'} {by}\n")
