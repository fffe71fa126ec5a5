"""Input of the stages of a run, each a group of checks in a process of its own, and the model that one leaves them."""

from __future__ import annotations

import pickle
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.config.validation import ValidationSettings
    from kinematify.manipulation.plan_request import PriorFinding, TaskRequest
    from kinematify.robot.robot import Robot
    from kinematify.validation.validated_file import ValidatedFile

_LEFT = "model.pickle"
"""In the folder of the run, which nobody else writes to."""


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


def cache_model(model: Robot, work: Path) -> None:
    """Leave a model for the later stages of a run, so that they need not parse its meshes again."""
    partly = work / f"{_LEFT}.partly"
    with partly.open("wb") as file:
        pickle.dump(model, file, protocol=pickle.HIGHEST_PROTOCOL)
    partly.replace(work / _LEFT)  # a stage that is stopped leaves no half of it


def has_model(work: Path) -> bool:
    """True if a stage of the run with this folder left the model."""
    return (work / _LEFT).is_file()


def model_of(request: StageRequest) -> Robot:
    """Read the model of a run: what an earlier stage left, or else the files.

    Raises:
        DescriptionError: As for `read_robot`.
    """
    return _loaded(request.work / _LEFT) or read_robot(request.urdf, package_dirs=request.package_dirs)


def _loaded(path: Path) -> Robot | None:
    if not path.is_file():
        return None
    with path.open("rb") as file:
        model: Robot = pickle.load(file)
    return model
