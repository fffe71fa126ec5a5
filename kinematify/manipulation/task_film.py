"""A short film of reach, grasp and pull, and a still of its three moments, drawn by ray casting."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from kinematify.config import load_config
from kinematify.manipulation.robot_place import column_mesh
from kinematify.render.film import draw_all, write_gif
from kinematify.render.picture import BACKGROUND, PictureScene, PosedMesh, camera_for
from kinematify.robot.robot import forward_kinematics, rigid_groups
from kinematify.robot.transforms import transformed
from kinematify.robot.vectors import as_one

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from kinematify.manipulation.execute import Execution, Frame, Loaded
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Robot

_ARM, _HAND = np.array([0.80, 0.83, 0.88]), np.array([0.96, 0.58, 0.20])
_HELD, _OTHERS, _CARCASS = np.array([0.16, 0.62, 0.56]), np.array([0.62, 0.72, 0.80]), np.array([0.86, 0.80, 0.71])
_STAND = np.array([0.55, 0.58, 0.63])
_INK = (45, 50, 60)
_FRAMES = 24  # of the film at most: 8 pictures a second of motion, each takes 0.15 s to draw
_SIZE, _STILL_SIZE = (360, 290), (360, 330)  # of the film, and of each of the three panels of the still [pixels]
_COLORS = 64  # of the film's palette, shades of five colours: a film of 3 s has 0.2 MB
_LAST_SECONDS = 1.5  # that the last picture is shown
_AZIMUTHS = 12  # sides from which the view is tried
_MARGIN = 14.0  # [pixels]
_CAPTION = 34  # height of the line above a panel of the still [pixels]


def write_film(loaded: Loaded, execution: Execution, film: Path, still: Path) -> None:
    """Write a GIF of a run and a PNG with its start, the grasp and the end side by side.

    Args:
        loaded: Both models and the motion.
        execution: The run, with at least one frame.
        film: GIF file to write.
        still: PNG file to write.

    Raises:
        OSError: A file cannot be written.
    """
    config = load_config("default").preview
    all_frames = execution.frames
    at_grasp = min(all_frames, key=lambda frame: abs(frame.time - execution.grasped))
    scenes, watched = _scenes(loaded, [all_frames[0], at_grasp, all_frames[-1], *_thinned(all_frames, _FRAMES)])
    moments, frames = scenes[:3], scenes[3:]

    def worth(azimuth: float) -> float:
        size = (config.probe_pixels, round(config.probe_pixels * 0.75))
        camera = camera_for(moments, azimuth, config, size=size, margin=2.0)
        return sum(float(np.sqrt(scene.visible_pixels(camera)[:watched]).sum()) for scene in moments)

    step = 2.0 * np.pi / _AZIMUTHS
    azimuth = max((step * (index + 0.4) for index in range(_AZIMUTHS)), key=worth)

    pictures = draw_all(frames, camera_for(frames, azimuth, config, size=_SIZE, margin=_MARGIN))
    seconds = all_frames[-1].time - all_frames[0].time
    write_gif(pictures, film, seconds / max(len(pictures) - 1, 1), colors=_COLORS, last=_LAST_SECONDS)
    panels = draw_all(moments, camera_for(moments, azimuth, config, size=_STILL_SIZE, margin=_MARGIN))
    _write_still(panels, still, ("before", "at the grasp", f"after {execution.share:.0%} of the planned way"))


def _scenes(loaded: Loaded, frames: Sequence[Frame]) -> tuple[list[PictureScene], int]:
    """Both models in some moments, hand and held part first in each, and how many meshes these are."""
    motion, root = loaded.motion, loaded.object.root
    hand, held = loaded.hand_links, loaded.held_links
    bodies = [
        *((loaded.robot, link in hand, link, mesh, _HAND if link in hand else _ARM)
          for link, mesh in _bodies(loaded.robot)),
        *((loaded.object, link in held, link, mesh, _HELD if link in held else _CARCASS if link == root else _OTHERS)
          for link, mesh in _bodies(loaded.object)),
    ]  # fmt: skip
    bodies.sort(key=lambda body: not body[1])
    column = column_mesh(float(motion.T_world_base[2, 3]))
    stand = [(transformed(column[0], motion.T_world_base), column[1], _STAND)] if column else []
    scenes = []
    for frame in frames:
        poses = {
            model: {link: T @ pose for link, pose in forward_kinematics(robot, _leading(robot, values)).items()}
            for model, robot, values, T in (
                (True, loaded.robot, frame.robot, motion.T_world_base),
                (False, loaded.object, frame.object, motion.T_world_object),
            )
        }
        placed = [
            (transformed(mesh[0], poses[robot is loaded.robot][link]), mesh[1], color)
            for robot, _, link, mesh, color in bodies
        ]
        meshes = (PosedMesh(vertices=v, faces=faces, color=color) for v, faces, color in (*placed, *stand))
        scenes.append(PictureScene(meshes=tuple(meshes)))
    return scenes, sum(body[1] for body in bodies)


def _leading(robot: Robot, values: dict[str, float]) -> dict[str, float]:
    return {name: value for name, value in values.items() if robot.joint_by_name[name].mimic is None}


def _bodies(robot: Robot) -> Iterator[tuple[str, tuple[FloatArray, IntArray]]]:
    """First link and mesh, in the frame of that link, of each body that has geometry."""
    poses = forward_kinematics(robot, {})
    for group in rigid_groups(robot):
        if group.has_geometry:
            back = np.asarray(np.linalg.inv(poses[group.top]), dtype=np.float64)
            yield (
                group.top,
                as_one(
                    (transformed(mesh.vertices, back @ poses[name]), mesh.faces)
                    for name in group.links
                    for mesh in robot.link_by_name[name].meshes
                ),
            )


def _thinned(frames: Sequence[Frame], most: int) -> list[Frame]:
    """At most so many frames at equal steps, the first and the last among them."""
    chosen = np.unique(np.linspace(0, len(frames) - 1, min(most, len(frames))).round().astype(np.int64))
    return [frames[index] for index in chosen]


def _write_still(panels: Sequence[Image.Image], path: Path, captions: Sequence[str]) -> None:
    width, height = panels[0].size
    sheet = Image.new("RGB", (width * len(panels), height + _CAPTION), tuple(np.round(BACKGROUND * 255.0).astype(int)))
    draw = ImageDraw.Draw(sheet)
    for index, (panel, caption) in enumerate(zip(panels, captions, strict=True)):
        sheet.paste(panel, (index * width, _CAPTION))
        center = (index * width + width // 2, _CAPTION // 2 + 2)
        draw.text(center, caption, fill=_INK, font=ImageFont.load_default(17), anchor="mm")
    sheet.save(path)
