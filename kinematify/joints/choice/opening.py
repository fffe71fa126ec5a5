"""Which way a turning joint opens: the fitted answer.

Gradient-boosted trees (Friedman 2001) read what is measured towards either side, as the difference of both and their
mean. With f for their sum, the log odds that the axis opens as it is are f(difference) - f(-difference), so that an
axis and its opposite get opposite answers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.joints.choice.scorer import shipped_opening, shipped_rigidity, shipped_turning
from kinematify.joints.measure.measurements import SLIDE, TURN, Hypotheses, measure
from kinematify.joints.measure.opening_direction import customary_sign, measure_sides

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from kinematify.config import LimitsConfig
    from kinematify.joints.choice.scorer import Scorer
    from kinematify.joints.measure.scene import JointScene
    from kinematify.robot.arrays import FloatArray, IntArray


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


_FREE = -0.5  # log odds beyond which what meets nothing goes round: both kinds are told about equally often
_STOPPED = 1.0  # the same of what meets something on its way, as a tyre its mudguard


def goes_round(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray) -> bool:
    """Whether a turn has no end: wheels, knobs and propellers, but not links in series, of which each has its stops.

    Args:
        scene: The pair.
        axis: Unit direction, shape (3,).
        pivot: Point on the line [m], shape (3,).
        free: Free angle towards + and - [rad], shape (2,).
    """
    if scene.serial and scene.smallness < 1.0 and not scene.rolls:
        return False
    turn = Hypotheses(kinds=np.array([TURN]), axes=axis[None], pivots=pivot[None], sources=("chosen",))
    scorer = shipped_turning()
    odds = scorer.sums(turning_columns(measure(scene, turn), 0, scorer.measurements)[None])[0] / scorer.temperature
    return bool(odds > (_FREE if free.min() >= np.pi else _STOPPED))


def turning_columns(measured: Mapping[str, FloatArray], row: int, names: Sequence[str]) -> NDArray[Any]:
    """What the trees read of one hypothesis, shape (n,)."""
    # In single precision, as they were fitted, so that what lies at a threshold goes the same way.
    values: NDArray[Any] = np.array([measured[name][row] if name in measured else np.nan for name in names], np.float32)
    values[~np.isfinite(values)] = np.nan
    return values


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
