"""A night: benchmark and validation of all objects, compared with earlier nights; resumable, and locked."""

from __future__ import annotations

import os
import shutil
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.errors import InputError
from kinematify.evaluation.datasets import CONDITIONS, find_objects
from kinematify.evaluation.job import INFER
from kinematify.evaluation.ledger import Ledger
from kinematify.evaluation.nightly.accuracy import accuracy_run
from kinematify.evaluation.nightly.compare import compare, counts
from kinematify.evaluation.nightly.junit import as_junit
from kinematify.evaluation.nightly.pages.night import night_page
from kinematify.evaluation.nightly.pages.trends import trend_page
from kinematify.evaluation.nightly.record import RUN, SCHEMA
from kinematify.evaluation.nightly.scenario import accuracy_scenario, digest, validation_scenario, whole_code_version
from kinematify.evaluation.nightly.smoke import write_smoke_objects
from kinematify.evaluation.nightly.state import open_state
from kinematify.evaluation.nightly.store import (
    JUNIT_FILE,
    MODELS,
    PAGE_FILE,
    UNFINISHED,
    Night,
    accepted,
    chosen,
    earlier_runs,
    load_nights,
    locked,
    replace_text,
    write_night,
)
from kinematify.evaluation.nightly.validity import Unit, run_units, unit_request
from kinematify.evaluation.run import BenchmarkRequest, Variant, run_benchmark
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.evaluation.datasets import BenchObject
    from kinematify.evaluation.job import JobResult
    from kinematify.evaluation.nightly.compare import Change
    from kinematify.evaluation.nightly.record import Run
    from kinematify.evaluation.nightly.settings import NightlySettings
    from kinematify.evaluation.nightly.state import State
    from kinematify.evaluation.run import BenchmarkReport

    Progress = Callable[[str, float], None]

_ENGINES = ("mujoco", "pybullet", "pin", "python-fcl", "libigl", "trimesh")
_ACCURACY, _VALIDATION = 0.45, 0.97  # shares of the time at which these are done, on the benchmark


@dataclass(frozen=True, kw_only=True)
class NightRequest:
    """What to run."""

    settings: NightlySettings
    out: Path
    """Folder of all nights."""
    only: tuple[str, ...] = ()
    """Names of objects, categories or kinds; empty for all."""
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
    """What came of it."""

    night: Night
    place: Path
    notices: tuple[str, ...]
    """Sentences about what the user should know: broken folders, no baseline."""


def run_night(request: NightRequest, progress: Progress) -> NightResult:
    """Run a night, taking up one of the same code and settings that was interrupted.

    Args:
        request: What to run.
        progress: Told what has just ended and the fraction done in [0, 1].

    Raises:
        InputError: Another night is running; a night of a newer version is there; there is no such baseline, data or
            object.
        ConfigError: A configuration is unknown or malformed.
        OutputError: The folder cannot be written.
    """
    with locked(request.out):
        nights, warnings = load_nights(request.out)
        baseline = _baseline(request, nights)
        objects = _objects(request)
        work = _Work(request, objects)
        state = open_state(request.out, work.plan, {path.name for path in request.out.iterdir()})
        night = next((night for night in nights if night.name == state.name), None)
        if night is None:
            night = _new_night(work, state, nights, baseline, progress)
            nights = (*nights, night)
        _finish(request, nights)
        none = () if baseline is not None else (_NO_BASELINE,)
        return NightResult(night=night, place=request.out / night.name, notices=(*warnings, *none))


_NO_BASELINE = (
    "No night is accepted as the baseline, so only the night before was compared with. When one is good, accept it: "
    "kinematify nightly --accept NIGHT"
)


def _baseline(request: NightRequest, nights: Sequence[Night]) -> Night | None:
    name = request.baseline or accepted(request.out)
    return None if name is None else chosen(nights, name, request.out)


def _objects(request: NightRequest) -> list[BenchObject]:
    data: str | Path | None = request.settings.data
    if request.smoke:
        data = request.out / UNFINISHED / "objects"
        write_smoke_objects(data, request.settings.smoke.sentences)
    found = find_objects(data)
    chosen_objects = [o for o in found if not request.only or {o.name, o.category, o.kind} & set(request.only)]
    if not chosen_objects:
        raise InputError(
            f"No object is called, or is of the kind or category, {', '.join(request.only)}. There are "
            f"{', '.join(item.name for item in found)}."
        )
    return chosen_objects


class _Work:
    """The runs of a night."""

    def __init__(self, request: NightRequest, objects: Sequence[BenchObject]) -> None:
        self.request, self.objects, self.settings = request, objects, request.settings
        self.folder = request.out / UNFINISHED
        self.pages = self.folder / MODELS if request.pages else None
        self.thresholds = load_settings(self.settings.validation_config)
        self.code = whole_code_version()
        self.method = digest(load_config(self.settings.infer_config).model_dump(mode="json"))
        hashes = {item.name: item.content_hash for item in objects}
        self.plan = digest(
            [self.settings.model_dump(mode="json"), hashes, self.code, request.infer, self.thresholds.model_dump()]
        )

    def accuracy(self, progress: Progress) -> tuple[BenchmarkReport, list[Run]]:
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
        return report, [self._accuracy_run(result) for result in report.results]

    def _data(self) -> str | Path | None:
        return self.folder / "objects" if self.request.smoke else self.settings.data

    def _accuracy_run(self, result: JobResult) -> Run:
        item = next(item for item in self.objects if item.name == result.object)
        condition = next(condition for condition in CONDITIONS if condition.name == result.condition)
        return accuracy_run(result, accuracy_scenario(item, condition, self.settings), self.settings)

    def validations(self, progress: Progress) -> list[Run]:
        """Validate the models of every object."""
        units = {unit.key: unit for unit in self._units()}
        with Ledger(self.folder / "validations.jsonl", RUN) as ledger:
            known = {key: run for key, run in ledger.read().items() if key in units}
            missing = [unit for key, unit in units.items() if key not in known]
            missing.sort(key=lambda unit: unit.item.mesh_bytes, reverse=True)  # so that nobody waits for one at the end
            for run in run_units(missing, workers=self.request.workers, timeout=self.settings.validation_timeout):
                ledger.append(run)
                known[run.key] = run
                share = _ACCURACY + (_VALIDATION - _ACCURACY) * len(known) / len(units)
                progress(f"{run.object}, {run.case} model: {run.status}, {run.seconds:.1f} s", share)
        return [known[key] for key in units]

    def _units(self) -> list[Unit]:
        return [self._unit(item, source) for item in self.objects for source in self.settings.sources]

    def _unit(self, item: BenchObject, source: str) -> Unit:
        scenario = validation_scenario(item, source, self.settings, self.thresholds)
        facts = [item.name, source, scenario, self.code, self.request.infer, self.settings.budget]
        return Unit(
            key=digest(facts),
            scenario=scenario,
            item=item,
            source=source,
            request=unit_request(item, source, self.settings, infer=self.request.infer, pages=self.pages),
        )


def _new_night(work: _Work, state: State, nights: Sequence[Night], baseline: Night | None, progress: Progress) -> Night:
    """Run what is missing, compare and write."""
    start = time.perf_counter()
    report, accuracy = work.accuracy(progress)
    runs = sorted([*accuracy, *work.validations(progress)], key=lambda run: run.place)
    last = nights[-1] if nights else None
    processor = str(report.header["processor"])
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
    texts = {JUNIT_FILE: as_junit(night), PAGE_FILE: night_page(night, pages)}
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


def _facts(work: _Work, state: State, report: BenchmarkReport) -> dict[str, Any]:
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
        "command": header["command"],
        "processor": header["processor"],
        "workers": header["workers"],
        "python": header["python"],
        "packages": {**header["packages"], **package_versions(_ENGINES)},
        "objects": len(work.objects),
        "settings": work.settings.model_dump(mode="json"),
    }


def _finish(request: NightRequest, nights: Sequence[Night]) -> None:
    """Draw the trends, then forget what was only needed to resume; all of it can be repeated after a kill."""
    replace_text(request.out / PAGE_FILE, trend_page(nights[-request.settings.shown_nights :]))
    shutil.rmtree(request.out / UNFINISHED, ignore_errors=True)
