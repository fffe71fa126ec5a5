"""What bodies are made of: a density for the mass and a colour for the eye."""

from __future__ import annotations

from dataclasses import dataclass

RGB = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Substance:
    """A material as a rule of thumb knows its mass and colour."""

    density: float
    """[kg/m^3]."""
    color: RGB
    words: tuple[str, ...]
    """How people call it."""


MATERIALS = {
    "wood": Substance(density=650.0, color=(0.72, 0.53, 0.34), words=("wood", "wooden", "timber", "mdf")),
    "oak": Substance(density=710.0, color=(0.76, 0.60, 0.39), words=("oak", "oaken")),
    "pine": Substance(density=510.0, color=(0.86, 0.71, 0.48), words=("pine",)),
    "walnut": Substance(density=640.0, color=(0.36, 0.24, 0.16), words=("walnut",)),
    "steel": Substance(density=7850.0, color=(0.62, 0.64, 0.67), words=("steel", "iron", "stainless")),
    "metal": Substance(
        density=2700.0,
        color=(0.70, 0.72, 0.75),
        words=("metal", "metallic", "aluminium", "aluminum"),
    ),
    "brass": Substance(density=8500.0, color=(0.78, 0.62, 0.26), words=("brass",)),
    "copper": Substance(density=8960.0, color=(0.72, 0.45, 0.30), words=("copper",)),
    "chrome": Substance(density=7850.0, color=(0.82, 0.84, 0.86), words=("chrome", "chromed")),
    "plastic": Substance(density=1050.0, color=(0.90, 0.90, 0.88), words=("plastic", "abs", "nylon")),
    "glass": Substance(density=2500.0, color=(0.70, 0.85, 0.90), words=("glass", "glazed", "transparent")),
    "mirror": Substance(density=2500.0, color=(0.80, 0.86, 0.88), words=("mirror", "mirrored")),
    "rubber": Substance(density=1100.0, color=(0.15, 0.15, 0.16), words=("rubber",)),
    "ceramic": Substance(density=2400.0, color=(0.95, 0.95, 0.93), words=("ceramic", "porcelain")),
    "cardboard": Substance(density=700.0, color=(0.76, 0.62, 0.45), words=("cardboard", "paper")),
}
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
COLOR_WORDS = {name: name for name in COLORS} | {"golden": "gold", "gray": "grey"}
"""Every word for a colour -> its name."""


def color_of(material: str, color: str | None) -> RGB:
    """Return the named colour, or the material's own."""
    return MATERIALS[material].color if color is None else COLORS[color]
