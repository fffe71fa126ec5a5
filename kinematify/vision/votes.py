"""An answer is evidence: it is weighed by what its voter's record says, and against how sure geometry is.

Every option has a prior: the chosen joint its own calibrated confidence, the others what is left, less for each rank.
An answer multiplies the prior of what it names by the odds that such an answer is right, which come from a record of
answers to questions whose truth was known. So a voter that is right no more often than chance changes nothing, and a
joint that geometry is sure of is overruled by nobody. Congruent parts are asked about once and move alike.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import betaincinv

from kinematify.joints.choice.judge import alike_edges
from kinematify.refinement.candidates import CandidateJoints, described, is_same
from kinematify.robot.joint_type import JointType
from kinematify.vision.motion_options import chosen_candidate, look_alike, offered
from kinematify.vision.question import FIXED, NONE, TURNS, UNSURE, Answer

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from kinematify.assembly.part import Part
    from kinematify.config import VisionConfig
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.candidate import JointCandidate, JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.arrays import BoolArray, FloatArray

    Options = Sequence[JointCandidate]
    Shown = Mapping[int, Options]

VISION = "vision"
"""How likely a joint is after an answer, in `JointEstimate.evidence`."""
_FEWEST = 2  # questions that any object may cost
_ALIKE = 0.06  # congruent parts: shares of extents and distances that differ by less are the same


@dataclass(frozen=True, kw_only=True)
class VoterRecord:
    """Record of a voter: how often a voter was right on questions whose truth was known."""

    right: int
    asked: int
    """Abstentions are not counted."""

    def reliability(self, config: VisionConfig) -> float:
        """Share of right answers to count on: the lower end of what the record allows, and no more than measured."""
        low = float(betaincinv(self.right + 1, self.asked - self.right + 1, config.caution))
        return min(low, config.reliability)


@dataclass(frozen=True, kw_only=True)
class VoteResult:
    """Result of the question about one joint."""

    child: str
    answer: Answer
    before: str
    """The joint as geometry chose it, in words."""
    after: str
    confidence: tuple[float, float]
    """Before and after."""
    asked: bool = True
    """False for a part that is congruent to one that was asked about."""
    options: tuple[JointCandidate, ...] = ()
    """What was shown, in the order of the numbers; none for a part that was not asked about."""

    @property
    def changed(self) -> bool:
        """Another joint was chosen than without the answer."""
        return self.before != self.after

    def as_json(self) -> dict[str, Any]:
        """For `inference.json`."""
        options = [
            {"type": item.kind.value, "axis": item.axis.tolist(), "pivot": item.pivot.tolist()} for item in self.options
        ]
        return {
            "child": self.child, "asked": self.asked, "choice": self.answer.choice, "reason": self.answer.reason,
            "voter_confidence": self.answer.confidence, "fault": self.answer.fault, "options": options,
            "before": self.before, "after": self.after,
            "confidence_before": self.confidence[0], "confidence": self.confidence[1],
        }  # fmt: skip


def to_ask(
    inference: Inference, *, everything: bool = False, known: Collection[str] = ()
) -> tuple[list[int], list[int]]:
    """Places of the joints to ask about, the least sure first: one of each group of congruent parts.

    Args:
        inference: What geometry says.
        everything: Ask about sure joints too, and without the budget.
        known: Parts that nobody needs to be asked about.

    Returns:
        Places within the budget, and those beyond it.
    """
    config, joints, names = inference.config.vision, inference.joints, inference.assembly.names
    group_of = {place: group for group in groups(inference) for place in group}
    asked: list[int] = []
    for place in sorted(range(len(joints)), key=lambda k: (joints[k].confidence, k)):
        joint = joints[place]
        open_to_doubt = bool(joint.alternatives) and names[joint.child] not in known
        settled = any(other in asked for other in group_of.get(place, ()))
        if open_to_doubt and not settled and (everything or joint.confidence < config.ask_below):
            asked.append(place)
    budget = len(asked) if everything else max(_FEWEST, math.ceil(config.budget * len(joints)))
    return asked[:budget], asked[budget:]


def groups(inference: Inference) -> list[tuple[int, ...]]:
    """Places of joints whose parts are congruent and hang on one parent, or on congruent ones."""
    place_of = {joint.child: place for place, joint in enumerate(inference.joints)}
    return [
        tuple(place_of[child] for _, child in group if child in place_of)
        for group in alike_edges(inference.graph, inference.trees[0])
    ]


def choose_again(
    inference: Inference,
    answers: Mapping[int, Answer],
    shown: Shown,
    reliability: float,
) -> tuple[Inference, list[VoteResult]]:
    """Choose joints again with answers on some of them.

    Args:
        inference: What geometry says.
        answers: By the place of the joint.
        shown: Options in the order of their numbers, by the place of the joint.
        reliability: Share of the voter's answers that are right.

    Returns:
        The inference with the joints chosen again, and what came of each joint that an answer speaks of.
    """
    config, tree = inference.config.vision, inference.trees[0]
    maker = CandidateJoints(inference.assembly, inference.graph, inference.bearings, inference.config)
    joints, results = list(inference.joints), []
    for place, (source, answer) in sorted(_spread(inference, answers, shown).items()):
        joint, part = joints[place], inference.assembly.parts[joints[place].child]
        options = offered(joint, part, config) if source != place or place not in shown else tuple(shown[place])
        named = np.zeros(len(options) + 2, dtype=bool)
        if answer.counts(config.least_confidence):
            named[-2:] = answer.choice == FIXED, answer.choice == NONE
        if answer.option is not None and answer.counts(config.least_confidence):
            named[:-2] = _named(inference, source, place, shown[source][answer.option], options)
        found = posterior(prior(joint, options, config), named, reliability)
        joints[place] = _decided(joint, options, found, maker, tree)
        results.append(
            VoteResult(
                child=part.name, answer=answer, before=described(joint), after=described(joints[place]),
                confidence=(joint.confidence, joints[place].confidence), asked=source == place,
                options=tuple(shown[source]) if source == place else (),
            )
        )  # fmt: skip
    return replace(inference, joints=tuple(joints)), results


def _spread(inference: Inference, answers: Mapping[int, Answer], shown: Shown) -> dict[int, tuple[int, Answer]]:
    """Which answer speaks of each joint, and about which joint it was given; twins that disagree count as unsure."""
    found, least = (
        {place: (place, answer) for place, answer in answers.items()},
        inference.config.vision.least_confidence,
    )
    for group in groups(inference):
        counted = [place for place in group if place in answers and answers[place].counts(least)]
        if any(not _agree(inference, counted[0], other, answers, shown) for other in counted[1:]):
            fault = "congruent parts were answered differently"
            found |= {place: (place, replace(answers[place], choice=UNSURE, fault=fault)) for place in counted}
        elif counted:
            silent = [place for place in group if place not in counted]
            found |= dict.fromkeys(silent, (counted[0], answers[counted[0]]))
    return found


def _agree(
    inference: Inference,
    one: int,
    other: int,
    answers: Mapping[int, Answer],
    shown: Shown,
) -> bool:
    first, second = answers[one].option, answers[other].option
    if first is None or second is None:
        return answers[one].choice == answers[other].choice
    parts = [inference.assembly.parts[inference.joints[place].child] for place in (one, other)]
    return map_to_congruent_part(parts[0], shown[one][first], parts[1], shown[other][second])


def _named(inference: Inference, source: int, place: int, picked: JointCandidate, options: Options) -> BoolArray:
    """Which options of a joint are the motion that was picked for it, or for its twin, shape (options,)."""
    mine, theirs = (inference.assembly.parts[inference.joints[k].child] for k in (place, source))
    if source != place:
        return np.array([map_to_congruent_part(theirs, picked, mine, item) for item in options], dtype=bool)
    return np.array([look_alike(picked, item, mine.diagonal, inference.config.vision) for item in options], dtype=bool)


def map_to_congruent_part(one: Part, motion: JointCandidate, twin: Part, other: JointCandidate) -> bool:
    """True if a motion of a part is, up to its symmetries, that of a congruent part."""
    if motion.kind.turns != other.kind.turns:
        return False
    return bool(np.allclose(_invariants(one, motion), _invariants(twin, other), rtol=0.0, atol=_ALIKE))


def _invariants(part: Part, motion: JointCandidate) -> FloatArray:
    """Return invariants of a part with its motion under turns and mirrors: spreads, a distance, shares of its size."""
    corners = part.vertices[part.faces].mean(axis=1) - part.centroid
    weights = part.face_areas / max(part.area, 1e-300)
    spread = np.einsum("i,ij,ik->jk", weights, corners, corners)
    size = math.sqrt(max(float(np.trace(spread)), 1e-300))
    along = math.sqrt(max(float(motion.axis @ spread @ motion.axis), 0.0)) / size
    if not motion.kind.turns:
        return np.array([along])
    offset = motion.pivot - part.centroid
    offset = offset - float(offset @ motion.axis) * motion.axis
    distance = float(np.linalg.norm(offset))
    aside = math.sqrt(max(float(offset @ spread @ offset), 0.0)) / (size * max(distance, 1e-300))
    return np.array([along, distance / size, aside * min(1.0, distance / size)])


def prior(joint: JointEstimate, options: Options, config: VisionConfig) -> FloatArray:
    """Return how likely each option, fixed, and anything else is before an answer, sum 1, shape (options + 2,).

    Args:
        joint: As geometry chose it; its confidence less the doubt of its parent is that of the choice.
        options: In any order; those that were not chosen rank by their score.
        config: `rank_share`, `fixed_share` and `other_share`.
    """
    found = np.zeros(len(options) + 2)
    chosen = place_of_choice(joint, options)
    ranks = sorted((k for k in range(len(options)) if k != chosen), key=lambda k: -options[k].score)
    for rank, place in enumerate(ranks):
        found[place] = config.rank_share**rank
    found[: len(options)] /= max(found.sum(), 1e-300)
    found[-2:] = config.fixed_share, config.other_share
    if chosen is not None:
        found[chosen] = 0.0
        sure = min(joint.confidence / joint.evidence.get("parent_likely", 1.0), config.surest)
        found *= (1.0 - sure) / found.sum()
        found[chosen] = sure
    return np.asarray(found / found.sum())


def place_of_choice(joint: JointEstimate, options: Options) -> int | None:
    """Place of what geometry chose, in options and then fixed; None if it is not among them."""
    if joint.kind is JointType.FIXED:
        return len(options)
    return next((place for place, item in enumerate(options) if is_same(joint, item)), None)


def posterior(before: FloatArray, named: BoolArray, reliability: float) -> FloatArray:
    """Return how likely each option, fixed, and anything else is after an answer, sum 1, shape (options + 2,).

    Args:
        before: From `prior`.
        named: Which of them the answer names; none for an abstention.
        reliability: Share of the voter's answers that are right.
    """
    chance = 1.0 / (len(before) - 1)
    if not named.any() or reliability <= chance:  # no better than chance: no evidence, neither for nor against
        return before
    likely = np.where(named, reliability, (1.0 - reliability) / (len(before) - 2))
    if not named[-1]:
        likely[-1] = chance  # who does not see the right motion takes any other one
    found = before * likely
    return np.asarray(found / found.sum())


def _decided(
    joint: JointEstimate,
    options: Options,
    found: FloatArray,
    maker: CandidateJoints,
    tree: KinematicTree,
) -> JointEstimate:
    """The likeliest joint with its confidence; the same one where it stays the likeliest."""
    best = int(np.argmax(found[:-1]))
    if best == place_of_choice(joint, options):
        made = joint
    elif best == len(options):
        made = replace(joint, kind=JointType.FIXED, lower=0.0, upper=0.0)
    else:
        made = maker.realise(tree, joint, options[best])
    likely = float(found[best])
    sure = likely * joint.evidence.get("parent_likely", 1.0)
    return replace(made, confidence=sure, evidence={**made.evidence, VISION: likely})


def with_types(
    inference: Inference, types: Mapping[int, str], answers: Mapping[int, Answer]
) -> tuple[Inference, list[VoteResult]]:
    """Take the best joint of the types that were answered before axes were chosen (paper section III-D).

    Congruent parts follow the majority of their answers; where there is no candidate of a type the joint stays.

    Args:
        inference: Joints with candidates of both types.
        types: "turns", "slides" or "fixed" by the place of the joint; abstentions are not among them.
        answers: By the place of the joint, for the record.
    """
    said = dict(types)
    for group in groups(inference):
        votes = [types[place] for place in group if place in types]
        if votes:
            said |= dict.fromkeys(group, max(dict.fromkeys(votes), key=votes.count))
    maker = CandidateJoints(inference.assembly, inference.graph, inference.bearings, inference.config)
    joints, results = list(inference.joints), []
    for place, before in enumerate(inference.joints):
        joints[place] = _of_type(before, said.get(place), maker, inference)
        if place in answers or place in said:
            results.append(
                VoteResult(
                    child=inference.assembly.names[before.child], answer=answers.get(place, Answer()),
                    before=described(before), after=described(joints[place]), asked=place in answers,
                    confidence=(before.confidence, joints[place].confidence),
                )
            )  # fmt: skip
    return replace(inference, joints=tuple(joints)), results


def _of_type(joint: JointEstimate, kind: str | None, maker: CandidateJoints, inference: Inference) -> JointEstimate:
    """The joint itself where it has the type, else the best candidate of it."""
    if kind is None:
        return joint
    if kind == FIXED:
        return replace(joint, kind=JointType.FIXED, lower=0.0, upper=0.0)
    turns, own = kind == TURNS, chosen_candidate(joint)
    if own is not None and own.kind.turns == turns:
        return joint
    best = next((item for item in joint.alternatives if item.kind.turns == turns), None)
    return joint if best is None else maker.realise(inference.trees[0], joint, best)
