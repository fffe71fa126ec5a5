"""Meshes as a voxel remesher leaves them: an isosurface of the signed distance on a grid, walls no thinner than a cell.

Generators and scanners give such meshes: edges are chamfered, faces are no larger than a cell, and what is thinner than
a cell becomes a wall.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import igl
import numpy as np

from kinematify.paper.sdf_grid import exact_signed_distance

if TYPE_CHECKING:
    from kinematify.assembly.part import Part
    from kinematify.robot.arrays import FloatArray, IntArray

_DENSITY = 12  # samples per square of a cell's side: next to no cell that the surface crosses is missed
_MOST_SAMPLES = 4_000_000
_KEPT = 0.95  # share of the surface that must be found again; otherwise the part is too thin or open for a solid
_WALL = 0.75  # half the thickness of the wall that represents a thin or open surface, cells
_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])


def voxel_remeshed(part: Part, pitch: float, *, seed: int = 0) -> Part:
    """Return a part remeshed on a grid through the world's origin.

    Args:
        part: Any mesh with area.
        pitch: Side of a cell [m].
        seed: Of the samples that find the cells near the surface.
    """
    samples = _samples(part, pitch, seed)
    cells = _near_cells(samples, pitch)
    solid = _isosurface(part, cells, pitch, wall=None)
    if solid is not None:
        remeshed = replace(part, vertices=solid[0], faces=solid[1])
        few = samples[:: 1 + len(samples) // 2000]
        if np.mean(np.abs(exact_signed_distance(remeshed, few)) < pitch) > _KEPT:
            return remeshed
    wall = _isosurface(part, cells, pitch, wall=_WALL * pitch)
    return part if wall is None else replace(part, vertices=wall[0], faces=wall[1])


def _samples(part: Part, pitch: float, seed: int) -> FloatArray:
    """Points all over the surface, several per cell, shape (n, 3)."""
    rng = np.random.default_rng(seed)
    areas = part.face_areas
    count = int(min(_DENSITY * areas.sum() / pitch**2 + 200, _MOST_SAMPLES))
    picked = rng.choice(len(areas), size=count, p=areas / areas.sum())
    u, v = np.sqrt(rng.random(count)), rng.random(count)
    weights = np.stack([1 - u, u * (1 - v), u * v], axis=1)
    inner = np.einsum("nk,nkd->nd", weights, part.vertices[part.faces[picked]])
    return np.concatenate([part.vertices[np.unique(part.faces)], inner])


def _near_cells(samples: FloatArray, pitch: float) -> IntArray:
    """Lower corners of the cells that the surface crosses and of their neighbours, as numbers of corners, (n, 3)."""
    crossed, _ = _distinct(np.floor(samples / pitch - 0.5).astype(np.int64))
    around = np.stack(np.meshgrid(*[np.arange(-1, 2)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return _distinct((crossed[:, None] + around).reshape(-1, 3))[0]


def _distinct(rows: IntArray) -> tuple[IntArray, IntArray]:
    """Distinct rows (n, 3) and which of them every row is; one number per row sorts far quicker than three."""
    lowest = rows.min(axis=0)
    x, y, z = (rows - lowest).T
    keys, index = np.unique((x << 42) + (y << 21) + z, return_inverse=True)
    mask = (1 << 21) - 1
    return np.stack([keys >> 42, keys >> 21 & mask, keys & mask], axis=1) + lowest, index.reshape(-1)


def _isosurface(part: Part, cells: IntArray, pitch: float, *, wall: float | None) -> tuple[FloatArray, IntArray] | None:
    """Vertices and faces of the solid, or of a wall about the surface; None where nothing is left."""
    corners, index = _distinct((cells[:, None] + _CORNERS).reshape(-1, 3))
    # Half a cell off, so that walls at round coordinates do not lie on the grid.
    places: FloatArray = np.asarray((corners + 0.5) * pitch, dtype=np.float64)
    field = exact_signed_distance(part, places)
    field = field if wall is None else np.abs(field) - wall
    grid = np.ascontiguousarray(index.reshape(-1, 8))
    vertices, faces, _ = igl.marching_cubes(field, places, grid, 0.0)
    return (vertices, faces) if len(faces) else None
