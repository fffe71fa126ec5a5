"""From edge weights and base links to ranked kinematic trees (paper III-C)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

from kinematify.contact.graph import pair
from kinematify.topology.base import rank_bases
from kinematify.topology.mcts import SearchProblem, TreeSearch
from kinematify.topology.spanning import breadth_first_tree, parents_from, spanning_edges, tree_path
from kinematify.topology.tree import KinematicTree
from kinematify.topology.virtual import virtual_costs

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from kinematify.config import TopologyConfig
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.topology.base import BaseCandidate
    from kinematify.topology.mcts import Parents
    from kinematify.topology.reward import TreeReward


def search_trees(
    reward: TreeReward, bases: Sequence[BaseCandidate], *, seed: int, warm: Sequence[KinematicTree] = ()
) -> tuple[KinematicTree, ...]:
    """Find the best kinematic trees of an assembly.

    Args:
        reward: Of its trees; its configuration has the mode and the budget.
        bases: Base links to try.
        seed: Seed of the search; it only breaks ties.
        warm: Trees to begin with, beside the spanning tree of each base; the search never returns less.

    Returns:
        At most `config.keep` distinct trees, highest reward first.
    """
    keep = reward.config.keep
    found: dict[Parents, tuple[float, dict[str, float]]] = {}
    for candidate in bases:
        known = [tree.parents for tree in warm if tree.root == candidate.part]
        seen = _trees_of_base(reward, candidate, len(bases), seed=seed, known=known)
        best = sorted(seen, key=lambda parents: -seen[parents])[:keep]
        found |= {parents: (seen[parents], reward.terms(parents, candidate.score)) for parents in best}
    ranked = sorted(found, key=lambda parents: (-found[parents][0], parents))[:keep]
    return tuple(_finish(reward, parents, *found[parents]) for parents in ranked)


def plausible_bases(reward: TreeReward) -> tuple[BaseCandidate, ...]:
    """Base links worth a search, best first: those whose score is near the best."""
    config = reward.config
    edges = spanning_edges(reward.quality, reward.centroids)
    ranked = rank_bases(edges, reward.stats, reward.graph.clusters, reward.evidence, config.base)
    near = [item for item in ranked if item.score >= ranked[0].score - config.base_margin]
    return tuple(near[: config.max_bases])


@dataclass(frozen=True, kw_only=True)
class OpenEdges:
    """Which edges a search may use: the spanning tree, and what could replace a part of it."""

    usable: frozenset[Pair]
    certain: frozenset[Pair]
    """Edges of the spanning tree that nothing could replace."""


def open_edges(weights: Mapping[Pair, float], tree: Sequence[Pair], n: int, config: TopologyConfig) -> OpenEdges:
    """Find the ambiguous part of a graph.

    An edge outside the maximum spanning tree is open when its weight reaches `competitive_ratio` of the weakest tree
    edge on the cycle that it closes; the tree edges it could replace are open with it. At most `max_open_edges` of
    those that come closest are kept.
    """
    closeness: list[tuple[float, Pair, list[Pair]]] = []
    for edge in sorted(set(weights) - set(tree)):
        path = [step for step in tree_path(tree, n, edge) if step in weights]
        rivals = [step for step in path if weights[edge] >= config.competitive_ratio * weights[step]]
        if rivals:
            weakest = min(weights[step] for step in rivals)
            closeness.append((weights[edge] / max(weakest, 1e-12), edge, rivals))
    closeness.sort(key=lambda item: -item[0])
    kept = closeness[: config.max_open_edges]
    contested = {step for _, _, rivals in kept for step in rivals}
    return OpenEdges(
        usable=frozenset(tree) | {edge for _, edge, _ in kept}, certain=frozenset(tree) - frozenset(contested)
    )


def _trees_of_base(
    reward: TreeReward,
    candidate: BaseCandidate,
    n_bases: int,
    *,
    seed: int,
    known: Sequence[Parents],
) -> dict[Parents, float]:
    """Reward of every complete tree seen for one base link under the configured mode."""
    config, graph = reward.config, reward.graph
    edges = spanning_edges(reward.quality, reward.centroids)

    def judge(parents: Parents) -> float:
        return reward.total(reward.terms(parents, candidate.score))

    oriented = tuple(parents_from(edges, graph.n_parts, candidate.part))
    if config.mode == "mst":
        return {oriented: judge(oriented)}
    if config.mode == "bfs":
        breadth_first = breadth_first_tree(graph, candidate.part, reward.centroids)
        return {breadth_first: judge(breadth_first)}
    problem = _search_problem(reward, edges, candidate.part, judge)
    warm = oriented
    if reward.searches_all_contacts or problem.forbidden:
        warm = breadth_first_tree(graph, candidate.part, reward.centroids, problem.forbidden)
    search = TreeSearch(
        problem, exploration=config.exploration, normalise=config.normalise_returns, seed=seed, warm=[warm, *known]
    )
    search.run(max(config.iterations // n_bases, 1))
    return search.rewards


def _search_problem(
    reward: TreeReward,
    edges: Sequence[Pair],
    root: int,
    judge: Callable[[Parents], float],
) -> SearchProblem:
    graph, config = reward.graph, reward.config
    if reward.searches_all_contacts:
        usable = OpenEdges(usable=frozenset(touching_pairs(graph)), certain=frozenset())
    else:
        usable = open_edges(reward.quality, edges, graph.n_parts, config)
    neighbours: list[list[int]] = [[] for _ in range(graph.n_parts)]
    for a, b in sorted(usable.usable):
        neighbours[a].append(b)
        neighbours[b].append(a)
    forbidden = frozenset(_cluster_pairs(graph)) if config.cluster_edges == "forbid" else frozenset()
    return SearchProblem(
        root=root,
        neighbours=neighbours,
        gains={(u, v): reward.gain(u, v) for u, items in enumerate(neighbours) for v in items},
        reward=judge,
        virtual_costs=virtual_costs(
            reward.centroids, limit=config.virtual_distance * reward.diagonal, forbidden=forbidden
        ),
        forbidden=forbidden,
        certain=usable.certain,
    )


def touching_pairs(graph: ContactGraph) -> Iterator[Pair]:
    """Pairs of parts that touch; bridges are left out."""
    return ((edge.a, edge.b) for edge in graph.edges if not edge.bridge)


def _cluster_pairs(graph: ContactGraph) -> Iterator[Pair]:
    for cluster in graph.clusters:
        yield from combinations(sorted(cluster), 2)


def _finish(reward: TreeReward, parents: Parents, total: float, terms: Mapping[str, float]) -> KinematicTree:
    used = {pair(parent, child) for child, parent in enumerate(parents) if parent >= 0}
    touching = set(touching_pairs(reward.graph))
    return KinematicTree(
        parents=parents,
        broken=frozenset(touching - used),
        virtual=frozenset(used - touching),
        reward=total,
        terms=terms,
        likely={edge: reward.likely[edge] for edge in sorted(used) if edge in reward.likely},
    )
