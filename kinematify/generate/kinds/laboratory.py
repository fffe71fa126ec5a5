"""Instruments and vessels of a laboratory or a clinic."""

from __future__ import annotations

from math import cos, sin
from typing import TYPE_CHECKING

from kinematify.generate.library.builder import spread
from kinematify.generate.library.kind import kind, length, whole
from kinematify.generate.library.mechanisms import case, caster, knob, legs
from kinematify.generate.library.panels import carcass, drawer, leaf
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, prism, scaled, vector

if TYPE_CHECKING:
    from kinematify.generate.library.builder import ObjectBuilder


@kind(
    "pipette",
    words="micropipette, dropper, pipettor",
    size=length(0.9, 1.1),
)
def pipette(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "body",
        b.cylinder(0.014 * size, p(0, 0, 0.12), p(0, 0, 0.22)),
        b.cone(0.004 * size, 0.012 * size, p(0, 0, 0.02), p(0, 0, 0.12)),
        b.cone(0.001 * size, 0.004 * size, p(0, 0, -0.04), p(0, 0, 0.022)),
        box(p(-0.012, 0.005, 0.19), p(0.012, 0.035, 0.2)),
        color="white",
    )
    b.bore("body", b.cylinder(0.0042 * size, p(0, 0, 0.17), p(0, 0, 0.3)))
    b.part(
        "plunger",
        b.cylinder(0.003 * size, p(0, 0, 0.19), p(0, 0, 0.245)),
        b.cylinder(0.011 * size, p(0, 0, 0.24), p(0, 0, 0.25)),
        color="blue",
    )
    b.slide("plunger", parent="body", axis=-Z, upper=0.016)
    b.part(
        "ejector",
        box(p(0.015, -0.006, 0.1), p(0.019, 0.006, 0.215)),
        box(p(0.015, -0.006, 0.21), p(0.03, 0.006, 0.218)),
        color="grey",
    )
    b.slide("ejector", parent="body", axis=-Z, upper=0.012)


@kind(
    "fume hood",
    words="fume cupboard, safety cabinet, biosafety cabinet, laminar flow cabinet",
    width=length(1.0, 1.8),
    height=length(2.1, 2.4),
)
def fume_hood(b: ObjectBuilder, width: float, height: float) -> None:
    w = width / 2
    b.part(
        "cabinet",
        box((-w, 0, 0), (w, 0.75, 0.9)),
        box((-w, 0.7, 0.9), (w, 0.75, height)),
        [box((s * w, 0, 0.9), (s * (w - 0.05), 0.75, height)) for s in (-1, 1)],
        box((-w, 0.06, 1.65), (w, 0.75, height)),
        box((-w, 0, height - 0.05), (w, 0.1, height)),
        box((-w - 0.02, -0.03, 0.88), (w + 0.02, 0.1, 0.92)),
        material="steel",
        color="white",
    )
    b.cut(
        "cabinet",
        box((-w + 0.03, -1, 0.1), (w - 0.03, 0.6, 0.8)),
        box((-w + 0.06, 0.1, 1.7), (w - 0.06, 0.7, height - 0.05)),
    )
    b.part(
        "sash",
        box((-w + 0.055, 0.02, 0.95), (w - 0.055, 0.035, 1.6)),
        box((-w + 0.055, 0.005, 0.95), (w - 0.055, 0.04, 0.99)),
        material="glass",
    )
    b.slide("sash", parent="cabinet", axis=Z, upper=height - 1.67)
    for k, s in enumerate((-1, 1)):
        leaf(
            b,
            f"door_{k}",
            parent="cabinet",
            lower=(0, -0.02, 0.08),
            upper=(s * (w - 0.01), 0, 0.84),
            hinge=s * X,
            out=-Y,
            reach=1.8,
            material="steel",
        )


@kind(
    "incubator",
    words="drying oven, drying cabinet, sterilizer, laboratory oven, climate chamber",
    width=length(0.5, 0.8),
    height=length(0.6, 1.0),
    number=whole(1, 8, default=3, usual=(2, 4), words="rack, shelf, tray"),
)
def incubator(b: ObjectBuilder, width: float, height: float, number: int) -> None:
    carcass(b, "cabinet", lower=(-width / 2, 0, 0.05), upper=(width / 2, 0.6, height), wall=0.05, material="steel")
    legs(b, "cabinet", lower=(-width / 2, 0, 0), upper=(width / 2, 0.6, 0.055), thick=0.04)
    leaf(
        b,
        "door",
        parent="cabinet",
        lower=(-width / 2, -0.06, 0.05),
        upper=(width / 2, -0.001, height),
        hinge=-X,
        out=-Y,
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
        b.part(
            f"rack_{k}",
            box((-width / 2 + 0.055, 0.02, z - 0.003), (width / 2 - 0.055, 0.48, z + 0.006)),
            material="steel",
        )
        b.slide(f"rack_{k}", parent="cabinet", axis=-Y, upper=0.015)


@kind(
    "autoclave",
    words="vacuum chamber, steam sterilizer, pressure vessel",
    radius=length(0.2, 0.35),
    length=length(0.5, 0.9),
)
def autoclave(b: ObjectBuilder, radius: float, length: float) -> None:
    z = radius + 0.25
    b.part(
        "vessel",
        b.cylinder(radius, (0, 0, z), (0, length, z)),
        [
            box((-0.8 * radius, y - 0.04, 0), (0.8 * radius, y + 0.04, 0.26 + 0.1 * radius))
            for y in (0.2 * length, 0.8 * length)
        ],
        box((radius - 0.02, 0, z - 0.06), (radius + 0.07, 0.03, z + 0.06)),
        material="steel",
    )
    b.cut("vessel", b.cylinder(radius - 0.015, (0, -1, z), (0, length - 0.02, z)))
    b.part(
        "door",
        b.cylinder(radius + 0.01, (0, -0.001, z), (0, -0.03, z)),
        box((0, -0.03, z - 0.03), (radius + 0.07, -0.005, z + 0.03)),
        material="steel",
    )
    b.hinge("door", parent="vessel", axis=Z, pivot=(radius + 0.07, -0.001, z), upper=1.9)
    b.part(
        "wheel",
        b.torus(0.1, 0.01, (0, -0.1, z), Y),
        [
            beam(0.012, 0.01, (-0.1 * cos(a), -0.1, z - 0.1 * sin(a)), (0.1 * cos(a), -0.1, z + 0.1 * sin(a)), Y)
            for a in (0, 1.05, 2.1)
        ],
        b.cylinder(0.014, (0, -0.031, z), (0, -0.11, z)),
        material="steel",
        color="black",
    )
    b.spin("wheel", parent="door", axis=-Y, pivot=(0, 0, z))


@kind(
    "rotary evaporator",
    words="rotavap",
    size=length(0.9, 1.1),
)
def rotary_evaporator(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "base",
        box(p(-0.2, -0.15, 0), p(0.2, 0.15, 0.04)),
        box(p(0.1, -0.05, 0.03), p(0.18, 0.05, 0.5)),
        b.cylinder(0.1 * size, p(-0.08, 0, 0.03), p(-0.08, 0, 0.15)),
        material="metal",
        color="white",
    )
    b.cut("base", b.cylinder(0.094 * size, p(-0.08, 0, 0.045), p(-0.08, 0, 0.3)))
    b.part(
        "lift",
        box(p(0.075, -0.055, 0.35), p(0.098, 0.055, 0.45)),
        [box(p(0.06, s * 0.055, 0.35), p(0.18, s * 0.051, 0.45)) for s in (-1, 1)],
        [box(p(0.03, s * 0.035, 0.37), p(0.078, s * 0.027, 0.44)) for s in (-1, 1)],
        material="metal",
        color="grey",
    )
    b.slide("lift", parent="base", axis=Z, upper=0.04, lower=-0.01)
    b.part(
        "arm",
        beam(0.04 * size, 0.05 * size, p(0.045, 0, 0.405), p(-0.02, 0, 0.38), Y),
        b.cylinder(0.014 * size, p(-0.02, 0, 0.4), p(-0.02, 0, 0.55)),
        color="white",
    )
    b.cut("arm", b.cylinder(0.013 * size, p(-0.035, 0, 0.33), p(0, 0, 0.41)))
    b.hinge("arm", parent="lift", axis=Y, pivot=p(0.045, 0, 0.405), upper=0.2, lower=-0.2)
    b.part(
        "flask",
        b.cylinder(0.011 * size, p(-0.012, 0, 0.385), p(-0.06, 0, 0.285)),
        ball(0.055 * size, p(-0.08, 0, 0.245)),
        material="glass",
    )
    b.spin("flask", parent="arm", axis=vector(-0.43, 0, -0.9), pivot=p(-0.012, 0, 0.385))


@kind("hot plate stirrer", words="magnetic stirrer", width=length(0.14, 0.22))
def hot_plate_stirrer(b: ObjectBuilder, width: float) -> None:
    b.part(
        "case",
        box((-width / 2, -width / 2, 0), (width / 2, width / 2, 0.08)),
        box((-width / 2, -width / 2 - 0.04, 0), (width / 2, -width / 2 + 0.01, 0.05)),
        b.cylinder(0.45 * width, (0, 0.01, 0.08), (0, 0.01, 0.09)),
        material="metal",
        color="white",
    )
    b.cut("case", box((-width / 2 + 0.006, -width / 2 + 0.02, 0.006), (width / 2 - 0.006, width / 2 - 0.006, 0.074)))
    for k, x in enumerate((-0.25 * width, 0.25 * width)):
        knob(
            b, f"knob_{k}", parent="case", at=(x, -width / 2 - 0.04, 0.025), radius=0.016, high=0.018, out=-Y, reach=4.7
        )


@kind(
    "analytical balance",
    words="laboratory balance, precision scale, draft shield balance",
    size=length(0.9, 1.1),
)
def analytical_balance(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "base",
        box(p(-0.11, -0.17, 0), p(0.11, 0.15, 0.06)),
        box(p(-0.11, 0.13, 0.06), p(0.11, 0.15, 0.32)),
        box(p(-0.11, -0.07, 0.31), p(0.11, 0.15, 0.32)),
        box(p(-0.11, -0.07, 0.06), p(0.11, -0.066, 0.32)),
        color="white",
    )
    b.bore("base", b.cylinder(0.007 * size, p(0, 0.03, 0.03), p(0, 0.03, 0.1)))
    b.part(
        "pan",
        b.cylinder(0.005 * size, p(0, 0.03, 0.04), p(0, 0.03, 0.07)),
        b.cylinder(0.045 * size, p(0, 0.03, 0.068), p(0, 0.03, 0.073)),
        material="steel",
    )
    b.slide("pan", parent="base", axis=-Z, upper=0.004)
    for k, s in enumerate((-1, 1)):
        b.part(f"door_{k}", box(p(s * 0.104, -0.064, 0.062), p(s * 0.108, 0.128, 0.308)), material="glass")
        b.hinge(f"door_{k}", parent="base", axis=s * Z, pivot=p(s * 0.108, 0.128, 0), upper=1.3)


@kind(
    "retort stand",
    words="lab stand, clamp stand, ring stand, burette stand, burette",
    height=length(0.5, 0.8),
)
def retort_stand(b: ObjectBuilder, height: float) -> None:
    b.part(
        "base",
        box((-0.1, -0.08, 0), (0.1, 0.1, 0.015)),
        b.cylinder(0.006, (0, 0.07, 0.01), (0, 0.07, height)),
        material="steel",
    )
    b.part(
        "clamp",
        b.tube(0.016, 0.0075, (0, 0.07, 0.6 * height), (0, 0.07, 0.6 * height + 0.03)),
        b.cylinder(0.005, (0, 0.056, 0.6 * height + 0.015), (0, -0.05, 0.6 * height + 0.015)),
        b.torus(0.035, 0.004, (0, -0.085, 0.6 * height + 0.015), Z),
        material="metal",
    )
    b.slide("clamp", parent="base", axis=Z, upper=0.3 * height, lower=-0.4 * height)


@kind(
    "glove box",
    words="glovebox, sandblasting cabinet, sand blaster, isolator",
    width=length(0.6, 1.1),
)
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
        material="steel",
        color="blue",
    )
    b.cut(
        "box",
        prism([(-0.28, 0.02), (0.28, 0.02), (0.28, 0.63), (0.01, 0.63), (-0.28, 0.29)], (0, 0, 0.6), width - 0.03, "x"),
        [b.cylinder(0.08, (s * 0.4 * w, -1, 0.76), (s * 0.4 * w, 0, 0.76)) for s in (-1, 1)],
        box((w - 0.1, -0.2, 0.66), (w + 0.1, 0.2, 1)),
    )
    leaf(
        b,
        "door",
        parent="box",
        lower=(w + 0.001, -0.22, 0.64),
        upper=(w + 0.02, 0.22, 1.02),
        hinge=Y,
        out=X,
        reach=1.9,
        material="steel",
    )


@kind("petri dish", radius=length(0.04, 0.14, default=0.045), height=length(0.015, 0.09, default=0.018))
def petri_dish(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part("dish", b.cylinder(radius, (0, 0, 0), (0, 0, height)), material="glass")
    b.cut("dish", b.cylinder(0.95 * radius, (0, 0, 0.002), (0, 0, 1)))
    b.part("lid", b.cylinder(1.04 * radius, (0, 0, 0.6 * height), (0, 0, height + 0.003)), material="glass")
    b.cut("lid", b.cylinder(1.02 * radius, (0, 0, -1), (0, 0, height + 0.001)))
    b.slide("lid", parent="dish", axis=Z, upper=2 * height)


@kind(
    "test tube rack",
    words="test tube stand, tube rack",
    number=whole(1, 12, default=5, usual=(3, 8), words="tube, test tube"),
)
def test_tube_rack(b: ObjectBuilder, number: int) -> None:
    w = 0.035 * number / 2 + 0.01
    b.part(
        "rack",
        box((-w, -0.03, 0), (w, 0.03, 0.012)),
        box((-w, -0.03, 0.07), (w, 0.03, 0.08)),
        [box((s * w, -0.03, 0), (s * (w - 0.008), 0.03, 0.08)) for s in (-1, 1)],
        material="wood",
    )
    for k, x in enumerate(spread(number, -w + 0.01, w - 0.01)):
        b.cut("rack", b.cylinder(0.0105, (x, 0, 0.006), (x, 0, 1)))
        b.part(f"tube_{k}", b.rod(0.009, (x, 0, 0.016), (x, 0, 0.12)), material="glass")
        b.cut(f"tube_{k}", b.cylinder(0.0078, (x, 0, 0.02), (x, 0, 1)))
        b.slide(f"tube_{k}", parent="rack", axis=Z, upper=0.12)


@kind(
    "pcr machine",
    words="thermocycler, spectrometer, photometer, blood analyzer, lab analyzer",
    width=length(0.22, 0.35),
)
def pcr_machine(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    case(b, "body", lower=(-w, -0.16, 0), upper=(w, 0.16, 0.16), material="plastic")
    b.cut("body", box((-0.6 * w, -0.02, 0.11), (0.6 * w, 0.1, 1)))
    leaf(
        b,
        "lid",
        parent="body",
        lower=(-0.75 * w, -0.06, 0.16),
        upper=(0.75 * w, 0.13, 0.19),
        hinge=Y,
        out=Z,
        reach=1.2,
        handle=False,
        material="plastic",
    )
    drawer(
        b,
        "drawer",
        parent="body",
        lower=(-0.5 * w, -0.16, 0.02),
        upper=(0.5 * w, 0.05, 0.08),
        out=-Y,
        handle=False,
        material="plastic",
    )


@kind(
    "optical bench",
    words="optical rail, linear rail, lens rail, slide rail, motorized slider",
    number=whole(1, 4, words="carriage, rider"),
    length=length(0.6, 1.4),
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
        [box((x - 0.03, -0.05, 0), (x + 0.03, 0.05, 0.021)) for x in (-0.42 * length, 0.42 * length)],
        material="metal",
        color="black",
    )
    step = length / number
    for k, x in enumerate(spread(number, -length / 2, length / 2)):
        b.part(
            f"carriage_{k}",
            box((x - 0.03, -0.045, 0.0615), (x + 0.03, 0.045, 0.08)),
            [box((x - 0.03, s * 0.0345, 0.03), (x + 0.03, s * 0.045, 0.07)) for s in (-1, 1)],
            b.cylinder(0.006, (x, 0, 0.079), (x, 0, 0.16)),
            b.torus(0.03, 0.005, (x, 0, 0.195), X),
            b.cylinder(0.027, (x - 0.003, 0, 0.195), (x + 0.003, 0, 0.195)),
            material="metal",
        )
        b.slide(f"carriage_{k}", parent="rail", axis=X, upper=step / 2 - 0.04, lower=-step / 2 + 0.04)


@kind("bunsen burner", size=length(0.9, 1.2))
def bunsen_burner(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "base",
        b.cone(0.045 * size, 0.03 * size, p(0, 0, 0), p(0, 0, 0.02)),
        b.cylinder(0.007 * size, p(0, 0, 0.018), p(0, 0, 0.15)),
        b.cylinder(0.005 * size, p(0, 0, 0.03), p(0.06, 0, 0.03)),
        material="brass",
    )
    b.cut("base", b.cylinder(0.0045 * size, p(0, 0, 0.05), p(0, 0, 1)))
    b.part("collar", b.tube(0.012 * size, 0.0085 * size, p(0, 0, 0.05), p(0, 0, 0.068)), material="brass")
    b.hinge("collar", parent="base", axis=Z, pivot=p(0, 0, 0), upper=1.5)
    knob(b, "valve", parent="base", at=p(0.045, -0.005, 0.03), radius=0.007 * size, high=0.014 * size, out=-Y)


@kind(
    "syringe pump",
    words="infusion pump, dosing pump",
    size=length(0.9, 1.1),
)
def syringe_pump(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "body",
        box(p(-0.14, -0.06, 0), p(0.14, 0.06, 0.09)),
        [box(p(x - 0.008, -0.045, 0.08), p(x + 0.008, 0.045, 0.125)) for x in (-0.13, 0.13)],
        [b.cylinder(0.005 * size, p(-0.125, y, 0.11), p(0.125, y, 0.11)) for y in (-0.03, 0.03)],
        color="white",
    )
    b.part("carriage", box(p(0.03, -0.045, 0.092), p(0.06, 0.045, 0.15)), material="metal", color="blue")
    b.cut("carriage", [b.cylinder(0.0065 * size, p(0, y, 0.11), p(0.1, y, 0.11)) for y in (-0.03, 0.03)])
    b.slide("carriage", parent="body", axis=-X, upper=0.1, lower=-0.05)
    knob(b, "knob", parent="body", at=p(0.1, -0.06, 0.045), radius=0.016 * size, high=0.016 * size, out=-Y)


@kind(
    "operating table",
    words=(
        "surgery table, massage table, treatment table, exam bed, dissection table, tattoo bed, physiotherapy bed, "
        "examination table, exam table"
    ),
    height=length(0.7, 0.85),
)
def operating_table(b: ObjectBuilder, height: float) -> None:
    b.part(
        "base",
        box((-0.25, -0.5, 0), (0.25, 0.4, 0.08)),
        box((-0.15, -0.17, 0.07), (0.15, 0.17, 0.55 * height)),
        material="steel",
    )
    b.cut("base", box((-0.125, -0.145, 0.1), (0.125, 0.145, 2)))
    b.part(
        "seat",
        box((-0.12, -0.14, 0.15), (0.12, 0.14, height)),
        box((-0.27, -0.3, height - 0.005), (0.27, 0.3, height + 0.08)),
        material="steel",
        color="black",
    )
    b.slide("seat", parent="base", axis=Z, upper=0.2)
    b.part("back", box((-0.27, 0.302, height + 0.01), (0.27, 1, height + 0.08)), color="black")
    b.hinge("back", parent="seat", axis=X, pivot=(0, 0.301, height + 0.08), upper=0.9)
    b.part("leg_section", box((-0.27, -0.9, height + 0.01), (0.27, -0.302, height + 0.08)), color="black")
    b.hinge("leg_section", parent="seat", axis=X, pivot=(0, -0.301, height + 0.005), upper=0.9)


@kind(
    "surgical lamp",
    words="operating lamp, ceiling lamp with arms, dental lamp, ceiling mounted lamp",
    size=length(0.8, 1.1),
)
def surgical_lamp(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "mount",
        b.cylinder(0.1 * size, p(0, 0, 2.3), p(0, 0, 2.35)),
        b.cylinder(0.03 * size, p(0, 0, 2), p(0, 0, 2.31)),
        b.cylinder(0.045 * size, p(0, 0, 2), p(0, 0, 2.02)),
        material="steel",
        color="white",
    )
    b.part(
        "arm",
        b.tube(0.045 * size, 0.033 * size, p(0, 0, 2.025), p(0, 0, 2.12)),
        box(p(0.04, -0.025, 2.04), p(0.8, 0.025, 2.1)),
        b.cylinder(0.03 * size, p(0.8, 0, 2), p(0.8, 0, 2.1)),
        material="steel",
        color="white",
    )
    b.spin("arm", parent="mount", axis=Z, pivot=p(0, 0, 0))
    b.part(
        "drop",
        b.cylinder(0.028 * size, p(0.8, 0, 1.9), p(0.8, 0, 1.997)),
        [beam(0.02 * size, 0.02 * size, p(0.8, s * 0.02, 1.91), p(0.8, s * 0.27, 1.8)) for s in (-1, 1)],
        [box(p(0.785, s * 0.26, 1.6), p(0.815, s * 0.28, 1.81)) for s in (-1, 1)],
        material="steel",
        color="white",
    )
    b.spin("drop", parent="arm", axis=Z, pivot=p(0.8, 0, 0))
    b.part(
        "head",
        b.cone(0.25 * size, 0.15 * size, p(0.8, 0, 1.58), p(0.8, 0, 1.68)),
        [b.cylinder(0.008 * size, p(0.8, s * 0.18, 1.63), p(0.8, s * 0.258, 1.63)) for s in (-1, 1)],
        material="metal",
        color="white",
    )
    b.hinge("head", parent="drop", axis=Y, pivot=p(0.8, 0, 1.63), upper=0.7, lower=-0.7)


@kind(
    "overbed table",
    words="bed table, laptop table, side table on wheels, c table",
    width=length(0.6, 0.85),
    height=length(0.6, 0.75),
)
def overbed_table(b: ObjectBuilder, width: float, height: float) -> None:
    b.part(
        "base",
        [box((-0.35, s * 0.22 - 0.02, 0.06), (0.35, s * 0.22 + 0.02, 0.09)) for s in (-1, 1)],
        box((0.28, -0.22, 0.06), (0.34, 0.22, 0.1)),
        box((0.28, -0.04, 0.08), (0.36, 0.04, 0.8 * height)),
        material="steel",
        color="white",
    )
    b.cut("base", box((0.29, -0.03, 0.12), (0.35, 0.03, 2)))
    b.part(
        "top",
        box((0.292, -0.028, 0.25), (0.348, 0.028, height)),
        box((0.36 - width, -0.2, height - 0.005), (0.36, 0.2, height + 0.02)),
        material="wood",
    )
    b.slide("top", parent="base", axis=Z, upper=0.3)
    for k, (x, y) in enumerate([(x, y) for x in (-0.32, 0.32) for y in (-0.22, 0.22)]):
        caster(b, f"caster_{k}", parent="base", top=(x, y, 0.06), high=0.06)


@kind(
    "crutch",
    words="walking stick, walking cane, cane, trekking pole, ski pole, hiking pole",
    height=length(0.8, 1.1),
)
def crutch(b: ObjectBuilder, height: float) -> None:
    b.part(
        "shaft",
        b.tube(0.012, 0.0095, (0, 0, 0.45 * height), (0, 0, height)),
        b.cylinder(0.012, (0, 0, height - 0.01), (0, 0, height + 0.01)),
        b.rod(0.014, (0, 0.02, height), (0, -0.1, height)),
        material="metal",
    )
    b.part(
        "tube",
        b.cylinder(0.008, (0, 0, 0.02), (0, 0, 0.8 * height)),
        b.cylinder(0.016, (0, 0, 0), (0, 0, 0.04)),
        material="metal",
        color="black",
    )
    b.slide("tube", parent="shaft", axis=-Z, upper=0.25 * height, lower=-0.1 * height)


@kind(
    "pill box",
    words="pill organizer, weekly pill box",
    number=whole(4, 8, words="lid, compartment"),
)
def pill_box(b: ObjectBuilder, number: int) -> None:
    w = 0.03 * number / 2
    b.part("box", box((-w, -0.02, 0), (w, 0.02, 0.022)), color="blue")
    for k, x in enumerate(spread(number, -w, w)):
        b.cut("box", box((x - 0.0135, -0.0185, 0.002), (x + 0.0135, 0.0185, 1)))
        b.part(f"lid_{k}", box((x - 0.0145, -0.022, 0.0225), (x + 0.0145, 0.02, 0.025)), color="white")
        b.hinge(f"lid_{k}", parent="box", axis=-X, pivot=(x, 0.02, 0.0225), upper=1.9)


@kind(
    "hemostat",
    words="surgical clamp, artery forceps, needle holder",
    size=length(0.8, 1.3),
)
def hemostat(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "arm",
        beam(0.008 * size, 0.004 * size, p(-0.004, 0.05, 0.002), p(0.02, -0.07, 0.002)),
        beam(0.008 * size, 0.004 * size, p(-0.004, 0.05, 0.002), p(-0.003, 0.09, 0.002)),
        b.torus(0.014 * size, 0.003 * size, p(0.03, -0.08, 0.003), Z),
        b.cylinder(0.0035 * size, p(0, 0.03, 0), p(0, 0.03, 0.0085)),
        material="steel",
    )
    b.part(
        "other_arm",
        beam(0.008 * size, 0.004 * size, p(0.004, 0.05, 0.0065), p(-0.02, -0.07, 0.0065)),
        beam(0.008 * size, 0.004 * size, p(0.004, 0.05, 0.0065), p(0.003, 0.09, 0.0065)),
        b.torus(0.014 * size, 0.003 * size, p(-0.03, -0.08, 0.0075), Z),
        b.cylinder(0.006 * size, p(0, 0.03, 0.0045), p(0, 0.03, 0.008)),
        material="steel",
    )
    b.cut("other_arm", b.cylinder(0.0042 * size, p(0, 0.03, -1), p(0, 0.03, 1)))
    b.hinge("other_arm", parent="arm", axis=Z, pivot=p(0, 0.03, 0), upper=0.25, lower=-0.02)


@kind(
    "ct scanner",
    walls=50,
    words="mri scanner, mri machine, tomograph, x ray scanner",
    size=length(0.9, 1.1),
)
def ct_scanner(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "gantry",
        box(p(-1, -0.4, 0), p(1, 0.4, 1.9)),
        box(p(-0.3, -2.4, 0), p(0.3, -0.5, 0.7)),
        box(p(-0.35, -0.5, 0), p(0.35, -0.39, 0.3)),
        color="white",
    )
    b.cut(
        "gantry",
        b.cylinder(0.38 * size, p(0, -1, 1.05), p(0, 1, 1.05)),
        box(p(-0.97, -0.37, 0.03), p(-0.45, 0.37, 1.85)),
        box(p(0.45, -0.37, 0.03), p(0.97, 0.37, 1.85)),
        box(p(-0.27, -2.35, 0.03), p(0.27, -0.52, 0.65)),
    )
    b.part(
        "table",
        box(p(-0.22, -2.4, 0.79), p(0.22, -0.45, 0.84)),
        box(p(-0.2, -2.4, 0.702), p(0.2, -0.6, 0.8)),
        color="light blue",
    )
    b.slide("table", parent="gantry", axis=Y, upper=0.15)


@kind(
    "c arm",
    walls=45,
    words="x ray machine, x-ray machine, mobile x ray",
    size=length(0.9, 1.1),
)
def c_arm(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "base",
        box(p(0.5, -0.3, 0.12), p(1.1, 0.3, 0.7)),
        box(p(-0.2, -0.06, 0.12), p(0.5, 0.06, 0.18)),
        box(p(0.6, -0.1, 0.69), p(0.8, 0.1, 1.2)),
        color="white",
    )
    b.cut("base", box(p(0.53, -0.27, 0.15), p(1.07, 0.27, 0.66)))
    b.bore("base", box(p(0.3, -0.055, 1.045), p(0.9, 0.055, 1.155)))
    b.part("slide_arm", box(p(0.45, -0.05, 1.05), p(0.78, 0.05, 1.15)), material="steel")
    b.slide("slide_arm", parent="base", axis=-X, upper=0.12)
    b.part(
        "arc",
        [
            beam(
                0.08 * size,
                0.06 * size,
                p(-0.15 + 0.55 * cos(a), 0, 1.1 + 0.55 * sin(a)),
                p(-0.15 + 0.55 * cos(a + 0.45), 0, 1.1 + 0.55 * sin(a + 0.45)),
                Y,
            )
            for a in [-1.575 + 0.45 * k for k in range(7)]
        ],
        b.cylinder(0.12 * size, p(-0.15, 0, 0.55), p(-0.15, 0, 0.75)),
        b.cylinder(0.1 * size, p(-0.15, 0, 1.5), p(-0.15, 0, 1.65)),
        material="metal",
        color="white",
    )
    b.hinge("arc", parent="slide_arm", axis=-X, pivot=p(0.45, 0, 1.1), upper=1.2, lower=-1.2)
    for k, (x, y) in enumerate(((-0.15, 0), (1.05, -0.25), (1.05, 0.25))):
        caster(b, f"caster_{k}", parent="base", top=p(x, y, 0.12), high=0.12 * size)


@kind(
    "infant incubator",
    words="baby incubator, neonatal incubator",
    width=length(0.6, 1.0),
)
def infant_incubator(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "base",
        box((-w, -0.25, 0), (w, 0.25, 0.7)),
        box((-w, 0.24, 0.69), (w, 0.25, 1.1)),
        [box((s * w, -0.25, 0.69), (s * (w - 0.008), 0.25, 1.1)) for s in (-1, 1)],
        color="white",
    )
    b.cut("base", box((-w + 0.02, -0.23, 0.02), (w - 0.02, 0.23, 0.66)))
    leaf(
        b,
        "door",
        parent="base",
        lower=(-w, -0.258, 0.7),
        upper=(w, -0.251, 1.1),
        hinge=-Z,
        out=-Y,
        reach=1.5,
        handle=False,
        material="glass",
    )
    leaf(
        b,
        "hood",
        parent="base",
        lower=(-w, -0.25, 1.1),
        upper=(w, 0.25, 1.11),
        hinge=Y,
        out=Z,
        reach=1.4,
        handle=False,
        material="glass",
    )


@kind(
    "prosthetic leg",
    words="knee prosthesis, leg prosthesis, artificial leg",
    size=length(0.9, 1.1),
)
def prosthetic_leg(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "socket",
        b.cone(0.06 * size, 0.09 * size, p(0, 0, 0.55), p(0, 0, 0.85)),
        box(p(-0.035, -0.035, 0.53), p(0.035, 0.035, 0.56)),
        [box(p(s * 0.028, -0.02, 0.46), p(s * 0.036, 0.02, 0.56)) for s in (-1, 1)],
        color="black",
    )
    b.cut("socket", b.cone(0.055 * size, 0.085 * size, p(0, 0, 0.57), p(0, 0, 0.8501)))
    b.part(
        "shin",
        box(p(-0.026, -0.018, 0.47), p(0.026, 0.018, 0.505)),
        b.cylinder(0.016 * size, p(0, 0, 0.12), p(0, 0, 0.48)),
        [box(p(s * 0.018, -0.015, 0.08), p(s * 0.025, 0.015, 0.125)) for s in (-1, 1)],
        box(p(-0.025, -0.015, 0.112), p(0.025, 0.015, 0.13)),
        material="metal",
    )
    b.hinge("shin", parent="socket", axis=X, pivot=p(0, 0, 0.487), upper=0.5, lower=0)
    b.part(
        "foot",
        box(p(-0.016, -0.012, 0.055), p(0.016, 0.012, 0.105)),
        box(p(-0.035, -0.17, 0.02), p(0.035, 0.06, 0.06)),
        material="rubber",
        color="brown",
    )
    b.hinge("foot", parent="shin", axis=X, pivot=p(0, 0, 0.095), upper=0.2, lower=-0.2)
