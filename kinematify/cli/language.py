"""One call of `kinematify generate --source llm`: a language model writes a blueprint and mends what is found in it."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from kinematify.cli.generation import Generation
from kinematify.cli.provided import job_folder
from kinematify.cli.verdict import say
from kinematify.config import load_config
from kinematify.generate.blueprint_file import WrittenBlueprint
from kinematify.generate.providers.job import open_job
from kinematify.generate.providers.language_model import BLUEPRINT_FILE
from kinematify.generate.providers.source import check_prompt
from kinematify.model.output import MODEL_FILE
from kinematify.pipeline.generate import write_blueprint
from kinematify.validation.finding import Severity
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.cli.progress import Reporter
    from kinematify.cli.provided import ProvidedOptions
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.providers.language_model import LanguageModel, Written

_MOST_FINDINGS = 10  # that are told in one round


@dataclass
class LanguageGeneration(Generation):
    """As for what a file describes, once the model has written the file."""

    options: ProvidedOptions = field(kw_only=True)
    model_asked: LanguageModel = field(init=False)
    written: Written = field(init=False)

    def build(self, progress: Reporter) -> Blueprint:
        """Let the model write, and mend what the validation finds.

        Raises:
            InputError: See `LanguageModel.write`.
            EnvironmentFault: The service failed.
        """
        self.model_asked = self.options.language_model()
        prompt = check_prompt(self.options.text, self.options.images, seed=0)
        with open_job(job_folder(self.out), "llm", prompt.digest(self.model_asked.options())) as job:
            if self.options.resend:
                job.resend()
            self.written = self.model_asked.write(prompt, job, self._findings, progress)
        facts = {
            "source": "llm",
            "model": self.model_asked.model,
            "text": self.options.text,
            "rounds": self.written.rounds,
        }
        return replace(super().build(progress), parameters=facts)

    def _findings(self, blueprint: Blueprint) -> Sequence[str]:
        """What the validation holds against the model of a blueprint; nothing where it is left out."""
        if not self.validated:
            return ()
        with TemporaryDirectory() as folder:
            write_blueprint(blueprint, Path(folder), load_config())
            report = validate(Path(folder, MODEL_FILE), workers=os.cpu_count() or 1)
        errors = [item for item in report.counted if item.severity is Severity.ERROR]
        return [f"{item.message} {item.remedy}" for item in errors[:_MOST_FINDINGS]]

    @property
    def answer(self) -> dict[str, Any]:
        """Everything as JSON values."""
        facts = {"rounds": self.written.rounds, "tokens": self.written.tokens, "blueprint": str(self.written.path)}
        return {**super().answer, "language_model": facts}

    def say(self, *, quiet: bool) -> None:
        """Tell the user; nothing if a machine reads stdout."""
        if not quiet:
            say(
                f"Written by {self.model_asked.model} in {self.written.rounds} rounds, {self.written.tokens} tokens: "
                f"{self.written.path}\n"
            )
        super().say(quiet=quiet)


def written_request(out: Path) -> WrittenBlueprint:
    """What the model is going to write."""
    return WrittenBlueprint(job_folder(out) / BLUEPRINT_FILE)
