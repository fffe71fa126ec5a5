"""What is pressed, tipped and turned: switches, keys, dials and taps, plain on a plate or standing in it."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import button, knob
from benchmarks.recipes.object_builder import spread
from benchmarks.recipes.panels import seam
from benchmarks.recipes.shapes import X, Y, Z, ball, beam, box, capsule, cone, prism, rod

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def rocker_plate(d: ObjectBuilder) -> None:
    """Rockers in a row in a plate on a wall or on a box: each tips about its middle, and stands level or tipped."""
    n, a, b = d.n(1, 4), d.u(0.012, 0.06), d.u(0.025, 0.07)
    thick, upright = d.u(0.006, 0.02), d.maybe(0.8)
    wide, tall = a * n * d.u(1.05, 1.4), b * d.u(1.2, 1.8)
    if not upright:
        wide, tall = a * d.u(1.2, 1.8), b * n * d.u(1.05, 1.3)
    d.part("plate", box((-wide / 2, 0, -tall / 2), (wide / 2, thick, tall / 2)), material="plastic")
    if d.maybe(0.4):  # the box behind it
        d.part("plate", box((-0.45 * wide, thick / 2, -0.45 * tall), (0.45 * wide, d.u(0.03, 0.06), 0.45 * tall)))
    tip, high = d.u(0.06, 0.22), d.u(0.002, 0.007)
    deep = d.u(0.3, 0.9) * thick if d.hand.has_bore else d.pick(0.0, 0.3 * thick)
    gap = d.gap(a) + 0.0003
    level = d.maybe(0.4)
    form = d.pick("flat", "hollow", "raised")
    for k in range(n):
        x, z = (spread(n, -wide / 2, wide / 2)[k], 0.0) if upright else (0.0, spread(n, -tall / 2, tall / 2)[k])
        half, turn = 0.46 * b, 0.0 if level else d.pick(-tip, tip)
        middle = {"flat": high, "hollow": 0.4 * high, "raised": 1.5 * high}[form]
        # Corners in front of the plate (-y) and in it, tipped about the middle of the face.
        corners = [(deep, -half), (deep, half), (-high, half), (-middle, 0.0), (-high, -half)]
        turned = [(y * np.cos(turn) - s * np.sin(turn), z + y * np.sin(turn) + s * np.cos(turn)) for y, s in corners]
        reach = half + (deep + high) * np.sin(tip) + gap
        d.bore("plate", box((x - 0.46 * a - gap, -1, z - reach), (x + 0.46 * a + gap, deep + half * np.sin(tip) + gap,
            z + reach)))
        name = f"rocker_{k}"
        d.part(name, prism([(float(y), float(s)) for y, s in turned], (x, 0, 0), 0.92 * a, "x"), material="plastic")
        lower, upper = (-tip, tip) if level else ((0.0, 2 * tip) if turn < 0 else (-2 * tip, 0.0))
        d.hinge(name, "plate", X, (x, 0, z), upper, lower, initial_opening=False)


def toggle_plate(d: ObjectBuilder) -> None:
    """Sticks that lean up or down out of a plate, on a barrel, on a ball, or just in the plate."""
    n, thick, length = d.n(1, 4), d.u(0.005, 0.03), d.u(0.01, 0.05)
    wide, tall = n * d.u(1.2, 2.5) * length, d.u(2.2, 4.0) * length
    d.part("plate", box((-wide / 2, 0, -tall / 2), (wide / 2, thick, tall / 2)), material="plastic")
    lean, r = d.u(0.2, 0.6), d.u(0.08, 0.2) * length
    form, foot, flat = d.pick("rod", "cone", "bar"), d.pick("barrel", "barrel", "ball", "none"), d.maybe(0.25)
    for k, x in enumerate(spread(n, -wide / 2, wide / 2)):
        turn = d.pick(-lean, lean)
        out = -np.cos(turn) * Y + np.sin(turn) * Z
        at = x * X + d.pick(0.0, 0.3 * thick) * Y
        gap = d.gap(r) + 0.0002
        name = f"toggle_{k}"
        if foot == "ball":
            d.bore("plate", ball(1.6 * r + gap, at))
            d.part(name, ball(1.6 * r, at))
        else:
            wide = 2.0 * r + gap
            d.bore("plate", rod(1.6 * r + 1.5 * gap, at - wide * X, at + wide * X))
            if foot == "barrel":
                d.part(name, rod(1.6 * r, at - 2.0 * r * X, at + 2.0 * r * X))
        if not d.hand.has_bore and d.maybe():
            d.part("plate", rod(2.0 * r, x * X + 0.1 * thick * Y, x * X - 1.2 * r * Y))
        d.part(name, {"rod": capsule(r, at, at + length * out), "cone": cone(0.7 * r, 1.3 * r, at,
            at + length * out), "bar": beam(3.0 * r if flat else 1.5 * r, 1.5 * r, at, at + length * out)}[form],
            material="metal")
        if turn < 0:
            d.hinge(name, "plate", -X, at, 2 * lean, initial_opening=False)
        else:
            d.hinge(name, "plate", X, at, 2 * lean, initial_opening=False)


def button_plate(d: ObjectBuilder) -> None:
    """Push-buttons in a row or a grid, round or square, proud of a panel, in rings or deep in it."""
    columns, rows, a = d.n(1, 4), d.n(1, 3), d.u(0.008, 0.05)
    wide, tall, thick = columns * a * d.u(1.3, 2.2), rows * a * d.u(1.3, 2.2), d.u(0.3, 1.0) * a
    d.part("panel", box((-wide / 2, 0, -tall / 2), (wide / 2, thick, tall / 2)), material="metal")
    is_round, collar = d.maybe(), d.maybe(0.3)
    high, size = d.u(0.1, 0.5) * a, (a, a * d.u(0.5, 1.0))
    for i, z in enumerate(spread(rows, -tall / 2, tall / 2)):
        for k, x in enumerate(spread(columns, -wide / 2, wide / 2)):
            if collar:
                d.part("panel", rod(0.62 * a, (x, 0.01 * a, z), (x, -0.4 * high, z)))
            button(d, f"button_{i}_{k}", "panel", (x, 0, z), (a, a) if is_round else size, high, -Y, is_round=is_round)


def dial_plate(d: ObjectBuilder) -> None:
    """Plain discs, blocks and caps that turn on a panel, and now and then a fader beside them."""
    n, r = d.n(1, 5), d.u(0.008, 0.05)
    wide, tall, thick = n * r * d.u(2.5, 4.0), r * d.u(2.5, 6.0), d.u(0.5, 2.0) * r
    tilt = d.pick(0.0, 0.0, d.u(0.2, 0.6)) * tall  # a desk whose front leans back
    d.part("panel", prism([(0, -tall / 2), (tilt + thick, -tall / 2), (tilt + thick, tall / 2), (0, tall / 2)],
        (0, 0, 0), wide, "x"), material="metal")
    high = d.u(0.3, 1.2) * r
    ended = d.pick(None, 2.0, 4.7)
    for k, x in enumerate(spread(n, -wide / 2, wide / 2)):
        knob(d, f"dial_{k}", "panel", (x, 0, d.pick(0.0, 0.1) * tall), r, high, -Y, reach=ended)
    if d.maybe(0.3):
        play, travel = seam(d, r, 0.3 * r), 0.6 * wide
        z = -0.42 * tall
        d.part("fader", box((-travel / 2, -play - 0.5 * r, z - 0.1 * r), (-travel / 2 + 0.5 * r, -play, z + 0.3 * r)))
        d.slide("fader", "panel", X, travel - 0.5 * r, initial_opening=d.maybe())


def key_pad(d: ObjectBuilder) -> None:
    """A remote control, a telephone, a calculator: keys on a slab that lies flat."""
    columns, rows, a = d.n(2, 4), d.n(1, 3), d.u(0.006, 0.015)
    wide, deep, thick = columns * a * d.u(1.1, 1.6), rows * a * d.u(1.2, 3.0), d.u(0.008, 0.03)
    d.part("slab", box((-wide / 2, -deep / 2, 0), (wide / 2, deep / 2 + d.pick(0.0, 0.05), thick)), material="plastic")
    is_round, high = d.maybe(0.4), d.u(0.001, 0.005)
    for i, y in enumerate(spread(rows, -deep / 2, deep / 2)):
        for k, x in enumerate(spread(columns, -wide / 2, wide / 2)):
            button(d, f"key_{i}_{k}", "slab", (x, y, thick), (0.8 * a, 0.8 * a), high, Z, is_round=is_round)


def plain_faucet(d: ObjectBuilder) -> None:
    """A column, a spout that swings or stands fast, and one lever, two levers or two knobs."""
    r, reach = d.u(0.012, 0.025), d.u(0.08, 0.22)
    h = d.u(5.0, 10.0) * r
    d.part("base", rod(1.6 * r, (0, 0, 0), (0, 0, 0.012)), rod(r, (0, 0, 0), (0, 0, 0.6 * h)), material="metal")
    swings, form = d.maybe(0.7), d.pick("bend", "straight", "square")
    play = seam(d, r, 0.02)
    z = 0.6 * h + play
    spout = "spout" if swings else "base"
    at = np.array([0.0, 0.0, z])
    top = at + max(h - z, 0.02) * Z
    if form == "bend":
        points = [top + 0.5 * reach * (-(1.0 - np.cos(a)) * Y + np.sin(a) * Z) for a in np.linspace(0, 2.8, 8)]
        d.part(spout, rod(0.9 * r, at, top), *(capsule(0.8 * r, p, q) for p, q in pairwise(points)))
    elif form == "straight":
        d.part(spout, rod(r, at, top), rod(0.7 * r, top - 0.5 * r * Z, top - reach * Y + d.u(0.0, 0.3) * reach * Z))
    else:
        d.part(spout, box((-r, -r, z), (r, r, h)), box((-0.8 * r, -reach, h - 0.8 * r), (0.8 * r, 0, h)))
    if not swings:
        d.part("base", rod(0.9 * r, (0, 0, 0), top))
    else:
        d.hinge("spout", "base", Z, at, d.u(0.8, 2.0), -d.u(0.8, 2.0), initial_opening=False)
    kind = d.pick("side", "two levers", "two knobs", "back")
    sides = (-1.0, 1.0) if kind.startswith("two") else (d.pick(-1.0, 1.0),)
    for k, s in enumerate(sides):
        name, gap = f"handle_{k}", d.gap(r)
        if kind in {"side", "back"}:
            out = s * X if kind == "side" else Y
            foot = r * d.u(1.0, 2.0) * out + 0.35 * h * Z
            d.part("base", rod(0.7 * r, 0.35 * h * Z, foot))
            along, length = np.cross(Z, np.abs(out)), d.u(2.0, 5.0) * r
            axis = np.cross(-along, Z) if kind == "side" else np.cross(along, Z)
            if d.maybe():  # it stands up
                along, length = Z, min(length, 0.2 * h)
            d.part(name, rod(0.8 * r, foot + (gap if d.hand.has_bore else 0.0) * out, foot + r * out), rod(0.25 * r,
                foot + 0.6 * r * out, foot + 0.6 * r * out + length * along), material="metal")
            d.hinge(name, "base", axis, foot, d.u(0.5, 1.6), initial_opening=False)
        else:
            x = s * d.u(0.06, 0.1)
            d.part("base", rod(r, (x, 0, 0), (x, 0, 0.3 * h)), box((x, -0.6 * r, 0), (0, 0.6 * r, 0.01)))
            if kind == "two knobs":
                knob(d, name, "base", (x, 0, 0.3 * h), 1.3 * r, 1.5 * r, Z, reach=d.pick(None, 3.0))
            else:
                low = 0.3 * h + gap - (0.0 if d.hand.has_bore else d.pick(0.0, 0.3 * r))
                along = d.pick(s * X, -Y)
                d.part(name, rod(0.9 * r, (x, 0, low), (x, 0, 0.3 * h + r)), beam(0.6 * r, 0.4 * r, (x, 0,
                    0.3 * h + 0.7 * r), np.array([x, 0, 0.3 * h + 0.7 * r]) + 4.0 * r * along), material="metal")
                d.hinge(name, "base", s * Z, (x, 0, 0.3 * h), d.u(0.8, 1.8), initial_opening=False)
