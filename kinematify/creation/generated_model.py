"""A model folder that was generated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.generate.delivery import BuildResult
    from kinematify.generate.providers.language_model import Written
    from kinematify.generate.providers.source import Generated
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.inference import Inference
    from kinematify.validation.run.report import ValidationReport


@dataclass(frozen=True, kw_only=True)
class GeneratedModel:
    """A model folder that was written."""

    out: Path
    model: KinematicModel
    report: ValidationReport | None
    made: BuildResult | None = None
    """What was built, with what is not as asked; None where parts came from another generator."""
    inference: Inference | None = None
    """Joints inferred from the parts alone, where that was asked for or nothing else is known of them."""
    written: Written | None = None
    """What a language model answered."""
    parts: Generated | None = None
    """What another generator made."""

    @property
    def exit_status(self) -> int:
        """1 if the model has an error or is not as asked, 130 if the validation was interrupted, else as `validate`."""
        if self.report is not None and self.report.interrupted:
            return ExitStatus.INTERRUPTED
        judged = 0 if self.report is None else self.report.exit_status
        return judged or (0 if self.made is None or self.made.is_complete else ExitStatus.FAILURES)


def job_folder(out: Path) -> Path:
    """Beside the model: it stays, so that the same request never costs anything again."""
    return out.parent / f"{out.name}.job"


def not_as_asked(made: BuildResult) -> str:
    """Return what differs from the request and which words were not read; empty if nothing."""
    lines = [f"Not as asked: {'; '.join(made.differences)}"] if made.differences else []
    if words := made.unread:
        lines.append(f"Words not read: {'; '.join(map(repr, dict.fromkeys(words)))}")
    return "\n".join(lines)
