"""Vectors of three numbers: every digit is that of NumPy's general functions."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.robot.vectors import crossed, dots, highest, lengths_of, lowest


@pytest.mark.parametrize("shape", [(3,), (1, 3), (500, 3), (20, 7, 3)])
def test_digits_are_those_of_numpy(shape: tuple[int, ...]) -> None:
    first, second = np.random.default_rng(0).normal(size=(2, *shape)) * 10.0 ** np.arange(-4, 5, 4)
    assert np.array_equal(crossed(first, second), np.cross(first, second))
    assert np.array_equal(dots(first, second), (first * second).sum(axis=-1))
    assert np.array_equal(lengths_of(first), np.linalg.norm(first, axis=-1))


def test_one_vector_is_multiplied_with_many() -> None:
    many, one = np.random.default_rng(1).normal(size=(40, 3)), np.array([0.3, -2.0, 1e6])
    assert np.array_equal(crossed(many, one), np.cross(many, one))
    assert np.array_equal(dots(one, many), (one * many).sum(axis=-1))


def test_bounds_are_those_of_numpy() -> None:
    points = np.random.default_rng(2).normal(size=(300, 3))
    assert np.array_equal(lowest(points), points.min(axis=0))
    assert np.array_equal(highest(points), points.max(axis=0))
