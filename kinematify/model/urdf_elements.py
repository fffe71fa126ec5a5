"""`prepared.urdf`: one tag per line, no visual geometry, every number with all its digits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from kinematify.config.validation import PrepareSettings
    from kinematify.geometry.convex import ConvexPiece
    from kinematify.model.masses import PreparedInertial
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.declared import DeclaredJoint, DeclaredShape
    from kinematify.robot.robot import DescribedJoint

_DIGITS = 10  # a relative error of 1e-10: far below the tolerance of any engine
_LEVEL = 1e-9
"""Cosine of the pitch below which roll and yaw are one angle."""


def robot_element() -> etree._Element:
    """Return an empty document; its name is short because PyBullet crashes on long ones."""
    return etree.Element("robot", name="prepared")


def add_link(robot: etree._Element, name: str, inertial: PreparedInertial) -> etree._Element:
    """Add a link with its mass, and return it for `add_primitive` and `add_piece`."""
    link = etree.SubElement(robot, "link", name=name)
    block = etree.SubElement(link, "inertial")
    etree.SubElement(block, "origin", xyz=numbers(inertial.center_of_mass), rpy="0 0 0")
    etree.SubElement(block, "mass", value=numbers([inertial.mass]))
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = inertial.tensor.tolist()
    moments = {"ixx": ixx, "ixy": ixy, "ixz": ixz, "iyy": iyy, "iyz": iyz, "izz": izz}
    etree.SubElement(block, "inertia", {key: numbers([value]) for key, value in moments.items()})
    return link


def add_primitive(link: etree._Element, shape: DeclaredShape) -> None:
    """Add a box, cylinder or sphere as it was declared."""
    sizes = {
        "box": {"size": numbers(shape.size)},
        "sphere": {"radius": numbers(shape.size[:1])},
        "cylinder": {"radius": numbers(shape.size[:1]), "length": numbers(shape.size[1:])},
    }
    collision = etree.SubElement(link, "collision")
    _add_origin(collision, shape.T_link_shape)
    etree.SubElement(etree.SubElement(collision, "geometry"), shape.kind, sizes[shape.kind])


def add_piece(link: etree._Element, piece: ConvexPiece, path: Path) -> None:
    """Write a convex piece as OBJ in the link frame, and refer to it."""
    with path.open("w", encoding="ascii") as file:
        file.writelines(f"v {x:.{_DIGITS}g} {y:.{_DIGITS}g} {z:.{_DIGITS}g}\n" for x, y, z in piece.vertices.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in (piece.faces + 1).tolist())
    collision = etree.SubElement(link, "collision")
    etree.SubElement(collision, "origin", xyz="0 0 0", rpy="0 0 0")
    etree.SubElement(etree.SubElement(collision, "geometry"), "mesh", filename=str(path))


def add_joint(robot: etree._Element, declared: DeclaredJoint, settings: PrepareSettings) -> None:
    """Add a joint as it was declared; what readers demand and the file lacks is made up (`lacks_drive`)."""
    joint = declared.joint
    element = etree.SubElement(robot, "joint", name=joint.name, type=joint.kind.value)
    etree.SubElement(element, "parent", link=joint.parent)
    etree.SubElement(element, "child", link=joint.child)
    _add_origin(element, joint.T_parent_child)
    if joint.kind is JointType.FIXED:
        return
    etree.SubElement(element, "axis", xyz=numbers(joint.axis))
    etree.SubElement(element, "limit", _limit(joint, declared, settings))
    dynamics = {"damping": declared.damping, "friction": declared.friction}
    given = {key: numbers([value]) for key, value in dynamics.items() if value is not None and value >= 0.0}
    if given:
        etree.SubElement(element, "dynamics", given)
    if joint.mimic is not None:
        rule = {"multiplier": numbers([joint.mimic.multiplier]), "offset": numbers([joint.mimic.offset])}
        etree.SubElement(element, "mimic", {"joint": joint.mimic.joint, **rule})


def lacks_drive(declared: DeclaredJoint) -> bool:
    """True if a joint that moves has no effort or no velocity above zero."""
    moves = declared.joint.kind is not JointType.FIXED
    return moves and not ((declared.effort or 0.0) > 0.0 and (declared.velocity or 0.0) > 0.0)


def _limit(joint: DescribedJoint, declared: DeclaredJoint, settings: PrepareSettings) -> dict[str, str]:
    bounded = joint.kind is not JointType.CONTINUOUS
    limit = {"lower": joint.lower, "upper": joint.upper} if bounded else {}
    limit["effort"] = declared.effort if declared.effort and declared.effort > 0.0 else settings.effort
    limit["velocity"] = declared.velocity if declared.velocity and declared.velocity > 0.0 else settings.velocity
    return {key: numbers([value]) for key, value in limit.items()}


def _add_origin(element: etree._Element, transform: FloatArray) -> None:
    xyz, rpy = transform[:3, 3], roll_pitch_yaw(transform[:3, :3])
    etree.SubElement(element, "origin", xyz=numbers(xyz), rpy=numbers(rpy))


def roll_pitch_yaw(rotation: FloatArray) -> FloatArray:
    """Return the turns about the fixed x, y and z axes [rad], shape (3,), that make a rotation matrix (3, 3)."""
    level = float(np.hypot(rotation[0, 0], rotation[1, 0]))
    pitch = np.arctan2(-rotation[2, 0], level)
    if level < _LEVEL:  # looking straight up or down: roll and yaw are one angle
        return np.array([np.arctan2(-rotation[1, 2], rotation[1, 1]), pitch, 0.0])
    roll = np.arctan2(rotation[2, 1], rotation[2, 2])
    return np.array([roll, pitch, np.arctan2(rotation[1, 0], rotation[0, 0])])


def numbers(values: Iterable[float]) -> str:
    """Shortest text that reads back as the same float64."""
    return " ".join(repr(float(value) + 0.0) for value in values)
