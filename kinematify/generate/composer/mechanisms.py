"""Mechanisms that are placed on a side of a body, each with its own bearing, clearance and limits.

Each is built in the frame of its side: x to the right, y into the body, whose surface is y = 0, and z up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.generate.composer.bodies import BODY
from kinematify.generate.composer.linkages import (
    add_cantilever_tray,
    add_gripper,
    add_hook,
    add_leg,
    add_pedal,
    add_scissor_lift,
    stick,
)
from kinematify.generate.composer.place import HANGING, OUTWARD, UPSIDE_DOWN, Placement
from kinematify.generate.library.builder import drawn_on
from kinematify.generate.library.carved import add_door, add_drawer
from kinematify.generate.library.mechanisms import button, caster, hand_wheel, knob
from kinematify.generate.procedural.parameter import phrases, read_table
from kinematify.generate.procedural.pieces.bearings import BackEdge, add_barrels
from kinematify.generate.procedural.pieces.fronts import room
from kinematify.generate.procedural.solids import Y, ball, bore, box, cylinder, rod, union

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from manifold3d import Manifold

    from kinematify.robot.arrays import FloatArray


def _door(place: Placement) -> None:
    place.hollowed()
    # Doors of a front open from the middle of each pair; those beside are hinged at their front edge, as cars have it.
    side = {"left": "right", "right": "left"}.get(place.side, "left" if place.index % 2 == 0 else "right")
    side = place.hinge or side
    add_door(place.workshop, place.name, BODY, place.area, place.fitting, side=side)


def _drawer(place: Placement) -> None:
    place.hollowed()
    add_drawer(place.workshop, place.name, BODY, place.area, place.fitting)


def _flap(place: Placement) -> None:
    place.hollowed()
    # When it is down, it lies before what is below.
    lifted = replace(place.area, bottom=place.area.bottom + min(0.2 * place.area.height, 1.5 * place.area.wall))
    add_door(place.workshop, place.name, BODY, lifted, place.fitting, side="bottom")


def _leaf(place: Placement) -> None:
    """A board on barrel hinges before what carries it, that folds down until it is level."""
    add_door(place.workshop, place.name, BODY, place.area, place.fitting, side="bottom", hinge="barrel")


def _lid(place: Placement) -> None:
    place.hollowed()
    area = place.area
    about = replace(area, left=-area.right, right=-area.left, bottom=-area.top, top=-area.bottom)
    turned = place.workshop.turned(UPSIDE_DOWN, (0, 0, 0))
    add_door(turned, place.name, BODY, about, place.fitting, side="bottom")


def _shutter(place: Placement) -> None:
    """A panel between two rails covers the left half of its area, or the right one if so said, and slides aside.

    Several cover one area each, on two tracks one behind the other, and slide before or behind their neighbours.
    """
    area, gap, workshop, several = place.area, place.clearance, place.workshop, place.beside > 1
    thick, rail = min(area.wall, 0.02), min(0.012, 0.1 * area.height)
    middle, track = 0.5 * (area.left + area.right), place.index % 2
    way, side = (-1.0, area.right) if place.half == "right" else (1.0, area.left)
    low, high = sorted((side, middle))
    if several:
        way, low, high = 1.0 if place.index == 0 else -1.0, area.left, area.right
    if place.hollow:
        behind = replace(area, left=low, right=high, bottom=area.bottom + rail, top=area.top - rail)
        place.workshop.cut(BODY, room(behind))
    deep = thick + 2.0 * gap  # of a track
    front = -deep * (1 + several)
    for edge, sign in ((area.bottom, 1.0), (area.top, -1.0)):
        inner, lip = edge + sign * 0.5 * rail, edge + sign * rail
        for start, end, level in ((front - 0.006, 1e-3, inner), (front - 0.006, front, lip)):
            under, over = sorted((edge, level))
            workshop.add(BODY, box((area.left, start, under), (area.right, end, over)))
    bottom, top = area.bottom + 0.5 * rail + gap, area.top - 0.5 * rail - gap
    back = -gap - deep * track
    panel = box((low + 0.5 * gap, back - thick, bottom), (high - 0.5 * gap, back, top))
    x, z = (high if way > 0.0 else low) - way * min(0.05, 0.2 * area.width), place.middle[2]
    if several:  # what stands out would stop its neighbour
        x = low + high - x
        panel -= cylinder(min(0.02, 0.1 * area.width), (x, back - 2.0 * thick, z), (x, back - 0.6 * thick, z))
        workshop.body(place.name, panel)
    else:
        grip = box((x - 0.008, front - 0.03, z - 0.06), (x + 0.008, -gap - 1e-3, z + 0.06))
        if area.height < 0.25:
            grip = cylinder(0.15 * area.height, (x, -gap - 1e-3, z), (x, front - 0.02, z))
        workshop.body(place.name, panel, grip)
    workshop.slides(place.name, BODY, (way, 0, 0), place.middle, (0.0, 0.95 * (high - low)), rest=place.fitting.rest)


def _sash(place: Placement) -> None:
    """A shutter that is pushed up; in a frame, what is above it stays closed."""
    area = place.area
    upwards = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    about = replace(area, left=area.bottom, right=area.top, bottom=-area.right, top=-area.left)
    if not place.hollow:
        above = replace(area, bottom=place.middle[2])
        place.workshop.add(BODY, box((area.left, 1e-3, above.bottom), (area.right, area.wall, above.top)))
    _shutter(replace(place, workshop=place.workshop.turned(upwards, (0, 0, 0)), area=about, half=""))


def _trunk(place: Placement) -> None:
    place.hollowed()
    add_door(place.workshop, place.name, BODY, place.area, place.fitting, side="bottom")


def _ladder(place: Placement) -> None:
    """Two rails with rungs that lie on a roof and are raised about their rear end."""
    area, gap = place.area, place.clearance
    half = min(0.3 * area.width, 0.3)
    bar, long = 0.08 * half, 0.9 * area.height
    frame = place.workshop.turned(OUTWARD, (place.middle[0], 0.0, area.top - 3.0 * bar))
    level, pin = 3.0 * bar, 0.6 * bar
    for sign in (-1.0, 1.0):
        low, high = sorted((sign * (half + gap), sign * (half + gap + 2.0 * bar)))
        cheek = box((low, -2.0 * bar, -1e-3), (high, 2.0 * bar, level + 2.0 * bar))
        frame.add(BODY, cheek - bore(pin, gap, (low - 1e-3, 0, level), (high + 1e-3, 0, level)))
    low, high = sorted((-half, half))
    rails = [box((x, -long, level - bar), (x + 2.0 * bar, bar, level + bar)) for x in (low, high - 2.0 * bar)]
    rungs = [
        cylinder(0.7 * bar, (low + bar, y, level), (high - bar, y, level))
        for y in np.linspace(-0.95 * long, -0.1 * long, 10)
    ]
    axle = cylinder(pin, (low - gap - bar, 0, level), (high + gap + bar, 0, level))
    frame.body(place.name, *rails, *rungs, axle, material="metal")
    frame.turns(place.name, BODY, (-1, 0, 0), (0, 0, level), (0.0, 1.2), rest=place.fitting.rest)


def _vise(place: Placement) -> None:
    """A fixed jaw, and one on a bar through it that is drawn away."""
    x, _, z = place.middle
    size, gap = min(place.radius, 0.12), place.clearance
    high, bar = 0.9 * size, 0.16 * size
    level = -0.55 * high
    workshop = place.workshop
    fixed = box((x - 0.5 * size, -high, z - 0.5 * size), (x - 0.1 * size, 1e-3, z + 0.5 * size))
    workshop.add(BODY, fixed - bore(bar, gap, (x - size, level, z), (x + size, level, z)))
    jaw = box((x, -high, z - 0.5 * size), (x + 0.3 * size, -gap - 1e-3, z + 0.5 * size))
    workshop.body(place.name, jaw, cylinder(bar, (x - 0.95 * size, level, z), (x + 0.2 * size, level, z)))
    workshop.slides(place.name, BODY, (1, 0, 0), (x, level, z), (0.0, 0.4 * size), rest=place.fitting.rest)


def _rail(place: Placement) -> None:
    """A bar on two posts; it belongs to the body."""
    x, _, z = place.middle
    half, out = min(0.42 * place.area.width, 0.4), 0.05
    for end in (x - half, x + half):
        place.workshop.add(BODY, *place.workshop.as_handle(rod(0.008, (end, 0.002, z), (end, -out, z))))
    place.workshop.add(BODY, *place.workshop.as_handle(rod(0.01, (x - half, -out, z), (x + half, -out, z))))


def _plate(place: Placement, material: str, color: str | None = None) -> None:
    """Something flat on the surface; it belongs to the body."""
    x, _, z = place.middle
    wide, high = (min(0.4 * length, 0.3) for length in (place.area.width, place.area.height))
    plate = box((x - wide, -0.003, z - high), (x + wide, 1e-3, z + high))
    place.workshop.add(BODY, *place.workshop.painted(plate, material=material, color=color))


def _dome(place: Placement, material: str, color: str | None = None) -> None:
    """Half a ball on the surface; it belongs to the body."""
    radius = min(0.5 * place.radius, 0.02)
    dome = ball(radius, place.middle) - box((-9.0, 1e-3, -9.0), (9.0, 9.0, 9.0))
    place.workshop.add(BODY, *place.workshop.painted(dome, material=material, color=color))


def _vent(place: Placement) -> None:
    """A plate with slots; it belongs to the body."""
    x, _, z = place.middle
    wide, high = 0.45 * place.area.width, 0.45 * place.area.height
    slots = [box((x - 0.8 * wide, -0.1, z + k * high - 0.08 * high), (x + 0.8 * wide, 0.1, z + k * high + 0.08 * high))
             for k in (-0.6, -0.2, 0.2, 0.6)]  # fmt: skip
    plate = box((x - wide, -0.004, z - high), (x + wide, 1e-3, z + high)) - union(*slots)
    place.workshop.add(BODY, *place.workshop.painted(plate, material="plastic", color="dark grey"))


def _basket(place: Placement) -> None:
    """An open box before the surface; it belongs to the body."""
    area, wall = place.area, 0.004
    deep = min(0.8 * area.width, 0.25)
    low, high = (area.left, -deep, area.bottom), (area.right, 1e-3, area.top)
    inner = box((area.left + wall, wall - deep, area.bottom + wall), (area.right - wall, -wall, 9.0))
    place.workshop.add(BODY, *place.workshop.painted(box(low, high) - inner, material="metal"))


def _mirror(place: Placement) -> None:
    """A plate that stands at the rear edge; it belongs to the body."""
    area, half = place.area, 0.35 * place.area.width
    plate = box((-half, -2.0 * half, area.top - 0.02), (half, 1e-3, area.top))
    place.workshop.add(BODY, *place.workshop.painted(plate, material="mirror"))


def _shelf(place: Placement) -> None:
    """A board in a slot, with a lip to pull it by."""
    area, gap = place.area, place.clearance
    thick = min(0.4 * area.height, 0.018)
    z, deep = place.middle[2], 0.8 * area.depth
    half = 0.5 * area.width - area.wall
    x = place.middle[0]
    slot = box((x - half - gap, -1.0, z - 0.5 * thick - gap), (x + half + gap, deep, z + 0.5 * thick + gap))
    place.workshop.cut(BODY, slot)
    board = box((x - half, -gap - 1e-3, z - 0.5 * thick), (x + half, deep - gap, z + 0.5 * thick))
    lip = box((x - half, -gap - 0.012, z - 0.5 * area.height + 1e-3), (x + half, -gap, z + 0.5 * area.height - 1e-3))
    place.workshop.body(place.name, board, lip)
    place.workshop.slides(place.name, BODY, (0, -1, 0), place.middle, (0.0, 0.7 * deep), rest=place.fitting.rest)


def _knob(place: Placement) -> None:
    with place.drawn() as d:
        knob(d, place.name, BODY, place.middle, min(0.6 * place.radius, 0.03), -Y, reach=4.7)


def _button(place: Placement) -> None:
    size = min(1.1 * place.radius, 0.03)
    with place.drawn() as d:
        button(d, place.name, BODY, place.middle, (size, size), min(0.006, 0.25 * size), -Y)


def _lever(place: Placement) -> None:
    """A stick on a pin between two cheeks, which swings up and down."""
    width = min(0.05, 0.8 * place.radius, 0.2 * place.area.height)
    stick(BODY, place.workshop.turned(OUTWARD, place.middle), place.name, width, place.clearance, long=3.0 * width)


def _arm(place: Placement) -> None:
    """Two links, one on the other, that swing about level pins."""
    width = min(0.08, 0.9 * place.radius)
    frame = place.workshop.turned(OUTWARD, place.middle)
    lower, upper = f"{place.name}_link_1", f"{place.name}_link_2"
    # The upper link's fork stands where the lower one ends.
    height = stick(BODY, frame, lower, width, place.clearance, long=6.0 * width, head=ball(0.1 * width, (0, 0, 0)))
    above = place.workshop.turned(OUTWARD, (place.middle[0], -height, place.middle[2]))
    stick(lower, above, upper, 0.8 * width, place.clearance, long=5.0 * width)


def _crank(place: Placement) -> None:
    """An arm with a grip, on a shaft."""
    x, _, z = place.middle
    reach, gap = min(0.75 * place.radius, 0.15), place.clearance
    shaft = 0.12 * reach
    arm = box((x - shaft, -gap - 2.0 * shaft, z - shaft), (x + shaft, -gap, z + reach))
    grip = cylinder(
        0.8 * shaft, (x, -gap - shaft, z + reach - shaft), (x, -gap - shaft - 0.6 * reach, z + reach - shaft)
    )
    hub = cylinder(1.6 * shaft, (x, -gap, z), (x, -gap - 2.0 * shaft, z))
    place.on_shaft(arm, grip, hub, shaft=0.8 * shaft)


def _hand_wheel(place: Placement) -> None:
    with place.drawn() as d:
        hand_wheel(d, place.name, BODY, place.middle, min(0.85 * place.radius, 0.2), -Y)


def _rotor(place: Placement) -> None:
    """Blades on a hub."""
    radius, gap = min(0.95 * place.radius, 0.4), place.clearance
    hub, wide = 0.16 * radius, (0.12 if place.members < 5 else 0.09) * radius
    blades = [
        box((0, -wide, -0.02 * radius), (radius, wide, 0.02 * radius))
        .rotate((25.0, 0, 0))
        .rotate((0, 0, math.degrees(angle)))
        for angle in _angles(place.members or 3)
    ]
    x, _, z = place.middle
    body = cylinder(hub, (x, -gap, z), (x, -gap - 2.4 * hub, z))
    place.on_shaft(body, union(*blades).transform(_at(place, gap + 1.6 * hub)), shaft=0.5 * hub)


def _needle(place: Placement) -> None:
    """A pointer over a dial that belongs to the body."""
    x, _, z = place.middle
    radius, gap = min(0.85 * place.radius, 0.08), place.clearance
    dial = 0.003
    place.workshop.add(BODY, cylinder(radius, (x, 1e-3, z), (x, -dial, z)))
    half, out = 0.05 * radius, dial + gap
    pointer = box((x - half, -out - 0.003, z - 3.0 * half), (x + half, -out, z + 0.85 * radius))
    hub = cylinder(2.0 * half, (x, -out, z), (x, -out - 0.005, z))
    stem = cylinder(half, (x, 0, z), (x, -out - 1e-3, z))
    raised = replace(place, fitting=replace(place.fitting, rest=0.0))
    place.workshop.cut(BODY, bore(half, gap, (x, 0.2 * place.area.wall, z), (x, -1.0, z)))
    raised.on_shaft(pointer, hub, stem, shaft=half, limits=(0.0, 4.5))


def _turntable(place: Placement) -> None:
    """A disc on a shaft."""
    x, _, z = place.middle
    radius, gap = min(0.95 * place.radius, 0.3), place.clearance
    plate = cylinder(radius, (x, -gap, z), (x, -gap - max(0.01, 0.06 * radius), z))
    mark = box(
        (x - 0.04 * radius, -gap - 0.014 - 0.06 * radius, z + 0.6 * radius), (x + 0.04 * radius, -gap, z + 0.9 * radius)
    )
    place.on_shaft(plate, mark, shaft=min(0.3 * radius, 0.02))


def _wheel(place: Placement) -> None:
    """A tyre on a shaft beside the body."""
    x, _, z = place.middle
    radius, gap = place.radius, place.clearance
    wide, shaft = 0.35 * radius, min(0.2 * radius, 0.3 * place.area.depth)
    tyre = cylinder(radius, (x, -gap - 0.1 * radius, z), (x, -gap - 0.1 * radius - wide, z))
    hub = cylinder(1.6 * shaft, (x, -gap, z), (x, -gap - 0.15 * radius - wide, z))
    place.on_shaft(tyre, hub, shaft=shaft, material="rubber")


def _caster(place: Placement) -> None:
    high = min(place.radius, 0.05) / 0.38
    frame = place.workshop.turned(HANGING, place.middle)
    with drawn_on(frame, place.clearance) as d:
        caster(d, f"{place.name}_wheel", BODY, (0, 0, 0), high, fork=place.name, deep=0.022)


def _telescope(place: Placement) -> None:
    """A tube on the body, and a rod in it that is pulled out."""
    x, _, z = place.middle
    radius, gap = min(0.5 * place.radius, 0.03), place.clearance
    long = 12.0 * radius
    inner = 0.65 * radius
    tube = cylinder(radius, (x, 1e-3, z), (x, -long, z))
    place.workshop.add(BODY, tube - bore(inner, gap, (x, -0.2 * radius, z), (x, -2.0 * long, z), segments=8))
    mast = cylinder(inner, (x, -0.2 * radius - gap, z), (x, -long - 0.5 * radius, z), segments=8)
    cap = cylinder(radius, (x, -long - gap, z), (x, -long - 0.6 * radius - gap, z))
    place.workshop.body(place.name, mast, cap, material="metal")
    place.workshop.slides(place.name, BODY, (0, -1, 0), place.middle, (0.0, 0.7 * long), rest=place.fitting.rest)


def _bail(place: Placement) -> None:
    """A bow on two pins, which lies down to either side; where there is no floor, its ears stand on the rim."""
    x, _, z = place.middle
    gap, ear, pin, rise = place.clearance, 0.008, 0.005, 0.022
    on_rim = 0.5 * (place.area.width + place.area.wall + ear) + 2.0 * pin + gap
    on_edge = place.side == "top" and not place.hollow
    half = on_rim if on_edge else min(0.42 * place.area.width, 0.2)
    high = rise + 0.8 * half
    solids = [rod(pin, (x - half, -high, z), (x + half, -high, z))]
    for sign in (-1.0, 1.0):
        outer = x + sign * half
        inner = outer - sign * (2.0 * pin + gap)
        low, top = sorted((inner, inner - sign * ear))
        lug = box((low, -rise - 2.2 * pin, z - 2.2 * pin), (top, 1e-3, z + 2.2 * pin))
        place.workshop.add(place.parent, lug)
        place.workshop.cut(place.parent, bore(pin, gap, (low - 1e-3, -rise, z), (top + 1e-3, -rise, z)))
        solids.append(rod(pin, (outer, -rise, z), (outer, -high, z)))
        solids.append(cylinder(pin, (inner - sign * ear, -rise, z), (outer, -rise, z)))
    place.workshop.body(place.name, *place.workshop.as_handle(*solids))
    place.workshop.turns(place.name, place.parent, (1, 0, 0), (x, -rise, z), (-1.3, 1.3), rest=place.fitting.rest)


def _push_handle(place: Placement) -> None:
    """A bar on two posts; it belongs to the body."""
    out, top = -0.07, place.area.top + 0.3
    low = max(place.area.bottom + 0.02, place.area.top - 0.08)
    ends = [(sign * 0.42 * place.area.width, out, top) for sign in (-1.0, 1.0)]
    for x, _, _ in ends:
        posts = rod(0.012, (x, 0.002, low), (x, out, low)), rod(0.012, (x, out, low), (x, out, top))
        place.workshop.add(BODY, *place.workshop.as_handle(*posts))
    place.workshop.add(BODY, *place.workshop.as_handle(rod(0.014, *ends)))


def _round_lid(place: Placement) -> None:
    """A disc with a knob, on a barrel hinge behind a round mouth."""
    frame, gap, radius = place.workshop.turned(OUTWARD, place.middle), place.clearance, place.radius
    thick, pin, tab = 0.05 * radius, 0.0035, 0.25 * radius
    behind = radius + 1e-3
    frame.add(BODY, box((-tab, 0.9 * radius, -6.0 * pin), (tab, behind, 0)) - _inside(radius))
    top = gap + thick
    leaf = box((-tab, 0.9 * radius, gap), (tab, behind, top + 2.0 * pin))
    knob = ball(0.14 * radius, (0, 0, top + 0.12 * radius))
    disc = cylinder(radius, (0, 0, gap), (0, 0, top))
    frame.body(
        place.name,
        disc,
        leaf,
        *frame.as_handle(knob + cylinder(0.07 * radius, (0, 0, gap), (0, 0, top + 0.1 * radius))),
    )
    edge = BackEdge(y=behind, level=gap, below=5.0 * pin, above=thick + 2.0 * pin, clearance=min(gap, 0.3 * pin))
    pivot = add_barrels(frame, place.name, BODY, edge, (0.0,), length=1.8 * tab, radius=pin)
    frame.turns(place.name, BODY, (-1, 0, 0), pivot, (0.0, 1.5), rest=place.fitting.rest)


def _inside(radius: float) -> Manifold:
    """Of a round vessel below its mouth."""
    return cylinder(0.93 * radius, (0, 0, -radius), (0, 0, radius))


def _seat(place: Placement) -> None:
    """A round seat on a shaft."""
    x, _, z = place.middle
    gap, radius = place.clearance, 0.18
    seat = cylinder(radius, (x, -gap, z), (x, -gap - 0.06, z))
    back = box((x - 0.03, -gap - 0.075, z + 0.5 * radius), (x + 0.03, -gap - 0.055, z + 0.9 * radius))
    place.on_shaft(seat, back, shaft=0.5 * place.radius)


def _desktop(place: Placement) -> None:
    """A board on two rods that slide in the legs below it."""
    area, gap, workshop = place.area, place.clearance, place.workshop
    middle, rod_half, deep = place.middle, 0.022, 0.85 * area.depth
    board = box((area.left, -gap - 0.03, area.bottom), (area.right, -gap, area.top))
    solids = [board]
    for x in (-0.35 * (area.width + 2.0 * area.wall), 0.35 * (area.width + 2.0 * area.wall)):
        for start, half, cut in ((-1.0, rod_half + gap, True), (-gap - 1e-3, rod_half, False)):
            post = box((x - half, start, middle[2] - half), (x + half, deep + (gap if cut else 0.0), middle[2] + half))
            if cut:
                workshop.cut(BODY, post)
            else:
                solids.append(post)
    workshop.body(place.name, *solids, material="wood")
    workshop.slides(place.name, BODY, (0, -1, 0), middle, (0.0, 0.8 * deep), rest=place.fitting.rest)


def _screen(place: Placement) -> None:
    """A flat screen on a fork, which tilts."""
    width, frame = min(0.06, 1.6 * place.radius), place.workshop.turned(OUTWARD, place.middle)
    panel = box((-0.3, -0.03, -0.02), (0.3, -0.01, 0.34)) + box((-0.02, -0.02, -0.02), (0.02, 0.01, 0.1))
    stick(BODY, frame, place.name, width, place.clearance, long=2.0 * width, limits=(-0.3, 0.3), head=panel)


def _flag(place: Placement) -> None:
    """A small plate on a stick that is turned up."""
    width = min(0.03, 0.8 * place.radius)
    frame = place.workshop.turned(OUTWARD @ np.diag([-1.0, -1.0, 1.0]), place.middle)  # the other way than a lever
    plate = box((-0.1 * width, -0.1 * width, -width), (0.1 * width, 2.0 * width, 0))
    stick(BODY, frame, place.name, width, place.clearance, long=5.0 * width, limits=(0.0, 1.3), head=plate)


def _latch(place: Placement) -> None:
    """A bar that is turned aside."""
    x, _, z = place.middle
    reach, gap = min(0.85 * place.radius, 0.04), place.clearance
    bar = box((x - 0.25 * reach, -gap - 0.008, z - 0.3 * reach), (x + 0.25 * reach, -gap, z + reach))
    place.on_shaft(bar, shaft=0.15 * reach, limits=(0.0, 0.5 * math.pi))


def _slider(place: Placement) -> None:
    """A cap on a stem that is pushed along a slot."""
    x, _, z = place.middle
    gap, half = place.clearance, min(0.42 * place.area.height, 0.05)
    stem, deep = 0.06 * half, min(0.02, place.area.wall if place.hollow else 0.6 * place.area.depth)
    low, high = z - 0.8 * half, z + 0.8 * half
    slot = box((x - stem - gap, -1.0, low - stem - gap), (x + stem + gap, deep, high + stem + gap))
    place.workshop.cut(BODY, slot)
    blade = box((x - stem, -gap - 2e-3, low - stem), (x + stem, 0.7 * deep, low + stem))
    cap = box((x - 4.0 * stem, -gap - 0.012, low - 3.0 * stem), (x + 4.0 * stem, -gap - 1e-3, low + 3.0 * stem))
    place.workshop.body(place.name, blade, cap)
    place.workshop.slides(place.name, BODY, (0, 0, 1), place.middle, (0.0, high - low), rest=place.fitting.rest)


def _compartment(place: Placement) -> None:
    """An open room, whose floor is a shelf."""
    place.hollowed()


def _angles(count: int) -> list[float]:
    return [2.0 * math.pi * k / count for k in range(count)]


def _at(place: Placement, out: float) -> FloatArray:
    """From where something lies in z = 0 to where it lies before the middle of a place, (3, 4)."""
    x, _, z = place.middle
    return np.column_stack([OUTWARD, (x, -out, z)])


@dataclass(frozen=True, kw_only=True)
class MechanismKind:
    """A kind of mechanism."""

    words: tuple[str, ...]
    """How people call it, singular; the first one names it."""
    sides: tuple[str, ...]
    """Where it may go, the usual one first."""
    build: Callable[[Placement], None]
    arranged: str = "grid"
    """``row`` beside each other over the full height, ``stack`` one below the other, ``grid``, ``foot`` beside each
    other below all that, ``corners`` below the body, ``axles`` along its lower edges, ``over`` a side or its lid,
    ``alone`` on a side, ``apart`` on a side with at most what is over it, or ``edge``, which takes no room."""
    weight: float = 1.0
    """Share of a side's height beside the others."""
    least: tuple[float, float] = (0.04, 0.04)
    """Width and height that one needs [m]."""
    needs: str = ""
    """``room`` to run in, which must be cut behind it, or at least an ``opening`` that it closes; an open ``mouth``, a
    ``round mouth``, ``height`` above the floor, a ``post`` that ends there, or ``legs``."""
    most: int = 60
    """On one body."""
    moves: bool = True
    has_grip: bool = False
    """A handle of its own, which may be of another look."""
    members: tuple[str, ...] = ()
    """What it has several of, which may be counted: the blades of a rotor."""
    halves: bool = False
    """On the left or the right is said of the half of a side that it covers."""
    on_parts: Callable[[Placement], None] | None = None
    """How it is built on a door, a lid or the like, where that is otherwise."""


_BUILDERS: Mapping[str, Callable[[Placement], None]] = {
    **{
        build.__name__.removeprefix("_").removeprefix("add_"): build
        for build in (
            _door, _drawer, _flap, _leaf, _lid, _shutter, _sash, _trunk, _ladder, _vise, _rail, _mirror, _shelf,
            _round_lid, _vent, _basket,
            _compartment, _knob, _button, _slider, _latch, _flag, _seat, _desktop, _screen, _lever, _crank, _hand_wheel,
            _needle, _wheel, _caster, _rotor, _turntable, _telescope, _bail, _arm, _push_handle, add_cantilever_tray,
            add_scissor_lift, add_gripper, add_hook, add_pedal, add_leg,
        )
    },
    "display": partial(_plate, material="plastic", color="dark grey"),
    "window": partial(_plate, material="mirror"),
    "lock": partial(_plate, material="metal"),
    "light": partial(_dome, material="glass", color="orange"),
    "bell": partial(_dome, material="metal"),
}  # fmt: skip


def _kind(said: Mapping[str, Any]) -> MechanismKind:
    listed = {name: phrases(said[name]) for name in ("words", "members") if name in said}
    pairs = {name: tuple(said[name]) for name in ("sides", "least") if name in said}
    built = {name: _BUILDERS[said[name]] for name in ("build", "on_parts") if name in said}
    return MechanismKind(**{**said, **listed, **pairs, **built})


MECHANISMS = tuple(_kind(said) for said in read_table(Path(__file__).with_name("mechanisms.yaml")))
"""All mechanisms; no word stands twice."""
