"""Beds, seats and tables that fold, tilt or extend."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.kind import kind, length, whole
from kinematify.generate.library.mechanisms import case, legs, lever
from kinematify.generate.library.panels import carcass, drawer, leaf, seam
from kinematify.generate.procedural.builder import spread
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, slab

if TYPE_CHECKING:
    from kinematify.generate.procedural.builder import ObjectBuilder


@kind(
    "parametric wardrobe",
    like="cabinet",
    width=length(0.8, 1.8),
    depth=length(0.4, 0.65),
    height=length(1.7, 2.3),
    number=whole(1, 3, words="door"),
)
def wardrobe(b: ObjectBuilder, width: float, depth: float, height: float, number: int) -> None:
    """Two or three tall doors, now and then two drawers below."""
    foot = b.pick(0, 0.35)
    case(b, "carcass", lower=(-width / 2, 0, 0), upper=(width / 2, depth, height), opening=-Y, wall=0.02)
    if foot:
        b.part("carcass", slab(width / 2, (0, depth), (foot, foot + 0.02)))
        for k, x in enumerate(spread(2, -width / 2, width / 2)):
            drawer(
                b,
                f"drawer_{k}",
                parent="carcass",
                lower=(x - width / 4 + 0.03, 0, 0.04),
                upper=(x + width / 4 - 0.03, 0.8 * depth, foot - 0.03),
                out=-Y,
            )
    for k, x in enumerate(spread(number, -width / 2, width / 2)):
        side = X if k % 2 else -X
        leaf(
            b,
            f"door_{k}",
            parent="carcass",
            lower=(x - width / 2 / number, -0.02, foot + 0.01),
            upper=(x + width / 2 / number, 0, height),
            hinge=side,
            out=-Y,
            reach=b.draw(1.4, 2.4),
        )


@kind(
    "parametric chest of drawers",
    like="cabinet",
    width=length(0.4, 1.2),
    depth=length(0.35, 0.55),
    height=length(0.5, 1.3),
    number=whole(2, 6, words="drawer"),
    columns=whole(1, 2),
)
def chest_of_drawers(b: ObjectBuilder, width: float, depth: float, height: float, number: int, columns: int) -> None:
    """Rows of drawers."""
    case(b, "chest", lower=(-width / 2, 0, 0), upper=(width / 2, depth, height))
    for i, z in enumerate(spread(number, 0.03, height - 0.03)):
        for k, x in enumerate(spread(columns, -width / 2, width / 2)):
            a = 0.46 * width / columns
            b_ = 0.42 * (height - 0.06) / number
            drawer(
                b,
                f"drawer_{i}_{k}",
                parent="chest",
                lower=(x - a, 0, z - b_),
                upper=(x + a, b.draw(0.7, 0.9) * depth, z + b_),
                out=-Y,
            )


@kind(
    "parametric nightstand",
    like="cabinet",
    width=length(0.35, 0.6),
    height=length(0.4, 0.7),
    leg=length(0.05, 0.2),
)
def nightstand(b: ObjectBuilder, width: float, height: float, leg: float) -> None:
    """On legs, a drawer over a shelf or a door."""
    case(b, "stand", lower=(-width / 2, 0, leg), upper=(width / 2, 0.8 * width, height), opening=-Y, wall=0.018)
    legs(b, "stand", lower=(-width / 2, 0, 0), upper=(width / 2, 0.8 * width, leg + 0.005), thick=0.04)
    level = leg + b.draw(0.5, 0.65) * (height - leg)
    b.part("stand", slab(width / 2, (0, 0.8 * width), (level - 0.015, level)))
    b.part("stand", slab(width / 2 - 0.005, (0.02, 0.8 * width), (level, height - 0.005)))
    drawer(
        b,
        "drawer",
        parent="stand",
        lower=(-0.45 * width, 0, level + 0.01),
        upper=(0.45 * width, 0.6 * width, height - 0.03),
        out=-Y,
    )
    if b.maybe():
        leaf(
            b,
            "door",
            parent="stand",
            lower=(-width / 2, -0.018, leg),
            upper=(width / 2, 0, level - 0.005),
            hinge=b.pick(X, -X),
            out=-Y,
        )


@kind(
    "parametric gateleg table",
    like="drop_leaf_table",
    width=length(0.7, 1.1),
    depth=length(0.8, 1.4),
    m=length(0.2, 0.5),
)
def gateleg_table(b: ObjectBuilder, width: float, depth: float, m: float) -> None:
    """Leaves that hang from a narrow middle, or lie level with it."""
    h = 0.74
    b.part("middle", slab(m / 2, depth / 2, (h - 0.025, h)), look="wood")
    legs(b, "middle", lower=(-m / 2, -depth / 2 + 0.05, 0), upper=(m / 2, depth / 2 - 0.05, h - 0.02), thick=0.05)
    for k, s in enumerate((-1, 1)):
        leaf(
            b,
            f"leaf_{k}",
            parent="middle",
            lower=(s * m / 2, -depth / 2, h - 0.025),
            upper=(s * (m / 2 + width / 2), depth / 2, h),
            hinge=-s * X,
            out=-Z,
            reach=b.draw(1.3, 1.57),
            handle=False,
        )


@kind(
    "parametric recliner",
    like="recliner",
    width=length(0.6, 0.9),
    depth=length(0.5, 0.6),
    height=length(0.38, 0.48),
)
def parametric_recliner(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A back that leans and a foot rest that comes up."""
    b.part("seat", slab(width / 2, (0, depth), (0.05, height)), look="wood")
    for s in (-1, 1):
        b.part("seat", box((s * width / 2, -0.02, 0), (s * (width / 2 + 0.12), depth + 0.1, height + 0.2)))
    g = b.gap(0.2)
    b.part(
        "back",
        slab(width / 2 - g, (depth + g, depth + 0.15), (height - 0.15, height + b.draw(0.5, 0.75))),
    )
    b.hinge("back", parent="seat", axis=-X, pivot=(0, depth + b.style.gap, height - 0.15), upper=0.6)
    b.part("rest", slab(width / 2 - g, (-0.08, -g), (0.08, height - 0.02)))
    b.hinge("rest", parent="seat", axis=-X, pivot=(0, -0.08, height - 0.02), upper=1.3)
    if b.maybe():
        lever(b, "handle", parent="seat", at=(width / 2 + 0.12, 0.3 * depth, height), out=X, along=-Y, length=0.15)


@kind(
    "parametric folding bed",
    like="murphy_bed",
    width=length(0.9, 1.6),
    height=length(2.0, 2.2),
)
def folding_bed(b: ObjectBuilder, width: float, height: float) -> None:
    """A bed that folds down out of a wall case."""
    case(
        b, "case", lower=(-width / 2 - 0.03, 0, 0), upper=(width / 2 + 0.03, 0.4, height + 0.05), opening=-Y, wall=0.025
    )
    g = b.gap(0.2)
    b.part("bed", slab(width / 2 - g, (-0.02, 0 if not b.style.hollow else 0.25), (0.35, height)), look="wood")
    b.hinge(
        "bed", parent="case", axis=X, pivot=(0, 0 if b.style.line else 0.1, 0.36 if b.style.line else 0.4), upper=1.57
    )


@kind(
    "parametric rocking cradle", like="cradle", width=length(0.7, 1.0), radius=length(0.2, 0.3), height=length(0.7, 1.0)
)
def rocking_cradle(b: ObjectBuilder, width: float, radius: float, height: float) -> None:
    """A cradle that swings between two posts."""
    for s in (-1, 1):
        x = s * (width / 2 + 0.05)
        b.part(
            "stand",
            beam(0.04, 0.04, (x, -0.3, 0), (x, 0, height), X),
            beam(0.04, 0.04, (x, 0.3, 0), (x, 0, height), X),
            look="wood",
        )
    b.part(
        "stand",
        beam(0.04, 0.04, (-width / 2 - 0.05, 0, 0.15), (width / 2 + 0.05, 0, 0.15)),
        beam(0.04, 0.04, (-width / 2 - 0.05, -0.26, 0.15), (-width / 2 - 0.05, 0.26, 0.15)),
    )
    b.part("stand", beam(0.04, 0.04, (width / 2 + 0.05, -0.26, 0.15), (width / 2 + 0.05, 0.26, 0.15)))
    g = b.gap(0.05)
    top = height - 0.05
    b.part("cradle", slab(width / 2 - 0.01 - g, radius, (top - 0.35, top - 0.05)), look="wood")
    b.cut("cradle", slab(width / 2 - 0.03, radius - 0.02, (top - 0.33, top)))
    for s in (-1, 1):
        x = s * (width / 2 - 0.02 - g)
        b.part("cradle", beam(0.02, 0.06, (x, 0, top - 0.2), (x, 0, top + 0.02), Y))
        if b.style.barrels or b.style.has_bore:
            b.part("cradle", b.cylinder(0.012, (x, 0, top), (s * (width / 2 + 0.06), 0, top)))
    b.bore("stand", b.cylinder(0.012 + 1.5 * g, (-width, 0, top), (width, 0, top)))
    b.hinge("cradle", parent="stand", axis=X, pivot=(0, 0, top), upper=0.4, lower=-0.4, ajar=False)


@kind(
    "mirror on a stand",
    words="tilting table mirror, shaving mirror, magnifying mirror",
    like="cheval_mirror",
    width=length(0.2, 0.7),
    height=length(0.3, 1.6),
)
def mirror_on_stand(b: ObjectBuilder, width: float, height: float) -> None:
    """A mirror that tilts between two posts or in a fork."""
    g = b.gap(0.04) + 0.001
    b.part("stand", slab(width / 2 + 0.05, 0.15, (0, 0.03)), look="wood")
    for s in (-1, 1):
        b.part(
            "stand",
            b.cylinder(0.018, (s * (width / 2 + 0.02 + g), 0, 0), (s * (width / 2 + 0.02 + g), 0, 0.1 + 0.6 * height)),
        )
    z = 0.08 + 0.5 * height
    glass = (
        b.cylinder(width / 2, (0, -0.01, z), (0, 0.01, z))
        if height < 1.1 * width
        else slab(width / 2, 0.01, (0.08, 0.08 + height))
    )
    b.part("mirror", glass, look="glass")
    if b.style.barrels or b.style.has_bore:
        own = b.pick("mirror", "stand")
        b.bore(
            f"{'stand' if own == 'mirror' else 'mirror'}", b.cylinder(0.006 + 1.5 * g, (-width, 0, z), (width, 0, z))
        )
        b.part(
            own,
            b.cylinder(0.006, (-width / 2 - 0.02, 0, z), (-width / 2 + 0.001, 0, z)),
            b.cylinder(0.006, (width / 2 - 0.001, 0, z), (width / 2 + 0.02, 0, z)),
        )
    b.hinge("mirror", parent="stand", axis=X, pivot=(0, 0, z), upper=0.5, lower=-0.5)


@kind(
    "drawer table",
    like="table",
    width=length(0.7, 1.8),
    depth=length(0.45, 0.9),
    height=length(0.45, 0.8),
    top=length(0.015, 0.04),
    apron=length(0.08, 0.16),
    number=whole(1, 3, words="drawer"),
)
def drawer_table(
    b: ObjectBuilder, width: float, depth: float, height: float, top: float, apron: float, number: int
) -> None:
    """A table or desk whose apron or pedestal holds drawers: fronts alone, trays or blocks."""
    wall = 0.018
    b.part("table", slab(width / 2, (-0.02, depth), (height - top, height)), look="wood")
    legs(
        b,
        "table",
        lower=(-width / 2 + 0.03, 0.0, 0),
        upper=(width / 2 - 0.03, depth - 0.02, height - top + 0.002),
        thick=b.draw(0.03, 0.08),
    )
    low = height - top - apron
    high = height - top
    carcass(
        b,
        "table",
        lower=(-width / 2 + 0.05, 0.02, low),
        upper=(width / 2 - 0.05, depth - 0.05, high),
        wall=wall,
        uprights=np.linspace(-width / 2 + 0.05, width / 2 - 0.05, number + 1)[1:-1],
    )
    for k, x in enumerate(spread(number, -width / 2 + 0.05, width / 2 - 0.05)):
        half = (width - 0.1) / 2 / number - wall - 0.001
        b.bore("table", box((x - half, 0.0, low + wall + 0.001), (x + half, depth - 0.06, high - wall - 0.001)))
        drawer(
            b,
            f"drawer_{k}",
            parent="table",
            lower=(x - half, 0.02, low + wall + 0.001),
            upper=(x + half, b.draw(0.5, 0.9) * depth, high - wall - 0.001),
            lap=0,
        )
    if b.maybe(0.4):
        side = b.pick(X, -X)
        play = max(seam(b, 0.3, 0.01), 0)
        z = low - 0.02 - play
        b.part(
            "board",
            box(0.45 * width * side + 0.1 * depth * Y + z * Z, 0.1 * width * side + 0.8 * depth * Y + (z + 0.015) * Z),
        )
        b.slide("board", parent="table", axis=side, upper=b.draw(0.15, 0.3) * width)


@kind(
    "desk with pedestal",
    like="table",
    width=length(1.1, 1.8),
    depth=length(0.55, 0.8),
    height=length(0.7, 0.78),
    p=length(0.35, 0.5),
)
def desk_with_pedestal(b: ObjectBuilder, width: float, depth: float, height: float, p: float) -> None:
    """A desk with three drawers on one side and a keyboard tray."""
    b.part(
        "desk",
        slab(width / 2, (0, depth), (height - 0.03, height)),
        box((width / 2 - 0.03, 0, 0), (width / 2, depth, height)),
        look="wood",
    )
    b.part("desk", box((-width / 2, 0.02, 0), (-width / 2 + p, depth, height - 0.02)))
    for k, z in enumerate(spread(3, 0.05, height - 0.04)):
        drawer(
            b,
            f"drawer_{k}",
            parent="desk",
            lower=(-width / 2 + 0.03, 0.02, z - 0.09),
            upper=(-width / 2 + p - 0.03, depth - 0.08, z + 0.09),
            out=-Y,
        )
    if b.maybe(0.6):
        g = b.gap(0.02)
        x0 = -width / 2 + p + 0.1
        x1 = width / 2 - 0.1
        for x in (x0 - 0.015, x1 + 0.015):
            b.part("desk", box((x - 0.015 + g, 0.05, height - 0.1), (x + 0.015 - g, depth - 0.1, height - 0.025)))
        b.part("tray", box((x0, 0.03, height - 0.1), (x1, 0.4, height - 0.08)))
        b.slide("tray", parent="desk", axis=-Y, upper=0.3)


@kind(
    "glider chair",
    like="swing_seat",
    size=length(0.9, 1.1),
)
def glider_chair(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "stand",
        p.slab(0.4, 0.4, (0, 0.04)),
        [p.slab((s * 0.36 - 0.02, s * 0.36 + 0.02), 0.03, (0.03, 0.62)) for s in (-1, 1)],
        look="wood",
    )
    b.bore("stand", p.cylinder(0.0115, (-1, 0, 0.58), (1, 0, 0.58)))
    b.part(
        "seat",
        p.slab(0.28, (-0.28, 0.25), (0.36, 0.4)),
        p.beam(0.56, 0.03, (0, 0.24, 0.38), (0, 0.36, 1), X),
        [p.slab((s * 0.3, s * 0.25), 0.25, (0.55, 0.61)) for s in (-1, 1)],
        [p.box((s * 0.28, -0.22, 0.38), (s * 0.25, -0.17, 0.56)) for s in (-1, 1)],
        [p.box((s * 0.28, 0.17, 0.38), (s * 0.25, 0.22, 0.56)) for s in (-1, 1)],
        [p.cylinder(0.01, (s * 0.29, 0, 0.58), (s * 0.39, 0, 0.58)) for s in (-1, 1)],
        look="brown wood",
    )
    b.hinge("seat", parent="stand", axis=X, pivot=p(0, 0, 0.58), upper=0.3, lower=-0.3)
