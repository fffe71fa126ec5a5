"""The grain of wood: a small picture that repeats, drawn here, and how it lies on a board."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.appearance import Texture

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray

_PIXELS = 256
_LENGTH, _WIDTH = 0.9, 0.3  # of the picture on a board, along and across the grain [m]
_DARKEST = 0.62
_RINGS = 8  # dark lines across the picture
_FIBRES = 40.0  # how much longer fibres are than wide, in pixels


@cache
def wood_grain() -> Texture:
    """Return shades of wood, 1 where it is lightest, the grain along u; always the same."""
    ticks = 2.0 * np.pi * np.arange(_PIXELS) / _PIXELS
    u, v = np.meshgrid(ticks, ticks)
    # All waves have whole numbers of periods, so that the picture has no seam.
    bent = v + 0.35 * np.sin(u + 0.6 * np.sin(v)) + 0.12 * np.sin(2.0 * u - 3.0 * v) + 0.3 * np.sin(2.0 * v)
    rings = (0.5 + 0.5 * np.sin(_RINGS * bent)) ** 3
    waves = np.fft.fft2(np.random.default_rng(0).normal(size=(_PIXELS, _PIXELS)))
    along = np.fft.fftfreq(_PIXELS)[None, :]
    fibres = np.real(np.fft.ifft2(waves * np.exp(-0.5 * (2.0 * np.pi * _FIBRES * along) ** 2)))
    fibres = np.clip(0.5 + 0.25 * fibres / fibres.std(), 0.0, 1.0)
    shade = 1.0 - (1.0 - _DARKEST) * (0.6 * rings + 0.4 * fibres)
    # Dark wood is redder than light wood.
    colors = np.stack([shade**0.8, shade, shade**1.25, np.ones_like(shade)], axis=-1)
    return Texture(name="wood", pixels=np.round(255.0 * colors).astype(np.uint8))


def grain_coordinates(vertices: FloatArray, faces: IntArray, *, shift: float = 0.0) -> FloatArray:
    """Lay the grain along the longest extent of a part; on every face it is seen from its main direction.

    Args:
        vertices: Shape (V, 3) [m].
        faces: Shape (F, 3).
        shift: Moves the picture across, so that no two boards look the same.

    Returns:
        Place of the corners in the picture, shape (F, 3, 2).
    """
    corners = vertices[faces]
    normals = np.abs(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    long = int(np.ptp(vertices, axis=0).argmax())
    facing = normals.argmax(axis=1)
    along = np.where(facing == long, (facing + 1) % 3, long)
    across = 3 - facing - along
    rows = np.arange(len(faces))
    u, v = corners[rows, :, along] / _LENGTH, corners[rows, :, across] / _WIDTH + shift
    return np.stack([u, v], axis=-1)
