"""Cabinets, tables and chairs, carved."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np
from manifold3d import Manifold

from kinematify.errors import InputError
from kinematify.generate.library.kind import choice, kind, length, whole
from kinematify.generate.library.mechanisms import caster
from kinematify.generate.library.panels import add_door, add_drawer
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.layout import Cell, parse_layout, stacked
from kinematify.generate.procedural.pieces.bearing_pieces import at, bent_fork, stub
from kinematify.generate.procedural.pieces.fronts import Bay, carcass, room
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, rod, slab, union

_MOST_STACKS = 5  # of a table, and drawers in one


def drawer_stacks(text: str) -> list[int]:
    """Return how many drawers each stack of a table has, from left to right.

    Raises:
        InputError: The layout has other fields, or too many.
    """
    cells = parse_layout(text)
    kinds = {cell.kind for cell in cells}
    if "drawer" not in kinds or not kinds <= {"drawer", "panel"}:
        raise InputError(
            f"The layout {text!r} of a table needs drawers, and panels where none are, and nothing else. Write for "
            "example '2*drawer | drawer'; for doors ask for a cabinet."
        )
    lefts = sorted({cell.left for cell in cells})
    counts = [sum(cell.left == left and cell.kind == "drawer" for cell in cells) for left in lefts]
    if len(counts) > _MOST_STACKS or max(counts) > _MOST_STACKS:
        raise InputError(
            f"The layout {text!r} has {len(counts)} stacks of up to {max(counts)} drawers; a table has at most "
            f"{_MOST_STACKS} of at most {_MOST_STACKS}."
        )
    return counts


@kind(
    words=(
        "cupboard, chest, shelf, pantry, kitchen unit, base unit, wall unit, tallboy, storage unit, bureau, "
        "chiffonier, vitrine, drawer cabinet, tool drawer cabinet, shoe cupboard, toy shelf, book cabinet, kitchen "
        "cabinet, kitchen cupboard, display cabinet, office cabinet"
    ),
    title="cabinet or chest",
    carved_from="wood",
    usual={
        "desk organizer, desk tidy, parts cabinet, small parts organizer, craft organizer": {
            "width": 0.22,
            "height": 0.2,
            "depth": 0.18,
            "wall": 0.006,
            "layout": "3*(2*drawer)",
        },
        "medicine cabinet, mirror cabinet, bathroom cabinet, first aid cabinet, bathroom cupboard": {
            "width": 0.55,
            "height": 0.6,
            "depth": 0.16,
            "doors": 2,
            "drawers": 0,
        },
        "kitchen block, row of kitchen units, kitchen counter, kitchenette": {
            "width": 1.8,
            "height": 0.9,
            "depth": 0.6,
            "doors": 3,
            "drawers": 3,
        },
        "wall cupboard, overhead cabinet, overhead locker, overhead cupboard": {
            "width": 0.85,
            "height": 0.6,
            "depth": 0.35,
            "doors": 2,
            "drawers": 0,
        },
        "nightstand, bedside table, bedside cabinet": {
            "width": 0.45,
            "height": 0.55,
            "depth": 0.4,
            "doors": 0,
            "drawers": 2,
        },
        "wardrobe, armoire, closet": {"width": 1.0, "height": 2.0, "depth": 0.6, "doors": 2, "drawers": 0},
        "sideboard, credenza": {"width": 1.6, "height": 0.8, "depth": 0.45, "doors": 3, "drawers": 0},
        "chest of drawer, dresser, drawer unit, commode": {"doors": 0, "drawers": 4},
        "filing cabinet, file cabinet": {"doors": 0, "drawers": 4, "width": 0.45, "height": 1.3},
        "apothecary chest, apothecary cabinet, card catalogue, card catalog": {"doors": 0, "drawers": 6},
        "kitchen island": {"width": 1.4, "height": 0.9, "depth": 0.7},
        "locker": {"width": 0.35, "height": 1.8, "doors": 1, "drawers": 0},
        "bookcase, bookshelf": {"width": 0.8, "height": 1.8, "depth": 0.35, "doors": 2, "drawers": 0, "shelves": 2},
        "tv stand, tv unit": {"width": 1.6, "height": 0.5, "depth": 0.45, "doors": 3, "drawers": 0},
        "aquarium stand, fish tank stand, media console, media cabinet, media unit, hi-fi stand": {
            "width": 0.9,
            "height": 0.8,
            "depth": 0.45,
            "doors": 2,
            "drawers": 0,
        },
        (
            "bar cabinet, liquor cabinet, wine cabinet, curio cabinet, china cabinet, hutch, gun cabinet, linen cabinet"
        ): {"width": 0.6, "height": 1.2, "depth": 0.4, "doors": 2, "drawers": 0},
        "key cabinet, wall cabinet, spice cabinet": {
            "width": 0.5,
            "height": 0.6,
            "depth": 0.2,
            "doors": 1,
            "drawers": 0,
        },
        "vanity unit, washstand, sink unit, changing table, baby changing table": {
            "width": 0.7,
            "height": 0.85,
            "depth": 0.5,
            "doors": 0,
            "drawers": 2,
        },
        "night table, end table, night stand, printer stand": {
            "width": 0.5,
            "height": 0.55,
            "depth": 0.4,
            "doors": 0,
            "drawers": 1,
        },
        "garderobe, linen closet": {"width": 1.2, "height": 2, "depth": 0.6, "doors": 2, "drawers": 0},
        "tv bench, tv lowboard, lowboard, entertainment center, entertainment unit, media bench": {
            "width": 1.5,
            "height": 0.5,
            "depth": 0.4,
            "doors": 0,
            "drawers": 2,
        },
        "tallboy dresser, lingerie chest, map cabinet, map chest, plan chest": {
            "width": 0.9,
            "height": 0.9,
            "depth": 0.45,
            "doors": 0,
            "drawers": 3,
        },
        (
            "buffet, storage cabinet, utility cabinet, base cabinet, sink cabinet, under sink cabinet, vanity cabinet, "
            "bathroom vanity, chemical cabinet, lab cabinet, record cabinet, toy cabinet, craft cabinet"
        ): {"width": 0.9, "height": 0.9, "depth": 0.45, "doors": 2, "drawers": 0},
        (
            "larder, pantry cupboard, broom closet, broom cupboard, trophy case, trophy cabinet, showcase, display "
            "case, gym locker, school locker, tool locker, parcel locker, pie safe"
        ): {"width": 0.8, "height": 1.8, "depth": 0.4, "doors": 2, "drawers": 0},
        "organizer, organiser, drawer organizer, jewelry cabinet, jewellery cabinet, tea cabinet, sewing cabinet": {
            "width": 0.35,
            "height": 0.25,
            "depth": 0.25,
            "doors": 0,
            "drawers": 3,
        },
        "switch cabinet, electrical cabinet": {
            "width": 0.5,
            "height": 0.7,
            "depth": 0.2,
            "doors": 1,
            "drawers": 0,
            "material": "steel",
        },
        "lateral file, lateral filing cabinet, file drawer cabinet": {
            "width": 0.45,
            "height": 1.1,
            "depth": 0.6,
            "doors": 0,
            "drawers": 4,
        },
        "tool storage cabinet": {"width": 0.7, "height": 0.9, "depth": 0.45, "doors": 0, "drawers": 5},
        "charging cabinet": {"width": 0.6, "height": 2, "depth": 0.8, "doors": 1, "drawers": 0, "material": "steel"},
        "switchgear, plc cabinet, evidence locker, proofing cabinet": {
            "width": 0.5,
            "height": 1.6,
            "depth": 0.6,
            "doors": 1,
            "drawers": 0,
            "material": "steel",
        },
    },
    width=length(0.1, 5.0, default=0.8, usual=(0.4, 1.2), help="Outer width."),
    height=length(0.1, 4.0, default=0.9, usual=(0.5, 1.8), help="Outer height."),
    depth=length(0.1, 2.0, default=0.5, usual=(0.3, 0.6), help="Outer depth."),
    wall=length(0.004, 0.05, default=0.018, usual=(0.012, 0.025), help="Of the boards."),
    doors=whole(0, 12, default=2, usual=(0, 3), help="Doors, side by side."),
    drawers=whole(0, 40, default=3, usual=(1, 4), help="Drawers, stacked below the doors."),
    shelves=whole(0, 12, default=0, usual=None, help="Open fields.", words="shelf, open shelf, compartment"),
    layout=choice((), help="Any other arrangement, e.g. '(3*drawer) | door'; overrides the counts."),
    handle=choice(("bar", "knob", "cup", "edge", "none"), help="What doors and drawers are pulled by."),
    hinge=choice(("edge", "barrel"), help="Hidden hinges, or visible ones."),
)
def cabinet(
    w: ObjectBuilder,
    width: float,
    height: float,
    depth: float,
    wall: float,
    doors: int,
    drawers: int,
    shelves: int,
    layout: str,
    handle: str,
    hinge: str,
    open: float,
) -> None:
    """Cabinets, chests, wardrobes and desks' pedestals: any grid of doors, drawers and open shelves."""

    # Open shelves above doors side by side above stacked drawers.
    def default_layout() -> str:
        kinds = ((shelves, "shelf"), (doors, "door"), (drawers, "drawer"))
        return stacked(kinds)

    def opening_of(cell: Cell) -> Bay:
        return Bay(
            left=(cell.left - 0.5) * width,
            right=(cell.right - 0.5) * width,
            bottom=cell.bottom * height,
            top=cell.top * height,
            depth=depth,
            wall=wall,
        )

    # Pairs of doors open from their middle; a single door has its hinge at the nearer outer side, else left.
    def side_of(cells: tuple[Cell, ...], cell: Cell) -> str:
        beside = [
            other
            for other in cells
            if other.kind == "door"
            and other.bottom == cell.bottom
            and (other.top == cell.top)
            and (other.right <= cell.left)
        ]
        if len(beside) % 2 == 1:
            found = "right"
        else:
            alone = cell.right > 1.0 - 1e-09 and cell.left > 0.0
            found = "right" if alone else "left"
        return found

    cells = parse_layout(layout or default_layout())
    openings = [opening_of(cell) for cell in cells]
    behind = [opening for cell, opening in zip(cells, openings, strict=False) if cell.kind != "panel"]
    w.part("body", carcass(width, height, depth, behind))
    for k, (cell, opening) in enumerate(zip(cells, openings, strict=False)):
        name = f"{cell.kind}_{sum([other.kind == cell.kind for other in cells[:k]]) + 1}"
        if cell.kind == "door":
            side = side_of(cells, cell)
            outermost = cell.left == 0.0 if side == "left" else cell.right > 1.0 - 1e-09
            add_door(
                w, name, "body", opening, side=side, hinge=hinge if outermost else "edge", handle=handle, opened=open
            )
        elif cell.kind == "drawer":
            add_drawer(w, name, "body", opening, handle=handle, opened=open)
    w.settle()


@kind(
    words=(
        "desk, writing desk, console table, vanity, side table, study desk, writing table, school table, reading desk, "
        "entrance table, drawer table, hall table, dressing table, vanity table, console table with drawers, desk with "
        "drawers"
    ),
    usual={
        "desk with pedestal, pedestal desk, computer desk, office desk": {
            "arrangement": "pedestal",
            "drawers": 3,
            "width": 1.45,
        },
        "work table, lab bench": {"width": 1.2, "depth": 0.6, "height": 0.75},
        "sofa table, tea table": {"width": 1.1, "depth": 0.6, "height": 0.5},
        "hallway table, entry table, sewing table, potting bench": {"width": 1, "depth": 0.4, "height": 0.8},
        "school desk, chess table, occasional table": {"width": 0.7, "depth": 0.5, "height": 0.7},
        (
            "kitchen table, breakfast table, lab table, laboratory table, packing table, prep table, laboratory bench, "
            "carpenter bench, woodworking bench, workshop bench, tool bench, work bench"
        ): {"width": 1.6, "depth": 0.8, "height": 0.75},
        (
            "gaming desk, student desk, art desk, craft table, sewing desk, teacher desk, kids desk, children desk, "
            "kids table, reception table, nail table, makeup table, bathroom table"
        ): {"width": 1.2, "depth": 0.6, "height": 0.75},
    },
    title="table or desk with drawers",
    carved_from="wood",
    width=length(0.4, 4.0, default=1.2, usual=(0.8, 1.8), help="Outer width."),
    depth=length(0.3, 2.0, default=0.6, usual=(0.45, 0.8), help="Outer depth."),
    height=length(0.5, 1.5, default=0.74, usual=(0.65, 0.95), help="Outer height."),
    top=length(0.01, 0.06, default=0.025, usual=(0.018, 0.045), help="Thickness of the top."),
    drawers=whole(1, 5, default=2, usual=(1, 4), help="Drawers."),
    arrangement=choice(
        {"row": "side by side, in a row, next to each other", "pedestal": "stacked"},
        help="Drawers side by side under the top, or stacked at the right.",
    ),
    layout=choice((), help="Any other arrangement, e.g. '2*drawer | drawer | 2*drawer'; overrides the counts."),
    handle=choice(("bar", "knob", "cup", "edge", "none"), help="What drawers are pulled by."),
)
def table(
    w: ObjectBuilder,
    width: float,
    depth: float,
    height: float,
    top: float,
    drawers: int,
    arrangement: str,
    layout: str,
    handle: str,
    open: float,
) -> None:
    """Tables and desks with drawers: a row under the top, pedestals of stacked drawers at the sides, or both."""
    overhang = 0.03  # of the top on all sides [m]
    leg = 0.05  # [m]

    # How many drawers each stack has, from left to right.
    def columns() -> Sequence[int]:
        row = [1] * drawers if arrangement == "row" else [drawers]
        return drawer_stacks(layout) if layout else row

    # Several drawers reach down to the floor, a single one hangs under the top.
    def stack_of(across: tuple[float, float], count: int, under: float) -> Sequence[tuple[float, float, float, float]]:
        if count <= 1:
            found = [(*across, under - min(max(0.16 * under, 0.09), 0.2), under)] * count
        else:
            pitch = (under - leg) / count
            found = [
                (*across, under - (k + 1) * pitch if k + 1 < count else leg, under - k * pitch) for k in range(count)
            ]
        return found

    # Fields of the drawers, from left to right, and in each stack from the top down.
    def stacks_of(half: float, under: float) -> list[Sequence[tuple[float, float, float, float]]]:
        counts = columns()
        last = len(counts) - 1
        narrow = min(0.45, 1.6 * half / max(len(counts), 2))
        stacks: list[Sequence[tuple[float, float, float, float]]] = []
        for k, number in enumerate(counts):
            if max(counts) == 1:
                left = -half + 2.0 * half * k / len(counts)
                right = -half + 2.0 * half * (k + 1) / len(counts)
            elif k in (0, last):
                left, right = (half - narrow, half) if k == last else (-half, narrow - half)
            else:
                share = 2.0 * (half - narrow) / (last - 1)
                left = narrow - half + (k - 1) * share
                right = narrow - half + k * share
            stacks = [*stacks, stack_of((left, right), number, under)]
        return [stack for stack in stacks if stack]

    def opening_of(span: tuple[float, float, float, float], back: float) -> Bay:
        left, right, bottom, top = span
        wall = min(0.018, 0.15 * (top - bottom))
        return Bay(left=left, right=right, bottom=bottom, top=top, depth=back, wall=wall)

    def leg_of(x: float, y: float, height: float) -> Manifold:
        return box((x, y, 0), (x + leg, y + leg, height))

    under = height - top
    half = 0.5 * width - overhang
    back = depth - 2.0 * overhang
    stacks = stacks_of(half, under)
    openings = [opening_of(span, back) for stack in stacks for span in stack]
    body = union(
        slab(0.5 * width, (-overhang, depth - overhang), (under, height)),
        *[box((stack[0][0], 0, stack[-1][2]), (stack[0][1], back, under)) for stack in stacks],
        slab(half, (back - 0.02, back), (under - 0.08, under)),
        *[leg_of(x, y, under) for x in (-half, half - leg) for y in (0.0, back - leg)],
    )
    w.part("body", body - union(*[room(opening) for opening in openings]))
    for k, opening in enumerate(openings):
        add_drawer(w, f"drawer_{k + 1}", "body", opening, handle=handle, opened=open)
    w.settle()


@kind(
    words=(
        "foldable chair, camping chair, collapsible chair, garden chair, lawn chair, patio chair, fishing chair, "
        "picnic chair, folding seat"
    ),
    carved_from="wood",
    width=length(0.3, 0.7, default=0.44, usual=(0.38, 0.5), help="Outer width."),
    height=length(0.7, 1.2, default=0.84, usual=(0.76, 0.95), help="When folded."),
    seat=length(0.3, 0.5, default=0.44, usual=(0.4, 0.47), help="Level of the seat."),
    depth=length(0.2, 0.42, default=0.35, usual=(0.3, 0.4), help="Of the seat."),
    rail=length(0.022, 0.045, default=0.028, usual=(0.024, 0.034), help="Of the bars."),
    slats=whole(1, 6, usual=(1, 4), help="Of the back.", words="slat"),
    boards=whole(1, 8, usual=(1, 6), help="Of the seat.", words="board"),
)
def folding_chair(
    w: ObjectBuilder,
    width: float,
    height: float,
    seat: float,
    depth: float,
    rail: float,
    slats: int,
    boards: int,
    open: float,
    clearance: float,
) -> None:
    """Folding chairs: a frame with a back, legs and a seat that fold into it. Zero is folded flat."""
    board = 0.014  # thickness of the slats [m]
    pin = 0.004  # radius [m]
    the_legs = 0.75  # how far the rear legs swing back [rad]

    # An upright bar between two x, about the plane y = 0.
    def between(one: float, other: float, thick: float, low: float, high: float) -> Manifold:
        x0, x1 = sorted((one, other))
        return slab((x0, x1), thick, (low, high))

    # Half the width of what moves between the sides [m].
    inner = 0.5 * width - rail - clearance
    # Half the thickness of what folds into the frame, before its slats and behind its tie [m].
    the_half = 0.5 * rail - 0.0015 - clearance

    # Hang a body on an axle through both sides of the frame.
    def hang_of(name: str, solids: Sequence[Manifold], level: float, opens: float) -> None:
        end = 0.5 * width - 0.35 * rail
        w.cut("frame", bore(pin, clearance, (-end - clearance, 0, level), (end + clearance, 0, level)))
        w.part(f"{name}", solids, cylinder(pin, (-end, end), 0, level))
        w.hinge(f"{name}", "frame", (1, 0, 0), (0, 0, level), opens, rest=open * opens)

    half = 0.5 * width
    thick = 0.5 * rail
    sides = [between(s * half, s * (half - rail), thick, 0.0, height) for s in (-1, 1)]
    wide = half - 0.5 * rail
    pitch = (height - seat - 0.12) / slats
    its_slats: list[Manifold] = []
    for k in range(slats):
        low = height - (k + 1) * pitch
        its_slats = [*its_slats, slab(wide, (thick - 0.001, thick + board), (low + 0.15 * pitch, low + pitch))]
    tie = slab(wide, (-thick - board, 0.001 - thick), (0.1, 0.13))
    w.part("frame", sides, its_slats, tie)
    # Rear legs between the sides of the frame; they swing back.
    thick_2 = the_half
    pivot = seat - 0.5 * rail - 0.025
    legs = [between(s * inner, s * (inner - rail), thick_2, 0.0, pivot) for s in (-1, 1)]
    legs = legs + [cylinder(thick_2, (s * inner, s * (inner - rail)), 0, pivot) for s in (-1, 1)]
    legs = legs + [between(-inner, inner, 0.5 * thick_2, z, z + 0.025) for z in (0.06, 0.7 * pivot)]
    hang_of("legs", solids=legs, level=pivot, opens=the_legs)
    # A seat that stands up before the back and comes down to the front.
    half_2 = the_half
    pitch_2 = depth / boards
    its_seat = [
        between(-inner, inner, half_2, seat + k * pitch_2 + 0.012, seat + (k + 1) * pitch_2) for k in range(boards)
    ]
    for s in (-1, 1):
        its_seat = [*its_seat, cylinder(half_2, (s * inner, s * (inner - 0.03)), 0, seat)]
        its_seat = [*its_seat, between(s * inner, s * (inner - 0.03), half_2, seat, seat + depth)]
    hang_of("seat", solids=its_seat, level=seat, opens=0.5 * pi)
    w.settle()


@kind(
    words=(
        "swivel chair, desk chair, computer chair, chair, task chair, gaming chair, drafting chair, "
        "conference chair, executive chair, student chair, revolving chair, spinning chair"
    ),
    castors=whole(
        3, 6, default=5, usual=(4, 6), help="Each turns and has a wheel.", words="castor, caster, wheel, roller, leg"
    ),
    width=length(0.36, 0.7, default=0.48, usual=(0.44, 0.54), help="Of the seat."),
    depth=length(0.36, 0.65, default=0.46, usual=(0.42, 0.5), help="Of the seat."),
    back=length(0.2, 0.9, default=0.5, usual=(0.35, 0.65), help="Its height."),
    column=length(0.12, 0.4, default=0.2, usual=(0.16, 0.26), help="Its height."),
    star=length(0.22, 0.42, default=0.3, usual=(0.26, 0.34), help="Length of an arm."),
    wheel=length(0.02, 0.045, default=0.028, usual=(0.022, 0.034), help="Radius."),
    armrests=choice({"armrests": "armrest, arm", "none": "armless"}, help="Beside the seat."),
    carved_from="plastic",
)
def office_chair(
    w: ObjectBuilder,
    castors: int,
    width: float,
    depth: float,
    back: float,
    column: float,
    star: float,
    wheel: float,
    armrests: str,
    open: float,
    clearance: float,
) -> None:
    """Office chairs: a star with castors, a gas spring, a seat that turns and a backrest that leans."""
    the_column = 0.026  # radius of the tube around the gas spring [m]
    the_spring = 0.014  # radius of the gas spring [m]
    sides = 8  # of the gas spring
    seat = 0.065  # thickness of the cushion [m]
    fork = (0.07, 0.016)  # width and radius of the backrest's hinge [m]

    # A rod that rises in the column, of eight sides that it may not turn; returns the level of what turns on
    # it.
    def spring(level: float, rim: float) -> float:
        top = rim + 0.012
        travel = min(0.1, 0.5 * column)
        w.cut("base", bore(the_spring, clearance, (0, 0, level + 0.01), (0, 0, rim + 0.1), segments=sides))
        boss, hole, rotor = stub((0, 0, top + 0.022), (0, 0, 1), 0.032, clearance, length=0.022)
        rod_ = cylinder(the_spring, level + 0.014, top + 0.001, segments=sides)
        w.part("lift", rod_, boss, look="steel")
        w.cut("lift", hole)
        w.slide("lift", "base", (0, 0, 1), travel, pivot=(0, 0, rim), rest=open * travel)
        w.part("seat", rotor)
        w.spin("seat", "lift", (0, 0, 1), (0, 0, top + 0.022))
        return top + 0.044 + clearance

    # A bow beside the cushion with a pad on it.
    def armrest(x: float, level: float) -> Sequence[Manifold]:
        low = level + 0.03
        high = level + seat + 0.19
        inner = -0.06 if x > 0 else 0.06
        return [
            rod(0.012, (x + inner, x), 0.0, low),
            rod(0.012, x, 0.0, (low, high)),
            hull(rod(0.018, x, (-0.11, 0.1), high), rod(0.018, x, (-0.11, 0.1), high + 0.01)),
        ]

    level = wheel / 0.38
    its_column = level + column
    hub = cylinder(0.04, level - 0.005, level + 0.05)
    w.part("base", hub, cylinder(the_column, level, its_column))
    for k in range(castors):
        # An arm of the star; under its end a fork on a stem that turns, and in the fork a wheel.
        number = k + 1
        angle = 2.0 * pi * k / castors
        cosine = cos(angle)
        sine = sin(angle)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        place = at(turn @ (0.0, -star, 0.0), turn)
        arm = hull(
            cylinder(0.022, 0, star, (level, level + 0.045), segments=24),
            cylinder(0.016, level, level + 0.03, segments=24),
        )
        w.part("base", arm.transform(place))
        seen = w.from_frame(place)
        with seen.fitted() as b:
            caster(b, f"wheel_{number}", "base", (0, 0, level), level, fork=f"castor_{number}", deep=0.022)
    # A cushion on a plate, and behind it a bracket with the backrest.
    level_2 = spring(level, its_column)
    behind = 0.5 * depth + 0.05
    places = [(sx * (0.5 * width - 0.05), sy * (0.5 * depth - 0.05)) for sx in (-1, 1) for sy in (-1, 1)]
    cushion = [cylinder(0.05, (*xy, level_2 + 0.02), (*xy, level_2 + seat), segments=24) for xy in places]
    plate = slab(0.1, 0.12, (level_2 - 0.01, level_2 + 0.021))
    bracket = slab(0.03, (0.1, behind + fork[1]), (level_2 - 0.01, level_2 + 0.012))
    pivot = (0.0, behind, level_2 + 0.012 + 2.0 * fork[1])
    forked, tongue = bent_fork(pivot, (0.0, 0.0), fork[0], fork[1], clearance)
    w.part("seat", plate, bracket, forked, hull(*cushion))
    if armrests == "armrests":
        w.part("seat", [solid for s in (-1, 1) for solid in armrest(s * (0.5 * width + 0.02), level_2)])
    low = level_2 + seat + 0.05
    rail = slab(0.025, (behind - 0.01, behind + 0.01), (pivot[2] + 0.02, low + 0.5 * back))
    wide = 0.5 * width - 0.05
    rest = [
        rod(0.02, (s * wide, behind - 0.015, z), (0.6 * s * wide, behind + 0.002, z))
        for s in (-1, 1)
        for z in (low + 0.02, low + back - 0.02)
    ]
    w.part("back", tongue, rail, hull(*rest))
    w.hinge("back", "seat", (-1, 0, 0), pivot, 0.45, rest=open * 0.45)
    w.settle()
