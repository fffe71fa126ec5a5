"""Tables and desks with drawers: a row under the top, or a pedestal of stacked drawers at one side."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.sources.procedural.family import Family, Parameter
from kinematify.sources.procedural.pieces.fronts import Fitting, Opening, add_drawer, room
from kinematify.sources.procedural.pieces.handles import HANDLES
from kinematify.sources.procedural.solids import box, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.sources.procedural.family import Values
    from kinematify.sources.procedural.workshop import Workshop

_OVERHANG = 0.03  # of the top on all sides [m]
_LEG = 0.05  # [m]


def _build(values: Values, workshop: Workshop) -> None:
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    under = height - values.number("top")
    half, back = 0.5 * width - _OVERHANG, depth - 2.0 * _OVERHANG
    openings = _openings(values, half, back, under)
    left, bottom = min(o.left for o in openings), min(o.bottom for o in openings)
    body = union(
        box((-0.5 * width, -_OVERHANG, under), (0.5 * width, depth - _OVERHANG, height)),
        box((left, 0, bottom), (half, back, under)),
        box((-half, back - 0.02, under - 0.08), (half, back, under)),
        *(_leg(x, y, under) for x in (-half, half - _LEG) for y in (0.0, back - _LEG)),
    )
    workshop.body("body", body - union(*(room(opening) for opening in openings)))
    fitting = Fitting(clearance=values.number("clearance"), grip=values.choice("handle"), rest=values.number("open"))
    for k, opening in enumerate(openings):
        add_drawer(workshop, f"drawer_{k + 1}", "body", opening, fitting)


def _openings(values: Values, half: float, back: float, under: float) -> list[Opening]:
    """Of the drawers, from left to right or from the top down."""
    count = values.count("drawers")
    if values.choice("arrangement") == "row":
        height, pitch = min(max(0.16 * under, 0.09), 0.2), 2.0 * half / count
        spans = [(-half + k * pitch, -half + (k + 1) * pitch, under - height, under) for k in range(count)]
    else:
        bottom, pitch = _LEG, (under - _LEG) / count
        left = half - min(0.45, 0.8 * half)
        spans = [(left, half, under - (k + 1) * pitch, under - k * pitch) for k in range(count)]
        spans[-1] = (left, half, bottom, spans[-1][3])
    return [
        Opening(left=left, right=right, bottom=bottom, top=top, depth=back, wall=min(0.018, 0.15 * (top - bottom)))
        for left, right, bottom, top in spans
    ]


def _leg(x: float, y: float, height: float) -> Manifold:
    return box((x, y, 0), (x + _LEG, y + _LEG, height))


FAMILY = Family(
    name="table",
    title="table or desk with drawers",
    words=("table", "desk", "writing desk", "workbench", "console table", "vanity", "side table", "bench table"),
    material="wood",
    parameters=(
        Parameter(name="width", default=1.2, unit="m", bounds=(0.4, 4.0), usual=(0.8, 1.8), help="Outer width."),
        Parameter(name="depth", default=0.6, unit="m", bounds=(0.3, 2.0), usual=(0.45, 0.8), help="Outer depth."),
        Parameter(name="height", default=0.74, unit="m", bounds=(0.5, 1.5), usual=(0.65, 0.95), help="Outer height."),
        Parameter(
            name="top", default=0.025, unit="m", bounds=(0.01, 0.06), usual=(0.018, 0.045), help="Thickness of the top."
        ),
        Parameter(name="drawers", default=2, bounds=(1, 5), usual=(1, 4), help="Drawers."),
        Parameter(
            name="arrangement",
            default="row",
            choices=("row", "pedestal"),
            help="Drawers side by side under the top, or stacked at the right.",
            choice_words={"row": ("side by side", "in a row", "next to each other"), "pedestal": ("stacked",)},
        ),
        Parameter(name="handle", default="bar", choices=HANDLES, help="What drawers are pulled by."),
    ),
    build=_build,
)
