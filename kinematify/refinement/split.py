"""Inferring again with pieces of one part joined, and fixing the pieces to each other in the answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.contact.seams import joined, largest_piece, rigid_pieces
from kinematify.pipeline.infer import infer
from kinematify.pipeline.pieces import joints_of_pieces, tree_of_pieces
from kinematify.refinement.history import PlanChange
from kinematify.refinement.plan import Plan
from kinematify.refinement.topology import SearchedContacts, with_kept

if TYPE_CHECKING:
    from kinematify.contact.graph import Pair


def infer_joined(
    plan: Plan, contacts: SearchedContacts, seams: dict[Pair, float], *, base: int | None
) -> tuple[Plan, SearchedContacts, list[PlanChange]]:
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
    tree = tree_of_pieces(whole.trees[0], groups, mains)
    joints = joints_of_pieces(assembly, tree, whole.joints, groups, mains)
    new = Plan(assembly=assembly, config=plan.config, tree=tree, joints=with_kept(plan, contacts, joints))
    changes = [
        PlanChange(
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


def _parent_name(plan: Plan, part: int) -> str:
    above = plan.tree.parents[part]
    return "nothing" if above < 0 else plan.assembly.names[above]


def _seam(seams: dict[Pair, float], group: tuple[int, ...]) -> float:
    return sum(length for (a, b), length in seams.items() if a in group and b in group)
