"""Measurements of two pieces that touch: sizes, contact, room to move, what is seen, twins and neighbours."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.mesh_trees import DistanceTree, WindingTree
from kinematify.grouping.lattice import Lattice, frame_of, lattice
from kinematify.robot.vectors import box_gaps, lengths_of
from kinematify.robot.weld import is_closed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Part
    from kinematify.robot.arrays import FloatArray, IntArray

_NEAR, _TOUCH = 0.012, 0.003
"""Of the longest side: pieces this near are neighbours, and in contact."""
_PROBES = 160
"""Samples of a piece whose distance to another is measured."""
_FLUSH = 0.004
"""Of the longest side: planes of two boxes nearer than this are one plane."""
_TWIN = 0.02
"""Relative difference of sizes and areas of twins."""
FREE = 0.02
"""Share of the cells of what moves that may meet others without being stopped."""
_HANDLE = 0.35
"""A neighbour smaller than this share of a piece may ride on it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MeasuredPieces:
    """Neighbours among pieces and what is measured of each pair."""

    pairs: IntArray
    """Ends of every pair, the smaller piece first, shape (m, 2)."""
    gaps: FloatArray
    """Distance between them, as a share of the longest side, shape (m,)."""
    columns: FloatArray
    """Shape (m, len(names))."""
    names: tuple[str, ...]
    grid: Lattice
    sizes: FloatArray
    """Diagonal of every piece's box, as a share of the longest side, shape (n,)."""


def measure_pieces(parts: Sequence[Part]) -> MeasuredPieces:
    """Measure every pair of neighbours.

    Args:
        parts: Two or more pieces with area, world frame, z up.
    """
    grid = lattice(parts)
    sizes = lengths_of(grid.bounds[:, 1] - grid.bounds[:, 0])
    pairs, contact = _contacts(parts, grid, sizes)
    of_piece = _of_pieces(parts, grid)
    of_piece |= _of_neighbours(pairs, contact, sizes, len(parts))
    blocked = _blocked(grid, pairs)
    of_pair = {**contact, **_of_boxes(grid, pairs, sizes), **blocked}
    of_pair |= _of_twins(of_piece, pairs)
    small, large = pairs.T
    names = [*of_pair, *(f"{name}_{which}" for which in ("small", "large") for name in of_piece)]
    values = [*of_pair.values(), *(column[ends] for ends in (small, large) for column in of_piece.values())]
    return MeasuredPieces(
        pairs=pairs, gaps=contact["gap"], columns=np.column_stack(values), names=tuple(names), grid=grid, sizes=sizes
    )


def _contacts(parts: Sequence[Part], grid: Lattice, sizes: FloatArray) -> tuple[IntArray, dict[str, FloatArray]]:
    """Pairs of neighbours, the smaller one first, and how they touch."""
    apart = box_gaps(grid.bounds[:, 0], grid.bounds[:, 1])
    rows, columns = np.nonzero(np.triu(apart <= _NEAR, k=1))
    probes = _probes(grid)
    turn, offset, scale = frame_of(parts)
    trees = [_Trees(part, turn, offset, scale) for part in parts]
    kept, found = [], []
    for a, b in zip(rows.tolist(), columns.tolist(), strict=True):
        small, large = (a, b) if (sizes[a], a) <= (sizes[b], b) else (b, a)
        measured = _contact(probes[small], probes[large], trees[small], trees[large])
        if measured is not None:
            kept.append((small, large))
            found.append(measured)
    names = (
        "gap", "touch_small", "near_small", "touch_large", "near_large", "patch_long", "patch_wide", "patch_thin",
        "inside_small", "inside_large", "patch_of_small",
    )  # fmt: skip
    table = np.array(found).reshape(-1, len(names))
    return np.array(kept, dtype=np.int64).reshape(-1, 2), dict(zip(names, table.T, strict=True))


class _Trees:
    """Trees of one piece, built when first asked for."""

    def __init__(self, part: Part, turn: FloatArray, offset: FloatArray, scale: float) -> None:
        self.vertices = (part.vertices @ turn.T - offset) / scale
        self.faces = part.faces

    @cached_property
    def distances(self) -> DistanceTree:
        return DistanceTree(self.vertices, self.faces)

    @cached_property
    def winding(self) -> WindingTree | None:
        """None where the piece is open."""
        return WindingTree(self.vertices, self.faces) if is_closed(self.vertices, self.faces) else None

    def inside(self, points: FloatArray) -> float:
        """Share of the points inside; missing where the piece is open."""
        return float("nan") if self.winding is None else float((np.abs(self.winding.numbers(points)) > 0.5).mean())


def _probes(grid: Lattice) -> list[FloatArray]:
    starts = np.searchsorted(grid.piece, np.arange(grid.count + 1))
    found = []
    for k in range(grid.count):
        points = grid.points[starts[k] : starts[k + 1]]
        found.append(points[np.unique(np.linspace(0, len(points) - 1, _PROBES).astype(int))])
    return found


def _contact(small: FloatArray, large: FloatArray, tree_small: _Trees, tree_large: _Trees) -> tuple[float, ...] | None:
    there, back = tree_large.distances.distances(small), tree_small.distances.distances(large)
    gap = float(min(there.min(), back.min()))
    if gap > _NEAR:
        return None
    patch = np.concatenate([small[there <= gap + _TOUCH], large[back <= gap + _TOUCH]])
    spread = np.sort(np.linalg.eigvalsh(np.cov(patch.T)))[::-1] if len(patch) > 2 else np.zeros(3)
    spread = np.sqrt(np.maximum(spread, 0.0)) * np.sqrt(12.0)
    extent = float(np.linalg.norm(np.ptp(small, axis=0)))
    return (
        gap,
        float((there <= _TOUCH).mean()),
        float((there <= _NEAR).mean()),
        float((back <= _TOUCH).mean()),
        float((back <= _NEAR).mean()),
        *(spread / max(extent, 1e-9)).tolist(),
        tree_large.inside(small),
        tree_small.inside(large),
        float(np.linalg.norm(np.ptp(patch, axis=0)) / max(extent, 1e-9)),
    )


def _of_pieces(parts: Sequence[Part], grid: Lattice) -> dict[str, FloatArray]:
    """Columns of every piece by itself."""
    low, high = grid.bounds[:, 0], grid.bounds[:, 1]
    extents = high - low
    areas = np.array([part.area for part in parts])
    boxes = 2.0 * (extents * np.roll(extents, 1, axis=1)).sum(axis=1)
    rank = np.argsort(np.argsort(-areas)) / len(parts)
    return {
        **place_columns(low, high, grid.seen / grid.sizes[:, None], grid),
        "area": areas / areas.sum(),
        "rank": rank,
        "largest": (rank == 0).astype(float),
        "fill": areas / frame_of(parts)[2] ** 2 / np.maximum(boxes, 1e-9),
        "faces": np.log10([len(part.faces) for part in parts]),
        "held": grid.at_rest.sum(axis=1) / grid.sizes,
        **freedom_columns(grid.met.sum(axis=3) / grid.sizes),
    }


def place_columns(low: FloatArray, high: FloatArray, seen: FloatArray, grid: Lattice) -> dict[str, FloatArray]:
    """Size, place and what is seen of pieces or sets of pieces; columns of shape (n,).

    Args:
        low: Lower corners of their boxes, shape (n, 3).
        high: Upper ones.
        seen: Share of their cells that is seen from each direction, shape (n, 6).
        grid: Of the object.
    """
    extents, end, one = high - low, grid.end, np.ones(len(low))
    ordered = np.sort(extents, axis=1)
    sides = np.sort(np.stack([low[:, 0], end[0] - high[:, 0], low[:, 1], end[1] - high[:, 1]], axis=1), axis=1)
    around = np.sort(seen[:, 2:], axis=1)
    return {
        "thin": ordered[:, 0],
        "middle": ordered[:, 1],
        "long": ordered[:, 2],
        "slender": ordered[:, 1] / np.maximum(ordered[:, 2], 1e-9),
        "flat": ordered[:, 0] / np.maximum(ordered[:, 1], 1e-9),
        "thin_up": (np.argmin(extents, axis=1) == 2).astype(float),
        "height": extents[:, 2],
        "box_share": extents.prod(axis=1) / max(float(end.prod()), 1e-12),
        "bottom": low[:, 2],
        "top": end[2] - high[:, 2],
        "side_1": sides[:, 0],
        "side_2": sides[:, 1],
        "side_3": sides[:, 2],
        "of_height": extents[:, 2] / max(end[2], 1e-9),
        "of_width": (extents[:, :2] / np.maximum(end[:2], 1e-9)).max(axis=1),
        "of_depth": (extents[:, :2] / np.maximum(end[:2], 1e-9)).min(axis=1),
        "seen_up": seen[:, 0],
        "seen_down": seen[:, 1],
        "seen_side_1": around[:, 3],
        "seen_side_2": around[:, 2],
        "seen": seen.sum(axis=1),
        "pieces": one * np.log10(grid.count),
        "object_height": one * end[2],
        "object_depth": one * end[:2].min(),
    }


def freedom_columns(met: FloatArray) -> dict[str, FloatArray]:
    """Columns of shape (n,) of what is met within each reach along each direction, as shares of cells, (3, 6, n)."""
    columns: dict[str, FloatArray] = {}
    for reach, name in zip(met, ("short", "middle", "far"), strict=True):
        around = np.sort(reach[2:], axis=0)
        columns |= {
            f"up_{name}": reach[0],
            f"down_{name}": reach[1],
            **{f"side_{k + 1}_{name}": around[k] for k in range(4)},
            f"free_{name}": (reach < FREE).sum(axis=0).astype(float),
        }
    return columns


def _of_neighbours(
    pairs: IntArray, contact: dict[str, FloatArray], sizes: FloatArray, count: int
) -> dict[str, FloatArray]:
    """Return how many neighbours every piece has, and how many small ones that touch nothing else."""
    small, large = pairs.T
    touches = contact["gap"] <= _TOUCH
    degree = np.bincount(pairs.reshape(-1), minlength=count).astype(float)
    touching = np.bincount(pairs[touches].reshape(-1), minlength=count).astype(float)
    riding = (degree[small] == 1) & (sizes[small] < _HANDLE * sizes[large])
    bigger = np.bincount(small, minlength=count).astype(float)
    return {
        "degree": degree,
        "touching": touching,
        "riders": np.bincount(large[riding], minlength=count).astype(float),
        "bigger": bigger,
    }


def _of_boxes(grid: Lattice, pairs: IntArray, sizes: FloatArray) -> dict[str, FloatArray]:
    """Return how the boxes of a pair lie."""
    low, high = grid.bounds[:, 0], grid.bounds[:, 1]
    small, large = pairs.T
    extents = high - low + 1e-9
    common = np.minimum(high[small], high[large]) - np.maximum(low[small], low[large])
    share = np.clip(common, 0.0, None) / extents[small]
    planes = np.concatenate([low, high], axis=1)
    flush = np.abs(planes[small] - planes[large]) <= _FLUSH
    centre = 0.5 * (low + high)
    away = np.abs(centre[small] - centre[large])
    sides = np.sort(away[:, :2], axis=1)
    around = np.sort(share[:, :2], axis=1)
    return {
        "size_ratio": sizes[small] / np.maximum(sizes[large], 1e-9),
        "common": np.clip(share, 0, 1).prod(axis=1),
        "common_up": share[:, 2],
        "common_side_1": around[:, 0],
        "common_side_2": around[:, 1],
        "flush": flush.sum(axis=1).astype(float),
        "flush_up": flush[:, [2, 5]].sum(axis=1).astype(float),
        "away_up": centre[small, 2] - centre[large, 2],
        "away_side_1": sides[:, 0],
        "away_side_2": sides[:, 1],
    }


def _blocked(grid: Lattice, pairs: IntArray) -> dict[str, FloatArray]:
    """Return what of the smaller piece meets the larger one along each axis, beyond what meets it at rest."""
    small, large = pairs.T
    hits = grid.met[:, :, small, large] / grid.sizes[small]
    columns = {f"blocked_{name}": column for name, column in freedom_columns(hits).items()}
    ways = {f"ways_{name}": columns.pop(f"blocked_free_{name}") for name in ("short", "middle", "far")}
    return {"rest_common": grid.at_rest[small, large] / grid.sizes[small], **columns, **ways}


def _of_twins(of_piece: dict[str, FloatArray], pairs: IntArray) -> dict[str, FloatArray]:
    """Test whether the pair is congruent, as far as sizes tell; also adds how many twins each piece has."""
    shape = np.stack([of_piece[name] for name in ("thin", "middle", "long", "fill")], axis=1)
    length = shape[:, 2]
    alike = np.ones((len(shape), len(shape)), dtype=bool)
    for k in range(3):
        alike &= np.abs(shape[:, None, k] - shape[None, :, k]) <= _TWIN * np.maximum(length[:, None], length[None])
    alike &= np.abs(shape[:, None, 3] - shape[None, :, 3]) <= 0.05 * np.maximum(shape[:, None, 3], shape[None, :, 3])
    of_piece["twins"] = alike.sum(axis=1) - 1.0
    return {"twin": alike[pairs[:, 0], pairs[:, 1]].astype(float)}
