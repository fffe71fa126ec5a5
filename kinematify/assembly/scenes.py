"""A mesh of a scene: the floor is set apart from the objects that stand on it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse.csgraph import connected_components

from kinematify.errors import AssemblyError
from kinematify.robot.vectors import box_gaps

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.robot.arrays import FloatArray, IntArray

_FLAT = 0.05
"""Height of a floor, as a share of its longer side."""
_BEYOND = 0.02
"""Share of its size by which a floor reaches beyond what stands on it, on each side."""
_APART = 0.01
"""Of the diagonal of all: pieces whose boxes are farther apart are of different objects."""
_SMALL = 0.05
"""A group of pieces with a smaller diagonal, as a share of the largest one's, is no object of its own."""


def one_object(assembly: Assembly, number: int | None = None) -> Assembly:
    """Remove a floor, and all objects but one where several stand on it.

    Objects are numbered from 1, from left to right. Without a floor and a number, an assembly is returned as it is:
    pieces that touch nothing may belong to one object.

    Args:
        assembly: Pieces of a mesh, z up.
        number: The object; None where there is one.

    Raises:
        AssemblyError: There are several and no number was given, or there is no such object.
    """
    bounds = np.array([part.bounds for part in assembly.parts])
    floor = _floor(bounds)
    if floor is None and number is None:
        return assembly
    rest = np.array([k for k in range(len(bounds)) if k != floor])
    objects = [rest[index] for index in _objects(bounds[rest], _APART * assembly.diagonal)]
    if number is None and len(objects) > 1:
        raise AssemblyError(f"{assembly.source} shows {len(objects)} objects on a floor. {_listed(bounds, objects)}")
    if number is not None and not 1 <= number <= len(objects):
        raise AssemblyError(f"{assembly.source} has no object {number}. {_listed(bounds, objects)}")
    return _only(assembly, objects[(number or 1) - 1], floor)


def _floor(bounds: FloatArray) -> int | None:
    """The lowest flat piece that reaches beyond all others on every side, shape of `bounds` (n, 2, 3)."""
    extents = bounds[:, 1] - bounds[:, 0]
    k = int(np.argmax(extents[:, 0] * extents[:, 1]))
    others = np.delete(bounds, k, axis=0)
    if not len(others) or extents[k, 2] > _FLAT * extents[k, :2].max():
        return None
    margin = _BEYOND * extents[k, :2].max()
    around = (others[:, 0, :2] >= bounds[k, 0, :2] + margin).all() and (
        others[:, 1, :2] <= bounds[k, 1, :2] - margin
    ).all()
    below = (others[:, 0, 2] >= bounds[k, 0, 2] - margin).all()
    # A tabletop or a plinth carries one object that spans most of it; a floor is seen around what stands on it.
    spans = np.ptp(others[:, :, :2].reshape(-1, 2), axis=0) / extents[k, :2]
    return k if around and below and spans.min() < 1.0 - 4.0 * _BEYOND else None


def _objects(bounds: FloatArray, gap: float) -> list[IntArray]:
    """Pieces of every object, from left to right; boxes that are nearer than `gap` [m] are of one."""
    low, high = bounds[:, 0], bounds[:, 1]
    label = connected_components(box_gaps(low, high) <= gap, directed=False)[1]
    groups = [np.flatnonzero(label == number) for number in range(int(label.max()) + 1)]
    sizes = np.array([np.linalg.norm(high[group].max(axis=0) - low[group].min(axis=0)) for group in groups])
    large = [group for group, size in zip(groups, sizes, strict=True) if size >= _SMALL * sizes.max()]
    centres = [0.5 * (low[group].min(axis=0) + high[group].max(axis=0)) for group in large]
    order = sorted(range(len(large)), key=lambda k: tuple(np.round(centres[k], 6)))
    return [large[k] for k in order]


def _listed(bounds: FloatArray, objects: Sequence[IntArray]) -> str:
    sizes = [bounds[index, 1].max(axis=0) - bounds[index, 0].min(axis=0) for index in objects]
    said = [
        f"{number}: {len(index)} pieces, {' x '.join(f'{side:.3g}' for side in size)} m"
        for number, (index, size) in enumerate(zip(objects, sizes, strict=True), start=1)
    ]
    more = f"; and {len(said) - 8} more" if len(said) > 8 else ""
    return f"Give --object N with one of them, from left to right: {'; '.join(said[:8])}{more}."


def _only(assembly: Assembly, index: IntArray, floor: int | None) -> Assembly:
    """The assembly with the pieces at `index` alone, which says what was removed."""
    names = [assembly.names[k] for k in index]
    if len(names) < 2:
        raise AssemblyError(
            f"This object of {assembly.source} is one connected piece, so that nothing moves. Give --labels if parts "
            "of it move."
        )
    gone = len(assembly.parts) - len(names) - (floor is not None)
    removed = [*([f"the floor {assembly.names[floor]}"] if floor is not None else [])]
    removed += [f"{gone} pieces of other objects"] if gone else []
    return replace(
        assembly,
        parts=tuple(assembly.parts[k] for k in index),
        set_aside=tuple(item for item in assembly.set_aside if item.nearest in names),
        originals={name: part for name, part in assembly.originals.items() if name in names},
        warnings=(*assembly.warnings, *([f"Removed: {' and '.join(removed)}."] if removed else [])),
    )
