"""Suitcases that stand upright: two shells on a hinge at the left, wheels, and a handle that is drawn out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import barrel
from kinematify.generate.procedural.pieces.castors import STEM, castor
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, rod, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_WALL = 0.003
_ROUND = 0.04  # radius of the corners [m]
_WHEEL = 0.02  # radius [m]
_FORK = 0.056  # height of a wheel with its fork [m]
_HINGE = 0.004  # radius [m]
_TUBE = 0.006  # radius of the drawn handle's tubes [m]
_GRIP = 0.021  # height of the grip above the shells when it is pushed in [m]
_OPENS = 1.7  # [rad]


def _build(values: Values, workshop: Workshop) -> None:
    clearance, rest = values.number("clearance"), values.number("open")
    deep = 0.5 * values.number("depth")
    workshop.body("body", _shell(values, 0.0, deep), *_side_handle(values))
    workshop.body("front", _shell(values, -clearance, -deep))
    workshop.turns("front", "body", (0, 0, -1), _add_hinges(values, workshop), (0.0, _OPENS), rest=rest)
    if values.choice("handle") == "trolley":
        _add_trolley(values, workshop)
    _add_wheels(values, workshop)


def _bottom(values: Values) -> float:
    """Underside of the shells [m]."""
    return _FORK + values.number("clearance")


def _top(values: Values) -> float:
    """Upper side of the shells, below the grip where there is one [m]."""
    return values.number("height") - (_GRIP if values.choice("handle") == "trolley" else 0.0)


def _shell(values: Values, mouth: float, back: float) -> Manifold:
    """One half, open at y = `mouth`, with grooves in its broad face."""
    sign = 1.0 if back > mouth else -1.0
    width = values.number("width")
    outer = hull(_plate(values, 0.0, mouth, back - sign * 0.012), _plate(values, 0.012, mouth, back))
    hollow = _plate(values, _WALL + 0.009, mouth - sign, back - sign * _WALL)
    shallow = sorted((back - sign * 0.0015, back + sign))
    grooves = [
        box((x - 0.004, shallow[0], 0.0), (x + 0.004, shallow[1], 9.0))
        for x in (width * share for share in (-0.3, -0.15, 0.0, 0.15, 0.3))
    ]
    return outer - hollow - union(*grooves)


def _plate(values: Values, inset: float, start: float, end: float) -> Manifold:
    """The outline of the front, rounded at its corners, between two depths."""
    half, bottom, top = 0.5 * values.number("width") - inset, _bottom(values) + inset, _top(values) - inset
    radius = _ROUND - inset
    places = [(x, z) for x in (radius - half, half - radius) for z in (bottom + radius, top - radius)]
    return hull(*(cylinder(radius, (x, start, z), (x, end, z), segments=32) for x, z in places))


def _side_handle(values: Values) -> list[Manifold]:
    """A grip on the right side of the half that stays."""
    x, y = 0.5 * values.number("width"), 0.25 * values.number("depth")
    level = 0.5 * (_bottom(values) + _top(values))
    ends = [(y, level - 0.06), (y, level + 0.06)]
    posts = [rod(0.006, (x - 1e-3, *end), (x + 0.022, *end)) for end in ends]
    return [
        rod(0.007, (x + 0.022, *ends[0]), (x + 0.022, *ends[1])),
        *(p.trim_by_plane((1, 0, 0), x - 2e-3) for p in posts),
    ]


def _add_hinges(values: Values, workshop: Workshop) -> tuple[float, float, float]:
    """Barrels at the left side of both halves; returns a point on the pins."""
    clearance, bottom, top = values.number("clearance"), _bottom(values), _top(values)
    face, reach = _HINGE + clearance, 3.0 * _HINGE
    deep = (face - 1e-4, face + 2e-4)
    on_body = (*deep, clearance + 0.2 * reach, clearance + reach)
    on_front = (*deep, -reach, -0.2 * reach)
    x = -0.5 * values.number("width") - face
    for share in (0.25, 0.75):
        halves = barrel(0.05, _HINGE, clearance, (on_body, on_front))
        for name, half in zip(("body", "front"), halves, strict=True):
            workshop.add(name, half.translate((x, -clearance, bottom + share * (top - bottom))))
    return x, -clearance, bottom


def _add_trolley(values: Values, workshop: Workshop) -> None:
    """Two tubes in sleeves at the back, with a grip above the top."""
    clearance, top, bottom = values.number("clearance"), _top(values), _bottom(values)
    x, y = 0.22 * values.number("width"), 0.5 * values.number("depth") - 0.022
    low, grip = bottom + 0.05, top + 0.012
    tubes = []
    for side in (-x, x):
        workshop.add("body", cylinder(_TUBE + clearance + 0.003, (side, y, bottom + 0.02), (side, y, top)))
        tubes.append(cylinder(_TUBE, (side, y, low + clearance), (side, y, grip)))
    for side in (-x, x):
        workshop.cut("body", bore(_TUBE, clearance, (side, y, low), (side, y, top + 1.0)))
    bar = rod(0.009, (-x, y, grip), (x, y, grip))
    workshop.body("handle", *tubes, bar, material="metal")
    way = 0.75 * (top - low)
    workshop.slides("handle", "body", (0, 0, 1), (0, y, top), (0.0, way), rest=values.number("open"))


def _add_wheels(values: Values, workshop: Workshop) -> None:
    """Castors under both halves, or two wheels that only roll and feet beside them."""
    count, clearance, bottom = values.count("wheels"), values.number("clearance"), _bottom(values)
    x, y = 0.5 * values.number("width") - 0.07, 0.25 * values.number("depth")
    back, front = [("body", -x, y), ("body", x, y)], [("front", -x, -y), ("front", x, -y)]
    places = {2: back, 3: [*back, ("front", 0.0, -y)], 4: [*back, *front]}[count]
    for k, (parent, px, py) in enumerate(places):
        axle = np.array([0.0, -0.4 * _WHEEL, _WHEEL])
        fork, roller = (solid.translate((px, py, 0)) for solid in castor(axle, _FORK, _WHEEL, clearance))
        boss = cylinder(STEM + clearance + 0.004, (px, py, bottom), (px, py, bottom + 0.028))
        workshop.add(parent, boss)
        carrier = parent
        if count == 2:
            workshop.add(parent, fork, cylinder(0.012, (px, py, _FORK - 1e-3), (px, py, bottom + 1e-3)))
        else:
            carrier = f"castor_{k + 1}"
            workshop.cut(parent, bore(STEM, clearance, (px, py, bottom - 0.01), (px, py, bottom + 0.024)))
            workshop.body(carrier, fork, material="plastic")
            workshop.turns(carrier, parent, (0, 0, 1), (px, py, bottom))
        workshop.body(f"wheel_{k + 1}", roller, material="rubber")
        workshop.turns(f"wheel_{k + 1}", carrier, (1, 0, 0), (px, py - 0.4 * _WHEEL, _WHEEL))
    if count == 2:
        feet = [box((s * x - 0.012, -y - 0.012, 0), (s * x + 0.012, 0.012 - y, bottom + 1e-3)) for s in (-1, 1)]
        workshop.add("front", *feet)


FAMILY = family("suitcase", _build)
