"""Kitchen and laundry machines as boxes with slabs before them, trays in them and knobs on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import button, case, knob
from benchmarks.recipes.object_builder import spread
from benchmarks.recipes.panels import box_drawer, carcass, pull, rack, seam, slab
from benchmarks.recipes.shapes import X, Y, Z, ball, beam, box, cone, rod, tube

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def slab_microwave(d: ObjectBuilder) -> None:
    """A box with a slab at its front, hung at a side or below, a panel beside it and a plate that turns."""
    w, t, h = d.u(0.4, 0.65), d.u(0.28, 0.45), d.u(0.22, 0.38)
    panel, wall, thick = d.pick(0.0, d.u(0.15, 0.3)) * w, d.u(0.01, 0.03), d.u(0.015, 0.04)
    carcass(d, "body", (-w / 2, 0, 0), (w / 2, t, h), wall, material="steel")
    front = d.pick(0.0, -thick)
    if panel:
        d.part("body", box((w / 2 - panel, front, 0), (w / 2, t, h)))
    for x in (-0.4 * w, 0.4 * w) if d.maybe() else ():
        d.part("body", rod(0.015, (x, 0.1 * t, -0.012), (x, 0.1 * t, 0.01)), rod(0.015, (x, 0.9 * t, -0.012), (x,
            0.9 * t, 0.01)))
    slab(d, "door", "body", (-w / 2, -thick, 0), (w / 2 - panel, 0, h), hinge=d.pick(-X, -X, -X, -Z), glazed=0.6,
        reach=d.u(1.4, 2.2), material="steel")
    if d.hand.hollow and d.maybe(0.6):
        middle, r = -panel / 2, 0.38 * min(w - panel - 2 * wall, t - wall)
        z = wall + seam(d, 0.1, 0.01)
        d.part("plate", rod(r, (middle, 0.48 * t, z), (middle, 0.48 * t, z + 0.012)), material="glass")
        d.spin("plate", "body", Z, (middle, 0.48 * t, z))
    if panel:
        for k, z in enumerate(spread(d.n(0, 3), 0.1 * h, 0.9 * h)):
            at = (w / 2 - panel / 2, front, z)
            if d.maybe():
                knob(d, f"knob_{k}", "body", at, 0.25 * panel, 0.015, -Y, reach=d.pick(None, 4.7))
            else:
                button(d, f"button_{k}", "body", at, (0.5 * panel, 0.06 * h), 0.006, -Y)


def slab_oven(d: ObjectBuilder) -> None:
    """One or two chambers with flaps that fall down or doors at a side, racks on ledges, a row of knobs."""
    w, t, chamber = d.u(0.45, 0.8), d.u(0.45, 0.65), d.u(0.3, 0.5)
    n, top, foot, wall, thick = d.n(1, 2), d.u(0.08, 0.15), d.pick(0.0, 0.1), d.u(0.02, 0.05), d.u(0.02, 0.05)
    h = foot + n * chamber + top
    carcass(d, "body", (-w / 2, 0, foot), (w / 2, t, h), wall, shelves=[foot + k * chamber for k in range(1, n + 1)],
        material="steel")
    front = d.pick(0.0, -thick)
    d.part("body", box((-w / 2, front, h - top), (w / 2, t, h)))
    if foot:
        d.part("body", box((-w / 2 + 0.02, 0.05, 0), (w / 2 - 0.02, t, foot + 0.01)))
    hinge = d.pick(-Z, -Z, -Z, X, -X)
    for k in range(n):
        low = foot + k * chamber
        slab(d, f"door_{k}", "body", (-w / 2, -thick, low), (w / 2, 0, low + chamber), hinge=hinge, glazed=0.5,
            reach=d.u(1.4, 1.6) if hinge[2] else d.u(1.5, 2.2), material="steel")
        for i in range(d.n(0, 2) if d.hand.hollow else 0):
            z = low + (0.3 + 0.35 * i) * chamber
            rack(d, f"rack_{k}_{i}", "body", (-w / 2 + wall, 0.02, z), (w / 2 - wall, t - wall, z + 0.03))
    for k, x in enumerate(spread(d.n(2, 5), -0.45 * w, 0.45 * w)):
        knob(d, f"knob_{k}", "body", (x, front, h - top / 2), 0.25 * top, d.u(0.012, 0.03), -Y,
            reach=d.pick(None, None, 4.7))
    if d.maybe(0.3):
        d.part("body", *(rod(0.07, (x, y, h - 0.005), (x, y, h + 0.006)) for x in (-0.25 * w, 0.25 * w)
            for y in (0.25 * t, 0.75 * t)))


def slab_fridge(d: ObjectBuilder) -> None:
    """A tall body with slabs: one, one above the other, two side by side, drawers below."""
    w, t, h, thick = d.u(0.5, 0.95), d.u(0.5, 0.75), d.u(0.8, 2.0), d.u(0.03, 0.09)
    wall = d.u(0.03, 0.06)
    level = d.pick(0.0, d.u(0.25, 0.4), d.u(0.6, 0.75)) * h
    kind = d.pick("one", "one", "side by side", "drawers below")
    level = level or 0.35 * h if kind == "drawers below" else level
    carcass(d, "body", (-w / 2, 0, 0), (w / 2, t, h), wall, shelves=[level] if level else [],
        uprights=[0.0] if kind == "side by side" else [], material="plastic")
    side = d.pick(X, -X)
    rows = [(0.0, level), (level, h)] if level else [(0.0, h)]
    for k, (a, b) in enumerate(rows):
        if kind == "drawers below" and k == 0:
            n = d.n(1, 2)
            for i, z in enumerate(spread(n, a, b)):
                half = (b - a) / 2 / n
                box_drawer(d, f"drawer_{i}", "body", (-w / 2 + wall, 0, z - half + 0.01 + wall), (w / 2 - wall,
                    0.8 * t, z + half - 0.01 - wall), lap=0.9 * wall, front=thick)
        elif kind == "side by side" and k == len(rows) - 1:
            for i, (hinge, c, e) in enumerate(((-X, -w / 2, 0.0), (X, 0.0, w / 2))):
                slab(d, f"door_{k}_{i}", "body", (c, -thick, a), (e, 0, b), hinge=hinge, glazed=0.1, material="plastic",
                    reach=d.u(1.5, 2.3))
        else:
            slab(d, f"door_{k}", "body", (-w / 2, -thick, a), (w / 2, 0, b), hinge=side, glazed=0.1, material="plastic",
                reach=d.u(1.5, 2.3))
    if d.hand.hollow and d.maybe(0.4) and not level:
        for k, z in enumerate(spread(d.n(1, 2), 0.1 * h, 0.5 * h)):
            rack(d, f"shelf_{k}", "body", (-w / 2 + wall, 0.03, z), (w / 2 - wall, t - wall, z + 0.06), travel=0.6)


def slab_dishwasher(d: ObjectBuilder) -> None:
    """A box under a worktop with a slab that falls down, baskets, a strip with buttons above the slab or on it."""
    w, t, h, thick = d.pick(0.45, 0.6), d.u(0.5, 0.6), d.u(0.6, 0.88), d.u(0.02, 0.06)
    strip, foot, wall = d.pick(0.0, d.u(0.08, 0.14)), d.pick(0.0, 0.1), d.u(0.01, 0.03)
    carcass(d, "body", (-w / 2, 0, foot), (w / 2, t, h), wall, material="steel")
    if foot:
        d.part("body", box((-w / 2, 0.04, 0), (w / 2, t, foot + 0.01)))
    if strip:
        d.part("body", box((-w / 2, -thick, h - strip), (w / 2, t, h)))
        for k, x in enumerate(spread(d.n(1, 6), -0.4 * w, 0.4 * w)):
            button(d, f"button_{k}", "body", (x, -thick, h - strip / 2), (0.02, 0.015), 0.005, -Y, is_round=d.maybe())
    slab(d, "door", "body", (-w / 2, -thick, foot), (w / 2, 0, h - strip), hinge=-Z, glazed=0.0, material="steel",
        reach=d.u(1.45, 1.6))
    if d.hand.hollow:
        for k, z in enumerate((foot + wall + 0.03, foot + 0.5 * (h - foot - strip))[: d.n(0, 2)]):
            rack(d, f"basket_{k}", "body", (-w / 2 + wall, 0.02, z), (w / 2 - wall, t - 2 * wall, z + 0.12),
                travel=d.u(0.6, 0.9))


def round_door_washer(d: ObjectBuilder) -> None:
    """A box with a round door before a drum, a dial, buttons, and a drawer for powder."""
    w, t, h = d.u(0.5, 0.7), d.u(0.45, 0.65), d.u(0.75, 0.95)
    r, z, thick = d.u(0.26, 0.36) * w, d.u(0.45, 0.52) * h, d.u(0.02, 0.06)
    case(d, "housing", (-w / 2, 0, 0), (w / 2, t, h), material="steel")
    if d.hand.hollow:
        d.cut("housing", rod(0.85 * r, (0, -0.1, z), (0, 0.8 * t, z)))
        if d.maybe():
            g = d.gap(r) + 0.004
            d.part("drum", rod(0.85 * r - g, (0, 0.06, z), (0, 0.8 * t - g, z)), material="steel")
            d.cut("drum", rod(0.8 * r - g, (0, -0.1, z), (0, 0.78 * t - g, z)))
            d.spin("drum", "housing", Y, (0, 0.4 * t, z))
    play = seam(d, r, thick)
    front = -play
    d.part("door", tube(r, 0.7 * r, (0, front - thick, z), (0, front, z)), rod(0.75 * r, (0, front - d.u(0.5,
        1.3) * thick, z), (0, front - 0.1 * thick, z)), material="plastic")
    side = d.pick(X, -X)
    if d.maybe(0.5):  # a lug where it is hung
        d.part("door", box((0.8 * r * side[0], front - 0.7 * thick, z - 0.2 * r), (1.1 * r * side[0], front,
            z + 0.2 * r)))
        edge = 1.1 * r
    else:
        edge = d.pick(1.0, 1.0, 1.05) * r
    pull(d, "door", -0.86 * r * side + (front - thick) * Y + z * Z, -Y, Z, 0.5 * r)
    d.hinge("door", "housing", np.cross(-Y, side), edge * side + (front - d.hand.line * thick) * Y + z * Z,
        d.u(1.4, 2.6))
    if d.maybe():
        box_drawer(d, "drawer", "housing", (-0.47 * w, 0, 0.86 * h), (-0.2 * w, 0.3, 0.97 * h), lap=d.pick(0.0, 0.006))
        if d.hand.has_bore:
            d.cut("housing", box((-0.47 * w, -0.001, 0.86 * h), (-0.2 * w, 0.3, 0.97 * h)))
    if d.maybe(0.8):
        knob(d, "dial", "housing", (0.05 * w, 0, 0.92 * h), 0.03, d.u(0.015, 0.03), -Y, reach=d.pick(None, None, 5.5))
    for k, x in enumerate(spread(d.n(0, 4), 0.15 * w, 0.47 * w)):
        button(d, f"button_{k}", "housing", (x, 0, 0.92 * h), (0.02, 0.015), 0.006, -Y, is_round=d.maybe())


def lever_toaster(d: ObjectBuilder) -> None:
    """Slots, levers that go down at an end or the front, knobs, and a crumb tray."""
    n = d.n(1, 2)
    w, t, h = d.u(0.22, 0.4), d.u(0.08, 0.14) * n, d.u(0.15, 0.22)
    case(d, "body", (-w / 2, -t / 2, 0.01), (w / 2, t / 2, h), material="steel")
    rows = spread(2 * n if d.maybe(0.7) else n, -t / 2, t / 2)
    for y in rows:
        d.cut("body", box((-0.4 * w, y - 0.013, 0.2 * h), (0.4 * w, y + 0.013, h + 0.1)))
    end = d.maybe(0.7)
    out = X if end else -Y
    face = w / 2 if end else t / 2
    along = Y if end else X
    travel = d.u(0.3, 0.55) * h
    z = d.u(0.7, 0.85) * h
    for k, s in enumerate(spread(n, -t / 2, t / 2) if end else spread(n, -0.4 * w, 0.4 * w)):
        at = face * out + s * along + z * Z
        wide, deep = d.u(0.02, 0.045), d.u(0.015, 0.035)
        root = max(d.hand.gap, 0.001) if d.maybe(0.4) or not d.hand.has_bore else -0.02
        if root < 0.0:  # through a slot
            d.cut("body", box(at - 0.03 * out - 0.005 * along - (travel + 0.01) * Z, at + 0.1 * out + 0.005 * along
                + 0.01 * Z))
            d.part(f"lever_{k}", beam(0.006, 0.006, at + root * out, at + 0.01 * out, Z))
            root = 0.002
        elif not d.hand.has_bore:
            root = d.pick(root, 0.0, -0.01)
        d.part(f"lever_{k}", box(at + root * out - wide / 2 * along - 0.006 * Z, at + deep * out + wide / 2 * along
            + 0.006 * Z), material="plastic")
        d.slide(f"lever_{k}", "body", -Z, travel, initial_opening=d.maybe())
        if d.maybe():
            knob(d, f"knob_{k}", "body", face * out + (s + 0.03) * along + 0.25 * h * Z, 0.012, 0.012, out,
                reach=d.pick(None, 4.7))
    for k, s in enumerate(spread(d.n(0, 3), -0.3 * t, 0.3 * t) if end else ()):
        button(d, f"button_{k}", "body", (w / 2, s, 0.12 * h), (0.012, 0.008), 0.004, X, is_round=d.maybe())
    if d.maybe(0.4):
        y = -t / 2 if end else t / 2
        s = -1.0 if end else 1.0
        d.bore("body", box((-0.35 * w, y + s * 0.02, 0.012), (0.35 * w, -0.85 * y, 0.022)))
        g = d.gap(0.1)
        d.part("crumb_tray", box((-0.35 * w + g, y + s * 0.006, 0.0125 + g), (0.35 * w - g, -0.8 * y - s * g,
            0.0215 - g)), box((-0.1 * w, y + s * g, 0.0125 + g), (0.1 * w, y + s * 0.015, 0.0215 - g)))
        d.cut("body", box((-0.35 * w, y - s * 0.01, 0.012), (0.35 * w, y + s * 0.025, 0.022)))
        d.slide("crumb_tray", "body", -Y if end else Y, 0.7 * t)


def plain_kettle(d: ObjectBuilder) -> None:
    """A jug on a base, a lid that lifts or is hinged, a handle and a spout that are one with it."""
    r, h = d.u(0.06, 0.1), d.u(0.12, 0.24)
    top = d.u(0.6, 1.0) * r
    d.part("jug", cone(r, top, (0, 0, 0.02), (0, 0, h)), cone(0.4 * r, 0.15 * r, (0, -0.5 * r, 0.5 * h), (0, -1.5 * r,
        0.95 * h)), material="steel")
    d.part("jug", beam(0.025, 0.02, (0, 0.8 * top, 0.93 * h), (0, 1.6 * r, 0.9 * h)), beam(0.025, 0.02, (0, 1.6 * r,
        0.92 * h), (0, 1.6 * r, 0.25 * h), Y), beam(0.025, 0.02, (0, 1.62 * r, 0.26 * h), (0, 0.9 * r, 0.22 * h)))
    if d.hand.hollow:
        d.cut("jug", cone(0.9 * r, 0.88 * top, (0, 0, 0.03), (0, 0, h + 0.001)))
    play = seam(d, r, 0.01)
    high = d.u(0.01, 0.04)
    z = h + play
    d.part("lid", d.pick(cone(top, 0.6 * top, (0, 0, z), (0, 0, z + high)), rod(0.95 * top, (0, 0, z), (0, 0,
        z + high))), d.pick(ball(0.012, (0, 0, z + high + 0.008)), rod(0.014, (0, 0, z), (0, 0, z + high + 0.02))))
    if d.maybe():
        d.slide("lid", "jug", Z, d.u(0.03, 0.15))
    else:
        d.hinge("lid", "jug", -X, (0, d.pick(0.95, 1.0) * top, z), d.u(1.0, 1.7))
    if d.maybe(0.6):
        g = d.gap(r)
        d.part("base", rod(1.05 * r, (0, 0, 0), (0, 0, 0.02 - g)), material="plastic")
        if d.maybe():
            d.spin("jug", "base", Z, (0, 0, 0.02))
        else:
            d.slide("jug", "base", Z, d.u(0.1, 0.3))


def plain_coffee_machine(d: ObjectBuilder) -> None:
    """A tower over a tray: a lid, a lever or a knob, a tray that is drawn out, a jug that is taken away."""
    w, t, h = d.u(0.15, 0.3), d.u(0.2, 0.35), d.u(0.28, 0.4)
    head, foot, back = d.u(0.28, 0.4) * h, d.u(0.08, 0.14) * h, 0.45 * t
    d.part("body", box((-w / 2, back, 0), (w / 2, t, h)), box((-w / 2, 0, h - head), (w / 2, t, h)), box((-w / 2, 0, 0),
        (w / 2, t, foot)), material="plastic")
    kind = d.pick("lid", "lid", "lever", "none")
    if kind == "lid":
        thick = d.u(0.012, 0.03)
        slab(d, "lid", "body", (-w / 2, d.pick(0.0, back), h), (w / 2, t, h + thick), hinge=Y, out=Z, glazed=0.0,
            reach=d.u(1.2, 1.7), material="plastic")
    elif kind == "lever":
        side = d.pick(X, -X)
        x = 0.5 * w + d.gap(w) if d.hand.has_bore else 0.5 * w
        at = x * side + 0.5 * t * Y + (h - 0.4 * head) * Z
        d.part("lever", rod(0.02, at, at + 0.015 * side), beam(0.015, 0.012, at + 0.008 * side, at + 0.008 * side
            - d.u(0.3, 0.6) * t * Y + 0.3 * head * Z, side), material="metal")
        d.hinge("lever", "body", X, at, d.u(0.6, 1.4), initial_opening=False)
    if d.maybe(0.7):
        play = seam(d, w, 0.01)
        d.part("tray", box((-0.45 * w, 0.01, foot + play), (0.45 * w, back - 0.01, foot + play + 0.015)))
        d.slide("tray", "body", -Y, d.u(0.6, 0.95) * back)
    r = min(0.3 * w, 0.4 * back)
    if d.maybe(0.6):
        z0, z1 = foot + 0.03, h - head - 0.02
        d.part("jug", rod(r, (0, 0.5 * back, z0), (0, 0.5 * back, z1)), beam(0.02, 0.012, (0, 0.5 * back - 0.9 * r,
            0.8 * z1 + 0.2 * z0), (0, 0.5 * back - 1.6 * r, 0.75 * z1 + 0.25 * z0)), material="glass")
        d.slide("jug", "body", -Y, d.u(0.1, 0.25), initial_opening=False)
    for k, x in enumerate(spread(d.n(0, 3), -0.45 * w, 0.45 * w)):
        at = (x, 0, h - head / 2)
        if d.maybe():
            knob(d, f"knob_{k}", "body", at, min(0.02, 0.1 * w), 0.012, -Y, reach=d.pick(None, 3.0))
        else:
            button(d, f"button_{k}", "body", at, (0.08 * w, 0.08 * w), 0.005, -Y, is_round=d.maybe())


def slab_safe(d: ObjectBuilder) -> None:
    """A thick box with a thick slab before it or let into it, a dial and a handle on the slab."""
    w, t, h = d.u(0.25, 0.7), d.u(0.25, 0.6), d.u(0.25, 1.2)
    wall, thick = d.u(0.02, 0.06), d.u(0.03, 0.08)
    carcass(d, "body", (-w / 2, 0, 0), (w / 2, t, h), wall, shelves=[d.u(0.4, 0.6) * h] if d.maybe(0.3) else [],
        material="steel")
    side, inset = d.pick(X, -X), d.maybe(0.4) and d.hand.hollow
    low, y = (wall, 0.0) if inset else (0.0, -thick)
    slab(d, "door", "body", (-w / 2 + low, y, low), (w / 2 - low, y + thick, h - low), hinge=side, inset=inset,
        reach=d.u(1.4, 2.4), handle=False, glazed=0.0, material="steel")
    if inset and d.hand.hollow:
        d.cut("body", box((-w / 2 + wall, -0.001, wall), (w / 2 - wall, thick, h - wall)))
    face = y - 0.35 * thick
    d.part("door", box((-0.12 * w, face, 0.35 * h), (0.12 * w, y + 0.2 * thick, 0.65 * h)))
    if d.maybe(0.7):
        knob(d, "dial", "door", (0, face, 0.58 * h), d.u(0.06, 0.1) * w, d.u(0.015, 0.035), -Y,
            reach=d.pick(None, None, 3.0))
    if d.maybe(0.6):
        at, r = np.array([0.0, face, 0.42 * h]), 0.1 * w
        n, deep = d.pick(1, 2, 3, 4), d.u(0.02, 0.04)
        foot = -seam(d, r, 0.01)
        d.part("handle", rod(0.3 * r, at + foot * Y, at - deep * Y), material="metal")
        for a in np.arange(n) * 2 * np.pi / n + d.pick(0.0, 0.5):
            tip = at - 0.8 * deep * Y + r * (np.cos(a) * X + np.sin(a) * Z)
            d.part("handle", rod(0.12 * r, at - 0.8 * deep * Y, tip))
        if d.maybe():
            d.spin("handle", "door", -Y, at)
        else:
            d.hinge("handle", "door", -Y, at, d.u(0.8, 1.6), initial_opening=False)
