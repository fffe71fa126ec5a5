"""What is known of the joint of each contact edge before the tree is: its quality, its line, and what holds it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.joints.measure.edge_tests import journal_pairs, leaf_pairs, passing_pairs
from kinematify.joints.measure.quality import edge_quality
from kinematify.joints.measure.workspace import PartCache
from kinematify.robot.arrays import read_only
from kinematify.topology.spanning import on_cycles

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.joints.hypotheses.bearing_line import EdgeBearing
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class EdgeEvidence:
    """How well the best joint explains a contact; the same for both directions of the edge."""

    quality: float
    """In [0, 1]; 0 where no joint fits."""
    axis: FloatArray | None
    """Unit direction of the best joint in the world frame, shape (3,); None where there is none. Read-only."""
    point: FloatArray | None = None
    """A point on its line in the world frame [m], shape (3,); None where there is none. Read-only."""
    has_journal: bool = False
    """One part holds the other all around a line, beyond doubt; asked only where the tree depends on it."""
    passing: bool = False
    """One part turns past the other about the line, all around; asked of coaxial parts only."""
    is_adjacent_leaf: bool = False
    """Both are leaves on one pin, next to each other, and cannot pass each other."""
    skips_leaf: bool = False
    """Both are leaves on one pin, and a third one lies between them."""

    def __post_init__(self) -> None:
        if self.axis is not None:
            axis = np.asarray(self.axis, dtype=np.float64)
            object.__setattr__(self, "axis", read_only(axis / np.linalg.norm(axis), np.float64))
        if self.point is not None:
            object.__setattr__(self, "point", read_only(self.point, np.float64))

    def is_coaxial(self, other: EdgeEvidence, *, angle: float, distance: float) -> bool:
        """Whether two joints turn about one line, within `angle` [deg] and `distance` [m]."""
        if self.axis is None or other.axis is None or self.point is None or other.point is None:
            return False
        offset = np.linalg.norm(np.cross(other.point - self.point, self.axis))
        return bool(abs(float(self.axis @ other.axis)) > np.cos(np.radians(angle)) and offset < distance)


def coaxial_carriers(
    evidence: Mapping[Pair, EdgeEvidence], *, angle: float, distance: float
) -> dict[Pair, frozenset[int]]:
    """Parts that bear both ends of an edge about its own line.

    Args:
        evidence: Best joint of each contact edge.
        angle: Axes within this angle are one line [deg].
        distance: The same for their distance [m].

    Returns:
        For every edge (a, b) with such parts: all c that touch both a and b, where all three turn on one line.
    """
    touching: dict[int, set[int]] = {}
    for a, b in evidence:
        touching.setdefault(a, set()).add(b)
        touching.setdefault(b, set()).add(a)
    found = {}
    for (a, b), item in evidence.items():
        sides = {c: (evidence[pair(a, c)], evidence[pair(b, c)]) for c in touching[a] & touching[b]}
        carriers = frozenset(
            c
            for c, both in sides.items()
            if all(item.is_coaxial(side, angle=angle, distance=distance) for side in both)
        )
        if carriers:
            found[a, b] = carriers
    return found


def gather_evidence(
    assembly: Assembly, graph: ContactGraph, bearings: Mapping[Pair, EdgeBearing], config: Config
) -> dict[Pair, EdgeEvidence]:
    """What the tree search needs to know of each contact edge: quality and line of its best joint, and what holds it.

    Costly questions are asked only of edges whose answer the search needs: those that others could replace and that
    have no clear bearing or join congruent parts, and those between parts that a third one bears on the same line.
    """
    lines = {pair: bearing.lines[0] for pair, bearing in bearings.items() if bearing.lines}
    evidence = {
        pair: EdgeEvidence(
            quality=edge_quality(edge, bearings.get(pair), config.quality),
            axis=lines[pair].axis if pair in lines else None,
            point=lines[pair].pivot if pair in lines else None,
        )
        for pair, edge in graph.by_pair.items()
    }
    topology = config.topology
    bounds = {"angle": topology.stack_deg, "distance": topology.stack_distance * assembly.diagonal}
    carriers = coaxial_carriers(evidence, **bounds)
    contested = [pair for pair in on_cycles(graph.by_pair, graph.n_parts) if pair in lines]
    doubtful = [
        pair for pair in contested if evidence[pair].quality < topology.journal_quality or _are_twins(graph, pair)
    ]
    cache = PartCache(assembly, graph, samples=config.joints.samples, seed=config.seed)
    journals = journal_pairs(cache, doubtful, config.joints)
    passing = passing_pairs(cache, {pair: lines[pair] for pair in carriers}, config.joints)
    triples = sorted({tuple(sorted((a, b, c))) for (a, b), found in carriers.items() for c in found})
    adjacent, skipping = leaf_pairs(cache, triples, lines, passing, config.joints)
    return {
        pair: replace(
            item,
            has_journal=pair in journals,
            passing=pair in passing,
            is_adjacent_leaf=pair in adjacent,
            skips_leaf=pair in skipping,
        )
        for pair, item in evidence.items()
    }


def _are_twins(graph: ContactGraph, pair: Pair) -> bool:
    first, second = (graph.cluster_of[part] for part in pair)
    return first >= 0 and first == second
