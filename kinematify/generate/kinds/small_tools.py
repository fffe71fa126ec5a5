"""Scissors, pliers, staplers and more, carved."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from kinematify.generate.library.kind import choice, kind, length, share, whole
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, hull, prism, slab, strip, vector


@kind(
    words=(
        "pair of scissors, kitchen scissors, paper scissors, nail scissors, surgical scissors, sewing scissors, hair "
        "scissors, craft scissors, kids scissors, herb scissors, office scissors, fabric scissors"
    ),
    title="pair of scissors",
    length=length(0.08, 0.35, default=0.18, usual=(0.12, 0.25), help="Over all."),
    blade=share(0.35, 0.65, usual=(0.42, 0.58), help="Share of the length."),
    thick=length(0.002, 0.004, default=0.0025, usual=(0.002, 0.003), help="Of a blade."),
    loops=choice(
        ("round", "oval", "mixed"), help="Of the handles: both round, both long, or one of each.", words="loop, handle"
    ),
    styles=False,
)
def scissors(b: ObjectBuilder, length: float, blade: float, thick: float, loops: str) -> None:
    g = min(b.style.gap, 0.3 * thick)
    tall = max(0.045 * length, 3 * thick)
    mid = tall / 2
    wide = 0.05 * length
    back = (1 - blade) * length
    radius = min(0.17 * length, 0.28 * back)
    wall = 0.3 * radius
    gap2 = 0.0008
    for name, s, z in (("blade_1", 1, mid - g / 2 - thick), ("blade_2", -1, mid + g / 2)):
        large = loops == "oval" or (s < 0 and loops == "mixed")
        stretch = min(0.6 * radius, back - 2 * radius - 2 * wide) if large else 0
        x = s * (-radius - gap2)
        y = radius - back
        top = y + stretch + radius - wall / 2
        end = min((top - 1.5 * wide) / 2, -1.4 * wide - 0.55 * wall)
        b.part(
            name,
            hull(
                b.cylinder(0.9 * wide, z, z + thick),
                box(
                    (-0.2 * s * wide, 0.55 * blade * length, z),
                    (0.75 * s * wide, 0.55 * blade * length + 0.001, z + thick),
                ),
                box((0.05 * s * wide, blade * length - 0.001, z), (0.2 * s * wide, blade * length, z + thick)),
            ),
            strip([(x, y, radius), (x, y + stretch, radius)], 0, tall),
            strip([(x, top, 0.6 * wall), (0.45 * x, end, 0.55 * wall)], 0, tall),
            strip([(0, 0, 0.9 * wide), (x, top, 0.4 * wall)], z, z + thick),
            look="steel",
        )
        b.cut(
            name,
            strip([(x, y, radius - wall), (x, y + stretch, radius - wall)], -1, 1),
            slab((-s * gap2, s * length), (-2 * length, -1.1 * wide), 1),
        )
    r = 0.022 * length
    top = mid + g / 2 + thick + g
    b.part("blade_1", b.cylinder(r, mid - thick, top + 0.0001), b.cylinder(1.8 * r, top, top + r / 2))
    b.cut("blade_2", b.cylinder(r + 1.5 * g, -1, 1))
    b.hinge("blade_2", "blade_1", Z, (0, 0, mid), 1.1)


@kind(
    words=(
        "pair of pliers, combination pliers, wire cutters, side cutter, nippers, cutting pliers, lineman pliers, long "
        "nose pliers, electrician pliers, needle nose pliers"
    ),
    title="pair of pliers",
    length=length(0.1, 0.4, default=0.18, usual=(0.13, 0.25), help="Over all."),
    thick=length(0.006, 0.02, default=0.01, usual=(0.008, 0.014), help="Of a lever."),
    jaws=choice(
        {
            "flat": "combination, flat nose",
            "needle": "needle nose, needle nosed, long nose, pointed",
            "cutting": "cutter, side cutting, diagonal, diagonal cutting",
        },
        help="Shape of the jaws.",
        words="jaw, nose",
    ),
    grips=choice(
        {"sleeve": "insulated, cushioned", "none": "bare"}, help="Around the ends of the handles.", words="grip, handle"
    ),
    styles=False,
)
def pliers(b: ObjectBuilder, length: float, thick: float, jaws: str, grips: str) -> None:
    g = min(b.style.gap, 0.15 * thick)
    mid = thick / 2
    radius = 0.05 * length + 0.004
    shape = {"flat": (0.34, 1, 0.75), "needle": (0.5, 0.7, 0.25), "cutting": (0.2, 1, 0.55)}[jaws]
    jaw = shape[0] / (1 + shape[0]) * length
    back = length - jaw
    inner = b.style.gap / 2 + 0.0002
    half = radius / 2
    bow = -0.4 * radius - 0.09 * back
    n = 1 if jaws == "cutting" else 8
    pitch = 0.35 * jaw / n
    for name, s, z0, z1 in (("lever_1", 1, 0, mid - g / 2), ("lever_2", -1, mid + g / 2, thick)):
        b.part(
            name,
            b.cylinder(radius, z0, z1),
            hull(
                box((s * inner, radius / 2, 0), (s * shape[1] * radius, 0.7 * radius, thick)),
                box((s * inner, jaw / 2, 0), (s * (shape[1] + shape[2]) / 2 * radius, 0.51 * jaw, thick)),
                box((s * inner, jaw - 0.001, 0), (s * shape[2] * radius, jaw, thick)),
            ),
            strip(
                [
                    (-0.6 * s * radius, -0.6 * radius, half),
                    (s * bow, -0.45 * back, 0.8 * half),
                    (s * bow, -back, 0.7 * half),
                ],
                0,
                thick,
            ),
            look="steel",
        )
        if grips != "none":
            b.part(name, strip([(s * bow, -back / 2, 1.15 * half), (s * bow, half - back, half)], 0, 1.12 * thick))
        b.cut(
            name,
            b.tube(radius + g, 0.408 * radius, z1, thick + g / 2) if s > 0 else b.cylinder(radius + g, -1, z0),
            [
                slab((0, s * (inner + 0.0004)), (y, y + 0.4 * pitch), 1)
                for y in [0.6 * jaw + k * pitch for k in range(n)]
            ],
        )
    r = 0.4 * radius
    b.part("lever_1", b.cylinder(r, 0.0001, thick + g + 0.0001), b.cylinder(1.8 * r, thick + g, thick + g + r / 2))
    b.cut("lever_2", b.cylinder(r + 1.5 * g, -1, 1))
    b.hinge("lever_2", "lever_1", Z, (0, 0, mid), 0.55)


@kind(
    words="desk stapler, office stapler, toy stapler, booklet stapler",
    length=length(0.08, 0.3, default=0.15, usual=(0.11, 0.2), help="Of the base."),
    width=length(0.026, 0.06, default=0.036, usual=(0.03, 0.045), help="At the ears."),
    cover=length(0.006, 0.016, default=0.01, usual=(0.008, 0.013), help="Height of the arm."),
    cover_shape=choice(("flat", "round"), help="Of the arm's top."),
    styles=False,
)
def stapler(b: ObjectBuilder, length: float, width: float, cover: float, cover_shape: str) -> None:
    half = width / 2
    g = min(b.style.gap, 0.00075)
    y = 0.88 * length
    z = 0.034
    e = 0.0015
    outer = half - e - g
    inner = outer - e - g
    low = 0.0155 + g
    top = z - 0.004
    under = z + 0.008
    level = cover / 2
    front = 0.4 * outer
    tall = min(cover, outer)
    b.part(
        "base",
        [
            hull(box((x, y - 0.012, 0.004), (x + e, y + 0.012, 0.008)), b.cylinder(0.007, (x, x + e), y, z))
            for x in (-half, half - e)
        ],
        hull(b.cylinder(half, 0, half, (0, 0.008)), slab(half, (length - 0.02, length), (0, 0.008))),
        slab(0.4 * half, (0.006, 0.026), (0.0079, 0.0095)),
        b.cylinder(0.0025, (-half, half), y, z),
        look="metal",
    )
    b.part(
        "magazine",
        slab(inner, (0.004, y - 0.012), (low, low + e)),
        [box((x, 0.004, low), (x + e, y - 0.012, top)) for x in (-inner, inner - e)],
        slab(inner, (0.004, 0.004 + e), (low, top)),
        box((0.0001 - inner, 0.014, low), (inner - 0.0001, 0.6 * y, low + 0.4 * (top - low))),
        [
            hull(box((x, y - 0.022, low), (x + e, y - 0.012, top)), b.cylinder(0.006, (x, x + e), y, z))
            for x in (-inner, inner - e)
        ],
        look="silver steel",
    )
    b.part(
        "arm",
        hull(
            b.cylinder(level, (-outer, outer), front, under + level),
            b.cylinder(level, (-outer, outer), y, under + level),
            slab(outer, (y / 2, y), (under, under + cover)),
        ),
        [
            hull(box((x, y / 2, z - 0.002), (x + e, y - 0.012, under + level)), b.cylinder(0.006, (x, x + e), y, z))
            for x in (-outer, outer - e)
        ],
        box((g + e - inner, 0.0085, z - 0.003), (inner - e - g, 0.0095, under + level)),
        look="metal",
    )
    if cover_shape == "round":
        b.part(
            "arm",
            prism(
                [(tall * cos(a), tall * sin(a)) for a in np.linspace(0, pi, 17)],
                (0, (front + y - 0.01) / 2, under + level),
                y - 0.01 - front,
                "y",
            ),
        )
    for name, above, down, upper in (("magazine", "base", 0.005, 1.2), ("arm", "magazine", 0.008, 1.3)):
        b.cut(name, b.cylinder(0.0025 + 1.5 * g, (-1, 1), y, z))
        b.hinge(name, above, -X, (0, y, z), upper, -down / length)


@kind(
    words=(
        "ballpoint pen, ballpoint, ball pen, biro, fountain pen, felt pen, marker, click pen, retractable "
        "pen, gel pen, rollerball pen, mechanical pencil"
    ),
    length=length(0.1, 0.2, default=0.14, usual=(0.125, 0.155), help="Of the barrel."),
    width=length(0.009, 0.02, default=0.011, usual=(0.0095, 0.013), help="Outer diameter.", words="diameter"),
    mechanism=choice(
        {"click": "clicking, push button, retractable, button", "cap": "capped", "twist": "twisting, twist action"},
        help="What moves.",
    ),
    styles=False,
)
def pen(b: ObjectBuilder, length: float, width: float, mechanism: str) -> None:
    r = width / 2
    g = min(b.style.gap, 0.0005)
    n = 0.42 * length
    m = 0.55 * length
    k = 0.066 * length
    q = r - 0.0012 - g
    end = length - 0.006
    free = n - 0.006 if mechanism == "cap" else length - 0.045
    fixed = -0.006 if mechanism == "cap" else length
    s = 1 if fixed < free else -1
    tip = length if mechanism == "click" else m
    clip = [
        slab(0.002, (free, fixed), (2 * r + 0.0012, 2 * r + 0.0024)),
        slab(0.002, (fixed, fixed + s * 0.004), (1.8 * r, 2 * r + 0.0024)),
        b.cylinder(0.001, (-0.002, 0.002), free - s * 0.002, 2 * r + 0.0012),
    ]
    if mechanism == "cap":
        b.part(
            "barrel",
            b.lathe([(0, 0), (0.0015, 0), (q, 0.012), (q, n + 0.001), (0, n + 0.001)], segments=6)
            .rotate((-90, 0, 0))
            .translate((0, 0, r)),
            b.cylinder(r, 0, (n, length), r),
        )
        b.part("cap", b.cylinder(r, 0, (-0.006, n - g), r), clip)
        b.cut(
            "cap",
            b.lathe([(0, -0.002), (1.155 * (q + g), -0.002), (1.155 * (q + g), 1), (0, 1)], segments=6)
            .rotate((-90, 0, 0))
            .translate((0, 0, r)),
        )
        b.slide("cap", "barrel", -Y, n + 0.01)
    else:
        b.part(
            "barrel",
            b.lathe([(0, 0), (0.0015, 0), (r, 0.012), (r, tip), (0, tip)]).rotate((-90, 0, 0)).translate((0, 0, r)),
        )
        b.cut("barrel", [b.torus(r, 0.0003, (0, 0.018 + 0.003 * j, r), Y) for j in range(6)])
        if mechanism == "click":
            b.part("barrel", clip)
            b.cut(
                "barrel",
                b.lathe(
                    [
                        (0, -1),
                        (0.0007 + g, -1),
                        (0.0007 + g, 0.012),
                        (0.6 * r + g, 0.012),
                        (0.6 * r + g, end),
                        (0.42 * r + g, end),
                        (0.42 * r + g, 1),
                        (0, 1),
                    ]
                )
                .rotate((-90, 0, 0))
                .translate((0, 0, r)),
                slab(0.14 * r + g, (0.012, end), (0.24 * r - g, 1.76 * r + g)),
            )
            b.part(
                "button",
                b.lathe(
                    [
                        (0, 0.002),
                        (0.0007, 0.002),
                        (0.0007, 0.018),
                        (0.4 * r, 0.018),
                        (0.4 * r, end - 0.004),
                        (0.6 * r, end - 0.004),
                        (0.6 * r, end - g),
                        (0.42 * r, end - g),
                        (0.42 * r, length + 0.009),
                        (0, length + 0.009),
                    ]
                )
                .rotate((-90, 0, 0))
                .translate((0, 0, r)),
                slab(0.14 * r, (end - 0.02, end - g), (0.24 * r, 1.76 * r)),
                look="metal",
            )
            b.slide("button", "barrel", -Y, 0.005)
        else:
            b.cut("barrel", b.cylinder(0.55 * r + 1.5 * g, 0, (m - 1.4 * k - g, m + g), r))
            b.part("barrel", b.cylinder(0.0006, 0, (-0.002, 0.012), r))
            b.part(
                "grip",
                b.cylinder(0.55 * r, 0, (m - 1.4 * k, m + k), r),
                b.cylinder(r, 0, (m + g, length), r),
                b.cylinder(r + 0.0005, 0, (m + g, m + g + 0.002), r),
                clip,
                look="metal",
            )
            b.hinge("grip", "barrel", Y, (0, m, r), 3.0)


@kind(
    words=(
        "wall clock, kitchen clock, station clock, table clock, analog clock, alarm clock, desk clock, office "
        "clock, school clock, hallway clock, mantel clock"
    ),
    part_words={"hand": "hour hand, minute hand, second hand"},
    width=length(0.12, 1.0, default=0.3, usual=(0.2, 0.45), help="Outer width or diameter.", words="diameter"),
    depth=length(0.04, 0.12, default=0.05, usual=(0.04, 0.07), help="Of the case."),
    frame=length(0.006, 0.03, default=0.015, usual=(0.01, 0.025), help="Of the rim."),
    hands=whole(1, 3, default=3, usual=(2, 3), help="Hours first.", words="hand, pointer"),
    time=share(0.0, 12.0, default=10.15, help="That it shows [h]."),
    shape=choice({"round": "circular", "square": "rectangular"}, help="Of the case."),
    styles=False,
)
def clock(b: ObjectBuilder, width: float, depth: float, frame: float, hands: int, time: float, shape: str) -> None:
    half = width / 2
    dial = half - frame
    recess = depth / 2
    n = hands
    g = min(b.style.gap, 0.1 * recess)
    thin = 0.0015
    back = 0.75 * depth
    turns = (time / 12, time, 60 * time)
    c = vector(0, 0, half)
    if shape == "square":
        b.part(
            "body",
            slab(half, (recess, depth), (0, width)),
            [box((x - frame / 2, 0, 0), (x + frame / 2, depth, width)) for x in (frame / 2 - half, half - frame / 2)],
            [slab(half, (0, depth), (z - frame / 2, z + frame / 2)) for z in (frame / 2, width - frame / 2)],
        )
    else:
        b.part(
            "body",
            b.cylinder(half, c + recess * Y, c + depth * Y, segments=96),
            b.tube(half, dial, c, c + depth * Y, segments=96),
        )
    for k in range(12):
        a = k * pi / 6
        u = vector(sin(a), 0, cos(a)) * dial
        size = (0.12, 0.03) if k % 3 == 0 else (0.07, 0.018)
        b.part(
            "body",
            beam(
                0.0022,
                2 * size[1] * dial,
                c + (recess - 0.0001) * Y + (0.95 - size[0]) * u,
                c + (recess - 0.0001) * Y + 0.95 * u,
                np.cross(u, Y),
            ),
        )
    b.bore("body", b.cylinder(1.003 * (0.0015 + (n - 1) * (thin + g) + g), c + 0.4 * depth * Y, c + (back + g) * Y))
    for k in range(n):
        r = 0.0015 + (n - 1 - k) * (thin + g)
        y = recess - 0.002 - g - k * (thin + g)
        a = 2 * pi * (turns[k] % 1)
        long = ((0.5, 1.0), (0.78, 0.7), (0.85, 0.3))[k][0] * dial
        w = 0.05 * ((0.5, 1.0), (0.78, 0.7), (0.85, 0.3))[k][1] * dial
        tail = -0.16 * dial if k else -0.1 * dial
        b.part(
            f"hand_{k + 1}",
            prism(
                [
                    (x * cos(a) + z * sin(a), z * cos(a) - x * sin(a))
                    for x, z in (
                        (-w / 2, tail),
                        (w / 2, tail),
                        (w / 2, 0),
                        (0.2 * w, long),
                        (-0.2 * w, long),
                        (-w / 2, 0),
                    )
                ],
                c + (y - thin / 2) * Y,
                thin,
                "y",
            ),
            b.cylinder(max(2.2 * r, 0.02 * dial), c + (y - thin) * Y, c + y * Y),
            b.cylinder(r, c + (y - 0.0001) * Y, c + back * Y),
            look=("metal", f"{'red' if k == 2 else 'black'}"),
        )
        if k + 1 < n:
            b.cut(f"hand_{k + 1}", b.cylinder(1.003 * (r - thin), c - Y, c + Y))
        b.spin(f"hand_{k + 1}", "body", Y, c + y * Y)


@kind(
    words="pruning shears, garden secateurs, pruner, hand pruner, garden pruner, pruning scissors",
    part_words={"blade": "jaw, cutter, handle"},
    length=(0.15, 0.25),
    styles=False,
)
def secateurs(b: ObjectBuilder, length: float) -> None:
    """A hook and a blade that passes it."""
    p = b.sized(length)
    jaws = (
        [(0, 0, 0.065), (0.05, 0.16, 0.03), (0.03, 0.33, 0.012)],
        [(0, 0, 0.065), (0, 0.16, 0.05), (0.02, 0.34, 0.006)],
    )
    for k, (jaw, s) in enumerate(zip(jaws, (1, -1), strict=True)):
        z = 0.0175 * k
        grip = [(-s * 0.05, -0.18, 0.028), (-s * 0.075, -0.4, 0.032), (-s * 0.06, -0.62, 0.028)]
        tang = p.strip([(0, 0, 0.06), (-s * 0.05, -0.2, 0.025)], z, z + 0.015)
        handle = b.painted(*p.strip(grip, -0.015, 0.045))
        b.part(f"blade_{k + 1}", p.strip(jaw, z, z + 0.015), tang, handle, look="steel")
    b.part("blade_1", p.cylinder(0.02, 0, 0.04), p.cylinder(0.035, 0.036, 0.046))
    b.cut("blade_2", b.cylinder(0.02 * length + 1.5 * b.gap(0.02 * length), -1, 1))
    b.hinge("blade_2", "blade_1", Z, (0, 0, 0), 0.62)
