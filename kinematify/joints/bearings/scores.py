"""Scores of the evidence near a contact: the share that turns or slides into itself about a line or direction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.bearings.line import Line, Lines, lines_of
from kinematify.robot.arrays import read_only
from kinematify.robot.vectors import crossed, lengths_of, unit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import BearingConfig, RailConfig
    from kinematify.joints.bearings.bearing_evidence import BearingSide, Generators, Sides
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Rail:
    """The direction along which a contact could slide; the counterpart of a bearing.

    Area whose normals lie across the direction slides along itself (slippage of Gelfand and Guibas for a translation),
    and straight edges along it are what guides, columns and telescopes leave; a rail needs both, on both parts.
    """

    axis: FloatArray
    """Unit direction, world frame, shape (3,). Read-only."""
    score: float
    """Combined support."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "axis", read_only(self.axis, np.float64))


def fit_rail(sides: Sides, config: RailConfig, draws: Generators) -> Rail | None:
    """Find the best rail of a contact.

    Args:
        sides: Evidence of both parts near their contact.
        config: Tolerances and number of proposals.
        draws: One generator for each part; they draw the pairs of normals whose cross products are the proposals.

    Returns:
        The best direction; None where no two normals cross or a side is empty.
    """
    proposals = [_cross_directions(side, config.pairs, rng) for side, rng in zip(sides, draws, strict=True)]
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
    return cross[good] / sine[good, None]


def _score(sides: Sides, axes: FloatArray, config: RailConfig) -> FloatArray:
    area = [_extruded_area(side, axes, config) for side in sides]
    edges = [_guiding_edges(side, axes, config) for side in sides]
    guided = (config.edge_floor + np.sqrt(edges[0] * edges[1])) / (config.edge_floor + 1)
    return np.sqrt(area[0] * area[1]) * guided


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
    return np.clip(2 * np.linalg.eigvalsh(moments)[:, 1], 0.0, 1.0)


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


OCTAGON = 0.8
"""Length of an edge piece in radii beyond which it is no arc: an octagon's side is 0.77 long."""
CACHED = 16384
"""Samples times lines at a time: they fit the cache, and what NumPy allocates is not new memory each time."""


def surface_support(side: BearingSide, lines: Lines, config: BearingConfig) -> FloatArray:
    """Share of near area that turns into itself about each line, weighted by how well it locates the line.

    Consistent area counts through the smaller eigenvalue of the 2x2 matrix of its normals across the axis: a flat
    wall, which a far-away line explains too, has rank one and counts nothing. Area perpendicular to the axis (flanges,
    washers) counts a little.

    Args:
        side: Evidence of one part.
        lines: L candidates.
        config: Tolerance of the normals and weight of flanges.

    Returns:
        Support in [0, 1], shape (L,).
    """
    step = max(1, CACHED // max(1, len(side.weights)))
    blocks = [
        _block_support(side, lines.subset(slice(start, start + step)), config) for start in range(0, len(lines), step)
    ]
    return np.asarray(np.clip(np.concatenate([*blocks, np.empty(0)]), 0.0, 1.0))


def _block_support(side: BearingSide, lines: Lines, config: BearingConfig) -> FloatArray:
    u, p = lines.axes, lines.points
    e1, e2 = across_axes(u)
    along = side.normals @ u.T  # (S, L)
    n1, n2 = side.normals @ e1.T, side.normals @ e2.T
    x1 = side.points @ e1.T - np.einsum("ij,ij->i", p, e1)
    x2 = side.points @ e2.T - np.einsum("ij,ij->i", p, e2)
    radius = np.sqrt(x1 * x1 + x2 * x2) + 1e-12
    miss = (x1 * n2 - x2 * n1) / radius  # sine of the angle between normal and meridian plane
    fit = np.exp(-((miss / config.normal_tolerance_sine) ** 2)) * side.weights[:, None]
    s11, s22, s12 = (fit * n1 * n1).sum(0), (fit * n2 * n2).sum(0), (fit * n1 * n2).sum(0)
    half = 0.5 * (s11 + s22)
    smaller = half - np.sqrt(np.maximum(0.25 * (s11 - s22) ** 2 + s12 * s12, 0))
    flat = (np.exp(-((1 - along * along) / config.normal_tolerance_sine**2)) * side.weights[:, None]).sum(0)
    total = max(float(side.weights.sum()), 1e-300)
    return np.asarray((2 * smaller + config.flange_weight * flat) / total)


def across_axes(axes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors across each axis, shapes (L, 3); zero where that is zero."""
    helper = np.eye(3)[np.argmin(np.abs(axes), axis=1)]
    first = unit(crossed(axes, helper))
    return first, crossed(axes, first)


def circle_support(side: BearingSide, line: Line, config: BearingConfig) -> float:
    """Arc of feature edges that run around the line, in full turns near the contact, saturated to [0, 1].

    Args:
        side: Evidence of one part.
        line: The candidate.
        config: Tolerances; pieces of nearly equal radius and height belong to one circle.
    """
    if len(side.lengths) == 0:
        return 0.0
    offset = side.middles - line.point
    height = offset @ line.axis
    radial = offset - height[:, None] * line.axis
    radius = lengths_of(radial)
    sine = config.circle_tolerance_sine
    around = (
        (np.abs(side.tangents @ line.axis) < sine)
        & (np.abs(np.einsum("ij,ij->i", side.tangents, radial)) < sine * radius)
        & (side.lengths < OCTAGON * radius)
    )
    if not around.any():
        return 0.0
    keys = np.round(np.stack([radius[around], height[around]], axis=1) / config.circle_cell)
    _, inverse = np.unique(keys, axis=0, return_inverse=True)
    turn = side.lengths[around] / radius[around] / (2 * np.pi)
    turns = np.bincount(inverse.reshape(-1), turn)
    weighted = np.bincount(inverse.reshape(-1), turn * side.edge_weights[around])
    arc = weighted * (turns > config.least_arc)
    return float(1 - np.exp(-np.minimum(arc, 2.0).sum()))


@dataclass(frozen=True, kw_only=True, eq=False)
class BearingLine:
    """A line about which the contact could turn, with its support on either part (each in [0, 1])."""

    axis: FloatArray
    """Unit direction, world frame, shape (3,). Read-only."""
    pivot: FloatArray
    """Point of the line nearest to the contact centroid, world frame [m], shape (3,). Read-only."""
    score: float
    """Combined support; comparable among edges of one assembly."""
    surfaces: tuple[float, ...]
    """Share of either part's area that turns into itself about it."""
    rings: tuple[float, ...]
    """The same of its circular edges."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "axis", read_only(self.axis, np.float64))
        object.__setattr__(self, "pivot", read_only(self.pivot, np.float64))

    @property
    def line(self) -> Line:
        """The line alone."""
        return Line(axis=self.axis, point=self.pivot)

    @property
    def exchanged(self) -> BearingLine:
        """The same line with its support on either part exchanged."""
        return replace(self, surfaces=self.surfaces[::-1], rings=self.rings[::-1])

    @property
    def surface(self) -> float:
        """Geometric mean of the revolution support of both parts (F of feasibility.md section 4)."""
        return float(np.sqrt(np.prod(self.surfaces)))

    @property
    def circles(self) -> float:
        """Geometric mean of the circle support of both parts (CS of feasibility.md section 4)."""
        return float(np.sqrt(np.prod(self.rings)))


@dataclass(frozen=True, kw_only=True, eq=False)
class EdgeBearing:
    """Bearing lines of one contact edge, best first, and its rail; empty where nothing is round or extruded."""

    centroid: FloatArray
    """Weighted contact centroid, world frame [m], shape (3,). Read-only."""
    lines: tuple[BearingLine, ...]
    rail: Rail | None = None
    follows: tuple[tuple[int, int], ...] = ()
    """Contacts of congruent parts whose evidence put another line first than this contact would by itself."""

    @property
    def best_score(self) -> float:
        """Score of the best line; 0 without one."""
        return self.lines[0].score if self.lines else 0.0


def scored_line(sides: Sides, line: Line, centroid: FloatArray, config: BearingConfig) -> BearingLine:
    """Score a line as a bearing of a contact; its pivot is the foot of the contact centroid."""
    return scored_lines(sides, lines_of([line]), centroid, config)[0]


def scored_lines(sides: Sides, lines: Lines, centroid: FloatArray, config: BearingConfig) -> list[BearingLine]:
    """`scored_line` of each of many lines."""
    supports = [surface_support(side, lines, config).tolist() for side in sides]
    scored, floor = [], config.circle_floor
    for line, surfaces in zip(lines, zip(*supports, strict=True), strict=True):
        rings = tuple(circle_support(side, line, config) for side in sides)
        score = float(np.sqrt(np.prod(surfaces)) * (floor + np.sqrt(np.prod(rings))) / (floor + 1))
        pivot = line.foot(centroid)
        scored.append(BearingLine(axis=line.axis, pivot=pivot, score=score, surfaces=surfaces, rings=rings))
    return scored


def best_distinct(lines: Sequence[BearingLine], config: BearingConfig) -> list[BearingLine]:
    """The best lines, best first, without those that nearly repeat a better one."""
    ordered = sorted(lines, key=lambda line: -line.score)
    where = lines_of([line.line for line in ordered])
    kept = where.distinct(config.keep, angle=config.apart_angle, distance=config.apart)
    return [ordered[index] for index in kept]
