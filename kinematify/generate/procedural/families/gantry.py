"""Gantries: a bridge along a bed, a carriage along the bridge, a ram up and down; each on rails."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.solids import box, cylinder, union

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_BAR = 0.02
"""Half the width of a rail [m]."""


def _build(values: Values, workshop: Workshop) -> None:
    wide, deep, high = values.number("width"), values.number("depth"), values.number("height")
    gap, tall = values.number("clearance"), 0.06
    inner = _BAR + gap
    bed = [box((-0.5 * wide, -0.5 * deep, 0), (0.5 * wide, 0.5 * deep, 0.05))]
    rails = [(sign * (0.5 * wide - 2 * _BAR)) for sign in (-1, 1)]
    for x in rails:
        bed.append(box((x - _BAR, -0.5 * deep, 0.04), (x + _BAR, 0.5 * deep, 0.05 + tall)))
        for y0, y1 in ((-0.5 * deep, -0.5 * deep + 0.02), (0.5 * deep - 0.02, 0.5 * deep)):
            bed.append(box((x - 1.5 * _BAR, y0, 0.04), (x + 1.5 * _BAR, y1, 0.07 + tall)))
    workshop.body("bed", *bed)

    foot, top = 0.12, high
    shoes = [
        box((x - 2 * _BAR, -0.5 * foot, 0.05 + gap), (x + 2 * _BAR, 0.5 * foot, 0.05 + tall + 0.04))
        - box((x - inner, -1, 0), (x + inner, 1, 0.05 + tall + gap))
        for x in rails
    ]
    posts = [box((x - _BAR, -0.03, 0.05 + tall + 0.03), (x + _BAR, 0.03, top)) for x in rails]
    beam = box((rails[0], -_BAR, top - 2 * _BAR), (rails[1], _BAR, top))
    workshop.body("bridge", *shoes, *posts, beam)
    travel = deep - 0.04 - foot - 2e-3
    workshop.slides("bridge", "bed", (0, 1, 0), (0, 0, 0.1), (-0.5 * travel, 0.5 * travel))

    half = 0.07
    carriage = box((-half, -0.06, top - 2 * _BAR - 0.03), (half, 0.06, top + 0.03))
    carriage -= box((-1, -inner, top - 2 * _BAR - gap), (1, inner, top + gap))
    room = 0.015 + gap
    tower = box((-0.04, -0.13, top - 2 * _BAR - 0.03), (0.04, -0.05, top + 0.03))
    tower -= box((-room, -0.09 - room, 0), (room, -0.09 + room, 2 * high))
    workshop.body("carriage", union(carriage, tower))
    reach = 0.5 * (rails[1] - rails[0]) - _BAR - half - 2e-3
    workshop.slides("carriage", "bridge", (1, 0, 0), (0, 0, top), (-reach, reach))

    low = top - 2 * _BAR - 0.08
    stroke = low - 0.12
    ram = box((-0.015, -0.105, low), (0.015, -0.075, top + 0.08 + stroke))
    cap = box((-0.03, -0.12, top + 0.08 + stroke - 1e-3), (0.03, -0.06, top + 0.1 + stroke))
    tool = cylinder(0.02, (0, -0.09, low - 0.03), (0, -0.09, low + 1e-3))
    workshop.body("ram", ram, cap, tool)
    workshop.slides("ram", "carriage", (0, 0, -1), (0, -0.09, low), (0.0, stroke))


FAMILY = family("gantry", _build)
