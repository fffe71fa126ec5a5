"""Beds, seats and tables that fold, tilt or extend."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from kinematify.generate.library.kind import choice, kind, whole
from kinematify.generate.library.mechanisms import case, caster, legs, wheel
from kinematify.generate.library.panels import grip
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, slab


@kind(words="sliding door sideboard, sliding door cabinet", width=(1.0, 2.0), height=(0.5, 0.9), depth=(0.35, 0.5))
def sideboard_with_sliding_doors(b: ObjectBuilder, width: float, height: float, depth: float) -> None:
    """Two panels that pass each other before a case."""
    case(b, "case", (-width / 2, 0, 0.1), (width / 2, depth, height), opening=-Y, wall=0.02)
    legs(b, "case", (-width / 2, 0, 0), (width / 2, depth, 0.105), 0.05)
    b.part("case", slab(width / 2, (-0.06, 0.01), (0.1, 0.12)), slab(width / 2, (-0.06, 0.01), (height - 0.02, height)))
    play1 = b.gap(0.02)
    for k, s in enumerate((-1, 1)):
        y = -0.022 - 0.022 * k
        b.part(
            f"door_{k}",
            box(
                (min(0, s * width / 2) - 0.03 * (s > 0), y - 0.018, 0.12 + play1),
                (max(0, s * width / 2) + 0.03 * (s < 0), y, height - 0.02 - play1),
            ),
        )
        if b.style.grips != "none":
            b.part(
                f"door_{k}", b.cylinder(0.03, 0.85 * s * width / 2, (y - 0.0181 - (0.002 if k else 0), y), height / 2)
            )
        b.slide(f"door_{k}", "case", -s * X, width / 2 - 0.04)


@kind(
    words="sit stand desk, height adjustable desk, adjustable desk, lifting desk",
    width=(1.0, 1.8),
    depth=(0.6, 0.8),
    height=(0.6, 0.75),
)
def standing_desk(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A top on two or one telescopic columns."""
    g = b.gap(0.06)
    for x in (-0.35 * width, 0.35 * width):
        b.part(
            "feet",
            slab((x - 0.04, x + 0.04), depth / 2 - 0.05, (0, 0.03)),
            slab((x - 0.04, x + 0.04), 0.04, (0.02, 0.55)),
            look="steel",
        )
        b.bore("feet", slab((x - 0.03 - g, x + 0.03 + g), 0.03 + g, (0.05, 0.6)))
        b.part("top", slab((x - 0.03, x + 0.03), 0.03, (0.1 if b.style.has_bore else 0.54, height)))
    b.part("feet", slab(0.35 * width, 0.02, (0.03, 0.1)))
    b.part("top", slab(width / 2, depth / 2, (height, height + 0.025)), look="wood")
    b.slide("top", "feet", Z, b.draw(0.3, 0.5))


@kind(
    words=(
        "swivel stool, bar stool, screw stool, music stool, stool, swivel bar stool, counter stool, pub stool, work "
        "stool, drafting stool, lab stool, vanity stool, kitchen stool, drum stool, drum throne, rotating stool, "
        "artist stool, massage stool, doctor stool, dentist stool, shop stool, revolving stool, spinning stool, "
        "cobbler stool"
    ),
    radius=(0.15, 0.22),
    height=(0.4, 0.6),
)
def piano_stool(b: ObjectBuilder, radius: float, height: float) -> None:
    """A seat that turns on its screw."""
    b.part("base", b.cylinder(0.04, 0.1, height), look="wood")
    n = b.count(3, 5)
    for a in np.arange(n) * 2 * pi / n:
        b.part("base", beam(0.04, 0.04, (0, 0, 0.2), (1.2 * radius * cos(a), 1.2 * radius * sin(a), 0.02)))
    g = b.gap(radius)
    b.part("seat", b.cylinder(radius, height + g, height + b.draw(0.03, 0.1)))
    if b.style.has_bore:
        b.cut("base", b.cylinder(0.02 + 2 * g, 0.2, height + 0.01))
        b.part("seat", b.cylinder(0.02, 0.22, height + 0.02))
    b.spin("seat", "base", Z, (0, 0, height))


@kind(
    words="storage bed, captains bed, bed with drawers, pull out bed",
    width=(0.8, 1.2),
    number=whole(1, 2, words="box, drawer"),
)
def trundle_bed(b: ObjectBuilder, width: float, number: int) -> None:
    """A second bed on wheels, or a bed box, below the first."""
    t = 2.0
    h = 0.45
    b.part(
        "bed",
        box((0, 0, 0.3), (t, width, h)),
        box((0, 0, 0), (0.03, width, 0.9)),
        box((t - 0.03, 0, 0), (t, width, 0.7)),
        look="wood",
    )
    for k, x in enumerate(spread(number, 0.04, t - 0.04)):
        half = (t - 0.1) / 2 / number
        g = b.gap(0.1) + 0.002
        b.part(f"box_{k}", box((x - half, -0.01, 0.04), (x + half, 0.85 * width, 0.27)), look="wood")
        if b.style.drawer == "tray":
            b.cut(f"box_{k}", box((x - half + 0.02, 0.01, 0.06), (x + half - 0.02, 0.85 * width - 0.02, 0.4)))
        b.part("bed", box((x - half, 0.85 * width + g, 0.1), (x + half, 0.85 * width + g + 0.02, 0.31)))
        b.slide(f"box_{k}", "bed", -Y, 0.6)


@kind(words="cot, baby crib, baby bed, baby cot, infant bed", width=(1.1, 1.4), depth=(0.6, 0.75), height=(0.8, 1.0))
def crib(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A cot with a side that slides down or swings out."""
    b.part("cot", box((0, 0, 0.25), (width, depth, 0.3)), look="wood")
    for x in (0, width):
        b.part("cot", box((x - 0.02, 0, 0), (x + 0.02, depth, height)))
    b.part("cot", box((0, depth - 0.03, 0.25), (width, depth, height)))
    g = b.gap(0.05)
    bars = [b.cylinder(0.008, x, -0.025, (0.32, height)) for x in spread(b.count(8, 16), 0.04, width - 0.04)]
    rails = [box((0.021 + g, -0.045, z), (width - 0.021 - g, -0.005, z + 0.04)) for z in (0.3, height - 0.04)]
    b.part("side", bars, rails)
    if b.maybe():
        b.slide("side", "cot", -Z, 0.25)
    else:
        b.hinge("side", "cot", X, (width / 2, -0.025, 0.31), 1.5)


@kind(
    words=(
        "serving trolley, tea trolley, serving cart, tea cart, kitchen cart, kitchen trolley, hostess trolley, "
        "drinks trolley, drinks cart, dessert cart, service cart, service trolley, dish cart, utility cart, rolling "
        "cart"
    ),
    width=(0.5, 0.9),
    depth=(0.35, 0.5),
    height=(0.7, 0.95),
    kind=choice(("casters", "wheels")),
)
def bar_cart(b: ObjectBuilder, width: float, depth: float, height: float, kind: str) -> None:
    """Two trays on a frame with four wheels or casters, and a drawer."""
    foot = 0.1
    legs(b, "frame", (-width / 2, -depth / 2, foot), (width / 2, depth / 2, height), 0.03)
    for z in (foot + 0.02, 0.55 * height, height - 0.05):
        b.part("frame", slab(width / 2, depth / 2, (z, z + 0.03)), look="steel")
    corners = [(x, y) for x in (-width / 2 + 0.015, width / 2 - 0.015) for y in (-depth / 2 + 0.015, depth / 2 - 0.015)]
    for k, (x, y) in enumerate(corners):
        if kind == "casters":
            caster(b, f"caster_{k}", "frame", (x, y, foot), foot)
        else:
            s = np.sign(y)
            wheel(b, f"wheel_{k}", "frame", (x, y + s * 0.03, 0.06), 0.06, 0.025, s * Y, axle=0.012)
            b.part("frame", box((x - 0.015, y - 0.012, 0.05), (x + 0.015, y + 0.012, foot + 0.01)))


@kind(words="rotating bookcase, revolving bookcase", width=(0.35, 0.5), height=(0.6, 1.4), foot=(0.04, 0.1))
def swivel_bookcase(b: ObjectBuilder, width: float, height: float, foot: float) -> None:
    """A square bookcase that turns on its foot."""
    b.part("foot", b.cylinder(0.45 * width, 0, foot), look="wood")
    g = b.gap(width)
    b.part("case", slab(width / 2, width / 2, (foot + g, height)), look="wood")
    for z in spread(3, foot, height):
        for s in (-1, 1):
            corner = (s * (width / 2 + 1), 0.02 - width / 2, z - 0.12 * height)
            b.cut("case", box(corner, (s * 0.02, width / 2 - 0.02, z + 0.12 * height)))
    b.spin("case", "foot", Z, (0, 0, foot))


@kind(words="tambour cabinet, roll front cabinet", width=(0.6, 1.2), height=(0.6, 1.8))
def roller_shutter_cabinet(b: ObjectBuilder, width: float, height: float) -> None:
    """A shutter of slats drawn as one plate that slides up or aside."""
    t = 0.4
    case(b, "cabinet", (-width / 2, 0, 0), (width / 2, t, height), opening=-Y, wall=0.03)
    g = b.gap(0.02)
    z0 = 0.03 + g
    z1 = height * b.draw(0.45, 0.95)
    b.part("shutter", slab(width / 2 - 0.005 - g, (-0.015 - g, -g), (z0, z1)))
    for z in spread(int((z1 - z0) / 0.05), z0, z1):
        b.part("shutter", b.cylinder(0.008, (-width / 2 + 0.01, width / 2 - 0.01), -0.015 - g, z))
    grip(b, "shutter", (0, -0.015 - g, z0 + 0.06), -Y, X, 0.12)
    b.slide("shutter", "cabinet", Z, 0.7 * (z1 - z0))


@kind(
    words="double decker bed",
    part_words={"drawer": "bed box, box"},
    width=(0.8, 1.0),
    height=(1.5, 1.8),
    number=whole(1, 3, words="drawer, bed box, storage box"),
)
def bunk_bed(b: ObjectBuilder, width: float, height: float, number: int) -> None:
    """Two beds above each other, a ladder, drawers below."""
    t = 2.0
    up = height - 0.45
    b.part(
        "bed",
        [box((x, y, 0), (x + 0.06, y + 0.06, height)) for x in (0, t - 0.06) for y in (0, width - 0.06)],
        [box((0, 0, z), (t, width, z + 0.1)) for z in (0.35, up)],
        [box((0, y, height - 0.12), (t, y + 0.03, height - 0.02)) for y in (0, width - 0.03)],
        look="wood",
    )
    x = t - 0.55
    b.part(
        "ladder",
        [box((x + a, -0.035, 0), (x + a + 0.04, -0.0005, height)) for a in (0, 0.36)],
        [b.cylinder(0.015, (x + 0.02, x + 0.38), -0.018, z) for z in spread(5, 0.1, height - 0.2)],
        look="wood",
    )
    b.fix("ladder", "bed")
    for k, x in enumerate(spread(number, 0.08, t - 0.6)):
        half = (t - 0.74) / 2 / number
        g = b.gap(0.1) + 0.002
        b.part(f"drawer_{k}", box((x - half, 0.005, 0.04), (x + half, 0.85 * width, 0.3)), look="wood")
        b.cut(f"drawer_{k}", box((x - half + 0.02, 0.025, 0.06), (x + half - 0.02, 0.85 * width - 0.02, 0.4)))
        b.part("bed", box((x - half, 0.85 * width + g, 0.1), (x + half, 0.85 * width + g + 0.02, 0.36)))
        b.slide(f"drawer_{k}", "bed", -Y, 0.5)
