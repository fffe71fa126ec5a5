"""Knobs, switches, levers and panels of controls."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.library.builder import spread
from kinematify.generate.library.kind import kind, length, whole
from kinematify.generate.library.mechanisms import knob
from kinematify.generate.library.panels import seam
from kinematify.generate.procedural.solids import X, Y, box, prism

if TYPE_CHECKING:
    from kinematify.generate.library.builder import ObjectBuilder


@kind("dial plate", words="knob panel, dial panel", number=whole(1, 5, words="dial, knob"), radius=length(0.008, 0.05))
def dial_plate(b: ObjectBuilder, number: int, radius: float) -> None:
    """Plain discs, blocks and caps that turn on a panel, and now and then a fader beside them."""
    wide = number * radius * b.draw(2.5, 4)
    tall = radius * b.draw(2.5, 6)
    thick = b.draw(0.5, 2) * radius
    tilt = b.pick(0, 0, b.draw(0.2, 0.6)) * tall
    b.part(
        "panel",
        prism(
            [(0, -tall / 2), (tilt + thick, -tall / 2), (tilt + thick, tall / 2), (0, tall / 2)], (0, 0, 0), wide, "x"
        ),
        material="metal",
    )
    high = b.draw(0.3, 1.2) * radius
    ended = b.pick(None, 2, 4.7)
    for k, x in enumerate(spread(number, -wide / 2, wide / 2)):
        knob(
            b,
            f"dial_{k}",
            parent="panel",
            at=(x, 0, b.pick(0, 0.1) * tall),
            radius=radius,
            high=high,
            out=-Y,
            reach=ended,
        )
    if b.maybe(0.3):
        play = seam(b, radius, 0.3 * radius)
        travel = 0.6 * wide
        z = -0.42 * tall
        b.part(
            "fader",
            box(
                (-travel / 2, -play - 0.5 * radius, z - 0.1 * radius),
                (-travel / 2 + 0.5 * radius, -play, z + 0.3 * radius),
            ),
        )
        b.slide("fader", parent="panel", axis=X, upper=travel - 0.5 * radius, ajar=b.maybe())
