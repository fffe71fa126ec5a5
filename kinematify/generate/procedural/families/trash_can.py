"""Trash cans: a pedal and a hinged lid, a flap that swings both ways, or a lid that is lifted off."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.handles import handle
from kinematify.generate.procedural.pieces.lids import BackEdge, add_barrels
from kinematify.generate.procedural.solids import bore, box, cylinder, tray

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_WALL = 0.004
_BASE = 0.06  # height of the solid foot that holds a pedal [m]
_PEDAL = 0.2  # way of the pedal [rad]


def _build(values: Values, workshop: Workshop) -> None:
    {"pedal": _pedal, "swing": _swing, "lift": _lift}[values.choice("lid")](values, workshop)


def _bin(values: Values, foot: float) -> Manifold:
    """A round or a square bin, its axis at the origin, with a floor at the height of its foot."""
    half, height = 0.5 * values.number("width"), values.number("height")
    if values.choice("shape") == "square":
        lower, upper = (-half, -half, foot), (half, half, height)
        return tray(lower, upper, _WALL) + box((-half, -half, 0), (half, half, foot))
    inner = cylinder(half - _WALL, (0, 0, foot + _WALL), (0, 0, height + 1.0))
    return cylinder(half, (0, 0, 0), (0, 0, height)) - inner


def _cover(values: Values, grow: float, bottom: float, top: float) -> Manifold:
    """A plate of the shape of the bin, wider by `grow` on all sides."""
    half = 0.5 * values.number("width") + grow
    if values.choice("shape") == "square":
        return box((-half, -half, bottom), (half, half, top))
    return cylinder(half, (0, 0, bottom), (0, 0, top))


def _pedal(values: Values, workshop: Workshop) -> None:
    half, height = 0.5 * values.number("width"), values.number("height")
    clearance, rest = values.number("clearance"), values.number("open")
    level, thick, seat = height + clearance, 0.012, 0.04
    workshop.body("body", _bin(values, _BASE), box((-seat, 0.8 * half, height - 0.03), (seat, half + 0.002, height)))
    workshop.cut("body", _inside(half, height))
    back = box((-seat, 0.0, level), (seat, half + 0.002, level + thick))
    workshop.body("lid", _cover(values, 0.0, level, level + thick), back)
    edge = BackEdge(y=half + 0.002, level=level, below=0.03, above=thick, clearance=clearance)
    pivot = add_barrels(workshop, ("body", "lid"), edge, (0.0,), length=2.0 * seat, radius=0.004)
    workshop.turns("lid", "body", (-1, 0, 0), pivot, (0.0, 1.5), rest=rest)
    _add_pedal(workshop, half, clearance, rest)


def _inside(half: float, height: float) -> Manifold:
    """Keeps the seat of the hinge from reaching into the bin."""
    return cylinder(half - _WALL, (0, 0, _BASE + _WALL), (0, 0, height + 1.0))


def _add_pedal(workshop: Workshop, half: float, clearance: float, rest: float) -> None:
    """A lever on a pin across a slot of the foot; its end in front goes down."""
    wide, level, radius = 0.025, 0.036, 0.005
    back, tip = -half + 0.06, -half - 0.05
    slot = box((-wide, -2.0 * half, 0.006), (wide, back + 3.0 * radius, _BASE - 0.006))
    pin = (-wide - 0.01, back, level), (wide + 0.01, back, level)
    hole = (pin[0][0] - 2e-3, back, level), (pin[1][0] + 2e-3, back, level)
    workshop.cut("body", slot, bore(radius, clearance, *hole))
    inner = wide - max(clearance, 5e-4)
    arm = box((-inner, tip + 0.02, level - radius), (inner, back, level + radius))
    plate = box((-1.6 * wide, tip, level - radius), (1.6 * wide, tip + 0.035, level + radius))
    hub = cylinder(1.4 * radius, (-inner, back, level), (inner, back, level))
    workshop.body("pedal", arm, plate, hub, cylinder(radius, *pin), material="steel")
    workshop.turns("pedal", "body", (1, 0, 0), (0, back, level), (0.0, _PEDAL), rest=rest)


def _swing(values: Values, workshop: Workshop) -> None:
    """A flap in the mouth on two pins in the side walls."""
    half, height, clearance = 0.5 * values.number("width"), values.number("height"), values.number("clearance")
    level = height - 0.3 * half
    inner, radius = half - _WALL, 0.004
    if values.choice("shape") == "square":
        reach = inner - clearance - 0.002
        flap = box((-reach, -reach, level - 0.003), (reach, reach, level + 0.003))
    else:  # a round flap is narrower than the mouth, so that it does not meet the wall when it hangs down
        reach = 0.97 * inner - clearance
        flap = cylinder(reach, (0, 0, level - 0.003), (0, 0, level + 0.003))
    ridge = box((-0.5 * reach, -0.008, level), (0.5 * reach, 0.008, level + 0.012))
    pin = (-half - 0.002, 0, level), (half + 0.002, 0, level)
    steepest = math.asin(min(0.93, 0.95 * (level - _WALL) / (reach + 0.01)))  # above the floor
    workshop.body("body", _bin(values, 0.0))
    workshop.cut("body", bore(radius, clearance, (-2.0 * half, 0, level), (2.0 * half, 0, level)))
    workshop.body("flap", flap, ridge, cylinder(radius, *pin))
    workshop.turns("flap", "body", (1, 0, 0), (0, 0, level), (-steepest, steepest), rest=values.number("open"))


def _lift(values: Values, workshop: Workshop) -> None:
    """A lid with a skirt around the rim and a handle."""
    height, gap = values.number("height"), values.number("clearance")
    skirt = 0.1 * height
    top = height + gap + _WALL
    cap = _cover(values, gap + 1.5 * _WALL, height - skirt, top) - _cover(values, gap, -1.0, height + gap)
    grip = [
        solid.rotate((-90, 0, 0)).translate((0, 0, top)) for solid in handle("knob", (0, 0, 0), along="x", length=0)
    ]
    workshop.body("body", _bin(values, 0.0))
    workshop.body("lid", cap, *grip)
    workshop.slides("lid", "body", (0, 0, 1), (0, 0, height), (0.0, 1.2 * skirt), rest=values.number("open"))


FAMILY = family("trash_can", _build)
