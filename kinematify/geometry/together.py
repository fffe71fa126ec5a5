"""Several joints at once: every pair of joints that can meet, and quasi-random configurations of all of them."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from itertools import combinations, product
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.scene import relative
from kinematify.geometry.sobol import sobol

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from kinematify.geometry.overlap import Overlap
    from kinematify.geometry.rest import Allowance
    from kinematify.geometry.scene import Pair, Scene
    from kinematify.robot.arrays import FloatArray

    BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True, eq=False)
class Configurations:
    """What meets in some configurations."""

    rows: FloatArray
    """Values of the leaders [rad or m], shape (n, leaders)."""
    touching: BoolArray
    """Surfaces meet, shape (n, pairs of the scene); False for neighbours."""
    meeting: BoolArray
    """They meet although they do not touch at rest, or are deeper than they may be, shape (n, pairs)."""


@dataclass(frozen=True, kw_only=True)
class JointPair:
    """Two joints that bring bodies together which neither of them brings together alone."""

    leaders: tuple[int, int]
    pair: Pair
    share: float
    """Share of the combinations of their values in which the bodies meet."""
    values: tuple[float, float]
    """One of these combinations [rad or m]."""


def random_rows(scene: Scene, seed: int) -> FloatArray:
    """Sobol points in the box of all ranges, shape (n, leaders)."""
    travels = scene.travels
    low, high = np.array([t.lower for t in travels]), np.array([t.upper for t in travels])
    return np.asarray(low + sobol(scene.settings.random_rows, len(travels), seed) * (high - low))


def looked_at(scene: Scene, overlap: Overlap, allowance: Allowance, rows: FloatArray) -> Configurations:
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
    return Configurations(rows=rows, touching=touching, meeting=meeting)


def _beyond(overlap: Overlap, allowance: Allowance, pair: Pair, T: FloatArray, hit: BoolArray) -> BoolArray:
    """Which of the hits go beyond what the pair may."""
    found = np.zeros(len(T), dtype=bool)
    rest = allowance.pairs.get(pair)
    if rest is None or not rest.collide:
        return hit
    if hit.any():
        found[hit] = overlap.depth(pair, T[hit]) > rest.depth + allowance.tolerance(pair)
    return found


def joint_pairs(
    scene: Scene, overlap: Overlap, allowance: Allowance, alone: Sequence[frozenset[Pair]], go_on: Callable[[], bool]
) -> tuple[list[JointPair], int]:
    """Move every two joints together whose bodies come near each other.

    Args:
        scene: The bodies.
        overlap: Asked about collisions.
        allowance: What touches at rest.
        alone: For every leader the pairs that meet when it moves alone; they are no news.
        go_on: False when time is up.

    Returns:
        What meets, and how many pairs of joints could not be looked at.
    """
    of_pair = {pair: scene.between(pair) for pair in scene.pairs if not allowance.joined(pair)}
    wanted = defaultdict(list)
    for pair, leaders in of_pair.items():
        for two in combinations(sorted(leaders), 2):
            if pair not in alone[two[0]] | alone[two[1]]:
                wanted[two].append(pair)
    steps = scene.settings.pair_steps
    left = max(0, len(wanted) - scene.settings.pair_rows // steps**2)
    found: list[JointPair] = []
    for done, (two, pairs) in enumerate(sorted(wanted.items())[: len(wanted) - left]):
        if not go_on():
            return found, len(wanted) - done
        found += _together(scene, overlap, allowance, two, pairs)
    return found, left


def _together(
    scene: Scene, overlap: Overlap, allowance: Allowance, two: tuple[int, int], pairs: Sequence[Pair]
) -> list[JointPair]:
    steps = scene.settings.pair_steps
    values = [np.linspace(scene.travels[k].lower, scene.travels[k].upper, steps) for k in two]
    grid = np.array(list(product(*values)))
    rows = np.tile(scene.mechanism.rest, (len(grid), 1))
    rows[:, list(two)] = grid
    poses = scene.poses(rows)
    found = []
    for pair in pairs:
        T = relative(poses, pair)
        hit = _beyond(overlap, allowance, pair, T, overlap.collide(pair, T))
        if hit.any():
            low, high = grid[int(np.argmax(hit))].tolist()
            found.append(JointPair(leaders=two, pair=pair, share=float(hit.mean()), values=(low, high)))
    return found
