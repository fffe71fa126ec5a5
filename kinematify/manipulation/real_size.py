"""Real size of an object: shapes of common collections are brought to unit size, and an arm is not.

A model that fills a ball of radius 1 around its origin was normalised, and is scaled to the common size of what it is
called. Any other model whose size is plausible for what it is called stays as it is, and so does one that is called
nothing known if a robot could use a thing of that size. `write_scaled` writes the copy.
"""

from __future__ import annotations

import csv
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import LinkMesh, Mimic
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Inertial, Joint, Robot, Shape


with Path(__file__).with_name("real_sizes.csv").open(encoding="utf-8") as _file:
    SIZES = {name: tuple(map(float, sizes)) for name, *sizes in csv.reader(line for line in _file if line[0] != "#")}
"""Least, common and most of the largest extent of things of one category [m]."""

_UNKNOWN = (0.03, 0.5, 5.0)  # what is smaller or larger is no thing that an arm opens
_UNIT_DIAGONAL = (1.6, 2.9)  # of normalised shapes: 48 of 48 of the benchmark, opened parts included [m]
_UNIT_OFFSET = 0.35  # distance of the middle of their box from the origin: 47 of 48 [m]
_UNIT_DEPTH = 0.2  # they reach so far below their origin; what stands on a floor does not [m]
_FOLDERS = 2  # of the path that may say what the object is


def sizing(urdf: Path, name: str, box: FloatArray, *, scale: float | None = None) -> tuple[float, str]:
    """Return by how much to scale an object before a robot meets it, and why.

    Args:
        urdf: Its file; the words of its name and of its folders are looked at.
        name: Name of the robot element.
        box: Lowest and highest corner of the object at rest, frame of the root link [units of the file], shape (2, 3).
        scale: What the user wants; it wins.

    Raises:
        InputError: The scale is not above zero, or the size fits nothing that an arm could use.
    """
    if scale is not None:
        if not 0.0 < scale < float("inf"):
            raise InputError(f"--scale {scale} is no factor. Give metres per unit of the model, e.g. 0.001.")
        return scale, "the scale that was given"
    extent = float(np.ptp(box, axis=0).max())
    category = category_of(urdf, name)
    least, common, most = SIZES[category] if category is not None else _UNKNOWN
    unit = category is not None and is_normalised(box)
    if least <= extent <= most and not unit:
        what = f"of a {category}" if category else "that an arm can use"
        return 1.0, f"{extent:.3g} m is a size {what}"
    if category is None:
        raise InputError(
            f"The object {urdf} is {extent:.4g} m large, and nothing in its name says what it is. Give --scale with "
            "the metres per unit of the model, e.g. --scale 0.001 for millimetres."
        )
    why = "the file was normalised to unit size" if unit else f"{extent:.3g} m is not plausible"
    return common / extent, f"a {category} is about {common:g} m large and {why}; --scale 1 keeps the file's size"


def is_normalised(box: FloatArray) -> bool:
    """True if a box (2, 3) fills the ball of radius 1 around the origin, as shapes of collections do."""
    diagonal = float(np.linalg.norm(box[1] - box[0]))
    offset = float(np.linalg.norm(box.mean(axis=0)))
    return _UNIT_DIAGONAL[0] <= diagonal <= _UNIT_DIAGONAL[1] and offset <= _UNIT_OFFSET and box[0, 2] < -_UNIT_DEPTH


def category_of(urdf: Path, name: str) -> str | None:
    """Find the category that the names of robot, file and folders say, the robot's first; the longest words win."""
    for text in (name, urdf.stem, *(folder.name for folder in list(urdf.absolute().parents)[:_FOLDERS])):
        words = " ".join(re.findall(r"[a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text).lower()))
        found = [category for category in SIZES if re.search(rf"\b{category}(s|es)?\b", words)]
        if found:
            return max(found, key=lambda category: (len(category), category))
    return None


def write_scaled(urdf: Path, factor: float, path: Path, *, package_dirs: Sequence[Path] = ()) -> None:
    """Write an object at another size, with absolute mesh paths.

    Args:
        urdf: The object.
        factor: Above zero; 1 only makes mesh paths absolute.
        path: File to write.
        package_dirs: Where packages lie (``package://``).

    Raises:
        InputError: The object cannot be read.
        OSError: The file cannot be written.
    """
    write_robot(scaled(read_robot(urdf, package_dirs=package_dirs), factor), path)


def scaled(robot: Robot, factor: float) -> Robot:
    """Return a robot at another size: lengths by the factor, masses by its cube, inertias by its fifth power."""
    unit = {joint.name: factor if joint.kind is JointType.PRISMATIC else 1.0 for joint in robot.joints}
    return replace(
        robot,
        links=tuple(
            replace(
                link,
                inertial=None if link.inertial is None else _inertial(link.inertial, factor),
                visuals=tuple(_shape(shape, factor) for shape in link.visuals),
                collisions=tuple(_shape(shape, factor) for shape in link.collisions),
            )
            for link in robot.links
        ),
        joints=tuple(_joint(joint, factor, unit) for joint in robot.joints),
    )


def _inertial(inertial: Inertial, factor: float) -> Inertial:
    return replace(
        inertial,
        mass=inertial.mass * factor**3,
        center_of_mass=inertial.center_of_mass * factor,
        tensor=inertial.tensor * factor**5,
    )


def _shape(shape: Shape, factor: float) -> Shape:
    return replace(
        shape,
        mesh=LinkMesh(vertices=shape.mesh.vertices * factor, faces=shape.mesh.faces),
        scale=shape.scale * factor if shape.kind == "mesh" else shape.scale,
        size=tuple(length * factor for length in shape.size),
        T_link_shape=_placed(shape.T_link_shape, factor),
    )


def _joint(joint: Joint, factor: float, unit: dict[str, float]) -> Joint:
    own, mimic = unit[joint.name], joint.mimic
    return replace(
        joint,
        T_parent_child=_placed(joint.T_parent_child, factor),
        lower=joint.lower * own,
        upper=joint.upper * own,
        velocity=None if joint.velocity is None else joint.velocity * own,
        mimic=None
        if mimic is None
        else Mimic(joint=mimic.joint, multiplier=mimic.multiplier * own / unit[mimic.joint], offset=mimic.offset * own),
    )


def _placed(transform: FloatArray, factor: float) -> FloatArray:
    moved = transform.copy()
    moved[:3, 3] *= factor
    return moved
