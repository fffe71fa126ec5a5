"""Refine a bearing line: robust Gauss-Newton on its four parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.hypotheses.bearing_scores import OCTAGON
from kinematify.joints.hypotheses.line import Line
from kinematify.robot.vectors import dots

if TYPE_CHECKING:
    from kinematify.config import BearingConfig
    from kinematify.joints.hypotheses.bearing_evidence import BearingSide, Sides
    from kinematify.robot.arrays import FloatArray

_LONGEST_STEP = 0.1  # in rad and in spreads: farther, the linear model means nothing


@dataclass(frozen=True, kw_only=True, eq=False)
class Rows:
    """Linearised residuals; the columns are two tilts of the axis [rad] and two shifts of the point [spread]."""

    design: FloatArray
    """Derivatives of the residuals with frozen radii, shape (R, 4)."""
    rest: FloatArray
    """Residuals: sines of angles, shape (R,)."""
    weight: FloatArray
    """Robust weight times evidence, shape (R,)."""


def refine_line(
    sides: Sides, line: Line, tolerances: FloatArray, config: BearingConfig, *, turning: bool = True
) -> Line:
    """Move a line to where most of the evidence turns into itself; the tolerance shrinks from coarse to fine.

    Each round linearises the angular residuals with frozen radii and weights them by exp(-(r / tolerance)^2). Both
    parts weigh the same whatever their areas.

    Args:
        sides: Evidence of both parts.
        line: Where to start.
        tolerances: Sine of the tolerance of each round.
        config: `circle_weight`.
        turning: Whether the direction may change as well as the place.
    """
    spread = sample_spread(sides)
    for tolerance in tolerances:
        basis = across_axis(line.axis)
        normal, gradient = np.zeros((4, 4)), np.zeros(4)
        for side in sides:
            for rows in (
                surface_rows(side, line, basis, spread=spread, tolerance=tolerance),
                circle_rows(side, line, basis, spread=spread, tolerance=tolerance, share=config.circle_weight),
            ):
                normal += rows.design.T @ (rows.design * rows.weight[:, None])
                gradient += rows.design.T @ (rows.weight * rows.rest)
        damping = (1e-9 * np.trace(normal) + 1e-15) * np.eye(4)
        free = slice(0 if turning else 2, 4)
        step = np.zeros(4)
        step[free] = -np.linalg.solve((normal + damping)[free, free], gradient[free])
        step *= min(1.0, _LONGEST_STEP / max(float(np.linalg.norm(step)), 1e-12))
        line = moved_line(line, basis, step, spread=spread)
    return line


def sample_spread(sides: Sides) -> float:
    """Spread of the near samples [m]; makes steps in position as large as steps in direction."""
    return max(float(np.sqrt(sum(side.points.var(0).sum() for side in sides if len(side.points)))), 1e-12)


def across_axis(axis: FloatArray) -> FloatArray:
    """Two unit vectors across one axis (3,), shape (2, 3)."""
    first = _cross_matrix(axis) @ np.eye(3)[int(np.argmin(np.abs(axis)))]
    first /= np.sqrt(first @ first)
    return np.stack([first, _cross_matrix(axis) @ first])


def moved_line(line: Line, basis: FloatArray, step: FloatArray, *, spread: float) -> Line:
    """Tilt a line towards the vectors of `basis` (2, 3) by step[:2] [rad] and shift it by step[2:] [spread]."""
    axis = line.axis + step[0] * basis[0] + step[1] * basis[1]
    axis /= np.linalg.norm(axis)
    return Line(axis=axis, point=line.point + spread * (step[2] * basis[0] + step[3] * basis[1]))


def surface_rows(side: BearingSide, line: Line, basis: FloatArray, *, spread: float, tolerance: float) -> Rows:
    """Rows of n . (u x (x - p)) / radius = 0: the normal line meets the axis.

    Args:
        side: Evidence of one part.
        line: Where to linearise: axis u through point p.
        basis: From `across_axis`, shape (2, 3).
        spread: Unit of the shifts [m].
        tolerance: Residual at which the weight has fallen to 1/e.
    """
    arm = side.points - line.point
    turned = arm @ _cross_matrix(line.axis).T
    radius = np.sqrt(dots(turned, turned)) + 1e-12
    rest = dots(side.normals, turned) / radius
    # n . (e x arm) for the tilts of the axis towards e, n . (e x u) for its shifts, both as products with e.
    tilt = [dots(side.normals, arm @ _cross_matrix(e).T) / radius for e in basis]
    shift = [side.normals @ (_cross_matrix(e) @ line.axis) / radius * spread for e in basis]
    across = 1 - (side.normals @ line.axis) ** 2
    total = max(float(side.weights.sum()), 1e-300)
    weight = np.exp(-((rest / tolerance) ** 2)) * across * side.weights / total
    return Rows(design=np.stack([*tilt, *shift], axis=1), rest=rest, weight=weight)


def circle_rows(
    side: BearingSide, line: Line, basis: FloatArray, *, spread: float, tolerance: float, share: float
) -> Rows:
    """Rows of t . u = 0 and t . (m - p) / radius = 0: a piece of edge runs around the axis.

    Args:
        side: Evidence of one part.
        line: Where to linearise.
        basis: From `across_axis`, shape (2, 3).
        spread: Unit of the shifts [m].
        tolerance: Residual at which the weight has fallen to 1/e.
        share: Weight of a full circle against all area.
    """
    arm = side.middles - line.point
    radial = arm - (arm @ line.axis)[:, None] * line.axis
    radius = np.sqrt(dots(radial, radial)) + 1e-12
    level = side.tangents @ line.axis
    outward = dots(side.tangents, radial) / radius
    zeros = np.zeros((len(radius), 2))
    tilt = np.concatenate([side.tangents @ basis.T, zeros], axis=1)
    shift = np.concatenate([zeros, -(side.tangents @ basis.T) * (spread / radius)[:, None]], axis=1)
    fit = np.exp(-((level / tolerance) ** 2) - (outward / tolerance) ** 2) * (side.lengths < OCTAGON * radius)
    weight = share * fit * side.edge_weights * np.minimum(side.lengths / radius, 0.5) / (2 * np.pi)
    return Rows(
        design=np.concatenate([tilt, shift]),
        rest=np.concatenate([level, outward]),
        weight=np.concatenate([weight, weight]),
    )


def _cross_matrix(vector: FloatArray) -> FloatArray:
    """Matrix of v -> vector x v, shape (3, 3)."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
