"""Windows: sashes that slide in grooves, or turn about a side, the lower or upper edge, or pins at mid-height."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_lever
from kinematify.generate.procedural.pieces.leaves import (
    Field,
    Hinge,
    Tracks,
    add_sliding,
    carved,
    hang,
    hinged_slab,
    side_by_side,
    stopped_opening,
)
from kinematify.generate.procedural.solids import bore, box, cylinder

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_THICK = 0.04  # of a sash [m]
_DEPTH = 0.07  # of a frame without grooves [m]
_SASH = 0.045  # width of a sash's bars [m]
_BARREL = 0.005  # radius [m]
_PIN = 0.008  # radius of what a pivoting sash turns on [m]
_TURNING = {"casement": 1.5, "tilt": 0.6, "awning": 0.8}
"""How far a sash opens [rad]."""


def _build(values: Values, workshop: Workshop) -> None:
    width, height, bar = values.number("width"), values.number("height"), values.number("frame")
    opening = Field(left=bar - 0.5 * width, right=0.5 * width - bar, bottom=bar, top=height - bar)
    kind = values.choice("kind")
    if kind == "sliding":
        _sliding(values, workshop, opening)
    elif kind == "pivot":
        _pivoting(values, workshop, opening)
    else:
        _hinged(values, workshop, opening, kind)


def _frame(values: Values, depth: float) -> Manifold:
    half = 0.5 * values.number("width")
    return box((-half, 0, 0), (half, depth, values.number("height")))


def _glazed(values: Values, slab: Manifold, face: Field, front: float) -> Manifold:
    """A sash with its panes."""
    rows, columns = values.count("rows"), values.count("columns")
    return carved(slab, face, front, _THICK, bar=_bar(face), rows=rows, columns=columns, sunk=0.42)


def _bar(face: Field) -> float:
    """Width of the bars around a sash's panes."""
    return min(_SASH, 0.2 * (face.right - face.left), 0.2 * (face.top - face.bottom))


def _sliding(values: Values, workshop: Workshop, opening: Field) -> None:
    count = values.count("sashes")
    tracks = Tracks(opening=opening, count=max(count, 2), thick=_THICK, clearance=values.number("clearance"))
    workshop.body("frame", _frame(values, tracks.depth))

    def finish(slab: Manifold, face: Field, front: float) -> Manifold:
        x, z = face.left + 0.5 * _bar(face), face.middle[1]
        pull = box((x - 0.006, front - 1.0, z - 0.05), (x + 0.006, front + 0.008, z + 0.05))
        return _glazed(values, slab, face, front) - pull

    add_sliding(workshop, "sash", "frame", tracks, count=count, finish=finish, rest=values.number("open"))


def _hinged(values: Values, workshop: Workshop, opening: Field, kind: str) -> None:
    clearance, rest = values.number("clearance"), values.number("open")
    together = 2 if kind == "casement" else 1
    groups = side_by_side(opening, values.count("sashes"), values.number("frame"), together=together)
    workshop.body("frame", _frame(values, _DEPTH) - stopped_opening(groups, _DEPTH, _THICK, clearance))
    radius = _BARREL if values.choice("hinge") == "barrel" else 0.0
    number = 0
    for group in groups:
        for place, field in enumerate(group):
            number += 1
            edge = {"tilt": "bottom", "awning": "top"}.get(kind, ("left", "right")[place])
            hinge = Hinge(edge=edge, barrel=radius, thick=_THICK, clearance=clearance)
            sash = _glazed(values, hinged_slab(field, hinge), field, 0.0)
            hang(workshop, f"sash_{number}", "frame", field, hinge, solids=[sash], opens=_TURNING[kind], rest=rest)
            if values.choice("handle") == "lever":
                _add_handle(
                    workshop, f"handle_{number}", f"sash_{number}", field, edge=edge, clearance=clearance, rest=rest
                )


def _pivoting(values: Values, workshop: Workshop, opening: Field) -> None:
    """Sashes on pins in the jambs, which turn about their middle."""
    clearance, rest = values.number("clearance"), values.number("open")
    groups = side_by_side(opening, values.count("sashes"), values.number("frame"))
    workshop.body("frame", _frame(values, _DEPTH))
    for number, (field,) in enumerate(groups, start=1):
        workshop.cut("frame", field.box(-1.0, 1.0))
        gap, half = clearance + 0.001, 0.5 * (field.top - field.bottom)
        swing = gap + math.hypot(half, 0.5 * _THICK) - half
        x, z = field.middle
        start = 0.5 * (_DEPTH - _THICK)
        lower = (field.left + gap, start, field.bottom + swing)
        slab = box(lower, (field.right - gap, start + _THICK, field.top - swing))
        name, reach = f"sash_{number}", 0.4 * values.number("frame")
        ends = (field.left - reach, 0.5 * _DEPTH, z), (field.right + reach, 0.5 * _DEPTH, z)
        far = (ends[0][0] - clearance, *ends[0][1:]), (ends[1][0] + clearance, *ends[1][1:])
        workshop.cut("frame", bore(_PIN, clearance, *far))
        pins = cylinder(_PIN, *ends) - field.box(-1.0, 1.0, inset=2.0 * gap)
        workshop.body(name, _glazed(values, slab, field, start), pins)
        workshop.turns(name, "frame", (1, 0, 0), (x, 0.5 * _DEPTH, z), (0.0, 1.3), rest=rest)


def _add_handle(
    workshop: Workshop, name: str, parent: str, field: Field, *, edge: str, clearance: float, rest: float
) -> None:
    """A handle in the middle of the free side, that turns by a quarter."""
    (x, z), bar = field.middle, _bar(field)
    x = {"left": field.right - 0.5 * bar, "right": field.left + 0.5 * bar}.get(edge, x)
    z = {"bottom": field.top - 0.5 * bar, "top": field.bottom + 0.5 * bar}.get(edge, z)
    mount = Mount(parent=parent, place=(x, 0.0, z), face=FRONT, clearance=clearance, depth=_THICK)
    arm, swing = (0.0, 0.5 * math.pi) if edge == "top" else (-0.5 * math.pi, 0.5 * math.pi)
    swing = -swing if edge == "left" else swing
    add_lever(workshop, name, mount, 2.2 * bar, arm=arm, swing=swing, through=False, rest=rest)


FAMILY = family("window", _build)
