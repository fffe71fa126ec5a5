"""Pieces of one part: what was inferred with them as one, reported of each of them."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.contact.seams import largest_piece
from kinematify.contact.tree import KinematicTree
from kinematify.joints.candidate import JointEstimate
from kinematify.pipeline.warnings import cut_parts
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.pipeline.inference import Inference

Groups = tuple[tuple[int, ...], ...]


def piece_standing_for(name: str | None, assembly: Assembly, groups: Groups) -> str | None:
    """Name of the main piece of the group that a part belongs to; None for None."""
    if name is None:
        return None
    group = next(group for group in groups if assembly.names.index(name) in group)
    return assembly.names[largest_piece(assembly, group)]


def inference_of_pieces(
    whole: Inference, assembly: Assembly, graph: ContactGraph, groups: Groups, seconds: Mapping[str, float]
) -> Inference:
    """Return what was inferred with the pieces of every part as one, with the pieces fixed to each other.

    Args:
        whole: Of the joined parts; part i is group i.
        assembly: The pieces.
        graph: Their contacts.
        groups: Pieces of every group.
        seconds: Wall time that each stage had taken before [s].
    """
    mains = [largest_piece(assembly, group) for group in groups]
    trees = tuple(tree_of_pieces(tree, groups, mains) for tree in whole.trees)
    bearings = {pair_of_pieces(ends, mains): bearing for ends, bearing in whole.bearings.items()}
    return replace(
        whole,
        assembly=assembly,
        graph=graph,
        bearings=MappingProxyType({ends: item for ends, item in bearings.items() if ends in graph.by_pair}),
        trees=trees,
        joints=joints_of_pieces(assembly, trees[0], whole.joints, groups, mains),
        timings=MappingProxyType({name: seconds.get(name, 0.0) + t for name, t in whole.timings.items()}),
        warnings=(*assembly.warnings, *whole.warnings, *cut_parts(assembly, groups, mains)),
    )


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
        frozenset(pair_of_pieces(ends, mains) for ends in pairs) for pairs in (tree.broken, tree.virtual)
    )
    return KinematicTree(
        parents=tuple(parents), broken=broken, virtual=virtual, reward=tree.reward, terms=dict(tree.terms)
    )


def pair_of_pieces(ends: Pair, mains: Sequence[int]) -> Pair:
    """The main pieces of two groups, ascending."""
    return pair(mains[ends[0]], mains[ends[1]])


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
