"""Pins that hold two parts, asked where the tree may depend on it: journals, and what a body bears on one line."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.joints.features.journal import held_journal
from kinematify.joints.features.workspace import PartCache

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config, JointsConfig
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.geometry.part_stats import PartStats
    from kinematify.joints.bearings.scores import BearingLine, EdgeBearing


_BODY = 10.0  # times the hull of hands and shafts; leaves on one pin, as in staplers and scissors, are of one size


@dataclass(frozen=True, kw_only=True)
class EdgePins:
    """Contact edges by what holds their parts; what was not asked is in none."""

    journals: frozenset[Pair] = frozenset()
    """One part holds the other all around a line."""
    carriers: Mapping[Pair, frozenset[int]] = field(default_factory=dict)
    """Bodies far larger than both ends that bear them about their own line."""


def find_pins(
    assembly: Assembly,
    graph: ContactGraph,
    stats: Sequence[PartStats],
    bearings: Mapping[Pair, EdgeBearing],
    config: Config,
) -> EdgePins:
    """Ask the edges that others could replace and that have no clear bearing or join congruent parts, and coaxial ones.

    Args:
        assembly: The parts.
        graph: Their contacts.
        stats: What is measured of the parts.
        bearings: Bearing lines of the edges, best first.
        config: `topology` says what is clear and what is one line, `joints` how contacts are asked.
    """
    lines = {edge: bearing.lines[0] for edge, bearing in bearings.items() if bearing.lines}
    topology, kind = config.topology, graph.alike.kind
    doubtful = [
        (a, b)
        for a, b in on_cycles(graph.by_pair, graph.n_parts)
        if (a, b) in lines and (lines[a, b].score < topology.clear_score or kind[a] == kind[b])
    ]
    hulls = [item.hull_volume for item in stats]
    found = coaxial_carriers(lines, angle=topology.stack_deg, distance=topology.stack_distance * assembly.diagonal)
    cache = PartCache(assembly, graph, samples=config.joints.samples, seed=config.seed)
    return EdgePins(
        journals=frozenset(edge for edge in doubtful if has_journal(cache, edge, config.joints)),
        carriers={
            edge: frozenset(part for part in parts if hulls[part] > _BODY * max(hulls[end] for end in edge))
            for edge, parts in found.items()
        },
    )


def on_cycles(edges: Iterable[Pair], n: int) -> list[Pair]:
    """Edges that others could replace: without one of them, all parts that it joins are still connected."""
    kept = list(edges)
    incidence = np.zeros((len(kept), n))
    for row, ends in zip(incidence, kept, strict=True):
        row[list(ends)] = 1.0, -1.0
    # An edge of unit resistance that nothing bypasses has the resistance 1 between its ends.
    resistance = np.einsum("ij,jk,ik->i", incidence, np.linalg.pinv(incidence.T @ incidence), incidence)
    return [edge for edge, between in zip(kept, resistance, strict=True) if between < 1.0 - 1e-6]


def coaxial_carriers(lines: Mapping[Pair, BearingLine], *, angle: float, distance: float) -> dict[Pair, frozenset[int]]:
    """Parts that bear both ends of an edge about its own line.

    Args:
        lines: Best bearing line of each contact edge that has one.
        angle: Axes within this angle are one line [deg].
        distance: The same for their distance [m].

    Returns:
        For every edge (a, b) with such parts: all c that touch both a and b, where all three turn on one line.
    """
    parts = {part for edge in lines for part in edge}

    def coaxial(first: BearingLine, second: BearingLine) -> bool:
        offset = np.linalg.norm(np.cross(second.pivot - first.pivot, first.axis))
        return bool(abs(float(first.axis @ second.axis)) > np.cos(np.radians(angle)) and offset < distance)

    found = {}
    for edge, line in lines.items():
        others = [(part, [lines.get(pair(end, part)) for end in edge]) for part in parts]
        carriers = frozenset(part for part, some in others if all(item and coaxial(line, item) for item in some))
        if carriers:
            found[edge] = carriers
    return found


def has_journal(cache: PartCache, ends: Pair, config: JointsConfig) -> bool:
    """True if a pin, barrel or shaft of one part sits in the other; looking from the smaller one.

    Leaves that lie edge to edge, fingers and drawers touch as well as a hinge does, but nothing of one goes round the
    other.
    """
    small, large = sorted(ends, key=lambda part: (cache.assembly.parts[part].diagonal, part))
    size = float(np.ptp(cache.assembly.parts[small].bounds, axis=0).max())
    return held_journal(cache, large, small, size, config) is not None
