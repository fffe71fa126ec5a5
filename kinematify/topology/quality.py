"""Weight of a contact edge: how well its best joint explains it, with a soft penalty between congruent parts.

The paper forbids edges inside a cluster, which cuts true ones (neighbouring links of an arm are congruent). Here such
an edge is only weakened, and only as far as it has a rival: it keeps its quality where nothing else connects the two
parts, where it is decisively better than what it would replace, or where one part holds the other by a pin (the leaves
of a folding door).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.topology.spanning import maximum_spanning_edges, tree_path

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.config import TopologyConfig
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.topology.evidence import EdgeEvidence


def effective_quality(
    graph: ContactGraph, evidence: Mapping[Pair, EdgeEvidence], config: TopologyConfig
) -> dict[Pair, float]:
    """Weight of every contact edge in [0, 1].

    Args:
        graph: Contacts and clusters.
        evidence: Best joint of each edge; an edge without evidence has quality 0.
        config: `proximity_weight` of the tie-break, `cluster_penalty` and `decisive_ratio` of the soft penalty.
    """
    quality = {pair: _quality_with_tie_break(graph, evidence, pair, config.proximity_weight) for pair in graph.by_pair}
    journals = {pair for pair, item in evidence.items() if item.has_journal}
    quality |= {pair: max(quality[pair], config.journal_quality) for pair in journals}
    quality |= {pair: quality[pair] * config.skip_penalty for pair, item in evidence.items() if item.skips_leaf}
    label = graph.cluster_of
    kept = journals | {pair for pair, item in evidence.items() if item.is_adjacent_leaf}
    inside = [(a, b) for a, b in quality if label[a] >= 0 and label[a] == label[b] and (a, b) not in kept]
    weakened = {**quality, **{pair: quality[pair] * config.cluster_penalty for pair in inside}}
    result = dict(weakened)
    for pair in inside:
        rival = bottleneck({other: value for other, value in weakened.items() if other != pair}, graph.n_parts, pair)
        if quality[pair] > config.decisive_ratio * rival:
            result[pair] = quality[pair]
    return result


def bottleneck(weights: Mapping[Pair, float], n: int, ends: Pair) -> float:
    """Weakest edge of the strongest path between two parts; 0 where there is no path."""
    path = tree_path(maximum_spanning_edges(weights, n), n, ends)
    return min((weights[step] for step in path), default=0.0)


def _quality_with_tie_break(
    graph: ContactGraph, evidence: Mapping[Pair, EdgeEvidence], pair: Pair, proximity_weight: float
) -> float:
    """Joint quality, moved by at most `proximity_weight` so that proximity only breaks ties."""
    edge = graph.by_pair[pair]
    strength = 0.0 if edge.bridge else edge.strength
    quality = evidence[pair].quality if pair in evidence else 0.0
    return (1 - proximity_weight) * quality + proximity_weight * strength
