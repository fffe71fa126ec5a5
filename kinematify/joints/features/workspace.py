"""Derived geometry of every part, computed once per run and shared by all joints of an assembly."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import TYPE_CHECKING

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from kinematify.contact.graph import pair
from kinematify.geometry.mesh_trees import DistanceTree, WindingTree
from kinematify.geometry.sampling import sample_surface
from kinematify.geometry.solid import thinned
from kinematify.joints.features.frames import body_axes
from kinematify.robot.vectors import all_three, lengths_of, triangle_normals, unit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.contact.graph import ContactGraph
    from kinematify.geometry.sampling import SurfaceSamples
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


_WINDING = ((1.5, 0.1), (2.0, 0.0))
"""Accuracies of winding numbers, and how far from a half each decides: the first takes two thirds of the time of the
second and was never more than 0.015 off it. One of 1.0 takes a third, and was 0.6 off on open shells."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactView:
    """Where the child of a pair touches its parent; empty arrays where the graph has no such edge."""

    points: FloatArray
    """Samples of the child near the parent, world frame [m], shape (n, 3)."""
    normals: FloatArray
    """Unit normals of the child there, shape (n, 3)."""
    weights: FloatArray
    """Contact area that each sample represents, normalised to sum 1, shape (n,)."""
    parent_points: FloatArray
    """Samples of the parent near the child, world frame [m], shape (m, 3)."""
    parent_normals: FloatArray
    """Unit normals of the parent there, shape (m, 3)."""

    @property
    def centroid(self) -> FloatArray:
        """Area-weighted centre of the contact in the world frame [m], shape (3,); NaN without contact."""
        if len(self.points) == 0:
            return np.full(3, np.nan)
        return self.weights @ self.points

    @cached_property
    def spread(self) -> tuple[FloatArray, FloatArray]:
        """Principal variances of the contact [m^2], ascending, shape (3,), and their axes in columns, shape (3, 3)."""
        offset = self.points - self.centroid
        values, vectors = np.linalg.eigh((offset * self.weights[:, None]).T @ offset)
        return values, vectors

    @cached_property
    def facing(self) -> tuple[FloatArray, FloatArray]:
        """Shares of the child's normals along their principal axes, ascending, and these axes; as above."""
        values, vectors = np.linalg.eigh((self.normals * self.weights[:, None]).T @ self.normals)
        return values, vectors


class PartCache:
    """Samples, ray-casting scenes and distance trees of the parts of one assembly, each made when first asked for."""

    def __init__(self, assembly: Assembly, graph: ContactGraph, *, samples: int, seed: int) -> None:
        """Keep the assembly.

        Args:
            assembly: The parts, world frame.
            graph: Their contacts.
            samples: Surface samples per part.
            seed: Seed of the samples.
        """
        self.assembly, self.graph = assembly, graph
        parts = assembly.parts
        self.samples = cache(lambda part: sample_surface(parts[part], samples, seed))
        """Area-uniform surface samples of a part."""
        self._scene = cache(self._new_scene)
        self._tree = cache(lambda part: DistanceTree(parts[part].vertices, parts[part].faces))
        self._solid = cache(lambda part: WindingTree(parts[part].vertices, parts[part].faces))

    @property
    def diagonal(self) -> float:
        """Diagonal of the assembly [m]; the unit of most tolerances."""
        return self.assembly.diagonal

    def corners(self, part: int) -> FloatArray:
        """Vertices of the faces of a part, world frame [m], shape (n, 3)."""
        mesh = self.assembly.parts[part]
        return mesh.vertices[np.unique(mesh.faces)]

    @cached_property
    def upright_axes(self) -> FloatArray:
        """Upright axes of the whole object, one per row, shape (3, 3); single parts may be round, or turned."""
        samples = [self.samples(part) for part in range(len(self.assembly.parts))]
        normals, areas = (np.concatenate([getattr(some, name) for some in samples]) for name in ("normals", "areas"))
        return body_axes(normals, areas)

    def first_hits(self, part: int, origins: FloatArray, steps: FloatArray) -> FloatArray:
        """Cast segments at a part.

        Args:
            part: Index of the part that is hit.
            origins: Starts in the world frame [m], shape (n, 3).
            steps: Segment vectors [m], shape (n, 3).

        Returns:
            Fraction of each segment up to its first hit, shape (n,); inf where nothing is hit.
        """
        fractions = np.full(len(origins), np.inf)
        lower, upper = self.assembly.parts[part].bounds
        ends = origins + steps
        near = all_three((np.minimum(origins, ends) <= upper) & (np.maximum(origins, ends) >= lower))
        index = np.flatnonzero(near)
        if len(index) == 0:
            return fractions
        lengths = lengths_of(steps[index])
        index, lengths = index[lengths > 0], lengths[lengths > 0]
        directions = (steps[index] / lengths[:, None]).astype(np.float32)
        reach = lengths.astype(np.float32)
        starts = origins[index].astype(np.float32)
        # Embree writes the distances into the array of ranges that it is given.
        found = self._scene(part).run(starts, directions, dists=reach.copy(), query="DISTANCE")
        hit = found < reach
        fractions[index[hit]] = found[hit] / lengths[hit]
        return fractions

    def distances(self, part: int, points: FloatArray) -> FloatArray:
        """Exact unsigned distance [m] from points (n, 3) in the world frame to the surface of a part, shape (n,)."""
        return self._tree(part).distances(points)

    def closest(self, part: int, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Nearest place on the surface of a part.

        Args:
            part: Index of the part.
            points: World frame [m], shape (n, 3).

        Returns:
            Distances [m], shape (n,), the nearest points, shape (n, 3), and the unit normals of their faces, (n, 3).
        """
        if len(points) == 0:
            return np.empty(0), np.empty((0, 3)), np.empty((0, 3))
        tree = self._tree(part)
        distances, index, closest = tree.nearest(points)
        return distances, closest, unit(triangle_normals(tree.vertices[tree.faces[index]]), 1e-300)

    def inside(self, part: int, points: FloatArray) -> BoolArray:
        """Test whether points (n, 3) in the world frame are in the solid of a part, by winding number, shape (n,)."""
        lower, upper = self.assembly.parts[part].bounds
        result = all_three((points > lower) & (points < upper))
        near = np.flatnonzero(result)
        for accuracy, clear in _WINDING if len(near) else ():
            off = np.abs(self._solid(part).numbers(points[near], accuracy)) - 0.5
            result[near] = off > 0.0
            near = near[np.abs(off) < clear]
        return result

    def inside_any(self, parts: Sequence[int], points: FloatArray) -> BoolArray:
        """Test whether points (n, 3) in the world frame lie inside the solid of one of some parts, shape (n,)."""
        result = np.zeros(len(points), dtype=bool)
        for part in parts:
            left = np.flatnonzero(~result)
            result[left] = self.inside(part, points[left])
        return result

    def near(self, parts: Sequence[int], low: FloatArray, high: FloatArray) -> tuple[int, ...]:
        """Those of some parts whose boxes meet a box with these corners, world frame [m], shape (3,) each."""
        boxes = ((part, *self.assembly.parts[part].bounds) for part in parts)
        return tuple(part for part, lower, upper in boxes if ((lower <= high) & (upper >= low)).all())

    def contact(self, parent: int, child: int, band: float) -> ContactView:
        """Contact samples of a pair that lie within `band` [m] beyond its gap."""
        edge = self.graph.by_pair.get(pair(parent, child))
        if edge is None:
            nothing = np.empty((0, 3))
            return ContactView(
                points=nothing, normals=nothing, weights=np.empty(0), parent_points=nothing, parent_normals=nothing
            )
        of_child, of_parent = (edge.samples_a, edge.samples_b) if edge.a == child else (edge.samples_b, edge.samples_a)
        near = of_child.distances <= edge.gap + band
        areas = of_child.areas[near]
        near_parent = of_parent.distances <= edge.gap + band
        return ContactView(
            points=of_child.points[near],
            normals=of_child.normals[near],
            weights=areas / max(float(areas.sum()), 1e-300),
            parent_points=of_parent.points[near_parent],
            parent_normals=of_parent.normals[near_parent],
        )

    def _new_scene(self, part: int) -> EmbreeScene:
        mesh, scene = self.assembly.parts[part], EmbreeScene()
        TriangleMesh(scene, mesh.vertices[mesh.faces].astype(np.float32))
        return scene


CHILD, PARENT, OTHER, CARRIED = range(4)

_CHILD, _PARENT, _OTHERS, _CARRIED = 160, 112, 64, 32
_NEAREST = 48  # of child and of parent, besides
_TRIED = 640  # samples among which the nearest are looked for
_AROUND_PARENT, _AROUND_OTHERS = 0.5, 0.7  # how far from the child's box points may lie, in diagonals of the child


@dataclass(frozen=True, kw_only=True, eq=False)
class Cloud:
    """Points of one edge, world frame."""

    points: FloatArray
    """[m], shape (m, 3)."""
    normals: FloatArray
    """Unit normals, outwards, shape (m, 3)."""
    gaps: FloatArray
    """Distance of the child's points from the parent and of all others from the child, in diagonals, shape (m,)."""
    labels: IntArray
    """CHILD, PARENT, OTHER or CARRIED, shape (m,)."""
    centre: FloatArray
    """Mean of the child's samples [m], shape (3,)."""
    parent_centre: FloatArray
    """The same of the parent [m], shape (3,)."""
    unit: float
    """Diagonal of the child's box [m]."""
    sizes: FloatArray
    """Logarithms of the child's diagonal over those of the parent and of the whole, shape (2,)."""


def point_cloud(cache: PartCache, parent: int, child: int, others: Sequence[int], unit: float) -> Cloud:
    """Sample the parts of one edge.

    Args:
        cache: Samples and distances of the parts.
        parent: Part that carries the child.
        child: Part that moves.
        others: Every other part that does not move with the child.
        unit: Diagonal of the child's box [m].
    """
    carried = [part for part in range(len(cache.assembly.parts)) if part not in {parent, child, *others}]
    own, its = cache.samples(child), cache.samples(parent)
    low, high = cache.assembly.parts[child].bounds
    beside = np.flatnonzero(_within(its.points, low, high, _AROUND_PARENT * unit))
    beside = beside if len(beside) >= _NEAREST else np.arange(len(its.points))
    every = np.arange(len(own.points))
    chosen = [
        (own, np.concatenate([thinned(every, _CHILD), _nearest(cache, parent, own, every)]), parent, CHILD),
        (its, np.concatenate([thinned(beside, _PARENT), _nearest(cache, child, its, beside)]), child, PARENT),
    ]
    centre = own.points.mean(axis=0)
    found = [
        (samples.points[index], samples.normals[index], cache.distances(to, samples.points[index]), label)
        for samples, index, to, label in chosen
    ]
    reach = _AROUND_OTHERS * unit
    for parts, count, label in ((others, _OTHERS, OTHER), (carried, _CARRIED, CARRIED)):
        near = cache.near(parts, low - reach, high + reach)
        if not near:
            continue
        # In the order of their distance: that of the parts is whatever a file has.
        some = sorted(map(cache.samples, near), key=lambda item: float(lengths_of(item.points.mean(axis=0) - centre)))
        places, faces = (np.concatenate([getattr(item, name) for item in some]) for name in ("points", "normals"))
        index = thinned(np.flatnonzero(_within(places, low, high, reach)), count)
        found.append((places[index], faces[index], cache.distances(child, places[index]), label))
    points, normals, gaps, labels = zip(*found, strict=True)
    parent_low, parent_high = cache.assembly.parts[parent].bounds
    reaches = np.array([np.linalg.norm(parent_high - parent_low), cache.diagonal])
    return Cloud(
        points=np.concatenate(points),
        normals=np.concatenate(normals),
        gaps=np.concatenate(gaps) / unit,
        labels=np.repeat(labels, [len(some) for some in points]),
        centre=centre,
        parent_centre=its.points.mean(axis=0),
        unit=unit,
        sizes=np.log(unit / reaches),
    )


def _within(points: FloatArray, low: FloatArray, high: FloatArray, slack: float) -> BoolArray:
    """Which points lie within a box that is grown by `slack` on all sides, shape (n,)."""
    return np.asarray(((points > low - slack) & (points < high + slack)).all(axis=1))


def _nearest(cache: PartCache, part: int, samples: SurfaceSamples, index: IntArray) -> IntArray:
    """Those of the samples at the positions `index` that are nearest to a part."""
    tried = thinned(index, _TRIED)
    order = np.argsort(cache.distances(part, samples.points[tried]), kind="stable")
    return tried[order[:_NEAREST]]
