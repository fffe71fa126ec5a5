"""Chains of panels and bars, for the fit of the edges of the tree: what hangs on what where alike parts touch.

Flaps on the rim of a box that carry further flaps, leaves that fold in an opening, boards hinged to boards, and bars
end to end or side by side. Some chains are of one link, so that a neighbour is not always what carries a part.
"""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.robot.transforms import pose_at, rotation_about

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.robot.arrays import FloatArray


class _Chains:
    """A builder with the clearance and the panels of one object."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng, self.links = rng, 0
        self.builder = ObjectBuilder("chain", carves=True, look=("wood", None))
        self.gap = float(rng.choice([0.0, 0.0005, 0.001, 0.002, 0.004]))
        self.thick = float(np.exp(rng.uniform(np.log(0.001), np.log(0.03))))
        self.barrels = bool(rng.random() < 0.25)

    def link(self, parent: str, frame: FloatArray, width: float, reach: float, *, pin: bool = False) -> str:
        """A panel from the origin of `frame` along v, hinged about u; a bar about n where a pin holds it."""
        seen = self.builder.from_frame(frame[:3])
        t, half = 0.5 * self.thick, 0.5 * width
        start = -half if pin else self.gap
        name = seen.part(f"link_{self.links}", box((-half, start, -t), (half, reach + (half if pin else 0.0), t)))
        if pin or self.barrels:
            end = (0.0, 0.0, t + self.thick) if pin else (half, 0.0, 0.0)
            seen.part(name, cylinder(0.3 * half if pin else t, (0, 0, -t) if pin else (-half, 0, 0), end, segments=16))
        axis, level = ((0, 0, 1), 0.0) if pin else ((1, 0, 0), float(self.rng.choice([-t, 0.0, t])))
        seen.hinge(name, parent, axis, (0.0, 0.0, level), 3.0, -3.0)
        self.links += 1
        return name

    def panels(self, frame: FloatArray, width: float, reaches: Sequence[float], angles: Sequence[float]) -> None:
        """A chain from the edge of the body that is the u axis of a frame, each link turned against the last one."""
        parent, growth = "body", self.rng.uniform(0.8, 1.0)
        for reach, angle in zip(reaches, angles, strict=True):
            frame = frame @ pose_at((0, 0, 0), rotation_about(np.array([1.0, 0, 0]), angle))
            parent = self.link(parent, frame, width - 2 * self.gap, reach)
            if self.rng.random() < 0.1:
                self._knob(parent, frame, width, reach)
            frame, width = frame @ pose_at((0, reach + self.gap, 0)), width * growth

    def _knob(self, parent: str, frame: FloatArray, width: float, reach: float) -> None:
        seen, r = self.builder.from_frame(frame[:3]), 0.1 * min(width, reach)
        place = np.array([0.3 * width, 0.7 * reach, 0.5 * self.thick + self.gap])
        seen.part(f"knob_{self.links}", cylinder(r, place, (*place[:2], place[2] + 2 * r), segments=16))
        seen.spin(f"knob_{self.links}", parent, (0, 0, 1), place)
        self.links += 1


def chain(number: int) -> Blueprint:
    """Return one object with exact joints; most of its parts are links of chains."""
    rng = np.random.default_rng([number, zlib.crc32(b"chains 1")])
    name, draw = _KINDS[number % len(_KINDS)]
    drawn = _Chains(rng)
    draw(drawn)
    drawn.builder.settle()
    return drawn.builder.finish(f"{name}_{number}", {"seed": number})


def _carton(d: _Chains) -> None:
    """A box or tray with flaps around its rim, shut, standing or hanging out."""
    rng = d.rng
    *size, h = rng.uniform(0.1, 0.8, 3)
    half, wall = 0.5 * np.array(size), min(d.thick, 0.01)
    solid = box((*-half, 0), (*half, h))
    d.builder.part("body", solid - box((*(wall - half), wall), (*(half - wall), 2 * h)))
    shut = rng.random() < 0.25
    for k in range(int(rng.choice([1, 2, 4, 4]))):
        # Flaps that are shut lie on each other, one pair above the other one.
        level = h + d.gap + d.thick * (0.5 + (k >= 2 and shut) * 1.2)
        links = 1 if shut else int(rng.choice([1, 1, 2, 3]))
        reach = 2.0 * half[1 - k // 2] * rng.uniform(0.25, 0.49)
        reaches = [reach * rng.uniform(0.4, 1.0) ** i for i in range(links)]
        first = 0.0 if shut else rng.uniform(0.3, 3.3)
        frame, width = _side(k, half, level, inwards=True)
        d.panels(frame, width, reaches, [first, *rng.uniform(-0.9, 0.9, links - 1)])


def _leaves(d: _Chains) -> None:
    """Leaves in an opening or at a post, in chains from one side or from both, in one row or several."""
    rng = d.rng
    h, leaf, deep, t = rng.uniform(0.3, 2.2), rng.uniform(0.2, 0.9), rng.uniform(0.03, 0.2), rng.uniform(0.02, 0.1)
    d.thick = min(rng.uniform(0.01, 0.05), deep)
    left, right = int(rng.integers(1, 5)), int(rng.choice([0, 0, 1, 1, 2, 3]))
    wide = (left + right) * (leaf + d.gap)
    solids = [box((-t, -deep / 2, 0), (-d.gap, deep / 2, h))]
    if right or rng.random() < 0.7:
        solids.append(box((wide, -deep / 2, 0), (wide + t, deep / 2, h)))
        solids += [box((-t, -deep / 2, z), (wide + t, deep / 2, z + t)) for z in (h, -t)[: int(rng.integers(1, 3))]]
    d.builder.part("body", *solids)
    rows = int(rng.choice([1, 1, 1, 2, 3]))
    fold = float(rng.choice([0.0, 0.0, rng.uniform(0.05, 1.3)]))
    for row in range(rows):
        for x, along, many in ((0.0, 1.0, left), (wide, -1.0, right)):
            upright = np.column_stack([(0, 0, 1), (along, 0, 0), (0, along, 0)])
            folds = [fold * (-1) ** k * (1 + (k > 0)) for k in range(many)]
            d.panels(pose_at((x, 0, (row + 0.5) * h / rows), upright), h / rows, [leaf - d.gap] * many, folds)


def _boards(d: _Chains) -> None:
    """A board, thin box or table top with leaves at its sides and leaves on these, or plates upon each other."""
    rng = d.rng
    half = 0.5 * rng.uniform(0.15, 1.5, 2)
    high = d.thick * float(rng.choice([1.0, 1.0, 3.0, rng.uniform(1, 20)]))
    d.builder.part("body", box((*-half, -high), (*half, 0)))
    if rng.random() < 0.2:
        for k in range(int(rng.integers(1, 4))):
            frame, width = _side(0, half, d.gap + (k + 0.5) * (d.thick + d.gap), inwards=True)
            d.panels(frame, width, [2 * half[1] * rng.uniform(0.5, 1.0)], [0.0])
        return
    alike = rng.random() < 0.4
    for k in range(int(rng.integers(1, 5))):
        links = int(rng.choice([1, 1, 2, 3, 4]))
        reaches = 2 * half[1 - k // 2] * (np.ones(links) if alike else rng.uniform(0.2, 1.0, links))
        frame, width = _side(k, half, -0.5 * d.thick)
        width *= rng.uniform(0.6, 1.0)
        turns = rng.uniform(-1.2, 1.2, links) * (rng.random() < 0.7)
        d.panels(frame, width, reaches.tolist(), turns.tolist())


def _bars(d: _Chains) -> None:
    """Bars that turn about pins in their ends, each beside the last one; a block carries the first."""
    rng = d.rng
    d.thick = rng.uniform(0.002, 0.03)
    width, size = d.thick * rng.uniform(1.0, 5.0), rng.uniform(0.03, 0.4, 3)
    d.builder.part("body", box(-size / 2, size / 2))
    for side in (1.0, -1.0)[: int(rng.choice([1, 1, 2]))]:
        frame = pose_at((0, 0, side * (0.5 * size[2] + d.gap + 0.5 * d.thick)), np.diag([1.0, side, side]))
        parent = "body"
        for _ in range(int(rng.integers(1, 5))):
            yaw = rng.uniform(-np.pi, np.pi) if rng.random() < 0.7 else float(rng.choice([0.0, np.pi]))
            frame = frame @ pose_at((0, 0, 0), rotation_about(np.array([0.0, 0, 1]), yaw))
            reach = rng.uniform(2.0, 15.0) * width
            parent = d.link(parent, frame, width, reach, pin=True)
            frame = frame @ pose_at((0, reach, d.thick + d.gap))


def _side(k: int, half: FloatArray, level: float, *, inwards: bool = False) -> tuple[FloatArray, float]:
    """Frame in the middle of a side of a rectangle whose panels lead along v, and the length of the side."""
    yaw = (0.0, np.pi, 0.5 * np.pi, -0.5 * np.pi)[k]
    turn = rotation_about(np.array([0.0, 0.0, 1.0]), yaw)
    place = turn[:2, 1] * half * (-1.0 if inwards else 1.0)
    return pose_at((*place, level), turn), float(2 * half[k // 2])


_KINDS = (("carton", _carton), ("leaves", _leaves), ("boards", _boards), ("bars", _bars))
