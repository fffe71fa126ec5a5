"""Hinges behind the back edge of two bodies that lie on each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.generate.procedural.pieces.bearings import ALONG_X, at, barrel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.generate.procedural.workshop import Workshop


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
    workshop: Workshop,
    bodies: tuple[str, str],
    edge: BackEdge,
    places: Sequence[float],
    *,
    length: float,
    radius: float,
    knuckles: int = 3,
) -> tuple[float, float, float]:
    """Add barrel hinges to a lower and an upper body, which are there; returns a point on the pins.

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
        for name, half in zip(bodies, halves, strict=True):
            workshop.add(name, half.transform(place))
    return pivot
