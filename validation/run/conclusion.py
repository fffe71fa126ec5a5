"""The meaning of all results together: what engines agree on, what the user accepts, and causes.

One cause, one finding: what follows from another finding is reported under it and not counted beside it. Which checks
can be the cause of which stands at each check (`Check.follows`), and what both must be about.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from kinematify.robot.robot import rigid_groups
from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES
from kinematify.validation.check import CauseScope
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, Finding, Observation, Severity, Status

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.robot.robot import Robot
    from kinematify.validation.finding import CheckResult, Suppression

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
    results: Sequence[CheckResult[Observation]],
    robot: Robot | None,
    engines: Sequence[str] = (),
    *,
    named: bool = True,
    rules: Sequence[Suppression] = (),
) -> tuple[CheckResult[Finding], ...]:
    """Write the findings of a run, each once: as severe as it is beside all other results, and with its cause.

    What one engine shows of the untouched file is no error where the file works in another one; what is laid to an
    engine and only one shows is a note then, and a warning where no other engine runs the file.

    What others follow from is as bad as the worst of them, and where it is suppressed, so are they. A note is the
    cause of notes alone, unless it is about the link for which an engine refuses the file.

    Args:
        results: Of all checks of a run.
        robot: The model, which tells what is one body; None if it cannot be read, and every link is one.
        engines: That were asked for. Where they are not the default ones a user has named them, and errors stay.
        named: False: the user named no engine, and what the only one shows is a warning.
        rules: Findings that the user accepts; the first that fits gives the reason.
    """
    compared = tuple(engines) == DEFAULT_ENGINES or not named
    seen = [item for result in results for item in result.findings]
    facts = {id(item): _beside_others(item, results, named) if compared else (item.severity, "") for item in seen}
    severity = {key: found for key, (found, _) in facts.items()}
    accepted = {id(item): next((rule.reason for rule in rules if rule.covers(item)), None) for item in seen}
    subjects = _Subjects(robot, frozenset(item.link for item in seen if item.check == _OPENS and item.link))
    above = {id(item): cause for item in seen if (cause := _cause(item, seen, severity, subjects)) is not None}
    roots: dict[int, Observation] = {}
    worst = dict(severity)
    for item in seen:
        root = item
        while id(root) in above:
            root = above[id(root)]
        roots[id(item)] = root
        if root is not item and accepted[id(item)] is None:
            worst[id(root)] = min(worst[id(root)], severity[id(item)], key=_ORDER.index)
    written: dict[int, Finding] = {}
    for item in sorted(seen, key=lambda item: id(item) in above):
        cause = written.get(id(roots[id(item)]))
        values = {field.name: getattr(item, field.name) for field in fields(Observation)}
        values |= {"severity": worst[id(item)], "message": item.message + facts[id(item)][1]}
        reason = accepted[id(item)] or (None if cause is None else cause.suppressed)
        written[id(item)] = Finding(**values, suppressed=reason, follows_from=cause)
    return tuple(_written(result, tuple(written[id(item)] for item in result.findings)) for result in results)


def _written(result: CheckResult[Any], findings: tuple[Finding, ...]) -> CheckResult[Finding]:
    """Return a result with its findings; it has failed if one of them counts, unless it is blocked or skipped."""
    status = result.status
    if status in (Status.PASS, Status.FAIL):
        counted = any(finding.severity is not Severity.NOTE for finding in findings)
        status = Status.FAIL if counted else Status.SKIPPED if result.unfinished else Status.PASS
    return replace(result, status=status, findings=findings)


def _beside_others(item: Observation, results: Sequence[CheckResult[Observation]], named: bool) -> tuple[Severity, str]:
    """Return how severe an observation of the untouched file is beside what other engines say, and what they say."""
    if item.severity is not Severity.ERROR or not item.check.startswith(_FAMILY):
        return item.severity, ""
    errors = [
        other
        for result in results
        for other in result.findings
        if other.check.startswith(_FAMILY) and other.severity is Severity.ERROR
    ]
    failing = {
        other.engine
        for other in errors
        if other.joint in (None, item.joint) and (other.check == _ENERGY) <= (item.check == _ENERGY)
    }
    same = (result for result in results if result.check == item.check)
    ran = {result.engine for result in same if result.status in (Status.PASS, Status.FAIL)} - failing
    works = [entry.title for name, entry in ENGINES.items() if name in ran]
    alone = item.cause is Cause.ENGINE and not any(
        other.check == item.check and other.engine != item.engine for other in errors
    )
    if works:
        return Severity.NOTE if alone else Severity.WARNING, f" It works in {' and '.join(works)}."
    if not named:
        return Severity.WARNING, " No other engine was asked."
    return Severity.WARNING if alone else Severity.ERROR, ""


def _cause(
    item: Observation, seen: Sequence[Observation], severity: Mapping[int, Severity], subjects: _Subjects
) -> Observation | None:
    """Return the worst observation that another one directly follows from.

    What several engines find alike follows from the first of them.
    """
    follows = CHECKS[item.check].follows
    earlier = seen[: next(number for number, other in enumerate(seen) if other is item)]
    fits = [
        other
        for check, shared in follows.items()
        for other in (earlier if check == item.check else seen)
        if other.check == check and subjects.share(other, item, shared)
    ]
    fits = [
        other
        for other in fits
        if severity[id(other)] is not Severity.NOTE
        or severity[id(item)] is Severity.NOTE
        or other.link in subjects.refused
    ]
    return min(fits, key=lambda other: _ORDER.index(severity[id(other)]), default=None)


class _Subjects:
    """Subjects of findings, by bodies: engines and checks name different links of one body."""

    def __init__(self, robot: Robot | None, refused: frozenset[str]) -> None:
        self.refused = refused
        groups = () if robot is None else rigid_groups(robot)
        self._body = {link: group.links[0] for group in groups for link in group.links}
        self._joints = {} if robot is None else robot.joint_by_name

    def share(self, cause: Observation, finding: Observation, shared: CauseScope) -> bool:
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

    def _bodies(self, finding: Observation) -> set[str]:
        joint = self._joints.get(finding.joint or "")
        links = finding.pair or ((finding.link,) if finding.link else ()) or ((joint.child,) if joint else ())
        return {self._body.get(link, link) for link in links}
