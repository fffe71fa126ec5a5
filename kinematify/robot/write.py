"""From a `Robot` to a URDF: one tag per line, every number with all its digits."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rpy_of
from kinematify.robot.urdf_geometry import SIZES
from kinematify.robot.urdf_numbers import MOMENTS

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


def add(parent: _Element, tag: str, text: float | Iterable[float] | str | None = None, **values: Any) -> _Element:
    """Append an element with a text and attributes: names, or numbers with all their digits; None is left out."""
    element = etree.SubElement(parent, tag, {key: _text(value) for key, value in values.items() if value is not None})
    element.text = None if text is None else _text(text)
    return element


def _text(value: Any) -> str:
    return value if isinstance(value, str) else numbers(np.atleast_1d(value))


def _add_link(robot: _Element, link: Link) -> None:
    element = add(robot, "link", name=link.name)
    if link.inertial is not None:
        inertial = add(element, "inertial")
        add(inertial, "origin", xyz=link.inertial.center_of_mass, rpy="0 0 0")
        add(inertial, "mass", value=link.inertial.mass)
        add(inertial, "inertia", **moments(link.inertial))
    for number, shape in enumerate(link.visuals):
        visual = _add_shape(element, "visual", shape, link.name)
        if shape.color is not None:
            # Readers take materials of one name for one, so that every shape has one of its own.
            add(add(visual, "material", name=f"{link.name}_{number}"), "color", rgba=shape.color)
    for shape in link.collisions:
        _add_shape(element, "collision", shape, link.name)


def moments(inertial: Inertial) -> dict[str, float]:
    """Return the moments of inertia [kg m^2] under the names that URDF and SDFormat have for them."""
    return dict(zip(MOMENTS, inertial.tensor[np.triu_indices(3)].tolist(), strict=True))


def _add_shape(link: _Element, tag: str, shape: Shape, name: str) -> _Element:
    element = add(link, tag)
    _add_origin(element, shape.T_link_shape)
    geometry = add(element, "geometry")
    if shape.kind == "mesh":
        if shape.file is None:
            raise ValueError(f"A mesh of the link {name} has no file. Write it, and name the file in the shape.")
        scale = shape.scale if (shape.scale != 1.0).any() else None
        add(geometry, "mesh", filename=shape.file.as_posix(), scale=scale)
    elif shape.kind == "box":
        add(geometry, "box", size=shape.size)
    else:
        add(geometry, shape.kind, **dict(zip(SIZES[shape.kind], shape.size, strict=True)))
    return element


def _add_joint(robot: _Element, joint: Joint) -> None:
    element = add(robot, "joint", name=joint.name, type=joint.kind.value)
    add(element, "parent", link=joint.parent)
    add(element, "child", link=joint.child)
    _add_origin(element, joint.T_parent_child)
    if joint.kind is JointType.FIXED:
        return
    add(element, "axis", xyz=joint.axis)
    limit = {"lower": joint.lower, "upper": joint.upper} if np.isfinite(joint.upper - joint.lower) else {}
    for tag, values in (
        ("limit", {**limit, "effort": joint.effort, "velocity": joint.velocity}),
        ("dynamics", {"damping": joint.damping, "friction": joint.friction}),
    ):
        if any(value is not None for value in values.values()):
            add(element, tag, **values)
    if joint.mimic is not None:
        add(element, "mimic", **asdict(joint.mimic))


def _add_loop(robot: _Element, loop: LoopJoint) -> None:
    """As Drake reads it. Isaac Sim's `loop_joint` says the same, but Drake refuses a file that has one."""
    element = add(robot, drake_tag("ball_constraint"), name=loop.name)
    for end, link, point, place in zip("AB", loop.links, loop.points, ("AP", "BQ"), strict=True):
        add(element, drake_tag(f"ball_constraint_body_{end}"), name=link)
        add(element, drake_tag(f"ball_constraint_p_{place}"), value=point)


def drake_tag(name: str) -> str:
    """Return the name of an element that Drake adds to URDF, as lxml writes it."""
    return f"{{{DRAKE}}}{name}"


def _add_origin(parent: _Element, transform: FloatArray) -> None:
    add(parent, "origin", xyz=transform[:3, 3], rpy=rpy_of(transform[:3, :3]))
