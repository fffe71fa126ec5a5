"""Parts that were one before somebody cut them: their open rims coincide edge for edge, and the surface goes on.

Where a mesh is cut along its edges or by a plane (labels per face, automatic segmentation), both sides keep the same
vertices there. That alone proves nothing: the parts of many collections are cut out of one closed shell, a knob along
its foot, a door along its frame. There the surface mostly turns a corner; where one part was cut in two it goes
straight on. Doors that lie flush in the body that they close go straight on as well. What tells them from a cut is that
a plane that goes through a part crosses its surface and leaves no rim in it that is not common, while a door's outline
lies in the surface, or has another one towards the inside. A door's outline is also at most some six times as long as
the door is big, both its sides together, while a ragged cut through boards and walls is longer.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from kinematify.assembly.part import Assembly, Part
from kinematify.contact.build_graph import near_pairs
from kinematify.robot.exact_faces import joined_faces
from kinematify.robot.vectors import as_one, lengths_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from kinematify.config import SeamConfig
    from kinematify.contact.graph import Pair
    from kinematify.geometry.surface import PartSurface
    from kinematify.robot.arrays import BoolArray, FloatArray

_LINE = 1e-3  # what is narrower than this share of its length is a line
_SMOOTH = np.cos(np.radians(30.0))  # facets of a cylinder of 12 sides go on


def find_cuts(assembly: Assembly, surfaces: Sequence[PartSurface], config: SeamConfig) -> dict[Pair, float]:
    """Pairs (a < b) that were one part beyond doubt, with the length of the seam [m]; the base link may be among them.

    Args:
        assembly: The parts.
        surfaces: Derived geometry of each part, same order.
        config: What counts as a cut.
    """
    return {pair: seam.length for pair, seam in _seams(assembly, surfaces, config) if seam.goes_through(config)}


def rigid_pieces(n: int, seams: dict[Pair, float]) -> tuple[tuple[int, ...], ...]:
    """Groups of parts that seams hold together, each ascending; single parts are groups of one."""
    rows, columns = [a for a, _ in seams], [b for _, b in seams]
    labels = connected_components(coo_matrix((np.ones(len(seams)), (rows, columns)), shape=(n, n)), directed=False)[1]
    return tuple(tuple(np.flatnonzero(labels == label).tolist()) for label in range(int(labels.max()) + 1))


def joined(assembly: Assembly, groups: tuple[tuple[int, ...], ...]) -> Assembly:
    """The assembly with every group as one part, named after its largest piece; part i is group i."""
    return Assembly(parts=tuple(_one(assembly, group) for group in groups), source=assembly.source)


def largest_piece(assembly: Assembly, group: tuple[int, ...]) -> int:
    """The piece that the others are fixed to."""
    return max(group, key=lambda part: (assembly.parts[part].area, -part))


def _one(assembly: Assembly, group: tuple[int, ...]) -> Part:
    main = assembly.parts[largest_piece(assembly, group)]
    if len(group) == 1:
        return main
    parts = [assembly.parts[index] for index in group]
    vertices, faces = as_one((part.vertices, part.faces) for part in parts)
    return Part(
        name=main.name,
        vertices=vertices,
        faces=faces,
        color=main.color,
        density=main.density,
        exact=joined_faces([part.exact for part in parts]),
    )


@dataclass(frozen=True, kw_only=True)
class _Seam:
    """Edges that the rims of two parts have in common."""

    length: float
    """[m]."""
    smooth: float
    """Share of the length over which the surface goes on."""
    bend: float
    """Distance from the plane of the seam, as a share of its size (both root mean square)."""
    complete: float
    """Share of the rims in that plane that is common; that of the part where it is smaller."""
    facing: float
    """Cosine between the surface and that plane, mean size: 0 where the plane crosses it, 1 where it lies in it."""
    line: bool
    """It is one straight line, as where a sheet was cut, or where corners happen to meet."""
    smaller: float
    """Diagonal of the smaller part [m]."""

    def goes_through(self, config: SeamConfig) -> bool:
        """True if one part was cut in two there, by a plane or along the edges of its mesh."""
        straight = self.smooth >= config.through_smooth and self.bend <= config.through_planar
        through = self.long(config) if self.line else self.facing <= config.through_facing
        flat = straight and self.complete >= config.through_complete and through
        return flat or self.smooth * self.length > config.ragged * self.smaller

    def long(self, config: SeamConfig) -> bool:
        """True if the surface goes on over about the size of the smaller part."""
        return self.smooth * self.length > config.share * self.smaller


def _seams(assembly: Assembly, surfaces: Sequence[PartSurface], config: SeamConfig) -> Iterator[tuple[Pair, _Seam]]:
    tolerance = config.tolerance * assembly.diagonal
    for a, b in near_pairs(assembly, tolerance):
        smaller = min(assembly.parts[part].diagonal for part in (a, b))
        seam = _seam(surfaces[a].rim, surfaces[b].rim, tolerance, config, smaller=smaller)
        if seam is not None:
            yield (a, b), seam


def _seam(
    first: tuple[FloatArray, FloatArray],
    second: tuple[FloatArray, FloatArray],
    tolerance: float,
    config: SeamConfig,
    *,
    smaller: float,
) -> _Seam | None:
    """Return what two rims, their edges (n, 2, 3) and normals (n, 3), have in common; None where that is nothing."""
    if not len(first[0]) or not len(second[0]):
        return None
    mine, partner = _common(first[0], second[0], tolerance)
    lengths = lengths_of(first[0][mine, 0] - first[0][mine, 1])
    if lengths.sum() <= tolerance:
        return None
    theirs, _ = _common(second[0], first[0], tolerance)
    straight = np.abs(np.einsum("nd,nd->n", first[1][mine], second[1][partner])) > _SMOOTH
    ends = first[0][mine].reshape(-1, 3)
    centre, normal, bend, line = _plane(ends, np.repeat(lengths, 2))
    reach = max(tolerance, config.through_planar * float(np.ptp(ends, axis=0).max()))
    return _Seam(
        length=float(lengths.sum()),
        smooth=float(lengths @ straight / lengths.sum()),
        bend=bend,
        facing=float(lengths @ np.abs(first[1][mine] @ normal) / lengths.sum()),
        line=line,
        smaller=smaller,
        complete=min(
            _share_in_plane(rim, common, centre, normal, reach)
            for rim, common in ((first[0], mine), (second[0], theirs))
        ),
    )


def _common(ends: FloatArray, others: FloatArray, tolerance: float) -> tuple[BoolArray, NDArray[np.int64]]:
    """Which edges (n, 2, 3) are among others, shape (n,), and which one each of these is."""
    distance, nearest = cKDTree(others.mean(axis=1)).query(ends.mean(axis=1), distance_upper_bound=tolerance)
    found = np.isfinite(distance)
    mine, theirs = ends[found], others[nearest[found]]
    straight = lengths_of((mine - theirs).reshape(-1, 3)).reshape(-1, 2).max(axis=1)
    swapped = lengths_of((mine - theirs[:, ::-1]).reshape(-1, 3)).reshape(-1, 2).max(axis=1)
    same = np.minimum(straight, swapped) <= tolerance
    common = found.copy()
    common[found] = same
    return common, nearest[common]


def _plane(points: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray, float, bool]:
    """Centre, unit normal and bend of the plane that fits weighted points (n, 3) best, and whether they are a line."""
    centre = np.average(points, axis=0, weights=weights)
    spread = ((points - centre) * weights[:, None]).T @ (points - centre)
    values, vectors = np.linalg.eigh(spread)
    bend, width = np.sqrt(np.maximum(values[:2], 0.0) / max(values.sum(), 1e-300))
    return centre, vectors[:, 0], float(bend), bool(width < _LINE)


def _share_in_plane(ends: FloatArray, common: BoolArray, centre: FloatArray, normal: FloatArray, reach: float) -> float:
    """Length of the common edges over that of all edges of a rim (n, 2, 3) within `reach` [m] of a plane."""
    lengths = lengths_of(ends[:, 0] - ends[:, 1])
    inside = np.abs((ends - centre) @ normal).max(axis=1) <= reach
    return float(lengths[common].sum() / max(lengths[inside | common].sum(), 1e-300))
