"""What the joint stage tells the topology stage about a contact edge before the tree is known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import read_only

if TYPE_CHECKING:
    from kinematify.assembly.part import FloatArray

Pair = tuple[int, int]
"""An undirected edge (a, b) with a < b."""


@dataclass(frozen=True, kw_only=True, eq=False)
class EdgeEvidence:
    """How well the best joint explains a contact; the same for both directions of the edge."""

    quality: float
    """In [0, 1]; 0 where no joint fits."""
    axis: FloatArray | None
    """Unit direction of the best joint in the world frame, shape (3,); None where there is none. Read-only."""
    turns: bool = True
    """True for a revolute joint, False for a prismatic one."""

    def __post_init__(self) -> None:
        if self.axis is not None:
            axis = np.asarray(self.axis, dtype=np.float64)
            object.__setattr__(self, "axis", read_only(axis / np.linalg.norm(axis), np.float64))


def pair(a: int, b: int) -> Pair:
    """Key of the undirected edge between two parts."""
    return (a, b) if a < b else (b, a)
