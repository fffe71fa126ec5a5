"""Stages in processes of their own: a crash, a hang or a memory blow-up ends the stage, not the run.

Their limits count processor time, so that a busy machine changes no verdict. A stage sends each result at once; what it
sent before it died is kept.
"""

from __future__ import annotations

import importlib
import math
import os
import resource
import signal
import sys
import time
import traceback
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from kinematify.processes.pool import TaskFailure, WorkerProcess, WorkItem, run_tasks, send, wait_for
from kinematify.processes.start import ONE_THREAD, environment_variables, use_server, without_main, worker_context

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
    from pathlib import Path

    from kinematify.validation.finding import CheckResult, JointSummary, Observation
    from kinematify.validation.stage import StageRequest

_SHOWN = 200
"""Characters of a failed stage's last words."""
_GRACE = 2.0
"""Processor time after which a stage that should have ended by itself at the deadline is stopped [s]."""
_PATIENCE = 10.0
"""Time on the clock over processor time after which a stage waits for what never comes, however busy the machine is."""
_VARIABLES = {**ONE_THREAD, "MUJOCO_GL": "disable"}
"""Of the workers: one thread, and no search for a display."""
_EVERY_STAGE = (
    "numpy",
    "kinematify.validation.isolation",
    "kinematify.config.validation",
    "kinematify.manipulation.plan_request",
)
"""Modules that all stages need."""


@dataclass(frozen=True, kw_only=True)
class Stage:
    """A group of checks that runs in one process."""

    name: str
    run: Callable[[StageRequest, Callable[[CheckResult[Observation] | JointSummary], None]], object]
    """What runs in the process and tells each result at once; what it measures with is imported there."""
    checks: tuple[tuple[str, str | None], ...]
    """Every (id, engine) that it tells if nothing goes wrong."""
    imports: tuple[str, ...] = ()
    """Modules that it needs, loaded once for all stages."""
    library: str | None = None
    """Module that only a server loads beforehand: not every model needs it, or it changes a process that others use."""


@dataclass(frozen=True, kw_only=True)
class StageEnd:
    """End of a stage."""

    stage: Stage
    results: tuple[CheckResult[Observation] | JointSummary, ...]
    failure: str | None
    """Why it did not end by itself, as words that follow "because"; None if it did."""
    late: bool = False
    """It was stopped because time ran out: no fact about the model."""
    seconds: float = 0.0
    """Processor time of a stage that ended by itself."""


class _StageProcesses:
    """The executor of stages: a process for each."""

    def __init__(self, workers: int, ahead: Sequence[Stage]) -> None:
        self.capacity = workers
        self._ahead = ahead

    def start(self) -> WorkerProcess:
        """Return a new process."""
        with without_main():
            return WorkerProcess(worker_context(), session=False)

    def wait(self, workers: Collection[WorkerProcess]) -> list[WorkerProcess]:
        """Wait as any executor does; the first time, load what later stages need while these run."""
        if self._ahead:
            load_imports(self._ahead)
            self._ahead = ()
        return wait_for(workers)


def start_server(stages: Iterable[Stage]) -> None:
    """Start a server that workers are forked from, with the imports of stages; returns at once."""
    wanted = [name for stage in stages for name in (*stage.imports, stage.library) if name]
    use_server([*_EVERY_STAGE, *wanted], _VARIABLES)


def load_imports(stages: Sequence[Stage] = (), ahead: Sequence[Stage] = ()) -> None:
    """Load what stages need once for all of them: into this process if workers are forked from it, else into a server.

    Called before NumPy is loaded, it keeps the process one that workers can be forked from.

    Args:
        stages: Those that come next.
        ahead: Those that come later: a server loads at its start whatever it will need.
    """
    if worker_context().get_start_method() == "forkserver":
        if stages or ahead:
            start_server([*stages, *ahead])
        return
    with environment_variables(_VARIABLES):
        for name in (*_EVERY_STAGE, *(name for stage in stages for name in stage.imports)):
            importlib.import_module(name)


def run_stages(
    stages: list[Stage], request: StageRequest, *, workers: int, ahead: Sequence[Stage] = ()
) -> Iterator[StageEnd]:
    """Run stages; yield each end. Closing the iterator stops all.

    Args:
        stages: The longest first.
        request: What each of them is given.
        workers: Processes at a time.
        ahead: Stages of later calls: what they need is loaded while these run.
    """
    load_imports(stages, ahead)
    results: dict[str, list[CheckResult[Observation] | JointSummary]] = {stage.name: [] for stage in stages}

    def tasks() -> Iterator[WorkItem[float]]:
        for stage in stages:
            timeout = _PATIENCE * request.deadline + _GRACE
            yield WorkItem(key=stage.name, call=partial(_work, stage, request), timeout=timeout)

    by_name = {stage.name: stage for stage in stages}
    executor = _StageProcesses(workers, ahead)
    with closing(run_tasks(tasks(), executor, heard=lambda name, message: results[name].append(message))) as running:
        for name, answer in running:
            failure, late, seconds = None, False, 0.0
            if isinstance(answer, TaskFailure):
                failure, late = _cause(answer, _log(by_name[name], request))
            else:
                seconds = answer
            said = tuple(results[name])
            yield StageEnd(stage=by_name[name], results=said, failure=failure, late=late, seconds=seconds)


def _work(stage: Stage, request: StageRequest) -> float:
    """Run a stage in its worker, and return the processor time of that [s]."""
    os.environ.update(_VARIABLES)
    limit = request.settings.budget.stage_bytes
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    _, most = resource.getrlimit(resource.RLIMIT_CPU)
    seconds = math.ceil(request.deadline + _GRACE)
    resource.setrlimit(resource.RLIMIT_CPU, (seconds if most == resource.RLIM_INFINITY else min(seconds, most), most))
    try:
        _silence(_log(stage, request))
    except FileNotFoundError:
        sys.exit()  # the run was stopped meanwhile, and its folder is gone
    try:
        stage.run(request, send)
    except Exception:
        traceback.print_exc()  # its last line becomes the cause
        sys.exit(1)
    return time.process_time()


def _silence(log: os.PathLike[str]) -> None:
    """Send what C libraries print into a file: it must not end up in the user's answer."""
    target = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    os.dup2(target, 1)
    os.dup2(target, 2)


def _cause(failure: TaskFailure, log: Path) -> tuple[str, bool]:
    """Why a stage did not end by itself, and whether time ran out."""
    if failure.status == "timeout":
        return f"was {failure.message} in which it did not end", True
    code = failure.exit_code
    if code == -signal.SIGXCPU:
        return "was stopped when its processor time was used up", True
    if code is not None and code < 0:
        return f"crashed with {signal.Signals(-code).name}", False
    try:
        last = log.read_text(encoding="utf-8", errors="replace").strip().rpartition("\n")[2]
    except OSError:
        last = ""
    # The last line of a traceback says what was raised.
    return f"failed with status {code}" + (f" ({last[:_SHOWN]})" if last else ""), False


def _log(stage: Stage, request: StageRequest) -> Path:
    """Where a stage's output goes."""
    return request.work / f"{stage.name}.log"
