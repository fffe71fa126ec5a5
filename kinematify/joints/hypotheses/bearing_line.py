"""A bearing line with its support on both parts, and all those of a contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.hypotheses.bearing_scores import circle_support, surface_support
from kinematify.joints.hypotheses.line import Line, Lines
from kinematify.robot.arrays import read_only

if TYPE_CHECKING:
    from kinematify.config import BearingConfig
    from kinematify.joints.hypotheses.bearing_evidence import Sides
    from kinematify.joints.hypotheses.rail import Rail
    from kinematify.robot.arrays import FloatArray


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
    follows: tuple[tuple[int, int], ...] = ()
    """Contacts of congruent parts whose evidence put another line first than this contact would by itself."""


def scored_line(sides: Sides, line: Line, centroid: FloatArray, diagonal: float, config: BearingConfig) -> BearingLine:
    """Score a line as a bearing of a contact; its pivot is the foot of the contact centroid."""
    return scored_lines(sides, Lines(axes=line.axis[None], points=line.point[None]), centroid, diagonal, config)[0]


def scored_lines(
    sides: Sides, lines: Lines, centroid: FloatArray, diagonal: float, config: BearingConfig
) -> list[BearingLine]:
    """`scored_line` of each of many lines."""
    surface_a, surface_b = (surface_support(side, lines, config).tolist() for side in sides)
    scored = []
    for index, line in enumerate(lines):
        circles_a, circles_b = (circle_support(side, line, diagonal=diagonal, config=config) for side in sides)
        support = np.sqrt(surface_a[index] * surface_b[index])
        score = float(support * (config.circle_floor + np.sqrt(circles_a * circles_b)) / (config.circle_floor + 1))
        scored.append(
            BearingLine(
                axis=line.axis,
                pivot=line.foot(centroid),
                score=score,
                surface_a=surface_a[index],
                surface_b=surface_b[index],
                circles_a=circles_a,
                circles_b=circles_b,
            )
        )
    return scored


def best_distinct(lines: list[BearingLine], diagonal: float, config: BearingConfig) -> list[BearingLine]:
    """The best lines, best first, without those that nearly repeat a better one."""
    ordered = sorted(lines, key=lambda line: -line.score)
    where = Lines(
        axes=np.array([line.axis for line in ordered]).reshape(-1, 3),
        points=np.array([line.pivot for line in ordered]).reshape(-1, 3),
    )
    kept = where.distinct(config.keep, angle=config.apart_angle, distance=config.apart * diagonal)
    return [ordered[index] for index in kept]
