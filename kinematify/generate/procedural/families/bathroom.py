"""Toilets and faucets."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

from kinematify.generate.procedural.pieces.bearings import fork, room, stub
from kinematify.generate.procedural.pieces.controls import TOP, Mount, add_button
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, off, rod, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.solids import Point
    from kinematify.generate.procedural.workshop import Workshop


_SEAT, _LID = 0.018, 0.014  # thickness [m]
_KNUCKLE, _PIN = 0.009, 0.0045  # radius [m]
_OPENS = 1.65  # [rad]
_TANK = 0.11  # from the pins to the tank [m]


def build_toilet(values: Values, workshop: Workshop) -> None:
    """Toilets: a seat and a lid on one pin line, and a flush lever or button on the tank."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    clearance = min(values.number("clearance"), 0.3 * _KNUCKLE)
    tank_depth = 0.24 * depth
    axis = (depth - tank_depth - _TANK, height + clearance + _SEAT)  # y and z of the pins
    tank_top = height + 0.85 * depth * 0.6
    tank = box((-0.5 * width, depth - tank_depth, height - 0.05), (0.5 * width, depth, tank_top))
    seam = box((-width, -1, tank_top - 0.035), (width, depth - tank_depth + 0.003, tank_top - 0.032))
    workshop.body("body", _bowl(values, axis[0]), tank - seam)
    _add_covers(values, workshop, axis, clearance)
    _add_flush(values, workshop, (depth - tank_depth, tank_top))


def _oval(width: float, front: float, back: float, span: tuple[float, float]) -> Manifold:
    """A round front and a straight back, between two levels."""
    radius = 0.5 * width
    round_part = cylinder(radius, (0, front + radius, span[0]), (0, front + radius, span[1]))
    return hull(round_part, box((-0.8 * radius, back - 0.01, span[0]), (0.8 * radius, back, span[1])))


def _breadth(values: Values, back: float) -> float:
    """Of the bowl: narrower than the tank and not as wide as it is long."""
    return min(0.9 * values.number("width"), 0.85 * back)


def _bowl(values: Values, back: float) -> Manifold:
    """A bowl on a foot, with a deck that reaches back under the tank."""
    width, depth, height = _breadth(values, back), values.number("depth"), values.number("height")
    foot = _oval(0.55 * width, 0.2 * back, depth - 0.1, (0.0, 0.05))
    rim = _oval(width, 0.0, depth - 0.05, (height - 0.06, height))
    hollow = hull(
        _oval(0.7 * width, 0.15 * width, 0.85 * back, (height - 1e-3, height + 0.1)),
        _oval(0.3 * width, 0.35 * width, 0.6 * back, (0.35 * height, 0.36 * height)),
    )
    return union(hull(foot, rim.trim_by_plane((0, 0, -1), -(height - 0.03))), rim) - hollow


def _add_covers(values: Values, workshop: Workshop, axis: tuple[float, float], clearance: float) -> None:
    """Seat and lid; the seat owns the pins, posts of the body and knuckles of the lid stand on them."""
    y, z = axis
    width, height = _breadth(values, y), values.number("height")
    back = y - _KNUCKLE - clearance - 0.001
    level = height + clearance
    ring = _oval(width, 0.0, back, (level, level + _SEAT)) - _oval(
        0.62 * width, 0.19 * width, 0.8 * back, (level - 1.0, level + 1.0)
    )
    cover = _oval(width, 0.0, back, (level + _SEAT + clearance, level + _SEAT + clearance + _LID))
    to_seat = (level, level + 0.5 * _SEAT)
    to_lid = (level + _SEAT + clearance + 0.3 * _LID, level + _SEAT + clearance + _LID)
    posts, knuckles, pins, of_lid, holes = [], [], [], [], []
    for side in (-1.0, 1.0):
        spans = [(side * (0.03 + k * 0.022), side * (0.03 + (k + 1) * 0.022 - clearance)) for k in range(3)]
        lid_at, seat_at, post_at = spans
        of_lid.append(_knuckle(lid_at, axis, back, to_lid))
        knuckles.append(_knuckle(seat_at, axis, back, to_seat))
        post = cylinder(_KNUCKLE, (post_at[0], y, z), (post_at[1], y, z))
        xs = sorted(post_at)
        posts.append(hull(post, box((xs[0], y - _KNUCKLE, height - 0.002), (xs[1], y + _KNUCKLE, height))))
        ends = (lid_at[0], y, z), (post_at[1], y, z)
        pins.append(cylinder(_PIN, *ends))
        holes.append(bore(_PIN, clearance, (0.5 * lid_at[0], y, z), (1.2 * post_at[1], y, z)))
    workshop.add("body", *posts)
    workshop.cut("body", *holes)
    rest, pivot = values.number("open"), (0.0, y, z)
    workshop.body("seat", ring, *knuckles, *pins, material="plastic")
    workshop.body("lid", union(cover, *of_lid) - union(*holes), material="plastic")
    # A lid that stands open leaves the seat less way before it meets the tank.
    workshop.turns("seat", "body", (-1, 0, 0), pivot, (0.0, _OPENS - 0.95 * rest * _OPENS))
    workshop.turns("lid", "seat", (-1, 0, 0), pivot, (0.0, _OPENS), rest=rest)


def _knuckle(
    span: tuple[float, float], axis: tuple[float, float], back: float, heights: tuple[float, float]
) -> Manifold:
    """A knuckle that reaches forward to the back face of what it carries."""
    y, z = axis
    lower, upper = sorted(span)
    return hull(
        cylinder(_KNUCKLE, (lower, y, z), (upper, y, z)),
        box((lower, back - 2e-4, heights[0]), (upper, back + 1e-4, heights[1])),
    )


def _add_flush(values: Values, workshop: Workshop, corner: tuple[float, float]) -> None:
    """A lever at the front of the tank, or a button on its top; `corner` is y of the front and z of the top."""
    front, top = corner
    clearance, rest, width = values.number("clearance"), values.number("open"), values.number("width")
    if values.choice("flush") == "button":
        place = (0.0, front + 0.12 * values.number("depth"), top)
        mount = Mount(parent="body", place=place, face=TOP, clearance=clearance, depth=0.025)
        add_button(workshop, "button", mount, (0.06, 0.035), travel=0.008, rest=rest)
        return
    x, z = -0.35 * width, top - 0.08
    workshop.cut("body", bore(0.008, clearance, (x, front - 1e-3, z), (x, front + 0.03 + clearance, z)))
    shaft = cylinder(0.008, (x, front - 0.02, z), (x, front + 0.03, z))
    flange = cylinder(0.015, (x, front - clearance, z), (x, front - clearance - 0.006, z))
    workshop.body(
        "lever", shaft, flange, rod(0.007, (x, front - 0.02, z), (x + 0.09, front - 0.02, z)), material="metal"
    )
    workshop.turns("lever", "body", (0, 1, 0), (x, front, z), (0.0, 0.8), rest=rest)


_PLATE = 0.01  # thickness of the base plate [m]


def build_faucet(values: Values, workshop: Workshop) -> None:
    """Faucets: a lever that turns and lifts, handles that twist, or a spout that swivels."""
    {"lever": _lever, "twist": _twist, "swivel": _swivel}[values.choice("handle")](values, workshop)


def _spout(radius: float, foot: Point, rise: float, reach: float) -> Manifold:
    """A pipe that rises, bends forward over a half circle and ends above its outlet."""
    bend = 0.5 * reach
    arc = [
        off(foot, 0, -bend * (1.0 - math.cos(math.radians(a))), rise + bend * math.sin(math.radians(a)))
        for a in range(0, 151, 25)
    ]
    points = [foot, *arc]
    return union(*(rod(radius, one, two) for one, two in pairwise(points)))


def _lever(values: Values, workshop: Workshop) -> None:
    """A cartridge on the post turns, and the lever on it lifts."""
    radius, clearance, rest = values.number("pipe"), values.number("clearance"), values.number("open")
    post, top = 1.8 * radius, values.number("height")
    outlet = [rod(radius, (0, 0, 0.62 * top), (0, -values.number("reach"), 0.7 * top))]
    boss, hole, rotor = stub((0, 0, top), (0, 0, 1), post, clearance, length=1.2 * radius)
    plate = cylinder(2.6 * radius, (0, 0, 0), (0, 0, _PLATE))
    workshop.body("body", plate, cylinder(post, (0, 0, 0), (0, 0, top)), boss, *outlet)
    workshop.cut("body", hole)
    small, gap = 0.6 * radius, min(clearance, 0.2 * radius)
    hinge = top + clearance + 1.2 * radius + room(small, gap) + 0.5 * small
    forked, tongue = (s.translate((0, 0, hinge)) for s in fork(2.6 * radius, small, gap, hinge - top - 1.2 * radius))
    workshop.body("cartridge", rotor, forked)
    handle = rod(small, (0, 0, hinge + 2.0 * small), (0, -0.9 * values.number("reach"), hinge + 3.5 * small))
    workshop.body("lever", tongue, handle)
    workshop.turns("cartridge", "body", (0, 0, 1), (0, 0, top), (-0.8, 0.8))
    workshop.turns("lever", "cartridge", (-1, 0, 0), (0, 0, hinge), (0.0, 0.5), rest=rest)


def _twist(values: Values, workshop: Workshop) -> None:
    """Cross handles on posts beside the spout, or one on its top."""
    radius, clearance, rest = values.number("pipe"), values.number("clearance"), values.number("open")
    count, height = values.count("handles"), values.number("height")
    half = 5.5 * radius
    places = {1: (half,), 2: (-half, half)}[count]
    plate = box((-1.35 * half, -2.2 * radius, 0), (1.35 * half, 2.2 * radius, _PLATE))
    rise = height - 0.5 * values.number("reach") - radius - _PLATE
    pipe = _spout(radius, (0, 0, 0.5 * _PLATE), max(rise, 3.0 * radius), values.number("reach"))
    workshop.body("body", plate, pipe.trim_by_plane((0, 0, 1), 0.0))
    top = _PLATE + 4.0 * radius
    for k, x in enumerate(places):
        boss, hole, rotor = stub((x, 0, top), (0, 0, 1), 1.4 * radius, clearance, length=2.0 * radius)
        workshop.add("body", boss, cylinder(1.4 * radius, (x, 0, 0.5 * _PLATE), (x, 0, top)))
        workshop.cut("body", hole)
        level = top + clearance + 1.6 * radius
        arms = [rod(0.5 * radius, (x - 2.6 * radius, 0, level), (x + 2.6 * radius, 0, level))]
        if values.choice("cross") == "cross":
            arms.append(rod(0.5 * radius, (x, -2.6 * radius, level), (x, 2.6 * radius, level)))
        workshop.body(f"handle_{k + 1}", rotor, *arms)
        workshop.turns(f"handle_{k + 1}", "body", (0, 0, 1), (x, 0, top), (0.0, 1.5 * math.pi), rest=rest)


def _swivel(values: Values, workshop: Workshop) -> None:
    """A high spout that swivels on the post, and a lever at the post's side."""
    radius, clearance, rest = values.number("pipe"), values.number("clearance"), values.number("open")
    post, top = 1.7 * radius, 7.0 * radius
    plate = cylinder(2.6 * radius, (0, 0, 0), (0, 0, _PLATE))
    boss, hole, rotor = stub((0, 0, top), (0, 0, 1), post, clearance, length=1.5 * radius)
    side = (2.6 * radius, 0, 4.0 * radius)
    side_boss, side_hole, side_rotor = stub(side, (1, 0, 0), 1.2 * radius, clearance, length=1.5 * radius)
    workshop.body("body", plate, cylinder(post, (0, 0, 0), (0, 0, top)), boss, side_boss)
    workshop.cut("body", hole, side_hole)
    foot = (0, 0, top + clearance + radius)
    rise = values.number("height") - foot[2] - 0.5 * values.number("reach") - radius
    workshop.body("spout", rotor, _spout(radius, foot, max(rise, 2.0 * radius), values.number("reach")))
    tip = off(side, clearance + 0.9 * radius, 0, 0)
    lever = rod(0.55 * radius, tip, off(tip, 2.0 * radius, -0.6 * radius, 5.0 * radius))
    workshop.body("lever", side_rotor, lever)
    workshop.turns("spout", "body", (0, 0, 1), (0, 0, top), (-2.0, 2.0))
    workshop.turns("lever", "body", (1, 0, 0), side, (0.0, 1.0), rest=rest)
