"""Convex pieces with few vertices, and points on surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull, QhullError, cKDTree

from kinematify.robot.vectors import crossed, lengths_of, triangle_normals

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray


_PRECISION = 1e-6  # axes between which extents differ by less than this fraction are not distinguished


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
    inward = np.einsum("ij,ij->i", triangle_normals(vertices[faces]), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return vertices, faces


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


_CLOSED = 1e-6
"""Sum of the area vectors of a closed surface, fraction of its area."""
_BESIDE = 3e-4
"""Distance of two corners that are one, fraction of a piece's size."""
_CORNER = 1e-6
"""Least eigenvalue of the sum of n n^T over the unit normals n around a corner: 0 on edges and faces."""
_MANY = 100_000
"""Points of which the whole hull takes long: a second, if all are on it."""
_BLOCK = 16
"""Directions at a time: scans have millions of points."""
_GOLDEN = np.pi * (3.0 - np.sqrt(5.0))
_KRONECKER = np.array([0.7548776662466927, 0.5698402909980532])


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

    @cached_property
    def low(self) -> FloatArray:
        """Lower corner of the bounding box, shape (3,)."""
        return np.asarray(self.vertices.min(axis=0))

    @cached_property
    def high(self) -> FloatArray:
        """Upper corner."""
        return np.asarray(self.vertices.max(axis=0))

    @cached_property
    def area(self) -> float:
        """[m^2]."""
        return float(0.5 * lengths_of(triangle_normals(self.vertices[self.faces])).sum())


def convex_piece(points: FloatArray, *, thickness: float, directions: int) -> ConvexPiece:
    """Return the hull of the points, reduced to what engines handle quickly.

    Args:
        points: Shape (n, 3), at least one.
        thickness: Flat sets of points are given this thickness [m]: no engine makes a hull of a plane.
        directions: The piece keeps the outermost point in each of so many directions; corners always stay, but of more
            points than `_MANY` those that are outermost in no direction of four times as many.
    """
    if len(points) > _MANY:
        points = outermost(points, 4 * directions)
    vertices, faces = convex_hull(thickened(points, thickness))
    if len(vertices) > directions:
        vertices, faces = convex_hull(thickened(outermost(vertices, directions), thickness))
    return ConvexPiece(vertices=vertices, faces=faces)


def enclosing_piece(points: FloatArray, *, directions: int) -> ConvexPiece:
    """Return a hull around points that has at most so many corners, a little larger than theirs where they are more.

    Args:
        points: Shape (n, 3); they span a volume.
        directions: As in `convex_piece`.
    """
    vertices, faces = convex_hull(points)
    if len(vertices) > directions:
        middle = vertices.mean(axis=0)
        few, faces = convex_hull(outermost(vertices, directions) - middle)
        a, b, c = (few[faces[:, k]] for k in range(3))
        normals = crossed(b - a, c - a)
        reach = (normals @ (vertices - middle).T).max(axis=1) / np.einsum("ij,ij->i", normals, a)
        vertices = few * reach.max() + middle
    return ConvexPiece(vertices=vertices, faces=faces)


def plain_piece(piece: ConvexPiece) -> ConvexPiece:
    """Return the hull of a piece's corners: points on edges and faces, and corners beside another one, make slivers.

    It lies within the piece.
    """
    vertices = piece.vertices
    near = cKDTree(vertices).query_pairs(_BESIDE * float(np.linalg.norm(piece.high - piece.low)), output_type="ndarray")
    normals = triangle_normals(vertices[piece.faces])
    normals /= np.maximum(lengths_of(normals), 1e-300)[:, None]
    spread = np.zeros((len(vertices), 3, 3))
    for k in range(3):
        np.add.at(spread, piece.faces[:, k], normals[:, :, None] * normals[:, None, :])
    corner = np.linalg.eigvalsh(spread)[:, 0] > _CORNER
    corner[near[:, 1]] = False
    try:
        kept, faces = convex_hull(vertices[corner])
    except (QhullError, ValueError):  # too thin to lose any
        return piece
    return ConvexPiece(vertices=kept, faces=faces)


def outermost(points: FloatArray, directions: int) -> FloatArray:
    """Return the points that lie farthest out in each of so many directions, shape (k, 3): their hull, nearly."""
    if not len(points):
        return points
    shifted = points - points[0]
    farthest = [
        np.argmax(block @ shifted.T, axis=1)  # along rows of memory, a quarter of the time that columns take
        for block in np.array_split(_directions(directions), -(-directions // _BLOCK))
    ]
    return np.asarray(points[np.unique(np.concatenate(farthest))])


@cache
def _directions(count: int) -> FloatArray:
    """Unit vectors, evenly spread (spherical Fibonacci), shape (count, 3)."""
    k = np.arange(count) + 0.5
    height = 1.0 - 2.0 * k / count
    radius, angle = np.sqrt(1.0 - height**2), _GOLDEN * k
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)


def signed_volume(vertices: FloatArray, faces: IntArray) -> float:
    """Enclosed volume [m^3], positive where faces look outward; meaningless for open meshes."""
    a, b, c = (vertices - vertices.mean(axis=0))[faces.T]
    return float(np.einsum("ij,ij->", a, crossed(b, c)) / 6.0)


def enclosed_volume(vertices: FloatArray, faces: IntArray) -> float | None:
    """Volume inside a surface [m^3]; None where it is open or encloses nothing."""
    areas = 0.5 * triangle_normals(vertices[faces])
    if np.linalg.norm(areas.sum(axis=0)) > _CLOSED * float(lengths_of(areas).sum()):
        return None
    return abs(signed_volume(vertices, faces)) or None


def surface_points(vertices: FloatArray, faces: IntArray, count: int) -> FloatArray:
    """Return points on a mesh, evenly by area, shape (count, 3).

    Args:
        vertices: Shape (V, 3).
        faces: Shape (F, 3), at least one with an area.
        count: How many.
    """
    corners = vertices[faces]
    areas = lengths_of(triangle_normals(corners))
    ends = np.cumsum(areas)
    number = np.arange(count)
    face = np.minimum(np.searchsorted(ends, (number + 0.5) * (ends[-1] / count)), len(faces) - 1)
    # A low-discrepancy sequence in the unit square, folded into the triangle.
    first, second = ((number[:, None] * _KRONECKER + 0.5) % 1.0).T
    over = first + second > 1.0
    first, second = np.where(over, 1.0 - first, first), np.where(over, 1.0 - second, second)
    a, b, c = (corners[face, k] for k in range(3))
    return np.asarray(a + first[:, None] * (b - a) + second[:, None] * (c - a))
