"""What the joint stage asks of a kinematic tree, without knowing the topology stage that builds it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterator


class RootedTree(Protocol):
    """A directed spanning tree over the parts of an assembly; node i is part i."""

    @property
    def root(self) -> int:
        """Index of the base link."""
        ...

    @property
    def parents(self) -> tuple[int, ...]:
        """Parent of every node; -1 for the root."""
        ...

    @property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Children of every node in ascending order."""
        ...

    @property
    def depths(self) -> tuple[int, ...]:
        """Graph distance of every node from the root."""
        ...

    def edges(self) -> Iterator[tuple[int, int]]:
        """Yield (parent, child), parents before children."""
        ...
