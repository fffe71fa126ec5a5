"""Distances between two rooted trees over the same parts (paper IV-A, tree edit distance).

A tree is a mapping from node to parent, -1 for the root; an empty mapping is the empty tree. Node labels are the
nodes themselves: the identity of the part.

The paper leaves labels and sibling order open. Here trees are unordered, because the order of a link's children means
nothing, and insertion, deletion and relabelling cost 1. The unordered distance is NP-hard in general. Branch and bound
finds it for the sizes that occur; when its budget ends, the value is an upper bound and says so.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from kinematify.robot.arrays import BoolArray, IntArray

    Tree = Mapping[int, int]

STEP_BUDGET = 20_000
"""Branch-and-bound steps before the best value so far is taken: about a second for 20 parts."""
MAX_EXACT_NODES = 48
"""In larger trees a part is matched with itself alone: a table of all pairs would not fit the memory."""


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
    search = _MappingSearch(truth, predicted, labelled=labelled)
    if not labelled:  # parts that keep their identity are legal here too, and a good start
        same = _MappingSearch(truth, predicted, labelled=True)
        same.run()
        search.best_gain = 2 * same.best_size
    search.run()
    return TreeDistance(value=search.total - search.best_gain, exact=search.finished)


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


def _canonical(tree: Tree, labelled: bool) -> object:
    """Equal for equal trees: the mapping itself, or nested sorted shapes."""
    if labelled:
        return dict(tree)

    def shape(node: int) -> str:
        return f"({''.join(sorted(shape(child) for child, parent in tree.items() if parent == node))})"

    return shape(-1)


class _MappingSearch:
    """Branch and bound over edit mappings; a mapping's gain is what it saves against deleting and inserting all.

    A pair saves 2, or 1 where it relabels. Sets of pairs are bit masks; a mapping is legal if its pairs are compatible
    two by two: one to one, and the first node is an ancestor of the other in both trees or in none.
    """

    def __init__(self, first: Tree, second: Tree, *, labelled: bool) -> None:
        self.total = len(first) + len(second)
        self.labelled = labelled
        nodes = np.array(sorted(first), dtype=int), np.array(sorted(second), dtype=int)
        same = nodes[0][:, None] == nodes[1]
        self.whole = max(map(len, nodes)) <= MAX_EXACT_NODES
        rows, columns = np.nonzero(same | self.whole)
        above = _relations(first, nodes[0])[np.ix_(rows, rows)], _relations(second, nodes[1])[np.ix_(columns, columns)]
        beside = (above[0] == above[1]) & (above[0].T == above[1].T)
        beside &= (rows[:, None] != rows) & (columns[:, None] != columns)
        self.compatible = [_mask(row) for row in beside]
        self.row_masks = [_mask(rows == row) for row in range(len(first))]
        self.column_masks = [_mask(columns == column) for column in range(len(second))]
        saves_all = _mask(same[rows, columns] | (not labelled))
        self.full_gain = [mask & saves_all for mask in self.row_masks]
        self.order = self._hardest_last()
        self.steps = STEP_BUDGET
        self.best_gain = 0
        self.best_size = 0

    @property
    def finished(self) -> bool:
        return self.whole and self.steps > 0

    def run(self) -> None:
        """Look for a larger gain than `best_gain`."""
        self._extend(0, (1 << len(self.compatible)) - 1, 0, 0)

    def _extend(self, depth: int, allowed: int, gain: int, size: int) -> None:
        if gain > self.best_gain:
            self.best_gain, self.best_size = gain, size
        if self.steps <= 0 or gain + self._gain_bound(depth, allowed) <= self.best_gain:
            return
        self.steps -= 1
        row = self.order[depth]
        full = self.full_gain[row] & allowed
        for worth, mask in ((2, full), (1, self.row_masks[row] & allowed & ~full)):
            for pair in _bits(mask):
                self._extend(depth + 1, allowed & self.compatible[pair], gain + worth, size + 1)
        self._extend(depth + 1, allowed, gain, size)

    def _gain_bound(self, depth: int, allowed: int) -> int:
        """At most what the rows left can still save: each at its best pair, no more rows than columns are left."""
        left = self.order[depth:]
        open_rows = sum(bool(allowed & self.row_masks[row]) for row in left)
        if not self.labelled:
            return 2 * min(open_rows, sum(bool(allowed & mask) for mask in self.column_masks))
        identities = [pair for row in left for pair in _bits(self.full_gain[row] & allowed)]
        return open_rows + len(identities) - self._conflicts(identities)

    def _conflicts(self, pairs: list[int]) -> int:
        """Disjoint pairs of parts of which at most one can keep its identity: each costs at least 1."""
        count = 0
        while pairs:
            pair = pairs.pop()
            rival = next((other for other in pairs if not self.compatible[pair] >> other & 1), None)
            if rival is not None:
                pairs.remove(rival)
                count += 1
        return count

    def _hardest_last(self) -> list[int]:
        """Rows whose identities agree with most others first, so that the bound grips early."""
        everything = reduce(or_, self.full_gain, 0)

        def agreement(row: int) -> int:
            pair = self.full_gain[row].bit_length() - 1
            return (self.compatible[pair] & everything).bit_count() if pair >= 0 else -1

        return sorted(range(len(self.row_masks)), key=agreement, reverse=True)


def _mask(flags: BoolArray) -> int:
    return int.from_bytes(np.packbits(flags, bitorder="little").tobytes(), "little")


def _bits(mask: int) -> Iterator[int]:
    """Numbers of the bits that are set, ascending."""
    while mask:
        yield (mask & -mask).bit_length() - 1
        mask &= mask - 1


def _relations(tree: Tree, nodes: IntArray) -> BoolArray:
    """Entry (a, b) is True where node a is a proper ancestor of node b."""
    place = {int(node): index for index, node in enumerate(nodes)}
    above = np.zeros((len(nodes), len(nodes)), dtype=bool)
    for node, number in place.items():
        parent = tree[node]
        while parent >= 0:
            above[place[parent], number] = True
            parent = tree[parent]
    return above
