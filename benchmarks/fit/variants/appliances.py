"""Kitchen and household appliances as others model them."""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.kind import choice, kind, length, whole, yes
from kinematify.generate.library.mechanisms import button, case, knob
from kinematify.generate.library.panels import carcass, drawer, grip, leaf, rack, seam
from kinematify.generate.procedural.builder import spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, slab, vector

if TYPE_CHECKING:
    from kinematify.generate.procedural.builder import ObjectBuilder


@kind(
    "slab microwave",
    like="microwave",
    width=length(0.4, 0.65),
    depth=length(0.28, 0.45),
    height=length(0.22, 0.38),
    wall=length(0.01, 0.03),
    thick=length(0.015, 0.04),
)
def slab_microwave(b: ObjectBuilder, width: float, depth: float, height: float, wall: float, thick: float) -> None:
    """A box with a slab at its front, hung at a side or below, a panel beside it and a plate that turns."""
    panel = b.pick(0, b.draw(0.15, 0.3)) * width
    carcass(b, "body", lower=(-width / 2, 0, 0), upper=(width / 2, depth, height), wall=wall, material="steel")
    front = b.pick(0, -thick)
    if panel:
        b.part("body", box((width / 2 - panel, front, 0), (width / 2, depth, height)))
    for x in (-0.4 * width, 0.4 * width) if b.maybe() else ():
        b.part(
            "body",
            b.cylinder(0.015, (x, 0.1 * depth, -0.012), (x, 0.1 * depth, 0.01)),
            b.cylinder(0.015, (x, 0.9 * depth, -0.012), (x, 0.9 * depth, 0.01)),
        )
    leaf(
        b,
        "door",
        parent="body",
        lower=(-width / 2, -thick, 0),
        upper=(width / 2 - panel, 0, height),
        hinge=b.pick(-X, -X, -X, -Z),
        glazed=0.6,
        reach=b.draw(1.4, 2.2),
        material="steel",
    )
    if b.style.hollow and b.maybe(0.6):
        middle = -panel / 2
        r = 0.38 * min(width - panel - 2 * wall, depth - wall)
        z = wall + seam(b, 0.1, 0.01)
        b.part("plate", b.cylinder(r, (middle, 0.48 * depth, z), (middle, 0.48 * depth, z + 0.012)), look="glass")
        b.spin("plate", parent="body", axis=Z, pivot=(middle, 0.48 * depth, z))
    if panel:
        for k, z in enumerate(spread(b.count(0, 3), 0.1 * height, 0.9 * height)):
            at = (width / 2 - panel / 2, front, z)
            if b.maybe():
                knob(
                    b,
                    f"knob_{k}",
                    parent="body",
                    at=at,
                    radius=0.25 * panel,
                    high=0.015,
                    out=-Y,
                    reach=b.pick(None, 4.7),
                )
            else:
                button(b, f"button_{k}", parent="body", at=at, size=(0.5 * panel, 0.06 * height), high=0.006, out=-Y)


@kind(
    "slab oven",
    like="oven",
    width=length(0.45, 0.8),
    depth=length(0.45, 0.65),
    chamber=length(0.3, 0.5),
    number=whole(1, 2, words="door, oven"),
    top=length(0.08, 0.15),
    wall=length(0.02, 0.05),
    thick=length(0.02, 0.05),
)
def slab_oven(
    b: ObjectBuilder, width: float, depth: float, chamber: float, number: int, top: float, wall: float, thick: float
) -> None:
    """One or two chambers with flaps that fall down or doors at a side, racks on ledges, a row of knobs."""
    foot = b.pick(0, 0.1)
    h = foot + number * chamber + top
    carcass(
        b,
        "body",
        lower=(-width / 2, 0, foot),
        upper=(width / 2, depth, h),
        wall=wall,
        shelves=[foot + k * chamber for k in range(1, number + 1)],
        material="steel",
    )
    front = b.pick(0, -thick)
    b.part("body", slab(width / 2, (front, depth), (h - top, h)))
    if foot:
        b.part("body", slab(width / 2 - 0.02, (0.05, depth), (0, foot + 0.01)))
    hinge = b.pick(-Z, -Z, -Z, X, -X)
    for k in range(number):
        low = foot + k * chamber
        leaf(
            b,
            f"door_{k}",
            parent="body",
            lower=(-width / 2, -thick, low),
            upper=(width / 2, 0, low + chamber),
            hinge=hinge,
            glazed=0.5,
            reach=b.draw(1.4, 1.6) if hinge[2] else b.draw(1.5, 2.2),
            material="steel",
        )
        for i in range(b.count(0, 2) if b.style.hollow else 0):
            z = low + (0.3 + 0.35 * i) * chamber
            rack(
                b,
                f"rack_{k}_{i}",
                parent="body",
                lower=(-width / 2 + wall, 0.02, z),
                upper=(width / 2 - wall, depth - wall, z + 0.03),
            )
    for k, x in enumerate(spread(b.count(2, 5), -0.45 * width, 0.45 * width)):
        knob(
            b,
            f"knob_{k}",
            parent="body",
            at=(x, front, h - top / 2),
            radius=0.25 * top,
            high=b.draw(0.012, 0.03),
            out=-Y,
            reach=b.pick(None, None, 4.7),
        )
    if b.maybe(0.3):
        b.part(
            "body",
            [
                b.cylinder(0.07, (x, y, h - 0.005), (x, y, h + 0.006))
                for x in (-0.25 * width, 0.25 * width)
                for y in (0.25 * depth, 0.75 * depth)
            ],
        )


@kind(
    "slab fridge",
    like="fridge",
    width=length(0.5, 0.95),
    depth=length(0.5, 0.75),
    height=length(0.8, 2.0),
    thick=length(0.03, 0.09),
    wall=length(0.03, 0.06),
    kind=choice(("one", "one", "side by side", "drawers below")),
)
def slab_fridge(
    b: ObjectBuilder, width: float, depth: float, height: float, thick: float, wall: float, kind: str
) -> None:
    """A tall body with slabs: one, one above the other, two side by side, drawers below."""
    level = b.pick(0, b.draw(0.25, 0.4), b.draw(0.6, 0.75)) * height
    level = level or 0.35 * height if kind == "drawers below" else level
    carcass(
        b,
        "body",
        lower=(-width / 2, 0, 0),
        upper=(width / 2, depth, height),
        wall=wall,
        shelves=[level] if level else [],
        uprights=[0] if kind == "side by side" else [],
        material="plastic",
    )
    side = b.pick(X, -X)
    rows = [(0, level), (level, height)] if level else [(0, height)]
    for k, (a, b_) in enumerate(rows):
        if kind == "drawers below" and k == 0:
            n = b.count(1, 2)
            for i, z in enumerate(spread(n, a, b_)):
                half = (b_ - a) / 2 / n
                drawer(
                    b,
                    f"drawer_{i}",
                    parent="body",
                    lower=(-width / 2 + wall, 0, z - half + 0.01 + wall),
                    upper=(width / 2 - wall, 0.8 * depth, z + half - 0.01 - wall),
                    lap=0.9 * wall,
                    front=thick,
                )
        elif kind == "side by side" and k == len(rows) - 1:
            for i, (hinge, c, e) in enumerate(((-X, -width / 2, 0), (X, 0, width / 2))):
                leaf(
                    b,
                    f"door_{k}_{i}",
                    parent="body",
                    lower=(c, -thick, a),
                    upper=(e, 0, b_),
                    hinge=hinge,
                    glazed=0.1,
                    material="plastic",
                    reach=b.draw(1.5, 2.3),
                )
        else:
            leaf(
                b,
                f"door_{k}",
                parent="body",
                lower=(-width / 2, -thick, a),
                upper=(width / 2, 0, b_),
                hinge=side,
                glazed=0.1,
                material="plastic",
                reach=b.draw(1.5, 2.3),
            )
    if b.style.hollow and b.maybe(0.4) and (not level):
        for k, z in enumerate(spread(b.count(1, 2), 0.1 * height, 0.5 * height)):
            rack(
                b,
                f"shelf_{k}",
                parent="body",
                lower=(-width / 2 + wall, 0.03, z),
                upper=(width / 2 - wall, depth - wall, z + 0.06),
                travel=0.6,
            )


@kind(
    "slab dishwasher",
    like="dishwasher",
    depth=length(0.5, 0.6),
    height=length(0.6, 0.88),
    thick=length(0.02, 0.06),
    wall=length(0.01, 0.03),
)
def slab_dishwasher(b: ObjectBuilder, depth: float, height: float, thick: float, wall: float) -> None:
    """A box under a worktop with a slab that falls down, baskets, a strip with buttons above the slab or on it."""
    width = b.pick(0.45, 0.6)
    strip = b.pick(0, b.draw(0.08, 0.14))
    foot = b.pick(0, 0.1)
    carcass(b, "body", lower=(-width / 2, 0, foot), upper=(width / 2, depth, height), wall=wall, material="steel")
    if foot:
        b.part("body", slab(width / 2, (0.04, depth), (0, foot + 0.01)))
    if strip:
        b.part("body", slab(width / 2, (-thick, depth), (height - strip, height)))
        for k, x in enumerate(spread(b.count(1, 6), -0.4 * width, 0.4 * width)):
            button(
                b,
                f"button_{k}",
                parent="body",
                at=(x, -thick, height - strip / 2),
                size=(0.02, 0.015),
                high=0.005,
                out=-Y,
                is_round=b.maybe(),
            )
    leaf(
        b,
        "door",
        parent="body",
        lower=(-width / 2, -thick, foot),
        upper=(width / 2, 0, height - strip),
        hinge=-Z,
        glazed=0.0,
        material="steel",
        reach=b.draw(1.45, 1.6),
    )
    if b.style.hollow:
        for k, z in enumerate((foot + wall + 0.03, foot + 0.5 * (height - foot - strip))[: b.count(0, 2)]):
            rack(
                b,
                f"basket_{k}",
                parent="body",
                lower=(-width / 2 + wall, 0.02, z),
                upper=(width / 2 - wall, depth - 2 * wall, z + 0.12),
                travel=b.draw(0.6, 0.9),
            )


@kind(
    "round door washer",
    words="porthole washer",
    like="washing_machine",
    width=length(0.5, 0.7),
    depth=length(0.45, 0.65),
    height=length(0.75, 0.95),
    thick=length(0.02, 0.06),
)
def round_door_washer(b: ObjectBuilder, width: float, depth: float, height: float, thick: float) -> None:
    """A box with a round door before a drum, a dial, buttons, and a drawer for powder."""
    r = b.draw(0.26, 0.36) * width
    z = b.draw(0.45, 0.52) * height
    case(b, "housing", lower=(-width / 2, 0, 0), upper=(width / 2, depth, height), material="steel")
    if b.style.hollow:
        b.cut("housing", b.cylinder(0.85 * r, (0, -0.1, z), (0, 0.8 * depth, z)))
        if b.maybe():
            g = b.gap(r) + 0.004
            b.part("drum", b.cylinder(0.85 * r - g, (0, 0.06, z), (0, 0.8 * depth - g, z)), look="steel")
            b.cut("drum", b.cylinder(0.8 * r - g, (0, -0.1, z), (0, 0.78 * depth - g, z)))
            b.spin("drum", parent="housing", axis=Y, pivot=(0, 0.4 * depth, z))
    play = seam(b, r, thick)
    front = -play
    b.part(
        "door",
        b.tube(r, 0.7 * r, (0, front - thick, z), (0, front, z)),
        b.cylinder(0.75 * r, (0, front - b.draw(0.5, 1.3) * thick, z), (0, front - 0.1 * thick, z)),
    )
    side = b.pick(X, -X)
    if b.maybe(0.5):
        b.part(
            "door", box((0.8 * r * side[0], front - 0.7 * thick, z - 0.2 * r), (1.1 * r * side[0], front, z + 0.2 * r))
        )
        edge = 1.1 * r
    else:
        edge = b.pick(1, 1, 1.05) * r
    grip(
        b, "door", at=-0.86 * r * side + (front - thick) * Y + z * Z, out=-Y, along=Z, length=b.draw(0.2, 0.6) * 0.5 * r
    )
    b.hinge(
        "door",
        parent="housing",
        axis=np.cross(-Y, side),
        pivot=edge * side + (front - b.style.line * thick) * Y + z * Z,
        upper=b.draw(1.4, 2.6),
    )
    if b.maybe():
        drawer(
            b,
            "drawer",
            parent="housing",
            lower=(-0.47 * width, 0, 0.86 * height),
            upper=(-0.2 * width, 0.3, 0.97 * height),
            lap=b.pick(0, 0.006),
        )
        if b.style.has_bore:
            b.cut("housing", box((-0.47 * width, -0.001, 0.86 * height), (-0.2 * width, 0.3, 0.97 * height)))
    if b.maybe(0.8):
        knob(
            b,
            "dial",
            parent="housing",
            at=(0.05 * width, 0, 0.92 * height),
            radius=0.03,
            high=b.draw(0.015, 0.03),
            out=-Y,
            reach=b.pick(None, None, 5.5),
        )
    for k, x in enumerate(spread(b.count(0, 4), 0.15 * width, 0.47 * width)):
        button(
            b,
            f"button_{k}",
            parent="housing",
            at=(x, 0, 0.92 * height),
            size=(0.02, 0.015),
            high=0.006,
            out=-Y,
            is_round=b.maybe(),
        )


@kind(
    "lever toaster",
    like="toaster",
    number=whole(1, 2, words="lever"),
    width=length(0.22, 0.4),
    height=length(0.15, 0.22),
    end=yes(0.7),
)
def lever_toaster(b: ObjectBuilder, number: int, width: float, height: float, end: bool) -> None:
    """Slots, levers that go down at an end or the front, knobs, and a crumb tray."""
    t = b.draw(0.08, 0.14) * number
    case(b, "body", lower=(-width / 2, -t / 2, 0.01), upper=(width / 2, t / 2, height), material="steel")
    rows = spread(2 * number if b.maybe(0.7) else number, -t / 2, t / 2)
    for y in rows:
        b.cut("body", slab(0.4 * width, (y - 0.013, y + 0.013), (0.2 * height, height + 0.1)))
    out = X if end else -Y
    face = width / 2 if end else t / 2
    along = Y if end else X
    travel = b.draw(0.3, 0.55) * height
    z = b.draw(0.7, 0.85) * height
    for k, s in enumerate(spread(number, -t / 2, t / 2) if end else spread(number, -0.4 * width, 0.4 * width)):
        at = face * out + s * along + z * Z
        wide = b.draw(0.02, 0.045)
        deep = b.draw(0.015, 0.035)
        root = max(b.style.gap, 0.001) if b.maybe(0.4) or not b.style.has_bore else -0.02
        if root < 0:
            b.cut(
                "body",
                box(at - 0.03 * out - 0.005 * along - (travel + 0.01) * Z, at + 0.1 * out + 0.005 * along + 0.01 * Z),
            )
            b.part(f"lever_{k}", beam(0.006, 0.006, at + root * out, at + 0.01 * out, Z))
            root = 0.002
        elif not b.style.has_bore:
            root = b.pick(root, 0, -0.01)
        b.part(
            f"lever_{k}",
            box(at + root * out - wide / 2 * along - 0.006 * Z, at + deep * out + wide / 2 * along + 0.006 * Z),
        )
        b.slide(f"lever_{k}", parent="body", axis=-Z, upper=travel, ajar=b.maybe())
        if b.maybe():
            knob(
                b,
                f"knob_{k}",
                parent="body",
                at=face * out + (s + 0.03) * along + 0.25 * height * Z,
                radius=0.012,
                high=0.012,
                out=out,
                reach=b.pick(None, 4.7),
            )
    for k, s in enumerate(spread(b.count(0, 3), -0.3 * t, 0.3 * t) if end else ()):
        button(
            b,
            f"button_{k}",
            parent="body",
            at=(width / 2, s, 0.12 * height),
            size=(0.012, 0.008),
            high=0.004,
            out=X,
            is_round=b.maybe(),
        )
    if b.maybe(0.4):
        y = -t / 2 if end else t / 2
        s = -1 if end else 1
        b.bore("body", slab(0.35 * width, (y + s * 0.02, -0.85 * y), (0.012, 0.022)))
        g = b.gap(0.1)
        b.part(
            "crumb_tray",
            slab(0.35 * width - g, (y + s * 0.006, -0.8 * y - s * g), (0.0125 + g, 0.0215 - g)),
            slab(0.1 * width, (y + s * g, y + s * 0.015), (0.0125 + g, 0.0215 - g)),
        )
        b.cut("body", slab(0.35 * width, (y - s * 0.01, y + s * 0.025), (0.012, 0.022)))
        b.slide("crumb_tray", parent="body", axis=-Y if end else Y, upper=0.7 * t)


@kind("plain kettle", like="kettle", radius=length(0.06, 0.1), height=length(0.12, 0.24), high=length(0.01, 0.04))
def plain_kettle(b: ObjectBuilder, radius: float, height: float, high: float) -> None:
    """A jug on a base, a lid that lifts or is hinged, a handle and a spout that are one with it."""
    top = b.draw(0.6, 1) * radius
    b.part(
        "jug",
        b.cone(radius, top, 0.02, height),
        b.cone(0.4 * radius, 0.15 * radius, (0, -0.5 * radius, 0.5 * height), (0, -1.5 * radius, 0.95 * height)),
        look="steel",
    )
    b.part(
        "jug",
        beam(0.025, 0.02, (0, 0.8 * top, 0.93 * height), (0, 1.6 * radius, 0.9 * height)),
        beam(0.025, 0.02, (0, 1.6 * radius, 0.92 * height), (0, 1.6 * radius, 0.25 * height), Y),
        beam(0.025, 0.02, (0, 1.62 * radius, 0.26 * height), (0, 0.9 * radius, 0.22 * height)),
    )
    if b.style.hollow:
        b.cut("jug", b.cone(0.9 * radius, 0.88 * top, 0.03, height + 0.001))
    play = seam(b, radius, 0.01)
    z = height + play
    b.part(
        "lid",
        b.pick(b.cone(top, 0.6 * top, z, z + high), b.cylinder(0.95 * top, z, z + high)),
        b.pick(ball(0.012, (0, 0, z + high + 0.008)), b.cylinder(0.014, z, z + high + 0.02)),
    )
    if b.maybe():
        b.slide("lid", parent="jug", axis=Z, upper=b.draw(0.03, 0.15))
    else:
        b.hinge("lid", parent="jug", axis=-X, pivot=(0, b.pick(0.95, 1) * top, z), upper=b.draw(1, 1.7))
    if b.maybe(0.6):
        g = b.gap(radius)
        b.part("base", b.cylinder(1.05 * radius, 0, 0.02 - g))
        if b.maybe():
            b.spin("jug", parent="base", axis=Z, pivot=(0, 0, 0.02))
        else:
            b.slide("jug", parent="base", axis=Z, upper=b.draw(0.1, 0.3))


@kind(
    "plain coffee machine",
    like="coffee_machine",
    width=length(0.15, 0.3),
    depth=length(0.2, 0.35),
    height=length(0.28, 0.4),
    kind=choice(("lid", "lid", "lever", "none")),
)
def plain_coffee_machine(b: ObjectBuilder, width: float, depth: float, height: float, kind: str) -> None:
    """A tower over a tray: a lid, a lever or a knob, a tray that is drawn out, a jug that is taken away."""
    head = b.draw(0.28, 0.4) * height
    foot = b.draw(0.08, 0.14) * height
    back = 0.45 * depth
    b.part(
        "body",
        slab(width / 2, (back, depth), (0, height)),
        slab(width / 2, (0, depth), (height - head, height)),
        slab(width / 2, (0, depth), (0, foot)),
    )
    if kind == "lid":
        thick = b.draw(0.012, 0.03)
        leaf(
            b,
            "lid",
            parent="body",
            lower=(-width / 2, b.pick(0, back), height),
            upper=(width / 2, depth, height + thick),
            hinge=Y,
            out=Z,
            glazed=0.0,
            reach=b.draw(1.2, 1.7),
            material="plastic",
        )
    elif kind == "lever":
        side = b.pick(X, -X)
        x = 0.5 * width + b.gap(width) if b.style.has_bore else 0.5 * width
        at = x * side + 0.5 * depth * Y + (height - 0.4 * head) * Z
        b.part(
            "lever",
            b.cylinder(0.02, at, at + 0.015 * side),
            beam(
                0.015, 0.012, at + 0.008 * side, at + 0.008 * side - b.draw(0.3, 0.6) * depth * Y + 0.3 * head * Z, side
            ),
            look="metal",
        )
        b.hinge("lever", parent="body", axis=X, pivot=at, upper=b.draw(0.6, 1.4), ajar=False)
    if b.maybe(0.7):
        play = seam(b, width, 0.01)
        b.part("tray", slab(0.45 * width, (0.01, back - 0.01), (foot + play, foot + play + 0.015)))
        b.slide("tray", parent="body", axis=-Y, upper=b.draw(0.6, 0.95) * back)
    radius = min(0.3 * width, 0.4 * back)
    if b.maybe(0.6):
        z0 = foot + 0.018
        z1 = height - head - 0.02
        b.part(
            "jug",
            b.cylinder(radius, (0, 0.5 * back, z0), (0, 0.5 * back, z1)),
            beam(
                0.02,
                0.012,
                (0, 0.5 * back - 0.9 * radius, 0.8 * z1 + 0.2 * z0),
                (0, 0.5 * back - 1.6 * radius, 0.75 * z1 + 0.25 * z0),
            ),
            look="glass",
        )
        b.slide("jug", parent="body", axis=-Y, upper=b.draw(0.1, 0.25), ajar=False)
    for k, x in enumerate(spread(b.count(0, 3), -0.45 * width, 0.45 * width)):
        at = (x, 0, height - head / 2)
        if b.maybe():
            knob(
                b,
                f"knob_{k}",
                parent="body",
                at=at,
                radius=min(0.02, 0.1 * width),
                high=0.012,
                out=-Y,
                reach=b.pick(None, 3),
            )
        else:
            button(
                b,
                f"button_{k}",
                parent="body",
                at=at,
                size=(0.08 * width, 0.08 * width),
                high=0.005,
                out=-Y,
                is_round=b.maybe(),
            )


@kind(
    "slab safe",
    like="safe",
    width=length(0.25, 0.7),
    depth=length(0.25, 0.6),
    height=length(0.25, 1.2),
    wall=length(0.02, 0.06),
    thick=length(0.03, 0.08),
)
def slab_safe(b: ObjectBuilder, width: float, depth: float, height: float, wall: float, thick: float) -> None:
    """A thick box with a thick slab before it or let into it, a dial and a handle on the slab."""
    carcass(
        b,
        "body",
        lower=(-width / 2, 0, 0),
        upper=(width / 2, depth, height),
        wall=wall,
        shelves=[b.draw(0.4, 0.6) * height] if b.maybe(0.3) else [],
        material="steel",
    )
    side = b.pick(X, -X)
    inset = b.maybe(0.4) and b.style.hollow
    low, y = (wall, 0) if inset else (0, -thick)
    leaf(
        b,
        "door",
        parent="body",
        lower=(-width / 2 + low, y, low),
        upper=(width / 2 - low, y + thick, height - low),
        hinge=side,
        inset=inset,
        reach=b.draw(1.4, 2.4),
        handle=False,
        glazed=0.0,
        material="steel",
    )
    if inset and b.style.hollow:
        b.cut("body", slab(width / 2 - wall, (-0.001, thick), (wall, height - wall)))
    face = y - 0.35 * thick
    b.part("door", slab(0.12 * width, (face, y + 0.2 * thick), (0.35 * height, 0.65 * height)))
    if b.maybe(0.7):
        knob(
            b,
            "dial",
            parent="door",
            at=(0, face, 0.58 * height),
            radius=b.draw(0.06, 0.1) * width,
            high=b.draw(0.015, 0.035),
            out=-Y,
            reach=b.pick(None, None, 3),
        )
    if b.maybe(0.6):
        at = vector(0, face, 0.42 * height)
        r = 0.1 * width
        n = b.pick(1, 2, 3, 4)
        deep = b.draw(0.02, 0.04)
        foot = -seam(b, r, 0.01)
        b.part("handle", b.cylinder(0.3 * r, at + foot * Y, at - deep * Y), look="metal")
        for a in np.arange(n) * 2 * pi / n + b.pick(0, 0.5):
            tip = at - 0.8 * deep * Y + r * (cos(a) * X + sin(a) * Z)
            b.part("handle", b.cylinder(0.12 * r, at - 0.8 * deep * Y, tip))
        if b.maybe():
            b.spin("handle", parent="door", axis=-Y, pivot=at)
        else:
            b.hinge("handle", parent="door", axis=-Y, pivot=at, upper=b.draw(0.8, 1.6), ajar=False)
