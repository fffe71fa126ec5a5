"""What is fixed to a building: doors, windows and panels with switches or buttons."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.pieces.bearings import barrel
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_button, add_knob, add_lever, grid
from kinematify.generate.procedural.pieces.fronts import handle
from kinematify.generate.procedural.pieces.leaves import (
    Field,
    Grooves,
    Hinge,
    add_sliding,
    carved,
    hang,
    hinged_slab,
    side_by_side,
    stopped_opening,
)
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, rod

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop


_DOOR_DEPTH = 0.11  # of a frame without grooves [m]
_DOOR_BARREL = 0.007  # radius [m]
_FLOOR = 0.006  # under a leaf that has no sill [m]
_OPENS = 1.75  # [rad]; less where the leaves of two openings would meet
_FOLDS = 1.25  # of the first leaf of a folding door; the others fold back by twice as much [rad]


def build_door(values: Values, workshop: Workshop) -> None:
    """Doors in their frames: hinged leaves, alone or in pairs, leaves that slide in grooves, and leaves that fold."""
    {"hinged": _door_hinged, "sliding": _door_sliding, "folding": _folding}[values.choice("kind")](values, workshop)


def _frame(values: Values, depth: float) -> Manifold:
    half = 0.5 * values.number("width")
    return box((-half, 0, 0), (half, depth, values.number("height")))


def _opening(values: Values, sill: float) -> Field:
    half, bar = 0.5 * values.number("width"), values.number("frame")
    return Field(left=bar - half, right=half - bar, bottom=sill, top=values.number("height") - bar)


def _panelled(values: Values, slab: Manifold, face: Field, front: float) -> Manifold:
    """A leaf with its panels, one above the other."""
    rows, thick = values.count("panels"), values.number("thick")
    return carved(slab, face, front, thick, bar=_stile(face), rows=rows, columns=1, sunk=0.25)


def _stile(face: Field) -> float:
    """Width of the bars around a leaf's panels, where handles are."""
    return min(0.11, 0.22 * (face.right - face.left))


def _door_hinged(values: Values, workshop: Workshop) -> None:
    clearance, rest, thick = values.number("clearance"), values.number("open"), values.number("thick")
    opening = _opening(values, 0.0)
    groups = side_by_side(opening, values.count("leaves"), values.number("frame"), together=2)
    cut = stopped_opening(groups, _DOOR_DEPTH, thick, clearance)
    below = [Field(left=g[0].left, right=g[-1].right, bottom=-1.0, top=0.1).box(-1.0, 1.0) for g in groups]
    workshop.body("frame", _frame(values, _DOOR_DEPTH) - cut)
    workshop.cut("frame", *below)
    radius = _DOOR_BARREL if values.choice("hinge") == "barrel" else 0.0
    opens = _OPENS if len(groups) == 1 else 1.5
    leaves = [(place, field) for group in groups for place, field in enumerate(group)]
    for number, (place, field) in enumerate(leaves, start=1):
        edge = ("left", "right")[place]
        if len(leaves) == 1 and values.choice("hinge_side") == "right":
            edge = "right"
        raised = Field(left=field.left, right=field.right, bottom=_FLOOR, top=field.top)
        hinge = Hinge(edge=edge, barrel=radius, thick=thick, clearance=clearance)
        leaf = _panelled(values, hinged_slab(raised, hinge), raised, 0.0)
        x = field.right - 0.5 * _stile(field) if edge == "left" else field.left + 0.5 * _stile(field)
        grip = values.choice("handle")
        solids = [leaf, *handle(grip, (x, 0.0, 1.0), along="z", length=0.3)] if grip == "bar" else [leaf]
        hang(workshop, f"leaf_{number}", "frame", raised, hinge, solids=solids, opens=opens, rest=rest, count=3)
        mount = Mount(parent=f"leaf_{number}", place=(x, 0.0, 1.0), face=FRONT, clearance=clearance, depth=thick)
        _add_door_handle(workshop, f"handle_{number}", mount, grip, edge=edge, stile=_stile(field), rest=rest)


def _add_door_handle(
    workshop: Workshop, name: str, mount: Mount, grip: str, *, edge: str, stile: float, rest: float
) -> None:
    """A handle that turns: a lever towards the hinge, on both sides where there is room for it, or a knob."""
    if grip == "lever":
        arm, swing = (math.pi, 0.8) if edge == "left" else (0.0, -0.8)
        add_lever(workshop, name, mount, 1.1 * stile, arm=arm, swing=swing, through=stile > 0.08, rest=rest)
    elif grip == "knob":
        add_knob(workshop, name, mount, min(0.028, 0.4 * stile), rest=rest)


def _door_sliding(values: Values, workshop: Workshop) -> None:
    """Leaves in grooves of sill and lintel; each passes its neighbour."""
    count, thick = values.count("leaves"), values.number("thick")
    tracks = Grooves(
        opening=_opening(values, 0.03), count=max(count, 2), thick=thick, clearance=values.number("clearance")
    )
    workshop.body("frame", _frame(values, tracks.depth))

    def finish(slab: Manifold, face: Field, front: float) -> Manifold:
        x, half = face.left + 0.5 * _stile(face), min(0.012, 0.3 * _stile(face))
        pull = box((x - half, front - 1.0, 0.93), (x + half, front + 0.3 * thick, 1.07))
        return _panelled(values, slab, face, front) - pull

    add_sliding(workshop, "leaf", "frame", tracks, count=count, finish=finish, rest=values.number("open"))


def _folding(values: Values, workshop: Workshop) -> None:
    """Leaves in a row, each hinged to the one before, in front and behind in turn; a single one is made of two."""
    clearance, rest, thick = values.number("clearance"), values.number("open"), values.number("thick")
    opening = _opening(values, _FLOOR)
    (row,) = side_by_side(opening, max(2, values.count("leaves")), 0.0, together=99)
    workshop.body("frame", _frame(values, thick + 0.02) - opening.box(-1.0, 1.0) - _below(opening))
    gap = clearance + 0.001
    spare = 0.5 * (thick + _DOOR_BARREL + clearance) ** 2 / (row[0].right - row[0].left)
    parent = "frame"
    for k, field in enumerate(row):
        name, last = f"leaf_{k + 1}", k + 1 == len(row)
        right = field.right - gap - (spare + gap if last else 0.0)
        slab = box((field.left + gap, 0, field.bottom + gap), (right, thick, field.top - gap))
        solids = [_panelled(values, slab, field, 0.0)]
        if last:
            solids += handle("edge", (right - 0.4 * _stile(field), 0.0, 1.0), along="z", length=0.12)
        inwards = k % 2 == 0
        level = -_DOOR_BARREL - clearance if inwards else thick + _DOOR_BARREL + clearance
        workshop.body(name, *solids)
        _add_folding_barrels(workshop, parent, name, field, clearance, level=level, gap=gap)
        opens = _FOLDS if k == 0 else 2.0 * _FOLDS
        workshop.turns(name, parent, (0, 0, -1 if inwards else 1), (field.left, level, 0), (0.0, opens), rest=rest)
        parent = name


def _below(opening: Field) -> Manifold:
    return Field(left=opening.left, right=opening.right, bottom=-1.0, top=0.1).box(-1.0, 1.0)


def _add_folding_barrels(
    workshop: Workshop, parent: str, name: str, field: Field, clearance: float, *, level: float, gap: float
) -> None:
    """Barrels on the faces of two leaves, or of a jamb and a leaf, about the line at x = field.left, y = level."""
    far, near = (gap + 3.0 * _DOOR_BARREL, gap + 0.6 * _DOOR_BARREL)
    face = (_DOOR_BARREL + clearance - 2e-4, _DOOR_BARREL + clearance + 1e-4)
    halves = barrel(0.08, _DOOR_BARREL, clearance, ((-far, -near, *face), (near, far, *face)))
    height = field.top - field.bottom
    for share in (0.15, 0.5, 0.85):
        place = (field.left, level, field.bottom + share * height)
        for body, half in zip((parent, name), halves, strict=True):
            workshop.add(body, (half if level < 0 else half.mirror((0, 1, 0))).translate(place))


_THICK = 0.04  # of a sash [m]
_WINDOW_DEPTH = 0.07  # of a frame without grooves [m]
_SASH = 0.045  # width of a sash's bars [m]
_WINDOW_BARREL = 0.005  # radius [m]
_WINDOW_PIN = 0.008  # radius of what a pivoting sash turns on [m]
_TURNING = {"casement": 1.5, "tilt": 0.6, "awning": 0.8}
"""How far a sash opens [rad]."""


def build_window(values: Values, workshop: Workshop) -> None:
    """Windows: sashes that slide in grooves, or turn about a side, the lower or upper edge, or pins at mid-height."""
    width, height, bar = values.number("width"), values.number("height"), values.number("frame")
    opening = Field(left=bar - 0.5 * width, right=0.5 * width - bar, bottom=bar, top=height - bar)
    kind = values.choice("kind")
    if kind == "sliding":
        _window_sliding(values, workshop, opening)
    elif kind == "pivot":
        _pivoting(values, workshop, opening)
    else:
        _window_hinged(values, workshop, opening, kind)


def _glazed(values: Values, slab: Manifold, face: Field, front: float) -> Manifold:
    """A sash with its panes."""
    rows, columns = values.count("rows"), values.count("columns")
    return carved(slab, face, front, _THICK, bar=_bar(face), rows=rows, columns=columns, sunk=0.42)


def _bar(face: Field) -> float:
    """Width of the bars around a sash's panes."""
    return min(_SASH, 0.2 * (face.right - face.left), 0.2 * (face.top - face.bottom))


def _window_sliding(values: Values, workshop: Workshop, opening: Field) -> None:
    count = values.count("sashes")
    tracks = Grooves(opening=opening, count=max(count, 2), thick=_THICK, clearance=values.number("clearance"))
    workshop.body("frame", _frame(values, tracks.depth))

    def finish(slab: Manifold, face: Field, front: float) -> Manifold:
        x, z = face.left + 0.5 * _bar(face), face.middle[1]
        pull = box((x - 0.006, front - 1.0, z - 0.05), (x + 0.006, front + 0.008, z + 0.05))
        return _glazed(values, slab, face, front) - pull

    add_sliding(workshop, "sash", "frame", tracks, count=count, finish=finish, rest=values.number("open"))


def _window_hinged(values: Values, workshop: Workshop, opening: Field, kind: str) -> None:
    clearance, rest = values.number("clearance"), values.number("open")
    together = 2 if kind == "casement" else 1
    groups = side_by_side(opening, values.count("sashes"), values.number("frame"), together=together)
    workshop.body("frame", _frame(values, _WINDOW_DEPTH) - stopped_opening(groups, _WINDOW_DEPTH, _THICK, clearance))
    radius = _WINDOW_BARREL if values.choice("hinge") == "barrel" else 0.0
    number = 0
    for group in groups:
        for place, field in enumerate(group):
            number += 1
            edge = {"tilt": "bottom", "awning": "top"}.get(kind, ("left", "right")[place])
            hinge = Hinge(edge=edge, barrel=radius, thick=_THICK, clearance=clearance)
            sash = _glazed(values, hinged_slab(field, hinge), field, 0.0)
            hang(workshop, f"sash_{number}", "frame", field, hinge, solids=[sash], opens=_TURNING[kind], rest=rest)
            if values.choice("handle") == "lever":
                _add_window_handle(
                    workshop, f"handle_{number}", f"sash_{number}", field, edge=edge, clearance=clearance, rest=rest
                )


def _pivoting(values: Values, workshop: Workshop, opening: Field) -> None:
    """Sashes on pins in the jambs, which turn about their middle."""
    clearance, rest = values.number("clearance"), values.number("open")
    groups = side_by_side(opening, values.count("sashes"), values.number("frame"))
    workshop.body("frame", _frame(values, _WINDOW_DEPTH))
    for number, (field,) in enumerate(groups, start=1):
        workshop.cut("frame", field.box(-1.0, 1.0))
        gap, half = clearance + 0.001, 0.5 * (field.top - field.bottom)
        swing = gap + math.hypot(half, 0.5 * _THICK) - half
        x, z = field.middle
        start = 0.5 * (_WINDOW_DEPTH - _THICK)
        lower = (field.left + gap, start, field.bottom + swing)
        slab = box(lower, (field.right - gap, start + _THICK, field.top - swing))
        name, reach = f"sash_{number}", 0.4 * values.number("frame")
        ends = (field.left - reach, 0.5 * _WINDOW_DEPTH, z), (field.right + reach, 0.5 * _WINDOW_DEPTH, z)
        far = (ends[0][0] - clearance, *ends[0][1:]), (ends[1][0] + clearance, *ends[1][1:])
        workshop.cut("frame", bore(_WINDOW_PIN, clearance, *far))
        pins = cylinder(_WINDOW_PIN, *ends) - field.box(-1.0, 1.0, inset=2.0 * gap)
        workshop.body(name, _glazed(values, slab, field, start), pins)
        workshop.turns(name, "frame", (1, 0, 0), (x, 0.5 * _WINDOW_DEPTH, z), (0.0, 1.3), rest=rest)


def _add_window_handle(
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


_SWITCH_DEPTH = 0.034  # of the housing [m]
_POCKET = 0.024  # depth of the room behind a switch [m]
_PIVOT = 0.009  # depth of its pins [m]
_SWITCH_PANEL_PIN = 0.003  # radius of the pins [m]
_TILT = {"rocker": 0.12, "toggle": 0.35}
"""From the middle to either end [rad]."""


def build_switch_panel(values: Values, workshop: Workshop) -> None:
    """Light switches: rockers or toggles side by side in a plate, and dimmers."""
    rockers, dimmers = values.count("rockers"), values.count("dimmers")
    pitch, height = values.number("pitch"), values.number("height")
    half = 0.5 * pitch * (rockers + dimmers) + 0.006
    plate = box((-half, 0, 0), (half, 0.004, height))
    housing = box((0.004 - half, 0.001, 0.004), (half - 0.004, _SWITCH_DEPTH, height - 0.004))
    workshop.body("plate", plate, housing)
    for k in range(rockers):
        _add_switch(values, workshop, k, (k + 0.5) * pitch - half + 0.006)
    clearance = values.number("clearance")
    for k in range(dimmers):
        place = ((rockers + k + 0.5) * pitch - half + 0.006, 0.0, 0.5 * height)
        mount = Mount(parent="plate", place=place, face=FRONT, clearance=clearance, depth=0.02)
        add_knob(workshop, f"dimmer_{k + 1}", mount, 0.36 * pitch, rest=values.number("open"))


def _add_switch(values: Values, workshop: Workshop, k: int, x: float) -> None:
    """A switch on pins that lie along x, tilted to its lower end."""
    kind, clearance = values.choice("kind"), values.number("clearance")
    half, level = 0.5 * values.number("pitch") - 0.008, 0.5 * values.number("height")
    if kind == "rocker":
        solid, room = _rocker(half, 0.36 * values.number("height"), clearance)
    else:
        half = min(half, 0.01)
        solid, room = _toggle(half, clearance)
    reach, tight = half + 0.0055, min(clearance, 0.5 * _SWITCH_PANEL_PIN)
    pins = cylinder(_SWITCH_PANEL_PIN, (-reach, 0, 0), (reach, 0, 0))
    place = (x, _PIVOT, level)
    workshop.cut("plate", room.translate(place))
    workshop.cut(
        "plate", bore(_SWITCH_PANEL_PIN, tight, (-reach - tight, 0, 0), (reach + tight, 0, 0)).translate(place)
    )
    tilt = _TILT[kind]
    name = f"rocker_{k + 1}"
    workshop.body(name, (solid + pins).rotate((math.degrees(tilt), 0, 0)).translate(place))
    workshop.turns(name, "plate", (-1, 0, 0), place, (0.0, 2.0 * tilt), rest=values.number("open"))


def _rocker(half: float, high: float, clearance: float) -> tuple[Manifold, Manifold]:
    """A wedge with a ridge in its middle, level about its pins, and the room that it needs."""
    edge = high * math.tan(_TILT["rocker"]) - _PIVOT - 0.003
    ridge = box((-half, -_PIVOT - 0.003, -1e-3), (half, 0.004, 1e-3))
    wedge = hull(ridge, box((-half, edge, -high), (half, edge + 0.003, high)))
    reach = math.hypot(high, edge) + clearance
    wide = half + clearance
    return wedge, box((-wide, -1.0, -reach), (wide, _POCKET - _PIVOT, reach))


def _toggle(half: float, clearance: float) -> tuple[Manifold, Manifold]:
    """A stick on a hub, and the room that it needs."""
    hub = cylinder(0.006, (-half, 0, 0), (half, 0, 0))
    stick = hull(rod(0.0035, (0, 0, 0), (0, -0.01, 0)), rod(0.0045, (0, -0.022, 0), (0, -0.024, 0)))
    wide = half + clearance
    return hub + stick, box((-wide, -1.0, -0.012 - clearance), (wide, 0.008 + clearance, 0.012 + clearance))


_DEEP = 0.012  # pockets of the buttons [m]


def build_button_panel(values: Values, workshop: Workshop) -> None:
    """Button panels and keypads: buttons in rows on a housing, with knobs and a display above them."""
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    workshop.body("housing", box((-0.5 * width, 0, 0), (0.5 * width, depth, height)))
    top = 0.94 * height
    if values.choice("display") == "display":
        workshop.cut("housing", box((-0.42 * width, -1.0, top - 0.16 * height), (0.42 * width, 0.002, top)))
        top -= 0.2 * height
    if values.count("knobs"):
        _add_knobs(values, workshop, top - 0.1 * height)
        top -= 0.22 * height
    _add_buttons(values, workshop, 0.06 * height, top)


def _add_knobs(values: Values, workshop: Workshop, level: float) -> None:
    count, width = values.count("knobs"), values.number("width")
    pitch = 0.9 * width / count
    radius = min(0.09 * values.number("height"), 0.38 * pitch)
    for k in range(count):
        x = (k - 0.5 * (count - 1)) * pitch
        clearance = min(values.number("clearance"), 0.2 * radius)
        mount = Mount(parent="housing", place=(x, 0, level), face=FRONT, clearance=clearance, depth=_DEEP)
        add_knob(workshop, f"knob_{k + 1}", mount, radius, rest=values.number("open"))


def _add_buttons(values: Values, workshop: Workshop, bottom: float, top: float) -> None:
    width, count = values.number("width"), values.count("buttons")
    columns = min(values.count("columns"), count)
    rows = -(-count // columns)
    pitch = min(0.9 * width / columns, (top - bottom) / rows)
    clearance = min(values.number("clearance"), 0.08 * pitch)
    area = (columns * min(0.9 * width / columns, 1.6 * pitch), rows * min((top - bottom) / rows, 1.6 * pitch))
    size = (0.84 * pitch - 2.0 * clearance,) * 2
    for k, (x, z) in enumerate(grid(count, columns, area)):
        place = (x, 0.0, 0.5 * (bottom + top) + z)
        mount = Mount(parent="housing", place=place, face=FRONT, clearance=clearance, depth=_DEEP)
        is_round = values.choice("shape") == "round"
        travel = min(0.004, 0.3 * pitch)
        add_button(workshop, f"button_{k + 1}", mount, size, travel=travel, is_round=is_round)
