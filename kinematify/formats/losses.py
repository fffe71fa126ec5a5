"""Losses of a format: one table of what it cannot say, for the command, its JSON and the docs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from kinematify.robot.robot import Joint, Robot

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


def _moving(has: Callable[[Joint], bool]) -> Callable[[Robot], int]:
    return lambda robot: sum(joint.kind is not JointType.FIXED and has(joint) for joint in robot.joints)


def _materials(robot: Robot) -> int:
    shown = [shape.mesh.appearance for link in robot.links for shape in link.visuals]
    return sum(look is not None and (len(look.materials) > 1 or look.is_textured) for look in shown)


_COUNTS: Mapping[str, Callable[[Robot], int]] = {
    "joints that move": _moving(lambda joint: True),
    "limits": _moving(lambda joint: bool(np.isfinite([joint.lower, joint.upper]).all())),
    "followers (mimic)": _moving(lambda joint: joint.mimic is not None),
    "closed loops": lambda robot: len(robot.loops),
    "friction": _moving(lambda joint: bool(joint.friction)),
    "damping": _moving(lambda joint: bool(joint.damping)),
    "effort": _moving(lambda joint: bool(joint.effort)),
    "speed limits": _moving(lambda joint: bool(joint.velocity)),
    "masses": lambda robot: sum(link.inertial is not None for link in robot.links),
    "collision pieces": lambda robot: sum(len(link.collisions) for link in robot.links),
    "materials and textures": _materials,
}
"""What a model may have, and how many of its joints, links or shapes have it."""

TREATMENT: Mapping[str, Mapping[str, str]] = {
    "urdf": {
        "closed loops": "drake:ball_constraint, which Drake closes; readers of trees alone ignore it",
        "materials and textures": "in the OBJ files; the URDF has one mean colour a shape",
    },
    "mjcf": {
        "followers (mimic)": "an equality between two joints, held softly",
        "closed loops": "an equality connect at the pin, held softly",
        "effort": "the control range of a motor, which is added for every joint that moves by itself",
        "speed limits": _NONE,
    },
    "usd": {
        "followers (mimic)": "NewtonMimicAPI, which Newton and nobody else reads",
        "closed loops": "a spherical joint outside of the articulation",
        "friction": "mjc:frictionloss and newton:friction; USD's own schema has none",
        "effort": "the largest force of a drive without stiffness, and the control range of a motor (MjcActuator)",
        "speed limits": "newton:velocityLimit; USD's own schema has none",
    },
    "sdf": {
        "closed loops": "a ball joint; the link then has two parents, which not every engine of Gazebo takes",
        "materials and textures": "in the OBJ files",
    },
    "glb": {
        "joints that move": "nodes; extras.kinematify has name, type and axis",
        "limits": "extras.kinematify",
        "followers (mimic)": _NONE,
        "closed loops": _NONE,
        "friction": _NONE,
        "damping": _NONE,
        "effort": _NONE,
        "speed limits": _NONE,
        "masses": _NONE,
        "collision pieces": _NONE,
    },
}
"""By format, what is not held as it is; all else of `_COUNTS` is."""


def losses(robot: Robot, to: str) -> tuple[Loss, ...]:
    """Return what a model has that a format does not hold as it is; nothing for a format that holds no model (srdf)."""
    treated = TREATMENT.get(to, {})
    found = (Loss(what=what, count=_COUNTS[what](robot), became=treated[what]) for what in _COUNTS if what in treated)
    return tuple(loss for loss in found if loss.count)


def losses_markdown() -> str:
    """Return the table of all formats, as docs/formats.md has it."""
    lines = [f"| | {' | '.join(TREATMENT)} |", "|---|" + "---|" * len(TREATMENT)]
    lines += [f"| {what} | {' | '.join(own.get(what, KEPT) for own in TREATMENT.values())} |" for what in _COUNTS]
    return "\n".join(lines)
