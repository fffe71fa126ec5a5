"""The manifest: one JSON line for every object that has ended, in a file that a killed run leaves whole.

It stands in the output, ``manifest.jsonl``, or ``manifest-2-of-8.jsonl`` for a share of the objects. In a store, where
nothing can be appended, the file is kept on the disk of the driver and put there every few seconds and at the end.
"""

from __future__ import annotations

import json
import posixpath
import tempfile
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pydantic import TypeAdapter, ValidationError

from kinematify.batch.batch_inputs import filesystem, is_local
from kinematify.processes.lock import locked

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_EVERY = 10.0
"""Seconds between two copies to a store."""
SCHEMA = 1


@dataclass(frozen=True, kw_only=True)
class ObjectRecord:
    """Result of one object."""

    object: str
    """Its name: that of its folder in the output."""
    source: str
    """Path or URL."""
    status: Literal["ok", "unusable", "error", "timeout", "crash"]
    """``ok``: all steps were done; ``unusable``: the input cannot be read; ``error``: an engine, the machine or
    Kinematify failed; ``timeout``; ``crash``: set aside after it has cost several workers."""
    error: str = ""
    """Why it is not ok."""
    verdict: Literal["pass", "warn", "fail"] | None = None
    """Of its validation."""
    errors: tuple[str, ...] = ()
    """Of its validation, by title and place, the first three."""
    lengths: str = ""
    """In which unit it was read, and why; empty where nothing was inferred."""
    warnings: tuple[str, ...] = ()
    """Of its inference."""
    seconds: float
    """Wall time, of the last worker that had it [s]."""
    step_seconds: dict[str, float] = field(default_factory=dict)
    """Wall time by step [s]."""
    peak_mb: float | None = None
    """Most memory of the worker while it had the object [MB], without the stages of a validation, which have processes
    and limits of their own. None where the worker did not live to tell."""
    parts: int | None = None
    faces: int | None = None
    joints: int | None = None
    """Joints that move."""
    asked: str = ""
    """Who was asked about the pieces, what that cost, and the record of answers."""
    content: str = ""
    """Hash of the files; empty where they could not be read."""
    configuration: str
    """Hash of all that was asked for, and of the version of Kinematify."""
    schema: int = SCHEMA

    @property
    def failed(self) -> bool:
        """True if a user has to look at it: no model, or one with an error."""
        return self.status != "ok" or self.verdict == "fail"


RECORD = TypeAdapter(ObjectRecord)


@contextmanager
def manifest_file(out: str, share: tuple[int, int] = (1, 1)) -> Iterator[tuple[Path, Callable[[], None]]]:
    """The file of a run, which no other run writes; and what keeps its copy in a store, called now and then.

    Args:
        out: Path or URL of the output.
        share: Number of the share of the objects, from 1, and how many shares there are.
    """
    fs, path = filesystem(out)
    number, of = share
    place = posixpath.join(path, "manifest.jsonl" if of == 1 else f"manifest-{number}-of-{of}.jsonl")
    if is_local(fs):
        with locked(Path(path, f".{posixpath.basename(place)}.lock"), place):
            yield Path(place), lambda: None
        return
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        file, copied = Path(folder, posixpath.basename(place)), 0.0
        if fs.exists(place):
            fs.get_file(place, str(file))

        def copy() -> None:
            nonlocal copied
            if time.monotonic() > copied + _EVERY:
                fs.put_file(str(file), place)
                copied = time.monotonic()

        try:
            yield file, copy
        finally:
            if file.is_file() and file.stat().st_size:
                fs.put_file(str(file), place)


def read_manifests(out: str) -> list[ObjectRecord]:
    """Return the records of all shares in an output, by name of the object."""
    fs, path = filesystem(out)
    lines: list[dict[str, Any]] = []
    for file in fs.glob(posixpath.join(path, "manifest*.jsonl")):
        for line in fs.cat_file(file).splitlines():
            with suppress(ValueError):  # the last line of a share that is being written
                lines.append(json.loads(line))
    return sorted(filter(None, map(record_of, lines)), key=lambda record: record.object)


def record_of(line: dict[str, Any]) -> ObjectRecord | None:
    """The record of a line; None where another version wrote it."""
    with suppress(ValidationError):
        return RECORD.validate_python(line) if line.get("schema") == SCHEMA else None
    return None
