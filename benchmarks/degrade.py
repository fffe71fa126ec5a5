"""Meshes as generators, scanners and hasty exports leave them; every operator is seeded and leaves the truth alone.

Each takes the parts of an object and returns as many, in the same order, under the same names. Lengths are shares of
the object's diagonal.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import fast_simplification
import igl
import numpy as np

from kinematify.assembly.part import Assembly, Part
from kinematify.geometry.convex import convex_hull, thickened
from kinematify.geometry.surface import PartSurface
from kinematify.robot.weld import welded

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.random import Generator

    Degrade = Callable[[Assembly, Generator], Assembly]

VERTEX_NOISE = 5e-4
"""Standard deviation of the place of every vertex."""
HOLES = 0.05
"""Share of the faces that are dropped."""
GROWN = 0.005
"""What every part grows by on each side of its box, so that neighbours stand in each other by up to twice as much."""
GAP = 0.01
"""Gap that opens between touching parts."""
OPEN_REACH = 2.5e-3
"""Faces this near to another part are missing from parts that were cut out of one shell."""
_OPEN_MOST = 0.5  # share of a part's area that goes missing at most
_NEARLY = 1.1  # times the faces that were asked for
_HULL_THICKNESS = 1e-4  # flat parts get a hull of this thickness


def voxels(resolution: int) -> Degrade:
    """Remesh every part on a grid of 1/`resolution` of the diagonal."""

    def remeshed(assembly: Assembly, rng: Generator) -> Assembly:
        # Exact signed distances come with torch, which takes seconds to import.
        from benchmarks.voxels import voxel_remeshed  # noqa: PLC0415

        seed = int(rng.integers(2**31))
        return with_parts(
            assembly, [voxel_remeshed(part, assembly.diagonal / resolution, seed=seed) for part in assembly.parts]
        )

    return remeshed


def vertex_noise(assembly: Assembly, rng: Generator) -> Assembly:
    """Vertices at one place move together, so that meshes stay closed."""

    def shaken(part: Part) -> Part:
        places, index = np.unique(part.vertices, axis=0, return_inverse=True)
        moved = places + VERTEX_NOISE * assembly.diagonal * rng.normal(size=places.shape)
        return replace(part, vertices=moved[index.reshape(-1)])

    return with_parts(assembly, [shaken(part) for part in assembly.parts])


def decimated(faces: int) -> Degrade:
    """Collapse edges until every part has at most about `faces` faces."""

    def fewer(part: Part) -> Part:
        if len(part.faces) <= faces:
            return part
        vertices, triangles = welded(part.vertices, part.faces, 1e-7)
        thin = igl.qslim(np.asfortranarray(vertices), np.asfortranarray(triangles.astype(np.int32)), faces)[:2]
        for haste in (3, 5, 7):
            if 0 < len(thin[1]) <= _NEARLY * faces:
                break  # else it met an edge of more than two faces; the other one is rougher the hastier it is
            thin = fast_simplification.simplify(vertices.copy(), triangles.copy(), target_count=faces, agg=haste)
        return replace(part, vertices=np.asarray(thin[0], dtype=np.float64), faces=np.asarray(thin[1], dtype=np.int64))

    return lambda assembly, rng: with_parts(assembly, [fewer(part) for part in assembly.parts])


def hulls(assembly: Assembly, rng: Generator) -> Assembly:
    """Every part becomes its convex hull."""

    def hull(part: Part) -> Part:
        points = part.vertices[np.unique(part.faces)]
        vertices, faces = convex_hull(thickened(points, _HULL_THICKNESS * assembly.diagonal))
        return replace(part, vertices=vertices, faces=faces)

    return with_parts(assembly, [hull(part) for part in assembly.parts])


def holes(assembly: Assembly, rng: Generator) -> Assembly:
    """Single faces are missing, at random."""

    def pierced(part: Part) -> Part:
        kept = rng.permutation(len(part.faces))[: max(round((1.0 - HOLES) * len(part.faces)), 1)]
        return replace(part, faces=part.faces[np.sort(kept)])

    return with_parts(assembly, [pierced(part) for part in assembly.parts])


def flipped(assembly: Assembly, rng: Generator) -> Assembly:
    """Every second face, at random, is turned inside out."""

    def turned(part: Part) -> Part:
        faces = part.faces.copy()
        chosen = rng.random(len(faces)) < 0.5
        faces[chosen] = faces[chosen][:, ::-1]
        return replace(part, faces=faces)

    return with_parts(assembly, [turned(part) for part in assembly.parts])


def gaps(assembly: Assembly, rng: Generator) -> Assembly:
    """Every part shrinks about the middle of its box by half a gap on each side, but to no less than half."""
    return with_parts(assembly, [_resized(part, -0.5 * GAP * assembly.diagonal) for part in assembly.parts])


def interpenetrating(assembly: Assembly, rng: Generator) -> Assembly:
    """Every part grows about the middle of its box on each side, but to no more than one and a half."""
    return with_parts(assembly, [_resized(part, GROWN * assembly.diagonal) for part in assembly.parts])


def _resized(part: Part, by: float) -> Part:
    middle, sides = part.bounds.mean(axis=0), np.ptp(part.bounds, axis=0)
    factors = np.clip(1.0 + 2.0 * by / np.maximum(sides, 1e-12), 0.5, 1.5)
    return replace(part, vertices=middle + factors * (part.vertices - middle))


def opened(assembly: Assembly, rng: Generator) -> Assembly:
    """Parts lack their surface where they lie on another one, as if cut out of one closed shell.

    The nearest faces go first; half of a part's area is kept in any case.
    """
    surfaces = [PartSurface(part, crease_angle=0.5) for part in assembly.parts]
    reach = OPEN_REACH * assembly.diagonal
    return with_parts(assembly, [_without_covered(k, assembly, surfaces, reach) for k in range(len(assembly.parts))])


def _without_covered(k: int, assembly: Assembly, surfaces: list[PartSurface], reach: float) -> Part:
    part = assembly.parts[k]
    corners = part.vertices[part.faces]
    probes = np.concatenate([corners, corners.mean(axis=1, keepdims=True)], axis=1)
    farthest = np.full(len(part.faces), np.inf)
    lower, upper = part.bounds[0] - reach, part.bounds[1] + reach
    for other, surface in zip(assembly.parts, surfaces, strict=True):
        if other is part or (other.bounds[0] > upper).any() or (other.bounds[1] < lower).any():
            continue
        distances = surface.distance(probes.reshape(-1, 3)).reshape(-1, 4)
        farthest = np.minimum(farthest, distances.max(axis=1))
    order = np.argsort(farthest, kind="stable")
    share = np.cumsum(part.face_areas[order]) / max(part.area, 1e-300)
    gone = order[(farthest[order] <= reach) & (share <= _OPEN_MOST)]
    return replace(part, faces=np.delete(part.faces, gone, axis=0))


DEGRADATIONS: Mapping[str, Degrade] = {
    "voxels-300": voxels(300),
    "voxels-150": voxels(150),
    "vertex-noise": vertex_noise,
    "faces-1000": decimated(1000),
    "faces-300": decimated(300),
    "hulls": hulls,
    "holes": holes,
    "flipped": flipped,
    "gaps": gaps,
    "interpenetration": interpenetrating,
    "open": opened,
}
"""Name of a degradation -> what it does to an object."""


def with_parts(assembly: Assembly, parts: list[Part]) -> Assembly:
    """The assembly with other parts."""
    return Assembly(parts=tuple(parts), source=assembly.source)
