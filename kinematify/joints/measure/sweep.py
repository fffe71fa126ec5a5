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

from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import SweepConfig
    from kinematify.joints.measure.workspace import PartCache
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


def moving_points(cache: PartCache, part: int, config: SweepConfig) -> FloatArray:
    """Points that stand for a part in a sweep: its samples, drawn towards their mean by `config.shrink`."""
    points = cache.samples(part).points
    stride = max(1, len(points) // config.points)
    chosen = points[::stride]
    centre = points.mean(axis=0)
    return np.asarray(centre + (1.0 - config.shrink) * (chosen - centre))


def sweep_turns(
    cache: PartCache,
    points: FloatArray,
    axes: FloatArray,
    pivots: FloatArray,
    obstacles: Sequence[int],
    *,
    limit: float,
    config: SweepConfig,
) -> Sweep:
    """Turn points about several lines, both ways.

    Args:
        cache: Ray-casting scenes.
        points: Points of the moving part, world frame [m], shape (n, 3).
        axes: Unit directions, shape (c, 3).
        pivots: Points on the lines [m], shape (c, 3).
        obstacles: Parts that may be hit.
        limit: Largest angle [rad].
        config: Step, shrinkage, hinge zone and grace distance.
    """
    offset = points[None] - pivots[:, None]
    along = np.einsum("cnk,ck->cn", offset, axes)
    feet = pivots[:, None] + along[..., None] * axes[:, None]
    radial = points[None] - feet
    radius = lengths_of(radial)
    tangent = crossed(axes[:, None], radial)
    reach = radius.max(axis=1, keepdims=True)
    counted = (radius > config.hinge_zone * reach).astype(np.float64)
    # Parts that overlap a little where they touch leave the overlap during the grace distance.
    start = np.minimum(config.grace * cache.diagonal / np.maximum(radius, 1e-12), 0.5 * limit)
    n_steps = max(1, int(np.ceil(limit / np.radians(config.step_deg))))
    grid = start[..., None] + (limit - start)[..., None] * (np.arange(n_steps + 1) / n_steps)
    hits = np.full((len(axes), 2, len(points)), np.inf)
    straight = feet[:, :, None] + np.cos(grid)[..., None] * radial[:, :, None]
    aside = np.sin(grid)[..., None] * tangent[:, :, None]
    for side, sign in enumerate((1.0, -1.0)):
        hits[:, side] = _first_hits(cache, straight + sign * aside, grid, counted, obstacles)
    return Sweep(hits=hits, counted=counted, limit=limit)


def sweep_slides(
    cache: PartCache,
    points: FloatArray,
    axes: FloatArray,
    obstacles: Sequence[int],
    *,
    limit: float,
    config: SweepConfig,
) -> Sweep:
    """Slide points along several directions, both ways, up to `limit` [m]; arguments as in `sweep_turns`."""
    start = min(config.grace * cache.diagonal, 0.5 * limit)
    shape = (len(axes), len(points))
    grid = np.broadcast_to(np.array([start, limit]), (*shape, 2))
    counted = np.ones(shape)
    hits = np.full((len(axes), 2, len(points)), np.inf)
    for side, sign in enumerate((1.0, -1.0)):
        path = points[None, :, None] + sign * grid[..., None] * axes[:, None, None]
        hits[:, side] = _first_hits(cache, path, grid, counted, obstacles)
    return Sweep(hits=hits, counted=counted, limit=limit)


def _first_hits(
    cache: PartCache, path: FloatArray, grid: FloatArray, counted: FloatArray, obstacles: Sequence[int]
) -> FloatArray:
    """Motion at the first hit of each path (c, n, k + 1, 3) at motions `grid` (c, n, k + 1); inf if none, (c, n)."""
    use = counted > 0
    used = path[use]
    pieces = np.full((*grid.shape[:2], grid.shape[2] - 1), np.inf)
    if len(used):
        pieces[use] = _fractions(cache, used, obstacles)
    motions = grid[:, :, :-1] + pieces * np.diff(grid, axis=2)
    return np.asarray(motions.min(axis=2))


def _fractions(cache: PartCache, paths: FloatArray, obstacles: Sequence[int]) -> FloatArray:
    """Fraction of each piece of paths (m, k + 1, 3) up to its first hit; inf where it meets nothing, (m, k)."""
    ends = np.ascontiguousarray(paths.transpose(1, 0, 2))  # along the first axis NumPy is five times as fast
    low, high = ends.min(axis=0), ends.max(axis=0)
    lowest, highest = low.min(axis=0), high.max(axis=0)
    steps = np.diff(paths, axis=1)
    fraction = np.full(steps.shape[:2], np.inf)
    for part in obstacles:
        lower, upper = cache.assembly.parts[part].bounds
        if (lower > highest).any() or (upper < lowest).any():
            continue  # of many parts only a few are ever near
        rows = np.flatnonzero(((low <= upper) & (high >= lower)).all(axis=1))
        if len(rows):
            found = cache.first_hits(part, paths[rows, :-1].reshape(-1, 3), steps[rows].reshape(-1, 3))
            fraction[rows] = np.minimum(fraction[rows], found.reshape(len(rows), -1))
    return fraction
