"""Copies of a URDF for planners and engines: mesh paths absolute, sizes scaled."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.model.urdf_elements import numbers
from kinematify.robot.description import parse_description
from kinematify.robot.read import read_parsed
from kinematify.robot.urdf_geometry import geometry_source

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.robot.declared import DeclaredModel

_LENGTHS = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",), "capsule": ("radius", "length")}


def write_scaled(urdf: Path, factor: float, path: Path, *, package_dirs: Sequence[Path] = ()) -> None:
    """Write an object at another size: lengths by the factor, masses by its cube, inertias by its fifth power.

    Args:
        urdf: The object.
        factor: Above zero; 1 only makes mesh paths absolute.
        path: File to write.
        package_dirs: Where packages lie (``package://``).

    Raises:
        InputError: The object cannot be read.
        OSError: The file cannot be written.
    """
    document = parse_description(urdf)
    model = read_parsed(document, urdf, geometry_source(urdf, package_dirs))
    with_absolute_meshes(document, model)
    slides = {j.name for j in model.joints if j.declared_kind == "prismatic"}
    for link in document.findall("link"):
        for block in [*link.findall("visual"), *link.findall("collision"), *link.findall("inertial")]:
            _scale_origin(block, factor)
        for geometry in link.iter("geometry"):
            _scale_shape(geometry[0], factor)
        for inertial in link.findall("inertial"):
            _scale(inertial.find("mass"), ("value",), factor**3)
            _scale(inertial.find("inertia"), ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), factor**5)
    for joint in document.findall("joint"):
        _scale_joint(joint, slides, factor)
    etree.ElementTree(document).write(path, pretty_print=True, xml_declaration=True, encoding="utf-8")


def with_absolute_meshes(document: _Element, model: DeclaredModel) -> None:
    """Make every mesh path of a document absolute."""
    for element, link in zip(document.findall("link"), model.links, strict=True):
        for tag, shapes in (("visual", link.visuals), ("collision", link.collisions)):
            for block, shape in zip(element.findall(tag), shapes, strict=True):
                mesh = block.find("geometry/mesh")
                if shape.file is not None and mesh is not None:
                    mesh.set("filename", str(shape.file))


def _scale_joint(joint: _Element, slides: set[str], factor: float) -> None:
    _scale_origin(joint, factor)
    own = factor if joint.get("name") in slides else 1.0
    _scale(joint.find("limit"), ("lower", "upper", "velocity"), own)
    mimic = joint.find("mimic")
    if mimic is not None:
        _scale(mimic, ("offset",), own)
        mimic.set("multiplier", mimic.get("multiplier") or "1")
        _scale(mimic, ("multiplier",), own / (factor if mimic.get("joint") in slides else 1.0))


def _scale_shape(shape: _Element, factor: float) -> None:
    if shape.tag == "mesh":
        shape.set("scale", shape.get("scale") or "1 1 1")
        _scale(shape, ("scale",), factor)
    else:
        _scale(shape, _LENGTHS.get(str(shape.tag), ()), factor)


def _scale_origin(block: _Element, factor: float) -> None:
    _scale(block.find("origin"), ("xyz",), factor)


def _scale(element: _Element | None, attributes: Sequence[str], factor: float) -> None:
    """Multiply the numbers of some attributes; those that are absent stay so."""
    if element is None or factor == 1.0:
        return
    for attribute in attributes:
        text = element.get(attribute)
        if text is not None:
            element.set(attribute, numbers(factor * np.array([float(word) for word in text.split()])))
