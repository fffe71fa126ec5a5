"""Solids that objects are built from: boxes, cylinders and what booleans make of them.

Lengths are metres in the world frame. A circle is a polygon, so a bore is widened until even its flats keep the stated
clearance: a shaft turns in it without touching at any angle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from manifold3d import CrossSection, Manifold, OpType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray

SEGMENTS = 48
"""Sides of the polygon that represents a circle."""

Point: TypeAlias = "Sequence[float] | FloatArray"
"""x, y, z [m]."""


def off(point: Point, x: float, y: float, z: float) -> FloatArray:
    """Return the point moved by (x, y, z)."""
    return np.add(point, (x, y, z))


def box(lower: Point, upper: Point) -> Manifold:
    """Return the box between two corners."""
    return Manifold.cube(np.subtract(upper, lower)).translate(lower)


def rounded_box(lower: Point, upper: Point, radius: float) -> Manifold:
    """Return the box between two corners with its upright edges rounded."""
    (x0, y0, z0), (x1, y1, z1) = lower, upper
    corners = [(x, y) for x in (x0 + radius, x1 - radius) for y in (y0 + radius, y1 - radius)]
    return hull(*(cylinder(radius, (x, y, z0), (x, y, z1), segments=24) for x, y in corners))


def cylinder(radius: float, start: Point, end: Point, *, segments: int = SEGMENTS) -> Manifold:
    """Return the cylinder whose circular faces are centred at `start` and `end`."""
    direction = np.subtract(end, start, dtype=np.float64)
    length = float(np.linalg.norm(direction))
    direction /= length
    side = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    side /= np.linalg.norm(side)
    frame = np.column_stack([side, np.cross(direction, side), direction, np.asarray(start, dtype=np.float64)])
    return Manifold.cylinder(length, radius, radius, segments).transform(frame)


def frustum(length: float, radius: float, top_radius: float) -> Manifold:
    """Return the cone on the z axis from the origin upwards, cut off at `length`."""
    return Manifold.cylinder(length, radius, top_radius, SEGMENTS)


def bore(radius: float, clearance: float, start: Point, end: Point, *, segments: int = SEGMENTS) -> Manifold:
    """Return what to take away so that a shaft of `radius` turns freely with `clearance` at the tightest place."""
    return cylinder((radius + clearance) / np.cos(np.pi / segments), start, end, segments=segments)


def turned(outline: Sequence[tuple[float, float]], *, segments: int = SEGMENTS) -> Manifold:
    """Return what a closed outline of radius and height, anticlockwise, sweeps about the z axis."""
    return Manifold.revolve(CrossSection([np.array(outline)]), segments)


def ring(radius: float, thick: float, degrees: float = 360.0, *, sides: int = 16) -> Manifold:
    """Return a wire of radius `thick` bent to an arc about the z axis, from the x axis on anticlockwise."""
    return Manifold.revolve(CrossSection.circle(thick, sides).translate((radius, 0)), SEGMENTS, degrees)


def rod(radius: float, start: Point, end: Point, *, segments: int = 32) -> Manifold:
    """Return a cylinder with round ends."""
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
