"""Small things on a table."""

from __future__ import annotations

from itertools import pairwise
from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.kind import angle, choice, kind, length, whole, yes
from kinematify.generate.library.mechanisms import button, knob
from kinematify.generate.library.panels import seam
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, slab, vector

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from manifold3d import Manifold

    from kinematify.generate.procedural.builder import ObjectBuilder


def pinned(
    d: ObjectBuilder,
    name: str,
    parent: str,
    arms: Sequence[Sequence[Manifold]],
    r: float,
    low: float,
    high: float,
    upper: float,
    lower: float,
) -> None:
    """Two arms that cross at the origin, and a pin about z in both: of one of them, of its own, or not drawn."""
    for arm_name, some in zip((parent, name), arms, strict=True):
        d.part(arm_name, *some, look="steel")
    pin = d.cylinder(r, low, high)
    kind = d.pick("merged", "apart", "none")
    if kind != "none":
        d.bore(name, d.cylinder(r + 1.5 * d.gap(2 * r) + 1e-5, low - 1, high + 1))
        if kind == "merged":
            d.part(parent, pin)
        else:
            d.fix(d.part("pin", pin, look="steel"), parent)
    d.hinge(name, parent, Z, (0, 0, 0), upper, lower, ajar=False)


@kind(
    "plain scissors",
    like="scissors",
    blade=length(0.05, 0.15),
    grip=length(0.05, 0.1),
    wide=length(0.008, 0.018),
    thick=length(0.0015, 0.004),
    half=length(0.08, 0.5),
)
def plain_scissors(b: ObjectBuilder, blade: float, grip: float, wide: float, thick: float, half: float) -> None:
    """Two blades that lie on each other, or in one plane and in each other, with loops at their ends."""
    play = seam(b, wide, thick)
    flat = not b.style.has_bore and b.maybe()
    shapes: list[Any] = []
    for k, s in enumerate((1, -1)):
        z = 0 if flat else k * (thick + play)
        along = vector(s * sin(half), cos(half), 0)
        side = vector(cos(half), -s * sin(half), 0) * s
        middle = vector(0, 0, z + thick / 2)
        end = middle - grip * along - 0.012 * side
        loop = b.torus(b.draw(0.014, 0.02), 0.45 * thick, end - 0.015 * along, Z)
        shapes = [
            *shapes,
            [
                beam(wide, thick, middle - 0.3 * grip * along, middle + blade * along, Z),
                beam(0.6 * wide, thick, middle - 0.2 * grip * along, end, Z),
                loop,
            ],
        ]
    top = 2 * thick + max(play, 0)
    pinned(
        b,
        "other_blade",
        parent="blade",
        arms=shapes,
        r=0.25 * wide,
        low=-0.3 * thick,
        high=(thick if flat else top) + 0.3 * thick,
        upper=2 * half,
        lower=-b.draw(0.2, 0.8),
    )


@kind(
    "plain pliers",
    like="pliers",
    jaw=length(0.02, 0.06),
    grip=length(0.08, 0.16),
    wide=length(0.01, 0.02),
    thick=length(0.005, 0.012),
    half=length(0.06, 0.3),
    bend=length(0.0, 0.3),
)
def plain_pliers(
    b: ObjectBuilder, jaw: float, grip: float, wide: float, thick: float, half: float, bend: float
) -> None:
    """Two thick arms with jaws and curved or straight handles about a pin: pliers, tongs, shears, clamps."""
    play = seam(b, wide, thick)
    flat = not b.style.has_bore and b.maybe()
    shapes: list[Any] = []
    for k, s in enumerate((1, -1)):
        z = 0 if flat else k * (thick + play)
        along = vector(s * sin(half), cos(half), 0)
        back = vector(-s * sin(half + bend), -cos(half + bend), 0)
        middle = vector(0, 0, z + thick / 2)
        knee = middle - 0.35 * grip * along
        shapes = [
            *shapes,
            [
                beam(wide, thick, middle, middle + jaw * along, Z),
                beam(0.9 * wide, thick, middle, knee, Z),
                beam(0.8 * wide, thick, knee, knee + 0.65 * grip * back, Z),
                b.cylinder(0.8 * wide, z, z + thick),
            ],
        ]
    top = 2 * thick + max(play, 0)
    pinned(
        b,
        "other_arm",
        parent="arm",
        arms=shapes,
        r=0.3 * wide,
        low=-0.2 * thick,
        high=(thick if flat else top) + 0.2 * thick,
        upper=2 * half,
        lower=-b.draw(0.2, 0.6),
    )


@kind(
    "capped pen",
    like="pen",
    radius=length(0.004, 0.01),
    length=length(0.09, 0.15),
    capped=yes(0.6),
)
def capped_pen(b: ObjectBuilder, radius: float, length: float, capped: bool) -> None:
    """A pen on end or lying: a cap that is drawn off, or a button that is pressed, and a clip."""
    out = b.pick(Z, -Y)
    side = X
    b.part(
        "pen",
        b.cylinder(radius, 0 * out, 0.7 * length * out),
        b.cone(0.2 * radius, radius, -0.15 * length * out, 0 * out),
    )
    if capped:
        play = b.gap(radius)
        start = 0.55 * length * out
        end = length * out
        b.part("pen", b.cylinder(0.8 * radius, 0.6 * length * out, 0.9 * length * out))
        if b.maybe():
            b.part("cap", b.cylinder(1.25 * radius, start, end))
            b.bore("cap", b.cylinder(radius + 1.5 * play + 1e-05, 0 * out, 0.93 * length * out))
        else:
            b.part("cap", b.cylinder(radius, (0.7 * length + play) * out, end))
            b.bore("cap", b.cylinder(0.8 * radius + 1.5 * play + 1e-05, 0 * out, 0.93 * length * out))
        b.part(
            "cap",
            beam(
                0.4 * radius,
                0.6 * radius,
                0.97 * length * out + 0.5 * radius * side,
                0.97 * length * out + 1.9 * radius * side,
            ),
            beam(
                0.4 * radius,
                0.6 * radius,
                length * out + 1.7 * radius * side,
                0.62 * length * out + 1.7 * radius * side,
                side,
            ),
        )
        b.slide("cap", parent="pen", axis=out, upper=b.draw(0.3, 0.5) * length)
    else:
        button(
            b,
            "button",
            parent="pen",
            at=0.7 * length * out,
            size=(0.9 * radius, 0.9 * radius),
            high=b.draw(0.004, 0.012),
            out=out,
            is_round=True,
        )
        b.part(
            "pen",
            beam(0.4 * radius, 0.6 * radius, 0.66 * length * out, 0.66 * length * out + 1.6 * radius * side),
            beam(
                0.4 * radius,
                0.6 * radius,
                0.69 * length * out + 1.5 * radius * side,
                0.3 * length * out + 1.5 * radius * side,
                side,
            ),
        )


@kind(
    "parametric pump bottle",
    like="soap_dispenser",
    radius=length(0.02, 0.05),
    height=length(0.08, 0.25),
)
def pump_bottle(b: ObjectBuilder, radius: float, height: float) -> None:
    """A bottle with a head that goes down or a cap that turns or comes off; round, square or waisted."""
    neck = 0.4 * radius
    top = height + b.draw(0.01, 0.03)
    b.part(
        "bottle",
        b.pick(
            b.cylinder(radius, 0, height),
            slab(radius, 0.6 * radius, (0, height)),
            b.lathe(
                [(0.001, 0), (radius, 0), (0.75 * radius, 0.5 * height), (radius, height), (0.001, height)], (0, 0, 0)
            ),
        ),
        b.cylinder(neck, 0.5 * height, top),
    )
    play = seam(b, neck, 0.01)
    if b.maybe(0.5):
        z = top + play
        stem = b.draw(0.015, 0.04)
        b.bore(
            "bottle",
            b.cylinder(0.35 * neck + 1.5 * b.gap(neck) + 1e-05, max(0.01, 0.5 * height - stem), top + 1),
        )
        b.part(
            "head",
            b.cylinder(0.35 * neck, 0.5 * height if b.style.has_bore else top, z + stem),
            b.pick(
                b.cylinder(0.9 * neck, z + stem, z + stem + 0.012),
                slab(0.8 * neck, neck, (z + stem, z + stem + 0.012)),
            ),
            beam(0.4 * neck, 0.3 * neck, (0, 0, z + stem + 0.006), (0, -1.5 * radius, z + stem)),
        )
        b.slide("head", parent="bottle", axis=-Z, upper=0.8 * stem, ajar=False)
    else:
        high = b.draw(0.01, 0.04)
        z = top - 0.8 * high if b.maybe() else top + max(play, -0.3 * high)
        b.part("cap", b.cylinder(1.15 * neck, z, z + high))
        b.bore("cap", b.cylinder(neck + b.gap(neck) + 1e-05, 0, top + b.gap(neck) + 1e-05))
        if b.maybe():
            b.spin("cap", parent="bottle", axis=Z, pivot=(0, 0, z))
        else:
            b.slide("cap", parent="bottle", axis=Z, upper=b.draw(0.02, 0.06))


@kind(
    "plain bucket",
    like="bucket",
    radius=length(0.1, 0.2),
    height=length(0.12, 0.35),
    wire=length(0.003, 0.008),
)
def plain_bucket(b: ObjectBuilder, radius: float, height: float, wire: float) -> None:
    """A pail or a basket with one bow or two that swing about their ends, upright or laid on the rim."""
    b.part("pail", b.cone(b.draw(0.6, 1) * radius, radius, 0, height), look="metal")
    if b.style.hollow:
        b.cut("pail", b.cone(0.55 * radius, 0.95 * radius, 0.01, height + 0.001))
    play = seam(b, radius, wire)
    wide = radius + wire + max(play, -wire)
    z = height - b.draw(0.02, 0.15) * height
    n = b.pick(1, 1, 1, 2)
    for k in range(n):
        y = 0 if n == 1 else (k - 0.5) * 0.02
        tall = b.draw(0.8, 1.3)
        steps = np.linspace(0, pi, b.count(6, 14))
        out = wide / (cos(pi / 2 / (len(steps) - 1)) if b.style.has_bore else 1)
        points = [vector(out * cos(a), y, z + tall * out * sin(a)) for a in steps]
        name = f"bow_{k}"
        b.part(name, [b.rod(wire, p, q) for p, q in pairwise(points)], look="metal")
        if b.style.barrels and b.style.hollow:
            b.part(
                "pail", [b.cylinder(0.8 * wire, (s * 0.9 * radius, y, z), (s * (wide - wire), y, z)) for s in (-1, 1)]
            )
        swing = b.draw(1, 1.5)
        b.hinge(
            name,
            parent="pail",
            axis=X,
            pivot=(0, y, z),
            upper=swing,
            lower=-swing,
            ajar=False,
            rest=b.pick(0, 0, 0.9 * swing),
        )


@kind(
    "plain stapler",
    like="stapler",
    length=length(0.08, 0.18),
    wide=length(0.02, 0.04),
    thickness=length(0.006, 0.015),
    cheeks=yes(0.5),
)
def plain_stapler(b: ObjectBuilder, length: float, wide: float, thickness: float, cheeks: bool) -> None:
    """A base and an arm that is hinged behind: a stapler, a punch, a clip, a press."""
    arm = b.draw(0.8, 1.3) * thickness
    rise = b.pick(0, b.draw(0.05, 0.3))
    b.part("base", slab(wide / 2, (0, length), (0, thickness)), look="metal")
    play = seam(b, wide, thickness)
    low = thickness + max(play, 0.001)
    if cheeks:
        for s in (-1, 1):
            b.part("base", box((s * wide / 2, 0.8 * length, 0), (s * (wide / 2 - 0.12 * wide), length, low + arm)))
    half = wide / 2 - (0.12 * wide + max(play, 0.0005) if cheeks else 0)
    end = (b.draw(0.85, 0.94) if cheeks else 0.97) * length
    b.part("arm", slab(half, (b.draw(-0.05, 0.1) * length, end), (low, low + arm)), look="metal")
    if b.maybe():
        b.part("arm", slab(0.8 * half, (0, 0.6 * length), (low + arm, low + 1.4 * arm)))
    pivot = (0, end, low + (0.5 * arm if cheeks else 0))
    b.hinge("arm", parent="base", axis=-X, pivot=pivot, upper=b.draw(0.6, 1.4 if cheeks else 2), ajar=False, rest=rise)


@kind(
    "slab laptop",
    like="laptop",
    width=length(0.08, 0.4),
    depth=length(0.06, 0.28),
    a=length(0.008, 0.03),
    b=length(0.004, 0.015),
    reach=angle(1.8, 3.0),
)
def slab_laptop(d: ObjectBuilder, width: float, depth: float, a: float, b: float, reach: float) -> None:
    """Two slabs on an edge, mostly open: a laptop, a game, a case for make-up; keys or a pad at times."""
    d.part("base", slab(width / 2, (0, depth), (0, a)))
    play = max(seam(d, depth, b), -0.2 * b)
    low = a + play
    shrink = d.pick(0, 0.01) * width
    d.part("screen", slab(width / 2 - shrink, (shrink, depth), (low, low + b)))
    d.cut("screen", slab(0.44 * width, (0.08 * depth, 0.9 * depth), (low - 1, low + 0.2 * b)))
    if d.maybe(0.4):
        d.cut("base", slab(0.4 * width, (0.4 * depth, 0.9 * depth), (0.85 * a, a + 1)))
    if d.maybe(0.25):
        button(
            d, "key", parent="base", at=(0.44 * width, 0.95 * depth - 0.005, a), size=(0.006, 0.006), high=0.001, out=Z
        )
    pivot = (0, depth, d.pick(low, a + play / 2, low + b / 2))
    d.hinge(
        "screen",
        parent="base",
        axis=-X,
        pivot=pivot,
        upper=reach,
        ajar=False,
        rest=d.pick(0, d.draw(1.2, 1.9), d.draw(1.5, 1.8)),
    )


@kind(
    "plain globe",
    like="globe",
    radius=length(0.06, 0.2),
)
def plain_globe(b: ObjectBuilder, radius: float) -> None:
    """A ball between the ends of a bow, or on a rod: it turns about a tilted line, with pins or without."""
    tilt = b.pick(0, b.draw(0.2, 0.5))
    up = vector(sin(tilt), 0, cos(tilt))
    side = vector(cos(tilt), 0, -sin(tilt))
    middle = (radius + b.draw(0.3, 0.8) * radius) * Z
    play1 = b.gap(radius)
    wide = radius + max(0.04 * radius, play1 + 0.02 * radius) + 0.04 * radius
    b.part(
        "stand",
        b.cylinder(b.draw(0.5, 0.8) * radius, 0, 0.08 * radius),
        b.cylinder(0.06 * radius, (0, 0, 0), middle - 0.99 * wide * Z),
        look="metal",
    )
    angles = np.linspace(0, pi, 14)
    bow = [middle + wide * (cos(a) * up - sin(a) * side) for a in angles]
    b.part("stand", [beam(0.06 * radius, 0.1 * radius, p, q, Y) for p, q in pairwise(bow)])
    low = [middle + wide * (-sin(a) * side - cos(a) * Z) for a in np.linspace(0, 0.8, 5)]
    b.part("stand", [beam(0.06 * radius, 0.1 * radius, p, q, Y) for p, q in pairwise(low)])
    b.part("ball", ball(radius, middle))
    if b.style.barrels:
        reach = wide - 0.06 * radius if b.style.has_bore else wide
        b.part("ball", b.cylinder(0.03 * radius, middle - reach * up, middle + reach * up))
    b.spin("ball", parent="stand", axis=up, pivot=middle)


@kind(
    "rod lamp",
    like="desk_lamp",
    number=whole(1, 3, words="arm, link"),
    length=length(0.15, 0.4),
    radius=length(0.004, 0.012),
    foot=length(0.06, 0.1),
    angle=angle(-0.3, 0.5),
    high=length(0.05, 0.12),
)
def rod_lamp(
    b: ObjectBuilder, number: int, length: float, radius: float, foot: float, angle: float, high: float
) -> None:
    """Plain rods that touch or stand in each other at their ends, a shade or a head at the last."""
    b.part("foot", b.pick(b.cylinder(foot, 0, 0.02), slab(foot, foot, (0, 0.03))), look="metal")
    at = vector(0, 0, 0.03)
    parent = "foot"
    play = b.gap(2 * radius)
    if b.maybe():
        h = b.draw(0.05, 0.3)
        b.part("foot", b.cylinder(1.5 * radius, 0, 0.03 + h))
        at = vector(0, 0, 0.03 + h)
    for k in range(number):
        along = vector(0, -sin(angle), cos(angle))
        beside = (2.5 * radius + play) * X if b.style.has_bore else 0 * X
        start = at + beside + (0 if b.style.has_bore else b.pick(0, 0.8 * radius)) * along
        end = at + beside + length * along
        b.part(f"arm_{k}", b.pick(b.rod(radius, start, end), b.cylinder(radius, start, end)), look="metal")
        if not b.style.has_bore and b.maybe():
            b.part(f"arm_{k}", ball(1.8 * radius, at))
        b.hinge(
            f"arm_{k}",
            parent=parent,
            axis=X,
            pivot=at + beside,
            upper=b.draw(0.6, 1.5),
            lower=-b.draw(0.3, 0.8),
            ajar=False,
        )
        at = end
        parent = f"arm_{k}"
        angle = angle + b.draw(0.5, 1.5)
    out = vector(0, -sin(angle), cos(angle))
    beside = (2.5 * radius + play) * X if b.style.has_bore else 0 * X
    b.part(
        "head",
        b.pick(
            b.cone(0.3 * high, high, at + beside, at + beside + high * out),
            beam(0.5 * high, 0.2 * high, at + beside, at + beside + 2 * high * out),
        ),
        look="metal",
    )
    if b.style.has_bore:
        b.cut("head", box(at - 5 * radius - X, at + 5 * radius + (radius + play / 2 - 5 * radius) * X))
    b.hinge(
        "head", parent=parent, axis=X, pivot=at + beside, upper=b.draw(0.5, 1.2), lower=-b.draw(0.5, 1.2), ajar=False
    )


@kind(
    "plain clock",
    like="clock",
    radius=length(0.04, 0.25),
    thickness=length(0.01, 0.06),
)
def plain_clock(b: ObjectBuilder, radius: float, thickness: float) -> None:
    """A disc or a box with two or three thin hands before it about one line; a knob behind at times."""
    b.part(
        "case",
        b.pick(b.cylinder(radius, (0, 0, 0), (0, thickness, 0)), slab(radius, (0, thickness), radius)),
        look="wood",
    )
    deep = 0.3 * thickness
    if b.style.hollow and b.maybe():
        b.cut("case", b.cylinder(0.9 * radius, (0, -1, 0), (0, deep, 0)))
        b.part("case", b.torus(0.95 * radius, 0.04 * radius, (0, 0, 0), Y))
    else:
        deep = 0.0
    play = seam(b, 0.2 * radius, 0.01 * radius)
    thick = 0.012 * radius
    y = deep - play
    for k in range(b.count(2, 3)):
        length = (0.5, 0.75, 0.8)[k] * radius
        wide = (0.08, 0.05, 0.02)[k] * radius
        angle = b.draw(0, 2 * pi)
        along = vector(sin(angle), 0, cos(angle))
        middle = vector(0, y - thick / 2, 0)
        name = ("hour", "minute", "second")[k]
        b.part(
            name, beam(wide, thick, middle - b.pick(0, 0.15) * length * along, middle + length * along, Y), look="metal"
        )
        if b.maybe():
            b.part(name, b.cylinder(0.05 * radius, (0, y, 0), (0, y - thick, 0)))
        b.spin(name, parent="case", axis=-Y, pivot=(0, y, 0))
        y = y - (thick + max(play, 0))
    if b.maybe(0.3):
        knob(
            b, "setter", parent="case", at=(0, thickness, -0.3 * radius), radius=0.1 * radius, high=0.1 * radius, out=Y
        )


@kind(
    "box fan",
    like="fan",
    radius=length(0.04, 0.25),
    thickness=length(0.03, 0.12),
    number=whole(3, 7, words="blade"),
)
def box_fan(b: ObjectBuilder, radius: float, thickness: float, number: int) -> None:
    """Blades in a ring or a box that nothing visible holds, or a spindle behind them does."""
    b.part("case", slab(1.15 * radius, thickness / 2, 1.15 * radius))
    b.cut("case", b.cylinder(1.04 * radius + b.style.gap, (0, -1, 0), (0, 1, 0)))
    if b.maybe(0.4):
        b.part(
            "guard",
            [b.torus(f * radius, 0.02 * radius, (0, 0.4 * thickness, 0), Y) for f in (0.2, 0.6, 1.04)],
            beam(0.04 * radius, 0.04 * radius, (-1.1 * radius, 0.4 * thickness, 0), (1.1 * radius, 0.4 * thickness, 0)),
            beam(0.04 * radius, 0.04 * radius, (0, 0.4 * thickness, -1.1 * radius), (0, 0.4 * thickness, 1.1 * radius)),
        )
        b.fix("guard", parent="case")
    hub = b.draw(0.15, 0.4) * radius
    b.part("rotor", b.cylinder(hub, (0, -0.25 * thickness, 0), (0, 0.25 * thickness, 0)))
    for a in np.arange(number) * 2 * pi / number:
        along = vector(cos(a), 0, sin(a))
        flat = 0.8 * Y + 0.6 * np.cross(Y, along)
        b.part("rotor", beam(0.35 * radius, 0.02 * radius, 0.8 * hub * along, 0.97 * radius * along, flat))
    b.cut(
        "rotor",
        slab(2 * radius, (-0.4 * thickness - 1, -0.33 * thickness), 2 * radius),
        slab(2 * radius, (0.33 * thickness, 0.4 * thickness + 1), 2 * radius),
    )
    b.spin("rotor", parent="case", axis=-Y, pivot=(0, 0, 0))


@kind(
    "flip cap bottle",
    like="bottle",
    width=length(0.015, 0.04),
    thickness=length(0.008, 0.02),
    height=length(0.03, 0.07),
    kind=choice(("flips", "turns", "off")),
    share=length(0.5, 0.75),
)
def flip_cap(b: ObjectBuilder, width: float, thickness: float, height: float, kind: str, share: float) -> None:
    """A stick or a block with a cover: hinged at an end, turning about a pin, or drawn off: a lighter, a USB stick."""
    b.part("body", slab(width / 2, thickness / 2, (0, share * height)), look="metal")
    play = seam(b, thickness, 0.004)
    if kind == "turns":
        g = max(b.gap(thickness), 0) if b.style.has_bore else b.pick(0, b.gap(thickness))
        sheet = 0.08 * thickness
        for s in (-1, 1):
            b.part(
                "cover",
                slab(
                    0.5 * width,
                    (s * (thickness / 2 + g), s * (thickness / 2 + g + sheet)),
                    (-0.1 * height, 0.9 * height),
                ),
            )
        b.part(
            "cover",
            slab(0.5 * width, thickness / 2 + g + sheet, (0.9 * height, 0.9 * height + sheet)),
        )
        b.part(
            "body",
            [
                b.cylinder(
                    0.08 * width, (0, s * thickness / 2, 0.15 * height), (0, s * (thickness / 2 - 0.001), 0.15 * height)
                )
                for s in (-1, 1)
            ],
        )
        b.hinge(
            "cover",
            parent="body",
            axis=Y,
            pivot=(0, 0, 0.15 * height),
            upper=b.draw(2, 3.1),
            lower=-b.draw(2, 3.1),
            ajar=False,
        )
    else:
        b.part("body", slab(0.35 * width, 0.35 * thickness, (0, 0.9 * height)))
        low = share * height + play
        b.part("cover", slab(width / 2, thickness / 2, (low, height)), look="metal")
        b.bore("cover", slab(0.4 * width, 0.4 * thickness, (0, 0.95 * height)))
        if kind == "flips":
            b.hinge(
                "cover",
                parent="body",
                axis=Y,
                pivot=(width / 2, 0, share * height + b.pick(0, 0.5, 1) * play),
                upper=b.draw(1.5, 2.8),
                ajar=False,
            )
        else:
            b.slide("cover", parent="body", axis=Z, upper=b.draw(0.3, 0.6) * height)
