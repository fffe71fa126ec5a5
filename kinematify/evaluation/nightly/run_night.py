"""A night: benchmark and validation of all objects, compared with earlier nights; resumable, and locked."""

from __future__ import annotations

import json
import os
import shutil
import time
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.batch.task_pool import Pool
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.evaluation.benchmark_job import INFER
from kinematify.evaluation.datasets import CONDITIONS, find_objects, matching
from kinematify.evaluation.nightly.comparison import SHOWN, compare, counts
from kinematify.evaluation.nightly.night_junit import as_junit
from kinematify.evaluation.nightly.night_page import night_page, nights_page
from kinematify.evaluation.nightly.runs import (
    PULLED,
    RUN,
    SCHEMA,
    accuracy_run,
    accuracy_scenario,
    digest,
    validation_scenario,
)
from kinematify.evaluation.nightly.store import (
    BADGE_FILE,
    JUNIT_FILE,
    MODELS,
    PAGE_FILE,
    UNFINISHED,
    Night,
    State,
    baseline_of,
    earlier_runs,
    find_night,
    load_nights,
    open_state,
    write_night,
)
from kinematify.evaluation.nightly.validity import NightValidation, run_validation
from kinematify.evaluation.result_record import code_version, replace_text
from kinematify.evaluation.run_benchmark import BenchmarkRequest, Variant, run_benchmark
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.reader import read_sentence
from kinematify.processes.lock import locked
from kinematify.processes.pool import TaskFailure
from kinematify.validation.formats.report_picture import drawing_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.batch.task_pool import Progress
    from kinematify.config.nightly_settings import NightlySettings
    from kinematify.evaluation.benchmark_job import JobResult
    from kinematify.evaluation.datasets import BenchObject
    from kinematify.evaluation.nightly.comparison import Change
    from kinematify.evaluation.nightly.runs import Run
    from kinematify.evaluation.result_record import Report

_PICTURES, _SECONDS = 12, 15.0
"""Objects that changed and are drawn, and the time for each [s]."""
_ACCURACY, _VALIDATION = 0.45, 0.97  # shares of the time at which these are done, on the benchmark


@dataclass(frozen=True, kw_only=True)
class NightRequest:
    """Request of a night."""

    settings: NightlySettings
    out: Path
    """Folder of all nights."""
    only: tuple[str, ...] = ()
    """Patterns for names of objects, categories or kinds; empty for all."""
    baseline: str | None = None
    """Name of a night to compare with instead of the accepted one."""
    smoke: bool = False
    """Run the objects of the built-in generator instead of the data."""
    pages: bool = False
    """Write a page for each validated model too, 0.4 MB each."""
    workers: int = field(default_factory=lambda: os.cpu_count() or 1)
    infer: str = INFER
    """Function under test, as ``module:name``; tests plant faults with it."""


@dataclass(frozen=True, kw_only=True)
class NightResult:
    """Result of a night."""

    night: Night
    place: Path
    notices: tuple[str, ...]
    """Sentences about what the user should know: broken folders, no baseline."""


def run_night(request: NightRequest, progress: Progress) -> NightResult:
    """Run a night, taking up one of the same code and settings that was interrupted.

    Args:
        request: What to run.
        progress: Called with what has just ended and the fraction done in [0, 1].

    Raises:
        InputError: Another night is running; a night of a newer version is there; there is no such baseline, data or
            object.
        ConfigError: A configuration is unknown or malformed.
        OutputError: The folder cannot be written.
    """
    with locked(request.out / ".lock", f"The folder of nights {request.out}"):
        nights, warnings = load_nights(request.out)
        name = request.baseline or baseline_of(request.out)
        baseline = None if name is None else find_night(nights, name, request.out)
        objects = _objects(request)
        work = _Work(request, objects)
        state = open_state(request.out, work.plan, {path.name for path in request.out.iterdir()})
        night = next((night for night in nights if night.name == state.name), None)
        if night is None:
            night = _new_night(work, state, nights, baseline, progress)
            nights = (*nights, night)
        # The list of nights, then nothing of what was only needed to resume; all of it can be repeated after a kill.
        replace_text(request.out / PAGE_FILE, nights_page(nights[-request.settings.shown_nights :]))
        replace_text(request.out / BADGE_FILE, json.dumps(nights[-1].badge) + "\n")
        shutil.rmtree(request.out / UNFINISHED, ignore_errors=True)
        none = () if baseline is not None else (_NO_BASELINE,)
        return NightResult(night=night, place=request.out / night.name, notices=(*warnings, *none))


_NO_BASELINE = (
    "No night is accepted as the baseline, so only the night before was compared with. When one is good, accept it: "
    "kinematify nightly --accept NIGHT"
)


def _objects(request: NightRequest) -> list[BenchObject]:
    data: str | Path | None = request.settings.data
    if request.smoke:
        data = request.out / UNFINISHED / "objects"
        write_smoke_objects(data, request.settings.smoke.sentences)
    return list(matching(find_objects(data), request.only))


class _Work:
    """The runs of a night."""

    def __init__(self, request: NightRequest, objects: Sequence[BenchObject]) -> None:
        self.request, self.objects, self.settings = request, objects, request.settings
        self.folder = request.out / UNFINISHED
        self.pages = self.folder / MODELS if request.pages else None
        self.thresholds = load_settings(self.settings.validation_config)
        self.code = code_version(without=("cli", "evaluation/nightly"))
        self.method = digest(load_config(self.settings.infer_config).model_dump(mode="json"))
        hashes = {item.name: item.content_hash for item in objects}
        self.plan = digest(
            [self.settings.model_dump(mode="json"), hashes, self.code, request.infer, self.thresholds.model_dump()]
        )

    def accuracy(self, progress: Progress) -> tuple[Report[JobResult], list[Run]]:
        """Infer every object in every condition."""
        report = run_benchmark(
            BenchmarkRequest(
                data=self._data(),
                variants=(Variant(label="nightly", config=self.settings.infer_config),),
                conditions=tuple(self.settings.conditions),
                only=tuple(item.name for item in self.objects),
                work_folder=self.folder,
                workers=self.request.workers,
                timeout=self.settings.timeout,
                infer=self.request.infer,
            ),
            lambda what, share: progress(what.replace(", nightly", ""), _ACCURACY * share),
        )
        return report, [self._accuracy_run(result) for result in report.records]

    def _data(self) -> str | Path | None:
        return self.folder / "objects" if self.request.smoke else self.settings.data

    def _accuracy_run(self, result: JobResult) -> Run:
        item = next(item for item in self.objects if item.name == result.object)
        condition = next(condition for condition in CONDITIONS if condition.name == result.condition)
        return accuracy_run(result, accuracy_scenario(item, condition, self.settings), self.settings)

    def validations(self, progress: Progress) -> list[Run]:
        """Validate the models of every object."""
        # The largest objects first, so that nobody waits for one at the end.
        by_size = sorted(self._validations(), key=lambda task: task.item.mesh_bytes, reverse=True)
        tasks = {self._key(task): task for task in by_size}
        share = _VALIDATION - _ACCURACY
        pool = Pool(
            folder=self.folder,
            workers=self.request.workers,
            progress=lambda what, done: progress(what, _ACCURACY + share * done),
        )
        answers = pool.run(
            {key: partial(run_validation, task) for key, task in tasks.items()},
            RUN,
            ledger="validations",
            timeout=self.settings.validation_timeout,
            said=lambda key, run: (
                f"{tasks[key].item.name}, {tasks[key].source} model: {run.status}, {run.seconds:.1f} s"
            ),
            preload=("kinematify.evaluation.nightly.validity", "kinematify.pipeline.infer_assembly"),
        )
        return [
            tasks[key].run(answer.status, answer.seconds, answer.message) if isinstance(answer, TaskFailure) else answer
            for key, answer in answers.items()
        ]

    def _validations(self) -> Iterator[NightValidation]:
        for item in self.objects:
            pulled = any(fnmatchcase(item.name, pattern) for pattern in self.settings.pulled)
            for source in (*self.settings.sources, *([PULLED] if pulled else [])):
                yield NightValidation(
                    item=item,
                    scenario=validation_scenario(item, source, self.settings, self.thresholds),
                    source=source,
                    infer=self.request.infer,
                    infer_config=self.settings.infer_config,
                    validation_config=self.settings.validation_config,
                    engines=tuple(self.settings.engines),
                    checks=("KV7*",) if source == PULLED else tuple(self.settings.checks),
                    budget=self.settings.pull_budget if source == PULLED else self.settings.budget,
                    pages=self.pages,
                )

    def _key(self, task: NightValidation) -> str:
        return digest([task.item.name, task.source, task.scenario, self.code, task.infer, task.budget])


def _new_night(work: _Work, state: State, nights: Sequence[Night], baseline: Night | None, progress: Progress) -> Night:
    """Run what is missing, compare and write."""
    start = time.perf_counter()
    report, accuracy = work.accuracy(progress)
    runs = sorted([*accuracy, *work.validations(progress)], key=lambda run: run.place)
    last = nights[-1] if nights else None
    processor = str(report.header.machine["processor"])
    changes = _changes(work, runs, nights, processor)
    drift = _changes(work, runs, [baseline], processor) if baseline is not None and baseline is not last else ()
    header = {
        **_facts(work, state, report),
        "seconds": round(time.perf_counter() - start, 1),
        "runs": len(runs),
        "last": last.name if last else None,
        "baseline": baseline.name if baseline else None,
        "counts": counts(changes),
        "baseline_counts": counts(drift),
        "gate": "fail" if any(change.gate for change in (*changes, *drift)) else "pass",
    }
    night = Night(name=state.name, header=header, runs=tuple(runs), changes=changes, baseline_changes=drift)
    pages = {path.name for path in (work.folder / MODELS).glob("*.html")}
    changed = dict.fromkeys(change.object for change in (*changes, *drift) if change.kind in SHOWN)
    shown = [item for item in work.objects if item.name in changed][:_PICTURES]
    pictures = {
        item.name: drawing_of(item.urdf, item.package_dirs, work.thresholds, seconds=_SECONDS) for item in shown
    }
    texts = {
        JUNIT_FILE: as_junit(night),
        PAGE_FILE: night_page(night, pages, {name: drawn.picture for name, drawn in pictures.items()}),
    }
    write_night(work.request.out, night, texts, models=work.folder / MODELS if pages else None)
    return night


def _changes(work: _Work, runs: Sequence[Run], nights: Sequence[Night], processor: str) -> tuple[Change, ...]:
    """Compare with earlier nights, the oldest first; times only if the latest of them ran on the same machine."""
    return compare(
        runs,
        earlier_runs(nights),
        work.settings,
        same_machine=bool(nights) and nights[-1].header.get("processor") == processor,
        complete=not work.request.only,
    )


def _facts(work: _Work, state: State, report: Report[JobResult]) -> dict[str, Any]:
    header = report.header
    return {
        "schema": SCHEMA,
        "night": state.name,
        "started": state.started,
        "commit": state.commit,
        "dirty": state.dirty,
        "sessions": state.sessions,
        "code": work.code[:12],
        "method": work.method,
        "command": header.command,
        "processor": header.machine["processor"],
        "workers": header.machine["workers"],
        "python": header.versions["python"],
        "packages": {name: version for name, version in header.versions.items() if name != "python"},
        "objects": len(work.objects),
        "settings": work.settings.model_dump(mode="json"),
    }


def write_smoke_objects(folder: Path, sentences: Sequence[str]) -> None:
    """Write an object with known joints for each sentence, if it is not there yet.

    Args:
        folder: Gets a folder per object.
        sentences: As `kinematify generate` takes them.

    Raises:
        InputError: A sentence is not understood.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for number, sentence in enumerate(sentences, start=1):
        blueprint = read_sentence(sentence).made(seed=0).blueprint
        place = folder / f"{blueprint.name}_{number}"
        if place.is_dir():
            continue
        aside = folder / f".{place.name}.{os.getpid()}"
        shutil.rmtree(aside, ignore_errors=True)
        write_blueprint(blueprint, aside, load_config())
        aside.rename(place)
