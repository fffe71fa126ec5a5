"""Unit of the input: what files state, else what the size of the object suggests."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.lengths import length_text
from kinematify.robot.vectors import referenced

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import AssemblyConfig
    from kinematify.robot.raw_mesh import RawMesh

UNITLESS = (".stl", ".obj", ".ply", ".off")
"""Formats that state no unit."""
METRE = "meter"
_UNITS = {
    "micron": (1e-6, "micrometres"),
    "millimeter": (1e-3, "millimetres"),
    "centimeter": (1e-2, "centimetres"),
    METRE: (1.0, "metres"),
    "inch": (0.0254, "inches"),
    "foot": (0.3048, "feet"),
}
"""What a mesh states -> metres, and the word for it."""
_GUESSES = (("millimetres", 1e-3), ("centimetres", 1e-2), ("metres, and were divided by a thousand", 1e3))
"""What lengths may be in that cannot be metres, the likeliest first, and metres per unit."""


def in_metres(meshes: Sequence[RawMesh], scale: float | None, config: AssemblyConfig) -> tuple[list[RawMesh], str]:
    """Return the meshes in metres, and how their lengths were read, in words.

    Where no mesh states a unit, an object that is longer than `config.largest` is taken for one in millimetres.

    Args:
        meshes: In the units of their files.
        scale: Metres per unit; None: what the files state.
        config: Which sizes are usual.
    """
    if scale is not None:
        return [_scaled(mesh, scale) for mesh in meshes], f"{scale:g} m per unit (--scale)"
    units = [mesh.unit.rstrip("s") for mesh in meshes]
    stated = [_UNITS[unit] for unit in dict.fromkeys(units) if unit in _UNITS]
    if stated:
        scaled = [_scaled(mesh, _UNITS.get(unit, (1.0, ""))[0]) for mesh, unit in zip(meshes, units, strict=True)]
        return scaled, f"{' and '.join(word for _, word in stated)} (stated by the file or its format)"
    corners = np.concatenate([referenced(mesh.vertices, mesh.faces) for mesh in meshes])
    corners = corners[np.isfinite(corners).all(axis=1)]
    size = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
    if size > config.largest:
        said = f"millimetres (the file states no unit, and {size:.4g} m is too long; --scale 1 reads metres)"
        return [_scaled(mesh, 1e-3) for mesh in meshes], said
    return list(meshes), "metres (the file states no unit; --scale 0.001 reads millimetres)"


def _scaled(mesh: RawMesh, factor: float) -> RawMesh:
    return replace(mesh if factor == 1.0 else mesh.moved(factor * np.eye(3)), unit=METRE)


def size_warnings(assembly: Assembly, scale: float | None, config: AssemblyConfig) -> tuple[str, ...]:
    """Ask about the unit of an object that is larger or smaller than what has joints."""
    size = float(np.ptp(assembly.bounds, axis=0).max())
    if config.smallest <= size <= config.largest:
        return ()
    unit, factor = next((item for item in _GUESSES if config.smallest <= size * item[1] <= config.largest), _GUESSES[0])
    given = 1.0 if scale is None else scale
    said = f"The object is {length_text(size)} long, which is unusual. If its lengths are in {unit}, it is "
    return (f"{said}{length_text(size * factor)} long: give --scale {given * factor:g}.",)
