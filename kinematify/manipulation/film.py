"""A short film of reach, grasp and pull, and a still of its three moments, drawn by ray casting."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from kinematify.config import load_config
from kinematify.geometry.scene import transformed
from kinematify.manipulation.robot_place import column_mesh
from kinematify.model.picture_scene import camera_for
from kinematify.render.picture import BACKGROUND, PictureScene, PosedMesh, render_scene
from kinematify.robot.robot import forward_kinematics, rigid_groups

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kinematify.config import PreviewConfig
    from kinematify.config.task_settings import FilmSettings
    from kinematify.manipulation.execute import Execution, Frame, Loaded
    from kinematify.render.camera import Camera
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Robot

_ARM, _HAND = np.array([0.80, 0.83, 0.88]), np.array([0.96, 0.58, 0.20])
_HELD, _OTHERS, _CARCASS = np.array([0.16, 0.62, 0.56]), np.array([0.62, 0.72, 0.80]), np.array([0.86, 0.80, 0.71])
_STAND = np.array([0.55, 0.58, 0.63])
_INK = (45, 50, 60)
_MARGIN = 14  # [pixels]
_CAPTION = 34  # height of the line above a panel of the still [pixels]


@dataclass(frozen=True, eq=False)
class _Mesh:
    """One body in the frame of its first link."""

    link: str
    vertices: FloatArray
    faces: IntArray
    color: FloatArray


def write_film(loaded: Loaded, execution: Execution, film: Path, still: Path, settings: FilmSettings) -> None:
    """Write a GIF of a run and a PNG with its start, the grasp and the end side by side.

    Args:
        loaded: Both models and the motion.
        execution: The run, with at least one frame.
        film: GIF file to write.
        still: PNG file to write.
        settings: Size and length.

    Raises:
        OSError: A file cannot be written.
    """
    stage = _FilmStage(loaded, settings)
    moments = stage.moments(execution)
    azimuth = stage.azimuth(moments)
    frames = _thinned(execution.frames, settings.frames)
    pictures = stage.pictures(frames, azimuth, (settings.width, settings.height))
    seconds = execution.frames[-1].time - execution.frames[0].time
    _write_gif(pictures, film, seconds / max(len(pictures) - 1, 1), settings)
    panels = stage.pictures(moments, azimuth, (settings.still_width, settings.still_height))
    _write_still(panels, still, ("before", "at the grasp", f"after {execution.share:.0%} of the planned way"))


@dataclass(frozen=True, eq=False)
class _FilmStage:
    """Both models as meshes."""

    loaded: Loaded
    settings: FilmSettings

    @cached_property
    def config(self) -> PreviewConfig:
        quality = {
            "subsamples": self.settings.subsamples,
            "openness_rays": self.settings.rays,
            "floor_cells": 48,
            "azimuths": self.settings.azimuths,
        }
        return load_config("default").preview.model_copy(update=quality)

    @cached_property
    def meshes(self) -> tuple[tuple[_Mesh, ...], tuple[_Mesh, ...]]:
        """Meshes of the robot, the hand first, and of the object, the held part first."""
        loaded = self.loaded
        robot = _bodies(loaded.robot, lambda link: _HAND if link in loaded.hand_links else _ARM)
        root = loaded.object.root
        model = _bodies(
            loaded.object,
            lambda link: _HELD if link in loaded.held_links else _CARCASS if link == root else _OTHERS,
        )
        hand_first = sorted(robot, key=lambda mesh: mesh.link not in loaded.hand_links)
        return tuple(hand_first), tuple(sorted(model, key=lambda mesh: mesh.link not in loaded.held_links))

    @cached_property
    def watched(self) -> int:
        """Return how many of the meshes of `scene` are the held part and the hand, which stand first."""
        robot, model = self.meshes
        hand = sum(mesh.link in self.loaded.hand_links for mesh in robot)
        return hand + sum(mesh.link in self.loaded.held_links for mesh in model)

    def scene(self, frame: Frame) -> PictureScene:
        """Both models in one moment, what is watched first."""
        motion = self.loaded.motion
        robot, model = (
            self._posed(robot, meshes, values, T)
            for robot, meshes, values, T in (
                (self.loaded.robot, self.meshes[0], frame.robot, motion.T_world_base),
                (self.loaded.object, self.meshes[1], frame.object, motion.T_world_object),
            )
        )
        hand = sum(mesh.link in self.loaded.hand_links for mesh in self.meshes[0])
        held = self.watched - hand
        return PictureScene(meshes=(*robot[:hand], *model[:held], *robot[hand:], *model[held:], *self.column))

    @cached_property
    def column(self) -> tuple[PosedMesh, ...]:
        """Return what the robot stands on, if it does not stand on the floor."""
        T = self.loaded.motion.T_world_base
        found = column_mesh(float(T[2, 3]))
        if found is None:
            return ()
        return (PosedMesh(vertices=transformed(found[0], T), faces=found[1], color=_STAND),)

    def moments(self, execution: Execution) -> tuple[Frame, Frame, Frame]:
        """Start, grasp and end."""
        at_grasp = min(execution.frames, key=lambda frame: abs(frame.time - execution.grasped))
        return execution.frames[0], at_grasp, execution.frames[-1]

    def azimuth(self, moments: Sequence[Frame]) -> float:
        """The side from which hand and part are seen best in all moments [rad]."""
        scenes = [self.scene(frame) for frame in moments]
        size = (self.config.probe_pixels, round(self.config.probe_pixels * 0.75))

        def worth(azimuth: float) -> float:
            camera = camera_for(scenes, azimuth, self.config, size=size, margin=2.0)
            return sum(float(np.sqrt(s.visible_pixels(camera)[: self.watched]).sum()) for s in scenes)

        step = 2.0 * np.pi / self.settings.azimuths
        return max((step * (index + 0.4) for index in range(self.settings.azimuths)), key=worth)

    def pictures(self, frames: Sequence[Frame], azimuth: float, size: tuple[int, int]) -> list[Image.Image]:
        """Draw all frames with one camera, which shows everything that happens in them."""
        scenes = [self.scene(frame) for frame in frames]
        camera = self._camera(scenes, azimuth, size)
        return [render_scene(scene, camera, self.config) for scene in scenes]

    def _camera(self, scenes: Sequence[PictureScene], azimuth: float, size: tuple[int, int]) -> Camera:
        return camera_for(scenes, azimuth, self.config, size=size, margin=float(_MARGIN))

    def _posed(
        self, robot: Robot, meshes: Sequence[_Mesh], values: dict[str, float], T_world_root: FloatArray
    ) -> list[PosedMesh]:
        leaders = {name: value for name, value in values.items() if robot.joint_by_name[name].mimic is None}
        poses = forward_kinematics(robot, leaders)
        return [
            PosedMesh(
                vertices=transformed(mesh.vertices, T_world_root @ poses[mesh.link]),
                faces=mesh.faces,
                color=mesh.color,
            )
            for mesh in meshes
        ]


def _bodies(robot: Robot, color_of: Callable[[str], FloatArray]) -> list[_Mesh]:
    """One mesh per body that has geometry, in the frame of its first link."""
    poses = forward_kinematics(robot, {})
    found = []
    for group in rigid_groups(robot):
        if not group.has_geometry:
            continue
        back = np.asarray(np.linalg.inv(poses[group.top]), dtype=np.float64)
        vertices: list[FloatArray] = []
        faces: list[IntArray] = []
        for name in group.links:
            for mesh in robot.link_by_name[name].meshes:
                faces.append(mesh.faces + sum(map(len, vertices)))
                vertices.append(transformed(mesh.vertices, back @ poses[name]))
        found.append(_Mesh(group.top, np.concatenate(vertices), np.concatenate(faces), color_of(group.top)))
    return found


def _thinned(frames: Sequence[Frame], most: int) -> list[Frame]:
    """At most so many frames at equal steps, the first and the last among them."""
    chosen = np.unique(np.linspace(0, len(frames) - 1, min(most, len(frames))).round().astype(np.int64))
    return [frames[index] for index in chosen]


def _write_gif(pictures: Sequence[Image.Image], path: Path, pace: float, settings: FilmSettings) -> None:
    """Write frames with one palette, `pace` [s] apart; the last one is shown longer."""
    palette = pictures[-1].quantize(settings.colors, method=Image.Quantize.MEDIANCUT)
    reduced = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    durations = [max(20, round(1e3 * pace))] * (len(reduced) - 1) + [round(1e3 * settings.last_seconds)]
    reduced[0].save(path, save_all=True, append_images=reduced[1:], duration=durations, loop=0, optimize=True)


def _write_still(panels: Sequence[Image.Image], path: Path, captions: Sequence[str]) -> None:
    width, height = panels[0].size
    sheet = Image.new("RGB", (width * len(panels), height + _CAPTION), tuple(np.round(BACKGROUND * 255.0).astype(int)))
    draw = ImageDraw.Draw(sheet)
    for index, (panel, caption) in enumerate(zip(panels, captions, strict=True)):
        sheet.paste(panel, (index * width, _CAPTION))
        center = (index * width + width // 2, _CAPTION // 2 + 2)
        draw.text(center, caption, fill=_INK, font=ImageFont.load_default(17), anchor="mm")
    sheet.save(path)
