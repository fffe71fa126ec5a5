"""Losses of a format: one table of what it cannot say, for the command, its JSON and the docs."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from kinematify.formats.content import Content
    from kinematify.robot.robot import Joint, Link, Shape

KEPT = "kept"
_NONE = "omitted"


@dataclass(frozen=True, kw_only=True)
class Loss:
    """Something of a model that a format does not hold as it is."""

    what: str
    """E.g. ``speed limits``."""
    count: int
    """Joints, links or loops that have it."""
    became: str
    """What was written instead."""


def _moving(has: Callable[[Joint], bool]) -> Callable[[Content], int]:
    return lambda content: sum(joint.kind is not JointType.FIXED and has(joint) for joint in content.robot.joints)


def _shapes(has: Callable[[Shape], bool], of: Callable[[Link], tuple[Shape, ...]]) -> Callable[[Content], int]:
    return lambda content: sum(has(shape) for link in content.robot.links for shape in of(link))


_COUNTS: Mapping[str, Callable[[Content], int]] = {
    "joints that move": _moving(lambda joint: True),
    "limits": _moving(lambda joint: joint.is_limited),
    "followers (mimic)": _moving(lambda joint: joint.mimic is not None),
    "closed loops": lambda content: len(content.robot.loops),
    "friction": _moving(lambda joint: bool(joint.friction)),
    "damping": _moving(lambda joint: bool(joint.damping)),
    "springs (springStiffness)": lambda content: len(content.extensions.springs),
    "effort": _moving(lambda joint: bool(joint.effort)),
    "actuated joints without effort": lambda content: len(content.undriven),
    "speed limits": _moving(lambda joint: bool(joint.velocity)),
    "masses": lambda content: sum(link.inertial is not None for link in content.robot.links),
    "collision pieces": _shapes(lambda shape: True, lambda link: link.collisions),
    "capsules": _shapes(lambda shape: shape.kind == "capsule", lambda link: (*link.visuals, *link.collisions)),
    "links that overlap at rest": lambda content: len(content.apart),
    "surface friction (mu1, mu2)": lambda content: len(content.extensions.surfaces),
    "materials and textures": _shapes(lambda shape: shape.mesh.is_dressed, lambda link: link.visuals),
}
"""What a model may have, and how many of its joints, links or shapes have it."""
OTHERS = "all else that a URDF states (gazebo, transmission, ros2_control, safety_controller)"

TREATMENT: Mapping[str, Mapping[str, str]] = {
    "urdf": {
        "closed loops": "drake:ball_constraint; readers of trees alone ignore it",
        "capsules": "their triangles",
        "links that overlap at rest": "they collide in engines that let links of one model collide",
        "materials and textures": "in the OBJ files; the URDF has one mean colour a shape",
    },
    "mjcf": {
        "followers (mimic)": "an equality between two joints, held softly",
        "closed loops": "an equality connect at the pin, held softly",
        "effort": "the control range of a motor, which is added for every joint that moves by itself",
        "actuated joints without effort": "no motor, since none is stated above zero: {joints}",
        "speed limits": _NONE,
        "surface friction (mu1, mu2)": "mu1, as the sliding friction of geoms",
        OTHERS: _NONE,
    },
    "usd": {
        "followers (mimic)": "NewtonMimicAPI, which Newton and nobody else reads",
        "closed loops": "a spherical joint outside of the articulation",
        "friction": "mjc:frictionloss and newton:friction; USD's own schema has none",
        "effort": "the largest force of a drive without stiffness, and the control range of a motor (MjcActuator)",
        "actuated joints without effort": "no motor, since none is stated above zero: {joints}",
        "speed limits": "newton:velocityLimit; USD's own schema has none",
        "masses": "seven digits, as of all numbers of the physics schema",
        "springs (springStiffness)": "the stiffness of a drive towards the rest value",
        "surface friction (mu1, mu2)": "mu1, as the friction of a physics material",
        OTHERS: _NONE,
    },
    "sdf": {
        "closed loops": "a ball joint; the link then has two parents, which not every engine of Gazebo takes",
        "links that overlap at rest": "they collide once self_collide is on, which it is not",
        "materials and textures": "in the OBJ files",
        OTHERS: _NONE,
    },
    "glb": {
        "joints that move": "nodes; extras.kinematify has name, type and axis",
        "limits": "extras.kinematify",
        "followers (mimic)": _NONE,
        "closed loops": _NONE,
        "friction": _NONE,
        "damping": _NONE,
        "springs (springStiffness)": _NONE,
        "effort": _NONE,
        "speed limits": _NONE,
        "masses": _NONE,
        "collision pieces": _NONE,
        "surface friction (mu1, mu2)": _NONE,
        OTHERS: _NONE,
    },
}
"""By format, what is not held as it is; all else of `_COUNTS` is."""


def losses(content: Content, to: str) -> tuple[Loss, ...]:
    """Return what a model has that a format does not hold as it is, with what its URDF states besides."""
    treated = TREATMENT[to]
    joints = ", ".join(f"{joint.name} (effort {joint.effort or 0:g})" for joint in content.undriven)
    others = content.extensions.dropped + (content.extensions.lost if OTHERS in treated else Counter())
    rows = [
        (what, count(content), treated[what].format(joints=joints))
        for what, count in _COUNTS.items()
        if what in treated
    ]
    rows += [(what, count, _NONE) for what, count in sorted(others.items())]
    return tuple(Loss(what=what, count=count, became=became) for what, count, became in rows if count)
