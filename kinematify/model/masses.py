"""A mass and an inertia for every link: as declared where engines can use them, made up from the geometry elsewhere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import Part
from kinematify.config import load_config
from kinematify.geometry.convex import convex_hull, thickened
from kinematify.robot.robot import Inertial, rigid_groups
from kinematify.robot.vectors import as_one, crossed, lengths_of, referenced, triangle_normals
from kinematify.robot.weld import is_closed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import ModelConfig
    from kinematify.config.validation import PrepareSettings
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Link, Robot, Shape


_STURDY = 1e-6
"""By how much two principal moments exceed the third, at least: a sheet without thickness has none."""
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

    A closed mesh is integrated exactly by the divergence theorem; anything else is replaced by its convex hull. Bodies
    that would then weigh more than walls of their surface do are hollow, and weigh what the walls weigh. The result
    satisfies what engines demand: positive mass, a positive definite tensor, and the triangle inequality.

    Args:
        part: The mesh in world coordinates; may be open, flat or inside out.
        origin: Origin of the link frame in the world frame [m], shape (3,).
        thickness: A part that is thinner gets this thickness [m].
        config: Densities of parts that have none of their own, and lower bounds.

    Returns:
        Mass properties with source ``volume``, ``hull`` or ``shell``.
    """
    used = referenced(part.vertices, part.faces)
    thick = thickened(used, thickness)
    hull = _integrate(*convex_hull(thick))
    solid = _closed_volume(part) if len(thick) == len(used) else None
    # Shells that are nested with opposite winding or that overlap can integrate to nonsense; a hull cannot.
    if solid is not None and _plausible(solid, hull, part.bounds):
        density, source = part.density or config.solid_density, "volume"
    else:
        solid, density, source = hull, part.density or config.hull_density, "hull"
    if config.density is not None:
        return _weighed_solid(solid, config.density, source, origin, config)
    shell, weight = _walls(part), part.walls or config.wall_weight
    if density * solid.volume > weight * shell.volume > 0.0 and _sturdy(shell):
        return _weighed_solid(shell, weight, "shell", origin, config)
    return _weighed_solid(solid, density, source, origin, config)


def _walls(part: Part) -> _Solid:
    """Moments of the surface: its area takes the place of the volume [m^2]. Exact, by the middles of the edges."""
    corners = part.vertices[part.faces]
    crosses = triangle_normals(corners)
    areas = 0.5 * lengths_of(crosses)
    points = 0.5 * (corners + np.roll(corners, 1, axis=1)).reshape(-1, 3)
    weights = np.repeat(areas / 3.0, 3)
    area = float(areas.sum())
    center = weights @ points / area if area > 0.0 else np.zeros(3)
    arms = points - center
    second = (weights[:, None] * arms).T @ arms
    return _Solid(volume=area, center=center, tensor=np.trace(second) * np.eye(3) - second)


def _sturdy(solid: _Solid) -> bool:
    """True if the moments are those of something that extends in all directions, by more than engines round."""
    low, middle, high = np.linalg.eigvalsh(solid.tensor)
    return bool(low > 0.0 and low + middle > (1.0 + _STURDY) * high)


def _closed_volume(part: Part) -> _Solid | None:
    """Moments of the enclosed volume, or None if the mesh is not closed."""
    return _integrate(part.vertices, part.faces) if is_closed(part.vertices, part.faces) else None


def _integrate(vertices: FloatArray, faces: IntArray) -> _Solid:
    """Sum signed tetrahedra between the faces and a reference point inside the bounds."""
    reference = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    a, b, c = (vertices[faces[:, k]] - reference for k in range(3))
    six_volumes = np.einsum("ij,ij->i", a, crossed(b, c))
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


def _weighed_solid(solid: _Solid, density: float, source: str, origin: FloatArray, config: ModelConfig) -> Inertial:
    """Weigh a solid and raise what is below the engines' bounds."""
    mass = max(density * solid.volume, config.min_mass)
    tensor = solid.tensor * (mass / solid.volume)
    # The same amount on all principal moments keeps the axes and the triangle inequality.
    lift = max(config.min_inertia - float(np.linalg.eigvalsh(tensor)[0]), 0.0)
    tensor = 0.5 * (tensor + tensor.T) + lift * np.eye(3)
    return Inertial(mass=mass, center_of_mass=solid.center - origin, tensor=tensor, source=source)


_ROUNDING = 1e-9
"""Relative rounding of moments of inertia, well above that of engines that read them."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PreparedInertial(Inertial):
    """Mass and inertia that engines receive for a link."""

    mass_added: bool
    """True if the file states no mass above zero."""
    inertia_added: bool
    """True if the file states no tensor that engines take, or one that had to be changed by more than rounding."""


def prepared_inertials(model: Robot, settings: PrepareSettings) -> dict[str, PreparedInertial]:
    """Return mass properties for every link.

    A link without a usable mass that is fixed to links with one adds nothing, as its author meant it. Where no link of
    a rigid group has one, each link with geometry weighs what its volume suggests; frames without geometry weigh next
    to nothing.
    """
    found: dict[str, PreparedInertial] = {}
    for group in rigid_groups(model):
        links = [model.link_by_name[name] for name in group.links]
        weighed = any(usable_mass(link.inertial) for link in links)
        for link in links:
            found[link.name] = _inertial(link, weighed=weighed, settings=settings)
        if not weighed and not group.has_geometry:
            found[group.top] = _ball(settings.dummy_mass, settings)
    return found


def usable_mass(inertial: Inertial | None) -> bool:
    """True if there is a mass above zero."""
    return inertial is not None and inertial.mass > 0.0


def lifted(tensor: FloatArray) -> FloatArray | None:
    """Return the tensor with just enough added to all principal moments that no one exceeds the sum of the others.

    MuJoCo refuses what misses that by the last digit of the file. None where a moment is not above zero.

    Args:
        tensor: Shape (3, 3), symmetric.
    """
    low, middle, high = np.linalg.eigvalsh(tensor)
    if low <= _ROUNDING * high or high <= 0.0:
        return None
    excess = high - low - middle
    lift = excess + _ROUNDING * high if excess > -_ROUNDING * high else 0.0
    return np.asarray(tensor + lift * np.eye(3))


def _inertial(link: Link, *, weighed: bool, settings: PrepareSettings) -> PreparedInertial:
    declared = link.inertial
    if declared is None or not usable_mass(declared):
        part = None if weighed else link_part(link)
        return _ball(settings.frame_mass, settings) if part is None else _from_geometry(part)
    tensor = lifted(declared.tensor)
    if tensor is None:
        return _with_made_up_tensor(link, declared, settings)
    changed = float(np.abs(tensor - declared.tensor).max()) > settings.moment_slack * float(np.abs(tensor).max())
    return PreparedInertial(
        mass=declared.mass,
        center_of_mass=declared.center_of_mass,
        tensor=tensor,
        mass_added=False,
        inertia_added=changed,
    )


def _with_made_up_tensor(link: Link, declared: Inertial, settings: PrepareSettings) -> PreparedInertial:
    """Keep mass and centre; the tensor is that of the geometry, or of a small ball where there is none."""
    part = link_part(link)
    if part is None:
        tensor = np.eye(3) * declared.mass * settings.ball_radius**2
    else:
        guess = _from_geometry(part)
        tensor = guess.tensor * (declared.mass / guess.mass)
    return PreparedInertial(
        mass=declared.mass,
        center_of_mass=declared.center_of_mass,
        tensor=tensor,
        mass_added=False,
        inertia_added=True,
    )


@cache
def _densities() -> ModelConfig:
    return load_config().model


def _from_geometry(part: Part) -> PreparedInertial:
    config = _densities()
    solid = inertial_of(part, np.zeros(3), thickness=config.min_thickness * part.diagonal, config=config)
    return PreparedInertial(
        mass=solid.mass,
        center_of_mass=solid.center_of_mass,
        tensor=solid.tensor,
        source=solid.source,
        mass_added=True,
        inertia_added=True,
    )


def _ball(mass: float, settings: PrepareSettings) -> PreparedInertial:
    return PreparedInertial(
        mass=mass,
        center_of_mass=np.zeros(3),
        tensor=np.eye(3) * mass * settings.ball_radius**2,
        source="ball",
        mass_added=True,
        inertia_added=True,
    )


def link_part(link: Link) -> Part | None:
    """All solid geometry of a link as one mesh: the visual one, which shows the true shape, else the collision one."""
    shapes = link.visuals or link.collisions
    return merged_part(link.name, shapes) if shapes else None


def merged_part(name: str, shapes: Sequence[Shape]) -> Part:
    """Put shapes together in the link frame."""
    vertices, faces = as_one((shape.mesh.vertices, shape.mesh.faces) for shape in shapes)
    return Part(name=name, vertices=vertices, faces=faces)
