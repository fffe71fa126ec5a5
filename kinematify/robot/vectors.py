"""Products and lengths of many vectors of three numbers: the digits of NumPy at a part of its cost.

Its general functions walk along the axis of three for every vector, or spend longer on their arguments than on a few
hundred vectors.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import used_vertices

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


def box_around(boxes: Sequence[FloatArray] | FloatArray) -> FloatArray:
    """Lower and upper corner of the box around boxes, shape (n, 2, d) -> (2, d)."""
    corners = np.asarray(boxes)
    return np.stack([corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)])


def crossed(first: FloatArray, second: FloatArray) -> FloatArray:
    """Cross products as `np.cross`, shapes (..., 3) that broadcast."""
    a, b, c = first[..., 0], first[..., 1], first[..., 2]
    x, y, z = second[..., 0], second[..., 1], second[..., 2]
    return np.stack([b * z - c * y, c * x - a * z, a * y - b * x], axis=-1)


def dots(first: FloatArray, second: FloatArray) -> FloatArray:
    """Scalar products as ``(first * second).sum(axis=-1)``, shapes (..., 3) that broadcast -> (...)."""
    product = first * second
    return np.asarray(product[..., 0] + product[..., 1] + product[..., 2])


def triangle_normals(corners: FloatArray) -> FloatArray:
    """Normals of triangles, twice as long as their areas, (..., 3, 3) -> (..., 3)."""
    first = corners[..., 0, :]
    return crossed(corners[..., 1, :] - first, corners[..., 2, :] - first)


def vertex_normals(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Unit normals of vertices, means over their faces weighted by area, zero where none has one, shape (V, 3)."""
    sums = np.zeros_like(vertices)
    np.add.at(sums, faces, triangle_normals(vertices[faces])[:, None])
    return unit(sums, np.finfo(float).tiny)


def lengths_of(vectors: FloatArray) -> FloatArray:
    """Lengths as ``np.linalg.norm(vectors, axis=-1)``, (..., 3) -> (...)."""
    return np.sqrt(dots(vectors, vectors))


def unit(vectors: FloatArray, least: float = 1.0e-12) -> FloatArray:
    """Vectors (..., 3) over their lengths; those shorter than `least` over that."""
    return np.asarray(vectors / np.maximum(lengths_of(vectors), least)[..., None])


def lowest(points: FloatArray) -> FloatArray:
    """Least x, y and z as ``points.min(axis=0)``, (n, 3) -> (3,), n > 0."""
    return np.asarray(np.ascontiguousarray(points.T).min(axis=1))


def highest(points: FloatArray) -> FloatArray:
    """Largest x, y and z as ``points.max(axis=0)``, (n, 3) -> (3,), n > 0."""
    return np.asarray(np.ascontiguousarray(points.T).max(axis=1))


def all_three(flags: BoolArray) -> BoolArray:
    """True where x, y and z are, as ``flags.all(axis=-1)``, (..., 3) -> (...)."""
    return np.asarray(flags[..., 0] & flags[..., 1] & flags[..., 2])


def referenced(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return the vertices (V, 3) that a face (F, 3) uses, each once, in their order, shape (k, 3)."""
    return vertices[used_vertices(faces, len(vertices))]


def as_one(meshes: Iterable[tuple[FloatArray, IntArray]]) -> tuple[FloatArray, IntArray]:
    """Return several meshes as one, each of vertices (V, 3) and faces (F, 3); both are empty where there are none."""
    vertices, faces, start = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int64)], 0
    for points, triangles in meshes:
        vertices.append(points)
        faces.append(triangles + start)
        start += len(points)
    return np.concatenate(vertices), np.concatenate(faces)


def box_gaps(low: FloatArray, high: FloatArray) -> FloatArray:
    """Return the largest gap along an axis between upright boxes, below zero where they overlap, (n, 3) -> (n, n)."""
    return np.asarray(np.maximum(low[:, None] - high[None], low[None] - high[:, None]).max(axis=2))
