"""The benchmark: every object under every condition and configuration, in worker processes, resumable."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter

from kinematify.batch.task_pool import WORK_FOLDER, Pool
from kinematify.config import Config, load_config
from kinematify.errors import ConfigError, InputError
from kinematify.evaluation.benchmark_job import CLEAN, INFER, Job, JobResult, run_job, unscored
from kinematify.evaluation.benchmark_summary import summaries
from kinematify.evaluation.datasets import CONDITIONS, Condition, find_objects, matching
from kinematify.evaluation.result_record import NOT_INFERRING, Report, code_version, new_header
from kinematify.processes.pool import TaskFailure

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.batch.task_pool import Progress

RESULT = TypeAdapter(JobResult)
RESULTS = TypeAdapter(tuple[JobResult, ...])


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


ALL_CONDITIONS = tuple(condition.name for condition in CONDITIONS)
DEFAULT_VARIANTS = (Variant(label="default", config="default"),)


def run_benchmark(
    data: str | Path | None = None,
    *,
    variants: Sequence[Variant] = DEFAULT_VARIANTS,
    conditions: Sequence[str] = ALL_CONDITIONS,
    inputs: Sequence[str] = (CLEAN,),
    degrade: str = "",
    objects: Sequence[str] = (),
    work: Path = WORK_FOLDER,
    fresh: bool = False,
    jobs: int | None = None,
    timeout: float = 900.0,
    infer: str = INFER,
    progress: Progress | None = None,
) -> Report[JobResult]:
    """Measure the accuracy on objects with known joints.

    What an earlier run with the same code and configuration has finished is taken up.

    Args:
        data: As `find_objects` takes it.
        variants: Configurations under test.
        conditions: Names of conditions.
        inputs: What is done to the parts: `CLEAN`, and names that `degrade` knows.
        degrade: Function that degrades parts, as ``module:name``; `Job.degrade` says how it is called.
        objects: Patterns for names of objects, categories or kinds; empty for all.
        work: Folder in which finished jobs are kept between runs.
        fresh: Forget what that folder holds; otherwise finished jobs are not run again.
        jobs: Processes at a time; as many as there are cores if absent.
        timeout: Wall time for one object under one condition [s]; H1 is allowed 40 s.
        infer: Function under test, as ``module:name``; tests give a quick one.
        progress: Called with what has just finished and the fraction done in [0, 1].

    Returns:
        The results in the order of the request.

    Raises:
        InputError: There is no such data, object, condition or configuration.
        OutputError: The work folder cannot be written.
        KeyboardInterrupt: Ctrl-C; workers are stopped, finished jobs are kept.
    """
    items, posed = matching(find_objects(data), objects), [_condition(name) for name in conditions]
    asked = [
        Job(
            item=item, condition=condition, variant=variant.label, config=config, infer=infer, input=given,
            degrade=degrade,
        )
        for variant, config in [(variant, variant.load()) for variant in variants]
        for given in inputs
        for item in items
        for condition in posed
    ]  # fmt: skip
    code, workers = code_version(without=NOT_INFERRING, module=degrade.partition(":")[0]), jobs or os.cpu_count() or 1
    keyed = [(job.key(code), job) for job in asked]
    # The largest objects first, so that no worker is left alone with one at the end.
    by_key = dict(sorted(keyed, key=lambda entry: entry[1].item.mesh_bytes, reverse=True))
    pool = Pool(folder=work, workers=workers, fresh=fresh)
    pool = pool if progress is None else replace(pool, progress=progress)
    torch_too = ["kinematify.paper.joints"] if any(job.config.joints.method == "cavl" for job in asked) else []

    def answered(pool: Pool, tasks: Mapping[str, Callable[[], JobResult]]) -> dict[str, JobResult | TaskFailure]:
        return pool.run(
            tasks,
            RESULT,
            ledger="jobs",
            timeout=timeout,
            said=lambda key, result: _line(by_key[key.removesuffix(_SCORED)], result),
            preload=("kinematify.pipeline.infer_assembly", "kinematify.evaluation.benchmark_job", *torch_too),
        )

    answers = answered(pool, {key: partial(run_job, job) for key, job in by_key.items()})
    # A job that crashed or ran out of time gets a second process, which only scores the missing answer.
    failed = {key: answer for key, answer in answers.items() if isinstance(answer, TaskFailure)}
    again = {key + _SCORED: partial(run_job, by_key[key], failure) for key, failure in failed.items()}
    scored = answered(replace(pool, fresh=False), again) if again else {}
    results: dict[str, JobResult] = {}
    for key, job in by_key.items():
        answer = scored.get(key + _SCORED, answers[key])
        results[key] = unscored(job, failed[key]) if isinstance(answer, TaskFailure) else answer
    # Two labels can name the same configuration, which is run once.
    ordered = tuple(replace(results[key], variant=job.variant) for key, job in keyed)
    header = new_header(
        "bench",
        workers=workers,
        seeds=[condition.seed for condition in posed],
        configuration={
            "objects": len({result.object for result in ordered}),
            "conditions": list(conditions),
            "inputs": list(inputs),
            "variants": [variant.label for variant in variants],
        },
        code=code,
    )
    return Report(header=header, records=ordered, summary={"groups": summaries(ordered)})


_SCORED = " scored"


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
            raise ConfigError(
                f"The configuration {config.name} has no field {dotted}. Compare it with kinematify.config.Config."
            )
        place[name] = value
    try:
        return Config.model_validate(values)
    except ValueError as error:
        raise ConfigError(f"The changes {dict(changes)} do not fit configuration {config.name}: {error}.") from error


def _condition(name: str) -> Condition:
    for condition in CONDITIONS:
        if condition.name == name:
            return condition
    known = ", ".join(condition.name for condition in CONDITIONS)
    raise InputError(f"There is no condition {name}. Give some of {known}.")


def _line(job: Job, result: JobResult | TaskFailure) -> str:
    given = "" if job.input == CLEAN else f", {job.input}"
    place = f"{job.item.name}, {job.condition.name}{given}, {job.variant}"
    if isinstance(result, JobResult) and result.status == "ok":
        return f"{place}: {result.seconds:.1f} s"
    return f"{place}: {result.status}, {result.message}"
