"""Stages in processes of their own: a crash, a hang or a memory blow-up ends the stage, not the run.

Their limits count processor time, so that a busy machine changes no verdict.

Workers are forked from a process that has the heavy imports done, so that one costs milliseconds: from the caller's own
where no library has started threads in it, whose locks a copy might inherit in any state, and else from a server. A
worker sends each result through a pipe at once; what it sent before it died is kept.
"""

from __future__ import annotations

import faulthandler
import gc
import importlib
import math
import multiprocessing
import os
import resource
import signal
import sys
import threading
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from multiprocessing import connection, forkserver, resource_tracker
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
    from multiprocessing.connection import Connection
    from multiprocessing.context import ForkContext, ForkServerContext
    from multiprocessing.process import BaseProcess

    from kinematify.validation.finding import CheckResult
    from kinematify.validation.stage import Recorder, StageRequest
    from kinematify.validation.summary import Summary

_SHOWN = 200
"""Characters of a failed stage's last words."""
_GRACE = 2.0
"""Processor time after which a stage that should have ended by itself at the deadline is stopped [s]."""
_PATIENCE = 10.0
"""Time on the clock over processor time after which a stage waits for what never comes, however busy the machine is."""
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Variables of workers: one thread per library, as there are as many workers as cores."""
_VARIABLES = {**ONE_THREAD, "MUJOCO_GL": "disable"}
"""Of the workers: one thread, and no search for a display."""
_EVERY_STAGE = (
    "numpy",
    "kinematify.validation.isolation",
    "kinematify.validation.stage",
    "kinematify.config.validation",
    "kinematify.manipulation.request",
)
"""Modules that all stages need."""


@dataclass(frozen=True, kw_only=True)
class Stage:
    """A group of checks that runs in one process."""

    name: str
    run: Callable[[StageRequest, Recorder], None]
    """What runs in the process; what it measures with is imported there."""
    checks: tuple[tuple[str, str | None], ...]
    """Every (id, engine) that it tells if nothing goes wrong."""
    after: tuple[str, ...] = ()
    """Names of the stages that must have ended without a crash before."""
    imports: tuple[str, ...] = ()
    """Modules that it needs, loaded once for all stages."""
    library: str | None = None
    """Module that only a server loads beforehand: not every model needs it, or it changes a process that others use."""


@dataclass(frozen=True, kw_only=True)
class StageEnd:
    """How a stage ended."""

    stage: Stage
    told: tuple[CheckResult | Summary, ...]
    failure: str | None
    """Why it did not end by itself, as words that follow "because"; None if it did."""
    late: bool = False
    """It, or one that it comes after, was stopped because time ran out: no fact about the model."""
    seconds: float = 0.0
    """Processor time of a stage that ended by itself, with the longest of those that it comes after."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Running:
    stage: Stage
    process: BaseProcess
    before: float
    """Processor time of those that it comes after [s]."""
    started: float
    patience: float
    """Time on the clock after which it is stopped [s]."""
    told: list[CheckResult | Summary]


class _Server:
    """The server that workers are forked from where the caller's process cannot be."""

    runs = False

    def start(self, stages: Iterable[Stage]) -> None:
        """Start it, if it does not run; its imports go on beside the caller's work."""
        wanted = [name for stage in stages for name in (*stage.imports, stage.library) if name]
        multiprocessing.get_context("forkserver").set_forkserver_preload([*_EVERY_STAGE, *wanted])
        resource_tracker.ensure_running()  # else it would be started meanwhile, and end the deafness
        with environment_variables(_VARIABLES), _without_main(), _deaf():
            forkserver.ensure_running()
        self.runs = True


_SERVER = _Server()


def worker_context() -> ForkContext | ForkServerContext:
    """Return what starts processes: the server once it runs, and this process as long as its threads are Python's."""
    if _SERVER.runs or not _only_threads_of_python():
        return multiprocessing.get_context("forkserver")
    return multiprocessing.get_context("fork")


def start_server(stages: Iterable[Stage]) -> None:
    """Start a server that workers are forked from, with the imports of stages; returns at once."""
    _SERVER.start(stages)


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


def _only_threads_of_python() -> bool:
    try:
        return sum(1 for _ in Path("/proc/self/task").iterdir()) == threading.active_count()
    except OSError:
        return False  # not Linux: who knows


def run_stages(
    stages: list[Stage], request: StageRequest, *, workers: int, ahead: Sequence[Stage] = ()
) -> Iterator[StageEnd]:
    """Run stages, each as soon as those before it have ended; yield each end. Closing the iterator stops all.

    Args:
        stages: In an order in which each stands behind those that it comes after.
        request: What each of them is given; what those before it took is taken off the time of a stage.
        workers: Processes at a time.
        ahead: Stages of later calls: what they need is loaded while these run.
    """
    load_imports(stages, ahead)
    waiting, ended = list(stages), dict[str, StageEnd]()
    active: dict[Connection, _Running] = {}
    try:
        while waiting or active:
            for stage in [s for s in waiting if all(name in ended for name in s.after)]:
                if len(active) == workers:
                    break
                waiting.remove(stage)
                before = [ended[name] for name in stage.after]
                broken = next((end for end in before if end.failure), None)
                if broken is not None:
                    why = f"did not run, because the stage {broken.stage.name} {broken.failure}"
                    ended[stage.name] = StageEnd(stage=stage, told=(), failure=why, late=broken.late)
                    yield ended[stage.name]
                else:
                    receiver, running = _start(stage, request, max((end.seconds for end in before), default=0.0))
                    active[receiver] = running
            load_imports(ahead)
            ahead = ()
            for end in _listen(active, request):
                ended[end.stage.name] = end
                yield end
    finally:
        for receiver, running in active.items():
            _stop(receiver, running.process)


def _start(stage: Stage, request: StageRequest, before: float) -> tuple[Connection, _Running]:
    request = replace(request, deadline=max(0.0, request.deadline - before))
    context = worker_context()
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(sender, stage, request), daemon=True)
    with _without_main(), _deaf():  # an interrupt amid the request would make the server print a traceback
        process.start()
    sender.close()  # only the worker may hold the sending end: its death is then the end of the stream
    patience = _PATIENCE * request.deadline + _GRACE
    return receiver, _Running(
        stage=stage, process=process, before=before, started=time.monotonic(), patience=patience, told=[]
    )


def _work(sender: Connection, stage: Stage, request: StageRequest) -> None:
    """Body of a worker. Ctrl-C reaches the whole process group; the parent alone answers it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    faulthandler.disable()  # the parent tells of a crash
    os.environ.update(_VARIABLES)
    gc.freeze()  # what was imported before is looked through no more, and stays shared with it
    limit = request.settings.budget.stage_bytes
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    _, most = resource.getrlimit(resource.RLIMIT_CPU)
    seconds = math.ceil(request.deadline + _GRACE)
    resource.setrlimit(resource.RLIMIT_CPU, (seconds if most == resource.RLIM_INFINITY else min(seconds, most), most))
    try:
        _silence(_log(stage, request))
    except FileNotFoundError:
        return  # the run was stopped meanwhile, and its folder is gone
    # Imported here, and by a server: the sooner the caller starts that, the sooner everything ends.
    from kinematify.validation.stage import Recorder  # noqa: PLC0415

    with suppress(BrokenPipeError):  # nobody listens any more where the run itself was stopped
        stage.run(request, Recorder(sender.send, request.selected))
        sender.send(time.process_time())


def _silence(log: os.PathLike[str]) -> None:
    """Send what C libraries print into a file: it must not end up in the user's answer."""
    target = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    os.dup2(target, 1)
    os.dup2(target, 2)


def _listen(active: dict[Connection, _Running], request: StageRequest) -> Iterator[StageEnd]:
    """Take in what the workers tell, and yield those that have ended, died or run out of time."""
    if not active:
        return
    until = min(running.started + running.patience for running in active.values()) - time.monotonic()
    ready = connection.wait(list(active), max(0.0, until))
    for receiver, running in list(active.items()):
        failure: str | None = None
        late, seconds = False, 0.0
        if receiver in ready:
            try:
                message = receiver.recv()
            except EOFError:
                running.process.join()
                late = running.process.exitcode == -signal.SIGXCPU
                failure = _cause(running.process.exitcode, _log(running.stage, request))
            else:
                if not isinstance(message, float):
                    running.told.append(message)
                    continue
                seconds = running.before + message
        elif time.monotonic() >= running.started + running.patience:
            late, failure = True, f"was stopped after {running.patience:.0f} s in which it did not end"
        else:
            continue
        del active[receiver]
        _stop(receiver, running.process)
        yield StageEnd(stage=running.stage, told=tuple(running.told), failure=failure, late=late, seconds=seconds)


def _cause(exit_code: int | None, log: Path) -> str:
    if exit_code == -signal.SIGXCPU:
        return "was stopped when its processor time was used up"
    if exit_code is not None and exit_code < 0:
        return f"crashed with {signal.Signals(-exit_code).name}"
    try:
        last = log.read_text(encoding="utf-8", errors="replace").strip().rpartition("\n")[2]
    except OSError:
        last = ""
    # The last line of a traceback says what was raised.
    return f"failed with status {exit_code}" + (f" ({last[:_SHOWN]})" if last else "")


def _log(stage: Stage, request: StageRequest) -> Path:
    """Where a stage's output goes."""
    return request.work / f"{stage.name}.log"


def _stop(receiver: Connection, process: BaseProcess) -> None:
    receiver.close()
    process.kill()
    process.join()


@contextmanager
def environment_variables(values: Mapping[str, str]) -> Iterator[None]:
    """Give what is started meanwhile some variables of the environment, and keep them from the caller's."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def _deaf() -> Iterator[None]:
    """Keep Ctrl-C from what is started meanwhile, its imports included; it is answered here right after."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _without_main() -> Iterator[None]:
    """Hide the caller's script, which workers would run again although they need nothing of it."""
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main
