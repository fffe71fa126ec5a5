"""The search against brute force, its warm start, its determinism and what it must never do."""

from __future__ import annotations

from itertools import combinations

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematify.config import TopologyConfig, load_config
from kinematify.contact.graph import ContactGraph, pair
from kinematify.errors import InputError
from kinematify.paper.trees import PaperReward
from kinematify.pipeline.stages import rank_trees
from kinematify.topology.reward import TreeReward
from kinematify.topology.search import parents_from
from tests.topology.topology_objects import edge, evidence_of, graph_of, random_assembly, stat

DEFAULT = load_config().topology
PAPER = load_config("paper").topology
# Without pruning and with a budget that exhausts seven parts.
EXACT = DEFAULT.model_copy(update={"competitive_ratio": 0.0, "max_open_edges": 1000, "iterations": 100_000})
EXACT_PAPER = PAPER.model_copy(update={"iterations": 100_000})
ATLAS = [graph for graph in nx.graph_atlas_g() if len(graph) >= 2 and nx.is_connected(graph)]
SMALL = [graph for graph in ATLAS if len(graph) <= 5]
LARGER = [graph for graph in ATLAS if len(graph) >= 6 and graph.number_of_edges() <= 9][::24]


def dress(shape: nx.Graph, seed: int, clusters: tuple[tuple[int, ...], ...]) -> tuple:
    """Random strengths, joints and sizes on a given graph."""
    rng = np.random.default_rng(seed)
    n = len(shape)
    graph = graph_of(n, {pair(*ends): float(rng.random()) for ends in sorted(shape.edges)}, clusters)
    stats = [stat(rng.random(3), float(rng.random()) + 0.1, float(rng.random())) for _ in range(n)]
    evidence = {(item.a, item.b): float(rng.random()) for item in graph.edges}
    return graph, stats, evidence_of(evidence)


def brute_force(graph: ContactGraph, reward: TreeReward, root: int, banned: set) -> float:
    """Best reward over all spanning trees."""
    n, best = graph.n_parts, -np.inf
    for chosen in combinations([key for key in graph.by_pair if key not in banned], n - 1):
        parents = parents_from(chosen, n, root)
        if parents.count(-1) == 1:
            best = max(best, reward.of(parents))
    return best


@pytest.mark.parametrize("shapes", [SMALL, LARGER], ids=["all_to_5", "some_of_6_and_7"])
def test_default_search_finds_the_optimum_over_all_trees(shapes: list[nx.Graph]) -> None:
    for number, shape in enumerate(shapes):
        n = len(shape)
        graph, stats, evidence = dress(shape, number, ((0, 1),) if n < 5 else ((0, 1), (2, 3, 4)))
        reward = TreeReward(graph, stats, evidence, EXACT)
        for root in range(0, n, 2):
            best = brute_force(graph, reward, root, set())
            found = rank_trees(graph, stats, evidence, EXACT, seed=0, base=root)[0]
            assert found.reward == pytest.approx(best, abs=1e-9), (shape.edges, root)


@pytest.mark.parametrize("shapes", [SMALL], ids=["all_to_5"])
def test_paper_search_finds_the_optimum_without_edges_inside_clusters(shapes: list[nx.Graph]) -> None:
    compared = 0
    for number, shape in enumerate(shapes):
        n = len(shape)
        graph, stats, evidence = dress(shape, number, ((0, n - 1),))
        banned = {(0, n - 1)}
        remaining = nx.Graph(shape)
        remaining.remove_edges_from(banned)
        if not nx.is_connected(remaining):
            continue
        reward = PaperReward(graph, stats, evidence, PAPER)
        for root in range(0, n, 2):
            best = brute_force(graph, reward, root, banned)
            found = rank_trees(graph, stats, evidence, EXACT_PAPER, seed=0, base=root)[0]
            assert found.reward == pytest.approx(best, abs=1e-9), (shape.edges, root)
            compared += 1
    assert compared > 20


@settings(max_examples=30)
@given(st.integers(2, 30), st.integers(0, 12), st.integers(0, 10_000))
def test_every_tree_spans_and_every_contact_is_used_or_broken(n: int, extra: int, seed: int) -> None:
    graph, stats, evidence = random_assembly(n, extra, seed, [(0, 1)])
    for config in (DEFAULT, PAPER):
        for tree in rank_trees(graph, stats, evidence, config, seed=seed):
            used = {pair(parent, child) for parent, child in tree.edges()}
            assert len(used) == n - 1
            assert tree.parents.count(-1) == 1
            assert tree.broken == set(graph.by_pair) - used
            assert tree.virtual == used - set(graph.by_pair)


def test_the_default_keeps_congruent_neighbours_of_an_arm() -> None:
    # A chain whose second and third link are congruent; the paper's ban cuts it, the default does not.
    graph = graph_of(4, {(0, 1): 0.5, (1, 2): 0.5, (2, 3): 0.5}, [(1, 2)])
    stats = [stat((0, 0, float(k)), 2.0 if k == 0 else 1.0) for k in range(4)]
    evidence = evidence_of(dict.fromkeys(graph.by_pair, 0.3))
    assert rank_trees(graph, stats, evidence, DEFAULT, seed=0, base=0)[0].parents == (-1, 0, 1, 2)
    assert rank_trees(graph, stats, evidence, PAPER, seed=0, base=0)[0].parents[2] != 1


@pytest.mark.parametrize(("mode", "config"), [("mcts", DEFAULT), ("mst", PAPER), ("bfs", PAPER)])
def test_parts_that_touch_nothing_are_joined_to_the_nearest(config: TopologyConfig, mode: str) -> None:
    graph = graph_of(4, {(0, 1): 0.5})
    stats = [stat((0, 0, 0), 9.0), stat((2, 0, 0), 4.0), stat((4, 0, 0), 2.0), stat((100, 0, 0))]
    tree = rank_trees(graph, stats, evidence_of({}), config.model_copy(update={"mode": mode}), seed=0, base=0)[0]
    assert tree.parents == (-1, 0, 1, 2)
    assert tree.virtual == {(1, 2), (2, 3)}


def test_a_bridge_is_used_and_reported_as_virtual() -> None:
    edges = (edge(0, 1), edge(0, 2, bridge=True))
    graph = ContactGraph(n_parts=3, edges=edges, clusters=(), tolerance=0.01)
    stats = [stat((0, 0, 0), 9.0), stat((2, 0, 0)), stat((3, 0, 0))]
    tree = rank_trees(graph, stats, evidence_of({}), DEFAULT, seed=0)[0]
    assert tree.parents == (-1, 0, 0)
    assert tree.virtual == {(0, 2)}
    assert tree.broken == frozenset()


def test_given_base_is_the_root() -> None:
    graph, stats, evidence = random_assembly(8, 3, 1)
    for config in (DEFAULT, PAPER):
        assert {tree.root for tree in rank_trees(graph, stats, evidence, config, seed=0, base=5)} == {5}


@pytest.mark.parametrize("base", [-1, 8])
def test_a_base_that_is_no_part_is_refused(base: int) -> None:
    graph, stats, evidence = random_assembly(8, 3, 1)
    with pytest.raises(InputError, match="numbered 0 to 7"):
        rank_trees(graph, stats, evidence, DEFAULT, seed=0, base=base)


def test_too_few_parts_or_measurements_are_refused() -> None:
    graph, stats, evidence = random_assembly(8, 3, 1)
    with pytest.raises(InputError, match="measurements of 7"):
        rank_trees(graph, stats[:-1], evidence, DEFAULT, seed=0)
