"""What PyBullet says of a table of configurations: poses, contacts, inertia, the torques that hold the model still."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kinematify.assembly.part import FloatArray
    from kinematify.validation.engines.pybullet_model import PybulletModel
    from kinematify.validation.engines.touching import Contacts


@dataclass(frozen=True, kw_only=True, eq=False)
class Measured:
    """One entry for each row that was asked for."""

    T_world_link: FloatArray
    """Shape (n, L, 4, 4)."""
    contacts: Contacts
    gravity: FloatArray
    """Torques and forces that hold the model still [N m or N], shape (n, J)."""
    inertia: FloatArray
    """Mass matrices of the first `dynamic` rows, shape (k, J, J)."""


def measure(loaded: PybulletModel, values: FloatArray, *, dynamic: int, poses: bool = True) -> Measured:
    """Set the model to every row and look.

    Args:
        loaded: Complete (`PybulletModel.complete`), base fixed.
        values: Values of all joints [rad or m], shape (n, J).
        dynamic: Mass matrices are computed for the first so many rows.
        poses: False: they are left out, and so are the torques; identities and zeros stand for them.
    """
    transforms = np.tile(np.eye(4), (len(values), len(loaded.link), 1, 1))
    gravity = np.zeros_like(values)
    matrices: list[FloatArray] = []
    found: list[tuple[int, int, int, float]] = []
    for row, q in enumerate(values):
        loaded.place(q)
        found += loaded.contacts(row)
        if row < dynamic:
            matrices.append(loaded.mass_matrix(q) if len(q) else np.zeros((0, 0)))
        if poses:
            transforms[row] = link_transforms(loaded)
            gravity[row] = loaded.gravity(q) if len(q) else 0.0
    return Measured(
        T_world_link=transforms,
        contacts=loaded.corrected(found),
        gravity=gravity,
        inertia=np.array(matrices).reshape(len(matrices), values.shape[1], values.shape[1]),
    )


def link_transforms(loaded: PybulletModel) -> FloatArray:
    """Return the pose of every link's frame as it stands, the fixed root at the origin, shape (L, 4, 4)."""
    transforms = np.tile(np.eye(4), (len(loaded.link), 1, 1))
    states = loaded.link_states()
    moving = np.flatnonzero(loaded.link >= 0)
    if len(moving):
        picked = [states[index] for index in loaded.link[moving].tolist()]
        transforms[moving, :3, 3] = [state[4] for state in picked]
        transforms[moving, :3, :3] = rotations(np.array([state[5] for state in picked]))
    return transforms


def rotations(quaternions: FloatArray) -> FloatArray:
    """Return rotation matrices, shape (n, 3, 3), of quaternions x, y, z, w, shape (n, 4)."""
    x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    matrices: FloatArray = np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)
    return matrices
