"""Rotations and frames in the notations of URDF and of the engines: angles, axes, quaternions, matrices.

Written in NumPy: SciPy's `Rotation` needs 0.2 s for its import, and engines start a process for every run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray

_LEVEL = 1e-9
"""Cosine of the pitch below which roll and yaw are one angle."""
_PARALLEL = 1e-12
"""Sine of the angle below which two directions are one line."""


def transformed(points: FloatArray, T: FloatArray) -> FloatArray:
    """Points (n, 3) moved by a transform (4, 4)."""
    return np.asarray(points @ T[:3, :3].T + T[:3, 3])


def pose_at(place: FloatArray | Sequence[float], rotation: FloatArray | None = None) -> FloatArray:
    """Pose (4, 4) of a frame with its origin at a place (3,), turned by a rotation (3, 3) if one is given."""
    T = np.eye(4)
    T[:3, 3] = place
    if rotation is not None:
        T[:3, :3] = rotation
    return T


def rotation_about(axis: FloatArray, angle: float | FloatArray) -> FloatArray:
    """Return rotation matrices, shape (..., 3, 3), by angles (...) [rad] about a unit `axis` (3,) (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = np.asarray(angle)[..., None, None]
    matrix: FloatArray = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return matrix


def joint_motion(kind: JointType, axis: FloatArray, pivot: FloatArray, value: float) -> FloatArray:
    """Return the motion of a joint as a transform of points in the frame of its line, shape (4, 4).

    Args:
        kind: Type of the joint; a fixed one does not move.
        axis: Unit direction, shape (3,).
        pivot: Point on the line [m], shape (3,).
        value: Of the joint [rad or m].
    """
    if kind is JointType.PRISMATIC:
        return pose_at(value * axis)
    if not kind.turns:
        return np.eye(4)
    turn = rotation_about(axis, value)
    return pose_at(pivot - turn @ pivot, turn)


def across(axis: FloatArray) -> FloatArray:
    """Return a unit direction perpendicular to a unit axis, shape (3,)."""
    side = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    return np.asarray(side / np.linalg.norm(side))


def rotation_from_x(axis: FloatArray) -> FloatArray:
    """Return a rotation matrix, shape (3, 3), that takes the x axis to a unit vector."""
    across = np.array([0.0, -axis[2], axis[1]])
    sine = float(np.linalg.norm(across))
    if sine < _PARALLEL:
        return np.eye(3) if axis[0] > 0.0 else np.diag([-1.0, -1.0, 1.0])
    return rotation_about(across / sine, float(np.arctan2(sine, axis[0])))


def rotation_from_rpy(roll_pitch_yaw: FloatArray) -> FloatArray:
    """Return the rotation matrix, shape (3, 3), of turns about the fixed x, y and z axes [rad], shape (3,)."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(roll_pitch_yaw), np.cos(roll_pitch_yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def rpy_of(rotation: FloatArray) -> FloatArray:
    """Return the turns about the fixed x, y and z axes [rad], shape (3,), that make a rotation matrix (3, 3)."""
    level = float(np.hypot(rotation[0, 0], rotation[1, 0]))
    pitch = np.arctan2(-rotation[2, 0], level)
    if level < _LEVEL:  # looking straight up or down: roll and yaw are one angle
        return np.array([np.arctan2(-rotation[1, 2], rotation[1, 1]), pitch, 0.0])
    roll = np.arctan2(rotation[2, 1], rotation[2, 2])
    return np.array([roll, pitch, np.arctan2(rotation[1, 0], rotation[0, 0])])


def quaternion_of(rotation: FloatArray, *, real_last: bool = False) -> FloatArray:
    """Return the unit quaternion of a rotation matrix (3, 3): w, x, y, z, or x, y, z, w; shape (4,), w not negative.

    The largest of the four is found first, from the diagonal, and divides the others (Shepperd 1978).
    """
    m = np.asarray(rotation)
    trace = float(np.trace(m))
    squares = 0.25 * np.array([1.0 + trace, *(1.0 - trace + 2.0 * np.diag(m))])
    products = 0.25 * np.array(
        [
            [0.0, m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], 0.0, m[1, 0] + m[0, 1], m[0, 2] + m[2, 0]],
            [m[0, 2] - m[2, 0], m[1, 0] + m[0, 1], 0.0, m[2, 1] + m[1, 2]],
            [m[1, 0] - m[0, 1], m[0, 2] + m[2, 0], m[2, 1] + m[1, 2], 0.0],
        ]
    )
    largest = int(np.argmax(squares))
    found = (products + np.diag(squares))[largest]
    found = found / np.linalg.norm(found)
    found = -found if found[0] < 0.0 else found
    return np.roll(found, -1) if real_last else np.asarray(found)


def rotation_from_quaternion(quaternion: FloatArray) -> FloatArray:
    """Return the rotation matrices, shape (..., 3, 3), of quaternions w, x, y, z of any length, shape (..., 4)."""
    w, x, y, z = np.moveaxis(quaternion / np.linalg.norm(quaternion, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
