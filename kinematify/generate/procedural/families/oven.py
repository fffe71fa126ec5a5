"""Ovens and stoves: a door that falls open, and knobs above it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_knob
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_flap, carcass
from kinematify.generate.procedural.solids import box, cylinder

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_WALL = 0.04
_PLINTH = 0.1  # below the door, so that its handle does not reach the floor [m]


def _build(values: Values, workshop: Workshop) -> None:
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance, rest = values.number("clearance"), values.number("open")
    strip = min(0.12, max(0.07, 0.14 * height))
    opening = Opening(left=-0.5 * width, right=0.5 * width, bottom=_PLINTH, top=height - strip, depth=depth, wall=_WALL)
    workshop.body("body", carcass(width, height, depth, [opening]), *_grate(opening))
    if values.choice("top") == "burners":
        workshop.cut("body", *_burners(width, depth, height))
    fitting = Fitting(clearance=clearance, grip=values.choice("handle"), rest=rest)
    add_flap(workshop, "door", "body", opening, fitting, hinge=values.choice("hinge"))
    workshop.cut("door", _window(opening, clearance))
    knobs = values.count("knobs")
    for k in range(knobs):
        x = ((k + 0.5) / knobs - 0.5) * 0.9 * width
        mount = Mount(
            parent="body", place=(x, 0, height - 0.5 * strip), face=FRONT, clearance=clearance, depth=0.5 * strip
        )
        add_knob(workshop, f"knob_{k + 1}", mount, min(0.3 * strip, 0.35 * width / knobs), rest=rest)


def _grate(opening: Opening) -> list[Manifold]:
    """A grate of bars from wall to wall in the middle of the room."""
    level, inner = 0.5 * (opening.bottom + opening.top), 0.5 * _WALL - 1e-3
    first, last = 0.04, opening.depth - _WALL - 0.02
    return [
        box((opening.left + inner, y, level), (opening.right - inner, y + 0.006, level + 0.006))
        for y in (first + k / 6.0 * (last - first) for k in range(7))
    ]


def _burners(width: float, depth: float, height: float) -> list[Manifold]:
    """Ring-shaped grooves in the top."""
    rings = []
    for x, y, share in ((-1, 0.28, 0.13), (1, 0.28, 0.17), (-1, 0.72, 0.17), (1, 0.72, 0.13)):
        radius, centre = share * min(width, depth), (0.24 * x * width, y * depth)
        disc = cylinder(radius, (*centre, height - 0.002), (*centre, height + 0.01))
        rings.append(disc - cylinder(radius - 0.004, (*centre, height - 0.01), (*centre, height + 0.02)))
    return rings


def _window(opening: Opening, clearance: float) -> Manifold:
    """A shallow recess in the door's front where the glass is."""
    front = -clearance - _WALL
    margin = 0.15 * min(opening.width, opening.height)
    return box(
        (opening.left + margin, front - 0.01, opening.bottom + margin),
        (opening.right - margin, front + 0.003, opening.top - 0.3 * opening.height),
    )


FAMILY = family("oven", _build)
