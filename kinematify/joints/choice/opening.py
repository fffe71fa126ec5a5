"""Which way a turning joint opens: the fitted answer.

Gradient-boosted trees (Friedman 2001) read what is measured towards either side, as the difference of both and their
mean. With f for their sum, the log odds that the axis opens as it is are f(difference) - f(-difference), so that an
axis and its opposite get opposite answers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.joints.choice.scorer import shipped_opening
from kinematify.joints.measure.opening_direction import customary_sign, measure_sides

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from kinematify.config import LimitsConfig
    from kinematify.joints.choice.scorer import Scorer
    from kinematify.joints.measure.scene import JointScene
    from kinematify.robot.arrays import FloatArray

_UNDECIDED = 0.2  # log odds; noise of the samples decides below


def turn_sign(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray, config: LimitsConfig) -> float:
    """+1 where a turn opens about the axis as it is, -1 where it must be reversed.

    What stands at a stop opens the other way. Links in series, what turns on a bearing and is not stopped either way,
    and what looks alike towards both sides have no side that opens: customs tell theirs (`customary_sign`).

    Args:
        scene: The pair.
        axis: Unit direction, shape (3,).
        pivot: Point on the axis [m], shape (3,).
        free: Free angle towards + and - [rad], shape (2,).
        config: From where on a joint stands at its stop.
    """
    stopped, unstopped = np.radians((config.stopped_deg, config.unstopped_deg))
    if free.min() < stopped and free.max() > unstopped:
        return 1.0 if free[0] > free[1] else -1.0
    either = scene.serial or (scene.has_bearing and free.min() > unstopped)
    odds = 0.0 if either else opening_odds(shipped_opening(), measure_sides(scene, axis, pivot))
    return customary_sign(scene, axis, pivot, free, config) if abs(odds) < _UNDECIDED else float(np.sign(odds))


def opening_odds(scorer: Scorer, sides: Mapping[str, FloatArray]) -> float:
    """Log odds that the first of two sides is the one that opens.

    Args:
        scorer: The fitted trees.
        sides: Name -> value towards either side, shape (2,) each.
    """
    forward, backward = scorer.sums(side_columns(sides, scorer.measurements))
    return float(forward - backward) / scorer.temperature


def side_columns(sides: Mapping[str, FloatArray], names: Sequence[str]) -> NDArray[Any]:
    """What the trees read of either side: by how much it is ahead of the other one, and the mean, shape (2, 2 n)."""
    missing = np.full(2, np.nan)
    # In single precision, as they were fitted, so that what lies at a threshold goes the same way.
    values: NDArray[Any] = np.stack([sides.get(name, missing) for name in names], axis=1).astype(np.float32)
    values[~np.isfinite(values)] = np.nan
    ahead = np.round(values - values[::-1], 6)  # rounding is no lead
    mean = np.broadcast_to(values.mean(axis=0), values.shape)
    return np.concatenate([ahead, mean], axis=1)
