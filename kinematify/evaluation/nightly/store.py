"""The folder of all nights: a folder for each, which appears whole or not at all, and the accepted baseline.

```text
results/nightly/
  index.html                 all nights, a line each
  baseline.json              name of the accepted night
  2026-01-31-0a1b2c3/        night.json  runs.jsonl  junit.xml  index.html
  .unfinished/  .lock        of the night that is running, not for the history
```
"""

from __future__ import annotations

import datetime
import json
import shutil
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from kinematify.errors import InputError, OutputError
from kinematify.evaluation.nightly.comparison import CHANGES, ChangeKind
from kinematify.evaluation.nightly.runs import RUN, SCHEMA
from kinematify.evaluation.result_record import git_commit, replace_text

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence
    from pathlib import Path

    from kinematify.evaluation.nightly.comparison import Change
    from kinematify.evaluation.nightly.runs import Run, RunKey

HEADER_FILE = "night.json"
RUNS_FILE = "runs.jsonl"
JUNIT_FILE = "junit.xml"
PAGE_FILE = "index.html"
BASELINE_FILE = "baseline.json"
BADGE_FILE = "badge.json"
MODELS = "models"
"""Folder of a night for the pages of its models."""
UNFINISHED = ".unfinished"


@dataclass(frozen=True, kw_only=True)
class Night:
    """A night that is over."""

    name: str
    """``<date>-<commit>``, numbered where one commit was run twice on a day."""
    header: dict[str, Any]
    """Commit, machine, versions, configuration, what it was compared with and the verdict."""
    runs: tuple[Run, ...]
    changes: tuple[Change, ...]
    """Against the last night, or the baseline where there is no other."""
    baseline_changes: tuple[Change, ...] = ()
    """Against the accepted baseline, where that is another night."""

    @property
    def started(self) -> str:
        """ISO date and time, by which nights are ordered."""
        return str(self.header["started"])

    @property
    def failed(self) -> bool:
        """True if a quality gate fails, against either night."""
        return any(change.gate for change in (*self.changes, *self.baseline_changes))

    @property
    def badge(self) -> dict[str, Any]:
        """The verdict as an endpoint badge of shields.io reads it."""
        problems = sum(change.gate for change in (*self.changes, *self.baseline_changes))
        changed = len({change.object for change in self.changes if change.kind is ChangeKind.INPUT_CHANGED})
        message, color = (f"{problems} worse", "red") if problems else ("passing", "brightgreen")
        message += f", {changed} input{'s' if changed > 1 else ''} changed" if changed else ""
        return {"schemaVersion": 1, "label": "nightly", "message": message, "color": color}


def unwritable(folder: Path, error: OSError) -> str:
    """The message for a folder that cannot be written."""
    return (
        f"The nights cannot be kept in {folder}: {error.strerror or error}. Give a writable "
        "folder on a disk with space with -o."
    )


def load_nights(folder: Path) -> tuple[tuple[Night, ...], tuple[str, ...]]:
    """Return all nights, the oldest first, and a sentence about every folder that is none.

    Raises:
        InputError: A night was written by a newer version; it must not be shown or compared in part.
    """
    nights, warnings = [], []
    for path in sorted(folder.iterdir()) if folder.is_dir() else ():
        if not path.is_dir() or path.name.startswith("."):
            continue
        if not (path / HEADER_FILE).is_file():
            warnings.append(f"{path} has no {HEADER_FILE}: it is no whole night and was passed over.")
            continue
        try:
            nights.append(load_night(path))
        except (ValueError, KeyError, OSError, ValidationError) as error:
            reason = str(error).splitlines()[0]
            warnings.append(f"{path} cannot be read as a night ({reason}) and was passed over; nothing was changed.")
    return tuple(sorted(nights, key=lambda night: (night.started, night.name))), tuple(warnings)


def load_night(path: Path) -> Night:
    """Read one night.

    Raises:
        InputError: It was written by a newer version.
        ValueError: Its files are broken.
        KeyError: Its header lacks something.
        OSError: A file is missing.
    """
    header = json.loads((path / HEADER_FILE).read_text(encoding="utf-8"))
    schema = header["schema"]
    if not isinstance(schema, int) or schema > SCHEMA:
        raise InputError(
            f"The night {path} has schema {schema}, this version reads up to {SCHEMA}: a newer Kinematify wrote it. "
            "Use that version, or give another folder with -o. Nothing was changed."
        )
    lines = (path / RUNS_FILE).read_bytes().splitlines()
    runs = tuple(RUN.validate_json(line) for line in lines)
    if len(runs) != header["runs"]:
        raise ValueError(f"{RUNS_FILE} has {len(runs)} of {header['runs']} runs")
    return Night(
        name=path.name,
        header=header,
        runs=runs,
        changes=CHANGES.validate_python(header["changes"], strict=False),
        baseline_changes=CHANGES.validate_python(header["baseline_changes"], strict=False),
    )


def earlier_runs(nights: Sequence[Night]) -> dict[RunKey, list[Run]]:
    """Runs of each place, the latest first.

    Args:
        nights: The oldest first.
    """
    found: dict[RunKey, list[Run]] = {}
    for night in reversed(nights):
        for run in night.runs:
            found.setdefault(run.place, []).append(run)
    return found


def baseline_of(folder: Path) -> str | None:
    """Return the name of the accepted night; None if none was accepted.

    Raises:
        InputError: The file that names it cannot be read.
    """
    file = folder / BASELINE_FILE
    if not file.is_file():
        return None
    try:
        return str(json.loads(file.read_text(encoding="utf-8"))["night"])
    except (ValueError, KeyError, TypeError, OSError) as error:
        raise InputError(
            f"{file} does not name an accepted night ({error}). Delete it, or accept a night again with "
            "`kinematify nightly --accept NIGHT`."
        ) from error


def find_night(nights: Sequence[Night], name: str, folder: Path) -> Night:
    """Return a night by its name.

    Raises:
        InputError: There is none of that name.
    """
    for night in nights:
        if night.name == name:
            return night
    known = ", ".join(night.name for night in nights[-5:]) or "none yet"
    raise InputError(f"There is no night {name} in {folder}. The latest are: {known}. Give one of them.")


def accept(folder: Path, night: Night) -> None:
    """Make a night the baseline.

    Raises:
        OutputError: The file cannot be written.
    """
    text = json.dumps({"schema": SCHEMA, "night": night.name}, indent=1) + "\n"
    try:
        replace_text(folder / BASELINE_FILE, text)
    except OSError as error:
        raise OutputError(unwritable(folder, error)) from error


def write_night(folder: Path, night: Night, texts: Mapping[str, str], *, models: Path | None = None) -> Path:
    """Write a night; its folder appears whole or not at all, and none is ever replaced.

    Args:
        folder: Of all nights.
        night: Not there yet.
        texts: Further files by name.
        models: Folder of pages that belong to it.

    Raises:
        OutputError: It cannot be written.
    """
    place = folder / night.name
    aside = folder / UNFINISHED / night.name
    facts = {
        **night.header,
        "changes": CHANGES.dump_python(night.changes, mode="json"),
        "baseline_changes": CHANGES.dump_python(night.baseline_changes, mode="json"),
    }
    runs = "".join(RUN.dump_json(run).decode() + "\n" for run in night.runs)
    files = {**texts, RUNS_FILE: runs, HEADER_FILE: json.dumps(facts, indent=1, allow_nan=False) + "\n"}
    try:
        shutil.rmtree(aside, ignore_errors=True)
        aside.mkdir(parents=True)
        for name, text in files.items():
            (aside / name).write_text(text, encoding="utf-8")
        if models is not None:
            shutil.copytree(models, aside / MODELS)  # not moved: a night that is killed now does this again
        aside.rename(place)
    except OSError as error:
        raise OutputError(unwritable(folder, error)) from error
    return place


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
    left = _remaining(folder / UNFINISHED / _FILE)
    resumed = left is not None and left.plan == plan
    state = replace(left, sessions=left.sessions + 1) if left and resumed else _start(plan, taken)
    try:
        (folder / UNFINISHED).mkdir(parents=True, exist_ok=True)
        replace_text(folder / UNFINISHED / _FILE, json.dumps(asdict(state), indent=1) + "\n")
    except OSError as error:
        raise OutputError(unwritable(folder, error)) from error
    return state


def _remaining(file: Path) -> State | None:
    try:
        return State(**json.loads(file.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None  # there is none, or an older version left it: begin again, finished runs are kept by their keys


def _start(plan: str, taken: Collection[str]) -> State:
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
