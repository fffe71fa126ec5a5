"""MJCF, the language of MuJoCo: nested bodies, motors for joints with an effort, pairs that do not collide."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from kinematify.formats.content import GREY, shown_surfaces
from kinematify.robot.joint_type import JointType
from kinematify.robot.mesh_folder import MeshFiles
from kinematify.robot.transforms import quaternion_of
from kinematify.robot.write import add
from kinematify.simulation.configurations import PIN_SOLIMP, PIN_SOLREF

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.formats.content import Content
    from kinematify.robot.appearance import Surface
    from kinematify.robot.robot import Joint, Link, Shape

_PIN = {"solref": PIN_SOLREF, "solimp": PIN_SOLIMP}
_SEEN, _COLLIDES = "2", "3"  # MuJoCo's viewer shows groups 0 to 2

_LEAST_RANGE = 1e-9
_ROLLING = (0.005, 1e-4)
"""MuJoCo's own coefficients for turns in contact."""


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
    add(document, "compiler", angle="radian", meshdir=meshes.folder.name, autolimits="true")
    assets = add(document, "asset")
    _MjcfWriter(content, meshes, assets).add_tree(add(document, "worldbody"), free=free)
    if content.apart:
        contact = add(document, "contact")
        for first, second in content.apart:
            add(contact, "exclude", body1=first, body2=second)
    _add_equalities(document, content)
    driven = [joint for joint in content.robot.joints if joint.leads and joint not in content.undriven]
    actuators = add(document, "actuator") if driven else document
    for joint in driven:
        add(actuators, "motor", name=joint.name, joint=joint.name, ctrlrange=[-(joint.effort or 0.0), joint.effort])
    etree.ElementTree(document).write(out, pretty_print=True, xml_declaration=True, encoding="utf-8")


class _MjcfWriter:
    """The tree of bodies and the meshes that it needs."""

    def __init__(self, content: Content, meshes: MeshFiles, assets: _Element) -> None:
        self._content, self._meshes, self._assets = content, meshes, assets

    def add_tree(self, world: _Element, *, free: bool) -> None:
        robot = self._content.robot
        root = add(world, "body", name=robot.root)
        if free:
            add(root, "freejoint")
        waiting = [(root, robot.root)]
        while waiting:  # a loop: chains may be longer than Python's stack
            element, name = waiting.pop()
            self._fill(element, robot.link_by_name[name])
            for joint in robot.joints_below[name]:
                waiting.append((self._add_child(element, joint), joint.child))

    def _add_child(self, parent: _Element, joint: Joint) -> _Element:
        T = joint.T_parent_child
        child = add(parent, "body", name=joint.child, pos=T[:3, 3], quat=quaternion_of(T[:3, :3]))
        if joint.kind is not JointType.FIXED:
            stiffness, rest = self._content.extensions.springs.get(joint.name, (None, None))
            add(
                child, "joint", name=joint.name, type="hinge" if joint.kind.turns else "slide", axis=joint.axis,
                # MuJoCo takes a range without width for none.
                range=[joint.lower, max(joint.upper, joint.lower + _LEAST_RANGE)] if joint.is_limited else None,
                damping=joint.damping, frictionloss=joint.friction, stiffness=stiffness, springref=rest,
            )  # fmt: skip
        return child

    def _fill(self, element: _Element, link: Link) -> None:
        if link.inertial is not None:
            m = link.inertial.tensor
            add(
                element, "inertial", pos=link.inertial.center_of_mass, mass=link.inertial.mass,
                fullinertia=[m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2]],
            )  # fmt: skip
        for shape in link.visuals:
            if shape.kind != "mesh":
                self._geom(element, link, shape, group=_SEEN, contype="0", conaffinity="0", rgba=shape.color or GREY)
            else:
                for surface in shown_surfaces(shape):
                    self._surface(element, link, surface)
        friction = self._content.extensions.surfaces.get(link.name)
        for shape in link.collisions:
            self._geom(element, link, shape, group=_COLLIDES, friction=friction and [friction[0], *_ROLLING])

    def _surface(self, element: _Element, link: Link, surface: Surface) -> None:
        mesh = self._mesh(self._meshes.write_surface(surface, link.name))
        color, texture, stated = surface.material.color, surface.material.texture, None
        if texture is not None:
            name = self._meshes.write_texture(texture).removesuffix(".png")
            if self._assets.find(f"texture[@name='{name}']") is None:
                add(self._assets, "texture", name=name, type="2d", file=f"{self._meshes.folder.name}/{name}.png")
            stated = f"{name}_{len(self._assets)}"
            add(self._assets, "material", name=stated, texture=name, rgba=color)
        add(
            element, "geom", type="mesh", mass="0", mesh=mesh, group=_SEEN, contype="0", conaffinity="0",
            material=stated, rgba=None if stated else color,
        )  # fmt: skip

    def _mesh(self, file: str) -> str:
        """Declare a mesh file and return its name."""
        name = file.removesuffix(".obj")
        # Only what is seen may be open or flat, for which a volume makes no sense.
        add(self._assets, "mesh", name=name, file=file, inertia="shell")
        return name

    def _geom(self, element: _Element, link: Link, shape: Shape, **more: Any) -> None:
        if shape.kind == "mesh":
            add(element, "geom", type="mesh", mass="0", mesh=self._mesh(self._meshes.write(shape, link.name)), **more)
            return
        T, size = shape.T_link_shape, np.array(shape.size)
        # Half lengths, but the radius that is the first size of round shapes.
        size[shape.kind != "box" :] *= 0.5
        place = {"pos": T[:3, 3], "quat": quaternion_of(T[:3, :3]), "size": size}
        add(element, "geom", type=shape.kind, mass="0", **place, **more)


def _add_equalities(document: _Element, content: Content) -> None:
    equality = add(document, "equality")
    for loop in content.robot.loops:
        first, second = loop.links
        add(equality, "connect", name=loop.name, body1=first, body2=second, anchor=loop.points[0], **_PIN)
    for joint in content.robot.joints:
        if joint.mimic is not None:
            add(
                equality, "joint", name=f"{joint.name} follows", joint1=joint.name, joint2=joint.mimic.joint,
                polycoef=[joint.mimic.offset, joint.mimic.multiplier, 0.0, 0.0, 0.0],
            )  # fmt: skip
