"""Mechanisms composed at random: a joint is drawn first, then geometry that allows it, and only then decoration.

They are no objects with names: panels, boxes, rods, plugs, discs and levers are put on, in and through a carrier on any
of its sides, so that size, place and joint are not tied to each other as they are in furniture.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.solids import box, cylinder, union

if TYPE_CHECKING:
    from collections.abc import Callable

    from manifold3d import Manifold

    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class _Seat:
    """A rectangle on one side of a carrier; u and v span it, n leaves it."""

    origin: FloatArray
    """Its middle [m], shape (3,)."""
    u: FloatArray
    v: FloatArray
    n: FloatArray
    width: float
    """Along u [m]."""
    height: float
    """Along v [m]."""
    depth: float
    """Of the carrier behind it [m]."""

    def at(self, u: float, v: float, n: float) -> FloatArray:
        """Point at lengths along the three directions [m], shape (3,)."""
        return np.asarray(self.origin + u * self.u + v * self.v + n * self.n)

    def block(self, u: tuple[float, float], v: tuple[float, float], n: tuple[float, float]) -> Manifold:
        """Box between bounds along the three directions [m]."""
        corners = np.array([self.at(u[i], v[j], n[k]) for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        return box(corners.min(axis=0), corners.max(axis=0))


@dataclass(frozen=True, kw_only=True, eq=False)
class _Fitted:
    """A moving part on its seat."""

    child: Manifold
    turns: bool
    axis: FloatArray
    pivot: FloatArray
    reach: float
    """Upper limit [rad or m]."""
    added: Manifold | None = None
    """To the carrier."""
    removed: Manifold | None = None
    """From the carrier."""


def compose(seed: int) -> Blueprint:
    """Return a random mechanism with 1 to 6 joints, its exact joints known."""
    rng = np.random.default_rng(seed)
    size = np.exp(rng.uniform(np.log(0.05), np.log(1.2), size=3))
    size = np.maximum(size, 0.15 * size.max())
    low = np.array([-0.5 * size[0], -0.5 * size[1], 0.0])
    builder = ObjectBuilder("composed", carves=True, look=("wood", None))
    hollow = rng.random() < 0.4
    solid = box(low, low + size)
    wall = 0.06 * float(size.min())
    if hollow:
        solid -= box(low + wall, low + size - wall)
    builder.part("carrier", solid)
    seats = _seats(low, size, int(rng.integers(1, 7)), rng)
    opened = float(rng.uniform(0.05, 0.6)) if rng.random() < 0.2 else 0.0
    for k, seat in enumerate(seats):
        recipe = _RECIPES[int(rng.integers(len(_RECIPES)))]
        repeated = _split(seat, int(rng.integers(2, 5))) if rng.random() < 0.3 else [seat]
        state = rng.bit_generator.state
        for i, part in enumerate(repeated):
            rng.bit_generator.state = state
            _mount(builder, f"part_{k}_{i}", part, recipe(part, rng, wall), opened)
    return builder.finish(f"composed_{seed}", {"seed": seed})


def _mount(builder: ObjectBuilder, name: str, seat: _Seat, fitted: _Fitted, opened: float) -> None:
    if fitted.removed is not None:
        builder.cut("carrier", fitted.removed)
    if fitted.added is not None:
        builder.part("carrier", fitted.added)
    builder.part(name, fitted.child)
    axis, pivot, reach = fitted.axis, fitted.pivot, fitted.reach
    if not fitted.turns:
        builder.slide(name, "carrier", axis, reach, pivot=pivot, rest=opened * reach)
    elif reach > 6.0:
        builder.spin(name, "carrier", axis, pivot)
    else:
        builder.hinge(name, "carrier", axis, pivot, reach, rest=opened * reach)


def _seats(low: FloatArray, size: FloatArray, count: int, rng: np.random.Generator) -> list[_Seat]:
    """Rectangles on different sides of a box, each inset by a random margin."""
    sides = rng.permutation(6)[:count]
    found = []
    for side in sides:
        k, sign = int(side) % 3, 1.0 if side < 3 else -1.0
        i, j = ((k + 1) % 3, (k + 2) % 3) if rng.random() < 0.5 else ((k + 2) % 3, (k + 1) % 3)
        middle = low + 0.5 * size
        middle[k] += 0.5 * sign * size[k]
        share = rng.uniform(0.3, 1.0, size=2) if rng.random() < 0.6 else np.ones(2)
        shift = rng.uniform(-0.5, 0.5, size=2) * (1.0 - share)
        middle[i] += shift[0] * size[i]
        middle[j] += shift[1] * size[j]
        unit = np.eye(3)
        found.append(
            _Seat(
                origin=middle,
                u=unit[i],
                v=unit[j],
                n=sign * unit[k],
                width=float(share[0] * size[i]),
                height=float(share[1] * size[j]),
                depth=float(size[k]),
            )
        )
    return found


def _split(seat: _Seat, count: int) -> list[_Seat]:
    width = seat.width / count
    return [
        _Seat(
            origin=seat.at((k + 0.5) * width - 0.5 * seat.width, 0.0, 0.0),
            u=seat.u,
            v=seat.v,
            n=seat.n,
            width=0.94 * width,
            height=seat.height,
            depth=seat.depth,
        )
        for k in range(count)
    ]


def _grip(seat: _Seat, u: float, v: float, n: float, rng: np.random.Generator) -> Manifold:
    """A handle or knob on a front."""
    size = 0.12 * min(seat.width, seat.height) + 1e-3
    long = float(rng.uniform(1.0, 4.0)) * size
    spans = [(u - 0.5 * size, u + 0.5 * size), (v - 0.5 * long, v + 0.5 * long)]
    if rng.random() < 0.5:
        spans = [(u - 0.5 * long, u + 0.5 * long), (v - 0.5 * size, v + 0.5 * size)]
    return seat.block(spans[0], spans[1], (n - 1e-4, n + size))


def _gap(rng: np.random.Generator) -> float:
    """Clearance [m]: often none, up to some millimetres."""
    return float(rng.choice([0.0, 0.0005, 0.002, 0.005]))


def _leaf(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A panel on, or let into, a side, hinged along one of its edges; a hollow may be behind it."""
    w, h = 0.5 * seat.width, 0.5 * seat.height
    thick = float(rng.uniform(0.02, 0.12)) * min(seat.width, seat.height)
    inset = rng.random() < 0.4 and thick < 0.6 * seat.depth
    gap = _gap(rng)
    n = (-thick, 0.0) if inset else (gap, gap + thick)
    leaf = seat.block((-w + gap, w - gap), (-h, h), n)
    if rng.random() < 0.7:
        leaf += _grip(seat, 0.75 * w, float(rng.uniform(-0.6, 0.6)) * h, n[1], rng)
    removed = seat.block((-w, w), (-h, h), (-thick, 0.1 * thick)) if inset else None
    if rng.random() < 0.5:
        room = seat.block((-0.9 * w, 0.9 * w), (-0.9 * h, 0.9 * h), (-0.8 * seat.depth, 1e-3))
        removed = room if removed is None else removed + room
    level = n[0] if rng.random() < 0.3 else n[1] if rng.random() < 0.5 else 0.5 * (n[0] + n[1])
    axis = np.cross(seat.n, seat.u)  # the free edge leaves the carrier
    return _Fitted(
        child=leaf,
        turns=True,
        axis=-axis if np.dot(np.cross(axis, seat.u), seat.n) < 0 else axis,
        pivot=seat.at(-w, 0.0, level),
        reach=float(rng.uniform(1.0, 2.5)),
        removed=removed,
    )


def _dial(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A disc, block or lever on a side that turns about the normal through its middle, with or without a shaft."""
    r = float(rng.uniform(0.1, 0.5)) * min(seat.width, seat.height)
    high = float(rng.uniform(0.1, 1.5)) * r
    gap = _gap(rng)
    if rng.random() < 0.6:
        child = cylinder(r, seat.at(0, 0, gap), seat.at(0, 0, gap + high))
    else:
        child = seat.block((-r, r), (-0.25 * r, 0.25 * r), (gap, gap + high))
    removed = None
    if rng.random() < 0.5:
        deep = float(rng.uniform(0.1, 0.4)) * seat.depth
        child += cylinder(0.3 * r, seat.at(0, 0, -deep), seat.at(0, 0, gap + 0.5 * high))
        removed = cylinder(0.3 * r + gap + 1e-4, seat.at(0, 0, -deep - gap), seat.at(0, 0, 0.01 * r))
    if rng.random() < 0.4:
        child += seat.block((0.4 * r, 0.95 * r), (-0.1 * r, 0.1 * r), (gap, gap + 1.2 * high))
    return _Fitted(child=child, turns=True, axis=seat.n, pivot=seat.at(0, 0, 0), reach=9.0, removed=removed)


def _lever(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A bar that lies on a side and turns about the normal at one of its ends."""
    w = 0.5 * seat.width
    wide = float(rng.uniform(0.05, 0.3)) * min(seat.width, seat.height)
    gap = _gap(rng)
    child = seat.block((-w, w), (-0.5 * wide, 0.5 * wide), (gap, gap + 0.5 * wide))
    at = -w + 0.5 * wide
    added = None
    if rng.random() < 0.6:
        pin = cylinder(0.25 * wide, seat.at(at, 0, -0.1 * wide), seat.at(at, 0, gap + 0.7 * wide))
        child -= cylinder(0.25 * wide + gap, seat.at(at, 0, -1.0 * wide), seat.at(at, 0, gap + wide))
        added = pin
    return _Fitted(child=child, turns=True, axis=seat.n, pivot=seat.at(at, 0, 0), reach=3.0, added=added)


def _arm(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A bar that stands between two ears, or in a slot, and turns about a pin across."""
    thick = float(rng.uniform(0.05, 0.25)) * min(seat.width, seat.height)
    long = float(rng.uniform(1.5, 8.0)) * thick
    up = 1.2 * thick
    gap = _gap(rng)
    child = seat.block((-0.5 * thick, 0.5 * thick), (-0.5 * thick, 0.5 * thick), (up - 0.5 * thick, up + long))
    added = None
    if rng.random() < 0.7:
        ears = [
            seat.block((-0.5 * thick, 0.5 * thick), sorted_pair(s * (0.5 * thick + gap), s * thick), (-1e-4, 1.5 * up))
            for s in (1.0, -1.0)
        ]
        added = union(*ears)
        if rng.random() < 0.6:
            added += cylinder(0.2 * thick, seat.at(0, -0.9 * thick, up), seat.at(0, 0.9 * thick, up))
            child -= cylinder(0.2 * thick + gap, seat.at(0, -thick, up), seat.at(0, thick, up))
    return _Fitted(child=child, turns=True, axis=seat.v, pivot=seat.at(0, 0, up), reach=1.2, added=added)


def sorted_pair(a: float, b: float) -> tuple[float, float]:
    """Both in ascending order."""
    return (a, b) if a < b else (b, a)


def _bail(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A bow whose two ends turn in or beside the carrier."""
    w = 0.45 * seat.width
    thick = float(rng.uniform(0.03, 0.12)) * seat.width
    high = float(rng.uniform(0.3, 1.2)) * seat.width
    low = float(rng.uniform(-0.3, 0.1)) * min(seat.depth, seat.width)
    gap = _gap(rng)
    out = 0.5 * seat.width + gap if rng.random() < 0.5 else w
    legs = [
        seat.block(sorted_pair(s * out, s * (out + thick)), (-0.5 * thick, 0.5 * thick), (low, high)) for s in (1, -1)
    ]
    top = seat.block((-out - thick, out + thick), (-0.5 * thick, 0.5 * thick), (high - thick, high))
    return _Fitted(child=union(*legs, top), turns=True, axis=seat.u, pivot=seat.at(0, 0, low + 0.5 * thick), reach=1.5)


def _flap(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A plate in an opening that swings about a line through it: a rocker, a swing lid, a throttle."""
    w, h = 0.45 * seat.width, 0.45 * seat.height
    thick = float(rng.uniform(0.03, 0.2)) * min(w, h)
    gap = max(_gap(rng), 2e-4)
    child = seat.block((-w + gap, w - gap), (-h + gap, h - gap), (-0.5 * thick, 0.5 * thick))
    removed = seat.block((-w, w), (-h, h), (-min(h, 0.8 * seat.depth), thick))
    at = float(rng.choice([0.0, 0.0, 0.8])) * h
    if rng.random() < 0.4:
        child += cylinder(0.3 * thick, seat.at(-w - 0.2 * thick, at, 0), seat.at(w + 0.2 * thick, at, 0))
    return _Fitted(child=child, turns=True, axis=seat.u, pivot=seat.at(0, at, 0), reach=0.8, removed=removed)


def _wheel(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A disc beside a side, larger than its axle."""
    r = float(rng.uniform(0.3, 1.0)) * min(seat.width, seat.height)
    thick = float(rng.uniform(0.1, 0.6)) * r
    gap = max(_gap(rng), 1e-3)
    child = cylinder(r, seat.at(0, 0, gap), seat.at(0, 0, gap + thick))
    added = None
    if rng.random() < 0.6:
        added = cylinder(0.2 * r, seat.at(0, 0, -0.01 * r), seat.at(0, 0, gap + 0.8 * thick))
        child -= cylinder(0.2 * r + gap, seat.at(0, 0, -r), seat.at(0, 0, gap + 0.8 * thick + gap))
    return _Fitted(child=child, turns=True, axis=seat.n, pivot=seat.at(0, 0, 0), reach=9.0, added=added)


def _drawer(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A box, or an open tray, in a hole of its own size; it leaves along the normal."""
    w, h = 0.46 * seat.width, 0.46 * seat.height
    deep = float(rng.uniform(0.3, 0.9)) * seat.depth
    gap = _gap(rng)
    child = seat.block((-w + gap, w - gap), (-h + gap, h - gap), (-deep, 0.0))
    if rng.random() < 0.6:
        room = 0.85
        child -= seat.block((-room * w, room * w), (-room * h, 1.1 * h), (-0.95 * deep, -0.06 * deep))
    if rng.random() < 0.6:
        front = 0.05 * min(w, h) + 1e-3
        child += seat.block((-1.05 * w, 1.05 * w), (-1.05 * h, 1.05 * h), (gap, gap + front))
        child += seat.block((-w + gap, w - gap), (-h + gap, h - gap), (-0.05 * deep, gap + front))
    if rng.random() < 0.6:
        child += _grip(seat, 0.0, float(rng.uniform(-0.5, 0.5)) * h, 0.0, rng)
    removed = seat.block((-w, w), (-h, h), (-deep - gap, 1e-3))
    return _Fitted(child=child, turns=False, axis=seat.n, pivot=seat.origin, reach=0.8 * deep, removed=removed)


def _button(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A small block or plug that stands out of a side and is pressed along the normal."""
    r = float(rng.uniform(0.08, 0.4)) * min(seat.width, seat.height)
    stands = float(rng.uniform(0.1, 1.0)) * r
    deep = float(rng.uniform(0.0, 1.0)) * min(r, 0.5 * seat.depth)
    gap = _gap(rng)
    if rng.random() < 0.5:
        child = cylinder(r, seat.at(0, 0, -deep), seat.at(0, 0, stands))
        removed = cylinder(r + gap + 1e-4, seat.at(0, 0, -deep - stands), seat.at(0, 0, 0.01 * r))
    else:
        v = float(rng.uniform(0.5, 1.5)) * r
        child = seat.block((-r, r), (-v, v), (-deep, stands))
        removed = seat.block((-r - gap, r + gap), (-v - gap, v + gap), (-deep - stands, 0.01 * r))
    return _Fitted(
        child=child,
        turns=False,
        axis=-seat.n,
        pivot=seat.origin,
        reach=0.8 * stands,
        removed=removed if rng.random() < 0.7 else None,
    )


def _pane(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A panel on a side that slides along it, in grooves or free."""
    w, h = float(rng.uniform(0.25, 0.48)) * seat.width, 0.45 * seat.height
    thick = float(rng.uniform(0.02, 0.1)) * min(seat.width, seat.height)
    gap = _gap(rng)
    at = float(rng.choice([-1.0, 1.0])) * (0.5 * seat.width - w)
    child = seat.block((at - w, at + w), (-h, h), (gap, gap + thick))
    added = None
    if rng.random() < 0.6:
        lips = [
            seat.block(
                (-0.5 * seat.width, 0.5 * seat.width),
                sorted_pair(s * (h + gap), s * (h + gap + thick)),
                (-1e-4, 1.8 * thick),
            )
            for s in (1.0, -1.0)
        ]
        added = union(*lips)
    removed = None
    if rng.random() < 0.5:
        removed = seat.block((-0.45 * seat.width, 0.45 * seat.width), (-0.8 * h, 0.8 * h), (-0.8 * seat.depth, 1e-4))
    if rng.random() < 0.4:
        child += _grip(seat, at, 0.0, gap + thick, rng)
    sign = -np.sign(at)
    reach = max(seat.width - 2.0 * w, 0.1 * w)
    return _Fitted(
        child=child, turns=False, axis=sign * seat.u, pivot=seat.origin, reach=reach, added=added, removed=removed
    )


def _plunger(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A rod, post or tube that goes through a side along its own length."""
    r = float(rng.uniform(0.05, 0.3)) * min(seat.width, seat.height)
    out = float(rng.uniform(1.0, 6.0)) * r
    deep = float(rng.uniform(0.3, 0.9)) * seat.depth
    gap = _gap(rng)
    square = rng.random() < 0.5
    if square:
        child = seat.block((-r, r), (-r, r), (-deep, out))
        removed = seat.block((-r - gap, r + gap), (-r - gap, r + gap), (-deep - gap, 1e-3))
    else:
        child = cylinder(r, seat.at(0, 0, -deep), seat.at(0, 0, out))
        removed = cylinder(r + gap + 1e-4, seat.at(0, 0, -deep - gap), seat.at(0, 0, 1e-3))
    if rng.random() < 0.5:
        child += seat.block((-2.5 * r, 2.5 * r), (-1.5 * r, 1.5 * r), (out, out + r))
    return _Fitted(child=child, turns=False, axis=seat.n, pivot=seat.origin, reach=0.7 * deep, removed=removed)


def _carriage(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A block that rides on a rail along a side."""
    wide = float(rng.uniform(0.1, 0.4)) * seat.height
    long = float(rng.uniform(0.1, 0.4)) * seat.width
    gap = _gap(rng)
    rail = seat.block((-0.5 * seat.width, 0.5 * seat.width), (-0.25 * wide, 0.25 * wide), (-1e-4, 0.5 * wide))
    at = float(rng.uniform(-0.4, 0.4)) * (seat.width - long)
    child = seat.block((at - 0.5 * long, at + 0.5 * long), (-0.5 * wide, 0.5 * wide), (gap, wide))
    child -= seat.block((-seat.width, seat.width), (-0.25 * wide - gap, 0.25 * wide + gap), (-1.0, 0.5 * wide + gap))
    return _Fitted(child=child, turns=False, axis=seat.u, pivot=seat.origin, reach=0.3 * seat.width, added=rail)


def _cap(seat: _Seat, rng: np.random.Generator, wall: float) -> _Fitted:
    """A lid that reaches over a spout, or lies on a side, and is drawn off along the normal."""
    r = float(rng.uniform(0.2, 0.48)) * min(seat.width, seat.height)
    high = float(rng.uniform(0.2, 1.0)) * r
    gap = max(_gap(rng), 2e-4)
    spout = cylinder(0.8 * r, seat.at(0, 0, -1e-4), seat.at(0, 0, 0.8 * high))
    child = cylinder(r, seat.at(0, 0, gap), seat.at(0, 0, high))
    child -= cylinder(0.8 * r + gap, seat.at(0, 0, -high), seat.at(0, 0, 0.8 * high + gap))
    return _Fitted(child=child, turns=False, axis=seat.n, pivot=seat.origin, reach=high, added=spout)


_RECIPES: tuple[Callable[[_Seat, np.random.Generator, float], _Fitted], ...] = (
    _leaf,
    _leaf,
    _leaf,
    _dial,
    _lever,
    _arm,
    _bail,
    _flap,
    _wheel,
    _drawer,
    _drawer,
    _button,
    _pane,
    _plunger,
    _carriage,
    _cap,
)
