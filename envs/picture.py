"""Pictures of an environment: by OpenGL where the machine has it, else by the project's own ray caster.

Which one is taken says the variable MUJOCO_GL: ``egl``, ``osmesa``, ``off`` for the ray caster; if it is not set, the
first that works.
"""

from __future__ import annotations

import ctypes
import importlib
import logging
import os
import weakref
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from kinematify.config import load_config
from kinematify.errors import EnvironmentFault
from kinematify.render.camera import Camera
from kinematify.render.picture import PictureScene, PosedMesh, render_scene

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from kinematify.envs.settings import PictureSettings
    from kinematify.robot.arrays import FloatArray, IntArray

    Pixels = NDArray[np.uint8]

_log = logging.getLogger(__name__)
_LIBRARIES = {"egl": ("libEGL.so.1", "libegl1 libgl1-mesa-dri"), "osmesa": ("libOSMesa.so.8", "libosmesa6")}
_OFF = {"off", "disable", "disabled", "false", "0"}
_FLOOR, _SKY = [0.93, 0.94, 0.95, 1.0], [0.97, 0.975, 0.985]
_QUALITY = {"subsamples": 2, "openness_rays": 3, "floor_cells": 48}
_MOST_GEOMS = 5000
_FONT = 100  # percent; no text is drawn


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


@dataclass(frozen=True, kw_only=True, eq=False)
class View:
    """Where the camera stands."""

    center: FloatArray
    """What it looks at [m], shape (3,)."""
    radius: float
    """Of what is to be seen [m]."""
    azimuth: float
    """Where it is, seen from the centre, from x towards y [rad]."""


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


class Painter:
    """Draws pieces at poses; `close` frees OpenGL."""

    def __init__(self, pieces: Sequence[Piece], view: View, settings: PictureSettings) -> None:
        """Choose the way of drawing.

        Raises:
            EnvironmentFault: The variable MUJOCO_GL asks for what is not there; the message names the package.
        """
        self._pieces, self._view, self._settings = tuple(pieces), view, settings
        self._gl = _opened(self._pieces, view, settings)
        self.kind = "software" if self._gl is None else self._gl.kind
        """``egl``, ``osmesa`` or ``software``."""

    def draw(self, poses: Mapping[str, FloatArray], tint: Mapping[str, FloatArray]) -> Pixels:
        """Return a picture, shape (height, width, 3).

        Args:
            poses: World pose of each link, shape (4, 4).
            tint: What is added to the colour of a link, shape (3,); nothing if it is not named.
        """
        if self._gl is not None:
            return self._gl.draw(poses, tint)
        meshes = tuple(
            PosedMesh(
                vertices=piece.vertices @ poses[piece.link][:3, :3].T + poses[piece.link][:3, 3],
                faces=piece.faces,
                color=_tinted(piece, tint),
            )
            for piece in self._pieces
        )
        config = load_config("default").preview.model_copy(update=_QUALITY)
        return np.asarray(render_scene(PictureScene(meshes=meshes), self._camera(), config))

    def close(self) -> None:
        """Free OpenGL."""
        if self._gl is not None:
            self._gl.close()
            self._gl = None

    def _camera(self) -> Camera:
        settings, view = self._settings, self._view
        up, round_ = settings.elevation, view.azimuth
        towards = np.array([np.cos(round_) * np.cos(up), np.sin(round_) * np.cos(up), np.sin(up)])
        return Camera(
            position=view.center + settings.distance * view.radius * towards,
            forward=-towards,
            focal=0.5 * settings.height / np.tan(0.5 * np.radians(settings.field_of_view)),
            width=settings.width,
            height=settings.height,
        )


class ViewerWindow:
    """MuJoCo's viewer, for ``render_mode="human"``."""

    def __init__(self, pieces: Sequence[Piece], view: View, settings: PictureSettings) -> None:
        """Open a window.

        Raises:
            EnvironmentFault: There is no screen.
        """
        require_screen()
        self._stage = _Stage(pieces, view, settings)
        viewer = importlib.import_module("mujoco.viewer")
        self._viewer = viewer.launch_passive(
            self._stage.model, self._stage.data, show_left_ui=False, show_right_ui=False
        )
        self._stage.aim(self._viewer.cam)

    def draw(self, poses: Mapping[str, FloatArray], tint: Mapping[str, FloatArray]) -> None:
        """Show the poses."""
        self._stage.pose(poses, tint)
        if self._viewer.is_running():
            self._viewer.sync()

    def close(self) -> None:
        """Close the window."""
        self._viewer.close()


class _Stage:
    """The pieces as bodies that are moved by hand, in a model that is never simulated."""

    def __init__(self, pieces: Sequence[Piece], view: View, settings: PictureSettings) -> None:
        self.view, self.settings, self.pieces = view, settings, tuple(pieces)
        self.links = tuple(dict.fromkeys(piece.link for piece in pieces))
        self.model = self._spec().compile()
        self.data = mujoco.MjData(self.model)
        self._mocap = [int(self.model.body(f"link {k}").mocapid[0]) for k in range(len(self.links))]
        self._geoms = [int(self.model.geom(f"piece {k}").id) for k in range(len(self.pieces))]

    def _spec(self) -> mujoco.MjSpec:
        settings, spec = self.settings, mujoco.MjSpec()
        spec.visual.global_.offwidth, spec.visual.global_.offheight = settings.width, settings.height
        spec.visual.global_.fovy = settings.field_of_view
        spec.visual.headlight.ambient, spec.visual.headlight.diffuse = [0.35] * 3, [0.45] * 3
        spec.stat.center, spec.stat.extent = self.view.center, 2.0 * self.view.radius
        sky = spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=64, height=384)
        sky.builtin, sky.rgb1, sky.rgb2 = mujoco.mjtBuiltin.mjBUILTIN_FLAT, _SKY, _SKY
        spec.worldbody.add_light(pos=[1.0, -2.0, 4.0], dir=[-0.2, 0.4, -1.0], diffuse=[0.5] * 3, castshadow=True,
                                 type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)  # fmt: skip
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0.0, 0.0, 1.0], rgba=_FLOOR)
        for number, link in enumerate(self.links):
            body = spec.worldbody.add_body(name=f"link {number}", mocap=True)
            for k, piece in enumerate(self.pieces):
                if piece.link == link:
                    mesh = spec.add_mesh(
                        name=f"piece {k}", uservert=piece.vertices.ravel(), userface=piece.faces.ravel()
                    )
                    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
                    body.add_geom(name=f"piece {k}", type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name, contype=0,
                                  conaffinity=0, rgba=[*piece.color, 1.0])  # fmt: skip
        return spec

    def pose(self, poses: Mapping[str, FloatArray], tint: Mapping[str, FloatArray]) -> None:
        for index, link in zip(self._mocap, self.links, strict=True):
            T = poses[link]
            self.data.mocap_pos[index] = T[:3, 3]
            mujoco.mju_mat2Quat(self.data.mocap_quat[index], np.ascontiguousarray(T[:3, :3]).ravel())
        for geom, piece in zip(self._geoms, self.pieces, strict=True):
            self.model.geom_rgba[geom, :3] = _tinted(piece, tint)
        mujoco.mj_forward(self.model, self.data)

    def aim(self, camera: Any) -> None:
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE
        camera.lookat[:] = self.view.center
        camera.distance = self.settings.distance * self.view.radius
        camera.azimuth, camera.elevation = np.degrees(self.view.azimuth) + 180.0, -np.degrees(self.settings.elevation)


class _Gl:
    """A picture by OpenGL."""

    def __init__(self, kind: str, pieces: Sequence[Piece], view: View, settings: PictureSettings) -> None:
        self.kind, self._stage = kind, _Stage(pieces, view, settings)
        self._context = importlib.import_module(f"mujoco.{kind}").GLContext(settings.width, settings.height)
        self._context.make_current()
        self._free = weakref.finalize(self, self._context.free)
        self._scene = mujoco.MjvScene(self._stage.model, _MOST_GEOMS)
        self._drawing = mujoco.MjrContext(self._stage.model, _FONT)
        self._rect = mujoco.MjrRect(0, 0, settings.width, settings.height)
        self._camera = mujoco.MjvCamera()
        self._stage.aim(self._camera)

    def draw(self, poses: Mapping[str, FloatArray], tint: Mapping[str, FloatArray]) -> Pixels:
        stage = self._stage
        stage.pose(poses, tint)
        self._context.make_current()
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._drawing)
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(stage.model, stage.data, mujoco.MjvOption(), None, self._camera, everything, self._scene)
        pixels = np.empty((self._rect.height, self._rect.width, 3), dtype=np.uint8)
        mujoco.mjr_render(self._rect, self._scene, self._drawing)
        mujoco.mjr_readPixels(pixels, None, self._rect, self._drawing)
        return np.ascontiguousarray(pixels[::-1])

    def close(self) -> None:
        self._context.make_current()
        self._drawing.free()
        self._free()


def _opened(pieces: Sequence[Piece], view: View, settings: PictureSettings) -> _Gl | None:
    """OpenGL, or None for the ray caster."""
    asked = os.environ.get("MUJOCO_GL", "").strip().lower()
    if asked in _OFF:
        return None
    if asked in _LIBRARIES:
        return _asked_for(asked, pieces, view, settings)
    for kind, (library, _) in _LIBRARIES.items():
        if _there(library):
            try:
                return _Gl(kind, pieces, view, settings)
            except (ImportError, RuntimeError, OSError, AttributeError, ValueError, mujoco.FatalError) as error:
                _log.info("pictures by %s are not possible: %s", kind, error)
    packages = " or ".join(package for _, package in _LIBRARIES.values())
    _log.warning("pictures are drawn without OpenGL, which takes ten times as long; apt-get install %s", packages)
    return None


def _asked_for(kind: str, pieces: Sequence[Piece], view: View, settings: PictureSettings) -> _Gl:
    library, package = _LIBRARIES[kind]
    hint = f"Install it (Debian, Ubuntu: apt-get install {package}), or set MUJOCO_GL=off to draw without OpenGL."
    if not _there(library):
        raise EnvironmentFault(f"MUJOCO_GL={kind} asks for pictures by {library}, which is not installed. {hint}")
    try:
        return _Gl(kind, pieces, view, settings)
    except (ImportError, RuntimeError, OSError, AttributeError, mujoco.FatalError) as error:
        raise EnvironmentFault(
            f"MUJOCO_GL={kind} asks for pictures by {library}, which fails: {error}. {hint}"
        ) from error


def _there(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _tinted(piece: Piece, tint: Mapping[str, FloatArray]) -> FloatArray:
    return np.clip(piece.color + tint.get(piece.link, 0.0), 0.0, 1.0)
