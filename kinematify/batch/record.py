"""What is known of each object of a batch: one record, one line of the manifest."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from pydantic import TypeAdapter

SCHEMA = 1


@dataclass(frozen=True, kw_only=True)
class ObjectRecord:
    """What became of an object."""

    object: str
    """Its name: that of its folder in the output."""
    source: str
    """Path or URL."""
    status: Literal["ok", "unusable", "error", "timeout", "crash"]
    """``ok``: all steps were done; ``unusable``: the input cannot be read; ``error``: an engine, the machine or
    Kinematify failed; ``timeout``; ``crash``: set aside after it has cost several workers."""
    error: str = ""
    """Why it is not ok."""
    verdict: Literal["pass", "warn", "fail"] | None = None
    """Of its validation."""
    seconds: float
    """Wall time, of the last worker that had it [s]."""
    step_seconds: dict[str, float] = field(default_factory=dict)
    """Wall time by step [s]."""
    peak_mb: float | None = None
    """Most memory of the worker while it had the object [MB], without the stages of a validation, which have processes
    and limits of their own. None where the worker did not live to tell."""
    parts: int | None = None
    faces: int | None = None
    joints: int | None = None
    """Joints that move."""
    content: str = ""
    """Hash of the files; empty where they could not be read."""
    configuration: str
    """Hash of all that was asked for, and of the version of Kinematify."""
    schema: int = SCHEMA

    @property
    def failed(self) -> bool:
        """Whether a user has to look at it: no model, or one with an error."""
        return self.status != "ok" or self.verdict == "fail"


RECORD = TypeAdapter(ObjectRecord)
