"""What a night leaves while it runs, so that one that was killed at any point goes on where it stopped."""

from __future__ import annotations

import datetime
import json
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

from kinematify.errors import OutputError
from kinematify.evaluation.nightly.store import UNFINISHED, unwritable
from kinematify.evaluation.record import replace_text
from kinematify.evaluation.sources import git_commit

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

_FILE = "state.json"


@dataclass(frozen=True, kw_only=True)
class State:
    """The night that is running."""

    name: str
    started: str
    """ISO date and time with its zone."""
    commit: str
    dirty: bool
    """Whether sources were changed since the commit."""
    plan: str
    """Hash of the code, the settings and the objects: with others a new night begins."""
    sessions: int
    """How often it was started; above 1 where it was interrupted."""


def open_state(folder: Path, plan: str, taken: Collection[str]) -> State:
    """Take up the unfinished night of a folder, or begin one.

    Args:
        folder: Of all nights.
        plan: Hash of what is to be run.
        taken: Names that the folder has already, of nights and of what is none.

    Returns:
        The state. Its name is among `taken` where the earlier process was killed right after it had finished.

    Raises:
        OutputError: The folder cannot be written.
    """
    left = _left(folder / UNFINISHED / _FILE)
    resumed = left is not None and left.plan == plan
    state = replace(left, sessions=left.sessions + 1) if left and resumed else _begun(plan, taken)
    try:
        (folder / UNFINISHED).mkdir(parents=True, exist_ok=True)
        replace_text(folder / UNFINISHED / _FILE, json.dumps(asdict(state), indent=1) + "\n")
    except OSError as error:
        raise OutputError(unwritable(folder, error)) from error
    return state


def _left(file: Path) -> State | None:
    try:
        return State(**json.loads(file.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None  # there is none, or an older version left it: begin anew, finished runs are kept by their keys


def _begun(plan: str, taken: Collection[str]) -> State:
    now = datetime.datetime.now(tz=datetime.UTC)
    commit, dirty = git_commit()
    base = f"{now.date().isoformat()}-{commit}"
    name, number = base, 1
    while name in taken:
        number += 1
        name = f"{base}-{number}"
    return State(
        name=name, started=now.isoformat(timespec="seconds"), commit=commit, dirty=dirty, plan=plan, sessions=1
    )
