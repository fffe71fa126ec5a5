"""Several joints at once: quasi-random configurations of all of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.scene import relative

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.geometry.overlap import OverlapQueries
    from kinematify.geometry.rest_pairs import DepthAllowance
    from kinematify.geometry.scene import Pair, Scene
    from kinematify.robot.arrays import BoolArray, FloatArray

    Bits = NDArray[np.uint32]


@dataclass(frozen=True, kw_only=True, eq=False)
class JudgedConfigurations:
    """Contacts of some configurations."""

    rows: FloatArray
    """Values of the leaders [rad or m], shape (n, leaders)."""
    touching: BoolArray
    """Surfaces meet, shape (n, pairs of the scene); False for neighbours."""
    meeting: BoolArray
    """They meet although they do not touch at rest, or are deeper than they may be, shape (n, pairs)."""


def random_rows(scene: Scene, seed: int) -> FloatArray:
    """Sobol points in the box of all ranges, shape (n, leaders)."""
    travels = scene.travels
    low, high = np.array([t.lower for t in travels]), np.array([t.upper for t in travels])
    return np.asarray(low + sobol(scene.settings.random_rows, len(travels), seed) * (high - low))


def looked_at(
    scene: Scene, overlap: OverlapQueries, allowance: DepthAllowance, rows: FloatArray
) -> JudgedConfigurations:
    """Ask about every pair in every row but neighbours, which the sweeps of their joints judge."""
    poses = scene.poses(rows)
    touching = np.zeros((len(rows), len(scene.pairs)), dtype=bool)
    meeting = np.zeros_like(touching)
    for column, pair in enumerate(scene.pairs):
        if allowance.joined(pair):
            continue
        T = relative(poses, pair)
        touching[:, column] = overlap.collide(pair, T)
        meeting[:, column] = _beyond(overlap, allowance, pair, T, touching[:, column])
    return JudgedConfigurations(rows=rows, touching=touching, meeting=meeting)


def _beyond(overlap: OverlapQueries, allowance: DepthAllowance, pair: Pair, T: FloatArray, hit: BoolArray) -> BoolArray:
    """Which of the hits go beyond what the pair may."""
    found = np.zeros(len(T), dtype=bool)
    rest = allowance.pairs.get(pair)
    if rest is None or not rest.collide:
        return hit
    if hit.any():
        found[hit] = overlap.depth(pair, T[hit]) > rest.depth + allowance.tolerance(pair)
    return found


_BITS = 30

# fmt: off
_DIRECTIONS: tuple[tuple[int, tuple[int, ...]], ...] = (
    (3, (1,)), (7, (1, 3)), (11, (1, 3, 1)), (13, (1, 1, 1)), (19, (1, 1, 3, 3)), (25, (1, 3, 5, 13)),
    (37, (1, 1, 5, 5, 17)), (41, (1, 1, 5, 5, 5)), (47, (1, 1, 7, 11, 19)), (55, (1, 1, 5, 1, 1)),
    (59, (1, 1, 1, 3, 11)), (61, (1, 3, 5, 5, 31)), (67, (1, 3, 3, 9, 7, 49)), (91, (1, 1, 1, 15, 21, 21)),
    (97, (1, 3, 1, 13, 27, 49)), (103, (1, 1, 1, 15, 7, 5)), (109, (1, 3, 1, 15, 13, 25)),
    (115, (1, 1, 5, 5, 19, 61)), (131, (1, 3, 7, 11, 23, 15, 103)), (137, (1, 3, 7, 13, 13, 15, 69)),
    (143, (1, 1, 3, 13, 7, 35, 63)), (145, (1, 3, 5, 9, 1, 25, 53)), (157, (1, 3, 1, 13, 9, 35, 107)),
    (167, (1, 3, 1, 5, 27, 61, 31)), (171, (1, 1, 5, 11, 19, 41, 61)), (185, (1, 3, 5, 3, 3, 13, 69)),
    (191, (1, 1, 7, 13, 1, 19, 1)), (193, (1, 3, 7, 5, 13, 19, 59)), (203, (1, 1, 3, 9, 25, 29, 41)),
    (211, (1, 3, 5, 13, 23, 1, 55)), (213, (1, 3, 7, 3, 13, 59, 17)), (229, (1, 3, 1, 3, 5, 53, 69)),
    (239, (1, 1, 5, 5, 23, 33, 13)), (241, (1, 1, 7, 7, 1, 61, 123)), (247, (1, 1, 7, 9, 13, 61, 49)),
    (253, (1, 3, 3, 5, 3, 55, 33)), (285, (1, 3, 1, 15, 31, 13, 49, 245)), (299, (1, 3, 5, 15, 31, 59, 63, 97)),
    (301, (1, 3, 1, 11, 11, 11, 77, 249)), (333, (1, 3, 1, 11, 27, 43, 71, 9)), (351, (1, 1, 7, 15, 21, 11, 81, 45)),
    (355, (1, 3, 7, 3, 25, 31, 65, 79)), (357, (1, 3, 1, 1, 19, 11, 3, 205)), (361, (1, 1, 5, 9, 19, 21, 29, 157)),
    (369, (1, 3, 7, 11, 1, 33, 89, 185)), (391, (1, 3, 3, 3, 15, 9, 79, 71)), (397, (1, 3, 7, 11, 15, 39, 119, 27)),
)
# fmt: on
"""Primitive polynomial (its bits) and initial direction numbers of each dimension after the first: the first of Joe and
Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30 (2008)."""


def sobol(count: int, dimensions: int, seed: int) -> FloatArray:
    """Draw points in the unit cube, scrambled by random lower triangular matrices and a random shift.

    They are those of `scipy.stats.qmc.Sobol`, whose import takes as long as all else that the geometric checks import.

    Args:
        count: A power of two keeps them balanced.
        dimensions: Coordinates of each.
        seed: Of the scrambling.

    Returns:
        Shape (count, dimensions).
    """
    if dimensions > len(_DIRECTIONS) + 1:
        from scipy.stats import qmc  # noqa: PLC0415  # it knows thousands of dimensions

        return np.asarray(qmc.Sobol(dimensions, rng=seed).random(count))
    random = np.random.default_rng(seed).spawn(1)[0]
    powers = 1 << np.arange(_BITS, dtype=np.uint32)
    shift = random.integers(2, size=(dimensions, _BITS), dtype=np.uint32) @ powers
    mixing = np.tril(random.integers(2, size=(dimensions, _BITS, _BITS), dtype=np.uint32), -1)
    mixing += np.eye(_BITS, dtype=np.uint32)
    # Binary digits of the direction numbers, the highest first: (dimensions, digit, number).
    digits = (_direction_numbers(dimensions)[:, None, :] >> np.arange(_BITS)[::-1, None]) & 1
    directions = np.einsum("dqn,q->dn", mixing @ digits.astype(np.uint32) & 1, powers[::-1])
    # Neighbours in the order of a Gray code differ by the direction number of the lowest zero of the index.
    index = np.arange(count - 1)
    lowest_zero = np.log2(~index & (index + 1)).astype(np.int64)
    steps = np.concatenate([shift[:, None], directions[:, lowest_zero]], axis=1)
    return np.asarray(np.bitwise_xor.accumulate(steps, axis=1).T * 2.0**-_BITS)


def _direction_numbers(dimensions: int) -> Bits:
    """Unscrambled direction numbers as fractions of 2^30, shape (dimensions, 30)."""
    rows = [[1] * _BITS]
    for polynomial, initial in _DIRECTIONS[: dimensions - 1]:
        numbers, degree = list(initial), len(initial)
        for k in range(degree, _BITS):
            new = numbers[k - degree]
            for back in range(1, degree + 1):
                if polynomial >> (degree - back) & 1:
                    new ^= numbers[k - back] << back
            numbers.append(new)
        rows.append(numbers)
    return np.array(rows, dtype=np.uint32) << np.arange(_BITS, dtype=np.uint32)[::-1]
