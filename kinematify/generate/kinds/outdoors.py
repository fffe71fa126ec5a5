"""Things of a garden and a playground."""

from __future__ import annotations

from math import cos, sin
from typing import TYPE_CHECKING

from kinematify.generate.library.builder import spread
from kinematify.generate.library.kind import kind, length
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, scaled, tray

if TYPE_CHECKING:
    from kinematify.generate.library.builder import ObjectBuilder


@kind(
    "swing seat",
    words=(
        "garden swing seat, hollywood swing, canopy swing, swing bench, glider chair, hanging chair, porch glider, "
        "porch swing"
    ),
    part_words={"seat": "bench, swing"},
    details={"roof": 1, "frame": 1},
    width=length(1.2, 2.0),
)
def swing_seat(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "frame",
        [b.rod(0.025, (s * (w + 0.2), 0, 1.7), (s * (w + 0.2), t * 0.6, 0.03)) for s in (-1, 1) for t in (-1, 1)],
        b.rod(0.025, (-w - 0.2, 0, 1.7), (w + 0.2, 0, 1.7)),
        [b.rod(0.02, (s * (w + 0.2), -0.6, 0.03), (s * (w + 0.2), 0.6, 0.03)) for s in (-1, 1)],
        material="steel",
        color="green",
    )
    b.part(
        "seat",
        box((-w, -0.3, 0.42), (w, 0.25, 0.47)),
        box((-w, 0.2, 0.46), (w, 0.25, 0.95)),
        [b.rod(0.01, (s * (w - 0.03), t * 0.22, 0.46), (s * (w - 0.03), 0, 1.66)) for s in (-1, 1) for t in (-1, 1)],
        [b.torus(0.042, 0.008, (s * (w - 0.03), 0, 1.7), X) for s in (-1, 1)],
        material="wood",
    )
    b.hinge("seat", parent="frame", axis=X, pivot=(0, 0, 1.7), lower=-0.35, upper=0.35)
    b.part(
        "canopy",
        box((-w - 0.2, -0.6, 1.78), (w + 0.2, 0.6, 1.8)),
        [box((s * (w + 0.1) - 0.02, -0.02, 1.732), (s * (w + 0.1) + 0.02, 0.02, 1.79)) for s in (-1, 1)],
        color="green",
    )
    b.hinge("canopy", parent="frame", axis=X, pivot=(0, 0, 1.74), lower=-0.25, upper=0.25)


@kind(
    "pull-along duck",
    words="pull along duck, duck on wheels, toy duck",
    part_words={"wing": "wings"},
    details={"beak": 1},
    size=length(0.8, 1.5),
)
def pull_along_duck(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "body",
        box(p(-0.08, -0.03, 0.03), p(0.07, 0.03, 0.1)),
        b.cylinder(0.03 * size, p(0.06, -0.028, 0.075), p(0.06, 0.028, 0.075)),
        box(p(0.03, -0.02, 0.09), p(0.06, 0.02, 0.13)),
        beam(0.04 * size, 0.05 * size, p(-0.07, 0, 0.09), p(-0.11, 0, 0.12), Y),
        material="wood",
        color="yellow",
    )
    b.part(
        "head",
        b.cylinder(0.03 * size, p(0.05, -0.02, 0.165), p(0.05, 0.02, 0.165)),
        b.cone(0.014 * size, 0.004 * size, p(0.075, 0, 0.16), p(0.11, 0, 0.158)),
        material="wood",
        color="yellow",
    )
    b.hinge("head", parent="body", axis=Y, pivot=p(0.045, 0, 0.135), lower=-0.1, upper=0.25)
    for k, s in enumerate((-1, 1)):
        b.part(
            f"wing_{k + 1}",
            box(p(-0.06, min(s * 0.031, s * 0.037), 0.05), p(0.02, max(s * 0.031, s * 0.037), 0.095)),
            material="wood",
            color="orange",
        )
        b.hinge(f"wing_{k + 1}", parent="body", axis=s * X, pivot=p(0, s * 0.034, 0.095), upper=1.2)
        for j, x in enumerate((-0.05, 0.045)):
            b.part(
                f"wheel_{2 * k + j + 1}",
                b.cylinder(0.025 * size, p(x, s * 0.034, 0.025), p(x, s * 0.046, 0.025)),
                material="wood",
                color="red",
            )
            b.spin(f"wheel_{2 * k + j + 1}", parent="body", axis=Y, pivot=p(x, 0, 0.025))


@kind(
    "dumbwaiter",
    words="dumb waiter, service lift, food lift, goods lift",
    part_words={"car": "cabin, platform, lift", "door": "hatch, sash, shutter"},
    height=length(1.8, 3.0),
)
def dumbwaiter(b: ObjectBuilder, height: float) -> None:
    h = height
    b.part(
        "shaft",
        box((-0.32, 0.3, 0), (0.32, 0.33, h)),
        [box((s * 0.32 - 0.01, -0.3, 0), (s * 0.32 + 0.01, 0.33, h)) for s in (-1, 1)],
        box((-0.32, -0.3, h - 0.02), (0.32, 0.33, h)),
        box((-0.32, -0.3, 0), (0.32, 0.33, 0.02)),
        box((-0.32, -0.3, 0), (0.32, -0.28, 0.5)),
        box((-0.32, -0.3, 1.3), (0.32, -0.28, h)),
        material="metal",
    )
    b.part(
        "car",
        box((-0.28, -0.25, 0.5), (0.28, 0.28, 0.52)),
        box((-0.28, -0.25, 0.98), (0.28, 0.28, 1.0)),
        box((-0.28, 0.26, 0.5), (0.28, 0.28, 1.0)),
        [box((s * 0.29 - 0.01, -0.25, 0.5), (s * 0.29 + 0.01, 0.28, 1.0)) for s in (-1, 1)],
        material="steel",
    )
    b.slide("car", parent="shaft", axis=Z, lower=-0.45, upper=h - 1.05)
    b.part(
        "door",
        box((-0.3, -0.325, 0.48), (0.3, -0.305, 0.92)),
        box((-0.06, -0.35, 0.5), (0.06, -0.324, 0.52)),
        material="steel",
        color="grey",
    )
    b.slide("door", parent="shaft", axis=Z, upper=0.42)


@kind(
    "cherry picker",
    walls=120,
    words="aerial work platform, boom lift, bucket truck, aerial lift, sky lift",
    part_words={
        "basket": "bucket, cage, platform",
        "turntable": "turret, cab",
        "lower_boom": "boom, lower arm",
        "upper_boom": "upper arm, boom",
    },
    size=length(0.8, 1.2),
)
def cherry_picker(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "chassis",
        box(p(-1.2, -0.55, 0.35), p(1.2, 0.55, 0.7)),
        b.cylinder(0.3 * size, p(-0.6, 0, 0.69), p(-0.6, 0, 0.78)),
        material="steel",
        color="yellow",
    )
    for k, s in enumerate((-1, 1)):
        for j, x in enumerate((-0.8, 0.8)):
            b.part(
                f"wheel_{2 * k + j + 1}",
                b.cylinder(0.32 * size, p(x, s * 0.551, 0.32), p(x, s * 0.78, 0.32)),
                material="rubber",
                color="black",
            )
            b.spin(f"wheel_{2 * k + j + 1}", parent="chassis", axis=Y, pivot=p(x, 0, 0.32))
    b.part(
        "turntable",
        b.cylinder(0.35 * size, p(-0.6, 0, 0.79), p(-0.6, 0, 0.88)),
        [box(p(-0.75, s * 0.2 - 0.03, 0.87), p(-0.45, s * 0.2 + 0.03, 1.25)) for s in (-1, 1)],
        material="steel",
        color="grey",
    )
    b.spin("turntable", parent="chassis", axis=Z, pivot=p(-0.6, 0, 0))
    b.part(
        "lower_boom",
        beam(0.2 * size, 0.2 * size, p(-0.6, 0, 1.15), p(1.0, 0, 1.75), Y),
        material="steel",
        color="yellow",
    )
    b.hinge("lower_boom", parent="turntable", axis=-Y, pivot=p(-0.6, 0, 1.15), lower=-0.2, upper=0.9)
    b.part(
        "upper_boom",
        beam(0.14 * size, 0.12 * size, p(1.0, 0.19, 1.75), p(-0.9, 0.19, 2.2), Y),
        b.cylinder(0.05 * size, p(0.98, 0.1, 1.745), p(0.98, 0.15, 1.745)),
        material="steel",
        color="yellow",
    )
    b.hinge("upper_boom", parent="lower_boom", axis=Y, pivot=p(1.0, 0.19, 1.75), lower=-0.15, upper=2.0)
    b.part(
        "basket",
        tray(p(-1.58, -0.1, 1.75), p(-1.0, 0.7, 2.4), 0.03 * size),
        b.cylinder(0.04 * size, p(-0.9, 0.251, 2.2), p(-0.9, 0.32, 2.2)),
        box(p(-1.01, 0.28, 2.17), p(-0.88, 0.32, 2.23)),
        material="steel",
        color="grey",
    )
    b.hinge("basket", parent="upper_boom", axis=-Y, pivot=p(-0.9, 0.25, 2.2), lower=-1.0, upper=1.0)


@kind(
    "capstan",
    words="ship's capstan, anchor capstan",
    part_words={"drum": "barrel, head", "bar": "lever"},
    size=length(0.7, 1.3),
)
def capstan(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "base",
        b.cylinder(0.4 * size, p(0, 0, 0), p(0, 0, 0.1)),
        b.cylinder(0.06 * size, p(0, 0, 0.09), p(0, 0, 0.9)),
        material="wood",
    )
    b.part(
        "drum",
        b.cylinder(0.2 * size, p(0, 0, 0.11), p(0, 0, 0.7)),
        b.cylinder(0.3 * size, p(0, 0, 0.68), p(0, 0, 0.85)),
        [
            b.rod(0.03 * size, p(0.28 * cos(a), 0.28 * sin(a), 0.77), p(1.1 * cos(a), 1.1 * sin(a), 0.77))
            for a in [6.28318 * k / 6 for k in range(6)]
        ],
        material="wood",
    )
    b.cut("drum", b.cylinder(0.063 * size, p(0, 0, 0), p(0, 0, 1)))
    b.spin("drum", parent="base", axis=Z, pivot=(0, 0, 0))


@kind(
    "porthole",
    words="ship's window, bullseye window, port light",
    part_words={"window": "glass, cover, lid, door", "dog": "screw, wing nut, clamp, latch"},
    radius=length(0.12, 0.25),
)
def porthole(b: ObjectBuilder, radius: float) -> None:
    r = radius
    b.part(
        "frame",
        b.tube(1.35 * r, 0.95 * r, (0, 0, 0), (0, 0.12 * r, 0)),
        [
            box((-1.45 * r, -0.22 * r, s * 0.3 * r - 0.07 * r), (-1.2 * r, 0.05 * r, s * 0.3 * r + 0.07 * r))
            for s in (-1, 1)
        ],
        material="brass",
    )
    b.bore("frame", b.cylinder(0.05 * r, (-1.33 * r, -0.12 * r, -r), (-1.33 * r, -0.12 * r, r)))
    b.part(
        "window",
        b.cylinder(1.12 * r, (0, -0.18 * r, 0), (0, -0.04 * r, 0)),
        b.cylinder(0.04 * r, (-1.33 * r, -0.12 * r, -0.36 * r), (-1.33 * r, -0.12 * r, 0.36 * r)),
        box((-1.33 * r, -0.16 * r, -0.2 * r), (-1.0 * r, -0.08 * r, 0.2 * r)),
        material="glass",
    )
    b.hinge("window", parent="frame", axis=-Z, pivot=[-1.33 * r, -0.12 * r, 0], upper=1.7)
    for k, s in enumerate((-1, 1)):
        b.part(
            f"dog_{k + 1}",
            b.cylinder(0.06 * r, (0.95 * r, -0.3 * r, s * 0.82 * r), (0.95 * r, -0.005 * r, s * 0.82 * r)),
            box((0.88 * r, -0.3 * r, s * 0.82 * r - 0.25 * r), (1.02 * r, -0.22 * r, s * 0.82 * r + 0.05 * r)),
            material="brass",
        )
        b.hinge(f"dog_{k + 1}", parent="frame", axis=Y, pivot=[0.95 * r, 0, s * 0.82 * r], upper=1.5)


@kind(
    "puppet theatre",
    words="puppet theater, puppet stage, toy theatre, toy theater",
    part_words={"curtain": "drape"},
    width=length(0.5, 1.2),
)
def puppet_theatre(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "stage",
        box((-w, 0, 0), (w, 0.3, 0.4 * width)),
        [box((x - 0.07 * w, 0, 0.3 * width), (x + 0.07 * w, 0.03, 1.1 * width)) for x in (-0.93 * w, 0.93 * w)],
        box((-w, 0, 0.95 * width), (w, 0.03, 1.2 * width)),
        b.cylinder(0.008, (-0.9 * w, 0.05, 0.97 * width), (0.9 * w, 0.05, 0.97 * width)),
        [box((x - 0.03, 0.02, 0.96 * width), (x + 0.03, 0.06, 0.985 * width)) for x in (-0.95 * w, 0.95 * w)],
        material="wood",
    )
    for k, s in enumerate((-1, 1)):
        left, right = sorted((s * 0.005, s * 0.45 * w))
        b.part(
            f"curtain_{k + 1}",
            box((left, 0.04, 0.42 * width), (right, 0.06, 0.97 * width - 0.012)),
            [b.torus(0.013, 0.003, (s * x * w, 0.05, 0.97 * width), X) for x in (0.08, 0.25, 0.4)],
            color="red",
        )
        b.slide(f"curtain_{k + 1}", parent="stage", axis=s * X, upper=0.4 * w)


@kind(
    "dish rack",
    words="dish drainer, draining rack, plate rack",
    part_words={"tray": "drip tray, drawer"},
    details={"wire": 1},
    width=length(0.35, 0.55),
)
def dish_rack(b: ObjectBuilder, width: float) -> None:
    w = width / 2
    b.part(
        "rack",
        [b.rod(0.004, (s * w, -0.15, 0.06), (s * w, 0.15, 0.06)) for s in (-1, 1)],
        [b.rod(0.004, (-w, t * 0.15, 0.06), (w, t * 0.15, 0.06)) for t in (-1, 1)],
        [b.rod(0.004, (s * w, t * 0.15, 0.004), (s * w, t * 0.15, 0.17)) for s in (-1, 1) for t in (-1, 1)],
        [b.rod(0.003, (x, -0.15, 0.06), (x, 0.15, 0.06)) for x in spread(9, -w + 0.03, w - 0.03)],
        [b.rod(0.003, (x, 0.05, 0.06), (x, 0.05, 0.15)) for x in spread(9, -w + 0.03, w - 0.03)],
        [b.rod(0.004, (-w, t * 0.15, 0.17), (w, t * 0.15, 0.17)) for t in (-1, 1)],
        [b.rod(0.004, (s * w, -0.15, 0.012), (s * w, 0.15, 0.012)) for s in (-1, 1)],
        material="steel",
    )
    b.part("tray", tray((-w + 0.006, -0.16, 0.017), (w - 0.006, 0.14, 0.045), 0.003), color="grey")
    b.slide("tray", parent="rack", axis=-Y, upper=0.2)


@kind(
    "bread slicer",
    words="meat slicer, food slicer, bread cutter, ham slicer, bacon slicer, slicing machine",
    part_words={"blade": "disc, knife", "carriage": "sled, table", "crank": "hand crank, handle"},
    size=length(0.9, 1.3),
)
def bread_slicer(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "body",
        box(p(-0.16, -0.18, 0), p(0.16, 0.18, 0.03)),
        box(p(0.02, -0.05, 0.025), p(0.12, 0.05, 0.2)),
        material="metal",
        color="white",
    )
    b.bore("body", b.cylinder(0.012 * size, p(-1, 0, 0.15), p(1, 0, 0.15)))
    b.part(
        "blade",
        b.cylinder(0.1 * size, p(0.008, 0, 0.15), p(0.012, 0, 0.15)),
        b.cylinder(0.01 * size, p(0.01, 0, 0.15), p(0.16, 0, 0.15)),
        material="steel",
    )
    b.spin("blade", parent="body", axis=X, pivot=p(0, 0, 0.15))
    b.part(
        "crank",
        beam(0.02 * size, 0.012 * size, p(0.168, 0, 0.15), p(0.168, 0, 0.06), X),
        b.rod(0.009 * size, p(0.17, 0, 0.06), p(0.23, 0, 0.06)),
        material="metal",
    )
    b.fix("crank", parent="blade")
    b.part(
        "carriage",
        box(p(-0.14, -0.12, 0.034), p(-0.01, 0.06, 0.044)),
        box(p(-0.14, 0.05, 0.04), p(-0.01, 0.06, 0.16)),
        material="metal",
    )
    b.slide("carriage", parent="body", axis=Y, lower=-0.05, upper=0.1)


@kind(
    "laboratory stirrer",
    words="lab stirrer, overhead stirrer, stirrer, stirring machine, agitator",
    part_words={"paddle": "impeller, propeller, blade, stirrer shaft", "head": "motor, drive"},
    size=length(0.9, 1.3),
)
def laboratory_stirrer(b: ObjectBuilder, size: float) -> None:
    p = scaled(size)
    b.part(
        "stand",
        box(p(-0.12, -0.16, 0), p(0.12, 0.12, 0.02)),
        b.cylinder(0.009 * size, p(0, 0.08, 0.015), p(0, 0.08, 0.7)),
        material="steel",
    )
    b.part("head", box(p(-0.05, -0.1, 0.46), p(0.05, 0.1, 0.56)), color="white")
    b.bore(
        "head",
        b.cylinder(0.0098 * size, p(0, 0.08, 0), p(0, 0.08, 1)),
        b.cylinder(0.006 * size, p(0, -0.04, 0.4), p(0, -0.04, 0.52)),
    )
    b.slide("head", parent="stand", axis=Z, lower=-0.1, upper=0.13)
    b.part(
        "paddle",
        b.cylinder(0.005 * size, p(0, -0.04, 0.17), p(0, -0.04, 0.51)),
        [box(p(s * 0.02 - 0.018, -0.042, 0.17), p(s * 0.02 + 0.018, -0.038, 0.2)) for s in (-1, 1)],
        material="steel",
    )
    b.spin("paddle", parent="head", axis=Z, pivot=p(0, -0.04, 0))
