"""Small things on a table."""

from __future__ import annotations

from itertools import pairwise
from math import cos, pi, sin

import numpy as np

from kinematify.generate.library.kind import kind
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.solids import X, Y, Z, slab, vector


@kind(
    "bag",
    walls=4,
    words="handbag, shopping bag, tote bag, purse",
    width=(0.2, 0.45),
    depth=(0.08, 0.2),
    height=(0.15, 0.35),
    wire=(0.003, 0.008),
)
def plain_bag(b: ObjectBuilder, width: float, depth: float, height: float, wire: float) -> None:
    """A bag or a basket with one handle or two that swing on its rim, and a flap at times."""
    b.part("bag", slab(width / 2, depth / 2, (0, height)))
    if b.style.hollow:
        b.cut("bag", slab(0.47 * width, 0.44 * depth, (0.02 * height, height + 1)))
    if b.maybe(0.4):
        leaf(
            b,
            "flap",
            "bag",
            (-width / 2, -depth / 2, height),
            (width / 2, depth / 2, height + 0.012),
            hinge=Y,
            out=Z,
            handle=False,
            reach=b.draw(1.5, 2.8),
        )
    half = b.draw(0.15, 0.35) * width
    tall = b.draw(0.3, 0.7) * height
    for k, s in enumerate((-1, 1)):
        y = s * (depth / 2 + wire + max(b.gap(depth), 0 if b.style.has_bore else -wire))
        z = height - b.draw(0.02, 0.15) * height
        points = [vector(half * cos(a), y, z + tall * sin(a)) for a in np.linspace(0, pi, b.count(5, 10))]
        b.part(f"strap_{k}", [b.rod(wire, p, q) for p, q in pairwise(points)])
        b.hinge(f"strap_{k}", "bag", s * -X, (0, y, z), b.draw(0.8, 2.5), ajar=False)
