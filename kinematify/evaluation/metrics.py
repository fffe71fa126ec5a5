"""Scores of one predicted mechanism against the ground truth, per joint and per object (paper IV-A).

Axes and places are those of the world frame of the input. What is missing or wrong is counted, never dropped: a true
joint whose parent-child pair is not in the predicted tree counts 90 degrees, a wrong type and a limit overlap of 0.
Line and pivot distances exist only where both axes do.
"""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.evaluation.tree_metrics import TreeDistance, parent_errors, root_of, tree_edit_distance, without_nodes
from kinematify.generate.procedural.blueprint import ground_truth
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.truth import GroundTruth, TrueJoint
    from kinematify.contact.tree import KinematicTree
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.arrays import FloatArray

FULL_TURN = 2.0 * math.pi
ONE_SIDED = 0.5
"""A joint opens towards one side where that side has this much more of its travel, as a share: three to one."""


def axis_angle(first: FloatArray, second: FloatArray) -> float:
    """Return the angle between two axes [deg], opposite directions counting as equal: in [0, 90].

    Args:
        first: Direction of any non-zero length, shape (3,).
        second: Direction of any non-zero length, shape (3,).
    """
    sine = float(np.linalg.norm(np.cross(first, second)))
    return math.degrees(math.atan2(sine, abs(float(first @ second))))


def axis_line_distance(
    *, true_axis: FloatArray, true_pivot: FloatArray, axis: FloatArray, pivot: FloatArray, near: FloatArray
) -> float:
    """Return how far the predicted axis line passes from the true one at the part that moves [m].

    It is the distance to the predicted line from the point of the true line nearest to `near`, the child part's
    centroid. The usual distance between two skew lines jumps at parallel lines: lines 10 cm apart and tilted by 0.01
    deg cross somewhere far away and count 0. This one is continuous everywhere, does not change when either pivot
    slides along its line, nor when an axis is flipped, and equals the offset where the lines are parallel.

    Args:
        true_axis: True direction, shape (3,).
        true_pivot: A point on the true axis [m], shape (3,).
        axis: Predicted direction, shape (3,).
        pivot: A point on the predicted axis [m], shape (3,).
        near: Where the joint does its work [m], shape (3,).
    """
    anchor = true_pivot + _along(near - true_pivot, true_axis)
    offset = anchor - pivot
    return float(np.linalg.norm(offset - _along(offset, axis)))


def limit_overlap(
    true_limits: tuple[float, float], limits: tuple[float, float], *, same_sign: bool, turns: bool
) -> float:
    """Return intersection over union of two ranges of motion, in [0, 1].

    A turning range of a full turn or more reaches every angle, as a continuous joint does; where one of the two is
    such a range, the overlap is the share of the turn that the other one reaches.

    Args:
        true_limits: Lower and upper limit [rad or m], measured from the configuration of the input.
        limits: The predicted ones, same zero and unit; infinite for a continuous joint.
        same_sign: True where the axes point the same way; otherwise the predicted range is mirrored.
        turns: True for angles, False for travels.
    """
    lower, upper = limits if same_sign else (-limits[1], -limits[0])
    widths = (true_limits[1] - true_limits[0], upper - lower)
    if turns and max(widths) >= FULL_TURN:
        return min(FULL_TURN, *widths) / FULL_TURN
    shared = min(true_limits[1], upper) - max(true_limits[0], lower)
    if shared < 0.0:
        return 0.0
    hull = max(true_limits[1], upper) - min(true_limits[0], lower)
    return shared / hull if hull > 0.0 else 1.0


def opening_sign(lower: float, upper: float) -> int:
    """Return the direction in which a joint opens from zero: 1, -1, or 0 where its range does not say.

    It does not where the range is not one-sided (most robot joints), has no end, or leaves out zero.

    Args:
        lower: Lower limit in the joint's own zero [rad or m]; may be infinite.
        upper: Upper limit in the same unit.
    """
    finite = math.isfinite(lower) and math.isfinite(upper)
    if not finite or not lower <= 0.0 <= upper or lower == upper:
        return 0
    share = (upper + lower) / (upper - lower)
    return 0 if abs(share) < ONE_SIDED else int(math.copysign(1, share))


def _along(vector: FloatArray, direction: FloatArray) -> FloatArray:
    """Component of `vector` along `direction`."""
    return direction * (float(vector @ direction) / float(direction @ direction))


MISSING_ANGLE = 90.0
"""What a joint without a predicted axis counts [deg]."""
CLOSE_ANGLE = 5.0
"""An axis counts as found within this angle [deg]; S2O and others use the same."""
CLOSE_ORIGIN = 0.1
"""An origin counts as found within this share of the moving part's diagonal, as in S2O."""


@dataclass(frozen=True, kw_only=True)
class JointScore:
    """One true joint against what was predicted for it."""

    joint: str
    """Name in the source description."""
    parent: str
    child: str
    kind: str
    """True type."""
    predicted_kind: str | None
    """None where the parent-child pair is not in the predicted tree, or represents another joint of that pair."""
    gripper: bool
    """True for fingers that the paper's count leaves out."""
    angle_deg: float
    """Folded axis angle; 90 where there is no predicted axis."""
    angle_given_type_deg: float
    """The same for the best candidate of the true type, where one was kept."""
    line_m: float | None
    """Distance between the axis lines at the child; None for sliding joints, which have no place."""
    pivot_m: float | None
    """Distance between the pivots, the paper's axis position error; None for sliding joints."""
    limit_iou: float
    opens: bool | None
    """Whether the positive direction opens; None where the true range does not say."""
    part_diagonal: float | None = None
    """Of the bounding box of the moving part [m]; None in reports made before it was recorded."""
    confidence: float | None = None
    """What the method gave the joint above the child, or the one that hangs the parent on the child; None if neither
    is there."""

    @property
    def matched(self) -> bool:
        """True where a predicted joint represents this one."""
        return self.predicted_kind is not None

    @property
    def type_right(self) -> bool:
        """Type accuracy; continuous counts as revolute."""
        return self.predicted_kind is not None and _loose(self.predicted_kind) == _loose(self.kind)

    @property
    def axis_right(self) -> bool:
        """Type right and axis within `CLOSE_ANGLE`: the MA of S2O."""
        return self.type_right and self.angle_deg <= CLOSE_ANGLE

    @property
    def origin_right(self) -> bool:
        """The same, and the axis line of a turning joint within `CLOSE_ORIGIN` at the moving part: the MAO of S2O."""
        if not self.axis_right or self.line_m is None:
            return self.axis_right and _loose(self.kind) == JointType.PRISMATIC
        return self.part_diagonal is not None and self.line_m <= CLOSE_ORIGIN * self.part_diagonal

    @property
    def type_right_strict(self) -> bool:
        """Type accuracy with revolute and continuous distinguished."""
        return self.predicted_kind == self.kind


@dataclass(frozen=True, kw_only=True)
class ObjectScore:
    """One object under one condition."""

    diagonal: float
    """Of the input's bounding box [m]."""
    joints: tuple[JointScore, ...]
    ted: TreeDistance
    """Node label = identity of the part."""
    ted_unlabelled: TreeDistance
    ted_without_gripper: TreeDistance
    """Labelled, with the finger parts deleted from both trees."""
    parent_errors: int
    """Parts with another parent than in truth, the root included."""
    root_right: bool


def score_object(
    truth: GroundTruth,
    prediction: Prediction,
    *,
    centroids: Sequence[FloatArray],
    part_diagonals: Sequence[float],
    diagonal: float,
    gripper_joints: Sequence[str] = (),
) -> ObjectScore:
    """Compare a prediction with the ground truth.

    Several true joints can stand between two parts (a screw cap: a turning and a sliding joint through a link without
    geometry). A tree has one joint there; it is matched with the true joint that it fits best, type first, then
    angle, and the others count as missing.

    Args:
        truth: Parts by index, joints in the world frame of the input.
        prediction: The mechanism to score, parts by the same index.
        centroids: Surface centroid of every part [m], shape (3,) each.
        part_diagonals: Of the bounding box of every part [m].
        diagonal: Of the input's bounding box [m].
        gripper_joints: Names of the joints of gripper fingers.
    """
    fingers = {joint.child for joint in truth.joints if joint.source in gripper_joints}
    true_tree = dict(enumerate(truth.parents))
    bare = [without_nodes(tree, fingers & set(tree)) for tree in (true_tree, prediction.parents)]
    labelled = tree_edit_distance(true_tree, prediction.parents)
    return ObjectScore(
        diagonal=diagonal,
        joints=tuple(_joint_scores(truth, prediction, centroids, part_diagonals, gripper_joints)),
        ted=labelled,
        ted_unlabelled=tree_edit_distance(true_tree, prediction.parents, labelled=False),
        ted_without_gripper=tree_edit_distance(*bare) if fingers else labelled,
        parent_errors=parent_errors(true_tree, prediction.parents),
        root_right=root_of(true_tree) == root_of(prediction.parents),
    )


def _joint_scores(
    truth: GroundTruth,
    prediction: Prediction,
    centroids: Sequence[FloatArray],
    part_diagonals: Sequence[float],
    gripper_joints: Sequence[str],
) -> list[JointScore]:
    predicted = {(joint.parent, joint.child): joint for joint in prediction.joints}
    chosen = _matches(truth.joints, predicted)
    return [
        _joint_score(
            joint,
            chosen.get(joint.name),
            near=centroids[joint.child],
            part_diagonal=part_diagonals[joint.child],
            names=truth.part_names,
            gripper=joint.source in gripper_joints,
            confidence=_confidence(joint, prediction),
        )
        for joint in truth.joints
    ]


def _matches(
    joints: Sequence[TrueJoint], predicted: Mapping[tuple[int, int], JointEstimate]
) -> dict[str, JointEstimate]:
    """True joint name -> the predicted joint that represents it."""
    by_pair: dict[tuple[int, int], list[TrueJoint]] = defaultdict(list)
    for joint in joints:
        by_pair[joint.parent, joint.child].append(joint)

    def misfit(joint: TrueJoint) -> tuple[bool, float]:
        guess = predicted[joint.parent, joint.child]
        return _loose(joint.kind) != _loose(guess.kind), axis_angle(joint.axis, guess.axis)

    return {min(rivals, key=misfit).name: predicted[pair] for pair, rivals in by_pair.items() if pair in predicted}


def _confidence(joint: TrueJoint, prediction: Prediction) -> float | None:
    above = {item.child: item for item in prediction.joints}
    own, turned = above.get(joint.child), above.get(joint.parent)
    if own is None and turned is not None and turned.parent == joint.child:
        own = turned
    return None if own is None else own.confidence


def _joint_score(
    joint: TrueJoint,
    guess: JointEstimate | None,
    *,
    near: FloatArray,
    part_diagonal: float,
    names: Sequence[str],
    gripper: bool,
    confidence: float | None,
) -> JointScore:
    placed = guess is not None and joint.kind.turns and guess.kind != JointType.FIXED
    return JointScore(
        joint=joint.name,
        parent=names[joint.parent],
        child=names[joint.child],
        kind=str(joint.kind),
        predicted_kind=None if guess is None else str(guess.kind),
        gripper=gripper,
        angle_deg=_angle(joint, guess),
        angle_given_type_deg=_angle_given_type(joint, guess),
        line_m=axis_line_distance(
            true_axis=joint.axis, true_pivot=joint.pivot, axis=guess.axis, pivot=guess.pivot, near=near
        )
        if guess is not None and placed
        else None,
        pivot_m=float(np.linalg.norm(joint.pivot - guess.pivot)) if guess is not None and placed else None,
        limit_iou=_limit_iou(joint, guess),
        opens=_opens(joint, guess),
        part_diagonal=part_diagonal,
        confidence=confidence,
    )


def _angle(joint: TrueJoint, guess: JointEstimate | None) -> float:
    if guess is None or guess.kind == JointType.FIXED:
        return MISSING_ANGLE
    return axis_angle(joint.axis, guess.axis)


def _angle_given_type(joint: TrueJoint, guess: JointEstimate | None) -> float:
    if guess is None or _loose(guess.kind) == _loose(joint.kind):
        return _angle(joint, guess)
    axes = (item.axis for item in guess.alternatives if _loose(item.kind) == _loose(joint.kind))
    best = next(axes, None)
    return _angle(joint, guess) if best is None else axis_angle(joint.axis, best)


def _limit_iou(joint: TrueJoint, guess: JointEstimate | None) -> float:
    """Overlap in the true joint's sign; 0 for another type, or where perpendicular axes leave the sign open."""
    if guess is None or _loose(guess.kind) != _loose(joint.kind):
        return 0.0
    agreement = float(joint.axis @ guess.axis)
    if agreement == 0.0:
        return 0.0
    return limit_overlap(
        (joint.lower, joint.upper),
        (guess.lower, guess.upper),
        same_sign=agreement > 0.0,
        turns=joint.kind.turns,
    )


def _opens(joint: TrueJoint, guess: JointEstimate | None) -> bool | None:
    """The output promises that the positive direction opens, so the sign of its axis alone is judged."""
    sign = opening_sign(joint.lower + joint.value, joint.upper + joint.value)
    if sign == 0:
        return None
    if guess is None or _loose(guess.kind) != _loose(joint.kind):
        return False
    return bool(sign * float(joint.axis @ guess.axis) > 0.0)


def _loose(kind: str) -> str:
    """Type with continuous and revolute taken as one."""
    return JointType.REVOLUTE if kind == JointType.CONTINUOUS else kind


@dataclass(frozen=True, kw_only=True, eq=False)
class Prediction:
    """A predicted kinematic tree."""

    parents: Mapping[int, int]
    """Part -> parent part, -1 for the root. Parts that the method set aside are missing; empty if it failed."""
    joints: tuple[JointEstimate, ...]


NOTHING_PREDICTED = Prediction(parents={}, joints=())
"""What a run that failed is scored as: every joint is missing."""


def prediction_of(
    tree: KinematicTree, estimates: Sequence[JointEstimate], names: Sequence[str], part_index: Mapping[str, int]
) -> Prediction:
    """Translate an inferred tree and its joints to the parts of the ground truth.

    Args:
        tree: The best tree; node i is the part `names[i]`.
        estimates: One joint per tree edge.
        names: Part names in the order of the tree's nodes.
        part_index: Part name -> index of the part in the ground truth.
    """
    index = [part_index[name] for name in names]
    parents = {index[node]: -1 if parent < 0 else index[parent] for node, parent in enumerate(tree.parents)}
    return Prediction(
        parents=parents,
        joints=tuple(
            replace(estimate, parent=index[estimate.parent], child=index[estimate.child]) for estimate in estimates
        ),
    )


def score_blueprint(blueprint: Blueprint, inference: Inference) -> ObjectScore:
    """Compare an inference from the parts of a blueprint with the joints that it was built with."""
    truth = ground_truth(blueprint)
    index = {name: number for number, name in enumerate(truth.part_names)}
    return score_object(
        truth,
        prediction_of(inference.trees[0], inference.joints, inference.assembly.names, index),
        centroids=[part.centroid for part in blueprint.parts],
        part_diagonals=[part.diagonal for part in blueprint.parts],
        diagonal=blueprint.assembly.diagonal,
    )
