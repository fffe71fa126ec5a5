"""Spanning trees without a search: the maximum one, and the paper's breadth-first orientation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree

from kinematify.topology.virtual import nearest_pair, virtual_costs

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.robot.arrays import FloatArray


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


def spanning_edges(weights: Mapping[Pair, float], centroids: FloatArray) -> tuple[Pair, ...]:
    """Edges of the exact maximum spanning tree; components are joined by virtual edges between nearest centroids."""
    n = len(centroids)
    edges = list(maximum_spanning_edges(weights, n))
    while len(edges) < n - 1:
        reached = [part == 0 or parent >= 0 for part, parent in enumerate(parents_from(edges, n, 0))]
        a, b = nearest_pair(virtual_costs(centroids), reached)
        edges.append((min(a, b), max(a, b)))
    return tuple(sorted(edges))


def maximum_spanning_edges(weights: Mapping[Pair, float], n: int) -> tuple[Pair, ...]:
    """Exact maximum spanning forest, edges in ascending order."""
    if not weights:
        return ()
    rows, columns = np.array(list(weights)).T
    costs = 2.0 - np.array(list(weights.values()))  # positive: scipy reads a stored 0 as no edge
    forest = minimum_spanning_tree(csr_matrix((costs, (rows, columns)), shape=(n, n))).tocoo()
    return tuple(sorted((int(min(a, b)), int(max(a, b))) for a, b in zip(forest.row, forest.col, strict=True)))


def tree_path(edges: Sequence[Pair], n: int, ends: Pair) -> tuple[Pair, ...]:
    """Edges of a forest on the way between two parts, empty where they are not connected."""
    previous = parents_from(edges, n, ends[0])
    steps = []
    node = ends[1]
    while previous[node] >= 0:
        parent = previous[node]
        steps.append((min(node, parent), max(node, parent)))
        node = parent
    return tuple(steps) if node == ends[0] else ()


def parents_from(edges: Sequence[Pair], n: int, root: int) -> list[int]:
    """Orient a forest away from `root`: parent of every part, -1 for the root and for what it does not reach."""
    if not edges:
        return [-1] * n
    rows, columns = np.array(edges).T
    matrix = csr_matrix((np.ones(len(edges)), (rows, columns)), shape=(n, n))
    _, previous = breadth_first_order(matrix, root, directed=False)
    return [max(int(item), -1) for item in previous]


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
