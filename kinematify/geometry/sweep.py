"""One joint moved through its range and beyond while all others rest: what it runs into, where, and how deep."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import OverlapQueries, boxes_meet
from kinematify.geometry.rest_pairs import DepthAllowance
from kinematify.geometry.scene import box_corners, relative
from kinematify.robot.vectors import lengths_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from kinematify.geometry.scene import Pair, Scene
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray
    from kinematify.robot.mechanism import Travel


_PIECE = 8  # samples beyond the declared range that are looked at in one go
_COARSE = 9  # configurations from which the length of the way of the corners is estimated


@dataclass(frozen=True, kw_only=True)
class Meeting:
    """A pair that gets deeper into each other than it may, on the way to one side."""

    pair: Pair
    first: float
    """Value of the joint where it begins [rad or m]."""
    deep: float
    """Value of the joint at the first sample where it is deeper than it may be [rad or m]."""
    depth: float
    """Deepest within the declared range, or where it was noticed beyond it [m]."""
    at: float
    """Value of the joint at `depth` [rad or m]."""
    passed: bool
    """The depth is how far something has gone through a wall, not how deep it is in a solid."""
    inside: bool
    """It gets too deep within the declared range; otherwise beyond it, which only neighbours are asked for."""


@dataclass(frozen=True, kw_only=True)
class SweepSide:
    """One direction of a joint from rest."""

    sign: float
    declared: float
    """Value at the declared end [rad or m]; rest if the range does not go this way."""
    reached: float
    """Value up to which it was looked at [rad or m]."""
    meetings: tuple[Meeting, ...]
    """The first to begin comes first."""
    gaps: tuple[tuple[Pair, float, float], ...] = ()
    """Neighbours that may get farther apart than `lost` allows within the declared range, with their largest gap there
    [m] and the value at which."""


@dataclass(frozen=True, kw_only=True, eq=False)
class JointSweep:
    """Both sides of one leader."""

    leader: int
    travel: Travel
    own: frozenset[Pair]
    """Neighbours that this joint connects."""
    sides: tuple[SweepSide, SweepSide]
    """Downwards and upwards."""

    @property
    def free(self) -> tuple[float, float]:
        """Range around rest in which nothing collides [rad or m]."""
        low, high = (side.meetings[0].first if side.meetings else side.reached for side in self.sides)
        return low, high


class Sweeper:
    """Moves the joints of one scene."""

    def __init__(self, scene: Scene, overlap: OverlapQueries, allowance: DepthAllowance) -> None:
        """Keep what is shared by all joints."""
        self._scene, self._overlap, self._allowance = scene, overlap, allowance
        self._way = lru_cache(maxsize=2)(self._way_to_end)  # one joint's pairs are asked about in a row
        # What a pair meets within the declared range on the way to one side, by joint, pair and sign.
        self.meeting = cache(self._within)

    @classmethod
    def of(cls, scene: Scene) -> Sweeper:
        """Return one that shares nothing."""
        overlap = OverlapQueries(scene)
        return cls(scene, overlap, DepthAllowance(scene, overlap))

    def sweep(self, leader: int, *, far: bool = True) -> JointSweep:
        """Move one joint to both sides, beyond its range only if `far` or if it is blocked within."""
        travel = self._scene.travels[leader]
        own = frozenset(
            connection.pair
            for connection in self._scene.connections
            if self._leads(leader, connection.joints) and leader in self._scene.between(connection.pair)
        )
        far = far or any(self.meeting(leader, pair, sign) for sign in (-1.0, 1.0) for pair in own)
        low, high = (self._side(leader, sign, own, far=far) for sign in (-1.0, 1.0))
        return JointSweep(leader=leader, travel=travel, own=own, sides=(low, high))

    def free_end(self, leader: int, sign: float) -> float:
        """Value within the declared range on one side of rest up to which no pair meets [rad or m]."""
        meetings = [self.meeting(leader, pair, sign) for pair in self._scene.affected[leader]]
        ends = [self._way(leader, sign)[0][-1], *(meeting.first for meeting in meetings if meeting)]
        return sign * float(min(sign * np.array(ends)))

    def rows(self, leader: int, values: FloatArray) -> FloatArray:
        """Rows of leaders with one joint at `values` (n,) and the others at rest, shape (n, leaders)."""
        rows = np.tile(self._scene.mechanism.rest, (len(values), 1))
        rows[:, leader] = values
        return rows

    def _leads(self, leader: int, joints: tuple[str, ...]) -> bool:
        names = self._scene.mechanism.joints
        return any(abs(self._scene.mechanism.leads[names.index(name), leader]) > 0.0 for name in joints)

    def _side(self, leader: int, sign: float, own: frozenset[Pair], *, far: bool) -> SweepSide:
        travel, values = self._scene.travels[leader], self._way(leader, sign)[0]
        end = float(values[-1])
        found = {pair: self.meeting(leader, pair, sign) for pair in self._scene.affected[leader]}
        beyond = self._to(leader, end, self._far_end(travel, sign) if far else end, sign)
        for pair in own if far else ():
            found[pair] = found[pair] or self._outside(leader, pair, values, beyond)
        meetings = sorted((m for m in found.values() if m is not None), key=lambda item: abs(item.first - travel.rest))
        return SweepSide(
            sign=sign,
            declared=end,
            reached=float(beyond[-1]),
            meetings=tuple(meetings),
            gaps=tuple(gap for pair in sorted(own) for gap in self.widest(leader, pair, sign)),
        )

    def _way_to_end(self, leader: int, sign: float) -> tuple[FloatArray, FloatArray]:
        """Values (n,) from rest to the declared end of one side, and the poses of all bodies there, (n, B, 4, 4)."""
        travel = self._scene.travels[leader]
        values = self._to(leader, travel.rest, travel.upper if sign > 0 else travel.lower, sign)
        return values, self._scene.poses(self.rows(leader, values))

    def _far_end(self, travel: Travel, sign: float) -> float:
        """Return the end of the search: one more range, at most half a turn from rest, never less than declared."""
        declared = travel.upper if sign > 0 else travel.lower
        if not travel.limited:
            return declared
        way = abs(declared + sign * travel.range - travel.rest)
        way = max(abs(declared - travel.rest), min(way, np.pi)) if travel.turns else way
        return travel.rest + sign * way

    def _to(self, leader: int, start: float, end: float, sign: float) -> FloatArray:
        """Values from `start` to `end`, or `start` alone if `end` lies the other way."""
        if (end - start) * sign < 1e-9:
            return np.array([start])
        return np.linspace(start, end, self._count(leader, start, end) + 1)

    def _count(self, leader: int, start: float, end: float) -> int:
        """Samples so that no corner moves by more than a step from one to the next."""
        settings, scene = self._scene.settings, self._scene
        poses = scene.poses(self.rows(leader, np.linspace(start, end, _COARSE)))
        moved = sorted({body for pair in scene.affected[leader] for body in pair})
        if not moved:
            return settings.samples_least
        corners = np.stack([box_corners(scene.bodies[body].solid) for body in moved])
        T = poses[:, moved]
        posed = np.einsum("nbij,bkj->nbki", T[..., :3, :3], corners) + T[..., None, :3, 3]
        longest = float(lengths_of(np.diff(posed, axis=0)).sum(axis=0).max())
        wanted = int(np.ceil(longest / (settings.step * scene.size)))
        return min(max(wanted, settings.samples_least), settings.samples_most)

    def _within(self, leader: int, pair: Pair, sign: float) -> Meeting | None:
        """Where and how deep a pair meets beyond what it is allowed on its way."""
        values, poses = self._way(leader, sign)
        T = relative(poses, pair)
        if not boxes_meet(*self._overlap.solids(pair), T).any():
            return None
        hit = self._overlap.collide(pair, T)
        growth, passed = self._growth(pair, T, hit)
        events = np.flatnonzero(growth > self._allowance.tolerance(pair))
        if not len(events):
            return None
        begin = self._onset(leader, pair, values[: events[0] + 1], growth, hit), float(values[events[0]])
        return _meeting(pair, begin, values, growth, passed, inside=True)

    def _outside(self, leader: int, pair: Pair, values: FloatArray, beyond: FloatArray) -> Meeting | None:
        """The same beyond the declared range, piece by piece, for the first place is enough."""
        # What is on its way through a wall when the range ends is followed from a piece before.
        way = np.concatenate([values[-_PIECE:], beyond[1:]])
        T = relative(self._scene.poses(self.rows(leader, way)), pair)
        hit = np.zeros(len(way), dtype=bool)
        for start in range(0, len(way), _PIECE):
            new = slice(start, start + _PIECE)
            hit[new] = self._overlap.collide(pair, T[new])
            until = len(hit[: new.stop])
            growth, passed = self._growth(pair, T[:until], hit[:until], since=start)
            events = np.flatnonzero(growth > self._allowance.tolerance(pair))
            if len(events):
                stop = int(events[0]) + 1
                begin = self._onset(leader, pair, way[:stop], growth, hit), float(way[stop - 1])
                return _meeting(pair, begin, way[:stop], growth[:stop], passed, inside=False)
        return None

    def _growth(self, pair: Pair, T: FloatArray, hit: BoolArray, *, since: int = 0) -> tuple[FloatArray, BoolArray]:
        """Depth beyond that at rest [m] and whether something has passed a wall by it, (n,) each.

        Rows before `since` are only the way there; their depth is not asked for.
        """
        overlap, settings, size = self._overlap, self._scene.settings, self._scene.size
        ask = (hit | overlap.may_contain(pair, T)) & (np.arange(len(T)) >= since)
        growth = np.zeros(len(T))
        if ask.any():
            growth[ask] = np.maximum(overlap.depth(pair, T[ask]) - self._allowance.at_rest(pair), 0.0)
        through = overlap.passed(pair, T, hit, grace=2.0 * settings.tolerance * size)
        return np.maximum(growth, through), through > growth

    def _onset(self, leader: int, pair: Pair, values: FloatArray, growth: FloatArray, hit: BoolArray) -> float:
        """First contact of the run of growing depth that leads to the last of the values, found by bisection."""
        noise = self._scene.settings.noise * self._scene.size
        start = len(values) - 1
        while start > 1 and growth[start - 1] > noise:
            start -= 1
        low, high = float(values[start - 1]), float(values[start])

        def free(value: float) -> bool:
            T = relative(self._scene.poses(self.rows(leader, np.array([value]))), pair)
            if hit[start - 1]:
                return float(self._overlap.depth(pair, T)[0]) <= self._allowance.at_rest(pair) + noise
            return not bool(self._overlap.collide(pair, T)[0])

        settings, turns = self._scene.settings, self._scene.travels[leader].turns
        fine = np.radians(settings.fine_angle) if turns else min(settings.fine_length, 1e-4 * self._scene.size)
        return bisected(free, low, high, float(fine))

    def widest(self, leader: int, pair: Pair, sign: float) -> Iterator[tuple[Pair, float, float]]:
        """Yield the largest gap of a pair on the way to one side [m], and where; nothing where it is small for sure."""
        settings, overlap = self._scene.settings, self._overlap
        values, poses = self._way(leader, sign)
        T = relative(poses, pair)
        chosen: IntArray = np.unique(np.linspace(0, len(values) - 1, settings.gap_samples + 1).astype(np.int64))
        apart = [row for row in chosen if not overlap.near(pair, T[row], settings.lost * self._scene.size)]
        if apart:
            gaps = [overlap.gap(pair, T[row]) for row in apart]
            widest = int(np.argmax(gaps))
            yield pair, gaps[widest], float(values[apart[widest]])


def _meeting(
    pair: Pair, begin: tuple[float, float], values: FloatArray, growth: FloatArray, passed: BoolArray, *, inside: bool
) -> Meeting:
    deepest = int(np.argmax(growth))
    return Meeting(
        pair=pair,
        first=begin[0],
        deep=begin[1],
        depth=float(growth[deepest]),
        at=float(values[deepest]),
        passed=bool(passed[deepest]),
        inside=inside,
    )


def bisected(free: Callable[[float], bool], low: float, high: float, fine: float) -> float:
    """Last value that is free, between `low`, which is, and `high`, which is not."""
    while abs(high - low) > fine:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if free(middle) else (low, middle)
    return low
