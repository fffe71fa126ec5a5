"""What all engines share: gravity, pins, and rows of joint values."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray

GRAVITY = 9.81
"""Along -z of the root link's frame [m/s^2]; every engine is set to it."""
PIN_SOLREF, PIN_SOLIMP = (0.004, 1.0), (0.99, 0.999, 1.0e-4)
"""Of pins that close a loop in MuJoCo: its defaults let a driven four-bar open by 0.4 % of its size, these by 0.004 %
at the default step."""


def spread_rows(lower: FloatArray, upper: FloatArray, rows: int, seed: int) -> FloatArray:
    """Latin hypercube in the box of the limits, shape (rows, m): every joint's range is covered evenly.

    NumPy alone makes it; SciPy's Sobol points would cost half a second for the import.
    """
    generator = np.random.default_rng(seed)
    strata = np.array([generator.permutation(rows) for _ in lower]).reshape(len(lower), rows).T
    points: FloatArray = (strata + generator.random(strata.shape)) / rows
    return lower + points * (upper - lower)
