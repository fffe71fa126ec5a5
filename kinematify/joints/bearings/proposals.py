"""Where the line of a bearing may be: from pairs of normals and from circles through feature edges."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.bearings.evidence import thin
from kinematify.joints.bearings.line import NO_LINES, Lines, join
from kinematify.joints.bearings.scores import surface_support
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from kinematify.config import BearingConfig
    from kinematify.joints.bearings.evidence import BearingSide, Sides
    from kinematify.robot.arrays import BoolArray, FloatArray

_LEAST_SINE = 0.17  # below 10 deg between two normals their intersection is ill-conditioned
_ALONG = np.cos(np.radians(1.0))
_COARSE = 2.0  # proposals this much farther apart than what is kept: the refinement moves them


def propose_lines(
    sides: Sides,
    centroid: FloatArray,
    directions: FloatArray,
    *,
    diagonal: float,
    config: BearingConfig,
    rng: np.random.Generator,
) -> Lines:
    """Promising distinct lines: the best by area among all, and the best by circles among those through circles.

    Both lists are needed: a bearing that shows as two circles on boxy housings has little round area.

    Args:
        sides: Evidence of both parts.
        centroid: Of the contact, world frame [m], shape (3,).
        directions: Along which lines are proposed besides, shape (k, 3).
        diagonal: Of the assembly [m].
        config: Numbers of proposals and of what is kept.
        rng: Draws the pairs and circles.

    Returns:
        Lines through their feet of the contact centroid; none where nothing is curved.
    """
    by_pairs = [normal_pair_lines(side, config.pairs, rng) for side in sides]
    by_pairs += [directed_lines(side, directions, config.directed_pairs, rng) for side in sides]
    by_circles = [_circle_lines(side, config.circles, rng) for side in sides]
    lines = join([*by_circles, *by_pairs]).through_feet(centroid)
    if len(lines) == 0:
        return lines
    coarse = [surface_support(thin(side, config.coarse_samples), lines, config) for side in sides]
    area = np.sqrt(coarse[0] * coarse[1])
    votes = np.zeros(len(lines))
    n_circles = [len(found) for found in by_circles]
    votes[: sum(n_circles)] = _circle_votes(
        lines.subset(slice(sum(n_circles))), n_circles[0], diagonal=diagonal, config=config
    )
    chosen: list[int] = []
    lists = [(area, config.shortlist), (votes, config.shortlist_circles)]
    lists += [(area * along, config.shortlist_directed) for along in _running_along(lines, directions)]
    for merit, count in lists:
        order = np.argsort(-merit, kind="stable")
        order = order[merit[order] > 0]
        picked = lines.subset(order).distinct(
            count, angle=_COARSE * config.apart_angle, distance=_COARSE * config.apart * diagonal
        )
        chosen += order[picked].tolist()
    return lines.subset(list(dict.fromkeys(chosen)))


def _running_along(lines: Lines, directions: FloatArray) -> BoolArray:
    """Which lines run along each direction (k, 3), shape (k, L)."""
    return np.asarray(np.abs(directions @ lines.axes.T) > _ALONG)


def normal_pair_lines(side: BearingSide, count: int, rng: np.random.Generator) -> Lines:
    """Axes of the cylinders through `count` random pairs of samples.

    Each runs along n1 x n2, through the point where the normals meet. Nearly parallel pairs are left out.
    """
    if len(side.weights) < 2:
        return NO_LINES
    chance = side.weights / side.weights.sum()
    first, second = rng.choice(len(chance), (2, count), p=chance)
    n1, n2 = side.normals[first], side.normals[second]
    cross = crossed(n1, n2)
    sine = lengths_of(cross)
    good = sine > _LEAST_SINE
    axes = cross[good] / sine[good, None]
    offset = side.points[second][good] - side.points[first][good]
    # Solve x1 + s n1 = x2 + t n2 in the plane across the axis.
    along = np.einsum("ij,ij->i", crossed(offset, n2[good]), axes) / sine[good]
    return Lines(axes=axes, points=side.points[first][good] + along[:, None] * n1[good])


def directed_lines(side: BearingSide, directions: FloatArray, count: int, rng: np.random.Generator) -> Lines:
    """Lines along given directions, each through the place where the normals of a random pair of samples meet.

    Rough normals are several degrees off, and so is the direction that two of them give; seen along a given direction,
    they still meet near the axis.

    Args:
        side: Evidence of one part.
        directions: Unit directions, shape (k, 3).
        count: Pairs per direction.
        rng: Draws the pairs.
    """
    if len(side.weights) < 2 or count == 0 or len(directions) == 0:
        return NO_LINES
    chance = side.weights / side.weights.sum()
    axes = np.repeat(directions, count, axis=0)
    first, second = rng.choice(len(chance), (2, len(axes)), p=chance)
    n1, n2 = (side.normals[k] - np.einsum("ij,ij->i", side.normals[k], axes)[:, None] * axes for k in (first, second))
    offset = side.points[second] - side.points[first]
    sine = np.einsum("ij,ij->i", crossed(n1, n2), axes)
    good = np.abs(sine) > _LEAST_SINE
    along = np.einsum("ij,ij->i", crossed(offset[good], n2[good]), axes[good]) / sine[good]
    return Lines(axes=axes[good], points=side.points[first][good] + along[:, None] * n1[good])


def _circle_lines(side: BearingSide, count: int, rng: np.random.Generator) -> Lines:
    """Axes of at most `count` circles, drawn by weight."""
    weights = side.circle_weights
    if len(weights) == 0 or weights.sum() <= 0:
        return NO_LINES
    found = Lines(axes=side.circle_axes, points=side.circle_centres)
    return found.subset(rng.choice(len(weights), count, p=weights / weights.sum())) if len(weights) > count else found


def _circle_votes(lines: Lines, n_first: int, *, diagonal: float, config: BearingConfig) -> FloatArray:
    """How many circles of either side share each circle's line (geometric mean), shape (C,).

    Args:
        lines: Axes of all circles; the first `n_first` belong to the first side.
        n_first: Number of circles of the first side.
        diagonal: Of the assembly [m].
        config: Tolerances.
    """
    axes, points = lines.axes, lines.points
    aligned = np.abs(axes @ axes.T) > np.cos(np.arcsin(config.circle_tolerance_sine))
    x, y, z = (column[None] - column[:, None] for column in points.T)
    along = x * axes[:, :1] + y * axes[:, 1:2] + z * axes[:, 2:]
    apart = np.sqrt(np.maximum(x * x + y * y + z * z - along**2, 0))
    same = aligned & (apart < config.circle_cell * diagonal)
    return np.asarray(np.sqrt(same[:, :n_first].sum(axis=1) * same[:, n_first:].sum(axis=1)))
