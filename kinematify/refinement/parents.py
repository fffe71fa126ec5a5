"""Hints on parents: parts hang where a hint says, and all others where they did as far as that allows."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.pipeline.stages import choose_joints, tree_reward, with_doubt_of_parents
from kinematify.pipeline.warnings import floating_parts
from kinematify.topology.arborescence import tree_with_parents

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.contact.tree import KinematicTree
    from kinematify.pipeline import Inference


def with_parents(inference: Inference, parents: Mapping[int, int]) -> Inference:
    """The inference on the tree that hints ask for.

    Joints stay where neither parent nor what the part carries has changed; the others are chosen as `infer` would.

    Args:
        inference: As it is.
        parents: Parent of parts by index, neither the root nor in a circle.
    """
    before = inference.trees[0]
    if all(before.parents[child] == parent for child, parent in parents.items()):
        return inference
    assembly, graph, config = inference.assembly, inference.graph, inference.config
    tree = tree_with_parents(tree_reward(assembly, graph, inference.bearings, config), before, parents)
    known = {(joint.parent, joint.child): joint for joint in inference.joints}
    chosen = with_doubt_of_parents(choose_joints(assembly, graph, tree, inference.bearings, config), tree)
    joints = tuple(
        known[edge] if _is_as_before(edge, before, tree) else joint
        for edge, joint in zip(tree.edges(), chosen, strict=True)
    )
    old, new = (set(floating_parts(assembly, graph, item)) for item in (before, tree))
    warnings = tuple(warning for warning in inference.warnings if warning not in old - new)
    added = tuple(sorted(new - old - set(warnings)))
    others = tuple(other for other in inference.trees if other.parents != tree.parents)
    return replace(inference, trees=(tree, *others), joints=joints, warnings=(*warnings, *added))


def _is_as_before(edge: tuple[int, int], before: KinematicTree, after: KinematicTree) -> bool:
    """Whether a part has the parent that it had, and carries what it carried."""
    parent, child = edge
    return before.parents[child] == parent and before.subtree(child) == after.subtree(child)
