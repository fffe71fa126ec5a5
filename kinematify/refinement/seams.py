"""Parts that were one before somebody cut them: their open rims coincide edge for edge, and the surface goes on.

Where a mesh is cut along its edges (labels per face, automatic segmentation), both sides keep the same vertices there.
That alone proves nothing: the parts of many collections are cut out of one closed shell, a knob along its foot, a door
along its frame. There the surface mostly turns a corner; where one part was cut in two it goes straight on. Doors
that lie flush in the body that they close go straight on as well, so that the base is never joined with anything.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from kinematify.assembly.part import Assembly, Part
from kinematify.contact.build import near_pairs

if TYPE_CHECKING:
    from kinematify.assembly.part import FloatArray
    from kinematify.config import RefineConfig

Pair = tuple[int, int]

_SMOOTH = np.cos(np.radians(30.0))  # facets of a cylinder of 12 sides go on


def find_seams(assembly: Assembly, root: int, config: RefineConfig) -> dict[Pair, float]:
    """Pairs (a < b) that are one part cut in two, with the length of the seam [m].

    Args:
        assembly: The parts.
        root: The base link, which is left out.
        config: `seam_share`, `seam_smooth` and `seam_tolerance`.
    """
    tolerance = config.seam_tolerance * assembly.diagonal
    rims = [_rim(part) for part in assembly.parts]
    found = {}
    for a, b in near_pairs(assembly, tolerance):
        if root in (a, b):
            continue
        seam, smooth = _common(rims[a], rims[b], tolerance)
        smaller = min(assembly.parts[a].diagonal, assembly.parts[b].diagonal)
        if smooth > config.seam_share * smaller and smooth > config.seam_smooth * seam:
            found[a, b] = seam
    return found


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
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    return Part(
        name=main.name,
        vertices=np.concatenate([part.vertices for part in parts]),
        faces=np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)]),
        color=main.color,
        density=main.density,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Rim:
    """Edges that one face alone has."""

    ends: FloatArray
    """World frame [m], shape (n, 2, 3)."""
    normals: FloatArray
    """Unit normals of their faces, shape (n, 3)."""


def _rim(part: Part) -> _Rim:
    places, index = np.unique(part.vertices, axis=0, return_inverse=True)
    faces = index.reshape(-1)[part.faces]
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(faces)), 3)
    unique, first, counts = np.unique(edges, axis=0, return_index=True, return_counts=True)
    single = (counts == 1) & (unique[:, 0] != unique[:, 1])
    corners = places[faces[owner[first[single]]]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    return _Rim(ends=np.asarray(places[unique[single]]), normals=normals)


def _common(first: _Rim, second: _Rim, tolerance: float) -> tuple[float, float]:
    """Length of the edges of one rim that are edges of the other one, and of those over which the surface goes on."""
    if not len(first.ends) or not len(second.ends):
        return 0.0, 0.0
    near = cKDTree(second.ends.mean(axis=1)).query(first.ends.mean(axis=1), distance_upper_bound=tolerance)
    rows = np.flatnonzero(np.isfinite(near[0]))
    others = near[1][rows]
    mine, theirs = first.ends[rows], second.ends[others]
    straight = np.linalg.norm(mine - theirs, axis=2).max(axis=1)
    swapped = np.linalg.norm(mine - theirs[:, ::-1], axis=2).max(axis=1)
    same = np.minimum(straight, swapped) <= tolerance
    lengths = np.linalg.norm(mine[:, 0] - mine[:, 1], axis=1) * same
    smooth = np.abs(np.einsum("nd,nd->n", first.normals[rows], second.normals[others])) > _SMOOTH
    return float(lengths.sum()), float((lengths * smooth).sum())
