"""Are the joints at rest the same as another version inferred?

Every object is inferred from its parts at rest and compared, joint by joint, with what an earlier run of this study
recorded. Without one to compare with, the joints are only recorded.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field

from benchmarks.study import RECORDS, Options, Study, explained
from kinematify.evaluation.datasets import CONDITIONS, DEFAULT_SETS, BenchObject, find_objects
from kinematify.evaluation.job import erased_item, shown_parts
from kinematify.evaluation.record import load_report, table
from kinematify.pipeline import infer

if TYPE_CHECKING:
    from collections.abc import Iterator

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.record import Report
    from kinematify.joints.candidate import JointEstimate

_REST = CONDITIONS[0]
_VECTORS, _NUMBERS = ("axis", "pivot"), ("lower", "upper", "confidence")


class SameJointsOptions(Options):
    """What is compared."""

    data: tuple[str, ...] = Field(DEFAULT_SETS, description="Sets or folders of objects, separated by commas.")
    against: Path | None = Field(None, description="JSON that an earlier run of this study wrote.")
    tolerance: float = Field(1e-9, ge=0.0, description="Largest difference of a number [m, rad or 1].")


def measure(options: SameJointsOptions, work: Work) -> Measured:
    """Infer every object and compare."""
    before = None if options.against is None else load_report(options.against, RECORDS).records
    objects = {item.name: item for data in options.data for item in find_objects(data)}
    records = list(work.each(joints_at_rest, objects, timeout=900.0).values())
    if before is None:
        return records, {"compared": 0, "differences": {}}
    recorded = {record["object"]: record["joints"] for record in before}
    found = {record["object"]: record["joints"] for record in records}
    common = sorted(recorded.keys() & found.keys())
    told = {name: list(differences(recorded[name], found[name], options.tolerance)) for name in common}
    missing = {name: ["there is no answer"] for name in work.failures if name in recorded}
    return records, {
        "compared": len(common) + len(missing),
        "joints": sum(len(recorded[name]) for name in common),
        "differences": {**{name: lines for name, lines in told.items() if lines}, **missing},
    }


def joints_at_rest(item: BenchObject) -> Record:
    """Infer one object and return its joints, unlimited ends as None."""
    inference = infer(shown_parts(erased_item(item, _REST)))
    names = inference.assembly.names
    return {"object": item.name, "joints": [_plain(joint, names) for joint in inference.joints]}


def _plain(joint: JointEstimate, names: tuple[str, ...]) -> Record:
    return {
        "parent": names[joint.parent],
        "child": names[joint.child],
        "kind": str(joint.kind),
        **{name: [round(float(value), 9) for value in getattr(joint, name)] for name in _VECTORS},
        "lower": float(joint.lower) if math.isfinite(joint.lower) else None,
        "upper": float(joint.upper) if math.isfinite(joint.upper) else None,
        "confidence": round(float(joint.confidence), 9),
    }


def differences(before: list[Record], now: list[Record], tolerance: float) -> Iterator[str]:
    """Yield a sentence for every joint that is not the same, joints told apart by their child.

    Args:
        before: Joints of one object.
        now: Those of another version.
        tolerance: Largest difference of a number.
    """
    old, new = ({joint["child"]: joint for joint in joints} for joints in (before, now))
    for child in sorted(old.keys() | new.keys()):
        if child not in old or child not in new:
            yield f"{child} {'has a joint now' if child in new else 'has no joint any more'}"
            continue
        changes = list(_changes(old[child], new[child], tolerance))
        if changes:
            yield f"{child}: {'; '.join(changes)}"


def _changes(old: Record, new: Record, tolerance: float) -> Iterator[str]:
    for name in ("parent", "kind"):
        if old[name] != new[name]:
            yield f"{name} {old[name]} -> {new[name]}"
    for name in (*_VECTORS, *_NUMBERS):
        a, b = old[name], new[name]
        # More than the tolerance, and the half digit that rounding can add.
        same = a == b if a is None or b is None else np.allclose(a, b, rtol=0.0, atol=tolerance + 1e-9)
        if not same:
            yield f"{name} {a} -> {b}"


def report(found: Report[Record]) -> list[str]:
    """What differs, object by object."""
    told = faults(found)
    joints = sum(len(record["joints"]) for record in found.records)
    rows = [(name, line) for name, lines in found.summary["differences"].items() for line in lines]
    return [
        explained(__doc__),
        f"{len(found.records)} objects, {joints} joints; {found.summary['compared']} objects compared.",
        table(("object", "difference"), rows) if told else "No joint differs." if found.summary["compared"] else "",
    ]


def faults(found: Report[Record]) -> list[str]:
    """Every difference."""
    return [f"{name}: {line}" for name, lines in found.summary["differences"].items() for line in lines]


STUDY = Study(
    title="The joints of two versions", options=SameJointsOptions, measure=measure, report=report, faults=faults
)
