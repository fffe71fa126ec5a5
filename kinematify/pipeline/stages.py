"""The stages of a run whose method the configuration chooses: ours, or those of the paper as printed."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.errors import InputError
from kinematify.geometry.part_stats import assembly_stats
from kinematify.joints.choice.decide import estimate_joints
from kinematify.joints.features.pins import find_pins
from kinematify.paper.trees import PaperReward, base_by_degree
from kinematify.topology.base_link import base_probabilities
from kinematify.topology.edge_evidence import gather_evidence
from kinematify.topology.reward import TreeReward
from kinematify.topology.search import search_trees, spanning_edges

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config, TopologyConfig
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.contact.tree import KinematicTree
    from kinematify.geometry.part_stats import PartStats
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.candidate import JointEstimate
    from kinematify.topology.edge_evidence import TreeEvidence
    from kinematify.topology.reward import SimulatedEdges


def find_trees(
    assembly: Assembly,
    graph: ContactGraph,
    bearings: Mapping[Pair, EdgeBearing],
    config: Config,
    *,
    base: int | None = None,
    simulated: SimulatedEdges | None = None,
    warm: Sequence[KinematicTree] = (),
) -> tuple[KinematicTree, ...]:
    """The best kinematic trees of an assembly; arguments as in `rank_trees`."""
    stats = assembly_stats(assembly)
    evidence = gather_evidence(graph, stats, bearings, find_pins(assembly, graph, stats, bearings, config))
    return rank_trees(
        graph, stats, evidence, config.topology, seed=config.seed, base=base, simulated=simulated, warm=warm
    )


def tree_reward(
    assembly: Assembly, graph: ContactGraph, bearings: Mapping[Pair, EdgeBearing], config: Config
) -> TreeReward:
    """Return what trees of an assembly are worth under the configuration."""
    stats = assembly_stats(assembly)
    evidence = gather_evidence(graph, stats, bearings, find_pins(assembly, graph, stats, bearings, config))
    return _reward_class(config.topology)(graph, stats, evidence, config.topology)


def _reward_class(config: TopologyConfig) -> type[TreeReward]:
    return PaperReward if config.reward == "paper" else TreeReward


def rank_trees(
    graph: ContactGraph,
    stats: Sequence[PartStats],
    evidence: TreeEvidence,
    config: TopologyConfig,
    *,
    seed: int,
    base: int | None = None,
    simulated: SimulatedEdges | None = None,
    warm: Sequence[KinematicTree] = (),
) -> tuple[KinematicTree, ...]:
    """Search trees by the reward and the base rule of the configuration.

    Args:
        graph: Contacts, bridges and clusters of congruent parts.
        stats: Size and support of every part, world frame, z up.
        evidence: Of its edges.
        config: Mode, reward, base rule and budget.
        seed: Seed of the search; it only breaks ties.
        base: Index of the base link where it is known.
        simulated: What a simulation had against edges.
        warm: Trees to begin with, beside the spanning tree of each base; the search never returns less.

    Returns:
        At most `config.keep` distinct trees, highest reward first.

    Raises:
        InputError: There are fewer than two parts, `base` is no part, or the lengths do not match.
    """
    reward = _reward_class(config)(graph, stats, evidence, config, simulated)
    if base is not None and not 0 <= base < graph.n_parts:
        raise InputError(f"Part {base} was given as base link, but the parts are numbered 0 to {graph.n_parts - 1}.")
    if base is None and config.base_rule == "given":
        raise InputError(
            "The configuration takes the base link as input, as the paper's Algorithm 1 does, and none was given. Name "
            "one with --base, or take a configuration that finds it, e.g. paper or default."
        )
    standing: tuple[float, ...] = ()
    if base is None and config.base_rule == "degree":
        base = base_by_degree(graph)
    elif base is None:
        edges = spanning_edges(reward.quality, reward.centroids)
        standing = tuple(base_probabilities(edges, stats, graph.alike.kind).tolist())
        base = standing.index(max(standing))
    return tuple(replace(tree, standing=standing) for tree in search_trees(reward, base, seed=seed, warm=warm))


def choose_joints(
    assembly: Assembly,
    graph: ContactGraph,
    tree: KinematicTree,
    bearings: Mapping[Pair, EdgeBearing],
    config: Config,
) -> tuple[JointEstimate, ...]:
    """The joint of every edge of a tree, in the order of `tree.edges()`, by the method of the configuration."""
    if config.joints.method == "geometry":
        return estimate_joints(assembly, graph, tree, bearings, config=config.joints, seed=config.seed)
    # torch takes seconds to import, and only this branch needs it.
    from kinematify.paper.joints import estimate_paper_joints  # noqa: PLC0415

    return estimate_paper_joints(assembly, graph, tuple(tree.edges()), config=config)


def with_doubt_of_parents(joints: Sequence[JointEstimate], tree: KinematicTree) -> tuple[JointEstimate, ...]:
    """Joints with less confidence where the part could as well hang on another one, or bear what is its parent here."""
    beyond = np.array(tree.standing or np.zeros(len(tree.parents)))
    for parent, child in reversed(list(tree.edges())):
        beyond[parent] += beyond[child]
    found = []
    for joint in joints:
        # The other way round where the base link is beyond the part.
        right = tree.likely.get(pair(joint.parent, joint.child), 1.0) * (1.0 - float(beyond[joint.child]))
        evidence = {**joint.evidence, "parent_likely": right}
        found.append(replace(joint, confidence=joint.confidence * right, evidence=evidence))
    return tuple(found)
