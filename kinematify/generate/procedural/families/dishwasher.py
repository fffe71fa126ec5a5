"""Dishwashers: a door that falls open, racks on rails and a spray arm inside."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_button
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_flap, carcass
from kinematify.generate.procedural.solids import box, tray, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_WALL = 0.04
_PLINTH = 0.1
_ARM = 0.07  # height that the spray arm needs above the floor of the room [m]
_RAIL = 0.012


def _build(values: Values, workshop: Workshop) -> None:
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance, rest = values.number("clearance"), values.number("open")
    opening = Opening(left=-0.5 * width, right=0.5 * width, bottom=_PLINTH, top=height, depth=depth, wall=_WALL)
    workshop.body("body", carcass(width, height, depth, [opening]))
    fitting = Fitting(clearance=clearance, grip=values.choice("handle"), rest=rest)
    add_flap(workshop, "door", "body", opening, fitting, hinge=values.choice("hinge"))
    _add_buttons(values, workshop, opening)
    _add_spray_arm(workshop, opening, clearance)
    _add_racks(values, workshop, opening)


def _add_buttons(values: Values, workshop: Workshop, opening: Opening) -> None:
    """A row of buttons at the upper edge of the door, above its handle."""
    count, clearance = values.count("buttons"), values.number("clearance")
    for k in range(count):
        x = (k - 0.5 * (count - 1)) * 0.03
        place = (x, -clearance - _WALL, opening.top - 0.012)
        mount = Mount(parent="door", place=place, face=FRONT, clearance=clearance, depth=0.02)
        add_button(workshop, f"button_{k + 1}", mount, (0.018, 0.01), travel=0.002)


def _add_spray_arm(workshop: Workshop, opening: Opening, clearance: float) -> None:
    floor, middle = opening.bottom + 0.5 * _WALL, 0.5 * (opening.depth - _WALL)
    pivot = (0.0, middle, floor + 0.02)
    boss, hole, rotor = stub(pivot, (0, 0, 1), 0.015, clearance, length=0.022)
    workshop.add("body", boss)
    workshop.cut("body", hole)
    half = 0.42 * min(opening.width - _WALL, opening.depth - _WALL)
    level = pivot[2] + clearance + 0.012
    blade = box((-half, middle - 0.02, level), (half, middle + 0.02, level + 0.01))
    workshop.body("spray_arm", rotor, blade)
    workshop.turns("spray_arm", "body", (0, 0, 1), pivot)


def _add_racks(values: Values, workshop: Workshop, opening: Opening) -> None:
    """Baskets on rails at both walls; they come forward as far as the closed door lets them."""
    count, clearance = values.count("racks"), values.number("clearance")
    half, back = 0.5 * (opening.width - _WALL), opening.depth - _WALL
    lowest, top = opening.bottom + 0.5 * _WALL + _ARM, opening.top - 0.5 * _WALL
    pitch, travel = (top - lowest) / count, values.number("reach") * back
    for k in range(count):
        level = lowest + (count - 1 - k) * pitch
        rails = [
            box((x0, 0.01, level), (x1, back + 1e-3, level + _RAIL))
            for x0, x1 in ((-half - 1e-3, -half + 0.02), (half - 0.02, half + 1e-3))
        ]
        workshop.add("body", *rails)
        lower = (-half + 0.004 + clearance, 0.012 + travel, level + _RAIL + clearance)
        upper = (half - 0.004 - clearance, back - clearance, level + 0.75 * pitch)
        workshop.body(f"rack_{k + 1}", _basket(lower, upper), material="steel")
        middle = (0.0, 0.5 * (lower[1] + upper[1]), lower[2])
        workshop.slides(f"rack_{k + 1}", "body", (0, -1, 0), middle, (0.0, travel), rest=values.number("open"))


def _basket(lower: tuple[float, float, float], upper: tuple[float, float, float]) -> Manifold:
    """A tray whose floor has slots."""
    count, wall = 6, 0.006
    pitch = (upper[0] - lower[0] - 0.06) / count
    slots = [
        box(
            (lower[0] + 0.03 + k * pitch, lower[1] + 0.03, lower[2] - 0.01),
            (lower[0] + 0.03 + (k + 0.6) * pitch, upper[1] - 0.03, lower[2] + 0.02),
        )
        for k in range(count)
    ]
    return tray(lower, upper, wall) - union(*slots)


FAMILY = family("dishwasher", _build)
