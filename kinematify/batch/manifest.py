"""The manifest: one JSON line for every object that has ended, in a file that a killed run leaves whole.

It stands in the output, ``manifest.jsonl``, or ``manifest-2-of-8.jsonl`` for a share of the objects. In a store, where
nothing can be appended, the file is kept on the disk of the driver and put there every few seconds and at the end.
"""

from __future__ import annotations

import json
import posixpath
import shutil
import tempfile
import time
from contextlib import ExitStack, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pydantic import TypeAdapter, ValidationError

from kinematify.batch.batch_inputs import filesystem, is_local
from kinematify.batch.ledger import Ledger
from kinematify.processes.lock import locked

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from types import TracebackType
    from typing import Self

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


class Manifest:
    """The records of a run and of those before it, by the places of the objects."""

    def __init__(self, out: str, share: tuple[int, int] = (1, 1)) -> None:
        """Open nothing yet.

        Args:
            out: Path or URL of the output.
            share: Number of the share of the objects, from 1, and how many shares there are.
        """
        number, of = share
        self._fs, path = filesystem(out)
        self.name = "manifest.jsonl" if of == 1 else f"manifest-{number}-of-{of}.jsonl"
        self.place = posixpath.join(path, self.name)
        self.records: dict[str, ObjectRecord] = {}
        self.notice = ""
        """What a user must know of the lines that were there; empty if nothing."""
        self._exit = ExitStack()
        self._copied = 0.0

    def __enter__(self) -> Self:
        with ExitStack() as stack:
            if is_local(self._fs):
                file = Path(self.place)
                stack.enter_context(locked(file.with_name(f".{file.name}.lock"), str(file)))
            else:
                file = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="kinematify-"))) / self.name
                if self._fs.exists(self.place):
                    self._fs.get_file(self.place, str(file))
            self._ledger = stack.enter_context(Ledger(file))
            self._read()
            self._exit = stack.pop_all()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._exit:
            self._copy()

    def add(self, record: ObjectRecord) -> None:
        """Add the record of an object that has none; it is on disk when this returns.

        Raises:
            OutputError: The disk is full or gone.
        """
        self._ledger.append(RECORD.dump_python(record, mode="json"))
        self.records[record.source] = record
        if time.monotonic() > self._copied + _EVERY:
            self._copy()

    def forget(self, places: Iterable[str]) -> None:
        """Drop the records of objects that are going to be converted again."""
        gone = self.records.keys() & set(places)
        if gone:
            self.records = {place: record for place, record in self.records.items() if place not in gone}
            self._ledger.rewrite(RECORD.dump_python(record, mode="json") for record in self.records.values())

    def _read(self) -> None:
        """Take up what stands there; a manifest of another version is put aside, not lost."""
        lines = list(self._ledger)
        if any(facts.get("schema") != SCHEMA for facts in lines):
            aside = self._ledger.path.with_name(f"{self.name}.old")
            shutil.copyfile(self._ledger.path, aside)
            if not is_local(self._fs):
                self._fs.put_file(str(aside), f"{self.place}.old")
            self.notice = (
                f"{self.name} has lines of another version, which stay in {aside.name}; these objects are new."
            )
        self.records = {record.source: record for record in _records(lines)}
        if len(self.records) < len(lines):
            self._ledger.rewrite(RECORD.dump_python(record, mode="json") for record in self.records.values())

    def _copy(self) -> None:
        if not is_local(self._fs) and self._ledger.path.stat().st_size:
            self._fs.put_file(str(self._ledger.path), self.place)
            self._copied = time.monotonic()


def read_manifests(out: str) -> list[ObjectRecord]:
    """Return the records of all shares in an output, by name of the object."""
    fs, path = filesystem(out)
    lines: list[dict[str, Any]] = []
    for file in fs.glob(posixpath.join(path, "manifest*.jsonl")):
        for line in fs.cat_file(file).splitlines():
            with suppress(ValueError):  # the last line of a share that is being written
                lines.append(json.loads(line))
    return sorted(_records(lines), key=lambda record: record.object)


def _records(lines: Iterable[dict[str, Any]]) -> Iterator[ObjectRecord]:
    """The records among lines of this version."""
    for facts in lines:
        with suppress(ValidationError):
            if facts.get("schema") == SCHEMA:
                yield RECORD.validate_python(facts)
