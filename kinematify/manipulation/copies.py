"""Copies of a URDF at another size."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import LinkMesh, Mimic
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Inertial, Joint, Robot, Shape


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
