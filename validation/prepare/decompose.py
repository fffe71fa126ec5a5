"""The collision geometry of a link as primitives and convex pieces, because engines see every mesh as its hull."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import igl
import numpy as np

from kinematify.assembly.weld import welded
from kinematify.validation.convex import ConvexPiece, convex_piece, reach, signed_volume
from kinematify.validation.prepare.prepared import Method

if TYPE_CHECKING:
    from kinematify.validation.declared import DeclaredLink, DeclaredShape
    from kinematify.validation.settings import PrepareSettings

_KEPT = ("box", "cylinder", "sphere")
_WELD = 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class Pieces:
    """What the engines collide for one link."""

    primitives: tuple[DeclaredShape, ...]
    convex: tuple[ConvexPiece, ...]
    """Link frame."""
    method: Method
    gap: float
    """How far the pieces reach beyond the declared surface at most [m]."""
    volume_error: float | None
    """Volume of the pieces over that of the declared meshes, less one; None where they enclose none."""


def decomposed(link: DeclaredLink, settings: PrepareSettings) -> Pieces:
    """Return the collision geometry of a link, or the visual one where it declares none."""
    shapes = link.collisions or link.visuals
    primitives = tuple(shape for shape in shapes if shape.kind in _KEPT)
    convex: list[ConvexPiece] = []
    gap, volume = 0.0, 0.0
    method = Method.PRIMITIVES if primitives else Method.NONE
    for shape in shapes:
        if shape.kind in _KEPT:
            continue
        vertices, faces = welded(shape.mesh.vertices, shape.mesh.faces, _WELD)
        diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
        piece = convex_piece(vertices, thickness=settings.thickness * diagonal, directions=settings.directions)
        tree = igl.AABB()
        tree.init(vertices, faces)
        here = reach(piece, tree, vertices, faces)
        method = Method.CONVEX if here < settings.convex_gap * diagonal else Method.HULL
        gap = max(gap, here)
        volume += max(signed_volume(vertices, faces), 0.0)
        convex.append(piece)
    error = sum(piece.volume for piece in convex) / volume - 1.0 if volume > 0.0 else None
    return Pieces(primitives=primitives, convex=tuple(convex), method=method, gap=gap, volume_error=error)
