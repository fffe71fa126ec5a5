"""Instruments and vessels of a laboratory or a clinic."""

from __future__ import annotations

from math import cos, sin

from kinematify.generate.library.kind import kind, length, whole
from kinematify.generate.library.mechanisms import case, caster, knob, legs
from kinematify.generate.library.panels import carcass, drawer, leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, prism, slab, vector


@kind(words="micropipette, pipettor", size=(0.9, 1.1))
def pipette(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.cylinder(0.014, 0.12, 0.22),
        p.cone(0.004, 0.012, 0.02, 0.12),
        p.cone(0.001, 0.004, -0.04, 0.022),
        p.slab(0.012, (0.005, 0.035), (0.19, 0.2)),
        look="white",
    )
    b.bore("body", p.cylinder(0.0042, 0.17, 0.3))
    b.part("plunger", p.cylinder(0.003, 0.19, 0.245), p.cylinder(0.011, 0.24, 0.25), look="blue")
    b.slide("plunger", "body", -Z, 0.016)
    b.part(
        "ejector", p.slab((0.015, 0.019), 0.006, (0.1, 0.215)), p.slab((0.015, 0.03), 0.006, (0.21, 0.218)), look="grey"
    )
    b.slide("ejector", "body", -Z, 0.012)


@kind(
    words="fume cupboard, safety cabinet, biosafety cabinet, laminar flow cabinet", width=(1.0, 1.8), height=(2.1, 2.4)
)
def fume_hood(b: ObjectBuilder, width: float, height: float) -> None:
    w = width / 2
    b.part(
        "cabinet",
        slab(w, (0, 0.75), (0, 0.9)),
        slab(w, (0.7, 0.75), (0.9, height)),
        [box((s * w, 0, 0.9), (s * (w - 0.05), 0.75, height)) for s in (-1, 1)],
        slab(w, (0.06, 0.75), (1.65, height)),
        slab(w, (0, 0.1), (height - 0.05, height)),
        slab(w + 0.02, (-0.03, 0.1), (0.88, 0.92)),
        look="white steel",
    )
    b.cut("cabinet", slab(w - 0.03, (-1, 0.6), (0.1, 0.8)), slab(w - 0.06, (0.1, 0.7), (1.7, height - 0.05)))
    b.part(
        "sash", slab(w - 0.055, (0.02, 0.035), (0.95, 1.6)), slab(w - 0.055, (0.005, 0.04), (0.95, 0.99)), look="glass"
    )
    b.slide("sash", "cabinet", Z, height - 1.67)
    for k, s in enumerate((-1, 1)):
        leaf(
            b,
            f"door_{k}",
            "cabinet",
            (0, -0.02, 0.08),
            (s * (w - 0.01), 0, 0.84),
            hinge=s * X,
            reach=1.8,
            material="steel",
        )


@kind(
    words="drying oven, drying cabinet, sterilizer, laboratory oven, climate chamber",
    width=(0.5, 0.8),
    height=(0.6, 1.0),
    number=whole(1, 8, default=3, usual=(2, 4), words="rack, shelf, tray"),
)
def incubator(b: ObjectBuilder, width: float, height: float, number: int) -> None:
    carcass(b, "cabinet", (-width / 2, 0, 0.05), (width / 2, 0.6, height), 0.05, material="steel")
    legs(b, "cabinet", (-width / 2, 0, 0), (width / 2, 0.6, 0.055), 0.04)
    leaf(
        b,
        "door",
        "cabinet",
        (-width / 2, -0.06, 0.05),
        (width / 2, -0.001, height),
        hinge=-X,
        reach=1.8,
        material="steel",
    )
    b.part(
        "cabinet",
        [
            box((s * (width / 2 - 0.051), 0.02, z - 0.012), (s * (width / 2 - 0.07), 0.5, z - 0.004))
            for s in (-1, 1)
            for z in spread(number, 0.12, height - 0.1)
        ],
    )
    for k, z in enumerate(spread(number, 0.12, height - 0.1)):
        b.part(f"rack_{k}", slab(width / 2 - 0.055, (0.02, 0.48), (z - 0.003, z + 0.006)), look="steel")
        b.slide(f"rack_{k}", "cabinet", -Y, 0.015)


@kind(words="vacuum chamber, steam sterilizer", radius=(0.2, 0.35), length=(0.5, 0.9))
def autoclave(b: ObjectBuilder, radius: float, length: float) -> None:
    z = radius + 0.25
    b.part(
        "vessel",
        b.cylinder(radius, 0, (0, length), z),
        [slab(0.8 * radius, (y - 0.04, y + 0.04), (0, 0.26 + 0.1 * radius)) for y in (0.2 * length, 0.8 * length)],
        box((radius - 0.02, 0, z - 0.06), (radius + 0.07, 0.03, z + 0.06)),
        look="steel",
    )
    b.cut("vessel", b.cylinder(radius - 0.015, 0, (-1, length - 0.02), z))
    b.part(
        "door",
        b.cylinder(radius + 0.01, 0, (-0.001, -0.03), z),
        box((0, -0.03, z - 0.03), (radius + 0.07, -0.005, z + 0.03)),
        look="steel",
    )
    b.hinge("door", "vessel", Z, (radius + 0.07, -0.001, z), 1.9)
    b.part(
        "wheel",
        b.torus(0.1, 0.01, (0, -0.1, z), Y),
        [
            beam(0.012, 0.01, (-0.1 * cos(a), -0.1, z - 0.1 * sin(a)), (0.1 * cos(a), -0.1, z + 0.1 * sin(a)), Y)
            for a in (0, 1.05, 2.1)
        ],
        b.cylinder(0.014, 0, (-0.031, -0.11), z),
        look="black steel",
    )
    b.spin("wheel", "door", -Y, (0, 0, z))


@kind(words="rotavap", size=(0.9, 1.1))
def rotary_evaporator(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "base",
        p.slab(0.2, 0.15, (0, 0.04)),
        p.slab((0.1, 0.18), 0.05, (0.03, 0.5)),
        p.cylinder(0.1, -0.08, 0, (0.03, 0.15)),
        look="white metal",
    )
    b.cut("base", p.cylinder(0.094, -0.08, 0, (0.045, 0.3)))
    b.part(
        "lift",
        p.slab((0.075, 0.098), 0.055, (0.35, 0.45)),
        [p.box((0.06, s * 0.055, 0.35), (0.18, s * 0.051, 0.45)) for s in (-1, 1)],
        [p.box((0.03, s * 0.035, 0.37), (0.078, s * 0.027, 0.44)) for s in (-1, 1)],
        look="grey metal",
    )
    b.slide("lift", "base", Z, 0.04, lower=-0.01)
    b.part(
        "arm",
        p.beam(0.04, 0.05, (0.045, 0, 0.405), (-0.02, 0, 0.38), Y),
        p.cylinder(0.014, -0.02, 0, (0.4, 0.55)),
        look="white",
    )
    b.cut("arm", p.cylinder(0.013, (-0.035, 0, 0.33), (0, 0, 0.41)))
    b.hinge("arm", "lift", Y, p(0.045, 0, 0.405), 0.2, -0.2)
    b.part(
        "flask",
        p.cylinder(0.011, (-0.012, 0, 0.385), (-0.06, 0, 0.285)),
        p.ball(0.055, (-0.08, 0, 0.245)),
        look="glass",
    )
    b.spin("flask", "arm", vector(-0.43, 0, -0.9), p(-0.012, 0, 0.385))


@kind(words="magnetic stirrer", width=(0.14, 0.22))
def hot_plate_stirrer(b: ObjectBuilder, width: float) -> None:
    b.part(
        "case",
        slab(width / 2, width / 2, (0, 0.08)),
        slab(width / 2, (-width / 2 - 0.04, -width / 2 + 0.01), (0, 0.05)),
        b.cylinder(0.45 * width, 0, 0.01, (0.08, 0.09)),
        look="white metal",
    )
    b.cut("case", slab(width / 2 - 0.006, (-width / 2 + 0.02, width / 2 - 0.006), (0.006, 0.074)))
    for k, x in enumerate((-0.25 * width, 0.25 * width)):
        knob(b, f"knob_{k}", "case", (x, -width / 2 - 0.04, 0.025), 0.016, -Y, high=0.018, reach=4.7)


@kind(words="laboratory balance, precision scale, draft shield balance", size=(0.9, 1.1))
def analytical_balance(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "base",
        p.slab(0.11, (-0.17, 0.15), (0, 0.06)),
        p.slab(0.11, (0.13, 0.15), (0.06, 0.32)),
        p.slab(0.11, (-0.07, 0.15), (0.31, 0.32)),
        p.slab(0.11, (-0.07, -0.066), (0.06, 0.32)),
        look="white",
    )
    b.bore("base", p.cylinder(0.007, 0, 0.03, (0.03, 0.1)))
    b.part("pan", p.cylinder(0.005, 0, 0.03, (0.04, 0.07)), p.cylinder(0.045, 0, 0.03, (0.068, 0.073)), look="steel")
    b.slide("pan", "base", -Z, 0.004)
    for k, s in enumerate((-1, 1)):
        b.part(f"door_{k}", p.box((s * 0.104, -0.064, 0.062), (s * 0.108, 0.128, 0.308)), look="glass")
        b.hinge(f"door_{k}", "base", s * Z, p(s * 0.108, 0.128, 0), 1.3)


@kind(words="lab stand, clamp stand, ring stand, burette stand", height=(0.5, 0.8))
def retort_stand(b: ObjectBuilder, height: float) -> None:
    b.part("base", slab(0.1, (-0.08, 0.1), (0, 0.015)), b.cylinder(0.006, 0, 0.07, (0.01, height)), look="steel")
    b.part(
        "clamp",
        b.tube(0.016, 0.0075, 0, 0.07, (0.6 * height, 0.6 * height + 0.03)),
        b.cylinder(0.005, 0, (0.056, -0.05), 0.6 * height + 0.015),
        b.torus(0.035, 0.004, (0, -0.085, 0.6 * height + 0.015), Z),
        look="metal",
    )
    b.slide("clamp", "base", Z, 0.3 * height, lower=-0.4 * height)


@kind(words="sandblasting cabinet, isolator", width=(0.6, 1.1))
def glove_box(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "box",
        prism([(-0.3, 0), (0.3, 0), (0.3, 0.65), (0, 0.65), (-0.3, 0.3)], (0, 0, 0.6), width, "x"),
        [
            box((x - 0.02, y - 0.02, 0), (x + 0.02, y + 0.02, 0.61))
            for x in (-w + 0.02, w - 0.02)
            for y in (-0.28, 0.28)
        ],
        look="blue steel",
    )
    b.cut(
        "box",
        prism([(-0.28, 0.02), (0.28, 0.02), (0.28, 0.63), (0.01, 0.63), (-0.28, 0.29)], (0, 0, 0.6), width - 0.03, "x"),
        [b.cylinder(0.08, s * 0.4 * w, (-1, 0), 0.76) for s in (-1, 1)],
        slab((w - 0.1, w + 0.1), 0.2, (0.66, 1)),
    )
    leaf(
        b, "door", "box", (w + 0.001, -0.22, 0.64), (w + 0.02, 0.22, 1.02), hinge=Y, out=X, reach=1.9, material="steel"
    )


@kind(radius=length(0.04, 0.14, default=0.045), height=length(0.015, 0.09, default=0.018))
def petri_dish(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part("dish", b.cylinder(radius, 0, height), look="glass")
    b.cut("dish", b.cylinder(0.95 * radius, 0.002, 1))
    b.part("lid", b.cylinder(1.04 * radius, 0.6 * height, height + 0.003), look="glass")
    b.cut("lid", b.cylinder(1.02 * radius, -1, height + 0.001))
    b.slide("lid", "dish", Z, 2 * height)


@kind(words="test tube stand, tube rack", number=whole(1, 12, default=5, usual=(3, 8), words="tube, test tube"))
def test_tube_rack(b: ObjectBuilder, number: int) -> None:
    w = 0.035 * number / 2 + 0.01
    b.part(
        "rack",
        slab(w, 0.03, (0, 0.012)),
        slab(w, 0.03, (0.07, 0.08)),
        [slab((s * w, s * (w - 0.008)), 0.03, (0, 0.08)) for s in (-1, 1)],
        look="wood",
    )
    for k, x in enumerate(spread(number, -w + 0.01, w - 0.01)):
        b.cut("rack", b.cylinder(0.0105, x, 0, (0.006, 1)))
        b.part(f"tube_{k}", b.rod(0.009, x, 0, (0.016, 0.12)), look="glass")
        b.cut(f"tube_{k}", b.cylinder(0.0078, x, 0, (0.02, 1)))
        b.slide(f"tube_{k}", "rack", Z, 0.12)


@kind(words="thermocycler", width=(0.22, 0.35))
def pcr_machine(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    case(b, "body", (-w, -0.16, 0), (w, 0.16, 0.16), material="plastic")
    b.cut("body", slab(0.6 * w, (-0.02, 0.1), (0.11, 1)))
    leaf(
        b,
        "lid",
        "body",
        (-0.75 * w, -0.06, 0.16),
        (0.75 * w, 0.13, 0.19),
        hinge=Y,
        out=Z,
        reach=1.2,
        handle=False,
        material="plastic",
    )
    drawer(b, "drawer", "body", (-0.5 * w, -0.16, 0.02), (0.5 * w, 0.05, 0.08), handle=False, material="plastic")


@kind(
    words="optical rail, linear rail, lens rail, slide rail",
    number=whole(1, 8, default=2, usual=(1, 4), words="carriage, rider, lens holder"),
    length=(0.6, 1.4),
)
def optical_bench(b: ObjectBuilder, number: int, length: float) -> None:
    b.part(
        "rail",
        prism(
            [(-0.03, 0), (0.03, 0), (0.012, 0.02), (0.03, 0.04), (-0.03, 0.04), (-0.012, 0.02)],
            (0, 0, 0.02),
            length,
            "x",
        ),
        [slab((x - 0.03, x + 0.03), 0.05, (0, 0.021)) for x in (-0.42 * length, 0.42 * length)],
        look="black metal",
    )
    step = length / number
    for k, x in enumerate(spread(number, -length / 2, length / 2)):
        b.part(
            f"carriage_{k}",
            slab((x - 0.03, x + 0.03), 0.045, (0.0615, 0.08)),
            [box((x - 0.03, s * 0.0345, 0.03), (x + 0.03, s * 0.045, 0.07)) for s in (-1, 1)],
            b.cylinder(0.006, x, 0, (0.079, 0.16)),
            b.torus(0.03, 0.005, (x, 0, 0.195), X),
            b.cylinder(0.027, (x - 0.003, x + 0.003), 0, 0.195),
            look="metal",
        )
        b.slide(f"carriage_{k}", "rail", X, step / 2 - 0.04, lower=-step / 2 + 0.04)


@kind(size=(0.9, 1.2))
def bunsen_burner(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "base",
        p.cone(0.045, 0.03, 0, 0.02),
        p.cylinder(0.007, 0.018, 0.15),
        p.cylinder(0.005, (0, 0.06), 0, 0.03),
        look="brass",
    )
    b.cut("base", p.cylinder(0.0045, 0.05, 1))
    b.part("collar", p.tube(0.012, 0.0085, 0.05, 0.068), look="brass")
    b.hinge("collar", "base", Z, p(0, 0, 0), 1.5)
    knob(b, "valve", "base", p(0.045, -0.005, 0.03), 0.007 * size, -Y, high=0.014 * size)


@kind(size=(0.9, 1.1))
def syringe_pump(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.14, 0.06, (0, 0.09)),
        [p.slab((x - 0.008, x + 0.008), 0.045, (0.08, 0.125)) for x in (-0.13, 0.13)],
        [p.cylinder(0.005, (-0.125, 0.125), y, 0.11) for y in (-0.03, 0.03)],
        look="white",
    )
    b.part("carriage", p.slab((0.03, 0.06), 0.045, (0.092, 0.15)), look="blue metal")
    b.cut("carriage", [p.cylinder(0.0065, (0, 0.1), y, 0.11) for y in (-0.03, 0.03)])
    b.slide("carriage", "body", -X, 0.1, lower=-0.05)
    knob(b, "knob", "body", p(0.1, -0.06, 0.045), 0.016 * size, -Y, high=0.016 * size)


@kind(
    words=("surgery table, treatment table, exam bed, tattoo bed, physiotherapy bed, examination table, exam table"),
    height=(0.7, 0.85),
)
def operating_table(b: ObjectBuilder, height: float) -> None:
    b.part("base", slab(0.25, (-0.5, 0.4), (0, 0.08)), slab(0.15, 0.17, (0.07, 0.55 * height)), look="steel")
    b.cut("base", slab(0.125, 0.145, (0.1, 2)))
    b.part(
        "seat", slab(0.12, 0.14, (0.15, height)), slab(0.27, 0.3, (height - 0.005, height + 0.08)), look="black steel"
    )
    b.slide("seat", "base", Z, 0.2)
    b.part("back", slab(0.27, (0.302, 1), (height + 0.01, height + 0.08)), look="black")
    b.hinge("back", "seat", X, (0, 0.301, height + 0.08), 0.9)
    b.part("leg_section", slab(0.27, (-0.9, -0.302), (height + 0.01, height + 0.08)), look="black")
    b.hinge("leg_section", "seat", X, (0, -0.301, height + 0.005), 0.9)


@kind(words="operating lamp, ceiling lamp with arms, dental lamp, ceiling mounted lamp", size=(0.8, 1.1))
def surgical_lamp(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "mount", p.cylinder(0.1, 2.3, 2.35), p.cylinder(0.03, 2, 2.31), p.cylinder(0.045, 2, 2.02), look="white steel"
    )
    b.part(
        "arm",
        p.tube(0.045, 0.033, 2.025, 2.12),
        p.slab((0.04, 0.8), 0.025, (2.04, 2.1)),
        p.cylinder(0.03, 0.8, 0, (2, 2.1)),
        look="white steel",
    )
    b.spin("arm", "mount", Z, p(0, 0, 0))
    b.part(
        "drop",
        p.cylinder(0.028, 0.8, 0, (1.9, 1.997)),
        [p.beam(0.02, 0.02, (0.8, s * 0.02, 1.91), (0.8, s * 0.27, 1.8)) for s in (-1, 1)],
        [p.box((0.785, s * 0.26, 1.6), (0.815, s * 0.28, 1.81)) for s in (-1, 1)],
        look="white steel",
    )
    b.spin("drop", "arm", Z, p(0.8, 0, 0))
    b.part(
        "head",
        p.cone(0.25, 0.15, 0.8, 0, (1.58, 1.68)),
        [p.cylinder(0.008, 0.8, (s * 0.18, s * 0.258), 1.63) for s in (-1, 1)],
        look="white metal",
    )
    b.hinge("head", "drop", Y, p(0.8, 0, 1.63), 0.7, -0.7)


@kind(words="bed table, laptop table, side table on wheels, c table", width=(0.6, 0.85), height=(0.6, 0.75))
def overbed_table(b: ObjectBuilder, width: float, height: float) -> None:
    b.part(
        "base",
        [slab(0.35, (s * 0.22 - 0.02, s * 0.22 + 0.02), (0.06, 0.09)) for s in (-1, 1)],
        slab((0.28, 0.34), 0.22, (0.06, 0.1)),
        slab((0.28, 0.36), 0.04, (0.08, 0.8 * height)),
        look="white steel",
    )
    b.cut("base", slab((0.29, 0.35), 0.03, (0.12, 2)))
    b.part(
        "top",
        slab((0.292, 0.348), 0.028, (0.25, height)),
        slab((0.36 - width, 0.36), 0.2, (height - 0.005, height + 0.02)),
        look="wood",
    )
    b.slide("top", "base", Z, 0.3)
    for k, (x, y) in enumerate([(x, y) for x in (-0.32, 0.32) for y in (-0.22, 0.22)]):
        caster(b, f"caster_{k}", "base", (x, y, 0.06), 0.06)


@kind(words="walking stick, walking cane, cane, trekking pole, hiking pole", height=(0.8, 1.1))
def crutch(b: ObjectBuilder, height: float) -> None:
    b.part(
        "shaft",
        b.tube(0.012, 0.0095, 0.45 * height, height),
        b.cylinder(0.012, height - 0.01, height + 0.01),
        b.rod(0.014, 0, (0.02, -0.1), height),
        look="metal",
    )
    b.part("tube", b.cylinder(0.008, 0.02, 0.8 * height), b.cylinder(0.016, 0, 0.04), look="black metal")
    b.slide("tube", "shaft", -Z, 0.25 * height, lower=-0.1 * height)


@kind(words="pill organizer, weekly pill box", number=whole(1, 14, usual=(4, 8), words="lid, compartment, day"))
def pill_box(b: ObjectBuilder, number: int) -> None:
    w = 0.03 * number / 2
    b.part("box", slab(w, 0.02, (0, 0.022)), look="blue")
    for k, x in enumerate(spread(number, -w, w)):
        b.cut("box", slab((x - 0.0135, x + 0.0135), 0.0185, (0.002, 1)))
        b.part(f"lid_{k}", box((x - 0.0145, -0.022, 0.0225), (x + 0.0145, 0.02, 0.025)), look="white")
        b.hinge(f"lid_{k}", "box", -X, (x, 0.02, 0.0225), 1.9)


@kind(words="surgical clamp, artery forceps, needle holder", size=(0.8, 1.3))
def hemostat(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "arm",
        p.beam(0.008, 0.004, (-0.004, 0.05, 0.002), (0.02, -0.07, 0.002)),
        p.beam(0.008, 0.004, (-0.004, 0.05, 0.002), (-0.003, 0.09, 0.002)),
        p.torus(0.014, 0.003, (0.03, -0.08, 0.003), Z),
        p.cylinder(0.0035, 0, 0.03, (0, 0.0085)),
        look="steel",
    )
    b.part(
        "other_arm",
        p.beam(0.008, 0.004, (0.004, 0.05, 0.0065), (-0.02, -0.07, 0.0065)),
        p.beam(0.008, 0.004, (0.004, 0.05, 0.0065), (0.003, 0.09, 0.0065)),
        p.torus(0.014, 0.003, (-0.03, -0.08, 0.0075), Z),
        p.cylinder(0.006, 0, 0.03, (0.0045, 0.008)),
        look="steel",
    )
    b.cut("other_arm", p.cylinder(0.0042, 0, 0.03, (-1, 1)))
    b.hinge("other_arm", "arm", Z, p(0, 0.03, 0), 0.25, -0.02)


@kind(walls=50, words="mri scanner, mri machine, tomograph, x ray scanner", size=(0.9, 1.1))
def ct_scanner(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "gantry",
        p.slab(1, 0.4, (0, 1.9)),
        p.slab(0.3, (-2.4, -0.5), (0, 0.7)),
        p.slab(0.35, (-0.5, -0.39), (0, 0.3)),
        look="white",
    )
    b.cut(
        "gantry",
        p.cylinder(0.38, 0, (-1, 1), 1.05),
        p.slab((-0.97, -0.45), 0.37, (0.03, 1.85)),
        p.slab((0.45, 0.97), 0.37, (0.03, 1.85)),
        p.slab(0.27, (-2.35, -0.52), (0.03, 0.65)),
    )
    b.part(
        "table", p.slab(0.22, (-2.4, -0.45), (0.79, 0.84)), p.slab(0.2, (-2.4, -0.6), (0.702, 0.8)), look="light blue"
    )
    b.slide("table", "gantry", Y, 0.15)


@kind(walls=45, words="x ray machine, mobile x ray", size=(0.9, 1.1))
def c_arm(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "base",
        p.slab((0.5, 1.1), 0.3, (0.12, 0.7)),
        p.slab((-0.2, 0.5), 0.06, (0.12, 0.18)),
        p.slab((0.6, 0.8), 0.1, (0.69, 1.2)),
        look="white",
    )
    b.cut("base", p.slab((0.53, 1.07), 0.27, (0.15, 0.66)))
    b.bore("base", p.slab((0.3, 0.9), 0.055, (1.045, 1.155)))
    b.part("slide_arm", p.slab((0.45, 0.78), 0.05, (1.05, 1.15)), look="steel")
    b.slide("slide_arm", "base", -X, 0.12)
    b.part(
        "arc",
        [
            p.beam(
                0.08,
                0.06,
                (-0.15 + 0.55 * cos(a), 0, 1.1 + 0.55 * sin(a)),
                (-0.15 + 0.55 * cos(a + 0.45), 0, 1.1 + 0.55 * sin(a + 0.45)),
                Y,
            )
            for a in [-1.575 + 0.45 * k for k in range(7)]
        ],
        p.cylinder(0.12, -0.15, 0, (0.55, 0.75)),
        p.cylinder(0.1, -0.15, 0, (1.5, 1.65)),
        look="white metal",
    )
    b.hinge("arc", "slide_arm", -X, p(0.45, 0, 1.1), 1.2, -1.2)
    for k, (x, y) in enumerate(((-0.15, 0), (1.05, -0.25), (1.05, 0.25))):
        caster(b, f"caster_{k}", "base", p(x, y, 0.12), 0.12 * size)


@kind(words="baby incubator, neonatal incubator", width=(0.6, 1.0))
def infant_incubator(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "base",
        slab(w, 0.25, (0, 0.7)),
        slab(w, (0.24, 0.25), (0.69, 1.1)),
        [slab((s * w, s * (w - 0.008)), 0.25, (0.69, 1.1)) for s in (-1, 1)],
        look="white",
    )
    b.cut("base", slab(w - 0.02, 0.23, (0.02, 0.66)))
    leaf(b, "door", "base", (-w, -0.258, 0.7), (w, -0.251, 1.1), hinge=-Z, reach=1.5, handle=False, material="glass")
    leaf(
        b, "hood", "base", (-w, -0.25, 1.1), (w, 0.25, 1.11), hinge=Y, out=Z, reach=1.4, handle=False, material="glass"
    )


@kind(words="knee prosthesis, leg prosthesis, artificial leg", size=(0.9, 1.1))
def prosthetic_leg(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "socket",
        p.cone(0.06, 0.09, 0.55, 0.85),
        p.slab(0.035, 0.035, (0.53, 0.56)),
        [p.slab((s * 0.028, s * 0.036), 0.02, (0.46, 0.56)) for s in (-1, 1)],
        look="black",
    )
    b.cut("socket", p.cone(0.055, 0.085, 0.57, 0.8501))
    b.part(
        "shin",
        p.slab(0.026, 0.018, (0.47, 0.505)),
        p.cylinder(0.016, 0.12, 0.48),
        [p.slab((s * 0.018, s * 0.025), 0.015, (0.08, 0.125)) for s in (-1, 1)],
        p.slab(0.025, 0.015, (0.112, 0.13)),
        look="metal",
    )
    b.hinge("shin", "socket", X, p(0, 0, 0.487), 0.5, 0)
    b.part(
        "foot", p.slab(0.016, 0.012, (0.055, 0.105)), p.slab(0.035, (-0.17, 0.06), (0.02, 0.06)), look="brown rubber"
    )
    b.hinge("foot", "shin", X, p(0, 0, 0.095), 0.2, -0.2)
