"""Wrong joints in true mechanisms, for `kinematify refine` to find and fix.

Contacts are measured, the tree and all joints are the true ones, and every joint keeps the candidates that inference
proposes for its edge, the right one among them. Then one joint is made wrong.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.erasure import ErasedModel
from kinematify.contact.tree import KinematicTree
from kinematify.evaluation.benchmark_job import predicted, score_erased, shown_parts
from kinematify.evaluation.metrics import opening_sign
from kinematify.joints.candidate import JointCandidate, JointEstimate
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.inference import Inference
from kinematify.pipeline.stages import choose_joints
from kinematify.refinement.candidates import CandidateJoints
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.assembly.truth import TrueJoint
    from kinematify.config import Config
    from kinematify.evaluation.metrics import JointScore
    from kinematify.robot.arrays import FloatArray

WRONG_DEG = 10.0
"""A joint is wrong if its axis is off by more [deg]."""
WRONG_SHARE = 0.1
"""A joint that turns is wrong if its line is off by more, fraction of the part's diagonal."""
_PIVOT_SHARE = 0.2
NOTHING = "nothing"
AXIS, PIVOT, TYPE, SIGN, PARENT, SECOND = "axis by 90 deg", "pivot", "type", "sign", "parent", "second best"
FAULTS = (AXIS, PIVOT, TYPE, SIGN, PARENT, SECOND)
RANGE = "range"
"""A range that reaches twice as far: a fault that is counted, and no wrong joint."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TrueMechanism:
    """An object whose tree and joints are the true ones."""

    erased: ErasedModel
    inference: Inference
    """With the true tree and joints; the candidates are those of inference, the true ones among them."""
    chosen: tuple[JointEstimate, ...]
    """What inference would choose on the true tree."""

    def scores(self, answer: Inference) -> dict[str, JointScore]:
        """Compare the joints of an answer about the same parts with the truth, by the part that moves."""
        prediction, _ = predicted(self.erased, answer)
        return {joint.child: joint for joint in score_erased(self.erased, prediction).joints}

    def wrong(self, answer: Inference) -> frozenset[str]:
        """Parts whose joint is wrong: parent, type, axis, line or the side that it opens to."""
        return frozenset(
            part
            for part, joint in self.scores(answer).items()
            if not joint.type_right
            or joint.angle_deg > WRONG_DEG
            or (joint.line_m or 0.0) > WRONG_SHARE * self._size(part)
            or joint.opens is False
        )

    def _size(self, part: str) -> float:
        names = self.inference.assembly.names
        return float(self.inference.assembly.parts[names.index(part)].diagonal)


@dataclass(frozen=True, kw_only=True, eq=False)
class PlantedJoint:
    """A mechanism with one wrong joint."""

    fault: str
    """Of `FAULTS`, or `RANGE`."""
    part: str
    """Whose joint is wrong."""
    inference: Inference


def true_mechanism(erased: ErasedModel, config: Config) -> TrueMechanism | None:
    """Return an object with its true joints; None where they are no tree of single joints, or fewer than two parts."""
    truth = erased.truth
    edges = Counter((joint.parent, joint.child) for joint in truth.joints)
    if len(truth.part_names) < 2 or list(truth.parents).count(-1) != 1 or max(edges.values(), default=2) > 1:
        return None
    inference = infer(shown_parts(erased), config=config)
    tree = KinematicTree(parents=truth.parents)
    chosen = choose_joints(inference.assembly, inference.graph, tree, inference.bearings, config)
    true = {joint.child: joint for joint in truth.joints}
    joints = tuple(_true_joint(joint, true[joint.child]) for joint in chosen)
    return TrueMechanism(
        erased=erased, inference=replace(inference, trees=(tree, *inference.trees), joints=joints), chosen=chosen
    )


def _true_joint(chosen: JointEstimate, true: TrueJoint) -> JointEstimate:
    best = chosen.alternatives[0].score
    own = JointCandidate(
        kind=JointType.PRISMATIC if true.kind is JointType.PRISMATIC else JointType.REVOLUTE,
        axis=true.axis,
        pivot=true.pivot,
        score=best,
        source="truth",
    )
    others = tuple(item for item in chosen.alternatives if not _agree(item, own))
    agreeing = [item.score for item in chosen.alternatives if _agree(item, own)]
    own = replace(own, score=max(agreeing, default=best))
    return replace(
        chosen,
        kind=true.kind,
        axis=true.axis,
        pivot=true.pivot,
        lower=true.lower,
        upper=true.upper,
        alternatives=tuple(sorted((own, *others), key=lambda item: -item.score)),
    )


def _agree(one: JointCandidate, other: JointCandidate) -> bool:
    """Whether they are one joint to 1 deg and a thousandth of its distance from the origin."""
    if one.kind.turns != other.kind.turns or abs(float(one.axis @ other.axis)) < np.cos(np.radians(1.0)):
        return False
    apart = float(np.linalg.norm(np.cross(one.pivot - other.pivot, one.axis)))
    return not one.kind.turns or apart < 1e-3 * max(float(np.linalg.norm(other.pivot)), 1e-3)


def planted_faults(
    mechanism: TrueMechanism, seed: int, faults: tuple[str, ...] = FAULTS, *, level: bool = False
) -> Iterator[PlantedJoint]:
    """Plant each fault once, in a joint drawn from the seed; a fault that fits no joint is omitted.

    Args:
        mechanism: A true one.
        seed: Draws the joints.
        faults: Some of `FAULTS`, and `RANGE`.
        level: The wrong joint scores as the best candidate does, so only simulation distinguishes them. Otherwise it
            scores what inference gives it. The second best has the score of the best in either case.
    """
    for fault in faults:
        random = np.random.default_rng([seed, (*FAULTS, RANGE).index(fault)])
        for index in random.permutation(len(mechanism.inference.joints)):
            found = _planted(mechanism, int(index), fault, random, level=level)
            if found is not None and (fault == RANGE or found.part in mechanism.wrong(found.inference)):
                yield found
                break


def _planted(
    mechanism: TrueMechanism, index: int, fault: str, random: np.random.Generator, *, level: bool
) -> PlantedJoint | None:
    inference = mechanism.inference
    joint, part = inference.joints[index], inference.assembly.parts[inference.joints[index].child]
    tree = inference.trees[0]
    wrong: JointEstimate | None
    if fault == AXIS:
        wrong = replace(joint, axis=_across(joint.axis))
    elif fault == PIVOT:
        drawn = random.normal(size=3)
        aside = drawn - (drawn @ joint.axis) * joint.axis
        wrong = replace(joint, pivot=joint.pivot + _PIVOT_SHARE * part.diagonal * aside / np.linalg.norm(aside))
    elif fault == TYPE:
        wrong = _other_type(joint, part.centroid, 0.5 * part.diagonal)
    elif fault == SIGN:
        wrong = replace(joint, axis=-joint.axis) if opening_sign(joint.lower, joint.upper) else None
    elif fault == RANGE:
        ends = joint.kind is not JointType.FIXED and np.isfinite(joint.upper - joint.lower)
        wrong = replace(joint, lower=2.0 * joint.lower, upper=2.0 * joint.upper) if ends else None
    elif fault == PARENT:
        tree, wrong = _other_parent(inference, joint, random)
    else:
        wrong = _second_best(mechanism, index)
    if wrong is None:
        return None
    if level and fault != SECOND:
        wrong = _believed(wrong)
    by_child = {item.child: item for item in (*inference.joints[:index], wrong, *inference.joints[index + 1 :])}
    joints = tuple(by_child[child] for _, child in tree.edges())
    trees = (tree,) if fault == PARENT else (tree, *inference.trees[1:])
    return PlantedJoint(fault=fault, part=part.name, inference=replace(inference, trees=trees, joints=joints))


def _believed(joint: JointEstimate) -> JointEstimate:
    """Return a joint among its own candidates, level with the best."""
    own = JointCandidate(
        kind=JointType.REVOLUTE if joint.kind.turns else JointType.PRISMATIC,
        axis=joint.axis,
        pivot=joint.pivot,
        score=joint.alternatives[0].score,
        source="planted",
    )
    return replace(joint, alternatives=(own, *(item for item in joint.alternatives if not _agree(item, own))))


def _across(axis: FloatArray) -> FloatArray:
    """Return the direction of the world that is farthest from an axis, made square to it."""
    other = np.eye(3)[int(np.argmin(np.abs(axis)))]
    across = other - (other @ axis) * axis
    return np.asarray(across / np.linalg.norm(across))


def _other_type(joint: JointEstimate, centroid: FloatArray, lever: float) -> JointEstimate:
    """Return a joint of about the same motion at the middle of the part."""
    if joint.kind.turns:
        lower, upper = np.clip([joint.lower, joint.upper], -1.0, 1.0) * lever
        return replace(joint, kind=JointType.PRISMATIC, lower=float(lower), upper=float(upper))
    lower, upper = np.clip(np.array([joint.lower, joint.upper]) / lever, -np.pi, np.pi)
    return replace(joint, kind=JointType.REVOLUTE, pivot=centroid, lower=float(lower), upper=float(upper))


def _other_parent(
    inference: Inference, joint: JointEstimate, random: np.random.Generator
) -> tuple[KinematicTree, JointEstimate | None]:
    """Return the tree with the part on another one that it does not carry, one that it touches if there is any."""
    tree = inference.trees[0]
    carried = {joint.child}
    for part in range(len(tree.parents)):
        above = part
        while above >= 0 and above != joint.child:
            above = tree.parents[above]
        carried |= {part} if above == joint.child else set()
    others = [part for part in range(len(tree.parents)) if part not in {*carried, joint.parent}]
    others = [part for part in others if part in inference.graph.neighbours[joint.child]] or others
    if not others:
        return tree, None
    parent = int(random.choice(others))
    parents = tuple(parent if part == joint.child else above for part, above in enumerate(tree.parents))
    return KinematicTree(parents=parents), replace(joint, parent=parent)


def _second_best(mechanism: TrueMechanism, index: int) -> JointEstimate | None:
    """Return what inference would have chosen next, each with the score of the other; None where it errs anyway."""
    inference, chosen = mechanism.inference, mechanism.chosen[index]
    name = inference.assembly.names[chosen.child]
    if name in mechanism.wrong(replace(inference, joints=mechanism.chosen)):
        return None
    own = inference.joints[index]
    pool = CandidateJoints(inference.assembly, inference.graph, inference.bearings, inference.config)
    best = own.alternatives[0]
    for candidate in own.alternatives[1:]:
        wrong = pool.realise(inference.trees[0], own, candidate)
        joints = (*inference.joints[:index], wrong, *inference.joints[index + 1 :])
        if wrong is not own and name in mechanism.wrong(replace(inference, joints=joints)):
            swapped = {id(best): candidate.score, id(candidate): best.score}
            pooled = [replace(item, score=swapped.get(id(item), item.score)) for item in own.alternatives]
            return replace(wrong, alternatives=tuple(sorted(pooled, key=lambda item: -item.score)))
    return None
