"""Button panels and keypads: buttons in rows on a housing, with knobs and a display above them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_button, add_knob, grid
from kinematify.generate.procedural.solids import box

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_DEEP = 0.012  # pockets of the buttons [m]


def _build(values: Values, workshop: Workshop) -> None:
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    workshop.body("housing", box((-0.5 * width, 0, 0), (0.5 * width, depth, height)))
    top = 0.94 * height
    if values.choice("display") == "display":
        workshop.cut("housing", box((-0.42 * width, -1.0, top - 0.16 * height), (0.42 * width, 0.002, top)))
        top -= 0.2 * height
    if values.count("knobs"):
        _add_knobs(values, workshop, top - 0.1 * height)
        top -= 0.22 * height
    _add_buttons(values, workshop, 0.06 * height, top)


def _add_knobs(values: Values, workshop: Workshop, level: float) -> None:
    count, width = values.count("knobs"), values.number("width")
    pitch = 0.9 * width / count
    radius = min(0.09 * values.number("height"), 0.38 * pitch)
    for k in range(count):
        x = (k - 0.5 * (count - 1)) * pitch
        clearance = min(values.number("clearance"), 0.2 * radius)
        mount = Mount(parent="housing", place=(x, 0, level), face=FRONT, clearance=clearance, depth=_DEEP)
        add_knob(workshop, f"knob_{k + 1}", mount, radius, rest=values.number("open"))


def _add_buttons(values: Values, workshop: Workshop, bottom: float, top: float) -> None:
    width, count = values.number("width"), values.count("buttons")
    columns = min(values.count("columns"), count)
    rows = -(-count // columns)
    pitch = min(0.9 * width / columns, (top - bottom) / rows)
    clearance = min(values.number("clearance"), 0.08 * pitch)
    area = (columns * min(0.9 * width / columns, 1.6 * pitch), rows * min((top - bottom) / rows, 1.6 * pitch))
    size = (0.84 * pitch - 2.0 * clearance,) * 2
    for k, (x, z) in enumerate(grid(count, columns, area)):
        place = (x, 0.0, 0.5 * (bottom + top) + z)
        mount = Mount(parent="housing", place=place, face=FRONT, clearance=clearance, depth=_DEEP)
        is_round = values.choice("shape") == "round"
        travel = min(0.004, 0.3 * pitch)
        add_button(workshop, f"button_{k + 1}", mount, size, travel=travel, is_round=is_round)


FAMILY = family("button_panel", _build)
