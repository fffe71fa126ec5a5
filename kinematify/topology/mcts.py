"""Monte Carlo tree search over rooted spanning trees (paper III-C: state, actions, transition, UCT, greedy rollouts).

A state is a partial tree that grows from the base; an action adds one edge from a visited to an unvisited part. The
same partial tree is reached by many orders of actions, so statistics are kept per set of edges, and a set whose
completions have all been seen is closed: a small problem is solved exactly and the search then stops early.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.topology.virtual import nearest_pair

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from kinematify.contact.graph import Pair
    from kinematify.robot.arrays import FloatArray

Action = tuple[int, int]
"""A directed edge (parent, child)."""
Parents = tuple[int, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class SearchProblem:
    """What one search is about: a root, the edges that may be used, and how trees are judged."""

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
    """``S = (T_S, V_S, B_S)``: partial tree, visited parts, broken edges."""

    def __init__(self, problem: SearchProblem) -> None:
        """Start with the root alone and all certain edges that it reaches."""
        self.problem = problem
        self.parents = [-1] * problem.n
        self.visited = [False] * problem.n
        self.broken: set[Pair] = set()
        self.n_visited = 0
        self.key = 0
        self._visit(problem.root, -1)

    @property
    def complete(self) -> bool:
        """Whether every part is in the tree."""
        return self.n_visited == self.problem.n

    def apply(self, action: Action) -> list[int]:
        """Add the edge u -> v, record as broken what v would close, and follow certain edges beyond v.

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
            self.broken.update(
                pair(node, other) for other in self.problem.neighbours[node] if self.visited[other] and other != above
            )
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
    """One search from one root; `rewards` holds every complete tree that was seen."""

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
            if not node.untried and all(self.nodes[key].closed for _, key in node.tried):
                node.closed = True

    def _judge(self, parents: Parents) -> float:
        if parents not in self.rewards:
            self.rewards[parents] = self.problem.reward(parents)
        return self.rewards[parents]


def rollout(state: SearchState, priority: Mapping[Action, float]) -> None:
    """Complete a tree greedily: always the available action with the highest immediate score (in place)."""
    heap = [(-priority[action], action) for action in state.actions() if action in priority]
    heapq.heapify(heap)
    while not state.complete:
        action = _pop_feasible(heap, state)
        if action is None:
            action = state.actions()[0]
        for part in state.apply(action):
            for further in state.frontier_of(part):
                heapq.heappush(heap, (-priority[further], further))


def _pop_feasible(heap: list[tuple[float, Action]], state: SearchState) -> Action | None:
    while heap:
        _, action = heapq.heappop(heap)
        if not state.visited[action[1]]:
            return action
    return None
