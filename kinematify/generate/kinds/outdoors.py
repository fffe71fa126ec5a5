"""Things of a garden and a playground."""

from __future__ import annotations

from math import cos, sin

from kinematify.generate.library.kind import kind
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, box, slab, tray


@kind(
    words=("garden swing seat, hollywood swing, canopy swing, swing bench"),
    part_words={"seat": "bench, swing"},
    details={"roof": 1, "frame": 1},
    width=(1.2, 2.0),
)
def swing_seat(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "frame",
        [b.rod(0.025, (s * (w + 0.2), 0, 1.7), (s * (w + 0.2), t * 0.6, 0.03)) for s in (-1, 1) for t in (-1, 1)],
        b.rod(0.025, (-w - 0.2, w + 0.2), 0, 1.7),
        [b.rod(0.02, s * (w + 0.2), (-0.6, 0.6), 0.03) for s in (-1, 1)],
        look="green steel",
    )
    b.part(
        "seat",
        slab(w, (-0.3, 0.25), (0.42, 0.47)),
        slab(w, (0.2, 0.25), (0.46, 0.95)),
        [b.rod(0.01, (s * (w - 0.03), t * 0.22, 0.46), (s * (w - 0.03), 0, 1.66)) for s in (-1, 1) for t in (-1, 1)],
        [b.torus(0.042, 0.008, (s * (w - 0.03), 0, 1.7), X) for s in (-1, 1)],
        look="wood",
    )
    b.hinge("seat", "frame", X, (0, 0, 1.7), 0.35, -0.35)
    b.part(
        "canopy",
        slab(w + 0.2, 0.6, (1.78, 1.8)),
        [slab((s * (w + 0.1) - 0.02, s * (w + 0.1) + 0.02), 0.02, (1.732, 1.79)) for s in (-1, 1)],
        look="green",
    )
    b.hinge("canopy", "frame", X, (0, 0, 1.74), 0.25, -0.25)


@kind(
    "pull-along duck",
    words="duck on wheels, toy duck",
    part_words={"wing": "wings"},
    details={"beak": 1},
    size=(0.8, 1.5),
)
def pull_along_duck(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab((-0.08, 0.07), 0.03, (0.03, 0.1)),
        p.cylinder(0.03, 0.06, (-0.028, 0.028), 0.075),
        p.slab((0.03, 0.06), 0.02, (0.09, 0.13)),
        p.beam(0.04, 0.05, (-0.07, 0, 0.09), (-0.11, 0, 0.12), Y),
        look="yellow wood",
    )
    b.part(
        "head",
        p.cylinder(0.03, 0.05, (-0.02, 0.02), 0.165),
        p.cone(0.014, 0.004, (0.075, 0, 0.16), (0.11, 0, 0.158)),
        look="yellow wood",
    )
    b.hinge("head", "body", Y, p(0.045, 0, 0.135), 0.25, -0.1)
    for k, s in enumerate((-1, 1)):
        b.part(
            f"wing_{k + 1}",
            p.box((-0.06, min(s * 0.031, s * 0.037), 0.05), (0.02, max(s * 0.031, s * 0.037), 0.095)),
            look="orange wood",
        )
        b.hinge(f"wing_{k + 1}", "body", s * X, p(0, s * 0.034, 0.095), 1.2)
        for j, x in enumerate((-0.05, 0.045)):
            b.part(f"wheel_{2 * k + j + 1}", p.cylinder(0.025, x, (s * 0.034, s * 0.046), 0.025), look="red wood")
            b.spin(f"wheel_{2 * k + j + 1}", "body", Y, p(x, 0, 0.025))


@kind(
    words="service lift, food lift, goods lift",
    part_words={"car": "cabin, platform, lift", "door": "hatch, sash, shutter"},
    height=(1.8, 3.0),
)
def dumbwaiter(b: ObjectBuilder, height: float) -> None:
    h = height
    b.part(
        "shaft",
        slab(0.32, (0.3, 0.33), (0, h)),
        [box((s * 0.32 - 0.01, -0.3, 0), (s * 0.32 + 0.01, 0.33, h)) for s in (-1, 1)],
        slab(0.32, (-0.3, 0.33), (h - 0.02, h)),
        slab(0.32, (-0.3, 0.33), (0, 0.02)),
        slab(0.32, (-0.3, -0.28), (0, 0.5)),
        slab(0.32, (-0.3, -0.28), (1.3, h)),
        look="metal",
    )
    b.part(
        "car",
        slab(0.28, (-0.25, 0.28), (0.5, 0.52)),
        slab(0.28, (-0.25, 0.28), (0.98, 1.0)),
        slab(0.28, (0.26, 0.28), (0.5, 1.0)),
        [box((s * 0.29 - 0.01, -0.25, 0.5), (s * 0.29 + 0.01, 0.28, 1.0)) for s in (-1, 1)],
        look="steel",
    )
    b.slide("car", "shaft", Z, h - 1.05, lower=-0.45)
    b.part(
        "door", slab(0.3, (-0.325, -0.305), (0.48, 0.92)), slab(0.06, (-0.35, -0.324), (0.5, 0.52)), look="grey steel"
    )
    b.slide("door", "shaft", Z, 0.42)


@kind(
    walls=120,
    words="aerial work platform, boom lift, bucket truck, aerial lift, sky lift",
    part_words={
        "basket": "bucket, cage, platform",
        "turntable": "turret, cab",
        "lower_boom": "boom, lower arm",
        "upper_boom": "upper arm, boom",
    },
    size=(0.8, 1.2),
)
def cherry_picker(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("chassis", p.slab(1.2, 0.55, (0.35, 0.7)), p.cylinder(0.3, -0.6, 0, (0.69, 0.78)), look="yellow steel")
    for k, s in enumerate((-1, 1)):
        for j, x in enumerate((-0.8, 0.8)):
            b.part(f"wheel_{2 * k + j + 1}", p.cylinder(0.32, x, (s * 0.551, s * 0.78), 0.32), look="black rubber")
            b.spin(f"wheel_{2 * k + j + 1}", "chassis", Y, p(x, 0, 0.32))
    b.part(
        "turntable",
        p.cylinder(0.35, -0.6, 0, (0.79, 0.88)),
        [p.box((-0.75, s * 0.2 - 0.03, 0.87), (-0.45, s * 0.2 + 0.03, 1.25)) for s in (-1, 1)],
        look="grey steel",
    )
    b.spin("turntable", "chassis", Z, p(-0.6, 0, 0))
    b.part("lower_boom", p.beam(0.2, 0.2, (-0.6, 0, 1.15), (1.0, 0, 1.75), Y), look="yellow steel")
    b.hinge("lower_boom", "turntable", -Y, p(-0.6, 0, 1.15), 0.9, -0.2)
    b.part(
        "upper_boom",
        p.beam(0.14, 0.12, (1.0, 0.19, 1.75), (-0.9, 0.19, 2.2), Y),
        p.cylinder(0.05, 0.98, (0.1, 0.15), 1.745),
        look="yellow steel",
    )
    b.hinge("upper_boom", "lower_boom", Y, p(1.0, 0.19, 1.75), 2.0, -0.15)
    b.part(
        "basket",
        tray(p(-1.58, -0.1, 1.75), p(-1.0, 0.7, 2.4), 0.03 * size),
        p.cylinder(0.04, -0.9, (0.251, 0.32), 2.2),
        p.box((-1.01, 0.28, 2.17), (-0.88, 0.32, 2.23)),
        look="grey steel",
    )
    b.hinge("basket", "upper_boom", -Y, p(-0.9, 0.25, 2.2), 1.0, -1.0)


@kind(words="ship's capstan, anchor capstan", part_words={"drum": "barrel, head", "bar": "lever"}, size=(0.7, 1.3))
def capstan(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("base", p.cylinder(0.4, 0, 0.1), p.cylinder(0.06, 0.09, 0.9), look="wood")
    b.part(
        "drum",
        p.cylinder(0.2, 0.11, 0.7),
        p.cylinder(0.3, 0.68, 0.85),
        [
            p.rod(0.03, (0.28 * cos(a), 0.28 * sin(a), 0.77), (1.1 * cos(a), 1.1 * sin(a), 0.77))
            for a in [6.28318 * k / 6 for k in range(6)]
        ],
        look="wood",
    )
    b.cut("drum", p.cylinder(0.063, 0, 1))
    b.spin("drum", "base", Z, (0, 0, 0))


@kind(
    words="ship's window, bullseye window, port light",
    part_words={"window": "glass, cover, lid, door", "dog": "screw, wing nut, clamp, latch"},
    radius=(0.12, 0.25),
)
def porthole(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    b.part(
        "frame",
        p.tube(1.35, 0.95, 0, (0, 0.12), 0),
        [
            box((-1.45 * r, -0.22 * r, s * 0.3 * r - 0.07 * r), (-1.2 * r, 0.05 * r, s * 0.3 * r + 0.07 * r))
            for s in (-1, 1)
        ],
        look="brass",
    )
    b.bore("frame", p.cylinder(0.05, -1.33, -0.12, (-1, 1)))
    b.part(
        "window",
        p.cylinder(1.12, 0, (-0.18, -0.04), 0),
        p.cylinder(0.04, -1.33, -0.12, (-0.36, 0.36)),
        p.slab((-1.33, -1.0), (-0.16, -0.08), 0.2),
        look="glass",
    )
    b.hinge("window", "frame", -Z, [-1.33 * r, -0.12 * r, 0], 1.7)
    for k, s in enumerate((-1, 1)):
        b.part(
            f"dog_{k + 1}",
            p.cylinder(0.06, 0.95, (-0.3, -0.005), s * 0.82),
            box((0.88 * r, -0.3 * r, s * 0.82 * r - 0.25 * r), (1.02 * r, -0.22 * r, s * 0.82 * r + 0.05 * r)),
            look="brass",
        )
        b.hinge(f"dog_{k + 1}", "frame", Y, [0.95 * r, 0, s * 0.82 * r], 1.5)


@kind(words="puppet theater, puppet stage, toy theatre, toy theater", part_words={"curtain": "drape"}, width=(0.5, 1.2))
def puppet_theatre(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "stage",
        slab(w, (0, 0.3), (0, 0.4 * width)),
        [box((x - 0.07 * w, 0, 0.3 * width), (x + 0.07 * w, 0.03, 1.1 * width)) for x in (-0.93 * w, 0.93 * w)],
        slab(w, (0, 0.03), (0.95 * width, 1.2 * width)),
        b.cylinder(0.008, (-0.9 * w, 0.9 * w), 0.05, 0.97 * width),
        [box((x - 0.03, 0.02, 0.96 * width), (x + 0.03, 0.06, 0.985 * width)) for x in (-0.95 * w, 0.95 * w)],
        look="wood",
    )
    for k, s in enumerate((-1, 1)):
        left, right = sorted((s * 0.005, s * 0.45 * w))
        b.part(
            f"curtain_{k + 1}",
            box((left, 0.04, 0.42 * width), (right, 0.06, 0.97 * width - 0.012)),
            [b.torus(0.013, 0.003, (s * x * w, 0.05, 0.97 * width), X) for x in (0.08, 0.25, 0.4)],
            look="red",
        )
        b.slide(f"curtain_{k + 1}", "stage", s * X, 0.4 * w)


@kind(
    words="dish drainer, draining rack, plate rack",
    part_words={"tray": "drip tray, drawer"},
    details={"wire": 1},
    width=(0.35, 0.55),
)
def dish_rack(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "rack",
        [b.rod(0.004, s * w, (-0.15, 0.15), 0.06) for s in (-1, 1)],
        [b.rod(0.004, (-w, w), t * 0.15, 0.06) for t in (-1, 1)],
        [b.rod(0.004, s * w, t * 0.15, (0.004, 0.17)) for s in (-1, 1) for t in (-1, 1)],
        [b.rod(0.003, x, (-0.15, 0.15), 0.06) for x in spread(9, -w + 0.03, w - 0.03)],
        [b.rod(0.003, x, 0.05, (0.06, 0.15)) for x in spread(9, -w + 0.03, w - 0.03)],
        [b.rod(0.004, (-w, w), t * 0.15, 0.17) for t in (-1, 1)],
        [b.rod(0.004, s * w, (-0.15, 0.15), 0.012) for s in (-1, 1)],
        look="steel",
    )
    b.part("tray", tray((-w + 0.006, -0.16, 0.017), (w - 0.006, 0.14, 0.045), 0.003), look="grey")
    b.slide("tray", "rack", -Y, 0.2)


@kind(
    words="meat slicer, food slicer, bread cutter, ham slicer, bacon slicer, slicing machine",
    part_words={"blade": "disc, knife", "carriage": "sled, table", "crank": "hand crank, handle"},
    size=(0.9, 1.3),
)
def bread_slicer(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("body", p.slab(0.16, 0.18, (0, 0.03)), p.slab((0.02, 0.12), 0.05, (0.025, 0.2)), look="white metal")
    b.bore("body", p.cylinder(0.012, (-1, 1), 0, 0.15))
    b.part("blade", p.cylinder(0.1, (0.008, 0.012), 0, 0.15), p.cylinder(0.01, (0.01, 0.16), 0, 0.15), look="steel")
    b.spin("blade", "body", X, p(0, 0, 0.15))
    b.part(
        "crank",
        p.beam(0.02, 0.012, (0.168, 0, 0.15), (0.168, 0, 0.06), X),
        p.rod(0.009, (0.17, 0.23), 0, 0.06),
        look="metal",
    )
    b.fix("crank", "blade")
    b.part(
        "carriage",
        p.box((-0.14, -0.12, 0.034), (-0.01, 0.06, 0.044)),
        p.box((-0.14, 0.05, 0.04), (-0.01, 0.06, 0.16)),
        look="metal",
    )
    b.slide("carriage", "body", Y, 0.1, lower=-0.05)


@kind(
    words="lab stirrer, overhead stirrer, stirrer, stirring machine, agitator",
    part_words={"paddle": "impeller, propeller, blade, stirrer shaft", "head": "motor, drive"},
    size=(0.9, 1.3),
)
def laboratory_stirrer(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("stand", p.slab(0.12, (-0.16, 0.12), (0, 0.02)), p.cylinder(0.009, 0, 0.08, (0.015, 0.7)), look="steel")
    b.part("head", p.slab(0.05, 0.1, (0.46, 0.56)), look="white")
    b.bore("head", p.cylinder(0.0098, 0, 0.08, (0, 1)), p.cylinder(0.006, 0, -0.04, (0.4, 0.52)))
    b.slide("head", "stand", Z, 0.13, lower=-0.1)
    b.part(
        "paddle",
        p.cylinder(0.005, 0, -0.04, (0.17, 0.51)),
        [p.box((s * 0.02 - 0.018, -0.042, 0.17), (s * 0.02 + 0.018, -0.038, 0.2)) for s in (-1, 1)],
        look="steel",
    )
    b.spin("paddle", "head", Z, p(0, -0.04, 0))
