"""Rails: the direction along which both sides of a contact are extruded, as of a linear guide.

The counterpart of a bearing for sliding joints. Area whose normals lie across the direction slides along itself
(slippage of Gelfand and Guibas for a translation), and straight edges along it are what guides, columns and telescopes
leave; a rail needs both, on both parts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.bearings.scores import CACHED
from kinematify.robot.arrays import read_only
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from kinematify.config import RailConfig
    from kinematify.joints.bearings.evidence import BearingSide, Sides
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Rail:
    """The direction along which a contact could slide, with its support on either part (each in [0, 1])."""

    axis: FloatArray
    """Unit direction, world frame, shape (3,). Read-only."""
    score: float
    """Combined support."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "axis", read_only(self.axis, np.float64))


def fit_rail(sides: Sides, config: RailConfig, rng: np.random.Generator) -> Rail | None:
    """Find the best rail of a contact.

    Args:
        sides: Evidence of both parts near their contact.
        config: Tolerances and number of proposals.
        rng: Draws the pairs of normals whose cross products are the proposals.

    Returns:
        The best direction; None where no two normals cross or a side is empty.
    """
    proposals = [_cross_directions(side, config.pairs, rng) for side in sides]
    axes = np.concatenate(proposals)
    if len(axes) == 0 or any(len(side.weights) == 0 for side in sides):
        return None
    score = _score(sides, axes, config)
    best = axes[int(np.argmax(score))]
    refined = _refine(sides, best, config)
    return Rail(axis=refined, score=float(_score(sides, refined[None], config)[0]))


def _cross_directions(side: BearingSide, count: int, rng: np.random.Generator) -> FloatArray:
    """Directions across pairs of normals that are far from parallel, shape (L, 3)."""
    if len(side.weights) == 0:
        return np.empty((0, 3))
    first, second = rng.choice(len(side.weights), (2, count), p=side.weights / side.weights.sum())
    cross = crossed(side.normals[first], side.normals[second])
    sine = lengths_of(cross)
    good = sine > 0.3  # about 17 deg; nearly parallel normals leave the direction open
    return np.asarray(cross[good] / sine[good, None])


def _score(sides: Sides, axes: FloatArray, config: RailConfig) -> FloatArray:
    area = [_extruded_area(side, axes, config) for side in sides]
    edges = [_guiding_edges(side, axes, config) for side in sides]
    guided = (config.edge_floor + np.sqrt(edges[0] * edges[1])) / (config.edge_floor + 1)
    return np.asarray(np.sqrt(area[0] * area[1]) * guided)


def _extruded_area(side: BearingSide, axes: FloatArray, config: RailConfig) -> FloatArray:
    """Share of near area along each direction, through the smaller eigenvalue of its normals across it, (L,).

    One flat wall has rank one and counts nothing: it slides in two directions.
    """
    step = max(1, CACHED // len(side.weights))
    blocks = [_block_area(side, axes[start : start + step], config) for start in range(0, len(axes), step)]
    return np.concatenate(blocks)


def _block_area(side: BearingSide, axes: FloatArray, config: RailConfig) -> FloatArray:
    along = side.normals @ axes.T
    fit = np.exp(-((along / config.tolerance_sine) ** 2)) * (side.weights / side.weights.sum())[:, None]
    moments = np.empty((len(axes), 3, 3))
    for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)):  # equal directions keep equal digits
        moments[:, i, j] = moments[:, j, i] = (fit * (side.normals[:, i] * side.normals[:, j])[:, None]).sum(axis=0)
    # The normals that count are across the axis, so the smallest of the three eigenvalues belongs to the axis itself.
    return np.asarray(np.clip(2 * np.linalg.eigvalsh(moments)[:, 1], 0.0, 1.0))


def _guiding_edges(side: BearingSide, axes: FloatArray, config: RailConfig) -> FloatArray:
    """Share of the near feature edges' length that runs along each direction, (L,)."""
    lengths = side.lengths * side.edge_weights
    total = float(lengths.sum())
    if total <= 0:
        return np.zeros(len(axes))
    parallel = np.abs(side.tangents @ axes.T) > np.sqrt(1 - config.edge_tolerance_sine**2)
    return np.asarray(lengths @ parallel / total)


def _refine(sides: Sides, axis: FloatArray, config: RailConfig) -> FloatArray:
    """Direction of least squared sine against the normals that count, both parts weighing the same."""
    for _ in range(config.refine_steps):
        moments = np.zeros((3, 3))
        for side in sides:
            along = side.normals @ axis
            fit = np.exp(-((along / config.tolerance_sine) ** 2)) * side.weights
            moments += (side.normals * fit[:, None]).T @ side.normals / max(float(fit.sum()), 1e-300)
        axis = np.linalg.eigh(moments)[1][:, 0]
    return axis
