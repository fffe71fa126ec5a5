"""Tasks in processes of their own, so that a crash, a hang or a leak ends with the task that caused it; resumable.

What has ended stands in a file of JSON lines, so that a run that was killed goes on where it stopped.
"""

from __future__ import annotations

import json
import multiprocessing
import os
import select
import signal
import sys
import threading
import time
import traceback
from collections import deque
from contextlib import closing, suppress
from dataclasses import asdict, dataclass, field
from multiprocessing import connection, forkserver
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar

from pydantic import TypeAdapter, ValidationError

from kinematify.errors import OutputError

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Mapping, Sequence
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess
    from types import TracebackType
    from typing import Self

    Progress = Callable[[str, float], None]

_Result = TypeVar("_Result")
_THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
WORK_FOLDER = Path(".kinematify-bench")
"""Where results are kept between runs, in the folder from which the command is called."""


@dataclass(frozen=True, kw_only=True)
class TaskFailure:
    """How a task ended that gave no result."""

    status: Literal["error", "timeout", "crash"]
    message: str
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Pool:
    """How many processes there are, and where results are kept."""

    folder: Path = WORK_FOLDER
    workers: int = field(default_factory=lambda: os.cpu_count() or 1)
    fresh: bool = False
    """Forget what the folder holds; otherwise what has ended is not run again."""
    progress: Progress = lambda what, share: None
    """Told what has just ended and the fraction done in [0, 1]."""

    def run(
        self,
        tasks: Mapping[str, Callable[[], _Result]],
        adapter: TypeAdapter[_Result],
        *,
        ledger: str,
        timeout: float,
        said: Callable[[str, _Result | TaskFailure], str],
        preload: Sequence[str] = (),
        reuse: int = 1,
    ) -> dict[str, _Result | TaskFailure]:
        """Return the result of every task in the order given, those of an earlier run taken up.

        Args:
            tasks: By keys that are equal only where nothing that a result depends on has changed; picklable.
            adapter: Of the results' type.
            ledger: Name of the file in the folder, without suffix.
            timeout: Wall time after which a task is stopped with all that it has started [s].
            said: What progress is told of a key and its result.
            preload: Modules that are imported once for all processes.
            reuse: Tasks that a process takes one after the other; 1 gives each its own.

        Raises:
            OutputError: The folder cannot be written.
            KeyboardInterrupt: Ctrl-C; processes are stopped, results are kept.
        """
        with _Ledger(self.folder / f"{ledger}.jsonl", adapter) as file:
            if self.fresh:
                file.clear()
            known = {key: result for key, result in file.read().items() if key in tasks}
            missing = {key: task for key, task in tasks.items() if key not in known}
            if known:
                self.progress("taken up from an earlier run", len(known) / len(tasks))
            running = run_tasks(missing, workers=self.workers, timeout=timeout, preload=preload, reuse=reuse)
            with closing(running):  # an interrupt must stop the processes now, not when the generator is collected
                for key, result in running:
                    file.append(key, result)
                    known[key] = result
                    self.progress(said(key, result), len(known) / len(tasks))
        return {key: known[key] for key in tasks}


def run_tasks(
    tasks: Mapping[str, Callable[[], _Result]],
    *,
    workers: int,
    timeout: float,
    preload: Sequence[str] = (),
    reuse: int = 1,
) -> Generator[tuple[str, _Result | TaskFailure]]:
    """Yield key and result of every task as it ends; closing the iterator stops all processes.

    Args:
        tasks: Started in this order.
        workers: Processes at a time, each with one thread per numeric library.
        timeout: As in `Pool.run`.
        preload: Likewise.
        reuse: Likewise.
    """
    context = _context(preload)
    waiting = deque(tasks.items())
    active: dict[Connection, _Worker] = {}
    try:
        while waiting or active:
            while waiting and len(active) < workers:
                worker = _Worker(context)
                worker.take(*waiting.popleft())
                active[worker.channel] = worker
            until = min(worker.started for worker in active.values()) + timeout
            ready = connection.wait(list(active), max(0.0, until - time.monotonic()))
            for channel, worker in list(active.items()):
                if channel not in ready and time.monotonic() < worker.started + timeout:
                    continue
                key, (result, alive) = worker.key, worker.collect(timeout, answered=channel in ready)
                if alive and waiting and worker.taken < reuse:
                    worker.take(*waiting.popleft())
                else:
                    del active[channel]
                    worker.stop()
                yield key, result
    finally:
        for worker in active.values():
            worker.stop()


def _context(preload: Sequence[str]) -> multiprocessing.context.ForkServerContext:
    """Start the server that processes are forked from: heavy imports are paid once, one thread per library."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([__name__, *preload])
    before = {name: os.environ.get(name) for name in _THREAD_VARIABLES}
    os.environ.update(dict.fromkeys(_THREAD_VARIABLES, "1"))
    try:
        forkserver.ensure_running()
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
    return context


class _Worker:
    """A process that does one task after the other, the leader of a session of its own."""

    def __init__(self, context: multiprocessing.context.ForkServerContext) -> None:
        self.channel, other = context.Pipe()
        # No daemon, which could not start processes, as validation does.
        self.process: BaseProcess = context.Process(target=_serve, args=(other,))
        self.process.start()
        other.close()  # only the process may hold its end: then its death is seen as the end of the stream
        self.key, self.started, self.taken = "", 0.0, 0

    def take(self, key: str, task: Callable[[], Any]) -> None:
        self.key, self.started, self.taken = key, time.monotonic(), self.taken + 1
        with suppress(BrokenPipeError):  # it died between two tasks: the next look at it tells
            self.channel.send(task)

    def collect(self, timeout: float, *, answered: bool) -> tuple[Any, bool]:
        """What the process answered, or what became of it, and whether it can take another task."""
        seconds = time.monotonic() - self.started
        if not answered:
            return TaskFailure(status="timeout", message=f"stopped after {timeout:.0f} s", seconds=seconds), False
        try:
            return self.channel.recv(), True
        except (EOFError, ConnectionResetError):
            self.process.join()
            code = self.process.exitcode
            cause = signal.Signals(-code).name if code is not None and code < 0 else f"status {code}"
            return TaskFailure(status="crash", message=f"the worker ended with {cause}", seconds=seconds), False

    def stop(self) -> None:
        self.channel.close()
        with suppress(ProcessLookupError, TypeError):  # it has not begun a session yet, or has ended
            os.killpg(self.process.pid, signal.SIGKILL)  # type: ignore[arg-type]  # it was started
        self.process.kill()
        self.process.join()


def _serve(channel: Connection) -> None:
    """Body of a process."""
    os.setsid()  # Ctrl-C is answered by the caller alone, and a hang is stopped with all that it has started
    threading.Thread(target=_end_with_caller, args=(channel.fileno(),), daemon=True).start()
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


class _Ledger(Generic[_Result]):
    """Results of a file of JSON lines, kept open for appending."""

    def __init__(self, path: Path, adapter: TypeAdapter[_Result]) -> None:
        self.path = path
        self._adapter = adapter

    def __enter__(self) -> Self:
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = self.path.open("ab+")
        except OSError as error:
            raise OutputError(
                f"Results cannot be kept in {self.path}: {error}. Give a work folder that can be written."
            ) from error
        self._drop_unfinished_line()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def read(self) -> dict[str, _Result | TaskFailure]:
        """Return the results so far by key; lines that an older version wrote are passed over."""
        self._file.seek(0)
        results: dict[str, _Result | TaskFailure] = {}
        for line in self._file.read().splitlines():
            with suppress(ValueError, KeyError, TypeError, ValidationError):
                facts = json.loads(line)
                failed = facts.get("failure")
                results[facts["key"]] = (
                    TaskFailure(**failed) if failed else self._adapter.validate_python(facts["result"])
                )
        return results

    def append(self, key: str, result: _Result | TaskFailure) -> None:
        """Add a result; it is on disk when this returns."""
        if isinstance(result, TaskFailure):
            facts = {"key": key, "failure": asdict(result)}
        else:
            facts = {"key": key, "result": self._adapter.dump_python(result, mode="json")}
        self._file.write(json.dumps(facts).encode() + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def clear(self) -> None:
        """Forget every result."""
        self._file.truncate(0)

    def _drop_unfinished_line(self) -> None:
        """A killed run can leave half a line, to which the next result must not be glued."""
        self._file.seek(0)
        content = self._file.read()
        self._file.truncate(content.rfind(b"\n") + 1)
