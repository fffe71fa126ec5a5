"""KV301 to KV303: what the model looks like at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.check import FeedbackRow, check
from kinematify.validation.checks.shared import BARELY, SLIMMER, UNSEEN, configuration, length
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.geometry.rest_pairs import AtRest
    from kinematify.geometry.scene import Pair
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.geometry.look import GeometryContext


@check(
    "KV301",
    title="Bodies without a joint between them are apart at rest",
    fails="Bodies without a joint between them overlap at rest",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    feedback=FeedbackRow.AS_GIVEN,
)
def strangers_overlap(result: OpenCheck, look: GeometryContext) -> None:
    """Of every pair of bodies that no joint joins (links held together by fixed joints are one body), the deepest
    point of one in the other is measured in the exact meshes: above geometry.rest_overlap of the model's size it is a
    warning, above geometry.wrong an error if the visible meshes overlap as much. A body inside another one counts as
    overlap; a body without collision geometry does not, for nothing pushes it. What the SRDF leaves out, or an MJCF
    keeps from colliding (`contype`, `conaffinity`, `exclude`), is a note.

    Why it matters: Engines push overlapping bodies apart in the first step, with whatever force it takes.

    Remedy: Correct the mesh or its origin; check that both parts hang on the right parent.
    """
    limit = look.scene.settings.rest_overlap * look.scene.size
    for rest in look.allowance.pairs.values():
        if not rest.joined and rest.depth > limit and look.collides(rest.pair):
            _overlap(result, look, rest, limit, f"{_how(look, rest)} at rest, and no joint joins them.")


@check(
    "KV302",
    title="Parent and child overlap only at their joint",
    fails="Parent and child are in each other at rest",
    severity=Severity.WARNING,
    cause=Cause.ASSET,
    feedback=FeedbackRow.AS_GIVEN,
)
def neighbours_overlap(result: OpenCheck, look: GeometryContext) -> None:
    """The deepest point of a part in the one that carries it is less than geometry.rest_joined of the smaller part's
    size. Small overlaps at a bearing are common and tolerated from then on.

    Why it matters: A part that is buried in its parent cannot be judged along its motion, and engines that collide
    neighbours push it out.

    Remedy: Correct the mesh or its origin, or cut the hole for the part.
    """
    for rest in look.allowance.pairs.values():
        limit = look.scene.settings.rest_joined * min(solid.size for solid in look.overlap.solids(rest.pair))
        if rest.joined and rest.depth > limit and look.collides(rest.pair):
            joint = look.scene.connection_of[rest.pair].joints[-1]
            message = f"{_how(look, rest)} at rest; the joint {joint} joins them."
            _overlap(result, look, rest, limit, message, joint=joint)


def _how(look: GeometryContext, rest: AtRest) -> str:
    first, second = look.links_at(rest.pair, {})
    depth = min(rest.depth, look.thickness(rest.pair))
    if rest.contained:
        return f"One of {first} and {second} is inside the other one, {length(depth)} deep,"
    return f"{first} and {second} overlap by {length(depth)}"


def _overlap(
    result: OpenCheck, look: GeometryContext, rest: AtRest, limit: float, message: str, *, joint: str | None = None
) -> None:
    seen = rest.depth if look.visible is None else look.visible.allowance.at_rest(rest.pair)
    unseen = seen <= limit
    wrong = (
        joint is None and look.shown(rest.pair) and min(rest.depth, seen) > look.scene.settings.wrong * look.scene.size
    )
    said = UNSEEN if look.clear(rest.pair, {}) else BARELY
    left_out = look.left_out_by(rest.pair, {})
    result.find(
        (f"{message} {said}" if unseen else message)
        + ("" if left_out is None else f" The pair is omitted by {left_out}."),
        SLIMMER
        if unseen
        else "Correct the mesh or its <origin>, or cut the parts so that they only touch; the overlap is tolerated "
        f"in all later checks.{_start(look, rest.pair)}",
        cause=Cause.PHYSICS if unseen else None,
        severity=Severity.NOTE if left_out is not None else Severity.ERROR if wrong else Severity.WARNING,
        joint=joint,
        pair=look.links_at(rest.pair, {}),
        q=configuration(look.scene, {}),
        value=min(rest.depth, look.thickness(rest.pair)),
        limit=limit,
        unit="m",
    )


_STARTS = 32
"""Configurations in which a place to start from is looked for."""


def _start(look: GeometryContext, pair: Pair) -> str:
    """Return a configuration in which a pair is apart, the nearest to rest of some; empty if it is in none."""
    from kinematify.geometry.scene import relative  # noqa: PLC0415 - reading the checks loads no geometry
    from kinematify.geometry.together import random_rows  # noqa: PLC0415

    scene, between = look.scene, sorted(look.scene.between(pair))
    if not between:
        return ""
    rows = np.tile(scene.mechanism.rest, (_STARTS, 1))
    rows[:, between] = random_rows(scene, seed=0)[:_STARTS, between]
    T = relative(scene.poses(rows), pair)
    apart = rows[~(look.overlap.collide(pair, T) | look.overlap.may_contain(pair, T))]
    if not len(apart):
        return ""
    nearest = apart[np.abs(apart - scene.mechanism.rest).sum(axis=1).argmin()]
    values = ", ".join(f"{scene.travels[k].joint} {nearest[k]:.3g}" for k in between)
    return f" Or start elsewhere, if zero is no pose of the model: the two are apart at {values}."


@check(
    "KV303",
    title="Parts touch what carries them",
    fails="A part touches nothing that carries it",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    feedback=FeedbackRow.NOT_CARRIED,
)
def hovering(result: OpenCheck, look: GeometryContext) -> None:
    """At rest, a moving part is less than geometry.hover of the model's size away from the body that its joint hangs
    it on. What is visible counts: collision shapes are often stubs that leave the bearing out. Of a wheel or rotor,
    whose axis runs through what carries it, it is a note: axles are seldom modelled.

    Why it matters: A part in the air often has the wrong parent or the wrong origin.

    Remedy: Check parent and origin of the joint; accept it where the bearing is not modelled.
    """
    scene, allowance = look.scene, look.allowance
    limit = scene.settings.hover * scene.size
    for connection in filter(look.is_known, scene.connections):
        seen = allowance if look.visible is None else look.visible.allowance
        if allowance.hovers(connection.pair, limit) and seen.hovers(connection.pair, limit):
            gap = seen.gap(connection.pair)
            parent, child = look.parent_and_child(connection, {})
            result.find(
                f"{child} is {length(gap)} away from {parent}, on which the joint {connection.joints[-1]} "
                "hangs it: no contact supports it.",
                "Check the joint's <parent> and <origin>; if the bearing is not modelled, accept it.",
                severity=Severity.NOTE if look.on_an_axle(connection) else None,
                joint=connection.joints[-1],
                pair=look.in_order(parent, child),
                q=configuration(scene, {}),
                value=gap,
                limit=limit,
                unit="m",
            )
