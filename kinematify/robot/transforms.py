"""Rotations as other formats write them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray


def quaternion(rotation: FloatArray) -> FloatArray:
    """Unit quaternion of a rotation matrix (3, 3), the real part first and not negative, shape (4,)."""
    return np.asarray(Rotation.from_matrix(rotation).as_quat(canonical=True, scalar_first=True))


def from_x(axis: FloatArray) -> FloatArray:
    """Rotation matrix that takes the x axis to a unit vector, shape (3, 3)."""
    x = np.array([1.0, 0.0, 0.0])
    across = np.cross(x, axis)
    if np.linalg.norm(across) < 1e-12:
        return np.eye(3) if axis[0] > 0.0 else np.diag([-1.0, -1.0, 1.0])
    angle = np.arctan2(np.linalg.norm(across), float(axis @ x))
    return np.asarray(Rotation.from_rotvec(across / np.linalg.norm(across) * angle).as_matrix())
