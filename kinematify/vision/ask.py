"""One question about an object, to a model or a person, and what comes of the answer."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.contact.graph import pair
from kinematify.grouping.groups import group_pieces
from kinematify.grouping.numbered_pieces import BODY
from kinematify.refinement.hints import with_parents
from kinematify.vision.client import oracle_of, read_kept, write_kept
from kinematify.vision.piece_question import piece_question, read_answer_file
from kinematify.vision.screening import known_questions, right_parts
from kinematify.vision.votes import VoterRecord, follow_parts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.grouping.groups import Grouping
    from kinematify.pipeline.inference import Inference
    from kinematify.vision.client import ChatOracle
    from kinematify.vision.piece_question import PieceAnswer, PieceQuestion
    from kinematify.vision.screening import KnownQuestion


@dataclass(frozen=True, kw_only=True)
class PieceVote:
    """What was said of an object of numbered pieces."""

    voter: str
    question: PieceQuestion
    answer: PieceAnswer
    record: VoterRecord | None = None
    """None for what a user gives, which is taken as it is."""

    @property
    def trust(self) -> float:
        """Weight beside geometry, in [0, 1]."""
        return 1.0 if self.record is None else self.record.trust

    @property
    def base(self) -> str | None:
        """Name of the base link, where the answer says what stands still."""
        return None if self.question.assembly.segmented or self.trust < 1.0 else BODY

    def grouping(self, config: Config) -> Grouping:
        """The pieces grouped with the answer.

        Raises:
            AssemblyError: No part moves.
        """
        named = self.answer.parts
        return group_pieces(self.question.assembly, config.grouping, named=named, trust=self.trust)

    def applied(self, inference: Inference) -> Inference:
        """The inference with the types and axes that were named, and with what carries what where parts touch."""
        names, record = inference.assembly.names, self.record
        index = {name: k for k, name in enumerate(names)}
        if self.base is not None:
            above = {index[part.name]: index[part.on] for part in self.answer.parts if {part.name, part.on} <= {*names}}
            touching = {pair(edge.a, edge.b) for edge in inference.graph.edges}
            inference = with_parents(inference, {k: on for k, on in above.items() if pair(k, on) in touching})
        pieces = self.question.assembly
        links = {
            part.name: {
                index.get(name, -1)
                for name in ([pieces.names[k] for k in part.pieces] if pieces.segmented else [part.name])
            }
            for part in self.answer.parts
        }
        named = {
            joint.child: part for joint in inference.joints for part in self.answer.parts
            if joint.child in links[part.name] and joint.parent not in links[part.name]
        }  # fmt: skip
        found, results = inference, list[dict[str, Any]]()
        if self.trust > 0.0:
            config = inference.config.vision
            reliability = config.reliability if record is None else record.reliability(config)
            found, results = follow_parts(inference, named, reliability, taken=self.trust >= 1.0)
        notes = [
            f"{item['child']}: no candidate of geometry moves as the answer says." for item in results
            if not item["candidates"] and item["before"] == item["after"]
        ]  # fmt: skip
        return replace(
            found, vision=self._as_json(results), warnings=(*self.answer.described(), *notes, *found.warnings)
        )

    def _as_json(self, results: list[dict[str, Any]]) -> dict[str, Any]:
        """For `inference.json`."""
        return {
            "voter": self.voter,
            "record": None if self.record is None else {"right": self.record.right, "asked": self.record.asked},
            "trust": self.trust, "questions": 1, "tokens": self.answer.tokens, "object": self.answer.about,
            "named": self.answer.named, "taken": [part.name for part in self.answer.parts],
            "fault": self.answer.fault, "described": self._described(), "joints": results,
        }  # fmt: skip

    def _described(self) -> str:
        """Who answered, what that cost, and what its record is."""
        if self.answer.fault:
            return f"{self.voter} gave no answer, so geometry decided alone: {self.answer.fault}"
        record = self.record
        worth = "taken as they are" if record is None else f"{record.right} of {record.asked} known parts right"
        return f"{self.voter} named {self.answer.named} moving parts for {self.answer.tokens} tokens: {worth}."


def ask_pieces(given: Assembly, vlm: str, answer: Path | None, config: Config) -> PieceVote | None:
    """Ask a file or a model about the pieces of an object; without an answer geometry decides alone.

    Args:
        given: Pieces of a mesh, or parts.
        vlm: ``off``, ``auto`` or the address of a model.
        answer: File of a person's or a chat's answer; it comes first.
        config: Of the inference.

    Returns:
        What was said; None where nobody is asked.

    Raises:
        InputError: The answer cannot be read, or `vlm` is neither off, auto nor an address.
    """
    if answer is not None:
        question = piece_question(given, config)
        return PieceVote(voter=str(answer), question=question, answer=read_answer_file(question, answer))
    oracle = oracle_of(vlm, config.vision)
    if oracle is None:
        return None
    [said] = oracle.ask([question := piece_question(given, config)])
    record = VoterRecord(right=0, asked=0) if said.fault else voter_record(oracle, lambda: known_questions(config))
    return PieceVote(voter=oracle.name, question=question, answer=said, record=record)


def voter_record(oracle: ChatOracle, known: Callable[[], Iterable[KnownQuestion]]) -> VoterRecord:
    """The record of a model, from the user's cache, or else from questions whose right answers are known."""
    kept = read_kept(oracle.record_path)
    if kept is not None and all(isinstance(kept.get(key), int) for key in ("right", "asked")):
        return VoterRecord(right=kept["right"], asked=kept["asked"])
    questions, right, asked = list(known()), 0, 0
    for answer, (question, truth) in zip(oracle.ask([question for question, _ in questions]), questions, strict=True):
        right += right_parts(answer.parts, truth, np.array([part.area for part in question.assembly.parts]))
        asked += max(answer.named, len(truth))
    if oracle.fault:
        return VoterRecord(right=0, asked=0)
    write_kept(oracle.record_path, {"right": right, "asked": asked})
    return VoterRecord(right=right, asked=asked)
