"""What things are kept in: plain cabinets, drawers, boxes, bins and cases, and furniture with flaps."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import legs, wheel
from benchmarks.recipes.object_builder import spread
from benchmarks.recipes.panels import box_drawer, carcass, pane, pull, rack, seam, slab
from benchmarks.recipes.shapes import X, Y, Z, box, cone, prism, rod

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def slab_cabinet(d: ObjectBuilder) -> None:
    """Rows and columns of doors before a body or let into it, on the floor, on feet, or on a wall."""
    w, t, h = d.u(0.35, 1.6), d.u(0.25, 0.6), d.u(0.4, 2.0)
    wall, thick, foot = d.u(0.012, 0.03), d.u(0.012, 0.03), d.pick(0.0, 0.0, d.u(0.05, 0.2))
    rows = d.pick(1, 1, 2)
    columns = min(d.n(1, 3), max(1, round(w / 0.3)))
    levels = [foot + (h - foot) * d.u(0.35, 0.65)] if rows == 2 else []
    edges = np.linspace(-w / 2, w / 2, columns + 1)
    inset = d.maybe(0.3) and d.hand.hollow
    carcass(d, "body", (-w / 2, 0, foot), (w / 2, t, h), wall, shelves=levels, uprights=edges[1:-1] if inset else ())
    if foot:
        legs(d, "body", (-w / 2, 0, 0), (w / 2, t, foot + 0.002), d.u(0.02, 0.05))
    if d.maybe(0.3):
        d.part("body", box((-w / 2 - 0.02, -0.03 - thick, h), (w / 2 + 0.02, t, h + 0.03)))
    sides = [d.pick(X, -X)] if columns == 1 else [-X, X, d.pick(X, -X)]
    bounds = [foot, *levels, h]
    for i, (a, b) in enumerate(pairwise(bounds)):
        for k, (c, e) in enumerate(pairwise(edges)):
            if inset:  # between the boards
                low = (c + (wall if k == 0 else wall / 2), 0.0, a + (wall if i == 0 else wall / 2))
                high = (e - (wall if k == columns - 1 else wall / 2), thick, b - (wall if i == rows - 1 else wall / 2))
            else:
                low, high = (c, -thick, a), (e, 0.0, b)
            slab(d, f"door_{i}_{k}", "body", low, high, hinge=sides[k], inset=inset, reach=d.u(1.4, 2.8),
                handle=d.maybe(0.8))


def slab_wardrobe(d: ObjectBuilder) -> None:
    """A tall case with two or three leaves that slide past each other, between boards or before the case."""
    n, w, t, h = d.n(2, 3), d.u(0.5, 0.9), d.u(0.45, 0.65), d.u(1.2, 2.4)
    wall, thick = d.u(0.015, 0.03), d.u(0.012, 0.03)
    wide = n * w
    carcass(d, "body", (-wide / 2, 0, 0), (wide / 2, t, h), wall, uprights=spread(n - 1, -wide / 2 + w / 2, wide / 2
        - w / 2) if d.maybe() else ())
    play = seam(d, w, thick)
    inside = d.maybe(0.4) and d.hand.hollow
    z0, z1 = (wall + max(play, 0.0), h - wall - max(play, 0.0)) if inside or d.maybe() else (0.0, h)
    if inside:  # boards before the leaves
        for a, b in ((0, wall), (h - wall, h)):
            d.part("body", box((-wide / 2, -3.0 * thick - 0.01, a), (wide / 2, 0.01, b)))
        for s in (-1.0, 1.0):
            d.part("body", box((s * wide / 2, -3.0 * thick - 0.01, 0), (s * (wide / 2 - wall), 0.01, h)))
    lap = d.u(0.0, 0.05)
    for k in range(n):
        a, b = -wide / 2 + k * w - lap * (k > 0), -wide / 2 + (k + 1) * w + lap * (k < n - 1)
        a, b = max(a, -wide / 2 + wall + 0.001), min(b, wide / 2 - wall - 0.001)
        y = -thick - play - (k % 2) * (thick + max(play, 0.0))
        pane(d, f"leaf_{k}", (a, y, z0), (b, y + thick, z1))
        s = 1.0 if k < n - 1 else -1.0
        if d.maybe(0.6) and k % 2:  # none where another leaf passes before it
            pull(d, f"leaf_{k}", (a + 0.06 if s < 0 else b - 0.06, y, h / 2), -Y, Z, 0.4 * h)
        d.slide(f"leaf_{k}", "body", s * X, d.u(0.7, 0.95) * (w - 2 * wall))


def drawer_stack(d: ObjectBuilder) -> None:
    """Drawers one above the other, now and then in columns, with fronts before the body or in it, or as open trays."""
    w, t, h, n = d.u(0.3, 1.2), d.u(0.3, 0.6), d.u(0.3, 1.3), d.n(1, 5)
    wall, foot, columns = d.u(0.012, 0.025), d.pick(0.0, 0.0, d.u(0.05, 0.15)), d.pick(1, 1, 2)
    levels = np.linspace(foot, h, n + 1)
    edges = np.linspace(-w / 2, w / 2, columns + 1)
    boards = d.maybe()  # between the drawers
    carcass(d, "body", (-w / 2, 0, foot), (w / 2, t, h), wall, shelves=levels[1:-1] if boards else (),
        uprights=edges[1:-1])
    if foot:
        legs(d, "body", (-w / 2, 0, 0), (w / 2, t, foot + 0.002), d.u(0.02, 0.05))
    lap = d.pick(0.0, 0.8 * wall)
    deep = d.u(0.6, 0.95) * (t - wall)
    share = wall if boards or lap else 0.003
    for i, (a, b) in enumerate(pairwise(levels)):
        for k, (c, e) in enumerate(pairwise(edges)):
            low = (c + wall * (1.0 if k == 0 else 0.5), 0.0, a + (wall if i == 0 else share / 2) + 0.001)
            high = (e - wall * (1.0 if k == columns - 1 else 0.5), deep,
                b - (wall if i == n - 1 else share / 2) - 0.001)
            box_drawer(d, f"drawer_{i}_{k}", "body", low, high, lap=0.45 * share if lap and not boards else lap / 2.2)


def tray_rack(d: ObjectBuilder) -> None:
    """Trays, baskets or sheets without fronts that slide in an open case: cutlery, letters, bread."""
    w, t, h, n = d.u(0.2, 0.7), d.u(0.25, 0.6), d.u(0.1, 1.5), d.n(1, 6)
    wall = d.u(0.006, 0.025)
    carcass(d, "case", (-w / 2, 0, 0), (w / 2, t, h), wall, material="steel")
    for k, z in enumerate(spread(n, wall, h - wall)):
        high = d.u(0.25, 0.6) * (h - 2 * wall) / n
        rack(d, f"tray_{k}", "case", (-w / 2 + wall, d.pick(0.0, -0.01, 0.02), z - high / 2), (w / 2 - wall,
            t - 1.5 * wall, z + high / 2), travel=d.u(0.5, 0.95))


def doors_and_drawers(d: ObjectBuilder) -> None:
    """A sideboard or kitchen unit: fields that hold a door, drawers, a flap or nothing."""
    n, field, t, h = d.n(1, 4), d.u(0.3, 0.6), d.u(0.3, 0.6), d.u(0.4, 1.0)
    wall, thick = d.u(0.012, 0.025), d.u(0.012, 0.025)
    w = n * field
    edges = np.linspace(-w / 2, w / 2, n + 1)
    level = d.u(0.55, 0.8) * h
    carcass(d, "body", (-w / 2, 0, 0), (w / 2, t, h), wall, shelves=[level], uprights=edges[1:-1])
    for k, (c, e) in enumerate(pairwise(edges)):
        kind = d.pick("door and drawer", "drawers", "door", "flap") if k else "door and drawer"
        low, high = c + wall, e - wall
        if kind not in {"door", "flap"}:
            box_drawer(d, f"drawer_{k}_top", "body", (low, 0, level + wall), (high, 0.8 * t, h - wall), lap=0.4 * wall,
                front=thick)
        if kind == "drawers":
            box_drawer(d, f"drawer_{k}_low", "body", (low, 0, wall + 0.002), (high, 0.8 * t, level - wall),
                lap=0.4 * wall, front=thick)
        elif kind == "flap":
            slab(d, f"flap_{k}", "body", (c + 0.001, -thick, 0), (e - 0.001, 0, level), hinge=d.pick(-Z, Z),
                reach=d.u(1.2, 1.57))
        else:
            slab(d, f"door_{k}", "body", (c + 0.001, -thick, 0), (e - 0.001, 0, level - 0.5 * wall if kind != "door"
                else h), hinge=d.pick(-X, X), reach=d.u(1.4, 2.2))


def drawer_table(d: ObjectBuilder) -> None:
    """A table or desk whose apron or pedestal holds drawers: fronts alone, trays or blocks."""
    w, t, h = d.u(0.7, 1.8), d.u(0.45, 0.9), d.u(0.45, 0.8)
    top, apron, wall = d.u(0.015, 0.04), d.u(0.08, 0.16), 0.018
    d.part("table", box((-w / 2, -0.02, h - top), (w / 2, t, h)), material="wood")
    legs(d, "table", (-w / 2 + 0.03, 0.0, 0), (w / 2 - 0.03, t - 0.02, h - top + 0.002), d.u(0.03, 0.08))
    n = d.n(1, 3)
    low, high = h - top - apron, h - top
    carcass(d, "table", (-w / 2 + 0.05, 0.02, low), (w / 2 - 0.05, t - 0.05, high), wall,
        uprights=np.linspace(-w / 2 + 0.05, w / 2 - 0.05, n + 1)[1:-1])
    for k, x in enumerate(spread(n, -w / 2 + 0.05, w / 2 - 0.05)):
        half = (w - 0.1) / 2 / n - wall - 0.001
        box_drawer(d, f"drawer_{k}", "table", (x - half, 0.02, low + wall + 0.001), (x + half, d.u(0.5, 0.9) * t,
            high - wall - 0.001))
    if d.maybe(0.4):  # a board that is drawn out to either side
        side = d.pick(X, -X)
        play = max(seam(d, 0.3, 0.01), 0.0)
        z = low - 0.02 - play
        d.part("board", box(0.45 * w * side + 0.1 * t * Y + z * Z, 0.1 * w * side + 0.8 * t * Y + (z + 0.015) * Z))
        d.slide("board", "table", side, d.u(0.15, 0.3) * w)


def lidded_box(d: ObjectBuilder) -> None:
    """A box with one lid, two flaps or four, thin or thick, shut or half open; or a lid that is lifted off."""
    w, t, h = d.u(0.15, 1.2), d.u(0.12, 0.6), d.u(0.08, 0.6)
    wall, kind = d.u(0.01, 0.06) * min(w, t, h), d.pick("lid", "lid", "lid", "two", "four", "off")
    if d.hand.hollow:
        d.part("body", box((-w / 2, -t / 2, 0), (w / 2, t / 2, h)), material="wood")
        d.cut("body", box((-w / 2 + wall, -t / 2 + wall, wall), (w / 2 - wall, t / 2 - wall, h + 1)))
    else:
        d.part("body", box((-w / 2, -t / 2, 0), (w / 2, t / 2, h)), material="wood")
    thick = d.pick(wall, 2.0 * wall, d.u(0.1, 0.4) * h)
    reach = d.u(1.2, 3.3)
    if kind == "off":
        play = seam(d, t, thick)
        over = d.u(0.0, 0.02)
        d.part("lid", box((-w / 2 - over, -t / 2 - over, h + play), (w / 2 + over, t / 2 + over, h + play + thick)))
        d.slide("lid", "body", Z, d.u(0.3, 1.0) * h)
        return
    if kind == "lid":
        slab(d, "lid", "body", (-w / 2, -t / 2, h), (w / 2, t / 2, h + thick), hinge=d.pick(Y, Y, X), out=Z,
            reach=min(reach, 2.0), glazed=0.05)
    else:
        for k, (side, a, b) in enumerate(((-X, -w / 2, 0.0), (X, 0.0, w / 2))):
            slab(d, f"flap_{k}", "body", (a, -t / 2, h), (b, t / 2, h + wall), hinge=side, out=Z, reach=reach,
                handle=False, glazed=0.0)
    if kind == "four":
        for k, (side, a, b) in enumerate(((-Y, -t / 2, -0.1 * t), (Y, 0.1 * t, t / 2))):
            slab(d, f"cross_flap_{k}", "body", (-w / 2, a, h + 1.2 * wall + d.hand.gap), (w / 2, b, h + 2.2 * wall
                + d.hand.gap), hinge=side, out=Z, reach=reach, handle=False, glazed=0.0)


def plain_bin(d: ObjectBuilder) -> None:
    """A bin whose lid is hinged behind, swings about its middle, or is two halves; at times wheels, a pedal."""
    w, t, h = d.u(0.25, 0.6), d.u(0.25, 0.6), d.u(0.35, 1.1)
    round_one = d.maybe(0.3)
    r = min(w, t) / 2
    body = cone(0.85 * r, r, (0, 0, 0), (0, 0, h)) if round_one else box((-w / 2, -t / 2, 0), (w / 2, t / 2, h))
    d.part("bin", body, material="plastic")
    if round_one:
        w = t = 2 * r
    if d.hand.hollow:
        d.cut("bin", cone(0.75 * r, 0.92 * r, (0, 0, 0.02), (0, 0, h + 0.01)) if round_one else box((-0.46 * w,
            -0.46 * t, 0.02), (0.46 * w, 0.46 * t, h + 1)))
    thick = d.u(0.008, 0.06)
    play = seam(d, w, thick)
    kind = d.pick("behind", "behind", "swings", "halves") if not round_one else "behind"
    low = h + play
    if round_one:
        d.part("lid", rod(r, (0, 0, low), (0, 0, low + thick)))
        d.hinge("lid", "bin", -X, (0, r, low + (1.0 - d.hand.line) * thick), d.u(1.0, 1.7))
    elif kind == "behind":
        slab(d, "lid", "bin", (-w / 2, -t / 2, h), (w / 2, t / 2, h + thick), hinge=Y, out=Z, reach=d.u(1.2, 2.2),
            glazed=0.0, material="plastic")
    elif kind == "swings":
        d.part("bin", *(box((s * w / 2, -t / 2, h), (s * 0.44 * w, t / 2, h + 0.4 * t)) for s in (-1.0, 1.0)))
        g = max(seam(d, w, 0.01), 0.001)
        z = h + 0.36 * t
        d.part("lid", prism([(-0.4 * t, z - 0.3 * t), (0.0, z + 0.02), (0.0, z + 0.03), (-0.42 * t, z - 0.29 * t)],
            (0, 0, 0), 0.88 * w - 2 * g, "x"), prism([(0.4 * t, z - 0.3 * t), (0.42 * t, z - 0.29 * t), (0.0, z + 0.03),
            (0.0, z + 0.02)], (0, 0, 0), 0.88 * w - 2 * g, "x"))
        d.hinge("lid", "bin", X, (0, 0, z), 0.6, -0.6, initial_opening=False)
    else:
        for k, (side, a, b) in enumerate(((-X, -w / 2, 0.0), (X, 0.0, w / 2))):
            slab(d, f"lid_{k}", "bin", (a, -t / 2, h), (b, t / 2, h + thick), hinge=side, out=Z, reach=d.u(1.2, 1.8),
                glazed=0.0, handle=False, material="plastic")
    if d.maybe(0.3) and not round_one:
        for k, s in enumerate((-1.0, 1.0)):
            g = d.gap(0.1)
            wheel(d, f"wheel_{k}", "bin", (s * (w / 2 + 0.02 + g), 0.4 * t, 0.09), d.u(0.08, 0.1), 0.04, s * X)
    elif d.maybe(0.4):
        deep = t / 2 if not round_one else 0.85 * r
        g = d.gap(0.05)
        d.part("pedal", box((-0.05, -deep - 0.08, 0.01), (0.05, -deep - g if d.hand.has_bore else -0.9 * deep, 0.022)))
        d.hinge("pedal", "bin", X, (0, -deep - g if d.hand.has_bore else -0.9 * deep, 0.016), d.u(0.1, 0.3), -0.02,
            initial_opening=False)


def plain_suitcase(d: ObjectBuilder) -> None:
    """A case on end with two halves or one block, a handle that telescopes, a carry handle, and wheels below."""
    w, t, h, foot = d.u(0.35, 0.5), d.u(0.18, 0.3), d.u(0.5, 0.75), d.u(0.03, 0.06)
    split = d.maybe(0.4)
    middle = d.u(-0.1, 0.1) * t if split else -t / 2
    d.part("body", box((-w / 2, middle, foot), (w / 2, t / 2, foot + h)), material="plastic")
    if split:
        play = seam(d, w, 0.01)
        d.part("lid", box((-w / 2, -t / 2, foot), (w / 2, middle - play, foot + h)), material="plastic")
        side = d.pick(X, -X)
        d.hinge("lid", "body", np.cross(-Y, side), w / 2 * side + (middle - d.pick(0.0, play)) * Y + 0.5 * h * Z,
            d.u(1.5, 3.0), initial_opening=False)
        if d.hand.hollow:
            d.cut("body", box((-0.48 * w, middle - 1, foot + 0.02 * h), (0.48 * w, 0.46 * t, foot + 0.98 * h)))
            d.cut("lid", box((-0.48 * w, -0.46 * t, foot + 0.02 * h), (0.48 * w, middle + 1, foot + 0.98 * h)))
    r, top, gap = d.u(0.005, 0.01), d.u(0.01, 0.06), d.gap(0.03)
    y, x = t / 2 - 0.02, d.u(0.1, 0.2)
    low = foot + h * d.u(0.1, 0.5)
    for s in (-1.0, 1.0):
        d.bore("body", box((s * x - r - gap, y - r - gap, low - 0.01), (s * x + r + gap, y + r + gap, foot + h + 0.1)))
        d.part("handle", box((s * x - r, y - r, low), (s * x + r, y + r, foot + h + top)), material="metal")
    d.part("handle", box((-x - r, y - 0.014, foot + h + top), (x + r, y + 0.014, foot + h + top + 0.025)))
    d.slide("handle", "body", Z, d.u(0.5, 0.9) * (foot + h - low), initial_opening=d.maybe())
    for k, s in enumerate((-1.0, 1.0)) if d.maybe(0.7) else ():
        at = (s * 0.38 * w, t / 2 - 0.035, foot - d.pick(0.005, 0.0))
        g = max(d.gap(0.03), 0.001)
        d.cut("body", rod(foot + g, (at[0] - 0.013 - g, at[1], at[2]), (at[0] + 0.013 + g, at[1], at[2])))
        wheel(d, f"wheel_{k}", "body", at, foot * 0.95, 0.025, s * X)
    if d.maybe(0.5):
        g = d.gap(0.02)
        z, half, side = foot + h / 2, 0.07, d.pick(-1.0, 1.0)
        if split:
            side = -float(side)
        a = side * (w / 2 + g)
        lift = side * 0.035
        if not split:
            d.part("grip", box((a, -0.012, z - half), (a + lift, 0.012, z - half + 0.012)), box((a, -0.012,
                z + half - 0.012), (a + lift, 0.012, z + half)), box((a + lift, -0.012, z - half), (a + 0.75 * lift,
                0.012, z + half)), material="plastic")
            d.hinge("grip", "body", Z, (a, 0, z), 1.2, -1.2, initial_opening=False)
