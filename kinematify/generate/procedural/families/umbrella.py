"""Umbrellas that stand on their handle: slats that spread from a crown, and a runner on the shaft."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import fork
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, ring, rod

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_SHAFT = 0.005  # radius [m]
_GRIP = 0.13  # height of the handle [m]
_KNUCKLE = 0.003  # radius of a slat's hinge [m]
_HINGE = 0.009  # length of a slat's hinge [m]
_OPENS = 1.3  # [rad]


def _build(values: Values, workshop: Workshop) -> None:
    count, top = values.count("ribs"), values.number("height") - 0.05
    gap = min(values.number("clearance"), 0.15 * _KNUCKLE)
    # As many hinges as there are slats stand around the shaft and leave room for the runner between them.
    circle = max(0.026, 0.5 * (_HINGE + 0.003) / math.tan(math.pi / count) + _KNUCKLE)
    above = top + 2.5 * _KNUCKLE
    crown = cylinder(circle + 1.2 * _KNUCKLE, (0, 0, above), (0, 0, above + 0.006))
    point = rod(0.6 * _SHAFT, (0, 0, top), (0, 0, top + 0.05 - 0.6 * _SHAFT))
    shaft = cylinder(_SHAFT, (0, 0, 0.5 * _GRIP), (0, 0, above + 0.012), segments=32)
    workshop.body("shaft", *_handle(values), shaft, point, crown)
    _add_runner(values, workshop, top)
    forked, tongue = (half.rotate((180, 0, 0)) for half in fork(_HINGE, _KNUCKLE, gap, 3.0 * _KNUCKLE))
    slat = tongue + _slat(values, circle, top - _GRIP - 0.02)
    for k in range(count):
        angle = 2.0 * math.pi * k / count
        name, degrees = f"rib_{k + 1}", math.degrees(angle)
        workshop.add("shaft", forked.translate((0, -circle, top)).rotate((0, 0, degrees)))
        workshop.body(name, slat.translate((0, -circle, top)).rotate((0, 0, degrees)))
        axis = (-math.cos(angle), -math.sin(angle), 0)
        pivot = (circle * math.sin(angle), -circle * math.cos(angle), top)
        workshop.turns(name, "shaft", axis, pivot, (0.0, _OPENS), rest=values.number("open"))


def _slat(values: Values, circle: float, longest: float) -> Manifold:
    """A thin plate that hangs from the origin, as wide as its neighbours allow while all hang down."""
    gap = max(values.number("clearance"), 5e-4)
    half = (circle - 0.001) * math.tan(math.pi / values.count("ribs")) - gap
    low, start = -min(values.number("reach"), longest), -2.0 * _KNUCKLE
    return hull(
        box((-0.25 * _HINGE, -0.001, start - 0.01), (0.25 * _HINGE, 0.001, start)),
        box((-half, -0.001, 0.7 * low), (half, 0.001, 0.3 * low)),
        box((-0.3 * half, -0.001, low), (0.3 * half, 0.001, low + 0.002)),
    )


def _handle(values: Values) -> list[Manifold]:
    """A straight grip, or a crook whose lowest place is the ground."""
    if values.choice("handle") == "straight":
        return [cylinder(0.013, (0, 0, 0), (0, 0, _GRIP), segments=32)]
    bend, thick = 0.03, 0.009
    level = bend + thick
    hook = ring(bend, thick, 180.0).rotate((-90, 0, 0)).translate((bend, 0, level))
    return [
        hook,
        cylinder(thick, (0, 0, level - 1e-4), (0, 0, _GRIP), segments=32),
        rod(thick, (2.0 * bend, 0, level), (2.0 * bend, 0, level + 0.012)),
    ]


def _add_runner(values: Values, workshop: Workshop, top: float) -> None:
    """A sleeve that is pushed up the shaft."""
    clearance, start, tall = values.number("clearance"), _GRIP + 0.03, 0.04
    sleeve = cylinder(0.012, (0, 0, start), (0, 0, start + tall)) + cylinder(
        0.015, (0, 0, start + tall - 0.006), (0, 0, start + tall)
    )
    # A rib of the shaft in a groove of the sleeve: the slats would keep it from turning, were they strung.
    gap, rib = min(clearance, 0.002), box((-0.0015, 0, start - 0.01), (0.0015, _SHAFT + 0.003, top - 0.01))
    groove = box((-0.0015 - gap, 0, 0), (0.0015 + gap, _SHAFT + 0.003 + gap, 2.0 * top))
    workshop.add("shaft", rib)
    workshop.body("runner", sleeve - bore(_SHAFT, gap, (0, 0, 0), (0, 0, 2.0 * top)) - groove, material="plastic")
    way = 0.9 * (top - 0.02 - start - tall)
    workshop.slides("runner", "shaft", (0, 0, 1), (0, 0, start), (0.0, way), rest=values.number("open"))


FAMILY = family("umbrella", _build)
