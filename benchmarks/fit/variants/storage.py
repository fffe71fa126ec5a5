"""Cabinets, drawers, boxes and bins as others model them."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.fit.variants.openings import pane
from kinematify.generate.library.kind import angle, choice, kind, length, whole, yes
from kinematify.generate.library.mechanisms import case, caster, legs, wheel
from kinematify.generate.library.panels import carcass, drawer, grip, leaf, seam
from kinematify.generate.procedural.builder import spread
from kinematify.generate.procedural.solids import X, Y, Z, box, prism, slab

if TYPE_CHECKING:
    from kinematify.generate.procedural.builder import ObjectBuilder


@kind(
    "slab cabinet",
    like="cabinet",
    width=length(0.35, 1.6),
    depth=length(0.25, 0.6),
    height=length(0.4, 2.0),
    wall=length(0.012, 0.03),
    thick=length(0.012, 0.03),
)
def slab_cabinet(b: ObjectBuilder, width: float, depth: float, height: float, wall: float, thick: float) -> None:
    """Rows and columns of doors before a body or let into it, on the floor, on feet, or on a wall."""
    foot = b.pick(0, 0, b.draw(0.05, 0.2))
    rows = b.pick(1, 1, 2)
    columns = min(b.count(1, 3), max(1, round(width / 0.3)))
    levels = [foot + (height - foot) * b.draw(0.35, 0.65)] if rows == 2 else []
    edges = np.linspace(-width / 2, width / 2, columns + 1)
    inset = b.maybe(0.3) and b.style.hollow
    carcass(
        b,
        "body",
        lower=(-width / 2, 0, foot),
        upper=(width / 2, depth, height),
        wall=wall,
        shelves=levels,
        uprights=edges[1:-1] if inset else (),
    )
    if foot:
        legs(b, "body", lower=(-width / 2, 0, 0), upper=(width / 2, depth, foot + 0.002), thick=b.draw(0.02, 0.05))
    if b.maybe(0.3):
        b.part("body", slab(width / 2 + 0.02, (-0.03 - thick, depth), (height, height + 0.03)))
    sides = [b.pick(X, -X)] if columns == 1 else [-X, X, b.pick(X, -X)]
    bounds = [foot, *levels, height]
    for i, (a, b_) in enumerate(pairwise(bounds)):
        for k, (c, e) in enumerate(pairwise(edges)):
            if inset:
                low = (c + (wall if k == 0 else wall / 2), 0.0, a + (wall if i == 0 else wall / 2))
                high = (e - (wall if k == columns - 1 else wall / 2), thick, b_ - (wall if i == rows - 1 else wall / 2))
            else:
                low = (c, -thick, a)
                high = (e, 0.0, b_)
            leaf(
                b,
                f"door_{i}_{k}",
                parent="body",
                lower=low,
                upper=high,
                hinge=sides[k],
                inset=inset,
                reach=b.draw(1.4, 2.8),
                handle=b.maybe(0.8),
                glazed=0.25,
            )


@kind(
    "slab wardrobe",
    like="cabinet",
    number=whole(2, 3, words="leaf, door"),
    width=length(0.5, 0.9),
    depth=length(0.45, 0.65),
    height=length(1.2, 2.4),
    wall=length(0.015, 0.03),
    thick=length(0.012, 0.03),
    lap=length(0.0, 0.05),
)
def slab_wardrobe(
    b: ObjectBuilder, number: int, width: float, depth: float, height: float, wall: float, thick: float, lap: float
) -> None:
    """A tall case with two or three leaves that slide past each other, between boards or before the case."""
    wide = number * width
    carcass(
        b,
        "body",
        lower=(-wide / 2, 0, 0),
        upper=(wide / 2, depth, height),
        wall=wall,
        uprights=spread(number - 1, -wide / 2 + width / 2, wide / 2 - width / 2) if b.maybe() else (),
    )
    play = seam(b, width, thick)
    inside = b.maybe(0.4) and b.style.hollow
    z0, z1 = (wall + max(play, 0), height - wall - max(play, 0)) if inside or b.maybe() else (0, height)
    if inside:
        for a, b_ in ((0, wall), (height - wall, height)):
            b.part("body", slab(wide / 2, (-3 * thick - 0.01, 0.01), (a, b_)))
        for s in (-1, 1):
            b.part("body", box((s * wide / 2, -3 * thick - 0.01, 0), (s * (wide / 2 - wall), 0.01, height)))
    for k in range(number):
        a = -wide / 2 + k * width - lap * (k > 0)
        b_ = -wide / 2 + (k + 1) * width + lap * (k < number - 1)
        a = max(a, -wide / 2 + wall + 0.001)
        b_ = min(b_, wide / 2 - wall - 0.001)
        y = -thick - play - k % 2 * (thick + max(play, 0))
        pane(b, f"leaf_{k}", (a, y, z0), (b_, y + thick, z1))
        s = 1 if k < number - 1 else -1
        if b.maybe(0.6) and k % 2:
            grip(
                b,
                f"leaf_{k}",
                at=(a + 0.06 if s < 0 else b_ - 0.06, y, height / 2),
                out=-Y,
                along=Z,
                length=b.draw(0.1, 0.3) * height,
            )
        b.slide(f"leaf_{k}", parent="body", axis=s * X, upper=b.draw(0.7, 0.95) * (width - 2 * wall))


@kind(
    "drawer stack",
    words="stack of drawers",
    like="cabinet",
    width=length(0.3, 1.2),
    depth=length(0.3, 0.6),
    height=length(0.3, 1.3),
    number=whole(1, 10, default=3, usual=(1, 5), words="drawer"),
    wall=length(0.012, 0.025),
    boards=yes(0.5),
)
def drawer_stack(
    b: ObjectBuilder, width: float, depth: float, height: float, number: int, wall: float, boards: bool
) -> None:
    """Drawers one above the other, now and then in columns, with fronts before the body or in it, or as open trays."""
    foot = b.pick(0, 0, b.draw(0.05, 0.15))
    columns = b.pick(1, 1, 2)
    levels = np.linspace(foot, height, number + 1)
    edges = np.linspace(-width / 2, width / 2, columns + 1)
    carcass(
        b,
        "body",
        lower=(-width / 2, 0, foot),
        upper=(width / 2, depth, height),
        wall=wall,
        shelves=levels[1:-1] if boards else (),
        uprights=edges[1:-1],
    )
    if foot:
        legs(b, "body", lower=(-width / 2, 0, 0), upper=(width / 2, depth, foot + 0.002), thick=b.draw(0.02, 0.05))
    lap = b.pick(0, 0.8 * wall)
    deep = b.draw(0.6, 0.95) * (depth - wall)
    share = wall if boards or lap else 0.003
    for i, (a, b_) in enumerate(pairwise(levels)):
        for k, (c, e) in enumerate(pairwise(edges)):
            low = (c + wall * (1 if k == 0 else 0.5), 0.0, a + (wall if i == 0 else share / 2) + 0.001)
            high = (
                e - wall * (1 if k == columns - 1 else 0.5),
                deep,
                b_ - (wall if i == number - 1 else share / 2) - 0.001,
            )
            drawer(
                b,
                f"drawer_{i}_{k}",
                parent="body",
                lower=low,
                upper=high,
                lap=0.45 * share if lap and (not boards) else lap / 2.2,
            )


@kind(
    "doors and drawers",
    words="cabinet of doors and drawers",
    like="cabinet",
    number=whole(1, 4, words="door"),
    field=length(0.3, 0.6),
    depth=length(0.3, 0.6),
    height=length(0.4, 1.0),
    wall=length(0.012, 0.025),
    thick=length(0.012, 0.025),
)
def doors_and_drawers(
    b: ObjectBuilder, number: int, field: float, depth: float, height: float, wall: float, thick: float
) -> None:
    """A sideboard or kitchen unit: fields that hold a door, drawers, a flap or nothing."""
    w = number * field
    edges = np.linspace(-w / 2, w / 2, number + 1)
    level = b.draw(0.55, 0.8) * height
    carcass(
        b, "body", lower=(-w / 2, 0, 0), upper=(w / 2, depth, height), wall=wall, shelves=(level,), uprights=edges[1:-1]
    )
    for k, (c, e) in enumerate(pairwise(edges)):
        kind = b.pick("door and drawer", "drawers", "door", "flap") if k else "door and drawer"
        low = c + wall
        high = e - wall
        if kind not in ("door", "flap"):
            drawer(
                b,
                f"drawer_{k}_top",
                parent="body",
                lower=(low, 0, level + wall),
                upper=(high, 0.8 * depth, height - wall),
                lap=0.4 * wall,
                front=thick,
            )
        if kind == "drawers":
            drawer(
                b,
                f"drawer_{k}_low",
                parent="body",
                lower=(low, 0, wall + 0.002),
                upper=(high, 0.8 * depth, level - wall),
                lap=0.4 * wall,
                front=thick,
            )
        elif kind == "flap":
            leaf(
                b,
                f"flap_{k}",
                parent="body",
                lower=(c + 0.001, -thick, 0),
                upper=(e - 0.001, 0, level),
                hinge=b.pick(-Z, Z),
                reach=b.draw(1.2, 1.57),
                glazed=0.25,
            )
        else:
            leaf(
                b,
                f"door_{k}",
                parent="body",
                lower=(c + 0.001, -thick, 0),
                upper=(e - 0.001, 0, level - 0.5 * wall if kind != "door" else height),
                hinge=b.pick(-X, X),
                reach=b.draw(1.4, 2.2),
                glazed=0.25,
            )


@kind(
    "lidded box",
    like="box",
    width=length(0.15, 1.2),
    depth=length(0.12, 0.6),
    height=length(0.08, 0.6),
    kind=choice(("lid", "lid", "lid", "two", "four", "off")),
    reach=angle(1.2, 3.3),
)
def lidded_box(b: ObjectBuilder, width: float, depth: float, height: float, kind: str, reach: float) -> None:
    """A box with one lid, two flaps or four, thin or thick, shut or half open; or a lid that is lifted off."""
    wall = b.draw(0.01, 0.06) * min(width, depth, height)
    if b.style.hollow:
        b.part("body", slab(width / 2, depth / 2, (0, height)), look="wood")
        b.cut("body", slab(width / 2 - wall, depth / 2 - wall, (wall, height + 1)))
    else:
        b.part("body", slab(width / 2, depth / 2, (0, height)), look="wood")
    thick = b.pick(wall, 2 * wall, b.draw(0.1, 0.4) * height)
    if kind == "off":
        play = seam(b, depth, thick)
        over = b.draw(0, 0.02)
        b.part(
            "lid",
            slab(width / 2 + over, depth / 2 + over, (height + play, height + play + thick)),
        )
        b.slide("lid", parent="body", axis=Z, upper=b.draw(0.3, 1) * height)
    else:
        if kind == "lid":
            leaf(
                b,
                "lid",
                parent="body",
                lower=(-width / 2, -depth / 2, height),
                upper=(width / 2, depth / 2, height + thick),
                hinge=b.pick(Y, Y, X),
                out=Z,
                reach=min(reach, 2),
                glazed=0.05,
            )
        else:
            for k, (side, a, b_) in enumerate(((-X, -width / 2, 0), (X, 0, width / 2))):
                leaf(
                    b,
                    f"flap_{k}",
                    parent="body",
                    lower=(a, -depth / 2, height),
                    upper=(b_, depth / 2, height + wall),
                    hinge=side,
                    out=Z,
                    reach=reach,
                    handle=False,
                    glazed=0.0,
                )
        if kind == "four":
            for k, (side, a, b_) in enumerate(((-Y, -depth / 2, -0.1 * depth), (Y, 0.1 * depth, depth / 2))):
                leaf(
                    b,
                    f"cross_flap_{k}",
                    parent="body",
                    lower=(-width / 2, a, height + 1.2 * wall + b.style.gap),
                    upper=(width / 2, b_, height + 2.2 * wall + b.style.gap),
                    hinge=side,
                    out=Z,
                    reach=reach,
                    handle=False,
                    glazed=0.0,
                )


@kind(
    "plain bin",
    like="trash_can",
    width=length(0.25, 0.6),
    depth=length(0.25, 0.6),
    height=length(0.35, 1.1),
    round_one=yes(0.3),
    thick=length(0.008, 0.06),
)
def plain_bin(b: ObjectBuilder, width: float, depth: float, height: float, round_one: bool, thick: float) -> None:
    """A bin whose lid is hinged behind, swings about its middle, or is two halves; at times wheels, a pedal."""
    r = min(width, depth) / 2
    body = b.cone(0.85 * r, r, 0, height) if round_one else slab(width / 2, depth / 2, (0, height))
    b.part("bin", body)
    if round_one:
        width = 2 * r
        depth = 2 * r
    if b.style.hollow:
        b.cut(
            "bin",
            b.cone(0.75 * r, 0.92 * r, 0.02, height + 0.01)
            if round_one
            else slab(0.46 * width, 0.46 * depth, (0.02, height + 1)),
        )
    play = seam(b, width, thick)
    kind = b.pick("behind", "behind", "swings", "halves") if not round_one else "behind"
    low = height + play
    if round_one:
        b.part("lid", b.cylinder(r, low, low + thick))
        b.hinge("lid", parent="bin", axis=-X, pivot=(0, r, low + (1 - b.style.line) * thick), upper=b.draw(1, 1.7))
    elif kind == "behind":
        leaf(
            b,
            "lid",
            parent="bin",
            lower=(-width / 2, -depth / 2, height),
            upper=(width / 2, depth / 2, height + thick),
            hinge=Y,
            out=Z,
            reach=b.draw(1.2, 2.2),
            glazed=0.0,
            material="plastic",
        )
    elif kind == "swings":
        b.part(
            "bin",
            [slab((s * width / 2, s * 0.44 * width), depth / 2, (height, height + 0.4 * depth)) for s in (-1, 1)],
        )
        g = max(seam(b, width, 0.01), 0.001)
        z = height + 0.36 * depth
        b.part(
            "lid",
            prism(
                [(-0.4 * depth, z - 0.3 * depth), (0, z + 0.02), (0, z + 0.03), (-0.42 * depth, z - 0.29 * depth)],
                (0, 0, 0),
                0.88 * width - 2 * g,
                "x",
            ),
            prism(
                [(0.4 * depth, z - 0.3 * depth), (0.42 * depth, z - 0.29 * depth), (0, z + 0.03), (0, z + 0.02)],
                (0, 0, 0),
                0.88 * width - 2 * g,
                "x",
            ),
        )
        b.hinge("lid", parent="bin", axis=X, pivot=(0, 0, z), upper=0.6, lower=-0.6, ajar=False)
    else:
        for k, (side, a, b_) in enumerate(((-X, -width / 2, 0), (X, 0, width / 2))):
            leaf(
                b,
                f"lid_{k}",
                parent="bin",
                lower=(a, -depth / 2, height),
                upper=(b_, depth / 2, height + thick),
                hinge=side,
                out=Z,
                reach=b.draw(1.2, 1.8),
                glazed=0.0,
                handle=False,
                material="plastic",
            )
    if b.maybe(0.3) and (not round_one):
        for k, s in enumerate((-1, 1)):
            g = b.gap(0.1)
            wheel(
                b,
                f"wheel_{k}",
                parent="bin",
                middle=(s * (width / 2 + 0.02 + g), 0.4 * depth, 0.09),
                radius=b.draw(0.08, 0.1),
                wide=0.04,
                out=s * X,
            )
    elif b.maybe(0.4):
        deep = depth / 2 if not round_one else 0.85 * r
        g = b.gap(0.05)
        b.part("pedal", slab(0.05, (-deep - 0.08, -deep - g if b.style.has_bore else -0.9 * deep), (0.01, 0.022)))
        b.hinge(
            "pedal",
            parent="bin",
            axis=X,
            pivot=(0, -deep - g if b.style.has_bore else -0.9 * deep, 0.016),
            upper=b.draw(0.1, 0.3),
            lower=-0.02,
            ajar=False,
        )


@kind(
    "plain suitcase",
    like="suitcase",
    width=length(0.35, 0.5),
    depth=length(0.18, 0.3),
    height=length(0.5, 0.75),
    foot=length(0.03, 0.06),
    split=yes(0.4),
    radius=length(0.005, 0.01),
    top=length(0.01, 0.06),
    x=length(0.1, 0.2),
)
def plain_suitcase(
    b: ObjectBuilder,
    width: float,
    depth: float,
    height: float,
    foot: float,
    split: bool,
    radius: float,
    top: float,
    x: float,
) -> None:
    """A case on end with two halves or one block, a handle that telescopes, a carry handle, and wheels below."""
    middle = b.draw(-0.1, 0.1) * depth if split else -depth / 2
    b.part("body", slab(width / 2, (middle, depth / 2), (foot, foot + height)))
    if split:
        play = seam(b, width, 0.01)
        b.part("lid", slab(width / 2, (-depth / 2, middle - play), (foot, foot + height)))
        side = b.pick(X, -X)
        b.hinge(
            "lid",
            parent="body",
            axis=np.cross(-Y, side),
            pivot=width / 2 * side + (middle - b.pick(0, play)) * Y + 0.5 * height * Z,
            upper=b.draw(1.5, 3),
            ajar=False,
        )
        if b.style.hollow:
            b.cut(
                "body",
                slab(0.48 * width, (middle - 1, 0.46 * depth), (foot + 0.02 * height, foot + 0.98 * height)),
            )
            b.cut(
                "lid",
                slab(0.48 * width, (-0.46 * depth, middle + 1), (foot + 0.02 * height, foot + 0.98 * height)),
            )
    play1 = b.gap(0.03)
    y = depth / 2 - 0.02
    low = foot + height * b.draw(0.1, 0.5)
    for s in (-1, 1):
        b.bore(
            "body",
            box(
                (s * x - radius - play1, y - radius - play1, low - 0.01),
                (s * x + radius + play1, y + radius + play1, foot + height + 0.1),
            ),
        )
        b.part(
            "handle",
            box((s * x - radius, y - radius, low), (s * x + radius, y + radius, foot + height + top)),
            look="metal",
        )
    b.part(
        "handle",
        slab(x + radius, (y - 0.014, y + 0.014), (foot + height + top, foot + height + top + 0.025)),
    )
    b.slide("handle", parent="body", axis=Z, upper=b.draw(0.5, 0.9) * (foot + height - low), ajar=b.maybe())
    for k, s in enumerate((-1, 1)) if b.maybe(0.7) else ():
        at = (s * 0.38 * width, depth / 2 - 0.035, foot - b.pick(0.005, 0))
        g = max(b.gap(0.03), 0.001)
        b.cut("body", b.cylinder(foot + g, (at[0] - 0.013 - g, at[1], at[2]), (at[0] + 0.013 + g, at[1], at[2])))
        wheel(b, f"wheel_{k}", parent="body", middle=at, radius=foot * 0.95, wide=0.025, out=s * X)
    if b.maybe(0.5):
        g = b.gap(0.02)
        z = foot + height / 2
        half = 0.07
        side = b.pick(-1, 1)
        if split:
            side = -side
        a = side * (width / 2 + (0.014 if b.style.has_bore else g))
        lift = side * 0.035
        if not split:
            b.part(
                "grip",
                slab((a, a + lift), 0.012, (z - half, z - half + 0.012)),
                slab((a, a + lift), 0.012, (z + half - 0.012, z + half)),
                slab((a + lift, a + 0.75 * lift), 0.012, (z - half, z + half)),
            )
            if b.style.has_bore:
                b.part(
                    "body",
                    [
                        slab(
                            (side * width / 2.01, a + side * 0.006),
                            0.008,
                            (z + s * (half + 0.001), z + s * (half + 0.013)),
                        )
                        for s in (-1, 1)
                    ],
                )
                b.cut("body", b.cylinder(0.003 + 1.5 * g, (a, 0, z - half - 0.011), (a, 0, z + half + 0.011)))
                b.part("grip", b.cylinder(0.003, (a, 0, z - half - 0.01), (a, 0, z + half + 0.01)))
            b.hinge("grip", parent="body", axis=Z, pivot=(a, 0, z), upper=1.2, lower=-1.2, ajar=False)


@kind(
    "wall cupboard",
    like="cabinet",
    width=length(0.5, 1.2),
    height=length(0.35, 0.8),
    depth=length(0.25, 0.4),
    rows=whole(1, 2, words="flap, door"),
)
def wall_cupboard(b: ObjectBuilder, width: float, height: float, depth: float, rows: int) -> None:
    """Flaps that go up, or doors, on a wall unit."""
    case(b, "unit", lower=(-width / 2, 0, 0), upper=(width / 2, depth, height), opening=-Y, wall=0.018)
    for k, z in enumerate(spread(rows, 0, height)):
        if rows == 2:
            b.part("unit", slab(width / 2, (0, depth), (height / 2 - 0.009, height / 2 + 0.009)))
        leaf(
            b,
            f"flap_{k}",
            parent="unit",
            lower=(-width / 2, -0.018, z - height / 2 / rows + 0.002),
            upper=(width / 2, 0, z + height / 2 / rows - 0.002),
            hinge=Z,
            out=-Y,
            reach=b.draw(1.2, 1.8),
        )


@kind(
    "kitchen block",
    like="cabinet",
    number=whole(2, 4, words="door"),
)
def kitchen_block(b: ObjectBuilder, number: int) -> None:
    """A row of base units: doors, drawers, a sink front that tilts."""
    h = 0.87
    t = 0.58
    case(b, "block", lower=(0, 0, 0), upper=(0.6 * number, t, h), opening=-Y, wall=0.02)
    b.part("block", box((-0.01, -0.03, h), (0.6 * number + 0.01, t, h + 0.04)))
    for k, x in enumerate(spread(number, 0, 0.6 * number)):
        if k:
            b.part("block", box((x - 0.31, 0, 0), (x - 0.29, t, h)))
        kind = b.pick("door", "drawers", "tilt")
        low = x - 0.28
        high = x + 0.28
        if kind == "drawers":
            b.part("block", box((low - 0.01, 0.01, 0.1), (high + 0.01, t, h)))
            for i, z in enumerate(spread(3, 0.12, h - 0.02)):
                drawer(
                    b,
                    f"drawer_{k}_{i}",
                    parent="block",
                    lower=(low + 0.01, 0, z - 0.105),
                    upper=(high - 0.01, 0.5, z + 0.105),
                    out=-Y,
                    handle=True,
                )
        elif kind == "door":
            leaf(
                b,
                f"door_{k}",
                parent="block",
                lower=(low - 0.005, -0.018, 0.1),
                upper=(high + 0.005, 0, h - 0.02),
                hinge=b.pick(X, -X),
                out=-Y,
            )
        else:
            leaf(
                b,
                f"front_{k}",
                parent="block",
                lower=(low - 0.005, -0.018, 0.1),
                upper=(high + 0.005, 0, h - 0.02),
                hinge=-Z,
                out=-Y,
                reach=b.draw(0.4, 1.5),
            )


@kind(
    "medicine cabinet",
    like="cabinet",
    width=length(0.35, 0.8),
    height=length(0.5, 0.7),
)
def medicine_cabinet(b: ObjectBuilder, width: float, height: float) -> None:
    n = 2 if width > 0.55 else 1
    carcass(
        b,
        "cabinet",
        lower=(-width / 2, 0, 0),
        upper=(width / 2, 0.14, height),
        wall=0.015,
        shelves=(0.33 * height, 0.66 * height),
    )
    for k, x in enumerate(spread(n, -width / 2, width / 2)):
        leaf(
            b,
            f"door_{k}",
            parent="cabinet",
            lower=(x - width / 2 / n, -0.016, 0),
            upper=(x + width / 2 / n, 0, height),
            hinge=X if k else -X,
            out=-Y,
            reach=1.8,
            material="mirror",
        )


@kind(
    "drawer box",
    like="cabinet",
    rows=whole(2, 4),
    columns=whole(1, 3),
)
def desk_organizer(b: ObjectBuilder, rows: int, columns: int) -> None:
    width = 0.1 * columns + 0.02
    height = 0.06 * rows + 0.01
    case(b, "body", lower=(-width / 2, 0, 0), upper=(width / 2, 0.16, height), material="plastic")
    for i, z in enumerate(spread(rows, 0.005, height - 0.005)):
        for k, x in enumerate(spread(columns, -width / 2 + 0.01, width / 2 - 0.01)):
            drawer(
                b,
                f"drawer_{i}_{k}",
                parent="body",
                lower=(x - 0.044, 0, z - 0.023),
                upper=(x + 0.044, 0.14, z + 0.023),
                out=-Y,
                material="plastic",
            )


@kind(
    "office drawer unit",
    like="tool_cart",
    width=length(0.35, 0.45),
    depth=length(0.5, 0.7),
    height=length(0.5, 0.65),
)
def office_drawer_unit(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A roll container."""
    foot = 0.07
    case(b, "unit", lower=(-width / 2, 0, foot), upper=(width / 2, depth, height), material="steel")
    n = b.count(2, 4)
    for k, z in enumerate(spread(n, foot + 0.02, height - 0.02)):
        b_ = 0.42 * (height - foot - 0.04) / n
        drawer(
            b,
            f"drawer_{k}",
            parent="unit",
            lower=(-0.44 * width, 0, z - b_),
            upper=(0.44 * width, 0.85 * depth, z + b_),
            out=-Y,
            material="steel",
        )
    for k, (x, y) in enumerate([(x, y) for x in (-0.4 * width, 0.4 * width) for y in (0.12 * depth, 0.88 * depth)]):
        caster(b, f"caster_{k}", parent="unit", top=(x, y, foot), high=foot)
