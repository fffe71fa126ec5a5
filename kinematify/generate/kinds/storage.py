"""Cabinets, drawers, boxes and bins as others model them."""

from __future__ import annotations

from kinematify.generate.library.kind import kind, whole
from kinematify.generate.library.panels import carcass, rack
from kinematify.generate.procedural.builder import ObjectBuilder, spread


@kind(
    walls=8,
    words="rack of trays, baking rack, tray trolley, bakery rack, letter tray",
    width=(0.2, 0.7),
    depth=(0.25, 0.6),
    height=(0.1, 1.5),
    number=whole(1, 16, default=3, usual=(1, 6), words="tray"),
    wall=(0.006, 0.025),
)
def tray_rack(b: ObjectBuilder, width: float, depth: float, height: float, number: int, wall: float) -> None:
    """Trays, baskets or sheets without fronts that slide in an open case: cutlery, letters, bread."""
    carcass(b, "case", (-width / 2, 0, 0), (width / 2, depth, height), wall, material="steel")
    for k, z in enumerate(spread(number, wall, height - wall)):
        high = b.draw(0.25, 0.6) * (height - 2 * wall) / number
        rack(
            b,
            f"tray_{k}",
            "case",
            (-width / 2 + wall, b.pick(0, -0.01, 0.02), z - high / 2),
            (width / 2 - wall, depth - 1.5 * wall, z + high / 2),
            travel=b.draw(0.5, 0.95),
        )
