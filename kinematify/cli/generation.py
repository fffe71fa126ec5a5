"""One call of `kinematify generate`: from a request to a model folder with its verdict, and what is said about it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.inferred import describe_files, describe_joints
from kinematify.cli.options import say, with_collision
from kinematify.cli.report_files import report_on
from kinematify.config import load_config
from kinematify.errors import ExitStatus, InputError
from kinematify.generate.blueprint_files import INFERRED_FOLDER, PARTS_FOLDER, write_blueprint, write_parts
from kinematify.generate.delivery import BuildResult, deliver
from kinematify.generate.reader import Sentence
from kinematify.generate.request import Request
from kinematify.model.output import MODEL_FILE, PREVIEW_FILE, check_output, write_model_folder

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.cli.progress import Reporter
    from kinematify.config import Config
    from kinematify.evaluation.metrics import ObjectScore
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.inference import Inference
    from kinematify.validation.run.report import ValidationReport

    Requested = Sentence | Request | Blueprint


_INFERRED, _WRITTEN = 0.4, 0.6  # shares of the time at which these are done, for five joints that are inferred


@dataclass
class Generation:
    """State of one generation: the request and what was built."""

    request: Requested | None
    """None where a language model is asked."""
    seed: int | None
    out: Path
    preview: bool
    validated: bool
    inferred: bool = False
    """Whether the joints are found again from the parts alone, beside the exact ones."""
    collision: str | None = None
    """``auto`` or ``mesh``; None: as the configuration says."""
    config: Config = field(default_factory=load_config)
    strict: bool = False
    """True: nothing is written unless all is as asked for."""
    made: BuildResult = field(init=False)
    model: KinematicModel = field(init=False)
    inference: Inference | None = None
    report: ValidationReport | None = None

    def all(self, progress: Reporter, *, overwrite: bool) -> None:
        """Build the object, write it with its exact joints and validate that; infer them from its parts if asked to.

        Raises:
            InputError: A parameter is out of its bounds, or something is not built and `strict` is set.
            OutputError: The folder exists and must not be replaced, or cannot be written.
        """
        check_output(self.out, overwrite=overwrite)
        self.made = self.build(progress)
        if self.strict and not self.made.is_complete:
            raise InputError(f"{_not_as_asked(self.made)}\nNothing is written; without --strict the rest is built.")
        if self.validated:
            from kinematify.simulation.engines import DEFAULT_ENGINES
            from kinematify.validation.isolation import start_server
            from kinematify.validation.run.plan import stages_of

            # Its imports take a second, on another core than the inference.
            start_server(stages_of(DEFAULT_ENGINES))
        config = with_collision(self.config, self.collision)
        if self.inferred:
            from kinematify.pipeline.infer_assembly import infer

            self.inference = infer(
                self.blueprint.assembly, config=config, progress=lambda stage, done: progress(stage, _INFERRED * done)
            )
        share = _WRITTEN - _INFERRED
        write_model_folder(
            self.out,
            lambda folder: self._write(folder, config, lambda stage, done: progress(stage, _INFERRED + share * done)),
            overwrite=overwrite,
        )
        if self.validated:
            self._validate(lambda stage, done: progress(f"validation: {stage}", _WRITTEN + (1.0 - _WRITTEN) * done))

    def build(self, progress: Reporter) -> BuildResult:
        """Build what is asked for.

        Raises:
            InputError: A parameter is out of its bounds.
        """
        del progress
        assert self.request is not None, "who asks no language model has a request"
        if isinstance(self.request, Sentence):
            return self.request.made(seed=self.seed)
        if isinstance(self.request, Request):
            made = deliver(self.request, seed=self.seed)
            if made.missing:  # a sentence may name what is not there; a request says exactly what is
                raise InputError(f"{made.differences[0][0].upper()}{made.differences[0][1:]}.")
            return made
        return BuildResult(blueprint=self.request)

    @property
    def blueprint(self) -> Blueprint:
        """Return the blueprint that was built."""
        return self.made.blueprint

    def _write(self, folder: Path, config: Config, progress: Reporter) -> None:
        progress("cutting the collision geometry", 0.0)
        self.model = write_blueprint(self.blueprint, folder, config, facts=self.made.facts)
        write_parts(self.blueprint, folder / PARTS_FOLDER)
        if self.preview:
            from kinematify.model.preview import render_preview

            progress("drawing the picture", 0.4)
            render_preview(self.model, folder / PREVIEW_FILE, config.preview)
        if self.inference is not None:
            from kinematify.pipeline.record import write_inference_files

            (folder / INFERRED_FOLDER).mkdir()
            write_inference_files(
                self.inference,
                folder / INFERRED_FOLDER,
                preview=self.preview,
                progress=lambda stage, done: progress(f"the inferred model: {stage}", 0.6 + 0.4 * done),
            )

    def _validate(self, progress: Reporter) -> None:
        self.report = report_on(self.out, progress=progress)

    @property
    def exit_status(self) -> int:
        """1 if the model has an error or is not as asked, 130 if the validation was interrupted, else 0."""
        return status_of(self.report) or (0 if self.made.is_complete else ExitStatus.FAILURES)

    @property
    def answer(self) -> dict[str, Any]:
        """Everything as JSON values."""
        return {
            "schema": 1,
            "out": str(self.out),
            "category": self.blueprint.family,
            "parameters": dict(self.blueprint.parameters),
            "request": self.made.facts.get("request"),
            "notes": list(self.made.notes),
            "differences": list(self.made.differences),
            "unread": list(self.made.unread),
            "validation": summary_of(self.report),
            "accuracy": None if self.inference is None else _accuracy(self.score(self.inference)),
        }

    def say(self, *, quiet: bool) -> None:
        """Tell the user, how well the joints were inferred last; nothing if a machine reads stdout."""
        if quiet:
            return
        blocks = [
            _read(self.made),
            f"Base: {self.model.root}\n\n{describe_joints(self.model.joints)}",
            "\n".join(describe_files(self.out)),
            verdict_on(self.report, self.out),
        ]
        if self.inference is not None:
            score = _describe_score(self.score(self.inference))
            blocks.append(f"Inferred from the parts alone: {self.out / INFERRED_FOLDER / MODEL_FILE}\n{score}")
        blocks.append(_not_as_asked(self.made))
        say("\n\n".join(block for block in blocks if block))
        warn_if_interrupted(self.report)

    def score(self, inference: Inference) -> ObjectScore:
        """Compare with the joints that the object was built with."""
        from kinematify.evaluation.metrics import score_blueprint

        return score_blueprint(self.blueprint, inference)


def status_of(report: ValidationReport | None) -> int:
    """Exit status: 1 if the model has an error, 130 if the validation was interrupted, else 0."""
    if report is None:
        return 0
    return ExitStatus.INTERRUPTED if report.environment.get("interrupted") else report.exit_status


def verdict_on(report: ValidationReport | None, out: Path) -> str:
    """Return what a user reads of a validation, or how to get one."""
    if report is None:
        return f"Not validated; kinematify validate {out / MODEL_FILE} does that."
    from kinematify.cli.verdict import describe_briefly

    return f"{describe_briefly(report)}\n{out / 'validation.html'}: every check, with remedies"


def warn_if_interrupted(report: ValidationReport | None) -> None:
    """Say that only the validation is incomplete."""
    if status_of(report) == ExitStatus.INTERRUPTED:
        click.echo("Interrupted. The model is complete, its validation is not.", err=True)


def summary_of(report: ValidationReport | None) -> dict[str, Any] | None:
    """The verdict as JSON values."""
    if report is None:
        return None
    from kinematify.validation.finding import Severity
    from kinematify.validation.run.outcome import severity_counts

    counts = severity_counts(report)
    return {
        "verdict": report.verdict,
        **{f"{severity.value}s": counts.get(severity, 0) for severity in Severity},
        "failed": sorted({item.check for item in report.counted if item.severity is Severity.ERROR}),
        "seconds": report.environment.get("seconds"),
    }


def _read(made: BuildResult) -> str:
    """The request as it was read, for who wants to see whether that is what was meant."""
    if made.request is None:
        return ""
    asked = made.request
    facts = [f"{name} {value}" for name, value in asked.parameters.items()]
    facts += [f"{name} {value:.3g} m" for name, value in asked.size.items()]
    for noun, part in asked.parts.items():
        said = part.model_dump(exclude_defaults=True)
        facts.append(f"{noun} ({', '.join(f'{name} {_shown(value)}' for name, value in said.items()) or 'any'})")
    copies = f"{asked.copies} of " if asked.copies > 1 else ""
    return "\n".join([*made.notes, f"Request: {copies}{asked.kind}{': ' if facts else ''}{'; '.join(facts)}."])


def _shown(value: Any) -> str:
    return (
        ", ".join(map(_shown, value))
        if isinstance(value, tuple)
        else f"{value:.3g}"
        if isinstance(value, float)
        else str(value)
    )


def _not_as_asked(made: BuildResult) -> str:
    lines = [f"Not as asked: {'; '.join(made.differences)}"] if made.differences else []
    if words := (*made.unread, *made.harmless):
        lines.append(f"Words not read: {', '.join(dict.fromkeys(words))}")
    return "\n".join(lines)


def _accuracy(score: ObjectScore) -> dict[str, Any]:
    angles = [joint.angle_deg for joint in score.joints]
    return {
        "joints": len(angles),
        "types_right": sum(joint.type_right for joint in score.joints),
        "tree_edit_distance": score.ted.value,
        "mean_axis_angle_deg": sum(angles) / len(angles) if angles else None,
        "largest_axis_angle_deg": max(angles, default=None),
    }


def _describe_score(score: ObjectScore) -> str:
    facts = _accuracy(score)
    if not facts["joints"]:
        return "Against the known joints: there are none."
    return (
        f"Against the known joints: {facts['types_right']} of {facts['joints']} types right, axes off by "
        f"{facts['mean_axis_angle_deg']:.2f} deg on average and {facts['largest_axis_angle_deg']:.2f} deg at most, "
        f"tree {'exact' if facts['tree_edit_distance'] == 0 else 'off by ' + format(facts['tree_edit_distance'], 'g')}."
    )
