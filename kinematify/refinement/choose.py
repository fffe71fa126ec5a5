"""Choosing joints again under feedback: every near-best candidate is simulated, and the evidence is added up.

The score of a candidate is that of the inference, in log odds, less what the simulation has against it. A candidate
that was never simulated has nothing against it, so none may replace another before it was.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.refinement.candidates import described, is_same, ranged
from kinematify.refinement.hints import HINTED
from kinematify.refinement.joint_plan import PlanChange
from kinematify.robot.joint_type import JointType
from kinematify.validation.run.feedback import feedback_from

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.joints.candidate import JointCandidate, JointEstimate
    from kinematify.refinement.candidates import CandidateJoints
    from kinematify.refinement.joint_plan import Plan
    from kinematify.refinement.simulate import Simulator
    from kinematify.validation.run.feedback import Feedback, RangeSignal

MARGIN = 3.0  # one to twenty: what is less likely is not saved by a sweep
"""Candidates this far below the best are near-best and are simulated; where the chosen joint is farther below, its
shape alone speaks against it [log odds]."""
NEAR_BEST = 4  # on most edges fewer differ
"""So many of them at most."""
LEAD = 0.3  # a tie stays with the inference
"""A candidate replaces the chosen one if it leads by more [log odds]."""
LEAD_ELSEWHERE = 1.2  # less than any error weighs (3.0): half of the doubted axes are right
"""The same for a candidate of another type or direction [log odds]."""
LEAST_TRAVEL = 0.5  # what is blocked earlier has a wrong line or mesh; a shorter range would hide that
"""A range that is blocked may not be cut below this share of what the inference saw free."""
LEAST_KEPT = 0.05  # what has left its parent has no joint any more: all that is kept is all there is
"""The same of a range beyond which the part has left its parent."""
_SAME_WAY = np.cos(np.radians(10.0))  # as `kinematify bench` separates wrong axes from right ones


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

    @property
    def total(self) -> float:
        """Evidence for it, all in all [log odds]."""
        return self.score - self.against


@dataclass(kw_only=True, eq=False)
class Chooser:
    """Simulates candidates and chooses among them."""

    plan: Plan
    """With all that was chosen again so far."""
    candidates: CandidateJoints
    simulator: Simulator
    simulated: int = 0
    changes: list[PlanChange] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    """Choices that would have hidden a failure, with the reason."""
    gained: dict[str, float] = field(default_factory=dict)
    """What joints that were chosen again have before the old ones, by part [log odds]."""

    def choose_again(self, feedback: Feedback) -> None:
        """Take decisions about joints again, one part after the other, those that most speaks against first.

        Doubted are the joints that failures point to, and those that score far less than a candidate by shape alone.
        A warning by itself moves no joint that nothing scores above, for true joints warn too.

        Args:
            feedback: What the failures of the plan point to.
        """
        given = self.plan.inference
        suspected = {item.child for item in (*feedback.lines, *feedback.types)}
        odds: dict[str, float] = {}
        for joint in given.joints:
            child, score = given.assembly.names[joint.child], self.candidates.score(given.trees[0], joint)
            if HINTED in joint.evidence:
                if child in suspected:
                    self.refused.append(f"{child}: a hint asked for its joint; without the hint others are tried")
            elif -score > MARGIN or (child in suspected and (feedback.has_error(child) or score < 0.0)):
                odds[child] = score - feedback.against(child)
        for child in sorted(odds, key=lambda child: (odds[child], child)):
            self._again(child, feedback.against(child))
        moved = {change.part for change in self.changes}
        for signal in feedback.ranges:
            if signal.child not in moved:
                self._cut(signal)

    def trial(self, joint: JointEstimate, score: float) -> Trial:
        """Simulate one joint for a part of the plan, whose inference scored it so."""
        self.simulated += 1
        tried = self.plan.with_joint(joint)
        child = tried.inference.assembly.names[joint.child]
        verdict = self.simulator.judge(tried.model, child)
        feedback = feedback_from(verdict.findings, verdict.joints, tried.model.robot.joint_by_name)
        blocked = any(signal.check == "KV310" for signal in feedback.lines)
        return Trial(joint=joint, score=score, against=feedback.against(child), blocked=blocked)

    def _trials(self, first: Trial) -> Iterator[Trial]:
        """Near-best candidates, simulated; where those that are tried are all blocked, others too until one moves."""
        joint, tree = first.joint, self.plan.inference.trees[0]
        best = max((candidate.score for candidate in joint.alternatives), default=0.0)
        blocked = first.blocked
        for number, candidate in enumerate(self._near_best(joint, best)):
            if number >= NEAR_BEST and not blocked:
                return
            trial = self.trial(self.candidates.realise(tree, joint, candidate), candidate.score - best)
            blocked &= trial.blocked
            yield trial

    def _near_best(self, joint: JointEstimate, best: float) -> list[JointCandidate]:
        """Candidates within the margin that are not the chosen one, the best of either type among the first."""
        least = best - MARGIN
        near = [item for item in joint.alternatives if item.score >= least and not is_same(joint, item)]
        tops = {item.kind.turns: item for item in reversed(near)}.values()
        rest = [item for item in near if all(item is not top for top in tops)]
        some = max(NEAR_BEST - len(tops), 0)
        return [*sorted((*tops, *rest[:some]), key=lambda item: -item.score), *rest[some:]]

    def _again(self, child: str, against: float) -> None:
        """Choose the joint of one part again."""
        old = self.plan.joint(child)
        score = self.candidates.score(self.plan.inference.trees[0], old)
        first = Trial(joint=old, score=score, against=against, blocked=against > 0.0)
        others = list(self._trials(first))
        tried = [first, *others]
        if others and all(trial.blocked for trial in tried) and len({trial.joint.kind.turns for trial in tried}) > 1:
            why = f"all {len(tried)} near-best joints, turning and sliding, are blocked to both sides at once"
            self._take(replace(old, kind=JointType.FIXED, lower=0.0, upper=0.0), "fixed", why)
            return
        best = max(others, key=lambda trial: trial.total - self._lead_of(trial, first), default=first)
        if best.total <= first.total + self._lead_of(best, first) or best.joint.kind is JointType.FIXED:
            return
        self.gained[child] = best.total - first.total
        why = (
            f"evidence {best.score:+.1f} of the geometry and {-best.against:+.1f} of the simulation, against "
            f"{first.score:+.1f} and {-first.against:+.1f}"
        )
        self._take(best.joint, "type" if best.joint.kind.turns != old.kind.turns else "axis", why)

    def _lead_of(self, trial: Trial, first: Trial) -> float:
        """Return the lead that a candidate needs: more if it moves otherwise, most if it fixes no failure."""
        if first.against == 0.0 or trial.against > 0.0:
            return MARGIN
        joint, old = trial.joint, first.joint
        alike = abs(float(joint.axis @ old.axis)) > _SAME_WAY and joint.kind.turns == old.kind.turns
        return LEAD if alike else LEAD_ELSEWHERE

    def _take(self, joint: JointEstimate, what: str, why: str) -> None:
        """Put a joint into the plan, and note it."""
        child = self.plan.inference.assembly.names[joint.child]
        words = ranged if what == "range" else described
        change = PlanChange(part=child, what=what, before=words(self.plan.joint(child)), after=words(joint), why=why)
        self.changes.append(change)
        self.plan = self.plan.with_joint(joint)

    def _cut(self, signal: RangeSignal) -> None:
        """End a range where the way ends, unless that leaves less than the stated share of it."""
        old = self.plan.joint(signal.child)
        new = shortened(old, signal)
        share = LEAST_KEPT if signal.lost else LEAST_TRAVEL
        if new is None:
            return
        if new.upper - new.lower < share * (old.upper - old.lower):
            self.refused.append(
                f"{signal.child}: {signal.check} asked for a range of {ranged(new)} in place of {ranged(old)}; a cut "
                "that large could hide the failure instead of fixing it"
            )
            return
        self._take(new, "range", f"{signal.check}: {signal.reason}")


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
