"""Clusters of congruent parts, up to mirroring (paper III-C: part clusters by Chamfer distance).

A fingerprint that no rigid motion or mirroring changes (area, spreads, distances from the centroid) rejects nearly
all pairs; the Chamfer distance after the best of the alignments of principal axes decides the rest.
"""

from __future__ import annotations

from itertools import permutations, product
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from kinematify.geometry.surface import FACETED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.assembly.part import Assembly
    from kinematify.config import ContactConfig
    from kinematify.geometry.surface import PartSurface
    from kinematify.robot.arrays import FloatArray

_PROFILE_QUANTILES = np.linspace(0.02, 0.98, 9)
_ROUGH = 1.5
"""More of the tolerance for rough parts in the test by size and area: voxels of a tenth of a finger change both."""


def find_clusters(
    assembly: Assembly, surfaces: Sequence[PartSurface], *, config: ContactConfig, seed: int
) -> tuple[tuple[int, ...], ...]:
    """Group congruent parts.

    Args:
        assembly: The parts.
        surfaces: Derived geometry of each part, same order.
        config: `cluster_samples` points per part, `cluster_tolerance` as a fraction of the part's diagonal.
        seed: Seed of the samples.

    Returns:
        Groups of two or more part indices, each ascending, ordered by their first member.
    """
    shapes = [_centred_samples(surface, config.cluster_samples, seed) for surface in surfaces]
    prints = np.array([_fingerprint(points) for points in shapes])
    areas = np.array([surface.part.area for surface in surfaces])
    sizes = np.array([np.linalg.norm(points, axis=1).max() for points in shapes])
    slack = np.array([_ROUGH if surface.roughness > FACETED else 1.0 for surface in surfaces])
    alike = _alike(prints, areas, sizes, config.cluster_tolerance * np.maximum(slack[:, None], slack[None]))
    labels = np.arange(len(surfaces))
    for a, b in zip(*np.nonzero(np.triu(alike, k=1)), strict=True):
        limit = config.cluster_tolerance * 2 * max(sizes[a], sizes[b])
        # Only the groups matter: what others have joined already needs no comparison of its own.
        if labels[a] != labels[b] and aligned_chamfer(shapes[a], shapes[b], enough=limit) <= limit:
            labels[labels == labels[b]] = labels[a]
    groups = [tuple(np.flatnonzero(labels == label).tolist()) for label in np.unique(labels)]
    return tuple(sorted(group for group in groups if len(group) > 1))


def aligned_chamfer(first: FloatArray, second: FloatArray, *, enough: float = 0.0) -> float:
    """Mean nearest-neighbour distance [m], both ways, of two centred clouds after the best alignment of their axes.

    Principal axes are tried with all signs and, since equal spreads leave their order open, all orders, so mirrored
    twins match. Clouds of shape (n, 3) and (m, 3). The first alignment that is at most `enough` apart ends the search.
    """
    one, other = first @ _principal_axes(first), second @ _principal_axes(second)
    tree_of_one, tree_of_other = cKDTree(one), cKDTree(other)
    best = np.inf
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            there = float(tree_of_one.query(other[:, order] * signs)[0].mean())
            if there < 2 * best:  # the way back can halve the mean at best
                back = float(tree_of_other.query((one * signs)[:, np.argsort(order)])[0].mean())
                best = min(best, 0.5 * (there + back))
                if best <= enough:
                    return best
    return best


def _centred_samples(surface: PartSurface, count: int, seed: int) -> FloatArray:
    points = surface.sample(count, seed=seed).points
    return points - surface.part.centroid if len(points) else np.zeros((1, 3))


def _fingerprint(points: FloatArray) -> FloatArray:
    """Quantiles of the distance from the centroid and the principal spreads [m], shape (12,)."""
    radii = np.quantile(np.linalg.norm(points, axis=1), _PROFILE_QUANTILES)
    spreads = np.sqrt(np.maximum(np.linalg.eigvalsh(points.T @ points / len(points)), 0))
    return np.concatenate([radii, spreads])


def _alike(prints: FloatArray, areas: FloatArray, sizes: FloatArray, tolerance: FloatArray) -> NDArray[np.bool_]:
    """Matrix of pairs that may be congruent within a tolerance per pair, shape (n, n)."""
    scale = np.maximum(sizes[:, None], sizes[None])
    difference = np.abs(prints[:, None] - prints[None]).max(axis=2)
    area_ratio = np.minimum(areas[:, None], areas[None]) / np.maximum(np.maximum(areas[:, None], areas[None]), 1e-300)
    close = difference <= 2.5 * tolerance * scale
    return np.asarray(close & (area_ratio > 1 - 4 * tolerance))


def _principal_axes(points: FloatArray) -> FloatArray:
    return np.linalg.eigh(points.T @ points)[1]
