"""Films of scenes as GIFs, drawn without a browser, a window or a graphics card."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from kinematify.config import load_config
from kinematify.render.picture import camera_for, render_scene, row_of

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path
    from typing import BinaryIO

    from kinematify.render.camera import Camera
    from kinematify.render.picture import PictureScene

_SIZE, _STILL_SIZE = (360, 290), (360, 330)  # of the film of a run, and of each panel of its still [pixels]
_COLORS = 64  # of the film's palette, shades of five colours: a film of 3 s has 0.2 MB
_LAST_SECONDS = 1.5  # that the last picture is shown
_AZIMUTHS = 12  # sides from which the view is tried
_MARGIN = 14.0  # [pixels]


def draw_all(scenes: Sequence[PictureScene], camera: Camera) -> list[Image.Image]:
    """Draw scenes with one camera, in the quality of a film."""
    quality = {"subsamples": 2, "openness_rays": 3, "floor_cells": 48}
    config = load_config("default").preview.model_copy(update=quality)
    return [render_scene(scene, camera, config) for scene in scenes]


def write_gif(
    pictures: Sequence[Image.Image],
    target: Path | BinaryIO,
    seconds: float,
    *,
    colors: int = 256,
    last: float | None = None,
) -> None:
    """Write pictures of one size as a GIF that begins again at its end.

    Args:
        pictures: In their order; all get the palette of the last one.
        target: File to write.
        seconds: From picture to picture.
        colors: Of the palette.
        last: That the last picture is shown [s]; as long as the others if None.
    """
    palette = pictures[-1].quantize(colors, method=Image.Quantize.MEDIANCUT)
    reduced = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    pause = max(20, round(1e3 * seconds))
    durations = [pause] * (len(reduced) - 1) + [pause if last is None else round(1e3 * last)]
    reduced[0].save(
        target, format="GIF", save_all=True, append_images=reduced[1:], duration=durations, loop=0, optimize=True
    )


def watching_side(moments: Sequence[PictureScene], watched: int) -> float:
    """Azimuth of a camera [rad] from which most is seen of the first meshes of all scenes, small ones too."""
    config = load_config("default").preview

    def worth(azimuth: float) -> float:
        size = (config.probe_pixels, round(config.probe_pixels * 0.75))
        camera = camera_for(moments, azimuth, config, size=size, margin=2.0)
        return sum(float(np.sqrt(scene.visible_pixels(camera)[:watched]).sum()) for scene in moments)

    step = 2.0 * np.pi / _AZIMUTHS
    return max((step * (index + 0.4) for index in range(_AZIMUTHS)), key=worth)


def write_run(frames: Sequence[PictureScene], path: Path, seconds: float, azimuth: float) -> None:
    """Write the GIF of a run that takes some seconds, seen from a side; the last picture is shown longer."""
    pictures = draw_all(frames, _camera(frames, azimuth, _SIZE))
    write_gif(pictures, path, seconds / max(len(pictures) - 1, 1), colors=_COLORS, last=_LAST_SECONDS)


def write_moments(moments: Sequence[PictureScene], path: Path, captions: Sequence[str], azimuth: float) -> None:
    """Write a PNG with moments of a run side by side, each under its caption."""
    panels = draw_all(moments, _camera(moments, azimuth, _STILL_SIZE))
    row_of(panels, captions, above=34, middle=19, font=17).save(path)


def _camera(scenes: Sequence[PictureScene], azimuth: float, size: tuple[int, int]) -> Camera:
    return camera_for(scenes, azimuth, load_config("default").preview, size=size, margin=_MARGIN)
