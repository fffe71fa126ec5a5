"""Sets of pieces that may be one moving part, and what is measured of each as a whole."""

from __future__ import annotations

import heapq
from collections import defaultdict
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from kinematify.grouping.lattice import CELLS, PAD
from kinematify.grouping.pair_measurements import FREE, freedom_columns, place_columns

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Part
    from kinematify.grouping.lattice import Lattice
    from kinematify.grouping.pair_measurements import MeasuredPieces
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray

_SMALLER = (0.4, 0.8)
"""Neighbours below these shares of a piece's size may move with it."""
_TOGETHER = 0.9
"""Share of the pieces that hang together in their nodes, if nodes are parts: 1 in most files, .2 to .9 by material."""
_POINTS = 160
"""Of a candidate, which are turned."""
_ANGLES, _NAMES = (12.0, 40.0, 80.0), ("slightly", "half", "wide")
"""Turns about an edge of the box around a candidate [deg]."""

_ALIKE = 2e-3
"""Of the object's size: congruent pieces have sizes and places that differ by less."""
_MIRRORS = np.array([[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0]])
"""Of congruent sets of pieces beside each other."""

Candidate = frozenset[int]


def node_of_pieces(names: Sequence[str], pairs: IntArray) -> IntArray | None:
    """Node that each piece came from, shape (n,); None where nodes say nothing of the parts.

    So it is if there is one node or one per piece, and if pieces of a node hang apart, as those of one material do.

    Args:
        names: Of the node of every piece.
        pairs: Neighbours, shape (m, 2).
    """
    node = np.unique(names, return_inverse=True)[1]
    count, within = int(node.max()) + 1, pairs[node[pairs[:, 0]] == node[pairs[:, 1]]]
    links = coo_array((np.ones(len(within)), within.T), shape=(len(node), len(node)))
    joined = connected_components(links, directed=False)[1]
    together = sum(int(np.bincount(joined[node == k]).max()) for k in range(count))
    return node if 1 < count < len(node) and together >= _TOGETHER * len(node) else None


def propose(measured: MeasuredPieces, odds: FloatArray) -> list[Candidate]:
    """Sets of pieces that may be a part: each piece, with what rides on it, and what clustering joins step by step.

    Args:
        measured: Pieces and pairs.
        odds: Log odds that each pair is rigidly one, shape (m,).
    """
    count = measured.grid.count
    beside: list[set[int]] = [set() for _ in range(count)]
    for a, b in measured.pairs.tolist():
        beside[a].add(b)
        beside[b].add(a)
    found = [frozenset([piece]) for piece in range(count)]
    for share in _SMALLER:
        for piece in range(count):
            smaller = {other for other in beside[piece] if measured.sizes[other] < share * measured.sizes[piece]}
            found.append(frozenset({piece} | smaller))
    found += [_with_riders(piece, beside, measured.sizes) for piece in range(count)]
    found += _joined_stepwise(count, measured.pairs, odds)
    return [candidate for candidate in dict.fromkeys(found) if len(candidate) < count]


def _with_riders(piece: int, beside: Sequence[set[int]], sizes: FloatArray) -> Candidate:
    """A piece with all smaller ones that reach the others only through it."""
    group = {piece}
    while True:
        around = {other for member in group for other in beside[member]} - group
        new = {other for other in around if beside[other] <= group and sizes[other] <= sizes[piece]}
        if not new:
            return frozenset(group)
        group |= new


def _joined_stepwise(count: int, pairs: IntArray, odds: FloatArray) -> list[Candidate]:
    """Every group that arises when the two likeliest to be one are joined until nothing is left to join.

    The log odds between two groups are the mean over the pairs of neighbours between them (average linkage).
    """
    links: dict[int, dict[int, tuple[float, float]]] = defaultdict(dict)
    for (a, b), value in zip(pairs.tolist(), odds.tolist(), strict=True):
        links[a][b] = links[b][a] = (value, 1.0)
    waiting = [(-link[0], a, b, link) for a in links for b, link in links[a].items() if a < b]
    heapq.heapify(waiting)
    members = {piece: frozenset([piece]) for piece in range(count)}
    found = []
    while waiting:
        _, a, b, link = heapq.heappop(waiting)
        if a not in members or b not in members or links[a].get(b) != link:
            continue
        kept, gone = (a, b) if len(members[a]) >= len(members[b]) else (b, a)
        members[kept] |= members.pop(gone)
        found.append(members[kept])
        for other, (total, number) in links.pop(gone).items():
            if other == kept:
                continue
            own = links[kept].get(other, (0.0, 0.0))
            new = own[0] + total, own[1] + number
            links[kept][other] = links[other][kept] = new
            del links[other][gone]
            heapq.heappush(waiting, (-new[0] / new[1], min(kept, other), max(kept, other), new))
        links[kept].pop(gone, None)
    return found


def alike(
    candidates: Sequence[Candidate], odds: FloatArray, parts: Sequence[Part]
) -> tuple[list[Candidate], FloatArray]:
    """Sets of pieces with the congruent ones that were not proposed; those that are congruent have one log odds.

    Three equal drawers are grouped alike, whichever of their sets were proposed, and how each was measured.

    Args:
        candidates: Sets of pieces.
        odds: Log odds that each is a moving part, shape (c,).
        parts: The pieces.

    Returns:
        The sets, and the mean log odds of all proposed ones that are congruent with each.
    """
    middles = np.array([part.bounds.mean(axis=0) for part in parts])
    shapes = np.array([(*np.ptp(part.bounds, axis=0), np.sqrt(part.area)) for part in parts])
    near = _ALIKE * float(np.linalg.norm(np.ptp(middles, axis=0)) + shapes.max())
    tree = cKDTree(np.concatenate([shapes, middles], axis=1))
    known = dict(zip(candidates, odds.tolist(), strict=True))
    label: dict[Candidate, Candidate] = {}
    for candidate in candidates:
        if candidate in label:
            continue
        label[candidate] = candidate
        pieces = np.array(sorted(candidate))
        offsets = (middles[pieces] - middles[pieces[0]]) * _MIRRORS[: len(_MIRRORS) if len(pieces) > 1 else 1, None]
        same = np.flatnonzero((np.abs(shapes - shapes[pieces[0]]) < near).all(axis=1))
        places = (middles[same, None, None] + offsets).reshape(-1, len(pieces), 3)
        wanted = np.concatenate([np.broadcast_to(shapes[pieces], (len(places), *shapes[pieces].shape)), places], axis=2)
        gaps, found = tree.query(wanted, p=np.inf, distance_upper_bound=near)
        for row in found[np.isfinite(gaps).all(axis=1)].tolist():
            image = frozenset(row)
            if len(image) == len(candidate) and (image == candidate or not image & candidate):
                label.setdefault(image, candidate)
    members: dict[Candidate, list[float]] = defaultdict(list)
    for candidate, value in known.items():
        members[label[candidate]].append(value)
    return list(label), np.array([np.mean(members[of]) for of in label.values()])


def measure_candidates(
    measured: MeasuredPieces, odds: FloatArray, areas: FloatArray, candidates: Sequence[Candidate]
) -> tuple[FloatArray, tuple[str, ...]]:
    """Return what is measured of each candidate, shape (c, k), and the names of the columns.

    Args:
        measured: Pieces and pairs.
        odds: Log odds of each pair, shape (m,).
        areas: Surface of every piece, shape (n,).
        candidates: Sets of pieces, none of them all.
    """
    member = np.zeros((len(candidates), measured.grid.count), dtype=bool)
    for row, candidate in enumerate(candidates):
        member[row, list(candidate)] = True
    turns = _Turns(measured.grid)
    rows = [{**_links(inside, measured, odds, areas), **turns.measured(inside)} for inside in member]
    columns = {**_place(member, measured.grid, areas), **_slides(member, measured.grid)}
    table = np.column_stack([[list(row.values()) for row in rows], *columns.values()])
    return with_ranks(table, (*rows[0], *columns))


def with_ranks(table: FloatArray, names: tuple[str, ...]) -> tuple[FloatArray, tuple[str, ...]]:
    """The table (c, k) with the rank of every value among those of all candidates, in (0, 1], shape (c, 2 k).

    What is large or free for one object is not for another; ranks compare the candidates of one object.
    """
    from scipy.stats import rankdata  # noqa: PLC0415  # its import takes .3 s, and only grouping needs it

    return np.column_stack([table, rankdata(table, axis=0) / len(table)]), (*names, *(f"{name}_rank" for name in names))


def _links(inside: BoolArray, measured: MeasuredPieces, odds: FloatArray, areas: FloatArray) -> dict[str, float]:
    """Return how likely its pieces are one, and are one with others."""
    ends = inside[measured.pairs]
    within, across = ends.all(axis=1), ends[:, 0] != ends[:, 1]
    own, other = odds[within], odds[across]
    outer = np.where(ends[across, 0], measured.pairs[across, 1], measured.pairs[across, 0])
    inner = np.where(ends[across, 0], measured.pairs[across, 0], measured.pairs[across, 1])
    largest = int(np.argmax(np.where(inside, areas, -1.0)))
    of_largest = other[inner == largest]
    touching = measured.gaps[across] < 0.003
    return {
        "own_mean": float(own.mean()) if len(own) else 3.0,
        "own_least": float(own.min()) if len(own) else 3.0,
        "other_mean": float(other.mean()) if len(other) else -6.0,
        "other_most": float(other.max()) if len(other) else -6.0,
        "other_least": float(other.min()) if len(other) else -6.0,
        "main_other_mean": float(of_largest.mean()) if len(of_largest) else -6.0,
        "main_other_most": float(of_largest.max()) if len(of_largest) else -6.0,
        "others": float(len(np.unique(outer))),
        "touching": float(touching.sum()),
        "nearest": float(measured.gaps[across].min()) if len(other) else 0.1,
        "members": float(inside.sum()),
        "share_of_members": float(inside.mean()),
        "main_share": float(areas[largest] / areas[inside].sum()),
    }


def _place(member: BoolArray, grid: Lattice, areas: FloatArray) -> dict[str, FloatArray]:
    """Size, place and what is seen of each candidate, and how it lies in the rest; columns of shape (c,)."""
    low, high = _corners(member, grid)
    rest_low, rest_high = _corners(~member, grid)
    inside, extents = member.astype(np.float64), high - low
    beyond = np.maximum(rest_low - low, 0.0) + np.maximum(high - rest_high, 0.0)
    common = np.clip(np.minimum(high, rest_high) - np.maximum(low, rest_low), 0.0, None)
    return {
        **place_columns(low, high, inside @ grid.seen / (inside @ grid.sizes)[:, None], grid),
        "area": inside @ areas / areas.sum(),
        "largest": inside[:, int(np.argmax(areas))],
        "beyond": beyond.max(axis=1),
        "beyond_share": (beyond / np.maximum(extents, 1e-9)).max(axis=1),
        "in_rest": (common / np.maximum(extents, 1e-9)).prod(axis=1),
    }


def _corners(member: BoolArray, grid: Lattice) -> tuple[FloatArray, FloatArray]:
    """Corners of the boxes around sets of pieces, shape (c, 3) each."""
    boxes = [grid.bounds[inside] for inside in member]
    return np.array([box[:, 0].min(axis=0) for box in boxes]), np.array([box[:, 1].max(axis=0) for box in boxes])


def _slides(member: BoolArray, grid: Lattice) -> dict[str, FloatArray]:
    """Return what each candidate meets when it moves along each axis, as shares of its cells; columns of shape (c,)."""
    inside = member.astype(np.float64)
    size = inside @ grid.sizes
    met = np.array([[((inside @ of) * (1.0 - inside)).sum(axis=1) / size for of in reach] for reach in grid.met])
    seen = inside @ grid.seen / size[:, None]
    rows = np.arange(len(member))
    best = 2 + np.argmin(met[2, 2:] + 1e-3 * met[0, 2:], axis=0)
    others = np.where(np.arange(6)[:, None] == best, np.nan, met[0])
    return {
        "held": ((inside @ grid.at_rest) * (1.0 - inside)).sum(axis=1) / size,
        "out_seen": seen[rows, best],
        "out_others_least": np.nanmin(others, axis=0),
        "out_others_mean": np.nanmean(others, axis=0),
        "out_back": met[1, best ^ 1, rows],
        **freedom_columns(met),
    }


class _Turns:
    """Turns of candidates about the edges of their boxes."""

    def __init__(self, grid: Lattice) -> None:
        self.sizes = grid.sizes
        cells, pieces = grid.filled
        places = np.stack(np.unravel_index(cells, tuple(grid.shape)), axis=1)
        self.low = places.min(axis=0) - 1
        self.shape = places.max(axis=0) - self.low + 2
        keys = np.ravel_multi_index(tuple((places - self.low).T), tuple(self.shape))
        again = np.append(False, cells[1:] == cells[:-1])
        self.first, self.second = (np.full(int(np.prod(self.shape)), grid.count, dtype=np.int16) for _ in range(2))
        self.first[keys[~again]], self.second[keys[again]] = pieces[~again], pieces[again]
        self.starts = np.searchsorted(grid.piece, np.arange(grid.count + 1))
        self.points = grid.points * CELLS + PAD
        self.rotations = np.array(
            [[_rotation(a, np.radians(s * angle)) for s in (1, -1) for angle in _ANGLES] for a in range(3)]
        )

    def measured(self, inside: BoolArray) -> dict[str, float]:
        """Return what a candidate (n,) meets in turns, as shares of its points, beyond what it meets at rest."""
        points = self._points_of(inside)
        outside = np.append(~inside, False)
        rest = self._hits(points[None], outside)[0]
        low, high = points.min(axis=0), points.max(axis=0)
        turned = np.empty((3, 4, 2 * len(_ANGLES), len(points), 3))
        for axis in range(3):
            across = [a for a in range(3) if a != axis]
            for edge in range(4):
                pivot = np.zeros(3)
                pivot[across[0]] = (low, high)[edge & 1][across[0]]
                pivot[across[1]] = (low, high)[edge >> 1][across[1]]
                turned[axis, edge] = (points - pivot) @ self.rotations[axis].transpose(0, 2, 1) + pivot
        met = self._hits(turned.reshape(-1, len(points), 3), outside) - rest
        hits = np.maximum.accumulate(np.maximum(met, 0.0).reshape(3, 4, 2, len(_ANGLES)), axis=3)
        # The second bit of an edge is its height where it is level.
        groups = {"upright": hits[2], "lower": hits[:2, :2], "upper": hits[:2, 2:]}
        columns: dict[str, float] = {}
        for name, values in groups.items():
            group = values.reshape(8, -1)
            columns |= {f"{name}_{angle}": float(group[:, k].min()) for k, angle in enumerate(_NAMES)}
            columns[f"{name}_ways"] = float((group[:, 1] < FREE).sum())
        return columns

    def _points_of(self, inside: BoolArray) -> FloatArray:
        """About `_POINTS` samples [cells], as many of each piece as its size asks for."""
        members = np.flatnonzero(inside)
        shares = np.maximum(np.round(_POINTS * self.sizes[members] / self.sizes[members].sum()), 1).astype(int)
        rows = [
            np.linspace(self.starts[k], self.starts[k + 1] - 1, count).astype(int)
            for k, count in zip(members, shares, strict=True)
        ]
        return np.asarray(self.points[np.concatenate(rows)])

    def _hits(self, points: FloatArray, outside: BoolArray) -> FloatArray:
        """Share of points (t, n, 3) [cells] in cells of pieces that are outside (count + 1,), shape (t,)."""
        cells = np.floor(points).astype(np.int64) - self.low
        beyond = ((cells < 0) | (cells >= self.shape)).any(axis=2)
        cells = np.clip(cells, 0, self.shape - 1)
        keys = (cells[..., 0] * self.shape[1] + cells[..., 1]) * self.shape[2] + cells[..., 2]
        met = outside[self.first[keys]] | outside[self.second[keys]]
        return np.asarray((met & ~beyond).mean(axis=1))


def _rotation(axis: int, angle: float) -> FloatArray:
    a, b = [k for k in range(3) if k != axis]
    turn = np.eye(3)
    turn[a, a] = turn[b, b] = np.cos(angle)
    turn[a, b], turn[b, a] = -np.sin(angle), np.sin(angle)
    return turn
