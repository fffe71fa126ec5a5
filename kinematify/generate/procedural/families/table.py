"""Tables and desks with drawers: a row under the top, pedestals of stacked drawers at the sides, or both."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.layout import parse_layout
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_drawer, room
from kinematify.generate.procedural.solids import box, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_OVERHANG = 0.03  # of the top on all sides [m]
_LEG = 0.05  # [m]
_MOST = 5  # stacks, and drawers in one

_Span = tuple[float, float, float, float]
"""Left, right, bottom and top of a drawer's field [m]."""


def _build(values: Values, workshop: Workshop) -> None:
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    under = height - values.number("top")
    half, back = 0.5 * width - _OVERHANG, depth - 2.0 * _OVERHANG
    stacks = _stacks(values, half, under)
    openings = [_opening(span, back) for stack in stacks for span in stack]
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
    for k, count in enumerate(counts):
        if max(counts) == 1:
            left, right = -half + 2.0 * half * k / len(counts), -half + 2.0 * half * (k + 1) / len(counts)
        elif k in (0, last):
            left, right = (half - narrow, half) if k == last else (-half, narrow - half)
        else:
            share = 2.0 * (half - narrow) / (last - 1)
            left, right = narrow - half + (k - 1) * share, narrow - half + k * share
        stacks.append(_stack((left, right), count, under))
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


def _opening(span: _Span, back: float) -> Opening:
    left, right, bottom, top = span
    wall = min(0.018, 0.15 * (top - bottom))
    return Opening(left=left, right=right, bottom=bottom, top=top, depth=back, wall=wall)


def _leg(x: float, y: float, height: float) -> Manifold:
    return box((x, y, 0), (x + _LEG, y + _LEG, height))


FAMILY = family("table", _build)
