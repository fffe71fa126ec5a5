"""One call of `kinematify validate`: models one after the other, and what is said about them at the end."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import click

from kinematify.cli.options import say
from kinematify.cli.verdict import describe, describe_listed, describe_table, describe_unused
from kinematify.errors import ExitStatus, InputError
from kinematify.robot.description import form_of
from kinematify.validation.finding import Severity
from kinematify.validation.run import validate
from kinematify.validation.run.outcome import Unusable
from kinematify.validation.run.suppression_file import unused_suppressions

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.cli.progress import Reporter
    from kinematify.config.validation import ValidationSettings
    from kinematify.manipulation.plan_request import TaskRequest
    from kinematify.validation.formats.report_picture import Drawing
    from kinematify.validation.run.outcome import Outcome
    from kinematify.validation.run.report import ValidationReport
    from kinematify.validation.suppression import Suppression

PICTURES_AT_MOST = 12
"""With more models an HTML report shows none: it would take long to make and to load."""
PICTURE_SECONDS = 15.0
"""A picture that takes longer is omitted [s]; known robots take 1 to 3."""


@dataclass(kw_only=True)
class ValidationRun:
    """State of one run of `kinematify validate`: the request and the results."""

    models: tuple[Path, ...]
    package_dirs: tuple[Path, ...]
    arguments: dict[str, str]
    """Of xacros."""
    selected: frozenset[str]
    engines: tuple[str, ...]
    rules: tuple[Suppression, ...]
    settings: ValidationSettings
    workers: int
    with_pictures: bool
    fail_on: Severity = Severity.ERROR
    """Least severity that ends the command with 1."""
    quick: bool = False
    """Only MuJoCo is asked, and nobody named it."""
    quiet: bool = False
    """Nothing is told on stdout."""
    everything: bool = False
    """Tell notes, places and tables of one model, too."""
    task: TaskRequest | None = None
    outcomes: list[Outcome] = field(default_factory=list)
    pictures: dict[str, bytes] = field(default_factory=dict)
    scenes: dict[str, str] = field(default_factory=dict)
    interrupted: bool = False

    def run(self, progress: Reporter) -> None:
        """Validate one model after the other; each has all processes for itself."""
        for number, model in enumerate(self.models):
            label = f"{model.parent.name}/{model.name} ({number + 1} of {len(self.models)}): "
            prefix = label if len(self.models) > 1 else ""

            def report(stage: str, fraction: float, done: int = number, prefix: str = prefix) -> None:
                progress(prefix + stage, (done + fraction) / len(self.models))

            self._run_one(model, report)
            if self.interrupted:
                return

    def _run_one(self, model: Path, progress: Reporter) -> None:
        try:
            report = validate(
                model,
                package_dirs=self.package_dirs,
                arguments=self.arguments if form_of(model) == "xacro" else None,
                settings=self.settings,
                selected=self.selected,
                engines=self.engines,
                named=not self.quick,
                suppressions=self.rules,
                task=self._task_of(model),
                workers=self.workers,
                progress=progress,
            )
        except InputError as error:
            self._take(Unusable(model=str(model), message=str(error)))
            return
        self._take(report)
        self.interrupted = bool(report.environment.get("interrupted"))
        if self.with_pictures and len(self.models) <= PICTURES_AT_MOST and _can_be_drawn(report):
            progress("picture", 0.97)
            drawing = self._drawing(model)
            self.pictures[report.model], self.scenes[report.model] = drawing.picture, drawing.scene

    def _take(self, outcome: Outcome) -> None:
        """Keep an outcome, and tell it at once where there are several."""
        self.outcomes.append(outcome)
        if len(self.models) > 1 and not self.quiet:
            say(f"{describe_listed(outcome)}\n")

    def _task_of(self, model: Path) -> TaskRequest | None:
        """The task with names of films that distinguishes the models."""
        if self.task is None:
            return None
        stem = model.stem if len(self.models) == 1 else f"{model.absolute().parent.name}_{model.stem}"
        return replace(self.task, stem=f"{stem}_{self.task.kind}")

    def _drawing(self, model: Path) -> Drawing:
        from kinematify.validation.formats.report_picture import drawing_of

        return drawing_of(model, self.package_dirs, self.settings, seconds=PICTURE_SECONDS)

    @property
    def exit_status(self) -> int:
        """130 after Ctrl-C, else the worst of the models: unusable, an error, not finished, fine."""
        if self.interrupted:
            return ExitStatus.INTERRUPTED
        found = {item.status_at(self.fail_on) for item in self.outcomes}
        order = (ExitStatus.UNUSABLE, ExitStatus.FAILURES, ExitStatus.FAULT)
        return next((status for status in order if status in found), ExitStatus.FINE)

    def print(self) -> None:
        """Tell the user: the report on stdout unless a machine reads that, what is no result on stderr."""
        reports = [outcome for outcome in self.outcomes if not isinstance(outcome, Unusable)]
        if len(self.models) > 1 and not self.quiet:
            say(describe_table(self.outcomes))
        elif reports and not self.quiet:
            say(describe(reports[0], everything=self.everything))
        else:
            for outcome in self.outcomes:
                if isinstance(outcome, Unusable):
                    click.echo(f"Error: {outcome.message}", err=True)
        if self.interrupted:
            done = f"{len(self.outcomes)} of {len(self.models)} models"
            click.echo(f"Interrupted. What is known by now was reported ({done}, the last one in part).", err=True)
        elif unused := describe_unused(unused_suppressions(self.rules, reports)):
            click.echo(unused, err=True)


def _can_be_drawn(report: ValidationReport) -> bool:
    """True if the file and its meshes can be read and nobody waits for the end."""
    broken = any(item.check.startswith("KV1") and item.severity is Severity.ERROR for item in report.findings)
    return not broken and not report.environment.get("interrupted")
