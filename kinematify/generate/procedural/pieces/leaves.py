"""Leaves of doors and windows in their frames: hinged at an edge, or running in grooves.

A frame lies between y = 0, its front, and its depth. A leaf that is hinged lies flush with the front and opens
towards it, along -y.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.generate.procedural.solids import box, union

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.workshop import Workshop

_STOP = 0.012  # how far the strip that a leaf lies against reaches into the opening [m]
_GROOVE = 0.012  # depth of the grooves that leaves run in [m]
_RIB = 0.008  # between two grooves [m]


@dataclass(frozen=True, kw_only=True)
class Field:
    """Opening that one leaf closes: its borders in the plane of the frame [m]."""

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
        """Depth of the frame that has room for the grooves [m]."""
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


def fields_of(face: Field, front: float, thick: float, *, bar: float, rows: int, columns: int, sunk: float) -> Manifold:
    """Return what to cut from a leaf so that `rows` x `columns` fields are sunk into both faces between bars.

    Args:
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
    return union(*cuts)
