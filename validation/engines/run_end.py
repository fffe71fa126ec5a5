"""How runs ended, whatever the engine: did a value become infinite, did anything fly?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.engines.configurations import GRAVITY
from kinematify.validation.engines.loading import ENGINE_TITLES
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.stage import OpenCheck


@dataclass(frozen=True, kw_only=True)
class RunEnd:
    """How a run went on the whole."""

    when: str
    """As words that follow "while"."""
    speed: float
    """The largest of a link [m/s]."""
    warnings: tuple[str, ...]
    """Those of the engine that ended it; empty if it went on to the end."""
    joint: str | None = None
    """The one that was driven."""
    told: float = 0.0
    """The largest speed that it was commanded to give a link [m/s]."""


def find_unstable(check: OpenCheck, ends: Sequence[RunEnd], *, size: float, explosion: float) -> None:
    """Add a finding for every run that diverged or in which something flew.

    Args:
        check: Open, of the engine.
        ends: Of all runs.
        size: Of the model [m].
        explosion: Multiple of the speed of a fall by `size`, or of what was commanded, that is no motion any more.
    """
    fall = float(np.sqrt(2.0 * GRAVITY * size))
    check.measured |= {"fastest": max((end.speed for end in ends), default=0.0), "limit": explosion * fall}
    for end in ends:
        limit = explosion * max(fall, end.told)
        if end.warnings:
            check.find(
                f"{ENGINE_TITLES[check.engine or '']} diverged while {end.when}: {', '.join(end.warnings)}.",
                "Correct masses and inertias, above all of links far lighter than what they carry, and overlaps.",
                joint=end.joint,
            )
        elif end.speed > limit:
            check.find(
                f"A link moves at {end.speed:.3g} m/s while {end.when}; a fall from the height of the model gives "
                f"{fall:.3g} m/s.",
                "Correct masses and inertias, and overlaps at rest.",
                severity=Severity.WARNING,
                joint=end.joint,
                value=end.speed,
                limit=limit,
                unit="m/s",
            )
