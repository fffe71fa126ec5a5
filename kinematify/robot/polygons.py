"""Polygons of mesh files become triangles that lie inside of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import manifold3d
import numpy as np

from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray


def triangle_places(points: FloatArray, sizes: IntArray) -> IntArray:
    """Return the triangles of polygons as places in `points`, shape (T, 3): `size - 2` of each polygon, in their order.

    A fan from the first corner where it lies inside of the polygon, else the ears that manifold3d cuts: it keeps
    corners on straight edges, which mapbox_earcut drops, so that a closed surface stays closed.

    Args:
        points: Corners of all polygons, one after another, shape (n, 3).
        sizes: Number of corners of each polygon, at least 3, shape (p,).
    """
    starts = np.cumsum(sizes) - sizes
    polygon = np.repeat(np.arange(len(sizes)), sizes - 2)
    step = np.arange(len(polygon)) - np.repeat(np.cumsum(sizes - 2) - (sizes - 2), sizes - 2)
    triangles: IntArray = starts[polygon][:, None] + np.stack([np.zeros_like(step), step + 1, step + 2], axis=1)
    if not (sizes > 3).any():
        return triangles
    normals = crossed(
        points[triangles[:, 1]] - points[triangles[:, 0]], points[triangles[:, 2]] - points[triangles[:, 0]]
    )
    sums = [np.bincount(polygon, normals[:, k], len(sizes)) for k in range(3)]
    whole = np.array(sums, dtype=np.float64).T
    turned = (normals * whole[polygon]).sum(axis=1) < -_FLAT * lengths_of(normals) * lengths_of(whole)[polygon]
    for k in np.unique(polygon[turned]):
        corners = points[starts[k] : starts[k] + sizes[k]]
        # Seen along the axis that the polygon faces most, with its corners counter-clockwise.
        axis = int(np.argmax(np.abs(whole[k])))
        seen = np.roll(np.arange(3), -axis - 1)[:2]
        flat = corners[:, seen] * np.array([np.sign(whole[k, axis]), 1.0])
        ears = manifold3d.triangulate([flat - flat[0]])
        if len(ears) == sizes[k] - 2:  # a polygon that crosses itself may have fewer
            triangles[polygon == k] = starts[k] + ears
    return triangles


_FLAT = 1e-9
"""Sine of the angle below which a triangle of a fan is a line."""
