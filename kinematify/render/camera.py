"""A perspective camera: pixels to rays, points to pixels."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.vectors import lengths_of

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray

_STEEPEST = 0.98
"""Vertical part of a direction at most: a camera that looks straight down has no upper side."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Camera:
    """A pinhole that looks along ``forward`` with z up in the picture."""

    position: FloatArray
    """World frame [m], shape (3,)."""
    forward: FloatArray
    """Unit, world frame, shape (3,); not vertical."""
    focal: float
    """Focal length [pixels]."""
    width: int
    """[pixels]."""
    height: int
    """[pixels]."""
    shift: tuple[float, float] = (0.0, 0.0)
    """Where the optical axis meets the picture, from its centre, right and down [pixels]."""

    @cached_property
    def axes(self) -> FloatArray:
        """Rows: right, down and forward in the world frame, shape (3, 3)."""
        right = np.cross(self.forward, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(self.forward, right), self.forward])

    def rays(self, pixels: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rays through picture positions.

        Args:
            pixels: Right and down from the upper left corner [pixels], shape (n, 2).

        Returns:
            Where all start (3,), and unit directions (n, 3) in the world frame.
        """
        plane = np.column_stack([(pixels - self._optical_center) / self.focal, np.ones(len(pixels))])
        directions = plane @ self.axes
        directions /= lengths_of(directions)[:, None]
        return self.position, directions

    def project(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Picture positions (n, 2) [pixels] and depths along `forward` (n,) [m] of world points (n, 3)."""
        local = (points - self.position) @ self.axes.T
        return local[:, :2] / local[:, 2:] * self.focal + self._optical_center, local[:, 2]

    @property
    def _optical_center(self) -> FloatArray:
        return np.array([0.5 * self.width + self.shift[0], 0.5 * self.height + self.shift[1]])


def fit_camera(
    points: FloatArray, *, azimuth: float, elevation: float, field_of_view: float, size: tuple[int, int], margin: float
) -> Camera:
    """Place a camera so that points fill the picture.

    Args:
        points: World frame [m], shape (n, 3).
        azimuth: Where the camera stands, from x towards y [rad].
        elevation: Its height above the horizon [rad].
        field_of_view: Opening angle over the smaller side [rad].
        size: Width and height [pixels].
        margin: Empty border on each side [pixels].
    """
    width, height = size
    towards = np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)])
    center = points.mean(axis=0)
    radius = max(float(lengths_of(points - center).max()), 1e-300)
    focal = 0.5 * min(size) / np.tan(0.5 * field_of_view)
    inner = np.array([width - 2.0 * margin, height - 2.0 * margin])
    # Standing this far off, nothing can leave the picture; then the picture is enlarged and shifted to fit.
    distance = radius / np.sin(0.5 * field_of_view)
    far = Camera(position=center + distance * towards, forward=-towards, focal=focal, width=width, height=height)
    seen, _ = far.project(points)
    low, high = seen.min(axis=0), seen.max(axis=0)
    zoom = float(np.min(inner / np.maximum(high - low, 1e-9)))
    middle = (0.5 * (low + high) - 0.5 * np.array(size)) * zoom
    shift = (float(-middle[0]), float(-middle[1]))
    return Camera(
        position=far.position, forward=far.forward, focal=focal * zoom, width=width, height=height, shift=shift
    )


def camera_at(eye: FloatArray, target: FloatArray, field_of_view: float, size: tuple[int, int]) -> Camera:
    """Camera at a place that looks at another one [m], shape (3,) each; the field of view [rad] is the vertical one."""
    width, height = size
    forward = (target - eye) / np.linalg.norm(target - eye)
    forward[2] = np.clip(forward[2], -_STEEPEST, _STEEPEST)
    forward /= np.linalg.norm(forward)
    focal = 0.5 * height / np.tan(0.5 * field_of_view)
    return Camera(position=eye, forward=forward, focal=float(focal), width=width, height=height)
