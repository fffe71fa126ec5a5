"""Laptops: a screen that is hinged at the back edge of a slab with keys."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.controls import grid
from kinematify.generate.procedural.pieces.lids import BackEdge, add_barrels
from kinematify.generate.procedural.solids import box

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_RADIUS = 0.005  # of the hinges [m]
_OPENS = 2.2  # [rad]


def _build(values: Values, workshop: Workshop) -> None:
    width, depth = values.number("width"), values.number("depth")
    base, screen = values.number("base"), values.number("screen")
    clearance = values.number("clearance")
    back = depth - 2.0 * _RADIUS - clearance - 0.001  # behind it stand the barrels
    level = base + clearance
    slab = box((-0.5 * width, 0, 0), (0.5 * width, back, base))
    keys = [
        box((x - 0.007, y - 0.007, -0.002), (x + 0.007, y + 0.007, 0.002)).translate((0, 0.58 * back, base))
        for x, y in grid(48, 12, (min(0.9 * width, 0.3), min(0.4 * depth, 0.1)))
    ]
    pad = box((-0.18 * width, 0.06 * back, base - 0.0005), (0.18 * width, 0.3 * back, base + 0.01))
    lid = box((-0.5 * width, 0, level), (0.5 * width, back, level + screen))
    # The lid is hollow below where the keys stand up.
    hollow = box((-0.46 * width, 0.04 * back, level - 1.0), (0.46 * width, 0.96 * back, level + 0.0025))
    workshop.body("base", slab - pad, *keys)
    workshop.body("screen", lid - hollow)
    edge = BackEdge(y=back, level=level, below=base, above=screen, clearance=clearance)
    places, knuckles = (-0.32 * width, 0.32 * width), values.count("knuckles")
    pivot = add_barrels(
        workshop, ("base", "screen"), edge, places, length=0.16 * width, radius=_RADIUS, knuckles=knuckles
    )
    workshop.turns("screen", "base", (-1, 0, 0), pivot, (0.0, _OPENS), rest=values.number("open"))


FAMILY = family("laptop", _build)
