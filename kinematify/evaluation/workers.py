"""Worker processes: one per job, so that a crash, a hang or a leak ends with the job that caused it."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
import time
from collections import deque
from dataclasses import dataclass
from multiprocessing import connection, forkserver
from typing import TYPE_CHECKING

from kinematify.evaluation.job import Failure, run_job, unscored

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess

    from kinematify.evaluation.job import Job, JobResult

_THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True, kw_only=True, eq=False)
class _Running:
    job: Job
    key: str
    process: BaseProcess
    started: float
    failure: Failure | None


def run_jobs(jobs: Sequence[tuple[str, Job]], *, workers: int, timeout: float) -> Iterator[JobResult]:
    """Yield the result of every job as it finishes; closing the iterator stops all workers.

    A job that crashes or runs out of time gets a second worker, which only scores the missing answer.

    Args:
        jobs: Keys and jobs, started in this order.
        workers: Processes at a time, each with one thread.
        timeout: Wall time after which a job is stopped [s].
    """
    context = _context(cavl=any(job.config.joints.method == "cavl" for _, job in jobs))
    waiting: deque[tuple[str, Job, Failure | None]] = deque((key, job, None) for key, job in jobs)
    active: dict[Connection, _Running] = {}
    try:
        while waiting or active:
            while waiting and len(active) < workers:
                receiver, running = _start(context, *waiting.popleft())
                active[receiver] = running
            for receiver in _finished(active, timeout):
                running = active.pop(receiver)
                answer = _collect(receiver, running, timeout)
                if isinstance(answer, Failure):
                    waiting.appendleft((running.key, running.job, answer))
                else:
                    yield answer
    finally:
        for receiver, running in active.items():
            _stop(receiver, running)


def _context(*, cavl: bool) -> multiprocessing.context.ForkServerContext:
    """Start the server that workers are forked from: the heavy imports are paid once, one thread per library."""
    context = multiprocessing.get_context("forkserver")
    torch_too = ["kinematify.paper.joints"] if cavl else []
    context.set_forkserver_preload(["kinematify.pipeline", "kinematify.evaluation.job", *torch_too])
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


def _start(
    context: multiprocessing.context.ForkServerContext, key: str, job: Job, failure: Failure | None
) -> tuple[Connection, _Running]:
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(sender, job, key, failure), daemon=True)
    process.start()
    # Only the worker may hold the sending end: then its death is seen as the end of the stream.
    sender.close()
    return receiver, _Running(job=job, key=key, process=process, started=time.monotonic(), failure=failure)


def _work(sender: Connection, job: Job, key: str, failure: Failure | None) -> None:
    """Body of a worker. Ctrl-C reaches the whole process group; the parent alone answers it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if "torch" in sys.modules:
        sys.modules["torch"].set_num_threads(1)
    result = run_job(job, key=key, failure=failure)
    # Nobody listens any more where the run itself was killed.
    with contextlib.suppress(BrokenPipeError):
        sender.send(result)


def _finished(active: dict[Connection, _Running], timeout: float) -> list[Connection]:
    """Wait until a worker answers, dies or runs out of time."""
    next_deadline = min(running.started for running in active.values()) + timeout
    ready = connection.wait(list(active), max(0.0, next_deadline - time.monotonic()))
    overdue = time.monotonic() - timeout
    return [receiver for receiver, running in active.items() if receiver in ready or running.started <= overdue]


def _collect(receiver: Connection, running: _Running, timeout: float) -> JobResult | Failure:
    """Return a worker's result, or what became of it."""
    seconds = time.monotonic() - running.started
    try:
        answer: JobResult | Failure = receiver.recv() if receiver.poll() else _timed_out(timeout, seconds)
    except EOFError:
        running.process.join()
        answer = _crashed(running.process.exitcode, seconds)
    _stop(receiver, running)
    if isinstance(answer, Failure) and running.failure is not None:
        return unscored(running.job, running.key, running.failure)
    return answer


def _timed_out(timeout: float, seconds: float) -> Failure:
    return Failure(status="timeout", message=f"stopped after {timeout:.0f} s", seconds=seconds)


def _crashed(exit_code: int | None, seconds: float) -> Failure:
    cause = signal.Signals(-exit_code).name if exit_code is not None and exit_code < 0 else f"status {exit_code}"
    return Failure(status="crash", message=f"the worker ended with {cause}", seconds=seconds)


def _stop(receiver: Connection, running: _Running) -> None:
    receiver.close()
    running.process.kill()
    running.process.join()
