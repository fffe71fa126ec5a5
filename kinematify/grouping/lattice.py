"""Pieces on a common lattice: which cells each one fills, what is seen of it, and what it meets when it moves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import QhullError

from kinematify.assembly.part import rectangles_around
from kinematify.geometry.sampling import place_samples

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Part
    from kinematify.robot.arrays import FloatArray, IntArray

CELLS = 72
"""Cells along the longest side of the object; its thin boards are one to three cells thick."""
DIRECTIONS = ((0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))
"""Up, down, and the four sides; each is followed by its opposite."""
REACHES = ((1, 2, 3), (4, 6, 9), (13, 18, 24))
"""Steps of three ranges of motion [cells]."""
_PER_CELL = 2.0
"""Samples for the area of a cell's side."""
_FEWEST, _MOST = 48, 400_000
"""Samples of a piece and of all."""
PAD = 26


@dataclass(frozen=True, kw_only=True, eq=False)
class Lattice:
    """Samples of all pieces and the cells that they fill; the plan is turned so that the object stands square."""

    points: FloatArray
    """Samples of all pieces, square frame [object lengths, the longest side is 1], shape (n, 3)."""
    piece: IntArray
    """Piece of every sample, shape (n,), ascending."""
    count: int
    """Pieces."""

    @cached_property
    def bounds(self) -> FloatArray:
        """Lower and upper corner of every piece, shape (count, 2, 3)."""
        starts = np.searchsorted(self.piece, np.arange(self.count))
        low = np.minimum.reduceat(self.points, starts)
        return np.stack([low, np.maximum.reduceat(self.points, starts)], axis=1)

    @cached_property
    def end(self) -> FloatArray:
        """Upper corner of the object; its lower one is 0. Shape (3,)."""
        return np.asarray(self.points.max(axis=0))

    @cached_property
    def shape(self) -> IntArray:
        """Cells along each axis with a margin, shape (3,)."""
        return np.asarray(np.floor(self.end * CELLS) + 1 + 2 * PAD, dtype=np.int64)

    @cached_property
    def _strides(self) -> IntArray:
        return np.array([self.shape[1] * self.shape[2], self.shape[2], 1])

    @cached_property
    def filled(self) -> tuple[IntArray, IntArray]:
        """Distinct pairs of cell and piece, by cell: keys of cells (m,) and pieces (m,)."""
        cells = np.floor(self.points * CELLS).astype(np.int64) + PAD
        keys = np.unique((cells @ self._strides) * self.count + self.piece)
        return keys // self.count, keys % self.count

    @cached_property
    def sizes(self) -> IntArray:
        """Cells of every piece, shape (count,)."""
        return np.bincount(self.filled[1], minlength=self.count)

    def meetings(self, direction: int, steps: int) -> FloatArray:
        """Cells of each piece that meet each other piece when it moves alone, shape (count, count).

        Args:
            direction: Index in `DIRECTIONS`.
            steps: Cells of motion.
        """
        cells, pieces = self.filled
        wanted = cells + steps * int(np.array(DIRECTIONS[direction]) @ self._strides)
        first = np.searchsorted(cells, wanted)
        number = np.searchsorted(cells, wanted, side="right") - first
        row = np.repeat(np.arange(len(cells)), number)
        place = np.repeat(first - np.cumsum(number) + number, number) + np.arange(len(row))
        keys = pieces[row] * self.count + pieces[place]
        met: FloatArray = np.bincount(keys, minlength=self.count**2).reshape(self.count, self.count).astype(np.float64)
        np.fill_diagonal(met, 0.0)
        return met

    @cached_property
    def at_rest(self) -> FloatArray:
        """Cells that each piece shares with each other one, shape (count, count)."""
        return self.meetings(0, 0)

    @cached_property
    def met(self) -> FloatArray:
        """The most cells that meet within each of `REACHES` along each of `DIRECTIONS`, beyond those at rest.

        Shape (3, 6, count, count); moved piece, then the piece that it meets.
        """
        found = np.zeros((len(REACHES), len(DIRECTIONS), self.count, self.count))
        for r, reach in enumerate(REACHES):
            for k in range(len(DIRECTIONS)):
                for steps in reach:
                    np.maximum(found[r, k], self.meetings(k, steps) - self.at_rest, out=found[r, k])
        return np.maximum.accumulate(found, axis=0)

    @cached_property
    def seen(self) -> FloatArray:
        """Cells of each piece that are the first ones from each of `DIRECTIONS`, shape (count, 6)."""
        cells, pieces = self.filled
        places = np.stack(np.unravel_index(cells, tuple(self.shape)), axis=1)
        found = np.empty((self.count, 6))
        for k, direction in enumerate(DIRECTIONS):
            axis = int(np.argmax(np.abs(direction)))
            across = [a for a in range(3) if a != axis]
            column = places[:, across[0]] * self.shape[across[1]] + places[:, across[1]]
            height = places[:, axis] * sum(direction)
            top = np.full(int(column.max()) + 1, np.iinfo(np.int64).min)
            np.maximum.at(top, column, height)
            found[:, k] = np.bincount(pieces[height == top[column]], minlength=self.count)
        return found


def lattice(parts: Sequence[Part]) -> Lattice:
    """Sample every piece as densely as the lattice needs.

    Args:
        parts: Pieces with area, world frame, z up.
    """
    turn, low, size = frame_of(parts)
    areas = np.array([part.area for part in parts])
    wanted = np.maximum(areas * _PER_CELL * (CELLS / size) ** 2, _FEWEST)
    wanted *= min(1.0, _MOST / wanted.sum())
    samples = [_samples(part, max(int(number), 8)) for part, number in zip(parts, wanted, strict=True)]
    points = (np.concatenate(samples) @ turn.T - low) / size
    return Lattice(
        points=np.clip(points, 0.0, None),
        piece=np.repeat(np.arange(len(parts)), [len(part) for part in samples]),
        count=len(parts),
    )


def frame_of(parts: Sequence[Part]) -> tuple[FloatArray, FloatArray, float]:
    """Turn, offset and length of the frame of the lattice, shape (3, 3) and (3,) [m]."""
    used = np.concatenate([part.vertices[np.unique(part.faces)] for part in parts])
    turn = _square_turn(used[:, :2])
    used = used @ turn.T
    return turn, used.min(axis=0), float(np.ptp(used, axis=0).max())


def _square_turn(plan: FloatArray) -> FloatArray:
    """Rotation about z that makes the smallest rectangle around points in the plan (n, 2) square to the axes."""
    turn = np.eye(3)
    try:
        along, widths = rectangles_around(plan)
    except QhullError:  # all points on one line
        return turn
    diagonals = np.hypot(*widths)
    square = np.abs(along).max(axis=1) > 1.0 - 1e-9  # of sides that are as good, one that is square already
    best = int(np.argmin(diagonals - 1e-9 * diagonals.max() * square))
    angle = np.arctan2(along[best, 1], along[best, 0]) % (0.5 * np.pi)
    if min(angle, 0.5 * np.pi - angle) < 1e-6:
        return turn
    turn[:2, :2] = [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
    return turn


def _samples(part: Part, count: int) -> FloatArray:
    """Points on the surface with some of its vertices, shape (n, 3)."""
    corners = part.vertices[part.faces]
    faces, barycentric = place_samples(corners, part.face_areas, np.arange(len(corners)), count, 0)
    on_surface = np.einsum("nc,ncd->nd", barycentric, corners[faces])
    vertices = part.vertices[np.unique(part.faces)]
    return np.concatenate([on_surface, vertices[:: max(1, len(vertices) // count)]])
