"""A mesh of boards that nobody segmented."""

from __future__ import annotations

from typing import TYPE_CHECKING

import trimesh

if TYPE_CHECKING:
    from pathlib import Path


def box(size: tuple[float, float, float], centre: tuple[float, float, float]) -> trimesh.Trimesh:
    """A block [m]."""
    return trimesh.creation.box(size, trimesh.transformations.translation_matrix(centre))


def write_bin_with_lid(path: Path) -> None:
    """Five boards, a lid on top with a knob, as one mesh."""
    boards = [
        box((0.4, 0.4, 0.02), (0, 0, 0.01)),
        *(box((0.02, 0.4, 0.5), (side * 0.19, 0, 0.27)) for side in (-1, 1)),
        *(box((0.36, 0.02, 0.5), (0, side * 0.19, 0.27)) for side in (-1, 1)),
    ]
    lid = [box((0.4, 0.4, 0.02), (0, 0, 0.532)), box((0.05, 0.05, 0.03), (0, 0, 0.557))]
    trimesh.util.concatenate([*boards, *lid]).export(path)
