"""Toilets: a seat and a lid on one pin line, and a flush lever or button on the tank."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.controls import TOP, Mount, add_button
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, rod, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_SEAT, _LID = 0.018, 0.014  # thickness [m]
_KNUCKLE, _PIN = 0.009, 0.0045  # radius [m]
_OPENS = 1.65  # [rad]
_TANK = 0.11  # from the pins to the tank [m]


def _build(values: Values, workshop: Workshop) -> None:
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


FAMILY = family("toilet", _build)
