"""URDF again, with collision geometry that engines can use, for those who load the file without `kinematify`."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace
from typing import TYPE_CHECKING

from lxml import etree

from kinematify.model.simulable import prepared_joint
from kinematify.robot.mesh_folder import MeshFiles, with_files
from kinematify.robot.write import robot_element

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.formats.content import Content


def write_urdf(content: Content, out: Path, *, free: bool) -> None:
    """Write a URDF file and a folder with its meshes.

    Links, joints and what is seen stay as they are; what collides becomes primitives and convex pieces. Masses that
    the model lacks are those of its volume, and joints without effort or velocity get the ones of the configuration.

    Args:
        content: What to write.
        out: The file.
        free: Not used: a URDF does not say whether its root is fixed.

    Raises:
        OSError: It cannot be written.
    """
    del free
    meshes = MeshFiles(out)
    # URDF has no capsule: its triangles represent it.
    links = tuple(with_files(link, meshes, ("mesh", "capsule")) for link in content.robot.links)
    joints = tuple(prepared_joint(joint, content.settings) for joint in content.robot.joints)
    document = robot_element(replace(content.robot, links=links, joints=joints))
    owners = {(str(element.tag), element.get("name")): element for element in document}
    for tag, name, element in content.extensions.elements:
        (document if tag == "robot" else owners[tag, name]).append(deepcopy(element))
    etree.indent(document)
    etree.ElementTree(document).write(out, pretty_print=True, xml_declaration=True, encoding="utf-8")
