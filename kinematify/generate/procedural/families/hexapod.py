"""Robots on six legs, or four to eight, that stand around a round trunk."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import at
from kinematify.generate.procedural.pieces.limbs import leg_solids
from kinematify.generate.procedural.solids import ball, cylinder, off

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_OUTWARDS = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
"""Turns a leg that hangs down, its first joint along x, so that it reaches out along x, that joint upright."""


def _build(values: Values, workshop: Workshop) -> None:
    radius, clearance, count = values.number("joint_radius"), values.number("clearance"), values.count("legs")
    lengths = values.number("femur"), values.number("tibia")
    high = lengths[1] - 1.5 * radius - clearance  # of the pivots in the trunk, so that the feet stand on the floor
    ring = max(0.5 * values.number("trunk"), 3.5 * radius / math.sin(math.pi / count))  # else coxae meet
    plate = (0, 0, high - 1.4 * radius), (0, 0, high - 0.2 * radius)
    workshop.body(
        "trunk",
        cylinder(ring + 0.4 * radius, *plate),
        ball(0.5 * ring, (0, 0, high - 0.2 * radius)).trim_by_plane((0, 0, 1), high - radius),
    )
    for k in range(count):
        angle = 2.0 * math.pi * (k + 0.5) / count
        cosine, sine = math.cos(angle), math.sin(angle)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        place = at((ring * cosine, ring * sine, high), turn @ _OUTWARDS)
        _add_leg(values, workshop, f"leg_{k + 1}", place)


def _add_leg(values: Values, workshop: Workshop, leg: str, place: FloatArray) -> None:
    """A coxa on an upright joint, a femur that reaches out and a tibia that reaches down."""
    radius, clearance = values.number("joint_radius"), values.number("clearance")
    lengths = values.number("femur"), values.number("tibia")
    boss, hole, links, pivots = leg_solids(np.zeros(3), (1, 1), radius, lengths, clearance)
    knee = pivots[2]
    links["shank"] = links["shank"].translate(-knee).rotate((0, 90, 0)).translate(knee)
    coxa, femur, tibia = (links[name].transform(place) for name in ("hip", "thigh", "shank"))
    upright, *others = (place @ (*pivot, 1.0) for pivot in pivots)
    workshop.add("trunk", boss.transform(place))
    workshop.cut("trunk", hole.transform(place))
    above, across = "trunk", -place[:, 1]
    if values.count("joints") > 2:
        above = f"{leg}_coxa"
        workshop.body(above, coxa)
        workshop.turns(above, "trunk", (0, 0, 1), upright, (-0.3, 0.3))
    else:
        workshop.add("trunk", coxa, cylinder(radius, off(upright, 0, 0, -radius), off(upright, 0, 0, radius)))
    workshop.body(f"{leg}_femur", femur)
    workshop.turns(f"{leg}_femur", above, across, others[0], (-0.3, 0.8))
    workshop.body(f"{leg}_tibia", tibia)
    workshop.turns(f"{leg}_tibia", f"{leg}_femur", across, others[1], (-0.35, 0.9))


FAMILY = family("hexapod", _build)
