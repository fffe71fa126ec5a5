"""Folding chairs: a frame with a back, legs and a seat that fold into it. Zero is folded flat."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.solids import bore, box, cylinder

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_PIN = 0.004  # radius [m]
_BOARD = 0.014  # thickness of the slats [m]
_LEGS = 0.75  # how far the rear legs swing back [rad]


def _build(values: Values, workshop: Workshop) -> None:
    height, seat = values.number("height"), values.number("seat")
    rail, half = values.number("rail"), 0.5 * values.number("width")
    thick = 0.5 * rail
    sides = [_between(s * half, s * (half - rail), thick, 0.0, height) for s in (-1, 1)]
    wide, pitch = half - 0.5 * rail, (height - seat - 0.12) / values.count("slats")
    slats = []
    for k in range(values.count("slats")):
        low = height - (k + 1) * pitch
        slats.append(box((-wide, thick - 1e-3, low + 0.15 * pitch), (wide, thick + _BOARD, low + pitch)))
    tie = box((-wide, -thick - _BOARD, 0.1), (wide, 1e-3 - thick, 0.13))
    workshop.body("frame", *sides, *slats, tie)
    _add_legs(values, workshop)
    _add_seat(values, workshop)


def _between(one: float, other: float, thick: float, low: float, high: float) -> Manifold:
    """An upright bar between two x, about the plane y = 0."""
    x0, x1 = sorted((one, other))
    return box((x0, -thick, low), (x1, thick, high))


def _add_legs(values: Values, workshop: Workshop) -> None:
    """Rear legs between the sides of the frame; they swing back."""
    rail, inner = values.number("rail"), _inner(values)
    thick = _half(values)
    pivot = values.number("seat") - 0.5 * rail - 0.025
    legs = [_between(s * inner, s * (inner - rail), thick, 0.0, pivot) for s in (-1, 1)]
    legs += [cylinder(thick, (s * inner, 0, pivot), (s * (inner - rail), 0, pivot)) for s in (-1, 1)]
    legs += [_between(-inner, inner, 0.5 * thick, z, z + 0.025) for z in (0.06, 0.7 * pivot)]
    _hang(values, workshop, "legs", solids=legs, level=pivot, opens=_LEGS)


def _add_seat(values: Values, workshop: Workshop) -> None:
    """A seat that stands up before the back and comes down to the front."""
    inner, level, depth = _inner(values), values.number("seat"), values.number("depth")
    half = _half(values)
    boards, pitch = values.count("boards"), depth / values.count("boards")
    seat = [_between(-inner, inner, half, level + k * pitch + 0.012, level + (k + 1) * pitch) for k in range(boards)]
    for s in (-1, 1):
        seat.append(cylinder(half, (s * inner, 0, level), (s * (inner - 0.03), 0, level)))
        seat.append(_between(s * inner, s * (inner - 0.03), half, level, level + depth))
    _hang(values, workshop, "seat", solids=seat, level=level, opens=0.5 * math.pi)


def _inner(values: Values) -> float:
    """Half the width of what moves between the sides [m]."""
    return 0.5 * values.number("width") - values.number("rail") - values.number("clearance")


def _half(values: Values) -> float:
    """Half the thickness of what folds into the frame, before its slats and behind its tie [m]."""
    return 0.5 * values.number("rail") - 1.5e-3 - values.number("clearance")


def _hang(values: Values, workshop: Workshop, name: str, *, solids: list[Manifold], level: float, opens: float) -> None:
    """Hang a body on an axle through both sides of the frame."""
    clearance = values.number("clearance")
    end = 0.5 * values.number("width") - 0.35 * values.number("rail")
    workshop.cut("frame", bore(_PIN, clearance, (-end - clearance, 0, level), (end + clearance, 0, level)))
    workshop.body(name, *solids, cylinder(_PIN, (-end, 0, level), (end, 0, level)))
    workshop.turns(name, "frame", (1, 0, 0), (0, 0, level), (0.0, opens), rest=values.number("open"))


FAMILY = family("folding_chair", _build)
