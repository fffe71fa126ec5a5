"""Hints: what the user knows about single joints decides; geometry fills in the rest and says where it disagrees.

A hint names a part and what moves it: ``door_1=prismatic`` gives the type, ``lid:axis=x`` the direction of the axis
in the world. The line, the opening direction and the limits come from the best candidate that agrees.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.joints.candidate import JointCandidate
from kinematify.refinement.candidates import CandidateJoints
from kinematify.refinement.words import described
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline import Inference
    from kinematify.robot.arrays import FloatArray

TYPES = {str(kind): kind for kind in JointType}
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_NEAR = np.cos(np.radians(30.0))  # a candidate along the named axis: parts are tilted, and people name the nearest
_HELD = 0.1  # a slide that is stopped within a tenth of the part's length has no way to go
_FORMS = "Write PART=TYPE or PART:axis=AXIS, as in `door_1=prismatic` and `lid:axis=x`."


@dataclass(frozen=True, kw_only=True)
class Hint:
    """What is known of the joint above one part."""

    part: str
    kind: JointType | None = None
    axis: str | None = None
    """Of `AXES`."""


def parse_hints(texts: Sequence[str], parts: Sequence[str], *, base: str | None = None) -> tuple[Hint, ...]:
    """Read hints as they are typed; those on one part are taken together.

    Args:
        texts: ``PART=TYPE`` and ``PART:axis=AXIS``.
        parts: Names that there are.
        base: Part that is said to be the base link, if any.

    Raises:
        InputError: A hint cannot be read, names no part, or contradicts another one; the message has the choices.
    """
    found: dict[str, Hint] = {}
    for text in texts:
        hint = _parsed(text, parts)
        known = found.get(hint.part, Hint(part=hint.part))
        for name in ("kind", "axis"):
            old, new = getattr(known, name), getattr(hint, name)
            if old is not None and new is not None and old != new:
                raise InputError(
                    f"The hints contradict each other: the joint of {hint.part} cannot be both {old} and {new}. "
                    "Keep one of them."
                )
        found[hint.part] = Hint(part=hint.part, kind=hint.kind or known.kind, axis=hint.axis or known.axis)
    for hint in found.values():
        if hint.kind is JointType.FIXED and hint.axis is not None:
            raise InputError(
                f"The hints contradict each other: {hint.part} cannot be fixed and have an axis along {hint.axis}. "
                "Keep one of them."
            )
        if hint.part == base:
            raise _about_the_base(hint.part)
    return tuple(found.values())


def _about_the_base(part: str) -> InputError:
    return InputError(
        f"A hint is about {part}, which is the base link and has no joint above it. Give another base with --base, or "
        "leave out the hint."
    )


def _parsed(text: str, parts: Sequence[str]) -> Hint:
    left, _, value = text.rpartition("=")
    name, value = left.removesuffix(":axis").strip(), value.strip().lower()
    if not name or not value:
        raise InputError(f"The hint {text!r} cannot be read. {_FORMS}")
    if name not in parts:
        near = difflib.get_close_matches(name, parts, n=3, cutoff=0.6)
        meant = f"Did you mean {' or '.join(near)}?" if near else f"The parts are {', '.join(parts)}."
        raise InputError(f"The hint {text!r} names no part of the input. {meant}")
    choices = list(AXES if left.endswith(":axis") else TYPES)
    if value not in choices:
        raise InputError(f"The hint {text!r} asks for {value!r}. Choose one of {', '.join(choices)}. {_FORMS}")
    if left.endswith(":axis"):
        return Hint(part=name, axis=value)
    return Hint(part=name, kind=TYPES[value])


def with_hints(inference: Inference, hints: Sequence[Hint]) -> Inference:
    """Choose the joints anew that hints speak of.

    Raises:
        InputError: A hint is about the base link, which has no joint above it.
    """
    names = list(inference.assembly.names)
    maker = CandidateJoints(inference.assembly, inference.graph, inference.bearings, inference.config)
    joints, warnings = list(inference.joints), list(inference.warnings)
    for hint in hints:
        place = next((k for k, joint in enumerate(joints) if names[joint.child] == hint.part), None)
        if place is None:
            raise _about_the_base(hint.part)
        before = joints[place]
        joints[place] = _hinted(inference, maker, before, hint)
        warnings += _objections(joints[place], hint, inference, before)
    return replace(inference, joints=tuple(joints), warnings=tuple(warnings))


def _hinted(inference: Inference, maker: CandidateJoints, joint: JointEstimate, hint: Hint) -> JointEstimate:
    """The joint that agrees with a hint; its confidence is that of the user."""
    if hint.kind is JointType.FIXED:
        return replace(joint, kind=JointType.FIXED, lower=0.0, upper=0.0, confidence=1.0)
    candidate = _best(joint, hint)
    found = maker.realise(inference.trees[0], joint, candidate)
    if hint.kind is JointType.CONTINUOUS:
        found = replace(found, kind=JointType.CONTINUOUS, lower=-np.inf, upper=np.inf)
    elif hint.kind is JointType.REVOLUTE and found.kind is JointType.CONTINUOUS:
        found = replace(found, kind=JointType.REVOLUTE, lower=-np.pi, upper=np.pi)
    return replace(found, confidence=1.0)


def _best(joint: JointEstimate, hint: Hint) -> JointCandidate:
    """The best candidate that agrees with a hint; where none does, a joint along the axis that is asked for."""
    own = _of_estimate(joint)
    every = (*([own] if own else []), *joint.alternatives)
    turns = None if hint.kind is None else hint.kind.turns
    named = None if hint.axis is None else np.array(AXES[hint.axis])
    for candidate in every:
        if (turns is None or candidate.kind.turns == turns) and (
            named is None or abs(float(candidate.axis @ named)) > _NEAR
        ):
            return candidate
    kind = joint.kind if turns is None else JointType.REVOLUTE if turns else JointType.PRISMATIC
    return JointCandidate(kind=kind, axis=_direction(every, named, joint), pivot=joint.pivot, score=0.0, source="hint")


def _direction(every: Sequence[JointCandidate], named: FloatArray | None, joint: JointEstimate) -> FloatArray:
    """The axis that is asked for, square to the part where a candidate of any type runs that way."""
    if named is None:
        return joint.axis
    return next((item.axis for item in every if abs(float(item.axis @ named)) > _NEAR), named)


def _of_estimate(joint: JointEstimate) -> JointCandidate | None:
    if joint.kind is JointType.FIXED:
        return None
    kind = JointType.REVOLUTE if joint.kind.turns else joint.kind
    return JointCandidate(kind=kind, axis=joint.axis, pivot=joint.pivot, score=0.0, source="chosen")


def _objections(joint: JointEstimate, hint: Hint, inference: Inference, before: JointEstimate) -> list[str]:
    """What speaks against a hint that was followed: the part can hardly move that way; and what the geometry says."""
    if joint.kind is JointType.FIXED:
        return []
    free = max(joint.evidence.get("free_forward", np.inf), joint.evidence.get("free_backward", np.inf))
    length = float(np.ptp(inference.assembly.parts[joint.child].vertices @ joint.axis))
    if joint.kind.turns and free < np.radians(inference.config.joints.limits.least_deg):
        stopped = f"turns by {np.degrees(free):.1f} deg"
    elif not joint.kind.turns and free < _HELD * length:
        stopped = f"slides by {1e3 * free:.1f} mm"
    else:
        return []
    said = f"The hint on {hint.part} is followed, but the part only {stopped} before it meets another one."
    return [f"{said} Without the hint it is {described(before)}."]
