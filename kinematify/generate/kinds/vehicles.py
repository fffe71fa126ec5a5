"""Vehicles on land and water, and in the air."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np
from manifold3d import Manifold

from kinematify.generate.library.kind import kind, whole, yes
from kinematify.generate.library.mechanisms import case, caster, rotor, wheel
from kinematify.generate.library.panels import grip, leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import Point, X, Y, Z, beam, block, box, slab, vector


def _windows(d: ObjectBuilder, lower: Point, upper: Point) -> Sequence[Manifold]:
    """Dark windows all around a box, which stand out of it by 5 mm."""
    low, high = np.array(lower), np.array(upper)
    edge = 0.1 * (high - low) * (1, 1, 0)
    bands = [box(low + edge * a - 0.005 * b, high - edge * a + 0.005 * b) for a, b in ((Y, X), (X, Y))]
    return d.painted(*bands, look="black plastic")


def axles(
    d: ObjectBuilder, parent: str, xs: Sequence[float], half: float, radius: float, wide: float, axle: float
) -> None:
    """Pairs of wheels; the car drives along x, its sides are at y = -half and half."""
    for i, x in enumerate(xs):
        for s, side in ((-1.0, "right"), (1.0, "left")):
            wheel(
                d,
                f"wheel_{i}_{side}",
                parent,
                (x, s * (half + axle + wide / 2), radius),
                radius,
                wide,
                s * Y,
                axle=axle,
            )


@kind(
    walls=38,
    words="car, automobile, toy car, sedan, passenger car, hatchback, taxi, police car, suv, station wagon, estate car",
    length=(2.5, 4.5),
    width=(1.4, 1.9),
    radius=(0.25, 0.35),
)
def box_car(b: ObjectBuilder, length: float, width: float, radius: float) -> None:
    """A car of boxes: four wheels, doors, a tailgate and a bonnet as they come."""
    b.part(
        "body",
        slab(length / 2, width / 2, (radius, radius + 0.55)),
        slab((-0.45 * length, 0.15 * length), 0.45 * width, (radius + 0.5, radius + 1.1)),
        _windows(b, (-0.45 * length, -0.45 * width, radius + 0.68), (0.15 * length, 0.45 * width, radius + 1.0)),
        look="steel",
    )
    axles(b, "body", (-0.32 * length, 0.32 * length), width / 2, radius, b.draw(0.15, 0.25), b.pick(0.01, 0.05))
    for s, side in ((-1, "right"), (1, "left")):
        if b.maybe(0.7):
            y = s * width / 2
            leaf(
                b,
                f"door_{side}",
                "body",
                (-0.12 * length, y, radius + 0.1),
                (0.15 * length, y + s * 0.04, radius + 0.5),
                hinge=X,
                out=s * Y,
                reach=1.1,
                material="steel",
            )
    if b.maybe():
        leaf(
            b,
            "bonnet",
            "body",
            (0.16 * length, -0.45 * width, radius + 0.55),
            (length / 2, 0.45 * width, radius + 0.58),
            hinge=-X,
            out=Z,
            reach=1.0,
            handle=False,
            material="steel",
        )
    if b.maybe():
        leaf(
            b,
            "tailgate",
            "body",
            (-length / 2 - 0.03, -0.42 * width, radius + 0.1),
            (-length / 2, 0.42 * width, radius + 0.55),
            hinge=b.pick(Z, -Z),
            out=-X,
            reach=1.4,
            material="steel",
        )


@kind(walls=47, words="pickup, truck, toy truck", length=(4.0, 5.5), width=(1.7, 2.0), radius=(0.32, 0.42))
def pickup_truck(b: ObjectBuilder, length: float, width: float, radius: float) -> None:
    """A cab, a bed with a tailgate, four wheels."""
    b.part(
        "body",
        slab(length / 2, width / 2, (radius, radius + 0.4)),
        slab((-0.05 * length, 0.28 * length), 0.46 * width, (radius + 0.3, radius + 1.15)),
        slab((0.2 * length, length / 2), width / 2, (radius, radius + 0.7)),
        _windows(b, (-0.05 * length, -0.46 * width, radius + 0.78), (0.28 * length, 0.46 * width, radius + 1.08)),
        look="steel",
    )
    for s in (-1, 1):
        b.part(
            "body",
            box((-length / 2, s * width / 2, radius + 0.3), (-0.05 * length, s * (width / 2 - 0.06), radius + 0.8)),
        )
    leaf(
        b,
        "tailgate",
        "body",
        (-length / 2 - 0.05, -width / 2 + 0.07, radius + 0.41),
        (-length / 2, width / 2 - 0.07, radius + 0.8),
        hinge=-Z,
        out=-X,
        reach=1.57,
        handle=b.maybe(),
        material="steel",
    )
    axles(b, "body", (-0.3 * length, 0.32 * length), width / 2, radius, 0.25, 0.02)
    if b.maybe():
        leaf(
            b,
            "bonnet",
            "body",
            (0.3 * length, -0.45 * width, radius + 0.7),
            (length / 2, 0.45 * width, radius + 0.73),
            hinge=-X,
            out=Z,
            reach=1.0,
            handle=False,
        )


@kind(
    walls=35,
    words=(
        "delivery van, minivan, camper van, ambulance, transporter van, cargo van, transporter, camper, mail van, post "
        "van, police van, panel van, bakery van, news van"
    ),
    length=(4.5, 6.0),
    width=(1.8, 2.1),
    height=(1.6, 2.2),
)
def van(b: ObjectBuilder, length: float, width: float, height: float) -> None:
    """A sliding side door, two rear doors, wheels."""
    r = 0.33
    case(b, "body", (-length / 2, -width / 2, r), (length / 2, width / 2, r + height), material="steel")
    b.part("body", _windows(b, (0.2 * length, -width / 2, r + 0.5 * height), (length / 2, width / 2, r + 0.9 * height)))
    leaf_w = width / 2 - 0.02
    for s, side in ((-1, "right"), (1, "left")):
        leaf(
            b,
            f"rear_{side}",
            "body",
            (-length / 2 - 0.04, 0.01 * s, r + 0.15),
            (-length / 2, s * leaf_w, r + height - 0.1),
            hinge=s * Y,
            out=-X,
            reach=b.draw(1.6, 2.6),
            material="steel",
        )
    g = b.gap(0.1)
    y = -width / 2 - g
    b.part(
        "side_door", box((-0.1 * length, y - 0.05, 2 * r + 0.02), (0.15 * length, y, r + height - 0.15)), look="steel"
    )
    b.part(
        "body",
        box(
            (-0.4 * length, -width / 2 - 0.03, r + height - 0.14 + g),
            (0.16 * length, -width / 2 + 0.01, r + height - 0.11),
        ),
    )
    grip(b, "side_door", (0.12 * length, y - 0.05, r + height / 2), -Y, Z, 0.2)
    b.slide("side_door", "body", -X, 0.24 * length)
    axles(b, "body", (-0.3 * length, 0.32 * length), width / 2, r, 0.22, 0.02)


@kind(
    "bus",
    walls=65,
    words=(
        "tram, city bus, coach, streetcar, trolley bus, school bus, tour bus, shuttle bus, airport shuttle, tram car"
    ),
    length=(6.0, 12.0),
    swings=yes(0.5),
)
def bus_or_tram(b: ObjectBuilder, length: float, swings: bool) -> None:
    """Double doors that slide apart or swing, and many wheels."""
    w = 2.5
    r = 0.45
    h = 2.5
    case(b, "body", (-length / 2, -w / 2, r), (length / 2, w / 2, r + h), material="steel")
    b.part("body", _windows(b, (-length / 2, 0.01 - w / 2, r + 1.0), (length / 2, w / 2, r + 2.1)))
    g = b.gap(0.1) + 0.002
    for i, x in enumerate(spread(1 if length < 9 else 2, -0.25 * length, 0.2 * length)):
        for s in (-1, 1):
            name = f"{('front' if s > 0 else 'rear')}_leaf_{i}"
            a, b_ = sorted((x + s * 0.01, x + s * 0.65))
            if swings:
                leaf(
                    b,
                    name,
                    "body",
                    (a, -w / 2 - 0.04, r + 0.1),
                    (b_, -w / 2, r + 2.1),
                    hinge=s * X,
                    reach=1.5,
                    material="glass",
                )
            else:
                b.part(name, box((a, -w / 2 - 0.04 - g, r + 0.1), (b_, -w / 2 - g, r + 2.1)), look="glass")
                b.slide(name, "body", s * X, 0.6)
    axles(b, "body", (-0.35 * length, 0.3 * length), w / 2, r, 0.28, 0.02)


@kind(words="longboard", length=(0.6, 0.9), width=(0.18, 0.24), radius=(0.025, 0.035))
def skateboard(b: ObjectBuilder, length: float, width: float, radius: float) -> None:
    """A deck, two trucks that tilt, four wheels."""
    b.part(
        "deck",
        slab(length / 2, width / 2, (0.1, 0.112)),
        [b.cylinder(width / 2, s * length / 2, 0, (0.1, 0.112)) for s in (-1, 1)],
        [block((s * 0.3 * length, 0, 0.095), (0.08, 0.06, 0.012)) for s in (-1, 1)],
        look="wood",
    )
    g = b.gap(0.02) + 0.0005
    for k, s in enumerate((-1, 1)):
        x = s * 0.3 * length
        name = f"truck_{k}"
        b.part(
            name,
            slab((x - 0.015, x + 0.015), 0.38 * width, (radius - 0.008, radius + 0.008)),
            b.cylinder(0.012, x, 0, (radius, 0.085 - g)),
            look="metal",
        )
        b.hinge(name, "deck", X, (x, 0, 0.07), 0.2, -0.2, ajar=False)
        for q in (-1, 1):
            wheel(
                b,
                f"wheel_{k}_{int(q > 0)}",
                name,
                (x, q * (0.38 * width + 0.022), radius),
                radius,
                0.035,
                q * Y,
                axle=0.004,
            )


@kind(
    words="shopping trolley, supermarket trolley, grocery cart, supermarket cart",
    length=(0.7, 1.0),
    width=(0.45, 0.6),
    height=(0.9, 1.05),
)
def shopping_cart(b: ObjectBuilder, length: float, width: float, height: float) -> None:
    """A wire basket, four casters, a child's flap."""
    z0 = 0.45
    b.part(
        "cart",
        slab(length / 2, width / 2, (z0, z0 + 0.01)),
        [slab(length / 2, (s * width / 2, s * (width / 2 - 0.01)), (z0, height - 0.15)) for s in (-1, 1)],
        slab((length / 2 - 0.01, length / 2), width / 2, (z0, height - 0.15)),
        look="steel",
    )
    b.part(
        "cart",
        [
            beam(0.025, 0.025, (x, s * 0.45 * width, 0.12), (x, s * 0.45 * width, z0 + 0.005), X)
            for s in (-1, 1)
            for x in (-0.4 * length, 0.4 * length)
        ],
        [
            beam(0.03, 0.03, (-0.42 * length, s * 0.45 * width, 0.135), (0.42 * length, s * 0.45 * width, 0.135))
            for s in (-1, 1)
        ],
    )
    b.part(
        "cart",
        [
            b.cylinder(
                0.012,
                (-length / 2, s * (width / 2 - 0.005), height - 0.2),
                (-length / 2 - 0.12, s * (width / 2 - 0.005), height),
            )
            for s in (-1, 1)
        ],
        b.cylinder(0.014, -length / 2 - 0.12, (-width / 2, width / 2), height),
    )
    leaf(
        b,
        "flap",
        "cart",
        (-length / 2 - 0.012, -width / 2 + 0.02, z0 + 0.02),
        (-length / 2, width / 2 - 0.02, height - 0.17),
        hinge=Z,
        out=-X,
        reach=0.6,
        handle=False,
        material="steel",
    )
    for k, (x, y) in enumerate(
        [(x, y) for x in (-0.38 * length, 0.38 * length) for y in (-0.45 * width, 0.45 * width)]
    ):
        caster(b, f"caster_{k}", "cart", (x, y, 0.12), 0.12)


@kind(words="speed boat, outboard boat, power boat", length=(3.0, 7.0))
def motor_boat(b: ObjectBuilder, length: float) -> None:
    """An outboard that steers, its propeller, a steering wheel, a hatch."""
    p = b.sized(length)
    b.part(
        "hull",
        p.prism([(-0.5, 0), (0.4, 0), (0.5, 0.18), (-0.5, 0.18)], (0, 0, 0), 0.36, "y"),
        p.slab((0, 0.1), 0.12, (0.17, 0.28)),
    )
    g = b.gap(0.05 * length) + 0.001
    x = -0.52 * length
    b.part("hull", p.slab((-0.515, -0.499), 0.008, (0.14, 0.18)))
    b.part(
        "outboard",
        slab((x - 0.1 * length, x), 0.04 * length, (0.12 * length, 0.26 * length)),
        slab((x - 0.07 * length, x - 0.03 * length), 0.015 * length, (-0.1 * length, 0.13 * length)),
        b.cylinder(0.02 * length, (x - 0.09 * length, x - 0.02 * length), 0, -0.07 * length),
    )
    b.hinge("outboard", "hull", Z, (x, 0, 0), 0.45, -0.45, ajar=False)
    rotor(b, "propeller", "outboard", (x - 0.09 * length, 0, -0.07 * length), -X, 0.06 * length, 3, wide=0.5)
    at = vector(0, 0.06 * length, 0.24 * length)
    b.part(
        "wheel",
        b.torus(0.045 * length, 0.005 * length, at - 0.03 * length * X, X),
        b.cylinder(0.008 * length, at - g * X, at - 0.03 * length * X),
        [
            beam(
                0.008 * length,
                0.005 * length,
                at - 0.03 * length * X - 0.045 * length * v,
                at - 0.03 * length * X + 0.045 * length * v,
                X,
            )
            for v in (Y, Z)
        ],
    )
    b.spin("wheel", "hull", -X, at)
    leaf(
        b,
        "hatch",
        "hull",
        (0.15 * length, -0.08 * length, 0.18 * length),
        (0.33 * length, 0.08 * length, 0.18 * length + 0.02),
        hinge=b.pick(X, -X),
        out=Z,
        reach=1.5,
    )


@kind(
    words="car trailer, utility trailer, box trailer",
    length=(1.5, 3.0),
    width=(1.0, 1.5),
    radius=(0.22, 0.32),
    height=(0.25, 0.4),
)
def trailer(b: ObjectBuilder, length: float, width: float, radius: float, height: float) -> None:
    """A flat bed with sides that fold down, two wheels, a jockey wheel that goes up."""
    z = radius + 0.2
    b.part(
        "bed",
        slab(length / 2, width / 2, (z, z + 0.05)),
        beam(0.08, 0.08, (length / 2 - 0.1, 0, z), (length / 2 + 0.8, 0, z)),
        [slab(0.1, (s * width / 2, s * (width / 2 - 0.08)), (radius - 0.05, z + 0.01)) for s in (-1, 1)],
        look="steel",
    )
    axles(b, "bed", (0.0,), width / 2, radius, 0.16, 0.03)
    for k, (s, out) in enumerate(((-1, -Y), (1, Y))):
        leaf(
            b,
            f"side_{k}",
            "bed",
            (-length / 2 + 0.03, s * width / 2, z + 0.055),
            (length / 2 - 0.03, s * (width / 2 - 0.025), z + 0.05 + height),
            hinge=-Z,
            out=out,
            reach=0.8,
            handle=False,
        )
    leaf(
        b,
        "tailgate",
        "bed",
        (-length / 2 - 0.025, -width / 2, z + 0.055),
        (-length / 2, width / 2, z + 0.05 + height),
        hinge=-Z,
        out=-X,
        handle=b.maybe(),
    )
    x = length / 2 + 0.6
    b.part("bed", b.tube(0.035, 0.022 if b.style.has_bore else 0.002, x, 0.07, (z - 0.1, z + 0.15)))
    g = b.gap(0.02) + 0.0005
    b.part(
        "jockey",
        b.cylinder(0.022 - (1.5 * g if b.style.has_bore else 0), x, 0.07, (0.14, z + 0.2)),
        [beam(0.03, 0.006, (x, 0.07 + s, 0.15), (x, 0.07 + s, 0.06), Y) for s in (-0.035, 0.035)],
        block((x, 0.07, 0.15), (0.04, 0.08, 0.02)),
        look="steel",
    )
    b.slide("jockey", "bed", Z, 0.05, ajar=False)
    b.part("jockey_wheel", b.cylinder(0.08, x, (0.045, 0.095), 0.07), look="rubber")
    b.cut("jockey", b.cylinder(0.085, x, (0.043, 0.097), 0.07))
    b.spin("jockey_wheel", "jockey", Y, (x, 0.07, 0.07))


@kind(
    words="dutch windmill, grain windmill, toy windmill",
    sails=whole(4, 4, words="sail", drawn=False),
    height=(1.0, 8.0),
)
def windmill(b: ObjectBuilder, height: float) -> None:
    """Sails on a cap that turns on a tower, a door below."""
    b.part("tower", b.cone(0.22 * height, 0.14 * height, 0, 0.8 * height), look="wood")
    g = b.gap(0.05 * height)
    b.part(
        "cap",
        b.cone(0.16 * height, 0.05 * height, 0.8 * height + g, height),
        b.cylinder(0.03 * height, 0, (0, -0.24 * height), 0.87 * height),
        look="wood",
    )
    b.spin("cap", "tower", Z, (0, 0, 0.8 * height))
    rotor(b, "sails", "cap", (0, -0.24 * height, 0.87 * height), -Y, 0.45 * height, 4, wide=0.2)


@kind(words="wind generator, wind power plant, wind wheel", height=(0.5, 40.0))
def wind_turbine(b: ObjectBuilder, height: float) -> None:
    """A nacelle that yaws on a mast and a rotor with three blades."""
    b.part("mast", b.cone(0.04 * height, 0.025 * height, 0, height), look="steel")
    g = b.gap(0.02 * height)
    b.part("nacelle", slab(0.03 * height, (-0.06 * height, 0.12 * height), (height + g, height + 0.06 * height)))
    b.spin("nacelle", "mast", Z, (0, 0, height))
    rotor(
        b, "rotor", "nacelle", (0, -0.06 * height, height + 0.03 * height), -Y, 0.6 * height, b.count(2, 4), wide=0.08
    )


@kind(
    words="letter box, post box",
    part_words={"door": "flap"},
    width=(0.15, 0.25),
    length=(0.35, 0.55),
    height=(0.9, 1.2),
)
def mailbox(b: ObjectBuilder, width: float, length: float, height: float) -> None:
    """A door in front and a flag at the side."""
    b.part(
        "box",
        slab(width / 2, (0, length), (height, height + width)),
        b.cylinder(width / 2, 0, (0, length), height + width),
        slab(0.04, (0.4 * length, 0.4 * length + 0.08), (0, height + 0.01)),
        look="steel",
    )
    g = b.gap(0.05)
    b.part(
        "door",
        slab(width / 2, (-0.01 - g, -g), (height, height + width)),
        b.cylinder(width / 2, 0, (-0.01 - g, -g), height + width),
        look="steel",
    )
    grip(b, "door", (0, -0.01 - g, height + 1.2 * width), -Y, X, 0.04)
    b.hinge("door", "box", X, (0, -g - 0.01 * b.pick(0, 1), height), 1.5)
    x = width / 2 + g + 0.001
    b.part(
        "flag",
        box((x, 0.2 * length, height + 0.3 * width), (x + 0.005, 0.2 * length + 0.02, height + 1.4 * width)),
        box((x, 0.2 * length, height + 1.1 * width), (x + 0.005, 0.2 * length + 0.1, height + 1.45 * width)),
    )
    b.hinge("flag", "box", X * b.pick(1, -1), (x, 0.2 * length + 0.01, height + 0.35 * width), 1.57)


@kind(words="glasshouse, hothouse", width=(1.5, 2.5), length=(1.5, 3.0))
def greenhouse(b: ObjectBuilder, width: float, length: float) -> None:
    """A house of glass: roof vents that lift, a sliding door."""
    h = 1.6
    t = 0.04
    b.part(
        "frame",
        [beam(t, t, (s * width / 2, y, 0), (s * width / 2, y, h), Y) for s in (-1, 1) for y in (0, length)],
        [beam(t, t, (s * width / 2, 0, z), (s * width / 2, length, z)) for s in (-1, 1) for z in (0.02, h)],
        [beam(t, t, (-width / 2, y, 0.02), (width / 2, y, 0.02)) for y in (0, length)],
        [beam(t, t, (s * width / 2, y, h), (0, y, h + 0.4), Y) for s in (-1, 1) for y in (0, length)],
        beam(t, t, (0, 0, h + 0.4), (0, length, h + 0.4)),
        [beam(t, t, (-width / 2, y, h), (width / 2, y, h)) for y in (0, length)],
        look="metal",
    )
    slope = vector(width / 2, 0, -0.4) / np.hypot(width / 2, 0.4)
    up = vector(0.4, 0, width / 2) / np.hypot(width / 2, 0.4)
    g = b.gap(0.02) + 0.021
    for k, y in enumerate(spread(b.count(1, 3), 0.05, length - 0.05)):
        a = vector(0, y, h + 0.4) + 0.02 * slope + g * up
        b.part(f"vent_{k}", beam(0.8 * length / 4, 0.01, a, a + 0.45 * width * slope, up), look="glass")
        b.hinge(f"vent_{k}", "frame", -Y, a, 0.7)
    y = -0.02 - b.gap(0.05) - 0.003
    b.part("door", slab(0.4, (y - 0.02, y), (0.03, h - 0.02)), look="glass")
    b.slide("door", "frame", X, 0.7)


@kind(words="grill, bbq, charcoal grill, kettle grill, bbq grill, barbecue grill", radius=(0.2, 0.32), z=(0.6, 0.75))
def barbecue(b: ObjectBuilder, radius: float, z: float) -> None:
    """A bowl with a lid, vents that turn, a tray, wheels."""
    b.part(
        "bowl",
        b.lathe([(0, 0), (0.6 * radius, 0.1 * radius), (radius, 0.7 * radius), (0, 0.7 * radius)], (0, 0, z)),
        [
            b.cylinder(
                0.012,
                (0.5 * radius * cos(a), 0.5 * radius * sin(a), z + 0.2 * radius),
                (0.9 * radius * cos(a), 0.9 * radius * sin(a), 0.05),
            )
            for a in np.arange(3) * 2 * pi / 3
        ],
        look="steel",
    )
    if b.style.hollow:
        b.cut(
            "bowl",
            b.lathe(
                [(0, 0.1 * radius), (0.55 * radius, 0.2 * radius), (0.93 * radius, 0.75 * radius), (0, 0.75 * radius)],
                (0, 0, z),
            ),
        )
    g = b.gap(0.05)
    top = z + 0.7 * radius + g
    b.part(
        "lid",
        b.lathe([(0, 0), (radius, 0), (0.6 * radius, 0.6 * radius), (0, 0.7 * radius)], (0, 0, top)),
        look="steel",
    )
    grip(b, "lid", (0, -0.75 * radius, top + 0.35 * radius), -Y, X, 0.15)
    if b.maybe(0.6):
        b.hinge("lid", "bowl", -X, (0, radius, top), 1.4)
    else:
        b.slide("lid", "bowl", Z, 0.2)
    b.part(
        "vent",
        b.cylinder(0.2 * radius, top + 0.7 * radius + g, top + 0.7 * radius + 0.004 + g),
        b.cylinder(0.03 * radius, top + 0.7 * radius + g, top + 0.75 * radius),
    )
    b.hinge("vent", "lid", Z, (0, 0, top + 0.7 * radius), 0.8, ajar=False)
