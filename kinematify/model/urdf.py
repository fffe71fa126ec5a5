"""Writing a model as URDF with one OBJ per mesh, in the subset that every engine reads the same way."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.joints.candidate import JointType
from kinematify.model.output import MODEL_FILE
from kinematify.model.palette import link_colors

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from kinematify.assembly.part import Part
    from kinematify.model.kinematic_model import Inertial, Joint, KinematicModel, Link
    from kinematify.robot.arrays import FloatArray

MESH_FOLDER = "meshes"
_MAX_STEM = 100  # file systems end at 255 bytes for a name
_DIGITS = 10  # one more than a float32 needs; the error is 1e-10 of a coordinate


@dataclass(frozen=True)
class _Mesh:
    """A mesh on its way to a file."""

    path: str
    """Relative to the URDF's folder."""
    part: Part
    """World coordinates."""


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
    colors = link_colors(model)
    robot = etree.Element("robot", name=model.name)
    for link in model.links:
        material = etree.SubElement(robot, "material", name=_material(link))
        etree.SubElement(material, "color", rgba=_numbers([*np.round(colors[link.name], 4), 1.0]))
    (folder / MESH_FOLDER).mkdir(exist_ok=True)
    taken: set[str] = set()
    for link in model.links:
        _add_link(robot, link, folder, taken)
    for joint in model.joints:
        _add_joint(robot, joint)
    path = folder / MODEL_FILE
    etree.ElementTree(robot).write(path, pretty_print=True, xml_declaration=True, encoding="utf-8")
    return path


def _material(link: Link) -> str:
    return f"{link.name}_color"


def _add_link(robot: etree._Element, link: Link, folder: Path, taken: set[str]) -> None:
    element = etree.SubElement(robot, "link", name=link.name)
    _add_inertial(element, link.inertial)
    origin = link.T_world_link[:3, 3]
    visual = _mesh(link.visual, taken)
    # A set-aside part may have no face at all: engines refuse such a file, and there is nothing to see.
    visuals = [visual, *(_mesh(part, taken) for part in link.fixed_visuals if len(part.faces))]
    collisions = [_mesh(part, taken) for part in link.collision_parts] or [visual]
    for mesh in {mesh.path: mesh for mesh in (*visuals, *collisions)}.values():
        _write_obj(mesh.part, origin, folder / mesh.path)
    for mesh in visuals:
        etree.SubElement(_add_geometry(element, "visual", mesh), "material", name=_material(link))
    for mesh in collisions:
        _add_geometry(element, "collision", mesh)


def _mesh(part: Part, taken: set[str]) -> _Mesh:
    """Choose a file name that is safe and distinct on every file system."""
    stem = re.sub(r"[^A-Za-z0-9_-]", "_", part.name)[:_MAX_STEM] or "part"
    name, number = stem, 1
    while name.casefold() in taken:
        number += 1
        name = f"{stem}_{number}"
    taken.add(name.casefold())
    return _Mesh(path=f"{MESH_FOLDER}/{name}.obj", part=part)


def _write_obj(part: Part, origin: FloatArray, path: Path) -> None:
    """Write a mesh in the link frame; link frames have world orientation."""
    used, inverse = np.unique(part.faces, return_inverse=True)
    vertices = part.vertices[used] - origin
    faces = inverse.reshape(-1, 3) + 1
    with path.open("w", encoding="ascii") as file:
        file.writelines(f"v {x:.{_DIGITS}g} {y:.{_DIGITS}g} {z:.{_DIGITS}g}\n" for x, y, z in vertices.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in faces.tolist())


def _add_inertial(element: etree._Element, inertial: Inertial) -> None:
    block = etree.SubElement(element, "inertial")
    etree.SubElement(block, "origin", xyz=_numbers(inertial.center_of_mass), rpy="0 0 0")
    etree.SubElement(block, "mass", value=_numbers([inertial.mass]))
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = inertial.tensor.tolist()
    moments = {"ixx": ixx, "ixy": ixy, "ixz": ixz, "iyy": iyy, "iyz": iyz, "izz": izz}
    etree.SubElement(block, "inertia", {key: _numbers([value]) for key, value in moments.items()})


def _add_geometry(element: etree._Element, tag: str, mesh: _Mesh) -> etree._Element:
    block = etree.SubElement(element, tag)
    etree.SubElement(block, "origin", xyz="0 0 0", rpy="0 0 0")
    etree.SubElement(etree.SubElement(block, "geometry"), "mesh", filename=mesh.path)
    return block


def _add_joint(robot: etree._Element, joint: Joint) -> None:
    element = etree.SubElement(robot, "joint", name=joint.name, type=joint.kind.value)
    etree.SubElement(element, "parent", link=joint.parent)
    etree.SubElement(element, "child", link=joint.child)
    etree.SubElement(element, "origin", xyz=_numbers(joint.T_parent_child[:3, 3]), rpy="0 0 0")
    if joint.kind is JointType.FIXED:
        return
    etree.SubElement(element, "axis", xyz=_numbers(joint.axis))
    limit = {"effort": joint.effort, "velocity": joint.velocity}
    if joint.kind is not JointType.CONTINUOUS:
        limit = {"lower": joint.lower, "upper": joint.upper, **limit}
    etree.SubElement(element, "limit", {key: _numbers([value]) for key, value in limit.items()})


def _numbers(values: Iterable[float]) -> str:
    """Shortest text that reads back as the same float64."""
    return " ".join(repr(float(value) + 0.0) for value in values)
