"""Ovens, fridges, microwaves, dishwashers, washing machines and toasters, carved."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, pi, sin
from typing import Any

from manifold3d import Manifold

from kinematify.generate.library import mechanisms
from kinematify.generate.library.kind import choice, kind, length, share, whole
from kinematify.generate.library.mechanisms import button, knob, lever
from kinematify.generate.library.panels import add_door, add_drawer
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.layout import grid
from kinematify.generate.procedural.pieces.bearing_pieces import barrel, stub
from kinematify.generate.procedural.pieces.fronts import Bay, carcass, room
from kinematify.generate.procedural.solids import Point, X, Y, Z, box, cylinder, slab, tray, union, vector


@kind(
    words=(
        "stove, cooker, range, kitchen stove, range cooker, gas stove, gas oven, electric stove, cooking range, gas "
        "cooker, kitchen range, gas range, electric oven, electric cooker, gas stove oven, induction stove"
    ),
    title="oven or stove",
    carved_from="metal",
    width=length(0.35, 1.2, default=0.6, usual=(0.5, 0.9), help="Outer width."),
    height=length(0.45, 1.2, default=0.85, usual=(0.6, 0.95), help="Outer height."),
    depth=length(0.35, 0.9, default=0.6, usual=(0.5, 0.65), help="Outer depth of the body."),
    knobs=whole(0, 8, usual=(2, 6), help="Knobs above the door.", words="dial"),
    top=choice({"burners": "cooktop, hob", "plain": "built in"}, help="A cooktop, or a plain top."),
    burners=whole(4, 4, words="burner", drawn=False, help="Rings on the cooktop."),
    handle=choice(("bar", "edge", "cup"), help="What the door is pulled by."),
    hinge=choice(("edge", "barrel"), help="Hidden hinges, or visible ones."),
)
def oven(
    w: ObjectBuilder,
    width: float,
    height: float,
    depth: float,
    knobs: int,
    top: str,
    handle: str,
    hinge: str,
    open: float,
    clearance: float,
) -> None:
    """Ovens and stoves: a door that falls open, and knobs above it."""
    plinth = 0.1  # below the door, so that its handle does not reach the floor [m]
    wall = 0.04  # of a dishwasher, too [m]

    # A grate of bars from wall to wall in the middle of the room.
    def grate(opening: Bay) -> Sequence[Manifold]:
        level = 0.5 * (opening.bottom + opening.top)
        inner = 0.5 * wall - 0.001
        first = 0.04
        last = opening.depth - wall - 0.02
        return [
            box((opening.left + inner, y, level), (opening.right - inner, y + 0.006, level + 0.006))
            for y in [first + k / 6.0 * (last - first) for k in range(7)]
        ]

    # Ring-shaped grooves in the top.
    def burners(width: float, depth: float, height: float) -> Sequence[Manifold]:
        rings: list[Manifold] = []
        for x, y, part in ((-1, 0.28, 0.13), (1, 0.28, 0.17), (-1, 0.72, 0.17), (1, 0.72, 0.13)):
            radius = part * min(width, depth)
            centre = (0.24 * x * width, y * depth)
            disc = cylinder(radius, (*centre, height - 0.002), (*centre, height + 0.01))
            rings = [*rings, disc - cylinder(radius - 0.004, (*centre, height - 0.01), (*centre, height + 0.02))]
        return rings

    # A shallow recess in the door's front where the glass is.
    def window(opening: Bay, clearance: float) -> Manifold:
        front = -clearance - wall
        margin = 0.15 * min(opening.width, opening.height)
        return box(
            (opening.left + margin, front - 0.01, opening.bottom + margin),
            (opening.right - margin, front + 0.003, opening.top - 0.3 * opening.height),
        )

    strip = min(0.12, max(0.07, 0.14 * height))
    opening = Bay(left=-0.5 * width, right=0.5 * width, bottom=plinth, top=height - strip, depth=depth, wall=wall)
    w.part("body", carcass(width, height, depth, [opening]), grate(opening))
    if top == "burners":
        w.cut("body", burners(width, depth, height))
    add_door(w, "door", "body", opening, side="bottom", hinge=hinge, handle=handle, opened=open)
    w.cut("door", window(opening, clearance))
    for k in range(knobs):
        x = ((k + 0.5) / knobs - 0.5) * 0.9 * width
        with w.fitted(open) as b:
            knob(
                b,
                f"knob_{k + 1}",
                "body",
                (x, 0, height - 0.5 * strip),
                min(0.3 * strip, 0.35 * width / knobs),
                -Y,
                reach=4.7,
            )
    w.settle()


@kind(
    words="microwave oven",
    title="microwave oven",
    width=length(0.4, 0.8, default=0.5, usual=(0.42, 0.6), help="Outer width."),
    height=length(0.22, 0.5, default=0.28, usual=(0.25, 0.35), help="Outer height."),
    depth=length(0.25, 0.6, default=0.36, usual=(0.3, 0.45), help="Outer depth."),
    buttons=whole(0, 12, usual=(1, 12), help="On the panel.", words="key"),
    knobs=whole(0, 2, default=0, help="Above the buttons.", words="dial"),
    handle=choice(("bar", "edge", "none"), help="What the door is pulled by."),
    hinge=choice(("edge", "barrel"), help="Hidden hinges, or visible ones."),
    carved_from="plastic",
)
def microwave(
    w: ObjectBuilder,
    width: float,
    height: float,
    depth: float,
    buttons: int,
    knobs: int,
    handle: str,
    hinge: str,
    open: float,
    clearance: float,
) -> None:
    """Microwave ovens: a door at the left, a control panel at the right, and a turntable inside."""
    the_panel = 0.26  # share of the width that the control panel takes
    wall = 0.03
    border = (0.5 - the_panel) * width
    behind = depth - wall - clearance
    opening = Bay(left=-0.5 * width, right=border, bottom=0.0, top=height, depth=behind, wall=wall)
    panel = box((border + 0.002, -wall - clearance, 0), (0.5 * width, 0.001, height))
    w.part("body", carcass(width, height, behind, [opening]), panel)
    add_door(w, "door", "body", opening, side="left", hinge=hinge, handle=handle, opened=open)
    margin = 0.15 * opening.width
    front = -clearance - wall
    recess = box((opening.left + margin, -1.0, margin), (border - 1.2 * margin, front + 0.003, height - margin))
    w.cut("door", recess)
    # A glass plate with a rim on a shaft in the floor.
    radius = 0.44 * min(opening.width - wall, opening.depth - wall)
    floor = 0.5 * wall
    centre = (0.5 * (opening.left + opening.right), 0.5 * (opening.depth - wall))
    pivot = (*centre, floor + 0.006)
    boss, hole, rotor = stub(pivot, (0, 0, 1), 0.015, clearance, length=0.012)
    w.part("body", boss)
    w.cut("body", hole)
    level = pivot[2] + 0.011 + clearance
    plate = cylinder(radius, (*centre, level), (*centre, level + 0.012))
    hollow = cylinder(radius - 0.006, (*centre, level + 0.005), (*centre, level + 0.02))
    w.part("turntable", rotor, plate - hollow, look="glass")
    w.spin("turntable", "body", (0, 0, 1), pivot)
    # Knobs above buttons, in the middle of the panel.
    its_width = the_panel * width
    border_2 = 0.55 * height if knobs else 0.85 * height
    x = 0.5 * (border + 0.5 * width)
    for k in range(knobs):
        radius_2 = min(0.3 * its_width, 0.3 * height / knobs)
        z = border_2 + (knobs - k - 0.5) * (0.95 * height - border_2) / knobs
        with w.fitted(open) as b:
            knob(b, f"knob_{k + 1}", "body", (x, front, z), min(radius_2, 0.17 * height / knobs), -Y, reach=4.7)
    columns, rows = (3, -(-buttons // 3)) if buttons > 3 else (1, max(1, buttons))
    size = (0.8 * its_width, border_2 - 0.1 * height)
    pitch = (min(size[0] / columns, 0.03), min(size[1] / rows, 0.03))
    area = (pitch[0] * columns, pitch[1] * rows)
    middle = 0.05 * height + 0.5 * size[1]
    for k, (u, v) in enumerate(grid(buttons, columns, area)):
        cap = (0.9 * pitch[0] - 2 * clearance - 0.002, 0.9 * pitch[1] - 2 * clearance - 0.002)
        with w.fitted() as b:
            button(b, f"button_{k + 1}", "body", (x + u, front, middle + v), cap, 0.003, -Y)
    w.settle()


@kind(
    words="dish washing machine",
    carved_from="metal",
    width=length(0.4, 1.0, default=0.6, usual=(0.45, 0.62), help="Outer width."),
    height=length(0.6, 1.1, default=0.82, usual=(0.7, 0.88), help="Outer height."),
    depth=length(0.4, 0.8, default=0.58, usual=(0.5, 0.62), help="Outer depth of the body."),
    racks=whole(1, 3, help="Racks inside.", words="basket, dish rack"),
    reach=share(
        0.1, 0.5, usual=(0.2, 0.4), help="Way of the racks behind the closed door, as a share of the room's depth."
    ),
    buttons=whole(0, 6, default=0, usual=(0, 5), help="Above the handle.", words="key"),
    handle=choice(("bar", "cup", "edge"), help="What the door is pulled by."),
    hinge=choice(("edge", "barrel"), help="Hidden hinges, or visible ones."),
)
def dishwasher(
    w: ObjectBuilder,
    width: float,
    height: float,
    depth: float,
    racks: int,
    reach: float,
    buttons: int,
    handle: str,
    hinge: str,
    open: float,
    clearance: float,
) -> None:
    """Dishwashers: a door that falls open, racks on rails and a spray arm inside."""
    plinth = 0.1  # below the door, so that its handle does not reach the floor [m]
    the_wall = 0.04  # of a dishwasher, too [m]
    arm = 0.07  # height that the spray arm needs above the floor of the room [m]
    rail = 0.012

    # A tray whose floor has slots.
    def basket(lower: Point, upper: Point) -> Manifold:
        count = 6
        wall = 0.006
        pitch = (upper[0] - lower[0] - 0.06) / count
        slots = [
            box(
                (lower[0] + 0.03 + k * pitch, lower[1] + 0.03, lower[2] - 0.01),
                (lower[0] + 0.03 + (k + 0.6) * pitch, upper[1] - 0.03, lower[2] + 0.02),
            )
            for k in range(count)
        ]
        return tray(lower, upper, wall) - union(*slots)

    opening = Bay(left=-0.5 * width, right=0.5 * width, bottom=plinth, top=height, depth=depth, wall=the_wall)
    w.part("body", carcass(width, height, depth, [opening]))
    add_door(w, "door", "body", opening, side="bottom", hinge=hinge, handle=handle, opened=open)
    # A row of buttons at the upper edge of the door, above its handle.
    for k in range(buttons):
        x = (k - 0.5 * (buttons - 1)) * 0.03
        with w.fitted() as b:
            button(
                b, f"button_{k + 1}", "door", (x, -clearance - the_wall, opening.top - 0.012), (0.018, 0.01), 0.003, -Y
            )
    floor = opening.bottom + 0.5 * the_wall
    middle = 0.5 * (opening.depth - the_wall)
    pivot = (0.0, middle, floor + 0.02)
    boss, hole, rotor = stub(pivot, (0, 0, 1), 0.015, clearance, length=0.022)
    w.part("body", boss)
    w.cut("body", hole)
    half = 0.42 * min(opening.width - the_wall, opening.depth - the_wall)
    level = pivot[2] + clearance + 0.012
    blade = slab(half, (middle - 0.02, middle + 0.02), (level, level + 0.01))
    w.part("spray_arm", rotor, blade)
    w.spin("spray_arm", "body", (0, 0, 1), pivot)
    # Baskets on rails at both walls; they come forward as far as the closed door lets them.
    half_2 = 0.5 * (opening.width - the_wall)
    back = opening.depth - the_wall
    lowest = opening.bottom + 0.5 * the_wall + arm
    top = opening.top - 0.5 * the_wall
    pitch = (top - lowest) / racks
    travel = reach * back
    for k_2 in range(racks):
        level_2 = lowest + (racks - 1 - k_2) * pitch
        rails = [
            box((x0, 0.01, level_2), (x1, back + 0.001, level_2 + rail))
            for x0, x1 in ((-half_2 - 0.001, -half_2 + 0.02), (half_2 - 0.02, half_2 + 0.001))
        ]
        w.part("body", rails)
        lower = (-half_2 + 0.004 + clearance, 0.012 + travel, level_2 + rail + clearance)
        upper = (half_2 - 0.004 - clearance, back - clearance, level_2 + 0.75 * pitch)
        w.part(f"rack_{k_2 + 1}", basket(lower, upper), look="steel")
        middle_2 = (0.0, 0.5 * (lower[1] + upper[1]), lower[2])
        w.slide(f"rack_{k_2 + 1}", "body", (0, -1, 0), travel, pivot=middle_2, rest=open * travel)
    w.settle()


@kind(
    words="refrigerator, freezer, fridge freezer, icebox, minibar, mini fridge, kitchen fridge, wine cooler",
    carved_from="metal",
    width=length(0.4, 1.5, default=0.6, usual=(0.55, 0.9), help="Outer width."),
    height=length(0.5, 2.4, default=1.7, usual=(1.3, 2.0), help="Outer height."),
    depth=length(0.35, 1.0, default=0.6, usual=(0.5, 0.7), help="Outer depth of the body."),
    doors=whole(1, 4, help="Doors."),
    drawers=whole(0, 3, default=0, drawn=False, help="Freezer drawers, below doors that are side by side."),
    freezer=choice(
        {
            "top": "freezer on top, freezer above, top freezer, freezer compartment, ice compartment",
            "bottom": "freezer below, freezer at the bottom, bottom freezer",
            "side": "side by side, american",
            "none": "french, without freezer, without a freezer, no freezer",
        },
        help="Where the smaller compartment is; with none, two doors are a pair.",
    ),
    hinge_side=choice(("right", "left"), help="Of doors over the whole width."),
    handle=choice(("bar", "edge", "none"), help="What doors are pulled by."),
    hinge=choice(("edge", "barrel"), help="Hidden hinges, or visible ones."),
)
def fridge(
    w: ObjectBuilder,
    width: float,
    height: float,
    depth: float,
    doors: int,
    drawers: int,
    freezer: str,
    hinge_side: str,
    handle: str,
    hinge: str,
    open: float,
    clearance: float,
) -> None:
    """Refrigerators: thick doors with bins inside, one above the other or side by side."""
    wall = 0.05  # a door's thickness; walls of the body are half as thick, between two rooms as thick [m]
    the_pitch = 0.3  # between shelves [m]
    bin = 0.07  # depth of a bin [m]
    the_inset = 0.06  # of a bin from the room's sides, so that it swings out of the room [m]

    # Left, right, bottom and top of each door as shares of the front.
    def fields_of_(doors: int, freezer: str) -> Sequence[tuple[float, float, float, float]]:
        if drawers:
            low, rows = 0.2 + 0.1 * drawers, (doors + 1) // 2
            found = [(0.0, 1.0, low * k / drawers, low * (k + 1) / drawers) for k in range(drawers)]
            for k in range(doors):
                row, bottom = k // 2, low + (1.0 - low) * (k // 2) / rows
                span = (0.0, 1.0) if k == doors - 1 and doors % 2 else (0.5 * (k % 2), 0.5 * (k % 2) + 0.5)
                found.append((*span, bottom, low + (1.0 - low) * (row + 1) / rows))
        elif doors == 1:
            found = [(0.0, 1.0, 0.0, 1.0)]
        elif doors == 2 and freezer == "side":
            found = [(0.0, 0.42, 0.0, 1.0), (0.42, 1.0, 0.0, 1.0)]
        elif doors == 2 and freezer == "none":
            found = [(0.0, 0.5, 0.0, 1.0), (0.5, 1.0, 0.0, 1.0)]
        else:
            low = 0.34 if freezer == "bottom" else 0.66
            halves = ((0.0, 0.5), (0.5, 1.0))
            upper = halves if doors >= 3 and (freezer != "top" or doors == 4) else ((0.0, 1.0),)
            lower = halves if doors == 4 or (doors == 3 and freezer == "top") else ((0.0, 1.0),)
            found = [(*span, low, 1.0) for span in upper] + [(*span, 0.0, low) for span in lower]
        return found

    # Glass shelves in a room, behind the bins of the door.
    def shelves_of(opening: Bay) -> Sequence[Manifold]:
        count = int(opening.height / the_pitch)
        inset = 0.5 * wall
        pitch = opening.height / (count + 1)
        levels = [opening.bottom + (k + 1) * pitch for k in range(count)]
        return [
            box((opening.left + inset, bin + 0.03, z), (opening.right - inset, opening.depth - inset, z + 0.006))
            for z in levels
        ]

    # Bins on the inner side of a door.
    def bins(opening: Bay, clearance: float) -> Sequence[Manifold]:
        left = opening.left + the_inset
        right = opening.right - the_inset
        count = int(opening.height / the_pitch)
        if right - left < 0.06:
            found: list[Any] = []
        else:
            pitch = opening.height / (count + 1)
            levels = [opening.bottom + 0.07 + k * pitch for k in range(count)]
            found = [tray((left, -clearance - 0.001, z), (right, bin, z + 0.08), 0.004) for z in levels]
        return found

    fields = fields_of_(doors, freezer)
    openings = [
        Bay(
            left=(left - 0.5) * width,
            right=(right - 0.5) * width,
            bottom=bottom * height,
            top=top * height,
            depth=depth,
            wall=wall,
        )
        for left, right, bottom, top in fields
    ]
    shelves = [shelf for opening in openings[drawers:] for shelf in shelves_of(opening)]
    w.part("body", carcass(width, height, depth, openings), shelves)
    for k, opening in enumerate(openings[:drawers]):
        add_drawer(w, f"drawer_{k + 1}", "body", opening, handle=handle, opened=open)
    for k, (field, opening) in enumerate(zip(fields[drawers:], openings[drawers:], strict=True)):
        side = hinge_side if field[1] - field[0] == 1.0 else "left" if field[0] == 0.0 else "right"
        name = f"door_{k + 1}"
        add_door(w, name, "body", opening, side=side, hinge=hinge, handle=handle, opened=open)
        w.part(name, bins(opening, clearance))
    w.settle()


@kind(
    words=(
        "washer, tumble dryer, laundry machine, clothes washer, front loading washer, front loading washing "
        "machine, toy washing machine, laundry washer, clothes dryer, tumble drier"
    ),
    carved_from="metal",
    part_words={"door": "round door, porthole"},
    width=length(0.4, 0.9, default=0.6, usual=(0.5, 0.7), help="Outer width."),
    height=length(0.55, 1.2, default=0.85, usual=(0.75, 0.95), help="Outer height."),
    depth=length(0.35, 0.8, default=0.55, usual=(0.45, 0.65), help="Outer depth of the body."),
    buttons=whole(0, 6, default=4, help="At the right.", words="key"),
    knob=choice(("endless", "stops"), help="Whether the programme knob turns without end."),
    hinge_side=choice(("left", "right"), help="Of the door."),
)
def washing_machine(
    w: ObjectBuilder,
    width: float,
    height: float,
    depth: float,
    buttons: int,
    knob: str,
    hinge_side: str,
    open: float,
    clearance: float,
) -> None:
    """Washing machines and dryers: a round door, a drum behind it, a detergent drawer, a knob and buttons."""
    strip = 0.14  # height of the strip with the controls [m]
    wall = 0.03
    hinge = (0.006, 0.09)  # radius and length of the door's hinge [m]
    door = 0.03  # thickness [m]
    front = slab(0.5 * width, (0, depth), (0, height))
    tub = 0.5 * min(width, height - strip) - wall
    centre = (0.0, 0.5 * (height - strip))
    cavity = cylinder(tub, 0, (wall, depth - wall), centre[1])
    mouth = cylinder(0.72 * tub, 0, (-1.0, 0.5 * depth), centre[1])
    w.part("body", front - cavity - mouth)
    # A drum with three ribs on a shaft in the back wall.
    level = centre[1]
    back = depth - wall
    radius = tub - 0.01 - clearance
    start = (0, wall + 0.01, level)
    end = (0, back - 0.04, level)
    inner = cylinder(radius - 0.004, 0, (0, back - 0.045), level)
    pivot = (0.0, back - 0.02, level)
    boss, hole, rotor = stub(pivot, (0, -1, 0), 0.03, clearance, length=0.022)
    w.part("body", boss)
    w.cut("body", hole)
    rib = slab(0.012, (start[1] + 0.01, end[1]), (level + 0.75 * radius, level + radius - 0.002))
    ribs = [rib.translate((0, 0, -level)).rotate((0, 120 * k, 0)).translate((0, 0, level)) for k in range(3)]
    w.part("drum", rotor, cylinder(radius, start, end) - inner, ribs, look="steel")
    w.spin("drum", "body", (0, -1, 0), pivot)
    # A round door on a barrel hinge beside its rim.
    radius_2 = 0.86 * tub
    level_2 = centre[1]
    side = 1.0 if hinge_side == "right" else -1.0
    barrel_radius, length = hinge
    back_2 = -clearance
    front_2 = -clearance - door
    pivot_2 = (side * (radius_2 + barrel_radius + clearance), 0.5 * (back_2 + front_2), level_2)
    reach = hypot(radius_2, 0.5 * length) - radius_2 + barrel_radius + clearance
    on_body = (-0.004, 0.004, -pivot_2[1] - 0.001, -pivot_2[1] + 0.01)
    on_door = (reach, reach + 0.02, -0.4 * door, 0.4 * door)
    halves = barrel(length, barrel_radius, clearance, (on_body, on_door))
    of_body, of_door = [(half if side < 0 else half.mirror((1, 0, 0))).translate(pivot_2) for half in halves]
    w.part("body", of_body)
    disc = cylinder(radius_2, 0, (back_2, front_2), level_2)
    glass = cylinder(0.7 * radius_2, 0, (front_2 - 1.0, front_2 + 0.006), level_2)
    grip_at = -side * 0.88 * radius_2
    grip = box((grip_at - 0.01, front_2 - 0.012, level_2 - 0.05), (grip_at + 0.01, front_2 + 0.001, level_2 + 0.05))
    w.part("door", disc - glass, of_door, grip)
    w.hinge("door", "body", (0, 0, side), pivot_2, 1.9, rest=open * 1.9)
    # From left to right: drawer, knob, buttons.
    level_3 = height - 0.5 * strip
    opening = Bay(
        left=-0.47 * width,
        right=-0.15 * width,
        bottom=height - strip + 0.02,
        top=height - 0.02,
        depth=0.6 * depth,
        wall=0.012,
    )
    w.cut("body", room(opening))
    add_drawer(w, "drawer", "body", opening, handle="edge", opened=open)
    with w.fitted(open) as b:
        mechanisms.knob(
            b,
            "knob",
            parent="body",
            at=(0, 0, level_3),
            out=-Y,
            radius=min(0.035, 0.1 * width),
            reach=None if knob == "endless" else 4.7,
        )
    for k in range(buttons):
        x = (0.17 + 0.3 * (k + 0.5) / buttons) * width
        with w.fitted() as b:
            button(
                b, f"button_{k + 1}", "body", (x, 0, level_3), (0.2 * width / buttons - 2 * clearance, 0.014), 0.004, -Y
            )
    w.settle()


@kind(
    words=("strongbox, safe box, money safe, bank safe, office safe, home safe, hotel room safe"),
    usual={"gun safe, wall safe, hotel safe": {"width": 0.4, "depth": 0.4, "height": 0.5}},
    carved_from="steel",
    width=length(0.2, 1.2, default=0.35, usual=(0.28, 0.6), help="Outer width."),
    height=length(0.2, 1.8, default=0.4, usual=(0.28, 0.9), help="Outer height."),
    depth=length(0.2, 1.0, default=0.35, usual=(0.25, 0.5), help="Outer depth of the body."),
    wall=length(0.01, 0.035, default=0.015, usual=(0.012, 0.03), help="Of the body."),
    lock=choice(
        {"dial": "combination lock, dial lock, round dial", "keypad": "buttons, key pad, digital lock"},
        help="What it is unlocked by.",
    ),
    handle=choice({"lever": "", "wheel": "spoked handle, hand wheel"}, help="What draws the bolts."),
    hinge=choice(("edge", "barrel"), help="Hidden hinges, or visible ones."),
)
def safe(
    w: ObjectBuilder,
    width: float,
    height: float,
    depth: float,
    wall: float,
    lock: str,
    handle: str,
    hinge: str,
    open: float,
    clearance: float,
) -> None:
    """Safes: thick walls, a heavy door with a lever, and a dial or a keypad."""
    its_wall = 2.0 * wall
    opening = Bay(left=-0.5 * width, right=0.5 * width, bottom=0.0, top=height, depth=depth, wall=its_wall)
    w.part("body", carcass(width, height, depth, [opening]))
    add_door(w, "door", "body", opening, side="left", hinge=hinge, opened=open)
    front = -clearance - its_wall
    size = min(width, height)
    if lock == "dial":
        with w.fitted() as b:
            knob(b, "dial", "door", (0, front, 0.68 * height), min(0.05, 0.12 * size), -Y)
    else:
        pad = min(0.12, 0.3 * size)
        for k, (x, z) in enumerate(grid(12, 3, (0.75 * pad, pad))):
            cap = 0.2 * pad - 2 * clearance
            with w.fitted() as b:
                button(b, f"button_{k + 1}", "door", (x, front, 0.68 * height + z), (cap, 0.9 * cap), 0.003, -Y)
    # A lever or a wheel of three spokes that draws the bolts.
    place = [0, front, 0.3 * height]
    length = min(0.12, 0.22 * size)
    if handle == "wheel":
        with w.fitted() as b:
            at, wire, gap = vector(*place), 0.1 * length, b.gap(length)
            level = at - (gap + 3.0 * wire) * Y
            for angle in (0, 2 * pi / 3, 4 * pi / 3):
                tip = level + length * (cos(angle) * Z + sin(angle) * X)
                b.part("handle", b.rod(0.8 * wire, level, tip), look="metal")
            b.part("handle", b.cylinder(1.5 * wire, at - gap * Y, level))
            b.cut("door", b.cylinder(wire + 1.5 * b.gap(wire), at + 2.0 * wire * Y, at - wire * Y))
            b.part("handle", b.cylinder(wire, at + (2.0 * wire - gap) * Y, at - (gap + 0.2 * wire) * Y))
            b.hinge("handle", "door", Y, at, 0.5 * pi)
    else:
        with w.fitted() as b:
            lever(b, "handle", "door", place, -Y, X, 1.2 * length, reach=-0.5 * pi)
    w.settle()
