"""Trolleys, carts and lifts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.library.builder import spread
from kinematify.generate.library.kind import kind
from kinematify.generate.library.mechanisms import wheel
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, prism, scaled, slab, vector

if TYPE_CHECKING:
    from kinematify.generate.library.builder import ObjectBuilder


@kind(walls=150, words="freight car, box wagon, railway wagon, goods wagon, cattle car")
def train_wagon(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.1)
    p = scaled(size)
    b.part(
        "body",
        box(p(-3, -1.2, 1), p(3, 1.2, 3.2)),
        [box(p(x - 0.9, -0.6, 0.5), p(x + 0.9, 0.6, 1.01)) for x in (-1.8, 1.8)],
        [box(p(-1.4, s * 1.2, z), p(2.9, s * 1.32, z + 0.05)) for s in (-1, 1) for z in (0.98, 3.05)],
        look="brown steel",
    )
    b.cut("body", box(p(-2.95, -1.15, 1.05), p(2.95, 1.15, 3.15)), box(p(-0.8, -2, 1.1), p(0.8, 2, 3)))
    for k, s in enumerate((-1, 1)):
        b.part(f"door_{k}", box(p(-0.9, s * 1.21, 1.04), p(0.9, s * 1.28, 3.04)), look="dark red steel")
        b.slide(f"door_{k}", "body", X, 1.9 * size)
    for i, x in enumerate((-2.3, -1.3, 1.3, 2.3)):
        for s, side in ((-1, "right"), (1, "left")):
            wheel(
                b,
                f"wheel_{i}_{side}",
                "body",
                p(x, s * 0.72, 0.45),
                0.45 * size,
                0.12 * size,
                s * Y,
                axle=0.05 * size,
                material="steel",
            )


@kind(walls=30, words="gondola lift, ski lift, cable car cabin, funicular cabin")
def cable_car(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.1)
    p = scaled(size)
    b.part(
        "rope",
        b.cylinder(0.03 * size, p(-3, 0, 3.6), p(3, 0, 3.6)),
        [box(p(s * 3 - 0.15, -0.2, 0), p(s * 3 + 0.15, 0.2, 3.8)) for s in (-1, 1)],
        look="steel",
    )
    b.part(
        "trolley",
        box(p(-0.5, -0.2, 3.64), p(0.5, 0.2, 3.8)),
        box(p(-0.06, -0.3, 3.2), p(0.06, -0.2, 3.8)),
        box(p(-0.06, -0.3, 3.2), p(0.06, 0, 3.3)),
        look="black steel",
    )
    b.slide("trolley", "rope", X, 1.6 * size, lower=-1.6 * size)
    b.part(
        "cabin",
        box(p(-0.7, -0.6, 0.6), p(0.7, 0.6, 2.4)),
        box(p(-0.05, -0.05, 2.39), p(0.05, 0.05, 3.18)),
        look="red metal",
    )
    b.cut(
        "cabin",
        box(p(-0.65, -0.55, 0.65), p(0.65, 0.55, 2.35)),
        box(p(-0.6, -1, 1.3), p(0.6, 1, 2.2)),
        box(p(-0.3, -1, 0.7), p(0.3, 0, 2.3)),
    )
    b.hinge("cabin", "trolley", Y, p(0, 0, 3.2), 0.2, lower=-0.2)
    b.part("door", box(p(-0.34, -0.65, 0.68), p(0.34, -0.61, 2.32)), look="glass")
    b.slide("door", "cabin", X, 0.33 * size)


@kind(walls=20, words="carriage, stagecoach")
def horse_carriage(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.15)
    p = scaled(size)
    b.part(
        "body",
        box(p(-0.8, -0.6, 0.8), p(0.8, 0.6, 2)),
        box(p(-0.5, -0.65, 0.55), p(0.5, 0.65, 0.8)),
        [box(p(0.79, s * 0.3, 0.7), p(1, s * 0.25, 0.9)) for s in (-1, 1)],
        look="dark red wood",
    )
    b.cut(
        "body",
        box(p(-0.72, -0.53, 0.87), p(0.72, 0.53, 1.93)),
        box(p(-0.3, -1, 0.9), p(0.3, 0, 1.9)),
        box(p(-0.6, 0, 1.3), p(0.6, 1, 1.8)),
    )
    leaf(b, "door", "body", p(-0.31, -0.63, 0.88), p(0.31, -0.601, 1.92), hinge=X, out=-Y, reach=0.7)
    for i, (x, s) in enumerate([(x, s) for x in (-0.55, 0.55) for s in (-1, 1)]):
        wheel(
            b,
            f"wheel_{i}",
            "body",
            p(x, s * 0.73, 0.5),
            0.37 * size,
            0.06 * size,
            s * Y,
            axle=0.05 * size,
            material="wood",
        )
    b.part(
        "shaft",
        beam(0.06 * size, 0.06 * size, p(0.92, -0, 0.8), p(2.4, 0, 0.8)),
        box(p(0.88, -0.24, 0.76), p(0.96, 0.24, 0.84)),
        look="wood",
    )
    b.hinge("shaft", "body", -Y, p(0.92, 0, 0.8), 0.4, lower=-0.2)


@kind(walls=40, words="snow scooter")
def snowmobile(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.15)
    p = scaled(size)
    b.part(
        "body",
        prism(
            [
                (-1.2 * size, 0.1 * size),
                (0.6 * size, 0.1 * size),
                (1.1 * size, 0.35 * size),
                (0.5 * size, 0.75 * size),
                (0.1 * size, 0.65 * size),
                (-1.2 * size, 0.6 * size),
            ],
            p(0, 0, 0.05),
            0.5 * size,
            "y",
        ),
        box(p(-1.2, -0.2, 0), p(0.2, 0.2, 0.16)),
        [box(p(0.55, s * 0.24, 0.18), p(0.75, s * 0.4, 0.26)) for s in (-1, 1)],
        look="orange",
    )
    for k, s in enumerate((-1, 1)):
        b.part(
            f"ski_{k}",
            b.cylinder(0.03 * size, p(0.65, s * 0.35, 0.06), p(0.65, s * 0.35, 0.178)),
            box(p(0.2, s * 0.35 - 0.06, 0), p(1.2, s * 0.35 + 0.06, 0.04)),
            b.cylinder(0.05 * size, p(0.65, s * 0.35, 0.03), p(0.65, s * 0.35, 0.08)),
            look="black metal",
        )
        b.hinge(f"ski_{k}", "body", Z, p(0.65, s * 0.35, 0), 0.4, lower=-0.4)
    b.part("body", b.cylinder(0.04 * size, p(0.3, 0, 0.7), p(0.3, 0, 0.82)))
    b.part(
        "handlebar",
        b.cylinder(0.05 * size, p(0.3, 0, 0.822), p(0.3, 0, 0.88)),
        b.rod(0.025 * size, p(0.2, -0.35, 0.92), p(0.2, 0.35, 0.92)),
        beam(0.05 * size, 0.05 * size, p(0.3, 0, 0.86), p(0.19, 0, 0.92)),
        look="black steel",
    )
    b.hinge("handlebar", "body", Z, p(0.3, 0, 0), 0.6, lower=-0.6)


@kind(walls=20, words="gokart, go-kart, pedal car, soap box, soapbox car")
def go_kart(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.2)
    p = scaled(size)
    b.part(
        "frame",
        box(p(-0.75, -0.25, 0.08), p(0.75, 0.25, 0.13)),
        box(p(-0.7, -0.45, 0.1), p(-0.5, 0.45, 0.16)),
        box(p(0.5, -0.45, 0.1), p(0.6, 0.45, 0.16)),
        box(p(-0.3, -0.2, 0.12), p(0.1, 0.2, 0.2)),
        beam(0.36 * size, 0.06 * size, p(-0.28, 0, 0.15), p(-0.45, 0, 0.6), X),
        beam(0.04 * size, 0.04 * size, p(0.6, 0, 0.12), p(0.3, 0, 0.45)),
        look="red steel",
    )
    up = vector(-0.673, 0, 0.74)
    b.part(
        "steering_wheel",
        b.torus(0.14 * size, 0.014 * size, p(0.29, 0, 0.5), up),
        [beam(0.02 * size, 0.015 * size, p(0.29, 0, 0.5), p(0.29, 0, 0.5) + 0.14 * size * v, up) for v in (Y, -Y)],
        b.cylinder(0.02 * size, p(0.29, 0, 0.5) - 0.035 * size * up, p(0.29, 0, 0.5) + 0.01 * size * up),
        look="rubber",
    )
    b.hinge("steering_wheel", "frame", up, p(0.29, 0, 0.5), 1.2, lower=-1.2)
    for i, (x, s) in enumerate([(x, s) for x in (-0.6, 0.55) for s in (-1, 1)]):
        wheel(b, f"wheel_{i}", "frame", p(x, s * 0.53, 0.14), 0.14 * size, 0.12 * size, s * Y, axle=0.02 * size)


@kind(walls=110, words="concrete truck, mixer truck")
def cement_truck(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.1)
    p = scaled(size)
    b.part(
        "truck",
        box(p(-3.5, -0.5, 0.8), p(3.5, 0.5, 1.05)),
        box(p(2, -1.15, 1.03), p(3.6, 1.15, 2.9)),
        [box(p(x - 0.15, -0.9, 1), p(x + 0.15, 0.9, z)) for x, z in ((-2.3, 1.2), (1.62, 1.55))],
        box(p(1.48, -0.3, 1.5), p(1.75, 0.3, 2.3)),
        box(p(-3.4, -0.7, 1), p(-3.1, 0.7, 2.9)),
        [box(p(x - 0.2, -0.85, 0.5), p(x + 0.2, 0.85, 0.85)) for x in (-2.2, -1, 2.7)],
        look="white steel",
    )
    b.cut("truck", box(p(2.05, -1.1, 1.1), p(3.55, 1.1, 2.85)), box(p(-2.5, -2, 1.2), p(-2.1, 2, 3)))
    b.part(
        "drum",
        b.cone(0.6 * size, 1.1 * size, p(1.42, 0, 2.2), p(0.3, 0, 2.3)),
        b.cylinder(1.1 * size, p(0.31, 0, 2.3), p(-0.6, 0, 2.3)),
        b.cone(1.1 * size, 0.45 * size, p(-0.59, 0, 2.3), p(-2.6, 0, 2.3)),
        look="grey steel",
    )
    b.cut(
        "drum",
        b.cylinder(0.4 * size, p(-3, 0, 2.3), p(0.8, 0, 2.3)),
        b.cylinder(1.02 * size, p(-0.5, 0, 2.3), p(0.2, 0, 2.3)),
    )
    b.spin("drum", "truck", X, p(0, 0, 2.3))
    b.part(
        "chute",
        b.cylinder(0.06 * size, p(-3.55, 0, 1.3), p(-3.55, 0, 1.7)),
        beam(0.3 * size, 0.05 * size, p(-3.55, 0, 1.68), p(-4.8, 0, 1.2)),
        look="black steel",
    )
    b.part("truck", box(p(-3.6, -0.1, 1.1), p(-3.35, 0.1, 1.27)))
    b.hinge("chute", "truck", Z, p(-3.55, 0, 0), 1.2, lower=-1.2)
    for i, (x, s) in enumerate([(x, s) for x in (-2.2, -1, 2.7) for s in (-1, 1)]):
        wheel(b, f"wheel_{i}", "truck", p(x, s * 1.02, 0.5), 0.5 * size, 0.3 * size, s * Y, axle=0.02 * size)


@kind(walls=110, words="turntable ladder, aerial ladder, fire engine with ladder")
def ladder_truck(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.1)
    p = scaled(size)
    b.part(
        "truck",
        box(p(-3.2, -1.1, 0.6), p(1.6, 1.1, 1.3)),
        box(p(1.7, -1.15, 0.6), p(3.2, 1.15, 1.8)),
        box(p(1.5, -0.5, 0.6), p(1.8, 0.5, 1)),
        look="red steel",
    )
    b.cut("truck", box(p(-3.1, -1.05, 0.9), p(1.5, 1.05, 1.22)), box(p(1.78, -1.08, 0.68), p(3.12, 1.08, 1.72)))
    b.part(
        "turntable",
        b.cylinder(0.8 * size, p(-2, 0, 1.302), p(-2, 0, 1.5)),
        [box(p(-2.4, s * 0.5, 1.45), p(-1.9, s * 0.4, 2.1)) for s in (-1, 1)],
        look="black steel",
    )
    b.spin("turntable", "truck", Z, p(-2, 0, 0))
    b.part(
        "ladder",
        [box(p(-2.3, s * 0.38, 1.85), p(3, s * 0.33, 2.05)) for s in (-1, 1)],
        [box(p(x - 0.03, -0.35, 1.86), p(x + 0.03, 0.35, 1.92)) for x in spread(10, -2.3, 3)],
        look="metal",
    )
    b.hinge("ladder", "turntable", -Y, p(-2.2, 0, 1.95), 0.9)
    b.part(
        "extension",
        [box(p(-2, s * 0.31, 1.94), p(3.3, s * 0.26, 2.12)) for s in (-1, 1)],
        [box(p(x - 0.03, -0.28, 2), p(x + 0.03, 0.28, 2.06)) for x in spread(10, -2, 3.3)],
        look="metal",
    )
    b.slide("extension", "ladder", X, 3.5 * size)
    for i, (x, s) in enumerate([(x, s) for x in (-2.2, 2.4) for s in (-1, 1)]):
        wheel(b, f"wheel_{i}", "truck", p(x, s * 1.3, 0.5), 0.5 * size, 0.26 * size, s * Y, axle=0.02 * size)


@kind(words="mars rover, moon rover, rover, lunar rover, exploration robot", size=(0.5, 1.2))
def planet_rover(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "body",
        box(p(-0.5, -0.35, 0.5), p(0.5, 0.35, 0.75)),
        b.cylinder(0.04 * size, p(0, -0.44, 0.55), p(0, 0.44, 0.55)),
        box(p(-0.6, -0.4, 0.75), p(0.3, 0.4, 0.78)),
        look="white metal",
    )
    for k, s in enumerate((-1, 1)):
        b.part(
            f"rocker_{k}",
            b.tube(0.07 * size, 0.0425 * size, p(0, s * 0.37, 0.55), p(0, s * 0.43, 0.55)),
            beam(0.05 * size, 0.05 * size, p(0.05, s * 0.4, 0.54), p(0.6, s * 0.4, 0.25), Y),
            beam(0.05 * size, 0.05 * size, p(-0.05, s * 0.4, 0.54), p(-0.6, s * 0.4, 0.25), Y),
            beam(0.05 * size, 0.05 * size, p(0, s * 0.4, 0.5), p(0, s * 0.4, 0.25), Y),
            [b.cylinder(0.025 * size, p(x, s * 0.38, 0.2), p(x, s * 0.44, 0.2)) for x in (-0.6, 0, 0.6)],
            [beam(0.04 * size, 0.04 * size, p(x, s * 0.4, 0.26), p(x, s * 0.4, 0.2), Y) for x in (-0.6, 0, 0.6)],
            look="metal",
        )
        b.hinge(f"rocker_{k}", "body", Y, p(0, s * 0.4, 0.55), 0.2, lower=-0.2)
        for i, x in enumerate((-0.6, 0, 0.6)):
            wheel(
                b,
                f"wheel_{k}_{i}",
                f"rocker_{k}",
                p(x, s * 0.54, 0.2),
                0.2 * size,
                0.16 * size,
                s * Y,
                axle=0.01 * size,
                material="metal",
            )
    b.part(
        "mast",
        b.cylinder(0.03 * size, p(0.4, 0.2, 0.752), p(0.4, 0.2, 1.2)),
        [box(p(0.38, 0.2 + s * 0.06, 1.17), p(0.42, 0.2 + s * 0.045, 1.3)) for s in (-1, 1)],
        box(p(0.38, 0.14, 1.17), p(0.42, 0.26, 1.2)),
        look="white metal",
    )
    b.spin("mast", "body", Z, p(0.4, 0.2, 0))
    b.part("camera", box(p(0.36, 0.158, 1.225), p(0.46, 0.242, 1.32)), look="black")
    b.hinge("camera", "mast", Y, p(0.4, 0.2, 1.27), 0.3, lower=-0.3)


@kind(words="space probe, spacecraft, cubesat", size=(0.3, 1.5))
def satellite(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "bus",
        box(p(-0.3, -0.3, 0), p(0.3, 0.3, 0.8)),
        b.cylinder(0.05 * size, p(0, 0, 0.79), p(0, 0, 0.9)),
        look="gold metal",
    )
    for k, s in enumerate((-1, 1)):
        b.part(
            f"arm_{k}",
            b.cylinder(0.02 * size, p(s * 0.302, 0, 0.4), p(s * 0.45, 0, 0.4)),
            box(p(s * 0.45, -0.25, 0.385), p(s * 1.1, 0.25, 0.41)),
            look="dark blue metal",
        )
        b.spin(f"arm_{k}", "bus", s * X, p(0, 0, 0.4))
        b.part(f"panel_{k}", box(p(s * 1.102, -0.25, 0.385), p(s * 1.75, 0.25, 0.41)), look="dark blue metal")
        b.hinge(f"panel_{k}", f"arm_{k}", s * -Y, p(s * 1.101, 0, 0.41), 2.2)
    b.part(
        "dish",
        b.cone(0.06 * size, 0.25 * size, p(0, 0, 0.99), p(0, 0, 1.1)),
        b.cylinder(0.04 * size, p(0, 0, 0.93), p(0, 0, 1)),
        look="white metal",
    )
    b.cut("dish", b.cone(0.03 * size, 0.235 * size, p(0, 0, 1.02), p(0, 0, 1.101)))
    b.hinge("dish", "bus", X, p(0, 0, 0.9), 0.25, lower=-0.25)


@kind(words="self balancing scooter", size=(0.9, 1.1))
def segway(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "deck",
        box(p(-0.2, -0.15, 0.2), p(0.2, 0.15, 0.3)),
        [box(p(s * 0.03, -0.02, 0.29), p(s * 0.022, 0.02, 0.38)) for s in (-1, 1)],
        look="black",
    )
    b.part(
        "handle",
        beam(0.04 * size, 0.04 * size, p(0, 0, 0.33), p(0, 0.06, 1.15), Y),
        b.rod(0.02 * size, p(-0.25, 0.06, 1.15), p(0.25, 0.06, 1.15)),
        look="steel",
    )
    b.hinge("handle", "deck", X, p(0, 0, 0.352), 0.1, lower=-0.1)
    for k, s in enumerate((-1, 1)):
        wheel(b, f"wheel_{k}", "deck", p(s * 0.27, 0, 0.24), 0.24 * size, 0.1 * size, s * X, axle=0.02 * size)


@kind(
    walls=4,
    words="baby stroller, pram, baby carriage, pushchair, buggy for babies, baby buggy, doll carriage",
    size=(0.9, 1.1),
)
def stroller(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "frame",
        box(p(-0.2, -0.35, 0.45), p(0.2, 0.3, 0.7)),
        [beam(0.025 * size, 0.025 * size, p(s * 0.215, -0.3, 0.55), p(s * 0.215, 0.35, 0.15), X) for s in (-1, 1)],
        [beam(0.025 * size, 0.025 * size, p(s * 0.215, 0.35, 0.5), p(s * 0.215, -0.3, 0.2), X) for s in (-1, 1)],
        [beam(0.025 * size, 0.025 * size, p(s * 0.215, 0.25, 0.5), p(s * 0.215, 0.6, 1), X) for s in (-1, 1)],
        b.rod(0.015 * size, p(-0.22, 0.6, 1), p(0.22, 0.6, 1)),
        [box(p(s * 0.225, 0, 0.5), p(s * 0.2, 0.08, 0.76)) for s in (-1, 1)],
        [box(p(s * 0.235, 0.3, 0.1), p(s * 0.2, 0.4, 0.2)) for s in (-1, 1)],
        [box(p(s * 0.235, -0.34, 0.16), p(s * 0.2, -0.26, 0.24)) for s in (-1, 1)],
        look="black metal",
    )
    b.cut("frame", box(p(-0.18, -0.33, 0.48), p(0.18, 0.28, 1)))
    b.part("hood", b.cylinder(0.3 * size, p(-0.238, 0.04, 0.72), p(0.238, 0.04, 0.72)), look="blue")
    b.cut(
        "hood",
        b.cylinder(0.285 * size, p(-0.2385 + 0.008, 0.04, 0.72), p(0.2305, 0.04, 0.72)),
        box(p(-1, -1, 0), p(1, 1, 0.735)),
        box(p(-1, -1, 0), p(1, -0.02, 2)),
    )
    b.hinge("hood", "frame", X, p(0, 0.04, 0.735), 0.8, lower=0)
    for k, (y, s) in enumerate([(y, s) for y in (-0.3, 0.35) for s in (-1, 1)]):
        wheel(b, f"wheel_{k}", "frame", p(s * 0.265, y, 0.14), 0.14 * size, 0.04 * size, s * X, axle=0.008 * size)


@kind(walls=12, words="camper trailer, mobile home")
def caravan(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.15)
    p = scaled(size)
    b.part(
        "body",
        box(p(-1.8, -1, 0.5), p(1.8, 1, 2.5)),
        box(p(-2.6, -0.05, 0.5), p(-1.79, 0.05, 0.6)),
        box(p(-2.45, -0.04, 0), p(-2.37, 0.04, 0.51)),
        box(p(-0.25, -0.9, 0.3), p(0.25, 0.9, 0.51)),
        look="white metal",
    )
    b.cut(
        "body",
        box(p(-1.72, -0.92, 0.58), p(1.72, 0.92, 2.42)),
        box(p(0.6, -2, 0.6), p(1.3, 0, 2.3)),
        box(p(-1.3, -2, 1.3), p(0.1, 0, 2.1)),
    )
    leaf(b, "door", "body", p(0.58, -1.04, 0.58), p(1.32, -1.001, 2.32), hinge=X, out=-Y, reach=1.7, material="metal")
    leaf(
        b,
        "flap",
        "body",
        p(-1.32, -1.04, 1.28),
        p(0.12, -1.001, 2.12),
        hinge=Z,
        out=-Y,
        reach=1.6,
        handle=False,
        material="metal",
    )
    for k, s in enumerate((-1, 1)):
        wheel(
            b,
            f"wheel_{k}",
            "body",
            p(0, s * 1.08 if s > 0 else -1.08, 0.33),
            0.33 * size,
            0.14 * size,
            s * Y,
            axle=0.09 * size,
        )


@kind(words="railway signal, semaphore signal, rail signal", height=(1.0, 4.0))
def semaphore(b: ObjectBuilder, height: float) -> None:
    b.part(
        "mast",
        slab(0.2, 0.2, (0, 0.05)),
        b.cylinder(0.05, 0.04, height + 0.1),
        b.cylinder(0.02, (0, 0, height - 0.1), (0, -0.1, height - 0.1)),
        look="white steel",
    )
    b.part("arm", box((-0.1, -0.09, height - 0.17), (0.6, -0.075, height - 0.03)), look="red steel")
    b.cut("arm", b.cylinder(0.022, (0, -1, height - 0.1), (0, 1, height - 0.1)))
    b.hinge("arm", "mast", Y, (0, 0, height - 0.1), 0.8, lower=0)


@kind(
    "railroad switch",
    words="railway switch, rail points, track switch",
)
def rail_switch(b: ObjectBuilder) -> None:
    size = b.pick(0.5, 0.1)
    p = scaled(size)
    b.part(
        "bed",
        [box(p(x - 0.12, -1.2, 0), p(x + 0.12, 1.2, 0.12)) for x in spread(5, -1.5, 1.5)],
        [box(p(-1.5, s * 0.75 - 0.05, 0.12), p(1.5, s * 0.75 + 0.05, 0.28)) for s in (-1, 1)],
        box(p(-0.3, 1.2, 0), p(0.3, 1.9, 0.1)),
        box(p(-0.1, 0.9, 0), p(0.1, 1.3, 0.1)),
        look="brown steel",
    )
    b.part(
        "blade",
        [
            box(
                p(-1.4, s * 0.75 - (0.16 if s > 0 else -0.09), 0.125),
                p(0.8, s * 0.75 - (0.09 if s > 0 else -0.16), 0.27),
            )
            for s in (-1, 1)
        ],
        box(p(-1.2, -0.62, 0.125), p(-1.1, 0.62, 0.17)),
        look="steel",
    )
    b.slide("blade", "bed", Y, 0.03 * size, lower=-0.03 * size)
    b.part(
        "lever",
        beam(0.08 * size, 0.08 * size, p(0, 1.6, 0.14), p(0, 1.6, 1), Y),
        b.cylinder(0.1 * size, p(0, 1.5, 0.9), p(0, 1.7, 0.9)),
        look="red steel",
    )
    b.hinge("lever", "bed", X, p(0, 1.6, 0.14), 0.6, lower=-0.6)
