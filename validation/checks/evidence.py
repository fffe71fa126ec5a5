"""From figures to doubts: which of them speak against a declared joint, how badly, and what would fit better.

What geometry proves is an error, what it only makes unlikely a warning: people build doors that no rule has seen.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.config.validation import EvidenceSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.validation.evidence.bodies import Bodies
    from kinematify.validation.evidence.measure import JointMeasures

PARENT, DIRECTION, PLACE, FIT = "KV341", "KV342", "KV343", "KV344"
TYPE, OPENING, TRAVEL, RANGE = "KV345", "KV346", "KV347", "KV348"

_LINKAGE = 0.5  # `JointScene.mechanism` from which a pair belongs to a linkage rather than to furniture
_SMALL = 0.5  # `JointScene.smallness` from which a part is a button or knob


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """Why one check does not believe in a declared joint."""

    check: str
    severity: Severity
    message: str
    remedy: str
    value: float
    limit: float
    unit: str | None


@dataclass(frozen=True, kw_only=True, eq=False)
class Alternative:
    """A joint that explains the contact better than the declared one."""

    kind: JointType
    axis: FloatArray
    """Unit direction, world frame at rest, shape (3,)."""
    pivot: FloatArray
    """A point on the axis, world frame at rest [m], shape (3,)."""
    score: float
    """By how much it leads over the declared joint."""


@dataclass(frozen=True, kw_only=True)
class _Case:
    """One joint before its judges."""

    bodies: Bodies
    measures: JointMeasures
    settings: EvidenceSettings

    @property
    def linkage(self) -> bool:
        """The pair belongs to a machine, not to furniture."""
        return self.measures.weighed.scene.mechanism > _LINKAGE

    @property
    def small(self) -> bool:
        """The child is a button, a knob or a lever."""
        return self.measures.weighed.scene.smallness > _SMALL

    @property
    def parent(self) -> str:
        """Name of the body that carries the joint."""
        return self.bodies.links[self.measures.joint.parent]

    @property
    def child(self) -> str:
        """Name of the body that moves."""
        return self.bodies.links[self.measures.joint.child]


def doubts_about(bodies: Bodies, measures: JointMeasures, settings: EvidenceSettings) -> tuple[Doubt, ...]:
    """Everything that speaks against a declared joint, in the order of the checks.

    A joint with the wrong parent is judged no further, and where several joints in series share one contact only what
    holds for each of them is.
    """
    case = _Case(bodies=bodies, measures=measures, settings=settings)
    parent = _parent(case)
    if parent is not None:
        return (parent,)
    judges: list[Callable[[_Case], Doubt | None]] = [_direction, _place]
    if measures.alone:
        judges += [_fit, _type, _opening, _travel, _range]
    found = [doubt for judge in judges if (doubt := judge(case)) is not None]
    unexplained = any(doubt.check == DIRECTION for doubt in found)
    # One cause, one finding: a direction that nothing shows has no place, and of course another one fits better.
    return tuple(doubt for doubt in found if not unexplained or doubt.check not in (PLACE, FIT))


def better_joint(measures: JointMeasures, doubts: tuple[Doubt, ...]) -> Alternative | None:
    """The joint that the geometry speaks for instead; None where it does not speak against the declared one."""
    checks = {doubt.check for doubt in doubts}
    if not checks & {DIRECTION, PLACE, FIT, TYPE}:
        return None
    line = measures.line
    if TYPE not in checks:
        kind = JointType.PRISMATIC if measures.slides else JointType.REVOLUTE
        return Alternative(kind=kind, axis=line.best_axis, pivot=line.best_pivot, score=line.deficit)
    turns, slides, score = measures.weighed.turns.proposed, measures.weighed.slides.proposed, measures.odds_against
    if measures.slides:
        return Alternative(kind=JointType.REVOLUTE, axis=turns.lines.axes[0], pivot=turns.lines.pivots[0], score=score)
    return Alternative(kind=JointType.PRISMATIC, axis=slides.axes[0], pivot=measures.anchor, score=score)


# ---- the judges, in the order of the checks --------------------------------------------------------------------------


def _parent(case: _Case) -> Doubt | None:
    found, limit = case.measures.parent, case.settings.weak_contact
    if found.best is None or found.best_quality <= 0.0:
        return None
    other = case.bodies.links[found.best]
    remedy = f"Make {other} the parent, or mend the pose or the meshes of {case.child} and {case.parent}."
    if not found.touches:
        apart = found.gap * case.bodies.diagonal
        return Doubt(
            check=PARENT,
            severity=Severity.ERROR if found.gap > case.settings.far_gap else Severity.WARNING,
            message=f"{case.child} does not touch {case.parent}, which carries it (they are {apart:.3g} m apart), but "
            f"it touches {other}.",
            remedy=remedy,
            value=apart,
            limit=case.bodies.graph.tolerance,
            unit="m",
        )
    share = found.quality / found.best_quality
    if share >= limit:
        return None
    return Doubt(
        check=PARENT,
        severity=Severity.WARNING,
        message=f"The contact of {case.child} with {case.parent}, which carries it, is far weaker than that with "
        f"{other}: {share:.0%} of its quality.",
        remedy=remedy,
        value=share,
        limit=limit,
        unit=None,
    )


def _direction(case: _Case) -> Doubt | None:
    line, settings = case.measures.line, case.settings
    if not case.measures.parent.touches or line.angle <= settings.unknown_deg:
        return None
    certain = line.angle > settings.wrong_deg and line.deficit > settings.clearly_better and case.measures.alone
    return Doubt(
        check=DIRECTION,
        severity=Severity.ERROR if certain else Severity.WARNING,
        message=f"The axis runs {line.angle:.1f} deg off every direction that {case.child} and {case.parent} show: "
        "their edges, faces, round surfaces and where they touch.",
        remedy=_instead(case),
        value=line.angle,
        limit=settings.unknown_deg,
        unit="deg",
    )


def _place(case: _Case) -> Doubt | None:
    line, settings = case.measures.line, case.settings
    limit = settings.linkage_distance if case.linkage else settings.unknown_distance
    if case.measures.slides or not case.measures.parent.touches or line.distance <= limit:
        return None
    size = case.measures.weighed.scene.frame.diagonal
    far = f"{line.distance * size:.3g} m" if np.isfinite(line.distance) else "far"
    return Doubt(
        check=PLACE,
        severity=Severity.WARNING,
        message=f"The axis runs {far} beside every line along its direction that {case.child} and {case.parent} show "
        f"as a hinge ({case.child} is {size:.3g} m large).",
        remedy=_instead(case),
        value=line.distance * size if np.isfinite(line.distance) else size,
        limit=limit * size,
        unit="m",
    )


def _fit(case: _Case) -> Doubt | None:
    line, settings = case.measures.line, case.settings
    limit = _better(case)
    if line.deficit <= limit or _supported(case):
        return None
    if case.linkage and not (_contradicted(case) or _blocked(case) > settings.blocked):
        return None
    return Doubt(
        check=FIT,
        severity=Severity.WARNING,
        message=f"Another joint of the same type explains the contact of {case.child} and {case.parent} clearly "
        f"better: its score leads by {line.deficit:.2g}.",
        remedy=_instead(case),
        value=line.deficit,
        limit=limit,
        unit=None,
    )


def _better(case: _Case) -> float:
    settings = case.settings
    if case.linkage:
        return settings.linkage_better
    return settings.better_slide if case.measures.slides else settings.better


def _supported(case: _Case) -> bool:
    """Both bodies are round about the declared line about as clearly as about any: then no habit speaks against it."""
    measures = case.measures
    return measures.own_bearing > max(case.settings.bearing_score, 0.5 * measures.bearing)


def _contradicted(case: _Case) -> bool:
    """Both bodies are beyond doubt round about another line."""
    own = max(case.measures.own_bearing, 1e-4)
    return case.measures.weighed.scene.has_bearing and case.measures.bearing > case.settings.bearing_lead * own


def _blocked(case: _Case) -> float:
    """Share of the declared range in which the parent is in the way, of as much of it as was swept."""
    joint, room = case.measures.joint, case.measures.room
    upper, lower = min(max(joint.upper, 0.0), room.reach), min(max(-joint.lower, 0.0), room.reach)
    missing = max(upper - room.forward, 0.0) + max(lower - room.backward, 0.0)
    return missing / max(upper + lower, 1e-12)


def _type(case: _Case) -> Doubt | None:
    measures, settings = case.measures, case.settings
    odds = measures.odds_against
    if odds <= settings.type_odds or not _type_open(case):
        return None
    declared, other = ("slide", "turn") if measures.slides else ("turn", "slide")
    cues = {name: value for name, value in measures.weighed.decision.cues.items() if value > 0.0}
    return Doubt(
        check=TYPE,
        severity=Severity.WARNING,
        message=f"{case.child} is declared to {declared} on {case.parent}, but its shape and room speak for a part "
        f"that {other}s (log odds {odds:.1f}; {', '.join(cues) or 'no cue for either'}).",
        remedy=f"Check the type: written as {'revolute' if measures.slides else 'prismatic'} it would fit. "
        + _instead(case, other_type=True),
        value=odds,
        limit=settings.type_odds,
        unit="log odds",
    )


def _type_open(case: _Case) -> bool:
    """False where the odds are no more than habit: few joints of linkages slide, but those that do are meant to.

    They count against a slide only where something else does too: a bearing, a better slide, a parent in the way. Nor
    does anybody write that a part turns without end by mistake.
    """
    if case.measures.joint.kind is JointType.CONTINUOUS:
        return False
    if not case.linkage or not case.measures.slides:
        return True
    better = case.measures.line.deficit > case.settings.better_slide
    return better or case.measures.weighed.scene.has_bearing or _blocked(case) > case.settings.blocked


def _opening(case: _Case) -> Doubt | None:
    joint, room, settings = case.measures.joint, case.measures.room, case.settings
    short, long = sorted((abs(joint.lower), abs(joint.upper)))
    if not np.isfinite(long) or short >= settings.one_sided * long:
        return None
    forward = abs(joint.upper) > abs(joint.lower)
    free, other = (room.forward, room.backward) if forward else (room.backward, room.forward)
    outward = room.outward if forward else -room.outward
    wanted = min(long, room.reach)
    unit = "m" if case.measures.slides else "rad"
    remedy = "Turn the axis round (or swap the limits with their signs), so that the permitted motion opens."
    if case.measures.slides and case.small and not case.linkage:
        # Pressed parts sink into what they stand on: only the way out is wrong.
        return _button_opening(case, outward, remedy)
    if free >= settings.shut * wanted or other <= settings.open * wanted:
        return _panel_opening(case, outward, remedy)
    return Doubt(
        check=OPENING,
        severity=Severity.WARNING,
        message=f"The permitted motion of {case.child} leads into {case.parent} after {free:.3g} {unit} of "
        f"{long:.3g} {unit}, while the other way is free for {other:.3g} {unit}.",
        remedy=remedy,
        value=free,
        limit=settings.shut * wanted,
        unit=unit,
    )


def _panel_opening(case: _Case, outward: float, remedy: str) -> Doubt | None:
    """A closed door or lid that nothing stops still does not open into its body."""
    limit = -case.settings.panel_inward
    closed = case.measures.weighed.scene.panel and not case.measures.room.ajar
    if case.measures.slides or case.linkage or not closed or outward >= limit:
        return None
    return Doubt(
        check=OPENING,
        severity=Severity.WARNING,
        message=f"{case.child} is a closed panel and the permitted motion turns it into {case.parent}.",
        remedy=remedy,
        value=outward,
        limit=limit,
        unit=None,
    )


def _button_opening(case: _Case, outward: float, remedy: str) -> Doubt | None:
    limit = case.settings.button_outward
    if outward <= limit:
        return None
    return Doubt(
        check=OPENING,
        severity=Severity.WARNING,
        message=f"{case.child} is a small part on {case.parent} and moves out of it; buttons go in.",
        remedy=remedy,
        value=outward,
        limit=limit,
        unit=None,
    )


def _travel(case: _Case) -> Doubt | None:
    joint, room = case.measures.joint, case.measures.room
    travel = max(abs(joint.lower), abs(joint.upper))
    limit = case.settings.far_gap * case.bodies.diagonal
    if not case.measures.slides or room.parted <= limit or travel <= room.length:
        return None
    return Doubt(
        check=TRAVEL,
        severity=Severity.WARNING,
        message=f"{case.child} travels by {travel:.3g} m, more than its own length of {room.length:.3g} m along the "
        f"axis, and is {room.parted:.3g} m away from {case.parent} at the end.",
        remedy=f"Reduce the range to about {0.8 * room.length:.3g} m, four fifths of its length.",
        value=room.parted,
        limit=limit,
        unit="m",
    )


def _range(case: _Case) -> Doubt | None:
    """What is wide for such a part although nothing stops it."""
    joint, room, scene, settings = case.measures.joint, case.measures.room, case.measures.weighed.scene, case.settings
    span = max(abs(joint.lower), abs(joint.upper))
    if not np.isfinite(span):
        return None
    if not case.measures.slides and _turns_round(joint.lower, joint.upper, settings):
        return _round(case, float(np.degrees(joint.upper - joint.lower)))
    if case.linkage:
        return None
    if case.measures.slides:
        pressed = case.small and abs(room.outward) > settings.button_outward
        return _wide(case, "button", span, settings.button_travel * room.length, "m") if pressed else None
    if not scene.panel or not (scene.upright or scene.flat):
        return None
    name, limit = ("door", settings.widest_door) if scene.upright else ("lid", settings.widest_lid)
    return _wide(case, name, float(np.degrees(span)), limit, "deg")


def _turns_round(lower: float, upper: float, settings: EvidenceSettings) -> bool:
    """Whether a range is a whole turn or more, mostly to one side; wrists go as far to both."""
    span = upper - lower
    return bool(np.degrees(span) >= settings.whole_turn and abs(lower + upper) > settings.lopsided * span)


def _round(case: _Case, span: float) -> Doubt:
    return Doubt(
        check=RANGE,
        severity=Severity.WARNING,
        message=f"{case.child} turns by {span:.3g} deg, mostly to one side: that is more than a whole turn, so no stop "
        "can be there.",
        remedy='Write type="continuous" if it turns without end; otherwise check the limits, and halve them if the '
        "range was doubled.",
        value=span,
        limit=case.settings.whole_turn,
        unit="deg",
    )


def _wide(case: _Case, name: str, span: float, limit: float, unit: str) -> Doubt | None:
    if span <= limit:
        return None
    return Doubt(
        check=RANGE,
        severity=Severity.WARNING,
        message=f"{case.child} looks like a {name} and moves by {span:.3g} {unit} to one side; such parts hardly ever "
        f"move by more than {limit:.3g} {unit}.",
        remedy="Check the limit, and halve it if the range was doubled; suppress the finding if it is meant.",
        value=span,
        limit=limit,
        unit=unit,
    )


def _instead(case: _Case, *, other_type: bool = False) -> str:
    if other_type:
        return "The report names the joint that fits best."
    line = case.measures.line
    axis = ", ".join(f"{value:.3f}" for value in line.best_axis)
    where = "" if case.measures.slides else " through (" + ", ".join(f"{value:.3f}" for value in line.best_pivot) + ")"
    return f"Best candidate in the world frame at rest: axis ({axis}){where}."
