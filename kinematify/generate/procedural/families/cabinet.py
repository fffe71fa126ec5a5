"""Cabinets, chests, wardrobes and desks' pedestals: any grid of doors, drawers and open shelves."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.layout import parse_layout
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_door, add_drawer, carcass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.layout import Cell
    from kinematify.generate.procedural.workshop import Workshop


def _build(values: Values, workshop: Workshop) -> None:
    cells = parse_layout(values.choice("layout") or _default_layout(values))
    openings = [_opening(cell, values) for cell in cells]
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


def _opening(cell: Cell, values: Values) -> Opening:
    width, height = values.number("width"), values.number("height")
    return Opening(
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


FAMILY = family("cabinet", _build)
