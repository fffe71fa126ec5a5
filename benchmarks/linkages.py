"""Linkages of known joints for the study of closed chains: flat bars in layers, with pins in holes.

They are ours: made for this study, with modelled pins and holes, seen while the code was written.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.solids import bore, box, cylinder, hull
from kinematify.generate.procedural.workshop import Workshop
from kinematify.generate.sentence import from_text

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.blueprint import Blueprint

Plane = tuple[float, float]
"""x and z [m]."""


class Bars:
    """A mechanism in the plane of x and z; bars lie in layers along y, on one side or on both."""

    def __init__(self, name: str, rng: np.random.Generator, *, pin: float, wide: float = 0.0) -> None:
        """Begin a mechanism.

        Args:
            name: Of the object.
            rng: Draws sizes.
            pin: Radius of the pins [m].
            wide: Distance between both sides [m]; 0 for one side only.
        """
        self.workshop = Workshop(name, material="metal")
        self.rng, self.pin, self.wide = rng, pin, wide
        self.thick, self.gap = 1.6 * pin, 0.08 * pin
        self._name = name
        self._layer: dict[str, int] = {}

    def between(self, low: float, high: float) -> float:
        """A number between two."""
        return float(self.rng.uniform(low, high))

    def plates(self, layer: int, *points: Plane, radius: float | None = None) -> list[Manifold]:
        """A bar with round ends through points, in its layer, on each side."""
        radius = 2.4 * self.pin if radius is None else radius
        found = []
        for low, high in self.spans(layer):
            ends = [cylinder(radius, (x, low, z), (x, high, z)) for x, z in points]
            found += [hull(one, other) for one, other in pairwise(ends)] or ends
        return found

    def body(self, name: str, layer: int, *points: Plane, more: Sequence[Manifold] = ()) -> None:
        """Add a bar, with more solids that belong to it."""
        self.workshop.body(name, *self.plates(layer, *points), *more)
        self._layer[name] = layer

    def bolt(self, inner: str, outer: str, at: Plane) -> None:
        """A pin of the one body in a hole of the other; no joint yet.

        On two sides it runs from one to the other, and the body in the lower layer is drilled.
        """
        (x, z), one, other = at, self._layer[inner], self._layer[outer]
        spans = list(zip(self.spans(one), self.spans(other), strict=True))
        for mine, its in spans:
            start, end = min(mine[0], its[0]), max(mine[1], its[1])
            hole = bore(self.pin, self.gap, (x, its[0] - self.thick, z), (x, its[1] + self.thick, z))
            self.workshop.cut(outer, hole)
            self.workshop.add(inner, cylinder(self.pin, (x, start, z), (x, end, z)))

    def turn(self, child: str, parent: str, at: Plane, *, pin_of: str, far: float = 1.0) -> None:
        """A hinge of the tree."""
        self.bolt(pin_of, parent if pin_of == child else child, at)
        self.workshop.turns(child, parent, (0, 1, 0), (at[0], 0, at[1]), (-far, far))

    def close(self, one: str, other: str, at: Plane, *, pin_of: str) -> None:
        """A hinge that closes a chain."""
        self.bolt(pin_of, other if pin_of == one else one, at)
        self.workshop.closes(one, other, (at[0], 0, at[1]))

    def rung(self, layer: int, at: Plane, radius: float = 0.01) -> Manifold:
        """A rod from the one side to the other."""
        ends = self.spans(layer)
        reach = max(abs(end) for span in ends for end in span)
        return cylinder(radius, (at[0], -reach, at[1]), (at[0], reach, at[1]))

    def finish(self) -> Blueprint:
        """The object as it is shown."""
        return self.workshop.finish(self._name, {}, style="clean", clearance=self.gap, rng=self.rng)

    def spans(self, layer: int) -> list[tuple[float, float]]:
        """Where a layer begins and ends along y [m], on each side."""
        low = layer * (self.thick + self.gap)
        if self.wide == 0.0:
            return [(low, low + self.thick)]
        start = 0.5 * self.wide + low
        return [(start, start + self.thick), (-start - self.thick, -start)]


def meets(one: Plane, reach: float, other: Plane, span: float, *, up: float = 1.0) -> Plane:
    """The point at a distance from each of two points, on the upper or lower side of the line from one to the other."""
    between = np.subtract(other, one)
    apart = float(np.linalg.norm(between))
    along = (reach**2 - span**2 + apart**2) / (2.0 * apart)
    aside = math.sqrt(reach**2 - along**2)
    x, z = np.add(one, along / apart * between) + up * aside / apart * np.array([-between[1], between[0]])
    return float(x), float(z)


def off(point: Plane, long: float, degrees: float) -> Plane:
    """The point at a distance in a direction from x towards z."""
    turn = math.radians(degrees)
    return point[0] + long * math.cos(turn), point[1] + long * math.sin(turn)


def four_bar(rng: np.random.Generator) -> Blueprint:
    """A ground, two bars on it and one between their ends, of any lengths."""
    bars = Bars("four_bar", rng, pin=0.004)
    a, d = (0.0, 0.0), (bars.between(0.1, 0.14), 0.0)
    b = off(a, bars.between(0.05, 0.07), bars.between(75, 110))
    c = meets(b, bars.between(0.09, 0.13), d, bars.between(0.07, 0.1))
    bars.body("ground", 0, off(a, 0.02, 180), off(d, 0.02, 0))
    bars.body("crank", 1, a, b)
    bars.body("rocker", 1, d, c)
    bars.body("coupler", 2, b, c)
    bars.turn("crank", "ground", a, pin_of="ground")
    bars.turn("rocker", "ground", d, pin_of="ground")
    bars.turn("coupler", "crank", b, pin_of="crank")
    bars.close("rocker", "coupler", c, pin_of="rocker")
    return bars.finish()


def desk_lamp(rng: np.random.Generator) -> Blueprint:
    """Two parallelograms, one on the other, that keep a shade level."""
    bars = Bars("desk_lamp", rng, pin=0.004)
    lower, upper, apart = bars.between(0.2, 0.28), bars.between(0.18, 0.24), bars.between(0.03, 0.036)
    first, second = bars.between(95, 115), bars.between(20, 40)
    a1, a2 = (0.0, 0.1), (apart, 0.1)
    b1, b2 = off(a1, lower, first), off(a2, lower, first)
    c1 = off(b1, 0.5 * apart, 60)
    c2 = off(c1, apart, 90)
    d1, d2 = off(c1, upper, second), off(c2, upper, second)
    foot = cylinder(0.08, (0.5 * apart, 0.0, 0.0), (0.5 * apart, 0.0, 0.015))
    post = box((-0.012, 0.0, 0.01), (apart + 0.012, bars.thick, 0.1))
    bars.body("foot", 0, a1, a2, more=[foot, post])
    bars.body("arm_1", 1, a1, b1)
    bars.body("arm_2", 1, a2, b2)
    bars.body("elbow", 2, b1, b2, c1, c2, more=[hull(*bars.plates(2, b1, b2, c1, c2))])
    bars.body("arm_3", 3, c1, d1)
    bars.body("arm_4", 3, c2, d2)
    shade = hull(*bars.plates(4, d1, d2, off(d2, 0.05, -60), off(d2, 0.09, -20)))
    bars.body("shade", 4, d1, d2, more=[shade])
    for arm, start, end in (("arm_1", a1, b1), ("arm_2", a2, b2)):
        bars.turn(arm, "foot", start, pin_of="foot")
        if arm == "arm_1":
            bars.turn("elbow", arm, end, pin_of=arm)
        else:
            bars.close(arm, "elbow", end, pin_of=arm)
    for arm, start, end in (("arm_3", c1, d1), ("arm_4", c2, d2)):
        bars.turn(arm, "elbow", start, pin_of="elbow")
        if arm == "arm_3":
            bars.turn("shade", arm, end, pin_of=arm)
        else:
            bars.close(arm, "shade", end, pin_of=arm)
    return bars.finish()


def toolbox(rng: np.random.Generator) -> Blueprint:
    """The toolbox of the composer: trays on two parallel arms each."""
    width = int(rng.integers(38, 56))
    return from_text(f"a {width} cm wide toolbox with two cantilever trays, half open").build()


def scissor_lift(rng: np.random.Generator) -> Blueprint:
    """Crossed arms between a base and a deck; two ends are pinned, two slide in channels."""
    bars = Bars("scissor_lift", rng, pin=0.006)
    long, rise = bars.between(0.3, 0.42), bars.between(25, 45)
    run, low = long * math.cos(math.radians(rise)), 0.05
    high = low + long * math.sin(math.radians(rise))
    right, top_left, top_right = (run, low), (0.0, high), (run, high)
    middle, block = (0.5 * run, 0.5 * (low + high)), 2.6 * bars.pin
    ((near, far),) = bars.spans(2)
    slot, channel = block + bars.gap, (0.3 * long, long + 0.03)
    for name, level, sign in (("base", low, 1.0), ("deck", high, -1.0)):
        under, over = (
            sorted((level + sign * one, level + sign * other))
            for one, other in ((-slot - 0.012, -slot), (slot, slot + 0.008))
        )
        side = sorted((level - sign * (slot + 1e-3), level + sign * (slot + 0.008)))
        floor = box((-0.04, -0.06, under[0]), (long + 0.04, far + 0.06, under[1]))
        wall = box((channel[0], far + bars.gap, side[0]), (channel[1], far + 0.01, side[1]))
        lip = box((channel[0], near, over[0]), (channel[1], far + 0.01, over[1]))
        pivot = 0.0, level
        lug = hull(*bars.plates(2, pivot), box((-0.02, near, under[0]), (0.02, far, under[1])))
        bars.body(name, 2, pivot, more=[floor, wall, lip, lug])
    bars.body("arm_1", 1, (0.0, low), top_right)
    bars.body("arm_2", 0, right, top_left)
    for name, (x, z) in (("foot_block", right), ("deck_block", top_right)):
        bars.body(name, 2, (x, z), more=[box((x - block, near, z - block), (x + block, far, z + block))])
    bars.turn("arm_1", "base", (0.0, low), pin_of="base", far=0.5)
    bars.turn("arm_2", "arm_1", middle, pin_of="arm_2")
    bars.workshop.slides("foot_block", "base", (1, 0, 0), (right[0], 0, right[1]), (-0.1, 0.1))
    bars.close("foot_block", "arm_2", right, pin_of="foot_block")
    bars.turn("deck", "arm_2", top_left, pin_of="deck")
    bars.workshop.slides("deck_block", "deck", (1, 0, 0), (top_right[0], 0, top_right[1]), (-0.1, 0.1))
    bars.close("deck_block", "arm_1", top_right, pin_of="deck_block")
    return bars.finish()


def folding_chair(rng: np.random.Generator) -> Blueprint:
    """Two frames that cross, a seat on the one, and a link from the seat to the other."""
    bars = Bars("folding_chair", rng, pin=0.006, wide=float(rng.uniform(0.36, 0.42)))
    cross = (0.0, bars.between(0.26, 0.3))
    foot, back = off(cross, 0.36, bars.between(-62, -55)), off(cross, 0.62, bars.between(112, 118))
    rear, front = off(cross, 0.34, bars.between(-125, -118)), off(cross, 0.2, bars.between(48, 56))
    seat = off(cross, 0.2, math.degrees(math.atan2(back[1] - cross[1], back[0] - cross[0])))
    under = (seat[0] + bars.between(0.2, 0.24), seat[1])
    bars.body("back_frame", 1, foot, cross, seat, back, more=[bars.rung(1, foot), bars.rung(1, back)])
    bars.body("rear_frame", 2, rear, cross, front, more=[bars.rung(2, rear)])
    reach = 0.5 * bars.wide + bars.thick
    top = box((seat[0] - 0.01, -reach, seat[1] + 0.012), (under[0] + 0.14, reach, seat[1] + 0.03))
    bars.body("seat", 0, seat, under, more=[top])
    bars.body("link", 1, under, front, more=[bars.rung(1, front, bars.pin)])
    bars.turn("rear_frame", "back_frame", cross, pin_of="back_frame")
    bars.turn("seat", "back_frame", seat, pin_of="back_frame")
    bars.turn("link", "seat", under, pin_of="seat")
    bars.close("link", "rear_frame", front, pin_of="link")
    return bars.finish()


def toggle_clamp(rng: np.random.Generator) -> Blueprint:
    """A clamp whose handle pushes its arm down over a link."""
    bars = Bars("toggle_clamp", rng, pin=0.003)
    a, d = (0.0, 0.03), (0.035, 0.03)
    b = off(a, bars.between(0.04, 0.05), bars.between(70, 95))
    c = meets(b, bars.between(0.028, 0.034), d, bars.between(0.03, 0.036))
    plate = box((-0.05, 0.0, 0.0), (0.06, 0.04, 0.006))
    webs = [hull(part, box((x - 0.01, 0, 0.0), (x + 0.01, bars.thick, 0.006)))
            for (x, z) in (a, d) for part in bars.plates(0, (x, z))]  # fmt: skip
    bars.body("base", 0, a, d, more=[plate, *webs])
    bars.body("arm", 1, a, b, off(b, 0.06, 180))
    bars.body("handle", 2, b, c, off(c, bars.between(0.08, 0.11), 60))
    bars.body("link", 1, c, d)
    bars.turn("arm", "base", a, pin_of="base")
    bars.turn("handle", "arm", b, pin_of="arm")
    bars.turn("link", "base", d, pin_of="base")
    bars.close("link", "handle", c, pin_of="link")
    return bars.finish()


def press(rng: np.random.Generator) -> Blueprint:
    """A crank that moves a ram in a guide over a rod."""
    bars = Bars("press", rng, pin=0.005)
    crank, rod = bars.between(0.03, 0.04), bars.between(0.11, 0.14)
    centre = (0.0, 0.25)
    knee = off(centre, crank, bars.between(-160, -110))
    wrist = (0.0, knee[1] - math.sqrt(rod**2 - knee[0] ** 2))
    half, low, high = 0.018, wrist[1] - 0.05, wrist[1] + 0.016
    ((near, far),) = bars.spans(1)
    back = box((-0.05, -0.02, 0.0), (0.05, -bars.gap, 0.28))
    boss = cylinder(0.012, (0.0, -0.02, centre[1]), (0.0, bars.thick, centre[1]))
    rails, ribs = [], []
    for side in (-1.0, 1.0):
        x = sorted((side * (half + bars.gap), side * 0.04))
        rails.append(box((x[0], -0.02, low - 0.03), (x[1], far, high)))
        ribs.append(box((x[0], far - 1e-3, low - 0.03), (x[1], far + 0.01, low - 0.005)))
    foot = box((-0.08, -0.05, 0.0), (0.08, 0.08, 0.012))
    cover = box((-0.04, far + bars.gap, low - 0.03), (0.04, far + 0.01, low - 0.005))
    bars.body("frame", 0, centre, more=[back, boss, *rails, *ribs, foot, cover])
    bars.body("crank", 1, centre, knee, more=bars.plates(1, centre, radius=0.016))
    bars.body("rod", 2, knee, wrist)
    bars.body("ram", 1, wrist, more=[box((-half, near - bars.thick, low), (half, far, high))])
    bars.turn("crank", "frame", centre, pin_of="frame", far=3.0)
    bars.turn("rod", "crank", knee, pin_of="crank")
    bars.workshop.slides("ram", "frame", (0, 0, 1), (wrist[0], 0, wrist[1]), (-0.03, 0.03))
    bars.close("ram", "rod", wrist, pin_of="ram")
    return bars.finish()


def parallel_gripper(rng: np.random.Generator) -> Blueprint:
    """Two fingers, each on two parallel cranks."""
    bars = Bars("parallel_gripper", rng, pin=0.004)
    long, apart, lean = bars.between(0.06, 0.08), bars.between(0.024, 0.03), bars.between(15, 35)
    inner, rows = bars.between(0.014, 0.02), []
    for side in (-1.0, 1.0):
        a1 = (side * inner, 0.1)
        a2 = (side * (inner + apart), 0.1)
        b1, b2 = (off(a, long, 90 - side * lean) for a in (a1, a2))
        rows.append((side, a1, a2, b1, b2))
    reach = inner + apart + 0.012
    palm = box((-reach, 0.0, 0.0), (reach, bars.thick, 0.105))
    bars.body("palm", 0, rows[0][2], rows[1][2], more=[palm])
    for number, (side, a1, a2, b1, b2) in enumerate(rows, 1):
        tip = [off(b1, 0.05, 90), off(b1, 0.05, 90)]
        bars.body(f"crank_{2 * number - 1}", 1, a1, b1)
        bars.body(f"crank_{2 * number}", 1, a2, b2)
        bars.body(f"finger_{number}", 2, b2, b1, tip[0])
        bars.turn(f"crank_{2 * number - 1}", "palm", a1, pin_of="palm")
        bars.turn(f"crank_{2 * number}", "palm", a2, pin_of="palm")
        bars.turn(f"finger_{number}", f"crank_{2 * number - 1}", b1, pin_of=f"crank_{2 * number - 1}")
        bars.close(f"crank_{2 * number}", f"finger_{number}", b2, pin_of=f"crank_{2 * number}")
        del side
    return bars.finish()


def lazy_tongs(rng: np.random.Generator) -> Blueprint:
    """Three crosses that extend together, held by a bracket on the wall."""
    bars = Bars("lazy_tongs", rng, pin=0.004)
    long, open_ = bars.between(0.1, 0.13), bars.between(35, 55)
    run, rise = long * math.cos(math.radians(open_)), long * math.sin(math.radians(open_))
    names: list[tuple[str, str]] = []
    plate = box((-0.03, -bars.thick - bars.gap, -0.03), (-0.012, 2 * bars.thick, rise + 0.03))
    arm = box((-0.03, -bars.thick - bars.gap, -0.009), (0.0, -bars.gap, 0.009))
    bars.body("bracket", -1, (0.0, 0.0), more=[plate, arm])
    for k in range(3):
        low, high = k * run, (k + 1) * run
        up, down = f"up_{k + 1}", f"down_{k + 1}"
        bars.body(up, 0, (low, 0.0), (high, rise))
        bars.body(down, 1, (low, rise), (high, 0.0))
        names.append((up, down))
    bars.turn("up_1", "bracket", (0.0, 0.0), pin_of="bracket")
    for k, (up, down) in enumerate(names):
        if k:
            before_up, before_down = names[k - 1]
            bars.turn(up, before_down, (k * run, 0.0), pin_of=up)
        bars.turn(down, up, ((k + 0.5) * run, 0.5 * rise), pin_of=up)
        if k:
            bars.close(down, before_up, (k * run, rise), pin_of=before_up)
    return bars.finish()


def pedal_bin(rng: np.random.Generator) -> Blueprint:
    """A bin whose pedal lifts the lid over a rod behind it."""
    bars = Bars("pedal_bin", rng, pin=0.004)
    wide, tall, deep = bars.between(0.24, 0.3), bars.between(0.32, 0.4), bars.between(0.2, 0.26)
    y = -deep - bars.gap
    shell = box((0, y, 0.05), (wide, -bars.gap, tall)) - box(
        (0.004, y + 0.004, 0.054), (wide - 0.004, -bars.gap - 0.004, tall + 1)
    )
    pedal, hinge = (0.45 * wide, 0.03), (wide - 0.015, tall + 0.012)
    joint, lift = (pedal[0] + bars.between(0.06, 0.08), 0.03), (wide + 0.015, tall + 0.004)
    feet = [box((x, y, 0.0), (x + 0.02, -bars.gap, 0.055)) for x in (0.0, wide - 0.02)]
    ears = [hull(*bars.plates(0, hinge), box((wide - 0.03, 0, tall - 0.05), (wide, bars.thick, tall - 0.03))),
            box((wide - 0.03, -bars.gap - 0.003, tall - 0.05), (wide, bars.thick, tall - 0.03)),
            hull(*bars.plates(0, pedal), box((pedal[0] - 0.01, 0, 0.06), (pedal[0] + 0.01, bars.thick, 0.08))),
            box((pedal[0] - 0.01, -bars.gap - 0.003, 0.06), (pedal[0] + 0.01, bars.thick, 0.08))]  # fmt: skip
    bars.body("bin", 0, hinge, more=[shell, *feet, *ears])
    lid = box((-0.006, y - 0.006, tall + 0.002), (wide - 0.03, 0.0, tall + 0.01))
    ledge = box((wide - 0.06, y - 0.006, tall + 0.002), (wide - 0.03, bars.thick * 2 + bars.gap, tall + 0.01))
    bars.body("lid", 1, (wide - 0.04, tall + 0.008), hinge, lift, more=[lid, ledge])
    tread = box((-0.07, -0.04, 0.022), (-0.02, 0.03, 0.03))
    bars.body("pedal", 1, (-0.03, 0.026), pedal, joint, more=[tread])
    bars.body("rod", 2, joint, lift)
    bars.turn("lid", "bin", hinge, pin_of="bin", far=1.2)
    bars.turn("pedal", "bin", pedal, pin_of="bin", far=0.3)
    bars.turn("rod", "pedal", joint, pin_of="pedal")
    bars.close("rod", "lid", lift, pin_of="lid")
    return bars.finish()


KINDS: Mapping[str, Callable[[np.random.Generator], Blueprint]] = {
    kind.__name__: kind
    for kind in (
        four_bar, desk_lamp, toolbox, scissor_lift, folding_chair, toggle_clamp, press, parallel_gripper, lazy_tongs,
        pedal_bin,
    )
}  # fmt: skip
"""Ten kinds of linkages."""


def linkage(kind: str, seed: int) -> Blueprint:
    """Draw a linkage."""
    return KINDS[kind](np.random.default_rng(seed))
