"""Ray casting against triangle meshes (Embree), for pictures without OpenGL."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from kinematify.robot.vectors import as_one, lengths_of, triangle_normals

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray

_OFFSET = 2e-5  # of the scene's size: rays that start on a surface must not meet it again in float32
_WELD = 1e-6  # of the scene's size: corners closer than this are one vertex for smooth shading


@dataclass(frozen=True, eq=False)
class RayHits:
    """The first surface that each of n rays meets; where none is met, `mesh` is -1 and the rest has no meaning."""

    distance: FloatArray
    """Along the unit direction [m], shape (n,); infinite where nothing is met."""
    mesh: IntArray
    """Index of the mesh, shape (n,)."""
    face: IntArray
    """Index of the triangle among all meshes, shape (n,)."""
    barycentric: FloatArray
    """Weights of the triangle's corners, shape (n, 3)."""

    @property
    def met(self) -> BoolArray:
        """True where a surface is met, shape (n,)."""
        return self.mesh >= 0


class RayScene:
    """Triangle meshes in one tree; both sides of a triangle are met."""

    def __init__(self, meshes: Sequence[tuple[FloatArray, IntArray]]) -> None:
        """Build the tree.

        Args:
            meshes: Vertices (V, 3) in the world frame [m] and faces (F, 3) of each mesh; at least one face in all.
        """
        self.vertices, self.faces = as_one(meshes)
        """All vertices, world frame [m], shape (V, 3), and all faces, shape (F, 3)."""
        self.mesh_of_face: IntArray = np.repeat(np.arange(len(meshes)), [len(faces) for _, faces in meshes])
        """Mesh of every face, shape (F,)."""
        used = self.vertices[self.faces.reshape(-1)]
        self.bounds: FloatArray = np.stack([used.min(axis=0), used.max(axis=0)])
        """Axis-aligned bounds [m], shape (2, 3)."""
        # Embree computes in float32: the scene is brought to unit size around the origin.
        self._center = self.bounds.mean(axis=0)
        self.size = max(float(np.linalg.norm(self.bounds[1] - self.bounds[0])), 1e-300)
        """Diagonal of the bounds [m]."""
        self._tree = EmbreeScene(robust=True)
        local = ((self.vertices - self._center) / self.size).astype(np.float32)
        TriangleMesh(self._tree, np.ascontiguousarray(local), np.ascontiguousarray(self.faces, dtype=np.int32))

    def first_hits(self, origins: FloatArray, directions: FloatArray) -> RayHits:
        """Find the first surface along each ray.

        Args:
            origins: World frame [m], shape (n, 3), or (3,) where all start.
            directions: Unit, shape (n, 3).
        """
        found = self._tree.run(*self._local_rays(origins, directions), output=1)
        face = found["primID"].astype(np.int64)
        met = face >= 0
        u, v = found["u"].astype(np.float64), found["v"].astype(np.float64)
        return RayHits(
            distance=np.where(met, found["tfar"].astype(np.float64) * self.size, np.inf),
            mesh=np.where(met, self.mesh_of_face[face], -1),
            face=face,
            barycentric=np.stack([1.0 - u - v, u, v], axis=1),
        )

    def from_behind(self, origins: FloatArray, along: FloatArray) -> BoolArray:
        """Tell which rays meet the back of a face first.

        Args:
            origins: World frame [m], shape (n, 3).
            along: Unit, of all rays, shape (3,).
        """
        rays = self._local_rays(origins, np.broadcast_to(along, origins.shape))
        # A ray that meets nothing has the last place, -1.
        return np.asarray(np.append(self.face_normals @ along > 0.0, False)[self._tree.run(*rays)])

    def occluded(self, origins: FloatArray, directions: NDArray[np.floating], reach: float) -> BoolArray:
        """Tell which rays meet any surface within `reach` [m]; a surface on which a ray starts does not count.

        Args:
            origins: World frame [m], shape (n, 3).
            directions: Unit, shape (n, 3).
            reach: Length of the rays [m].
        """
        start, along = self._local_rays(origins, directions)
        reaches = np.full(len(start), reach / self.size, dtype=np.float32)
        answer: BoolArray = self._tree.run(start + _OFFSET * along, along, reaches, query="OCCLUDED") >= 0
        return answer

    def _local_rays(self, origins: FloatArray, directions: NDArray[np.floating]) -> tuple[NDArray[np.float32], ...]:
        start = ((origins - self._center) / self.size).astype(np.float32)
        along = np.ascontiguousarray(directions, dtype=np.float32)
        return np.ascontiguousarray(np.broadcast_to(start, along.shape)), along

    def smooth_normals(self, face: IntArray, barycentric: FloatArray, angle: float) -> FloatArray:
        """Interpolated unit normals at points of faces; only faces that meet at less than `angle` are blended.

        Args:
            face: Indices of faces, shape (n,).
            barycentric: Position in each face, shape (n, 3).
            angle: Faces that meet at a larger angle keep a sharp edge [rad].

        Returns:
            Normals in the world frame, shape (n, 3), on the front side of the faces.
        """
        seen = np.bincount(face, minlength=len(self.faces)) > 0
        corners = self._corner_normals(np.flatnonzero(seen), float(np.cos(angle)))
        normals = np.einsum("nk,nkd->nd", barycentric, corners[(np.cumsum(seen) - 1)[face]])
        return _unit(normals)

    def _corner_normals(self, faces: IntArray, cosine: float) -> FloatArray:
        """Unit normals at the corners of some faces, shape (n, 3, 3): area-weighted over the like faces around."""
        weld, faces_around, first = self._faces_at_vertex
        vertex = weld[self.faces[faces]].reshape(-1)
        count = first[vertex + 1] - first[vertex]
        corner = np.repeat(np.arange(len(vertex)), count)
        step = np.arange(len(corner)) - np.repeat(np.cumsum(count) - count, count)
        around = faces_around[np.repeat(first[vertex], count) + step]
        own = np.repeat(faces, 3)[corner]
        alike = np.einsum("ij,ij->i", self.face_normals[own], self.face_normals[around]) > cosine
        weighted = self._face_cross[around[alike]]
        sums = np.stack([np.bincount(corner[alike], weighted[:, k], len(vertex)) for k in range(3)], axis=1)
        return _unit(sums.astype(np.float64)).reshape(-1, 3, 3)

    @cached_property
    def _face_cross(self) -> FloatArray:
        return np.asarray(triangle_normals(self.vertices[self.faces]), dtype=np.float64)

    @cached_property
    def face_normals(self) -> FloatArray:
        """Unit normals of all faces, shape (F, 3); zero for a face without area."""
        return _unit(self._face_cross)

    @cached_property
    def _faces_at_vertex(self) -> tuple[IntArray, IntArray, IntArray]:
        """Welded vertex of each vertex, faces sorted by welded vertex, and where each vertex's faces begin."""
        cells = np.round((self.vertices - self.bounds[0]) / (self.size * _WELD)).astype(np.int64)
        mesh_of_vertex = np.zeros(len(self.vertices), dtype=np.int64)
        mesh_of_vertex[self.faces] = self.mesh_of_face[:, None]
        # 20 bits a coordinate; what overflows only merges the normals of places that lie far apart by chance.
        key = ((cells[:, 0] << 40) ^ (cells[:, 1] << 20) ^ cells[:, 2]) + mesh_of_vertex * 0x9E3779B1
        _, weld = np.unique(key, return_inverse=True)
        weld = weld.reshape(-1)
        corners = weld[self.faces].reshape(-1)
        order = np.argsort(corners, kind="stable")
        first = np.concatenate([[0], np.cumsum(np.bincount(corners, minlength=weld.max() + 1))])
        return weld, order // 3, first


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(lengths_of(vectors), 1e-300)[..., None], dtype=np.float64)
