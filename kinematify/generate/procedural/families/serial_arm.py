"""Robot arms: a foot and any number of joints that turn about the upright and across it in turn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import at, stub
from kinematify.generate.procedural.pieces.jaws import add_fingers, add_jaws, finger_palm, jaw_rail
from kinematify.generate.procedural.solids import box, cylinder, off

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.solids import Point
    from kinematify.generate.procedural.workshop import Workshop


_HALF, _FINGER = 0.06, 0.07  # of a gripper: half the way of its jaws, length of its fingers [m]


def _build(values: Values, workshop: Workshop) -> None:
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


FAMILY = family("serial_arm", _build)
