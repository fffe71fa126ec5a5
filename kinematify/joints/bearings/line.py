"""Straight lines in space: candidates for joint axes, before they have a type, a sign or limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.vectors import crossed, dots, lengths_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.robot.arrays import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Line:
    """A line through a point; the sign of its direction means nothing."""

    axis: FloatArray
    """Unit direction, world frame, shape (3,)."""
    point: FloatArray
    """Any point of the line, world frame [m], shape (3,)."""

    def foot(self, target: FloatArray) -> FloatArray:
        """Point of the line that is nearest to `target`, world frame [m], shape (3,)."""
        return self.point + self.axis * float((target - self.point) @ self.axis)


@dataclass(frozen=True, kw_only=True, eq=False)
class Lines:
    """Many lines in two arrays."""

    axes: FloatArray
    """Unit directions, world frame, shape (L, 3)."""
    points: FloatArray
    """A point of each line, world frame [m], shape (L, 3)."""

    def __len__(self) -> int:
        return len(self.axes)

    def __getitem__(self, index: int) -> Line:
        return Line(axis=self.axes[index], point=self.points[index])

    def __iter__(self) -> Iterator[Line]:
        return (self[index] for index in range(len(self)))

    def subset(self, index: IntArray | Sequence[int] | slice) -> Lines:
        """Keep the lines at these positions, in this order."""
        return Lines(axes=self.axes[index], points=self.points[index])

    def through_feet(self, target: FloatArray) -> Lines:
        """The same lines, each with the point that is nearest to `target` (3,)."""
        along = np.einsum("ij,ij->i", target - self.points, self.axes)
        return Lines(axes=self.axes, points=self.points + along[:, None] * self.axes)

    def distinct(self, count: int, *, angle: float, distance: float) -> list[int]:
        """Pick greedily, in the given order, the lines that differ from every line picked before.

        Args:
            count: Stop after this many.
            angle: Lines closer in direction [deg] *and* in position repeat each other.
            distance: From the point of one line to the other line [m].

        Returns:
            Their positions, ascending.
        """
        kept: list[int] = []
        cosine = np.cos(np.deg2rad(angle))
        left = np.arange(len(self))
        while len(left) and len(kept) < count:
            kept.append(int(left[0]))
            axes = self.axes[left]
            offset = self.points[left[0]] - self.points[left]
            offset -= dots(offset, axes)[:, None] * axes
            same = (np.abs(dots(axes, axes[0])) > cosine) & (lengths_of(offset) < distance)
            same[0] = True
            left = left[~same]
        return kept


def join(parts: Sequence[Lines]) -> Lines:
    """Put lists of lines one after the other."""
    return Lines(
        axes=np.concatenate([part.axes for part in parts]), points=np.concatenate([part.points for part in parts])
    )


def lines_of(lines: Sequence[Line]) -> Lines:
    """Lines in two arrays, in their order."""
    return Lines(
        axes=np.array([line.axis for line in lines]).reshape(-1, 3),
        points=np.array([line.point for line in lines]).reshape(-1, 3),
    )


def meeting_lines(
    points: FloatArray, normals: FloatArray, pairs: tuple[IntArray, IntArray], least_sine: float
) -> tuple[Lines, FloatArray]:
    """Axes of the cylinders through pairs of points: each runs along n1 x n2, through where the normals meet.

    Args:
        points: World frame [m], shape (n, 3).
        normals: Unit normals there, shape (n, 3).
        pairs: Positions of the first and of the second of each pair, shape (p,) each.
        least_sine: Pairs whose normals are more nearly parallel are omitted: it leaves the direction open.

    Returns:
        The lines, and how far along its normal each first point meets its line [m].
    """
    n1, n2 = (normals[index] for index in pairs)
    cross = crossed(n1, n2)
    sine = lengths_of(cross)
    good = sine > least_sine
    axes = cross[good] / sine[good, None]
    first, second = (points[index[good]] for index in pairs)
    # Solve x1 + s n1 = x2 + t n2 in the plane across the axis.
    along = np.einsum("ij,ij->i", crossed(second - first, n2[good]), axes) / sine[good]
    return Lines(axes=axes, points=first + along[:, None] * n1[good]), along


NO_LINES = Lines(axes=np.empty((0, 3)), points=np.empty((0, 3)))
