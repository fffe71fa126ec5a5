"""KV344 to KV349: does the geometry of two links explain the joint between them?

KV344 is an opinion and always a note, for people build doors that no rule has seen. It is asked only of joints that a
sweep doubts or whose contact opens, for it takes most of the time. One cause, one finding: a joint with the wrong
parent is judged no further, and where several joints in series share one contact only what holds for each of them is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.check import CauseScope, check
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.config.validation import EvidenceSettings
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.joint_case import JointCase

_SWEPT = ("KV310", "KV311", "KV312", "KV320")
"""What exact sweeps measure of one joint: with a part that lifts off, two facts about one axis, and an error."""


@check(
    "KV344",
    title="The shapes suggest no other joint",
    fails="The shapes suggest another joint",
    severity=Severity.NOTE,
    cause=Cause.KINEMATICS,
    follows={"KV303": CauseScope.JOINT},
)
def shapes_suggest_another(result: OpenCheck, case: JointCase) -> None:
    """What the inference holds of a joint that a sweep doubts or whose contact opens; the first of these that is not so
    is the note. The child touches the body that carries it, with evidence.weak_contact of the quality of its best
    other contact. Of the line, unless KV349 finds a better one: it runs within evidence.unknown_deg of a direction that
    the two bodies show, within evidence.unknown_distance of the child's size (in linkages evidence.linkage_distance)
    of a hinge that they show, and no other line is likelier by evidence.better (in linkages evidence.linkage_better
    with a bearing, or a parent in the way). The other type has log odds below evidence.type_odds. No ground truth is
    needed: people build along what they build.

    Why it matters: People build what no rule has seen, so this is no fault; but where it is one, nothing else names
    what to write.

    Remedy: Compare with the joint that the note names; where it is right, correct parent, type, axis or origin.
    """
    found = _suggested(case) if case.examined else None
    if found is not None:
        joint = case.measures.joint
        said = f"The shapes suggest otherwise, though nothing measured does: {found[0]}"
        result.find(said, found[1], joint=joint.source, q={joint.source: joint.value})


def _suggested(case: JointCase) -> tuple[str, str] | None:
    """Return what the shapes hold against the joint, and what to do."""
    measures, child, parent = case.measures, case.child, case.parent
    if case.hangs_elsewhere and measures.parent.best is not None:
        other, share = case.bodies[measures.parent.best], case.share_of_contact
        return (
            f"{child} touches {other} far better than {parent}, which carries it ({share:.0%} of the quality).",
            f"Make {other} the parent, or fix the pose or the meshes of {child} and {parent}.",
        )
    if case.doubts_line and case.opened is None:
        size, shown = measures.size, f"{child} and {parent} show"
        away = measures.distance * size if np.isfinite(measures.distance) else size
        if case.unexplained:
            message = f"the axis runs {measures.angle:.1f} deg off every direction that {shown}."
        elif case.misplaced:
            message = f"the axis runs {away:.3g} m beside every line along its direction that {shown} as a hinge."
        else:
            message = f"another line is {min(np.exp(measures.deficit), 1e4):.0f} times as likely by what {shown}."
        return message, case.instead
    if case.doubts_type:
        declared, other = ("slide", "turn") if measures.slides else ("turn", "slide")
        return (
            f"{child} is declared to {declared} on {parent}, but its shape and room speak for a part that {other}s.",
            "Check the type. The report names the joint that fits best.",
        )
    return None


@check(
    "KV348",
    title="The range is usual for such a part",
    fails="The range is unusual for such a part",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
)
def unusual_range(result: OpenCheck, case: JointCase) -> None:
    """No limited range is a whole turn, mostly to one side (evidence.whole_turn). Outside linkages, an upright panel
    opens by no more than evidence.widest_door, a level one by no more than evidence.widest_lid. Meshes do not hold
    designed stops, so this is experience.

    Why it matters: A robot that learns to open a door to twice its angle fails on the real one.

    Remedy: Correct the limit, or accept the finding with a reason.
    """
    joint, settings = case.measures.joint, case.settings
    span = float(np.degrees(max(abs(joint.lower), abs(joint.upper))))
    if not np.isfinite(span):
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
    elif case.measures.slides or span <= min(settings.widest_door, settings.widest_lid) or case.linkage:
        return
    elif (scene := case.measures.scene).panel and scene.upright:
        _wide(result, case, "door", span, settings.widest_door)
    elif scene.panel and scene.flat:
        _wide(result, case, "lid", span, settings.widest_lid)


def _turns_round(lower: float, upper: float, settings: EvidenceSettings) -> bool:
    """True if a range is a whole turn or more, mostly to one side; wrists go as far to both."""
    span = upper - lower
    return bool(np.degrees(span) >= settings.whole_turn and abs(lower + upper) > settings.lopsided * span)


def _wide(result: OpenCheck, case: JointCase, name: str, span: float, limit: float) -> None:
    """Report a range [deg] that is wide for such a part although nothing stops it."""
    if span > limit:
        _doubt(
            result,
            case,
            f"{case.child} looks like a {name} and moves by {span:.3g} deg to one side; such parts hardly ever move by "
            f"more than {limit:.3g}.",
            "Check the limit, and halve it if the range was doubled; suppress the finding if it is meant.",
            value=span,
            limit=limit,
            unit="deg",
        )


@check(
    "KV349",
    title="A part stays with what carries it along its line",
    fails="A part lifts off what carries it, and not about another line",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    doubts=True,
)
def contact_opens(result: OpenCheck, case: JointCase) -> None:
    """Where KV344 doubts the line of a joint, its motion is held against that about the line that fits
    best: half of the places at which child and parent touch at rest do not get farther apart by evidence.opens of the
    child's size than they do about that other line (evidence.bearing_opens where both bodies are round about it,
    evidence.opens_across where it runs across), by visible geometry, over the declared range up to
    evidence.widest_turn or evidence.longest_slide.

    Why it matters: Bearings and guides do not let go of each other: an axis that is tilted, or beside the hinge, lifts
    the part off what carries it, and no engine complains.

    Remedy: Move the joint to the configuration that is named and look at the gap; align axis and origin with the
    line that keeps the contact.
    """
    if not case.opens or not case.doubts_line or case.opened is None:
        return
    (own, at), (other, _) = case.opened
    joint = case.measures.joint
    swept = [check for check in (case.doubted or {}).get(joint.source, ()) if check in _SWEPT]
    also = f" Its sweep speaks against the same line ({', '.join(swept)})." if swept else ""
    value = joint.value + at
    where = f"{value:.3g} m" if case.measures.slides else f"{np.degrees(value):.3g} deg"
    result.find(
        f"{case.child} lifts off {case.parent}: at {where} of {joint.source}, half of where they touch at rest is "
        f"{own:.3g} m or more farther apart. About the line that fits best it is {max(other, 0.0):.3g} m."
        f"{also}",
        case.instead,
        severity=Severity.ERROR if swept else None,
        joint=joint.source,
        pair=(case.parent, case.child),
        q={joint.source: value},
        value=own,
        limit=max(other, 0.0),
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
) -> None:
    """Add a finding against the declared joint, if the contact tells of it alone."""
    if not case.judged_alone:
        return
    joint = case.measures.joint
    result.find(
        message,
        remedy,
        joint=joint.source,
        q={joint.source: joint.value},
        value=value,
        limit=limit,
        unit=unit,
    )
