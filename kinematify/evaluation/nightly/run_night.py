"""A night: benchmark and validation of all objects, compared with an earlier night; resumable, and locked.

```text
results/nightly/
  index.html                 all nights, a line each
  baseline.json              name of the accepted night, which later ones are compared with
  2026-01-31-0a1b2c3/        night.json  runs.jsonl  index.html
  .unfinished/  .lock        of the night that is running, not for the history
```

A folder of a night appears whole or not at all, and none is ever replaced.
"""

from __future__ import annotations

import datetime
import json
import os
import shutil
import time
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from kinematify.batch.task_pool import Pool
from kinematify.config import load_config
from kinematify.config.nightly_settings import NightlySettings, load_nightly
from kinematify.errors import InputError, OutputError
from kinematify.evaluation.benchmark_job import INFER
from kinematify.evaluation.datasets import find_objects, matching
from kinematify.evaluation.nightly.comparison import CHANGES, Night, compare, counts
from kinematify.evaluation.nightly.night_pages import night_page, nights_page
from kinematify.evaluation.nightly.runs import PULLED, RUN, SCHEMA, ModelJob, Run, accuracy_run, digest, validation_run
from kinematify.evaluation.result_record import code_version, git_commit, replace_text
from kinematify.evaluation.run_benchmark import Variant, run_benchmark
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.reader import read_sentence
from kinematify.processes.lock import locked
from kinematify.processes.pool import TaskFailure

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.batch.task_pool import Progress
    from kinematify.evaluation.datasets import BenchObject

_ACCURACY = 0.45  # share of the time at which all is inferred, on the benchmark
_SHOWN = 60
"""Nights in the list of all, the latest: two months."""
_UNFINISHED = ".unfinished"
_SMOKE = ("a cabinet with one door", "a cabinet with one drawer")
"""Objects of a night that is small enough for a test suite."""


@dataclass(frozen=True, kw_only=True)
class NightResult:
    """Result of a night."""

    night: Night
    place: Path
    notices: tuple[str, ...]
    """Sentences about what the user should know: broken folders."""


def nightly(
    data: str | Path | None = None,
    out: str | Path | None = None,
    *,
    config: str | Path | NightlySettings = "nightly",
    objects: Sequence[str] = (),
    baseline: str | None = None,
    smoke: bool = False,
    jobs: int | None = None,
    infer: str = INFER,
    progress: Progress | None = None,
) -> NightResult:
    """Infer every object, validate its models, and compare with an earlier night, as `kinematify nightly` does.

    Args:
        data: As `kinematify bench` takes it; as the configuration says if absent.
        out: Folder of all nights; ``results/nightly`` if absent, ``out/nightly-smoke`` with `smoke`.
        config: The settings, or their name or path.
        objects: Patterns for names of objects, categories or kinds; empty for all.
        baseline: Night to compare with instead of the accepted one.
        smoke: Take two objects of the built-in generator, in one pose and in MuJoCo.
        jobs: Processes at a time; as many as there are cores if absent.
        infer: Function under test, as ``module:name``; tests plant faults with it.
        progress: Called with what has just ended and the fraction done in [0, 1].

    What a night of the same code and settings has finished before it was interrupted is taken up.

    Raises:
        InputError: A night of a newer version is there; there is no such baseline, data or object.
        ConfigError: A configuration is unknown or malformed.
        OutputError: Another night is running, or the folder cannot be written.
    """
    settings = load_nightly(config)
    changes: dict[str, Any] = {} if data is None else {"data": str(data)}
    if smoke:
        changes |= {"conditions": ["rest"], "engines": ["mujoco"]}
    settings, workers = settings.model_copy(update=changes), jobs or os.cpu_count() or 1
    folder = _nights(out, smoke=smoke)
    say = progress or (lambda what, share: None)
    with locked(folder / ".lock", f"The folder of nights {folder}"):
        start = time.perf_counter()
        nights, warnings = load_nights(folder)
        name = baseline or _accepted(folder)
        compared = [find_night(nights, name, folder)] if name else nights
        work, models = folder / _UNFINISHED, settings.data
        if smoke:
            models = str(work / "objects")
            write_smoke_objects(Path(models), _SMOKE)
        items = {item.name: item for item in matching(find_objects(models), objects)}
        report = run_benchmark(
            models,
            variants=(Variant(label="nightly", config=settings.infer_config),),
            conditions=settings.conditions,
            objects=objects,
            work=work,
            jobs=workers,
            timeout=settings.timeout,
            infer=infer,
            progress=lambda what, share: say(what.replace(", nightly", ""), _ACCURACY * share),
        )
        accuracy = [accuracy_run(result, items[result.object], settings) for result in report.records]
        pool = Pool(
            folder=work,
            workers=workers,
            progress=lambda what, done: say(what, _ACCURACY + (1.0 - _ACCURACY) * done),
        )
        runs = [*accuracy, *_validated(settings, infer, list(items.values()), pool)]
        header = report.header
        processor = header.machine["processor"]
        found = compare(
            runs,
            _earlier_runs(compared),
            same_machine=bool(compared) and compared[-1].header.get("processor") == processor,
            complete=not objects,
        )
        commit, dirty = git_commit()
        now = datetime.datetime.now(tz=datetime.UTC)
        base = f"{now.date().isoformat()}-{commit}"
        same_day = sum(path.name.startswith(base) for path in folder.iterdir())
        night = Night(
            name=f"{base}-{same_day + 1}" if same_day else base,
            header={
                "schema": SCHEMA,
                "started": now.isoformat(timespec="seconds"),
                "commit": commit,
                "dirty": dirty,
                "code": header.code,
                "method": digest(load_config(settings.infer_config).model_dump(mode="json")),
                "command": header.command,
                "processor": processor,
                "workers": workers,
                "versions": header.versions,
                "objects": len(items),
                "runs": len(runs),
                "seconds": round(time.perf_counter() - start, 1),
                "compared": compared[-1].name if compared else None,
                "counts": counts(found),
                "settings": settings.model_dump(mode="json"),
            },
            runs=tuple(sorted(runs, key=lambda run: run.place)),
            changes=found,
        )
        place = _write(folder, night, nights)
        return NightResult(night=night, place=place, notices=warnings)


def _validated(settings: NightlySettings, infer: str, objects: Sequence[BenchObject], pool: Pool) -> Iterator[Run]:
    """Validate the models of every object, the largest first, so that nobody waits for one at the end."""
    code = code_version(without=("cli", "evaluation/nightly"))
    asked = {
        digest([item.name, item.content_hash, source, settings.model_dump(mode="json"), infer, code]): ModelJob(
            item=item, source=source, settings=settings, infer=infer
        )
        for item in sorted(objects, key=lambda item: item.mesh_bytes, reverse=True)
        for source in (*settings.sources, PULLED)
        if source != PULLED or any(fnmatchcase(item.name, pattern) for pattern in settings.pulled)
    }
    answers = pool.run(
        {key: partial(validation_run, job) for key, job in asked.items()},
        RUN,
        ledger="validations",
        timeout=settings.timeout,
        said=lambda key, run: f"{asked[key].item.name}, {asked[key].source} model: {run.status}, {run.seconds:.1f} s",
        preload=("kinematify.evaluation.nightly.runs", "kinematify.pipeline.infer_assembly"),
    )
    for key, run in answers.items():
        yield asked[key].run(run.status, run.seconds, run.message) if isinstance(run, TaskFailure) else run


def load_nights(folder: Path) -> tuple[list[Night], tuple[str, ...]]:
    """Return all nights, the oldest first, and a sentence about every folder that is none.

    Raises:
        InputError: A night was written by a newer version; it must not be shown or compared in part.
    """
    nights, warnings = [], []
    for path in sorted(folder.iterdir()):
        if path.is_dir() and not path.name.startswith("."):
            try:
                nights.append(_load_night(path))
            except (ValueError, KeyError, OSError, ValidationError) as error:
                why = str(error).splitlines()[0]
                warnings.append(f"{path} is no whole night of this version ({why}) and was passed over, unchanged.")
    return sorted(nights, key=lambda night: (night.header["started"], night.name)), tuple(warnings)


def _load_night(path: Path) -> Night:
    header = json.loads((path / "night.json").read_text(encoding="utf-8"))
    if header["schema"] > SCHEMA:
        raise InputError(
            f"The night {path} has schema {header['schema']}, this version reads {SCHEMA}: a newer Kinematify wrote "
            "it. Use that version, or give another folder with -o. Nothing was changed."
        )
    if header["schema"] < SCHEMA:
        raise ValueError(f"it has schema {header['schema']}")
    runs = tuple(RUN.validate_json(line) for line in (path / "runs.jsonl").read_bytes().splitlines())
    if len(runs) != header["runs"]:
        raise ValueError(f"runs.jsonl has {len(runs)} of {header['runs']} runs")
    changes = CHANGES.validate_python(header.pop("changes"), strict=False)
    return Night(name=path.name, header=header, runs=runs, changes=changes)


def find_night(nights: Sequence[Night], name: str, folder: Path) -> Night:
    """Return a night by its name.

    Raises:
        InputError: There is none of that name.
    """
    for night in nights:
        if night.name == name:
            return night
    known = ", ".join(night.name for night in nights[-5:]) or "none yet"
    raise InputError(f"There is no night {name} in {folder}. The latest are: {known}. Give one of them.")


def _nights(out: str | Path | None, *, smoke: bool) -> Path:
    return Path(out or ("out/nightly-smoke" if smoke else "results/nightly"))


def accept(out: str | Path | None, name: str, *, smoke: bool = False) -> Path:
    """Make a night the one that later nights are compared with; return the folder of all, found as `nightly` does.

    Raises:
        InputError: There is none of that name.
        OutputError: The file cannot be written.
    """
    folder = _nights(out, smoke=smoke)
    with locked(folder / ".lock", f"The folder of nights {folder}"):
        night = find_night(load_nights(folder)[0], name, folder)
        replace_text(folder / "baseline.json", json.dumps({"schema": SCHEMA, "night": night.name}) + "\n")
    return folder


def _accepted(folder: Path) -> str | None:
    file = folder / "baseline.json"
    try:
        return str(json.loads(file.read_text(encoding="utf-8"))["night"]) if file.is_file() else None
    except (ValueError, KeyError, TypeError, OSError) as error:
        raise InputError(
            f"{file} does not name an accepted night ({error}). Delete it, or accept a night again with "
            "`kinematify nightly --accept NIGHT`."
        ) from error


def _earlier_runs(nights: Sequence[Night]) -> dict[tuple[str, str, str], list[Run]]:
    """Runs of each place, the latest first."""
    found: dict[tuple[str, str, str], list[Run]] = {}
    for night in reversed(nights):
        for run in night.runs:
            found.setdefault(run.place, []).append(run)
    return found


def _write(folder: Path, night: Night, earlier: Sequence[Night]) -> Path:
    """Write a night and the list of all, and drop what was only needed to resume."""
    place, aside = folder / night.name, folder / _UNFINISHED / night.name
    problems = sum(change.gate for change in night.changes)
    facts = {**night.header, "gate": night.gate, "changes": CHANGES.dump_python(night.changes, mode="json")}
    files = {
        "runs.jsonl": "".join(RUN.dump_json(run).decode() + "\n" for run in night.runs),
        "index.html": night_page(night),
        "night.json": json.dumps(facts, indent=1, allow_nan=False) + "\n",
    }
    badge = {
        "schemaVersion": 1,
        "label": "nightly",
        "message": f"{problems} worse" if problems else "passing",
        "color": "red" if problems else "brightgreen",
    }  # as an endpoint badge of shields.io reads it
    try:
        shutil.rmtree(aside, ignore_errors=True)
        aside.mkdir(parents=True)
        for name, text in files.items():
            (aside / name).write_text(text, encoding="utf-8")
        aside.rename(place)
        replace_text(folder / "index.html", nights_page([*earlier, night][-_SHOWN:]))
        replace_text(folder / "badge.json", json.dumps(badge) + "\n")
    except OSError as error:
        raise OutputError(
            f"The nights cannot be kept in {folder}: {error.strerror or error}. Give a writable folder on a disk with "
            "space with -o."
        ) from error
    shutil.rmtree(folder / _UNFINISHED, ignore_errors=True)
    return place


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
        if not place.is_dir():
            aside = folder / f".{place.name}.{os.getpid()}"
            write_blueprint(blueprint, aside, load_config())
            aside.rename(place)
