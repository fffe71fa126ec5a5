"""The project's own arm: seven turning joints and a parallel gripper, made of boxes and cylinders only.

Proportions and limits are those of common research arms with a reach of 0.85 m. Collision shapes leave gaps of a few
millimetres at the joints, so that neighbours touch in no configuration and no pair has to be ignored.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.model.urdf_elements import numbers
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray

Triple = tuple[float, float, float]

TOOL = "tool"
"""Link without geometry between the finger tips: +z approaches, +y closes."""
FINGERS = ("left_finger_joint", "right_finger_joint")
TRAVEL = 0.05
"""Of each finger from closed to open [m]; the gap between the pads is twice this."""
HOME = (0.0, -0.7, 0.0, -2.3, 0.0, 1.6, 0.0)
"""Arm folded over its base, hand pointing down [rad]."""

_RIGHT = 0.5 * np.pi
_HAND = 0.11  # from the last joint to the hand's frame [m]
_PAD = 0.012  # thickness of a finger at its tip [m]
_CLOSED = 0.0005  # half of the gap between closed fingers: what touches at rest would look like a collision [m]
_LIGHT, _DARK, _ACCENT = "0.91 0.92 0.94 1", "0.22 0.24 0.28 1", "0.95 0.55 0.16 1"
_MATERIALS = {"light": _LIGHT, "dark": _DARK, "accent": _ACCENT}


@dataclass(frozen=True)
class _Shape:
    """A box (x, y, z) or, with two sizes, a cylinder (radius, length) [m], in the link frame."""

    size: tuple[float, ...]
    at: Triple = (0.0, 0.0, 0.0)
    rpy: Triple = (0.0, 0.0, 0.0)
    color: str = "light"

    @property
    def volume(self) -> float:
        """[m^3]."""
        if len(self.size) == 3:
            return float(np.prod(self.size))
        return float(np.pi * self.size[0] ** 2 * self.size[1])

    @property
    def moments(self) -> FloatArray:
        """Tensor about the shape's middle, link axes, of unit mass [m^2], shape (3, 3)."""
        if len(self.size) == 3:
            x, y, z = np.square(self.size)
            own = np.array([y + z, x + z, x + y]) / 12.0
        else:
            radius, length = np.square(self.size)
            own = np.array([radius / 4.0 + length / 12.0] * 2 + [radius / 2.0])
        turn = _rotation(self.rpy)
        return np.asarray(turn @ np.diag(own) @ turn.T)


@dataclass(frozen=True)
class _Link:
    name: str
    mass: float
    """[kg]."""
    shapes: tuple[_Shape, ...]


@dataclass(frozen=True)
class _Joint:
    name: str
    parent: str
    child: str
    at: Triple
    rpy: Triple = (0.0, 0.0, 0.0)
    kind: str = "fixed"
    axis: Triple = (0.0, 0.0, 1.0)
    limits: tuple[float, float] = (0.0, 0.0)
    effort: float = 0.0
    velocity: float = 0.0
    damping: float = 0.0


_ALONG_Y = (_RIGHT, 0.0, 0.0)

_LINKS = (
    _Link("base", 6.0, (_Shape((0.20, 0.18, 0.03), (-0.02, 0.0, 0.017)), _Shape((0.065, 0.13), (0.0, 0.0, 0.10)))),
    _Link("shoulder", 3.2, (_Shape((0.045, 0.094), (0.0, 0.0, -0.113), color="dark"),)),
    _Link(
        "upper_arm",
        3.2,
        (
            _Shape((0.058, 0.13), color="light"),
            _Shape((0.052, 0.085), (0.0, -0.105, 0.0), _ALONG_Y),
        ),
    ),
    _Link(
        "elbow",
        2.8,
        (
            _Shape((0.05, 0.082), (0.0, 0.0, -0.1245), color="dark"),
            _Shape((0.11, 0.08, 0.025), (0.005, 0.0, -0.0685), color="dark"),
        ),
    ),
    _Link(
        "forearm",
        2.6,
        (
            _Shape((0.05, 0.10)),
            _Shape((0.11, 0.08, 0.025), (-0.08, 0.0685, 0.0), (_RIGHT, 0.0, 0.0)),
            _Shape((0.048, 0.11), (-0.08, 0.14, 0.0), _ALONG_Y),
        ),
    ),
    _Link("wrist", 2.2, (_Shape((0.045, 0.122), (0.0, 0.0, -0.117), color="dark"),)),
    _Link(
        "flange",
        1.4,
        (_Shape((0.046, 0.085)), _Shape((0.085, 0.066, 0.066), (0.0875, 0.0, 0.0))),
    ),
    _Link("turntable", 0.5, (_Shape((0.036, 0.03), (0.0, 0.0, 0.052), color="dark"),)),
    _Link(
        "hand",
        0.8,
        (_Shape((0.032, 0.035), (0.0, 0.0, -0.022), color="dark"), _Shape((0.05, 0.15, 0.045), (0.0, 0.0, 0.02))),
    ),
    *(
        _Link(
            name,
            0.12,
            (
                _Shape((0.022, 0.02, 0.025), (0.0, sign * (_CLOSED + 0.01), 0.0165), color="dark"),
                _Shape((0.018, _PAD, 0.045), (0.0, sign * (_CLOSED + 0.5 * _PAD), 0.0515), color="accent"),
            ),
        )
        for name, sign in (("left_finger", 1.0), ("right_finger", -1.0))
    ),
    _Link(TOOL, 0.0, ()),
)


@dataclass(frozen=True)
class _Turn:
    """One of the seven; its axis is z of the child's frame, turned by `roll` about x of the parent's."""

    parent: str
    child: str
    at: Triple
    roll: float
    limits: tuple[float, float]


_TURNS = (
    _Turn("base", "shoulder", (0.0, 0.0, 0.33), 0.0, (-2.9, 2.9)),
    _Turn("shoulder", "upper_arm", (0.0, 0.0, 0.0), -_RIGHT, (-1.8, 1.8)),
    _Turn("upper_arm", "elbow", (0.0, -0.32, 0.0), _RIGHT, (-2.9, 2.9)),
    _Turn("elbow", "forearm", (0.08, 0.0, 0.0), _RIGHT, (-3.0, -0.05)),
    _Turn("forearm", "wrist", (-0.08, 0.38, 0.0), -_RIGHT, (-2.9, 2.9)),
    _Turn("wrist", "flange", (0.0, 0.0, 0.0), _RIGHT, (0.1, 3.5)),
    _Turn("flange", "turntable", (0.088, 0.0, 0.0), _RIGHT, (-2.9, 2.9)),
)


def _turning(number: int, turn: _Turn) -> _Joint:
    strong = number <= 4  # shoulder and elbow carry the rest
    return _Joint(
        f"joint_{number}",
        turn.parent,
        turn.child,
        turn.at,
        (turn.roll, 0.0, 0.0),
        "revolute",
        limits=turn.limits,
        effort=90.0 if strong else 20.0,
        velocity=2.2 if strong else 2.6,
        damping=1.0 if strong else 0.2,
    )


def _sliding(name: str, child: str, side: float) -> _Joint:
    return _Joint(
        name,
        "hand",
        child,
        (0.0, 0.0, 0.0405),
        kind="prismatic",
        axis=(0.0, side, 0.0),
        limits=(0.0, TRAVEL),
        effort=60.0,
        velocity=0.2,
        damping=5.0,
    )


_JOINTS = (
    *(_turning(number, turn) for number, turn in enumerate(_TURNS, start=1)),
    _Joint("hand_joint", "turntable", "hand", (0.0, 0.0, _HAND)),
    _sliding(FINGERS[0], "left_finger", 1.0),
    _sliding(FINGERS[1], "right_finger", -1.0),
    _Joint("tool_joint", "hand", TOOL, (0.0, 0.0, 0.107)),
)

ARM_JOINTS = tuple(joint.name for joint in _JOINTS if joint.kind == "revolute")


def write_arm(path: Path) -> None:
    """Write the arm as URDF: no mesh, one tag per line, mass and inertia of every link from its shapes.

    Raises:
        OSError: The file cannot be written.
    """
    robot = etree.Element("robot", name="kinematify_arm")
    for name, rgba in _MATERIALS.items():
        etree.SubElement(etree.SubElement(robot, "material", name=name), "color", rgba=rgba)
    for link in _LINKS:
        _add_link(robot, link)
    for joint in _JOINTS:
        _add_joint(robot, joint)
    etree.ElementTree(robot).write(path, pretty_print=True, xml_declaration=True, encoding="utf-8")


def _add_link(robot: etree._Element, link: _Link) -> None:
    element = etree.SubElement(robot, "link", name=link.name)
    if link.shapes:
        _add_inertial(element, link)
    for tag in ("visual", "collision"):
        for shape in link.shapes:
            block = etree.SubElement(element, tag)
            etree.SubElement(block, "origin", xyz=numbers(shape.at), rpy=numbers(shape.rpy))
            geometry = etree.SubElement(block, "geometry")
            if len(shape.size) == 3:
                etree.SubElement(geometry, "box", size=numbers(shape.size))
            else:
                radius, length = (numbers([value]) for value in shape.size)
                etree.SubElement(geometry, "cylinder", radius=radius, length=length)
            if tag == "visual":
                etree.SubElement(block, "material", name=shape.color)


def _add_inertial(element: etree._Element, link: _Link) -> None:
    """Mass properties of shapes of one density."""
    volumes = np.array([shape.volume for shape in link.shapes])
    masses = link.mass * volumes / volumes.sum()
    middles = np.array([shape.at for shape in link.shapes])
    center = masses @ middles / link.mass
    tensor = np.zeros((3, 3))
    for mass, middle, shape in zip(masses, middles, link.shapes, strict=True):
        arm = middle - center
        tensor += mass * (shape.moments + float(arm @ arm) * np.eye(3) - np.outer(arm, arm))
    block = etree.SubElement(element, "inertial")
    etree.SubElement(block, "origin", xyz=numbers(center), rpy="0 0 0")
    etree.SubElement(block, "mass", value=numbers([link.mass]))
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = tensor.tolist()
    moments = {"ixx": ixx, "ixy": ixy, "ixz": ixz, "iyy": iyy, "iyz": iyz, "izz": izz}
    etree.SubElement(block, "inertia", {key: numbers([value]) for key, value in moments.items()})


def _add_joint(robot: etree._Element, joint: _Joint) -> None:
    element = etree.SubElement(robot, "joint", name=joint.name, type=joint.kind)
    etree.SubElement(element, "parent", link=joint.parent)
    etree.SubElement(element, "child", link=joint.child)
    etree.SubElement(element, "origin", xyz=numbers(joint.at), rpy=numbers(joint.rpy))
    if joint.kind == "fixed":
        return
    etree.SubElement(element, "axis", xyz=numbers(joint.axis))
    lower, upper = (numbers([value]) for value in joint.limits)
    drive = {"effort": numbers([joint.effort]), "velocity": numbers([joint.velocity])}
    etree.SubElement(element, "limit", {"lower": lower, "upper": upper, **drive})
    etree.SubElement(element, "dynamics", damping=numbers([joint.damping]))


def _rotation(rpy: Triple) -> FloatArray:
    """Matrix of turns about the fixed x, y and z axes, shape (3, 3)."""
    roll, pitch, yaw = (rotation_about(np.eye(3)[k], angle) for k, angle in enumerate(rpy))
    return np.asarray(yaw @ pitch @ roll)
