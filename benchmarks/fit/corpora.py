"""What the choice is fitted to and judged on: generated objects in ways of modelling, random mechanisms, real ones.

Objects that files describe judge alone: with them in the fit, no more held-out ones are right (results/choice.md).
"""

from __future__ import annotations

import json
import zlib
from contextlib import closing
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.fit.chains import chain
from benchmarks.fit.composed import compose
from benchmarks.fit.drawn import DRAWN, corpus_kinds, drawn_object
from benchmarks.fit.edges import read_tree_examples, tree_example, write_tree_examples
from benchmarks.fit.examples import content_key, examples_of, read_examples, write_examples
from benchmarks.fit.fragmentation import with_pieces_broken_off
from benchmarks.fit.modelling import WAYS, augment
from kinematify.assembly.erasure import erase
from kinematify.assembly.part import Assembly
from kinematify.config import load_config
from kinematify.errors import EnvironmentFault, InputError, KinematifyError
from kinematify.generate.procedural.blueprint import ground_truth
from kinematify.generate.registry import FAMILIES, build
from kinematify.processes.pool import Processes, TaskFailure, WorkItem, run_tasks
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from benchmarks.fit.edges import TreeExample
    from benchmarks.fit.examples import Example
    from kinematify.assembly.part import Part
    from kinematify.assembly.truth import GroundTruth
    from kinematify.generate.procedural.blueprint import Blueprint

GENERATED = FAMILY, DESCRIBED, PROGRAMMED, COMPOSED, CHAINS = "family", "described", "programmed", "composed", "chains"
_RESEARCH = ("partnet", "shapenet", "research", "non-commercial")
"""Words of licences under which an object judges and never enters weights that ship."""
_MOST_JOINTS = 14  # of a generated object: a hand or hexapod would outweigh the rest
_BROKEN_ROUNDS = 2
_CHAINS = 120
_MOST_PARTS = 25  # of an object with pieces broken off
_AJAR = 0.25  # of the generated objects
_TIMEOUT = 3600.0  # [s] of one object, on a busy machine
_REUSE = 50  # objects of one worker: libraries leak


@dataclass(frozen=True, kw_only=True)
class CorpusSource:
    """One object to measure; small and picklable."""

    origin: str
    """One of `GENERATED`, or the name of the folder of real objects."""
    name: str
    number: int = 0
    """Of a generated object."""
    folder: Path | None = None
    """Of a real one, with its ``model.urdf`` and ``source.json``."""
    broken: bool = False
    """With pieces broken off."""


def generated_sources(rounds: int, composed: int) -> list[CorpusSource]:
    """`rounds` objects of every kind, each modelled in another way, and `composed` random mechanisms."""
    origins = dict.fromkeys(FAMILIES, FAMILY) | dict.fromkeys(DRAWN, PROGRAMMED)
    named = [(origins.get(name, DESCRIBED), name) for name in sorted(corpus_kinds())]
    found = [CorpusSource(origin=origin, name=name, number=n) for n in range(rounds) for origin, name in named]
    return found + [CorpusSource(origin=COMPOSED, name="composed", number=n) for n in range(composed)]


def real_sources(folder: Path) -> list[CorpusSource]:
    """Every object of a folder of objects, or of a folder of such folders.

    Raises:
        InputError: There is none.
    """
    found = [
        CorpusSource(origin=path.parent.parent.name, name=path.parent.name, folder=path.parent)
        for path in sorted([*folder.glob("*/model.urdf"), *folder.glob("*/*/model.urdf")])
    ]
    if not found:
        raise InputError(f"{folder} holds no object: a folder with a model.urdf and a source.json. Give one that does.")
    return found


def broken_sources(sources: Sequence[CorpusSource]) -> list[CorpusSource]:
    """Of every real object, and of two of every object in steps, the same with pieces broken off."""
    return [
        replace(source, broken=True)
        for source in sources
        if source.folder is not None or (source.origin == PROGRAMMED and source.number < _BROKEN_ROUNDS)
    ]


def tree_sources() -> list[CorpusSource]:
    """Generated objects that the edges of the tree and the base link are fitted to: one of every kind, and chains."""
    return generated_sources(1, 0) + [CorpusSource(origin=CHAINS, name=CHAINS, number=n) for n in range(_CHAINS)]


def gather_examples(
    sources: Sequence[CorpusSource], cache: Path, *, seed: int, workers: int, progress: Callable[[str, float], None]
) -> list[Example]:
    """Measure objects, or read what an earlier run has measured of them.

    Args:
        sources: The objects.
        cache: Folder with one file per object that was measured.
        seed: Draws the generated objects.
        workers: Processes at a time.
        progress: Called with the object and the share done.

    Raises:
        EnvironmentFault: An object killed its worker or took an hour.
    """
    paths = _gathered(_measure, sources, cache, seed=seed, workers=workers, progress=progress)
    return [example for path in paths for example in read_examples(path)]


def with_spares(examples: Sequence[Example], most: int | None) -> list[Example]:
    """The examples, of which those beyond the first `most` objects of a category of real ones only judge."""
    if most is None:
        return list(examples)
    taken: dict[tuple[str, str], list[str]] = {}
    found = []
    for example in examples:
        names = taken.setdefault((example.origin, example.category), [])
        if example.object not in names:
            names.append(example.object)
        spare = example.origin not in GENERATED and names.index(example.object) >= most
        found.append(replace(example, spare=spare))
    return found


def gather_trees(
    sources: Sequence[CorpusSource], cache: Path, *, seed: int, workers: int, progress: Callable[[str, float], None]
) -> list[TreeExample]:
    """The contact graphs of objects and their true trees; arguments as of `gather_examples`.

    Raises:
        EnvironmentFault: An object killed its worker or took an hour.
    """
    paths = _gathered(_measure_tree, sources, cache, seed=seed, workers=workers, progress=progress)
    return [example for path in paths for example in read_tree_examples(path)]


def _gathered(
    measure: Callable[[CorpusSource, Path, int], None],
    sources: Sequence[CorpusSource],
    cache: Path,
    *,
    seed: int,
    workers: int,
    progress: Callable[[str, float], None],
) -> list[Path]:
    """One file for every object, written by `measure` where there is none yet."""
    cache.mkdir(parents=True, exist_ok=True)
    paths = [cache / f"{_key(source, seed)}.npz" for source in sources]
    missing = {path: source for source, path in zip(sources, paths, strict=True) if not path.exists()}
    tasks = [
        WorkItem(key=str(path), call=partial(measure, source, path, seed), timeout=_TIMEOUT)
        for path, source in missing.items()
    ]
    with closing(run_tasks(tasks, Processes(workers, preload=(__name__,)), reuse=_REUSE)) as running:
        for done, (path, failure) in enumerate(running, start=len(sources) - len(missing) + 1):
            name = missing[Path(path)].name
            if isinstance(failure, TaskFailure):
                raise EnvironmentFault(
                    f"{name} could not be measured: {failure.message}. Start again; {cache} keeps what was measured."
                )
            progress(name, done / len(sources))
    return paths


def _key(source: CorpusSource, seed: int) -> str:
    """Hash of what the measurements depend on, but not of the code: an emptied folder measures again."""
    files = [] if source.folder is None else sorted(source.folder.rglob("*.*"))
    sizes = [(path.name, path.stat().st_size) for path in files]
    facts = asdict(source) | {"folder": None}
    settings = load_config().joints.model_dump(mode="json", exclude={"confidence"})  # of what is chosen, not measured
    return content_key(facts, sizes, seed, settings)


def _measure(source: CorpusSource, path: Path, seed: int) -> None:
    """Measure one object; one that cannot be built or read gives no example."""
    opened = opened_object(source, seed)
    if opened is None:
        write_examples(path, [])
        return
    name = _name(source)
    parts, truth = opened.parts, opened.truth
    if source.broken:
        parts, truth = with_pieces_broken_off(parts, truth, np.random.default_rng(zlib.crc32(name.encode())))
        if not len(opened.parts) < len(parts) <= _MOST_PARTS:
            write_examples(path, [])
            return
    found = examples_of(
        Assembly(parts=parts, source=name),
        truth,
        load_config(),
        category=opened.category,
        origin=source.origin,
        source=opened.source,
        fits=opened.fits,
        broken=source.broken,
    )
    write_examples(path, found)


def _measure_tree(source: CorpusSource, path: Path, seed: int) -> None:
    """The same of the tree of an object; the edges are fitted to no kinds of the library but families."""
    opened = opened_object(source, seed)
    if opened is None:
        write_tree_examples(path, [])
        return
    example = tree_example(
        Assembly(parts=opened.parts, source=_name(source)),
        opened.truth,
        load_config(),
        category=opened.category,
        origin=source.origin,
        source=opened.source,
        fits=opened.fits,
        contacts=source.origin not in (DESCRIBED, PROGRAMMED),
    )
    write_tree_examples(path, [example])


def _name(source: CorpusSource) -> str:
    """Of an object, among those of its origin."""
    return f"{source.name}_{source.number}" if source.folder is None else source.name


def opened_object(source: CorpusSource, seed: int) -> _Opened | None:
    """The object; None where it cannot be built or read."""
    try:
        return _generated(source, seed) if source.folder is None else _read(source.folder)
    except (KinematifyError, ValueError):
        return None


@dataclass(frozen=True, kw_only=True, eq=False)
class _Opened:
    """An object as it is measured."""

    parts: tuple[Part, ...]
    truth: GroundTruth
    category: str
    source: str
    """Whose work it is."""
    fits: bool
    """It may enter weights that ship."""


def _read(folder: Path) -> _Opened:
    facts = json.loads((folder / "source.json").read_text(encoding="utf-8"))
    erased = erase(read_robot(folder / "model.urdf", geometry="shown"), pose="rest", seed=0, yaw_deg=0.0)
    # "osrf/gazebo_models @ 8163eb4, cessna/model.sdf" is of osrf/gazebo_models.
    written = str(facts.get("source", "unknown")).partition(",")[0].partition("@")[0]
    return _Opened(
        parts=erased.assembly.parts,
        truth=erased.truth,
        category=str(facts.get("category", "unknown")),
        source=str(facts.get("dataset", written)).strip(),
        fits=may_be_fitted_to(facts),
    )


def may_be_fitted_to(facts: Mapping[str, object]) -> bool:
    """Whether the licence in an object's `source.json` lets it enter weights that ship."""
    licence = str(facts.get("license", "research")).lower()
    return not any(word in licence for word in _RESEARCH)


def _generated(source: CorpusSource, seed: int) -> _Opened:
    number = seed + source.number
    blueprint = _drawn(source, number)
    if len(blueprint.joints) > _MOST_JOINTS:
        raise ValueError(f"{source.name} has {len(blueprint.joints)} joints, more than {_MOST_JOINTS}.")
    # Random mechanisms have nothing in common: each is a category of its own.
    category = f"{source.name} {number}" if source.origin == COMPOSED else source.name
    return _Opened(
        parts=blueprint.assembly.parts,
        truth=ground_truth(blueprint),
        category=category,
        source=source.origin,
        fits=source.origin != DESCRIBED,
    )


def _drawn(source: CorpusSource, number: int) -> Blueprint:
    ways = list(WAYS)
    if source.origin == PROGRAMMED:
        return drawn_object(source.name, number)
    if source.origin == CHAINS:
        return chain(number)
    if source.origin == COMPOSED:
        way = ways[number % len(ways)] if number % 3 == 0 else "as_drawn"
        return augment(compose(number), way, rng=np.random.default_rng(number))
    rng = np.random.default_rng([number, zlib.crc32(source.name.encode())])
    ajar = round(float(rng.uniform(0.05, 0.6)), 2) if rng.random() < _AJAR else 0.0
    drawn = int(rng.integers(2**31))
    blueprint = build(corpus_kinds()[source.name], {"open": ajar}, seed=drawn, name=source.name)
    return augment(blueprint, ways[(number + zlib.crc32(source.name.encode())) % len(ways)], rng=rng)
