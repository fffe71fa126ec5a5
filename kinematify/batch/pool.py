"""Tasks in workers that may crash, hang or leak; what has ended is kept, and a killed run goes on where it stopped."""

from __future__ import annotations

import os
from collections import Counter, deque
from contextlib import closing, suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from kinematify.batch.engine import TaskFailure
from kinematify.batch.ledger import Ledger
from kinematify.batch.processes import Processes

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence

    from kinematify.batch.engine import Engine, Worker

    Progress = Callable[[str, float], None]

_Result = TypeVar("_Result")
WORK_FOLDER = Path(".kinematify-bench")
"""Where results are kept between runs, in the folder from which the command is called."""


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
        with Ledger(self.folder / f"{ledger}.jsonl") as file:
            if self.fresh:
                file.rewrite(())
            known = {key: result for key, result in _kept(file, adapter) if key in tasks}
            missing = [(key, task) for key, task in tasks.items() if key not in known]
            if known:
                self.progress("taken up from an earlier run", len(known) / len(tasks))
            running = run_tasks(missing, Processes(self.workers, preload=preload), timeout=timeout, reuse=reuse)
            with closing(running):  # an interrupt must stop the processes now, not when the generator is collected
                for key, result in running:
                    file.append(_line(key, result, adapter))
                    known[key] = result
                    self.progress(said(key, result), len(known) / len(tasks))
        return {key: known[key] for key in tasks}


def run_tasks(
    tasks: Iterable[tuple[str, Callable[[], _Result]]],
    engine: Engine,
    *,
    timeout: float,
    reuse: int = 1,
    lives: int = 1,
) -> Generator[tuple[str, _Result | TaskFailure]]:
    """Yield key and result of every task as it ends; closing the iterator stops all workers.

    Args:
        tasks: By keys, each once; started in this order, and taken from the iterator as workers come free.
        engine: Starts the workers.
        timeout: Wall time after which a task is stopped with all that it has started [s].
        reuse: Tasks that a worker takes one after the other.
        lives: A task whose worker dies is begun again until it has cost as many; then that is its failure.
    """
    upcoming, deaths = iter(tasks), Counter[str]()
    again: deque[tuple[str, Callable[[], _Result]]] = deque()
    active: dict[Worker, tuple[str, Callable[[], _Result], int]] = {}  # its task, and how many it has taken with it
    try:
        while True:
            while len(active) < engine.capacity and (given := again.popleft() if again else next(upcoming, None)):
                worker = engine.start()
                active[worker] = (*given, 1)
                worker.take(given[1], timeout)
            if not active:
                return
            for worker in engine.wait(active):
                key, task, taken = active.pop(worker)
                result, alive = worker.answer()
                died = isinstance(result, TaskFailure) and result.status == "crash"
                deaths[key] += died
                if died and deaths[key] < lives:
                    again.append((key, task))
                if alive and taken < reuse and (given := again.popleft() if again else next(upcoming, None)):
                    active[worker] = (*given, taken + 1)
                    worker.take(given[1], timeout)
                else:
                    worker.stop()
                if not died:
                    yield key, result
                elif deaths[key] == lives:
                    times = f", the last of {lives} that it cost" if lives > 1 else ""
                    yield key, replace(result, message=result.message + times)
    finally:
        for worker in active:
            worker.stop()


def _kept(file: Ledger, adapter: TypeAdapter[_Result]) -> Iterator[tuple[str, _Result | TaskFailure]]:
    """Results of a ledger by key; lines that an older version wrote are passed over."""
    for facts in file:
        with suppress(KeyError, TypeError, ValidationError):
            failed = facts.get("failure")
            yield facts["key"], TaskFailure(**failed) if failed else adapter.validate_python(facts["result"])


def _line(key: str, result: _Result | TaskFailure, adapter: TypeAdapter[_Result]) -> dict[str, Any]:
    if isinstance(result, TaskFailure):
        return {"key": key, "failure": asdict(result)}
    return {"key": key, "result": adapter.dump_python(result, mode="json")}
