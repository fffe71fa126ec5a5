"""Normals of meshes whose vertices are noisy: how rough a surface is, and normals that look past the noise."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.vectors import crossed, dots, lengths_of

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray

ROUGH = 0.6
"""A surface is noisy where so much of its area belongs to faces that bend both ways; random bends give 3/4."""
_BEND = np.sin(np.radians(4.0))  # a bend; those of fine tessellations are smaller
NOISE_ROUNDS = 8
"""Rounds of averaging that reach about as many faces away, some fifty faces: what vertex noise needs."""
FACET_ROUNDS = 2
"""Rounds that reach the faces around a face: what coarse facets and the steps of voxels need."""
_ACROSS = 0.5  # normals farther apart than 60 deg belong to different surfaces


def bends_both_ways(centres: FloatArray, normals: FloatArray, areas: FloatArray, pairs: IntArray) -> float:
    """Share of the area of faces with a convex and a concave neighbour, both bent by more than a few degrees.

    A design has flat, convex and concave places, and few faces that are both; noise bends each edge at random.

    Args:
        centres: Of the faces [m], shape (F, 3).
        normals: Unit normals, shape (F, 3).
        areas: Shape (F,).
        pairs: Faces that share an edge, shape (P, 2).
    """
    if not len(pairs) or areas.sum() <= 0:
        return 0.0
    first, second = pairs[:, 0], pairs[:, 1]
    across = centres[second] - centres[first]
    bend = lengths_of(crossed(normals[first], normals[second])) > _BEND
    concave = dots(across, normals[first] - normals[second]) > 0
    ways = []
    for chosen in (bend & concave, bend & ~concave):
        has = np.zeros(len(areas), dtype=bool)
        has[first[chosen]] = has[second[chosen]] = True
        ways.append(has)
    return float(areas[ways[0] & ways[1]].sum() / areas.sum())


def filtered_normals(normals: FloatArray, areas: FloatArray, pairs: IntArray, *, rounds: int) -> FloatArray:
    """Average every normal with those of the faces around it, less with those that differ more: edges stay.

    Args:
        normals: Unit normals of the faces, shape (F, 3).
        areas: Shape (F,).
        pairs: Faces that share an edge, shape (P, 2).
        rounds: `NOISE_ROUNDS` or `FACET_ROUNDS`.
    """
    first, second = np.concatenate([pairs[:, 0], pairs[:, 1]]), np.concatenate([pairs[:, 1], pairs[:, 0]])
    result = normals
    for _ in range(rounds):
        alike = np.maximum(dots(result[first], result[second]) - _ACROSS, 0.0) ** 2 * areas[second]
        total = result * (areas * (1.0 - _ACROSS) ** 2)[:, None]
        for axis in range(3):
            total[:, axis] += np.bincount(first, alike * result[second, axis], minlength=len(areas))
        result = total / np.maximum(lengths_of(total), 1e-300)[:, None]
    return result


def mean_deviation(normals: FloatArray, others: FloatArray, areas: FloatArray) -> float:
    """Mean angle over the area between two sets of unit normals (F, 3) of the same faces [deg]."""
    if areas.sum() <= 0:
        return 0.0
    angles = np.degrees(np.arccos(np.clip(dots(normals, others), -1.0, 1.0)))
    return float(angles @ areas / areas.sum())
