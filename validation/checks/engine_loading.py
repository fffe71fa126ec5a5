"""KV401, KV402, KV601, KV606 and their like: an engine has what the file says, and every link where it belongs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.simulation.configurations import link_poses
from kinematify.simulation.engine import Refused
from kinematify.simulation.engines import ENGINES
from kinematify.validation.check import CauseScope, FeedbackRow, check, engine_check
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint, Robot
    from kinematify.simulation.engine import LoadedJoint, LoadedRobot
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.engine_context import EngineContext

_LIMIT_SLACK = 1e-6
"""Difference of a limit [rad or m] that no decimal number in a file explains."""


@engine_check(
    "01",
    title="Loads with the same joints, masses and limits",
    fails="Joints, masses or limits change on loading",
    severity=Severity.ERROR,
    cause=Cause.ENGINE,
    feedback=FeedbackRow.EXPORTER,
    follows={"KV221": CauseScope.JOINT, "KV202": CauseScope.BODY},
)
def loads(result: OpenCheck, context: EngineContext) -> None:
    """{engine} loads the model; every link and joint is there, with the type, axis, limits, mass and inertia of the
    file, within engines.same of each value.

    MuJoCo: Links joined by fixed joints are kept apart.

    Why it matters: Importers drop, merge and replace silently: a lost limit or a mass of 1 kg out of nothing changes
    every simulation.

    Remedy: Fix what the engine's message names; write limits, masses and inertias in full.
    """
    _load(result, context)


@check(
    "KV606",
    title="Pinocchio loads the same model",
    fails="Pinocchio loads another model",
    severity=Severity.ERROR,
    cause=Cause.ENGINE,
    engines=("pinocchio",),
    follows={"KV221": CauseScope.JOINT, "KV202": CauseScope.BODY},
)
def pinocchio_loads(result: OpenCheck, context: EngineContext) -> None:
    """Pinocchio reads the file and has the same moving joints with the same types and limits, and the same masses.

    Why it matters: It is the analytical reference for the engines, and what many planners and controllers use.

    Remedy: Write the joint or link that is named with plain decimal numbers and a unique name.
    """
    _load(result, context)


def _load(result: OpenCheck, context: EngineContext) -> None:
    title, same = context.entry.title, context.settings.same
    try:
        loaded = context.model.loaded
    except Refused as refusal:
        result.find(
            f"{title} refuses the model: {refusal}.",
            f"Fix what {title}'s message names, and the other findings of the file.",
        )
        return
    compare_with_file(result, context.declared, context.prepared, loaded, same)
    _compare_axes(result, context, loaded, same)
    if loaded.balanced:
        result.find(
            f"{title} refuses an inertia tensor whose largest principal moment exceeds the sum of the others, even "
            "by a rounding error; all tensors were balanced for the other checks.",
            "Write the tensors with more digits, or make the largest moment a little smaller.",
            severity=Severity.WARNING,
            cause=Cause.PHYSICS,
        )


def _compare_axes(result: OpenCheck, context: EngineContext, loaded: LoadedRobot, same: float) -> None:
    for name, joint in loaded.joints.items():
        declared = context.declared.joint_by_name[name].axis
        if joint.axis is not None and np.abs(joint.axis - declared).max() > same:
            result.find(
                f"The axis of the joint {name} is {_vector(declared)} in the file and {_vector(joint.axis)} in "
                f"{context.entry.title}.",
                "Write the axis as a unit vector with plain decimal numbers.",
                joint=name,
                value=np.abs(joint.axis - declared).max(),
                limit=same,
            )


def _vector(values: FloatArray) -> str:
    return "(" + ", ".join(f"{value:.6g}" for value in values) + ")"


def compare_with_file(
    result: OpenCheck, model: Robot, prepared: Prepared, loaded: LoadedRobot, mass_error: float
) -> None:
    """Add a finding for every joint or mass that an engine has otherwise than it was given.

    Args:
        result: Open, of the engine.
        model: The file, with or without geometry.
        prepared: What the engine was given.
        loaded: What it made of it.
        mass_error: Relative difference that is an error.
    """
    engine = ENGINES[result.engine or ""].title
    for described in model.joints:
        if described.kind != "fixed":
            _compare_joint(result, engine, described, loaded.joints.get(described.name))
    for link in prepared.links:
        mass = loaded.masses.get(link.link, link.mass)
        if not link.mass_added and not np.isclose(mass, link.mass, rtol=mass_error, atol=1e-9):
            result.find(
                f"{engine} gives the link {link.link} {mass:.6g} kg; the file says {link.mass:.6g} kg.",
                "Write mass and inertia in an <inertial> element with plain decimal numbers.",
                link=link.link,
                value=mass,
                limit=link.mass,
                unit="kg",
                line=model.link_by_name[link.link].line,
            )
    result.measured["joints"] = float(len(loaded.joints))
    result.measured["mass"] = loaded.total_mass
    if not result.findings and not np.isclose(loaded.total_mass, prepared.total_mass, rtol=mass_error):
        result.find(
            f"The model weighs {loaded.total_mass:.6g} kg in {engine}; its links weigh {prepared.total_mass:.6g} kg in "
            "the file.",
            "Give every link a mass of its own; an engine has dropped or made up one.",
            value=loaded.total_mass,
            limit=prepared.total_mass,
            unit="kg",
        )


def _compare_joint(result: OpenCheck, engine: str, joint: Joint, loaded: LoadedJoint | None) -> None:
    said = _difference(engine, joint, loaded)
    if said:
        result.find(
            said,
            f"Write the joint {joint.name} with a type, axis and limits that {engine} reads as they are meant.",
            # Importers take an empty range for none; the checks of limits report that the range is empty.
            severity=Severity.WARNING if joint.lower >= joint.upper else None,
            joint=joint.name,
        )


def _difference(engine: str, joint: Joint, loaded: LoadedJoint | None) -> str:
    if loaded is None:
        return (
            f"The joint {joint.name} ({joint.kind}) does not move in {engine}, which has lost it or taken it for fixed."
        )
    if loaded.turns != joint.kind.turns:
        now = "turns" if loaded.turns else "slides"
        return f"The joint {joint.name} is {joint.kind} in the file and {now} in {engine}."
    ends = list(_ends(joint, loaded))
    if any(not _same(declared, found) for declared, found in ends):
        unit = "rad" if joint.kind.turns else "m"
        declared, found = ([f"{end[side]:.6g}" for end in ends] for side in (0, 1))
        return (
            f"The joint {joint.name} has the limits {' to '.join(declared)} {unit} in the file and "
            f"{' to '.join(found)} {unit} in {engine}."
        )
    return ""


def _ends(joint: Joint, loaded: LoadedJoint) -> Iterator[tuple[float, float]]:
    yield joint.lower, loaded.lower
    yield joint.upper, loaded.upper


def _same(declared: float, found: float) -> bool:
    return declared == found or abs(declared - found) <= _LIMIT_SLACK * max(1.0, abs(declared))


@check(
    "KV601",
    title="Poses agree over the range",
    fails="Poses differ over the range",
    severity=Severity.ERROR,
    cause=Cause.ENGINE,
    engines=("pinocchio",),
)
@engine_check(
    "02",
    title="Poses agree over the range",
    fails="Poses differ over the range",
    severity=Severity.ERROR,
    cause=Cause.ENGINE,
    feedback=FeedbackRow.EXPORTER,
)
def poses_agree(result: OpenCheck, context: EngineContext) -> None:
    """At zero, at rest, at both ends of every joint and in quasi-random configurations every link is where the
    file's kinematics put it, within engines.pose_distance of the model's size and engines.pose_deg. Engines that agree
    with the file agree with each other.

    Why it matters: A frame that the engine reads differently moves a part to another place without a message, and a
    policy that was trained in one engine fails in the next.

    Remedy: Write origins and axes as plain numbers, the axis as a unit vector; compare the frames of the link that
    the message names.
    """
    rows, settings, size = context.rows, context.settings, context.model.size
    ours, theirs = link_poses(context.declared, rows), context.model.poses(rows.q)
    distance = np.linalg.norm(ours[..., :3, 3] - theirs[..., :3, 3], axis=-1)
    # Frobenius norm of a difference of rotations: 2 sqrt(2) sin(angle / 2); exact for small angles, unlike the trace.
    chord = np.linalg.norm(ours[..., :3, :3] - theirs[..., :3, :3], axis=(-2, -1)) / np.sqrt(8.0)
    angle = np.degrees(2.0 * np.arcsin(np.clip(chord, 0.0, 1.0)))
    result.measured |= {"rows": float(len(rows.q)), "distance": float(distance.max()), "angle_deg": float(angle.max())}
    share = np.maximum(distance / (settings.pose_distance * size), angle / settings.pose_deg)
    worst = np.argmax(share, axis=0)
    for link in np.flatnonzero(share.max(axis=0) > 1.0).tolist():
        row = int(worst[link])
        result.find(
            f"{context.entry.title} puts the link {rows.links[link]} {distance[row, link] * 1e3:.3g} mm "
            f"and {angle[row, link]:.3g} deg from where the file's kinematics put it.",
            f"Write origins and axes on the way to {rows.links[link]} as plain numbers, axes as unit vectors.",
            link=rows.links[link],
            q=rows.named(row),
            value=distance[row, link],
            limit=settings.pose_distance * size,
            unit="m",
        )
