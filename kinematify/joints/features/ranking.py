"""Turns or slides of an edge in the order in which weighted cues rank them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.joints.candidate import Hypotheses
    from kinematify.robot.arrays import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Ranked:
    """Lines of one kind with what cues say of them."""

    lines: Hypotheses
    scores: FloatArray
    """Shape (c,), higher is better."""
    cues: Mapping[str, FloatArray]
    """Value of each cue before its weight, shape (c,) each."""
    free: FloatArray
    """Free motion towards + and - of the axis before the part hits anything, shape (c, 2): turns [rad], slides as a
    fraction of the diagonal."""
    free_parent: FloatArray
    """The same against the parent alone, shape (c, 2)."""

    @property
    def axes(self) -> FloatArray:
        """Unit directions, shape (c, 3)."""
        return self.lines.axes

    @property
    def proposed(self) -> Ranked:
        """Without those that were given."""
        return self.at(np.flatnonzero(~self.lines.given))

    @property
    def best_first(self) -> Ranked:
        """In the order of the scores; of equal ones, the first stays before the others."""
        return self.at(np.argsort(-self.scores, kind="stable"))

    def first(self, count: int | None) -> Ranked:
        """The first of them, and those that were given; all where `count` is None."""
        given = self.lines.given
        return self.at(np.flatnonzero(given | (np.cumsum(~given) <= (count or len(given)))))

    def at(self, index: IntArray) -> Ranked:
        """Those at these positions, in this order."""
        return Ranked(
            lines=self.lines.at(index),
            scores=self.scores[index],
            cues={name: value[index] for name, value in self.cues.items()},
            free=self.free[index],
            free_parent=self.free_parent[index],
        )


def cue_sum(cues: Mapping[str, FloatArray], weights: Mapping[str, float], cap: float) -> FloatArray:
    """Weighted sum of cues, each of which says `cap` at most, shape (c,)."""
    total: FloatArray = np.sum([np.clip(weights[name] * value, -cap, cap) for name, value in cues.items()], axis=0)
    return total
