"""Validations of a night: which there are, and running them side by side, each in a process of its own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import ValidationError

from kinematify.evaluation.nightly.record import Run
from kinematify.evaluation.nightly.unit import ANSWER, REQUEST, UnitAnswer, UnitRequest

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.evaluation.datasets import BenchObject
    from kinematify.evaluation.nightly.settings import NightlySettings

_LOOK = 0.05
"""Seconds between two looks at what has ended."""
_LAST_WORDS = 300
"""Characters of what a process said when it failed."""


@dataclass(frozen=True, kw_only=True)
class Unit:
    """One validation to run."""

    key: str
    scenario: str
    item: BenchObject
    source: str
    request: UnitRequest


@dataclass(frozen=True, kw_only=True, eq=False)
class _Running:
    unit: Unit
    process: subprocess.Popen[bytes]
    answer: Path
    log: Path
    started: float


def unit_request(
    item: BenchObject, source: str, settings: NightlySettings, *, infer: str, pages: Path | None
) -> UnitRequest:
    """What the process of a validation is told.

    Args:
        item: The object.
        source: Which of its models.
        settings: Of the night.
        infer: Function under test.
        pages: Folder for the page of each model; None for no pages.
    """
    return UnitRequest(
        urdf=str(item.urdf.absolute()),
        package_dirs=tuple(str(folder) for folder in item.package_dirs),
        source=source,
        infer=infer,
        infer_config=settings.infer_config,
        validation_config=settings.validation_config,
        engines=tuple(settings.engines),
        checks=tuple(settings.checks),
        budget=settings.budget,
        title=f"{item.name}, {source} model",
        page="" if pages is None else str((pages / page_name(item.name, source)).absolute()),
    )


def page_name(item: str, source: str) -> str:
    """File of the page of a model; names of objects may hold what no file name can."""
    plain = "".join(letter if letter.isascii() and (letter.isalnum() or letter in "._-") else "-" for letter in item)
    return f"{plain}-{source}.html"


def run_units(units: Sequence[Unit], *, workers: int, timeout: float) -> Iterator[Run]:
    """Yield the run of every unit as it ends; closing the iterator stops all processes.

    Args:
        units: Started in this order.
        workers: Processes at a time.
        timeout: Wall time after which one is stopped [s].
    """
    waiting = deque(units)
    active: list[_Running] = []
    with tempfile.TemporaryDirectory(prefix="kinematify-night-", ignore_cleanup_errors=True) as folder:
        try:
            while waiting or active:
                while waiting and len(active) < workers:
                    active.append(_start(waiting.popleft(), Path(folder)))
                for running in [item for item in active if _over(item, timeout)]:
                    active.remove(running)
                    yield _run(running.unit, _collect(running, timeout))
                time.sleep(_LOOK)
        finally:
            for running in active:
                _stop(running)


def _start(unit: Unit, folder: Path) -> _Running:
    request, answer, log = (folder / f"{unit.key}.{end}" for end in ("request", "answer", "log"))
    request.write_bytes(REQUEST.dump_json(unit.request))
    with log.open("wb") as out:
        process = subprocess.Popen(
            [sys.executable, "-m", "kinematify.evaluation.nightly.unit", str(request), str(answer)],
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=subprocess.STDOUT,
            env={**os.environ, **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")},
            start_new_session=True,  # Ctrl-C is answered here alone, and a hang is stopped with all it has started
        )
    return _Running(unit=unit, process=process, answer=answer, log=log, started=time.monotonic())


def _over(running: _Running, timeout: float) -> bool:
    return running.process.poll() is not None or time.monotonic() - running.started > timeout


def _collect(running: _Running, timeout: float) -> UnitAnswer:
    """What the process answered, or how it ended without an answer."""
    seconds = round(time.monotonic() - running.started, 3)
    code = running.process.poll()
    _stop(running)
    try:
        return ANSWER.validate_json(running.answer.read_bytes())
    except (OSError, ValidationError):
        if code is None:
            return UnitAnswer(status="timeout", seconds=seconds, message=f"stopped after {timeout:.0f} s")
        said = running.log.read_text(encoding="utf-8", errors="replace").strip().rpartition("\n")[2]
        return UnitAnswer(
            status="crash", seconds=seconds, message=f"ended with status {code} {said[:_LAST_WORDS]}".strip()
        )


def _stop(running: _Running) -> None:
    with suppress(ProcessLookupError):  # it has ended, and so has all that it started
        os.killpg(running.process.pid, signal.SIGKILL)
    running.process.wait()


def _run(unit: Unit, answer: UnitAnswer) -> Run:
    return Run(
        key=unit.key,
        scenario=unit.scenario,
        object=unit.item.name,
        kind=unit.item.kind,
        category=unit.item.category,
        what="validation",
        case=unit.source,
        status=answer.status,
        message=answer.message,
        seconds=answer.seconds,
        values=answer.values,
        problems=answer.problems,
        not_run=answer.not_run,
        families=answer.families,
    )
