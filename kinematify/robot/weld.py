"""Merging duplicate vertices, so that triangles which touch share corners."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import used_vertices
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray

_SAME_PLACE = 1e-7
"""Fraction of the diagonal: above the rounding of float32 files."""


def welded(vertices: FloatArray, faces: IntArray, tolerance: float) -> tuple[FloatArray, IntArray]:
    """Return what `weld` returns without the faces that are kept."""
    points, triangles, _ = weld(vertices, faces, tolerance)
    return points, triangles


def weld(vertices: FloatArray, faces: IntArray, tolerance: float) -> tuple[FloatArray, IntArray, IntArray]:
    """Merge vertices that lie closer than a tolerance, and drop what is left without area or use.

    A merged vertex keeps the coordinates of its first one, so that an already clean mesh comes back unchanged. Faces
    that lose a corner or have all three corners on a line are dropped, and vertices that no face uses.

    Args:
        vertices: Finite positions, shape (V, 3).
        faces: Shape (F, 3).
        tolerance: Fraction of the mesh's bounding box diagonal.

    Returns:
        New vertices and faces, which may be empty, and the index of each of these faces among those that were given.
    """
    points, triangles = without_unused(vertices, faces)
    first, merged = _merged(points, tolerance * _diagonal(points))
    triangles = first[merged[triangles]]
    kept = np.flatnonzero(_has_area(points, triangles))
    return (*without_unused(points, triangles[kept]), kept)


def without_unused(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the mesh without vertices that no face uses, the others in their order."""
    used = used_vertices(faces, len(vertices))
    if used.all():
        return vertices, faces
    place = np.cumsum(used) - 1
    return vertices[used], place[faces]


def snapped(vertices: FloatArray, faces: IntArray, cells: int) -> tuple[FloatArray, IntArray]:
    """Replace the vertices of each cell of a grid by the one farthest out, and drop faces that lose a corner.

    Args:
        vertices: Shape (V, 3).
        faces: Shape (F, 3).
        cells: Cells along the diagonal; no vertex moves by more than the diagonal of one.
    """
    width = _diagonal(vertices) / cells
    outward = np.argsort(-lengths_of(vertices - vertices.mean(axis=0)), kind="stable")
    places = np.round(vertices[outward] / width).astype(np.int64)
    places -= places.min(axis=0)
    x, y, z = places.T
    size = cells + 2
    _, first, merged = np.unique((x * size + y) * size + z, return_index=True, return_inverse=True)
    cell_of = np.empty(len(vertices), dtype=np.int64)
    cell_of[outward] = merged.reshape(-1)
    moved = cell_of[faces]
    kept = (moved[:, 0] != moved[:, 1]) & (moved[:, 1] != moved[:, 2]) & (moved[:, 2] != moved[:, 0])
    _, distinct = np.unique(np.sort(moved[kept], axis=1), axis=0, return_index=True)
    return vertices[outward[first]], moved[kept][distinct]


def is_closed(vertices: FloatArray, faces: IntArray) -> bool:
    """Return True if every directed edge is met by its reverse: the boundary of the surface is empty.

    Args:
        vertices: Shape (V, 3); those at the same place count as one, as STL and other soups repeat them for every face.
        faces: Shape (F, 3), at least one.
    """
    keys = np.round((vertices - vertices.min(axis=0)) / max(_SAME_PLACE * _diagonal(vertices), 1e-300))
    _, place = np.unique(keys.astype(np.int64), axis=0, return_inverse=True)
    corners = place.reshape(-1)[faces]
    start, end = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
    count = int(corners.max()) + 1
    return bool(np.array_equal(np.sort(start * count + end), np.sort(end * count + start)))


def _diagonal(points: FloatArray) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0


def _merged(points: FloatArray, distance: float) -> tuple[IntArray, IntArray]:
    """First member of every group of near vertices, and the group of every vertex."""
    if not len(points):
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    # They take half a second to load, and many read a file's links and joints alone.
    from scipy.sparse import coo_array  # noqa: PLC0415
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415
    from scipy.spatial import cKDTree  # noqa: PLC0415

    # Equal vertices are most of the work in files without sharing (STL): out of the way before the search for near
    # ones.
    first, same = _equal_rows(points)
    distinct = points[first]
    pairs = cKDTree(distinct).query_pairs(distance, output_type="ndarray") if distance > 0 else np.empty((0, 2), int)
    links = coo_array((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=(len(distinct),) * 2)
    count, group = connected_components(links, directed=False)
    groups = group[same]
    earliest = np.empty(count, dtype=np.int64)
    earliest[groups[::-1]] = np.arange(len(points))[::-1]  # of several, the one that is written last stays
    return earliest, groups.astype(np.int64)


def _equal_rows(points: FloatArray) -> tuple[IntArray, IntArray]:
    """Index of the first of every set of equal rows, and the set of every row.

    Sorting one hash per row instead of the rows is ten times faster on millions of them; a collision, should there
    ever be one, only leaves equal rows for the search for near ones to find.
    """
    hashes = np.zeros(len(points), dtype=np.uint64)
    for k in range(3):
        hashes ^= (points[:, k] + 0.0).view(np.uint64)  # adding zero makes -0.0 equal to 0.0
        hashes *= _ODD
        hashes ^= hashes >> np.uint64(32)
    # As `np.unique` does, in a third of its memory.
    order = np.argsort(hashes, kind="stable")
    hashes = hashes[order]
    begins = np.append(True, hashes[1:] != hashes[:-1])
    first = order[begins]
    same = np.empty_like(order)
    same[order] = np.cumsum(begins) - 1
    collided = np.zeros(len(points), dtype=bool)
    for k in range(3):
        collided |= points[first, k][same] != points[:, k]
    if collided.any():
        alone = np.flatnonzero(collided)
        same[alone] = len(first) + np.arange(len(alone))
        first = np.concatenate([first, alone])
    return first, same


def _has_area(points: FloatArray, triangles: IntArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """False for triangles whose height is below the rounding of their longest side."""
    answer = np.empty(len(triangles), dtype=np.bool_)
    for start in range(0, len(triangles), _BLOCK):
        rows = slice(start, start + _BLOCK)
        a, b, c = (points[triangles[rows, k]] for k in range(3))
        sides = np.stack([b - a, c - b, a - c])
        longest = np.einsum("kfi,kfi->kf", sides, sides).max(axis=0, initial=0.0)
        answer[rows] = lengths_of(crossed(sides[0], sides[1])) > _FLATTEST * longest
    return answer


_ODD = np.uint64(0x9E3779B97F4A7C15)
"""An odd number with well mixed bits."""
_BLOCK = 500_000
"""Triangles at a time."""
_FLATTEST = 1e-12
"""Height over longest side of a triangle, below which its normal is noise of float64."""
