"""Validating corrupted models in guarded processes: whatever one does to its process is an outcome, not the end."""

from __future__ import annotations

import json
import multiprocessing
import tempfile
import time
import traceback
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import connection
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.config.validation import load_settings
from kinematify.errors import InputError
from kinematify.evaluation.studies.corruption.cases import write_case
from kinematify.validation.catalogue import CATALOGUE
from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.html import as_html
from kinematify.validation.formats.json_lines import as_json_text
from kinematify.validation.formats.junit import as_junit
from kinematify.validation.formats.sarif import as_sarif
from kinematify.validation.outcome import Unusable
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess

    from kinematify.config.validation import ValidationSettings
    from kinematify.evaluation.studies.corruption.bases import Base
    from kinematify.validation.outcome import Outcome
    from kinematify.validation.report import ValidationReport

Result = dict[str, Any]
"""number, kind, base, outcome, seconds, message, errors, unexplained."""

READY = ("passes", "fails", "no URDF")
"""Outcomes that are right; the others are `crash`, `hang` and `traceback`."""
_GRACE = 15.0
"""Seconds beyond the budget of a run, for starting and writing, after which it hangs."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What every process needs; it crosses process borders."""

    seed: int
    bases: tuple[Base, ...]
    settings: ValidationSettings
    """With the time budget of one run."""
    selected: frozenset[str]
    """Ids of the checks."""


def run_cases(numbers: Sequence[int], plan: Plan, workers: int) -> Iterator[Result]:
    """Validate the cases, each as soon as a process is free, and yield the results as they come."""
    waiting = list(numbers)
    active: dict[Connection, _Worker] = {}
    try:
        while waiting or active:
            while waiting and len(active) < workers:
                worker = _Worker(plan)
                worker.take(waiting.pop(0))
                active[worker.channel] = worker
            ready = connection.wait(list(active), timeout=1.0)
            for channel, worker in list(active.items()):
                limit = plan.settings.budget.seconds + _GRACE
                result = worker.result(limit) if channel in ready else worker.late(limit)
                if result is None:
                    continue
                yield result
                if waiting and worker.process.is_alive():
                    worker.take(waiting.pop(0))
                else:
                    del active[channel]
                    worker.stop()
    finally:
        for worker in active.values():
            worker.stop()


class _Worker:
    """A process that validates one model after the other."""

    def __init__(self, plan: Plan) -> None:
        context = multiprocessing.get_context("spawn")
        self.channel, other = context.Pipe()
        self.process: BaseProcess = context.Process(target=_serve, args=(other, plan))
        self.process.start()
        other.close()
        self.number = -1
        self.started = 0.0

    def take(self, number: int) -> None:
        self.number, self.started = number, time.monotonic()
        with suppress(BrokenPipeError):  # it died between two cases: the next look at it tells
            self.channel.send(number)

    def result(self, limit: float) -> Result | None:
        try:
            return self.channel.recv()
        except (EOFError, ConnectionResetError):
            self.process.join(limit)
            return self._failure("crash", f"the process ended with {self.process.exitcode}")

    def late(self, limit: float) -> Result | None:
        if time.monotonic() < self.started + limit:
            return None
        self.process.kill()
        self.process.join()
        return self._failure("hang", f"stopped after {limit:.0f} s")

    def stop(self) -> None:
        with suppress(OSError):
            self.channel.send(None)
        self.process.join(5.0)
        self.process.kill()
        self.channel.close()

    def _failure(self, outcome: str, message: str) -> Result:
        seconds = time.monotonic() - self.started
        return {"number": self.number, "outcome": outcome, "seconds": seconds, "message": message}


def hurried(seconds: float) -> ValidationSettings:
    """Return the settings as shipped with a time budget of one's own."""
    settings = load_settings()
    return settings.model_copy(update={"budget": settings.budget.model_copy(update={"seconds": seconds})})


def _serve(channel: Connection, plan: Plan) -> None:
    while (number := channel.recv()) is not None:
        channel.send(run_case(number, plan))


def run_case(number: int, plan: Plan) -> Result:
    """Write and validate one case in this process."""
    with tempfile.TemporaryDirectory(prefix="corrupted-", ignore_cleanup_errors=True) as folder:
        case = write_case(number, plan.seed, plan.bases, Path(folder))
        start = time.perf_counter()
        facts = {"number": number, "kind": case.kind, "base": case.base}
        try:
            facts |= _validated(case.urdf, plan)
        except Exception:
            facts |= {"outcome": "traceback", "message": traceback.format_exc()[-1500:]}
        return {**facts, "seconds": time.perf_counter() - start}


def _validated(urdf: Path, plan: Plan) -> Result:
    try:
        engines = sorted({engine for check in plan.selected for engine in CATALOGUE[check].engines})
        report = validate(urdf, settings=plan.settings, selected=plan.selected, engines=engines, workers=1)
    except InputError as error:
        _write_all(Unusable(model=str(urdf), message=str(error)))
        return {"outcome": "no URDF", "message": str(error)[:200]}
    _write_all(report)
    errors = Counter(finding.check for finding in report.findings if finding.severity is Severity.ERROR)
    outcome = "fails" if report.exit_status else "passes"
    return {"outcome": outcome, "message": "", "errors": dict(errors), "unexplained": _unexplained(report)}


def _write_all(outcome: Outcome) -> None:
    """Every format must be able to hold what was found."""
    json.loads(as_json_text([outcome]))
    json.loads(as_sarif([outcome]))
    as_junit([outcome]).encode()
    as_html([outcome], {}).encode()


def _unexplained(report: ValidationReport) -> list[str]:
    """Reasons of blocked checks that are no consequence of what was found: something inside gave way."""
    usual = ("the pre-check found", "a mesh cannot be used", "the meshes cannot be used")
    first: dict[str, str] = {}
    for check in report.checks:
        reason = check.reason or ""
        if check.status is Status.BLOCKED and not reason.startswith(usual):
            first.setdefault(reason, f"{check.check} {check.engine or ''}: {reason}"[:400])
    return list(first.values())
