"""Furniture with an open front, which doors and drawers close. Fronts look along -y, up is z."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.generate.procedural.solids import box, union

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold


@dataclass(frozen=True, kw_only=True)
class Field:
    """Opening that one leaf closes: its borders in the plane of the frame [m]."""

    left: float
    right: float
    bottom: float
    top: float

    def box(self, start: float, end: float, *, inset: float = 0.0) -> Manifold:
        """Return the block over the field from y = `start` to y = `end`, smaller by `inset` on all four sides."""
        lower = (self.left + inset, start, self.bottom + inset)
        return box(lower, (self.right - inset, end, self.top - inset))

    @property
    def width(self) -> float:
        """[m]."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """[m]."""
        return self.top - self.bottom

    @property
    def middle(self) -> tuple[float, float]:
        """X and z."""
        return 0.5 * (self.left + self.right), 0.5 * (self.bottom + self.top)


@dataclass(frozen=True, kw_only=True)
class Bay(Field):
    """One field of a front, its outer border in the plane y = 0 of the carcass's front."""

    depth: float
    """Of the body behind it [m]."""
    wall: float
    """Thickness of the body's walls and of the panel [m]."""


def carcass(width: float, height: float, depth: float, openings: Sequence[Bay]) -> Manifold:
    """Return a body, its front in y = 0 and its floor in z = 0, with a room behind every opening."""
    body = box((-0.5 * width, 0.0, 0.0), (0.5 * width, depth, height))
    return body - union(*(room(opening) for opening in openings))


def room(opening: Bay) -> Manifold:
    """Return what to take away from a solid body to make the room behind an opening."""
    return opening.box(-opening.wall, opening.depth - opening.wall, inset=0.5 * opening.wall)
