"""A tensor that is right but for one digit too many or too few of one entry."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Inertial
    from kinematify.validation.asset.rigid_bodies import Room

_POWERS = [power for power in range(-6, 7) if power]
_ALIKE = 4.0
"""Ratio of a moment to that of a box, over the same ratio of another axis: shells and motors reach half of it."""
_ROUNDING = 1e-9
"""Relative rounding of moments that were read from text."""
_HEAVY, _LIGHT = 4.0, 0.05
"""Moments over those of a box of the same size and mass: a hollow one has 2.5 at most, a dense core a tenth."""


class Slip(NamedTuple):
    """An entry that a power of ten repairs."""

    entry: str
    """As in a URDF, e.g. ``ixx``."""
    given: float
    right: float
    tensor: FloatArray
    """With the entry repaired, shape (3, 3)."""


def slip_of(inertial: Inertial, room: Room | None) -> Slip | None:
    """Return the one entry that one power of ten makes fit the geometry; None if the tensor fits, or several would do.

    Args:
        inertial: Mass and tensor of a link.
        room: The room that its geometry takes, in the link's frame.
    """
    if room is None or inertial.mass <= 0.0 or fits_box(inertial, room):
        return None
    found = []
    for i, j in zip(*np.triu_indices(3), strict=True):
        for power in _POWERS if inertial.tensor[i, j] else ():
            tensor = inertial.tensor.copy()
            tensor[i, j] = tensor[j, i] = right = float(f"{tensor[i, j] * 10.0**power:.12g}")
            if _fits(tensor, inertial.mass, room):
                found.append(Slip(f"i{'xyz'[i]}{'xyz'[j]}", float(inertial.tensor[i, j]), right, tensor))
    return found[0] if len(found) == 1 else None


def fits_box(inertial: Inertial, room: Room) -> bool:
    """True if a tensor is that of some body, and of one about as large as a room."""
    return _fits(inertial.tensor, inertial.mass, room)


def _fits(tensor: FloatArray, mass: float, room: Room) -> bool:
    low, middle, high = np.linalg.eigvalsh(tensor)
    square = np.maximum((room.high - room.low) ** 2, 1e-4 * room.diagonal**2)
    ratio = np.diag(tensor) / (mass / 12.0 * (square.sum() - square))
    alike = ratio.min() > _LIGHT and ratio.max() < min(_HEAVY, _ALIKE * ratio.min())
    return bool(low > 0.0 and high <= (low + middle) * (1.0 + _ROUNDING) and alike)
