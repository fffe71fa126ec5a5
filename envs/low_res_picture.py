"""Small pictures for policies by PyBullet's software renderer: in milliseconds, and the same on every machine."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pybullet

from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.pybullet_world import Client

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from kinematify.envs.picture import Piece, View
    from kinematify.envs.settings import PictureSettings
    from kinematify.robot.arrays import FloatArray

_FLOOR = (0.93, 0.94, 0.95, 1.0)
_FLOOR_SIZE = 4.0
"""Half an edge of the floor, in radii of what is seen."""
_NEAR, _FAR = 0.05, 20.0
"""What is drawn, in radii of what is seen from the camera."""
_LIGHT = (-0.4, -1.0, 1.6)


class LowResRenderer:
    """Draws pieces at poses, as `kinematify.envs.picture.Painter` does; `close` frees what it holds."""

    def __init__(self, pieces: Sequence[Piece], view: View, settings: PictureSettings) -> None:
        """Put the pieces into a world of their own, which is never simulated."""
        self._pieces = tuple(pieces)
        self._client = Client()
        self._bodies = [self._body(piece) for piece in self._pieces]
        size = _FLOOR_SIZE * view.radius
        floor = self._client.createVisualShape(pybullet.GEOM_BOX, halfExtents=[size, size, 1e-3], rgbaColor=_FLOOR)
        self._client.createMultiBody(0, -1, floor, basePosition=[0.0, 0.0, -1e-3])
        distance = settings.distance * view.radius
        self._view = pybullet.computeViewMatrixFromYawPitchRoll(
            view.center.tolist(), distance, np.degrees(view.azimuth) + 90.0, -np.degrees(settings.elevation), 0.0, 2
        )
        self._field, self._near, self._far = settings.field_of_view, _NEAR * view.radius, _FAR * view.radius

    def _body(self, piece: Piece) -> int:
        corners = piece.vertices[piece.faces]  # one per face: shared ones would round off the edges
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        shape = self._client.createVisualShape(
            pybullet.GEOM_MESH,
            vertices=corners.reshape(-1, 3).tolist(),
            indices=list(range(3 * len(corners))),
            normals=np.repeat(normals, 3, axis=0).tolist(),
        )
        return int(self._client.createMultiBody(0, -1, shape))

    def draw(
        self, poses: Mapping[str, FloatArray], tint: Mapping[str, FloatArray], size: tuple[int, int]
    ) -> NDArray[np.uint8]:
        """Return a picture, shape (height, width, 3).

        Args:
            poses: World pose of each link, shape (4, 4).
            tint: What is added to the colour of a link, shape (3,); nothing if it is not named.
            size: Height and width [pixels].
        """
        for piece, body in zip(self._pieces, self._bodies, strict=True):
            T = poses[piece.link]
            turn = quaternion_of(T[:3, :3], real_last=True)
            self._client.resetBasePositionAndOrientation(body, T[:3, 3], turn)
            color = np.clip(piece.color + tint.get(piece.link, 0.0), 0.0, 1.0)
            self._client.changeVisualShape(body, -1, rgbaColor=[*color.tolist(), 1.0])
        height, width = size
        found = self._client.getCameraImage(
            width,
            height,
            self._view,
            pybullet.computeProjectionMatrixFOV(self._field, width / height, self._near, self._far),
            lightDirection=_LIGHT,
            renderer=pybullet.ER_TINY_RENDERER,
        )
        return np.ascontiguousarray(np.reshape(np.asarray(found[2], dtype=np.uint8), (height, width, 4))[..., :3])

    def close(self) -> None:
        """Free the world."""
        self._client.disconnect()
