"""Excavators, cranes and what has tracks, carved."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import cos, degrees, pi, radians, sin, sqrt, tan
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold

from kinematify.generate.kinds.limbs import track_ring, track_top, tracked, turntable
from kinematify.generate.library.kind import choice, kind, length, whole
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.pieces.bearing_pieces import bent_fork, fork_room, stub
from kinematify.generate.procedural.solids import ball, bore, box, cylinder, hull, off, rod, slab, union, vector

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray


@kind(
    walls=180,
    words="digger, mini excavator, toy excavator, toy digger, crawler excavator",
    carved_from="steel",
    length=length(1.5, 5.0, default=2.6, usual=(1.6, 4.0), help="Of the tracks."),
    width=length(1.0, 4.0, default=1.8, usual=(1.2, 2.6), help="Over the tracks."),
    boom=length(1.6, 8.0, default=2.6, usual=(2.0, 4.0), help="Its length."),
    stick=length(1.0, 5.0, default=1.6, usual=(1.2, 2.4), help="Its length.", words="arm"),
    bucket=length(0.3, 1.8, default=0.7, usual=(0.5, 1.0), help="Its size."),
    wheels=whole(0, 4, default=0, usual=(0, 3), help="Seen on each side.", words="wheel"),
)
def excavator(
    w: ObjectBuilder,
    length: float,
    width: float,
    boom: float,
    stick: float,
    bucket: float,
    wheels: int,
    open: float,
    clearance: float,
) -> None:
    """Excavators: a house on tracks, a boom, a stick and a bucket on pins."""
    # leans: house, boom below and above its bend, stick and bucket: from the upright to the front [rad].
    leans = (0.0, 0.45, 1.25, 2.3, 2.7)
    swings = {"boom": (-0.35, 0.3), "stick": (-0.3, 0.8), "bucket": (-0.8, 0.9)}  # positive upwards [rad]

    # Platform, cab, engine and counterweight; returns the boom's pin and the radius of its knuckles.
    def house() -> tuple[FloatArray, float]:
        half = 0.46 * tracks_width
        long = 0.5 * tracks_length
        low = tracks_top - 0.2 * tracks_ring
        thick = 0.12 * tracks_length
        top = low + thick
        radius = min(0.055 * tracks_width, 0.05 * tracks_length)
        cab = 0.42 * tracks_length
        w.part(
            "house",
            slab(half, (-0.8 * long, long), (low, top)),
            box((-half, -0.75 * long, top - 0.001), (-0.2 * tracks_width, 0.1 * long, top + cab)),
            slab(half, (0.25 * long, 0.7 * long), (top - 0.001, top + 0.6 * cab)),
            cylinder(min(half, 0.5 * long), 0, 0.55 * long, (low, top + 0.4 * cab)),
        )
        window = box((-2.0, -0.68 * long, top + 0.45 * cab), (-half + 0.01, 0.02 * long, top + 0.92 * cab))
        front = box(
            (-0.95 * half, -2.0, top + 0.45 * cab), (-0.23 * tracks_width, -0.75 * long + 0.01, top + 0.92 * cab)
        )
        w.cut("house", window, front)
        return (vector(0.0, -0.7 * long, top + 1.9 * radius), radius)

    # A bucket above the origin, open towards -y, with teeth.
    def scoop_of(radius: float, start: float) -> Manifold:
        size = bucket
        half = 0.45 * bucket
        outer = 0.42 * size
        wall = 0.03 * size
        centre = start + outer
        shell = cylinder(outer, (-half, half), 0, centre)
        shell = shell - cylinder(outer - wall, (wall - half, half - wall), 0, centre)
        shell = shell.trim_by_plane((0, 1, 0), -0.3 * outer)
        lip = centre + sqrt(outer * outer - 0.3 * outer * (0.3 * outer))
        teeth = [
            box((x - 0.05 * size, -0.65 * outer, lip - 1.2 * wall), (x + 0.05 * size, -0.25 * outer, lip - 0.2 * wall))
            for x in np.linspace(-0.8, 0.8, 4) * half
        ]
        ear = slab(0.6 * radius, 0.6 * radius, (start, start + 2.5 * wall))
        return union(shell, ear, *teeth)

    def along(lean: float) -> FloatArray:
        return vector(0.0, -sin(lean), cos(lean))

    # A beam between two points, `thick` at its bend and as thick as a knuckle at the other end.
    def beam_(start: FloatArray, end: FloatArray, radius: float, thick: float, swap: bool = False) -> Manifold:
        first, second = (thick, 0.9 * radius) if swap else (0.9 * radius, thick)
        x = vector(1.2 * radius, 0.0, 0.0)
        return hull(cylinder(first, start - x, start + x, segments=24), cylinder(second, end - x, end + x, segments=24))

    tracks_length = length
    tracks_width = width
    tracks_ring = track_ring(length, width)
    tracks_top = track_top(clearance, length, width)
    tracked(w, clearance, "tracks", tracks_length, tracks_width, wheels)
    turntable(w, clearance, "house", "tracks", tracks_length, tracks_width)
    pivot, radius = house()
    # Boom, stick and bucket, one after the other.
    pivot_2 = pivot
    lengths = {"boom": boom, "stick": stick}
    parent = "house"
    below = leans[0]
    for name, above in (("boom", leans[1]), ("stick", leans[3]), ("bucket", leans[4])):
        forked, tongue = bent_fork(pivot_2, (below, above), 2.6 * radius, radius, clearance)
        w.part(parent, forked)
        if name == "bucket":
            scoop = scoop_of(radius, fork_room(radius, 0.15 * radius))
            w.part(name, tongue, scoop.rotate((degrees(above), 0, 0)).translate(pivot_2))
            end = pivot_2
            last = above
        else:
            last = leans[2] if name == "boom" else above
            bend = pivot_2 + 0.5 * lengths[name] * along(above)
            end = bend + 0.5 * lengths[name] * along(last)
            start = pivot_2 + 2.2 * radius * along(above)
            stop = end - 2.3 * radius * along(last)
            thick = 1.5 * radius if name == "boom" else radius
            beams = (beam_(start, bend, radius, thick), beam_(bend, stop, radius, thick, swap=True))
            w.part(name, tongue, beams)
        least, most = swings[name]
        w.hinge(name, parent, (-1, 0, 0), pivot_2, most, least, rest=open * most)
        parent = name
        below = last
        pivot_2 = end
    w.settle()


@kind(
    words=("tower crane, mobile crane, construction crane, toy crane, truck crane, toy tower crane, building crane"),
    carved_from="steel",
    kind=choice(
        {"tower": "", "mobile": "crawler, tracked, telescopic, telescoping"},
        help="A tower with a trolley on its jib, or a boom on tracks.",
    ),
    height=length(1.5, 20.0, default=3.0, usual=(2.0, 5.0), help="Of a tower; sets the scale."),
    jib=length(1.0, 20.0, default=2.4, usual=(1.6, 3.0), help="Its length; of a boom drawn out.", words="jib, boom"),
    sections=whole(0, 4, usual=(0, 3), help="That a boom lengthens by.", words="section"),
    wheels=whole(0, 4, default=0, usual=(0, 3), help="Seen on each side.", words="wheel"),
)
def crane(
    w: ObjectBuilder, kind: str, height: float, jib: float, sections: int, wheels: int, open: float, clearance: float
) -> None:
    """Cranes: a tower with a trolley on its jib, or a house on tracks with a boom that lifts and lengthens."""
    lean = 0.7  # of a mobile crane's boom at zero, from the upright to the front [rad]
    least, most = -0.35, 0.5  # of the boom, positive upwards [rad]

    # Four posts with rungs, closed by a plate on top.
    def mast(half: float, low: float, high: float) -> Sequence[Manifold]:
        post = 0.22 * half
        at = half - post
        solids = [box((x - post, y - post, low), (x + post, y + post, high)) for x in (-at, at) for y in (-at, at)]
        for z in np.linspace(low, high - 2.0 * post, max(3, min(16, int((high - low) / (3.0 * half))))):
            frame = slab(half, half, (z, z + post))
            solids = [*solids, frame - box((post - at, post - at, -1.0), (at - post, at - post, high + 1.0))]
        return [*solids, slab(half, half, (high - post, high + 0.001))]

    # Two stiff ropes of `length` below a point of the parent, tied at both ends, and a hook block on them.
    def hook_of(parent: str, top: FloatArray, half: float, length: float) -> None:
        rope = 0.12 * half
        size = 0.9 * half
        tight = min(clearance, 0.5 * rope)
        x = 0.42 * size
        end = off(top, 0, 0, -length)
        ties = [box(off(at, -x - rope, -rope, -rope), off(at, x + rope, rope, rope)) for at in (top, end)]
        falls = [(off(top, s * x, 0, 0), off(end, s * x, 0, 0)) for s in (-1, 1)]
        w.part(parent, ties, [cylinder(rope, *fall) for fall in falls])
        start = off(top, 0, 0, -0.6 * half - 2.0 * clearance)
        block = box(off(start, -0.62 * size, -0.35 * size, -size), off(start, 0.62 * size, 0.35 * size, 0))
        block = block - union(*[bore(rope, tight, off(low, 0, 0, -1.0), high) for high, low in falls])
        shape = ((0.0, 0.8), (0.0, 1.4), (0.3, 1.8), (-0.1, 2.2), (-0.5, 2.0), (-0.6, 1.6))
        points = [off(start, 0, ahead * size, -down * size) for ahead, down in shape]
        hook = [rod(0.13 * size, one, other, segments=16) for one, other in pairwise(points)]
        w.part("hook", block, hook, look="yellow steel")
        travel = length - 0.6 * half - 2.0 * clearance - 2.4 * size - 3.0 * rope
        w.slide("hook", parent, (0, 0, -1), travel, pivot=start, rest=open * travel)

    # A square bar along z, from `deep` on hollow and open at its end if `inner` is above zero.
    def tube_(half: float, start: float, end: float, inner: float, deep: float) -> Manifold:
        bar = slab(half, half, (start, end))
        return bar - slab(inner, inner, (deep, end + 1.0)) if inner else bar

    if kind == "tower":
        # Foot, mast, and a jib that turns on it with a trolley and a hook.
        half = min(0.02 * height + 0.01 * jib, 0.05 * jib, 0.04 * height)
        level = height - 7.0 * half
        foot = 0.12 * height + 2.0 * half
        w.part("tower", slab(foot, foot, (0, 0.02 * height)), mast(half, 0.01 * height, level))
        pivot = (0.0, 0.0, level + half)
        boss, hole, rotor = stub(pivot, (0, 0, 1), 1.5 * half, clearance, length=half)
        w.part("tower", boss)
        w.cut("tower", hole)
        beam = level + 3.0 * half
        thick = 0.7 * half
        counter = 0.3 * jib
        w.part(
            "jib",
            rotor,
            slab(half, half, (pivot[2] + 0.9 * half, height)),
            slab(thick, (-jib, counter), (beam, beam + 2.0 * thick)),
            slab(1.2 * half, (0.7 * counter, 0.98 * counter), (beam - 2.0 * half, beam + 2.2 * thick)),
            box((half - 0.001, -2.5 * half, beam - 1.5 * half), (2.6 * half, half, beam + half)),
            [rod(0.12 * half, (0, 0, height), (0, y, beam + thick), segments=12) for y in (-0.7 * jib, 0.9 * counter)],
        )
        w.spin("jib", "tower", (0, 0, 1), pivot)
        # A trolley around the jib, with a rope on which a hook is lowered.
        wall = 0.35 * half
        long = 1.5 * half
        y = -3.2 * half - long
        gap = thick + clearance
        high = beam + 2.0 * thick + clearance
        block = slab(gap + wall, (y - long, y + long), (beam - clearance - wall, high + wall))
        inner = slab(gap, (-2.0 * jib, 1.0), (beam - clearance, high))
        slot = slab(0.3 * half, (-2.0 * jib, 1.0), (high - 0.001, high + 1.0))
        w.part("trolley", block - inner - slot)
        travel = 0.98 * jib - 3.2 * half - 2.0 * long
        w.slide("trolley", "jib", (0, -1, 0), travel, pivot=(0, y, beam), rest=open * travel)
        top = beam - clearance - 0.5 * wall
        hook_of("trolley", vector(0.0, y, top), half=half, length=0.75 * beam)
    elif kind == "mobile":
        # A house on tracks with a boom of boxes that run in each other.
        length = min(0.35 * height, 0.4 * jib)
        width = 0.75 * length
        tracks_length = length
        tracks_width = width
        tracks_ring = track_ring(length, width)
        tracks_top = track_top(clearance, length, width)
        tracked(w, clearance, "tracks", tracks_length, tracks_width, wheels)
        turntable(w, clearance, "house", "tracks", tracks_length, tracks_width)
        half_2 = 0.46 * tracks_width
        long_2 = 0.5 * tracks_length
        low = tracks_top - 0.2 * tracks_ring
        top_2 = low + 0.1 * tracks_length
        radius = 0.14 * tracks_width
        w.part(
            "house",
            slab(half_2, (-0.7 * long_2, long_2), (low, top_2)),
            box(
                (-half_2, -0.7 * long_2, top_2 - 0.001),
                (-0.26 * tracks_width, 0.2 * long_2, top_2 + 0.3 * tracks_length),
            ),
            slab(half_2, (0.6 * long_2, long_2), (top_2 - 0.001, top_2 + 0.2 * tracks_length)),
        )
        pivot_2 = vector(0.0, 0.1 * long_2, top_2 + 2.0 * radius)
        forked, tongue = bent_fork(pivot_2, (0.0, lean), 2.4 * radius, radius, clearance)
        w.part("house", forked)
        # The boom on its tongue, its sections, and the hook at the end of the last one.
        long_3 = 0.5 * jib
        wall_2 = 0.12 * radius
        gap_2 = min(clearance, 0.05 * radius)
        start = 1.3 * radius
        deep = 2.4 * radius
        half_3 = 0.95 * radius
        along = vector(0.0, -sin(lean), cos(lean))

        def placed(*solids: Manifold) -> Sequence[Manifold]:
            return [solid.rotate((degrees(lean), 0, 0)).translate(pivot_2) for solid in solids]

        w.part("boom", tongue, placed(tube_(half_3, start, long_3, half_3 - wall_2 if sections else 0.0, deep)))
        w.hinge("boom", "house", (-1, 0, 0), pivot_2, most, least, rest=open * most)
        parent = "boom"
        for k in range(sections):
            half_3 = half_3 - (wall_2 + gap_2)
            start, deep, long_3 = (deep + gap_2, deep + gap_2 + wall_2, long_3 + 1.5 * wall_2)
            name = f"section_{k + 1}"
            w.part(name, placed(tube_(half_3, start, long_3, half_3 - wall_2 if k + 1 < sections else 0.0, deep)))
            w.slide(name, parent, along, 0.75 * (long_3 - start), pivot=pivot_2, rest=open * (0.75 * (long_3 - start)))
            parent = name
        tip = pivot_2 + (long_3 + 0.8 * half_3) * along
        jut = off(tip, 0, -2.6 * radius, 0)
        head = slab(0.8 * half_3, 0.8 * half_3, (long_3 - 0.001, long_3 + 1.6 * half_3))
        w.part(
            parent,
            placed(head),
            rod(min(0.35 * half_3, 0.3 * radius), tip, jut, segments=16),
            ball(min(0.6 * half_3, 0.4 * radius), jut),
        )
        hook_of(parent, jut, half=0.8 * radius, length=0.8 * jut[2])
    w.settle()


@kind(
    words=(
        "tracked robot tree, robot tree, tracked robot, tree on tracks, tree of links, linkage tree, tree "
        "linkage, kinematic tree, tree robot, branching robot"
    ),
    title="tree of links on tracks",
    carved_from="metal",
    branches=whole(1, 8, usual=(2, 6), help="Around the trunk.", words="branch, limb"),
    links=whole(1, 3, help="Of a branch.", words="link, joint, joint per branch"),
    wheels=whole(0, 4, default=0, usual=(0, 3), help="Seen on each side.", words="wheel"),
    length=length(0.4, 3.0, default=0.8, usual=(0.6, 1.2), help="Of the tracks."),
    width=length(0.4, 2.0, default=0.6, usual=(0.4, 0.9), help="Over the tracks."),
    trunk=length(0.2, 2.0, default=0.5, usual=(0.3, 0.8), help="Its height."),
    link_length=length(0.25, 1.0, default=0.3, usual=(0.25, 0.5), help="Its length."),
    joint_radius=length(0.015, 0.04, default=0.025, usual=(0.02, 0.035), help="Of the hinges."),
)
def tracked_tree(
    w: ObjectBuilder,
    branches: int,
    links: int,
    wheels: int,
    length: float,
    width: float,
    trunk: float,
    link_length: float,
    joint_radius: float,
    clearance: float,
) -> None:
    """Linkages in the shape of a tree on tracks: branches of links around a trunk that turns. No such thing is sold."""
    start = 0.6  # lean of the trunk's arms from the upright [rad]
    leans = (1.0, 0.5)  # of the links of a branch, in turn [rad]
    swing = 0.4  # of every link, both ways [rad]

    def along(lean: float) -> FloatArray:
        return vector(0.0, -sin(lean), cos(lean))

    tracks_length = length
    tracks_width = width
    tracks_ring = track_ring(length, width)
    tracks_top = track_top(clearance, length, width)
    tracked(w, clearance, "tracks", tracks_length, tracks_width, wheels)
    turntable(w, clearance, "trunk", "tracks", tracks_length, tracks_width)
    low = tracks_top - 0.2 * tracks_ring
    ring = max(2.5 * joint_radius, 2.1 * joint_radius / sin(pi / max(branches, 3)))
    w.part("trunk", cylinder(max(1.6 * joint_radius, 0.3 * ring), low, low + trunk))
    for k in range(branches):
        # An arm of the trunk, and links one after the other; built towards -y and then turned about the trunk.
        angle = 360.0 * k / branches
        first = vector(0.0, -ring, low + trunk + 1.2 * ring)
        cosine = cos(radians(angle))
        sine = sin(radians(angle))
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])

        def turned(*solids: Manifold, angle: float = angle) -> Sequence[Manifold]:
            return [solid.rotate((0, 0, angle)) for solid in solids]

        foot = vector(0.0, 0.0, first[2] - np.abs(first[1]) / tan(start))
        parent = "trunk"
        pivot = first
        below = start
        w.part(
            parent, turned(cylinder(0.7 * joint_radius, foot, pivot - 1.6 * joint_radius * along(below), segments=20))
        )
        for link in range(links):
            above = leans[link % 2]
            name = f"branch_{k + 1}_{link + 1}"
            forked, tongue = bent_fork(pivot, (below, above), 2.4 * joint_radius, joint_radius, clearance)
            end = pivot + link_length * along(above)
            last = link + 1 == links
            stop = end if last else end - 1.6 * joint_radius * along(above)
            w.part(parent, turned(forked))
            bar = cylinder(0.7 * joint_radius, pivot + 1.6 * joint_radius * along(above), stop, segments=20)
            w.part(name, turned(tongue, bar, *([ball(1.3 * joint_radius, end, segments=20)] if last else [])))
            w.hinge(name, parent, turn @ (-1.0, 0.0, 0.0), turn @ pivot, swing, -swing)
            parent = name
            pivot = end
            below = above
    w.settle()
