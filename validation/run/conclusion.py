"""The meaning of all results together: what engines agree on, what the user accepts, and causes.

One cause, one finding: what follows from another finding is reported under it and not counted beside it. Which checks
can be the cause of which stands at each check (`Check.follows`), and what both must be about.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from kinematify.robot.robot import rigid_groups
from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES
from kinematify.validation.check import CauseScope
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, Severity, Status

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from kinematify.robot.robot import Robot
    from kinematify.validation.finding import CheckResult, Finding, Suppression

_ORDER = tuple(Severity)
_FAMILY, _OPENS, _ENERGY = "KV8", "KV801", "KV806"


@dataclass(frozen=True, kw_only=True)
class FindingGroup:
    """A finding that follows from no other, with those that follow from it."""

    finding: Finding
    consequences: tuple[Finding, ...] = ()


def group_by_cause(findings: Iterable[Finding]) -> tuple[FindingGroup, ...]:
    """Return the findings without a cause, in their order, each with what follows from it."""
    findings = tuple(findings)
    under: dict[int, list[Finding]] = {}
    for finding in findings:
        if finding.follows_from is not None:
            under.setdefault(id(finding.follows_from), []).append(finding)
    return tuple(
        FindingGroup(finding=finding, consequences=tuple(under.get(id(finding), ())))
        for finding in findings
        if finding.follows_from is None
    )


def concluded(
    results: Sequence[CheckResult],
    robot: Robot | None,
    engines: Sequence[str] = (),
    *,
    named: bool = True,
    rules: Sequence[Suppression] = (),
) -> tuple[CheckResult, ...]:
    """Say what all results mean together.

    What one engine shows of the untouched file is no error where the file works in another one; what is laid to an
    engine and only one shows is a note then, and a warning where no other engine runs the file.

    A cause is as bad as the worst that follows from it, and where it is suppressed, so is what follows. A note is the
    cause of notes alone, unless it is about the link for which an engine refuses the file.

    Args:
        results: Of all checks of a run.
        robot: The model, which tells what is one body; None if it cannot be read, and every link is one.
        engines: That were asked for. Where they are not the default ones a user has named them, and errors stay.
        named: False: the user named no engine, and what the only one shows is a warning.
        rules: Findings that the user accepts; the first that fits gives the reason.
    """
    if tuple(engines) == DEFAULT_ENGINES or not named:
        results = [
            result.with_findings(_agreed(item, results, named) for item in result.findings) for result in results
        ]
    accepted = ((result, (_suppressed(item, rules) for item in result.findings)) for result in results)
    return _with_causes([replace(result, findings=tuple(found)) for result, found in accepted], robot)


def _agreed(finding: Finding, results: Sequence[CheckResult], named: bool) -> Finding:
    """Return a finding of the untouched file as severe as it is beside what other engines say."""
    if finding.severity is not Severity.ERROR or not finding.check.startswith(_FAMILY):
        return finding
    errors = [
        item
        for result in results
        for item in result.findings
        if item.check.startswith(_FAMILY) and item.severity is Severity.ERROR
    ]
    failing = {
        other.engine
        for other in errors
        if other.joint in (None, finding.joint) and (other.check == _ENERGY) <= (finding.check == _ENERGY)
    }
    same = (result for result in results if result.check == finding.check)
    ran = {result.engine for result in same if result.status in (Status.PASS, Status.FAIL)} - failing
    works = [entry.title for name, entry in ENGINES.items() if name in ran]
    alone = finding.cause is Cause.ENGINE and not any(
        other.check == finding.check and other.engine != finding.engine for other in errors
    )
    if works:
        said, severity = f" It works in {' and '.join(works)}.", Severity.NOTE if alone else Severity.WARNING
    elif not named:
        said, severity = " No other engine was asked.", Severity.WARNING
    else:
        said, severity = "", Severity.WARNING if alone else Severity.ERROR
    return replace(finding, severity=severity, message=f"{finding.message}{said}")


def _suppressed(finding: Finding, rules: Sequence[Suppression]) -> Finding:
    rule = next((rule for rule in rules if rule.covers(finding)), None)
    return finding if rule is None else replace(finding, suppressed=rule.reason)


def _with_causes(results: Sequence[CheckResult], robot: Robot | None) -> tuple[CheckResult, ...]:
    """Name the cause of every finding that follows from another one."""
    findings = [finding for result in results for finding in result.findings]
    subjects = _Subjects(robot, frozenset(item.link for item in findings if item.check == _OPENS and item.link))
    above = {id(item): cause for item in findings if (cause := _cause(item, findings, subjects)) is not None}
    roots: dict[int, Finding] = {}
    for finding in findings:
        root = finding
        while id(root) in above:
            root = above[id(root)]
        roots[id(finding)] = root
    final: dict[int, Finding] = {}
    for root in findings:
        if id(root) not in above:
            followers = [item for item in findings if roots[id(item)] is root and item.suppressed is None]
            worst = min((item.severity for item in (root, *followers)), key=_ORDER.index)
            final[id(root)] = replace(root, severity=worst)
    for finding in findings:
        if id(finding) in above:
            cause = final[id(roots[id(finding)])]
            final[id(finding)] = replace(finding, follows_from=cause, suppressed=finding.suppressed or cause.suppressed)

    def finished(result: CheckResult) -> CheckResult:
        found = tuple(final[id(item)] for item in result.findings)
        counted = any(item.severity is not Severity.NOTE for item in found)
        failed = counted and result.status is Status.PASS  # what is blocked stays so
        return replace(result, findings=found, status=Status.FAIL if failed else result.status)

    return tuple(map(finished, results))


def _cause(finding: Finding, findings: Sequence[Finding], subjects: _Subjects) -> Finding | None:
    """Return the worst finding that a finding directly follows from.

    What several engines find alike follows from the first of them.
    """
    follows = CHECKS[finding.check].follows
    earlier = findings[: next(number for number, other in enumerate(findings) if other is finding)]
    fits = [
        other
        for check, shared in follows.items()
        for other in (earlier if check == finding.check else findings)
        if other.check == check and subjects.share(other, finding, shared)
    ]
    fits = [
        item
        for item in fits
        if item.severity is not Severity.NOTE or finding.severity is Severity.NOTE or item.link in subjects.refused
    ]
    return min(fits, key=lambda item: _ORDER.index(item.severity), default=None)


class _Subjects:
    """Subjects of findings, by bodies: engines and checks name different links of one body."""

    def __init__(self, robot: Robot | None, refused: frozenset[str]) -> None:
        self.refused = refused
        groups = () if robot is None else rigid_groups(robot)
        self._body = {link: group.links[0] for group in groups for link in group.links}
        self._joints = {} if robot is None else robot.joint_by_name

    def share(self, cause: Finding, finding: Finding, shared: CauseScope) -> bool:
        """True if two findings are both about what a cause and its consequence must share."""
        if shared is CauseScope.MODEL:
            return True
        if shared is CauseScope.CONTACT and finding.pair is None:
            return cause.engine is not None and cause.engine == finding.engine
        if shared is CauseScope.JOINT:
            return cause.joint is not None and cause.joint == finding.joint
        first, second = self._bodies(cause), self._bodies(finding)
        if shared in (CauseScope.PAIR, CauseScope.CONTACT):
            return len(first) == len(second) == 2 and first == second
        return bool(first & second)

    def _bodies(self, finding: Finding) -> set[str]:
        joint = self._joints.get(finding.joint or "")
        links = finding.pair or ((finding.link,) if finding.link else ()) or ((joint.child,) if joint else ())
        return {self._body.get(link, link) for link in links}
