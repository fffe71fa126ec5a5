"""Cabinets, chests, wardrobes and desks' pedestals: any grid of doors, drawers and open shelves."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import Family
from kinematify.generate.procedural.layout import parse_layout
from kinematify.generate.procedural.parameter import choice, counted, length, phrases
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_door, add_drawer, carcass
from kinematify.generate.procedural.pieces.handles import HANDLES

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

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


_NIGHTSTAND = {"width": 0.45, "height": 0.55, "depth": 0.4, "doors": 0, "drawers": 2}
_WARDROBE = {"width": 1.0, "height": 2.0, "depth": 0.6, "doors": 2, "drawers": 0}
_SIDEBOARD = {"width": 1.6, "height": 0.8, "depth": 0.45, "doors": 3, "drawers": 0}
_CHEST = {"doors": 0, "drawers": 4}
_KINDS: dict[str, Mapping[str, float | int | str]] = {
    **dict.fromkeys(("nightstand", "bedside table"), _NIGHTSTAND),
    **dict.fromkeys(("wardrobe", "armoire", "closet"), _WARDROBE),
    **dict.fromkeys(("sideboard", "credenza"), _SIDEBOARD),
    **dict.fromkeys(("chest of drawer", "dresser", "drawer unit", "commode"), _CHEST),
    **dict.fromkeys(("filing cabinet", "file cabinet"), _CHEST | {"width": 0.45, "height": 1.3}),
    "locker": {"width": 0.35, "height": 1.8, "doors": 1, "drawers": 0},
    "bookcase": {"width": 0.8, "height": 1.8, "depth": 0.35, "doors": 2, "drawers": 0, "shelves": 2},
    **dict.fromkeys(("tv stand", "tv unit"), _SIDEBOARD | {"height": 0.5}),
}

FAMILY = Family(
    name="cabinet",
    title="cabinet or chest",
    words=phrases(
        "cabinet, cupboard, wardrobe, closet, chest, chest of drawers, dresser, sideboard, nightstand, "
        "bedside table, drawer unit, commode, locker, bookcase, shelf, pantry, credenza, kitchen unit, base unit, "
        "wall unit, tv stand, tv unit, tallboy, storage unit, filing cabinet, file cabinet, bureau, chiffonier, "
        "vitrine, armoire"
        ", drawer cabinet, tool drawer cabinet, shoe cupboard, toy shelf, book cabinet"
    ),
    material="wood",
    kinds=_KINDS,
    parameters=(
        length("width", 0.8, (0.1, 5.0), "Outer width.", usual=(0.4, 1.2)),
        length("height", 0.9, (0.1, 4.0), "Outer height.", usual=(0.5, 1.8)),
        length("depth", 0.5, (0.1, 2.0), "Outer depth.", usual=(0.3, 0.6)),
        length("wall", 0.018, (0.004, 0.05), "Of the boards.", usual=(0.012, 0.025)),
        counted("doors", 2, (0, 12), "Doors, side by side.", usual=(0, 3)),
        counted("drawers", 3, (0, 12), "Drawers, stacked below the doors.", usual=(1, 4)),
        counted("shelves", 0, (0, 12), "Open fields.", words="shelf, open shelf, compartment"),
        choice("layout", (), "Any other arrangement, e.g. '(3*drawer) | door'; overrides the counts."),
        choice("handle", HANDLES, "What doors and drawers are pulled by."),
        choice("hinge", ("edge", "barrel"), "Hidden hinges, or visible ones."),
    ),
    build=_build,
)
