"""Parts with pieces broken off: how files look that keep handles, feet, shelves and labels as parts of their own.

The truth of a broken-off piece is that it is fixed to the part that it was broken off. So every object, whoever made
it, teaches what rigidly belongs together. A part of several connected pieces loses some of them; one of a single piece
loses what stands out of a plane in which much of its surface lies.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import trimesh

from kinematify.assembly.part import Part
from kinematify.assembly.pieces import connected_pieces
from kinematify.assembly.truth import GroundTruth, TrueJoint
from kinematify.robot.joint_type import JointType
from kinematify.robot.raw_mesh import RawMesh
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray

_MOST = 5  # parts of an object that lose pieces to become parts
_MOST_OF_PART = 2
_MOST_PROTRUSIONS = 4
_LEAST_AREA = 0.004  # of the part's surface
_LEAST_FACES = 4
_WELD = 1e-6
_PLANE = 0.03  # of the surface lies in a plane worth cutting along
_PLANES_TRIED = 6
_LEAST_HEIGHT = 0.01  # of the part's diagonal above the plane
_MOST_CUT = 0.5  # of what is left


def with_pieces_broken_off(
    parts: Sequence[Part], truth: GroundTruth, rng: np.random.Generator
) -> tuple[tuple[Part, ...], GroundTruth]:
    """Make pieces of some parts parts of their own, fixed to the rest of what they were of.

    Args:
        parts: In the order of the truth.
        truth: Of the parts.
        rng: Draws which pieces.

    Returns:
        The given parts, lessened by what was broken off, then the pieces; and the truth of them all. Both are as they
        were where no part has a piece to lose.
    """
    found, broken, joints = list(parts), list[Part](), list[TrueJoint]()
    for index in rng.permutation(len(parts)):
        lost = _broken(parts[index], rng) if len(broken) < _MOST else None
        if lost is None:
            continue
        found[index], pieces = lost
        for piece in pieces:
            child = len(parts) + len(broken)
            broken.append(replace(piece, name=f"part_{child:03d}"))
            joints.append(_fixed(int(index), child, piece))
    names = tuple(part.name for part in (*found, *broken))
    links = (*truth.part_links, *(() for _ in broken))
    whole = replace(truth, part_names=names, part_links=links, joints=(*truth.joints, *joints))
    return (*found, *broken), whole


def _broken(part: Part, rng: np.random.Generator) -> tuple[Part, list[Part]] | None:
    """What is left of a part, and what is broken off it; None where nothing can be."""
    pieces = _pieces(part)
    if len(pieces) == 1:
        return _protrusions(part, rng)
    loose = [piece for piece in pieces[1:] if _substantial(piece, part)]
    drawn = [loose[k] for k in rng.permutation(len(loose))[:_MOST_OF_PART]]
    return (_without(part, drawn), drawn) if drawn else None


def _pieces(part: Part) -> list[Part]:
    """Connected pieces of a part but slivers, largest first."""
    mesh = RawMesh(name=part.name, vertices=part.vertices, faces=part.faces)
    found = [Part(name=part.name, vertices=p.vertices, faces=p.faces) for p in connected_pieces(mesh, _WELD)]
    return sorted((piece for piece in found if len(piece.faces) >= _LEAST_FACES), key=lambda piece: -piece.area)


def _substantial(piece: Part, part: Part) -> bool:
    """It is no crumb and not flat."""
    extents = piece.bounds[1] - piece.bounds[0]
    return bool(piece.area > _LEAST_AREA * part.area and extents.min() > 1e-3 * extents.max())


def _without(part: Part, pieces: Sequence[Part]) -> Part:
    """The part less the triangles of pieces."""
    gone = {tuple(centre) for piece in pieces for centre in _centres(piece)}
    kept = np.array([tuple(centre) not in gone for centre in _centres(part)])
    return replace(part, faces=part.faces[kept])


def _centres(part: Part) -> FloatArray:
    return np.asarray(np.round(part.vertices[part.faces].mean(axis=1), 9))


def _protrusions(part: Part, rng: np.random.Generator) -> tuple[Part, list[Part]] | None:
    """The part cut along a plane of its surface, and all that stood out of it."""
    mesh = trimesh.Trimesh(part.vertices, part.faces)
    planes = _planes(part)
    for k in rng.permutation(len(planes))[:_PLANES_TRIED]:
        origin, normal = planes[k]
        if float(((part.vertices - origin) @ normal).max()) < _LEAST_HEIGHT * part.diagonal:
            continue
        try:
            off, rest = (mesh.slice_plane(origin, side * normal, cap=True) for side in (1.0, -1.0))
        except ValueError:  # an open surface cannot be closed along the cut
            continue
        if len(rest.faces) < _LEAST_FACES or not 0.0 < off.area < _MOST_CUT * rest.area:
            continue
        pieces = _pieces(Part(name=part.name, vertices=off.vertices, faces=off.faces))
        if 0 < len(pieces) <= _MOST_PROTRUSIONS and all(_substantial(piece, part) for piece in pieces):
            return replace(part, vertices=rest.vertices, faces=rest.faces), pieces
    return None


def _planes(part: Part) -> list[tuple[FloatArray, FloatArray]]:
    """Point and outward normal of every plane in which much of the surface lies."""
    corners = part.vertices[part.faces]
    normals = crossed(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = normals / np.maximum(lengths_of(normals), 1e-15)[:, None]
    height = np.einsum("nk,nk->n", normals, corners[:, 0]) / part.diagonal
    keys = np.round(np.column_stack([normals, height]), 3) + 0.0
    _, first, plane = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    share = np.bincount(plane.ravel(), part.face_areas) / part.area
    return [(corners[k, 0], normals[k]) for k in first[share > _PLANE]]


def _fixed(parent: int, child: int, piece: Part) -> TrueJoint:
    return TrueJoint(
        name=f"fixed_{child}",
        source="",
        kind=JointType.FIXED,
        parent=parent,
        child=child,
        axis=np.zeros(3),
        pivot=piece.centroid,
        lower=0.0,
        upper=0.0,
        value=0.0,
    )
