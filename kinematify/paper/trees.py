"""Base link and reward of trees as the paper prints them (III-C): highest degree, five terms, contact strength."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.topology.reward import EPSILON, TreeReward, equal_depth

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.robot.arrays import FloatArray
    from kinematify.topology.reward import TreeLayout


_MAD_TO_SIGMA = 1.4826
"""Median absolute deviation to standard deviation of a normal distribution."""


class PaperReward(TreeReward):
    """The five terms of the paper over edges weighed by contact strength."""

    searches_all_contacts = True

    @cached_property
    def volumes(self) -> FloatArray:
        """``v_i`` [m^3], shape (n,)."""
        return np.array([item.volume for item in self.stats])

    @cached_property
    def scale(self) -> float:
        """``sigma_tau`` [m^4]."""
        return torque_scale(self.centroids, self.volumes)

    def edge_quality(self) -> dict[Pair, float]:
        """The paper's ``s(u, v)``; parts that a virtual edge joins do not touch and have none."""
        return {pair: 0.0 if edge.bridge else edge.strength for pair, edge in self.graph.by_pair.items()}

    @cached_property
    def likely(self) -> dict[Pair, float]:
        """Nothing: contact strength is no probability."""
        return {}

    def own_terms(self, tree: TreeLayout) -> dict[str, float]:
        """R_struct, R_static, R_sym, halved into [0, 1], and R_hier."""
        return {
            "struct": structure(tree, self.config.preferred_degree),
            "static": static_support(tree, self.centroids, self.volumes, self.scale),
            "sym": 0.5 * symmetry(tree, self.graph.clusters),
            "hier": hierarchy(tree, self.volumes),
        }

    def term_weights(self) -> dict[str, float]:
        """As configured; that of R_sym is doubled, since the term is halved."""
        weights = super().term_weights()
        return {**weights, "sym": 2 * weights["sym"]}

    def gain(self, parent: int, child: int) -> float:
        """Contact strength."""
        return float(self.edge_weights[parent, child])


def base_by_degree(graph: ContactGraph) -> int:
    """The part with the highest undirected degree (III-C), lowest index on a tie."""
    return int(np.argmax([len(items) for items in graph.neighbours]))


def structure(tree: TreeLayout, preferred_degree: int) -> float:
    """``R_struct = 1 / (mean d^2 + mean (deg+ - k)^2)``; at most 1 for a whole number k and two or more parts."""
    out_degree = np.bincount(tree.parents[tree.children], minlength=len(tree.parents))
    return float(1 / (np.mean(tree.depth**2) + np.mean((out_degree - preferred_degree) ** 2)))


def static_support(tree: TreeLayout, centroids: FloatArray, volumes: FloatArray, scale: float) -> float:
    """``R_static = 1 / (1 + tau / sigma_tau)`` with ``tau = sum_i |(c_sub(i) - c_i) x M(i) g z-|`` over i != b.

    Density and gravity scale tau and sigma_tau alike and are omitted.

    Args:
        tree: The tree.
        centroids: ``c_i`` [m], shape (n, 3).
        volumes: ``v_i`` [m^3], shape (n,).
        scale: ``sigma_tau`` of `torque_scale` [m^4].
    """
    mass = volumes.copy()
    moment = volumes[:, None] * centroids
    for node in reversed(tree.order[1:]):
        parent = tree.parents[node]
        mass[parent] += mass[node]
        moment[parent] += moment[node]
    arm = moment - mass[:, None] * centroids
    torque = np.hypot(arm[:, 0], arm[:, 1])
    return float(1 / (1 + torque[tree.children].sum() / scale))


def torque_scale(centroids: FloatArray, volumes: FloatArray) -> float:
    """Robust normaliser ``sigma_tau`` [m^4] of an assembly, the same for all its trees.

    The paper names only "MAD scale". Here: 1.4826 x n x the median absolute deviation of the torque of each part
    about the common centre of mass, with a floor because few or equal parts have a deviation of zero.
    """
    centre = np.average(centroids, axis=0, weights=volumes)
    arms = np.hypot(*(centroids - centre)[:, :2].T) * volumes
    deviation = np.median(np.abs(arms - np.median(arms)))
    floor = 0.01 * volumes.sum() * max(float(np.ptp(centroids, axis=0).max()), EPSILON)
    return float(max(_MAD_TO_SIGMA * deviation * len(volumes), floor))


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
