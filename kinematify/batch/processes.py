"""Workers that are processes of this machine, each the leader of a session, with bounded memory."""

from __future__ import annotations

import multiprocessing
import os
import resource
import select
import signal
import sys
import threading
import time
import traceback
from contextlib import suppress
from multiprocessing import connection, forkserver
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from kinematify.batch.engine import TaskFailure
from kinematify.validation.isolation import ONE_THREAD, environment_variables

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping, Sequence
    from multiprocessing.connection import Connection
    from multiprocessing.context import ForkServerContext
    from multiprocessing.process import BaseProcess


class Processes:
    """The engine of one machine."""

    def __init__(self, workers: int, *, preload: Sequence[str] = (), memory: int | None = None) -> None:
        """Start the server that processes are forked from: heavy imports are paid once, one thread per library.

        Args:
            workers: Processes at a time.
            preload: Modules that are imported once for all of them.
            memory: Address space of each [bytes]; what needs more fails with a `MemoryError`.
        """
        self.capacity = workers
        self._memory = memory
        self._context = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload([__name__, *preload])
        with environment_variables(ONE_THREAD):
            forkserver.ensure_running()

    def start(self) -> WorkerProcess:
        """Return a new process."""
        return WorkerProcess(self._context, self._memory)

    def wait(self, workers: Collection[WorkerProcess]) -> list[WorkerProcess]:
        """Return those of the busy processes that have an answer, have died or whose time is up, at least one."""
        left = min(worker.deadline for worker in workers) - time.monotonic()
        ready = connection.wait([worker.channel for worker in workers], max(0.0, left))
        now = time.monotonic()
        return [worker for worker in workers if worker.channel in ready or now >= worker.deadline]


class WorkerProcess:
    """A process that does one task after the other."""

    def __init__(self, context: ForkServerContext, memory: int | None) -> None:
        self.channel, other = context.Pipe()
        # No daemon, which could not start processes, as validation does.
        # The server may have been started under another environment, before credentials of a store were set.
        environment = {name: value for name, value in os.environ.items() if name not in ONE_THREAD}
        self._process: BaseProcess = context.Process(target=_serve, args=(other, memory, environment))
        self._process.start()
        other.close()  # only the process may hold its end: then its death is seen as the end of the stream
        self._started, self.deadline = 0.0, 0.0

    def take(self, task: Callable[[], Any], timeout: float) -> None:
        """Begin a task."""
        self._started = time.monotonic()
        self.deadline = self._started + timeout
        with suppress(BrokenPipeError):  # it died between two tasks: the next look at it tells
            self.channel.send(task)

    def answer(self) -> tuple[Any, bool]:
        """Return the result or what became of the task, and whether the process lives."""
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
            return TaskFailure(status="crash", message=f"the worker ended with {cause}", seconds=seconds), False

    def stop(self) -> None:
        """End it with all that it has started."""
        self.channel.close()
        with suppress(ProcessLookupError, TypeError):  # it has not begun a session yet, or has ended
            os.killpg(self._process.pid, signal.SIGKILL)  # type: ignore[arg-type]  # it was started
        self._process.kill()
        self._process.join()


def _serve(channel: Connection, memory: int | None, environment: Mapping[str, str]) -> None:
    """Body of a process."""
    os.environ.update(environment)
    os.setsid()  # Ctrl-C is answered by the caller alone, and a hang is stopped with all that it has started
    threading.Thread(target=_end_with_caller, args=(channel.fileno(),), daemon=True).start()
    if memory is not None:  # the soft limit alone: stages of a validation have limits of their own
        resource.setrlimit(resource.RLIMIT_AS, (memory, resource.getrlimit(resource.RLIMIT_AS)[1]))
    if "torch" in sys.modules:
        sys.modules["torch"].set_num_threads(1)
    with suppress(EOFError, BrokenPipeError):
        while True:
            task = channel.recv()
            start = time.perf_counter()
            try:
                result = task()
            except Exception as error:  # one task never ends the run
                result = TaskFailure(status="error", message=sentence(error), seconds=time.perf_counter() - start)
            channel.send(result)


def _end_with_caller(channel: int) -> None:
    """A run that is killed takes its processes with it, so that they do not slow down the one that resumes."""
    poll = select.poll()
    poll.register(channel, 0)  # the end of the other side is told in any case
    poll.poll()
    os.killpg(0, signal.SIGKILL)


def sentence(error: Exception) -> str:
    """Type, message and place of an error."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({place.name}, line {place.lineno} of {PurePath(place.filename).name})"
