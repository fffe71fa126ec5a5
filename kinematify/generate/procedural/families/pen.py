"""Pens that lie along y with the tip in front: one that clicks, one with a cap, one that twists."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.solids import bore, box, cylinder, ring, turned, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_CAP = 0.0012  # wall of a cap [m]
_CONE = 0.012  # length of the tip's cone [m]
_STROKE = 0.005  # of a button [m]
_SIDES = 6  # of the barrel under a cap
_TIGHT = 5e-4  # a pen has no wider gaps [m]


def _build(values: Values, workshop: Workshop) -> None:
    {"click": _click, "cap": _cap, "twist": _twist}[values.choice("mechanism")](values, workshop)


def _lie(values: Values, *solids: Manifold) -> Manifold:
    """Lay down what is built upright about z, the tip at z = 0 and its clip at -y."""
    return union(*solids).rotate((-90, 0, 0)).translate((0, 0, 0.5 * values.number("width")))


def _clip(values: Values, free: float, fixed: float) -> Manifold:
    """A springy strip along the barrel; `free` and `fixed` are the heights of its ends."""
    radius = 0.5 * values.number("width")
    start, end = sorted((free, fixed))
    inner, outer = radius + 0.0012, radius + 0.0024
    strip = box((-0.002, -outer, start), (0.002, -inner, end))
    foot = sorted((fixed, fixed + (0.004 if fixed < free else -0.004)))
    bead_at = free + (-0.002 if fixed < free else 0.002)
    bead = cylinder(0.001, (-0.002, -inner, bead_at), (0.002, -inner, bead_at), segments=16)
    return union(strip, bead, box((-0.002, -outer, foot[0]), (0.002, -0.8 * radius, foot[1])))


def _barrel(values: Values, length: float, radius: float) -> Manifold:
    """A round body with a cone at the tip and grooves for the fingers."""
    body = turned([(0.0, 0.0), (1.5e-3, 0.0), (radius, _CONE), (radius, length), (0.0, length)])
    grooves = [ring(radius, 3e-4, sides=8).translate((0, 0, _CONE + 0.006 + 0.003 * k)) for k in range(6)]
    return body - union(*grooves)


def _click(values: Values, workshop: Workshop) -> None:
    """A button behind the barrel that pushes the tip out in front; two splines keep it from turning."""
    length, radius, gap = values.number("length"), 0.5 * values.number("width"), min(values.number("clearance"), _TIGHT)
    end, ledge = length - 0.006, _CONE + _STROKE + 0.001
    tip, rod, collar, button = 7e-4, 0.4 * radius, 0.6 * radius, 0.42 * radius
    hole = [(tip + gap, -1.0), (tip + gap, _CONE), (collar + gap, _CONE)]
    hole += [(collar + gap, end), (button + gap, end), (button + gap, 1.0)]
    spline = 0.14 * radius, 0.76 * radius
    inner = turned([(0.0, -1.0), *hole, (0.0, 1.0)])
    inner += box((-spline[0] - gap, -spline[1] - gap, _CONE), (spline[0] + gap, spline[1] + gap, end))
    workshop.body(
        "barrel", _lie(values, _barrel(values, length, radius) - inner, _clip(values, length - 0.045, length))
    )
    top = length + _STROKE + 0.004
    refill = [(tip, 0.002), (tip, ledge), (rod, ledge), (rod, end - 0.004), (collar, end - 0.004)]
    refill += [(collar, end - gap), (button, end - gap), (button, top)]
    splines = box((-spline[0], -spline[1], end - 0.02), (spline[0], spline[1], end - gap))
    workshop.body("button", _lie(values, turned([(0.0, 0.002), *refill, (0.0, top)]), splines), material="metal")
    limits, rest = (0.0, _STROKE), values.number("open")
    workshop.slides("button", "barrel", (0, -1, 0), (0, length, radius), limits, rest=rest)


def _cap(values: Values, workshop: Workshop) -> None:
    """A cap that is drawn off the front; both have six sides there, so that it does not turn."""
    length, radius, gap = values.number("length"), 0.5 * values.number("width"), min(values.number("clearance"), _TIGHT)
    covered = 0.42 * length
    rear = cylinder(radius, (0, 0, covered), (0, 0, length))
    inner = radius - _CAP - gap
    front_half = _barrel(values, covered + 1e-3, inner) ^ cylinder(inner, (0, 0, -1.0), (0, 0, 1.0), segments=_SIDES)
    workshop.body("barrel", _lie(values, front_half, rear))
    front, end = -0.006, covered - gap
    shell = cylinder(radius, (0, 0, front), (0, 0, end)) - bore(
        inner, gap, (0, 0, -0.002), (0, 0, 1.0), segments=_SIDES
    )
    inside = cylinder(radius - 0.5 * _CAP, (0, 0, -0.002), (0, 0, end - 0.001))
    clip = _clip(values, covered - 0.006, front) - inside
    workshop.body("cap", _lie(values, shell, clip))
    travel, rest = (0.0, covered + 0.01), values.number("open")
    workshop.slides("cap", "barrel", (0, -1, 0), (0, 0, radius), travel, rest=rest)


def _twist(values: Values, workshop: Workshop) -> None:
    """The rear half turns on the front half and drives the tip."""
    length, radius, gap = values.number("length"), 0.5 * values.number("width"), min(values.number("clearance"), _TIGHT)
    middle = 0.55 * length
    _, hole, rotor = stub((0, 0, middle), (0, 0, 1), radius, gap, length=0.12 * length)
    tip = cylinder(6e-4, (0, 0, -0.002), (0, 0, _CONE), segments=16)
    workshop.body("barrel", _lie(values, _barrel(values, middle, radius) - hole, tip))
    collar = cylinder(radius + 5e-4, (0, 0, middle + gap), (0, 0, middle + gap + 0.002))
    rear = cylinder(radius, (0, 0, middle + gap), (0, 0, length))
    workshop.body("grip", _lie(values, rotor, rear, collar, _clip(values, length - 0.045, length)), material="metal")
    workshop.turns("grip", "barrel", (0, 1, 0), (0, middle, radius), (0.0, 3.0), rest=values.number("open"))


FAMILY = family("pen", _build)
