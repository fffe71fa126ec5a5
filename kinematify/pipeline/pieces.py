"""Pieces of one part: what was inferred with them as one, told of each of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.candidate import JointEstimate, JointType
from kinematify.topology.tree import KinematicTree

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly

Pair = tuple[int, int]
Groups = tuple[tuple[int, ...], ...]


def tree_of_pieces(tree: KinematicTree, groups: Groups, mains: Sequence[int]) -> KinematicTree:
    """A tree over groups as one over their pieces: the main piece stands where its group stood, the others hang on it.

    Args:
        tree: Node i is group i.
        groups: Pieces of every group.
        mains: The main piece of every group.
    """
    parents = [-1] * sum(len(group) for group in groups)
    for node, above in enumerate(tree.parents):
        parents[mains[node]] = -1 if above < 0 else mains[above]
        for piece in groups[node]:
            if piece != mains[node]:
                parents[piece] = mains[node]
    broken, virtual = (
        frozenset(pair_of_pieces(pair, mains) for pair in pairs) for pairs in (tree.broken, tree.virtual)
    )
    return KinematicTree(
        parents=tuple(parents), broken=broken, virtual=virtual, reward=tree.reward, terms=dict(tree.terms)
    )


def pair_of_pieces(pair: Pair, mains: Sequence[int]) -> Pair:
    """The main pieces of two groups, ascending."""
    a, b = sorted((mains[pair[0]], mains[pair[1]]))
    return a, b


def joints_of_pieces(
    assembly: Assembly, tree: KinematicTree, joints: Sequence[JointEstimate], groups: Groups, mains: Sequence[int]
) -> tuple[JointEstimate, ...]:
    """The joints of groups as those of their pieces, in the order of `tree.edges()`; pieces of one group are fixed.

    Args:
        assembly: The pieces.
        tree: What `tree_of_pieces` made.
        joints: Between groups.
        groups: Pieces of every group.
        mains: The main piece of every group.
    """
    found = {mains[item.child]: replace(item, parent=mains[item.parent], child=mains[item.child]) for item in joints}
    for main, group in zip(mains, groups, strict=True):
        found.update({piece: _fixed(assembly, main, piece) for piece in group if piece != main})
    return tuple(found[child] for _, child in tree.edges())


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
