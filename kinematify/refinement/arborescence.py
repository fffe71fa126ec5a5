"""The best tree in which some parts have a parent that was given."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.contact.graph import pair
from kinematify.topology.search import finish_tree

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.contact.tree import KinematicTree
    from kinematify.topology.reward import TreeReward

_AS_BEFORE = 2.0
"""More than what any contact is worth."""
_NO_CONTACT = 100.0
"""What is taken off an edge between parts that may be far apart."""


def tree_with_parents(reward: TreeReward, before: KinematicTree, parents: Mapping[int, int]) -> KinematicTree:
    """The tree in which some parts have a given parent, and most others the one that they had.

    Of the trees that keep as many parents as possible, the maximum spanning arborescence (Edmonds 1967) has the best
    contacts.

    Args:
        reward: Of the trees of the assembly.
        before: The tree as it is; its root stays.
        parents: Parent of parts by index, neither the root nor in a circle.
    """
    # A third of a second to import, and only hints on parents need it.
    import networkx as nx  # noqa: PLC0415

    root, n = before.root, reward.graph.n_parts
    weights = dict.fromkeys([(root, child) for child in range(n)], -_NO_CONTACT)
    for (a, b), quality in reward.quality.items():
        weights[a, b] = weights[b, a] = quality
    for edge in before.edges():
        weights[edge] = max(weights.get(edge, 0.0), 0.0) + _AS_BEFORE
    for child, parent in parents.items():
        weights.setdefault((parent, child), 0.0)
    directed = nx.DiGraph()
    for (parent, child), weight in sorted(weights.items()):
        if child != root and parents.get(child, parent) == parent:
            directed.add_edge(parent, child, weight=weight)
    found = nx.maximum_spanning_arborescence(directed, attr="weight")
    above = {child: parent for parent, child in found.edges}
    chosen = tuple(above.get(part, -1) for part in range(n))
    tree = finish_tree(reward, chosen)
    given = {pair(parent, child) for child, parent in parents.items()}
    likely = {edge: value for edge, value in tree.likely.items() if edge not in given}
    return replace(tree, likely=likely, standing=before.standing)
