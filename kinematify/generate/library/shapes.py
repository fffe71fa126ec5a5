"""Primitives of a blueprint by where they stand: boxes by corners, rods by ends, plates by outline."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from kinematify.robot.transforms import rotation_from_x, rpy_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.robot.arrays import FloatArray

Shape: TypeAlias = dict[str, Any]
"""As a blueprint writes it."""
Point: TypeAlias = "Sequence[float] | FloatArray"
"""x, y, z [m]."""

X, Y, Z = np.eye(3)


def box(lower: Point, upper: Point) -> Shape:
    """A box between two corners, in any order."""
    low, high = np.minimum(lower, upper), np.maximum(lower, upper)
    return {"kind": "box", "size": (high - low).tolist(), "xyz": (0.5 * (low + high)).tolist()}


def block(middle: Point, size: Point) -> Shape:
    """A box about a point."""
    half = 0.5 * np.asarray(size)
    return box(np.subtract(middle, half), np.add(middle, half))


def cylinder(radius: float, start: Point, end: Point) -> Shape:
    """A cylinder between two points."""
    return {"kind": "cylinder", "radius": radius, **_along(start, end)}


def rod(radius: float, start: Point, end: Point) -> Shape:
    """A rod with round ends."""
    return {"kind": "capsule", "radius": radius, **_along(start, end)}


def cone(radius: float, top_radius: float, start: Point, end: Point) -> Shape:
    """A cone or frustum between two points."""
    return {"kind": "cone", "radius": radius, "top_radius": top_radius, **_along(start, end)}


def tube(radius: float, inner_radius: float, start: Point, end: Point) -> Shape:
    """A tube between two points."""
    return {"kind": "tube", "radius": radius, "inner_radius": inner_radius, **_along(start, end)}


def torus(radius: float, wire_radius: float, middle: Point, normal: Point) -> Shape:
    """A ring of round wire."""
    placed = _along(middle, np.add(middle, normal))
    del placed["length"]
    return {"kind": "torus", "radius": radius, "wire_radius": wire_radius, **placed, "xyz": list(map(float, middle))}


def sphere(radius: float, middle: Point) -> Shape:
    """A ball."""
    return {"kind": "sphere", "radius": radius, "xyz": list(map(float, middle))}


def beam(wide: float, high: float, start: Point, end: Point, side: Point = Z) -> Shape:
    """A box between two points; `high` is measured along `side` as far as that is across the beam."""
    along = np.subtract(end, start, dtype=np.float64)
    length = float(np.linalg.norm(along))
    along /= length
    up = np.asarray(side, dtype=np.float64) - along * float(along @ np.asarray(side))
    if np.linalg.norm(up) < 1e-6:
        up = np.eye(3)[np.argmin(np.abs(along))]
        up = up - along * float(along @ up)
    up /= np.linalg.norm(up)
    frame = np.column_stack([along, np.cross(up, along), up])
    middle = 0.5 * np.add(start, end)
    return {"kind": "box", "size": [length, wide, high], "xyz": middle.tolist(), "rpy": rpy_of(frame).tolist()}


def prism(outline: Sequence[tuple[float, float]], middle: Point, length: float, axis: str) -> Shape:
    """A polygon drawn out along ``x``, ``y`` or ``z``; its corners are (y, z), (x, z) or (x, y) [m]."""
    # Turned to its axis, the polygon's own x and y point elsewhere.
    corners = {"x": [(-b, a) for a, b in outline], "y": [(a, -b) for a, b in outline], "z": list(outline)}[axis]
    placed = {"xyz": list(map(float, middle)), "axis": axis}
    return {"kind": "prism", "outline": corners, "length": length, **placed}


def lathe(outline: Sequence[tuple[float, float]], foot: Point) -> Shape:
    """A polygon of radius and height turned about the upright line through `foot`."""
    return {"kind": "lathe", "outline": list(outline), "xyz": list(map(float, foot))}


def hull(*shapes: Shape) -> Shape:
    """The smallest convex solid around shapes."""
    return {"kind": "hull", "shapes": list(shapes)}


def strip(places: Sequence[Sequence[float]], low: float, high: float) -> list[Shape]:
    """A flat bar between two heights along `places`: x, y and half its width there [m], with round ends."""
    discs = [cylinder(half, (x, y, low), (x, y, high)) for x, y, half in places]
    return [hull(one, other) for one, other in pairwise(discs)]


def stick(square: bool, along: Point, foot: Point, radius: float, start: float, end: float) -> Shape:
    """A beam or a cylinder on a line, between two distances from its foot [m]."""
    a, b = (np.add(foot, distance * np.asarray(along)) for distance in (start, end))
    return beam(2.0 * radius, 2.0 * radius, a, b) if square else cylinder(radius, a, b)


def scaled(size: float) -> Callable[[float, float, float], FloatArray]:
    """Return a function that makes a point from coordinates in units of a size."""

    def point(x: float, y: float, z: float) -> FloatArray:
        return size * np.array([x, y, z], dtype=np.float64)

    return point


def _along(start: Point, end: Point) -> Shape:
    along = np.subtract(end, start, dtype=np.float64)
    length = float(np.linalg.norm(along))
    return {
        "length": length,
        "axis": "x",
        "xyz": (0.5 * np.add(start, end)).tolist(),
        "rpy": rpy_of(rotation_from_x(along / length)).tolist(),
    }
