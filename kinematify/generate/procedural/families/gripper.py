"""Grippers: parallel jaws on a rail, or fingers on pins around a palm."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
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


FAMILY = family("gripper", _build)
