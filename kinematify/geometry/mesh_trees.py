"""Trees over the triangles of a mesh: distances and winding numbers of many points at once.

Points are asked about along a curve through space. What one needs of the tree is then still in the processor's cache
from the one before: distances take half the time, and the answers are the same to the last digit.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import fcl
import igl
import numpy as np

from kinematify.geometry.sampling import morton_codes

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray

_CELLS = 2**6
"""Cells of the curve along the longest side of the box around the points."""
_FEW = 64
"""So many points are not worth an order."""


class DistanceTree:
    """Nearest places on a mesh."""

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        """Build the tree; vertices (V, 3) near the origin, because squares far from it lose digits, faces (F, 3)."""
        self.vertices, self.faces = np.ascontiguousarray(vertices), np.ascontiguousarray(faces)
        self._tree = igl.AABB()
        self._tree.init(self.vertices, self.faces)

    def nearest(self, points: FloatArray) -> tuple[FloatArray, IntArray, FloatArray]:
        """Unsigned distances (n,), faces (n,) and places on them (n, 3) that are nearest to points (n, 3)."""
        order = _along_curve(points)
        sorted_points = np.ascontiguousarray(points[order])
        squares, faces, places = self._tree.squared_distance(self.vertices, self.faces, sorted_points)
        back = _inverse(order)
        return np.sqrt(np.maximum(squares, 0.0))[back], faces[back], places[back]

    def distances(self, points: FloatArray) -> FloatArray:
        """Unsigned distances (n,) of points (n, 3)."""
        return self.nearest(points)[0]


class WindingTree:
    """Winding numbers about a mesh: 1 inside and 0 outside of it where it is closed."""

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        """Build the tree; vertices (V, 3), faces (F, 3)."""
        self._tree = igl.FastWindingNumberBVH()
        self._tree.init(np.ascontiguousarray(vertices), np.ascontiguousarray(faces))

    def numbers(self, points: FloatArray, accuracy: float = 2.0) -> FloatArray:
        """Winding numbers (n,) at points (n, 3); far triangles are summed up the more coarsely the lower `accuracy`."""
        order = _along_curve(points)
        found = self._tree.winding_number(np.ascontiguousarray(points[order]), accuracy)
        return np.asarray(found[_inverse(order)])


def collision_tree(vertices: FloatArray, faces: IntArray) -> fcl.BVHModel:
    """FCL tree of the triangles (F, 3) between vertices (V, 3)."""
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(vertices, faces.tolist())
    model.endModel()
    return model


def _along_curve(points: FloatArray) -> IntArray:
    """Order of points (n, 3) along the curve, shape (n,)."""
    if len(points) < _FEW:
        return np.arange(len(points))
    low = points.min(axis=0)
    width = float((points.max(axis=0) - low).max())
    cells = ((points - low) * ((_CELLS - 1) / max(width, 1e-300))).astype(np.int64)
    return np.argsort(morton_codes(cells), kind="stable")


def _inverse(order: IntArray) -> IntArray:
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    return places
