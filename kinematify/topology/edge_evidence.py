"""Evidence of edges for the search: quality of a contact, and how parts that no contact reaches join (III-C)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.choice.edges import edge_qualities

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.geometry.part_stats import PartStats
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.features.pins import EdgePins
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class TreeEvidence:
    """What is known of contacts, keyed (a, b) with a < b; the same for both directions of an edge."""

    quality: Mapping[Pair, float]
    """Of every contact for the tree, in [0, 1]."""
    carriers: Mapping[Pair, frozenset[int]]
    """Bodies far larger than both ends of an edge that bear them about one line."""


def gather_evidence(
    graph: ContactGraph, stats: Sequence[PartStats], bearings: Mapping[Pair, EdgeBearing], pins: EdgePins
) -> TreeEvidence:
    """Evidence of every contact edge; arguments as in `edges.edge_measurements`."""
    return TreeEvidence(
        quality=edge_qualities(graph, stats, bearings, pins),
        carriers=pins.carriers,
    )


def virtual_costs(centroids: FloatArray, *, limit: float = np.inf, forbidden: Iterable[Pair] = ()) -> FloatArray:
    """Cost of a virtual edge between every two parts [m], shape (n, n): the distance of their centroids.

    Pairs beyond `limit` (``d_max``) cost more than any nearer one, and forbidden pairs (inside a cluster) more than
    all others, so that they are taken last: a tree that leaves a part out would be of no use.
    """
    costs: FloatArray = np.linalg.norm(centroids[:, None] - centroids[None], axis=2)
    span = float(costs.max()) + 1.0
    costs = np.where(costs > limit, costs + span, costs)
    for a, b in forbidden:
        costs[a, b] += 4 * span
        costs[b, a] += 4 * span
    return costs


def nearest_pair(costs: FloatArray, reached: ArrayLike) -> tuple[int, int]:
    """Cheapest pair (reached part, other part).

    Args:
        costs: Cost of every pair, shape (n, n).
        reached: Which parts are in the tree, shape (n,); at least one is and one is not.
    """
    mask = np.asarray(reached, dtype=bool)
    inside, outside = np.flatnonzero(mask), np.flatnonzero(~mask)
    choices = costs[np.ix_(inside, outside)]
    row, column = np.unravel_index(int(choices.argmin()), choices.shape)
    return int(inside[row]), int(outside[column])
