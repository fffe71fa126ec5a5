"""Rooted kinematic trees over the parts of an assembly (paper III-A, ``T = (V, E_T)``)."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


@dataclass(frozen=True, kw_only=True)
class KinematicTree:
    """A directed spanning tree; node i is part i of the assembly."""

    parents: tuple[int, ...]
    """Parent of every node; -1 for the root and nowhere else."""
    broken: frozenset[tuple[int, int]] = frozenset()
    """Contact edges (a < b) that are not in the tree because they would close a cycle."""
    virtual: frozenset[tuple[int, int]] = frozenset()
    """Tree edges (a < b) between parts that do not touch."""
    reward: float = 0.0
    """Total reward under the configured weights; higher is better."""
    terms: Mapping[str, float] = field(default_factory=dict)
    """Value of each reward term, each in [0, 1]."""
    likely: Mapping[tuple[int, int], float] = field(default_factory=dict)
    """Probability of its edges (a < b) among all trees of the contact graph; those that are not named are certain."""
    standing: tuple[float, ...] = ()
    """Probability of every part to be the base link; empty where the base link was given."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "likely", MappingProxyType(dict(self.likely)))
        object.__setattr__(self, "terms", MappingProxyType(dict(self.terms)))

    @property
    def root(self) -> int:
        """Index of the base link ``b``."""
        return self.parents.index(-1)

    def edges(self) -> Iterator[tuple[int, int]]:
        """Yield (parent, child) in breadth-first order from the root."""
        queue = [self.root]
        for node in queue:
            for child in self.children[node]:
                yield node, child
                queue.append(child)

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Children of every node in ascending order."""
        lists: list[list[int]] = [[] for _ in self.parents]
        for child, parent in enumerate(self.parents):
            if parent >= 0:
                lists[parent].append(child)
        return tuple(tuple(items) for items in lists)

    @cached_property
    def depths(self) -> tuple[int, ...]:
        """Graph distance of every node from the root."""
        depth = [0] * len(self.parents)
        for parent, child in self.edges():
            depth[child] = depth[parent] + 1
        return tuple(depth)

    def subtree(self, node: int) -> frozenset[int]:
        """Return a node and all that it carries."""
        found = [node]
        for item in found:
            found.extend(self.children[item])
        return frozenset(found)
