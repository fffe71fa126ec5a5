"""inference.json: the whole result as data, with versions, seed and configuration."""

from __future__ import annotations

import hashlib
import json
import platform
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify import __version__
from kinematify.grouping.groups import GROUPS_FILE
from kinematify.model.output import MODEL_FILE, PREVIEW_FILE, RECORD_FILE, write_model_folder
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import MESH_FOLDER, write_model
from kinematify.pipeline.inference import DOUBTFUL
from kinematify.robot.arrays import json_values
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.contact.graph import ContactEdge
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.bearings.scores import BearingLine
    from kinematify.joints.candidate import JointCandidate, JointEstimate
    from kinematify.pipeline.inference import CutChain, Inference

SCHEMA = 1
_PACKAGES = ("numpy", "scipy", "torch", "trimesh", "libigl", "python-fcl", "embreex")


def write_inference(inference: Inference, out: str | Path, *, overwrite: bool = False, preview: bool = True) -> None:
    """Write the model folder: ``model.urdf``, ``meshes/``, ``inference.json`` and ``preview.png``.

    Args:
        inference: What `infer` returned.
        out: Folder to make; it appears whole or not at all.
        overwrite: Replace an earlier model folder.
        preview: Draw the picture.

    Raises:
        OutputError: `out` exists and must not be replaced, or cannot be written.
    """
    write_model_folder(
        Path(out), lambda folder: write_inference_files(inference, folder, preview=preview), overwrite=overwrite
    )


def write_inference_files(
    inference: Inference, folder: Path, *, preview: bool = True, progress: Callable[[str, float], None] | None = None
) -> None:
    """Write what belongs to a model folder into an existing folder.

    Args:
        inference: What `infer` returned.
        folder: An existing one.
        preview: Draw the picture.
        progress: Called with each stage and the share of the work done before it, in [0, 1].

    Raises:
        OSError: It cannot be written.
    """
    report = progress or (lambda stage, share: None)
    report("cutting the collision geometry", 0.0)
    model = simulable_model(inference.model, inference.config, swept=inference.swept)
    write_model(model.robot, folder)
    record = {**inference_record(inference), "collision": model.record(), "files": file_hashes(folder)}
    text = json.dumps(record, indent=1, allow_nan=False)
    (folder / RECORD_FILE).write_text(text + "\n", encoding="utf-8")
    if inference.grouping is not None:
        (folder / GROUPS_FILE).write_text(inference.grouping.to_json(), encoding="utf-8")
    if preview:
        report("drawing the picture", 0.7)
        from kinematify.render.model_picture import render_preview  # noqa: PLC0415 - a third of a second

        render_preview(inference.model, folder / PREVIEW_FILE, inference.config.preview, model.robot)


def file_hashes(folder: Path) -> dict[str, str]:
    """SHA-256 of the URDF and the meshes of a model folder, by path: whether somebody has changed them since."""
    files = [folder / MODEL_FILE, *sorted((folder / MESH_FOLDER).glob("*"))]
    return {
        file.relative_to(folder).as_posix(): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in files
        if file.is_file()
    }


def inference_record(inference: Inference) -> dict[str, Any]:
    """The result as JSON values; numbers that are not finite become null."""
    assembly = inference.assembly
    record = {
        "schema": SCHEMA,
        "kinematify": __version__,
        "versions": {"python": platform.python_version(), **package_versions(_PACKAGES)},
        "seed": inference.config.seed,
        "source": assembly.source,
        "options": list(assembly.options),
        "parts": [
            {
                "name": part.name,
                "original_name": assembly.original_names.get(part.name, part.name),
                "faces": len(part.faces),
                "mesh_hash": part.mesh_hash,
                "color": part.color,
                "density": part.density,
            }
            for part in assembly.parts
        ],
        "set_aside": [{"name": k.part.name, "reason": k.reason, "nearest": k.nearest} for k in assembly.set_aside],
        "warnings": list(inference.warnings),
        "clusters": [[assembly.names[part] for part in cluster] for cluster in inference.graph.clusters],
        "contacts": [_contact(inference, edge) for edge in inference.graph.edges],
        "trees": [_tree(tree, assembly.names) for tree in inference.trees],
        "joints": [_joint(joint, assembly.names) for joint in inference.joints],
        "doubtful": list(inference.doubtful),
        "doubtful_below": DOUBTFUL,
        "closed_chains": [_closed_chain(chain) for chain in inference.closed_chains],
        "hints": list(inference.hints),
        "groups": None if inference.grouping is None else inference.grouping.record(),
        "refinement": inference.refinement,
        **({} if inference.vision is None else {"vision": inference.vision}),
        "provenance": inference.provenance,
        "seconds": dict(inference.timings),
        "peak_mb": inference.peak_mb,
        "configuration": inference.config.model_dump(mode="json"),
    }
    found: dict[str, Any] = json_values(record)
    return found


def _contact(inference: Inference, edge: ContactEdge) -> dict[str, Any]:
    names = inference.assembly.names
    bearing = inference.bearings.get((edge.a, edge.b))
    return {
        "a": names[edge.a],
        "b": names[edge.b],
        "gap": edge.gap,
        "strength": edge.strength,
        "bridge": edge.bridge,
        "bearings": [_bearing(line) for line in bearing.lines] if bearing is not None else [],
    }


def _bearing(line: BearingLine) -> dict[str, Any]:
    return {
        "axis": line.axis.tolist(),
        "pivot": line.pivot.tolist(),
        "score": line.score,
        "surface": [*line.surfaces],
        "circles": [*line.rings],
    }


def _tree(tree: KinematicTree, names: tuple[str, ...]) -> dict[str, Any]:
    return {
        "root": names[tree.root],
        "parents": {names[child]: names[parent] for parent, child in tree.edges()},
        "broken": sorted([names[a], names[b]] for a, b in tree.broken),
        "virtual": sorted([names[a], names[b]] for a, b in tree.virtual),
        "reward": tree.reward,
        "terms": dict(tree.terms),
    }


def _joint(joint: JointEstimate, names: tuple[str, ...]) -> dict[str, Any]:
    return {
        "parent": names[joint.parent],
        "child": names[joint.child],
        "type": joint.kind.value,
        "axis": joint.axis.tolist(),
        "pivot": joint.pivot.tolist(),
        "lower": joint.lower,
        "upper": joint.upper,
        "stops": list(joint.stops),
        "confidence": joint.confidence,
        "evidence": {key: float(value) for key, value in joint.evidence.items()},
        "candidates": [_candidate(candidate) for candidate in joint.alternatives],
    }


def _closed_chain(chain: CutChain) -> dict[str, Any]:
    return {
        "parts": list(chain.parts),
        "axis": chain.line.axis.tolist(),
        "pivot": chain.line.pivot.tolist(),
        "joints": list(chain.joints),
        "opened_by": chain.opening.joint,
        "opens": chain.opening.distance,
        "loop": chain.closing.loop,
        "driver": chain.closing.driver,
        "by": chain.closing.by or None,
        "description": chain.description,
    }


def _candidate(candidate: JointCandidate) -> dict[str, Any]:
    return {
        "type": candidate.kind.value,
        "axis": candidate.axis.tolist(),
        "pivot": candidate.pivot.tolist(),
        "score": candidate.score,
        "source": candidate.source,
        "evidence": {key: float(value) for key, value in candidate.evidence.items()},
    }
