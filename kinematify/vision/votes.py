"""Votes are evidence among other evidence: they are added to the scores of candidates as log odds, and never obeyed.

A vote alone decides worse than the geometry alone below 95 % of right answers; added, it helps, if both are weighed in
the same unit. A vote counts the log odds of its reliability, whatever more the voter says of itself, and the choice of
the geometry those of how often it is right, however close the scores: so a voter that is no better than the geometry
changes nothing alone. All votes on one joint together are bounded, for who misreads a picture errs on all questions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.refinement.candidates import CandidateJoints, is_same
from kinematify.robot.joint_type import JointType
from kinematify.vision.answer import TYPES, Direction, HingeSide
from kinematify.vision.question import joint_question

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Part
    from kinematify.config import VisionConfig
    from kinematify.joints.candidate import JointCandidate, JointEstimate
    from kinematify.pipeline import Inference
    from kinematify.robot.arrays import FloatArray
    from kinematify.vision.answer import JointOracle, JointVotes, Vote

_DIRECTIONS = (Direction.SIDEWAYS, Direction.DEPTH, Direction.VERTICAL)
"""Of the world's x, y and z axes: the front looks along -y."""
_ALIKE = 0.01  # boxes that differ less, as a share of their diagonal, stand the same way
_SIDES = ((HingeSide.LEFT, HingeSide.RIGHT), (HingeSide.FRONT, HingeSide.BACK), (HingeSide.BOTTOM, HingeSide.TOP))


@dataclass(frozen=True, kw_only=True)
class VoteResult:
    """What came of asking about one joint."""

    child: str
    votes: JointVotes
    changed: bool
    """Another candidate was chosen than without the votes."""


def with_votes(inference: Inference, oracle: JointOracle) -> tuple[Inference, list[VoteResult]]:
    """Ask about the joints of an inference, the least sure first, and choose again with the answers.

    Args:
        inference: What the geometry says.
        oracle: Who is asked.

    Returns:
        The inference with the joints chosen anew, and what was heard of each.
    """
    config = inference.config.vision
    asked = sorted(range(len(inference.joints)), key=lambda k: inference.joints[k].confidence)[: config.budget]
    questions = [
        joint_question(
            inference.assembly, inference.joints[k].parent, inference.joints[k].child, config=config,
            preview=inference.config.preview,
        )
        for k in asked
    ]  # fmt: skip
    votes = dict(zip(asked, oracle.ask(questions), strict=True))
    return chosen_anew(inference, votes)


def chosen_anew(inference: Inference, votes: dict[int, JointVotes]) -> tuple[Inference, list[VoteResult]]:
    """Choose the joints of an inference again with votes on some of them, keyed by their place in `joints`."""
    config, names = inference.config.vision, inference.assembly.names
    maker = CandidateJoints(inference.assembly, inference.graph, inference.bearings, inference.config)
    joints, heard = list(inference.joints), []
    for k, own in sorted(votes.items()):
        joint = joints[k]
        twins = [_shared(inference, k, other, votes[other]) for other in _twins(inference, k) if other in votes]
        best = _best(joint, own, twins, inference.assembly.parts[joint.child], config)
        changed = best is not None and not is_same(joint, best)
        if best is not None and changed:
            joints[k] = maker.realise(inference.trees[0], joint, best)
        heard.append(VoteResult(child=names[joint.child], votes=own, changed=changed))
    return replace(inference, joints=tuple(joints)), heard


def _twins(inference: Inference, k: int) -> list[int]:
    """Other joints whose moving parts are congruent to that of a joint (paper III-D: votes per cluster)."""
    child = inference.joints[k].child
    cluster = next((set(c) for c in inference.graph.clusters if child in c), set())
    return [n for n, joint in enumerate(inference.joints) if n != k and joint.child in cluster]


def _shared(inference: Inference, k: int, other: int, votes: JointVotes) -> JointVotes:
    """What votes on a twin say of the part itself: its type, and where both stand alike, the direction of its axis."""
    here, there = (np.ptp(inference.assembly.parts[inference.joints[n].child].bounds, axis=0) for n in (k, other))
    alike = np.allclose(here, there, rtol=0.0, atol=_ALIKE * float(np.linalg.norm(here)))
    return replace(votes, direction=votes.direction if alike else None, side=None)


def _best(
    joint: JointEstimate, own: JointVotes, twins: Sequence[JointVotes], part: Part, config: VisionConfig
) -> JointCandidate | None:
    """The candidate that geometry and votes like best; None where there is no choice."""
    if joint.kind is JointType.FIXED or not joint.alternatives:
        return None
    gains = [
        standing(candidate, joint, config) + vote_gain(candidate, own, twins, part, config)
        for candidate in joint.alternatives
    ]
    return joint.alternatives[int(np.argmax(gains))]


def standing(candidate: JointCandidate, chosen: JointEstimate, config: VisionConfig) -> float:
    """What the geometry says for a candidate [log odds]: its score, and that the geometry chose it if it did."""
    return candidate.score + config.chosen_lead * is_same(chosen, candidate)


def vote_gain(
    candidate: JointCandidate, own: JointVotes, twins: Sequence[JointVotes], part: Part, config: VisionConfig
) -> float:
    """What votes add to the score of a candidate, between 0 and `config.most` [log odds].

    Args:
        candidate: A joint of the part.
        own: Votes on this part.
        twins: Votes on congruent parts, whose types and directions count too, together as `config.cluster_weight` of
            one vote: who is wrong about one of them is likely to be wrong about all.
        part: The moving part.
        config: Reliability and bounds.
    """
    kind = candidate.kind.value
    direction = direction_of(candidate.axis, config.oblique_deg)
    side = side_of(candidate, part, config.off_center) if candidate.kind.turns else None
    shared = config.cluster_weight / max(len(twins), 1)
    opinions = [
        (own.kind, kind, len(TYPES), 1.0),
        *((twin.kind, kind, len(TYPES), shared) for twin in twins),
        (own.direction, direction, len(Direction), 1.0),
        *((twin.direction, direction, len(Direction), shared) for twin in twins),
        (own.side, side, len(HingeSide), 1.0),
    ]
    weights = [weight * _strength(vote, choices, config) for vote, _, choices, weight in opinions]
    agreed = [
        weight
        for weight, (vote, choice, _, _) in zip(weights, opinions, strict=True)
        if vote is not None and choice is not None and _means(vote.choice, choice)
    ]
    # Scaled, not cut off: who agrees with more of the votes still gains more.
    return float(sum(agreed)) * min(1.0, config.most / max(sum(weights), 1e-12))


def _strength(vote: Vote | None, choices: int, config: VisionConfig) -> float:
    """Log odds of a vote for one of so many choices, at least 0: right in p of all cases, else any of the others."""
    if vote is None:
        return 0.0
    right = min(vote.confidence, config.reliability)
    return max(0.0, math.log(right * (choices - 1) / (1.0 - right)))


def _means(voted: str, choice: str) -> bool:
    """A continuous joint is a revolute one without limits: candidates do not tell them apart."""
    turns = {JointType.REVOLUTE.value, JointType.CONTINUOUS.value}
    return voted == choice or {voted, choice} <= turns


def direction_of(axis: FloatArray, oblique_deg: float) -> str | None:
    """How a view names the direction of an axis (3,); None where it is oblique."""
    index = int(np.argmax(np.abs(axis)))
    return _DIRECTIONS[index].value if abs(float(axis[index])) > np.cos(np.radians(oblique_deg)) else None


def side_of(candidate: JointCandidate, part: Part, off_center: float) -> str:
    """The side of a part at which an axis lies."""
    low, high = part.bounds
    offset = candidate.pivot - 0.5 * (low + high)
    offset = offset - (offset @ candidate.axis) * candidate.axis
    shares = offset / np.maximum(high - low, 1e-12)
    # Along a thin side every axis is far out: sides are told in lengths, the middle in shares.
    index = int(np.argmax(np.abs(offset)))
    if abs(float(shares[index])) < off_center:
        return HingeSide.MIDDLE.value
    return _SIDES[index][int(offset[index] > 0.0)].value


_NAMED = 5


def describe_votes(heard: Sequence[VoteResult]) -> str:
    """Say how many questions were answered, what changed, and why there were no answers."""
    answered = [item for item in heard if not item.votes.note]
    changed = [item.child for item in heard if item.changed]
    lines = [f"The vision model answered {len(answered)} of {len(heard)} questions and changed {len(changed)} joints."]
    if changed:
        lines.append(f"Changed: {', '.join(changed[:_NAMED])}{', ...' if len(changed) > _NAMED else ''}.")
    reasons = sorted({item.votes.note for item in heard if item.votes.note})
    lines += [f"No answer: {reason}" for reason in reasons[:_NAMED]]
    return "\n".join(lines)
