"""Does the answer depend on unit, heading, order or names?

Every object is inferred as it is, at a thousandth and at a thousand times its size, turned about the vertical, and with
its parts in another order under other names. Base, parents, types, axes, directions and limits are compared, in the
frame and unit of the object as it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field

from benchmarks.study import Options, Study, explained
from kinematify.assembly.part import Assembly
from kinematify.config import load_config
from kinematify.evaluation.benchmark_job import erased_item, shown_parts
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, bench_folder, find_objects
from kinematify.evaluation.result_record import table
from kinematify.pipeline.infer_assembly import infer
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report
    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.arrays import FloatArray, IntArray

ANGLE, LINE, LIMIT = 1.0, 0.01, 0.05
"""Up to these, two joints are the same: degrees between axes, distance of lines in diagonals of the object, and
difference of a limit as a share of the range."""
ASPECTS = ("base", "parent", "type", "axis", "line", "direction", "limits")


class InvarianceOptions(Options):
    """Which objects."""

    sets: tuple[str, ...] = Field(
        ("everyday", "everyday2", "articraft", "infinigen"), description="Sets of the benchmark, separated by commas."
    )
    count: int = Field(10, ge=1, description="Objects of each set, spread evenly over it.")
    yaw_deg: float = Field(37.0, description="Turn about the vertical.")


@dataclass(frozen=True, kw_only=True)
class Asked:
    """One object."""

    item: BenchObject
    yaw_deg: float


@dataclass(frozen=True, kw_only=True)
class Change:
    """The same object given in another way; x -> scale * turn x."""

    scale: float = 1.0
    yaw_deg: float = 0.0
    shuffled: bool = False

    @property
    def turn(self) -> FloatArray:
        """About the vertical, shape (3, 3)."""
        c, s = np.cos(np.radians(self.yaw_deg)), np.sin(np.radians(self.yaw_deg))
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    def order(self, parts: int) -> IntArray:
        """Which part of the original each new part is, shape (parts,)."""
        return np.random.default_rng(0).permutation(parts) if self.shuffled else np.arange(parts)

    def applied(self, assembly: Assembly) -> Assembly:
        """The object, given so."""
        parts = []
        for number, k in enumerate(self.order(len(assembly.parts)).tolist()):
            part = assembly.parts[k]
            name = f"item_{number}" if self.shuffled else part.name
            parts.append(replace(part, name=name, vertices=self.scale * part.vertices @ self.turn.T))
        return Assembly(parts=tuple(parts), source=assembly.source)


def changes(yaw_deg: float) -> dict[str, Change]:
    """What is done to an object, by name."""
    return {
        "1/1000": Change(scale=1e-3),
        "1000": Change(scale=1e3),
        "turned": Change(yaw_deg=yaw_deg),
        "permuted and renamed": Change(shuffled=True),
    }


def measure(options: InvarianceOptions, work: Work) -> Measured:
    """Infer every object in all ways."""
    asked: dict[str, Asked] = {}
    for name in options.sets:
        items = find_objects(bench_folder() / name)
        for k in np.unique(np.linspace(0, len(items) - 1, min(options.count, len(items))).round().astype(int)):
            asked[f"{name}/{items[k].name}"] = Asked(item=items[k], yaw_deg=options.yaw_deg)
    records = list(work.each(compared, asked).values())
    return records, {}


def compared(asked: Asked) -> Record:
    """What differs of one object."""
    assembly = shown_parts(erased_item(asked.item, CONDITIONS[0]))
    differences = differences_of(assembly, changes(asked.yaw_deg))
    return {
        "object": asked.item.name,
        "joints": len(assembly.parts) - 1,
        "differences": differences,
    }


def differences_of(assembly: Assembly, given: Mapping[str, Change]) -> dict[str, list[str]]:
    """What differs from the object as it is, one sentence each, by change."""
    config = load_config()
    reference = infer(assembly, config=config)
    return {
        name: differing(reference, infer(change.applied(assembly), config=config), change)
        for name, change in given.items()
    }


def differing(reference: Inference, other: Inference, change: Change) -> list[str]:
    """Which aspects of which joints differ, as ``aspect part: before, after``."""
    order = change.order(len(reference.assembly.parts)).tolist()
    names = reference.assembly.names
    there = {order[joint.child]: _brought_back(joint, change, order) for joint in other.joints}
    found = []
    bases = names[reference.trees[0].root], names[order[other.trees[0].root]]
    if bases[0] != bases[1]:
        found.append(f"base: {bases[0]}, {bases[1]}")
    for joint in reference.joints:
        if joint.child not in there:
            continue
        aspect = _aspect(joint, there[joint.child], reference.assembly.diagonal)
        if aspect is not None:
            found.append(f"{aspect[0]} {names[joint.child]}: {aspect[1]}")
    return found


def _brought_back(joint: JointEstimate, change: Change, order: Sequence[int]) -> JointEstimate:
    length = 1.0 if joint.kind.turns else 1.0 / change.scale
    return replace(
        joint,
        parent=order[joint.parent],
        child=order[joint.child],
        axis=joint.axis @ change.turn,
        pivot=joint.pivot @ change.turn / change.scale,
        lower=length * joint.lower,
        upper=length * joint.upper,
    )


def _aspect(one: JointEstimate, other: JointEstimate, diagonal: float) -> tuple[str, str] | None:
    """The first aspect in which two joints of one part differ, and how; None where they are the same."""
    cosine = float(one.axis @ other.axis)
    angle = float(np.degrees(np.arccos(np.clip(abs(cosine), 0.0, 1.0))))
    apart = float(np.linalg.norm(np.cross(one.pivot - other.pivot, one.axis))) / diagonal
    width = one.upper - one.lower
    moved = max(abs(one.lower - other.lower), abs(one.upper - other.upper)) if np.isfinite(width) else 0.0
    moves = one.kind is not JointType.FIXED
    limits = f"{one.lower:.4g}..{one.upper:.4g}, {other.lower:.4g}..{other.upper:.4g}"
    found = (
        ("parent", one.parent != other.parent, f"{one.parent}, {other.parent}"),
        ("type", one.kind is not other.kind, f"{one.kind}, {other.kind}"),
        ("axis", moves and angle > ANGLE, f"{angle:.1f} deg"),
        ("line", one.kind.turns and apart > LINE, f"{apart:.2%} of the diagonal"),
        ("direction", moves and cosine < 0.0, "opposite"),
        ("limits", moves and moved > LIMIT * width, limits),
    )
    return next(((name, said) for name, differs, said in found if differs), None)


def report(found: Report[Record]) -> list[str]:
    """How many objects and joints differ under each change, and each difference."""
    joints = sum(record["joints"] for record in found.records)
    rows = []
    for name in found.records[0]["differences"]:
        said = [text for record in found.records for text in record["differences"][name]]
        same = sum(not record["differences"][name] for record in found.records)
        counts = [sum(text.startswith(aspect) for text in said) for aspect in ASPECTS]
        rows.append((name, f"{same} of {len(found.records)}", *map(str, counts)))
    lines = [
        f"- {record['object']}, {name}: {'; '.join(said)}"
        for record in found.records
        for name, said in record["differences"].items()
        if said
    ]
    return [
        explained(__doc__),
        (
            f"{len(found.records)} objects with {joints} joints. Two joints are the same up to {ANGLE:g} deg, "
            f"{LINE:.0%} of the diagonal and {LIMIT:.0%} of the range."
        ),
        table(("change", "objects that stay the same", *(f"{aspect} differs" for aspect in ASPECTS)), rows),
        *(["## What differs", "\n".join(lines)] if lines else []),
    ]


STUDY = Study(
    title="Invariance to unit, heading, order and names", options=InvarianceOptions, measure=measure, report=report
)
