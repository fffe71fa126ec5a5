"""A batch: every object converted by a worker, its record kept in the manifest, and a page at the end."""

from __future__ import annotations

import hashlib
import json
import posixpath
import shutil
import tempfile
import time
import zlib
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify import __version__
from kinematify.batch.batch_inputs import absolute, content_hash, filesystem, find_sources, is_local
from kinematify.batch.convert import FORMATS, STEPS, Conversion, convert
from kinematify.batch.manifest import Manifest, ObjectRecord
from kinematify.errors import InputError, OutputError
from kinematify.processes.pool import TaskFailure, WorkItem, run_tasks
from kinematify.simulation.engines import DEFAULT_ENGINES

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.batch.batch_inputs import Source
    from kinematify.config import Config
    from kinematify.config.validation import ValidationSettings
    from kinematify.pipeline.infer_assembly import Progress
    from kinematify.processes.pool import Executor

OBJECTS = "objects"
"""Folder of the output with a folder for each object."""
PRELOAD = ("kinematify.batch.convert", "kinematify.pipeline.infer_assembly")
"""What workers need, imported once for all of them."""
REUSE = 50
"""Objects that a worker takes before a new one is started: what leaks ends with it."""
LIVES = 3
"""Workers that an object may cost."""


@dataclass(frozen=True, kw_only=True)
class BatchRequest:
    """Inputs and options of a batch."""

    patterns: tuple[str, ...]
    """As `find_sources` takes them."""
    out: str
    """Path or URL of a folder."""
    config: Config
    settings: ValidationSettings
    steps: tuple[str, ...] = ("infer", "validate")
    """Some of `STEPS`; without ``infer`` the inputs are URDFs."""
    formats: tuple[str, ...] = ("mjcf",)
    """Some of `FORMATS`, for the step ``export``."""
    engines: tuple[str, ...] = DEFAULT_ENGINES
    """Of the validation."""
    reading: dict[str, Any] = field(default_factory=dict)
    """Arguments of `load_assembly`: `up`, `scale`, `pieces`."""
    vlm: str = "off"
    """Model that is asked about the pieces of a mesh: ``off``, ``auto`` or its address."""
    share: tuple[int, int] = (1, 1)
    """Number of the share of the objects to convert, from 1, and how many shares there are."""
    timeout: float = 900.0
    """Wall time for an object [s]."""
    resume: bool = False
    """Go on: objects with a record of the same content and configuration stay, but for errors of the machine."""
    retry: bool = False
    """With `resume`: convert again what is not ``ok``, whatever the reason."""

    def conversion(self) -> Conversion:
        """Return what is asked for of every object.

        Raises:
            InputError: There is no such step or format, or there is nothing to refine.
        """
        for word, words, option in [(step, STEPS, "--steps") for step in self.steps] + [
            (form, tuple(FORMATS), "--to") for form in self.formats
        ]:
            if word not in words:
                raise InputError(f"{option} names {word!r}. Give some of {', '.join(words)}, separated by commas.")
        if not self.steps or ("refine" in self.steps and "infer" not in self.steps):
            raise InputError("--steps has nothing to work on. Give infer, or validate and export for URDFs.")
        facts = {
            "config": self.config.model_dump(mode="json"),
            "settings": self.settings.model_dump(mode="json"),
            "asked": [sorted(self.steps), sorted(self.formats), sorted(self.engines), self.reading, self.vlm],
            "kinematify": __version__,
        }
        return Conversion(
            steps=self.steps,
            formats=self.formats,
            config=self.config,
            settings=self.settings,
            engines=self.engines,
            reading=self.reading,
            vlm=self.vlm,
            hash=hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest(),
        )


@dataclass(frozen=True, kw_only=True)
class BatchResult:
    """Result of a batch."""

    out: str
    """Absolute path or URL of the output."""
    records: tuple[ObjectRecord, ...]
    """Of all objects that were asked for and have ended, those of earlier runs included."""
    new: int
    """Objects that ended in this run."""
    left: int
    """Objects that have not ended, after an interrupt."""
    seconds: float
    """Wall time of this run [s]."""
    workers: int
    notice: str
    """What a user must know of an earlier manifest; empty if nothing."""
    interrupted: bool


def run_batch(request: BatchRequest, engine: Executor, progress: Progress | None = None) -> BatchResult:
    """Convert all objects that have no record yet; what has ended is kept whatever happens.

    Args:
        request: What to convert, and how.
        engine: Starts the workers.
        progress: Called with the object that has ended and the share done.

    Returns:
        The records; after an interrupt those of the objects that have ended.

    Raises:
        InputError: The patterns match nothing, or the steps do not fit together.
        OutputError: The output cannot be written, holds a run that must not be touched, or is full.
        EnvironmentFault: A store cannot be opened.
    """
    conversion, start = request.conversion(), time.perf_counter()
    out = absolute(*filesystem(request.out))
    sources = _share(find_sources(request.patterns, besides=out), request.share)
    report = progress or (lambda what, share: None)
    with Manifest(out, request.share) as manifest, _staging(out, request.share) as staging:
        if manifest.records and not request.resume:
            raise OutputError(
                f"{request.out} holds a run with {len(manifest.records)} objects. Go on with --resume, or give another "
                "folder with -o."
            )
        missing = [source for source in sources if not _has_ended(source, manifest, conversion, request)]
        manifest.forget(source.place for source in missing)
        if len(missing) < len(sources):
            report("skipped: done earlier", 1.0 - len(missing) / len(sources))
        by_place = {source.place: source for source in missing}
        tasks = (
            WorkItem(
                key=place,
                call=partial(convert, source, conversion, posixpath.join(out, OBJECTS, source.name), staging),
                timeout=request.timeout,
            )
            for place, source in by_place.items()
        )
        new, interrupted = 0, False
        try:
            with closing(run_tasks(tasks, engine, reuse=REUSE, lives=LIVES)) as running:
                for place, answer in running:
                    record = _failed(by_place[place], answer, conversion) if isinstance(answer, TaskFailure) else answer
                    manifest.add(record)
                    new += 1
                    words = f"{record.object}: {record.verdict or record.status}, {record.seconds:.1f} s"
                    report(words, 1.0 - (len(missing) - new) / len(sources))
        except KeyboardInterrupt:
            interrupted = True
        return BatchResult(
            out=out,
            records=tuple(manifest.records[source.place] for source in sources if source.place in manifest.records),
            new=new,
            left=len(missing) - new,
            seconds=time.perf_counter() - start,
            workers=engine.capacity,
            notice=manifest.notice,
            interrupted=interrupted,
        )


def _share(sources: Sequence[Source], share: tuple[int, int]) -> list[Source]:
    """The objects of one share; which share an object is in hangs on its place alone."""
    number, of = share
    return [source for source in sources if zlib.crc32(source.place.encode()) % of == number - 1]


def _has_ended(source: Source, manifest: Manifest, conversion: Conversion, request: BatchRequest) -> bool:
    """True if an object has a record that stays."""
    record = manifest.records.get(source.place)
    if record is None or record.configuration != conversion.hash or record.status == "error":
        return False
    if request.retry and record.status != "ok":
        return False
    return _content(source) == record.content


def _failed(source: Source, failure: TaskFailure, conversion: Conversion) -> ObjectRecord:
    """The record of an object whose worker did not live to tell."""
    return ObjectRecord(
        object=source.name,
        source=source.place,
        status=failure.status,
        error=failure.message,
        seconds=failure.seconds,
        content=_content(source),
        configuration=conversion.hash,
    )


def _content(source: Source) -> str:
    """Hash of the files, empty where they cannot be read."""
    try:
        return content_hash(source.place)
    except OSError:
        return ""


@contextmanager
def _staging(out: str, share: tuple[int, int]) -> Iterator[str]:
    """A folder on the disk of the output for what is unfinished, without what a killed run has left in it."""
    fs, path = filesystem(out)
    if not is_local(fs):
        yield tempfile.gettempdir()
        return
    folder = Path(path, ".unfinished-{}-of-{}".format(*share))
    shutil.rmtree(folder, ignore_errors=True)
    try:
        folder.mkdir(parents=True)
        Path(path, OBJECTS).mkdir(exist_ok=True)
        yield str(folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
