"""Objects of other generators: parts of a picture or a sentence, whose joints are inferred, or a written blueprint."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from kinematify.assembly.load import load_assembly
from kinematify.creation.blueprint_feedback import in_blueprint_words
from kinematify.creation.generated_model import GeneratedModel, job_folder
from kinematify.errors import InputError
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.providers.command import run_command
from kinematify.generate.providers.job import open_job
from kinematify.generate.providers.judge_blueprint import drawn_findings
from kinematify.generate.providers.language_model import language_model
from kinematify.model.output import MODEL_FILE, write_model_folder
from kinematify.pipeline.record import write_inference_files
from kinematify.validation.formats.report_files import report_on
from kinematify.validation.run import validate
from kinematify.vision.infer_object import infer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.config import Config
    from kinematify.generate.delivery import BuildResult
    from kinematify.generate.providers.language_model import Written
    from kinematify.generate.providers.source import Prompt

    Progress = Callable[[str, float], None]

_MADE, _INFERRED, _WRITTEN = 0.6, 0.8, 0.85
"""Shares of the time at which these are done."""


def made_parts(
    prompt: Prompt,
    out: Path,
    config: Config,
    progress: Progress,
    *,
    program: str | None,
    time_limit: float | None,
    up: str,
    scale: float | None,
    overwrite: bool,
    preview: bool,
    validation: bool,
) -> GeneratedModel:
    """Run the program of the user for parts, infer their joints, write the folder and validate the model in it.

    Raises:
        InputError: There is no program, or the prompt cannot be used.
        EnvironmentFault: The program failed.
        OutputError: The folder cannot be written.
    """
    if program is None:
        raise InputError("--source command needs --command 'program {image} {out}'.")
    limit = time_limit or config.sources.command_seconds
    job = job_folder(out)
    with open_job(job, "command", prompt.digest({"command": program})):
        parts = run_command(program, limit, prompt, job, lambda stage, done: progress(stage, _MADE * done))
    progress("reading the parts", _MADE)
    read = load_assembly(parts.path, config=config.assembly, up=up, scale=scale, labels=parts.labels)
    found = infer(read, config=config, progress=lambda stage, done: progress(stage, _MADE + (_INFERRED - _MADE) * done))
    inference = replace(found, provenance=parts.provenance)
    write_model_folder(
        out,
        lambda folder: write_inference_files(
            inference, folder, preview=preview,
            progress=lambda stage, done: progress(stage, _INFERRED + (_WRITTEN - _INFERRED) * done),
        ),
        overwrite=overwrite,
    )  # fmt: skip
    report = report_on(out, progress, _WRITTEN) if validation else None
    return GeneratedModel(out=out, model=inference.model, inference=inference, report=report, parts=parts)


def written_blueprint(
    prompt: Prompt,
    out: Path,
    config: Config,
    progress: Progress,
    *,
    rounds: int | None,
    time_limit: float | None,
    validation: bool,
    **options: Any,
) -> Written:
    """Build what a language model answers, and send back what does not hold of it.

    Raises:
        InputError: No address is set; see `LanguageModel.write`.
        EnvironmentFault: The service failed.
    """
    asked = {"rounds": rounds, "answer_seconds": time_limit}
    settings = config.sources.language_model.model_copy(
        update={name: value for name, value in asked.items() if value is not None}
    )
    model = language_model(settings, **options)

    def judged(made: BuildResult) -> Sequence[str]:
        drawn = drawn_findings(made.blueprint) if made.request is None else ()
        if not validation:
            return drawn
        with TemporaryDirectory() as folder:
            write_blueprint(made.blueprint, Path(folder), config)
            report = validate(Path(folder, MODEL_FILE))
        return [*drawn, *in_blueprint_words(report.counted)]

    job = job_folder(out)
    with open_job(job, "llm", prompt.digest(model.options())):
        written = model.write(prompt, job, judged, progress)
    facts = {"source": "llm", "model": model.model, "text": prompt.text, "rounds": written.rounds}
    blueprint = written.made.blueprint
    named = replace(blueprint, parameters={**blueprint.parameters, **facts})
    return replace(written, made=replace(written.made, blueprint=named))
