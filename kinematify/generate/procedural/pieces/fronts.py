"""Furniture with an open front, and the doors and drawers that close it. Fronts look along -y, up is z."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.builder import drawn_on
from kinematify.generate.library.panels import drawer, leaf
from kinematify.generate.procedural.pieces.leaves import Field
from kinematify.generate.procedural.solids import X, Z, box, union

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.workshop import Workshop


_REVEAL = 0.002  # of a front towards its neighbours, besides the clearance


@dataclass(frozen=True, kw_only=True)
class Bay(Field):
    """One field of a front, its outer border in the plane y = 0 of the carcass's front."""

    depth: float
    """Of the body behind it [m]."""
    wall: float
    """Thickness of the body's walls and of the panel [m]."""


@dataclass(frozen=True, kw_only=True)
class Fitting:
    """How fronts are mounted."""

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


def add_drawer(workshop: Workshop, name: str, parent: str, opening: Bay, fitting: Fitting) -> None:
    """Add a drawer that runs in the room behind an opening and comes out along -y."""
    edge = 0.5 * opening.wall
    lower = opening.left + edge, 0.0, opening.bottom + edge
    upper = opening.right - edge, opening.depth - opening.wall, opening.top - edge
    lap = edge - 0.5 * (fitting.clearance + _REVEAL)
    with drawn_on(workshop, fitting.clearance, fitting.rest) as d:
        drawer(d, name, parent, lower, upper, travel=0.8, lap=lap, front=opening.wall, handle=fitting.grip)


def add_door(
    workshop: Workshop,
    name: str,
    parent: str,
    opening: Bay,
    fitting: Fitting,
    *,
    side: str,
    hinge: str = "edge",
) -> None:
    """Add what closes an opening and turns outwards about a line at one side of it.

    Args:
        workshop: Where it is added.
        name: Of the door.
        parent: The body that carries it; a barrel hinge leaves its other half there.
        opening: What the door covers.
        fitting: Gaps, handle and where it is.
        side: ``left`` or ``right``, or ``bottom`` of what falls open.
        hinge: ``edge`` (nothing to be seen) or ``barrel``, beside which nothing may be.
    """
    edge, reach = {"left": (-X, 1.8), "right": (X, 1.8), "bottom": (-Z, 0.5 * np.pi)}[side]
    less = 0.5 * _REVEAL
    lower = opening.left + less, -opening.wall, opening.bottom + less
    with drawn_on(workshop, fitting.clearance, fitting.rest) as d:
        leaf(
            d, name, parent, lower, (opening.right - less, 0.0, opening.top - less), hinge=edge, reach=reach,
            handle=fitting.grip, barrels=2 if hinge == "barrel" else 0,
        )  # fmt: skip
