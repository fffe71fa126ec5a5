"""What people pull: bars, knobs, cups and edges, mounted on a front that looks along -y."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.solids import ball, box, cylinder, rod, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.solids import Point

_SUNK = 1e-3  # how deep a handle reaches into its front, so that both are one solid


def handle(kind: str, at: Point, *, along: str, length: float) -> list[Manifold]:
    """Return the solids of a handle.

    Args:
        kind: ``bar``, ``knob``, ``cup``, ``edge`` or ``none``.
        at: Where its middle meets the front [m]; the front's outer face lies in y = at[1].
        along: ``x`` or ``z``, the direction of a long one.
        length: Of a long one [m].
    """
    x, y, z = at
    half = 0.5 * length
    if kind == "knob":
        return [cylinder(0.006, (x, y + _SUNK, z), (x, y - 0.02, z)), ball(0.014, (x, y - 0.026, z))]
    if kind == "bar":
        ends = [(x - half, y - 0.03, z), (x + half, y - 0.03, z)]
        feet = [(x - 0.8 * half, z), (x + 0.8 * half, z)]
        if along == "z":
            ends = [(x, y - 0.03, z - half), (x, y - 0.03, z + half)]
            feet = [(x, z - 0.8 * half), (x, z + 0.8 * half)]
        posts = [cylinder(0.005, (fx, y + _SUNK, fz), (fx, y - 0.03, fz), segments=24) for fx, fz in feet]
        return [rod(0.006, *ends), *posts]
    if kind == "cup":
        half = min(half, 0.04)  # it always lies, and must not reach beyond a door's free edge
        outer = cylinder(0.03, (x - half, y, z), (x + half, y, z)) - cylinder(0.025, (x - half, y, z), (x + half, y, z))
        caps = [cylinder(0.03, (x + s * half, y, z), (x + s * (half - 0.003), y, z)) for s in (-1, 1)]
        below = box((x - length, y - 0.1, z - 0.1), (x + length, y + 0.1, z))
        behind = box((x - length, y + _SUNK, z - 0.1), (x + length, y + 0.1, z + 0.1))
        return [union(outer, *caps) - below - behind]
    if kind == "edge":
        size = (half, 0.004) if along == "x" else (0.004, half)
        return [box((x - size[0], y - 0.02, z - size[1]), (x + size[0], y + _SUNK, z + size[1]))]
    return []
