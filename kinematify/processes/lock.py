"""A file that one process holds: two commands do not write one output at the same time."""

from __future__ import annotations

import fcntl
import hashlib
import os
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.errors import OutputError

if TYPE_CHECKING:
    from collections.abc import Iterator


@contextmanager
def locked(file: Path, what: str) -> Iterator[None]:
    """Hold a file; the lock goes with the process, however that ends.

    Args:
        file: Made where it is not there, with its folder; it keeps who holds it.
        what: The output, as the message names it.

    Raises:
        OutputError: Another process holds it, which is named, or the file cannot be written.
    """
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        held = file.open("a+", encoding="utf-8")
    except OSError as error:
        raise OutputError(
            f"{what} cannot be written: {error.strerror or error}. Give another place with -o, or "
            "change its permissions or free disk space."
        ) from error
    with held:
        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            held.seek(0)
            raise OutputError(
                f"{what} is being written by {held.read().strip() or 'another process'}. Wait for its end, or give "
                "another place with -o. Nothing was changed."
            ) from None
        held.truncate(0)
        held.write(f"process {os.getpid()} on {os.uname().nodename}, started {time.strftime('%H:%M:%S')}")
        held.flush()
        yield


@contextmanager
def writing(out: Path) -> Iterator[None]:
    """Hold the place of an output, beside which no file is left.

    Raises:
        OutputError: Another process writes there; the message names it.
    """
    name = hashlib.sha256(os.fsencode(out.resolve())).hexdigest()[:24]
    with locked(Path(tempfile.gettempdir()) / f"kinematify-{os.getuid()}" / f"{name}.lock", str(out)):
        yield
