"""From a `Robot` to a URDF: one tag per line, every number with all its digits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rpy_of
from kinematify.robot.urdf_geometry import SIZES

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Inertial, Joint, Link, LoopJoint, Robot, Shape


DRAKE = "http://drake.mit.edu"
"""Namespace of the elements that Drake adds to URDF, some of which other engines read as well."""


def write_robot(robot: Robot, path: Path) -> Path:
    """Write a URDF file, without the meshes: each mesh shape names its own file, as it is to stand in the URDF.

    Raises:
        OSError: It cannot be written.
        ValueError: A mesh shape names no file.
    """
    etree.ElementTree(robot_element(robot)).write(path, pretty_print=True, xml_declaration=True, encoding="utf-8")
    return path


def robot_element(robot: Robot) -> _Element:
    """Return the document that `write_robot` writes.

    Raises:
        ValueError: A mesh shape names no file.
    """
    element = etree.Element("robot", {"name": robot.name}, nsmap={"drake": DRAKE} if robot.loops else None)
    for link in robot.links:
        _add_link(element, link)
    for joint in robot.joints:
        _add_joint(element, joint)
    for loop in robot.loops:
        _add_loop(element, loop)
    return element


def numbers(values: Iterable[float]) -> str:
    """Shortest text that reads back as the same float64."""
    return " ".join(repr(float(value) + 0.0) for value in values)


def _add_link(robot: _Element, link: Link) -> None:
    element = etree.SubElement(robot, "link", name=link.name)
    if link.inertial is not None:
        _add_inertial(element, link.inertial)
    for number, shape in enumerate(link.visuals):
        visual = _add_shape(element, "visual", shape, link.name)
        if shape.color is not None:
            # Readers take materials of one name for one, so that every shape has one of its own.
            material = etree.SubElement(visual, "material", name=f"{link.name}_{number}")
            etree.SubElement(material, "color", rgba=numbers(shape.color))
    for shape in link.collisions:
        _add_shape(element, "collision", shape, link.name)


def _add_inertial(link: _Element, inertial: Inertial) -> None:
    element = etree.SubElement(link, "inertial")
    etree.SubElement(element, "origin", xyz=numbers(inertial.center_of_mass), rpy="0 0 0")
    etree.SubElement(element, "mass", value=numbers([inertial.mass]))
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = inertial.tensor.tolist()
    moments = {"ixx": ixx, "ixy": ixy, "ixz": ixz, "iyy": iyy, "iyz": iyz, "izz": izz}
    etree.SubElement(element, "inertia", {key: numbers([value]) for key, value in moments.items()})


def _add_shape(link: _Element, tag: str, shape: Shape, name: str) -> _Element:
    element = etree.SubElement(link, tag)
    _add_origin(element, shape.T_link_shape)
    geometry = etree.SubElement(element, "geometry")
    if shape.kind == "mesh":
        if shape.file is None:
            raise ValueError(f"A mesh of the link {name} has no file. Write it, and name the file in the shape.")
        mesh = etree.SubElement(geometry, "mesh", filename=shape.file.as_posix())
        if (shape.scale != 1.0).any():
            mesh.set("scale", numbers(shape.scale))
    elif shape.kind == "box":
        etree.SubElement(geometry, "box", size=numbers(shape.size))
    else:
        sizes = zip(SIZES[shape.kind], shape.size, strict=True)
        etree.SubElement(geometry, shape.kind, {key: numbers([value]) for key, value in sizes})
    return element


def _add_joint(robot: _Element, joint: Joint) -> None:
    element = etree.SubElement(robot, "joint", name=joint.name, type=joint.kind.value)
    etree.SubElement(element, "parent", link=joint.parent)
    etree.SubElement(element, "child", link=joint.child)
    _add_origin(element, joint.T_parent_child)
    if joint.kind is JointType.FIXED:
        return
    etree.SubElement(element, "axis", xyz=numbers(joint.axis))
    limit = {"lower": joint.lower, "upper": joint.upper} if np.isfinite(joint.upper - joint.lower) else {}
    _add_values(element, "limit", {**limit, "effort": joint.effort, "velocity": joint.velocity})
    _add_values(element, "dynamics", {"damping": joint.damping, "friction": joint.friction})
    if joint.mimic is not None:
        rule = {"multiplier": numbers([joint.mimic.multiplier]), "offset": numbers([joint.mimic.offset])}
        etree.SubElement(element, "mimic", {"joint": joint.mimic.joint, **rule})


def _add_loop(robot: _Element, loop: LoopJoint) -> None:
    """As Drake reads it. Isaac Sim's `loop_joint` says the same, but Drake refuses a file that has one."""
    element = etree.SubElement(robot, drake_tag("ball_constraint"), name=loop.name)
    for end, link, point, place in zip("AB", loop.links, loop.points, ("AP", "BQ"), strict=True):
        etree.SubElement(element, drake_tag(f"ball_constraint_body_{end}"), name=link)
        etree.SubElement(element, drake_tag(f"ball_constraint_p_{place}"), value=numbers(point))


def drake_tag(name: str) -> str:
    """Return the name of an element that Drake adds to URDF, as lxml writes it."""
    return f"{{{DRAKE}}}{name}"


def _add_values(parent: _Element, tag: str, values: dict[str, float | None]) -> None:
    given = {key: numbers([value]) for key, value in values.items() if value is not None}
    if given:
        etree.SubElement(parent, tag, given)


def _add_origin(parent: _Element, transform: FloatArray) -> None:
    etree.SubElement(parent, "origin", xyz=numbers(transform[:3, 3]), rpy=numbers(rpy_of(transform[:3, :3])))
