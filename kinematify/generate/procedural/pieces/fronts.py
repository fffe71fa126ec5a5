"""Furniture with an open front, and the doors and drawers that close it. Fronts look along -y, up is z."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import ALONG_X, at, barrel
from kinematify.generate.procedural.pieces.leaves import Field
from kinematify.generate.procedural.solids import ball, box, cylinder, off, rod, tray, union

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.solids import Point
    from kinematify.generate.procedural.workshop import Workshop


_SUNK = 1e-3  # how deep a handle reaches into its front, so that both are one solid


def handle_solids(kind: str, at: Point, *, along: str, length: float) -> list[Manifold]:
    """Return the solids of a handle.

    Args:
        kind: ``bar``, ``knob``, ``cup``, ``edge`` or ``none``.
        at: Where its middle meets the front [m]; the front's outer face lies in y = at[1].
        along: ``x`` or ``z``, the direction of a long one.
        length: Of a long one [m].
    """
    x, y, z = at
    half = 0.5 * length
    if kind == "knob":
        return [cylinder(0.006, (x, y + _SUNK, z), (x, y - 0.02, z)), ball(0.014, (x, y - 0.026, z))]
    if kind == "bar":
        ends = [(x - half, y - 0.03, z), (x + half, y - 0.03, z)]
        feet = [(x - 0.8 * half, z), (x + 0.8 * half, z)]
        if along == "z":
            ends = [(x, y - 0.03, z - half), (x, y - 0.03, z + half)]
            feet = [(x, z - 0.8 * half), (x, z + 0.8 * half)]
        posts = [cylinder(0.005, (fx, y + _SUNK, fz), (fx, y - 0.03, fz), segments=24) for fx, fz in feet]
        return [rod(0.006, *ends), *posts]
    if kind == "cup":
        half = min(half, 0.04)  # it always lies, and must not reach beyond a door's free edge
        outer = cylinder(0.03, (x - half, y, z), (x + half, y, z)) - cylinder(0.025, (x - half, y, z), (x + half, y, z))
        caps = [cylinder(0.03, (x + s * half, y, z), (x + s * (half - 0.003), y, z)) for s in (-1, 1)]
        below = box((x - length, y - 0.1, z - 0.1), (x + length, y + 0.1, z))
        behind = box((x - length, y + _SUNK, z - 0.1), (x + length, y + 0.1, z + 0.1))
        return [union(outer, *caps) - below - behind]
    if kind == "edge":
        size = (half, 0.004) if along == "x" else (0.004, half)
        return [box((x - size[0], y - 0.02, z - size[1]), (x + size[0], y + _SUNK, z + size[1]))]
    return []


_REVEAL = 0.002  # of a front towards its neighbours, besides the clearance
_BARREL = (0.004, 0.06)  # radius and length of a barrel hinge [m]


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


def panel(opening: Bay, clearance: float) -> Manifold:
    """Return the board that covers an opening from outside."""
    return opening.box(-clearance - opening.wall, -clearance, inset=0.5 * (clearance + _REVEAL))


def add_drawer(workshop: Workshop, name: str, parent: str, opening: Bay, fitting: Fitting) -> None:
    """Add a drawer that runs in the room behind an opening and comes out along -y."""
    clearance = fitting.clearance
    edge, wall = 0.5 * opening.wall + clearance, min(0.012, 0.1 * opening.width)
    rim = opening.bottom + edge + 0.75 * (opening.height - 2.0 * edge)
    inner = tray(
        (opening.left + edge, -clearance - 1e-3, opening.bottom + edge),
        (opening.right - edge, opening.depth - opening.wall - clearance, rim),
        wall,
    )
    workshop.add(parent, *_kickers(opening, rim + clearance, edge + wall))
    front = -clearance - opening.wall
    middle = (opening.middle[0], front, opening.middle[1])
    solids = workshop.as_handle(*handle_solids(fitting.grip, middle, along="x", length=min(0.16, 0.5 * opening.width)))
    workshop.body(name, panel(opening, clearance), inner, *solids)
    travel = 0.8 * (opening.depth - opening.wall)
    workshop.slides(name, parent, (0, -1, 0), middle, (0.0, travel), rest=fitting.rest)


def _kickers(opening: Bay, bottom: float, reach: float) -> list[Manifold]:
    """Strips along both sides of a room, above the rim of the drawer, so that it neither lifts nor tips when it is out.

    Args:
        opening: Whose room it is.
        bottom: Height of their undersides [m].
        reach: How far they reach in from the sides of the opening [m].
    """
    hold, back, top = 0.25 * opening.wall, opening.depth - 0.75 * opening.wall, opening.top - 0.25 * opening.wall
    if top - bottom < hold:
        return []
    return [
        box((opening.left + hold, 0.0, bottom), (opening.left + reach, back, top)),
        box((opening.right - reach, 0.0, bottom), (opening.right - hold, back, top)),
    ]


def add_door(
    workshop: Workshop,
    name: str,
    parent: str,
    opening: Bay,
    fitting: Fitting,
    *,
    side: str,
    outermost: bool,
    hinge: str,
) -> None:
    """Add a door that turns outwards about a vertical line at one side of an opening.

    Args:
        workshop: Where it is added.
        name: Of the door.
        parent: The body that carries it; a barrel hinge leaves its other half there.
        opening: What the door covers.
        fitting: Gaps, handle and where it is.
        side: ``left`` or ``right``.
        outermost: True if nothing is beside the hinge; then the door may turn about its inner edge.
        hinge: ``edge`` (nothing to be seen) or ``barrel``.
    """
    clearance = fitting.clearance
    sign = 1.0 if side == "left" else -1.0  # from the hinge to the free side
    at_hinge = opening.left if side == "left" else opening.right
    front, back = -clearance - opening.wall, -clearance
    free = at_hinge + sign * (opening.width - 0.05)
    level = opening.middle[1]
    length = min(0.2, 0.4 * opening.height)
    grip = handle_solids(fitting.grip, (free, front, level), along="z", length=length)
    solids = [panel(opening, clearance), *workshop.as_handle(*grip)]
    pivot = (
        at_hinge if outermost else at_hinge + sign * 0.5 * (clearance + _REVEAL),
        back if outermost else front,
        level,
    )
    if hinge == "barrel" and outermost:
        pivot = (at_hinge - sign * (_BARREL[0] + clearance), 0.5 * (front + back), level)
        of_body, of_door = _barrels(opening, pivot, at_hinge, sign, clearance)
        for share in (0.15, 0.85):
            height = (0.0, 0.0, opening.bottom + share * opening.height - level)
            workshop.add(parent, of_body.translate(height))
            solids.append(of_door.translate(height))
    workshop.body(name, *solids)
    workshop.turns(name, parent, (0, 0, -sign), pivot, (0.0, 1.8), rest=fitting.rest)


def _barrels(
    opening: Bay, pivot: tuple[float, float, float], at_hinge: float, sign: float, clearance: float
) -> tuple[Manifold, Manifold]:
    """Both halves of a barrel hinge about the vertical line through `pivot`, its middle there."""
    radius, length = _BARREL
    side = sign * (at_hinge - pivot[0])
    on_body = (side - 0.003, side + 0.001, -pivot[1] + 0.002, -pivot[1] + 0.02)
    start = side + 0.5 * (clearance + _REVEAL)
    on_door = (start, start + 0.02, -0.5 * opening.wall, -0.5 * opening.wall + 0.003)
    halves = barrel(length, radius, clearance, (on_body, on_door))
    of_body, of_door = (half if sign > 0 else half.mirror((1, 0, 0)) for half in halves)
    return of_body.translate(pivot), of_door.translate(pivot)


def add_flap(workshop: Workshop, name: str, parent: str, opening: Bay, fitting: Fitting, *, hinge: str) -> None:
    """Add a door that falls open about a horizontal line at its lower edge; `hinge` as for `add_door`."""
    clearance = fitting.clearance
    front, back = -clearance - opening.wall, -clearance
    middle = opening.middle[0]
    grip = (middle, front, opening.top - min(0.05, 0.15 * opening.height))
    bar = handle_solids(fitting.grip, grip, along="x", length=0.7 * opening.width)
    solids = [panel(opening, clearance), *workshop.as_handle(*bar)]
    pivot = (middle, back, opening.bottom)
    if hinge == "barrel":
        pivot = (middle, 0.5 * (front + back), opening.bottom - _BARREL[0] - clearance)
        level = opening.bottom - pivot[2]
        on_body = (-pivot[1] + 0.002, -pivot[1] + 0.02, level - 0.003, level + 0.001)
        start = level + 0.5 * (clearance + _REVEAL)
        on_door = (-0.5 * opening.wall, -0.5 * opening.wall + 0.003, start, start + 0.02)
        halves = barrel(_BARREL[1], _BARREL[0], clearance, (on_body, on_door))
        for share in (-0.35, 0.35):
            place = at(off(pivot, share * opening.width, 0, 0), ALONG_X[:, :3])
            of_body, of_door = (half.transform(place) for half in halves)
            workshop.add(parent, of_body)
            solids.append(of_door)
    workshop.body(name, *solids)
    workshop.turns(name, parent, (1, 0, 0), pivot, (0.0, 0.5 * np.pi), rest=fitting.rest)
