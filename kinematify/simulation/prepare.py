"""Write what engines load: convex pieces, masses and inertias that they can use, names and joints as in the file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from kinematify.model.collision_pieces import Pieces, decomposed
from kinematify.model.masses import prepared_inertials
from kinematify.model.simulable import lacks_drive, prepared_joint
from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.robot import Link, LinkMesh, Robot, Shape
from kinematify.robot.write import write_robot
from kinematify.simulation.prepared import URDF_FILE, Prepared, PreparedLink, write_record

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config.validation import PrepareSettings
    from kinematify.model.masses import PreparedInertial

_MESH_FOLDER = "prepared_meshes"
_NAME = "prepared"  # short, because PyBullet crashes on long names


def prepare(model: Robot, work: Path, settings: PrepareSettings) -> Prepared:
    """Write the file that engines load, and its record, into an existing folder."""
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
    write_robot(Robot(name=_NAME, links=links, joints=joints), work / URDF_FILE)
    prepared = Prepared(
        urdf=work / URDF_FILE,
        links=tuple(_record(link, pieces[link.name], inertials[link.name]) for link in model.links),
        drives_added=tuple(joint.name for joint in model.joints if lacks_drive(joint)),
    )
    write_record(prepared, work)
    return prepared


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


def _record(link: Link, pieces: Pieces, inertial: PreparedInertial) -> PreparedLink:
    return PreparedLink(
        link=link.name,
        method=pieces.method,
        from_visual=bool(link.visuals) and not link.collisions,
        pieces=len(pieces.primitives) + len(pieces.convex),
        gap=pieces.gap,
        volume_error=pieces.volume_error,
        mass=inertial.mass,
        mass_added=inertial.mass_added,
        inertia_added=inertial.inertia_added,
    )
