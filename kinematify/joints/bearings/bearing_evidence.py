"""Evidence of either part of a contact near the other one: surface samples, feature edges and circles, with weights.

Bearings and rails (`scores.py`) are fitted to the same evidence.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import BearingConfig
    from kinematify.contact.graph import ContactEdge, ContactSamples
    from kinematify.geometry.surface import PartSurface
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class BearingSide:
    """Evidence of one part near a contact, world frame. Weights fade with the distance to the other part."""

    points: FloatArray
    """Surface samples [m], shape (S, 3)."""
    normals: FloatArray
    """Unit smooth normals there, shape (S, 3)."""
    weights: FloatArray
    """Area of each sample times its fading [m^2], shape (S,)."""
    middles: FloatArray
    """Middles of pieces of feature edges [m], shape (E, 3)."""
    tangents: FloatArray
    """Their unit directions, shape (E, 3)."""
    lengths: FloatArray
    """Their lengths [m], shape (E,)."""
    edge_weights: FloatArray
    """Their fading in [0, 1], shape (E,)."""
    circle_axes: FloatArray
    """Unit normals of circles through three vertices of a chain of feature edges, shape (C, 3)."""
    circle_centres: FloatArray
    """Their centres [m], shape (C, 3)."""
    circle_weights: FloatArray
    """Length of the chain times its fading [m], shape (C,)."""


Sides = tuple[BearingSide, BearingSide]
Generators = tuple[np.random.Generator, np.random.Generator]
"""One for what is drawn of each side."""


def contact_sides(surfaces: Sequence[PartSurface], edge: ContactEdge, *, config: BearingConfig) -> Sides:
    """Gather the evidence of both parts of a contact edge.

    Args:
        surfaces: Derived geometry of each part of the assembly.
        edge: A contact with samples.
        config: How far evidence reaches, lengths in metres.

    Returns:
        Sides of part `edge.a` and of part `edge.b`.
    """
    a, b = surfaces[edge.a], surfaces[edge.b]
    # It follows the smaller part, never beyond the contact band.
    fade = _Fade(gap=edge.gap, scale=min(config.fade, config.fade_part * min(a.part.diagonal, b.part.diagonal)))
    return _side(a, edge.samples_a, b, fade, config), _side(b, edge.samples_b, a, fade, config)


def whole_side(surface: PartSurface, count: int) -> BearingSide:
    """Evidence of a whole part: `count` samples of its surface, no edges."""
    samples = surface.sample(count)
    nothing, none = np.empty((0, 3)), np.empty(0)
    return BearingSide(
        points=samples.points,
        normals=samples.normals,
        weights=samples.areas,
        middles=nothing,
        tangents=nothing,
        lengths=none,
        edge_weights=none,
        circle_axes=nothing,
        circle_centres=nothing,
        circle_weights=none,
    )


def thin(side: BearingSide, count: int) -> BearingSide:
    """Keep about `count` surface samples, evenly spread over the list, and all edges."""
    if len(side.weights) <= count:
        return side
    index = np.linspace(0, len(side.weights) - 1, count).astype(np.int64)
    return replace(side, points=side.points[index], normals=side.normals[index], weights=side.weights[index])


def contact_centroid(sides: Sides) -> FloatArray:
    """Weighted centroid of a contact in which both parts count the same, world frame [m], shape (3,)."""
    points = np.concatenate([side.points for side in sides])
    weights = np.concatenate([side.weights / max(side.weights.sum(), 1e-300) for side in sides])
    if weights.sum() <= 0:
        return points.mean(axis=0) if len(points) else np.zeros(3)
    return np.average(points, axis=0, weights=weights)


@dataclass(frozen=True, kw_only=True)
class _Fade:
    """Weight of evidence by its distance beyond the gap."""

    gap: float
    scale: float

    @property
    def reach(self) -> float:
        """Distance beyond which a weight is below exp(-4.5), about 1 % [m]."""
        return self.gap + 3 * self.scale

    def weight(self, distances: FloatArray) -> FloatArray:
        return np.exp(-0.5 * (np.maximum(distances - self.gap, 0.0) / self.scale) ** 2)


def _side(
    surface: PartSurface, samples: ContactSamples, other: PartSurface, fade: _Fade, config: BearingConfig
) -> BearingSide:
    weights = samples.areas * fade.weight(samples.distances)
    keep = weights > config.negligible * weights.max(initial=0.0)
    edges, circles = surface.feature_pieces, surface.feature_circles
    edge_distance = _distance_near(edges.middles, other, fade.reach)
    circle_distance = _distance_near(circles.on_circle, other, fade.reach)
    near, round_near = np.isfinite(edge_distance), np.isfinite(circle_distance)
    return BearingSide(
        points=samples.points[keep],
        normals=samples.normals[keep],
        weights=weights[keep],
        middles=edges.middles[near],
        tangents=edges.tangents[near],
        lengths=edges.lengths[near],
        edge_weights=fade.weight(edge_distance[near]),
        circle_axes=circles.axes[round_near],
        circle_centres=circles.centres[round_near],
        circle_weights=fade.weight(circle_distance[round_near]) * circles.lengths[round_near],
    )


def _distance_near(points: FloatArray, other: PartSurface, reach: float) -> FloatArray:
    """Exact distance to the other part [m], infinite beyond `reach`."""
    result = np.full(len(points), np.inf)
    lower, upper = other.part.bounds
    boxed = np.flatnonzero(np.all((points >= lower - reach) & (points <= upper + reach), axis=1))
    if len(boxed):
        distance = other.distance(points[boxed])
        result[boxed] = np.where(distance <= reach, distance, np.inf)
    return result
