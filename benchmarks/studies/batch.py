"""How many objects does `kinematify batch` convert in an hour, and is one lost when workers and drivers are killed?

Generated objects with known joints, given as URDFs whose joints are not looked at; whole commands, start included. The
cost of a step is fitted to its times: seconds = start + a * parts + b * faces, none of them negative. The killed run
loses a worker now and then and its driver at equal shares of the way, and goes on with --resume each time.
"""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field
from scipy.optimize import nnls

from benchmarks.study import Options, Study, explained
from kinematify.batch.batch_summary import STEP_HEADINGS, step_rows
from kinematify.batch.manifest import RECORD
from kinematify.config import load_config
from kinematify.evaluation.result_record import table
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.registry import FAMILIES, build

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.batch.manifest import ObjectRecord
    from kinematify.evaluation.result_record import Report

_LOOK = 0.1
"""Seconds between two looks at a run that is to be killed."""
_MILLION = 1_000_000


class BatchOptions(Options):
    """What is converted."""

    objects: int = Field(20, ge=1, description="Objects of the runs that are timed.")
    killed: int = Field(20, ge=1, description="Objects of the run whose workers and driver are killed.")
    every: float = Field(20.0, gt=0.0, description="Seconds between two kills of a worker.")
    drivers: int = Field(2, ge=0, description="Times that the driver is killed.")
    workers: int = Field(2, ge=1, description="Workers beside the run with one.")
    steps: str = Field("infer,validate", description="Steps, separated by commas.")
    seed: int = Field(0, description="Of the objects.")


@dataclass(frozen=True, kw_only=True)
class Timed:
    """A run to be timed."""

    pattern: str
    steps: str
    engine: str
    workers: int


@dataclass(frozen=True, kw_only=True)
class Killed:
    """A run whose processes are killed."""

    pattern: str
    steps: str
    objects: int
    workers: int
    every: float
    """Seconds between two kills of a worker."""
    drivers: int
    """Times that the driver is killed."""


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """An object to be written: of a kind, a quarter of them ajar."""

    folder: Path
    family: str
    seed: list[int]


def written_object(asked: Drawn) -> Record:
    """Write one object; it appears whole or not at all."""
    rng = np.random.default_rng(asked.seed)
    seed, share = int(rng.integers(2**31)), round(float(rng.uniform(0.05, 0.6)), 2)
    name = f"{asked.family}_{asked.seed[1]:03d}"
    blueprint = build(asked.family, {"open": share if rng.random() < 0.25 else 0.0}, seed=seed, name=name)
    asked.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=asked.folder.parent) as aside:
        write_blueprint(blueprint, Path(aside, name), load_config())
        Path(aside, name).replace(asked.folder / name)
    return {"object": name}


def measure(options: BatchOptions, work: Work) -> Measured:
    """Time one worker, several, and Ray where it is installed; then kill."""
    patterns = []
    for count in (options.objects, options.killed):
        folder = work.folder.absolute() / f"families-{count}-{options.seed}"
        names = sorted(FAMILIES)
        drawn = [Drawn(folder=folder, family=names[k % len(names)], seed=[options.seed, k]) for k in range(count)]
        work.each(written_object, {f"{count}: {k}": item for k, item in enumerate(drawn)}, reuse=count)
        patterns.append(f"{folder}/*/model.urdf")
    engines = ["local", *(["ray"] if importlib.util.find_spec("ray") else [])]
    runs = {
        f"{engine}, {workers} workers": Timed(pattern=patterns[0], steps=options.steps, engine=engine, workers=workers)
        for engine, workers in [("local", 1), *((engine, options.workers) for engine in engines)]
    }
    killed = Killed(
        pattern=patterns[1],
        steps=options.steps,
        objects=options.killed,
        workers=options.workers,
        every=options.every,
        drivers=options.drivers,
    )
    timed = work.each(timed_run, runs, workers=1, timeout=24 * 3600.0)
    harmed = work.each(killed_run, {"killed": killed}, workers=1, timeout=24 * 3600.0)
    return [*timed.values(), *harmed.values()], {}


def timed_run(asked: Timed) -> Record:
    """Convert all objects into a folder that is thrown away."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        answer = Path(folder, "answer.json")
        command = _command(asked.pattern, asked.steps, Path(folder, "out"), asked.workers)
        subprocess.run([*command, "--engine", asked.engine, "--json", str(answer)], capture_output=True, check=False)
        seconds = time.perf_counter() - start
        records = json.loads(answer.read_text("utf-8"))["records"]
    objects = [{**record, "source": record["object"]} for record in records]  # the same wherever they lie
    return {
        "run": "timed", "engine": asked.engine, "workers": asked.workers, "seconds": seconds, "objects": objects,
    }  # fmt: skip


def killed_run(asked: Killed) -> Record:
    """Convert all objects while processes are killed, and count what the manifest lacks or has twice."""
    rng = np.random.default_rng(0)
    workers_killed = drivers_killed = 0
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        manifest = Path(folder, "out", "manifest.jsonl")
        command = [*_command(asked.pattern, asked.steps, manifest.parent, asked.workers), "--resume"]
        driver, next_kill = _started(command), time.perf_counter() + asked.every
        while driver.poll() is None:
            time.sleep(_LOOK)
            ended = manifest.read_bytes().count(b"\n") if manifest.is_file() else 0
            if drivers_killed < asked.drivers and ended >= asked.objects * (drivers_killed + 1) / (asked.drivers + 1):
                driver.kill()
                driver.wait()
                drivers_killed += 1
                driver = _started(command)
            elif time.perf_counter() >= next_kill and (workers := workers_of(driver.pid)):
                with suppress(ProcessLookupError):
                    os.kill(int(rng.choice(workers)), signal.SIGKILL)
                    workers_killed += 1
                next_kill = time.perf_counter() + asked.every
        lines = [json.loads(line) for line in manifest.read_text("utf-8").splitlines()]
    times = Counter(line["source"] for line in lines)
    return {
        "run": "killed",
        "objects": asked.objects,
        "workers": asked.workers,
        "workers_killed": workers_killed,
        "drivers_killed": drivers_killed,
        "seconds": time.perf_counter() - start,
        "lost": asked.objects - len(times),
        "doubled": len(lines) - len(times),
        "status": dict(Counter(line["status"] for line in lines)),
    }


def workers_of(driver: int) -> list[int]:
    """Workers of a run: processes below its driver that lead a session of their own."""
    found: dict[int, tuple[int, int]] = {}
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(FileNotFoundError, ProcessLookupError):
            state, parent, _, session = (folder / "stat").read_text("ascii", "replace").rpartition(")")[2].split()[:4]
            if state != "Z":
                found[int(folder.name)] = int(parent), int(session)
    leaders, below = [], {driver}
    while below:
        below = {process for process, (parent, _) in found.items() if parent in below}
        leaders += [process for process in below if found[process][1] == process]
    return sorted(leaders)


def _command(pattern: str, steps: str, out: Path, workers: int) -> list[str]:
    words = ["batch", pattern, "-o", str(out), "--steps", steps, "--workers", str(workers)]
    return [sys.executable, "-m", "kinematify", *words]


def _started(command: Sequence[str]) -> subprocess.Popen[bytes]:
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def report(found: Report[Record]) -> list[str]:
    """Throughput, the cost of each step, what a million objects would cost, and what the kills did."""
    runs = [record for record in found.records if record["run"] == "timed"]
    single = runs[0]
    records = [RECORD.validate_python(facts) for facts in single["objects"]]
    return [
        explained(__doc__),
        "## Throughput",
        table(
            ("engine", "workers", "objects", "seconds", "objects an hour", "times one worker"),
            [_throughput_row(run, single) for run in runs],
        ),
        "## Cost of a step",
        table(STEP_HEADINGS, step_rows(records)),
        table(
            ("step", "start [s]", "a part more [ms]", "1,000 faces more [ms]"),
            [(step, *cost) for step, cost in _costs(records).items()],
        ),
        _arithmetic(single),
        "## Killed",
        table(
            ("objects", "workers killed", "drivers killed", "lost", "doubled", "ended as"),
            [_killed_row(record) for record in found.records if record["run"] == "killed"],
        ),
    ]


def _arithmetic(single: Record) -> str:
    hours = single["seconds"] / len(single["objects"]) * _MILLION / 3600.0
    return (
        f"By arithmetic from the run with one worker, not measured: a million such objects take {hours:,.0f} hours of "
        f"one processor, {hours / 1000.0:,.1f} hours of a thousand."
    )


def _throughput_row(run: Record, single: Record) -> tuple[str, ...]:
    seconds, count = run["seconds"], len(run["objects"])
    cells = (f"{seconds:.0f}", f"{3600.0 * count / seconds:.0f}", f"{single['seconds'] / seconds:.2f}")
    return (run["engine"], str(run["workers"]), str(count), *cells)


def _killed_row(record: Record) -> tuple[str, ...]:
    counts = (str(record[name]) for name in ("objects", "workers_killed", "drivers_killed", "lost", "doubled"))
    return (*counts, ", ".join(f"{count} {status}" for status, count in sorted(record["status"].items())))


def _costs(records: Sequence[ObjectRecord]) -> dict[str, tuple[str, str, str]]:
    """Cost of each step that knows parts and faces: at its start, for a part and for 1,000 faces more."""
    known = [record for record in records if record.parts is not None and record.faces is not None]
    sizes = np.array([(1.0, record.parts, record.faces) for record in known])
    costs = {}
    for step in dict.fromkeys(step for record in known for step in record.step_seconds):
        start, part, face = nnls(sizes, np.array([record.step_seconds.get(step, 0.0) for record in known]))[0]
        costs[step] = (f"{start:.2f}", f"{1.0e3 * part:.1f}", f"{1.0e6 * face:.1f}")
    return costs


def faults(found: Report[Record]) -> list[str]:
    """What must not be: a record that is lost or doubled."""
    return [
        f"Of {record['objects']} objects {record['lost']} are lost and {record['doubled']} doubled."
        for record in found.records
        if record["run"] == "killed" and (record["lost"] or record["doubled"])
    ]


STUDY = Study(title="Objects an hour, and kills", options=BatchOptions, measure=measure, report=report, faults=faults)
