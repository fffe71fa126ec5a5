"""The pool: tasks in workers, most of them processes of this machine, each with a channel to the caller."""

from __future__ import annotations

import faulthandler
import gc
import os
import resource
import select
import signal
import sys
import threading
import time
import traceback
from collections import Counter, deque
from contextlib import suppress
from dataclasses import dataclass, replace
from multiprocessing import connection
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Generic, Literal, Protocol, TypeVar

from kinematify.processes.start import ONE_THREAD, deaf, ensure_server, keep_memory

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Generator, Iterable, Mapping, Sequence
    from multiprocessing.connection import Connection
    from multiprocessing.context import ForkContext, ForkServerContext
    from multiprocessing.process import BaseProcess

_Result = TypeVar("_Result")
_Result_co = TypeVar("_Result_co", covariant=True)


@dataclass(frozen=True, kw_only=True)
class WorkItem(Generic[_Result_co]):
    """Task of a worker."""

    key: str
    """Each task has its own."""
    call: Callable[[], _Result_co]
    """Picklable; while it runs it can `send` the caller more than its result."""
    timeout: float
    """Wall time after which it is stopped with all that it has started [s]."""


@dataclass(frozen=True, kw_only=True)
class TaskFailure:
    """Failure of a task that gave no result."""

    status: Literal["error", "timeout", "crash"]
    message: str
    seconds: float
    exit_code: int | None = None
    """Of a process that crashed; below zero: the signal that ended it."""


@dataclass(frozen=True)
class Message:
    """Message of a task before it ends."""

    content: Any


class Executor(Protocol):
    """Starts workers."""

    @property
    def capacity(self) -> int:
        """Workers that can run at a time at present, at least 1."""

    def start(self) -> Any:
        """Return a new worker, as `WorkerProcess` is one."""

    def wait(self, workers: Collection[Any]) -> list[Any]:
        """Return those of the busy workers that have an answer, have died or whose time is up, at least one."""


def run_tasks(
    tasks: Iterable[WorkItem[_Result] | None],
    executor: Executor,
    *,
    reuse: int = 1,
    lives: int = 1,
    heard: Callable[[str, Any], None] = lambda key, message: None,
) -> Generator[tuple[str, _Result | TaskFailure]]:
    """Yield key and result of every task as it ends; closing the iterator stops all workers.

    Args:
        tasks: Started in this order, and taken from the iterator as workers come free; None where the next one waits
            for the end of one that runs.
        executor: Starts the workers.
        reuse: Tasks that a worker takes one after the other.
        lives: A task whose worker dies is begun again until it has cost as many; then that is its failure.
        heard: Called with the key of a task and what it tells before it ends.
    """
    upcoming, deaths = iter(tasks), Counter[str]()
    again: deque[WorkItem[_Result]] = deque()
    active: dict[Any, tuple[WorkItem[_Result], int]] = {}  # its task, and how many it has taken with it
    try:
        while True:
            while len(active) < executor.capacity and (task := again.popleft() if again else next(upcoming, None)):
                with deaf():  # an interrupt before it is listed would leave a process that nobody stops
                    worker = executor.start()
                    active[worker] = task, 1
                worker.submit(task.call, task.timeout)
            if not active:
                return
            for worker in executor.wait(active):
                result, alive = worker.result()
                ended, taken = active[worker]
                if isinstance(result, Message):
                    heard(ended.key, result.content)
                    continue
                died = isinstance(result, TaskFailure) and result.status == "crash"
                deaths[ended.key] += died
                if died and deaths[ended.key] < lives:
                    again.append(ended)
                if alive and taken < reuse and (task := again.popleft() if again else next(upcoming, None)):
                    active[worker] = task, taken + 1
                    worker.submit(task.call, task.timeout)
                else:
                    worker.stop()
                    del active[worker]
                if not died:
                    yield ended.key, result
                elif deaths[ended.key] == lives:
                    times = f", the last of {lives} that it cost" if lives > 1 else ""
                    yield ended.key, replace(result, message=result.message + times)
    finally:
        for worker in active:
            worker.stop()


class Processes:
    """The executor of this machine: workers with bounded memory that take one task after the other."""

    def __init__(
        self,
        workers: int,
        *,
        preload: Sequence[str] = (),
        memory: int | None = None,
        context: ForkContext | None = None,
    ) -> None:
        """Start the server that processes are forked from: heavy imports are paid once, one thread per library.

        Args:
            workers: Processes at a time.
            preload: Modules that are imported once for all of them.
            memory: Address space of each [bytes]; what needs more fails with a `MemoryError`.
            context: What they are forked from in place of a server.
        """
        self.capacity = workers
        self._memory = memory
        self._context = context or ensure_server([__name__, *preload])

    def start(self) -> WorkerProcess:
        """Return a new process."""
        return WorkerProcess(self._context, memory=self._memory)

    def wait(self, workers: Collection[WorkerProcess]) -> list[WorkerProcess]:
        """Return those of the busy processes that have an answer, have died or whose time is up, at least one."""
        return wait_for(workers)


def wait_for(workers: Collection[WorkerProcess]) -> list[WorkerProcess]:
    """Return those of the busy processes that have an answer, have died or whose time is up, at least one."""
    left = min(worker.deadline for worker in workers) - time.monotonic()
    ready = connection.wait([worker.channel for worker in workers], max(0.0, left))
    now = time.monotonic()
    return [worker for worker in workers if worker.channel in ready or now >= worker.deadline]


class WorkerProcess:
    """A process that does one task after the other."""

    def __init__(
        self, context: ForkContext | ForkServerContext, *, memory: int | None = None, session: bool = True
    ) -> None:
        """Start it.

        Args:
            context: What it is forked from.
            memory: Its address space [bytes].
            session: Whether it leads a session, so that it may start processes, all of which end with it or with the
                caller; else it may start none.
        """
        self.channel, other = context.Pipe()
        # The server may have been started under another environment, before credentials of a store were set.
        environment = {name: value for name, value in os.environ.items() if name not in ONE_THREAD}
        inherited = self.channel if context.get_start_method() == "fork" else None
        arguments = (other, inherited, memory, session, environment)
        self._session = session
        self._process: BaseProcess = context.Process(target=_serve, args=arguments, daemon=not session)
        with deaf():  # an interrupt amid the request would make the server print a traceback
            self._process.start()
        other.close()  # only the process may hold its end: then its death is seen as the end of the stream
        self._started, self.deadline = 0.0, 0.0

    def submit(self, call: Callable[[], Any], timeout: float) -> None:
        """Begin a task."""
        self._started = time.monotonic()
        self.deadline = self._started + timeout
        with suppress(BrokenPipeError):  # it died between two tasks: the next look at it tells
            self.channel.send(call)

    def result(self) -> tuple[Any, bool]:
        """Return the result, what became of the task or a `Message`, and whether the process lives."""
        seconds = time.monotonic() - self._started
        if not self.channel.poll():
            stopped = f"stopped after {self.deadline - self._started:.0f} s"
            return TaskFailure(status="timeout", message=stopped, seconds=seconds), False
        try:
            return self.channel.recv(), True
        except (EOFError, ConnectionResetError):
            self._process.join()
            code = self._process.exitcode
            cause = signal.Signals(-code).name if code is not None and code < 0 else f"status {code}"
            message = f"the worker ended with {cause}"
            return TaskFailure(status="crash", message=message, seconds=seconds, exit_code=code), False

    def stop(self) -> None:
        """End it with all that it has started."""
        self.channel.close()
        if self._session:
            with suppress(ProcessLookupError, TypeError):  # it has not begun a session yet, or has ended
                os.killpg(self._process.pid, signal.SIGKILL)  # type: ignore[arg-type]  # it was started
        self._process.kill()
        self._process.join()


_CALLERS: list[Connection] = []
"""Channels of this worker and of those that it was forked from; the last is its own."""


def in_worker() -> bool:
    """True in a worker: the pool that it is of keeps the cores busy."""
    return bool(_CALLERS)


def send(message: Any) -> None:
    """Send the caller of this worker a message that its task has before it ends."""
    _CALLERS[-1].send(Message(message))


def _serve(
    channel: Connection, callers: Connection | None, memory: int | None, session: bool, environment: Mapping[str, str]
) -> None:
    """Body of a process. Ctrl-C is answered by the caller alone."""
    if callers is not None:  # a copy of the caller's own end: while it is open, the end of the caller is not seen
        callers.close()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    faulthandler.disable()  # the caller tells of a crash
    gc.freeze()  # what was imported before is looked through no more, and stays shared with it
    os.environ.update(environment)
    keep_memory()
    _CALLERS.append(channel)
    if session:
        os.setsid()  # a hang is stopped with all that it has started
        threading.Thread(target=_end_with_caller, args=(channel.fileno(),), daemon=True).start()
        if "torch" in sys.modules:
            sys.modules["torch"].set_num_threads(1)
    if memory is not None:  # the soft limit alone: stages of a validation have limits of their own
        resource.setrlimit(resource.RLIMIT_AS, (memory, resource.getrlimit(resource.RLIMIT_AS)[1]))
    with suppress(EOFError, BrokenPipeError):
        while True:
            call = channel.recv()
            start = time.perf_counter()
            try:
                result = call()
            except Exception as error:  # one task never ends the run
                result = TaskFailure(status="error", message=sentence(error), seconds=time.perf_counter() - start)
            channel.send(result)


def _end_with_caller(channel: int) -> None:
    """A run that is killed takes its processes with it, so that they do not slow down the one that resumes."""
    poll = select.poll()
    poll.register(channel, 0)  # the end of the other side is reported in any case
    poll.poll()
    os.killpg(0, signal.SIGKILL)


def sentence(error: Exception) -> str:
    """Type, message and place of an error."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({place.name}, line {place.lineno} of {PurePath(place.filename).name})"
