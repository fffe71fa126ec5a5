"""What fingers turn and press: knobs and buttons, each in its own hole of the part that carries it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import at
from kinematify.generate.procedural.solids import bore, box, cylinder, rod

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.solids import Point
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

FRONT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns what is built to look along z so that it looks along -y, with its y up."""
TOP = np.eye(3)
"""Leaves what is built to look along z as it is."""
_SPAN = 4.7  # a knob with stops turns so far [rad], about 270 degrees


@dataclass(frozen=True, kw_only=True)
class Mount:
    """Where a control sits on a surface."""

    parent: str
    """Body that carries it; it gets the hole."""
    place: Point
    """Where its middle meets the surface [m]."""
    face: FloatArray
    """`FRONT`, `TOP` or another rotation, shape (3, 3), that takes z to the outer normal."""
    clearance: float
    """[m]."""
    depth: float
    """Of solid material behind the surface that the hole may use [m]."""

    def placed(self, solid: Manifold) -> Manifold:
        """Bring a solid from the origin, where the surface is z = 0, to the surface."""
        return solid.transform(at(self.place, self.face))

    @property
    def outward(self) -> FloatArray:
        """Unit normal of the surface, shape (3,)."""
        return self.face[:, 2]


def add_knob(
    workshop: Workshop, name: str, mount: Mount, radius: float, *, endless: bool = False, rest: float = 0.0
) -> None:
    """Add a knob with a pointer, turned clockwise by its shaft in a bore; without stops if it is endless."""
    shaft, height, clearance = 0.3 * radius, 0.7 * radius, mount.clearance
    bottom = -mount.depth + clearance
    workshop.cut(mount.parent, mount.placed(bore(shaft, clearance, (0, 0, -mount.depth), (0, 0, radius))))
    solids = (
        cylinder(radius, (0, 0, clearance), (0, 0, clearance + height)),
        box((-0.12 * radius, 0.0, 0.5 * height), (0.12 * radius, 0.95 * radius, clearance + 1.3 * height)),
        cylinder(shaft, (0, 0, bottom), (0, 0, clearance + 0.5 * height)),
    )
    workshop.body(name, *(mount.placed(solid) for solid in solids))
    limits = None if endless else (0.0, _SPAN)
    workshop.turns(name, mount.parent, -mount.outward, mount.place, limits, rest=rest)


def add_lever(
    workshop: Workshop,
    name: str,
    mount: Mount,
    length: float,
    *,
    arm: float,
    swing: float,
    through: bool,
    rest: float = 0.0,
) -> None:
    """Add a lever handle: an arm on a spindle in the leaf that carries it.

    Args:
        workshop: Where it is added.
        name: Of the lever.
        mount: Its depth is the thickness of the leaf.
        length: Of an arm [m].
        arm: Direction of the arms at zero, from the right, anticlockwise seen from outside [rad].
        swing: How far it turns, anticlockwise seen from outside if positive [rad].
        through: True if the spindle goes through the leaf and has another arm behind it.
        rest: Share of the way that it stands turned.
    """
    radius, clearance, depth = 0.07 * length, mount.clearance, mount.depth
    out, back = clearance + 0.3 * length, -depth if through else -0.8 * depth
    hole = back - 0.01 if through else back - clearance
    workshop.cut(mount.parent, mount.placed(bore(radius, clearance, (0, 0, hole), (0, 0, 0.01))))
    x, y = length * np.cos(arm), length * np.sin(arm)
    solids = [cylinder(radius, (0, 0, back - (out if through else 0.0)), (0, 0, out))]
    for start, sign in ((0.0, 1.0), (-depth, -1.0))[: 2 if through else 1]:
        level = start + sign * out
        rose = cylinder(2.2 * radius, (0, 0, start + sign * clearance), (0, 0, start + sign * (clearance + radius)))
        solids += [rose, rod(radius, (0, 0, level), (x, y, level))]
    workshop.body(name, *(mount.placed(solid) for solid in solids))
    workshop.turns(name, mount.parent, np.sign(swing) * mount.outward, mount.place, (0.0, abs(swing)), rest=rest)


def add_button(
    workshop: Workshop,
    name: str,
    mount: Mount,
    size: tuple[float, float],
    *,
    travel: float,
    rest: float = 0.0,
    is_round: bool = False,
) -> None:
    """Add a button that is pressed into its pocket; `size` is across and up [m], of a round one the diameter."""
    clearance = mount.clearance
    bottom, top = -mount.depth + travel + clearance, 1.5 * travel
    x, y = 0.5 * size[0], 0.5 * size[1]
    if is_round:
        pocket, cap = _round_button(x, clearance, mount.depth, travel, top)
    else:
        pocket = box((-x - clearance, -y - clearance, -mount.depth), (x + clearance, y + clearance, mount.depth))
        cap = box((-x, -y, bottom), (x, y, top))
    workshop.cut(mount.parent, mount.placed(pocket))
    workshop.body(name, mount.placed(cap))
    workshop.slides(name, mount.parent, -mount.outward, mount.place, (0.0, travel), rest=rest)


def _round_button(
    radius: float, clearance: float, depth: float, travel: float, top: float
) -> tuple[Manifold, Manifold]:
    """Pocket and button of a round cap on a square foot, which keeps it from turning and from falling out."""
    bottom = -depth + travel + clearance
    half, ledge, gap = 0.8 * radius, 0.7 * bottom, min(clearance, -0.1 * bottom)
    room = half + clearance
    mouth = bore(radius, clearance, (0, 0, ledge - 1e-4), (0, 0, depth))
    foot = box((-half, -half, bottom), (half, half, ledge - gap))
    neck = cylinder(0.6 * radius, (0, 0, ledge - 2.0 * gap - 1e-4), (0, 0, top))
    cap = cylinder(radius, (0, 0, ledge + travel + gap), (0, 0, top))
    return mouth + box((-room, -room, -depth), (room, room, ledge)), foot + neck + cap


def grid(count: int, columns: int, size: tuple[float, float]) -> list[tuple[float, float]]:
    """Return the middles of `count` fields in rows of `columns`, first row on top, on an area around the origin."""
    columns = max(1, min(columns, count))
    rows = max(1, -(-count // columns))
    pitch = size[0] / columns, size[1] / rows
    return [
        ((k % columns + 0.5) * pitch[0] - 0.5 * size[0], 0.5 * size[1] - (k // columns + 0.5) * pitch[1])
        for k in range(count)
    ]
