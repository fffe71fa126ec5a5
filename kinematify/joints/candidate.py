"""What is known of a joint before and after it is chosen."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import read_only
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.arrays import FloatArray


__all__ = ["JointCandidate", "JointEstimate", "JointType"]


@dataclass(frozen=True, kw_only=True, eq=False)
class JointCandidate:
    """A hypothesis of how one part moves against another; world frame, input configuration = zero."""

    kind: JointType
    axis: FloatArray
    """Unit direction in the world frame, shape (3,); sign is not yet meaningful. Read-only."""
    pivot: FloatArray
    """A point on the axis, world frame [m], shape (3,). Read-only."""
    score: float
    """Higher is better; comparable among the candidates of one edge."""
    source: str
    """Generator that proposed it, e.g. ``bearing``, ``pca``, ``box_edge``."""
    evidence: Mapping[str, float] = field(default_factory=dict)
    """Named measurements behind the score."""

    def __post_init__(self) -> None:
        axis = np.asarray(self.axis, dtype=np.float64)
        object.__setattr__(self, "axis", read_only(axis / np.linalg.norm(axis), np.float64))
        object.__setattr__(self, "pivot", read_only(self.pivot, np.float64))
        object.__setattr__(self, "evidence", MappingProxyType(dict(self.evidence)))


@dataclass(frozen=True, kw_only=True, eq=False)
class JointEstimate:
    """The joint chosen for a directed tree edge; world frame, q = 0 is the input configuration."""

    parent: int
    child: int
    kind: JointType
    axis: FloatArray
    """Unit direction in the world frame, shape (3,), signed so that q > 0 opens the joint. Read-only."""
    pivot: FloatArray
    """A point on the axis, world frame [m], shape (3,). Read-only."""
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
    evidence: Mapping[str, float] = field(default_factory=dict)
    """Named measurements behind type, direction and limits."""

    def __post_init__(self) -> None:
        axis = np.asarray(self.axis, dtype=np.float64)
        object.__setattr__(self, "axis", read_only(axis / np.linalg.norm(axis), np.float64))
        object.__setattr__(self, "pivot", read_only(self.pivot, np.float64))
        object.__setattr__(self, "evidence", MappingProxyType(dict(self.evidence)))
        if self.kind in (JointType.FIXED, JointType.CONTINUOUS):
            object.__setattr__(self, "stops", ("", ""))
