"""The result as a table for people and as JSON for programs."""

from __future__ import annotations

import json
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.evaluation.studies.corruption.cases import KINDS
from kinematify.evaluation.studies.corruption.runner import READY

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.evaluation.studies.corruption.runner import Result

NAME = "validate_robustness"
BAD = ("crash", "hang", "traceback")


def write_tables(results: Sequence[Result], facts: Mapping[str, Any], folder: Path, *, command: str) -> str:
    """Write ``validate_robustness.md`` and ``.json`` and return the former's text."""
    folder.mkdir(parents=True, exist_ok=True)
    text = _markdown(results, facts, command)
    (folder / f"{NAME}.md").write_text(text, encoding="utf-8")
    values = {
        "schema": 1,
        "command": command,
        "environment": {key: value for key, value in facts.items() if key not in ("settings", "interrupted")},
        "totals": dict(Counter(result["outcome"] for result in results)),
        "by_kind": {kind: dict(_outcomes(results, kind)) for kind in KINDS},
        "failures": [result for result in results if result["outcome"] in BAD],
        "stopped_inside": [result for result in results if result.get("unexplained")],
    }
    (folder / f"{NAME}.json").write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    return text


def _outcomes(results: Sequence[Result], kind: str) -> Counter[str]:
    return Counter(result["outcome"] for result in results if result["kind"] == kind)


def _markdown(results: Sequence[Result], facts: Mapping[str, Any], command: str) -> str:
    columns = (*READY, *BAD)
    totals = Counter(result["outcome"] for result in results)
    times = np.array([result["seconds"] for result in results])
    inside = [result for result in results if result.get("unexplained")]
    intro = (
        f"`{command}`: {len(results)} corruptions of valid models. *Passes* and *fails* are reports (exit status 0 and "
        "1, written in every format), *no URDF* is a refusal with a remedy (exit status 2). "
        f"{totals['crash']} crashes, {totals['hang']} hangs, {totals['traceback']} tracebacks."
    )
    pace = (
        f"Time of a run: median {np.median(times):.2f} s, 95 % below {np.percentile(times, 95):.1f} s, longest "
        f"{times.max():.1f} s. In {len(inside)} runs an isolated stage or check gave way, which the report says."
    )
    heading = "| Corruption | cases | " + " | ".join(columns) + " |"
    told_versions = ", ".join(f"{name} {version}" for name, version in facts["versions"].items()) + "."
    lines = ["# Robustness of `kinematify validate`", "", intro, "", pace, "", told_versions, "", heading]
    lines.append("|---|--:|" + "--:|" * len(columns))
    for kind in KINDS:
        counts = _outcomes(results, kind)
        lines.append(f"| {kind} | {counts.total()} | " + " | ".join(str(counts[name]) for name in columns) + " |")
    lines.append(f"| **all** | {totals.total()} | " + " | ".join(str(totals[name]) for name in columns) + " |")
    bad = [result for result in results if result["outcome"] in BAD]
    if bad:
        lines += ["", "## Failures", ""]
        lines += [f"- {r['number']} ({r['kind']}, {r['base']}): {r['outcome']}, {r['message'][-300:]}" for r in bad]
    if inside:
        lines += ["", "## Stages and checks that gave way, isolated", ""]
        reasons = Counter(reason for result in inside for reason in result["unexplained"])
        lines += [f"- {count} times {reason}" for reason, count in reasons.most_common(30)]
    return "\n".join(lines) + "\n"
