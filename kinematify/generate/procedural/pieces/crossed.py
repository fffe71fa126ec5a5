"""Two flat levers that cross on a rivet, as in scissors and pliers: one lies on the other, z is up."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from kinematify.generate.procedural.solids import bore, cylinder, hull, union

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

Span = tuple[float, float]
"""Lower and upper z [m]."""


def strip(places: Sequence[tuple[float, float, float]], span: Span) -> Manifold:
    """Return a flat bar along `places`: x, y and half its width there [m], with round ends."""
    discs = [cylinder(half, (x, y, span[0]), (x, y, span[1]), segments=32) for x, y, half in places]
    return union(*(hull(one, other) for one, other in pairwise(discs)))


def disc(radius: float, span: Span) -> Manifold:
    """Return the round plate about the rivet."""
    return cylinder(radius, (0, 0, span[0]), (0, 0, span[1]))


def riveted(
    lower: Manifold, upper: Manifold, spans: tuple[Span, Span], radius: float, clearance: float
) -> tuple[Manifold, Manifold]:
    """Return the lower lever with a rivet at the origin and the upper one with the hole that turns on it.

    Args:
        lower: Owns the rivet, whose head keeps the upper one.
        upper: Lies on it.
        spans: Of both where they cross; the upper one has to be free above the origin.
        radius: Of the rivet; its head is 1.8 times as wide [m].
        clearance: Between all of them [m].
    """
    bottom, top = spans[0][0], spans[1][1]
    shaft = cylinder(radius, (0, 0, bottom + 1e-4), (0, 0, top + clearance + 1e-4))
    head = cylinder(1.8 * radius, (0, 0, top + clearance), (0, 0, top + clearance + 0.5 * radius))
    return union(lower, shaft, head), upper - bore(radius, clearance, (0, 0, bottom - 1.0), (0, 0, top + 1.0))
