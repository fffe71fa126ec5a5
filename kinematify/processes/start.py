"""Start of processes: forked from one that has the heavy imports done, so that each costs milliseconds.

That is the caller's own where no library has started threads in it, whose locks a copy might inherit in any state, and
else a server.
"""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import signal
import sys
import threading
from contextlib import contextmanager
from multiprocessing import forkserver, resource_tracker
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from multiprocessing.context import ForkContext, ForkServerContext

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Variables of workers: one thread per library, as there are as many workers as cores."""


_MMAP_THRESHOLD, _TRIM_THRESHOLD = -3, -1
"""Numbers of glibc's options (mallopt(3))."""
_KEPT = 1 << 29
"""Memory that a process keeps at most when it is freed [bytes]."""


def keep_memory() -> None:
    """Keep what is freed for what comes next: glibc returns it, and each large array costs new pages, zeroed again."""
    if sys.platform == "linux" and (mallopt := getattr(ctypes.CDLL(None), "mallopt", None)):  # musl has none
        mallopt(_MMAP_THRESHOLD, _KEPT)
        mallopt(_TRIM_THRESHOLD, _KEPT)


class _Server:
    """Test whether the caller wants workers to come from the server alone."""

    wanted = False


def ensure_server(preload: Iterable[str], variables: Mapping[str, str] = ONE_THREAD) -> ForkServerContext:
    """Start the server, if it does not run; its imports go on beside the caller's work.

    Args:
        preload: Modules that it imports once for all workers.
        variables: Of its environment.
    """
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(preload))
    resource_tracker.ensure_running()  # else it would be started meanwhile, and end the deafness
    with environment_variables(variables), without_main(), deaf():
        forkserver.ensure_running()
    return context


def use_server(preload: Iterable[str], variables: Mapping[str, str] = ONE_THREAD) -> None:
    """Start the server as `ensure_server` does, and let `worker_context` name it from now on."""
    ensure_server(preload, variables)
    _Server.wanted = True


def worker_context() -> ForkContext | ForkServerContext:
    """Return what starts processes: the server once it is used, else this process while its threads are Python's."""
    if _Server.wanted or not only_threads_of_python():
        return multiprocessing.get_context("forkserver")
    return multiprocessing.get_context("fork")


def only_threads_of_python() -> bool:
    """True if no library has started threads in this process."""
    try:
        return sum(1 for _ in Path("/proc/self/task").iterdir()) == threading.active_count()
    except OSError:
        return False  # not Linux: who knows


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
def deaf() -> Iterator[None]:
    """Keep Ctrl-C from what is started meanwhile, its imports included; it is answered here right after."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def without_main() -> Iterator[None]:
    """Hide the caller's script, which workers would run again although they need nothing of it."""
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main
