"""Contact graphs and skeletons of boxes that the topology tests share."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import Part
from kinematify.contact.graph import ContactEdge, ContactGraph, ContactSamples, pair
from kinematify.geometry.part_stats import PartStats, part_stats
from kinematify.topology.edge_evidence import TreeEvidence

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

NO_SAMPLES = ContactSamples(points=np.zeros((0, 3)), normals=np.zeros((0, 3)), distances=np.zeros(0), areas=np.zeros(0))
BOX_FACES = np.array([
    (0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4),
    (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7),
])  # fmt: skip
X, Y, Z = np.eye(3)


def edge(a: int, b: int, strength: float = 0.5, *, bridge: bool = False) -> ContactEdge:
    """A contact without samples."""
    return ContactEdge(a=a, b=b, gap=0.0, strength=strength, samples_a=NO_SAMPLES, samples_b=NO_SAMPLES, bridge=bridge)


def graph_of(
    n: int, strengths: Mapping[tuple[int, int], float], clusters: Iterable[Sequence[int]] = ()
) -> ContactGraph:
    """A contact graph with the given strengths."""
    edges = tuple(edge(a, b, value) for (a, b), value in sorted(strengths.items()))
    return ContactGraph(n_parts=n, edges=edges, clusters=tuple(map(tuple, clusters)), tolerance=0.01)


def evidence_of(
    quality: Mapping[tuple[int, int], float], carriers: Mapping[tuple[int, int], frozenset[int]] | None = None
) -> TreeEvidence:
    """Evidence of edges by quality."""
    return TreeEvidence(quality=quality, carriers=carriers or {})


def stat(centroid: Sequence[float], volume: float = 1.0, flat: float = 0.0) -> PartStats:
    """Measurements of a part that exists only as numbers."""
    centre = np.asarray(centroid, dtype=float)
    half = 0.5 * volume ** (1 / 3)
    return PartStats(
        centroid=centre,
        volume=volume,
        hull_volume=volume,
        bounds=np.stack([centre - half, centre + half]),
        flat_bottom=flat,
    )


def box(name: str, centre: Sequence[float], size: Sequence[float]) -> Part:
    """An axis-aligned closed box."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]) - 0.5
    return Part(name=name, vertices=np.asarray(centre) + corners * np.asarray(size), faces=BOX_FACES)


class Machine:
    """A skeleton of boxes: parts and their true parents."""

    def __init__(self) -> None:
        self.parts: list[Part] = []
        self.parents: list[int] = []

    def add(self, centre: Sequence[float], size: Sequence[float], parent: int = -1) -> int:
        """Add a box; the first one is the base."""
        index = len(self.parts)
        self.parts.append(box(f"p{index}", centre, size))
        self.parents.append(parent)
        return index

    @property
    def edges(self) -> list[tuple[int, int]]:
        """The true undirected tree."""
        return sorted(pair(parent, child) for child, parent in enumerate(self.parents) if parent >= 0)

    @property
    def stats(self) -> list[PartStats]:
        """Measured parts."""
        return [part_stats(part) for part in self.parts]

    @property
    def kind(self) -> np.ndarray:
        """Boxes of equal sorted sides are of one kind."""
        sides = [tuple(sorted(np.round(part.bounds[1] - part.bounds[0], 6).tolist())) for part in self.parts]
        return np.array([sides.index(item) for item in sides])


def random_assembly(
    n: int, extra: int, seed: int, clusters: Iterable[Sequence[int]] = ()
) -> tuple[ContactGraph, list[PartStats], TreeEvidence]:
    """A connected random graph: a random tree of mostly short branches and `extra` more contacts."""
    rng = np.random.default_rng(seed)
    pairs = {(int(rng.integers(max(0, i - 4), i)), i) for i in range(1, n)}
    while len(pairs) < min(n - 1 + extra, n * (n - 1) // 2):
        a, b = sorted(rng.choice(n, 2, replace=False).tolist())
        pairs.add((a, b))
    graph = graph_of(n, {item: float(rng.random()) for item in sorted(pairs)}, clusters)
    stats = [stat(rng.random(3), float(rng.random()) + 0.1, float(rng.random())) for _ in range(n)]
    evidence = {(item.a, item.b): float(rng.random()) for item in graph.edges}
    return graph, stats, evidence_of(evidence)
