"""Solids that objects are built from: boxes, cylinders and what booleans make of them.

Lengths are metres in the world frame. A circle is a polygon, so a bore is widened until even its flats keep the stated
clearance: a shaft turns in it without touching at any angle.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from manifold3d import CrossSection, Manifold, OpType

from kinematify.robot.transforms import across

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray

SEGMENTS = 48
"""Sides of the polygon that represents a circle."""

Point: TypeAlias = "Sequence[float] | FloatArray"
"""x, y, z [m]."""

Level: TypeAlias = "Point | float"
"""A point, or a height above the origin [m]."""

Span: TypeAlias = "tuple[float, float] | float"
"""Two bounds, or the upper one of what lies evenly about zero [m]."""

Solids: TypeAlias = "Manifold | Sequence[Solids]"
"""A solid, or some in lists."""

X, Y, Z = np.eye(3)


def flat(solids: Sequence[Solids]) -> list[Manifold]:
    """Return solids out of lists of them, in the same order."""
    return [solid for item in solids for solid in (flat(item) if isinstance(item, list | tuple) else [item])]


def vector(x: float, y: float, z: float) -> FloatArray:
    """Return a vector, shape (3,), that can be added and scaled."""
    return np.array([x, y, z], dtype=np.float64)


def point(given: Point) -> FloatArray:
    """Return a point as an array, shape (3,)."""
    return np.asarray(given, dtype=np.float64)


def off(start: Point, x: float, y: float, z: float) -> FloatArray:
    """Return a point moved by (x, y, z)."""
    return np.add(start, (x, y, z))


def box(lower: Point, upper: Point) -> Manifold:
    """Return the box between two corners, in any order."""
    low = np.minimum(lower, upper)
    return Manifold.cube(np.maximum(lower, upper) - low).translate(low)


def slab(x: Span, y: Span, z: Span) -> Manifold:
    """Return the box between bounds along each axis; one number bounds both sides of zero."""
    lower, upper = np.transpose([np.multiply((-1.0, 1.0), span) if np.ndim(span) == 0 else span for span in (x, y, z)])
    return box(lower, upper)


def block(middle: Point, size: Point) -> Manifold:
    """Return the box of a size about a point."""
    half = 0.5 * np.asarray(size)
    return box(np.subtract(middle, half), np.add(middle, half))


def beam(wide: float, high: float, start: Point, end: Point, side: Point = Z) -> Manifold:
    """Return the box between two points; `high` is measured along `side` as far as that is across the beam."""
    along = np.subtract(end, start, dtype=np.float64)
    length = float(np.linalg.norm(along))
    along /= length
    up = point(side) - along * float(along @ np.asarray(side))
    if np.linalg.norm(up) < 1e-6:
        up = np.eye(3)[np.argmin(np.abs(along))]
        up = up - along * float(along @ up)
    up /= np.linalg.norm(up)
    frame = np.column_stack([along, np.cross(up, along), up, 0.5 * np.add(start, end)])
    return Manifold.cube((length, wide, high), True).transform(frame)


def cylinder(radius: float, start: Level, end: Level, z: Span | None = None, *, segments: int = SEGMENTS) -> Manifold:
    """Return the cylinder whose circular faces are centred at `start` and `end`; see `_ends`."""
    return cone(radius, radius, start, end, z, segments=segments)


def cone(
    radius: float, top_radius: float, start: Level, end: Level, z: Span | None = None, *, segments: int = SEGMENTS
) -> Manifold:
    """Return the cone, or what is left of one without its tip, between two points; see `_ends`."""
    start, end = _ends(start, end, z)
    length = float(np.linalg.norm(np.subtract(end, start, dtype=np.float64)))
    return Manifold.cylinder(length, radius, top_radius, segments).transform(_upright(start, np.subtract(end, start)))


def tube(
    radius: float, inner_radius: float, start: Level, end: Level, z: Span | None = None, *, segments: int = SEGMENTS
) -> Manifold:
    """Return the cylinder with a bore between two points; see `_ends`."""
    start, end = _ends(start, end, z)
    beyond = 0.5 * np.subtract(end, start)
    inner = cylinder(inner_radius, np.subtract(start, beyond), np.add(end, beyond), segments=segments)
    return cylinder(radius, start, end, segments=segments) - inner


def torus(radius: float, wire_radius: float, middle: Point, normal: Point, *, segments: int = SEGMENTS) -> Manifold:
    """Return a ring of round wire."""
    return ring(radius, wire_radius, segments=segments).transform(_upright(middle, normal))


def _ends(start: Level, end: Level, z: Span | None) -> tuple[Point, Point]:
    """Two points: as given, at two heights above the origin, or as x, y and z of which one is a pair of bounds."""
    if z is not None:
        one, other = np.transpose(np.broadcast_arrays(start, end, z))
        return one, other
    first, second = ((0.0, 0.0, level) if isinstance(level, float | int) else level for level in (start, end))
    return first, second


def _upright(origin: Point, towards: Point) -> FloatArray:
    """Transform, shape (3, 4), that takes what stands on z = 0 to `origin`, where it looks in a direction."""
    direction = point(towards) / np.linalg.norm(towards)
    side = across(direction)
    return np.column_stack([side, np.cross(direction, side), direction, point(origin)])


def bore(radius: float, clearance: float, start: Point, end: Point, *, segments: int = SEGMENTS) -> Manifold:
    """Return what to take away so that a shaft of `radius` turns freely with `clearance` at the tightest place."""
    return cylinder((radius + clearance) / np.cos(np.pi / segments), start, end, segments=segments)


def section(outline: Sequence[tuple[float, float]]) -> CrossSection:
    """Return a polygon, whichever way round its corners are given."""
    found = CrossSection([np.array(outline)])
    return found if found.area() > 0.0 else CrossSection([np.array(outline[::-1])])


def lathe(outline: Sequence[tuple[float, float]], foot: Point = (0, 0, 0), *, segments: int = SEGMENTS) -> Manifold:
    """Return what a polygon of radius and height sweeps about the upright line through `foot`."""
    return Manifold.revolve(section(outline), segments).translate(foot)


def prism(outline: Sequence[tuple[float, float]], middle: Point, length: float, axis: str) -> Manifold:
    """Return a polygon drawn out along ``x``, ``y`` or ``z``; its corners are (y, z), (x, z) or (x, y) [m]."""
    x, y, z = {"x": (Y, Z, X), "y": (X, Z, -Y), "z": (X, Y, Z)}[axis]
    return section(outline).extrude(length).transform(np.column_stack([x, y, z, np.asarray(middle) - 0.5 * length * z]))


def ring(radius: float, thick: float, degrees: float = 360.0, *, sides: int = 16, segments: int = SEGMENTS) -> Manifold:
    """Return a wire of radius `thick` bent to an arc about the z axis, from the x axis on anticlockwise."""
    return Manifold.revolve(CrossSection.circle(thick, sides).translate((radius, 0)), segments, degrees)


def rounded_block(size: Point, radius: float) -> Manifold:
    """Return the box of a size about the origin with all edges and corners rounded."""
    corners = 0.5 * (np.asarray(size) - 2.0 * radius) * [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    return hull(*(ball(radius, corner, segments=16) for corner in corners))


def strip(places: Sequence[Sequence[float]], low: float, high: float) -> list[Manifold]:
    """Return a flat bar between two heights along `places`: x, y and half its width there [m], with round ends."""
    discs = [cylinder(half, (x, y, low), (x, y, high)) for x, y, half in places]
    return [hull(one, other) for one, other in pairwise(discs)]


def rod(radius: float, start: Level, end: Level, z: Span | None = None, *, segments: int = 32) -> Manifold:
    """Return a cylinder with round ends; see `_ends`."""
    start, end = _ends(start, end, z)
    ends = ball(radius, start, segments=segments) + ball(radius, end, segments=segments)
    return cylinder(radius, start, end, segments=segments) + ends


def ball(radius: float, centre: Point, *, segments: int = 32) -> Manifold:
    """Return a sphere."""
    return Manifold.sphere(radius, segments).translate(centre)


def union(*solids: Manifold) -> Manifold:
    """Return the union of all solids."""
    return Manifold.batch_boolean(list(solids), OpType.Add)


def hull(*solids: Manifold) -> Manifold:
    """Return the convex hull of all solids."""
    return Manifold.batch_hull(list(solids))


def tray(lower: Point, upper: Point, wall: float) -> Manifold:
    """Return a box that is open at the top."""
    inner_upper = (upper[0] - wall, upper[1] - wall, upper[2] + wall)
    return box(lower, upper) - box(np.add(lower, wall), inner_upper)
