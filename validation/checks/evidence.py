"""KV340 to KV349: does the geometry of two links explain the joint between them?

KV341 to KV346 are opinions, for people build doors that no rule has seen: they count only beside an error of fact
about the same joint, and are one note per joint else (`kinematify.validation.run.opinions`). They are asked only of
joints that a sweep doubts or whose contact opens, for they take most of the time. One cause, one finding:
a joint with the wrong parent is judged no further, and where several joints in series share one contact only what
holds for each of them is.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.validation.check import CauseScope, FeedbackRow, check
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.config.validation import EvidenceSettings
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.evidence.case import JointCase

_NAMED = 8
"""Joints that one finding names."""


_opinion = partial(
    check,
    cause=Cause.KINEMATICS,
    doubts=True,
    opinion=True,
    follows={"KV341": CauseScope.JOINT, "KV350": CauseScope.BODY},
)


@check(
    "KV340",
    title="The axes run along the parts",
    fails="Several axes are off the parts by the same few degrees",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
)
def askew_together(result: OpenCheck, case: JointCase) -> None:
    """Fewer than evidence.askew_joints axes run between evidence.askew_deg and evidence.unknown_deg off every direction
    that their bodies show, all by the same angle (evidence.askew_spread). It is one finding, for it has one cause.

    Why it matters: Drawers whose guides are turned by some degrees against their boxes rub, and a policy that was
    trained with them pulls askew.

    Remedy: Look for one rotation that was written by hand or rounded, in the axes or in the <origin> of the meshes.
    """
    askew = case.askew
    if len(askew) < case.settings.askew_joints or askew[0] is not case.measures:
        return
    names = [item.joint.source for item in askew]
    angle = float(np.median([item.angle for item in askew]))
    _doubt(
        result,
        case,
        f"The axes of {len(askew)} joints run about {angle:.2g} deg off every direction that their bodies show: "
        f"{', '.join(names[:_NAMED])}{', ...' if len(names) > _NAMED else ''}.",
        "Turn the axes, or the meshes, by that angle; one rotation that was rounded or written by hand explains all.",
        value=angle,
        limit=case.settings.askew_deg,
        unit="deg",
    )


@check(
    "KV341",
    title="A child hangs on what it touches",
    fails="A child touches another link than its parent",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
    feedback=FeedbackRow.NOT_CARRIED,
    doubts=True,
    opinion=True,
    follows={"KV303": CauseScope.JOINT, "KV350": CauseScope.BODY},
)
def hangs_elsewhere(result: OpenCheck, case: JointCase) -> None:
    """At rest, every moving body touches the body that carries it, or at least no other one. A child that is more than
    evidence.far_gap away from its parent and touches another body is an error; one whose contact with the parent
    has less than evidence.weak_contact of the quality of its best other contact is a warning.

    Why it matters: A part on the wrong parent moves with the wrong thing: the handle stays behind when the door
    opens.

    Remedy: Write the link that carries the part as the joint's parent and express the origin in its frame.
    """
    found = case.measures.parent
    if not case.hangs_elsewhere or found.best is None:
        return
    other = case.bodies.links[found.best]
    remedy = f"Make {other} the parent, or fix the pose or the meshes of {case.child} and {case.parent}."
    if not found.touches:
        apart = found.gap * case.bodies.diagonal
        _doubt(
            result,
            case,
            f"{case.child} does not touch {case.parent}, which carries it (they are {apart:.3g} m apart), but "
            f"it touches {other}.",
            remedy,
            severity=Severity.ERROR if found.gap > case.settings.far_gap else Severity.WARNING,
            value=apart,
            limit=case.bodies.graph.tolerance,
            unit="m",
        )
        return
    _doubt(
        result,
        case,
        f"The contact of {case.child} with {case.parent}, which carries it, is far weaker than that with "
        f"{other}: {case.share_of_contact:.0%} of its quality.",
        remedy,
        value=case.share_of_contact,
        limit=case.settings.weak_contact,
    )


@_opinion(
    "KV342",
    title="The axis runs in a direction that the parts show",
    fails="The axis runs in no direction that the parts show",
    severity=Severity.ERROR,
    feedback=FeedbackRow.LINE,
)
def unknown_direction(result: OpenCheck, case: JointCase) -> None:
    """The axis lies within evidence.unknown_deg of a direction that the two bodies show: axes of round surfaces and
    circular edges on both sides of the contact, edges and faces of either body, guides, the normal and the long
    side of the contact. Beyond evidence.wrong_deg it is an error where another joint is also likelier by
    evidence.better. It needs no ground truth: people build along what they build.

    Why it matters: A hinge that is turned by some degrees lets a door scrape and lift, and no engine complains.

    Remedy: Align the axis with the hinge or guide; the message names the direction that fits best.
    """
    if not case.unexplained:
        return
    line, settings = case.measures, case.settings
    certain = line.angle > settings.wrong_deg and line.deficit > settings.better and case.measures.alone
    _doubt(
        result,
        case,
        f"The axis runs {line.angle:.1f} deg off every direction that {case.child} and {case.parent} show: "
        "their edges, faces, round surfaces and where they touch.",
        case.instead,
        severity=Severity.ERROR if certain else Severity.WARNING,
        value=line.angle,
        limit=settings.unknown_deg,
        unit="deg",
    )


@_opinion(
    "KV343",
    title="The axis runs where the parts have a hinge",
    fails="The axis runs beside every hinge of the parts",
    severity=Severity.WARNING,
    feedback=FeedbackRow.LINE,
)
def unknown_place(result: OpenCheck, case: JointCase) -> None:
    """A turning joint's axis runs within evidence.unknown_distance of the child's size (in linkages
    evidence.linkage_distance) of a line that the two bodies show: a bearing, an edge or middle line of the part,
    the line along which they touch.

    Why it matters: A door that turns about a line beside its edge cuts through its frame or leaves a gap.

    Remedy: Move the joint's origin onto the hinge line; the message names the line that fits best.
    """
    if not case.misplaced:
        return
    line = case.measures
    size = case.measures.scene.frame.diagonal
    far = f"{line.distance * size:.3g} m" if np.isfinite(line.distance) else "far"
    _doubt(
        result,
        case,
        f"The axis runs {far} beside every line along its direction that {case.child} and {case.parent} show "
        f"as a hinge ({case.child} is {size:.3g} m large).",
        case.instead,
        value=line.distance * size if np.isfinite(line.distance) else size,
        limit=case.farthest * size,
        unit="m",
    )


@_opinion(
    "KV344",
    title="No other joint fits the contact far better",
    fails="Another joint fits the contact far better",
    severity=Severity.WARNING,
    feedback=FeedbackRow.LINE,
)
def another_fits(result: OpenCheck, case: JointCase) -> None:
    """The fitted choice of the inference judges the declared joint beside all candidates of its type, by geometry
    alone. A lead of evidence.better in log probability is a warning, unless both bodies are round about the declared
    line itself. In linkages, whose bearings are often not modelled, it takes a lead of evidence.linkage_better with a
    bearing on both bodies about another line (evidence.bearing_lead) or a range of which the parent blocks
    evidence.blocked.

    Why it matters: A door on the wrong edge, or a knob about the wrong line, moves plausibly in an engine and
    wrongly.

    Remedy: Compare with the candidate that the message names, and correct axis and origin.
    """
    if not case.outdone:
        return
    deficit = case.measures.deficit
    _doubt(
        result,
        case,
        f"Another joint of the same type explains the contact of {case.child} and {case.parent} clearly "
        f"better: it is {min(np.exp(deficit), 1e4):.0f} times as likely to be right.",
        case.instead,
        value=deficit,
        limit=case.usual_deficit,
    )


@_opinion(
    "KV345",
    title="The type fits the parts",
    fails="The parts look as if they moved otherwise",
    severity=Severity.WARNING,
    feedback=FeedbackRow.TYPE,
)
def other_type(result: OpenCheck, case: JointCase) -> None:
    """Shape and room of the part do not speak for the other type of joint: plates hinge, boxes in a cavity slide,
    round parts with a bearing turn, small caps are pressed. Log odds of the fitted choice above evidence.type_odds
    are a warning; a slide of a linkage must also have a bearing, a better direction (evidence.better) or a parent in
    the way (evidence.blocked), and a continuous joint is taken as meant.

    Why it matters: A drawer that turns and a door that slides are useless for training, and nothing else reports
    them.

    Remedy: Write the other type with limits in its unit, or accept the finding with a reason.
    """
    measures, settings = case.measures, case.settings
    odds = measures.odds_against
    if not case.judged_alone or odds <= settings.type_odds or not _type_open(case):
        return
    declared, other = ("slide", "turn") if measures.slides else ("turn", "slide")
    _doubt(
        result,
        case,
        f"{case.child} is declared to {declared} on {case.parent}, but its shape and room speak for a part "
        f"that {other}s (log odds {odds:.1f}).",
        f"Check the type: written as {'revolute' if measures.slides else 'prismatic'} it would fit. "
        "The report names the joint that fits best.",
        value=odds,
        limit=settings.type_odds,
        unit="log odds",
    )


def _type_open(case: JointCase) -> bool:
    """False where the odds are no more than habit: few joints of linkages slide, but those that do are meant to.

    They count against a slide only where something else does too: a bearing, a better slide, a parent in the way. Nor
    does anybody write that a part turns without end by mistake.
    """
    if case.measures.joint.kind is JointType.CONTINUOUS:
        return False
    if not case.linkage or not case.measures.slides:
        return True
    better = case.measures.deficit > case.settings.better
    return better or case.measures.scene.has_bearing or case.blocked > case.settings.blocked


@_opinion(
    "KV346",
    title="The permitted motion opens",
    fails="The permitted motion closes",
    severity=Severity.WARNING,
)
def opens_inwards(result: OpenCheck, case: JointCase) -> None:
    """With a one-sided range (evidence.one_sided), the permitted side does not lead into the parent within
    evidence.shut of the range while the other side is free for evidence.open of it; a closed panel does not turn
    into its body (evidence.panel_inward), and small parts that slide do not move outwards
    (evidence.button_outward).

    Why it matters: A drawer that opens inwards is stuck in every engine, or flies out of the back of the cabinet.

    Remedy: Reverse the axis, or swap the limits together with their signs.
    """
    joint, room, settings = case.measures.joint, case.measures, case.settings
    short, long = sorted((abs(joint.lower), abs(joint.upper)))
    if not case.judged_alone or not np.isfinite(long) or short >= settings.one_sided * long:
        return
    forward = abs(joint.upper) > abs(joint.lower)
    free, other = room.free if forward else room.free[::-1]
    outward = room.outward if forward else -room.outward
    wanted = min(long, room.reach)
    remedy = "Turn the axis round (or swap the limits with their signs), so that the permitted motion opens."
    if case.measures.slides and case.small and not case.linkage:
        if outward > settings.button_outward:  # pressed parts sink into what they stand on: only the way out is wrong
            message = f"{case.child} is a small part on {case.parent} and moves out of it; buttons go in."
            _doubt(result, case, message, remedy, value=outward, limit=settings.button_outward)
    elif free < settings.shut * wanted and other > settings.open * wanted:
        unit = "m" if case.measures.slides else "rad"
        _doubt(
            result,
            case,
            f"The permitted motion of {case.child} leads into {case.parent} after {free:.3g} {unit} of "
            f"{long:.3g} {unit}, while the other way is free for {other:.3g} {unit}.",
            remedy,
            value=free,
            limit=settings.shut * wanted,
            unit=unit,
        )
    elif case.closed_panel and outward < -settings.panel_inward:  # it does not open inwards, though nothing stops it
        message = f"{case.child} is a closed panel and the permitted motion turns it into {case.parent}."
        _doubt(result, case, message, remedy, value=outward, limit=-settings.panel_inward)


@check(
    "KV347",
    title="A slide stays with its parent",
    fails="A slide leaves its parent",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    follows={"KV321": CauseScope.JOINT, "KV320": CauseScope.JOINT},
)
def leaves_guides(result: OpenCheck, case: JointCase) -> None:
    """At the end of its range, a part that slides by more than its own length along the axis is not evidence.far_gap
    of the model's size farther away from its parent than at rest; beyond, it has left its guides.

    Why it matters: A drawer that travels twice its length hangs in the air.

    Remedy: Reduce the limits, for a drawer to about four fifths of its length.
    """
    joint, room = case.measures.joint, case.measures
    travel = max(abs(joint.lower), abs(joint.upper))
    limit = case.settings.far_gap * case.bodies.diagonal
    if not case.judged_alone or not case.measures.slides or room.parted <= limit or travel <= room.length:
        return
    _doubt(
        result,
        case,
        f"{case.child} travels by {travel:.3g} m, more than its own length of {room.length:.3g} m along the "
        f"axis, and is {room.parted:.3g} m away from {case.parent} at the end.",
        f"Reduce the range to about {0.8 * room.length:.3g} m, four fifths of its length.",
        value=room.parted,
        limit=limit,
        unit="m",
    )


@check(
    "KV348",
    title="The range is usual for such a part",
    fails="The range is unusual for such a part",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
)
def unusual_range(result: OpenCheck, case: JointCase) -> None:
    """No limited range is a whole turn, mostly to one side (evidence.whole_turn). Outside linkages, an upright panel
    opens by no more than evidence.widest_door, a level one by no more than evidence.widest_lid; a button that travels
    by more than evidence.button_travel of its own length is a note. Meshes do not hold designed stops, so this is
    experience.

    Why it matters: A robot that learns to open a door to twice its angle fails on the real one.

    Remedy: Correct the limit, or accept the finding with a reason.
    """
    joint, room, scene, settings = case.measures.joint, case.measures, case.measures.scene, case.settings
    span = max(abs(joint.lower), abs(joint.upper))
    if not case.judged_alone or not np.isfinite(span):
        return
    if not case.measures.slides and _turns_round(joint.lower, joint.upper, settings):
        turned = float(np.degrees(joint.upper - joint.lower))
        _doubt(
            result,
            case,
            f"{case.child} turns by {turned:.3g} deg, mostly to one side: that is more than a whole turn, so no stop "
            "can be there.",
            'Write type="continuous" if it turns without end; otherwise check the limits, and halve them if the '
            "range was doubled.",
            value=turned,
            limit=settings.whole_turn,
            unit="deg",
        )
    elif case.linkage:
        return
    elif case.measures.slides:
        if case.small and abs(room.outward) > settings.button_outward:
            _wide(result, case, "button", span / room.length, settings.button_travel)
    elif scene.panel and scene.upright:
        _wide(result, case, "door", float(np.degrees(span)), settings.widest_door)
    elif scene.panel and scene.flat:
        _wide(result, case, "lid", float(np.degrees(span)), settings.widest_lid)


def _turns_round(lower: float, upper: float, settings: EvidenceSettings) -> bool:
    """True if a range is a whole turn or more, mostly to one side; wrists go as far to both."""
    span = upper - lower
    return bool(np.degrees(span) >= settings.whole_turn and abs(lower + upper) > settings.lopsided * span)


def _wide(result: OpenCheck, case: JointCase, name: str, span: float, limit: float) -> None:
    """Tell a range [deg, or the length of the part] that is wide for such a part although nothing stops it."""
    unit = None if case.measures.slides else "deg"
    if span > limit:
        _doubt(
            result,
            case,
            f"{case.child} looks like a {name} and moves by {span:.3g} {unit or 'times its own length'} to one side; "
            f"such parts hardly ever move by more than {limit:.3g}.",
            "Check the limit, and halve it if the range was doubled; suppress the finding if it is meant.",
            severity=Severity.NOTE if case.measures.slides else Severity.WARNING,
            value=span,
            limit=limit,
            unit=unit,
        )


@check(
    "KV349",
    title="A part stays with what carries it along its line",
    fails="A part lifts off what carries it, and not about another line",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    feedback=FeedbackRow.LINE,
    doubts=True,
)
def contact_opens(result: OpenCheck, case: JointCase) -> None:
    """Where KV342, KV343 or KV344 doubt the line of a joint, its motion is held against that about the line that fits
    best: half of the places at which child and parent touch at rest do not get farther apart by evidence.opens of the
    child's size than they do about that other line (evidence.bearing_opens where both bodies are round about it,
    evidence.opens_across where it runs across), by visible geometry, over the declared range up to
    evidence.widest_turn or evidence.longest_slide.

    Why it matters: Bearings and guides do not let go of each other: an axis that is tilted, or beside the hinge, lifts
    the part off what carries it, and no engine complains.

    Remedy: Move the joint to the configuration that is named and look at the gap; align axis and origin with the
    line that keeps the contact.
    """
    if not case.opens or not (case.unexplained or case.misplaced or case.outdone) or case.opened is None:
        return
    own, other = case.opened
    joint = case.measures.joint
    value = joint.value + own.at
    where = f"{value:.3g} m" if case.measures.slides else f"{np.degrees(value):.3g} deg"
    result.find(
        f"{case.child} lifts off {case.parent}: at {where} of {joint.source}, half of where they touch at rest is "
        f"{own.width:.3g} m or more farther apart. About the line that fits best it is {max(other.width, 0.0):.3g} m.",
        case.instead,
        joint=joint.source,
        pair=(case.parent, case.child),
        q={joint.source: value},
        value=own.width,
        limit=max(other.width, 0.0),
        unit="m",
    )


def _doubt(
    result: OpenCheck,
    case: JointCase,
    message: str,
    remedy: str,
    *,
    value: float,
    limit: float,
    unit: str | None = None,
    severity: Severity = Severity.WARNING,
) -> None:
    """Add a finding against the declared joint."""
    joint = case.measures.joint
    result.find(
        message,
        remedy,
        severity=severity,
        joint=joint.source,
        q={joint.source: joint.value},
        value=value,
        limit=limit,
        unit=unit,
    )
