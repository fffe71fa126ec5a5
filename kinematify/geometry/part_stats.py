"""Facts of each part for the topology stage: where it is, how large it is, what it can stand on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from kinematify.robot.arrays import read_only
from kinematify.robot.vectors import crossed, lengths_of, referenced, triangle_normals

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly, Part
    from kinematify.robot.arrays import FloatArray

_VOLUME_FLOOR = 1e-12
"""Smallest volume of a part in units of its cubed diagonal; keeps ratios of flat parts finite."""
_LEVEL = float(np.cos(np.radians(3.0)))
"""A hull facet is level when its normal is within 3 degrees of the vertical."""
_TOUCHES = 1e-3
"""What lies this far above the lowest point touches the floor, in diagonals of the part."""
_NEAR = 0.03
"""So do level faces up to this height: real bottoms are a little tilted, or have small feet."""
_FOOT = 0.05
"""What touches the floor spans at least this share of the footprint, or nothing could stand on it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PartStats:
    """Size and support of one part, world frame, z up (paper III-A: ``c_i``, ``v_i``, ``e_i``)."""

    centroid: FloatArray
    """Surface centroid ``c_i`` [m], shape (3,). Read-only."""
    volume: float
    """Robust volume ``v_i`` [m^3], positive: enclosed volume of a closed mesh, else volume of the convex hull."""
    hull_volume: float
    """Volume of the convex hull [m^3], positive; comparable between closed and open meshes."""
    bounds: FloatArray
    """Axis-aligned bounds [m], shape (2, 3). Read-only."""
    flat_bottom: float
    """Share of the part's footprint that stands flat on a level floor, in [0, 1]."""
    flat_top: float = 0.0
    """Share of the part's footprint that lies flat against a level ceiling, in [0, 1]."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "centroid", read_only(self.centroid, np.float64))
        object.__setattr__(self, "bounds", read_only(self.bounds, np.float64))

    @property
    def diagonal(self) -> float:
        """Length of the bounding box diagonal [m]."""
        return float(np.linalg.norm(self.bounds[1] - self.bounds[0]))

    @property
    def bottom(self) -> float:
        """Lowest point [m]."""
        return float(self.bounds[0, 2])

    @property
    def top(self) -> float:
        """Highest point [m]."""
        return float(self.bounds[1, 2])


def assembly_stats(assembly: Assembly) -> tuple[PartStats, ...]:
    """Measure every part of an assembly, in order."""
    return tuple(part_stats(part) for part in assembly.parts)


def part_stats(part: Part) -> PartStats:
    """Measure one part; flat and open meshes get a small positive volume."""
    floor = _VOLUME_FLOOR * max(part.diagonal, 1e-9) ** 3
    hull_volume, flat_bottom, flat_top = _hull_measures(part)
    hull_volume = max(hull_volume, floor)
    a, b, c = (part.vertices[part.faces[:, k]] - part.centroid for k in range(3))
    by_divergence = abs(float(np.einsum("ij,ij->i", a, crossed(b, c)).sum() / 6))
    enclosed = by_divergence if _is_closed(part) else hull_volume
    return PartStats(
        centroid=part.centroid,
        volume=max(enclosed, floor),
        hull_volume=hull_volume,
        bounds=part.bounds,
        flat_bottom=flat_bottom,
        flat_top=flat_top,
    )


def _hull_measures(part: Part) -> tuple[float, float, float]:
    """Hull volume [m^3] and shares of the footprint that are a level bottom and top; zeros for a flat part."""
    points = referenced(part.vertices, part.faces)
    try:
        hull = ConvexHull(points)
    except QhullError:
        return 0.0, 0.0, 0.0
    sides = points[hull.simplices]
    areas = 0.5 * lengths_of(triangle_normals(sides))
    up = hull.equations[:, 2]
    footprint = 0.5 * float((areas * np.abs(up)).sum())
    if footprint <= 0.0:
        return float(hull.volume), 0.0, 0.0
    corners = part.vertices[part.faces]
    below = float(areas[up < -_LEVEL].sum()) * _rests(corners, part.diagonal, footprint)
    above = float(areas[up > _LEVEL].sum()) * _rests(-corners, part.diagonal, footprint)
    return float(hull.volume), min(below / footprint, 1.0), min(above / footprint, 1.0)


def _rests(corners: FloatArray, diagonal: float, footprint: float) -> bool:
    """True if the surface that lies on the floor spans a fair share of the footprint.

    The hull of blades around a small cap is nearly level below, and there is nothing but the cap.
    """
    height = corners[:, :, 2] - corners[:, :, 2].min()
    normals = triangle_normals(corners)
    level = np.abs(normals[:, 2]) > _LEVEL * lengths_of(normals)
    lying = level & (height.max(axis=1) < _NEAR * diagonal)
    touching = np.concatenate([corners[lying].reshape(-1, 3), corners[height < _TOUCHES * diagonal]])[:, :2]
    try:
        return bool(ConvexHull(touching).volume > _FOOT * footprint)
    except (QhullError, ValueError):
        return False


def _is_closed(part: Part) -> bool:
    """True if every edge, by position, is walked once in each direction (meshes often repeat vertices)."""
    merged = np.unique(part.vertices, axis=0, return_inverse=True)[1].reshape(-1)[part.faces]
    merged = merged[(merged != np.roll(merged, 1, axis=1)).all(axis=1)]
    edges = np.concatenate([merged[:, [0, 1]], merged[:, [1, 2]], merged[:, [2, 0]]])
    codes = edges[:, 0] * (len(part.vertices) + 1) + edges[:, 1]
    back = edges[:, 1] * (len(part.vertices) + 1) + edges[:, 0]
    return len(codes) > 0 and bool(np.array_equal(np.sort(codes), np.sort(back)))
