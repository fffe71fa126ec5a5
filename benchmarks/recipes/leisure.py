"""Toys, instruments, sport, office, laboratory, medicine, doors and windows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import (
    bail,
    button,
    case,
    caster,
    crank,
    drawer,
    knob,
    leaf,
    legs,
    lever,
    plunger,
    wheel,
)
from benchmarks.recipes.object_builder import spread
from benchmarks.recipes.shapes import (
    X,
    Y,
    Z,
    ball,
    beam,
    block,
    box,
    capsule,
    cone,
    prism,
    ring,
    rod,
    tube,
)

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def toy_train(d: ObjectBuilder) -> None:
    """A locomotive of blocks with four to eight wheels."""
    n, w, r = d.u(0.12, 0.3), d.u(0.04, 0.08), d.u(0.012, 0.025)
    d.part("engine", box((-n / 2, -w / 2, r), (n / 2, w / 2, 2.5 * r)), rod(0.4 * w, (-0.1 * n, 0, 2.5 * r + 0.3 * w),
        (n / 2, 0, 2.5 * r + 0.3 * w)), box((-n / 2, -w / 2, 2 * r), (-0.1 * n, w / 2, 2.5 * r + 1.2 * w)),
        rod(0.15 * w, (0.35 * n, 0, 2.5 * r), (0.35 * n, 0, 2.5 * r + 1.1 * w)), material="wood")
    for i, x in enumerate(spread(d.n(2, 4), -0.48 * n, 0.48 * n)):
        for s in (-1.0, 1.0):
            wheel(d, f"wheel_{i}_{int(s > 0)}", "engine", (x, s * (w / 2 + 0.35 * r), r), min(r, 0.11 * n), 0.4 * r,
                s * Y, axle=0.15 * r)


def pull_along_animal(d: ObjectBuilder) -> None:
    """A body on wheels, a head that nods, a tail that wags."""
    k = d.u(0.08, 0.2)
    d.part("body", capsule(0.35 * k, (-0.5 * k, 0, 0.8 * k), (0.5 * k, 0, 0.8 * k)), *(box((x * k - 0.1 * k, -0.3 * k,
        0.2 * k), (x * k + 0.1 * k, 0.3 * k, 0.7 * k)) for x in (-0.45, 0.45)), material="wood")
    g = d.gap(0.1 * k)
    x = 0.85 * k + g
    d.part("head", ball(0.3 * k, (x + 0.3 * k, 0, 1.1 * k)), cone(0.12 * k, 0.05 * k, (x + 0.5 * k, 0, 1.05 * k),
        (x + 0.75 * k, 0, 1.0 * k)))
    d.hinge("head", "body", Y, (x + (0.3 * k if d.hand.has_bore else 0.0), 0, 1.1 * k), 0.25, -0.25,
        initial_opening=False)
    d.part("tail", capsule(0.06 * k, (-0.9 * k - g, 0, 0.95 * k), (-1.2 * k, 0, 1.3 * k)))
    d.hinge("tail", "body", X if d.maybe() else Z, (-0.9 * k - g, 0, 0.95 * k), 0.3, -0.3, initial_opening=False)
    for i, x in enumerate((-0.45 * k, 0.45 * k)):
        for s in (-1.0, 1.0):
            wheel(d, f"wheel_{i}_{int(s > 0)}", "body", (x, s * 0.38 * k, 0.22 * k), 0.22 * k, 0.1 * k, s * Y,
                axle=0.03 * k)


def articulated_doll(d: ObjectBuilder) -> None:
    """Arms, legs and a head on a torso."""
    k = d.u(0.1, 1.0)
    g = d.gap(0.05 * k)
    d.part("torso", box((-0.18 * k, -0.1 * k, 0.5 * k), (0.18 * k, 0.1 * k, 0.95 * k)), rod(0.05 * k, (0, 0, 0.94 * k),
        (0, 0, 1.0 * k)), material="wood")
    d.part("head", ball(0.13 * k, (0, 0, 1.13 * k + g)))
    d.hinge("head", "torso", Z, (0, 0, 1.0 * k), 1.3, -1.3, initial_opening=False)
    for s, side in ((-1.0, "right"), (1.0, "left")):
        x = s * (0.18 * k + g)
        top = np.array([x + s * 0.05 * k, 0, 0.9 * k])
        d.part(f"arm_{side}", capsule(0.05 * k, top, top - 0.4 * k * Z))
        d.hinge(f"arm_{side}", "torso", -X, (x, 0, 0.9 * k), 2.5, -0.5, initial_opening=False)
        hip = np.array([s * 0.09 * k, 0, 0.5 * k - g])
        d.part(f"leg_{side}", rod(0.07 * k, hip, hip - 0.25 * k * Z) if d.hand.has_bore else capsule(0.07 * k,
            hip - 0.03 * k * Z, hip - 0.25 * k * Z))
        d.hinge(f"leg_{side}", "torso", -X, hip, 0.02 if d.hand.has_bore else 1.2,
            -0.02 if d.hand.has_bore else -0.4, initial_opening=False)
        if d.maybe():
            knee = hip - (0.25 * k + g + (0.07 * k if not d.hand.has_bore else 0.0)) * Z
            d.part(f"shin_{side}", rod(0.06 * k, knee, knee - 0.18 * k * Z), box((knee[0] - 0.06 * k, -0.16 * k,
                knee[2] - 0.22 * k), (knee[0] + 0.06 * k, 0.06 * k, knee[2] - 0.17 * k)))
            d.hinge(f"shin_{side}", f"leg_{side}", X, knee, 0.02 if d.hand.has_bore else 1.5, initial_opening=False)


def jack_in_the_box(d: ObjectBuilder) -> None:
    """A lid and a crank at the side."""
    k = d.u(0.08, 0.2)
    case(d, "box", (-k / 2, -k / 2, 0), (k / 2, k / 2, k), opening=Z)
    leaf(d, "lid", "box", (-k / 2, -k / 2, k), (k / 2, k / 2, 1.06 * k), hinge=Y, out=Z, reach=2.2, handle=False)
    crank(d, "crank", "box", (k / 2, 0, 0.5 * k), X, 0.35 * k)


def abacus(d: ObjectBuilder) -> None:
    """Beads that slide on rods."""
    w, n = d.u(0.15, 0.4), d.n(2, 4)
    h, r = 0.18 * w * n, 0.07 * w
    d.part("frame", *(box((s * w / 2, -r, 0), (s * (w / 2 + 0.05 * w), r, h)) for s in (-1, 1)), *(box((-w / 2, -r, z),
        (w / 2, r, z + 0.05 * w)) for z in (0, h - 0.05 * w)), material="wood")
    g = d.gap(r) + 0.0001
    for i, z in enumerate(spread(n, 0.05 * w, h - 0.05 * w)):
        d.part("frame", rod(0.02 * w, (-w / 2, 0, z), (w / 2, 0, z)))
        m = d.n(1, 3)
        for k in range(m):
            x = -w / 2 + (0.06 + 0.13 * k) * w + 0.001
            d.part(f"bead_{i}_{k}", rod(r, (x, 0, z), (x + 0.1 * w, 0, z)), material="wood")
            d.bore(f"bead_{i}_{k}", rod(0.02 * w + 1.5 * g, (x - 1, 0, z), (x + 1, 0, z)))
            if k == m - 1:
                d.slide(f"bead_{i}_{k}", "frame", X, 0.4 * w, initial_opening=False)
            else:
                d.slide(f"bead_{i}_{k}", "frame", X, 0.02 * w, initial_opening=False)


def gyroscope(d: ObjectBuilder) -> None:
    """A wheel in a ring in a ring."""
    r = d.u(0.03, 0.3)
    g = d.gap(0.05 * r) + 0.0002
    c = np.array([0, 0, 1.7 * r])
    d.part("stand", rod(0.8 * r, (0, 0, 0), (0, 0, 0.1 * r)), *(beam(0.1 * r, 0.1 * r, (s * 1.5 * r, 0, 0.05 * r),
        (s * 1.5 * r, 0, 1.75 * r), Y) for s in (-1, 1)), beam(0.1 * r, 0.1 * r, (-1.5 * r, 0, 0.05 * r), (1.5 * r, 0,
        0.05 * r)), material="metal")
    d.part("gimbal", tube(1.38 * r, 1.25 * r, c - 0.06 * r * Y, c + 0.06 * r * Y), *(rod(0.04 * r, c + s * 1.3 * r * X,
        c + s * 1.55 * r * X) for s in (-1, 1)), material="metal")
    d.bore("stand", rod(0.04 * r + 1.5 * g, c - 2 * r * X, c + 2 * r * X))
    d.spin("gimbal", "stand", X, c)
    d.part("wheel", rod(1.0 * r, c - 0.08 * r * Y, c + 0.08 * r * Y), rod(0.04 * r, c - 1.24 * r * Z, c + 1.24 * r * Z),
        material="metal")
    d.part("gimbal", *(rod(0.06 * r, c + s * 1.245 * r * Z, c + s * 1.3 * r * Z) for s in (-1, 1)))
    d.spin("wheel", "gimbal", Z, c)


def upright_piano(d: ObjectBuilder) -> None:
    """Keys, a fallboard, pedals, a lid."""
    w, n = 1.0 * d.u(0.6, 1.4), d.n(5, 10)
    d.part("piano", box((-w / 2, 0, 0), (w / 2, 0.35, 1.2)), box((-w / 2, -0.25, 0.6), (w / 2, 0.01, 0.65)),
        *(box((s * w / 2, -0.28, 0), (s * (w / 2 - 0.04), 0.01, 0.8)) for s in (-1, 1)), material="wood")
    g = max(d.gap(0.05), 0.0005)
    for k, x in enumerate(spread(n, -w / 2 + 0.05, w / 2 - 0.05)):
        a = (w - 0.1) / n / 2 - g
        d.part(f"key_{k}", box((x - a, -0.2, 0.665), (x + a, -g, 0.685)))
        d.hinge(f"key_{k}", "piano", X, (x, -g, 0.665), 0.05, initial_opening=False)
    for k, x in enumerate((-0.08, 0.08)):
        d.part(f"pedal_{k}", box((x - 0.02, -0.12, 0.06), (x + 0.02, -g, 0.075)), material="metal")
        d.hinge(f"pedal_{k}", "piano", X, (x, -g, 0.06), 0.15, initial_opening=False)
    leaf(d, "lid", "piano", (-w / 2, 0, 1.2), (w / 2, 0.35, 1.22), hinge=Y, out=Z, reach=1.5, handle=False)


def mixing_console(d: ObjectBuilder) -> None:
    """Faders in slots, knobs in a grid and pads on a desk: a mixer."""
    w, t, n = d.u(0.3, 0.9), d.u(0.25, 0.45), d.n(2, 5)
    case(d, "console", (-w / 2, 0, 0), (w / 2, t, 0.06), material="steel")
    g = d.gap(0.005) + 0.0002
    for k, x in enumerate(spread(n, -0.46 * w, 0.46 * w)):
        d.cut("console", box((x - 0.003 - g, 0.04, 0.04), (x + 0.003 + g, 0.5 * t, 0.07)))
        y = d.u(0.06, 0.3 * t)
        d.part(f"fader_{k}", box((x - 0.003, y - 0.004, 0.045), (x + 0.003, y + 0.004, 0.07)), box((x - 0.012, y - 0.01,
            0.062), (x + 0.012, y + 0.01, 0.075)))
        d.slide(f"fader_{k}", "console", Y, 0.48 * t - y, 0.05 - y, initial_opening=False)
        for i, q in enumerate(spread(d.n(1, 2), 0.55 * t, 0.95 * t)):
            knob(d, f"knob_{k}_{i}", "console", (x, q, 0.06), 0.01, 0.015, Z, reach=5.0)


def hi_hat(d: ObjectBuilder) -> None:
    """A bass drum pedal, and a hi-hat whose upper cymbal rides on its rod."""
    h, r = d.u(0.7, 1.0), d.u(0.14, 0.2)
    d.part("stand", rod(0.012, (0, 0, 0.02), (0, 0, h - 0.02)), *(rod(0.01, (0, 0, 0.3 * h), (0.3 * np.cos(a),
        0.3 * np.sin(a), 0)) for a in np.arange(3) * 2.1 + 0.5), cone(r, 0.03, (0, 0, h), (0, 0, h - 0.03)), box((-0.05,
        -0.35, 0), (0.05, 0, 0.02)), material="metal")
    g = d.gap(0.01) + 0.0003
    d.part("cymbal", cone(r, 0.03, (0, 0, h + 0.012), (0, 0, h + 0.05)), rod(0.004, (0, 0,
        h - 0.2 if d.hand.has_bore else h + 0.01), (0, 0, h + 0.2)), material="metal")
    d.bore("stand", rod(0.004 + 1.5 * g, (0, 0, h - 0.25), (0, 0, h + 1)))
    d.slide("cymbal", "stand", Z, 0.05, initial_opening=False)
    d.part("pedal", beam(0.08, 0.01, (0, -0.33, 0.03 + g), (0, -0.05, 0.12)), material="metal")
    d.hinge("pedal", "stand", X, (0, -0.33, 0.03 + g), 0.05, -0.25, initial_opening=False)


def metronome(d: ObjectBuilder) -> None:
    """A rod that swings on a tapered case, and a weight on it."""
    h = d.u(0.15, 0.25)
    d.part("case", prism([(-0.35 * h, 0), (0.35 * h, 0), (0.12 * h, h), (-0.12 * h, h)], (0, 0, 0), 0.4 * h, "y"),
        material="wood")
    g = d.gap(0.01) + 0.0003
    y = -0.2 * h - g - 0.004
    d.part("rod", beam(0.008, 0.004, (0, y, 0.2 * h), (0, y, 1.1 * h), Y), rod(0.01, (0, y - 0.004, 0.2 * h), (0,
        y + 0.004, 0.2 * h)), material="metal")
    d.hinge("rod", "case", -Y, (0, y, 0.2 * h), 0.6, -0.6)
    z = d.u(0.5, 0.8) * h
    d.part("weight", box((-0.015, y - 0.012, z), (0.015, y - 0.002 - g, z + 0.025)), material="metal")
    d.slide("weight", "rod", Z, 0.2 * h, -0.1 * h, initial_opening=False)


def wall_clock(d: ObjectBuilder) -> None:
    """Two or three hands about one axis, a pendulum."""
    r = d.u(0.08, 0.25)
    d.part("clock", rod(r, (0, 0, 0), (0, 0.04, 0)), material="wood")
    g = d.gap(0.01) + 0.0005
    y = 0.0
    for name, n, wide in (("hour_hand", 0.5, 0.08), ("minute_hand", 0.8, 0.05), ("second_hand", 0.85, 0.02))[: d.n(2,
        3)]:
        y -= g
        a = d.u(0, 6.28)
        u = np.array([np.cos(a), 0, np.sin(a)])
        d.part(name, beam(wide * r, 0.002, np.array([0, y - 0.001, 0]) - 0.12 * r * u, np.array([0, y - 0.001,
            0]) + n * r * u, Y), rod(0.06 * r, (0, y, 0), (0, y - 0.002, 0)), material="metal")
        d.spin(name, "clock", -Y, (0, 0, 0))
        y -= 0.002
    if d.maybe():
        d.part("clock", box((-0.4 * r, 0.0, -2.6 * r), (-0.35 * r, 0.04, -0.8 * r)), box((0.35 * r, 0.0, -2.6 * r),
            (0.4 * r, 0.04, -0.8 * r)), box((-0.4 * r, 0.03, -2.6 * r), (0.4 * r, 0.04, -0.8 * r)))
        d.part("pendulum", rod(0.02 * r, (0, 0.015, -1.02 * r - g), (0, 0.015, -2.1 * r)), rod(0.15 * r, (0, 0.01,
            -2.2 * r), (0, 0.02, -2.2 * r)), material="metal")
        d.hinge("pendulum", "clock", Y, (0, 0.015, -1.02 * r - g), 0.08, -0.08, initial_opening=False)


def exercise_bike(d: ObjectBuilder) -> None:
    """A flywheel, cranks, a seat post."""
    r = d.u(0.16, 0.24)
    d.part("frame", box((-0.5, -0.25, 0), (-0.42, 0.25, 0.06)), box((0.45, -0.25, 0), (0.53, 0.25, 0.06)), box((-0.45,
        -0.025, 0.02), (0.5, 0.025, 0.07)), beam(0.06, 0.06, (-0.2, 0, 0.05), (-0.25, 0, 0.6)), *(box((0.3 - 0.02,
        s * 0.06 - 0.01, 0.05), (0.32, s * 0.06 + 0.01, 0.08 + 2.3 * r)) for s in (-1, 1)), box((0.28, -0.07,
        0.06 + 2.2 * r), (0.34, 0.07, 1.0)), rod(0.015, (0.31, -0.25, 1.0), (0.31, 0.25, 1.0)), box((-0.05, -0.03,
        0.05), (0.05, 0.03, 0.36)), material="steel")
    g = d.gap(0.02) + 0.0005
    d.part("flywheel", rod(r, (0.3, -0.02, 0.09 + r), (0.3, 0.02, 0.09 + r)), rod(0.012, (0.3, -0.08, 0.09 + r), (0.3,
        0.08, 0.09 + r)), material="steel")
    d.bore("frame", rod(0.012 + 1.5 * g, (0.3, -0.1, 0.09 + r), (0.3, 0.1, 0.09 + r)))
    d.spin("flywheel", "frame", Y, (0.3, 0, 0.09 + r))
    c = np.array([0, 0, 0.3])
    for s in (-1.0, 1.0):
        d.part("cranks", beam(0.012, 0.03, c + s * 0.05 * Y, c + s * 0.05 * Y + s * 0.16 * X),
            box(c + np.array([s * 0.16 - 0.03, s * 0.06, -0.01]), c + np.array([s * 0.16 + 0.03, s * 0.14, 0.01])),
            material="metal")
    d.part("cranks", rod(0.01, c - 0.06 * Y, c + 0.06 * Y))
    d.bore("frame", rod(0.01 + 1.5 * g, c - 0.1 * Y, c + 0.1 * Y))
    d.spin("cranks", "frame", Y, c)
    d.bore("frame", beam(0.05, 0.05, (-0.2, 0, 0.1), (-0.26, 0, 0.72)))
    d.part("seat", beam(0.05 - 2 * g if d.hand.has_bore else 0.05, 0.05 - 2 * g if d.hand.has_bore else 0.05, (-0.21, 0,
        0.2) if d.hand.has_bore else (-0.25, 0, 0.6), (-0.27, 0, 0.8)), box((-0.4, -0.1, 0.8), (-0.15, 0.1, 0.86)))
    d.slide("seat", "frame", np.array([-0.05, 0, 0.55]) / np.hypot(0.05, 0.55), 0.15, initial_opening=False)


def weight_machine(d: ObjectBuilder) -> None:
    """A stack that slides on two rods, an arm that swings."""
    h, w = d.u(1.6, 2.0), 0.5
    d.part("frame", box((-w / 2, -0.2, 0), (w / 2, 0.2, 0.06)), box((-w / 2, -0.05, h), (w / 2, 0.05, h + 0.08)),
        *(box((s * w / 2 - 0.03, -0.04, 0), (s * w / 2 + 0.03, 0.04, h + 0.05)) for s in (-1, 1)), *(rod(0.014,
        (s * 0.12, 0, 0.05), (s * 0.12, 0, h + 0.01)) for s in (-1, 1)), material="steel")
    g = d.gap(0.02) + 0.0003
    n = d.n(1, 3)
    z = 0.06 + g
    for k in range(n):
        t = d.u(0.06, 0.2)
        d.part(f"plate_{k}", box((-0.2, -0.06, z), (0.2, 0.06, z + t)), material="steel")
        d.bore(f"plate_{k}", *(rod(0.014 + 1.5 * g, (s * 0.12, 0, 0), (s * 0.12, 0, h)) for s in (-1, 1)))
        d.slide(f"plate_{k}", "frame", Z, 0.02 if k < n - 1 and d.hand.has_bore else 0.6 * h if k == n - 1 else 0.3,
            initial_opening=False)
        z += t + (0.021 if d.hand.has_bore else 0.0) + g


def basketball_hoop(d: ObjectBuilder) -> None:
    """A ring that folds down on a board, on a base with wheels."""
    h = d.u(1.2, 3.0)
    d.part("stand", box((-0.4, 0, 0), (0.4, 0.7, 0.15)), beam(0.1, 0.1, (0, 0.4, 0.1), (0, 0.4, h), Y), box((-0.55,
        0.05, h - 0.1), (0.55, 0.08, h + 0.65)), beam(0.08, 0.08, (0, 0.4, h - 0.05), (0, 0.07, h)), material="steel")
    g = d.gap(0.05) + 0.0005
    d.part("ring", ring(0.23, 0.01, (0, -0.25, h + 0.02), Z), box((-0.06, -0.03, h), (0.06, 0.05 - g, h + 0.04)),
        material="steel")
    d.hinge("ring", "stand", X, (0, 0.05 - g, h + (0.0 if d.hand.has_bore else 0.02)), 0.6)
    for s in (-1.0, 1.0):
        wheel(d, f"wheel_{int(s > 0)}", "stand", (s * 0.43, 0.1, 0.06), 0.06, 0.04, s * X, axle=0.01)


def table_football(d: ObjectBuilder) -> None:
    """Rods with figures that turn (and slide); here they turn."""
    w, n, z = 0.7, d.u(0.8, 1.3), 0.8
    d.part("table", box((-w / 2, -n / 2, z - 0.25), (w / 2, n / 2, z - 0.2)), *(box((s * w / 2, -n / 2, z - 0.25),
        (s * (w / 2 - 0.03), n / 2, z)) for s in (-1, 1)), *(box((-w / 2, s * n / 2, z - 0.25), (w / 2,
        s * (n / 2 - 0.03), z)) for s in (-1, 1)), material="wood")
    legs(d, "table", (-w / 2, -n / 2, 0), (w / 2, n / 2, z - 0.24), 0.08)
    g = d.gap(0.01) + 0.0003
    for k, y in enumerate(spread(d.n(3, 6), -0.4 * n, 0.4 * n)):
        d.part(f"rod_{k}", rod(0.008, (-w / 2 - 0.25, y, z - 0.06), (w / 2 + 0.15, y, z - 0.06)), rod(0.016,
            (-w / 2 - 0.3, y, z - 0.06), (-w / 2 - 0.18, y, z - 0.06)), *(box((x - 0.015, y - 0.01, z - 0.16),
            (x + 0.015, y + 0.01, z - 0.02)) for x in spread(d.n(1, 4), -0.3, 0.3)), material="metal")
        d.bore("table", rod(0.008 + 1.5 * g, (-w, y, z - 0.06), (w, y, z - 0.06)))
        d.spin(f"rod_{k}", "table", X, (0, y, z - 0.06))


def hole_punch(d: ObjectBuilder) -> None:
    """A lever on a base."""
    n, w = d.u(0.08, 0.15), d.u(0.05, 0.12)
    d.part("base", box((-n / 2, -w / 2, 0), (n / 2, w / 2, 0.012)), *(box((-0.35 * n, s * 0.3 * w, 0.01), (-0.15 * n,
        s * (0.3 * w - 0.004), 0.05)) for s in (-1, 1)), material="steel")
    g = d.gap(0.005) + 0.0002
    half = 0.3 * w - 0.004 - g
    d.part("handle", box((-0.3 * n, -half, 0.035), (0.6 * n, half, 0.045)), *(box((-0.3 * n, s * half, 0.028),
        (-0.2 * n, s * (half - 0.003), 0.04)) for s in (-1, 1)), material="steel")
    if not d.hand.has_bore:
        d.part(d.pick("handle", "base"), rod(0.003, (-0.25 * n, -0.32 * w, 0.035), (-0.25 * n, 0.32 * w, 0.035)))
    d.hinge("handle", "base", Y, (-0.25 * n, 0, 0.035), 0.2, -0.2, initial_opening=False)


def ring_binder(d: ObjectBuilder) -> None:
    """Two covers about a spine, lying open or shut."""
    w, h, t = d.u(0.2, 0.3), d.u(0.25, 0.35), d.u(0.02, 0.08)
    g = d.gap(0.01) + 0.0002
    d.part("spine", box((-0.003, 0, 0), (0.0, h, t)), material="cardboard")
    for k, (z0, z1) in enumerate(((-0.003 - g, -g), (t + g, t + g + 0.003))):
        d.part(f"cover_{k}", box((-0.003, 0, z0), (w, h, z1)), material="cardboard")
        d.hinge(f"cover_{k}", "spine", Y * (1.0 if k == 0 else -1.0), (-0.003, 0, z1 if k == 0 else z0), d.u(1.4, 3.0))


def printer(d: ObjectBuilder) -> None:
    """A scanner lid, a paper tray, an output flap, buttons."""
    w, t, h = d.u(0.35, 0.5), d.u(0.3, 0.45), d.u(0.12, 0.35)
    case(d, "printer", (-w / 2, 0, 0), (w / 2, t, h), material="plastic")
    leaf(d, "lid", "printer", (-w / 2, 0.06, h), (w / 2, t, h + 0.03), hinge=Y, out=Z, reach=1.3, handle=False)
    drawer(d, "tray", "printer", (-0.38 * w, 0, 0.015), (0.38 * w, 0.85 * t, 0.35 * h), out=-Y, handle=d.maybe())
    leaf(d, "flap", "printer", (-0.4 * w, -0.012, 0.45 * h), (0.4 * w, 0, 0.85 * h), hinge=-Z, out=-Y, reach=1.4,
        handle=False)
    for k, x in enumerate(spread(d.n(1, 4), -0.3 * w, 0.3 * w)):
        button(d, f"button_{k}", "printer", (x, 0.03, h), (0.02, 0.015), 0.003, Z, is_round=d.maybe())


def desktop_computer(d: ObjectBuilder) -> None:
    """A side panel that slides or swings, a power button, drive trays."""
    w, t, h = d.u(0.17, 0.22), d.u(0.4, 0.5), d.u(0.38, 0.5)
    case(d, "tower", (-w / 2, 0, 0), (w / 2, t, h), opening=X, wall=0.006, material="steel")
    if d.maybe():
        leaf(d, "panel", "tower", (w / 2, 0, 0), (w / 2 + 0.004, t, h), hinge=Y, out=X, reach=1.6, handle=False,
            material="glass")
    else:
        g = d.gap(0.01)
        d.part("panel", box((w / 2 + g, 0, 0), (w / 2 + g + 0.004, t, h)), material="steel")
        d.slide("panel", "tower", Y, 0.3)
    for k, z in enumerate(spread(d.n(1, 3), 0.6 * h, h - 0.02)):
        drawer(d, f"drive_{k}", "tower", (-0.075, 0, z - 0.012), (0.075, 0.18, z + 0.012), out=-Y, handle=False,
            travel=0.7)
    button(d, "power", "tower", (0, 0, 0.5 * h), (0.02, 0.02), 0.004, -Y, is_round=d.maybe())


def folding_phone(d: ObjectBuilder) -> None:
    """Two halves on a hinge: a phone, a console, a compact, a cigarette case."""
    w, t, a = d.u(0.05, 0.15), d.u(0.05, 0.12), d.u(0.006, 0.015)
    round_ = d.maybe(0.3)
    g = d.gap(0.005) + 0.0001
    d.part("lower", rod(w / 2, (0, 0, 0), (0, 0, a)) if round_ else box((-w / 2, -t / 2, 0), (w / 2, t / 2, a)))
    y = w / 2 if round_ else t / 2
    d.part("upper", rod(w / 2, (0, 0, a + g), (0, 0, 2 * a)) if round_ else box((-w / 2, -t / 2, a + g), (w / 2, t / 2,
        2 * a)))
    if d.hand.barrels and not d.hand.has_bore:
        d.part("lower", rod(0.5 * a, (-0.4 * w, y, a), (-0.2 * w, y, a)), rod(0.5 * a, (0.2 * w, y, a), (0.4 * w, y,
            a)))
        d.part("upper", rod(0.5 * a, (-0.19 * w, y, a), (0.19 * w, y, a)))
    d.hinge("upper", "lower", -X, (0, y, a + (g / 2 if d.hand.gap else 0)), d.u(1.5, 3.0))
    if d.maybe() and not round_:
        for k, x in enumerate(spread(3, -0.35 * w, 0.35 * w)):
            button(d, f"key_{k}", "lower", (x, -t / 2, a / 2), (0.1 * w, 0.4 * a), 0.1 * a, -Y)


def camera_on_tripod(d: ObjectBuilder) -> None:
    """A head that pans and tilts, a lens ring, legs that spread."""
    h = d.u(0.6, 1.5)
    d.part("column", rod(0.016, (0, 0, 0.5 * h), (0, 0, h)), rod(0.035, (0, 0, 0.8 * h), (0, 0, 0.86 * h)),
        material="metal")
    g = d.gap(0.02) + 0.0005
    for k, a in enumerate(np.arange(3) * 2 * np.pi / 3):
        u = np.array([np.cos(a), np.sin(a), 0])
        p = (0.05 + g) * u + 0.84 * h * Z
        d.part(f"leg_{k}", rod(0.012, p, p + 0.4 * h * u - 0.84 * h * Z), material="metal")
        d.hinge(f"leg_{k}", "column", np.cross(Z, u) * -1.0, p, 0.3, -0.3, initial_opening=False)
    d.part("pan", rod(0.03, (0, 0, h + g), (0, 0, h + 0.04)), *(box((s * 0.035 - 0.005, -0.02, h + 0.02),
        (s * 0.035 + 0.005, 0.02, h + 0.1)) for s in (-1, 1)), material="metal")
    d.spin("pan", "column", Z, (0, 0, h))
    d.part("camera", box((-0.03 + g, -0.02, h + 0.05), (0.03 - g, 0.02, h + 0.12)), box((-0.07, -0.03, h + 0.11), (0.07,
        0.03, h + 0.2)), rod(0.03, (0, -0.02, h + 0.155), (0, -0.06, h + 0.155)))
    d.hinge("camera", "pan", X, (0, 0, h + 0.08), 0.3, -0.3, initial_opening=False)
    d.part("lens", tube(0.034, 0.0305 + g, (0, -0.035, h + 0.155), (0, -0.075,
        h + 0.155)) if d.hand.has_bore else rod(0.03, (0, -0.06, h + 0.155), (0, -0.1, h + 0.155)))
    d.spin("lens", "camera", -Y, (0, -0.06, h + 0.155))


def refracting_telescope(d: ObjectBuilder) -> None:
    """An optical tube on a mount with two axes, a focuser that draws out."""
    k = d.u(0.5, 1.2)
    d.part("pier", cone(0.15 * k, 0.08 * k, (0, 0, 0), (0, 0, 0.8 * k)), material="metal")
    g = d.gap(0.03 * k) + 0.0003
    d.part("fork", rod(0.1 * k, (0, 0, 0.8 * k + g), (0, 0, 0.86 * k)), *(box((s * 0.11 * k - 0.015 * k, -0.04 * k,
        0.84 * k), (s * 0.11 * k + 0.015 * k, 0.04 * k, 1.1 * k)) for s in (-1, 1)), box((-0.12 * k, -0.04 * k,
        0.83 * k), (0.12 * k, 0.04 * k, 0.87 * k)), material="metal")
    d.spin("fork", "pier", Z, (0, 0, 0.8 * k))
    c = np.array([0, 0, 1.05 * k])
    d.part("tube", rod(0.07 * k, c - 0.5 * k * Y, c + 0.4 * k * Y), *(rod(0.03 * k, c + s * 0.05 * k * X,
        c + s * (0.095 * k - g) * X) for s in (-1, 1)), material="metal")
    d.hinge("tube", "fork", X, c, 0.35, -0.35, initial_opening=False)
    plunger(d, "focuser", "tube", c + 0.55 * k * Y, c + 0.3 * k * Y, 0.03 * k, travel=0.06 * k)


def centrifuge(d: ObjectBuilder) -> None:
    """A lid over a rotor, a dial in front."""
    r = d.u(0.1, 0.22)
    case(d, "housing", (-1.3 * r, -1.4 * r, 0), (1.3 * r, 1.3 * r, 1.3 * r), material="plastic")
    d.cut("housing", rod(1.1 * r, (0, 0, 0.4 * r), (0, 0, 2 * r)))
    g = d.gap(0.05 * r)
    d.part("rotor", cone(0.95 * r, 0.6 * r, (0, 0, 0.5 * r), (0, 0, 1.0 * r)), rod(0.15 * r, (0, 0, 0.4 * r + g), (0, 0,
        0.55 * r)), material="metal")
    d.spin("rotor", "housing", Z, (0, 0, 0.4 * r))
    leaf(d, "lid", "housing", (-1.25 * r, -1.3 * r, 1.3 * r), (1.25 * r, 1.25 * r, 1.4 * r), hinge=Y, out=Z, reach=1.3)
    for k, x in enumerate(spread(d.n(1, 2), -r, r)):
        knob(d, f"dial_{k}", "housing", (x, -1.4 * r, 0.6 * r), 0.18 * r, 0.15 * r, -Y, reach=4.0)


def hospital_bed(d: ObjectBuilder) -> None:
    """A back section that rises, rails that drop, casters."""
    n, w, z = 2.0, d.u(0.85, 1.0), d.u(0.45, 0.6)
    d.part("frame", box((0, -w / 2, z - 0.1), (n, w / 2, z)), box((0.75, -w / 2, z), (n, w / 2, z + 0.1)), box((-0.03,
        -w / 2, z - 0.2), (0.0, w / 2, z + 0.5)), box((n, -w / 2, z - 0.2), (n + 0.03, w / 2, z + 0.4)),
        *(box((x - 0.04, s * 0.4 * w - 0.04, 0.15), (x + 0.04, s * 0.4 * w + 0.04, z - 0.05)) for x in (0.2,
        n - 0.2) for s in (-1, 1)), material="steel")
    g = d.gap(0.05) + 0.0005
    d.part("back", box((0.03, -w / 2 + 0.02, z + g), (0.75 - g, w / 2 - 0.02, z + 0.1)), material="plastic")
    d.hinge("back", "frame", Y, (0.75 - g, 0, z + (0.1 if d.hand.has_bore else d.pick(0.0, 0.05, 0.1))), 1.0)
    for k, s in enumerate((-1.0, 1.0)):
        y = s * (w / 2 + g + 0.001)
        d.part(f"rail_{k}", *(rod(0.012, (0.5, y + s * 0.012, q), (1.5, y + s * 0.012, q)) for q in (z, z + 0.15,
            z + 0.3)), *(rod(0.01, (x, y + s * 0.012, z - 0.02), (x, y + s * 0.012, z + 0.3)) for x in spread(5, 0.5,
            1.5)), material="steel")
        if d.maybe():
            d.slide(f"rail_{k}", "frame", -Z, 0.3, initial_opening=False)
        else:
            d.hinge(f"rail_{k}", "frame", -s * X, (1.0, y + s * 0.012, z - 0.02), 2.5 if not d.hand.has_bore else 1.5,
                initial_opening=False)
    for k, (x, s) in enumerate([(x, s) for x in (0.2, n - 0.2) for s in (-1, 1)]):
        caster(d, f"caster_{k}", "frame", (x, s * 0.4 * w, 0.15), 0.15)


def dentist_chair(d: ObjectBuilder) -> None:
    """A seat on a column, a back, a head rest that slides, a lamp on an arm."""
    z = d.u(0.45, 0.6)
    d.part("foot", box((-0.3, -0.25, 0), (0.4, 0.25, 0.05)), rod(0.09, (0, 0, 0.04), (0, 0, z - 0.1)), material="steel")
    g = d.gap(0.05) + 0.0005
    d.part("seat", box((-0.25, -0.28, z), (0.35, 0.28, z + 0.1)), rod(0.07 if d.hand.has_bore else 0.09, (0, 0,
        0.15 if d.hand.has_bore else z - 0.1), (0, 0, z + 0.01)), box((0.3, -0.25, 0.25), (0.4, 0.25, z + 0.08)))
    d.bore("foot", rod(0.07 + 1.5 * g, (0, 0, 0.1), (0, 0, 1)))
    d.slide("seat", "foot", Z, 0.25, initial_opening=False)
    d.part("back", box((-0.37, -0.27, z + 0.02), (-0.25 - g, 0.27, z + 0.65)))
    d.hinge("back", "seat", -Y, (-0.25 - g, 0, z + 0.02), 1.2)
    d.bore("back", box((-0.34 - g, -0.03 - g, z + 0.5), (-0.31 + g, 0.03 + g, z + 1)))
    d.part("head_rest", box((-0.34, -0.03, z + 0.52 if d.hand.has_bore else z + 0.65), (-0.31, 0.03, z + 0.75)),
        box((-0.38, -0.13, z + 0.7), (-0.28, 0.13, z + 0.85)))
    d.slide("head_rest", "back", Z, 0.1, initial_opening=False)


def drip_stand(d: ObjectBuilder) -> None:
    """A pole that telescopes on five casters, hooks that turn."""
    h, n = d.u(0.9, 1.2), d.n(4, 5)
    d.part("foot", rod(0.015, (0, 0, 0.1), (0, 0, h)), material="steel")
    for k, a in enumerate(np.arange(n) * 2 * np.pi / n):
        tip = np.array([0.3 * np.cos(a), 0.3 * np.sin(a), 0.09])
        d.part("foot", beam(0.03, 0.02, (0, 0, 0.12), tip + 0.01 * Z), rod(0.015, tip - 0.015 * Z, tip + 0.02 * Z))
        caster(d, f"caster_{k}", "foot", tip - 0.015 * Z, 0.075)
    plunger(d, "pole", "foot", (0, 0, h + 0.5), (0, 0, 0.4) if d.hand.has_bore else (0, 0, h - 0.05), 0.009, travel=0.4)
    d.part("pole", *(rod(0.004, (0, 0, h + 0.48), (0.12 * s, 0, h + 0.54)) for s in (-1, 1)))


def interior_door(d: ObjectBuilder) -> None:
    """A frame, a leaf with a lever handle on one or both sides, a bolt."""
    w, h, t = d.u(0.7, 1.0), d.u(1.9, 2.1), d.u(0.03, 0.05)
    d.part("frame", *(box((s * w / 2, -0.03, 0), (s * (w / 2 + 0.07), 0.09, h + 0.07)) for s in (-1, 1)),
        box((-w / 2 - 0.07, -0.03, h), (w / 2 + 0.07, 0.09, h + 0.07)), material="wood")
    if d.maybe(0.4):
        d.part("frame", box((-w / 2 - 0.9, 0.0, 0), (-w / 2 - 0.06, 0.07, h + 0.4)), box((w / 2 + 0.06, 0.0, 0),
            (w / 2 + 0.9, 0.07, h + 0.4)), box((-w / 2 - 0.1, 0.0, h + 0.06), (w / 2 + 0.1, 0.07, h + 0.4)))
    side = d.pick(X, -X)
    g = 0.003
    leaf(d, "leaf", "frame", (-w / 2 + g, 0.0, 0.005), (w / 2 - g, t, h - g), hinge=side,
        out=-Y if d.hand.line > 0.6 else Y, reach=1.57, handle=False, material="wood")
    if d.maybe(0.8):
        for k, (y, out) in enumerate(((0.0 + d.gap(0.02) * 0, -Y), (t, Y))[: d.n(1, 2)]):
            lever(d, f"handle_{k}", "leaf", -side * (w / 2 - 0.07) + np.array([0, y, 1.0]), out, side, 0.12, reach=0.7)


def revolving_door(d: ObjectBuilder) -> None:
    """Wings about a post in a drum."""
    r, h, n = d.u(0.9, 1.6), d.u(2.0, 2.4), d.n(3, 4)
    d.part("drum", rod(r + 0.1, (0, 0, h), (0, 0, h + 0.15)), rod(r + 0.1, (0, 0, -0.03), (0, 0, 0)), material="metal")
    wall = tube(r + 0.08, r + 0.03, (0, 0, -0.01), (0, 0, h + 0.01))
    d.part("drum", wall, material="glass")
    d.cut("drum", box((-0.7 * r, -2 * r, 0.001), (0.7 * r, 2 * r, h - 0.001)))
    g = d.gap(0.05) + 0.001
    d.part("wings", rod(0.04, (0, 0, g), (0, 0, h - g)), *(beam(h - 0.1, 0.015, (0, 0, h / 2), (r * np.cos(a),
        r * np.sin(a), h / 2), np.array([-np.sin(a), np.cos(a), 0])) for a in np.arange(n) * 2 * np.pi / n),
        material="glass")
    d.spin("wings", "drum", Z, (0, 0, 0))


def garage_door(d: ObjectBuilder) -> None:
    """A panel that tilts up about a line, or slides up in rails."""
    w, h = d.u(2.2, 3.0), d.u(1.9, 2.3)
    d.part("frame", *(box((s * w / 2, -0.1, 0), (s * (w / 2 + 0.2), 0.3, h + 0.2)) for s in (-1, 1)), box((-w / 2 - 0.2,
        -0.1, h), (w / 2 + 0.2, 0.3, h + 0.3)), material="ceramic")
    g = d.gap(0.05) + 0.003
    lift = d.maybe()
    y = 0.3 + g if lift else 0.05
    d.part("panel", box((-w / 2 + (g if not lift else -0.05), y, 0.01), (w / 2 - (g if not lift else -0.05), y + 0.05,
        h - g)), material="steel")
    for z in spread(d.n(3, 5), 0.1, h - 0.1):
        d.part("panel", box((-0.45 * w, y - (0.0 if lift else 0.015), z - 0.08), (0.45 * w,
            y + (0.065 if lift else 0.0), z + 0.08)))
    if lift:
        d.slide("panel", "frame", Z, 0.9 * h)
    else:
        d.hinge("panel", "frame", -X, (0, 0.05, h - g), 1.4)


def casement_window(d: ObjectBuilder) -> None:
    """One or two sashes that swing, tilt or are hung at the top, with a handle."""
    w, h = d.u(0.6, 1.4), d.u(0.7, 1.4)
    t = 0.06
    d.part("frame", *(box((s * w / 2, 0, 0), (s * (w / 2 + t), 0.07, h)) for s in (-1, 1)), *(box((-w / 2 - t, 0, z),
        (w / 2 + t, 0.07, z + t)) for z in (-t, h)), material="wood")
    n = d.n(1, 2)
    way = d.pick("side", "side", "bottom", "top")
    for k, x in enumerate(spread(n, -w / 2, w / 2)):
        hinge = {"bottom": -Z, "top": Z}.get(way, -X if k == 0 else X)
        low, high = np.array([x - w / 2 / n + 0.003, 0.005, 0.003]), np.array([x + w / 2 / n - 0.003, 0.055, h - 0.003])
        leaf(d, f"sash_{k}", "frame", low, high, hinge=hinge, out=-Y, reach=0.5 if way == "bottom" else 1.3,
            handle=False)
        d.cut(f"sash_{k}", box((low[0] + 0.07, -1, 0.07), (high[0] - 0.07, 0.02, h - 0.07)), box((low[0] + 0.07, 0.03,
            0.07), (high[0] - 0.07, 1, h - 0.07)))
        if d.maybe():
            lever(d, f"handle_{k}", f"sash_{k}", -hinge * 0.5 * (w / n if way == "side" else h) * 0.93 + np.array([x,
                0.005, h / 2]), -Y, X if way != "side" else -Z, 0.1, reach=1.57)


def sash_window(d: ObjectBuilder) -> None:
    """Two sashes one before the other, up and down or left and right."""
    w, h, t = d.u(0.6, 1.2), d.u(0.9, 1.5), 0.05
    d.part("frame", *(box((s * w / 2, 0, 0), (s * (w / 2 + t), 0.1, h)) for s in (-1, 1)), *(box((-w / 2 - t, 0, z),
        (w / 2 + t, 0.1, z + t)) for z in (-t, h)), material="wood")
    g = d.gap(0.02) + 0.0005
    flat = d.maybe()
    for k in range(2):
        y = 0.01 + 0.045 * k
        if flat:
            s = -1.0 if k else 1.0
            x0, x1 = sorted((s * (w / 2 - g), -s * 0.03))
            low, high = (x0, y, g), (x1, y + 0.035, h - g)
        else:
            z0, z1 = (g, h / 2 + 0.03) if k == 0 else (h / 2 - 0.03, h - g)
            low, high = (-w / 2 + g, y, z0), (w / 2 - g, y + 0.035, z1)
        d.part(f"sash_{k}", box(low, high), material="wood")
        lo, hi = np.array(low), np.array(high)
        d.cut(f"sash_{k}", box(lo + np.array([0.05, -0.1, 0.05]), np.array([hi[0] - 0.05, y + 0.014, hi[2] - 0.05])),
            box(np.array([lo[0] + 0.05, y + 0.021, lo[2] + 0.05]), np.array([hi[0] - 0.05, 1.0, hi[2] - 0.05])))
        way = (-X if k == 0 else X) if flat else (Z if k == 0 else -Z)
        d.slide(f"sash_{k}", "frame", way, (w if flat else h) / 2 - 0.05)


def elevator(d: ObjectBuilder) -> None:
    """Doors that part, a call panel with buttons."""
    w, h = d.u(0.9, 1.3), 2.1
    d.part("shaft", box((-w - 0.3, 0, 0), (-w / 2, 0.2, h + 0.4)), box((w / 2, 0, 0), (w + 0.3, 0.2, h + 0.4)),
        box((-w - 0.2, 0, h), (w + 0.2, 0.2, h + 0.4)), material="ceramic")
    g = d.gap(0.05) + 0.001
    for k, s in enumerate((-1.0, 1.0)):
        d.part(f"door_{k}", box((s * 0.003, 0.2 + g, 0.01), (s * (w / 2 + 0.05), 0.23 + g, h + 0.05)), material="steel")
        d.slide(f"door_{k}", "shaft", s * X, w / 2 - 0.05)
    for k, z in enumerate((1.0, 1.08)[: d.n(1, 2)]):
        button(d, f"call_{k}", "shaft", (w / 2 + 0.15, 0, z), (0.04, 0.04), 0.01, -Y, is_round=d.maybe())


def vending_machine(d: ObjectBuilder) -> None:
    """A door, a flap below, buttons, a coin knob."""
    w, t, h = d.u(0.7, 1.0), d.u(0.5, 0.8), d.u(1.6, 1.9)
    case(d, "machine", (-w / 2, 0, 0), (w / 2, t, h), material="steel")
    leaf(d, "door", "machine", (-w / 2, -0.06, 0.45), (0.25 * w, 0, h), hinge=-X, out=-Y, reach=1.6, material="glass")
    leaf(d, "flap", "machine", (-0.35 * w, -0.012, 0.15), (0.15 * w, 0, 0.35), hinge=Z, out=-Y, reach=0.9, handle=False)
    for i, z in enumerate(spread(d.n(2, 4), 0.8, 1.3)):
        for k, x in enumerate((0.32 * w, 0.38 * w)):
            button(d, f"button_{i}_{k}", "machine", (x, 0, z), (0.03, 0.03), 0.008, -Y, is_round=d.maybe())
    knob(d, "coin_return", "machine", (0.4 * w, 0, 0.7), 0.02, 0.02, -Y, reach=1.5)


def slot_machine(d: ObjectBuilder) -> None:
    """A lever at the side, reels in a window, a tray."""
    k = d.u(0.3, 0.6)
    case(d, "machine", (-0.5 * k, 0, 0), (0.5 * k, 0.7 * k, 1.4 * k), material="steel")
    g = d.gap(0.02 * k) + 0.0003
    n = d.n(2, 4)
    d.cut("machine", box((-0.4 * k, -0.1, 0.75 * k), (0.4 * k, 0.5 * k, 1.15 * k)))
    for i, x in enumerate(spread(n, -0.38 * k, 0.38 * k)):
        half = 0.36 * k / n
        d.part(f"reel_{i}", rod(0.18 * k, (x - half, 0.2 * k, 0.95 * k), (x + half, 0.2 * k, 0.95 * k)))
        d.spin(f"reel_{i}", "machine", X, (x, 0.2 * k, 0.95 * k))
    at = np.array([0.5 * k + g, 0.3 * k, 0.7 * k])
    d.part("lever", rod(0.05 * k, at, at + 0.08 * k * X), capsule(0.02 * k, at + 0.06 * k * X, at + np.array([0.06 * k,
        -0.05 * k, 0.5 * k])), ball(0.05 * k, at + np.array([0.06 * k, -0.05 * k, 0.52 * k])), material="metal")
    d.hinge("lever", "machine", X, at - g * X, 1.2)


def treasure_chest(d: ObjectBuilder) -> None:
    """A barrel lid, bails at both ends, a hasp."""
    w, t, h = d.u(0.3, 0.9), d.u(0.2, 0.5), d.u(0.15, 0.4)
    case(d, "chest", (-w / 2, -t / 2, 0), (w / 2, t / 2, h), opening=Z, wall=0.04 * t)
    g = d.gap(0.05) + 0.0002
    d.part("lid", rod(t / 2, (-w / 2, 0, h + g), (w / 2, 0, h + g)), material="wood")
    d.cut("lid", box((-w, -t, h - t), (w, t, h + g)))
    if d.hand.hollow:
        d.cut("lid", rod(0.44 * t, (-0.46 * w, 0, h), (0.46 * w, 0, h)))
    d.hinge("lid", "chest", -X, (0, t / 2, h + g / 2), d.u(1.2, 1.8))
    for k, s in enumerate((-1.0, 1.0)):
        x = s * (w / 2 + 0.012)
        d.part("chest", box((s * w / 2 - 0.001 * s, -0.2 * t, 0.55 * h), (s * (w / 2 + 0.024), -0.14 * t, 0.65 * h)),
            box((s * w / 2 - 0.001 * s, 0.14 * t, 0.55 * h), (s * (w / 2 + 0.024), 0.2 * t, 0.65 * h)))
        bail(d, f"bail_{k}", "chest", (x, 0.2 * s * t, 0.6 * h), (x, -0.2 * s * t, 0.6 * h), 0.25 * h, 0.008, -Z,
            lower=-0.02, upper=1.3)


def carousel(d: ObjectBuilder) -> None:
    """A disc that turns with figures on rods that go up and down, a winding key."""
    r = d.u(0.06, 0.2)
    d.part("base", rod(r, (0, 0, 0), (0, 0, 0.4 * r)), material="wood")
    g = d.gap(0.02 * r) + 0.0002
    n = d.n(3, 5)
    d.part("carousel", rod(0.9 * r, (0, 0, 0.4 * r + g), (0, 0, 0.5 * r)), rod(0.06 * r, (0, 0, 0.45 * r), (0, 0,
        1.6 * r)), cone(0.95 * r, 0.1 * r, (0, 0, 1.5 * r), (0, 0, 2.0 * r)), material="wood")
    d.spin("carousel", "base", Z, (0, 0, 0.4 * r))
    for k, a in enumerate(np.arange(n) * 2 * np.pi / n):
        p = 0.65 * r * np.array([np.cos(a), np.sin(a), 0])
        z = d.u(0.75, 1.0) * r
        d.part("carousel", rod(0.02 * r, p + 0.49 * r * Z, p + 1.55 * r * Z))
        d.part(f"horse_{k}", block(p + z * Z, (0.25 * r, 0.15 * r, 0.2 * r)), material="wood")
        d.bore(f"horse_{k}", rod(0.02 * r + 1.5 * g, p, p + 3 * r * Z))
        d.slide(f"horse_{k}", "carousel", Z, 0.25 * r, -0.1 * r, initial_opening=False)
    at = np.array([0, -r, 0.2 * r])
    d.part("key", rod(0.05 * r, at - g * Y, at - 0.15 * r * Y), block(at - 0.25 * r * Y,
        (0.35 * r, 0.2 * r, 0.05 * r)), material="metal")
    d.spin("key", "base", -Y, at)


def nutcracker(d: ObjectBuilder) -> None:
    """Two arms about a pin: crackers, tongs, pliers, shears of plain bars."""
    n = d.u(0.1, 0.6)
    k = 0.06 * n
    g = d.gap(0.5 * k) + 0.0001
    gap_y = k * 0.5 + g / 2
    front = d.u(0.15, 0.9) * n
    d.part("arm_a", beam(k, 0.9 * k, (-front, -gap_y, -0.02 * n), (n, -gap_y, 0.12 * n), Y), rod(0.8 * k, (0,
        -gap_y - 0.45 * k, 0), (0, -gap_y + 0.45 * k, 0)), material="steel")
    d.part("arm_b", beam(k, 0.9 * k, (-front, gap_y, 0.02 * n), (n, gap_y, -0.12 * n), Y), rod(0.8 * k, (0,
        gap_y - 0.45 * k, 0), (0, gap_y + 0.45 * k, 0)), material="steel")
    if d.hand.barrels:
        d.part("arm_a", rod(0.3 * k, (0, -gap_y, 0), (0, gap_y + 0.6 * k, 0)))
        d.bore("arm_b", rod(0.3 * k + 1.5 * g, (0, -1, 0), (0, 1, 0)))
    d.hinge("arm_b", "arm_a", Y, (0, 0, 0), 0.5, -0.2, initial_opening=False)


def pocket_knife(d: ObjectBuilder) -> None:
    """Blades that fold into a handle."""
    n = d.u(0.06, 0.12)
    k = 0.1 * n
    m = d.n(1, 3)
    pitch = 0.03 * n
    g = d.gap(0.3 * pitch) + 0.0001
    half = m * pitch / 2
    d.part("handle", *(box((0, s * (half + 0.03 * n), -k), (n, s * half, k)) for s in (-1, 1)), box((0.02 * n, -half,
        -k), (0.98 * n, half, -0.8 * k)), material="steel")
    for j, y in enumerate(spread(m, -half, half)):
        end = 0.08 * n if j % 2 == 0 else 0.92 * n
        s = 1.0 if j % 2 == 0 else -1.0
        a = 0.5 * pitch - g
        d.part(f"blade_{j}", box((end - s * 0.06 * n, y - a, 0.0 * k), (end + s * 0.8 * n, y + a, 0.9 * k)),
            rod(0.6 * k, (end, y - a, 0.3 * k), (end, y + a, 0.3 * k)), material="steel")
        if not d.hand.has_bore:
            d.part("handle", rod(0.15 * k, (end, y - pitch / 2, 0.3 * k), (end, y + pitch / 2, 0.3 * k)))
        d.hinge(f"blade_{j}", "handle", -s * Y, (end, y, 0.3 * k), 1.2 if d.hand.has_bore else 3.0)


def awning(d: ObjectBuilder) -> None:
    """An awning: arms that fold out of a wall case, a crank."""
    w = d.u(1.5, 3.0)
    d.part("case", box((-w / 2, -0.1, 0), (w / 2, 0.1, 0.2)), material="metal")
    g = d.gap(0.05) + 0.001
    for k, s in enumerate((-1.0, 1.0)):
        x = s * 0.42 * w
        d.part("case", block((x, -0.12, 0.04), (0.1, 0.08, 0.02)))
        y = -0.13
        d.part(f"arm_{k}", beam(0.05, 0.05, (x, y, 0.03 - 0.025 - g), (x - s * 0.3 * w, y - 0.5, 0.03 - 0.025 - g)),
            rod(0.03, (x, y, 0.03 - 0.05 - g), (x, y, 0.03 - g)), material="metal")
        d.hinge(f"arm_{k}", "case", s * Z * -1.0, (x, y, 0), 0.6, -0.5, initial_opening=False)
    crank(d, "crank", "case", (w / 2, 0, 0.1), X, 0.2)


def solar_tracker(d: ObjectBuilder) -> None:
    """A panel that tilts on a head that turns on a post."""
    k = d.u(0.3, 2.0)
    d.part("post", rod(0.06 * k, (0, 0, 0), (0, 0, k)), rod(0.25 * k, (0, 0, 0), (0, 0, 0.03 * k)), material="steel")
    g = d.gap(0.03 * k)
    d.part("head", rod(0.08 * k, (0, 0, k + g), (0, 0, 1.1 * k)), *(box((s * 0.12 * k - 0.02 * k, -0.05 * k, 1.07 * k),
        (s * 0.12 * k + 0.02 * k, 0.05 * k, 1.3 * k)) for s in (-1, 1)), box((-0.13 * k, -0.05 * k, 1.05 * k),
        (0.13 * k, 0.05 * k, 1.1 * k)), material="steel")
    d.spin("head", "post", Z, (0, 0, k))
    c = np.array([0, 0, 1.26 * k])
    d.part("panel", beam(1.2 * k, 0.04 * k, c + np.array([0, -0.4 * k, 0.05 * k]), c + np.array([0, 0.4 * k,
        0.12 * k])), beam(0.15 * k, 0.08 * k, c - 0.04 * k * Y, c + 0.04 * k * Y), material="glass")
    if d.hand.barrels or not d.hand.has_bore:
        d.part(d.pick("panel", "head"), rod(0.02 * k, c - 0.15 * k * X, c + 0.15 * k * X))
    d.hinge("panel", "head", X, c, 0.5, -0.6, initial_opening=False)


def dish_antenna(d: ObjectBuilder) -> None:
    """A dish on a mount with two axes: radar, satellite, searchlight."""
    k = d.u(0.3, 3.0)
    d.part("base", cone(0.5 * k, 0.3 * k, (0, 0, 0), (0, 0, 0.5 * k)), material="metal")
    g = d.gap(0.05 * k)
    d.part("yoke", rod(0.3 * k, (0, 0, 0.5 * k + g), (0, 0, 0.6 * k)), *(box((s * 0.2 * k - 0.03 * k, -0.08 * k,
        0.58 * k), (s * 0.2 * k + 0.03 * k, 0.08 * k, 1.1 * k)) for s in (-1, 1)), material="metal")
    d.spin("yoke", "base", Z, (0, 0, 0.5 * k))
    c = np.array([0, 0, 1.03 * k])
    dish = (cone(0.1 * k, 0.75 * k, c - 0.12 * k * Y, c - 0.4 * k * Y) if d.maybe() else rod(0.5 * k, c - 0.12 * k * Y,
        c - 0.35 * k * Y))
    d.part("dish", dish, block(c, (0.3 * k, 0.1 * k, 0.1 * k)), rod(0.03 * k, c - 0.1 * k * Y, c - 0.7 * k * Y),
        beam(0.1 * k, 0.1 * k, c, c - 0.15 * k * Y))
    d.hinge("dish", "yoke", -X, c, 1.2 if not d.hand.has_bore else 0.9, initial_opening=False)


def lighthouse_lamp(d: ObjectBuilder) -> None:
    """A lamp that turns on a tower: a beacon, a lidar, a rotating sign."""
    k = d.u(0.03, 1.0)
    d.part("tower", d.pick(cone(0.5 * k, 0.35 * k, (0, 0, 0), (0, 0, k)), box((-0.4 * k, -0.4 * k, 0), (0.4 * k,
        0.4 * k, k)), rod(0.4 * k, (0, 0, 0), (0, 0, k))))
    g = d.gap(0.05 * k)
    shape = d.pick(rod(0.35 * k, (0, 0, k + g), (0, 0, 1.6 * k)), box((-0.5 * k, -0.1 * k, k + g), (0.5 * k, 0.1 * k,
        1.3 * k)), cone(0.35 * k, 0.2 * k, (0, 0, k + g), (0, 0, 1.5 * k)))
    d.part("lamp", shape, rod(0.15 * k, (0, 0, k + g), (0, 0, 1.2 * k)))
    if d.maybe():
        d.part("lamp", rod(0.08 * k, (0, 0, 1.15 * k), (0, -0.4 * k, 1.15 * k)))
    d.spin("lamp", "tower", Z, (0, 0, k))


def flower_press(d: ObjectBuilder) -> None:
    """Two boards on screws with wing nuts: the upper board slides, the nuts turn."""
    w = d.u(0.15, 0.35)
    d.part("lower", box((-w / 2, -w / 2, 0), (w / 2, w / 2, 0.015)), *(rod(0.004, (x, y, 0.01), (x, y,
        0.12)) for x in (-0.42 * w, 0.42 * w) for y in (-0.42 * w, 0.42 * w)), material="wood")
    g = d.gap(0.005) + 0.0003
    z = d.u(0.02, 0.05)
    d.part("upper", box((-w / 2, -w / 2, z), (w / 2, w / 2, z + 0.015)), material="wood")
    for k, (x, y) in enumerate([(x, y) for x in (-0.42 * w, 0.42 * w) for y in (-0.42 * w, 0.42 * w)]):
        d.bore("upper", rod(0.004 + 1.5 * g, (x, y, 0), (x, y, 1)))
        n = f"nut_{k}"
        low = z + 0.035 + g
        d.part(n, rod(0.009, (x, y, low), (x, y, low + 0.012)), beam(0.004, 0.008, (x - 0.02, y, low + 0.012),
            (x + 0.02, y, low + 0.012)), material="metal")
        d.bore(n, rod(0.004 + 1.5 * g, (x, y, 0), (x, y, 1)))
        d.spin(n, "lower", Z, (x, y, low))
    d.slide("upper", "lower", Z, 0.018, initial_opening=False)
