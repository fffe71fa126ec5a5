"""Leaves of doors and windows in their frames: hinged at an edge, or running in grooves.

A frame lies between y = 0, its front, and its depth. A leaf that is hinged lies flush with the front and opens
towards it, along -y.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import barrel
from kinematify.generate.procedural.solids import box, union

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_REVEAL = 0.001  # around a leaf, besides the clearance [m]
_STOP = 0.012  # how far the strip that a leaf lies against reaches into the opening [m]
_GROOVE = 0.012  # depth of the grooves that leaves run in [m]
_RIB = 0.008  # between two grooves [m]
_TOWARDS = {
    "left": (1.0, 0.0, 0.0),
    "right": (-1.0, 0.0, 0.0),
    "bottom": (0.0, 0.0, 1.0),
    "top": (0.0, 0.0, -1.0),
}
"""From a hinged edge into the leaf."""


@dataclass(frozen=True, kw_only=True)
class Field:
    """What one leaf closes: its borders in the plane of the frame [m]."""

    left: float
    right: float
    bottom: float
    top: float

    def box(self, start: float, end: float, *, inset: float = 0.0) -> Manifold:
        """Return the block over the field from y = `start` to y = `end`, smaller by `inset` on all four sides."""
        lower = (self.left + inset, start, self.bottom + inset)
        return box(lower, (self.right - inset, end, self.top - inset))

    @property
    def width(self) -> float:
        """[m]."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """[m]."""
        return self.top - self.bottom

    @property
    def middle(self) -> tuple[float, float]:
        """X and z."""
        return 0.5 * (self.left + self.right), 0.5 * (self.bottom + self.top)


@dataclass(frozen=True, kw_only=True)
class Hinge:
    """How a leaf hangs at an edge."""

    edge: str
    """``left``, ``right``, ``bottom`` or ``top``."""
    barrel: float
    """Radius of the barrels that stand before the front [m]; zero hides the hinge in the front corner."""
    thick: float
    """Of the leaf [m]."""
    clearance: float
    """[m]."""

    @property
    def gap(self) -> float:
        """Between the leaf and the borders of its field [m]."""
        return self.clearance + _REVEAL

    @property
    def pivot(self) -> tuple[float, float]:
        """From the hinged border into the field, and y [m]."""
        return 0.5 * self.gap, -(self.barrel + self.clearance) if self.barrel else 0.0


def side_by_side(whole: Field, count: int, mullion: float, *, together: int = 1) -> list[list[Field]]:
    """Divide a field into `count` equal ones in groups of `together`, with a mullion between groups."""
    groups = -(-count // together)
    width = (whole.right - whole.left - (groups - 1) * mullion) / count
    divided: list[list[Field]] = [[] for _ in range(groups)]
    for k in range(count):
        left = whole.left + k * width + (k // together) * mullion
        divided[k // together].append(Field(left=left, right=left + width, bottom=whole.bottom, top=whole.top))
    return divided


def stopped_opening(groups: Sequence[Sequence[Field]], depth: float, thick: float, clearance: float) -> Manifold:
    """Return what to cut from a frame so that groups of leaves close against a strip behind them."""
    cuts = []
    for group in groups:
        whole = Field(left=group[0].left, right=group[-1].right, bottom=group[0].bottom, top=group[0].top)
        cuts += [whole.box(-1.0, thick + clearance), whole.box(-1.0, depth + 1.0, inset=_STOP)]
    return union(*cuts)


def hinged_slab(field: Field, hinge: Hinge) -> Manifold:
    """Return the solid leaf of a field, its free edge so bevelled that it passes the border when it opens."""
    place, span, length = _canonical(field, hinge)
    near, level = hinge.pivot
    reach = span - hinge.gap - near
    front = near + math.sqrt(reach**2 - level**2)
    back = near + math.sqrt(reach**2 - (hinge.thick - level) ** 2)
    half = 0.5 * length - hinge.gap
    slab = box((hinge.gap, 0.0, -half), (front, hinge.thick, half))
    bevel = np.array([-hinge.thick, back - front, 0.0])
    bevel /= np.linalg.norm(bevel)
    return slab.trim_by_plane(bevel, float(bevel[0] * front)).transform(place)


def hang(
    workshop: Workshop,
    name: str,
    *solids: Manifold,
    parent: str,
    field: Field,
    hinge: Hinge,
    opens: float,
    rest: float,
    count: int = 2,
) -> None:
    """Hang a leaf, made of `solids`, at an edge of its field; it opens by `opens` [rad] on `count` barrels."""
    place, _, length = _canonical(field, hinge)
    near, level = hinge.pivot
    halves = list(solids)
    if hinge.barrel:
        pieces = _barrels(hinge, min(12.0 * hinge.barrel, 0.2 * length))
        for share in np.linspace(-0.36, 0.36, count):
            of_frame, of_leaf = (piece.translate((near, level, share * length)).transform(place) for piece in pieces)
            workshop.add(parent, of_frame)
            halves.append(of_leaf)
    workshop.body(name, *halves)
    axis = np.cross(_TOWARDS[hinge.edge], (0.0, -1.0, 0.0))
    workshop.turns(name, parent, axis, place @ (near, level, 0.0, 1.0), (0.0, opens), rest=rest)


def _canonical(field: Field, hinge: Hinge) -> tuple[FloatArray, float, float]:
    """Transform, shape (3, 4), from where the hinge runs along z at x = 0 with the leaf on +x; span and length."""
    into = np.array(_TOWARDS[hinge.edge], dtype=np.float64)
    upright = hinge.edge in ("left", "right")
    span, length = (field.width, field.height) if upright else (field.height, field.width)
    x, z = field.middle
    along = (0, 0, 1) if upright else (1, 0, 0)
    origin = np.array([x, 0.0, z]) - 0.5 * span * into
    return np.column_stack([into, (0, 1, 0), along, origin]), span, length


def _barrels(hinge: Hinge, length: float) -> tuple[Manifold, Manifold]:
    """Halves of one barrel for frame and leaf, about z; their wings touch the fronts from outside."""
    near, level = hinge.pivot
    inner, outer = 0.6 * hinge.barrel, 3.0 * hinge.barrel
    face = (-level - 2e-4, -level + 1e-4)  # a wing that reached deeper would meet the other side
    on_frame = (-near - outer, -near - inner, *face)
    on_leaf = (hinge.gap - near + inner, hinge.gap - near + outer, *face)
    return barrel(length, hinge.barrel, hinge.clearance, (on_frame, on_leaf))


@dataclass(frozen=True, kw_only=True)
class Grooves:
    """Grooves above and below an opening, one behind the other, the first one in front."""

    opening: Field
    count: int
    thick: float
    """Of the leaves [m]."""
    clearance: float
    """[m]."""

    @property
    def depth(self) -> float:
        """Of the frame that has room for the grooves [m]."""
        return _RIB + self.count * self._pitch

    @property
    def _pitch(self) -> float:
        return self.thick + 2.0 * self.clearance + _RIB

    def cut(self) -> Manifold:
        """Return what to cut from a frame: the opening and the grooves."""
        grooves = [self._groove(k) for k in range(self.count)]
        return union(self.opening.box(-1.0, self.depth + 1.0), *grooves)

    def _groove(self, track: int) -> Manifold:
        start = _RIB + track * self._pitch
        lower = (self.opening.left, start, self.opening.bottom - _GROOVE)
        return box(lower, (self.opening.right, start + self._pitch - _RIB, self.opening.top + _GROOVE))

    def front(self, track: int) -> float:
        """Y of the front of a leaf in a track [m]."""
        return _RIB + track * self._pitch + self.clearance

    def slab(self, track: int, left: float, right: float) -> Manifold:
        """Return a leaf that runs in a track."""
        y, deep = self.front(track), _GROOVE - self.clearance
        lower = (left, y, self.opening.bottom - deep)
        return box(lower, (right, y + self.thick, self.opening.top + deep))

    def fixed(self, track: int, left: float, right: float) -> Manifold:
        """Return a pane that fills a track and belongs to the frame."""
        y = self.front(track) - self.clearance
        lower = (left, y - 1e-4, self.opening.bottom - _GROOVE)
        return box(lower, (right, y + self.thick + 2.0 * self.clearance + 1e-4, self.opening.top + _GROOVE))


def add_sliding(
    workshop: Workshop,
    name: str,
    parent: str,
    tracks: Grooves,
    *,
    count: int,
    finish: Callable[[Manifold, Field, float], Manifold],
    rest: float,
) -> None:
    """Add `count` leaves, each in its own track, that run sideways; beside a single one stands a fixed pane.

    Args:
        workshop: Where they are added.
        name: Of all, without their numbers.
        parent: The frame, without the opening; it is cut here.
        tracks: As many as leaves, two at least.
        count: Of leaves.
        finish: Carves a slab, given its face and the y of its front.
        rest: Share of the way that they stand open.
    """
    opening, clearance = tracks.opening, tracks.clearance
    shares = max(count, 2)
    pitch = (opening.right - opening.left) / shares
    overlap = min(0.03, 0.1 * pitch)
    workshop.cut(parent, tracks.cut())
    for k in range(shares):
        left = opening.left + k * pitch + (clearance if k == 0 else -0.5 * overlap)
        right = opening.left + (k + 1) * pitch + (-clearance if k == shares - 1 else 0.5 * overlap)
        face = Field(left=left, right=right, bottom=opening.bottom, top=opening.top)
        if k >= count:
            whole = tracks.fixed(k, left, opening.right + 1e-3)
            workshop.add(parent, finish(whole, face, tracks.front(k)))
            continue
        workshop.body(f"{name}_{k + 1}", finish(tracks.slab(k, left, right), face, tracks.front(k)))
        to_right = opening.right - clearance - right
        to_left = left - opening.left - clearance
        sign, room = (1, to_right) if to_right >= to_left else (-1, to_left)
        place = (face.middle[0], tracks.front(k), face.middle[1])
        workshop.slides(f"{name}_{k + 1}", parent, (sign, 0, 0), place, (0.0, 0.95 * room), rest=rest)


def carved(
    slab: Manifold, face: Field, front: float, thick: float, *, bar: float, rows: int, columns: int, sunk: float
) -> Manifold:
    """Return a leaf with `rows` x `columns` fields sunk into both faces between bars of width `bar`.

    Args:
        slab: The solid leaf.
        face: Its borders.
        front: Y of its front [m].
        thick: Its thickness [m].
        bar: Width of the bars around the fields; those between them are half as wide [m].
        rows: Of fields.
        columns: Of fields.
        sunk: Share of the thickness taken away from each side, below one half.
    """
    width = (face.right - face.left - 2.0 * bar - 0.5 * bar * (columns - 1)) / max(columns, 1)
    height = (face.top - face.bottom - 2.0 * bar - 0.5 * bar * (rows - 1)) / max(rows, 1)
    cuts = []
    for row in range(rows):
        for column in range(columns):
            left = face.left + bar + column * (width + 0.5 * bar)
            bottom = face.bottom + bar + row * (height + 0.5 * bar)
            field = Field(left=left, right=left + width, bottom=bottom, top=bottom + height)
            cuts += [field.box(front - 1.0, front + sunk * thick), field.box(front + (1.0 - sunk) * thick, front + 1.0)]
    return slab - union(*cuts) if cuts else slab
