"""What grips: parallel jaws on a rail, and fingers on pins around a palm. Both stand on z = 0 and reach up."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.pieces.bearings import fork, fork_room
from kinematify.generate.procedural.solids import box, cylinder, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.workshop import Workshop

_BAR = 0.006  # half the side of the square rail [m]
_RAIL = 0.095  # height of its middle [m]
_JAW = 0.016  # length of a jaw along the rail [m]
_FINGER = 0.007  # half the thickness of a finger [m]
_KNUCKLE = 0.06  # height of the pins of fingers [m]


def jaw_rail(half: float) -> list[Manifold]:
    """Return the solids of a palm with a rail along x on which two jaws run, as far as `half` to either side [m]."""
    solids = [
        box((-half - 0.012, -0.03, 0.04), (half + 0.012, 0.03, 0.07)),
        cylinder(0.025, (0, 0, 0), (0, 0, 0.041)),
        box((-half - 0.001, -_BAR, _RAIL - _BAR), (half + 0.001, _BAR, _RAIL + _BAR)),
    ]
    for sign in (-1, 1):
        x0, x1 = sorted((sign * half, sign * (half + 0.012)))
        solids.append(box((x0, -0.03, 0.069), (x1, 0.03, _RAIL + 2 * _BAR)))
    return solids


def add_jaws(
    workshop: Workshop, name: str, palm: str, half: float, finger: float, *, clearance: float, rest: float = 0.0
) -> None:
    """Add two mirrored jaws, `name`_1 and `name`_2, to a palm with a `jaw_rail`; zero is shut, positive opens.

    Args:
        workshop: Where they are added.
        name: Of both, without their numbers.
        palm: The body with the rail.
        half: As in `jaw_rail` [m].
        finger: How far they reach beyond the rail [m].
        clearance: Around the rail [m].
        rest: Share of the way that they stand open.
    """
    inner = _BAR + clearance
    slide = box((clearance, -0.02, 0.07 + clearance), (_JAW, 0.02, _RAIL + 3 * _BAR))
    slide -= box((-1, -inner, _RAIL - inner), (1, inner, _RAIL + inner))
    jaw = union(slide, box((clearance, -0.008, _RAIL + 2.9 * _BAR), (0.008, 0.008, _RAIL + finger)))
    travel = half - _JAW - clearance
    for number, (sign, solid) in enumerate(((1, jaw), (-1, jaw.mirror((1, 0, 0)))), start=1):
        workshop.body(f"{name}_{number}", solid)
        workshop.slides(f"{name}_{number}", palm, (sign, 0, 0), (0, 0, _RAIL), (0.0, travel), rest=rest)


def finger_palm(fingers: int) -> list[Manifold]:
    """Return the solids of a round palm with room for fingers around it."""
    return [
        cylinder(_ring(fingers) + _FINGER, (0, 0, 0.02), (0, 0, _KNUCKLE - 2 * _FINGER)),
        cylinder(0.025, (0, 0, 0), (0, 0, 0.021)),
    ]


def add_fingers(
    workshop: Workshop, name: str, palm: str, count: int, finger: float, *, clearance: float, rest: float = 0.0
) -> None:
    """Add fingers to a `finger_palm`; zero is straight, positive opens; others as for `add_jaws`."""
    clearance = min(clearance, 8e-4)
    wide, ring, start = 0.02, _ring(count), fork_room(_FINGER, clearance)
    for k in range(count):
        angle = 360.0 * k / count
        forked, tongue = (
            solid.translate((0, -ring, _KNUCKLE)).rotate((0, 0, angle))
            for solid in fork(wide, _FINGER, clearance, 2.2 * _FINGER)
        )
        blade = box((-0.5 * wide, -_FINGER, start), (0.5 * wide, _FINGER, finger))
        tip = cylinder(_FINGER, (-0.5 * wide, 0, finger), (0.5 * wide, 0, finger))
        workshop.add(palm, forked)
        workshop.body(f"{name}_{k + 1}", tongue, (blade + tip).translate((0, -ring, _KNUCKLE)).rotate((0, 0, angle)))
        axis, pivot = _turned((1.0, 0.0, 0.0), angle), _turned((0.0, -ring, _KNUCKLE), angle)
        workshop.turns(f"{name}_{k + 1}", palm, axis, pivot, (0.0, 1.2), rest=rest)


def _ring(fingers: int) -> float:
    return max(0.04, 0.02 * fingers)


def _turned(point: tuple[float, float, float], angle: float) -> tuple[float, float, float]:
    """Turn a point about z by an angle [deg]."""
    x, y, z = point
    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return (cosine * x - sine * y, sine * x + cosine * y, z)
