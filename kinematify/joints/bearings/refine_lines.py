"""Refine bearing lines: robust Gauss-Newton on their four parameters, all lines of a contact at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.bearings.line import Line, Lines, lines_of
from kinematify.joints.bearings.scores import OCTAGON, across_axes
from kinematify.robot.vectors import lengths_of

if TYPE_CHECKING:
    from kinematify.config import BearingConfig
    from kinematify.joints.bearings.bearing_evidence import BearingSide, Sides
    from kinematify.robot.arrays import FloatArray

_LONGEST_STEP = 0.1  # in rad and in spreads: farther, the linear model means nothing


Rows = tuple["FloatArray", "FloatArray", "FloatArray"]
"""Linearised residuals of L lines; the parameters are two tilts of the axis [rad] and two shifts [spread].

Derivatives of the residuals with frozen radii, shape (L, 4, R), the residuals, which are sines of angles, and their
robust weights times evidence, shape (L, R) each.
"""


def refine_lines(
    sides: Sides, lines: Lines, tolerances: FloatArray, config: BearingConfig, *, turning: bool = True
) -> Lines:
    """Move lines to where most of the evidence turns into itself; the tolerance shrinks from coarse to fine.

    Each round linearises the angular residuals with frozen radii and weights them by exp(-(r / tolerance)^2). Both
    parts weigh the same whatever their areas.

    Args:
        sides: Evidence of both parts.
        lines: Where to start.
        tolerances: Sine of the tolerance of each round.
        config: `circle_weight`.
        turning: Whether the directions may change as well as the places.
    """
    if len(lines) == 0:
        return lines
    # Spread of the near samples [m]; it makes steps in position as large as steps in direction.
    spread = max(float(np.sqrt(sum(side.points.var(0).sum() for side in sides if len(side.points)))), 1e-12)
    free = slice(0 if turning else 2, 4)
    for tolerance in tolerances:
        frames = line_frames(lines.axes)
        normal, gradient = np.zeros((len(lines), 4, 4)), np.zeros((len(lines), 4))
        for side in sides:
            for design, rest, weight in (
                surface_rows(side, lines, frames, spread=spread, tolerance=tolerance),
                circle_rows(side, lines, frames, spread=spread, tolerance=tolerance, share=config.circle_weight),
            ):
                weighted = design * weight[:, None]
                normal += weighted @ design.transpose(0, 2, 1)
                gradient += (weighted @ rest[..., None])[..., 0]
        damping = 1e-9 * np.trace(normal, axis1=1, axis2=2) + 1e-15
        damped = normal + damping[:, None, None] * np.eye(4)
        steps = np.zeros((len(lines), 4))
        steps[:, free] = -np.linalg.solve(damped[:, free, free], gradient[:, free, None])[..., 0]
        steps *= np.minimum(1.0, _LONGEST_STEP / np.maximum(np.sqrt((steps**2).sum(axis=1)), 1e-12))[:, None]
        # Two tilts towards the vectors across each line, and two shifts.
        tilt, shift = (steps[:, k, None] * frames[:, 0] + steps[:, k + 1, None] * frames[:, 1] for k in (0, 2))
        axes = lines.axes + tilt
        lines = Lines(axes=axes / lengths_of(axes)[:, None], points=lines.points + spread * shift)
    return lines


def refine_line(sides: Sides, line: Line, tolerances: FloatArray, config: BearingConfig) -> Line:
    """`refine_lines` of a single line."""
    return refine_lines(sides, lines_of([line]), tolerances, config)[0]


def line_frames(axes: FloatArray) -> FloatArray:
    """Two unit vectors across each axis (L, 3) and the axis, right-handed, shape (L, 3, 3)."""
    return np.stack([*across_axes(axes), axes], axis=1)


def surface_rows(side: BearingSide, lines: Lines, frames: FloatArray, *, spread: float, tolerance: float) -> Rows:
    """Rows of n . (u x (x - p)) / radius = 0: the normal line meets the axis.

    Args:
        side: Evidence of one part.
        lines: Where to linearise: axes u through points p.
        frames: From `line_frames`.
        spread: Unit of the shifts [m].
        tolerance: Residual at which the weight has fallen to 1/e.
    """
    x1, x2, height = _seen_from(lines, frames, side.points)
    n1, n2, along = _turned_into(frames, side.normals)
    radius = np.sqrt(x1 * x1 + x2 * x2) + 1e-12
    rest = (x1 * n2 - x2 * n1) / radius
    # n . (e x (x - p)) for the tilts of the axis towards e, n . (e x u) for its shifts.
    tilt = (x2 * along - height * n2) / radius, (height * n1 - x1 * along) / radius
    shift = -n2 * (spread / radius), n1 * (spread / radius)
    total = max(float(side.weights.sum()), 1e-300)
    weight = np.exp(-((rest / tolerance) ** 2)) * (1 - along**2) * side.weights / total
    return np.stack([*tilt, *shift], axis=1), rest, weight


def circle_rows(
    side: BearingSide, lines: Lines, frames: FloatArray, *, spread: float, tolerance: float, share: float
) -> Rows:
    """Rows of t . u = 0 and t . (m - p) / radius = 0: a piece of edge runs around the axis.

    Args:
        side: Evidence of one part.
        lines: Where to linearise.
        frames: From `line_frames`.
        spread: Unit of the shifts [m].
        tolerance: Residual at which the weight has fallen to 1/e.
        share: Weight of a full circle against all area.
    """
    m1, m2, _ = _seen_from(lines, frames, side.middles)
    t1, t2, level = _turned_into(frames, side.tangents)
    radius = np.sqrt(m1 * m1 + m2 * m2) + 1e-12
    outward = (t1 * m1 + t2 * m2) / radius
    zeros = np.zeros((len(lines), 2, radius.shape[1]))
    tilt = np.concatenate([np.stack([t1, t2], axis=1), zeros], axis=1)
    shift = np.concatenate([zeros, np.stack([t1, t2], axis=1) * (-spread / radius)[:, None]], axis=1)
    fit = np.exp(-((level / tolerance) ** 2) - (outward / tolerance) ** 2) * (side.lengths < OCTAGON * radius)
    weight = share * fit * side.edge_weights * np.minimum(side.lengths / radius, 0.5) / (2 * np.pi)
    return (
        np.concatenate([tilt, shift], axis=2),
        np.concatenate([level, outward], axis=1),
        np.concatenate([weight, weight], axis=1),
    )


def _seen_from(lines: Lines, frames: FloatArray, points: FloatArray) -> FloatArray:
    """Coordinates of points (n, 3) in the frame at the point of each line, shape (3, L, n)."""
    near = points[0] if len(points) else np.zeros(3)  # what is far from the origin would lose digits
    place = np.einsum("lij,lj->il", frames, lines.points - near)
    return np.asarray(_turned_into(frames, points - near) - place[..., None])


def _turned_into(frames: FloatArray, vectors: FloatArray) -> FloatArray:
    """Coordinates of vectors (n, 3) along the axes of each frame, shape (3, L, n)."""
    flat = frames.transpose(1, 0, 2).reshape(-1, 3) @ vectors.T
    return flat.reshape(3, len(frames), len(vectors))
