"""The state of a request on disk: what was sent, what was accepted, what was fetched. It is why nobody pays twice.

A step that costs money is written down before it is sent. If the process dies before the answer is known, nobody can
tell whether it was paid; the next call then stops and says so instead of sending it again.
"""

from __future__ import annotations

import fcntl
import json
import os
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from kinematify.errors import EnvironmentFault, InputError, OutputError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

SCHEMA = 1
STATE_FILE = "job.json"
SENDING, DONE = "sending", "done"


@dataclass
class PaidJob:
    """One request; every change is on disk before the next line runs."""

    folder: Path
    source: str
    digest: str
    steps: dict[str, dict[str, Any]] = field(default_factory=dict)

    def state(self, step: str) -> str | None:
        """Return how far a step has come; None if it was not begun."""
        return self.steps.get(step, {}).get("state")

    def facts(self, step: str) -> dict[str, Any]:
        """Return what the provider reported about a step."""
        return dict(self.steps.get(step, {}))

    def begin(self, step: str) -> None:
        """Note that a request that may cost money is about to be sent.

        Raises:
            EnvironmentFault: It may have been sent before.
        """
        if self.state(step) == SENDING:
            raise EnvironmentFault(
                f"The step {step!r} of {self.folder} was sent before, and no answer is known: it may have been paid. "
                "Look at the provider's list of jobs, and call again with --resend to send it once more."
            )
        self._set(step, {"state": SENDING})

    def drop(self, step: str) -> None:
        """Forget a step that the provider has certainly not accepted."""
        self.steps.pop(step, None)
        self._write()

    def finish(self, step: str, **facts: Any) -> None:
        """Note that a step is done."""
        self._set(step, {"state": DONE, **facts})

    def resend(self) -> None:
        """Forget the steps whose fate is unknown, so that they are sent again."""
        self.steps = {step: facts for step, facts in self.steps.items() if facts.get("state") != SENDING}
        self._write()

    def _set(self, step: str, facts: dict[str, Any]) -> None:
        self.steps[step] = facts
        self._write()

    def _write(self) -> None:
        state = {"schema": SCHEMA, "source": self.source, "digest": self.digest, "steps": self.steps}
        keep(self.folder / STATE_FILE, state)


def keep(path: Path, values: Any) -> None:
    """Write JSON values, whole or not at all, and onto the disk.

    Raises:
        OutputError: It cannot be written.
    """
    partly = path.with_suffix(f".{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with partly.open("w", encoding="utf-8") as file:
            file.write(json.dumps(values, indent=1) + "\n")
            file.flush()
            os.fsync(file.fileno())
        partly.replace(path)
    except OSError as error:
        raise OutputError(
            f"{path} cannot be written ({error.strerror}). Free disk space or give another place with -o."
        ) from error


@contextmanager
def open_job(folder: Path, source: str, digest: str) -> Iterator[PaidJob]:
    """Open the job of a request, new or begun, for this process alone.

    Args:
        folder: Where its state and files are; made if it is not there.
        source: Name of the generator.
        digest: Of the request.

    Raises:
        InputError: The folder holds another request, or a state of a newer version.
        OutputError: It cannot be written, or another process works on it.
    """
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
        yield PaidJob(folder=folder, source=source, digest=digest, steps=_begun(folder, source, digest))


def _begun(folder: Path, source: str, digest: str) -> dict[str, dict[str, Any]]:
    path = folder / STATE_FILE
    if not path.is_file():
        return {}
    try:
        state = json.loads(path.read_text(encoding="utf-8"))
        schema, steps = state["schema"], state["steps"]
        same = (state["source"], state["digest"]) == (source, digest)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{path} is no state of a job. Move the folder {folder} away to start again; look there first for what "
            "was paid."
        ) from error
    if schema != SCHEMA:
        raise InputError(f"{path} has schema {schema}; this version reads {SCHEMA}. Use the version that wrote it.")
    if not same:
        raise InputError(
            f"{folder} holds the job of another request (text, images, seed or options differ). Give another -o, or "
            "move that folder away."
        )
    return dict(steps)
