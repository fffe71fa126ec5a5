"""How much of the sky each point of a scene sees: soft shading inside corners and a soft shadow on the floor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates

if TYPE_CHECKING:
    from kinematify.config import PreviewConfig
    from kinematify.geometry.rays import RayScene
    from kinematify.render.camera import Camera
    from kinematify.robot.arrays import FloatArray, IntArray

SAME_SURFACE_COSINE = 0.94
"""Places of one mesh whose normals differ less (20 deg) share light."""
_TILE = 4  # places per side of the square over which light is averaged; each pixel of it has its own directions
_FLOOR_RAYS = 64
_FLOOR_REACH = 0.6  # of the scene's size
_FLOOR_ROOM = 0.4  # of the scene's size: how far the map of the shadow reaches beyond the object
_FLOOR_FADE = 0.5  # of the map's half width: the shadow fades to nothing over this distance
_BORDER = 60.0  # pixels over which the shadow fades towards the border of the picture


class SkyLight:
    """Rays to the sky, the same few directions at like places, so that even surfaces show no noise."""

    def __init__(self, scene: RayScene, config: PreviewConfig) -> None:
        self.scene = scene
        self.rays = config.openness_rays
        self.reach = config.openness_reach * scene.size
        ball = _even_directions(self.rays * _TILE**2)
        # Directions that follow each other on the spiral lie at one height: every set takes them from all heights.
        self.sets = ball.reshape(self.rays, _TILE**2, 3).transpose(1, 0, 2).astype(np.float32)

    def open_share(self, points: FloatArray, normals: FloatArray, sets: IntArray) -> FloatArray:
        """Share of the sky that points see within reach.

        Args:
            points: World frame [m], shape (n, 3).
            normals: Unit, shape (n, 3).
            sets: Which set of directions each point uses, from 0 to 15, shape (n,).

        Returns:
            From 0 (dark) to 1 (open), weighted by the cosine to the normal, shape (n,).
        """
        # A point of the unit ball that lies on the surface is cosine distributed as seen from the point of contact.
        towards = self.sets[sets] + normals[:, None, :].astype(np.float32)
        towards /= np.sqrt(np.einsum("nrk,nrk->nr", towards, towards) + 1e-12)[..., None]
        hidden = self.scene.occluded(np.repeat(points, self.rays, axis=0), towards.reshape(-1, 3), self.reach)
        share: FloatArray = 1.0 - np.count_nonzero(hidden.reshape(-1, self.rays), axis=1) / self.rays
        return share

    def of_picture(self, points: FloatArray, normals: FloatArray, mesh: IntArray) -> FloatArray:
        """Share of the sky that a grid of places sees, averaged over a tile of the same surface, shape (h, w).

        Args:
            points: World frame [m], shape (h, w, 3).
            normals: Unit, shape (h, w, 3).
            mesh: Which one each shows, -1 for none, shape (h, w).
        """
        row, column = np.meshgrid(*(np.arange(size) for size in mesh.shape), indexing="ij")
        sets = (row % _TILE) * _TILE + column % _TILE
        share = np.ones(mesh.shape)
        met = mesh >= 0
        share[met] = self.open_share(points[met], normals[met], sets[met])
        return _average_on_surface(share, mesh, normals)


def _even_directions(count: int) -> FloatArray:
    """Unit vectors spread evenly over the sphere along a golden spiral, from pole to pole, shape (count, 3)."""
    index = np.arange(count)
    height = 1.0 - (2.0 * index + 1.0) / count
    turn = index * np.pi * (3.0 - np.sqrt(5.0))
    radius = np.sqrt(1.0 - height**2)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=1)


def _average_on_surface(values: FloatArray, mesh: IntArray, normals: FloatArray) -> FloatArray:
    """Mean over a tile around each pixel of those that show the same mesh with a like normal, shape (h, w)."""
    total, weight = values.copy(), np.ones_like(values)
    offsets = range(-(_TILE // 2), _TILE - _TILE // 2)
    for down, right in ((down, right) for down in offsets for right in offsets if down or right):
        here = (_span(values.shape[0], down), _span(values.shape[1], right))
        there = (_span(values.shape[0], -down), _span(values.shape[1], -right))
        cosine = np.einsum("ijk,ijk->ij", normals[here], normals[there])
        alike = (mesh[here] == mesh[there]) & (cosine > SAME_SURFACE_COSINE)
        total[here] += alike * values[there]
        weight[here] += alike
    return total / weight


def _span(size: int, offset: int) -> slice:
    """Indices i for which i and i - offset are both in range."""
    return slice(max(offset, 0), size + min(offset, 0))


class FloorShadow:
    """A horizontal plane below the scene that shows nothing but the shadow on it."""

    def __init__(self, scene: RayScene, config: PreviewConfig) -> None:
        room = _FLOOR_ROOM * scene.size
        self.low = scene.bounds[0, :2] - room
        self.step = (scene.bounds[1, :2] + room - self.low) / (config.floor_cells - 1)
        # A little lower than the lowest point: an object that stands on the plane would hide its own shadow.
        self.height = scene.bounds[0, 2] - 2e-3 * scene.size
        self.map = self._hidden_share(scene, config.floor_cells)

    def _hidden_share(self, scene: RayScene, cells: int) -> FloatArray:
        """Share of the sky that the scene hides from each cell, fading to zero at the border, shape (cells, cells)."""
        x, y = np.meshgrid(*(self.low[k] + self.step[k] * np.arange(cells) for k in range(2)), indexing="ij")
        points = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, self.height)])
        towards = _even_directions(_FLOOR_RAYS)
        towards[:, 2] += 1.0
        towards /= np.linalg.norm(towards, axis=1, keepdims=True)
        hidden = scene.occluded(
            np.repeat(points, _FLOOR_RAYS, axis=0), np.tile(towards, (len(points), 1)), _FLOOR_REACH * scene.size
        )
        share = hidden.reshape(cells, cells, _FLOOR_RAYS).mean(axis=2)
        from_middle = np.linspace(-1.0, 1.0, cells)
        radius = np.hypot(from_middle[:, None], from_middle)
        faded: FloatArray = gaussian_filter(share, 1.0) * _smooth_step((1.0 - radius) / _FLOOR_FADE)
        return faded

    def seen(self, origins: FloatArray, directions: FloatArray, pixels: FloatArray, camera: Camera) -> FloatArray:
        """Darkness of the floor where rays meet it, 0 elsewhere and at the border of the picture, shape (n,).

        Args:
            origins: World frame [m], shape (n, 3), or (3,) where all start.
            directions: Unit, shape (n, 3).
            pixels: Picture positions of the rays [pixels], shape (n, 2).
            camera: For the size of the picture.
        """
        down = directions[:, 2] < -1e-6
        distance = (self.height - origins[..., 2]) / np.where(down, directions[:, 2], -1.0)
        spots = origins[..., :2] + distance[:, None] * directions[:, :2]
        dark = map_coordinates(self.map, ((spots - self.low) / self.step).T, order=1, cval=0.0)
        inside = np.minimum(pixels, np.array([camera.width, camera.height]) - pixels).min(axis=1)
        share: FloatArray = np.where(down & (distance > 0.0), dark, 0.0) * _smooth_step(inside / _BORDER)
        return share


def _smooth_step(values: FloatArray) -> FloatArray:
    clipped = np.clip(values, 0.0, 1.0)
    smooth: FloatArray = clipped**2 * (3.0 - 2.0 * clipped)
    return smooth
