"""Staplers: a magazine and an arm above it, both on the pin between two ears at the back of the base."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_SHEET = 0.0015  # thickness of ears, arm and magazine [m]
_PIN = 0.0025  # radius [m]
_FOOT, _RISE = 0.008, 0.026  # height of the foot and of the pin above it [m]
_ANVIL = 0.0015  # thickness of the plate that bends the staples [m]
_STROKE, _PRESS = 0.005, 0.008  # way of the magazine's and of the arm's front when they are pressed [m]
_OPENS = {"magazine": 1.2, "arm": 1.3}  # [rad]


def _build(values: Values, workshop: Workshop) -> None:
    length, half = values.number("length"), 0.5 * values.number("width")
    clearance = min(values.number("clearance"), 0.3 * _PIN)
    y, z = 0.88 * length, _FOOT + _RISE
    ears = [
        hull(
            box((x, y - 0.012, 0.5 * _FOOT), (x + _SHEET, y + 0.012, _FOOT)),
            cylinder(0.007, (x, y, z), (x + _SHEET, y, z)),
        )
        for x in (-half, half - _SHEET)
    ]
    back = box((-half, length - 0.02, 0), (half, length, _FOOT))
    slab = hull(cylinder(half, (0, half, 0), (0, half, _FOOT)), back)
    anvil = box((-0.4 * half, 0.006, _FOOT - 1e-4), (0.4 * half, 0.026, _FOOT + _ANVIL))
    workshop.body("base", slab, anvil, *ears, cylinder(_PIN, (-half, y, z), (half, y, z)))

    hole, rest = bore(_PIN, clearance, (-1, y, z), (1, y, z)), values.number("open")
    outer = half - _SHEET - clearance  # of the arm, which is between the ears
    inner = outer - _SHEET - clearance  # of the magazine, which is in the arm
    workshop.body("magazine", _magazine(inner, (y, z), clearance) - hole, material="steel", color="silver")
    workshop.body("arm", _arm(values, outer, inner - _SHEET - clearance, (y, z)) - hole)
    limits = -_STROKE / length, _OPENS["magazine"]
    workshop.turns("magazine", "base", (-1, 0, 0), (0, y, z), limits, rest=rest)
    limits = -_PRESS / length, _OPENS["arm"]
    workshop.turns("arm", "magazine", (-1, 0, 0), (0, y, z), limits, rest=rest)


def _cheeks(half: float, axis: tuple[float, float], front: float, heights: tuple[float, float]) -> list[Manifold]:
    """Sheets with the pin in them; they reach forward to `front`."""
    y, z = axis
    return [
        hull(
            box((x, front, heights[0]), (x + _SHEET, y - 0.012, heights[1])),
            cylinder(0.006, (x, y, z), (x + _SHEET, y, z)),
        )
        for x in (-half, half - _SHEET)
    ]


def _magazine(half: float, axis: tuple[float, float], clearance: float) -> Manifold:
    """A channel with a stick of staples in it, open at the top."""
    y, z = axis
    bottom, top = _FOOT + _ANVIL + clearance + _STROKE + 0.001, z - 0.004
    channel = box((-half, 0.004, bottom), (half, y - 0.012, top))
    room = box((_SHEET - half, 0.004 + _SHEET, bottom + _SHEET), (half - _SHEET, y, top + 1.0))
    staples = box((1e-4 - half, 0.014, bottom), (half - 1e-4, 0.6 * y, bottom + 0.4 * (top - bottom)))
    return union(channel - room, staples, *_cheeks(half, axis, y - 0.022, (bottom, top)))


def _arm(values: Values, half: float, blade: float, axis: tuple[float, float]) -> Manifold:
    """A cover with sides that straddle the magazine and a blade in front that drives the staples."""
    y, z = axis
    under, thick = z + 0.008, values.number("cover")
    front, level = 0.4 * half, 0.5 * thick
    ends = [cylinder(level, (-half, at, under + level), (half, at, under + level)) for at in (front, y)]
    top = hull(*ends, box((-half, 0.5 * y, under), (half, y, under + thick)))
    if values.choice("cover_shape") == "round":
        round_top = cylinder(min(thick, half), (0, front, under + level), (0, y - 0.01, under + level))
        top += round_top.trim_by_plane((0, 0, 1), under + level)
    sides = _cheeks(half, axis, 0.5 * y, (z - 0.002, under + level))
    driver = box((-blade, 0.0085, z - 0.003), (blade, 0.0095, under + level))
    return union(top, *sides, driver)


FAMILY = family("stapler", _build)
