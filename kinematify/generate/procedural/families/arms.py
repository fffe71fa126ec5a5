"""Robot arms, and what they grasp with."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import at, fork, room, stub
from kinematify.generate.procedural.pieces.jaws import add_fingers, add_jaws, finger_palm, jaw_rail
from kinematify.generate.procedural.solids import box, cylinder, hull, off, union

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.solids import Point
    from kinematify.generate.procedural.workshop import Workshop


_HALF, _FINGER = 0.06, 0.07  # of a gripper: half the way of its jaws, length of its fingers [m]


def build_serial_arm(values: Values, workshop: Workshop) -> None:
    """Robot arms: a foot and any number of joints that turn about the upright and across it in turn."""
    joints, size, clearance = values.count("joints"), values.number("radius"), values.number("clearance")
    reach = values.number("length") / max(joints, 1) - 3.0 * size
    parent, side = "foot", 1.0
    workshop.body(
        parent,
        box((-3 * size, -2 * size, 0), (2 * size, 2 * size, 0.02)),
        cylinder(size, (0, 0, 0.01), (0, 0, 0.02 + 1.1 * size)),
    )
    tip = np.array([0.0, 0.0, 0.02 + size])
    for k in range(joints):
        name = f"link_{k + 1}"
        upright = k % 2 == 0
        pivot = off(tip, 0, 0, size) if upright else off(tip, 0, side * size, 0.5 * size)
        axis = np.array([0.0, 0.0, 1.0] if upright else [0.0, side, 0.0])
        boss, hole, rotor = stub(pivot, axis, size, clearance, length=size if upright else 2 * size)
        workshop.add(parent, boss)
        workshop.cut(parent, hole)
        tip = pivot + (size + clearance) * axis
        solids = [rotor]
        if not upright:
            solids.append(cylinder(size, tip, tip + size * axis))
            side = -side
        end = off(tip, 0, 0, max(reach, 2.5 * size))
        workshop.body(name, *solids, cylinder(0.75 * size, tip, end))
        limits = (-2.8, 2.8) if upright else (-1.7, 1.7)
        workshop.turns(name, parent, (0, 0, 1) if upright else (0, 1, 0), pivot, limits)
        tip, parent = end, name
    workshop.add(parent, box(tip - 0.8 * size, off(tip, 1.2 * size, 0.8 * size, 0.2 * size)))
    _add_gripper(values, workshop, parent, off(tip, 0, 0, 0.2 * size - 1e-3))


def _add_gripper(values: Values, workshop: Workshop, flange: str, place: Point) -> None:
    kind, fingers = values.choice("gripper"), values.count("fingers")
    if kind == "none":
        return
    frame = workshop.from_frame(at(place))
    clearance, rest = values.number("clearance"), values.number("open")
    if kind == "jaws" or fingers == 2:
        frame.add(flange, *jaw_rail(_HALF))
        add_jaws(frame, "finger", flange, _HALF, _FINGER, clearance=clearance, rest=rest)
    else:
        frame.add(flange, *finger_palm(fingers))
        add_fingers(frame, "finger", flange, fingers, _FINGER, clearance=clearance, rest=rest)


def build_scara(values: Values, workshop: Workshop) -> None:
    """SCARA robots: two upright hinges, a spindle that goes up and down, and a tool that turns on it."""
    upper, fore, high = values.number("upper_arm"), values.number("forearm"), values.number("height")
    clearance, stroke = values.number("clearance"), values.number("stroke")
    size, thick = 0.06, 0.05
    pivot = (0.0, 0.0, high)
    boss, hole, rotor = stub(pivot, (0, 0, 1), size, clearance)
    workshop.body(
        "column", box((-0.12, -0.12, 0), (0.12, 0.12, 0.03)), cylinder(size, (0, 0, 0.02), (0, 0, high)), boss
    )
    workshop.cut("column", hole)

    low = high + clearance
    elbow = (upper, 0.0, low + thick)
    boss, hole, second = stub(elbow, (0, 0, 1), size, clearance, length=thick)
    beam = hull(*(cylinder(size, (x, 0, low), (x, 0, low + thick)) for x in (0.0, upper)))
    workshop.body("upper_arm", rotor, beam, boss)
    workshop.cut("upper_arm", hole)
    workshop.turns("upper_arm", "column", (0, 0, 1), pivot, (-2.2, 2.2))

    # A square spindle slides in the forearm's head, which ends before the upper arm begins.
    start, half = elbow[2] + clearance, 0.016
    x = upper + fore
    room = half + clearance
    arm = hull(*(cylinder(size, (at, 0, start), (at, 0, start + thick)) for at in (upper, x)))
    head = cylinder(0.7 * size, (x, 0, start - 0.02), (x, 0, start + thick + 0.06))
    workshop.body("forearm", second, arm, head)
    workshop.cut("forearm", box((x - room, -room, start - 1), (x + room, room, start + 1)))
    workshop.turns("forearm", "upper_arm", (0, 0, 1), elbow, (-2.0, 2.0))

    bottom, top = start - 0.06, start + thick + 0.09 + stroke
    spindle = box((x - half, -half, bottom), (x + half, half, top))
    cap = cylinder(0.03, (x, 0, top - 1e-3), (x, 0, top + 0.01))
    tip = (x, 0.0, bottom)
    _, hole, tool = stub(tip, (0, 0, -1), 0.024, clearance)
    collar = cylinder(0.024, (x, 0, bottom), (x, 0, bottom + 0.03))
    workshop.body("spindle", spindle, cap, collar)
    workshop.cut("spindle", hole)
    workshop.slides("spindle", "forearm", (0, 0, -1), tip, (0.0, stroke))
    plate = box((x - 0.03, -0.02, bottom - 0.05), (x + 0.045, 0.02, bottom - 0.022))
    workshop.body("tool", union(tool, plate))
    workshop.turns("tool", "spindle", (0, 0, 1), tip, (-3.1, 3.1))


_BAR = 0.02
"""Half the width of a rail [m]."""


def build_gantry(values: Values, workshop: Workshop) -> None:
    """Gantries: a bridge along a bed, a carriage along the bridge, a ram up and down; each on rails."""
    wide, deep, high = values.number("width"), values.number("depth"), values.number("height")
    gap, tall = values.number("clearance"), 0.06
    inner = _BAR + gap
    bed = [box((-0.5 * wide, -0.5 * deep, 0), (0.5 * wide, 0.5 * deep, 0.05))]
    rails = [(sign * (0.5 * wide - 2 * _BAR)) for sign in (-1, 1)]
    for x in rails:
        bed.append(box((x - _BAR, -0.5 * deep, 0.04), (x + _BAR, 0.5 * deep, 0.05 + tall)))
        for y0, y1 in ((-0.5 * deep, -0.5 * deep + 0.02), (0.5 * deep - 0.02, 0.5 * deep)):
            bed.append(box((x - 1.5 * _BAR, y0, 0.04), (x + 1.5 * _BAR, y1, 0.07 + tall)))
    workshop.body("bed", *bed)

    foot, top = 0.12, high
    shoes = [
        box((x - 2 * _BAR, -0.5 * foot, 0.05 + gap), (x + 2 * _BAR, 0.5 * foot, 0.05 + tall + 0.04))
        - box((x - inner, -1, 0), (x + inner, 1, 0.05 + tall + gap))
        for x in rails
    ]
    posts = [box((x - _BAR, -0.03, 0.05 + tall + 0.03), (x + _BAR, 0.03, top)) for x in rails]
    beam = box((rails[0], -_BAR, top - 2 * _BAR), (rails[1], _BAR, top))
    workshop.body("bridge", *shoes, *posts, beam)
    travel = deep - 0.04 - foot - 2e-3
    workshop.slides("bridge", "bed", (0, 1, 0), (0, 0, 0.1), (-0.5 * travel, 0.5 * travel))

    half = 0.07
    carriage = box((-half, -0.06, top - 2 * _BAR - 0.03), (half, 0.06, top + 0.03))
    carriage -= box((-1, -inner, top - 2 * _BAR - gap), (1, inner, top + gap))
    room = 0.015 + gap
    tower = box((-0.04, -0.13, top - 2 * _BAR - 0.03), (0.04, -0.05, top + 0.03))
    tower -= box((-room, -0.09 - room, 0), (room, -0.09 + room, 2 * high))
    workshop.body("carriage", union(carriage, tower))
    reach = 0.5 * (rails[1] - rails[0]) - _BAR - half - 2e-3
    workshop.slides("carriage", "bridge", (1, 0, 0), (0, 0, top), (-reach, reach))

    low = top - 2 * _BAR - 0.08
    stroke = low - 0.12
    ram = box((-0.015, -0.105, low), (0.015, -0.075, top + 0.08 + stroke))
    cap = box((-0.03, -0.12, top + 0.08 + stroke - 1e-3), (0.03, -0.06, top + 0.1 + stroke))
    tool = cylinder(0.02, (0, -0.09, low - 0.03), (0, -0.09, low + 1e-3))
    workshop.body("ram", ram, cap, tool)
    workshop.slides("ram", "carriage", (0, 0, -1), (0, -0.09, low), (0.0, stroke))


def build_gripper(values: Values, workshop: Workshop) -> None:
    """Grippers: parallel jaws on a rail, or fingers on pins around a palm."""
    fingers, finger, clearance = values.count("fingers"), values.number("finger"), values.number("clearance")
    half, rest = 0.5 * values.number("width"), values.number("open")
    if fingers == 2:
        workshop.body("palm", *jaw_rail(half))
        add_jaws(workshop, "finger", "palm", half, finger, clearance=clearance, rest=rest)
    else:
        workshop.body("palm", *finger_palm(fingers))
        add_fingers(workshop, "finger", "palm", fingers, finger, clearance=clearance, rest=rest)


_SHARES = (1.0, 0.72, 0.62)
"""Length of a phalanx beside the first one."""


def build_hand(values: Values, workshop: Workshop) -> None:
    """Robot hands: a palm with fingers of phalanges on pins, straight at zero."""
    fingers, phalanges = values.count("fingers"), values.count("joints")
    long, wide = values.number("phalanx"), values.number("finger_width")
    clearance, rest = min(values.number("clearance"), 0.04 * wide), values.number("open")
    radius, pitch = 0.4 * wide, 1.4 * wide
    half = 0.5 * pitch * fingers
    level = 0.09
    workshop.body(
        "palm",
        box((-half, -radius, 0), (half, radius, level - 2 * radius)),
        cylinder(1.5 * radius, (0, 0, -0.04), (0, 0, 0.01)),
    )
    for finger in range(fingers):
        x, z, parent = (finger - 0.5 * (fingers - 1)) * pitch, level, "palm"
        for k in range(phalanges):
            name = f"finger_{finger + 1}_{k + 1}"
            forked, tongue = (solid.translate((x, 0, z)) for solid in fork(wide, radius, clearance, 2.2 * radius))
            workshop.add(parent, forked)
            length = max(long * _SHARES[min(k, 2)], 6.0 * radius)
            top = z + length - (2 * radius if k + 1 < phalanges else radius)
            solids = [
                tongue,
                box((x - 0.5 * wide, -radius, z + room(radius, clearance)), (x + 0.5 * wide, radius, top)),
            ]
            if k + 1 == phalanges:
                solids.append(cylinder(radius, (x - 0.5 * wide, 0, top), (x + 0.5 * wide, 0, top)))
            workshop.body(name, *solids)
            workshop.turns(name, parent, (1, 0, 0), (x, 0, z), (0.0, 1.5), rest=rest)
            parent, z = name, z + length
