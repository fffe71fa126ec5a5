"""Grippers: parallel jaws on a rail, or fingers on pins around a palm."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import Family
from kinematify.generate.procedural.parameter import counted, length, phrases
from kinematify.generate.procedural.pieces.jaws import add_fingers, add_jaws, finger_palm, jaw_rail

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop


def _build(values: Values, workshop: Workshop) -> None:
    fingers, finger, clearance = values.count("fingers"), values.number("finger"), values.number("clearance")
    half, rest = 0.5 * values.number("width"), values.number("open")
    if fingers == 2:
        workshop.body("palm", *jaw_rail(half))
        add_jaws(workshop, "finger", "palm", half, finger, clearance=clearance, rest=rest)
    else:
        workshop.body("palm", *finger_palm(fingers))
        add_fingers(workshop, "finger", "palm", fingers, finger, clearance=clearance, rest=rest)


FAMILY = Family(
    name="gripper",
    title="gripper",
    words=phrases("gripper, parallel gripper, parallel jaw gripper, claw, robot gripper, grasper"),
    material="metal",
    parameters=(
        counted("fingers", 2, (2, 6), "Two are parallel jaws.", usual=(2, 4), words="finger, jaw"),
        length("width", 0.12, (0.06, 0.5), "Of two jaws.", usual=(0.08, 0.16)),
        length("finger", 0.07, (0.05, 0.3), "Its length.", usual=(0.06, 0.1)),
    ),
    build=_build,
)
