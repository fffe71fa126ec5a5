"""Convex pieces joined to fewer."""

from __future__ import annotations

import numpy as np

from kinematify.geometry.convex import ConvexPiece, convex_piece
from kinematify.model.collision_pieces import fewer_pieces


def cube(x: float, y: float = 0.0) -> ConvexPiece:
    corners = np.array([[x + a, y + b, c] for a in (0.0, 1.0) for b in (0.0, 1.0) for c in (0.0, 1.0)])
    return convex_piece(corners, thickness=1e-6, directions=64)


def test_neighbours_whose_hull_is_both_are_joined_first() -> None:
    row = [cube(0.0), cube(5.0, 7.0), cube(1.0), cube(2.0)]
    joined = fewer_pieces(row, 2, thickness=1e-6, corners=64)
    assert sorted(round(piece.volume, 6) for piece in joined) == [1.0, 3.0]
