"""Furniture: cabinets, tables and chairs."""

from __future__ import annotations

import math
from itertools import count
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.procedural.layout import parse_layout
from kinematify.generate.procedural.pieces.bearings import STEM, at, bent_fork, castor, stub
from kinematify.generate.procedural.pieces.fronts import Bay, Fitting, add_door, add_drawer, carcass, room
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, rod, union

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.layout import Cell
    from kinematify.generate.procedural.workshop import Workshop


def build_cabinet(values: Values, workshop: Workshop) -> None:
    """Cabinets, chests, wardrobes and desks' pedestals: any grid of doors, drawers and open shelves."""
    cells = parse_layout(values.choice("layout") or _default_layout(values))
    openings = [_cabinet_opening(cell, values) for cell in cells]
    behind = [opening for cell, opening in zip(cells, openings, strict=True) if cell.kind != "panel"]
    size = (values.number("width"), values.number("height"), values.number("depth"))
    workshop.body("body", carcass(*size, behind))
    fitting = Fitting(clearance=values.number("clearance"), grip=values.choice("handle"), rest=values.number("open"))
    names = {kind: count(1) for kind in ("door", "drawer")}
    for cell, opening in zip(cells, openings, strict=True):
        if cell.kind == "door":
            side = _side(cells, cell)
            add_door(
                workshop,
                f"door_{next(names['door'])}",
                "body",
                opening,
                fitting,
                side=side,
                outermost=cell.left == 0.0 if side == "left" else cell.right > 1.0 - 1e-9,
                hinge=values.choice("hinge"),
            )
        elif cell.kind == "drawer":
            add_drawer(workshop, f"drawer_{next(names['drawer'])}", "body", opening, fitting)


def _default_layout(values: Values) -> str:
    """Open shelves above doors side by side above stacked drawers."""
    kinds = (("shelves", "shelf"), ("doors", "door"), ("drawers", "drawer"))
    return " / ".join(f"{values.count(name)}*{kind}" for name, kind in kinds if values.count(name)) or "shelf"


def _cabinet_opening(cell: Cell, values: Values) -> Bay:
    width, height = values.number("width"), values.number("height")
    return Bay(
        left=(cell.left - 0.5) * width,
        right=(cell.right - 0.5) * width,
        bottom=cell.bottom * height,
        top=cell.top * height,
        depth=values.number("depth"),
        wall=values.number("wall"),
    )


def _side(cells: Sequence[Cell], cell: Cell) -> str:
    """Pairs of doors open from their middle; a single door has its hinge at the nearer outer side, else left."""
    beside = [
        other for other in cells
        if other.kind == "door" and other.bottom == cell.bottom and other.top == cell.top and other.right <= cell.left
    ]  # fmt: skip
    if len(beside) % 2 == 1:
        return "right"
    alone = cell.right > 1.0 - 1e-9 and cell.left > 0.0
    return "right" if alone else "left"


_OVERHANG = 0.03  # of the top on all sides [m]
_LEG = 0.05  # [m]
_MOST = 5  # stacks, and drawers in one

_Span = tuple[float, float, float, float]
"""Left, right, bottom and top of a drawer's field [m]."""


def build_table(values: Values, workshop: Workshop) -> None:
    """Tables and desks with drawers: a row under the top, pedestals of stacked drawers at the sides, or both."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    under = height - values.number("top")
    half, back = 0.5 * width - _OVERHANG, depth - 2.0 * _OVERHANG
    stacks = _stacks(values, half, under)
    openings = [_table_opening(span, back) for stack in stacks for span in stack]
    body = union(
        box((-0.5 * width, -_OVERHANG, under), (0.5 * width, depth - _OVERHANG, height)),
        *(box((stack[0][0], 0, stack[-1][2]), (stack[0][1], back, under)) for stack in stacks),
        box((-half, back - 0.02, under - 0.08), (half, back, under)),
        *(_leg(x, y, under) for x in (-half, half - _LEG) for y in (0.0, back - _LEG)),
    )
    workshop.body("body", body - union(*(room(opening) for opening in openings)))
    fitting = Fitting(clearance=values.number("clearance"), grip=values.choice("handle"), rest=values.number("open"))
    for k, opening in enumerate(openings):
        add_drawer(workshop, f"drawer_{k + 1}", "body", opening, fitting)


def _stacks(values: Values, half: float, under: float) -> list[list[_Span]]:
    """Fields of the drawers, from left to right, and in each stack from the top down."""
    counts = _columns(values)
    last = len(counts) - 1
    narrow = min(0.45, 1.6 * half / max(len(counts), 2))
    stacks = []
    for k, number in enumerate(counts):
        if max(counts) == 1:
            left, right = -half + 2.0 * half * k / len(counts), -half + 2.0 * half * (k + 1) / len(counts)
        elif k in (0, last):
            left, right = (half - narrow, half) if k == last else (-half, narrow - half)
        else:
            share = 2.0 * (half - narrow) / (last - 1)
            left, right = narrow - half + (k - 1) * share, narrow - half + k * share
        stacks.append(_stack((left, right), number, under))
    return [stack for stack in stacks if stack]


def _columns(values: Values) -> list[int]:
    """How many drawers each stack has, from left to right."""
    if not values.choice("layout"):
        count = values.count("drawers")
        return [1] * count if values.choice("arrangement") == "row" else [count]
    cells = parse_layout(values.choice("layout"))
    kinds = {cell.kind for cell in cells}
    if "drawer" not in kinds or not kinds <= {"drawer", "panel"}:
        raise InputError(
            f"The layout {values.choice('layout')!r} of a table needs drawers, and panels where none are, and nothing "
            "else. Write for example '2*drawer | drawer'; for doors ask for a cabinet."
        )
    lefts = sorted({cell.left for cell in cells})
    counts = [sum(cell.left == left and cell.kind == "drawer" for cell in cells) for left in lefts]
    if len(counts) > _MOST or max(counts) > _MOST:
        raise InputError(
            f"The layout {values.choice('layout')!r} has {len(counts)} stacks of up to {max(counts)} drawers; a table "
            f"has at most {_MOST} of at most {_MOST}."
        )
    return counts


def _stack(across: tuple[float, float], count: int, under: float) -> list[_Span]:
    """Several drawers reach down to the floor, a single one hangs under the top."""
    if count <= 1:
        return [(*across, under - min(max(0.16 * under, 0.09), 0.2), under)] * count
    pitch = (under - _LEG) / count
    spans = [(*across, under - (k + 1) * pitch, under - k * pitch) for k in range(count)]
    spans[-1] = (*across, _LEG, spans[-1][3])
    return spans


def _table_opening(span: _Span, back: float) -> Bay:
    left, right, bottom, top = span
    wall = min(0.018, 0.15 * (top - bottom))
    return Bay(left=left, right=right, bottom=bottom, top=top, depth=back, wall=wall)


def _leg(x: float, y: float, height: float) -> Manifold:
    return box((x, y, 0), (x + _LEG, y + _LEG, height))


_PIN = 0.004  # radius [m]
_BOARD = 0.014  # thickness of the slats [m]
_LEGS = 0.75  # how far the rear legs swing back [rad]


def build_folding_chair(values: Values, workshop: Workshop) -> None:
    """Folding chairs: a frame with a back, legs and a seat that fold into it. Zero is folded flat."""
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
    _add_board_seat(values, workshop)


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


def _add_board_seat(values: Values, workshop: Workshop) -> None:
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


_COLUMN = 0.026  # radius of the tube around the gas spring [m]
_SPRING = 0.014  # radius of the gas spring [m]
_SIDES = 8  # of the gas spring
_FORK = (0.07, 0.016)  # width and radius of the backrest's hinge [m]
_SEAT = 0.065  # thickness of the cushion [m]


def build_office_chair(values: Values, workshop: Workshop) -> None:
    """Office chairs: a star with castors, a gas spring, a seat that turns and a backrest that leans."""
    level = 2.0 * values.number("wheel") + 0.035  # underside of the star's arms
    column = level + values.number("column")
    hub = cylinder(0.04, (0, 0, level - 0.005), (0, 0, level + 0.05))
    workshop.body("base", hub, cylinder(_COLUMN, (0, 0, level), (0, 0, column)))
    count = values.count("castors")
    for k in range(count):
        _add_castor(values, workshop, k + 1, 2.0 * math.pi * k / count, level)
    _add_cushion(values, workshop, _add_spring(values, workshop, level, column))


def _add_castor(values: Values, workshop: Workshop, number: int, angle: float, level: float) -> None:
    """An arm of the star; under its end a fork on a stem that turns, and in the fork a wheel."""
    wheel, reach, clearance = values.number("wheel"), values.number("star"), values.number("clearance")
    cosine, sine = math.cos(angle), math.sin(angle)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    place = at(turn @ (0.0, -reach, 0.0), turn)
    arm = hull(
        cylinder(0.022, (0, reach, level), (0, reach, level + 0.045), segments=24),
        cylinder(0.016, (0, 0, level), (0, 0, level + 0.03), segments=24),
    )
    workshop.add("base", arm.transform(place))
    workshop.cut("base", bore(STEM, clearance, (0, 0, level - 0.01), (0, 0, level + 0.024)).transform(place))
    axle = np.array([0.0, -0.4 * wheel, wheel])
    fork, roller = (solid.transform(place) for solid in castor(axle, level - clearance, wheel, clearance))
    workshop.body(f"castor_{number}", fork, material="metal")
    workshop.turns(f"castor_{number}", "base", (0, 0, 1), place[:, 3])
    workshop.body(f"wheel_{number}", roller, material="rubber")
    workshop.turns(f"wheel_{number}", f"castor_{number}", turn[:, 0], place @ (*axle, 1.0))


def _add_spring(values: Values, workshop: Workshop, level: float, column: float) -> float:
    """A rod that rises in the column, of eight sides that it may not turn; returns the level of what turns on it."""
    clearance = values.number("clearance")
    top = column + 0.012
    travel = min(0.1, 0.5 * values.number("column"))
    workshop.cut("base", bore(_SPRING, clearance, (0, 0, level + 0.01), (0, 0, column + 0.1), segments=_SIDES))
    boss, hole, rotor = stub((0, 0, top + 0.022), (0, 0, 1), 0.032, clearance, length=0.022)
    rod = cylinder(_SPRING, (0, 0, level + 0.014), (0, 0, top + 0.001), segments=_SIDES)
    workshop.body("lift", rod, boss, material="steel")
    workshop.cut("lift", hole)
    workshop.slides("lift", "base", (0, 0, 1), (0, 0, column), (0.0, travel), rest=values.number("open"))
    workshop.body("seat", rotor)
    workshop.turns("seat", "lift", (0, 0, 1), (0, 0, top + 0.022))
    return top + 0.044 + clearance


def _add_cushion(values: Values, workshop: Workshop, level: float) -> None:
    """A cushion on a plate, and behind it a bracket with the backrest."""
    width, depth, clearance = values.number("width"), values.number("depth"), values.number("clearance")
    behind = 0.5 * depth + 0.05
    places = [(sx * (0.5 * width - 0.05), sy * (0.5 * depth - 0.05)) for sx in (-1, 1) for sy in (-1, 1)]
    cushion = [cylinder(0.05, (*xy, level + 0.02), (*xy, level + _SEAT), segments=24) for xy in places]
    plate = box((-0.1, -0.12, level - 0.01), (0.1, 0.12, level + 0.021))
    bracket = box((-0.03, 0.1, level - 0.01), (0.03, behind + _FORK[1], level + 0.012))
    pivot = (0.0, behind, level + 0.012 + 2.0 * _FORK[1])
    forked, tongue = bent_fork(pivot, (0.0, 0.0), _FORK[0], _FORK[1], clearance)
    workshop.add("seat", plate, bracket, forked, hull(*cushion))
    if values.choice("armrests") == "armrests":
        workshop.add("seat", *(solid for s in (-1, 1) for solid in _armrest(s * (0.5 * width + 0.02), level)))
    high = values.number("back")
    low = level + _SEAT + 0.05
    rail = box((-0.025, behind - 0.01, pivot[2] + 0.02), (0.025, behind + 0.01, low + 0.5 * high))
    wide = 0.5 * width - 0.05
    rest = [
        rod(0.02, (s * wide, behind - 0.015, z), (0.6 * s * wide, behind + 0.002, z))
        for s in (-1, 1)
        for z in (low + 0.02, low + high - 0.02)
    ]
    workshop.body("back", tongue, rail, hull(*rest))
    workshop.turns("back", "seat", (-1, 0, 0), pivot, (0.0, 0.45), rest=values.number("open"))


def _armrest(x: float, level: float) -> list[Manifold]:
    """A bow beside the cushion with a pad on it."""
    low, high = level + 0.03, level + _SEAT + 0.19
    inner = -0.06 if x > 0 else 0.06
    return [
        rod(0.012, (x + inner, 0.0, low), (x, 0.0, low)),
        rod(0.012, (x, 0.0, low), (x, 0.0, high)),
        hull(rod(0.018, (x, -0.11, high), (x, 0.1, high)), rod(0.018, (x, -0.11, high + 0.01), (x, 0.1, high + 0.01))),
    ]
