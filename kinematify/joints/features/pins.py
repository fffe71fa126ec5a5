"""Pins that hold two parts, asked where the tree may depend on it: journals, shafts that pass, leaves on one pin."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from kinematify.contact.graph import pair
from kinematify.joints.bearings.refine_lines import across_axis
from kinematify.joints.features.journal import facing_faces, find_journal
from kinematify.joints.features.motion_test import moving_points, sweep_turns
from kinematify.joints.features.workspace import PartCache

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from collections.abc import Set as AbstractSet

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config, JointsConfig
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.joints.bearings.scores import BearingLine, EdgeBearing
    from kinematify.robot.arrays import FloatArray


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
    passing = frozenset(edge for edge in carriers if passes(cache, edge, lines[edge], config.joints))
    triples = sorted({tuple(sorted((a, b, c))) for (a, b), found in carriers.items() for c in found})
    adjacent, skipping = leaf_pairs(cache, triples, lines, passing, config.joints)
    journals = frozenset(edge for edge in doubtful if has_journal(cache, edge, config.joints))
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


def has_journal(cache: PartCache, pair: Pair, config: JointsConfig) -> bool:
    """True if a pin, barrel or shaft of one part sits in the other; looking from the smaller one.

    Leaves that lie edge to edge, fingers and drawers touch as well as a hinge does, but nothing of one goes round the
    other.
    """
    small, large = _by_size(cache, pair)
    reach = cache.graph.by_pair[pair].gap + config.contact_band * cache.diagonal
    facing = facing_faces(cache, large, small, reach, config.journal)
    size = float(np.ptp(cache.assembly.parts[small].bounds, axis=0).max())
    return find_journal(facing, size, config.journal) is not None


def passes(cache: PartCache, pair: Pair, line: BearingLine, config: JointsConfig) -> bool:
    """True if one part turns all around a line without meeting the other."""
    small, large = _by_size(cache, pair)
    points = moving_points(cache, small, config.sweep)
    swept = sweep_turns(cache, points, line.axis[None], line.pivot[None], (large,), limit=np.pi, config=config.sweep)
    return bool(swept.free(config.sweep.share).min() >= np.pi)


def _by_size(cache: PartCache, pair: Pair) -> Pair:
    small, large = sorted(pair, key=lambda part: (cache.assembly.parts[part].diagonal, part))
    return small, large


def middle_leaf(
    centroids: Mapping[int, FloatArray], line: BearingLine, reach: Mapping[int, float], config: JointsConfig
) -> int | None:
    """Which of three parts on one pin lies between the other two, as leaves of a book do; None where they do not.

    Args:
        centroids: Of the three parts, world frame [m], shape (3,) each.
        line: The pin.
        reach: Largest distance of each part from the line [m].
        config: What counts as a leaf.
    """
    basis = across_axis(line.axis)
    flat = {part: basis @ (centroid - line.pivot) for part, centroid in centroids.items()}
    if any(float(np.linalg.norm(place)) < config.limits.even * reach[part] for part, place in flat.items()):
        return None  # a shaft, which lies about the line on all sides
    mean = np.sum([place / np.linalg.norm(place) for place in flat.values()], axis=0)
    if np.linalg.norm(mean) < 1.0:
        return None  # all around
    turned = {part: float(np.arctan2(mean[0] * p[1] - mean[1] * p[0], mean @ p)) for part, p in flat.items()}
    return sorted(turned, key=turned.__getitem__)[1]


def leaf_pairs(
    cache: PartCache,
    triples: Iterable[tuple[int, ...]],
    lines: Mapping[Pair, BearingLine],
    passing: AbstractSet[Pair],
    config: JointsConfig,
) -> tuple[frozenset[Pair], frozenset[Pair]]:
    """Return the pairs of parts on one pin: next to each other, and with a third part between them.

    The magazine of a stapler lies between base and arm: the arm rests on it and pushes it down, so that the outer
    leaf moves with the middle one and not with what lies beyond.

    Args:
        cache: The parts.
        triples: Parts all of which turn on one line.
        lines: Best line of each contact (a, b), a < b.
        passing: Contacts whose parts turn past each other.
        config: What counts as a leaf.

    Returns:
        Pairs (a, b), a < b: next to each other, and skipping one.
    """
    adjacent: set[Pair] = set()
    skipping: set[Pair] = set()
    for triple in triples:
        pairs = [(min(pair), max(pair)) for pair in combinations(triple, 2)]
        line = lines[pairs[0]]
        points = {part: cache.samples(part).points for part in triple}
        reach = {
            part: float(np.linalg.norm(np.cross(own - line.pivot, line.axis), axis=1).max())
            for part, own in points.items()
        }
        middle = middle_leaf({part: own.mean(axis=0) for part, own in points.items()}, line, reach, config)
        beside = {pair for pair in pairs if middle in pair}
        if middle is not None and not beside & passing:
            adjacent |= beside
            skipping |= set(pairs) - beside
    return frozenset(adjacent), frozenset(skipping)
