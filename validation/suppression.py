"""Findings that the user has looked at and accepts; each with a reason, and still reported."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.finding import CheckResult, Finding


@dataclass(frozen=True, kw_only=True)
class Suppression:
    """Findings of `check` at `where` do not count, because of `reason`."""

    check: str
    """Id or glob, e.g. ``KV3*``."""
    reason: str
    where: str = "*"
    """Glob that the joint, the link or one link of the pair must match; ``*`` is anywhere."""

    def covers(self, finding: Finding) -> bool:
        """True if the rule applies to the finding."""
        if not fnmatchcase(finding.check, self.check):
            return False
        names = [name for name in (finding.joint, finding.link, *(finding.pair or ())) if name is not None]
        return self.where == "*" or any(fnmatchcase(name, self.where) for name in names)


def suppress(checks: Sequence[CheckResult], rules: Sequence[Suppression]) -> tuple[CheckResult, ...]:
    """Mark the findings that a rule covers with its reason; the first rule that fits gives it."""
    return tuple(
        replace(check, findings=tuple(_marked(finding, rules) for finding in check.findings)) for check in checks
    )


def _marked(finding: Finding, rules: Sequence[Suppression]) -> Finding:
    rule = next((rule for rule in rules if rule.covers(finding)), None)
    return finding if rule is None else replace(finding, suppressed=rule.reason)
