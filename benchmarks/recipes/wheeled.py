"""Wheels without axles, in forks, under boxes and beside them, and seats, tables and lids of plain solids."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import button, caster, legs, wheel
from benchmarks.recipes.object_builder import spread
from benchmarks.recipes.panels import seam, slab
from benchmarks.recipes.shapes import X, Y, Z, beam, block, box, capsule, rod

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder
    from benchmarks.recipes.shapes import Point
    from kinematify.robot.arrays import FloatArray

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def _in_fork(d: ObjectBuilder, name: str, parent: str, middle: Point, radius: float, wide: float, top: float) -> None:
    """A wheel about x between two cheeks of its parent that come down from a height, without an axle."""
    at = np.asarray(middle, dtype=np.float64)
    play = max(d.pick(d.hand.gap, 0.1 * wide, 0.3 * wide), 0.0005)
    sheet = d.u(0.15, 0.4) * wide
    length = d.u(0.3, 0.6) * radius
    for s in (-1.0, 1.0):
        x = at[0] + s * (wide / 2 + play)
        d.part(parent, box((x, at[1] - length, at[2] - d.u(0.1, 0.5) * radius), (x + s * sheet, at[1] + length, top)))
    reach = wide / 2 + play + sheet
    bridge = max(top - 0.3 * wide, at[2] + radius + play)
    d.part(parent, box((at[0] - reach, at[1] - length, bridge), (at[0] + reach, at[1] + length, bridge + 0.3 * wide)))
    wheel(d, name, parent, at, radius, wide, X)


def platform_cart(d: ObjectBuilder) -> None:
    """A plate with a push bar on fixed wheels in forks and on casters."""
    w, t, r = d.u(0.35, 0.7), d.u(0.5, 1.1), d.u(0.03, 0.1)
    top = 2.6 * r
    d.part("deck", box((-w / 2, 0, top), (w / 2, t, top + d.u(0.02, 0.06))), material="wood")
    if d.maybe(0.7):
        h, bar = d.u(0.6, 1.0), d.u(0.01, 0.02)
        for s in (-1.0, 1.0):
            d.part("deck", rod(bar, (s * 0.42 * w, t - 0.03, top), (s * 0.42 * w, t - 0.03, top + h)))
        d.part("deck", rod(bar, (-0.42 * w, t - 0.03, top + h), (0.42 * w, t - 0.03, top + h)))
    wide = d.u(0.3, 0.6) * r
    for k, s in enumerate((-1.0, 1.0)):
        _in_fork(d, f"wheel_{k}", "deck", (s * 0.38 * w, 0.85 * t, r), r, wide, top + 0.005)
        if d.maybe():
            caster(d, f"caster_{k}", "deck", (s * 0.38 * w, 0.12 * t, top), top)
        else:
            _in_fork(d, f"front_wheel_{k}", "deck", (s * 0.38 * w, 0.15 * t, r), r, wide, top + 0.005)


def fork_barrow(d: ObjectBuilder) -> None:
    """A tray or a frame on one wheel in a fork, or on two: a barrow, a walker, a stroller of plain bars."""
    w, t, r = d.u(0.4, 0.7), d.u(0.6, 1.0), d.u(0.1, 0.22)
    floor = 2 * r + d.u(0.05, 0.15)
    d.part("tray", box((-w / 2, 0, floor), (w / 2, t, floor + d.u(0.15, 0.35))), material="metal")
    if d.hand.hollow:
        d.cut("tray", box((-0.46 * w, 0.03 * t, floor + 0.02), (0.46 * w, 0.97 * t, floor + 1)))
    wide = d.u(0.15, 0.5) * r
    for s in (-1.0, 1.0):
        d.part("tray", beam(0.03, 0.03, (s * 0.3 * w, 0.5 * t, floor), (s * 0.3 * w, 1.5 * t, floor + 0.05)), beam(0.03,
            0.03, (s * 0.3 * w, 0.9 * t, floor + 0.01), (s * 0.3 * w, 0.95 * t, 0.0)))
    n = d.pick(1, 1, 2)
    for k in range(n):
        x = 0.0 if n == 1 else (k - 0.5) * 0.7 * w
        _in_fork(d, f"wheel_{k}", "tray", (x, d.u(0.0, 0.2) * t if n == 1 else 0.2 * t, r), r, wide, floor + 0.01)


def box_on_wheels(d: ObjectBuilder) -> None:
    """A toy, a cabinet or a carriage: a block with four to six discs at its sides, below it or half in it."""
    w, t, h, n = d.u(0.05, 0.8), d.u(0.1, 1.4), d.u(0.05, 0.6), d.n(2, 3)
    r = d.u(0.15, 0.4) * min(h, t / n, w)
    wide, form = d.u(0.2, 0.7) * r, d.pick("beside", "below", "within")
    foot = {"beside": d.u(0.3, 1.2) * r, "below": 2.05 * r, "within": d.u(0.5, 1.0) * r}[form]
    d.part("box", box((-w / 2, 0, foot), (w / 2, t, foot + h)), material="wood")
    if d.maybe(0.4):
        d.part("box", box((-0.4 * w, 0.3 * t, foot + h), (0.4 * w, 0.9 * t, foot + 1.6 * h)))
    play = seam(d, r, wide)
    if form != "beside" or d.hand.has_bore:
        play = max(play, 0.001)
    for i, y in enumerate(spread(n, 0, t)):
        for s in (-1.0, 1.0):
            x = s * (w / 2 + wide / 2 + play) if form == "beside" else s * (w / 2 - 0.6 * wide - play)
            if form == "within":
                reach = r + play
                d.cut("box", box((s * w, y - reach, foot - 1), (x - s * (wide / 2 + play), y + reach, r + reach)))
            wheel(d, f"wheel_{i}_{'left' if s < 0 else 'right'}", "box", (x, y, r), r, wide, s * X)


def plain_swivel_chair(d: ObjectBuilder) -> None:
    """A seat that turns or goes up on a column on feet; wheels in forks or bare discs below, a back that leans."""
    h, w = d.u(0.38, 0.55), d.u(0.38, 0.55)
    n, r, foot = d.n(3, 5), d.u(0.2, 0.32), d.pick(0.0, d.u(0.04, 0.07))
    d.part("base", rod(0.03, (0, 0, foot), (0, 0, 0.75 * h)), material="metal")
    for k, a in enumerate(np.arange(n) * 2 * np.pi / n):
        tip = r * np.array([np.cos(a), np.sin(a), 0.0])
        d.part("base", beam(0.04, 0.03, (0, 0, foot + 0.03), tip + (foot + 0.02) * Z))
        if foot:
            d.part("base", block(tip + (foot + 0.005) * Z, (0.03, 0.03, 0.02)))
            axis: FloatArray = np.array([-np.sin(a), np.cos(a), 0.0])
            play = max(d.gap(foot), 0.0005)
            wheel_radius = 0.48 * foot - play
            at = tip + (wheel_radius - 0.02 * foot) * Z
            d.part(f"wheel_{k}", rod(wheel_radius, at - 0.012 * axis, at + 0.012 * axis), material="rubber")
            d.spin(f"wheel_{k}", "base", axis, at)
    play = seam(d, 0.06, 0.03)
    low = 0.75 * h + play
    d.part("seat", rod(0.02, (0, 0, 0.4 * h if d.hand.has_bore else low), (0, 0, h)), d.pick(rod(w / 2, (0, 0, h),
        (0, 0,
        h + 0.06)), box((-w / 2, -w / 2, h), (w / 2, w / 2, h + 0.08))))
    d.bore("base", rod(0.02 + 2 * d.gap(0.06) + 1e-4, (0, 0, 0.38 * h), (0, 0, h)))
    if d.maybe(0.75):
        d.spin("seat", "base", Z, (0, 0, low))
    else:
        d.slide("seat", "base", Z, d.u(0.05, 0.2))
    kind = d.pick("merged", "leans", "none")
    top, thick = h + 0.1, d.u(0.03, 0.08)
    back = box((-0.45 * w, w / 2, top), (0.45 * w, w / 2 + thick, top + d.u(0.3, 0.6)))
    if kind == "merged":
        d.part("seat", back, box((-0.1 * w, 0.3 * w, h), (0.1 * w, w / 2 + 0.5 * thick, h + 0.02)), box((-0.1 * w,
            w / 2,
            h), (0.1 * w, w / 2 + 0.5 * thick, top + 0.02)))
    elif kind == "leans":
        d.part("seat", box((-0.1 * w, 0.3 * w, h), (0.1 * w, w / 2 + thick, h + 0.04)))
        gap = max(seam(d, w, 0.02), -0.01)
        lift = h + 0.04 + gap - top
        d.part("back", {**back, "xyz": (np.array(back["xyz"]) + lift * Z).tolist()}, material="plastic")
        d.hinge("back", "seat", -X, (0, w / 2 + thick, h + 0.04 + gap), 0.5, initial_opening=False)


def folding_table(d: ObjectBuilder) -> None:
    """A plate whose legs fold under it about their upper ends, or that folds itself in two."""
    w, t, h, thick = d.u(0.5, 1.8), d.u(0.4, 0.9), d.u(0.4, 0.8), d.u(0.015, 0.04)
    leg = d.u(0.015, 0.04)
    play = seam(d, t, thick)
    if d.maybe(0.7):
        d.part("top", box((-w / 2, -t / 2, h), (w / 2, t / 2, h + thick)), material="wood")
        for k, s in enumerate((-1.0, 1.0)):
            x, high = s * (w / 2 - d.u(0.05, 0.12)), h - play
            for y in (-0.42 * t, 0.42 * t):
                d.part(f"legs_{k}", box((x - leg / 2, y - leg / 2, 0), (x + leg / 2, y + leg / 2, high)),
                    material="metal")
            for z in (d.u(0.1, 0.3) * h, high - leg):
                d.part(f"legs_{k}", box((x - leg / 2, -0.42 * t, z), (x + leg / 2, 0.42 * t, z + leg)))
            # It turns about the edge that stays below the plate.
            d.hinge(f"legs_{k}", "top", s * Y, (x - s * leg / 2, 0, high), 1.5, initial_opening=False)
    else:
        d.part("half", box((-w / 2, -t / 2, h), (0, t / 2, h + thick)), material="wood")
        legs(d, "half", (-w / 2 + 0.02, -t / 2 + 0.02, 0), (-0.02, t / 2 - 0.02, h + 0.002), leg)
        slab(d, "other_half", "half", (0, -t / 2, h), (w / 2, t / 2, h + thick), hinge=-X, inset=True, handle=False,
            out=d.pick(Z, -Z), glazed=0.0, reach=d.u(1.4, 1.6))


def plain_toilet(d: ObjectBuilder) -> None:
    """A bowl and a tank: a seat and a lid behind it, a tank lid that lifts, a flush button or lever."""
    w, t, h = d.u(0.34, 0.42), d.u(0.4, 0.5), d.u(0.36, 0.42)
    d.part("bowl", box((-w / 2, 0.1, 0), (w / 2, t, 0.5 * h)), rod(w / 2, (0, w / 2, 0.4 * h), (0, w / 2, h)),
        box((-w / 2, w / 2, 0.4 * h), (w / 2, t + 0.02, h)), material="plastic")
    if d.hand.hollow:
        d.cut("bowl", rod(0.36 * w, (0, w / 2, 0.5 * h), (0, w / 2, h + 1)))
    tank = d.maybe(0.8)
    if tank:
        d.part("bowl", box((-0.5 * w, t + 0.02, 0.5 * h), (0.5 * w, t + 0.18, h + 0.35)))
    play, level = seam(d, w, 0.015), h
    edge, reach = t - d.u(0.0, 0.03), d.u(1.45, 1.6)
    for name, thick in (("seat", d.u(0.012, 0.03)), ("lid", d.u(0.01, 0.03)))[: d.pick(2, 2, 1)]:
        low = level + play
        d.part(name, rod(w / 2, (0, w / 2, low), (0, w / 2, low + thick)), box((-w / 2, w / 2, low), (w / 2, edge,
            low + thick)), material="plastic")
        if name == "seat":
            d.cut(name, rod(0.33 * w, (0, w / 2, low - 1), (0, w / 2, low + 1)))
        d.hinge(name, "bowl", -X, (0, edge, low + d.pick(0.0, 0.5) * thick), reach, initial_opening=False,
            rest=d.pick(0.0, 0.0, 0.95 * reach) if name == "lid" else 0.0)
        level = low + thick
    if tank:
        gap = seam(d, w, 0.02)
        high = h + 0.35
        if d.maybe(0.5):
            d.part("tank_lid", box((-0.53 * w, t + 0.02 - min(0.0, gap), high + gap), (0.53 * w, t + 0.19, high + gap
                + 0.03)))
            d.slide("tank_lid", "bowl", Z, d.u(0.05, 0.2), initial_opening=False)
        elif d.maybe():
            button(d, "flush", "bowl", (0, t + 0.1, high), (0.05, 0.05), 0.01, Z, is_round=d.maybe())
        else:
            at = np.array([-0.35 * w, t + 0.02, high - 0.06])
            gap = d.gap(0.02) if d.hand.has_bore else 0.0
            d.part("lever", rod(0.012, at - gap * Y, at - 0.015 * Y), beam(0.012, 0.008, at - 0.012 * Y, at - 0.012 * Y
                + 0.08 * X), material="metal")
            d.hinge("lever", "bowl", Y, at, 0.6, initial_opening=False)


def grand_piano(d: ObjectBuilder) -> None:
    """A case on legs, a large lid on its long side, a fall before the keys, keys and pedals as they come."""
    w, t, h, deep = d.u(1.3, 1.5), d.u(1.4, 2.4), d.u(0.65, 0.75), d.u(0.25, 0.35)
    d.part("case", box((-w / 2, 0.25, h), (w / 2, t, h + deep)), box((-w / 2, 0, h), (w / 2, 0.3, h + 0.3 * deep)),
        material="wood")
    for x, y in ((-0.4 * w, 0.15), (0.4 * w, 0.15), (0.0, 0.85 * t)):
        d.part("case", rod(0.05, (x, y, 0), (x, y, h + 0.01)))
    if d.hand.hollow:
        d.cut("case", box((-0.47 * w, 0.32, h + 0.1), (0.47 * w, 0.97 * t, h + 1)))
    slab(d, "lid", "case", (-w / 2, 0.25, h + deep), (w / 2, t, h + deep + 0.025), hinge=d.pick(X, -X), out=Z,
        handle=False, glazed=0.0, reach=d.u(0.5, 1.2))
    gap, low = d.gap(0.1), h + 0.3 * deep
    if d.maybe(0.7):
        d.part("fall", box((-0.46 * w, 0.03, low + 0.03 + gap), (0.46 * w, 0.24, low + 0.045 + gap)))
        d.hinge("fall", "case", -X, (0, 0.24, low + 0.03 + gap), d.u(1.2, 1.6), initial_opening=False)
    for k, x in enumerate(spread(d.n(0, 6), -0.4 * w, 0.4 * w)):
        half = 0.025
        d.part(f"key_{k}", box((x - half, -0.02, low + gap), (x + half, 0.23, low + gap + 0.015)))
        d.hinge(f"key_{k}", "case", X, (x, 0.23, low + gap + 0.0075), 0.05, -0.02, initial_opening=False)


def tilting_screen(d: ObjectBuilder) -> None:
    """A flat screen on a foot or an arm: it tilts, it swivels, or it goes up on a post."""
    w, h, t, z = d.u(0.15, 1.2), d.u(0.12, 0.7), d.u(0.01, 0.06), d.u(0.05, 0.3)
    d.part("foot", box((-0.25 * w, -0.1, 0), (0.25 * w, 0.12, 0.02)), material="metal")
    kind, r = d.pick("tilts", "swivels", "rises"), d.u(0.01, 0.03)
    y = t + r
    post = z + 0.35 * h
    play = seam(d, 2 * r, r)
    if kind == "swivels":
        d.part("foot", rod(2 * r, (0, y, 0), (0, y, 0.04)))
        low = 0.04 + play
        d.part("screen", rod(r, (0, y, low), (0, y, post)), box((-r, 0, post - 2 * r), (r, y, post + 2 * r)))
        d.hinge("screen", "foot", Z, (0, y, low), d.u(0.5, 1.6), -d.u(0.5, 1.6), initial_opening=False)
    elif kind == "tilts":
        d.part("foot", box((-r, y, 0), (r, y + 2 * r, post + r)))
        g = max(play, 0.0) if d.hand.has_bore else play
        d.part("screen", capsule(r, (-2 * r, y - r - g, post), (2 * r, y - r - g, post)))
        d.hinge("screen", "foot", X, (0, y - r - g, post), 0.3, -0.4, initial_opening=False)
    else:
        d.part("foot", box((-r, y, 0), (r, y + r, post + 0.2 * h)))
        g = d.gap(r)
        d.part("screen", box((-2.2 * r, t - 0.002, post - 3 * r), (2.2 * r, y + 2.2 * r, post + 3 * r)))
        d.cut("screen", box((-r - g, y - g, 0), (r + g, y + r + g, 10)) if d.hand.has_bore else box((-r, y, 0), (r,
            y + r,
            10)))
        d.slide("screen", "foot", Z, d.u(0.1, 0.3) * h, -0.1 * h, initial_opening=False)
    d.part("screen", box((-w / 2, 0, z), (w / 2, t, z + h)), material="plastic")
