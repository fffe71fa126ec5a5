"""SDFormat, the language of Gazebo: links in the frame of the model, joints in the frame of their child."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.formats.content import GREY, WORLD, MeshFiles, body_name
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rpy_of
from kinematify.robot.write import numbers

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.formats.content import Content
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint, Link, Shape

_VERSION = "1.11"  # the first that knows followers
_ENDLESS = 1e16  # the value that SDFormat takes for no limit


def write_sdf(content: Content, out: Path, *, free: bool) -> None:
    """Write an SDF file and a folder with its meshes; arguments and errors as for `write_mjcf`."""
    meshes = MeshFiles(out)
    document = etree.Element("sdf", version=_VERSION)
    model = etree.SubElement(document, "model", name=content.robot.name)
    poses = _at_zero(content)
    if not free:
        fixed = etree.SubElement(model, "joint", name="world_joint", type="fixed")
        etree.SubElement(fixed, "parent").text = WORLD
        etree.SubElement(fixed, "child").text = body_name(content.robot.root)
    for link in content.robot.links:
        _add_link(model, link, poses[link.name], meshes)
    for joint in content.robot.joints:
        _add_joint(model, joint)
    for loop in content.robot.loops:
        (first, second), (_, point) = loop.links, loop.points
        closing = etree.SubElement(model, "joint", name=loop.name, type="ball")
        etree.SubElement(closing, "pose").text = f"{numbers(point)} 0 0 0"  # in the frame of the child
        etree.SubElement(closing, "parent").text = body_name(first)
        etree.SubElement(closing, "child").text = body_name(second)
    etree.ElementTree(document).write(out, pretty_print=True, xml_declaration=True, encoding="utf-8")


def _at_zero(content: Content) -> dict[str, FloatArray]:
    """Where links stand with all joints at zero, followers too: SDFormat counts from there."""
    poses = {content.robot.root: np.eye(4)}
    for joint in content.robot.joints_downward:
        poses[joint.child] = poses[joint.parent] @ joint.T_parent_child
    return poses


def _pose(parent: _Element, T: FloatArray) -> None:
    etree.SubElement(parent, "pose").text = f"{numbers(T[:3, 3])} {numbers(rpy_of(T[:3, :3]))}"


def _add_link(model: _Element, link: Link, T_model_link: FloatArray, meshes: MeshFiles) -> None:
    element = etree.SubElement(model, "link", name=body_name(link.name))
    _pose(element, T_model_link)
    if link.inertial is not None:
        inertial = etree.SubElement(element, "inertial")
        T = np.eye(4)
        T[:3, 3] = link.inertial.center_of_mass
        _pose(inertial, T)
        etree.SubElement(inertial, "mass").text = numbers([link.inertial.mass])
        inertia, names = etree.SubElement(inertial, "inertia"), "xyz"
        for row, column in zip(*np.triu_indices(3), strict=True):
            moment = link.inertial.tensor[row, column]
            etree.SubElement(inertia, f"i{names[row]}{names[column]}").text = numbers([moment])
    for kind, shapes in (("visual", link.visuals), ("collision", link.collisions)):
        for number, shape in enumerate(shapes):
            block = etree.SubElement(element, kind, name=f"{kind}_{number}")
            _add_shape(block, shape, link.name, meshes)
            if kind == "visual" and not (shape.mesh.appearance and len(shape.mesh.appearance.materials) > 1):
                material = etree.SubElement(block, "material")
                for name in ("ambient", "diffuse"):
                    etree.SubElement(material, name).text = numbers(shape.color or GREY)


def _add_shape(element: _Element, shape: Shape, link: str, meshes: MeshFiles) -> None:
    _pose(element, shape.T_link_shape)
    kind = etree.SubElement(etree.SubElement(element, "geometry"), shape.kind)
    if shape.kind == "mesh":
        etree.SubElement(kind, "uri").text = f"{meshes.folder.name}/{meshes.write(shape, link)}"
    elif shape.kind == "box":
        etree.SubElement(kind, "size").text = numbers(shape.size)
    else:
        for name, value in zip(("radius", "length"), shape.size, strict=False):
            etree.SubElement(kind, name).text = numbers([value])


def _add_joint(model: _Element, joint: Joint) -> None:
    element = etree.SubElement(model, "joint", name=joint.name, type=_TYPES[joint.kind])
    etree.SubElement(element, "parent").text = body_name(joint.parent)
    etree.SubElement(element, "child").text = body_name(joint.child)
    if joint.kind is JointType.FIXED:
        return
    axis = etree.SubElement(element, "axis")
    etree.SubElement(axis, "xyz").text = numbers(joint.axis)
    if joint.mimic is not None:
        mimic = etree.SubElement(axis, "mimic", joint=joint.mimic.joint)
        for name, value in (("multiplier", joint.mimic.multiplier), ("offset", joint.mimic.offset), ("reference", 0.0)):
            etree.SubElement(mimic, name).text = numbers([value])
    limit = etree.SubElement(axis, "limit")
    limited = bool(np.isfinite([joint.lower, joint.upper]).all())
    for name, value in (
        ("lower", joint.lower if limited else -_ENDLESS),
        ("upper", joint.upper if limited else _ENDLESS),
    ):
        etree.SubElement(limit, name).text = numbers([value])
    for name, stated in (("effort", joint.effort), ("velocity", joint.velocity)):
        if stated is not None:
            etree.SubElement(limit, name).text = numbers([stated])
    if joint.damping or joint.friction:
        dynamics = etree.SubElement(axis, "dynamics")
        for name, stated in (("damping", joint.damping), ("friction", joint.friction)):
            etree.SubElement(dynamics, name).text = numbers([stated or 0.0])


_TYPES = {
    JointType.FIXED: "fixed",
    JointType.REVOLUTE: "revolute",
    JointType.CONTINUOUS: "continuous",
    JointType.PRISMATIC: "prismatic",
}
