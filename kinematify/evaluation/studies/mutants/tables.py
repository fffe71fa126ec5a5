"""The result as a table for people and as JSON for programs."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.evaluation.studies.mutants.outcome import Verdict

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.evaluation.studies.mutants.fault import Fault
    from kinematify.evaluation.studies.mutants.outcome import Outcome
    from kinematify.evaluation.studies.mutants.plan import Mutant
    from kinematify.evaluation.studies.mutants.work import Result

NAME = "validate_detection"


@dataclass(frozen=True, kw_only=True)
class Row:
    """One mutant."""

    mutant: Mutant
    fault: Fault
    outcome: Outcome
    seconds: float


def write_tables(rows: Sequence[Row], untouched: Mapping[str, Result], folder: Path, *, command: str) -> str:
    """Write ``validate_detection.md`` and ``.json`` and return the former's text."""
    folder.mkdir(parents=True, exist_ok=True)
    text = _markdown(rows, untouched, command)
    (folder / f"{NAME}.md").write_text(text, encoding="utf-8")
    values = {"schema": 1, "command": command, "untouched": _untouched(untouched), "mutants": [_plain(r) for r in rows]}
    (folder / f"{NAME}.json").write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    return text


def _plain(row: Row) -> dict[str, Any]:
    return {
        "model": row.mutant.model,
        "fault": row.fault.name,
        "joint": row.mutant.planted.joint,
        "links": row.mutant.planted.links,
        "how": row.mutant.planted.how,
        **asdict(row.outcome),
        "seconds": round(row.seconds, 2),
    }


def _untouched(untouched: Mapping[str, Result]) -> dict[str, Any]:
    def of(severity: str) -> dict[str, list[str]]:
        found = {
            name: sorted({fact["check"] for fact in result["findings"] if fact["severity"] == severity})
            for name, result in sorted(untouched.items())
        }
        return {name: checks for name, checks in found.items() if checks}

    return {"models": len(untouched), "errors": of("error"), "warnings": of("warning")}


def _markdown(rows: Sequence[Row], untouched: Mapping[str, Result], command: str) -> str:
    good = _untouched(untouched)
    intro = (
        f"`{command}`: {len(rows)} mutants of {len({row.mutant.model for row in rows})} models, each with one fault. "
        "*Found*: a warning or an error that the untouched model does not have names the joint (or its link) and puts "
        "the right blame. *Elsewhere*: there are new findings, but none of them does."
    )
    alarms = (
        f"Untouched models with errors: {len(good['errors'])} of {good['models']} "
        f"({len(good['errors']) / max(good['models'], 1):.1%}); with warnings: {len(good['warnings'])}."
    )
    halves = (
        "## By half of the objects\n\nThe first half of the objects alone leads to the thresholds of KV34x; the halves "
        "are drawn from the objects' names. Neither half is unseen in the strict sense: the scorers behind KV344 and "
        "KV345 were made with all of the objects in view.\n\n"
    )
    blocks = [
        "# Planted faults that `kinematify validate` finds",
        intro,
        _confusion(rows),
        alarms,
        *_named("Errors of untouched models", good["errors"]),
        *_named("Warnings of untouched models", good["warnings"]),
        _times(rows),
        halves + _halves(rows),
        "## What found them\n\nMutants found by each check (several may find one).\n\n" + _checks(rows),
        "## Not found\n\n" + _misses(rows),
    ]
    return "\n\n".join(block for block in blocks if block) + "\n"


def _times(rows: Sequence[Row]) -> str:
    seconds = [row.seconds for row in rows] or [0.0]
    return f"Time per mutant: median {np.median(seconds):.1f} s, 95 % below {np.percentile(seconds, 95):.1f} s."


def _share(rows: Sequence[Row]) -> str:
    found = sum(row.outcome.verdict is Verdict.FOUND for row in rows)
    return f"{found / len(rows):.1%}" if rows else "-"


def _confusion(rows: Sequence[Row]) -> str:
    lines = ["| fault | planted | found | elsewhere | missed | share found |", "|---|---|---|---|---|---|"]
    for kinematic, title in ((True, "all kinematic faults"), (False, "all file defects")):
        group = [row for row in rows if row.fault.kinematic is kinematic]
        names = list(dict.fromkeys(row.fault.name for row in group))
        lines += [_line(name, [row for row in group if row.fault.name == name]) for name in names]
        lines.append(_line(f"**{title}**", group))
    return "\n".join(lines)


def _line(name: str, rows: Sequence[Row]) -> str:
    counts = Counter(row.outcome.verdict for row in rows)
    numbers = " | ".join(str(counts[verdict]) for verdict in Verdict)
    return f"| {name} | {len(rows)} | {numbers} | {_share(rows)} |"


def _halves(rows: Sequence[Row]) -> str:
    lines = ["| | kinematic faults | file defects |", "|---|---|---|"]
    for half, title in enumerate(("first half", "second half, held out")):
        group = [row for row in rows if half_of(row.mutant.model) == half]
        kinds = [[row for row in group if row.fault.kinematic is kinematic] for kinematic in (True, False)]
        lines.append(f"| {title} | {_share(kinds[0])} of {len(kinds[0])} | {_share(kinds[1])} of {len(kinds[1])} |")
    return "\n".join(lines)


def half_of(model: str) -> int:
    """0 or 1, from the name alone."""
    return sum(model.encode()) % 2


def _checks(rows: Sequence[Row]) -> str:
    names = list(dict.fromkeys(row.fault.name for row in rows))
    lines = []
    for name in names:
        group = [row for row in rows if row.fault.name == name]
        counts = Counter(check for row in group for check in {fact["check"] for fact in row.outcome.right})
        lines.append(f"- {name}: {', '.join(f'{check} {n}' for check, n in counts.most_common(8)) or 'none'}")
    return "\n".join(lines)


def _misses(rows: Sequence[Row]) -> str:
    lines = []
    for row in rows:
        if row.outcome.verdict is Verdict.FOUND:
            continue
        seen = sorted({f"{fact['check']} ({fact['blame']}, {_place(fact)})" for fact in row.outcome.other})
        place = row.mutant.planted.joint or ", ".join(row.mutant.planted.links) or "all links"
        lines.append(f"- {row.fault.name}: {row.mutant.model}, {place}: {row.mutant.planted.how}. "
                     + (f"Instead: {'; '.join(seen[:4])}." if seen else "Nothing new."))  # fmt: skip
    return "\n".join(lines) or "All were found."


def _place(fact: dict[str, Any]) -> str:
    return str(fact["joint"] or fact["link"] or (fact["pair"] and " and ".join(fact["pair"])) or "the model")


def _named(title: str, found: Mapping[str, list[str]]) -> list[str]:
    if not found:
        return []
    return [f"{title}: " + "; ".join(f"{name} ({', '.join(checks)})" for name, checks in found.items()) + "."]
