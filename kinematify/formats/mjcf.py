"""MJCF, the language of MuJoCo: nested bodies, motors for joints with an effort, pairs that do not collide."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.formats.content import GREY, MeshFiles, body_name, shown_surfaces
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import quaternion_of
from kinematify.robot.write import numbers
from kinematify.simulation.configurations import PIN_SOLIMP, PIN_SOLREF

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.formats.content import Content
    from kinematify.robot.appearance import Surface
    from kinematify.robot.robot import Joint, Link, Shape

_PIN = {"solref": numbers(PIN_SOLREF), "solimp": numbers(PIN_SOLIMP)}
_SEEN, _COLLIDES = "2", "3"  # MuJoCo's viewer shows groups 0 to 2


def write_mjcf(content: Content, out: Path, *, free: bool) -> None:
    """Write an MJCF file and a folder with its meshes.

    Args:
        content: What to write.
        out: File to write.
        free: The root link floats, otherwise it is fixed to the world.

    Raises:
        OSError: A file cannot be written.
    """
    meshes = MeshFiles(out)
    document = etree.Element("mujoco", model=content.robot.name)
    etree.SubElement(document, "compiler", angle="radian", meshdir=meshes.folder.name, autolimits="true")
    assets = etree.SubElement(document, "asset")
    world = etree.SubElement(document, "worldbody")
    writer = _MjcfWriter(content, meshes, assets)
    writer.add_tree(world, free=free)
    _add_contact(document, content)
    _add_followers(document, content)
    _add_motors(document, content)
    etree.ElementTree(document).write(out, pretty_print=True, xml_declaration=True, encoding="utf-8")


class _MjcfWriter:
    """The tree of bodies and the meshes that it needs."""

    def __init__(self, content: Content, meshes: MeshFiles, assets: _Element) -> None:
        self._content, self._meshes, self._assets = content, meshes, assets

    def add_tree(self, world: _Element, *, free: bool) -> None:
        robot = self._content.robot
        root = etree.SubElement(world, "body", name=body_name(robot.root))
        if free:
            etree.SubElement(root, "freejoint", name="root")
        waiting = [(root, robot.root)]
        while waiting:  # a loop: chains may be longer than Python's stack
            element, name = waiting.pop()
            self._fill(element, robot.link_by_name[name])
            for joint in robot.joints_below[name]:
                waiting.append((self._add_child(element, joint), joint.child))

    def _add_child(self, parent: _Element, joint: Joint) -> _Element:
        T = joint.T_parent_child
        child = etree.SubElement(
            parent, "body", name=body_name(joint.child), pos=numbers(T[:3, 3]), quat=numbers(quaternion_of(T[:3, :3]))
        )
        if joint.kind is JointType.FIXED:
            return child
        element = etree.SubElement(
            child, "joint", name=joint.name, type="hinge" if joint.kind.turns else "slide", axis=numbers(joint.axis)
        )
        if np.isfinite([joint.lower, joint.upper]).all():
            element.set("range", numbers([joint.lower, joint.upper]))
        for key, value in (("damping", joint.damping), ("frictionloss", joint.friction)):
            if value:
                element.set(key, numbers([value]))
        return child

    def _fill(self, element: _Element, link: Link) -> None:
        inertial = link.inertial
        if inertial is not None:
            m = inertial.tensor
            etree.SubElement(
                element, "inertial", pos=numbers(inertial.center_of_mass), mass=numbers([inertial.mass]),
                fullinertia=numbers([m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2]]),
            )  # fmt: skip
        for shape in link.visuals:
            for geom in self._seen(element, link, shape):
                geom.set("group", _SEEN)
                geom.set("contype", "0")
                geom.set("conaffinity", "0")
        for shape in link.collisions:
            self._geom(element, link, shape).set("group", _COLLIDES)

    def _seen(self, element: _Element, link: Link, shape: Shape) -> list[_Element]:
        """A geometry for every material of what is seen."""
        if shape.kind != "mesh":
            geom = self._geom(element, link, shape)
            geom.set("rgba", numbers(shape.color or GREY))
            return [geom]
        return [self._surface(element, link, surface) for surface in shown_surfaces(shape)]

    def _surface(self, element: _Element, link: Link, surface: Surface) -> _Element:
        geom = etree.SubElement(element, "geom", type="mesh", mass="0")
        geom.set("mesh", self._mesh(self._meshes.write_surface(surface, link.name)))
        material, texture = surface.material, surface.material.texture
        if texture is None:
            geom.set("rgba", numbers(material.color))
            return geom
        name = self._meshes.write_texture(texture).removesuffix(".png")
        if self._assets.find(f"texture[@name='{name}']") is None:
            file = f"{self._meshes.folder.name}/{name}.png"
            etree.SubElement(self._assets, "texture", name=name, type="2d", file=file)
        stated = f"{name}_{len(self._assets)}"
        etree.SubElement(self._assets, "material", name=stated, texture=name, rgba=numbers(material.color))
        geom.set("material", stated)
        return geom

    def _mesh(self, file: str) -> str:
        """Declare a mesh file and return its name."""
        name = file.removesuffix(".obj")
        # Only what is seen may be open or flat, for which a volume makes no sense.
        etree.SubElement(self._assets, "mesh", name=name, file=file, inertia="shell")
        return name

    def _geom(self, element: _Element, link: Link, shape: Shape) -> _Element:
        geom = etree.SubElement(element, "geom", type=shape.kind, mass="0")
        if shape.kind == "mesh":
            geom.set("mesh", self._mesh(self._meshes.write(shape, link.name)))
            return geom
        T = shape.T_link_shape
        geom.set("pos", numbers(T[:3, 3]))
        geom.set("quat", numbers(quaternion_of(T[:3, :3])))
        geom.set("size", numbers(_half(shape)))
        return geom


def _half(shape: Shape) -> list[float]:
    """MuJoCo's sizes of a primitive: half lengths."""
    if shape.kind == "box":
        return [0.5 * side for side in shape.size]
    return [shape.size[0], *(0.5 * length for length in shape.size[1:])]


def _moves(joint: Joint) -> bool:
    return joint.kind is not JointType.FIXED


def _add_contact(document: _Element, content: Content) -> None:
    if content.apart:
        contact = etree.SubElement(document, "contact")
        for first, second in content.apart:
            etree.SubElement(contact, "exclude", body1=body_name(first), body2=body_name(second))


def _add_followers(document: _Element, content: Content) -> None:
    followers = [joint for joint in content.robot.joints if joint.mimic is not None and _moves(joint)]
    if not followers and not content.robot.loops:
        return
    equality = etree.SubElement(document, "equality")
    for loop in content.robot.loops:
        (first, second), (anchor, _) = loop.links, loop.points
        etree.SubElement(
            equality, "connect", _PIN, name=loop.name, body1=body_name(first), body2=body_name(second),
            anchor=numbers(anchor),
        )  # fmt: skip
    for joint in followers:
        mimic = joint.mimic
        assert mimic is not None
        etree.SubElement(
            equality, "joint", name=f"{joint.name} follows", joint1=joint.name, joint2=mimic.joint,
            polycoef=numbers([mimic.offset, mimic.multiplier, 0.0, 0.0, 0.0]),
        )  # fmt: skip


def _add_motors(document: _Element, content: Content) -> None:
    driven = [joint for joint in content.robot.joints if joint.leads and (joint.effort or 0) > 0]
    if not driven:
        return
    actuators = etree.SubElement(document, "actuator")
    for joint in driven:
        assert joint.effort is not None
        etree.SubElement(
            actuators, "motor", name=joint.name, joint=joint.name, ctrlrange=numbers([-joint.effort, joint.effort])
        )
