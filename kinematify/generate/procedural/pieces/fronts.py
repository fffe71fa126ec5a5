"""Furniture with an open front, which doors and drawers close. Fronts look along -y, up is z."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.generate.procedural.pieces.leaves import Field
from kinematify.generate.procedural.solids import box, union

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold


@dataclass(frozen=True, kw_only=True)
class Bay(Field):
    """One field of a front, its outer border in the plane y = 0 of the carcass's front."""

    depth: float
    """Of the body behind it [m]."""
    wall: float
    """Thickness of the body's walls and of the panel [m]."""


@dataclass(frozen=True, kw_only=True)
class Fitting:
    """Mounting of fronts."""

    clearance: float
    """Gap between parts that move past each other [m]."""
    grip: str
    """Kind of handle."""
    rest: float
    """Share of the way that they stand open, in [0, 1]."""


def carcass(width: float, height: float, depth: float, openings: Sequence[Bay]) -> Manifold:
    """Return a body, its front in y = 0 and its floor in z = 0, with a room behind every opening."""
    body = box((-0.5 * width, 0.0, 0.0), (0.5 * width, depth, height))
    return body - union(*(room(opening) for opening in openings))


def room(opening: Bay) -> Manifold:
    """Return what to take away from a solid body to make the room behind an opening."""
    return opening.box(-opening.wall, opening.depth - opening.wall, inset=0.5 * opening.wall)
