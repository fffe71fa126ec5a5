"""A mesh of boards that nobody segmented."""

from __future__ import annotations

from typing import TYPE_CHECKING

import trimesh

if TYPE_CHECKING:
    from pathlib import Path


def box(size: tuple[float, float, float], centre: tuple[float, float, float]) -> trimesh.Trimesh:
    """A block [m]."""
    return trimesh.creation.box(size, trimesh.transformations.translation_matrix(centre))


def bin_with_lid() -> tuple[list[trimesh.Trimesh], list[trimesh.Trimesh]]:
    """Five boards, and a lid on top with a knob."""
    boards = [
        box((0.4, 0.4, 0.02), (0, 0, 0.01)),
        *(box((0.02, 0.4, 0.5), (side * 0.19, 0, 0.27)) for side in (-1, 1)),
        *(box((0.36, 0.02, 0.5), (0, side * 0.19, 0.27)) for side in (-1, 1)),
    ]
    return boards, [box((0.4, 0.4, 0.02), (0, 0, 0.532)), box((0.05, 0.05, 0.03), (0, 0, 0.557))]


def write_bin_with_lid(path: Path) -> None:
    """Boards and lid as one mesh."""
    boards, lid = bin_with_lid()
    trimesh.util.concatenate([*boards, *lid]).export(path)


def write_chest(path: Path) -> None:
    """A carcass of five boards with three equal drawers of front, handle, bottom, two sides and back, as one mesh."""
    carcass = [
        *(box((0.02, 0.4, 0.9), (side * 0.29, 0, 0.45)) for side in (-1, 1)),
        *(box((0.56, 0.4, 0.02), (0, 0, height)) for height in (0.01, 0.89)),
        box((0.56, 0.01, 0.86), (0, 0.19, 0.45)),
    ]
    drawers = [
        board
        for z in (0.16, 0.44, 0.72)
        for board in (
            box((0.55, 0.02, 0.27), (0, -0.21, z)),
            box((0.15, 0.02, 0.02), (0, -0.23, z)),
            box((0.52, 0.34, 0.01), (0, -0.03, z - 0.1)),
            *(box((0.01, 0.34, 0.15), (side * 0.255, -0.03, z - 0.02)) for side in (-1, 1)),
            box((0.5, 0.01, 0.15), (0, 0.135, z - 0.02)),
        )
    ]
    trimesh.util.concatenate([*carcass, *drawers]).export(path)
