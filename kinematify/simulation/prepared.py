"""What is in worlds where a robot uses an object: convex pieces, masses that engines can use, all names and joints.

`prepare` writes `prepared.urdf` and returns what was changed to make the file loadable.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from kinematify.model.collision_pieces import Method, Pieces, decomposed
from kinematify.model.masses import prepared_inertials
from kinematify.model.simulable import prepared_joint
from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.robot import Link, LinkMesh, Robot, Shape
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config.validation import PrepareSettings
    from kinematify.model.masses import PreparedInertial

URDF_FILE = "prepared.urdf"


@dataclass(frozen=True, kw_only=True)
class PreparedLink:
    """A link as the engines get it."""

    link: str
    method: Method
    """The most work that one of its shapes needed."""
    pieces: int
    """Convex pieces and primitives."""
    gap: float
    """How far the pieces reach beyond the declared surface at most [m]."""
    volume_error: float | None
    """Volume of the pieces over that of the declared geometry, less one; None where a mesh encloses none."""
    mass: float
    """[kg]."""
    mass_added: bool
    """True if the file has no mass that engines can use; `mass` is then made up."""
    inertia_added: bool
    """True if the file has no inertia that engines can use, or one that had to be changed by more than rounding."""


@dataclass(frozen=True, kw_only=True)
class Prepared:
    """The record of `prepared.urdf`. Links and joints have the names, frames, axes and limits of the original."""

    urdf: Path
    """Absolute; mesh paths in it are absolute too."""
    links: tuple[PreparedLink, ...]
    """In the order of the document."""

    @cached_property
    def link_by_name(self) -> dict[str, PreparedLink]:
        """Links keyed by name."""
        return {link.link: link for link in self.links}


_MESH_FOLDER = "prepared_meshes"
_NAME = "prepared"  # short, because PyBullet crashes on long names


def prepare(model: Robot, work: Path, settings: PrepareSettings) -> Prepared:
    """Write the file that engines load into an existing folder, and return its record."""
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
    return Prepared(
        urdf=work / URDF_FILE,
        links=tuple(_record(link, pieces[link.name], inertials[link.name]) for link in model.links),
    )


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
        pieces=len(pieces.primitives) + len(pieces.convex),
        gap=pieces.gap,
        volume_error=pieces.volume_error,
        mass=inertial.mass,
        mass_added=inertial.mass_added,
        inertia_added=inertial.inertia_added,
    )
