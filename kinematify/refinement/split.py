"""Inferring again with pieces of one part joined, and fixing the pieces to each other in the answer."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.candidate import JointEstimate, JointType
from kinematify.pipeline.infer import infer
from kinematify.refinement.history import Change
from kinematify.refinement.plan import Plan
from kinematify.refinement.seams import joined, largest_piece, rigid_pieces
from kinematify.refinement.topology import Contacts
from kinematify.topology.tree import KinematicTree

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly
    from kinematify.pipeline.infer import Inference

Pair = tuple[int, int]
Groups = tuple[tuple[int, ...], ...]


def infer_joined(
    plan: Plan, contacts: Contacts, seams: dict[Pair, float], *, base: int | None
) -> tuple[Plan, Contacts, list[Change]]:
    """The plan that results when pieces with a common seam are one part.

    Args:
        plan: With the pieces as parts of their own.
        contacts: Their contacts; they stay those of the pieces.
        seams: Pairs of pieces with the length of their seam [m].
        base: Part that is known to be the base link.
    """
    assembly = plan.assembly
    groups = rigid_pieces(len(assembly.parts), seams)
    mains = [largest_piece(assembly, group) for group in groups]
    named = None
    if base is not None:
        named = assembly.names[next(main for main, group in zip(mains, groups, strict=True) if base in group)]
    if len(groups) < 2:
        return plan, contacts, []
    whole = infer(joined(assembly, groups), config=plan.config, base=named)
    tree, joints = _with_pieces(assembly, whole, groups, mains)
    new = Plan(assembly=assembly, config=plan.config, tree=tree, joints=joints)
    changes = [
        Change(
            part=assembly.names[piece],
            what="fixed",
            before=f"a part of its own on {_parent_name(plan, piece)}",
            after=f"fixed to {assembly.names[main]}",
            why=f"they are one part cut in two: their open rims coincide over {_seam(seams, group):.3g} m",
        )
        for main, group in zip(mains, groups, strict=True)
        for piece in group
        if piece != main
    ]
    return new, contacts, changes


def _with_pieces(
    assembly: Assembly, whole: Inference, groups: Groups, mains: list[int]
) -> tuple[KinematicTree, tuple[JointEstimate, ...]]:
    """Tree and joints over all pieces: the main piece of each group stands where the group stood."""
    parents = [-1] * len(assembly.parts)
    for node, above in enumerate(whole.trees[0].parents):
        parents[mains[node]] = -1 if above < 0 else mains[above]
    found = {
        mains[item.child]: replace(item, parent=mains[item.parent], child=mains[item.child]) for item in whole.joints
    }
    for main, group in zip(mains, groups, strict=True):
        for piece in group:
            if piece != main:
                parents[piece] = main
                found[piece] = _fixed(assembly, main, piece)
    tree = KinematicTree(parents=tuple(parents), reward=whole.trees[0].reward, terms=whole.trees[0].terms)
    return tree, tuple(found[child] for _, child in tree.edges())


def _fixed(assembly: Assembly, parent: int, child: int) -> JointEstimate:
    return JointEstimate(
        parent=parent,
        child=child,
        kind=JointType.FIXED,
        axis=np.array([0.0, 0.0, 1.0]),
        pivot=assembly.parts[child].centroid,
        lower=0.0,
        upper=0.0,
        confidence=1.0,
        evidence={"seam": 1.0},
    )


def _parent_name(plan: Plan, part: int) -> str:
    above = plan.tree.parents[part]
    return "nothing" if above < 0 else plan.assembly.names[above]


def _seam(seams: dict[Pair, float], group: tuple[int, ...]) -> float:
    return sum(length for (a, b), length in seams.items() if a in group and b in group)
