"""Knobs, switches, levers and panels of controls."""

from __future__ import annotations

from itertools import pairwise
from math import cos, sin
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.kind import angle, choice, kind, length, whole, yes
from kinematify.generate.library.mechanisms import button, knob
from kinematify.generate.library.panels import seam
from kinematify.generate.procedural.builder import spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, prism, slab, vector

if TYPE_CHECKING:
    from kinematify.generate.procedural.builder import ObjectBuilder


@kind(
    "rocker plate",
    words="rocker switch plate",
    like="switch_panel",
    number=whole(1, 4, words="rocker, switch"),
    a=length(0.012, 0.06),
    b=length(0.025, 0.07),
    thick=length(0.006, 0.02),
    upright=yes(0.8),
    tip=angle(0.06, 0.22),
    high=length(0.002, 0.007),
    level=yes(0.4),
    form=choice(("flat", "hollow", "raised")),
)
def rocker_plate(
    d: ObjectBuilder,
    number: int,
    a: float,
    b: float,
    thick: float,
    upright: bool,
    tip: float,
    high: float,
    level: bool,
    form: str,
) -> None:
    """Rockers in a row in a plate on a wall or on a box: each tips about its middle, and stands level or tipped."""
    wide = a * number * d.draw(1.05, 1.4)
    tall = b * d.draw(1.2, 1.8)
    if not upright:
        wide = a * d.draw(1.2, 1.8)
        tall = b * number * d.draw(1.05, 1.3)
    d.part("plate", slab(wide / 2, (0, thick), tall / 2))
    if d.maybe(0.4):
        d.part("plate", slab(0.45 * wide, (thick / 2, d.draw(0.03, 0.06)), 0.45 * tall))
    deep = d.draw(0.3, 0.9) * thick if d.style.has_bore else d.pick(0, 0.3 * thick)
    play1 = d.gap(a) + 0.0003
    for k in range(number):
        x, z = (spread(number, -wide / 2, wide / 2)[k], 0) if upright else (0, spread(number, -tall / 2, tall / 2)[k])
        half = 0.46 * b
        turn = 0 if level else d.pick(-tip, tip)
        middle = {"flat": high, "hollow": 0.4 * high, "raised": 1.5 * high}[form]
        corners = [(deep, -half), (deep, half), (-high, half), (-middle, 0), (-high, -half)]
        turned = [(y * cos(turn) - s * sin(turn), z + y * sin(turn) + s * cos(turn)) for y, s in corners]
        reach = half + (deep + high) * sin(tip) + play1
        d.bore(
            "plate",
            box(
                (x - 0.46 * a - play1, -1, z - reach), (x + 0.46 * a + play1, deep + half * sin(tip) + play1, z + reach)
            ),
        )
        name = f"rocker_{k}"
        d.part(name, prism([(y, s) for y, s in turned], (x, 0, 0), 0.92 * a, "x"))
        lower, upper = (-tip, tip) if level else (0, 2 * tip) if turn < 0 else (-2 * tip, 0)
        d.hinge(name, parent="plate", axis=X, pivot=(x, 0, z), upper=upper, lower=lower, ajar=False)


@kind(
    "toggle plate",
    words="toggle switch plate",
    like="switch_panel",
    number=whole(1, 4, words="toggle, switch, lever"),
    thick=length(0.005, 0.03),
    length=length(0.01, 0.05),
    lean=angle(0.2, 0.6),
    form=choice(("rod", "cone", "bar")),
    foot=choice(("barrel", "barrel", "ball", "none")),
    flat=yes(0.25),
)
def toggle_plate(
    b: ObjectBuilder, number: int, thick: float, length: float, lean: float, form: str, foot: str, flat: bool
) -> None:
    """Sticks that lean up or down out of a plate, on a barrel, on a ball, or just in the plate."""
    wide = number * b.draw(1.2, 2.5) * length
    tall = b.draw(2.2, 4) * length
    b.part("plate", slab(wide / 2, (0, thick), tall / 2))
    r = b.draw(0.08, 0.2) * length
    for k, x in enumerate(spread(number, -wide / 2, wide / 2)):
        turn = b.pick(-lean, lean)
        out = -cos(turn) * Y + sin(turn) * Z
        at = x * X + b.pick(0, 0.3 * thick) * Y
        play1 = b.gap(r) + 0.0002
        name = f"toggle_{k}"
        if foot == "ball":
            b.bore("plate", ball(1.6 * r + play1, at))
            b.part(name, ball(1.6 * r, at))
        else:
            wide = 2 * r + play1
            b.bore("plate", b.cylinder(1.6 * r + 1.5 * play1, at - wide * X, at + wide * X))
            if foot == "barrel":
                b.part(name, b.cylinder(1.6 * r, at - 2 * r * X, at + 2 * r * X))
        if not b.style.has_bore and b.maybe():
            b.part("plate", b.cylinder(2 * r, x * X + 0.1 * thick * Y, x * X - 1.2 * r * Y))
        b.part(
            name,
            {
                "rod": b.rod(r, at, at + length * out),
                "cone": b.cone(0.7 * r, 1.3 * r, at, at + length * out),
                "bar": beam(3 * r if flat else 1.5 * r, 1.5 * r, at, at + length * out),
            }[form],
            look="metal",
        )
        if turn < 0:
            b.hinge(name, parent="plate", axis=-X, pivot=at, upper=2 * lean, ajar=False)
        else:
            b.hinge(name, parent="plate", axis=X, pivot=at, upper=2 * lean, ajar=False)


@kind(
    "button plate",
    like="button_panel",
    columns=whole(1, 4),
    rows=whole(1, 3),
    a=length(0.008, 0.05),
    is_round=yes(0.5),
    collar=yes(0.3),
)
def button_plate(b: ObjectBuilder, columns: int, rows: int, a: float, is_round: bool, collar: bool) -> None:
    """Push-buttons in a row or a grid, round or square, proud of a panel, in rings or deep in it."""
    wide = columns * a * b.draw(1.3, 2.2)
    tall = rows * a * b.draw(1.3, 2.2)
    thick = b.draw(0.3, 1) * a
    b.part("panel", slab(wide / 2, (0, thick), tall / 2), look="metal")
    high = b.draw(0.1, 0.5) * a
    size = (a, a * b.draw(0.5, 1))
    for i, z in enumerate(spread(rows, -tall / 2, tall / 2)):
        for k, x in enumerate(spread(columns, -wide / 2, wide / 2)):
            if collar:
                b.part("panel", b.cylinder(0.62 * a, (x, 0.01 * a, z), (x, -0.4 * high, z)))
            button(
                b,
                f"button_{i}_{k}",
                parent="panel",
                at=(x, 0, z),
                size=(a, a) if is_round else size,
                high=high,
                out=-Y,
                is_round=is_round,
            )


@kind(
    "raised key pad",
    like="button_panel",
    columns=whole(2, 4),
    rows=whole(1, 3),
    a=length(0.006, 0.015),
    thick=length(0.008, 0.03),
    is_round=yes(0.4),
    high=length(0.001, 0.005),
)
def key_pad(b: ObjectBuilder, columns: int, rows: int, a: float, thick: float, is_round: bool, high: float) -> None:
    """A remote control, a telephone, a calculator: keys on a slab that lies flat."""
    wide = columns * a * b.draw(1.1, 1.6)
    deep = rows * a * b.draw(1.2, 3)
    b.part("slab", slab(wide / 2, (-deep / 2, deep / 2 + b.pick(0, 0.05)), (0, thick)))
    for i, y in enumerate(spread(rows, -deep / 2, deep / 2)):
        for k, x in enumerate(spread(columns, -wide / 2, wide / 2)):
            button(
                b,
                f"key_{i}_{k}",
                parent="slab",
                at=(x, y, thick),
                size=(0.8 * a, 0.8 * a),
                high=high,
                out=Z,
                is_round=is_round,
            )


@kind(
    "plain faucet",
    like="faucet",
    radius=length(0.012, 0.025),
    reach=angle(0.08, 0.22),
    swings=yes(0.7),
    form=choice(("bend", "straight", "square")),
    kind=choice(("side", "two levers", "two knobs", "back")),
)
def plain_faucet(b: ObjectBuilder, radius: float, reach: float, swings: bool, form: str, kind: str) -> None:
    """A column, a spout that swings or stands fast, and one lever, two levers or two knobs."""
    h = b.draw(5, 10) * radius
    b.part("base", b.cylinder(1.6 * radius, 0, 0.012), b.cylinder(radius, 0, 0.6 * h), look="metal")
    play = seam(b, radius, 0.02)
    z = 0.6 * h + play
    spout = "spout" if swings else "base"
    at = vector(0, 0, z)
    top = at + max(h - z, 0.02) * Z
    if form == "bend":
        points = [top + 0.5 * reach * (-(1 - cos(a)) * Y + sin(a) * Z) for a in np.linspace(0, 2.8, 8)]
        b.part(spout, b.cylinder(0.9 * radius, at, top), [b.rod(0.8 * radius, p, q) for p, q in pairwise(points)])
    elif form == "straight":
        b.part(
            spout,
            b.cylinder(radius, at, top),
            b.cylinder(0.7 * radius, top - 0.5 * radius * Z, top - reach * Y + b.draw(0, 0.3) * reach * Z),
        )
    else:
        b.part(
            spout,
            slab(radius, radius, (z, h)),
            slab(0.8 * radius, (-reach, 0), (h - 0.8 * radius, h)),
        )
    if not swings:
        b.part("base", b.cylinder(0.9 * radius, (0, 0, 0), top))
    else:
        b.hinge("spout", parent="base", axis=Z, pivot=at, upper=b.draw(0.8, 2), lower=-b.draw(0.8, 2), ajar=False)
    sides = (-1, 1) if kind[:3] == "two" else (b.pick(-1, 1),)
    for k, s in enumerate(sides):
        name = f"handle_{k}"
        play1 = b.gap(radius)
        if kind in ("side", "back"):
            out = s * X if kind == "side" else Y
            foot = radius * b.draw(1, 2) * out + 0.35 * h * Z
            b.part("base", b.cylinder(0.7 * radius, 0.35 * h * Z, foot))
            along = np.cross(Z, abs(out))
            length = b.draw(2, 5) * radius
            axis = np.cross(-along, Z) if kind == "side" else np.cross(along, Z)
            if b.maybe():
                along = Z
                length = min(length, 0.2 * h)
            b.part(
                name,
                b.cylinder(0.8 * radius, foot + (play1 if b.style.has_bore else 0) * out, foot + radius * out),
                b.cylinder(0.25 * radius, foot + 0.6 * radius * out, foot + 0.6 * radius * out + length * along),
                look="metal",
            )
            b.hinge(name, parent="base", axis=axis, pivot=foot, upper=b.draw(0.5, 1.6), ajar=False)
        else:
            x = s * b.draw(0.06, 0.1)
            b.part(
                "base",
                b.cylinder(radius, (x, 0, 0), (x, 0, 0.3 * h)),
                slab((x, 0), 0.6 * radius, (0, 0.01)),
            )
            if kind == "two knobs":
                knob(
                    b,
                    name,
                    parent="base",
                    at=(x, 0, 0.3 * h),
                    radius=1.3 * radius,
                    high=1.5 * radius,
                    out=Z,
                    reach=b.pick(None, 3),
                )
            else:
                low = 0.3 * h + play1 - (0 if b.style.has_bore else b.pick(0, 0.3 * radius))
                along = b.pick(s * X, -Y)
                b.part(
                    name,
                    b.cylinder(0.9 * radius, (x, 0, low), (x, 0, 0.3 * h + radius)),
                    beam(
                        0.6 * radius,
                        0.4 * radius,
                        (x, 0, 0.3 * h + 0.7 * radius),
                        vector(x, 0, 0.3 * h + 0.7 * radius) + 4 * radius * along,
                    ),
                    look="metal",
                )
                b.hinge(name, parent="base", axis=s * Z, pivot=(x, 0, 0.3 * h), upper=b.draw(0.8, 1.8), ajar=False)


@kind("dial plate", like="control_box", number=whole(1, 5, words="dial, knob"), radius=length(0.008, 0.05))
def dial_plate(b: ObjectBuilder, number: int, radius: float) -> None:
    """Plain discs, blocks and caps that turn on a panel, and now and then a fader beside them."""
    wide = number * radius * b.draw(2.5, 4)
    tall = radius * b.draw(2.5, 6)
    thick = b.draw(0.5, 2) * radius
    tilt = b.pick(0, 0, b.draw(0.2, 0.6)) * tall
    b.part(
        "panel",
        prism(
            [(0, -tall / 2), (tilt + thick, -tall / 2), (tilt + thick, tall / 2), (0, tall / 2)], (0, 0, 0), wide, "x"
        ),
        look="metal",
    )
    high = b.draw(0.3, 1.2) * radius
    ended = b.pick(None, 2, 4.7)
    for k, x in enumerate(spread(number, -wide / 2, wide / 2)):
        knob(
            b,
            f"dial_{k}",
            parent="panel",
            at=(x, 0, b.pick(0, 0.1) * tall),
            radius=radius,
            high=high,
            out=-Y,
            reach=ended,
        )
    if b.maybe(0.3):
        play = seam(b, radius, 0.3 * radius)
        travel = 0.6 * wide
        z = -0.42 * tall
        b.part(
            "fader",
            box(
                (-travel / 2, -play - 0.5 * radius, z - 0.1 * radius),
                (-travel / 2 + 0.5 * radius, -play, z + 0.3 * radius),
            ),
        )
        b.slide("fader", parent="panel", axis=X, upper=travel - 0.5 * radius, ajar=b.maybe())
