"""Refrigerators: thick doors with bins inside, one above the other or side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_door, carcass
from kinematify.generate.procedural.solids import box, tray

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_WALL = 0.05  # a door's thickness; walls of the body are half as thick, between two rooms as thick [m]
_INSET = 0.06  # of a bin from the room's sides, so that it swings out of the room [m]
_BIN = 0.07  # depth of a bin [m]
_PITCH = 0.3  # between shelves [m]


def _build(values: Values, workshop: Workshop) -> None:
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    fields = _fields(values.count("doors"), values.choice("freezer"))
    openings = [
        Opening(
            left=(left - 0.5) * width,
            right=(right - 0.5) * width,
            bottom=bottom * height,
            top=top * height,
            depth=depth,
            wall=_WALL,
        )
        for left, right, bottom, top in fields
    ]
    shelves = [shelf for opening in openings for shelf in _shelves(opening)]
    workshop.body("body", carcass(width, height, depth, openings), *shelves)
    fitting = Fitting(clearance=values.number("clearance"), grip=values.choice("handle"), rest=values.number("open"))
    for k, (field, opening) in enumerate(zip(fields, openings, strict=True)):
        side = values.choice("hinge_side") if field[1] - field[0] == 1.0 else "left" if field[0] == 0.0 else "right"
        name, hinge = f"door_{k + 1}", values.choice("hinge")
        add_door(workshop, name, "body", opening, fitting, side=side, outermost=True, hinge=hinge)
        workshop.add(name, *_bins(opening, fitting.clearance))


def _fields(doors: int, freezer: str) -> list[tuple[float, float, float, float]]:
    """Left, right, bottom and top of each door as shares of the front."""
    if doors == 1:
        return [(0.0, 1.0, 0.0, 1.0)]
    if doors == 2 and freezer == "side":
        return [(0.0, 0.42, 0.0, 1.0), (0.42, 1.0, 0.0, 1.0)]
    if doors == 2 and freezer == "none":
        return [(0.0, 0.5, 0.0, 1.0), (0.5, 1.0, 0.0, 1.0)]
    low = 0.34 if freezer == "bottom" else 0.66
    halves = ((0.0, 0.5), (0.5, 1.0))
    upper = halves if doors >= 3 and (freezer != "top" or doors == 4) else ((0.0, 1.0),)
    lower = halves if doors == 4 or (doors == 3 and freezer == "top") else ((0.0, 1.0),)
    return [(*span, low, 1.0) for span in upper] + [(*span, 0.0, low) for span in lower]


def _shelves(opening: Opening) -> list[Manifold]:
    """Glass shelves in a room, behind the bins of the door."""
    count = int(opening.height / _PITCH)
    inset, pitch = 0.5 * _WALL, opening.height / (count + 1)
    levels = [opening.bottom + (k + 1) * pitch for k in range(count)]
    return [
        box((opening.left + inset, _BIN + 0.03, z), (opening.right - inset, opening.depth - inset, z + 0.006))
        for z in levels
    ]


def _bins(opening: Opening, clearance: float) -> list[Manifold]:
    """Bins on the inner side of a door."""
    left, right = opening.left + _INSET, opening.right - _INSET
    count = int(opening.height / _PITCH)
    if right - left < 0.06:
        return []
    pitch = opening.height / (count + 1)
    levels = [opening.bottom + 0.07 + k * pitch for k in range(count)]
    return [tray((left, -clearance - 1e-3, z), (right, _BIN, z + 0.08), 0.004) for z in levels]


FAMILY = family("fridge", _build)
