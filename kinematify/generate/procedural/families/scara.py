"""SCARA robots: two upright hinges, a spindle that goes up and down, and a tool that turns on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.solids import box, cylinder, hull, union

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop


def _build(values: Values, workshop: Workshop) -> None:
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


FAMILY = family("scara", _build)
