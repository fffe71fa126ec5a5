"""The model of a run, read once: the first stage that has it leaves it for the later ones."""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING

from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.robot import Robot
    from kinematify.validation.stage import StageRequest

_LEFT = "model.pickle"
"""In the folder of the run, which nobody else writes to."""


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
