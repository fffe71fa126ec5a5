"""A film of a model in motion, drawn without a browser."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from kinematify.config import load_config
from kinematify.render.camera import Camera
from kinematify.render.picture import PictureScene, render_scene

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.arrays import FloatArray
    from kinematify.view.viewer_scene import ViewScene

_WIDTH, _HEIGHT = 480, 360
_FRAMES, _SECONDS = 24, 3.0
_QUALITY = {"subsamples": 1, "openness_rays": 3, "floor_cells": 48}
_STEEPEST = 0.98
"""Vertical part of a direction at most: a camera that looks straight down has no upper side."""


def film_of(
    scene: ViewScene,
    ends: Mapping[str, tuple[float, float]],
    *,
    eye: FloatArray,
    target: FloatArray,
    field_of_view: float,
    frames: int = _FRAMES,
) -> bytes:
    """Return a GIF of joints that go from one end to the other and back, the others at rest.

    Args:
        scene: The model.
        ends: Joint -> both ends of its way [rad or m].
        eye: Where the camera stands, frame of the root link [m], shape (3,).
        target: What it looks at [m], shape (3,).
        field_of_view: Vertical [rad].
        frames: How many pictures.
    """
    forward = target - eye
    forward = forward / np.linalg.norm(forward)
    forward[2] = np.clip(forward[2], -_STEEPEST, _STEEPEST)
    camera = Camera(
        position=eye,
        forward=forward / np.linalg.norm(forward),
        focal=0.5 * _HEIGHT / math.tan(0.5 * field_of_view),
        width=_WIDTH,
        height=_HEIGHT,
    )
    config = load_config().preview.model_copy(update=_QUALITY)
    pictures: list[Image.Image] = []
    for number in range(frames):
        share = 0.5 - 0.5 * math.cos(2.0 * math.pi * number / frames)
        q = {**scene.rest, **{name: lower + share * (upper - lower) for name, (lower, upper) in ends.items()}}
        pictures.append(render_scene(PictureScene(meshes=scene.posed(q)), camera, config))
    content = io.BytesIO()
    pace = round(1000.0 * _SECONDS / frames)
    pictures[0].save(content, format="GIF", save_all=True, append_images=pictures[1:], duration=pace, loop=0)
    return content.getvalue()
