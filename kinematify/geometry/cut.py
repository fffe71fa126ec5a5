"""Cutting concave surfaces into nearly convex pieces by planes.

Of all pieces of a model the one whose hull reaches farthest beyond its surface is cut next, where least is left to cut
on both sides, until none reaches farther than is tolerated or the number of cuts is spent. That is approximate convex
decomposition without its search: 20 ms a cut where CoACD takes 3 to 40 s for a mesh of furniture (measured, with its
quickest settings and pieces no closer). It takes open surfaces as they are, and parts the boards of furniture exactly,
because planes of large faces are tried first.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import fast_simplification
import numpy as np

from kinematify.geometry.convex import ConvexPiece, convex_piece, outermost, surface_points
from kinematify.geometry.mesh_trees import DistanceTree, WindingTree
from kinematify.processes.forked import each
from kinematify.robot.vectors import lengths_of, triangle_normals
from kinematify.robot.weld import snapped

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.robot.arrays import FloatArray, IntArray

_CORNERS = 48
"""Vertices of a hull while cuts are compared, at most."""
_PROBES = 128
"""Points of a hull at which its distance from the surface is measured."""
_BESIDE = 0.01
"""How far beside a face a plane stands, fraction of `_RIND`."""
_UNIFORM = (0.2, 0.35, 0.5, 0.65, 0.8)
"""Places of planes between the ends of a piece that are tried whatever its faces are."""
_FACE_PLANES = 6
"""Planes of faces that are tried per axis, the largest first."""
_PER_AXIS = 2
"""Planes across each axis that are tried in earnest."""
ALONG = 0.99
"""Cosine from which a face counts as lying across an axis."""
_RIND = 0.01
"""Planes nearer to the end of a piece are moved there, fraction of its extent: walls may have no thickness."""
_HOLES = 0.02
"""Share of open edges, and of the area that is missing, up to which a surface is closed."""
_AT_ONCE = 2
"""Cuts of different surfaces, so that two processes share them; the second is for nothing when cuts are spent."""
_PATIENCE = 16
"""Cuts after which the largest gap of a surface must have become smaller."""
_NEARLY = 0.9
"""Share of what it was that it must have come below."""
_FEW_FACES = 400
"""Larger meshes are simplified to so many faces before they are cut."""
_MANY_FACES = 5000
"""Still larger ones are first thinned out on a grid, which is quicker."""
_FINE_CELLS = 80
"""Cells of that grid along the diagonal."""
_STRAY = 0.02
"""A simplified mesh is no farther from the true one than this fraction of the diagonal."""
_COARSE_CELLS = 40
"""Cells of the grid on which meshes are thinned out that cannot be simplified."""


class CutSurface:
    """A mesh that pieces are compared with."""

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        """Keep the mesh; vertices (V, 3), faces (F, 3)."""
        self.vertices = np.ascontiguousarray(vertices)
        self.faces = np.ascontiguousarray(faces)

    @cached_property
    def _tree(self) -> DistanceTree:
        return DistanceTree(self.vertices, self.faces)

    @cached_property
    def closed(self) -> bool:
        """True if it encloses a solid, small holes apart: what is inside an open shell is air."""
        sides = np.sort(self.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        _, count = np.unique(sides[:, 0] * len(self.vertices) + sides[:, 1], return_counts=True)
        if np.count_nonzero(count == 1) > _HOLES * len(count):
            return False
        areas = triangle_normals(self.vertices[self.faces])
        return bool(np.linalg.norm(areas.sum(axis=0)) <= _HOLES * lengths_of(areas).sum())

    @cached_property
    def _winding(self) -> WindingTree:
        return WindingTree(self.vertices, self.faces)

    def gap(self, piece: ConvexPiece, tolerance: float) -> float:
        """Return how far a piece reaches beyond the surface at most [m]; what lies inside it does not count."""
        return float(self.gaps(piece, tolerance).max())

    def gaps(self, piece: ConvexPiece, tolerance: float) -> FloatArray:
        """Distances of points on a piece from the surface [m], 0 inside it; `tolerance` is near enough to be on it."""
        points = surface_points(piece.vertices, piece.faces, _PROBES)
        distances = self._tree.distances(points)
        far = distances > tolerance
        if self.closed and far.any():
            winding = self._winding.numbers(points[far])
            distances[far] = np.where(np.abs(winding) > 0.5, 0.0, distances[far])
        return np.asarray(distances)

    def few_triangles(self) -> FloatArray:
        """Return the corners of its triangles, shape (n, 3, 3), simplified where there are many."""
        vertices, faces = self.vertices, self.faces
        if len(faces) > _MANY_FACES:
            vertices, faces = snapped(vertices, faces, _FINE_CELLS)
        if len(faces) > _FEW_FACES:
            vertices, faces = fast_simplification.simplify(
                vertices.astype(np.float32), faces.astype(np.int32), target_count=_FEW_FACES
            )
        if self._strays(vertices[faces]) or len(faces) > 2 * _FEW_FACES:
            vertices, faces = snapped(self.vertices, self.faces, _COARSE_CELLS)
        if not len(faces):
            vertices, faces = self.vertices, self.faces
        return np.asarray(vertices[faces], dtype=np.float64)

    def _strays(self, triangles: FloatArray) -> bool:
        """True if some triangle (n, 3, 3) is far from the surface, or none is left: simplification closes pots."""
        if not len(triangles):
            return True
        middles = np.asarray(triangles.mean(axis=1), dtype=np.float64)
        size = float(np.linalg.norm(np.ptp(self.vertices, axis=0)))
        return float(self._tree.distances(middles).max()) > _STRAY * size


@dataclass(frozen=True, kw_only=True, eq=False)
class Concave:
    """A surface that is to be cut."""

    surface: CutSurface
    """What hulls are compared with."""
    tolerance: float
    """How far they may reach beyond it [m]."""
    thickness: float
    """Of flat pieces [m]."""

    @cached_property
    def triangles(self) -> FloatArray:
        """Return what is cut: corners, shape (n, 3, 3)."""
        return self.surface.few_triangles()

    @cached_property
    def axes(self) -> FloatArray:
        """Rows across which to cut: those of the frame or the principal ones, whichever more faces lie across."""
        triangles = self.triangles
        normals = triangle_normals(triangles)
        middles = triangles.mean(axis=1)
        weights = lengths_of(normals) + 1e-300
        centred = middles - np.average(middles, axis=0, weights=weights)
        principal = np.linalg.eigh(np.einsum("n,ni,nj->ij", weights, centred, centred))[1].T
        return max((np.eye(3), principal), key=lambda axes: float(np.abs(normals @ axes.T).max(axis=1).sum()))

    def chunk(self, triangles: FloatArray) -> Chunk:
        """Measure some triangles of the surface, shape (n, 3, 3)."""
        points = outermost(triangles.reshape(-1, 3), _CORNERS)
        piece = convex_piece(points, thickness=self.thickness, directions=_CORNERS)
        gaps = self.surface.gaps(piece, self.tolerance)
        hollow = (piece.volume + self.tolerance * piece.area) * float((gaps**4).mean()) ** 0.25
        return Chunk(triangles=triangles, piece=piece, gap=float(gaps.max()), hollow=hollow)


@dataclass(frozen=True, kw_only=True, eq=False)
class Chunk:
    """A part of a surface with its hull."""

    triangles: FloatArray
    """Corners [m], shape (n, 3, 3)."""
    piece: ConvexPiece
    gap: float
    """How far the hull reaches beyond the surface [m]."""
    hollow: float
    """How much there is to cut: volume of the hull, flat ones as thick as is tolerated, times a mean of order four of
    the distances between hull and surface [m^4]. The largest distance alone would depend on where it is probed."""


class _Cutting:
    """A surface on its way to pieces."""

    def __init__(self, body: Concave) -> None:
        self._body = body
        self._whole = body.chunk(body.triangles)
        self._cuts = 0
        self._best = self._whole.gap
        self._finished: list[Chunk] = []
        self._queue = [self._whole]
        self.ahead: list[Chunk] | None = None
        """Result of the next cut, where it is known already."""

    @property
    def chunks(self) -> list[Chunk]:
        """Return what it is made of so far."""
        return self._finished + self._queue

    @property
    def worst(self) -> float:
        """The largest gap that is still to be cut [m]; 0 where nothing is left to do."""
        gap = max((chunk.gap for chunk in self._queue), default=0.0)
        return gap if gap > self._body.tolerance else 0.0

    @property
    def following(self) -> Chunk:
        """The worst chunk, which is cut next."""
        return max(self._queue, key=lambda item: item.gap)

    def next_cut(self) -> list[Chunk]:
        """Return what the next cut makes; nothing changes."""
        return _best_cut(self._body, self.following)

    def cut(self) -> None:
        """Cut the worst chunk; stop where that has not helped for a while, and start from the whole if it never has."""
        sides, chunk = self.ahead or [], self.following
        self.ahead = None
        self._queue.remove(chunk)
        self._queue += sides
        self._finished += [] if sides else [chunk]
        self._cuts += 1
        if self._cuts % _PATIENCE == 0:
            worst = max(item.gap for item in self.chunks)
            if worst > _NEARLY * self._best:
                self._finished = [self._whole] if worst > _NEARLY * self._whole.gap else self.chunks
                self._queue = []
            self._best = worst


def cut_worst_first(bodies: Sequence[Concave], cuts: int) -> list[list[Chunk]]:
    """Cut surfaces until each hull is close enough or the number of cuts is spent.

    Args:
        bodies: The surfaces.
        cuts: For all of them together.

    Returns:
        The chunks of each.
    """
    cutting = [_Cutting(body) for body in bodies]
    for _ in range(cuts if cutting else 0):
        worst = max(cutting, key=lambda item: item.worst)
        if worst.worst == 0.0:
            break
        if worst.ahead is None:
            waiting = sorted(
                (item for item in cutting if item.worst and item.ahead is None), key=lambda item: -item.worst
            )
            for item, sides in zip(waiting, each(_Cutting.next_cut, waiting[:_AT_ONCE]), strict=False):
                item.ahead = sides
        worst.cut()
    return [item.chunks for item in cutting]


def _best_cut(body: Concave, chunk: Chunk) -> list[Chunk]:
    """The two sides that have the least left to cut; empty where no plane parts the chunk."""
    best, chosen = np.inf, list[Chunk]()
    for heights, offset in _planes(chunk.triangles, body.axes, closed=body.surface.closed):
        sides = split(chunk.triangles, heights - offset)
        if min(map(len, sides)) == 0:
            continue
        chunks = _if_better(body, sides, best)
        if chunks:
            best, chosen = sum(side.hollow for side in chunks), chunks
    return chosen


def _if_better(body: Concave, sides: tuple[FloatArray, FloatArray], best: float) -> list[Chunk]:
    """Measure two sides, the larger first; empty, often before the second, where no less than `best` is left to cut."""
    first = int(len(sides[1]) > len(sides[0]))
    one = body.chunk(sides[first])
    if one.hollow >= best:
        return []
    other = body.chunk(sides[1 - first])
    chunks = [one, other] if first == 0 else [other, one]
    return chunks if sum(side.hollow for side in chunks) < best else []


def _planes(triangles: FloatArray, axes: FloatArray, *, closed: bool) -> Iterator[tuple[FloatArray, float]]:
    """Heights of all corners across an axis (n, 3) and the height of a plane, for the most promising planes.

    Promising are planes whose two sides have the smallest boxes together, some across each axis.
    """
    frame = triangles @ axes.T
    corners, following = (np.ascontiguousarray(ends.reshape(-1, 3).T) for ends in (frame, np.roll(frame, -1, axis=1)))
    for number in range(3):
        heights = frame[:, :, number]
        offsets = _offsets(triangles, heights, axes[number], closed=closed)
        boxes = np.array([_boxes(corners, following, number, offset) for offset in offsets])
        for index in np.argsort(boxes, kind="stable")[:_PER_AXIS]:
            yield heights, float(offsets[index])


def _boxes(corners: FloatArray, following: FloatArray, number: int, offset: float) -> float:
    """Volume of the boxes around the two sides of a plane.

    Args:
        corners: Of triangles, shape (3, n).
        following: The corner after each in its triangle, shape (3, n).
        number: Axis that the plane stands across.
        offset: Height of the plane.
    """
    start, end = corners[number] - offset, following[number] - offset
    crossing = np.flatnonzero(start * end < 0.0)
    share = start[crossing] / (start[crossing] - end[crossing])
    on_plane = corners[:, crossing] + share * (following[:, crossing] - corners[:, crossing])
    volume = 0.0
    for side in (start <= 0.0, start >= 0.0):
        points = np.concatenate([corners[:, side], on_plane], axis=1)
        if points.size:
            volume += float(np.prod(points.max(axis=1) - points.min(axis=1)))
    return volume


def _offsets(triangles: FloatArray, heights: FloatArray, axis: FloatArray, *, closed: bool) -> FloatArray:
    """Places of planes across an axis, the most telling first: large faces across it, some in between, the ends.

    Open surfaces may be walls without thickness, which stand at the ends.
    """
    low, high = float(heights.min()), float(heights.max())
    rind = _RIND * (high - low)
    if rind == 0.0:
        return np.empty(0)
    exact = face_levels(triangles, heights, axis, rind, _FACE_PLANES)
    at_end = (exact < low + rind) | (exact > high - rind)
    uniform = low + (high - low) * np.array(_UNIFORM)
    # A face in the very plane belongs to one side; which one is not known where surfaces are open.
    beside = (exact[~at_end, None] + _BESIDE * rind * np.array([-1.0, 1.0])).reshape(-1)
    ordered = [beside, uniform, exact[at_end]] if closed else [exact[at_end], beside, uniform]
    return np.asarray(np.clip(np.concatenate(ordered), low + rind, high - rind))


def face_levels(triangles: FloatArray, heights: FloatArray, axis: FloatArray, cell: float, most: int) -> FloatArray:
    """Heights across an axis at which faces lie, those with the largest area first, shape (n,).

    Args:
        triangles: Corners, shape (n, 3, 3).
        heights: Of the corners across the axis, shape (n, 3).
        axis: Unit direction, shape (3,).
        cell: Faces that are no farther apart lie at one height.
        most: Heights.
    """
    normals = triangle_normals(triangles)
    areas = lengths_of(normals)
    across = (np.abs(normals @ axis) > ALONG * areas) & (areas > 0.0)
    levels = heights[across].mean(axis=1)
    # The mean of three equal heights may lie below them by a rounding, which counts where there is hardly any extent.
    places = np.maximum(np.round((levels - float(heights.min())) / cell).astype(np.int64), 0)
    total = np.bincount(places, weights=areas[across])
    order = [place for place in np.argsort(-total, kind="stable")[:most] if total[place] > 0.0]
    return np.array([np.median(levels[places == place]) for place in order])


def split(triangles: FloatArray, signed: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Split triangles by a plane.

    Args:
        triangles: Corners, shape (n, 3, 3).
        signed: Signed distance of each corner from the plane, shape (n, 3).

    Returns:
        The triangles below and above, shapes (k, 3, 3) and (m, 3, 3); those that it crosses are cut.
    """
    above = signed > 0.0
    count = above.sum(axis=1)
    below_all = count == 0
    above_all = (signed >= 0.0).all(axis=1) & ~below_all
    crossing = ~below_all & ~above_all
    alone = np.where(count == 1, above.argmax(axis=1), (~above).argmax(axis=1))[crossing]
    order = (alone[:, None] + np.arange(3)) % 3  # the corner that is alone on its side comes first
    corners = np.take_along_axis(triangles[crossing], order[:, :, None], axis=1)
    heights = np.take_along_axis(signed[crossing], order, axis=1)
    tip, left, right = corners[:, 0], corners[:, 1], corners[:, 2]
    to_left = tip + (heights[:, :1] / (heights[:, :1] - heights[:, 1:2])) * (left - tip)
    to_right = tip + (heights[:, :1] / (heights[:, :1] - heights[:, 2:])) * (right - tip)
    tips = np.stack([tip, to_left, to_right], axis=1)
    rests = np.concatenate([np.stack([to_left, left, right], axis=1), np.stack([to_left, right, to_right], axis=1)])
    up = count[crossing] == 1
    both = np.concatenate([up, up])
    return (
        np.concatenate([triangles[below_all], tips[~up], rests[both]]),
        np.concatenate([triangles[above_all], tips[up], rests[~both]]),
    )
