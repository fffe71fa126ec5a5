"""The tree again: parts that hang on what they do not touch, or run into what should carry them.

The feedback weakens edges, and the search restarts warm from the trees it had, with R_sim among its terms. Joints of
edges that are new are chosen as the inference would.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.pipeline.stages import choose_joints, find_trees
from kinematify.refinement.joint_plan import Plan, PlanChange
from kinematify.topology.reward import SimulatedEdges

if TYPE_CHECKING:
    from collections.abc import Mapping


_SURVIVAL_WEIGHT = 0.5  # half of what the quality of joints weighs
"""Weight of R_sim, the mean survival of a tree's edges, in the reward of the tree search."""


def hung_again(plan: Plan, against: Mapping[tuple[int, int], float]) -> tuple[Plan, list[PlanChange]]:
    """The plan on the tree that the search finds on the same base with what speaks against edges, with what changed.

    Args:
        plan: Its trees are where the search begins.
        against: What failures have said against edges (parent, child) [log odds].
    """
    given = plan.inference
    survival = {edge: float(np.exp(-weight)) for edge, weight in against.items()}
    simulated = SimulatedEdges(survival=survival, weight=_SURVIVAL_WEIGHT)
    trees = find_trees(
        given.assembly, given.graph, given.bearings, given.config, base=given.trees[0].root, simulated=simulated,
        warm=given.trees,
    )  # fmt: skip
    old, tree = given.trees[0], trees[0]
    if tree.parents == old.parents:
        return plan, []
    chosen = choose_joints(given.assembly, given.graph, tree, given.bearings, given.config)
    known = {(joint.parent, joint.child): joint for joint in given.joints}
    joints = tuple(known.get((item.parent, item.child), item) for item in chosen)
    names = (*given.assembly.names, "(base)")
    changes = [
        PlanChange(
            part=names[child],
            what="parent",
            before=names[before],
            after=names[after],
            why="what the simulation has against edges",
        )
        for child, (before, after) in enumerate(zip(old.parents, tree.parents, strict=True))
        if before != after
    ]
    kept = (tree, *(item for item in given.trees if item.parents != tree.parents))
    return Plan(inference=replace(given, trees=kept, joints=joints)), changes
