"""One colour per link, the same in the URDF and in pictures, and its shade in pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.colors import linear_of, srgb_of

if TYPE_CHECKING:
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.robot.arrays import FloatArray

_GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))  # never repeats, and neighbours in order lie far apart
_FIRST_HUE = 0.75  # [rad] a warm orange
_LIGHTNESS = np.array([0.72, 0.64, 0.80])  # cycled, so that similar hues still differ
_CHROMA = 0.125  # inside sRGB for all hues at these lightnesses but for a little clipping
_ROOT = (0.83, 0.008, 1.2)  # a light warm grey: what stands still stays in the background
_SHADES = (1.0, 0.72, 1.35, 0.52)  # of the light of a material: plainly lighter or darker, and still that material
_ALIKE = 0.1  # of the sides of sRGB: swatches that are nearer are not told apart

# OKLab to linear sRGB (Ottosson, "A perceptual color space for image processing", 2020).
_OKLAB_TO_LMS = np.array([[1, 0.3963377774, 0.2158037573], [1, -0.1055613458, -0.0638541728],
                          [1, -0.0894841775, -1.2914855480]])  # fmt: skip
_LMS_TO_RGB = np.array([[4.0767416621, -3.3077115913, 0.2309699292], [-1.2684380046, 2.6097574011, -0.3413193965],
                        [-0.0041960863, -0.7034186147, 1.7076147010]])  # fmt: skip


def link_colors(model: KinematicModel) -> dict[str, FloatArray]:
    """Colour of every link: its part's own, else grey for the root and distinct hues of like strength for all others.

    Returns:
        Link name -> sRGB in [0, 1], shape (3,).
    """
    colors = {model.root: _oklch(*_ROOT)}
    moving = [link.name for link in model.links if link.name != model.root]
    for index, name in enumerate(moving):
        hue = _FIRST_HUE + index * _GOLDEN_ANGLE
        colors[name] = _oklch(float(_LIGHTNESS[index % len(_LIGHTNESS)]), _CHROMA, hue)
    known = {link.name: np.array(link.part.color) for link in model.links if link.part.color is not None}
    return {**colors, **known}


def link_shades(model: KinematicModel) -> dict[str, float]:
    """Factors on the light of links that tell apart what is of one material; 1 where the colour alone does.

    Returns:
        Link name -> factor.
    """
    colors, shades, taken = link_colors(model), {}, np.empty((0, 3))
    for name in (model.root, *(joint.child for joint in model.joints)):
        linear = linear_of(colors[name])
        offered = [min(shade, 1.0 / max(float(linear.max()), 1e-3)) for shade in _SHADES]
        shown = srgb_of(np.outer(offered, linear))
        nearest = np.linalg.norm(shown[:, None] - taken, axis=2).min(axis=1, initial=np.inf)
        best = 0 if nearest[0] > _ALIKE else int(nearest.argmax())
        shades[name] = offered[best]
        taken = np.concatenate([taken, shown[best : best + 1]])
    return shades


def tell_apart(colors: FloatArray) -> bool:
    """Whether all of some colours differ to the eye.

    Args:
        colors: sRGB in [0, 1], shape (n, 3).
    """
    apart = np.linalg.norm(colors[:, None] - colors, axis=2)
    return bool((apart[~np.eye(len(colors), dtype=bool)] > _ALIKE).all())


def _oklch(lightness: float, chroma: float, hue: float) -> FloatArray:
    """OKLCh (hue in rad) to sRGB in [0, 1], shape (3,)."""
    lab = np.array([lightness, chroma * np.cos(hue), chroma * np.sin(hue)])
    return srgb_of(_LMS_TO_RGB @ (_OKLAB_TO_LMS @ lab) ** 3)
