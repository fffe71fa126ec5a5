"""Buckets: a vessel that widens upwards, and a bail that swings on studs at its sides."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.solids import bore, cylinder, ring, turned, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_WALL = 0.003
_BEAD = 0.002  # how far the rim stands out [m]
_BELOW = 0.025  # from the rim down to the studs [m]


def _build(values: Values, workshop: Workshop) -> None:
    radius, height, clearance = 0.5 * values.number("width"), values.number("height"), values.number("clearance")
    wire = values.number("wire")
    stud, level = 1.2 * wire, height - _BELOW
    grip = 2.6 * wire if values.choice("handle") == "grip" else wire
    # The bail moves on a sphere, which has to be outside the rim even where the rim is highest.
    reach = math.hypot(radius + _BEAD + clearance, _BELOW) + wire + 5e-4
    workshop.body("body", _vessel(values))
    bend = (2.4 * stud) ** 2 / reach  # the wire bends inwards above its eyes
    eyes, holes = [], []
    for side in (-1.0, 1.0):
        eye = side * (reach - wire), side * (reach + wire)
        face = side * (reach - wire - clearance - bend)
        boss = cylinder(2.0 * stud, (side * 0.3 * radius, 0, level), (face, 0, level))
        shaft = cylinder(stud, (side * 0.3 * radius, 0, level), (eye[1] + side * (clearance + 1e-4), 0, level))
        head = cylinder(
            1.9 * stud, (eye[1] + side * clearance, 0, level), (eye[1] + side * (clearance + wire), 0, level)
        )
        workshop.add("body", boss, shaft, head)
        eyes.append(cylinder(2.2 * stud, (eye[0], 0, level), (eye[1], 0, level)))
        holes.append(bore(stud, clearance, (side * 0.5 * reach, 0, level), (side * 2.0 * reach, 0, level)))
    workshop.cut("body", _inside(values))
    lies = math.asin(min(0.9, (_BELOW + 1.2 * grip + clearance) / (0.9 * reach)))  # so that the grip is above the rim
    bail = union(*_bail(reach, wire, grip), *(eye.translate((0, 0, -level)) for eye in eyes))
    bail = bail.rotate((90.0 - math.degrees(lies), 0, 0)).translate((0, 0, level)) - union(*holes)
    workshop.body("handle", bail, material="steel")
    swing = (0.0, math.pi - 2.0 * lies)
    workshop.turns("handle", "body", (-1, 0, 0), (0, 0, level), swing, rest=values.number("open"))


def _bail(reach: float, wire: float, grip: float) -> list[Manifold]:
    """A half circle of wire that stands upright over the x axis, with a grip around its top."""
    made = [ring(reach, wire, 180.0)]
    if grip > wire:
        made.append(ring(reach, grip, 50.0).rotate((0, 0, 65.0)))
    return [solid.rotate((90.0, 0, 0)) for solid in made]


def _profile(values: Values, inset: float, bottom: float, top: float) -> list[tuple[float, float]]:
    radius = 0.5 * values.number("width")
    foot = values.number("taper") * radius
    return [(0.0, bottom), (foot - inset, bottom), (radius - inset, top), (0.0, top)]


def _inside(values: Values) -> Manifold:
    return turned(_profile(values, _WALL, _WALL, values.number("height") + 1e-4))


def _vessel(values: Values) -> Manifold:
    """Solid as yet; the studs reach into it."""
    radius, height = 0.5 * values.number("width"), values.number("height")
    bead = cylinder(radius + _BEAD, (0, 0, height - 0.006), (0, 0, height))
    return turned(_profile(values, 0.0, 0.0, height)) + bead


FAMILY = family("bucket", _build)
