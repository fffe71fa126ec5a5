"""Hints: what the user knows about single joints decides; geometry fills in the rest and says where it disagrees.

A hint names a part and what moves it: ``door_1=prismatic`` gives the type, ``lid:axis=x`` the direction of the axis
in the world, ``lid:pivot=0.1,0,0.9`` a point that a hinge goes through. What is not said, the opening direction and
the limits come from the best candidate that agrees.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.joints.candidate import JointCandidate
from kinematify.refinement.candidates import CandidateJoints, described
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline import Inference
    from kinematify.robot.arrays import FloatArray

TYPES = {str(kind): kind for kind in JointType}
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
HINTED = "hinted"
"""1 in `JointEstimate.evidence` where the user said what the joint is: no failure overrules that."""
_NEAR = np.cos(np.radians(30.0))  # a candidate along the named axis: parts are tilted, and people name the nearest
_SAME = np.cos(np.radians(1.0))  # a candidate along an axis that is given by its numbers
_THROUGH = 0.005  # of the object's diagonal: a candidate that goes through the point that is given
_HELD = 0.1  # a slide that is stopped within a tenth of the part's length has no way to go
_FORMS = (
    "Write PART=TYPE, PART:axis=AXIS, PART:pivot=X,Y,Z or PART:limits=LOWER,UPPER, as in `door_1=prismatic`, "
    "`lid:axis=x` (numbers do as well: `lid:axis=0.7,0,0.7`), `lid:pivot=0.1,0,0.9` and `lid:limits=0,1.57`."
)


@dataclass(frozen=True, kw_only=True)
class Hint:
    """What is known of the joint above one part."""

    part: str
    kind: JointType | None = None
    axis: str | None = None
    """Of `AXES`, or three numbers with commas between them, world frame."""
    pivot: str | None = None
    """A point on the axis, world frame [m], written in the same way."""
    limits: str | None = None
    """Lower and upper limit [rad or m], two numbers with a comma between them, along `axis` or else along the axis that
    the joint had."""

    @property
    def texts(self) -> tuple[str, ...]:
        """As it is typed."""
        stated = (("", self.kind), (":axis", self.axis), (":pivot", self.pivot), (":limits", self.limits))
        return tuple(f"{self.part}{key}={value}" for key, value in stated if value is not None)

    @property
    def direction(self) -> FloatArray | None:
        """Unit direction of the axis, shape (3,); None if the hint states none."""
        if self.axis is None:
            return None
        given = np.array(AXES[self.axis]) if self.axis in AXES else _vector(self.axis)
        assert given is not None
        unit: FloatArray = given / np.linalg.norm(given)
        return unit

    def agrees(self, axis: FloatArray) -> bool:
        """Whether a unit direction is the one that is named, or one is near enough to it."""
        named = self.direction
        return named is None or bool(abs(float(axis @ named)) > (_NEAR if self.axis in AXES else _SAME))


def parse_hints(texts: Sequence[str], parts: Sequence[str], *, base: str | None = None) -> tuple[Hint, ...]:
    """Read hints as they are typed; those on one part are taken together.

    Args:
        texts: ``PART=TYPE``, ``PART:axis=AXIS``, ``PART:pivot=X,Y,Z`` and ``PART:limits=LOWER,UPPER``.
        parts: Names that there are.
        base: Part that is said to be the base link, if any.

    Raises:
        InputError: A hint cannot be read, names no part, or contradicts another one; the message has the choices.
    """
    found: dict[str, Hint] = {}
    for text in texts:
        hint = _parsed(text, parts)
        known = found.get(hint.part, Hint(part=hint.part))
        for name in ("kind", "axis", "pivot", "limits"):
            old, new = getattr(known, name), getattr(hint, name)
            if old is not None and new is not None and old != new:
                raise InputError(
                    f"The hints contradict each other: the joint of {hint.part} cannot be both {old} and {new}. "
                    "Keep one of them."
                )
        found[hint.part] = Hint(
            part=hint.part,
            kind=hint.kind or known.kind,
            axis=hint.axis or known.axis,
            pivot=hint.pivot or known.pivot,
            limits=hint.limits or known.limits,
        )
    for hint in found.values():
        if hint.kind is JointType.FIXED and hint.axis is not None:
            raise InputError(
                f"The hints contradict each other: {hint.part} cannot be fixed and have an axis along {hint.axis}. "
                "Keep one of them."
            )
        if hint.kind in (JointType.FIXED, JointType.CONTINUOUS) and hint.limits is not None:
            raise InputError(
                f"The hints contradict each other: {hint.part} cannot be {hint.kind} and have limits. Keep one of them."
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
    name, value = left.strip(), value.strip().lower()
    for ending in (":axis", ":pivot", ":limits"):
        name = name.removesuffix(ending)
    if not name or not value:
        raise InputError(f"The hint {text!r} cannot be read. {_FORMS}")
    if name not in parts:
        near = difflib.get_close_matches(name, parts, n=3, cutoff=0.6)
        meant = f"Did you mean {' or '.join(near)}?" if near else f"The parts are {', '.join(parts)}."
        raise InputError(f"The hint {text!r} names no part of the input. {meant}")
    if left.endswith(":pivot"):
        if _vector(value) is None:
            raise InputError(f"The hint {text!r} asks for the pivot {value!r}. Give three numbers [m]. {_FORMS}")
        return Hint(part=name, pivot=value)
    if left.endswith(":limits"):
        ends = _vector(value, 2)
        if ends is None or not ends[0] <= 0.0 <= ends[1] or ends[0] == ends[1]:
            raise InputError(
                f"The hint {text!r} asks for the limits {value!r}. Give two numbers [rad or m] with zero, which is the "
                f"pose of the input, between them. {_FORMS}"
            )
        return Hint(part=name, limits=value)
    choices = list(AXES if left.endswith(":axis") else TYPES)
    numbers = _vector(value) if left.endswith(":axis") else None
    if value not in choices and (numbers is None or not numbers.any()):
        raise InputError(f"The hint {text!r} asks for {value!r}. Choose one of {', '.join(choices)}. {_FORMS}")
    if left.endswith(":axis"):
        return Hint(part=name, axis=value)
    return Hint(part=name, kind=TYPES[value])


def _vector(text: str, count: int = 3) -> FloatArray | None:
    """Numbers with commas between them; None if the text is anything else."""
    try:
        found = np.array([float(word) for word in text.split(",")])
    except ValueError:
        return None
    return found if found.shape == (count,) and np.isfinite(found).all() else None


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
    spoken = {hint.part for hint in hints}
    earlier = tuple(text for text in inference.hints if text.partition("=")[0].partition(":")[0] not in spoken)
    texts = tuple(text for hint in hints for text in hint.texts)
    return replace(inference, joints=tuple(joints), warnings=tuple(warnings), hints=(*earlier, *texts))


def _hinted(inference: Inference, maker: CandidateJoints, joint: JointEstimate, hint: Hint) -> JointEstimate:
    """The joint that agrees with a hint; its confidence is that of the user."""
    if hint.kind is JointType.FIXED:
        return _told(replace(joint, kind=JointType.FIXED, lower=0.0, upper=0.0))
    candidate = _best(joint, hint, _THROUGH * inference.assembly.diagonal)
    found = maker.realise(inference.trees[0], joint, candidate)
    if hint.kind is JointType.CONTINUOUS:
        found = replace(found, kind=JointType.CONTINUOUS, lower=-np.inf, upper=np.inf)
    elif hint.kind is JointType.REVOLUTE and found.kind is JointType.CONTINUOUS:
        found = replace(found, kind=JointType.REVOLUTE, lower=-np.pi, upper=np.pi)
    if hint.limits is not None:
        found = _limited(found, hint, joint)
    return _told(found)


def _limited(found: JointEstimate, hint: Hint, before: JointEstimate) -> JointEstimate:
    """The joint with the limits of a hint, which are along the axis that was named, or had before."""
    ends = _vector(hint.limits or "", 2)
    assert ends is not None
    named = before.axis if hint.direction is None else hint.direction
    lower, upper = ends if float(found.axis @ named) >= 0.0 else -ends[::-1]
    kind = JointType.REVOLUTE if found.kind is JointType.CONTINUOUS else found.kind
    return replace(found, kind=kind, lower=float(lower), upper=float(upper))


def _told(joint: JointEstimate) -> JointEstimate:
    return replace(joint, confidence=1.0, evidence={**joint.evidence, HINTED: 1.0})


def _best(joint: JointEstimate, hint: Hint, reach: float) -> JointCandidate:
    """The best candidate that agrees with a hint, its pivot to within reach [m]; else the joint that it asks for."""
    own = _of_estimate(joint)
    every = (*([own] if own else []), *joint.alternatives)
    turns = None if hint.kind is None else hint.kind.turns
    pivot = None if hint.pivot is None else _vector(hint.pivot)
    for candidate in every:
        if (turns is None or candidate.kind.turns == turns) and hint.agrees(candidate.axis):
            off = np.zeros(3) if pivot is None else np.cross(pivot - candidate.pivot, candidate.axis)
            if not candidate.kind.turns or float(np.linalg.norm(off)) <= reach:
                return candidate
    kind = joint.kind if turns is None else JointType.REVOLUTE if turns else JointType.PRISMATIC
    place = joint.pivot if pivot is None else pivot
    return JointCandidate(kind=kind, axis=_direction(every, hint, joint), pivot=place, score=0.0, source="hint")


def _direction(every: Sequence[JointCandidate], hint: Hint, joint: JointEstimate) -> FloatArray:
    """The axis that is asked for, square to the part where a candidate of any type runs that way."""
    named = hint.direction
    if named is None:
        return joint.axis
    return next((item.axis for item in every if hint.agrees(item.axis)), named)


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
