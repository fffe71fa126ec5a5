"""From a URDF that the pre-check let pass to a `DeclaredModel`; every mesh file is read once."""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.declared import (
    DeclaredInertial,
    DeclaredJoint,
    DeclaredLink,
    DeclaredModel,
    DeclaredShape,
)
from kinematify.robot.description import describe, parse_description
from kinematify.robot.robot import LinkMesh
from kinematify.robot.urdf_geometry import geometry_source
from kinematify.robot.urdf_numbers import number, origin_transform, vector

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.robot.robot import DescribedJoint
    from kinematify.robot.urdf_geometry import GeometrySource
    from kinematify.validation.stage import StageRequest

_LEFT = "model.pickle"
"""In the folder of the run, which nobody else writes to."""


def read_model(path: Path, *, package_dirs: Sequence[Path] = ()) -> DeclaredModel:
    """Read everything that a URDF declares, meshes included.

    Args:
        path: The URDF file.
        package_dirs: Where packages lie (``package://``).

    Raises:
        DescriptionError: It cannot be read or is no tree of single-axis joints; the message says where and what to do.
    """
    return read_parsed(parse_description(path), path, geometry_source(path, package_dirs))


def leave_model(model: DeclaredModel, work: Path) -> None:
    """Leave a model for the later stages of a run, so that they need not parse its meshes again."""
    partly = work / f"{_LEFT}.partly"
    with partly.open("wb") as file:
        pickle.dump(model, file, protocol=pickle.HIGHEST_PROTOCOL)
    partly.replace(work / _LEFT)  # a stage that is stopped leaves no half of it


def model_of(request: StageRequest) -> DeclaredModel:
    """Read the model of a run: what an earlier stage left, or else the files.

    Raises:
        DescriptionError: As for `read_model`.
    """
    left = request.work / _LEFT
    if not left.is_file():
        return read_model(request.urdf, package_dirs=request.package_dirs)
    with left.open("rb") as file:
        model: DeclaredModel = pickle.load(file)
    return model


def read_without_geometry(path: Path) -> DeclaredModel:
    """Read what `read_model` reads but for the geometry, for what needs the tree only: no mesh file is opened.

    Raises:
        DescriptionError: As for `read_model`.
    """
    robot = parse_description(path)
    for link in robot.findall("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            link.remove(shape)
    return read_parsed(robot, path, geometry_source(path, ()))


def read_parsed(robot: _Element, path: Path, source: GeometrySource) -> DeclaredModel:
    """Do the work of `read_model` on a parsed document with a source that may have opened the mesh files already.

    Raises:
        DescriptionError: As for `read_model`.
    """
    kinematics = describe(robot, path, source)
    return DeclaredModel(
        path=path.resolve(),
        name=kinematics.name,
        links=tuple(_link(element, source) for element in robot.findall("link")),
        joints=tuple(
            _joint(element, joint) for element, joint in zip(robot.findall("joint"), kinematics.joints, strict=True)
        ),
        kinematics=kinematics,
    )


def _link(element: _Element, source: GeometrySource) -> DeclaredLink:
    return DeclaredLink(
        name=element.get("name") or "",
        inertial=_inertial(element),
        visuals=_shapes(element, "visual", source),
        collisions=_shapes(element, "collision", source),
        line=_line(element),
    )


def _shapes(link: _Element, tag: str, source: GeometrySource) -> tuple[DeclaredShape, ...]:
    meshes = source.meshes(link, tag)
    where = f"link {link.get('name')}"
    return tuple(_shape(element, mesh, source, where) for element, mesh in zip(link.findall(tag), meshes, strict=True))


def _shape(element: _Element, mesh: LinkMesh, source: GeometrySource, where: str) -> DeclaredShape:
    shape = element[[child.tag for child in element].index("geometry")][0]
    kind = str(shape.tag)
    sizes = {"box": ("size",), "sphere": ("radius",)}.get(kind, ("radius", "length"))
    numbers = [] if kind == "mesh" else [float(word) for key in sizes for word in (shape.get(key) or "").split()]
    return DeclaredShape(
        kind=kind,
        mesh=mesh,
        file=source.resolved(shape.get("filename") or "", where) if kind == "mesh" else None,
        scale=vector(shape, "scale", (1.0, 1.0, 1.0), where) if kind == "mesh" else np.ones(3),
        size=tuple(numbers),
        T_link_shape=origin_transform(element, where),
        line=_line(element),
    )


def _inertial(link: _Element) -> DeclaredInertial | None:
    element = link.find("inertial")
    if element is None:
        return None
    where = f"link {link.get('name')}"
    mass, inertia = element.find("mass"), element.find("inertia")
    ixx, ixy, ixz, iyy, iyz, izz = (
        0.0 if inertia is None else number(inertia, key, 0.0, where)
        for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    )
    T_link_inertial = origin_transform(element, where)
    rotation = T_link_inertial[:3, :3]
    tensor = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    return DeclaredInertial(
        mass=0.0 if mass is None else number(mass, "value", 0.0, where),
        center_of_mass=T_link_inertial[:3, 3],
        tensor=rotation @ tensor @ rotation.T,
        line=_line(element),
    )


def _joint(element: _Element, joint: DescribedJoint) -> DeclaredJoint:
    return DeclaredJoint(
        joint=joint,
        declared_kind=element.get("type") or "",
        has_limit=element.find("limit") is not None,
        effort=_optional(element, "limit", "effort"),
        velocity=_optional(element, "limit", "velocity"),
        damping=_optional(element, "dynamics", "damping"),
        friction=_optional(element, "dynamics", "friction"),
        line=_line(element),
    )


def _optional(joint: _Element, tag: str, attribute: str) -> float | None:
    element = joint.find(tag)
    if element is None or element.get(attribute) is None:
        return None
    return number(element, attribute, None, f"joint {joint.get('name')}")


def _line(element: _Element) -> int:
    return int(str(element.sourceline))  # the stubs of lxml do not know its type
