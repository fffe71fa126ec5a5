"""Motions between congruent clouds: they lay one upon the other, mirrored where the shape is."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.contact.alike import motions_between
from kinematify.robot.transforms import rotation_about

MIRROR = np.diag([1.0, -1.0, 1.0])


def hook(count: int = 500, seed: int = 0) -> np.ndarray:
    """Points in three bars of different lengths along three axes, a chiral shape."""
    rng = np.random.default_rng(seed)
    lows = np.array([[0, 0, 0], [0.9, 0, 0], [0.9, 0.5, 0]])
    highs = np.array([[1.0, 0.1, 0.1], [1.0, 0.6, 0.1], [1.0, 0.6, 0.35]])
    which = rng.integers(3, size=count)
    return lows[which] + rng.random((count, 3)) * (highs - lows)[which]


@pytest.mark.parametrize("mirrored", [False, True])
def test_the_motion_of_a_chiral_shape_is_found(mirrored: bool) -> None:
    turn = rotation_about(np.array([0.6, 0.0, 0.8]), 1.1) @ (MIRROR if mirrored else np.eye(3))
    shift = np.array([0.3, -2.0, 0.7])
    found = motions_between(hook(), hook(seed=1) @ turn.T + shift, tolerance=0.025)
    assert len(found) == 1
    assert np.sign(np.linalg.det(found[0].turn)) == (-1.0 if mirrored else 1.0)
    np.testing.assert_allclose(found[0].inverse.points(hook() @ turn.T + shift), hook(), atol=0.03)
