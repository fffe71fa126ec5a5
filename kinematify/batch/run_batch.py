"""A batch: every object converted by a worker, its record kept in the manifest, and a page at the end."""

from __future__ import annotations

import hashlib
import json
import os
import posixpath
import shutil
import tempfile
import time
import zlib
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from kinematify import __version__
from kinematify.batch.batch_inputs import absolute, content_hash, filesystem, find_sources, is_local
from kinematify.batch.convert import FORMATS, STEPS, Conversion, convert
from kinematify.batch.ledger import Ledger
from kinematify.batch.manifest import RECORD, ObjectRecord, manifest_file, record_of
from kinematify.batch.task_pool import Pool
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.errors import InputError, OutputError
from kinematify.processes.pool import Processes

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from kinematify.batch.batch_inputs import Source
    from kinematify.config import Config
    from kinematify.config.validation import ValidationSettings
    from kinematify.pipeline.infer_assembly import Progress
    from kinematify.processes.pool import Executor, TaskFailure

OBJECTS = "objects"
"""Folder of the output with a folder for each object."""
PRELOAD = ("kinematify.batch.convert", "kinematify.pipeline.infer_assembly")
"""What workers need, imported once for all of them."""
REUSE = 50
"""Objects that a worker takes before a new one is started: what leaks ends with it."""
LIVES = 3
"""Workers that an object may cost."""


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
    interrupted: bool


def batch(
    inputs: Sequence[str],
    out: str | Path,
    *,
    steps: Sequence[str] = ("infer", "validate"),
    to: Sequence[str] = ("mjcf",),
    engine: Literal["local", "ray"] | Executor = "local",
    address: str | None = None,
    workers: int | None = None,
    timeout: float = 900.0,
    memory: float = 8.0,
    resume: bool = False,
    retry: bool = False,
    shard: tuple[int, int] = (1, 1),
    up: str = "auto",
    scale: float | None = None,
    pieces: str = "auto",
    vlm: str = "off",
    config: str | Path | Config = "default",
    seed: int | None = None,
    settings: ValidationSettings | None = None,
    progress: Progress | None = None,
) -> BatchResult:
    """Convert all objects that have no record yet, as `kinematify batch` does; what has ended is kept whatever happens.

    Args:
        inputs: Paths or URLs; ``*`` is any name and ``**`` any folders.
        out: Path or URL of a folder.
        steps: Some of `STEPS`; without ``infer`` the inputs are URDFs.
        to: Some of `FORMATS`, for the step ``export``.
        engine: Processes of this machine, of a Ray cluster, or what else starts workers.
        address: Of the Ray cluster; None starts one here.
        workers: Objects at a time; as many as there are processors if absent.
        timeout: Wall time for an object [s].
        memory: Address space of a worker [GB].
        resume: Go on: objects with a record of the same content and configuration stay, but for errors of the machine.
        retry: With `resume`: convert again what is not ``ok``, whatever the reason.
        shard: Number of the share of the objects to convert, from 1, and how many shares there are.
        up: As `kinematify.load_assembly` takes it.
        scale: The same.
        pieces: The same.
        vlm: As `kinematify.infer` takes it.
        config: All stages: a shipped name, a file or the configuration.
        seed: Of everything random, instead of the configuration's.
        settings: Of the validation; the shipped ones if absent.
        progress: Called with the object that has ended and the share done.

    Returns:
        The records; after an interrupt those of the objects that have ended.

    Raises:
        InputError: The inputs match nothing, or the steps do not fit together.
        OutputError: The output cannot be written, holds a run that must not be touched, or is full.
        EnvironmentFault: A store or a cluster cannot be opened.
    """
    if retry and not resume:
        raise InputError("--retry belongs to --resume. Give both, or leave it out.")
    if address and engine != "ray":
        raise InputError("--address belongs to --engine ray. Leave it out.")
    reading = {"up": up, "scale": scale, "pieces": pieces}
    values = load_config(config, seed=seed), load_settings(settings or "validation", seed=seed)
    conversion = _conversion(steps, to, reading, vlm, values)
    start, place = time.perf_counter(), absolute(*filesystem(str(out)))
    sources = {
        source.place: source
        for source in find_sources(inputs, besides=place)
        if zlib.crc32(source.place.encode()) % shard[1] == shard[0] - 1
    }  # a share hangs on the places alone
    executor = _executor(engine, address, workers, int(memory * 2**30)) if isinstance(engine, str) else engine
    report = progress or (lambda what, share: None)
    with manifest_file(place, shard) as (file, copy), _staging(place, shard) as staging:
        kept = _kept(file, sources, conversion.hash, resume=resume, retry=retry)

        def said(key: str, answer: ObjectRecord | TaskFailure) -> str:
            copy()
            assert isinstance(answer, ObjectRecord)
            return f"{answer.object}: {answer.verdict or answer.status}, {answer.seconds:.1f} s"

        interrupted = False
        try:
            Pool(folder=file.parent, progress=report).run(
                {
                    name: partial(convert, source, conversion, posixpath.join(place, OBJECTS, source.name), staging)
                    for name, source in sources.items()
                },
                RECORD,
                ledger=file.stem,
                timeout=timeout,
                said=said,
                reuse=REUSE,
                lives=LIVES,
                executor=executor,
                failed=lambda key, failure: _failed(sources[key], failure, conversion),
            )
        except KeyboardInterrupt:
            interrupted = True
        with Ledger(file) as ledger:
            known = {record.source: record for line in ledger if (record := record_of(line)) is not None}
    records = tuple(known[name] for name in sources if name in known)
    return BatchResult(
        out=place,
        records=records,
        new=len(records) - kept,
        left=len(sources) - len(records),
        seconds=time.perf_counter() - start,
        workers=executor.capacity,
        interrupted=interrupted,
    )


def _conversion(
    steps: Sequence[str],
    to: Sequence[str],
    reading: dict[str, Any],
    vlm: str,
    values: tuple[Config, ValidationSettings],
) -> Conversion:
    """What is asked for of every object.

    Raises:
        InputError: There is no such step or format, or there is nothing to refine.
    """
    for word, words, option in [(step, STEPS, "--steps") for step in steps] + [
        (form, tuple(FORMATS), "--to") for form in to
    ]:
        if word not in words:
            raise InputError(f"{option} names {word!r}. Give some of {', '.join(words)}, separated by commas.")
    if not steps or ("refine" in steps and "infer" not in steps):
        raise InputError("--steps has nothing to work on. Give infer, or validate and export for URDFs.")
    config, settings = values
    facts = {
        "config": config.model_dump(mode="json"),
        "settings": settings.model_dump(mode="json"),
        "asked": [sorted(steps), sorted(to), reading, vlm],
        "kinematify": __version__,
    }
    return Conversion(
        steps=tuple(steps),
        formats=tuple(to),
        config=config,
        settings=settings,
        reading=reading,
        vlm=vlm,
        hash=hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest(),
    )


def _executor(engine: str, address: str | None, workers: int | None, memory: int) -> Executor:
    if engine == "ray":
        from kinematify.batch.ray_nodes import RayNodes  # noqa: PLC0415 - of an extra

        return RayNodes(address, workers=workers, preload=PRELOAD, memory=memory)
    return Processes(workers or os.cpu_count() or 1, preload=PRELOAD, memory=memory)


def _kept(file: Path, sources: Mapping[str, Source], configuration: str, *, resume: bool, retry: bool) -> int:
    """Drop the lines of objects that are to be converted again; return how many of these objects stay."""
    with Ledger(file) as ledger:
        lines = [(line, record) for line in ledger if (record := record_of(line)) is not None]
        if lines and not resume:
            raise OutputError(
                f"{file.parent} holds a run with {len(lines)} objects. Go on with --resume, or give another folder "
                "with -o."
            )
        asked = [record.source in sources for _, record in lines]
        stays = [
            not mine
            or (
                record.configuration == configuration
                and record.status != "error"
                and not (retry and record.status != "ok")
                and _content(sources[record.source]) == record.content
            )
            for mine, (_, record) in zip(asked, lines, strict=True)
        ]
        ledger.rewrite(line for (line, _), stay in zip(lines, stays, strict=True) if stay)
    return sum(mine and stay for mine, stay in zip(asked, stays, strict=True))


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
