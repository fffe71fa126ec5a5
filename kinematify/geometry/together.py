"""Several joints at once: quasi-random configurations of all of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.sampling import spread_rows
from kinematify.geometry.scene import relative

if TYPE_CHECKING:
    from kinematify.geometry.overlap import OverlapQueries
    from kinematify.geometry.rest_pairs import DepthAllowance
    from kinematify.geometry.scene import Pair, Scene
    from kinematify.robot.arrays import BoolArray, FloatArray


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
    """Spread configurations in the box of all ranges, shape (n, leaders)."""
    travels = scene.travels
    low, high = np.array([t.lower for t in travels]), np.array([t.upper for t in travels])
    return spread_rows(low, high, scene.settings.random_rows, seed)


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
