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
from kinematify.robot.description import open_description
from kinematify.robot.read import read_robot
from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES, require_engine, why_not_run
from kinematify.validation.check import OpenCheck
from kinematify.validation.checks import CHECKS
from kinematify.validation.document_copy import LEFT_OUT, readable_copy, resolved_copy
from kinematify.validation.finding import Cause, CheckResult, JointSummary, Observation, Severity, Status, not_finished
from kinematify.validation.isolation import load_imports, run_stages
from kinematify.validation.run.conclusion import concluded
from kinematify.validation.run.needs import (
    Recorder,
    file,
    geometry_stage,
    keys,
    later_stages,
    mesh_stage,
    needed,
    task_stage,
)
from kinematify.validation.run.report import CONTRACT, ISAAC, ValidationReport, environment
from kinematify.validation.stage import StageRequest, has_model
from kinematify.validation.validated_file import ValidatedFile
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from kinematify.config.validation import ValidationSettings
    from kinematify.manipulation.plan_request import TaskRequest
    from kinematify.robot.robot import Robot
    from kinematify.validation.check import Check
    from kinematify.validation.finding import JointSummary, Suppression
    from kinematify.validation.isolation import Stage, StageEnd
    from kinematify.validation.run.needs import CheckKey
    from kinematify.validation.validated_file import DocumentCopy

    Progress = Callable[[str, float], None]


def validate(
    path: str | Path,
    *,
    package_dirs: Sequence[str | Path] = (),
    settings: ValidationSettings | None = None,
    selected: Collection[str] | None = None,
    engines: Sequence[str] = DEFAULT_ENGINES,
    named: bool = True,
    suppressions: Sequence[Suppression] = (),
    task: TaskRequest | None = None,
    arguments: Mapping[str, str] | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> ValidationReport:
    """Check a URDF, xacro, MJCF, SDF or USD: file, declared physics, collision along the motion, joints, engines.

    Args:
        path: The file.
        package_dirs: Where packages lie (``package://``).
        settings: Thresholds and budgets; the shipped ones if absent.
        selected: Ids of the checks to run; all but those of the contract and of Isaac Sim if absent. Those of file and
            meshes always run, and their errors count.
        engines: Of `kinematify.simulation.engines.ENGINES`; all that are installed if absent. Checks of others are
            reported as skipped, with the reason.
        named: The user named the engines: what one of them shows is an error, even if others were not asked.
        suppressions: Findings that do not count.
        arguments: Of a xacro.
        task: What a robot is to do with the object (KV7xx); without one these checks are not in the report.
        workers: Processes at a time; as many as there are cores if absent.
        progress: Called with the stage that ended and the fraction done.

    Returns:
        The report; after an interrupt a partial one that says so.

    Raises:
        InputError: `path` is no description at all (missing, unreadable, binary), or cannot be read.
        EnvironmentFault: An engine was asked for that is not installed, or a task without what plans it.
    """
    for engine in engines:
        require_engine(engine)
    if task is not None:
        require("A robot arm", "pin", "coal", "ompl")
    chosen = tuple(engine for engine in ENGINES if engine in engines)
    checks = _checks(task, selected or ())
    wanted = frozenset(checks) if selected is None else frozenset(checks) & frozenset(selected)
    run = _Run(
        path=Path(path), selected=wanted, progress=progress, task=task, engines=chosen, named=named, checks=checks
    )
    settings = settings or load_settings()
    try:
        with tempfile.TemporaryDirectory(prefix="kinematify-", ignore_cleanup_errors=True) as folder:
            places = tuple(Path(item).absolute() for item in package_dirs)
            description = open_description(run.path.absolute(), Path(folder), places, arguments)
            run.robot = _bodies(description.urdf)
            run.source = replace(ValidatedFile.of(description), to_finish=run.command(settings.budget.seconds))
            request = StageRequest(
                urdf=description.urdf,
                package_dirs=places,
                work=Path(folder),
                settings=settings,
                selected=run.selected,
                deadline=settings.budget.seconds,
                task=task,
                native=description.path if description.native else None,
                apart=description.apart,
                losses=description.notes,
                source=run.source,
            )
            run.all(request, workers or os.cpu_count() or 1)
    except KeyboardInterrupt:
        run.interrupted = True
    return run.report(settings, suppressions)


_GUARDS = frozenset(check for check in CHECKS if check.startswith("KV1"))
"""Checks of file and meshes: they always run, and their errors always count."""
_MESH_GUARDS = frozenset(check for check in _GUARDS if check.startswith("KV15"))
_LAST_GUARD = "KV152"
"""Called when every mesh file has been opened and read."""


_DOUBTS = frozenset(name for name, check in CHECKS.items() if check.doubts)
"""What the stage of a task wants to know of the joints: whether parent, axis, place, type and direction are right."""
_LEEWAY = 20.0
"""Processor time that the stage of a task has to end what it is at [s]."""


def _checks(task: TaskRequest | None, selected: Collection[str]) -> dict[str, Check]:
    """Checks of the report; those of a task, of the contract and of Isaac Sim only when they were asked for."""
    return {
        name: check
        for name, check in CHECKS.items()
        if (task is not None or not name.startswith("KV7"))
        and (name in selected or not name.startswith((CONTRACT, ISAAC)))
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
        named: bool,
        checks: Mapping[str, Check],
    ) -> None:
        self.path = path
        self.task = task
        self.engines, self.named = engines, named
        self.checks = checks
        self.selected = selected
        self.interrupted = False
        self.source = ValidatedFile()
        self.robot: Robot | None = None
        self._progress = progress or (lambda stage, fraction: None)
        self._results: dict[CheckKey, CheckResult[Observation]] = {}
        self._joints: dict[str, JointSummary] = {}
        self._why: dict[CheckKey, tuple[Status, str]] = {}
        self._started = time.perf_counter()

    def all(self, request: StageRequest, workers: int) -> None:
        """Run everything that can run."""
        if self.task is not None:
            request = replace(request, selected=request.selected | _DOUBTS)
        first = needed([geometry_stage()], request.selected)
        later = needed(later_stages(self.engines), request.selected)
        load_imports(ahead=[mesh_stage(), *first, *later])
        asset_request = replace(request, selected=request.selected | _GUARDS)
        usable = file(asset_request, Recorder(self._take, asset_request))
        self._progress("pre-check", 0.05)
        copy = self._readable(asset_request)
        if not usable and copy is None:
            self._explain_rest(
                Status.BLOCKED,
                "the pre-check found errors that keep the file from being read: fix "
                f"{self._ids(self._broken())} first; no engine was started",
            )
            return
        spent, late = self._read_meshes(asset_request, copy, [*first, *later])
        if (
            self._fault_of_meshes(request.work) is not None
            and not late
            and (again := self._readable(asset_request)) is not None
        ):
            copy = again
            more, late = self._read_meshes(asset_request, copy, [])
            spent += more
        self._progress("meshes and declared physics", 0.15)
        if late:
            self._explain_rest(Status.SKIPPED, not_finished("time ran out before the meshes were checked"))
            return
        self.robot = self.robot or (None if copy is None else _bodies(copy.path))
        source = replace(self.source, copy=copy)
        request = replace(request, deadline=max(0.0, request.deadline - spent), source=source)
        fault = self._fault_of_meshes(request.work) if copy is None else None
        if copy is not None and copy.joints:
            fault = f"the pre-check found errors in what moves: {self._ids(self._broken())}"
        if fault is not None:
            self._explain_rest(Status.BLOCKED, fault)
            return
        for end in run_stages(first, request, workers=workers):
            self._take_end(end)
            self._progress(end.stage.name, 0.4)
        for name in set(ENGINES) - set(self.engines):
            self._explain([key for key in self._missing() if key[1] == name], Status.SKIPPED, why_not_run(name))
        self._look_further(later, request, workers, request.urdf if copy is None else copy.path)
        if self.task is not None:
            self._use(request, self.engines)

    def _broken(self) -> list[Observation]:
        """What keeps the document from being read: errors of file and meshes, but for shapes that are left out."""
        found = [result for key, result in self._results.items() if key[0] in _GUARDS - LEFT_OUT]
        return [item for result in found for item in result.findings if item.severity is Severity.ERROR]

    def _readable(self, request: StageRequest) -> DocumentCopy | None:
        """A copy without what is broken; None where nothing is, or where it cannot be read at all."""
        broken = self._broken()
        blocked = [
            key for key, result in self._results.items() if result.status is Status.BLOCKED and not result.findings
        ]
        if not broken or any(key[0] not in _MESH_GUARDS for key in blocked):
            return None
        return readable_copy(request, broken)

    def _ids(self, findings: Iterable[Observation]) -> str:
        return ", ".join(sorted({finding.check for finding in findings})) or "the errors above"

    def _read_meshes(
        self, request: StageRequest, copy: DocumentCopy | None, ahead: Sequence[Stage]
    ) -> tuple[float, bool]:
        """Run the checks of meshes and declared physics; processor time [s], and whether it ran out."""
        before = {key: result for key, result in self._results.items() if _has_error(result)}
        given = request if copy is None else replace(request, urdf=copy.path, source=replace(self.source, copy=copy))
        (asset,) = run_stages([mesh_stage()], given, workers=1, ahead=ahead)
        self._take_end(asset)
        self._results |= before  # of the file, not of the copy
        return asset.seconds, asset.late

    def _look_further(self, stages: list[Stage], request: StageRequest, workers: int, readable: Path) -> None:
        """Look at the joints' evidence and at the untouched file in engines, with what exact geometry knows by now."""
        free = {name: joint.free_travel for name, joint in self._joints.items() if joint.free_travel is not None}
        left_out = [item for key, result in self._results.items() if key[0] in LEFT_OUT for item in result.findings]
        resolved = resolved_copy(replace(request, urdf=readable), left_out) if stages else None
        request = replace(request, free_travel=free, resolved=resolved, doubted=self._doubted() if free else None)
        for number, end in enumerate(run_stages(stages, request, workers=workers)):
            self._take_end(end)
            self._progress(end.stage.name, 0.4 + 0.55 * (number + 1) / len(stages))

    def _doubted(self) -> dict[str, list[str]]:
        """Checks by exact geometry that speak against the kinematics of a joint, by joint."""
        doubted: dict[str, list[str]] = {}
        for (check, _), result in self._results.items():
            for item in result.findings if check.startswith("KV3") else ():
                if item.joint and item.severity is not Severity.NOTE and item.cause is Cause.KINEMATICS:
                    doubted.setdefault(item.joint, []).append(check)
        return doubted

    def _use(self, request: StageRequest, engines: Sequence[str]) -> None:
        """Make a robot use the object; it has time of its own."""
        seconds = _task_seconds(request.settings)
        source = replace(self.source, to_finish=self.command(seconds))
        request = replace(request, deadline=seconds + _LEEWAY, source=source)
        request = replace(request, suspects=self._suspects(), task_engines=tuple(engines))
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
            if finding.cause is Cause.KINEMATICS and finding.joint and finding.severity is not Severity.NOTE
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
        results = [self._result(key) for key in keys(self.checks.values())]
        robot = self.robot
        checks = concluded(results, robot, self.engines, named=self.named, rules=suppressions)
        facts = environment(settings, seconds=time.perf_counter() - self._started, interrupted=self.interrupted)
        return ValidationReport(
            model=str(self.path),
            checks=checks,
            joints=tuple(self._in_order(robot)),
            environment=facts,
        )

    def _in_order(self, robot: Robot | None) -> list[JointSummary]:
        """Joints as the file names them: they come in as stages end."""
        place = {joint.name: number for number, joint in enumerate(() if robot is None else robot.joints)}
        return sorted(self._joints.values(), key=lambda item: place.get(item.joint, len(place)))

    def _take(self, result: CheckResult[Observation] | JointSummary) -> None:
        if isinstance(result, JointSummary):
            self._joints[result.joint] = _merged(self._joints.get(result.joint), result)
        else:
            self._results[result.check, result.engine] = result

    def _take_end(self, end: StageEnd) -> None:
        for result in end.results:
            self._take(result)
        if end.failure is None:
            return
        left = [key for key in end.stage.checks if key not in self._results and key[0] in self.selected]
        reason = f"the stage {end.stage.name} {end.failure}"
        if end.late:
            self._explain(left, Status.SKIPPED, not_finished(reason))
            return
        if left:
            self._results[left[0]] = self._fallen(*left[0], end)
        self._explain(left, Status.BLOCKED, reason)

    def _fault_of_meshes(self, work: Path) -> str | None:
        """Why no later stage may open the meshes; None if they may."""
        if (_LAST_GUARD, None) not in self._results:
            return "the meshes could not be checked, and no other stage may trip over them"
        if has_model(work):
            return None
        faults = [key[0] for key, result in self._results.items() if key[0] in _MESH_GUARDS and _has_error(result)]
        return f"the meshes cannot be used, see {', '.join(faults)}"

    def _missing(self) -> Iterable[CheckKey]:
        return [key for key in keys(self.checks.values()) if key not in self._results and key not in self._why]

    def _explain_rest(self, status: Status, reason: str) -> None:
        self._explain(self._missing(), status, reason)

    def _explain(self, which: Iterable[CheckKey], status: Status, reason: str) -> None:
        for key in which:
            unwanted = key[0] not in self.selected
            reason = self.source.reason(reason) or reason
            self._why.setdefault(key, (Status.SKIPPED, "it was not asked for") if unwanted else (status, reason))

    def _result(self, key: CheckKey) -> CheckResult[Observation]:
        result = self._results.get(key)
        if result is not None and (key[0] in self.selected or _has_error(result)):
            return result
        status, reason = self._why.get(key, (Status.SKIPPED, "it was not asked for"))
        return CheckResult(check=key[0], engine=key[1], status=status, reason=reason)

    def command(self, seconds: float) -> str:
        """Say how to finish what had so much processor time [s]."""
        words = f"kinematify validate {shlex.quote(str(self.path))} --budget {2.0 * seconds:g}"
        return f"to finish: {words}, other options as they were"

    def _fallen(self, check: str, engine: str | None, end: StageEnd) -> CheckResult[Observation]:
        """A crash as a finding of the check that was under way."""
        result = OpenCheck(id=check, engine=engine, source=self.source)
        result.find(
            f"The stage {end.stage.name} {end.failure} during this check or right before it.",
            "Fix the other findings first and run again; if it stays, report it with the model.",
            severity=Severity.WARNING if engine is None else Severity.ERROR,
            cause=Cause.ENGINE,
        )
        reason = f"the stage {end.stage.name} {end.failure}"
        return CheckResult(
            check=check, engine=engine, status=Status.BLOCKED, reason=reason, findings=tuple(result.findings)
        )


def _bodies(path: Path) -> Robot | None:
    """The links and joints of a file; None where it is no tree that could be read."""
    try:
        return read_robot(path, geometry="none")
    except DescriptionError:
        return None


def _task_seconds(settings: ValidationSettings) -> float:
    """Processor time of the stage of a task [s]."""
    return max(settings.task.seconds, settings.budget.seconds)


def _has_error(result: CheckResult[Observation]) -> bool:
    return any(finding.severity is Severity.ERROR for finding in result.findings)


def _merged(before: JointSummary | None, now: JointSummary) -> JointSummary:
    """Return what two stages know of one joint together."""
    if before is None:
        return now
    return replace(
        now,
        free_travel=now.free_travel or before.free_travel,
        best_alternative=now.best_alternative or before.best_alternative,
    )
