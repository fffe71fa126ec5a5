"""The benchmark: every object under every condition and configuration, in worker processes, resumable."""

from __future__ import annotations

import datetime
import os
import platform
import shlex
import sys
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from kinematify.config import Config, load_config
from kinematify.errors import ConfigError, InputError
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, Condition, find_objects
from kinematify.evaluation.job import INFER, Job, JobResult
from kinematify.evaluation.ledger import RESULT, Ledger, code_version
from kinematify.evaluation.perturb import CLEAN
from kinematify.evaluation.workers import run_jobs
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    Progress = Callable[[str, float], None]


class _OfObject(Protocol):
    @property
    def object(self) -> str: ...


DEFAULT_TIMEOUT = 900.0
"""Wall time for one object [s]; H1 is allowed 40 s."""


@dataclass(frozen=True, kw_only=True)
class Variant:
    """A configuration under test."""

    label: str
    config: str | Path
    """Name of a shipped configuration or path of a YAML file."""
    changes: Mapping[str, Any] = field(default_factory=dict)
    """Dotted name of a field -> its value, e.g. ``{"topology.mode": "bfs"}``."""

    def load(self) -> Config:
        """Return the configuration.

        Raises:
            ConfigError: It is unknown or a change does not fit.
        """
        return changed(load_config(self.config), self.changes)


DEFAULT_VARIANTS = (Variant(label="default", config="default"),)
PAPER_VARIANTS = (
    Variant(label="paper", config="paper"),
    Variant(label="paper without MCTS", config="paper", changes={"topology.mode": "bfs"}),
    Variant(
        label="paper without DW-CAVL",
        config="paper",
        changes={"cavl.consistency_weight": 0.0, "cavl.pivot_weight": 0.0},
    ),
)
"""The paper as written and its two ablations: breadth-first search for the tree, and no anchor term."""
DEFAULT_ABLATION = (
    *DEFAULT_VARIANTS,
    Variant(label="default without MCTS", config="default", changes={"topology.mode": "bfs"}),
    Variant(label="default with DW-CAVL", config="default", changes={"joints.method": "cavl"}),
)
"""The same questions asked of the default, which has no DW-CAVL: with it in place of all evidence on joints."""


@dataclass(frozen=True, kw_only=True)
class BenchmarkRequest:
    """What to run."""

    data: str | Path | None = None
    """As `find_objects` takes it."""
    variants: tuple[Variant, ...] = DEFAULT_VARIANTS
    conditions: tuple[str, ...] = tuple(condition.name for condition in CONDITIONS)
    """Names of conditions."""
    inputs: tuple[str, ...] = (CLEAN,)
    """What is done to the meshes: `CLEAN` and some of `kinematify.evaluation.perturb.DEGRADED`."""
    only: tuple[str, ...] = ()
    """Names of objects or categories or kinds; empty for all."""
    work_folder: Path = Path(".kinematify-bench")
    """Where finished jobs are kept between runs."""
    fresh: bool = False
    """Forget what the work folder holds; otherwise finished jobs are not run again."""
    workers: int = field(default_factory=lambda: os.cpu_count() or 1)
    timeout: float = DEFAULT_TIMEOUT
    """Wall time for one object under one condition [s]."""
    infer: str = INFER
    """Function under test, as ``module:name``; tests give a quick one."""


@dataclass(frozen=True, kw_only=True)
class BenchmarkReport:
    """What came of a run, in the order of the request."""

    header: dict[str, Any]
    """Command, date, versions, machine, seeds, number of objects."""
    results: tuple[JobResult, ...]


def run_benchmark(request: BenchmarkRequest, progress: Progress | None = None) -> BenchmarkReport:
    """Run the benchmark, taking up what an earlier run with the same code and configuration has finished.

    Args:
        request: Objects, conditions, configurations and where to work.
        progress: Told what has just finished and the fraction done in [0, 1].

    Raises:
        InputError: There is no such data, object, condition or configuration.
        OutputError: The work folder cannot be written.
        KeyboardInterrupt: Ctrl-C; workers are stopped, finished jobs are kept.
    """
    jobs = jobs_of(request)
    version_hash = code_version()
    keyed = [(job.key(version_hash), job) for job in jobs]
    total = len({key for key, _ in keyed})
    with Ledger(request.work_folder / "jobs.jsonl", RESULT) as ledger:
        if request.fresh:
            ledger.clear()
        results = ledger.read()
        missing = {key: job for key, job in keyed if key not in results}
        finished = total - len(missing)
        if progress is not None and finished:
            progress("taken up from an earlier run", finished / total)
        for result in run_jobs(_longest_first(missing), workers=request.workers, timeout=request.timeout):
            ledger.append(result)
            results[result.key] = result
            finished += 1
            if progress is not None:
                progress(_line(result), finished / total)
    # Two labels can name the same configuration, which is run once.
    ordered = tuple(replace(results[key], variant=job.variant) for key, job in keyed)
    return BenchmarkReport(header=header_of(request, ordered), results=ordered)


def changed(config: Config, changes: Mapping[str, Any]) -> Config:
    """Return a configuration with some fields replaced.

    Args:
        config: The configuration to start from.
        changes: Dotted name of a field -> its value.

    Raises:
        ConfigError: There is no such field, or the value does not fit.
    """
    values = config.model_dump()
    for dotted, value in changes.items():
        *stages, name = dotted.split(".")
        place = values
        for stage in stages:
            place = place.get(stage, {})
        if name not in place:
            raise ConfigError(f"The configuration {config.name} has no field {dotted}. Compare it with default.yaml.")
        place[name] = value
    try:
        return Config.model_validate(values)
    except ValueError as error:
        raise ConfigError(f"The changes {dict(changes)} do not fit configuration {config.name}: {error}.") from error


def selected_objects(request: BenchmarkRequest) -> list[BenchObject]:
    """Objects that a request asks for.

    Raises:
        InputError: There is no such data or object.
    """
    return _selected(find_objects(request.data), request.only)


def selected_conditions(request: BenchmarkRequest) -> list[Condition]:
    """Conditions that a request asks for.

    Raises:
        InputError: There is no such condition.
    """
    return [_condition(name) for name in request.conditions]


def jobs_of(request: BenchmarkRequest) -> list[Job]:
    """One job per configuration, input, object and condition of a request.

    Raises:
        InputError: There is no such data, object or condition.
    """
    objects = selected_objects(request)
    conditions = selected_conditions(request)
    return [
        Job(item=item, condition=condition, variant=variant.label, config=config, infer=request.infer, input=given)
        for variant, config in [(variant, variant.load()) for variant in request.variants]
        for given in request.inputs
        for item in objects
        for condition in conditions
    ]


def _selected(objects: Sequence[BenchObject], only: Sequence[str]) -> list[BenchObject]:
    if not only:
        return list(objects)
    chosen = [item for item in objects if {item.name, item.category, item.kind} & set(only)]
    known = {word for item in objects for word in (item.name, item.category, item.kind)}
    unknown = sorted(set(only) - known)
    if unknown:
        raise InputError(
            f"The benchmark data has no object, category or kind called {', '.join(unknown)}. It has "
            f"{', '.join(sorted(known))}."
        )
    return chosen


def _condition(name: str) -> Condition:
    for condition in CONDITIONS:
        if condition.name == name:
            return condition
    known = ", ".join(condition.name for condition in CONDITIONS)
    raise InputError(f"There is no condition {name}. Give some of {known}.")


def _longest_first(jobs: Mapping[str, Job]) -> list[tuple[str, Job]]:
    """Start the largest objects first, so that no worker is left alone with one at the end."""
    return sorted(jobs.items(), key=lambda entry: entry[1].item.mesh_bytes, reverse=True)


def _line(result: JobResult) -> str:
    given = "" if result.input == CLEAN else f", {result.input}"
    place = f"{result.object}, {result.condition}{given}, {result.variant}"
    if result.status == "ok":
        return f"{place}: {result.seconds:.1f} s"
    return f"{place}: {result.status}, {result.message}"


def header_of(request: BenchmarkRequest, results: Sequence[_OfObject]) -> dict[str, Any]:
    """Command, date, versions, machine, seeds, number of objects."""
    seeds = {condition.seed for condition in CONDITIONS if condition.name in request.conditions}
    return {
        "command": _command(),
        "date": datetime.datetime.now(tz=datetime.UTC).date().isoformat(),
        "code": code_version()[:12],
        "objects": len({result.object for result in results}),
        "conditions": list(request.conditions),
        "seeds": sorted(seeds),
        "inputs": list(request.inputs),
        "variants": [variant.label for variant in request.variants],
        "workers": request.workers,
        "processor": _processor(),
        "python": platform.python_version(),
        "packages": package_versions(("kinematify", "numpy", "scipy", "torch", "trimesh", "libigl")),
    }


def _command() -> str:
    """The command that is running, as a user types it, also where it was started as `python -m kinematify`."""
    program = Path(sys.argv[0]).name
    return shlex.join(["kinematify" if program == "__main__.py" else program, *sys.argv[1:]])


def _processor() -> str:
    """Model and count of the processors."""
    model = platform.processor() or platform.machine()
    facts = Path("/proc/cpuinfo")
    if facts.is_file():
        lines = facts.read_text(encoding="utf-8").splitlines()
        model = next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), model)
    return f"{os.cpu_count()} x {model}"
