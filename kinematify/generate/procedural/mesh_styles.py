"""Meshes as they come from elsewhere: what a CAD program exports, remeshed, simplified, or not quite even."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.vectors import lengths_of

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.robot.arrays import FloatArray

STYLES = ("clean", "remeshed", "coarse", "bumpy")
"""As in ``--set style=``; clean is what a CAD program exports."""
_SHARE = 0.35  # of the clearance that a surface may move; two that face each other still stay apart
_TIGHTEST = 5e-4  # [m] small hinges are built tighter than what is asked for
_EDGES = 40.0  # edges along the diagonal of a remeshed part
_MAX_TRIANGLES = 20_000  # of a remeshed part
_WAVES = 12  # of the bumps


def styled(solid: Manifold, style: str, clearance: float, rng: np.random.Generator) -> Manifold:
    """Return a solid in a style.

    Args:
        solid: The clean one.
        style: Of `STYLES`.
        clearance: Gap between parts that move past each other [m].
        rng: Draws the bumps and the place of every vertex.
    """
    reach = _SHARE * min(clearance, _TIGHTEST)
    if style == "coarse":
        return solid.simplify(reach)
    if style == "clean":
        return solid
    fine = _refined(solid)
    if style == "remeshed":
        return fine
    waves = _waves(solid, rng)
    return fine.warp_batch(lambda points: points + reach * _bumps(np.asarray(points), waves))


def _refined(solid: Manifold) -> Manifold:
    """Split long edges, as far as the number of triangles allows."""
    lower, upper = np.array(solid.bounding_box()[:3]), np.array(solid.bounding_box()[3:])
    length = float(np.linalg.norm(upper - lower)) / _EDGES
    while True:
        fine = solid.refine_to_length(length)
        if fine.num_tri() <= max(_MAX_TRIANGLES, 2 * solid.num_tri()):
            return fine
        length *= 1.5


def _waves(solid: Manifold, rng: np.random.Generator) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Wave vectors [rad/m], (w, 3), phases, (w,), and directions, (w, 3), of a smooth field."""
    size = float(np.linalg.norm(np.subtract(solid.bounding_box()[3:], solid.bounding_box()[:3])))
    directions = rng.normal(size=(_WAVES, 3))
    directions /= lengths_of(directions)[:, None]
    lengths = size * rng.uniform(0.05, 0.25, size=_WAVES)
    vectors = rng.normal(size=(_WAVES, 3))
    vectors *= (2.0 * np.pi / lengths / lengths_of(vectors))[:, None]
    return vectors, rng.uniform(0.0, 2.0 * np.pi, size=_WAVES), directions


def _bumps(points: FloatArray, waves: tuple[FloatArray, FloatArray, FloatArray]) -> FloatArray:
    """A field of displacements of length 1 at most, (n, 3)."""
    vectors, phases, directions = waves
    field = np.sin(points @ vectors.T + phases) @ directions
    return field / max(float(lengths_of(field).max()), 1e-12)
