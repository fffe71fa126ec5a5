"""Machines of factories, farms and shops."""

from __future__ import annotations

from itertools import pairwise
from math import cos, pi, sin

import numpy as np
from manifold3d import Manifold

from kinematify.generate.library.kind import kind, whole, yes
from kinematify.generate.library.mechanisms import arm, button, case, caster, knob, lever, plunger
from kinematify.generate.library.panels import drawer, leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, block, box, prism, slab, vector


@kind(
    words=(
        "tool trolley, tool chest, roller cabinet, workshop trolley, tool cabinet, mechanic cart, crash cart, workshop "
        "cart, tool trolley cart, medication cart, office drawer unit, mobile pedestal, rolling drawer unit, rolling "
        "pedestal, rolling tool chest, rolling cabinet, drawer cart, drawer trolley"
    ),
    width=(0.55, 0.8),
    depth=(0.4, 0.5),
    height=(0.75, 1.0),
)
def tool_cart(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """Drawers of many heights, a lid, casters, a push bar."""
    z = 0.13
    case(b, "cabinet", (-width / 2, -depth / 2, z), (width / 2, depth / 2, height), material="steel")
    b.part(
        "cabinet",
        [
            beam(
                0.02,
                0.02,
                (width / 2, s * 0.4 * depth, height - 0.08),
                (width / 2 + 0.07, s * 0.4 * depth, height - 0.08),
            )
            for s in (-1, 1)
        ],
        b.cylinder(0.014, width / 2 + 0.07, (-0.45 * depth, 0.45 * depth), height - 0.08),
    )
    low = z + 0.05
    for k, share in enumerate(sorted([b.draw(0.5, 1.5) for i in range(b.count(3, 6))], reverse=True)):
        top = low + share * 0.115
        if top <= height - 0.03:
            drawer(
                b,
                f"drawer_{k}",
                "cabinet",
                (-0.46 * width, -depth / 2, low),
                (0.46 * width, 0.4 * depth, top),
                material="steel",
            )
            low = top + 0.012
    if b.maybe():
        leaf(
            b,
            "lid",
            "cabinet",
            (-width / 2, -depth / 2, height),
            (width / 2, depth / 2, height + 0.04),
            hinge=Y,
            out=Z,
            reach=1.4,
            handle=False,
        )
    for k, (x, y) in enumerate([(x, y) for x in (-0.42 * width, 0.42 * width) for y in (-0.4 * depth, 0.4 * depth)]):
        caster(b, f"caster_{k}", "cabinet", (x, y, z), z)


@kind(words="arbor press, workshop press", height=(0.35, 0.6))
def press(b: ObjectBuilder, height: float) -> None:
    """An arbor press: a ram and a lever."""
    b.part(
        "frame",
        slab(0.08, (-0.1, 0.14), (0, 0.04)),
        slab(0.04, (0.05, 0.13), (0.03, height)),
        slab(0.05, (-0.06, 0.13), (height - 0.14, height)),
        look="steel",
    )
    g = b.gap(0.02) + 0.0003
    a = 0.016
    b.bore("frame", slab(a + g, (-a - g - 0.02, a + g - 0.02), (0.05, height + 1)))
    b.part(
        "ram",
        slab(a, (-a - 0.02, a - 0.02), (0.12, height + 0.06 if b.style.has_bore else height - 0.14 - g)),
        look="steel",
    )
    b.slide("ram", "frame", -Z, 0.06, ajar=False)
    lever(b, "lever", "frame", (0.05, 0.03, height - 0.06), X, vector(0, -0.8, 0.6), b.draw(0.2, 0.4), reach=1.2)
    b.follow("ram", "lever", 0.05)


@kind(
    words="valve, globe valve, stop valve, handwheel valve, needle valve, water valve",
    radius=(0.02, 0.15),
    number=whole(3, 12, default=4, usual=(3, 6), words="spoke"),
)
def gate_valve(b: ObjectBuilder, radius: float, number: int) -> None:
    """A handwheel above a body between flanges."""
    p = b.sized(radius)
    b.part(
        "body",
        p.tube(1, 0.7, (-3, 3), 0, 0),
        [p.tube(1.7, 0.7, (s * 3, s * 2.6), 0, 0) for s in (-1, 1)],
        p.ball(1.3, (0, 0, 0)),
        p.cone(0.9, 0.5, 1, 3),
        look="steel",
    )
    g = b.gap(radius)
    at = vector(0, 0, 3 * radius)
    b.part(
        "handwheel",
        b.cylinder(0.25 * radius, at + g * Z, at + 1.2 * radius * Z),
        b.torus(1.6 * radius, 0.18 * radius, at + 0.9 * radius * Z, Z),
        [
            beam(
                0.2 * radius,
                0.15 * radius,
                at + 0.9 * radius * Z,
                at + 0.9 * radius * Z + 1.6 * radius * vector(cos(a), sin(a), 0),
            )
            for a in np.arange(number) * 2 * pi / number
        ],
        look="steel",
    )
    if b.maybe():
        b.spin("handwheel", "body", Z, at)
    else:
        b.hinge("handwheel", "body", Z, at, 9.0, ajar=False)


@kind(
    words="lever valve, gas valve, quarter turn valve, shut off valve",
    radius=(0.01, 0.06),
    number=whole(1, 3, words="lever, handle"),
)
def ball_valve(b: ObjectBuilder, radius: float, number: int) -> None:
    """A lever that turns by a quarter above a pipe."""
    b.part("pipe", b.cylinder(radius, (-4 * radius * number, 4 * radius * number), 0, 0), look="steel")
    for k, x in enumerate(spread(number, -4 * radius * number, 4 * radius * number)):
        b.part(
            "pipe",
            b.cylinder(1.4 * radius, (x - 1.5 * radius, x + 1.5 * radius), 0, 0),
            b.cylinder(0.5 * radius, x, 0, (0, 1.8 * radius)),
        )
        lever(b, f"lever_{k}", "pipe", (x, 0, 1.8 * radius), Z, b.pick(X, Y), 5 * radius, reach=1.57)


@kind(
    words=(
        "control cabinet, operator panel, control station, pendant control, machine control, dial plate, knob "
        "panel, dial panel"
    ),
    width=(0.15, 0.4),
    height=(0.15, 0.5),
    depth=(0.06, 0.2),
    rows=whole(2, 4),
)
def control_box(b: ObjectBuilder, width: float, height: float, depth: float, rows: int) -> None:
    """Knobs, push buttons, an emergency stop, switches and a key on a box."""
    case(b, "box", (-width / 2, 0, 0), (width / 2, depth, height), material="steel")
    for i, z in enumerate(spread(rows, 0.05 * height, 0.95 * height)):
        kind = b.pick("knobs", "buttons", "levers", "sliders")
        n = b.count(1, 4)
        pitch = min(0.9 * width / n, 0.8 * height / rows)
        for k, x in enumerate(spread(n, -0.45 * width, 0.45 * width)):
            name = f"{kind[:-1]}_{i}_{k}"
            if kind == "knobs":
                knob(
                    b,
                    name,
                    parent="box",
                    at=(x, 0, z),
                    radius=0.3 * pitch,
                    high=0.3 * pitch,
                    out=-Y,
                    reach=b.pick(None, 4.7),
                )
            elif kind == "buttons":
                button(b, name, "box", (x, 0, z), (0.6 * pitch, 0.6 * pitch), 0.15 * pitch, -Y, is_round=b.maybe(0.7))
            elif kind == "levers":
                g = b.gap(0.1 * pitch)
                tip = (x, -0.5 * pitch, z + 0.25 * pitch)
                b.part("box", b.cylinder(0.18 * pitch, x, (0.01 * pitch, -0.06 * pitch), z))
                b.part(name, b.rod(0.06 * pitch, (x, -0.12 * pitch - g, z), tip))
                b.hinge(
                    name, "box", X, (x, -0.12 * pitch - g if b.style.has_bore else 0, z), 0.8, lower=-0.05, ajar=False
                )
            else:
                g = b.gap(0.1 * pitch) + 0.0002
                b.bore(
                    "box",
                    box(
                        (x - 0.05 * pitch - g, -0.01, z - 0.4 * pitch),
                        (x + 0.05 * pitch + g, 0.1 * depth, z + 0.4 * pitch),
                    ),
                )
                b.part(
                    name,
                    box(
                        (x - 0.05 * pitch, 0.05 * depth if b.style.has_bore else -g, z - 0.1 * pitch),
                        (x + 0.05 * pitch, -0.2 * pitch, z + 0.1 * pitch),
                    ),
                    box(
                        (x - 0.12 * pitch, -0.08 * pitch, z - 0.1 * pitch),
                        (x + 0.12 * pitch, -0.25 * pitch, z + 0.1 * pitch),
                    ),
                )
                b.slide(name, "box", Z, 0.25 * pitch, lower=-0.25 * pitch, ajar=False)


@kind(
    words=(
        "breaker box, electrical panel, breaker panel, electric meter box, distribution board, circuit breaker "
        "panel, switchboard"
    ),
    width=(0.2, 0.4),
    height=(0.25, 0.5),
)
def fuse_box(b: ObjectBuilder, width: float, height: float) -> None:
    """A door with switches behind or beside it."""
    case(b, "box", (-width / 2, 0, 0), (width / 2, 0.12, height), opening=-Y, wall=0.01, material="steel")
    leaf(
        b,
        "door",
        "box",
        (-width / 2, -0.012, 0),
        (width / 2, 0, height),
        hinge=b.pick(X, -X),
        reach=2.0,
        material="steel",
    )
    if b.style.hollow:
        b.part("panel", slab(width / 2 - 0.011, (0.06, 0.109), (0.011, height - 0.011)), look="grey")
        b.fix("panel", "box")
        for k, x in enumerate(spread(b.count(3, 8), -0.4 * width, 0.4 * width)):
            g = b.gap(0.01)
            b.part(
                f"breaker_{k}",
                box((x - 0.006, 0.06 - g, 0.5 * height - 0.01), (x + 0.006, 0.035, 0.5 * height + 0.012)),
            )
            b.hinge(f"breaker_{k}", "panel", X, (x, 0.06 - g, 0.5 * height - 0.01), 0.6, ajar=False)


@kind(words="blade switch, disconnect switch", number=whole(1, 3, words="blade, pole"), width=(0.04, 0.08))
def knife_switch(b: ObjectBuilder, number: int, width: float) -> None:
    """A blade with a handle between clips."""
    b.part("board", slab(width * number, (-0.01, 0), 0.12))
    g = b.gap(0.005) + 0.0003
    xs = spread(number, -0.8 * width * number, 0.8 * width * number)
    for x in xs:
        for z in (-0.08, 0.05):
            b.part(
                "board",
                [
                    box((x + s * (0.004 + g), -0.04, z - 0.012), (x + s * (0.007 + g), -0.001, z + 0.012))
                    for s in (-1, 1)
                ],
            )
        b.part("blade", box((x - 0.004, -0.035, -0.085), (x + 0.004, -0.02, 0.09)), look="metal")
    b.part(
        "blade",
        box((xs[0] - 0.005, -0.035, 0.09), (xs[-1] + 0.005, -0.02, 0.1)),
        b.cylinder(0.008, (0, -0.027, 0.095), (0, -0.09, 0.11)),
    )
    if not b.style.has_bore:
        b.part(f"{b.pick('board', 'blade')}", b.cylinder(0.003, (xs[0] - 0.01, xs[-1] + 0.01), -0.0275, -0.08))
    b.hinge("blade", "board", X, (0, -0.0275, -0.08), 1.2)


@kind(
    "lever console",
    words="signal box lever frame, railway lever frame, lever frame",
    width=(0.5, 1.2),
    number=whole(1, 10, default=3, usual=(2, 5), words="lever, handle"),
)
def big_lever_console(b: ObjectBuilder, width: float, number: int) -> None:
    """Levers in slots on a desk, joysticks, pedals below."""
    b.part("console", prism([(0, 0), (0.5, 0), (0.5, 0.9), (0.3, 0.9), (0, 0.75)], (0, 0, 0), width, "x"), look="steel")
    up = vector(0, -0.15, 0.3) / np.hypot(0.15, 0.3)
    for k, x in enumerate(spread(number, -0.45 * width, 0.45 * width)):
        at = vector(x, 0.15, 0.825)
        g = b.gap(0.02) + 0.001
        b.bore("console", box((x - 0.009 - g, 0.03, 0.7), (x + 0.009 + g, 0.27, 1)))
        b.part(
            f"lever_{k}",
            b.cylinder(0.008, at - (0.06 * up if b.style.has_bore else -g * up), at + 0.2 * up),
            ball(0.02, at + 0.21 * up),
        )
        b.hinge(
            f"lever_{k}", "console", X, at - (0.05 * up if b.style.has_bore else 0 * up), 0.35, lower=-0.35, ajar=False
        )
    for k, x in enumerate(spread(b.count(0, 2) or 1, -0.3 * width, 0.3 * width)):
        g = b.gap(0.02) + 0.0005
        b.part(f"pedal_{k}", beam(0.08, 0.015, (x, -0.012 - g, 0.06), (x, -0.2, 0.14), Z), look="metal")
        b.hinge(f"pedal_{k}", "console", X, (x, -0.012 - g, 0.05), 0.3, ajar=False)


@kind(words="screw jack, lifting jack", radius=(0.03, 0.05), height=(0.15, 0.25))
def bottle_jack(b: ObjectBuilder, radius: float, height: float) -> None:
    """A post that rises out of a body, with a lever."""
    b.part(
        "body",
        slab(2 * radius, 2 * radius, (0, 0.02)),
        b.cylinder(1.3 * radius, 0.01, height),
        b.cylinder(0.5 * radius, 1.6 * radius, 0, (0, 0.5 * height)),
        slab((0, 2 * radius), 0.4 * radius, (0.3 * height, 0.4 * height)),
        look="steel",
    )
    plunger(b, "post", "body", (0, 0, height + 0.02), (0, 0, 0.2 * height), 0.7 * radius, travel=0.6 * height)
    arm(
        b,
        "lever",
        "body",
        (1.6 * radius, 0.5 * radius, 0.5 * height),
        (1.6 * radius + 0.3, 0.5 * radius, 0.6 * height),
        0.5 * radius,
        Y,
        lower=-0.8,
        upper=0.2,
    )


@kind(
    walls=9,
    words="telescopic mast, telescopic antenna, telescopic pole, telescoping boom",
    number=whole(2, 5, usual=(2, 4), words="section, stage, tube"),
    radius=(0.02, 0.1),
    height=(0.4, 1.5),
    square=yes(0.5),
    lying=yes(0.3),
)
def telescope_mast(b: ObjectBuilder, number: int, radius: float, height: float, square: bool, lying: bool) -> None:
    """Three to five tubes in each other: a mast, an antenna, a crane's boom."""
    along, foot = (Y, 3 * radius * Z) if lying else (Z, 0 * Z)

    def stick(q: float, start: float, end: float) -> Manifold:
        return (
            beam(2 * q, 2 * q, foot + start * along, foot + end * along)
            if square
            else b.cylinder(q, foot + start * along, foot + end * along)
        )

    b.part(
        "tube_0",
        stick(radius, 0, height),
        block(foot, (4 * radius, 4 * radius, 0.3 * radius))
        if not lying
        else slab(1.5 * radius, (0, 0.4 * height), (0, 2.2 * radius)),
        look="steel",
    )
    for k in range(1, number + 1):
        q = radius * (1 - 0.2 * k)
        g = b.gap(0.1 * radius) + 0.0002
        b.part(
            f"tube_{k}",
            stick(q, 0.05 * height * k + 0.01, height + 0.08 * height * k)
            if b.style.has_bore
            else stick(q, height + 0.08 * height * (k - 1), height + 0.08 * height * k + 0.08 * height),
            look="metal",
        )
        b.bore(f"tube_{k - 1}", stick(q + 1.5 * g, 0.04 * height * k, 3 * height))
        b.slide(f"tube_{k}", f"tube_{k - 1}", along, 0.6 * height)


@kind(
    words="roller conveyor",
    number=whole(2, 40, default=7, usual=(5, 10), words="roller"),
    width=(0.3, 0.8),
    size=(0.05, 0.09),
)
def conveyor(b: ObjectBuilder, number: int, width: float, size: float) -> None:
    """Rollers between two rails."""
    length = 2.6 * size * number
    for s in (-1, 1):
        b.part(
            "frame",
            box((0, s * width / 2, 0.5), (length, s * (width / 2 + 0.03), 0.6)),
            [
                box((x - 0.02, s * width / 2, 0), (x + 0.02, s * (width / 2 + 0.03), 0.55))
                for x in (0.1 * length, 0.9 * length)
            ],
            look="steel",
        )
    b.part("frame", [slab((x - 0.02, x + 0.02), width / 2, (0.2, 0.24)) for x in (0.1 * length, 0.9 * length)])
    g = b.gap(0.02) + 0.0005
    for i, x in enumerate(spread(number, 0, length)):
        c = vector(x, 0, 0.58)
        b.part(f"roller_{i}", b.cylinder(size, c - (width / 2 - g) * Y, c + (width / 2 - g) * Y), look="metal")
        if b.style.barrels or b.style.has_bore:
            b.part(f"roller_{i}", b.cylinder(0.25 * size, c - (width / 2 + 0.02) * Y, c + (width / 2 + 0.02) * Y))
            b.bore("frame", b.cylinder(0.25 * size + 1.5 * g, c - width * Y, c + width * Y))
        b.spin(f"roller_{i}", "frame", Y, c)


@kind(
    words="gears, gearbox, set of gears, gear wheels, spur gears, gear pair, pair of gears, reduction gear, cogwheels",
    number=whole(2, 8, default=3, usual=(2, 4), words="gear, wheel, cog"),
    radius=(0.03, 0.08),
)
def gear_train(b: ObjectBuilder, number: int, radius: float) -> None:
    """Toothed wheels side by side on a plate; the others follow the first."""
    radii = [radius * b.draw(0.6, 1.4) for i in range(number)]
    xs = np.cumsum([0] + [1.08 * (a + b_) for a, b_ in pairwise(radii)])
    b.part("plate", slab((-1.2 * radii[0], xs[-1] + 1.2 * radii[-1]), (0, 0.01), 1.5 * radius), look="steel")
    g = b.gap(0.1 * radius) + 0.0002
    for k, (x, q) in enumerate(zip(xs, radii, strict=False)):
        c = vector(x, 0, 0)
        teeth = [
            beam(0.12 * q, 0.012, c - (g + 0.008) * Y, c - (g + 0.008) * Y + q * vector(cos(a), 0, sin(a)), Y)
            for a in np.arange(12) * pi / 6
        ]
        b.part(
            f"gear_{k}",
            b.cylinder(0.88 * q, c - g * Y, c - (g + 0.015) * Y),
            teeth,
            b.cylinder(0.15 * q, c - g * Y, c - 0.04 * Y),
            look="metal",
        )
        b.spin(f"gear_{k}", "plate", -Y, c)
        if k:
            b.follow(f"gear_{k}", "gear_0", (-1 if k % 2 else 1) * radii[0] / q)


@kind(words="hasp, hasp and staple, latch, gate latch, door latch", size=(0.02, 0.06), hook=yes(0.5))
def hasp_latch(b: ObjectBuilder, size: float, hook: bool) -> None:
    """A toggle or hook that turns on a plate."""
    p = b.sized(size)
    b.part(
        "plate",
        p.slab(1, (0, 0.15), 1),
        p.slab((2.5, 3.5), (0, 0.15), 1),
        p.slab((-1, 3.5), (0.1, 0.3), 0.4),
        p.cylinder(0.2, 3, (0.1, -0.8), 0),
        look="steel",
    )
    g = b.gap(0.1 * size)
    b.part(
        "hook",
        beam(0.3 * size, 0.4 * size, (-0.2 * size, -0.2 * size - g, 0), (2.7 * size, -0.2 * size - g, 0)),
        b.cylinder(0.3 * size, 0, (-g, -0.45 * size - g), 0),
        look="steel",
    )
    if hook:
        b.part(
            "hook",
            beam(
                0.3 * size,
                0.4 * size,
                (2.6 * size, -0.2 * size - g, 0.1 * size),
                (2.6 * size, -0.2 * size - g, 0.9 * size),
                Y,
            ),
        )
    b.hinge("hook", "plate", -Y, (0, 0, 0), 2.0, ajar=False)


@kind(
    words="pulley, block and tackle, snatch block",
    radius=(0.03, 0.15),
    number=whole(1, 3, words="sheave, pulley, wheel"),
)
def pulley_block(b: ObjectBuilder, radius: float, number: int) -> None:
    """Sheaves between cheeks with a hook that swivels."""
    pitch = 0.45 * radius
    g = b.gap(0.05 * radius) + 0.0002
    ys = spread(number, -number * pitch / 2, number * pitch / 2)
    for y in (-number * pitch / 2 - 0.05 * radius, number * pitch / 2 + 0.05 * radius):
        b.part("block", slab(0.5 * radius, (y - 0.05 * radius, y + 0.05 * radius), 1.2 * radius), look="steel")
    b.part(
        "block",
        slab(0.5 * radius, number * pitch / 2 + 0.1 * radius, (-1.4 * radius, -1.15 * radius)),
        slab(0.5 * radius, number * pitch / 2 + 0.1 * radius, (1.15 * radius, 1.4 * radius)),
    )
    b.part("block", b.cylinder(0.12 * radius, 0, (-number * pitch / 2, number * pitch / 2), 0))
    for k, y in enumerate(ys):
        b.part(
            f"sheave_{k}",
            b.cylinder(radius, 0, (y - 0.4 * pitch, y - 0.15 * pitch), 0),
            b.cylinder(0.8 * radius, 0, (y - 0.2 * pitch, y + 0.2 * pitch), 0),
            b.cylinder(radius, 0, (y + 0.15 * pitch, y + 0.4 * pitch), 0),
            look="metal",
        )
        b.bore(f"sheave_{k}", b.cylinder(0.12 * radius + 1.5 * g, 0, (-radius * number, radius * number), 0))
        b.spin(f"sheave_{k}", "block", Y, (0, y, 0))
    b.part(
        "hook",
        b.cylinder(0.12 * radius, -1.4 * radius - g, -1.8 * radius),
        b.torus(0.4 * radius, 0.1 * radius, (0, 0, -2.2 * radius), Y),
        look="steel",
    )
    b.spin("hook", "block", Z, (0, 0, -1.4 * radius))
