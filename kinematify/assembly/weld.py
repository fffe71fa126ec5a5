"""Merging duplicate vertices, so that triangles which touch share corners."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

if TYPE_CHECKING:
    from kinematify.assembly.part import FloatArray, IntArray


def welded(vertices: FloatArray, faces: IntArray, tolerance: float) -> tuple[FloatArray, IntArray]:
    """Merge vertices that lie closer than a tolerance, and drop what is left without area or use.

    A merged vertex keeps the coordinates of its first one, so that an already clean mesh comes back unchanged. Faces
    that lose a corner or have all three corners on a line are dropped, and vertices that no face uses.

    Args:
        vertices: Finite positions, shape (V, 3).
        faces: Shape (F, 3).
        tolerance: Fraction of the mesh's bounding box diagonal.

    Returns:
        New vertices and faces; both may be empty.
    """
    used, corners = np.unique(faces, return_inverse=True)
    points = vertices[used]
    first, merged = _merged(points, tolerance * _diagonal(points))
    triangles = first[merged[corners.reshape(-1, 3)]]
    triangles = triangles[_has_area(points, triangles)]
    kept, triangles = np.unique(triangles, return_inverse=True)
    return points[kept], triangles.reshape(-1, 3).astype(np.int64)


def _diagonal(points: FloatArray) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0


def _merged(points: FloatArray, distance: float) -> tuple[IntArray, IntArray]:
    """First member of every group of near vertices, and the group of every vertex."""
    if not len(points):
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    # Equal vertices are most of the work in files without sharing (STL): out of the way before the search for near
    # ones. Adding zero makes -0.0 equal to 0.0.
    _, first, same = np.unique(points + 0.0, axis=0, return_index=True, return_inverse=True)
    distinct = points[first]
    pairs = cKDTree(distinct).query_pairs(distance, output_type="ndarray") if distance > 0 else np.empty((0, 2), int)
    links = coo_array((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=(len(distinct),) * 2)
    count, group = connected_components(links, directed=False)
    groups = group[same.reshape(-1)]
    earliest = np.full(count, len(points), dtype=np.int64)
    np.minimum.at(earliest, groups, np.arange(len(points)))
    return earliest, groups.astype(np.int64)


def _has_area(points: FloatArray, triangles: IntArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """False for triangles whose height is below the rounding of their longest side."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    sides = np.stack([b - a, c - b, a - c])
    longest = np.einsum("kfi,kfi->kf", sides, sides).max(axis=0, initial=0.0)
    double_area = np.linalg.norm(np.cross(sides[0], sides[1]), axis=1)
    answer: np.ndarray[tuple[int], np.dtype[np.bool_]] = double_area > _FLATTEST * longest
    return answer


_FLATTEST = 1e-12
"""Height over longest side of a triangle, below which its normal is noise of float64."""
