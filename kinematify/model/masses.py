"""A mass and an inertia for every link: as declared where engines can use them, made up from the geometry elsewhere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import Part
from kinematify.config import load_config
from kinematify.model.inertia import inertial_of
from kinematify.robot.robot import Inertial, rigid_groups

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import ModelConfig
    from kinematify.config.validation import PrepareSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Link, Robot, Shape


_ROUNDING = 1e-9
"""Relative rounding of moments of inertia, well above that of engines that read them."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PreparedInertial(Inertial):
    """What engines are given for a link."""

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
    starts = np.cumsum([0, *(len(shape.mesh.vertices) for shape in shapes)])
    return Part(
        name=name,
        vertices=np.concatenate([shape.mesh.vertices for shape in shapes]),
        faces=np.concatenate([shape.mesh.faces + start for shape, start in zip(shapes, starts, strict=False)]),
    )
