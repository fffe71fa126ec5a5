"""What MuJoCo says of a table of configurations: poses, contacts, inertia, the torques that hold the model still."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.validation.engines.touching import Contacts, deepest

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.validation.engines.mujoco_model import MujocoModel


_ROWS_PER_THREAD = 150
"""Fewer rows are done before a thread has started."""


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


def measure(loaded: MujocoModel, values: FloatArray, *, dynamic: int, threads: int) -> Measured:
    """Set the model to every row and look.

    Args:
        loaded: Complete (`MujocoModel.complete`).
        values: Values of all joints [rad or m], shape (n, J).
        dynamic: Mass matrices are kept for the first so many rows.
        threads: MuJoCo computes outside of Python's lock.
    """
    chunks = np.array_split(np.arange(len(values)), min(threads, 1 + len(values) // _ROWS_PER_THREAD))
    if len(chunks) == 1:
        parts = [_measure_rows(loaded, values, chunks[0], dynamic)]
    else:
        with ThreadPoolExecutor(len(chunks)) as pool:
            parts = list(pool.map(lambda rows: _measure_rows(loaded, values, rows, dynamic), chunks))
    row, links, depth = (np.concatenate([part[k] for part in parts]) for k in (1, 2, 3))
    return Measured(
        T_world_link=np.concatenate([part[0] for part in parts]),
        contacts=deepest(row, links, depth),
        gravity=np.concatenate([part[4] for part in parts]),
        inertia=np.concatenate([part[5] for part in parts]),
    )


_Part = tuple["FloatArray", "IntArray", "IntArray", "FloatArray", "FloatArray", "FloatArray"]


def _measure_rows(loaded: MujocoModel, values: FloatArray, rows: IntArray, dynamic: int) -> _Part:
    model, data = loaded.model, mujoco.MjData(loaded.model)
    qpos, bodies = loaded.qpos, loaded.body
    poses = np.tile(np.eye(4), (len(rows), len(loaded.body), 1, 1))
    gravity = np.zeros((len(rows), model.nv))
    matrices: list[FloatArray] = []
    found: list[tuple[IntArray, IntArray, FloatArray]] = []
    for k, row in enumerate(rows):
        data.qpos[qpos] = values[row]
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_rne(model, data, 0, gravity[k])
        poses[k, :, :3, :3] = data.xmat[bodies].reshape(-1, 3, 3)
        poses[k, :, :3, 3] = data.xpos[bodies]
        if data.ncon:
            found.append((np.full(data.ncon, row), data.contact.geom.copy(), -data.contact.dist))
        if row < dynamic:
            matrices.append(_mass_matrix(loaded, data))
    row_of, geoms, depth = (np.concatenate([item[k] for item in found] or [np.zeros(0)]) for k in range(3))
    links = loaded.link_of_body[model.geom_bodyid][geoms.reshape(-1, 2).astype(np.int64)]
    size = len(loaded.joint)
    inertia = np.array(matrices).reshape(len(matrices), size, size)
    return poses, row_of.astype(np.int64), links, depth, gravity[:, loaded.dof], inertia


def _mass_matrix(loaded: MujocoModel, data: mujoco.MjData) -> FloatArray:
    matrix = np.zeros((loaded.model.nv, loaded.model.nv))
    if loaded.model.nv:
        mujoco.mj_fullM(loaded.model, data, matrix)
    return matrix[np.ix_(loaded.dof, loaded.dof)]
