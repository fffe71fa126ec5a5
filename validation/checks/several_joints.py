"""KV331 to KV333: several joints at once, what engines see that collide convex hulls, and joints of twins."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.check import CauseScope, FeedbackRow, check
from kinematify.validation.checks.follow import AT_REST
from kinematify.validation.finding import Cause, Severity, not_finished
from kinematify.validation.geometry.formatting import configuration, joint_value, length
from kinematify.validation.geometry.mirror_pairs import twins_at_odds

if TYPE_CHECKING:
    from kinematify.robot.robot import Joint
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.geometry.look import GeometryContext

_HULL_SAMPLES = 24


def _two_joints(look: GeometryContext) -> str | None:
    return look.late or ("only one joint moves" if len(look.scene.travels) < 2 else None)


@check(
    "KV331",
    title="Configurations of all joints are free",
    fails="Configurations of all joints collide",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    follows={"KV301": CauseScope.PAIR, "KV311": CauseScope.PAIR},
    needs=(lambda look: not_finished("time ran out before it") if look.random is None else None,),
)
def free_configurations(result: OpenCheck, look: GeometryContext) -> None:
    """Quasi-random configurations of all joints (geometry.random_rows Sobol points); the share that is free is
    measured. A warning only if none is.

    Why it matters: Sampling planners and random resets need free configurations.

    Remedy: Check limits and parents if hardly any is free.
    """
    assert look.random is not None
    meeting = look.random.meeting
    hit = meeting.any(axis=1)
    result.measured["free_share"] = float((~hit).mean())
    if not hit.any():
        return
    share = meeting.mean(axis=0)
    column = int(share.argmax())
    row = int(meeting[:, column].argmax())
    standing = dict(enumerate(look.random.rows[row].tolist()))
    first, second = look.links_at(look.scene.pairs[column], standing)
    none = bool(hit.all())
    result.find(
        f"{(~hit).sum()} of {hit.size} quasi-random configurations are free of self-collision; most often, in "
        f"{share[column]:.0%}, {first} and {second} meet.",
        "A model that can hardly move without self-collision has wrong limits or a wrong parent."
        if none
        else "Nothing to do; planners must check self-collision.",
        severity=Severity.WARNING if none else Severity.NOTE,
        pair=(first, second),
        q=configuration(look.scene, standing),
        value=float((~hit).mean()),
    )


def _two_bodies_that_collide(look: GeometryContext) -> str | None:
    links = look.scene.model.link_by_name
    seen = sum(any(links[name].collisions for name in body.links) for body in look.scene.bodies)
    return "fewer than two bodies have collision geometry" if seen < 2 else None


@check(
    "KV332",
    title="Engines' hulls leave the motion free",
    fails="Engines' hulls block a motion that the surfaces leave free",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    feedback=FeedbackRow.COLLISION,
    follows=AT_REST,
    prepared=True,
    needs=(_two_bodies_that_collide,),
)
def hulls_block(result: OpenCheck, look: GeometryContext) -> None:
    """Where the exact surfaces are clear, so are the convex hulls of the collision shapes, which engines collide
    instead (neighbours only if the parent is the base). What the file declares concave="yes" is omitted: PyBullet
    collides its surface then.

    Why it matters: A drawer in a hollow cabinet is stuck in an engine although nothing is wrong with its joint.

    Remedy: Cut the collision meshes into convex pieces.
    """
    for done, sweep in enumerate(look.sweeps):
        if not look.in_time():
            result.leave(f"{len(look.sweeps) - done} joints")
            return
        found = look.hulls.blocked(sweep, _HULL_SAMPLES)
        if found is None:
            continue
        joint = sweep.travel.joint
        first, second = look.links_at(found.pair, {sweep.leader: found.at})
        result.find(
            f"The surfaces of {first} and {second} stay clear, but their convex hulls, which engines collide, "
            f"are {length(found.depth)} deep in each other at {joint_value(found.at, turns=sweep.travel.turns)} of "
            f"{joint}, and in the way over {found.share:.0%} of its free range.",
            "Cut the collision meshes into convex pieces (kinematify export --to urdf, or CoACD); the joint "
            "itself is right.",
            joint=joint,
            pair=(first, second),
            q=configuration(look.scene, {sweep.leader: found.at}),
            value=found.depth,
            limit=found.tolerance,
            unit="m",
        )


@check(
    "KV333",
    title="Twins move alike",
    fails="Twins do not move alike",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    needs=(_two_joints,),
)
def unlike_twins(result: OpenCheck, look: GeometryContext) -> None:
    """Two parts of one size that mirror or repeat each other at rest have joints of one type that do so too: their axes
    run alike and through the same place of both parts, and their ranges are about as wide and lead the same way. It is
    a finding only if no symmetry of the two explains both joints. Axes that differ are one only if the surfaces of both
    parts agree, and the axes differ either in direction or in place.

    Why it matters: One leg that bends the wrong way, or one door that opens inwards, is stopped by nothing in an
    engine.

    Remedy: Compare the two joints; correct <axis>, <origin>, the type or the limits of the one that is wrong.
    """
    for found in twins_at_odds(look.scene):
        first, second = found.joints
        result.find(
            f"{first.child} and {second.child} mirror or repeat each other, but {found.how}: "
            f"{' and '.join(f'{joint.name} ({_line_and_range(joint)})' for joint in found.joints)}.",
            "Compare the two: correct <axis> or <origin> of the one that is wrong, or its type or its limits.",
            pair=(first.child, second.child),
            line=second.line,
        )


def _line_and_range(joint: Joint) -> str:
    axis = " ".join(f"{value + 0.0:.4g}" for value in np.round(joint.axis, 4))
    return f"{joint.kind}, axis {axis}, {joint.lower:.4g} to {joint.upper:.4g}"
