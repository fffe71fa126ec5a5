"""Virtual motion test: how far a part can turn or slide before it runs into another one.

A point that moves from outside to inside crosses a surface on its way, whether or not that surface is closed. The
test therefore casts the path of many surface points, piece by piece, as segments at every obstacle: no inside, no
signed distance and no step of penetration is needed, and parts that overlap in the given pose are no obstacle to
each other until they move through another wall.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.vectors import all_three, crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import JointsConfig, SweepConfig
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.joints.features.workspace import PartCache
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Sweep:
    """First hits of the moving points of several candidates in both directions."""

    hits: FloatArray
    """Motion (rad or m) at which each point first hits, inf if never, shape (candidates, 2, points)."""
    counted: FloatArray
    """Weight of each point for each candidate, 0 in the hinge zone, shape (candidates, points)."""
    limit: float
    """Motion up to which the points were followed [rad or m]."""

    def free(self, share: float) -> FloatArray:
        """Motion until more than `share` of the counted points have hit, shape (candidates, 2), at most `limit`."""
        order = np.argsort(self.hits, axis=2)
        weights = np.take_along_axis(np.broadcast_to(self.counted[:, None], self.hits.shape), order, axis=2)
        accumulated = np.cumsum(weights, axis=2) / np.maximum(weights.sum(axis=2, keepdims=True), 1e-12)
        first = np.argmax(accumulated > share, axis=2)[..., None]
        reached = np.take_along_axis(np.take_along_axis(self.hits, order, axis=2), first, axis=2)[..., 0]
        return np.minimum(reached, self.limit)

    def crossed(self, motion: float) -> FloatArray:
        """Share of the counted points that have hit something within `motion` [rad or m], shape (candidates, 2)."""
        hit = (self.hits <= motion) * self.counted[:, None]
        return np.asarray(hit.sum(axis=2) / np.maximum(self.counted.sum(axis=1), 1e-12)[:, None])

    def joined(self, other: Sweep) -> Sweep:
        """The same motion with the obstacles of both sweeps."""
        return Sweep(hits=np.minimum(self.hits, other.hits), counted=self.counted, limit=self.limit)


def moving_points(scene: JointScene) -> FloatArray:
    """Points that represent a child in a sweep [m], (n, 3): its samples, drawn towards their mean by `sweep.shrink`."""
    points, config = scene.samples.points, scene.config.sweep
    centre = points.mean(axis=0)
    return np.asarray(centre + (1.0 - config.shrink) * (points[:: max(1, len(points) // config.points)] - centre))


@dataclass(frozen=True, kw_only=True, eq=False)
class Paths:
    """The ways of points in both directions of several candidates, in straight pieces."""

    cache: PartCache
    ends: tuple[FloatArray, FloatArray]
    """Ends of the pieces of every counted point, along + and - [m], shape (k + 1, m, 3) each.

    NumPy is five times as fast along a first axis."""
    motions: FloatArray
    """Motion at these ends [rad or m], shape (k + 1, m)."""
    counted: FloatArray
    """As in `Sweep`; m of them are not 0."""
    limit: float
    """As in `Sweep`."""

    def reached(self, obstacles: Sequence[int]) -> tuple[int, ...]:
        """The first of some parts, and those of the others that lie in the box around the ways."""
        ends = np.concatenate(self.ends).reshape(-1, 3)
        low, high = ends.min(axis=0, initial=np.inf), ends.max(axis=0, initial=-np.inf)
        return obstacles[0], *self.cache.near(obstacles[1:], low, high)

    def against(self, obstacles: Sequence[int]) -> Sweep:
        """First hits of some parts."""
        hits = np.full((len(self.counted), 2, self.counted.shape[1]), np.inf)
        for side, ends in enumerate(self.ends):
            if ends.size:
                way = self.motions[:-1] + _fractions(self.cache, ends, obstacles) * np.diff(self.motions, axis=0)
                hits[:, side][self.counted > 0] = way.min(axis=0)
        return Sweep(hits=hits, counted=self.counted, limit=self.limit)


def turn_paths(
    cache: PartCache, points: FloatArray, axes: FloatArray, pivots: FloatArray, *, limit: float, config: SweepConfig
) -> Paths:
    """Ways of points that turn about several lines.

    Args:
        cache: Ray-casting scenes.
        points: Points of the moving part, world frame [m], shape (n, 3).
        axes: Unit directions, shape (c, 3).
        pivots: Points on the lines [m], shape (c, 3).
        limit: Largest angle [rad].
        config: Step, shrinkage, hinge zone and grace distance.
    """
    offset = points[None] - pivots[:, None]
    along = np.einsum("cnk,ck->cn", offset, axes)
    feet = pivots[:, None] + along[..., None] * axes[:, None]
    radial = points[None] - feet
    radius = lengths_of(radial)
    tangent = crossed(axes[:, None], radial)
    use = radius > config.hinge_zone * radius.max(axis=1, keepdims=True)
    # Parts that overlap a little where they touch leave the overlap during the grace distance.
    start = np.minimum(config.grace * cache.diagonal / np.maximum(radius[use], 1e-12), 0.5 * limit)
    n_steps = max(1, int(np.ceil(limit / np.radians(config.step_deg))))
    motions = start + (limit - start) * (np.arange(n_steps + 1) / n_steps)[:, None]
    straight = feet[use] + np.cos(motions)[..., None] * radial[use]
    aside = np.sin(motions)[..., None] * tangent[use]
    ends = straight + aside, straight - aside
    return Paths(cache=cache, ends=ends, motions=motions, counted=use.astype(np.float64), limit=limit)


def slide_paths(cache: PartCache, points: FloatArray, axes: FloatArray, *, limit: float, config: SweepConfig) -> Paths:
    """Ways of points that slide along several directions up to `limit` [m]; arguments as in `turn_paths`."""
    start = min(config.grace * cache.diagonal, 0.5 * limit)
    counted = np.ones((len(axes), len(points)))
    motions = np.broadcast_to(np.array([[start], [limit]]), (2, counted.size))
    resting, way = np.tile(points, (len(axes), 1)), motions[..., None] * np.repeat(axes, len(points), axis=0)
    return Paths(cache=cache, ends=(resting + way, resting - way), motions=motions, counted=counted, limit=limit)


def _fractions(cache: PartCache, ends: FloatArray, obstacles: Sequence[int]) -> FloatArray:
    """Fraction of each piece of paths (k + 1, m, 3) up to its first hit; inf where it meets nothing, (k, m)."""
    low, high = ends.min(axis=0), ends.max(axis=0)
    lowest, highest = low.min(axis=0), high.max(axis=0)
    fraction = np.full((len(ends) - 1, ends.shape[1]), np.inf)
    for part in obstacles:
        lower, upper = cache.assembly.parts[part].bounds
        if (lower > highest).any() or (upper < lowest).any():
            continue  # of many parts only a few are ever near
        rows = np.flatnonzero(all_three((low <= upper) & (high >= lower)))
        if len(rows):
            near = ends[:, rows]
            found = cache.first_hits(part, near[:-1].reshape(-1, 3), np.diff(near, axis=0).reshape(-1, 3))
            fraction[:, rows] = np.minimum(fraction[:, rows], found.reshape(-1, len(rows)))
    return fraction


def contact_clearance(
    scene: JointScene, axes: FloatArray, pivots: FloatArray, direction: FloatArray
) -> tuple[float, float] | None:
    """Measure how far a contact turns about the freest of several lines and slides, against the parent alone.

    Sweeps of a whole part skip the first steps, because meshes overlap where parts touch. Keys, splines, skirts,
    grooves and beads decide within them, so that the samples near the other part are swept without that grace.

    Args:
        scene: The pair.
        axes: Unit directions of the lines, shape (c, 3).
        pivots: Points on them [m], shape (c, 3).
        direction: Unit direction of the slide, shape (3,).

    Returns:
        Length of the arc at the contact's mean radius and that of the slide, the longer of both directions [m], inf
        where it is not stopped; None where the contact has too few samples.
    """
    points = _followed(scene)
    if points is None:
        return None
    limit = np.radians(scene.config.clearance.turn_deg)
    turned = turn_paths(scene.cache, points, axes, pivots, limit=limit, config=_strict(scene.config))
    free = turned.against((scene.parent,)).free(_share(scene)).max(axis=1)
    radii = lengths_of(crossed(points[None] - pivots[:, None], axes[:, None])).mean(axis=1)
    arcs = np.where(free >= limit, np.inf, free * radii)
    return float(arcs.max()), float(_slid(scene, points, direction).max())


def slide_clearance(scene: JointScene, direction: FloatArray) -> FloatArray | None:
    """Measure how far the contact slides along +/- a direction [m], shape (2,), inf if never stopped; None as above."""
    points = _followed(scene)
    return None if points is None else _slid(scene, points, direction)


def _slid(scene: JointScene, points: FloatArray, direction: FloatArray) -> FloatArray:
    reach = scene.config.clearance.slide * scene.frame.diagonal
    slid = slide_paths(scene.cache, points, direction[None], limit=reach, config=_strict(scene.config))
    free = slid.against((scene.parent,)).free(_share(scene))[0]
    return np.where(free >= reach, np.inf, free)


def _followed(scene: JointScene) -> FloatArray | None:
    """Samples of the contact, drawn into the child [m], shape (n, 3); None where there are too few."""
    contact = scene.contact
    if len(contact.points) < scene.config.clearance.least_samples:
        return None
    stride = max(1, len(contact.points) // scene.config.clearance.samples)
    return (contact.points - scene.config.clearance.inset * scene.frame.diagonal * contact.normals)[::stride]


def _strict(config: JointsConfig) -> SweepConfig:
    return config.sweep.model_copy(update={"grace": 0.0, "hinge_zone": 0.0})


def _share(scene: JointScene) -> float:
    """A journal is modelled with its clearance, so that fewer samples are beyond doubt."""
    return scene.config.clearance.share if scene.journal is None else scene.config.clearance.journal_share
