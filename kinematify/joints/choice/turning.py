"""Whether what turns goes round and round: the fitted answer.

Gradient-boosted trees (Friedman 2001) with a logistic loss read what is measured of the turn alone, not what else was
proposed nor what cues say of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.joints.choice.scorer import shipped_turning
from kinematify.joints.measure.measurements import TURN, Hypotheses, measure

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from kinematify.joints.measure.scene import JointScene
    from kinematify.robot.arrays import FloatArray


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
