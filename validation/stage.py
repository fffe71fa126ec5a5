"""Stage of a run: a group of checks in a process of its own, telling each result as soon as it is known.

A stage is a function `stage(request, recorder)`. What it has recorded before it crashes or is stopped is kept;
the checks that it has not recorded become ``blocked``, or ``skipped`` as not finished where time ran out.
"""

from __future__ import annotations

import time
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.validation.check import OpenCheck
from kinematify.validation.finding import CheckResult, Severity, Status

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.config.validation import ValidationSettings
    from kinematify.manipulation.plan_request import PriorFinding, TaskRequest
    from kinematify.validation.check import Check
    from kinematify.validation.summary import Summary


@dataclass(frozen=True, kw_only=True)
class StageRequest:
    """Input of every stage; it crosses a process border, so it holds plain data only."""

    urdf: Path
    """The file as the user gave it, or the URDF that represents it."""
    package_dirs: tuple[Path, ...]
    work: Path
    """Folder of this run: stages leave there what later ones need."""
    settings: ValidationSettings
    selected: frozenset[str]
    """Ids of the checks that the user wants."""
    deadline: float
    """`time.process_time()` of the stage's process at which it should be over, which no other program's load changes; a
    stage that is late says what it omitted."""
    task: TaskRequest | None = None
    """What a robot is to do with the object."""
    task_engines: tuple[str, ...] = ()
    """Engines in which its plans are executed."""
    resolved: Path | None = None
    """A copy of the file with every mesh by its absolute path, for engines that find the meshes nowhere else."""
    native: Path | None = None
    """The file that MuJoCo opens in place of `urdf`."""
    losses: tuple[str, ...] = ()
    """What the file holds and `urdf` does not, one sentence each."""
    free_travel: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Range around rest in which nothing collides by exact geometry, of joints where it was measured [rad or m]."""
    doubted: Mapping[str, Sequence[str]] | None = None
    """Checks by exact geometry that speak against a joint, for the stage of the evidence; None where none were made."""
    suspects: Mapping[str, PriorFinding] = field(default_factory=dict)
    """Joints that earlier stages doubt, for the stage of the task."""

    @property
    def remaining(self) -> float:
        """Seconds of processor time until the deadline, at least 0."""
        return max(0.0, self.deadline - time.process_time())


class Recorder:
    """Collects what a stage has to say and passes it on at once."""

    def __init__(self, tell: Callable[[CheckResult | Summary], None], selected: frozenset[str]) -> None:
        """Keep where results go and which checks are wanted."""
        self._tell = tell
        self._selected = selected

    def is_selected(self, *checks: str) -> bool:
        """True if at least one of the checks was asked for; work for none of them can be omitted."""
        return any(check in self._selected for check in checks)

    @contextmanager
    def check(self, name: str, engine: str | None = None) -> Iterator[OpenCheck]:
        """Run one check: ``with recorder.check("KV301") as check: ... check.find(...)``.

        An exception inside makes the check ``blocked`` with the exception's text, and the stage goes on: a validator
        must survive what it validates. Results of checks that were not asked for are dropped.
        """
        check = OpenCheck(id=name, engine=engine)
        start = time.perf_counter()
        try:
            yield check
        except Exception as error:  # the boundary of a check: whatever fails inside is said, not raised
            check.block(f"{type(error).__name__}: {error}")
        if name in self._selected:
            self._tell(_closed(check, time.perf_counter() - start))

    def run(self, check: Check, context: object, engine: str | None = None) -> None:
        """Run one check on the context of its stage, if it was asked for."""
        if not self.is_selected(check.id):
            return
        with self.check(check.id, engine) as result:
            check.run(result, context)

    def skip(self, checks: Iterable[Check], reason: str) -> None:
        """Say of checks that they do not apply."""
        for check in checks:
            for engine in check.engines or (None,):
                with self.check(check.id, engine) as result:
                    result.skip(reason)

    def summarise(self, summary: Summary) -> None:
        """Tell what is known of a joint or a pair; later summaries of the same joint add to earlier ones."""
        self._tell(summary)


def _closed(check: OpenCheck, seconds: float) -> CheckResult:
    counted = any(finding.severity is not Severity.NOTE for finding in check.findings)
    status = check.status or (Status.FAIL if counted else Status.PASS)
    return CheckResult(
        check=check.id,
        engine=check.engine,
        # What was found before a check was cut short still stands.
        status=Status.FAIL if counted else status,
        reason=check.reason,
        seconds=seconds,
        findings=tuple(check.findings),
        measured=check.measured,
    )
