"""Exact distances to one body: how deep points lie in it, how far they are from it, and its FCL tree.

FCL decides whether two bodies collide; it cannot say how deep (its depth between meshes is meaningless), so depth is
that of sampled points of one body below the surface of the other one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import igl
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kinematify.geometry.mesh_trees import DistanceTree, WindingTree, collision_tree
from kinematify.geometry.rays import RayScene
from kinematify.geometry.sampling import curve_order, place_samples
from kinematify.robot.vectors import all_three, crossed, highest, lengths_of, lowest, referenced, triangle_normals

if TYPE_CHECKING:
    from collections.abc import Callable

    import fcl
    from numpy.typing import NDArray

    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


_ASKEW = np.array([0.36, 0.48, 0.8])  # along no edge of furniture
_SHARP = np.cos(np.radians(30.0))  # edges of facets of a cylinder of 12 sides are no edges


class Solid:
    """One body in its own frame; each structure is built when first asked for."""

    def __init__(
        self,
        vertices: FloatArray,
        faces: IntArray,
        *,
        unit: float,
        hole: float,
        points: int,
        measured: Callable[[], tuple[FloatArray, IntArray]] | None = None,
    ) -> None:
        """Keep the mesh.

        Args:
            vertices: Body frame [m], shape (V, 3).
            faces: Shape (F, 3), at least one.
            unit: Length of one unit of the FCL tree [m]; FCL takes short lengths for none.
            hole: See `shells_of`.
            points: Number of points that represent the surface in questions of depth.
            measured: Gives a simpler mesh with the same box, which all else is asked of.
        """
        self._measured = measured or (lambda: (vertices, faces))
        self._unit, self._hole, self._count = unit, hole, points
        used = referenced(vertices, faces)
        self.low, self.high = lowest(used), highest(used)

    @property
    def size(self) -> float:
        """Diagonal of the box in the body's frame [m]."""
        return float(np.linalg.norm(self.high - self.low))

    @property
    def middle(self) -> FloatArray:
        """Middle of the box, body frame [m], shape (3,)."""
        return np.asarray(0.5 * (self.low + self.high))

    @cached_property
    def shells(self) -> Shells:
        """Closed shells and sheets."""
        return shells_of(*self._measured(), hole=self._hole)

    @cached_property
    def points(self) -> FloatArray:
        """Corners, places on sharp edges and places on the surface, body frame [m], shape (n, 3)."""
        vertices, faces = self.shells.vertices, self.shells.faces
        if not len(faces):
            return vertices
        share = self._count // 3
        edges = _sharp_edges(vertices, faces)
        corners = vertices[np.unique(edges)] if len(edges) else vertices
        areas = 0.5 * lengths_of(triangle_normals(vertices[faces]))
        picked, weights = place_samples(vertices[faces], areas, curve_order(vertices[faces], areas), share, 0)
        surface = np.einsum("nk,nkd->nd", weights, vertices[faces[picked]])
        return np.concatenate([thinned(corners, share), _along(vertices[edges], share), surface])

    @cached_property
    def tree(self) -> fcl.BVHModel:
        """FCL tree, centred at `middle`, in units of `unit`."""
        return collision_tree(self._local(self.shells.vertices) / self._unit, self.shells.faces)

    def deepest(self, points: FloatArray) -> FloatArray:
        """Largest depth of each set of points in the closed shells [m], body frame (n, p, 3) -> (n,).

        The winding number is asked for only where a doubtful point would be the deepest one.
        """
        flat, depth = points.reshape(-1, 3), np.zeros(points.shape[:2])
        sure, doubtful = self._by_rays(flat)
        within = np.flatnonzero(sure | doubtful)
        if len(within):
            claimed = self._closed.nearest(self._local(flat[within]))[0]
            depth.flat[within] = np.where(sure[within], claimed, 0.0)
            decides = doubtful[within] & (claimed > depth.max(axis=1)[within // points.shape[1]])
            if decides.any():
                depth.flat[within[decides]] = np.where(self._is_wound(flat[within[decides]]), claimed[decides], 0.0)
        return np.asarray(depth.max(axis=1))

    def contains(self, points: FloatArray) -> BoolArray:
        """Test whether points are in the closed shells, body frame (n, 3) -> (n,)."""
        found, doubtful = self._by_rays(points)
        if doubtful.any():
            found[doubtful] = self._is_wound(points[doubtful])
        return found

    def _by_rays(self, points: FloatArray) -> tuple[BoolArray, BoolArray]:
        """Where two opposite rays both meet a face from behind first, as inside, and where they disagree."""
        first, second = np.zeros((2, len(points)), dtype=bool)
        near = np.flatnonzero(all_three((points > self.low) & (points < self.high)) & bool(len(self.shells.closed)))
        if len(near):
            local = self._local(points[near])
            first[near], second[near] = (self._closed_rays.from_behind(local, along) for along in (_ASKEW, -_ASKEW))
        return first & second, first ^ second

    def _is_wound(self, points: FloatArray) -> BoolArray:
        """Test whether points are inside by the winding number, which is slow; rays disagree in shells that overlap."""
        return np.asarray(np.abs(self._winding.numbers(self._local(points))) > 0.5)

    def beside_sheets(self, points: FloatArray) -> FloatArray:
        """Distance of points from the sheets [m], body frame (n, 3) -> (n,); 0 where a rim is nearest.

        A point that went through a sheet stands behind it; one that is nearest to a rim may have gone round it.
        """
        distance, face, foot = self._sheets.nearest(self._local(points))
        on_rim = (self._rim[face] & _at_edges(self._sheets.vertices[self._sheets.faces[face]], foot)).any(axis=1)
        return np.where(on_rim, 0.0, distance)

    def meets(self, starts: FloatArray, steps: FloatArray, *, sheets: bool) -> BoolArray:
        """Test whether segments meet a sheet, or else a closed shell, body frame (n, 3) each -> (n,)."""
        met = np.zeros(len(starts), dtype=bool)
        if not len(self.shells.sheets if sheets else self.shells.closed):
            return met
        ends = starts + steps
        near = all_three((np.minimum(starts, ends) <= self.high) & (np.maximum(starts, ends) >= self.low))
        length = lengths_of(steps)
        rows = np.flatnonzero(near & (length > 0.0))
        if len(rows):
            along = steps[rows] / length[rows, None]
            rays = self._sheet_rays if sheets else self._closed_rays
            met[rows] = rays.first_hits(self._local(starts[rows]), along).distance < length[rows]
        return met

    def beside_closed(self, points: FloatArray) -> FloatArray:
        """Distance of points from the closed shells [m], body frame (n, 3) -> (n,)."""
        return self._closed.nearest(self._local(points))[0]

    def distance(self, points: FloatArray) -> FloatArray:
        """Distance of points from the surface [m], body frame (n, 3) -> (n,); infinite where there is none."""
        local, found = self._local(points), np.full(len(points), np.inf)
        if len(self.shells.closed):
            found = np.minimum(found, self._closed.nearest(local)[0])
        if len(self.shells.sheets):
            found = np.minimum(found, self._sheets.nearest(local)[0])
        return found

    def _local(self, points: FloatArray) -> FloatArray:
        return points - self.middle

    @cached_property
    def _winding(self) -> WindingTree:
        return WindingTree(self._closed.vertices, self._closed.faces)

    @cached_property
    def _closed(self) -> DistanceTree:
        return DistanceTree(self._local(self.shells.vertices), self.shells.closed)

    @cached_property
    def _sheets(self) -> DistanceTree:
        return DistanceTree(self._local(self.shells.vertices), self.shells.sheets)

    @cached_property
    def _closed_rays(self) -> RayScene:
        return RayScene([(self._closed.vertices, self._closed.faces)])

    @cached_property
    def _sheet_rays(self) -> RayScene:
        return RayScene([(self._sheets.vertices, self._sheets.faces)])

    @cached_property
    def _rim(self) -> BoolArray:
        """Which sides of a sheet's faces no other one has; side k is opposite corner k; shape (S, 3)."""
        edges = _Edges(self.shells.sheets, len(self.shells.vertices))
        return np.asarray(np.roll((edges.uses[edges.name] == 1).reshape(3, -1), -1, axis=0).T)


def _at_edges(corners: FloatArray, foot: FloatArray) -> BoolArray:
    """Test whether a place in a triangle lies on the side opposite each corner, shape (n, 3)."""
    u, v, w = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], foot - corners[:, 0]
    uu, uv, vv = (np.einsum("nd,nd->n", *pair) for pair in ((u, u), (u, v), (v, v)))
    wu, wv = np.einsum("nd,nd->n", w, u), np.einsum("nd,nd->n", w, v)
    scale = np.maximum(uu * vv - uv * uv, 1e-300)
    second, third = (vv * wu - uv * wv) / scale, (uu * wv - uv * wu) / scale
    return np.stack([1.0 - second - third, second, third], axis=1) < 1e-6


def _sharp_edges(vertices: FloatArray, faces: IntArray) -> IntArray:
    """Vertex pairs of edges that two faces do not share smoothly, shape (E, 2)."""
    cross = triangle_normals(vertices[faces])
    normals = cross / np.maximum(lengths_of(cross), 1e-300)[:, None]
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(faces)), 3)
    order = np.argsort(sides[:, 0] * len(vertices) + sides[:, 1], kind="stable")
    ranked, owner = sides[order], owner[order]
    start = np.flatnonzero(np.r_[True, (ranked[1:] != ranked[:-1]).any(axis=1)])
    uses = np.diff(np.r_[start, len(ranked)])
    second = np.minimum(start + 1, len(ranked) - 1)
    cosine = np.abs(np.einsum("nd,nd->n", normals[owner[start]], normals[owner[second]]))
    return np.asarray(ranked[start][(uses != 2) | (cosine < _SHARP)])


def thinned(points: NDArray[Any], count: int) -> NDArray[Any]:
    """Return at most `count` of the points, evenly from their list."""
    return points[:: max(1, -(-len(points) // max(count, 1)))]


def _along(ends: FloatArray, count: int) -> FloatArray:
    """Places at equal steps along pieces of edges (E, 2, 3) laid end to end, shape (count, 3)."""
    if not len(ends):
        return np.empty((0, 3))
    length = lengths_of(ends[:, 1] - ends[:, 0])
    total = np.cumsum(length)
    at = (np.arange(count) + 0.5) / count * total[-1]
    edge = np.minimum(np.searchsorted(total, at), len(ends) - 1)
    share = (at - total[edge] + length[edge]) / np.maximum(length[edge], 1e-300)
    return np.asarray(ends[edge, 0] + share[:, None] * (ends[edge, 1] - ends[edge, 0]))


_WELD = 1e-6  # of the largest extent: corners in one cell of this size are the same
_CELLS = 1 << 20  # more cells than an extent has


@dataclass(frozen=True, kw_only=True, eq=False)
class Shells:
    """Triangles of one body, equal corners merged, faces of a patch turned the same way.

    A shell counts as closed where its holes are small against its surface. A box of five sheets stays a sheet: what
    stands in it is not inside it.
    """

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
    points, triangles = merged_corners(vertices, faces)
    if not len(triangles):
        return Shells(vertices=points, closed=triangles, sheets=triangles)
    triangles, patch = _turned(points, triangles)
    edges = _Edges(triangles, len(points))
    shell = edges.joined(patch)
    areas = np.bincount(shell, 0.5 * lengths_of(triangle_normals(points[triangles])))
    closed = (edges.hole_areas(points, shell) <= hole * areas)[shell]
    return Shells(vertices=points, closed=triangles[closed], sheets=triangles[~closed])


def merged_corners(points: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
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
        _, self._first, name, self.uses = np.unique(
            low * points + high, return_index=True, return_inverse=True, return_counts=True
        )
        self.name = name.reshape(-1)

    def joined(self, patch: IntArray) -> IntArray:
        """Shell of every face: patches that share an edge belong together, as where three walls meet."""
        owner = np.tile(patch, 3)
        count, edges = int(patch.max()) + 1, len(self.uses)
        links = coo_array((np.ones(len(owner), dtype=np.int8), (owner, count + self.name)), shape=(count + edges,) * 2)
        _, group = connected_components(links, directed=False)
        return np.asarray(np.unique(group[:count], return_inverse=True)[1].reshape(-1)[patch])

    def hole_areas(self, points: FloatArray, shell: IntArray) -> FloatArray:
        """Area that the boundary loops of each shell span [m^2]; an edge of one face only is boundary."""
        count = int(shell.max()) + 1
        rim = self._first[self.uses == 1]
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
