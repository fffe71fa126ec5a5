"""What `kinematify infer` left beside a model: the next best joints of every part, and the rounds of refinement."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import DescriptionError
from kinematify.robot.read import read_robot
from kinematify.validation.finding import Blame, Severity
from kinematify.validation.run.outcome import counted_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from kinematify.validation.finding import CheckResult
    from kinematify.validation.summary import JointSummary

RECORD_FILE = "inference.json"
ALTERNATIVES = 3
"""So many are told of each joint."""
_SAME = np.cos(np.radians(1.0))  # directions that nobody tells apart
_NEAR = 1e-3  # lines closer than this fraction of their distance from the origin are one
ROUND_HEADINGS = ("round", "simulated by", "chosen again", "failed", "cause", "score", "time [s]")
"""Of `round_rows`; the round that was kept has a star."""


@dataclass(frozen=True, kw_only=True)
class Inferred:
    """The record of an inference as far as a report shows it."""

    alternatives: Mapping[str, tuple[Mapping[str, Any], ...]] = field(default_factory=dict)
    """Joint -> its next best candidates, best first: ``kind``, ``axis``, ``pivot`` (world frame at zero), ``score``
    below the best [log odds] and ``source``."""
    refinement: Mapping[str, Any] | None = None
    """Rounds of `kinematify refine`, as in `inference.json`."""


def inferred_beside(urdf: Path) -> Inferred | None:
    """Read the record beside a model; None if there is none, or if it is about another or a changed model."""
    path = urdf.parent / RECORD_FILE
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        if record["files"][urdf.name] != hashlib.sha256(urdf.read_bytes()).hexdigest():
            return None
        above = {link: joint.name for link, joint in read_robot(urdf, geometry="none").joint_above.items()}
        alternatives = {
            above[item["child"]]: tuple(_others(item)) for item in record["joints"] if item["child"] in above
        }
        return Inferred(alternatives=alternatives, refinement=record.get("refinement"))
    except (OSError, ValueError, KeyError, TypeError, AttributeError, DescriptionError):
        return None  # whatever lies there is not ours, and the model is judged without it


def with_next_best(
    joints: Iterable[JointSummary], checks: Iterable[CheckResult], inferred: Inferred | None
) -> tuple[JointSummary, ...]:
    """Add the next best candidates to every joint that an error or a warning about motion names."""
    if inferred is None:
        return tuple(joints)
    failed = {
        finding.joint
        for check in checks
        for finding in check.findings
        if finding.blame is Blame.KINEMATICS and finding.severity is not Severity.NOTE and finding.suppressed is None
    }
    return tuple(
        replace(joint, next_best=inferred.alternatives.get(joint.joint, ())) if joint.joint in failed else joint
        for joint in joints
    )


def round_rows(refinement: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """The rounds of a refinement as rows of a table."""
    return [_round_row(item, kept=item["number"] == refinement["kept"]) for item in refinement["rounds"]]


def _round_row(item: Mapping[str, Any], *, kept: bool) -> tuple[str, ...]:
    changes = [f"{it['part']}: {it['what']} {it['before']} -> {it['after']}" for it in item["changes"]]
    return (
        f"{item['number']}{' *' if kept else ''}",
        item["tier"],
        "; ".join(changes) or ("as inferred" if item["number"] == 0 else "-"),
        "; ".join(item["failed"]) or "nothing",
        "; ".join(item["blamed"]) or "-",
        f"{item['score']:.2f}",
        f"{item['seconds']:.1f}",
    )


def round_words(refinement: Mapping[str, Any]) -> list[str]:
    """Which round was kept, why the loop ended, and what was refused, a sentence each."""
    rounds, kept = refinement["rounds"], refinement["kept"]
    if not rounds:
        return ["Nothing was simulated."]
    chosen = next(item for item in rounds if item["number"] == kept)
    left = f"{counted_words(chosen['errors'], 'error')} and {counted_words(chosen['warnings'], 'warning')} about motion"
    what = "the model as it was inferred" if kept == 0 else f"round {kept}"
    refused = [phrase for item in rounds for phrase in item["refused"]]
    cost = f"{refinement['seconds']:.1f} s, {refinement['candidates']} candidates"
    return [
        f"Kept: {what}, with {left}. The loop ended because {refinement['ended']} ({cost}).",
        *(f"Refused, because it would have hidden a failure: {phrase}." for phrase in dict.fromkeys(refused)),
    ]


def _others(item: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Candidates that are not the joint itself, best first."""
    best = max((candidate["score"] for candidate in item["candidates"]), default=0.0)
    found = [candidate for candidate in item["candidates"] if not _is_chosen(item, candidate)]
    found.sort(key=lambda candidate: -float(candidate["score"]))
    return [
        {
            "kind": candidate["type"],
            "axis": [round(number, 6) + 0.0 for number in candidate["axis"]],
            "pivot": [round(number, 6) + 0.0 for number in candidate["pivot"]],
            "score": candidate["score"] - best,
            "source": candidate["source"],
        }
        for candidate in found[:ALTERNATIVES]
    ]


def _is_chosen(item: Mapping[str, Any], candidate: Mapping[str, Any]) -> bool:
    turns = [kind != "prismatic" for kind in (item["type"], candidate["type"])]
    axis, other = np.array(item["axis"]), np.array(candidate["axis"])
    if turns[0] != turns[1] or item["type"] == "fixed" or abs(float(axis @ other)) < _SAME:
        return False
    apart = np.linalg.norm(np.cross(np.array(candidate["pivot"]) - np.array(item["pivot"]), axis))
    return not turns[0] or bool(apart <= _NEAR * max(float(np.linalg.norm(item["pivot"])), 1.0))
