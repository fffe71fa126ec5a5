"""Materials of bodies: a density for the mass, a colour and a surface for the eye."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.parameter import pairs, phrases
from kinematify.robot.appearance import Appearance, Material, Texture

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray


_PIXELS = 256
_LENGTH, _WIDTH = 0.9, 0.3  # of the picture on a board, along and across the grain [m]
_DARKEST = 0.62
_RINGS = 8  # dark lines across the picture
_FIBRES = 40.0  # how much longer fibres are than wide, in pixels


@cache
def wood_grain() -> Texture:
    """Return shades of wood, 1 where it is lightest, the grain along u; always the same."""
    ticks = 2.0 * np.pi * np.arange(_PIXELS) / _PIXELS
    u, v = np.meshgrid(ticks, ticks)
    # All waves have whole numbers of periods, so that the picture has no seam.
    bent = v + 0.35 * np.sin(u + 0.6 * np.sin(v)) + 0.12 * np.sin(2.0 * u - 3.0 * v) + 0.3 * np.sin(2.0 * v)
    rings = (0.5 + 0.5 * np.sin(_RINGS * bent)) ** 3
    waves = np.fft.fft2(np.random.default_rng(0).normal(size=(_PIXELS, _PIXELS)))
    along = np.fft.fftfreq(_PIXELS)[None, :]
    fibres = np.real(np.fft.ifft2(waves * np.exp(-0.5 * (2.0 * np.pi * _FIBRES * along) ** 2)))
    fibres = np.clip(0.5 + 0.25 * fibres / fibres.std(), 0.0, 1.0)
    shade = 1.0 - (1.0 - _DARKEST) * (0.6 * rings + 0.4 * fibres)
    # Dark wood is redder than light wood.
    colors = np.stack([shade**0.8, shade, shade**1.25, np.ones_like(shade)], axis=-1)
    return Texture(name="wood", pixels=np.round(255.0 * colors).astype(np.uint8))


def grain_coordinates(vertices: FloatArray, faces: IntArray, *, shift: float = 0.0) -> FloatArray:
    """Lay the grain along the longest extent of a part; on every face it is seen from its main direction.

    Args:
        vertices: Shape (V, 3) [m].
        faces: Shape (F, 3).
        shift: Moves the picture across, so that no two boards look the same.

    Returns:
        Place of the corners in the picture, shape (F, 3, 2).
    """
    corners = vertices[faces]
    normals = np.abs(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    long = int(np.ptp(vertices, axis=0).argmax())
    facing = normals.argmax(axis=1)
    along = np.where(facing == long, (facing + 1) % 3, long)
    across = 3 - facing - along
    rows = np.arange(len(faces))
    u, v = corners[rows, :, along] / _LENGTH, corners[rows, :, across] / _WIDTH + shift
    return np.stack([u, v], axis=-1)


RGB = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Substance:
    """A material as a rule of thumb knows its mass and colour."""

    density: float
    """[kg/m^3]."""
    color: RGB
    roughness: float
    """As in `kinematify.robot.appearance.Material`."""
    surface: str
    """``metal``, ``clear``, ``grain`` (its own colour shows the grain of wood) or ``plain``."""
    words: tuple[str, ...]
    """How people call it besides its name."""


_TABLE = """
wood 650 0.72 0.53 0.34 0.7 grain wooden, timber, mdf, plywood, elm
oak 710 0.80 0.65 0.42 0.7 grain oaken
pine 510 0.91 0.77 0.53 0.7 grain spruce, pinewood
beech 720 0.88 0.67 0.52 0.7 grain beechwood
birch 680 0.93 0.85 0.70 0.7 grain maple, light wood, pale wood
bamboo 700 0.85 0.72 0.36 0.7 grain
teak 660 0.66 0.42 0.22 0.7 grain
cherry 580 0.62 0.32 0.19 0.6 grain cherrywood
mahogany 560 0.43 0.17 0.11 0.6 grain rosewood
walnut 640 0.36 0.24 0.16 0.7 grain dark wood
ebony 1000 0.14 0.11 0.09 0.5 grain
steel 7850 0.62 0.64 0.67 0.35 metal stainless
iron 7600 0.26 0.26 0.28 0.65 metal
metal 2700 0.70 0.72 0.75 0.35 metal metallic
aluminium 2700 0.80 0.81 0.82 0.5 metal aluminum
brass 8500 0.80 0.64 0.24 0.3 metal
bronze 8800 0.55 0.36 0.17 0.35 metal
copper 8960 0.77 0.43 0.30 0.3 metal
chrome 7850 0.84 0.87 0.91 0.1 metal chromed
plastic 1050 0.90 0.90 0.88 0.45 plain abs, nylon
glass 2500 0.70 0.85 0.90 0.05 clear glazed, transparent
mirror 2500 0.80 0.86 0.88 0.02 metal mirrored
rubber 1100 0.15 0.15 0.16 0.95 plain
ceramic 2400 0.95 0.95 0.93 0.15 plain porcelain
stone 2600 0.60 0.58 0.54 0.9 plain granite, concrete
marble 2700 0.90 0.89 0.87 0.2 plain
leather 900 0.38 0.22 0.13 0.6 plain
cardboard 700 0.76 0.62 0.45 0.95 plain paper
"""
"""Name, density, red, green, blue, roughness, surface, and words for it."""


def _substance(line: str) -> tuple[str, Substance]:
    name, density, red, green, blue, roughness, surface, *said = line.split(" ", 7)
    color = float(red), float(green), float(blue)
    words = phrases(" ".join(said))
    return name, Substance(
        density=float(density), color=color, roughness=float(roughness), surface=surface, words=words
    )


MATERIALS = dict(map(_substance, _TABLE.strip().splitlines()))
"""Keyed by name."""

_PLAIN: dict[str, RGB] = {
    "white": (0.95, 0.95, 0.94),
    "black": (0.10, 0.10, 0.11),
    "grey": (0.55, 0.56, 0.58),
    "red": (0.75, 0.15, 0.13),
    "green": (0.20, 0.52, 0.28),
    "blue": (0.16, 0.35, 0.68),
    "yellow": (0.93, 0.78, 0.20),
    "orange": (0.92, 0.52, 0.16),
    "brown": (0.42, 0.28, 0.18),
    "beige": (0.88, 0.82, 0.70),
    "pink": (0.92, 0.62, 0.68),
    "purple": (0.45, 0.26, 0.58),
    "silver": (0.75, 0.76, 0.78),
    "gold": (0.80, 0.65, 0.25),
    "turquoise": (0.25, 0.66, 0.66),
}
_SHADES = {"dark": (0.0, 0.45), "light": (1.0, 0.4)}
"""What a colour is mixed with, and the share of that."""

COLORS: dict[str, RGB] = _PLAIN | {
    f"{shade} {name}": (
        round(red + share * (end - red), 3),
        round(green + share * (end - green), 3),
        round(blue + share * (end - blue), 3),
    )
    for shade, (end, share) in _SHADES.items()
    for name, (red, green, blue) in _PLAIN.items()
}
"""Keyed by name, `red` or `dark red`."""
COLOR_WORDS = {name: name for name in COLORS} | pairs(
    "golden gold|gray grey|navy dark blue|mint light green|cream beige|ivory white|crimson dark red|scarlet red|"
    "burgundy dark red|maroon dark red|teal turquoise|cyan turquoise|aqua turquoise|violet purple|lilac light purple|"
    "charcoal dark grey|anthracite dark grey|olive dark green|tan light brown|khaki beige|rose pink|"
    "oxblood dark red|lime light green|mustard dark yellow|lavender light purple|magenta purple"
)
COLOR_WORDS |= {f"{said} {COLOR_WORDS[said].split()[-1]}": COLOR_WORDS[said] for said in ("navy", "mint", "olive")}
COLOR_WORDS["cherry red"] = "dark red"
"""Every word for a colour -> its name."""


_BARE_COLORS = ("gold", "silver")
"""Colours that are of metal, not of paint."""
_PAINT_ROUGHNESS = 0.4


@cache
def surface_of(material: str, color: str | RGB | None) -> Material:
    """Return what a material looks like: bare, or painted where a colour is named; the same object every time."""
    substance = MATERIALS[material]
    red, green, blue = substance.color if color is None else COLORS[color] if isinstance(color, str) else color
    bare = color is None or color in _BARE_COLORS
    return Material(
        name=material if color is None else f"{color if isinstance(color, str) else 'painted'} {material}",
        color=(red, green, blue, 0.3 if substance.surface == "clear" else 1.0),
        roughness=substance.roughness if bare or substance.surface == "clear" else _PAINT_ROUGHNESS,
        metallic=float(bare and (color in _BARE_COLORS or substance.surface == "metal")),
        texture=wood_grain() if substance.surface == "grain" and color is None else None,
    )


def of_one_material(material: Material, vertices: FloatArray, faces: IntArray) -> Appearance:
    """Return the appearance of a mesh, vertices (V, 3) [m] and faces (F, 3), that is of one material all over."""
    return Appearance(
        materials=(material,),
        material_of_face=np.zeros(len(faces), dtype=np.int64),
        uv=None if material.texture is None else grain_coordinates(vertices, faces),
    )
