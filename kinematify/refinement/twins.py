"""Congruent parts on one parent move alike: their common evidence decides, not that of each alone.

The evidence of all twins is added up for turning and for sliding. Those that were taken for the other type follow, if
the sum leads by the configured margin and they have a candidate of that type.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.refinement.hints import HINTED
from kinematify.refinement.history import PlanChange
from kinematify.refinement.words import described
from kinematify.robot.joint_type import JointType

TWINS = "twins"
"""What the evidence of the other twins is for a joint that followed them [log odds], in `JointEstimate.evidence`."""

if TYPE_CHECKING:
    from kinematify.contact.graph import ContactGraph
    from kinematify.joints.candidate import JointEstimate
    from kinematify.refinement.choose import Chooser
    from kinematify.refinement.plan import Plan


def vote(plan: Plan, graph: ContactGraph, chooser: Chooser) -> tuple[Plan, list[PlanChange]]:
    """Let siblings that are congruent vote about their type.

    Args:
        plan: With what was chosen for each alone.
        graph: With the clusters of congruent parts.
        chooser: Simulates what a part would change to.
    """
    changes: list[PlanChange] = []
    for group in _siblings(plan, graph):
        members = [plan.joints[plan.index(plan.assembly.names[part])] for part in group]
        kinds = {joint.kind.turns for joint in members}
        if len(kinds) < 2 or any(joint.kind is JointType.FIXED for joint in members):
            continue
        lean = sum(_lean(joint) for joint in members)
        if abs(lean) <= chooser.config.twin_lead or not chooser.in_time():
            continue
        for joint in members:
            others = abs(lean - _lean(joint))
            plan, change = _follow(plan, joint, turns=lean > 0.0, chooser=chooser, votes=len(members), others=others)
            changes += [change] if change is not None else []
    return plan, changes


def _siblings(plan: Plan, graph: ContactGraph) -> list[list[int]]:
    """Congruent parts on one parent that carry as much as each other, two or more."""
    found = []
    for cluster in graph.clusters:
        by_place: dict[tuple[int, int], list[int]] = {}
        for part in cluster:
            by_place.setdefault((plan.tree.parents[part], len(plan.tree.children[part])), []).append(part)
        found += [group for (parent, _), group in by_place.items() if parent >= 0 and len(group) > 1]
    return found


def _lean(joint: JointEstimate) -> float:
    """Log odds of turning against sliding among the candidates of one part; 0 where it has only one type."""
    best = {
        turns: max((item.score for item in joint.alternatives if item.kind.turns == turns), default=None)
        for turns in (True, False)
    }
    turn, slide = best[True], best[False]
    return 0.0 if turn is None or slide is None else turn - slide


def _follow(
    plan: Plan, joint: JointEstimate, *, turns: bool, chooser: Chooser, votes: int, others: float
) -> tuple[Plan, PlanChange | None]:
    """The best candidate of the type that the twins agree on, unless the simulation is against it."""
    if joint.kind.turns == turns or HINTED in joint.evidence:
        return plan, None
    candidate = max((item for item in joint.alternatives if item.kind.turns == turns), key=lambda item: item.score)
    trial = chooser.trial(plan, chooser.candidates.realise(plan.tree, joint, candidate), 0.0)
    if trial.against > 0.0:
        return plan, None
    name = plan.assembly.names[joint.child]
    change = PlanChange(
        part=name,
        what="type",
        before=described(joint),
        after=described(trial.joint),
        why=f"{votes} congruent parts on {plan.assembly.names[joint.parent]} move alike, and their evidence together "
        f"is for {'turning' if turns else 'sliding'}",
    )
    told = replace(trial.joint, evidence={**trial.joint.evidence, TWINS: others})
    return plan.with_joint(told), change
