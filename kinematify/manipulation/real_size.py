"""Real size of an object: shapes of common collections are brought to unit size, and an arm is not.

A model that fills a ball of radius 1 around its origin was normalised, and is scaled to the common size of what it is
called. Any other model whose size is plausible for what it is called stays as it is, and so does one that is called
nothing known if a robot could use a thing of that size. `write_scaled` writes the copy.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import LinkMesh, Mimic
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Inertial, Joint, Robot, Shape


@dataclass(frozen=True, kw_only=True)
class RealSize:
    """Largest extent of things of one category [m]."""

    least: float
    common: float
    most: float


@dataclass(frozen=True, kw_only=True)
class Sizing:
    """By how much an object is scaled before a robot meets it, and why."""

    factor: float
    category: str | None
    reason: str


def _size(least: float, common: float, most: float) -> RealSize:
    return RealSize(least=least, common=common, most=most)


SIZES = {
    "bag": _size(0.25, 0.45, 0.8),
    "bottle": _size(0.1, 0.25, 0.4),
    "bowl": _size(0.1, 0.2, 0.4),
    "box": _size(0.1, 0.4, 0.9),
    "bucket": _size(0.2, 0.3, 0.5),
    "button panel": _size(0.08, 0.2, 0.6),
    "cabinet": _size(0.4, 1.1, 2.4),
    "chest": _size(0.3, 0.8, 1.5),
    "coffee machine": _size(0.2, 0.4, 0.6),
    "cup": _size(0.05, 0.1, 0.2),
    "cupboard": _size(0.4, 1.1, 2.4),
    "desk": _size(0.7, 1.3, 2.2),
    "desk lamp": _size(0.2, 0.45, 0.9),
    "dishwasher": _size(0.4, 0.85, 0.95),
    "dispenser": _size(0.1, 0.2, 0.5),
    "door": _size(1.6, 2.05, 2.6),
    "drawer": _size(0.25, 0.6, 1.2),
    "drawer cabinet": _size(0.35, 1.1, 2.0),
    "faucet": _size(0.12, 0.3, 0.5),
    "fridge": _size(0.5, 1.6, 2.1),
    "kettle": _size(0.15, 0.27, 0.4),
    "kitchen pot": _size(0.12, 0.3, 0.55),
    "lamp": _size(0.2, 0.45, 1.8),
    "laptop": _size(0.25, 0.36, 0.5),
    "microwave": _size(0.35, 0.52, 0.7),
    "mug": _size(0.06, 0.12, 0.2),
    "nightstand": _size(0.35, 0.55, 0.8),
    "oven": _size(0.45, 0.8, 1.1),
    "pot": _size(0.12, 0.3, 0.55),
    "printer": _size(0.25, 0.45, 0.8),
    "refrigerator": _size(0.5, 1.6, 2.1),
    "safe": _size(0.2, 0.45, 1.0),
    "scissors": _size(0.1, 0.18, 0.3),
    "sink": _size(0.3, 0.6, 1.2),
    "stapler": _size(0.08, 0.16, 0.35),
    "storage furniture": _size(0.4, 1.1, 2.4),
    "suitcase": _size(0.35, 0.65, 0.9),
    "switch": _size(0.05, 0.12, 0.3),
    "switch panel": _size(0.05, 0.15, 0.4),
    "table": _size(0.4, 1.2, 2.4),
    "toaster": _size(0.2, 0.32, 0.5),
    "toilet": _size(0.5, 0.75, 1.0),
    "trash can": _size(0.2, 0.6, 1.2),
    "wardrobe": _size(1.0, 2.0, 2.6),
    "washing machine": _size(0.5, 0.87, 1.1),
    "window": _size(0.4, 1.2, 2.2),
}
"""Largest extent at rest of common things [m]: furniture and appliances as shops list them."""

_UNKNOWN = RealSize(least=0.03, common=0.5, most=5.0)  # what is smaller or larger is no thing that an arm opens
_UNIT_DIAGONAL = (1.6, 2.9)  # of normalised shapes: 48 of 48 of the benchmark, opened parts included [m]
_UNIT_OFFSET = 0.35  # distance of the middle of their box from the origin: 47 of 48 [m]
_UNIT_DEPTH = 0.2  # they reach so far below their origin; what stands on a floor does not [m]
_FOLDERS = 2  # of the path that may say what the object is


def sizing(urdf: Path, name: str, box: FloatArray, *, scale: float | None = None) -> Sizing:
    """Return by how much to scale an object.

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
        return Sizing(factor=scale, category=None, reason="the scale that was given")
    extent = float(np.ptp(box, axis=0).max())
    category = category_of(urdf, name)
    size = SIZES[category] if category is not None else _UNKNOWN
    unit = category is not None and is_normalised(box)
    if size.least <= extent <= size.most and not unit:
        what = f"of a {category}" if category else "that an arm can use"
        return Sizing(factor=1.0, category=category, reason=f"{extent:.3g} m is a size {what}")
    if category is None:
        raise InputError(
            f"The object {urdf} is {extent:.4g} m large, and nothing in its name says what it is. Give --scale with "
            "the metres per unit of the model, e.g. --scale 0.001 for millimetres."
        )
    why = "the file was normalised to unit size" if unit else f"{extent:.3g} m is not plausible"
    return Sizing(
        factor=size.common / extent,
        category=category,
        reason=f"a {category} is about {size.common:g} m large and {why}; --scale 1 keeps the file's size",
    )


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
