"""Axis, line, limit and opening metrics of one joint: hand-made cases and laws."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from kinematify.evaluation.metrics import axis_angle, limit_overlap, opening_sign

X, Y, Z = np.eye(3)


def tilted(degrees: float) -> NDArray[np.float64]:
    """Z, turned about X."""
    radians = math.radians(degrees)
    return np.array([0.0, -math.sin(radians), math.cos(radians)])


@pytest.mark.parametrize(("degrees", "expected"), [(0, 0), (30, 30), (90, 90), (120, 60), (180, 0), (1e-6, 1e-6)])
def test_axis_angle_is_folded_and_precise_near_zero(degrees: float, expected: float) -> None:
    assert axis_angle(Z, tilted(degrees)) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(
    ("true_limits", "limits", "same_sign", "expected"),
    [
        ((0.0, 1.0), (0.0, 1.0), True, 1.0),
        ((0.0, 1.0), (-1.0, 0.0), False, 1.0),
        ((0.0, 1.0), (-1.0, 0.0), True, 0.0),
        ((0.0, 1.0), (0.5, 1.5), True, 1.0 / 3.0),
        ((0.0, 1.0), (2.0, 3.0), True, 0.0),
        ((0.0, 2.0), (0.0, 1.0), True, 0.5),
        ((0.0, 0.0), (0.0, 0.0), True, 1.0),
        ((0.0, 0.0), (0.0, 1.0), True, 0.0),
    ],
)
def test_limit_overlap(
    true_limits: tuple[float, float], limits: tuple[float, float], same_sign: bool, expected: float
) -> None:
    assert limit_overlap(true_limits, limits, same_sign=same_sign, turns=False) == pytest.approx(expected)
    assert limit_overlap(true_limits, limits, same_sign=same_sign, turns=True) == pytest.approx(expected)


def test_full_turns_are_compared_by_the_share_of_the_turn() -> None:
    endless = (-math.inf, math.inf)
    assert limit_overlap(endless, endless, same_sign=True, turns=True) == 1.0
    assert limit_overlap((-2 * math.pi, 2 * math.pi), endless, same_sign=True, turns=True) == 1.0
    assert limit_overlap((0.0, math.pi / 2), endless, same_sign=False, turns=True) == pytest.approx(0.25)
    # A slide of 10 m is no turn.
    assert limit_overlap((0.0, 10.0), (0.0, 5.0), same_sign=True, turns=False) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("lower", "upper", "expected"),
    [
        (0.0, 1.5, 1),
        (-1.5, 0.0, -1),
        (-0.1, 1.0, 1),
        (-2.9, 2.9, 0),
        (-0.6, 1.0, 0),
        (0.2, 1.0, 0),
        (0.0, 0.0, 0),
        (-math.inf, math.inf, 0),
    ],
)
def test_opening_sign(lower: float, upper: float, expected: int) -> None:
    assert opening_sign(lower, upper) == expected
    assert opening_sign(-upper, -lower) == -expected
