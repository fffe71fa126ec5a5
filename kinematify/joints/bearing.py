"""Bearings: the line about which both sides of a contact are surfaces of revolution.

A revolute joint that was designed leaves two kinds of evidence on *both* parts near their contact: area that a
rotation about the axis maps onto itself (all normals meet the axis: the linear-complex criterion of Pottmann and
Gelfand-Guibas slippage), and circular edges about the axis. Lines are proposed from pairs of normals and from circles
through feature edges, scored on both parts, and refined by robust Gauss-Newton on the same residuals.
feasibility.md section 4 measured why the paper's own pool and ranking (joints/cavl.py) are not enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import read_only
from kinematify.joints.bearing_evidence import contact_centroid, contact_sides, thin, whole_side
from kinematify.joints.bearing_fit import refine_line
from kinematify.joints.bearing_proposals import normal_pair_lines, propose_lines
from kinematify.joints.bearing_scores import circle_support, line_support, surface_support
from kinematify.joints.line import Line, Lines
from kinematify.joints.rail import Rail, fit_rail

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly, FloatArray
    from kinematify.config import BearingConfig
    from kinematify.contact.graph import ContactEdge, ContactGraph
    from kinematify.geometry.surface import PartSurface
    from kinematify.joints.bearing_evidence import Side, Sides


@dataclass(frozen=True, kw_only=True, eq=False)
class BearingLine:
    """A line about which the contact could turn, with its support on either part (each in [0, 1])."""

    axis: FloatArray
    """Unit direction, world frame, shape (3,). Read-only."""
    pivot: FloatArray
    """Point of the line nearest to the contact centroid, world frame [m], shape (3,). Read-only."""
    score: float
    """Combined support; comparable among edges of one assembly."""
    surface_a: float
    surface_b: float
    circles_a: float
    circles_b: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "axis", read_only(self.axis, np.float64))
        object.__setattr__(self, "pivot", read_only(self.pivot, np.float64))

    @property
    def line(self) -> Line:
        """The line alone."""
        return Line(axis=self.axis, point=self.pivot)

    @property
    def surface(self) -> float:
        """Geometric mean of the revolution support of both parts (F of feasibility.md section 4)."""
        return float(np.sqrt(self.surface_a * self.surface_b))

    @property
    def circles(self) -> float:
        """Geometric mean of the circle support of both parts (CS of feasibility.md section 4)."""
        return float(np.sqrt(self.circles_a * self.circles_b))


@dataclass(frozen=True, kw_only=True, eq=False)
class EdgeBearing:
    """Bearing lines of one contact edge, best first, and its rail; empty where nothing is round or extruded."""

    a: int
    b: int
    centroid: FloatArray
    """Weighted contact centroid, world frame [m], shape (3,). Read-only."""
    lines: tuple[BearingLine, ...]
    rail: Rail | None = None


def fit_bearings(
    assembly: Assembly, surfaces: Sequence[PartSurface], graph: ContactGraph, *, config: BearingConfig, seed: int
) -> dict[tuple[int, int], EdgeBearing]:
    """Fit bearing lines to every contact edge.

    Args:
        assembly: The parts.
        surfaces: Derived geometry of each part, same order.
        graph: Contact graph with samples.
        config: Scales as fractions of the assembly's diagonal.
        seed: Seed of the sampled pairs.

    Returns:
        One entry per edge, keyed like `ContactGraph.by_pair`.
    """
    return {
        (edge.a, edge.b): fit_edge(surfaces, edge, diagonal=assembly.diagonal, config=config, seed=seed)
        for edge in graph.edges
    }


def fit_edge(
    surfaces: Sequence[PartSurface], edge: ContactEdge, *, diagonal: float, config: BearingConfig, seed: int
) -> EdgeBearing:
    """Propose, score and refine the lines of one contact edge; `diagonal` is that of the assembly [m]."""
    rng = np.random.default_rng([seed, edge.a, edge.b])
    if surfaces[edge.a].noisy or surfaces[edge.b].noisy:
        config = config.for_noise
    sides = contact_sides(surfaces, edge, diagonal=diagonal, config=config)
    centroid = contact_centroid(sides)
    proposals = propose_lines(sides, centroid, diagonal=diagonal, config=config, rng=rng)
    lines = _rank(sides, proposals, centroid, diagonal, config)
    if not lines or lines[0].score < config.turned_score:
        turned = _turned_lines(surfaces, edge, centroid, config, rng)
        lines = sorted([*lines, *turned], key=lambda line: -line.score)
    return EdgeBearing(
        a=edge.a,
        b=edge.b,
        centroid=read_only(centroid, np.float64),
        lines=tuple(lines),
        rail=fit_rail(sides, config.rail, rng),
    )


def score_line(
    surfaces: Sequence[PartSurface], edge: ContactEdge, line: Line, *, diagonal: float, config: BearingConfig
) -> BearingLine:
    """Score one given line as a bearing of a contact edge, as `fit_edge` scores its own, without refining it."""
    if surfaces[edge.a].noisy or surfaces[edge.b].noisy:
        config = config.for_noise
    sides = contact_sides(surfaces, edge, diagonal=diagonal, config=config)
    return _scored(sides, line, contact_centroid(sides), diagonal, config)


def _rank(
    sides: Sides, proposals: Lines, centroid: FloatArray, diagonal: float, config: BearingConfig
) -> list[BearingLine]:
    """Refine lines on few samples, keep the best distinct ones, finish them on all samples; best first."""
    few = thin(sides[0], config.refine_samples), thin(sides[1], config.refine_samples)
    tolerances = _tolerances(config)
    rough = [_scored(few, refine_line(few, line, tolerances, config), centroid, diagonal, config) for line in proposals]
    final = [
        _scored(sides, refine_line(sides, line.line, tolerances[-2:], config), centroid, diagonal, config)
        for line in _best_distinct(rough, diagonal, config)
    ]
    return _best_distinct(final, diagonal, config)


def _tolerances(config: BearingConfig) -> FloatArray:
    """Sine of the tolerance of every round of refinement, coarse to fine."""
    return np.geomspace(config.normal_tolerance_sine, config.fine_tolerance_sine, config.refine_steps)


def _best_distinct(lines: list[BearingLine], diagonal: float, config: BearingConfig) -> list[BearingLine]:
    """The best lines, best first, without those that nearly repeat a better one."""
    ordered = sorted(lines, key=lambda line: -line.score)
    where = Lines(
        axes=np.array([line.axis for line in ordered]).reshape(-1, 3),
        points=np.array([line.pivot for line in ordered]).reshape(-1, 3),
    )
    kept = where.distinct(config.keep, angle=config.apart_angle, distance=config.apart * diagonal)
    return [ordered[index] for index in kept]


def _scored(sides: Sides, line: Line, centroid: FloatArray, diagonal: float, config: BearingConfig) -> BearingLine:
    """Score a line; its pivot is the foot of the contact centroid."""
    surface_a, surface_b = (line_support(side, line, config) for side in sides)
    circles_a, circles_b = (circle_support(side, line, diagonal=diagonal, config=config) for side in sides)
    support = np.sqrt(surface_a * surface_b)
    score = float(support * (config.circle_floor + np.sqrt(circles_a * circles_b)) / (config.circle_floor + 1))
    return BearingLine(
        axis=line.axis,
        pivot=line.foot(centroid),
        score=score,
        surface_a=surface_a,
        surface_b=surface_b,
        circles_a=circles_a,
        circles_b=circles_b,
    )


def _turned_lines(
    surfaces: Sequence[PartSurface],
    edge: ContactEdge,
    centroid: FloatArray,
    config: BearingConfig,
    rng: np.random.Generator,
) -> list[BearingLine]:
    """Axes of wheels and discs: a part that is round as a whole turns about its own axis.

    The other part often models no bearing at all (a wheel in its well). Long round parts are left out: a rod hinged
    at its end is round about the wrong line.
    """
    lines = []
    for own, shares in ((edge.a, (1.0, 0.0)), (edge.b, (0.0, 1.0))):
        side = whole_side(surfaces[own], config.turned_samples)
        line = _own_axis(side, config, rng)
        if line is None:
            continue
        support = line_support(side, line, config)
        arm = side.points - line.point
        height = float(np.ptp(arm @ line.axis))
        width = 2 * float(np.linalg.norm(np.cross(arm, line.axis), axis=1).max())
        if support >= config.turned_support and height <= config.turned_length * width:
            lines.append(
                BearingLine(
                    axis=line.axis,
                    pivot=line.foot(centroid),
                    score=config.turned_score * support,
                    surface_a=support * shares[0],
                    surface_b=support * shares[1],
                    circles_a=0.0,
                    circles_b=0.0,
                )
            )
    return lines


def _own_axis(side: Side, config: BearingConfig, rng: np.random.Generator) -> Line | None:
    """The line about which a whole part is most nearly a surface of revolution."""
    lines = normal_pair_lines(side, config.turned_samples, rng)
    if len(lines) == 0:
        return None
    best = int(np.argmax(surface_support(side, lines, config)))
    return refine_line((side, side), lines[best], _tolerances(config), config)
