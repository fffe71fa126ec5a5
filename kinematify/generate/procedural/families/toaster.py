"""Toasters: levers in front that carry the bread down, knobs, and a crumb tray."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_knob
from kinematify.generate.procedural.solids import box, cylinder, hull, union

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_WALL = 0.012
_SHAFT = 0.05  # y where the slots for the bread begin; in front of it is the room of the levers [m]
_FLOOR = 0.034  # underside of the slots [m]
_PLATE = 0.005  # thickness of what carries the bread [m]


def _build(values: Values, workshop: Workshop) -> None:
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    half, round_ = 0.5 * width, 0.02
    corners = [(s * (half - round_), y) for s in (-1, 1) for y in (round_, depth - round_)]
    workshop.body("body", hull(*(cylinder(round_, (x, y, 0), (x, y, height)) for x, y in corners)))
    share = (width - 2.0 * round_) / values.count("levers")
    for k in range(values.count("levers")):
        middle = (k + 0.5) * share - half + round_
        _add_lever(values, workshop, f"lever_{k + 1}", middle, share)
        if values.choice("knob") == "knob":
            radius = min(0.014, 0.13 * share)
            place = (middle + 0.33 * share, 0.0, 0.3 * height)
            clearance = min(values.number("clearance"), 0.25 * radius)
            mount = Mount(parent="body", place=place, face=FRONT, clearance=clearance, depth=0.8 * _WALL)
            add_knob(workshop, f"knob_{k + 1}", mount, radius, rest=values.number("open"))
    if values.choice("tray") == "tray":
        _add_tray(values, workshop)


def _add_lever(values: Values, workshop: Workshop, name: str, middle: float, share: float) -> None:
    """A lever in an upright slit, one piece with the plates that carry the bread; it moves down."""
    depth, height, count = values.number("depth"), values.number("height"), values.count("slots")
    clearance = values.number("clearance")
    wide = min(0.032, 0.72 * share / count)
    back, slit = depth - 0.03, 0.004
    level = max(0.62 * height, _FLOOR + 0.05)
    low = _FLOOR + clearance + 0.001
    across = 0.5 * count * (wide + 0.01)
    room = box((middle - across, _WALL, _FLOOR), (middle + across, _SHAFT + 1e-3, height - 0.02))
    opening = box((middle - slit - clearance, -1.0, low - 0.002), (middle + slit + clearance, _SHAFT, level + 0.012))
    plates, rooms = [], [room, opening]
    gap = clearance + 0.001
    for k in range(count):
        x = middle + (k - 0.5 * (count - 1)) * (wide + 0.01)
        rooms.append(box((x - 0.5 * wide, _SHAFT, _FLOOR), (x + 0.5 * wide, back, height + 1.0)))
        plates.append(box((x - 0.5 * wide + gap, 0.03, level), (x + 0.5 * wide - gap, back - gap, level + _PLATE)))
    left = middle - 0.5 * (count - 1) * (wide + 0.01) - 0.5 * wide + gap
    bridge = box((left, 0.026, level), (2.0 * middle - left, 0.038, level + _PLATE))
    stem = box((middle - slit, -0.012, level), (middle + slit, 0.03, level + _PLATE))
    grip = min(0.014, 0.16 * share)
    knob = box((middle - grip, -0.028, level - 0.004), (middle + grip, -0.01, level + 0.009))
    workshop.cut("body", union(*rooms))
    workshop.body(name, bridge, stem, knob, *plates)
    workshop.slides(name, "body", (0, 0, -1), (middle, 0, level), (0.0, level - low), rest=values.number("open"))


def _add_tray(values: Values, workshop: Workshop) -> None:
    """A flat tray for crumbs that comes out behind."""
    width, depth, clearance = values.number("width"), values.number("depth"), values.number("clearance")
    half, front = 0.5 * width - 0.03, 0.04
    workshop.cut("body", box((-half, front, 0.008), (half, depth + 1.0, 0.024)))
    gap = clearance
    outer = box((gap - half, front + gap, 0.008 + gap), (half - gap, depth - 0.002, 0.024 - gap))
    inner = box((gap + 0.003 - half, front + gap + 0.003, 0.011 + gap), (half - gap - 0.003, depth - 0.006, 1.0))
    lip = box((-0.2 * half, depth - 0.003, 0.012), (0.2 * half, depth + 0.014, 0.02))
    workshop.body("tray", outer - inner, lip, material="metal")
    travel = 0.7 * (depth - front)
    workshop.slides("tray", "body", (0, 1, 0), (0, depth, 0.016), (0.0, travel), rest=values.number("open"))


FAMILY = family("toaster", _build)
