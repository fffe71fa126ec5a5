"""Convex pieces that are boxes, cylinders or spheres, which engines collide exactly and quickest.

Capsules are not among them: URDF has none.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.convex import plain_piece
from kinematify.robot.robot import LinkMesh, Shape
from kinematify.robot.transforms import rotation_from_x
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from kinematify.geometry.convex import ConvexPiece
    from kinematify.robot.arrays import FloatArray

_BOX_CORNERS = np.stack(np.meshgrid([0.0, 1.0], [0.0, 1.0], [0.0, 1.0], indexing="ij"), axis=-1).reshape(8, 3)
_SQUARE = 1e-6
"""A piece is a box if its corners differ from those of one by less than this fraction of its diagonal."""
_ROUND = 1e-3
"""A piece is round if its corners are on a circle or a sphere but for this fraction of its radius."""
_LEAST_CORNERS = 8
"""Of what may stand for a circle."""


def fitted_shape(piece: ConvexPiece, most_beyond: float) -> tuple[Shape, float]:
    """Return the shape that a piece is, and how far that reaches beyond it [m].

    Corners of round pieces lie on their cylinder or sphere, so that nothing is left out.

    Args:
        piece: In the link frame.
        most_beyond: How far a cylinder or a sphere may reach beyond it [m].

    Returns:
        A box, a cylinder, a sphere or a mesh, and a distance that is 0 for boxes and meshes.
    """
    mesh = LinkMesh(vertices=piece.vertices, faces=piece.faces)
    axes = _box_axes(piece)
    if axes is not None:
        along = piece.vertices @ axes.T
        low, high = along.min(axis=0), along.max(axis=0)
        x, y, z = (high - low).tolist()
        return Shape(kind="box", mesh=mesh, size=(x, y, z), T_link_shape=_pose(axes.T, 0.5 * (low + high) @ axes)), 0.0
    for shape, beyond in (_cylinder(piece, mesh), _sphere(piece, mesh)):
        if shape is not None and beyond <= most_beyond:
            return shape, beyond
    plain = plain_piece(piece)
    return Shape(mesh=LinkMesh(vertices=plain.vertices, faces=plain.faces)), 0.0


def _pose(rotation: FloatArray, place: FloatArray) -> FloatArray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation, place
    return T


def _face_planes(piece: ConvexPiece) -> tuple[FloatArray, FloatArray]:
    """Unit normals (F, 3) and offsets (F,) of the faces."""
    a, b, c = (piece.vertices[piece.faces[:, k]] for k in range(3))
    normals = crossed(b - a, c - a)
    normals /= np.maximum(lengths_of(normals), 1e-300)[:, None]
    return normals, np.einsum("ij,ij->i", normals, a)


def _box_axes(piece: ConvexPiece) -> FloatArray | None:
    """Axes of the box that a piece is, as rows, those nearest to the frame's; None if it is none."""
    if len(piece.vertices) != len(_BOX_CORNERS):
        return None
    normals = _face_planes(piece)[0]
    first = normals[np.argmax(np.abs(normals[:, 0]))]
    second = normals[np.argmin(np.abs(normals @ first) - 1e-3 * np.abs(normals[:, 1]))]
    axes = np.stack([first, second, crossed(first, second)])
    axes = np.stack([axes[k] for k in np.argmax(np.abs(axes), axis=0)])
    axes *= np.where(np.diag(axes) < 0.0, -1.0, 1.0)[:, None]
    if abs(float(np.linalg.det(axes)) - 1.0) > _SQUARE:
        return None
    along = piece.vertices @ axes.T
    low, high = along.min(axis=0), along.max(axis=0)
    corners = low + _BOX_CORNERS * (high - low)
    farthest = np.linalg.norm(along[:, None] - corners[None], axis=2).min(axis=0).max()
    return axes if farthest <= _SQUARE * float(np.linalg.norm(high - low)) else None


def _cylinder(piece: ConvexPiece, mesh: LinkMesh) -> tuple[Shape | None, float]:
    """The cylinder on which all corners of a prism lie."""
    normals = _face_planes(piece)[0]
    heights = piece.vertices @ normals.T
    low, high = heights.min(axis=0), heights.max(axis=0)
    on_ends = np.minimum(heights - low, high - heights).max(axis=0) <= _ROUND * (high - low)
    if not on_ends.any():
        return None, 0.0
    end = int(np.argmax(on_ends))
    axis = normals[end]
    R_link_axis = rotation_from_x(axis)[:, [1, 2, 0]]
    across = piece.vertices @ R_link_axis[:, :2]
    center, radius = _sphere_through(across)
    if center is None:
        return None, 0.0
    turns = np.sort(np.arctan2(*(across - center).T))
    gaps = np.diff(turns, append=turns[0] + 2.0 * np.pi)
    if (gaps > _ROUND).sum() < _LEAST_CORNERS:
        return None, 0.0
    beyond = radius * (1.0 - np.cos(0.5 * gaps.max()))
    middle = R_link_axis @ np.append(center, 0.5 * (low[end] + high[end]))
    size = (radius, float(high[end] - low[end]))
    return Shape(kind="cylinder", mesh=mesh, size=size, T_link_shape=_pose(R_link_axis, middle)), float(beyond)


def _sphere(piece: ConvexPiece, mesh: LinkMesh) -> tuple[Shape | None, float]:
    """The sphere on which all corners lie."""
    center, radius = _sphere_through(piece.vertices)
    if center is None or len(piece.vertices) < _LEAST_CORNERS:
        return None, 0.0
    normals, offsets = _face_planes(piece)
    beyond = radius - float((offsets - normals @ center).min())
    return Shape(kind="sphere", mesh=mesh, size=(radius,), T_link_shape=_pose(np.eye(3), center)), beyond


def _sphere_through(points: FloatArray) -> tuple[FloatArray | None, float]:
    """Centre and radius of the circle (n, 2) or sphere (n, 3) through all points, None where there is none."""
    middle = points.mean(axis=0)
    shifted = points - middle
    unknowns = np.column_stack([2.0 * shifted, np.ones(len(points))])
    found = np.linalg.lstsq(unknowns, (shifted**2).sum(axis=1), rcond=None)[0]
    center = found[:-1]
    distances = np.linalg.norm(shifted - center, axis=1)
    radius = float(distances.max())
    return (center + middle, radius) if np.ptp(distances) <= _ROUND * radius else (None, 0.0)
