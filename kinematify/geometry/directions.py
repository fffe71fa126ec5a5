"""The directions along which a designed part is built: those of its flat faces and of its whole."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray

_MOST = 4  # flat directions of a part; a box has three
_LEAST_SHARE = 0.04  # of the area; the end of a motor housing has about a tenth
_WIDTH = np.cos(np.radians(12.0))  # normals of one flat side of a rough mesh lie so close together
_APART = np.cos(np.radians(10.0))  # nearer directions are one: the finer of them follows from the refinement


def main_directions(normals: FloatArray, areas: FloatArray) -> FloatArray:
    """Directions in which much area looks, and the principal axes of all normals.

    A turning joint of a machine runs along one of them: bearings end in flat seats and covers, and housings are built
    around them. The sense means nothing.

    Args:
        normals: Unit normals of samples of a part, shape (n, 3).
        areas: What each sample stands for [m^2], shape (n,).

    Returns:
        Unit directions, those with most area first, shape (k, 3).
    """
    total = float(areas.sum())
    if total <= 0:
        return np.empty((0, 3))
    found = _flat_directions(normals, areas / total)
    axes = np.linalg.eigh((normals * areas[:, None]).T @ normals)[1].T
    return distinct_directions(np.concatenate([found, axes]))


def distinct_directions(directions: FloatArray) -> FloatArray:
    """The same without those that nearly repeat an earlier one, shape (k, 3)."""
    kept: list[FloatArray] = []
    for direction in directions:
        if all(abs(float(direction @ other)) < _APART for other in kept):
            kept.append(direction)
    return np.array(kept).reshape(-1, 3)


def _flat_directions(normals: FloatArray, shares: FloatArray) -> FloatArray:
    left = np.ones(len(normals), dtype=bool)
    alike = np.abs(normals @ normals.T) > _WIDTH
    found = []
    for _ in range(_MOST):
        support = alike[:, left] @ shares[left]
        best = int(np.argmax(support))
        if support[best] < _LEAST_SHARE:
            break
        members = alike[best] & left
        tensor = (normals[members] * shares[members, None]).T @ normals[members]
        found.append(np.linalg.eigh(tensor)[1][:, 2])
        left &= ~members
    return np.array(found).reshape(-1, 3)
