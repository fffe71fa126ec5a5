"""Loops whose items are done in forked copies of this process: they have all that it holds, and only results travel."""

from __future__ import annotations

import multiprocessing
import os
import sys
from contextlib import closing, contextmanager
from contextvars import ContextVar
from functools import partial
from multiprocessing.reduction import ForkingPickler
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from kinematify.errors import EnvironmentFault
from kinematify.processes.pool import Processes, TaskFailure, WorkItem, in_worker, run_tasks
from kinematify.processes.start import only_threads_of_python

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")

_LONG = 1e6
"""Time that an item may take [s]: as long as it would take in this process."""
_JOBS: ContextVar[int] = ContextVar("jobs", default=1)
_WORK: ContextVar[Callable[[int], Any]] = ContextVar("work")


@contextmanager
def using_processes(jobs: int | None) -> Iterator[None]:
    """Let loops inside use so many processes, as many as there are cores if absent; a worker of a pool uses one."""
    count = jobs or os.cpu_count() or 1
    _keep_embree_alone()
    token = _JOBS.set(count)
    try:
        yield
    finally:
        _JOBS.reset(token)


def _keep_embree_alone() -> None:
    """Make the first scene of Embree while it sees one core: it would start a thread for each other one."""
    if sys.platform == "linux":
        from embreex.rtcore_scene import EmbreeScene  # noqa: PLC0415 - heavy

        cores = os.sched_getaffinity(0)
        os.sched_setaffinity(0, {min(cores)})
        EmbreeScene()
        os.sched_setaffinity(0, cores)


def each(work: Callable[[_Item], _Result], items: Sequence[_Item]) -> list[_Result]:
    """Return the result of every item, in their order: the same for any number of processes.

    All are done in this process where only one is allowed, in a worker of a pool, or where a library has started
    threads, whose locks a copy might inherit in any state.

    Args:
        work: Gives a picklable result; what else it changes is lost.
        items: Each is done on its own; the longest should come first.

    Raises:
        EnvironmentFault: A process died or failed.
    """
    count = min(_JOBS.get(), len(items))
    if count < 2 or in_worker() or not only_threads_of_python():
        return [work(item) for item in items]
    found: dict[str, _Result] = {}
    tasks = (WorkItem(key=str(k), call=partial(_done, k), timeout=_LONG) for k in range(len(items)))
    token = _WORK.set(lambda k: work(items[k]))
    try:
        with closing(
            run_tasks(tasks, Processes(count, context=multiprocessing.get_context("fork")), reuse=len(items))
        ) as running:
            for key, result in running:
                if isinstance(result, TaskFailure):
                    raise EnvironmentFault(
                        f"One of {count} processes that shared the work gave no result: {result.message}. With "
                        "--jobs 1, all is done in one process, which needs less memory."
                    )
                found[key] = result
    finally:
        _WORK.reset(token)
    return [found[str(k)] for k in range(len(items))]


def _view(items: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    return MappingProxyType(items)


ForkingPickler.register(MappingProxyType, lambda view: (_view, (dict(view),)))


def _done(k: int) -> Any:
    """The result of an item of the loop that this copy was made for."""
    return _WORK.get()(k)
