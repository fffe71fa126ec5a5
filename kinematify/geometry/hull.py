"""Convex hulls that always enclose a volume, whatever mesh they come from."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull

from kinematify.robot.vectors import crossed

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray

_PRECISION = 1e-6  # axes between which extents differ by less than this fraction are not told apart


def convex_hull(points: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the convex hull of points that span a volume as an outward-facing closed mesh.

    Args:
        points: Shape (n, 3); at least four, not coplanar (see `thickened`).

    Returns:
        Vertices (h, 3) and faces (f, 3).
    """
    scale = float(np.ptp(points, axis=0).max())
    # Qhull's tolerances are absolute: very small or very distant parts must be brought to unit size first.
    hull = ConvexHull((points - points.mean(axis=0)) / scale)
    index = np.full(len(points), -1)
    index[hull.vertices] = np.arange(len(hull.vertices))
    faces = index[hull.simplices]
    vertices: FloatArray = points[hull.vertices]
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", crossed(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return vertices, faces.astype(np.int64)


def thickened(points: FloatArray, thickness: float) -> FloatArray:
    """Spread points to both sides along every principal direction in which they extend less than `thickness`.

    Args:
        points: Shape (n, 3), at least one.
        thickness: Smallest extent that is kept [m].

    Returns:
        The points themselves where they are thick enough, else two copies per flat direction, `thickness` apart.
    """
    axes = _principal_axes(points)
    for axis, extent in zip(axes, np.ptp(points @ axes.T, axis=0), strict=True):
        if extent < thickness:
            offset = 0.5 * (thickness - extent) * axis
            points = np.concatenate([points + offset, points - offset])
    return points


def _principal_axes(points: FloatArray) -> FloatArray:
    """Rows are the principal directions of the point set, world axes where it is the same in all directions."""
    centred = points - points.mean(axis=0)
    scale = float(np.abs(centred).max())
    if scale == 0.0:
        return np.eye(3)
    spread = (centred / scale).T @ (centred / scale)
    values, vectors = np.linalg.eigh(spread)
    axes: FloatArray = np.eye(3) if np.ptp(values) < _PRECISION * values[-1] else vectors.T
    return axes
