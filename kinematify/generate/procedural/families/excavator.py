"""Excavators: a house on tracks, a boom, a stick and a bucket on pins."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import bent_fork, room
from kinematify.generate.procedural.pieces.tracks import Tracks, add_tracks, add_turntable
from kinematify.generate.procedural.solids import box, cylinder, hull, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_LEANS = (0.0, 0.45, 1.25, 2.3, 2.7)
"""Of the house, the boom below and above its bend, the stick and the bucket: from the upright to the front [rad]."""
_SWINGS = {"boom": (-0.35, 0.3), "stick": (-0.3, 0.8), "bucket": (-0.8, 0.9)}
"""Positive upwards [rad]."""


def _build(values: Values, workshop: Workshop) -> None:
    tracks = Tracks(length=values.number("length"), width=values.number("width"), clearance=values.number("clearance"))
    add_tracks(workshop, "tracks", tracks, wheels=values.count("wheels"))
    add_turntable(workshop, "house", "tracks", tracks)
    pivot, radius = _add_house(values, workshop, tracks)
    _add_arm(values, workshop, pivot, radius)


def _add_house(values: Values, workshop: Workshop, tracks: Tracks) -> tuple[FloatArray, float]:
    """Platform, cab, engine and counterweight; returns the boom's pin and the radius of its knuckles."""
    half, long, low = 0.46 * tracks.width, 0.5 * tracks.length, tracks.top - 0.2 * tracks.ring
    thick = 0.12 * tracks.length
    top = low + thick
    radius = min(0.055 * tracks.width, 0.05 * tracks.length)
    cab = 0.42 * tracks.length
    workshop.add(
        "house",
        box((-half, -0.8 * long, low), (half, long, top)),
        box((-half, -0.75 * long, top - 1e-3), (-0.2 * tracks.width, 0.1 * long, top + cab)),
        box((-half, 0.25 * long, top - 1e-3), (half, 0.7 * long, top + 0.6 * cab)),
        cylinder(min(half, 0.5 * long), (0, 0.55 * long, low), (0, 0.55 * long, top + 0.4 * cab)),
    )
    window = box((-2.0, -0.68 * long, top + 0.45 * cab), (-half + 0.01, 0.02 * long, top + 0.92 * cab))
    front = box((-0.95 * half, -2.0, top + 0.45 * cab), (-0.23 * tracks.width, -0.75 * long + 0.01, top + 0.92 * cab))
    workshop.cut("house", window, front)
    return np.array([0.0, -0.7 * long, top + 1.9 * radius]), radius


def _along(lean: float) -> FloatArray:
    return np.array([0.0, -math.sin(lean), math.cos(lean)])


def _add_arm(values: Values, workshop: Workshop, pivot: FloatArray, radius: float) -> None:
    """Boom, stick and bucket, one after the other."""
    clearance, boom, stick, rest = (values.number(name) for name in ("clearance", "boom", "stick", "open"))
    lengths = {"boom": boom, "stick": stick}
    parent, below = "house", _LEANS[0]
    for name, above in (("boom", _LEANS[1]), ("stick", _LEANS[3]), ("bucket", _LEANS[4])):
        forked, tongue = bent_fork(pivot, (below, above), 2.6 * radius, radius, clearance)
        workshop.add(parent, forked)
        if name == "bucket":
            scoop = _scoop(values, radius, room(radius, 0.15 * radius))
            workshop.body(name, tongue, scoop.rotate((math.degrees(above), 0, 0)).translate(pivot))
            end, last = pivot, above
        else:
            last = _LEANS[2] if name == "boom" else above
            bend = pivot + 0.5 * lengths[name] * _along(above)
            end = bend + 0.5 * lengths[name] * _along(last)
            start, stop = pivot + 2.2 * radius * _along(above), end - 2.3 * radius * _along(last)
            thick = 1.5 * radius if name == "boom" else radius
            beams = _beam(start, bend, radius, thick), _beam(bend, stop, radius, thick, swap=True)
            workshop.body(name, tongue, *beams)
        workshop.turns(name, parent, (-1, 0, 0), pivot, _SWINGS[name], rest=rest)
        parent, below, pivot = name, last, end


def _beam(start: FloatArray, end: FloatArray, radius: float, thick: float, *, swap: bool = False) -> Manifold:
    """A beam between two points, `thick` at its bend and as thick as a knuckle at the other end."""
    first, second = (thick, 0.9 * radius) if swap else (0.9 * radius, thick)
    x = np.array([1.2 * radius, 0.0, 0.0])
    return hull(cylinder(first, start - x, start + x, segments=24), cylinder(second, end - x, end + x, segments=24))


def _scoop(values: Values, radius: float, start: float) -> Manifold:
    """A bucket above the origin, open towards -y, with teeth."""
    size, half = values.number("bucket"), 0.45 * values.number("bucket")
    outer, wall = 0.42 * size, 0.03 * size
    centre = start + outer
    shell = cylinder(outer, (-half, 0, centre), (half, 0, centre))
    shell -= cylinder(outer - wall, (wall - half, 0, centre), (half - wall, 0, centre))
    shell = shell.trim_by_plane((0, 1, 0), -0.3 * outer)
    lip = centre + math.sqrt(outer**2 - (0.3 * outer) ** 2)
    teeth = [
        box((x - 0.05 * size, -0.65 * outer, lip - 1.2 * wall), (x + 0.05 * size, -0.25 * outer, lip - 0.2 * wall))
        for x in np.linspace(-0.8, 0.8, 4) * half
    ]
    ear = box((-0.6 * radius, -0.6 * radius, start), (0.6 * radius, 0.6 * radius, start + 2.5 * wall))
    return union(shell, ear, *teeth)


FAMILY = family("excavator", _build)
