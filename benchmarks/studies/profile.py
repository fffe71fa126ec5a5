"""How much processor time do whole commands take, beside those of an earlier checkout, and where does it go?

Processor seconds of the whole command with all processes that it starts, interpreter and imports included, median of
the repeats, the two checkouts taking turns: unlike the time on the clock they hardly depend on what else the machine
does. Memory is that of the largest process. The shares are of the time on the clock of the command as it is now; "rest"
is start-up, reading and writing, and the engines. `infer` of the earlier checkout does not load its model into engines.
"""

from __future__ import annotations

import ctypes
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from benchmarks.study import Options, Study, among, explained
from kinematify.assembly.erasure import erase
from kinematify.errors import InputError
from kinematify.evaluation.datasets import find_objects
from kinematify.evaluation.result_record import table
from kinematify.generate.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.robot.obj_file import write_obj
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.assembly.part import Part
    from kinematify.evaluation.result_record import Report

ROOT = Path(__file__).resolve().parents[2]
"""The checkout that this runs from."""
_SUBREAPER = 36
"""Of `prctl`: orphans of a command become children of this process, so that their time counts."""


@dataclass(frozen=True, kw_only=True)
class Command:
    """One command that is timed."""

    words: tuple[str, ...]
    """Of the command line; ``IN`` represents the parts or the file, ``OUT`` a folder."""
    given: str
    """``drawer``, a number of parts, or the name of an object of the benchmark."""
    newer: tuple[str, ...] = ()
    """Words that the earlier checkout does not know."""
    asked: float | None = None
    """Largest ratio to the earlier checkout."""

    @property
    def line(self) -> str:
        """As people read it."""
        words = (self.given if word == "IN" else word for word in self.words if word not in ("-o", "OUT"))
        return " ".join((*words, *self.newer))


_INFER = ("infer", "IN", "-o", "OUT")
_PLAIN = (*_INFER, "--no-preview")
COMMANDS = {
    "drawer-all": Command(words=_INFER, given="drawer"),
    "drawer-engines": Command(words=_PLAIN, given="drawer"),
    "drawer": Command(words=_PLAIN, given="drawer", newer=("--no-validation",)),
    **{
        f"infer-{name}": Command(words=_PLAIN, given=name, newer=("--no-validation",), asked=asked)
        for name, asked in (("cabinet_41083", 0.6), ("allegro", 0.4), ("h1", 0.4))
    },
    **{
        f"validate-{name}": Command(words=("validate", "IN"), given=name, asked=0.6)
        for name in ("cabinet_41083", "panda", "h1")
    },
}


class ProfileOptions(Options):
    """What is timed."""

    baseline: str | None = Field(None, description="Folder of an earlier checkout; without one only this is timed.")
    repeats: int = Field(3, ge=1, description="Runs of each command of which the median is taken.")
    commands: Annotated[tuple[str, ...], among(COMMANDS)] = Field(tuple(COMMANDS), description="Which ones.")


@dataclass(frozen=True, kw_only=True)
class Asked:
    """One command to be timed."""

    command: Command
    baseline: str | None
    repeats: int


def measure(options: ProfileOptions, work: Work) -> Measured:
    """Time one command after the other."""
    if options.baseline is not None and not Path(options.baseline, "kinematify").is_dir():
        raise InputError(f"--baseline {options.baseline} is no checkout. Give the folder that holds kinematify/.")
    asked = {
        name: Asked(command=COMMANDS[name], baseline=options.baseline, repeats=options.repeats)
        for name in options.commands
    }
    found = work.each(timed, asked, workers=1, timeout=14400.0)
    commit = None if options.baseline is None else _commit(options.baseline)
    return list(found.values()), {"cores": len(os.sched_getaffinity(0)), "baseline": commit}


def _commit(checkout: str) -> str:
    answer = subprocess.run(["git", "-C", checkout, "rev-parse", "HEAD"], check=False, capture_output=True, text=True)
    return answer.stdout[:7] or "no commit"


def timed(asked: Asked) -> Record:
    """Time one command in both checkouts, by turns."""
    ctypes.CDLL(None).prctl(_SUBREAPER, 1, 0, 0, 0)
    command = asked.command
    before: list[tuple[float, float]] = []
    now: list[tuple[float, float]] = []
    with tempfile.TemporaryDirectory() as folder:
        given, out, cache = _given(command, Path(folder, "in")), Path(folder, "out"), Path(folder, "cache")
        words = [{"IN": str(given), "OUT": str(out)}.get(word, word) for word in command.words]
        more = ["--force"] if "OUT" in command.words else []
        for _ in range(asked.repeats + 1):  # the first run fills the caches of bytecode and of convex pieces
            if asked.baseline is not None:
                before.append(_run(Path(asked.baseline).absolute(), [*words, *more], cache))
            start = time.perf_counter()
            now.append(_run(ROOT, [*words, *more, *command.newer], cache))
            clock = time.perf_counter() - start
        record = json.loads((out / "inference.json").read_text("utf-8")) if more else {"seconds": {}}
    shares = {stage: seconds / clock for stage, seconds in record["seconds"].items()}
    return {
        "command": command.line,
        "asked": command.asked,
        "before": _median(before[1:]),
        "now": _median(now[1:]),
        "shares": {**shares, "rest": 1.0 - sum(shares.values())} if shares else {},
    }


def _median(runs: Sequence[tuple[float, float]]) -> Record | None:
    """Processor time [s] and memory [MB]; None without runs."""
    if not runs:
        return None
    seconds, memory = zip(*runs, strict=True)
    return {"seconds": statistics.median(seconds), "memory": statistics.median(memory)}


def _given(command: Command, place: Path) -> Path:
    """Write what a command is given."""
    if command.given == "drawer":
        return _written(build(FAMILIES["cabinet"], {"doors": 0, "drawers": 1, "shelves": 0}).assembly.parts, place)
    item = next((item for item in find_objects() if item.name == command.given), None)
    if item is None:
        raise InputError(f"The benchmark has no {command.given}. Leave it out with --commands.")
    if "OUT" not in command.words:
        return item.urdf
    return _written(erase(read_robot(item.urdf), pose="rest", seed=0, yaw_deg=0.0).parts, place)


def _written(parts: Sequence[Part], folder: Path) -> Path:
    folder.mkdir()
    for part in parts:
        write_obj(folder / f"{part.name}.obj", part.vertices, part.faces)
    return folder


def _run(checkout: Path, words: Sequence[str], cache: Path) -> tuple[float, float]:
    """Processor time [s] of a command with all that it starts, and the memory of its largest process [MB]."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"} | {
        "PYTHONPATH": str(checkout),
        "PYTHONPYCACHEPREFIX": str(cache / "bytecode"),
        "XDG_CACHE_HOME": str(cache / checkout.name),
    }
    command = subprocess.Popen(
        [sys.executable, "-m", "kinematify", *words],
        env=environment,
        cwd=checkout,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    _, status, used = os.wait4(command.pid, 0)
    command.returncode = os.waitstatus_to_exitcode(status)
    usages = [used]
    while True:
        try:
            usages.append(os.wait3(0)[2])
        except ChildProcessError:
            break
    if command.returncode not in (0, 1):
        raise InputError(f"`kinematify {' '.join(words)}` ended with {command.returncode} in {checkout}.")
    seconds = sum(usage.ru_utime + usage.ru_stime for usage in usages)
    return seconds, max(usage.ru_maxrss for usage in usages) / 1024.0


def report(found: Report[Record]) -> list[str]:
    """A line for each command."""
    rows = [
        (
            item["command"],
            *(f"{item[when]['seconds']:.2f} s" if item[when] else "-" for when in ("before", "now")),
            f"{item['now']['seconds'] / item['before']['seconds']:.2f}" if item["before"] else "-",
            "-" if item["asked"] is None else f"{item['asked']:.1f}",
            *(f"{item[when]['memory']:.0f} MB" if item[when] else "-" for when in ("before", "now")),
            ", ".join(f"{stage} {share:.0%}" for stage, share in item["shares"].items()) or "-",
        )
        for item in found.records
    ]
    titles = ("command", "before", "now", "ratio", "asked", "memory before", "now", "where the time goes now")
    facts = f"{found.summary['cores']} cores; before: {found.summary['baseline'] or '-'}."
    return [explained(__doc__), facts, table(titles, rows)]


STUDY = Study(title="Processor time of whole commands", options=ProfileOptions, measure=measure, report=report)
