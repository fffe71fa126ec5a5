"""Faucets: a lever that turns and lifts, handles that twist, or a spout that swivels."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import fork, room, stub
from kinematify.generate.procedural.solids import box, cylinder, off, rod, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.solids import Point
    from kinematify.generate.procedural.workshop import Workshop

_PLATE = 0.01  # thickness of the base plate [m]


def _build(values: Values, workshop: Workshop) -> None:
    {"lever": _lever, "twist": _twist, "swivel": _swivel}[values.choice("handle")](values, workshop)


def _spout(radius: float, foot: Point, rise: float, reach: float) -> Manifold:
    """A pipe that rises, bends forward over a half circle and ends above its outlet."""
    bend = 0.5 * reach
    arc = [
        off(foot, 0, -bend * (1.0 - math.cos(math.radians(a))), rise + bend * math.sin(math.radians(a)))
        for a in range(0, 151, 25)
    ]
    points = [foot, *arc]
    return union(*(rod(radius, one, two) for one, two in pairwise(points)))


def _lever(values: Values, workshop: Workshop) -> None:
    """A cartridge on the post turns, and the lever on it lifts."""
    radius, clearance, rest = values.number("pipe"), values.number("clearance"), values.number("open")
    post, top = 1.8 * radius, values.number("height")
    outlet = [rod(radius, (0, 0, 0.62 * top), (0, -values.number("reach"), 0.7 * top))]
    boss, hole, rotor = stub((0, 0, top), (0, 0, 1), post, clearance, length=1.2 * radius)
    plate = cylinder(2.6 * radius, (0, 0, 0), (0, 0, _PLATE))
    workshop.body("body", plate, cylinder(post, (0, 0, 0), (0, 0, top)), boss, *outlet)
    workshop.cut("body", hole)
    small, gap = 0.6 * radius, min(clearance, 0.2 * radius)
    hinge = top + clearance + 1.2 * radius + room(small, gap) + 0.5 * small
    forked, tongue = (s.translate((0, 0, hinge)) for s in fork(2.6 * radius, small, gap, hinge - top - 1.2 * radius))
    workshop.body("cartridge", rotor, forked)
    handle = rod(small, (0, 0, hinge + 2.0 * small), (0, -0.9 * values.number("reach"), hinge + 3.5 * small))
    workshop.body("lever", tongue, handle)
    workshop.turns("cartridge", "body", (0, 0, 1), (0, 0, top), (-0.8, 0.8))
    workshop.turns("lever", "cartridge", (-1, 0, 0), (0, 0, hinge), (0.0, 0.5), rest=rest)


def _twist(values: Values, workshop: Workshop) -> None:
    """Cross handles on posts beside the spout, or one on its top."""
    radius, clearance, rest = values.number("pipe"), values.number("clearance"), values.number("open")
    count, height = values.count("handles"), values.number("height")
    half = 5.5 * radius
    places = {1: (half,), 2: (-half, half)}[count]
    plate = box((-1.35 * half, -2.2 * radius, 0), (1.35 * half, 2.2 * radius, _PLATE))
    rise = height - 0.5 * values.number("reach") - radius - _PLATE
    pipe = _spout(radius, (0, 0, 0.5 * _PLATE), max(rise, 3.0 * radius), values.number("reach"))
    workshop.body("body", plate, pipe.trim_by_plane((0, 0, 1), 0.0))
    top = _PLATE + 4.0 * radius
    for k, x in enumerate(places):
        boss, hole, rotor = stub((x, 0, top), (0, 0, 1), 1.4 * radius, clearance, length=2.0 * radius)
        workshop.add("body", boss, cylinder(1.4 * radius, (x, 0, 0.5 * _PLATE), (x, 0, top)))
        workshop.cut("body", hole)
        level = top + clearance + 1.6 * radius
        arms = [rod(0.5 * radius, (x - 2.6 * radius, 0, level), (x + 2.6 * radius, 0, level))]
        if values.choice("cross") == "cross":
            arms.append(rod(0.5 * radius, (x, -2.6 * radius, level), (x, 2.6 * radius, level)))
        workshop.body(f"handle_{k + 1}", rotor, *arms)
        workshop.turns(f"handle_{k + 1}", "body", (0, 0, 1), (x, 0, top), (0.0, 1.5 * math.pi), rest=rest)


def _swivel(values: Values, workshop: Workshop) -> None:
    """A high spout that swivels on the post, and a lever at the post's side."""
    radius, clearance, rest = values.number("pipe"), values.number("clearance"), values.number("open")
    post, top = 1.7 * radius, 7.0 * radius
    plate = cylinder(2.6 * radius, (0, 0, 0), (0, 0, _PLATE))
    boss, hole, rotor = stub((0, 0, top), (0, 0, 1), post, clearance, length=1.5 * radius)
    side = (2.6 * radius, 0, 4.0 * radius)
    side_boss, side_hole, side_rotor = stub(side, (1, 0, 0), 1.2 * radius, clearance, length=1.5 * radius)
    workshop.body("body", plate, cylinder(post, (0, 0, 0), (0, 0, top)), boss, side_boss)
    workshop.cut("body", hole, side_hole)
    foot = (0, 0, top + clearance + radius)
    rise = values.number("height") - foot[2] - 0.5 * values.number("reach") - radius
    workshop.body("spout", rotor, _spout(radius, foot, max(rise, 2.0 * radius), values.number("reach")))
    tip = off(side, clearance + 0.9 * radius, 0, 0)
    lever = rod(0.55 * radius, tip, off(tip, 2.0 * radius, -0.6 * radius, 5.0 * radius))
    workshop.body("lever", side_rotor, lever)
    workshop.turns("spout", "body", (0, 0, 1), (0, 0, top), (-2.0, 2.0))
    workshop.turns("lever", "body", (1, 0, 0), side, (0.0, 1.0), rest=rest)


FAMILY = family("faucet", _build)
