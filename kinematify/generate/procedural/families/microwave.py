"""Microwave ovens: a door at the left, a control panel at the right, and a turntable inside."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_button, add_knob, grid
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_door, carcass
from kinematify.generate.procedural.solids import box, cylinder

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_WALL = 0.03
_PANEL = 0.26  # share of the width that the control panel takes


def _build(values: Values, workshop: Workshop) -> None:
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance = values.number("clearance")
    border = (0.5 - _PANEL) * width
    behind = depth - _WALL - clearance  # the panel stands out as far as the door
    opening = Opening(left=-0.5 * width, right=border, bottom=0.0, top=height, depth=behind, wall=_WALL)
    panel = box((border + 0.002, -_WALL - clearance, 0), (0.5 * width, 1e-3, height))
    workshop.body("body", carcass(width, height, behind, [opening]), panel)
    fitting = Fitting(clearance=clearance, grip=values.choice("handle"), rest=values.number("open"))
    add_door(workshop, "door", "body", opening, fitting, side="left", outermost=True, hinge=values.choice("hinge"))
    margin, front = 0.15 * opening.width, -clearance - _WALL
    recess = box((opening.left + margin, -1.0, margin), (border - 1.2 * margin, front + 0.003, height - margin))
    workshop.cut("door", recess)
    _add_turntable(workshop, opening, clearance)
    _add_controls(values, workshop, 0.5 * (border + 0.5 * width), front)


def _add_turntable(workshop: Workshop, opening: Opening, clearance: float) -> None:
    """A glass plate with a rim on a shaft in the floor."""
    radius = 0.44 * min(opening.width - _WALL, opening.depth - _WALL)
    floor, centre = 0.5 * _WALL, (0.5 * (opening.left + opening.right), 0.5 * (opening.depth - _WALL))
    pivot = (*centre, floor + 0.006)
    boss, hole, rotor = stub(pivot, (0, 0, 1), 0.015, clearance, length=0.012)
    workshop.add("body", boss)
    workshop.cut("body", hole)
    level = pivot[2] + 0.011 + clearance  # the plate's bottom is one with the flange
    plate = cylinder(radius, (*centre, level), (*centre, level + 0.012))
    hollow = cylinder(radius - 0.006, (*centre, level + 0.005), (*centre, level + 0.02))
    workshop.body("turntable", rotor, plate - hollow, material="glass")
    workshop.turns("turntable", "body", (0, 0, 1), pivot)


def _add_controls(values: Values, workshop: Workshop, x: float, front: float) -> None:
    """Knobs above buttons, in the middle of the panel."""
    width, height = _PANEL * values.number("width"), values.number("height")
    clearance, rest = values.number("clearance"), values.number("open")
    knobs, buttons = values.count("knobs"), values.count("buttons")
    border = 0.55 * height if knobs else 0.85 * height

    def mount(u: float, z: float) -> Mount:
        return Mount(parent="body", place=(x + u, front, z), face=FRONT, clearance=clearance, depth=0.02)

    for k in range(knobs):
        radius = min(0.3 * width, 0.3 * height / knobs)
        z = border + (knobs - k - 0.5) * (0.95 * height - border) / knobs
        add_knob(workshop, f"knob_{k + 1}", mount(0.0, z), min(radius, 0.17 * height / knobs), rest=rest)
    columns, rows = (3, -(-buttons // 3)) if buttons > 3 else (1, max(1, buttons))
    size = (0.8 * width, border - 0.1 * height)
    pitch = min(size[0] / columns, 0.03), min(size[1] / rows, 0.03)
    area = (pitch[0] * columns, pitch[1] * rows)
    middle = 0.05 * height + 0.5 * size[1]
    for k, (u, v) in enumerate(grid(buttons, columns, area)):
        cap = (0.9 * pitch[0] - 2 * clearance - 0.002, 0.9 * pitch[1] - 2 * clearance - 0.002)
        add_button(workshop, f"button_{k + 1}", mount(u, middle + v), cap, travel=0.002)


FAMILY = family("microwave", _build)
