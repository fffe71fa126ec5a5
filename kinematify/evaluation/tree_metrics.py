"""Distances between two rooted trees over the same parts (paper IV-A, tree edit distance).

A tree is a mapping from node to parent, -1 for the root; an empty mapping is the empty tree. Node labels are the
nodes themselves: the identity of the part.

The paper leaves labels and sibling order open. Here trees are unordered, because the order of a link's children means
nothing, and insertion, deletion and relabelling cost 1. The unordered distance is NP-hard in general. Branch and bound
finds it for the sizes that occur; when its budget ends, the value is an upper bound and says so. It starts from
Zhang's constrained distance (disjoint subtrees map to disjoint subtrees), which an assignment problem per pair of
nodes solves exactly and which never lies below the unordered one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import linear_sum_assignment

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    Tree = Mapping[int, int]

STEP_BUDGET = 20_000
"""Branch-and-bound steps before the best value so far is taken: about a second for 20 parts."""
MAX_EXACT_NODES = 48
"""Larger trees keep the constrained distance: their table of compatible pairs would not fit the memory."""


@dataclass(frozen=True, kw_only=True)
class TreeDistance:
    """A tree edit distance."""

    value: int
    exact: bool
    """False where `value` is only an upper bound."""


def tree_edit_distance(truth: Tree, predicted: Tree, *, labelled: bool = True) -> TreeDistance:
    """Return the rooted, unordered edit distance under unit costs.

    Args:
        truth: Parent of every node, -1 for the root.
        predicted: The same for the other tree; its nodes may be a subset.
        labelled: A matched pair of different nodes costs 1. False: it costs nothing (ReArt's definition, which
            minimises an ordered distance over all sibling orders of both trees).
    """
    if _canonical(truth, labelled) == _canonical(predicted, labelled):
        return TreeDistance(value=0, exact=True)
    upper = constrained_edit_distance(truth, predicted, labelled=labelled)
    # Equally large trees that differ need one deletion with one insertion, or two relabellings.
    lower = 2 if set(truth) == set(predicted) else max(1, abs(len(truth) - len(predicted)))
    if upper <= lower:
        return TreeDistance(value=upper, exact=True)
    if max(len(truth), len(predicted)) > MAX_EXACT_NODES:
        return TreeDistance(value=upper, exact=False)
    search = _MappingSearch(truth, predicted, labelled=labelled)
    if not labelled:
        # Mapping parts to themselves is legal here too, and often better than any constrained mapping.
        identity = _MappingSearch(truth, predicted, labelled=True)
        identity.run(gain_floor=0)
        upper = min(upper, search.total - 2 * identity.best_size)
    gain = search.run(gain_floor=search.total - upper)
    return TreeDistance(value=search.total - gain, exact=search.finished)


def constrained_edit_distance(truth: Tree, predicted: Tree, *, labelled: bool = True) -> int:
    """Return Zhang's constrained unordered edit distance (Algorithmica 15, 1996) under unit costs."""
    if not truth or not predicted:
        return len(truth) + len(predicted)
    return _ConstrainedDistance(truth, predicted, labelled=labelled).between_trees()


def parent_errors(truth: Tree, predicted: Tree) -> int:
    """Return how many parts have another parent than in truth; a part missing from `predicted` is an error."""
    return sum(node not in predicted or predicted[node] != parent for node, parent in truth.items())


def root_of(tree: Tree) -> int | None:
    """Return the root, None for the empty tree."""
    return next((node for node, parent in tree.items() if parent < 0), None)


def without_nodes(tree: Tree, removed: Iterable[int]) -> dict[int, int]:
    """Return the tree with nodes deleted as an edit does: children go to the nearest remaining ancestor.

    Of the children of a deleted root, the one with the lowest number becomes the root.
    """
    gone = set(removed)

    def lift(node: int) -> int:
        while node >= 0 and node in gone:
            node = tree[node]
        return node

    kept = {node: lift(parent) for node, parent in tree.items() if node not in gone}
    roots = sorted(node for node, parent in kept.items() if parent < 0)
    kept.update(dict.fromkeys(roots[1:], roots[0] if roots else -1))
    return kept


def _children(tree: Tree) -> dict[int, list[int]]:
    lists: dict[int, list[int]] = {node: [] for node in tree}
    for node, parent in tree.items():
        if parent >= 0:
            lists[parent].append(node)
    return lists


def _post_order(tree: Tree) -> list[int]:
    children, order = _children(tree), []
    stack = [node for node, parent in tree.items() if parent < 0]
    while stack:
        node = stack.pop()
        order.append(node)
        stack.extend(children[node])
    return order[::-1]


def _canonical(tree: Tree, labelled: bool) -> object:
    """Equal for equal trees: the mapping itself, or nested sorted shapes."""
    if labelled:
        return dict(tree)
    children = _children(tree)
    shape: dict[int, str] = {}
    for node in _post_order(tree):
        shape[node] = "(" + "".join(sorted(shape[child] for child in children[node])) + ")"
    root = root_of(tree)
    return None if root is None else shape[root]


class _ConstrainedDistance:
    """Zhang's recursion, bottom-up over all pairs of nodes."""

    def __init__(self, first: Tree, second: Tree, *, labelled: bool) -> None:
        self.labelled = labelled
        self.children = (_children(first), _children(second))
        self.orders = (_post_order(first), _post_order(second))
        self.sizes = tuple(self._subtree_sizes(side) for side in (0, 1))
        self.tree: dict[tuple[int, int], int] = {}
        self.forest: dict[tuple[int, int], int] = {}

    def between_trees(self) -> int:
        for i in self.orders[0]:
            for j in self.orders[1]:
                self.forest[i, j] = self._between_forests(i, j)
                self.tree[i, j] = self._between_subtrees(i, j)
        return self.tree[self.orders[0][-1], self.orders[1][-1]]

    def _subtree_sizes(self, side: int) -> dict[int, int]:
        sizes: dict[int, int] = {}
        for node in self.orders[side]:
            sizes[node] = 1 + sum(sizes[child] for child in self.children[side][node])
        return sizes

    def _between_subtrees(self, i: int, j: int) -> int:
        relabel = int(self.labelled and i != j)
        return min([self.forest[i, j] + relabel, *self._through_one_child(i, j, self.tree)])

    def _between_forests(self, i: int, j: int) -> int:
        return min([self._assignment(i, j), *self._through_one_child(i, j, self.forest)])

    def _through_one_child(self, i: int, j: int, known: dict[tuple[int, int], int]) -> list[int]:
        """Everything of one side stands against a single child of the other side; the rest of that side is new."""
        inserted = [self.sizes[1][j] - self.sizes[1][k] + known[i, k] for k in self.children[1][j]]
        return inserted + [self.sizes[0][i] - self.sizes[0][k] + known[k, j] for k in self.children[0][i]]

    def _assignment(self, i: int, j: int) -> int:
        """Match the children's subtrees one to one; what is left over is deleted or inserted."""
        rows, columns = self.children[0][i], self.children[1][j]
        n, m = len(rows), len(columns)
        if not n or not m:
            return self.sizes[0][i] + self.sizes[1][j] - 2
        forbidden = self.sizes[0][i] + self.sizes[1][j] + 1
        cost = np.full((n + m, n + m), forbidden)
        cost[:n, :m] = [[self.tree[row, column] for column in columns] for row in rows]
        cost[range(n), range(m, m + n)] = [self.sizes[0][row] for row in rows]
        cost[range(n, n + m), range(m)] = [self.sizes[1][column] for column in columns]
        cost[n:, m:] = 0
        return int(cost[linear_sum_assignment(cost)].sum())


class _MappingSearch:
    """Branch and bound over edit mappings; a mapping's gain is what it saves against deleting and inserting all.

    A pair saves 2, or 1 where it relabels. Sets of pairs are bit masks; a mapping is legal if its pairs are compatible
    two by two: one to one, and the first node is an ancestor of the other in both trees or in none.
    """

    def __init__(self, first: Tree, second: Tree, *, labelled: bool) -> None:
        self.total = len(first) + len(second)
        self.labelled = labelled
        self.rows, self.columns = sorted(first), sorted(second)
        self.relations = (_relations(first, self.rows), _relations(second, self.columns))
        self.compatible = self._compatible_pairs()
        self.full_gain = self._full_gain_masks()
        width = len(self.columns)
        self.column_masks = [sum(1 << (row * width + k) for row in range(len(self.rows))) for k in range(width)]
        self.order = self._hardest_last()
        self.steps = STEP_BUDGET
        self.best_gain = 0
        self.best_size = 0

    @property
    def finished(self) -> bool:
        return self.steps > 0

    def run(self, *, gain_floor: int) -> int:
        """Return the largest gain above `gain_floor`, or `gain_floor` where nothing better was found."""
        self.best_gain = gain_floor
        self._extend(0, (1 << (len(self.rows) * len(self.columns))) - 1, 0, 0)
        return self.best_gain

    def _extend(self, depth: int, allowed: int, gain: int, size: int) -> None:
        if gain > self.best_gain:
            self.best_gain, self.best_size = gain, size
        if self.steps <= 0 or gain + self._gain_bound(depth, allowed) <= self.best_gain:
            return
        self.steps -= 1
        row = self.order[depth]
        for pair in self._pairs_of(row, allowed):
            worth = 2 if self.full_gain[row] >> pair & 1 else 1
            self._extend(depth + 1, allowed & self.compatible[pair], gain + worth, size + 1)
        self._extend(depth + 1, allowed, gain, size)

    def _gain_bound(self, depth: int, allowed: int) -> int:
        """At most what the rows left can still save: each at its best pair, no more rows than columns are left."""
        worths = []
        for row in self.order[depth:]:
            if allowed & self.full_gain[row]:
                worths.append(2)
            elif allowed & self._row_mask(row):
                worths.append(1)
        if not self.labelled:
            return 2 * min(len(worths), sum(bool(allowed & mask) for mask in self.column_masks))
        return sum(worths) - self._conflicts(depth, allowed)

    def _conflicts(self, depth: int, allowed: int) -> int:
        """Disjoint pairs of parts of which at most one can keep its identity: each costs at least 1."""
        count = 0
        identities = [self.full_gain[row] & allowed for row in self.order[depth:]]
        pairs = [mask.bit_length() - 1 for mask in identities if mask]
        while pairs:
            pair = pairs.pop()
            rival = next((other for other in pairs if not self.compatible[pair] >> other & 1), None)
            if rival is not None:
                pairs.remove(rival)
                count += 1
        return count

    def _row_mask(self, row: int) -> int:
        width = len(self.columns)
        return ((1 << width) - 1) << (row * width)

    def _pairs_of(self, row: int, allowed: int) -> list[int]:
        """Allowed pairs of a row, those that keep its identity first."""
        width = len(self.columns)
        pairs = [row * width + column for column in range(width) if allowed >> (row * width + column) & 1]
        return sorted(pairs, key=lambda pair: not self.full_gain[row] >> pair & 1)

    def _full_gain_masks(self) -> list[int]:
        width = len(self.columns)
        if not self.labelled:
            return [self._row_mask(row) for row in range(len(self.rows))]
        place = {node: column for column, node in enumerate(self.columns)}
        return [1 << (row * width + place[node]) if node in place else 0 for row, node in enumerate(self.rows)]

    def _compatible_pairs(self) -> list[int]:
        """Bit mask, per pair, of the pairs that may be beside it."""
        above_1, above_2 = self.relations
        masks = []
        for a in range(len(self.rows)):
            for b in range(len(self.columns)):
                same = (above_1[a][:, None] == above_2[b][None, :]) & (above_1[:, a][:, None] == above_2[:, b][None, :])
                same[a, :] = False
                same[:, b] = False
                masks.append(int.from_bytes(np.packbits(same.ravel(), bitorder="little").tobytes(), "little"))
        return masks

    def _hardest_last(self) -> list[int]:
        """Rows whose identities agree with most others first, so that the bound grips early."""
        everything = reduce(or_, self.full_gain, 0)

        def agreement(row: int) -> int:
            pair = self.full_gain[row].bit_length() - 1
            return (self.compatible[pair] & everything).bit_count() if pair >= 0 else -1

        return sorted(range(len(self.rows)), key=agreement, reverse=True)


def _relations(tree: Tree, nodes: list[int]) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    """Entry (a, b) is True where a is a proper ancestor of b."""
    place = {node: index for index, node in enumerate(nodes)}
    above = np.zeros((len(nodes), len(nodes)), dtype=bool)
    for node in nodes:
        parent = tree[node]
        while parent >= 0:
            above[place[parent], place[node]] = True
            parent = tree[parent]
    return above
