"""The loop: simulate, turn findings into penalties, choose again, and keep the best round (design section 5).

It ends when nothing is left to act on, or when the rounds are used up. The round with the fewest errors, then with the
fewest warnings, then with the most evidence is kept. The inference
wins every tie, so that refining never makes a model worse by its own standards.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.config.validation import load_settings
from kinematify.model.output import MODEL_FILE
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.record import write_inference
from kinematify.processes.lock import writing
from kinematify.refinement.candidates import CandidateJoints, ranged
from kinematify.refinement.choose import LEAST_TRAVEL, Chooser, shortened
from kinematify.refinement.folder import open_model_folder, read_record, stored_state, target_of, write_refined
from kinematify.refinement.hints import HINTED
from kinematify.refinement.joint_plan import History, Plan, PlanChange, Round
from kinematify.refinement.simulate import Simulator
from kinematify.refinement.topology import hung_again
from kinematify.validation.check import FeedbackRow
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, Severity
from kinematify.validation.run.feedback import RangeSignal, feedback_from
from kinematify.validation.run.model_validation import validated

if TYPE_CHECKING:
    from kinematify.config.validation import ValidationSettings
    from kinematify.errors import KinematifyError
    from kinematify.pipeline.infer_assembly import Progress
    from kinematify.pipeline.inference import Inference
    from kinematify.refinement.simulate import MotionVerdict
    from kinematify.validation.run.feedback import Feedback
    from kinematify.validation.run.report import ValidationReport


@dataclass(frozen=True, kw_only=True, eq=False)
class Refinement:
    """Result of the loop: the best answer, with the history of how it was found."""

    inference: Inference
    """The kept round as an inference; its `refinement` holds the history as plain data."""
    history: History
    interrupted: bool = False
    """Ctrl-C ended it."""
    report: ValidationReport | KinematifyError | None = None
    """What `kinematify.validate` said of the folder that was written, or the error that kept it from an answer."""

    @property
    def passes(self) -> bool:
        """True if the round that was kept has no error about motion."""
        kept = self.history.rounds[self.history.kept :][:1]
        return bool(kept) and not kept[0].errors


def refine(
    model: Inference | str | Path,
    out: str | Path | None = None,
    *,
    rounds: int = 3,  # nothing new fails after two rounds on nearly every object
    base: str | None = None,
    overwrite: bool = False,
    preview: bool = True,
    validation: bool = True,
    settings: ValidationSettings | None = None,
    progress: Progress | None = None,
) -> Refinement:
    """Simulate what was inferred, and choose again what the failures point to, as `kinematify refine` does.

    Args:
        model: What `infer` returned, or the folder that it wrote.
        out: Folder to make for the best round, which is then validated: `Refinement.report`. That of a folder replaces
            its model if absent, with `overwrite`.
        rounds: Rounds at most after the first.
        base: Name of the part that is the base link, where it is known.
        overwrite: Replace `out` if it is a model folder.
        preview: Draw a picture into `out`.
        validation: Validate the model in `out`.
        settings: Of the validation of motions; the shipped ones if absent.
        progress: Called with what is being done and the share done.

    Returns:
        The best round. Ctrl-C ends the loop, and the best round so far is returned.

    Raises:
        InputError: It is no model folder, its model was changed since, or `out` lies in it.
        OutputError: `out` exists and must not be replaced, or cannot be written.
    """
    report = progress or (lambda stage, share: None)
    if not isinstance(model, str | Path):
        found = _refined(model, rounds, settings, report)
        if out is not None:
            write_inference(found.inference, out, overwrite=overwrite, preview=preview)
        return found
    target = target_of(Path(model), out, overwrite=overwrite)
    with writing(target):
        report("reading the parts", 0.0)
        assembly, config = open_model_folder(model)
        inference = infer(assembly, config=config, base=base, progress=lambda stage, done: report(stage, 0.4 * done))
        found = _refined(
            stored_state(inference, read_record(Path(model))), rounds, settings,
            lambda stage, done: report(stage, 0.4 + 0.5 * done),
        )  # fmt: skip
        report("writing the model", 0.9)
        write_refined(found.inference, Path(model), target, overwrite=overwrite, preview=preview)
        if validation and not found.interrupted:
            report("checking the geometry and loading the file into engines", 0.94)
            found = replace(found, report=validated(target / MODEL_FILE))
    return found


def _refined(inference: Inference, rounds: int, settings: ValidationSettings | None, progress: Progress) -> Refinement:
    loop = _Loop(inference, rounds, settings or load_settings(), progress)
    interrupted = False
    try:
        loop.run()
    except KeyboardInterrupt:
        loop.ended, interrupted = "it was interrupted", True
    return loop.result(interrupted=interrupted)


def repaired(inference: Inference, *, settings: ValidationSettings | None = None) -> Inference:
    """End ranges before a collision, and choose again once where the motion of what was inferred has an error.

    Args:
        inference: What `infer` returned, with hints or answers.
        settings: Of the validation; the shipped ones if absent.

    Returns:
        The inference with fewer errors about its motion, each change among its warnings; the given one if none goes.
    """
    chosen = settings or load_settings()
    plan = Plan(inference=inference)
    simulator = Simulator(plan.model, chosen.geometry)
    verdict = simulator.judge(plan.model)
    plan, changes = _ended(plan, verdict)
    if changes:
        verdict = simulator.judge(plan.model)
        inference = plan.inference
    if _severities(verdict)[0]:
        found = _refined(inference, 1, chosen, lambda stage, share: None)
        rounds, kept = found.history.rounds, found.history.kept
        if kept and rounds[kept].errors < rounds[0].errors:
            inference = replace(found.inference, refinement=inference.refinement)
            changes += found.history.changed
    said = [f"{item.part}: {item.what} {item.before} was changed to {item.after}: {item.why}." for item in changes]
    result = replace(inference, warnings=(*inference.warnings, *said)) if said else inference
    if inference is plan.inference and not (
        result.closed_chains or any(link.fixed_visuals or link.collision_parts for link in plan.model.links)
    ):
        result.swept.update((sweep.travel.joint, sweep) for sweep in verdict.sweeps)
    return result


def _ended(plan: Plan, verdict: MotionVerdict) -> tuple[Plan, list[PlanChange]]:
    """Ranges that end in another body end before it, where most of the range stays: no failure is hidden by that."""
    changes: list[PlanChange] = []
    free = {joint.joint: joint.free_travel for joint in verdict.joints}
    for finding in verdict.findings:
        ends = free.get(finding.joint or "")
        if finding.check not in _INTO_BODIES or finding.severity is Severity.NOTE or ends is None:
            continue
        child = plan.model.robot.joint_by_name[finding.joint or ""].child
        old = plan.joint(child)
        lower, upper = max(ends[0], old.lower), min(ends[1], old.upper)
        signal = RangeSignal(child=child, lower=lower, upper=upper, lost=False, check="contact", reason=finding.message)
        new = shortened(old, signal)
        if HINTED in old.evidence or new is None or upper - lower < LEAST_TRAVEL * (old.upper - old.lower):
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
    feedback: Feedback
    round: Round


class _Loop:
    """One run of the loop."""

    def __init__(self, given: Inference, rounds: int, settings: ValidationSettings, progress: Progress) -> None:
        self.given, self.rounds, self.progress = given, rounds, progress
        self.started = time.perf_counter()
        self.simulator = Simulator(Plan(inference=given).model, settings.geometry)
        self.against: dict[tuple[int, int], float] = {}
        self.done: list[_Done] = []
        self.candidates = CandidateJoints(given.assembly, given.graph, given.bearings, given.config)
        self.ended = "all rounds were used"
        self.simulated = 0

    def run(self) -> None:
        """Simulate and choose again until there is nothing to choose."""
        plan, changes = Plan(inference=self.given), list[PlanChange]()
        for number in range(self.rounds + 1):
            self.progress(f"round {number}: simulating", number / (self.rounds + 1))
            done = self._simulated(number, plan, changes)
            self.done.append(done)
            if number == self.rounds:
                return
            self.progress(f"round {number}: choosing again", (number + 0.5) / (self.rounds + 1))
            plan, changes, refused = self._choose(done)
            self.done[-1] = replace(done, round=replace(done.round, refused=tuple(refused)))
            if not changes:
                self.ended = "nothing was left to choose again" if done.feedback else "nothing failed that it can fix"
                return

    def result(self, *, interrupted: bool) -> Refinement:
        """The best round as an inference."""
        best = min(self.done, key=self._rank, default=None)
        seconds = time.perf_counter() - self.started
        history = History(
            rounds=tuple(done.round for done in self.done),
            kept=best.round.number if best else 0,
            ended=self.ended,
            seconds=seconds,
            candidates=self.simulated,
        )
        earlier = {} if self.given.refinement is None else {"earlier": dict(self.given.refinement)}
        inference = replace(
            best.plan.inference if best else self.given,
            timings={**self.given.timings, "refinement": seconds},
            refinement={**history.as_json(), **earlier},
        )
        return Refinement(inference=inference, history=history, interrupted=interrupted)

    def _rank(self, done: _Done) -> tuple[float, ...]:
        """Smaller is better: errors about motion, warnings, evidence; earlier rounds win ties."""
        played = done.round
        return played.errors, played.warnings, -played.score, played.number

    def _simulated(self, number: int, plan: Plan, changes: list[PlanChange]) -> _Done:
        """One round: what fails on a plan, and what that means."""
        start, given = time.perf_counter(), plan.inference
        verdict = self.simulator.judge(plan.model)
        feedback = feedback_from(verdict.findings, verdict.joints, plan.model.robot.joint_by_name)
        names, pool = given.assembly.names, self.candidates
        for signal in feedback.edges:
            edge = names.index(signal.parent), names.index(signal.child)
            self.against[edge] = max(self.against.get(edge, 0.0), signal.weight)
        errors, warnings = _severities(verdict)
        scores = [pool.score(given.trees[0], joint) - feedback.against(names[joint.child]) for joint in given.joints]
        simulated = Round(
            number=number,
            changes=tuple(changes),
            errors=errors,
            warnings=warnings,
            failed=tuple(_failed(verdict)),
            suspected=tuple(_suspected(feedback)),
            score=sum(scores) - sum(signal.weight for signal in feedback.edges),
            seconds=time.perf_counter() - start,
        )
        return _Done(plan=plan, feedback=feedback, round=simulated)

    def _choose(self, done: _Done) -> tuple[Plan, list[PlanChange], list[str]]:
        """The next plan: first what the parts touch and hang on, then how they move."""
        edges = done.feedback.edges
        carried = any(CHECKS[signal.check].feedback in _OF_PARENTS for signal in edges)
        if carried and (moved := self._hung_again(done)):
            return *moved, []
        chooser = Chooser(plan=done.plan, candidates=self.candidates, simulator=self.simulator)
        chooser.choose_again(done.feedback)
        self.simulated += chooser.simulated
        # Where no joint on an edge gains as much as the failures say against the edge, it may be the wrong one.
        outweighed = any(edge.weight > chooser.gained.get(edge.child, 0.0) for edge in edges)
        if not carried and outweighed and (moved := self._hung_again(done)):
            return *moved, []
        return chooser.plan, chooser.changes, chooser.refused

    def _hung_again(self, done: _Done) -> tuple[Plan, list[PlanChange]] | None:
        """Another tree on the same base, if the search finds one by what failed, and geometry fails less on it."""
        plan, changes = hung_again(done.plan, self.against)
        before = done.round.errors, done.round.warnings
        return (plan, changes) if changes and _severities(self.simulator.judge(plan.model)) < before else None


_INTO_BODIES = ("KV311", "KV312")
"""Checks of bodies that meet within the range of a joint."""
_OF_PARENTS = (FeedbackRow.OTHER_PARENT, FeedbackRow.NOT_CARRIED)
"""Failures that speak of what carries a part, before they speak of its joint."""


def _severities(verdict: MotionVerdict) -> tuple[int, int]:
    """Errors and warnings about the kinematics."""
    found = [finding.severity for finding in verdict.findings if finding.cause is Cause.KINEMATICS]
    return found.count(Severity.ERROR), found.count(Severity.WARNING)


def _failed(verdict: MotionVerdict) -> list[str]:
    return [
        f"{finding.check} {finding.joint or ''}".strip()
        for finding in verdict.findings
        if finding.cause is Cause.KINEMATICS and finding.severity is not Severity.NOTE
    ]


def _suspected(feedback: Feedback) -> list[str]:
    """Return what is suspected, one phrase per part and decision."""
    edges = [f"{signal.child}: parent" for signal in feedback.edges]
    lines = [f"{signal.child}: axis" for signal in feedback.lines]
    types = [f"{signal.child}: type" for signal in feedback.types]
    ranges = [f"{signal.child}: range" for signal in feedback.ranges]
    return list(dict.fromkeys([*edges, *lines, *types, *ranges]))
