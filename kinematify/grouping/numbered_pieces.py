"""Pieces by number, as somebody is shown them, and the moving parts that an answer names."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.grouping.piece_sets import Candidate
    from kinematify.robot.arrays import FloatArray, IntArray

BODY = "body"
"""What stands still, in answers and as a link."""
MOST_NUMBERS = 60
_SURE = 2.0
"""Log odds from which two pieces get one number first."""
_SMALL = 0.03
"""Of the surface: only pieces below it are joined for the sake of fewer numbers."""
_AGREES, _GAIN, _LOSS = 0.5, 4.0, 2.0
"""IoU of areas from which an answer speaks for a set, and what it adds and takes at most [log odds]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class NamedPart:
    """A moving part as somebody named it; None for what was not said."""

    name: str
    pieces: IntArray
    """Indices of pieces, no two parts have one in common."""
    turns: bool | None = None
    axis: FloatArray | None = None
    """Unit direction, shape (3,); roughly, unless it is an axis of the world."""
    edges: tuple[str, ...] | None = None
    """Sides of the part's box at which it turns, as ``-y``; none for its middle."""
    on: str = BODY
    """Name of the part that carries it."""
    sure: float = 1.0


def few_numbers(areas: FloatArray, middles: FloatArray, pairs: IntArray, odds: FloatArray) -> IntArray:
    """Number of each piece, at most `MOST_NUMBERS`, shape (n,): the surest pairs first, then what lies nearest.

    Args:
        areas: Shape (n,).
        middles: Of their boxes, shape (n, 3).
        pairs: Neighbours, shape (m, 2).
        odds: Log odds that they are rigidly one, shape (m,).
    """
    owner, total, whole = np.arange(len(areas)), areas.copy(), areas.sum()
    for least in (_SURE, -np.inf):
        for row in np.argsort(-odds, kind="stable"):
            kept, gone = sorted(owner[pairs[row]].tolist(), key=lambda k: -total[k])
            if len(np.unique(owner)) <= MOST_NUMBERS or odds[row] < least:
                break
            if kept != gone and total[gone] <= _SMALL * whole:
                owner[owner == gone] = kept
                total[kept] += total[gone]
    groups = np.unique(owner)
    large = groups[np.argsort(-total[groups], kind="stable")[:MOST_NUMBERS]]
    nearest = large[cKDTree(middles[large]).query(middles)[1]]
    return np.where(np.isin(owner, large), owner, nearest[owner])


def evidence(
    sets: Sequence[Candidate], named: Sequence[Candidate], sure: Sequence[float], areas: FloatArray
) -> tuple[FloatArray, IntArray]:
    """Log odds that an answer adds to sets of pieces, shape (c,), and the named set that each one is, else -1.

    Args:
        sets: Indices of pieces.
        named: Those that the answer names.
        sure: How sure it is of each, in [0, 1].
        areas: Of the pieces, shape (n,).
    """
    member, of_named = (
        np.array([[k in items for k in range(len(areas))] for items in group], dtype=np.float64).reshape(-1, len(areas))
        for group in (sets, named)
    )
    both = (member * areas) @ of_named.T
    share = both / (member @ areas[:, None] + of_named @ areas - both)
    best = share.argmax(axis=1)
    overlap = share.max(axis=1)
    added = np.where(overlap > _AGREES, _GAIN * (2.0 * overlap - 1.0) * np.asarray(sure)[best], -_LOSS)
    return added, np.where(overlap > 0.8, best, -1)
