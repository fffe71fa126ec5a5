"""Which parts of an object are alike: congruent or mirrored, by which motions, and whether their contacts are.

Whoever lets alike parts decide together asks here: bearings and joints of congruent contacts, trees, linkages, warnings
and hints. Everything is found once for a contact graph.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, permutations, product
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from kinematify.geometry.surface import FACETED

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import ContactConfig
    from kinematify.contact.tree import KinematicTree
    from kinematify.geometry.surface import PartSurface
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


_SAMPLES = 400  # spacing of 5 % of a part's size; a motion is exact to a tenth of that
"""Points per part that are laid upon each other."""
TOLERANCE = 0.045  # half as much again as for congruent parts: the samples are fewer
"""Largest mean distance between them, fraction of the smaller part's diagonal."""
_ROUGHLY = 0.1  # walls that represent solids are half a cell thicker on each side
"""Rough parts whose spreads along their principal axes differ by more are not alike, fraction of the largest."""
_REACH = 0.1  # contacts of rough meshes wander by a few percent of the part
"""Contacts that lie farther apart after the motion are not alike, fraction of the part's diagonal."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Outline:
    """Outside of one part, to be laid upon that of another one."""

    points: FloatArray
    """World frame [m], shape (n, 3)."""
    size: float
    """Diagonal of the part [m]."""
    rough: bool
    """Its surface is so rough that copies of it may differ inside."""

    @cached_property
    def spreads(self) -> FloatArray:
        """Standard deviations along the principal axes [m], ascending, shape (3,); NaN without points."""
        if not len(self.points):
            return np.full(3, np.nan)
        return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(self.points.T)), 0.0)))


def outline_of(surface: PartSurface) -> Outline:
    """The outside of a part."""
    points = surface.outline(_SAMPLES).points
    return Outline(points=points, size=surface.part.diagonal, rough=surface.roughness > FACETED)


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidMotion:
    """x -> turn x + shift, in the world frame."""

    turn: FloatArray
    """Orthogonal, of determinant 1 or -1, shape (3, 3)."""
    shift: FloatArray
    """[m], shape (3,)."""

    def points(self, points: FloatArray) -> FloatArray:
        """Where points go, shape (n, 3) or (3,)."""
        return points @ self.turn.T + self.shift

    def directions(self, directions: FloatArray) -> FloatArray:
        """Where directions go, shape (n, 3) or (3,)."""
        return directions @ self.turn.T

    @property
    def inverse(self) -> RigidMotion:
        """The way back."""
        return RigidMotion(turn=self.turn.T, shift=-self.turn.T @ self.shift)


class AlikeParts:
    """Parts that are alike, and the motions between them, each found when first asked for."""

    def __init__(self, n_parts: int, clusters: Sequence[Sequence[int]], outlines: Sequence[Outline] = ()) -> None:
        """Keep what is known.

        Args:
            n_parts: Number of parts.
            clusters: Groups of congruent parts, each ascending.
            outlines: Of every part; motions need them.
        """
        self.kind = np.arange(n_parts)
        """The first of all parts that are congruent with each one, shape (n,)."""
        for cluster in clusters:
            self.kind[list(cluster)] = cluster[0]
        self._outlines = outlines
        self._motions: dict[tuple[int, int], list[RigidMotion]] = {}

    def others(self, part: int) -> tuple[int, ...]:
        """Parts that are congruent with a part, without itself."""
        return tuple(other for other in np.flatnonzero(self.kind == self.kind[part]).tolist() if other != part)

    def edges(self, tree: KinematicTree) -> list[list[tuple[int, int]]]:
        """All edges (parent, child) in groups whose children are congruent, and on one parent or on congruent ones.

        Args:
            tree: Parent of every part.
        """
        groups: dict[tuple[int, ...], list[tuple[int, int]]] = {}
        for edge in tree.edges():
            groups.setdefault(tuple(self.kind[list(edge)].tolist()), []).append(edge)
        return list(groups.values())

    @cached_property
    def roughly(self) -> IntArray:
        """One number for all parts that are congruent, or nearly so where they are rough, shape (n,).

        Remeshing makes a wall of one copy of a part and a solid of the other one. Whether they are alike shows when
        they are laid upon each other; here, only their outer size counts.
        """
        found = self.kind.copy()
        for a, b in combinations([part for part, outline in enumerate(self._outlines) if outline.rough], 2):
            one, other = self._outlines[a].spreads, self._outlines[b].spreads
            if np.abs(one - other).max() <= _ROUGHLY * max(one[2], other[2]):
                found[found == found[b]] = found[a]
        return found

    def motions(self, first: int, second: int) -> list[RigidMotion]:
        """Motions from one part onto another one, the closest first; none from a part onto itself."""
        if first == second:
            return []
        if (first, second) not in self._motions:
            one, other = self._outlines[first], self._outlines[second]
            found = []
            if min(len(one.points), len(other.points)):
                found = motions_between(one.points, other.points, tolerance=TOLERANCE * min(one.size, other.size))
            self._motions[first, second] = found
        return self._motions[first, second]

    def contact_motions(
        self, here: tuple[int, int], there: tuple[int, int], centres: tuple[FloatArray, FloatArray]
    ) -> list[tuple[float, RigidMotion]]:
        """Motions that take a contact to another one and one of its parts to its like, with how far both stay apart.

        Args:
            here: The two parts.
            there: Their likes, in the same order.
            centres: Of both contacts [m], shape (3,) each; NaN where there is none.

        Returns:
            Mean distance of both parts from their likes [m] and motion, the closest first.
        """
        source, target = (np.concatenate([self._outlines[part].points for part in parts]) for parts in (here, there))
        tree, found = cKDTree(target), []
        for part, like in zip(here, there, strict=True):
            for motion in self.motions(part, like):
                if not np.linalg.norm(motion.points(centres[0]) - centres[1]) > _REACH * self._outlines[part].size:
                    found.append((float(tree.query(motion.points(source))[0].mean()), motion))
        return sorted(found, key=lambda item: item[0])


_START = 3.0  # times the distance that is asked for: principal axes of rough twins are some degrees off
_ROUNDS = 10  # of matching nearest points; converged to a tenth of the spacing of the points
_SAME = np.cos(np.radians(5.0))  # nearly equal motions are one
_ALIGNMENTS = tuple(product(permutations(range(3)), product((1.0, -1.0), repeat=3)))
"""Orders and signs in which principal axes may be laid upon each other."""


def motions_between(first: FloatArray, second: FloatArray, *, tolerance: float) -> list[RigidMotion]:
    """Every motion that lays one cloud upon another one, the closest first.

    The principal axes are laid upon each other in all orders and signs; matching nearest points finishes each that is
    close. Shapes with symmetries of their own have several answers.

    Args:
        first: Points all over one part, world frame [m], shape (n, 3).
        second: Points all over the other one [m], shape (m, 3).
        tolerance: Largest mean distance of the moved points from the nearest others [m].
    """
    tree = cKDTree(second)
    found: list[tuple[float, RigidMotion]] = []
    for start in _starts(first, second):
        motion, distance = matched(first, second, tree, start, tolerance)
        if distance <= tolerance:
            found.append((distance, motion))
    kept: list[RigidMotion] = []
    for _, motion in sorted(found, key=lambda item: item[0]):
        if all(_agreement(motion, other) < _SAME for other in kept):
            kept.append(motion)
    return kept


def _starts(first: FloatArray, second: FloatArray) -> Iterator[RigidMotion]:
    middles = first.mean(axis=0), second.mean(axis=0)
    axes = [_principal_axes(cloud - middle) for cloud, middle in zip((first, second), middles, strict=True)]
    for order, signs in _ALIGNMENTS:
        turn = (axes[1][:, order] * signs) @ axes[0].T
        yield RigidMotion(turn=turn, shift=middles[1] - turn @ middles[0])


def matched(
    first: FloatArray, second: FloatArray, tree: cKDTree, motion: RigidMotion, tolerance: float
) -> tuple[RigidMotion, float]:
    """Match nearest points until they stay, mirrored or not as at the start; and their mean distance [m].

    A round brings less than the one before it: what does not come within the tolerance [m] like that is given up.
    """
    sign, one, found, before = np.sign(np.linalg.det(motion.turn)), first.mean(axis=0), np.empty(0), _START * tolerance
    for rounds in range(_ROUNDS, 0, -1):
        distances, index = tree.query(motion.points(first))
        apart = float(distances.mean())
        # The same points give the same motion again.
        if np.array_equal(index, found) or apart - rounds * (before - apart) > tolerance:
            return motion, apart
        before = apart
        found, nearest, other = index, second[index], second[index].mean(axis=0)
        left, _, right = np.linalg.svd((nearest - other).T @ (first - one))
        flip = np.array([1.0, 1.0, sign * np.sign(np.linalg.det(left @ right))])
        turn = (left * flip) @ right
        motion = RigidMotion(turn=turn, shift=other - turn @ one)
    return motion, apart


def _agreement(one: RigidMotion, other: RigidMotion) -> float:
    """Cosine of the angle between two motions; -1 where only one of them mirrors."""
    if np.linalg.det(one.turn) * np.linalg.det(other.turn) < 0:
        return -1.0
    return float(np.clip((np.trace(one.turn.T @ other.turn) - 1.0) / 2.0, -1.0, 1.0))


# ---- clusters of congruent parts ------------------------------------------------------------------------------------


_PROFILE_QUANTILES = np.linspace(0.02, 0.98, 9)
_ROUGH = 1.5
"""More of the tolerance for rough parts in the test by size: voxels of a tenth of a finger change it."""
_AREAS = (0.04, 0.18)
"""Most difference of areas of congruent parts, as a share; of rough ones. Base and lid of a laptop differ by .07."""


def find_clusters(
    assembly: Assembly, surfaces: Sequence[PartSurface], *, config: ContactConfig, seed: int
) -> tuple[tuple[int, ...], ...]:
    """Group congruent parts.

    Args:
        assembly: The parts.
        surfaces: Derived geometry of each part, same order.
        config: `cluster_samples` points per part, `cluster_tolerance` as a fraction of the part's diagonal.
        seed: Seed of the samples.

    Returns:
        Groups of two or more part indices, each ascending, ordered by their first member.
    """
    shapes = [_centred_samples(surface, config.cluster_samples, seed) for surface in surfaces]
    prints = np.array([_fingerprint(points) for points in shapes])
    areas = np.array([surface.part.area for surface in surfaces])
    sizes = np.array([np.linalg.norm(points, axis=1).max() for points in shapes])
    rough = np.array([surface.roughness > FACETED for surface in surfaces])
    alike = _alike(prints, areas, sizes, config.cluster_tolerance, rough[:, None] | rough)
    labels = np.arange(len(surfaces))
    for a, b in zip(*np.nonzero(np.triu(alike, k=1)), strict=True):
        limit = config.cluster_tolerance * 2 * max(sizes[a], sizes[b])
        # Only the groups matter: what others have joined already needs no comparison of its own.
        if labels[a] != labels[b] and aligned_chamfer(shapes[a], shapes[b], enough=limit) <= limit:
            labels[labels == labels[b]] = labels[a]
    groups = [tuple(np.flatnonzero(labels == label).tolist()) for label in np.unique(labels)]
    return tuple(sorted(group for group in groups if len(group) > 1))


def aligned_chamfer(first: FloatArray, second: FloatArray, *, enough: float = 0.0) -> float:
    """Mean nearest-neighbour distance [m], both ways, of two centred clouds after the best alignment of their axes.

    Principal axes are tried with all signs and, since equal spreads leave their order open, all orders, so mirrored
    twins match. Clouds of shape (n, 3) and (m, 3). The first alignment that is at most `enough` apart ends the search.
    """
    one, other = first @ _principal_axes(first), second @ _principal_axes(second)
    tree_of_one, tree_of_other = cKDTree(one), cKDTree(other)
    best = np.inf
    for order, signs in _ALIGNMENTS:
        there = float(tree_of_one.query(other[:, order] * signs)[0].mean())
        if there < 2 * best:  # the way back can halve the mean at best
            back = float(tree_of_other.query((one * signs)[:, np.argsort(order)])[0].mean())
            best = min(best, 0.5 * (there + back))
            if best <= enough:
                return best
    return best


def _centred_samples(surface: PartSurface, count: int, seed: int) -> FloatArray:
    points = surface.sample(count, seed=seed).points
    return points - surface.part.centroid if len(points) else np.zeros((1, 3))


def _fingerprint(points: FloatArray) -> FloatArray:
    """Quantiles of the distance from the centroid and the principal spreads [m], shape (12,)."""
    radii = np.quantile(np.linalg.norm(points, axis=1), _PROFILE_QUANTILES)
    spreads = np.sqrt(np.maximum(np.linalg.eigvalsh(points.T @ points / len(points)), 0))
    return np.concatenate([radii, spreads])


def _alike(prints: FloatArray, areas: FloatArray, sizes: FloatArray, tolerance: float, rough: BoolArray) -> BoolArray:
    """Matrix of pairs that may be congruent within a tolerance; `rough` where one of a pair is; all of shape (n, n)."""
    scale = _ROUGH**rough * np.maximum(sizes[:, None], sizes)
    difference = np.abs(prints[:, None] - prints).max(axis=2)
    least = (1 - np.where(rough, _AREAS[1], _AREAS[0])) * np.maximum(areas[:, None], areas)
    return np.asarray((difference <= 2.5 * tolerance * scale) & (np.minimum(areas[:, None], areas) > least))


def _principal_axes(points: FloatArray) -> FloatArray:
    return np.linalg.eigh(points.T @ points)[1]
