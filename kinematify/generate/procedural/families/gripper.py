"""Grippers: parallel jaws on a rail, or fingers on pins around a palm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import Family, Parameter
from kinematify.generate.procedural.pieces.bearings import fork, room
from kinematify.generate.procedural.solids import box, cylinder, union

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop


def _build(values: Values, workshop: Workshop) -> None:
    if values.count("fingers") == 2:
        _parallel(values, workshop)
    else:
        _radial(values, workshop)


def _parallel(values: Values, workshop: Workshop) -> None:
    """Two mirrored jaws on one square rail; zero is shut, positive opens."""
    half, clearance = 0.5 * values.number("width"), values.number("clearance")
    bar, thick, level = 0.006, 0.016, 0.095
    inner = bar + clearance
    palm = [
        box((-half - 0.012, -0.03, 0.04), (half + 0.012, 0.03, 0.07)),
        cylinder(0.025, (0, 0, 0), (0, 0, 0.041)),
        box((-half - 0.001, -bar, level - bar), (half + 0.001, bar, level + bar)),
    ]
    for sign in (-1, 1):
        x0, x1 = sorted((sign * half, sign * (half + 0.012)))
        palm.append(box((x0, -0.03, 0.069), (x1, 0.03, level + 2 * bar)))
    workshop.body("palm", *palm)
    slide = box((clearance, -0.02, 0.07 + clearance), (thick, 0.02, level + 3 * bar))
    slide -= box((-1, -inner, level - inner), (1, inner, level + inner))
    jaw = union(slide, box((clearance, -0.008, level + 2.9 * bar), (0.008, 0.008, level + values.number("finger"))))
    travel = half - thick - clearance
    rest = values.number("open")
    for number, (sign, solid) in enumerate(((1, jaw), (-1, jaw.mirror((1, 0, 0)))), start=1):
        name = f"finger_{number}"
        workshop.body(name, solid)
        workshop.slides(name, "palm", (sign, 0, 0), (0, 0, level), (0.0, travel), rest=rest)


def _radial(values: Values, workshop: Workshop) -> None:
    """Fingers on pins around a round palm; zero is straight, positive opens."""
    fingers, long = values.count("fingers"), values.number("finger")
    wide, radius = 0.02, 0.007
    clearance = min(values.number("clearance"), 8e-4)
    ring = max(0.04, 0.02 * fingers)
    level = 0.06
    workshop.body(
        "palm",
        cylinder(ring + radius, (0, 0, 0.02), (0, 0, level - 2 * radius)),
        cylinder(0.025, (0, 0, 0), (0, 0, 0.021)),
    )
    start = room(radius, clearance)
    for k in range(fingers):
        angle = 360.0 * k / fingers
        forked, tongue = (
            solid.translate((0, -ring, level)).rotate((0, 0, angle))
            for solid in fork(wide, radius, clearance, 2.2 * radius)
        )
        blade = box((-0.5 * wide, -radius, start), (0.5 * wide, radius, long))
        tip = cylinder(radius, (-0.5 * wide, 0, long), (0.5 * wide, 0, long))
        workshop.add("palm", forked)
        name = f"finger_{k + 1}"
        workshop.body(name, tongue, (blade + tip).translate((0, -ring, level)).rotate((0, 0, angle)))
        axis, pivot = _turned((1.0, 0.0, 0.0), angle), _turned((0.0, -ring, level), angle)
        workshop.turns(name, "palm", axis, pivot, (0.0, 1.2), rest=values.number("open"))


def _turned(point: tuple[float, float, float], angle: float) -> tuple[float, float, float]:
    """Turn a point about z by an angle [deg]."""
    x, y, z = point
    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return (cosine * x - sine * y, sine * x + cosine * y, z)


FAMILY = Family(
    name="gripper",
    title="gripper",
    words=("gripper", "parallel gripper", "parallel jaw gripper", "claw", "robot gripper", "grasper"),
    material="metal",
    parameters=(
        Parameter(
            name="fingers",
            default=2,
            bounds=(2, 6),
            usual=(2, 4),
            words=("finger", "jaw"),
            help="Two are parallel jaws.",
        ),
        Parameter(name="width", default=0.12, unit="m", bounds=(0.06, 0.5), usual=(0.08, 0.16), help="Of two jaws."),
        Parameter(name="finger", default=0.07, unit="m", bounds=(0.05, 0.3), usual=(0.06, 0.1), help="Its length."),
    ),
    build=_build,
)
