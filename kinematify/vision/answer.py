"""What is asked of a joint, and what an answer may be: abstention is always allowed, anything else is not an answer."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PIL.Image import Image

ABSTAINED = "unsure"


class Direction(StrEnum):
    """Of an axis, as somebody in front of the object sees it."""

    VERTICAL = "vertical"
    SIDEWAYS = "sideways"
    DEPTH = "depth"


class HingeSide(StrEnum):
    """Of a part on which it is hinged, as somebody in front of the object sees it."""

    LEFT = "left"
    RIGHT = "right"
    TOP = "top"
    BOTTOM = "bottom"
    FRONT = "front"
    BACK = "back"
    MIDDLE = "middle"


TYPES = ("fixed", "revolute", "continuous", "prismatic")


@dataclass(frozen=True, kw_only=True)
class Vote:
    """One opinion on one question."""

    choice: str
    confidence: float
    """In [0, 1]."""


@dataclass(frozen=True, kw_only=True)
class JointVotes:
    """All opinions on one joint; None where there is none."""

    kind: Vote | None = None
    direction: Vote | None = None
    side: Vote | None = None
    name: str = ""
    """What the moving part is called; not used to decide anything."""
    note: str = ""
    """Why there is no opinion, where there is none."""


@dataclass(frozen=True, kw_only=True, eq=False)
class JointQuestion:
    """A joint that somebody is asked about."""

    parent: str
    child: str
    picture: Image
    """Four views, the moving part in red, what it hangs on in blue."""


class JointOracle(Protocol):
    """Somebody who looks at pictures of joints."""

    def ask(self, questions: Sequence[JointQuestion]) -> list[JointVotes]:
        """Return the opinion on each joint, in their order; who has none says so."""
        ...


def schema() -> dict[str, Any]:
    """JSON schema of an answer."""

    def question(choices: Sequence[str]) -> dict[str, Any]:
        return {
            "type": "object",
            "properties": {
                "choice": {"type": "string", "enum": [*choices, ABSTAINED]},
                "confidence": {"type": "number", "minimum": 0, "maximum": 1},
            },
            "required": ["choice", "confidence"],
            "additionalProperties": False,
        }

    properties = {
        "name": {"type": "string"},
        "type": question(TYPES),
        "axis_direction": question([item.value for item in Direction]),
        "hinge_side": question([item.value for item in HingeSide]),
    }
    return {
        "type": "object", "properties": properties, "required": list(properties), "additionalProperties": False,
    }  # fmt: skip


def read_answer(answer: Any, least: float) -> JointVotes:
    """Read an answer that may be anything.

    Args:
        answer: JSON values.
        least: Less sure answers count as abstentions.
    """
    if not isinstance(answer, dict):
        return JointVotes(note="the answer is no JSON object")
    found = JointVotes(
        kind=_vote(answer.get("type"), TYPES, least),
        direction=_vote(answer.get("axis_direction"), [item.value for item in Direction], least),
        side=_vote(answer.get("hinge_side"), [item.value for item in HingeSide], least),
        name=str(answer.get("name", ""))[:80],
    )
    if found.kind is found.direction is found.side is None:
        return JointVotes(name=found.name, note="it abstains")
    return found


def _vote(given: Any, choices: Sequence[str], least: float) -> Vote | None:
    if not isinstance(given, dict):
        return None
    choice, confidence = given.get("choice"), given.get("confidence")
    if not isinstance(choice, str) or choice not in choices:
        return None
    if not isinstance(confidence, int | float) or isinstance(confidence, bool) or not least <= confidence <= 1.0:
        return None
    return Vote(choice=choice, confidence=float(confidence))
