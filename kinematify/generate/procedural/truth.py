"""What is known of a blueprint, in the form in which answers are measured."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.assembly.truth import GroundTruth, TrueJoint

if TYPE_CHECKING:
    from kinematify.generate.blueprint import Blueprint


def ground_truth(blueprint: Blueprint) -> GroundTruth:
    """Return the truth about the parts of a blueprint, in their order and under their names."""
    index = {part.name: k for k, part in enumerate(blueprint.parts)}
    seed = blueprint.parameters.get("seed")
    return GroundTruth(
        name=blueprint.name,
        part_names=tuple(index),
        part_links=tuple((name,) for name in index),
        joints=tuple(
            TrueJoint(
                name=f"{joint.child}_joint",
                source=f"{joint.child}_joint",
                kind=joint.kind,
                parent=index[joint.parent],
                child=index[joint.child],
                axis=joint.axis,
                pivot=joint.pivot,
                lower=joint.lower,
                upper=joint.upper,
                value=joint.value,
                mimic=joint.mimic and replace(joint.mimic, joint=f"{joint.mimic.joint}_joint"),
            )
            for joint in blueprint.joints
        ),
        dropped=(),
        configuration={},
        pose="rest",
        seed=seed if isinstance(seed, int) else 0,
        yaw_deg=0.0,
    )
