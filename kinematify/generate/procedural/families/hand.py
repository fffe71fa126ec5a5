"""Robot hands: a palm with fingers of phalanges on pins, straight at zero."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import fork, room
from kinematify.generate.procedural.solids import box, cylinder

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_SHARES = (1.0, 0.72, 0.62)
"""Length of a phalanx beside the first one."""


def _build(values: Values, workshop: Workshop) -> None:
    fingers, phalanges = values.count("fingers"), values.count("joints")
    long, wide = values.number("phalanx"), values.number("finger_width")
    clearance, rest = min(values.number("clearance"), 0.04 * wide), values.number("open")
    radius, pitch = 0.4 * wide, 1.4 * wide
    half = 0.5 * pitch * fingers
    level = 0.09
    workshop.body(
        "palm",
        box((-half, -radius, 0), (half, radius, level - 2 * radius)),
        cylinder(1.5 * radius, (0, 0, -0.04), (0, 0, 0.01)),
    )
    for finger in range(fingers):
        x, z, parent = (finger - 0.5 * (fingers - 1)) * pitch, level, "palm"
        for k in range(phalanges):
            name = f"finger_{finger + 1}_{k + 1}"
            forked, tongue = (solid.translate((x, 0, z)) for solid in fork(wide, radius, clearance, 2.2 * radius))
            workshop.add(parent, forked)
            length = max(long * _SHARES[min(k, 2)], 6.0 * radius)
            top = z + length - (2 * radius if k + 1 < phalanges else radius)
            solids = [
                tongue,
                box((x - 0.5 * wide, -radius, z + room(radius, clearance)), (x + 0.5 * wide, radius, top)),
            ]
            if k + 1 == phalanges:
                solids.append(cylinder(radius, (x - 0.5 * wide, 0, top), (x + 0.5 * wide, 0, top)))
            workshop.body(name, *solids)
            workshop.turns(name, parent, (1, 0, 0), (x, 0, z), (0.0, 1.5), rest=rest)
            parent, z = name, z + length


FAMILY = family("hand", _build)
