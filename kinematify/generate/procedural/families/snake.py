"""Snake robots: segments on hinges that turn about the upright and across it in turn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import fork, room
from kinematify.generate.procedural.solids import cylinder, rod

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_SIZE = 0.45
"""Radius of a hinge beside that of the body."""


def _build(values: Values, workshop: Workshop) -> None:
    segments, radius, length = values.count("segments"), values.number("radius"), values.number("segment")
    clearance = min(values.number("clearance"), 0.03 * radius)
    size = _SIZE * radius
    space = room(size, clearance)
    length = max(length, 8.0 * size)
    for k in range(segments):
        start, end = k * length, (k + 1) * length
        first, last = k == 0, k + 1 == segments
        name = f"segment_{k + 1}"
        body = cylinder(
            radius, (start + (0.0 if first else 1.6 * space + 0.5 * radius), 0, radius),
            (end - (0.0 if last else 1.6 * space + 0.5 * radius), 0, radius),
        )  # fmt: skip
        workshop.body(name, body)
        if not first:
            _hinge(workshop, k, start, radius, clearance)
    workshop.add("segment_1", rod(0.8 * radius, (0, 0, radius), (-0.6 * radius, 0, radius)))


def _hinge(workshop: Workshop, k: int, x: float, radius: float, clearance: float) -> None:
    """Join segment k to segment k + 1 at x: a fork on the one, a tongue on the other."""
    upright, size = k % 2 == 0, _SIZE * radius
    forked, tongue = fork(1.6 * radius, size, clearance, 1.8 * size + 0.9 * radius)
    # The fork reaches down along -z and turns about x: lay it along x, its pin across or upright.
    lay = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    if upright:
        lay = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
    place = np.column_stack([lay, (x, 0.0, radius)])
    reach = tongue.transform(place)
    workshop.add(f"segment_{k}", forked.transform(place))
    workshop.add(f"segment_{k + 1}", reach)
    axis = (0, 0, 1) if upright else (0, 1, 0)
    workshop.turns(f"segment_{k + 1}", f"segment_{k}", axis, (x, 0, radius), (-0.7, 0.7))


FAMILY = family("snake", _build)
