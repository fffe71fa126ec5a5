"""Undercarriages on two tracks, and the turntable on top of one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.solids import box, cylinder, hull, off, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.workshop import Workshop


@dataclass(frozen=True, kw_only=True)
class Tracks:
    """Sizes of an undercarriage on two tracks [m]."""

    length: float
    width: float
    """Over both tracks."""
    clearance: float
    """Between parts that turn on each other."""

    @property
    def belt(self) -> float:
        """Width of a track."""
        return 0.24 * self.width

    @property
    def high(self) -> float:
        """Of a track."""
        return 0.22 * self.length

    @property
    def ring(self) -> float:
        """Radius of the turntable."""
        return 0.2 * min(self.width, self.length)

    @property
    def level(self) -> float:
        """Of the turntable's plane."""
        return 1.3 * self.high

    @property
    def top(self) -> float:
        """Where a body may begin that stands on the turntable."""
        return self.level + self.clearance + 0.5 * self.ring


def add_tracks(workshop: Workshop, name: str, sizes: Tracks, *, wheels: int) -> None:
    """Add the undercarriage as the base, with `wheels` that turn on the outside of each track."""
    half = 0.5 * sizes.width
    cross = box(
        (-half + 0.5 * sizes.belt, -0.3 * sizes.length, 0.35 * sizes.high),
        (half - 0.5 * sizes.belt, 0.3 * sizes.length, 0.9 * sizes.high),
    )
    workshop.body(name, cross, *(_belt(sizes, s * (half - 0.5 * sizes.belt)) for s in (-1, 1)))
    radius = min(0.36 * sizes.high, 0.32 * sizes.length / max(wheels, 1))
    places = np.linspace(-0.5, 0.5, wheels) * (sizes.length - sizes.high) if wheels > 1 else np.zeros(wheels)
    for side, s in (("left", -1), ("right", 1)):
        for k, y in enumerate(places):
            pivot = np.array([s * half, y, 0.5 * sizes.high])
            _, hole, rotor = stub(pivot, (s, 0, 0), radius, min(sizes.clearance, 0.1 * radius), length=0.5 * radius)
            workshop.cut(name, hole)
            wheel = f"{side}_wheel_{k + 1}"
            nuts = [_nut(pivot, s, radius, angle) for angle in np.arange(5) * 0.4 * np.pi]
            workshop.body(wheel, rotor, *nuts, material="steel")
            workshop.turns(wheel, name, (s, 0, 0), pivot)


def _belt(tracks: Tracks, x: float) -> Manifold:
    """A closed track with cleats."""
    radius, half = 0.46 * tracks.high, 0.5 * tracks.belt
    run = 0.5 * tracks.length - 0.5 * tracks.high
    ends = [cylinder(radius, (x - half, y, 0.5 * tracks.high), (x + half, y, 0.5 * tracks.high)) for y in (-run, run)]
    cleat = 0.04 * tracks.high
    cleats = [
        box((x - half, y - cleat, z0), (x + half, y + cleat, z1))
        for y in np.linspace(-run, run, 9)
        for z0, z1 in ((0.0, 0.1 * tracks.high), (0.9 * tracks.high, tracks.high))
    ]
    return union(hull(*ends), *cleats)


def _nut(pivot: np.ndarray, s: int, radius: float, angle: float) -> Manifold:
    centre = off(pivot, s * 0.4 * radius, 0.65 * radius * np.cos(angle), 0.65 * radius * np.sin(angle))
    return cylinder(0.12 * radius, centre, off(centre, s * 0.3 * radius, 0, 0), segments=6)


def add_turntable(workshop: Workshop, name: str, parent: str, sizes: Tracks) -> None:
    """Add what turns on the undercarriage without end: the ring alone, its body follows above `top` of the tracks."""
    pivot = (0.0, 0.0, sizes.level)
    boss, hole, rotor = stub(pivot, (0, 0, 1), sizes.ring, sizes.clearance, length=0.5 * sizes.ring)
    below = cylinder(sizes.ring, (0, 0, 0.6 * sizes.high), pivot)
    workshop.add(parent, boss, below)
    workshop.cut(parent, hole)
    workshop.body(name, rotor)
    workshop.turns(name, parent, (0, 0, 1), pivot)
