"""Pairs of solids that let one part turn on another: barrel hinges, forks and flanged stubs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.solids import bore, box, cylinder, hull, point, union

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.builder import ObjectBuilder
    from kinematify.generate.procedural.solids import Point
    from kinematify.robot.arrays import FloatArray


Rectangle = tuple[float, float, float, float]
"""Lower x, upper x, lower y, upper y in a cross-section."""

ALONG_X = np.array([[0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]])
"""Turns what is built along z so that it runs along x: local x becomes y and local y becomes z."""
FRONT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns what is built to look along z so that it looks along -y, with its y up."""


def at(position: Point, turn: FloatArray | None = None) -> FloatArray:
    """Return the transform, shape (3, 4), that turns by `turn`, shape (3, 3), and then moves to `position`."""
    return np.column_stack([np.eye(3) if turn is None else turn, point(position)])


def barrel(
    length: float, radius: float, clearance: float, anchors: tuple[Rectangle, Rectangle], *, knuckles: int = 3
) -> tuple[Manifold, Manifold]:
    """Return the two sides of a barrel hinge about the z axis, centred at the origin.

    Knuckles alternate between the sides; the first side, which has the outer ones, owns the pin. Each knuckle
    reaches out to the rectangle of its side, which must overlap the body that it carries. A clearance that is large
    beside the radius is cut, so that there is a wall around the pin.
    """
    clearance = min(clearance, 0.3 * radius)
    pitch = length / knuckles
    sides: list[list[Manifold]] = [[], []]
    for k in range(knuckles):
        lower = -0.5 * length + k * pitch + 0.5 * clearance
        upper = lower + pitch - clearance
        x0, x1, y0, y1 = anchors[k % 2]
        round_part = cylinder(radius, (0, 0, lower), (0, 0, upper))
        sides[k % 2].append(hull(round_part, box((x0, y0, lower), (x1, y1, upper))))
    ends = (0, 0, -0.5 * length), (0, 0, 0.5 * length - clearance)
    pinned = union(*sides[0], cylinder(0.5 * radius, *ends))
    return pinned, union(*sides[1]) - bore(0.5 * radius, clearance, (0, 0, -length), (0, 0, length))


def fork(width: float, radius: float, clearance: float, reach: float) -> tuple[Manifold, Manifold]:
    """Return a fork that reaches down and a tongue that reaches up, hinged about the x axis at the origin.

    The tongue owns the pin. A body on the fork must stay below ``-fork_room(radius, clearance)`` and one on the
    tongue above it; both may be as wide as `width` and ``2 * radius`` thick. The hinge then turns by 90 degrees
    both ways.
    """
    inner, outer, clear = 0.25 * width, 0.5 * width, fork_room(radius, clearance)
    whole = cylinder(radius, (-outer, 0, 0), (outer, 0, 0)) + box((-outer, -radius, -reach), (outer, radius, 0))
    slot = box((-inner, -2 * radius, -clear), (inner, 2 * radius, 2 * radius))
    forked = whole - slot - bore(0.5 * radius, clearance, (-width, 0, 0), (width, 0, 0))
    half = inner - clearance
    tongue = cylinder(radius, (-half, 0, 0), (half, 0, 0)) + box((-half, -radius, 0), (half, radius, reach))
    return forked, tongue + cylinder(0.5 * radius, (-outer, 0, 0), (outer, 0, 0))


def bent_fork(
    pivot: Point, leans: tuple[float, float], width: float, radius: float, clearance: float
) -> tuple[Manifold, Manifold]:
    """Return a fork and a tongue as `fork` does, about the x axis through `pivot`, where the links meet at an angle.

    Args:
        pivot: Where the pin is [m].
        leans: Of the link with the fork and of the one with the tongue: from the upright towards -y [rad].
        width: Along the pin [m].
        radius: Of the knuckles [m].
        clearance: Between both [m]; cut where it is large beside the radius.
    """
    halves = fork(width, radius, min(clearance, 0.15 * radius), 2.2 * radius)
    forked, tongue = (half.rotate((np.degrees(lean), 0, 0)) for half, lean in zip(halves, leans, strict=True))
    return forked.translate(pivot), tongue.translate(pivot)


def fork_room(radius: float, clearance: float) -> float:
    """Return the distance from the axis of a fork at which bodies may begin [m]."""
    return 1.05 * radius + clearance


def stub(
    pivot: Point, direction: Point, radius: float, clearance: float, *, length: float | None = None
) -> tuple[Manifold, Manifold, Manifold]:
    """Return a boss, the hole to drill into it and the rotor with its flange and shaft.

    Boss and rotor are equal cylinders that meet at `pivot`; `direction` points from the boss to the rotor. The
    hole is to be taken away when the boss has become one with its body.
    """
    length = length or radius
    start, along = point(pivot), point(direction)
    boss = cylinder(radius, start - length * along, start)
    hole = bore(0.55 * radius, clearance, start - (0.7 * length + clearance) * along, start + clearance * along)
    flange = cylinder(radius, start + clearance * along, start + (length + clearance) * along)
    shaft = cylinder(0.55 * radius, start - 0.7 * length * along, start + 0.5 * length * along)
    return boss, hole, flange + shaft


@dataclass(frozen=True, kw_only=True)
class BackEdge:
    """Where two bodies with flush back faces lie on each other; the edge runs along x."""

    y: float
    """Of both back faces [m]."""
    level: float
    """Underside of the upper body, which is where the pin will be [m]."""
    below: float
    """Height of the lower body's back face under it [m]."""
    above: float
    """Height of the upper body's back face [m]."""
    clearance: float
    """Between the bodies, and between them and the knuckles [m]."""


def add_barrels(
    b: ObjectBuilder,
    upper: str,
    parent: str,
    edge: BackEdge,
    places: Sequence[float],
    *,
    length: float,
    radius: float,
    knuckles: int = 3,
) -> tuple[float, float, float]:
    """Add barrel hinges between an upper body and its parent, which are there; returns a point on the pins.

    The upper body then turns about -x until its back face meets the knuckles, beyond 90 degrees.
    """
    pivot = (0.0, edge.y + radius + edge.clearance, edge.level)
    face = -radius - edge.clearance  # a knuckle that reached deeper than this would meet the other body
    below, above = min(3.0 * radius, edge.below), min(3.0 * radius, edge.above)
    on_lower = (face - 2e-4, face + 1e-4, -edge.clearance - below, -edge.clearance - 0.2 * below)
    on_upper = (face - 2e-4, face + 1e-4, 0.2 * above, above)
    halves = barrel(length, radius, edge.clearance, (on_lower, on_upper), knuckles=knuckles)
    for x in places:
        place = at((x, pivot[1], pivot[2]), ALONG_X[:, :3])
        for name, half in zip((parent, upper), halves, strict=True):
            b.part(name, half.transform(place))
    return pivot
