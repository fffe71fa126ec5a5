"""From findings to feedback: which decision each failure points to, as plain data (design section 5).

A failure seldom proves anything. Each signal carries a weight in log odds, the unit in which the inference adds up its
own evidence (`failure_rates` measures it), and the search decides. Failures that are not the search's to fix stay
findings; no collision is ever switched off.

Which row of the table (`FeedbackRow`) a finding belongs to stands at its check, here stands what each row does;
`docs/checks.md` shows the table.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.robot.joint_type import JointType
from kinematify.validation.check import FeedbackRow
from kinematify.validation.checks import CHECKS
from kinematify.validation.failure_rates import LINE, PARENT, RANGE, TYPE, shipped_rates
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from kinematify.robot.robot import Joint
    from kinematify.validation.failure_rates import FailureRates
    from kinematify.validation.finding import JointSummary, Observation


_OPEN_SHARE = 0.9  # a side that is free for half of the range only is no side to open to: a suitcase
"""A side that is free over this share of the range is the one that opens."""
_BACK_SHARE = 0.5  # drawers are modelled half open
"""A slide that leaves its guide, and whose way back is free over this share of its range, stands open."""
_FULL_TURN = 1.5708  # doors open by a right angle
"""Ranges of turning joints count up to this [rad]."""


@dataclass(frozen=True, kw_only=True)
class EdgeSignal:
    """Penalty of one part as the parent of another."""

    parent: str
    child: str
    weight: float
    """Log odds against this edge, positive."""
    check: str


@dataclass(frozen=True, kw_only=True)
class JointSignal:
    """Penalty of the line, axis and place, that the joint of a part has, or of its type."""

    child: str
    weight: float
    """Log odds against it, positive."""
    check: str
    error: bool
    """The check found an error, not only a warning."""


@dataclass(frozen=True, kw_only=True)
class RangeSignal:
    """End that the range of a joint must have; None leaves an end as it is."""

    child: str
    lower: float | None
    """[rad or m], about the declared axis."""
    upper: float | None
    lost: bool
    """Beyond the end the part has left its parent; otherwise it is blocked there."""
    check: str
    reason: str


@dataclass(frozen=True, kw_only=True)
class Feedback:
    """Penalties that the failures of one model put on the decisions behind it."""

    edges: tuple[EdgeSignal, ...] = ()
    lines: tuple[JointSignal, ...] = ()
    types: tuple[JointSignal, ...] = ()
    ranges: tuple[RangeSignal, ...] = ()

    def __bool__(self) -> bool:
        """True if the search has something to act on."""
        return bool(self.edges or self.lines or self.types or self.ranges)

    def against(self, child: str) -> float:
        """Log odds against the joint of a part, parent omitted.

        Of each check its worst finding counts, once; what two engines find of a joint is one failure.
        """
        return max(_worst_of_each(self.lines, child), _worst_of_each(self.types, child))

    def has_error(self, child: str) -> bool:
        """True if an error, not only warnings, speaks against the joint of a part."""
        return any(item.error for item in (*self.lines, *self.types) if item.child == child)


def only_collision_meets(finding: Observation) -> bool:
    """True if the exact geometry saw no visible parts meet, so that nothing speaks against the joint."""
    return finding.cause is Cause.PHYSICS and finding.check.startswith("KV3")


def _worst_of_each(signals: Iterable[JointSignal], child: str) -> float:
    worst: dict[str, float] = {}
    for signal in signals:
        if signal.child == child:
            worst[signal.check] = max(signal.weight, worst.get(signal.check, 0.0))
    return sum(worst.values())


def feedback_from(
    findings: Sequence[Observation],
    summaries: Iterable[JointSummary],
    joints: Mapping[str, Joint],
    *,
    rates: FailureRates | None = None,
) -> Feedback:
    """Turn the findings about one model into feedback.

    Args:
        findings: All of them, in any order.
        summaries: Free travel of the joints, where it was measured.
        joints: The joints of the model by name.
        rates: How often each failure occurs, which is what it weighs; the shipped ones if absent.
    """
    travel = {item.joint: item.free_travel for item in summaries if item.free_travel is not None}
    case = _Case(
        findings=findings,
        travel=travel,
        joints=joints,
        rates=rates or shipped_rates(),
    )
    for finding in findings:
        _route(case, finding)
    return Feedback(
        edges=tuple(case.edges),
        lines=tuple(case.lines),
        types=tuple(case.types),
        ranges=tuple(case.ranges),
    )


@dataclass(kw_only=True)
class _Case:
    """Findings of one model with what is known of its joints, and the signals so far."""

    findings: Sequence[Observation]
    travel: Mapping[str, tuple[float, float]]
    joints: Mapping[str, Joint]
    rates: FailureRates
    edges: list[EdgeSignal] = field(default_factory=list)
    lines: list[JointSignal] = field(default_factory=list)
    types: list[JointSignal] = field(default_factory=list)
    ranges: list[RangeSignal] = field(default_factory=list)

    def has(self, *checks: str, joint: str | None = None) -> bool:
        """True if one of the checks found something that counts, of one joint if it is given."""
        return any(
            item.check in checks and item.severity is not Severity.NOTE and (joint is None or item.joint == joint)
            for item in self.findings
        )

    def against(self, finding: Observation, joint: Joint, *, parent_only: bool = False) -> None:
        """Add penalties of the parent of a joint, and of its line and type, where the failure is more frequent."""
        weights = {what: self.rates.weight(finding.check, finding.severity, what) for what in (LINE, TYPE, PARENT)}
        for what, signals in ((LINE, self.lines), (TYPE, self.types)):
            if weights[what] > 0.0 and not parent_only:
                signal = JointSignal(
                    child=joint.child,
                    weight=weights[what],
                    check=finding.check,
                    error=finding.severity is Severity.ERROR,
                )
                signals.append(signal)
        if weights[PARENT] > 0.0:
            edge = EdgeSignal(parent=joint.parent, child=joint.child, weight=weights[PARENT], check=finding.check)
            self.edges.append(edge)

    def end(
        self,
        finding: Observation,
        joint: Joint,
        ends: tuple[float | None, float | None],
        reason: str,
        *,
        lost: bool = False,
    ) -> None:
        """Add a signal about where the range of a joint ends, if the failure is more frequent where it is wrong."""
        if self.rates.weight(finding.check, finding.severity, RANGE) > 0.0:
            lower, upper = ends
            self.ranges.append(
                RangeSignal(
                    child=joint.child,
                    lower=lower,
                    upper=upper,
                    lost=lost,
                    check=finding.check,
                    reason=reason,
                )
            )


def _route(case: _Case, finding: Observation) -> None:
    """Hand a finding to the row of the table that it belongs to; what only collision geometry causes has none."""
    row = CHECKS[finding.check].feedback
    if finding.severity is Severity.NOTE or only_collision_meets(finding):
        return
    if row in _ROWS and finding.joint is not None and finding.joint in case.joints:
        _ROWS[row](case, finding, case.joints[finding.joint])


# ---- the rows of the table -----------------------------------------------------------------------------------------


def _into_parent(case: _Case, finding: Observation, joint: Joint) -> None:
    """KV310: to both sides the line is wrong, to one side only the direction."""
    low, high = _free(case, finding)
    way = joint.upper - joint.lower
    if joint.kind.turns:
        way = min(way, _FULL_TURN)
    if max(-low, high) >= _OPEN_SHARE * way:
        ends = max(low, -way), min(high, way)
        case.end(finding, joint, ends, "to the other side it is free: it opens there")
    else:  # blocked to both sides at once
        case.against(finding, joint)


def _end_there(case: _Case, finding: Observation, joint: Joint) -> None:
    """KV312: to one side, the range ends where the way does."""
    low, high = _free(case, finding)
    ends = low if joint.lower < low else None, high if high < joint.upper else None
    case.end(finding, joint, ends, "its way is blocked there")


def _into_others(case: _Case, finding: Observation, joint: Joint) -> None:
    """KV311: what a part meets besides its parent may be what carries it, or its carrier moves it into that."""
    pair = finding.pair or ()
    if joint.child in pair and set(pair) - {joint.child, joint.parent}:
        case.against(finding, joint, parent_only=True)
        return
    carried = next((item for item in case.joints.values() if item.child in pair and item.parent == joint.child), None)
    if carried is not None:  # else what the joint carries farther out meets others
        case.against(finding, carried, parent_only=True)


def _not_carried(case: _Case, finding: Observation, joint: Joint) -> None:
    """KV303: no contact supports the part there."""
    case.against(finding, joint, parent_only=True)


def _derailed(case: _Case, finding: Observation, joint: Joint) -> None:
    """KV320: what leaves its parent runs along the wrong line or moves in the wrong way, or too far."""
    if case.has("KV321", joint=finding.joint):
        return  # a slide with a guide goes too far along the right line
    case.against(finding, joint)
    if joint.kind is JointType.PRISMATIC and finding.value is not None and finding.limit is not None:
        upwards, share = _upwards(finding), finding.limit / max(finding.value, finding.limit)
        end = share * (joint.upper if upwards else joint.lower)
        ends = (None, end) if upwards else (end, None)
        case.end(finding, joint, ends, "beyond it it has left its parent", lost=True)


def _out_of_guide(case: _Case, finding: Observation, joint: Joint) -> None:
    """KV321: the range ends at the stated share of the guide; where the way back is free, the part stands open."""
    end = finding.limit
    if end is None:
        return
    low, high = _free(case, finding)
    way = joint.upper - joint.lower
    upwards = _upwards(finding)
    back = low if upwards else high
    stands_open = abs(back) >= _BACK_SHARE * way
    reason = "beyond it the guide has ended" + ("; it is open, and the range back is free" if stands_open else "")
    other = min(abs(back), way) if stands_open else None
    if upwards:
        case.end(finding, joint, (None if other is None else -other, end), reason, lost=True)
    else:
        case.end(finding, joint, (-end, other), reason, lost=True)


def _upwards(finding: Observation) -> bool:
    """True if the joint was above zero where the failure was seen."""
    return (finding.q or {}).get(finding.joint or "", 0.0) >= 0.0


_ROWS: dict[FeedbackRow | None, Callable[[_Case, Observation, Joint], None]] = {
    FeedbackRow.INTO_PARENT: _into_parent,
    FeedbackRow.END: _end_there,
    FeedbackRow.OTHER_PARENT: _into_others,
    FeedbackRow.NOT_CARRIED: _not_carried,
    FeedbackRow.DERAILED: _derailed,
    FeedbackRow.GUIDE: _out_of_guide,
}


def _free(case: _Case, finding: Observation) -> tuple[float, float]:
    """Range around zero in which nothing meets [rad or m]; (0, 0) where it was not measured."""
    return case.travel.get(finding.joint or "", (0.0, 0.0))
