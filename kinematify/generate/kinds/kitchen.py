"""Things of a kitchen."""

from __future__ import annotations

from math import cos, pi, sin

from kinematify.generate.library.kind import kind, whole, yes
from kinematify.generate.library.mechanisms import button, case, knob
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, slab


@kind(words="stovetop espresso maker, espresso pot", radius=(0.035, 0.055), height=(0.13, 0.2))
def moka_pot(b: ObjectBuilder, radius: float, height: float) -> None:
    h = height / 2
    b.part(
        "pot",
        b.cone(radius, 0.75 * radius, 0, h),
        b.cone(0.75 * radius, radius, h, height),
        beam(0.015, 0.012, (0, 0.9 * radius, 0.92 * height), (0, 2 * radius, 0.9 * height)),
        beam(0.015, 0.012, (0, 2 * radius, 0.92 * height), (0, 2.1 * radius, 0.55 * height), Y),
        look="metal",
    )
    b.cut("pot", b.cone(0.65 * radius, 0.92 * radius, h + 0.005, height + 0.001))
    b.part(
        "lid",
        b.cone(radius, 0.2 * radius, height + 0.001, height + 0.02),
        ball(0.01, (0, 0, height + 0.026)),
        look="metal",
    )
    b.hinge("lid", "pot", -X, (0, radius, height + 0.001), 1.7)


@kind(words="multi cooker", radius=(0.11, 0.15), height=(0.18, 0.26))
def rice_cooker(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part("body", b.cylinder(radius, 0.01, height), look="white")
    b.cut("body", b.cylinder(0.86 * radius, 0.04, height + 0.01))
    b.part("body", slab(0.04, (radius - 0.005, radius + 0.02), (height - 0.06, height)))
    b.part(
        "lid",
        b.cylinder(radius, height + 0.001, height + 0.04),
        b.cone(0.9 * radius, 0.5 * radius, height + 0.04, height + 0.06),
        look="grey",
    )
    b.hinge("lid", "body", -X, (0, radius + 0.02, height + 0.001), 1.5)
    button(b, "button", "body", (0, -radius, 0.4 * height), (0.03, 0.02), 0.008, -Y)


@kind(words="canner", radius=(0.1, 0.14), height=(0.15, 0.24))
def pressure_cooker(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part("pot", b.cylinder(radius, 0, height), look="steel")
    b.cut("pot", b.cylinder(0.97 * radius, 0.006, height + 1))
    b.part(
        "pot", beam(0.03, 0.02, (-radius + 0.002, 0, 0.85 * height), (-radius - 0.15, 0, 0.9 * height)), look="black"
    )
    b.part(
        "lid",
        b.cone(1.02 * radius, 0.85 * radius, height + 0.001, height + 0.03),
        beam(0.03, 0.02, (-0.5 * radius, 0, height + 0.04), (-radius - 0.14, 0, height + 0.05)),
        b.cylinder(0.008, height + 0.02, height + 0.06),
        look="steel",
    )
    b.slide("lid", "pot", Z, 0.12)
    b.part("weight", b.cylinder(0.018, height + 0.035, height + 0.08), look="brass")
    b.cut("weight", b.cylinder(0.0095, height + 0.02, height + 0.061))
    b.slide("weight", "lid", Z, 0.03)


@kind(walls=6, words="hot air fryer", width=(0.24, 0.32), height=(0.28, 0.36))
def air_fryer(b: ObjectBuilder, width: float, height: float) -> None:
    b.part("body", slab(width / 2, width / 2, (0, height)), look="black")
    b.cut(
        "body",
        slab(0.42 * width, (-width, 0.4 * width), (0.04, 0.55 * height)),
        slab(0.42 * width, (-0.4 * width, 0.42 * width), (0.6 * height, 0.95 * height)),
    )
    b.part(
        "basket",
        slab(0.41 * width, (-width / 2 - 0.02, 0.38 * width), (0.043, 0.53 * height)),
        slab(0.02, (-width / 2 - 0.12, -width / 2), (0.3 * height, 0.38 * height)),
        look="grey",
    )
    b.cut("basket", slab(0.38 * width, (-0.45 * width, 0.35 * width), (0.055, height)))
    b.slide("basket", "body", -Y, 0.25)
    knob(b, "timer", "body", (-0.2 * width, -width / 2, 0.78 * height), 0.025, -Y, high=0.02, reach=4.7)
    knob(b, "thermostat", "body", (0.2 * width, -width / 2, 0.78 * height), 0.025, -Y, high=0.02, reach=4.7)


@kind(words="centrifugal juicer, juice extractor", radius=(0.08, 0.11), height=(0.2, 0.28))
def juicer(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part(
        "body",
        b.cylinder(radius, 0, height),
        slab(0.02, (-radius - 0.05, -radius + 0.01), (0.75 * height, 0.82 * height)),
        look="grey",
    )
    b.part(
        "lid",
        b.cylinder(1.05 * radius, height + 0.001, height + 0.05),
        b.tube(0.04, 0.035, height + 0.04, height + 0.16),
        look="black",
    )
    b.cut("lid", b.cylinder(0.035, height + 0.03, height + 0.2))
    b.slide("lid", "body", Z, 0.1)
    b.part(
        "pusher",
        b.cylinder(0.032, height + 0.06, height + 0.2),
        b.cylinder(0.045, height + 0.185, height + 0.2),
        look="white",
    )
    b.slide("pusher", "lid", Z, 0.13)
    knob(b, "switch", "body", (radius, 0, 0.3 * height), 0.02, X, high=0.015, reach=2.0)


@kind(words="drum grater", size=(0.9, 1.3))
def rotary_grater(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.tube(0.03, 0.026, 0, (-0.03, 0.04), 0.1),
        p.slab(0.015, (0.02, 0.04), (0.127, 0.26)),
        p.slab(0.02, 0.02, (0.128, 0.15)),
        look="white",
    )
    b.part(
        "drum",
        p.cylinder(0.024, 0, (-0.04, 0.03), 0.1),
        p.cylinder(0.008, 0, (-0.08, -0.03), 0.1),
        p.beam(0.014, 0.008, (0, -0.075, 0.1), (0.08, -0.075, 0.1), Y),
        p.cylinder(0.008, 0.075, (-0.12, -0.07), 0.1),
        look="steel",
    )
    b.spin("drum", "body", -Y, p(0, 0, 0.1))


@kind(words="apple corer, crank peeler", size=(0.9, 1.2))
def apple_peeler(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("base", p.slab(0.16, 0.04, (0, 0.015)), p.slab((0.05, 0.08), 0.02, (0.01, 0.1)), look="red steel")
    b.bore("base", p.cylinder(0.0085, (0.04, 0.1), 0, 0.08))
    b.part(
        "shaft",
        p.cylinder(0.0075, (-0.06, 0.15), 0, 0.08),
        p.beam(0.012, 0.01, (0.145, 0, 0.08), (0.145, 0, 0.15), X),
        p.cylinder(0.01, (0.14, 0.2), 0, 0.145),
        look="steel",
    )
    b.spin("shaft", "base", X, p(0, 0, 0.08))
    b.part(
        "arm",
        p.cylinder(0.01, -0.1, 0.02, (0.016, 0.03)),
        p.beam(0.01, 0.012, (-0.1, 0.02, 0.03), (-0.1, 0.02, 0.13), X),
        p.beam(0.008, 0.02, (-0.1, 0.02, 0.125), (-0.06, 0.05, 0.125)),
        look="steel",
    )
    b.hinge("arm", "base", Z, p(-0.1, 0.02, 0.02), 0.8, 0)


@kind(words="coffee pot", radius=(0.06, 0.1))
def teapot(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    b.part(
        "pot",
        p.lathe([(0, 0), (0.6, 0), (1, 0.6), (0.9, 1.1), (0.5, 1.45), (0, 1.45)], (0, 0, 0)),
        p.cone(0.28, 0.12, (0, -0.8, 0.6), (0, -1.7, 1.4)),
        p.torus(0.45, 0.08, (0, 1.15, 0.8), X),
        look="white ceramic",
    )
    b.cut("pot", p.lathe([(0, 0.08), (0.55, 0.08), (0.9, 0.6), (0.8, 1.05), (0.4, 1.4), (0.4, 2), (0, 2)], (0, 0, 0)))
    b.part(
        "lid", b.cone(0.48 * r, 0.15 * r, 1.45 * r + 0.001, 1.65 * r), p.ball(0.1, (0, 0, 1.72)), look="white ceramic"
    )
    b.slide("lid", "pot", Z, r)


@kind(width=(0.16, 0.3), depth=(0.1, 0.2))
def butter_dish(b: ObjectBuilder, width: float, depth: float) -> None:
    b.part("dish", slab(width / 2, depth / 2, (0, 0.012)), look="white ceramic")
    b.part("cover", slab(0.44 * width, 0.42 * depth, (0.013, 0.08)), slab(0.02, 0.01, (0.075, 0.1)), look="glass")
    b.cut("cover", slab(0.42 * width, 0.4 * depth, (0, 0.075)))
    b.slide("cover", "dish", Z, 0.1)


@kind(
    walls=5,
    words="thermo mug, insulated mug, beer stein, tankard, coffee mug with lid",
    radius=(0.035, 0.05),
    height=(0.13, 0.2),
)
def travel_mug(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part(
        "mug",
        b.cylinder(radius, 0, height),
        b.torus(0.2 * height, 0.007, (0, radius + 0.012, 0.5 * height), X),
        look="steel",
    )
    b.cut("mug", b.cylinder(0.92 * radius, 0.006, height + 1))
    b.part(
        "lid",
        b.cylinder(radius, height + 0.001, height + 0.01),
        slab(0.01, (radius - 0.005, radius + 0.012), (height + 0.001, height + 0.012)),
        look="black",
    )
    b.hinge("lid", "mug", -X, (0, radius + 0.008, height + 0.001), 1.9)


@kind(words="egg cutter", size=(0.9, 1.2))
def egg_slicer(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("base", p.slab(0.045, 0.06, (0, 0.02)), p.slab(0.045, (0.06, 0.075), (0, 0.024)), look="white")
    b.cut("base", p.cylinder(0.028, 0.008, 0.03))
    b.part("frame", p.slab(0.045, (-0.06, 0.075), (0.025, 0.031)), look="steel")
    b.cut("frame", p.slab(0.037, 0.05, (0, 0.1)))
    for x in spread(7, -0.037 * size, 0.037 * size):
        b.part("frame", b.cylinder(0.0008, x, (-0.055 * size, 0.055 * size), 0.028 * size))
    b.hinge("frame", "base", -X, p(0, 0.075, 0.025), 1.6)


@kind(words="spice carousel, revolving spice rack", number=whole(3, 9, usual=(4, 8), words="jar"))
def spice_rack(b: ObjectBuilder, number: int) -> None:
    b.part("base", b.cylinder(0.08, 0, 0.02), b.cylinder(0.008, 0.01, 0.3), look="wood")
    b.part("rack", [b.cylinder(0.1, z, z + 0.012) for z in (0.03, 0.16)], b.tube(0.014, 0.01, 0.03, 0.28), look="wood")
    b.cut("rack", b.cylinder(0.0095, 0, 1))
    for a in [2 * pi * k / number for k in range(number)]:
        x, y = 0.07 * cos(a), 0.07 * sin(a)
        jars = [b.cylinder(0.022, x, y, (z + 0.01, z + 0.1)) for z in (0.03, 0.16)]
        b.part("rack", b.painted(*jars, look="green glass"))
    b.spin("rack", "base", Z, (0, 0, 0))


@kind(words="wind up timer, cooking timer, timer", radius=(0.03, 0.05))
def kitchen_timer(b: ObjectBuilder, radius: float) -> None:
    p = b.sized(radius)
    b.part("base", p.cone(1, 0.9, 0, 0.4), look="white")
    b.part("dial", p.cone(0.9, 0.5, 0.42, 1.1), p.slab(0.08, (-0.85, 0), (0.42, 1.15)), look="red")
    b.hinge("dial", "base", Z, (0, 0, 0), 5.5)


@kind(words="cooker hood, extractor hood, kitchen hood, extractor fan", width=(0.6, 0.9), depth=(0.3, 0.5))
def range_hood(b: ObjectBuilder, width: float, depth: float) -> None:
    b.part("hood", slab(width / 2, depth / 2, (0, 0.08)), slab(0.15, (0, depth / 2), (0.07, 0.6)), look="steel")
    b.cut(
        "hood",
        slab(0.48 * width, (-0.6 * depth, 0.4 * depth), (0.015, 0.04)),
        slab(0.14, (0.01, depth / 2 - 0.01), (0.1, 0.7)),
    )
    b.part(
        "visor",
        slab(0.475 * width, (-depth / 2 - 0.015, 0.38 * depth), (0.017, 0.037)),
        slab(width / 2, (-depth / 2 - 0.015, -depth / 2 - 0.002), (0.001, 0.05)),
        look="steel",
    )
    b.slide("visor", "hood", -Y, 0.6 * depth)
    for k, x in enumerate(spread(3, 0.1, 0.4 * width)):
        button(b, f"button_{k}", "hood", (x, -depth / 2, 0.065), (0.02, 0.012), 0.005, -Y)


@kind(words="popcorn cart, popcorn maker", width=(0.4, 0.6))
def popcorn_machine(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "case",
        slab(w, w, (0, 0.1)),
        slab(w, w, (0.75, 0.85)),
        [
            box((x - 0.012, y - 0.012, 0.1), (x + 0.012, y + 0.012, 0.75))
            for x in (-w + 0.012, w - 0.012)
            for y in (-w + 0.012, w - 0.012)
        ],
        slab(w, (w - 0.005, w), (0.1, 0.75)),
        [slab((x * 0.14 - 0.01, x * 0.14 + 0.01), 0.01, (0.55, 0.76)) for x in (-1, 1)],
        look="red steel",
    )
    leaf(b, "door", "case", (-w, -w - 0.008, 0.1), (w, -w, 0.75), hinge=-X, reach=1.8, material="glass")
    b.part(
        "kettle",
        b.cylinder(0.1, 0.45, 0.6),
        [b.cylinder(0.006, (x * 0.095, x * 0.128), 0, 0.57) for x in (-1, 1)],
        look="steel",
    )
    b.cut("kettle", b.cylinder(0.094, 0.46, 1))
    b.hinge("kettle", "case", X, (0, 0, 0.57), 1.2)


@kind(walls=5, words="chip pan, fryer", width=(0.2, 0.3), depth=(0.25, 0.35))
def deep_fryer(b: ObjectBuilder, width: float, depth: float) -> None:
    b.part("body", slab(width / 2, depth / 2, (0, 0.2)), look="steel")
    b.cut("body", slab(0.44 * width, 0.44 * depth, (0.05, 1)))
    b.part(
        "basket",
        slab(0.4 * width, 0.4 * depth, (0.08, 0.19)),
        beam(0.02, 0.012, (0, -0.4 * depth, 0.205), (0, -depth / 2 - 0.14, 0.24)),
        beam(0.02, 0.02, (0, -0.385 * depth, 0.17), (0, -0.385 * depth, 0.215), Y),
        look="steel",
    )
    b.cut("basket", slab(0.385 * width, (-0.36 * depth, 0.385 * depth), (0.085, 1)))
    b.slide("basket", "body", Z, 0.2)
    knob(b, "thermostat", "body", (0.25 * width, -depth / 2, 0.08), 0.018, -Y, high=0.018, reach=4.0)


@kind(words="measuring jug with lid, milk jug with lid, water pitcher", radius=(0.05, 0.07), height=(0.2, 0.27))
def water_filter_jug(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part(
        "jug",
        b.cone(0.85 * radius, radius, 0, height),
        beam(0.02, 0.014, (0, 0.9 * radius, 0.9 * height), (0, 1.9 * radius, 0.86 * height)),
        beam(0.02, 0.014, (0, 1.9 * radius, 0.9 * height), (0, 1.8 * radius, 0.3 * height), Y),
        beam(0.02, 0.014, (0, 1.85 * radius, 0.32 * height), (0, 0.8 * radius, 0.3 * height)),
        look="glass",
    )
    b.cut("jug", b.cone(0.8 * radius, 0.96 * radius, 0.006, height + 0.001))
    b.part("lid", b.cylinder(radius, height + 0.001, height + 0.012), look="blue")
    b.hinge("lid", "jug", -X, (0, radius, height + 0.001), 1.4)


@kind(
    words="draft tower, beer dispenser, wine tap",
    height=(0.3, 0.45),
    number=whole(1, 8, default=2, usual=(1, 4), words="handle, tap, lever"),
)
def beer_tap(b: ObjectBuilder, height: float, number: int) -> None:
    width = 0.1 * number
    b.part("tower", slab(width / 2 + 0.02, 0.05, (0, 0.03)), slab(width / 2, 0.035, (0.02, height)), look="chrome")
    for k, x in enumerate(spread(number, -width / 2, width / 2)):
        b.part(
            "tower",
            b.cylinder(0.012, x, (-0.03, -0.1), 0.8 * height),
            b.cylinder(0.008, (x, -0.09, 0.8 * height), (x, -0.1, 0.62 * height)),
        )
        b.part(
            f"handle_{k}",
            beam(0.012, 0.012, (x, -0.085, 0.8 * height + 0.022), (x, -0.085, 0.8 * height + 0.075), Y),
            b.rod(0.016, x, -0.085, (0.8 * height + 0.07, 0.8 * height + 0.16)),
            look="black wood",
        )
        b.hinge(f"handle_{k}", "tower", X, (x, -0.085, 0.8 * height + 0.022), 0.6, 0)


@kind(words="shaker, protein shaker", radius=(0.035, 0.05), height=(0.15, 0.22))
def cocktail_shaker(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part("cup", b.cone(0.75 * radius, radius, 0, height), look="steel")
    b.cut("cup", b.cone(0.7 * radius, 0.96 * radius, 0.004, height + 0.001))
    b.part(
        "lid",
        b.cone(radius, 0.5 * radius, height + 0.001, height + 0.04),
        b.cylinder(0.45 * radius, height + 0.03, height + 0.06),
        look="steel",
    )
    b.slide("lid", "cup", Z, 0.08)
    b.part("cap", b.cylinder(0.6 * radius, height + 0.045, height + 0.085), look="steel")
    b.cut(
        "cap",
        b.cylinder(0.48 * radius, height, height + 0.065),
        b.cone(1.02 * radius, 0.52 * radius, height + 0.001, height + 0.041),
    )
    b.slide("cap", "lid", Z, 0.06)


@kind(
    walls=6, words="mini oven, countertop oven, reflow oven", width=(0.35, 0.5), depth=(0.28, 0.36), height=(0.2, 0.28)
)
def toaster_oven(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    w = width / 2
    b.part(
        "body",
        slab(w, depth / 2, (0.015, height)),
        [b.cylinder(0.012, x, y, (0, 0.016)) for x in (-0.8 * w, 0.8 * w) for y in (-0.4 * depth, 0.4 * depth)],
        look="steel",
    )
    b.cut(
        "body",
        box((-w + 0.015, -depth, 0.03), (0.55 * w, 0.45 * depth, height - 0.02)),
        slab((0.6 * w, w - 0.01), 0.45 * depth, (0.03, height - 0.02)),
    )
    b.part(
        "door",
        box((-w + 0.008, -depth / 2 - 0.016, 0.022), (0.57 * w, -depth / 2 - 0.001, height - 0.012)),
        b.cylinder(0.006, (-0.7 * w, 0.3 * w), -depth / 2 - 0.035, height - 0.03),
        [
            box((x, -depth / 2 - 0.035, height - 0.035), (x + 0.01, -depth / 2 - 0.014, height - 0.025))
            for x in (-0.7 * w, 0.26 * w)
        ],
        look="glass",
    )
    b.hinge("door", "body", X, (0, -depth / 2 - 0.016, 0.022), 1.5)
    for k, z in enumerate(spread(3, 0.03, height - 0.02)):
        knob(b, f"knob_{k}", "body", (0.78 * w, -depth / 2, z), 0.016, -Y, high=0.016, reach=4.7)


@kind(words="hob, gas hob, hot plate, stove top, electric hob", number=whole(1, 6, words="knob, burner, dial"))
def cooktop(b: ObjectBuilder, number: int) -> None:
    rows = 1 if number < 3 else 2
    columns = (number + rows - 1) // rows
    width = 0.28 * columns + 0.04
    depth = 0.28 * rows + 0.08
    b.part("plate", slab(width / 2, depth / 2, (0, 0.05)), look="black steel")
    b.cut("plate", slab(width / 2 - 0.005, (-depth / 2 + 0.03, depth / 2 - 0.005), (0.005, 0.045)))
    for k in range(number):
        x = -width / 2 + 0.16 + 0.28 * (k % columns)
        y = -depth / 2 + 0.22 + 0.28 * (k // columns)
        b.part(
            "plate",
            b.cylinder(0.05, x, y, (0.045, 0.065)),
            [box((x - 0.11, y + s - 0.005, 0.045), (x + 0.11, y + s + 0.005, 0.08)) for s in (-0.06, 0.06)],
        )
    for k, x in enumerate(spread(number, -width / 2 + 0.02, width / 2 - 0.02)):
        knob(b, f"knob_{k}", "plate", (x, -depth / 2 + 0, 0.025), 0.018, -Y, high=0.022, reach=4.7)


@kind(words="ice cream freezer, deep freezer", width=(0.6, 1.4), depth=(0.5, 0.7), height=(0.7, 0.9))
def chest_freezer(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    b.part("body", slab(width / 2, depth / 2, (0, height)), look="white")
    b.cut("body", slab(width / 2 - 0.06, depth / 2 - 0.06, (0.1, height + 1)))
    leaf(
        b,
        "lid",
        "body",
        (-width / 2, -depth / 2, height),
        (width / 2, depth / 2, height + 0.06),
        hinge=Y,
        out=Z,
        reach=1.4,
        material="plastic",
    )


@kind(words="kitchen roll holder, paper roll stand", height=(0.24, 0.32))
def paper_towel_holder(b: ObjectBuilder, height: float) -> None:
    b.part(
        "stand",
        b.cylinder(0.075, 0, 0.012),
        b.cylinder(0.009, 0.01, height + 0.04),
        ball(0.014, (0, 0, height + 0.05)),
        look="wood",
    )
    b.part("roll", b.tube(0.06, 0.02, 0.014, height), look="white cardboard")
    b.spin("roll", "stand", Z, (0, 0, 0))


@kind(words="burger press, hamburger press", radius=(0.08, 0.13))
def tortilla_press(b: ObjectBuilder, radius: float) -> None:
    b.part(
        "base",
        b.cylinder(radius, 0.01, 0.025),
        slab(0.035, (0.8 * radius, radius + 0.04), (0.01, 0.024)),
        [box((x * 0.02, radius + 0.003, 0.01), (x * 0.035, radius + 0.04, 0.05)) for x in (-1, 1)],
        [box((x * 0.02, -radius - 0.04, 0.01), (x * 0.035, -radius + 0.01, 0.026)) for x in (-1, 1)],
        [box((x * 0.02, -radius - 0.04, 0.01), (x * 0.035, -radius - 0.005, 0.032)) for x in (-1, 1)],
        look="metal",
    )
    b.part(
        "plate",
        b.cylinder(0.97 * radius, 0.027, 0.042),
        slab(0.018, (0.9 * radius, radius + 0.035), (0.027, 0.042)),
        look="metal",
    )
    b.hinge("plate", "base", -X, (0, radius + 0.035, 0.027), 1.5)
    b.bore("base", b.cylinder(0.0055, (-0.1, 0.1), -radius - 0.025, 0.02))
    b.part(
        "lever",
        beam(0.02, 0.012, (0, -radius - 0.025, 0.022), (0, -radius - 0.025, 0.24), Y),
        b.cylinder(0.004, (-0.033, 0.033), -radius - 0.025, 0.02),
        look="metal",
    )
    b.hinge("lever", "base", -X, (0, -radius - 0.025, 0.02), 0.5, -0.6)


@kind(words="roasting spit, kebab grill, barbecue spit", width=(0.6, 1.2))
def rotisserie(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "frame",
        slab(w, 0.2, (0, 0.08)),
        [beam(0.02, 0.02, (s * w * 0.95, 0, 0.06), (s * w * 0.95, 0, 0.38), X) for s in (-1, 1)],
        look="black steel",
    )
    b.cut("frame", slab(w - 0.02, 0.18, (0.02, 0.2)))
    b.bore("frame", [b.cylinder(0.0075, (s * w * 0.8, s * w * 1.1), 0, 0.34) for s in (-1, 1)])
    b.part(
        "spit",
        b.cylinder(0.006, (-w - 0.03, w + 0.06), 0, 0.34),
        b.rod(0.08, (-0.15, 0.15), 0, 0.34),
        beam(0.012, 0.01, (w + 0.055, 0, 0.34), (w + 0.055, 0, 0.24), X),
        b.cylinder(0.01, (w + 0.05, w + 0.12), 0, 0.25),
        look="steel",
    )
    b.spin("spit", "frame", X, (0, 0, 0.34))


@kind(words="bottle crusher, can press", height=(0.3, 0.45))
def can_crusher(b: ObjectBuilder, height: float) -> None:
    b.part(
        "frame",
        slab(0.05, (0, 0.02), (0, height)),
        slab(0.05, (-0.1, 0.01), (0, 0.02)),
        [box((s * 0.05, -0.03, 0.02), (s * 0.042, 0.001, height - 0.02)) for s in (-1, 1)],
        [box((s * 0.02, -0.04, height - 0.03), (s * 0.032, 0.01, height + 0.03)) for s in (-1, 1)],
        look="red steel",
    )
    b.part(
        "ram",
        slab(0.04, (-0.09, -0.002), (0.6 * height, 0.6 * height + 0.02)),
        slab(0.035, (-0.03, -0.002), (0.6 * height, 0.6 * height + 0.06)),
        look="steel",
    )
    b.slide("ram", "frame", -Z, 0.5 * height)
    b.part("lever", beam(0.03, 0.015, (0, -0.025, height + 0.015), (0, -0.33, height + 0.12)), look="steel")
    b.hinge("lever", "frame", X, (0, -0.025, height + 0.015), 0.35, -0.9)


@kind(words="tea box, sewing box with tray", width=(0.2, 0.35), depth=(0.15, 0.25))
def cutlery_box(b: ObjectBuilder, width: float, depth: float) -> None:
    case(b, "box", (-width / 2, -depth / 2, 0), (width / 2, depth / 2, 0.12), opening=Z, wall=0.008)
    b.part("tray", slab(width / 2 - 0.011, depth / 2 - 0.011, (0.07, 0.115)), look="wood")
    b.cut(
        "tray",
        [
            slab((x - width / 6 + 0.012, x + width / 6 - 0.012), depth / 2 - 0.018, (0.076, 0.2))
            for x in spread(3, -width / 2 + 0.011, width / 2 - 0.011)
        ],
    )
    leaf(
        b,
        "lid",
        "box",
        (-width / 2, -depth / 2, 0.12),
        (width / 2, depth / 2, 0.13),
        hinge=Y,
        out=Z,
        reach=1.7,
        handle=False,
    )
    b.slide("tray", "box", Z, 0.004)


@kind(
    walls=9, words="shower cubicle, shower stall, shower enclosure, corner shower", width=(0.8, 1.1), height=(1.9, 2.1)
)
def shower_cabin(b: ObjectBuilder, width: float, height: float) -> None:
    w = width / 2
    b.part(
        "cabin",
        slab(w, w, (0, 0.1)),
        slab(w, (w - 0.02, w), (0.1, height)),
        slab((w - 0.02, w), w, (0.1, height)),
        [slab(w, (-w, -w + 0.05), (z, z + 0.03)) for z in (0.1, height - 0.03)],
        slab((-w, -w + 0.03), w, (0.1, height)),
        b.cylinder(0.012, 0, (w - 0.05, w - 0.01), height - 0.1),
        b.cone(0.08, 0.02, (0, w - 0.12, height - 0.16), (0, w - 0.06, height - 0.09)),
        look="white",
    )
    b.part("cabin", box((0, -w + 0.005, 0.12), (w - 0.02, -w + 0.013, height - 0.02)))
    b.part(
        "door",
        box((-w + 0.04, -w + 0.018, 0.135), (0.02, -w + 0.026, height - 0.035)),
        box((-0.02, -w + 0.0275, 0.9), (0, -w + 0.05, 1.2)),
        box((-0.02, -w + 0.02, 0.95), (0, -w + 0.03, 1.15)),
        look="glass",
    )
    b.slide("door", "cabin", X, 0.85 * w - 0.05)
    knob(b, "tap", "cabin", (0, w - 0.02, 1.1), 0.03, -Y, high=0.04, reach=3.0, material="chrome")


@kind(
    "walk in bathtub",
    usual={"bathtub, bath tub, bath, tub": {"door": "no"}},
    length=(1.3, 1.7),
    width=(0.65, 0.8),
    height=(0.5, 0.6),
    door=yes(1, drawn=False),
)
def walk_in_bathtub(b: ObjectBuilder, length: float, width: float, height: float, door: bool) -> None:
    b.part("tub", box((0, 0, 0), (length, width, height)), look="white ceramic")
    b.cut("tub", box((0.06, 0.06, 0.12), (length - 0.06, width - 0.06, 1)))
    if door:
        b.cut("tub", slab((0.2, 0.7), 0.1, (0.15, 1)))
        face = (0.203, 0.0, 0.155), (0.697, 0.05, height)
        leaf(b, "door", "tub", *face, hinge=-X, material="plastic")
    b.part(
        "tub",
        b.cylinder(0.02, length - 0.03, width / 2, (height, height + 0.12)),
        b.cylinder(0.014, (length - 0.03, width / 2, height + 0.11), (length - 0.18, width / 2, height + 0.09)),
    )
    for k, s in enumerate((-1, 1)):
        knob(
            b, f"tap_{k}", "tub", (length - 0.03, width / 2 + s * 0.12, height), 0.022, Z, high=0.05, material="chrome"
        )


@kind(words="sink, kitchen sink, bathroom sink, hand basin", width=(0.45, 0.8), depth=(0.38, 0.5))
def washbasin(b: ObjectBuilder, width: float, depth: float) -> None:
    b.part("basin", slab(width / 2, depth / 2, (0.75, 0.9)), b.cylinder(0.08, 0, 0.05, (0, 0.76)), look="white ceramic")
    b.cut("basin", slab(0.42 * width, (-0.42 * depth, 0.25 * depth), (0.78, 1)))
    b.part(
        "plug", b.cylinder(0.022, 0, -0.05, (0.782, 0.79)), b.cylinder(0.004, 0, -0.05, (0.788, 0.81)), look="chrome"
    )
    b.slide("plug", "basin", Z, 0.05)
    b.part(
        "spout",
        b.cylinder(0.02, 0, 0.38 * depth, (0.902, 1.02)),
        b.cylinder(0.012, (0, 0.38 * depth, 1), (0, 0 * depth, 1.02)),
        b.cylinder(0.01, 0, 0.01, (1.025, 0.99)),
        look="chrome",
    )
    b.hinge("spout", "basin", Z, (0, 0.38 * depth, 0.9), 1.0, -1.0)
    b.part(
        "lever",
        b.cylinder(0.018, 0, 0.38 * depth, (1.022, 1.04)),
        beam(0.012, 0.008, (0, 0.38 * depth, 1.035), (0, 0.38 * depth - 0.1, 1.06)),
        look="chrome",
    )
    b.hinge("lever", "spout", Z, (0, 0.38 * depth, 1.02), 0.7, -0.7)


@kind(height=(0.38, 0.42))
def bidet(b: ObjectBuilder, height: float) -> None:
    b.part("bowl", b.cone(0.12, 0.18, 0, height), slab(0.18, (0, 0.32), (height - 0.14, height)), look="white ceramic")
    b.cut("bowl", b.cone(0.06, 0.15, 0, -0.02, (height - 0.15, height + 0.001)))
    b.part(
        "bowl",
        b.cylinder(0.018, 0, 0.24, (height, height + 0.08)),
        b.cylinder(0.01, (0, 0.24, height + 0.07), (0, 0.1, height + 0.05)),
    )
    b.part(
        "lever",
        b.cylinder(0.017, 0, 0.24, (height + 0.081, height + 0.1)),
        beam(0.012, 0.008, (0, 0.24, height + 0.095), (0, 0.33, height + 0.12)),
        look="chrome",
    )
    b.hinge("lever", "bowl", Z, (0, 0.24, height + 0.08), 0.8, -0.8)


@kind(walls=5, words="laundry hamper, linen bin, laundry bin", width=(0.35, 0.5), height=(0.5, 0.7))
def laundry_basket(b: ObjectBuilder, width: float, height: float) -> None:
    b.part("basket", slab(width / 2, 0.17, (0, height)), look="beige wood")
    b.cut(
        "basket",
        slab(width / 2 - 0.01, 0.16, (0.012, height + 1)),
        [slab(0.4 * width, 0.3, (z - 0.012, z + 0.012)) for z in spread(6, 0.05, height - 0.05)],
    )
    leaf(
        b, "lid", "basket", (-width / 2, -0.17, height), (width / 2, 0.17, height + 0.014), hinge=Y, out=Z, handle=False
    )


@kind(walls=5, words="toilet brush set, brush holder", height=(0.35, 0.45))
def toilet_brush(b: ObjectBuilder, height: float) -> None:
    b.part("holder", b.cylinder(0.05, 0, 0.14), look="steel")
    b.cut("holder", b.cylinder(0.046, 0.006, 1))
    b.part(
        "brush",
        b.rod(0.034, 0.045, 0.1),
        b.cylinder(0.006, 0.09, height),
        b.rod(0.011, height - 0.08, height),
        look="white",
    )
    b.slide("brush", "holder", Z, 0.2)


@kind(walls=2.5, words="toilet roll holder, paper roll holder", size=(0.9, 1.2))
def toilet_paper_holder(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "mount",
        p.slab(0.07, (0, 0.01), (0, 0.1)),
        [p.box((s * 0.058, -0.07, 0.02), (s * 0.066, 0.005, 0.05)) for s in (-1, 1)],
        p.cylinder(0.008, (-0.06, 0.06), -0.06, 0.035),
        look="chrome",
    )
    b.part("roll", p.tube(0.05, 0.0095, (-0.05, 0.05), -0.06, 0.035), look="white cardboard")
    b.spin("roll", "mount", X, p(0, -0.06, 0.035))
    b.part("cover", p.slab(0.062, (-0.13, -0.002), (0.094, 0.098)), look="chrome")
    b.hinge("cover", "mount", -X, p(0, -0.002, 0.098), 1.4)


@kind(words="towel dispenser, tissue dispenser", width=(0.25, 0.35), height=(0.3, 0.42))
def paper_towel_dispenser(b: ObjectBuilder, width: float, height: float) -> None:
    b.part(
        "back",
        slab(width / 2, (0, 0.015), (0, height)),
        [box((s * width / 2, -0.19, 0), (s * (width / 2 - 0.006), 0.01, height)) for s in (-1, 1)],
        look="white",
    )
    b.part(
        "cover",
        slab(width / 2 - 0.008, (-0.2, -0.193), (0, height)),
        slab(width / 2 - 0.008, (-0.2, -0.002), (height - 0.006, height)),
        look="grey",
    )
    b.hinge("cover", "back", X, (0, -0.2, 0), 1.3)


@kind(words="toothbrush", size=(0.9, 1.1))
def electric_toothbrush(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("handle", p.rod(0.014, 0.016, 0.12), p.cone(0.012, 0.004, 0.12, 0.2), look="white")
    b.part("head", p.cylinder(0.007, 0, (-0.0065, -0.016), 0.195), look="blue")
    b.hinge("head", "handle", -Y, p(0, 0, 0.195), 0.6, -0.6)
    b.bore("handle", p.slab(0.006, (-0.03, -0.008), (0.08, 0.1)))
    b.part("button", p.slab(0.0055, (-0.017, -0.011), (0.0805, 0.0995)), look="grey rubber")
    b.slide("button", "handle", Y, 0.002)


@kind(words="flat iron", length=(0.22, 0.3))
def hair_straightener(b: ObjectBuilder, length: float) -> None:
    b.part(
        "arm",
        slab((0, length), 0.016, (0, 0.014)),
        box((-0.02, -0.016, 0), (0.01, -0.011, 0.03)),
        box((-0.02, 0.011, 0), (0.01, 0.016, 0.03)),
        look="black",
    )
    b.part(
        "other_arm",
        slab((0.012, length), 0.016, (0.017, 0.031)),
        slab((-0.018, 0.02), 0.009, (0.017, 0.031)),
        look="black",
    )
    b.hinge("other_arm", "arm", -Y, (-0.005, 0, 0.023), 0.35)


@kind(words="wet razor, disposable razor, razor, shaving razor", length=(0.1, 0.14))
def safety_razor(b: ObjectBuilder, length: float) -> None:
    b.part("handle", b.rod(0.006, 0, length), slab(0.004, 0.004, (length, length + 0.012)), look="chrome")
    b.part(
        "head",
        slab(0.02, (-0.012, 0.004), (length + 0.014, length + 0.022)),
        [slab((s * 0.0055, s * 0.008), 0.004, (length + 0.005, length + 0.015)) for s in (-1, 1)],
        look="blue",
    )
    b.hinge("head", "handle", X, (0, 0, length + 0.008), 0.4, -0.4)


@kind(words="support rail, toilet rail, folding support bar", length=(0.6, 0.85))
def folding_grab_bar(b: ObjectBuilder, length: float) -> None:
    b.part(
        "plate",
        slab(0.05, (0, 0.02), (0, 0.25)),
        [box((s * 0.022, -0.06, 0.19), (s * 0.03, 0.01, 0.25)) for s in (-1, 1)],
        look="white steel",
    )
    b.part(
        "bar",
        b.cylinder(0.016, 0, (-0.04, -length), 0.1),
        b.cylinder(0.016, 0, (-0.04, -length), 0.22),
        b.cylinder(0.016, 0, -length, (0.084, 0.236)),
        b.cylinder(0.016, 0, -0.04, (0.09, 0.236)),
        look="white steel",
    )
    b.hinge("bar", "plate", -X, (0, -0.04, 0.22), 1.5)


@kind(words="folding wall seat, tip up seat", width=(0.35, 0.6), depth=(0.3, 0.45))
def shower_seat(b: ObjectBuilder, width: float, depth: float) -> None:
    b.part(
        "mount",
        slab(width / 2, (0, 0.02), (0, 0.16)),
        [box((s * width * 0.4, -0.03, 0.03), (s * width * 0.44, 0.01, 0.09)) for s in (-1, 1)],
        look="steel",
    )
    b.part("seat", slab(0.38 * width, (-depth, -0.012), (0.05, 0.08)), look="white wood")
    b.hinge("seat", "mount", -X, (0, -0.02, 0.065), 1.4)


@kind(words="jet dryer, wall dryer", width=(0.22, 0.32))
def hand_dryer(b: ObjectBuilder, width: float) -> None:
    b.part("body", slab(width / 2, (0, 0.16), (0, width)), look="white metal")
    b.cut("body", slab(0.46 * width, (0.008, 0.152), (0.008, width - 0.008)))
    button(b, "button", "body", (0, 0, 0.7 * width), (0.05, 0.05), 0.008, -Y, is_round=True)
    b.part(
        "nozzle",
        b.cylinder(0.03, 0, 0.08, (-0.001, -0.03)),
        b.cylinder(0.018, (0, 0.09, -0.02), (0, 0.03, -0.05)),
        look="chrome",
    )
    b.spin("nozzle", "body", Z, (0, 0.08, 0))
