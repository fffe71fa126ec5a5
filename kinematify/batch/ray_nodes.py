"""Workers on the nodes of a Ray cluster: each is an actor that keeps one process of its node, with the same limits."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from kinematify.errors import EnvironmentFault
from kinematify.processes.pool import Processes, TaskFailure
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence
    from types import ModuleType

    from kinematify.processes.pool import WorkerProcess

_PATIENCE = 120.0
"""Seconds over its time after which a task is not waited for any more: its node, or the way to it, is gone."""


class RayNodes:
    """The executor of a cluster, or of this machine where there is none."""

    def __init__(
        self, address: str | None, *, workers: int | None = None, preload: Sequence[str] = (), memory: int | None = None
    ) -> None:
        """Connect, or start a cluster of this machine alone.

        Args:
            address: As `ray.init` takes it; None starts one.
            workers: At a time; one for every processor of the cluster if None.
            preload: Modules that are imported once on every node.
            memory: Address space of each process [bytes].

        Raises:
            EnvironmentFault: Ray is not installed, or the cluster cannot be reached.
        """
        self._ray = _ray()
        try:
            self._ray.init(address=address, log_to_driver=False, logging_level="error", ignore_reinit_error=True)
        except (ConnectionError, RuntimeError, ValueError) as error:
            raise EnvironmentFault(
                f"The Ray cluster {address or 'of this machine'} cannot be reached: {error}. Start it with "
                "`ray start`, or give its --address."
            ) from error
        self._most = workers
        self._actor = self._ray.remote(num_cpus=1, max_restarts=0)(_Keeper)
        self._arguments = (tuple(preload), memory)

    @property
    def capacity(self) -> int:
        """Processors of the cluster as it is now, at most as many as were asked for."""
        there = int(self._ray.cluster_resources().get("CPU", 1))
        return max(1, there if self._most is None else min(there, self._most))

    def start(self) -> RayWorker:
        """Return a worker on the node that has room."""
        return RayWorker(self._ray, self._actor.remote(*self._arguments))

    def wait(self, workers: Collection[RayWorker]) -> list[RayWorker]:
        """Return those of the busy workers that have an answer, whose node has died or whose time is long up."""
        left = min(worker.deadline for worker in workers) - time.monotonic()
        ready, _ = self._ray.wait([worker.answered for worker in workers], timeout=max(0.0, left))
        now = time.monotonic()
        return [worker for worker in workers if worker.answered in ready or now >= worker.deadline]


class RayWorker:
    """An actor on some node."""

    def __init__(self, ray: ModuleType, keeper: Any) -> None:
        self._ray, self._keeper = ray, keeper
        self._started, self.deadline = 0.0, 0.0
        self.answered: Any = None

    def submit(self, task: Callable[[], Any], timeout: float) -> None:
        """Begin a task."""
        self._started = time.monotonic()
        self.deadline = self._started + timeout + _PATIENCE
        self.answered = self._keeper.do.remote(task, timeout)

    def result(self) -> tuple[Any, bool]:
        """Return the result or what became of the task, and whether the worker lives."""
        seconds = time.monotonic() - self._started
        try:
            return self._ray.get(self.answered, timeout=0.0)  # type: ignore[no-any-return]
        except self._ray.exceptions.RayActorError:
            message = "the node of the worker was lost"
        except self._ray.exceptions.GetTimeoutError:
            message = f"no node has answered in {seconds:.0f} s"
        return TaskFailure(status="crash", message=message, seconds=seconds), False

    def stop(self) -> None:
        """End the actor; its process ends with it."""
        self._ray.kill(self._keeper)


class _Keeper:
    """The actor: it hands tasks to a process of its node, which may die, hang or leak."""

    def __init__(self, preload: Sequence[str], memory: int | None) -> None:
        self._executor = Processes(1, preload=preload, memory=memory)
        self._worker: WorkerProcess | None = None

    def do(self, task: Callable[[], Any], timeout: float) -> tuple[Any, bool]:
        """Return the result of a task, or its failure, and whether the process lives."""
        worker = self._worker or self._executor.start()
        worker.submit(task, timeout)
        self._executor.wait([worker])
        result, alive = worker.result()
        if not alive:
            worker.stop()
        self._worker = worker if alive else None
        return result, alive


def _ray() -> ModuleType:
    require("--engine ray, here and on every node,", "ray")
    import ray  # noqa: PLC0415  # of an extra

    module: ModuleType = ray
    return module
