"""The folder of a request: what was sent there, what was answered and made. The same request is answered from it."""

from __future__ import annotations

import fcntl
import json
import os
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError, OutputError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

STATE_FILE = "job.json"


def keep(path: Path, values: Any) -> None:
    """Write JSON values, whole or not at all; they are on disk when this returns.

    Raises:
        OutputError: They cannot be written.
    """
    partly = path.with_suffix(f".{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with partly.open("w", encoding="utf-8") as file:
            json.dump(values, file, indent=1)
            file.flush()
            os.fsync(file.fileno())
        partly.replace(path)
    except OSError as error:
        raise OutputError(
            f"{path} cannot be written ({error.strerror}). Free disk space or give another place."
        ) from error


@contextmanager
def open_job(folder: Path, source: str, digest: str) -> Iterator[None]:
    """Open the folder of a request, new or begun, for this process alone.

    Args:
        folder: Made if it is not there.
        source: Name of the generator.
        digest: Of the request.

    Raises:
        InputError: The folder holds another request.
        OutputError: It cannot be written, or another process works on it.
    """
    path, own = folder / STATE_FILE, {"source": source, "digest": digest}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = (folder / ".lock").open("w")
    except OSError as error:
        raise OutputError(f"The job folder {folder} cannot be made ({error.strerror}). Give another -o.") from error
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise OutputError(f"Another process works on {folder}. Wait for it, or give another -o.") from error
        if path.is_file():
            try:
                same = own.items() <= json.loads(path.read_text(encoding="utf-8")).items()
            except (OSError, ValueError, AttributeError) as error:
                raise InputError(
                    f"{path} is no state of a job. Move the folder {folder} away to start again."
                ) from error
            if not same:
                raise InputError(
                    f"{folder} holds the job of another request (text, images, seed or options differ). Give another "
                    "-o, or move that folder away."
                )
        else:
            keep(path, own)
        yield
