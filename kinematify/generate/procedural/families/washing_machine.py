"""Washing machines and dryers: a round door, a drum behind it, a detergent drawer, a knob and buttons."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import barrel, stub
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_button, add_knob
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_drawer, room
from kinematify.generate.procedural.solids import box, cylinder

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_STRIP = 0.14  # height of the strip with the controls [m]
_WALL = 0.03
_DOOR = 0.03  # thickness [m]
_HINGE = (0.006, 0.09)  # radius and length of the door's hinge [m]


def _build(values: Values, workshop: Workshop) -> None:
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    front = box((-0.5 * width, 0, 0), (0.5 * width, depth, height))
    tub = 0.5 * min(width, height - _STRIP) - _WALL
    centre = (0.0, 0.5 * (height - _STRIP))
    cavity = cylinder(tub, (0, _WALL, centre[1]), (0, depth - _WALL, centre[1]))
    mouth = cylinder(0.72 * tub, (0, -1.0, centre[1]), (0, 0.5 * depth, centre[1]))
    workshop.body("body", front - cavity - mouth)
    _add_drum(values, workshop, tub, centre[1])
    _add_door(values, workshop, 0.86 * tub, centre[1])
    _add_controls(values, workshop)


def _add_drum(values: Values, workshop: Workshop, tub: float, level: float) -> None:
    """A drum with three ribs on a shaft in the back wall."""
    clearance, back = values.number("clearance"), values.number("depth") - _WALL
    radius = tub - 0.01 - clearance
    start, end = (0, _WALL + 0.01, level), (0, back - 0.04, level)
    inner = cylinder(radius - 0.004, (0, 0, level), (0, back - 0.045, level))
    pivot = (0.0, back - 0.02, level)
    boss, hole, rotor = stub(pivot, (0, -1, 0), 0.03, clearance, length=0.022)
    workshop.add("body", boss)
    workshop.cut("body", hole)
    rib = box((-0.012, start[1] + 0.01, level + 0.75 * radius), (0.012, end[1], level + radius - 0.002))
    ribs = [rib.translate((0, 0, -level)).rotate((0, 120 * k, 0)).translate((0, 0, level)) for k in range(3)]
    workshop.body("drum", rotor, cylinder(radius, start, end) - inner, *ribs, material="steel")
    workshop.turns("drum", "body", (0, -1, 0), pivot)


def _add_door(values: Values, workshop: Workshop, radius: float, level: float) -> None:
    """A round door on a barrel hinge beside its rim."""
    clearance = values.number("clearance")
    side = 1.0 if values.choice("hinge_side") == "right" else -1.0
    barrel_radius, length = _HINGE
    back, front = -clearance, -clearance - _DOOR
    pivot = (side * (radius + barrel_radius + clearance), 0.5 * (back + front), level)
    reach = math.hypot(radius, 0.5 * length) - radius + barrel_radius + clearance  # to the rim at the barrel's ends
    on_body = (-0.004, 0.004, -pivot[1] - 1e-3, -pivot[1] + 0.01)
    on_door = (reach, reach + 0.02, -0.4 * _DOOR, 0.4 * _DOOR)
    halves = barrel(length, barrel_radius, clearance, (on_body, on_door))
    of_body, of_door = ((half if side < 0 else half.mirror((1, 0, 0))).translate(pivot) for half in halves)
    workshop.add("body", of_body)
    disc = cylinder(radius, (0, back, level), (0, front, level))
    glass = cylinder(0.7 * radius, (0, front - 1.0, level), (0, front + 0.006, level))
    grip_at = -side * 0.88 * radius
    grip = box((grip_at - 0.01, front - 0.012, level - 0.05), (grip_at + 0.01, front + 1e-3, level + 0.05))
    workshop.body("door", disc - glass, of_door, grip)
    workshop.turns("door", "body", (0, 0, side), pivot, (0.0, 1.9), rest=values.number("open"))


def _add_controls(values: Values, workshop: Workshop) -> None:
    """From left to right: drawer, knob, buttons."""
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance, rest, level = values.number("clearance"), values.number("open"), height - 0.5 * _STRIP
    opening = Opening(
        left=-0.47 * width,
        right=-0.15 * width,
        bottom=height - _STRIP + 0.02,
        top=height - 0.02,
        depth=0.6 * depth,
        wall=0.012,
    )
    workshop.cut("body", room(opening))
    add_drawer(workshop, "drawer", "body", opening, Fitting(clearance=clearance, grip="edge", rest=rest))
    mount = Mount(parent="body", place=(0, 0, level), face=FRONT, clearance=clearance, depth=0.03)
    add_knob(workshop, "knob", mount, min(0.035, 0.1 * width), endless=values.choice("knob") == "endless", rest=rest)
    count = values.count("buttons")
    for k in range(count):
        x = (0.17 + 0.3 * (k + 0.5) / count) * width
        mount = Mount(parent="body", place=(x, 0, level), face=FRONT, clearance=clearance, depth=0.03)
        add_button(workshop, f"button_{k + 1}", mount, (0.2 * width / count - 2 * clearance, 0.014), travel=0.003)


FAMILY = family("washing_machine", _build)
