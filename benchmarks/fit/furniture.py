"""Furniture and household things as collections of drawn models have them, for the fit.

Bodies are panels, thin boxes or sheets without a thickness; doors and drawers lie flush in a front or stand a little
proud of it, with small gaps and no hinge between; handles are fused into what they move; knobs are short cylinders,
cones and discs in rows, buttons flat and small. All of it is general knowledge of such things: no proportion is that of
an object that judges.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias, TypeVar

import numpy as np

from kinematify.assembly.part import Part
from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.robot.arrays import FloatArray, IntArray

T = TypeVar("T")
Mesh: TypeAlias = "tuple[FloatArray, IntArray]"
Rect = tuple[float, float, float, float]
"""u and v of the lower left corner, u and v of the upper right one [m]."""
_QUADS = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
"""Corners of the faces of a box, seen from outside: below and above in n, then v, then u."""


@dataclass(frozen=True, eq=False)
class Side:
    """A plane that things are put on: u to the right and v up in it, n out of it. All three are unit vectors."""

    origin: FloatArray
    u: FloatArray
    v: FloatArray

    @property
    def n(self) -> FloatArray:
        """Out of the plane, shape (3,)."""
        return np.cross(self.u, self.v)

    def at(self, u: float, v: float, n: float = 0.0, *, turned: float = 0.0) -> Side:
        """The same at another point of it, turned about n [rad]."""
        c, s = np.cos(turned), np.sin(turned)
        middle = self.origin + u * self.u + v * self.v + n * self.n
        return Side(middle, c * self.u + s * self.v, c * self.v - s * self.u)

    def tilted(self, angle: float) -> Side:
        """The same, turned about u [rad]."""
        return Side(self.origin, self.u, np.cos(angle) * self.v + np.sin(angle) * self.n)

    def world(self, points: FloatArray) -> FloatArray:
        """Points (u, v, n) in the world, shape (..., 3)."""
        return np.asarray(self.origin + points @ np.array([self.u, self.v, self.n]))


X, Y, Z = np.eye(3)


def front(y: float = 0.0) -> Side:
    """What looks towards -y."""
    return Side(np.array([0.0, y, 0.0]), X, Z)


def top(z: float = 0.0) -> Side:
    """What looks up."""
    return Side(np.array([0.0, 0.0, z]), X, Y)


def bar(
    u: tuple[float, float], v: tuple[float, float], n: tuple[float, float], *, without: tuple[int, ...] = ()
) -> Mesh:
    """A box between bounds, some of its faces left out; a sheet where bounds of n are equal."""
    corners = np.array([[a, b, c] for c in n for b in v for a in u], dtype=float)
    quads = _QUADS[[k for k in (range(1) if n[0] == n[1] else range(6)) if k not in without]]
    return corners, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def rod(start: tuple[float, ...], end: tuple[float, ...], radius: float, sides: int, *, narrow: float = 1.0) -> Mesh:
    """A cylinder or, with `narrow` < 1, what becomes narrower towards its end."""
    low, high = np.asarray(start, float), np.asarray(end, float)
    along = (high - low) / np.linalg.norm(high - low)
    across = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    across /= np.linalg.norm(across)
    turns = 2 * np.pi * np.arange(sides) / sides
    ring = np.cos(turns)[:, None] * across + np.sin(turns)[:, None] * np.cross(along, across)
    k, m = np.arange(sides), (np.arange(sides) + 1) % sides
    vertices = np.concatenate([low + radius * ring, high + narrow * radius * ring, [low, high]])
    walls = [np.column_stack([k, m, m + sides]), np.column_stack([k, m + sides, k + sides])]
    ends = [np.column_stack([m, k, 0 * k + 2 * sides]), np.column_stack([k + sides, m + sides, 0 * k + 2 * sides + 1])]
    return vertices, np.concatenate([*walls, *ends])


def ring(radius: float, inner: float, n: tuple[float, float], sides: int) -> Mesh:
    """A flat ring about n."""
    turns = 2 * np.pi * np.arange(sides) / sides
    round_ = np.column_stack([np.cos(turns), np.sin(turns)])
    loops = [
        np.column_stack([r * round_, np.full(sides, z)])
        for r, z in ((radius, n[0]), (radius, n[1]), (inner, n[1]), (inner, n[0]))
    ]
    k, m = np.arange(sides), (np.arange(sides) + 1) % sides
    pairs = [(a * sides, ((a + 1) % 4) * sides) for a in range(4)]
    faces = [
        np.concatenate([np.column_stack([k + a, m + a, m + b]), np.column_stack([k + a, m + b, k + b])])
        for a, b in pairs
    ]
    return np.concatenate(loops), np.concatenate(faces)


class Drawing:
    """Parts and joints as they are drawn, in one way of modelling."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.meshes: dict[str, list[Mesh]] = {}
        self.joints: list[BlueprintJoint] = []
        self.thin = self.maybe(0.3)
        """Panels of bodies are sheets."""
        self.board = self.draw(0.006, 0.022)
        self.gap = float(self.pick(0.0, 0.0005, 0.001, 0.002, 0.004))
        self.sides = int(self.pick(8, 12, 16, 24, 32, 48))
        self.grip = self.pick("bar", "bar", "knob", "plate", "lip", "none")
        self.front = self.pick("flush", "flush", "proud", "inset")

    def draw(self, low: float, high: float) -> float:
        """Any number between two."""
        return float(self.rng.uniform(low, high))

    def pick(self, *some: T) -> T:
        """One of some."""
        return some[int(self.rng.integers(len(some)))]

    def maybe(self, share: float = 0.5) -> bool:
        """True that often."""
        return bool(self.rng.random() < share)

    def count(self, low: int, high: int) -> int:
        """Any whole number from one to another."""
        return int(self.rng.integers(low, high + 1))

    def name(self, kind: str) -> str:
        """A name that no part has yet."""
        return f"{kind}_{len(self.meshes)}"

    def put(self, name: str, side: Side, *meshes: Mesh) -> str:
        """Add to a part, whose name returns."""
        self.meshes.setdefault(name, []).extend((side.world(v), f) for v, f in meshes)
        return name

    def turns(
        self, child: str, parent: str, side: Side, axis: FloatArray, at: tuple[float, ...], *, upper: float
    ) -> None:
        """About a line through a point of a side; both ways or without end where `upper` is 0."""
        bounds = self.pick((-np.inf, np.inf), (-2.5, 2.5), (0.0, 4.7)) if upper == 0.0 else (0.0, upper)
        kind = JointType.CONTINUOUS if np.isinf(bounds[1]) else JointType.REVOLUTE
        self._joins(child, parent, kind, (axis, side.world(np.array(at, float))), bounds)

    def slides(self, child: str, parent: str, axis: FloatArray, upper: float) -> None:
        """Along a direction, from where it is."""
        self._joins(child, parent, JointType.PRISMATIC, (axis, np.zeros(3)), (0.0, upper))

    def _joins(
        self, child: str, parent: str, kind: JointType, line: tuple[FloatArray, FloatArray], bounds: tuple[float, float]
    ) -> None:
        (axis, pivot), (lower, upper) = line, bounds
        self.joints.append(
            BlueprintJoint(parent=parent, child=child, kind=kind, axis=axis, pivot=pivot, lower=lower, upper=upper)
        )

    # ---- what furniture is made of -------------------------------------------------------------------------------

    def case(self, name: str, side: Side, rect: Rect, depth: float, *, back: float = 0.0) -> None:
        """A box that is open in front, of panels or sheets; now and then a closed one."""
        (a, b, c, d), t = rect, self.board
        if self.maybe(0.12):
            self.put(
                name, side, bar((a, c), (b, d), (-depth, back - self.gap - (0.02 if self.front != "proud" else 0.0)))
            )
        elif self.thin:
            self.put(name, side, bar((a, c), (b, d), (-depth, back), without=(1,)))
        else:
            walls = [((a, a + t), (b, d)), ((c - t, c), (b, d)), ((a, c), (b, b + t)), ((a, c), (d - t, d))]
            self.put(
                name, side, bar((a, c), (b, d), (-depth, -depth + t)), *(bar(u, v, (-depth, back)) for u, v in walls)
            )

    def handle(self, name: str, side: Side, rect: Rect, edge: str, n: float) -> None:
        """Fused into a door or drawer near an edge: 'left', 'right', 'top', 'bottom' or 'middle'."""
        a, b, c, d = rect
        w, h, far = c - a, d - b, self.draw(0.05, 0.14)
        u = {"left": a + far * w, "right": c - far * w}.get(edge, 0.5 * (a + c))
        v = {"bottom": b + far * h, "top": d - far * h}.get(
            edge, b + h * self.draw(0.35, 0.65) if edge in ("left", "right") else 0.5 * (b + d)
        )
        upright = edge in ("left", "right")
        length = (h if upright else w) * self.draw(0.1, 0.8)
        r = self.draw(0.004, 0.009)
        half = (r, 0.5 * length) if upright else (0.5 * length, r)
        out = n + self.draw(0.015, 0.05)
        place = side.at(u, v)
        if self.grip == "bar":
            ends = [(0.0, s * half[1] * 0.9) if upright else (s * half[0] * 0.9, 0.0) for s in (-1, 1)]
            self.put(
                name,
                place,
                bar((-half[0], half[0]), (-half[1], half[1]), (out - 2 * r, out)),
                *(rod((*e, n), (*e, out - r), r, 8) for e in ends),
            )
        elif self.grip == "knob":
            size = min(self.draw(0.008, 0.02), 0.2 * min(w, h))
            spots = [(-0.3 * w, 0.0), (0.3 * w, 0.0)] if not upright and w > 0.5 else [(0.0, 0.0)]
            for spot in spots:
                self.put(
                    name,
                    place,
                    rod((*spot, n), (*spot, out), 0.5 * size, self.sides),
                    rod((*spot, out - 0.4 * size), (*spot, out + 0.4 * size), size, self.sides),
                )
        elif self.grip == "plate":
            self.put(name, place, bar((-half[0], half[0]), (-half[1], half[1]), (n, out)))
        elif self.grip == "lip" and not upright:
            self.put(name, side, bar((a, c), (v, v + 2 * r), (n, n + self.draw(0.008, 0.03))))

    def panel(self, name: str, side: Side, rect: Rect, n: tuple[float, float]) -> None:
        """A slab, a frame with a pane, or a slab with a raised field."""
        a, b, c, d = rect
        w, style = min(c - a, d - b) * self.draw(0.08, 0.2), self.rng.random()
        thin = 0.3 * (n[1] - n[0])
        if style < 0.22:
            sticks = [
                ((a, a + w), (b, d)),
                ((c - w, c), (b, d)),
                ((a + w, c - w), (b, b + w)),
                ((a + w, c - w), (d - w, d)),
            ]
            self.put(
                name,
                side,
                *(bar(u, v, n) for u, v in sticks),
                bar((a + w, c - w), (b + w, d - w), (n[0] + thin, n[1] - thin)),
            )
        else:
            self.put(name, side, bar((a, c), (b, d), n, without=(0,) if self.thin and self.maybe() else ()))
            if style > 0.8:
                self.put(name, side, bar((a + w, c - w), (b + w, d - w), (n[1], n[1] + thin)))

    def level(self, thick: float) -> tuple[float, float]:
        """Where a front of a thickness begins and ends."""
        if self.front == "inset":
            thick = thick + self.draw(0.0, 0.015)
            return -thick, -self.draw(0.0, 0.3) * thick
        return (-thick, 0.0) if self.front == "flush" else (self.gap, self.gap + thick)

    def within(self, rect: Rect) -> Rect:
        """A rectangle less the gap; less the wall in front of which nothing lies flush."""
        g = self.gap + (self.board if self.front != "proud" and not self.thin else 0.0)
        return rect[0] + g, rect[1] + g, rect[2] - g, rect[3] - g

    def door(
        self, parent: str, side: Side, rect: Rect, hinged: str, *, upper: float | None = None, inside: bool = False
    ) -> str:
        """Hinged at an edge, with a handle at the other one."""
        a, b, c, d = rect
        n = self.level(self.draw(0.008, 0.035))
        name = self.name("door")
        self.panel(name, side, rect, n)
        away = {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}[hinged]
        self.handle(name, side, rect, away, n[1])
        if inside:
            deep = self.draw(0.04, 0.1)
            for k in range(self.count(1, 3)):
                v = b + (d - b) * (0.15 + 0.25 * k)
                self.put(name, side, bar((a + 0.06, c - 0.06), (v, v + 0.06), (n[0] - deep, n[0])))
        axis = {"left": -side.v, "right": side.v, "bottom": side.u, "top": -side.u}[hinged]
        level = self.pick(n[0], n[1], 0.5 * (n[0] + n[1]), n[1])
        at = {"left": (a, 0, level), "right": (c, 0, level), "bottom": (0, b, level), "top": (0, d, level)}[hinged]
        self.turns(name, parent, side, axis, at, upper=upper or self.draw(1.4, 2.6))
        return name

    def drawer(self, parent: str, side: Side, rect: Rect, depth: float) -> str:
        """A front with a tray behind it, a box or a board alone."""
        a, b, c, d = rect
        n, t, style = self.level(self.draw(0.008, 0.03)), self.draw(0.004, 0.012), self.rng.random()
        name = self.name("drawer")
        self.panel(name, side, rect, n)
        self.handle(name, side, rect, self.pick("middle", "middle", "top"), n[1])
        i, deep = self.draw(0.004, 0.02) + self.board, depth * self.draw(0.6, 0.95)
        u, v = (a + i, c - i), (b + self.draw(0.003, 0.02), d - min(i + 0.01, 0.4 * (d - b)))
        if style < 0.65 and min(u[1] - u[0], v[1] - v[0]) > 0.01:
            if self.thin:
                self.put(name, side, bar(u, v, (-deep, n[0]), without=(1, 3)))
            else:
                walls = [
                    bar((u[0], u[0] + t), v, (-deep, n[0])),
                    bar((u[1] - t, u[1]), v, (-deep, n[0])),
                    bar(u, (v[0], v[0] + t), (-deep, n[0])),
                    bar(u, v, (-deep, -deep + t)),
                ]
                self.put(name, side, *walls)
        elif style < 0.85 and min(u[1] - u[0], v[1] - v[0]) > 0.01:
            self.put(name, side, bar(u, v, (-deep, n[0])))
        self.slides(name, parent, side.n, deep * self.draw(0.6, 1.0))
        return name

    def knobs(self, parent: str, spots: list[Side], radius: float) -> None:
        """Alike ones at several places, turned about n."""
        style, high = (
            self.pick("plain", "plain", "cone", "stepped", "bar", "mark", "wings"),
            radius * self.draw(0.35, 1.6),
        )
        sunk, narrow, alike = self.draw(-0.2, 0.15) * high, self.draw(0.6, 0.95), self.draw(0, 2 * np.pi)
        foot = self.gap if sunk > 0 else sunk
        for spot in spots:
            name = self.name("knob")
            place = spot.at(0, 0, turned=alike if self.maybe(0.8) else self.draw(0, 6))
            body = rod((0, 0, foot), (0, 0, high), radius, self.sides, narrow=narrow if style == "cone" else 1.0)
            if style == "stepped":
                body = rod((0, 0, foot), (0, 0, 0.3 * high), radius, self.sides)
                self.put(name, place, rod((0, 0, 0.3 * high), (0, 0, high), radius * narrow * 0.8, self.sides))
            if style == "bar":
                body = rod((0, 0, foot), (0, 0, 0.4 * high), radius, self.sides)
                self.put(name, place, bar((-0.18 * radius, 0.18 * radius), (-radius, radius), (0.4 * high, high)))
            if style == "mark":
                self.put(
                    name,
                    place,
                    bar((-0.05 * radius, 0.05 * radius), (0.4 * radius, 0.95 * radius), (high, high + 0.06 * radius)),
                )
            if style == "wings":
                body = rod((0, 0, foot), (0, 0, high), 0.6 * radius, self.sides)
                self.put(
                    name, place, bar((-0.2 * radius, 0.2 * radius), (-1.4 * radius, 1.4 * radius), (0.5 * high, high))
                )
            self.put(name, place, body)
            self.turns(name, parent, place, place.n, (0, 0, 0), upper=0.0)

    def buttons(self, parent: str, spots: list[Side], width: float, height: float) -> None:
        """Flat ones at several places, pressed along n."""
        proud, sunk, round_ = (
            self.draw(0.0003, 0.35) * min(width, height),
            self.draw(-0.5, 0.5) * min(width, height),
            self.maybe(0.4),
        )
        sunk = min(sunk, 0.2 * proud) if sunk > 0 else sunk
        for spot in spots:
            name = self.name("button")
            shape = (
                rod((0, 0, sunk), (0, 0, proud), 0.5 * min(width, height), self.sides, narrow=self.pick(1.0, 1.0, 0.9))
                if round_
                else bar((-0.5 * width, 0.5 * width), (-0.5 * height, 0.5 * height), (sunk, proud))
            )
            self.put(name, spot, shape)
            self.slides(name, parent, -spot.n, max(proud, 0.001) * self.draw(0.6, 1.5))

    def grid(self, side: Side, rect: Rect, columns: int, rows: int) -> list[Side]:
        """Middles of the fields of a rectangle."""
        a, b, c, d = rect
        return [
            side.at(a + (i + 0.5) * (c - a) / columns, b + (j + 0.5) * (d - b) / rows)
            for j in range(rows)
            for i in range(columns)
        ]

    def controls(self, parent: str, side: Side, rect: Rect, *, most: int = 5) -> None:
        """Knobs, buttons or both on a strip; a display where there is room."""
        a, b, c, d = rect
        w, h = c - a, d - b
        long = w >= h
        share = self.pick(0.0, 0.0, 1.0, 1.0, 0.4, 0.6)  # of the strip that is knobs
        split = a + share * w if long else b + share * h
        for kind, part in (
            ("knob", (a, b, split, d) if long else (a, b, c, split)),
            ("button", (split, b, c, d) if long else (a, split, c, d)),
        ):
            pw, ph = part[2] - part[0], part[3] - part[1]
            if min(pw, ph) < 0.01:
                continue
            many = self.count(1, most)
            columns, rows = (many, 1) if pw > ph else (1, many)
            if kind == "button" and self.maybe(0.4):
                columns, rows = self.pick((3, 2), (2, 2), (2, 3), (4, 1), (1, 4))
            cell = min(pw / columns, ph / rows)
            spots = self.grid(side, part, columns, rows)
            if kind == "knob":
                self.knobs(parent, spots, min(cell * self.draw(0.2, 0.42), 0.035))
            else:
                width, height = (
                    min(self.draw(0.3, 0.8) * pw / columns, 0.04),
                    min(self.draw(0.3, 0.8) * ph / rows, 0.03),
                )
                self.buttons(parent, spots, width, height)

    def fill(self, parent: str, side: Side, rect: Rect, depth: float, *, doors: float = 0.5) -> None:
        """Doors, drawers, flaps or shelves in a rectangle of a front, more of them the larger it is."""
        if len(self.joints) >= 9:
            return
        a, b, c, d = rect
        w, h = c - a, d - b
        if max(w, h) > 0.45 and self.maybe(0.75):
            many = self.count(2, 3)
            cuts = (
                np.linspace(0, 1, many + 1)
                if self.maybe(0.6)
                else np.array([0, *np.sort(self.rng.uniform(0.25, 0.75, many - 1)), 1])
            )
            if np.diff(cuts).min() * max(w, h) > 0.12:
                for lo, hi in pairwise(cuts):
                    sub = (a + lo * w, b, a + hi * w, d) if w > h else (a, b + lo * h, c, b + hi * h)
                    self.fill(parent, side, sub, depth, doors=doors)
                t = 0.0 if self.thin else 0.5 * self.board
                for cut in cuts[1:-1]:
                    x = a + cut * w if w > h else b + cut * h
                    self.put(
                        parent,
                        side,
                        bar((x - t, x + t), (b, d), (-depth, 0)) if w > h else bar((a, c), (x - t, x + t), (-depth, 0)),
                    )
                return
        inner = self.within(rect)
        if min(inner[2] - inner[0], inner[3] - inner[1]) < 0.03:
            return
        kind = self.rng.random()
        if kind < 0.08:
            return  # a shelf
        if kind < 0.08 + 0.92 * doors * min(h / max(w, 1e-9), 1.2):
            if w > 0.5 and self.maybe(0.6):
                middle = 0.5 * (inner[0] + inner[2])
                g = max(0.5 * self.gap, 0.0005)
                self.door(parent, side, (inner[0], inner[1], middle - g, inner[3]), "left")
                self.door(parent, side, (middle + g, inner[1], inner[2], inner[3]), "right")
            else:
                self.door(parent, side, inner, self.pick("left", "right"))
        elif self.maybe(0.1):
            self.door(parent, side, inner, self.pick("bottom", "top"), upper=1.57)
        else:
            self.drawer(parent, side, inner, depth)

    def legs(self, name: str, w: float, depth: float, high: float, thick: float, *, y: float) -> None:
        """Four of them below a body."""
        for x in (-0.5 * w + thick, 0.5 * w - thick):
            for at in (y + thick, y + depth - thick):
                self.put(
                    name,
                    top(),
                    bar((x - 0.5 * thick, x + 0.5 * thick), (at - 0.5 * thick, at + 0.5 * thick), (0, high)),
                )


# ---- kinds ---------------------------------------------------------------------------------------------------------


def cabinet(d: Drawing) -> None:
    """Doors and drawers in a body, on legs, a plinth or the floor; a top that overhangs."""
    w, h, depth, foot = d.draw(0.35, 1.6), d.draw(0.4, 1.9), d.draw(0.3, 0.6), d.pick(0.0, 0.0, d.draw(0.05, 0.2))
    side = front().at(0, foot)
    d.case("body", side, (-0.5 * w, 0, 0.5 * w, h), depth)
    if foot and d.maybe():
        d.legs("body", w, depth, foot, d.draw(0.03, 0.06), y=0.0)
    elif foot:
        d.put("body", front(), bar((-0.5 * w, 0.5 * w), (0, foot), (-depth, -0.03)))
    if d.maybe(0.4):
        o = d.draw(0.0, 0.04)
        d.put("body", side, bar((-0.5 * w - o, 0.5 * w + o), (h, h + d.draw(0.01, 0.04)), (-depth, o)))
    d.fill("body", side, (-0.5 * w, 0, 0.5 * w, h), depth, doors=d.draw(0.1, 1.0))


def desk(d: Drawing) -> None:
    """A table with drawers below its top, or a pedestal."""
    w, h, depth, t = d.draw(0.8, 1.8), d.draw(0.65, 0.85), d.draw(0.45, 0.8), d.draw(0.015, 0.04)
    d.put("body", front(), bar((-0.5 * w, 0.5 * w), (h - t, h), (-depth, d.draw(0, 0.02))))
    d.legs("body", w, depth, h - t, d.draw(0.03, 0.08), y=0.0)
    low = h - t - d.draw(0.1, 0.2)
    if d.maybe(0.6):
        d.case("body", front(), (-0.4 * w, low, 0.4 * w, h - t), 0.9 * depth)
        many = d.count(1, 3)
        for k in range(many):
            u = -0.4 * w + np.array([k, k + 1]) * 0.8 * w / many
            d.drawer("body", front(), d.within((u[0], low, u[1], h - t)), 0.9 * depth)
    for left in (-1, 1):
        if d.maybe(0.35):
            a = min(left * 0.48 * w, left * 0.2 * w)
            d.case("body", front(), (a, 0.08, a + 0.28 * w, low), 0.9 * depth)
            d.fill("body", front(), (a, 0.08, a + 0.28 * w, low), 0.9 * depth, doors=0.3)


def fridge(d: Drawing) -> None:
    """One to three doors with shelves inside, drawers below."""
    w, h, depth = d.draw(0.5, 0.95), d.draw(0.8, 2.0), d.draw(0.5, 0.75)
    d.board = d.draw(0.02, 0.05)
    d.front = d.pick("proud", "proud", "flush")
    d.case("body", front(), (-0.5 * w, 0, 0.5 * w, h), depth)
    cut = h * d.pick(0.0, 0.3, 0.35, 0.65, 0.7)
    halves = d.maybe(0.25)
    hinged = d.pick("left", "right")
    for low, high in ((0.0, cut), (cut, h)):
        if high - low < 0.1:
            continue
        rect = d.within((-0.5 * w, low, 0.5 * w, high))
        if low == 0.0 and high < 0.5 * h and d.maybe(0.4):
            d.drawer("body", front(), rect, depth)
        elif halves:
            d.door("body", front(), (rect[0], rect[1], -0.001, rect[3]), "left", inside=d.maybe())
            d.door("body", front(), (0.001, rect[1], rect[2], rect[3]), "right", inside=d.maybe())
        else:
            d.door("body", front(), rect, hinged, inside=d.maybe())
    if d.maybe(0.3):
        d.slides(
            d.put(
                d.name("shelf"), front(), bar((-0.4 * w, 0.4 * w), (0.15 * h, 0.15 * h + 0.15), (-0.85 * depth, -0.1))
            ),
            "body",
            front().n,
            0.5 * depth,
        )


def oven(d: Drawing) -> None:
    """A drop-down door below a row of knobs; burners, a drawer and a lid with some."""
    w, h, depth = d.draw(0.5, 0.9), d.draw(0.5, 0.95), d.draw(0.45, 0.65)
    d.board = d.draw(0.01, 0.04)
    d.grip = d.pick("bar", "bar", "lip")
    d.case("body", front(), (-0.5 * w, 0, 0.5 * w, h), depth)
    strip = h * d.draw(0.1, 0.2)
    face = d.pick(0.0, 0.0, d.draw(0.0, 0.03))
    d.put("body", front(), bar((-0.5 * w, 0.5 * w), (h - strip, h), (-0.1, face)))
    panel = front().at(0, 0, face)
    if d.maybe(0.3):  # on a back panel or on top
        d.put("body", front(), bar((-0.5 * w, 0.5 * w), (h, h + strip), (-depth, -depth + 0.06)))
        panel = d.pick(front().at(0, strip, -depth + 0.06), panel)
    d.controls("body", panel, (-0.47 * w, h - strip * 0.9, 0.47 * w, h - strip * 0.1), most=6)
    low = h * d.pick(0.0, 0.0, d.draw(0.15, 0.25))
    d.door(
        "body",
        front(),
        d.within((-0.5 * w, low, 0.5 * w, h - strip)),
        d.pick("bottom", "bottom", "bottom", "left"),
        upper=1.57,
    )
    if low:
        d.drawer("body", front(), d.within((-0.5 * w, 0, 0.5 * w, low)), depth)
    for _ in range(d.pick(0, 0, 1, 2)):
        v = d.draw(low + 0.1, h - strip - 0.05)
        rack = [bar((x, x + 0.006), (v, v + 0.006), (-0.9 * depth, -0.06)) for x in np.linspace(-0.42 * w, 0.41 * w, 6)]
        d.slides(
            d.put(d.name("rack"), front(), *rack, bar((-0.42 * w, 0.42 * w), (v, v + 0.006), (-0.07, -0.06))),
            "body",
            front().n,
            0.7 * depth,
        )
    for spot in d.grid(top(h), (-0.4 * w, 0.1 * depth, 0.4 * w, 0.9 * depth), 2, 2) if d.maybe() else []:
        d.put("body", spot, ring(0.09, 0.05, (0.0, 0.012), d.sides))
    if d.maybe(0.15):
        d.door("body", top(h), (-0.5 * w, 0.02, 0.5 * w, depth), "top", upper=1.4)


def hob(d: Drawing) -> None:
    """A slab with burners and knobs on top or in front."""
    w, depth, t = d.draw(0.4, 0.9), d.draw(0.35, 0.55), d.draw(0.03, 0.12)
    d.put("body", top(), bar((-0.5 * w, 0.5 * w), (0, depth), (0, t)))
    for spot in d.grid(top(t), (-0.5 * w, 0.25 * depth, 0.5 * w, depth), 2, d.count(1, 2)):
        d.put("body", spot, ring(0.08, 0.05, (0.0, 0.02), d.sides))
    many = d.count(1, 6)
    if d.maybe():
        spots = d.grid(top(t), (-0.45 * w, 0.02, 0.45 * w, 0.2 * depth), many, 1)
        d.knobs("body", spots, min(d.draw(0.012, 0.03), 0.4 * w / many))
    else:
        d.knobs(
            "body", d.grid(front(), (-0.45 * w, 0, 0.45 * w, t), many, 1), min(d.draw(0.25, 0.48) * t, 0.4 * w / many)
        )


def microwave(d: Drawing) -> None:
    """A door beside a strip of controls, a plate inside."""
    w, h, depth = d.draw(0.4, 0.6), d.draw(0.22, 0.38), d.draw(0.28, 0.45)
    d.board = d.draw(0.005, 0.02)
    d.case("body", front(), (-0.5 * w, 0, 0.5 * w, h), depth)
    edge = 0.5 * w - w * d.draw(0.18, 0.3)
    d.put("body", front(), bar((edge, 0.5 * w), (0, h), (-depth, 0)))
    d.door("body", front(), d.within((-0.5 * w, 0, edge, h)), d.pick("left", "left", "left", "bottom"))
    d.controls("body", front(), (edge + 0.01, 0.1 * h, 0.5 * w - 0.01, 0.75 * h), most=3)
    if d.maybe(0.5):
        plate = d.put(
            d.name("plate"),
            top(),
            rod(
                (0.5 * (edge - 0.5 * w), 0.5 * depth, d.board + 0.01),
                (0.5 * (edge - 0.5 * w), 0.5 * depth, d.board + 0.016),
                0.3 * depth,
                d.sides,
            ),
        )
        d.turns(plate, "body", top(), Z, (0.5 * (edge - 0.5 * w), 0.5 * depth, 0), upper=0.0)


def dishwasher(d: Drawing) -> None:
    """A drop-down door, racks that slide out, controls on its edge or above."""
    w, h, depth = d.draw(0.45, 0.6), d.draw(0.6, 0.9), d.draw(0.5, 0.6)
    d.case("body", front(), (-0.5 * w, 0, 0.5 * w, h), depth)
    low, strip = h * d.pick(0.0, 0.1), h * d.pick(0.0, 0.0, d.draw(0.1, 0.16))
    if strip:
        d.put("body", front(), bar((-0.5 * w, 0.5 * w), (h - strip, h), (-0.1, 0)))
        d.controls("body", front(), (-0.46 * w, h - 0.9 * strip, 0.46 * w, h - 0.1 * strip), most=4)
    door = d.door("body", front(), d.within((-0.5 * w, low, 0.5 * w, h - strip)), "bottom", upper=1.57)
    if not strip and d.maybe():
        d.controls(door, front().at(0, 0, d.level(0.02)[1]), (-0.45 * w, 0.9 * h, 0.45 * w, 0.97 * h), most=4)
    for k in range(d.count(0, 2)):
        v = low + (h - low) * (0.15 + 0.4 * k)
        a, b, u = -0.9 * depth, -0.06, 0.42 * w
        if d.maybe():
            d.put(
                rack := d.name("rack"),
                front(),
                *(bar((x, x + 0.005), (v, v + 0.1), (a, b)) for x in (-u, u)),
                *(bar((-u, u), (v, v + 0.005), (y, y + 0.005)) for y in np.linspace(a, b, 7)),
            )
        else:
            d.put(rack := d.name("rack"), front(), bar((-u, u), (v, v + 0.12), (a, b), without=(3,)))
        d.slides(rack, "body", front().n, 0.7 * depth)


def washer(d: Drawing) -> None:
    """A round door in front or a lid on top; a knob, buttons and a small drawer."""
    w, h, depth = d.draw(0.45, 0.7), d.draw(0.6, 1.0), d.draw(0.45, 0.65)
    d.put("body", front(), bar((-0.5 * w, 0.5 * w), (0, h), (-depth, 0)))
    strip = h * d.draw(0.1, 0.18)
    d.controls("body", front(), (-0.1 * w, h - 0.9 * strip, 0.46 * w, h - 0.1 * strip), most=4)
    if d.maybe(0.5):
        d.drawer("body", front(), (-0.47 * w, h - 0.9 * strip, -0.2 * w, h - 0.1 * strip), 0.4 * depth)
    if d.maybe(0.3):
        d.front = d.pick("proud", "flush")
        d.door("body", top(h), (-0.4 * w, 0.05, 0.4 * w, 0.8 * depth), "top", upper=1.6)
        return
    r, sign = 0.5 * w * d.draw(0.5, 0.85), d.pick(-1, 1)
    name, at, thick = d.name("door"), front().at(0, 0.45 * h), d.draw(0.01, 0.05)
    d.put(
        name,
        at,
        ring(r, 0.75 * r, (d.gap, thick), max(d.sides, 16)),
        rod((0, 0, -0.05 * d.draw(0, 1)), (0, 0, 0.6 * thick), 0.76 * r, max(d.sides, 16)),
    )
    if d.maybe(0.6):
        d.put(
            name,
            at,
            bar((0.8 * r, 0.95 * r) if sign > 0 else (-0.95 * r, -0.8 * r), (-0.03, 0.03), (thick, thick + 0.015)),
        )
    d.turns(name, "body", at, sign * -at.v, (-sign * r, 0, d.pick(0.0, thick)), upper=d.draw(1.5, 2.8))


def chest(d: Drawing) -> None:
    """A box with a lid, two lids or flaps in pairs, of which some have flaps of their own."""
    w, h, depth = d.draw(0.15, 0.9), d.draw(0.1, 0.6), d.draw(0.15, 0.6)
    t = 0.0 if d.thin else min(d.board, 0.01)
    rect = (-0.5 * w, 0, 0.5 * w, depth)
    d.put("body", top(h), bar((-0.5 * w, 0.5 * w), (0, depth), (-h, 0), without=(1,)))
    if t:
        d.put("body", top(h), bar((-0.5 * w + t, 0.5 * w - t), (t, depth - t), (-h + t, 0), without=(1,)))
    d.grip = d.pick("none", "none", "knob", "plate")
    d.front = d.pick("proud", "proud", "flush")
    d.board = t
    style = d.rng.random()
    if style < 0.35:
        d.door("body", top(h), rect, d.pick("top", "top", "left"), upper=d.draw(1.2, 3.0))
    elif style < 0.55:
        d.door("body", top(h), (rect[0], 0, -d.gap, depth), "left")
        d.door("body", top(h), (d.gap, 0, rect[2], depth), "right")
    elif style < 0.7:  # a deep lid
        n, high = d.name("lid"), h * d.draw(0.15, 0.6)
        d.put(n, top(h + d.gap), bar(rect[::2], rect[1::2], (0, high), without=(0,) if d.thin else ()))
        d.turns(n, "body", top(h), -X, (0, depth, d.pick(0.0, d.gap)), upper=d.draw(1.2, 2.0))
    else:  # a carton: flaps that stand up or out, in chains
        thick, angle = d.draw(0.0005, 0.004), d.draw(-1.5, 1.2)
        edges = [
            top(h).at(0, 0),
            top(h).at(0, depth, turned=np.pi),
            top(h).at(-0.5 * w, 0.5 * depth, turned=-0.5 * np.pi),
            top(h).at(0.5 * w, 0.5 * depth, turned=0.5 * np.pi),
        ]
        for k, edge in enumerate(edges[: d.pick(2, 4, 4)]):
            long, parent, plane = w if k < 2 else depth, "body", edge
            reach = d.draw(0.3, 0.55) * (depth if k < 2 else w)
            for _ in range(d.pick(1, 1, 2)):
                plane = plane.tilted(angle if parent == "body" else d.draw(-0.6, 0.6))
                name = d.put(
                    d.name("flap"), plane, bar((-0.5 * long + 0.002, 0.5 * long - 0.002), (d.gap, reach), (0, thick))
                )
                d.turns(name, parent, plane, d.pick(1, -1) * plane.u, (0, 0, 0), upper=d.draw(1.5, 3.0))
                parent, plane, reach = name, plane.at(0, reach + d.gap), reach * d.draw(0.3, 1.0)


def bin_(d: Drawing) -> None:
    """A round or square bin with a lid, a swing flap or a pedal."""
    r, h, n = d.draw(0.1, 0.25), d.draw(0.3, 0.8), d.sides if d.maybe(0.6) else 4
    turn = 0.25 * np.pi if n == 4 else 0.0
    d.put("body", top().at(0, 0, turned=turn), rod((0, 0, 0), (0, 0, h), r * d.draw(0.8, 1.0), n, narrow=1.0))
    style, side = d.rng.random(), top(h).at(0, 0, d.gap)
    half = r * (np.sqrt(0.5) if n == 4 else 1.0)
    lid = d.name("lid")
    dome = d.draw(0.01, 0.08)
    d.put(lid, side.at(0, 0, turned=turn), rod((0, 0, 0), (0, 0, dome), r, n, narrow=d.draw(0.5, 1.0)))
    if style < 0.6:
        d.turns(lid, "body", side, -side.u, (0, half, d.pick(0.0, 0.5 * dome)), upper=d.draw(1.2, 1.9))
    elif style < 0.8:
        d.slides(lid, "body", side.n, 0.5 * h)
    else:
        d.turns(lid, "body", side, side.n, (0, 0, 0), upper=0.0)
    if style < 0.6 and d.maybe(0.4):
        pedal = d.put(d.name("pedal"), front(-half), bar((-0.04, 0.04), (0.02, 0.03), (-0.05, 0.06)))
        d.turns(pedal, "body", front(-half), front().u, (0, 0.025, d.pick(-0.05, 0.0)), upper=0.3)


def window(d: Drawing) -> None:
    """A frame with sashes that slide past each other, hang, swing or tilt; some pivot in their middle."""
    w, h, t, deep = d.draw(0.6, 1.8), d.draw(0.6, 1.8), d.draw(0.03, 0.08), d.draw(0.05, 0.15)
    sticks = [
        ((-0.5 * w - t, -0.5 * w), (0, h)),
        ((0.5 * w, 0.5 * w + t), (0, h)),
        ((-0.5 * w - t, 0.5 * w + t), (-t, 0)),
        ((-0.5 * w - t, 0.5 * w + t), (h, h + t)),
    ]
    d.put("body", front(), *(bar(u, v, (-deep, 0)) for u, v in sticks))
    style, thick, g = d.rng.random(), 0.3 * deep, d.gap
    frame = d.draw(0.02, 0.07)

    def sash(side: Side, rect: Rect, n: tuple[float, float]) -> str:
        a, b, c, e = rect
        name = d.name("sash")
        pieces = [
            ((a, a + frame), (b, e)),
            ((c - frame, c), (b, e)),
            ((a, c), (b, b + frame)),
            ((a, c), (e - frame, e)),
        ]
        d.put(name, side, *(bar(u, v, n) for u, v in pieces))
        if d.maybe(0.8):
            d.put(
                name,
                side,
                bar(
                    (a, c),
                    (b, e),
                    (0.5 * (n[0] + n[1]),) * 2 if d.thin else (0.6 * n[0] + 0.4 * n[1], 0.4 * n[0] + 0.6 * n[1]),
                ),
            )
        for x in np.linspace(a, c, 4)[1:-1] if d.maybe(0.2) else []:
            d.put(name, side, bar((x - 0.01, x + 0.01), (b, e), n))
        return name

    tracks = [(-0.9 * deep, -0.9 * deep + thick), (-0.45 * deep, -0.45 * deep + thick)]
    if style < 0.4:  # sliding, side by side or up and down
        upright, many = d.maybe(0.4), d.pick(2, 2, 2, 3)
        length = h if upright else w
        lap = frame * d.draw(0.0, 1.0)
        fixed = d.count(0, many) if d.maybe(0.4) else many
        for k in range(many):
            lo, hi = k * length / many - lap * (k > 0), (k + 1) * length / many + lap * (k < many - 1)
            rect = (
                (-0.5 * w + g, lo + g, 0.5 * w - g, hi - g)
                if upright
                else (-0.5 * w + lo + g, g, -0.5 * w + hi - g, h - g)
            )
            name = sash(front(), rect, tracks[k % 2])
            if k == fixed:
                d.meshes["body"] += d.meshes.pop(name)
            else:
                d.slides(
                    name, "body", (1 if k == 0 else -1) * (front().v if upright else front().u), 0.8 * length / many
                )
    else:
        n = d.pick((-deep, -deep + 2 * thick), (-thick, 0.0), (-0.7 * deep, -0.2 * deep))
        columns, rows = d.pick((1, 1), (2, 1), (2, 1), (1, 2), (2, 2))
        for i in range(columns):
            for j in range(rows):
                a, b, c, e = (
                    -0.5 * w + i * w / columns + g,
                    j * h / rows + g,
                    -0.5 * w + (i + 1) * w / columns - g,
                    (j + 1) * h / rows - g,
                )
                edge = d.pick(
                    "top",
                    "bottom",
                    "left" if i == 0 else "right",
                    "left" if i == 0 else "right",
                    "left" if i == 0 else "right",
                    "middle",
                )
                name = sash(front(), (a, b, c, e), n)
                if d.maybe(0.3) and edge != "middle":
                    d.handle(
                        name,
                        front(),
                        (a, b, c, e),
                        {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}[edge],
                        n[1],
                    )
                axis, at = {
                    "left": (-Z, (a, 0, n[1])),
                    "right": (Z, (c, 0, n[1])),
                    "bottom": (X, (0, b, n[1])),
                    "top": (-X, (0, e, n[1])),
                    "middle": d.pick((X, (0, 0.5 * (b + e), sum(n) / 2)), (Z, (0.5 * (a + c), 0, sum(n) / 2))),
                }[edge]
                d.turns(name, "body", front(), axis, at, upper=d.draw(0.6, 1.6))
        if columns > 1 or rows > 1:
            d.put(
                "body",
                front(),
                *([bar((-0.005, 0.005), (0, h), (-deep, n[0]))] if columns > 1 else []),
                *([bar((-0.5 * w, 0.5 * w), (0.5 * h - 0.005, 0.5 * h + 0.005), (-deep, n[0]))] if rows > 1 else []),
            )


def _revolving(d: Drawing, h: float) -> None:
    """Blades about a post, between two curved walls."""
    r, blades = d.draw(0.7, 1.3), d.count(2, 4)
    for k in range(d.sides + 8):
        a = 2 * np.pi * k / (d.sides + 8)
        if abs(np.cos(a)) > 0.6:
            place = Side(
                np.array([(r + 0.02) * np.cos(a), (r + 0.02) * np.sin(a), 0]),
                np.array([-np.sin(a), np.cos(a), 0]),
                Z,
            )
            half = np.pi * r / (d.sides + 8)
            d.put("body", place, bar((-half, half), (0, h), (0, 0.02)))
    d.put("body", top(h), rod((0, 0, 0.01), (0, 0, 0.1), 1.05 * r, d.sides))
    leaf, start = d.name("leaf"), d.draw(0, 3)
    for k in range(blades):
        d.put(leaf, top().at(0, 0, turned=start + 2 * np.pi * k / blades), bar((0, r), (-0.012, 0.012), (0.01, h)))
    if d.maybe():
        d.put(leaf, top(), rod((0, 0, 0), (0, 0, h), 0.04, d.sides))
    d.turns(leaf, "body", top(), Z, (0, 0, 0), upper=0.0)


def _lever(d: Drawing, leaf: str, at: tuple[float, float], n: tuple[float, float], away: float) -> None:
    """Of a leaf, through it or on it; or a bar that is one with it."""
    u, h = at
    if d.maybe(0.6):
        r, v = d.draw(0.008, 0.03), d.draw(0.42, 0.5) * h
        name = d.name("lever")
        if d.maybe(0.75):
            d.put(name, front(), rod((u, v, n[0] - 0.05), (u, v, n[1] + 0.05), min(r, 0.012), d.sides))
            for z in (n[0] - 0.055, n[1] + 0.045):
                d.put(
                    name,
                    front(),
                    bar(
                        (u - 0.01, u + 0.12) if away > 0 else (u - 0.12, u + 0.01),
                        (v - 0.01, v + 0.01),
                        (z, z + 0.01),
                    ),
                )
        else:
            d.put(
                name,
                front(),
                rod((u, v, n[1]), (u, v, n[1] + 0.05), 0.5 * r, d.sides),
                rod((u, v, n[1] + 0.03), (u, v, n[1] + 0.07), r, d.sides),
            )
        d.turns(name, leaf, front(), np.sign(away) * front().n, (u, v, 0), upper=d.pick(0.8, 1.2))
    elif d.maybe():
        d.grip = "bar"
        d.handle(leaf, front(), (u - 0.1, 0.3 * h, u + 0.1, 0.7 * h), "left", n[1])
        d.grip = "none"


def doorway(d: Drawing) -> None:
    """Leaves in a frame, with lever or knob; in pairs, sliding, folding or revolving."""
    w, h, t, deep = d.draw(0.7, 1.2), d.draw(1.8, 2.4), d.draw(0.03, 0.1), d.draw(0.06, 0.2)
    style, n, g = d.rng.random(), d.pick((-0.05, 0.0), (-0.09, -0.04), (-0.03, 0.01)), d.gap
    many = 2 if style < 0.25 else d.count(2, 4) if 0.5 < style < 0.72 else 1
    whole = w * (many if style < 0.5 else max(1.0, 0.5 * many))
    if style > 0.85:
        _revolving(d, h)
        return
    sticks = [
        ((-0.5 * whole - t, -0.5 * whole), (0, h + t)),
        ((0.5 * whole, 0.5 * whole + t), (0, h + t)),
        ((-0.5 * whole, 0.5 * whole), (h, h + t)),
    ]
    d.put("body", front(), *(bar(u, v, (-deep, 0)) for u, v in sticks))
    d.grip = "none"

    if style < 0.5:
        for k in range(many):
            a = -0.5 * whole + k * w
            name = d.name("leaf")
            left = (k == 0) if many == 2 else d.maybe()
            d.panel(name, front(), (a + g, g, a + w - g, h - g), n)
            _lever(d, name, (a + (0.92 if left else 0.08) * w, h), n, -1.0 if left else 1.0)
            d.turns(
                name,
                "body",
                front(),
                -Z if left else Z,
                (a if left else a + w, 0, d.pick(n[1], n[1], n[0])),
                upper=d.draw(1.4, 2.8),
            )
    elif style < 0.72:  # folding: a chain of panels, a little folded or flat
        width, fold, parent = whole / many, d.pick(0.0, d.draw(0.05, 1.2)), "body"
        place = front().at(-0.5 * whole, 0, -0.03)
        for k in range(many):
            plane = Side(place.origin, np.cos(fold) * X + (-1) ** k * np.sin(fold) * Y, Z)
            name = d.name("leaf")
            d.panel(name, plane, (g, g, width - g, h - g), (-0.015, 0.015))
            d.turns(name, parent, plane, d.pick(1, -1) * Z, (0, 0, d.pick(-0.015, 0.015, 0.0)), upper=d.draw(1.2, 3.0))
            place, parent = plane.at(width, 0), name
    else:  # sliding past each other
        many = d.count(1, 3)
        for k in range(many):
            lo, hi = -0.5 * whole + k * whole / many, -0.5 * whole + (k + 1) * whole / many
            z = -0.03 - 0.035 * (k % 2)
            name = d.name("leaf")
            d.panel(name, front(), (lo + g - 0.01 * (k > 0), g, hi - g, h - g), (z, z + 0.025))
            d.grip = d.pick("none", "plate", "bar")
            d.handle(name, front(), (lo, 0.3 * h, hi, 0.7 * h), d.pick("left", "right"), z + 0.025)
            d.slides(name, "body", (1 if k < 0.5 * many else -1) * X, 0.8 * (hi - lo))


def tap(d: Drawing) -> None:
    """A spout that swivels, one or two levers or knobs."""
    r, h = d.draw(0.012, 0.03), d.draw(0.05, 0.3)
    d.put("body", top(), rod((0, 0, 0), (0, 0, 0.4 * h), r * d.draw(1.0, 1.4), d.sides))
    spread = d.pick(0.0, 0.0, d.draw(0.06, 0.12))
    if spread:
        d.put("body", top(), bar((-spread - r, spread + r), (-1.2 * r, 1.2 * r), (0, d.draw(0.01, 0.05))))
    reach, spout = d.draw(0.1, 0.25), d.name("spout") if d.maybe(0.75) else "body"
    d.put(
        spout,
        top(),
        rod((0, 0, 0.4 * h + d.gap), (0, 0, h), r * d.draw(0.7, 1.0), d.sides),
        bar((-0.6 * r, 0.6 * r), (-reach, 0), (h - r, h)),
        rod((0, -reach, h - 0.04), (0, -reach, h), 0.7 * r, d.sides),
    )
    if spout != "body":
        d.turns(spout, "body", top(), Z, (0, 0, 0), upper=0.0)
    spots = [top(d.draw(0.01, 0.04)).at(s * spread, 0) for s in (-1, 1)] if spread else [top(h).at(0, 0, d.gap)]
    on = "body" if spread else spout
    if not spread and d.maybe(0.5):  # at the side of the body
        spots, on = [Side(np.array([d.pick(-1, 1) * r, 0.0, 0.25 * h]), Y, Z)], "body"
        if spots[0].origin[0] < 0:
            spots = [Side(spots[0].origin, -Y, Z)]
    if d.maybe(0.5):
        d.knobs(on, spots, d.draw(0.8, 1.6) * r)
    else:
        long, up = d.draw(0.05, 0.12), d.draw(0.01, 0.05)
        for k, spot in enumerate(spots):
            name = d.put(
                d.name("lever"),
                spot,
                rod((0, 0, 0), (0, 0, up), 0.8 * r, d.sides),
                bar((-0.3 * r, 0.3 * r), (-long, 0.5 * r), (up - 0.006, up + 0.004)),
            )
            tips = not spread and d.maybe(0.4)
            d.turns(
                name,
                on,
                spot,
                spot.u if tips else spot.n * (-1) ** k,
                (0, 0, up if tips else 0),
                upper=d.draw(0.5, 1.6),
            )


def folding_chair(d: Drawing) -> None:
    """A seat and legs that cross, about pins that are not drawn; or a back that reclines on a swivelling seat."""
    w, h, t = d.draw(0.38, 0.5), d.draw(0.4, 0.5), d.draw(0.012, 0.03)
    if d.maybe():
        lean = d.draw(0.25, 0.5)
        one = front().at(0, 0.5 * h).tilted(lean)
        other = front().at(0, 0.5 * h).tilted(-lean)
        d.put(
            "body",
            one,
            *(bar((x, x + t), (-0.55 * h, 1.1 * h), (-0.5 * t, 0.5 * t)) for x in (-0.5 * w, 0.5 * w - t)),
            bar((-0.5 * w, 0.5 * w), (0.8 * h, 1.1 * h), (-0.4 * t, 0.4 * t)),
        )
        inner = 0.5 * w - t - d.gap
        leg = d.put(
            d.name("leg"),
            other,
            *(bar((x, x + t), (-0.55 * h, 0.6 * h), (-0.5 * t, 0.5 * t)) for x in (-inner, inner - t)),
            bar((-inner, inner), (-0.5 * h, -0.5 * h + t), (-0.4 * t, 0.4 * t)),
        )
        d.turns(leg, "body", front(), X, (0, 0.5 * h, 0), upper=0.8)
        y = np.tan(lean) * 0.5 * h
        seat = d.put(d.name("seat"), front(y), bar((-inner + t, inner - t), (h, h + t), (0, 2.2 * y)))
        d.turns(seat, d.pick("body", leg), front(y), X, (0, h, 0), upper=1.2)
        return
    for k in range(legs := d.pick(4, 5)):
        d.put("body", top().at(0, 0, turned=2 * np.pi * k / legs), bar((0, 0.5 * w), (-0.02, 0.02), (0.04, 0.07)))
    d.put("body", top(), rod((0, 0, 0.05), (0, 0, 0.8 * h), 0.025, d.sides))
    seat = d.put(
        d.name("seat"),
        top(h),
        bar((-0.5 * w, 0.5 * w), (-0.5 * w, 0.5 * w), (0, 0.06)),
        rod((0, 0, -0.2 * h + d.gap), (0, 0, 0), 0.03, d.sides),
    )
    if d.maybe(0.75):
        d.turns(seat, "body", top(), Z, (0, 0, 0), upper=0.0)
    else:
        d.slides(seat, "body", Z, 0.1)
    back = d.put(
        d.name("back"),
        front(0.5 * w).tilted(-d.draw(0, 0.3)),
        bar((-0.45 * w, 0.45 * w), (h + 0.06 + d.gap, 2 * h), (-0.03, 0.0)),
    )
    if d.maybe(0.6):
        d.turns(back, seat, front(0.5 * w), X, (0, h + 0.05, 0), upper=0.5)
    else:
        d.meshes[seat] += d.meshes.pop(back)


def keys(d: Drawing) -> None:
    """A slab with rows of buttons, some with a dial, a switch or a cover that folds or slides."""
    w, h, t = d.draw(0.04, 0.45), d.draw(0.08, 0.3), d.draw(0.008, 0.05)
    stands = d.maybe(0.3)
    side = front().tilted(0.0) if stands else top(t)
    d.put("body", side, bar((-0.5 * w, 0.5 * w), (0, h), (-t, 0)))
    columns, rows = d.pick((3, 4), (2, 4), (4, 3), (3, 3), (5, 2), (2, 2), (1, 3), (3, 2))
    high = h * d.draw(0.4, 0.75)
    share = d.draw(0.45, 0.92)
    d.buttons(
        "body",
        d.grid(side, (-0.46 * w, 0.04 * h, 0.46 * w, high), columns, rows),
        share * 0.92 * w / columns,
        share * 0.9 * (high - 0.04 * h) / rows,
    )
    if d.maybe(0.35):
        d.knobs(
            "body",
            d.grid(side, (-0.45 * w, high, 0.45 * w, 0.97 * h), d.count(1, 2), 1),
            d.draw(0.2, 0.42) * min(0.45 * w, 0.97 * h - high),
        )
    elif d.maybe(0.35):
        name = d.put(
            d.name("slider"),
            side.at(d.draw(-0.3, 0.3) * w, 0.5 * (high + h)),
            bar((-0.01, 0.01), (-0.004, 0.004), (0, 0.004)),
        )
        d.slides(name, "body", side.u, 0.15 * w)
    if d.maybe(0.2):
        name = d.put(d.name("cover"), side.at(0, h), bar((-0.5 * w, 0.5 * w), (d.gap, 0.9 * h), (-t, 0)))
        d.turns(name, "body", side, -side.u, (0, h, d.pick(0.0, -t, -0.5 * t)), upper=2.8)


def clamshell(d: Drawing) -> None:
    """Laptops, cases and the like: a half that folds up, closed or open, about an edge both share; keys in some."""
    w, h, t = d.draw(0.08, 0.7), d.draw(0.06, 0.5), d.draw(0.006, 0.12)
    d.put("body", top(), bar((-0.5 * w, 0.5 * w), (0, h), (0, t), without=(1,) if d.maybe(0.3) else ()))
    lid, open_ = d.name("lid"), d.pick(0.0, 0.0, d.draw(0.5, 2.2))
    z = t + d.gap
    plane = Side(np.array([0.0, h, z]), -X, -np.cos(open_) * Y + np.sin(open_) * Z)
    thick = t * d.draw(0.3, 1.1)
    d.put(lid, plane, bar((-0.5 * w, 0.5 * w), (d.pick(0.0, d.gap), h), (0, thick)))
    if d.maybe(0.3):
        d.put(lid, plane, bar((-0.15 * w, 0.15 * w), (h, h + 0.03), (0.2 * thick, 0.8 * thick)))
    d.turns(lid, "body", plane, plane.u, (0, 0, d.pick(0.0, 0.0, -d.gap)), upper=2.4)
    if open_ > 1.0 and d.maybe(0.5):
        d.buttons("body", d.grid(top(t), (-0.45 * w, 0.1 * h, 0.45 * w, 0.8 * h), d.count(2, 4), 2), 0.08 * w, 0.1 * h)
    if d.maybe(0.2):
        handle = d.put(
            d.name("handle"),
            front(),
            *(bar((x, x + 0.01), (0.4 * t, 0.4 * t + 0.01), (0, 0.05)) for x in (-0.1 * w, 0.1 * w)),
            bar((-0.1 * w, 0.1 * w + 0.01), (0.4 * t, 0.4 * t + 0.01), (0.045, 0.055)),
        )
        d.turns(handle, "body", front(), d.pick(1, -1) * X, (0, 0.4 * t + 0.005, 0), upper=1.57)


def bottle(d: Drawing) -> None:
    """What is round about one line, and a cap, pump, lid or plunger on it."""
    r, h, neck = d.draw(0.03, 0.12), d.draw(0.06, 0.3), d.draw(0.3, 1.0)
    d.put(
        "body",
        top(),
        rod((0, 0, 0), (0, 0, 0.8 * h), r, d.sides),
        rod((0, 0, 0.8 * h), (0, 0, h), r, d.sides, narrow=neck),
    )
    cap, c, high = d.name("cap"), r * neck * d.draw(0.8, 1.1), d.draw(0.01, 0.05)
    side = top(h).at(0, 0, d.gap - d.pick(0.0, 0.6 * high))
    style = d.rng.random()
    d.put(cap, side, rod((0, 0, 0), (0, 0, high), c, d.sides))
    if style < 0.45:
        d.turns(cap, "body", side, Z, (0, 0, 0), upper=0.0)
    elif style < 0.7:
        d.put(
            cap,
            side,
            rod((0, 0, high), (0, 0, high + 0.04), 0.25 * c, 8),
            bar((-0.3 * c, 0.3 * c), (-1.5 * r, 0.3 * c), (high + 0.035, high + 0.05)),
        )
        d.slides(cap, "body", -Z, 0.03)
    elif style < 0.85:
        d.put(
            cap,
            side,
            rod((0, 0, high), (0, 0, high + 0.02), 0.2 * c, 8),
            rod((0, 0, high + 0.02), (0, 0, high + 0.03), 0.35 * c, d.sides),
        )
        d.slides(cap, "body", Z, 0.5 * h)
    else:
        d.turns(cap, "body", side, -X, (0, c, 0), upper=2.0)
    if d.maybe(0.3):
        bail = 1.05 * r
        name = d.put(
            d.name("handle"),
            front(),
            *(bar((s * bail, s * bail + 0.005), (0.7 * h, 0.7 * h + bail), (-0.004, 0.004)) for s in (-1, 1)),
            bar((-bail, bail + 0.005), (0.7 * h + bail, 0.7 * h + bail + 0.006), (-0.004, 0.004)),
        )
        d.turns(name, "body", front(), X, (0, 0.7 * h, 0), upper=1.5)


def safe(d: Drawing) -> None:
    """A door with a dial, a wheel or a lever, or keys."""
    w, h, depth = d.draw(0.25, 0.7), d.draw(0.25, 0.9), d.draw(0.25, 0.6)
    d.board = d.draw(0.015, 0.05)
    d.grip = "none"
    d.case("body", front(), (-0.5 * w, 0, 0.5 * w, h), depth)
    left = d.maybe()
    door = d.door("body", front(), d.within((-0.5 * w, 0, 0.5 * w, h)), "left" if left else "right")
    face = max(v[:, 1].min() for v, _ in d.meshes[door][:1])
    side, u = front(face), (0.2 if left else -0.2) * w
    d.knobs(door, [side.at(u, 0.6 * h)], d.draw(0.02, 0.05))
    if d.maybe():
        spot = side.at(u, 0.4 * h, d.draw(0.01, 0.03), turned=d.draw(0, 1))
        r, many = d.draw(0.04, 0.09), d.count(1, 4)
        spokes = [
            rod((0, 0, 0), (r * np.cos(a), r * np.sin(a), 0), 0.006, 8) for a in 2 * np.pi * np.arange(many) / many
        ]
        name = d.put(d.name("wheel"), spot, rod((0, 0, -0.03), (0, 0, 0.01), 0.012, d.sides), *spokes)
        d.turns(name, door, spot, spot.n, (0, 0, 0), upper=0.0)
    elif d.maybe():
        d.buttons(door, d.grid(side, (u - 0.04, 0.3 * h, u + 0.04, 0.45 * h), 3, 2), 0.015, 0.012)


def cart(d: Drawing) -> None:
    """A body on wheels, some of which swivel, with a handle that folds or a lid."""
    w, depth, h, r = d.draw(0.3, 0.6), d.draw(0.3, 1.0), d.draw(0.2, 0.7), d.draw(0.03, 0.1)
    lift = 2.4 * r
    d.put("body", top(lift), bar((-0.5 * w, 0.5 * w), (0, depth), (0, h), without=(1,) if d.thin else ()))
    swivel = d.maybe(0.4)
    for x in (-0.42 * w, 0.42 * w):
        for k, y in enumerate((0.12 * depth, 0.88 * depth)):
            parent, drop = "body", 0.0
            if swivel and k == 0:
                parent = d.put(
                    d.name("fork"),
                    top().at(x, y),
                    *(bar((s - 0.003, s + 0.003), (-0.01, 0.02), (0.8 * r, lift - d.gap)) for s in (-0.02, 0.02)),
                    bar((-0.022, 0.022), (-0.02, 0.02), (lift - 0.008, lift - d.gap)),
                )
                d.turns(parent, "body", top().at(x, y), Z, (0, 0, 0), upper=0.0)
                drop = 0.01
            elif d.maybe():
                d.put(
                    "body",
                    top().at(x, y),
                    *(bar((s - 0.003, s + 0.003), (-0.01, 0.01), (r, lift)) for s in (-0.018, 0.018)),
                )
            name = d.put(
                d.name("wheel"), top().at(x, y + drop), rod((-0.012, 0, r), (0.012, 0, r), r, max(d.sides, 12))
            )
            d.turns(name, parent, top().at(x, y + drop), X, (0, 0, r), upper=0.0)
    if d.maybe(0.4):
        z = lift + h * 0.8
        name = d.put(
            d.name("handle"),
            top(z).at(0, depth),
            *(bar((x, x + 0.015), (0, 0.015), (0, d.draw(0.3, 0.4))) for x in (-0.45 * w, 0.45 * w - 0.015)),
            bar((-0.45 * w, 0.45 * w), (0, 0.015), (0.3, 0.32)),
        )
        if d.maybe():
            d.slides(name, "body", Z, 0.3)
        else:
            d.turns(name, "body", top(z).at(0, depth), X, (0, 0.007, 0), upper=1.5)


def lamp(d: Drawing) -> None:
    """A chain of arms and a head on a foot; every joint of it turns."""
    r, long = d.draw(0.006, 0.02), d.draw(0.15, 0.4)
    d.put(
        "body",
        top(),
        rod((0, 0, 0), (0, 0, d.draw(0.015, 0.04)), d.draw(0.07, 0.14), d.sides),
        rod((0, 0, 0.02), (0, 0, 0.08), 1.5 * r, d.sides),
    )
    place, parent = Side(np.array([0.0, 0.0, 0.08]), -Y, Z), "body"
    for k in range(d.count(1, 3)):
        name = d.name("arm")
        if k == 0 and d.maybe(0.4):
            d.put(name, top(0.08), rod((0, 0, 0), (0, 0, 0.04), 1.6 * r, d.sides))
            d.turns(name, parent, top(), Z, (0, 0, 0), upper=0.0)
            place, parent = Side(np.array([0.0, 0.0, 0.11]), -Y, Z), name
            continue
        tilt = d.draw(-0.9, 0.9)
        plane = place.at(0, 0, turned=tilt)
        d.put(name, plane, bar((-r, r), (-r, long + r), (-0.6 * r, 0.6 * r)))
        d.turns(name, parent, plane, plane.n, (0, 0, 0), upper=0.0 if d.maybe(0.2) else 1.5)
        place, parent = plane.at(0, long, d.pick(0.0, 1.3 * r)), name
        long *= d.draw(0.6, 1.0)
    head, plane = d.name("head"), place.at(0, 0, turned=d.draw(-1, 1))
    d.put(
        head,
        plane,
        rod((0, 0, 0), (0, 0.12, 0), 0.07, d.sides, narrow=d.draw(0.3, 1.0)),
        rod((0, -0.03, 0), (0, 0.01, 0), 1.2 * r, 8),
    )
    d.turns(head, parent, plane, plane.n, (0, 0, 0), upper=1.2)


def seat(d: Drawing) -> None:
    """A toilet or piano bench: a lid and a ring that fold up about the same line; a button or lever on a tank."""
    w, depth, h = d.draw(0.35, 0.45), d.draw(0.4, 0.55), d.draw(0.35, 0.45)
    d.put("body", top(), rod((0, 0.4 * depth, 0), (0, 0.4 * depth, h), 0.4 * w, max(d.sides, 12)))
    d.put(
        "body",
        front(),
        bar((-0.5 * w, 0.5 * w), (0.5 * h, 1.9 * h), (-depth - 0.18, -depth)),
        bar((-0.3 * w, 0.3 * w), (0, h), (-depth, -0.5 * depth)),
    )
    z = h + d.gap
    for k in range(d.count(1, 2)):
        thick = d.draw(0.01, 0.025)
        name = d.name("lid")
        at = top(z).at(0, 0.45 * depth)
        d.put(
            name,
            at,
            ring(0.48 * w, 0.3 * w, (0, thick), max(d.sides, 12))
            if k == 0 and d.maybe(0.7)
            else rod((0, 0, 0), (0, 0, thick), 0.48 * w, max(d.sides, 12)),
            bar((-0.2 * w, 0.2 * w), (0.35 * w, 0.52 * depth), (0, thick)),
        )
        d.turns(name, "body", top(z), -X, (0, 0.96 * depth, 0.5 * thick), upper=1.7)
        z += thick + d.gap
    tank = top(1.9 * h).at(0, depth + 0.09)
    style = d.rng.random()
    if style < 0.5:
        d.buttons("body", [tank.at(0, 0)] if d.maybe() else [tank.at(-0.02, 0), tank.at(0.02, 0)], 0.034, 0.05)
    elif style < 0.8:
        spot = front(depth).at(-0.35 * w, 1.75 * h)
        name = d.put(
            d.name("lever"),
            spot,
            rod((0, 0, 0), (0, 0, 0.02), 0.01, d.sides),
            bar((-0.01, 0.08), (-0.006, 0.006), (0.015, 0.023)),
        )
        d.turns(name, "body", spot, spot.n, (0, 0, 0), upper=0.6)


def machine(d: Drawing) -> None:
    """A coffee machine, printer or dispenser: a block with knobs, buttons, a tray, a flap, a lever."""
    w, h, depth = d.draw(0.15, 0.5), d.draw(0.2, 0.5), d.draw(0.2, 0.45)
    d.put("body", front(), bar((-0.5 * w, 0.5 * w), (0, h), (-depth, 0)))
    d.controls("body", front(), (-0.45 * w, 0.7 * h, 0.45 * w, 0.92 * h), most=4)
    d.front, d.board = d.pick("flush", "proud"), 0.0
    if d.maybe(0.4):
        d.drawer("body", front(), (-0.4 * w, 0.05 * h, 0.4 * w, 0.2 * h), 0.7 * depth)
    if d.maybe(0.4):
        d.door(
            "body", front(), (-0.4 * w, 0.3 * h, 0.4 * w, 0.6 * h), d.pick("bottom", "bottom", "top", "left"), upper=1.4
        )
    if d.maybe(0.4):
        d.front = "proud"
        d.door("body", top(h), (-0.48 * w, 0.02, 0.48 * w, 0.95 * depth), "top", upper=1.3)
    if d.maybe(0.3):
        s, long = d.pick(-1, 1), d.draw(0.05, 0.15)
        spot = Side(np.array([s * 0.5 * w, 0.4 * depth, 0.6 * h]), s * Y, Z)
        name = d.put(
            d.name("lever"),
            spot,
            rod((0, 0, 0), (0, 0, 0.02), 0.012, d.sides),
            bar((-0.008, 0.008), (-0.01, long), (0.01, 0.02)),
        )
        d.turns(name, "body", spot, spot.n, (0, 0, 0), upper=1.2)


def switches(d: Drawing) -> None:
    """A plate with rockers, toggles or buttons."""
    many, w, h, t = d.count(1, 3), d.draw(0.05, 0.09), d.draw(0.08, 0.14), d.draw(0.005, 0.02)
    d.put("body", front(), bar((-0.5 * w * many, 0.5 * w * many), (0, h), (-t, 0)))
    style = d.pick("rocker", "rocker", "toggle", "knob", "button")
    spots = d.grid(front(), (-0.5 * w * many, 0, 0.5 * w * many, h), many, 1)
    if style == "knob":
        d.knobs("body", spots, 0.3 * w)
    elif style == "button":
        d.buttons("body", spots, 0.5 * w, 0.4 * h)
    for spot in spots if style in ("rocker", "toggle") else []:
        a, b = (0.35 * w, 0.3 * h) if style == "rocker" else (0.06 * w, 0.05 * h)
        up = 0.006 if style == "rocker" else 0.02
        name = d.put(
            d.name(style), spot.tilted(d.pick(-1, 1) * d.draw(0.0, 0.2)), bar((-a, a), (-b, b), (-0.5 * t, up))
        )
        d.turns(name, "body", spot, d.pick(1, -1) * spot.u, (0, 0, d.pick(0.0, -0.3 * t)), upper=0.4)


KINDS: dict[str, tuple[Callable[[Drawing], None], int]] = {
    "cabinet": (cabinet, 4), "desk": (desk, 2), "fridge": (fridge, 2), "oven": (oven, 4), "hob": (hob, 2),
    "microwave": (microwave, 2), "dishwasher": (dishwasher, 2), "washer": (washer, 2), "chest": (chest, 3),
    "bin": (bin_, 1), "window": (window, 3), "doorway": (doorway, 3), "tap": (tap, 2),
    "folding_chair": (folding_chair, 1), "keys": (keys, 2), "clamshell": (clamshell, 2), "bottle": (bottle, 2),
    "safe": (safe, 1), "cart": (cart, 1), "lamp": (lamp, 1), "seat": (seat, 1), "machine": (machine, 2),
    "switches": (switches, 1),
}  # fmt: skip
"""How a kind is drawn, and how often it is among others."""
ORDER = [name for name, (_, often) in KINDS.items() for _ in range(often)]


def furniture(number: int) -> Blueprint:
    """Return a piece of furniture with exact joints; quarter turns, mirror and triangles are drawn."""
    name = ORDER[number % len(ORDER)]
    rng = np.random.default_rng([number, zlib.crc32(b"furniture 1")])
    drawing = Drawing(rng)
    KINDS[name][0](drawing)
    parts = []
    divided = drawing.pick(0, 0, 1, 2)
    for part, meshes in drawing.meshes.items():
        starts = np.cumsum([0, *(len(v) for v, _ in meshes)])
        vertices, faces = (
            np.concatenate([v for v, _ in meshes]),
            np.concatenate([f + s for (_, f), s in zip(meshes, starts, strict=False)]),
        )
        for _ in range(divided if len(faces) < 400 else 0):
            vertices, faces = _divided(vertices, faces)
        parts.append(Part(name=part, vertices=vertices, faces=faces))
    joints = sorted(drawing.joints, key=lambda joint: list(drawing.meshes).index(joint.child))
    drawn = Blueprint(
        name=f"{name}_{number}", family=name, parts=tuple(parts), joints=tuple(joints), parameters={"seed": number}
    )
    opened = {}
    if drawing.maybe(0.15):
        opened = {
            j.child: drawing.draw(0.05, 0.6) * (j.upper if np.isfinite(j.upper) else 1.0)
            for j in joints
            if drawing.maybe()
        }
    drawn = drawn.moved(opened).scaled(1.0, mirrored=drawing.maybe())
    turn = np.linalg.matrix_power(np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), drawing.count(0, 3))
    placed = [replace(part, vertices=part.vertices @ turn.T) for part in drawn.parts]
    moved = [replace(joint, axis=turn @ joint.axis, pivot=turn @ joint.pivot) for joint in drawn.joints]
    return replace(drawn, parts=tuple(placed), joints=tuple(moved))


def _divided(vertices: FloatArray, faces: IntArray) -> Mesh:
    """Every triangle as four."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    corners = np.concatenate([a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)])
    n = len(faces)
    k = [np.arange(n) + i * n for i in range(6)]
    four = [(k[0], k[3], k[5]), (k[3], k[1], k[4]), (k[5], k[4], k[2]), (k[3], k[4], k[5])]
    return corners, np.concatenate([np.column_stack(item) for item in four])
