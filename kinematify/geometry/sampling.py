"""Surface samples of a part: area-uniform, stratified and reproducible.

`sample_surface` samples a part as it is given; `geometry.surface` interpolates smooth normals at the same places.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import AssemblyError
from kinematify.robot.arrays import read_only
from kinematify.robot.vectors import triangle_normals

if TYPE_CHECKING:
    from kinematify.assembly.part import Part
    from kinematify.robot.arrays import FloatArray, IntArray

# Generator of the two-dimensional Kronecker sequence of lowest discrepancy (powers of the plastic number's inverse).
_KRONECKER = np.array([0.7548776662466927, 0.5698402909980532])
_MORTON_BITS = 20  # 3 x 20 bits fill an int64; cells of 1e-6 of the part's size
_SPREAD_STEPS = (
    (32, 0x001F00000000FFFF),
    (16, 0x001F0000FF0000FF),
    (8, 0x100F00F00F00F00F),
    (4, 0x10C30C30C30C30C3),
    (2, 0x1249249249249249),
)  # each halves the runs of adjacent bits


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfaceSamples:
    """Points on the surface of one part, in the world frame."""

    points: FloatArray
    """World frame [m], shape (n, 3). Read-only."""
    normals: FloatArray
    """Unit normals of the faces that the points lie on, shape (n, 3). Read-only."""
    areas: FloatArray
    """Surface area that each sample represents [m^2], shape (n,); sums to the part's area. Read-only."""
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
        raise AssemblyError(f"Part {part.name} has no surface area to sample; remove it or fix its mesh.")
    corners = part.vertices[part.faces]
    faces, barycentric = place_samples(corners, part.face_areas, curve_order(corners, part.face_areas), count, seed)
    return SurfaceSamples(
        points=np.einsum("nc,ncd->nd", barycentric, corners[faces]),
        normals=_unit_normals(corners[faces]),
        areas=np.full(count, part.area / count),
        faces=faces,
    )


def curve_order(corners: FloatArray, areas: FloatArray) -> IntArray:
    """Order faces along a Morton curve through their centres; ties (twin faces) fall back on the area.

    Args:
        corners: Corners of every face [m], shape (F, 3, 3), not all in one point.
        areas: Area of every face [m^2], shape (F,).

    Returns:
        Indices of faces, shape (F,); the same walk over the surface however the faces are listed.
    """
    centres = corners.mean(axis=1)
    lower, upper = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    # Rounding decides the cell; the half cell keeps symmetric parts away from its edge.
    cells = ((centres - lower) / (upper - lower).max() * (2**_MORTON_BITS - 2) + 0.5).astype(np.int64)
    return np.lexsort((areas, morton_codes(cells)))


def place_samples(
    corners: FloatArray, areas: FloatArray, order: IntArray, count: int, seed: int
) -> tuple[IntArray, FloatArray]:
    """Place `count` samples at equal steps of area along a walk over faces.

    Args:
        corners: Corners of every face [m], shape (F, 3, 3).
        areas: Area of every face [m^2], shape (F,).
        order: The faces to walk, from `curve_order`, with positive total area, shape (n,).
        count: Number of samples.
        seed: Shifts the sequence.

    Returns:
        Face of each sample, shape (count,), and its barycentric coordinates there, shape (count, 3).
    """
    shift = np.random.default_rng(seed).random(3)
    faces = _systematic_faces(areas, order, count, shift[0])
    square = (np.arange(1, count + 1)[:, None] * _KRONECKER + shift[1:]) % 1.0
    return faces, _unturned(_barycentric(square), corners[faces])


def morton_codes(cells: IntArray) -> IntArray:
    """Places of cells (n, 3) of 20 bits along a Morton curve, shape (n,)."""
    return np.asarray(_every_third_bit(cells) @ np.array([1, 2, 4]))


def _every_third_bit(cells: IntArray) -> IntArray:
    """Spread the bits of 20-bit numbers so that two zeros lie between any two of them."""
    code = cells
    for step, mask in _SPREAD_STEPS:
        code = (code | (code << step)) & mask
    return code


def _systematic_faces(areas: FloatArray, order: IntArray, count: int, shift: float) -> IntArray:
    """Faces met at `count` equal steps of accumulated area, shape (count,)."""
    accumulated = np.cumsum(areas[order])
    steps = (np.arange(count) + shift) * (accumulated[-1] / count)
    met = np.searchsorted(accumulated, steps, side="right")  # `right` never stops at a face without area
    last = np.flatnonzero(areas[order])[-1]
    found: IntArray = order[np.minimum(met, last)]
    return found


def _barycentric(square: FloatArray) -> FloatArray:
    """Map the unit square to barycentric coordinates, keeping areas, (n, 2) -> (n, 3)."""
    root = np.sqrt(square[:, 0])
    return np.stack([1.0 - root, root * (1.0 - square[:, 1]), root * square[:, 1]], axis=1)


def _unturned(barycentric: FloatArray, corners: FloatArray) -> FloatArray:
    """Count coordinates (n, 3) from a corner that the geometry picks, not from the one that is listed first."""
    along = (corners - corners.mean(axis=1, keepdims=True)) @ np.array([0.5377, 0.6911, 0.4829])
    first = along.argmin(axis=1)
    # Column c of the result belongs to the listed corner c, which is number (c - first) from the picked one.
    return np.take_along_axis(barycentric, (np.arange(3) - first[:, None]) % 3, axis=1)


def _unit_normals(corners: FloatArray) -> FloatArray:
    """Unit normals of triangles of positive area, (n, 3, 3) -> (n, 3)."""
    normals = triangle_normals(corners)
    lengths: FloatArray = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(normals / np.maximum(lengths, np.finfo(np.float64).tiny), dtype=np.float64)


def spread_rows(lower: FloatArray, upper: FloatArray, rows: int, seed: int) -> FloatArray:
    """Latin hypercube in the box of the limits, shape (rows, m): every joint's range is covered evenly.

    NumPy alone makes it; SciPy's Sobol points would cost half a second for the import.
    """
    generator = np.random.default_rng(seed)
    strata = np.array([generator.permutation(rows) for _ in lower]).reshape(len(lower), rows).T
    points: FloatArray = (strata + generator.random(strata.shape)) / rows
    return lower + points * (upper - lower)
