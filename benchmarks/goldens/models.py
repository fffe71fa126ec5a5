"""Goldens of models: inference, what is measured of their edges, and findings."""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.faults.fault import write_base
from benchmarks.faults.plan import FAULTS, write_mutants
from benchmarks.fit.edges import tree_example
from benchmarks.fit.examples import examples_of
from benchmarks.goldens.values import array_hash, file_hashes, made, plain
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.errors import InputError
from kinematify.evaluation.benchmark_job import erased_item, shown_parts
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, bench_folder, find_objects
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.registry import FAMILIES, build
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.record import write_inference
from kinematify.simulation.engines import DEFAULT_ENGINES
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Iterator

    from benchmarks.goldens.values import Values

_REST = CONDITIONS[0]
_SETS = ("robots", "everyday", "everyday2")
_SAMPLE = {
    "robots": ("allegro",),
    "everyday": ("door_9128", "microwave_7236", "drawer_cabinet_27189"),
    "everyday2": ("toaster_103498", "window_102801"),
}
_GENERATED = 20
_FEATURES = {"everyday": (), "robots": ("allegro", "go2", "panda", "ur10e", "fetch", "h1")}
"""Sets whose edges are measured; together more than 200 of them."""
_FEATURES_SAMPLE = ("cabinet_41083", "safe_101623", "toaster_103486")
_PUBLISHED = ("published", "published2")
_STEMS = (
    "model", "Lite3", "T1_serial", "anymal", "dobot", "door", "fridge", "mobility_annotation_gapartnet",
    "piper_description", "schunk_svh_hand_right", "sektion_cabinet", "turtlebot", "wsg_50_mesh_collision",
)  # fmt: skip
"""Files that are validated; some folders have others beside them."""
_PUBLISHED_SAMPLE = ("so100", "pbp_door", "wsg_50")
_BASES = (
    "cabinet_45780", "door_9128", "drawer_cabinet_22692", "laptop_10040", "microwave_7236", "safe_102380",
    "trash_can_102181", "window_103135",
)  # fmt: skip
"""Small objects that faults are planted in."""
_MUTANTS = 4
"""Of each fault; the first one runs in engines, too."""
_FAULTS_SAMPLE = ("type swapped", "wrong parent", "bad inertia", "offset collision geometry")
_CLEAN = ("cabinet", "door", "microwave", "crane", "laptop", "fan")
_ENGINES_WITH_SPREAD = ("pybullet",)
"""Engines that keep something from step to step."""
_NUMBERS = ("measured", "q", "value", "limit", "message", "remedy", "reproduction")
"""What says in numbers what was found, and in which configuration."""
_BUDGET = 3000.0
"""Processor time of a stage of a validation [s]: none ends early, however busy the machine is."""


@dataclass(frozen=True, kw_only=True)
class Generated:
    """An object of the generator."""

    family: str
    seed: int


def _of_sets(chosen: dict[str, tuple[str, ...]]) -> tuple[dict[str, BenchObject], dict[str, str]]:
    """Objects of data sets by set and name, all where none is named, and why a set is absent."""
    found: dict[str, BenchObject] = {}
    absent: dict[str, str] = {}
    for data, names in chosen.items():
        try:
            objects = find_objects(data)
        except InputError as error:
            absent[data] = str(error)
            continue
        found |= {f"{data}/{item.name}": item for item in objects if not names or item.name in names}
    return found, absent


# ---- inference -----------------------------------------------------------------------------------------------------


def inference_items(sample: bool) -> tuple[dict[str, Any], dict[str, str]]:
    """Objects of the benchmark at rest, and objects of the generator."""
    found, absent = _of_sets(_SAMPLE if sample else dict.fromkeys(_SETS, ()))
    families = list(FAMILIES)[:: len(FAMILIES) // _GENERATED][:_GENERATED]
    drawn = [Generated(family=family, seed=number) for number, family in enumerate(families)]
    generated = {f"generated/{item.family} {item.seed}": item for item in (drawn[3:5] if sample else drawn)}
    return {**found, **generated}, absent


def inference_values(item: BenchObject | Generated) -> dict[str, Values]:
    """Files of the inference; of `inference.json` all but times, versions and the configuration that was given."""
    if isinstance(item, Generated):
        parts = build(item.family, seed=item.seed).assembly
    else:
        parts = shown_parts(erased_item(item, _REST))
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        out = Path(folder, "out")
        write_inference(infer(parts), out, preview=False)
        record = json.loads((out / "inference.json").read_text("utf-8"))
        files = file_hashes(out)
    del files["inference.json"]
    for name in ("kinematify", "versions", "seconds", "peak_mb", "configuration"):
        del record[name]
    return made(exact={"files": files, "inference.json": record})


# ---- what is measured of edges -------------------------------------------------------------------------------------


def feature_items(sample: bool) -> tuple[dict[str, Any], dict[str, str]]:
    """Objects whose true edges are measured."""
    return _of_sets({"everyday": _FEATURES_SAMPLE} if sample else dict(_FEATURES))


def feature_values(item: BenchObject) -> dict[str, Values]:
    """Hypotheses of every true edge with all that is measured of them, and the measurements of all contacts."""
    erased, config = erased_item(item, _REST), load_config()
    parts, facts = shown_parts(erased), {"category": item.category, "origin": "golden", "source": "", "fits": False}
    found: Values = {}
    for number, example in enumerate(examples_of(parts, erased.truth, config, **facts)):  # type: ignore[arg-type]
        hypotheses = example.hypotheses
        found[f"edge {number}"] = {
            "hypotheses": {
                "sources": list(hypotheses.sources),
                **{name: array_hash(getattr(hypotheses, name)) for name in ("kinds", "axes", "pivots")},
            },
            "measured": {name: array_hash(value) for name, value in example.measured.items()},
            "sides": {name: array_hash(value) for name, value in example.sides.items()},
            "cloud": plain(example.cloud),
            "size": example.size,
            "by cues": int(example.by_cues),
            "alike": int(example.alike),
        }
    tree = tree_example(parts, erased.truth, config, **facts)  # type: ignore[arg-type]
    found["contacts"] = {"pairs": tree.pairs.tolist(), "measured": array_hash(tree.measured)}
    return made(exact=found)


# ---- findings ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Mutants:
    """Objects with one kind of fault."""

    fault: str
    bases: tuple[BenchObject, ...]
    count: int


def finding_items(sample: bool) -> tuple[dict[str, Any], dict[str, str]]:
    """Published models, generated ones, and objects of the benchmark as they are and with planted faults."""
    found: dict[str, Any] = {}
    absent: dict[str, str] = {}
    for data in _PUBLISHED:
        folder = _published_folder(data)
        for file in sorted(path for path in folder.rglob("*.urdf") if path.stem in _STEMS):
            name = file.relative_to(folder).parts[0]
            if not sample or name in _PUBLISHED_SAMPLE:
                found[f"{data}/{name}"] = file
        if not any(item.startswith(f"{data}/") for item in found):
            absent[data] = f"There are no models in {folder}."
    clean = [Generated(family=family, seed=0) for family in (_CLEAN[:1] if sample else _CLEAN)]
    found |= {f"clean/{item.family} {item.seed}": item for item in clean}
    bases, missing = _of_sets({"everyday": _BASES[:2] if sample else _BASES})
    if missing:
        return found, {**absent, "mutants": missing["everyday"]}
    for fault in FAULTS:
        if not sample or fault.name in _FAULTS_SAMPLE:
            asked = Mutants(fault=fault.name, bases=tuple(bases.values()), count=1 if sample else _MUTANTS)
            found[f"mutants/{fault.name}"] = asked
    if not sample:
        found["mutants/untouched"] = Mutants(fault="", bases=tuple(bases.values()), count=0)
    return found, absent


def _published_folder(data: str) -> Path:
    try:
        return bench_folder().parent / data
    except InputError:
        return Path(data)


def finding_values(item: Path | Generated | Mutants) -> dict[str, Values]:
    """What a validation says of each model."""
    if isinstance(item, Path):
        return _reports({"report": (item, DEFAULT_ENGINES)}, item.parent)
    with tempfile.TemporaryDirectory(prefix="kinematify-") as name:
        folder = Path(name)
        if isinstance(item, Mutants):
            return _reports(dict(_written(item, folder)), folder)
        write_blueprint(build(item.family, seed=item.seed), folder, load_config())
        return _reports({"report": (folder / "model.urdf", DEFAULT_ENGINES)}, folder)


def _written(item: Mutants, folder: Path) -> Iterator[tuple[str, tuple[Path, tuple[str, ...]]]]:
    """Name, file and engines of every mutant, or of the untouched objects."""
    bases = [write_base(base, folder) for base in item.bases]
    faults = [fault for fault in FAULTS if fault.name == item.fault]
    if not faults:
        yield from ((base.name, (base.urdf, ())) for base in bases)
        return
    for number, mutant in enumerate(write_mutants(bases, item.count, 0, faults)):
        yield mutant.name, (Path(mutant.urdf), () if number else DEFAULT_ENGINES)


def _reports(models: dict[str, tuple[Path, tuple[str, ...]]], folder: Path) -> dict[str, Values]:
    settings = load_settings()
    settings = settings.model_copy(update={"budget": settings.budget.model_copy(update={"seconds": _BUDGET})})
    exact, spread = {}, {}
    for name, (urdf, engines) in models.items():
        report = validate(urdf, settings=settings, engines=engines, workers=1).as_json()
        numbers = []
        for item in (*report["checks"], *report["findings"]):
            item.pop("seconds", None)
            if item["engine"] in _ENGINES_WITH_SPREAD:
                numbers.append([item.pop(key, None) for key in _NUMBERS])
        del report["environment"], report["model"]
        exact[name], spread[name] = json.loads(json.dumps([report, numbers]).replace(str(folder), ""))
    return made(exact=exact, spread=spread)
