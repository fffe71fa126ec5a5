"""What holds two parts, asked where the tree may depend on it: journals, shafts that pass, leaves on one pin."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from kinematify.contact.graph import pair
from kinematify.joints.measure.edge_tests import journal_pairs, leaf_pairs, passing_pairs
from kinematify.joints.measure.workspace import PartCache

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.joints.hypotheses.bearing_line import BearingLine, EdgeBearing


@dataclass(frozen=True, kw_only=True)
class EdgePins:
    """Contact edges by what holds their parts; what was not asked is in none."""

    journals: frozenset[Pair] = frozenset()
    """One part holds the other all around a line."""
    passing: Mapping[Pair, frozenset[int]] = field(default_factory=dict)
    """One part turns past the other about their line, all around, and these parts bear both there."""
    adjacent: frozenset[Pair] = frozenset()
    """Both are leaves on one pin, next to each other, and cannot pass each other."""
    skipping: frozenset[Pair] = frozenset()
    """Both are leaves on one pin, and a third one lies between them."""


def find_pins(
    assembly: Assembly, graph: ContactGraph, bearings: Mapping[Pair, EdgeBearing], config: Config
) -> EdgePins:
    """Ask the edges that others could replace and that have no clear bearing or join congruent parts, and coaxial ones.

    Args:
        assembly: The parts.
        graph: Their contacts.
        bearings: Bearing lines of the edges, best first.
        config: `topology` says what is clear and what is one line, `joints` how contacts are asked.
    """
    lines = {edge: bearing.lines[0] for edge, bearing in bearings.items() if bearing.lines}
    topology, label = config.topology, graph.cluster_of
    doubtful = [
        (a, b)
        for a, b in on_cycles(graph.by_pair, graph.n_parts)
        if (a, b) in lines and (lines[a, b].score < topology.clear_score or label[a] == label[b] >= 0)
    ]
    carriers = coaxial_carriers(lines, angle=topology.stack_deg, distance=topology.stack_distance * assembly.diagonal)
    if not doubtful and not carriers:
        return EdgePins()
    cache = PartCache(assembly, graph, samples=config.joints.samples, seed=config.seed)
    passing = passing_pairs(cache, {edge: lines[edge] for edge in carriers}, config.joints)
    triples = sorted({tuple(sorted((a, b, c))) for (a, b), found in carriers.items() for c in found})
    adjacent, skipping = leaf_pairs(cache, triples, lines, passing, config.joints)
    journals = journal_pairs(cache, doubtful, config.joints)
    beside = {edge: carriers[edge] for edge in sorted(passing)}
    return EdgePins(journals=journals, passing=beside, adjacent=adjacent, skipping=skipping)


def on_cycles(edges: Iterable[Pair], n: int) -> list[Pair]:
    """Edges that others could replace: without one of them, all parts that it joins are still connected."""
    kept = list(edges)
    replaceable = []
    for edge in kept:
        rows, columns = np.array([other for other in kept if other != edge]).reshape(-1, 2).T
        matrix = csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(n, n))
        labels = connected_components(matrix, directed=False)[1]
        if labels[edge[0]] == labels[edge[1]]:
            replaceable.append(edge)
    return replaceable


def coaxial_carriers(lines: Mapping[Pair, BearingLine], *, angle: float, distance: float) -> dict[Pair, frozenset[int]]:
    """Parts that bear both ends of an edge about its own line.

    Args:
        lines: Best bearing line of each contact edge that has one.
        angle: Axes within this angle are one line [deg].
        distance: The same for their distance [m].

    Returns:
        For every edge (a, b) with such parts: all c that touch both a and b, where all three turn on one line.
    """
    touching: dict[int, set[int]] = {}
    for a, b in lines:
        touching.setdefault(a, set()).add(b)
        touching.setdefault(b, set()).add(a)

    def coaxial(first: BearingLine, second: BearingLine) -> bool:
        offset = np.linalg.norm(np.cross(second.pivot - first.pivot, first.axis))
        return bool(abs(float(first.axis @ second.axis)) > np.cos(np.radians(angle)) and offset < distance)

    found = {}
    for (a, b), line in lines.items():
        common = touching[a] & touching[b]
        carriers = frozenset(c for c in common if all(coaxial(line, lines[pair(end, c)]) for end in (a, b)))
        if carriers:
            found[a, b] = carriers
    return found
