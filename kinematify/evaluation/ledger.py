"""Finished jobs on disk, one JSON line each, so that a run that was killed continues where it stopped."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

from pydantic import TypeAdapter, ValidationError

from kinematify.errors import OutputError
from kinematify.evaluation.job import JobResult

if TYPE_CHECKING:
    from types import TracebackType
    from typing import Self


class _Keyed(Protocol):
    @property
    def key(self) -> str: ...


_Result = TypeVar("_Result", bound=_Keyed)
RESULT = TypeAdapter(JobResult)
_PACKAGE = Path(__file__).resolve().parents[1]
_NO_INFLUENCE = {"cli", "envs", "nightly", "validation", "batch.py", "refine.py"}
"""Parts of the package that stand to the right of the inference."""
_REPORTING = {
    f"benchmark/{name}.py"
    for name in (
        "calibration",
        "degrade_tables",
        "error_pictures",
        "errors",
        "ledger",
        "paper",
        "regression",
        "report",
        "run",
        "scaling",
        "summary",
        "tables",
        "workers",
    )
}
"""Parts of the benchmark that run jobs or show their results."""


class Ledger(Generic[_Result]):
    """Results of a work folder; a context manager that keeps the file open for appending."""

    def __init__(self, path: Path, adapter: TypeAdapter[_Result]) -> None:
        self.path = path
        self._adapter = adapter

    def __enter__(self) -> Self:
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = self.path.open("ab+")
        except OSError as error:
            raise OutputError(
                f"The benchmark cannot keep its results in {self.path}: {error}. Give a work folder that can be "
                "written."
            ) from error
        self._drop_unfinished_line()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def read(self) -> dict[str, _Result]:
        """Return the results so far by key; lines that an older version wrote are passed over."""
        self._file.seek(0)
        results = {}
        for line in self._file.read().splitlines():
            try:
                result = self._adapter.validate_json(line)
            except ValidationError:
                continue
            results[result.key] = result
        return results

    def append(self, result: _Result) -> None:
        """Add a result; it is on disk when this returns."""
        self._file.write(self._adapter.dump_json(result) + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def clear(self) -> None:
        """Forget every result."""
        self._file.truncate(0)

    def _drop_unfinished_line(self) -> None:
        """A killed run can leave half a line, to which the next result must not be glued."""
        self._file.seek(0)
        content = self._file.read()
        self._file.truncate(content.rfind(b"\n") + 1)


def code_version() -> str:
    """Hash of the sources that an inference and its score depend on: results of other code are not taken up."""
    digest = hashlib.sha256()
    for path in sorted(_PACKAGE.rglob("*.py")):
        place = path.relative_to(_PACKAGE)
        if place.parts[0] not in _NO_INFLUENCE and place.as_posix() not in _REPORTING:
            digest.update(place.as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()
