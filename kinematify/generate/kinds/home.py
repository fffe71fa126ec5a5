"""Things of a home: lamps, blinds, windows, doors."""

from __future__ import annotations

from math import cos, sin

from kinematify.generate.library.kind import kind, whole
from kinematify.generate.library.mechanisms import knob, legs, lever
from kinematify.generate.library.panels import drawer, leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, prism, slab


@kind("door handle", words="door lever, door fitting, lock fitting", size=(0.9, 1.1))
def lever_handle(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("plate", p.slab(0.022, (0, 0.008), 0.12), look="brass")
    lever(b, "lever", "plate", p(0, 0, 0.05), -Y, X, 0.12 * size, reach=0.6, material="brass")
    b.bore("plate", p.cylinder(0.008, 0, (-0.1, 0.1), -0.05))
    b.part(
        "key",
        p.cylinder(0.0068, 0, (-0.001, 0.007), -0.05),
        p.cylinder(0.003, 0, (-0.02, 0.03), -0.05),
        p.torus(0.012, 0.003, (0, -0.033, -0.05), X),
        p.slab(0.002, (0.018, 0.03), (-0.062, -0.05)),
        look="steel",
    )
    b.hinge("key", "plate", -Y, p(0, 0, -0.05), 1.57, -1.57)


@kind(words="rim lock, latch lock, dead lock, spring latch, night latch, deadbolt, door lock", size=(0.8, 1.2))
def mortise_lock(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("case", p.slab(0.04, 0.012, 0.08), p.slab((0.04, 0.045), 0.015, 0.1), look="steel")
    b.cut("case", p.slab((-0.03, 0.1), 0.0085, (-0.0465, -0.0185)), p.slab((-0.03, 0.1), 0.0065, (0.0335, 0.0565)))
    b.part("bolt", p.slab((-0.02, 0.047), 0.0075, (-0.0455, -0.0195)), look="brass")
    b.slide("bolt", "case", X, 0.02)
    b.part("latch", p.slab((-0.01, 0.06), 0.0055, (0.0345, 0.0555)), look="brass")
    b.cut("latch", p.beam(0.02, 0.04, (0.045, -0.02, 0.045), (0.08, 0.005, 0.045), Z))
    b.slide("latch", "case", -X, 0.014)
    knob(b, "knob", "case", p(0, -0.012, 0.005), 0.016 * size, -Y, high=0.03 * size, reach=1.6, material="brass")


@kind(words="castle gate", width=(1.2, 3.0), height=(1.5, 3.0))
def portcullis(b: ObjectBuilder, width: float, height: float) -> None:
    w = width / 2
    b.part(
        "wall",
        [slab((s * w, s * (w + 0.4)), 0.15, (0, 2.1 * height)) for s in (-1, 1)],
        slab(w, 0.15, (2 * height, 2.1 * height)),
        slab(w, (0.06, 0.15), (height, 1.1 * height)),
        look="grey ceramic",
    )
    b.cut("wall", [slab((s * (w - 0.001), s * (w + 0.08)), 0.05, (0, 1.98 * height)) for s in (-1, 1)])
    b.part(
        "gate",
        [box((x - 0.03, -0.03, 0), (x + 0.03, 0, height)) for x in spread(7, -w, w)],
        [slab(w + 0.07, (0, 0.03), (z - 0.03, z + 0.03)) for z in spread(5, 0.1, height)],
        look="black steel",
    )
    b.slide("gate", "wall", Z, 0.9 * height)


@kind(
    words="driveway gate, sliding driveway gate, yard sliding gate, factory gate", width=(2.0, 4.0), height=(1.0, 1.8)
)
def sliding_gate(b: ObjectBuilder, width: float, height: float) -> None:
    w = width / 2
    b.part(
        "posts",
        [slab((x - 0.1, x + 0.1), 0.1, (0, height + 0.1)) for x in (-w - 0.12, w + 0.12)],
        box((-w - 0.02, -0.16, 0), (2.9 * w, -0.11, 0.04)),
        [box((x - 0.08, -0.155, 0), (x + 0.08, -0.1, 0.03)) for x in (-w - 0.1, w + 0.1)],
        look="black steel",
    )
    b.part(
        "gate",
        box((-w - 0.1, -0.16, 0.045), (w + 0.05, -0.11, 0.15)),
        box((-w - 0.1, -0.16, height - 0.06), (w + 0.05, -0.11, height)),
        [box((x - 0.012, -0.15, 0.1), (x + 0.012, -0.12, height - 0.03)) for x in spread(14, -w, w)],
        look="black steel",
    )
    b.slide("gate", "posts", X, 0.85 * width)


@kind(
    words="split air conditioner, air conditioning unit",
    width=(0.5, 0.9),
    number=whole(1, 6, default=2, usual=(1, 4), words="louver, louvre, vane, flap"),
)
def air_conditioner(b: ObjectBuilder, width: float, number: int) -> None:
    w = width / 2
    b.part("case", slab(w, (0, 0.22), (0, 0.28)), look="white")
    b.cut("case", slab(w - 0.03, (-0.1, 0.14), (0.02, 0.12)), slab(w - 0.01, (0.02, 0.21), (0.14, 0.27)))
    for k, z in enumerate(spread(number, 0.02, 0.12)):
        b.part(f"louver_{k}", slab(w - 0.032, (-0.005, 0.02), (z - 0.002, z + 0.002)), look="grey")
        b.hinge(f"louver_{k}", "case", X, (0, 0.008, z), 0.35, -0.35)
        if k:
            b.follow(f"louver_{k}", "louver_0", 1)


@kind("cat litter box", walls=4, width=(0.35, 0.55))
def litter_box(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part("box", slab(w, 0.25, (0, 0.4)), look="grey")
    b.cut("box", slab(w - 0.006, 0.244, (0.006, 1)), slab(0.12, (-1, 0), (0.12, 0.34)))
    b.part("lid", slab(w, 0.25, (0.401, 0.42)), slab(0.08, 0.02, (0.42, 0.46)), look="blue")
    b.cut("lid", slab(0.06, 0.1, (0.42, 0.445)))
    b.hinge("lid", "box", -X, (0, 0.25, 0.401), 1.5)
    b.part("flap", slab(0.118, (-0.2485, -0.2455), (0.122, 0.335)), look="glass")
    b.hinge("flap", "box", X, (0, -0.247, 0.335), 0.9, -0.9)


@kind(words="rodent cage, hamster cage with a wheel, mouse cage", width=(0.4, 0.7))
def hamster_cage(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "cage",
        slab(w, 0.18, (0, 0.08)),
        slab(w, 0.18, (0.38, 0.39)),
        [b.cylinder(0.003, x, y, (0.07, 0.385)) for x in spread(9, -w, w) for y in (-0.175, 0.175)],
        [b.cylinder(0.003, x, y, (0.07, 0.385)) for x in (-w + 0.005, w - 0.005) for y in (-0.1, 0, 0.1)],
        [box((0.3 * w - 0.01, 0.075, 0.07), (0.3 * w + 0.01, 0.09, 0.22)) for k in (1,)],
        b.cylinder(0.006, 0.3 * w, (0.08, -0.05), 0.2),
        look="blue",
    )
    b.cut("cage", slab(w - 0.006, 0.174, (0.008, 0.079)), box((-0.8 * w, -0.2, 0.09), (-0.3 * w, -0.1, 0.3)))
    b.part(
        "wheel",
        b.tube(0.1, 0.092, 0.3 * w, (0.06, -0.04), 0.2),
        b.cylinder(0.1, 0.3 * w, (0.066, 0.058), 0.2),
        look="yellow",
    )
    b.cut("wheel", b.cylinder(0.0075, 0.3 * w, (-1, 1), 0.2))
    b.spin("wheel", "cage", Y, (0.3 * w, 0, 0.2))
    b.part("door", box((-0.82 * w, -0.185, 0.085), (-0.28 * w, -0.1805, 0.305)), look="metal")
    b.hinge("door", "cage", X, (0, -0.185, 0.085), 1.5)


@kind(
    words="coat hook rail, hook rail, coat hooks, folding hooks, wall hooks, key rack",
    number=whole(1, 12, default=4, usual=(3, 6), words="hook, peg"),
)
def coat_rack(b: ObjectBuilder, number: int) -> None:
    w = 0.06 * number
    b.part("board", slab(w, (0, 0.02), (0, 0.12)), look="wood")
    for k, x in enumerate(spread(number, -w, w)):
        b.part("board", [box((x + s * 0.012, -0.02, 0.03), (x + s * 0.017, 0.005, 0.05)) for s in (-1, 1)])
        b.part(f"hook_{k}", box((x - 0.011, -0.016, 0.032), (x + 0.011, -0.006, 0.1)), look="metal")
        b.hinge(f"hook_{k}", "board", X, (x, -0.011, 0.04), 1.2)


@kind(
    words="tilting shoe cabinet, tilt out cabinet, laundry cabinet, tilt out bin",
    rows=whole(1, 4, words="flap, compartment"),
    width=(0.5, 0.9),
    drawers=whole(0, 1, words="drawer"),
)
def shoe_cabinet(b: ObjectBuilder, rows: int, width: float, drawers: int) -> None:
    w = width / 2
    h = 0.36 * rows + 0.1
    top = h + 0.14 * drawers
    b.part(
        "cabinet",
        [box((s * w, 0, 0), (s * (w - 0.018), 0.2, top)) for s in (-1, 1)],
        slab(w, (0.19, 0.2), (0, top)),
        slab(w, (-0.02, 0.2), (top, top + 0.018)),
        slab(w, (0, 0.2), (0, 0.06)),
        look="white wood",
    )
    if drawers:
        b.part("cabinet", slab(w, (0, 0.2), (h - 0.009, h + 0.009)))
        drawer(b, "drawer", "cabinet", (-w + 0.018, -0.018, h + 0.012), (w - 0.018, 0.18, top - 0.003), material="wood")
    for k, z in enumerate(spread(rows, 0.07, h - 0.01)):
        half = (h - 0.08) / rows / 2
        b.part(
            f"flap_{k}",
            slab(w, (-0.018, -0.001), (z - half + 0.004, z + half - 0.004)),
            slab(w - 0.022, (-0.002, 0.12), (z - half + 0.004, z - half + 0.014)),
            slab(0.05, (-0.035, -0.017), (z + half - 0.05, z + half - 0.04)),
            look="wood",
        )
        b.hinge(f"flap_{k}", "cabinet", X, (0, -0.018, z - half + 0.004), 0.7)


@kind(words="photo frame, easel frame", width=(0.1, 0.3), height=(0.13, 0.4))
def picture_frame(b: ObjectBuilder, width: float, height: float) -> None:
    b.part("frame", slab(width / 2, (0, 0.012), (0, height)), look="wood")
    b.cut("frame", slab(0.42 * width, (-1, 0.005), (0.08 * height, 0.92 * height)))
    b.part("stand", slab(0.12 * width, (0.0125, 0.016), (0.05 * height, 0.75 * height)), look="black cardboard")
    b.hinge("stand", "frame", X, (0, 0.0125, 0.75 * height), 0.6)


@kind(
    words="extending table, extendable table, dining table with extension, telescopic table, pull out table",
    width=(1.0, 1.8),
    depth=(0.7, 1.0),
)
def extension_table(b: ObjectBuilder, width: float, depth: float) -> None:
    w = width / 2
    t = depth / 2
    legs(b, "table", (-w + 0.05, -t + 0.05, 0), (w - 0.05, t - 0.05, 0.7), 0.07)
    b.part(
        "table",
        slab(w, t, (0.725, 0.75)),
        [slab(w - 0.06, (s * (t - 0.06), s * (t - 0.1)), (0.63, 0.7)) for s in (-1, 1)],
        [box((-w + 0.06, s * (t - 0.06), 0.69), (-w + 0.12, s * (t - 0.1), 0.726)) for s in (-1, 1)],
        [box((w - 0.12, s * (t - 0.06), 0.69), (w - 0.06, s * (t - 0.1), 0.726)) for s in (-1, 1)],
        look="wood",
    )
    for k, s in enumerate((-1, 1)):
        b.part(f"leaf_{k}", slab((s * 0.03, s * (w + 0.01)), t - 0.12, (0.702, 0.723)), look="wood")
        b.slide(f"leaf_{k}", "table", s * X, 0.7 * w)


@kind(
    "coffee table with drawer",
    words="lift top coffee table, coffee table",
    width=(0.8, 1.2),
    depth=(0.5, 0.7),
)
def lift_top_table(b: ObjectBuilder, width: float, depth: float) -> None:
    w = width / 2
    t = depth / 2
    b.part("body", slab(w, t, (0.12, 0.42)), look="wood")
    legs(b, "body", (-w, -t, 0), (w, t, 0.125), 0.06)
    b.cut("body", slab(w - 0.02, t - 0.02, (0.28, 1)))
    drawer(b, "drawer", "body", (-0.4 * width, -t, 0.14), (0.4 * width, 0.6 * t, 0.25))
    b.part(
        "top",
        slab(w, t, (0.421, 0.445)),
        [slab((s * 0.8 * w - 0.02, s * 0.8 * w + 0.02), 0.05, (0.29, 0.422)) for s in (-1, 1)],
        look="wood",
    )
    b.slide("top", "body", Z, 0.12)


@kind(
    "adjustable headrest chair",
    words="train seat, bus seat, gaming seat, car seat with a headrest, car seat, airplane seat",
    size=(0.9, 1.1),
)
def passenger_seat(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "seat",
        p.slab(0.26, 0.25, (0.25, 0.42)),
        [p.slab((s * 0.2 - 0.03, s * 0.2 + 0.03), 0.2, (0, 0.26)) for s in (-1, 1)],
        [p.box((s * 0.31, -0.2, 0.3), (s * 0.27, 0.34, 0.62)) for s in (-1, 1)],
        [p.slab((s * 0.28, s * 0.25), 0.1, (0.27, 0.4)) for s in (-1, 1)],
        look="grey",
    )
    b.part("back", p.slab(0.26, (0.255, 0.37), (0.35, 1)), look="blue")
    b.cut("back", [p.cylinder(0.009, s * 0.08, 0.31, (0.8, 2)) for s in (-1, 1)])
    b.hinge("back", "seat", -X, p(0, 0.31, 0.36), 0.4, 0)
    b.part(
        "headrest",
        p.slab(0.14, (0.26, 0.36), (1.03, 1.22)),
        [p.cylinder(0.007, s * 0.08, 0.31, (0.83, 1.04)) for s in (-1, 1)],
        look="blue",
    )
    b.slide("headrest", "back", Z, 0.1, lower=-0.02)


@kind(words="bollard, traffic post, folding parking post, parking lock", height=(0.5, 0.9))
def parking_bollard(b: ObjectBuilder, height: float) -> None:
    b.part(
        "base",
        slab(0.2, 0.2, (0, 0.02)),
        [slab((s * 0.055, s * 0.068), 0.04, (0.01, 0.12)) for s in (-1, 1)],
        look="black steel",
    )
    b.part(
        "post",
        slab(0.05, 0.04, (0.035, height)),
        slab(0.0501, 0.0401, (0.7 * height, 0.8 * height)),
        look="yellow steel",
    )
    b.hinge("post", "base", X, (0, 0.0, 0.095), 0.7, -0.7)


@kind(words="cash machine, cash dispenser", width=(0.5, 0.8))
def atm(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "case",
        prism([(-0.3, 0), (0.3, 0), (0.3, 1.6), (-0.1, 1.6), (-0.15, 1), (-0.3, 0.9)], (0, 0, 0), width, "x"),
        look="blue steel",
    )
    b.cut(
        "case",
        slab(w - 0.03, 0.28, (0.05, 0.75)),
        slab(0.35 * width, (-0.4, -0.2), (0.1, 0.65)),
        slab(0.12, (-0.5, -0.22), (0.78, 0.86)),
    )
    leaf(
        b,
        "door",
        "case",
        (-0.36 * width, -0.32, 0.08),
        (0.36 * width, -0.301, 0.67),
        hinge=X,
        reach=1.8,
        material="steel",
    )
    b.part("flap", slab(0.118, (-0.309, -0.301), (0.775, 0.858)), look="black")
    b.hinge("flap", "case", -X, (0, -0.309, 0.858), 1.2)


@kind(words="cargo container, container with doors, freight container, sea container")
def shipping_container(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.1)
    p = b.sized(size)
    b.part(
        "container",
        p.slab(1.2, (0, 6), (0, 2.5)),
        [p.box((s * 1.2, y - 0.05, 0.1), (s * 1.23, y + 0.05, 2.4)) for s in (-1, 1) for y in spread(12, 0.2, 5.8)],
        look="dark blue steel",
    )
    b.cut("container", p.slab(1.15, (-1, 5.95), (0.1, 2.42)))
    for k, s in enumerate((-1, 1)):
        b.part(
            f"door_{k}",
            p.box((s * 0.01, -0.06, 0.02), (s * 1.2, -0.005, 2.48)),
            [p.box((s * 0.3 - 0.06, -0.13, z - 0.05), (s * 0.3 + 0.06, -0.05, z + 0.05)) for z in (0.4, 2.1)],
            look="dark blue steel",
        )
        b.cut(f"door_{k}", p.cylinder(0.0225, s * 0.3, -0.1, (-1, 3)))
        b.hinge(f"door_{k}", "container", s * Z, p(s * 1.2, -0.06, 0), 2.0)
        b.part(
            f"bar_{k}",
            p.cylinder(0.02, s * 0.3, -0.1, (0.03, 2.47)),
            p.box((s * 0.3, -0.12, 1.1), (s * 0.6, -0.09, 1.16)),
            look="steel",
        )
        b.hinge(f"bar_{k}", f"door_{k}", -s * Z, p(s * 0.3, -0.1, 0), 1.2)


@kind(words="throttle valve, throttle body, damper flap, air damper", radius=(0.03, 0.12))
def butterfly_valve(b: ObjectBuilder, radius: float) -> None:
    r = radius
    b.part(
        "body",
        b.tube(1.25 * r, r, 0, (-0.4 * r, 0.4 * r), 0),
        [b.tube(1.5 * r, r, 0, (y - 0.06 * r, y + 0.06 * r), 0) for y in (-0.4 * r, 0.4 * r)],
        b.cylinder(0.2 * r, 1.2 * r, 1.6 * r),
        look="blue steel",
    )
    b.bore("body", b.cylinder(0.115 * r, -1.15 * r, 3 * r))
    b.part(
        "disc",
        b.cylinder(0.96 * r, 0, (-0.05 * r, 0.05 * r), 0),
        b.cylinder(0.1 * r, -1.1 * r, 1.9 * r),
        beam(0.2 * r, 0.12 * r, (0, 0, 1.8 * r), (1.8 * r, 0, 1.8 * r)),
        look="steel",
    )
    b.hinge("disc", "body", Z, (0, 0, 0), 1.5, -1.5)


@kind(walls=100, words="hydrant", size=(0.9, 1.1))
def fire_hydrant(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.cylinder(0.14, 0, 0.05),
        p.cylinder(0.1, 0.04, 0.6),
        p.ball(0.1, (0, 0, 0.6)),
        [p.cylinder(0.06, (s * 0.05, s * 0.15), 0, 0.45) for s in (-1, 1)],
        p.cylinder(0.025, 0.68, 0.72),
        look="red steel",
    )
    b.cut("body", p.cylinder(0.085, 0.06, 0.6))
    for k, s in enumerate((-1, 1)):
        b.part(
            f"cap_{k}",
            p.cylinder(0.07, (s * 0.151, s * 0.185), 0, 0.45),
            p.slab((s * 0.18, s * 0.215), 0.015, (0.435, 0.465)),
            look="yellow steel",
        )
        b.spin(f"cap_{k}", "body", s * X, p(0, 0, 0.45))
    b.part("valve", p.cylinder(0.04, 0.721, 0.75), p.slab(0.012, 0.012, (0.74, 0.78)), look="red steel")
    b.spin("valve", "body", Z, p(0, 0, 0))


@kind(words=("rotary clothes line, rotary washing line, rotary airer, rotary dryer, hills hoist"), height=(1.5, 2.0))
def rotary_clothesline(b: ObjectBuilder, height: float) -> None:
    b.part("post", b.cylinder(0.15, 0, 0.03), b.cylinder(0.022, 0.02, height), look="steel")
    b.part(
        "head",
        b.tube(0.04, 0.0245, height - 0.25, height),
        b.cylinder(0.04, height + 0.001, height + 0.04),
        b.tube(0.04, 0.0245, height - 0.01, height + 0.01),
        [
            beam(0.02, 0.02, (0.03 * cos(a), 0.03 * sin(a), height - 0.1), (0.9 * cos(a), 0.9 * sin(a), height + 0.3))
            for a in (0, 1.5708, 3.1416, 4.7124)
        ],
        [
            beam(
                0.006,
                0.006,
                (q * cos(a), q * sin(a), height - 0.1 + 0.46 * q),
                (q * cos(a + 1.5708), q * sin(a + 1.5708), height - 0.1 + 0.46 * q),
            )
            for q in (0.4, 0.6, 0.85)
            for a in (0, 1.5708, 3.1416, 4.7124)
        ],
        look="metal",
    )
    b.spin("head", "post", Z, (0, 0, 0))


@kind(words="parrot cage, budgie cage", width=(0.3, 0.6), height=(0.45, 0.9))
def birdcage(b: ObjectBuilder, width: float, height: float) -> None:
    """Bars on a tray under a roof, a door in front, a swing inside."""
    w = width / 2
    top = height
    low = 0.25 * height
    high = 0.6 * height
    half = 0.3 * width
    b.part(
        "cage",
        slab(w, w, (0, 0.03)),
        slab(w, w, (top, top + 0.015)),
        [
            b.cylinder(0.003, x, s * (w - 0.005), (0.02, top + 0.01))
            for x in spread(9, -w, w)
            for s in (-1, 1)
            if s > 0 or abs(x) > half
        ],
        [b.cylinder(0.003, s * (w - 0.005), y, (0.02, top + 0.01)) for y in spread(9, -w, w) for s in (-1, 1)],
        [
            b.cylinder(0.003, x, 0.005 - w, (a, b_))
            for x in spread(9, -w, w)
            if abs(x) <= half
            for a, b_ in ((0.02, low), (high, top + 0.01))
        ],
        [slab(half + 0.01, (-w, 0.01 - w), (z - 0.006, z + 0.006)) for z in (low, high)],
        [box((s * half - 0.006, -w, low), (s * half + 0.006, 0.01 - w, high)) for s in (-1, 1)],
        [slab(w, (y - 0.01, y + 0.01), (top - 0.01, top + 0.001)) for y in [0]],
        look="steel",
    )
    leaf(b, "door", "cage", (-half, -w - 0.008, low), (half, -w, high), hinge=-X, reach=2.0)
    z = top - 0.02
    arm = 0.35 * w
    b.part(
        "swing",
        [b.cylinder(0.003, s * arm, 0, (z, 0.45 * height)) for s in (-1, 1)],
        b.cylinder(0.006, (-1.2 * arm, 1.2 * arm), 0, 0.45 * height),
        b.cylinder(0.004, (-arm, arm), 0, z),
        look="wood",
    )
    b.hinge("swing", "cage", X, (0, 0, z), 0.5, -0.5, ajar=False)
