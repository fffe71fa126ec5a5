"""Build the contact graph: exact distances between all near parts, samples near each contact, bridges.

Paper III-B declares contact where the minimum bidirectional SDF distance falls below a tolerance. A sampled or
learned distance cannot resolve real gaps of 0.01 to 0.2 % of the diagonal, so the gap here is the exact distance
between triangles.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from kinematify.contact.alike import find_clusters, outline_of
from kinematify.contact.graph import ContactEdge, ContactGraph, ContactSamples, Pair
from kinematify.processes.forked import each
from kinematify.robot.arrays import read_only
from kinematify.robot.vectors import box_gaps, lengths_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import ContactConfig
    from kinematify.geometry.surface import PartSurface, Samples
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


def build_contact_graph(
    assembly: Assembly,
    surfaces: Sequence[PartSurface],
    *,
    config: ContactConfig,
    seed: int,
    gap_of: Callable[[Pair], float] | None = None,
) -> ContactGraph:
    """Find which parts touch, keep samples near each contact and join what is left apart.

    Args:
        assembly: The parts, world frame.
        surfaces: Derived geometry of each part, same order.
        config: Tolerances as fractions of the assembly's diagonal.
        seed: Seed of the surface samples.
        gap_of: Distance between the parts of a pair [m]; the exact one if absent.

    Returns:
        A connected graph: parts that are near, and components by their smallest gap, are joined by bridges.
    """
    tolerance = config.tolerance * assembly.diagonal
    reach = max(config.near, config.tolerance) * assembly.diagonal
    gap_of = gap_of or partial(exact_gap, surfaces)
    within = {pair: gap for pair in near_pairs(assembly, reach) if (gap := gap_of(pair)) <= reach}
    gaps = {pair: gap for pair, gap in within.items() if gap <= tolerance}
    band = config.band * assembly.diagonal
    bridges = find_bridges(assembly, surfaces, list(gaps), near=config.bridge_ratio, limit=band)
    bridges |= {pair: gap for pair, gap in within.items() if gap > tolerance}
    raw = each(
        lambda item: (*item, *_contact_samples(surfaces, item[0], max(band, 3 * item[1]), config.samples, seed)),
        sorted({**gaps, **bridges}.items()),
    )
    strengths = _strengths(raw, tolerance, config)
    edges = tuple(
        ContactEdge(
            a=pair[0],
            b=pair[1],
            gap=gap,
            strength=strength,
            samples_a=side_a,
            samples_b=side_b,
            bridge=pair in bridges,
        )
        for (pair, gap, side_a, side_b), strength in zip(raw, strengths, strict=True)
    )
    return ContactGraph(
        n_parts=len(assembly.parts),
        edges=edges,
        clusters=find_clusters(assembly, surfaces, config=config, seed=seed),
        tolerance=tolerance,
        outlines=tuple(map(outline_of, surfaces)),
    )


def _strengths(
    raw: Sequence[tuple[Pair, float, ContactSamples, ContactSamples]], tolerance: float, config: ContactConfig
) -> list[float]:
    """Strength of every contact in [0, 1]."""
    if config.strength == "proximity":
        return [float(np.exp(-gap / tolerance)) for _, gap, _, _ in raw]
    areas = np.array([_mutual_area(side_a, side_b, max(gap, tolerance)) for _, gap, side_a, side_b in raw])
    return [float(area) for area in areas / max(float(areas.max(initial=0.0)), 1e-300)]


def near_pairs(assembly: Assembly, margin: float) -> list[Pair]:
    """Pairs (a < b) of parts whose bounding boxes come within `margin` [m] of each other."""
    lower = np.array([part.bounds[0] for part in assembly.parts])
    upper = np.array([part.bounds[1] for part in assembly.parts])
    rows, columns = np.nonzero(np.triu(box_gaps(lower, upper) <= margin, k=1))
    return list(zip(rows.tolist(), columns.tolist(), strict=True))


def exact_gap(surfaces: Sequence[PartSurface], pair: Pair) -> float:
    """Smallest distance between the triangles of two parts [m]; 0 where they cross."""
    return surfaces[pair[0]].gap(surfaces[pair[1]])


def find_bridges(
    assembly: Assembly, surfaces: Sequence[PartSurface], pairs: Sequence[Pair], *, near: float, limit: float
) -> dict[Pair, float]:
    """Join the components of the contact graph by their smallest gaps (Kruskal over exact distances).

    An object has one clearance: a part that touches nothing is joined with all that is nearly as close to it as the
    nearest. Exact distances are taken in the order of the bounding boxes' distance, which is a lower bound, so that
    few are needed.

    Args:
        assembly: The parts.
        surfaces: Derived geometry of each part, same order.
        pairs: Parts that touch.
        near: Gaps up to this many times the smallest one are nearly as close.
        limit: Largest clearance [m]; what is farther apart is joined by its smallest gap alone.

    Returns:
        Gap [m] of every added pair.
    """
    n = len(assembly.parts)
    touching = {part for pair in pairs for part in pair}
    bridges: dict[Pair, float] = {}
    for part in range(n):
        if part not in touching and n > 1:
            gaps = _smallest_gaps(assembly, surfaces, np.arange(n) == part, near)
            bridges |= {pair: gap for pair, gap in gaps.items() if gap <= limit}
    while True:
        labels = _component_labels(n, [*pairs, *bridges])
        if labels.max() == 0:
            return bridges
        smallest = int(np.argmin(np.bincount(labels)))
        bridges |= dict([_smallest(_smallest_gaps(assembly, surfaces, labels == smallest, 1.0))])


def _component_labels(n: int, pairs: Sequence[Pair]) -> IntArray:
    rows = [a for a, _ in pairs]
    columns = [b for _, b in pairs]
    graph = coo_matrix((np.ones(len(pairs)), (rows, columns)), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _smallest_gaps(
    assembly: Assembly, surfaces: Sequence[PartSurface], chosen: BoolArray, near: float
) -> dict[Pair, float]:
    """Closest pair between the chosen parts (n,) and the rest, and all that are at most `near` times as far apart."""
    inside, outside = np.flatnonzero(chosen), np.flatnonzero(~chosen)
    bounds = np.array([part.bounds for part in assembly.parts])
    apart = np.maximum(
        bounds[inside, None, 0] - bounds[None, outside, 1], bounds[None, outside, 0] - bounds[inside, None, 1]
    )
    lower_bound = lengths_of(np.maximum(apart, 0))
    found: dict[Pair, float] = {}
    smallest = np.inf
    for flat in np.argsort(lower_bound, axis=None, kind="stable"):
        row, column = np.unravel_index(flat, lower_bound.shape)
        if lower_bound[row, column] > near * smallest:
            break
        pair = (int(min(inside[row], outside[column])), int(max(inside[row], outside[column])))
        found[pair] = exact_gap(surfaces, pair)
        smallest = min(smallest, found[pair])
    return {pair: gap for pair, gap in found.items() if gap <= near * smallest}


def _smallest(gaps: dict[Pair, float]) -> tuple[Pair, float]:
    return min(gaps.items(), key=lambda item: (item[1], item[0]))


def _contact_samples(
    surfaces: Sequence[PartSurface], pair: Pair, band: float, count: int, seed: int
) -> tuple[ContactSamples, ContactSamples]:
    a, b = (surfaces[index] for index in pair)
    return _samples_near(a, b, band, count, seed), _samples_near(b, a, band, count, seed)


def _samples_near(surface: PartSurface, other: PartSurface, band: float, count: int, seed: int) -> ContactSamples:
    """Samples of `surface` within `band` [m] of `other`: a coarse pass finds the zone, a fine pass fills it."""
    zone = surface.faces_near(other.part.bounds, band)
    coarse = surface.sample(count, faces=zone, seed=seed)
    kept, distances = _within(coarse, other, band)
    if len(distances) == 0:
        return _empty_samples()
    box = np.stack([kept.points.min(0), kept.points.max(0)])
    fine = surface.sample(count, faces=surface.faces_near(box, 0.0), seed=seed + 1)
    refined, refined_distances = _within(fine, other, band)
    if len(refined_distances) > len(distances):
        kept, distances = refined, refined_distances
    return ContactSamples(
        points=read_only(kept.points, np.float64),
        normals=read_only(kept.normals, np.float64),
        distances=read_only(distances, np.float64),
        areas=read_only(kept.areas, np.float64),
    )


def _within(samples: Samples, other: PartSurface, band: float) -> tuple[Samples, FloatArray]:
    lower, upper = other.part.bounds
    boxed = np.all((samples.points >= lower - band) & (samples.points <= upper + band), axis=1)
    points = samples.points[boxed]
    if len(points) == 0:
        return samples.subset(boxed), np.empty(0)
    distances = other.distance(points)
    near = distances <= band
    index = np.flatnonzero(boxed)[near]
    return samples.subset(index), distances[near]


def _empty_samples() -> ContactSamples:
    nothing = read_only(np.empty((0, 3)), np.float64)
    scalars = read_only(np.empty(0), np.float64)
    return ContactSamples(points=nothing, normals=nothing, distances=scalars, areas=scalars)


def _mutual_area(side_a: ContactSamples, side_b: ContactSamples, reach: float) -> float:
    """Geometric mean of the two areas that lie within `reach` [m] of the other part [m^2]."""
    near_a = float(side_a.areas[side_a.distances <= reach].sum())
    near_b = float(side_b.areas[side_b.distances <= reach].sum())
    return float(np.sqrt(near_a * near_b))
