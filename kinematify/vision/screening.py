"""A voter's record: objects of the library, broken into pieces, whose parts and joints are known.

They are asked once for each model and kept in the user's cache. The objects are generated, so that no voter can have
seen them, and their questions are made as all others are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from kinematify.assembly.part import Assembly, Part
from kinematify.assembly.pieces import connected_sheets
from kinematify.generate.registry import build
from kinematify.generate.request import find_family
from kinematify.grouping.numbered_pieces import NamedPart
from kinematify.robot.joint_type import JointType
from kinematify.robot.raw_mesh import RawMesh
from kinematify.vision.piece_question import PieceQuestion, piece_question

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.config import Config
    from kinematify.robot.arrays import FloatArray

OBJECTS = ("cabinet", "trash_can", "stapler", "window", "box")
"""Of the library: what turns about an edge and a pin, and what slides."""
_SEED = 2026
_SAME, _NEAR = 0.5, np.cos(np.radians(30.0))  # IoU of areas, and axes, of a right part


KnownQuestion: TypeAlias = "tuple[PieceQuestion, tuple[NamedPart, ...]]"
"""A question, and the parts that move."""


def known_questions(config: Config) -> Iterator[KnownQuestion]:
    """Questions of which the right answers are known.

    Args:
        config: How meshes are divided and numbered.
    """
    for name in OBJECTS:
        blueprint = build(find_family(name), {}, seed=_SEED)
        owner, pieces = list[str](), list[Part]()
        for part in blueprint.parts:
            mesh = RawMesh(name=part.name, vertices=part.vertices, faces=part.faces)
            for sheet in connected_sheets(mesh, config.assembly.weld):
                pieces.append(Part(name=f"piece_{len(pieces):03d}", vertices=sheet.vertices, faces=sheet.faces))
                owner.append(part.name)
        for joint in reversed(blueprint.joints):  # what is fixed to a part is of it
            if joint.kind is JointType.FIXED:
                owner = [joint.parent if part == joint.child else part for part in owner]
        truth = tuple(
            NamedPart(
                name=joint.child, pieces=np.flatnonzero([part == joint.child for part in owner]),
                turns=joint.kind.turns, axis=joint.axis,
            )
            for joint in blueprint.joints if joint.kind is not JointType.FIXED
        )  # fmt: skip
        yield piece_question(Assembly(parts=tuple(pieces), source=name, segmented=False), config), truth


def right_parts(named: Sequence[NamedPart], truth: Sequence[NamedPart], areas: FloatArray) -> int:
    """Number of true parts that were named, with their type and roughly their axis.

    Args:
        named: By an answer.
        truth: The parts that move.
        areas: Of the pieces, shape (n,).
    """

    def is_right(one: NamedPart, true: NamedPart) -> bool:
        both, either = (areas[way(one.pieces, true.pieces)].sum() for way in (np.intersect1d, np.union1d))
        along = one.axis is not None and true.axis is not None and abs(float(one.axis @ true.axis)) > _NEAR
        return bool(both > _SAME * either and one.turns == true.turns and along)

    return sum(any(is_right(one, true) for one in named) for true in truth)
