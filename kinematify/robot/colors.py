"""sRGB, as files and pictures hold colours, and linear light, in which they are added and scaled."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray


def srgb_of(linear: NDArray[Any]) -> FloatArray:
    """Return linear light as sRGB in [0, 1], of the same shape; what is out of range is cut."""
    clipped = np.clip(np.asarray(linear, dtype=np.float64), 0.0, 1.0)
    values: FloatArray = np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)
    return values


def linear_of(srgb: NDArray[Any]) -> FloatArray:
    """Return sRGB in [0, 1] as linear light, of the same shape."""
    given = np.asarray(srgb, dtype=np.float64)
    values: FloatArray = np.where(given <= 0.04045, given / 12.92, ((given + 0.055) / 1.055) ** 2.4)
    return values
