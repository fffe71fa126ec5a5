"""A voter's record: questions about objects of the library, whose joints are known, before its answers count.

They are asked once for each model and kept in the user's cache. The objects are generated, so that no voter can have
seen them, and their questions are made as all others are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from kinematify.generate.procedural.family import build
from kinematify.generate.request import find_family
from kinematify.pipeline.infer_assembly import infer
from kinematify.refinement.candidates import CandidateJoints
from kinematify.vision.pictures import joint_question

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.config import Config
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
    from kinematify.joints.candidate import JointCandidate
    from kinematify.pipeline.inference import Inference
    from kinematify.vision.question import JointQuestion

OBJECTS = (
    "laptop", "cabinet", "faucet", "trash_can", "syringe", "stapler", "window", "scissors", "door", "box",
)  # fmt: skip
"""Of the library: what turns about an edge, a pin and an upright axis, and what slides in and up."""
_SEED = 2026
_SAME_DEG, _SAME_LINE = 5.0, 0.05  # as `kinematify bench` tells right joints from wrong ones


KnownQuestion: TypeAlias = "tuple[JointQuestion, frozenset[str]]"
"""A question, and the answers to it that are right."""


def screening_questions(config: Config) -> Iterator[KnownQuestion]:
    """Questions of which the right answers are known: about the largest moving part of each object.

    Objects whose joint is not among the options are omitted.

    Args:
        config: All stages; objects are inferred with it.
    """
    for name in OBJECTS:
        blueprint = build(find_family(name), {}, seed=_SEED)
        inference = infer(blueprint.assembly, config=config)
        maker = CandidateJoints(inference.assembly, inference.graph, inference.bearings, config)
        for place in _largest_first(inference):
            question, true = _known_question(inference, place, maker, blueprint)
            if question is not None and true is not None:
                right = right_choices(question.options, true, inference.assembly.diagonal)
                if right:
                    yield question, right
                    break


def _largest_first(inference: Inference) -> list[int]:
    area_of = [inference.assembly.parts[joint.child].area for joint in inference.joints]
    return sorted(range(len(area_of)), key=lambda place: -area_of[place])


def _known_question(
    inference: Inference, place: int, maker: CandidateJoints, blueprint: Blueprint
) -> tuple[JointQuestion | None, BlueprintJoint | None]:
    """The question about a joint and the true joint; None where the tree is wrong there, or the part hidden."""
    joint, names = inference.joints[place], inference.assembly.names
    true = blueprint.joint_above.get(names[joint.child])
    if true is None or true.parent != names[joint.parent]:
        return None, None
    return joint_question(inference, place, maker), true


def right_choices(options: tuple[JointCandidate, ...], true: BlueprintJoint, diagonal: float) -> frozenset[str]:
    """Numbers of the options that are the true joint.

    Args:
        options: In the order of their numbers.
        true: Type, axis and pivot.
        diagonal: Of the object [m].
    """
    found = set()
    for number, option in enumerate(options, 1):
        near = abs(float(option.axis @ true.axis)) > np.cos(np.radians(_SAME_DEG))
        apart = float(np.linalg.norm(np.cross(option.pivot - true.pivot, true.axis)))
        placed = not option.kind.turns or apart <= _SAME_LINE * diagonal
        if option.kind.turns == true.kind.turns and near and placed:
            found.add(str(number))
    return frozenset(found)
