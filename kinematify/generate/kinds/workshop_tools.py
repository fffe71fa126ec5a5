"""Machines and fixtures of a workshop."""

from __future__ import annotations

from math import cos, sin

from manifold3d import Manifold

from kinematify.generate.library.kind import kind, whole
from kinematify.generate.library.mechanisms import bail, caster, crank, knob, lever, wheel
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, prism, slab


@kind(words="socket wrench, torque wrench, ratchet spanner", length=(0.18, 0.3))
def ratchet_wrench(b: ObjectBuilder, length: float) -> None:
    b.part(
        "handle",
        b.cylinder(0.018, 0, 0.022),
        beam(0.014, 0.012, (0.01, 0, 0.011), (0.6 * length, 0, 0.011)),
        b.rod(0.011, (0.5 * length, length), 0, 0.011),
        look="chrome",
    )
    b.bore("handle", b.cylinder(0.0085, -0.01, 0.012))
    b.part("socket", b.cylinder(0.0075, 0.005, -0.002), b.cylinder(0.011, -0.001, -0.035), look="chrome")
    b.cut("socket", b.cylinder(0.0075, -0.02, -0.1))
    b.spin("socket", "handle", Z, (0, 0, 0))
    b.part(
        "lever",
        b.cylinder(0.004, 0.0222, 0.027),
        beam(0.005, 0.003, (0, 0, 0.0255), (-0.014, 0, 0.0255)),
        look="black steel",
    )
    b.hinge("lever", "handle", Z, (0, 0, 0), 0.6, -0.6)


@kind(words="tube cutter", size=(0.9, 1.3))
def pipe_cutter(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "frame",
        p.slab((-0.012, 0.06), 0.01, (0, 0.012)),
        p.slab((-0.012, -0.002), 0.01, (0, 0.06)),
        [p.cylinder(0.006, x, (-0.009, 0.009), 0.016) for x in (0.035, 0.052)],
        p.slab((-0.024, -0.01), 0.01, (0, 0.03)),
        look="blue metal",
    )
    b.bore("frame", p.cylinder(0.0052, (-0.05, 0), 0, 0.015))
    b.part(
        "screw",
        p.cylinder(0.004, (-0.05, -0.003), 0, 0.015),
        p.cylinder(0.012, (-0.065, -0.045), 0, 0.015),
        look="steel",
    )
    b.spin("screw", "frame", X, p(0, 0, 0.015))
    b.part(
        "jaw",
        p.slab((0.001, 0.018), 0.01, (0.0125, 0.04)),
        p.cylinder(0.01, 0.02, (-0.002, 0.002), 0.028),
        look="steel",
    )
    b.slide("jaw", "frame", X, 0.003)


@kind(words="quick clamp", size=(0.9, 1.4))
def toggle_clamp(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "base",
        p.slab(0.03, 0.02, (0, 0.004)),
        [p.box((-0.025, s * 0.01, 0.003), (0.02, s * 0.014, 0.04)) for s in (-1, 1)],
        look="steel",
    )
    b.part(
        "arm",
        p.beam(0.016, 0.008, (-0.01, 0, 0.032), (0.07, 0, 0.032)),
        p.cylinder(0.004, 0.065, 0, (0.006, 0.034)),
        p.cylinder(0.007, 0.065, 0, (0.004, 0.01)),
        look="steel",
    )
    b.hinge("arm", "base", -Y, p(0.012, 0, 0.032), 1.3)
    b.part(
        "handle",
        p.beam(0.014, 0.008, (-0.018, 0, 0.016), (-0.1, 0, 0.045)),
        p.rod(0.009, (-0.07, 0, 0.034), (-0.11, 0, 0.048)),
        look="red steel",
    )
    b.hinge("handle", "base", Y, p(-0.018, 0, 0.016), 1.2)
    b.follow("arm", "handle", 1.08)


@kind(words="sealant gun, silicone gun", length=(0.2, 0.26))
def caulking_gun(b: ObjectBuilder, length: float) -> None:
    b.part(
        "frame",
        slab((-0.03, -0.024), 0.03, 0.03),
        [slab((-0.03, length), (s * 0.026, s * 0.03), 0.004) for s in (-1, 1)],
        b.tube(0.03, 0.012, (length - 0.006, length), 0, 0),
        slab((-0.06, -0.024), 0.012, (-0.02, 0.025)),
        beam(0.02, 0.02, (-0.05, 0, -0.015), (-0.08, 0, -0.12), Y),
        look="red steel",
    )
    b.bore("frame", b.cylinder(0.0055, (-0.2, 0), 0, 0), slab((-0.055, -0.028), 0.0055, (-0.03, -0.006)))
    b.part(
        "rod",
        b.cylinder(0.004, (-0.2, 0.02), 0, 0),
        b.cylinder(0.022, (0.016, 0.022), 0, 0),
        beam(0.008, 0.006, (-0.195, 0, 0), (-0.2, 0, -0.05), Y),
        look="steel",
    )
    b.slide("rod", "frame", X, 0.12)
    b.part("trigger", beam(0.009, 0.009, (-0.036, 0, -0.012), (-0.045, 0, -0.1), Y), look="black steel")
    b.hinge("trigger", "frame", Y, (-0.036, 0, -0.012), 0.08, -0.1)


@kind(words="tacker", size=(0.9, 1.2))
def staple_gun(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab((0, 0.15), 0.012, (0, 0.03)),
        p.slab((0.12, 0.15), 0.012, (0, 0.1)),
        p.slab((0, 0.02), 0.012, (0, 0.075)),
        p.slab((0, 0.03), 0.012, (0.055, 0.075)),
        [p.box((0.11, s * 0.012, 0.08), (0.15, s * 0.008, 0.125)) for s in (-1, 1)],
        look="steel",
    )
    b.part("lever", p.beam(0.013, 0.012, (0.138, 0, 0.113), (-0.01, 0, 0.14)), look="black steel")
    b.hinge("lever", "body", -Y, p(0.138, 0, 0.113), 0.12, -0.3)


@kind(words="hot air gun", size=(0.9, 1.2))
def heat_gun(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.cylinder(0.035, (-0.06, 0.1), 0, 0.16),
        p.cone(0.033, 0.018, (0.1, 0.18), 0, 0.16),
        p.beam(0.03, 0.04, (-0.01, 0, 0.14), (-0.03, 0, 0), X),
        look="orange",
    )
    b.bore("body", p.slab((0.004, 0.05), 0.007, (0.075, 0.13)))
    b.part("trigger", p.slab((0.0105, 0.026), 0.006, (0.08, 0.122)), look="black")
    b.slide("trigger", "body", -X, 0.005)
    knob(b, "dial", "body", p(-0.06, 0, 0.16), 0.018 * size, -X, high=0.012 * size, reach=4.5)


@kind(words="hand circular saw, plunge saw, track saw", size=(0.9, 1.2))
def circular_saw(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.cylinder(0.05, 0, (0.02, 0.14), 0.1),
        p.beam(0.03, 0.03, (0, 0.07, 0.14), (-0.1, 0.07, 0.2)),
        p.beam(0.03, 0.03, (-0.1, 0.07, 0.2), (-0.14, 0.07, 0.1)),
        p.slab(0.05, (0.03, 0.1), (0.03, 0.1)),
        p.slab(0.14, (0.012, 0.12), (0.014, 0.03)),
        look="green",
    )
    b.cut("body", p.slab(0.13, (-0.02, 0.0115), (0, 0.2)))
    b.part("blade", p.cylinder(0.085, 0, (0.001, 0.003), 0.1), p.cylinder(0.012, 0, (-0.008, 0.011), 0.1), look="steel")
    b.spin("blade", "body", -Y, p(0, 0, 0.1))
    b.part("guard", p.cylinder(0.098, 0, (-0.006, 0.0095), 0.1), look="grey metal")
    b.cut(
        "guard",
        p.cylinder(0.091, 0, (-0.0035, 0.0065), 0.1),
        p.slab(0.2, 0.1, (0.1, 0.4)),
        p.cylinder(0.02, 0, (-0.1, 0.1), 0.1),
        p.slab(0.2, (0.0062, 0.02), (-0.1, 0.3)),
    )
    b.hinge("guard", "body", Y, p(0, 0, 0.1), 1.6)


@kind(size=(0.9, 1.1))
def chainsaw(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.1, 0.08, (0, 0.14)),
        p.rod(0.012, (-0.09, 0, 0.13), (-0.16, 0, 0.2)),
        p.rod(0.012, (-0.16, 0, 0.2), (-0.28, 0, 0.14)),
        p.rod(0.012, (-0.28, 0, 0.14), (-0.26, 0, 0.04)),
        p.rod(0.012, (-0.26, -0.09), 0, 0.04),
        p.slab((0.09, 0.45), 0.006, (0.03, 0.09)),
        p.cylinder(0.03, 0.45, (-0.006, 0.006), 0.06),
        [p.box((0.04, s * 0.06, 0.13), (0.06, s * 0.07, 0.16)) for s in (-1, 1)],
        look="orange",
    )
    b.part("brake", p.slab((0.055, 0.063), 0.056, (0.145, 0.23)), look="black")
    b.hinge("brake", "body", Y, p(0.059, 0, 0.15), 0.5, -0.2)
    b.bore("body", p.cylinder(0.0085, -0.03, (-0.1, -0.02), 0.07))
    b.part(
        "starter",
        p.cylinder(0.006, -0.03, (-0.075, -0.025), 0.07),
        p.rod(0.01, (-0.06, 0), -0.095, 0.07),
        p.cylinder(0.006, -0.03, (-0.09, -0.07), 0.07),
        look="black",
    )
    b.slide("starter", "body", -Y, 0.04)


@kind(height=(0.8, 1.3))
def band_saw(b: ObjectBuilder, height: float) -> None:
    b.part(
        "frame",
        slab(0.3, (-0.05, 0.25), (0, 0.4)),
        box((-0.3, 0, 0.4), (-0.2, 0.15, height)),
        slab(0.3, (0, 0.15), (height, height + 0.3)),
        box((0.02, 0.03, 0.4), (0.1, 0.12, 0.44)),
        look="grey steel",
    )
    b.cut("frame", slab(0.27, (-0.06, 0.2), (0.03, 0.37)))
    b.part("frame", box((0.059, 0.07, 0.42), (0.061, 0.085, height + 0.01)))
    b.part(
        "table", box((-0.12, -0.1, 0.47), (0.28, 0.25, 0.49)), box((0.1, 0.03, 0.43), (0.14, 0.12, 0.471)), look="steel"
    )
    b.cut("table", box((0.03, -0.2, 0.4), (0.09, 0.14, 0.5)))
    b.cut("frame", box((0.097, 0, 0.42), (0.145, 0.2, 0.48)))
    b.part("frame", box((0.145, 0.03, 0.4), (0.17, 0.12, 0.45)))
    b.hinge("table", "frame", Y, (0.12, 0, 0.44), 0.05, -0.02)
    leaf(b, "door", "frame", (-0.29, -0.07, 0.01), (0.29, -0.052, 0.39), hinge=-X, reach=1.8, material="steel")
    b.part(
        "guide",
        box((0.08, 0.05, 0.75 * height), (0.1, 0.07, height - 0.002)),
        box((0.04, 0.05, 0.75 * height), (0.1, 0.068, 0.75 * height + 0.05)),
        look="metal",
    )
    b.slide("guide", "frame", -Z, 0.125 * height)


@kind(words="folding trestle, trestle", width=(0.7, 1.1), height=(0.6, 0.85))
def saw_horse(b: ObjectBuilder, width: float, height: float) -> None:
    w = width / 2
    lean = 0.28 * height
    b.part(
        "front",
        slab(w, (-0.045, -0.0015), (height, height + 0.05)),
        [beam(0.05, 0.03, (s * 0.85 * w, -0.035, height + 0.01), (s * 0.85 * w, -lean, 0.015), X) for s in (-1, 1)],
        beam(0.05, 0.02, (-0.85 * w, -0.65 * lean, 0.4 * height), (0.85 * w, -0.65 * lean, 0.4 * height)),
        look="wood",
    )
    b.part(
        "back",
        slab(w, (0.0015, 0.045), (height, height + 0.05)),
        [beam(0.05, 0.03, (s * 0.85 * w, 0.035, height + 0.01), (s * 0.85 * w, lean, 0.015), X) for s in (-1, 1)],
        beam(0.05, 0.02, (-0.85 * w, 0.65 * lean, 0.4 * height), (0.85 * w, 0.65 * lean, 0.4 * height)),
        look="wood",
    )
    b.hinge("back", "front", X, (0, 0, height + 0.05), 0.15, 0)


@kind(words="portable workbench, work stand, bench with a vise jaw", width=(0.55, 0.75), height=(0.72, 0.85))
def folding_workbench(b: ObjectBuilder, width: float, height: float) -> None:
    w = width / 2
    b.part(
        "frame",
        [beam(0.04, 0.025, (s * 0.8 * w, -0.12, height - 0.05), (s * 0.95 * w, -0.28, 0.012), X) for s in (-1, 1)],
        [beam(0.04, 0.025, (s * 0.8 * w, 0.1, height - 0.05), (s * 0.95 * w, 0.28, 0.012), X) for s in (-1, 1)],
        [box((s * 0.7 * w - 0.02, -0.22, height - 0.06), (s * 0.7 * w + 0.02, 0.2, height - 0.03)) for s in (-1, 1)],
        slab(w, (0.02, 0.2), (height - 0.03, height)),
        look="wood",
    )
    b.part("jaw", slab(w, (-0.2, -0.005), (height - 0.029, height)), look="wood")
    b.slide("jaw", "frame", -Y, 0.1)
    for k, s in enumerate((-1, 1)):
        crank(b, f"crank_{k}", "frame", (s * 0.7 * w, -0.22, height - 0.045), -Y, 0.06)


@kind(words="dolly, furniture dolly, piano dolly, plant trolley, wheeled board", width=(0.4, 0.6), length=(0.5, 1.1))
def mechanics_creeper(b: ObjectBuilder, width: float, length: float) -> None:
    b.part("board", slab(width / 2, length / 2, (0.09, 0.11)), look="wood")
    for k, (x, y) in enumerate([(x, y) for x in (-0.4 * width, 0.4 * width) for y in (-0.42 * length, 0.42 * length)]):
        caster(b, f"caster_{k}", "board", (x, y, 0.09), 0.09)


@kind(walls=40, words="shop crane, floor crane", size=(0.8, 1.1))
def engine_hoist(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "base",
        [p.box((s * 0.35 - 0.04, -1.2, 0.1), (s * 0.35 + 0.04, 0.1, 0.16)) for s in (-1, 1)],
        p.slab(0.39, (0, 0.12), (0.1, 0.18)),
        p.slab(0.05, (0.02, 0.12), (0.15, 1.4)),
        [p.box((s * 0.05, -0.03, 1.4), (s * 0.065, 0.12, 1.55)) for s in (-1, 1)],
        p.slab(0.065, (0.02, 0.12), (1.36, 1.41)),
        look="red steel",
    )
    b.part("boom", p.slab(0.045, (-1.1, 0.1), (1.45, 1.53)), look="red steel")
    b.hinge("boom", "base", -X, p(0, 0.06, 1.49), 0.5, -0.05)
    b.part("hook", p.cylinder(0.012, 0, -1, (1.33, 1.448)), p.torus(0.04, 0.012, (0, -1, 1.29), X), look="black steel")
    b.spin("hook", "boom", Z, p(0, -1, 0))
    for k, (x, y) in enumerate(((-0.35, -1.1), (0.35, -1.1), (-0.35, 0.06), (0.35, 0.06))):
        caster(b, f"caster_{k}", "base", p(x, y, 0.1), 0.1 * size)


@kind(words="compressor", length=(0.5, 0.8))
def air_compressor(b: ObjectBuilder, length: float) -> None:
    r = 0.16
    b.part(
        "tank",
        b.rod(r, (-length / 2 + r, length / 2 - r), 0, 0.26),
        slab(0.15, 0.1, (0.4, 0.6)),
        [box((length / 2 - 0.2, s * 0.1 - 0.015, 0), (length / 2 - 0.17, s * 0.1 + 0.015, 0.2)) for s in (-1, 1)],
        b.cylinder(0.012, -0.3 * length, (-0.2, 0.2), 0.09),
        slab((-0.3 * length - 0.02, -0.3 * length + 0.02), 0.1, (0.08, 0.16)),
        look="red steel",
    )
    for k, s in enumerate((-1, 1)):
        b.part(f"wheel_{k}", b.cylinder(0.09, -0.3 * length, (s * 0.145, s * 0.19), 0.09), look="rubber")
        b.cut(f"wheel_{k}", b.cylinder(0.0135, -0.3 * length, (-1, 1), 0.09))
        b.spin(f"wheel_{k}", "tank", s * Y, (-0.3 * length, 0, 0.09))
    knob(b, "valve", "tank", (0, -0.1, 0.5), 0.02, -Y, high=0.03)
    bail(b, "handle", "tank", (0.15, -0.1, 0.56), (0.15, 0.1, 0.56), 0.25, 0.02, X, lower=-0.6, upper=0.2)


@kind(words="fireplace bellows, hand bellows", size=(0.8, 1.2))
def bellows(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)

    def board(end: float, height: float) -> Manifold:
        half = [
            (0.1 * size, end * size),
            (0.09 * size, 0.3 * size),
            (0.02 * size, 0.36 * size),
            (0.02 * size, 0.46 * size),
        ]
        outline = [(-0.1 * size, end * size), *half, *((-x, y) for x, y in reversed(half[1:]))]
        return prism(outline, p(0, 0, height), 0.014 * size, "z")

    b.part(
        "lower_board",
        board(0.12, 0.008),
        p.cylinder(0.012, 0, (0.06, 0.13), 0.012),
        p.cone(0.006, 0.012, 0, (-0.02, 0.07), 0.012),
        look="wood",
    )
    b.part("board", board(0.13, 0.035), look="wood")
    b.hinge("board", "lower_board", X, p(0, 0.13, 0.03), 0.45)


@kind(words="voltmeter", size=(0.9, 1.2))
def multimeter(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("case", p.slab(0.045, (0, 0.035), (0, 0.18)), p.slab(0.035, (-0.002, 0.001), (0.12, 0.165)), look="yellow")
    knob(b, "dial", "case", p(0, 0, 0.07), 0.025 * size, -Y, high=0.012 * size, reach=5.5)
    b.part("stand", p.slab(0.03, (0.036, 0.04), (0.02, 0.12)), look="black")
    b.hinge("stand", "case", X, p(0, 0.036, 0.12), 0.7)


@kind(width=(0.25, 0.4), number=whole(1, 6, default=4, usual=(3, 6), words="knob, dial"))
def oscilloscope(b: ObjectBuilder, width: float, number: int) -> None:
    h = 0.16
    b.part(
        "case",
        slab(width / 2, (0, 0.25), (0.01, h)),
        box((-0.45 * width, -0.003, 0.4 * h), (-0.02, 0.001, 0.92 * h)),
        [b.cylinder(0.01, x, y, (0, 0.011)) for x in (-0.4 * width, 0.4 * width) for y in (0.03, 0.22)],
        look="grey metal",
    )
    b.cut("case", slab(width / 2 - 0.004, (0.08, 0.24), (0.015, h - 0.005)))
    for k in range(number):
        knob(
            b,
            f"knob_{k}",
            "case",
            (0.05 * width + 0.15 * width * (k % 3), 0, 0.75 * h if k < 3 else 0.3 * h),
            0.05 * width,
            -Y,
            high=0.016,
            reach=4.7,
        )
    bail(
        b,
        "handle",
        "case",
        (-width / 2, 0.05, 0.5 * h),
        (width / 2, 0.05, 0.5 * h),
        0.13,
        0.01,
        -Y,
        lower=-0.6,
        upper=0.6,
    )


@kind(words="angle finder, bevel gauge, goniometer, angle gauge, t bevel", length=(0.15, 0.3))
def protractor(b: ObjectBuilder, length: float) -> None:
    b.part(
        "ruler",
        slab((-0.015, length), 0.012, (0, 0.004)),
        b.cylinder(0.018, 0, 0.004),
        b.cylinder(0.004, 0, 0.012),
        look="steel",
    )
    b.part(
        "arm", slab((-0.015, length), 0.012, (0.0045, 0.0085)), b.cylinder(0.018, 0.0045, 0.0085), look="yellow steel"
    )
    b.cut("arm", b.cylinder(0.0045, 0, 1))
    b.hinge("arm", "ruler", Z, (0, 0, 0), 3.1)


@kind(words="micrometer screw gauge, outside micrometer, screw gauge", size=(0.9, 1.3))
def micrometer(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "frame",
        [
            p.beam(
                0.012, 0.01, (0.035 * cos(a), -0.035 * sin(a), 0), (0.035 * cos(a + 0.55), -0.035 * sin(a + 0.55), 0)
            )
            for a in [0.52 * k for k in range(6)]
        ],
        p.slab((0.03, 0.045), (-0.006, 0.012), 0.006),
        p.slab((-0.045, -0.03), (-0.006, 0.012), 0.006),
        p.cylinder(0.006, (0.03, 0.075), 0.006, 0),
        p.cylinder(0.003, (-0.035, -0.01), 0.006, 0),
        look="steel",
    )
    b.bore("frame", p.cylinder(0.0042, (0, 0.2), 0.006, 0))
    b.part("spindle", p.cylinder(0.0032, (-0.005, 0.1), 0.006, 0), look="steel")
    b.slide("spindle", "frame", X, 0.03)
    b.part(
        "thimble",
        p.tube(0.009, 0.0072, (0.05, 0.085), 0.006, 0),
        p.tube(0.009, 0.004, (0.0855 - 0.001, 0.095), 0.006, 0),
        look="chrome",
    )
    b.spin("thimble", "spindle", X, p(0, 0.006, 0))


@kind(words="dial gauge, pressure gauge, manometer, barometer, thermometer dial, gauge", radius=(0.025, 0.08))
def dial_indicator(b: ObjectBuilder, radius: float) -> None:
    r = radius
    b.part(
        "case",
        b.cylinder(r, 0, (0, 0.5 * r), 0),
        b.cylinder(0.2 * r, 0, 0.25 * r, (-0.9 * r, -1.5 * r)),
        look="white metal",
    )
    b.cut("case", b.cylinder(0.9 * r, 0, (-1, 0.12 * r), 0))
    b.part("case", b.cylinder(0.05 * r, 0, (0.05 * r, 0.13 * r), 0))
    b.part(
        "needle",
        b.cylinder(0.09 * r, 0, (0.02 * r, 0.1 * r), 0),
        beam(0.04 * r, 0.03 * r, (0, 0.06 * r, -0.25 * r), (0, 0.06 * r, 0.8 * r), Y),
        look="red steel",
    )
    b.cut("needle", b.cylinder(0.06 * r, 0, (-1, 1), 0))
    b.hinge("needle", "case", Y, (0, 0, 0), 2.3, -2.3)


@kind(number=whole(2, 12, default=5, usual=(3, 8), words="leaf, blade"), length=(0.08, 0.12))
def feeler_gauge(b: ObjectBuilder, number: int, length: float) -> None:
    b.part(
        "case",
        [slab((-0.012, length), 0.009, (z, z + 0.0015)) for z in (0, 0.002 + 0.0022 * number)],
        b.cylinder(0.003, 0, 0.003 + 0.0022 * number),
        box((length - 0.004, -0.009, 0), (length, -0.006, 0.003 + 0.0022 * number)),
        look="steel",
    )
    for k in range(number):
        z = 0.002 + 0.0022 * k
        b.part(f"leaf_{k}", box((-0.006, -0.005, z), (length - 0.008, 0.0065, z + 0.0016)), look="steel")
        b.cut(f"leaf_{k}", b.cylinder(0.0036, -1, 1))
        b.hinge(f"leaf_{k}", "case", Z, (0, 0, 0), 2.8)


@kind(words="wood plane, block plane", length=(0.16, 0.35))
def hand_plane(b: ObjectBuilder, length: float) -> None:
    b.part(
        "body",
        slab((0, length), 0.03, (0, 0.012)),
        [box((0.2 * length, s * 0.03, 0.01), (0.75 * length, s * 0.026, 0.04)) for s in (-1, 1)],
        beam(0.02, 0.035, (0.18 * length, 0, 0.01), (0.1 * length, 0, 0.1), Y),
        b.cylinder(0.008, 0.85 * length, 0, (0.01, 0.03)),
        ball(0.018, (0.85 * length, 0, 0.042)),
        beam(0.04, 0.012, (0.3 * length, 0, 0.06), (0.55 * length, 0, 0.015), X),
        look="black steel",
    )
    b.part("lever", beam(0.03, 0.008, (0.31 * length, 0, 0.075), (0.5 * length, 0, 0.042), X), look="brass")
    b.hinge("lever", "body", Y, (0.5 * length, 0, 0.042), 0.9, 0)


@kind(words="pillar crane, slewing crane, davit crane, davit", height=(1.8, 2.8))
def jib_crane(b: ObjectBuilder, height: float) -> None:
    reach = 0.8 * height
    b.part("column", b.cylinder(0.18, 0, 0.04), b.cylinder(0.07, 0.03, height), look="yellow steel")
    b.part(
        "jib",
        b.tube(0.1, 0.073, 0.8 * height, height - 0.02),
        b.cylinder(0.1, height + 0.005, height + 0.03),
        b.tube(0.1, 0.073, height - 0.03, height + 0.01),
        slab((0.09, reach), 0.03, (height - 0.12, height - 0.02)),
        beam(0.04, 0.04, (0.09, 0, 0.82 * height), (0.5 * reach, 0, height - 0.1), Y),
        look="yellow steel",
    )
    b.hinge("jib", "column", Z, (0, 0, 0), 3.0, -3.0)
    b.part(
        "trolley",
        slab((0.6 * reach - 0.05, 0.6 * reach + 0.05), 0.05, (height - 0.2, height - 0.124)),
        [
            box((0.6 * reach - 0.05, s * 0.034, height - 0.13), (0.6 * reach + 0.05, s * 0.05, height - 0.06))
            for s in (-1, 1)
        ],
        b.cylinder(0.008, 0.6 * reach, 0, (height - 0.45, height - 0.19)),
        look="steel",
    )
    b.cut("trolley", b.cylinder(0.008, 0.6 * reach, 0, (0, height - 0.198)))
    b.slide("trolley", "jib", X, 0.33 * reach, lower=-0.05 * reach)
    b.part(
        "hook",
        b.cylinder(0.006, 0.6 * reach, 0, (height - 0.5, height - 0.201)),
        b.torus(0.04, 0.01, (0.6 * reach, 0, height - 0.55), Y),
        look="black steel",
    )
    b.slide("hook", "trolley", -Z, 0.5 * height)


@kind(words="garden spray gun, shower gun", size=(0.9, 1.2))
def hose_nozzle(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.cylinder(0.014, (-0.1, 0, 0), (0.02, 0, 0.06)),
        p.cylinder(0.014, (0, 0.06), 0, 0.06),
        [p.box((-0.01, s * 0.014, 0.06), (0.015, s * 0.009, 0.085)) for s in (-1, 1)],
        look="green",
    )
    b.part("head", p.cylinder(0.024, (0.061, 0.09), 0, 0.06), look="black")
    b.spin("head", "body", X, p(0, 0, 0.06))
    b.part("lever", p.beam(0.012, 0.005, (0.006, 0, 0.081), (-0.1, 0, 0.055)), look="metal")
    b.hinge("lever", "body", -Y, p(0.006, 0, 0.081), 0.2, -0.1)


@kind(
    words=(
        "dump cart, garden wagon, hand wagon, bollerwagen, pull wagon, wagon, toy wagon, handcart, pull cart, beach "
        "wagon"
    ),
    length=(0.7, 1.1),
    width=(0.45, 0.6),
)
def garden_cart(b: ObjectBuilder, length: float, width: float) -> None:
    b.part(
        "frame",
        slab(length / 2, 0.06, (0.2, 0.25)),
        [slab((x - 0.03, x + 0.03), width / 2, (0.13, 0.201)) for x in (-0.35 * length, 0.35 * length)],
        [box((length / 2 - 0.01, s * 0.03, 0.2), (length / 2 + 0.05, s * 0.022, 0.26)) for s in (-1, 1)],
        look="black steel",
    )
    for k, (x, s) in enumerate([(x, s) for x in (-0.35 * length, 0.35 * length) for s in (-1, 1)]):
        wheel(b, f"wheel_{k}", "frame", (x, s * (width / 2 + 0.05), 0.14), 0.14, 0.06, s * Y, axle=0.015)
    b.part(
        "tub",
        slab(length / 2, width / 2, (0.29, 0.52)),
        [box((-length / 2, s * 0.06, 0.262), (length / 2 - 0.02, s * 0.02, 0.291)) for s in (-1, 1)],
        look="red steel",
    )
    b.cut("tub", slab(length / 2 - 0.008, width / 2 - 0.008, (0.3, 1)))
    b.hinge("tub", "frame", -Y, (-length / 2, 0, 0.255), 0.9)
    b.part(
        "handle",
        beam(0.025, 0.025, (length / 2 + 0.03, 0, 0.23), (length / 2 + 0.45, 0, 0.75), Y),
        b.cylinder(0.014, length / 2 + 0.45, (-0.1, 0.1), 0.75),
        look="black steel",
    )
    b.hinge("handle", "frame", Y, (length / 2 + 0.03, 0, 0.23), 0.7, -0.2)


@kind(words="rotating drum, lottery drum, raffle drum", radius=(0.15, 0.32), length=(0.4, 0.8))
def compost_tumbler(b: ObjectBuilder, radius: float, length: float) -> None:
    z = radius + 0.35
    l = length / 2
    b.part(
        "stand",
        [
            beam(0.035, 0.035, (s * (l + 0.04), 0, z), (s * (l + 0.04), t * 0.35, 0.018), X)
            for s in (-1, 1)
            for t in (-1, 1)
        ],
        b.cylinder(0.014, (-l - 0.05, l + 0.05), 0, z),
        look="black steel",
    )
    b.part("drum", b.cylinder(radius, (-l, l), 0, z), look="dark green")
    b.cut(
        "drum",
        b.cylinder(radius - 0.008, (-l + 0.008, l - 0.008), 0, z),
        b.cylinder(0.017, (-1, 1), 0, z),
        slab(0.4 * l, 0.4 * radius, (z, z + 2)),
    )
    b.spin("drum", "stand", X, (0, 0, z))
    b.part(
        "hatch",
        slab(0.45 * l, 0.45 * radius, (z + radius + 0.001, z + radius + 0.008)),
        slab(0.03, (-0.4 * radius, -0.35 * radius), (z + radius + 0.007, z + radius + 0.03)),
        look="black",
    )
    b.hinge("hatch", "drum", -X, (0, 0.45 * radius, z + radius + 0.001), 1.8)


@kind(words="rain butt, water barrel, barrel", radius=(0.2, 0.35), height=(0.6, 1.0))
def rain_barrel(b: ObjectBuilder, radius: float, height: float) -> None:
    r = radius
    b.part(
        "barrel",
        b.lathe(
            [(0, 0), (0.8 * r, 0), (r, 0.35 * height), (r, 0.65 * height), (0.8 * r, height), (0, height)], (0, 0, 0)
        ),
        b.cylinder(0.02, 0, (-0.85 * r, -r - 0.07), 0.15 * height),
        b.cylinder(0.012, 0, -r - 0.06, (0.15 * height, 0.15 * height - 0.05)),
        look="brown wood",
    )
    b.cut(
        "barrel",
        b.lathe(
            [
                (0, 0.03),
                (0.76 * r, 0.03),
                (0.95 * r, 0.35 * height),
                (0.95 * r, 0.65 * height),
                (0.74 * r, height),
                (0.74 * r, 2 * height),
                (0, 2 * height),
            ],
            (0, 0, 0),
        ),
    )
    b.part(
        "lid",
        b.cylinder(0.8 * r, height + 0.001, height + 0.025),
        slab(0.05, 0.015, (height + 0.02, height + 0.05)),
        look="wood",
    )
    b.slide("lid", "barrel", Z, 0.3)
    knob(b, "tap", "barrel", (0, -r - 0.03, 0.15 * height + 0.02), 0.014, Z, high=0.03, reach=1.57, material="brass")


@kind(words="rabbit hutch, pet house, hen house", width=(0.5, 1.2), height=(0.5, 1.0))
def chicken_coop(b: ObjectBuilder, width: float, height: float) -> None:
    w = width / 2
    t = 0.35 * width
    b.part(
        "house",
        slab(w, t, (0.1, height)),
        [
            box((x - 0.025, y - 0.025, 0), (x + 0.025, y + 0.025, 0.11))
            for x in (-w + 0.025, w - 0.025)
            for y in (-t + 0.025, t - 0.025)
        ],
        look="wood",
    )
    b.cut(
        "house",
        slab(w - 0.015, t - 0.015, (0.115, height + 1)),
        box((-0.7 * w, -t - 1, 0.15), (-0.1 * w, 0, 0.8 * height)),
        box((0.2 * w, -t - 1, 0.4 * height), (0.8 * w, 0, 0.75 * height)),
    )
    leaf(b, "door", "house", (-0.75 * w, -t - 0.018, 0.13), (-0.05 * w, -t, 0.84 * height), hinge=-X, reach=1.9)
    leaf(
        b,
        "roof",
        "house",
        (-w - 0.03, -t - 0.06, height),
        (w + 0.03, t, height + 0.02),
        hinge=Y,
        out=Z,
        reach=1.2,
        handle=False,
    )


@kind(number=whole(1, 8, usual=(3, 6), words="frame"))
def beehive(b: ObjectBuilder, number: int) -> None:
    b.part(
        "box",
        slab(0.25, 0.2, (0.05, 0.3)),
        [slab((x - 0.03, x + 0.03), 0.2, (0, 0.051)) for x in (-0.2, 0.2)],
        look="wood",
    )
    b.cut("box", slab(0.23, 0.18, (0.07, 1)), slab(0.1, (-0.3, 0), (0.07, 0.085)))
    for k, x in enumerate(spread(number, -0.22, 0.22)):
        b.part(f"frame_{k}", slab((x - 0.012, x + 0.012), 0.17, (0.09, 0.295)), look="yellow wood")
        b.slide(f"frame_{k}", "box", Z, 0.004)
    b.part("lid", slab(0.27, 0.22, (0.305, 0.35)), look="metal")
    b.slide("lid", "box", Z, 0.3)


@kind(words="wood splitter, hydraulic splitter", length=(1.2, 1.7))
def log_splitter(b: ObjectBuilder, length: float) -> None:
    b.part(
        "beam",
        slab((0, length), 0.08, (0.35, 0.45)),
        slab((length - 0.08, length - 0.02), 0.015, (0.44, 0.65)),
        b.cylinder(0.06, (0, 0.35 * length), 0, 0.54),
        slab((0, 0.04), 0.05, (0.44, 0.6)),
        slab((0.3 * length, 0.33 * length), 0.05, (0.44, 0.5)),
        slab((length - 0.1, length - 0.04), 0.03, (0, 0.36)),
        slab((0.2 * length - 0.04, 0.2 * length + 0.04), 0.2, (0.18, 0.36)),
        look="red steel",
    )
    b.bore("beam", b.cylinder(0.032, (0.05, length * 0.5), 0, 0.54))
    b.part(
        "ram",
        b.cylinder(0.028, (0.08, 0.42 * length), 0, 0.54),
        slab((0.4 * length, 0.44 * length), 0.07, (0.452, 0.63)),
        look="steel",
    )
    b.slide("ram", "beam", X, 0.25 * length)
    for k, s in enumerate((-1, 1)):
        wheel(b, f"wheel_{k}", "beam", (0.2 * length, s * 0.255, 0.2), 0.2, 0.1, s * Y, axle=0.005)
    lever(b, "lever", "beam", (0.3 * length, -0.08, 0.4), -Y, Z, 0.2, reach=0.5, lower=-0.5)


@kind(words="lawn roller", width=(0.3, 0.6), radius=(0.1, 0.2))
def garden_roller(b: ObjectBuilder, width: float, radius: float) -> None:
    w = width / 2
    b.part(
        "handle",
        [beam(0.02, 0.02, (s * (w + 0.025), 0, radius), (s * (w + 0.025), 0.5, 0.9), X) for s in (-1, 1)],
        b.cylinder(0.014, (-w - 0.035, w + 0.035), 0.5, 0.9),
        b.cylinder(0.012, (-w - 0.03, w + 0.03), 0, radius),
        look="green steel",
    )
    b.part("drum", b.cylinder(radius, (-w, w), 0, radius), look="green")
    b.cut("drum", b.cylinder(0.014, (-1, 1), 0, radius))
    b.spin("drum", "handle", X, (0, 0, radius))


@kind(words="snow thrower", size=(0.9, 1.2))
def snow_blower(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.3, (-0.5, -0.1), (0.05, 0.5)),
        p.slab(0.2, (-0.12, 0.35), (0.2, 0.55)),
        p.cylinder(0.07, 0, -0.2, (0.49, 0.54)),
        [p.rod(0.014, (s * 0.2, 0.25, 0.45), (s * 0.25, 0.8, 0.95)) for s in (-1, 1)],
        p.rod(0.014, (-0.25, 0.25), 0.8, 0.95),
        [p.cylinder(0.02, (s * 0.19, s * 0.235), 0.15, 0.2) for s in (-1, 1)],
        p.slab(0.19, (0.1, 0.2), (0.15, 0.25)),
        look="red steel",
    )
    b.cut("body", p.slab(0.28, (-1, -0.14), (0.07, 0.45)))
    b.bore("body", p.cylinder(0.022, (-1, 1), -0.32, 0.26))
    b.part(
        "auger",
        p.cylinder(0.018, (-0.32, 0.32), -0.32, 0.26),
        [
            p.beam(
                0.03,
                0.02,
                (x, -0.32 - 0.15 * cos(14 * x), 0.26 - 0.15 * sin(14 * x)),
                (x, -0.32 + 0.15 * cos(14 * x), 0.26 + 0.15 * sin(14 * x)),
            )
            for x in (-0.22, -0.11, 0, 0.11, 0.22)
        ],
        look="black steel",
    )
    b.spin("auger", "body", X, p(0, -0.32, 0.26))
    b.part(
        "chute",
        p.cylinder(0.07, 0, -0.2, (0.542, 0.6)),
        p.beam(0.12, 0.02, (0, -0.24, 0.58), (0, -0.3, 0.85), Y),
        look="red steel",
    )
    b.hinge("chute", "body", Z, p(0, -0.2, 0), 1.6, -1.6)
    for k, s in enumerate((-1, 1)):
        wheel(b, f"wheel_{k}", "body", p(s * 0.29, 0.15, 0.2), 0.2 * size, 0.1 * size, s * X, axle=0.004 * size)
