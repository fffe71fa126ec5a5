"""Furniture and what stands in rooms."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import case, caster, drawer, grip, leaf, legs, lever, wheel
from benchmarks.recipes.object_builder import spread
from benchmarks.recipes.shapes import X, Y, Z, beam, box, rod

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def wardrobe(d: ObjectBuilder) -> None:
    """Two or three tall doors, now and then two drawers below."""
    w, t, h, foot = d.u(0.8, 1.8), d.u(0.4, 0.65), d.u(1.7, 2.3), d.pick(0.0, 0.35)
    case(d, "carcass", (-w / 2, 0, 0), (w / 2, t, h), opening=-Y, wall=0.02)
    if foot:
        d.part("carcass", box((-w / 2, 0, foot), (w / 2, t, foot + 0.02)))
        for k, x in enumerate(spread(2, -w / 2, w / 2)):
            drawer(d, f"drawer_{k}", "carcass", (x - w / 4 + 0.03, 0, 0.04), (x + w / 4 - 0.03, 0.8 * t, foot - 0.03),
                out=-Y)
    n = d.n(1, 3)
    for k, x in enumerate(spread(n, -w / 2, w / 2)):
        side = X if k % 2 else -X
        leaf(d, f"door_{k}", "carcass", (x - w / 2 / n, -0.02, foot + 0.01), (x + w / 2 / n, 0, h), hinge=side, out=-Y,
            reach=d.u(1.4, 2.4))


def chest_of_drawers(d: ObjectBuilder) -> None:
    """Rows of drawers."""
    w, t, h, n = d.u(0.4, 1.2), d.u(0.35, 0.55), d.u(0.5, 1.3), d.n(2, 6)
    case(d, "chest", (-w / 2, 0, 0), (w / 2, t, h))
    columns = d.n(1, 2)
    for i, z in enumerate(spread(n, 0.03, h - 0.03)):
        for k, x in enumerate(spread(columns, -w / 2, w / 2)):
            a, b = 0.46 * w / columns, 0.42 * (h - 0.06) / n
            drawer(d, f"drawer_{i}_{k}", "chest", (x - a, 0, z - b), (x + a, d.u(0.7, 0.9) * t, z + b), out=-Y)


def nightstand(d: ObjectBuilder) -> None:
    """On legs, a drawer over a shelf or a door."""
    w, h, leg = d.u(0.35, 0.6), d.u(0.4, 0.7), d.u(0.05, 0.2)
    case(d, "stand", (-w / 2, 0, leg), (w / 2, 0.8 * w, h), opening=-Y, wall=0.018)
    legs(d, "stand", (-w / 2, 0, 0), (w / 2, 0.8 * w, leg + 0.005), 0.04)
    level = leg + d.u(0.5, 0.65) * (h - leg)
    d.part("stand", box((-w / 2, 0, level - 0.015), (w / 2, 0.8 * w, level)))
    d.part("stand", box((-w / 2 + 0.005, 0.02, level), (w / 2 - 0.005, 0.8 * w, h - 0.005)))
    drawer(d, "drawer", "stand", (-0.45 * w, 0, level + 0.01), (0.45 * w, 0.6 * w, h - 0.03), out=-Y)
    if d.maybe():
        leaf(d, "door", "stand", (-w / 2, -0.018, leg), (w / 2, 0, level - 0.005), hinge=d.pick(X, -X), out=-Y)


def kitchen_block(d: ObjectBuilder) -> None:
    """A row of base units: doors, drawers, a sink front that tilts."""
    n, h, t = d.n(2, 4), 0.87, 0.58
    case(d, "block", (0, 0, 0), (0.6 * n, t, h), opening=-Y, wall=0.02)
    d.part("block", box((-0.01, -0.03, h), (0.6 * n + 0.01, t, h + 0.04)))
    for k, x in enumerate(spread(n, 0, 0.6 * n)):
        if k:
            d.part("block", box((x - 0.31, 0.0, 0), (x - 0.29, t, h)))
        kind = d.pick("door", "drawers", "tilt")
        low, high = x - 0.28, x + 0.28
        if kind == "drawers":
            d.part("block", box((low - 0.01, 0.01, 0.1), (high + 0.01, t, h)))
            for i, z in enumerate(spread(3, 0.12, h - 0.02)):
                drawer(d, f"drawer_{k}_{i}", "block", (low + 0.01, 0, z - 0.105), (high - 0.01, 0.5, z + 0.105), out=-Y,
                    handle=True)
        elif kind == "door":
            leaf(d, f"door_{k}", "block", (low - 0.005, -0.018, 0.1), (high + 0.005, 0, h - 0.02), hinge=d.pick(X, -X),
                out=-Y)
        else:
            leaf(d, f"front_{k}", "block", (low - 0.005, -0.018, 0.1), (high + 0.005, 0, h - 0.02), hinge=-Z, out=-Y,
                reach=d.u(0.4, 1.5))


def wall_cupboard(d: ObjectBuilder) -> None:
    """Flaps that go up, or doors, on a wall unit."""
    w, h, t = d.u(0.5, 1.2), d.u(0.35, 0.8), d.u(0.25, 0.4)
    case(d, "unit", (-w / 2, 0, 0), (w / 2, t, h), opening=-Y, wall=0.018)
    rows = d.n(1, 2)
    for k, z in enumerate(spread(rows, 0, h)):
        if rows == 2:
            d.part("unit", box((-w / 2, 0.0, h / 2 - 0.009), (w / 2, t, h / 2 + 0.009)))
        leaf(d, f"flap_{k}", "unit", (-w / 2, -0.018, z - h / 2 / rows + 0.002), (w / 2, 0, z + h / 2 / rows - 0.002),
            hinge=Z, out=-Y, reach=d.u(1.2, 1.8))


def sideboard_with_sliding_doors(d: ObjectBuilder) -> None:
    """Two panels that pass each other before a case."""
    w, h, t = d.u(1.0, 2.0), d.u(0.5, 0.9), d.u(0.35, 0.5)
    case(d, "case", (-w / 2, 0, 0.1), (w / 2, t, h), opening=-Y, wall=0.02)
    legs(d, "case", (-w / 2, 0, 0), (w / 2, t, 0.105), 0.05)
    d.part("case", box((-w / 2, -0.06, 0.1), (w / 2, 0.01, 0.12)), box((-w / 2, -0.06, h - 0.02), (w / 2, 0.01, h)))
    gap = d.gap(0.02)
    for k, s in enumerate((-1.0, 1.0)):
        y = -0.022 - 0.022 * k
        d.part(f"door_{k}", box((min(0, s * w / 2) - 0.03 * (s > 0), y - 0.018, 0.12 + gap), (max(0,
            s * w / 2) + 0.03 * (s < 0), y, h - 0.02 - gap)))
        if d.hand.grips != "none":
            d.part(f"door_{k}", rod(0.03, (0.85 * s * w / 2, y - 0.0181 - (0.002 if k else 0), h / 2),
                (0.85 * s * w / 2, y, h / 2)))
        d.slide(f"door_{k}", "case", -s * X, w / 2 - 0.04)


def desk_with_pedestal(d: ObjectBuilder) -> None:
    """A desk with three drawers on one side and a keyboard tray."""
    w, t, h = d.u(1.1, 1.8), d.u(0.55, 0.8), d.u(0.7, 0.78)
    p = d.u(0.35, 0.5)
    d.part("desk", box((-w / 2, 0, h - 0.03), (w / 2, t, h)), box((w / 2 - 0.03, 0, 0), (w / 2, t, h)), material="wood")
    d.part("desk", box((-w / 2, 0.02, 0), (-w / 2 + p, t, h - 0.02)))
    for k, z in enumerate(spread(3, 0.05, h - 0.04)):
        drawer(d, f"drawer_{k}", "desk", (-w / 2 + 0.03, 0.02, z - 0.09), (-w / 2 + p - 0.03, t - 0.08, z + 0.09),
            out=-Y)
    if d.maybe(0.6):
        g = d.gap(0.02)
        x0, x1 = -w / 2 + p + 0.1, w / 2 - 0.1
        for x in (x0 - 0.015, x1 + 0.015):
            d.part("desk", box((x - 0.015 + g, 0.05, h - 0.1), (x + 0.015 - g, t - 0.1, h - 0.025)))
        d.part("tray", box((x0, 0.03, h - 0.1), (x1, 0.4, h - 0.08)))
        d.slide("tray", "desk", -Y, 0.3)


def standing_desk(d: ObjectBuilder) -> None:
    """A top on two or one telescopic columns."""
    w, t, h = d.u(1.0, 1.8), d.u(0.6, 0.8), d.u(0.6, 0.75)
    g = d.gap(0.06)
    for x in (-0.35 * w, 0.35 * w):
        d.part("feet", box((x - 0.04, -t / 2 + 0.05, 0), (x + 0.04, t / 2 - 0.05, 0.03)), box((x - 0.04, -0.04, 0.02),
            (x + 0.04, 0.04, 0.55)), material="steel")
        d.bore("feet", box((x - 0.03 - g, -0.03 - g, 0.05), (x + 0.03 + g, 0.03 + g, 0.6)))
        d.part("top", box((x - 0.03, -0.03, 0.1 if d.hand.has_bore else 0.54), (x + 0.03, 0.03, h)))
    d.part("feet", box((-0.35 * w, -0.02, 0.03), (0.35 * w, 0.02, 0.1)))
    d.part("top", box((-w / 2, -t / 2, h), (w / 2, t / 2, h + 0.025)), material="wood")
    d.slide("top", "feet", Z, d.u(0.3, 0.5))


def gateleg_table(d: ObjectBuilder) -> None:
    """Leaves that hang from a narrow middle, or lie level with it."""
    w, t, h, m = d.u(0.7, 1.1), d.u(0.8, 1.4), 0.74, d.u(0.2, 0.5)
    d.part("middle", box((-m / 2, -t / 2, h - 0.025), (m / 2, t / 2, h)), material="wood")
    legs(d, "middle", (-m / 2, -t / 2 + 0.05, 0), (m / 2, t / 2 - 0.05, h - 0.02), 0.05)
    for k, s in enumerate((-1.0, 1.0)):
        leaf(d, f"leaf_{k}", "middle", (s * m / 2, -t / 2, h - 0.025), (s * (m / 2 + w / 2), t / 2, h), hinge=-s * X,
            out=-Z, reach=d.u(1.3, 1.57), handle=False)


def piano_stool(d: ObjectBuilder) -> None:
    """A seat that turns on its screw."""
    r, h = d.u(0.15, 0.22), d.u(0.4, 0.6)
    d.part("base", rod(0.04, (0, 0, 0.1), (0, 0, h)), material="wood")
    for a in np.arange(n := d.n(3, 5)) * 2 * np.pi / n:
        d.part("base", beam(0.04, 0.04, (0, 0, 0.2), (1.2 * r * np.cos(a), 1.2 * r * np.sin(a), 0.02)))
    g = d.gap(r)
    d.part("seat", rod(r, (0, 0, h + g), (0, 0, h + d.u(0.03, 0.1))))
    if d.hand.has_bore:
        d.cut("base", rod(0.02 + 2 * g, (0, 0, 0.2), (0, 0, h + 0.01)))
        d.part("seat", rod(0.02, (0, 0, 0.22), (0, 0, h + 0.02)))
    d.spin("seat", "base", Z, (0, 0, h))


def recliner(d: ObjectBuilder) -> None:
    """A back that leans and a foot rest that comes up."""
    w, t, h = d.u(0.6, 0.9), d.u(0.5, 0.6), d.u(0.38, 0.48)
    d.part("seat", box((-w / 2, 0, 0.05), (w / 2, t, h)), material="wood")
    for s in (-1.0, 1.0):
        d.part("seat", box((s * w / 2, -0.02, 0.0), (s * (w / 2 + 0.12), t + 0.1, h + 0.2)))
    g = d.gap(0.2)
    d.part("back", box((-w / 2 + g, t + g, h - 0.15), (w / 2 - g, t + 0.15, h + d.u(0.5, 0.75))))
    d.hinge("back", "seat", -X, (0, t + d.hand.gap, h - 0.15), 0.6)
    d.part("rest", box((-w / 2 + g, -0.08, 0.08), (w / 2 - g, -g, h - 0.02)))
    d.hinge("rest", "seat", -X, (0, -0.08, h - 0.02), 1.3)
    if d.maybe():
        lever(d, "handle", "seat", ((w / 2 + 0.12), 0.3 * t, h), X, -Y, 0.15)


def folding_bed(d: ObjectBuilder) -> None:
    """A bed that folds down out of a wall case."""
    w, h = d.u(0.9, 1.6), d.u(2.0, 2.2)
    case(d, "case", (-w / 2 - 0.03, 0, 0), (w / 2 + 0.03, 0.4, h + 0.05), opening=-Y, wall=0.025)
    g = d.gap(0.2)
    d.part("bed", box((-w / 2 + g, -0.02, 0.35), (w / 2 - g, 0.0 if not d.hand.hollow else 0.25, h)), material="wood")
    d.hinge("bed", "case", X, (0, 0 if d.hand.line else 0.1, 0.36 if d.hand.line else 0.4), 1.57)


def trundle_bed(d: ObjectBuilder) -> None:
    """A second bed on wheels, or a bed box, below the first."""
    w, t, h = d.u(0.8, 1.2), 2.0, 0.45
    d.part("bed", box((0, 0, 0.3), (t, w, h)), box((0, 0, 0), (0.03, w, 0.9)), box((t - 0.03, 0, 0), (t, w, 0.7)),
        material="wood")
    n = d.n(1, 2)
    for k, x in enumerate(spread(n, 0.04, t - 0.04)):
        half = (t - 0.1) / 2 / n
        g = d.gap(0.1) + 0.002
        d.part(f"box_{k}", box((x - half, -0.01, 0.04), (x + half, 0.85 * w, 0.27)), material="wood")
        if d.hand.drawer == "tray":
            d.cut(f"box_{k}", box((x - half + 0.02, 0.01, 0.06), (x + half - 0.02, 0.85 * w - 0.02, 0.4)))
        d.part("bed", box((x - half, 0.85 * w + g, 0.1), (x + half, 0.85 * w + g + 0.02, 0.31)))
        d.slide(f"box_{k}", "bed", -Y, 0.6)


def crib(d: ObjectBuilder) -> None:
    """A cot with a side that slides down or swings out."""
    w, t, h = d.u(1.1, 1.4), d.u(0.6, 0.75), d.u(0.8, 1.0)
    d.part("cot", box((0, 0, 0.25), (w, t, 0.3)), material="wood")
    for x in (0, w):
        d.part("cot", box((x - 0.02, 0, 0), (x + 0.02, t, h)))
    d.part("cot", box((0, t - 0.03, 0.25), (w, t, h)))
    g = d.gap(0.05)
    bars = [rod(0.008, (x, -0.025, 0.32), (x, -0.025, h)) for x in spread(d.n(8, 16), 0.04, w - 0.04)]
    rails = [box((0.021 + g, -0.045, z), (w - 0.021 - g, -0.005, z + 0.04)) for z in (0.3, h - 0.04)]
    d.part("side", *bars, *rails)
    if d.maybe():
        d.slide("side", "cot", -Z, 0.25)
    else:
        d.hinge("side", "cot", X, (w / 2, -0.025, 0.31), 1.5)


def rocking_cradle(d: ObjectBuilder) -> None:
    """A cradle that swings between two posts."""
    w, r, h = d.u(0.7, 1.0), d.u(0.2, 0.3), d.u(0.7, 1.0)
    for s in (-1.0, 1.0):
        x = s * (w / 2 + 0.05)
        d.part("stand", beam(0.04, 0.04, (x, -0.3, 0), (x, 0, h), X), beam(0.04, 0.04, (x, 0.3, 0), (x, 0, h), X),
            material="wood")
    d.part("stand", beam(0.04, 0.04, (-w / 2 - 0.05, 0, 0.15), (w / 2 + 0.05, 0, 0.15)), beam(0.04, 0.04,
        (-w / 2 - 0.05, -0.15, h / 2), (-w / 2 - 0.05, 0.15, h / 2)))
    d.part("stand", beam(0.04, 0.04, (w / 2 + 0.05, -0.15, h / 2), (w / 2 + 0.05, 0.15, h / 2)))
    g = d.gap(0.05)
    top = h - 0.05
    d.part("cradle", box((-w / 2 + 0.01 + g, -r, top - 0.35), (w / 2 - 0.01 - g, r, top - 0.05)), material="wood")
    d.cut("cradle", box((-w / 2 + 0.03, -r + 0.02, top - 0.33), (w / 2 - 0.03, r - 0.02, top)))
    for s in (-1.0, 1.0):
        x = s * (w / 2 - 0.02 - g)
        d.part("cradle", beam(0.02, 0.06, (x, 0, top - 0.2), (x, 0, top + 0.02), Y))
        if d.hand.barrels:
            d.part("cradle", rod(0.012, (x, 0, top), (s * (w / 2 + 0.06), 0, top)))
    d.hinge("cradle", "stand", X, (0, 0, top), 0.4, -0.4, initial_opening=False)


def mirror_on_stand(d: ObjectBuilder) -> None:
    """A mirror that tilts between two posts or in a fork."""
    w, h = d.u(0.2, 0.7), d.u(0.3, 1.6)
    g = d.gap(0.04) + 0.001
    d.part("stand", box((-w / 2 - 0.05, -0.15, 0), (w / 2 + 0.05, 0.15, 0.03)), material="wood")
    for s in (-1.0, 1.0):
        d.part("stand", rod(0.018, (s * (w / 2 + 0.02 + g), 0, 0), (s * (w / 2 + 0.02 + g), 0, 0.1 + 0.6 * h)))
    z = 0.08 + 0.5 * h
    glass = (rod(w / 2, (0, -0.01, z), (0, 0.01, z)) if h < 1.1 * w else box((-w / 2, -0.01, 0.08), (w / 2, 0.01,
        0.08 + h)))
    d.part("mirror", glass, material="glass")
    if d.hand.barrels or d.hand.has_bore:
        d.part(d.pick("mirror", "stand"), rod(0.006, (-w / 2 - 0.02, 0, z), (-w / 2 + 0.001, 0, z)), rod(0.006,
            (w / 2 - 0.001, 0, z), (w / 2 + 0.02, 0, z)))
    d.hinge("mirror", "stand", X, (0, 0, z), 0.5, -0.5)


def bar_cart(d: ObjectBuilder) -> None:
    """Two trays on a frame with four wheels or casters, and a drawer."""
    w, t, h = d.u(0.5, 0.9), d.u(0.35, 0.5), d.u(0.7, 0.95)
    foot = 0.1
    legs(d, "frame", (-w / 2, -t / 2, foot), (w / 2, t / 2, h), 0.03)
    for z in (foot + 0.02, 0.55 * h, h - 0.05):
        d.part("frame", box((-w / 2, -t / 2, z), (w / 2, t / 2, z + 0.03)), material="steel")
    corners = [(x, y) for x in (-w / 2 + 0.015, w / 2 - 0.015) for y in (-t / 2 + 0.015, t / 2 - 0.015)]
    kind = d.pick("casters", "wheels")
    for k, (x, y) in enumerate(corners):
        if kind == "casters":
            caster(d, f"caster_{k}", "frame", (x, y, foot), foot)
        else:
            s = np.sign(y)
            wheel(d, f"wheel_{k}", "frame", (x, y + s * 0.03, 0.06), 0.06, 0.025, s * Y, axle=0.012)
            d.part("frame", box((x - 0.015, y - 0.012, 0.05), (x + 0.015, y + 0.012, foot + 0.01)))


def office_drawer_unit(d: ObjectBuilder) -> None:
    """A roll container."""
    w, t, h, foot = d.u(0.35, 0.45), d.u(0.5, 0.7), d.u(0.5, 0.65), 0.07
    case(d, "unit", (-w / 2, 0, foot), (w / 2, t, h), material="steel")
    for k, z in enumerate(spread(n := d.n(2, 4), foot + 0.02, h - 0.02)):
        b = 0.42 * (h - foot - 0.04) / n
        drawer(d, f"drawer_{k}", "unit", (-0.44 * w, 0, z - b), (0.44 * w, 0.85 * t, z + b), out=-Y, material="steel")
    for k, (x, y) in enumerate([(x, y) for x in (-0.4 * w, 0.4 * w) for y in (0.12 * t, 0.88 * t)]):
        caster(d, f"caster_{k}", "unit", (x, y, foot), foot)


def swivel_bookcase(d: ObjectBuilder) -> None:
    """A square bookcase that turns on its foot."""
    w, h, foot = d.u(0.35, 0.5), d.u(0.6, 1.4), d.u(0.04, 0.1)
    d.part("foot", rod(0.45 * w, (0, 0, 0), (0, 0, foot)), material="wood")
    g = d.gap(w)
    d.part("case", box((-w / 2, -w / 2, foot + g), (w / 2, w / 2, h)), material="wood")
    for z in spread(3, foot, h):
        d.cut("case", box((-w / 2 - 1, -w / 2 + 0.02, z - 0.12 * h), (-0.02, w / 2 - 0.02, z + 0.12 * h)))
    d.spin("case", "foot", Z, (0, 0, foot))


def roller_shutter_cabinet(d: ObjectBuilder) -> None:
    """A shutter of slats drawn as one plate that slides up or aside."""
    w, h, t = d.u(0.6, 1.2), d.u(0.6, 1.8), 0.4
    case(d, "cabinet", (-w / 2, 0, 0), (w / 2, t, h), opening=-Y, wall=0.03)
    g = d.gap(0.02)
    z0, z1 = 0.03 + g, h * d.u(0.45, 0.95)
    d.part("shutter", box((-w / 2 + 0.005 + g, -0.015 - g, z0), (w / 2 - 0.005 - g, -g, z1)))
    for z in spread(int((z1 - z0) / 0.05), z0, z1):
        d.part("shutter", rod(0.008, (-w / 2 + 0.01, -0.015 - g, z), (w / 2 - 0.01, -0.015 - g, z)))
    grip(d, "shutter", (0, -0.015 - g, z0 + 0.06), -Y, X, 0.12)
    d.slide("shutter", "cabinet", Z, 0.7 * (z1 - z0))
