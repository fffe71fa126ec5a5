"""What happened in each round, as plain data for `inference.json`, for tables and for people."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True, kw_only=True)
class PlanChange:
    """One decision that was taken again."""

    part: str
    """Whose joint, or whose parent, it is."""
    what: str
    """``parent``, ``type``, ``axis``, ``range``, ``fixed`` or ``contacts``."""
    before: str
    after: str
    why: str
    """The evidence, one sentence."""


@dataclass(frozen=True, kw_only=True)
class Round:
    """One plan with what the simulation said of it."""

    number: int
    """0 is the inference as it was."""
    tier: str
    """``geometry``, ``engines`` or ``task``: how far it was simulated."""
    changes: tuple[PlanChange, ...]
    """What was chosen anew before it was simulated."""
    motion_errors: int
    """By the exact geometry alone, which every tier has."""
    errors: int = 0
    """About motion or the task, by all that it was simulated by."""
    warnings: int = 0
    failed: tuple[str, ...] = ()
    """``CHECK joint`` of every error and warning about motion."""
    blamed: tuple[str, ...] = ()
    """What the feedback blames, one phrase each."""
    score: float = 0.0
    """Sum of the scores of the chosen candidates below the best ones, and of all log odds against them; 0 at best."""
    seconds: float = 0.0
    refused: tuple[str, ...] = ()
    """Changes that would have hidden a failure rather than mended it, with the reason."""


@dataclass(frozen=True, kw_only=True)
class History:
    """All rounds, which one was kept, and why the loop ended."""

    rounds: tuple[Round, ...]
    kept: int
    """Number of the round that was written."""
    ended: str
    """Why there was no further round."""
    tier: str
    seconds: float
    candidates: int
    """Joints that were simulated beside the chosen ones."""

    @property
    def changed(self) -> tuple[PlanChange, ...]:
        """Everything that differs between the inference and the round that was kept."""
        return tuple(change for item in self.rounds[: self.kept + 1] for change in item.changes)

    def as_json(self) -> dict[str, Any]:
        """JSON values."""
        return asdict(self)
