"""Questions about the joints of an inference, to a model, and what comes of their answers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from kinematify.refinement.candidates import CandidateJoints
from kinematify.vision.client import read_kept, write_kept
from kinematify.vision.pictures import joint_question
from kinematify.vision.votes import VoterRecord, choose_again, to_ask, with_types

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from kinematify.joints.candidate import JointCandidate
    from kinematify.pipeline.inference import Inference
    from kinematify.vision.client import ChatOracle
    from kinematify.vision.question import Answer, JointOracle
    from kinematify.vision.screening import KnownQuestion
    from kinematify.vision.votes import VoteResult

_NAMED = 5


@dataclass(frozen=True, kw_only=True)
class Voting:
    """Result of the questions."""

    voter: str
    answers: Mapping[str, Answer]
    """By the part that was asked about."""
    results: tuple[VoteResult, ...] = ()
    """Joints that an answer speaks of."""
    not_shown: tuple[str, ...] = ()
    """Parts that no picture shows, so that nobody was asked about them."""
    not_asked: tuple[str, ...] = ()
    """Doubtful joints beyond the budget."""
    record: VoterRecord | None = None

    @property
    def reached(self) -> bool:
        """True if there was an answer, or nothing to ask."""
        return not self.answers or any(not answer.fault for answer in self.answers.values())

    def as_json(self) -> dict[str, Any]:
        """For `inference.json`."""
        return {
            "voter": self.voter,
            "record": None if self.record is None else {"right": self.record.right, "asked": self.record.asked},
            "tokens": sum(answer.tokens for answer in self.answers.values()),
            "joints": [result.as_json() for result in self.results],
            "not_shown": list(self.not_shown),
            "not_asked": list(self.not_asked),
        }

    def described(self) -> str:
        """Return how many questions were answered, what changed, and why there were no answers."""
        usable = [answer for answer in self.answers.values() if not answer.fault]
        changed = [result.child for result in self.results if result.changed]
        lines = [
            f"{self.voter} answered {len(usable)} of {len(self.answers)} questions about joints and changed "
            f"{len(changed)} joints." if self.answers else "No joint is doubtful enough to ask about (--vlm-all asks).",
        ]  # fmt: skip
        if self.record is not None and self.answers:
            lines.append(f"Record of {self.voter}: {self.record.right} of {self.record.asked} known joints right.")
        for title, names in (
            ("Changed", changed), ("Not asked, no picture shows the part", self.not_shown),
            ("Not asked, beyond the budget", self.not_asked),
        ):  # fmt: skip
            if names:
                lines.append(f"{title}: {', '.join(names[:_NAMED])}{', ...' if len(names) > _NAMED else ''}.")
        faults = dict.fromkeys(answer.fault for answer in self.answers.values() if answer.fault)
        lines += [f"Counted as unsure: {fault}" for fault in list(faults)[:_NAMED]]
        return "\n".join(lines)


def with_votes(
    inference: Inference,
    oracle: JointOracle,
    record: VoterRecord,
    *,
    everything: bool = False,
    known: Collection[str] = (),
) -> tuple[Inference, Voting]:
    """Ask about the doubtful joints of an inference and choose again with the answers.

    Args:
        inference: What geometry says.
        oracle: Who is asked.
        record: How often it was right.
        everything: Ask about sure joints, too, and without a budget.
        known: Parts that nobody needs to be asked about.
    """
    heard, voting = _heard(inference, oracle, everything=everything, known=known)
    reliability = record.reliability(inference.config.vision)
    chosen, results = choose_again(inference, heard.answers, heard.shown, reliability)
    voting = replace(voting, results=tuple(results), record=record)
    return (replace(chosen, vision=voting.as_json()) if voting.answers else inference), voting


def with_types_first(inference: Inference, oracle: JointOracle) -> tuple[Inference, Voting]:
    """Ask for the type of every joint before its axis is chosen, with a majority over congruent parts (III-D)."""
    drawn = {place: joint_question(inference, place, None) for place in range(len(inference.joints))}
    asked = {place: question for place, question in drawn.items() if question is not None}
    answers = dict(zip(asked, oracle.ask(list(asked.values())), strict=True))
    least = inference.config.vision.least_confidence
    types = {place: answer.choice for place, answer in answers.items() if answer.counts(least)}
    names = _children(inference)
    chosen, results = with_types(inference, types, answers)
    voting = Voting(
        voter=oracle.name, answers={names[place]: answer for place, answer in answers.items()},
        results=tuple(results), not_shown=tuple(names[place] for place in drawn if place not in asked),
    )  # fmt: skip
    return replace(chosen, vision=voting.as_json()), voting


def voter_record(oracle: ChatOracle, known: Callable[[], Iterable[KnownQuestion]]) -> VoterRecord:
    """The record of a model, from the user's cache, or else from questions whose right answers are known.

    Args:
        oracle: The model.
        known: Makes the questions, with the answers that are right.
    """
    kept = read_kept(oracle.record_path)
    if kept is not None and all(isinstance(kept.get(key), int) for key in ("right", "asked")):
        return VoterRecord(right=kept["right"], asked=kept["asked"])
    questions = list(known())
    answers = oracle.ask([question for question, _ in questions])
    pairs = zip(answers, questions, strict=True)
    counted = [(answer, right) for answer, (_, right) in pairs if answer.counts(oracle.config.least_confidence)]
    record = VoterRecord(right=sum(answer.choice in right for answer, right in counted), asked=len(counted))
    if not oracle.fault:
        write_kept(oracle.record_path, {"right": record.right, "asked": record.asked})
    return record


@dataclass(frozen=True, kw_only=True)
class Answers:
    """By the place of the joint."""

    shown: Mapping[int, tuple[JointCandidate, ...]]
    answers: Mapping[int, Answer]


def _heard(
    inference: Inference, oracle: JointOracle, *, everything: bool, known: Collection[str]
) -> tuple[Answers, Voting]:
    """Ask a few questions at a time, until the tokens are spent."""
    config, names = inference.config.vision, _children(inference)
    maker = CandidateJoints(inference.assembly, inference.graph, inference.bearings, inference.config)
    places, beyond = to_ask(inference, everything=everything, known=known)
    hidden = list[int]()
    shown: dict[int, tuple[JointCandidate, ...]] = {}
    answers: dict[int, Answer] = {}
    for start in range(0, len(places), oracle.at_once):
        if not everything and sum(answer.tokens for answer in answers.values()) >= config.tokens:
            beyond = [*places[start:], *beyond]
            break
        drawn = {place: joint_question(inference, place, maker) for place in places[start : start + oracle.at_once]}
        asked = {place: question for place, question in drawn.items() if question is not None}
        hidden += [place for place in drawn if place not in asked]
        shown |= {place: question.options for place, question in asked.items()}
        answers |= dict(zip(asked, oracle.ask(list(asked.values())), strict=True))
    return Answers(shown=shown, answers=answers), Voting(
        voter=oracle.name, answers={names[place]: answer for place, answer in answers.items()},
        not_shown=tuple(names[place] for place in hidden), not_asked=tuple(names[place] for place in beyond),
    )  # fmt: skip


def _children(inference: Inference) -> list[str]:
    return [inference.assembly.names[joint.child] for joint in inference.joints]
