"""Convex pieces with few vertices, and how far they reach beyond the surface that they stand for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import igl
import numpy as np

from kinematify.geometry.hull import convex_hull, thickened

if TYPE_CHECKING:
    from kinematify.assembly.part import FloatArray, IntArray

_GOLDEN = np.pi * (3.0 - np.sqrt(5.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class ConvexPiece:
    """A closed convex mesh, faces outward."""

    vertices: FloatArray
    """Shape (V, 3)."""
    faces: IntArray
    """Shape (F, 3)."""

    @cached_property
    def volume(self) -> float:
        """[m^3]."""
        return signed_volume(self.vertices, self.faces)


def convex_piece(points: FloatArray, *, thickness: float, directions: int) -> ConvexPiece:
    """Return the hull of the points, reduced to what engines handle quickly.

    Args:
        points: Shape (n, 3), at least one.
        thickness: Flat sets of points are given this thickness [m]: no engine makes a hull of a plane.
        directions: The piece keeps the outermost point in each of so many directions; corners always stay.
    """
    vertices, faces = convex_hull(thickened(points, thickness))
    if len(vertices) > directions:
        vertices, faces = convex_hull(thickened(outermost(vertices, directions), thickness))
    return ConvexPiece(vertices=vertices, faces=faces)


def outermost(points: FloatArray, directions: int) -> FloatArray:
    """Return the points that lie farthest out in each of so many directions, shape (k, 3): their hull, nearly."""
    if not len(points):
        return points
    return np.asarray(points[np.unique(np.argmax(_directions(directions) @ (points - points[0]).T, axis=1))])


def _directions(count: int) -> FloatArray:
    """Unit vectors, evenly spread (spherical Fibonacci), shape (count, 3)."""
    k = np.arange(count) + 0.5
    height = 1.0 - 2.0 * k / count
    radius, angle = np.sqrt(1.0 - height**2), _GOLDEN * k
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)


def signed_volume(vertices: FloatArray, faces: IntArray) -> float:
    """Enclosed volume [m^3], positive where faces look outward; meaningless for open meshes."""
    a, b, c = (vertices[faces[:, k]] - vertices.mean(axis=0) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def reach(piece: ConvexPiece, tree: igl.AABB, vertices: FloatArray, faces: IntArray) -> float:
    """How far the surface of a piece lies from a mesh at most [m], over its face centres and edge middles."""
    corners = piece.vertices[piece.faces]
    probes = np.concatenate([corners.mean(axis=1), 0.5 * (corners + np.roll(corners, 1, axis=1)).reshape(-1, 3)])
    squared, _, _ = tree.squared_distance(vertices, faces, np.ascontiguousarray(probes))
    return float(np.sqrt(np.max(squared, initial=0.0)))
