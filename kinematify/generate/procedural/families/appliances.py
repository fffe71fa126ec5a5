"""Large appliances, each a body with doors: ovens, microwave ovens, fridges, washers and safes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.pieces.bearings import barrel, stub
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_button, add_knob, grid
from kinematify.generate.procedural.pieces.fronts import Bay, Fitting, add_door, add_drawer, add_flap, carcass, room
from kinematify.generate.procedural.solids import bore, box, cylinder, rod, tray, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop


_OVEN_WALL = 0.04  # of a dishwasher, too [m]
_PLINTH = 0.1  # below the door, so that its handle does not reach the floor [m]


def build_oven(values: Values, workshop: Workshop) -> None:
    """Ovens and stoves: a door that falls open, and knobs above it."""
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance, rest = values.number("clearance"), values.number("open")
    strip = min(0.12, max(0.07, 0.14 * height))
    opening = Bay(
        left=-0.5 * width, right=0.5 * width, bottom=_PLINTH, top=height - strip, depth=depth, wall=_OVEN_WALL
    )
    workshop.body("body", carcass(width, height, depth, [opening]), *_grate(opening))
    if values.choice("top") == "burners":
        workshop.cut("body", *_burners(width, depth, height))
    fitting = Fitting(clearance=clearance, grip=values.choice("handle"), rest=rest)
    add_flap(workshop, "door", "body", opening, fitting, hinge=values.choice("hinge"))
    workshop.cut("door", _window(opening, clearance))
    knobs = values.count("knobs")
    for k in range(knobs):
        x = ((k + 0.5) / knobs - 0.5) * 0.9 * width
        mount = Mount(
            parent="body", place=(x, 0, height - 0.5 * strip), face=FRONT, clearance=clearance, depth=0.5 * strip
        )
        add_knob(workshop, f"knob_{k + 1}", mount, min(0.3 * strip, 0.35 * width / knobs), rest=rest)


def _grate(opening: Bay) -> list[Manifold]:
    """A grate of bars from wall to wall in the middle of the room."""
    level, inner = 0.5 * (opening.bottom + opening.top), 0.5 * _OVEN_WALL - 1e-3
    first, last = 0.04, opening.depth - _OVEN_WALL - 0.02
    return [
        box((opening.left + inner, y, level), (opening.right - inner, y + 0.006, level + 0.006))
        for y in (first + k / 6.0 * (last - first) for k in range(7))
    ]


def _burners(width: float, depth: float, height: float) -> list[Manifold]:
    """Ring-shaped grooves in the top."""
    rings = []
    for x, y, share in ((-1, 0.28, 0.13), (1, 0.28, 0.17), (-1, 0.72, 0.17), (1, 0.72, 0.13)):
        radius, centre = share * min(width, depth), (0.24 * x * width, y * depth)
        disc = cylinder(radius, (*centre, height - 0.002), (*centre, height + 0.01))
        rings.append(disc - cylinder(radius - 0.004, (*centre, height - 0.01), (*centre, height + 0.02)))
    return rings


def _window(opening: Bay, clearance: float) -> Manifold:
    """A shallow recess in the door's front where the glass is."""
    front = -clearance - _OVEN_WALL
    margin = 0.15 * min(opening.width, opening.height)
    return box(
        (opening.left + margin, front - 0.01, opening.bottom + margin),
        (opening.right - margin, front + 0.003, opening.top - 0.3 * opening.height),
    )


_MICROWAVE_WALL = 0.03
_PANEL = 0.26  # share of the width that the control panel takes


def build_microwave(values: Values, workshop: Workshop) -> None:
    """Microwave ovens: a door at the left, a control panel at the right, and a turntable inside."""
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance = values.number("clearance")
    border = (0.5 - _PANEL) * width
    behind = depth - _MICROWAVE_WALL - clearance  # the panel stands out as far as the door
    opening = Bay(left=-0.5 * width, right=border, bottom=0.0, top=height, depth=behind, wall=_MICROWAVE_WALL)
    panel = box((border + 0.002, -_MICROWAVE_WALL - clearance, 0), (0.5 * width, 1e-3, height))
    workshop.body("body", carcass(width, height, behind, [opening]), panel)
    fitting = Fitting(clearance=clearance, grip=values.choice("handle"), rest=values.number("open"))
    add_door(workshop, "door", "body", opening, fitting, side="left", outermost=True, hinge=values.choice("hinge"))
    margin, front = 0.15 * opening.width, -clearance - _MICROWAVE_WALL
    recess = box((opening.left + margin, -1.0, margin), (border - 1.2 * margin, front + 0.003, height - margin))
    workshop.cut("door", recess)
    _add_turntable(workshop, opening, clearance)
    _add_microwave_controls(values, workshop, 0.5 * (border + 0.5 * width), front)


def _add_turntable(workshop: Workshop, opening: Bay, clearance: float) -> None:
    """A glass plate with a rim on a shaft in the floor."""
    radius = 0.44 * min(opening.width - _MICROWAVE_WALL, opening.depth - _MICROWAVE_WALL)
    floor, centre = (
        0.5 * _MICROWAVE_WALL,
        (0.5 * (opening.left + opening.right), 0.5 * (opening.depth - _MICROWAVE_WALL)),
    )
    pivot = (*centre, floor + 0.006)
    boss, hole, rotor = stub(pivot, (0, 0, 1), 0.015, clearance, length=0.012)
    workshop.add("body", boss)
    workshop.cut("body", hole)
    level = pivot[2] + 0.011 + clearance  # the plate's bottom is one with the flange
    plate = cylinder(radius, (*centre, level), (*centre, level + 0.012))
    hollow = cylinder(radius - 0.006, (*centre, level + 0.005), (*centre, level + 0.02))
    workshop.body("turntable", rotor, plate - hollow, material="glass")
    workshop.turns("turntable", "body", (0, 0, 1), pivot)


def _add_microwave_controls(values: Values, workshop: Workshop, x: float, front: float) -> None:
    """Knobs above buttons, in the middle of the panel."""
    width, height = _PANEL * values.number("width"), values.number("height")
    clearance, rest = values.number("clearance"), values.number("open")
    knobs, buttons = values.count("knobs"), values.count("buttons")
    border = 0.55 * height if knobs else 0.85 * height

    def mount(u: float, z: float) -> Mount:
        return Mount(parent="body", place=(x + u, front, z), face=FRONT, clearance=clearance, depth=0.02)

    for k in range(knobs):
        radius = min(0.3 * width, 0.3 * height / knobs)
        z = border + (knobs - k - 0.5) * (0.95 * height - border) / knobs
        add_knob(workshop, f"knob_{k + 1}", mount(0.0, z), min(radius, 0.17 * height / knobs), rest=rest)
    columns, rows = (3, -(-buttons // 3)) if buttons > 3 else (1, max(1, buttons))
    size = (0.8 * width, border - 0.1 * height)
    pitch = min(size[0] / columns, 0.03), min(size[1] / rows, 0.03)
    area = (pitch[0] * columns, pitch[1] * rows)
    middle = 0.05 * height + 0.5 * size[1]
    for k, (u, v) in enumerate(grid(buttons, columns, area)):
        cap = (0.9 * pitch[0] - 2 * clearance - 0.002, 0.9 * pitch[1] - 2 * clearance - 0.002)
        add_button(workshop, f"button_{k + 1}", mount(u, middle + v), cap, travel=0.002)


_ARM = 0.07  # height that the spray arm needs above the floor of the room [m]
_RAIL = 0.012


def build_dishwasher(values: Values, workshop: Workshop) -> None:
    """Dishwashers: a door that falls open, racks on rails and a spray arm inside."""
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance, rest = values.number("clearance"), values.number("open")
    opening = Bay(left=-0.5 * width, right=0.5 * width, bottom=_PLINTH, top=height, depth=depth, wall=_OVEN_WALL)
    workshop.body("body", carcass(width, height, depth, [opening]))
    fitting = Fitting(clearance=clearance, grip=values.choice("handle"), rest=rest)
    add_flap(workshop, "door", "body", opening, fitting, hinge=values.choice("hinge"))
    _add_buttons(values, workshop, opening)
    _add_spray_arm(workshop, opening, clearance)
    _add_racks(values, workshop, opening)


def _add_buttons(values: Values, workshop: Workshop, opening: Bay) -> None:
    """A row of buttons at the upper edge of the door, above its handle."""
    count, clearance = values.count("buttons"), values.number("clearance")
    for k in range(count):
        x = (k - 0.5 * (count - 1)) * 0.03
        place = (x, -clearance - _OVEN_WALL, opening.top - 0.012)
        mount = Mount(parent="door", place=place, face=FRONT, clearance=clearance, depth=0.02)
        add_button(workshop, f"button_{k + 1}", mount, (0.018, 0.01), travel=0.002)


def _add_spray_arm(workshop: Workshop, opening: Bay, clearance: float) -> None:
    floor, middle = opening.bottom + 0.5 * _OVEN_WALL, 0.5 * (opening.depth - _OVEN_WALL)
    pivot = (0.0, middle, floor + 0.02)
    boss, hole, rotor = stub(pivot, (0, 0, 1), 0.015, clearance, length=0.022)
    workshop.add("body", boss)
    workshop.cut("body", hole)
    half = 0.42 * min(opening.width - _OVEN_WALL, opening.depth - _OVEN_WALL)
    level = pivot[2] + clearance + 0.012
    blade = box((-half, middle - 0.02, level), (half, middle + 0.02, level + 0.01))
    workshop.body("spray_arm", rotor, blade)
    workshop.turns("spray_arm", "body", (0, 0, 1), pivot)


def _add_racks(values: Values, workshop: Workshop, opening: Bay) -> None:
    """Baskets on rails at both walls; they come forward as far as the closed door lets them."""
    count, clearance = values.count("racks"), values.number("clearance")
    half, back = 0.5 * (opening.width - _OVEN_WALL), opening.depth - _OVEN_WALL
    lowest, top = opening.bottom + 0.5 * _OVEN_WALL + _ARM, opening.top - 0.5 * _OVEN_WALL
    pitch, travel = (top - lowest) / count, values.number("reach") * back
    for k in range(count):
        level = lowest + (count - 1 - k) * pitch
        rails = [
            box((x0, 0.01, level), (x1, back + 1e-3, level + _RAIL))
            for x0, x1 in ((-half - 1e-3, -half + 0.02), (half - 0.02, half + 1e-3))
        ]
        workshop.add("body", *rails)
        lower = (-half + 0.004 + clearance, 0.012 + travel, level + _RAIL + clearance)
        upper = (half - 0.004 - clearance, back - clearance, level + 0.75 * pitch)
        workshop.body(f"rack_{k + 1}", _basket(lower, upper), material="steel")
        middle = (0.0, 0.5 * (lower[1] + upper[1]), lower[2])
        workshop.slides(f"rack_{k + 1}", "body", (0, -1, 0), middle, (0.0, travel), rest=values.number("open"))


def _basket(lower: tuple[float, float, float], upper: tuple[float, float, float]) -> Manifold:
    """A tray whose floor has slots."""
    count, wall = 6, 0.006
    pitch = (upper[0] - lower[0] - 0.06) / count
    slots = [
        box(
            (lower[0] + 0.03 + k * pitch, lower[1] + 0.03, lower[2] - 0.01),
            (lower[0] + 0.03 + (k + 0.6) * pitch, upper[1] - 0.03, lower[2] + 0.02),
        )
        for k in range(count)
    ]
    return tray(lower, upper, wall) - union(*slots)


_FRIDGE_WALL = 0.05  # a door's thickness; walls of the body are half as thick, between two rooms as thick [m]
_INSET = 0.06  # of a bin from the room's sides, so that it swings out of the room [m]
_BIN = 0.07  # depth of a bin [m]
_PITCH = 0.3  # between shelves [m]


def build_fridge(values: Values, workshop: Workshop) -> None:
    """Refrigerators: thick doors with bins inside, one above the other or side by side."""
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    fields = _fields(values.count("doors"), values.choice("freezer"))
    openings = [
        Bay(
            left=(left - 0.5) * width,
            right=(right - 0.5) * width,
            bottom=bottom * height,
            top=top * height,
            depth=depth,
            wall=_FRIDGE_WALL,
        )
        for left, right, bottom, top in fields
    ]
    shelves = [shelf for opening in openings for shelf in _shelves(opening)]
    workshop.body("body", carcass(width, height, depth, openings), *shelves)
    fitting = Fitting(clearance=values.number("clearance"), grip=values.choice("handle"), rest=values.number("open"))
    for k, (field, opening) in enumerate(zip(fields, openings, strict=True)):
        side = values.choice("hinge_side") if field[1] - field[0] == 1.0 else "left" if field[0] == 0.0 else "right"
        name, hinge = f"door_{k + 1}", values.choice("hinge")
        add_door(workshop, name, "body", opening, fitting, side=side, outermost=True, hinge=hinge)
        workshop.add(name, *_bins(opening, fitting.clearance))


def _fields(doors: int, freezer: str) -> list[tuple[float, float, float, float]]:
    """Left, right, bottom and top of each door as shares of the front."""
    if doors == 1:
        return [(0.0, 1.0, 0.0, 1.0)]
    if doors == 2 and freezer == "side":
        return [(0.0, 0.42, 0.0, 1.0), (0.42, 1.0, 0.0, 1.0)]
    if doors == 2 and freezer == "none":
        return [(0.0, 0.5, 0.0, 1.0), (0.5, 1.0, 0.0, 1.0)]
    low = 0.34 if freezer == "bottom" else 0.66
    halves = ((0.0, 0.5), (0.5, 1.0))
    upper = halves if doors >= 3 and (freezer != "top" or doors == 4) else ((0.0, 1.0),)
    lower = halves if doors == 4 or (doors == 3 and freezer == "top") else ((0.0, 1.0),)
    return [(*span, low, 1.0) for span in upper] + [(*span, 0.0, low) for span in lower]


def _shelves(opening: Bay) -> list[Manifold]:
    """Glass shelves in a room, behind the bins of the door."""
    count = int(opening.height / _PITCH)
    inset, pitch = 0.5 * _FRIDGE_WALL, opening.height / (count + 1)
    levels = [opening.bottom + (k + 1) * pitch for k in range(count)]
    return [
        box((opening.left + inset, _BIN + 0.03, z), (opening.right - inset, opening.depth - inset, z + 0.006))
        for z in levels
    ]


def _bins(opening: Bay, clearance: float) -> list[Manifold]:
    """Bins on the inner side of a door."""
    left, right = opening.left + _INSET, opening.right - _INSET
    count = int(opening.height / _PITCH)
    if right - left < 0.06:
        return []
    pitch = opening.height / (count + 1)
    levels = [opening.bottom + 0.07 + k * pitch for k in range(count)]
    return [tray((left, -clearance - 1e-3, z), (right, _BIN, z + 0.08), 0.004) for z in levels]


_STRIP = 0.14  # height of the strip with the controls [m]
_WASHER_WALL = 0.03
_DOOR = 0.03  # thickness [m]
_HINGE = (0.006, 0.09)  # radius and length of the door's hinge [m]


def build_washing_machine(values: Values, workshop: Workshop) -> None:
    """Washing machines and dryers: a round door, a drum behind it, a detergent drawer, a knob and buttons."""
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    front = box((-0.5 * width, 0, 0), (0.5 * width, depth, height))
    tub = 0.5 * min(width, height - _STRIP) - _WASHER_WALL
    centre = (0.0, 0.5 * (height - _STRIP))
    cavity = cylinder(tub, (0, _WASHER_WALL, centre[1]), (0, depth - _WASHER_WALL, centre[1]))
    mouth = cylinder(0.72 * tub, (0, -1.0, centre[1]), (0, 0.5 * depth, centre[1]))
    workshop.body("body", front - cavity - mouth)
    _add_drum(values, workshop, tub, centre[1])
    _add_door(values, workshop, 0.86 * tub, centre[1])
    _add_washer_controls(values, workshop)


def _add_drum(values: Values, workshop: Workshop, tub: float, level: float) -> None:
    """A drum with three ribs on a shaft in the back wall."""
    clearance, back = values.number("clearance"), values.number("depth") - _WASHER_WALL
    radius = tub - 0.01 - clearance
    start, end = (0, _WASHER_WALL + 0.01, level), (0, back - 0.04, level)
    inner = cylinder(radius - 0.004, (0, 0, level), (0, back - 0.045, level))
    pivot = (0.0, back - 0.02, level)
    boss, hole, rotor = stub(pivot, (0, -1, 0), 0.03, clearance, length=0.022)
    workshop.add("body", boss)
    workshop.cut("body", hole)
    rib = box((-0.012, start[1] + 0.01, level + 0.75 * radius), (0.012, end[1], level + radius - 0.002))
    ribs = [rib.translate((0, 0, -level)).rotate((0, 120 * k, 0)).translate((0, 0, level)) for k in range(3)]
    workshop.body("drum", rotor, cylinder(radius, start, end) - inner, *ribs, material="steel")
    workshop.turns("drum", "body", (0, -1, 0), pivot)


def _add_door(values: Values, workshop: Workshop, radius: float, level: float) -> None:
    """A round door on a barrel hinge beside its rim."""
    clearance = values.number("clearance")
    side = 1.0 if values.choice("hinge_side") == "right" else -1.0
    barrel_radius, length = _HINGE
    back, front = -clearance, -clearance - _DOOR
    pivot = (side * (radius + barrel_radius + clearance), 0.5 * (back + front), level)
    reach = math.hypot(radius, 0.5 * length) - radius + barrel_radius + clearance  # to the rim at the barrel's ends
    on_body = (-0.004, 0.004, -pivot[1] - 1e-3, -pivot[1] + 0.01)
    on_door = (reach, reach + 0.02, -0.4 * _DOOR, 0.4 * _DOOR)
    halves = barrel(length, barrel_radius, clearance, (on_body, on_door))
    of_body, of_door = ((half if side < 0 else half.mirror((1, 0, 0))).translate(pivot) for half in halves)
    workshop.add("body", of_body)
    disc = cylinder(radius, (0, back, level), (0, front, level))
    glass = cylinder(0.7 * radius, (0, front - 1.0, level), (0, front + 0.006, level))
    grip_at = -side * 0.88 * radius
    grip = box((grip_at - 0.01, front - 0.012, level - 0.05), (grip_at + 0.01, front + 1e-3, level + 0.05))
    workshop.body("door", disc - glass, of_door, grip)
    workshop.turns("door", "body", (0, 0, side), pivot, (0.0, 1.9), rest=values.number("open"))


def _add_washer_controls(values: Values, workshop: Workshop) -> None:
    """From left to right: drawer, knob, buttons."""
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance, rest, level = values.number("clearance"), values.number("open"), height - 0.5 * _STRIP
    opening = Bay(
        left=-0.47 * width,
        right=-0.15 * width,
        bottom=height - _STRIP + 0.02,
        top=height - 0.02,
        depth=0.6 * depth,
        wall=0.012,
    )
    workshop.cut("body", room(opening))
    add_drawer(workshop, "drawer", "body", opening, Fitting(clearance=clearance, grip="edge", rest=rest))
    mount = Mount(parent="body", place=(0, 0, level), face=FRONT, clearance=clearance, depth=0.03)
    add_knob(workshop, "knob", mount, min(0.035, 0.1 * width), endless=values.choice("knob") == "endless", rest=rest)
    count = values.count("buttons")
    for k in range(count):
        x = (0.17 + 0.3 * (k + 0.5) / count) * width
        mount = Mount(parent="body", place=(x, 0, level), face=FRONT, clearance=clearance, depth=0.03)
        add_button(workshop, f"button_{k + 1}", mount, (0.2 * width / count - 2 * clearance, 0.014), travel=0.003)


def build_safe(values: Values, workshop: Workshop) -> None:
    """Safes: thick walls, a heavy door with a lever, and a dial or a keypad."""
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance, rest = values.number("clearance"), values.number("open")
    wall = 2.0 * values.number("wall")  # a door is twice as thick as the walls
    opening = Bay(left=-0.5 * width, right=0.5 * width, bottom=0.0, top=height, depth=depth, wall=wall)
    workshop.body("body", carcass(width, height, depth, [opening]))
    fitting = Fitting(clearance=clearance, grip="none", rest=rest)
    add_door(workshop, "door", "body", opening, fitting, side="left", outermost=True, hinge=values.choice("hinge"))
    front, size = -clearance - wall, min(width, height)

    def mount(x: float, z: float) -> Mount:
        return Mount(parent="door", place=(x, front, z), face=FRONT, clearance=clearance, depth=0.7 * wall)

    if values.choice("lock") == "dial":
        add_knob(workshop, "dial", mount(0.0, 0.68 * height), min(0.05, 0.12 * size), endless=True)
    else:
        pad = min(0.12, 0.3 * size)
        for k, (x, z) in enumerate(grid(12, 3, (0.75 * pad, pad))):
            cap = 0.2 * pad - 2 * clearance
            add_button(workshop, f"button_{k + 1}", mount(x, 0.68 * height + z), (cap, 0.9 * cap), travel=0.002)
    _add_lever(values, workshop, mount(0.0, 0.3 * height), min(0.12, 0.22 * size))


def _add_lever(values: Values, workshop: Workshop, mount: Mount, length: float) -> None:
    """A lever or a wheel of three spokes that draws the bolts; its shaft turns in the door."""
    radius, clearance = 0.1 * length, mount.clearance
    workshop.cut("door", mount.placed(bore(radius, clearance, (0, 0, -mount.depth), (0, 0, 1.0))))
    spokes = (90.0, 210.0, 330.0) if values.choice("handle") == "wheel" else (0.0,)
    level = clearance + 0.35 * length
    solids = [
        cylinder(radius, (0, 0, clearance - mount.depth), (0, 0, level)),
        cylinder(1.6 * radius, (0, 0, clearance), (0, 0, clearance + radius)),
    ]
    for angle in spokes:
        x, y = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        reach = (0.9 if len(spokes) > 1 else 1.3) * length
        solids.append(rod(0.7 * radius, (0, 0, level), (x * reach, y * reach, level)))
    workshop.body("handle", *(mount.placed(solid) for solid in solids), material="steel")
    workshop.turns("handle", "door", -mount.outward, mount.place, (0.0, 0.5 * math.pi), rest=values.number("open"))
