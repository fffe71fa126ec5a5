"""Summary of an inference for people."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus
from kinematify.model.output import MODEL_FILE
from kinematify.robot.joint_type import JointType
from kinematify.robot.lengths import range_text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.assembly.part import Assembly
    from kinematify.errors import KinematifyError
    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.robot import Joint
    from kinematify.validation.run.report import ValidationReport

_RENAMED = 10
"""Changed names that are printed."""


def estimates(inference: Inference) -> dict[str, JointEstimate]:
    """The joint above every part as it was inferred, by the part's name."""
    names = inference.assembly.names
    return {names[estimate.child]: estimate for estimate in inference.joints}


def describe(inference: Inference, out: Path) -> str:
    """Return what was found, as people read it: the joints, what to look at first, and the files."""
    lines = [
        f"Base: {inference.model.root}",
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


def describe_validation(report: ValidationReport | KinematifyError | None, out: Path) -> str:
    """Return the verdict as its last line, after errors, warnings and the file as loaded."""
    again = f"kinematify validate {out}"
    if report is None:
        return f"Not validated (--no-validation): {again} does that."
    if isinstance(report, Exception):
        return f"as loaded: not known. {report}\nNot validated: {again} does that."
    from kinematify.cli.verdict import describe_briefly

    return describe_briefly(replace(report, model=str(out / MODEL_FILE)))


def validation_answer(report: ValidationReport | KinematifyError | None) -> dict[str, Any]:
    """Return the verdict as JSON values; all null where there is none."""
    known = report if report is not None and not isinstance(report, Exception) else None
    errors = () if known is None else (item for item in known.counted if item.severity == "error")
    return {
        "verdict": None if known is None else known.verdict,
        "errors": [f"{item.check}: {item.message}" for item in errors],
        "as_loaded": None if known is None else known.as_loaded or None,
    }


def validation_status(report: ValidationReport | KinematifyError | None) -> int:
    """Return 1 for a model with an error, 3 where an engine failed or time ran out, 130 after an interrupt, else 0."""
    if report is None:
        return 0
    interrupted = not isinstance(report, Exception) and report.interrupted
    return int(ExitStatus.INTERRUPTED if interrupted else report.exit_status)


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
        "validation.html": "every check, with remedies",
    }
    present = [name for name in purposes if (out / name).is_file()]
    return [f"{out / name}: {purposes[name]}" for name in present]
