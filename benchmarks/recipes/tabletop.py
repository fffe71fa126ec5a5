"""Small things as plain solids: a pin stands in solid blades, hands lie on a dial, a cap sits on a pen."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import button, knob
from benchmarks.recipes.panels import seam, slab
from benchmarks.recipes.shapes import X, Y, Z, ball, beam, box, capsule, cone, lathe, ring, rod

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.recipes.object_builder import ObjectBuilder
    from benchmarks.recipes.shapes import Shape
    from kinematify.robot.arrays import FloatArray

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def _pinned(d: ObjectBuilder, names: tuple[str, str], shapes: Sequence[Sequence[Shape]], r: float, low: float,
    high: float,
        upper: float, lower: float) -> None:
    """Two arms that cross at the origin, and a pin about z in both: of one of them, of its own, or not drawn."""
    for name, some in zip(names, shapes, strict=True):
        d.part(name, *some, material="steel")
    pin = rod(r, (0, 0, low), (0, 0, high))
    kind = d.pick("merged", "apart", "none")
    if kind != "none":
        d.bore(names[1], rod(r + 1.5 * d.gap(2 * r) + 1e-5, (0, 0, low - 1), (0, 0, high + 1)))
        if kind == "merged":
            d.part(names[0], pin)
        else:
            d.fix(d.part("pin", pin, material="steel"), names[0])
    d.hinge(names[1], names[0], Z, (0, 0, 0), upper, lower, initial_opening=False)


def plain_scissors(d: ObjectBuilder) -> None:
    """Two blades that lie on each other, or in one plane and in each other, with loops at their ends."""
    blade, grip, wide = d.u(0.05, 0.15), d.u(0.05, 0.1), d.u(0.008, 0.018)
    thick, half = d.u(0.0015, 0.004), d.u(0.08, 0.5)
    play = seam(d, wide, thick)
    flat = not d.hand.has_bore and d.maybe()
    shapes = []
    for k, s in enumerate((1.0, -1.0)):
        z = 0.0 if flat else k * (thick + play)
        along = np.array([s * np.sin(half), np.cos(half), 0.0])
        side = np.array([np.cos(half), -s * np.sin(half), 0.0]) * s
        middle = np.array([0.0, 0.0, z + thick / 2])
        end = middle - grip * along - 0.012 * side
        loop = ring(d.u(0.014, 0.02), 0.45 * thick, end - 0.015 * along, Z)
        shapes.append([beam(wide, thick, middle - 0.3 * grip * along, middle + blade * along, Z), beam(0.6 * wide,
            thick,
            middle - 0.2 * grip * along, end, Z), loop])
    top = 2 * thick + max(play, 0.0)
    _pinned(d, ("blade", "other_blade"), shapes, 0.25 * wide, -0.3 * thick, (thick if flat else top) + 0.3 * thick,
        2 * half, -d.u(0.2, 0.8))


def plain_pliers(d: ObjectBuilder) -> None:
    """Two thick arms with jaws and curved or straight handles about a pin: pliers, tongs, shears, clamps."""
    jaw, grip, wide = d.u(0.02, 0.06), d.u(0.08, 0.16), d.u(0.01, 0.02)
    thick, half = d.u(0.005, 0.012), d.u(0.06, 0.3)
    play = seam(d, wide, thick)
    flat = not d.hand.has_bore and d.maybe()
    bend = d.u(0.0, 0.3)
    shapes = []
    for k, s in enumerate((1.0, -1.0)):
        z = 0.0 if flat else k * (thick + play)
        along = np.array([s * np.sin(half), np.cos(half), 0.0])
        back = np.array([-s * np.sin(half + bend), -np.cos(half + bend), 0.0])
        middle = np.array([0.0, 0.0, z + thick / 2])
        knee = middle - 0.35 * grip * along
        shapes.append([beam(wide, thick, middle, middle + jaw * along, Z), beam(0.9 * wide, thick, middle, knee, Z),
            beam(0.8 * wide, thick, knee, knee + 0.65 * grip * back, Z), rod(0.8 * wide, (0, 0, z), (0, 0, z + thick))])
    top = 2 * thick + max(play, 0.0)
    _pinned(d, ("arm", "other_arm"), shapes, 0.3 * wide, -0.2 * thick, (thick if flat else top) + 0.2 * thick,
        2 * half, -d.u(0.2, 0.6))


def capped_pen(d: ObjectBuilder) -> None:
    """A pen on end or lying: a cap that is drawn off, or a button that is pressed, and a clip."""
    r, length = d.u(0.004, 0.01), d.u(0.09, 0.15)
    out: FloatArray = d.pick(Z, -Y)
    side = X
    d.part("pen", rod(r, 0 * out, 0.7 * length * out), cone(0.2 * r, r, -0.15 * length * out, 0 * out),
        material="plastic")
    capped = d.maybe(0.6)
    if capped:
        play = d.gap(r)
        start, end = 0.55 * length * out, length * out
        d.part("pen", rod(0.8 * r, 0.6 * length * out, 0.9 * length * out))
        if d.maybe():  # over the end of the pen, and wider than it
            d.part("cap", rod(1.25 * r, start, end))
            d.bore("cap", rod(r + 1.5 * play + 1e-5, 0 * out, 0.93 * length * out))
        else:
            d.part("cap", rod(r, (0.7 * length + play) * out, end))
            d.bore("cap", rod(0.8 * r + 1.5 * play + 1e-5, 0 * out, 0.93 * length * out))
        d.part("cap", beam(0.4 * r, 0.6 * r, 0.97 * length * out + 0.5 * r * side,
            0.97 * length * out + 1.9 * r * side),
            beam(0.4 * r, 0.6 * r, length * out + 1.7 * r * side, 0.62 * length * out + 1.7 * r * side, side))
        d.slide("cap", "pen", out, d.u(0.3, 0.5) * length)
    else:
        button(d, "button", "pen", 0.7 * length * out, (0.9 * r, 0.9 * r), d.u(0.004, 0.012), out, is_round=True)
        d.part("pen", beam(0.4 * r, 0.6 * r, 0.66 * length * out, 0.66 * length * out + 1.6 * r * side), beam(0.4 * r,
            0.6 * r, 0.69 * length * out + 1.5 * r * side, 0.3 * length * out + 1.5 * r * side, side))


def pump_bottle(d: ObjectBuilder) -> None:
    """A bottle with a head that goes down or a cap that turns or comes off; round, square or waisted."""
    r, h = d.u(0.02, 0.05), d.u(0.08, 0.25)
    neck, top = 0.4 * r, h + d.u(0.01, 0.03)
    d.part("bottle", d.pick(rod(r, (0, 0, 0), (0, 0, h)), box((-r, -0.6 * r, 0), (r, 0.6 * r, h)), lathe([(0.001, 0),
        (r, 0), (0.75 * r, 0.5 * h), (r, h), (0.001, h)], (0, 0, 0))), rod(neck, (0, 0, 0.5 * h), (0, 0, top)),
        material="plastic")
    play = seam(d, neck, 0.01)
    if d.maybe(0.5):
        z = top + play
        stem = d.u(0.015, 0.04)
        d.bore("bottle", rod(0.35 * neck + 1.5 * d.gap(neck) + 1e-5, (0, 0, 0.4 * h), (0, 0, top + 1)))
        d.part("head", rod(0.35 * neck, (0, 0, 0.5 * h if d.hand.has_bore else top), (0, 0, z + stem)),
            d.pick(rod(0.9 * neck,
            (0, 0, z + stem), (0, 0, z + stem + 0.012)), box((-0.8 * neck, -neck, z + stem), (0.8 * neck, neck,
            z + stem + 0.012))), beam(0.4 * neck, 0.3 * neck, (0, 0, z + stem + 0.006), (0, -1.5 * r, z + stem)))
        d.slide("head", "bottle", -Z, 0.8 * stem, initial_opening=False)
    else:
        high = d.u(0.01, 0.04)
        z = top - 0.8 * high if d.maybe() else top + max(play, -0.3 * high)
        d.part("cap", rod(1.15 * neck, (0, 0, z), (0, 0, z + high)))
        d.bore("cap", rod(neck + d.gap(neck) + 1e-5, (0, 0, 0), (0, 0, top + d.gap(neck) + 1e-5)))
        if d.maybe():
            d.spin("cap", "bottle", Z, (0, 0, z))
        else:
            d.slide("cap", "bottle", Z, d.u(0.02, 0.06))


def plain_bucket(d: ObjectBuilder) -> None:
    """A pail or a basket with one bow or two that swing about their ends, upright or laid on the rim."""
    r, h = d.u(0.1, 0.2), d.u(0.12, 0.35)
    d.part("pail", cone(d.u(0.6, 1.0) * r, r, (0, 0, 0), (0, 0, h)), material="metal")
    if d.hand.hollow:
        d.cut("pail", cone(0.55 * r, 0.95 * r, (0, 0, 0.01), (0, 0, h + 0.001)))
    wire = d.u(0.003, 0.008)
    play = seam(d, r, wire)
    wide, z = r + wire + max(play, -wire), h - d.u(0.02, 0.15) * h
    n = d.pick(1, 1, 1, 2)
    for k in range(n):
        y = 0.0 if n == 1 else (k - 0.5) * 0.02
        tall = d.u(0.8, 1.3)
        steps = np.linspace(0.0, np.pi, d.n(6, 14))
        points = [np.array([wide * np.cos(a), y, z + tall * wide * np.sin(a)]) for a in steps]
        name = f"bow_{k}"
        d.part(name, *(capsule(wire, p, q) for p, q in pairwise(points)), material="metal")
        if d.hand.barrels and d.hand.hollow:
            d.part("pail", *(rod(0.8 * wire, (s * 0.9 * r, y, z), (s * (wide - wire), y, z)) for s in (-1.0, 1.0)))
        swing = d.u(1.0, 1.5)
        d.hinge(name, "pail", X, (0, y, z), swing, -swing, initial_opening=False, rest=d.pick(0.0, 0.0, 0.9 * swing))


def plain_stapler(d: ObjectBuilder) -> None:
    """A base and an arm that is hinged behind: a stapler, a punch, a clip, a press."""
    length, wide, t = d.u(0.08, 0.18), d.u(0.02, 0.04), d.u(0.006, 0.015)
    arm, rise = d.u(0.8, 1.3) * t, d.pick(0.0, d.u(0.05, 0.3))
    d.part("base", box((-wide / 2, 0, 0), (wide / 2, length, t)), material="metal")
    play = seam(d, wide, t)
    low = t + max(play, 0.001)
    cheeks = d.maybe()
    if cheeks:
        for s in (-1.0, 1.0):
            d.part("base", box((s * wide / 2, 0.8 * length, 0), (s * (wide / 2 - 0.12 * wide), length, low + arm)))
    half = wide / 2 - (0.12 * wide + max(play, 0.0005) if cheeks else 0.0)
    end = (d.u(0.85, 0.94) if cheeks else 0.97) * length
    d.part("arm", box((-half, d.u(-0.05, 0.1) * length, low), (half, end, low + arm)), material="metal")
    if d.maybe():
        d.part("arm", box((-0.8 * half, 0.0, low + arm), (0.8 * half, 0.6 * length, low + 1.4 * arm)))
    pivot = (0, end, low + (0.5 * arm if cheeks else 0.0))
    d.hinge("arm", "base", -X, pivot, d.u(0.6, 1.4 if cheeks else 2.0), initial_opening=False, rest=rise)


def slab_laptop(d: ObjectBuilder) -> None:
    """Two slabs on an edge, mostly open: a laptop, a game, a case for make-up; keys or a pad at times."""
    w, t, a, b = d.u(0.08, 0.4), d.u(0.06, 0.28), d.u(0.008, 0.03), d.u(0.004, 0.015)
    d.part("base", box((-w / 2, 0, 0), (w / 2, t, a)), material="plastic")
    play = max(seam(d, t, b), -0.2 * b)
    low = a + play
    shrink = d.pick(0.0, 0.01) * w
    d.part("screen", box((-w / 2 + shrink, shrink, low), (w / 2 - shrink, t, low + b)), material="plastic")
    d.cut("screen", box((-0.44 * w, 0.08 * t, low - 1), (0.44 * w, 0.9 * t, low + 0.2 * b)))
    if d.maybe(0.4):
        d.cut("base", box((-0.4 * w, 0.4 * t, 0.85 * a), (0.4 * w, 0.9 * t, a + 1)))
    if d.maybe(0.25):
        button(d, "key", "base", (0.44 * w, 0.95 * t - 0.005, a), (0.006, 0.006), 0.001, Z)
    pivot = (0, t, d.pick(low, a + play / 2, low + b / 2))
    reach = d.u(1.8, 3.0)
    d.hinge("screen", "base", -X, pivot, reach, initial_opening=False, rest=d.pick(0.0, d.u(1.2, 1.9), d.u(1.5, 1.8)))


def plain_globe(d: ObjectBuilder) -> None:
    """A ball between the ends of a bow, or on a rod: it turns about a tilted line, with pins or without."""
    r, tilt = d.u(0.06, 0.2), d.pick(0.0, d.u(0.2, 0.5))
    up = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    side = np.array([np.cos(tilt), 0.0, -np.sin(tilt)])
    middle = (r + d.u(0.3, 0.8) * r) * Z
    gap = d.gap(r)
    wide = r + max(0.04 * r, gap + 0.02 * r) + 0.04 * r
    d.part("stand", rod(d.u(0.5, 0.8) * r, (0, 0, 0), (0, 0, 0.08 * r)), rod(0.06 * r, (0, 0, 0),
        middle - 0.99 * wide * Z),
        material="metal")
    angles = np.linspace(0.0, np.pi, 14)
    bow = [middle + wide * (np.cos(a) * up - np.sin(a) * side) for a in angles]
    d.part("stand", *(beam(0.06 * r, 0.1 * r, p, q, Y) for p, q in pairwise(bow)))
    low = [middle + wide * (-np.sin(a) * side - np.cos(a) * Z) for a in np.linspace(0.0, 0.8, 5)]
    d.part("stand", *(beam(0.06 * r, 0.1 * r, p, q, Y) for p, q in pairwise(low)))
    d.part("ball", ball(r, middle), material="plastic")
    if d.hand.barrels:  # stubs on the ball that end before the bow
        reach = wide - 0.06 * r if d.hand.has_bore else wide
        d.part("ball", rod(0.03 * r, middle - reach * up, middle + reach * up))
    d.spin("ball", "stand", up, middle)


def rod_lamp(d: ObjectBuilder) -> None:
    """Plain rods that touch or stand in each other at their ends, a shade or a head at the last."""
    n, length, r = d.n(1, 3), d.u(0.15, 0.4), d.u(0.004, 0.012)
    foot = d.u(0.06, 0.1)
    d.part("foot", d.pick(rod(foot, (0, 0, 0), (0, 0, 0.02)), box((-foot, -foot, 0), (foot, foot, 0.03))),
        material="metal")
    at, parent, play = np.array([0.0, 0.0, 0.03]), "foot", d.gap(2 * r)
    if d.maybe():
        h = d.u(0.05, 0.3)
        d.part("foot", rod(1.5 * r, (0, 0, 0), (0, 0, 0.03 + h)))
        at = np.array([0.0, 0.0, 0.03 + h])
    angle = d.u(-0.3, 0.5)
    for k in range(n):
        along = np.array([0.0, -np.sin(angle), np.cos(angle)])
        # Careful hands lay a rod beside the one before it.
        beside = (2.5 * r + play) * X if d.hand.has_bore else 0.0 * X
        start = at + beside + (0.0 if d.hand.has_bore else d.pick(0.0, 0.8 * r)) * along
        end = at + beside + length * along
        d.part(f"arm_{k}", d.pick(capsule(r, start, end), rod(r, start, end)), material="metal")
        if not d.hand.has_bore and d.maybe():
            d.part(f"arm_{k}", ball(1.8 * r, at))
        d.hinge(f"arm_{k}", parent, X, at + beside, d.u(0.6, 1.5), -d.u(0.3, 0.8), initial_opening=False)
        at, parent, angle = end, f"arm_{k}", angle + d.u(0.5, 1.5)
    out = np.array([0.0, -np.sin(angle), np.cos(angle)])
    beside = (2.5 * r + play) * X if d.hand.has_bore else 0.0 * X
    high = d.u(0.05, 0.12)
    d.part("head", d.pick(cone(0.3 * high, high, at + beside, at + beside + high * out), beam(0.5 * high, 0.2 * high,
        at + beside, at + beside + 2 * high * out)), material="metal")
    if d.hand.has_bore:
        d.cut("head", box(at - 5 * r - X, at + 5 * r + (r + play / 2 - 5 * r) * X))
    d.hinge("head", parent, X, at + beside, d.u(0.5, 1.2), -d.u(0.5, 1.2), initial_opening=False)


def plain_clock(d: ObjectBuilder) -> None:
    """A disc or a box with two or three thin hands before it about one line; a knob behind at times."""
    r, t = d.u(0.04, 0.25), d.u(0.01, 0.06)
    d.part("case", d.pick(rod(r, (0, 0, 0), (0, t, 0)), box((-r, 0, -r), (r, t, r))), material="wood")
    deep = 0.3 * t
    if d.hand.hollow and d.maybe():
        d.cut("case", rod(0.9 * r, (0, -1, 0), (0, deep, 0)))
        d.part("case", ring(0.95 * r, 0.04 * r, (0, 0, 0), Y))
    else:
        deep = 0.0
    play, thick = seam(d, 0.2 * r, 0.01 * r), 0.012 * r
    y = deep - play
    for k in range(d.n(2, 3)):
        length, wide = (0.5, 0.75, 0.8)[k] * r, (0.08, 0.05, 0.02)[k] * r
        angle = d.u(0.0, 2 * np.pi)
        along = np.array([np.sin(angle), 0.0, np.cos(angle)])
        middle = np.array([0.0, y - thick / 2, 0.0])
        name = ("hour", "minute", "second")[k]
        d.part(name, beam(wide, thick, middle - d.pick(0.0, 0.15) * length * along, middle + length * along, Y),
            material="metal")
        if d.maybe():
            d.part(name, rod(0.05 * r, (0, y, 0), (0, y - thick, 0)))
        d.spin(name, "case", -Y, (0, y, 0))
        y -= thick + max(play, 0.0)
    if d.maybe(0.3):
        knob(d, "setter", "case", (0, t, -0.3 * r), 0.1 * r, 0.1 * r, Y)


def box_fan(d: ObjectBuilder) -> None:
    """Blades in a ring or a box that nothing visible holds, or a spindle behind them does."""
    r, t, n = d.u(0.04, 0.25), d.u(0.03, 0.12), d.n(3, 7)
    d.part("case", box((-1.15 * r, -t / 2, -1.15 * r), (1.15 * r, t / 2, 1.15 * r)), material="plastic")
    d.cut("case", rod(1.04 * r + d.hand.gap, (0, -1, 0), (0, 1, 0)))
    if d.maybe(0.4):
        d.part("guard", *(ring(f * r, 0.02 * r, (0, 0.4 * t, 0), Y) for f in (0.2, 0.6, 1.04)), beam(0.04 * r, 0.04 * r,
            (-1.1 * r, 0.4 * t, 0), (1.1 * r, 0.4 * t, 0)), beam(0.04 * r, 0.04 * r, (0, 0.4 * t, -1.1 * r), (0,
            0.4 * t,
            1.1 * r)))
        d.fix("guard", "case")
    hub = d.u(0.15, 0.4) * r
    d.part("rotor", rod(hub, (0, -0.25 * t, 0), (0, 0.25 * t, 0)), material="plastic")
    for a in np.arange(n) * 2 * np.pi / n:
        along = np.array([np.cos(a), 0.0, np.sin(a)])
        flat = 0.8 * Y + 0.6 * np.cross(Y, along)
        d.part("rotor", beam(0.35 * r, 0.02 * r, 0.8 * hub * along, 0.97 * r * along, flat))
    d.cut("rotor", box((-2 * r, -0.4 * t - 1, -2 * r), (2 * r, -0.33 * t, 2 * r)), box((-2 * r, 0.33 * t, -2 * r),
        (2 * r,
        0.4 * t + 1, 2 * r)))
    d.spin("rotor", "case", -Y, (0, 0, 0))


def flip_cap(d: ObjectBuilder) -> None:
    """A stick or a block with a cover: hinged at an end, turning about a pin, or drawn off: a lighter, a USB stick."""
    w, t, h = d.u(0.015, 0.04), d.u(0.008, 0.02), d.u(0.03, 0.07)
    kind = d.pick("flips", "turns", "off")
    share = d.u(0.5, 0.75)
    d.part("body", box((-w / 2, -t / 2, 0), (w / 2, t / 2, share * h)), material="metal")
    play = seam(d, t, 0.004)
    if kind == "turns":  # a bow of sheet over both faces
        g = max(d.gap(t), 0.0) if d.hand.has_bore else d.pick(0.0, d.gap(t))
        sheet = 0.08 * t
        for s in (-1.0, 1.0):
            d.part("cover", box((-0.5 * w, s * (t / 2 + g), -0.1 * h), (0.5 * w, s * (t / 2 + g + sheet), 0.9 * h)))
        d.part("cover", box((-0.5 * w, -t / 2 - g - sheet, 0.9 * h), (0.5 * w, t / 2 + g + sheet, 0.9 * h + sheet)))
        d.part("body", *(rod(0.08 * w, (0, s * t / 2, 0.15 * h), (0, s * (t / 2 - 1e-3), 0.15 * h)) for s in (-1.0,
            1.0)))
        d.hinge("cover", "body", Y, (0, 0, 0.15 * h), d.u(2.0, 3.1), -d.u(2.0, 3.1), initial_opening=False)
        return
    d.part("body", box((-0.35 * w, -0.35 * t, 0), (0.35 * w, 0.35 * t, 0.9 * h)))
    low = share * h + play
    d.part("cover", box((-w / 2, -t / 2, low), (w / 2, t / 2, h)), material="metal")
    d.bore("cover", box((-0.4 * w, -0.4 * t, 0), (0.4 * w, 0.4 * t, 0.95 * h)))
    if kind == "flips":
        d.hinge("cover", "body", Y, (w / 2, 0, share * h + d.pick(0.0, 0.5, 1.0) * play), d.u(1.5, 2.8),
            initial_opening=False)
    else:
        d.slide("cover", "body", Z, d.u(0.3, 0.6) * h)


def plain_bag(d: ObjectBuilder) -> None:
    """A bag or a basket with one handle or two that swing on its rim, and a flap at times."""
    w, t, h = d.u(0.2, 0.45), d.u(0.08, 0.2), d.u(0.15, 0.35)
    d.part("bag", box((-w / 2, -t / 2, 0), (w / 2, t / 2, h)), material="plastic")
    if d.hand.hollow:
        d.cut("bag", box((-0.47 * w, -0.44 * t, 0.02 * h), (0.47 * w, 0.44 * t, h + 1)))
    if d.maybe(0.4):
        slab(d, "flap", "bag", (-w / 2, -t / 2, h), (w / 2, t / 2, h + 0.012), hinge=Y, out=Z, handle=False,
            glazed=0.0, reach=d.u(1.5, 2.8))
    wire, half, tall = d.u(0.003, 0.008), d.u(0.15, 0.35) * w, d.u(0.3, 0.7) * h
    for k, s in enumerate((-1.0, 1.0)):
        y = s * (t / 2 + wire + max(d.gap(t), 0.0 if d.hand.has_bore else -wire))
        z = h - d.u(0.02, 0.15) * h
        points = [np.array([half * np.cos(a), y, z + tall * np.sin(a)]) for a in np.linspace(0, np.pi, d.n(5, 10))]
        d.part(f"strap_{k}", *(capsule(wire, p, q) for p, q in pairwise(points)))
        d.hinge(f"strap_{k}", "bag", s * -X, (0, y, z), d.u(0.8, 2.5), initial_opening=False)
