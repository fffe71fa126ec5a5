"""Tools with a joint that a hand works."""

from __future__ import annotations

from math import cos, sin

from kinematify.generate.library.kind import kind, whole
from kinematify.generate.library.mechanisms import knob
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.solids import X, Y, Z, beam, slab


@kind(
    part_words={"base_plate": "base, shoe, sole, plate, sole plate", "trigger": "switch"},
    size=(0.9, 1.2),
)
def jigsaw(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab((-0.1, 0.09), 0.03, (0.03, 0.1)),
        p.slab((-0.1, 0.08), 0.02, (0.14, 0.175)),
        p.slab((-0.1, -0.06), 0.02, (0.09, 0.16)),
        p.slab((0.05, 0.08), 0.02, (0.09, 0.16)),
        look="green",
    )
    b.bore("body", p.cylinder(0.006, 0.075, 0, (0, 0.085)))
    b.cut("body", p.slab((-0.001, 0.031), 0.009, (0.13, 0.152)))
    b.part(
        "base_plate",
        p.slab((-0.09, 0.07), 0.04, (0, 0.004)),
        p.cylinder(0.012, (-0.06, 0.04), 0, 0.016),
        p.slab((-0.06, 0.04), 0.008, (0.003, 0.016)),
        look="steel",
    )
    b.hinge("base_plate", "body", X, p(0, 0, 0.016), 0.3, -0.3)
    b.part("blade", p.cylinder(0.005, 0.075, 0, (-0.01, 0.07)), p.slab((0.07, 0.08), 0.001, (-0.09, 0.0)), look="steel")
    b.slide("blade", "body", Z, 0.012, lower=-0.008)
    b.part("trigger", p.slab((0.0, 0.03), 0.008, (0.128, 0.142)), look="black")
    b.slide("trigger", "body", Z, 0.006)


@kind(
    words="hedge cutter, electric hedge trimmer",
    part_words={"blade": "knife, cutter bar", "trigger": "switch", "handle": "front handle"},
    details={"handle": 2, "guard": 1},
    length=(0.45, 0.7),
)
def hedge_trimmer(b: ObjectBuilder, length: float) -> None:
    b.part(
        "body",
        slab((-0.15, 0.1), 0.045, 0.05),
        beam(0.03, 0.03, (-0.14, 0, 0.02), (-0.32, 0, 0.02)),
        [b.rod(0.01, (0, s * 0.045, 0), (0, s * 0.09, 0.12)) for s in (-1, 1)],
        b.rod(0.01, 0, (-0.09, 0.09), 0.12),
        slab((0.1, 0.1 + length), 0.035, (-0.006, -0.001)),
        look="orange",
    )
    b.cut("body", slab((-0.251, -0.199), 0.009, (0, 0.018)))
    b.part(
        "blade",
        slab((0.115, 0.1 + length), 0.02, (0.0, 0.005)),
        [slab((0.13 + k * 0.05, 0.14 + k * 0.05), 0.045, (0.0, 0.005)) for k in range(int((length - 0.06) / 0.05))],
        look="steel",
    )
    b.slide("blade", "body", X, 0.01, lower=-0.01)
    b.part("trigger", slab((-0.25, -0.2), 0.008, 0.008), look="black")
    b.slide("trigger", "body", Z, 0.006)


@kind(
    words="nailer, brad nailer", part_words={"magazine": "nail magazine", "nose": "muzzle, safety tip"}, size=(0.8, 1.2)
)
def nail_gun(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.04, 0.035, (0.04, 0.28)),
        p.beam(0.035, 0.045, (-0.02, 0, 0.2), (-0.2, 0, 0.19), Y),
        p.slab((-0.2, -0.16), 0.022, (0.03, 0.2)),
        p.slab((-0.17, -0.03), 0.022, (0.03, 0.036)),
        look="yellow",
    )
    b.bore("body", p.cylinder(0.012, 0.01, 0, (0, 0.1)))
    b.part("nose", p.cylinder(0.011, 0.01, 0, (-0.03, 0.08)), look="steel")
    b.slide("nose", "body", Z, 0.012)
    b.part("trigger", p.slab((-0.075, -0.05), 0.009, (0.145, 0.17)), look="black")
    b.slide("trigger", "body", Z, 0.006)
    b.part("magazine", p.slab((-0.155, -0.045), 0.015, (0.037, 0.06)), look="steel")
    b.slide("magazine", "body", -Y, 0.03)


@kind(words="hot glue gun, craft glue gun", part_words={"trigger": "lever"}, size=(0.8, 1.3))
def glue_gun(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab((-0.08, 0.07), 0.018, (0.1, 0.15)),
        p.cone(0.012, 0.003, (0.068, 0.11), 0, 0.125),
        p.beam(0.035, 0.03, (-0.05, 0, 0.11), (-0.08, 0, 0.01), Y),
        look="blue",
    )
    b.bore("body", p.cylinder(0.0065, (-0.1, 0), 0, 0.125))
    b.part("stick", p.cylinder(0.0055, (-0.14, -0.01), 0, 0.125), look="white")
    b.slide("stick", "body", X, 0.008, lower=-0.04)
    b.cut("body", p.slab((-0.013, 0.01), 0.008, (0, 0.112)))
    b.part("trigger", p.beam(0.014, 0.012, (0, 0, 0.103), (-0.02, 0, 0.03), Y), look="black")
    b.hinge("trigger", "body", Y, p(0, 0, 0.103), 0.25)


@kind(
    words="fret saw, fretsaw machine",
    part_words={"knob": "speed knob, dial", "arm": "upper arm"},
    size=(0.9, 1.2),
)
def scroll_saw(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "base",
        p.slab((-0.3, 0.25), 0.12, (0, 0.06)),
        p.slab((-0.3, -0.22), 0.05, (0.05, 0.36)),
        p.slab((-0.3, 0.16), 0.03, (0.32, 0.37)),
        p.box((0.02, -0.1, 0.055), (0.06, -0.085, 0.148)),
        look="blue steel",
    )
    b.bore("base", p.cylinder(0.007, 0.14, 0, (0.02, 0.35)))
    b.part(
        "table",
        p.slab((-0.05, 0.22), 0.14, (0.165, 0.175)),
        p.box((0.01, -0.08, 0.1), (0.07, -0.07, 0.166)),
        look="metal",
    )
    b.cut("table", p.slab((0.128, 0.152), 0.07, (0, 1)))
    b.hinge("table", "base", X, p(0.04, -0.075, 0.13), 0.2, -0.1)
    b.part("blade", p.cylinder(0.006, 0.14, 0, (0.29, 0.34)), p.slab((0.138, 0.142), 0.0008, (0.05, 0.3)), look="steel")
    b.slide("blade", "base", Z, 0.006, lower=-0.008)
    knob(b, "knob", "base", [0.05 * size, -0.12 * size, 0.03 * size], 0.015 * size, -Y, high=0.015 * size)


@kind(
    words="roller brush, wallpaper roller, brayer",
    part_words={"roller": "roll, sleeve"},
    details={"handle": 1},
    width=(0.1, 0.28),
)
def paint_roller(b: ObjectBuilder, width: float) -> None:
    b.part(
        "handle",
        b.cylinder(0.014, 0, 0.13),
        b.rod(0.004, 0.12, 0.2),
        b.rod(0.004, (0, 0, 0.2), (-0.5 * width - 0.02, 0, 0.23)),
        b.rod(0.004, -0.5 * width - 0.02, 0, (0.23, 0.3)),
        b.cylinder(0.004, (-0.5 * width - 0.022, 0.5 * width), 0, 0.3),
        look="red",
    )
    b.part("roller", b.cylinder(0.025, (-0.5 * width, 0.5 * width), 0, 0.3), look="white")
    b.cut("roller", b.cylinder(0.0048, (-width, width), 0, 0.3))
    b.spin("roller", "handle", X, (0, 0, 0.3))


@kind(
    "screwdriver",
    words="ratcheting screwdriver",
    title="ratchet screwdriver",
    part_words={"shaft": "bit, blade, tip, shank"},
    details={"handle": 1},
    length=(0.16, 0.3),
)
def ratchet_screwdriver(b: ObjectBuilder, length: float) -> None:
    b.part(
        "handle", b.cylinder(0.016, 0.55 * length, length), b.cylinder(0.013, 0.5 * length, 0.56 * length), look="red"
    )
    b.bore("handle", b.cylinder(0.0056, 0, 0.75 * length))
    b.part("shaft", b.cylinder(0.005, 0.01, 0.7 * length), slab(0.004, 0.001, (0, 0.02)), look="steel")
    b.spin("shaft", "handle", Z, (0, 0, 0))


@kind(
    words="folding rule, carpenter's rule, zigzag rule, zigzag ruler, folding yardstick",
    part_words={"segment": "link, section, element, piece"},
    segments=whole(2, 10),
)
def folding_ruler(b: ObjectBuilder, segments: int) -> None:
    b.part("segment_1", beam(0.016, 0.003, (0, 0, 0.002), (0.23, 0, 0.002)), look="yellow wood")
    for k in range(1, segments):
        x = 0.22 if k % 2 else 0.01
        z = 0.002 + 0.004 * k
        b.part(
            f"segment_{k + 1}",
            beam(0.016, 0.003, (0, 0, z), (0.23, 0, z)),
            b.cylinder(0.003, x, 0, (z - 0.0025, z)),
            look="yellow wood",
        )
        b.hinge(f"segment_{k + 1}", f"segment_{k}", (1 if k % 2 else -1) * Z, [x, 0, z], 3.1)


@kind(
    words="octant", part_words={"arm": "index arm, index, alidade"}, details={"telescope": 1, "arc": 1}, size=(0.9, 1.2)
)
def sextant(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "frame",
        [p.rod(0.005, (0, 0, 0.2), (s * 0.1, 0, 0.02)) for s in (-1, 1)],
        [
            p.rod(0.007, (0.2 * sin(a), 0, 0.2 - 0.2 * cos(a)), (0.2 * sin(a + 0.1), 0, 0.2 - 0.2 * cos(a + 0.1)))
            for a in [-0.55 + 0.1 * k for k in range(11)]
        ],
        p.cylinder(0.01, 0, (-0.014, 0.006), 0.2),
        p.cylinder(0.012, (-0.09, 0.03), 0.025, 0.12),
        p.box((-0.06, 0, 0.1), (-0.05, 0.025, 0.12)),
        p.box((0.01, 0, 0.1), (0.03, 0.025, 0.12)),
        p.rod(0.004, (-0.07, 0.07), 0, 0.1),
        look="brass",
    )
    b.part("arm", p.beam(0.03, 0.004, (0, -0.0105, 0.225), (0, -0.0105, -0.03), Y), look="brass")
    b.cut("arm", p.cylinder(0.0106, 0, (-1, 1), 0.2))
    b.hinge("arm", "frame", Y, p(0, 0, 0.2), 0.5, -0.5)
