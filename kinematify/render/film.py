"""Films of scenes as GIFs, drawn without a browser, a window or a graphics card."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PIL import Image

from kinematify.config import load_config
from kinematify.render.picture import render_scene

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path
    from typing import BinaryIO

    from kinematify.render.camera import Camera
    from kinematify.render.picture import PictureScene


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
