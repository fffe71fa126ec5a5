"""A model folder opened again: its parts as they were given, and the configuration that inferred it."""

from __future__ import annotations

import json
import shutil
from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.assembly.assemble import assemble
from kinematify.config import Config
from kinematify.contact.tree import KinematicTree
from kinematify.errors import InputError
from kinematify.joints.candidate import JointCandidate, JointEstimate
from kinematify.model.output import MODEL_FILE, PREVIEW_FILE, RECORD_FILE, check_output, write_model_folder
from kinematify.model.urdf import MESH_FOLDER
from kinematify.pipeline.record import SCHEMA, file_hashes, write_inference_files
from kinematify.robot.joint_type import JointType
from kinematify.robot.raw_mesh import RawMesh
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import transformed

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly, Part
    from kinematify.pipeline.inference import Inference

_OURS = {MODEL_FILE, RECORD_FILE, MESH_FOLDER, PREVIEW_FILE}
_STALE = {"validation.html", "validation.json"}
"""Reports about the model as it was."""


def open_model_folder(folder: str | Path) -> tuple[Assembly, Config]:
    """Read the parts of a model folder, world frame, with the configuration that its model was inferred with.

    Args:
        folder: What `kinematify infer` or `generate` has made.

    Raises:
        InputError: It is no model folder, its model was changed since, or another version of Kinematify made it.
    """
    folder = Path(folder)
    record = read_record(folder)
    _check_untouched(folder, record)
    try:
        config = Config.model_validate(record["configuration"])
    except ValueError as error:
        raise InputError(
            f"The configuration in {folder / RECORD_FILE} is not one of this version of Kinematify "
            f"({str(error).splitlines()[0]}). Infer the model again from its parts."
        ) from error
    meshes = _meshes(folder, record)
    assembly = assemble(meshes, source=str(record.get("source", folder)), config=config.assembly)
    parts, options = tuple(with_materials(part, record) for part in assembly.parts), tuple(record.get("options", ()))
    return replace(assembly, parts=parts, options=options), config


def stored_state(inference: Inference, record: dict[str, Any]) -> Inference:
    """An inference made again, with the tree and the joints that a model folder holds in place of the best ones.

    They differ where the model in the folder is a refined one.

    Args:
        inference: Of the same parts and configuration.
        record: `inference.json` of the folder.
    """
    names = inference.assembly.names
    known = {(joint.parent, joint.child): joint for joint in inference.joints}
    above = record["trees"][0]["parents"]
    tree = KinematicTree(parents=tuple(names.index(above[name]) if name in above else -1 for name in names))
    left = {names.index(item["child"]): item for item in record["joints"]}
    joints = tuple(_joint(edge, left[edge[1]], known.get(edge)) for edge in tree.edges())
    same = tree.parents == inference.trees[0].parents
    trees = inference.trees if same else (tree, *inference.trees)
    return replace(
        inference,
        trees=trees,
        joints=joints,
        hints=tuple(record.get("hints", ())),
        refinement=record.get("refinement"),
        vision=record.get("vision"),
    )


def _joint(edge: tuple[int, int], item: dict[str, Any], known: JointEstimate | None) -> JointEstimate:
    """A joint as it was written; the candidates are those found again, or else those that were written."""
    alternatives = tuple(
        JointCandidate(
            kind=JointType(candidate["type"]),
            axis=np.array(candidate["axis"]),
            pivot=np.array(candidate["pivot"]),
            score=candidate["score"],
            source=candidate["source"],
        )
        for candidate in item["candidates"]
    )
    kind = JointType(item["type"])
    ends = (-np.inf, np.inf) if kind is JointType.CONTINUOUS else (0.0, 0.0)
    return JointEstimate(
        parent=edge[0],
        child=edge[1],
        kind=kind,
        axis=np.array(item["axis"]),
        pivot=np.array(item["pivot"]),
        lower=ends[0] if item["lower"] is None else item["lower"],
        upper=ends[1] if item["upper"] is None else item["upper"],
        stops=tuple(item.get("stops", ("", ""))),
        confidence=item["confidence"],
        alternatives=known.alternatives if known is not None else alternatives,
        evidence={key: value for key, value in item["evidence"].items() if value is not None},
    )


def read_record(folder: Path) -> dict[str, Any]:
    """`inference.json` of a model folder.

    Raises:
        InputError: There is none, or it cannot be read.
    """
    path = folder / RECORD_FILE
    if not path.is_file():
        raise InputError(
            f"There is no {RECORD_FILE} in {folder}, so the alternatives of its model are unknown. Give a "
            "folder of `kinematify infer`, or inferred/ of `kinematify generate --infer`; infer a URDF from elsewhere "
            "with `kinematify infer MODEL.urdf -o FOLDER`."
        )
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"The record {path} cannot be read as JSON: {error}. Infer the model again.") from error
    if not isinstance(record, dict) or record.get("schema") != SCHEMA or "files" not in record:
        raise InputError(
            f"The record {path} was made by an older version of Kinematify, which did not note what it wrote. Infer "
            "the model again from its parts."
        )
    without = [joint["child"] for joint in record["joints"] if not {"candidates", "evidence"} <= joint.keys()]
    if without:
        raise InputError(
            f"The record {path} has no candidates of the joint of {', '.join(without)}, so that nothing else can be "
            "tried. Infer the model again from its parts."
        )
    return record


def target_of(folder: Path, out: str | Path | None, *, overwrite: bool) -> Path:
    """Return the folder to write a refined model to, once it may be written.

    Raises:
        InputError: The model in `folder` would be replaced without `overwrite`, or one of the folders holds the other.
        OutputError: `out` exists and must not be replaced, or cannot be written.
    """
    if out is None and not overwrite:
        raise InputError(
            f"The refined model would replace the one in {folder}.\n"
            f"Give -o OUT to write it to another folder, or --force to replace the model in {folder}."
        )
    target = folder if out is None else Path(out)
    ends = folder.resolve(), target.resolve()
    if ends[0] != ends[1] and (ends[0] in ends[1].parents or ends[1] in ends[0].parents):
        raise InputError(f"One of the folders {folder} and {target} lies in the other. Give a place beside {folder}.")
    if out is not None:
        check_output(target, overwrite=overwrite)
    return target


def write_refined(
    inference: Inference, folder: Path, out: Path | None = None, *, overwrite: bool = True, preview: bool
) -> None:
    """Write a refined model with what else lies in the folder of the earlier one, but no report about that one.

    The folder that is written changes as a whole or not at all.

    Args:
        inference: The refined one.
        folder: Where the earlier model is.
        out: Folder to make, neither within `folder` nor around it; `folder` itself if None.
        overwrite: Replace `out` if it is a model folder.
        preview: Draw a picture.

    Raises:
        OutputError: `out` exists and must not be replaced, or cannot be written.
    """

    def write(staging: Path) -> None:
        for entry in folder.iterdir():
            if entry.name not in _OURS | _STALE:
                copy = shutil.copytree if entry.is_dir() else shutil.copy2
                copy(entry, staging / entry.name)
        write_inference_files(inference, staging, preview=preview)

    write_model_folder(folder if out is None else out, write, overwrite=overwrite)


def _check_untouched(folder: Path, record: dict[str, Any]) -> None:
    """Refuse a model that was changed by hand: choosing again would lose the change in silence."""
    now = file_hashes(folder)
    changed = sorted(name for name, digest in record["files"].items() if now.get(name) != digest)
    if changed:
        more = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        raise InputError(
            f"The file {folder / changed[0]}{more} was changed or removed since the model was inferred, and refining "
            f"would lose that. Infer the changed parts again (`kinematify infer {folder / MODEL_FILE} -o NEW`), or put "
            "the file back."
        )


def _meshes(folder: Path, record: dict[str, Any]) -> list[RawMesh]:
    """One mesh per part, and those that had been set aside, in the world frame of the input."""
    robot = read_robot(folder / MODEL_FILE, geometry="shown", appearance=True)
    poses = forward_kinematics(robot, {})
    aside: dict[str, list[str]] = defaultdict(list)
    for item in record["set_aside"]:
        aside[item["nearest"]].append(item["name"])
    found = {}
    for link in robot.links:
        T = poses[link.name]
        names = [link.name, *aside[link.name]]
        for name, mesh in zip(names, link.meshes, strict=False):
            found[name] = RawMesh(
                name=name,
                vertices=transformed(mesh.vertices, T),
                faces=mesh.faces,
                appearance=mesh.appearance,
            )
    order = [part["name"] for part in record["parts"]]
    return [found.pop(name) for name in order if name in found] + list(found.values())


def with_materials(part: Part, record: dict[str, Any]) -> Part:
    """Colour and density as the source knew them."""
    facts: dict[str, Any] = next((item for item in record["parts"] if item["name"] == part.name), {})
    color = facts.get("color")
    look = None if color is None else part.appearance  # else the colour that its file was given would become its own
    return replace(part, color=None if color is None else tuple(color), appearance=look, density=facts.get("density"))
