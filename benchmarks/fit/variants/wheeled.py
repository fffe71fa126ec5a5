"""Wheels, casters and carts as others model them."""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.kind import angle, choice, kind, length, whole, yes
from kinematify.generate.library.mechanisms import button, in_fork
from kinematify.generate.library.panels import leaf, seam
from kinematify.generate.procedural.builder import spread
from kinematify.generate.procedural.solids import X, Y, Z, beam, block, box, slab, vector

if TYPE_CHECKING:
    from kinematify.generate.procedural.builder import ObjectBuilder


@kind("fork barrow", like="hand_truck", width=length(0.4, 0.7), depth=length(0.6, 1.0), radius=length(0.1, 0.22))
def fork_barrow(b: ObjectBuilder, width: float, depth: float, radius: float) -> None:
    """A tray or a frame on one wheel in a fork, or on two: a barrow, a walker, a stroller of plain bars."""
    floor = 2 * radius + b.draw(0.05, 0.15)
    b.part("tray", slab(width / 2, (0, depth), (floor, floor + b.draw(0.15, 0.35))), look="metal")
    if b.style.hollow:
        b.cut("tray", slab(0.46 * width, (0.03 * depth, 0.97 * depth), (floor + 0.02, floor + 1)))
    wide = b.draw(0.15, 0.5) * radius
    for s in (-1, 1):
        b.part(
            "tray",
            beam(0.03, 0.03, (s * 0.3 * width, 0.5 * depth, floor), (s * 0.3 * width, 1.5 * depth, floor + 0.05)),
            beam(0.03, 0.03, (s * 0.3 * width, 0.9 * depth, floor + 0.01), (s * 0.3 * width, 0.95 * depth, 0)),
        )
    n = b.pick(1, 1, 2)
    for k in range(n):
        x = 0 if n == 1 else (k - 0.5) * 0.7 * width
        in_fork(
            b,
            f"wheel_{k}",
            parent="tray",
            middle=(x, b.draw(0, 0.2) * depth if n == 1 else 0.2 * depth, radius),
            radius=radius,
            wide=wide,
            top=floor + 0.01,
        )


@kind(
    "plain swivel chair",
    like="office_chair",
    height=length(0.38, 0.55),
    width=length(0.38, 0.55),
    number=whole(3, 5, words="leg, spoke"),
    radius=length(0.2, 0.32),
    kind=choice(("merged", "leans", "none")),
    thick=length(0.03, 0.08),
)
def plain_swivel_chair(
    b: ObjectBuilder, height: float, width: float, number: int, radius: float, kind: str, thick: float
) -> None:
    """A seat that turns or goes up on a column on feet; wheels in forks or bare discs below, a back that leans."""
    foot = b.pick(0, b.draw(0.04, 0.07))
    b.part("base", b.cylinder(0.03, foot, 0.75 * height), look="metal")
    for k, a in enumerate(np.arange(number) * 2 * pi / number):
        tip = radius * vector(cos(a), sin(a), 0)
        b.part("base", beam(0.04, 0.03, (0, 0, foot + 0.03), tip + (foot + 0.02) * Z))
        if foot:
            b.part("base", block(tip + (foot + 0.005) * Z, (0.03, 0.03, 0.02)))
            axis = vector(-sin(a), cos(a), 0)
            play = max(b.gap(foot), 0.0005)
            wheel_radius = 0.48 * foot - play
            at = tip + (wheel_radius - 0.02 * foot) * Z
            b.part(f"wheel_{k}", b.cylinder(wheel_radius, at - 0.012 * axis, at + 0.012 * axis), look="rubber")
            b.spin(f"wheel_{k}", parent="base", axis=axis, pivot=at)
    play = seam(b, 0.06, 0.03)
    low = 0.75 * height + play
    b.part(
        "seat",
        b.cylinder(0.02, 0.4 * height if b.style.has_bore else low, height),
        b.pick(
            b.cylinder(width / 2, height, height + 0.06),
            slab(width / 2, width / 2, (height, height + 0.08)),
        ),
    )
    b.bore("base", b.cylinder(0.02 + 2 * b.gap(0.06) + 0.0001, 0.38 * height, height))
    if b.maybe(0.75):
        b.spin("seat", parent="base", axis=Z, pivot=(0, 0, low))
    else:
        b.slide("seat", parent="base", axis=Z, upper=b.draw(0.05, 0.2))
    top = height + 0.1
    back = slab(0.45 * width, (width / 2, width / 2 + thick), (top, top + b.draw(0.3, 0.6)))
    if kind == "merged":
        b.part(
            "seat",
            back,
            slab(0.1 * width, (0.3 * width, width / 2 + 0.5 * thick), (height, height + 0.02)),
            slab(0.1 * width, (width / 2, width / 2 + 0.5 * thick), (height, top + 0.02)),
        )
    elif kind == "leans":
        b.part("seat", slab(0.1 * width, (0.3 * width, width / 2 + thick), (height, height + 0.04)))
        play1 = max(seam(b, width, 0.02), -0.01)
        lift = height + 0.04 + play1 - top
        b.part("back", back.translate(lift * Z))
        b.hinge(
            "back", parent="seat", axis=-X, pivot=(0, width / 2 + thick, height + 0.04 + play1), upper=0.5, ajar=False
        )


@kind(
    "plain toilet",
    like="toilet",
    width=length(0.34, 0.42),
    depth=length(0.4, 0.5),
    height=length(0.36, 0.42),
    tank=yes(0.8),
    reach=angle(1.45, 1.6),
)
def plain_toilet(b: ObjectBuilder, width: float, depth: float, height: float, tank: bool, reach: float) -> None:
    """A bowl and a tank: a seat and a lid behind it, a tank lid that lifts, a flush button or lever."""
    b.part(
        "bowl",
        slab(width / 2, (0.1, depth), (0, 0.5 * height)),
        b.cylinder(width / 2, (0, width / 2, 0.4 * height), (0, width / 2, height)),
        slab(width / 2, (width / 2, depth + 0.02), (0.4 * height, height)),
    )
    if b.style.hollow:
        b.cut("bowl", b.cylinder(0.36 * width, (0, width / 2, 0.5 * height), (0, width / 2, height + 1)))
    if tank:
        b.part("bowl", slab(0.5 * width, (depth + 0.02, depth + 0.18), (0.5 * height, height + 0.35)))
    play = seam(b, width, 0.015)
    level = height
    edge = depth - b.draw(0, 0.03)
    for name, thick in (("seat", b.draw(0.012, 0.03)), ("lid", b.draw(0.01, 0.03)))[: b.pick(2, 2, 1)]:
        low = level + play
        b.part(
            name,
            b.cylinder(width / 2, (0, width / 2, low), (0, width / 2, low + thick)),
            slab(width / 2, (width / 2, edge), (low, low + thick)),
        )
        if name == "seat":
            b.cut(name, b.cylinder(0.33 * width, (0, width / 2, low - 1), (0, width / 2, low + 1)))
        b.hinge(
            name,
            parent="bowl",
            axis=-X,
            pivot=(0, edge, low + b.pick(0, 0.5) * thick),
            upper=reach,
            ajar=False,
            rest=b.pick(0, 0, 0.95 * reach) if name == "lid" else 0,
        )
        level = low + thick
    if tank:
        play1 = seam(b, width, 0.02)
        high = height + 0.35
        if b.maybe(0.5):
            b.part(
                "tank_lid",
                slab(0.53 * width, (depth + 0.02 - min(0, play1), depth + 0.19), (high + play1, high + play1 + 0.03)),
            )
            b.slide("tank_lid", parent="bowl", axis=Z, upper=b.draw(0.05, 0.2), ajar=False)
        elif b.maybe():
            button(
                b,
                "flush",
                parent="bowl",
                at=(0, depth + 0.1, high),
                size=(0.05, 0.05),
                high=0.01,
                out=Z,
                is_round=b.maybe(),
            )
        else:
            at = vector(-0.35 * width, depth + 0.02, high - 0.06)
            play1 = b.gap(0.02) if b.style.has_bore else 0
            b.part(
                "lever",
                b.cylinder(0.012, at - play1 * Y, at - 0.015 * Y),
                beam(0.012, 0.008, at - 0.012 * Y, at - 0.012 * Y + 0.08 * X),
                look="metal",
            )
            b.hinge("lever", parent="bowl", axis=Y, pivot=at, upper=0.6, ajar=False)


@kind(
    "parametric grand piano",
    like="grand_piano",
    width=length(1.3, 1.5),
    depth=length(1.4, 2.4),
    height=length(0.65, 0.75),
    deep=length(0.25, 0.35),
)
def parametric_grand_piano(b: ObjectBuilder, width: float, depth: float, height: float, deep: float) -> None:
    """A case on legs, a large lid on its long side, a fall before the keys, keys and pedals as they come."""
    b.part(
        "case",
        slab(width / 2, (0.25, depth), (height, height + deep)),
        slab(width / 2, (0, 0.3), (height, height + 0.3 * deep)),
        look="wood",
    )
    for x, y in ((-0.4 * width, 0.15), (0.4 * width, 0.15), (0, 0.85 * depth)):
        b.part("case", b.cylinder(0.05, (x, y, 0), (x, y, height + 0.01)))
    if b.style.hollow:
        b.cut("case", slab(0.47 * width, (0.32, 0.97 * depth), (height + 0.1, height + 1)))
    leaf(
        b,
        "lid",
        parent="case",
        lower=(-width / 2, 0.25, height + deep),
        upper=(width / 2, depth, height + deep + 0.025),
        hinge=b.pick(X, -X),
        out=Z,
        handle=False,
        glazed=0.0,
        reach=b.draw(0.5, 1.2),
    )
    play1 = b.gap(0.1) + (0.013 if b.style.has_bore else 0)
    y = 0.222 if b.style.has_bore else 0.24
    low = height + 0.3 * deep
    if b.maybe(0.7):
        b.part("fall", slab(0.46 * width, (0.03, y), (low + 0.03 + play1, low + 0.045 + play1)))
        b.hinge("fall", parent="case", axis=-X, pivot=(0, y, low + 0.03 + play1), upper=b.draw(1.2, 1.6), ajar=False)
    for k, x in enumerate(spread(b.count(0, 6), -0.4 * width, 0.4 * width)):
        half = 0.025
        b.part(f"key_{k}", box((x - half, -0.02, low + play1), (x + half, 0.23, low + play1 + 0.015)))
        b.hinge(
            f"key_{k}",
            parent="case",
            axis=X,
            pivot=(x, 0.23, low + play1 + 0.0075),
            upper=0.05,
            lower=-0.02,
            ajar=False,
        )
