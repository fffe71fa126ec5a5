"""What PyBullet says of a table of configurations: poses, contacts, inertia, the torques that hold the model still."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
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
    shape = len(values), len(loaded.link)
    gravity = np.zeros_like(values)
    matrices: list[FloatArray] = []
    found: list[tuple[int, int, int, float]] = []
    states: list[list[tuple[tuple[float, ...], ...]]] = []
    for row, q in enumerate(values):
        loaded.place(q)
        found += loaded.contacts(row)
        if row < dynamic:
            matrices.append(loaded.mass_matrix(q) if len(q) else np.zeros((0, 0)))
        if poses:
            states.append(loaded.link_states())
            gravity[row] = loaded.gravity(q) if len(q) else 0.0
    return Measured(
        T_world_link=_link_transforms(loaded, states) if poses else np.tile(np.eye(4), (*shape, 1, 1)),
        contacts=loaded.corrected(found),
        gravity=gravity,
        inertia=np.array(matrices).reshape(len(matrices), values.shape[1], values.shape[1]),
    )


def _link_transforms(loaded: PybulletModel, states: list[list[tuple[tuple[float, ...], ...]]]) -> FloatArray:
    """Return the pose of every link's frame in every row, the fixed root at the origin, shape (n, L, 4, 4)."""
    transforms = np.tile(np.eye(4), (len(states), len(loaded.link), 1, 1))
    moving = np.flatnonzero(loaded.link >= 0)
    picked = loaded.link[moving].tolist()
    if picked and states:
        placed = transforms[:, moving]
        placed[..., :3, 3] = [[row[index][4] for index in picked] for row in states]
        turned = np.array([row[index][5] for row in states for index in picked])
        placed[..., :3, :3] = _rotations(turned).reshape(len(states), len(picked), 3, 3)
        transforms[:, moving] = placed
    return transforms


def _rotations(quaternions: FloatArray) -> FloatArray:
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
