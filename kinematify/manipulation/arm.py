"""The project's own arm: seven turning joints and a parallel gripper, made of boxes and cylinders only.

Proportions and limits are those of common research arms with a reach of 0.85 m. Collision shapes leave gaps of a few
millimetres at the joints, so that neighbours touch in no configuration and no pair has to be ignored.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Inertial, Joint, Link, Robot
from kinematify.robot.transforms import rotation_from_rpy
from kinematify.robot.urdf_geometry import primitive
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Shape

Triple = tuple[float, float, float]
Color = tuple[float, float, float, float]

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
_LIGHT: Color = (0.91, 0.92, 0.94, 1.0)
_DARK: Color = (0.22, 0.24, 0.28, 1.0)
_ACCENT: Color = (0.95, 0.55, 0.16, 1.0)


@dataclass(frozen=True)
class _Shape:
    """A box (x, y, z) or, with two sizes, a cylinder (radius, length) [m], in the link frame."""

    size: tuple[float, ...]
    at: Triple = (0.0, 0.0, 0.0)
    rpy: Triple = (0.0, 0.0, 0.0)
    color: Color = _LIGHT

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
        turn = rotation_from_rpy(np.array(self.rpy))
        return np.asarray(turn @ np.diag(own) @ turn.T)

    def built(self, color: Color | None) -> Shape:
        """The shape as a link has it."""
        return primitive("box" if len(self.size) == 3 else "cylinder", self.size, _frame(self.at, self.rpy), color)


@dataclass(frozen=True)
class _Link:
    name: str
    mass: float
    """[kg]."""
    shapes: tuple[_Shape, ...]

    def built(self) -> Link:
        """The link with mass properties of shapes of one density."""
        return Link(
            name=self.name,
            inertial=self._inertial() if self.shapes else None,
            visuals=tuple(shape.built(shape.color) for shape in self.shapes),
            collisions=tuple(shape.built(None) for shape in self.shapes),
        )

    def _inertial(self) -> Inertial:
        volumes = np.array([shape.volume for shape in self.shapes])
        masses = self.mass * volumes / volumes.sum()
        middles = np.array([shape.at for shape in self.shapes])
        center = masses @ middles / self.mass
        tensor = np.zeros((3, 3))
        for mass, middle, shape in zip(masses, middles, self.shapes, strict=True):
            arm = middle - center
            tensor += mass * (shape.moments + float(arm @ arm) * np.eye(3) - np.outer(arm, arm))
        return Inertial(mass=self.mass, center_of_mass=center, tensor=tensor, source="volume")


def _frame(at: Triple, rpy: Triple = (0.0, 0.0, 0.0)) -> FloatArray:
    T = np.eye(4)
    T[:3, :3] = rotation_from_rpy(np.array(rpy))
    T[:3, 3] = at
    return T


_ALONG_Y = (_RIGHT, 0.0, 0.0)

_LINKS = (
    _Link("base", 6.0, (_Shape((0.20, 0.18, 0.03), (-0.02, 0.0, 0.017)), _Shape((0.065, 0.13), (0.0, 0.0, 0.10)))),
    _Link("shoulder", 3.2, (_Shape((0.045, 0.094), (0.0, 0.0, -0.113), color=_DARK),)),
    _Link(
        "upper_arm",
        3.2,
        (
            _Shape((0.058, 0.13), color=_LIGHT),
            _Shape((0.052, 0.085), (0.0, -0.105, 0.0), _ALONG_Y),
        ),
    ),
    _Link(
        "elbow",
        2.8,
        (
            _Shape((0.05, 0.082), (0.0, 0.0, -0.1245), color=_DARK),
            _Shape((0.11, 0.08, 0.025), (0.005, 0.0, -0.0685), color=_DARK),
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
    _Link("wrist", 2.2, (_Shape((0.045, 0.122), (0.0, 0.0, -0.117), color=_DARK),)),
    _Link(
        "flange",
        1.4,
        (_Shape((0.046, 0.085)), _Shape((0.085, 0.066, 0.066), (0.0875, 0.0, 0.0))),
    ),
    _Link("turntable", 0.5, (_Shape((0.036, 0.03), (0.0, 0.0, 0.052), color=_DARK),)),
    _Link(
        "hand",
        0.8,
        (_Shape((0.032, 0.035), (0.0, 0.0, -0.022), color=_DARK), _Shape((0.05, 0.15, 0.045), (0.0, 0.0, 0.02))),
    ),
    *(
        _Link(
            name,
            0.12,
            (
                _Shape((0.022, 0.02, 0.025), (0.0, sign * (_CLOSED + 0.01), 0.0165), color=_DARK),
                _Shape((0.018, _PAD, 0.045), (0.0, sign * (_CLOSED + 0.5 * _PAD), 0.0515), color=_ACCENT),
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


def _turning(number: int, turn: _Turn) -> Joint:
    strong = number <= 4  # shoulder and elbow carry the rest
    return Joint(
        name=f"joint_{number}",
        kind=JointType.REVOLUTE,
        parent=turn.parent,
        child=turn.child,
        T_parent_child=_frame(turn.at, (turn.roll, 0.0, 0.0)),
        axis=np.array([0.0, 0.0, 1.0]),
        lower=turn.limits[0],
        upper=turn.limits[1],
        effort=90.0 if strong else 20.0,
        velocity=2.2 if strong else 2.6,
        damping=1.0 if strong else 0.2,
    )


def _sliding(name: str, child: str, side: float) -> Joint:
    return Joint(
        name=name,
        kind=JointType.PRISMATIC,
        parent="hand",
        child=child,
        T_parent_child=_frame((0.0, 0.0, 0.0405)),
        axis=np.array([0.0, side, 0.0]),
        upper=TRAVEL,
        effort=60.0,
        velocity=0.2,
        damping=5.0,
    )


def _fixed(name: str, parent: str, child: str, height: float) -> Joint:
    T_parent_child = _frame((0.0, 0.0, height))
    return Joint(name=name, kind=JointType.FIXED, parent=parent, child=child, T_parent_child=T_parent_child)


_JOINTS = (
    *(_turning(number, turn) for number, turn in enumerate(_TURNS, start=1)),
    _fixed("hand_joint", "turntable", "hand", _HAND),
    _sliding(FINGERS[0], "left_finger", 1.0),
    _sliding(FINGERS[1], "right_finger", -1.0),
    _fixed("tool_joint", "hand", TOOL, 0.107),
)

ARM_JOINTS = tuple(joint.name for joint in _JOINTS if joint.kind is JointType.REVOLUTE)


def write_arm(path: Path) -> None:
    """Write the arm as URDF: no mesh, one tag per line, mass and inertia of every link from its shapes.

    Raises:
        OSError: The file cannot be written.
    """
    write_robot(Robot(name="kinematify_arm", links=tuple(link.built() for link in _LINKS), joints=_JOINTS), path)
