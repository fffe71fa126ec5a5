"""From a request to a model folder with its verdict, and what is said about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kinematify.cli.inferred import (
    describe_files,
    describe_joints,
    describe_validation,
    validation_answer,
    validation_status,
)
from kinematify.cli.options import say
from kinematify.cli.report_files import report_on
from kinematify.errors import ExitStatus, InputError
from kinematify.generate.blueprint_files import INFERRED_FOLDER, PARTS_FOLDER, write_blueprint, write_parts
from kinematify.model.output import MODEL_FILE, PREVIEW_FILE, check_output, write_model_folder

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from kinematify.cli.progress import Reporter
    from kinematify.config import Config
    from kinematify.evaluation.metrics import ObjectScore
    from kinematify.generate.delivery import BuildResult
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.inference import Inference
    from kinematify.validation.run.report import ValidationReport


_INFERRED, _WRITTEN = 0.4, 0.6  # shares of the time at which these are done, for five joints that are inferred


@dataclass(frozen=True, kw_only=True)
class GeneratedModel:
    """A model folder that was written with its exact joints."""

    out: Path
    made: BuildResult
    model: KinematicModel
    inference: Inference | None
    """Joints found again from the parts alone, where that was asked for."""
    report: ValidationReport | None

    @property
    def exit_status(self) -> int:
        """1 if the model has an error or is not as asked, 130 if the validation was interrupted, else 0."""
        return validation_status(self.report) or (0 if self.made.is_complete else ExitStatus.FAILURES)

    @property
    def score(self) -> ObjectScore | None:
        """Comparison of the inferred joints with those that the object was built with."""
        from kinematify.evaluation.metrics import score_blueprint

        return None if self.inference is None else score_blueprint(self.made.blueprint, self.inference)

    def as_json(self) -> dict[str, Any]:
        """Everything as JSON values."""
        blueprint, score = self.made.blueprint, self.score
        return {
            "schema": 1,
            "out": str(self.out),
            "category": blueprint.family,
            "parameters": dict(blueprint.parameters),
            "request": self.made.facts.get("request"),
            "notes": list(self.made.notes),
            "differences": list(self.made.differences),
            "unread": list(self.made.unread),
            "validation": validation_answer(self.report),
            "accuracy": None if score is None else _accuracy(score),
        }

    def print(self) -> None:
        """Tell the user, how well the joints were inferred last."""
        score = self.score
        inferred = f"Inferred from the parts alone: {self.out / INFERRED_FOLDER / MODEL_FILE}\n"
        blocks = [
            _read(self.made),
            f"Base: {self.model.root}\n\n{describe_joints(self.model.joints)}",
            "\n".join(describe_files(self.out)),
            describe_validation(self.report, self.out),
            "" if score is None else inferred + _describe_score(score),
            _not_as_asked(self.made),
        ]
        say("\n\n".join(block for block in blocks if block))


def write_generated(
    build: Callable[[Reporter], BuildResult],
    out: Path,
    *,
    preview: bool,
    validated: bool,
    inferred: bool,
    config: Config,
    strict: bool,
    overwrite: bool,
    progress: Reporter,
) -> GeneratedModel:
    """Build an object, write it with its exact joints and validate that; infer them from its parts if asked to.

    Raises:
        InputError: A parameter is out of its bounds, or something is not built and `strict` is set.
        OutputError: The folder exists and must not be replaced, or cannot be written.
    """
    check_output(out, overwrite=overwrite)
    made = build(progress)
    if strict and not made.is_complete:
        raise InputError(f"{_not_as_asked(made)}\nNothing is written; without --strict the rest is built.")
    if validated:
        from kinematify.simulation.engines import DEFAULT_ENGINES
        from kinematify.validation.isolation import start_server
        from kinematify.validation.run.needs import stages_of

        # Its imports take a second, on another core than the inference.
        start_server(stages_of(DEFAULT_ENGINES))
    blueprint, inference = made.blueprint, None
    if inferred:
        from kinematify.pipeline.infer_assembly import infer

        inference = infer(
            blueprint.assembly, config=config, progress=lambda stage, done: progress(stage, _INFERRED * done)
        )
    models: list[KinematicModel] = []

    def write(folder: Path) -> None:
        share = _WRITTEN - _INFERRED
        progress("cutting the collision geometry", _INFERRED)
        models.append(write_blueprint(blueprint, folder, config, facts=made.facts))
        write_parts(blueprint, folder / PARTS_FOLDER)
        if preview:
            from kinematify.model.preview import render_preview

            progress("drawing the picture", _INFERRED + 0.4 * share)
            render_preview(models[0], folder / PREVIEW_FILE, config.preview)
        if inference is not None:
            from kinematify.pipeline.record import write_inference_files

            (folder / INFERRED_FOLDER).mkdir()
            write_inference_files(
                inference, folder / INFERRED_FOLDER, preview=preview,
                progress=lambda stage, done: progress(
                    f"the inferred model: {stage}", _INFERRED + share * (0.6 + 0.4 * done)
                ),
            )  # fmt: skip

    write_model_folder(out, write, overwrite=overwrite)
    report = report_on(out, progress, _WRITTEN) if validated else None
    return GeneratedModel(out=out, made=made, model=models[0], inference=inference, report=report)


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
    if words := made.unread:
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
