"""From a blueprint to files: the exact model with what is known of it, and its parts for an inference."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.contact.tree import KinematicTree
from kinematify.generate.procedural.blueprint import ground_truth
from kinematify.joints.candidate import JointEstimate
from kinematify.model.build import build_model
from kinematify.model.output import SOURCE_FILE
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model
from kinematify.robot.obj_file import write_obj
from kinematify.robot.robot import LoopJoint

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.config import Config
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintLoop
    from kinematify.model.kinematic_model import KinematicModel

PARTS_FOLDER = "parts"
INFERRED_FOLDER = "inferred"


def true_model(blueprint: Blueprint, config: Config) -> KinematicModel:
    """Return the model with the joints that the blueprint knows; its zero is the configuration that is shown."""
    index = {part.name: k for k, part in enumerate(blueprint.parts)}
    parents = [-1] * len(index)
    for joint in blueprint.joints:
        parents[index[joint.child]] = index[joint.parent]
    joints = [
        JointEstimate(
            parent=index[joint.parent],
            child=index[joint.child],
            kind=joint.kind,
            axis=joint.axis,
            pivot=joint.pivot,
            lower=joint.lower,
            upper=joint.upper,
            confidence=1.0,
        )
        for joint in blueprint.joints
    ]
    tree = KinematicTree(parents=tuple(parents))
    exact = config.model.model_copy(update={"play": 0.0, "play_travel": 0.0})  # what stands open knows how far
    model = build_model(blueprint.assembly, tree, joints, name=blueprint.name, config=exact)
    names = {joint.child: joint.name for joint in model.joints}
    followers = {
        joint.child: replace(joint.mimic, joint=names[joint.mimic.joint]) for joint in blueprint.joints if joint.mimic
    }
    return replace(
        model,
        joints=tuple(replace(j, mimic=followers.get(j.child)) for j in model.joints),
        loops=tuple(_closed(loop, model) for loop in blueprint.loops),
    )


def _closed(loop: BlueprintLoop, model: KinematicModel) -> LoopJoint:
    links = loop.one, loop.other
    one, other = (loop.pivot - model.link_by_name[link].T_world_link[:3, 3] for link in links)
    return LoopJoint(name=f"{loop.other}_loop", links=links, points=(one, other))


def write_parts(blueprint: Blueprint, folder: Path) -> None:
    """Write one OBJ per part into a new folder: all that an inference needs.

    Raises:
        OSError: It cannot be written.
    """
    folder.mkdir(parents=True)
    for part in blueprint.parts:
        write_obj(folder / f"{part.name}.obj", part.vertices, part.faces)


def write_blueprint(
    blueprint: Blueprint, folder: Path, config: Config, *, facts: Mapping[str, Any] | None = None
) -> KinematicModel:
    """Write ``model.urdf`` with the exact joints, ``truth.json`` and ``source.json`` into a folder, made if need be.

    The folder is one object of a benchmark: `kinematify bench` takes it as it is.

    Args:
        blueprint: What is written.
        folder: Where.
        config: Of the model.
        facts: What else ``source.json`` says, as JSON values.

    Returns:
        The model that was written.

    Raises:
        OSError: It cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    model = true_model(blueprint, config)
    write_model(simulable_model(model, config, powered=True).robot, folder)
    (folder / "truth.json").write_text(ground_truth(blueprint).to_json() + "\n", encoding="utf-8")
    known = {"kind": "procedural", "category": blueprint.family, "parameters": dict(blueprint.parameters)}
    (folder / SOURCE_FILE).write_text(json.dumps({**known, **(facts or {})}, indent=1) + "\n", encoding="utf-8")
    return model
