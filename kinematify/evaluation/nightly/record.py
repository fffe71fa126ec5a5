"""One run of a night, the unit of the history: an object inferred in one pose, or one of its models validated."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from pydantic import TypeAdapter

SCHEMA = 1
"""Number of the layout of `night.json` and `runs.jsonl`; raised when a reader of the old one would go wrong."""

What = Literal["accuracy", "validation"]
RunKey = tuple[str, str, str]
"""Object, what, case: the same in every night."""


@dataclass(frozen=True, kw_only=True)
class Problem:
    """One thing that is wrong; known again in another night by its id."""

    id: str
    """Check or aspect, then the place, e.g. ``KV312 [mujoco] hinge_1`` or ``axis hinge_1``."""
    check: str
    """Key of the check (``KV312``, ``KV405 [mujoco]``) or aspect of a joint (``axis``) that it belongs to."""
    severity: Literal["error", "warning"]
    text: str
    """A sentence with the numbers, which may change from night to night."""


@dataclass(frozen=True, kw_only=True)
class Run:
    """What came of one run."""

    scenario: str
    """Hash of all that makes two runs comparable: input, pose, thresholds, but not the code under test."""
    object: str
    kind: str
    category: str
    what: What
    case: str
    """Condition of the benchmark, or ``truth``, ``inferred`` or ``pulled``."""
    status: str
    """``ok``, ``error``, ``timeout``, ``crash``, ``unreadable``; of a validation its verdict, if it came to one."""
    message: str = ""
    """Why there is no answer; empty if there is one."""
    seconds: float = 0.0
    """Wall time [s]."""
    values: dict[str, float | None] = field(default_factory=dict)
    """Metrics of the benchmark, or counts of findings and checks."""
    problems: tuple[Problem, ...] = ()
    not_run: dict[str, str] = field(default_factory=dict)
    """Check -> why it was skipped or blocked, with that word in front."""
    families: dict[str, str] = field(default_factory=dict)
    """Family of checks -> ``pass``, ``warn``, ``fail``, ``skipped`` or ``blocked``, the worst of its checks."""

    @property
    def place(self) -> RunKey:
        """What it is a run of."""
        return self.object, self.what, self.case

    @property
    def answered(self) -> bool:
        """False where nothing can be said of it: the truth is unreadable, or the validator itself fell over."""
        return self.status not in ("unreadable", "unusable") and not (
            self.what == "validation" and self.status in ("error", "timeout", "crash")
        )


RUN = TypeAdapter(Run)
