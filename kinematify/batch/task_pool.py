"""Tasks in workers that may crash, hang or leak; what has ended is kept, and a killed run goes on where it stopped."""

from __future__ import annotations

import os
from contextlib import closing, suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from kinematify.batch.ledger import Ledger
from kinematify.processes.pool import Processes, TaskFailure, WorkItem, run_tasks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from kinematify.processes.pool import Executor

    Progress = Callable[[str, float], None]

_Result = TypeVar("_Result")
WORK_FOLDER = Path(".kinematify-bench")
"""Where results are kept between runs, in the folder from which the command is called."""


@dataclass(frozen=True, kw_only=True)
class Pool:
    """Number of processes, and the folder that keeps results."""

    folder: Path = WORK_FOLDER
    workers: int = field(default_factory=lambda: os.cpu_count() or 1)
    fresh: bool = False
    """Forget what the folder holds; otherwise what has ended is not run again."""
    progress: Progress = lambda what, share: None
    """Called with what has just ended and the fraction done in [0, 1]."""

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
        lives: int = 1,
        executor: Executor | None = None,
        failed: Callable[[str, TaskFailure], _Result] | None = None,
    ) -> dict[str, _Result | TaskFailure]:
        """Return the result of every task in the order given, those of an earlier run taken up.

        Args:
            tasks: By keys that are equal only where nothing that a result depends on has changed; picklable.
            adapter: Of the results' type, which has named values.
            ledger: Name of the file in the folder, without suffix.
            timeout: Wall time after which a task is stopped with all that it has started [s].
            said: What progress is given of a key and its result.
            preload: Modules that are imported once for all processes.
            reuse: Tasks that a process takes one after the other; 1 gives each its own.
            lives: Processes that a task may cost before it has failed.
            executor: Starts the processes, in place of `workers` of this machine.
            failed: Makes a result of a failure; if absent, failures are results.

        Raises:
            OutputError: The folder cannot be written.
            KeyboardInterrupt: Ctrl-C; processes are stopped, results are kept.
        """
        with Ledger(self.folder / f"{ledger}.jsonl") as file:
            if self.fresh:
                file.rewrite(())
            known = {key: result for key, result in _kept(file, adapter) if key in tasks}
            missing = [WorkItem(key=k, call=call, timeout=timeout) for k, call in tasks.items() if k not in known]
            if known:
                self.progress("skipped: done earlier", len(known) / len(tasks))
            engine = executor or Processes(self.workers, preload=preload)
            running = run_tasks(missing, engine, reuse=reuse, lives=lives)
            with closing(running):  # an interrupt must stop the processes now, not when the generator is collected
                for key, answer in running:
                    result = failed(key, answer) if failed and isinstance(answer, TaskFailure) else answer
                    file.append(_line(key, result, adapter))
                    known[key] = result
                    self.progress(said(key, result), len(known) / len(tasks))
        return {key: known[key] for key in tasks}


def _kept(file: Ledger, adapter: TypeAdapter[_Result]) -> Iterator[tuple[str, _Result | TaskFailure]]:
    """Results of a ledger by key; lines that an older version wrote are passed over."""
    for facts in file:
        with suppress(KeyError, TypeError, ValidationError):
            key, failed = facts.pop("key"), facts.get("failure")
            yield key, TaskFailure(**failed) if failed else adapter.validate_python(facts)


def _line(key: str, result: _Result | TaskFailure, adapter: TypeAdapter[_Result]) -> dict[str, Any]:
    if isinstance(result, TaskFailure):
        return {"key": key, "failure": asdict(result)}
    return {"key": key, **adapter.dump_python(result, mode="json")}
