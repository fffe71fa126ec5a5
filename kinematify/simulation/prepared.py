"""What is in worlds where a robot uses an object: convex pieces, masses that engines can use, all names and joints.

Links and joints have the names, frames, axes and limits of the original.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from kinematify.model.collision_pieces import decomposed
from kinematify.model.masses import prepared_inertials
from kinematify.model.simulable import prepared_joint
from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.robot import Link, LinkMesh, Robot, Shape
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config.validation import PrepareSettings
    from kinematify.model.collision_pieces import Pieces

URDF_FILE = "prepared.urdf"
_MESH_FOLDER = "prepared_meshes"
_NAME = "prepared"  # short, because PyBullet crashes on long names


def prepare(model: Robot, work: Path, settings: PrepareSettings) -> Path:
    """Write the file that engines load into an existing folder; its absolute path, as those of its meshes are."""
    work = work.resolve()
    (work / _MESH_FOLDER).mkdir(exist_ok=True)
    inertials = prepared_inertials(model, settings)
    pieces = decomposed(model, settings)
    links = tuple(
        Link(
            name=link.name,
            inertial=inertials[link.name],
            collisions=_shapes(pieces[link.name], work / _MESH_FOLDER, f"{index:03d}_{_safe(link.name)}"),
        )
        for index, link in enumerate(model.links)
    )
    joints = tuple(prepared_joint(joint, settings) for joint in model.joints)
    write_robot(Robot(name=_NAME, links=links, joints=joints, loops=model.loops), work / URDF_FILE)
    return work / URDF_FILE


def _shapes(pieces: Pieces, folder: Path, stem: str) -> tuple[Shape, ...]:
    """Primitives as they are, and convex pieces, written as OBJ."""
    shapes = list(pieces.primitives)
    for number, piece in enumerate(pieces.convex):
        path = folder / f"{stem}_{number:03d}.obj"  # MuJoCo takes meshes with the same base name for one mesh
        write_obj(path, piece.vertices, piece.faces, OBJ_DIGITS)
        shapes.append(Shape(mesh=LinkMesh(vertices=piece.vertices, faces=piece.faces), file=path))
    return tuple(shapes)


def _safe(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9_-]", "_", name)[:60]
