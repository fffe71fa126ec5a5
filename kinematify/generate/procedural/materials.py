"""What bodies are made of: a density for the mass and a colour for the eye."""

from __future__ import annotations

from dataclasses import dataclass

RGB = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Material:
    """A material as a rule of thumb knows it."""

    density: float
    """[kg/m^3]."""
    color: RGB
    words: tuple[str, ...]
    """How people call it."""


MATERIALS = {
    "wood": Material(density=650.0, color=(0.72, 0.53, 0.34), words=("wood", "wooden", "oak", "pine", "timber", "mdf")),
    "steel": Material(density=7850.0, color=(0.62, 0.64, 0.67), words=("steel", "iron", "stainless")),
    "metal": Material(
        density=2700.0,
        color=(0.70, 0.72, 0.75),
        words=("metal", "metallic", "aluminium", "aluminum", "brass", "copper", "bronze", "chrome"),
    ),
    "plastic": Material(density=1050.0, color=(0.90, 0.90, 0.88), words=("plastic", "abs", "nylon")),
    "glass": Material(density=2500.0, color=(0.70, 0.85, 0.90), words=("glass", "glazed")),
    "rubber": Material(density=1100.0, color=(0.15, 0.15, 0.16), words=("rubber",)),
    "ceramic": Material(density=2400.0, color=(0.95, 0.95, 0.93), words=("ceramic", "porcelain", "stone")),
    "cardboard": Material(density=700.0, color=(0.76, 0.62, 0.45), words=("cardboard", "paper")),
}
"""Keyed by name."""

COLORS: dict[str, RGB] = {
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
}
"""Keyed by name."""


def color_of(material: str, color: str | None) -> RGB:
    """Return the named colour, or the material's own."""
    return MATERIALS[material].color if color is None else COLORS[color]
