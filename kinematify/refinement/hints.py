"""Hints: what the user knows about single joints decides; geometry fills in the rest and says where it disagrees.

A hint names a part and what moves it: ``door_1=prismatic`` gives the type, ``lid:axis=x`` the direction of the axis
in the world, ``lid:pivot=0.1,0,0.9`` a point that a hinge goes through, ``lid:range=0..1.57`` its limits,
``lid:parent=body`` what it hangs on, ``arm_2:twin=arm_1`` that it moves as another part does. What no hint gives comes
from the best candidate that agrees.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.contact.graph import pair
from kinematify.errors import InputError
from kinematify.joints.candidate import JointCandidate
from kinematify.pipeline.congruent_joints import carried
from kinematify.pipeline.stages import choose_joints, tree_reward, with_doubt_of_parents
from kinematify.pipeline.warnings import floating_parts, unlike_twins
from kinematify.refinement.arborescence import tree_with_parents
from kinematify.refinement.candidates import CandidateJoints, described
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.arrays import FloatArray

TYPES = {str(kind): kind for kind in JointType}
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
HINTED = "hinted"
"""1 in `JointEstimate.evidence` where the user said what the joint is: no failure overrules that."""
_NEAR = np.cos(np.radians(30.0))  # a candidate along the named axis: parts are tilted, and people name the nearest
_SAME = np.cos(np.radians(1.0))  # a candidate along an axis that is given by its numbers
_THROUGH = 0.005  # of the object's diagonal: a candidate that goes through the point that is given
_ROUNDED = 1e-4  # a full turn is typed as 6.2832 [rad]
_HELD_TURN = np.radians(5.0)  # less is the clearance of meshes
_HELD = 0.1  # a slide that is stopped within a tenth of the part's length has no way to go
_FORMS = (
    "Write PART=TYPE, PART:fixed, PART:axis=AXIS, PART:pivot=X,Y,Z, PART:range=LOWER..UPPER, PART:parent=LINK or "
    "PART:twin=PART, as in `door_1=prismatic`, `lid:axis=x` (or numbers: `lid:axis=0.7,0,0.7`), "
    "`lid:pivot=0.1,0,0.9`, `lid:range=0..1.57` (or `0..90deg`, `0..300mm`), `lid:parent=body`, `arm_2:twin=arm_1`."
)
_KEYS = ("axis", "pivot", "range", "parent", "twin")
_UNITS = {"deg": np.pi / 180.0, "rad": 1.0, "mm": 1e-3, "cm": 1e-2, "m": 1.0}


@dataclass(frozen=True, kw_only=True)
class Hint:
    """Facts about the joint above one part."""

    part: str
    kind: JointType | None = None
    axis: str | None = None
    """Of `AXES`, or three numbers with commas between them, world frame."""
    pivot: str | None = None
    """A point on the axis, world frame [m], written in the same way."""
    limits: str | None = None
    """Lower and upper limit, ``LOWER..UPPER`` [rad or m], or with one of `_UNITS` behind them, along `axis` or else
    along the axis that the joint had."""
    parent: str | None = None
    """Part that it hangs on."""
    twin: str | None = None
    """Part whose joint it has, carried over by the motion that lays that part upon this one."""

    @property
    def texts(self) -> tuple[str, ...]:
        """As it is typed."""
        stated = (("", self.kind), *((f":{key}", getattr(self, _field(key))) for key in _KEYS))
        return tuple(f"{self.part}{key}={value}" for key, value in stated if value is not None)

    @property
    def about_joint(self) -> bool:
        """True if it states anything of the joint itself."""
        return any(item is not None for item in (self.kind, self.axis, self.pivot, self.limits))

    @property
    def direction(self) -> FloatArray | None:
        """Unit direction of the axis, shape (3,); None if the hint states none."""
        if self.axis is None:
            return None
        given = np.array(AXES[self.axis]) if self.axis in AXES else _vector(self.axis)
        assert given is not None
        unit: FloatArray = given / np.linalg.norm(given)
        return unit

    @property
    def turns(self) -> bool | None:
        """Return whether it turns: by type, else by pivot, else by the unit of its range; None if it states none."""
        return self.kind.turns if self.kind else bool(self.pivot) or _is_angle(self.limits)

    def agrees(self, axis: FloatArray) -> bool:
        """True if a unit direction is the one that is named, or one is near enough to it."""
        named = self.direction
        return named is None or bool(abs(float(axis @ named)) > (_NEAR if self.axis in AXES else _SAME))


def parse_hints(texts: Sequence[str], parts: Sequence[str], *, base: str | None = None) -> tuple[Hint, ...]:
    """Read hints as they are typed; those on one part are taken together.

    Args:
        texts: As `_FORMS` has them.
        parts: Names that there are.
        base: Part that is said to be the base link, if any.

    Raises:
        InputError: A hint cannot be read, names no part, or contradicts another one; the message has the choices.
    """
    found: dict[str, Hint] = {}
    for text in texts:
        hint = _parsed(text, parts)
        known = found.get(hint.part, Hint(part=hint.part))
        stated = {name: value for name in _FIELDS if (value := getattr(hint, name)) is not None}
        for name, new in stated.items():
            old = getattr(known, name)
            if old is not None and old != new:
                raise _contradiction(f"the joint of {hint.part} cannot be both {old} and {new}")
        found[hint.part] = replace(known, **stated)
    for hint in found.values():
        _check(hint)
        if hint.part == base:
            raise _about_the_base(hint.part)
    _check_circles(found, "parent", "hang on each other")
    _check_circles(found, "twin", "are each the model of the other one")
    return tuple(found.values())


def _check(hint: Hint) -> None:
    """Refuse a hint that contradicts itself."""
    angle = _is_angle(hint.limits)
    for kinds, said in (
        ((JointType.FIXED,), hint.axis and f"an axis along {hint.axis}"),
        ((JointType.FIXED, JointType.PRISMATIC), hint.pivot and f"a pivot at {hint.pivot}"),
        ((JointType.FIXED, JointType.CONTINUOUS), hint.limits and "limits"),
        ((JointType.PRISMATIC if angle else JointType.REVOLUTE,), angle is not None and f"the range {hint.limits}"),
        ((None,), angle is False and hint.pivot and f"both a pivot and the range {hint.limits}"),
    ):
        if said and hint.kind in kinds:
            raise _contradiction(f"{hint.part} cannot {'' if hint.kind is None else f'be {hint.kind} and '}have {said}")
    if hint.twin is not None and hint.about_joint:
        raise _contradiction(f"{hint.part} takes its joint from {hint.twin} and cannot have one of its own")
    if angle or hint.kind is JointType.REVOLUTE:
        _check_turn(hint)


def _check_turn(hint: Hint) -> None:
    """Refuse a range of a turn that reaches poses twice."""
    ends = _ends(hint.limits or "")
    if ends is not None and float(np.ptp(ends)) > 2.0 * np.pi + _ROUNDED:
        raise InputError(
            f"The hint {hint.part}:range={hint.limits} spans {np.degrees(np.ptp(ends)):.0f} deg. A limited turn has "
            f"360 deg at most, since beyond that it reaches every pose twice. Write {hint.part}=continuous for what "
            "turns without end, or give a unit of length for what slides."
        )


def _check_circles(hints: Mapping[str, Hint], name: str, said: str) -> None:
    """Refuse hints of which one leads to the next and back to the first."""
    for start in hints:
        chain = [start]
        while chain[-1] in hints and (above := getattr(hints[chain[-1]], name)) is not None:
            if above in chain:
                raise _contradiction(f"{' and '.join(sorted(chain))} {said}")
            chain.append(above)


def _contradiction(reason: str) -> InputError:
    return InputError(f"The hints contradict each other: {reason}. Keep one of them.")


def _about_the_base(part: str) -> InputError:
    return InputError(
        f"A hint is about {part}, which is the base link and has no joint above it. Give another base with --base, or "
        "leave out the hint."
    )


def _parsed(text: str, parts: Sequence[str]) -> Hint:
    left, _, value = text.rpartition("=")
    if text.strip().endswith(":fixed"):
        left, value = text.strip().removesuffix(":fixed"), "fixed"
    name, value = left.strip(), value.strip()
    key = next((key for key in _KEYS if name.endswith(f":{key}")), "")
    name = name.removesuffix(f":{key}")
    if not name or not value:
        raise InputError(f"The hint {text!r} cannot be read. {_FORMS}")
    _check_part(text, name, parts)
    if key in ("parent", "twin"):
        _check_part(text, value, parts)
        if value == name:
            raise InputError(f"The hint {text!r} names {name} twice: a part is neither its own parent nor its twin.")
    else:
        value = value.lower()
    if key == "pivot" and _vector(value) is None:
        raise InputError(f"The hint {text!r} asks for the pivot {value!r}. Give three numbers [m]. {_FORMS}")
    if key == "range":
        ends = _ends(value)
        if ends is None or not ends[0] <= 0.0 <= ends[1] or ends[0] == ends[1]:
            raise InputError(
                f"The hint {text!r} asks for the range {value!r}. Give two numbers [rad or m] with zero, which is the "
                f"pose of the input, between them. {_FORMS}"
            )
    if key in ("", "axis"):
        choices = list(AXES if key else TYPES)
        numbers = _vector(value) if key else None
        if value not in choices and (numbers is None or not numbers.any()):
            raise InputError(f"The hint {text!r} asks for {value!r}. Choose one of {', '.join(choices)}. {_FORMS}")
    stated: dict[str, Any] = {_field(key): value if key else TYPES[value]}
    return replace(Hint(part=name), **stated)


def _check_part(text: str, name: str, parts: Sequence[str]) -> None:
    if name not in parts:
        near = difflib.get_close_matches(name, parts, n=3, cutoff=0.6)
        meant = f"Did you mean {' or '.join(near)}?" if near else f"The parts are {', '.join(parts)}."
        raise InputError(f"The hint {text!r} names no part of the input. {meant}")


def _field(key: str) -> str:
    """Name of the field of a hint that a key sets."""
    return {"": "kind", "range": "limits"}.get(key, key)


_FIELDS = ("kind", *map(_field, _KEYS))


def _ends(text: str) -> FloatArray | None:
    """Lower and upper limit [rad or m]; None if the text is anything else."""
    unit = next((unit for unit in _UNITS if text.endswith(unit)), "")
    found = _vector(text.removesuffix(unit).replace("..", ","), 2)
    return None if found is None else found * _UNITS.get(unit, 1.0)


def _is_angle(limits: str | None) -> bool | None:
    """Test whether a range is in degrees or radians, not in a unit of length; None if it has no unit."""
    return next((unit in ("deg", "rad") for unit in _UNITS if (limits or "").endswith(unit)), None)


def _vector(text: str, count: int = 3) -> FloatArray | None:
    """Numbers with commas between them; None if the text is anything else."""
    try:
        found = np.array([float(word) for word in text.split(",")])
    except ValueError:
        return None
    return found if found.shape == (count,) and np.isfinite(found).all() else None


def with_hints(inference: Inference, hints: Sequence[Hint]) -> Inference:
    """Choose the joints again that hints speak of.

    Raises:
        InputError: A hint is about the base link, which has no joint above it.
    """
    names = list(inference.assembly.names)
    base = names[inference.trees[0].root]
    if any(base in (hint.part, hint.twin) for hint in hints):
        raise _about_the_base(base)
    parents = {names.index(hint.part): names.index(hint.parent) for hint in hints if hint.parent is not None}
    if parents:
        inference = with_parents(inference, parents)
    maker = CandidateJoints(inference.assembly, inference.graph, inference.bearings, inference.config)
    joints, warnings = list(inference.joints), list(inference.warnings)
    place = {names[joint.child]: k for k, joint in enumerate(joints)}
    for hint in _models_first(hints):
        old = joints[place[hint.part]]
        if hint.twin is not None:
            joints[place[hint.part]] = _as_twin(inference, joints[place[hint.twin]], old)
        elif hint.about_joint:
            joints[place[hint.part]] = _hinted(inference, maker, old, hint)
            warnings += _objections(joints[place[hint.part]], hint, inference, old)
    spoken = {hint.part for hint in hints}
    earlier = tuple(text for text in inference.hints if text.partition("=")[0].partition(":")[0] not in spoken)
    before, after = (
        unlike_twins(inference.assembly, inference.graph, inference.trees[0], found)
        for found in (inference.joints, joints)
    )
    said = (*(text for text in warnings if text not in before), *after)
    texts = (*earlier, *(text for hint in hints for text in hint.texts))
    return replace(inference, joints=tuple(joints), warnings=said, hints=texts)


def _models_first(hints: Sequence[Hint]) -> list[Hint]:
    """The hints in an order in which a part comes after the one whose joint it takes."""
    twin_of = {hint.part: hint.twin for hint in hints if hint.twin is not None}

    def steps(part: str) -> int:
        return 1 + steps(twin_of[part]) if part in twin_of else 0

    return sorted(hints, key=lambda hint: steps(hint.part))


def _as_twin(inference: Inference, model: JointEstimate, joint: JointEstimate) -> JointEstimate:
    """A joint as that of the part of which the user said that it is its twin."""
    names = inference.assembly.names
    found = next(carried(inference.assembly, inference.graph, model, joint), None)
    if found is None:
        raise InputError(
            f"The hint {names[joint.child]}:twin={names[model.child]} cannot be followed: no motion or reflection "
            f"lays {names[model.child]} and its contact with {names[model.parent]} upon {names[joint.child]} and its "
            f"contact with {names[joint.parent]}. Give the joint of {names[joint.child]} by its type, axis and range."
        )
    return _certain(found)


def _hinted(inference: Inference, maker: CandidateJoints, joint: JointEstimate, hint: Hint) -> JointEstimate:
    """The joint that agrees with a hint; its confidence is that of the user."""
    if hint.kind is JointType.FIXED:
        return _certain(replace(joint, kind=JointType.FIXED, lower=0.0, upper=0.0))
    candidate = _best(joint, hint, _THROUGH * inference.assembly.diagonal)
    found = maker.realise(inference.trees[0], joint, candidate)
    if hint.kind is JointType.CONTINUOUS:
        found = replace(found, kind=JointType.CONTINUOUS, lower=-np.inf, upper=np.inf)
    elif hint.kind is JointType.REVOLUTE and found.kind is JointType.CONTINUOUS:
        found = replace(found, kind=JointType.REVOLUTE, lower=-np.pi, upper=np.pi)
    if hint.limits is not None:
        found = _limited(found, hint, joint)
    return _certain(found)


def _limited(found: JointEstimate, hint: Hint, before: JointEstimate) -> JointEstimate:
    """The joint with the limits of a hint, which are along the axis that was named, or had before."""
    ends = _ends(hint.limits or "")
    assert ends is not None
    if found.kind.turns:
        _check_turn(hint)
    named = before.axis if hint.direction is None else hint.direction
    lower, upper = ends if float(found.axis @ named) >= 0.0 else -ends[::-1]
    kind = JointType.REVOLUTE if found.kind is JointType.CONTINUOUS else found.kind
    return replace(found, kind=kind, lower=float(lower), upper=float(upper), stops=("a hint", "a hint"))


def _certain(joint: JointEstimate) -> JointEstimate:
    return replace(joint, confidence=1.0, evidence={**joint.evidence, HINTED: 1.0})


def _best(joint: JointEstimate, hint: Hint, reach: float) -> JointCandidate:
    """The best candidate that agrees with a hint, its pivot to within reach [m]; else the joint that it asks for."""
    every = joint.alternatives
    if joint.kind is not JointType.FIXED:
        own = JointType.REVOLUTE if joint.kind.turns else joint.kind
        every = (JointCandidate(kind=own, axis=joint.axis, pivot=joint.pivot, score=0.0, source="chosen"), *every)
    turns, pivot = hint.turns, None if hint.pivot is None else _vector(hint.pivot)
    for candidate in every:
        if (turns is None or candidate.kind.turns == turns) and hint.agrees(candidate.axis):
            off = np.zeros(3) if pivot is None else np.cross(pivot - candidate.pivot, candidate.axis)
            if not candidate.kind.turns or float(np.linalg.norm(off)) <= reach:
                return candidate
    kind = joint.kind if turns is None else JointType.REVOLUTE if turns else JointType.PRISMATIC
    place = joint.pivot if pivot is None else pivot
    axis = joint.axis
    if hint.direction is not None:  # square to the part where a candidate of any type runs that way
        axis = next((item.axis for item in every if hint.agrees(item.axis)), hint.direction)
    return JointCandidate(kind=kind, axis=axis, pivot=place, score=0.0, source="hint")


def _objections(joint: JointEstimate, hint: Hint, inference: Inference, before: JointEstimate) -> list[str]:
    """Return the objections to a hint that was followed: the part can hardly move so; and what the geometry says."""
    if joint.kind is JointType.FIXED:
        return []
    free = max(joint.evidence.get("free_forward", np.inf), joint.evidence.get("free_backward", np.inf))
    length = float(np.ptp(inference.assembly.parts[joint.child].vertices @ joint.axis))
    if joint.kind.turns and free < _HELD_TURN:
        stopped = f"turns by {np.degrees(free):.1f} deg"
    elif not joint.kind.turns and free < _HELD * length:
        stopped = f"slides by {1e3 * free:.1f} mm"
    else:
        return []
    said = f"The hint on {hint.part} is followed, but the part only {stopped} before it meets another one."
    return [f"{said} Without the hint it is {described(before)}."]


def with_parents(inference: Inference, parents: Mapping[int, int]) -> Inference:
    """The inference on the tree that hints ask for: parts hang where a hint says, others where they did if possible.

    Joints stay where neither parent nor what the part carries has changed; the others are chosen as `infer` would. A
    part has no bearing on the parent that it had before, so that no loop joint is written between them.

    Args:
        inference: As it is.
        parents: Parent of parts by index, neither the root nor in a circle.
    """
    before = inference.trees[0]
    if all(before.parents[child] == parent for child, parent in parents.items()):
        return inference
    assembly, graph, config = inference.assembly, inference.graph, inference.config
    tree = tree_with_parents(tree_reward(assembly, graph, inference.bearings, config), before, parents)
    known = {(joint.parent, joint.child, before.subtree(joint.child)): joint for joint in inference.joints}
    chosen = with_doubt_of_parents(choose_joints(assembly, graph, tree, inference.bearings, config), tree)
    joints = tuple(
        known.get((*edge, tree.subtree(edge[1])), joint) for edge, joint in zip(tree.edges(), chosen, strict=True)
    )
    old, new = (set(floating_parts(assembly, graph, item)) for item in (before, tree))
    warnings = tuple(warning for warning in inference.warnings if warning not in old - new)
    added = tuple(sorted(new - old - set(warnings)))
    others = tuple(other for other in inference.trees if other.parents != tree.parents)
    left = {pair(child, before.parents[child]) for child, parent in parents.items() if before.parents[child] != parent}
    bearings = {ends: bearing for ends, bearing in inference.bearings.items() if ends not in left}
    return replace(inference, trees=(tree, *others), joints=joints, bearings=bearings, warnings=(*warnings, *added))
