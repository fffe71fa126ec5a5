"""Convex pieces cut back until the motion is free: what one joint moves never meets what it leaves behind.

Every joint is swept over its range from rest, the others at rest. Two pieces are apart over a step of the sweep if a
face plane of one of them, or a plane across an axis of the joint's frame, has the other one on its far side at both
ends of the step; the arc between them is counted by its height over the chord. That is a statement about the whole
step, so nothing slips through between two samples. Where no plane is found, the piece that loses less of its link is
cut: by one plane if that leaves nearly all of it, else into the convex rest around the swept obstacle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import QhullError

from kinematify.geometry.convex import ConvexPiece
from kinematify.geometry.hull import convex_hull
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray

    BoolArray = NDArray[np.bool_]

_SAMPLES = 160
"""Points in a piece by which the share that a plane cuts off is estimated."""
_MOST_STEPS = 128
"""Steps of a sweep at most: 3 deg of a whole turn."""
_MOST_PARTS = 6
"""Pieces that one obstacle may leave of one piece: a box has six sides."""
_LEAST_PART = 0.02
"""A part of a piece that is smaller than this share of it, and of its link, is dropped."""
_PIECE_COST = 0.01
"""Share of a link that is given up to save one more piece."""
_ROUNDING = 1e-3
"""Cuts keep this much more than the clearance, as a share of it."""
_DIRECTIONS = 6
"""Steps of a sweep whose face planes are tried as cuts."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Sweep:
    """The motion of one joint from rest, others at rest, in the world frame."""

    moved: frozenset[int]
    """Bodies that it moves."""
    turns: bool
    axis: FloatArray
    """Unit direction, shape (3,)."""
    pivot: FloatArray
    """A point on the axis [m], shape (3,)."""
    lower: float
    """[rad or m], at most 0."""
    upper: float
    """[rad or m], at least 0."""

    def motions(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rotations (n, 3, 3) and translations (n, 3) of what moves, at values (n,) [rad or m]."""
        if not self.turns:
            return np.broadcast_to(np.eye(3), (len(values), 3, 3)), values[:, None] * self.axis
        x, y, z = self.axis
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        sine, versine = np.sin(values)[:, None, None], (1.0 - np.cos(values))[:, None, None]
        rotations = np.eye(3) + sine * cross + versine * (cross @ cross)
        return rotations, self.pivot - rotations @ self.pivot

    def radius(self, points: FloatArray) -> float:
        """Largest distance of points (n, 3) from the axis [m]; 0 for what slides."""
        if not self.turns:
            return 0.0
        return float(lengths_of(crossed(points - self.pivot, np.broadcast_to(self.axis, points.shape))).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class Carved:
    """What is left."""

    pieces: tuple[tuple[ConvexPiece, ...], ...]
    """Of every body, world frame at rest; at least one where there was one."""
    lost: tuple[float, ...]
    """Share of the volume of each body's pieces that was cut away."""
    jams: tuple[tuple[int, int, int], ...]
    """Sweep and two bodies whose last pieces still meet, because a body keeps at least one."""


class _Polytope:
    """A convex piece of a body, with its planes."""

    def __init__(self, body: int, piece: ConvexPiece) -> None:
        self.body, self.piece = body, piece
        self.vertices = piece.vertices
        self.low, self.high = piece.low, piece.high

    @cached_property
    def planes(self) -> tuple[FloatArray, FloatArray]:
        """Distinct outward unit normals (P, 3) of the faces and offsets (P,): inside where `normal @ x <= offset`."""
        a, b, c = (self.vertices[self.piece.faces[:, k]] for k in range(3))
        normals = crossed(b - a, c - a)
        areas = lengths_of(normals)
        normals = normals[areas > 0.0] / areas[areas > 0.0, None]
        _, first = np.unique(np.round(normals * 500.0).astype(np.int64), axis=0, return_index=True)
        distinct = normals[np.sort(first)]
        return distinct, (distinct @ self.vertices.T).max(axis=1)

    @cached_property
    def samples(self) -> FloatArray:
        """Points spread evenly over the inside, shape (n, 3)."""
        middle = self.vertices.mean(axis=0)
        a, b, c = (self.vertices[self.piece.faces[:, k]] - middle for k in range(3))
        volumes = np.abs(np.einsum("ij,ij->i", a, crossed(b, c)))
        ends = np.cumsum(volumes)
        number = np.arange(_SAMPLES)
        face = np.minimum(np.searchsorted(ends, (number + 0.5) / _SAMPLES * ends[-1]), len(ends) - 1)
        steps = np.array([0.8191725134, 0.6710436067, 0.5497004779])
        cube = np.sort((number[:, None] * steps + 0.5) % 1.0, axis=1)  # the ordered cube is a tetrahedron
        weights = np.stack([cube[:, 0], cube[:, 1] - cube[:, 0], cube[:, 2] - cube[:, 1]], axis=1)
        return np.asarray(middle + weights[:, :1] * a[face] + weights[:, 1:2] * b[face] + weights[:, 2:] * c[face])

    def clipped(self, normal: FloatArray, offset: float, thinnest: float) -> _Polytope | None:
        """What lies where `normal @ x >= offset`; None where that is thinner than `thinnest` or nothing."""
        heights = self.vertices @ normal - offset
        if heights.max() <= thinnest:
            return None
        if heights.min() >= 0.0:
            return self
        faces = self.piece.faces
        edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
        start, end = heights[edges[:, 0]], heights[edges[:, 1]]
        crossing = start * end < 0.0
        share = (start[crossing] / (start[crossing] - end[crossing]))[:, None]
        first, second = self.vertices[edges[crossing, 0]], self.vertices[edges[crossing, 1]]
        points = np.concatenate([self.vertices[heights >= 0.0], first + share * (second - first)])
        try:
            vertices, faces = convex_hull(points)
        except (QhullError, ValueError):  # what is left is flat
            return None
        return _Polytope(self.body, ConvexPiece(vertices=vertices, faces=faces))


def carved(
    bodies: Sequence[Sequence[ConvexPiece]], sweeps: Sequence[Sweep], *, clearance: float, thinnest: float
) -> Carved:
    """Cut pieces back until no sweep brings two of them nearer than the clearance.

    Args:
        bodies: Convex pieces of every body, world frame at rest.
        sweeps: One per joint that moves.
        clearance: Distance that is kept between what moves and what does not [m].
        thinnest: What would be left thinner than this is dropped [m].
    """
    carving = _Carving(bodies, clearance, thinnest)
    for number, sweep in enumerate(sweeps):
        carving.free(number, sweep)
    return carving.result()


class _Carving:
    """Bodies on their way to pieces that do not meet."""

    def __init__(self, bodies: Sequence[Sequence[ConvexPiece]], clearance: float, thinnest: float) -> None:
        self._alive = [[_Polytope(index, piece) for piece in pieces] for index, pieces in enumerate(bodies)]
        self._volumes = [max(sum(item.piece.volume for item in group), 1e-300) for group in self._alive]
        self._clearance, self._thinnest = clearance, thinnest
        self._jams: list[tuple[int, int, int]] = []

    def result(self) -> Carved:
        left = [sum(item.piece.volume for item in group) for group in self._alive]
        return Carved(
            pieces=tuple(tuple(item.piece for item in group) for group in self._alive),
            lost=tuple(max(0.0, 1.0 - now / before) for now, before in zip(left, self._volumes, strict=True)),
            jams=tuple(self._jams),
        )

    def free(self, number: int, sweep: Sweep) -> None:
        """Cut until one sweep is free."""
        moving = [item for body in sorted(sweep.moved) for item in self._alive[body]]
        resting = [item for body, group in enumerate(self._alive) if body not in sweep.moved for item in group]
        if not moving or not resting:
            return
        path = _Path(sweep, np.concatenate([item.vertices for item in moving]), self._clearance)
        low, high = path.boxes(moving)
        steps = [
            (low[:, None, :, k] <= np.array([item.high for item in resting])[None, :, None, k] + self._clearance)
            & (high[:, None, :, k] >= np.array([item.low for item in resting])[None, :, None, k] - self._clearance)
            for k in range(3)
        ]
        near = (steps[0] & steps[1] & steps[2]).any(axis=2)
        pairs = [(moving[i], resting[j]) for i, j in np.argwhere(near)[::-1]]
        rest_of: dict[_Polytope, list[_Polytope]] = {}
        while pairs:
            one, other = pairs.pop()
            if one in rest_of or other in rest_of:
                pairs += [(a, b) for a in rest_of.get(one, [one]) for b in rest_of.get(other, [other])]
                continue
            meets = path.meets(one, other, self._clearance)
            if not len(meets):
                continue
            self._separate(number, path, one, other, meets, rest_of)

    def _separate(
        self,
        number: int,
        path: _Path,
        one: _Polytope,
        other: _Polytope,
        meets: IntArray,
        rest_of: dict[_Polytope, list[_Polytope]],
    ) -> None:
        """Cut the piece that loses less of its body."""
        options = []
        for piece, backwards in ((one, True), (other, False)):
            obstacle = other if backwards else one
            parts = _Cut(path, obstacle, backwards, self._clearance, self._thinnest, self._volumes[piece.body]).rest(piece, meets)
            lost = piece.piece.volume - sum(part.piece.volume for part in parts)
            emptied = not parts and len(self._alive[piece.body]) == 1
            cost = np.inf if emptied else lost / self._volumes[piece.body] + _PIECE_COST * (len(parts) - 1)
            options.append((cost, piece, parts))
        if any(parts == [piece] for _, piece, parts in options):
            return
        cost, piece, parts = min(options, key=lambda item: item[0])
        if not np.isfinite(cost):
            self._jams.append((number, one.body, other.body))
            return
        rest_of[piece] = parts
        group = self._alive[piece.body]
        place = group.index(piece)
        group[place : place + 1] = parts


class _Path:
    """One sweep in steps."""

    def __init__(self, sweep: Sweep, points: FloatArray, clearance: float) -> None:
        """Choose steps short enough that arcs rise over their chords by less than a third of the clearance."""
        self.sweep = sweep
        count = 1
        if sweep.turns:
            radius = max(sweep.radius(points), 1e-9)
            step = min(np.sqrt(8.0 * clearance / 3.0 / radius), 0.35)
            count = int(min(max(np.ceil((sweep.upper - sweep.lower) / step), 1), _MOST_STEPS))
        self.values = np.linspace(sweep.lower, sweep.upper, count + 1)
        self._rotations, self._translations = sweep.motions(self.values)
        self._rise = 1.0 - np.cos(0.5 * (sweep.upper - sweep.lower) / count) if sweep.turns else 0.0
        self._tracks: dict[tuple[_Polytope, bool], FloatArray] = {}

    def rise(self, piece: _Polytope) -> float:
        """How far the arcs of a piece rise over their chords [m]."""
        return self._rise * self.sweep.radius(piece.vertices) if self.sweep.turns else 0.0

    def track(self, piece: _Polytope, *, backwards: bool) -> FloatArray:
        """Vertices at all values, shape (n + 1, V, 3): of what moves in the world, or (backwards) of what rests as what
        moves sees it."""
        key = (piece, backwards)
        if key not in self._tracks:
            if backwards:
                shifted = piece.vertices[None] - self._translations[:, None]
                self._tracks[key] = np.einsum("nji,nvj->nvi", self._rotations, shifted)
            else:
                turned = np.einsum("nij,vj->nvi", self._rotations, piece.vertices)
                self._tracks[key] = turned + self._translations[:, None]
        return self._tracks[key]

    def boxes(self, pieces: Sequence[_Polytope]) -> tuple[FloatArray, FloatArray]:
        """Boxes around what moves in every step, shape (pieces, n, 3) each, arcs included."""
        low, high = [], []
        for piece in pieces:
            track, rise = self.track(piece, backwards=False), self.rise(piece)
            ends = track.min(axis=1), track.max(axis=1)
            low.append(np.minimum(ends[0][:-1], ends[0][1:]) - rise)
            high.append(np.maximum(ends[1][:-1], ends[1][1:]) + rise)
        return np.array(low), np.array(high)

    def normals(self, piece: _Polytope, steps: IntArray, *, backwards: bool) -> FloatArray:
        """Face normals of a piece along its track at both ends of some steps, shape (k, 3)."""
        own = piece.planes[0]
        some = np.unique(np.linspace(0, len(steps) - 1, min(len(steps), _DIRECTIONS)).astype(np.int64))
        turns = self._rotations[np.unique(np.concatenate([steps[some], steps[some] + 1]))]
        turned = np.einsum("nji,pj->npi" if backwards else "nij,pj->npi", turns, own)
        return np.asarray(turned.reshape(-1, 3)) if self.sweep.turns else own

    def meets(self, moving: _Polytope, resting: _Polytope, clearance: float) -> IntArray:
        """Steps in which no plane keeps two pieces apart by the clearance."""
        apart = np.maximum(
            self._beyond(resting, moving, backwards=False) - self.rise(moving),
            self._beyond(moving, resting, backwards=True) - self.rise(resting),
        )
        return np.flatnonzero(apart < clearance)

    def _beyond(self, still: _Polytope, passing: _Polytope, *, backwards: bool) -> FloatArray:
        """How far beyond the best plane of `still` the other one is in each step [m], shape (n,)."""
        normals, offsets = still.planes
        across = _axes_of(self.sweep)
        normals = np.concatenate([normals, across, -across])
        offsets = np.concatenate([offsets, (across @ still.vertices.T).max(axis=1), (-across @ still.vertices.T).max(axis=1)])
        heights = (self.track(passing, backwards=backwards) @ normals.T).min(axis=1) - offsets
        return np.asarray(np.minimum(heights[:-1], heights[1:]).max(axis=1))


def _axes_of(sweep: Sweep) -> FloatArray:
    """Axis of a joint and the axes of the frame, shape (4, 3)."""
    return np.concatenate([np.eye(3), sweep.axis[None]])


class _Cut:
    """What one obstacle leaves of a piece."""

    def __init__(
        self, path: _Path, obstacle: _Polytope, backwards: bool, clearance: float, thinnest: float, volume: float
    ) -> None:
        self._path, self._obstacle, self._backwards = path, obstacle, backwards
        self._room = (1.0 + _ROUNDING) * clearance + path.rise(obstacle)
        self._clearance, self._thinnest, self._volume = clearance, thinnest, volume
        self._track = path.track(obstacle, backwards=backwards)

    def rest(self, piece: _Polytope, steps: IntArray) -> list[_Polytope]:
        """Convex parts of a piece that are clear of the obstacle in all steps."""
        found: list[_Polytope] = []
        whole = piece
        while len(found) < _MOST_PARTS:
            normal, offset = self._best_plane(whole, steps)
            kept = whole.clipped(normal, offset, self._thinnest)
            if kept is None or not self._counts(kept, piece):
                break
            found.append(kept)
            if kept is whole:  # a plane that was not asked before is between them
                break
            beyond = whole.clipped(-normal, -offset, self._thinnest)
            if beyond is None or not self._counts(beyond, piece):
                break
            one, other = (beyond, self._obstacle) if self._backwards else (self._obstacle, beyond)
            steps = self._path.meets(one, other, self._clearance)
            if not len(steps):
                found.append(beyond)
                break
            whole = beyond
        return found

    def _counts(self, part: _Polytope, piece: _Polytope) -> bool:
        return part.piece.volume > _LEAST_PART * min(piece.piece.volume, self._volume)

    def _best_plane(self, piece: _Polytope, steps: IntArray) -> tuple[FloatArray, float]:
        """The plane that has the swept obstacle below it and most of the piece above."""
        ends = np.unique(np.concatenate([steps, steps + 1]))
        swept = self._track[ends].reshape(-1, 3)
        across = _axes_of(self._path.sweep)
        normals = np.concatenate(
            [
                -piece.planes[0],
                across,
                -across,
                self._path.normals(self._obstacle, steps, backwards=self._backwards),
            ]
        )
        offsets = (normals @ swept.T).max(axis=1) + self._room
        kept = (piece.samples @ normals.T > offsets).sum(axis=0)
        # Among planes that keep as many samples, the one that keeps the outermost corner farthest is the mildest.
        reach = (normals @ piece.vertices.T).max(axis=1) - offsets
        best = np.lexsort((reach, kept))[-1]
        return normals[best], float(offsets[best])
