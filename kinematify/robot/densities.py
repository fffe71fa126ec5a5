"""Densities by the name of a material in a mesh file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.vectors import lengths_of, triangle_normals

if TYPE_CHECKING:
    from kinematify.robot.appearance import Appearance
    from kinematify.robot.arrays import FloatArray

_WORDS = {
    7850.0: "steel iron stainless inox chrome",
    2700.0: "aluminium aluminum alu",
    8500.0: "brass bronze",
    8960.0: "copper",
    650.0: "wood wooden timber mdf plywood chipboard birch beech walnut",
    710.0: "oak",
    510.0: "pine spruce",
    1050.0: "plastic abs nylon pvc pla polypropylene polyethylene acrylic",
    2500.0: "glass mirror",
    2400.0: "ceramic porcelain concrete",
    2600.0: "stone marble granite",
    1100.0: "rubber silicone tyre tire",
    700.0: "cardboard paper",
    300.0: "fabric cloth textile foam",
}
DENSITIES = {word: density for density, words in _WORDS.items() for word in words.split()}
"""Density of what is called so [kg/m^3]."""


def density_of(appearance: Appearance, corners: FloatArray) -> float | None:
    """Return the density that the names of a part's materials state, or None where none of them does.

    Args:
        appearance: Materials of the faces.
        corners: Of the faces, shape (F, 3, 3); the mean over the area is of those whose material is known.
    """
    known = np.array([_named(material.name) for material in appearance.materials])[appearance.material_of_face]
    areas = np.where(np.isnan(known), 0.0, lengths_of(triangle_normals(corners)))
    return float(areas @ np.nan_to_num(known) / areas.sum()) if areas.sum() > 0.0 else None


def _named(name: str) -> float:
    """Density of the first word that is a material; NaN if there is none."""
    words = re.findall(r"[a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())
    return next((DENSITIES[word] for word in words if word in DENSITIES), float("nan"))
