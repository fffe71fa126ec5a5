"""A side of a body, and a workshop in whose frame mechanisms are built as if every side were the front."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.fronts import Opening
from kinematify.generate.procedural.workshop import Workshop

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.solids import Point
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Mimic

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
class Side:
    """A rectangle of a body's surface that mechanisms may take."""

    T_world_side: FloatArray
    """Shape (3, 4); the surface is y = 0, the body lies at y > 0."""
    area: Opening
    hollow: bool = True
    """Rooms may be cut behind it, as deep as the area says."""
    is_open: bool = False
    """There is nothing behind it but air: only what closes it goes there."""
    axles: Opening | None = None
    """Where wheels stand: their height is its bottom, they are spread between left and right."""


def side_of(
    name: str,
    origin: Point,
    area: Opening,
    *,
    hollow: bool = True,
    is_open: bool = False,
    axles: Opening | None = None,
) -> Side:
    """Return a side that looks as its name says; `origin` is where its x and z are zero, on the surface."""
    turn = np.array(FACING[name], dtype=np.float64).T
    return Side(
        T_world_side=np.column_stack([turn, np.asarray(origin, dtype=np.float64)]),
        area=area,
        hollow=hollow and not is_open,
        is_open=is_open,
        axles=axles,
    )


def rows(area: Opening, weights: Sequence[float]) -> list[Opening]:
    """Divide an area from top to bottom in shares of its height."""
    ends = area.top - area.height * np.cumsum([0.0, *weights]) / sum(weights)
    return [replace(area, top=float(top), bottom=float(end)) for top, end in pairwise(ends)]


def columns(area: Opening, count: int) -> list[Opening]:
    """Divide an area into equal columns, from the left."""
    ends = np.linspace(area.left, area.right, count + 1)
    return [replace(area, left=float(left), right=float(end)) for left, end in pairwise(ends)]


class SideWorkshop(Workshop):
    """A workshop in the frame of a side; what is built in it stands there in the object."""

    def __init__(
        self, whole: Workshop, T_world_side: FloatArray, *, material: str | None = None, color: str | None = None
    ) -> None:
        """Look at a workshop from a side.

        Args:
            whole: Where bodies and joints go.
            T_world_side: Shape (3, 4).
            material: Of bodies that name none.
            color: Of all bodies that are built here; their own if None.
        """
        self._whole = whole
        self._place = T_world_side
        self._made_of = material
        self._color_of_all = color

    def turned(self, turn: FloatArray, origin: Point) -> SideWorkshop:
        """The same from a frame that is turned by `turn`, shape (3, 3), and moved to `origin` in this one."""
        frame = np.column_stack([self._place[:, :3] @ turn, self._point(origin)])
        return SideWorkshop(self._whole, frame, material=self._made_of, color=self._color_of_all)

    def body(self, name: str, *solids: Manifold, material: str | None = None, color: str | None = None) -> str:
        """See `Workshop.body`."""
        made_of = self._made_of or material
        return self._whole.body(name, *self._placed(solids), material=made_of, color=self._color_of_all or color)

    def add(self, name: str, *solids: Manifold) -> None:
        """See `Workshop.add`."""
        self._whole.add(name, *self._placed(solids))

    def cut(self, name: str, *solids: Manifold) -> None:
        """See `Workshop.cut`."""
        self._whole.cut(name, *self._placed(solids))

    def painted(self, *solids: Manifold, material: str, color: str | None = None) -> Sequence[Manifold]:
        """See `Workshop.painted`."""
        return self._whole.painted(*solids, material=material, color=color)

    def as_handle(self, *solids: Manifold) -> Sequence[Manifold]:
        """See `Workshop.as_handle`."""
        return self._whole.as_handle(*solids)

    def turns(
        self,
        child: str,
        parent: str,
        axis: Point,
        pivot: Point,
        limits: tuple[float, float] | None = None,
        *,
        rest: float = 0.0,
        follows: Mimic | None = None,
    ) -> None:
        """See `Workshop.turns`."""
        self._whole.turns(
            child, parent, self._place[:, :3] @ axis, self._point(pivot), limits, rest=rest, follows=follows
        )

    def slides(
        self,
        child: str,
        parent: str,
        axis: Point,
        pivot: Point,
        limits: tuple[float, float],
        *,
        rest: float = 0.0,
    ) -> None:
        """See `Workshop.slides`."""
        self._whole.slides(child, parent, self._place[:, :3] @ axis, self._point(pivot), limits, rest=rest)

    def closes(self, one: str, other: str, pivot: Point) -> None:
        """See `Workshop.closes`."""
        self._whole.closes(one, other, self._point(pivot))

    def above_floor(self, point: Point) -> float:
        """Height of a point in the object [m]."""
        return float(self._point(point)[2])

    def _placed(self, solids: Sequence[Manifold]) -> list[Manifold]:
        return [solid.transform(self._place) for solid in solids]

    def _point(self, point: Point) -> FloatArray:
        return np.asarray(self._place @ (*point, 1.0))
