"""Which part is the base link: the probability of every part, from what is measured of it, weighed by fitted weights.

No single question finds the base (feasibility.md 3): it is the end of an arm, the hub of a hand, the junction of legs,
the case of a drawer, the foot of a lamp. Part i of an object is its base with the probability
``exp(w . x_i) / sum_j exp(w . x_j)``; the fit (`benchmarks/fit/edge_fit.py`) made the true bases as likely as can be.
Only the vertical direction of the world is used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import shortest_path
from scipy.special import softmax

from kinematify.joints.choice.edges import shipped_weights

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from kinematify.contact.graph import Pair
    from kinematify.geometry.part_stats import PartStats
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray

BASE_WEIGHTS = "base.json"
COLUMNS = (
    "largest", "stands", "of_what_stands", "low", "twin", "encloses", "enclosed", "flat_above", "highest",
    "bears_what_hangs", "flat_in_the_air", "junction", "under_centre", "in_a_chain", "largest_and_highest",
)  # fmt: skip
"""What `base_columns` measures, each in [0, 1]."""
_LARGEST = 0.99  # congruent parts differ by rounding
_LOW = 0.05  # feet are uneven, and wheels reach below the chassis
"""Height above the lowest point, in diagonals of the object, from which on a part does not stand."""
_HIGH = 0.03
"""Depth below the highest point within which a part reaches it."""
_LIES = 0.1  # rings, and plates with feet, lie on little of their footprint
"""Nothing hangs where something lies on the ground with more than this share of its footprint."""
_DECADES = 2.0  # fingers are about 1 % of a palm
"""Powers of ten below the largest part at which a part has no bulk left."""
_CHAIN = 4
"""Edges in a row from which on they are a chain."""
_ASIDE = 0.02
"""How far the centre of mass may be beside the box of a part in plan that is under it, in diagonals."""


def base_probabilities(edges: Collection[Pair], stats: Sequence[PartStats], kind: IntArray) -> FloatArray:
    """Probability of every part to be the base link, shape (n,); arguments as in `base_columns`."""
    scores = shipped_weights(BASE_WEIGHTS, COLUMNS).scores(base_columns(edges, stats, kind))
    return np.asarray(np.round(softmax(scores), 9))  # alike parts are equal whatever the rounding


def base_columns(edges: Collection[Pair], stats: Sequence[PartStats], kind: IntArray) -> FloatArray:
    """Return what is measured of every part, shape (n, len(COLUMNS)).

    Args:
        edges: The undirected spanning tree.
        stats: Size and support of every part, world frame, z up.
        kind: Which parts are congruent, as of `contact.alike.AlikeParts`, shape (n,).
    """
    n = len(stats)
    bounds = np.array([item.bounds for item in stats])
    hulls = np.array([item.hull_volume for item in stats])
    centres = np.array([item.centroid for item in stats])
    above, bottoms = np.array([(item.flat_top, item.flat_bottom) for item in stats]).T
    lowest, highest = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    diagonal = float(np.linalg.norm(highest - lowest)) + 1e-12
    extents = np.ptp(bounds, axis=1) + 1e-9 * diagonal
    twin = np.bincount(kind, minlength=n)[kind] > 1

    low = np.clip(1.0 - (bounds[:, 0, 2] - lowest[2]) / (_LOW * diagonal), 0.0, 1.0)
    stands = low * bottoms
    foot = stands * extents[:, 0] * extents[:, 1]
    high = highest[2] - bounds[:, 1, 2] <= _HIGH * diagonal
    alone = high & (high.sum() == 1)
    largest = hulls >= _LARGEST * hulls.max()
    tops = np.where(np.eye(n, dtype=bool), -np.inf, bounds[:, 1, 2]).max(axis=1)
    in_the_air = stands.max() < _LIES

    common = np.minimum(bounds[:, None, 1], bounds[None, :, 1]) - np.maximum(bounds[:, None, 0], bounds[None, :, 0])
    inside = np.clip((common + 1e-9 * diagonal) / extents, 0.0, 1.0).prod(axis=2) * (1.0 - np.eye(n))
    ends = np.array([*edges], dtype=np.int64).reshape(-1, 2).T
    steps = shortest_path(
        csr_matrix((np.ones(len(ends[0])), tuple(ends)), shape=(n, n)), directed=False, unweighted=True
    )
    centre = np.average(centres, axis=0, weights=hulls)[:2]
    aside = np.maximum(bounds[:, 0, :2] - centre, centre - bounds[:, 1, :2])
    return np.column_stack(
        [
            largest,
            stands,
            foot / max(float(foot.sum()), 1e-9 * diagonal**2),
            low,
            twin,
            inside.sum(axis=1) / max(n - 1, 1),
            inside.max(axis=0),
            above,
            alone,
            above * (tops < centres[:, 2]) * in_the_air,
            bottoms * in_the_air * ~twin * np.clip(1.0 + np.log10(hulls / hulls.max()) / _DECADES, 0.0, 1.0),
            _junction(steps, twin & (kind == kind[bounds[:, 0, 2].argmin()])),
            np.linalg.norm(np.maximum(aside, 0.0), axis=1) < _ASIDE * diagonal,
            ((steps == 1).sum(axis=1) == 2) & (steps.max() >= _CHAIN),
            largest & alone,
        ]
    )


def _junction(steps: FloatArray, feet: BoolArray) -> FloatArray:
    """1 for the parts nearest to the farthest of the feet, then to all of them, if they are no feet; shape (n,)."""
    n = len(feet)
    if not feet.any():
        return np.zeros(n)
    reach = n * n * steps[:, feet].max(axis=1) + steps[:, feet].sum(axis=1)
    return np.asarray((reach == reach.min()) & ~feet, dtype=float)
