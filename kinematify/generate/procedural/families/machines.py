"""Machines that stand on tracks or on a tower: excavators, cranes, and a tree of links on tracks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import bent_fork, room, stub
from kinematify.generate.procedural.solids import ball, bore, box, cylinder, hull, off, rod, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True)
class Tracks:
    """Sizes of an undercarriage on two tracks [m]."""

    length: float
    width: float
    """Over both tracks."""
    clearance: float
    """Between parts that turn on each other."""

    @property
    def belt(self) -> float:
        """Width of a track."""
        return 0.24 * self.width

    @property
    def high(self) -> float:
        """Of a track."""
        return 0.22 * self.length

    @property
    def ring(self) -> float:
        """Radius of the turntable."""
        return 0.2 * min(self.width, self.length)

    @property
    def level(self) -> float:
        """Of the turntable's plane."""
        return 1.3 * self.high

    @property
    def top(self) -> float:
        """Where a body may begin that stands on the turntable."""
        return self.level + self.clearance + 0.5 * self.ring


def add_tracks(workshop: Workshop, name: str, tracks: Tracks, *, wheels: int) -> None:
    """Add the undercarriage as the base, with `wheels` that turn on the outside of each track."""
    half = 0.5 * tracks.width
    cross = box(
        (-half + 0.5 * tracks.belt, -0.3 * tracks.length, 0.35 * tracks.high),
        (half - 0.5 * tracks.belt, 0.3 * tracks.length, 0.9 * tracks.high),
    )
    workshop.body(name, cross, *(_belt(tracks, s * (half - 0.5 * tracks.belt)) for s in (-1, 1)))
    radius = min(0.36 * tracks.high, 0.32 * tracks.length / max(wheels, 1))
    places = np.linspace(-0.5, 0.5, wheels) * (tracks.length - tracks.high) if wheels > 1 else np.zeros(wheels)
    for side, s in (("left", -1), ("right", 1)):
        for k, y in enumerate(places):
            pivot = np.array([s * half, y, 0.5 * tracks.high])
            _, hole, rotor = stub(pivot, (s, 0, 0), radius, min(tracks.clearance, 0.1 * radius), length=0.5 * radius)
            workshop.cut(name, hole)
            wheel = f"{side}_wheel_{k + 1}"
            nuts = [_nut(pivot, s, radius, angle) for angle in np.arange(5) * 0.4 * np.pi]
            workshop.body(wheel, rotor, *nuts, material="steel")
            workshop.turns(wheel, name, (s, 0, 0), pivot)


def _belt(tracks: Tracks, x: float) -> Manifold:
    """A closed track with cleats."""
    radius, half = 0.46 * tracks.high, 0.5 * tracks.belt
    run = 0.5 * tracks.length - 0.5 * tracks.high
    ends = [cylinder(radius, (x - half, y, 0.5 * tracks.high), (x + half, y, 0.5 * tracks.high)) for y in (-run, run)]
    cleat = 0.04 * tracks.high
    cleats = [
        box((x - half, y - cleat, z0), (x + half, y + cleat, z1))
        for y in np.linspace(-run, run, 9)
        for z0, z1 in ((0.0, 0.1 * tracks.high), (0.9 * tracks.high, tracks.high))
    ]
    return union(hull(*ends), *cleats)


def _nut(pivot: np.ndarray, s: int, radius: float, angle: float) -> Manifold:
    centre = off(pivot, s * 0.4 * radius, 0.65 * radius * np.cos(angle), 0.65 * radius * np.sin(angle))
    return cylinder(0.12 * radius, centre, off(centre, s * 0.3 * radius, 0, 0), segments=6)


def add_turntable(workshop: Workshop, name: str, parent: str, tracks: Tracks) -> None:
    """Add what turns on the undercarriage without end: the ring alone, its body follows above `tracks.top`."""
    pivot = (0.0, 0.0, tracks.level)
    boss, hole, rotor = stub(pivot, (0, 0, 1), tracks.ring, tracks.clearance, length=0.5 * tracks.ring)
    below = cylinder(tracks.ring, (0, 0, 0.6 * tracks.high), pivot)
    workshop.add(parent, boss, below)
    workshop.cut(parent, hole)
    workshop.body(name, rotor)
    workshop.turns(name, parent, (0, 0, 1), pivot)


_EXCAVATOR_LEANS = (0.0, 0.45, 1.25, 2.3, 2.7)
"""Of the house, the boom below and above its bend, the stick and the bucket: from the upright to the front [rad]."""
_SWINGS = {"boom": (-0.35, 0.3), "stick": (-0.3, 0.8), "bucket": (-0.8, 0.9)}
"""Positive upwards [rad]."""


def build_excavator(values: Values, workshop: Workshop) -> None:
    """Excavators: a house on tracks, a boom, a stick and a bucket on pins."""
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
    parent, below = "house", _EXCAVATOR_LEANS[0]
    for name, above in (("boom", _EXCAVATOR_LEANS[1]), ("stick", _EXCAVATOR_LEANS[3]), ("bucket", _EXCAVATOR_LEANS[4])):
        forked, tongue = bent_fork(pivot, (below, above), 2.6 * radius, radius, clearance)
        workshop.add(parent, forked)
        if name == "bucket":
            scoop = _scoop(values, radius, room(radius, 0.15 * radius))
            workshop.body(name, tongue, scoop.rotate((math.degrees(above), 0, 0)).translate(pivot))
            end, last = pivot, above
        else:
            last = _EXCAVATOR_LEANS[2] if name == "boom" else above
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


_LEAN = 0.7  # of a mobile crane's boom at zero, from the upright to the front [rad]
_RISES = (-0.35, 0.5)  # of the boom, positive upwards [rad]


def build_crane(values: Values, workshop: Workshop) -> None:
    """Cranes: a tower with a trolley on its jib, or a house on tracks with a boom that lifts and lengthens."""
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


_START = 0.6  # lean of the trunk's arms from the upright [rad]
_TREE_LEANS = (1.0, 0.5)  # of the links of a branch, in turn [rad]
_SWING = 0.4  # of every link, both ways [rad]


def build_tracked_tree(values: Values, workshop: Workshop) -> None:
    """Linkages in the shape of a tree on tracks: branches of links around a trunk that turns. No such thing is sold."""
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
        above, name = _TREE_LEANS[link % 2], f"branch_{k + 1}_{link + 1}"
        forked, tongue = bent_fork(pivot, (below, above), 2.4 * radius, radius, clearance)
        end = pivot + long * _along(above)
        last = link + 1 == links
        stop = end if last else end - 1.6 * radius * _along(above)
        workshop.add(parent, *turned(forked))
        bar = cylinder(0.7 * radius, pivot + 1.6 * radius * _along(above), stop, segments=20)
        workshop.body(name, *turned(tongue, bar, *([ball(1.3 * radius, end, segments=20)] if last else [])))
        workshop.turns(name, parent, turn @ (-1.0, 0.0, 0.0), turn @ pivot, (-_SWING, _SWING))
        parent, pivot, below = name, end, above
