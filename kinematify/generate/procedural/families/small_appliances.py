"""Appliances that stand on a table: toasters, coffee machines, fans and lamps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold

from kinematify.generate.procedural.pieces.bearings import BackEdge, add_barrels, at, bent_fork, stub
from kinematify.generate.procedural.pieces.controls import FRONT, TOP, Mount, add_button, add_knob
from kinematify.generate.procedural.pieces.fronts import Bay, Fitting, add_door, add_drawer, room
from kinematify.generate.procedural.solids import ball, box, cylinder, hull, rod, union

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray


_WALL = 0.012
_SHAFT = 0.05  # y where the slots for the bread begin; in front of it is the room of the levers [m]
_FLOOR = 0.034  # underside of the slots [m]
_PLATE = 0.005  # thickness of what carries the bread [m]


def build_toaster(values: Values, workshop: Workshop) -> None:
    """Toasters: levers in front that carry the bread down, knobs, and a crumb tray."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    half, round_ = 0.5 * width, 0.02
    corners = [(s * (half - round_), y) for s in (-1, 1) for y in (round_, depth - round_)]
    workshop.body("body", hull(*(cylinder(round_, (x, y, 0), (x, y, height)) for x, y in corners)))
    share = (width - 2.0 * round_) / values.count("levers")
    for k in range(values.count("levers")):
        middle = (k + 0.5) * share - half + round_
        _add_lever(values, workshop, f"lever_{k + 1}", middle, share)
        if values.choice("knob") == "knob":
            radius = min(0.014, 0.13 * share)
            place = (middle + 0.33 * share, 0.0, 0.3 * height)
            clearance = min(values.number("clearance"), 0.25 * radius)
            mount = Mount(parent="body", place=place, face=FRONT, clearance=clearance, depth=0.8 * _WALL)
            add_knob(workshop, f"knob_{k + 1}", mount, radius, rest=values.number("open"))
    if values.choice("tray") == "tray":
        _add_tray(values, workshop)


def _add_lever(values: Values, workshop: Workshop, name: str, middle: float, share: float) -> None:
    """A lever in an upright slit, one piece with the plates that carry the bread; it moves down."""
    depth, height, count = values.number("depth"), values.number("height"), values.count("slots")
    clearance = values.number("clearance")
    wide = min(0.032, 0.72 * share / count)
    back, slit = depth - 0.03, 0.004
    level = max(0.62 * height, _FLOOR + 0.05)
    low = _FLOOR + clearance + 0.001
    across = 0.5 * count * (wide + 0.01)
    room = box((middle - across, _WALL, _FLOOR), (middle + across, _SHAFT + 1e-3, height - 0.02))
    opening = box((middle - slit - clearance, -1.0, low - 0.002), (middle + slit + clearance, _SHAFT, level + 0.012))
    plates, rooms = [], [room, opening]
    gap = clearance + 0.001
    for k in range(count):
        x = middle + (k - 0.5 * (count - 1)) * (wide + 0.01)
        rooms.append(box((x - 0.5 * wide, _SHAFT, _FLOOR), (x + 0.5 * wide, back, height + 1.0)))
        plates.append(box((x - 0.5 * wide + gap, 0.03, level), (x + 0.5 * wide - gap, back - gap, level + _PLATE)))
    left = middle - 0.5 * (count - 1) * (wide + 0.01) - 0.5 * wide + gap
    bridge = box((left, 0.026, level), (2.0 * middle - left, 0.038, level + _PLATE))
    stem = box((middle - slit, -0.012, level), (middle + slit, 0.03, level + _PLATE))
    grip = min(0.014, 0.16 * share)
    knob = box((middle - grip, -0.028, level - 0.004), (middle + grip, -0.01, level + 0.009))
    workshop.cut("body", union(*rooms))
    workshop.body(name, bridge, stem, knob, *plates)
    workshop.slides(name, "body", (0, 0, -1), (middle, 0, level), (0.0, level - low), rest=values.number("open"))


def _add_tray(values: Values, workshop: Workshop) -> None:
    """A flat tray for crumbs that comes out behind."""
    width, depth, clearance = values.number("width"), values.number("depth"), values.number("clearance")
    half, front = 0.5 * width - 0.03, 0.04
    workshop.cut("body", box((-half, front, 0.008), (half, depth + 1.0, 0.024)))
    gap = clearance
    outer = box((gap - half, front + gap, 0.008 + gap), (half - gap, depth - 0.002, 0.024 - gap))
    inner = box((gap + 0.003 - half, front + gap + 0.003, 0.011 + gap), (half - gap - 0.003, depth - 0.006, 1.0))
    lip = box((-0.2 * half, depth - 0.003, 0.012), (0.2 * half, depth + 0.014, 0.02))
    workshop.body("tray", outer - inner, lip, material="metal")
    travel = 0.7 * (depth - front)
    workshop.slides("tray", "body", (0, 1, 0), (0, depth, 0.016), (0.0, travel), rest=values.number("open"))


_BASE = 0.05  # height of the base [m]
_LID = 0.01  # thickness [m]
_HINGE = 0.004  # radius [m]


def build_coffee_machine(values: Values, workshop: Workshop) -> None:
    """Coffee machines: with a jug under a filter that swings out, or with portafilters and a steam wand."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    head, column = _head(values), 0.6 * depth
    half, top = 0.5 * width, height - _LID
    workshop.body(
        "body",
        box((-half, 0, 0), (half, depth, _BASE)),
        box((-half, column, 0), (half, depth, top)),
        box((-half, 0, head), (half, depth, top)),
    )
    _add_lid(values, workshop)
    if values.choice("kind") == "filter":
        _add_filter(values, workshop)
        _add_jug(values, workshop)
    else:
        _add_espresso(values, workshop)
    _add_buttons(values, workshop)


def _head(values: Values) -> float:
    """Underside of what stands over the jug or the cups [m]."""
    return values.number("height") - max(0.3 * values.number("height"), 0.1)


def _add_lid(values: Values, workshop: Workshop) -> None:
    """A lid over the water tank, hinged behind."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    clearance, half = values.number("clearance"), 0.5 * width
    level, front = height - _LID, 0.6 * depth
    below = level - clearance
    tank = box(
        (_WALL - half, front + _WALL, _BASE + _WALL),
        (half - _WALL, depth - _WALL, height + 1.0),
    )
    above = box((-half - 1.0, -1.0, below), (half + 1.0, depth + 1.0, height + 1.0))
    workshop.cut("body", tank, above)
    lid = box((-half, front, level), (half, depth, height))
    grip = box((-0.1 * width, front - 0.008, level + 0.003), (0.1 * width, front + 0.01, height))
    workshop.body("lid", lid, grip)
    edge = BackEdge(y=depth, level=level, below=0.1, above=_LID, clearance=clearance)
    pivot = add_barrels(workshop, ("body", "lid"), edge, (-0.3 * width, 0.3 * width), length=0.04, radius=_HINGE)
    workshop.turns("lid", "body", (-1, 0, 0), pivot, (0.0, 1.8), rest=values.number("open"))


def _add_filter(values: Values, workshop: Workshop) -> None:
    """A door with the filter's basket behind it; both swing out to the left."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    clearance, head = values.number("clearance"), _head(values)
    opening = Bay(
        left=-0.5 * width,
        right=0.5 * width,
        bottom=head,
        top=height - _LID - clearance,
        depth=0.6 * depth,
        wall=_WALL,
    )
    workshop.cut("body", room(opening))
    fitting = Fitting(clearance=clearance, grip="edge", rest=values.number("open"))
    add_door(workshop, "filter", "body", opening, fitting, side="left", outermost=True, hinge=values.choice("hinge"))
    radius = min(0.22 * width, 0.2 * depth)
    bottom, top = head + _WALL, opening.top - _WALL
    centre = (0.0, radius + 0.012 + clearance)
    cup = cylinder(radius, (*centre, bottom), (*centre, top)) - cylinder(
        radius - 0.003, (*centre, bottom + 0.003), (*centre, top + 1.0)
    )
    arm = box((-0.02, -0.5 * _WALL - clearance, bottom), (0.02, 0.014 + clearance, top))
    workshop.add("filter", cup, arm - cylinder(radius - 0.003, (*centre, bottom + 0.003), (*centre, top + 1.0)))


def _add_jug(values: Values, workshop: Workshop) -> None:
    """A jug on the hot plate, which is drawn out to the front."""
    width, depth, clearance = values.number("width"), values.number("depth"), values.number("clearance")
    radius = min(0.4 * width, 0.26 * depth)
    level = _BASE + clearance
    top = _BASE + 0.8 * (_head(values) - _BASE)
    y = 0.3 * depth
    glass = cylinder(radius, (0, y, level), (0, y, top))
    hollow = cylinder(radius - 0.004, (0, y, level + 0.004), (0, y, top + 1.0))
    reach = y - radius
    grip = union(
        box((-0.008, reach - 0.045, level + 0.2 * (top - level)), (0.008, reach - 0.033, top)),
        *(box((-0.008, reach - 0.04, z), (0.008, y, z + 0.012)) for z in (level + 0.25 * (top - level), top - 0.014)),
    )
    workshop.body("jug", glass - hollow, grip - cylinder(radius - 0.002, (0, y, -1), (0, y, 1)), material="glass")
    travel = (0.0, 0.7 * depth)
    workshop.slides("jug", "body", (0, -1, 0), (0, y, level), travel, rest=values.number("open"))


def _add_espresso(values: Values, workshop: Workshop) -> None:
    """Portafilters that turn in their groups, a steam wand with its knob, and a drip tray."""
    width, depth, clearance = values.number("width"), values.number("depth"), values.number("clearance")
    head, rest, groups = _head(values), values.number("open"), values.count("groups")
    share = 0.8 * width / groups
    radius = min(0.032, 0.3 * share)
    y, reach = 0.3 * depth, radius + 0.09
    turn = min(0.7, math.asin(min(1.0, (share - 0.022) / reach)))  # then a grip meets its neighbour
    for k in range(groups):
        x = (k + 0.5) * share - 0.5 * width
        pivot = (x, y, head - 0.01)
        boss, hole, rotor = stub(pivot, (0, 0, -1), radius, clearance, length=0.022)
        workshop.add("body", boss)
        workshop.cut("body", hole)
        level = pivot[2] - clearance - 0.014
        grip = rod(0.009, (x, y, level), (x, y - reach, level))
        spout = cylinder(0.008, (x, y, level - 0.02), (x, y, level))
        name = f"portafilter_{k + 1}"
        workshop.body(name, rotor, grip, spout)
        workshop.turns(name, "body", (0, 0, -1), pivot, (0.0, turn), rest=rest)
    x = 0.42 * width
    pivot = (x, 0.15 * depth, head - 0.006)
    boss, hole, rotor = stub(pivot, (0, 0, -1), 0.009, clearance, length=0.012)
    workshop.add("body", boss)
    workshop.cut("body", hole)
    start = (*pivot[:2], pivot[2] - clearance - 0.009)
    tip = (x, 0.15 * depth - 0.04, _BASE + 0.35 * (head - _BASE))
    workshop.body("steam_wand", rotor, rod(0.004, start, tip))
    workshop.turns("steam_wand", "body", (0, 0, 1), pivot, (0.0, 0.9), rest=rest)
    opening = Bay(left=-0.5 * width, right=0.5 * width, bottom=0.0, top=_BASE, depth=0.58 * depth, wall=_WALL)
    workshop.cut("body", room(opening))
    add_drawer(workshop, "drip_tray", "body", opening, Fitting(clearance=clearance, grip="edge", rest=rest))
    front = 0.5 * (head + values.number("height") - _LID)
    mount = Mount(parent="body", place=(x, 0, front), face=FRONT, clearance=min(clearance, 0.0015), depth=0.02)
    add_knob(workshop, "knob", mount, min(0.018, 0.07 * width), endless=True)


def _add_buttons(values: Values, workshop: Workshop) -> None:
    """In a row: on the base under a jug, else on the head."""
    width, count, clearance = values.number("width"), values.count("buttons"), values.number("clearance")
    low = values.choice("kind") == "filter"
    level = 0.5 * _BASE if low else 0.5 * (_head(values) + values.number("height") - _LID)
    for k in range(count):
        x = (0.7 * (k + 0.5) / count - (0.35 if low else 0.45)) * width
        mount = Mount(parent="body", place=(x, 0, level), face=FRONT, clearance=clearance, depth=0.015)
        cap = min(0.016, 0.5 * width / count - 2.0 * clearance)
        is_round = values.choice("button") == "round"
        add_button(workshop, f"button_{k + 1}", mount, (cap, cap), travel=0.003, is_round=is_round)


_DOWN = np.diag([1.0, -1.0, -1.0])
_PITCH = 16.0  # of the blades [deg]
_FLANGE = 0.014  # of the rotor [m]
_WIRE = 0.004  # thickness of the cage's rods [m]
_SPOKES = 12
_FORK = (0.036, 0.013)  # width and radius of the hinge that a head tilts on [m]


def build_fan(values: Values, workshop: Workshop) -> None:
    """Fans: blades that turn without end, in a cage on a stand, under a ceiling or in a box."""
    {"stand": _on_stand, "ceiling": _under_ceiling, "box": _in_box}[values.choice("kind")](values, workshop)


# What turns is built about z with its bearing in z = 0, and then brought to its place.


def _blades(values: Values, radius: float) -> tuple[float, float, float]:
    """Width of a blade, the level of its middle, and how far the rotor reaches outwards [m]."""
    clearance = values.number("clearance")
    wide = min(0.5 * radius, 2.4 * radius / values.count("blades"))
    level = 0.006 + 0.5 * wide * math.sin(math.radians(_PITCH)) + clearance
    return wide, level, max(2.0 * level - 0.004, _FLANGE + clearance)


def _add_rotor(values: Values, workshop: Workshop, parent: str, place: FloatArray, radius: float) -> None:
    """Add boss, hole and rotor."""
    clearance, count = values.number("clearance"), values.count("blades")
    hub = min(0.2 * radius, 0.06)
    boss, hole, rotor = stub((0, 0, 0), (0, 0, 1), hub, clearance, length=_FLANGE)
    wide, level, front = _blades(values, radius)
    root, tip = (0.2 * radius, 0.25 * wide), (radius - 0.5 * wide, 0.5 * wide)
    ends = [cylinder(r, (x, 0, -0.0015), (x, 0, 0.0015), segments=24) for x, r in (root, tip)]
    blade = (hull(*ends) + box((0, -root[1], -0.0015), (root[0], root[1], 0.0015))).rotate((_PITCH, 0, 0))
    blades = [blade.translate((0, 0, level)).rotate((0, 0, 360.0 * k / count)) for k in range(count)]
    cap = cylinder(0.9 * hub, (0, 0, clearance + 1e-3), (0, 0, front))
    workshop.add(parent, boss.transform(place))
    workshop.cut(parent, hole.transform(place))
    workshop.body("rotor", union(rotor, cap, *blades).transform(place))
    workshop.turns("rotor", parent, place[:, 2], place[:, 3])


def _cage(radius: float, motor: float, front: float) -> Manifold:
    """Rods behind and before the blades, and a rim around them."""
    outer, back = radius + 0.012, -0.002 - _WIRE
    top = front + 0.008
    rim = cylinder(outer + _WIRE, (0, 0, back), (0, 0, top + _WIRE)) - cylinder(outer, (0, 0, -1), (0, 0, 1))
    rods = []
    for k in range(_SPOKES):
        for start, level in ((0.6 * motor, back), (0.0, top)):
            rod = box((start, -0.5 * _WIRE, level), (outer + 0.5 * _WIRE, 0.5 * _WIRE, level + _WIRE))
            rods.append(rod.rotate((0, 0, 360.0 * k / _SPOKES)))
    rods.append(cylinder(0.7 * motor, (0, 0, top), (0, 0, top + 1.5 * _WIRE)))
    return union(rim, *rods)


def _on_stand(values: Values, workshop: Workshop) -> None:
    """A foot with a post; a yoke that swings on it, and in the yoke a head that tilts."""
    radius, clearance, rest = 0.5 * values.number("diameter"), values.number("clearance"), values.number("open")
    foot, motor = 0.07 + 0.5 * radius, max(0.032, 0.22 * radius)
    lift = motor + 0.028
    axle = max(values.number("height") - radius - 0.016, 1.2 * radius + 0.09, lift + 0.11)  # else it nods onto the foot
    tilt = np.array([0.0, 0.0, axle - lift])
    swing = (0.0, 0.0, tilt[2] - 0.042)
    workshop.body("base", cylinder(foot, (0, 0, 0), (0, 0, 0.025)), cylinder(0.014, (0, 0, 0.02), swing))
    boss, hole, rotor = stub(swing, (0, 0, 1), 0.018, clearance, length=0.015)
    workshop.add("base", boss)
    workshop.cut("base", hole)
    forked, tongue = bent_fork(tilt, (0.0, 0.0), _FORK[0], _FORK[1], clearance)
    workshop.body("yoke", rotor, forked)
    workshop.turns("yoke", "base", (0, 0, 1), swing, (-0.8, 0.8), rest=rest)
    front = -0.5 * radius - 0.03
    housing = cylinder(motor, (0, 0.03, axle), (0, front, axle))
    neck = box((-0.008, -0.01, tilt[2] + 0.015), (0.008, 0.01, axle))
    workshop.body("head", tongue, neck, housing)
    workshop.turns("head", "yoke", (-1, 0, 0), tilt, (-0.3, 0.3), rest=rest)
    place = at((0, front, axle), FRONT)
    _add_rotor(values, workshop, "head", place, radius)
    workshop.add("head", _cage(radius, motor, _blades(values, radius)[2]).transform(place))
    _add_controls(values, workshop, (0.0, -0.6 * foot, 0.025), 0.018)


def _under_ceiling(values: Values, workshop: Workshop) -> None:
    """A canopy, a rod and a motor with the rotor below."""
    radius, height = 0.5 * values.number("span"), values.number("height")
    level = _blades(values, radius)[2] + 0.004
    workshop.body(
        "base",
        cylinder(0.075, (0, 0, height - 0.05), (0, 0, height)),
        cylinder(0.012, (0, 0, level), (0, 0, height - 0.04)),
        cylinder(0.09, (0, 0, level), (0, 0, level + 0.09)),
    )
    _add_rotor(values, workshop, "base", at((0, 0, level), _DOWN), radius)
    workshop.add("rotor", cylinder(0.02, (0, 0, 0), (0, 0, 0.005)))


def _in_box(values: Values, workshop: Workshop) -> None:
    """A square duct with bars behind and in front of the blades."""
    radius = 0.5 * values.number("diameter")
    half, motor, back = radius + 0.03, max(0.03, 0.22 * radius), 0.06
    centre = (0.0, back, half)
    workshop.body("base", cylinder(motor, (0, back + 0.03, half), centre))
    _add_rotor(values, workshop, "base", at(centre, FRONT), radius)
    front = back - _blades(values, radius)[2] - 0.02
    duct = box((-half, front, 0), (half, back + 0.05, 2 * half))
    duct -= box((0.012 - half, -1.0, 0.012), (half - 0.012, 1.0, 2 * half - 0.012))
    bars = []
    for share in np.linspace(-0.8, 0.8, 9):
        x = share * half
        bars.append(box((x - 0.003, front, 0.005), (x + 0.003, front + 0.006, 2 * half - 0.005)))
        bars.append(box((x - 0.003, back + 0.01, 0.005), (x + 0.003, back + 0.018, 2 * half - 0.005)))
    bars.append(box((0.005 - half, back + 0.01, half - 0.004), (half - 0.005, back + 0.018, half + 0.004)))
    workshop.add("base", duct, *bars)
    _add_controls(values, workshop, (0.0, back + 0.03, 2.0 * half), 0.009)


def _add_controls(values: Values, workshop: Workshop, place: tuple[float, float, float], depth: float) -> None:
    """Buttons in a row, or a knob, on top of the base."""
    count, clearance = values.count("buttons"), values.number("clearance")
    for k in range(max(count, 1)):
        where = (place[0] + 0.021 * (k - 0.5 * (max(count, 1) - 1)), *place[1:])
        mount = Mount(parent="base", place=where, face=TOP, clearance=clearance, depth=depth)
        if count:
            add_button(workshop, f"button_{k + 1}", mount, (0.013, 0.012), travel=0.003)
        else:
            add_knob(workshop, "knob", mount, 0.016, rest=values.number("open"))


_LEANS = {1: (0.0, 0.9), 2: (0.0, 0.3, 1.3), 3: (0.0, -0.4, 0.8, 1.6)}
"""Of the post, the arms and the head's neck, from the upright towards the front [rad]; by hinges."""
_SWINGS = ((-0.3, 0.4), (-0.25, 0.6), (-0.4, 0.5))
"""Of the hinges, counted from the head, positive upwards [rad]."""
_RADIUS = 0.011  # of the hinges [m]


def build_desk_lamp(values: Values, workshop: Workshop) -> None:
    """Desk lamps: arms on pins one after the other, and a shade at the end."""
    hinges, clearance, rest = min(values.count("joints"), 3), values.number("clearance"), values.number("open")
    foot, length = values.number("base"), values.number("arm")
    workshop.body("base", cylinder(foot, (0, 0, 0), (0, 0, 0.02)), cylinder(0.6 * foot, (0, 0, 0.019), (0, 0, 0.028)))
    _add_switch(values, workshop)
    parent, pivot = "base", np.array([0.0, 0.0, 0.08 if hinges > 1 else 0.03 + 0.8 * length])
    if values.count("joints") > hinges:
        boss, hole, rotor = stub((0, 0, 0.045), (0, 0, 1), 0.016, clearance, length=0.018)
        workshop.add("base", boss)
        workshop.cut("base", hole)
        parent = "post"
        workshop.body(parent, rotor)
        workshop.turns(parent, "base", (0, 0, 1), (0, 0, 0.045), (-2.5, 2.5))
        pivot[2] += 0.02
        start = (0.0, 0.0, 0.06)
    else:
        start = (0.0, 0.0, 0.02)
    workshop.add(parent, cylinder(0.9 * _RADIUS, start, pivot - (0.0, 0.0, 2.0 * _RADIUS)))
    leans = _LEANS[hinges]
    for k in range(hinges):
        last = k + 1 == hinges
        forked, tongue = bent_fork(pivot, (leans[k], leans[k + 1]), 0.026, _RADIUS, clearance)
        workshop.add(parent, forked)
        along = np.array([0.0, -math.sin(leans[k + 1]), math.cos(leans[k + 1])])
        end = pivot + (0.02 + values.number("shade") if last else length) * along
        begin, stop = pivot + 1.6 * _RADIUS * along, end - (0.0 if last else 2.0 * _RADIUS) * along
        name = "head" if last else f"arm_{k + 1}"
        workshop.body(name, tongue, rod(0.55 * _RADIUS, begin, stop))
        if last:
            workshop.add(name, *_shade(values, end, leans[k + 1] + 0.5 * math.pi))
        workshop.turns(name, parent, (-1, 0, 0), pivot, _SWINGS[hinges - 1 - k], rest=rest)
        parent, pivot = name, end


def _shade(values: Values, neck: FloatArray, lean: float) -> list[Manifold]:
    """A hollow cone that hangs on the neck with a bulb in it; its mouth looks where `lean` says."""
    wide, deep = values.number("shade"), 1.1 * values.number("shade")
    cone = Manifold.cylinder(deep, 0.35 * wide, wide, 48)
    inner = Manifold.cylinder(deep, 0.35 * wide - 0.002, wide - 0.002, 48).translate((0, 0, 0.004))
    bulb = ball(0.3 * wide, (0, 0, 0.45 * deep)) + cylinder(0.12 * wide, (0, 0, 0.002), (0, 0, 0.4 * deep))
    socket = cylinder(0.3 * wide, (0, 0, -0.03), (0, 0, 0.002))
    made = [cone - inner, bulb, socket]
    return [solid.translate((0, 0, 0.01)).rotate((math.degrees(lean), 0, 0)).translate(neck) for solid in made]


def _add_switch(values: Values, workshop: Workshop) -> None:
    """A button or a knob in front of the post."""
    clearance, foot = values.number("clearance"), values.number("base")
    mount = Mount(parent="base", place=(0, -0.8 * foot, 0.02), face=TOP, clearance=clearance, depth=0.012)
    if values.choice("switch") == "button":
        add_button(workshop, "button", mount, (0.016, 0.012), travel=0.003)
    elif values.choice("switch") == "knob":
        add_knob(workshop, "knob", mount, 0.12 * foot, rest=values.number("open"))
