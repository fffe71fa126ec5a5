"""Base link and reward of trees as the paper prints them (III-C): highest degree, five terms, contact strength."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.topology.base_link import BaseCandidate
from kinematify.topology.reward import EPSILON, TreeReward, equal_depth

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.robot.arrays import FloatArray
    from kinematify.topology.reward import TreeLayout


class PaperReward(TreeReward):
    """The five terms of the paper over edges weighed by contact strength."""

    searches_all_contacts = True

    def edge_quality(self) -> dict[Pair, float]:
        """The paper's ``s(u, v)``; parts that a virtual edge joins do not touch and have none."""
        return {pair: 0.0 if edge.bridge else edge.strength for pair, edge in self.graph.by_pair.items()}

    @cached_property
    def likely(self) -> dict[Pair, float]:
        """Nothing: contact strength is no probability."""
        return {}

    def own_terms(self, tree: TreeLayout, base_score: float) -> dict[str, float]:
        """R_sym, halved into [0, 1], and R_hier."""
        return {
            "sym": 0.5 * symmetry(tree, self.graph.clusters),
            "hier": hierarchy(tree, self.volumes),
            "base": base_score,
        }

    def term_weights(self) -> dict[str, float]:
        """As configured; that of R_sym is doubled, since the term is halved."""
        weights = super().term_weights()
        return {**weights, "sym": 2 * weights["sym"]}

    def gain(self, parent: int, child: int) -> float:
        """Contact strength."""
        return float(self.edge_weights[parent, child])


def base_by_degree(graph: ContactGraph) -> tuple[BaseCandidate, ...]:
    """Rank parts as the paper does (III-C): highest undirected degree first, lowest index on a tie."""
    degree = [len(items) for items in graph.neighbours]
    top = max(*degree, 1)
    order = sorted(range(graph.n_parts), key=lambda part: (-degree[part], part))
    return tuple(
        BaseCandidate(part=part, score=degree[part] / top, reason=f"It touches {degree[part]} parts.") for part in order
    )


def symmetry(tree: TreeLayout, clusters: Sequence[Sequence[int]]) -> float:
    """``R_sym = mean_k S_k``, ``S_k = 1 / (1 + Var d) + [1 - (|P_k| - 1) / (|C_k| - 1 + eps)]``, in [0, 2].

    0 where there is no cluster, a constant of the assembly.
    """
    scores = []
    for cluster in clusters:
        parents = {int(tree.parents[part]) for part in cluster} - {-1}
        shared = 1 - (len(parents) - 1) / (len(cluster) - 1 + EPSILON)
        scores.append(equal_depth(tree, cluster) + shared)
    return float(np.mean(scores)) if scores else 0.0


def hierarchy(tree: TreeLayout, volumes: FloatArray) -> float:
    """``R_hier = 1 / (1 + sum max(0, v_v / (v_u + eps) - 1))`` over edges u -> v."""
    ratio = volumes[tree.children] / (volumes[tree.parents[tree.children]] + EPSILON * volumes.max())
    return float(1 / (1 + np.maximum(ratio - 1, 0).sum()))
