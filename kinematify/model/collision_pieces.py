"""The collision geometry of a model as primitives and convex pieces, because engines see every mesh as its hull."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.pieces import connected_pieces
from kinematify.geometry.convex import ConvexPiece, convex_piece
from kinematify.geometry.cut import Concave, CutSurface
from kinematify.geometry.cut_cache import cached_cuts
from kinematify.geometry.scene import judged_shapes
from kinematify.robot.raw_mesh import RawMesh
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import transformed
from kinematify.robot.vectors import as_one, crossed, lengths_of, referenced

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config.validation import PrepareSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Link, LinkMesh, Robot, Shape


_KEPT = ("box", "cylinder", "sphere")
"""Primitives that all engines have; capsules become meshes."""
_WELD = 1e-6
"""Vertices nearer than this fraction of the diagonal are one."""
_FILLED = 3.0
"""A surface that was not cut is said to be filled if its hull reaches so many times beyond what is tolerated."""


class Method(StrEnum):
    """Method by which the collision geometry of a link became convex pieces, the least work first."""

    NONE = "none"
    """The link has no geometry."""
    PRIMITIVES = "primitives"
    """Boxes, cylinders and spheres, as they are."""
    CONVEX = "convex"
    """The meshes are convex within the tolerance: their hulls are they."""
    COMPONENTS = "components"
    """Each connected component is convex within the tolerance."""
    CUT = "cut"
    """Concave meshes were cut into nearly convex pieces."""
    HULL = "hull"
    """A part of the mesh with a hollow was not cut, since cuts did not help or were spent on worse ones."""


_EFFORT = list(Method)


@dataclass(frozen=True, kw_only=True, eq=False)
class Pieces:
    """Convex pieces that the engines collide for one link."""

    primitives: tuple[Shape, ...]
    convex: tuple[ConvexPiece, ...]
    """Link frame."""
    method: Method
    gap: float
    """How far the pieces reach beyond the declared surface at most [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Component:
    """A connected piece of a mesh, or the rest of one that has too many."""

    link: str
    surface: CutSurface
    hull: ConvexPiece
    gap: float
    """How far the hull reaches beyond the surface [m]."""
    tolerance: float
    """How far pieces may [m]."""
    thickness: float
    """Of flat pieces [m]."""
    alone: bool
    """True if it is the whole mesh."""

    @property
    def convex(self) -> bool:
        return self.gap <= self.tolerance


def decomposed(model: Robot, settings: PrepareSettings, *, only: frozenset[str] | None = None) -> dict[str, Pieces]:
    """Return the collision geometry of links, or the visual one where they declare none.

    Args:
        model: The model; hollows that are small beside it are filled.
        settings: Tolerances and how many cuts.
        only: Links that are asked for; all if absent.
    """
    size, asked = _diagonal(model), [link for link in model.links if only is None or link.name in only]
    components = [
        component
        for link in asked
        for shape in judged_shapes(link)
        if shape.kind not in _KEPT
        for component in _components(link, shape.mesh, size, settings)
    ]
    concave = [component for component in components if not component.convex]
    pieces = dict(zip(map(id, concave), _cut(concave, len(model.links), settings), strict=True))
    return {
        link.name: _pieces(link, [(item, pieces.get(id(item))) for item in components if item.link == link.name])
        for link in asked
    }


def _diagonal(model: Robot) -> float:
    """Diagonal of the box around the collision geometry at zero [m]; 0 where there is none."""
    poses = forward_kinematics(model, {})
    ends = [
        end(transformed(shape.mesh.vertices, poses[link.name]), axis=0)
        for link in model.links
        for shape in judged_shapes(link)
        if len(shape.mesh.vertices)
        for end in (np.min, np.max)
    ]
    return float(np.linalg.norm(np.ptp(np.array(ends), axis=0))) if ends else 0.0


def _components(link: Link, mesh: LinkMesh, size: float, settings: PrepareSettings) -> list[_Component]:
    parts = sorted(
        connected_pieces(RawMesh(name="", vertices=mesh.vertices, faces=mesh.faces), _WELD),
        key=lambda part: -float(np.linalg.norm(np.ptp(part.vertices, axis=0))),
    )
    if not parts:
        return []
    diagonal = float(np.linalg.norm(np.ptp(referenced(mesh.vertices, mesh.faces), axis=0)))
    surfaces = [CutSurface(part.vertices, part.faces) for part in parts[: settings.most_components]]
    if len(parts) > settings.most_components:
        surfaces.append(_joined(parts[settings.most_components :]))
    tolerance = max(settings.link_gap * diagonal, settings.model_gap * size)
    thickness = max(settings.thickness * diagonal, settings.least_thickness)
    found: list[_Component] = []
    for surface in surfaces:
        hull = convex_piece(surface.vertices, thickness=thickness, directions=settings.corners)
        if any(item.convex and _inside(surface.vertices, item.hull) for item in found):
            continue
        found.append(
            _Component(
                link=link.name,
                surface=surface,
                hull=hull,
                gap=surface.gap(hull, tolerance),
                tolerance=tolerance,
                thickness=thickness,
                alone=len(surfaces) == 1,
            )
        )
    return found


def _joined(parts: Sequence[RawMesh]) -> CutSurface:
    return CutSurface(*as_one((part.vertices, part.faces) for part in parts))


def _inside(points: FloatArray, hull: ConvexPiece) -> bool:
    """True if all points lie in a convex piece: nothing touches them there."""
    if np.any(points.min(axis=0) < hull.low) or np.any(points.max(axis=0) > hull.high):
        return False
    a, b, c = (hull.vertices[hull.faces[:, k]] for k in range(3))
    normals = crossed(b - a, c - a)
    return bool(np.all(points @ normals.T <= np.einsum("ij,ij->i", a, normals)))


def _cut(concave: Sequence[_Component], links: int, settings: PrepareSettings) -> list[list[ConvexPiece]]:
    """Pieces of each concave component; one piece where there were not enough cuts."""
    bodies = [Concave(surface=item.surface, tolerance=item.tolerance, thickness=item.thickness) for item in concave]
    return cached_cuts(bodies, max(settings.cuts, settings.cuts_per_link * links), settings)


def _pieces(link: Link, parts: Sequence[tuple[_Component, list[ConvexPiece] | None]]) -> Pieces:
    """Put the pieces of a link together; what could not be cut keeps its hull."""
    shapes = judged_shapes(link)
    primitives = tuple(shape for shape in shapes if shape.kind in _KEPT)
    convex: list[ConvexPiece] = []
    methods = [Method.PRIMITIVES if primitives else Method.NONE]
    gaps = [0.0]
    for component, cut in parts:
        if cut is not None and len(cut) > 1:
            methods.append(Method.CUT)
            convex += cut
            gaps.append(max(component.surface.gap(piece, component.tolerance) for piece in cut))
            continue
        simple = Method.CONVEX if component.alone else Method.COMPONENTS
        methods.append(Method.HULL if component.gap > _FILLED * component.tolerance else simple)
        convex.append(component.hull)
        gaps.append(component.gap)
    return Pieces(
        primitives=primitives,
        convex=tuple(convex),
        method=max(methods, key=_EFFORT.index),
        gap=max(gaps),
    )


_NEIGHBOURS = 8
"""Nearest pieces that one is tried with."""


def fewer_pieces(pieces: Sequence[ConvexPiece], most: int, *, thickness: float, corners: int) -> list[ConvexPiece]:
    """Join pieces until there are at most so many, two by two, those first whose hull is least larger than both.

    Args:
        pieces: Any number.
        most: At least 1.
        thickness: Of flat pieces [m].
        corners: Vertices of a piece at most.
    """
    alive = dict(enumerate(pieces))
    waiting: list[tuple[float, int, int, ConvexPiece]] = []

    def offer(number: int) -> None:
        one = alive[number]
        others = [other for other in alive if other != number]
        middles = np.array([alive[other].low + alive[other].high for other in others])
        for place in np.argsort(lengths_of(middles - one.low - one.high), kind="stable")[:_NEIGHBOURS]:
            other = alive[others[place]]
            points = np.concatenate([one.vertices, other.vertices])
            hull = convex_piece(points, thickness=thickness, directions=corners)
            heapq.heappush(waiting, (hull.volume - one.volume - other.volume, number, others[place], hull))

    if len(alive) > most:
        for number in list(alive):
            offer(number)
    following = len(alive)
    while len(alive) > most:
        _, first, second, hull = heapq.heappop(waiting)
        if first in alive and second in alive:
            del alive[first], alive[second]
            alive[following] = hull
            if len(alive) > most:
                offer(following)
            following += 1
    return list(alive.values())
