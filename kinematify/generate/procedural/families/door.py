"""Doors in their frames: hinged leaves, alone or in pairs, leaves that slide in grooves, and leaves that fold."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import barrel
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_knob, add_lever
from kinematify.generate.procedural.pieces.handles import handle
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
from kinematify.generate.procedural.solids import box

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_DEPTH = 0.11  # of a frame without grooves [m]
_BARREL = 0.007  # radius [m]
_FLOOR = 0.006  # under a leaf that has no sill [m]
_OPENS = 1.75  # [rad]; less where the leaves of two openings would meet
_FOLDS = 1.25  # of the first leaf of a folding door; the others fold back by twice as much [rad]


def _build(values: Values, workshop: Workshop) -> None:
    {"hinged": _hinged, "sliding": _sliding, "folding": _folding}[values.choice("kind")](values, workshop)


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


def _hinged(values: Values, workshop: Workshop) -> None:
    clearance, rest, thick = values.number("clearance"), values.number("open"), values.number("thick")
    opening = _opening(values, 0.0)
    groups = side_by_side(opening, values.count("leaves"), values.number("frame"), together=2)
    cut = stopped_opening(groups, _DEPTH, thick, clearance)
    below = [Field(left=g[0].left, right=g[-1].right, bottom=-1.0, top=0.1).box(-1.0, 1.0) for g in groups]
    workshop.body("frame", _frame(values, _DEPTH) - cut)
    workshop.cut("frame", *below)
    radius = _BARREL if values.choice("hinge") == "barrel" else 0.0
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
        _add_handle(workshop, f"handle_{number}", mount, grip, edge=edge, stile=_stile(field), rest=rest)


def _add_handle(
    workshop: Workshop, name: str, mount: Mount, grip: str, *, edge: str, stile: float, rest: float
) -> None:
    """A handle that turns: a lever towards the hinge, on both sides where there is room for it, or a knob."""
    if grip == "lever":
        arm, swing = (math.pi, 0.8) if edge == "left" else (0.0, -0.8)
        add_lever(workshop, name, mount, 1.1 * stile, arm=arm, swing=swing, through=stile > 0.08, rest=rest)
    elif grip == "knob":
        add_knob(workshop, name, mount, min(0.028, 0.4 * stile), rest=rest)


def _sliding(values: Values, workshop: Workshop) -> None:
    """Leaves in grooves of sill and lintel; each passes its neighbour."""
    count, thick = values.count("leaves"), values.number("thick")
    tracks = Tracks(
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
    spare = 0.5 * (thick + _BARREL + clearance) ** 2 / (row[0].right - row[0].left)
    parent = "frame"
    for k, field in enumerate(row):
        name, last = f"leaf_{k + 1}", k + 1 == len(row)
        right = field.right - gap - (spare + gap if last else 0.0)
        slab = box((field.left + gap, 0, field.bottom + gap), (right, thick, field.top - gap))
        solids = [_panelled(values, slab, field, 0.0)]
        if last:
            solids += handle("edge", (right - 0.4 * _stile(field), 0.0, 1.0), along="z", length=0.12)
        inwards = k % 2 == 0
        level = -_BARREL - clearance if inwards else thick + _BARREL + clearance
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
    far, near = (gap + 3.0 * _BARREL, gap + 0.6 * _BARREL)
    face = (_BARREL + clearance - 2e-4, _BARREL + clearance + 1e-4)
    halves = barrel(0.08, _BARREL, clearance, ((-far, -near, *face), (near, far, *face)))
    height = field.top - field.bottom
    for share in (0.15, 0.5, 0.85):
        place = (field.left, level, field.bottom + share * height)
        for body, half in zip((parent, name), halves, strict=True):
            workshop.add(body, (half if level < 0 else half.mirror((0, 1, 0))).translate(place))


FAMILY = family("door", _build)
