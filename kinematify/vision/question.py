"""Question about a joint, in words, and what an answer may be."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from kinematify.joints.candidate import JointCandidate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PIL.Image import Image

FIXED, NONE, UNSURE = "fixed", "none of these", "unsure"
TURNS = "turns"
TYPES = (TURNS, "slides")
"""What may be answered where the type alone is asked for (paper section III-D)."""
_LONGEST_REASON = 400  # characters

_SHOWN = (
    "The picture shows one upright object made of rigid parts. The red part is the one in question; "
    "what it carries is pink. The blue part holds it; all other parts are grey{through}. The first row shows the whole "
    "object, with a frame around the red part, and two close views."
)
_MOTIONS = (
    "The numbered pictures below show {count} possible motions of the red part against the blue part. The green line "
    "is the axis: with a ring around it, the part turns about this line; with a head at both ends, it slides along "
    "it. The part in orange is the same part after some of the motion. {list} Only the type of the motion and the "
    "place and direction of the line matter; how far and to which side it moves does not.\n\n"
    "Say first what the object and the red part are. Then choose the motion that the red part has in the real object. "
    "Answer 'fixed' if it does not move against the blue part, 'none of these' if it moves but no picture shows how, "
    "and 'unsure' if the pictures do not allow you to decide."
)
_TYPES = (
    "Say first what the object and the red part are. Then say whether the red part 'turns' against the blue part or "
    "'slides' in the real object. Answer 'fixed' if it does neither, and 'unsure' if the pictures do not allow you to "
    "decide."
)
_FORM = (
    'Answer with one JSON object and nothing else: {{"reason": "one or two sentences", "choice": {choices}, '
    '"confidence": a number from 0 to 1}}.'
)


@dataclass(frozen=True, kw_only=True, eq=False)
class JointQuestion:
    """A joint that somebody is asked about."""

    parent: str
    child: str
    options: tuple[JointCandidate, ...]
    """Motions in the order of their numbers; none where the type alone is asked for."""
    picture: Image
    """The object, close views, and a picture of every option."""
    pixels: int
    """Of the moving part, in the picture of it that shows the fewest."""
    see_through: bool = False
    """Other parts are drawn translucent, since they hide the moving one."""

    @property
    def choices(self) -> tuple[str, ...]:
        """Return what may be answered."""
        if not self.options:
            return (*TYPES, FIXED, UNSURE)
        return (*(str(number + 1) for number in range(len(self.options))), FIXED, NONE, UNSURE)

    @property
    def text(self) -> str:
        """Return what is asked, in words; it names no part."""
        through = ", and shown see-through where they hide the red part" if self.see_through else ""
        said = [f"{number}: {'turns' if item.kind.turns else 'slides'}." for number, item in enumerate(self.options, 1)]
        asked = _MOTIONS.format(count=len(said), list=" ".join(said)) if said else _TYPES
        form = _FORM.format(choices=" | ".join(json.dumps(choice) for choice in self.choices))
        return f"{_SHOWN.format(through=through)} {asked}\n\n{form}"

    def schema(self) -> dict[str, Any]:
        """JSON schema of an answer; the reason comes before the choice."""
        properties = {
            "reason": {"type": "string"},
            "choice": {"type": "string", "enum": list(self.choices)},
            "confidence": {"type": "number", "minimum": 0, "maximum": 1},
        }
        return {
            "type": "object", "properties": properties, "required": list(properties), "additionalProperties": False,
        }  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Answer about one joint."""

    choice: str = UNSURE
    """One of `JointQuestion.choices`."""
    confidence: float = 0.0
    """What the voter says of itself, in [0, 1]; a low one makes the answer count as unsure."""
    reason: str = ""
    fault: str = ""
    """Why there is no usable answer, where there is none; the choice is then `UNSURE`."""
    tokens: int = 0
    """That the service counted for question and answer; 0 where it does not say."""

    @property
    def option(self) -> int | None:
        """Place of the option that was chosen, from 0; None if none was."""
        return int(self.choice) - 1 if self.choice.isdecimal() else None

    def counts(self, least: float) -> bool:
        """True if it is an answer at all, and its voter at least this sure."""
        return self.choice != UNSURE and self.confidence >= least


class JointOracle(Protocol):
    """Somebody who looks at pictures of joints."""

    @property
    def name(self) -> str:
        """For messages and the record."""
        ...

    @property
    def at_once(self) -> int:
        """Questions that are asked together."""
        ...

    def ask(self, questions: Sequence[JointQuestion]) -> list[Answer]:
        """Return the answer to each question, in their order; who has none says why."""
        ...


def read_answer(text: str, choices: Sequence[str], *, tokens: int = 0) -> Answer:
    """Read an answer that may be anything: JSON, JSON inside of other text, or neither.

    Args:
        text: What was answered.
        choices: What may be answered.
        tokens: What it cost.
    """
    found = _object_in(text)
    if found is None:
        return Answer(fault="the answer holds no JSON object", tokens=tokens)
    choice, confidence = found.get("choice"), found.get("confidence", 0.0)
    if isinstance(choice, int) and not isinstance(choice, bool):
        choice = str(choice)
    said = " ".join(str(found.get("reason", "")).split())[:_LONGEST_REASON]
    if not isinstance(choice, str) or choice.strip().lower() not in choices:
        return Answer(reason=said, fault=f"the answer {str(choice)[:40]!r} was not offered", tokens=tokens)
    usable = isinstance(confidence, int | float) and not isinstance(confidence, bool) and 0.0 <= confidence <= 1.0
    return Answer(
        choice=choice.strip().lower(), confidence=float(confidence) if usable else 0.0, reason=said, tokens=tokens
    )


def _object_in(text: str) -> dict[str, Any] | None:
    """The last JSON object with a choice that a text holds."""
    decoder, start, found = json.JSONDecoder(), text.find("{"), None
    while start >= 0:
        try:
            value, end = decoder.raw_decode(text, start)
        except (ValueError, RecursionError):
            end = start + 1
        else:
            if isinstance(value, dict) and (found is None or "choice" in value):
                found = value
        start = text.find("{", end)
    return found
