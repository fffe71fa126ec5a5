"""Reward of a rooted spanning tree: terms of the paper (III-C, Reward) that we keep, and our own.

Each term is in [0, 1]. `TreeReward` binds them to an assembly and returns the weighted sum, normalised to [0, 1].
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.errors import InputError
from kinematify.joints.choice.edges import edge_probabilities, scores_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config import TopologyConfig
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.geometry.part_stats import PartStats
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.topology.edge_evidence import TreeEvidence

EPSILON = 1e-9
"""The paper's ``epsilon``: keeps denominators positive."""


@dataclass(frozen=True, kw_only=True)
class SimulatedEdges:
    """Results of edges in simulation (our R_sim; not in the paper)."""

    survival: Mapping[tuple[int, int], float]
    """Of edges (parent, child) that were simulated, in [0, 1]; 1 for those that nothing speaks against."""
    weight: float
    """Of R_sim in the reward."""

    def of_pair(self, pair: Pair) -> float:
        """Survival of the better direction of an edge (a, b)."""
        a, b = pair
        return max(self.survival.get((a, b), 1.0), self.survival.get((b, a), 1.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class TreeLayout:
    """A rooted tree as arrays; node i has parent ``parents[i]``, the root has -1."""

    parents: IntArray
    """Shape (n,)."""
    order: tuple[int, ...]
    """Nodes in breadth-first order from the root."""
    depth: IntArray
    """Graph distance d(i) from the root, shape (n,)."""

    @property
    def children(self) -> IntArray:
        """All nodes but the root, breadth first, shape (n - 1,)."""
        return np.array(self.order[1:], dtype=np.int64)


def layout_tree(parents: Sequence[int]) -> TreeLayout:
    """Order a tree given by its parents; -1 marks the root."""
    lists: list[list[int]] = [[] for _ in parents]
    order: list[int] = []
    for node, parent in enumerate(parents):
        (lists[parent] if parent >= 0 else order).append(node)
    depth = np.zeros(len(parents), dtype=np.int64)
    for node in order:
        depth[lists[node]] = depth[node] + 1
        order.extend(lists[node])
    return TreeLayout(parents=np.asarray(parents, dtype=np.int64), order=tuple(order), depth=depth)


def mean_over_edges(tree: TreeLayout, weights: FloatArray) -> float:
    """``R_contact = 1/|E| sum s(u, v)``: mean edge weight, `weights` of shape (n, n) in [0, 1]."""
    return float(weights[tree.parents[tree.children], tree.children].mean())


def corresponding_symmetry(tree: TreeLayout, clusters: Sequence[Sequence[int]], kind: IntArray) -> float:
    """Our R_sym in [0, 1]: equal depths, and parents that are one part or one cluster, each part used equally often.

    The paper asks for one shared parent, which is false for knees: each hangs on its own thigh, and the thighs
    correspond. Without clusters the term is neutral (1).
    """
    scores = []
    for cluster in clusters:
        kinds = _parent_kinds([int(tree.parents[part]) for part in cluster], kind)
        excess = min(kinds - 1, len(cluster) - 1)
        scores.append(0.5 * equal_depth(tree, cluster) + 0.5 * (1 - excess / (len(cluster) - 1)))
    return float(np.mean(scores)) if scores else 1.0


def side_by_side(tree: TreeLayout, carriers: Mapping[Pair, frozenset[int]]) -> float:
    """Our R_stack in [0, 1]: share of the children that could not as well hang on what carries their parent.

    Shafts one in another (the hands of a clock) turn about one line and past each other, so that both trees move
    alike; each is driven from the body, on its own.
    """
    above: dict[int, frozenset[int]] = {tree.order[0]: frozenset()}
    stacked = []
    for child in tree.order[1:]:
        parent = int(tree.parents[child])
        above[child] = above[parent] | {parent}
        stacked.append(not above[parent].isdisjoint(carriers.get(pair(parent, child), ())))
    return 1.0 - float(np.mean(stacked))


def log_hierarchy(tree: TreeLayout, hulls: FloatArray) -> float:
    """Our R_hier in (0, 1]: ``1 / (1 + mean max(0, log h_v / h_u))`` with hull volumes.

    The paper's sum over edges lets one large torso on a small pelvis outweigh all else.
    """
    logs = np.log(hulls)
    growth = logs[tree.children] - logs[tree.parents[tree.children]]
    return float(1 / (1 + np.maximum(growth, 0).mean()))


class TreeReward:
    """The reward of one assembly: weighted sum of the terms, normalised to [0, 1].

    `paper.trees.PaperReward` has the terms and weights of the paper instead.
    """

    searches_all_contacts = False
    """Whether a search tries every contact, or only the spanning tree and what could compete with it."""

    def __init__(
        self,
        graph: ContactGraph,
        stats: Sequence[PartStats],
        evidence: TreeEvidence,
        config: TopologyConfig,
        simulated: SimulatedEdges | None = None,
    ) -> None:
        """Measure what all trees share.

        Args:
            graph: Contacts and clusters.
            stats: Size and place of every part.
            evidence: Of the contact edges.
            config: Weights of the terms.
            simulated: What a simulation had against edges, if there was one; adds R_sim and weakens these edges.

        Raises:
            InputError: There are fewer than two parts, or not one measurement of each.
        """
        if graph.n_parts < 2 or len(stats) != graph.n_parts:
            raise InputError(
                f"The topology search was given {graph.n_parts} parts in the contact graph and measurements of "
                f"{len(stats)}; it needs two or more parts and one measurement of each."
            )
        self.graph = graph
        self.stats = stats
        self.evidence = evidence
        self.simulated = simulated
        self.config = config
        self.centroids = np.array([item.centroid for item in stats])
        self.hulls = np.array([item.hull_volume for item in stats])
        corners = np.array([item.bounds for item in stats])
        self.diagonal = float(np.linalg.norm(corners[:, 1].max(axis=0) - corners[:, 0].min(axis=0)))
        self.quality = self.edge_quality()
        if simulated is not None:
            self.quality = {edge: value * simulated.of_pair(edge) for edge, value in self.quality.items()}
        self.edge_weights = np.zeros((graph.n_parts, graph.n_parts))
        for (a, b), value in self.quality.items():
            self.edge_weights[a, b] = self.edge_weights[b, a] = value

    def edge_quality(self) -> dict[Pair, float]:
        """Weight of every contact edge in [0, 1], before what a simulation had against it; 0 without evidence."""
        return {pair: self.evidence.quality.get(pair, 0.0) for pair in self.graph.by_pair}

    @cached_property
    def likely(self) -> dict[Pair, float]:
        """Probability of every contact edge to be in the tree, whatever its root."""
        if not self.quality:
            return {}
        scores = scores_of(np.array(list(self.quality.values())))
        probabilities, _ = edge_probabilities(list(self.quality), scores, self.graph.n_parts)
        return dict(zip(self.quality, probabilities.tolist(), strict=True))

    def terms(self, parents: Sequence[int]) -> dict[str, float]:
        """Value of every term in [0, 1] of the tree with these parents, -1 for the root."""
        tree = layout_tree(parents)
        found = {"contact": mean_over_edges(tree, self.edge_weights), **self.own_terms(tree)}
        return found if self.simulated is None else {**found, "sim": self._survived(tree)}

    def own_terms(self, tree: TreeLayout) -> dict[str, float]:
        """The terms in which this reward differs from other ones."""
        return {
            "sym": corresponding_symmetry(tree, self.graph.clusters, self.graph.alike.kind),
            "hier": log_hierarchy(tree, self.hulls),
            "stack": side_by_side(tree, self.evidence.carriers),
        }

    def _survived(self, tree: TreeLayout) -> float:
        """``R_sim``: mean survival of the edges in simulation, in [0, 1]."""
        known = {} if self.simulated is None else self.simulated.survival
        children = tree.children.tolist()
        return float(np.mean([known.get((int(tree.parents[child]), child), 1.0) for child in children]))

    def term_weights(self) -> dict[str, float]:
        """Weight of every term but R_sim."""
        return self.config.weights.model_dump()

    def total(self, terms: Mapping[str, float]) -> float:
        """Weighted mean of the terms, in [0, 1]."""
        weights = {name: value for name, value in self.term_weights().items() if name in terms}
        if self.simulated is not None:
            weights["sim"] = self.simulated.weight
        return float(sum(weights[name] * value for name, value in terms.items()) / sum(weights.values()))

    def of(self, parents: Sequence[int]) -> float:
        """Reward of the tree with these parents, -1 for the root."""
        return self.total(self.terms(parents))

    def gain(self, parent: int, child: int) -> float:
        """Immediate score of an action: the growth of the reward (times n)."""
        growth = max(float(np.log(self.hulls[child] / self.hulls[parent])), 0.0)
        return self.config.weights.contact * float(self.edge_weights[parent, child]) - self.config.weights.hier * growth


def equal_depth(tree: TreeLayout, cluster: Sequence[int]) -> float:
    """``1 / (1 + Var(d(i): i in C_k))``: 1 where all parts of a cluster are equally deep in the tree."""
    return float(1 / (1 + np.var(tree.depth[list(cluster)])))


def _parent_kinds(parents: Sequence[int], kind: IntArray) -> int:
    """Number of different clusters or lone parts among the parents, one more where twins carry unequal numbers."""
    present = [parent for parent in parents if parent >= 0]
    counts = {present.count(parent) for parent in present}
    return max(len(set(kind[present].tolist())) + (len(counts) > 1), 1)
