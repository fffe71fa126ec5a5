"""KV405 and their like: each joint driven through its range, in whatever engine."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.linkage import loop_gaps, without_followers
from kinematify.simulation.contacts import stand_in_error, stand_in_reason
from kinematify.validation.check import CauseScope, FeedbackRow, engine_check
from kinematify.validation.checks.engine_rest import escape_limit
from kinematify.validation.checks.follow import IN_ENGINES, ON_THE_WAY
from kinematify.validation.checks.needs import late, not_driven, nothing_closes, nothing_moves
from kinematify.validation.finding import Cause, Severity
from kinematify.validation.geometry.formatting import BARELY, SLIMMER

if TYPE_CHECKING:
    from kinematify.simulation.drive import Driven
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.engine_context import EngineContext


@engine_check(
    "05",
    title="Driven through its range, each joint reaches both ends",
    fails="Driven through its range, a joint stops early",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
    feedback=FeedbackRow.NOT_REACHED,
    follows={**ON_THE_WAY, **IN_ENGINES, "KV804": CauseScope.JOINT, "KV225": CauseScope.JOINT},
    prepared=True,
    needs=(nothing_moves, late),
)
def reaches_both_ends(result: OpenCheck, context: EngineContext) -> None:
    """One joint after the other is driven from rest to both ends by a position servo, the others held. Each must
    arrive within engines.reach of its range. A joint that its own base stops is an error if the surfaces that the file
    declares meet, the visible ones too; where they are in each other at rest, only collision geometry meets, or
    convex stand-ins are in the way it is a warning, and a note where they are no neighbours (KV311 judges those), or
    pass each other in every engine unless their contacts are asked for. A tracking error above engines.tracking is a
    note.

    PyBullet: Pairs that touch at rest once meshes are inflated by 1 mm do not act on each other, since PyBullet would
    push them apart; the joint counts as stopped where they get deeper than allowed.

    Why it matters: A drawer that does not open in the simulator is of no use, whatever its file says.

    Remedy: Correct axis, pivot or limit of the joint, so that the pair that is named stays clear; where convex
    stand-ins meet, write convex pieces as collision geometry.
    """
    driven = context.drives.driven
    result.measured["drives"] = float(len(driven))
    result.measured["arrived"] = float(sum(context.arrived(item) for item in driven))
    for item in driven:
        if not context.arrived(item):
            _find_blocked(result, context, item)
        elif item.lag > context.settings.tracking * context.travel(item).range:
            _find_lag(result, context, item)
    _say_left(result, context)


@engine_check(
    "06",
    title="Driven joints press nothing together",
    fails="A driven joint presses links into each other",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    feedback=FeedbackRow.COLLISION,
    follows={**ON_THE_WAY, **IN_ENGINES, "05": CauseScope.PAIR, "KV804": CauseScope.JOINT},
    prepared=True,
    needs=(not_driven,),
)
def little_penetration(result: OpenCheck, context: EngineContext) -> None:
    """While a joint is driven to an end that it reaches, no pair of links gets deeper into each other than at rest by
    more than twice engines.contact_depth, beyond what convex stand-ins of neighbours can exceed their meshes by. It is
    a note where KV405 makes it one: where they are no neighbours, or pass each other in every engine.

    Why it matters: Parts that pass through each other teach a policy what reality does not allow.

    Remedy: Correct the joint, or the collision geometry of the pair.
    """
    driven = context.drives.driven
    worst: dict[int, tuple[float, Driven]] = {}
    arrived = [item for item in driven if context.arrived(item)]
    for item in arrived:
        # What is allowed gives way without force; a stop is then as soft as any contact of the engine.
        for pair in np.flatnonzero(item.excess > context.drives.sweep.tolerance).tolist():
            if item.excess[pair] > worst.get(pair, (0.0, item))[0]:
                worst[pair] = (float(item.excess[pair]), item)
    deepest = max((float(item.excess.max(initial=0.0)) for item in arrived), default=0.0)
    result.measured["deepest_beyond_rest"] = deepest + context.drives.sweep.tolerance if deepest > 0.0 else 0.0
    for pair, (excess, item) in sorted(worst.items()):
        _find_penetration(result, context, pair, excess, item)
    _say_left(result, context)


@engine_check(
    "09",
    title="Limits hold",
    fails="A limit gives way",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    feedback=FeedbackRow.UNSTABLE,
    follows={"KV221": CauseScope.JOINT, "KV207": CauseScope.BODY},
    needs=(not_driven,),
)
def limits_hold(result: OpenCheck, context: EngineContext) -> None:
    """At its end, a joint whose servo pulls on past the limit (by engines.push of the range) gets no farther beyond it
    than engines.escape of the range, 0.1 deg and 1 mm, whichever is more.

    Why it matters: A door that is pushed through its stop ends up in its frame.

    Remedy: Write a range that is not much smaller than the part's motion, and a plausible inertia: very light parts
    slip through soft stops.
    """
    driven = context.drives.driven
    pushed = [item for item in driven if context.travel(item).limited and context.arrived(item)]
    if not pushed:
        result.skip("no joint with limits got to one of them")
    for item in pushed:
        travel = context.travel(item)
        share = item.beyond / travel.range
        result.measured["farthest_of_range"] = max(0.0, share, result.measured.get("farthest_of_range", 0.0))
        limit = escape_limit(travel, context.settings)
        if item.beyond > limit:
            result.find(
                f"Pushed on at its limit {item.drive.end:.4g} {travel.unit}, joint {travel.joint} gets "
                f"{item.beyond:.3g} {travel.unit} beyond it, {share:.1%} of its range.",
                "Give the part a plausible inertia, and limits that fit its motion.",
                joint=travel.joint,
                value=item.beyond,
                limit=limit,
                unit=travel.unit,
            )
    _say_left(result, context)


@engine_check(
    "13",
    title="Driven, loops stay closed",
    fails="A loop opens while a joint is driven",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    follows={"KV230": CauseScope.MODEL},
    needs=(nothing_moves, nothing_closes, not_driven),
)
def loops_stay_closed(result: OpenCheck, context: EngineContext) -> None:
    """On the way of each driven joint, both ends of every loop stay within physics.loop_gap of the model's size of each
    other. The engine holds them by its own means, and no motor moves the passive joints.

    MuJoCo: By an equality connect with the softness of the MJCF export.

    PyBullet: By createConstraint; where <mimic> alone closes a loop, by the motors of the joints that follow.

    Why it matters: A linkage that comes apart under load is none.

    Remedy: Correct what KV230 names; give the links of the loop plausible masses: pins of links far lighter than their
    load give way.
    """
    robot, mechanism = context.declared, context.mechanism
    free = without_followers(robot)
    allowed = context.request.settings.physics.loop_gap * context.physics.size
    for item in context.drives.driven:
        gaps = [loop_gaps(free, dict(zip(mechanism.joints, row.tolist(), strict=True))) for row in item.values]
        worst = {loop: max(gap[loop] for gap in gaps) for loop in gaps[0]}
        result.measured["widest_gap"] = max(*worst.values(), result.measured.get("widest_gap", 0.0))
        for loop in robot.loops:
            if worst[loop.name] > allowed:
                driven = context.travel(item).joint
                result.find(
                    f"While {driven} is driven to {item.drive.end:.3g}, the loop {loop.name} of {loop.links[0]} and "
                    f"{loop.links[1]} opens by {worst[loop.name]:.3g} m.",
                    "Correct the loop, or the masses of its links.",
                    pair=loop.links,
                    joint=driven,
                    value=worst[loop.name],
                    limit=allowed,
                    unit="m",
                )
    _say_left(result, context)


def _say_left(result: OpenCheck, context: EngineContext) -> None:
    if context.drives.left:
        result.leave(f"{context.drives.left} of the drives")


def _find_blocked(result: OpenCheck, context: EngineContext, driven: Driven) -> None:
    travel = context.travel(driven)
    where = f"Driven from {travel.rest:.4g} towards {driven.drive.end:.4g} {travel.unit}"
    stops = f"{where}, joint {travel.joint} stops at {driven.reached:.4g} {travel.unit}"
    facts = {
        "joint": travel.joint,
        "q": {travel.joint: driven.reached},
        "value": driven.reached,
        "limit": driven.drive.end,
        "unit": travel.unit,
    }
    index = _blocking_pair(context, driven)
    if index is None:
        result.find(
            f"{stops} without contact, at a force of {driven.force:.3g} {'N m' if travel.turns else 'N'}.",
            "Check damping, friction and inertia of the joint, and the limits of joints that follow it.",
            severity=Severity.WARNING,
            cause=Cause.PHYSICS,
            **facts,  # type: ignore[arg-type]
        )
        return
    first, second = pair = context.links_on_the_way(driven, index)
    excess, values = context.excess_towards(driven)
    deepest = int(np.argmax(excess[index]))
    beyond = excess[index, deepest] > stand_in_error(context.prepared, pair)
    real, seen = (False, False) if not beyond else _surfaces(context, driven, pair, until=float(values[deepest]))
    why = (
        f"there {first} and {second} collide; moved on without physics, they get {excess[index, deepest] * 1e3:.3g} mm "
        f"deeper into each other than at rest (at {values[deepest]:.4g} {travel.unit})"
    )
    if real and not seen:
        why, remedy = f"{why}. {BARELY.rstrip('.')}", SLIMMER
    elif real:
        remedy = f"Correct axis, pivot or limit of {travel.joint} so that {first} and {second} stay clear."
    else:
        reason = stand_in_reason(context.prepared, pair) if not beyond else "while their declared surfaces stay clear"
        why += f", {reason}"
        remedy = f"Write convex pieces as collision geometry of {first} and {second}."
    result.find(
        f"{stops}: {why}.",
        remedy,
        severity=_severity(context, index, certain=seen and travel.limited and not _buried(context, index)),
        cause=Cause.KINEMATICS if seen else Cause.PHYSICS,
        pair=pair,
        **facts,  # type: ignore[arg-type]
    )


def _surfaces(context: EngineContext, driven: Driven, pair: tuple[str, str], *, until: float) -> tuple[bool, bool]:
    """Test whether the declared surfaces of two links meet on the way from rest to where the pieces are deepest.

    Returns:
        For those that collide; and for what is visible too, since collision shapes are often stubs or swollen.
    """
    from kinematify.validation.geometry.surfaces import surfaces_meet  # noqa: PLC0415 - exact geometry takes a while

    leader, (_, values) = driven.drive.leader, context.excess_towards(driven)
    away = np.abs(values - context.travel(driven).rest)
    way = np.argsort(away)[: 1 + int(np.count_nonzero(away < abs(until - context.travel(driven).rest)))]
    rows = np.tile(context.mechanism.rest, (1 + len(way), 1))
    rows[1:, leader] = values[way]
    ask = partial(surfaces_meet, links=pair, leaders=rows, tolerance=context.drives.sweep.tolerance)
    real = ask(context.surfaces)
    return real, real and (context.visible_surfaces is None or ask(context.visible_surfaces))


def _buried(context: EngineContext, index: int) -> bool:
    """True if a pair is in each other at rest already, as shapes are that represent a joint roughly."""
    sweep = context.drives.sweep
    return bool(sweep.at_rest[index] > sweep.tolerance)


def _severity(context: EngineContext, index: int, *, certain: bool) -> Severity:
    """Return how bad it is that a pair stops a joint.

    By default, MuJoCo lets neighbours pass each other but for those of a root that is fixed to the world, and PyBullet
    all of them. Of other pairs the exact geometry knows whether another joint clears the way (KV311). What has no
    collision geometry in a model that has some stops nothing.
    """
    sweep, links = context.drives.sweep, context.prepared.link_by_name
    pair = tuple(sorted(sweep.bodies[index].tolist()))
    if pair not in context.mechanism.neighbours or pair[0] != 0:
        return Severity.NOTE
    solid = any(link.pieces and not link.from_visual for link in links.values())
    if solid and any(links[name].from_visual for name in sweep.pair(index, context.mechanism.links)):
        return Severity.NOTE
    return Severity.ERROR if certain else Severity.WARNING


def _blocking_pair(context: EngineContext, driven: Driven) -> int | None:
    """Return the pair of the sweep that stops a joint: the deepest where it is, else the deepest ahead of it."""
    parted = context.separates(driven.drive.leader)
    if not parted.any():
        return None
    # A servo at its limit of force presses a contact in by less than the tolerance.
    pressed = np.where(parted, driven.at_end, -np.inf)
    if pressed.max() > -0.5 * context.drives.sweep.tolerance:
        return int(np.argmax(pressed))
    excess, _ = context.excess_towards(driven)
    ahead = np.where(parted, excess.max(axis=1), -np.inf)
    return int(np.argmax(ahead)) if ahead.max() > 0.0 else None


def _find_lag(result: OpenCheck, context: EngineContext, driven: Driven) -> None:
    travel = context.travel(driven)
    result.find(
        f"On its way to {driven.drive.end:.4g} {travel.unit}, joint {travel.joint} lags {driven.lag:.3g} {travel.unit} "
        f"behind its command.",
        "Check damping, friction and inertia of the joint.",
        severity=Severity.NOTE,
        cause=Cause.PHYSICS,
        joint=travel.joint,
        value=driven.lag,
        limit=context.settings.tracking * travel.range,
        unit=travel.unit,
    )


def _find_penetration(result: OpenCheck, context: EngineContext, pair: int, excess: float, driven: Driven) -> None:
    first, second = names = context.links_on_the_way(driven, pair)
    travel = context.travel(driven)
    result.find(
        f"While {travel.joint} is driven to {driven.drive.end:.4g} {travel.unit}, {first} and {second} get "
        f"{(excess + context.drives.sweep.tolerance) * 1e3:.3g} mm deeper into each other than at rest.",
        f"Correct the joint, or the collision geometry of {first} and {second}.",
        severity=_severity(context, pair, certain=False),
        joint=travel.joint,
        pair=names,
        value=excess + context.drives.sweep.tolerance,
        limit=context.drives.sweep.tolerance,
        unit="m",
    )
