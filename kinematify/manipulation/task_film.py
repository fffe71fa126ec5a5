"""Scenes of a short film of reach, grasp and pull, and of a still of its three moments."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.manipulation.robot_place import column_mesh
from kinematify.render.film import watching_side, write_moments, write_run
from kinematify.render.picture import ARM, CARCASS, HAND, HELD, OTHERS, STAND, PictureScene, PosedMesh
from kinematify.robot.robot import forward_kinematics, group_mesh, rigid_groups
from kinematify.robot.transforms import transformed

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from kinematify.manipulation.execute import Execution, Frame, Loaded
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Robot

_FRAMES = 24  # of the film at most: 8 pictures a second of motion, each takes 0.15 s to draw


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
    all_frames = execution.frames
    at_grasp = min(all_frames, key=lambda frame: abs(frame.time - execution.grasped))
    moments, watched = _scenes(loaded, [all_frames[0], at_grasp, all_frames[-1]])
    frames, _ = _scenes(loaded, _thinned(all_frames, _FRAMES))
    captions = ("before", "at the grasp", f"after {execution.share:.0%} of the planned way")
    azimuth = watching_side(moments, watched)
    write_run(frames, film, all_frames[-1].time - all_frames[0].time, azimuth)
    write_moments(moments, still, captions, azimuth)


def _scenes(loaded: Loaded, frames: Sequence[Frame]) -> tuple[list[PictureScene], int]:
    """Both models in some moments, hand and held part first in each, and how many meshes these are."""
    motion, root = loaded.motion, loaded.object.root
    hand, held = loaded.hand_links, loaded.held_links
    bodies = [
        *((loaded.robot, link in hand, link, mesh, HAND if link in hand else ARM)
          for link, mesh in _bodies(loaded.robot)),
        *((loaded.object, link in held, link, mesh, HELD if link in held else CARCASS if link == root else OTHERS)
          for link, mesh in _bodies(loaded.object)),
    ]  # fmt: skip
    bodies.sort(key=lambda body: not body[1])
    column = column_mesh(float(motion.T_world_base[2, 3]))
    stand = [(transformed(column[0], motion.T_world_base), column[1], STAND)] if column else []
    scenes = []
    for frame in frames:
        poses = {
            model: {link: T @ pose for link, pose in forward_kinematics(robot, values).items()}
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


def _bodies(robot: Robot) -> Iterator[tuple[str, tuple[FloatArray, IntArray]]]:
    """First link and mesh, in the frame of that link, of each body that has geometry."""
    zero = forward_kinematics(robot, {})
    for group in rigid_groups(robot):
        if group.has_geometry:
            yield group.top, group_mesh(robot, group, zero)


def _thinned(frames: Sequence[Frame], most: int) -> list[Frame]:
    """At most so many frames at equal steps, the first and the last among them."""
    chosen = np.unique(np.linspace(0, len(frames) - 1, min(most, len(frames))).round().astype(np.int64))
    return [frames[index] for index in chosen]
