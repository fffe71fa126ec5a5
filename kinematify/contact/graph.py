"""Contact graph of an assembly: which parts touch, where, and how strongly (paper III-B)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from kinematify.contact.alike import AlikeParts

if TYPE_CHECKING:
    from kinematify.contact.alike import Outline
    from kinematify.robot.arrays import FloatArray


Pair = tuple[int, int]
"""An undirected edge (a, b) with a < b."""


def pair(a: int, b: int) -> Pair:
    """Key of the undirected edge between two parts."""
    return (a, b) if a < b else (b, a)


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactSamples:
    """Surface samples of one part of a pair that lie near the other part."""

    points: FloatArray
    """World frame [m], shape (n, 3). Read-only."""
    normals: FloatArray
    """Unit face normals, shape (n, 3). Read-only."""
    distances: FloatArray
    """Exact unsigned distance to the other part [m], shape (n,). Read-only."""
    areas: FloatArray
    """Surface area that each sample represents [m^2], shape (n,). Read-only."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactEdge:
    """An undirected contact between parts `a` < `b`."""

    a: int
    b: int
    gap: float
    """Smallest exact distance between the two surfaces [m]; 0 where they touch or cross."""
    strength: float
    """Contact strength s(u, v) in [0, 1] (paper, R_contact)."""
    samples_a: ContactSamples
    """Samples of part `a` near part `b`."""
    samples_b: ContactSamples
    """Samples of part `b` near part `a`."""
    bridge: bool = False
    """True where the parts do not touch: they are near, or the edge joins components (paper: virtual edge)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactGraph:
    """The connection graph G = (V, E); nodes are indices into `Assembly.parts`."""

    n_parts: int
    edges: tuple[ContactEdge, ...]
    clusters: tuple[tuple[int, ...], ...]
    """Groups of two or more congruent parts (up to mirroring), ascending; singletons are omitted."""
    tolerance: float
    """Largest gap that counts as contact [m]."""
    outlines: tuple[Outline, ...] = ()
    """Of every part, to be laid upon each other."""

    @cached_property
    def by_pair(self) -> dict[Pair, ContactEdge]:
        """Edges keyed by (a, b) with a < b."""
        return {(edge.a, edge.b): edge for edge in self.edges}

    @cached_property
    def neighbours(self) -> tuple[tuple[int, ...], ...]:
        """Touching parts of every part, ascending."""
        sets: list[set[int]] = [set() for _ in range(self.n_parts)]
        for edge in self.edges:
            sets[edge.a].add(edge.b)
            sets[edge.b].add(edge.a)
        return tuple(tuple(sorted(items)) for items in sets)

    @cached_property
    def alike(self) -> AlikeParts:
        """Which parts are alike, and by which motions."""
        return AlikeParts(self.n_parts, self.clusters, self.outlines)
