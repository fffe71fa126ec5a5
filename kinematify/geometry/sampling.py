"""Surface samples of a part: area-uniform, stratified and reproducible."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import read_only
from kinematify.errors import AssemblyError

if TYPE_CHECKING:
    from kinematify.assembly.part import FloatArray, IntArray, Part

# Generator of the two-dimensional Kronecker sequence of lowest discrepancy (powers of the plastic number's inverse).
_KRONECKER = np.array([0.7548776662466927, 0.5698402909980532])
_MORTON_BITS = 20  # 3 x 20 bits fill an int64; cells of 1e-6 of the part's size


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfaceSamples:
    """Points on the surface of one part, in the world frame."""

    points: FloatArray
    """World frame [m], shape (n, 3). Read-only."""
    normals: FloatArray
    """Unit normals of the faces that the points lie on, shape (n, 3). Read-only."""
    areas: FloatArray
    """Surface area that each sample stands for [m^2], shape (n,); sums to the part's area. Read-only."""
    faces: IntArray
    """Index of the face that each point lies on, shape (n,). Read-only."""

    def __post_init__(self) -> None:
        for name in ("points", "normals", "areas"):
            object.__setattr__(self, name, read_only(getattr(self, name), np.float64))
        object.__setattr__(self, "faces", read_only(self.faces, np.int64))


def sample_surface(part: Part, count: int, seed: int) -> SurfaceSamples:
    """Draw `count` points uniformly by area (the surface samples ``P_A`` of paper III-D).

    Faces are laid end to end by area along a space-filling curve and met at equal steps, so every face of more than
    ``area / count`` gets its share, neighbouring samples lie on neighbouring faces, and the order in which the mesh
    lists its faces does not matter. Inside a face the points follow a low-discrepancy sequence.

    Args:
        part: Any mesh with positive area; open shells and degenerate faces are fine.
        count: Number of samples, at least 1.
        seed: Shifts the sequence; the same seed gives the same points.

    Raises:
        AssemblyError: The part has no area.
        ValueError: `count` is below 1.
    """
    if count < 1:
        raise ValueError(f"A surface sample needs count >= 1, got {count}.")
    if not part.area > 0.0:
        raise AssemblyError(f"Part {part.name} has no surface area to sample; set it aside or mend its mesh.")
    shift = np.random.default_rng(seed).random(3)
    faces = _systematic_faces(part, count, shift[0])
    square = (np.arange(1, count + 1)[:, None] * _KRONECKER + shift[1:]) % 1.0
    corners = _canonical_corners(part.vertices[part.faces[faces]])
    return SurfaceSamples(
        points=np.einsum("nc,ncd->nd", _barycentric(square), corners),
        normals=_unit_normals(corners),
        areas=np.full(count, part.area / count),
        faces=faces,
    )


def _systematic_faces(part: Part, count: int, shift: float) -> IntArray:
    """Faces met at `count` equal steps of accumulated area, shape (count,)."""
    order = _curve_order(part)
    accumulated = np.cumsum(part.face_areas[order])
    steps = (np.arange(count) + shift) * (accumulated[-1] / count)
    met = np.searchsorted(accumulated, steps, side="right")  # `right` never stops at a face without area
    last = np.flatnonzero(part.face_areas[order])[-1]
    found: IntArray = order[np.minimum(met, last)]
    return found


def _curve_order(part: Part) -> IntArray:
    """Faces along a Morton curve through their centres; ties (twin faces) fall back on the area."""
    centres = part.vertices[part.faces].mean(axis=1)
    size = float(np.ptp(part.bounds, axis=0).max())
    # Rounding decides the cell; the half cell keeps symmetric parts away from its edge.
    cells = ((centres - part.bounds[0]) / size * (2**_MORTON_BITS - 2) + 0.5).astype(np.int64)
    code = np.zeros(len(cells), dtype=np.int64)
    for bit in range(_MORTON_BITS):
        for axis in range(3):
            code |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.lexsort((part.face_areas, code))


def _canonical_corners(corners: FloatArray) -> FloatArray:
    """Rotate each triangle's corners so that the listing order does not matter; winding is kept, shape (n, 3, 3)."""
    along = (corners - corners.mean(axis=1, keepdims=True)) @ np.array([0.5377, 0.6911, 0.4829])
    first = along.argmin(axis=1)
    turned = (first[:, None] + np.arange(3)) % 3
    return np.take_along_axis(corners, turned[:, :, None], axis=1)


def _barycentric(square: FloatArray) -> FloatArray:
    """Map the unit square to barycentric coordinates, keeping areas, (n, 2) -> (n, 3)."""
    root = np.sqrt(square[:, 0])
    return np.stack([1.0 - root, root * (1.0 - square[:, 1]), root * square[:, 1]], axis=1)


def _unit_normals(corners: FloatArray) -> FloatArray:
    """Unit normals of triangles of positive area, (n, 3, 3) -> (n, 3)."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths: FloatArray = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(normals / np.maximum(lengths, np.finfo(np.float64).tiny), dtype=np.float64)
