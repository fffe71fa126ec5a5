"""Mechanisms of a textbook: linkages, gears, joints."""

from __future__ import annotations

from math import cos, pi, sin, tan

from kinematify.generate.library.kind import kind, whole
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, prism, slab, vector


@kind(
    words=(
        "scissor lift table, scissor jack, scissor platform, lab jack, pantograph lift, hydraulic lift table, "
        "lift table, platform lift, lifting platform"
    ),
    length=(0.3, 1.4),
    stages=whole(1, 4),
)
def scissor_lift(b: ObjectBuilder, length: float, stages: int) -> None:
    L = length
    q = 0.35
    t = 0.03 * L
    a = 0.22 * L
    z0 = 0.09 * L
    b.part(
        "base",
        slab(0.56 * L, 0.32 * L, (0, 0.04 * L)),
        [
            box(
                (-0.5 * L - 0.04 * L, s * (a - 2.2 * t), 0.03 * L),
                (-0.5 * L + 0.04 * L, s * (a - 1.2 * t), z0 + 0.04 * L),
            )
            for s in (-1, 1)
        ],
        look="yellow steel",
    )
    c = cos(q)
    height = sin(q)
    top = "base"
    foot = vector(-0.5 * L * c, 0, z0)
    b.cut("base", b.cylinder(0.0135 * L, foot - L * Y, foot + L * Y))
    lift = 0.0
    for k in range(stages):
        foot = vector(-0.5 * L * c, 0, z0 + k * L * height)
        middle = foot + vector(0.5 * L * c, 0, 0.5 * L * height)
        end = foot + vector(0, 0, L * height)
        b.part(
            f"arm_{k}",
            [beam(0.05 * L, t, foot + s * a * Y, foot + vector(L * c, 0, L * height) + s * a * Y, Y) for s in (-1, 1)],
            b.cylinder(0.012 * L, foot - (a + 1.2 * t if k else a) * Y, foot + (a + 1.2 * t if k else a) * Y)
            if k == 0
            else b.cylinder(0.012 * L, middle - a * Y, middle + a * Y),
            b.cylinder(0.012 * L, middle - (a + 1.6 * t) * Y, middle + (a + 1.6 * t) * Y),
            [b.cylinder(0.025 * L, foot + s * (a - 0.5 * t) * Y, foot + s * (a + 0.5 * t) * Y) for s in (-1, 1)],
            [
                b.cylinder(
                    0.025 * L,
                    foot + vector(L * c, 0, L * height) + s * (a - 0.5 * t) * Y,
                    foot + vector(L * c, 0, L * height) + s * (a + 0.5 * t) * Y,
                )
                for s in (-1, 1)
            ],
            look="grey steel",
        )
        b.hinge(f"arm_{k}", top, -Y, foot, 1.0 if k else 0.5, -0.4 if k else -0.2)
        if k:
            b.cut(f"arm_{k}", b.cylinder(0.0135 * L, foot - L * Y, foot + L * Y))
            b.follow(f"arm_{k}", "arm_0", 2)
        b.part(
            f"cross_{k}",
            [
                beam(
                    0.05 * L,
                    t,
                    middle + vector(0.5 * L * c, 0, -0.5 * L * height) + s * (a + 1.3 * t) * Y,
                    end + s * (a + 1.3 * t) * Y,
                    Y,
                )
                for s in (-1, 1)
            ],
            b.cylinder(0.012 * L, end - (a + 1.3 * t) * Y, end + (a + 1.3 * t) * Y),
            [b.cylinder(0.025 * L, end + s * (a + 0.8 * t) * Y, end + s * (a + 1.8 * t) * Y) for s in (-1, 1)],
            look="grey steel",
        )
        b.cut(f"cross_{k}", b.cylinder(0.0135 * L, middle - L * Y, middle + L * Y))
        b.hinge(f"cross_{k}", f"arm_{k}", Y, middle, 1.2, -0.6)
        b.follow(f"cross_{k}", "arm_0", 2)
        top = f"cross_{k}"
        lift = z0 + (k + 1) * L * height
    end = vector(-0.5 * L * c, 0, lift)
    b.part(
        "platform",
        slab(0.56 * L, 0.32 * L, (lift + 0.05 * L, lift + 0.09 * L)),
        [
            box(
                (-0.5 * L - 0.03 * L, s * (a - 2.4 * t), lift - 0.03 * L),
                (-0.5 * L + 0.05 * L, s * (a - 1.2 * t), lift + 0.06 * L),
            )
            for s in (-1, 1)
        ],
        look="yellow steel",
    )
    b.cut("platform", b.cylinder(0.0135 * L, end - L * Y, end + L * Y))
    b.hinge("platform", top, -Y, end, 0.6, -0.3)
    b.follow("platform", "arm_0", 1)


@kind(
    words="slider crank, piston engine, single cylinder engine, crank mechanism, reciprocating engine",
    radius=(0.03, 0.08),
)
def crank_slider(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    l = 3.5 * r
    b.part(
        "frame",
        p.box((-1.6, 0, -1.8), (6.4, 0.3, -1.4)),
        p.slab(0.4, (0, 0.3), (-1.5, 0.4)),
        [p.slab((2.2, 6.4), 0.3, (s * 0.42, s * 0.62)) for s in (-1, 1)],
        p.box((6, 0, -1.5), (6.4, 0.3, 0.6)),
        p.slab((2.2, 6.4), (0.1, 0.3), 0.6),
        look="grey steel",
    )
    b.bore("frame", p.cylinder(0.22, 0, (-1, 1), 0))
    b.part(
        "crank",
        p.cylinder(0.2, 0, (-0.3, 0.5), 0),
        p.cylinder(1.25, 0, (-0.3, -0.05), 0),
        p.cylinder(0.16, 1, (-0.6, -0.25), 0),
        look="red steel",
    )
    b.spin("crank", "frame", -Y, (0, 0, 0))
    b.part(
        "rod",
        beam(0.3 * r, 0.22 * r, (r, -0.45 * r, 0), (r + l, -0.45 * r, 0), Y),
        p.cylinder(0.3, 1, (-0.56, -0.34), 0),
        b.cylinder(0.25 * r, r + l, (-0.56 * r, -0.34 * r), 0),
        look="metal",
    )
    b.cut("rod", b.cylinder(0.18 * r, r, (-1, 1), 0))
    b.spin("rod", "crank", -Y, (r, 0, 0))
    b.part(
        "piston",
        slab((r + l - 0.3 * r, r + l + 0.7 * r), (-0.3 * r, 0.06 * r), 0.4 * r),
        b.cylinder(0.16 * r, r + l, (-0.335 * r, -0.2 * r), 0),
        look="metal",
    )
    b.slide("piston", "frame", -X, 2.05 * r, lower=-0.02 * r)
    b.close("piston", "rod", (r + l, -0.45 * r, 0))


@kind(words="four bar mechanism, parallelogram linkage, parallel linkage", length=(0.12, 0.3))
def four_bar_linkage(b: ObjectBuilder, length: float) -> None:
    L = length
    t = 0.04 * L
    h = 0.5 * L
    b.part(
        "ground",
        slab((-0.15 * L, 1.15 * L), (0, t), 0.06 * L),
        [b.cylinder(0.03 * L, x, (-1.3 * t, t), 0) for x in (0, L)],
        look="black steel",
    )
    for name, x in (("crank", 0), ("rocker", L)):
        b.part(
            name,
            beam(0.07 * L, t, (x, -0.7 * t, 0), (x, -0.7 * t, h), Y),
            b.cylinder(0.05 * L, x, (-1.2 * t, -0.2 * t), 0),
            b.cylinder(0.05 * L, x, (-1.2 * t, -0.2 * t), h),
            b.cylinder(0.025 * L, x, (-2.6 * t, -0.5 * t), h),
            look=("metal", f"{'red' if x == 0 else 'blue'}"),
        )
        b.cut(name, b.cylinder(0.0325 * L, x, (-1, 1), 0))
        b.hinge(name, "ground", Y, (x, 0, 0), 0.9, -0.9)
    b.follow("rocker", "crank", 1)
    b.part(
        "coupler",
        beam(0.07 * L, t, (0, -2 * t, h), (L, -2 * t, h), Y),
        [b.cylinder(0.05 * L, x, (-2.5 * t, -1.5 * t), h) for x in (0, L)],
        look="metal",
    )
    b.cut("coupler", [b.cylinder(0.028 * L, x, (-1, 1), h) for x in (0, L)])
    b.hinge("coupler", "crank", -Y, (0, 0, h), 0.9, -0.9)
    b.follow("coupler", "crank", 1)
    b.close("coupler", "rocker", (L, -2 * t, h))


@kind(
    words="geneva mechanism, maltese cross, indexing mechanism",
    radius=(0.04, 0.09),
    slots=whole(4, 8, default=4, words="slot, station, position"),
)
def geneva_drive(b: ObjectBuilder, radius: float, slots: int) -> None:
    """The pin of the driver moves the wheel by contact alone, since its ratio changes; no joint couples them."""
    r = radius
    c = r / sin(pi / slots)
    rim = r / tan(pi / slots)
    half = max(1.4 * r, rim + 0.4 * r)
    step = 2 * pi / slots
    b.part(
        "plate",
        slab((-half, c + 1.5 * r), (0, 0.12 * r), half),
        [b.cylinder(0.14 * r, x, (-0.5 * r, 0.02 * r), 0) for x in (0, c)],
        look="steel",
    )
    b.part("wheel", b.cylinder(0.95 * rim, 0, (-0.28 * r, -0.05 * r), 0), look="brass")
    b.cut(
        "wheel",
        [
            beam(
                0.19 * r,
                0.4 * r,
                ((c - 1.15 * r) * cos(b_), -0.15 * r, (c - 1.15 * r) * sin(b_)),
                (1.5 * rim * cos(b_), -0.15 * r, 1.5 * rim * sin(b_)),
                Y,
            )
            for b_ in [(0.5 + k) * step for k in range(slots)]
        ],
        [b.cylinder(0.62 * r, c * cos(b_), (-r, r), c * sin(b_)) for b_ in [step * k for k in range(slots)]],
        b.cylinder(0.155 * r, 0, (-r, r), 0),
    )
    b.spin("wheel", "plate", -Y, (0, 0, 0))
    b.part(
        "driver",
        b.cylinder(1.1 * r, c, (-0.45 * r, -0.3 * r), 0),
        b.cylinder(0.58 * r, c, (-0.31 * r, -0.285 * r), 0),
        b.rod(0.1 * r, c + 0.6 * r, (-0.44 * r, -0.9 * r), 0),
        look="red steel",
    )
    b.cut("driver", b.cylinder(0.155 * r, c, (-2 * r, r), 0), slab((c, c + 0.7 * r), (-0.305 * r, 0), 0.4 * r))
    b.part("driver", b.cylinder(0.08 * r, c + r, (-0.31 * r, -0.285 * r), 0))
    b.spin("driver", "plate", -Y, (c, 0, 0))


@kind(
    words="planetarium model, solar system model, tellurion, model of the solar system",
    number=whole(1, 8, default=5, usual=(3, 8), words="planet"),
    size=(0.8, 1.4),
)
def orrery(b: ObjectBuilder, number: int, size: float) -> None:
    p = b.sized(size)
    b.part("base", p.cylinder(0.1, 0, 0.02), p.cylinder(0.006, 0.01, 0.36), p.ball(0.035, (0, 0, 0.38)), look="brass")
    for k in range(number):
        x = 0.07 + 0.035 * k
        z = 0.3 - 0.03 * k
        r = (0.008, 0.011, 0.012, 0.01, 0.022, 0.019, 0.015, 0.014)[k]
        a = 2.4 * k
        b.part(
            f"planet_{k}",
            p.tube(0.014, 0.0075, z, z + 0.018),
            p.beam(0.005, 0.005, (0.009 * cos(a), 0.009 * sin(a), z + 0.009), (x * cos(a), x * sin(a), z + 0.009)),
            p.cylinder(0.0025, x * cos(a), x * sin(a), (z + 0.007, 0.375)),
            p.ball(r, (x * cos(a), x * sin(a), 0.38)),
            look="brass",
        )
        b.spin(f"planet_{k}", "base", Z, p(0, 0, 0))


@kind(words="slotted link mechanism", radius=(0.03, 0.08))
def scotch_yoke(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    b.part("frame", p.slab((-2.2, 4.2), (0.05, 0.25), 2), p.slab((3.4, 3.8), (-1, 0.06), 0.35), look="grey steel")
    b.bore("frame", p.cylinder(0.21, 0, (-1, 1), 0), p.slab((2, 5), (-0.87, -0.53), 0.17))
    b.part(
        "crank",
        p.cylinder(0.18, 0, (-0.2, 0.4), 0),
        p.cylinder(1.25, 0, (-0.3, -0.02), 0),
        p.cylinder(0.15, 0, (-0.54, -0.25), 1),
        p.cylinder(0.09, 0, (-0.75, -0.5), 1),
        look="red steel",
    )
    b.spin("crank", "frame", -Y, (0, 0, 0))
    b.part("yoke", p.slab(0.4, (-0.8, -0.55), 1.5), p.slab((0.3, 5), (-0.85, -0.55), 0.15), look="metal")
    b.cut("yoke", p.slab(0.18, (-2, 0), 1.25))
    b.slide("yoke", "frame", X, r, lower=-r)
    b.part("slider", p.slab(0.165, (-0.78, -0.57), (0.8, 1.2)), look="brass")
    b.cut("slider", p.cylinder(0.105, 0, (-1, 0), 1))
    b.slide("slider", "yoke", -Z, 2.01 * r, lower=-0.01 * r)
    b.close("slider", "crank", (0, -0.68 * r, r))


@kind(
    words="rack and pinion gear, gear rack, steering rack, rack and pinion steering, steering gear", radius=(0.02, 0.05)
)
def rack_and_pinion(b: ObjectBuilder, radius: float) -> None:
    r = radius
    n = 14
    b.part(
        "frame",
        slab(5 * r, (0.06 * r, 0.3 * r), (-2.2 * r, 1.4 * r)),
        slab(5 * r, (-0.7 * r, 0.07 * r), (-2.2 * r, -1.72 * r)),
        b.cylinder(0.2 * r, 0, (-0.8 * r, 0.1 * r), 0),
        look="grey steel",
    )
    b.part(
        "pinion",
        b.cylinder(0.88 * r, 0, (-0.6 * r, 0.02 * r), 0),
        [
            beam(0.17 * r, 0.5 * r, (0, -0.3 * r, 0), (1.06 * r * cos(a), -0.3 * r, 1.06 * r * sin(a)), Y)
            for a in [-1.5708 + 6.28318 * k / n for k in range(n)]
        ],
        look="brass",
    )
    b.cut("pinion", b.cylinder(0.22 * r, 0, (-2 * r, r), 0))
    b.hinge("pinion", "frame", -Y, (0, 0, 0), 2.0, -2.0)
    b.part(
        "rack",
        slab(4 * r, (-0.6 * r, 0.02 * r), (-1.7 * r, -1.2 * r)),
        [
            box(
                (6.28318 * r / n * (k + 0.5) - 0.08 * r, -0.6 * r, -1.21 * r),
                (6.28318 * r / n * (k + 0.5) + 0.08 * r, 0.02 * r, -0.98 * r),
            )
            for k in range(-8, 8)
        ],
        look="steel",
    )
    b.slide("rack", "frame", X, 2.0 * r, lower=-2.0 * r)
    b.follow("rack", "pinion", r)


@kind(words="worm drive, worm and wheel", radius=(0.03, 0.08))
def worm_gear(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    b.part(
        "frame",
        p.slab(1.5, (0.45, 0.65), (-2.2, 1.4)),
        p.cylinder(0.2, 0, (-0.4, 0.5), 0),
        [p.box((s * 1.3, -0.3, -1.75), (s * 1.5, 0.5, -1.2)) for s in (-1, 1)],
        look="grey steel",
    )
    b.bore("frame", p.cylinder(0.13, (-2, 2), 0, -1.45))
    b.part(
        "wheel",
        p.cylinder(0.95, 0, (-0.25, 0.25), 0),
        [
            beam(0.08 * r, 0.5 * r, (0, 0, 0), (1.02 * r * cos(a), 0, 1.02 * r * sin(a)), Y)
            for a in [6.28318 * k / 24 for k in range(24)]
        ],
        look="brass",
    )
    b.cut("wheel", p.cylinder(0.22, 0, (-1, 1), 0))
    b.spin("wheel", "frame", -Y, (0, 0, 0))
    b.part(
        "worm",
        p.cylinder(0.11, (-2, 1.5), 0, -1.45),
        p.cylinder(0.3, (-1.1, 1.1), 0, -1.45),
        [p.torus(0.34, 0.06, (x, 0, -1.45), X) for x in (-0.9, -0.6, -0.3, 0, 0.3, 0.6, 0.9)],
        p.cylinder(0.3, (-2.3, -1.9), 0, -1.45),
        look="steel",
    )
    b.spin("worm", "frame", X, (0, 0, -1.45 * r))
    b.follow("wheel", "worm", 0.04)


@kind(words="right angle gearbox, angle drive", radius=(0.03, 0.08))
def bevel_gears(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    b.part(
        "frame",
        p.slab((-1.6, 1.2), 1.2, (-2, -1.8)),
        p.slab((-1.8, -1.6), 1.2, (-2, 0.9)),
        p.cylinder(0.2, -1.81, -1),
        p.cylinder(0.2, (-1.61, -1), 0, 0),
        look="grey steel",
    )
    b.part("gear_0", p.cone(0.95, 0.45, -1, -0.5), p.cylinder(0.35, -1.5, -0.99), look="brass")
    b.cut("gear_0", p.cylinder(0.22, -3, -0.95))
    b.spin("gear_0", "frame", Z, (0, 0, 0))
    b.part(
        "gear_1",
        b.cone(0.95 * r, 0.45 * r, (-r - 0.03 * r, -0.53 * r), 0, 0),
        p.cylinder(0.35, (-1.5, -1), 0, 0),
        look="brass",
    )
    b.cut("gear_1", p.cylinder(0.22, (-3, -0.95), 0, 0))
    b.spin("gear_1", "frame", X, (0, 0, 0))
    b.follow("gear_1", "gear_0", -1)


@kind(
    words=(
        "planetary gear set, planetary gearbox, planetary gear train, epicyclic gearbox, epicyclic gear, sun "
        "and planet gear"
    ),
    radius=(0.04, 0.1),
    number=whole(3, 4, words="planet, planet gear"),
)
def planetary_gear(b: ObjectBuilder, radius: float, number: int) -> None:
    r = radius
    b.part(
        "ring",
        b.tube(r, 0.83 * r, 0, 0.25 * r),
        b.cylinder(r, -0.08 * r, 0),
        b.cylinder(0.07 * r, -0.01 * r, 0.5 * r),
        look="black steel",
    )
    b.part(
        "carrier",
        b.cylinder(0.7 * r, 0.28 * r, 0.36 * r),
        [
            b.cylinder(0.07 * r, 0.55 * r * cos(a), 0.55 * r * sin(a), (0.06 * r, 0.3 * r))
            for a in [6.28318 * k / number for k in range(number)]
        ],
        look="red metal",
    )
    b.cut("carrier", b.cylinder(0.085 * r, -1, 1))
    b.spin("carrier", "ring", Z, (0, 0, 0))
    b.part("sun", b.cylinder(0.27 * r, 0.02 * r, 0.25 * r), look="brass")
    b.cut("sun", b.cylinder(0.085 * r, -1, 1))
    b.spin("sun", "ring", Z, (0, 0, 0))
    b.follow("sun", "carrier", 4)
    for k in range(number):
        a = 6.28318 * k / number
        c = vector(0.55 * r * cos(a), 0.55 * r * sin(a), 0)
        b.part(f"planet_{k}", b.cylinder(0.26 * r, c + 0.02 * r * Z, c + 0.25 * r * Z), look="brass")
        b.cut(f"planet_{k}", b.cylinder(0.085 * r, c - Z, c + Z))
        b.spin(f"planet_{k}", "carrier", Z, c)
        b.follow(f"planet_{k}", "carrier", -3)


@kind("cam and follower", words="cam mechanism", radius=(0.03, 0.06))
def cam_follower(b: ObjectBuilder, radius: float) -> None:
    """The cam lifts the follower by contact alone, and its weight brings it back; no joint couples them."""
    r = radius
    p = b.sized(r)
    b.part(
        "frame",
        p.slab(2, 0.5, (-2, -1.8)),
        [p.slab(0.4, (s * 0.4, s * 0.6), (-1.81, 0.4)) for s in (-1, 1)],
        [p.slab((s * 1.8, s * 2), 0.4, (-1.81, 3.4)) for s in (-1, 1)],
        p.slab(2, 0.4, (3.1, 3.4)),
        look="wood",
    )
    b.bore("frame", p.cylinder(0.17, 0, (-1, 1), 0), p.cylinder(0.17, 3, 4))
    b.part(
        "cam",
        p.cylinder(1, 0, (-0.25, 0.25), 0.3),
        p.cylinder(0.14, 0, (-1.2, 0.7), 0),
        p.beam(0.2, 0.15, (0, -1.15, 0), (1, -1.15, 0), Y),
        p.cylinder(0.12, 0.95, (-1.8, -1.1), 0),
        look="red steel",
    )
    b.spin("cam", "frame", -Y, (0, 0, 0))
    b.part("follower", p.cylinder(0.5, 1.33, 1.5), p.cylinder(0.14, 1.4, 4.2), look="metal")
    b.slide("follower", "frame", Z, 0.9 * r)


@kind(
    "ratchet and pawl",
    words="ratchet wheel, ratchet mechanism",
    radius=(0.03, 0.09),
    number=whole(6, 24, default=12, usual=(8, 16), words="tooth, teeth"),
)
def ratchet(b: ObjectBuilder, radius: float, number: int) -> None:
    """The teeth lift the pawl by contact alone, and its weight brings it back; no joint couples them."""
    r = radius
    p = b.sized(r)
    b.part(
        "plate",
        p.box((-1.3, 0.03, -1.3), (1.5, 0.2, 1.9)),
        p.cylinder(0.15, 0, (-0.5, 0.05), 0),
        p.cylinder(0.08, 0.9, (-0.4, 0.05), 1.3),
        look="grey steel",
    )
    b.part(
        "wheel",
        p.cylinder(0.85, 0, (-0.3, -0.01), 0),
        [
            prism(
                [
                    (0.8 * r * cos(a), 0.8 * r * sin(a)),
                    (r * cos(a + 0.05), r * sin(a + 0.05)),
                    (0.8 * r * cos(a + 5.5 / number), 0.8 * r * sin(a + 5.5 / number)),
                ],
                (0, -0.155 * r, 0),
                0.29 * r,
                "y",
            )
            for a in [6.28318 * k / number for k in range(number)]
        ],
        look="brass",
    )
    b.cut("wheel", p.cylinder(0.17, 0, (-1, 1), 0))
    b.spin("wheel", "plate", Y, (0, 0, 0))
    b.part(
        "pawl",
        p.beam(0.14, 0.2, (0.9, -0.15, 1.3), (0.1, -0.15, 1.25), Y),
        p.cylinder(0.16, 0.9, (-0.25, -0.05), 1.3),
        look="red steel",
    )
    b.cut("pawl", b.cylinder(0.095 * r, 0.9 * r, (-1, 1), 1.3 * r))
    b.hinge("pawl", "plate", Y, (0.9 * r, 0, 1.3 * r), 0.6, -0.03)


@kind(words="cardan joint, u joint, hooke joint", radius=(0.015, 0.05))
def universal_joint(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    b.part(
        "yoke_0",
        p.cylinder(0.5, -5, -2),
        p.slab(1.4, 0.5, (-2.3, -2)),
        [p.slab((s * 1.1, s * 1.4), 0.5, (-2.1, 0.5)) for s in (-1, 1)],
        look="steel",
    )
    b.bore("yoke_0", p.cylinder(0.24, (-2, 2), 0, 0))
    b.part(
        "cross",
        p.cylinder(0.2, (-1.4, 1.4), 0, 0),
        p.cylinder(0.2, 0, (-1.4, 1.4), 0),
        p.ball(0.45, (0, 0, 0)),
        look="black steel",
    )
    b.hinge("cross", "yoke_0", X, (0, 0, 0), 0.6, -0.6)
    b.part(
        "yoke_1",
        p.cylinder(0.5, 2, 5),
        p.slab(0.5, 1.4, (2, 2.3)),
        [p.slab(0.5, (s * 1.1, s * 1.4), (-0.5, 2.1)) for s in (-1, 1)],
        look="steel",
    )
    b.cut("yoke_1", p.cylinder(0.24, 0, (-2, 2), 0))
    b.hinge("yoke_1", "cross", Y, (0, 0, 0), 0.6, -0.6)


@kind(words="chaos pendulum", number=whole(1, 3, words="arm, link, pendulum, bob"), length=(0.15, 0.4))
def double_pendulum(b: ObjectBuilder, number: int, length: float) -> None:
    b.part(
        "stand",
        slab(0.15, 0.1, (0, 0.02)),
        slab(0.02, (0.01, 0.05), (0.01, 0.1 + (number + 0.3) * length)),
        b.cylinder(0.006, 0, (-0.011, 0.02), 0.08 + (number + 0.2) * length),
        look="wood",
    )
    parent = "stand"
    for k in range(number):
        z = 0.08 + (number + 0.2 - k) * length
        y = -0.003 - 0.014 * k
        b.part(
            f"arm_{k}",
            beam(0.025, 0.008, (0, y, z), (0, y, z - length), Y),
            [b.cylinder(0.018, 0, (y - 0.004, y + 0.004), q) for q in (z, z - length)],
            look="red metal",
        )
        b.cut(f"arm_{k}", b.cylinder(0.0075, 0, (y - 0.01, y + 0.01), z))
        if k < number - 1:
            b.part(f"arm_{k}", b.cylinder(0.006, 0, (y - 0.02, y), z - length))
        b.spin(f"arm_{k}", parent, Y, (0, y, z))
        parent = f"arm_{k}"


@kind(words="inverted pendulum, cart and pole, pendulum on a cart", length=(0.8, 1.6))
def cart_pole(b: ObjectBuilder, length: float) -> None:
    b.part(
        "rail",
        slab(length / 2, 0.03, (0, 0.03)),
        [slab((s * length / 2, s * (length / 2 - 0.02)), 0.06, (0, 0.1)) for s in (-1, 1)],
        look="metal",
    )
    b.part(
        "cart",
        slab(0.08, 0.05, (0.031, 0.1)),
        [slab(0.08, (s * 0.05, s * 0.032), (0.005, 0.05)) for s in (-1, 1)],
        b.cylinder(0.008, 0, (-0.08, 0), 0.08),
        look="blue",
    )
    b.slide("cart", "rail", X, length / 2 - 0.11, lower=-length / 2 + 0.11)
    b.part(
        "pole",
        beam(0.025, 0.012, (0, -0.066, 0.08), (0, -0.066, 0.6), Y),
        b.cylinder(0.02, 0, (-0.072, -0.06), 0.08),
        b.cylinder(0.03, 0, (-0.08, -0.052), 0.62),
        look="red metal",
    )
    b.cut("pole", b.cylinder(0.0095, 0, (-1, 1), 0.08))
    b.hinge("pole", "cart", Y, (0, 0, 0.08), 1.5, -1.5)


@kind(words="rotary pendulum, rotary inverted pendulum", size=(0.8, 1.3))
def furuta_pendulum(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("base", p.cylinder(0.08, 0, 0.02), p.cylinder(0.03, 0.01, 0.3), p.cylinder(0.01, 0.29, 0.34), look="metal")
    b.part(
        "arm",
        p.tube(0.025, 0.0125, 0.305, 0.335),
        p.beam(0.016, 0.016, (0.015, 0, 0.32), (0.18, 0, 0.32)),
        p.cylinder(0.006, (0.17, 0.22), 0, 0.32),
        look="red metal",
    )
    b.spin("arm", "base", Z, p(0, 0, 0))
    b.part(
        "pendulum",
        p.beam(0.012, 0.008, (0.21, 0, 0.32), (0.21, 0, 0.1), X),
        p.cylinder(0.013, (0.202, 0.218), 0, 0.32),
        p.cylinder(0.022, (0.2, 0.22), 0, 0.09),
        look="blue metal",
    )
    b.cut("pendulum", p.cylinder(0.0078, (0, 1), 0, 0.32))
    b.spin("pendulum", "arm", X, p(0, 0, 0.32))


@kind(
    words="tilting plate, labyrinth game, marble labyrinth, tilting maze, gimbal table, two axis gimbal",
    width=(0.25, 0.45),
)
def ball_and_plate(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part("case", slab(w + 0.06, w + 0.06, (0, 0.1)), look="wood")
    b.cut("case", slab(w + 0.045, w + 0.045, (0.01, 1)))
    b.bore("case", b.cylinder(0.0075, (-1, 1), 0, 0.08))
    b.part(
        "frame",
        slab(w + 0.03, w + 0.03, (0.07, 0.09)),
        [b.cylinder(0.006, (s * (w + 0.025), s * (w + 0.09)), 0, 0.08) for s in (-1, 1)],
        b.cylinder(0.02, (w + 0.075, w + 0.095), 0, 0.08),
        look="brown wood",
    )
    b.cut("frame", slab(w + 0.012, w + 0.012, (0, 1)))
    b.bore("frame", b.cylinder(0.0075, 0, (-w - 0.025, w + 0.025), 0.08))
    b.hinge("frame", "case", X, (0, 0, 0.08), 0.12, -0.12)
    b.part(
        "plate",
        slab(w, w, (0.074, 0.086)),
        [b.cylinder(0.006, 0, (s * (w - 0.005), s * (w + 0.023)), 0.08) for s in (-1, 1)],
        look="wood",
    )
    b.part(
        "plate",
        [
            box((-w + 0.1 * k, -w + 0.06 * (k % 3), 0.085), (-w + 0.1 * k + 0.006, w - 0.08 * (k % 2) - 0.05, 0.098))
            for k in (1, 2, 3)
        ],
    )
    b.hinge("plate", "frame", Y, (0, 0, 0.08), 0.12, -0.12)


@kind(words="flyball governor, watt governor", size=(0.8, 1.3))
def centrifugal_governor(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("base", p.cylinder(0.1, 0, 0.03), p.cylinder(0.012, 0.02, 0.08), look="black steel")
    b.part(
        "spindle",
        p.cylinder(0.02, 0.081, 0.1),
        p.cylinder(0.009, 0.09, 0.4),
        [p.slab(0.008, (s * 0.006, s * 0.03), (0.36, 0.38)) for s in (-1, 1)],
        look="brass",
    )
    b.cut("spindle", [p.slab(0.0045, (s * 0.015, s * 0.05), (0.3, 0.4)) for s in (-1, 1)])
    b.spin("spindle", "base", Z, p(0, 0, 0))
    for k, s in enumerate((-1, 1)):
        b.part(
            f"arm_{k}",
            p.beam(0.007, 0.007, (0, s * 0.025, 0.37), (0, s * 0.1, 0.22), X),
            p.ball(0.025, (0, s * 0.105, 0.21)),
            look="brass",
        )
        b.hinge(f"arm_{k}", "spindle", s * X, p(0, s * 0.025, 0.37), 0.6, -0.1)
    b.follow("arm_1", "arm_0")


@kind(words="pulley and belt, timing belt drive, chain drive, two pulleys", radius=(0.04, 0.12))
def belt_drive(b: ObjectBuilder, radius: float) -> None:
    r = radius
    b.part(
        "frame",
        box((-1.4 * r, 0, -1.8 * r), (4.5 * r, 0.2 * r, -1.4 * r)),
        [box((x - 0.2 * r, 0, -1.5 * r), (x + 0.2 * r, 0.2 * r, 0.25 * r)) for x in (0, 3.4 * r)],
        [b.cylinder(0.15 * r, x, (-0.7 * r, 0.05 * r), 0) for x in (0, 3.4 * r)],
        look="grey steel",
    )
    for name, x, q in (("pulley_0", 0, r), ("pulley_1", 3.4 * r, 0.6 * r)):
        b.part(
            name,
            b.cylinder(q, x, (-0.15 * r, -0.03 * r), 0),
            b.cylinder(0.9 * q, x, (-0.45 * r, -0.1 * r), 0),
            b.cylinder(q, x, (-0.55 * r, -0.43 * r), 0),
            look=("metal", f"{'red' if x == 0 else 'blue'}"),
        )
        b.cut(name, b.cylinder(0.17 * r, x, (-1, 1), 0))
        b.spin(name, "frame", -Y, (x, 0, 0))
    b.follow("pulley_1", "pulley_0", 1.667)


@kind(
    words="ball screw, linear screw drive, screw drive, linear actuator stage, spindle drive",
    length=(0.25, 0.7),
)
def lead_screw(b: ObjectBuilder, length: float) -> None:
    L = length / 2
    b.part(
        "base",
        slab(L, 0.05, (0, 0.02)),
        [slab((s * L, s * (L - 0.02)), 0.05, (0.01, 0.08)) for s in (-1, 1)],
        [b.cylinder(0.006, (-L + 0.01, L - 0.01), y, 0.05) for y in (-0.035, 0.035)],
        look="metal",
    )
    b.bore("base", b.cylinder(0.0085, (-1, 1), 0, 0.05))
    b.part(
        "screw",
        b.cylinder(0.007, (-L - 0.03, L + 0.005), 0, 0.05),
        b.cylinder(0.018, (-L - 0.05, -L - 0.025), 0, 0.05),
        look="steel",
    )
    lead, way = 0.008, 2 * L - 0.17  # of the nut per radian of the screw
    b.hinge("screw", "base", X, (0, 0, 0.05), way / lead, ajar=False)
    b.part("nut", slab((-L + 0.05, -L + 0.11), 0.048, (0.03, 0.085)), look="black metal")
    b.cut("nut", b.cylinder(0.0085, (-1, 1), 0, 0.05), [b.cylinder(0.0075, (-1, 1), y, 0.05) for y in (-0.035, 0.035)])
    b.slide("nut", "base", X, way)
    b.follow("nut", "screw", lead)


@kind(words="oil pump jack, oil pump, nodding donkey", size=(0.5, 1.5))
def pump_jack(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "base",
        p.slab((-1.2, 1.3), 0.3, (0, 0.1)),
        [p.beam(0.08, 0.08, (x, s * 0.25, 0.05), (0, s * 0.13, 1.5), Y) for x in (-0.4, 0.4) for s in (-1, 1)],
        [p.slab(0.07, (s * 0.09, s * 0.15), (1.42, 1.6)) for s in (-1, 1)],
        p.slab((0.7, 1.2), 0.15, (0.09, 0.6)),
        look="blue steel",
    )
    b.part(
        "beam",
        p.slab((-1.2, 1), 0.07, (1.54, 1.68)),
        p.slab(0.06, 0.065, (1.46, 1.55)),
        p.prism([(-1.2, 1.3), (-1.05, 1.25), (-1, 1.75), (-1.2, 1.8)], (0, 0, 0), 0.14, "y"),
        look="yellow steel",
    )
    b.hinge("beam", "base", Y, p(0, 0, 1.5), 0.25, -0.25)
    for k, s in enumerate((-1, 1)):
        b.part(
            f"crank_{k}",
            p.cylinder(0.07, 0.95, (s * 0.152, s * 0.22), 0.45),
            p.box((0.87, s * 0.16, 0.14), (1.03, s * 0.22, 0.5))
            if k < 0
            else p.beam(0.14, 0.06, (0.95, s * 0.19, 0.45), (0.95, s * 0.19, 0.76), Y),
            look="black steel",
        )
        b.spin(f"crank_{k}", "base", Y, p(0.95, 0, 0.45))
    b.follow("crank_1", "crank_0", 1)
