"""Mass, centre of mass and inertia tensor of a link from its geometry.

A closed mesh is integrated exactly by the divergence theorem; anything else is replaced by its convex hull, which
`Inertial.source` states. The result always satisfies what physics engines demand: positive mass, a positive definite
tensor and the triangle inequality between principal moments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.hull import convex_hull, thickened
from kinematify.robot.robot import Inertial
from kinematify.robot.weld import is_closed

if TYPE_CHECKING:
    from kinematify.assembly.part import Part
    from kinematify.config import ModelConfig
    from kinematify.robot.arrays import FloatArray, IntArray

_SLACK = 1e-6  # relative rounding of a volume compared with that of the hull


@dataclass(frozen=True)
class _Solid:
    """Moments of a solid of unit density about the world origin's axes."""

    volume: float
    """[m^3]."""
    center: FloatArray
    """Centre of volume, world frame [m], shape (3,)."""
    tensor: FloatArray
    """Inertia about the centre, world axes, unit density [m^5], shape (3, 3)."""


def inertial_of(part: Part, origin: FloatArray, *, thickness: float, config: ModelConfig) -> Inertial:
    """Mass properties of a part in a link frame of world orientation.

    Args:
        part: The mesh in world coordinates; may be open, flat or inside out.
        origin: Origin of the link frame in the world frame [m], shape (3,).
        thickness: A part that is thinner gets this thickness [m].
        config: Densities of parts that have none of their own, and lower bounds.

    Returns:
        Mass properties with source ``volume`` or ``hull``.
    """
    used = part.vertices[np.unique(part.faces)]
    thick = thickened(used, thickness)
    hull = _integrate(*convex_hull(thick))
    solid = _closed_volume(part) if len(thick) == len(used) else None
    # Shells that are nested with opposite winding or that overlap can integrate to nonsense; a hull cannot.
    if solid is not None and _plausible(solid, hull, part.bounds):
        return _inertial(solid, part.density or config.solid_density, "volume", origin, config)
    return _inertial(hull, part.density or config.hull_density, "hull", origin, config)


def _closed_volume(part: Part) -> _Solid | None:
    """Moments of the enclosed volume, or None if the mesh is not closed."""
    return _integrate(part.vertices, part.faces) if is_closed(part.vertices, part.faces) else None


def _integrate(vertices: FloatArray, faces: IntArray) -> _Solid:
    """Sum signed tetrahedra between the faces and a reference point inside the bounds."""
    reference = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    a, b, c = (vertices[faces[:, k]] - reference for k in range(3))
    six_volumes = np.einsum("ij,ij->i", a, np.cross(b, c))
    total = a + b + c
    volume = float(six_volumes.sum()) / 6.0
    first = six_volumes @ total / 24.0
    second = np.einsum("n,ni,nj->ij", six_volumes, total, total)
    for corner in (a, b, c):
        second = second + np.einsum("n,ni,nj->ij", six_volumes, corner, corner)
    center = first / volume if volume != 0.0 else np.zeros(3)
    central = second / 120.0 - volume * np.outer(center, center)
    tensor = np.trace(central) * np.eye(3) - central
    # A mesh that is inside out has all its moments negated.
    sign = 1.0 if volume >= 0.0 else -1.0
    return _Solid(volume=sign * volume, center=center + reference, tensor=sign * tensor)


def _plausible(solid: _Solid, hull: _Solid, bounds: FloatArray) -> bool:
    """True if the moments can be those of a solid within the hull."""
    if not 0.0 < solid.volume <= hull.volume * (1.0 + _SLACK):
        return False
    inside = bool(np.all(solid.center >= bounds[0]) and np.all(solid.center <= bounds[1]))
    low, middle, high = np.linalg.eigvalsh(solid.tensor)
    return bool(inside and low > 0.0 and low + middle > high)


def _inertial(solid: _Solid, density: float, source: str, origin: FloatArray, config: ModelConfig) -> Inertial:
    """Weigh a solid and raise what is below the engines' bounds."""
    mass = max(density * solid.volume, config.min_mass)
    tensor = solid.tensor * (mass / solid.volume)
    # The same amount on all principal moments keeps the axes and the triangle inequality.
    lift = max(config.min_inertia - float(np.linalg.eigvalsh(tensor)[0]), 0.0)
    tensor = 0.5 * (tensor + tensor.T) + lift * np.eye(3)
    return Inertial(mass=mass, center_of_mass=solid.center - origin, tensor=tensor, source=source)
