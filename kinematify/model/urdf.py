"""Writing a model as URDF with one OBJ per mesh, in the subset that every engine reads the same way."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.model.output import MODEL_FILE
from kinematify.model.palette import link_colors
from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.robot import Link, LinkMesh, Robot, Shape
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from kinematify.assembly.part import Part
    from kinematify.model.kinematic_model import KinematicModel, ModelLink
    from kinematify.robot.appearance import Rgba
    from kinematify.robot.arrays import FloatArray

MESH_FOLDER = "meshes"
_MAX_STEM = 100  # file systems end at 255 bytes for a name


def write_urdf(model: KinematicModel, folder: Path) -> Path:
    """Write ``model.urdf`` and ``meshes/*.obj`` into an existing folder.

    Meshes stand in their link's frame, so visual and collision origins are zero. Link and joint frames are written
    with all digits: forward kinematics at zero reproduces the input.

    Args:
        model: What to write.
        folder: An existing folder.

    Returns:
        The path of the URDF.

    Raises:
        OSError: The folder cannot be written.
    """
    return write_model(model_robot(model), folder)


def write_model(robot: Robot, folder: Path) -> Path:
    """Write ``model.urdf`` and the meshes that its shapes name, relative to it, into an existing folder.

    Raises:
        OSError: The folder cannot be written.
        ValueError: A mesh shape names no file.
    """
    (folder / MESH_FOLDER).mkdir(exist_ok=True)
    shapes = (shape for link in robot.links for shape in (*link.visuals, *link.collisions))
    for file, mesh in {shape.file: shape.mesh for shape in shapes if shape.file is not None}.items():
        write_obj(folder / file, mesh.vertices, mesh.faces, OBJ_DIGITS, mesh.appearance)
    return write_robot(robot, folder / MODEL_FILE)


def model_robot(model: KinematicModel) -> Robot:
    """Return the model as its URDF describes it; mesh files are named, relative to the URDF, and not written yet."""
    colors = link_colors(model)
    taken: set[str] = set()
    return Robot(
        name=model.name,
        links=tuple(_link(link, np.round(colors[link.name], 4), taken) for link in model.links),
        joints=model.joints,
        loops=model.loops,
    )


def _link(link: ModelLink, color: FloatArray, taken: set[str]) -> Link:
    origin = link.T_world_link[:3, 3]
    # A set-aside part may have no face at all: engines refuse such a file, and there is nothing to see.
    shown = [link.visual, *(part for part in link.fixed_visuals if len(part.faces))]
    visuals = tuple(_shape(part, origin, taken, _color(part, color)) for part in shown)
    return Link(
        name=link.name,
        inertial=link.inertial,
        visuals=visuals,
        collisions=tuple(_shape(part, origin, taken) for part in link.collision_parts) or visuals[:1],
    )


def _color(part: Part, usual: FloatArray) -> Rgba:
    """The one colour of a mesh that is written beside its materials, for readers that know no others."""
    red, green, blue = (round(value, 4) for value in part.color or usual.tolist())
    opacity = 1.0 if part.appearance is None else part.appearance.mean_color(part.vertices, part.faces)[3]
    return red, green, blue, round(opacity, 4)


def _shape(part: Part, origin: FloatArray, taken: set[str], color: Rgba | None = None) -> Shape:
    """A mesh in the link frame, which has world orientation, with a file name that is distinct on every file system."""
    used, inverse = np.unique(part.faces, return_inverse=True)
    stem = re.sub(r"[^A-Za-z0-9_-]", "_", part.name)[:_MAX_STEM] or "part"
    name, number = stem, 1
    while name.casefold() in taken:
        number += 1
        name = f"{stem}_{number}"
    taken.add(name.casefold())
    return Shape(
        mesh=LinkMesh(vertices=part.vertices[used] - origin, faces=inverse.reshape(-1, 3), appearance=part.appearance),
        file=Path(MESH_FOLDER, f"{name}.obj"),
        color=color,
    )
