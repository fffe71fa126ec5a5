"""Cabinets, drawers, boxes and bins as others model them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.builder import spread
from kinematify.generate.library.kind import kind, length, whole
from kinematify.generate.library.mechanisms import legs
from kinematify.generate.library.panels import carcass, drawer, rack, seam
from kinematify.generate.procedural.solids import X, Y, Z, box

if TYPE_CHECKING:
    from kinematify.generate.library.builder import ObjectBuilder


@kind(
    "tray rack",
    words="rack of trays, baking rack, tray trolley, map chest, plan chest, bakery rack, letter tray",
    width=length(0.2, 0.7),
    depth=length(0.25, 0.6),
    height=length(0.1, 1.5),
    number=whole(1, 16, default=3, usual=(1, 6), words="tray"),
    wall=length(0.006, 0.025),
)
def tray_rack(b: ObjectBuilder, width: float, depth: float, height: float, number: int, wall: float) -> None:
    """Trays, baskets or sheets without fronts that slide in an open case: cutlery, letters, bread."""
    carcass(b, "case", lower=(-width / 2, 0, 0), upper=(width / 2, depth, height), wall=wall, material="steel")
    for k, z in enumerate(spread(number, wall, height - wall)):
        high = b.draw(0.25, 0.6) * (height - 2 * wall) / number
        rack(
            b,
            f"tray_{k}",
            parent="case",
            lower=(-width / 2 + wall, b.pick(0, -0.01, 0.02), z - high / 2),
            upper=(width / 2 - wall, depth - 1.5 * wall, z + high / 2),
            travel=b.draw(0.5, 0.95),
        )


@kind(
    "drawer table",
    words=(
        "table with a drawer, table with drawers, hall table, dressing table, vanity table, console table with drawers"
    ),
    width=length(0.7, 1.8),
    depth=length(0.45, 0.9),
    height=length(0.45, 0.8),
    top=length(0.015, 0.04),
    apron=length(0.08, 0.16),
    number=whole(1, 3, words="drawer"),
)
def drawer_table(
    b: ObjectBuilder, width: float, depth: float, height: float, top: float, apron: float, number: int
) -> None:
    """A table or desk whose apron or pedestal holds drawers: fronts alone, trays or blocks."""
    wall = 0.018
    b.part("table", box((-width / 2, -0.02, height - top), (width / 2, depth, height)), material="wood")
    legs(
        b,
        "table",
        lower=(-width / 2 + 0.03, 0.0, 0),
        upper=(width / 2 - 0.03, depth - 0.02, height - top + 0.002),
        thick=b.draw(0.03, 0.08),
    )
    low = height - top - apron
    high = height - top
    carcass(
        b,
        "table",
        lower=(-width / 2 + 0.05, 0.02, low),
        upper=(width / 2 - 0.05, depth - 0.05, high),
        wall=wall,
        uprights=np.linspace(-width / 2 + 0.05, width / 2 - 0.05, number + 1)[1:-1],
    )
    for k, x in enumerate(spread(number, -width / 2 + 0.05, width / 2 - 0.05)):
        half = (width - 0.1) / 2 / number - wall - 0.001
        b.bore("table", box((x - half, 0.0, low + wall + 0.001), (x + half, depth - 0.06, high - wall - 0.001)))
        drawer(
            b,
            f"drawer_{k}",
            parent="table",
            lower=(x - half, 0.02, low + wall + 0.001),
            upper=(x + half, b.draw(0.5, 0.9) * depth, high - wall - 0.001),
            lap=0,
        )
    if b.maybe(0.4):
        side = b.pick(X, -X)
        play = max(seam(b, 0.3, 0.01), 0)
        z = low - 0.02 - play
        b.part(
            "board",
            box(0.45 * width * side + 0.1 * depth * Y + z * Z, 0.1 * width * side + 0.8 * depth * Y + (z + 0.015) * Z),
        )
        b.slide("board", parent="table", axis=side, upper=b.draw(0.15, 0.3) * width)
