"""Vehicles on land and water, and in the air."""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.kinds.vehicles import axles
from kinematify.generate.library.kind import kind, length, whole
from kinematify.generate.library.mechanisms import arm, caster, rotor, wheel
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.builder import spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, block, box, prism, slab, vector

if TYPE_CHECKING:
    from kinematify.generate.procedural.builder import ObjectBuilder


@kind("parametric tractor", like="tractor", radius=length(0.6, 0.9), q=length(0.3, 0.45))
def parametric_tractor(b: ObjectBuilder, radius: float, q: float) -> None:
    """Large wheels behind, small ones in front on a swinging axle; a three-point arm."""
    b.part(
        "body",
        slab((-0.7, 1.4), 0.3, (radius - 0.2, radius + 0.4)),
        slab((-0.7, 0.1), 0.5, (radius + 0.3, radius + 0.45)),
        b.cylinder(0.04, (1, 0.1, radius + 0.3), (1, 0.1, radius + 0.9)),
        look="steel",
    )
    for s, side in ((-1, "right"), (1, "left")):
        wheel(
            b,
            f"rear_{side}",
            parent="body",
            middle=(-0.4, s * 0.75, radius),
            radius=radius,
            wide=0.4,
            out=s * Y,
            axle=0.25,
        )
    g = b.gap(0.1) + 0.005
    b.part(
        "axle",
        slab((1.1, 1.2), 0.55, (q - 0.05, q + 0.05)),
        slab((1.1, 1.2), 0.06, (q, radius - 0.2 - g)),
        look="steel",
    )
    b.hinge("axle", parent="body", axis=X, pivot=(1.15, 0, q), upper=0.1, lower=-0.1, ajar=False)
    for s, side in ((-1, "right"), (1, "left")):
        wheel(b, f"front_{side}", parent="axle", middle=(1.15, s * 0.68, q), radius=q, wide=0.2, out=s * Y, axle=0.03)
    b.part("hitch", beam(0.5, 0.06, (-0.71 - g, 0, radius), (-1.4, 0, radius - 0.2)))
    b.hinge("hitch", parent="body", axis=Y, pivot=(-0.71 - g, 0, radius + 0.04), upper=0.4, ajar=False)
    b.part(
        "steering",
        b.cylinder(
            0.02, (0.2, 0, radius + 0.4 + b.gap(0.02) + (0.006 if b.style.has_bore else 0)), (0.12, 0, radius + 0.7)
        ),
        b.torus(0.18, 0.015, (0.12, 0, radius + 0.7), vector(-0.25, 0, 0.97)),
    )
    b.hinge(
        "steering",
        parent="body",
        axis=vector(-0.08, 0, 0.3) / np.hypot(0.08, 0.3),
        pivot=(0.2, 0, radius + 0.4),
        upper=3.0,
        lower=-3.0,
        ajar=False,
    )


@kind("parametric bicycle", like="bicycle", radius=length(0.28, 0.36), b=length(0.9, 1.1))
def parametric_bicycle(d: ObjectBuilder, radius: float, b: float) -> None:
    """A frame, a fork that steers, two wheels, cranks."""
    t = 0.02
    head = vector(b - 0.18, 0, radius + 0.44)
    top = vector(b - 0.22, 0, radius + 0.6)
    seat = vector(0.3, 0, radius + 0.5)
    axle = vector(0.42, 0, radius - 0.05)
    d.part(
        "frame", [d.cylinder(t, p, q) for p, q in ((head, axle), (top, seat), (seat, axle), (head, top))], look="steel"
    )
    for s in (-0.05, 0.05):
        d.part(
            "frame",
            d.cylinder(0.6 * t, (0, s, radius), axle + s * Y),
            d.cylinder(0.6 * t, (0, s, radius), seat + s * 0.3 * Y),
            beam(0.06, 0.03, axle - 0.06 * Y, axle + 0.06 * Y),
        )
    d.part(
        "frame",
        d.rod(0.05, seat + vector(-0.1, 0, 0.12), seat + vector(0.1, 0, 0.12)),
        d.cylinder(t, seat, seat + 0.12 * Z),
    )
    axis = (top - head) / np.linalg.norm(top - head)
    g = d.gap(0.03)
    low = head - (0.055 + g) * axis
    foot = vector(b, 0, radius)
    d.part(
        "fork",
        [d.cylinder(0.6 * t, low + s * Y, foot + s * Y) for s in (-0.05, 0.05)],
        beam(0.03, 0.03, low - 0.06 * Y, low + 0.06 * Y),
        look="steel",
    )
    if d.style.has_bore:
        d.part("fork", d.cylinder(0.4 * t, low, top + 0.2 * axis))
        d.cut("frame", d.cylinder(0.4 * t + 1.5 * g, low - 0.05 * axis, top + 0.1 * axis))
    else:
        d.part("fork", d.cylinder(0.8 * t, low, top + 0.2 * axis))
    bar = top + 0.2 * axis
    d.part("fork", d.cylinder(0.6 * t, bar - 0.28 * Y, bar + 0.28 * Y))
    d.hinge("fork", parent="frame", axis=axis, pivot=head, upper=0.7, lower=-0.7, ajar=False)
    for name, on, at in (("rear_wheel", "frame", vector(0, 0, radius)), ("front_wheel", "fork", foot)):
        d.part(
            name,
            d.torus(radius - 0.02, 0.018, at, Y),
            d.cylinder(0.03, at - 0.03 * Y, at + 0.03 * Y),
            [
                beam(0.004, 0.004, at - (radius - 0.02) * v, at + (radius - 0.02) * v)
                for v in (X, Z, (X + Z) / 1.41421, (X - Z) / 1.41421)
            ],
            look="rubber",
        )
        d.spin(name, parent=on, axis=Y, pivot=at)
    for s in (-1, 1):
        d.part(
            "cranks",
            beam(0.012, 0.03, axle + s * 0.075 * Y, axle + s * 0.075 * Y + s * 0.17 * X),
            d.cylinder(0.012, axle + s * 0.07 * Y + s * 0.16 * X, axle + s * 0.17 * Y + s * 0.16 * X),
            look="metal",
        )
    d.part("cranks", d.cylinder(0.008, axle - 0.08 * Y, axle + 0.08 * Y))
    d.bore("frame", d.cylinder(0.008 + 1.5 * d.gap(0.02) + 0.0005, axle - 0.2 * Y, axle + 0.2 * Y))
    d.spin("cranks", parent="frame", axis=Y, pivot=axle)


@kind(
    "parametric scooter",
    like="kick_scooter",
    length=length(0.5, 0.7),
    radius=length(0.05, 0.1),
    height=length(0.7, 1.0),
)
def scooter(b: ObjectBuilder, length: float, radius: float, height: float) -> None:
    """A kick scooter: a deck, a steering column, two wheels."""
    g = b.gap(0.02) + 0.0005
    b.part(
        "deck",
        slab((0, length), 0.06, (0.07, 0.09)),
        [box((-2.2 * radius, s, radius - 0.015), (0.02, s * 1.4, 0.085)) for s in (-0.03, 0.03)],
        look="metal",
    )
    b.part(
        "deck",
        beam(0.04, 0.04, (length - 0.01, 0, 0.08), (length + 0.08, 0, 0.2)),
        b.tube(0.028, 0.02 if b.style.has_bore else 0.001, (length + 0.08, 0, 0.17), (length + 0.08, 0, 0.27)),
    )
    b.bore(
        "deck",
        b.cylinder(0.02, (length + 0.08, 0, 0.1), (length + 0.08, 0, 0.3)),
        b.cylinder(0.054, (length + 0.08, 0, 0.05), (length + 0.08, 0, 0.142)),
    )
    b.part(
        "column",
        b.cylinder(0.02 - (g if b.style.has_bore else 0), (length + 0.08, 0, 0.12), (length + 0.08, 0, height)),
        b.cylinder(0.014, (length + 0.08, -0.2, height), (length + 0.08, 0.2, height)),
        slab((length + 0.055, length + 0.105), 0.045, (0.12, 0.14)),
        look="metal",
    )
    for s in (-0.04, 0.04):
        b.part("column", beam(0.03, 0.008, (length + 0.08, s, 0.14), (length + 0.1, s, 0.035), Y))
    b.hinge("column", parent="deck", axis=Z, pivot=(length + 0.08, 0, 0.2), upper=0.9, lower=-0.9, ajar=False)
    for name, on, x in (("rear_wheel", "deck", -1.4 * radius), ("front_wheel", "column", length + 0.1)):
        q = 0.045 if on == "column" else radius
        b.part(name, b.cylinder(q, (x, -0.025, q), (x, 0.025, q)), look="rubber")
        b.spin(name, parent=on, axis=Y, pivot=(x, 0, q))


@kind(
    "parametric wheelbarrow",
    like="wheelbarrow",
    length=length(0.7, 0.9),
    width=length(0.5, 0.65),
    radius=length(0.15, 0.2),
)
def parametric_wheelbarrow(b: ObjectBuilder, length: float, width: float, radius: float) -> None:
    """A tray, two handles, one wheel in a fork."""
    b.part(
        "barrow",
        prism(
            [(-0.4 * length, 0.35), (0.35 * length, 0.35), (0.55 * length, 0.65), (-0.5 * length, 0.65)],
            (0, 0, 0),
            width,
            "y",
        ),
        look="steel",
    )
    if b.style.hollow:
        b.cut(
            "barrow",
            prism(
                [(-0.38 * length, 0.37), (0.34 * length, 0.37), (0.54 * length, 0.7), (-0.5 * length, 0.7)],
                (0, 0, 0),
                width - 0.04,
                "y",
            ),
        )
    for s in (-1, 1):
        b.part(
            "barrow",
            b.cylinder(0.018, (-1.2 * length, s * 0.3, 0.6), (-0.3 * length, s * 0.2, 0.34)),
            b.cylinder(0.018, (-0.3 * length, s * 0.2, 0.34), (0.62 * length, s * 0.08, radius)),
            b.cylinder(0.018, (-0.4 * length, s * 0.2, 0.36), (-0.4 * length, s * 0.2, 0)),
        )
    at = vector(0.6 * length, 0, radius)
    b.part("wheel", b.cylinder(radius, at - 0.04 * Y, at + 0.04 * Y), look="rubber")
    if b.style.barrels and (not b.style.has_bore):
        b.part(f"{b.pick('wheel', 'barrow')}", b.cylinder(0.01, at - 0.09 * Y, at + 0.09 * Y))
    b.spin("wheel", parent="barrow", axis=Y, pivot=at)


@kind(
    "parametric hand truck",
    like="hand_truck",
    width=length(0.35, 0.5),
    height=length(1.0, 1.3),
    radius=length(0.08, 0.14),
)
def parametric_hand_truck(b: ObjectBuilder, width: float, height: float, radius: float) -> None:
    """A sack truck with two wheels and a plate that folds up."""
    for s in (-1, 1):
        b.part("frame", b.cylinder(0.016, (s * width / 2, 0, 0.03), (s * width / 2, 0, height)), look="steel")
    b.part(
        "frame",
        [b.cylinder(0.012, (-width / 2, 0, z), (width / 2, 0, z)) for z in (0.06, 0.4 * height, 0.7 * height, height)],
    )
    b.part(
        "frame",
        [beam(0.024, 0.02, (s * width / 2, 0, radius), (s * width / 2, 0.1, radius)) for s in (-1, 1)],
        b.cylinder(0.01, (-width / 2 - 0.005, 0.1, radius), (width / 2 + 0.005, 0.1, radius)),
    )
    for s in (-1, 1):
        wheel(
            b,
            f"wheel_{int(s > 0)}",
            parent="frame",
            middle=(s * (width / 2 + 0.05), 0.1, radius),
            radius=radius,
            wide=0.05,
            out=s * X,
            axle=0.012,
        )
    g = b.gap(0.03) + 0.001
    y = -0.018 - g
    b.part("plate", slab(0.45 * width, (-0.25, y), (0.025, 0.033)), look="steel")
    b.hinge("plate", parent="frame", axis=-X, pivot=(0, y, 0.029), upper=1.5, ajar=False)


@kind(
    "parametric wheelchair",
    like="wheelchair",
    part_words={"rest": "footrest, foot rest, leg rest"},
    width=length(0.42, 0.52),
    radius=length(0.28, 0.32),
)
def parametric_wheelchair(b: ObjectBuilder, width: float, radius: float) -> None:
    """Two large wheels, two casters, foot rests that swing up."""
    z = 0.5
    b.part(
        "chair",
        slab(0.22, width / 2, (z, z + 0.03)),
        slab((-0.25, -0.22), width / 2, (z, z + 0.45)),
        [slab(0.25, (s * width / 2, s * (width / 2 - 0.03)), (0.25, z + 0.2)) for s in (-1, 1)],
        look="steel",
    )
    axles(b, "chair", xs=(-0.15,), half=width / 2, radius=radius, wide=0.03, axle=0.03)
    for k, s in enumerate((-1, 1)):
        b.part(
            "chair",
            beam(0.03, 0.03, (0.22, s * (width / 2 - 0.015), 0.3), (0.35, s * (width / 2 - 0.015), 0.17), Y),
            block((0.35, s * (width / 2 - 0.015), 0.175), (0.05, 0.05, 0.05)),
        )
        caster(b, f"caster_{k}", parent="chair", top=(0.35, s * (width / 2 - 0.015), 0.15), high=0.15)
        g = b.gap(0.02) + 0.001
        b.part(
            f"rest_{k}",
            beam(0.02, 0.02, (0.26 + g, s * 0.1, 0.45), (0.48, s * 0.1, 0.16), Y),
            box((0.44, s * 0.03, 0.15), (0.56, s * 0.15, 0.16)),
        )
        b.part(
            "chair",
            b.cylinder(0.012, (0.2, s * 0.1, 0.47), (0.25, s * 0.1, 0.45)),
            box((0.18, s * 0.08, 0.46), (0.22, s * 0.12, z + 0.01)),
        )
        b.hinge(f"rest_{k}", parent="chair", axis=Y * -1, pivot=(0.26 + g, s * 0.1, 0.45), upper=0.9, ajar=False)


@kind("parametric helicopter", like="helicopter", size=length(0.1, 1.0))
def parametric_helicopter(b: ObjectBuilder, size: float) -> None:
    """A main rotor, a tail rotor, a door on each side."""
    p = b.sized(size)
    b.part(
        "hull",
        p.rod(0.6, (-0.5, 0, 1.2), (0.6, 0, 1.2)),
        p.cone(0.3, 0.1, (-0.8, 0, 1.4), (-3.2, 0, 1.6)),
        p.cylinder(0.12, 1.7, 2),
        p.slab((-3.3, -3), 0.03, (1.5, 2.2)),
        look="metal",
    )
    for s in (-1, 1):
        b.part(
            "hull",
            p.cylinder(0.04, (-0.8, s * 0.5, 0.3), (0.9, s * 0.5, 0.3)),
            [p.cylinder(0.03, (x, s * 0.5, 0.3), (x, s * 0.3, 0.8)) for x in (-0.4, 0.5)],
        )
    rotor(
        b,
        "main_rotor",
        parent="hull",
        at=(0, 0, 2 * size),
        out=Z,
        radius=b.draw(2, 2.6) * size,
        blades=b.count(2, 5),
        wide=0.07,
    )
    b.part("hull", p.cylinder(0.06, (-3.15, 0, 1.8), (-3.15, 0.2, 1.8)))
    rotor(
        b,
        "tail_rotor",
        parent="hull",
        at=(-3.15 * size, 0.2 * size, 1.8 * size),
        out=Y,
        radius=0.5 * size,
        blades=b.count(2, 4),
    )


@kind("light aircraft", like="airplane", length=length(5.0, 8.0), b=length(7.0, 11.0))
def light_aircraft(d: ObjectBuilder, length: float, b: float) -> None:
    """A propeller, ailerons, an elevator, a rudder, wheels."""
    k = d.pick(1, 0.1)
    p = d.sized(k)
    d.part(
        "airframe",
        d.cone(0.6 * k, 0.15 * k, p(0.25 * length, 0, 1.2), p(-0.7 * length, 0, 1.4)),
        d.cone(0.6 * k, 0.3 * k, p(0.25 * length, 0, 1.2), p(0.33 * length, 0, 1.2)),
        look="metal",
    )
    z = d.pick(0.9, 1.75)
    d.part(
        "airframe",
        box(p(-0.05 * length, -b / 2, z), p(0.12 * length, b / 2, z + 0.12)),
        box(p(-0.68 * length, -1.4, 1.4), p(-0.58 * length, 1.4, 1.46)),
        box(p(-0.68 * length, -0.03, 1.4), p(-0.58 * length, 0.03, 2.4)),
        box(p(-0.05 * length, -0.2, 1), p(0.1 * length, 0.2, 1.8)),
    )
    g = d.gap(0.1 * k) / k + 0.001
    for k2, s in enumerate((-1, 1)):
        d.part(
            f"aileron_{k2}",
            box(
                p(-0.11 * length, s * 0.3 * b, z + 0.02),
                p(-0.05 * length - g - (0.02 if d.style.has_bore else 0), s * 0.49 * b, z + 0.1),
            ),
        )
        d.hinge(
            f"aileron_{k2}",
            parent="airframe",
            axis=Y,
            pivot=p(-0.05 * length - g, 0, z + d.pick(0.06, 0.06, 0.1)),
            upper=0.4,
            lower=-0.02 if d.style.has_bore else -0.4,
            ajar=False,
        )
    d.part(
        "elevator",
        box(p(-0.74 * length, -1.4, 1.41), p(-0.68 * length - g - 0.04, -0.2, 1.45)),
        box(p(-0.74 * length, 0.2, 1.41), p(-0.68 * length - g - 0.04, 1.4, 1.45)),
        box(p(-0.74 * length, -0.2, 1.42), p(-0.72 * length, 0.2, 1.44)),
    )
    d.hinge(
        "elevator", parent="airframe", axis=Y, pivot=p(-0.68 * length - g, 0, 1.43), upper=0.4, lower=-0.4, ajar=False
    )
    d.part("rudder", box(p(-0.74 * length, -0.02, 1.75), p(-0.68 * length - g - 0.04, 0.02, 2.4)))
    d.hinge("rudder", parent="airframe", axis=Z, pivot=p(-0.68 * length - g, 0, 1.5), upper=0.4, lower=-0.4, ajar=False)
    rotor(
        d,
        "propeller",
        parent="airframe",
        at=p(0.33 * length, 0, 1.2),
        out=X,
        radius=0.95 * k,
        blades=d.count(2, 3),
        wide=0.12,
    )
    for i, (x, y) in enumerate(((0.05 * length, -1.1), (0.05 * length, 1.1))):
        d.part("airframe", d.cylinder(0.05 * k, p(x, 0.2 * np.sign(y), 1), p(x, y * 0.86, 0.22)))
        wheel(
            d,
            f"wheel_{i}",
            parent="airframe",
            middle=p(x, y, 0.22),
            radius=0.2 * k,
            wide=0.14 * k,
            out=np.sign(y) * Y,
            axle=0.04 * k,
        )


@kind("parametric drone", like="drone", radius=length(0.1, 0.4))
def parametric_drone(b: ObjectBuilder, radius: float) -> None:
    """A quadcopter: four or six rotors on arms, a camera that tilts."""
    n = b.pick(4, 4, 6)
    b.part("frame", block((0, 0, 0.25 * radius), (0.6 * radius, 0.4 * radius, 0.15 * radius)))
    for k, a in enumerate((np.arange(n) + 0.5) * 2 * pi / n):
        tip = vector(1.1 * radius * cos(a), 1.1 * radius * sin(a), 0.25 * radius)
        b.part(
            "frame",
            beam(0.08 * radius, 0.05 * radius, (0, 0, 0.25 * radius), tip),
            b.cylinder(0.09 * radius, tip - 0.05 * radius * Z, tip + 0.12 * radius * Z),
            b.cylinder(0.02 * radius, tip - 0.05 * radius * Z, (tip[0], tip[1], 0)),
        )
        rotor(
            b, f"rotor_{k}", parent="frame", at=tip + 0.12 * radius * Z, out=Z, radius=0.5 * radius, blades=2, wide=0.14
        )
    g = b.gap(0.1 * radius)
    b.part(
        "camera",
        ball(0.09 * radius, (0.3 * radius + 0.1 * radius + g, 0, 0.22 * radius)),
        b.cylinder(0.05 * radius, (0.4 * radius, 0, 0.22 * radius), (0.55 * radius, 0, 0.22 * radius)),
    )
    b.hinge(
        "camera", parent="frame", axis=Y, pivot=(0.4 * radius + g, 0, 0.22 * radius), upper=1.0, lower=-0.3, ajar=False
    )


@kind("parametric sailing boat", like="sailboat", length=length(2.0, 6.0))
def sailing_boat(b: ObjectBuilder, length: float) -> None:
    """A hull, a boom that swings at the mast, a rudder with a tiller."""
    p = b.sized(length)
    b.part(
        "hull",
        p.prism([(-0.5, -0.16), (0.25, -0.17), (0.5, 0), (0.25, 0.17), (-0.5, 0.16)], (0, 0, 0.08), 0.16, "z"),
        p.cylinder(0.012, (0.1, 0, 0.1), (0.1, 0, 1.2)),
        look="wood",
    )
    if b.style.hollow:
        b.cut("hull", p.slab((-0.45, 0.05), 0.13, (0.1, 0.3)))
    g = b.gap(0.02 * length) + 0.0005
    z = 0.28 * length
    b.part(
        "boom", b.cylinder(0.01 * length, (0.1 * length - 0.012 * length - g, 0, z), (-0.4 * length, 0, z)), look="wood"
    )
    if b.maybe(0.7):
        b.part(
            "boom",
            prism(
                [(0.08 * length, z), (-0.4 * length, z), (0.085 * length, 1.15 * length)],
                (0, 0, 0),
                0.004 * length,
                "y",
            ),
        )
    b.hinge(
        "boom",
        parent="hull",
        axis=Z,
        pivot=(0.1 * length, 0, z) if b.maybe() else (0.088 * length - g, 0, z),
        upper=1.2,
        lower=-1.2,
    )
    x = -0.5 * length - g
    b.part(
        "rudder",
        slab((x - 0.1 * length, x - 0.01 * length), 0.008 * length, (-0.15 * length, 0.2 * length)),
        beam(0.02 * length, 0.02 * length, (x - 0.05 * length, 0, 0.2 * length), (x + 0.2 * length, 0, 0.24 * length)),
        look="wood",
    )
    b.hinge("rudder", parent="hull", axis=Z, pivot=(x, 0, 0), upper=0.7, lower=-0.7)


@kind("parametric rowing boat", like="rowing_boat", length=length(2.0, 4.0))
def parametric_rowing_boat(b: ObjectBuilder, length: float) -> None:
    """Two oars in their locks."""
    p = b.sized(length)
    b.part(
        "hull",
        p.prism([(-0.5, -0.12), (0.2, -0.18), (0.5, 0), (0.2, 0.18), (-0.5, 0.12)], (0, 0, 0.1), 0.2, "z"),
        look="wood",
    )
    if b.style.hollow:
        b.cut(
            "hull",
            p.prism([(-0.46, -0.1), (0.18, -0.15), (0.4, 0), (0.18, 0.15), (-0.46, 0.1)], (0, 0, 0.15), 0.2, "z"),
        )
    g = b.gap(0.02 * length) + 0.0005
    for k, s in enumerate((-1, 1)):
        y = s * 0.16 * length
        b.part("hull", block((0, y, 0.2 * length), (0.06 * length, 0.04 * length, 0.03 * length)))
        z = 0.215 * length + g + 0.012 * length
        b.part(
            f"oar_{k}",
            b.cylinder(0.012 * length, (0, s * 0.05 * length, z), (0, s * 0.6 * length, z)),
            block((0, s * 0.65 * length, z), (0.06 * length, 0.14 * length, 0.01 * length)),
            look="wood",
        )
        if b.style.barrels:
            holder = b.pick("hull", f"oar_{k}")
            b.part(f"{holder}", b.cylinder(0.006 * length, (0, y, 0.2 * length), (0, y, z)))
        b.hinge(f"oar_{k}", parent="hull", axis=Z, pivot=(0, y, 0.2 * length), upper=0.7, lower=-0.7)


@kind("parametric forklift", like="forklift", radius=length(0.22, 0.3))
def parametric_forklift(b: ObjectBuilder, radius: float) -> None:
    """A carriage that rises on a mast, wheels, a seat lid."""
    n = 1.6
    w = 1.0
    b.part(
        "truck",
        slab(n / 2, w / 2, (0.15, 0.8)),
        [
            box((n / 2, s * 0.42 * w - 0.05, 0.08), (n / 2 + 0.1, s * 0.42 * w + 0.05, b.draw(1.8, 2.4)))
            for s in (-1, 1)
        ],
        [b.cylinder(0.03, (x, s * 0.45 * w, 0.7), (x, s * 0.45 * w, 1.9)) for s in (-1, 1) for x in (-0.4, 0.5)],
        slab((-0.5, 0.6), 0.5 * w, (1.88, 1.92)),
        look="steel",
    )
    g = b.gap(0.05) + 0.001
    x = n / 2 + 0.1 + g
    b.part(
        "carriage",
        slab((x, x + 0.04), 0.45 * w, (0.1, 0.6)),
        [box((x, s * 0.3 - 0.06, 0.06), (x + 1, s * 0.3 + 0.06, 0.1)) for s in (-1, 1)],
        look="steel",
    )
    b.slide("carriage", parent="truck", axis=Z, upper=1.2)
    for i, x in enumerate((-0.5, 0.45)):
        for s in (-1, 1):
            wheel(
                b,
                f"wheel_{i}_{int(s > 0)}",
                parent="truck",
                middle=(x, s * (w / 2 + 0.07), radius),
                radius=radius,
                wide=0.12,
                out=s * Y,
                axle=0.01,
            )
    leaf(
        b,
        "seat",
        parent="truck",
        lower=(-0.6, -0.3, 0.8),
        upper=(-0.05, 0.3, 0.9),
        hinge=X,
        out=Z,
        reach=1.2,
        handle=False,
    )


@kind("parametric digger", like="excavator", size=length(0.1, 1.0))
def digger(b: ObjectBuilder, size: float) -> None:
    """A turntable on tracks, boom, stick and bucket."""
    p = b.sized(size)
    b.part(
        "tracks",
        [p.rod(0.35, (-1.2, s * 1, 0.35), (1.2, s * 1, 0.35)) for s in (-1, 1)],
        p.slab(0.9, 1, (0.2, 0.6)),
        p.cylinder(0.7, 0.5, 0.8),
        look="steel",
    )
    g = b.gap(0.1 * size)
    b.part(
        "house",
        box(p(-1.3, -0.9, 0.8) + g * Z, p(1, 0.9, 1.3)),
        p.box((-0.2, 0.1, 1.2), (0.95, 0.85, 2.3)),
        look="steel",
    )
    b.spin("house", parent="tracks", axis=Z, pivot=(0, 0, 0.8 * size))
    a = p(1.25, -0.3, 1.1)
    b_ = p(3, -0.3, 3)
    c = p(4.6, -0.3, 1.8)
    b.part("house", p.box((0.9, -0.42, 0.95), (1.4, -0.18, 1.25)))
    arm(b, "boom", parent="house", start=a, end=b_, thick=0.26 * size, axis=Y, lower=-0.3, upper=0.4)
    arm(
        b,
        "stick",
        parent="boom",
        start=b_ + (0.26 * size + b.gap(0.26 * size) if b.style.has_bore else 0) * Y,
        end=c + (0.26 * size + b.gap(0.26 * size) if b.style.has_bore else 0) * Y,
        thick=0.2 * size,
        axis=Y,
        side=0.24 * size if b.style.has_bore else 0,
        lower=-0.5,
        upper=0.5,
    )
    c = c + (0.5 * size + 2 * b.gap(0.26 * size) if b.style.has_bore else 0) * Y
    b.part(
        "bucket",
        prism(
            [
                (-0.1 * size, 0.1 * size),
                (0.25 * size, 0.1 * size),
                (0.35 * size, -0.5 * size),
                (-0.35 * size, -0.6 * size),
            ],
            c + (0.35 * size + g if b.style.has_bore else 0) * Y,
            0.5 * size,
            "y",
        ),
        look="steel",
    )
    b.hinge("bucket", parent="stick", axis=Y, pivot=c, upper=0.8, lower=-0.3, ajar=False)


@kind("swing", like="swing", number=whole(1, 3, words="seat, swing"), width=length(1.5, 3.0), height=length(1.6, 2.3))
def parametric_swing(b: ObjectBuilder, number: int, width: float, height: float) -> None:
    """Seats on ropes below a beam."""
    b.part(
        "frame",
        b.cylinder(0.05, (-width / 2, 0, height), (width / 2, 0, height)),
        [
            beam(0.07, 0.07, (s * width / 2, 0, height), (s * width / 2, t * 0.8, 0), X)
            for s in (-1, 1)
            for t in (-1, 1)
        ],
        look="wood",
    )
    g = b.gap(0.05)
    for k, x in enumerate(spread(number, -0.46 * width, 0.46 * width)):
        a = min(0.25, 0.3 * width / number)
        top = height - 0.05 - g if not b.style.barrels else height
        b.part(
            f"seat_{k}",
            slab((x - a, x + a), 0.12, (0.42, 0.45)),
            [b.cylinder(0.01, (x + s * 0.9 * a, 0, 0.43), (x + s * 0.9 * a, 0, top)) for s in (-1, 1)],
            look="wood",
        )
        b.hinge(
            f"seat_{k}",
            parent="frame",
            axis=X,
            pivot=(0, 0, b.pick(height, top)) if not b.style.has_bore else (0, 0, height),
            upper=0.8,
            lower=-0.8,
            ajar=False,
        )


@kind("parametric seesaw", like="seesaw", length=length(1.5, 3.0), height=length(0.35, 0.6))
def parametric_seesaw(b: ObjectBuilder, length: float, height: float) -> None:
    """A plank on a block or a post."""
    b.part(
        "stand",
        prism([(-0.3, 0), (0.3, 0), (0.05, height - 0.02), (-0.05, height - 0.02)], (0, 0, 0), 0.2, "y"),
        look="wood",
    )
    g = b.gap(0.05)
    b.part(
        "plank",
        slab(length / 2, 0.12, (height + g, height + g + 0.04)),
        [
            b.cylinder(0.015, (s * 0.4 * length, -0.12, height + 0.25), (s * 0.4 * length, 0.12, height + 0.25))
            for s in (-1, 1)
        ],
        [b.cylinder(0.015, (s * 0.4 * length, 0, height), (s * 0.4 * length, 0, height + 0.25)) for s in (-1, 1)],
        look="wood",
    )
    if not b.style.has_bore:
        b.part(f"{b.pick('stand', 'plank')}", b.cylinder(0.03, (0, -0.13, height), (0, 0.13, height)))
    b.hinge(
        "plank", parent="stand", axis=Y, pivot=(0, 0, height + (g if b.style.has_bore else 0)), upper=0.3, lower=-0.3
    )


@kind("parametric merry go round", like="merry_go_round", radius=length(0.8, 1.6))
def parametric_merry_go_round(b: ObjectBuilder, radius: float) -> None:
    """A disc with rails on a post."""
    b.part("base", b.cylinder(0.15 * radius, 0, 0.15), look="steel")
    g = b.gap(0.1)
    b.part("disc", b.cylinder(radius, 0.15 + g, 0.2 + g), look="wood")
    n = b.count(3, 6)
    for a in np.arange(n) * 2 * pi / n:
        p = (0.9 * radius * cos(a), 0.9 * radius * sin(a))
        q = (0.3 * radius * cos(a), 0.3 * radius * sin(a))
        b.part(
            "disc",
            b.cylinder(0.02, (*p, 0.16 + g), (*p, 0.8)),
            b.cylinder(0.02, (*p, 0.8), (*q, 0.8)),
            b.cylinder(0.02, (*q, 0.16 + g), (*q, 0.8)),
        )
    b.spin("disc", parent="base", axis=Z, pivot=(0, 0, 0.15))


@kind(
    "parametric ferris wheel",
    like="ferris_wheel",
    radius=length(0.3, 3.0),
    number=whole(4, 8, words="gondola, cabin, car, seat"),
)
def parametric_ferris_wheel(b: ObjectBuilder, radius: float, number: int) -> None:
    """A wheel on two stands with gondolas that hang."""
    h = 1.25 * radius
    for s in (-1, 1):
        b.part(
            "stand",
            [
                beam(0.06 * radius, 0.06 * radius, (s * 0.3 * radius, t * 0.6 * radius, 0), (s * 0.3 * radius, 0, h), X)
                for t in (-1, 1)
            ],
            look="steel",
        )
    b.part("stand", slab(0.33 * radius, 0.7 * radius, (-0.05 * radius, 0)))
    axle = b.cylinder(0.03 * radius, (-0.3 * radius, 0, h), (0.3 * radius, 0, h))
    b.part("stand", axle)
    g = b.gap(0.03 * radius)
    for s in (-1, 1):
        b.part(
            "wheel",
            b.torus(radius, 0.02 * radius, (s * 0.18 * radius, 0, h), X),
            b.cylinder(0.08 * radius, (s * 0.16 * radius, 0, h), (s * 0.2 * radius, 0, h)),
            look="steel",
        )
    angles = np.arange(number) * 2 * pi / number + 0.3
    for k, a in enumerate(angles):
        u = vector(0, cos(a), sin(a))
        at = vector(0, 0, h) + radius * u
        b.part(
            "wheel",
            [
                beam(0.03 * radius, 0.03 * radius, (s * 0.18 * radius, 0, h), at + s * 0.18 * radius * X, X)
                for s in (-1, 1)
            ],
            b.cylinder(0.015 * radius, at - 0.18 * radius * X, at + 0.18 * radius * X),
        )
        low = at - 0.03 * radius * Z
        b.part(
            f"gondola_{k}",
            block(low - 0.1 * radius * Z, (0.2 * radius, 0.16 * radius, 0.1 * radius)),
            [
                beam(
                    0.02 * radius,
                    0.02 * radius,
                    low + s * 0.09 * radius * X - 0.06 * radius * Z,
                    low + s * 0.09 * radius * X + 0.05 * radius * Z,
                    X,
                )
                for s in (-1, 1)
            ],
        )
        b.bore(f"gondola_{k}", b.cylinder(0.0155 * radius + 1.5 * g, at - radius * X, at + radius * X))
        b.spin(f"gondola_{k}", parent="wheel", axis=X, pivot=at)
    b.bore("wheel", b.cylinder(0.03 * radius + 1.5 * g + 0.0005 * radius, (-radius, 0, h), (radius, 0, h)))
    b.spin("wheel", parent="stand", axis=X, pivot=(0, 0, h))


@kind("parametric water wheel", like="water_wheel", radius=length(0.3, 2.0))
def parametric_water_wheel(b: ObjectBuilder, radius: float) -> None:
    """Paddles between two rings, between walls."""
    w = 0.0
    w = 0.4 * radius
    for s in (-1, 1):
        b.part(
            "walls",
            slab((s * (w / 2 + 0.05 * radius), s * (w / 2 + 0.2 * radius)), 0.5 * radius, (0, 1.2 * radius)),
            look="wood",
        )
    b.part("walls", slab(w, 1.2 * radius, (-0.1 * radius, 0)))
    g = b.gap(0.05 * radius)
    c = vector(0, 0, 1.1 * radius)
    b.part(
        "wheel",
        b.cylinder(0.06 * radius, c - (w / 2 + 0.15 * radius) * X, c + (w / 2 + 0.15 * radius) * X),
        [b.tube(0.9 * radius, 0.8 * radius, c + s * w / 2 * X, c + s * (w / 2 - 0.04 * radius) * X) for s in (-1, 1)],
        look="wood",
    )
    n = b.count(6, 10)
    for a in np.arange(n) * 2 * pi / n:
        u = vector(0, cos(a), sin(a))
        b.part("wheel", beam(w - 0.03 * radius, 0.03 * radius, c, c + radius * u, np.cross(X, u)))
    b.bore("walls", b.cylinder(0.06 * radius + 1.5 * g + 0.0001, c - radius * X, c + radius * X))
    b.spin("wheel", parent="walls", axis=X, pivot=c)


@kind("well with a windlass", like="well", radius=length(0.4, 0.7), height=length(0.6, 0.9))
def well_with_windlass(b: ObjectBuilder, radius: float, height: float) -> None:
    """A roller with a crank above a well, a bucket beside."""
    b.part(
        "well",
        b.tube(radius, 0.85 * radius, 0, height),
        [
            slab((s * 0.93 * radius - 0.04, s * 0.93 * radius + 0.04), 0.05, (0.5 * height, height + 0.7))
            for s in (-1, 1)
        ],
        look="ceramic",
    )
    g = b.gap(0.05) + 0.0005
    z = height + 0.5
    end = radius + 0.06
    b.part(
        "roller",
        b.cylinder(0.08, (-0.93 * radius + 0.045 + g, 0, z), (0.93 * radius - 0.045 - g, 0, z)),
        b.cylinder(0.02, (-0.93 * radius, 0, z), (end + 0.1, 0, z)),
        beam(0.03, 0.03, (end + 0.1, 0, z), (end + 0.1, 0.22, z)),
        b.cylinder(0.015, (end + 0.1, 0.21, z), (end + 0.25, 0.21, z)),
        look="wood",
    )
    b.bore("well", b.cylinder(0.02 + 1.5 * g, (-0.93 * radius - 0.02, 0, z), (radius + 1, 0, z)))
    b.spin("roller", parent="well", axis=X, pivot=(0, 0, z))


@kind(
    "parametric garden gate",
    like="door",
    width=length(0.8, 1.2),
    height=length(0.9, 1.6),
    number=whole(1, 2, words="leaf, wing"),
)
def garden_gate(b: ObjectBuilder, width: float, height: float, number: int) -> None:
    """One or two leaves of slats between posts."""
    g = b.gap(0.05) + 0.001
    posts = (-width * number / 2 - 0.06, width * number / 2 + 0.06)
    b.part(
        "posts",
        [slab((x - 0.05, x + 0.05), 0.05, (0, height + 0.15)) for x in posts],
        slab((posts[0], posts[1]), 0.05, (-0.05, 0.005)),
        look="wood",
    )
    for k in range(number):
        s = -1 if k == 0 else 1
        x0, x1 = sorted((s * width * number / 2, s * width * (number / 2 - 1) + s * g))
        x0 = x0 + (g - 0.01 if s < 0 else 0)
        x1 = x1 - (g - 0.01 if s > 0 else 0)
        slats = [slab((x - 0.03, x + 0.03), 0.012, (0.06, height)) for x in spread(b.count(5, 8), x0 + 0.01, x1 - 0.01)]
        y = 0.012
        rails = [box((x0, y - 0.001, z), (x1, y + 0.025, z + 0.07)) for z in (0.15, height - 0.2)]
        b.part(f"leaf_{k}", slats, rails, look="wood")
        pivot = (s * width * number / 2 + s * 0.005 * b.style.barrels, b.pick(-0.05, -0.05, -0.012), 0)
        b.hinge(f"leaf_{k}", parent="posts", axis=Z * s, pivot=pivot, upper=b.draw(1.2, 1.6))


@kind("parametric barrier", like="barrier", length=length(1.5, 4.0), height=length(0.9, 1.1))
def parametric_barrier(b: ObjectBuilder, length: float, height: float) -> None:
    """A boom that goes up beside a post."""
    b.part("post", slab(0.15, 0.12, (0, height + 0.1)), look="steel")
    g = b.gap(0.1)
    y = -0.12 - g
    b.part("boom", beam(0.05, 0.1, (-0.35, y - 0.025, height), (length, y - 0.025, height)), look="metal")
    if b.maybe():
        b.part("boom", block((-0.35, y - 0.05, height), (0.25, 0.1, 0.2)))
    if b.style.barrels and (not b.style.has_bore):
        b.part(f"{b.pick('boom', 'post')}", b.cylinder(0.03, (0, 0, height), (0, y - 0.06, height)))
    b.hinge("boom", parent="post", axis=-Y, pivot=(0, y, height), upper=1.5)


@kind("parametric turnstile", like="turnstile", height=length(0.85, 1.0))
def parametric_turnstile(b: ObjectBuilder, height: float) -> None:
    """Three arms on a slanted hub, or a wing."""
    b.part("cabinet", slab(0.15, 0.5, (0, height)), look="steel")
    g = b.gap(0.05)
    at = vector(0.15, 0, height - 0.12)
    if b.maybe():
        b.part(
            "arms",
            b.cylinder(0.05, at + g * X, at + 0.08 * X),
            [
                b.cylinder(0.02, at + 0.05 * X, at + 0.05 * X + 0.45 * vector(0.5, 0.87 * cos(a), 0.87 * sin(a)))
                for a in np.arange(3) * 2 * pi / 3
            ],
            look="steel",
        )
        b.spin("arms", parent="cabinet", axis=X, pivot=at)
    else:
        b.part("cabinet", b.cylinder(0.04, (0.19, 0, 0), (0.19, 0, 0.1)))
        b.part(
            "arms",
            b.cylinder(0.04, (0.2, 0, 0.1 + g), (0.2, 0, height)),
            slab((0.2, 0.75), 0.01, (0.3, height - 0.1)),
            look="glass",
        )
        b.hinge("arms", parent="cabinet", axis=Z, pivot=(0.2, 0, 0.1), upper=1.5, lower=-1.5, ajar=False)


@kind(
    "parametric lawn mower",
    like="lawn_mower",
    length=length(0.5, 0.8),
    width=length(0.4, 0.5),
    radius=length(0.08, 0.12),
)
def parametric_lawn_mower(b: ObjectBuilder, length: float, width: float, radius: float) -> None:
    """A deck with wheels, a blade below, a handle that folds."""
    b.part(
        "deck",
        slab(length / 2, width / 2, (radius, radius + 0.12)),
        b.cylinder(0.12, radius + 0.1, radius + 0.3),
        look="steel",
    )
    if b.style.hollow:
        b.cut("deck", slab(length / 2 - 0.02, width / 2 - 0.02, (0, radius + 0.1)))
    for i, x in enumerate((-0.4 * length, 0.4 * length)):
        for s in (-1, 1):
            wheel(
                b,
                f"wheel_{i}_{int(s > 0)}",
                parent="deck",
                middle=(x, s * (width / 2 + 0.035), radius),
                radius=radius,
                wide=0.05,
                out=s * Y,
                axle=0.01,
            )
    z = radius + 0.1 if b.style.hollow else radius
    g = b.gap(0.02)
    b.part(
        "blade", b.cylinder(0.02, z - 0.03, z - g), block((0, 0, z - 0.028), (0.8 * width, 0.05, 0.004)), look="steel"
    )
    b.spin("blade", parent="deck", axis=Z, pivot=(0, 0, z))
    x = -length / 2 + 0.05
    b.part(
        "handle",
        [
            b.cylinder(0.014, (x, s * 0.3 * width, radius + 0.12 + 0.015 + g), (x - 0.7, s * 0.3 * width, 0.95))
            for s in (-1, 1)
        ],
        b.cylinder(0.014, (x - 0.7, -0.3 * width, 0.95), (x - 0.7, 0.3 * width, 0.95)),
        look="steel",
    )
    b.hinge("handle", parent="deck", axis=Y, pivot=(x, 0, radius + 0.135 + g), upper=1.2, lower=-0.3)


@kind("parametric parasol", like="umbrella", height=length(1.8, 2.5), radius=length(0.8, 1.5))
def parasol(b: ObjectBuilder, height: float, radius: float) -> None:
    """A canopy that tilts on a pole that slides in its stand."""
    b.part(
        "stand", b.cylinder(0.25, 0, 0.08), b.tube(0.03, 0.02 if b.style.has_bore else 0.001, 0.05, 0.5), look="steel"
    )
    g = b.gap(0.02) + 0.0003
    b.part("pole", b.cylinder(0.02 - (g if b.style.has_bore else 0), 0.1, 0.8 * height), look="metal")
    b.slide("pole", parent="stand", axis=Z, upper=0.25)
    b.part(
        "canopy",
        b.cylinder(0.018, 0.8 * height + g, height),
        b.cone(radius, 0.02, height - 0.05, height + 0.25 * radius),
    )
    b.hinge(
        "canopy", parent="pole", axis=X, pivot=(0, 0, 0.8 * height), upper=0.02 if b.style.has_bore else 0.7, ajar=False
    )
