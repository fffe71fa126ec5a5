"""The whole of `kinematify validate` for one model: pre-check, then isolated stages, then one report.

Every check ends up in the report: passed, failed, skipped or blocked, the latter two with a reason.
"""

from __future__ import annotations

import os
import shlex
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.config.validation import load_settings
from kinematify.errors import DescriptionError
from kinematify.manipulation.plan_request import PriorFinding
from kinematify.robot.read import read_robot
from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES, require_engine
from kinematify.validation.checks import CHECKS
from kinematify.validation.environment import environment
from kinematify.validation.finding import Blame, CheckResult, Finding, Severity, Status, not_finished
from kinematify.validation.isolation import load_imports, run_stages
from kinematify.validation.lines import with_lines
from kinematify.validation.run.causes import with_causes
from kinematify.validation.run.loaded_findings import across_engines, confirm_on_raw_model, with_refusals
from kinematify.validation.run.opinions import evidence_before_blame
from kinematify.validation.run.plan import (
    agreement_stage,
    as_loaded_stages,
    asset_stage,
    keys,
    later_stages,
    needed,
    task_stage,
)
from kinematify.validation.run.report import ValidationReport
from kinematify.validation.stage import Recorder, StageRequest
from kinematify.validation.stages.precheck import precheck
from kinematify.validation.summary import JointCurve, JointSummary, PairTable
from kinematify.validation.suppression import suppress

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from kinematify.config.validation import ValidationSettings
    from kinematify.manipulation.plan_request import TaskRequest
    from kinematify.robot.robot import Robot
    from kinematify.validation.check import Check
    from kinematify.validation.isolation import Stage, StageEnd
    from kinematify.validation.run.plan import CheckKey
    from kinematify.validation.summary import Summary
    from kinematify.validation.suppression import Suppression

    Progress = Callable[[str, float], None]


def validate(
    path: str | Path,
    *,
    package_dirs: Sequence[str | Path] = (),
    settings: ValidationSettings | None = None,
    selected: Collection[str] | None = None,
    engines: Sequence[str] = DEFAULT_ENGINES,
    suppressions: Sequence[Suppression] = (),
    task: TaskRequest | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> ValidationReport:
    """Check a URDF: file, declared physics, collision along the motion, joint evidence, engines and their agreement.

    Args:
        path: The URDF file.
        package_dirs: Where packages lie (``package://``).
        settings: Thresholds and budgets; the shipped ones if absent.
        selected: Ids of the checks to run; all if absent. Those of file and meshes always run, and their errors count.
        engines: Of `kinematify.simulation.engines.ENGINES`; checks of others that every installation has are reported
            as skipped.
        suppressions: Findings that do not count.
        task: What a robot is to do with the object (KV7xx); without one these checks are not in the report.
        workers: Processes at a time; as many as there are cores if absent.
        progress: Called with the stage that ended and the fraction done.

    Returns:
        The report; after an interrupt a partial one that says so.

    Raises:
        InputError: `path` is not a URDF at all (missing, unreadable, binary, xacro, MJCF).
        EnvironmentFault: An engine was asked for that is not installed.
    """
    for engine in engines:
        require_engine(engine)
    chosen = tuple(engine for engine in ENGINES if engine in engines)
    checks = _checks(task, chosen)
    wanted = frozenset(checks) if selected is None else frozenset(checks) & frozenset(selected)
    run = _Run(path=Path(path), selected=wanted, progress=progress, task=task, engines=chosen, checks=checks)
    settings = settings or load_settings()
    try:
        with tempfile.TemporaryDirectory(prefix="kinematify-", ignore_cleanup_errors=True) as folder:
            request = StageRequest(
                urdf=run.path.absolute(),
                package_dirs=tuple(Path(item).absolute() for item in package_dirs),
                work=Path(folder),
                settings=settings,
                selected=run.selected,
                deadline=settings.budget.seconds,
                task=task,
            )
            run.all(request, workers or os.cpu_count() or 1)
    except KeyboardInterrupt:
        run.interrupted = True
    return run.report(settings, suppressions)


_GUARDS = frozenset(check for check in CHECKS if check.startswith("KV1"))
"""Checks of file and meshes: they always run, and their errors always count, since nothing else can run after one."""
_MESH_GUARDS = frozenset(check for check in _GUARDS if check.startswith("KV15"))
_LAST_GUARD = "KV152"
"""Called when every mesh file has been opened and read."""


_DOUBTS = frozenset(name for name, check in CHECKS.items() if check.doubts)
"""What the stage of a task wants to know of the joints: whether parent, axis, place, type and direction are right."""
_LEEWAY = 20.0
"""Processor time that the comparison of engines has at least, and the stage of a task to end what it is at [s]."""


def _checks(task: TaskRequest | None, engines: Sequence[str]) -> dict[str, Check]:
    """Checks of the report; those of a task and of engines that not every installation has only when asked for."""
    known = {None, *DEFAULT_ENGINES, *engines}
    return {
        name: replace(check, engines=tuple(engine for engine in check.engines if engine in known))
        for name, check in CHECKS.items()
        if (task is not None or not name.startswith("KV7")) and known & {*(check.engines or (None,))}
    }


class _Run:
    """Results as they come in; what has not come in is named with its reason at the end."""

    def __init__(
        self,
        *,
        path: Path,
        selected: frozenset[str],
        progress: Progress | None,
        task: TaskRequest | None,
        engines: Sequence[str],
        checks: Mapping[str, Check],
    ) -> None:
        self.path = path
        self.task = task
        self.engines = engines
        self.checks = checks
        self.selected = selected
        self.interrupted = False
        self._progress = progress or (lambda stage, fraction: None)
        self._results: dict[CheckKey, CheckResult] = {}
        self._joints: dict[str, JointSummary] = {}
        self._curves: list[JointCurve] = []
        self._pairs: PairTable | None = None
        self._why: dict[CheckKey, tuple[Status, str]] = {}
        self._failures: dict[str, str] = {}
        self._late: set[str] = set()
        self._started = time.perf_counter()

    def all(self, request: StageRequest, workers: int) -> None:
        """Run everything that can run."""
        if self.task is not None:
            request = replace(request, selected=request.selected | _DOUBTS)
        later = needed(later_stages(self.engines), request.selected)
        plain = [
            stage
            for stage in as_loaded_stages(self.engines)
            if any(name in request.selected for name, _ in stage.checks)
        ]
        load_imports(ahead=[asset_stage(), *later, *plain])
        asset_request = replace(request, selected=request.selected | _GUARDS)
        usable = precheck(asset_request, Recorder(self._take, asset_request.selected))
        self._progress("pre-check", 0.05)
        if not usable:
            self._explain_rest(Status.BLOCKED, "the pre-check found errors that no engine may see")
            return
        (asset,) = run_stages([asset_stage()], asset_request, workers=1, ahead=[*later, *plain])
        self._take_end(asset)
        self._progress("meshes and declared physics", 0.15)
        if asset.late:
            self._explain_rest(Status.SKIPPED, not_finished("time ran out before the meshes were checked"))
            return
        request = replace(request, deadline=max(0.0, request.deadline - asset.seconds))
        fault = self._fault_of_meshes()
        if fault is not None:
            self._explain_rest(Status.BLOCKED, fault)
            return
        for number, end in enumerate(run_stages(later, request, workers=workers)):
            self._take_end(end)
            self._progress(end.stage.name, 0.15 + 0.8 * (number + 1) / len(later))
        self._explain(
            [key for key in self._missing() if key[1] in set(ENGINES) - set(self.engines)],
            Status.SKIPPED,
            "the engine was not asked for",
        )
        self._load_plainly(plain, request, workers)
        self._compare(request, self.engines)
        if self.task is not None:
            self._use(request, self.engines)

    def _load_plainly(self, stages: list[Stage], request: StageRequest, workers: int) -> None:
        """Look at the untouched file in engines; what the exact geometry knows of the joints is known by now."""
        free = {name: joint.free_travel for name, joint in self._joints.items() if joint.free_travel is not None}
        for end in run_stages(stages, replace(request, free_travel=free), workers=workers):
            self._take_end(end)
            self._progress(end.stage.name, 0.95)

    def _compare(self, request: StageRequest, engines: Sequence[str]) -> None:
        """Hold the engines against each other; it is quick, and runs even where no time is left."""
        request = replace(
            request,
            deadline=max(request.deadline, _LEEWAY),
            engines=tuple(engines),
            failures=self._failures,
            late=frozenset(self._late),
        )
        for end in run_stages(needed([agreement_stage()], request.selected), request, workers=1):
            self._take_end(end)

    def _use(self, request: StageRequest, engines: Sequence[str]) -> None:
        """Let a robot use the object; it has time of its own."""
        seconds = _task_seconds(request.settings)
        request = replace(request, deadline=seconds + _LEEWAY, suspects=self._suspects(), task_engines=tuple(engines))
        self._progress("task", 0.96)
        for end in run_stages([task_stage()], request, workers=1):
            self._take_end(end)

    def _suspects(self) -> dict[str, PriorFinding]:
        """Joints that the checks by geometry doubt, each with the worst that is said of it."""
        found = [
            finding
            for key, result in self._results.items()
            if key[0] in _DOUBTS
            for finding in result.findings
            if finding.blame is Blame.KINEMATICS and finding.joint and finding.severity is not Severity.NOTE
        ]
        found.sort(key=lambda finding: finding.severity is Severity.ERROR)
        return {
            str(finding.joint): PriorFinding(
                check=finding.check, message=finding.message, error=finding.severity is Severity.ERROR
            )
            for finding in found
        }

    def report(self, settings: ValidationSettings, suppressions: Sequence[Suppression]) -> ValidationReport:
        """Put together what is known."""
        if self.interrupted:
            self._explain_rest(Status.SKIPPED, "the run was interrupted")
        self._explain_rest(Status.BLOCKED, "its stage said nothing about it, which is a defect of Kinematify")
        results = [self._result(key) for key in keys(list(self.checks.values()))]
        robot = _bodies(self.path)
        results = evidence_before_blame(
            confirm_on_raw_model(across_engines(with_refusals(with_lines(results, robot)), self.engines))
        )
        checks = suppress([self._with_command(result, settings) for result in results], suppressions)
        checks = with_causes(checks, robot)
        facts = environment(
            settings, seconds=time.perf_counter() - self._started, interrupted=self.interrupted, engines=self.engines
        )
        return ValidationReport(
            model=str(self.path),
            checks=checks,
            joints=tuple(self._in_order(robot)),
            curves=tuple(sorted(self._curves, key=lambda curve: curve.engine)),  # they come in as stages end
            pairs=self._pairs,
            environment=facts,
        )

    def _in_order(self, robot: Robot | None) -> list[JointSummary]:
        """Joints as the file names them: they come in as stages end."""
        place = {joint.name: number for number, joint in enumerate(() if robot is None else robot.joints)}
        return sorted(self._joints.values(), key=lambda item: place.get(item.joint, len(place)))

    def _take(self, result: CheckResult | Summary) -> None:
        if isinstance(result, JointSummary):
            self._joints[result.joint] = _merged(self._joints.get(result.joint), result)
        elif isinstance(result, JointCurve):
            self._curves.append(result)
        elif isinstance(result, PairTable):
            self._pairs = result
        else:
            self._results[result.check, result.engine] = result

    def _take_end(self, end: StageEnd) -> None:
        for result in end.results:
            self._take(result)
        if end.failure is None:
            return
        self._failures[end.stage.name] = end.failure
        left = [key for key in end.stage.checks if key not in self._results and key[0] in self.selected]
        reason = f"the stage {end.stage.name} {end.failure}"
        if end.late:
            self._late.add(end.stage.name)
            self._explain(left, Status.SKIPPED, not_finished(reason))
            return
        if left and not end.failure.startswith("did not run"):
            self._results[left[0]] = _fallen(left[0], end)
        self._explain(left, Status.BLOCKED, reason)

    def _fault_of_meshes(self) -> str | None:
        """Why no later stage may open the meshes; None if they may."""
        if (_LAST_GUARD, None) not in self._results:
            return "the meshes could not be checked, and no other stage may trip over them"
        faults = [key[0] for key, result in self._results.items() if key[0] in _MESH_GUARDS and _has_error(result)]
        return f"the meshes cannot be used, see {', '.join(faults)}" if faults else None

    def _missing(self) -> Iterable[CheckKey]:
        return [key for key in keys(list(self.checks.values())) if key not in self._results and key not in self._why]

    def _explain_rest(self, status: Status, reason: str) -> None:
        self._explain(self._missing(), status, reason)

    def _explain(self, which: Iterable[CheckKey], status: Status, reason: str) -> None:
        for key in which:
            unwanted = key[0] not in self.selected
            self._why.setdefault(key, (Status.SKIPPED, "it was not asked for") if unwanted else (status, reason))

    def _result(self, key: CheckKey) -> CheckResult:
        result = self._results.get(key)
        if result is not None and (key[0] in self.selected or _has_error(result)):
            return result
        status, reason = self._why.get(key, (Status.SKIPPED, "it was not asked for"))
        return CheckResult(check=key[0], engine=key[1], status=status, reason=reason)

    def _with_command(self, result: CheckResult, settings: ValidationSettings) -> CheckResult:
        """Add to the reason of what was not finished how to finish it."""
        if not result.unfinished:
            return result
        seconds = 2.0 * (_task_seconds(settings) if result.check.startswith("KV7") else settings.budget.seconds)
        command = f"kinematify validate {shlex.quote(str(self.path))} --budget {seconds:g}"
        return replace(result, reason=f"{result.reason}; to finish: {command}, other options as they were")


def _bodies(path: Path) -> Robot | None:
    """The links and joints of a file; None where it is no tree that could be read."""
    try:
        return read_robot(path, geometry="none")
    except DescriptionError:
        return None


def _task_seconds(settings: ValidationSettings) -> float:
    """Processor time of the stage of a task [s]."""
    return max(settings.task.seconds, settings.budget.seconds)


def _has_error(result: CheckResult) -> bool:
    return any(finding.severity is Severity.ERROR for finding in result.findings)


def _merged(before: JointSummary | None, now: JointSummary) -> JointSummary:
    """What two stages know of one joint together."""
    if before is None:
        return now
    return replace(
        now,
        free_travel=now.free_travel or before.free_travel,
        best_alternative=now.best_alternative or before.best_alternative,
    )


def _fallen(key: CheckKey, end: StageEnd) -> CheckResult:
    """A crash as a finding of the check that was under way."""
    check, engine = key
    finding = Finding(
        check=check,
        severity=Severity.WARNING if engine is None else Severity.ERROR,
        blame=Blame.ENGINE,
        engine=engine,
        message=f"The stage {end.stage.name} {end.failure} during this check or right before it.",
        remedy="Fix the other findings first and run again; if it stays, report it with the model.",
    )
    reason = f"the stage {end.stage.name} {end.failure}"
    return CheckResult(check=check, engine=engine, status=Status.BLOCKED, reason=reason, findings=(finding,))
