"""A side of a body, in whose frame mechanisms are built as if every side were the front."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.fronts import Bay

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.generate.procedural.solids import Point
    from kinematify.robot.arrays import FloatArray

FACING = {
    "front": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "back": ((-1, 0, 0), (0, -1, 0), (0, 0, 1)),
    "left": ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    "right": ((0, 1, 0), (-1, 0, 0), (0, 0, 1)),
    "top": ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
    "bottom": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
}
"""World directions of a side's x (to the right, seen from outside), y (into the body) and z (up)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class BodySide:
    """A rectangle of a body's surface that mechanisms may take."""

    T_world_side: FloatArray
    """Shape (3, 4); the surface is y = 0, the body lies at y > 0."""
    area: Bay
    hollow: bool = True
    """Rooms may be cut behind it, as deep as the area says."""
    is_open: bool = False
    """There is nothing behind it but air: only what closes it goes there."""
    end: str = ""
    """What it is the end of, for what needs just that: a ``round mouth``, a ``post``, or ``legs``."""
    axles: Bay | None = None
    """Where wheels stand: their height is its bottom, they are spread between left and right."""
    ahead: float = 0.0
    """Where a vehicle goes: 1 or -1 along x. Wheels between the first and the last one then stand by the last one."""


def side_of(
    name: str,
    origin: Point,
    area: Bay,
    *,
    hollow: bool = True,
    is_open: bool = False,
    axles: Bay | None = None,
    end: str = "",
) -> BodySide:
    """Return a side that looks as its name says; `origin` is where its x and z are zero, on the surface."""
    turn = np.array(FACING[name], dtype=np.float64).T
    return BodySide(
        T_world_side=np.column_stack([turn, np.asarray(origin, dtype=np.float64)]),
        area=area,
        hollow=hollow and not is_open,
        is_open=is_open,
        axles=axles,
        end=end,
    )


def rows(area: Bay, weights: Sequence[float]) -> list[Bay]:
    """Divide an area from top to bottom in shares of its height."""
    ends = area.top - area.height * np.cumsum([0.0, *weights]) / sum(weights)
    return [replace(area, top=float(top), bottom=float(end)) for top, end in pairwise(ends)]


def columns(area: Bay, count: int) -> list[Bay]:
    """Divide an area into equal columns, from the left."""
    ends = np.linspace(area.left, area.right, count + 1)
    return [replace(area, left=float(left), right=float(end)) for left, end in pairwise(ends)]
