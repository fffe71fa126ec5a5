"""The stage `prepare`: it tells no checks, it writes what the engine stages load."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from lxml import etree

from kinematify.model import urdf_elements as document
from kinematify.model.collision_pieces import Pieces, decomposed
from kinematify.model.masses import prepared_inertials
from kinematify.simulation.prepared import URDF_FILE, Prepared, PreparedLink, write_record
from kinematify.validation.left_model import model_of

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config.validation import PrepareSettings
    from kinematify.model.masses import PreparedInertial
    from kinematify.robot.declared import DeclaredLink, DeclaredModel
    from kinematify.validation.stage import Recorder, StageRequest

_MESH_FOLDER = "prepared_meshes"


def run(request: StageRequest, recorder: Recorder) -> None:
    """Write `prepared.urdf` and `prepared.json` (`kinematify.simulation.prepared`)."""
    del recorder  # what was changed is told by the checks that look at it
    model = model_of(request)
    prepare(model, request.work, request.settings.prepare)


def prepare(model: DeclaredModel, work: Path, settings: PrepareSettings) -> Prepared:
    """Write the file that engines load, and its record, into an existing folder."""
    work = work.resolve()
    (work / _MESH_FOLDER).mkdir(exist_ok=True)
    inertials = prepared_inertials(model, settings)
    shapes = decomposed(model, settings)
    robot = document.robot_element()
    for index, link in enumerate(model.links):
        element = document.add_link(robot, link.name, inertials[link.name])
        _add_collision(element, shapes[link.name], work / _MESH_FOLDER, f"{index:03d}_{_safe(link.name)}")
    for joint in model.joints:
        document.add_joint(robot, joint, settings)
    etree.ElementTree(robot).write(work / URDF_FILE, pretty_print=True, xml_declaration=True, encoding="utf-8")
    prepared = Prepared(
        urdf=work / URDF_FILE,
        links=tuple(_record(link, shapes[link.name], inertials[link.name]) for link in model.links),
        drives_added=tuple(joint.name for joint in model.joints if document.lacks_drive(joint)),
    )
    write_record(prepared, work)
    return prepared


def _add_collision(element: etree._Element, pieces: Pieces, folder: Path, stem: str) -> None:
    for shape in pieces.primitives:
        document.add_primitive(element, shape)
    for number, piece in enumerate(pieces.convex):
        # MuJoCo takes meshes with the same base name for one mesh.
        document.add_piece(element, piece, folder / f"{stem}_{number:03d}.obj")


def _safe(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9_-]", "_", name)[:60]


def _record(link: DeclaredLink, pieces: Pieces, inertial: PreparedInertial) -> PreparedLink:
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
