"""Things of an office."""

from __future__ import annotations

from math import cos, pi, sin

from kinematify.generate.library.kind import kind, whole
from kinematify.generate.library.mechanisms import bail, button, knob
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, prism, slab, vector


@kind(words="mechanical typewriter", number=whole(3, 12, usual=(5, 9), words="key"))
def typewriter(b: ObjectBuilder, number: int) -> None:
    width = 0.34
    b.part(
        "body",
        prism([(-0.17, 0), (0.17, 0), (0.17, 0.1), (0, 0.1), (-0.17, 0.03)], (0, 0, 0), width, "x"),
        look="dark green metal",
    )
    b.part(
        "carriage",
        slab(0.19, (0.06, 0.14), (0.102, 0.112)),
        b.cylinder(0.022, (-0.16, 0.16), 0.1, 0.132),
        [box((s * 0.17 - 0.01, 0.075, 0.11), (s * 0.17 + 0.01, 0.125, 0.15)) for s in (-1, 1)],
        look="black metal",
    )
    b.slide("carriage", "body", X, 0.1, lower=-0.1)
    for k, x in enumerate(spread(number, -0.15, 0.15)):
        b.part(
            f"key_{k}",
            b.cylinder(0.009, x, -0.11, (0.068, 0.076)),
            b.cylinder(0.003, x, -0.11, (0.03, 0.07)),
            look="black",
        )
        b.bore("body", b.cylinder(0.0045, x, -0.11, (0.01, 0.2)))
        b.slide(f"key_{k}", "body", -Z, 0.006)


@kind(words="till, cash drawer", width=(0.36, 0.46))
def cash_register(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "body",
        slab(w, 0.2, (0, 0.12)),
        prism([(-0.15, 0.12), (0.2, 0.12), (0.2, 0.24), (0.05, 0.24)], (0, 0, 0), 0.8 * width, "x"),
        look="grey",
    )
    b.bore("body", slab(w - 0.02, (-0.21, 0.15), (0.02, 0.1)))
    b.part(
        "drawer",
        slab(w - 0.022, (-0.19, 0.14), (0.022, 0.09)),
        slab(w - 0.005, (-0.21, -0.201), (0.015, 0.105)),
        slab(w - 0.022, (-0.202, -0.18), (0.022, 0.09)),
        look="black metal",
    )
    b.cut(
        "drawer",
        [
            box((x - w / 5 + 0.006, -0.17, 0.03), (x + w / 5 - 0.006, 0.13, 0.2))
            for x in spread(4, -w + 0.025, w - 0.025)
        ],
    )
    b.slide("drawer", "body", -Y, 0.25)
    b.part("display", slab(0.09, (0.08, 0.1), (0.25, 0.35)), b.cylinder(0.008, (-0.03, 0.03), 0.1, 0.253), look="black")
    b.hinge("display", "body", X, (0, 0.1, 0.253), 0.3, -0.3)


@kind(words="telephone, rotary telephone, dial telephone, landline phone, old phone", size=(0.9, 1.1))
def rotary_phone(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.prism([(-0.1, 0), (0.1, 0), (0.08, 0.09), (0.02, 0.1), (-0.1, 0.03)], (0, 0, 0), 0.18, "x"),
        [p.box((s * 0.05 - 0.008, 0.02, 0.09), (s * 0.05 + 0.008, 0.08, 0.115)) for s in (-1, 1)],
        look="black",
    )
    b.cut("body", [p.cylinder(0.0125, (s * 0.03, s * 0.07), 0.05, 0.115) for s in (-1, 1)])
    b.part(
        "handset",
        p.cylinder(0.0115, (-0.13, 0.13), 0.05, 0.117),
        [p.cone(0.026, 0.018, s * 0.125, 0.05, (0.092, 0.125)) for s in (-1, 1)],
        look="black",
    )
    b.slide("handset", "body", Z, 0.1)
    up = vector(0, -0.5, 0.86)
    at = vector(0, -0.045, 0.0625) * size
    b.part(
        "dial",
        b.cylinder(0.035 * size, at + 0.001 * size * up, at + 0.008 * size * up),
        b.cylinder(0.012 * size, at + 0.007 * size * up, at + 0.012 * size * up),
        look="metal",
    )
    b.hinge("dial", "body", up, at, 5.0)


@kind(words="cassette recorder, cassette player, tape recorder", width=(0.4, 0.6))
def boombox(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    h = 0.22
    b.part(
        "case",
        slab(w, 0.06, (0, h)),
        [b.cylinder(0.08, s * 0.66 * w, (-0.066, -0.059), 0.11) for s in (-1, 1)],
        look="grey",
    )
    b.cut("case", slab(0.055, (-0.1, -0.03), (0.025, 0.105)))
    b.part("door", slab(0.053, (-0.066, -0.06), (0.027, 0.103)), look="glass")
    b.hinge("door", "case", X, (0, -0.066, 0.027), 0.7)
    for k, x in enumerate(spread(5, -0.09, 0.09)):
        button(b, f"key_{k}", "case", (x, -0.02, h), (0.02, 0.03), 0.008, Z)
    for k, s in enumerate((-1, 1)):
        knob(b, f"knob_{k}", "case", (s * 0.05, -0.06, 0.17), 0.016, -Y, high=0.014, reach=4.7)
    bail(b, "handle", "case", (-w, 0.03, h - 0.03), (w, 0.03, h - 0.03), 0.09, 0.016, Z, lower=-0.9, upper=0.9)


@kind(walls=5, words="blu ray player, disc player", width=(0.3, 0.43))
def dvd_player(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "case",
        slab(w, 0.14, (0.006, 0.055)),
        [b.cylinder(0.012, x, y, (0, 0.007)) for x in (-0.8 * w, 0.8 * w) for y in (-0.11, 0.11)],
        look="black metal",
    )
    b.cut("case", slab(0.072, (-0.2, 0.06), (0.022, 0.042)), slab((0.1, w - 0.01), 0.13, (0.012, 0.05)))
    b.part(
        "tray", slab(0.07, (-0.143, 0.05), (0.024, 0.034)), slab(0.071, (-0.146, -0.141), (0.023, 0.041)), look="black"
    )
    b.cut("tray", b.cylinder(0.061, 0, -0.065, (0.028, 0.1)))
    b.slide("tray", "case", -Y, 0.13)
    button(b, "power", "case", (-0.85 * w, -0.14, 0.03), (0.016, 0.01), 0.004, -Y)


@kind(words="gamepad, controller", size=(0.9, 1.1))
def game_controller(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.05, 0.03, (0, 0.03)),
        [p.rod(0.022, (s * 0.055, 0.02, 0.003), (s * 0.065, -0.06, -0.005)) for s in (-1, 1)],
        look="black",
    )
    for k, x in enumerate((-0.025, 0.025)):
        b.bore("body", p.cone(0.008, 0.013, x, -0.012, (0.018, 0.0301)))
        b.part(
            f"stick_{k}",
            p.cylinder(0.004, x, -0.012, (0.019, 0.036)),
            p.cylinder(0.009, x, -0.012, (0.035, 0.041)),
            look="grey rubber",
        )
        b.hinge(f"stick_{k}", "body", X, p(x, -0.012, 0.021), 0.3, -0.3)
    for k, (x, y) in enumerate(((0.03, 0.012), (0.042, 0.02), (0.03, 0.026), (0.018, 0.018))):
        button(b, f"button_{k}", "body", p(x, y, 0.03), (0.008 * size, 0.008 * size), 0.004 * size, Z, is_round=True)


@kind(words="flight stick, control stick, arcade stick, fight stick", height=(0.14, 0.22))
def joystick(b: ObjectBuilder, height: float) -> None:
    b.part("base", slab(0.08, 0.08, (0, 0.045)), look="black")
    b.cut("base", slab(0.05, 0.05, (0.01, 1)))
    b.bore("base", b.cylinder(0.0062, (-0.07, 0.07), 0, 0.03))
    b.part(
        "frame",
        [slab(0.03, (s * 0.03, s * 0.036), (0.022, 0.038)) for s in (-1, 1)],
        [slab((s * 0.03, s * 0.036), 0.036, (0.022, 0.038)) for s in (-1, 1)],
        [b.cylinder(0.005, (s * 0.034, s * 0.068), 0, 0.03) for s in (-1, 1)],
        look="metal",
    )
    b.bore("frame", b.cylinder(0.0062, 0, (-0.05, 0.05), 0.03))
    b.hinge("frame", "base", X, (0, 0, 0.03), 0.3, -0.3)
    b.part(
        "stick",
        b.cylinder(0.005, 0, (-0.04, 0.04), 0.03),
        b.cylinder(0.008, 0.028, 0.1),
        b.rod(0.018, 0.1, height),
        look="grey",
    )
    b.hinge("stick", "frame", Y, (0, 0, 0.03), 0.3, -0.3)


@kind(words="mouse, gaming mouse", size=(0.9, 1.1))
def computer_mouse(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.03, (-0.015, 0.06), (0, 0.03)),
        p.slab(0.03, (-0.06, -0.01), (0, 0.02)),
        p.cylinder(0.03, 0, 0.055, (0, 0.03)),
        look="black",
    )
    b.bore("body", p.slab(0.006, (-0.052, -0.024), (0.004, 0.1)))
    for k, (a, b_) in enumerate(((-0.029, -0.0065), (0.0065, 0.029))):
        b.part(f"button_{k}", p.box((a, -0.06, 0.023), (b_, -0.017, 0.028)), look="grey")
        b.hinge(f"button_{k}", "body", X, p(0, -0.017, 0.028), 0.05)
    b.part("wheel", p.cylinder(0.012, (-0.0035, 0.0035), -0.038, 0.019), look="rubber")
    b.spin("wheel", "body", X, p(0, -0.038, 0.019))


@kind(
    words="pc keyboard, keyboard",
    columns=whole(6, 20, default=14, usual=(6, 10)),
    rows=whole(2, 6, default=5, usual=(2, 4)),
)
def computer_keyboard(b: ObjectBuilder, columns: int, rows: int) -> None:
    width = 0.019 * columns + 0.02
    depth = 0.019 * rows + 0.02
    b.part("board", slab(width / 2, depth / 2, (0, 0.012)), look="black")
    for i in range(rows):
        for k in range(columns):
            x = -width / 2 + 0.0195 + 0.019 * k
            y = -depth / 2 + 0.0195 + 0.019 * i
            b.bore("board", box((x - 0.004, y - 0.004, 0.003), (x + 0.004, y + 0.004, 1)))
            b.part(
                f"key_{i}_{k}",
                box((x - 0.0085, y - 0.0085, 0.0155), (x + 0.0085, y + 0.0085, 0.021)),
                box((x - 0.003, y - 0.003, 0.008), (x + 0.003, y + 0.003, 0.016)),
                look="grey",
            )
            b.slide(f"key_{i}_{k}", "board", -Z, 0.003)


@kind(
    words="rack cabinet, network cabinet, server cabinet",
    number=whole(1, 8, usual=(3, 6), words="server, drawer, unit"),
    height=(1.2, 2.0),
)
def server_rack(b: ObjectBuilder, number: int, height: float) -> None:
    b.part(
        "rack",
        [box((x - 0.02, y - 0.02, 0), (x + 0.02, y + 0.02, height)) for x in (-0.28, 0.28) for y in (-0.38, 0.38)],
        slab(0.3, 0.4, (0, 0.05)),
        slab(0.3, 0.4, (height - 0.03, height)),
        [slab((s * 0.3, s * 0.295), 0.36, (0.05, height)) for s in (-1, 1)],
        look="black steel",
    )
    for k, z in enumerate(spread(number, 0.1, height - 0.1)):
        b.part("rack", [slab((s * 0.24, s * 0.27), 0.39, (z - 0.06, z - 0.052)) for s in (-1, 1)])
        b.part(
            f"server_{k}",
            slab(0.23, (-0.36, 0.33), (z - 0.05, z + 0.05)),
            [box((s * 0.2 - 0.005, -0.38, z - 0.03), (s * 0.2 + 0.005, -0.359, z + 0.03)) for s in (-1, 1)],
            look="grey metal",
        )
        b.cut(f"server_{k}", slab(0.225, (-0.35, 0.32), (z - 0.045, z + 0.045)))
        b.slide(f"server_{k}", "rack", -Y, 0.02)
    leaf(b, "door", "rack", (-0.3, -0.425, 0.02), (0.3, -0.405, height), hinge=X, reach=2.0, material="glass")


@kind(words="projection screen, roll up screen", width=(1.2, 2.2))
def projector_screen(b: ObjectBuilder, width: float) -> None:
    b.part("case", slab(width / 2, 0.05, (0, 0.1)), look="white metal")
    b.cut("case", slab(width / 2 - 0.03, 0.03, (-0.1, 0.09)))
    b.part(
        "screen",
        slab(width / 2 - 0.035, 0.004, (-0.02, 0.08)),
        slab(width / 2 - 0.02, 0.012, (-0.045, -0.015)),
        look="white",
    )
    b.slide("screen", "case", -Z, 0.06)


@kind(words="mic stand, boom stand", height=(0.9, 1.2))
def microphone_stand(b: ObjectBuilder, height: float) -> None:
    b.part(
        "base",
        [beam(0.02, 0.015, (0, 0, 0.12), (0.32 * cos(a), 0.32 * sin(a), 0.008)) for a in (0.3, 2.4, 4.5)],
        b.tube(0.014, 0.01, 0.08, 0.75 * height),
        look="black steel",
    )
    b.cut("base", b.cylinder(0.01, 0.085, 2))
    b.part(
        "post",
        b.cylinder(0.0085, 0.3 * height, height),
        [slab(0.012, (s * 0.012, s * 0.018), (height - 0.01, height + 0.03)) for s in (-1, 1)],
        slab(0.012, 0.018, (height - 0.012, height - 0.004)),
        look="black steel",
    )
    b.slide("post", "base", Z, 0.35 * height)
    b.part(
        "boom",
        b.cylinder(0.008, (-0.2, 0.45), 0, height + 0.018),
        b.cylinder(0.018, (-0.3, -0.2), 0, height + 0.018),
        b.rod(0.02, (0.47, 0.56), 0, height + 0.018),
        look="black steel",
    )
    b.hinge("boom", "post", Y, (0, 0, height + 0.018), 0.7, -0.5)


@kind(width=(0.6, 0.75), height=(1.6, 1.9))
def flip_chart(b: ObjectBuilder, width: float, height: float) -> None:
    number = 1
    b.part(
        "stand",
        [beam(0.03, 0.02, (s * 0.3 * width, 0.03, height - 0.1), (s * 0.55 * width, 0.03, 0), Y) for s in (-1, 1)],
        beam(0.03, 0.02, (0, 0.06, height - 0.1), (0, 0.5, 0), Y),
        slab(width / 2, (0, 0.015), (0.45 * height, height)),
        slab(0.02, (0.01, 0.07), (height - 0.15, height - 0.05)),
        look="white metal",
    )
    for k in range(number):
        b.part(
            f"sheet_{k}",
            slab(0.46 * width, (-0.003 - 0.004 * k, -0.001 - 0.004 * k), (0.5 * height, height)),
            look="white cardboard",
        )
        b.hinge(f"sheet_{k}", "stand", -X, (0, -0.003 - 0.004 * k, height), 2.2)


@kind(words="date block, perpetual calendar", size=(0.9, 1.2))
def desk_calendar(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "frame",
        p.slab(0.1, 0.05, (0, 0.015)),
        [p.slab((x - 0.004, x + 0.004), 0.04, (0.01, 0.1)) for x in (-0.09, 0.09)],
        look="wood",
    )
    b.bore("frame", p.cylinder(0.006, (-0.12, 0.12), 0, 0.06))
    for k, (a, b_) in enumerate(((-0.083, -0.032), (-0.028, 0.028), (0.032, 0.083))):
        b.part(f"drum_{k}", p.cylinder(0.035, (a, b_), 0, 0.06), look="white")
        b.cut(f"drum_{k}", p.cylinder(0.006, (-0.12, 0.12), 0, 0.06))
        b.spin(f"drum_{k}", "frame", X, p(0, 0, 0.06))
    b.part(
        "frame",
        p.cylinder(0.0045, (-0.094, 0.094), 0, 0.06),
        [p.slab((s * 0.094, s * 0.098), 0.012, (0.048, 0.072)) for s in (-1, 1)],
    )


@kind(words="self inking stamp, stamp, date stamp", width=(0.04, 0.07))
def rubber_stamp(b: ObjectBuilder, width: float) -> None:
    b.part("base", slab(width / 2, 0.02, (0, 0.05)), look="black")
    b.cut("base", slab(width / 2 - 0.004, 0.016, (-1, 0.04)), slab(width / 2 - 0.008, 0.012, (0, 1)))
    b.part(
        "handle",
        slab(width / 2 - 0.009, 0.011, (0.02, 0.085)),
        slab(width / 2, 0.02, (0.08, 0.095)),
        slab(width / 2 - 0.006, 0.014, (0.012, 0.021)),
        look="red",
    )
    b.slide("handle", "base", -Z, 0.012)


@kind("clapperboard", words="film slate", width=(0.25, 0.35))
def film_clapper(b: ObjectBuilder, width: float) -> None:
    b.part("board", box((0, 0, 0), (width, 0.008, 0.6 * width)), look="black wood")
    b.part("clapper", box((0, 0, 0.6 * width + 0.001), (width, 0.01, 0.6 * width + 0.03)), look="white wood")
    b.hinge("clapper", "board", -Y, (0, 0, 0.6 * width + 0.001), 0.8)


@kind(words="torch, pocket torch, pocket lamp, penlight", length=(0.12, 0.22))
def flashlight(b: ObjectBuilder, length: float) -> None:
    b.part("body", b.cylinder(0.015, 0, (0, length), 0), b.cylinder(0.012, 0, (-0.012, 0.01), 0), look="black metal")
    b.cut(
        "body",
        slab(0.005, (0.4 * length, 0.4 * length + 0.03), (0.0115, 1)),
        b.cylinder(0.0115, 0, (0.01, length - 0.01), 0) if b.style.hollow else ball(0.001, (0, length / 2, 0)),
    )
    b.part("head", b.cone(0.018, 0.025, 0, (-0.001, -0.05), 0), look="grey metal")
    b.cut("head", b.cylinder(0.0135, 0, (0.1, -0.02), 0), b.cylinder(0.02, 0, (-0.035, -0.1), 0))
    b.spin("head", "body", -Y, (0, 0, 0))
    b.part("switch", slab(0.004, (0.4 * length + 0.001, 0.4 * length + 0.016), (0.0123, 0.019)), look="red")
    b.slide("switch", "body", Y, 0.012)


@kind(
    words="oil lamp, kerosene lamp, storm lantern, camping lantern, hurricane lamp",
    radius=(0.05, 0.08),
    height=(0.2, 0.3),
)
def lantern(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part(
        "base",
        b.cylinder(radius, 0, 0.25 * height),
        [
            b.cylinder(0.004, 0.85 * radius * cos(a), 0.85 * radius * sin(a), (0.2 * height, 0.9 * height))
            for a in (0.8, 2.36, 3.93, 5.5)
        ],
        b.cylinder(0.7 * radius, 0.25 * height, 0.88 * height),
        b.cylinder(radius, 0.88 * height, 0.92 * height),
        look="dark green metal",
    )
    b.cut("base", b.cylinder(0.66 * radius, 0.27 * height, 0.86 * height))
    b.part("cap", b.cone(0.8 * radius, 0.3 * radius, 0.92 * height + 0.001, height + 0.03), look="dark green metal")
    b.slide("cap", "base", Z, 0.04)
    knob(b, "wick_knob", "base", (radius, 0, 0.15 * height), 0.01, X, high=0.015)
    bail(
        b,
        "handle",
        "base",
        (0, -radius, 0.9 * height),
        (0, radius, 0.9 * height),
        0.5 * height,
        0.006,
        Z,
        lower=-1.2,
        upper=1.2,
    )


@kind(words="standard lamp, standing lamp, reading floor lamp", height=(1.3, 1.7))
def floor_lamp(b: ObjectBuilder, height: float) -> None:
    b.part(
        "base",
        b.cylinder(0.14, 0, 0.025),
        b.cylinder(0.011, 0.02, height - 0.03),
        [slab(0.012, (s * 0.008, s * 0.013), (height - 0.03, height + 0.015)) for s in (-1, 1)],
        slab(0.012, 0.013, (height - 0.035, height - 0.012)),
        look="black steel",
    )
    b.part("arm", beam(0.012, 0.012, (-0.008, 0, height), (0.4, 0, height + 0.12), Y), look="black steel")
    b.hinge("arm", "base", -Y, (0, 0, height), 0.6, -0.25)
    b.part(
        "head",
        b.cone(0.09, 0.03, 0.4, 0, (height - 0.05, height + 0.06)),
        [box((0.39, s * 0.0085, height + 0.05), (0.41, s * 0.014, height + 0.13)) for s in (-1, 1)],
        look="white metal",
    )
    b.cut("head", b.cone(0.085, 0.026, 0.4, 0, (height - 0.055, height + 0.05)))
    b.hinge("head", "arm", Y, (0.4, 0, height + 0.12), 0.5, -0.5)


@kind(words="clamp lamp, clip on lamp", size=(0.9, 1.2))
def clip_lamp(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.015, (-0.08, 0.03), (0, 0.012)),
        p.cylinder(0.006, 0.01, 0.125),
        [p.slab((s * 0.008, s * 0.013), 0.008, (0.12, 0.16)) for s in (-1, 1)],
        p.slab(0.013, 0.008, (0.118, 0.13)),
        [p.slab((s * 0.008, s * 0.014), 0.01, (-0.025, 0.002)) for s in (-1, 1)],
        look="black",
    )
    b.part("clip", p.slab(0.007, (-0.08, 0.04), (-0.022, -0.012)), look="black")
    b.hinge("clip", "body", X, p(0, 0, -0.017), 0.25)
    b.part(
        "head",
        p.cone(0.045, 0.02, 0, (-0.09, -0.03), 0.15),
        p.beam(0.012, 0.012, (0, -0.035, 0.15), (0, 0.004, 0.15)),
        look="black metal",
    )
    b.cut("head", p.cone(0.042, 0.017, 0, (-0.095, -0.04), 0.15))
    b.hinge("head", "body", X, p(0, 0, 0.15), 0.6, -0.6)


@kind(words="game clock, chess timer", width=(0.16, 0.22))
def chess_clock(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "case",
        slab(w, 0.025, (0, 0.1)),
        [b.cylinder(0.036, s * w / 2, (-0.029, -0.024), 0.052) for s in (-1, 1)],
        [slab(0.012, (s * 0.015, s * 0.02), (0.098, 0.122)) for s in (-1, 1)],
        look="wood",
    )
    b.part(
        "rocker",
        slab(0.8 * w, 0.012, (0.113, 0.119)),
        [slab((s * 0.8 * w - 0.012, s * 0.8 * w + 0.012), 0.012, (0.118, 0.124)) for s in (-1, 1)],
        look="metal",
    )
    b.hinge("rocker", "case", Y, (0, 0, 0.116), 0.12, -0.12)
    for k, s in enumerate((-1, 1)):
        b.part(
            f"hand_{k}",
            b.cylinder(0.003, s * w / 2, (-0.03, -0.034), 0.052),
            beam(0.003, 0.002, (s * w / 2, -0.032, 0.052), (s * w / 2, -0.032, 0.08)),
            look="black steel",
        )
        b.spin(f"hand_{k}", "case", -Y, (s * w / 2, 0, 0.052))


@kind(words="drawing table, drawing board, art table, architect table", width=(0.8, 1.3), depth=(0.55, 0.8))
def drafting_table(b: ObjectBuilder, width: float, depth: float) -> None:
    b.part(
        "frame",
        [slab((s * 0.4 * width - 0.02, s * 0.4 * width + 0.02), 0.3, (0, 0.05)) for s in (-1, 1)],
        [slab((s * 0.4 * width - 0.02, s * 0.4 * width + 0.02), 0.03, (0.04, 0.72)) for s in (-1, 1)],
        slab(0.4 * width, 0.02, (0.2, 0.26)),
        look="black steel",
    )
    b.part(
        "board",
        slab(width / 2, depth / 2, (0.75, 0.775)),
        slab(width / 2, (-depth / 2 - 0.012, -depth / 2 + 0.001), (0.75, 0.79)),
        [slab((s * 0.4 * width - 0.05, s * 0.4 * width - 0.025), 0.03, (0.72, 0.751)) for s in (-1, 1)],
        look="white wood",
    )
    b.hinge("board", "frame", X, (0, 0, 0.715), 1.0, 0)


@kind(words="pulpit, speaker desk, podium", height=(0.95, 1.2))
def lectern(b: ObjectBuilder, height: float) -> None:
    b.part("base", b.cylinder(0.22, 0, 0.03), b.tube(0.035, 0.028, 0.02, 0.75 * height), look="black steel")
    b.part(
        "post",
        b.cylinder(0.026, 0.25 * height, height),
        [slab((s * 0.03, s * 0.038), 0.03, (height - 0.01, height + 0.05)) for s in (-1, 1)],
        slab(0.038, 0.03, (height - 0.012, height)),
        look="steel",
    )
    b.slide("post", "base", Z, 0.3 * height)
    b.part(
        "desk",
        slab(0.25, 0.18, (height + 0.085, height + 0.1)),
        slab(0.25, (-0.2, -0.179), (height + 0.085, height + 0.13)),
        slab(0.028, 0.02, (height + 0.02, height + 0.086)),
        look="wood",
    )
    b.hinge("desk", "post", X, (0, 0, height + 0.035), 0.5, 0)


@kind(words="comb binder", width=(0.32, 0.42))
def binding_machine(b: ObjectBuilder, width: float) -> None:
    b.part(
        "body",
        slab(width / 2, 0.1, (0, 0.1)),
        [slab((s * width / 2, s * (width / 2 - 0.012)), 0.05, (0.08, 0.16)) for s in (-1, 1)],
        look="grey",
    )
    b.bore("body", slab(0.42 * width, (-0.2, 0.05), (0.015, 0.045)))
    b.part("drawer", slab(0.415 * width, (-0.11, 0.04), (0.017, 0.042)), look="black")
    b.cut("drawer", slab(0.4 * width, (-0.09, 0.035), (0.022, 0.1)))
    b.slide("drawer", "body", -Y, 0.1)
    b.part(
        "lever",
        slab(width / 2 - 0.014, (0.015, 0.04), (0.13, 0.15)),
        [beam(0.02, 0.012, (s * 0.42 * width, 0.028, 0.14), (s * 0.42 * width, -0.05, 0.3), X) for s in (-1, 1)],
        b.cylinder(0.012, (-0.43 * width, 0.43 * width), -0.05, 0.3),
        look="steel",
    )
    b.hinge("lever", "body", X, (0, 0.028, 0.14), 0.9, 0)


@kind(words="welding helmet, motorcycle helmet, helmet with visor, knight helmet, face shield", size=(0.9, 1.1))
def visor_helmet(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("shell", p.ball(0.13, (0, 0, 0.13)), look="black")
    b.cut(
        "shell", p.ball(0.118, (0, 0, 0.13)), p.slab(0.2, 0.2, (-0.1, 0.06)), p.slab(0.09, (-0.2, -0.04), (0.06, 0.15))
    )
    b.part("visor", p.ball(0.139, (0, 0, 0.13)), look="glass")
    b.cut(
        "visor",
        p.ball(0.132, (0, 0, 0.13)),
        p.slab(0.2, 0.2, (-0.1, 0.07)),
        p.slab(0.2, 0.2, (0.155, 0.4)),
        p.slab(0.2, (0.012, 0.2), (-0.1, 0.4)),
    )
    b.hinge("visor", "shell", -X, p(0, 0, 0.13), 1.0)


@kind(words="phone stand, phone holder, book holder, cookbook stand, tablet holder", size=(0.9, 1.3))
def tablet_stand(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "base",
        p.slab(0.06, 0.06, (0, 0.01)),
        [p.box((s * 0.018, 0.02, 0.008), (s * 0.025, 0.05, 0.05)) for s in (-1, 1)],
        look="metal",
    )
    b.part("arm", p.beam(0.03, 0.01, (0, 0.035, 0.035), (0, 0, 0.14)), look="metal")
    b.hinge("arm", "base", X, p(0, 0.035, 0.035), 0.5, -0.4)
    b.part(
        "back",
        p.slab(0.07, (-0.015, -0.009), (0.1, 0.22)),
        p.slab(0.07, (-0.035, -0.009), (0.1, 0.106)),
        [p.box((s * 0.017, -0.01, 0.125), (s * 0.022, 0.008, 0.15)) for s in (-1, 1)],
        look="metal",
    )
    b.hinge("back", "arm", X, p(0, 0, 0.14), 0.25, -0.4)


@kind(words="door phone, doorbell, door bell button, entry phone", number=whole(1, 5, words="button"))
def intercom(b: ObjectBuilder, number: int) -> None:
    height = 0.12 + 0.03 * number
    b.part(
        "panel",
        slab(0.05, (0, 0.02), (0, height)),
        [b.cylinder(0.004, x, (-0.001, 0.001), height - 0.03 - 0.01 * k) for x in (-0.015, 0, 0.015) for k in range(3)],
        look="steel",
    )
    for k, z in enumerate(spread(number, 0.02, height - 0.07)):
        button(b, f"button_{k}", "panel", (0, 0, z), (0.02, 0.02), 0.005, -Y, is_round=True, material="chrome")


@kind(words="flash drive, thumb drive, memory stick", size=(0.9, 1.2))
def usb_stick(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "stick", p.slab(0.01, (-0.02, 0.025), (0, 0.007)), p.slab(0.006, (-0.036, -0.02), (0.001, 0.006)), look="black"
    )
    b.part(
        "cover",
        p.slab(0.0105, (-0.038, 0.03), (0.008, 0.0095)),
        p.slab(0.0105, (-0.038, 0.03), (-0.0025, -0.001)),
        p.slab(0.0105, (-0.0395, -0.038), (-0.0025, 0.0095)),
        look="steel",
    )
    b.spin("cover", "stick", Z, p(0, 0.018, 0))


@kind(words="flood lamp on a tripod, stage lamp stand", height=(1.2, 2.0))
def work_light(b: ObjectBuilder, height: float) -> None:
    b.part(
        "stand",
        [beam(0.025, 0.025, (0, 0, 0.4), (0.4 * cos(a), 0.4 * sin(a), 0.012)) for a in (0.5, 2.6, 4.7)],
        b.cylinder(0.016, 0.3, height),
        slab(0.17, 0.012, (height - 0.01, height + 0.015)),
        [slab((s * 0.17, s * 0.162), 0.012, (height - 0.01, height + 0.13)) for s in (-1, 1)],
        look="yellow steel",
    )
    b.part(
        "head",
        slab(0.15, (-0.05, 0.03), (height + 0.03, height + 0.2)),
        [b.cylinder(0.006, (s * 0.149, s * 0.16), 0, height + 0.11) for s in (-1, 1)],
        look="black metal",
    )
    b.cut("head", slab(0.14, (-0.1, -0.03), (height + 0.04, height + 0.19)))
    b.hinge("head", "stand", X, (0, 0, height + 0.11), 0.5, -0.9)


@kind(
    "iris diaphragm",
    words="camera iris, aperture, iris aperture, mechanical iris, iris shutter, aperture diaphragm",
    blades=whole(5, 14, default=8, words="blade, leaf, lamella"),
    size=(0.7, 2),
    styles=False,
)
def iris(b: ObjectBuilder, blades: int, size: float) -> None:
    """Blades between two rings that close when the outer one is turned."""
    p = b.sized(size)
    top = 0.007 + 0.0012 * blades
    b.part("base", p.tube(0.06, 0.036, 0, 0.004), p.tube(0.06, 0.057, 0, top), look="black metal")
    b.part("ring", p.tube(0.066, 0.0605, 0, top), p.rod(0.003, (0.067, 0.085), 0, top / 2), look="metal")
    b.hinge("ring", "base", Z, (0, 0, 0), 1.0)
    for k in range(blades):
        a, z, name = 2 * pi * k / blades, 0.0046 + 0.0012 * k, f"blade_{k + 1}"
        x, y = 0.05 * cos(a), 0.05 * sin(a)
        arc = [(0.041 * cos(a + t), 0.041 * sin(a + t), 0.0055) for t in (0.5, 0.9, 1.3, 1.6)]
        b.part("base", p.cylinder(0.0015, x, y, (0.003, z + 0.001)))
        b.part(name, p.strip([(x, y, 0.004), *arc], z, z + 0.0008), look="steel")
        b.cut(name, p.cylinder(0.002, x, y, (0, 1)))
        b.hinge(name, "base", Z, p(x, y, z), 0.72)
        b.follow(name, "ring", 0.72)
