"""Contacts and tree again: parts that hang on what they do not touch, or run into what should carry them.

A part that loses its parent (KV303) may simply hang on the wrong one because the contact with the right one was never
seen. The exact distances of all near parts say which contacts there are, whatever the graph holds. The feedback then
weakens edges, and the search restarts warm from the trees it had, with R_sim among its terms. Joints of edges that are
new are chosen as the inference would.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.build_graph import build_contact_graph, exact_gap, near_pairs
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_fit import fit_edge
from kinematify.pipeline.stages import choose_joints, find_trees
from kinematify.refinement.joint_plan import Plan, PlanChange
from kinematify.topology.reward import SimulatedEdges

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.geometry.surface import PartSurface

_CONTACT_TOLERANCE = 0.0025  # that of the contact stage, measured again from the meshes
"""Gap up to which two parts are held to touch when contacts are measured again, fraction of the diagonal."""
_HOVERING_SHARE = 0.5  # single parts hang on bearings that are not modelled; half of all do not
"""If so many parts touch nothing, the tolerance is wrong, not the tree."""
_HOVERING_REACH = 1.5  # gaps within one object are alike
"""The tolerance then is this multiple of the median gap to the nearest part."""
_WIDEST_TOLERANCE = 0.03  # farther apart are parts of different things
"""And at most this, fraction of the diagonal."""
_SURVIVAL_WEIGHT = 0.5  # half of what the quality of joints weighs
"""Weight of R_sim, the mean survival of a tree's edges, in the reward of the tree search."""


def measured_again(plan: Plan, *, base: int | None) -> tuple[Plan, list[PlanChange]]:
    """The plan on the contacts that the meshes have, with what changed; nothing where the graph is right.

    Args:
        plan: As inferred.
        base: Part that is known to be the base link.
    """
    given = plan.inference
    assembly, config = given.assembly, given.config
    surfaces = part_surfaces(assembly, config=config.surface)
    missing, spurious, tolerance = audit_contacts(assembly, surfaces, given.graph)
    if not missing | spurious:
        return plan, []
    contact = config.contact.model_copy(update={"tolerance": tolerance})
    graph = build_contact_graph(assembly, surfaces, config=contact, seed=config.seed)
    bearings = {pair: item for pair, item in given.bearings.items() if pair in graph.by_pair}
    for pair, edge in graph.by_pair.items():
        if config.joints.method == "geometry" and (pair not in bearings or pair in missing):
            bearings[pair] = fit_edge(
                surfaces, edge, diagonal=assembly.diagonal, config=config.bearing, seed=config.seed
            )
    plan = Plan(inference=replace(given, graph=graph, bearings=bearings))
    plan, changes = hung_again(plan, {}, base=base)
    applied = PlanChange(
        part=assembly.names[plan.inference.trees[0].root], what="contacts", before=f"{len(given.graph.edges)}",
        after=f"{len(graph.edges)}", why=f"{len(missing)} contacts were missing and {len(spurious)} are none",
    )  # fmt: skip
    return plan, [applied, *changes]


def audit_contacts(
    assembly: Assembly, surfaces: Sequence[PartSurface], graph: ContactGraph
) -> tuple[set[Pair], set[Pair], float]:
    """Hold a contact graph against the exact distances of its parts.

    Where most parts touch nothing at all, the gaps between them are of the object's own, and the tolerance is widened
    to them.

    Returns:
        Pairs that touch and have no edge, edges between parts that do not touch, and the gap up to which parts are
        held to touch, fraction of the diagonal.
    """
    widest = _WIDEST_TOLERANCE * assembly.diagonal
    gaps = {pair: exact_gap(surfaces, pair) for pair in near_pairs(assembly, widest)}
    tolerance = _CONTACT_TOLERANCE * assembly.diagonal
    nearest = [
        min((gap for pair, gap in gaps.items() if part in pair), default=np.inf) for part in range(len(surfaces))
    ]
    apart = np.array(nearest) > tolerance
    if apart.mean() > _HOVERING_SHARE and np.isfinite(nearest).any():
        typical = float(np.median([gap for gap in nearest if np.isfinite(gap)]))
        tolerance = min(max(tolerance, _HOVERING_REACH * typical), widest)
    touching = {pair for pair, gap in gaps.items() if gap <= tolerance}
    known = {(edge.a, edge.b) for edge in graph.edges if not edge.bridge}
    return touching - known, known - touching, tolerance / assembly.diagonal


def hung_again(
    plan: Plan, against: Mapping[tuple[int, int], float], *, base: int | None
) -> tuple[Plan, list[PlanChange]]:
    """The plan on the tree that the search finds with what speaks against edges, with what changed.

    Args:
        plan: Its trees are where the search begins.
        against: What failures have said against edges (parent, child) [log odds].
        base: Part that is known to be the base link.
    """
    given = plan.inference
    survival = {edge: float(np.exp(-weight)) for edge, weight in against.items()}
    simulated = SimulatedEdges(survival=survival, weight=_SURVIVAL_WEIGHT)
    trees = find_trees(
        given.assembly, given.graph, given.bearings, given.config, base=base, simulated=simulated, warm=given.trees
    )
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
            why="the contacts as measured again, and what the simulation had against edges",
        )
        for child, (before, after) in enumerate(zip(old.parents, tree.parents, strict=True))
        if before != after
    ]
    kept = (tree, *(item for item in given.trees if item.parents != tree.parents))
    return Plan(inference=replace(given, trees=kept, joints=joints)), changes
