"""The loop: simulate, feed back, choose again, and keep the best round (design section 5).

It ends when nothing is left to act on, when a plan repeats, when the rounds or the time are used up. Each round is a
plan of its own, simulated in the cheap tier first, and in a dearer one where nothing is left to choose by that. The one
with the fewest errors, then with the right parts and contacts, then with the fewest warnings,
then with the most evidence is kept. The inference wins every tie, so that refining never makes a model worse by its
own standards.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from kinematify.config.validation import load_settings
from kinematify.contact.seams import find_seams
from kinematify.geometry.surface import part_surfaces
from kinematify.refinement.candidates import CandidateJoints, ranged
from kinematify.refinement.choose import TWINS, Chooser, shortened, vote
from kinematify.refinement.hints import HINTED
from kinematify.refinement.joint_plan import History, Plan, PlanChange, Round
from kinematify.refinement.simulate import TIERS, ExpensiveTiers, Simulator
from kinematify.refinement.topology import (
    EdgeMemory,
    SearchedContacts,
    audit_contacts,
    infer_joined,
    rebuilt,
    replanned,
    search_again,
)
from kinematify.validation.check import FeedbackRow
from kinematify.validation.checks import CHECKS
from kinematify.validation.failure_rates import GEOMETRY
from kinematify.validation.finding import Cause, Severity
from kinematify.validation.run.feedback import RangeSignal, feedback_from

if TYPE_CHECKING:
    from kinematify.config.validation import ValidationSettings
    from kinematify.pipeline.infer_assembly import Progress
    from kinematify.pipeline.inference import Inference
    from kinematify.refinement.simulate import MotionVerdict
    from kinematify.validation.run.feedback import Feedback


@dataclass(frozen=True, kw_only=True, eq=False)
class Refinement:
    """Result of the loop: the best answer, with the history of how it was found."""

    inference: Inference
    """The kept round as an inference; its `refinement` holds the history as plain data."""
    history: History
    interrupted: bool = False
    """Ctrl-C ended it."""


def refine(
    inference: Inference,
    *,
    rounds: int | None = None,
    tier: str = GEOMETRY,
    seconds: float | None = None,
    base: str | None = None,
    settings: ValidationSettings | None = None,
    progress: Progress | None = None,
) -> Refinement:
    """Simulate what was inferred, and choose again what the failures point to.

    Args:
        inference: What `infer` returned.
        rounds: Rounds at most after the first; those of the configuration if absent.
        tier: How far plans are simulated: ``geometry`` (exact sweeps), ``engines`` (MuJoCo and PyBullet too) or
            ``task`` (and an arm that pulls).
        seconds: Time at most [s]; a multiple of the time of the inference if absent, for dear tiers no limit.
        base: Name of the part that is the base link, where it is known.
        settings: Of the validation; the shipped ones if absent.
        progress: Called with what is being done and the share done.

    Returns:
        The best round. Ctrl-C ends the loop, and the best round so far is returned.

    Raises:
        ValueError: The tier is unknown, or there is no time.
    """
    if tier not in TIERS:
        raise ValueError(f"There is no tier {tier}. Give one of {', '.join(TIERS)}.")
    if seconds is not None and not seconds > 0.0:
        raise ValueError(f"The time for all rounds is {seconds} s. Give a number of seconds above 0, or None.")
    config = inference.config.refine
    usual = max(config.seconds_factor * sum(inference.timings.values()), config.seconds_least)
    loop = _Loop(
        _Request(
            given=inference,
            rounds=config.rounds if rounds is None else rounds,
            tier=tier,
            seconds=seconds if seconds is not None else usual if tier == GEOMETRY else float("inf"),
            base=None if base is None else inference.assembly.names.index(base),
            settings=settings or load_settings(),
            progress=progress or (lambda stage, share: None),
        )
    )
    try:
        loop.run()
        loop.settle()
    except KeyboardInterrupt:
        loop.ended = "it was interrupted"
        return replace(loop.result(), interrupted=True)
    return loop.result()


def repaired(inference: Inference, *, base: str | None = None, settings: ValidationSettings | None = None) -> Inference:
    """End ranges before a collision, and choose again once where the motion of what was inferred has an error.

    Args:
        inference: What `infer` returned, with hints or answers.
        base: Name of the part that is the base link, where it is known.
        settings: Of the validation; the shipped ones if absent.

    Returns:
        The inference with fewer errors about its motion, each change among its warnings; the given one if none goes.
    """
    chosen = settings or load_settings()
    plan = Plan(assembly=inference.assembly, config=inference.config, tree=inference.trees[0], joints=inference.joints)
    simulator = Simulator(plan.model, chosen.geometry)
    verdict = simulator.judge(plan.model)
    plan, changes = _ended(plan, verdict)
    if changes:
        verdict = simulator.judge(plan.model)
        inference = replace(inference, joints=plan.joints)
    if _severities(verdict)[0]:
        found = refine(inference, rounds=1, base=base, settings=chosen)
        rounds, kept = found.history.rounds, found.history.kept
        if kept and rounds[kept].errors < rounds[0].errors:
            inference = replace(found.inference, refinement=inference.refinement)
            changes += found.history.changed
    said = [f"{item.part}: {item.what} {item.before} was changed to {item.after}: {item.why}." for item in changes]
    return replace(inference, warnings=(*inference.warnings, *said)) if said else inference


def _ended(plan: Plan, verdict: MotionVerdict) -> tuple[Plan, list[PlanChange]]:
    """Ranges that end in another body end before it, where most of the range stays: no failure is hidden by that."""
    changes: list[PlanChange] = []
    free = {joint.joint: joint.free_travel for joint in verdict.joints}
    least = plan.config.refine.least_travel
    for finding in verdict.findings:
        ends = free.get(finding.joint or "")
        if finding.check not in _INTO_BODIES or finding.severity is Severity.NOTE or ends is None:
            continue
        child = plan.model.robot.joint_by_name[finding.joint or ""].child
        old = plan.joints[plan.index(child)]
        lower, upper = max(ends[0], old.lower), min(ends[1], old.upper)
        signal = RangeSignal(
            child=child, lower=lower, upper=upper, lost=False, weight=0.0, check="contact", reason=finding.message
        )
        new = shortened(old, signal)
        if HINTED in old.evidence or new is None or upper - lower < least * (old.upper - old.lower):
            continue
        plan = plan.with_joint(new)
        changes.append(
            PlanChange(part=child, what="range", before=ranged(old), after=ranged(new), why=finding.message.rstrip("."))
        )
    return plan, changes


@dataclass(frozen=True, kw_only=True, eq=False)
class _Done:
    """A round that was simulated."""

    plan: Plan
    contacts: SearchedContacts
    verdict: MotionVerdict
    feedback: Feedback
    round: Round

    def rank(self, sound_at: int) -> tuple[float, ...]:
        """Smaller is better: errors about motion, wrong parts or contacts, warnings, evidence; earlier rounds win ties.

        Args:
            sound_at: Number of the round from which on parts and contacts are what the meshes say.
        """
        errors, warnings = _severities(self.verdict)
        return errors, self.round.number < sound_at, warnings, -self.round.score, self.round.number


@dataclass(frozen=True, kw_only=True, eq=False)
class _Request:
    """Request to `refine`."""

    given: Inference
    rounds: int
    tier: str
    seconds: float
    base: int | None
    settings: ValidationSettings
    progress: Progress


class _Loop:
    """One run of the loop."""

    def __init__(self, request: _Request) -> None:
        self.request, self.given, self.tier = request, request.given, request.tier
        self.config, self.base, self.rounds = request.given.config.refine, request.base, request.rounds
        self.started = time.perf_counter()
        self.memory = EdgeMemory()
        self.dear = ExpensiveTiers(settings=request.settings)
        self.done: list[_Done] = []
        self.candidates: dict[SearchedContacts, CandidateJoints] = {}
        self.ended = "all rounds were used"
        self.simulated = 0
        self.sound_at = 0

    def in_time(self) -> bool:
        """True if there is time for one thing more."""
        return time.perf_counter() - self.started < self.request.seconds

    def run(self) -> None:
        """All rounds."""
        assembly = self.given.assembly
        contacts = SearchedContacts(graph=self.given.graph, bearings=self.given.bearings)
        plan = Plan(assembly=assembly, config=self.given.config, tree=self.given.trees[0], joints=self.given.joints)
        self.simulator = Simulator(plan.model, self.request.settings.geometry)
        seen = set()
        changes: list[PlanChange] = []
        refused: list[str] = []
        for number in range(self.rounds + 1):
            seen.add(plan.signature)
            done = self._simulate(number, plan, contacts, changes, refused)
            self.done.append(done)
            if number == self.rounds:
                return
            plan, contacts, changes, refused = self._choose(done)
            while not changes and done.round.tier != self.tier and self.in_time():
                done = self._deepened(number)
                plan, contacts, changes, refused = self._choose(done)
            if not changes:
                self.done[-1] = replace(done, round=replace(done.round, refused=(*done.round.refused, *refused)))
                if done.round.tier != self.tier:
                    self.ended = f"the time was used up before {self.tier} could be simulated"
                else:
                    self.ended = (
                        "nothing was left to choose again" if done.feedback else "nothing failed that it can fix"
                    )
                return
            if plan.signature in seen:
                self.ended = "the next plan had been simulated before"
                return
            if not self.in_time() and self.sound_at != number + 1:  # what is known to be wrong is never kept for haste
                self.ended = "the time was used up"
                return

    def settle(self) -> None:
        """Simulate the best round as far as was asked: a dear tier adds failures only, so that others may be better."""
        while self.in_time() and (best := self._best()).round.tier != self.tier:
            self._deepened(best.round.number)

    def _best(self) -> _Done:
        return min(self.done, key=lambda done: done.rank(self.sound_at))

    def result(self) -> Refinement:
        """The best round as an inference; of those that were simulated farthest, where the time did not last."""
        if not self.done:
            history = self._history(0)
            return Refinement(inference=replace(self.given, refinement=self._record(history)), history=history)
        farthest = max((done.round.tier for done in self.done), key=TIERS.index)
        finalists = [done for done in self.done if done.round.tier == farthest]
        best = min(finalists, key=lambda done: done.rank(self.sound_at))
        history = self._history(best.round.number)
        inference = self.given
        if best.round.number > 0:
            trees = (best.plan.tree, *(tree for tree in inference.trees if tree.parents != best.plan.tree.parents))
            inference = replace(
                inference,
                trees=trees,
                joints=best.plan.joints,
                graph=best.contacts.graph,
                bearings=best.contacts.bearings,
            )
        timings = {**inference.timings, "refinement": time.perf_counter() - self.started}
        return Refinement(
            inference=replace(inference, timings=timings, refinement=self._record(history)), history=history
        )

    def _simulate(
        self, number: int, plan: Plan, contacts: SearchedContacts, changes: list[PlanChange], refused: list[str]
    ) -> _Done:
        """One round: the plan by geometry."""
        self.request.progress(f"round {number}: simulating", number / (self.rounds + 1))
        start = time.perf_counter()
        verdict = self.simulator.judge(plan.model)
        played = Round(
            number=number,
            tier=GEOMETRY,
            changes=tuple(changes),
            motion_errors=_severities(verdict)[0],
            seconds=time.perf_counter() - start,
            refused=tuple(refused),
        )
        return self._judged(plan, contacts, verdict, played)

    def _deepened(self, number: int) -> _Done:
        """A round in the next dearer tier."""
        done = self.done[number]
        tier = TIERS[TIERS.index(done.round.tier) + 1]
        self.request.progress(f"round {number}: simulating by {tier}", number / (self.rounds + 1))
        start = time.perf_counter()
        verdict = self.dear.deepened(self.simulator.judge(done.plan.model), done.plan, tier)
        played = replace(done.round, tier=tier, seconds=done.round.seconds + time.perf_counter() - start)
        self.done[number] = self._judged(done.plan, done.contacts, verdict, played)
        return self.done[number]

    def _judged(self, plan: Plan, contacts: SearchedContacts, verdict: MotionVerdict, played: Round) -> _Done:
        """A round with what its verdict means."""
        feedback = feedback_from(
            verdict.findings,
            verdict.joints,
            plan.model.robot.joint_by_name,
            self.config.feedback,
            placements=verdict.placements,
        )
        self.memory.add(plan.assembly, feedback.edges)
        errors, warnings = _severities(verdict)
        judged = replace(
            played,
            errors=errors,
            warnings=warnings,
            failed=tuple(_failed(verdict)),
            suspected=tuple(_suspected(feedback)),
            score=self._score(plan, contacts, feedback),
        )
        return _Done(plan=plan, contacts=contacts, verdict=verdict, feedback=feedback, round=judged)

    def _choose(self, done: _Done) -> tuple[Plan, SearchedContacts, list[PlanChange], list[str]]:
        """The next plan: first what the parts are and what they hang on, then how they move."""
        self.request.progress(
            f"round {done.round.number}: choosing again", (done.round.number + 0.5) / (self.rounds + 1)
        )
        if done.round.number == 0 and done.round.tier == GEOMETRY:
            rebuilt_plan = self._rebuilt(done)
            if rebuilt_plan is not None:
                self.sound_at = 1
                return (*rebuilt_plan, [])
        carried = any(CHECKS[signal.check].feedback in _OF_PARENTS for signal in done.feedback.edges)
        plan, changes = self._repaired(done) if carried else (done.plan, [])
        if changes:
            return plan, done.contacts, changes, []
        candidates = self._candidates_of(done.contacts)
        chooser = Chooser(
            candidates=candidates,
            simulator=self.simulator,
            dear=self.dear,
            config=self.config,
            in_time=self.in_time,
        )
        plan, changes = chooser.choose_again(plan, done.feedback)
        plan, votes = vote(plan, done.contacts.graph, chooser)
        self.simulated += chooser.simulated
        changes += votes
        # Where no joint on an edge gains as much as the failures say against the edge, it may be the wrong one.
        if not carried and any(edge.weight > chooser.gained.get(edge.child, 0.0) for edge in done.feedback.edges):
            other, moved = self._repaired(done)
            if moved:
                return other, done.contacts, moved, []
        return plan, done.contacts, changes, chooser.refused

    def _candidates_of(self, contacts: SearchedContacts) -> CandidateJoints:
        """The joints that the edges of a contact graph may have."""
        if contacts not in self.candidates:
            self.candidates[contacts] = CandidateJoints(
                self.given.assembly, contacts.graph, contacts.bearings, self.given.config
            )
        return self.candidates[contacts]

    def _score(self, plan: Plan, contacts: SearchedContacts, feedback: Feedback) -> float:
        """Evidence for the chosen joints, less what speaks against them [log odds]."""
        candidates = self._candidates_of(contacts)
        scores = [candidates.score(plan.tree, joint) + joint.evidence.get(TWINS, 0.0) for joint in plan.joints]
        against = [feedback.against(plan.assembly.names[joint.child]) for joint in plan.joints]
        return sum(scores) - sum(against) - sum(signal.weight for signal in feedback.edges)

    def _rebuilt(self, done: _Done) -> tuple[Plan, SearchedContacts, list[PlanChange]] | None:
        """Parts that were one, and contacts that the graph has wrong; None where both are right."""
        assembly, config = self.given.assembly, self.given.config
        surfaces = part_surfaces(assembly, config=config.surface)
        seams = find_seams(assembly, surfaces, done.plan.tree.root, config.seam) if config.seam.join else {}
        if seams:
            joined = infer_joined(done.plan, done.contacts, seams, base=self.base)
            if joined[2]:
                return joined
        audit = audit_contacts(assembly, surfaces, self.given.graph, config)
        if not audit:
            return None
        graph, bearings = rebuilt(assembly, surfaces, audit, self.given.bearings, config)
        contacts = SearchedContacts(graph=graph, bearings=bearings)
        trees = search_again(assembly, contacts, self.memory, self.given.trees, config, base=self.base)
        plan, changes = replanned(done.plan, done.contacts, contacts, trees[0])
        why = f"{len(audit.missing)} contacts were missing and {len(audit.spurious)} are none"
        applied = PlanChange(
            part=assembly.names[trees[0].root], what="contacts", before=f"{len(self.given.graph.edges)}",
            after=f"{len(graph.edges)}", why=why,
        )  # fmt: skip
        return plan, contacts, [applied, *changes]

    def _repaired(self, done: _Done) -> tuple[Plan, list[PlanChange]]:
        """Another tree on the same base, if the search finds one by what failed, and geometry fails less on it."""
        if not done.feedback.edges:
            return done.plan, []
        base = done.plan.tree.root
        trees = search_again(
            done.plan.assembly, done.contacts, self.memory, self.given.trees, self.given.config, base=base
        )
        if trees[0].parents == done.plan.tree.parents:
            return done.plan, []
        plan, changes = replanned(done.plan, done.contacts, done.contacts, trees[0])
        before, after = (self.simulator.judge(tried.model) for tried in (done.plan, plan))
        return (plan, changes) if _severities(after) < _severities(before) else (done.plan, [])

    def _record(self, history: History) -> dict[str, Any]:
        """The history as JSON values, with that of an earlier refinement if there was one."""
        earlier = self.given.refinement
        return {**history.as_json(), **({} if earlier is None else {"earlier": dict(earlier)})}

    def _history(self, kept: int) -> History:
        return History(
            rounds=tuple(done.round for done in self.done),
            kept=kept,
            ended=self.ended,
            tier=self.tier,
            seconds=time.perf_counter() - self.started,
            candidates=self.simulated,
        )


_INTO_BODIES = ("KV311", "KV312")
"""Checks of bodies that meet within the range of a joint."""
_MOTION_CAUSES = (Cause.KINEMATICS, Cause.TASK)
_OF_PARENTS = (FeedbackRow.OTHER_PARENT, FeedbackRow.NOT_CARRIED)
"""Failures that speak of what carries a part, before they speak of its joint."""


def _severities(verdict: MotionVerdict) -> tuple[int, int]:
    """Errors and warnings about the kinematics or that a task failed on."""
    found = [finding.severity for finding in verdict.findings if finding.cause in _MOTION_CAUSES]
    return found.count(Severity.ERROR), found.count(Severity.WARNING)


def _failed(verdict: MotionVerdict) -> list[str]:
    return [
        f"{finding.check} {finding.joint or ''}".strip()
        for finding in verdict.findings
        if finding.cause in _MOTION_CAUSES and finding.severity is not Severity.NOTE
    ]


def _suspected(feedback: Feedback) -> list[str]:
    """Return what is suspected, one phrase per part and decision."""
    edges = [f"{signal.child}: parent" for signal in feedback.edges]
    lines = [f"{signal.child}: axis" for signal in feedback.lines]
    types = [f"{signal.child}: type" for signal in feedback.types]
    ranges = [f"{signal.child}: range" for signal in feedback.ranges]
    return list(dict.fromkeys([*edges, *lines, *types, *ranges]))
