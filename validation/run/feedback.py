"""From findings to feedback: which decision each failure points to, as plain data (design section 5).

A failure seldom proves anything. Each signal carries a weight in log odds, the unit in which the inference adds up its
own evidence (`failure_rates` measures it), and the search decides. Failures that are not the search's to fix are
listed with the reason, so that nothing is dropped in silence; above all, no collision is ever switched off.

Which row of the table (`FeedbackRow`) a finding belongs to stands at its check, here stands what each row does;
`docs/checks.md` shows the table.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from kinematify.robot.joint_type import JointType
from kinematify.validation.check import FeedbackRow
from kinematify.validation.checks import CHECKS
from kinematify.validation.failure_rates import LINE, PARENT, RANGE, TYPE, shipped_rates
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from kinematify.config import FeedbackConfig
    from kinematify.robot.robot import Joint
    from kinematify.validation.failure_rates import FailureRates
    from kinematify.validation.finding import Finding
    from kinematify.validation.summary import JointSummary


@dataclass(frozen=True, kw_only=True)
class EdgeSignal:
    """Against one part as the parent of another, and for a third one if it is known."""

    parent: str
    child: str
    weight: float
    """Log odds against this edge, positive."""
    better: str | None
    """Part that the child should hang on instead."""
    check: str
    reason: str


@dataclass(frozen=True, kw_only=True)
class JointSignal:
    """Against the line, axis and place, that the joint of a part has, or against its type."""

    child: str
    weight: float
    """Log odds against it, positive."""
    check: str
    reason: str
    at: float | None
    """Value of the joint at which it failed [rad or m], if one is known."""
    error: bool
    """The check found an error, not only a warning."""


@dataclass(frozen=True, kw_only=True)
class RangeSignal:
    """Where the range of a joint has to end; None leaves an end as it is."""

    child: str
    lower: float | None
    """[rad or m], about the declared axis."""
    upper: float | None
    lost: bool
    """Beyond the end the part has left its parent; otherwise it is blocked there."""
    weight: float
    """Log odds against the range as it is, positive."""
    check: str
    reason: str


@dataclass(frozen=True, kw_only=True)
class UnfixableFinding:
    """A failure that no choice of the search can fix, and who can."""

    check: str
    joint: str | None
    cause: str
    reason: str


@dataclass(frozen=True, kw_only=True)
class Feedback:
    """Feedback of the failures of one model on the decisions behind it."""

    edges: tuple[EdgeSignal, ...] = ()
    lines: tuple[JointSignal, ...] = ()
    types: tuple[JointSignal, ...] = ()
    ranges: tuple[RangeSignal, ...] = ()
    left: tuple[UnfixableFinding, ...] = ()

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

    def failed_at(self, child: str) -> frozenset[float]:
        """Values of the joint of a part at which it failed for its line or its type [rad or m]."""
        signals = (*self.lines, *self.types)
        return frozenset(item.at for item in signals if item.child == child and item.at is not None)

    def as_json(self) -> dict[str, Any]:
        """JSON values."""
        return asdict(self)


def only_collision_meets(finding: Finding) -> bool:
    """True if the exact geometry saw no visible parts meet, so that nothing speaks against the joint."""
    return finding.cause is Cause.PHYSICS and finding.check.startswith("KV3")


def _worst_of_each(signals: Iterable[JointSignal], child: str) -> float:
    worst: dict[str, float] = {}
    for signal in signals:
        if signal.child == child:
            worst[signal.check] = max(signal.weight, worst.get(signal.check, 0.0))
    return sum(worst.values())


def feedback_from(
    findings: Sequence[Finding],
    summaries: Iterable[JointSummary],
    joints: Mapping[str, Joint],
    config: FeedbackConfig,
    *,
    placements: Mapping[str, float] | None = None,
    rates: FailureRates | None = None,
) -> Feedback:
    """Turn the findings about one model into feedback.

    Args:
        findings: All of them, in any order; suppressed ones do not count.
        summaries: Free travel of the joints, where it was measured.
        joints: The joints of the model by name.
        config: How failures are read.
        placements: How many places of a robot were tried for each joint, if there was a task.
        rates: How often each failure occurs, which is what it weighs; the shipped ones if absent.
    """
    travel = {item.joint: item.free_travel for item in summaries if item.free_travel is not None}
    case = _Case(
        findings=findings,
        travel=travel,
        joints=joints,
        config=config,
        placements=placements or {},
        rates=rates or shipped_rates(),
    )
    for finding in findings:
        if finding.suppressed is None:
            _route(case, finding)
    return Feedback(
        edges=tuple(case.edges),
        lines=tuple(case.lines),
        types=tuple(case.types),
        ranges=tuple(case.ranges),
        left=tuple(case.left),
    )


@dataclass(kw_only=True)
class _Case:
    """Findings of one model with what is known of its joints, and the signals so far."""

    findings: Sequence[Finding]
    travel: Mapping[str, tuple[float, float]]
    joints: Mapping[str, Joint]
    config: FeedbackConfig
    placements: Mapping[str, float]
    rates: FailureRates
    edges: list[EdgeSignal] = field(default_factory=list)
    lines: list[JointSignal] = field(default_factory=list)
    types: list[JointSignal] = field(default_factory=list)
    ranges: list[RangeSignal] = field(default_factory=list)
    left: list[UnfixableFinding] = field(default_factory=list)

    def has(self, *checks: str, joint: str | None = None) -> bool:
        """True if one of the checks found something that counts, of one joint if it is given."""
        return any(
            item.check in checks and item.severity is not Severity.NOTE and (joint is None or item.joint == joint)
            for item in self.findings
        )

    def against_line(self, finding: Finding, joint: Joint, reason: str) -> None:
        """Add a signal against the line of a joint, if the failure is more frequent where it is wrong."""
        self._against(self.lines, LINE, finding, joint, reason)

    def against_type(self, finding: Finding, joint: Joint, reason: str) -> None:
        """The same of its type: sliding where it turns, turning where it slides."""
        self._against(self.types, TYPE, finding, joint, reason)

    def _against(self, signals: list[JointSignal], what: str, finding: Finding, joint: Joint, reason: str) -> None:
        weight = self.rates.weight(finding.check, finding.severity, what)
        if weight > 0.0:
            signals.append(
                JointSignal(
                    child=joint.child,
                    weight=weight,
                    check=finding.check,
                    reason=reason,
                    at=(finding.q or {}).get(joint.name),
                    error=finding.severity is Severity.ERROR,
                )
            )

    def against_parent(self, finding: Finding, joint: Joint, reason: str, better: str | None = None) -> None:
        """Add a signal against the parent of a part, if the failure is more frequent where it is wrong."""
        weight = self.rates.weight(finding.check, finding.severity, PARENT)
        if weight > 0.0:
            self.edges.append(
                EdgeSignal(
                    parent=joint.parent,
                    child=joint.child,
                    weight=weight,
                    better=better,
                    check=finding.check,
                    reason=reason,
                )
            )

    def against_all(self, finding: Finding, joint: Joint, reason: str) -> None:
        """Add signals against the line, the type and the parent of a joint."""
        self.against_line(finding, joint, reason)
        self.against_type(finding, joint, reason)
        self.against_parent(finding, joint, reason)

    def end(
        self,
        finding: Finding,
        joint: Joint,
        ends: tuple[float | None, float | None],
        reason: str,
        *,
        lost: bool = False,
    ) -> None:
        """Add a signal about where the range of a joint ends, if the failure is more frequent where it is wrong."""
        weight = self.rates.weight(finding.check, finding.severity, RANGE)
        if weight > 0.0:
            lower, upper = ends
            self.ranges.append(
                RangeSignal(
                    child=joint.child,
                    lower=lower,
                    upper=upper,
                    lost=lost,
                    weight=weight,
                    check=finding.check,
                    reason=reason,
                )
            )

    def leave(self, finding: Finding, reason: str, cause: Cause | None = None) -> None:
        """Note that the search does nothing about a finding, and why."""
        known = cause or finding.cause
        self.left.append(UnfixableFinding(check=finding.check, joint=finding.joint, cause=known.value, reason=reason))


def _route(case: _Case, finding: Finding) -> None:
    """Hand a finding to the row of the table that it belongs to."""
    row = CHECKS[finding.check].feedback
    if finding.severity is Severity.NOTE:
        return
    if row is FeedbackRow.AS_GIVEN:
        case.leave(finding, "they overlap as given; the cause is the cut of the parts, not an axis")
    elif only_collision_meets(finding):
        case.leave(finding, "only collision geometry is in the way; decompose it", Cause.PHYSICS)
    elif row is FeedbackRow.EXPORTER:
        case.leave(finding, "frames, masses or files disagree; that is for the exporter to fix")
    elif row in _ROWS and finding.joint is not None and finding.joint in case.joints:
        _ROWS[row](case, finding, case.joints[finding.joint])
    else:
        case.leave(finding, "it names no joint that could be chosen again")


# ---- the rows of the table -----------------------------------------------------------------------------------------


def _into_parent(case: _Case, finding: Finding, joint: Joint) -> None:
    """KV310: to both sides the line is wrong, to one side only the direction."""
    low, high = _free(case, finding)
    way = joint.upper - joint.lower
    if joint.kind.turns:
        way = min(way, case.config.full_turn)
    if max(-low, high) >= case.config.open_share * way:
        ends = max(low, -way), min(high, way)
        case.end(finding, joint, ends, "to the other side it is free: it opens there")
        return
    case.against_all(finding, joint, "blocked to both sides at once")


def _end_there(case: _Case, finding: Finding, joint: Joint) -> None:
    """KV312: to one side, the range ends where the way does."""
    low, high = _free(case, finding)
    ends = low if joint.lower < low else None, high if high < joint.upper else None
    case.end(finding, joint, ends, "its way is blocked there")


def _into_others(case: _Case, finding: Finding, joint: Joint) -> None:
    """KV311: what a part meets besides its parent may be what carries it."""
    pair = finding.pair or ()
    met = next((name for name in pair if name not in (joint.child, joint.parent)), None)
    if met is not None and joint.child in pair:
        reason = f"it runs into {met}"
        if not case.has("KV310", "KV312", joint=finding.joint):
            reason += ", never into its parent"
        case.against_parent(finding, joint, reason, met)
        return
    carried = next((item for item in case.joints.values() if item.child in pair and item.parent == joint.child), None)
    if carried is None:
        case.leave(finding, "what the joint carries farther out meets others")
        return
    other = next((name for name in pair if name != carried.child), None)
    case.against_parent(finding, carried, f"what carries it moves it into {other}", other)


def _not_carried(case: _Case, finding: Finding, joint: Joint) -> None:
    """KV303: no contact supports the part there."""
    other = next((name for name in finding.pair or () if name not in (joint.child, joint.parent)), None)
    case.against_parent(finding, joint, "it does not touch what carries it", other)


def _derailed(case: _Case, finding: Finding, joint: Joint) -> None:
    """KV320: what leaves its parent runs along the wrong line or moves in the wrong way, or too far."""
    if case.has("KV321", joint=finding.joint):
        return  # a slide with a guide goes too far along the right line
    case.against_all(finding, joint, "it leaves its parent")
    if joint.kind is JointType.PRISMATIC and finding.value is not None and finding.limit is not None:
        upwards, share = _upwards(finding), finding.limit / max(finding.value, finding.limit)
        end = share * (joint.upper if upwards else joint.lower)
        ends = (None, end) if upwards else (end, None)
        case.end(finding, joint, ends, "beyond it it has left its parent", lost=True)


def _out_of_guide(case: _Case, finding: Finding, joint: Joint) -> None:
    """KV321: the range ends at the stated share of the guide; where the way back is free, the part stands open."""
    end = finding.limit
    if end is None:
        return
    low, high = _free(case, finding)
    way = joint.upper - joint.lower
    upwards = _upwards(finding)
    back = low if upwards else high
    stands_open = abs(back) >= case.config.back_share * way
    reason = "beyond it the guide has ended" + ("; it is open, and the range back is free" if stands_open else "")
    other = min(abs(back), way) if stands_open else None
    if upwards:
        case.end(finding, joint, (None if other is None else -other, end), reason, lost=True)
    else:
        case.end(finding, joint, (-end, other), reason, lost=True)


def _upwards(finding: Finding) -> bool:
    """True if the joint was above zero where the failure was seen."""
    return (finding.q or {}).get(finding.joint or "", 0.0) >= 0.0


def _line_doubted(case: _Case, finding: Finding, joint: Joint) -> None:
    case.against_line(finding, joint, "the parts show another line")


def _as_loaded(case: _Case, finding: Finding, joint: Joint) -> None:
    """KV803 and KV804: the written file, whose pieces leave every free motion free, does not move as it should."""
    case.against_all(finding, joint, f"as loaded, {finding.engine} does not move it as it should")


def _no_way(case: _Case, finding: Finding, joint: Joint) -> None:
    """KV703 to KV706: only what fails from several places of the robot speaks against the joint."""
    if finding.check != "KV706" and case.placements.get(finding.joint or "", 0.0) < case.config.placements:
        case.leave(finding, "too few places of the robot were tried to name the joint as the cause", Cause.TASK)
    else:
        case.against_all(finding, joint, "no way leads through its range")


_ROWS: dict[FeedbackRow | None, Callable[[_Case, Finding, Joint], None]] = {
    FeedbackRow.INTO_PARENT: _into_parent,
    FeedbackRow.END: _end_there,
    FeedbackRow.OTHER_PARENT: _into_others,
    FeedbackRow.NOT_CARRIED: _not_carried,
    FeedbackRow.DERAILED: _derailed,
    FeedbackRow.GUIDE: _out_of_guide,
    FeedbackRow.LINE: _line_doubted,
    FeedbackRow.AS_LOADED: _as_loaded,
    FeedbackRow.NO_WAY: _no_way,
}


def _free(case: _Case, finding: Finding) -> tuple[float, float]:
    """Range around zero in which nothing meets [rad or m]; (0, 0) where it was not measured."""
    return case.travel.get(finding.joint or "", (0.0, 0.0))
