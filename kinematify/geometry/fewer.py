"""Fewer convex pieces: those are joined whose common hull adds least."""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.convex import ConvexPiece, convex_piece
from kinematify.robot.vectors import lengths_of

if TYPE_CHECKING:
    from collections.abc import Sequence

_NEIGHBOURS = 8
"""Nearest pieces that one is tried with."""


def fewer_pieces(pieces: Sequence[ConvexPiece], most: int, *, thickness: float, corners: int) -> list[ConvexPiece]:
    """Join pieces until there are at most so many, two by two, those first whose hull is least larger than both.

    Args:
        pieces: Any number.
        most: At least 1.
        thickness: Of flat pieces [m].
        corners: Vertices of a piece at most.
    """
    alive = dict(enumerate(pieces))
    waiting: list[tuple[float, int, int, ConvexPiece]] = []

    def offer(number: int) -> None:
        one = alive[number]
        others = [other for other in alive if other != number]
        middles = np.array([alive[other].low + alive[other].high for other in others])
        for place in np.argsort(lengths_of(middles - one.low - one.high), kind="stable")[:_NEIGHBOURS]:
            other = alive[others[place]]
            points = np.concatenate([one.vertices, other.vertices])
            hull = convex_piece(points, thickness=thickness, directions=corners)
            heapq.heappush(waiting, (hull.volume - one.volume - other.volume, number, others[place], hull))

    if len(alive) > most:
        for number in list(alive):
            offer(number)
    following = len(alive)
    while len(alive) > most:
        _, first, second, hull = heapq.heappop(waiting)
        if first in alive and second in alive:
            del alive[first], alive[second]
            alive[following] = hull
            if len(alive) > most:
                offer(following)
            following += 1
    return list(alive.values())
