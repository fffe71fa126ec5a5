"""Quality of the triangles of one mesh file as a surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.vectors import crossed
from kinematify.robot.weld import welded

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.raw_mesh import RawMesh


_PACKED = 1 << 21
"""So many vertices leave a number for each triple of them."""


@dataclass(frozen=True, kw_only=True)
class SurfaceQuality:
    """Figures of one mesh, equal corners merged."""

    faces: int
    """Triangles in the file."""
    degenerate: int
    """Of them without area."""
    diagonal: float
    """Of the bounding box, in the unit of the file."""
    thickness: float
    """Extent along the direction in which it is thinnest, same unit."""
    open_edges: int
    """Edges with one triangle."""
    opposed_edges: int
    """Edges at which two triangles face opposite sides."""
    twins: int
    """Triangles that lie on another one and face the other side: sheets that are seen from both."""
    volume: float
    """Signed volume without them, same unit cubed; negative where a closed mesh is inside out."""

    @property
    def closed(self) -> bool:
        """True if it encloses a volume."""
        return self.open_edges == 0 and self.faces > self.degenerate


def surface_quality(mesh: RawMesh) -> SurfaceQuality:
    """Measure a mesh whose coordinates are finite."""
    vertices, faces = welded(mesh.vertices, mesh.faces, 0.0)
    open_edges, opposed = _edges(faces, len(vertices))
    single = _without_twins(faces)
    return SurfaceQuality(
        faces=len(mesh.faces),
        degenerate=len(mesh.faces) - len(faces),
        diagonal=float(np.linalg.norm(np.ptp(mesh.vertices, axis=0))),
        thickness=_thickness(vertices),
        open_edges=open_edges,
        opposed_edges=opposed,
        twins=len(faces) - len(single),
        volume=_volume(vertices, single),
    )


def _edges(faces: IntArray, count: int) -> tuple[int, int]:
    """Edges with one triangle, and with two that run along it in the same direction."""
    if not len(faces):
        return 0, 0
    starts, ends = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    keys = np.minimum(starts, ends) * count + np.maximum(starts, ends)
    order = np.argsort(keys)
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))
    uses = np.diff(first, append=len(keys))
    balance = np.add.reduceat(np.where(starts < ends, 1, -1)[order], first)
    opposed = (uses == 2) & (balance != 0)
    return int((uses == 1).sum()), int(opposed.sum())


def _without_twins(faces: IntArray) -> IntArray:
    """Faces less those that have the corners of another one in the other order, shape (k, 3)."""
    if not len(faces):
        return faces
    corners, count = np.sort(faces, axis=1), int(faces.max()) + 1
    keys = corners @ [count * count, count, 1] if count < _PACKED else corners  # one number sorts far faster than three
    if len(np.unique(keys, axis=0)) == len(faces):
        return faces
    turned = np.argmin(faces, axis=1)
    rows = np.arange(len(faces))
    upward = faces[rows, (turned + 1) % 3] < faces[rows, (turned + 2) % 3]
    _, group = np.unique(keys, axis=0, return_inverse=True)
    group = group.ravel()
    both = np.minimum(np.bincount(group, upward), np.bincount(group, ~upward))
    single: IntArray = faces[both[group] == 0]
    return single


def _thickness(vertices: FloatArray) -> float:
    """Extent along the eigenvector of the covariance with the smallest eigenvalue."""
    if not len(vertices):
        return 0.0
    centred = vertices - vertices.mean(axis=0)
    _, axes = np.linalg.eigh(centred.T @ centred)
    return float(np.ptp(centred @ axes[:, 0]))


def _volume(vertices: FloatArray, faces: IntArray) -> float:
    if not len(faces):
        return 0.0
    a, b, c = (vertices[faces[:, k]] - vertices[0] for k in range(3))
    return float(np.einsum("fi,fi->", a, crossed(b, c)) / 6.0)
