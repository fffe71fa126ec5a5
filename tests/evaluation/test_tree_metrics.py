"""Tree edit distances against brute force, and the laws of a distance."""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import strategies as st

from kinematify.evaluation.tree_metrics import (
    parent_errors,
    root_of,
    tree_edit_distance,
    without_nodes,
)


def all_trees(n: int) -> list[dict[int, int]]:
    """Every rooted labelled tree over 0..n-1."""
    trees = []
    for root in range(n):
        others = [node for node in range(n) if node != root]
        for choice in product(range(n), repeat=n - 1):
            tree = {root: -1, **dict(zip(others, choice, strict=True))}
            if all(reaches_root(tree, node) for node in tree):
                trees.append(tree)
    return trees


def reaches_root(tree: dict[int, int], node: int) -> bool:
    for _ in range(len(tree)):
        if node < 0:
            return True
        node = tree[node]
    return node < 0


def ancestors(tree: dict[int, int], node: int) -> set[int]:
    found = set()
    while tree[node] >= 0:
        node = tree[node]
        found.add(node)
    return found


def brute_force(first: dict[int, int], second: dict[int, int], *, labelled: bool) -> int:
    """Cheapest of all legal edit mappings, tried one by one."""
    above_1 = {node: ancestors(first, node) for node in first}
    above_2 = {node: ancestors(second, node) for node in second}

    def legal(pairs: list[tuple[int, int]], a: int, b: int) -> bool:
        return all(
            b != d and (a in above_1[c]) == (b in above_2[d]) and (c in above_1[a]) == (d in above_2[b])
            for c, d in pairs
        )

    def cheapest(nodes: list[int], pairs: list[tuple[int, int]], relabelled: int) -> int:
        if not nodes:
            return len(first) + len(second) - 2 * len(pairs) + relabelled
        a, *rest = nodes
        costs = [cheapest(rest, pairs, relabelled)]
        for b in second:
            if legal(pairs, a, b):
                costs.append(cheapest(rest, [*pairs, (a, b)], relabelled + (labelled and a != b)))
        return min(costs)

    return cheapest(list(first), [], 0)


def one_per_shape(n: int) -> list[dict[int, int]]:
    shapes: list[dict[int, int]] = []
    for tree in all_trees(n):
        if all(tree_edit_distance(tree, other, labelled=False).value for other in shapes):
            shapes.append(tree)
    return shapes


@pytest.mark.parametrize("n", [1, 3, 4])
@pytest.mark.parametrize("labelled", [True, False])
def test_distance_is_that_of_brute_force_on_all_small_trees(n: int, labelled: bool) -> None:
    for first in one_per_shape(n):
        for second in all_trees(n):
            distance = tree_edit_distance(first, second, labelled=labelled)
            assert distance.exact
            assert distance.value == brute_force(first, second, labelled=labelled), (first, second)


def test_distance_between_trees_of_different_size() -> None:
    for first in one_per_shape(4):
        for second in all_trees(3):
            for labelled in (True, False):
                expected = brute_force(first, second, labelled=labelled)
                assert tree_edit_distance(first, second, labelled=labelled).value == expected, (first, second)


def test_a_skipped_parent_costs_two() -> None:
    truth = {0: -1, 1: 0, 2: 0, 3: 0, 4: 0}
    grouped = {0: -1, 1: 4, 2: 4, 3: 0, 4: 0}
    assert tree_edit_distance(truth, grouped).value == 2


def test_empty_prediction_costs_every_node() -> None:
    truth = {0: -1, 1: 0, 2: 1}
    assert tree_edit_distance(truth, {}).value == 3
    assert tree_edit_distance({}, {}).value == 0
    assert parent_errors(truth, {}) == 3
    assert root_of({}) is None


def test_deleted_nodes_hand_their_children_up() -> None:
    tree = {0: -1, 1: 0, 2: 1, 3: 1}
    assert without_nodes(tree, [1]) == {0: -1, 2: 0, 3: 0}
    assert without_nodes(tree, [0, 1]) == {2: -1, 3: 2}
    assert without_nodes(tree, [0, 1, 2, 3]) == {}


def test_large_trees_keep_a_bound_and_say_so() -> None:
    n = 120
    truth = {node: node - 1 for node in range(n)}
    star = {0: -1, **dict.fromkeys(range(1, n), 0)}
    distance = tree_edit_distance(truth, star)
    assert not distance.exact
    assert distance.value >= n - 2


@st.composite
def trees(draw: st.DrawFn, n: int) -> dict[int, int]:
    order = draw(st.permutations(range(n)))
    tree = {order[0]: -1}
    for place in range(1, n):
        tree[order[place]] = order[draw(st.integers(0, place - 1))]
    return tree
