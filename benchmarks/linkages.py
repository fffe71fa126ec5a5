"""Linkages of known joints: flat bars in layers, with pins in holes; seen while the code was written."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.solids import bore, box, cylinder, hull

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.blueprint import Blueprint

Plane = tuple[float, float]
"""x and z [m]."""


class Bars:
    """A mechanism in the plane of x and z; bars lie in layers along y."""

    def __init__(self, name: str, rng: np.random.Generator, *, pin: float) -> None:
        """Begin a mechanism.

        Args:
            name: Of the object.
            rng: Draws sizes.
            pin: Radius of the pins [m].
        """
        self.builder = ObjectBuilder(name, carves=True, look=("metal", None))
        self.rng, self.pin = rng, pin
        self.thick, self.gap = 1.6 * pin, 0.08 * pin
        self._layer: dict[str, int] = {}

    def between(self, low: float, high: float) -> float:
        """Draw a number between two."""
        return float(self.rng.uniform(low, high))

    def plates(self, layer: int, *points: Plane) -> list[Manifold]:
        """Return a bar with round ends through points, in its layer."""
        low, high = self.span(layer)
        ends = [cylinder(2.4 * self.pin, (x, low, z), (x, high, z)) for x, z in points]
        return [hull(one, other) for one, other in pairwise(ends)] or ends

    def body(self, name: str, layer: int, *points: Plane, more: Sequence[Manifold] = ()) -> None:
        """Add a bar, with more solids that belong to it."""
        self.builder.part(name, *self.plates(layer, *points), *more)
        self._layer[name] = layer

    def bolt(self, inner: str, outer: str, at: Plane) -> None:
        """Add a pin of the one body in a hole of the other; no joint yet."""
        (x, z), mine, its = at, self.span(self._layer[inner]), self.span(self._layer[outer])
        self.builder.cut(outer, bore(self.pin, self.gap, (x, its[0] - self.thick, z), (x, its[1] + self.thick, z)))
        self.builder.part(inner, cylinder(self.pin, (x, min(mine[0], its[0]), z), (x, max(mine[1], its[1]), z)))

    def turn(self, child: str, parent: str, at: Plane, *, pin_of: str) -> None:
        """Add a hinge of the tree."""
        self.bolt(pin_of, parent if pin_of == child else child, at)
        self.builder.hinge(child, parent, (0, 1, 0), (at[0], 0, at[1]), 1.0, -1.0)

    def close(self, one: str, other: str, at: Plane, *, pin_of: str) -> None:
        """Add a hinge that closes a chain."""
        self.bolt(pin_of, other if pin_of == one else one, at)
        self.builder.close(other, one, (at[0], 0, at[1]))

    def finish(self) -> Blueprint:
        """Return the object as it is shown."""
        return self.builder.finish()

    def span(self, layer: int) -> tuple[float, float]:
        """Return where a layer begins and ends along y [m]."""
        low = layer * (self.thick + self.gap)
        return low, low + self.thick


def meets(one: Plane, reach: float, other: Plane, span: float) -> Plane:
    """Return the point at a distance from each of two points, above the line from one to the other."""
    between = np.subtract(other, one)
    apart = float(np.linalg.norm(between))
    along = (reach**2 - span**2 + apart**2) / (2.0 * apart)
    aside = math.sqrt(reach**2 - along**2)
    x, z = np.add(one, along / apart * between) + aside / apart * np.array([-between[1], between[0]])
    return float(x), float(z)


def off(point: Plane, long: float, degrees: float) -> Plane:
    """Return the point at a distance in a direction from x towards z."""
    turn = math.radians(degrees)
    return point[0] + long * math.cos(turn), point[1] + long * math.sin(turn)


def four_bar(rng: np.random.Generator) -> Blueprint:
    """Draw a ground, two bars on it and one between their ends, of any lengths."""
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


def toggle_clamp(rng: np.random.Generator) -> Blueprint:
    """Draw a clamp whose handle pushes its arm down over a link."""
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


KINDS: Mapping[str, Callable[[np.random.Generator], Blueprint]] = {
    "four_bar": four_bar,
    "toggle_clamp": toggle_clamp,
}
"""Kinds of linkages."""


def linkage(kind: str, seed: int) -> Blueprint:
    """Draw a linkage."""
    return KINDS[kind](np.random.default_rng(seed))
