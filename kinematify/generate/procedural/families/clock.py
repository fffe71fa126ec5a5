"""Clocks with a dial that looks forward and up to three hands on arbors one in the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, off

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_THICK = 0.0015  # of a hand and of the wall of an arbor [m]
_HANDS = ((0.5, 1.0), (0.78, 0.7), (0.85, 0.3))
"""Length over the dial's radius, and width over its twentieth: hours, minutes, seconds."""


def _build(values: Values, workshop: Workshop) -> None:
    half, depth = 0.5 * values.number("width"), values.number("depth")
    dial = half - values.number("frame")
    recess = 0.5 * depth  # from the rim back to the dial
    centre = (0.0, 0.0, half)
    workshop.body("body", _case(values, half, depth), *_marks(values, dial, recess, half))
    count, clearance = values.count("hands"), min(values.number("clearance"), 0.1 * recess)
    hours = values.number("time")
    turns = (hours / 12.0, hours, 60.0 * hours)
    for k in range(count):
        radius = 0.0015 + (count - 1 - k) * (_THICK + clearance)
        level = recess - 0.002 - clearance - k * (_THICK + clearance)
        name, back = f"hand_{k + 1}", 0.75 * depth
        if k == 0:
            workshop.cut("body", bore(radius, clearance, (0, 0.4 * depth, half), (0, back + clearance, half)))
        else:
            workshop.cut(f"hand_{k}", bore(radius, clearance, (0, -1, half), (0, 1, half)))
        hand = _hand(dial, k, max(2.2 * radius, 0.02 * dial), level).rotate((0, 360.0 * (turns[k] % 1.0), 0))
        arbor = cylinder(radius, (0, level - 1e-4, half), (0, back, half))
        workshop.body(name, hand.translate(centre), arbor, material="metal", color="red" if k == 2 else "black")
        workshop.turns(name, "body", (0, 1, 0), off(centre, 0, level, 0))


def _case(values: Values, half: float, depth: float) -> Manifold:
    """A flat round or square case with a rim around the dial."""
    frame, recess = values.number("frame"), 0.5 * depth
    dial = half - frame
    if values.choice("shape") == "square":
        whole = box((-half, 0, 0), (half, depth, 2.0 * half))
        return whole - box((-dial, -1.0, frame), (dial, recess, half + dial))
    whole = cylinder(half, (0, 0, half), (0, depth, half), segments=96)
    return whole - cylinder(dial, (0, -1.0, half), (0, recess, half), segments=96)


def _marks(values: Values, dial: float, recess: float, level: float) -> list[Manifold]:
    """A bar for each hour, a longer one for each quarter; they lie on the dial."""
    bars = []
    for k in range(12):
        long, wide = (0.12, 0.03) if k % 3 == 0 else (0.07, 0.018)
        bar = box((-wide * dial, recess - 0.0012, (0.95 - long) * dial), (wide * dial, recess + 1e-3, 0.95 * dial))
        bars.append(bar.rotate((0, 30.0 * k, 0)).translate((0, 0, level)))
    return bars


def _hand(dial: float, kind: int, hub: float, level: float) -> Manifold:
    """Points up from the y axis, its back face at y = `level`."""
    long, wide = _HANDS[kind][0] * dial, 0.05 * _HANDS[kind][1] * dial
    tail = -0.16 * dial if kind else -0.1 * dial
    blade = hull(
        box((-0.5 * wide, level - _THICK, tail), (0.5 * wide, level, 0)),
        box((-0.2 * wide, level - _THICK, long - 1e-3), (0.2 * wide, level, long)),
    )
    return blade + cylinder(hub, (0, level - _THICK, 0), (0, level, 0), segments=32)


FAMILY = family("clock", _build)
