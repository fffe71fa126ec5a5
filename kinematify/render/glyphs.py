"""Arrows that show joint axes, as small solid meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray

    Mesh = tuple[FloatArray, IntArray]

_SEGMENTS = 20  # around a shaft a few pixels thick
_ARC_STEPS = 48
_HEAD_RADIUS = 3.0  # all in radii of the shaft
_HEAD_LENGTH = 9.0
_ARC_RADIUS = 9.0
_ARC_THICKNESS = 0.75


def turning_arrow(center: FloatArray, axis: FloatArray, length: float, radius: float, sweep: float) -> Mesh:
    """An axis line with a circular arrow around its upper end, right-handed about the axis.

    Args:
        center: Middle of the line, world frame [m], shape (3,).
        axis: Unit direction, shape (3,).
        length: Of the line [m].
        radius: Of the line [m].
        sweep: Angle that the circular arrow covers [rad].
    """
    tip = center + 0.5 * length * axis
    tail = center - 0.5 * length * axis
    ring = tip - 0.12 * length * axis
    return _joined([_tube(np.stack([tail, tip]), np.full(2, radius)), _circular_arrow(ring, axis, radius, sweep)])


def sliding_arrow(center: FloatArray, axis: FloatArray, length: float, radius: float) -> Mesh:
    """A straight arrow with a head at each end, the larger one in the positive direction.

    Args:
        center: Middle, world frame [m], shape (3,).
        axis: Unit direction, shape (3,).
        length: From tip to tip [m].
        radius: Of the shaft [m].
    """
    tip, tail = center + 0.5 * length * axis, center - 0.5 * length * axis
    head = _HEAD_LENGTH * radius * axis
    path = np.stack([tail, tail + 0.7 * head, tail + 0.7 * head, tip - head, tip - head, tip])
    radii = radius * np.array([0.0, 0.7 * _HEAD_RADIUS, 1.0, 1.0, _HEAD_RADIUS, 0.0])
    return _tube(path, radii)


def _circular_arrow(center: FloatArray, axis: FloatArray, radius: float, sweep: float) -> Mesh:
    side, across = _perpendiculars(axis)
    ring = _ARC_RADIUS * radius
    head = 0.75 * _HEAD_LENGTH / _ARC_RADIUS  # [rad] along the ring
    angles = np.linspace(0.0, sweep - head, _ARC_STEPS)
    tips = np.linspace(sweep - head, sweep, 5)
    turns = np.concatenate([angles, tips])
    path = center + ring * (np.cos(turns)[:, None] * side + np.sin(turns)[:, None] * across)
    radii = np.concatenate([np.full(len(angles), _ARC_THICKNESS), np.linspace(0.85 * _HEAD_RADIUS, 0.0, len(tips))])
    return _tube(path, radii * radius)


def _tube(path: FloatArray, radii: FloatArray) -> Mesh:
    """A tube of changing radius along a path (n, 3) with flat ends."""
    tangents = np.gradient(path, axis=0)
    # Where a point is doubled (a step in radius) the neighbours still give a direction.
    lengths = np.linalg.norm(tangents, axis=1, keepdims=True)
    tangents = tangents / np.maximum(lengths, 1e-300)
    turns = np.linspace(0.0, 2.0 * np.pi, _SEGMENTS, endpoint=False)
    rings = []
    side, _ = _perpendiculars(tangents[0])
    for point, tangent, radius in zip(path, tangents, radii, strict=True):
        side = side - (side @ tangent) * tangent  # carried along the path, so that rings do not twist
        side = side / np.linalg.norm(side)
        across = np.cross(tangent, side)
        rings.append(point + radius * (np.cos(turns)[:, None] * side + np.sin(turns)[:, None] * across))
    vertices = np.concatenate([*rings, path[:1], path[-1:]])
    return vertices, _tube_faces(len(path))


def _tube_faces(count: int) -> IntArray:
    ring = np.arange(_SEGMENTS)
    following = (ring + 1) % _SEGMENTS
    faces = []
    for index in range(count - 1):
        low, high = index * _SEGMENTS, (index + 1) * _SEGMENTS
        faces.append(np.stack([low + ring, low + following, high + following], axis=1))
        faces.append(np.stack([low + ring, high + following, high + ring], axis=1))
    last = (count - 1) * _SEGMENTS
    first_center, last_center = count * _SEGMENTS, count * _SEGMENTS + 1
    faces.append(np.stack([following, ring, np.full(_SEGMENTS, first_center)], axis=1))
    faces.append(np.stack([last + ring, last + following, np.full(_SEGMENTS, last_center)], axis=1))
    return np.concatenate(faces)


def _perpendiculars(axis: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors that form a right-handed frame with the axis."""
    helper = np.eye(3)[np.argmin(np.abs(axis))]
    side = np.cross(axis, helper)
    side /= np.linalg.norm(side)
    return side, np.cross(axis, side)


def _joined(meshes: list[Mesh]) -> Mesh:
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([faces + start for (_, faces), start in zip(meshes, starts[:-1], strict=True)]),
    )
