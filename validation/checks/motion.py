"""KV310 to KV321: what the sweep of one joint says about its axis, its direction and its limits.

A wrong axis or pivot drives the child into its parent at once and to both sides; a wrong limit lets it go for a
while to one side; a wrong parent brings it together with other bodies.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.check import CauseScope, FeedbackRow, check
from kinematify.validation.checks.shared import (
    BARELY,
    SLIMMER,
    UNFELT,
    UNSEEN,
    configuration,
    joint_value,
    length,
)
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.geometry.sweep import Meeting
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.geometry.look import JointMotion


_CRIPPLED = 0.5
"""No remedy leaves a joint less of its range."""
_GUIDED = 0.5
"""Share of its length with which a sliding part is beside what guides it."""
_LIMBS = 2
"""Bodies with more joints between them stand on limbs: two parts of a cabinet have two."""


@check(
    "KV310",
    title="A joint does not drive its child into its parent",
    fails="A joint drives its child into its parent",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
    feedback=FeedbackRow.INTO_PARENT,
    doubts=True,
)
def through_parent(result: OpenCheck, motion: JointMotion) -> None:
    """Each joint is moved alone, over its range and beyond. A child that gets deeper into its parent than at rest
    (geometry.tolerance) before geometry.early of the range is through, to both sides, says that axis, place or type is
    wrong; to the only permitted side, with the other one free, that the direction is. Above geometry.wrong, or if less
    than geometry.early of the range is free down to the tolerance, it is an error, unless the joint has no limits (a
    whole turn is none), the two are in each other at rest (a note if both hold: no range is claimed, and contact is no
    news), or only the collision geometry meets and not what is visible: that is a note where engines let the two pass
    by default, as they do neighbours but for those of the base.

    Why it matters: The joint is stuck in every engine, or the part passes through the wall that carries it.

    Remedy: Correct axis and origin, the type, or the direction, as the message says.
    """
    travel = motion.sweep.travel
    for sign, meeting in motion.blocked.items():
        side, other = motion.side(sign), motion.side(-sign)
        if not motion.early(side):
            continue
        where = (
            f"Moving {motion.joint} alone, the child meets its parent at {_value(motion, meeting.first)} already "
            f"(declared up to {_value(motion, side.declared)}): {_words(motion, meeting)}."
        )
        opposite = motion.own_first(other)
        if opposite is not None and motion.early(other):
            _meet(
                result,
                motion,
                meeting,
                f"{where} The other way it meets it at {_value(motion, opposite.first)}: blocked to both "
                "sides at once.",
                "The axis or its place is wrong, or the type: move the joint's <origin> onto the hinge or guide and "
                "align <axis> with it; if the part slides, or turns, write that type."
                if motion.has_stops
                else "Correct its axis, place or type, or the collision geometry of the two.",
                severity=None if motion.has_stops else Severity.WARNING,  # without limits a file claims no free range
            )
            return
        if motion.one_sided(sign):
            free = _value(motion, travel.rest - sign * motion.free_way(other))
            _meet(
                result,
                motion,
                meeting,
                f"{where} The other way, which is not permitted, it is free up to {free}: the joint moves into its "
                "parent.",
                "Reverse <axis>, or swap the limits together with their signs.",
            )


@check(
    "KV311",
    title="A joint does not drive its child into other bodies",
    fails="A joint drives its child into another body",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    feedback=FeedbackRow.OTHER_PARENT,
    follows={"KV312": CauseScope.JOINT, "KV310": CauseScope.JOINT},
)
def into_others(result: OpenCheck, motion: JointMotion) -> None:
    """While each joint moves alone over its range, bodies that are no neighbours do not meet. If another joint can
    clear the way (a door before the drawer behind it), it is a note. So is what arms, legs and fingers do: a chain
    that folds onto itself, two limbs that meet, or two fingers that the joint moves both, after the joint was free
    over geometry.early of its range, or over geometry.early_turn; and what a joint without limits does (a whole turn
    is none).

    Why it matters: Parts that always meet hang on the wrong parent, or the range is too wide.

    Remedy: Correct the parent, or end the range before the contact.
    """
    sweep = motion.sweep
    meetings = [m for side in sweep.sides for m in side.meetings if m.pair not in sweep.own and m.inside]
    look, leader = motion.look, sweep.leader
    meetings = [item for item in meetings if look.left_out_by(item.pair, {leader: item.at}) is None]
    found = [meeting for meeting in meetings if motion.counts(meeting)]
    if not found:
        return
    folding = [meeting for meeting in found if _folds(motion, meeting)]
    stuck = [meeting for meeting in found if meeting not in folding and not motion.clearable(meeting)]
    worst = max(stuck or found, key=lambda meeting: meeting.depth)
    more = f" ({len(found) - 1} more pairs meet.)" if len(found) > 1 else ""
    begin = f"Moving {motion.joint} alone, {_words(motion, worst)}, from {_value(motion, worst.first)} on"
    if stuck:
        _meet(
            result,
            motion,
            worst,
            f"{begin}, wherever the other joints stand.{more}",
            "If one of them carries the other, correct <parent>; otherwise end the range before, or correct the axis."
            if motion.has_stops
            else "Nothing to do where software limits the joint; else give it limits.",
            severity=Severity.WARNING if motion.has_stops else Severity.NOTE,
        )
    elif worst in folding:
        _meet(
            result,
            motion,
            worst,
            f"{begin}: the chain of joints between them reaches itself.{more}",
            "Nothing to do; a planner must keep them apart.",
            severity=Severity.NOTE,
        )
    else:
        _meet(
            result,
            motion,
            worst,
            f"{begin}, unless another joint has moved out of the way before.{more}",
            "Nothing to do; move the other joint first.",
            severity=Severity.NOTE,
        )


def _folds(motion: JointMotion, meeting: Meeting) -> bool:
    """True if a chain of joints reaches itself, and not at once.

    One body carries the other with others between them, both stand on limbs of their own, or the joint closes a gripper
    and moves both.
    """
    travel, scene = motion.sweep.travel, motion.scene
    moved = scene.mechanism.moved[motion.sweep.leader]
    closes = all(moved[scene.bodies[body].group] for body in meeting.pair)
    chain = closes or scene.carries(meeting.pair) or len(scene.between(meeting.pair)) > _LIMBS
    return chain and (motion.late(meeting) or abs(meeting.first - travel.rest) > scene.settings.early * travel.range)


@check(
    "KV312",
    title="Limits fit the free travel",
    fails="A limit lies beyond the free travel",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
    feedback=FeedbackRow.END,
    follows={"KV310": CauseScope.JOINT},
)
def beyond_free_travel(result: OpenCheck, motion: JointMotion) -> None:
    """The range does not end beyond the place where the child meets its parent (by more than geometry.late of the
    range): a warning, an error as in KV310, unless only the collision geometry meets (see KV310), or
    the two are in each other at rest. Where the joint has no limits (a whole turn is none) it is a warning, and a note
    after geometry.early_turn. A rail may go through a solid carriage, and a contact that is alike over half of the way
    or more is no stop.

    Why it matters: Controllers drive to the declared end; what they meet before it bends, breaks or explodes.

    Remedy: Write the measured end as the limit.
    """
    settings, travel = motion.scene.settings, motion.sweep.travel
    early = {sign: motion.early(motion.side(sign)) for sign in (-1.0, 1.0)}
    reported = any(early[sign] and (early[-sign] or motion.one_sided(sign)) for sign in motion.blocked)  # by KV310
    for sign, meeting in motion.blocked.items():
        side = motion.side(sign)
        if reported or abs(side.declared - meeting.first) < settings.late * travel.range:
            continue
        end = "upper" if sign > 0 else "lower"
        _meet(
            result,
            motion,
            meeting,
            f"{motion.joint} is declared to go to {_value(motion, side.declared)}, but its child meets its parent at "
            f"{_value(motion, meeting.first)}: {_words(motion, meeting)}.",
            _shorter(motion, end, meeting.first)
            if motion.has_stops
            else "Nothing to do where software limits the joint; else give it limits, or correct its axis.",
            severity=None if motion.has_stops else Severity.NOTE if motion.late(meeting) else Severity.WARNING,
        )


@check(
    "KV320",
    title="Parts stay with what carries them",
    fails="A part leaves what carries it",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
    feedback=FeedbackRow.DERAILED,
    doubts=True,
    follows={"KV321": CauseScope.JOINT},
)
def lost_contact(result: OpenCheck, motion: JointMotion) -> None:
    """Along the range, the gap between child and parent grows by less than geometry.lost of the model's size; beyond
    geometry.far it is an error, unless the two are that far apart at rest, or a slide is beside its parent with less
    than half of its length: the rope or rod of such a part is not in the file. It counts where both what is visible
    and what collides part.

    Why it matters: A hinge about the wrong line swings the part away from it, and a slide that is too long drops it.

    Remedy: Align axis and origin with the hinge or guide, or reduce the limits.
    """
    scene = motion.scene
    limit = scene.settings.lost * scene.size
    for pair in sorted({pair for side in motion.sweep.sides for pair, _, _ in side.gaps}):
        grown, value = motion.parted(pair)
        if grown > limit:
            grown, value = min((grown, value), motion.seen_parted(pair))
        connection = scene.connection_of[pair]
        if grown <= limit or not motion.look.is_known(connection):
            continue
        parent, child = motion.look.parent_and_child(connection, {motion.sweep.leader: value})
        what = "turns away from its hinge" if motion.sweep.travel.turns else "leaves its guide"
        far = grown > scene.settings.far * scene.size and motion.look.allowance.gap(pair) <= limit
        side = motion.side(1.0 if value > motion.sweep.travel.rest else -1.0)
        held = 1.0 if motion.sweep.travel.turns else motion.guide(connection, side)[1]
        result.find(
            f"{child} gets {length(grown)} farther away from {parent} than at rest at {_value(motion, value)} of "
            f"{motion.joint}: it {what}.",
            "Align <axis> and <origin> with the hinge or guide, check the type, or reduce the limits.",
            severity=Severity.ERROR if far and held >= _GUIDED else Severity.WARNING,
            joint=motion.joint,
            pair=motion.look.in_order(parent, child),
            q=configuration(scene, {motion.sweep.leader: value}),
            value=grown,
            limit=limit,
            unit="m",
        )


@check(
    "KV321",
    title="A slide ends before its guide does",
    fails="A slide runs out of its guide",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    feedback=FeedbackRow.GUIDE,
)
def out_of_guide(result: OpenCheck, motion: JointMotion) -> None:
    """A sliding part is still beside its parent at the end of its range: the travel is below geometry.guide of the
    length along the axis that both share, visible or colliding, whichever is more. Of what is beside its parent
    with less than half of its length, as the hook of a hoist does, the guide is not in the file.

    Why it matters: A drawer that is pulled out farther than it is long falls, but not in an engine.

    Remedy: Reduce the limit to about four fifths of the guide.
    """
    travel, scene = motion.sweep.travel, motion.scene
    if travel.turns or not travel.limited:
        return
    for pair in sorted(motion.sweep.own):
        connection = scene.connection_of[pair]
        for side in motion.sweep.sides:
            way = abs(side.declared - travel.rest)
            guide, held = max(motion.guide(connection, side), motion.guide(connection, side, visible=True))
            # What stands on its parent, as a lid does, or hangs on a rope, as a hook does, has no guide in the file.
            known = motion.look.is_known(connection) and held >= _GUIDED
            if guide <= scene.settings.hover * scene.size or not known or way <= scene.settings.guide * guide:
                continue
            parent, child = motion.look.parent_and_child(connection, {motion.sweep.leader: side.declared})
            end, last = "upper" if side.sign > 0 else "lower", travel.rest + side.sign * 0.8 * guide
            result.find(
                f"{motion.joint} slides {child} by {length(way)}, but only {length(guide)} of it stand beside "
                f"{parent} along the axis: at the end of its range it has left it.",
                f"{_limit(motion, end, last)} (four fifths of its guide), or correct <axis>."
                if 0.8 * guide > _CRIPPLED * travel.range
                else "Check <axis> and <origin>, and whether the guide is modelled.",
                joint=motion.joint,
                pair=motion.look.in_order(parent, child),
                q=configuration(scene, {motion.sweep.leader: side.declared}),
                value=way,
                limit=scene.settings.guide * guide,
                unit="m",
            )


def _limit(motion: JointMotion, end: str, value: float) -> str:
    """The element to write, with one end of the range changed."""
    joint = motion.scene.model.joint_by_name[motion.joint]
    ends = {"lower": joint.lower, "upper": joint.upper, end: value}
    more = {"effort": joint.effort, "velocity": joint.velocity}
    given = [f'{name}="{number:.4g}"' for name, number in (ends | more).items() if number is not None]
    return f"Write <limit {' '.join(given)}/> in the joint {motion.joint}"


def _shorter(motion: JointMotion, end: str, value: float) -> str:
    """Return what to do where a joint is stopped early: a limit there, unless hardly any range would be left."""
    if motion.left < _CRIPPLED:
        return "Correct the joint's axis or place, or the shapes of the two; a limit there would leave little range."
    return f"{_limit(motion, end, value)}; if the part should go farther, its axis or its place is wrong."


def _value(motion: JointMotion, value: float) -> str:
    return joint_value(value, turns=motion.sweep.travel.turns)


def _words(motion: JointMotion, meeting: Meeting) -> str:
    """Return what meets, how deep and where."""
    first, second = motion.look.links_at(meeting.pair, {motion.sweep.leader: meeting.at})
    place = _value(motion, meeting.at)
    if meeting.passed:
        return f"{first} and {second} go through each other on the way to {place}"
    return f"{first} and {second} get into each other by {length(motion.penetration(meeting))} at {place}"


def _meet(
    result: OpenCheck,
    motion: JointMotion,
    meeting: Meeting,
    message: str,
    remedy: str,
    *,
    severity: Severity | None = None,
) -> None:
    """Add a finding; an error if they are clearly too deep, not in the collision geometry alone nor at rest already."""
    seen = meeting.depth if severity is Severity.NOTE else motion.seen(meeting)
    unseen = seen == 0.0
    buried = motion.look.allowance.at_rest(meeting.pair) > motion.look.allowance.tolerance(meeting.pair)
    collides = motion.look.collides(meeting.pair)
    deep = min(meeting.depth, seen) > motion.scene.settings.wrong * motion.scene.size
    wrong = (deep or (motion.stuck and not unseen)) and not buried and collides
    if (unseen and not motion.look.felt_by_engines(meeting.pair)) or (buried and not motion.has_stops):
        severity = Severity.NOTE
    said = UNSEEN if unseen and motion.look.clear(meeting.pair, {motion.sweep.leader: meeting.at}) else BARELY
    result.find(
        f"{message} {said}" if unseen else message if collides else f"{message} {UNFELT}",
        SLIMMER if unseen else remedy,
        severity=severity or (Severity.ERROR if wrong else Severity.WARNING),
        cause=Cause.PHYSICS if unseen else None,
        joint=motion.joint,
        pair=motion.look.links_at(meeting.pair, {motion.sweep.leader: meeting.at}),
        q=configuration(motion.scene, {motion.sweep.leader: meeting.at}),
        value=motion.penetration(meeting),
        limit=motion.look.allowance.tolerance(meeting.pair),
        unit="m",
    )
