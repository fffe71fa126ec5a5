"""What a page shows: a model, and what its inference tells of the joints."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.arrays import FloatArray
    from kinematify.view.alternatives import Alternative
    from kinematify.view.scene import ViewScene

_DASHES = 9
_REACH = 0.15
"""Of the model's size: how far the line of a pin is drawn to either side."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ClosedChain:
    """Two links that share a pin, which no joint of the tree joins."""

    links: tuple[str, str]
    points: tuple[FloatArray, FloatArray]
    """The pin in the frame of either link [m], each of shape (3,)."""
    axis: FloatArray
    """Of the pin, unit, frame of the first link, shape (3,); zero where it is a point."""
    told: str
    """Which joint was cut, and why."""

    def dashes(self, poses: Mapping[str, FloatArray], size: float) -> FloatArray:
        """Return line segments along the pin and between its two ends, frame of the root link [m], shape (n, 2, 3).

        Args:
            poses: Of the links, frame of the root link, shape (4, 4) each.
            size: Of the model [m].
        """
        first, second = (
            (poses[link] @ np.append(point, 1.0))[:3] for link, point in zip(self.links, self.points, strict=True)
        )
        reach = _REACH * size * (poses[self.links[0]][:3, :3] @ self.axis)
        return np.concatenate([_dashed(first - reach, first + reach), _dashed(first, second)])


@dataclass(frozen=True, kw_only=True)
class Sight:
    """A finding as the viewer shows it."""

    title: str
    message: str
    q: Mapping[str, float] = field(default_factory=dict)
    links: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class Shown:
    """A model to look at."""

    scene: ViewScene
    alternatives: Mapping[tuple[str, str], tuple[Alternative, ...]] = field(default_factory=dict)
    """Candidates of joints by (parent, child) link."""
    doubtful: tuple[str, ...] = ()
    """Links whose joints are to be looked at, the least sure first."""
    doubtful_below: float = 0.0
    """Confidence below which they are."""
    chains: tuple[ClosedChain, ...] = ()
    """Where chains of joints close."""


def _dashed(start: FloatArray, end: FloatArray) -> FloatArray:
    """Dashes as long as the gaps between them, shape (n, 2, 3)."""
    shares = np.linspace(0.0, 1.0, 2 * _DASHES)[:, None]
    points: FloatArray = (start + shares * (end - start)).reshape(_DASHES, 2, 3)
    return points
