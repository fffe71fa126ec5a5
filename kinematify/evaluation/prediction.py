"""A predicted mechanism as the metrics see it: parts of the ground truth by index, joints in world coordinates."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.candidate import JointEstimate


@dataclass(frozen=True, kw_only=True, eq=False)
class Prediction:
    """A predicted kinematic tree."""

    parents: Mapping[int, int]
    """Part -> parent part, -1 for the root. Parts that the method set aside are missing; empty if it failed."""
    joints: tuple[JointEstimate, ...]


NOTHING_PREDICTED = Prediction(parents={}, joints=())
"""What a run that failed is scored as: every joint is missing."""


def prediction_of(
    tree: KinematicTree, estimates: Sequence[JointEstimate], names: Sequence[str], part_index: Mapping[str, int]
) -> Prediction:
    """Translate an inferred tree and its joints to the parts of the ground truth.

    Args:
        tree: The best tree; node i is the part `names[i]`.
        estimates: One joint per tree edge.
        names: Part names in the order of the tree's nodes.
        part_index: Part name -> index of the part in the ground truth.
    """
    index = [part_index[name] for name in names]
    parents = {index[node]: -1 if parent < 0 else index[parent] for node, parent in enumerate(tree.parents)}
    return Prediction(
        parents=parents,
        joints=tuple(
            replace(estimate, parent=index[estimate.parent], child=index[estimate.child]) for estimate in estimates
        ),
    )
