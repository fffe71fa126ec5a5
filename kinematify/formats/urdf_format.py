"""URDF again, with collision geometry that engines can use, for those who load the file without `kinematify`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.formats.mesh_files import MeshFiles
from kinematify.model.urdf_elements import add_joint, add_link, numbers, roll_pitch_yaw

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.formats.content import Content, Shape

_CAPSULE = "capsule"


def write_urdf(content: Content, out: Path, *, free: bool) -> tuple[str, ...]:
    """Write a URDF file and a folder with its meshes.

    Links, joints and what is seen stay as they are; what collides becomes primitives and convex pieces. Masses that
    the model lacks are those of its volume, and joints without effort or velocity get the ones of the configuration.

    Args:
        content: What to write.
        out: The file.
        free: Not used: a URDF does not say whether its root is fixed.

    Returns:
        What the format cannot hold: nothing.

    Raises:
        OSError: It cannot be written.
    """
    del free
    meshes = MeshFiles(out)
    robot = etree.Element("robot", name=content.name)
    for body in content.bodies:
        link = add_link(robot, body.name, body.inertial)
        if body.inertial.mass <= 0.0:  # a mere frame
            link.remove(link[0])
        for number, shape in enumerate(body.visuals):
            visual = _add_shape(link, "visual", shape, body.name, meshes)
            material = etree.SubElement(visual, "material", name=f"{body.name}_{number}")
            etree.SubElement(material, "color", rgba=numbers(shape.color))
        for shape in body.collisions:
            _add_shape(link, "collision", shape, body.name, meshes)
    for joint in content.joints:
        add_joint(robot, joint, content.settings)
    etree.ElementTree(robot).write(out, pretty_print=True, xml_declaration=True, encoding="utf-8")
    return ()


def _add_shape(link: _Element, tag: str, shape: Shape, name: str, meshes: MeshFiles) -> _Element:
    element = etree.SubElement(link, tag)
    primitive = shape.kind not in ("mesh", _CAPSULE)  # URDF has no capsule: its triangles stand in its link's frame
    T = shape.T_link_shape if primitive else np.eye(4)
    etree.SubElement(element, "origin", xyz=numbers(T[:3, 3]), rpy=numbers(roll_pitch_yaw(T[:3, :3])))
    geometry = etree.SubElement(element, "geometry")
    if not primitive:
        etree.SubElement(geometry, "mesh", filename=f"{meshes.folder.name}/{meshes.write(shape, name)}")
    elif shape.kind == "box":
        etree.SubElement(geometry, "box", size=numbers(shape.size))
    else:
        sizes = dict(zip(("radius", "length"), (numbers([value]) for value in shape.size), strict=False))
        etree.SubElement(geometry, shape.kind, sizes)
    return element
