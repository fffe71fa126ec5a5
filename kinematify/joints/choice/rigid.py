"""Whether a part is fixed to the one that carries it: handles, feet, shelves and panes are parts of their own too.

Asked apart from which joint it is, because objects teach the two apart: whatever piece of a link is taken for a part
of its own is an example of a fixed one. Gradient-boosted trees (Friedman 2001) with a logistic loss read what was
measured of the turn and of the slide that cues rank first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.joints.choice.scorer import shipped_rigidity
from kinematify.joints.measure.measurements import SLIDE, TURN

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray


def rigid_odds(kinds: IntArray, measured: Mapping[str, FloatArray]) -> float:
    """Log odds that the child of an edge is fixed to its parent, from its shapes alone.

    Args:
        kinds: FIXED, TURN or SLIDE of each hypothesis, shape (h,).
        measured: Name -> values, shape (h,) each.
    """
    scorer = shipped_rigidity()
    columns = rigid_columns(kinds, measured, scorer.measurements)
    return float(scorer.sums(columns[None])[0] / scorer.temperature)


def rigid_columns(kinds: IntArray, measured: Mapping[str, FloatArray], names: Sequence[str]) -> NDArray[Any]:
    """What the trees read of one edge: of a turn, of a slide, and the number of hypotheses, shape (2 n + 1,)."""
    support = np.nan_to_num(measured["rules_score"], nan=-np.inf)
    missing = np.full(len(kinds), np.nan)
    # In single precision, as they were fitted, so that what lies at a threshold goes the same way.
    values: NDArray[Any] = np.stack([measured.get(name, missing) for name in names], axis=1).astype(np.float32)
    values[~np.isfinite(values)] = np.nan
    found: list[NDArray[Any]] = []
    for kind in (TURN, SLIDE):
        rows = np.flatnonzero(kinds == kind)
        none = np.full(len(names), np.nan, dtype=np.float32)
        found.append(values[rows[np.argmax(support[rows])]] if len(rows) else none)
    return np.concatenate([*found, np.array([len(kinds)], dtype=np.float32)])
