"""Pictures of an environment by PyBullet's software renderer, the same on every machine, and MuJoCo's viewer."""

from __future__ import annotations

import importlib
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from kinematify.errors import EnvironmentFault
from kinematify.robot.transforms import quaternion_of
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray

_FLOOR, _SKY = (0.93, 0.94, 0.95, 1.0), (0.97, 0.975, 0.985)
_FLOOR_SIZE = 4.0
"""Half an edge of the floor, in radii of what is seen."""
_NEAR, _FAR = 0.05, 20.0
"""What is drawn, in radii of what is seen from the camera."""
_LIGHT = (-0.4, -1.0, 1.6)
_DISTANCE = 2.4  # of the camera from the middle, in radii of what is seen: all of it is seen, opened too
_ELEVATION = 0.35  # of the camera above the horizon [rad]
_FIELD_OF_VIEW = 45.0  # vertical [deg]


@dataclass(frozen=True, kw_only=True, eq=False)
class Piece:
    """A rigid piece of what is seen."""

    link: str
    """Key among the poses that `draw` is given."""
    vertices: FloatArray
    """Frame of the link [m], shape (V, 3)."""
    faces: IntArray
    """Shape (F, 3)."""
    color: FloatArray
    """sRGB, shape (3,)."""

    def tinted(self, tint: Mapping[str, FloatArray]) -> FloatArray:
        """Its colour with what is added to that of its link, shape (3,)."""
        return np.clip(self.color + tint.get(self.link, 0.0), 0.0, 1.0)


class Renderer:
    """Draws pieces at poses; `close` frees what it holds."""

    def __init__(self, pieces: Sequence[Piece], center: FloatArray, radius: float, azimuth: float) -> None:
        """Put the pieces into a world of their own, which is never simulated.

        Args:
            pieces: What is seen.
            center: What the camera looks at [m], shape (3,).
            radius: Of what is to be seen [m].
            azimuth: Where the camera is, seen from the centre, from x towards y [rad].

        Raises:
            EnvironmentFault: PyBullet is not installed.
        """
        require("A picture of an environment", "pybullet")
        import pybullet  # noqa: PLC0415  # not every installation has it

        from kinematify.simulation.pybullet_engine import Client  # noqa: PLC0415

        self._pieces = tuple(pieces)
        self._pybullet, self._client = pybullet, Client()
        self._bodies = [self._body(piece) for piece in self._pieces]
        size = _FLOOR_SIZE * radius
        floor = self._client.createVisualShape(pybullet.GEOM_BOX, halfExtents=[size, size, 1e-3], rgbaColor=_FLOOR)
        self._client.createMultiBody(0, -1, floor, basePosition=[0.0, 0.0, -1e-3])
        self._view = pybullet.computeViewMatrixFromYawPitchRoll(
            center.tolist(), _DISTANCE * radius, np.degrees(azimuth) + 90.0, -np.degrees(_ELEVATION), 0.0, 2
        )
        self._near, self._far = _NEAR * radius, _FAR * radius

    def _body(self, piece: Piece) -> int:
        corners = piece.vertices[piece.faces]  # one per face: shared ones would round off the edges
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        shape = self._client.createVisualShape(
            self._pybullet.GEOM_MESH,
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
            self._client.changeVisualShape(body, -1, rgbaColor=[*piece.tinted(tint).tolist(), 1.0])
        height, width = size
        found = self._client.getCameraImage(
            width,
            height,
            self._view,
            self._pybullet.computeProjectionMatrixFOV(_FIELD_OF_VIEW, width / height, self._near, self._far),
            lightDirection=_LIGHT,
            renderer=self._pybullet.ER_TINY_RENDERER,
        )
        return np.ascontiguousarray(np.reshape(np.asarray(found[2], dtype=np.uint8), (height, width, 4))[..., :3])

    def close(self) -> None:
        """Free the world."""
        self._client.disconnect()


def has_screen() -> bool:
    """True if a window can be opened."""
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def require_screen() -> None:
    """Refuse to open a window where there is no screen.

    Raises:
        EnvironmentFault: There is none.
    """
    if not has_screen():
        raise EnvironmentFault(
            'render_mode="human" opens a window, but there is no screen (DISPLAY and WAYLAND_DISPLAY are not set). '
            'Use render_mode="rgb_array", which needs none, or run it where there is a screen (ssh -X, xvfb-run).'
        )


class ViewerWindow:
    """MuJoCo's viewer, for ``render_mode="human"``: the pieces are bodies that are moved by hand, never simulated."""

    def __init__(self, pieces: Sequence[Piece], center: FloatArray, radius: float, azimuth: float) -> None:
        """Open a window; arguments as for `Renderer`.

        Raises:
            EnvironmentFault: There is no screen.
        """
        require_screen()
        self._pieces = tuple(pieces)
        self._links = tuple(dict.fromkeys(piece.link for piece in pieces))
        self._model = self._spec(center, radius).compile()
        self._data = mujoco.MjData(self._model)
        self._mocap = [int(self._model.body(f"link {k}").mocapid[0]) for k in range(len(self._links))]
        self._geoms = [int(self._model.geom(f"piece {k}").id) for k in range(len(self._pieces))]
        viewer = importlib.import_module("mujoco.viewer")
        self._viewer: Any = viewer.launch_passive(self._model, self._data, show_left_ui=False, show_right_ui=False)
        camera = self._viewer.cam
        camera.type, camera.lookat[:] = mujoco.mjtCamera.mjCAMERA_FREE, center
        camera.distance = _DISTANCE * radius
        camera.azimuth, camera.elevation = np.degrees(azimuth) + 180.0, -np.degrees(_ELEVATION)

    def _spec(self, center: FloatArray, radius: float) -> mujoco.MjSpec:
        spec = mujoco.MjSpec()
        spec.visual.global_.fovy = _FIELD_OF_VIEW
        spec.visual.headlight.ambient, spec.visual.headlight.diffuse = [0.35] * 3, [0.45] * 3
        spec.stat.center, spec.stat.extent = center, 2.0 * radius
        sky = spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=64, height=384)
        sky.builtin, sky.rgb1, sky.rgb2 = mujoco.mjtBuiltin.mjBUILTIN_FLAT, _SKY, _SKY
        spec.worldbody.add_light(pos=[1.0, -2.0, 4.0], dir=[-0.2, 0.4, -1.0], diffuse=[0.5] * 3, castshadow=True,
                                 type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)  # fmt: skip
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0.0, 0.0, 1.0], rgba=_FLOOR)
        bodies = {
            link: spec.worldbody.add_body(name=f"link {number}", mocap=True) for number, link in enumerate(self._links)
        }
        for k, piece in enumerate(self._pieces):
            mesh = spec.add_mesh(name=f"piece {k}", uservert=piece.vertices.ravel(), userface=piece.faces.ravel())
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
            bodies[piece.link].add_geom(name=f"piece {k}", type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name,
                                        contype=0, conaffinity=0, rgba=[*piece.color, 1.0])  # fmt: skip
        return spec

    def draw(self, poses: Mapping[str, FloatArray], tint: Mapping[str, FloatArray]) -> None:
        """Show the poses."""
        for index, link in zip(self._mocap, self._links, strict=True):
            T = poses[link]
            self._data.mocap_pos[index] = T[:3, 3]
            self._data.mocap_quat[index] = quaternion_of(T[:3, :3])
        for geom, piece in zip(self._geoms, self._pieces, strict=True):
            self._model.geom_rgba[geom, :3] = piece.tinted(tint)
        mujoco.mj_forward(self._model, self._data)
        if self._viewer.is_running():
            self._viewer.sync()

    def close(self) -> None:
        """Close the window."""
        self._viewer.close()
