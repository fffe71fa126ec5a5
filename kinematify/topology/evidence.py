"""What the joint stage tells the topology stage about a contact edge before the tree is known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import read_only

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.arrays import FloatArray

Pair = tuple[int, int]
"""An undirected edge (a, b) with a < b."""


@dataclass(frozen=True, kw_only=True, eq=False)
class EdgeEvidence:
    """How well the best joint explains a contact; the same for both directions of the edge."""

    quality: float
    """In [0, 1]; 0 where no joint fits."""
    axis: FloatArray | None
    """Unit direction of the best joint in the world frame, shape (3,); None where there is none. Read-only."""
    point: FloatArray | None = None
    """A point on its line in the world frame [m], shape (3,); None where there is none. Read-only."""
    turns: bool = True
    """True for a revolute joint, False for a prismatic one."""
    has_journal: bool = False
    """One part holds the other all around a line, beyond doubt; asked only where the tree depends on it."""
    passing: bool = False
    """One part turns past the other about the line, all around; asked of coaxial parts only."""
    is_adjacent_leaf: bool = False
    """Both are leaves on one pin, next to each other, and cannot pass each other."""
    skips_leaf: bool = False
    """Both are leaves on one pin, and a third one lies between them."""

    def __post_init__(self) -> None:
        if self.axis is not None:
            axis = np.asarray(self.axis, dtype=np.float64)
            object.__setattr__(self, "axis", read_only(axis / np.linalg.norm(axis), np.float64))
        if self.point is not None:
            object.__setattr__(self, "point", read_only(self.point, np.float64))

    def is_coaxial(self, other: EdgeEvidence, *, angle: float, distance: float) -> bool:
        """Whether two joints turn about one line, within `angle` [deg] and `distance` [m]."""
        if self.axis is None or other.axis is None or self.point is None or other.point is None:
            return False
        offset = np.linalg.norm(np.cross(other.point - self.point, self.axis))
        return bool(abs(float(self.axis @ other.axis)) > np.cos(np.radians(angle)) and offset < distance)


def pair(a: int, b: int) -> Pair:
    """Key of the undirected edge between two parts."""
    return (a, b) if a < b else (b, a)


def coaxial_carriers(
    evidence: Mapping[Pair, EdgeEvidence], *, angle: float, distance: float
) -> dict[Pair, frozenset[int]]:
    """Parts that bear both ends of an edge about its own line.

    Args:
        evidence: Best joint of each contact edge.
        angle: Axes within this angle are one line [deg].
        distance: The same for their distance [m].

    Returns:
        For every edge (a, b) with such parts: all c that touch both a and b, where all three turn on one line.
    """
    touching: dict[int, set[int]] = {}
    for a, b in evidence:
        touching.setdefault(a, set()).add(b)
        touching.setdefault(b, set()).add(a)
    found = {}
    for (a, b), item in evidence.items():
        sides = {c: (evidence[pair(a, c)], evidence[pair(b, c)]) for c in touching[a] & touching[b]}
        carriers = frozenset(
            c
            for c, both in sides.items()
            if all(item.is_coaxial(side, angle=angle, distance=distance) for side in both)
        )
        if carriers:
            found[a, b] = carriers
    return found
