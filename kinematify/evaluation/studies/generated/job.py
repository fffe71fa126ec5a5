"""One object of a family: built from a seed, its true and its inferred model validated, the joints compared."""

from __future__ import annotations

import hashlib
import tempfile
import time
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import kinematify
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.evaluation.metrics import score_object
from kinematify.evaluation.prediction import prediction_of
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.truth import ground_truth
from kinematify.model.urdf import write_urdf
from kinematify.pipeline import infer
from kinematify.pipeline.generate import true_model
from kinematify.validation.finding import Severity
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from kinematify.config.validation import ValidationSettings
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline import Inference

Result = dict[str, Any]
"""family, seed, key, joints; truth and inferred: errors of each (check, where, message), seconds; accuracy."""
_BUDGET = 1800.0
"""Seconds for one model; on a free machine it takes ten."""
_UNSEEN = ("cli", "envs", "benchmark", "sources")
"""Folders of the package that do not change what is said of a given blueprint."""


def run_job(family: str, seed: int, known: str | None) -> Result | None:
    """Return the result for one object, None if the key that is `known` shows that nothing has changed since."""
    start = time.perf_counter()
    blueprint = build(FAMILIES[family], {}, seed=seed, name=f"{family}_{seed}")
    key = f"{code_version()} {_content(blueprint)}"
    if key == known:
        return None
    config = load_config()
    result = {"family": family, "seed": seed, "key": key, "joints": len(blueprint.joints)}
    result["truth"] = _validated(true_model(blueprint, config))
    try:
        inference = infer(blueprint.assembly, config=config)
    except Exception as error:  # whatever it is, the object got no answer and the others must not wait for it
        fault = {"check": "no answer", "where": "", "message": f"{type(error).__name__}: {error}"}
        result |= {"inferred": {"errors": [fault], "seconds": 0.0}, "accuracy": _accuracy(blueprint, None)}
    else:
        result |= {"inferred": _validated(inference.model), "accuracy": _accuracy(blueprint, inference)}
    return {**result, "seconds": time.perf_counter() - start}


@cache
def code_version() -> str:
    """Hash of what infers, writes and validates, with its settings; the families count by what they build."""
    digest = hashlib.sha256()
    root = Path(kinematify.__file__).parent
    for folder in (root, root / "validation", root / "configs"):
        for path in sorted([*folder.rglob("*.py"), *folder.rglob("*.yaml")]):
            if path.relative_to(root).parts[0] not in _UNSEEN:
                digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def _content(blueprint: Blueprint) -> str:
    """Hash of parts and joints."""
    digest = hashlib.sha256()
    for part in blueprint.parts:
        digest.update(part.mesh_hash.encode())
        digest.update(part.vertices.tobytes())
    for joint in blueprint.joints:
        digest.update(f"{joint.parent} {joint.child} {joint.kind} {joint.lower!r} {joint.upper!r}".encode())
        digest.update(joint.axis.tobytes() + joint.pivot.tobytes())
    return digest.hexdigest()[:12]


def _validated(model: KinematicModel) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        write_urdf(model, Path(folder))
        report = validate(Path(folder, "model.urdf"), settings=_patient(), workers=1)
    errors = [
        {
            "check": item.check,
            "where": item.joint or item.link or " - ".join(item.pair or ()),
            "message": item.message,
        }
        for item in report.counted
        if item.severity is Severity.ERROR
    ]
    return {"errors": errors, "seconds": float(report.environment["seconds"])}


@cache
def _patient() -> ValidationSettings:
    """The shipped thresholds; what a check says of a model must not hang on how busy the machine is."""
    settings = load_settings()
    budget = settings.budget.model_copy(update={"seconds": _BUDGET, "stage_seconds": _BUDGET})
    return settings.model_copy(update={"budget": budget})


def _accuracy(blueprint: Blueprint, inference: Inference | None) -> dict[str, float]:
    if inference is None:
        return {"angle_deg": 90.0, "types_right": 0, "ted": len(blueprint.parts)}
    truth = ground_truth(blueprint)
    index = {name: k for k, name in enumerate(truth.part_names)}
    score = score_object(
        truth,
        prediction_of(inference.trees[0], inference.joints, inference.assembly.names, index),
        centroids=[part.centroid for part in blueprint.parts],
        diagonal=blueprint.assembly.diagonal,
    )
    angles = [joint.angle_deg for joint in score.joints]
    return {
        "angle_deg": sum(angles) / max(len(angles), 1),
        "types_right": sum(joint.type_right for joint in score.joints),
        "ted": float(score.ted.value),
    }
