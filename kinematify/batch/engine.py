"""Where tasks run: the protocol of workers, and what becomes of a task that gives no result."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Collection


@dataclass(frozen=True, kw_only=True)
class TaskFailure:
    """How a task ended that gave no result."""

    status: Literal["error", "timeout", "crash"]
    message: str
    seconds: float


class Worker(Protocol):
    """Does one task at a time; a task that ends it, hangs or leaks takes down nothing else."""

    def take(self, task: Callable[[], Any], timeout: float) -> None:
        """Begin a picklable task that is stopped after `timeout` seconds, with all that it has started."""

    def answer(self) -> tuple[Any, bool]:
        """Return the result of the task or its `TaskFailure`, and whether the worker can take another one.

        To be called when `Engine.wait` has named the worker.
        """

    def stop(self) -> None:
        """End it now, with all that it has started."""


class Engine(Protocol):
    """Starts workers."""

    @property
    def capacity(self) -> int:
        """Workers that can run at a time at present, at least 1."""

    def start(self) -> Worker:
        """Return a new worker."""

    def wait(self, workers: Collection[Any]) -> list[Any]:
        """Return those of the busy workers that have an answer, have died or whose time is up, at least one."""
