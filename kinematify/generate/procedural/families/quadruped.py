"""Robots on four legs: a trunk and legs of two or three joints on flanged stubs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.limbs import leg_solids
from kinematify.generate.procedural.solids import box, cylinder, off

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_LEGS = {"front_left": (1, 1), "front_right": (1, -1), "rear_left": (-1, 1), "rear_right": (-1, -1)}


def _build(values: Values, workshop: Workshop) -> None:
    half, wide, radius = 0.5 * values.number("length"), 0.5 * values.number("width"), values.number("joint_radius")
    lengths = values.number("thigh"), values.number("shank")
    high = lengths[0] + lengths[1] + 0.5 * radius
    workshop.body(
        "trunk",
        box((-half, -wide, high - 1.3 * radius), (half, wide, high + 1.7 * radius)),
        box((half - 0.05, -0.03, high + radius), (half + 0.03, 0.03, high + 2.7 * radius)),
    )
    for leg, side in _LEGS.items():
        hip = np.array([side[0] * (half + 0.02), side[1] * (wide - radius), high])
        boss, hole, links, pivots = leg_solids(hip, side, radius, lengths, values.number("clearance"))
        workshop.add("trunk", boss)
        workshop.cut("trunk", hole)
        _add_leg(
            workshop, leg, links, pivots, side, radius=radius, swings=_swings(values), three=values.count("joints") > 2
        )


def _swings(values: Values) -> tuple[float, float, float]:
    """How far hips roll inwards, and thighs and shanks swing, until two legs could meet [rad]."""
    shank = values.number("shank")
    leg = values.number("thigh") + shank
    beside = 0.5 * values.number("width")  # from the hip to half the way to the other side
    between = values.number("length") + 0.04  # of the legs in front and behind
    thigh = math.asin(min(math.sin(0.8), between / leg))
    return min(0.2, beside / leg), thigh, math.asin(min(math.sin(1.2), between / shank))


def _add_leg(
    workshop: Workshop,
    leg: str,
    links: Mapping[str, Manifold],
    pivots: Sequence[FloatArray],
    side: tuple[int, int],
    *,
    radius: float,
    swings: tuple[float, float, float],
    three: bool,
) -> None:
    above, (roll, thigh, shank) = "trunk", swings
    if three:
        workshop.body(f"{leg}_hip", links["hip"])
        workshop.turns(f"{leg}_hip", "trunk", (1, 0, 0), pivots[0], (-roll, 0.5) if side[1] > 0 else (-0.5, roll))
        above = f"{leg}_hip"
    else:
        hip = pivots[0]
        workshop.add("trunk", links["hip"], cylinder(radius, off(hip, -radius, 0, 0), off(hip, radius, 0, 0)))
    workshop.body(f"{leg}_thigh", links["thigh"])
    workshop.turns(f"{leg}_thigh", above, (0, 1, 0), pivots[1], (-thigh, thigh))
    workshop.body(f"{leg}_shank", links["shank"])
    workshop.turns(f"{leg}_shank", f"{leg}_thigh", (0, 1, 0), pivots[2], (-shank, shank))


FAMILY = family("quadruped", _build)
