"""Cranes: a tower with a trolley on its jib, or a house on tracks with a boom that lifts and lengthens."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import bent_fork, stub
from kinematify.generate.procedural.pieces.tracks import Tracks, add_tracks, add_turntable
from kinematify.generate.procedural.solids import ball, bore, box, cylinder, off, rod, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_LEAN = 0.7  # of a mobile crane's boom at zero, from the upright to the front [rad]
_RISES = (-0.35, 0.5)  # of the boom, positive upwards [rad]


def _build(values: Values, workshop: Workshop) -> None:
    {"tower": _tower, "mobile": _mobile}[values.choice("kind")](values, workshop)


def _tower(values: Values, workshop: Workshop) -> None:
    """Foot, mast, and a jib that turns on it with a trolley and a hook."""
    height, jib, clearance = values.number("height"), values.number("jib"), values.number("clearance")
    half = min(0.02 * height + 0.01 * jib, 0.05 * jib, 0.04 * height)  # of the mast's and the jib's section
    level = height - 7.0 * half
    foot = 0.12 * height + 2.0 * half
    workshop.body("tower", box((-foot, -foot, 0), (foot, foot, 0.02 * height)), *_mast(half, 0.01 * height, level))
    pivot = (0.0, 0.0, level + half)
    boss, hole, rotor = stub(pivot, (0, 0, 1), 1.5 * half, clearance, length=half)
    workshop.add("tower", boss)
    workshop.cut("tower", hole)
    beam = level + 3.0 * half  # underside of the jib
    thick = 0.7 * half
    counter = 0.3 * jib
    workshop.body(
        "jib",
        rotor,
        box((-half, -half, pivot[2] + 0.9 * half), (half, half, height)),
        box((-thick, -jib, beam), (thick, counter, beam + 2.0 * thick)),
        box((-1.2 * half, 0.7 * counter, beam - 2.0 * half), (1.2 * half, 0.98 * counter, beam + 2.2 * thick)),
        box((half - 1e-3, -2.5 * half, beam - 1.5 * half), (2.6 * half, half, beam + half)),
        *(rod(0.12 * half, (0, 0, height), (0, y, beam + thick), segments=12) for y in (-0.7 * jib, 0.9 * counter)),
    )
    workshop.turns("jib", "tower", (0, 0, 1), pivot)
    _add_trolley(values, workshop, half, thick, beam)


def _mast(half: float, low: float, high: float) -> list[Manifold]:
    """Four posts with rungs, closed by a plate on top."""
    post = 0.22 * half
    at = half - post
    solids = [box((x - post, y - post, low), (x + post, y + post, high)) for x in (-at, at) for y in (-at, at)]
    for z in np.linspace(low, high - 2.0 * post, max(3, min(16, int((high - low) / (3.0 * half))))):
        frame = box((-half, -half, z), (half, half, z + post))
        solids.append(frame - box((post - at, post - at, -1.0), (at - post, at - post, high + 1.0)))
    return [*solids, box((-half, -half, high - post), (half, half, high + 1e-3))]


def _add_trolley(values: Values, workshop: Workshop, half: float, thick: float, beam: float) -> None:
    """A trolley around the jib, with a rope on which a hook is lowered."""
    jib, clearance, rest = values.number("jib"), values.number("clearance"), values.number("open")
    wall, long = 0.35 * half, 1.5 * half
    y = -3.2 * half - long
    gap, high = thick + clearance, beam + 2.0 * thick + clearance
    block = box((-gap - wall, y - long, beam - clearance - wall), (gap + wall, y + long, high + wall))
    inner = box((-gap, -2.0 * jib, beam - clearance), (gap, 1.0, high))
    slot = box((-0.3 * half, -2.0 * jib, high - 1e-3), (0.3 * half, 1.0, high + 1.0))  # the jib's stay passes here
    workshop.body("trolley", block - inner - slot)
    travel = 0.98 * jib - 3.2 * half - 2.0 * long
    workshop.slides("trolley", "jib", (0, -1, 0), (0, y, beam), (0.0, travel), rest=rest)
    top = beam - clearance - 0.5 * wall
    _add_hook(values, workshop, "trolley", np.array([0.0, y, top]), half=half, length=0.75 * beam)


def _add_hook(values: Values, workshop: Workshop, parent: str, top: FloatArray, *, half: float, length: float) -> None:
    """Two stiff ropes of `length` below a point of the parent, tied at both ends, and a hook block on them."""
    clearance = values.number("clearance")
    rope, size = 0.12 * half, 0.9 * half
    tight, x = min(clearance, 0.5 * rope), 0.42 * size
    end = off(top, 0, 0, -length)
    ties = [box(off(at, -x - rope, -rope, -rope), off(at, x + rope, rope, rope)) for at in (top, end)]
    falls = [(off(top, s * x, 0, 0), off(end, s * x, 0, 0)) for s in (-1, 1)]
    workshop.add(parent, *ties, *(cylinder(rope, *fall) for fall in falls))
    start = off(top, 0, 0, -0.6 * half - 2.0 * clearance)
    block = box(off(start, -0.62 * size, -0.35 * size, -size), off(start, 0.62 * size, 0.35 * size, 0))
    block -= union(*(bore(rope, tight, off(low, 0, 0, -1.0), high) for high, low in falls))
    shape = ((0.0, 0.8), (0.0, 1.4), (0.3, 1.8), (-0.1, 2.2), (-0.5, 2.0), (-0.6, 1.6))
    points = [off(start, 0, ahead * size, -down * size) for ahead, down in shape]
    hook = [rod(0.13 * size, one, other, segments=16) for one, other in pairwise(points)]
    workshop.body("hook", block, *hook, material="steel", color="yellow")
    travel = length - 0.6 * half - 2.0 * clearance - 2.4 * size - 3.0 * rope
    workshop.slides("hook", parent, (0, 0, -1), start, (0.0, travel), rest=values.number("open"))


def _mobile(values: Values, workshop: Workshop) -> None:
    """A house on tracks with a boom of boxes that run in each other."""
    height, boom, clearance = values.number("height"), values.number("jib"), values.number("clearance")
    length = min(0.35 * height, 0.4 * boom)  # the rope hangs before the tracks
    tracks = Tracks(length=length, width=0.75 * length, clearance=clearance)
    add_tracks(workshop, "tracks", tracks, wheels=values.count("wheels"))
    add_turntable(workshop, "house", "tracks", tracks)
    half, long, low = 0.46 * tracks.width, 0.5 * tracks.length, tracks.top - 0.2 * tracks.ring
    top, radius = low + 0.1 * tracks.length, 0.14 * tracks.width
    workshop.add(
        "house",
        box((-half, -0.7 * long, low), (half, long, top)),
        box((-half, -0.7 * long, top - 1e-3), (-0.26 * tracks.width, 0.2 * long, top + 0.3 * tracks.length)),
        box((-half, 0.6 * long, top - 1e-3), (half, long, top + 0.2 * tracks.length)),
    )
    pivot = np.array([0.0, 0.1 * long, top + 2.0 * radius])
    forked, tongue = bent_fork(pivot, (0.0, _LEAN), 2.4 * radius, radius, clearance)
    workshop.add("house", forked)
    _add_boom(values, workshop, pivot, radius, tongue=tongue, long=0.5 * boom)


def _add_boom(
    values: Values, workshop: Workshop, pivot: FloatArray, radius: float, *, tongue: Manifold, long: float
) -> None:
    """The boom on its tongue, its sections, and the hook at the end of the last one."""
    clearance, rest = values.number("clearance"), values.number("open")
    sections, wall = values.count("sections"), 0.12 * radius
    gap = min(clearance, 0.05 * radius)
    start, deep, half = 1.3 * radius, 2.4 * radius, 0.95 * radius  # the tongue reaches into the boom
    along = np.array([0.0, -math.sin(_LEAN), math.cos(_LEAN)])

    def placed(*solids: Manifold) -> list[Manifold]:
        return [solid.rotate((math.degrees(_LEAN), 0, 0)).translate(pivot) for solid in solids]

    workshop.body("boom", tongue, *placed(_tube(half, start, long, half - wall if sections else 0.0, deep)))
    workshop.turns("boom", "house", (-1, 0, 0), pivot, _RISES, rest=rest)
    parent = "boom"
    for k in range(sections):
        half -= wall + gap
        start, deep, long = deep + gap, deep + gap + wall, long + 1.5 * wall
        name = f"section_{k + 1}"
        workshop.body(name, *placed(_tube(half, start, long, half - wall if k + 1 < sections else 0.0, deep)))
        workshop.slides(name, parent, along, pivot, (0.0, 0.75 * (long - start)), rest=rest)
        parent = name
    tip = pivot + (long + 0.8 * half) * along
    jut = off(tip, 0, -2.6 * radius, 0)
    head = box((-0.8 * half, -0.8 * half, long - 1e-3), (0.8 * half, 0.8 * half, long + 1.6 * half))
    workshop.add(
        parent,
        *placed(head),
        rod(min(0.35 * half, 0.3 * radius), tip, jut, segments=16),
        ball(min(0.6 * half, 0.4 * radius), jut),
    )
    _add_hook(values, workshop, parent, jut, half=0.8 * radius, length=0.8 * jut[2])


def _tube(half: float, start: float, end: float, inner: float, deep: float) -> Manifold:
    """A square bar along z, from `deep` on hollow and open at its end if `inner` is above zero."""
    bar = box((-half, -half, start), (half, half, end))
    return bar - box((-inner, -inner, deep), (inner, inner, end + 1.0)) if inner else bar


FAMILY = family("crane", _build)
