"""Choosing joints again under feedback: every near-best candidate is simulated, and the evidence is added up.

The score of a candidate is that of the inference, in log odds, less what the simulation has against it. A candidate
that was never simulated has nothing against it, so none may replace another before it was: by exact geometry, and in
the tier in which the chosen joint failed. Failures only ever speak against a candidate, so that what geometry leaves of
it bounds what a dear tier can; the most promising one is tried there first, until none could still do better.

Congruent parts on one parent move alike: their common evidence decides, not that of each alone. The evidence of all
twins is added up for turning and for sliding. Those that were taken for the other type follow, if the sum leads by the
configured margin and they have a candidate of that type.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.refinement.candidates import described, is_same, ranged
from kinematify.refinement.hints import HINTED
from kinematify.refinement.joint_plan import PlanChange
from kinematify.refinement.simulate import TIERS
from kinematify.robot.joint_type import JointType
from kinematify.validation.failure_rates import GEOMETRY, tier_of
from kinematify.validation.run.feedback import feedback_from

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.config import RefineConfig
    from kinematify.joints.candidate import JointCandidate, JointEstimate
    from kinematify.refinement.candidates import CandidateJoints
    from kinematify.refinement.joint_plan import Plan
    from kinematify.refinement.simulate import ExpensiveTiers, Simulator
    from kinematify.validation.run.feedback import Feedback, RangeSignal

_SAME_WAY = np.cos(np.radians(10.0))  # as `kinematify bench` tells wrong axes from right ones


@dataclass(frozen=True, kw_only=True, eq=False)
class Trial:
    """A candidate after its simulation."""

    joint: JointEstimate
    score: float
    """Of the inference, 0 for its best candidate [log odds]."""
    against: float
    """What the simulation has against it [log odds]."""
    blocked: bool
    """It can move to neither side."""
    tier: str = GEOMETRY
    """How far it was simulated."""

    @property
    def total(self) -> float:
        """Evidence for it, all in all [log odds]."""
        return self.score - self.against


@dataclass(kw_only=True, eq=False)
class Chooser:
    """Simulates candidates and chooses among them; remembers what it has simulated."""

    candidates: CandidateJoints
    simulator: Simulator
    dear: ExpensiveTiers
    config: RefineConfig
    in_time: Callable[[], bool]
    simulated: int = 0
    refused: list[str] = field(default_factory=list)
    """Choices that would have hidden a failure, with the reason."""
    gained: dict[str, float] = field(default_factory=dict)
    """What joints that were chosen again have before the old ones, by part [log odds]."""

    def choose_again(self, plan: Plan, feedback: Feedback) -> tuple[Plan, list[PlanChange]]:
        """Take decisions about joints again, one part after the other, those that most speaks against first.

        Doubted are the joints that failures point to, and those that score far less than a candidate by shape alone.
        A warning by itself moves no joint that nothing scores above, for true joints warn too.

        Args:
            plan: What was simulated.
            feedback: What its failures point to.
        """
        changes: list[PlanChange] = []
        names = plan.assembly.names
        suspected = {item.child for item in feedback.lines} | {item.child for item in feedback.types}
        scores = {names[joint.child]: self.candidates.score(plan.tree, joint) for joint in plan.joints}
        odds = {child: feedback.against(child) - score for child, score in scores.items()}
        unsure = {child for child in suspected if feedback.has_error(child) or scores[child] < 0.0}
        hinted = {names[joint.child] for joint in plan.joints if HINTED in joint.evidence}
        self.refused += [
            f"{child}: what failed speaks against its joint, but a hint asked for it; without the hint others are tried"
            for child in sorted(suspected & hinted)
        ]
        doubted = [child for child in odds if child in unsure or -scores[child] > self.config.margin]
        doubted = [child for child in doubted if child not in hinted]
        for child in sorted(doubted, key=lambda child: (-odds[child], child)):
            if child in suspected:
                joint = plan.joints[plan.index(child)]
                values, against = feedback.failed_at(child), feedback.against(child)
                plan = plan.with_joint(self.candidates.after_failures(joint, values, against))
            plan, change = self._again(plan, child, feedback.against(child), _failed_in(feedback, child))
            changes += [change] if change is not None else []
        moved = {change.part for change in changes}
        for signal in feedback.ranges:
            if signal.child not in moved:
                plan, cut = self._cut(plan, signal)
                changes += [cut] if cut is not None else []
        return plan, changes

    def trials(self, plan: Plan, joint: JointEstimate, against: float, tier: str = GEOMETRY) -> list[Trial]:
        """The chosen joint and the near-best candidates of an edge, simulated, as many as there is time for.

        Where those that are tried are all blocked, the others are tried too, until one can move.

        Args:
            plan: Where the other joints are as they are.
            joint: The chosen one.
            against: What the simulation has against it.
            tier: The dearest in which it failed; candidates that could replace it are tried there too.
        """
        best = max((candidate.score for candidate in joint.alternatives), default=0.0)
        first = _known(joint, self.candidates.score(plan.tree, joint), against, tier)
        others: list[Trial] = []
        for number, candidate in enumerate(self._near_best(joint, best)):
            enough = number >= self.config.near_best and not all(trial.blocked for trial in (first, *others))
            if enough or not self.in_time():
                break
            realised = self.candidates.realise(plan.tree, joint, candidate)
            others.append(self.trial(plan, realised, candidate.score - best))
        while others and self.in_time():
            top = max(range(len(others)), key=lambda k: others[k].total)
            if others[top].tier == tier or others[top].total <= first.total:
                break
            others[top] = self.trial(plan, others[top].joint, others[top].score, tier)
        return [first, *others]

    def _near_best(self, joint: JointEstimate, best: float) -> list[JointCandidate]:
        """Candidates within the margin that are not the chosen one, the best of either type among the first."""
        others = [item for item in joint.alternatives if not is_same(joint, item)]
        near = [item for item in others if item.score >= best - self.config.margin]
        kinds = {item.kind.turns: item for item in reversed(near)}
        firsts = sorted(kinds.values(), key=lambda item: -item.score)
        rest = [item for item in near if all(item is not first for first in firsts)]
        some = self.config.near_best
        return sorted((firsts + rest)[:some], key=lambda item: -item.score) + rest[max(some - len(firsts), 0) :]

    def trial(self, plan: Plan, joint: JointEstimate, score: float, tier: str = GEOMETRY) -> Trial:
        """Simulate one joint for a part of a plan, whose inference scored it so."""
        self.simulated += 1
        tried = plan.with_joint(joint)
        child = plan.assembly.names[joint.child]
        verdict = self.simulator.judge_joint(tried.model, tried.joint_of[child])
        if tier != GEOMETRY:
            verdict = self.dear.deepened(verdict, tried, tier)
        feedback = feedback_from(
            verdict.findings,
            verdict.joints,
            tried.model.robot.joint_by_name,
            self.config.feedback,
            placements=verdict.placements,
        )
        blocked = any(signal.check == "KV310" for signal in feedback.lines)
        return Trial(joint=joint, score=score, against=feedback.against(child), blocked=blocked, tier=tier)

    def _again(self, plan: Plan, child: str, against: float, tier: str) -> tuple[Plan, PlanChange | None]:
        """The joint of one part, chosen again."""
        old = plan.joints[plan.index(child)]
        trials = self.trials(plan, old, against, tier)
        first = trials[0]
        if len(trials) > 1 and self._can_never_move(trials):
            return self._fixed(plan, child, old, trials)
        tried = [trial for trial in trials[1:] if trial.tier == tier]
        best = max(tried, key=lambda trial: trial.total - self._lead_of(trial, first), default=first)
        if best.total <= first.total + self._lead_of(best, first) or best.joint.kind is JointType.FIXED:
            return plan, None
        what = "type" if best.joint.kind.turns != old.kind.turns else "axis"
        why = (
            f"evidence {best.score:+.1f} of the geometry and {-best.against:+.1f} of the simulation, against "
            f"{first.score:+.1f} and {-first.against:+.1f}"
        )
        change = PlanChange(part=child, what=what, before=described(old), after=described(best.joint), why=why)
        self.gained[child] = best.total - first.total
        return plan.with_joint(best.joint), change

    def _lead_of(self, trial: Trial, first: Trial) -> float:
        """Return the lead that a candidate needs: more if it moves otherwise, most if it fixes no failure."""
        if first.against == 0.0 or trial.against > 0.0:
            return self.config.margin
        joint, old = trial.joint, first.joint
        alike = abs(float(joint.axis @ old.axis)) > _SAME_WAY and joint.kind.turns == old.kind.turns
        return self.config.lead if alike else self.config.lead_elsewhere

    def _can_never_move(self, trials: list[Trial]) -> bool:
        """Everything that is near-best, turns and slides both, is blocked to both sides: evidence that it is fixed."""
        kinds = {trial.joint.kind.turns for trial in trials}
        return len(kinds) > 1 and self.in_time() and all(trial.blocked for trial in trials)

    def _fixed(self, plan: Plan, child: str, old: JointEstimate, trials: list[Trial]) -> tuple[Plan, PlanChange]:
        joint = replace(old, kind=JointType.FIXED, lower=0.0, upper=0.0)
        why = f"all {len(trials)} near-best joints, turning and sliding, are blocked to both sides at once"
        change = PlanChange(part=child, what="fixed", before=described(old), after="fixed", why=why)
        return plan.with_joint(joint), change

    def _cut(self, plan: Plan, signal: RangeSignal) -> tuple[Plan, PlanChange | None]:
        """End a range where the way ends, unless that leaves less than the stated share of it."""
        old = plan.joints[plan.index(signal.child)]
        new = shortened(old, signal)
        if new is None:
            return plan, None
        share = self.config.least_kept if signal.lost else self.config.least_travel
        if new.upper - new.lower < share * (old.upper - old.lower):
            self.refused.append(
                f"{signal.child}: {signal.check} asked for a range of {ranged(new)} in place of {ranged(old)}; a cut "
                "that large could hide the failure instead of fixing it"
            )
            return plan, None
        change = PlanChange(
            part=signal.child,
            what="range",
            before=ranged(old),
            after=ranged(new),
            why=f"{signal.check}: {signal.reason}",
        )
        return plan.with_joint(new), change


def shortened(joint: JointEstimate, signal: RangeSignal) -> JointEstimate | None:
    """A joint with the range that a signal asks for, its axis turned so that the larger side opens.

    None if nothing changes or nothing is left.
    """
    lower = min(joint.lower if signal.lower is None else signal.lower, 0.0)
    upper = max(joint.upper if signal.upper is None else signal.upper, 0.0)
    if not np.isfinite([lower, upper]).all() or upper - lower <= 0.0 or (lower, upper) == (joint.lower, joint.upper):
        return None
    sign = 1.0 if upper >= -lower else -1.0
    low, high = (lower, upper) if sign > 0 else (-upper, -lower)
    kind = JointType.REVOLUTE if joint.kind.turns else joint.kind
    known = zip((lower, upper), (joint.lower, joint.upper), joint.stops, strict=True)
    stops = [stop if end == before else signal.check for end, before, stop in known][:: int(sign)]
    return replace(joint, kind=kind, axis=sign * joint.axis, lower=low, upper=high, stops=(stops[0], stops[1]))


def _known(joint: JointEstimate, score: float, against: float, tier: str) -> Trial:
    return Trial(joint=joint, score=score, against=against, blocked=against > 0.0, tier=tier)


def _failed_in(feedback: Feedback, child: str) -> str:
    """The dearest tier in which the joint of a part failed."""
    signals = ((signal.child, signal.check) for group in (feedback.lines, feedback.types) for signal in group)
    return max((tier_of(check) for part, check in signals if part == child), key=TIERS.index, default=GEOMETRY)


TWINS = "twins"
"""What the evidence of the other twins is for a joint that followed them [log odds], in `JointEstimate.evidence`."""

if TYPE_CHECKING:
    from kinematify.contact.graph import ContactGraph
    from kinematify.joints.candidate import JointEstimate
    from kinematify.refinement.choose import Chooser
    from kinematify.refinement.joint_plan import Plan


def vote(plan: Plan, graph: ContactGraph, chooser: Chooser) -> tuple[Plan, list[PlanChange]]:
    """Make siblings that are congruent vote about their type.

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
    chosen = replace(trial.joint, evidence={**trial.joint.evidence, TWINS: others})
    return plan.with_joint(chosen), change
