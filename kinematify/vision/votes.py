"""An answer is evidence: a voter's record says what it is worth beside geometry, and hinge lines stay geometry's.

A voter that is right no more often than chance changes nothing, one with a good record is taken as it is, and between
the two a joint that geometry is sure of is overruled by nobody.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import betaincinv

from kinematify.refinement.candidates import CandidateJoints, described
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.assembly.part import Part
    from kinematify.config import VisionConfig
    from kinematify.grouping.numbered_pieces import NamedPart
    from kinematify.joints.candidate import JointCandidate, JointEstimate
    from kinematify.pipeline.inference import Inference

VISION = "vision"
"""How likely a joint is after an answer, in `JointEstimate.evidence`."""
_CHANCE, _TAKEN = 0.35, 0.8  # share of right answers below which one counts for nothing, and above which it is taken
_LOOSE = math.cos(math.radians(30.0))  # of an axis that somebody saw in a picture
_AT_EDGE, _AT_MIDDLE, _THIN = 0.6, 0.4, 0.2  # of half an extent of the part's box; of its largest one


@dataclass(frozen=True, kw_only=True)
class VoterRecord:
    """How often a voter was right on questions whose truth was known."""

    right: int
    asked: int

    @property
    def trust(self) -> float:
        """Weight beside geometry: 0 near chance, 1 where answers are taken as they are."""
        share = self.right / max(self.asked, 1)
        return min(max((share - _CHANCE) / (_TAKEN - _CHANCE), 0.0), 1.0)

    def reliability(self, config: VisionConfig) -> float:
        """Share of right answers to count on: the lower end of what the record allows, and no more than measured."""
        low = float(betaincinv(self.right + 1, self.asked - self.right + 1, config.caution))
        return min(low, config.reliability)


def follow_parts(
    inference: Inference, named: Mapping[int, NamedPart], reliability: float, *, taken: bool
) -> tuple[Inference, list[dict[str, Any]]]:
    """Choose joints again with the types and axes that were named.

    Args:
        inference: What geometry says.
        named: By the child of the joint.
        reliability: Share of the voter's answers that are right.
        taken: The answer is followed, however sure geometry is.

    Returns:
        The inference, and what came of each joint that was named, for `inference.json`.
    """
    maker = CandidateJoints(inference.assembly, inference.graph, inference.bearings, inference.config)
    joints, results = list(inference.joints), list[dict[str, Any]]()
    for place, joint in enumerate(inference.joints):
        if joint.child not in named:
            continue
        part, shape = named[joint.child], inference.assembly.parts[joint.child]
        meant = [item for item in joint.alternatives if _is_meant(part, item)]
        meant = [item for item in meant if _is_at_edge(part, item, shape)] or meant
        moves = joint.kind is not JointType.FIXED and _is_meant(part, joint)
        agrees = moves and (
            _is_at_edge(part, joint, shape) or not any(_is_at_edge(part, item, shape) for item in meant)
        )
        sure = min(joint.confidence, 1.0 - 1e-6)
        for_answer = (sure if agrees else 1.0 - sure) * reliability
        against = (1.0 - sure if agrees else sure) * (1.0 - reliability)
        likely = for_answer / (for_answer + against)
        found = joint
        if not agrees and meant and (taken or likely > 0.5):
            found = maker.realise(inference.trees[0], joint, meant[0])
        confidence = likely if agrees or found is not joint else 1.0 - likely
        if agrees or meant:
            joints[place] = replace(found, confidence=confidence, evidence={**found.evidence, VISION: confidence})
        results.append({
            "child": shape.name, "before": described(joint), "after": described(joints[place]),
            "candidates": len(meant), "confidence_before": joint.confidence, "confidence": joints[place].confidence,
        })  # fmt: skip
    return replace(inference, joints=tuple(joints)), results


def _is_meant(part: NamedPart, option: JointCandidate | JointEstimate) -> bool:
    along = part.axis is None or abs(float(part.axis @ option.axis)) >= _LOOSE
    return along and (part.turns is None or part.turns == option.kind.turns)


def _is_at_edge(part: NamedPart, option: JointCandidate | JointEstimate, shape: Part) -> bool:
    """True if the line of a joint runs along the sides of the box that were named, or through its middle."""
    if part.edges is None or not option.kind.turns:
        return True
    extents, offset = np.ptp(shape.bounds, axis=0), option.pivot - shape.bounds.mean(axis=0)
    offset = 2.0 * (offset - float(offset @ option.axis) * option.axis) / np.maximum(extents, 1e-300)
    thick = (extents > _THIN * extents.max()) & (np.abs(option.axis) < _LOOSE)
    if not part.edges:
        return bool((np.abs(offset[thick]) < _AT_MIDDLE).all())
    sides = {"xyz".index(side[1]): 1.0 if side[0] == "+" else -1.0 for side in part.edges}
    return all(offset[k] * sign > _AT_EDGE for k, sign in sides.items() if thick[k])
