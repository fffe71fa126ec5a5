"""Sobol points of our own are those of SciPy, digit by digit."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import qmc

from kinematify.geometry.together import sobol


@pytest.mark.parametrize("dimensions", [1, 2, 7, 48, 50])
@pytest.mark.parametrize("count", [1, 128])
def test_points_are_those_of_scipy(dimensions: int, count: int) -> None:
    expected = qmc.Sobol(dimensions, rng=3).random(count)
    assert np.array_equal(sobol(count, dimensions, 3), expected)
