"""KV407, KV410 and their like: did a value become infinite, did anything fly, what did the engine itself say?

They look at all runs of the checks before them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.engines import ENGINES
from kinematify.validation.check import FeedbackRow, engine_check
from kinematify.validation.checks.follow import NOT_A_BODY
from kinematify.validation.checks.needs import late, nothing_moves
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.check import OpenCheck
    from kinematify.validation.engine_context import EngineContext, RunEnd

_TOLD = 10
"""So many messages of an engine are findings, all of them are counted."""


@engine_check(
    "07",
    title="Stable",
    fails="Unstable",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    feedback=FeedbackRow.UNSTABLE,
    follows=NOT_A_BODY,
)
def stable(result: OpenCheck, context: EngineContext) -> None:
    """No value becomes infinite or not a number, and nothing moves faster than engines.explosion times the speed of a
    free fall from the model's height, neither passive nor held nor driven.

    Why it matters: A blow-up ends an episode, and silently resets the state in some engines.

    Remedy: Correct masses and inertias (no link far lighter than what it carries), and overlaps at the start.
    """
    if context.ends:
        find_unstable(result, context.ends, size=context.physics.size, explosion=context.settings.explosion)
    elif reason := nothing_moves(context) or late(context):
        result.skip(reason)
    else:
        result.block("the runs that it looks at did not take place")


@engine_check(
    "10",
    title="The engine warns of nothing",
    fails="The engine warns",
    severity=Severity.WARNING,
    cause=Cause.ENGINE,
    feedback=FeedbackRow.EXPORTER,
    follows=NOT_A_BODY,
)
def no_warnings(result: OpenCheck, context: EngineContext) -> None:
    """Loading and all runs give none of the engine's own warnings; those that say nothing about the model are
    omitted.

    MuJoCo: Its counters are read after each run: bad positions, velocities, accelerations, full contact or constraint
    buffers.

    PyBullet: What it has printed is read.

    Why it matters: Engines warn once in a log that nobody reads and go on with a reset state or dropped contacts.

    Remedy: Each message is given; begin with inertias and overlaps.
    """
    said = context.engine.messages()
    result.measured["warnings"] = float(len(said))
    for text in said[:_TOLD]:
        result.find(
            f"{context.entry.title} says: {text[:300]}",
            "Begin with masses, inertias, overlaps and the names of links and joints.",
            cause=Cause.PHYSICS,
        )


def find_unstable(result: OpenCheck, ends: Sequence[RunEnd], *, size: float, explosion: float) -> None:
    """Add a finding for every run that diverged or in which something flew.

    Args:
        result: Open, of the engine.
        ends: Of all runs.
        size: Of the model [m].
        explosion: Multiple of the speed of a fall by `size`, or of what was commanded, that is no motion any more.
    """
    fall = float(np.sqrt(2.0 * GRAVITY * size))
    result.measured |= {"fastest": max((end.speed for end in ends), default=0.0), "limit": explosion * fall}
    for end in ends:
        limit = explosion * max(fall, end.drive_speed)
        if end.warnings:
            result.find(
                f"{ENGINES[result.engine or ''].title} diverged while {end.when}: {', '.join(end.warnings)}.",
                "Correct masses and inertias, above all of links far lighter than what they carry, and overlaps.",
                joint=end.joint,
            )
        elif end.speed > limit:
            result.find(
                f"A link moves at {end.speed:.3g} m/s while {end.when}; a fall from the height of the model gives "
                f"{fall:.3g} m/s.",
                "Correct masses and inertias, and overlaps at rest.",
                severity=Severity.WARNING,
                joint=end.joint,
                value=end.speed,
                limit=limit,
                unit="m/s",
            )
