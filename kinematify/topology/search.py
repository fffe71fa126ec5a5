"""From edge weights and base links to ranked kinematic trees (paper III-C)."""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree

from kinematify.contact.graph import pair
from kinematify.contact.tree import KinematicTree
from kinematify.topology.edge_evidence import nearest_pair, virtual_costs

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from kinematify.config import TopologyConfig
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.robot.arrays import FloatArray
    from kinematify.topology.reward import TreeReward


def breadth_first_tree(
    graph: ContactGraph, root: int, centroids: FloatArray, forbidden: AbstractSet[Pair] = frozenset()
) -> tuple[int, ...]:
    """Orient the contact graph breadth first from a root (paper III-C, warm start).

    Neighbours are visited by distance of their centroids, so that the order of the parts does not matter. What no
    contact reaches is attached to its nearest part by a virtual edge.

    Args:
        graph: Contacts; bridges are omitted.
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
        for node in queue:  # which grows on the way
            reach = np.linalg.norm(centroids[contacts[node]] - centroids[node], axis=1) if contacts[node] else []
            for index in np.argsort(reach, kind="stable"):
                other = contacts[node][int(index)]
                if not visited[other]:
                    visited[other], parents[other] = True, node
                    queue.append(other)
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
        edges.append(pair(a, b))
    return tuple(sorted(edges))


def maximum_spanning_edges(weights: Mapping[Pair, float], n: int) -> tuple[Pair, ...]:
    """Exact maximum spanning forest, edges in ascending order."""
    if not weights:
        return ()
    rows, columns = np.array(list(weights)).T
    costs = 2.0 - np.array(list(weights.values()))  # positive: scipy reads a stored 0 as no edge
    forest = minimum_spanning_tree(csr_matrix((costs, (rows, columns)), shape=(n, n))).tocoo()
    return tuple(sorted(pair(int(a), int(b)) for a, b in zip(forest.row, forest.col, strict=True)))


def tree_path(edges: Sequence[Pair], n: int, ends: Pair) -> tuple[Pair, ...]:
    """Edges of a forest on the way between two parts, empty where they are not connected."""
    previous = parents_from(edges, n, ends[0])
    steps = []
    node = ends[1]
    while previous[node] >= 0:
        parent = previous[node]
        steps.append(pair(node, parent))
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


Action = tuple[int, int]
"""A directed edge (parent, child)."""
Parents = tuple[int, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class SearchProblem:
    """Problem of one search: a root, the edges that may be used, and how trees are judged."""

    root: int
    neighbours: Sequence[Sequence[int]]
    """Parts that each part may be joined to by a contact or bridge."""
    gains: Mapping[Action, float]
    """Immediate score of every possible action."""
    reward: Callable[[Parents], float]
    """Reward of a complete tree in [0, 1]."""
    virtual_costs: FloatArray
    """Cost of a virtual edge between every two parts, shape (n, n)."""
    forbidden: frozenset[Pair] = frozenset()
    """Pairs inside a cluster that must not be joined (paper mode)."""
    certain: frozenset[Pair] = frozenset()
    """Edges without a competitor: they are taken as soon as they are reached, without branching."""
    bits: dict[Action, int] = field(default_factory=dict)
    """Number of every action met so far; a set of actions is the sum of their bits."""

    @property
    def n(self) -> int:
        """Number of parts."""
        return len(self.neighbours)


class SearchState:
    """``S = (T_S, V_S)``: partial tree and visited parts; ``B_S``, the broken edges, follows from both."""

    def __init__(self, problem: SearchProblem) -> None:
        """Start with the root alone and all certain edges that it reaches."""
        self.problem = problem
        self.parents = [-1] * problem.n
        self.visited = [False] * problem.n
        self.n_visited = 0
        self.key = 0
        self._visit(problem.root, -1)

    @property
    def complete(self) -> bool:
        """True if every part is in the tree."""
        return self.n_visited == self.problem.n

    def apply(self, action: Action) -> list[int]:
        """Add the edge u -> v, and follow certain edges beyond v.

        Returns:
            The parts that became visited.
        """
        self.key |= 1 << self.problem.bits.setdefault(action, len(self.problem.bits))
        return self._visit(action[1], action[0])

    def actions(self) -> list[Action]:
        """Feasible oriented edges from V_S to the rest; virtual ones where no contact leads further."""
        found = [action for part in range(self.problem.n) if self.visited[part] for action in self.frontier_of(part)]
        return found or ([] if self.complete else [nearest_pair(self.problem.virtual_costs, self.visited)])

    def frontier_of(self, part: int) -> Iterator[Action]:
        """Feasible actions that leave one visited part."""
        for other in self.problem.neighbours[part]:
            if not self.visited[other] and pair(part, other) not in self.problem.forbidden:
                yield part, other

    def _visit(self, start: int, parent: int) -> list[int]:
        stack = [(start, parent)]
        reached = []
        while stack:
            node, above = stack.pop()
            reached.append(node)
            self.parents[node] = above
            self.visited[node] = True
            self.n_visited += 1
            stack.extend(
                (other, node)
                for other in self.problem.neighbours[node]
                if not self.visited[other] and pair(node, other) in self.problem.certain
            )
        return reached


@dataclass
class _Node:
    """Statistics of one set of edges."""

    untried: list[Action]
    """Actions not yet taken, best immediate score last."""
    tried: list[tuple[Action, int]] = field(default_factory=list)
    """Actions taken and the key of the state that each leads to."""
    visits: int = 0
    total: float = 0.0
    closed: bool = False
    """Every completion has been seen."""


class TreeSearch:
    """Monte Carlo tree search from one root (paper III-C: state, actions, transition, UCT, greedy rollouts).

    A state is a partial tree that grows from the root; an action adds one edge. Many orders of actions reach the same
    partial tree, so statistics are kept per set of edges, and a set whose completions have all been seen is closed: a
    small problem is solved exactly. `rewards` holds every complete tree that was seen.
    """

    def __init__(
        self, problem: SearchProblem, *, exploration: float, normalise: bool, seed: int, warm: Sequence[Parents] = ()
    ) -> None:
        """Evaluate the warm start, so that the search can never return less.

        Args:
            problem: Root, edges and reward.
            exploration: ``C`` of UCT.
            normalise: Stretch returns between the worst and the best seen before UCT compares them.
            seed: Breaks ties between actions of equal immediate score.
            warm: Complete trees to begin with.
        """
        self.problem = problem
        self.exploration = exploration
        self.normalise = normalise
        self.rewards: dict[Parents, float] = {}
        self.nodes: dict[int, _Node] = {}
        noise = np.random.default_rng(seed).random(len(problem.gains)) * 1e-9
        ordered = sorted(problem.gains)
        self.priority = {action: problem.gains[action] + float(tie) for action, tie in zip(ordered, noise, strict=True)}
        for parents in warm:
            self._judge(parents)

    def run(self, iterations: int) -> None:
        """Simulate until the budget is spent or every tree has been seen."""
        for _ in range(iterations):
            state = SearchState(self.problem)
            root = self._node(state)
            if root.closed:
                break
            path = self._descend(state, root)
            rollout(state, self.priority)
            self._back_up(path, self._judge(tuple(state.parents)))

    def _descend(self, state: SearchState, root: _Node) -> list[_Node]:
        """Follow UCT to a node with an untried action and take it; return the nodes on the way."""
        path = [root]
        while not state.complete:
            node = path[-1]
            if node.untried:
                action = node.untried.pop()
                state.apply(action)
                node.tried.append((action, state.key))
                path.append(self._node(state))
                break
            opened = [(action, self.nodes[key]) for action, key in node.tried if not self.nodes[key].closed]
            if not opened:  # the last open child was closed through another order of the same actions
                break
            state.apply(self._select(node, opened))
            path.append(self._node(state))
        return path

    def _select(self, node: _Node, opened: Sequence[tuple[Action, _Node]]) -> Action:
        """``argmax Q/N + C sqrt(ln N_parent / N)`` over the children that are still open."""
        low, high = min(self.rewards.values()), max(self.rewards.values())
        span = high - low if self.normalise and high > low else 1.0
        offset = low if self.normalise else 0.0

        def bound(child: _Node) -> float:
            mean = (child.total / child.visits - offset) / span
            return float(mean + self.exploration * np.sqrt(np.log(node.visits) / child.visits))

        return max(opened, key=lambda item: (bound(item[1]), self.priority.get(item[0], 0.0)))[0]

    def _node(self, state: SearchState) -> _Node:
        node = self.nodes.get(state.key)
        if node is None:
            actions = sorted(state.actions(), key=lambda action: self.priority.get(action, 0.0))
            node = self.nodes[state.key] = _Node(untried=actions, closed=state.complete)
        return node

    def _back_up(self, path: list[_Node], value: float) -> None:
        for node in reversed(path):
            node.visits += 1
            node.total += value
            node.closed |= not node.untried and all(self.nodes[key].closed for _, key in node.tried)

    def _judge(self, parents: Parents) -> float:
        if parents not in self.rewards:
            self.rewards[parents] = self.problem.reward(parents)
        return self.rewards[parents]


def rollout(state: SearchState, priority: Mapping[Action, float]) -> None:
    """Complete a tree greedily: always the available action with the highest immediate score (in place)."""
    heap = [(-priority[action], action) for action in state.actions() if action in priority]
    heapq.heapify(heap)
    while not state.complete:
        while heap and state.visited[heap[0][1][1]]:
            heapq.heappop(heap)
        action = heapq.heappop(heap)[1] if heap else state.actions()[0]
        for part in state.apply(action):
            for further in state.frontier_of(part):
                heapq.heappush(heap, (-priority[further], further))


def search_trees(
    reward: TreeReward, base: int, *, seed: int, warm: Sequence[KinematicTree] = ()
) -> tuple[KinematicTree, ...]:
    """Find the best kinematic trees of an assembly.

    Args:
        reward: Of its trees; its configuration has the mode and the budget.
        base: The base link.
        seed: Seed of the search; it only breaks ties.
        warm: Trees to begin with, beside the spanning tree; the search never returns less.

    Returns:
        At most `config.keep` distinct trees, highest reward first.
    """
    seen = _judged_trees(reward, base, seed=seed, known=[tree.parents for tree in warm if tree.root == base])
    ranked = sorted(seen, key=lambda parents: (-seen[parents], parents))
    return tuple(finish_tree(reward, parents) for parents in ranked[: reward.config.keep])


def open_edges(
    weights: Mapping[Pair, float], tree: Sequence[Pair], n: int, config: TopologyConfig
) -> tuple[frozenset[Pair], frozenset[Pair]]:
    """Find the edges that a search may use, and those of the spanning tree that nothing could replace.

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
    return frozenset(tree) | {edge for _, edge, _ in kept}, frozenset(tree) - frozenset(contested)


def _judged_trees(reward: TreeReward, base: int, *, seed: int, known: Sequence[Parents]) -> dict[Parents, float]:
    """Reward of every complete tree seen for a base link under the configured mode."""
    config, graph = reward.config, reward.graph
    edges = spanning_edges(reward.quality, reward.centroids)
    oriented = tuple(parents_from(edges, graph.n_parts, base))
    if config.mode == "mst":
        return {oriented: reward.of(oriented)}
    if config.mode == "bfs":
        breadth_first = breadth_first_tree(graph, base, reward.centroids)
        return {breadth_first: reward.of(breadth_first)}
    problem = _search_problem(reward, edges, base)
    warm = oriented
    if reward.searches_all_contacts or problem.forbidden:
        warm = breadth_first_tree(graph, base, reward.centroids, problem.forbidden)
    search = TreeSearch(
        problem, exploration=config.exploration, normalise=config.normalise_returns, seed=seed, warm=[warm, *known]
    )
    search.run(config.iterations)
    return search.rewards


def _search_problem(reward: TreeReward, edges: Sequence[Pair], root: int) -> SearchProblem:
    graph, config = reward.graph, reward.config
    certain: frozenset[Pair] = frozenset()
    if reward.searches_all_contacts:
        usable = frozenset(touching_pairs(graph))
    else:
        usable, certain = open_edges(reward.quality, edges, graph.n_parts, config)
    neighbours: list[list[int]] = [[] for _ in range(graph.n_parts)]
    for a, b in sorted(usable):
        neighbours[a].append(b)
        neighbours[b].append(a)
    clusters = graph.clusters if config.cluster_edges == "forbid" else ()
    forbidden = frozenset(ends for cluster in clusters for ends in combinations(cluster, 2))
    return SearchProblem(
        root=root,
        neighbours=neighbours,
        gains={(u, v): reward.gain(u, v) for u, items in enumerate(neighbours) for v in items},
        reward=reward.of,
        virtual_costs=virtual_costs(
            reward.centroids, limit=config.virtual_distance * reward.diagonal, forbidden=forbidden
        ),
        forbidden=forbidden,
        certain=certain,
    )


def touching_pairs(graph: ContactGraph) -> Iterator[Pair]:
    """Pairs of parts that touch; bridges are omitted."""
    return ((edge.a, edge.b) for edge in graph.edges if not edge.bridge)


def finish_tree(reward: TreeReward, parents: Parents) -> KinematicTree:
    """A tree with its reward, its terms, and what is known of its edges."""
    used = {pair(parent, child) for child, parent in enumerate(parents) if parent >= 0}
    touching = set(touching_pairs(reward.graph))
    return KinematicTree(
        parents=parents,
        broken=frozenset(touching - used),
        virtual=frozenset(used - touching),
        reward=reward.of(parents),
        terms=reward.terms(parents),
        likely={edge: reward.likely[edge] for edge in sorted(used) if edge in reward.likely},
    )
