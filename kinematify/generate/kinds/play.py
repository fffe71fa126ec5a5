"""Toys and playground equipment."""

from __future__ import annotations

from math import cos, sin

from kinematify.generate.library.kind import kind, length, whole
from kinematify.generate.library.mechanisms import button, knob, plunger
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, prism, slab, vector


@kind(walls=3, words="humming top, toy top", size=(0.9, 1.3))
def spinning_top(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("stand", p.cylinder(0.05, 0, 0.01), p.cylinder(0.012, 0, 0.03), look="wood")
    b.part(
        "top",
        p.lathe([(0, 0.032), (0.02, 0.04), (0.08, 0.1), (0.06, 0.13), (0.015, 0.16), (0, 0.16)], (0, 0, 0)),
        look="red metal",
    )
    b.bore("top", p.cylinder(0.0065, 0.06, 1))
    b.spin("top", "stand", Z, (0, 0, 0))
    b.part("handle", p.cylinder(0.005, 0.09, 0.24), p.ball(0.014, (0, 0, 0.245)), look="yellow wood")
    b.slide("handle", "top", -Z, 0.025, lower=-0.03)


@kind(words="rubik's cube, magic cube, puzzle cube, twisty puzzle", size=(0.05, 0.07))
def rubiks_cube(b: ObjectBuilder, size: float) -> None:
    s = size / 3
    b.part("middle_layer", slab(1.5 * s, 1.5 * s, (s, 2 * s)), b.cylinder(0.3 * s, 0.2 * s, 2.8 * s), look="blue")
    b.part("top_layer", slab(1.5 * s, 1.5 * s, (2.01 * s, 3 * s)), look="yellow")
    b.part("bottom_layer", slab(1.5 * s, 1.5 * s, (0, 0.99 * s)), look="red")
    for name in ("top_layer", "bottom_layer"):
        b.cut(name, b.cylinder(0.32 * s, 0.15 * s, 2.85 * s))
        b.spin(name, "middle_layer", Z, (0, 0, 0))


@kind(size=(0.8, 1.2))
def crossbow(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "stock",
        p.slab(0.03, (-0.4, 0.3), (0, 0.05)),
        p.beam(0.04, 0.08, (0, 0.25, 0.02), (0, 0.5, -0.03), Z),
        [p.beam(0.02, 0.03, (0, -0.38, 0.03), (s * 0.35, -0.25, 0.03)) for s in (-1, 1)],
        look="wood",
    )
    b.bore("stock", p.slab(0.008, (0.09, 0.16), (-0.1, 0.03)), p.slab(0.01, (-0.38, 0.15), (0.03, 0.1)))
    b.part("trigger", p.beam(0.012, 0.01, (0, 0.12, 0.02), (0, 0.14, -0.06), Y), look="steel")
    b.hinge("trigger", "stock", X, p(0, 0.12, 0.02), 0.1, -0.2)
    b.part("slide", p.slab(0.009, (-0.1, -0.06), (0.031, 0.06)), look="steel")
    b.slide("slide", "stock", Y, 0.15, lower=-0.2)


@kind(words="fishing pole", length=(0.8, 1.4))
def fishing_rod(b: ObjectBuilder, length: float) -> None:
    b.part(
        "rod",
        b.cylinder(0.013, 0, (0.25, -0.2), 0),
        b.cylinder(0.007, 0, (-0.19, -length), 0),
        slab(0.012, 0.03, (-0.05, -0.01)),
        [slab((s * 0.026, s * 0.022), 0.03, (-0.1, -0.04)) for s in (-1, 1)],
        slab(0.026, 0.03, (-0.052, -0.045)),
        look="black",
    )
    b.bore("rod", b.cylinder(0.0055, 0, (1, -2), 0), b.cylinder(0.0045, (-0.05, 0.05), 0, -0.075))
    b.part("tip", b.cylinder(0.004, 0, (-0.3, -length - 0.1), 0), look="red")
    b.slide("tip", "rod", -Y, 0.6 * length - 0.2)
    b.part(
        "spool",
        b.cylinder(0.0035, (-0.02, 0.05), 0, -0.075),
        b.cylinder(0.018, (-0.02, 0.02), 0, -0.075),
        beam(0.008, 0.005, (0.045, 0, -0.075), (0.045, 0, -0.125), X),
        b.cylinder(0.006, (0.043, 0.07), 0, -0.12),
        look="metal",
    )
    b.spin("spool", "rod", X, (0, 0, -0.075))


@kind(words="cross trainer, elliptical, air walker", size=(0.9, 1.1))
def elliptical_trainer(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "frame",
        p.slab(0.25, (-0.7, -0.6), (0, 0.06)),
        p.slab(0.25, (0.6, 0.7), (0, 0.06)),
        p.slab(0.04, 0.65, (0.02, 0.09)),
        p.beam(0.08, 0.08, (0, -0.5, 0.05), (0, -0.4, 1.4), X),
        p.cylinder(0.02, (-0.28, 0.28), -0.44, 0.85),
        p.slab(0.15, (-0.5, -0.4), (1.35, 1.55)),
        p.cylinder(0.3, (-0.06, 0.06), 0.45, 0.4),
        p.slab(0.06, (0.4, 0.5), (0.05, 0.3)),
        look="black",
    )
    for k, s in enumerate((-1, 1)):
        b.part(
            f"handle_{k}",
            p.tube(0.035, 0.0225, (s * 0.2, s * 0.25), -0.44, 0.85),
            p.beam(0.03, 0.03, (s * 0.225, -0.44, 0.88), (s * 0.225, -0.3, 1.5), X),
            p.beam(0.03, 0.03, (s * 0.225, -0.44, 0.82), (s * 0.225, -0.4, 0.25), X),
            p.box((s * 0.12, -0.45, 0.18), (s * 0.24, 0, 0.25)),
            look="grey steel",
        )
        b.hinge(f"handle_{k}", "frame", X, p(0, -0.44, 0.85), 0.25, -0.25)


@kind(words="bench press, training bench", size=(0.9, 1.1))
def weight_bench(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "frame",
        p.slab(0.03, (-0.6, 0.7), (0.3, 0.36)),
        p.slab(0.3, (0.62, 0.68), (0, 0.05)),
        p.slab(0.3, (-0.6, -0.54), (0, 0.05)),
        p.slab(0.03, (-0.6, -0.54), (0, 0.31)),
        p.slab(0.03, (0.62, 0.68), (0, 0.31)),
        [p.box((s * 0.4, 0.6, 0.02), (s * 0.34, 0.66, 0.95)) for s in (-1, 1)],
        p.slab(0.4, (0.61, 0.65), (0.02, 0.06)),
        p.slab(0.14, (-0.6, -0.2), (0.36, 0.42)),
        look="black steel",
    )
    b.part("back", p.slab(0.14, (-0.19, 0.55), (0.365, 0.42)), look="red")
    b.hinge("back", "frame", X, p(0, -0.19, 0.42), 0.9)
    b.part(
        "bar",
        p.cylinder(0.014, (-0.7, 0.7), 0.63, 0.966),
        [p.cylinder(0.18, (s * 0.55, s * 0.61), 0.63, 0.966) for s in (-1, 1)],
        look="steel",
    )
    b.slide("bar", "frame", Z, 0.3)


@kind("dart board cabinet", width=(0.45, 0.6))
def dartboard_cabinet(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part("cabinet", slab(w, (0, 0.05), (0, width)), b.cylinder(0.42 * width, 0, (-0.02, 0.01), w), look="wood")
    b.cut("cabinet", b.cylinder(0.36 * width, 0, (-1, -0.016), w))
    for k, s in enumerate((-1, 1)):
        b.part(f"door_{k}", box((s * 0.002, -0.045, 0), (s * w, -0.03, width)), look="wood")
        b.part("cabinet", box((s * w, -0.028, 0), (s * (w - 0.02), 0.01, width)))
        b.hinge(f"door_{k}", "cabinet", s * Z, (s * w, -0.045, 0), 2.4)


@kind(words="pinball, flipper machine", width=(0.45, 0.6), length=(0.9, 1.2))
def pinball_machine(b: ObjectBuilder, width: float, length: float) -> None:
    w = width / 2
    b.part(
        "cabinet",
        slab(w, (0, length), (0.7, 0.95)),
        slab(w, (length - 0.25, length), (0.94, 1.6)),
        [
            box((x - 0.025, y - 0.025, 0), (x + 0.025, y + 0.025, 0.71))
            for x in (-w + 0.025, w - 0.025)
            for y in (0.025, length - 0.025)
        ],
        look="red wood",
    )
    b.cut(
        "cabinet",
        slab(w - 0.025, (0.03, length - 0.26), (0.86, 2)),
        slab(w - 0.03, (0.05, length - 0.05), (0.72, 0.84)),
    )
    b.part(
        "cabinet",
        [
            b.cylinder(0.03, x, y, (0.855, 0.9))
            for x, y in ((0, 0.6 * length), (-0.1, 0.5 * length), (0.1, 0.5 * length))
        ],
        [b.cylinder(0.005, s * 0.1, 0.14, (0.85, 0.885)) for s in (-1, 1)],
    )
    for k, s in enumerate((-1, 1)):
        b.part(
            f"flipper_{k}",
            b.cylinder(0.014, s * 0.1, 0.14, (0.862, 0.882)),
            beam(0.018, 0.018, (s * 0.1, 0.14, 0.872), (s * 0.035, 0.115, 0.872)),
            look="yellow",
        )
        b.cut(f"flipper_{k}", b.cylinder(0.0065, s * 0.1, 0.14, (0, 2)))
        b.hinge(f"flipper_{k}", "cabinet", s * -Z, (s * 0.1, 0.14, 0), 0.8)
        button(b, f"button_{k}", "cabinet", (s * w, 0.1, 0.85 - 0.02), (0.024, 0.024), 0.008, s * X, is_round=True)
    plunger(b, "plunger", "cabinet", (w - 0.06, -0.06, 0.8), (w - 0.06, 0.045, 0.8), 0.008, travel=0.05)


@kind(
    words="arcade cabinet, video game machine",
    width=(0.5, 0.7),
    number=whole(1, 10, default=4, usual=(3, 6), words="button"),
)
def arcade_machine(b: ObjectBuilder, width: float, number: int) -> None:
    w = width / 2
    b.part(
        "cabinet",
        prism(
            [(-0.35, 0), (0.35, 0), (0.35, 1.75), (-0.15, 1.75), (-0.05, 1.2), (-0.4, 1), (-0.4, 0.95), (-0.35, 0.9)],
            (0, 0, 0),
            width,
            "x",
        ),
        look="black wood",
    )
    b.cut("cabinet", slab(w - 0.03, (-0.3, 0.32), (0.1, 0.85)), slab(0.42 * width, (-0.4, -0.3), (0.15, 0.75)))
    leaf(
        b,
        "door",
        "cabinet",
        (-0.43 * width, -0.368, 0.13),
        (0.43 * width, -0.351, 0.77),
        hinge=-X,
        reach=1.8,
        material="steel",
    )
    up = vector(0, -0.496, 0.868)
    at = vector(-0.25 * width, -0.22, 1.1029)
    b.bore("cabinet", b.cone(0.012, 0.026, at - 0.03 * up, at + 0.001 * up))
    b.part("joystick", b.cylinder(0.005, at - 0.025 * up, at + 0.06 * up), ball(0.018, at + 0.07 * up), look="red")
    b.hinge("joystick", "cabinet", X, at - 0.02 * up, 0.25, -0.25)
    for k in range(number):
        b_ = vector(0.02 + 0.06 * (k % 3), -0.26 + 0.06 * (k // 3), 1.1029 + (-0.04 + 0.06 * (k // 3)) * 0.5714)
        b.bore("cabinet", b.cylinder(0.0165, b_ - 0.02 * up, b_ + 0.05 * up))
        b.part(f"button_{k}", b.cylinder(0.015, b_ - 0.01 * up, b_ + 0.008 * up), look="yellow")
        b.slide(f"button_{k}", "cabinet", -up, 0.006)


@kind(words="ping pong table, folding table tennis table", size=length(0.8, 1.0, default=1.0))
def table_tennis_table(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "frame",
        [p.box((x - 0.03, s * 0.2 - 0.02, 0), (x + 0.03, s * 0.2 + 0.02, 0.68)) for x in (-0.6, 0.6) for s in (-1, 1)],
        [p.slab((x - 0.03, x + 0.03), 0.25, (0.62, 0.68)) for x in (-0.6, 0.6)],
        p.slab(0.6, 0.02, (0.3, 0.36)),
        [p.slab((x - 0.03, x + 0.03), 0.2, (0.3, 0.36)) for x in (-0.6, 0.6)],
        [p.slab((x - 0.02, x + 0.02), 0.2, (0, 0.05)) for x in (-0.6, 0.6)],
        look="black steel",
    )
    for k, s in enumerate((-1, 1)):
        b.part(f"half_{k}", p.slab(0.76, (s * 0.005, s * 1.37), (0.73, 0.76)), look="dark green wood")
        b.part("frame", [p.box((x - 0.015, s * 0.035, 0.67), (x + 0.015, s * 0.005, 0.728)) for x in (-0.6, 0.6)])
        b.hinge(f"half_{k}", "frame", s * X, p(0, s * 0.005, 0.76), 1.5)


@kind(words="roulette wheel", radius=(0.2, 0.5))
def roulette(b: ObjectBuilder, radius: float) -> None:
    r = radius
    b.part("bowl", b.cylinder(r, 0, 0.25 * r), b.cylinder(0.05 * r, 0.05 * r, 0.35 * r), look="wood")
    b.cut("bowl", b.tube(0.8 * r, 0.05 * r, 0.1 * r, r))
    b.part(
        "wheel",
        b.cone(0.77 * r, 0.2 * r, 0.11 * r, 0.28 * r),
        [
            b.cylinder(0.02 * r, (0, 0, 0.33 * r), (0.2 * r * cos(a), 0.2 * r * sin(a), 0.33 * r))
            for a in (0, 1.57, 3.14, 4.71)
        ],
        b.cylinder(0.1 * r, 0.25 * r, 0.36 * r),
        look="red wood",
    )
    b.cut("wheel", b.cylinder(0.062 * r, 0, 0.355 * r))
    b.spin("wheel", "bowl", Z, (0, 0, 0))


@kind(words="squeezebox", size=(0.8, 1.1))
def accordion(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.box((-0.18, 0, 0), (0, 0.18, 0.36)),
        p.box((0, 0.015, 0.02), (0.1, 0.165, 0.34)),
        p.box((-0.24, -0.02, 0.03), (-0.17, 0.06, 0.33)),
        look="red",
    )
    b.part("half", p.box((0.102, 0, 0), (0.2, 0.18, 0.36)), look="red")
    b.slide("half", "body", X, 0.15)
    for k, z in enumerate(spread(9, 0.04 * size, 0.32 * size)):
        b.part(
            f"key_{k}",
            box((-0.235 * size, -0.036 * size, z - 0.013 * size), (-0.175 * size, -0.022 * size, z + 0.013 * size)),
            look="white",
        )
        b.slide(f"key_{k}", "body", Y, 0.0015)


@kind(words="cornet, flugelhorn, bugle with valves", size=(0.9, 1.1))
def trumpet(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.cylinder(0.006, (-0.25, 0.15), 0, 0.05),
        p.cone(0.006, 0.06, (0.1, 0.3), 0, 0.05),
        [p.cylinder(0.011, x, 0, (-0.04, 0.08)) for x in (-0.03, 0, 0.03)],
        p.cylinder(0.006, (-0.15, 0.15), 0, -0.02),
        [p.beam(0.01, 0.01, (x, 0, -0.022), (x, 0, 0.052), X) for x in (-0.15, 0.15)],
        p.cone(0.012, 0.006, (-0.28, -0.245), 0, 0.05),
        look="brass",
    )
    b.cut("body", p.cone(0.004, 0.056, (0.12, 0.301), 0, 0.05))
    for k, x in enumerate((-0.03, 0, 0.03)):
        b.cut("body", p.cylinder(0.0075, x, 0, (0.055, 0.1)))
        b.part(
            f"valve_{k}",
            p.cylinder(0.006, x, 0, (0.073, 0.098)),
            p.cylinder(0.0095, x, 0, (0.097, 0.101)),
            look="chrome",
        )
        b.slide(f"valve_{k}", "body", -Z, 0.014)


@kind(walls=4.5, words="slide trombone", size=(0.9, 1.1))
def trombone(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "horn",
        [p.cylinder(0.006, (0, -0.7), y, 0) for y in (-0.05, 0.05)],
        p.cylinder(0.006, -0.02, (-0.052, 0.052), 0),
        p.cylinder(0.008, (0, 0.35), 0.05, 0),
        p.cylinder(0.008, 0.35, (0.046, 0.154), 0),
        p.cylinder(0.008, (0.35, 0), 0.15, 0),
        p.cone(0.008, 0.09, (0.01, -0.4), 0.15, 0),
        p.cone(0.01, 0.006, (0.04, -0.01), -0.05, 0),
        look="brass",
    )
    b.cut("horn", p.cone(0.006, 0.087, (0, -0.401), 0.15, 0))
    b.part(
        "slide",
        [p.tube(0.0095, 0.0075, (-0.08, -0.75), y, 0) for y in (-0.05, 0.05)],
        p.cylinder(0.009, -0.75, (-0.058, 0.058), 0),
        p.beam(0.008, 0.006, (-0.1, -0.042, 0), (-0.1, 0.042, 0)),
        look="brass",
    )
    b.slide("slide", "horn", -X, 0.5)


@kind(words="acoustic guitar, ukulele, bass guitar", size=(0.5, 1.0), number=whole(4, 6, words="peg, string, tuner"))
def guitar(b: ObjectBuilder, size: float, number: int) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.cylinder(0.19, -0.05, 0.05),
        p.cylinder(0.145, 0, 0.23, (-0.05, 0.05)),
        p.slab(0.03, (0.3, 0.75), (0.02, 0.06)),
        p.slab(0.045, (0.74, 0.92), (0.015, 0.045)),
        p.slab(0.07, (-0.08, -0.05), (0.049, 0.062)),
        look="wood",
    )
    b.cut(
        "body",
        p.cylinder(0.18, -0.044, 0.044),
        p.cylinder(0.135, 0, 0.23, (-0.044, 0.044)),
        p.cylinder(0.055, 0, 0.16, (0, 0.052)),
    )
    for k in range(number):
        s = -1 if k % 2 else 1
        y = 0.77 + 0.05 * (k // 2)
        knob(b, f"peg_{k}", "body", p(s * 0.045, y, 0.03), 0.01 * size, s * X, high=0.03 * size, material="metal")


@kind(words="kick drum", radius=(0.22, 0.32))
def bass_drum(b: ObjectBuilder, radius: float) -> None:
    r = radius
    b.part(
        "drum",
        b.cylinder(r, 0, (-0.2, 0.2), r + 0.02),
        [b.torus(r, 0.015, (0, y, r + 0.02), Y) for y in (-0.19, 0.19)],
        [beam(0.015, 0.015, (s * 0.9 * r, -0.1, 0.8 * r), (s * 1.3 * r, -0.15, 0.008), X) for s in (-1, 1)],
        slab(0.05, (0.19, 0.5), (0, 0.015)),
        [box((s * 0.045, 0.27, 0.01), (s * 0.037, 0.3, 0.25)) for s in (-1, 1)],
        look="red wood",
    )
    b.cut("drum", b.cylinder(r - 0.01, 0, (-0.19, 0.19), r + 0.02))
    b.bore("drum", b.cylinder(0.007, (-1, 1), 0.285, 0.235))
    b.part(
        "beater",
        b.cylinder(0.005, (-0.044, 0.044), 0.285, 0.235),
        beam(0.008, 0.008, (0, 0.285, 0.23), (0, 0.33, 0.36), X),
        ball(0.025, (0, 0.33, 0.37)),
        look="steel",
    )
    b.hinge("beater", "drum", X, (0, 0.285, 0.235), 0.15, -0.5)
    b.part("pedal", beam(0.06, 0.008, (0, 0.49, 0.025), (0, 0.33, 0.1)), look="steel")
    b.hinge("pedal", "drum", -X, (0, 0.49, 0.025), 0.1, -0.25)
    b.follow("beater", "pedal", -0.6)


@kind(
    words="electronic keyboard, keytar, midi keyboard, music keyboard, digital piano, electric piano, stage piano",
    number=whole(7, 12, words="key"),
)
def synthesizer(b: ObjectBuilder, number: int) -> None:
    w = 0.024 * number / 2
    b.part(
        "case",
        box((-w - 0.06, 0, 0), (w + 0.02, 0.25, 0.04)),
        box((-w - 0.06, 0.14, 0.03), (w + 0.02, 0.25, 0.07)),
        look="black",
    )
    b.cut("case", slab(w + 0.002, (-0.01, 0.142), (0.02, 0.1)))
    for k in range(number):
        x = -w + 0.024 * k
        b.part(f"key_{k}", box((x + 0.0008, 0, 0.036), (x + 0.0232, 0.139, 0.05)), look="white")
        b.hinge(f"key_{k}", "case", X, (0, 0.139, 0.036), 0.06)
    for k, x in enumerate(spread(4, -w, w)):
        knob(b, f"knob_{k}", "case", (x, 0.2, 0.07), 0.01, Z, high=0.014, reach=4.7)


@kind(radius=(0.03, 0.05))
def castanets(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    for name, s in (("shell", -1), ("other_shell", 1)):
        shell = p.ball(1, (0, 0, 0)).scale((1, 1, 0.45))
        inner = p.slab(2, 1.1, (s * -2, s * 0.02)) + p.ball(0.75, (0, 0, s * -0.2)).scale((1, 1, 0.45))
        knuckle = p.cylinder(0.08, (s * 0.02, s * 0.2), 1.12, 0)
        tab = p.slab((s * 0.02, s * 0.2), (0.8, 1.12), (s * 0.02, s * 0.08))
        b.part(name, shell - inner, tab, knuckle, look="brown wood")
    b.part("shell", p.cylinder(0.04, (-0.1, 0.2), 1.12, 0))
    b.cut("other_shell", p.cylinder(0.05, (0, 0.3), 1.12, 0))
    b.hinge("other_shell", "shell", -X, (0, 1.12 * r, 0), 0.6)


@kind("nodding dog", words="nodding toy, wobbly toy", size=(0.8, 1.3))
def bobblehead(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.cylinder(0.04, 0, 0.01),
        p.cone(0.03, 0.018, 0.01, 0.08),
        [p.slab((s * 0.009, s * 0.013), 0.005, (0.075, 0.1)) for s in (-1, 1)],
        look="blue",
    )
    b.part(
        "head",
        p.ball(0.03, (0, 0, 0.125)),
        p.slab(0.0075, 0.005, (0.085, 0.1)),
        p.cone(0.006, 0.003, (0, -0.028, 0.122), (0, -0.042, 0.12)),
        look="pink",
    )
    b.cut("head", [p.slab((s * 0.008, s * 0.03), 0.02, (0, 0.103)) for s in (-1, 1)])
    b.hinge("head", "body", X, p(0, 0, 0.092), 0.12, -0.12)


@kind("gymnast toy", words="high bar toy", size=(0.8, 1.4))
def acrobat_toy(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "frame",
        p.slab(0.09, 0.05, (0, 0.015)),
        [p.slab((s * 0.08, s * 0.07), 0.01, (0.01, 0.26)) for s in (-1, 1)],
        look="wood",
    )
    b.bore("frame", p.cylinder(0.0055, (-1, 1), 0, 0.24))
    b.part(
        "figure",
        p.cylinder(0.004, (-0.09, 0.09), 0, 0.24),
        [p.rod(0.007, s * 0.025, 0, (0.24, 0.18)) for s in (-1, 1)],
        p.slab(0.025, 0.012, (0.12, 0.18)),
        p.ball(0.018, (0, 0, 0.195)),
        [p.rod(0.008, s * 0.014, 0, (0.12, 0.06)) for s in (-1, 1)],
        look="red wood",
    )
    b.spin("figure", "frame", X, p(0, 0, 0.24))


@kind(words="crane game, claw crane game, grabber machine", width=(0.6, 0.9))
def claw_machine(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "cabinet",
        slab(w, w, (0, 0.8)),
        slab(w, w, (1.7, 1.8)),
        [
            box((x - 0.02, y - 0.02, 0.79), (x + 0.02, y + 0.02, 1.71))
            for x in (-w + 0.02, w - 0.02)
            for y in (-w + 0.02, w - 0.02)
        ],
        [slab(w - 0.02, (s * (w - 0.06), s * (w - 0.02)), (1.62, 1.66)) for s in (-1, 1)],
        slab(0.15, (-w - 0.12, -w + 0.01), (0.74, 0.79)),
        look="pink wood",
    )
    b.cut("cabinet", slab(w - 0.03, w - 0.03, (0.05, 0.77)))
    b.part("bridge", slab(0.03, w - 0.025, (1.661, 1.69)), look="steel")
    b.slide("bridge", "cabinet", X, w - 0.1, lower=-w + 0.1)
    b.part(
        "carriage",
        slab(0.06, 0.05, (1.6, 1.655)),
        [slab((s * 0.035, s * 0.045), 0.05, (1.65, 1.695)) for s in (-1, 1)],
        slab(0.045, 0.05, (1.692, 1.699)),
        look="steel",
    )
    b.slide("carriage", "bridge", Y, w - 0.13, lower=-w + 0.13)
    b.part("claw", b.cylinder(0.01, 1.35, 1.597), b.cylinder(0.035, 1.33, 1.36), look="chrome")
    b.slide("claw", "carriage", -Z, 0.3)
    knob(b, "button", "cabinet", (0.08, -w - 0.06, 0.79), 0.03, Z, high=0.02)


@kind(words="monocular, pirate telescope, hand telescope", length=(0.12, 0.25), radius=(0.015, 0.03))
def spyglass(b: ObjectBuilder, length: float, radius: float) -> None:
    b.part(
        "barrel", b.tube(radius, radius - 0.003, 0, (0, length), 0), b.cylinder(radius, 0, (0, 0.004), 0), look="brass"
    )
    b.part(
        "tube",
        b.tube(radius - 0.0045, radius - 0.007, 0, (0.2 * length, 1.2 * length), 0),
        b.tube(radius, radius - 0.007, 0, (1.15 * length, 1.22 * length), 0),
        look="brass",
    )
    b.slide("tube", "barrel", Y, 0.7 * length, lower=-0.05 * length)


@kind(
    words=(
        "table football, football table, table soccer, kicker table, foosball, soccer table, table football game, "
        "kicker"
    ),
    part_words={"rod": "bar, pole, row", "bumper": "ring"},
    details={"leg": 4},
    rods=whole(2, 12, default=8, words="bar, pole"),
    players=whole(1, 5, words="figure, man", help="Of every rod."),
    styles=False,
)
def foosball_table(b: ObjectBuilder, rods: int, players: int) -> None:
    """Rods of two teams that slide and turn."""
    long = 0.15 * rods
    y = long / 2
    b.part(
        "table",
        slab(0.37, y + 0.05, (0.6, 0.9)) - slab(0.34, y, (0.705, 1)),
        [box((s * 0.3, t * (y - 0.03), 0), (s * 0.36, t * (y + 0.03), 0.6)) for s in (-1, 1) for t in (-1, 1)],
        look="wood",
    )
    for k, at in enumerate(spread(rods, -y, y)):
        b.cut("table", b.cylinder(0.0093, (-1, 1), at, 0.86))
        b.part(f"bumper_{k + 1}", b.tube(0.018, 0.0093, (0.19, 0.22), at, 0.86), look="rubber")
        b.slide(f"bumper_{k + 1}", "table", X, 0.1, -0.1, ajar=False)
        men = [box((x - 0.015, at - 0.01, 0.78), (x + 0.015, at + 0.01, 0.88)) for x in spread(players, -0.17, 0.17)]
        name = b.part(
            f"rod_{k + 1}",
            b.cylinder(0.0085, (-0.56, 0.56), at, 0.86),
            b.cylinder(0.016, (0.56, 0.68), at, 0.86),
            b.painted(*men, look="blue" if k % 2 else "red plastic"),
            look="chrome",
        )
        b.spin(name, f"bumper_{k + 1}", X, (0, at, 0.86))
