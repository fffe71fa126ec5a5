"""Small things on a table."""

from __future__ import annotations

from itertools import pairwise
from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.kind import choice, kind, length
from kinematify.generate.library.panels import leaf, seam
from kinematify.generate.procedural.solids import X, Y, Z, box, vector

if TYPE_CHECKING:
    from kinematify.generate.library.builder import ObjectBuilder


@kind(
    "flip cap bottle",
    words="flip top bottle, tube with a flip cap, toothpaste tube, sauce bottle, flip top tube",
    width=length(0.015, 0.04),
    thickness=length(0.008, 0.02),
    height=length(0.03, 0.07),
    kind=choice(("flips", "turns", "off")),
    share=length(0.5, 0.75),
)
def flip_cap(b: ObjectBuilder, width: float, thickness: float, height: float, kind: str, share: float) -> None:
    """A stick or a block with a cover: hinged at an end, turning about a pin, or drawn off: a lighter, a USB stick."""
    b.part("body", box((-width / 2, -thickness / 2, 0), (width / 2, thickness / 2, share * height)), material="metal")
    play = seam(b, thickness, 0.004)
    if kind == "turns":
        g = max(b.gap(thickness), 0) if b.style.has_bore else b.pick(0, b.gap(thickness))
        sheet = 0.08 * thickness
        for s in (-1, 1):
            b.part(
                "cover",
                box(
                    (-0.5 * width, s * (thickness / 2 + g), -0.1 * height),
                    (0.5 * width, s * (thickness / 2 + g + sheet), 0.9 * height),
                ),
            )
        b.part(
            "cover",
            box(
                (-0.5 * width, -thickness / 2 - g - sheet, 0.9 * height),
                (0.5 * width, thickness / 2 + g + sheet, 0.9 * height + sheet),
            ),
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
        b.part("body", box((-0.35 * width, -0.35 * thickness, 0), (0.35 * width, 0.35 * thickness, 0.9 * height)))
        low = share * height + play
        b.part("cover", box((-width / 2, -thickness / 2, low), (width / 2, thickness / 2, height)), material="metal")
        b.bore("cover", box((-0.4 * width, -0.4 * thickness, 0), (0.4 * width, 0.4 * thickness, 0.95 * height)))
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


@kind(
    "bag",
    words="handbag, shopping bag, tote bag, gym bag, doctor bag, purse",
    width=length(0.2, 0.45),
    depth=length(0.08, 0.2),
    height=length(0.15, 0.35),
    wire=length(0.003, 0.008),
)
def plain_bag(b: ObjectBuilder, width: float, depth: float, height: float, wire: float) -> None:
    """A bag or a basket with one handle or two that swing on its rim, and a flap at times."""
    b.part("bag", box((-width / 2, -depth / 2, 0), (width / 2, depth / 2, height)))
    if b.style.hollow:
        b.cut("bag", box((-0.47 * width, -0.44 * depth, 0.02 * height), (0.47 * width, 0.44 * depth, height + 1)))
    if b.maybe(0.4):
        leaf(
            b,
            "flap",
            parent="bag",
            lower=(-width / 2, -depth / 2, height),
            upper=(width / 2, depth / 2, height + 0.012),
            hinge=Y,
            out=Z,
            handle=False,
            glazed=0.0,
            reach=b.draw(1.5, 2.8),
        )
    half = b.draw(0.15, 0.35) * width
    tall = b.draw(0.3, 0.7) * height
    for k, s in enumerate((-1, 1)):
        y = s * (depth / 2 + wire + max(b.gap(depth), 0 if b.style.has_bore else -wire))
        z = height - b.draw(0.02, 0.15) * height
        points = [vector(half * cos(a), y, z + tall * sin(a)) for a in np.linspace(0, pi, b.count(5, 10))]
        b.part(f"strap_{k}", [b.rod(wire, p, q) for p, q in pairwise(points)])
        b.hinge(f"strap_{k}", parent="bag", axis=s * -X, pivot=(0, y, z), upper=b.draw(0.8, 2.5), ajar=False)
