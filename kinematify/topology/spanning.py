"""Trees without a search: the paper's breadth-first orientation, and the exact maximum spanning tree."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.topology.quality import maximum_spanning_edges, parents_from
from kinematify.topology.virtual import nearest_pair, virtual_costs

if TYPE_CHECKING:
    from collections.abc import Mapping
    from collections.abc import Set as AbstractSet

    from kinematify.contact.graph import ContactGraph
    from kinematify.robot.arrays import FloatArray
    from kinematify.topology.evidence import Pair


def breadth_first_tree(
    graph: ContactGraph, root: int, centroids: FloatArray, forbidden: AbstractSet[Pair] = frozenset()
) -> tuple[int, ...]:
    """Orient the contact graph breadth first from a root (paper III-C, warm start).

    Neighbours are visited by distance of their centroids, so that the order of the parts does not matter. What no
    contact reaches is attached to its nearest part by a virtual edge.

    Args:
        graph: Contacts; bridges are left out.
        root: The base link.
        centroids: Part centroids [m], shape (n, 3).
        forbidden: Pairs that must not be joined.

    Returns:
        Parent of every part, -1 for the root.
    """
    contacts: list[list[int]] = [[] for _ in range(graph.n_parts)]
    for edge in graph.edges:
        if not edge.bridge and (edge.a, edge.b) not in forbidden:
            contacts[edge.a].append(edge.b)
            contacts[edge.b].append(edge.a)
    parents = [-1] * graph.n_parts
    visited = [part == root for part in range(graph.n_parts)]
    queue = [root]
    costs = virtual_costs(centroids, forbidden=forbidden)
    while True:
        _spread(queue, contacts, centroids, visited, parents)
        if all(visited):
            return tuple(parents)
        parent, child = nearest_pair(costs, visited)
        parents[child], visited[child] = parent, True
        queue = [child]


def spanning_tree(weights: Mapping[Pair, float], centroids: FloatArray, root: int) -> tuple[int, ...]:
    """Orient the exact maximum spanning tree away from a root.

    Args:
        weights: Weight of every usable edge (a, b), a < b, in [0, 1].
        centroids: Part centroids [m], shape (n, 3); components are joined where they are nearest.
        root: The base link.

    Returns:
        Parent of every part, -1 for the root.
    """
    return tuple(parents_from(spanning_edges(weights, centroids), len(centroids), root))


def spanning_edges(weights: Mapping[Pair, float], centroids: FloatArray) -> tuple[Pair, ...]:
    """Edges of the exact maximum spanning tree; components are joined by virtual edges between nearest centroids."""
    n = len(centroids)
    edges = list(maximum_spanning_edges(weights, n))
    while len(edges) < n - 1:
        reached = [part == 0 or parent >= 0 for part, parent in enumerate(parents_from(edges, n, 0))]
        a, b = nearest_pair(virtual_costs(centroids), reached)
        edges.append((min(a, b), max(a, b)))
    return tuple(sorted(edges))


def _spread(
    queue: list[int], contacts: list[list[int]], centroids: FloatArray, visited: list[bool], parents: list[int]
) -> None:
    for node in queue:
        reach = np.linalg.norm(centroids[contacts[node]] - centroids[node], axis=1) if contacts[node] else []
        for index in np.argsort(reach, kind="stable"):
            other = contacts[node][int(index)]
            if not visited[other]:
                visited[other], parents[other] = True, node
                queue.append(other)
