"""Exact signed distances to a part, and a grid of them that torch can differentiate (paper III-B)."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import torch
from scipy import ndimage

from kinematify.geometry.mesh_trees import DistanceTree, WindingTree

if TYPE_CHECKING:
    from torch import Tensor

    from kinematify.assembly.part import Part
    from kinematify.config import SdfConfig
    from kinematify.robot.arrays import BoolArray, FloatArray

# Longest edge for winding numbers, fraction of the part's extent: between 1/4 and 1/16 they are quickest.
_WINDING_EDGE = 0.125
# No more triangles than this after bisection: 100 MB of search structure.
_WINDING_FACES = 500_000


def exact_signed_distance(part: Part, points: FloatArray) -> FloatArray:
    """Signed distance to `part` [m], negative inside, world points (n, 3) -> (n,).

    The sign is that of the generalised winding number, so it holds for meshes with holes, for solids that overlap
    and for meshes turned inside out. An open shell has no inside except the pocket that it closes off by more than
    half of the view.
    """
    surface = _Surface(part)
    distances = surface.closest(points)[0]
    return np.where(np.abs(surface.winding(points)) > 0.5, -distances, distances)


class _Surface:
    """Search structures over the triangles of one part; built once."""

    def __init__(self, part: Part) -> None:
        # The vertices are centred, for far from the origin the squares would eat the digits.
        self._origin: FloatArray = part.bounds.mean(axis=0)
        self._triangles = part.vertices[part.faces] - self._origin
        self._tree = DistanceTree(part.vertices - self._origin, part.faces)

    def closest(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distances (n,) and nearest surface points in the world frame (n, 3)."""
        distances, _, nearest = self._tree.nearest(points - self._origin)
        return distances, nearest + self._origin

    def winding(self, points: FloatArray) -> FloatArray:
        """Generalised winding number, 1 inside and 0 outside a closed mesh, (n,)."""
        return self._solid.numbers(points - self._origin)

    @cached_property
    def _solid(self) -> WindingTree:
        """The same surface in triangles without long edges.

        Winding numbers are quick because far clusters of triangles are summed up; a fan of needles, as on the cap of
        a cylinder, is never far, and would be 20 times as slow.
        """
        longest = _WINDING_EDGE * float(np.ptp(self._triangles.reshape(-1, 3), axis=0).max())
        triangles = _bisected(self._triangles, longest)
        return WindingTree(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))


def _bisected(triangles: FloatArray, longest: float) -> FloatArray:
    """Halve triangles at their longest edge while that is above `longest` and the number permits, (F, 3, 3)."""
    kept: list[FloatArray] = []
    count, rest = 0, triangles
    while len(rest):
        lengths = np.linalg.norm(rest - rest[:, [1, 2, 0]], axis=2)
        final = (lengths.max(axis=1) <= longest) | (count + len(rest) > _WINDING_FACES)
        kept.append(rest[final])
        count += int(final.sum())
        turned = (lengths[~final].argmax(axis=1)[:, None] + np.arange(3)) % 3
        rest = np.take_along_axis(rest[~final], turned[:, :, None], axis=1)
        middle = 0.5 * (rest[:, 0] + rest[:, 1])
        halves = [np.stack([rest[:, 0], middle, rest[:, 2]], 1), np.stack([middle, rest[:, 1], rest[:, 2]], 1)]
        rest = np.concatenate(halves)
    return np.ascontiguousarray(np.concatenate(kept))


class SignedDistanceGrid:
    """Signed distances on a regular grid around one part, trilinear between its nodes.

    Outside of the grid the field goes on as the value at the nearest point of the box plus the distance to that
    point: continuous, never below the true distance, and growing without bound.
    """

    def __init__(self, part: Part, config: SdfConfig) -> None:
        """Measure the distances; walls thinner than a cell keep their distance but lose their inside.

        Args:
            part: Any mesh with positive extent.
            config: Number of cells, margin and exact band.
        """
        lattice = _lattice(part, config)
        values = _grid_values(part, lattice, config.band_cells)
        self._values = torch.from_numpy(values)[None, None]
        self._lower = torch.from_numpy(lattice.lower.copy())
        self._upper = torch.from_numpy(lattice.lower + lattice.spacing * (np.array(lattice.counts) - 1))
        self.spacing = lattice.spacing

    @property
    def memory_bytes(self) -> int:
        """Memory of the grid [bytes]."""
        return self._values.numel() * self._values.element_size()

    def value(self, points: Tensor) -> Tensor:
        """Signed distance [m] at world points, shape (..., 3) -> (...), differentiable."""
        exact = points.to(torch.float64)
        inside = torch.clamp(exact, self._lower, self._upper)
        unit = (inside - self._lower) / (self._upper - self._lower) * 2.0 - 1.0
        # grid_sample counts axes from the last, so x, y, z are handed over as z, y, x.
        sampled = torch.nn.functional.grid_sample(
            self._values, unit.flip(-1).reshape(1, 1, 1, -1, 3), padding_mode="border", align_corners=True
        )
        return sampled.reshape(exact.shape[:-1]) + _length(exact - inside)


def _length(vectors: Tensor) -> Tensor:
    """Norm over the last dimension with gradient 0 at 0, (..., 3) -> (...); four times as quick as vector_norm."""
    x, y, z = vectors.unbind(-1)
    squares = x * x + y * y + z * z
    zero = squares == 0.0
    return torch.sqrt(squares.masked_fill(zero, 1.0)).masked_fill(zero, 0.0)


@dataclass(frozen=True)
class _Lattice:
    lower: FloatArray
    spacing: float
    counts: tuple[int, int, int]

    def nodes(self, stride: int = 1) -> FloatArray:
        """World positions of every `stride`-th node, shape (nx, ny, nz, 3)."""
        ranges = [np.arange(0, count, stride) for count in self.counts]
        indices = np.stack(np.meshgrid(*ranges, indexing="ij"), axis=-1)
        return np.asarray(self.lower + self.spacing * indices, dtype=np.float64)


def _lattice(part: Part, config: SdfConfig) -> _Lattice:
    """Cubic cells around the part, an even number along each axis, so that every second node reaches the end."""
    margin = config.margin * part.diagonal
    extent = part.bounds[1] - part.bounds[0] + 2.0 * margin
    spacing = float(extent.max()) / config.resolution
    cells = 2 * np.ceil(extent / (2.0 * spacing) - 1e-9).astype(int)
    lower = part.bounds.mean(axis=0) - 0.5 * spacing * cells
    return _Lattice(lower, spacing, (int(cells[0]) + 1, int(cells[1]) + 1, int(cells[2]) + 1))


def _grid_values(part: Part, lattice: _Lattice, band_cells: float) -> FloatArray:
    """Signed distance at every node [m], shape of the lattice.

    Exact within `band_cells` cells of the surface. Further out a node takes the surface point of the nearest node of
    the band (about half a cell too far at worst, and ten times as quick), and the winding number of every second node.
    """
    surface = _Surface(part)
    measured, values, nearest = _exact_band(surface, lattice, band_cells)
    nodes, far = lattice.nodes(), ~measured
    # Of what was measured only an even layer may hand on its surface points; outliers would hand on bad ones.
    close = measured & (values <= band_cells * lattice.spacing)
    source = ndimage.distance_transform_edt(~close, return_distances=False, return_indices=True)
    values[far] = np.linalg.norm(nodes[far] - nearest[tuple(axis[far] for axis in source)], axis=1)
    return np.where(np.abs(_winding(surface, lattice, close)) > 0.5, -values, values)


def _winding(surface: _Surface, lattice: _Lattice, close: BoolArray) -> FloatArray:
    """Winding numbers of all nodes: asked for at `close` ones and every second one, smooth between those."""
    coarse = lattice.nodes(2)
    # One call, for it is the search structure that takes the time.
    asked = surface.winding(np.concatenate([coarse.reshape(-1, 3), lattice.nodes()[close]]))
    winding = _refined(asked[: coarse[..., 0].size].reshape(coarse.shape[:3]))
    winding[close] = asked[coarse[..., 0].size :]
    return winding


def _exact_band(surface: _Surface, lattice: _Lattice, band_cells: float) -> tuple[BoolArray, FloatArray, FloatArray]:
    """Nodes that may be near the surface, from coarse to fine; the others are certainly beyond the band.

    Returns:
        Mask of the measured nodes, their distances [m] (a lower bound elsewhere), and their nearest surface points.
    """
    bound = np.zeros([-(-count // 8) for count in lattice.counts])
    for stride in (4, 2, 1):
        nodes = lattice.nodes(stride)
        index = np.indices(nodes.shape[:3])
        # Distances change by no more than the way, so a coarser node's distance bounds those around it.
        way = stride * lattice.spacing * np.sqrt((index % 2).sum(axis=0))
        bound = bound[tuple(index // 2)] - way
        near = bound <= band_cells * lattice.spacing
        nearest = np.zeros(nodes.shape)
        bound[near], nearest[near] = surface.closest(nodes[near])
    return near, bound, nearest


def _refined(coarse: FloatArray) -> FloatArray:
    """Put the mean between every two neighbours along each axis, shape (n, ...) -> (2n - 1, ...)."""
    fine = coarse
    for axis in range(3):
        lower, upper = (np.take(fine, range(k, fine.shape[axis] - 1 + k), axis=axis) for k in (0, 1))
        wide = np.repeat(fine, 2, axis=axis).take(range(2 * fine.shape[axis] - 1), axis=axis)
        np.moveaxis(wide, axis, 0)[1::2] = np.moveaxis(0.5 * (lower + upper), axis, 0)
        fine = wide
    return fine


class SignedDistanceCache:
    """Grids of one run, keyed by geometry, the longest unused dropped when the memory limit is passed."""

    def __init__(self, config: SdfConfig) -> None:
        """Start empty; all grids of this cache share `config`."""
        self._config = config
        self._grids: OrderedDict[str, SignedDistanceGrid] = OrderedDict()

    def field(self, part: Part) -> SignedDistanceGrid:
        """The grid of `part`, built at the first request."""
        grid = self._grids.pop(part.mesh_hash, None) or SignedDistanceGrid(part, self._config)
        self._grids[part.mesh_hash] = grid
        while len(self._grids) > 1 and self.memory_bytes > self._config.cache_bytes:
            self._grids.popitem(last=False)
        return grid

    @property
    def memory_bytes(self) -> int:
        """Memory of the grids that are kept [bytes]."""
        return sum(grid.memory_bytes for grid in self._grids.values())
