"""Input of the stages of a run, each a group of checks in a process of its own."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.config.validation import ValidationSettings
    from kinematify.manipulation.plan_request import PriorFinding, TaskRequest
    from kinematify.validation.validated_file import ValidatedFile


@dataclass(frozen=True, kw_only=True)
class StageRequest:
    """Input of every stage; it crosses a process border, so it holds plain data only."""

    urdf: Path
    """The file as the user gave it, or the URDF that represents it."""
    package_dirs: tuple[Path, ...]
    work: Path
    """Folder of this run: stages leave there what later ones need."""
    settings: ValidationSettings
    selected: frozenset[str]
    """Ids of the checks that the user wants."""
    deadline: float
    """`time.process_time()` of the stage's process at which it should be over, which no other program's load changes; a
    stage that is late says what it omitted."""
    task: TaskRequest | None = None
    """What a robot is to do with the object."""
    task_engines: tuple[str, ...] = ()
    """Engines in which its plans are executed."""
    resolved: Path | None = None
    """A copy of the file with every mesh by its absolute path, for engines that find the meshes nowhere else."""
    native: Path | None = None
    """The file that MuJoCo opens in place of `urdf`."""
    apart: frozenset[frozenset[str]] = frozenset()
    """Pairs of links that the file keeps from colliding and `urdf` cannot."""
    losses: tuple[str, ...] = ()
    """What the file holds and `urdf` does not, one sentence each."""
    free_travel: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Range around rest in which nothing collides by exact geometry, of joints where it was measured [rad or m]."""
    doubted: Mapping[str, Sequence[str]] | None = None
    """Checks by exact geometry that speak against a joint, for the stage of the evidence; None where none were made."""
    suspects: Mapping[str, PriorFinding] = field(default_factory=dict)
    """Joints that earlier stages doubt, for the stage of the task."""
    source: ValidatedFile | None = None
    """The file, which is written into findings."""

    @property
    def remaining(self) -> float:
        """Seconds of processor time until the deadline, at least 0."""
        return max(0.0, self.deadline - time.process_time())
