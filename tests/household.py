"""Everyday objects with known joints. The front looks along -y."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearing_pieces import barrel, fork, fork_room
from kinematify.generate.procedural.solids import ball, bore, box, cylinder, hull, rod, tray, union
from tests.known import KnownJoint, KnownObject, known_object, moved, sliding, turning, varied

if TYPE_CHECKING:
    from manifold3d import Manifold

UP = np.array([0.0, 0.0, 1.0])


def hinge_pin(*, length: float = 0.08, clearance: float = 2e-4, seed: int | None = None) -> KnownObject:
    """Two leaves: the pin of one, with a head, turns in the bored knuckle of the other."""
    vary = varied(seed)
    height, radius = vary(length), vary(0.006)
    half, leaf, near, edge = 0.5 * height, vary(0.04), 1.1 * radius, 0.4 * radius
    lower = hull(
        cylinder(radius, (0, 0, -half), (0, 0, -clearance)),
        box((-near - edge, -edge, -half), (-near, edge, -clearance)),
    )
    upper = hull(cylinder(radius, (0, 0, 0), (0, 0, half)), box((near, -edge, 0), (near + edge, edge, half)))
    plates = [box((-leaf, -edge, -half), (-near, edge, half)), box((near, -edge, -half), (leaf, edge, half))]
    pin = cylinder(0.5 * radius, (0, 0, -half), (0, 0, half + 2 * clearance))
    head = cylinder(0.8 * radius, (0, 0, half + clearance), (0, 0, half + clearance + edge))
    leaf_with_bore = union(upper, plates[1]) - bore(0.5 * radius, clearance, (0, 0, -half), (0, 0, height))
    solids = {"pin_leaf": union(lower, plates[0], pin, head), "bored_leaf": leaf_with_bore}
    return known_object("hinge_pin", solids, turning("pin_leaf", "bored_leaf", (0, 0, 1), (0, 0, 0), (-2.0, 2.0)))


def barrel_hinge_door(
    *, width: float = 0.6, height: float = 1.2, clearance: float = 5e-4, seed: int | None = None
) -> KnownObject:
    """A door in its frame on two barrel hinges of three knuckles each; a rebate stops it."""
    vary = varied(seed)
    wide, high, thick = vary(width), vary(height), vary(0.03)
    radius, leaf = 0.008, 0.003
    near = radius + clearance
    free = np.hypot(wide, thick + 0.5 * leaf) + 2 * clearance
    post = 0.06
    frame = [
        box((-near - post, 0, 0), (-near, thick, high)),
        box((free, 0, 0), (free + post, thick + 0.02, high)),
        box((-near - post, 0, high), (free + post, thick + 0.02, high + post)),
        box((-near - post, 0, -post), (free + post, thick + 0.02, 0)),
        box((free - 0.015, thick + clearance, 0), (free, thick + 0.02, high)),
    ]
    door = [
        box((near, 0, 0.004), (wide, thick, high - 0.004)),
        rod(0.01, (wide - 0.05, -0.04, 0.5 * high), (wide - 0.15, -0.04, 0.5 * high)),
    ]
    door.append(cylinder(0.008, (wide - 0.05, 0.01, 0.5 * high), (wide - 0.05, -0.04, 0.5 * high)))
    anchors = ((-0.03, -near, 0.0, leaf), (near, 0.03, 0.0, leaf))
    for level in (0.15, 0.85):
        outer, inner = barrel(0.09, radius, clearance, anchors)
        shift = (0, -0.5 * leaf, level * high)
        frame.append(outer.translate(shift))
        door.append(inner.translate(shift))
    joint = turning("frame", "door", (0, 0, -1), (0, -0.5 * leaf, 0), (0.0, 2.1), stops=(True, False))
    return known_object("barrel_hinge_door", {"frame": union(*frame), "door": union(*door)}, joint)


def edge_door(
    *, width: float = 0.4, height: float = 0.6, clearance: float = 1e-3, seed: int | None = None
) -> KnownObject:
    """A cabinet whose door turns about its edge, without a hinge to be seen."""
    vary = varied(seed)
    wide, high, deep, wall = vary(width), vary(height), vary(0.35), 0.018
    door = box((0, -wall - clearance, 0), (wide, -clearance, high))
    grip = rod(0.006, (0.9 * wide, -wall - 0.03, 0.4 * high), (0.9 * wide, -wall - 0.03, 0.6 * high))
    feet = [cylinder(0.005, (0.9 * wide, -wall, z * high), (0.9 * wide, -wall - 0.03, z * high)) for z in (0.42, 0.58)]
    joint = turning("cabinet", "door", (0, 0, -1), (0, -clearance, 0), (0.0, 1.9), stops=(True, False))
    return known_object(
        "edge_door", {"cabinet": carcass(wide, deep, high, wall), "door": union(door, grip, *feet)}, joint
    )


def carcass(wide: float, deep: float, high: float, wall: float) -> Manifold:
    """Return a box that is open at the front, its lower left front corner at the origin."""
    inside = box((wall, -wall, wall), (wide - wall, deep - wall, high - wall))
    return box((0, 0, 0), (wide, deep, high)) - inside


def drawer_box(wide: float, deep: float, high: float, wall: float, clearance: float) -> Manifold:
    """Return an open drawer with its front panel and handle that fits the carcass of this size."""
    edge, lift = wall + clearance, wall + clearance
    body = tray((edge, -clearance, lift), (wide - edge, deep - edge, 0.8 * high), 0.01)
    panel = box((0.3 * wall, -wall - clearance, 0.3 * wall), (wide - 0.3 * wall, -clearance + 1e-4, high - 0.3 * wall))
    front, level = -wall - clearance, 0.55 * high
    bar = rod(0.006, (0.35 * wide, front - 0.03, level), (0.65 * wide, front - 0.03, level))
    posts = [cylinder(0.005, (x * wide, front + 1e-3, level), (x * wide, front - 0.03, level)) for x in (0.38, 0.62)]
    panel -= box((-wide, -clearance, -high), (2 * wide, deep, 2 * high))
    return union(body, panel, bar, *posts)


def drawer(
    *, width: float = 0.4, depth: float = 0.4, height: float = 0.15, clearance: float = 1e-3, seed: int | None = None
) -> KnownObject:
    """An open box with front panel and handle in a carcass."""
    vary = varied(seed)
    size = vary(width), vary(depth), vary(height), 0.015
    solids = {"carcass": carcass(*size), "drawer": drawer_box(*size, clearance)}
    joint = sliding("carcass", "drawer", (0, -1, 0), (0, 0, 0), (0.0, 0.75 * size[1]), stops=(True, False))
    return known_object("drawer", solids, joint)


def nested_drawer(*, width: float = 0.4, clearance: float = 1e-3, seed: int | None = None) -> KnownObject:
    """A drawer in a carcass and, in the drawer, a tray that slides along it."""
    vary = varied(seed)
    wide, deep, high, wall = vary(width), vary(0.45), vary(0.15), 0.015
    rim = wall + clearance + 0.01
    start, end = -clearance + 0.01, deep - rim
    long = 0.45 * (end - start)
    lower = (rim + clearance, start + clearance, rim + clearance)
    inner = tray(lower, (wide - rim - clearance, start + clearance + long, 0.6 * high), 0.006)
    solids = {
        "carcass": carcass(wide, deep, high, wall),
        "drawer": drawer_box(wide, deep, high, wall, clearance),
        "tray": inner,
    }
    travel = end - start - long - 2 * clearance
    return known_object(
        "nested_drawer",
        solids,
        sliding("carcass", "drawer", (0, -1, 0), (0, 0, 0), (0.0, 0.75 * deep), stops=(True, False)),
        sliding("drawer", "tray", (0, 1, 0), lower, (0.0, travel), stops=(True, True)),
    )


def knob(*, radius: float = 0.02, clearance: float = 3e-4, seed: int | None = None) -> KnownObject:
    """A knob with a pointer on a panel; its shaft passes a hole and a flange keeps it there."""
    vary = varied(seed)
    size, thick, shaft = vary(radius), vary(0.008), vary(0.004)
    panel = box((-4 * size, 0, -3 * size), (5 * size, thick, 3 * size))
    panel -= bore(shaft, clearance, (0, -thick, 0), (0, 2 * thick, 0))
    cap = cylinder(size, (0, -clearance - 0.015, 0), (0, -clearance, 0))
    pointer = box((-0.1 * size, -0.022, 0), (0.1 * size, -0.01, size))
    stem = cylinder(shaft, (0, -0.005, 0), (0, thick + clearance + 0.001, 0))
    flange = cylinder(1.8 * shaft, (0, thick + clearance, 0), (0, thick + clearance + 0.003, 0))
    solids = {"panel": panel, "knob": union(cap, pointer, stem, flange)}
    return known_object("knob", solids, turning("panel", "knob", (0, -1, 0), (0, 0, 0)))


def sliding_lid(*, length: float = 0.2, clearance: float = 4e-4, seed: int | None = None) -> KnownObject:
    """A pencil box: the lid slides in grooves on three sides."""
    vary = varied(seed)
    half, side, high, wall, thick = 0.5 * vary(length), vary(0.05), vary(0.06), 0.01, 0.004
    groove, level = 0.5 * wall, high - 0.012
    top = level + thick + 2 * clearance
    body = tray((-half, -side, 0), (half, side, high), wall)
    body -= box((-half + groove, -side + groove, level), (half + wall, side - groove, top))
    body -= box((half - 2 * wall, -side + groove, level), (half + wall, side - groove, high + wall))
    edge = groove + clearance
    lid = box((-half + edge, -side + edge, level + clearance), (half, side - edge, level + clearance + thick))
    ridge = box((half - 0.03, -0.5 * side, level + 0.001), (half - 0.024, 0.5 * side, high + 0.004))
    joint = sliding("box", "lid", (1, 0, 0), (0, 0, level), (0.0, 1.6 * half), stops=(True, False))
    return known_object("sliding_lid", {"box": body, "lid": lid + ridge}, joint)


def toilet(
    *, width: float = 0.36, opening: float = 1.75, clearance: float = 6e-4, seed: int | None = None
) -> KnownObject:
    """A bowl, a seat and a lid that turn about one line; the lid stands open by `opening` [rad]."""
    vary = varied(seed)
    half, deep, radius = 0.5 * vary(width), vary(0.42), 0.012
    near = radius + 2 * clearance
    back = -near - 0.02
    middle, bowl_top, seat_top, lid_bottom = back - 0.5 * deep, -radius, 0.002, 0.022

    def disc(scale: float, lower: float, upper: float) -> Manifold:
        round_part = cylinder(1.0, (0, 0, lower), (0, 0, upper)).scale((scale * half, scale * 0.5 * deep, 1.0))
        return round_part.translate((0, middle, 0))

    bowl = disc(1.0, bowl_top - 0.35, bowl_top) + box((-half, back - 0.1, bowl_top - 0.35), (half, 0.2, bowl_top))
    bowl -= disc(0.75, bowl_top - 0.2, bowl_top + 0.1)
    seat = disc(1.02, bowl_top + clearance, seat_top) - disc(0.7, -0.1, 0.1)
    lid = disc(1.02, lid_bottom, lid_bottom + 0.012)
    hinged = {"seat": [seat], "lid": [lid]}
    levels = {"seat": (bowl_top + 2e-3, seat_top - 1e-3), "lid": (lid_bottom + 2e-3, lid_bottom + 0.01)}
    posts = []
    for sign in (-1.0, 1.0):
        x = sign * 0.45 * half
        spans = {"post": (x - 0.01, x + 0.01)}
        spans["seat"] = tuple(sorted((x + sign * (0.01 + clearance), x + sign * 0.035)))
        spans["lid"] = tuple(sorted((x - sign * (0.01 + clearance), x - sign * 0.035)))
        pin = cylinder(0.5 * radius, (x - 0.034, 0, 0), (x + 0.034, 0, 0))
        foot = box((spans["post"][0], -radius, bowl_top - 0.01), (spans["post"][1], radius, 0))
        posts += [pin, foot, cylinder(radius, (spans["post"][0], 0, 0), (spans["post"][1], 0, 0))]
        for name, solids in hinged.items():
            x0, x1 = spans[name]
            round_part = cylinder(radius - clearance, (x0, 0, 0), (x1, 0, 0))
            inner = box((x0, middle + 0.4 * deep, levels[name][0]), (x1, middle + 0.42 * deep, levels[name][1]))
            ear = hull(round_part, inner) - bore(0.5 * radius, clearance, (x0 - 1, 0, 0), (x1 + 1, 0, 0))
            solids.append(ear)
    solids = {"bowl": union(bowl, *posts), "seat": union(*hinged["seat"]), "lid": union(*hinged["lid"])}
    closed = known_object(
        "toilet",
        solids,
        turning("bowl", "seat", (-1, 0, 0), (0, 0, 0), (0.0, 1.4), stops=(True, False)),
        turning("bowl", "lid", (-1, 0, 0), (0, 0, 0), (0.0, 1.9), stops=(True, False)),
    )
    return moved(closed, {"lid": opening})


def button(*, size: float = 0.02, clearance: float = 3e-4, seed: int | None = None) -> KnownObject:
    """A square button in a pocket of its housing."""
    vary = varied(seed)
    half, travel, deep = 0.5 * vary(size), vary(0.003), vary(0.012)
    room_ = half + clearance
    housing = box((-4 * half, -3 * half, -2 * deep), (3 * half, 3 * half, 0))
    housing -= box((-room_, -room_, -deep - travel - clearance), (room_, room_, deep))
    cap = box((-half, -half, -deep), (half, half, travel + 0.002))
    joint = sliding("housing", "button", (0, 0, -1), (0, 0, 0), (0.0, travel), stops=(False, True))
    return known_object("button", {"housing": housing, "button": cap}, joint)


def lever(*, length: float = 0.15, clearance: float = 3e-4, seed: int | None = None) -> KnownObject:
    """A lever with a ball on its end in the fork of a block."""
    solids, joint = lever_solids(length, clearance, seed)
    return known_object("lever", solids, joint)


def lever_solids(length: float, clearance: float, seed: int | None) -> tuple[dict[str, Manifold], KnownJoint]:
    """Return block, lever and the joint between them."""
    vary = varied(seed)
    long, radius, wide = vary(length), vary(0.008), vary(0.03)
    forked, tongue = fork(wide, radius, clearance, 3 * radius)
    block = forked + box((-wide, -0.03, -0.05), (1.3 * wide, 0.04, -2.5 * radius))
    start = fork_room(radius, clearance) + radius
    arm = union(tongue, rod(0.6 * radius, (0, 0, start), (0, 0, long)), ball(1.5 * radius, (0, 0, long)))
    return {"block": block, "lever": arm}, turning("block", "lever", (1, 0, 0), (0, 0, 0), (-1.2, 1.2))


def four_bars() -> KnownObject:
    """A crank, a rocker and the bar between their ends, which turns on the crank and takes the rocker's pin."""
    radius, clearance = 0.004, 2e-4

    def pin(x: float, y: float, low: float, high: float) -> Manifold:
        return cylinder(radius, (x, y, low), (x, y, high))

    def hole(x: float, y: float, low: float, high: float) -> Manifold:
        return cylinder(radius + clearance, (x, y, low - 0.01), (x, y, high + 0.01))

    ground = union(box((-0.02, -0.02, 0), (0.12, 0.02, 0.01)), pin(0, 0, 0.005, 0.0205), pin(0.1, 0, 0.005, 0.0205))
    parts = {"ground": ground}
    for name, x in (("crank", 0.0), ("rocker", 0.1)):
        bar = box((x - 0.01, -0.01, 0.0102), (x + 0.01, 0.07, 0.02)) - hole(x, 0, 0.01, 0.02)
        parts[name] = union(bar, pin(x, 0.06, 0.015, 0.031))
    coupler = box((-0.01, 0.05, 0.0202), (0.11, 0.07, 0.03)) - hole(0, 0.06, 0.02, 0.03)
    parts["coupler"] = coupler - hole(0.1, 0.06, 0.02, 0.03)
    return known_object(
        "four_bars",
        parts,
        turning("ground", "crank", (0, 0, 1), (0, 0, 0), (-0.5, 0.5)),
        turning("ground", "rocker", (0, 0, 1), (0.1, 0, 0), (-0.5, 0.5)),
        turning("crank", "coupler", (0, 0, 1), (0, 0.06, 0), (-0.5, 0.5)),
    )
