"""The lines of a report on the untouched file in engines (KV8xx), and on the contract for objects."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES
from kinematify.validation.finding import Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.finding import CheckResult, Finding

_Z = 1.96
"""Of an interval of 95 %."""
_OPENS, _MOVES = "KV801", "KV804"
CONTRACT = "KV82"
"""Begin of the ids of the contract for objects."""


def as_loaded_words(checks: Sequence[CheckResult[Finding]]) -> str:
    """Return how many joints move in the untouched file, by engine; empty if no engine was asked.

    A joint moves if a hand moves it over its free range and nothing throws it, e.g.
    ``as loaded: MuJoCo 5 of 5 joints move, PyBullet 5 of 5``. Every engine has its defaults; a second line names the
    flag of an engine with which fewer move.
    """
    opened = {check.engine: check for check in checks if check.check == _OPENS and check.engine is not None}
    moved = {check.engine: check for check in checks if check.check == _MOVES}
    parts = []
    for engine, opening in opened.items():
        title, found = ENGINES[engine].title, moved.get(engine)
        if "joints" not in opening.measured and opening.findings:
            parts.append(f"{title} does not open the file")
        elif found is not None and "right" in found.measured:
            joints = "" if parts and "joints move" in parts[0] else " joints move"
            parts.append(f"{title} {found.measured['right']:.0f} of {found.measured['joints']:.0f}{joints}")
        elif not ENGINES[engine].runs and "read" in opening.measured:
            parts.append(f"{title} reads {opening.measured['read']:.0f} of {opening.measured['joints']:.0f}")
        elif engine in DEFAULT_ENGINES:
            why = opening.reason or (found.reason if found is not None else None)
            parts.append(f"{title}: {why or 'its joints were not moved'}")
    absent = [f"{ENGINES[name].title} is not installed" for name in opened if name not in DEFAULT_ENGINES]
    words = [f"as loaded: {', '.join([*parts, *absent])}"] if parts else []
    for name, found in moved.items():
        entry = ENGINES[name or ""]
        if entry.contact_flag and found.measured.get("with_contacts", math.inf) < found.measured.get("right", 0.0):
            counted = f"{found.measured['with_contacts']:.0f} of {found.measured['joints']:.0f}"
            words.append(f"with {entry.contact_flag}: {entry.title} {counted}")
    return "\n".join(words)


def contract_words(reports: Sequence[Sequence[CheckResult[Finding]]]) -> str:
    """Return how many of some models keep the contract, with Wilson's interval of 95 %; empty if it was not asked for.

    Args:
        reports: All results of each model.
    """
    asked = [{check.status for check in checks if check.check.startswith(CONTRACT)} for checks in reports]
    order = {Status.FAIL: "failed", Status.BLOCKED: "blocked", Status.PASS: "kept", Status.SKIPPED: "not applicable"}
    states = [next(name for status, name in order.items() if status in found) for found in asked if found]
    if not states:
        return ""
    if len(states) == 1:
        return f"contract: {states[0]}"
    kept, count = states.count("kept"), states.count("kept") + states.count("failed")
    others = ", ".join(f"{name} {states.count(name)}" for name in ("blocked", "not applicable"))
    share, part = kept / max(count, 1), _Z**2 / max(count, 1)
    spread = math.sqrt(part * share * (1.0 - share) + part**2 / 4.0)
    low, high = ((share + part / 2.0 + sign * spread) / (1.0 + part) for sign in (-1, 1))
    return f"contract: kept by {kept} of {count} ({share:.0%}, 95 % interval {low:.0%} to {high:.0%}); {others}"
