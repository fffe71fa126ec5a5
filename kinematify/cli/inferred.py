"""Summary of an inference for people."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.cli.table import format_table
from kinematify.robot.joint_type import JointType
from kinematify.robot.lengths import length_text, range_text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.assembly.part import Assembly
    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.robot import Joint

_RENAMED = 10
"""Changed names that are printed."""


def estimates(inference: Inference) -> dict[str, JointEstimate]:
    """The joint above every part as it was inferred, by the part's name."""
    names = inference.assembly.names
    return {names[estimate.child]: estimate for estimate in inference.joints}


def describe(inference: Inference, out: Path) -> str:
    """Return what was found, as people read it: the joints, what to look at first, and the files."""
    bounds = inference.assembly.bounds
    size = " x ".join(length_text(float(side)) for side in bounds[1] - bounds[0])
    lines = [
        f"Base: {inference.model.root}",
        f"Lengths: read in {inference.assembly.lengths}; the object is {size} (x, y, z)",
        "",
        describe_joints(inference.model.joints, estimates(inference)),
        "",
        *_describe_doubts(inference),
        *describe_files(out),
    ]
    return "\n".join(lines)


def renamed(assembly: Assembly) -> dict[str, str]:
    """Parts that got another name than in the input, which maps to that."""
    return {new: old for new, old in assembly.original_names.items() if new != old and new in assembly.names}


def describe_joints(joints: Sequence[Joint], inferred: Mapping[str, JointEstimate] | None = None) -> str:
    """A table of joints; with confidence and what ends the ranges if they were inferred, by child link."""
    headings = ("joint", "type", "parent -> child", "range")
    rows = [(joint.name, joint.kind.value, f"{joint.parent} -> {joint.child}", _range(joint)) for joint in joints]
    if inferred is None:
        return format_table(headings, rows)
    found = [inferred[joint.child] for joint in joints]
    ended = ["; ".join(dict.fromkeys(filter(None, item.stops))) for item in found]
    sure = [(*rows[k], f"{item.confidence:.0%}", ended[k]) for k, item in enumerate(found)]
    return format_table((*headings, "confidence", "ended by"), sure)


def as_loaded(urdf: Path) -> str:
    """Return how many joints move in the written file by engine, measured; empty if no engine could be asked."""
    from kinematify.validation.run import validate

    return validate(urdf, selected=_as_loaded_checks()).as_loaded


def load_as_loaded() -> None:
    """Load what `as_loaded` needs, in a process that is asked for it later."""
    from kinematify.simulation.engines import DEFAULT_ENGINES
    from kinematify.validation.isolation import load_imports
    from kinematify.validation.run.plan import as_loaded_stages, asset_stage, later_stages, needed

    later = needed(later_stages(), _as_loaded_checks())
    load_imports([asset_stage(), *later, *as_loaded_stages(DEFAULT_ENGINES)])


def _as_loaded_checks() -> set[str]:
    from kinematify.validation.checks import checks_of

    free_travel = "KV310"  # its stage measures how far every joint is free
    return {free_travel, *(check.id for check in checks_of("KV8"))}


def _range(joint: Joint) -> str:
    if joint.kind is JointType.FIXED:
        return "-"
    if not math.isfinite(joint.upper - joint.lower):
        return "unlimited"
    if joint.kind.turns:
        return f"{math.degrees(joint.lower):z.0f} to {math.degrees(joint.upper):.0f} deg"
    return range_text(joint.lower, joint.upper)


def _describe_doubts(inference: Inference) -> list[str]:
    """Return what the user should look at, one line each, and an empty line if there is any."""
    joint_of = {joint.child: joint.name for joint in inference.model.joints}
    doubtful = [joint_of[part] for part in inference.doubtful]
    lines = [f"Set aside: {item.part.name} ({item.reason})" for item in inference.assembly.set_aside]
    changed = renamed(inference.assembly)
    if changed:
        said = ", ".join(f"{old!r} to {new}" for new, old in list(changed.items())[:_RENAMED])
        more = f" and {len(changed) - _RENAMED} more (--json lists all)" if len(changed) > _RENAMED else ""
        lines.append(f"Renamed for simulators: {said}{more}.")
    lines += [f"Note: {warning}" for warning in inference.warnings]
    lines += [f"Closed chain: {chain.description}" for chain in inference.closed_chains]
    if doubtful:
        names = ", ".join(doubtful)
        count = f"{len(doubtful)} joint{'s' if len(doubtful) > 1 else ''} to look at"
        from kinematify.pipeline.inference import DOUBTFUL

        below = f"less than {DOUBTFUL:.0%} sure, the least sure first"
        lines.append(f"{count}, {below}: {names}. Give what you know with --hint.")
    return [*lines, ""] if lines else []


def describe_files(out: Path) -> list[str]:
    """The files of a model folder that are there, a line each."""
    purposes = {
        "model.urdf": "what a simulator loads, with meshes/ beside it",
        "inference.json": "every alternative with its evidence, seed and timings",
        "groups.json": "the pieces of every part, to be corrected and given with --groups",
        "preview.png": "the object as given, and with every joint moved",
    }
    present = [name for name in purposes if (out / name).is_file()]
    return [f"{out / name}: {purposes[name]}" for name in present]
