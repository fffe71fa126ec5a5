"""Quality of a contact edge for the tree: what is measured of it, weighed by fitted weights.

A spanning tree T has the probability exp(sum of s_e over its edges) / Z, where s_e = w . x_e is linear in the
measurements x_e and Z sums over all spanning trees of the contact graph (matrix-tree theorem, Kirchhoff 1847). The fit
maximised the likelihood of the true trees (`benchmarks/fit/edge_fit.py`). The most likely tree is the maximum spanning
tree of s, and so of every growing function of it.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import EnvironmentFault

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.contact.graph import ContactEdge, ContactGraph, Pair
    from kinematify.geometry.part_stats import PartStats
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.features.pins import EdgePins
    from kinematify.robot.arrays import FloatArray

EDGE_WEIGHTS = "edges.json"
MEASUREMENTS = (
    "bearing", "clear_bearing", "log_bearing", "log_gap", "bridge", "log_wide_share",
    "of_largest_contact", "of_smaller_contacts", "of_larger_contacts", "twins", "bearing_of_twins", "log_hull_ratio",
    "size", "inside", "journal", "along_larger", "rim_of_larger",
)  # fmt: skip
"""Columns of `edge_measurements`."""
_WIDE = 8.0  # tolerances of the contact within which area counts, too
_LOWEST = -18.0  # scores below the best by more than this are equally unlikely
_SOFT = 2.0  # the quality is a growing function of s; half of it keeps apart what is beyond doubt


@dataclass(frozen=True, kw_only=True, eq=False)
class LinearWeights:
    """A linear score, of edges or of parts."""

    weights: FloatArray
    """Of every column, shape (k,)."""
    offset: float
    provenance: Mapping[str, Any]

    def scores(self, measured: FloatArray) -> FloatArray:
        """``s`` of measurements of shape (m, k), shape (m,)."""
        return np.asarray(measured @ self.weights + self.offset)


def edge_qualities(
    graph: ContactGraph, stats: Sequence[PartStats], bearings: Mapping[Pair, EdgeBearing], pins: EdgePins
) -> dict[Pair, float]:
    """Quality of every contact edge in (0, 1), which grows with its score; arguments as in `edge_measurements`.

    Raises:
        EnvironmentFault: The weights are missing, damaged or of another version.
    """
    scores = shipped_weights(EDGE_WEIGHTS, MEASUREMENTS).scores(edge_measurements(graph, stats, bearings, pins))
    qualities = 1.0 / (1.0 + np.exp(-scores / _SOFT))
    return dict(zip(graph.by_pair, qualities.tolist(), strict=True))


def scores_of(qualities: FloatArray) -> FloatArray:
    """``s_e`` of qualities in [0, 1], the inverse of what `edge_qualities` does; shape (m,)."""
    bounded = np.clip(qualities, 1e-6, 1.0 - 1e-6)
    return np.asarray(_SOFT * np.log(bounded / (1.0 - bounded)))


def edge_probabilities(pairs: Sequence[Pair], scores: FloatArray, n: int) -> tuple[FloatArray, float]:
    """Probability of each edge to be in the spanning tree, shape (m,), and ``log Z``.

    Both come from the Laplacian of the graph with weights exp(s): Z is its minor, and the probability of an edge is its
    weight times the resistance between its ends.

    Args:
        pairs: Edges; where they leave the graph in pieces, Z is 0, and each piece has its own tree.
        scores: ``s_e``, shape (m,).
        n: Number of parts.
    """
    a, b = np.array(pairs).T
    highest = float(scores.max())
    weights = np.exp(np.maximum(scores - highest, _LOWEST))
    laplacian = np.zeros((n, n))
    np.add.at(laplacian, (a, b), -weights)
    np.add.at(laplacian, (b, a), -weights)
    np.fill_diagonal(laplacian, -laplacian.sum(axis=1))
    inverse = np.linalg.pinv(laplacian, rcond=1e-13, hermitian=True)
    resistance = inverse[a, a] + inverse[b, b] - 2.0 * inverse[a, b]
    log_z = float(np.linalg.slogdet(laplacian[1:, 1:])[1]) + (n - 1) * highest
    return np.clip(weights * resistance, 0.0, 1.0), log_z


def edge_measurements(
    graph: ContactGraph, stats: Sequence[PartStats], bearings: Mapping[Pair, EdgeBearing], pins: EdgePins
) -> FloatArray:
    """Return what is measured of every contact edge, in the order of the graph, shape (m, len(MEASUREMENTS)).

    Args:
        graph: Contacts with their samples, bridges, and clusters of congruent parts.
        stats: Size and place of every part, world frame.
        bearings: Bearing lines of the edges, best first; an edge without any has none.
        pins: What holds the parts of the edges.
    """
    if not graph.edges:
        return np.empty((0, len(MEASUREMENTS)))
    bounds = np.array([item.bounds for item in stats])
    hulls = np.array([item.hull_volume for item in stats])
    diagonal = np.linalg.norm(bounds[:, 1].max(axis=0) - bounds[:, 0].min(axis=0))
    a, b = np.array(list(graph.by_pair)).T
    small, large = np.where(hulls[a] < hulls[b], (a, b), (b, a))
    extents = bounds[:, 1] - bounds[:, 0] + 1e-9 * diagonal
    faces = 2.0 * (extents * np.roll(extents, 1, axis=1)).sum(axis=1)

    found = [bearings.get(pair) for pair in graph.by_pair]
    score = np.array([item.lines[0].score if item and item.lines else 0.0 for item in found])
    gap = np.array([edge.gap for edge in graph.edges])
    near = [[_near(edge, times * graph.tolerance) for edge in graph.edges] for times in (1.0, _WIDE)]
    area, wide = (np.sqrt([one[1].sum() * other[1].sum() for one, other in sides]) for sides in near)
    total = np.bincount(np.concatenate([a, b]), np.tile(area, 2), minlength=len(stats))
    twins = graph.alike.kind[a] == graph.alike.kind[b]
    common = np.minimum(bounds[a, 1], bounds[b, 1]) - np.maximum(bounds[a, 0], bounds[b, 0]) + 1e-9 * diagonal
    bearing = score / (score + 0.02)
    inside = np.clip(common, 0.0, None).prod(axis=1) / np.minimum(extents[a].prod(axis=1), extents[b].prod(axis=1))
    return np.column_stack(
        [
            bearing,
            score / (score + 0.2),
            np.log10(score + 1e-3),
            np.log10(gap / diagonal + 1e-4),
            np.array([edge.bridge for edge in graph.edges]),
            np.log10(wide / np.minimum(faces[a], faces[b]) + 1e-4),
            np.sqrt(area / max(float(area.max()), 1e-300)),
            area / np.maximum(total[small], 1e-300),
            area / np.maximum(total[large], 1e-300),
            twins,
            twins * bearing,
            np.log10(hulls[small] / hulls[large] + 1e-5),
            np.linalg.norm(bounds[small, 1] - bounds[small, 0], axis=1) / diagonal,
            np.minimum(inside, 1.0),
            np.array([edge in pins.journals for edge in graph.by_pair]),
            np.array([_line(one, other, bounds[part]) for (one, other), part in zip(near[0], large, strict=True)]),
        ]
    )


_Side = tuple["FloatArray", "FloatArray"]
"""Points [m] and areas [m^2] of one part of an edge that are near the other part."""


def _near(edge: ContactEdge, reach: float) -> list[_Side]:
    """What of either part is within `reach` [m] of the other one, or a fifth beyond the gap."""
    near = [(side, side.distances <= max(reach, 1.2 * edge.gap)) for side in (edge.samples_a, edge.samples_b)]
    return [(side.points[kept], side.areas[kept]) for side, kept in near]


def _line(one: _Side, other: _Side, bounds: FloatArray) -> tuple[float, float]:
    """How far what is near runs along a box and how far out in it that lies, in [0, 1]: both are 1 under a hinge."""
    points, areas = map(np.concatenate, zip(one, other, strict=True))
    if areas.sum() <= 0.0:
        return 0.0, 0.0
    spread, axes = np.linalg.eigh(np.cov(points.T, aweights=areas, ddof=0))
    along, extents = axes[:, 2], np.ptp(bounds, axis=0) + 1e-12
    aside = np.average(points, axis=0, weights=areas) - bounds.mean(axis=0)
    aside -= (aside @ along) * along
    length = np.sqrt(12.0 * max(spread[2], 0.0)) / (np.abs(along) @ extents)
    return min(float(length), 1.0), min(float(2.0 * (aside @ aside) / (np.abs(aside) @ extents + 1e-300)), 1.0)


@cache
def shipped_weights(file: str, columns: tuple[str, ...]) -> LinearWeights:
    """Weights that come with the package.

    Args:
        file: Its name.
        columns: What they are to be of, in this order.

    Raises:
        EnvironmentFault: The file is missing, damaged or of another version.
    """
    try:
        stored = json.loads((files("kinematify.joints.choice") / file).read_text(encoding="utf-8"))
        weights = stored["weights"]
        if tuple(weights) != columns:
            raise ValueError(f"they are of {len(weights)} measurements, not of the {len(columns)} of this version")
        return LinearWeights(
            weights=np.array(list(weights.values())), offset=stored["offset"], provenance=stored["provenance"]
        )
    except (OSError, ValueError, KeyError) as error:
        raise EnvironmentFault(
            f"The weights of the tree ({file}) cannot be read: {error}. Install kinematify again, or write the weights "
            "with 'python -m benchmarks.fit.edge_fit'."
        ) from error
