"""Contacts of congruent parts share their bearing: what one limb hides, another one shows (paper III-D, symmetry).

The knees of a humanoid are one design, so their bearings lie alike in the legs. Where the mesh of one knee is too
rough to tell, lines of chance win; they differ from knee to knee, and the true one does not. Every line of a contact
is therefore carried over to its twins, along the motion that lays one limb upon the other, and weighed there as well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations, permutations, product
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from kinematify.geometry.surface import FACETED
from kinematify.joints.bearings.bearing_evidence import contact_centroid, thin
from kinematify.joints.bearings.line import Line
from kinematify.joints.bearings.refine_lines import refine_line
from kinematify.joints.bearings.scores import BearingLine, EdgeBearing, best_distinct, scored_line

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config import BearingConfig
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.geometry.surface import PartSurface
    from kinematify.joints.bearings.bearing_evidence import Sides
    from kinematify.robot.arrays import FloatArray, IntArray


def shared_by_twins(
    bearings: Mapping[Pair, EdgeBearing],
    sides: Mapping[Pair, Sides],
    surfaces: Sequence[PartSurface],
    graph: ContactGraph,
    *,
    diagonal: float,
    config: BearingConfig,
) -> dict[Pair, EdgeBearing]:
    """Rank the lines of every contact that has twins by what all of them show.

    Clean parts are left alone where every contact of a group has a clear bearing, or none: there is nothing to learn.

    Args:
        bearings: What every contact shows by itself.
        sides: Evidence of the contacts, as it was fitted.
        surfaces: Derived geometry of each part.
        graph: Contacts and clusters of congruent parts.
        diagonal: Of the assembly [m].
        config: `twins` and the tolerances.

    Returns:
        The bearings of all contacts. Those whose best line is now another one say so in `follows`.
    """
    result = dict(bearings)
    shapes = _Shapes(surfaces, config)
    labels = _labels(graph, surfaces, shapes)
    for group in _groups(graph, labels):
        if not _to_learn(group, bearings, surfaces, config):
            continue
        voters = {
            pair: _Voter(bearings[pair], sides[pair], diagonal, config.for_roughness(_roughness(surfaces, pair)))
            for pair in group
        }
        for pair in group:
            twins = _twins_of(pair, group, voters, labels, shapes)
            if twins:
                result[pair] = _voted(voters[pair], twins, diagonal, config)
    return result


def _labels(graph: ContactGraph, surfaces: Sequence[PartSurface], shapes: _Shapes) -> IntArray:
    """One number for all parts that are congruent, or nearly so where they are rough, shape (n,).

    Remeshing makes a wall of one copy of a part and a solid of the other one. Whether they are twins shows when they
    are laid upon each other; here, only their outer size counts.
    """
    joined = [(cluster[0], part) for cluster in graph.clusters for part in cluster[1:]]
    rough = [part for part, surface in enumerate(surfaces) if surface.roughness > FACETED]
    joined += [(a, b) for a, b in combinations(rough, 2) if shapes.alike(a, b)]
    rows, columns = np.array(joined, dtype=np.int64).reshape(-1, 2).T
    links = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(graph.n_parts, graph.n_parts))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def _groups(graph: ContactGraph, labels: IntArray) -> list[tuple[Pair, ...]]:
    """Contacts whose parts are congruent, or the same on one side; two or more."""
    kinds: dict[Pair, list[Pair]] = {}
    for a, b in sorted(graph.by_pair):
        low, high = sorted((int(labels[a]), int(labels[b])))
        kinds.setdefault((low, high), []).append((a, b))
    return [tuple(pairs) for pairs in kinds.values() if len(pairs) > 1]


def _to_learn(
    group: Sequence[Pair],
    bearings: Mapping[Pair, EdgeBearing],
    surfaces: Sequence[PartSurface],
    config: BearingConfig,
) -> bool:
    clear = [_best_score(bearings[pair]) >= config.twins.clear for pair in group]
    rough = any(_roughness(surfaces, pair) > config.rough_from for pair in group)
    return rough or (any(clear) and not all(clear))


def _roughness(surfaces: Sequence[PartSurface], pair: Pair) -> float:
    """Roughness of the rougher part of a contact [deg]."""
    return max(surfaces[part].roughness for part in pair)


def _best_score(bearing: EdgeBearing) -> float:
    return bearing.lines[0].score if bearing.lines else 0.0


# ---- which motion lays one contact upon another one ------------------------------------------------------------------


class _Shapes:
    """Samples of the parts and the motions between congruent ones, each found once."""

    def __init__(self, surfaces: Sequence[PartSurface], config: BearingConfig) -> None:
        self._surfaces = surfaces
        self._config = config.twins
        self._clouds: dict[int, FloatArray] = {}
        self._motions: dict[Pair, list[RigidMotion]] = {}
        self.most = config.twins.most
        self.reach = config.twins.reach

    def cloud(self, part: int) -> FloatArray:
        """Points all over a part [m], shape (n, 3)."""
        if part not in self._clouds:
            self._clouds[part] = self._surfaces[part].outline(self._config.samples).points
        return self._clouds[part]

    def alike(self, first: int, second: int) -> bool:
        """True if two parts have about the same outer size and shape, however they are turned."""
        if not all(len(self.cloud(part)) for part in (first, second)):
            return False
        one, other = (_spreads(self.cloud(part)) for part in (first, second))
        return bool(np.abs(one - other).max() <= self._config.alike * max(one[2], other[2]))

    def size(self, part: int) -> float:
        return self._surfaces[part].part.diagonal

    def motions(self, first: int, second: int) -> list[RigidMotion]:
        """Motions from one part onto a congruent one, the closest first; none from a part onto itself."""
        if first == second:
            return []
        if (first, second) not in self._motions:
            clouds = self.cloud(first), self.cloud(second)
            tolerance = self._config.tolerance * min(self.size(first), self.size(second))
            found = motions_between(*clouds, tolerance=tolerance) if min(len(c) for c in clouds) else []
            self._motions[first, second] = found
        return self._motions[first, second]


def _spreads(cloud: FloatArray) -> FloatArray:
    """Standard deviations along the principal axes [m], ascending, shape (3,)."""
    return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(cloud.T)), 0.0)))


@dataclass(frozen=True, kw_only=True, eq=False)
class _Twin:
    """Another contact and how lines get there."""

    voter: _Voter
    motion: RigidMotion
    swapped: bool
    """The first part of one contact is congruent to the second of the other one."""


def _twins_of(
    pair: Pair, group: Sequence[Pair], voters: Mapping[Pair, _Voter], labels: IntArray, shapes: _Shapes
) -> list[_Twin]:
    """The contacts of a group that a motion of congruent parts lays upon this one: the nearest are asked."""
    here = voters[pair]

    def nearness(other: Pair) -> tuple[float, ...]:
        # Rounded, so that the clearest of equally near ones is asked, whatever the order of the parts.
        apart = float(np.linalg.norm(voters[other].centroid - here.centroid)) / shapes.size(pair[0])
        return round(apart, 3), -round(_best_score(voters[other].bearing), 6), float(voters[other].centroid[2])

    twins = []
    for other in sorted((other for other in group if other != pair), key=nearness)[: shapes.most]:
        found = _best_motion(pair, other, voters, labels, shapes)
        if found is not None:
            twins.append(_Twin(voter=voters[other], motion=found[0], swapped=found[1]))
    return twins


def _best_motion(
    pair: Pair, other: Pair, voters: Mapping[Pair, _Voter], labels: IntArray, shapes: _Shapes
) -> tuple[RigidMotion, bool] | None:
    """The motion that takes contact to contact and brings both parts closest to their twins, and whether it swaps."""
    best: tuple[float, RigidMotion, bool] | None = None
    for swapped in (False, True):
        there = other[::-1] if swapped else other
        if any(labels[a] != labels[b] for a, b in zip(pair, there, strict=True)):
            continue
        target = np.concatenate([shapes.cloud(part) for part in there])
        source = np.concatenate([shapes.cloud(part) for part in pair])
        tree = cKDTree(target)
        for part, twin in zip(pair, there, strict=True):
            for motion in shapes.motions(part, twin):
                miss = np.linalg.norm(motion.points(voters[pair].centroid) - voters[other].centroid)
                if miss > shapes.reach * shapes.size(part):
                    continue
                apart = float(tree.query(motion.points(source))[0].mean())
                if best is None or apart < best[0]:
                    best = apart, motion, swapped
    return None if best is None else (best[1], best[2])


# ---- the vote --------------------------------------------------------------------------------------------------------


class _Voter:
    """One contact: its own lines, and what it says of those of others."""

    def __init__(self, bearing: EdgeBearing, sides: Sides, diagonal: float, config: BearingConfig) -> None:
        self.bearing = bearing
        self.centroid = contact_centroid(sides)
        self._sides = thin(sides[0], config.refine_samples), thin(sides[1], config.refine_samples)
        self._diagonal = diagonal
        self._config = config

    def opinion(self, line: Line) -> BearingLine:
        """Return what is known of a line, or of one next to it: motions are less exact than bearings."""
        for own in self.bearing.lines:
            if self._near(own.line, line, 1.0):
                return own
        if not all(len(side.weights) for side in self._sides):
            return scored_line(self._sides, line, self.centroid, self._diagonal, self._config)
        moved = refine_line(self._sides, line, self._tolerances, self._config)
        chosen = moved if self._near(moved, line, self._config.twins.slack) else line
        return scored_line(self._sides, chosen, self.centroid, self._diagonal, self._config)

    @property
    def _tolerances(self) -> FloatArray:
        return np.full(2, self._config.normal_tolerance_sine)

    def _near(self, one: Line, other: Line, slack: float) -> bool:
        cosine = np.cos(np.radians(slack * self._config.apart_angle))
        offset = one.foot(self.centroid) - other.foot(self.centroid)
        close = float(np.linalg.norm(offset)) < slack * self._config.apart * self._diagonal
        return bool(abs(float(one.axis @ other.axis)) > cosine and close)


def _voted(voter: _Voter, twins: Sequence[_Twin], diagonal: float, config: BearingConfig) -> EdgeBearing:
    """The lines of a contact and of its twins, each with the mean of what all of them say of it."""
    own = voter.bearing
    lines = [_carried(line, twin.motion.inverse, voter.centroid) for twin in twins for line in twin.voter.bearing.lines]
    candidates = best_distinct([*own.lines, *lines], diagonal, config.model_copy(update={"keep": 2 * config.keep}))
    lines = []
    for candidate in candidates:
        mine = voter.opinion(candidate.line)
        others = [_opinion(twin, mine.line) for twin in twins]
        lines.append(_mean(mine, others))
    ranked = best_distinct(lines, diagonal, config)
    if not ranked:
        return own
    followed = not own.lines or not same_line(ranked[0], own.lines[0], diagonal, config)
    follows = tuple((twin.voter.bearing.a, twin.voter.bearing.b) for twin in twins) if followed else ()
    return replace(own, lines=tuple(ranked), follows=follows)


def _carried(line: BearingLine, motion: RigidMotion, centroid: FloatArray) -> BearingLine:
    moved = Line(axis=motion.directions(line.axis), point=motion.points(line.pivot))
    return replace(line, axis=moved.axis, pivot=moved.foot(centroid))


def _opinion(twin: _Twin, line: Line) -> BearingLine:
    there = Line(axis=twin.motion.directions(line.axis), point=twin.motion.points(line.point))
    said = twin.voter.opinion(there)
    return said.exchanged if twin.swapped else said


def _mean(mine: BearingLine, others: Sequence[BearingLine]) -> BearingLine:
    everyone, names = [mine, *others], ("score", "surface_a", "surface_b", "circles_a", "circles_b")
    means: dict[str, Any] = {name: float(np.mean([getattr(line, name) for line in everyone])) for name in names}
    return replace(mine, **means)


def same_line(one: BearingLine, other: BearingLine, diagonal: float, config: BearingConfig) -> bool:
    """True if two lines of one contact are one, within the tolerance at which they are kept apart."""
    cosine = np.cos(np.radians(config.apart_angle))
    close = float(np.linalg.norm(one.pivot - other.pivot)) < config.apart * diagonal
    return bool(abs(float(one.axis @ other.axis)) > cosine and close)


_START = 3.0  # times the distance that is asked for: principal axes of rough twins are some degrees off
_ROUNDS = 10  # of matching nearest points; converged to a tenth of the spacing of the points
_SAME = np.cos(np.radians(5.0))  # nearly equal motions are one


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidMotion:
    """x -> turn x + shift, in the world frame."""

    turn: FloatArray
    """Orthogonal, of determinant 1 or -1, shape (3, 3)."""
    shift: FloatArray
    """[m], shape (3,)."""

    def points(self, points: FloatArray) -> FloatArray:
        """Where points go, shape (n, 3) or (3,)."""
        return np.asarray(points @ self.turn.T + self.shift)

    def directions(self, directions: FloatArray) -> FloatArray:
        """Where directions go, shape (n, 3) or (3,)."""
        return np.asarray(directions @ self.turn.T)

    @property
    def inverse(self) -> RigidMotion:
        """The way back."""
        return RigidMotion(turn=self.turn.T, shift=-self.turn.T @ self.shift)


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
        if tree.query(start.points(first))[0].mean() > _START * tolerance:
            continue
        motion, distance = matched(first, second, tree, start)
        if distance <= tolerance:
            found.append((distance, motion))
    kept: list[RigidMotion] = []
    for _, motion in sorted(found, key=lambda item: item[0]):
        if all(_agreement(motion, other) < _SAME for other in kept):
            kept.append(motion)
    return kept


def _starts(first: FloatArray, second: FloatArray) -> list[RigidMotion]:
    middles = first.mean(axis=0), second.mean(axis=0)
    axes = [np.linalg.eigh((cloud - m).T @ (cloud - m))[1] for cloud, m in zip((first, second), middles, strict=True)]
    starts = []
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            turn = (axes[1][:, order] * signs) @ axes[0].T
            starts.append(RigidMotion(turn=turn, shift=middles[1] - turn @ middles[0]))
    return starts


def matched(first: FloatArray, second: FloatArray, tree: cKDTree, motion: RigidMotion) -> tuple[RigidMotion, float]:
    """Match nearest points until they stay, mirrored or not as at the start; and their mean distance [m]."""
    sign, one, found = np.sign(np.linalg.det(motion.turn)), first.mean(axis=0), np.empty(0)
    for _ in range(_ROUNDS):
        distances, index = tree.query(motion.points(first))
        if np.array_equal(index, found):  # the same points give the same motion again
            return motion, float(distances.mean())
        found, nearest, other = index, second[index], second[index].mean(axis=0)
        left, _, right = np.linalg.svd((nearest - other).T @ (first - one))
        flip = np.array([1.0, 1.0, sign * np.sign(np.linalg.det(left @ right))])
        turn = (left * flip) @ right
        motion = RigidMotion(turn=turn, shift=other - turn @ one)
    return motion, float(tree.query(motion.points(first))[0].mean())


def _agreement(one: RigidMotion, other: RigidMotion) -> float:
    """Cosine of the angle between two motions; -1 where only one of them mirrors."""
    if np.linalg.det(one.turn) * np.linalg.det(other.turn) < 0:
        return -1.0
    return float(np.clip((np.trace(one.turn.T @ other.turn) - 1.0) / 2.0, -1.0, 1.0))
