"""SDFormat, the language of Gazebo: links in the frame of the model, joints in the frame of their child."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.formats.content import GREY, WORLD
from kinematify.robot.joint_type import JointType
from kinematify.robot.mesh_folder import MeshFiles
from kinematify.robot.transforms import rpy_of
from kinematify.robot.write import add, moments

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.formats.content import Content
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint, Link, Shape

_VERSION = "1.11"  # the first that knows followers
_ENDLESS = 1e16  # the value that SDFormat takes for no limit


def write_sdf(content: Content, out: Path, *, free: bool) -> None:
    """Write an SDF file and a folder with its meshes; arguments and errors as for `write_mjcf`."""
    meshes, robot = MeshFiles(out), content.robot
    document = etree.Element("sdf", version=_VERSION)
    model = add(document, "model", name=robot.name)
    if not free:
        _add_joint(model, content.root_joint, "fixed", WORLD, robot.root)
    poses = {robot.root: np.eye(4)}  # with all joints at zero, followers too: SDFormat counts from there
    for joint in robot.joints_downward:
        poses[joint.child] = poses[joint.parent] @ joint.T_parent_child
    for link in robot.links:
        _add_link(model, link, poses[link.name], meshes, content.extensions.surfaces.get(link.name))
    for joint in robot.joints:
        element = _add_joint(model, joint.name, joint.kind.value, joint.parent, joint.child)
        if joint.kind is not JointType.FIXED:
            _add_axis(element, joint, content.extensions.springs.get(joint.name, (None, None)))
    for loop in robot.loops:
        closing = _add_joint(model, loop.name, "ball", *loop.links)
        add(closing, "pose", [*loop.points[1], 0.0, 0.0, 0.0])  # in the frame of the child
    etree.ElementTree(document).write(out, pretty_print=True, xml_declaration=True, encoding="utf-8")


def _pose(parent: _Element, T: FloatArray) -> None:
    add(parent, "pose", [*T[:3, 3], *rpy_of(T[:3, :3])])


def _add_texts(parent: _Element, tag: str, values: Mapping[str, float | None]) -> None:
    stated = {name: value for name, value in values.items() if value is not None}
    element = add(parent, tag) if stated else parent
    for name, value in stated.items():
        add(element, name, value)


def _add_link(
    model: _Element, link: Link, T_model_link: FloatArray, meshes: MeshFiles, surface: list[float] | None
) -> None:
    element = add(model, "link", name=link.name)
    _pose(element, T_model_link)
    if link.inertial is not None:
        inertial = add(element, "inertial")
        add(inertial, "pose", [*link.inertial.center_of_mass, 0.0, 0.0, 0.0])
        add(inertial, "mass", link.inertial.mass)
        _add_texts(inertial, "inertia", moments(link.inertial))
    for number, shape in enumerate(link.visuals):
        block = _add_shape(element, f"visual_{number}", shape, link.name, meshes)
        if not shape.mesh.is_dressed:
            material = add(block, "material")
            for name in ("ambient", "diffuse"):
                add(material, name, shape.color or GREY)
    for number, shape in enumerate(link.collisions):
        block = _add_shape(element, f"collision_{number}", shape, link.name, meshes)
        if surface:
            friction = add(add(block, "surface"), "friction")
            _add_texts(friction, "ode", dict(zip(("mu", "mu2"), surface, strict=True)))


def _add_shape(parent: _Element, name: str, shape: Shape, link: str, meshes: MeshFiles) -> _Element:
    element = add(parent, name.split("_", maxsplit=1)[0], name=name)
    _pose(element, shape.T_link_shape)
    kind = add(add(element, "geometry"), shape.kind)
    if shape.kind == "mesh":
        add(kind, "uri", f"{meshes.folder.name}/{meshes.write(shape, link)}")
    elif shape.kind == "box":
        add(kind, "size", shape.size)
    else:
        for key, value in zip(("radius", "length"), shape.size, strict=False):
            add(kind, key, value)
    return element


def _add_joint(model: _Element, name: str, kind: str, parent: str, child: str) -> _Element:
    element = add(model, "joint", name=name, type=kind)
    add(element, "parent", parent)
    add(element, "child", child)
    return element


def _add_axis(element: _Element, joint: Joint, spring: Sequence[float | None]) -> None:
    axis = add(element, "axis")
    add(axis, "xyz", joint.axis)
    if joint.mimic is not None:
        mimic = add(axis, "mimic", joint=joint.mimic.joint)
        add(mimic, "multiplier", joint.mimic.multiplier)
        add(mimic, "offset", joint.mimic.offset)
        add(mimic, "reference", 0.0)
    ends = (joint.lower, joint.upper) if joint.is_limited else (-_ENDLESS, _ENDLESS)
    drive = {"effort": joint.effort, "velocity": joint.velocity}
    _add_texts(axis, "limit", {"lower": ends[0], "upper": ends[1], **drive})
    stiffness, rest = spring
    friction = {"damping": joint.damping, "friction": joint.friction}
    _add_texts(axis, "dynamics", {**friction, "spring_reference": rest, "spring_stiffness": stiffness})
