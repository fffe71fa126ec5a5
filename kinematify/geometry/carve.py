"""Convex pieces cut back until the motion is free: what one joint moves never meets what it leaves behind.

Every joint is swept over its range from rest, with those that follow it; the others are at rest. Two pieces are apart
over a step of the sweep if a face plane of one of them, or a plane across an axis of the joint's frame, has the other
one on its far side at both ends of the step; the arc between them is counted by its height over the chord. That is a
statement about the whole step, so nothing slips through between two samples. Where no plane is found, the piece that
loses less of its link is cut: by one plane if that leaves nearly all of it, else into the convex rest around the swept
obstacle. What is lost is how far points on the link's surface are then from its pieces, because these also fill
hollows, where nothing is lost; volume counts where the surface does not decide.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from kinematify.geometry.convex import ConvexPiece, convex_hull
from kinematify.robot.transforms import rotation_about
from kinematify.robot.vectors import all_three, crossed, lengths_of, triangle_normals

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.robot.arrays import FloatArray, IntArray

    Motions = tuple[FloatArray, FloatArray]
    """Rotations (n, 3, 3) and translations (n, 3)."""
    FreeEnd = Callable[[int, int, int, float], float]
    """Value up to which two bodies may be kept apart on one side of a sweep [rad or m]: sweep, body, body, its sign."""

_SAME = 1e-4
"""A point lies on two pieces if they are equally near to it, but for this share of the body's size."""
_SAMPLES = 160
"""Points in a piece by which the share that a plane cuts off is estimated."""
_LEAST_STEPS = 48
"""Steps of a sweep at least."""
_MOST_STEPS = 128
"""Steps of a sweep at most: 3 deg of a whole turn."""
_MOST_PARTS = 6
"""Pieces that one obstacle may leave of one piece: a box has six sides."""
_LEAST_PART = 0.02
"""A part of a piece that is smaller than this share of it, and of its link, is dropped, unless nothing else is left."""
_FILLING = 1e-3
"""What the volume of a piece counts beside the distance of its surface."""
_PIECE_COST = 3e-4
"""What one more piece costs: as much as 3 % of the surface that is cut back by 1 % of the link's size."""
_ROUNDING = 1e-3
"""Cuts keep this much more than the clearance, as a share of it."""
_BEGUN = 0.25
"""Share of a step that lies within a range if the step counts as one within it."""
_DIRECTIONS = 6
"""Steps of a sweep whose face planes are tried as cuts."""
_MANY = 10_000_000
"""Corners times normals of which inner corners are omitted first: hulls of scanned parts have thousands of each."""
_CACHED = 200_000
"""Numbers in a table that is made at once: they fit the processor's cache."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SweptJoint:
    """The motion of one joint from rest, with its followers, others at rest, in the world frame."""

    moved: frozenset[int]
    """Bodies that it moves."""
    against: frozenset[int]
    """Bodies that it moves them against."""
    followed: Callable[[FloatArray], Motions] | None = None
    """How it moves them against these at values (n,), where other joints follow; None: it turns or slides them."""
    turns: bool
    axis: FloatArray
    """Unit direction, shape (3,)."""
    pivot: FloatArray
    """A point on the axis [m], shape (3,)."""
    lower: float
    """[rad or m], at most 0."""
    upper: float
    """[rad or m], at least 0."""

    def motions(self, values: FloatArray) -> Motions:
        """Rotations (n, 3, 3) and translations (n, 3) of what moves, at values (n,) [rad or m]."""
        if self.followed is not None:
            return self.followed(values)
        if not self.turns:
            return np.broadcast_to(np.eye(3), (len(values), 3, 3)), values[:, None] * self.axis
        rotations = rotation_about(self.axis, values)
        return rotations, self.pivot - rotations @ self.pivot

    def radius(self, points: FloatArray) -> float:
        """Largest distance of points (n, 3) from the axis [m]; 0 for what slides."""
        if not self.turns:
            return 0.0
        return float(lengths_of(crossed(points - self.pivot, np.broadcast_to(self.axis, points.shape))).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class Carved:
    """Rest of a body after carving."""

    pieces: tuple[tuple[ConvexPiece, ...], ...]
    """Of every body, world frame at rest; at least one where there was one."""
    lost: tuple[float, ...]
    """Share of the volume of each body's pieces that was cut away."""
    jams: tuple[tuple[int, int, int], ...]
    """Sweep and two bodies whose last pieces still meet, because a body keeps at least one."""


class _Polytope:
    """A convex piece of a body, with its planes."""

    def __init__(self, body: int, piece: ConvexPiece, marks: FloatArray) -> None:
        """Keep the piece, and the points (n, 3) of its body's surface that it represents."""
        self.body, self.piece, self.marks = body, piece, marks
        self.vertices = piece.vertices
        self.low, self.high = piece.low, piece.high

    @cached_property
    def planes(self) -> tuple[FloatArray, FloatArray]:
        """Distinct outward unit normals (P, 3) of the faces and offsets (P,): inside where `normal @ x <= offset`."""
        normals = triangle_normals(self.vertices[self.piece.faces])
        areas = lengths_of(normals)
        normals = normals[areas > 0.0] / areas[areas > 0.0, None]
        x, y, z = np.round(normals.T * 500.0).astype(np.int64) + 500
        _, first = np.unique((x << 20) + (y << 10) + z, return_index=True)
        distinct = normals[np.sort(first)]
        return distinct, (distinct @ self.vertices.T).max(axis=1)

    @cached_property
    def samples(self) -> FloatArray:
        """Points spread evenly over the inside, shape (n, 3)."""
        middle = self.vertices.mean(axis=0)
        a, b, c = (self.vertices - middle)[self.piece.faces.T]
        volumes = np.abs(np.einsum("ij,ij->i", a, crossed(b, c)))
        ends = np.cumsum(volumes)
        number = np.arange(_SAMPLES)
        face = np.minimum(np.searchsorted(ends, (number + 0.5) / _SAMPLES * ends[-1]), len(ends) - 1)
        steps = np.array([0.8191725134, 0.6710436067, 0.5497004779])
        cube = np.sort((number[:, None] * steps + 0.5) % 1.0, axis=1)  # the ordered cube is a tetrahedron
        weights = np.stack([cube[:, 0], cube[:, 1] - cube[:, 0], cube[:, 2] - cube[:, 1]], axis=1)
        return np.asarray(middle + weights[:, :1] * a[face] + weights[:, 1:2] * b[face] + weights[:, 2:] * c[face])

    def clipped(self, normal: FloatArray, offset: float, thinnest: float) -> _Polytope | None:
        """Return what lies where `normal @ x >= offset`; None where that is thinner than `thinnest` or nothing."""
        heights = self.vertices @ normal - offset
        if heights.max() <= thinnest:
            return None
        if heights.min() >= 0.0:
            return self
        marks = self.marks[self.marks @ normal >= offset]
        faces = self.piece.faces
        following = faces[:, [1, 2, 0]]
        crossing = (heights[faces] * heights[following] < 0.0) & (faces < following)  # each edge has a face either way
        edges = np.sort(faces[crossing] * len(self.vertices) + following[crossing])
        one, other = np.divmod(edges, len(self.vertices))
        share = (heights[one] / (heights[one] - heights[other]))[:, None]
        first, second = self.vertices[one], self.vertices[other]
        points = np.concatenate([self.vertices[heights >= 0.0], first + share * (second - first)])
        try:
            vertices, faces = convex_hull(points)
        except (QhullError, ValueError):  # what is left is flat
            return None
        return _Polytope(self.body, ConvexPiece(vertices=vertices, faces=faces), marks)

    def stray(self, parts: Sequence[_Polytope]) -> float:
        """Sum of the distances of its marks from parts of it; from farthest off where there are none [m]."""
        far = float(np.linalg.norm(self.high - self.low))
        nearest = np.full(len(self.marks), far)
        for part in parts:
            normals, offsets = part.planes
            nearest = np.minimum(nearest, np.maximum((self.marks @ normals.T - offsets).max(axis=1), 0.0))
        return float(nearest.sum())

    def share(self, volume: float, marks: int) -> float:
        """Return how much it is of something with so much volume and surface."""
        return len(self.marks) / max(marks, 1) + _FILLING * self.piece.volume / max(volume, 1e-300)


def carved(
    bodies: Sequence[Sequence[ConvexPiece]],
    surfaces: Sequence[FloatArray],
    sweeps: Sequence[SweptJoint],
    free_end: FreeEnd,
    *,
    clearance: float,
    thinnest: float,
    most: int,
    kept: frozenset[int] = frozenset(),
) -> Carved:
    """Cut pieces back until no sweep brings two of them nearer than the clearance where the bodies are free to move.

    Args:
        bodies: Convex pieces of every body, world frame at rest.
        surfaces: Points on the surface of every body, shape (n, 3) each, spread evenly.
        sweeps: One per joint that moves.
        free_end: Where the bodies themselves begin to block each other, infinite where they never do; asked only where
            pieces meet. What lies beyond is left as it is: carving there would hide that the motion is not possible.
        clearance: Distance that is kept between what moves and what does not [m].
        thinnest: What would be left thinner than this is dropped [m].
        most: Pieces of a body at most; those are dropped that represent least of its surface.
        kept: Bodies that stay as they are: only what meets them is cut.
    """
    alive = [_marked(index, *of_body) for index, of_body in enumerate(zip(bodies, surfaces, strict=True))]
    volumes = [sum(item.piece.volume for item in group) for group in alive]
    # The sum of distances of a body's surface from its pieces is measured by its size, times the points that it has.
    extents = [
        max(len(surface) * float(np.linalg.norm(np.ptp(surface, axis=0))), 1e-300) if len(surface) else 1.0
        for surface in surfaces
    ]
    jams: list[tuple[int, int, int]] = []
    for number, sweep in enumerate(sweeps):
        clearing = _Carver(
            alive, volumes, extents, sweep, partial(free_end, number),
            clearance=clearance, thinnest=thinnest, kept=kept,
        )  # fmt: skip
        jams += [(number, one, other) for one, other in clearing.run()]
    for body, (group, volume, surface) in enumerate(zip(alive, volumes, surfaces, strict=True)):
        while body not in kept and len(group) > most:
            group.remove(min(group, key=partial(_Polytope.share, volume=volume, marks=len(surface))))
    return Carved(
        pieces=tuple(tuple(item.piece for item in group) for group in alive),
        lost=tuple(
            max(0.0, 1.0 - sum(item.piece.volume for item in group) / max(before, 1e-300))
            for group, before in zip(alive, volumes, strict=True)
        ),
        jams=tuple(jams),
    )


def _marked(body: int, pieces: Sequence[ConvexPiece], surface: FloatArray) -> list[_Polytope]:
    """The pieces of a body, each with the points of its surface to which no other one is nearer."""
    found = [_Polytope(body, piece, surface[:0]) for piece in pieces]
    if found and len(surface):
        beyond = np.array([(surface @ item.planes[0].T - item.planes[1]).max(axis=1) for item in found])
        beyond = np.maximum(beyond, 0.0)
        nearest = beyond <= beyond.min(axis=0) + _SAME * float(np.ptp(surface, axis=0).max())
        for item, mine in zip(found, nearest, strict=True):
            item.marks = surface[mine]
    return found


class _Carver:
    """One sweep that is made free."""

    def __init__(
        self,
        alive: list[list[_Polytope]],
        volumes: Sequence[float],
        extents: Sequence[float],
        sweep: SweptJoint,
        free_end: Callable[[int, int, float], float],
        *,
        clearance: float,
        thinnest: float,
        kept: frozenset[int],
    ) -> None:
        """Keep the pieces of all bodies, which are cut in place but for those kept, and volumes and extents."""
        self._kept = kept
        self._alive, self._volumes, self._extents, self._thinnest = alive, volumes, extents, thinnest
        self._free_end, self._clearance = free_end, clearance
        self._moving = [item for body in sorted(sweep.moved) for item in alive[body]]
        self._resting = [item for body in sorted(sweep.against) for item in alive[body]]
        self._path = _Path(sweep, self._moving, clearance)
        self._rest_of: dict[_Polytope, list[_Polytope]] = {}

    def run(self) -> list[tuple[int, int]]:
        """Cut until the sweep is free; return the pairs of bodies that still meet."""
        jams = []
        near = self._path.near(self._moving, self._resting)
        pairs = [pair for pair in near if not self._kept.issuperset(item.body for item in pair)]
        while pairs:
            one, other = pairs.pop()
            if one in self._rest_of or other in self._rest_of:
                pairs += [(a, b) for a in self._rest_of.get(one, [one]) for b in self._rest_of.get(other, [other])]
                continue
            steps = self._meets(one, other, self._clearance)
            if len(steps) and not self._separated(one, other, steps):
                jams.append((one.body, other.body))
        return jams

    def _meets(self, moving: _Polytope, resting: _Polytope, clearance: float) -> IntArray:
        """Steps in which two pieces come nearer than the clearance although their bodies are free to move there."""
        steps = self._path.meets(moving, resting, clearance)
        return self._path.within(steps, partial(self._free_end, moving.body, resting.body))

    def _separated(self, moving: _Polytope, resting: _Polytope, steps: IntArray) -> bool:
        """Cut the piece that loses less of its body; False if either body would have nothing left."""
        best = self._cheapest(moving, resting, steps) or self._last_piece(moving, resting, steps)
        if best is None:
            return False
        piece, parts = best
        if parts != [piece]:
            self._rest_of[piece] = parts
            group = self._alive[piece.body]
            place = group.index(piece)
            group[place : place + 1] = parts
        return True

    def _cheapest(
        self, moving: _Polytope, resting: _Polytope, steps: IntArray
    ) -> tuple[_Polytope, list[_Polytope]] | None:
        """The piece that loses less of its body, and its parts; None if either body would have nothing left."""
        options = []
        for piece, obstacle in ((moving, resting), (resting, moving)):
            if piece.body in self._kept:
                continue
            parts = self._around(piece, obstacle, steps, backwards=piece is moving)
            if not parts and len(self._alive[piece.body]) == 1:
                continue
            # Of what is left: a body that has lost much already is spared.
            left = sum(item.piece.volume for item in self._alive[piece.body])
            lost = _FILLING * (piece.piece.volume - sum(part.piece.volume for part in parts)) / left
            lost += piece.stray(parts) / self._extents[piece.body]
            options.append((lost + _PIECE_COST * (len(parts) - 1), piece, parts))
        return min(options, key=lambda item: item[0])[1:] if options else None

    def _last_piece(
        self, moving: _Polytope, resting: _Polytope, steps: IntArray
    ) -> tuple[_Polytope, list[_Polytope]] | None:
        """The smaller of two last pieces that has something left without clearance, however little, and what is left.

        It is the head of a pen's button.
        """
        for piece, obstacle in sorted(
            ((moving, resting), (resting, moving)), key=lambda pair: float(pair[0].piece.volume)
        ):
            if piece.body in self._kept:
                continue
            parts = self._around(piece, obstacle, steps, backwards=piece is moving, remnant=True)
            if parts:
                return piece, parts
        return None

    def _around(
        self, piece: _Polytope, obstacle: _Polytope, steps: IntArray, *, backwards: bool, remnant: bool = False
    ) -> list[_Polytope]:
        """Convex parts of a piece that are clear of the obstacle in all steps; the piece itself where it is clear.

        A remnant keeps no clearance and small parts.
        """
        least = 0.0 if remnant else _LEAST_PART * min(piece.piece.volume, self._volumes[piece.body])
        clearance = 0.0 if remnant else self._clearance
        found: list[_Polytope] = []
        whole = piece
        while len(found) < _MOST_PARTS:
            normal, offset = self._path.best_plane(whole, obstacle, steps, clearance, backwards=backwards)
            kept = whole.clipped(normal, offset, self._thinnest)
            if kept is None or kept.piece.volume < least:
                break
            found.append(kept)
            if kept is whole or whole.piece.volume - kept.piece.volume < 0.5 * least:  # sure without a hull
                break
            beyond = whole.clipped(-normal, -offset, self._thinnest)
            if beyond is None or beyond.piece.volume < least:
                break
            steps = self._meets(*((beyond, obstacle) if backwards else (obstacle, beyond)), clearance)
            if not len(steps):
                found.append(beyond)
                break
            whole = beyond
        return found


class _Path:
    """One sweep in steps."""

    def __init__(self, sweep: SweptJoint, moving: Sequence[_Polytope], clearance: float) -> None:
        """Choose steps whose arcs rise over their chords by at most a third of the clearance, and one at rest."""
        self._sweep, self._clearance = sweep, clearance
        count = _LEAST_STEPS if sweep.followed is None else _MOST_STEPS
        if sweep.turns and sweep.followed is None:
            radius = max((sweep.radius(item.vertices) for item in moving), default=0.0)
            step = np.sqrt(8.0 * clearance / 3.0 / max(radius, 1e-9))
            count = int(min(max(np.ceil((sweep.upper - sweep.lower) / step), _LEAST_STEPS), _MOST_STEPS))
        below = int(np.ceil(count * -sweep.lower / max(sweep.upper - sweep.lower, 1e-300)))
        down = np.linspace(sweep.lower, 0.0, below + 1)
        self._values = np.concatenate([down, np.linspace(0.0, sweep.upper, max(count - below, 0) + 1)])
        self._down = len(down)
        self._rotations, self._translations = sweep.motions(self._values)
        self._arc = 1.0 - np.cos(0.5 * np.diff(self._values).max()) if sweep.turns else 0.0
        self._across = np.concatenate([np.eye(3), sweep.axis[None], -np.eye(3), -sweep.axis[None]])
        self._track, self._boxes, self._rise = cache(self._new_track), cache(self._new_boxes), cache(self._new_rise)

    def near(self, moving: Sequence[_Polytope], resting: Sequence[_Polytope]) -> list[tuple[_Polytope, _Polytope]]:
        """Pairs whose boxes meet in some step, those of the first pieces last."""
        if not resting:
            return []
        lows = np.stack([other.low for other in resting]) - self._clearance
        highs = np.stack([other.high for other in resting]) + self._clearance
        found = []
        for item in moving:
            low, high = self._boxes(item)
            close = np.flatnonzero(all_three((low.min(axis=0) <= highs) & (high.max(axis=0) >= lows)))
            meet = all_three((low <= highs[close, None]) & (high >= lows[close, None])).any(axis=1)
            found += [(item, resting[index]) for index in close[meet].tolist()]
        return found[::-1]

    def _new_boxes(self, piece: _Polytope) -> tuple[FloatArray, FloatArray]:
        """Lower and upper corners of boxes around what moves, for every step, shape (n, 3) each; arcs included."""
        track, rise = self._track(piece, backwards=False), self._rise(piece)
        low, high = track.min(axis=1), track.max(axis=1)
        return np.minimum(low[:-1], low[1:]) - rise, np.maximum(high[:-1], high[1:]) + rise

    def within(self, steps: IntArray, free_end: Callable[[float], float]) -> IntArray:
        """Those of some steps that lie before the free ends [rad or m], or begin there; rest always does."""
        start, end = self._values[steps], self._values[steps + 1]
        begun = _BEGUN * (end - start)
        inside = start == end
        for sign, nearer in ((-1.0, end - begun), (1.0, start + begun)):
            beside = sign * nearer > 0.0
            if beside.any():
                inside |= beside & (sign * nearer <= sign * free_end(sign))
        return np.asarray(steps[inside])

    def meets(self, moving: _Polytope, resting: _Polytope, clearance: float) -> IntArray:
        """Steps in which no plane keeps two pieces apart by a clearance that is at most that of the sweep."""
        low, high = self._boxes(moving)
        boxes = (low <= resting.high + self._clearance) & (high >= resting.low - self._clearance)
        near = np.flatnonzero(all_three(boxes))
        if not len(near):
            return near
        ends = slice(near[0], near[-1] + 2)
        apart = np.maximum(
            self._beyond(resting, moving, ends, backwards=False) - self._rise(moving),
            self._beyond(moving, resting, ends, backwards=True) - self._rise(resting),
        )
        return np.asarray(near[0] + np.flatnonzero(apart < clearance))

    def best_plane(
        self, piece: _Polytope, obstacle: _Polytope, steps: IntArray, clearance: float, *, backwards: bool
    ) -> tuple[FloatArray, float]:
        """Unit normal (3,) and offset of the plane that has the swept obstacle below it and most of a piece above."""
        swept = self._track(obstacle, backwards=backwards)[np.union1d(steps, steps + 1)].reshape(-1, 3)
        along = self._normals(obstacle, steps, backwards=backwards)
        normals = np.concatenate([-piece.planes[0], self._across, along])
        offsets = _support(normals, swept) + (1.0 + _ROUNDING) * clearance + self._rise(obstacle)
        kept = (piece.samples @ normals.T > offsets).mean(axis=0)
        if len(piece.marks):
            kept += (piece.marks @ normals.T > offsets).mean(axis=0)
        # Of planes that keep as much, the one that the piece stands out of farthest is the mildest.
        reach = (normals @ piece.vertices.T).max(axis=1) - offsets
        best = np.lexsort((reach, kept))[-1]
        return normals[best], float(offsets[best])

    def _normals(self, piece: _Polytope, steps: IntArray, *, backwards: bool) -> FloatArray:
        """Face normals of a piece along its track at both ends of some steps, shape (k, 3)."""
        own = piece.planes[0]
        if not self._sweep.turns:
            return own
        some = steps[np.unique(np.linspace(0, len(steps) - 1, min(len(steps), _DIRECTIONS)).astype(np.int64))]
        turns = self._rotations[np.union1d(some, some + 1)]
        return np.asarray(np.einsum("nji,pj->npi" if backwards else "nij,pj->npi", turns, own).reshape(-1, 3))

    def _beyond(self, still: _Polytope, passing: _Polytope, ends: slice, *, backwards: bool) -> FloatArray:
        """Measure how far beyond the best plane of `still` the other is in each step between some ends [m], (n,)."""
        normals, offsets = still.planes
        normals = np.concatenate([normals, self._across])
        offsets = np.concatenate([offsets, (self._across @ still.vertices.T).max(axis=1)])
        heights = (self._track(passing, backwards=backwards)[ends] @ normals.T).min(axis=1) - offsets
        return np.asarray(np.minimum(heights[:-1], heights[1:]).max(axis=1))

    def _new_track(self, piece: _Polytope, *, backwards: bool) -> FloatArray:
        """Vertices at the ends of all steps, (n + 1, V, 3), of what moves; backwards: of what rests as that sees it."""
        return np.asarray(
            np.einsum("nji,nvj->nvi", self._rotations, piece.vertices[None] - self._translations[:, None])
            if backwards
            else np.einsum("nij,vj->nvi", self._rotations, piece.vertices) + self._translations[:, None]
        )

    def _new_rise(self, piece: _Polytope) -> float:
        """Return how far the arcs of a piece rise over their chords [m]; by second differences where it is no turn."""
        if self._sweep.followed is None:
            return self._arc * self._sweep.radius(piece.vertices)
        track = self._track(piece, backwards=piece.body not in self._sweep.moved)
        bends = [np.diff(part, n=2, axis=0) for part in (track[: self._down], track[self._down :])]
        return max(float(lengths_of(bend).max(initial=0.0)) for bend in bends) / 8.0


def _support(normals: FloatArray, points: FloatArray) -> FloatArray:
    """Return how far points reach along each normal, shape (k,)."""
    if len(normals) * len(points) > _MANY:
        points = points[ConvexHull(points, qhull_options="QJ").vertices]
    blocks = np.array_split(normals, 1 + len(normals) * len(points) // _CACHED)
    return np.concatenate([(block @ points.T).max(axis=1) for block in blocks])
