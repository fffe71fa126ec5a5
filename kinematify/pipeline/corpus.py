"""Many objects with known joints, as a benchmark: balanced over the families, from one seed, and resumable."""

from __future__ import annotations

import json
import os
import shutil
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify import __version__
from kinematify.config import load_config
from kinematify.errors import OutputError
from kinematify.pipeline.generate import write_truth
from kinematify.sources.procedural.families import FAMILIES
from kinematify.sources.procedural.family import build

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from kinematify.config import Config

MANIFEST = "manifest.json"


def write_corpus(out: Path, count: int, *, seed: int, progress: Callable[[str, float], None]) -> Path:
    """Write `count` objects below a folder, one folder each with a URDF, and a manifest.

    Families take turns, so that their numbers differ by one at most. Objects that are there already stay: the same
    call after an interrupt goes on, and a larger count adds to a smaller corpus of the same seed.

    Args:
        out: The folder.
        count: How many objects.
        seed: Draws the parameters; object k has the same ones in a corpus of any size.
        progress: Told the object and the share done.

    Returns:
        The path of the manifest.

    Raises:
        OutputError: The folder cannot be written, or holds a corpus of another seed.
    """
    manifest = out / MANIFEST
    _check_seed(manifest, seed)
    config = load_config()
    entries = [_entry(k, seed) for k in range(count)]
    try:
        out.mkdir(parents=True, exist_ok=True)
        facts = {"schema": 1, "kinematify": __version__, "seed": seed, "objects": entries}
        manifest.write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
        for k, entry in enumerate(entries):
            progress(str(entry["name"]), k / count)
            _write_object(out, entry, config)
    except OSError as error:
        raise OutputError(
            f"The corpus {out} cannot be written ({error.strerror}). Give a folder that you may write to, on a disk "
            "with space."
        ) from error
    return manifest


def _entry(k: int, seed: int) -> dict[str, Any]:
    """Object k of a corpus, the same in a corpus of any size."""
    names = sorted(FAMILIES)
    family = names[k % len(names)]
    drawn = int(np.random.default_rng([seed, k]).integers(2**31))
    return {"name": f"{family}_{k // len(names):03d}", "category": family, "seed": drawn}


def _write_object(out: Path, entry: dict[str, Any], config: Config) -> None:
    """Write one object, unless it is there; it appears whole or not at all."""
    folder = out / entry["name"]
    if folder.exists():
        return
    aside = out / f".{folder.name}.{os.getpid()}"
    shutil.rmtree(aside, ignore_errors=True)
    blueprint = build(FAMILIES[entry["category"]], {}, seed=entry["seed"], name=entry["name"])
    write_truth(blueprint, aside, config)
    aside.rename(folder)


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
