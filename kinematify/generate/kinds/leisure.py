"""Music, games, sports and toys."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from kinematify.generate.library.kind import kind, whole, yes
from kinematify.generate.library.mechanisms import button, case, crank, knob, wheel
from kinematify.generate.library.panels import drawer, leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, block, box, prism, slab, vector


@kind(words="wooden train, toy locomotive", length=(0.12, 0.3), width=(0.04, 0.08), radius=(0.012, 0.025))
def toy_train(b: ObjectBuilder, length: float, width: float, radius: float) -> None:
    """A locomotive of blocks with four to eight wheels."""
    b.part(
        "engine",
        slab(length / 2, width / 2, (radius, 2.5 * radius)),
        b.cylinder(0.4 * width, (-0.1 * length, length / 2), 0, 2.5 * radius + 0.3 * width),
        slab((-length / 2, -0.1 * length), width / 2, (2 * radius, 2.5 * radius + 1.2 * width)),
        b.cylinder(0.15 * width, 0.35 * length, 0, (2.5 * radius, 2.5 * radius + 1.1 * width)),
        look="wood",
    )
    for i, x in enumerate(spread(b.count(2, 4), -0.48 * length, 0.48 * length)):
        for s in (-1, 1):
            wheel(
                b,
                f"wheel_{i}_{int(s > 0)}",
                "engine",
                (x, s * (width / 2 + 0.35 * radius), radius),
                min(radius, 0.11 * length),
                0.4 * radius,
                s * Y,
                axle=0.15 * radius,
            )


@kind(words="pull along dog, pull toy, pull along toy, toy animal", size=(0.08, 0.2))
def pull_along_animal(b: ObjectBuilder, size: float) -> None:
    """A body on wheels, a head that nods, a tail that wags."""
    b.part(
        "body",
        b.rod(0.35 * size, (-0.5 * size, 0.5 * size), 0, 0.8 * size),
        [
            slab((x * size - 0.1 * size, x * size + 0.1 * size), 0.3 * size, (0.2 * size, 0.7 * size))
            for x in (-0.45, 0.45)
        ],
        look="wood",
    )
    g = b.gap(0.1 * size)
    x = 0.85 * size + g
    c = vector(x + 0.3 * size, 0, 1.1 * size)
    u = vector(0.91, 0, 0.415)
    b.part("body", b.rod(0.08 * size, c - 0.7 * size * u, c - (0.39 * size + g) * u))
    b.part(
        "head",
        ball(0.3 * size, (x + 0.3 * size, 0, 1.1 * size)),
        b.cone(0.12 * size, 0.05 * size, (x + 0.5 * size, 0, 1.05 * size), (x + 0.75 * size, 0, 1 * size)),
    )
    b.hinge(
        "head", "body", Y, (x + (0.3 * size if b.style.has_bore else 0), 0, 1.1 * size), 0.25, lower=-0.25, ajar=False
    )
    b.part("tail", b.rod(0.06 * size, (-0.9 * size - g, 0, 0.95 * size), (-1.2 * size, 0, 1.3 * size)))
    b.hinge("tail", "body", X if b.maybe() else Z, (-0.9 * size - g, 0, 0.95 * size), 0.3, -0.3, ajar=False)
    for i, x in enumerate((-0.45 * size, 0.45 * size)):
        for s in (-1, 1):
            wheel(
                b,
                f"wheel_{i}_{int(s > 0)}",
                "body",
                (x, s * 0.38 * size, 0.22 * size),
                0.22 * size,
                0.1 * size,
                s * Y,
                axle=0.03 * size,
            )


@kind("jointed doll", words="doll, toy doll, mannequin", size=(0.1, 1.0))
def articulated_doll(b: ObjectBuilder, size: float) -> None:
    """Arms, legs and a head on a torso."""
    g = b.gap(0.05 * size)
    b.part(
        "torso",
        slab(0.18 * size, 0.1 * size, (0.5 * size, 0.95 * size)),
        b.cylinder(0.05 * size, 0.94 * size, 1 * size),
        look="wood",
    )
    b.part("head", ball(0.13 * size, (0, 0, 1.13 * size + g)))
    b.hinge("head", "torso", Z, (0, 0, 1 * size), 1.3, -1.3, ajar=False)
    for s, side in ((-1, "right"), (1, "left")):
        x = s * (0.18 * size + g)
        top = vector(x + s * 0.05 * size, 0, 0.9 * size)
        b.part(f"arm_{side}", b.rod(0.05 * size, top, top - 0.4 * size * Z))
        b.hinge(f"arm_{side}", "torso", -X, (x, 0, 0.9 * size), 2.5, -0.5, ajar=False)
        hip = vector(s * 0.09 * size, 0, 0.43 * size - g)
        b.part(f"leg_{side}", b.rod(0.07 * size, hip, hip - 0.11 * size * Z))
        b.hinge(f"leg_{side}", "torso", -X, hip, 1.2, -0.4, ajar=False)
        if b.maybe():
            knee = hip - (0.24 * size + g) * Z
            toe = knee + size * vector(-0.06, -0.16, -0.19)
            b.part(
                f"shin_{side}",
                b.rod(0.06 * size, knee, knee - 0.12 * size * Z),
                box(toe, toe + size * vector(0.12, 0.22, 0.05)),
            )
            b.hinge(f"shin_{side}", f"leg_{side}", X, knee, 1.5, ajar=False)


@kind(size=(0.08, 0.2))
def jack_in_the_box(b: ObjectBuilder, size: float) -> None:
    """A lid and a crank at the side."""
    case(b, "box", (-size / 2, -size / 2, 0), (size / 2, size / 2, size), opening=Z)
    leaf(
        b,
        "lid",
        "box",
        (-size / 2, -size / 2, size),
        (size / 2, size / 2, 1.06 * size),
        hinge=Y,
        out=Z,
        reach=2.2,
        handle=False,
    )
    crank(b, "crank", "box", (size / 2, 0, 0.5 * size), X, 0.35 * size)


@kind(
    words="counting frame, bead frame",
    width=(0.15, 0.4),
    number=whole(1, 12, default=3, usual=(2, 4), words="rod, wire, row"),
)
def abacus(b: ObjectBuilder, width: float, number: int) -> None:
    """Beads that slide on rods."""
    h = 0.18 * width * number
    r = 0.07 * width
    b.part(
        "frame",
        [slab((s * width / 2, s * (width / 2 + 0.05 * width)), r, (0, h)) for s in (-1, 1)],
        [slab(width / 2, r, (z, z + 0.05 * width)) for z in (0, h - 0.05 * width)],
        look="wood",
    )
    g = b.gap(r) + 0.0001
    for i, z in enumerate(spread(number, 0.05 * width, h - 0.05 * width)):
        b.part("frame", b.cylinder(0.02 * width, (-width / 2, width / 2), 0, z))
        m = b.count(1, 3)
        for k in range(m):
            x = -width / 2 + (0.06 + 0.13 * k) * width + 0.001
            b.part(f"bead_{i}_{k}", b.cylinder(r, (x, x + 0.1 * width), 0, z), look="wood")
            b.bore(f"bead_{i}_{k}", b.cylinder(0.02 * width + 1.5 * g, (x - 1, x + 1), 0, z))
            if k == m - 1:
                b.slide(f"bead_{i}_{k}", "frame", X, 0.4 * width, ajar=False)
            else:
                b.slide(f"bead_{i}_{k}", "frame", X, 0.02 * width, ajar=False)


@kind(
    words="mixing desk, audio mixer, sound mixer, dj mixer, fader panel, sound board, mixer console, dj controller",
    width=(0.3, 0.9),
    depth=(0.25, 0.45),
    number=whole(1, 16, default=3, usual=(2, 5), words="fader, channel, slider"),
)
def mixing_console(b: ObjectBuilder, width: float, depth: float, number: int) -> None:
    """Faders in slots, knobs in a grid and pads on a desk: a mixer."""
    case(b, "console", (-width / 2, 0, 0), (width / 2, depth, 0.06), material="steel")
    g = b.gap(0.005) + 0.0002
    for k, x in enumerate(spread(number, -0.46 * width, 0.46 * width)):
        b.cut("console", box((x - 0.003 - g, 0.04, 0.04), (x + 0.003 + g, 0.5 * depth, 0.07)))
        y = b.draw(0.06, 0.3 * depth)
        b.part(
            f"fader_{k}",
            box((x - 0.003, y - 0.004, 0.045), (x + 0.003, y + 0.004, 0.07)),
            box((x - 0.012, y - 0.01, 0.062), (x + 0.012, y + 0.01, 0.075)),
        )
        b.slide(f"fader_{k}", "console", Y, 0.48 * depth - y, lower=0.05 - y, ajar=False)
        for i, q in enumerate(spread(b.count(1, 2), 0.55 * depth, 0.95 * depth)):
            knob(b, f"knob_{k}_{i}", "console", (x, q, 0.06), 0.01, Z, high=0.015, reach=5.0)


@kind(
    walls=60,
    words="weight stack, cable machine, gym machine",
    height=(1.6, 2.0),
    number=whole(1, 3, words="plate, weight"),
)
def weight_machine(b: ObjectBuilder, height: float, number: int) -> None:
    """A stack that slides on two rods, an arm that swings."""
    w = 0.5
    b.part(
        "frame",
        slab(w / 2, 0.2, (0, 0.06)),
        slab(w / 2, 0.05, (height, height + 0.08)),
        [slab((s * w / 2 - 0.03, s * w / 2 + 0.03), 0.04, (0, height + 0.05)) for s in (-1, 1)],
        [b.cylinder(0.014, s * 0.12, 0, (0.05, height + 0.01)) for s in (-1, 1)],
        look="steel",
    )
    g = b.gap(0.02) + 0.0003
    z = 0.06 + g
    for k in range(number):
        t = b.draw(0.06, 0.2)
        b.part(f"plate_{k}", slab(0.2, 0.06, (z, z + t)), look="steel")
        b.bore(f"plate_{k}", [b.cylinder(0.014 + 1.5 * g, s * 0.12, 0, (0, height)) for s in (-1, 1)])
        b.slide(
            f"plate_{k}",
            "frame",
            Z,
            0.02 if k < number - 1 and b.style.has_bore else 0.6 * height if k == number - 1 else 0.3,
            ajar=False,
        )
        z = z + (t + (0.021 if b.style.has_bore else 0) + g)


@kind(
    words="laser printer, inkjet printer, copier, photocopier, copy machine, office printer",
    width=(0.35, 0.5),
    depth=(0.3, 0.45),
    height=(0.12, 0.35),
)
def printer(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A scanner lid, a paper tray, an output flap, buttons."""
    case(b, "printer", (-width / 2, 0, 0), (width / 2, depth, height), material="plastic")
    leaf(
        b,
        "lid",
        "printer",
        (-width / 2, 0.06, height),
        (width / 2, depth, height + 0.03),
        hinge=Y,
        out=Z,
        reach=1.3,
        handle=False,
    )
    drawer(
        b, "tray", "printer", (-0.38 * width, 0, 0.015), (0.38 * width, 0.85 * depth, 0.35 * height), handle=b.maybe()
    )
    leaf(
        b,
        "flap",
        "printer",
        (-0.4 * width, -0.012, 0.45 * height),
        (0.4 * width, 0, 0.85 * height),
        hinge=-Z,
        reach=1.4,
        handle=False,
    )
    for k, x in enumerate(spread(b.count(1, 4), -0.3 * width, 0.3 * width)):
        button(b, f"button_{k}", "printer", (x, 0.03, height), (0.02, 0.015), 0.003, Z, is_round=b.maybe())


@kind(
    words="computer, personal computer, computer case, pc tower, pc, computer tower, pc case",
    width=(0.17, 0.22),
    depth=(0.4, 0.5),
    height=(0.38, 0.5),
)
def desktop_computer(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A side panel that slides or swings, a power button, drive trays."""
    case(b, "tower", (-width / 2, 0, 0), (width / 2, depth, height), opening=X, wall=0.006, material="steel")
    if b.maybe():
        leaf(
            b,
            "panel",
            "tower",
            (width / 2, 0, 0),
            (width / 2 + 0.004, depth, height),
            hinge=Y,
            out=X,
            handle=False,
            material="glass",
        )
    else:
        g = b.gap(0.01)
        b.part("panel", box((width / 2 + g, 0, 0), (width / 2 + g + 0.004, depth, height)), look="steel")
        b.slide("panel", "tower", Y, 0.3)
    for k, z in enumerate(spread(b.count(1, 3), 0.6 * height, height - 0.02)):
        drawer(b, f"drive_{k}", "tower", (-0.075, 0, z - 0.012), (0.075, 0.18, z + 0.012), handle=False, travel=0.7)
    button(b, "power", "tower", (0, 0, 0.5 * height), (0.02, 0.02), 0.004, -Y, is_round=b.maybe())


@kind("camera on a tripod", words="film camera on a tripod", height=(0.6, 1.5))
def camera_on_tripod(b: ObjectBuilder, height: float) -> None:
    """A head that pans and tilts, a lens ring, legs that spread."""
    b.part(
        "column", b.cylinder(0.016, 0.5 * height, height), b.cylinder(0.035, 0.8 * height, 0.86 * height), look="metal"
    )
    g = b.gap(0.02) + 0.0005
    for k, a in enumerate(np.arange(3) * 2 * pi / 3):
        u = vector(cos(a), sin(a), 0)
        p = (0.05 + g) * u + 0.84 * height * Z
        b.part(f"leg_{k}", b.cylinder(0.012, p, p + 0.4 * height * u - 0.84 * height * Z), look="metal")
        b.hinge(f"leg_{k}", "column", np.cross(Z, u) * -1, p, 0.3, -0.3, ajar=False)
    b.part(
        "pan",
        b.cylinder(0.03, height + g, height + 0.04),
        [slab((s * 0.035 - 0.005, s * 0.035 + 0.005), 0.02, (height + 0.02, height + 0.1)) for s in (-1, 1)],
        look="metal",
    )
    b.spin("pan", "column", Z, (0, 0, height))
    b.part(
        "camera",
        slab(0.03 - g, 0.02, (height + 0.05, height + 0.12)),
        slab(0.07, 0.03, (height + 0.11, height + 0.2)),
        b.cylinder(0.03, 0, (-0.02, -0.06), height + 0.155),
    )
    b.hinge("camera", "pan", X, (0, 0, height + 0.08), 0.3, -0.3, ajar=False)
    b.part(
        "lens",
        b.tube(0.034, 0.0305 + g, 0, (-0.035, -0.075), height + 0.155)
        if b.style.has_bore
        else b.cylinder(0.03, 0, (-0.06, -0.1), height + 0.155),
    )
    b.spin("lens", "camera", -Y, (0, -0.06, height + 0.155))


@kind(
    "dentist treatment chair",
    walls=40,
    words="dental chair, treatment chair, dentist unit, examination chair",
    z=(0.45, 0.6),
)
def dentist_chair(b: ObjectBuilder, z: float) -> None:
    """A seat on a column, a back, a head rest that slides."""
    b.part("foot", slab((-0.3, 0.4), 0.25, (0, 0.05)), b.cylinder(0.09, 0.04, z - 0.1), look="steel")
    g = b.gap(0.05) + 0.0005
    b.part(
        "seat",
        slab((-0.25, 0.35), 0.28, (z, z + 0.1)),
        b.cylinder(0.07 if b.style.has_bore else 0.09, 0.15 if b.style.has_bore else z - 0.1, z + 0.01),
        slab((0.3, 0.4), 0.25, (0.25, z + 0.08)),
    )
    b.bore("foot", b.cylinder(0.07 + 1.5 * g, 0.1, 1))
    b.slide("seat", "foot", Z, 0.25, ajar=False)
    b.part("back", slab((-0.37, -0.25 - g), 0.27, (z + 0.02, z + 0.65)))
    b.hinge("back", "seat", -Y, (-0.25 - g, 0, z + 0.02), 1.2)
    b.bore("back", slab((-0.34 - g, -0.31 + g), 0.03 + g, (z + 0.5, z + 1)))
    b.part(
        "head_rest",
        slab((-0.34, -0.31), 0.03, (z + 0.52 if b.style.has_bore else z + 0.65, z + 0.75)),
        slab((-0.38, -0.28), 0.13, (z + 0.7, z + 0.85)),
    )
    b.slide("head_rest", "back", Z, 0.1, ajar=False)


@kind(
    words="up and over door, overhead door, tilting garage door",
    width=(2.2, 3.0),
    height=(1.9, 2.3),
    lift=yes(0.45, words="vertical lift", help="It goes straight up before the wall above it."),
)
def garage_door(b: ObjectBuilder, width: float, height: float, lift: bool) -> None:
    """A panel that swings out and up until it lies under the lintel, or goes straight up before the wall above it."""
    b.part(
        "frame",
        [box((s * width / 2, -0.1, 0), (s * (width / 2 + 0.2), 0.3, height + 0.2)) for s in (-1, 1)],
        slab(width / 2 + 0.2, (-0.1, 0.3), (height, height * (2 if lift else 1) + 0.3)),
        look="ceramic",
    )
    g = b.gap(0.05) + 0.003
    y = 0.3 + g if lift else 0.05
    b.part("panel", slab(width / 2 - (g if not lift else -0.05), (y, y + 0.05), (0.01, height - g)), look="steel")
    for z in spread(b.count(3, 5), 0.1, height - 0.1):
        b.part(
            "panel", slab(0.45 * width, (y - (0 if lift else 0.015), y + (0.065 if lift else 0)), (z - 0.08, z + 0.08))
        )
    if lift:
        b.slide("panel", "frame", Z, height)
    else:
        b.hinge("panel", "frame", -X, (0, 0.05, height - g), 1.57)


@kind(
    words="sliding window",
    usual={"sash window, hung window, vertical sliding window, double hung window": {"flat": "no"}},
    width=(0.6, 1.2),
    height=(0.9, 1.5),
    flat=yes(0.5),
)
def sash_window(b: ObjectBuilder, width: float, height: float, flat: bool) -> None:
    """Two sashes one before the other, up and down or left and right."""
    t = 0.05
    b.part(
        "frame",
        [box((s * width / 2, 0, 0), (s * (width / 2 + t), 0.1, height)) for s in (-1, 1)],
        [slab(width / 2 + t, (0, 0.1), (z, z + t)) for z in (-t, height)],
        look="wood",
    )
    g = b.gap(0.02) + 0.0005
    for k in range(2):
        y = 0.01 + 0.045 * k
        if flat:
            s = -1 if k else 1
            x0, x1 = sorted((s * (width / 2 - g), -s * 0.03))
            low = (x0, y, g)
            high = (x1, y + 0.035, height - g)
        else:
            z0, z1 = (g, height / 2 + 0.03) if k == 0 else (height / 2 - 0.03, height - g)
            low = (-width / 2 + g, y, z0)
            high = (width / 2 - g, y + 0.035, z1)
        inner = vector(low[0] + 0.05, y + 0.014, low[2] + 0.05), vector(high[0] - 0.05, y + 0.021, high[2] - 0.05)
        pane = b.painted(box(*inner), look="glass")
        b.part(f"sash_{k}", box(low, high) - box(inner[0] - Y, inner[1] + Y), pane, look="wood")
        way = (-X if k == 0 else X) if flat else Z if k == 0 else -Z
        b.slide(f"sash_{k}", "frame", way, (width if flat else height) / 2 - 0.05)


@kind(words="lift, elevator car, passenger elevator, freight elevator, lift cabin, elevator cabin", width=(0.9, 1.3))
def elevator(b: ObjectBuilder, width: float) -> None:
    """Doors that part, a call panel with buttons."""
    h = 2.1
    b.part(
        "shaft",
        box((-width - 0.3, 0, 0), (-width / 2, 0.2, h + 0.4)),
        box((width / 2, 0, 0), (width + 0.3, 0.2, h + 0.4)),
        slab(width + 0.2, (0, 0.2), (h, h + 0.4)),
        look="ceramic",
    )
    g = b.gap(0.05) + 0.001
    for k, s in enumerate((-1, 1)):
        b.part(f"door_{k}", box((s * 0.003, 0.2 + g, 0.01), (s * (width / 2 + 0.05), 0.23 + g, h + 0.05)), look="steel")
        b.slide(f"door_{k}", "shaft", s * X, width / 2 - 0.05)
    for k, z in enumerate((1, 1.08)[: b.count(1, 2)]):
        button(b, f"call_{k}", "shaft", (width / 2 + 0.15, 0, z), (0.04, 0.04), 0.01, -Y, is_round=b.maybe())


@kind(
    words="snack machine, drinks machine, ticket machine, cigarette machine",
    width=(0.7, 1.0),
    depth=(0.5, 0.8),
    height=(1.6, 1.9),
)
def vending_machine(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A door, a flap below, buttons, a coin knob."""
    case(b, "machine", (-width / 2, 0, 0), (width / 2, depth, height), material="steel")
    leaf(b, "door", "machine", (-width / 2, -0.06, 0.45), (0.25 * width, 0, height), hinge=-X, material="glass")
    leaf(b, "flap", "machine", (-0.35 * width, -0.012, 0.15), (0.15 * width, 0, 0.35), hinge=Z, reach=0.9, handle=False)
    for i, z in enumerate(spread(b.count(2, 4), 0.8, 1.3)):
        for k, x in enumerate((0.32 * width, 0.38 * width)):
            button(b, f"button_{i}_{k}", "machine", (x, 0, z), (0.03, 0.03), 0.008, -Y, is_round=b.maybe())
    knob(b, "coin_return", "machine", (0.4 * width, 0, 0.7), 0.02, -Y, high=0.02, reach=1.5)


@kind(
    words="one armed bandit, fruit machine, gambling machine",
    size=(0.3, 0.6),
    number=whole(1, 6, usual=(2, 4), words="reel, drum"),
)
def slot_machine(b: ObjectBuilder, size: float, number: int) -> None:
    """A lever at the side, reels in a window, a tray."""
    case(b, "machine", (-0.5 * size, 0, 0), (0.5 * size, 0.7 * size, 1.4 * size), material="steel")
    g = b.gap(0.02 * size) + 0.0003
    b.cut("machine", slab(0.4 * size, (-0.1, 0.5 * size), (0.75 * size, 1.15 * size)))
    for i, x in enumerate(spread(number, -0.38 * size, 0.38 * size)):
        half = 0.36 * size / number
        b.part(f"reel_{i}", b.cylinder(0.18 * size, (x - half, x + half), 0.2 * size, 0.95 * size))
        b.spin(f"reel_{i}", "machine", X, (x, 0.2 * size, 0.95 * size))
    at = vector(0.5 * size + g, 0.3 * size, 0.7 * size)
    b.part(
        "lever",
        b.cylinder(0.05 * size, at, at + 0.08 * size * X),
        b.rod(0.02 * size, at + 0.06 * size * X, at + vector(0.06 * size, -0.05 * size, 0.5 * size)),
        ball(0.05 * size, at + vector(0.06 * size, -0.05 * size, 0.52 * size)),
        look="metal",
    )
    b.hinge("lever", "machine", X, at - g * X, 1.2)


@kind(words="sun blind, shop awning, folding arm awning, patio awning", width=(1.5, 3.0))
def awning(b: ObjectBuilder, width: float) -> None:
    """An awning: arms that fold out of a wall case, a crank."""
    b.part("case", slab(width / 2, 0.1, (0, 0.2)), look="metal")
    g = b.gap(0.05) + 0.001
    for k, s in enumerate((-1, 1)):
        x = s * 0.42 * width
        b.part("case", block((x, -0.12, 0.04), (0.1, 0.08, 0.02)))
        y = -0.13
        b.part(
            f"arm_{k}",
            beam(0.05, 0.05, (x, y, 0.03 - 0.025 - g), (x - s * 0.3 * width, y - 0.5, 0.03 - 0.025 - g)),
            b.cylinder(0.03, x, y, (0.03 - 0.05 - g, 0.03 - g)),
            look="metal",
        )
        b.hinge(f"arm_{k}", "case", s * Z * -1, (x, y, 0), 0.6, -0.5, ajar=False)
    crank(b, "crank", "case", (width / 2, 0, 0.1), X, 0.2)


@kind(words="solar panel, tracking solar panel, heliostat, solar array", size=(0.3, 2.0))
def solar_tracker(b: ObjectBuilder, size: float) -> None:
    """A panel that tilts on a head that turns on a post."""
    b.part("post", b.cylinder(0.06 * size, 0, size), b.cylinder(0.25 * size, 0, 0.03 * size), look="steel")
    g = b.gap(0.03 * size)
    b.part(
        "head",
        b.cylinder(0.08 * size, size + g, 1.1 * size),
        [
            slab((s * 0.12 * size - 0.02 * size, s * 0.12 * size + 0.02 * size), 0.05 * size, (1.07 * size, 1.3 * size))
            for s in (-1, 1)
        ],
        slab(0.13 * size, 0.05 * size, (1.05 * size, 1.1 * size)),
        look="steel",
    )
    b.spin("head", "post", Z, (0, 0, size))
    c = vector(0, 0, 1.26 * size)
    b.part(
        "panel",
        beam(1.2 * size, 0.04 * size, c + vector(0, -0.4 * size, 0.05 * size), c + vector(0, 0.4 * size, 0.12 * size)),
        beam(0.15 * size, 0.16 * size, c - 0.04 * size * Y, c + 0.04 * size * Y),
        look="glass",
    )
    if not b.style.has_bore:
        b.part(f"{b.pick('panel', 'head')}", b.cylinder(0.02 * size, c - 0.15 * size * X, c + 0.15 * size * X))
    if b.style.has_bore:
        b.part("panel", b.cylinder(0.02 * size, c - 0.15 * size * X, c + 0.15 * size * X))
        b.cut("head", b.cylinder(0.02 * size + 1.5 * g, c - 0.15 * size * X, c + 0.15 * size * X))
    b.hinge("panel", "head", X, c, 0.5, -0.6, ajar=False)


@kind(words="book press", width=(0.15, 0.35), z=(0.02, 0.05))
def flower_press(b: ObjectBuilder, width: float, z: float) -> None:
    """Two boards on screws with wing nuts: the upper board slides, the nuts turn."""
    b.part(
        "lower",
        slab(width / 2, width / 2, (0, 0.015)),
        [
            b.cylinder(0.004, x, y, (0.01, 0.12))
            for x in (-0.42 * width, 0.42 * width)
            for y in (-0.42 * width, 0.42 * width)
        ],
        look="wood",
    )
    g = b.gap(0.005) + 0.0003
    b.part("upper", slab(width / 2, width / 2, (z, z + 0.015)), look="wood")
    for k, (x, y) in enumerate([(x, y) for x in (-0.42 * width, 0.42 * width) for y in (-0.42 * width, 0.42 * width)]):
        b.bore("upper", b.cylinder(0.004 + 1.5 * g, x, y, (0, 1)))
        n = f"nut_{k}"
        low = z + 0.035 + g
        b.part(
            n,
            b.cylinder(0.009, x, y, (low, low + 0.012)),
            beam(0.004, 0.008, (x - 0.02, y, low + 0.012), (x + 0.02, y, low + 0.012)),
            look="metal",
        )
        b.bore(n, b.cylinder(0.004 + 1.5 * g, x, y, (0, 1)))
        b.spin(n, "lower", Z, (x, y, low))
    b.slide("upper", "lower", Z, 0.018, ajar=False)


@kind(
    words="upright piano, pianola, player piano, toy piano",
    title="upright piano",
    part_words={"lid": "fallboard, keyboard lid, key cover, cover", "key": "white key, piano key"},
    details={"leg": 2},
    keys=whole(7, 52, default=28, words="key, white key", help="White keys."),
)
def piano(b: ObjectBuilder, keys: int) -> None:
    """White keys in a row with black ones between them, two pedals, a lid over the keys."""
    g = max(b.gap(0.02), 0.001)
    w = 1.3 / keys
    b.part(
        "body",
        slab(0.75, (-0.025, 0.325), (0, 1.2)),
        slab(0.75, (-0.32, 0), (0.6, 0.7)),
        [box((s * 0.66, -0.31, 0), (s * 0.75, -0.22, 0.61)) for s in (-1, 1)],
        [box((s * 0.69, -0.32, 0.6), (s * 0.75, 0, 0.82)) for s in (-1, 1)],
        b.cylinder(0.008, (-0.72, 0.72), -0.05, 0.8),
        slab(0.2, (-0.04, 0), (0, 0.1)),
        look="black wood",
    )
    b.cut("body", [box((x - 0.026 - g, -0.045, 0.03), (x + 0.026 + g, 0.02, 0.085)) for x in (-0.07, 0.07)])
    for k, x in enumerate(spread(keys, -0.65, 0.65)):
        b.part(f"key_{k + 1}", box((x - w / 2 + g / 2, -0.3, 0.716), (x + w / 2 - g / 2, -0.03, 0.732)), look="white")
        if k % 7 not in (2, 6) and k + 1 < keys:
            b.cut(f"key_{k + 1}", box((x + 0.22 * w, -0.21, 0.7), (x + w, 0, 0.8)))
        if k and (k - 1) % 7 not in (2, 6):
            b.cut(f"key_{k + 1}", box((x - w, -0.21, 0.7), (x - 0.22 * w, 0, 0.8)))
            b.part(
                f"black_key_{k}", box((x - 0.78 * w + g, -0.2, 0.718), (x - 0.22 * w - g, -0.03, 0.744)), look="black"
            )
            b.hinge(f"black_key_{k}", "body", X, (x, -0.03, 0.72), 0.045, ajar=False)
        b.hinge(f"key_{k + 1}", "body", X, (x, -0.03, 0.72), 0.045, ajar=False)
    for k, x in enumerate((-0.07, 0.07)):
        b.part(f"pedal_{k + 1}", box((x - 0.025, -0.15, 0.06), (x + 0.025, 0.015, 0.072)), look="brass")
        b.hinge(f"pedal_{k + 1}", "body", X, (x, 0.01, 0.066), 0.12, ajar=False)
    b.part(
        "lid",
        slab(0.685, (-0.31, -0.06), (0.79, 0.81)),
        b.cylinder(0.018, (-0.685, 0.685), -0.05, 0.8),
        look="black wood",
    )
    b.cut("lid", b.cylinder(0.0085 + g, (-1, 1), -0.05, 0.8))
    b.hinge("lid", "body", -X, (0, -0.05, 0.8), 1.57)


@kind(
    words="baby grand piano, concert piano, concert grand, wing piano, harpsichord",
    part_words={"lid": "top, wing, cover", "key": "white key, piano key"},
    details={"leg": 3},
    keys=whole(7, 52, default=28, words="key, white key", help="White keys."),
)
def grand_piano(b: ObjectBuilder, keys: int) -> None:
    """A wing on three legs, white keys with black ones between them, a pedal, a lid on the long side."""
    g = max(b.gap(0.02), 0.001)
    w = 1.34 / keys
    wing = [(-0.75, -0.5), (0.75, -0.5), (0.75, -0.1), (0.6, 0.2), (0.2, 0.5), (-0.1, 1), (-0.4, 1.1), (-0.75, 1)]
    b.part(
        "body",
        prism([(-0.75, -0.8), (0.75, -0.8), *wing[2:]], (0, 0, 0.72), 0.14, "z"),
        prism(wing, (0, 0, 0.85), 0.2, "z"),
        [box((s * 0.68, -0.8, 0.7), (s * 0.75, -0.45, 0.92)) for s in (-1, 1)],
        [b.cylinder(0.05, x, y, (0, 0.66)) for x, y in ((-0.62, -0.65), (0.62, -0.65), (-0.45, 0.85))],
        slab(0.03, (-0.5, -0.4), (0.03, 0.66)),
        slab(0.1, (-0.52, -0.38), (0.03, 0.11)),
        b.cylinder(0.01, -0.78, (-0.4, 1), 0.96),
        [box((-0.795, y - 0.025, 0.9), (-0.735, y + 0.025, 0.965)) for y in (-0.375, 0.975)],
        look="black wood",
    )
    b.cut(
        "body",
        prism(
            [
                (-0.7, -0.45),
                (0.7, -0.45),
                (0.7, -0.1),
                (0.55, 0.17),
                (0.15, 0.47),
                (-0.15, 0.95),
                (-0.4, 1.05),
                (-0.7, 0.95),
            ],
            (0, 0, 0.9),
            0.3,
            "z",
        ),
        slab(0.026 + g, (-0.53, -0.42), (0.045, 0.095)),
    )
    for k, x in enumerate(spread(keys, -0.67, 0.67)):
        b.part(f"key_{k + 1}", box((x - w / 2 + g / 2, -0.78, 0.805), (x + w / 2 - g / 2, -0.503, 0.822)), look="white")
        if k % 7 not in (2, 6) and k + 1 < keys:
            b.cut(f"key_{k + 1}", box((x + 0.22 * w, -0.69, 0.75), (x + w, 0, 0.9)))
        if k and (k - 1) % 7 not in (2, 6):
            b.cut(f"key_{k + 1}", box((x - w, -0.69, 0.75), (x - 0.22 * w, 0, 0.9)))
            b.part(
                f"black_key_{k}", box((x - 0.78 * w + g, -0.68, 0.807), (x - 0.22 * w - g, -0.503, 0.834)), look="black"
            )
            b.hinge(f"black_key_{k}", "body", X, (x, -0.503, 0.809), 0.045, ajar=False)
        b.hinge(f"key_{k + 1}", "body", X, (x, -0.503, 0.809), 0.045, ajar=False)
    b.part("pedal", slab(0.025, (-0.6, -0.425), (0.065, 0.077)), look="brass")
    b.hinge("pedal", "body", X, (0, -0.43, 0.071), 0.1, ajar=False)
    b.part(
        "lid",
        prism(
            [(-0.73, -0.55), (0.75, -0.55), (0.75, -0.1), (0.6, 0.2), (0.2, 0.5), (-0.1, 1), (-0.4, 1.1), (-0.73, 1)],
            (0, 0, 0.964),
            0.02,
            "z",
        ),
        b.cylinder(0.018, -0.78, (-0.3, 0.9), 0.96),
        box((-0.78, -0.3, 0.964), (-0.72, 0.9, 0.979)),
        look="black wood",
    )
    b.cut("lid", b.cylinder(0.01 + g, -0.78, (-2, 2), 0.96))
    b.hinge("lid", "body", -Y, (-0.78, 0.3, 0.96), 0.7)
