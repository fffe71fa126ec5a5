"""Linkages in the shape of a tree on tracks: branches of links around a trunk that turns. No such thing is sold."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import bent_fork
from kinematify.generate.procedural.pieces.tracks import Tracks, add_tracks, add_turntable
from kinematify.generate.procedural.solids import ball, cylinder

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_START = 0.6  # lean of the trunk's arms from the upright [rad]
_LEANS = (1.0, 0.5)  # of the links of a branch, in turn [rad]
_SWING = 0.4  # of every link, both ways [rad]


def _build(values: Values, workshop: Workshop) -> None:
    tracks = Tracks(length=values.number("length"), width=values.number("width"), clearance=values.number("clearance"))
    add_tracks(workshop, "tracks", tracks, wheels=values.count("wheels"))
    add_turntable(workshop, "trunk", "tracks", tracks)
    radius, count, height = values.number("joint_radius"), values.count("branches"), values.number("trunk")
    low = tracks.top - 0.2 * tracks.ring
    ring = max(2.5 * radius, 2.1 * radius / math.sin(math.pi / max(count, 3)))  # else neighbours' forks meet
    workshop.add("trunk", cylinder(max(1.6 * radius, 0.3 * ring), (0, 0, low), (0, 0, low + height)))
    for k in range(count):
        _add_branch(values, workshop, k, 360.0 * k / count, np.array([0.0, -ring, low + height + 1.2 * ring]))


def _add_branch(values: Values, workshop: Workshop, k: int, angle: float, first: FloatArray) -> None:
    """An arm of the trunk, and links one after the other; built towards -y and then turned about the trunk."""
    radius, clearance, long = values.number("joint_radius"), values.number("clearance"), values.number("link_length")
    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])

    def turned(*solids: Manifold) -> list[Manifold]:
        return [solid.rotate((0, 0, angle)) for solid in solids]

    foot = np.array([0.0, 0.0, first[2] - abs(first[1]) / math.tan(_START)])
    parent, pivot, below = "trunk", first, _START
    workshop.add(parent, *turned(cylinder(0.7 * radius, foot, pivot - 1.6 * radius * _along(below), segments=20)))
    links = values.count("links")
    for link in range(links):
        above, name = _LEANS[link % 2], f"branch_{k + 1}_{link + 1}"
        forked, tongue = bent_fork(pivot, (below, above), 2.4 * radius, radius, clearance)
        end = pivot + long * _along(above)
        last = link + 1 == links
        stop = end if last else end - 1.6 * radius * _along(above)
        workshop.add(parent, *turned(forked))
        bar = cylinder(0.7 * radius, pivot + 1.6 * radius * _along(above), stop, segments=20)
        workshop.body(name, *turned(tongue, bar, *([ball(1.3 * radius, end, segments=20)] if last else [])))
        workshop.turns(name, parent, turn @ (-1.0, 0.0, 0.0), turn @ pivot, (-_SWING, _SWING))
        parent, pivot, below = name, end, above


def _along(lean: float) -> FloatArray:
    return np.array([0.0, -math.sin(lean), math.cos(lean)])


FAMILY = family("tracked_tree", _build)
