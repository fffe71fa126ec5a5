"""Facts of a joint before and after it is chosen."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import read_only
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


__all__ = ["JointCandidate", "JointEstimate", "JointType"]

FIXED, TURN, SLIDE = range(3)
CORNER, HALF_WAY, CENTRE, ELSEWHERE = range(4)
GIVEN = "given"
"""Source of hypotheses that were not proposed but given."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Hypotheses:
    """Joints that one edge may have."""

    kinds: IntArray
    """FIXED, TURN or SLIDE, shape (h,)."""
    axes: FloatArray
    """Unit directions, world frame, shape (h, 3); zero for fixed."""
    pivots: FloatArray
    """Points on the lines, those of turns nearest to the contact [m], shape (h, 3)."""
    places: IntArray
    """CORNER, HALF_WAY or CENTRE of the child's box, ELSEWHERE for lines of other sources, shape (h,)."""
    sources: NDArray[np.str_]
    """What proposed each, shape (h,)."""

    def __len__(self) -> int:
        return len(self.kinds)

    def at(self, index: IntArray) -> Hypotheses:
        """Those at these positions, in this order."""
        return Hypotheses(**{name: values[index] for name, values in vars(self).items()})

    @property
    def given(self) -> BoolArray:
        """Which were not proposed but given, shape (h,)."""
        return np.asarray(self.sources == GIVEN)

    def arms(self, point: FloatArray) -> FloatArray:
        """From each line to a point, across the line [m], shape (h, 3)."""
        offset = point - self.pivots
        return np.asarray(offset - np.einsum("hk,hk->h", offset, self.axes)[:, None] * self.axes)


def joined(*some: Hypotheses) -> Hypotheses:
    """Hypotheses of one edge one after the other."""
    return Hypotheses(**{name: np.concatenate([vars(each)[name] for each in some]) for name in vars(some[0])})


@dataclass(frozen=True, kw_only=True, eq=False)
class JointLine:
    """Type and line of a joint of one part against another; world frame, q = 0 is the input configuration."""

    kind: JointType
    axis: FloatArray
    """Unit direction in the world frame, shape (3,). Read-only."""
    pivot: FloatArray
    """A point on the axis, world frame [m], shape (3,). Read-only."""
    evidence: Mapping[str, float] = field(default_factory=dict)
    """Named measurements behind it."""

    def __post_init__(self) -> None:
        axis = np.asarray(self.axis, dtype=np.float64)
        object.__setattr__(self, "axis", read_only(axis / np.linalg.norm(axis), np.float64))
        object.__setattr__(self, "pivot", read_only(self.pivot, np.float64))
        object.__setattr__(self, "evidence", MappingProxyType(dict(self.evidence)))


@dataclass(frozen=True, kw_only=True, eq=False)
class JointCandidate(JointLine):
    """A hypothesis; the sign of its axis is not yet meaningful."""

    score: float
    """Higher is better; comparable among the candidates of one edge."""
    source: str
    """Generator that proposed it, e.g. ``bearing``, ``pca``, ``box_edge``."""


@dataclass(frozen=True, kw_only=True, eq=False)
class JointEstimate(JointLine):
    """The joint chosen for a directed tree edge; its axis is signed so that q > 0 opens it."""

    parent: int
    child: int
    lower: float
    """Lower limit [rad if it turns, m if it slides]; 0 for fixed, -inf for continuous."""
    upper: float
    """Upper limit [rad if it turns, m if it slides]; 0 for fixed, +inf for continuous."""
    confidence: float
    """Between 0 and 1; how likely parent, type and axis are right (calibration: `results/choice.md`)."""
    stops: tuple[str, str] = ("", "")
    """What ends the range at `lower` and at `upper`, in words; empty where nothing does or it is not known."""
    alternatives: tuple[JointCandidate, ...] = ()
    """Every candidate that was kept, best first, the chosen one included."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.kind in (JointType.FIXED, JointType.CONTINUOUS):
            object.__setattr__(self, "stops", ("", ""))
