"""One call of `kinematify generate` with another generator: parts of an image or a sentence, or a written blueprint."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import click

from kinematify.assembly.load import load_assembly
from kinematify.cli.blueprint_feedback import in_blueprint_words
from kinematify.cli.generation import Generation, status_of, summary_of, verdict_on, warn_if_interrupted
from kinematify.cli.inferred import describe
from kinematify.cli.options import say, with_collision
from kinematify.cli.report_files import report_on
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.providers.command import CommandSource
from kinematify.generate.providers.job import open_job
from kinematify.generate.providers.judge_blueprint import drawn_findings
from kinematify.generate.providers.language_model import LanguageModel, language_model
from kinematify.generate.providers.rodin import RodinSource
from kinematify.generate.providers.source import RecordingSource, ReplayedSource, check_prompt
from kinematify.model.output import MODEL_FILE, check_output, write_model_folder
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.record import write_inference_files
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.cli.progress import Reporter
    from kinematify.config import Config
    from kinematify.generate.delivery import BuildResult
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.providers.language_model import Written
    from kinematify.generate.providers.source import Generated, PartSource
    from kinematify.pipeline.inference import Inference
    from kinematify.validation.run.report import ValidationReport

_MADE, _INFERRED, _WRITTEN = 0.6, 0.8, 0.85  # shares of the time at which these are done
JOB_SUFFIX = ".job"


@dataclass(frozen=True, kw_only=True)
class ProvidedOptions:
    """As they were given on the command line."""

    text: str | None
    images: tuple[Path, ...]
    source: str
    command: str | None
    time_limit: float | None
    budget: float | None
    rounds: int | None
    record: Path | None
    replay: Path | None
    resend: bool
    up: str
    scale: float | None
    seed: int | None
    config: Config

    def part_source(self) -> PartSource:
        """The generator that was asked for.

        Raises:
            click.UsageError: Options do not go together.
        """
        self._refuse_both()
        if self.rounds is not None:
            raise click.UsageError("--rounds belongs to --source llm. Leave it out.")
        source = self._plain_source()
        if self.record is not None:
            return RecordingSource(source, self.record)
        return source if self.replay is None else ReplayedSource(source, self.replay)

    def language_model(self) -> LanguageModel:
        """The language model that was asked for.

        Raises:
            click.UsageError: Options do not go together.
            InputError: No address is set.
        """
        self._refuse_both()
        if self.command is not None or self.seed is not None:
            raise click.UsageError("--command and --seed mean nothing to a language model. Leave them out.")
        asked = {"rounds": self.rounds, "answer_seconds": self.time_limit}
        settings = self.config.sources.language_model.model_copy(
            update={name: value for name, value in asked.items() if value is not None}
        )
        return language_model(settings, budget=self.budget, record=self.record, replay=self.replay)

    def _refuse_both(self) -> None:
        if self.record is not None and self.replay is not None:
            raise click.UsageError("--record and --replay exclude each other.")

    def _plain_source(self) -> PartSource:
        settings = self.config.sources
        if self.source == "command":
            if self.command is None:
                raise click.UsageError("--source command needs --command 'program {image} {out}'.")
            if self.budget is not None:
                raise click.UsageError("--budget belongs to --source rodin. Leave it out.")
            return CommandSource(self.command, self.time_limit or settings.command_seconds)
        if self.command is not None:
            raise click.UsageError("--command belongs to --source command.")
        chosen = settings.rodin
        if self.time_limit is not None:
            chosen = chosen.model_copy(update={"job_seconds": self.time_limit})
        return RodinSource(chosen, self.budget)


def job_folder(out: Path) -> Path:
    """Beside the model: it stays, so that the same request never costs anything again."""
    return out.parent / f"{out.name}{JOB_SUFFIX}"


@dataclass
class ProvidedGeneration:
    """State of one generation by a provider: the request and what was built."""

    options: ProvidedOptions
    out: Path
    preview: bool
    with_verdict: bool
    collision: str | None = None
    """``auto`` or ``mesh``; None: as the configuration says."""
    generated: Generated = field(init=False)
    inference: Inference = field(init=False)
    report: ValidationReport | None = None

    def all(self, progress: Reporter, *, overwrite: bool) -> None:
        """Get the parts, infer their joints, write the folder and validate the model in it.

        Raises:
            InputError: The prompt, the key or an option cannot be used.
            EnvironmentFault: The generator failed; the same call goes on where it stopped.
            OutputError: The folder exists and must not be replaced, or cannot be written.
        """
        check_output(self.out, overwrite=overwrite)
        self._make_parts(lambda stage, done: progress(stage, _MADE * done))
        config = with_collision(self.options.config, self.collision)
        progress("reading the parts", _MADE)
        given = load_assembly(
            self.generated.path, config=config.assembly, up=self.options.up, scale=self.options.scale,
            labels=self.generated.labels,
        )  # fmt: skip
        share = _INFERRED - _MADE
        found = infer(given, config=config, progress=lambda stage, done: progress(stage, _MADE + share * done))
        self.inference = replace(found, provenance=self.generated.provenance.as_json())
        write_model_folder(
            self.out,
            lambda folder: write_inference_files(
                self.inference, folder, preview=self.preview,
                progress=lambda stage, done: progress(stage, _INFERRED + (_WRITTEN - _INFERRED) * done),
            ),
            overwrite=overwrite,
        )  # fmt: skip
        if self.with_verdict:
            rest = 1.0 - _WRITTEN
            self.report = report_on(
                self.out,
                progress=lambda stage, done: progress(f"validation: {stage}", _WRITTEN + rest * done),
            )  # fmt: skip

    @property
    def job_folder(self) -> Path:
        """Implement `job_folder`."""
        return job_folder(self.out)

    def _make_parts(self, progress: Reporter) -> None:
        source = self.options.part_source()
        prompt = check_prompt(self.options.text, self.options.images, seed=self.options.seed or 0)
        with open_job(self.job_folder, source.name, prompt.digest(source.options())) as job:
            if self.options.resend:
                job.resend()
            self.generated = source.generate(prompt, job, progress)

    @property
    def exit_status(self) -> int:
        """1 if the model has an error, 130 if the validation was interrupted, else 0."""
        return status_of(self.report)

    @property
    def answer(self) -> dict[str, Any]:
        """Everything as JSON values."""
        return {
            "schema": 1,
            "out": str(self.out),
            "job": str(self.job_folder),
            "provenance": self.generated.provenance.as_json(),
            "validation": summary_of(self.report),
        }

    def say(self, *, quiet: bool) -> None:
        """Tell the user; nothing if a machine reads stdout."""
        if quiet:
            return
        facts = self.generated.provenance
        made = f"Parts of {facts.provider} ({facts.model}), cost: {facts.cost or 'unknown'}. Terms: {facts.licence}"
        kept = f"{self.job_folder}: everything that the generator made; the same request is not sent again"
        say("\n\n".join([f"{made}\n{kept}", describe(self.inference, self.out), verdict_on(self.report, self.out)]))
        warn_if_interrupted(self.report)


@dataclass
class LanguageGeneration(Generation):
    """A request that a language model fills, or an object that it draws."""

    options: ProvidedOptions = field(kw_only=True)
    model_asked: LanguageModel = field(init=False)
    written: Written = field(init=False)

    def build(self, progress: Reporter) -> BuildResult:
        """Build what a model answers, and send back what does not hold of it.

        Raises:
            InputError: See `LanguageModel.write`.
            EnvironmentFault: The service failed.
        """
        self.model_asked = self.options.language_model()
        prompt = check_prompt(self.options.text, self.options.images, seed=0)
        with open_job(job_folder(self.out), "llm", prompt.digest(self.model_asked.options())) as job:
            if self.options.resend:
                job.resend()
            self.written = self.model_asked.write(prompt, job, self._judged, progress)
        facts = {
            "source": "llm", "model": self.model_asked.model, "text": self.options.text, "rounds": self.written.rounds,
        }  # fmt: skip
        made = self.written.made
        return replace(made, blueprint=replace(made.blueprint, parameters={**made.blueprint.parameters, **facts}))

    def _judged(self, made: BuildResult) -> Sequence[str]:
        drawn = drawn_findings(made.blueprint) if made.request is None else ()
        return [*drawn, *self._findings(made.blueprint)]

    def _findings(self, blueprint: Blueprint) -> Sequence[str]:
        """Return what the validation holds against the model of a blueprint; nothing without validation."""
        if not self.validated:
            return ()
        with TemporaryDirectory() as folder:
            write_blueprint(blueprint, Path(folder), self.config)
            report = validate(Path(folder, MODEL_FILE), workers=os.cpu_count() or 1)
        return in_blueprint_words(report.counted)

    @property
    def answer(self) -> dict[str, Any]:
        """Everything as JSON values."""
        facts = {"rounds": self.written.rounds, "tokens": self.written.tokens, "answer": str(self.written.path)}
        return {**super().answer, "language_model": facts}

    def say(self, *, quiet: bool) -> None:
        """Tell the user; nothing if a machine reads stdout."""
        if not quiet:
            written = self.written
            by = f"by {self.model_asked.model} in {written.rounds} rounds, {written.tokens} tokens: {written.path}"
            say(f"{'Drawn' if written.made.request is None else 'Filled in'} {by}\n")
        super().say(quiet=quiet)
