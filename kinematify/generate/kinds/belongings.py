"""Globes, umbrellas, suitcases, eyeglasses and more, carved."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, cos, degrees, hypot, pi, radians, sin, tan
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold

from kinematify.generate.library.kind import angle, choice, kind, length, whole
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.layout import grid
from kinematify.generate.procedural.pieces.bearing_pieces import BackEdge, add_barrels, at, barrel, fork, stub
from kinematify.generate.procedural.solids import ball, bore, box, cylinder, hull, ring, rod, slab, union, vector
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray


@kind(
    words=(
        "notebook, notebook computer, laptop computer, portable computer, macbook, chromebook, netbook, "
        "ultrabook, toy laptop"
    ),
    carved_from="metal",
    part_words={"screen": "lid, display"},
    width=length(0.2, 0.5, default=0.34, usual=(0.28, 0.4), help="Outer width."),
    depth=length(0.15, 0.4, default=0.24, usual=(0.2, 0.28), help="Outer depth."),
    base=length(0.008, 0.04, default=0.014, usual=(0.01, 0.024), help="Thickness below."),
    screen=length(0.005, 0.02, default=0.007, usual=(0.005, 0.01), help="Thickness above."),
    knuckles=whole(2, 5, usual=(3, 5), help="Of each of the two hinges."),
)
def laptop(
    w: ObjectBuilder,
    width: float,
    depth: float,
    base: float,
    screen: float,
    knuckles: int,
    open: float,
    clearance: float,
) -> None:
    """Laptops: a screen that is hinged at the back edge of a slab with keys."""
    radius = 0.005  # of the hinges [m]
    opens = 2.2  # [rad]
    back = depth - 2.0 * radius - clearance - 0.001
    level = base + clearance
    sheet = slab(0.5 * width, (0, back), (0, base))
    keys = [
        slab((x - 0.007, x + 0.007), (y - 0.007, y + 0.007), 0.002).translate((0, 0.58 * back, base))
        for x, y in grid(48, 12, (min(0.9 * width, 0.3), min(0.4 * depth, 0.1)))
    ]
    pad = slab(0.18 * width, (0.06 * back, 0.3 * back), (base - 0.0005, base + 0.01))
    lid = slab(0.5 * width, (0, back), (level, level + screen))
    hollow = slab(0.46 * width, (0.04 * back, 0.96 * back), (level - 1.0, level + 0.0025))
    w.part("base", sheet - pad, keys)
    w.part("screen", lid - hollow)
    edge = BackEdge(y=back, level=level, below=base, above=screen, clearance=clearance)
    places = (-0.32 * width, 0.32 * width)
    pivot = add_barrels(
        w, "screen", parent="base", edge=edge, places=places, length=0.16 * width, radius=radius, knuckles=knuckles
    )
    w.hinge("screen", "base", (-1, 0, 0), pivot, opens, rest=open * opens)
    w.settle()


@kind(
    words="world globe, earth globe, desk globe, terrestrial globe",
    part_words={"base": "stand"},
    diameter=length(0.1, 0.8, default=0.25, usual=(0.16, 0.36), help="Of the ball."),
    post=length(0.03, 0.4, default=0.05, usual=(0.03, 0.12), help="Its height."),
    tilt=angle(0.25, 0.6, default=0.41, usual=(0.3, 0.5), help="Of the axis."),
    mount=choice(
        {"arc": "half meridian", "ring": "full meridian"}, help="A half or a full meridian.", words="meridian"
    ),
    foot=choice(
        {"fixed": "", "turning": "rotating foot, turning foot, swivel"}, help="Whether the meridian turns on the foot."
    ),
    carved_from="plastic",
)
def globe(w: ObjectBuilder, diameter: float, post: float, tilt: float, mount: str, foot: str, clearance: float) -> None:
    """Globes: a ball that turns on an inclined axis in a meridian, which may turn on its foot."""
    the_foot = 0.014  # thickness of the foot [m]
    latitudes = (-40.0, 0.0, 40.0)  # of the raised lines [deg]

    # A foot and a post up to the meridian; returns the body that the post belongs to.
    def stand(low: float, arc: float) -> str:
        radius = 0.5 * diameter
        wide = 3.0 * arc
        start = 1.5 * the_foot
        w.part("base", cylinder(0.62 * radius, 0, the_foot, segments=64), cylinder(0.5 * radius, 0, start, segments=64))
        if foot == "fixed":
            w.part("base", cylinder(0.5 * wide, the_foot, low))
            found = "base"
        else:
            boss, hole, rotor = stub((0, 0, start + 0.01), (0, 0, 1), wide, clearance, length=0.012)
            w.part("base", boss)
            w.cut("base", hole)
            w.part("meridian", rotor, cylinder(0.5 * wide, start + 0.01 + clearance, low))
            w.spin("meridian", "base", (0, 0, 1), (0, 0, start + 0.01))
            found = "meridian"
        return found

    # A raised line around the ball.
    def latitude(radius: float, angle: float) -> Manifold:
        return ring(radius * cos(angle), 0.008 * radius, sides=8).translate((0, 0, radius * sin(angle)))

    radius = 0.5 * diameter
    arc = 0.02 * radius + 0.0025
    pin = 0.015 * radius + 0.0015
    reach = 1.03 * radius + 2.0 * clearance + arc + 0.004
    low = 2.0 * the_foot + post
    level = low + reach
    carrier = stand(low, arc)

    def tilted(*solids: Manifold) -> Manifold:
        return union(*solids).rotate((0, degrees(tilt), 0)).translate((0, 0, level))

    ends = [side * (1.02 * radius + clearance) for side in (-1.0, 1.0)]
    meridian = ring(reach, arc, 360.0 if mount == "ring" else 180.0)
    meridian = meridian.rotate((0, 0, -90.0)).rotate((90.0, 0, 0))
    wide = pin + clearance + 0.003
    bosses = [cylinder(wide, end, copysign(reach + arc + 0.002, end)) for end in ends]
    hole = bore(pin, clearance, (0, 0, -2.0 * reach), (0, 0, 2.0 * reach))
    w.part(carrier, tilted(union(meridian, *bosses) - hole))
    lines = [latitude(radius, radians(angle)) for angle in latitudes]
    hubs = [cylinder(wide, 0.9 * end, copysign(1.02 * radius, end)) for end in ends]
    tips = reach + arc + 0.004
    shaft = cylinder(pin, -tips, tips)
    w.part("ball", tilted(ball(radius, (0, 0, 0), segments=64), *lines, *hubs, shaft), look="blue")
    axis = (sin(tilt), 0, cos(tilt))
    w.spin("ball", carrier, axis, (0, 0, level))
    w.settle()


@kind(
    words=(
        "parasol, sunshade, patio umbrella, garden umbrella, beach umbrella, sun umbrella, market umbrella, "
        "rain umbrella, pocket umbrella, golf umbrella, cocktail umbrella, cafe umbrella"
    ),
    carved_from="metal",
    height=length(0.5, 1.5, default=0.85, usual=(0.7, 1.0), help="Over all."),
    reach=length(0.2, 1.0, default=0.55, usual=(0.4, 0.65), help="Of a slat."),
    ribs=whole(4, 12, usual=(6, 10), help="Around the shaft.", words="rib, slat"),
    handle=choice({"crook": "crooked, hooked, curved", "straight": ""}, help="The part under it."),
)
def umbrella(
    w: ObjectBuilder, height: float, reach: float, ribs: int, handle: str, open: float, clearance: float
) -> None:
    """Umbrellas that stand on their handle: slats that spread from a crown, and a runner on the shaft."""
    knuckle = 0.003  # radius of a slat's hinge [m]
    hinge = 0.009  # length of a slat's hinge [m]
    the_shaft = 0.005  # radius [m]
    grip = 0.13  # height of the handle [m]
    opens = 1.3  # [rad]

    # A straight grip, or a crook whose lowest place is the ground.
    def handle_of() -> Sequence[Manifold]:
        if handle == "straight":
            return [cylinder(0.013, 0, grip, segments=32)]
        bend = 0.03
        thick = 0.009
        level = bend + thick
        hook = ring(bend, thick, 180.0).rotate((-90, 0, 0)).translate((bend, 0, level))
        return [
            hook,
            cylinder(thick, level - 0.0001, grip, segments=32),
            rod(thick, 2.0 * bend, 0, (level, level + 0.012)),
        ]

    # A thin plate that hangs from the origin, as wide as its neighbours allow while all hang down.
    def slat_of(circle: float, longest: float) -> Manifold:
        gap = max(clearance, 0.0005)
        half = (circle - 0.001) * tan(pi / ribs) - gap
        low = -min(reach, longest)
        start = -2.0 * knuckle
        return hull(
            slab(0.25 * hinge, 0.001, (start - 0.01, start)),
            slab(half, 0.001, (0.7 * low, 0.3 * low)),
            slab(0.3 * half, 0.001, (low, low + 0.002)),
        )

    top = height - 0.05
    gap = min(clearance, 0.15 * knuckle)
    circle = max(0.026, 0.5 * (hinge + 0.003) / tan(pi / ribs) + knuckle)
    above = top + 2.5 * knuckle
    crown = cylinder(circle + 1.2 * knuckle, above, above + 0.006)
    point = rod(0.6 * the_shaft, top, top + 0.05 - 0.6 * the_shaft)
    shaft = cylinder(the_shaft, 0.5 * grip, above + 0.012, segments=32)
    w.part("shaft", handle_of(), shaft, point, crown)
    # A sleeve that is pushed up the shaft.
    start = grip + 0.03
    tall = 0.04
    sleeve = cylinder(0.012, start, start + tall) + cylinder(0.015, start + tall - 0.006, start + tall)
    gap_2 = min(clearance, 0.002)
    rib = slab(0.0015, (0, the_shaft + 0.003), (start - 0.01, top - 0.01))
    groove = slab(0.0015 + gap_2, (0, the_shaft + 0.003 + gap_2), (0, 2.0 * top))
    w.part("shaft", rib)
    w.part("runner", sleeve - bore(the_shaft, gap_2, (0, 0, 0), (0, 0, 2.0 * top)) - groove, look="plastic")
    way = 0.9 * (top - 0.02 - start - tall)
    w.slide("runner", "shaft", (0, 0, 1), way, pivot=(0, 0, start), rest=open * way)
    forked, tongue = [half.rotate((180, 0, 0)) for half in fork(hinge, knuckle, gap, 3.0 * knuckle)]
    slat = tongue + slat_of(circle, top - grip - 0.02)
    for k in range(ribs):
        angle = 2.0 * pi * k / ribs
        name = f"rib_{k + 1}"
        for part, its in (("shaft", forked), (name, slat)):
            w.part(part, its.translate((0, -circle, top)).rotate((0, 0, degrees(angle))))
        axis = (-cos(angle), -sin(angle), 0)
        pivot = (circle * sin(angle), -circle * cos(angle), top)
        w.hinge(name, "shaft", axis, pivot, opens, rest=open * opens)
        w.follow(name, "runner", opens / way)
    w.settle()


@kind(
    words=(
        "glasses, pair of glasses, pair of eyeglasses, spectacles, pair of spectacles, sunglasses, pair of sunglasses, "
        "reading glasses, safety glasses, 3d glasses"
    ),
    title="pair of eyeglasses",
    width=length(0.11, 0.17, default=0.138, usual=(0.125, 0.15), help="Of the frame."),
    lens=length(0.025, 0.055, usual=(0.03, 0.048), help="Its height."),
    bridge=length(0.014, 0.024, default=0.018, usual=(0.015, 0.022), help="Its width."),
    temple=length(0.09, 0.16, default=0.135, usual=(0.125, 0.148), help="Length of a temple."),
    shape=choice({"rectangular": "square", "round": "circular"}, help="Of the lenses.", words="lens, frame"),
    carved_from="plastic",
)
def eyeglasses(
    w: ObjectBuilder, width: float, lens: float, bridge: float, temple: float, shape: str, open: float, clearance: float
) -> None:
    """Eyeglasses: a frame with two lenses that looks along -y, and temples that fold in behind it.

    The pins lean a little, so that one folded temple rises inwards and the other sinks: they lie one above the other.
    """
    knuckle = 0.0018  # radius and length of a hinge [m]
    rim = 0.0025  # width of a rim [m]
    deep = 0.003  # thickness of the frame [m]
    thick = 0.0032  # of a temple [m]
    lean = 0.1  # of the pins [rad]
    hinge = 0.006  # radius and length of a hinge [m]
    the_back = 0.011  # from the front of the frame to the pins [m]
    the_high = 0.0038  # of a temple [m]

    # A rounded plate of the shape of a lens, smaller by `inset`.
    def outline(x: float, wide: float, inset: float, start: float | None = None, end: float = deep) -> Manifold:
        begin = (0.0 if inset == 0.0 else -1.0) if start is None else start
        stop = end if start is not None or inset == 0.0 else 1.0
        high = lens
        radius = (0.5 if shape == "round" else 0.25) * min(wide, high) - 0.0001
        places = [
            (x + sx * (0.5 * wide - radius), 0.5 * high + sz * (0.5 * high - radius))
            for sx in (-1, 1)
            for sz in (-1, 1)
        ]
        return hull(*[cylinder(radius - inset, px, (begin, stop), pz) for px, pz in places])

    # Rims with lenses, a bridge and two pads for the nose.
    def frame() -> Sequence[Manifold]:
        high = lens
        wide = 0.5 * (width - bridge) - 0.007
        made: list[Manifold] = []
        for side in (-1.0, 1.0):
            x = side * 0.5 * (bridge + wide)
            outer, inner = [outline(x, wide, inset) for inset in (0.0, rim)]
            lens_2 = outline(x, wide, 0.5 * rim, start=0.3 * deep, end=0.7 * deep)
            pad = (side * 0.4 * bridge, 0.007, 0.35 * high)
            root = (side * (0.5 * bridge + 0.5 * rim), 0.5 * deep, 0.5 * high)
            made = [*made, outer - inner, lens_2, ball(0.0025, pad, segments=16), rod(0.0007, root, pad)]
        arch = [(s * (0.5 * bridge + 0.4 * rim), 0.5 * deep, z) for s, z in ((-1.0, 0.62 * high), (1.0, 0.62 * high))]
        top = (0.0, 0.5 * deep, 0.7 * high)
        return [*made, *[hull(*[ball(0.45 * deep, end, segments=16) for end in (one, top)]) for one in arch]]

    # Height of the temples, above the middle of the lenses [m].
    level = 0.7 * lens

    # Both halves of a barrel about a leaning pin, for the frame and for the unfolded temple.
    def hinge_of(pivot: FloatArray, side: float, off_face: float, gap: float) -> tuple[Manifold, Manifold]:
        x0, x1 = sorted((side * (off_face - 0.0001), side * (off_face + 0.0005)))
        on_frame = (x0, x1, -gap - 0.004, -gap - 0.0016)
        on_temple = (x0, x1, gap + 0.0016, gap + 0.004)
        turn = np.array([[1.0, 0.0, -lean], [0.0, hypot(lean, 1.0), 0.0], [lean, 0.0, 1.0]]) / hypot(lean, 1.0)
        of_frame, of_temple = barrel(hinge, knuckle, gap, (on_frame, on_temple))
        return (of_frame.transform(at(pivot, turn)), of_temple.transform(at(pivot, turn)))

    # The corner of the frame, from the rim outwards and back to the hinge.
    def end_of(side: float, gap: float) -> Manifold:
        half = 0.5 * width
        low = level - 0.6 * the_high
        top = level + 0.6 * the_high
        across = sorted((side * (half - 0.013), side * half))
        back = sorted((side * (half - thick), side * half))
        return box((across[0], 0, low), (across[1], deep, top)) + box(
            (back[0], 0, low), (back[1], the_back - 0.5 * gap, top)
        )

    # Unfolded: it runs straight back and bends down a little behind the ear.
    def temple_of(side: float, gap: float) -> Manifold:
        half = 0.5 * width
        length = temple
        x0, x1 = sorted((side * (half - thick), side * half))
        bend = the_back + 0.72 * length
        drop = 0.3 * lean * width
        low = level - 0.5 * the_high
        top = level + 0.5 * the_high
        joint = box((x0, bend, low), (x1, bend + 0.001, top))
        tip = box((x0, the_back + length - 0.001, low - drop), (x1, the_back + length, top - drop))
        return union(box((x0, the_back + 0.5 * gap, low), (x1, bend + 0.001, top)), hull(joint, tip))

    # Return the transform, shape (3, 4), that turns about a line.
    def about(axis: FloatArray, pivot: FloatArray, angle: float) -> FloatArray:
        rotation = rotation_about(axis, angle)
        return at(pivot - rotation @ pivot, rotation)

    gap = min(clearance, 0.3 * knuckle)
    w.part("frame", frame())
    for k, side in enumerate((-1.0, 1.0)):
        inner = 0.5 * width - thick
        off_face = knuckle + gap + 0.5 * lean * hinge
        pivot = vector(side * (inner - off_face), the_back, level)
        of_frame, of_temple = hinge_of(pivot, side, off_face, gap)
        w.part("frame", end_of(side, gap), of_frame)
        axis = side * vector(lean, 0.0, -1.0) / hypot(lean, 1.0)
        opened = temple_of(side, gap) + of_temple
        name = f"temple_{k + 1}"
        w.part(name, opened.transform(about(axis, pivot, -0.5 * pi)))
        w.hinge(name, "frame", axis, pivot, 0.5 * pi, rest=open * (0.5 * pi))
    w.settle()
