"""Derived geometry of every part, computed once per run and shared by all joints of an assembly."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from kinematify.geometry.mesh_trees import DistanceTree, WindingTree
from kinematify.geometry.sampling import sample_surface
from kinematify.joints.measure.frames import body_axes
from kinematify.robot.vectors import all_three, lengths_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from kinematify.assembly.part import Assembly
    from kinematify.contact.graph import ContactGraph
    from kinematify.geometry.sampling import SurfaceSamples
    from kinematify.robot.arrays import FloatArray

    BoolArray = NDArray[np.bool_]

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
    """Contact area that each sample stands for, normalised to sum 1, shape (n,)."""
    parent_points: FloatArray
    """Samples of the parent near the child, world frame [m], shape (m, 3)."""
    parent_normals: FloatArray
    """Unit normals of the parent there, shape (m, 3)."""

    @property
    def centroid(self) -> FloatArray:
        """Area-weighted centre of the contact in the world frame [m], shape (3,); NaN without contact."""
        if len(self.points) == 0:
            return np.full(3, np.nan)
        return np.asarray(self.weights @ self.points)


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
        self.assembly = assembly
        self.graph = graph
        self._samples = samples
        self._seed = seed
        self._store: dict[tuple[str, int], Any] = {}

    @property
    def diagonal(self) -> float:
        """Diagonal of the assembly [m]; the unit of most tolerances."""
        return self.assembly.diagonal

    def samples(self, part: int) -> SurfaceSamples:
        """Area-uniform surface samples of a part."""
        found: SurfaceSamples = self._once(
            "samples", part, lambda: sample_surface(self.assembly.parts[part], self._samples, self._seed)
        )
        return found

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
        corners = tree.vertices[tree.faces[index]]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
        return distances, closest, normals

    def inside(self, part: int, points: FloatArray) -> BoolArray:
        """Whether points (n, 3) in the world frame lie inside the solid of a part, by winding number, shape (n,)."""
        lower, upper = self.assembly.parts[part].bounds
        result = all_three((points > lower) & (points < upper))
        near = np.flatnonzero(result)
        for accuracy, clear in _WINDING if len(near) else ():
            off = np.abs(self._solid(part).numbers(points[near], accuracy)) - 0.5
            result[near] = off > 0.0
            near = near[np.abs(off) < clear]
        return np.asarray(result)

    def inside_any(self, parts: Sequence[int], points: FloatArray) -> BoolArray:
        """Whether points (n, 3) in the world frame lie inside the solid of one of some parts, shape (n,)."""
        result = np.zeros(len(points), dtype=bool)
        for part in parts:
            left = np.flatnonzero(~result)
            result[left] = self.inside(part, points[left])
        return result

    def contact(self, parent: int, child: int, band: float) -> ContactView:
        """Contact samples of a pair that lie within `band` [m] beyond its gap."""
        edge = self.graph.by_pair.get((min(parent, child), max(parent, child)))
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

    def _scene(self, part: int) -> EmbreeScene:
        def build() -> EmbreeScene:
            mesh = self.assembly.parts[part]
            scene = EmbreeScene()
            TriangleMesh(scene, mesh.vertices[mesh.faces].astype(np.float32))
            return scene

        return self._once("scene", part, build)

    def _tree(self, part: int) -> DistanceTree:
        mesh = self.assembly.parts[part]
        found: DistanceTree = self._once("tree", part, lambda: DistanceTree(mesh.vertices, mesh.faces))
        return found

    def _solid(self, part: int) -> WindingTree:
        mesh = self.assembly.parts[part]
        found: WindingTree = self._once("solid", part, lambda: WindingTree(mesh.vertices, mesh.faces))
        return found

    def _once(self, kind: str, part: int, build: Callable[[], Any]) -> Any:
        key = (kind, part)
        if key not in self._store:
            self._store[key] = build()
        return self._store[key]
