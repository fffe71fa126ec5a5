"""Surface of a part as the evidence needs it: smooth normals, sharp edges and a collision tree.

A faceted cylinder has wrong normals everywhere but on the middle line of each facet. `PartSurface` therefore
interpolates corner normals over faces that meet at a small dihedral angle, which are radial to within the
tessellation's own asymmetry; a 3 deg tolerance then works from 16 segments up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import fcl
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from kinematify.geometry.convex import convex_hull, thickened
from kinematify.geometry.denoise import (
    FACET_ROUNDS,
    NOISE_ROUNDS,
    ROUGH,
    bends_both_ways,
    filtered_normals,
    mean_deviation,
)
from kinematify.geometry.mesh_trees import DistanceTree, collision_tree
from kinematify.geometry.sampling import curve_order, place_samples
from kinematify.robot.vectors import crossed, lengths_of, triangle_normals

if TYPE_CHECKING:
    from typing import Any

    from numpy.typing import NDArray

    from kinematify.assembly.part import Assembly, Part
    from kinematify.config import SurfaceConfig
    from kinematify.robot.arrays import FloatArray, IntArray


FACETED = 3.4
"""Roughness [deg] from which normals are averaged over the faces around."""
_FLAT = math.cos(math.radians(0.05))  # faces that meet at a smaller angle are one facet
_THINNEST = 1e-3  # of its diagonal: flat parts have no hull
_DIRECTION_SAMPLES = 800  # a side with 5 % of the area has forty of them
_UNIT_SHARE = 1e-3  # of the assembly's diagonal; FCL measured wrong from 0.1 down, right from 1 to 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class Samples:
    """Points on a surface with smooth normals."""

    points: FloatArray
    """World frame [m], shape (n, 3)."""
    normals: FloatArray
    """Unit, interpolated over smooth edges, shape (n, 3)."""
    areas: FloatArray
    """Surface area that each sample represents [m^2], shape (n,)."""

    def subset(self, index: NDArray[Any]) -> Samples:
        """Keep the samples that a boolean mask or an index array selects."""
        return Samples(points=self.points[index], normals=self.normals[index], areas=self.areas[index])


@dataclass(frozen=True, kw_only=True, eq=False)
class FeaturePieces:
    """Straight pieces of sharp and boundary edges."""

    middles: FloatArray
    """Middle of each piece, world frame [m], shape (E, 3)."""
    tangents: FloatArray
    """Unit direction, shape (E, 3)."""
    lengths: FloatArray
    """[m], shape (E,)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FeatureCircles:
    """Circles through three vertices along chains of feature edges."""

    axes: FloatArray
    """Unit normal of the circle's plane, shape (C, 3)."""
    centres: FloatArray
    """World frame [m], shape (C, 3)."""
    on_circle: FloatArray
    """Middle one of the three vertices, world frame [m], shape (C, 3)."""
    lengths: FloatArray
    """Length of the chain between the outer vertices [m], shape (C,)."""


class PartSurface:
    """Derived geometry of one part, each piece computed once when first asked for."""

    def __init__(self, part: Part, *, crease_angle: float, origin: FloatArray | None = None, unit: float = 1.0) -> None:
        """Keep the part.

        Args:
            part: The mesh.
            crease_angle: Faces that meet at a larger dihedral angle form a sharp edge [rad].
            origin: Where the collision tree has its origin, world frame [m], shape (3,); the world's by default.
            unit: Length of one unit of the collision tree [m]. FCL takes short lengths for none whatever the size of
                the object, so a thousandth of that size is a good unit. Surfaces that meet must share both.
        """
        self.part = part
        self.crease_angle = crease_angle
        self.origin = np.zeros(3) if origin is None else origin
        self.unit = unit

    @cached_property
    def welded(self) -> tuple[FloatArray, IntArray]:
        """Vertices merged by position and the faces over them that are not degenerate."""
        scale = max(self.part.diagonal, 1e-12) * 1e-6
        cells = np.round(self.part.vertices / scale).astype(np.int64)
        first, inverse = _distinct_rows(cells)
        faces = inverse[self.part.faces]
        distinct = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 0] != faces[:, 2])
        return self.part.vertices[first], faces[distinct]

    @cached_property
    def face_normals(self) -> tuple[FloatArray, FloatArray]:
        """Unit normals (F, 3) and areas (F,) of the welded faces; zero-area faces have a zero normal."""
        vertices, faces = self.welded
        cross = triangle_normals(vertices[faces])
        length = lengths_of(cross)
        return cross / np.maximum(length, 1e-300)[:, None], 0.5 * length

    @cached_property
    def _edge_table(self) -> tuple[IntArray, IntArray, IntArray]:
        """Sorted vertex pairs of unique edges, and for each face side its edge and its face."""
        _, faces = self.welded
        starts, ends = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
        count = len(self.welded[0])
        keys, inverse = np.unique(np.minimum(starts, ends) * count + np.maximum(starts, ends), return_inverse=True)
        edges = np.stack(np.divmod(keys, max(count, 1)), axis=1)
        return edges, inverse.reshape(-1), np.repeat(np.arange(len(faces)), 3)

    @cached_property
    def noisy(self) -> bool:
        """True if the vertices are so noisy that single faces do not tell how the surface runs."""
        vertices, faces = self.welded
        normals, areas = self.face_normals
        return bends_both_ways(vertices[faces].mean(axis=1), normals, areas, self._adjacent[:, :2]) > ROUGH

    @cached_property
    def roughness(self) -> float:
        """Mean angle between the normal of a face and that of the surface around it [deg]; infinite where noisy.

        0.5 to 3 in designed meshes, however curved, for the faces around lie alike on both sides; 3 to 9 in meshes
        that were remeshed on a grid or decimated.
        """
        if self.noisy:
            return math.inf
        normals, areas = self.face_normals
        return mean_deviation(normals, self._facet_normals, areas)

    @cached_property
    def _facet_normals(self) -> FloatArray:
        """Normals averaged over neighbouring facets (F, 3); the triangles of one flat facet count as one face."""
        normals, areas = self.face_normals
        facet = self._facets
        total: FloatArray = np.bincount(facet, areas).astype(np.float64)
        sums = [np.bincount(facet, normals[:, k] * areas) for k in range(3)]
        means: FloatArray = np.stack(sums, axis=1).astype(np.float64)
        means /= np.maximum(lengths_of(means), 1e-300)[:, None]
        pairs = facet[self._adjacent[:, :2]]
        return filtered_normals(means, total, pairs[pairs[:, 0] != pairs[:, 1]], rounds=FACET_ROUNDS)[facet]

    @cached_property
    def _facets(self) -> IntArray:
        """The flat facet to which each face belongs, shape (F,)."""
        normals, _ = self.face_normals
        pairs = self._adjacent[:, :2]
        flat = pairs[np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]]) > _FLAT]
        links = coo_matrix((np.ones(len(flat)), (flat[:, 0], flat[:, 1])), shape=(len(normals), len(normals)))
        return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)

    @cached_property
    def surface_normals(self) -> FloatArray:
        """Unit normals of the faces (F, 3), averaged over the faces around where single faces do not tell."""
        normals, areas = self.face_normals
        if self.noisy:
            return filtered_normals(normals, areas, self._adjacent[:, :2], rounds=NOISE_ROUNDS)
        return self._facet_normals if self.roughness > FACETED else normals

    @cached_property
    def smooth_pairs(self) -> tuple[IntArray, FloatArray]:
        """Pairs of faces that share an edge (P, 3: face, face, edge) and the cosine between their normals (P,)."""
        pairs, normals = self._adjacent, self.surface_normals
        return pairs, np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]])

    @cached_property
    def _adjacent(self) -> IntArray:
        """Pairs of faces that share an edge which no other face has, shape (P, 3): face, face, edge."""
        edges, edge_of_side, face_of_side = self._edge_table
        order = np.argsort(edge_of_side, kind="stable")
        sorted_edges = edge_of_side[order]
        counts = np.bincount(edge_of_side, minlength=len(edges))
        starts = np.flatnonzero(np.r_[True, sorted_edges[1:] != sorted_edges[:-1]])
        manifold = counts[sorted_edges[starts]] == 2
        first = order[starts[manifold]]
        second = order[starts[manifold] + 1]
        return np.stack([face_of_side[first], face_of_side[second], edge_of_side[first]], axis=1)

    @cached_property
    def feature_edges(self) -> IntArray:
        """Vertex pairs of sharp and boundary edges of the welded mesh, shape (E, 2)."""
        edges, edge_of_side, _ = self._edge_table
        counts = np.bincount(edge_of_side, minlength=len(edges))
        pairs, cosines = self.smooth_pairs
        sharp = pairs[np.abs(cosines) < np.cos(self.crease_angle), 2]
        return np.asarray(edges[np.union1d(sharp, np.flatnonzero(counts == 1))])

    @cached_property
    def rim(self) -> tuple[FloatArray, FloatArray]:
        """Edges that one face alone has: their ends [m], shape (E, 2, 3), and the unit normals of the faces, (E, 3)."""
        vertices, _ = self.welded
        edges, edge_of_side, face_of_side = self._edge_table
        single = np.flatnonzero(np.bincount(edge_of_side, minlength=len(edges))[edge_of_side] == 1)
        return vertices[edges[edge_of_side[single]]], self.face_normals[0][face_of_side[single]]

    @cached_property
    def feature_pieces(self) -> FeaturePieces:
        """Sharp and boundary edges as midpoints with directions."""
        vertices, _ = self.welded
        ends = vertices[self.feature_edges]
        along = ends[:, 1] - ends[:, 0]
        lengths = lengths_of(along)
        tangents = along / np.maximum(lengths, 1e-300)[:, None]
        return FeaturePieces(middles=ends.mean(axis=1), tangents=tangents, lengths=lengths)

    @cached_property
    def feature_circles(self) -> FeatureCircles:
        """Circles through vertices 1, 2, 4 and 8 steps apart along chains of feature edges."""
        vertices, _ = self.welded
        found = [_circles_through(vertices, *triple) for triple in _chain_triples(self.feature_edges)]
        axes, centres, middles, lengths = (np.concatenate(column) for column in zip(*found, strict=True))
        return FeatureCircles(axes=axes, centres=centres, on_circle=middles, lengths=lengths)

    @cached_property
    def main_directions(self) -> FloatArray:
        """Unit directions along which the part is built, shape (k, 3)."""
        samples = self.sample(_DIRECTION_SAMPLES)
        return main_directions(samples.normals, samples.areas)

    def distance(self, points: FloatArray) -> FloatArray:
        """Exact unsigned distance from `points` (n, 3) to the surface [m], shape (n,)."""
        return self._distance_tree.distances(points - self._middle)

    @cached_property
    def _middle(self) -> FloatArray:
        return np.asarray(self.part.bounds.mean(axis=0))

    @cached_property
    def _distance_tree(self) -> DistanceTree:
        vertices, faces = self.welded
        return DistanceTree(vertices - self._middle, faces)

    @cached_property
    def corner_normals(self) -> FloatArray:
        """Unit normal at each corner of each welded face, shape (F, 3, 3), angle-weighted over its smooth fan."""
        vertices, faces = self.welded
        normals = self.surface_normals
        fan = self._corner_fans()
        weights = _corner_angles(vertices, faces).reshape(-1)
        weighted = weights[:, None] * np.repeat(normals, 3, axis=0)
        smooth: FloatArray = np.stack([np.bincount(fan, weighted[:, k])[fan] for k in range(3)], axis=1)
        length = lengths_of(smooth)
        good = length > 1e-9
        smooth = np.where(good[:, None], smooth / np.maximum(length, 1e-300)[:, None], np.repeat(normals, 3, axis=0))
        return smooth.reshape(-1, 3, 3)

    def _corner_fans(self) -> IntArray:
        """Label every face corner by the fan of faces around its vertex that are joined by smooth edges."""
        _, faces = self.welded
        edges, _, _ = self._edge_table
        pairs, cosines = self.smooth_pairs
        smooth = pairs[cosines > np.cos(self.crease_angle)]
        ends, n = edges[smooth[:, 2]].T[..., None], faces.size
        i, j = (
            np.concatenate([face * 3 + np.argmax(faces[face] == end, axis=1) for end in ends])
            for face in smooth[:, :2].T
        )
        _, labels = connected_components(coo_matrix((np.ones(len(i)), (i, j)), shape=(n, n)), directed=False)
        return np.asarray(labels, dtype=np.int64)

    def sample(self, count: int, *, faces: IntArray | None = None, seed: int = 0) -> Samples:
        """Sample the surface uniformly by area, in the walk of `geometry.sampling`.

        Args:
            count: Number of samples.
            faces: Indices of welded faces to sample; all by default.
            seed: Shifts the samples; the same seed gives the same ones however the faces are listed.

        Returns:
            Samples with interpolated normals, ordered along the walk; empty where there is no area.
        """
        _, areas = self.face_normals
        order = self._walk(faces)
        total = float(areas[order].sum())
        if total <= 0:
            return Samples(points=np.empty((0, 3)), normals=np.empty((0, 3)), areas=np.empty(0))
        vertices, triangles = self.welded
        picked, barycentric = place_samples(vertices[triangles], areas, order, count, seed)
        points = np.einsum("nk,nkd->nd", barycentric, vertices[triangles[picked]])
        normals = np.einsum("nk,nkd->nd", barycentric, self.corner_normals[picked])
        normals /= np.maximum(lengths_of(normals), 1e-12)[:, None]
        return Samples(points=points, normals=normals, areas=np.full(count, total / count))

    def outline(self, count: int, *, seed: int = 0) -> Samples:
        """Samples of the whole part for comparing shapes, of its convex hull where the part is rough.

        What remeshing leaves of inner walls differs from one copy of a part to the next; the outside does not.
        """
        if self.roughness <= FACETED or not self.part.area:
            return self.sample(count, seed=seed)
        vertices, faces = convex_hull(thickened(self.welded[0], _THINNEST * self.part.diagonal))
        hull = replace(self.part, vertices=vertices, faces=faces)
        return PartSurface(hull, crease_angle=self.crease_angle).sample(count, seed=seed)

    def _walk(self, faces: IntArray | None) -> IntArray:
        """Some faces, or all, in the order of the curve through all of them."""
        order = self._curve
        if faces is None:
            return order
        rank = np.empty(len(order), dtype=np.int64)
        rank[order] = np.arange(len(order))
        return faces[np.argsort(rank[faces])]

    @cached_property
    def _curve(self) -> IntArray:
        vertices, faces = self.welded
        return curve_order(vertices[faces], self.face_normals[1]) if len(faces) else np.empty(0, dtype=np.int64)

    def faces_near(self, bounds: FloatArray, margin: float) -> IntArray:
        """Welded faces whose box meets `bounds` (2, 3) grown by `margin` [m]."""
        lower, upper = self._face_boxes
        hit = np.all((lower <= bounds[1] + margin) & (upper >= bounds[0] - margin), axis=1)
        return np.flatnonzero(hit)

    @cached_property
    def _face_boxes(self) -> tuple[FloatArray, FloatArray]:
        vertices, faces = self.welded
        a, b, c = (vertices[faces[:, k]] for k in range(3))
        return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)

    def gap(self, other: PartSurface) -> float:
        """Smallest distance between the triangles of two parts of one assembly [m]; 0 where they cross."""
        first, second = self._collision_object, other._collision_object
        if fcl.collide(first, second, fcl.CollisionRequest(), fcl.CollisionResult()):
            return 0.0
        return self.unit * max(float(fcl.distance(first, second, fcl.DistanceRequest(), fcl.DistanceResult())), 0.0)

    @cached_property
    def _collision_object(self) -> fcl.CollisionObject:
        """FCL tree of the triangles, in units of `unit` from `origin`."""
        vertices, faces = self.welded
        return fcl.CollisionObject(collision_tree((vertices - self.origin) / self.unit, faces), fcl.Transform())


def part_surfaces(assembly: Assembly, *, config: SurfaceConfig) -> tuple[PartSurface, ...]:
    """Wrap every part of an assembly, in order; nothing is computed yet."""
    crease = math.radians(config.crease_angle)
    middle, unit = assembly.bounds.mean(axis=0), _UNIT_SHARE * assembly.diagonal
    return tuple(PartSurface(part, crease_angle=crease, origin=middle, unit=unit) for part in assembly.parts)


def _distinct_rows(rows: IntArray) -> tuple[IntArray, IntArray]:
    """First of every set of equal rows (n, 3), in ascending order, and the set of every row (n,)."""
    keys = rows
    if len(rows) and np.ptp(rows, axis=0).max() < 1 << 21:  # vertices that no face uses may be anywhere
        x, y, z = (rows - rows.min(axis=0)).T
        keys = (x << 42) + (y << 21) + z  # one number for all three, in their order, sorts far quicker
    _, first, inverse = np.unique(keys, axis=0 if keys is rows else None, return_index=True, return_inverse=True)
    return first, inverse.reshape(-1)


def _corner_angles(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Interior angle at each corner [rad], shape (F, 3)."""
    corners = vertices[faces]
    angles = np.empty((len(faces), 3))
    for k in range(3):
        left = corners[:, (k + 1) % 3] - corners[:, k]
        right = corners[:, (k + 2) % 3] - corners[:, k]
        cross = lengths_of(crossed(left, right))
        angles[:, k] = np.arctan2(cross, np.einsum("ij,ij->i", left, right))
    return angles


def _chain_triples(edges: IntArray) -> list[tuple[IntArray, IntArray, IntArray]]:
    """Vertex triples (first, middle, last) k = 1, 2, 4, 8 steps apart along chains of feature edges.

    `follow` maps each directed edge to the next one along its chain; composing it with itself doubles the step, so
    nothing is walked. Chains end at vertices that have other than two feature edges.
    """
    n = len(edges)
    directed = np.concatenate([edges, edges[:, ::-1]])
    starts, ends = directed[:, 0], directed[:, 1]
    twin = np.concatenate([np.arange(n) + n, np.arange(n)])
    size = int(edges.max(initial=-1)) + 1
    degree = np.bincount(starts, minlength=size)
    # Where a vertex has two outgoing edges, their sum less the way back is the way on.
    outgoing = np.bincount(starts, np.arange(2 * n), minlength=size).astype(np.int64)
    follow = np.append(np.where(degree[ends] == 2, outgoing[ends] - twin, 2 * n), 2 * n)
    near, jump = np.arange(2 * n), follow
    triples = []
    for _ in range(4):
        far = jump[near]
        good = far < 2 * n
        first, middle, last = starts[good], ends[near[good]], ends[far[good]]
        once = first < last
        triples.append((first[once], middle[once], last[once]))
        near, jump = np.where(good, far, 2 * n), jump[jump]
    return triples


def _circles_through(
    vertices: FloatArray, first: IntArray, middle: IntArray, last: IntArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Circumscribed circles: axes, centres, middle points and chord lengths; nearly straight triples are dropped."""
    a, b, c = vertices[first], vertices[middle], vertices[last]
    left, right = a - b, c - b
    cross = crossed(left, right)
    area = lengths_of(cross)
    lengths = lengths_of(left) + lengths_of(right)
    bent = area > 0.01 * (0.25 * lengths**2)  # below, the chain turns by less than about 0.6 deg
    left, right, cross, area, b = left[bent], right[bent], cross[bent], area[bent], b[bent]
    squared_left = np.einsum("ij,ij->i", left, left)[:, None]
    squared_right = np.einsum("ij,ij->i", right, right)[:, None]
    to_centre = crossed(squared_left * right - squared_right * left, cross) / (2 * area**2)[:, None]
    return cross / area[:, None], b + to_centre, b, lengths[bent]


_MOST = 4  # flat directions of a part; a box has three
_LEAST_SHARE = 0.04  # of the area; the end of a motor housing has about a tenth
_WIDTH = np.cos(np.radians(12.0))  # normals of one flat side of a rough mesh lie so close together
_APART = np.cos(np.radians(10.0))  # nearer directions are one: the finer of them follows from the refinement


def main_directions(normals: FloatArray, areas: FloatArray) -> FloatArray:
    """Directions in which much area looks, and the principal axes of all normals.

    A turning joint of a machine runs along one of them: bearings end in flat seats and covers, and housings are built
    around them. The sense means nothing.

    Args:
        normals: Unit normals of samples of a part, shape (n, 3).
        areas: What each sample represents [m^2], shape (n,).

    Returns:
        Unit directions, those with most area first, shape (k, 3).
    """
    total = float(areas.sum())
    if total <= 0:
        return np.empty((0, 3))
    found = _flat_directions(normals, areas / total)
    axes = np.linalg.eigh((normals * areas[:, None]).T @ normals)[1].T
    return distinct_directions(np.concatenate([found, axes]))


def distinct_directions(directions: FloatArray) -> FloatArray:
    """The same without those that nearly repeat an earlier one, shape (k, 3)."""
    kept: list[FloatArray] = []
    for direction in directions:
        if all(abs(float(direction @ other)) < _APART for other in kept):
            kept.append(direction)
    return np.array(kept).reshape(-1, 3)


def _flat_directions(normals: FloatArray, shares: FloatArray) -> FloatArray:
    left = np.ones(len(normals), dtype=bool)
    alike = np.abs(normals @ normals.T) > _WIDTH
    found = []
    for _ in range(_MOST):
        support = alike[:, left] @ shares[left]
        best = int(np.argmax(support))
        if support[best] < _LEAST_SHARE:
            break
        members = alike[best] & left
        tensor = (normals[members] * shares[members, None]).T @ normals[members]
        found.append(np.linalg.eigh(tensor)[1][:, 2])
        left &= ~members
    return np.array(found).reshape(-1, 3)
