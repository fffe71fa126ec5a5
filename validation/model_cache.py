"""The model of a run, read once: the first stage that has it leaves it for the later ones."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.read import read_robot
from kinematify.robot.robot import LinkMesh

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.robot import Link, Robot, Shape
    from kinematify.validation.stage import StageRequest

_THIN = "thin.pickle"
_LEFT = "model.pickle"
"""In the folder of the run, which nobody else writes to."""


def cache_model(model: Robot, work: Path, name: str = _LEFT) -> None:
    """Leave a model for the later stages of a run, so that they need not parse its meshes again."""
    partly = work / f"{name}.partly"
    with partly.open("wb") as file:
        pickle.dump(model, file, protocol=pickle.HIGHEST_PROTOCOL)
    partly.replace(work / name)  # a stage that is stopped leaves no half of it


def has_model(work: Path) -> bool:
    """True if a stage of the run with this folder left the model."""
    return (work / _LEFT).is_file()


def model_of(request: StageRequest) -> Robot:
    """Read the model of a run: what an earlier stage left, or else the files.

    Raises:
        DescriptionError: As for `read_robot`.
    """
    return _loaded(request.work / _LEFT) or read_robot(request.urdf, package_dirs=request.package_dirs)


def thin_model_of(request: StageRequest) -> Robot:
    """Read the model of a run for sweeps: its meshes have at most `geometry.most_faces` triangles each.

    Raises:
        DescriptionError: As for `read_robot`.
    """
    within_a_run = has_model(request.work)
    thin = _loaded(request.work / _THIN) if within_a_run else None
    if thin is None:
        model, most = model_of(request), request.settings.geometry.most_faces
        thin = replace(model, links=tuple(_thin_link(link, most) for link in model.links))
        if within_a_run:
            cache_model(thin, request.work, _THIN)
    return thin


def _loaded(path: Path) -> Robot | None:
    if not path.is_file():
        return None
    with path.open("rb") as file:
        model: Robot = pickle.load(file)
    return model


def _thin_link(link: Link, most: int) -> Link:
    return replace(
        link,
        visuals=tuple(_thin(shape, most) for shape in link.visuals),
        collisions=tuple(_thin(shape, most) for shape in link.collisions),
    )


def _thin(shape: Shape, most: int) -> Shape:
    if len(shape.mesh.faces) <= most:
        return shape
    import fast_simplification  # noqa: PLC0415 - for large meshes only

    from kinematify.geometry.solid import merged_corners  # noqa: PLC0415

    vertices, faces = merged_corners(np.asarray(shape.mesh.vertices), np.asarray(shape.mesh.faces))
    if len(faces) > most:
        vertices, faces = fast_simplification.simplify(vertices, faces, target_count=most)
    return replace(shape, mesh=LinkMesh(vertices=vertices.astype(np.float64), faces=faces.astype(np.int64)))
