"""A body's triangles as closed shells, which have an inside, and open sheets, which have none.

Meshes from the wild have faces twice, faces turned over and small holes. Faces are therefore merged and turned the
same way first, and a shell counts as closed where its holes are small against its surface. A box of five sheets
stays a sheet: what stands in it is not inside it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import igl
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray

    BoolArray = NDArray[np.bool_]

_WELD = 1e-6  # of the largest extent: corners in one cell of this size are the same
_CELLS = 1 << 20  # more cells than an extent has


@dataclass(frozen=True, kw_only=True, eq=False)
class Shells:
    """Triangles of one body, equal corners merged, faces of a patch turned the same way."""

    vertices: FloatArray
    """Body frame [m], shape (V, 3)."""
    closed: IntArray
    """Faces of closed shells, outward, shape (C, 3)."""
    sheets: IntArray
    """All other faces, shape (S, 3)."""

    @property
    def faces(self) -> IntArray:
        """All faces, shape (C + S, 3)."""
        return np.concatenate([self.closed, self.sheets])


def shells_of(vertices: FloatArray, faces: IntArray, *, hole: float) -> Shells:
    """Split a mesh.

    Args:
        vertices: Shape (V, 3).
        faces: Shape (F, 3).
        hole: Area of the holes of a shell that still counts as closed, fraction of its surface.
    """
    points, triangles = _merged(vertices, faces)
    if not len(triangles):
        return Shells(vertices=points, closed=triangles, sheets=triangles)
    triangles, patch = _turned(points, triangles)
    edges = _Edges(triangles, len(points))
    shell = edges.joined(patch)
    closed = (edges.hole_areas(points, shell) <= hole * _areas(points, triangles, shell))[shell]
    return Shells(vertices=points, closed=triangles[closed], sheets=triangles[~closed])


def _merged(points: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Merge corners in one cell of a fine lattice, and drop faces that lose a corner or that are there twice."""
    if not len(faces):
        return points, faces
    low, extent = points.min(axis=0), max(float(np.ptp(points, axis=0).max()), 1e-300)
    cells = np.round((points - low) / (_WELD * extent)).astype(np.int64)
    _, first, name = np.unique(cells @ (_CELLS ** np.arange(3)), return_index=True, return_inverse=True)
    faces = name.reshape(-1)[faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    a, b, c = np.sort(faces, axis=1).T
    order = np.lexsort((c, b, a))
    ranked = np.stack([a, b, c], axis=1)[order]
    new = np.ones(len(faces), dtype=bool)
    new[1:] = (ranked[1:] != ranked[:-1]).any(axis=1)
    return points[first], faces[np.sort(order[new])]


def _turned(points: FloatArray, given: IntArray) -> tuple[IntArray, IntArray]:
    """Turn the faces of each patch the same way; returns them (F, 3) with their patches (F,).

    A patch looks where most of its faces looked. One that encloses a negative volume is the wall of a cavity if it
    lies in another patch, and inside out otherwise.
    """
    faces, patch = igl.bfs_orient(np.ascontiguousarray(given))
    count = int(patch.max()) + 1
    corners = points[faces]
    middle = _sums(patch, corners.mean(axis=1), count) / np.maximum(np.bincount(patch, minlength=count), 1)[:, None]
    local = corners - middle[patch][:, None]
    volume = np.bincount(patch, np.einsum("fi,fi->f", local[:, 0], crossed(local[:, 1], local[:, 2])), count)
    kept = np.bincount(patch, np.where((faces == given).all(axis=1), 1.0, -1.0), count) >= 0.0
    asked = np.where(kept, volume, -volume)
    flip = np.where((asked < 0.0) & ~_enclosed(corners, patch, asked), kept, ~kept)
    return np.where(flip[patch][:, None], faces[:, ::-1], faces), patch


def _enclosed(corners: FloatArray, patch: IntArray, volume: FloatArray) -> BoolArray:
    """Which patches of negative volume lie in the box of one of positive and larger volume, shape (patches,)."""
    count = len(volume)
    if not (volume < 0.0).any():
        return np.zeros(count, dtype=bool)
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, patch, corners.min(axis=1))
    np.maximum.at(high, patch, corners.max(axis=1))
    found = np.zeros(count, dtype=bool)
    outer = np.flatnonzero(volume > 0.0)
    for index in np.flatnonzero(volume < 0.0):
        within = (low[outer] <= low[index]).all(axis=1) & (high[outer] >= high[index]).all(axis=1)
        found[index] = (within & (volume[outer] > -volume[index])).any()
    return found


class _Edges:
    """Sides of the faces, and which of them lie on one another."""

    def __init__(self, faces: IntArray, points: int) -> None:
        self._sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        low, high = np.sort(self._sides, axis=1).T
        _, self._first, name, self._uses = np.unique(
            low * points + high, return_index=True, return_inverse=True, return_counts=True
        )
        self._name = name.reshape(-1)

    def joined(self, patch: IntArray) -> IntArray:
        """Shell of every face: patches that share an edge belong together, as where three walls meet."""
        owner = np.tile(patch, 3)
        count, edges = int(patch.max()) + 1, len(self._uses)
        links = coo_array((np.ones(len(owner), dtype=np.int8), (owner, count + self._name)), shape=(count + edges,) * 2)
        _, group = connected_components(links, directed=False)
        return np.asarray(np.unique(group[:count], return_inverse=True)[1].reshape(-1)[patch])

    def hole_areas(self, points: FloatArray, shell: IntArray) -> FloatArray:
        """Area that the boundary loops of each shell span [m^2]; an edge of one face only is boundary."""
        count = int(shell.max()) + 1
        rim = self._first[self._uses == 1]
        if not len(rim):
            return np.zeros(count)
        sides = self._sides[rim]
        links = coo_array((np.ones(len(rim), dtype=np.int8), tuple(sides.T)), shape=(len(points),) * 2)
        _, group = connected_components(links, directed=False)
        loops, loop = np.unique(group[sides[:, 0]], return_inverse=True)
        loop = loop.reshape(-1)
        start, end = points[sides[:, 0]], points[sides[:, 1]]
        origin = (_sums(loop, start, len(loops)) / np.bincount(loop)[:, None])[loop]
        area = lengths_of(_sums(loop, 0.5 * crossed(start - origin, end - origin), len(loops)))
        owner = np.zeros(len(loops), dtype=np.int64)
        owner[loop] = np.tile(shell, 3)[rim]
        return np.asarray(np.bincount(owner, area, count))


def _sums(index: IntArray, vectors: FloatArray, count: int) -> FloatArray:
    """Sum vectors (n, 3) by index, shape (count, 3)."""
    return np.stack([np.bincount(index, vectors[:, k], count) for k in range(3)], axis=1)


def _areas(points: FloatArray, faces: IntArray, shell: IntArray) -> FloatArray:
    corners = points[faces]
    cross = crossed(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(np.bincount(shell, 0.5 * lengths_of(cross)))
