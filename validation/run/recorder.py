"""Running the checks of a stage on what it makes, each result reported as soon as it is known."""

from __future__ import annotations

import time
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.validation.check import OpenCheck
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import CheckResult, Severity, Status

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from kinematify.validation.finding import Observation
    from kinematify.validation.stage import StageRequest
    from kinematify.validation.summary import JointSummary


@dataclass(frozen=True, kw_only=True, eq=False)
class Subjects:
    """Things that some checks look at, one after the other."""

    items: Callable[[], Sequence[object]]
    """Makes them; asked once for each check."""
    nothing: str | None = None
    """Why there are none, so that the checks do not apply."""
    left: Callable[[], str | None] = lambda: None
    """Those that time ran out before."""
    counted: str | None = None
    """Name of their number among what is measured."""


class Recorder:
    """Runs the checks of a stage and passes each result on at once."""

    def __init__(self, tell: Callable[[CheckResult[Observation] | JointSummary], None], request: StageRequest) -> None:
        """Keep where results go and which checks are wanted."""
        self._tell, self._request = tell, request
        self.fatal: set[str] = set()
        """Checks after whose errors nothing else may read the file."""

    def is_selected(self, *checks: str) -> bool:
        """True if at least one of the checks was asked for; work for none of them can be omitted."""
        return any(check in self._request.selected for check in checks)

    @contextmanager
    def _check(self, name: str, engine: str | None) -> Iterator[OpenCheck]:
        """Run one check.

        An exception inside makes the check ``blocked`` with the exception's text, and the stage goes on: a validator
        must survive what it validates.
        """
        check, start = OpenCheck(id=name, engine=engine, source=self._request.source), time.perf_counter()
        try:
            yield check
        except Exception as error:  # the boundary of a check: whatever fails inside is said, not raised
            check.block(f"{type(error).__name__}: {error}")
        if check.is_fatal or check.status is Status.BLOCKED:
            self.fatal.add(name)
        self._tell(_closed(check, time.perf_counter() - start))

    def run(
        self,
        subjects: Mapping[str, Subjects],
        engines: Sequence[str | None] = (None,),
        *,
        most: int | None = None,
        stopped: tuple[Status, str] | None = None,
    ) -> bool:
        """Run all checks of some subjects that were asked for; True if a guard forbids to go on.

        Args:
            subjects: By the class that checks ask for (`Check.subject`).
            engines: In which they run; None: in none.
            most: Findings of a check that are kept.
            stopped: Status and reason of the others where a guard forbids to go on; None: nothing is said of them.
        """
        checks = [check for check in CHECKS.values() if check.subject in subjects and self.is_selected(check.id)]
        for check in sorted(checks, key=lambda check: not check.guard):
            forbidden = not check.guard and self._stopped
            if forbidden and stopped is None:
                break
            for engine in [engine for engine in check.engines or (None,) if engine in engines]:
                with self._check(check.id, engine) as result:
                    if forbidden and stopped is not None:
                        result.status, result.reason = stopped
                    else:
                        self._look(result, subjects[check.subject])
                    if most is not None:
                        _shorten(result, most)
        return self._stopped

    @property
    def _stopped(self) -> bool:
        return any(CHECKS[name].guard for name in self.fatal)

    def _look(self, result: OpenCheck, subjects: Subjects) -> None:
        if subjects.nothing is not None:
            result.skip(subjects.nothing)
            return
        items = subjects.items()
        if subjects.counted is not None:
            result.measured[subjects.counted] = len(items)
        for item in items:
            CHECKS[result.id].run(result, item)
        left = subjects.left()
        if left is not None:
            result.leave(left)

    def summarise(self, summary: JointSummary) -> None:
        """Tell what is known of a joint or a pair; later summaries of the same joint add to earlier ones."""
        self._tell(summary)


def _shorten(result: OpenCheck, most: int) -> None:
    left = len(result.findings) - most
    if left > 0:
        del result.findings[most:]
        result.measured["not_listed"] = left
        result.reason = f"{left} more findings of this kind are not listed"


def _closed(check: OpenCheck, seconds: float) -> CheckResult[Observation]:
    counted = any(finding.severity is not Severity.NOTE for finding in check.findings)
    status = check.status or (Status.FAIL if counted else Status.PASS)
    return CheckResult(
        check=check.id,
        engine=check.engine,
        # What was found before a check was cut short still stands.
        status=Status.FAIL if counted else status,
        reason=check.reason if check.source is None else check.source.reason(check.reason),
        seconds=seconds,
        findings=tuple(check.findings),
        measured=check.measured,
    )
