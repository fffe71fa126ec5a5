"""Trolleys, carts and lifts."""

from __future__ import annotations

from kinematify.generate.library.kind import kind
from kinematify.generate.library.mechanisms import wheel
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, slab, vector


@kind(walls=150, words="freight car, box wagon, railway wagon, goods wagon, cattle car")
def train_wagon(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.1)
    p = b.sized(size)
    b.part(
        "body",
        p.slab(3, 1.2, (1, 3.2)),
        [p.slab((x - 0.9, x + 0.9), 0.6, (0.5, 1.01)) for x in (-1.8, 1.8)],
        [p.box((-1.4, s * 1.2, z), (2.9, s * 1.32, z + 0.05)) for s in (-1, 1) for z in (0.98, 3.05)],
        look="brown steel",
    )
    b.cut("body", p.slab(2.95, 1.15, (1.05, 3.15)), p.slab(0.8, 2, (1.1, 3)))
    for k, s in enumerate((-1, 1)):
        b.part(f"door_{k}", p.slab(0.9, (s * 1.21, s * 1.28), (1.04, 3.04)), look="dark red steel")
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


@kind(walls=30, words="gondola lift, cable car cabin")
def cable_car(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.1)
    p = b.sized(size)
    b.part(
        "rope",
        p.cylinder(0.03, (-3, 3), 0, 3.6),
        [p.slab((s * 3 - 0.15, s * 3 + 0.15), 0.2, (0, 3.8)) for s in (-1, 1)],
        look="steel",
    )
    b.part(
        "trolley",
        p.slab(0.5, 0.2, (3.64, 3.8)),
        p.slab(0.06, (-0.3, -0.2), (3.2, 3.8)),
        p.slab(0.06, (-0.3, 0), (3.2, 3.3)),
        look="black steel",
    )
    b.slide("trolley", "rope", X, 1.6 * size, lower=-1.6 * size)
    b.part("cabin", p.slab(0.7, 0.6, (0.6, 2.4)), p.slab(0.05, 0.05, (2.39, 3.18)), look="red metal")
    b.cut("cabin", p.slab(0.65, 0.55, (0.65, 2.35)), p.slab(0.6, 1, (1.3, 2.2)), p.slab(0.3, (-1, 0), (0.7, 2.3)))
    b.hinge("cabin", "trolley", Y, p(0, 0, 3.2), 0.2, -0.2)
    b.part("door", p.slab(0.34, (-0.65, -0.61), (0.68, 2.32)), look="glass")
    b.slide("door", "cabin", X, 0.33 * size)


@kind(walls=20, words="carriage, stagecoach")
def horse_carriage(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.15)
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.8, 0.6, (0.8, 2)),
        p.slab(0.5, 0.65, (0.55, 0.8)),
        [p.box((0.79, s * 0.3, 0.7), (1, s * 0.25, 0.9)) for s in (-1, 1)],
        look="dark red wood",
    )
    b.cut("body", p.slab(0.72, 0.53, (0.87, 1.93)), p.slab(0.3, (-1, 0), (0.9, 1.9)), p.slab(0.6, (0, 1), (1.3, 1.8)))
    leaf(b, "door", "body", p(-0.31, -0.63, 0.88), p(0.31, -0.601, 1.92), hinge=X, reach=0.7)
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
        p.beam(0.06, 0.06, (0.92, -0, 0.8), (2.4, 0, 0.8)),
        p.slab((0.88, 0.96), 0.24, (0.76, 0.84)),
        look="wood",
    )
    b.hinge("shaft", "body", -Y, p(0.92, 0, 0.8), 0.4, -0.2)


@kind(walls=40, words="snow scooter")
def snowmobile(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.15)
    p = b.sized(size)
    b.part(
        "body",
        p.prism([(-1.2, 0.1), (0.6, 0.1), (1.1, 0.35), (0.5, 0.75), (0.1, 0.65), (-1.2, 0.6)], (0, 0, 0.05), 0.5, "y"),
        p.slab((-1.2, 0.2), 0.2, (0, 0.16)),
        [p.box((0.55, s * 0.24, 0.18), (0.75, s * 0.4, 0.26)) for s in (-1, 1)],
        look="orange",
    )
    for k, s in enumerate((-1, 1)):
        b.part(
            f"ski_{k}",
            p.cylinder(0.03, 0.65, s * 0.35, (0.06, 0.178)),
            p.box((0.2, s * 0.35 - 0.06, 0), (1.2, s * 0.35 + 0.06, 0.04)),
            p.cylinder(0.05, 0.65, s * 0.35, (0.03, 0.08)),
            look="black metal",
        )
        b.hinge(f"ski_{k}", "body", Z, p(0.65, s * 0.35, 0), 0.4, -0.4)
    b.part("body", p.cylinder(0.04, 0.3, 0, (0.7, 0.82)))
    b.part(
        "handlebar",
        p.cylinder(0.05, 0.3, 0, (0.822, 0.88)),
        p.rod(0.025, 0.2, (-0.35, 0.35), 0.92),
        p.beam(0.05, 0.05, (0.3, 0, 0.86), (0.19, 0, 0.92)),
        look="black steel",
    )
    b.hinge("handlebar", "body", Z, p(0.3, 0, 0), 0.6, -0.6)


@kind(walls=20, words="soap box, soapbox car")
def go_kart(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.2)
    p = b.sized(size)
    b.part(
        "frame",
        p.slab(0.75, 0.25, (0.08, 0.13)),
        p.slab((-0.7, -0.5), 0.45, (0.1, 0.16)),
        p.slab((0.5, 0.6), 0.45, (0.1, 0.16)),
        p.slab((-0.3, 0.1), 0.2, (0.12, 0.2)),
        p.beam(0.36, 0.06, (-0.28, 0, 0.15), (-0.45, 0, 0.6), X),
        p.beam(0.04, 0.04, (0.6, 0, 0.12), (0.3, 0, 0.45)),
        look="red steel",
    )
    up = vector(-0.673, 0, 0.74)
    b.part(
        "steering_wheel",
        p.torus(0.14, 0.014, (0.29, 0, 0.5), up),
        [beam(0.02 * size, 0.015 * size, p(0.29, 0, 0.5), p(0.29, 0, 0.5) + 0.14 * size * v, up) for v in (Y, -Y)],
        b.cylinder(0.02 * size, p(0.29, 0, 0.5) - 0.035 * size * up, p(0.29, 0, 0.5) + 0.01 * size * up),
        look="rubber",
    )
    b.hinge("steering_wheel", "frame", up, p(0.29, 0, 0.5), 1.2, -1.2)
    for i, (x, s) in enumerate([(x, s) for x in (-0.6, 0.55) for s in (-1, 1)]):
        wheel(b, f"wheel_{i}", "frame", p(x, s * 0.53, 0.14), 0.14 * size, 0.12 * size, s * Y, axle=0.02 * size)


@kind(walls=110, words="concrete truck, mixer truck")
def cement_truck(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.1)
    p = b.sized(size)
    b.part(
        "truck",
        p.slab(3.5, 0.5, (0.8, 1.05)),
        p.slab((2, 3.6), 1.15, (1.03, 2.9)),
        [p.slab((x - 0.15, x + 0.15), 0.9, (1, z)) for x, z in ((-2.3, 1.2), (1.62, 1.55))],
        p.slab((1.48, 1.75), 0.3, (1.5, 2.3)),
        p.slab((-3.4, -3.1), 0.7, (1, 2.9)),
        [p.slab((x - 0.2, x + 0.2), 0.85, (0.5, 0.85)) for x in (-2.2, -1, 2.7)],
        look="white steel",
    )
    b.cut("truck", p.slab((2.05, 3.55), 1.1, (1.1, 2.85)), p.slab((-2.5, -2.1), 2, (1.2, 3)))
    b.part(
        "drum",
        p.cone(0.6, 1.1, (1.42, 0, 2.2), (0.3, 0, 2.3)),
        p.cylinder(1.1, (0.31, -0.6), 0, 2.3),
        p.cone(1.1, 0.45, (-0.59, -2.6), 0, 2.3),
        look="grey steel",
    )
    b.cut("drum", p.cylinder(0.4, (-3, 0.8), 0, 2.3), p.cylinder(1.02, (-0.5, 0.2), 0, 2.3))
    b.spin("drum", "truck", X, p(0, 0, 2.3))
    b.part(
        "chute",
        p.cylinder(0.06, -3.55, 0, (1.3, 1.7)),
        p.beam(0.3, 0.05, (-3.55, 0, 1.68), (-4.8, 0, 1.2)),
        look="black steel",
    )
    b.part("truck", p.slab((-3.6, -3.35), 0.1, (1.1, 1.27)))
    b.hinge("chute", "truck", Z, p(-3.55, 0, 0), 1.2, -1.2)
    for i, (x, s) in enumerate([(x, s) for x in (-2.2, -1, 2.7) for s in (-1, 1)]):
        wheel(b, f"wheel_{i}", "truck", p(x, s * 1.02, 0.5), 0.5 * size, 0.3 * size, s * Y, axle=0.02 * size)


@kind(walls=110, words="turntable ladder, aerial ladder, fire engine with ladder")
def ladder_truck(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.1)
    p = b.sized(size)
    b.part(
        "truck",
        p.slab((-3.2, 1.6), 1.1, (0.6, 1.3)),
        p.slab((1.7, 3.2), 1.15, (0.6, 1.8)),
        p.slab((1.5, 1.8), 0.5, (0.6, 1)),
        look="red steel",
    )
    b.cut("truck", p.slab((-3.1, 1.5), 1.05, (0.9, 1.22)), p.slab((1.78, 3.12), 1.08, (0.68, 1.72)))
    b.part(
        "turntable",
        p.cylinder(0.8, -2, 0, (1.302, 1.5)),
        [p.box((-2.4, s * 0.5, 1.45), (-1.9, s * 0.4, 2.1)) for s in (-1, 1)],
        look="black steel",
    )
    b.spin("turntable", "truck", Z, p(-2, 0, 0))
    b.part(
        "ladder",
        [p.box((-2.3, s * 0.38, 1.85), (3, s * 0.33, 2.05)) for s in (-1, 1)],
        [p.slab((x - 0.03, x + 0.03), 0.35, (1.86, 1.92)) for x in spread(10, -2.3, 3)],
        look="metal",
    )
    b.hinge("ladder", "turntable", -Y, p(-2.2, 0, 1.95), 0.9)
    b.part(
        "extension",
        [p.box((-2, s * 0.31, 1.94), (3.3, s * 0.26, 2.12)) for s in (-1, 1)],
        [p.slab((x - 0.03, x + 0.03), 0.28, (2, 2.06)) for x in spread(10, -2, 3.3)],
        look="metal",
    )
    b.slide("extension", "ladder", X, 3.5 * size)
    for i, (x, s) in enumerate([(x, s) for x in (-2.2, 2.4) for s in (-1, 1)]):
        wheel(b, f"wheel_{i}", "truck", p(x, s * 1.3, 0.5), 0.5 * size, 0.26 * size, s * Y, axle=0.02 * size)


@kind(words="mars rover, moon rover, rover, lunar rover, exploration robot", size=(0.5, 1.2))
def planet_rover(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.5, 0.35, (0.5, 0.75)),
        p.cylinder(0.04, 0, (-0.44, 0.44), 0.55),
        p.slab((-0.6, 0.3), 0.4, (0.75, 0.78)),
        look="white metal",
    )
    for k, s in enumerate((-1, 1)):
        b.part(
            f"rocker_{k}",
            p.tube(0.07, 0.0425, 0, (s * 0.37, s * 0.43), 0.55),
            p.beam(0.05, 0.05, (0.05, s * 0.4, 0.54), (0.6, s * 0.4, 0.25), Y),
            p.beam(0.05, 0.05, (-0.05, s * 0.4, 0.54), (-0.6, s * 0.4, 0.25), Y),
            p.beam(0.05, 0.05, (0, s * 0.4, 0.5), (0, s * 0.4, 0.25), Y),
            [p.cylinder(0.025, x, (s * 0.38, s * 0.44), 0.2) for x in (-0.6, 0, 0.6)],
            [p.beam(0.04, 0.04, (x, s * 0.4, 0.26), (x, s * 0.4, 0.2), Y) for x in (-0.6, 0, 0.6)],
            look="metal",
        )
        b.hinge(f"rocker_{k}", "body", Y, p(0, s * 0.4, 0.55), 0.2, -0.2)
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
        p.cylinder(0.03, 0.4, 0.2, (0.752, 1.2)),
        [p.box((0.38, 0.2 + s * 0.06, 1.17), (0.42, 0.2 + s * 0.045, 1.3)) for s in (-1, 1)],
        p.box((0.38, 0.14, 1.17), (0.42, 0.26, 1.2)),
        look="white metal",
    )
    b.spin("mast", "body", Z, p(0.4, 0.2, 0))
    b.part("camera", p.box((0.36, 0.158, 1.225), (0.46, 0.242, 1.32)), look="black")
    b.hinge("camera", "mast", Y, p(0.4, 0.2, 1.27), 0.3, -0.3)


@kind(words="space probe, spacecraft, cubesat", size=(0.3, 1.5))
def satellite(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part("bus", p.slab(0.3, 0.3, (0, 0.8)), p.cylinder(0.05, 0.79, 0.9), look="gold metal")
    for k, s in enumerate((-1, 1)):
        b.part(
            f"arm_{k}",
            p.cylinder(0.02, (s * 0.302, s * 0.45), 0, 0.4),
            p.slab((s * 0.45, s * 1.1), 0.25, (0.385, 0.41)),
            look="dark blue metal",
        )
        b.spin(f"arm_{k}", "bus", s * X, p(0, 0, 0.4))
        b.part(f"panel_{k}", p.slab((s * 1.102, s * 1.75), 0.25, (0.385, 0.41)), look="dark blue metal")
        b.hinge(f"panel_{k}", f"arm_{k}", s * -Y, p(s * 1.101, 0, 0.41), 2.2)
    b.part("dish", p.cone(0.06, 0.25, 0.99, 1.1), p.cylinder(0.04, 0.93, 1), look="white metal")
    b.cut("dish", p.cone(0.03, 0.235, 1.02, 1.101))
    b.hinge("dish", "bus", X, p(0, 0, 0.9), 0.25, -0.25)


@kind(words="self balancing scooter", size=(0.9, 1.1))
def segway(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "deck",
        p.slab(0.2, 0.15, (0.2, 0.3)),
        [p.slab((s * 0.03, s * 0.022), 0.02, (0.29, 0.38)) for s in (-1, 1)],
        look="black",
    )
    b.part(
        "handle",
        p.beam(0.04, 0.04, (0, 0, 0.33), (0, 0.06, 1.15), Y),
        p.rod(0.02, (-0.25, 0.25), 0.06, 1.15),
        look="steel",
    )
    b.hinge("handle", "deck", X, p(0, 0, 0.352), 0.1, -0.1)
    for k, s in enumerate((-1, 1)):
        wheel(b, f"wheel_{k}", "deck", p(s * 0.27, 0, 0.24), 0.24 * size, 0.1 * size, s * X, axle=0.02 * size)


@kind(
    walls=4,
    words="baby stroller, pram, baby carriage, pushchair, buggy for babies, baby buggy, doll carriage",
    size=(0.9, 1.1),
)
def stroller(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "frame",
        p.slab(0.2, (-0.35, 0.3), (0.45, 0.7)),
        [p.beam(0.025, 0.025, (s * 0.215, -0.3, 0.55), (s * 0.215, 0.35, 0.15), X) for s in (-1, 1)],
        [p.beam(0.025, 0.025, (s * 0.215, 0.35, 0.5), (s * 0.215, -0.3, 0.2), X) for s in (-1, 1)],
        [p.beam(0.025, 0.025, (s * 0.215, 0.25, 0.5), (s * 0.215, 0.6, 1), X) for s in (-1, 1)],
        p.rod(0.015, (-0.22, 0.22), 0.6, 1),
        [p.box((s * 0.225, 0, 0.5), (s * 0.2, 0.08, 0.76)) for s in (-1, 1)],
        [p.box((s * 0.235, 0.3, 0.1), (s * 0.2, 0.4, 0.2)) for s in (-1, 1)],
        [p.box((s * 0.235, -0.34, 0.16), (s * 0.2, -0.26, 0.24)) for s in (-1, 1)],
        look="black metal",
    )
    b.cut("frame", p.slab(0.18, (-0.33, 0.28), (0.48, 1)))
    b.part("hood", p.cylinder(0.3, (-0.238, 0.238), 0.04, 0.72), look="blue")
    b.cut(
        "hood",
        p.cylinder(0.285, (-0.2385 + 0.008, 0.2305), 0.04, 0.72),
        p.slab(1, 1, (0, 0.735)),
        p.slab(1, (-1, -0.02), (0, 2)),
    )
    b.hinge("hood", "frame", X, p(0, 0.04, 0.735), 0.8, 0)
    for k, (y, s) in enumerate([(y, s) for y in (-0.3, 0.35) for s in (-1, 1)]):
        wheel(b, f"wheel_{k}", "frame", p(s * 0.265, y, 0.14), 0.14 * size, 0.04 * size, s * X, axle=0.008 * size)


@kind(walls=12, words="camper trailer")
def caravan(b: ObjectBuilder) -> None:
    size = b.pick(1, 0.15)
    p = b.sized(size)
    b.part(
        "body",
        p.slab(1.8, 1, (0.5, 2.5)),
        p.slab((-2.6, -1.79), 0.05, (0.5, 0.6)),
        p.slab((-2.45, -2.37), 0.04, (0, 0.51)),
        p.slab(0.25, 0.9, (0.3, 0.51)),
        look="white metal",
    )
    b.cut(
        "body",
        p.slab(1.72, 0.92, (0.58, 2.42)),
        p.box((0.6, -2, 0.6), (1.3, 0, 2.3)),
        p.box((-1.3, -2, 1.3), (0.1, 0, 2.1)),
    )
    leaf(b, "door", "body", p(0.58, -1.04, 0.58), p(1.32, -1.001, 2.32), hinge=X, reach=1.7, material="metal")
    leaf(b, "flap", "body", p(-1.32, -1.04, 1.28), p(0.12, -1.001, 2.12), hinge=Z, handle=False, material="metal")
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
        b.cylinder(0.02, 0, (0, -0.1), height - 0.1),
        look="white steel",
    )
    b.part("arm", box((-0.1, -0.09, height - 0.17), (0.6, -0.075, height - 0.03)), look="red steel")
    b.cut("arm", b.cylinder(0.022, 0, (-1, 1), height - 0.1))
    b.hinge("arm", "mast", Y, (0, 0, height - 0.1), 0.8, 0)


@kind("railroad switch", words="railway switch, rail points, track switch")
def rail_switch(b: ObjectBuilder) -> None:
    size = b.pick(0.5, 0.1)
    p = b.sized(size)
    b.part(
        "bed",
        [p.slab((x - 0.12, x + 0.12), 1.2, (0, 0.12)) for x in spread(5, -1.5, 1.5)],
        [p.slab(1.5, (s * 0.75 - 0.05, s * 0.75 + 0.05), (0.12, 0.28)) for s in (-1, 1)],
        p.slab(0.3, (1.2, 1.9), (0, 0.1)),
        p.slab(0.1, (0.9, 1.3), (0, 0.1)),
        look="brown steel",
    )
    b.part(
        "blade",
        [
            p.box(
                (-1.4, s * 0.75 - (0.16 if s > 0 else -0.09), 0.125), (0.8, s * 0.75 - (0.09 if s > 0 else -0.16), 0.27)
            )
            for s in (-1, 1)
        ],
        p.slab((-1.2, -1.1), 0.62, (0.125, 0.17)),
        look="steel",
    )
    b.slide("blade", "bed", Y, 0.03 * size, lower=-0.03 * size)
    b.part(
        "lever",
        p.beam(0.08, 0.08, (0, 1.6, 0.14), (0, 1.6, 1), Y),
        p.cylinder(0.1, 0, (1.5, 1.7), 0.9),
        look="red steel",
    )
    b.hinge("lever", "bed", X, p(0, 1.6, 0.14), 0.6, -0.6)
