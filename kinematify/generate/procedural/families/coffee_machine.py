"""Coffee machines: with a jug under a filter that swings out, or with portafilters and a steam wand."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_button, add_knob
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_door, add_drawer, room
from kinematify.generate.procedural.pieces.lids import BackEdge, add_barrels
from kinematify.generate.procedural.solids import box, cylinder, rod, union

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_WALL = 0.012
_BASE = 0.05  # height of the base [m]
_LID = 0.01  # thickness [m]
_HINGE = 0.004  # radius [m]


def _build(values: Values, workshop: Workshop) -> None:
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    head, column = _head(values), 0.6 * depth
    half, top = 0.5 * width, height - _LID
    workshop.body(
        "body",
        box((-half, 0, 0), (half, depth, _BASE)),
        box((-half, column, 0), (half, depth, top)),
        box((-half, 0, head), (half, depth, top)),
    )
    _add_lid(values, workshop)
    if values.choice("kind") == "filter":
        _add_filter(values, workshop)
        _add_jug(values, workshop)
    else:
        _add_espresso(values, workshop)
    _add_buttons(values, workshop)


def _head(values: Values) -> float:
    """Underside of what stands over the jug or the cups [m]."""
    return values.number("height") - max(0.3 * values.number("height"), 0.1)


def _add_lid(values: Values, workshop: Workshop) -> None:
    """A lid over the water tank, hinged behind."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    clearance, half = values.number("clearance"), 0.5 * width
    level, front = height - _LID, 0.6 * depth
    below = level - clearance
    tank = box((_WALL - half, front + _WALL, _BASE + _WALL), (half - _WALL, depth - _WALL, height + 1.0))
    above = box((-half - 1.0, -1.0, below), (half + 1.0, depth + 1.0, height + 1.0))
    workshop.cut("body", tank, above)
    lid = box((-half, front, level), (half, depth, height))
    grip = box((-0.1 * width, front - 0.008, level + 0.003), (0.1 * width, front + 0.01, height))
    workshop.body("lid", lid, grip)
    edge = BackEdge(y=depth, level=level, below=0.1, above=_LID, clearance=clearance)
    pivot = add_barrels(workshop, ("body", "lid"), edge, (-0.3 * width, 0.3 * width), length=0.04, radius=_HINGE)
    workshop.turns("lid", "body", (-1, 0, 0), pivot, (0.0, 1.8), rest=values.number("open"))


def _add_filter(values: Values, workshop: Workshop) -> None:
    """A door with the filter's basket behind it; both swing out to the left."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    clearance, head = values.number("clearance"), _head(values)
    opening = Opening(
        left=-0.5 * width, right=0.5 * width, bottom=head, top=height - _LID - clearance, depth=0.6 * depth, wall=_WALL
    )
    workshop.cut("body", room(opening))
    fitting = Fitting(clearance=clearance, grip="edge", rest=values.number("open"))
    add_door(workshop, "filter", "body", opening, fitting, side="left", outermost=True, hinge=values.choice("hinge"))
    radius = min(0.22 * width, 0.2 * depth)
    bottom, top = head + _WALL, opening.top - _WALL
    centre = (0.0, radius + 0.012 + clearance)
    cup = cylinder(radius, (*centre, bottom), (*centre, top)) - cylinder(
        radius - 0.003, (*centre, bottom + 0.003), (*centre, top + 1.0)
    )
    arm = box((-0.02, -0.5 * _WALL - clearance, bottom), (0.02, 0.014 + clearance, top))
    workshop.add("filter", cup, arm - cylinder(radius - 0.003, (*centre, bottom + 0.003), (*centre, top + 1.0)))


def _add_jug(values: Values, workshop: Workshop) -> None:
    """A jug on the hot plate, which is drawn out to the front."""
    width, depth, clearance = values.number("width"), values.number("depth"), values.number("clearance")
    radius = min(0.4 * width, 0.26 * depth)
    level = _BASE + clearance
    top = _BASE + 0.8 * (_head(values) - _BASE)
    y = 0.3 * depth
    glass = cylinder(radius, (0, y, level), (0, y, top))
    hollow = cylinder(radius - 0.004, (0, y, level + 0.004), (0, y, top + 1.0))
    reach = y - radius
    grip = union(
        box((-0.008, reach - 0.045, level + 0.2 * (top - level)), (0.008, reach - 0.033, top)),
        *(box((-0.008, reach - 0.04, z), (0.008, y, z + 0.012)) for z in (level + 0.25 * (top - level), top - 0.014)),
    )
    workshop.body("jug", glass - hollow, grip - cylinder(radius - 0.002, (0, y, -1), (0, y, 1)), material="glass")
    travel = (0.0, 0.7 * depth)
    workshop.slides("jug", "body", (0, -1, 0), (0, y, level), travel, rest=values.number("open"))


def _add_espresso(values: Values, workshop: Workshop) -> None:
    """Portafilters that turn in their groups, a steam wand with its knob, and a drip tray."""
    width, depth, clearance = values.number("width"), values.number("depth"), values.number("clearance")
    head, rest, groups = _head(values), values.number("open"), values.count("groups")
    share = 0.8 * width / groups
    radius = min(0.032, 0.3 * share)
    y, reach = 0.3 * depth, radius + 0.09
    turn = min(0.7, math.asin(min(1.0, (share - 0.022) / reach)))  # then a grip meets its neighbour
    for k in range(groups):
        x = (k + 0.5) * share - 0.5 * width
        pivot = (x, y, head - 0.01)
        boss, hole, rotor = stub(pivot, (0, 0, -1), radius, clearance, length=0.022)
        workshop.add("body", boss)
        workshop.cut("body", hole)
        level = pivot[2] - clearance - 0.014
        grip = rod(0.009, (x, y, level), (x, y - reach, level))
        spout = cylinder(0.008, (x, y, level - 0.02), (x, y, level))
        name = f"portafilter_{k + 1}"
        workshop.body(name, rotor, grip, spout)
        workshop.turns(name, "body", (0, 0, -1), pivot, (0.0, turn), rest=rest)
    x = 0.42 * width
    pivot = (x, 0.15 * depth, head - 0.006)
    boss, hole, rotor = stub(pivot, (0, 0, -1), 0.009, clearance, length=0.012)
    workshop.add("body", boss)
    workshop.cut("body", hole)
    start = (*pivot[:2], pivot[2] - clearance - 0.009)
    tip = (x, 0.15 * depth - 0.04, _BASE + 0.35 * (head - _BASE))
    workshop.body("steam_wand", rotor, rod(0.004, start, tip))
    workshop.turns("steam_wand", "body", (0, 0, 1), pivot, (0.0, 0.9), rest=rest)
    opening = Opening(left=-0.5 * width, right=0.5 * width, bottom=0.0, top=_BASE, depth=0.58 * depth, wall=_WALL)
    workshop.cut("body", room(opening))
    add_drawer(workshop, "drip_tray", "body", opening, Fitting(clearance=clearance, grip="edge", rest=rest))
    front = 0.5 * (head + values.number("height") - _LID)
    mount = Mount(parent="body", place=(x, 0, front), face=FRONT, clearance=min(clearance, 0.0015), depth=0.02)
    add_knob(workshop, "knob", mount, min(0.018, 0.07 * width), endless=True)


def _add_buttons(values: Values, workshop: Workshop) -> None:
    """In a row: on the base under a jug, else on the head."""
    width, count, clearance = values.number("width"), values.count("buttons"), values.number("clearance")
    low = values.choice("kind") == "filter"
    level = 0.5 * _BASE if low else 0.5 * (_head(values) + values.number("height") - _LID)
    for k in range(count):
        x = (0.7 * (k + 0.5) / count - (0.35 if low else 0.45)) * width
        mount = Mount(parent="body", place=(x, 0, level), face=FRONT, clearance=clearance, depth=0.015)
        cap = min(0.016, 0.5 * width / count - 2.0 * clearance)
        is_round = values.choice("button") == "round"
        add_button(workshop, f"button_{k + 1}", mount, (cap, cap), travel=0.003, is_round=is_round)


FAMILY = family("coffee_machine", _build)
