"""A file of JSON lines that stays whole whatever ends the run: a fact is on disk before the next is begun."""

from __future__ import annotations

import errno
import json
import os
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from kinematify.errors import OutputError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path
    from types import TracebackType
    from typing import Self


class Ledger:
    """The file, kept open for appending."""

    def __init__(self, path: Path) -> None:
        """Open nothing yet; the file is made with its folder."""
        self.path = path

    def __enter__(self) -> Self:
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = self.path.open("ab+", buffering=0)
        except OSError as error:
            raise self._unwritable(error) from error
        self._drop_unfinished_line()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Return what the lines hold; one that is no JSON object is passed over."""
        self._file.seek(0)
        for line in self._file.read().splitlines():
            with suppress(ValueError):
                facts = json.loads(line)
                if isinstance(facts, dict):
                    yield facts

    def append(self, facts: Mapping[str, Any]) -> None:
        """Add a line; it is on disk when this returns.

        Raises:
            OutputError: The disk is full or gone; nothing of the line is left then.
        """
        line = json.dumps(facts).encode() + b"\n"
        end = self._file.seek(0, os.SEEK_END)
        try:
            if self._file.write(line) != len(line):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            os.fsync(self._file.fileno())
        except OSError as error:
            with suppress(OSError):
                self._file.truncate(end)
            raise self._unwritable(error) from error

    def rewrite(self, lines: Iterable[Mapping[str, Any]]) -> None:
        """Replace the file by these lines; a reader sees it as it was or as it is then.

        Raises:
            OutputError: It cannot be written; it is as it was then.
        """
        aside = self.path.with_name(f".{self.path.name}.{os.getpid()}")
        try:
            with aside.open("wb") as file:
                file.writelines(json.dumps(facts).encode() + b"\n" for facts in lines)
                file.flush()
                os.fsync(file.fileno())
            aside.replace(self.path)
            self._file.close()
            self._file = self.path.open("ab+", buffering=0)
        except OSError as error:
            raise self._unwritable(error) from error

    def _drop_unfinished_line(self) -> None:
        """A killed run can leave half a line, to which the next result must not be glued."""
        self._file.seek(0)
        content = self._file.read()
        self._file.truncate(content.rfind(b"\n") + 1)

    def _unwritable(self, error: OSError) -> OutputError:
        return OutputError(
            f"Results cannot be kept in {self.path}: {error.strerror or error}. Give a folder that can be written, on "
            "a disk with space."
        )
