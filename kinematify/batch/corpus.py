"""Many objects with known joints, as a benchmark: balanced over the families, from one seed, and resumable."""

from __future__ import annotations

import json
import os
import shutil
import zlib
from collections import Counter
from contextlib import closing
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify import __version__
from kinematify.config import load_config
from kinematify.errors import EnvironmentFault, OutputError
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.processes.pool import Processes, TaskFailure, WorkItem, run_tasks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from kinematify.generate.procedural.blueprint import Blueprint

MANIFEST = "manifest.json"
_AJAR = 0.25  # of the objects, as of things that are seen in rooms
_AJAR_BY = (0.05, 0.6)  # share of the way; more is as good as open, and no object is found so
_LONGEST = 600.0  # seconds for one object
_FEW = 8  # so many are written while other processes are still starting


def write_corpus(
    out: Path,
    count: int,
    *,
    seed: int,
    progress: Callable[[str, float], None],
    workers: int = 1,
) -> Path:
    """Write `count` objects below a folder, one folder each with a URDF, and a manifest.

    Families take turns, so that their numbers differ by one at most; a quarter of the objects stand ajar. The manifest
    says of every object how it was drawn, and its ``source.json`` with which parameters it was built. Objects that are
    there already stay: the same call after an interrupt goes on, and a larger count adds to a smaller corpus of the
    same seed.

    Args:
        out: The folder.
        count: How many objects.
        seed: Draws the parameters; an object of a name has the same ones in a corpus of any size.
        progress: Called with the object and the share done.
        workers: Processes at a time.

    Returns:
        The path of the manifest.

    Raises:
        OutputError: The folder cannot be written, or holds a corpus of another seed.
        EnvironmentFault: An object could not be built.
    """
    manifest = out / MANIFEST
    _check_seed(manifest, seed)
    entries = [_entry(k, seed) for k in range(count)]
    try:
        out.mkdir(parents=True, exist_ok=True)
        counts = Counter(entry["category"] for entry in entries)
        facts = {"schema": 1, "kinematify": __version__, "seed": seed, "categories": counts, "objects": entries}
        manifest.write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
        for left in out.glob(".*.*"):  # half of an object, of a process that was killed
            shutil.rmtree(left)
        missing = [entry for entry in entries if not (out / entry["name"]).exists()]
        for done, name in enumerate(_write_objects(out, missing, workers), start=count - len(missing) + 1):
            progress(name, done / count)
    except OSError as error:
        raise OutputError(
            f"The corpus {out} cannot be written ({error.strerror}). Give a writable folder on a disk with space."
        ) from error
    return manifest


def _entry(k: int, seed: int) -> dict[str, Any]:
    """Object k of a corpus; what it is like hangs on its name alone, so that new families change no other."""
    names = sorted(FAMILIES)
    family, number = names[k % len(names)], k // len(names)
    rng = np.random.default_rng([seed, zlib.crc32(family.encode()), number])
    drawn, ajar = int(rng.integers(2**31)), rng.random() < _AJAR
    share = round(float(rng.uniform(*_AJAR_BY)), 2) if ajar else 0.0
    return {"name": f"{family}_{number:03d}", "category": family, "seed": drawn, "open": share}


def _built(entry: dict[str, Any]) -> Blueprint:
    return build(FAMILIES[entry["category"]], {"open": entry["open"]}, seed=entry["seed"], name=entry["name"])


def _write_objects(out: Path, entries: Sequence[dict[str, Any]], workers: int) -> Iterator[str]:
    """Write the objects and yield the name of each that is finished; few are written in this process."""
    if workers == 1 or len(entries) < _FEW:
        for entry in entries:
            yield _write_object(out, entry)
        return
    tasks = (
        WorkItem(key=entry["name"], call=partial(_write_object, out, entry), timeout=_LONGEST) for entry in entries
    )
    engine = Processes(workers, preload=(__name__,))
    with closing(run_tasks(tasks, engine, reuse=len(entries))) as running:
        for name, answer in running:
            if isinstance(answer, TaskFailure):
                raise EnvironmentFault(
                    f"The object {name} of the corpus could not be written: {answer.message}. What was written stays; "
                    "the same command goes on."
                )
            yield answer


def _write_object(out: Path, entry: dict[str, Any]) -> str:
    """Write one object; it appears whole or not at all."""
    folder: Path = out / entry["name"]
    aside = out / f".{folder.name}.{os.getpid()}"
    shutil.rmtree(aside, ignore_errors=True)
    write_blueprint(_built(entry), aside, load_config())
    aside.rename(folder)
    return folder.name


def _check_seed(manifest: Path, seed: int) -> None:
    if not manifest.is_file():
        return
    try:
        there = json.loads(manifest.read_text(encoding="utf-8")).get("seed")
    except (OSError, ValueError, AttributeError):
        there = None
    if there != seed:
        raise OutputError(
            f"The folder {manifest.parent} holds a corpus of seed {there}, not {seed}. Give that seed to go on "
            "with it, or another folder."
        )
